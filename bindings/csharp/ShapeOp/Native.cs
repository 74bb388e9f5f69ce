// The C functions of the library, declared for P/Invoke.
// Generated from the sources of the library: do not edit. include/shapeop.h documents the functions.

using System;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>Why a call was refused. The numbers are frozen: 0 to 3 are those of libShapeOp 0.1.0, new ones are added from 16 up.</summary>
    public enum ErrorCode
    {
        /// <summary>The call did what it says.</summary>
        Success = 0,
        /// <summary>The constraint type does not exist, or cannot be edited.</summary>
        InvalidConstraintType = 1,
        /// <summary>A count (of indices, scalars, points) does not fit.</summary>
        InvalidArgumentLength = 2,
        /// <summary>The id is no constraint of that type.</summary>
        UnmatchingConstraintId = 3,
        /// <summary>A number is outside its domain, or not finite.</summary>
        InvalidValue = 16,
        /// <summary>A point index is out of range.</summary>
        IndexOutOfRange = 17,
        /// <summary>The id is no force of that kind.</summary>
        UnmatchingForceId = 18,
        /// <summary>The solver was not initialised.</summary>
        NotInitialised = 19,
        /// <summary>A force acts along a motion that no constraint resists.</summary>
        Unbounded = 20,
        /// <summary>Another call is using the solver.</summary>
        Busy = 21,
        /// <summary>The handle is null, was deleted, or never was a solver's.</summary>
        InvalidHandle = 22,
        /// <summary>A required pointer is null.</summary>
        NullPointer = 23,
        /// <summary>A file or text could not be read as what it claims to be.</summary>
        InvalidInput = 24,
        /// <summary>The problem is too large for this machine or for the numbers of this ABI.</summary>
        TooLarge = 25,
        /// <summary>An error inside the library: please report it.</summary>
        Internal = 26,
        /// <summary>The mesh is no grid of quads.</summary>
        NotGrid = 27,
        /// <summary>Points that must be on one plane are not.</summary>
        NotPlanar = 28,
        /// <summary>Points that must be on one circle are not.</summary>
        NotCircular = 29,
        /// <summary>The input is in a special position where no answer is defined.</summary>
        Degenerate = 30,
        /// <summary>Two shapes that must meet do not.</summary>
        NoIntersection = 31,
        /// <summary>No solution exists for this input.</summary>
        NoSolution = 32,
        /// <summary>Opposite edges of a quad are parallel where the fourth corner is found by meeting them.</summary>
        Singular = 33,
        /// <summary>A ring does not close.</summary>
        NotClosed = 34,
    }

    /// <summary>How iterations are accelerated: see shapeop_setAcceleration.</summary>
    public enum Acceleration
    {
        /// <summary>Not at all: every iteration is one local and one global step.</summary>
        None = 0,
        /// <summary>Safeguarded Anderson acceleration.</summary>
        Anderson = 1,
        /// <summary>L-BFGS with the matrix of the global step as initial Hessian, and a line search.</summary>
        QuasiNewton = 2,
        /// <summary>The default: none in shapeop_solve, quasi-Newton in shapeop_solveUntil.</summary>
        Automatic = 3,
    }

    /// <summary>How the linear system of an iteration is solved: see shapeop_setLinearSolver.</summary>
    public enum LinearSolver
    {
        /// <summary>The default: a factor if it is predicted to take at most 2 GB while it is computed, else conjugate gradients.</summary>
        Automatic = 0,
        /// <summary>A Cholesky factor, computed once and used in every iteration.</summary>
        Direct = 1,
        /// <summary>Conjugate gradients, preconditioned by multigrid, from the current points: far less memory, and no factor to compute.</summary>
        ConjugateGradients = 2,
    }

    /// <summary>What a type promises of its projection.</summary>
    public enum Projection
    {
        /// <summary>The nearest feasible configuration: plain iterations never raise the energy.</summary>
        Nearest = 0,
        /// <summary>A feasible configuration, not always the nearest.</summary>
        Feasible = 1,
        /// <summary>A step towards a feasible configuration.</summary>
        Approximate = 2,
    }

    /// <summary>Why a solve ended.</summary>
    public enum Outcome
    {
        /// <summary>The largest move fell below the tolerance.</summary>
        Converged = 0,
        /// <summary>The iterations were used up.</summary>
        IterationLimit = 1,
        /// <summary>The time was used up.</summary>
        TimeBudget = 2,
        /// <summary>The callback said so.</summary>
        Cancelled = 3,
        /// <summary>Neither the energy nor the largest move fell any more.</summary>
        Stalled = 4,
        /// <summary>
        /// A force acts along a motion that no constraint resists, and the points did not move. shapeop_lastError says
        /// which.
        /// </summary>
        Unbounded = 5,
        /// <summary>Hard constraints contradict each other; shapeop_getConflicts names a small set, and the points meet the others.</summary>
        Infeasible = 6,
    }

    /// <summary>What the fairness term measures displacements with.</summary>
    public enum Fairness
    {
        /// <summary>The displacement of a point minus the mean of its neighbours'. The lists are faces, or edges as lists of two.</summary>
        Laplacian = 0,
        /// <summary>Second differences along polylines, which the lists are; a closed one repeats its first point at its end.</summary>
        SecondDifferences = 1,
        /// <summary>Third differences along polylines.</summary>
        ThirdDifferences = 2,
    }

    internal static class Native
    {
        internal const int AbiVersion = 1;
        private const string Library = "shapeop";

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_constraint_type
        {
            internal uint struct_size;
            internal int least_indices;
            internal int greatest_indices;
            internal int scalar_count;
            internal int index_name_count;
            internal Projection projection;
            internal int is_centred;
            internal int energy_scale_power;
            internal IntPtr name;
            internal IntPtr help;
            internal IntPtr violation_unit;
            internal IntPtr edited_as;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_constraint_scalar
        {
            internal uint struct_size;
            internal int has_default;
            internal double default_value;
            internal IntPtr name;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_solve_options
        {
            internal uint struct_size;
            internal uint max_iterations;
            internal double tolerance;
            internal double time_budget_seconds;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_solve_report
        {
            internal uint struct_size;
            internal Outcome outcome;
            internal uint iterations;
            internal uint unconstrained_count;
            internal double energy_before;
            internal double energy_after;
            internal double largest_move;
            internal double analysis_seconds;
            internal double factorisation_seconds;
            internal double local_seconds;
            internal double global_seconds;
            internal uint evaluations;
            internal uint rejected_energy_rose;
            internal uint rejected_not_finite;
            internal uint rejected_ill_conditioned;
            internal uint rejected_not_descent;
            internal uint rejected_line_search;
            internal uint ordering_count;
            internal uint factorisation_count;
            internal LinearSolver linear_solver;
            internal uint linear_iterations;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_progress
        {
            internal uint struct_size;
            internal uint iteration;
            internal double energy;
            internal double largest_move;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_objective
        {
            internal uint struct_size;
            internal uint reserved;
            internal double handle_weight;
            internal double closeness_weight;
            internal double fairness_weight;
            internal double tolerance;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_exploration
        {
            internal uint struct_size;
            internal uint sweep_count;
            internal uint newton_step_count;
            internal int is_solution;
            internal double largest_violation;
            internal int worst_constraint;
            internal int capped_count;
            internal double primal_residual;
            internal double dual_residual;
            internal double handle_term;
            internal double closeness_term;
            internal double fairness_term;
            internal double soft_term;
            internal double penalty;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_recipe_options
        {
            internal uint struct_size;
            internal int fairness_kind;
            internal double weight;
            internal double closeness;
            internal double fairness;
            internal double length;
            internal IntPtr anchors;
            internal int nb_anchors;
            internal int anchor_boundary;
            internal int anchor_corners;
        }

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        internal delegate int shapeop_progress_callback(ref shapeop_progress progress, IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_version();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_abiVersion();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_lastError(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_lastErrorCode(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_errorText(int error);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SolverHandle shapeop_create();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_delete(IntPtr op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_init(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_initDynamic(SolverHandle op, double masses, double damping, double timestep);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_solve(SolverHandle op, uint iteration);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_setTimeStep(SolverHandle op, double timestep);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_setDamping(SolverHandle op, double damping);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setThreadCount(SolverHandle op, int nbThreads);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setAcceleration(SolverHandle op, int kind, uint memory);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setLinearSolver(SolverHandle op, int linearSolver);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_setPoints(SolverHandle op, double[] points, int nbPoints);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_getPoints(SolverHandle op, double[] points, int nbPoints);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_pointCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_unconstrainedCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addReferencePolyline(
            SolverHandle op,
            double[] points,
            int nbPoints,
            int isClosed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addReferenceMesh(
            SolverHandle op,
            double[] points,
            int nbPoints,
            int[] triangles,
            int nbTriangles);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_referenceCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addConstraint(
            SolverHandle op,
            byte[] constraintType,
            int[] ids,
            int nbIds,
            double weight);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_addConstraints(
            SolverHandle op,
            byte[] constraintType,
            int[] ids,
            int nbIds,
            int[] counts,
            int nbCounts,
            double[] weights,
            int nbWeights,
            double[] scalars,
            int nbScalars,
            int nbScalarSets,
            uint flags,
            int[] constraintIds);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_editConstraint(
            SolverHandle op,
            byte[] constraintType,
            int constraintId,
            double[] scalars,
            int nbScl);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_editConstraints(
            SolverHandle op,
            byte[] constraintType,
            int[] constraintIds,
            int nbConstraintIds,
            double[] scalars,
            int nbScalars,
            int nbScalarSets);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setWeight(SolverHandle op, int constraintId, double weight);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setWeights(
            SolverHandle op,
            int[] constraintIds,
            int nbConstraintIds,
            double[] weights,
            int nbWeights);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_removeConstraint(SolverHandle op, int constraintId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_constraintCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_isConstraint(SolverHandle op, int constraintId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_isDegenerate(SolverHandle op, int constraintId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addGravityForce(SolverHandle op, double[] force);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addVertexForce(SolverHandle op, double[] force, int id);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_editVertexForce(SolverHandle op, int forceId, double[] force, int id);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addPressure(
            SolverHandle op,
            int[] indices,
            int nbIndices,
            int[] counts,
            int nbCounts,
            double pressure);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_addNormalForce(
            SolverHandle op,
            int[] indices,
            int nbIndices,
            int[] counts,
            int nbCounts,
            double magnitude);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_editForceMagnitude(SolverHandle op, int forceId, double magnitude);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_removeForce(SolverHandle op, int forceId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_forceCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_isForce(SolverHandle op, int forceId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_constraintTypeCount();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_constraintType(int index, ref shapeop_constraint_type @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_constraintScalar(
            int index,
            int scalarIndex,
            ref shapeop_constraint_scalar @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_constraintIndexName(int index, int indexPosition);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_defaultSolveOptions(ref shapeop_solve_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_solveUntil(
            SolverHandle op,
            ref shapeop_solve_options options,
            shapeop_progress_callback progress,
            IntPtr user,
            ref shapeop_solve_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_energy(SolverHandle op, double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_getViolations(SolverHandle op, double[] @out, int nb);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setHard(SolverHandle op, int constraintId, int isHard);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_isHard(SolverHandle op, int constraintId);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setHandle(SolverHandle op, int point, double[] target);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_releaseHandle(SolverHandle op, int point);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_defaultObjective(ref shapeop_objective objective);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setObjective(SolverHandle op, ref shapeop_objective objective);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setFairness(
            SolverHandle op,
            int kind,
            int[] indices,
            int nbIndices,
            int[] counts,
            int nbCounts);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_getExploration(SolverHandle op, ref shapeop_exploration @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_getConflicts(SolverHandle op, int[] ids, int nb);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_weightClassCount(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_weightClassName(SolverHandle op, int index);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_getSensitivities(
            SolverHandle op,
            double[] points,
            int nbPoints,
            double[] squares,
            int nbClasses);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setProblem(
            SolverHandle op,
            byte[] json,
            ref shapeop_solve_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_problemText(byte[] json);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_defaultRecipeOptions(ref shapeop_recipe_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_recipe(
            byte[] name,
            double[] points,
            int nbPoints,
            int[] faceIndices,
            int nbFaceIndices,
            int[] counts,
            int nbCounts,
            ref shapeop_recipe_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_recipeCount();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_recipeName(int index);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_measureFaces(
            byte[] measure,
            double[] points,
            int nbPoints,
            int[] faceIndices,
            int nbFaceIndices,
            int[] counts,
            int nbCounts,
            double[] @out,
            int nb);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_measureCount();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_measureName(int index);
    }
}
