using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading;
using ShapeOp;

/// <summary>
/// Tests of the .NET binding, as a plain program: each says in its name what would be broken. Mistakes are in
/// Refusals.cs.
/// </summary>
static partial class Tests
{
    static int passed;
    static int failed;

    static int Main()
    {
        Console.WriteLine($"shapeop {Library.Version} on {RuntimeInformation.FrameworkDescription}");
        Statics();
        Dynamics();
        ConstraintsAndForces();
        SolvingUntil();
        Exploring();
        Registry();
        Problems();
        Lifetimes();
        Refusals.All();
        Console.WriteLine($"{passed} passed, {failed} failed");
        return failed == 0 ? 0 : 1;
    }

    internal static void Truth(string name, Action body)
    {
        try
        {
            body();
            passed++;
            Console.WriteLine($"ok      {name}");
        }
        catch (Exception error)
        {
            failed++;
            Console.WriteLine($"FAILED  {name}: {error}");
        }
    }

    internal static void Equal<T>(T expected, T found)
    {
        if (!Equals(expected, found)) throw new Exception($"expected {expected}, found {found}");
    }

    internal static void True(bool condition, string what)
    {
        if (!condition) throw new Exception(what);
    }

    internal static void Near(double[] expected, double[] found, double tolerance)
    {
        Equal(expected.Length, found.Length);
        for (int i = 0; i < expected.Length; i++)
        {
            // Negated, so that it is false for NaN.
            if (!(Math.Abs(expected[i] - found[i]) <= tolerance))
            {
                throw new Exception($"[{i}]: expected {expected[i]:G17}, found {found[i]:G17}");
            }
        }
    }

    internal static double[] Numbers(params double[] numbers) => numbers;

    internal static int[] Indices(params int[] indices) => indices;

    internal static Solver SolverWith(params double[] points)
    {
        return new Solver { Points = points };
    }

    /// <summary>A square whose corners are alternately above and below: the nearest plane is z = 0.</summary>
    internal static Solver BentSquare()
    {
        Solver solver = SolverWith(0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1);
        solver.Add("Plane", Indices(0, 1, 2, 3));
        return solver;
    }

    /// <summary>A wavy grid of quads.</summary>
    internal static double[] Grid(int side, out List<int[]> faces)
    {
        var points = new List<double>();
        faces = new List<int[]>();
        for (int j = 0; j < side; j++)
        {
            for (int i = 0; i < side; i++)
            {
                points.AddRange(new[] { i, j, Math.Sin(1.1 * i) * Math.Cos(0.9 * j) });
                if (i == 0 || j == 0) continue;
                int corner = side * (j - 1) + i - 1;
                faces.Add(new[] { corner, corner + 1, corner + 1 + side, corner + side });
            }
        }
        return points.ToArray();
    }

    static void Statics()
    {
        Truth("points come back as they were set", () =>
        {
            using (Solver solver = SolverWith(1, 2, 3, -1e-300, 1e300, 0.1))
            {
                Near(Numbers(1, 2, 3, -1e-300, 1e300, 0.1), solver.Points, 0);
                Equal(2, solver.PointCount);
            }
        });
        Truth("a bent square is planarised into the plane of its symmetry", () =>
        {
            using (Solver solver = BentSquare())
            {
                solver.Init();
                solver.Solve(1);
                Near(Numbers(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0), solver.Points, 1e-14);
                Near(Numbers(0), solver.Violations, 1e-14);
            }
        });
        Truth("a point between two targets divides their distance by their weights, and has that energy", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0))
            {
                solver.AddMany(
                    "Closeness", new[] { Indices(0), Indices(0) }, Numbers(1, 3),
                    new[] { Numbers(0, 0, 0), Numbers(1, 0, 0) });
                solver.Init();
                solver.Solve(1);
                Near(Numbers(0.75, 0, 0), solver.Points, 1e-15);
                // (1 * 0.75^2 + 3 * 0.25^2) / 2
                Near(Numbers(0.375), Numbers(solver.Energy), 1e-15);
                solver.SetWeights(Indices(0, 1), Numbers(2));
                solver.Solve(1);
                Near(Numbers(0.5, 0, 0), solver.Points, 1e-15);
                solver.SetWeights(Indices(0, 1), Numbers(4, 1));
                solver.Solve(1);
                Near(Numbers(0.2, 0, 0), solver.Points, 1e-15);
                solver.SetWeight(1, 4);
                solver.Solve(1);
                Near(Numbers(0.5, 0, 0), solver.Points, 1e-15);
            }
        });
        Truth("a held point sags by its load over its weight", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0))
            {
                solver.AddMany("Closeness", new[] { Indices(0), Indices(1) }, 4);
                int gravity = solver.AddGravity(0, 0, -1);
                int force = solver.AddVertexForce(1, 0, 2, 0);
                solver.Init();
                solver.Solve(1);
                Near(Numbers(0, 0, -0.25, 1, 0.5, -0.25), solver.Points, 1e-15);
                solver.EditVertexForce(force, 0, 0, 0, 1);
                solver.RemoveForce(gravity);
                solver.Solve(1);
                Near(Numbers(0, 0, 0.25, 1, 0, 0), solver.Points, 1e-15);
                Equal(2, solver.ForceCount);
                Equal(false, solver.IsForce(gravity));
                Equal(true, solver.IsForce(force));
            }
        });
        Truth("the results are the same bits for one thread and for four", () =>
        {
            double[] points = Grid(60, out List<int[]> faces);
            double[][] results = new[] { 1, 4 }.Select(threads =>
            {
                using (Solver solver = SolverWith(points))
                {
                    solver.SetThreadCount(threads);
                    solver.AddMany("Plane", faces);
                    for (int i = 0; i < solver.PointCount; i++) solver.Add("Closeness", Indices(i), 0.1);
                    solver.Init();
                    solver.Solve(10);
                    return solver.Points;
                }
            }).ToArray();
            Near(results[0], results[1], 0);
        });
    }

    static void Dynamics()
    {
        Truth("a free point falls as implicit Euler has it", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0))
            {
                solver.AddGravity(0, 0, -1);
                solver.InitDynamic(1, 1, 0.1);
                solver.Solve(1);
                Near(Numbers(0, 0, -0.01), solver.Points, 1e-15);
                solver.Solve(1);
                Near(Numbers(0, 0, -0.03), solver.Points, 1e-15);
            }
        });
        Truth("with damping 0 a point forgets its velocity", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0))
            {
                solver.AddGravity(0, 0, -1);
                solver.InitDynamic(1, 1, 0.1);
                solver.SetDamping(0);
                solver.Solve(1);
                solver.Solve(1);
                Near(Numbers(0, 0, -0.02), solver.Points, 1e-15);
            }
        });
        Truth("a point with a velocity moves twice as far in a time step of twice the length", () =>
        {
            double[] moves = new[] { 0.1, 0.2 }.Select(timeStep =>
            {
                using (Solver solver = SolverWith(0, 0, 0))
                {
                    int force = solver.AddVertexForce(0, 1, 0, 0);
                    solver.InitDynamic(1, 1, 0.1);
                    solver.Solve(1);
                    solver.RemoveForce(force);
                    double before = solver.Points[0];
                    solver.SetTimeStep(timeStep);
                    solver.Solve(1);
                    return solver.Points[0] - before;
                }
            }).ToArray();
            Near(Numbers(2 * moves[0]), Numbers(moves[1]), 1e-15);
            True(moves[0] > 0, "it does not move");
        });
    }

    static void ConstraintsAndForces()
    {
        Truth("each edge gets its own length", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0))
            {
                int[] ids = solver.AddMany(
                    "EdgeStrain", new[] { Indices(0, 1), Indices(2, 3) }, Numbers(1),
                    new[] { Numbers(2, 1, 1), Numbers(3, 1, 1) });
                Equal("0 1", string.Join(" ", ids));
                solver.Init();
                solver.Solve(100);
                Near(Numbers(-0.5, 0, 0, 1.5, 0, 0, -1, 1, 0, 2, 1, 0), solver.Points, 1e-9);
            }
        });
        Truth("faces of different sizes are added in one call", () =>
        {
            using (Solver solver = SolverWith(0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 1))
            {
                var faces = new List<List<int>> { new List<int> { 0, 1, 2, 3 }, new List<int> { 1, 4, 2 } };
                Equal(2, solver.AddMany("Plane", faces).Length);
                Equal(0, solver.UnconstrainedCount);
                double[] violations = solver.Violations;
                True(violations[0] > 0.1, "the quad is planar");
                Near(Numbers(0), Numbers(violations[1]), 1e-15);
            }
        });
        Truth("one edit moves a target, an edit of many moves each to its own or all to one", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0))
            {
                int[] ids = solver.AddMany("Closeness", new[] { Indices(0), Indices(1) });
                solver.Init();
                solver.Edit("Closeness", ids[1], 5, 6, 7);
                solver.Solve(1);
                Near(Numbers(0, 0, 0, 5, 6, 7), solver.Points, 1e-14);
                solver.EditMany("Closeness", ids, new[] { Numbers(1, 2, 3), Numbers(4, 5, 6) });
                solver.Solve(1);
                Near(Numbers(1, 2, 3, 4, 5, 6), solver.Points, 1e-14);
                solver.EditMany("Closeness", ids, new[] { Numbers(7, 8, 9) });
                solver.Solve(1);
                Near(Numbers(7, 8, 9, 7, 8, 9), solver.Points, 1e-14);
            }
        });
        Truth("shapes of unlike constraints are told apart", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 3, 0, 0, 9, 0, 0, 9, 1, 0, 8, 4, 0))
            {
                double[] edge = Numbers(0, 0, 0, 1, 0, 0);
                double[] triangle = Numbers(0, 0, 0, 1, 0, 0, 0, 1, 0);
                solver.AddMany(
                    "Rigid", new[] { Indices(0, 1), Indices(2, 3, 4) }, Numbers(1), new[] { edge, triangle });
                solver.Init();
                solver.Solve(200);
                Near(Numbers(0, 0), solver.Violations, 1e-9);
                Near(Numbers(1, 0, 0, 2, 0, 0), solver.Points.Take(6).ToArray(), 1e-9);
            }
        });
        Truth("a removed constraint keeps its place and asks for nothing", () =>
        {
            using (Solver solver = BentSquare())
            {
                int closeness = solver.Add("Closeness", Indices(0), 1, Numbers(0, 0, 0));
                solver.Remove(0);
                Equal(2, solver.ConstraintCount);
                Equal(false, solver.IsConstraint(0));
                Equal(true, solver.IsConstraint(closeness));
                Equal(false, solver.IsConstraint(77));
                Near(Numbers(0, 0.1), solver.Violations, 1e-15);
                Equal(3, solver.UnconstrainedCount);
            }
        });
        Truth("an edge of no length is degenerate, another is not", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 0, 0, 0, 1, 0, 0))
            {
                Equal(true, solver.IsDegenerate(solver.Add("EdgeStrain", Indices(0, 1))));
                Equal(false, solver.IsDegenerate(solver.Add("EdgeStrain", Indices(0, 2))));
            }
        });
        Truth("adding no constraints adds none", () =>
        {
            using (Solver solver = BentSquare())
            {
                Equal(0, solver.AddMany("Plane", new int[0][]).Length);
                Equal(1, solver.ConstraintCount);
            }
        });
        Truth("lists, arrays and queries will do", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 0))
            {
                solver.Add("Plane", new List<int> { 0, 1, 2, 3 }, 1);
                solver.Add("Closeness", Enumerable.Range(1, 1), 1, new List<double> { 1, 1, 1 });
                solver.AddMany("Closeness", Enumerable.Range(0, 4).Select(i => Indices(i)));
                Equal(6, solver.ConstraintCount);
            }
        });
    }

    static void Lifetimes()
    {
        Truth("reading points into an array allocates nothing", () =>
        {
            // It is not in netstandard2.0; where it is not there, the count of collections tells.
            MethodInfo count = typeof(GC).GetMethod("GetAllocatedBytesForCurrentThread", new Type[0]);
            Func<long> allocated = count == null
                ? (Func<long>)(() => GC.CollectionCount(0))
                : (Func<long>)Delegate.CreateDelegate(typeof(Func<long>), count);
            using (Solver solver = BentSquare())
            {
                var points = new double[12];
                solver.GetPoints(points);
                long before = allocated();
                for (int i = 0; i < 1000000; i++) solver.GetPoints(points);
                Equal(before, allocated());
            }
        });
        Truth("100000 solvers that nobody disposes of are freed by the collector", () =>
        {
            for (int i = 0; i < 100000; i++)
            {
                new Solver { Points = new double[] { 0, 0, i } };
            }
        });
        Truth("a solver that is disposed of twice, or while it is solving, ends in order", () =>
        {
            Solver solver = SolverWith(Grid(12, out List<int[]> faces));
            solver.AddMany("Plane", faces);
            solver.Init();
            Report report = solver.SolveUntil(new SolveOptions { MaxIterations = 5, Tolerance = 0 }, progress =>
            {
                var other = new Thread(solver.Dispose);
                if (progress.Iteration == 2) other.Start();
                if (progress.Iteration == 2) other.Join();
                return false;
            });
            Equal(5, report.Iterations);
            solver.Dispose();
            solver.Dispose();
        });
        Truth("different solvers run at the same time", () =>
        {
            double[] points = Grid(20, out List<int[]> faces);
            var results = new double[8][];
            Thread[] threads = Enumerable.Range(0, 8).Select(number => new Thread(() =>
            {
                using (Solver solver = SolverWith(points))
                {
                    solver.AddMany("Plane", faces);
                    solver.Init();
                    solver.Solve(50);
                    results[number] = solver.Points;
                }
            })).ToArray();
            foreach (Thread thread in threads) thread.Start();
            foreach (Thread thread in threads) thread.Join();
            foreach (double[] result in results) Near(results[0], result, 0);
        });
    }
}
