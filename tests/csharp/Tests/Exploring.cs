using System;
using System.Collections.Generic;
using System.Linq;
using ShapeOp;

// Hard constraints, handles, references and forces on faces, against numbers derived by hand.
static partial class Tests
{
    static readonly double[] Square = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 };

    static void Exploring()
    {
        Truth("with closeness alone a hard plane is the best-fit plane", () =>
        {
            using (Solver solver = BentSquare())
            {
                True(!solver.IsHard(0), "soft by default");
                solver.SetHard(0);
                True(solver.IsHard(0) && !solver.IsHard(7), "hard now, and no other");
                solver.SetObjective(new Objective { FairnessWeight = 0 });
                solver.Init();
                Equal(Outcome.Converged, solver.SolveUntil().Outcome);
                Near(Square, solver.Points, 1e-11);
                Exploration found = solver.Exploration;
                True(found.IsSolution && found.LargestViolation < 1e-11, "no solution");
                Equal((int?)0, found.WorstConstraint);
                // Half of 0.1 times 4 · 0.1².
                Near(Numbers(0.002, 0, 0), Numbers(found.ClosenessTerm, found.HandleTerm, found.SoftTerm), 1e-12);
                Equal(0, solver.Conflicts.Length);
                solver.SetHard(0, false);
                True(!solver.IsHard(0), "soft again");
            }
        });
        Truth("a handle takes its edge along as the weights say, and sensitivities are the derivatives of that", () =>
        {
            // A hard length 1 along x: 3 (t - 1)² + t² is least at t = 3/4; dt/d ln w = 3/16 for the handle.
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0))
            {
                solver.Add("EdgeLength", Indices(0, 1), 1, Numbers(1, 1), true);
                solver.SetObjective(new Objective { HandleWeight = 3, ClosenessWeight = 1, FairnessWeight = 0 });
                solver.Init();
                solver.SetHandle(1, 2, 0, 0);
                solver.SolveUntil();
                Near(Numbers(0.75, 0, 0, 1.75, 0, 0), solver.Points, 1e-9);
                Near(Numbers(3.0 / 32), Numbers(solver.Exploration.HandleTerm), 1e-9);
                Sensitivities answer = solver.GetSensitivities();
                True(answer.Classes.SequenceEqual(new[] { "handles", "closeness", "fairness" }), "the classes");
                const double step = 3.0 / 16;
                Near(Numbers(step, 0, 0, step, 0, 0), answer.Points[0], 1e-8);
                Near(Numbers(-step, 0, 0, -step, 0, 0), answer.Points[1], 1e-8);
                Near(new double[6], answer.Points[2], 1e-12);
                Near(Numbers(-2 * 3 * 0.25 * step, 2 * 0.75 * step, 0), answer.Squares[0], 1e-8);
                solver.ReleaseHandle(1);
                solver.SolveUntil();
                Near(Numbers(0, 0, 0, 1, 0, 0), solver.Points, 1e-9);
            }
        });
        Truth("a fair displacement solves the normal equations", () =>
        {
            using (Solver solver = SolverWith(0, 0, 0, 1, 0, 0, 2, 0, 0))
            {
                solver.SetObjective(new Objective { HandleWeight = 4, ClosenessWeight = 0.5, FairnessWeight = 2 });
                solver.SetFairness(Fairness.SecondDifferences, new[] { Indices(0, 1, 2) });
                solver.SetHandle(2, 2, 0, 1);
                solver.Init();
                solver.SolveUntil();
                double[] z = { solver.Points[2], solver.Points[5], solver.Points[8] };
                double difference = z[0] - 2 * z[1] + z[2];
                Near(
                    new double[3],
                    Numbers(0.5 * z[0] + 2 * difference, 0.5 * z[1] - 4 * difference, 4 * (z[2] - 1) + 2 * difference),
                    1e-9);
                True(Math.Abs(difference) > 1e-2, "fairness does not count");
            }
        });
        Truth("a contradiction is named", () =>
        {
            using (Solver solver = SolverWith(Square))
            {
                IEnumerable<int[]> edges = Enumerable.Range(0, 4).Select(i => Indices(i, (i + 1) % 4));
                int[] ids = solver.AddMany("EdgeLength", edges, 2, Numbers(1, 1), true);
                int planted = solver.Add("EdgeLength", Indices(0, 1), 1, Numbers(3, 3), true);
                int[] soft = solver.AddMany("Closeness", new[] { Indices(0), Indices(1) }, Numbers(1, 2), null, false);
                True(ids.All(solver.IsHard) && !soft.Any(solver.IsHard), "which are hard");
                solver.SetFairness(Fairness.Laplacian, new[] { Indices(0, 1, 2, 3) });
                solver.Init();
                Equal(Outcome.Infeasible, solver.SolveUntil().Outcome);
                True(solver.Conflicts.SequenceEqual(new[] { planted }), "another one");
                True(!solver.Exploration.IsSolution, "it is no solution");
            }
        });
        Truth("points are drawn to references", () =>
        {
            using (Solver solver = SolverWith(-1, 0.25, 0, -1, 0.25, 0, 0.75, 0.25, 3))
            {
                int open = solver.AddReferencePolyline(Square);
                int closed = solver.AddReferencePolyline(Square, true);
                int mesh = solver.AddReferenceMesh(Square, new[] { Indices(0, 1, 2), Indices(0, 2, 3) });
                Equal(3, solver.ReferenceCount);
                solver.Add("OnCurve", Indices(0), 1, Numbers(open));
                solver.Add("OnCurve", Indices(1), 1, Numbers(closed));
                solver.Add("OnMesh", Indices(2), 1, Numbers(mesh));
                solver.Init();
                solver.Solve(1);
                Near(Numbers(0, 0, 0, 0, 0.25, 0, 0.75, 0.25, 0), solver.Points, 1e-14);
            }
        });
        Truth("forces on faces move held points by their size over the weight", () =>
        {
            using (Solver solver = SolverWith(Square))
            {
                solver.AddMany("Closeness", Enumerable.Range(0, 4).Select(i => Indices(i)), 2);
                int pressure = solver.AddPressure(new[] { Indices(0, 1, 2, 3) }, 8);
                solver.Init();
                Func<double[]> heights = () =>
                {
                    solver.Points = Square;
                    solver.Solve(1);
                    return solver.Points.Where((_, i) => i % 3 == 2).ToArray();
                };
                // A quarter of the pressure on the area 1, over the weight.
                Near(Numbers(1, 1, 1, 1), heights(), 1e-12);
                solver.EditForceMagnitude(pressure, -4);
                Near(Numbers(-0.5, -0.5, -0.5, -0.5), heights(), 1e-12);
                solver.RemoveForce(pressure);
                solver.AddNormalForce(new[] { Indices(0, 1, 2), Indices(0, 2, 3) }, 3);
                // Once per point, whatever its number of faces.
                Near(Numbers(1.5, 1.5, 1.5, 1.5), heights(), 1e-12);
            }
        });
    }
}
