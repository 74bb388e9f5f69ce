using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>
    /// The weights of what is minimised while hard constraints are met; see <see cref="Solver.SetObjective"/>. New ones
    /// have the library's defaults.
    /// </summary>
    public sealed class Objective
    {
        /// <summary>Of the distances of handles from their targets, above 0.</summary>
        public double HandleWeight { get; set; }

        /// <summary>Of the distances of the other points from where they were at initialisation, above 0.</summary>
        public double ClosenessWeight { get; set; }

        /// <summary>
        /// Of the fairness of displacements, at least 0; without <see cref="Solver.SetFairness"/> it has nothing to
        /// weigh.
        /// </summary>
        public double FairnessWeight { get; set; }

        /// <summary>
        /// How far a hard constraint may be from its set, relative to the bounding-box diagonal; at least 1e-14.
        /// </summary>
        public double Tolerance { get; set; }

        /// <summary>The library's defaults.</summary>
        public Objective()
        {
            Native.shapeop_objective objective = Library.Call(Defaults);
            HandleWeight = objective.handle_weight;
            ClosenessWeight = objective.closeness_weight;
            FairnessWeight = objective.fairness_weight;
            Tolerance = objective.tolerance;
        }

        internal Native.shapeop_objective ToLibrary()
        {
            Native.shapeop_objective objective = Defaults();
            objective.handle_weight = HandleWeight;
            objective.closeness_weight = ClosenessWeight;
            objective.fairness_weight = FairnessWeight;
            objective.tolerance = Tolerance;
            return objective;
        }

        static Native.shapeop_objective Defaults()
        {
            var objective = new Native.shapeop_objective
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_objective>(),
            };
            SolverHandle.None.Check(Native.shapeop_defaultObjective(ref objective));
            return objective;
        }
    }

    /// <summary>What the last exploration found.</summary>
    public sealed class Exploration
    {
        readonly Native.shapeop_exploration found;

        internal Exploration(Native.shapeop_exploration found)
        {
            this.found = found;
        }

        /// <summary>Sweeps of the splitting method.</summary>
        public int SweepCount => (int)found.sweep_count;

        /// <summary>Newton steps.</summary>
        public int NewtonStepCount => (int)found.newton_step_count;

        /// <summary>
        /// Whether every hard constraint is met and the gradient vanishes, both within the tolerance.
        /// </summary>
        public bool IsSolution => found.is_solution != 0;

        /// <summary>The largest distance of a hard constraint from its set, in model units.</summary>
        public double LargestViolation => found.largest_violation;

        /// <summary>The hard constraint that it is of; null if there is none.</summary>
        public int? WorstConstraint => found.worst_constraint < 0 ? (int?)null : found.worst_constraint;

        /// <summary>
        /// Hard constraints whose multiplier is at its cap: the contradictions, as far as they are known.
        /// </summary>
        public int CappedCount => found.capped_count;

        /// <summary>
        /// The largest distance between what multipliers ask for and what the points are, in model units.
        /// </summary>
        public double PrimalResidual => found.primal_residual;

        /// <summary>
        /// The largest gradient of the Lagrangian at a point, relative to the force that moves it by the model's size.
        /// </summary>
        public double DualResidual => found.dual_residual;

        /// <summary>The term of the objective that draws handles to their targets.</summary>
        public double HandleTerm => found.handle_term;

        /// <summary>The term that draws the other points to where they were at initialisation.</summary>
        public double ClosenessTerm => found.closeness_term;

        /// <summary>The term that makes displacements fair.</summary>
        public double FairnessTerm => found.fairness_term;

        /// <summary>The term of the soft constraints.</summary>
        public double SoftTerm => found.soft_term;

        /// <summary>The penalty of the sweeps.</summary>
        public double Penalty => found.penalty;
    }

    /// <summary>How a solution answers a change of each weight.</summary>
    public sealed class Sensitivities
    {
        internal Sensitivities(IReadOnlyList<string> classes, double[] points, double[] squares)
        {
            int length = classes.Count == 0 ? 0 : points.Length / classes.Count;
            Classes = classes;
            Points = classes.Select((_, i) => points.Skip(i * length).Take(length).ToArray()).ToArray();
            Squares = classes.Select((_, i) => squares.Skip(i * classes.Count).Take(classes.Count).ToArray()).ToArray();
        }

        /// <summary>"handles", "closeness", "fairness", and the name of each type of soft constraints.</summary>
        public IReadOnlyList<string> Classes { get; }

        /// <summary>
        /// For each class how far each point (<c>x0 y0 z0 x1 ...</c>, model units) moves per change of the logarithm of
        /// its weight: about 0.69 times that if the weight is doubled.
        /// </summary>
        public IReadOnlyList<double[]> Points { get; }

        /// <summary>
        /// For each class that is changed how the sum of weighted squares of every class answers, per change of the
        /// logarithm.
        /// </summary>
        public IReadOnlyList<double[]> Squares { get; }
    }
}
