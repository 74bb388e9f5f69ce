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
        /// <summary>An index is out of range.</summary>
        IndexOutOfRange = 17,
        /// <summary>The id is no force of that kind.</summary>
        UnmatchingForceId = 18,
        /// <summary>Another call must come first: a solver is not initialised, or nothing was found yet that could be told.</summary>
        NotInitialised = 19,
        /// <summary>A force acts along a motion that no constraint resists.</summary>
        Unbounded = 20,
        /// <summary>Another call is using the solver, surface, design or snake.</summary>
        Busy = 21,
        /// <summary>The handle is null, was deleted, or never was one of such an object.</summary>
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
        /// <summary>Equations do not determine an answer: edges of a quad that are to meet are parallel, or derivatives lose rank.</summary>
        Singular = 33,
        /// <summary>A ring does not close.</summary>
        NotClosed = 34,
        /// <summary>The mesh is no oriented surface: an edge has more than two faces, or faces disagree about what is up.</summary>
        NotManifold = 35,
        /// <summary>The surface is not negatively curved where it must be.</summary>
        CurvatureSign = 36,
        /// <summary>No consistent choice of directions exists over the whole surface.</summary>
        NotOrientable = 37,
        /// <summary>Side conditions contradict each other.</summary>
        Infeasible = 38,
        /// <summary>What is asked for lies outside the surface, or outside the values of a function.</summary>
        OutOfDomain = 39,
        /// <summary>There is no graphics card to solve on, or not enough of it; or the library was built without the feature gpu.</summary>
        BackendUnavailable = 40,
        /// <summary>The graphics card was lost or refused work; the points are those of the last read-back.</summary>
        BackendFailed = 41,
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
        /// <summary>
        /// The graphics card was lost or refused work; the points are those of the last read-back. shapeop_lastError says
        /// what happened.
        /// </summary>
        BackendFailed = 7,
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

    /// <summary>What carries out the iterations of a solve: see shapeop_setBackend.</summary>
    public enum Backend
    {
        /// <summary>The default: the processor, in double precision.</summary>
        Cpu = 0,
        /// <summary>The graphics card, in single precision; what a tolerance asks for beyond that the processor finishes.</summary>
        Gpu = 1,
        /// <summary>
        /// The card where there is one that is faster on the model at hand, which the first iterations measure; else, and
        /// where anything is missing, the processor.
        /// </summary>
        Automatic = 2,
    }

    /// <summary>What kind of adapter it is, the fastest first.</summary>
    public enum AdapterKind
    {
        /// <summary>A card with memory of its own.</summary>
        Discrete = 0,
        /// <summary>A part of the processor that shares its memory.</summary>
        Integrated = 1,
        /// <summary>A card that a virtual machine lends.</summary>
        Virtual = 2,
        /// <summary>Not known.</summary>
        Other = 3,
        /// <summary>A program that behaves like a card: for tests.</summary>
        Software = 4,
    }

    /// <summary>What the base of a surface is; it decides on the name of its family only.</summary>
    public enum CanalKind
    {
        /// <summary>A canal surface: its sections are circles.</summary>
        Canal = 0,
        /// <summary>A surface of revolution.</summary>
        Revolution = 1,
        /// <summary>A moulding surface.</summary>
        Moulding = 2,
        /// <summary>Any circular net.</summary>
        Circular = 3,
    }

    /// <summary>Why smoothing stopped.</summary>
    public enum CanalStop
    {
        /// <summary>The gradient is as small as asked for.</summary>
        Gradient = 0,
        /// <summary>The value hardly falls any more.</summary>
        Decrease = 1,
        /// <summary>All iterations were used.</summary>
        Iterations = 2,
        /// <summary>No step lowers the value: it is as good as rounding allows, or at the border of what is feasible.</summary>
        LineSearch = 3,
        /// <summary>The callback said so.</summary>
        Cancelled = 4,
        /// <summary>The start is not feasible.</summary>
        Infeasible = 5,
    }

    /// <summary>How points are spread over a curve.</summary>
    public enum CanalSpacing
    {
        /// <summary>At equal lengths of the curve.</summary>
        ArcLength = 0,
        /// <summary>At equal steps of its parameter, the length of chords along the given points.</summary>
        Parameter = 1,
        /// <summary>The points that were given.</summary>
        Points = 2,
    }

    /// <summary>Which part of a circle is meshed, from a point of it on.</summary>
    public enum CanalSection
    {
        /// <summary>All of it; the mesh closes around it.</summary>
        Whole = 0,
        /// <summary>From the angle from_angle to to_angle, less than a full turn.</summary>
        Angles = 1,
        /// <summary>From the point to the one nearest to where the second curve passes.</summary>
        ToCurve = 2,
        /// <summary>What is above a plane.</summary>
        Above = 3,
    }

    /// <summary>
    /// Which center of inversion an M-revolution surface takes: a point of the circle of centers, see
    /// shapeop_canalCenters.
    /// </summary>
    public enum CanalCenter
    {
        /// <summary>The middle of the outer arc of the circle of centers.</summary>
        Middle = 0,
        /// <summary>
        /// The point at the angle center_value, in radians, on the circle of centers: 0 is the middle of the inner arc,
        /// pi that of the outer one.
        /// </summary>
        Angle = 1,
        /// <summary>The point inside the given circle for which the parallel sides have the ratio center_value.</summary>
        RatioInside = 2,
        /// <summary>The point outside the given circle for which the parallel sides have the ratio center_value.</summary>
        RatioOutside = 3,
        /// <summary>The point center_point.</summary>
        Point = 4,
        /// <summary>On the chord from the rail's start to its end; for M-moulding surfaces.</summary>
        Chord = 5,
    }

    /// <summary>What a transformation keeps.</summary>
    public enum CanalStep
    {
        /// <summary>A similarity: the family.</summary>
        Similarity = 0,
        /// <summary>An inversion: circles and angles.</summary>
        Moebius = 1,
        /// <summary>A Combescure transformation: the directions of edges.</summary>
        Combescure = 2,
    }

    /// <summary>What was found at a point of a mesh.</summary>
    public enum RuledPoint
    {
        /// <summary>Two asymptotic directions.</summary>
        Good = 0,
        /// <summary>The surface is flat or positively curved there: it has none.</summary>
        NotNegative = 1,
        /// <summary>Its neighbours do not determine curvatures.</summary>
        NotFitted = 2,
    }

    /// <summary>Why an asymptotic curve ends.</summary>
    public enum RuledEnd
    {
        /// <summary>At the boundary of the mesh.</summary>
        Boundary = 0,
        /// <summary>Where the direction is not known.</summary>
        Unknown = 1,
        /// <summary>At the length asked for.</summary>
        Length = 2,
        /// <summary>After the most steps.</summary>
        Steps = 3,
    }

    /// <summary>What strip boundaries are to be.</summary>
    public enum RuledLevels
    {
        /// <summary>Orthogonal to the rulings, at distances of one length where that is possible.</summary>
        Orthogonal = 0,
        /// <summary>Orthogonal to the rulings, at whatever distances.</summary>
        Direction = 1,
        /// <summary>At constant distances.</summary>
        Equidistant = 2,
        /// <summary>Geodesic: the straightest on the surface.</summary>
        Geodesic = 3,
        /// <summary>Such that the rulings along each are parallel to a plane.</summary>
        Conoidal = 4,
    }

    /// <summary>What the spherical image of a field is like.</summary>
    public enum RuledImage
    {
        /// <summary>It was not asked for: the weight conoidal was 0.</summary>
        None = 0,
        /// <summary>It covers a part of the sphere.</summary>
        Regular = 1,
        /// <summary>It covers a part of the sphere twice.</summary>
        Folded = 2,
        /// <summary>It collapsed to a great circle: every strip is conoidal, and the weight was not used.</summary>
        GreatCircle = 3,
        /// <summary>It collapsed to another curve: the surface is ruled, and the weight was not used.</summary>
        Curve = 4,
    }

    /// <summary>Why a run stopped.</summary>
    public enum RuledStop
    {
        /// <summary>There was nothing to iterate.</summary>
        None = 0,
        /// <summary>Steps or decreases became small.</summary>
        Converged = 1,
        /// <summary>All iterations were used.</summary>
        Iterations = 2,
        /// <summary>No step lowers the value: it is as good as rounding allows.</summary>
        LineSearch = 3,
        /// <summary>The callback said so.</summary>
        Cancelled = 4,
    }

    /// <summary>Why a curve of given curvature ends.</summary>
    public enum SnakeCurveEnd
    {
        /// <summary>It is as long as asked for.</summary>
        Length = 0,
        /// <summary>At the boundary of the surface.</summary>
        Boundary = 1,
        /// <summary>The surface itself bends more along the curve than the curve may.</summary>
        BendsMore = 2,
        /// <summary>The surface has no tangent plane there, or folds.</summary>
        Fold = 3,
    }

    /// <summary>A surface that a few numbers tell. Normals point outward, that of a plane as given.</summary>
    public enum SnakeSurface
    {
        /// <summary>A point and the normal: 6 numbers.</summary>
        Plane = 0,
        /// <summary>The centre and the radius: 4 numbers.</summary>
        Sphere = 1,
        /// <summary>A point of the axis, its direction, the radius: 7 numbers.</summary>
        Cylinder = 2,
        /// <summary>
        /// The centre, the direction of the axis, the distance of the tube's middle from it, the radius of the tube: 8
        /// numbers.
        /// </summary>
        Torus = 3,
    }

    /// <summary>Which way control points are to move.</summary>
    public enum SnakeDirection
    {
        /// <summary>None is given: rails or other wishes say it. So it is at first.</summary>
        Free = 0,
        /// <summary>To the left of the snake within its surface, seen from the side that the surface's normals point to.</summary>
        Sideways = 1,
        /// <summary>All along one vector.</summary>
        Along = 2,
    }

    /// <summary>Why an evolution stopped.</summary>
    public enum SnakeStop
    {
        /// <summary>All steps were made.</summary>
        Steps = 0,
        /// <summary>The next position would be farther from the surface than allowed: see stop_distance.</summary>
        Deviation = 1,
        /// <summary>Velocities, or positions, are not determined.</summary>
        Singular = 2,
        /// <summary>A rail ended, or the snake left it: see stop_rail and stop_distance.</summary>
        RailEnd = 3,
        /// <summary>A rail that the snake glides on became parallel to it: see stop_rail.</summary>
        Parallel = 4,
        /// <summary>The snake is back at its start.</summary>
        Cycle = 5,
        /// <summary>It does not move any more.</summary>
        Stalled = 6,
        /// <summary>The callback said so.</summary>
        Cancelled = 7,
    }

    /// <summary>Why a linkage's motion ends.</summary>
    public enum SnakeCycleEnd
    {
        /// <summary>It came back to the start.</summary>
        Closed = 0,
        /// <summary>All steps were used.</summary>
        Steps = 1,
        /// <summary>At the last position it can move in another number of ways than one: see free.</summary>
        Freedoms = 2,
        /// <summary>No step leads on.</summary>
        Stalled = 3,
        /// <summary>The callback said so.</summary>
        Cancelled = 4,
    }

    /// <summary>How lamellae stand.</summary>
    public enum SnakeLamella
    {
        /// <summary>In the planes of the arcs: a sector of a ring for each, which share no points.</summary>
        Flat = 0,
        /// <summary>Along the normals of the snake's surface: one band.</summary>
        Normal = 1,
        /// <summary>Along one vector: one band.</summary>
        Along = 2,
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
            internal Backend backend;
            internal uint gpu_iterations;
            internal uint read_back_iteration;
            internal uint reserved;
            internal double gpu_seconds;
            internal double transfer_seconds;
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
        internal struct shapeop_backend_info
        {
            internal uint struct_size;
            internal AdapterKind kind;
            internal uint group_count;
            internal uint reserved;
            internal double buffer_bytes;
            internal double binding_bytes;
            internal IntPtr adapter;
            internal IntPtr api;
            internal IntPtr driver;
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

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_progress
        {
            internal uint struct_size;
            internal uint iteration;
            internal double fraction;
            internal double value;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_smooth_options
        {
            internal uint struct_size;
            internal uint max_iterations;
            internal int has_cone;
            internal int turns_tangents;
            internal double cone_axis_x;
            internal double cone_axis_y;
            internal double cone_axis_z;
            internal double cone_angle;
            internal double spacing_ratio;
            internal double length_change;
            internal double length_weight;
            internal double half_angle;
            internal double relative_gradient;
            internal double relative_decrease;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_smooth_report
        {
            internal uint struct_size;
            internal CanalStop stop;
            internal double before;
            internal double after;
            internal uint iterations;
            internal uint reserved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_fit_options
        {
            internal uint struct_size;
            internal int circle_count;
            internal int column_count;
            internal int spacing;
            internal int section;
            internal int is_long_way;
            internal int has_normal;
            internal int reserved;
            internal double angle;
            internal double normal_x;
            internal double normal_y;
            internal double normal_z;
            internal double from_angle;
            internal double to_angle;
            internal double plane_x;
            internal double plane_y;
            internal double plane_z;
            internal double up_x;
            internal double up_y;
            internal double up_z;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_fit_report
        {
            internal uint struct_size;
            internal int is_outward;
            internal double deviation;
            internal double residual;
            internal double tangent_gap;
            internal double closing_gap;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_canal_properties
        {
            internal uint struct_size;
            internal uint face_count;
            internal uint crossed_count;
            internal uint flipped_count;
            internal uint shrunk_count;
            internal int has_planar_curves;
            internal int is_isothermic_by_construction;
            internal int has_stress_lines;
            internal double planarity;
            internal double concyclicity;
            internal double rows_off_plane;
            internal double columns_off_plane;
            internal double cross_ratio_residual;
            internal double stress_residual_coarse;
            internal double stress_residual_fine;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_options
        {
            internal uint struct_size;
            internal int family;
            internal int allow_cut;
            internal uint least_neighbours;
            internal double flatness;
            internal double max_mask;
            internal double hint_x;
            internal double hint_y;
            internal double hint_z;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_level_options
        {
            internal uint struct_size;
            internal uint max_iterations;
            internal int allow_folds;
            internal uint reserved;
            internal double orthogonal;
            internal double direction;
            internal double equidistant;
            internal double geodesic;
            internal double conoidal;
            internal double laplace;
            internal double relative_decrease;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_level_report
        {
            internal uint struct_size;
            internal RuledStop stop;
            internal uint iterations;
            internal uint critical_count;
            internal RuledImage image;
            internal uint image_unused_count;
            internal double least_slope;
            internal double greatest_slope;
            internal double image_extent;
            internal double image_folded;
            internal double image_flatness;
            internal double image_axis_x;
            internal double image_axis_y;
            internal double image_axis_z;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_boundary_options
        {
            internal uint struct_size;
            internal int extends;
            internal int overshoots;
            internal uint reserved;
            internal double least_length;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_progress
        {
            internal uint struct_size;
            internal uint iteration;
            internal double fraction;
            internal double value;
            internal double largest_deviation;
            internal double largest_gap;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_optimise_options
        {
            internal uint struct_size;
            internal uint max_iterations;
            internal uint samples_along;
            internal uint samples_across;
            internal double proximity;
            internal double beyond;
            internal double gap;
            internal double coverage;
            internal double thin_plate;
            internal double proximal;
            internal double largest_deviation;
            internal double least_width;
            internal double tolerance;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_optimise_report
        {
            internal uint struct_size;
            internal RuledStop stop;
            internal uint iterations;
            internal uint free_count;
            internal double before;
            internal double after;
            internal double proximity;
            internal double gap;
            internal double coverage;
            internal double way;
            internal double excess;
            internal double largest_deviation;
            internal double largest_gap;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_report_options
        {
            internal uint struct_size;
            internal uint samples_along;
            internal uint samples_across;
            internal uint columns_per_span;
            internal double feature_ratio;
            internal double trim_tolerance;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_report
        {
            internal uint struct_size;
            internal uint strip_count;
            internal uint joint_count;
            internal uint too_wide_count;
            internal double largest_deviation;
            internal double rms_deviation;
            internal double largest_uncovered;
            internal double rms_uncovered;
            internal double reference_area;
            internal double trimmed_area;
            internal double coverage;
            internal double largest_gap;
            internal double mean_gap;
            internal double largest_kink;
            internal double mean_kink;
            internal double width_variation;
            internal double overlap;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_strip_report
        {
            internal uint struct_size;
            internal int is_too_wide;
            internal double largest_deviation;
            internal double at_x;
            internal double at_y;
            internal double at_z;
            internal double rms_deviation;
            internal double area;
            internal double trimmed_area;
            internal double least_width;
            internal double mean_width;
            internal double greatest_width;
            internal double width_variation;
            internal double width_over_feature;
            internal double feature_size;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_joint_report
        {
            internal uint struct_size;
            internal int first;
            internal int second;
            internal uint gap_count;
            internal uint kink_count;
            internal uint reserved;
            internal double largest_gap;
            internal double mean_gap;
            internal double gap_x;
            internal double gap_y;
            internal double gap_z;
            internal double largest_kink;
            internal double mean_kink;
            internal double kink_x;
            internal double kink_y;
            internal double kink_z;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_plank_options
        {
            internal uint struct_size;
            internal int has_first_cut;
            internal double thickness;
            internal double depth;
            internal double first_cut;
            internal double tolerance;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_planks
        {
            internal uint struct_size;
            internal uint plank_count;
            internal double axis_x;
            internal double axis_y;
            internal double axis_z;
            internal double thickness;
            internal double deviation;
            internal double stock_area;
            internal double offcut;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_ruled_plank
        {
            internal uint struct_size;
            internal uint reserved;
            internal double lower;
            internal double upper;
            internal double filled;
            internal double first_u;
            internal double last_u;
            internal double length;
            internal double width;
            internal double first_end_angle;
            internal double second_end_angle;
            internal double offcut;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_report
        {
            internal uint struct_size;
            internal uint arc_count;
            internal uint control_count;
            internal int is_closed;
            internal double length;
            internal double residual;
            internal double deviation;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_fit_options
        {
            internal uint struct_size;
            internal int is_congruent;
            internal uint max_iterations;
            internal uint reserved;
            internal double curvature;
            internal double nearness;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_fit_report
        {
            internal uint struct_size;
            internal uint iterations;
            internal int is_converged;
            internal uint reserved;
            internal double deviation;
            internal double residual;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_curve_options
        {
            internal uint struct_size;
            internal int turns_right;
            internal uint steps;
            internal int method;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_curve_report
        {
            internal uint struct_size;
            internal SnakeCurveEnd end;
            internal double length;
            internal double curvature;
            internal double normal_curvature;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_progress
        {
            internal uint struct_size;
            internal uint step;
            internal double fraction;
            internal double time;
            internal double deviation;
            internal double residual;
            internal double first_angle;
            internal double last_angle;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_options
        {
            internal uint struct_size;
            internal uint max_steps;
            internal int is_second_order;
            internal int keeps_torsions;
            internal int stops_at_cycle;
            internal int is_exact;
            internal uint projection_iterations;
            internal uint reserved;
            internal double step;
            internal double least_step;
            internal double max_deviation;
            internal double tangential;
            internal double offset;
            internal double rotation;
            internal double orthogonal;
            internal double alpha;
            internal double mu;
            internal double surface_weight;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_evolution
        {
            internal uint struct_size;
            internal SnakeStop stop;
            internal int stop_rail;
            internal uint frame_count;
            internal double stop_distance;
            internal double time;
            internal double deviation;
            internal double residual;
            internal double height_residual;
            internal double incongruence;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_projection
        {
            internal uint struct_size;
            internal uint iterations;
            internal uint steps;
            internal int is_nearest;
            internal double residual;
            internal double moved;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_cycle_options
        {
            internal uint struct_size;
            internal uint max_steps;
            internal int is_reversed;
            internal uint reserved;
            internal double step;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_cycle
        {
            internal uint struct_size;
            internal SnakeCycleEnd end;
            internal uint free;
            internal uint frame_count;
            internal int first_turns;
            internal int last_turns;
            internal uint switch_count;
            internal uint reserved;
            internal double closing;
            internal double first_range;
            internal double last_range;
            internal double residual;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_covering_options
        {
            internal uint struct_size;
            internal uint per_arc;
            internal int comes_back;
            internal uint reserved;
            internal double tolerance;
            internal double distance;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct shapeop_snake_covering
        {
            internal uint struct_size;
            internal uint position_count;
            internal uint arc_count;
            internal uint kind_count;
            internal int is_compared;
            internal uint beyond_count;
            internal double length;
            internal double area;
            internal double residual;
            internal double reference_area;
            internal double coverage;
            internal double distance;
            internal double largest_deviation;
            internal double at_x;
            internal double at_y;
            internal double at_z;
            internal double rms_deviation;
        }

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        internal delegate int shapeop_progress_callback(ref shapeop_progress progress, IntPtr user);

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        internal delegate int shapeop_canal_progress_callback(ref shapeop_canal_progress progress, IntPtr user);

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        internal delegate int shapeop_ruled_progress_callback(ref shapeop_ruled_progress progress, IntPtr user);

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        internal delegate int shapeop_snake_progress_callback(ref shapeop_snake_progress progress, IntPtr user);

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
        internal static extern ErrorCode shapeop_setBackend(SolverHandle op, int backend);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_getBackend(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_setBackendOptions(
            SolverHandle op,
            byte[] adapter,
            double bindingBytes,
            double memoryBytes);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_backendInfo(SolverHandle op, ref shapeop_backend_info @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_backendReason(SolverHandle op);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_releaseBackend();

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

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalCreate(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] frame,
            int kind);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalFromJson(byte[] json);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalCopy(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_canalDelete(IntPtr surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_canalText(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_canalFamily(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_canalKind(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_canalChainCount(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalSize(CanalHandle surface, int[] rows, int[] columns, int[] wraps);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalPoints(
            CanalHandle surface,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFrames(
            CanalHandle surface,
            double[] frames,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalBasePoints(
            CanalHandle surface,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalRestoredPoints(
            CanalHandle surface,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvert(CanalHandle surface, double[] center, double ratio);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalTranslate(CanalHandle surface, double[] vector);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalScale(CanalHandle surface, double factor);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalRotate(CanalHandle surface, double[] axis, double angle);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCombescureFactors(
            CanalHandle surface,
            double[] column,
            int nbColumn,
            double[] row,
            int nbRow);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_canalUndo(CanalHandle surface);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalRefined(CanalHandle surface, int one, int two);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalRefinedAt(
            CanalHandle surface,
            double[] one,
            int nbOne,
            double[] two,
            int nbTwo);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalEvaluate(
            CanalHandle surface,
            int i,
            int j,
            double u,
            double v,
            double[] point,
            double[] frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalClosingGap(CanalHandle surface, double[] gap);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalMembraneResidual(CanalHandle surface, double[] residual);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalMembraneResidualOf(
            CanalHandle surface,
            double pressure,
            double[] forcesOne,
            double[] forcesTwo,
            int nbFaces,
            double[] residual);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalCreateWithKinks(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] frame,
            int kind,
            int direction,
            int[] lines,
            double[] angles,
            int nbKinks);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalKinks(
            CanalHandle surface,
            int[] direction,
            int[] lines,
            double[] angles,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCheckCircular(
            double[] points,
            int nbPoints,
            int[] quads,
            int nbQuads,
            double[] planarity,
            double[] concyclicity,
            int[] isInOrder);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCheckParallel(
            double[] a,
            double[] b,
            int nbPoints,
            int[] edges,
            int nbEdges,
            double[] largestSine,
            int[] reversedCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalGridLengths(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] column,
            double[] row);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalPolylineLengths(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] columnPoints,
            int nbColumnPoints,
            double[] rowPoints,
            int nbRowPoints,
            double[] column,
            double[] row);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCloseLengths(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] column,
            int nbColumn,
            double[] row,
            int nbRow,
            double[] outColumn,
            double[] outRow);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCombescure(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] column,
            int nbColumn,
            double[] row,
            int nbRow,
            double[] origin,
            double[] @out,
            int[] reversedCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalParallelSpace(
            double[] points,
            int nbPoints,
            int[] quads,
            int nbQuads,
            double[] basis,
            int capacity,
            int[] dimension);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalNearestParallel(
            double[] points,
            int nbPoints,
            int[] quads,
            int nbQuads,
            int[] handles,
            double[] targets,
            int nbHandles,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalGridOfMesh(
            double[] points,
            int nbPoints,
            int[] quads,
            int nbQuads,
            int component,
            int[] gridCount,
            int[] rows,
            int[] columns,
            int[] wraps,
            int[] indices,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFrameOfAngles(
            double lambda,
            double theta,
            double psi,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFrameOfTangent(
            double[] tangent,
            double[] normal,
            int direction,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFrameAcross(
            double[] frame,
            double[] edge,
            int direction,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalGridFrames(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] frame,
            double[] @out,
            double[] closingGap);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFolds(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] evoluteRatios,
            int[] isNearEvolute,
            double[] edgeRatios,
            int[] faceFlags);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvertPoints(
            double[] points,
            int nbPoints,
            double[] center,
            double ratio,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvertComplex(
            double[] points,
            int nbPoints,
            double[] center,
            double ratio,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvertCircle(
            double[] circle,
            double[] center,
            double ratio,
            double[] @out,
            int[] isLine);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvertSphere(
            double[] sphereCenter,
            double radius,
            double[] center,
            double ratio,
            double[] @out,
            int[] isPlane);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalInvertPlane(
            double[] point,
            double[] normal,
            double[] center,
            double ratio,
            double[] @out,
            int[] isPlane);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalDefaultSmoothOptions(ref shapeop_canal_smooth_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalSmooth(
            double[] guide,
            double[] border,
            int nbPoints,
            double[] frame,
            ref shapeop_canal_smooth_options options,
            shapeop_canal_progress_callback progress,
            IntPtr user,
            double[] outGuide,
            double[] outBorder,
            double[] parameters,
            double[] outFrame,
            double[] history,
            int capacity,
            int[] count,
            ref shapeop_canal_smooth_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStripEnergy(
            double[] guide,
            double[] border,
            int nbPoints,
            double[] frame,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStrip(
            double[] points,
            int nbPoints,
            double[] start,
            double[] lengths,
            uint flags,
            double[] border,
            double[] outLengths,
            double[] attainable,
            int[] isFlipped,
            int[] isProjected,
            double[] deviation);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStripOfRadii(
            double[] points,
            int nbPoints,
            double[] start,
            double[] radii,
            uint flags,
            double[] border,
            double[] outLengths,
            int[] isFlipped);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStripOfBorderEdges(
            double[] points,
            int nbPoints,
            double[] start,
            double[] edges,
            double[] border,
            double[] outLengths,
            int[] isFlipped);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalLengthsBetween(
            double[] points,
            int nbPoints,
            double first,
            double last,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalEdgesOfBorder(
            double[] points,
            int nbPoints,
            double length,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStripCircles(
            double[] guide,
            double[] border,
            int nbPoints,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalStripOfCircles(
            double[] circles,
            int nbCircles,
            double[] start,
            double[] end,
            double[] guide,
            double[] border,
            double[] distance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalHolonomy(
            double[] points,
            int nbPoints,
            double[] matrix,
            double[] residual,
            int[] closes,
            double[] tangent);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalClosedFrame(
            double[] points,
            int nbPoints,
            double[] wish,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalParallelOnSphere(
            double[] points,
            int nbPoints,
            double[] @out,
            int capacity,
            int[] count,
            int[] reversedCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCloseCircles(
            double[] firstCircle,
            double[] lastCircle,
            double[] start,
            double[] guideFirst,
            double[] guideLast,
            double[] circle,
            double[] first,
            double[] last,
            int[] whichCase,
            int[] isCrossed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCloseStrip(
            double[] guide,
            double[] border,
            int nbPoints,
            double[] last,
            double[] outBorder,
            double[] circle,
            int[] whichCase,
            int[] isFlipped);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCurvePoints(
            double[] points,
            int nbPoints,
            int isClosed,
            int spacing,
            double[] @out,
            double[] tangents,
            int nb);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalNormals(
            double[] points,
            double[] tangents,
            int nbPoints,
            int isClosed,
            double angle,
            double[] first,
            double[] normals,
            double[] frames);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalTouchingSpheres(
            double[] points,
            double[] normals,
            int nbPoints,
            double[] curve,
            int nbCurve,
            int isCurveClosed,
            double[] spheres,
            double[] offsets,
            double[] feet,
            int[] flags,
            double[] residual);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCharacteristicCircles(
            double[] spheres,
            int nbSpheres,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalDefaultFitOptions(ref shapeop_canal_fit_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalFit(
            double[] guide,
            int nbGuide,
            int isGuideClosed,
            double[] curve,
            int nbCurve,
            int isCurveClosed,
            ref shapeop_canal_fit_options options,
            double[] circles,
            int circleCapacity,
            int[] circleCount,
            double[] spheres,
            int[] sphereFlags,
            int sphereCapacity,
            int[] sphereCount,
            ref shapeop_canal_fit_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalSectionPoints(
            double[] circle,
            double[] start,
            double[] target,
            ref shapeop_canal_fit_options options,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalMeshCircles(
            double[] circles,
            double[] guide,
            int nbCircles,
            double[] row,
            int nbRow,
            int wraps,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalColumn(
            double[] circles,
            int nbCircles,
            double[] start,
            double[] guide,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalRevolution(
            double[] profile,
            int nbProfile,
            double[] axisPoint,
            double[] axisDirection,
            double angle,
            int columns);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalMoulding(
            double[] rail,
            int nbRail,
            double[] profile,
            int nbProfile,
            double[] obliquity,
            int[] reversedCount,
            double[] closingGap);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalMonge(
            double[] rail,
            int nbRail,
            double[] profile,
            int nbProfile,
            double[] obliquity,
            int[] reversedCount,
            double[] closingGap);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalTranslation(
            double[] rail,
            int nbRail,
            double[] profile,
            int nbProfile,
            double[] factors,
            double[] points,
            int capacity,
            int[] count,
            int[] rows,
            int[] columns,
            int[] wraps);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCenters(
            double[] corners,
            double[] circle,
            double[] centers,
            int[] isLine,
            double[] ratioLimits);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalCenter(
            double[] corners,
            int centerKind,
            double centerValue,
            double[] centerPoint,
            double[] center,
            int[] isInfinite,
            double[] omega,
            double[] ratio);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalMRevolution(
            double[] curve,
            int nbCurve,
            double[] p2,
            double[] p3,
            int centerKind,
            double centerValue,
            double[] centerPoint,
            double[] up,
            int columns,
            double[] omega,
            double[] axis);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalSphericalMRevolution(
            double[] curve,
            int nbCurve,
            double[] p2,
            double[] p3,
            double[] sphereCenter,
            double radius,
            double[] pole,
            int isOutside,
            int centerKind,
            double centerValue,
            double[] centerPoint,
            int columns,
            double[] omega,
            double[] axis);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalMMoulding(
            double[] curve,
            int nbCurve,
            double[] rail,
            int nbRail,
            double[] p3,
            int centerKind,
            double centerValue,
            double[] centerPoint,
            double[] obliquity,
            int[] reversedCount,
            double[] closingGap,
            double[] cornerGap);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern CanalHandle shapeop_canalCCanal(
            double[] guide,
            int nbGuide,
            double[] section,
            int nbSection,
            double[] lengths,
            double[] curve,
            int nbCurve,
            int isCurveClosed,
            int projectsLengths,
            shapeop_canal_progress_callback progress,
            IntPtr user,
            double[] outLengths,
            double[] deviations,
            double[] attainable,
            int[] isProjected,
            int[] isCancelled);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_canalFamilyCount();

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_canalFamilyName(int index);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalFamilySteps(
            byte[] name,
            int[] kind,
            int[] steps,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalProperties(CanalHandle surface, ref shapeop_canal_properties @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalNodeAxes(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] first,
            double[] axes,
            double[] gaps);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalNodeAxesOfLeastGaps(
            double[] points,
            int rows,
            int columns,
            int wraps,
            shapeop_canal_progress_callback progress,
            IntPtr user,
            double[] axes,
            double[] gaps,
            int[] isCancelled);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalNodeGaps(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] axes,
            double height,
            double[] gaps,
            double[] depths);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalOffset(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] axes,
            double distance,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalBeams(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] axes,
            double height,
            int[] nodes,
            double[] corners,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_canalPanels(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] axes,
            double thickness,
            double[] outlines,
            double[] lowerOutlines,
            double[] mitres,
            double[] circles,
            double[] heights);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_canalPartsText(
            double[] points,
            int rows,
            int columns,
            int wraps,
            double[] axes,
            double thickness,
            double height);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultOptions(ref shapeop_ruled_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern RuledHandle shapeop_ruledCreate(
            double[] points,
            int nbPoints,
            int[] faceIndices,
            int nbFaceIndices,
            int[] counts,
            int nbCounts,
            ref shapeop_ruled_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern RuledHandle shapeop_ruledCopy(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_ruledDelete(IntPtr design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSelectFamily(
            RuledHandle design,
            int family,
            double[] hint,
            int allowCut);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledTriangles(
            RuledHandle design,
            int[] triangles,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledCurvatures(
            RuledHandle design,
            double[] principal,
            double[] directions,
            double[] normals,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDirections(
            RuledHandle design,
            int family,
            double[] directions,
            int[] status,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledField(
            RuledHandle design,
            double[] directions,
            int[] isKnown,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledFlips(RuledHandle design, int[] edges, int capacity, int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledTrace(
            RuledHandle design,
            double[] seed,
            int isBackward,
            double step,
            double length,
            double[] points,
            int capacity,
            int[] count,
            int[] end);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultLevelOptions(
            int kind,
            ref shapeop_ruled_level_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetLevelBoundaries(
            RuledHandle design,
            ref shapeop_ruled_level_options options,
            int count,
            double width,
            double[] values,
            int nbValues,
            ref shapeop_ruled_boundary_options boundaries,
            shapeop_ruled_progress_callback progress,
            IntPtr user);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetLevels(
            RuledHandle design,
            int count,
            double width,
            double[] values,
            int nbValues,
            ref shapeop_ruled_boundary_options boundaries);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledLevelValues(
            RuledHandle design,
            double[] values,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledLevelHistory(
            RuledHandle design,
            double[] values,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledCriticalPoints(
            RuledHandle design,
            int[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledLevelReport(
            RuledHandle design,
            ref shapeop_ruled_level_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultBoundaryOptions(ref shapeop_ruled_boundary_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetPlanarBoundaries(
            RuledHandle design,
            double[] planes,
            int nbPlanes,
            double leastAngle,
            int refusesOblique,
            ref shapeop_ruled_boundary_options boundaries,
            double[] angles);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetGreatCircleBoundaries(
            RuledHandle design,
            double[] axes,
            int nbAxes,
            ref shapeop_ruled_boundary_options boundaries);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledGreatCircle(
            RuledHandle design,
            double[] axis,
            double[] points,
            int capacity,
            int[] count,
            int[] lengths,
            int curveCapacity,
            int[] curveCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetDrawnBoundaries(
            RuledHandle design,
            double[] points,
            int nbPoints,
            int[] counts,
            int nbCounts,
            int[] isClosed,
            ref shapeop_ruled_boundary_options boundaries);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_ruledBoundaryCount(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledBoundary(
            RuledHandle design,
            int boundary,
            double[] points,
            int capacity,
            int[] count,
            int[] isClosed,
            double[] level);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledBoundaryAxis(
            RuledHandle design,
            int boundary,
            double[] axis,
            double[] error);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledBoundaryPairs(
            RuledHandle design,
            int[] pairs,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledUnmatchedLevels(
            RuledHandle design,
            double[] levels,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDroppedCurves(
            RuledHandle design,
            double[] levels,
            double[] lengths,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledStart(RuledHandle design, int controlCount, int isShared);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledStarted(
            RuledHandle design,
            int[] missed,
            int[] moved,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_ruledStripCount(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledJoints(
            RuledHandle design,
            int[] pairs,
            int capacity,
            int[] count,
            int[] isShared);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledControl(
            RuledHandle design,
            int strip,
            double[] control,
            int capacity,
            int[] count,
            int[] isClosed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledKnots(
            RuledHandle design,
            int strip,
            double[] knots,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetControl(
            RuledHandle design,
            int strip,
            double[] control,
            int count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledSetStripsText(RuledHandle design, byte[] json);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledStripsText(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledEvaluate(
            RuledHandle design,
            int strip,
            double u,
            double v,
            double[] point,
            double[] derivatives,
            double[] normal);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainPlane(RuledHandle design, int boundary, double[] plane);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainCutPlanes(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainPoint(
            RuledHandle design,
            int strip,
            int side,
            int end,
            double[] point);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainEnds(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainEndDirection(
            RuledHandle design,
            int strip,
            int end,
            double[] direction);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledConstrainConoid(RuledHandle design, int strip, double[] axis);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_ruledConditionCount(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledClearConditions(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultOptimiseOptions(ref shapeop_ruled_optimise_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledOptimise(
            RuledHandle design,
            ref shapeop_ruled_optimise_options options,
            shapeop_ruled_progress_callback progress,
            IntPtr user,
            ref shapeop_ruled_optimise_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledHistory(
            RuledHandle design,
            double[] rows,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultReportOptions(ref shapeop_ruled_report_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledReport(
            RuledHandle design,
            ref shapeop_ruled_report_options options,
            ref shapeop_ruled_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledStripReport(
            RuledHandle design,
            int strip,
            ref shapeop_ruled_strip_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledJointReport(
            RuledHandle design,
            int joint,
            ref shapeop_ruled_joint_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledTooWide(
            RuledHandle design,
            int[] strips,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledReportText(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledMesh(
            RuledHandle design,
            int strip,
            int columnsPerSpan,
            int rows,
            double[] points,
            double[] normals,
            int capacity,
            int[] count,
            int[] faces,
            int[] stripOf,
            int faceCapacity,
            int[] faceCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledTrimmedMesh(
            RuledHandle design,
            int strip,
            int columnsPerSpan,
            double tolerance,
            double[] points,
            double[] normals,
            int capacity,
            int[] count,
            int[] faces,
            int[] stripOf,
            int faceCapacity,
            int[] faceCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledRulings(
            RuledHandle design,
            int strip,
            int rulings,
            int isTrimmed,
            double[] ends,
            double[] parameters,
            int[] stripOf,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledSurfacesObj(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledRulingsObj(RuledHandle design, int rulings);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledRulingsCsv(RuledHandle design, int rulings);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledZebra(
            double[] points,
            double[] normals,
            int nbPoints,
            double[] eye,
            int isParallel,
            double[] direction,
            int nbStripes,
            double turn,
            double[] @out);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDefaultPlankOptions(ref shapeop_ruled_plank_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledStripAxis(
            RuledHandle design,
            int strip,
            double[] axis,
            double[] deviation);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledCutPlanks(
            RuledHandle design,
            int strip,
            ref shapeop_ruled_plank_options options,
            double[] axis,
            ref shapeop_ruled_planks planks);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledPlank(
            RuledHandle design,
            int index,
            ref shapeop_ruled_plank plank,
            double[] frame,
            double[] outline,
            double[] rulings);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_ruledDowels(
            RuledHandle design,
            int side,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledPlanksText(RuledHandle design);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_ruledPlanksSvg(RuledHandle design, byte[] name, double millimetres);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SnakeHandle shapeop_snakeCreate(
            double[] control,
            int nbControl,
            int isClosed,
            double firstTangent);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SnakeHandle shapeop_snakeCreateFromArcs(
            double[] radii,
            double[] lengths,
            int nbArcs,
            double[] torsions,
            int nbTorsions,
            double[] point,
            double[] tangent,
            double[] normal);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SnakeHandle shapeop_snakeCopy(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern void shapeop_snakeDelete(IntPtr snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeReport(SnakeHandle snake, ref shapeop_snake_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeControl(
            SnakeHandle snake,
            double[] control,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetControl(SnakeHandle snake, double[] control, int nbControl);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeContacts(
            SnakeHandle snake,
            double[] contacts,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeShapes(
            SnakeHandle snake,
            double[] radii,
            double[] lengths,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeTorsions(
            SnakeHandle snake,
            double[] torsions,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeArcs(
            SnakeHandle snake,
            int frame,
            double[] arcs,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSample(
            SnakeHandle snake,
            int frame,
            int perArc,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeFreedoms(
            SnakeHandle snake,
            int onSurface,
            int[] free,
            int[] conditions,
            int[] rank);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDefaultFitOptions(ref shapeop_snake_fit_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SnakeHandle shapeop_snakeFit(
            double[] points,
            int nbPoints,
            int isClosed,
            int nbArcs,
            ref shapeop_snake_fit_options options,
            ref shapeop_snake_fit_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDefaultCurveOptions(ref shapeop_snake_curve_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCurve(
            int kind,
            double[] numbers,
            int nbNumbers,
            double[] start,
            double[] tangent,
            double[] curvatures,
            int nbCurvatures,
            double length,
            ref shapeop_snake_curve_options options,
            double[] points,
            int capacity,
            int[] count,
            ref shapeop_snake_curve_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeMeshCurve(
            double[] meshPoints,
            int nbMeshPoints,
            int[] faceIndices,
            int nbFaceIndices,
            int[] counts,
            int nbCounts,
            double[] start,
            double[] tangent,
            double[] curvatures,
            int nbCurvatures,
            double length,
            ref shapeop_snake_curve_options options,
            double[] points,
            int capacity,
            int[] count,
            ref shapeop_snake_curve_report report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetMesh(
            SnakeHandle snake,
            double[] points,
            int nbPoints,
            int[] faceIndices,
            int nbFaceIndices,
            int[] counts,
            int nbCounts);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetSurface(
            SnakeHandle snake,
            int kind,
            double[] numbers,
            int nbNumbers);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeClearSurface(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetDirection(SnakeHandle snake, int kind, double[] along);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetSpeeds(SnakeHandle snake, double[] speeds, int nbSpeeds);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSetFixed(SnakeHandle snake, int[] points, int nbPoints);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeWishVelocity(
            SnakeHandle snake,
            int point,
            double[] velocity,
            double weight);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeWishPlane(
            SnakeHandle snake,
            int point,
            double[] normal,
            double weight);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeClearWishes(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeDriveRail(
            SnakeHandle snake,
            int point,
            double[] points,
            int nbPoints,
            int isClosed,
            double speed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeFollowRail(
            SnakeHandle snake,
            int point,
            double[] points,
            int nbPoints,
            int isClosed,
            int leader);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeGlideRail(
            SnakeHandle snake,
            int contact,
            double[] points,
            int nbPoints,
            int isClosed);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeRailCount(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeClearRails(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDefaultOptions(ref shapeop_snake_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeVelocity(
            SnakeHandle snake,
            ref shapeop_snake_options options,
            double[] velocities,
            int capacity,
            int[] count,
            double[] residual);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeProject(
            SnakeHandle snake,
            double[] target,
            int nbTarget,
            ref shapeop_snake_options options,
            ref shapeop_snake_projection report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeEvolve(
            SnakeHandle snake,
            ref shapeop_snake_options options,
            shapeop_snake_progress_callback progress,
            IntPtr user,
            ref shapeop_snake_evolution report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeFrameCount(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeFrames(
            SnakeHandle snake,
            double[] control,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeFrameRows(
            SnakeHandle snake,
            double[] rows,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeTakeFrame(SnakeHandle snake, int frame);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCongruence(
            SnakeHandle snake,
            int a,
            int b,
            double[] rms,
            double[] distances);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDefaultCycleOptions(ref shapeop_snake_cycle_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCycle(
            SnakeHandle snake,
            ref shapeop_snake_cycle_options options,
            shapeop_snake_progress_callback progress,
            IntPtr user,
            ref shapeop_snake_cycle report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern int shapeop_snakeLinkageFreedoms(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDeterminant(SnakeHandle snake, double[] determinant);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCycleAngles(
            SnakeHandle snake,
            double[] angles,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeContactPath(
            SnakeHandle snake,
            int contact,
            double[] points,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeAtPhases(
            SnakeHandle snake,
            double[] phases,
            int nbPhases,
            double[] control,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCopies(
            SnakeHandle snake,
            int nbCopies,
            double phase,
            double shift,
            double[] offset,
            double[] control,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeSweepMesh(
            SnakeHandle snake,
            int perArc,
            int comesBack,
            double[] points,
            int capacity,
            int[] count,
            int[] quads,
            int quadCapacity,
            int[] quadCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakePipe(
            SnakeHandle snake,
            int frame,
            double radius,
            int perArc,
            int around,
            double[] points,
            int capacity,
            int[] count,
            int[] quads,
            int quadCapacity,
            int[] quadCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeLamellae(
            SnakeHandle snake,
            int frame,
            int kind,
            double[] along,
            double depth,
            int perArc,
            double[] points,
            int capacity,
            int[] count,
            int[] quads,
            int quadCapacity,
            int[] quadCount);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeKinds(
            SnakeHandle snake,
            double tolerance,
            double[] kinds,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeKindOf(
            SnakeHandle snake,
            double tolerance,
            int[] kindOf,
            int capacity,
            int[] count);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeDefaultCoveringOptions(ref shapeop_snake_covering_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern ErrorCode shapeop_snakeCovering(
            SnakeHandle snake,
            ref shapeop_snake_covering_options options,
            ref shapeop_snake_covering report);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeCoveringText(
            SnakeHandle snake,
            ref shapeop_snake_covering_options options);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern SnakeHandle shapeop_snakeCreateFromText(byte[] json);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeText(SnakeHandle snake);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeArcsText(SnakeHandle snake, int frame, double tolerance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeArcsCsv(SnakeHandle snake, int frame, double tolerance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeKindsCsv(SnakeHandle snake, int frame, double tolerance);

        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        internal static extern IntPtr shapeop_snakeArcsDxf(SnakeHandle snake, int frame, double tolerance);
    }
}
