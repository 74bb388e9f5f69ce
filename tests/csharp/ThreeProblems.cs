using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using ShapeOp;

/// <summary>The three problems of tests/languages/README.md: ThreeProblems.exe MESH FOLDER.</summary>
static class ThreeProblems
{
    static int Main(string[] arguments)
    {
        if (arguments.Length != 2)
        {
            Console.Error.WriteLine("usage: ThreeProblems.exe MESH FOLDER");
            return 2;
        }
        try
        {
            Write(Path.Combine(arguments[1], "quad.txt"), Quad());
            Write(Path.Combine(arguments[1], "planarise.txt"), Planarise(arguments[0]));
            Write(Path.Combine(arguments[1], "cloth.txt"), Cloth());
            return 0;
        }
        catch (Exception error)
        {
            Console.Error.WriteLine(error.Message);
            return 1;
        }
    }

    static double[] Quad()
    {
        using (var solver = new Solver())
        {
            solver.Points = new[] { 0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1 };
            int[] all = { 0, 1, 2, 3 };
            solver.Add("Plane", all);
            solver.Add("Rigid", all, 2, new double[] { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 });
            solver.Add("Closeness", new[] { 0 }, 0.5, new[] { 0, 0, 0.2 });
            solver.Init();
            solver.Solve(25);
            return solver.Points;
        }
    }

    static double[] Planarise(string file)
    {
        List<int[]> faces = ReadMesh(file, out double[] points);
        using (var solver = new Solver())
        {
            solver.Points = points;
            solver.AddMany("Plane", faces);
            for (int point = 0; point < solver.PointCount; point++) solver.Add("Closeness", new[] { point }, 0.05);
            solver.Init();
            solver.Solve(100);
            return solver.Points;
        }
    }

    static double[] Cloth()
    {
        const int side = 20;
        var points = new List<double>();
        var edges = new List<int[]>();
        for (int j = 0; j < side; j++)
        {
            for (int i = 0; i < side; i++)
            {
                int point = side * j + i;
                points.AddRange(new double[] { i, j, 0 });
                if (i < side - 1) edges.Add(new[] { point, point + 1 });
                if (j < side - 1) edges.Add(new[] { point, point + side });
            }
        }
        using (var solver = new Solver())
        {
            solver.Points = points.ToArray();
            solver.AddMany("EdgeStrain", edges, 10, new[] { 1, 0.9, 1.1 });
            int[] handles = solver.AddMany("Closeness", new[] { new[] { 0 }, new[] { 19 }, new[] { 399 } }, 1000);
            solver.AddGravity(0, 0, -1);
            int force = solver.AddVertexForce(380, 0.5, 0, 2);
            solver.InitDynamic(1, 0.95, 0.1);
            for (int step = 1; step <= 60; step++)
            {
                if (step == 11) solver.Edit("Closeness", handles[2], 14, 14, 5);
                if (step == 31) solver.EditVertexForce(force, 380, 0, 0.5, -1);
                solver.Solve(5);
            }
            return solver.Points;
        }
    }

    static List<int[]> ReadMesh(string file, out double[] points)
    {
        var coordinates = new List<double>();
        var faces = new List<int[]>();
        foreach (string line in File.ReadLines(file))
        {
            string[] words = line.Split((char[])null, StringSplitOptions.RemoveEmptyEntries);
            if (words.Length == 4 && words[0] == "v")
            {
                for (int i = 1; i < 4; i++) coordinates.Add(double.Parse(words[i], CultureInfo.InvariantCulture));
            }
            else if (words.Length > 1 && words[0] == "f")
            {
                var face = new int[words.Length - 1];
                for (int i = 0; i < face.Length; i++)
                {
                    face[i] = int.Parse(words[i + 1].Split('/')[0], CultureInfo.InvariantCulture) - 1;
                }
                faces.Add(face);
            }
        }
        points = coordinates.ToArray();
        return faces;
    }

    static void Write(string file, double[] points)
    {
        using (var writer = new StreamWriter(file))
        {
            for (int i = 0; i < points.Length; i += 3)
            {
                // "R" does not always read back as the same double on older runtimes.
                FormattableString line = $"{points[i]:G17} {points[i + 1]:G17} {points[i + 2]:G17}";
                writer.WriteLine(line.ToString(CultureInfo.InvariantCulture));
            }
        }
    }
}
