using System;
using System.Collections.Generic;
using System.Threading;
using ShapeOp;
using static Tests;

/// <summary>Mistakes: each is answered with an exception that says what is wrong, and changes nothing.</summary>
static class Refusals
{
    /// <summary>The call is refused with that code (null: none) and a message that has that part.</summary>
    internal static void Refused(ErrorCode code, string part, Action call)
    {
        try
        {
            call();
        }
        catch (ShapeOpException error)
        {
            Equal(code, error.Code);
            True(error.Message.Contains(part), $"expected a message with \"{part}\", found \"{error.Message}\"");
            return;
        }
        throw new Exception($"expected a refusal with \"{part}\", found none");
    }

    internal static void All()
    {
        Points();
        Constraints();
        ListsOfThem();
        Numbers();
        Texts();
        Exploring();
        Disposed();
        Busy();
    }

    static void Points()
    {
        Truth("points that are null, incomplete or not finite are refused, and the old ones stay", () =>
        {
            using (Solver solver = BentSquare())
            {
                double[] before = solver.Points;
                Refused(ErrorCode.NullPointer, "points is null", () => solver.Points = null);
                Refused(
                    ErrorCode.InvalidArgumentLength, "points: expected 3 numbers for each point, found 13 numbers",
                    () => solver.Points = new double[13]);
                var wrong = (double[])before.Clone();
                foreach (double number in new[] { double.NaN, double.PositiveInfinity })
                {
                    wrong[7] = number;
                    Refused(ErrorCode.InvalidValue, "points", () => solver.Points = wrong);
                }
                Refused(ErrorCode.InvalidArgumentLength, "number of points", () => solver.Points = new double[9]);
                Near(before, solver.Points, 0);
            }
        });
        Truth("an array of another length is not filled with points", () =>
        {
            using (Solver solver = BentSquare())
            {
                var points = new double[9];
                Refused(ErrorCode.InvalidArgumentLength, "4", () => solver.GetPoints(points));
                Near(new double[9], points, 0);
                Refused(ErrorCode.NullPointer, "points is null", () => solver.GetPoints(null));
            }
        });
    }

    static void Constraints()
    {
        Truth("a wrong type, index, number of indices, weight or scalar is refused, and nothing is added", () =>
        {
            using (Solver solver = BentSquare())
            {
                int[] quad = Indices(0, 1, 2, 3);
                Refused(ErrorCode.InvalidConstraintType, "Plain", () => solver.Add("Plain", quad));
                Refused(ErrorCode.InvalidConstraintType, "", () => solver.Add("", quad));
                Refused(ErrorCode.NullPointer, "type is null", () => solver.Add(null, quad));
                Refused(ErrorCode.IndexOutOfRange, "5000", () => solver.Add("Plane", Indices(0, 1, 2, 5000)));
                Refused(ErrorCode.IndexOutOfRange, "-1", () => solver.Add("Plane", Indices(0, 1, 2, -1)));
                Refused(ErrorCode.InvalidArgumentLength, "Plane", () => solver.Add("Plane", Indices(0, 1)));
                Refused(ErrorCode.InvalidArgumentLength, "Plane", () => solver.Add("Plane", Indices()));
                Refused(ErrorCode.NullPointer, "indices is null", () => solver.Add("Plane", null));
                foreach (double weight in new[] { -1, double.NaN, double.NegativeInfinity })
                {
                    Refused(ErrorCode.InvalidValue, "weight", () => solver.Add("Plane", quad, weight));
                }
                Refused(
                    ErrorCode.InvalidArgumentLength, "2",
                    () => solver.Add("Closeness", Indices(0), 1, Tests.Numbers(1, 2)));
                Refused(
                    ErrorCode.InvalidValue, "NaN",
                    () => solver.Add("Closeness", Indices(0), 1, Tests.Numbers(1, 2, double.NaN)));
                Equal(1, solver.ConstraintCount);
            }
        });
        Truth("an edit of another type, of no constraint or with wrong scalars is refused, and changes nothing", () =>
        {
            using (Solver solver = BentSquare())
            {
                int id = solver.Add("Closeness", Indices(0));
                Refused(ErrorCode.UnmatchingConstraintId, "0", () => solver.Edit("Closeness", 0, 1, 2, 3));
                Refused(ErrorCode.UnmatchingConstraintId, "9", () => solver.Edit("Closeness", 9, 1, 2, 3));
                Refused(ErrorCode.InvalidConstraintType, "Plane", () => solver.Edit("Plane", 0, 1));
                Refused(ErrorCode.InvalidArgumentLength, "2", () => solver.Edit("Closeness", id, 1, 2));
                Refused(ErrorCode.InvalidValue, "NaN", () => solver.Edit("Closeness", id, 1, 2, double.NaN));
                Refused(ErrorCode.NullPointer, "scalars is null", () => solver.Edit("Closeness", id, null));
                Refused(ErrorCode.NullPointer, "type is null", () => solver.Edit(null, id, 1, 2, 3));
                Refused(
                    ErrorCode.UnmatchingConstraintId, "9",
                    () => solver.EditMany("Closeness", Indices(id, 9), new[] { Tests.Numbers(1, 2, 3) }));
                Refused(ErrorCode.NullPointer, "ids is null", () => solver.EditMany("Closeness", null, new double[0][]));
                Refused(ErrorCode.NullPointer, "scalars is null", () => solver.EditMany("Closeness", Indices(id), null));
                Near(Tests.Numbers(0), new[] { solver.Violations[id] }, 0);
            }
        });
        Truth("weights and removals of no constraint, and forces of no point, are refused", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.UnmatchingConstraintId, "1", () => solver.SetWeight(1, 2));
                Refused(ErrorCode.InvalidValue, "-2", () => solver.SetWeight(0, -2));
                Refused(
                    ErrorCode.UnmatchingConstraintId, "1",
                    () => solver.SetWeights(Indices(0, 1), Tests.Numbers(2)));
                Refused(
                    ErrorCode.InvalidArgumentLength, "2",
                    () => solver.SetWeights(Indices(0, 0, 0), Tests.Numbers(2, 2)));
                Refused(ErrorCode.NullPointer, "weights is null", () => solver.SetWeights(Indices(0), null));
                Refused(ErrorCode.UnmatchingConstraintId, "1", () => solver.Remove(1));
                Refused(ErrorCode.UnmatchingConstraintId, "1", () => solver.IsDegenerate(1));
                Refused(ErrorCode.IndexOutOfRange, "4", () => solver.AddVertexForce(4, 0, 0, 1));
                Refused(ErrorCode.InvalidValue, "NaN", () => solver.AddGravity(0, double.NaN, 0));
                int force = solver.AddVertexForce(0, 0, 0, 1);
                Refused(ErrorCode.IndexOutOfRange, "4", () => solver.EditVertexForce(force, 4, 0, 0, 1));
                Refused(ErrorCode.UnmatchingForceId, "7", () => solver.EditVertexForce(7, 0, 0, 0, 1));
                Refused(ErrorCode.UnmatchingForceId, "7", () => solver.RemoveForce(7));
                Equal(1, solver.ForceCount);
            }
        });
    }

    static void ListsOfThem()
    {
        Truth("one wrong constraint among many is named, and none is added", () =>
        {
            using (Solver solver = BentSquare())
            {
                int[][] faces = { Indices(0, 1, 2), Indices(1, 2, 3), Indices(0, 2, 44) };
                Refused(ErrorCode.IndexOutOfRange, "constraint 3", () => solver.AddMany("Plane", faces));
                faces[2] = null;
                Refused(ErrorCode.NullPointer, "indices[2] is null", () => solver.AddMany("Plane", faces));
                Refused(ErrorCode.NullPointer, "indices is null", () => solver.AddMany("Plane", null));
                Equal(1, solver.ConstraintCount);
            }
        });
        Truth("numbers of weights or scalars that are neither one nor one for each are refused", () =>
        {
            using (Solver solver = BentSquare())
            {
                int[][] three = { Indices(0), Indices(1), Indices(2) };
                Refused(
                    ErrorCode.InvalidArgumentLength, "2",
                    () => solver.AddMany("Closeness", three, Tests.Numbers(1, 2)));
                Refused(ErrorCode.NullPointer, "weights is null", () => solver.AddMany("Closeness", three, null, null));
                double[][] two = { Tests.Numbers(1, 2, 3), Tests.Numbers(1, 2, 3) };
                Refused(
                    ErrorCode.InvalidArgumentLength, "2",
                    () => solver.AddMany("Closeness", three, Tests.Numbers(1), two));
                Equal(1, solver.ConstraintCount);
            }
        });
        Truth("lists of scalars whose lengths only add up are refused", () =>
        {
            using (Solver solver = BentSquare())
            {
                int[] ids = solver.AddMany("Closeness", new[] { Indices(0), Indices(1) });
                double[][] uneven = { Tests.Numbers(1, 2), Tests.Numbers(3, 4, 5, 6) };
                Refused(
                    ErrorCode.InvalidArgumentLength, "scalars[1]",
                    () => solver.AddMany("Closeness", new[] { Indices(0), Indices(1) }, Tests.Numbers(1), uneven));
                Refused(
                    ErrorCode.InvalidArgumentLength, "scalars[1]", () => solver.EditMany("Closeness", ids, uneven));
                double[][] shapes = { new double[9], new double[6] };
                Refused(
                    ErrorCode.InvalidArgumentLength, "scalars[1]",
                    () => solver.AddMany("Rigid", new[] { Indices(0, 1), Indices(1, 2, 3) }, Tests.Numbers(1), shapes));
                Equal(3, solver.ConstraintCount);
            }
        });
    }

    static void Numbers()
    {
        Truth("numbers outside their domain are refused", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.InvalidValue, "masses", () => solver.InitDynamic(0, 1, 1));
                Refused(ErrorCode.InvalidValue, "damping", () => solver.InitDynamic(1, -1, 1));
                Refused(ErrorCode.InvalidValue, "timestep", () => solver.InitDynamic(1, 1, double.NaN));
                solver.Init();
                Refused(ErrorCode.InvalidValue, "-1", () => solver.SetTimeStep(-1));
                Refused(ErrorCode.InvalidValue, "-1", () => solver.SetDamping(-1));
                Refused(ErrorCode.InvalidArgumentLength, "threads", () => solver.SetThreadCount(-1));
                Refused(ErrorCode.InvalidValue, "-1", () => solver.SetAcceleration(Acceleration.Anderson, -1));
                Refused(ErrorCode.InvalidValue, "65", () => solver.SetAcceleration(Acceleration.Anderson, 65));
                Refused(ErrorCode.InvalidValue, "99", () => solver.SetAcceleration((Acceleration)99));
                Refused(ErrorCode.InvalidValue, "99", () => solver.SetLinearSolver((LinearSolver)99));
                Refused(ErrorCode.InvalidValue, "99", () => solver.Backend = (Backend)99);
                Refused(ErrorCode.InvalidValue, "binding_bytes", () => solver.SetBackendOptions("", -1));
                Refused(ErrorCode.InvalidInput, "adapter", () => solver.SetBackendOptions("a\0b"));
                // The libraries that these tests run with are built without the feature.
                Refused(ErrorCode.BackendUnavailable, "feature", () => solver.Backend = Backend.Gpu);
                Refused(ErrorCode.BackendUnavailable, "feature", () => solver.GetBackendInfo());
                Equal(Backend.Cpu, solver.Backend);
                solver.Backend = Backend.Automatic;
                Equal(Backend.Automatic, solver.Backend);
                BackendInfo.Release();
                Refused(ErrorCode.InvalidValue, "iterations: expected at least 0, found -5", () => solver.Solve(-5));
                Refused(
                    ErrorCode.InvalidValue, "MaxIterations",
                    () => solver.SolveUntil(new SolveOptions { MaxIterations = -1 }));
                Refused(
                    ErrorCode.InvalidValue, "tolerance",
                    () => solver.SolveUntil(new SolveOptions { Tolerance = double.NaN }));
                Refused(
                    ErrorCode.InvalidValue, "time",
                    () => solver.SolveUntil(new SolveOptions { TimeBudgetSeconds = -1 }));
            }
        });
        Truth("a solver that is not initialised does not solve", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.NotInitialised, "init", () => solver.Solve(1));
                Refused(ErrorCode.NotInitialised, "init", () => solver.SolveUntil());
            }
        });
        Truth("a refusal is forgotten with the next call that succeeds", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.InvalidArgumentLength, "points", () => solver.GetPoints(new double[3]));
                solver.GetPoints(new double[12]);
            }
        });
    }

    static void Texts()
    {
        Truth("a wrong problem is refused with the place in its text, and the solver stays as it was", () =>
        {
            const string wrong = @"{""version"": 1, ""points"": [[0, 0, 0]],
                ""constraints"": [{""type"": ""Closeness"", ""indices"": [7]}]}";
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.IndexOutOfRange, "constraints[0]", () => solver.SetProblem(wrong));
                Refused(ErrorCode.IndexOutOfRange, "constraints[0]", () => Problem.Canonical(wrong));
                Refused(ErrorCode.InvalidInput, "", () => solver.SetProblem("{"));
                Refused(ErrorCode.InvalidInput, "", () => solver.SetProblem(""));
                Refused(ErrorCode.NullPointer, "json is null", () => solver.SetProblem(null));
                Refused(ErrorCode.NullPointer, "json is null", () => Problem.Canonical(null));
                Equal(4, solver.PointCount);
                Equal(1, solver.ConstraintCount);
            }
        });
        Truth("a text with a zero character is not cut off there", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(
                    ErrorCode.InvalidInput, "type: expected a text without zero characters, found one at 5",
                    () => solver.Add("Plane\0s", Indices(0, 1, 2)));
            }
        });
        Truth("a message has the letters that it complains of", () =>
        {
            using (Solver solver = BentSquare())
            {
                Refused(ErrorCode.InvalidConstraintType, "Plán 李", () => solver.Add("Plán 李", Indices(0, 1, 2)));
            }
        });
        double[] points = Grid(3, out List<int[]> faces);
        Truth("a wrong recipe, measure, mesh or option is refused", () =>
        {
            Refused(ErrorCode.InvalidValue, "planarise", () => Problem.FromRecipe("planarise", points, faces));
            Refused(ErrorCode.IndexOutOfRange, "9", () => Problem.FromRecipe("planarize", points, new[] { Indices(0, 1, 9) }));
            Refused(ErrorCode.NullPointer, "points is null", () => Problem.FromRecipe("planarize", null, faces));
            Refused(ErrorCode.NullPointer, "faces is null", () => Problem.FromRecipe("planarize", points, null));
            Refused(
                ErrorCode.NullPointer, "faces[0] is null",
                () => Problem.FromRecipe("planarize", points, new List<int[]> { null }));
            Refused(ErrorCode.IndexOutOfRange, "77", () => Problem.FromRecipe(
                "planarize", points, faces, new RecipeOptions { Anchors = Indices(77) }));
            Refused(ErrorCode.InvalidValue, "weight", () => Problem.FromRecipe(
                "planarize", points, faces, new RecipeOptions { Weight = -1 }));
            Refused(ErrorCode.InvalidValue, "length", () => Problem.FromRecipe(
                "planarize", points, faces, new RecipeOptions { Length = 3 }));
            Refused(ErrorCode.NullPointer, "Anchors is null", () => Problem.FromRecipe(
                "planarize", points, faces, new RecipeOptions { Anchors = null }));
            Refused(ErrorCode.InvalidValue, "area", () => Measure.Faces("area", points, faces));
            Refused(
                ErrorCode.IndexOutOfRange, "-1", () => Measure.Faces("planarity", points, new[] { Indices(0, 1, -1) }));
            Refused(
                ErrorCode.InvalidArgumentLength, "points: expected 3 numbers for each point, found 26 numbers",
                () => Measure.Faces("planarity", new double[26], faces));
        });
    }

    static void Exploring()
    {
        Truth("what cannot be explored is named and changes nothing", () =>
        {
            using (Solver solver = BentSquare())
            {
                var triangle = new[] { Indices(0, 1, 2) };
                Refused(ErrorCode.UnmatchingConstraintId, "77", () => solver.SetHard(77));
                Refused(
                    ErrorCode.InvalidValue, "cannot be hard", () => solver.Add("EdgeStrain", Indices(0, 0), hard: true));
                Refused(ErrorCode.IndexOutOfRange, "4 is out of range for 4 points", () => solver.SetHandle(4, 0, 0, 0));
                Refused(ErrorCode.InvalidValue, "target", () => solver.SetHandle(0, 0, double.NaN, 0));
                Refused(ErrorCode.InvalidValue, "point 2 is no handle", () => solver.ReleaseHandle(2));
                Refused(ErrorCode.NullPointer, "objective is null", () => solver.SetObjective(null));
                Refused(
                    ErrorCode.InvalidValue, "handle_weight: expected a number above 0, found 0",
                    () => solver.SetObjective(new Objective { HandleWeight = 0 }));
                Refused(
                    ErrorCode.InvalidValue, "tolerance: expected at least 1e-14",
                    () => solver.SetObjective(new Objective { Tolerance = 0 }));
                Refused(ErrorCode.NullPointer, "lists is null", () => solver.SetFairness(Fairness.Laplacian, null));
                Refused(
                    ErrorCode.NullPointer, "lists[1] is null",
                    () => solver.SetFairness(Fairness.Laplacian, new[] { Indices(0, 1), null }));
                Refused(
                    ErrorCode.IndexOutOfRange, "indices[1]: 4",
                    () => solver.SetFairness(Fairness.Laplacian, new[] { Indices(0, 4) }));
                Refused(ErrorCode.InvalidValue, "kind", () => solver.SetFairness((Fairness)7, triangle));
                Refused(ErrorCode.NotInitialised, "no exploration yet", () => solver.Exploration.ToString());
                Refused(ErrorCode.NotInitialised, "solve", () => solver.GetSensitivities());
                Equal(0, solver.Conflicts.Length);
                Refused(
                    ErrorCode.InvalidArgumentLength, "points: expected at least 2, found 1",
                    () => solver.AddReferencePolyline(new double[3]));
                Refused(
                    ErrorCode.InvalidArgumentLength, "triangles[1]: expected 3 indices, found 4",
                    () => solver.AddReferenceMesh(solver.Points, new[] { Indices(0, 1, 2), Indices(0, 1, 2, 3) }));
                Refused(
                    ErrorCode.IndexOutOfRange, "triangles[0][2]: 4",
                    () => solver.AddReferenceMesh(solver.Points, new[] { Indices(0, 1, 4) }));
                Refused(
                    ErrorCode.IndexOutOfRange, "3 is out of range for 0 references",
                    () => solver.Add("OnCurve", Indices(0), 1, new double[] { 3 }));
                Refused(ErrorCode.InvalidValue, "NaN", () => solver.AddPressure(triangle, double.NaN));
                Refused(
                    ErrorCode.InvalidArgumentLength, "faces[0]: expected a face of at least 3 corners, found 2",
                    () => solver.AddNormalForce(new[] { Indices(0, 1) }, 1));
                Refused(ErrorCode.UnmatchingForceId, "0", () => solver.EditForceMagnitude(0, 1));
                Equal(1, solver.ConstraintCount);
                Equal(0, solver.ReferenceCount);
                Equal(0, solver.ForceCount);
                True(!solver.IsHard(0), "it became hard");
                solver.InitDynamic(1, 1, 1);
                Refused(ErrorCode.InvalidValue, "static mode", () => solver.SetHard(0));
            }
        });
    }

    static void Disposed()
    {
        Truth("a solver that was disposed of says so", () =>
        {
            Solver solver = BentSquare();
            solver.Dispose();
            var calls = new Action[]
            {
                () => solver.Points = new double[12],
                () => solver.GetPoints(new double[12]),
                () => solver.Add("Plane", Indices(0, 1, 2, 3)),
                () => solver.AddMany("Plane", new int[0][]),
                () => solver.Edit("Closeness", 0, 1, 2, 3),
                () => solver.Remove(0),
                () => solver.Init(),
                () => solver.Solve(1),
                () => solver.SolveUntil(),
                () => solver.SetProblem("{}"),
                () => solver.SetHard(0),
                () => solver.SetHandle(0, 0, 0, 0),
                () => solver.SetObjective(new Objective()),
                () => solver.GetSensitivities(),
                () => solver.AddPressure(new[] { Indices(0, 1, 2) }, 1),
                () => solver.AddReferencePolyline(new double[6]),
                () => True(solver.Conflicts == null, "it has conflicts"),
                () => True(solver.Exploration == null, "it has explored"),
                () => True(solver.PointCount < 0, "it has points"),
                () => True(solver.Energy < 0, "it has an energy"),
                () => True(solver.Violations == null, "it has violations"),
            };
            for (int i = 0; i < calls.Length; i++)
            {
                try
                {
                    calls[i]();
                }
                catch (ObjectDisposedException error)
                {
                    Equal("ShapeOp.Solver", error.ObjectName);
                    continue;
                }
                throw new Exception($"call {i} went through");
            }
        });
    }

    static void Busy()
    {
        Truth("another thread is refused while a solver is busy, and nothing is lost", () =>
        {
            using (Solver solver = BentSquare())
            {
                solver.Init();
                Exception failure = null;
                solver.SolveUntil(new SolveOptions { MaxIterations = 2, Tolerance = 0 }, progress =>
                {
                    var other = new Thread(() =>
                    {
                        try
                        {
                            Refused(ErrorCode.Busy, "busy", () => solver.SetWeight(0, 9));
                            Refused(ErrorCode.Busy, "busy", () => solver.Solve(1));
                            Refused(ErrorCode.Busy, "busy", () => solver.Points = new double[12]);
                        }
                        catch (Exception error)
                        {
                            failure = error;
                        }
                    });
                    other.Start();
                    other.Join();
                    return false;
                });
                if (failure != null) throw failure;
                solver.SetWeight(0, 9);
            }
        });
        Truth("from inside its own solve a solver is not changed", () =>
        {
            using (Solver solver = BentSquare())
            {
                solver.Init();
                Refused(ErrorCode.Busy, "busy", () => solver.SolveUntil(null, progress =>
                {
                    solver.Add("Plane", Indices(0, 1, 2));
                    return false;
                }));
                Refused(ErrorCode.Busy, "busy", () => solver.SolveUntil(null, progress =>
                {
                    solver.Solve(1);
                    return false;
                }));
                Equal(1, solver.ConstraintCount);
                Equal(Outcome.Converged, solver.SolveUntil().Outcome);
            }
        });
    }
}
