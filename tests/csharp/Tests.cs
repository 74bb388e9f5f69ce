using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading;
using ShapeOp;

/// <summary>
/// Tests of the .NET binding, as a plain program: each says in its name what would be broken. Mistakes are in Refusals.cs.
/// </summary>
static class Tests
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

    static void SolvingUntil()
    {
        Truth("a solve until rest converges, lowers the energy and reports it", () =>
        {
            double[] points = Grid(12, out List<int[]> faces);
            using (Solver solver = SolverWith(points))
            {
                solver.AddMany("Plane", faces);
                solver.AddMany("Closeness", Enumerable.Range(0, 144).Select(i => Indices(i)), 0.05);
                solver.Init();
                double before = solver.Energy;
                int calls = 0;
                double last = 0;
                Report report = solver.SolveUntil(null, progress =>
                {
                    calls++;
                    Equal(calls, progress.Iteration);
                    last = progress.Energy;
                    return false;
                });
                Equal(Outcome.Converged, report.Outcome);
                Equal(calls, report.Iterations);
                True(report.LargestMove < new SolveOptions().Tolerance, "it moves on");
                Near(Numbers(before, solver.Energy), Numbers(report.EnergyBefore, report.EnergyAfter), 1e-12);
                Near(Numbers(last), Numbers(report.EnergyAfter), 0);
                True(report.EnergyAfter < 0.5 * report.EnergyBefore, "the energy hardly fell");
                Equal(LinearSolver.Direct, report.LinearSolver);
                Equal(1, report.FactorisationCount);
                Equal(null, report.Message);
            }
        });
        Truth("options end a solve: iterations, time, tolerance", () =>
        {
            using (Solver solver = SolverWith(Grid(12, out List<int[]> faces)))
            {
                solver.AddMany("Plane", faces);
                solver.Init();
                Report report = solver.SolveUntil(new SolveOptions { MaxIterations = 3, Tolerance = 0 });
                Equal(Outcome.IterationLimit, report.Outcome);
                Equal(3, report.Iterations);
                report = solver.SolveUntil(new SolveOptions { Tolerance = 0, TimeBudgetSeconds = 1e-9 });
                Equal(Outcome.TimeBudget, report.Outcome);
                report = solver.SolveUntil(new SolveOptions { Tolerance = 1e9 });
                Equal(Outcome.Converged, report.Outcome);
                Equal(1, report.Iterations);
            }
        });
        Truth("without acceleration there is one evaluation per iteration", () =>
        {
            using (Solver solver = SolverWith(Grid(12, out List<int[]> faces)))
            {
                solver.AddMany("Plane", faces);
                solver.SetAcceleration(Acceleration.None);
                solver.Init();
                Report report = solver.SolveUntil(new SolveOptions { MaxIterations = 7, Tolerance = 0 });
                Equal(7, report.Evaluations);
            }
        });
        Truth("conjugate gradients reach the points of the factor", () =>
        {
            double[] points = Grid(20, out List<int[]> faces);
            double[][] results = new[] { LinearSolver.Direct, LinearSolver.ConjugateGradients }.Select(kind =>
            {
                using (Solver solver = SolverWith(points))
                {
                    solver.AddMany("Plane", faces);
                    solver.AddMany("Closeness", Enumerable.Range(0, 400).Select(i => Indices(i)), 0.05);
                    solver.SetLinearSolver(kind);
                    solver.Init();
                    Report report = solver.SolveUntil(new SolveOptions { MaxIterations = 5, Tolerance = 0 });
                    Equal(kind, report.LinearSolver);
                    Equal(kind == LinearSolver.ConjugateGradients, report.LinearIterations > 0);
                    return solver.Points;
                }
            }).ToArray();
            Near(results[0], results[1], 1e-8);
        });
        Truth("a load that nothing resists is the outcome unbounded, and the report says which", () =>
        {
            using (Solver solver = BentSquare())
            {
                double[] before = solver.Points;
                solver.AddGravity(0, 0, -1);
                solver.Init();
                Report report = solver.SolveUntil();
                Equal(Outcome.Unbounded, report.Outcome);
                True(report.Message.Length > 0, "no message");
                Near(before, solver.Points, 0);
            }
        });
        Truth("the function of a solve ends it where it says, and can read the solver", () =>
        {
            using (Solver solver = SolverWith(Grid(12, out List<int[]> faces)))
            {
                solver.AddMany("Plane", faces);
                solver.Init();
                var buffer = new double[3 * solver.PointCount];
                Report report = solver.SolveUntil(null, progress =>
                {
                    solver.GetPoints(buffer);
                    Near(Numbers(progress.Energy), Numbers(solver.Energy), 1e-12);
                    Equal(faces.Count, solver.Violations.Length);
                    return progress.Iteration == 2;
                });
                Equal(Outcome.Cancelled, report.Outcome);
                Equal(2, report.Iterations);
                Near(buffer, solver.Points, 0);
            }
        });
        Truth("an exception of that function ends the solve and arrives as it was thrown", () =>
        {
            using (Solver solver = SolverWith(Grid(12, out List<int[]> faces)))
            {
                solver.AddMany("Plane", faces);
                solver.Init();
                int calls = 0;
                var thrown = new InvalidOperationException("enough");
                try
                {
                    solver.SolveUntil(null, progress => ++calls == 2 ? throw thrown : false);
                    throw new Exception("nothing arrived");
                }
                catch (InvalidOperationException error)
                {
                    True(ReferenceEquals(thrown, error), "another exception");
                }
                Equal(2, calls);
                Equal(Outcome.Converged, solver.SolveUntil().Outcome);
            }
        });
        Truth("the collector may run inside that function", () =>
        {
            using (Solver solver = SolverWith(Grid(12, out List<int[]> faces)))
            {
                solver.AddMany("Plane", faces);
                solver.Init();
                Report report = solver.SolveUntil(new SolveOptions { MaxIterations = 20, Tolerance = 0 }, progress =>
                {
                    GC.Collect();
                    GC.WaitForPendingFinalizers();
                    return false;
                });
                Equal(20, report.Iterations);
            }
        });
    }

    static void Registry()
    {
        Truth("every type of the registry is described, and can be added with its least number of points", () =>
        {
            True(ConstraintType.All.Count >= 18, "types are missing");
            // Fixed: in general position.
            var random = new Random(7);
            double[] points = Enumerable.Range(0, 3 * 16).Select(_ => random.NextDouble()).ToArray();
            foreach (ConstraintType type in ConstraintType.All)
            {
                True(type.Help.Length > 0 && type.ViolationUnit.Length > 0, $"{type.Name} is not described");
                True(type.Scalars.All(scalar => scalar.Name.Length > 0), $"{type.Name} has a scalar without a name");
                True(ReferenceEquals(type, ConstraintType.Find(type.Name)), $"{type.Name} is not found");
                using (Solver solver = SolverWith(points))
                {
                    solver.Add(type.Name, Enumerable.Range(0, type.LeastIndices));
                    if (type.GreatestIndices == null) continue;
                    Refusals.Refused(
                        ErrorCode.InvalidArgumentLength, type.Name,
                        () => solver.Add(type.Name, Enumerable.Range(0, type.GreatestIndices.Value + 1)));
                }
            }
        });
        Truth("the description of a type says its points and scalars", () =>
        {
            ConstraintType strain = ConstraintType.Find("EdgeStrain");
            Equal(2, strain.LeastIndices);
            Equal(2, strain.GreatestIndices);
            Equal(3, strain.Scalars.Count);
            // The length is that of the edge when it is added.
            Equal(null, strain.Scalars[0].Default);
            Equal(false, strain.TakesShapes);
            ConstraintType rigid = ConstraintType.Find("Rigid");
            Equal(true, rigid.TakesShapes);
            Equal(0, rigid.Scalars.Count);
            Equal("Similarity", rigid.EditedAs);
            Equal(null, rigid.GreatestIndices);
            Equal(Projection.Nearest, ConstraintType.Find("Plane").Projection);
            Equal(null, ConstraintType.Find("Plain"));
            Equal(null, ConstraintType.Find(null));
        });
    }

    static void Problems()
    {
        const string json = @"{""version"": 1, ""points"": [[0, 0, 0]], ""extra"": {""author"": ""Žofie 李""},
            ""constraints"": [{""type"": ""Closeness"", ""indices"": [0], ""scalars"": [1, 2, 3]}],
            ""settings"": {""max_iterations"": 17, ""tolerance"": 0.5, ""time_budget_seconds"": 9}}";
        Truth("a problem in JSON replaces everything, is ready to solve, and brings its settings", () =>
        {
            using (Solver solver = BentSquare())
            {
                SolveOptions options = solver.SetProblem(json);
                Equal(17, options.MaxIterations);
                Equal(0.5, options.Tolerance);
                Equal(9.0, options.TimeBudgetSeconds);
                Equal(1, solver.PointCount);
                Equal(1, solver.ConstraintCount);
                solver.SolveUntil(options);
                Near(Numbers(1, 2, 3), solver.Points, 1e-14);
            }
        });
        Truth("the canonical form is that of itself, and keeps letters of all scripts", () =>
        {
            string canonical = Problem.Canonical(json);
            Equal(canonical, Problem.Canonical(canonical));
            True(canonical.Contains("Žofie 李"), canonical);
        });
        double[] points = Grid(9, out List<int[]> faces);
        Truth("every recipe makes a problem that can be solved and lowers its energy", () =>
        {
            True(Problem.Recipes.Contains("planarize") && Problem.Recipes.Count >= 5, "recipes are missing");
            foreach (string recipe in Problem.Recipes)
            {
                using (var solver = new Solver())
                {
                    // "smooth" asks for fairness.
                    var recipeOptions = new RecipeOptions { Fairness = 0.1 };
                    SolveOptions options = solver.SetProblem(Problem.FromRecipe(recipe, points, faces, recipeOptions));
                    Near(points, solver.Points, 0);
                    Report report = solver.SolveUntil(options);
                    True(report.EnergyAfter < report.EnergyBefore, $"{recipe}: the energy did not fall");
                }
            }
        });
        Truth("planarising makes the worst face ten times as planar, and leaves anchors where they were", () =>
        {
            using (var solver = new Solver())
            {
                var options = new RecipeOptions { Closeness = 0.001, Anchors = new List<int> { 40, 3 } };
                solver.SolveUntil(solver.SetProblem(Problem.FromRecipe("planarize", points, faces, options)));
                double[] reached = solver.Points;
                double before = Measure.Faces("planarity", points, faces).Max();
                double after = Measure.Faces("planarity", reached, faces).Max();
                True(after < 0.1 * before, $"{before} before, {after} after");
                double length = Measure.Faces("mean_edge", points, faces).Average();
                Near(points.Skip(120).Take(3).ToArray(), reached.Skip(120).Take(3).ToArray(), 1e-3 * length);
                Near(points.Skip(9).Take(3).ToArray(), reached.Skip(9).Take(3).ToArray(), 1e-3 * length);
            }
        });
        Truth("options of a recipe arrive in its problem", () =>
        {
            string plain = Problem.FromRecipe("equalize", points, faces);
            Action<Action<RecipeOptions>> changes = set =>
            {
                var options = new RecipeOptions();
                set(options);
                True(plain != Problem.FromRecipe("equalize", points, faces, options), "nothing changed");
            };
            Equal(plain, Problem.FromRecipe("equalize", points, faces, new RecipeOptions()));
            changes(options => options.Weight = 2);
            changes(options => options.Closeness = 0.5);
            changes(options => options.Fairness = 0.5);
            changes(options => options.Length = 3);
            changes(options => options.Anchors = Indices(1));
            changes(options => options.AnchorBoundary = true);
            changes(options => options.AnchorCorners = true);
            var smoothing = new RecipeOptions { Fairness = 0.5, IsSmoothing = true };
            var keeping = new RecipeOptions { Fairness = 0.5 };
            True(
                Problem.FromRecipe("equalize", points, faces, smoothing) !=
                Problem.FromRecipe("equalize", points, faces, keeping), "smoothing changed nothing");
        });
        Truth("the diagonals of a bent unit square pass each other at its bend over their length", () =>
        {
            // Diagonals of length sqrt(2), one at z = 0.1, the other at z = -0.1.
            double[] square = Numbers(0, 0, 0.1, 1, 0, -0.1, 1, 1, 0.1, 0, 1, -0.1);
            double[] found = Measure.Faces("planarity", square, new[] { Indices(0, 1, 2, 3) });
            Near(Numbers(0.2 / Math.Sqrt(2)), found, 1e-15);
        });
        Truth("every measure gives a finite number for each face", () =>
        {
            True(Measure.All.Count >= 5, "measures are missing");
            foreach (string measure in Measure.All)
            {
                double[] found = Measure.Faces(measure, points, faces);
                Equal(faces.Count, found.Length);
                True(found.All(number => number >= 0 && !double.IsInfinity(number)), measure);
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
