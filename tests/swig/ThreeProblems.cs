using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;

/// <summary>Three problems (tests/languages/README.md) through the SWIG classes: MESH FOLDER.</summary>
public static class ThreeProblems
{
    static doubleArray Doubles(params double[] values)
    {
        var array = new doubleArray(values.Length);
        for (int i = 0; i < values.Length; i++) array.setitem(i, values[i]);
        return array;
    }

    static intArray Ints(params int[] values)
    {
        var array = new intArray(values.Length);
        for (int i = 0; i < values.Length; i++) array.setitem(i, values[i]);
        return array;
    }

    static void Check(SWIGTYPE_p_ShapeOpSolver op, bool isDone)
    {
        if (!isDone) throw new InvalidOperationException(shapeopCSharp.shapeop_lastError(op));
    }

    static SWIGTYPE_p_ShapeOpSolver Start(params double[] points)
    {
        var op = shapeopCSharp.shapeop_create();
        shapeopCSharp.shapeop_setPoints(op, Doubles(points).cast(), points.Length / 3);
        Check(op, shapeopCSharp.shapeop_lastError(op) == "");
        return op;
    }

    static int Add(SWIGTYPE_p_ShapeOpSolver op, string type, double weight, params int[] ids)
    {
        int constraint = shapeopCSharp.shapeop_addConstraint(op, type, Ints(ids).cast(), ids.Length, weight);
        Check(op, constraint >= 0);
        return constraint;
    }

    static void Edit(SWIGTYPE_p_ShapeOpSolver op, string type, int constraint, params double[] scalars)
    {
        var error = shapeopCSharp.shapeop_editConstraint(op, type, constraint, Doubles(scalars).cast(), scalars.Length);
        Check(op, error == shapeop_err.SO_SUCCESS);
    }

    static void Solve(SWIGTYPE_p_ShapeOpSolver op, uint iterations)
    {
        Check(op, shapeopCSharp.shapeop_solve(op, iterations) == 0);
    }

    /// <summary>Writes the points and deletes the solver.</summary>
    static void Finish(SWIGTYPE_p_ShapeOpSolver op, int pointCount, string path)
    {
        var points = new doubleArray(3 * pointCount);
        shapeopCSharp.shapeop_getPoints(op, points.cast(), pointCount);
        Check(op, shapeopCSharp.shapeop_lastError(op) == "");
        using (var file = new StreamWriter(path))
        {
            Func<int, string> text = i => points.getitem(i).ToString("G17", CultureInfo.InvariantCulture);
            for (int i = 0; i < 3 * pointCount; i += 3)
            {
                file.Write(text(i) + " " + text(i + 1) + " " + text(i + 2) + "\n");
            }
        }
        shapeopCSharp.shapeop_delete(op);
    }

    static void Quad(string path)
    {
        var op = Start(0, 0, 0.3, 1.2, 0, 0, 1, 1, 0.4, 0, 1.1, -0.1);
        Add(op, "Plane", 1, 0, 1, 2, 3);
        int rigid = Add(op, "Rigid", 2, 0, 1, 2, 3);
        Edit(op, "Rigid", rigid, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0);
        int closeness = Add(op, "Closeness", 0.5, 0);
        Edit(op, "Closeness", closeness, 0, 0, 0.2);
        Check(op, shapeopCSharp.shapeop_init(op) == 0);
        Solve(op, 25);
        Finish(op, 4, path);
    }

    static void Planarise(string mesh, string path)
    {
        var points = new List<double>();
        var faces = new List<int[]>();
        foreach (var line in File.ReadAllLines(mesh))
        {
            var words = line.Split(new[] { ' ', '\t' }, StringSplitOptions.RemoveEmptyEntries);
            if (words.Length > 0 && words[0] == "v")
            {
                for (int i = 1; i <= 3; i++) points.Add(double.Parse(words[i], CultureInfo.InvariantCulture));
            }
            else if (words.Length > 0 && words[0] == "f")
            {
                var face = new int[words.Length - 1];
                for (int i = 0; i < face.Length; i++) face[i] = int.Parse(words[i + 1]) - 1;
                faces.Add(face);
            }
        }
        int pointCount = points.Count / 3;
        var op = Start(points.ToArray());
        foreach (var face in faces) Add(op, "Plane", 1, face);
        for (int i = 0; i < pointCount; i++) Add(op, "Closeness", 0.05, i);
        Check(op, shapeopCSharp.shapeop_init(op) == 0);
        Solve(op, 100);
        Finish(op, pointCount, path);
    }

    static void AddEdge(SWIGTYPE_p_ShapeOpSolver op, int from, int to)
    {
        Edit(op, "EdgeStrain", Add(op, "EdgeStrain", 10, from, to), 1, 0.9, 1.1);
    }

    static void Cloth(string path)
    {
        const int size = 20;
        var points = new double[3 * size * size];
        for (int point = 0; point < size * size; point++)
        {
            points[3 * point] = point % size;
            points[3 * point + 1] = point / size;
        }
        var op = Start(points);
        for (int j = 0; j < size; j++)
        {
            for (int i = 0; i < size; i++)
            {
                int point = size * j + i;
                if (i < size - 1) AddEdge(op, point, point + 1);
                if (j < size - 1) AddEdge(op, point, point + size);
            }
        }
        Add(op, "Closeness", 1000, 0);
        Add(op, "Closeness", 1000, 19);
        int corner = Add(op, "Closeness", 1000, 399);
        Check(op, shapeopCSharp.shapeop_addGravityForce(op, Doubles(0, 0, -1).cast()) >= 0);
        int pull = shapeopCSharp.shapeop_addVertexForce(op, Doubles(0.5, 0, 2).cast(), 380);
        Check(op, pull >= 0);
        Check(op, shapeopCSharp.shapeop_initDynamic(op, 1, 0.95, 0.1) == 0);
        for (int step = 1; step <= 60; step++)
        {
            if (step == 11) Edit(op, "Closeness", corner, 14, 14, 5);
            if (step == 31)
            {
                shapeopCSharp.shapeop_editVertexForce(op, pull, Doubles(0, 0.5, -1).cast(), 380);
                Check(op, shapeopCSharp.shapeop_lastError(op) == "");
            }
            Solve(op, 5);
        }
        Finish(op, size * size, path);
    }

    public static int Main(string[] arguments)
    {
        if (arguments.Length != 2)
        {
            Console.Error.WriteLine("usage: ThreeProblems.exe MESH FOLDER");
            return 2;
        }
        Quad(Path.Combine(arguments[1], "quad.txt"));
        Planarise(arguments[0], Path.Combine(arguments[1], "planarise.txt"));
        Cloth(Path.Combine(arguments[1], "cloth.txt"));
        return 0;
    }
}
