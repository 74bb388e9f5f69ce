// Makes the faces of a mesh planar: Planarise.exe MESH.obj [OUT.obj]
//
// In a script component of Grasshopper the lines between the two marks are the same: points and faces come from its inputs.

using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using ShapeOp;

static class Planarise
{
    static int Main(string[] arguments)
    {
        if (arguments.Length < 1)
        {
            Console.Error.WriteLine("usage: Planarise.exe MESH.obj [OUT.obj]");
            return 2;
        }
        var coordinates = new List<double>();
        var faces = new List<int[]>();
        foreach (string line in File.ReadLines(arguments[0]))
        {
            string[] words = line.Split(new[] { ' ', '\t' }, StringSplitOptions.RemoveEmptyEntries);
            if (words.Length == 0) continue;
            // A corner may be written as point/texture/normal; points count from 1.
            if (words[0] == "v") coordinates.AddRange(words.Skip(1).Take(3).Select(Number));
            if (words[0] == "f") faces.Add(words.Skip(1).Select(word => int.Parse(word.Split('/')[0]) - 1).ToArray());
        }
        double[] points = coordinates.ToArray();
        try
        {
            // -- from here
            double before = Measure.Faces("planarity", points, faces).Max();
            using (var solver = new Solver())
            {
                string problem = Problem.FromRecipe("planarize", points, faces, new RecipeOptions { Closeness = 0.01 });
                SolveOptions options = solver.SetProblem(problem);
                Report report = solver.SolveUntil(options, progress => false /* true stops it */);
                points = solver.Points;
                double after = Measure.Faces("planarity", points, faces).Max();
                Console.WriteLine($"{report.Outcome} after {report.Iterations} iterations");
                Console.WriteLine(FormattableString.Invariant($"worst face: {100 * before:F3} % -> {100 * after:F3} %"));
            }
            // -- to here
        }
        catch (ShapeOpException refusal)
        {
            Console.Error.WriteLine($"{refusal.Code}: {refusal.Message}");
            return 1;
        }
        if (arguments.Length > 1) Write(arguments[1], points, faces);
        return 0;
    }

    static double Number(string word) => double.Parse(word, CultureInfo.InvariantCulture);

    static void Write(string path, double[] points, List<int[]> faces)
    {
        using (var file = new StreamWriter(path))
        {
            for (int i = 0; i < points.Length; i += 3)
            {
                file.WriteLine(FormattableString.Invariant($"v {points[i]:R} {points[i + 1]:R} {points[i + 2]:R}"));
            }
            foreach (int[] face in faces) file.WriteLine("f " + string.Join(" ", face.Select(index => index + 1)));
        }
    }
}
