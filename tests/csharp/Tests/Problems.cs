using System;
using System.Collections.Generic;
using System.Linq;
using ShapeOp;

/// <summary>The registry of constraint types; problems as JSON, recipes, measures.</summary>
static partial class Tests
{
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
                    // Types that refer to a shape take the first of its kind unless they are told.
                    solver.AddReferencePolyline(points);
                    solver.AddReferenceMesh(points, new[] { Indices(0, 1, 2) });
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
        Truth("every recipe makes a problem whose energy falls, or whose hard constraints are met to round-off", () =>
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
                    if (solver.IsHard(0))
                    {
                        // Within the recipe's tolerance, 1e-9 of the size of 12; it costs energy.
                        double worst = solver.Exploration.LargestViolation;
                        True(worst < 1.2e-8, $"{recipe}: {worst} from what is hard");
                        continue;
                    }
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
}
