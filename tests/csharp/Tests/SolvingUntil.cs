using System;
using System.Collections.Generic;
using System.Linq;
using ShapeOp;

/// <summary>Solving until the points no longer move, with progress.</summary>
static partial class Tests
{
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
                Equal(Backend.Cpu, report.Backend);
                Equal(0, report.GpuIterations);
                Near(Numbers(0, 0), Numbers(report.GpuSeconds, report.TransferSeconds), 0);
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
}
