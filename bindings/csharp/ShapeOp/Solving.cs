using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>When to stop. New ones have the library's defaults.</summary>
    public sealed class SolveOptions
    {
        /// <summary>Iterations at most; in dynamic mode within the one time step that a call makes.</summary>
        public int MaxIterations { get; set; }

        /// <summary>
        /// Stop when the largest move of a point in an iteration, relative to the bounding-box diagonal, is below this; 0
        /// never stops that way. Finite, at least 0.
        /// </summary>
        public double Tolerance { get; set; }

        /// <summary>Stop after so many seconds, looked at once per iteration; 0: no limit. Finite, at least 0.</summary>
        public double TimeBudgetSeconds { get; set; }

        /// <summary>The library's defaults.</summary>
        public SolveOptions() : this(Library.Call(Defaults))
        {
        }

        internal SolveOptions(Native.shapeop_solve_options options)
        {
            MaxIterations = options.max_iterations > int.MaxValue ? int.MaxValue : (int)options.max_iterations;
            Tolerance = options.tolerance;
            TimeBudgetSeconds = options.time_budget_seconds;
        }

        internal Native.shapeop_solve_options ToLibrary()
        {
            Native.shapeop_solve_options options = Defaults();
            options.max_iterations = Refusal.Unsigned(MaxIterations, nameof(MaxIterations));
            options.tolerance = Tolerance;
            options.time_budget_seconds = TimeBudgetSeconds;
            return options;
        }

        static Native.shapeop_solve_options Defaults()
        {
            var options = new Native.shapeop_solve_options
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_solve_options>(),
            };
            SolverHandle.None.Check(Native.shapeop_defaultSolveOptions(ref options));
            return options;
        }
    }

    /// <summary>What is known after an iteration.</summary>
    public struct Progress
    {
        /// <summary>Iterations made so far, from 1.</summary>
        public int Iteration { get; }

        /// <summary>The energy at the current points.</summary>
        public double Energy { get; }

        /// <summary>
        /// The largest move of a point in this iteration, relative to the bounding-box diagonal.
        /// </summary>
        public double LargestMove { get; }

        internal Progress(Native.shapeop_progress progress)
        {
            Iteration = (int)progress.iteration;
            Energy = progress.energy;
            LargestMove = progress.largest_move;
        }
    }

    /// <summary>What a solve found.</summary>
    public sealed class Report
    {
        readonly Native.shapeop_solve_report report;

        internal Report(Native.shapeop_solve_report report, string backendReason, string message)
        {
            this.report = report;
            BackendReason = backendReason;
            Message = message;
        }

        /// <summary>Why it ended.</summary>
        public Outcome Outcome => report.outcome;

        /// <summary>
        /// Which motion no constraint resists if the outcome is unbounded, what happened to the graphics card if the
        /// backend failed; else null.
        /// </summary>
        public string Message { get; }

        /// <summary>Iterations made.</summary>
        public int Iterations => (int)report.iterations;

        /// <summary>Points that no constraint of a weight above 0 holds.</summary>
        public int UnconstrainedCount => (int)report.unconstrained_count;

        /// <summary>The energy at the points that the iterations started from.</summary>
        public double EnergyBefore => report.energy_before;

        /// <summary>The energy at the points that were reached.</summary>
        public double EnergyAfter => report.energy_after;

        /// <summary>
        /// The largest move of a point in the last iteration, relative to the bounding-box diagonal.
        /// </summary>
        public double LargestMove => report.largest_move;

        /// <summary>Spent on ordering and symbolic analysis when the system in use was made.</summary>
        public double AnalysisSeconds => report.analysis_seconds;

        /// <summary>Spent on the factorisation when the system in use was made.</summary>
        public double FactorisationSeconds => report.factorisation_seconds;

        /// <summary>Spent on projections in this call.</summary>
        public double LocalSeconds => report.local_seconds;

        /// <summary>Spent on right-hand sides, linear solves and acceleration in this call.</summary>
        public double GlobalSeconds => report.global_seconds;

        /// <summary>
        /// Points that were tried, whether they were kept or not; without acceleration one per iteration.
        /// </summary>
        public int Evaluations => (int)report.evaluations;

        /// <summary>
        /// Evaluations of points whose energy was higher than before, or not as much lower as the line search asks for.
        /// </summary>
        public int RejectedEnergyRose => (int)report.rejected_energy_rose;

        /// <summary>Evaluations of points whose energy was not finite.</summary>
        public int RejectedNotFinite => (int)report.rejected_not_finite;

        /// <summary>Iterations in which acceleration left out a part of its history as ill-conditioned.</summary>
        public int RejectedIllConditioned => (int)report.rejected_ill_conditioned;

        /// <summary>Directions of acceleration that were not tried, as the energy would rise along them.</summary>
        public int RejectedNotDescent => (int)report.rejected_not_descent;

        /// <summary>Directions of acceleration that were given up: no step along them was accepted.</summary>
        public int RejectedLineSearch => (int)report.rejected_line_search;

        /// <summary>Orderings made since the solver was created.</summary>
        public int OrderingCount => (int)report.ordering_count;

        /// <summary>Numeric factorisations made since the solver was created.</summary>
        public int FactorisationCount => (int)report.factorisation_count;

        /// <summary>How linear systems were solved: direct or by conjugate gradients.</summary>
        public LinearSolver LinearSolver => report.linear_solver;

        /// <summary>
        /// Iterations of conjugate gradients in all linear solves of this call; 0 with a factor.
        /// </summary>
        public int LinearIterations => (int)report.linear_iterations;

        /// <summary>The graphics card if it made any of the iterations, else the processor.</summary>
        public Backend Backend => report.backend;

        /// <summary>Why it ran on that backend, in words.</summary>
        public string BackendReason { get; }

        /// <summary>Those of the iterations that the card made.</summary>
        public int GpuIterations => (int)report.gpu_iterations;

        /// <summary>The iteration after which points were read back from the card last.</summary>
        public int ReadBackIteration => (int)report.read_back_iteration;

        /// <summary>In which the card worked.</summary>
        public double GpuSeconds => report.gpu_seconds;

        /// <summary>In which points went to the card and back.</summary>
        public double TransferSeconds => report.transfer_seconds;
    }
}
