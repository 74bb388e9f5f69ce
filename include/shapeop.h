/* shapeop: constraint-based geometry. C99 and C++.
 *
 * Generated from the sources of the library: do not edit.
 *
 * Handles. A ShapeOpSolver* is a small integer (nonzero, below 2^31), not an address: never dereference it. A null
 * handle, one that was deleted, and one that never was a solver's are recognised and refused. Only the low 32 bits
 * count. A ShapeOpCanal* is a handle of a surface, a ShapeOpRuled* of a design of ruled strips, a ShapeOpSnake* of a
 * circular arc snake, and what is said of solvers here holds for them too.
 *
 * Ownership. Every solver of shapeop_create belongs to the caller, who deletes it with shapeop_delete, and every
 * surface, who deletes it with shapeop_canalDelete, every design, who deletes it with shapeop_ruledDelete, and every
 * snake, who deletes it with shapeop_snakeDelete. Arrays belong to the caller: the library copies what it reads and
 * keeps no pointer. Texts belong to the library and are never freed; how long they stay valid is said with each
 * function.
 *
 * Arrays. Points are double[3 * n]: x y z of point 0, then of point 1, and so on. Lengths of points are counted in
 * points, all others in entries. An array of length 0 may be null. Results are written only if the call succeeds.
 * Where a number of results is not known beforehand, the call takes a capacity and tells the count: a null array with
 * capacity 0 only asks for it, and one that is too small is left as it is. Circles are double[7]: the center, the unit
 * vector along the axis, the radius. Frames are read as double[6], the unit tangents t1 and t2, and written as
 * double[9], with the normal t1 x t2. Grids are rows times columns points, row by row.
 *
 * Errors. A refused call changes nothing, and answers with an error code, with 1 (shapeop_init, shapeop_initDynamic,
 * shapeop_solve), with -1 (ids, counts, truths) or with null (handles, texts). In all cases, functions without a result
 * included, shapeop_lastError then says why and shapeop_lastErrorCode gives the code; after a call that succeeded the
 * text is empty and the code SO_SUCCESS. Of calls on surfaces, designs and snakes, and of those that take no handle,
 * shapeop_lastError of null tells. Numbers that are not finite are refused where they enter, and none is ever handed
 * out.
 *
 * Threads. Any thread may use any solver. A call on a solver that another call is using does not wait: it is refused
 * as busy. Different solvers can be used at the same time. From inside its own progress callback a solver can be read
 * (points, counts, energy, violations) and nothing else.
 *
 * Units. Lengths are in model units, angles in radians, times in seconds; what a violation is measured in depends on
 * the type of its constraint: see shapeop_constraint_type.
 *
 * Versions. Structs begin with struct_size, to be set to their sizeof: fields may be added at their ends. */


#ifndef SHAPEOP_H
#define SHAPEOP_H


#ifndef SHAPEOP_API
#ifdef _WIN32
#define SHAPEOP_API __declspec(dllimport)
#else
#define SHAPEOP_API
#endif
#endif

/**
 * The version of the ABI that `shapeop_abiVersion` answers: raised when a caller must know of a change. Functions,
 * error codes and fields at the end of structs may be added without that.
 */
#define SHAPEOP_ABI_VERSION 1

/**
 * A bit of the flags of `shapeop_addConstraints`: the constraints are hard.
 */
#define SHAPEOP_HARD 1

/**
 * A bit of `wraps`: row 0 of a grid follows the last row.
 */
#define SHAPEOP_WRAPS_ROWS 1

/**
 * A bit of `wraps`: column 0 of a grid follows the last column.
 */
#define SHAPEOP_WRAPS_COLUMNS 2

/**
 * A bit of the flags of `shapeop_canalFolds`: the face is turned against most of its neighbours.
 */
#define SHAPEOP_FACE_FLIPPED 1

/**
 * A bit of the flags of `shapeop_canalFolds`: an edge of the face is shorter than a twentieth of the one opposite.
 */
#define SHAPEOP_FACE_SHRUNK 2

/**
 * A bit of the flags of `shapeop_canalStrip`: quads that cross themselves are refused.
 */
#define SHAPEOP_STRIP_STRICT 1

/**
 * A bit of the flags of `shapeop_canalStrip`: a length that is not attainable is replaced by the nearest that is.
 */
#define SHAPEOP_STRIP_PROJECT_LENGTHS 2

/**
 * A bit of the flags of `shapeop_canalStrip`: the first crossing edge is turned to where the lengths can go on.
 */
#define SHAPEOP_STRIP_FIT_START 4

/**
 * A bit of the flags of spheres: the sphere passes through an end of the second curve and is not tangent to it.
 */
#define SHAPEOP_SPHERE_END 1

/**
 * A bit of the flags of spheres: it touches the second curve on another branch than the sphere before.
 */
#define SHAPEOP_SPHERE_JUMP 2

/**
 * A bit of the flags of spheres: its center is on the other side of the first curve than that of the sphere before.
 */
#define SHAPEOP_SPHERE_SIGN_CHANGE 4

/**
 * A bit of the flags of spheres: another branch of the second curve is inside.
 */
#define SHAPEOP_SPHERE_PIERCED 8

/**
 * For `strip`: all strips.
 */
#define SHAPEOP_RULED_ALL -1

/**
 * For `frame`: the snake as it is.
 */
#define SHAPEOP_SNAKE_NOW -1

/**
 * For `frame`, where that is said: all positions found last.
 */
#define SHAPEOP_SNAKE_ALL -2

#if !defined(SHAPEOP_COMPAT_API_H)
/**
 * Why a call was refused. The numbers are frozen: 0 to 3 are those of libShapeOp 0.1.0, new ones are added from 16 up.
 */
typedef enum shapeop_err {
    /**
     * The call did what it says.
     */
    SO_SUCCESS = 0,
    /**
     * The constraint type does not exist, or cannot be edited.
     */
    SO_INVALID_CONSTRAINT_TYPE = 1,
    /**
     * A count (of indices, scalars, points) does not fit.
     */
    SO_INVALID_ARGUMENT_LENGTH = 2,
    /**
     * The id is no constraint of that type.
     */
    SO_UNMATCHING_CONSTRAINT_ID = 3,
    /**
     * A number is outside its domain, or not finite.
     */
    SO_INVALID_VALUE = 16,
    /**
     * An index is out of range.
     */
    SO_INDEX_OUT_OF_RANGE = 17,
    /**
     * The id is no force of that kind.
     */
    SO_UNMATCHING_FORCE_ID = 18,
    /**
     * Another call must come first: a solver is not initialised, or nothing was found yet that could be told.
     */
    SO_NOT_INITIALISED = 19,
    /**
     * A force acts along a motion that no constraint resists.
     */
    SO_UNBOUNDED = 20,
    /**
     * Another call is using the solver, surface, design or snake.
     */
    SO_BUSY = 21,
    /**
     * The handle is null, was deleted, or never was one of such an object.
     */
    SO_INVALID_HANDLE = 22,
    /**
     * A required pointer is null.
     */
    SO_NULL_POINTER = 23,
    /**
     * A file or text could not be read as what it claims to be.
     */
    SO_INVALID_INPUT = 24,
    /**
     * The problem is too large for this machine or for the numbers of this ABI.
     */
    SO_TOO_LARGE = 25,
    /**
     * An error inside the library: please report it.
     */
    SO_INTERNAL = 26,
    /**
     * The mesh is no grid of quads.
     */
    SO_NOT_GRID = 27,
    /**
     * Points that must be on one plane are not.
     */
    SO_NOT_PLANAR = 28,
    /**
     * Points that must be on one circle are not.
     */
    SO_NOT_CIRCULAR = 29,
    /**
     * The input is in a special position where no answer is defined.
     */
    SO_DEGENERATE = 30,
    /**
     * Two shapes that must meet do not.
     */
    SO_NO_INTERSECTION = 31,
    /**
     * No solution exists for this input.
     */
    SO_NO_SOLUTION = 32,
    /**
     * Equations do not determine an answer: edges of a quad that are to meet are parallel, or derivatives lose rank.
     */
    SO_SINGULAR = 33,
    /**
     * A ring does not close.
     */
    SO_NOT_CLOSED = 34,
    /**
     * The mesh is no oriented surface: an edge has more than two faces, or faces disagree about what is up.
     */
    SO_NOT_MANIFOLD = 35,
    /**
     * The surface is not negatively curved where it must be.
     */
    SO_CURVATURE_SIGN = 36,
    /**
     * No consistent choice of directions exists over the whole surface.
     */
    SO_NOT_ORIENTABLE = 37,
    /**
     * Side conditions contradict each other.
     */
    SO_INFEASIBLE = 38,
    /**
     * What is asked for lies outside the surface, or outside the values of a function.
     */
    SO_OUT_OF_DOMAIN = 39,
    /**
     * There is no graphics card to solve on, or not enough of it; or the library was built without the feature `gpu`.
     */
    SO_BACKEND_UNAVAILABLE = 40,
    /**
     * The graphics card was lost or refused work; the points are those of the last read-back.
     */
    SO_BACKEND_FAILED = 41,
} shapeop_err;
#endif

/**
 * What a type promises of its projection.
 */
typedef enum shapeop_projection {
    /**
     * The nearest feasible configuration: plain iterations never raise the energy.
     */
    SO_PROJECTION_NEAREST = 0,
    /**
     * A feasible configuration, not always the nearest.
     */
    SO_PROJECTION_FEASIBLE = 1,
    /**
     * A step towards a feasible configuration.
     */
    SO_PROJECTION_APPROXIMATE = 2,
} shapeop_projection;

/**
 * Why a solve ended.
 */
typedef enum shapeop_outcome {
    /**
     * The largest move fell below the tolerance.
     */
    SO_OUTCOME_CONVERGED = 0,
    /**
     * The iterations were used up.
     */
    SO_OUTCOME_ITERATION_LIMIT = 1,
    /**
     * The time was used up.
     */
    SO_OUTCOME_TIME_BUDGET = 2,
    /**
     * The callback said so.
     */
    SO_OUTCOME_CANCELLED = 3,
    /**
     * Neither the energy nor the largest move fell any more.
     */
    SO_OUTCOME_STALLED = 4,
    /**
     * A force acts along a motion that no constraint resists, and the points did not move. `shapeop_lastError` says
     * which.
     */
    SO_OUTCOME_UNBOUNDED = 5,
    /**
     * Hard constraints contradict each other; `shapeop_getConflicts` names a small set, and the points meet the others.
     */
    SO_OUTCOME_INFEASIBLE = 6,
    /**
     * The graphics card was lost or refused work; the points are those of the last read-back. `shapeop_lastError` says
     * what happened.
     */
    SO_OUTCOME_BACKEND_FAILED = 7,
} shapeop_outcome;

/**
 * How the linear system of an iteration is solved: see `shapeop_setLinearSolver`.
 */
typedef enum shapeop_linear_solver {
    /**
     * The default: a factor if it is predicted to take at most 2 GB while it is computed, else conjugate gradients.
     */
    SO_LINEAR_SOLVER_AUTOMATIC = 0,
    /**
     * A Cholesky factor, computed once and used in every iteration.
     */
    SO_LINEAR_SOLVER_DIRECT = 1,
    /**
     * Conjugate gradients, preconditioned by multigrid, from the current points: far less memory, and no factor to compute.
     */
    SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS = 2,
} shapeop_linear_solver;

/**
 * What carries out the iterations of a solve: see `shapeop_setBackend`.
 */
typedef enum shapeop_backend {
    /**
     * The default: the processor, in double precision.
     */
    SO_BACKEND_CPU = 0,
    /**
     * The graphics card, in single precision; what a tolerance asks for beyond that the processor finishes.
     */
    SO_BACKEND_GPU = 1,
    /**
     * The card where there is one that is faster on the model at hand, which the first iterations measure; else, and
     * where anything is missing, the processor.
     */
    SO_BACKEND_AUTOMATIC = 2,
} shapeop_backend;

/**
 * What kind of adapter it is, the fastest first.
 */
typedef enum shapeop_adapter_kind {
    /**
     * A card with memory of its own.
     */
    SO_ADAPTER_DISCRETE = 0,
    /**
     * A part of the processor that shares its memory.
     */
    SO_ADAPTER_INTEGRATED = 1,
    /**
     * A card that a virtual machine lends.
     */
    SO_ADAPTER_VIRTUAL = 2,
    /**
     * Not known.
     */
    SO_ADAPTER_OTHER = 3,
    /**
     * A program that behaves like a card: for tests.
     */
    SO_ADAPTER_SOFTWARE = 4,
} shapeop_adapter_kind;

/**
 * Why smoothing stopped.
 */
typedef enum shapeop_canal_stop {
    /**
     * The gradient is as small as asked for.
     */
    SO_CANAL_STOP_GRADIENT = 0,
    /**
     * The value hardly falls any more.
     */
    SO_CANAL_STOP_DECREASE = 1,
    /**
     * All iterations were used.
     */
    SO_CANAL_STOP_ITERATIONS = 2,
    /**
     * No step lowers the value: it is as good as rounding allows, or at the border of what is feasible.
     */
    SO_CANAL_STOP_LINE_SEARCH = 3,
    /**
     * The callback said so.
     */
    SO_CANAL_STOP_CANCELLED = 4,
    /**
     * The start is not feasible.
     */
    SO_CANAL_STOP_INFEASIBLE = 5,
} shapeop_canal_stop;

/**
 * Why a run stopped.
 */
typedef enum shapeop_ruled_stop {
    /**
     * There was nothing to iterate.
     */
    SO_RULED_STOP_NONE = 0,
    /**
     * Steps or decreases became small.
     */
    SO_RULED_STOP_CONVERGED = 1,
    /**
     * All iterations were used.
     */
    SO_RULED_STOP_ITERATIONS = 2,
    /**
     * No step lowers the value: it is as good as rounding allows.
     */
    SO_RULED_STOP_LINE_SEARCH = 3,
    /**
     * The callback said so.
     */
    SO_RULED_STOP_CANCELLED = 4,
} shapeop_ruled_stop;

/**
 * What the spherical image of a field is like.
 */
typedef enum shapeop_ruled_image {
    /**
     * It was not asked for: the weight `conoidal` was 0.
     */
    SO_RULED_IMAGE_NONE = 0,
    /**
     * It covers a part of the sphere.
     */
    SO_RULED_IMAGE_REGULAR = 1,
    /**
     * It covers a part of the sphere twice.
     */
    SO_RULED_IMAGE_FOLDED = 2,
    /**
     * It collapsed to a great circle: every strip is conoidal, and the weight was not used.
     */
    SO_RULED_IMAGE_GREAT_CIRCLE = 3,
    /**
     * It collapsed to another curve: the surface is ruled, and the weight was not used.
     */
    SO_RULED_IMAGE_CURVE = 4,
} shapeop_ruled_image;

/**
 * Why a curve of given curvature ends.
 */
typedef enum shapeop_snake_curve_end {
    /**
     * It is as long as asked for.
     */
    SO_SNAKE_CURVE_LENGTH = 0,
    /**
     * At the boundary of the surface.
     */
    SO_SNAKE_CURVE_BOUNDARY = 1,
    /**
     * The surface itself bends more along the curve than the curve may.
     */
    SO_SNAKE_CURVE_BENDS_MORE = 2,
    /**
     * The surface has no tangent plane there, or folds.
     */
    SO_SNAKE_CURVE_FOLD = 3,
} shapeop_snake_curve_end;

/**
 * Why an evolution stopped.
 */
typedef enum shapeop_snake_stop {
    /**
     * All steps were made.
     */
    SO_SNAKE_STOP_STEPS = 0,
    /**
     * The next position would be farther from the surface than allowed: see `stop_distance`.
     */
    SO_SNAKE_STOP_DEVIATION = 1,
    /**
     * Velocities, or positions, are not determined.
     */
    SO_SNAKE_STOP_SINGULAR = 2,
    /**
     * A rail ended, or the snake left it: see `stop_rail` and `stop_distance`.
     */
    SO_SNAKE_STOP_RAIL_END = 3,
    /**
     * A rail that the snake glides on became parallel to it: see `stop_rail`.
     */
    SO_SNAKE_STOP_PARALLEL = 4,
    /**
     * The snake is back at its start.
     */
    SO_SNAKE_STOP_CYCLE = 5,
    /**
     * It does not move any more.
     */
    SO_SNAKE_STOP_STALLED = 6,
    /**
     * The callback said so.
     */
    SO_SNAKE_STOP_CANCELLED = 7,
} shapeop_snake_stop;

/**
 * Why a linkage's motion ends.
 */
typedef enum shapeop_snake_cycle_end {
    /**
     * It came back to the start.
     */
    SO_SNAKE_CYCLE_CLOSED = 0,
    /**
     * All steps were used.
     */
    SO_SNAKE_CYCLE_STEPS = 1,
    /**
     * At the last position it can move in another number of ways than one: see `free`.
     */
    SO_SNAKE_CYCLE_FREEDOMS = 2,
    /**
     * No step leads on.
     */
    SO_SNAKE_CYCLE_STALLED = 3,
    /**
     * The callback said so.
     */
    SO_SNAKE_CYCLE_CANCELLED = 4,
} shapeop_snake_cycle_end;

/**
 * How iterations are accelerated: see `shapeop_setAcceleration`.
 */
typedef enum shapeop_acceleration {
    /**
     * Not at all: every iteration is one local and one global step.
     */
    SO_ACCELERATION_NONE = 0,
    /**
     * Safeguarded Anderson acceleration.
     */
    SO_ACCELERATION_ANDERSON = 1,
    /**
     * L-BFGS with the matrix of the global step as initial Hessian, and a line search.
     */
    SO_ACCELERATION_QUASI_NEWTON = 2,
    /**
     * The default: none in `shapeop_solve`, quasi-Newton in `shapeop_solveUntil`.
     */
    SO_ACCELERATION_AUTOMATIC = 3,
} shapeop_acceleration;

/**
 * What the fairness term measures displacements with.
 */
typedef enum shapeop_fairness {
    /**
     * The displacement of a point minus the mean of its neighbours'. The lists are faces, or edges as lists of two.
     */
    SO_FAIRNESS_LAPLACIAN = 0,
    /**
     * Second differences along polylines, which the lists are; a closed one repeats its first point at its end.
     */
    SO_FAIRNESS_SECOND_DIFFERENCES = 1,
    /**
     * Third differences along polylines.
     */
    SO_FAIRNESS_THIRD_DIFFERENCES = 2,
} shapeop_fairness;

/**
 * What the base of a surface is; it decides on the name of its family only.
 */
typedef enum shapeop_canal_kind {
    /**
     * A canal surface: its sections are circles.
     */
    SO_CANAL_KIND_CANAL = 0,
    /**
     * A surface of revolution.
     */
    SO_CANAL_KIND_REVOLUTION = 1,
    /**
     * A moulding surface.
     */
    SO_CANAL_KIND_MOULDING = 2,
    /**
     * Any circular net.
     */
    SO_CANAL_KIND_CIRCULAR = 3,
} shapeop_canal_kind;

/**
 * How points are spread over a curve.
 */
typedef enum shapeop_canal_spacing {
    /**
     * At equal lengths of the curve.
     */
    SO_CANAL_SPACING_ARC_LENGTH = 0,
    /**
     * At equal steps of its parameter, the length of chords along the given points.
     */
    SO_CANAL_SPACING_PARAMETER = 1,
    /**
     * The points that were given.
     */
    SO_CANAL_SPACING_POINTS = 2,
} shapeop_canal_spacing;

/**
 * Which part of a circle is meshed, from a point of it on.
 */
typedef enum shapeop_canal_section {
    /**
     * All of it; the mesh closes around it.
     */
    SO_CANAL_SECTION_WHOLE = 0,
    /**
     * From the angle `from_angle` to `to_angle`, less than a full turn.
     */
    SO_CANAL_SECTION_ANGLES = 1,
    /**
     * From the point to the one nearest to where the second curve passes.
     */
    SO_CANAL_SECTION_TO_CURVE = 2,
    /**
     * What is above a plane.
     */
    SO_CANAL_SECTION_ABOVE = 3,
} shapeop_canal_section;

/**
 * Which center of inversion an M-revolution surface takes: a point of the circle of centers, see
 * `shapeop_canalCenters`.
 */
typedef enum shapeop_canal_center {
    /**
     * The middle of the outer arc of the circle of centers.
     */
    SO_CANAL_CENTER_MIDDLE = 0,
    /**
     * The point at the angle `center_value`, in radians, on the circle of centers: 0 is the middle of the inner arc,
     * pi that of the outer one.
     */
    SO_CANAL_CENTER_ANGLE = 1,
    /**
     * The point inside the given circle for which the parallel sides have the ratio `center_value`.
     */
    SO_CANAL_CENTER_RATIO_INSIDE = 2,
    /**
     * The point outside the given circle for which the parallel sides have the ratio `center_value`.
     */
    SO_CANAL_CENTER_RATIO_OUTSIDE = 3,
    /**
     * The point `center_point`.
     */
    SO_CANAL_CENTER_POINT = 4,
    /**
     * On the chord from the rail's start to its end; for M-moulding surfaces.
     */
    SO_CANAL_CENTER_CHORD = 5,
} shapeop_canal_center;

/**
 * What a transformation keeps.
 */
typedef enum shapeop_canal_step {
    /**
     * A similarity: the family.
     */
    SO_CANAL_STEP_SIMILARITY = 0,
    /**
     * An inversion: circles and angles.
     */
    SO_CANAL_STEP_MOEBIUS = 1,
    /**
     * A Combescure transformation: the directions of edges.
     */
    SO_CANAL_STEP_COMBESCURE = 2,
} shapeop_canal_step;

/**
 * What was found at a point of a mesh.
 */
typedef enum shapeop_ruled_point {
    /**
     * Two asymptotic directions.
     */
    SO_RULED_POINT_GOOD = 0,
    /**
     * The surface is flat or positively curved there: it has none.
     */
    SO_RULED_POINT_NOT_NEGATIVE = 1,
    /**
     * Its neighbours do not determine curvatures.
     */
    SO_RULED_POINT_NOT_FITTED = 2,
} shapeop_ruled_point;

/**
 * Why an asymptotic curve ends.
 */
typedef enum shapeop_ruled_end {
    /**
     * At the boundary of the mesh.
     */
    SO_RULED_END_BOUNDARY = 0,
    /**
     * Where the direction is not known.
     */
    SO_RULED_END_UNKNOWN = 1,
    /**
     * At the length asked for.
     */
    SO_RULED_END_LENGTH = 2,
    /**
     * After the most steps.
     */
    SO_RULED_END_STEPS = 3,
} shapeop_ruled_end;

/**
 * What strip boundaries are to be.
 */
typedef enum shapeop_ruled_levels {
    /**
     * Orthogonal to the rulings, at distances of one length where that is possible.
     */
    SO_RULED_LEVELS_ORTHOGONAL = 0,
    /**
     * Orthogonal to the rulings, at whatever distances.
     */
    SO_RULED_LEVELS_DIRECTION = 1,
    /**
     * At constant distances.
     */
    SO_RULED_LEVELS_EQUIDISTANT = 2,
    /**
     * Geodesic: the straightest on the surface.
     */
    SO_RULED_LEVELS_GEODESIC = 3,
    /**
     * Such that the rulings along each are parallel to a plane.
     */
    SO_RULED_LEVELS_CONOIDAL = 4,
} shapeop_ruled_levels;

/**
 * A surface that a few numbers tell. Normals point outward, that of a plane as given.
 */
typedef enum shapeop_snake_surface {
    /**
     * A point and the normal: 6 numbers.
     */
    SO_SNAKE_SURFACE_PLANE = 0,
    /**
     * The centre and the radius: 4 numbers.
     */
    SO_SNAKE_SURFACE_SPHERE = 1,
    /**
     * A point of the axis, its direction, the radius: 7 numbers.
     */
    SO_SNAKE_SURFACE_CYLINDER = 2,
    /**
     * The centre, the direction of the axis, the distance of the tube's middle from it, the radius of the tube: 8
     * numbers.
     */
    SO_SNAKE_SURFACE_TORUS = 3,
} shapeop_snake_surface;

/**
 * Which way control points are to move.
 */
typedef enum shapeop_snake_direction {
    /**
     * None is given: rails or other wishes say it. So it is at first.
     */
    SO_SNAKE_DIRECTION_FREE = 0,
    /**
     * To the left of the snake within its surface, seen from the side that the surface's normals point to.
     */
    SO_SNAKE_DIRECTION_SIDEWAYS = 1,
    /**
     * All along one vector.
     */
    SO_SNAKE_DIRECTION_ALONG = 2,
} shapeop_snake_direction;

/**
 * How lamellae stand.
 */
typedef enum shapeop_snake_lamella {
    /**
     * In the planes of the arcs: a sector of a ring for each, which share no points.
     */
    SO_SNAKE_LAMELLA_FLAT = 0,
    /**
     * Along the normals of the snake's surface: one band.
     */
    SO_SNAKE_LAMELLA_NORMAL = 1,
    /**
     * Along one vector: one band.
     */
    SO_SNAKE_LAMELLA_ALONG = 2,
} shapeop_snake_lamella;

/**
 * A super-canal surface: a circular net with a frame at each point, and the transformations that made it of its base.
 * What points to it is no address but a small integer, a handle. All functions named `shapeop_canal...` leave their
 * messages for `shapeop_lastError` of null.
 */
typedef struct ShapeOpCanal ShapeOpCanal;

/**
 * A design of ruled strips: a negatively curved mesh, its asymptotic directions, strip boundaries across them, strips
 * between these, conditions on strips. Each step needs those before it and takes back those after it. What points to
 * it is no address but a small integer, a handle. All functions named `shapeop_ruled...` leave their messages for
 * `shapeop_lastError` of null.
 */
typedef struct ShapeOpRuled ShapeOpRuled;

/**
 * A circular arc snake: a smooth chain of circular arcs that moves while each arc keeps its shape; with it the surface
 * that it moves on, the rails that guide it, the wishes for its velocities, and the positions that were found last. What
 * points to it is no address but a small integer, a handle. All functions named `shapeop_snake...` leave their messages
 * for `shapeop_lastError` of null.
 *
 * A snake of N arcs has control points: of a closed one N, the vertices of the arcs in order; of an open one N + 2, its
 * first point, the vertices, its last point. An arc touches both edges at its vertex. Arcs meet in contact points: of an
 * open snake N + 1, its ends among them, of a closed one N.
 */
typedef struct ShapeOpSnake ShapeOpSnake;

#if !defined(SHAPEOP_COMPAT_API_H)
/**
 * A solver. What points to it is no address but a small integer, a handle.
 */
typedef struct ShapeOpSolver ShapeOpSolver;
#endif

/**
 * A constraint type. The texts are valid as long as the library is loaded.
 */
typedef struct shapeop_constraint_type {
    /**
     * In: `sizeof(shapeop_constraint_type)`.
     */
    unsigned int struct_size;
    /**
     * The least number of point indices.
     */
    int least_indices;
    /**
     * The greatest number of point indices; -1: any number.
     */
    int greatest_indices;
    /**
     * The number of scalars of an edit; 0: it cannot be edited; -1: shapes, any positive multiple of 3 times the
     * number of indices (x y z of each point of each shape).
     */
    int scalar_count;
    /**
     * The number of names for indices; the last name stands for all indices that follow.
     */
    int index_name_count;
    /**
     * What the projection promises.
     */
    enum shapeop_projection projection;
    /**
     * 1 if it sees its points only relative to their mean, so that alone it leaves translations free; else 0.
     */
    int is_centred;
    /**
     * The power of the model's scale with which its energy grows: scaling a model changes the balance of its weights.
     */
    int energy_scale_power;
    /**
     * The name in `shapeop_addConstraint`.
     */
    const char *name;
    /**
     * One line for people.
     */
    const char *help;
    /**
     * The unit of its violation, such as "model units" or "rad".
     */
    const char *violation_unit;
    /**
     * Another type's name that `shapeop_editConstraint` takes for it too, or null.
     */
    const char *edited_as;
} shapeop_constraint_type;

/**
 * One scalar of a constraint type. The text is valid as long as the library is loaded.
 */
typedef struct shapeop_constraint_scalar {
    /**
     * In: `sizeof(shapeop_constraint_scalar)`.
     */
    unsigned int struct_size;
    /**
     * 1 if there is a default; 0 where the points at creation decide.
     */
    int has_default;
    /**
     * The default, or 0.
     */
    double default_value;
    /**
     * Its name, ending in its unit unless it is in model units or has none.
     */
    const char *name;
} shapeop_constraint_scalar;

/**
 * When to stop. Start from `shapeop_defaultSolveOptions`.
 */
typedef struct shapeop_solve_options {
    /**
     * In: `sizeof(shapeop_solve_options)`.
     */
    unsigned int struct_size;
    /**
     * Iterations at most; in dynamic mode within the one time step that a call makes. Default 1000.
     */
    unsigned int max_iterations;
    /**
     * Stop when the largest move of a point in an iteration, relative to the bounding-box diagonal, is below this; 0
     * never stops that way. Finite, at least 0. Default 1e-6.
     */
    double tolerance;
    /**
     * Stop after so many seconds, looked at once per iteration; 0, the default: no limit. Finite, at least 0.
     */
    double time_budget_seconds;
} shapeop_solve_options;

/**
 * What a progress callback is told after every iteration.
 */
typedef struct shapeop_progress {
    /**
     * `sizeof(shapeop_progress)` in the library; fields may be added at the end.
     */
    unsigned int struct_size;
    /**
     * Iterations made so far, from 1.
     */
    unsigned int iteration;
    /**
     * The energy at the current points.
     */
    double energy;
    /**
     * The largest move of a point in this iteration, relative to the bounding-box diagonal.
     */
    double largest_move;
} shapeop_progress;

/**
 * Called after every iteration, on the thread that called `shapeop_solveUntil`. Returns 0 to go on; anything else ends
 * the solve, and what was reached is kept. It must return: no exception, no `longjmp`.
 */
typedef int (*shapeop_progress_callback)(const struct shapeop_progress *progress, void *user);

/**
 * What a solve found.
 */
typedef struct shapeop_solve_report {
    /**
     * In: `sizeof(shapeop_solve_report)`.
     */
    unsigned int struct_size;
    /**
     * Why it ended.
     */
    enum shapeop_outcome outcome;
    /**
     * Iterations made.
     */
    unsigned int iterations;
    /**
     * Points that no constraint of a weight above 0 holds.
     */
    unsigned int unconstrained_count;
    /**
     * The energy at the points that the iterations started from.
     */
    double energy_before;
    /**
     * The energy at the points that were reached.
     */
    double energy_after;
    /**
     * The largest move of a point in the last iteration, relative to the bounding-box diagonal.
     */
    double largest_move;
    /**
     * Seconds spent on ordering and symbolic analysis when the system in use was made.
     */
    double analysis_seconds;
    /**
     * Seconds spent on the factorisation when the system in use was made.
     */
    double factorisation_seconds;
    /**
     * Seconds spent on projections in this call.
     */
    double local_seconds;
    /**
     * Seconds spent on right-hand sides, linear solves and acceleration in this call.
     */
    double global_seconds;
    /**
     * Evaluations made: a local step at points that were tried, whether they were kept or not, and the global step from
     * there where they were. Without acceleration one per iteration; the first local step is not counted.
     */
    unsigned int evaluations;
    /**
     * Evaluations of points whose energy was higher than before, or not as much lower as the line search asks for.
     */
    unsigned int rejected_energy_rose;
    /**
     * Evaluations of points whose energy was not finite.
     */
    unsigned int rejected_not_finite;
    /**
     * Iterations in which acceleration left out a part of its history as ill-conditioned.
     */
    unsigned int rejected_ill_conditioned;
    /**
     * Directions of acceleration that were not tried, as the energy would rise along them.
     */
    unsigned int rejected_not_descent;
    /**
     * Directions of acceleration that were given up, as no step along them was accepted: the line search failed.
     */
    unsigned int rejected_line_search;
    /**
     * Orderings (with the analysis of the matrix's pattern) made since the solver was created.
     */
    unsigned int ordering_count;
    /**
     * Numeric factorisations made since the solver was created.
     */
    unsigned int factorisation_count;
    /**
     * How linear systems were solved: `SO_LINEAR_SOLVER_DIRECT` or `SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS`.
     */
    enum shapeop_linear_solver linear_solver;
    /**
     * Iterations of conjugate gradients in all linear solves of this call; 0 with a factor.
     */
    unsigned int linear_iterations;
    /**
     * `SO_BACKEND_GPU` if the graphics card made any of the iterations, else `SO_BACKEND_CPU`. `shapeop_backendReason`
     * says why.
     */
    enum shapeop_backend backend;
    /**
     * Those of the iterations that the card made.
     */
    unsigned int gpu_iterations;
    /**
     * The iteration after which points were read back from the card last.
     */
    unsigned int read_back_iteration;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Seconds in which the card worked.
     */
    double gpu_seconds;
    /**
     * Seconds in which points went to the card and back.
     */
    double transfer_seconds;
} shapeop_solve_report;

/**
 * The weights of the objective `1/2 handle sum |p - t|^2 + 1/2 closeness sum |p - p0|^2 + 1/2 fairness |L (p - p0)|^2`
 * plus the soft constraints, `p0` being the points at initialisation. Start from `shapeop_defaultObjective`.
 */
typedef struct shapeop_objective {
    /**
     * In: `sizeof(shapeop_objective)`.
     */
    unsigned int struct_size;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Above 0. Default 100.
     */
    double handle_weight;
    /**
     * Above 0. Default 0.1.
     */
    double closeness_weight;
    /**
     * At least 0; without `shapeop_setFairness` it has nothing to weigh. Default 1.
     */
    double fairness_weight;
    /**
     * How far a hard constraint may be from its set, relative to the bounding-box diagonal; at least 1e-14. Default
     * 1e-12.
     */
    double tolerance;
} shapeop_objective;

/**
 * What the last exploration found.
 */
typedef struct shapeop_exploration {
    /**
     * In: `sizeof(shapeop_exploration)`.
     */
    unsigned int struct_size;
    /**
     * Sweeps of the splitting method.
     */
    unsigned int sweep_count;
    /**
     * Newton steps.
     */
    unsigned int newton_step_count;
    /**
     * 1 if the points are a solution: every hard constraint is met and the gradient vanishes, both within the
     * tolerance.
     */
    int is_solution;
    /**
     * The largest distance of a hard constraint from its set, in model units.
     */
    double largest_violation;
    /**
     * The hard constraint that it is of; -1 if there is none.
     */
    int worst_constraint;
    /**
     * Hard constraints whose multiplier is at its cap: the contradictions, as far as they are known.
     */
    int capped_count;
    /**
     * The largest distance between what multipliers ask for and what the points are, in model units.
     */
    double primal_residual;
    /**
     * The largest gradient of the Lagrangian at a point, relative to the force that moves it by the model's size.
     */
    double dual_residual;
    /**
     * The terms of the objective.
     */
    double handle_term;
    /**
     * See `handle_term`.
     */
    double closeness_term;
    /**
     * See `handle_term`.
     */
    double fairness_term;
    /**
     * See `handle_term`.
     */
    double soft_term;
    /**
     * The penalty of the sweeps.
     */
    double penalty;
} shapeop_exploration;

/**
 * The graphics card that iterates, and its limits. The texts are valid as long as the library is loaded.
 */
typedef struct shapeop_backend_info {
    /**
     * In: `sizeof(shapeop_backend_info)`.
     */
    unsigned int struct_size;
    /**
     * Its kind.
     */
    enum shapeop_adapter_kind kind;
    /**
     * Workgroups at most, in one dimension of a run.
     */
    unsigned int group_count;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Bytes of one buffer at most: a whole number.
     */
    double buffer_bytes;
    /**
     * Bytes of what one binding reaches at most, a whole number; what is larger is split.
     */
    double binding_bytes;
    /**
     * Its name.
     */
    const char *adapter;
    /**
     * The interface it is driven by, such as "vulkan".
     */
    const char *api;
    /**
     * The driver, and its version.
     */
    const char *driver;
} shapeop_backend_info;

/**
 * What recipes take. Start from `shapeop_defaultRecipeOptions`.
 */
typedef struct shapeop_recipe_options {
    /**
     * In: `sizeof(shapeop_recipe_options)`.
     */
    unsigned int struct_size;
    /**
     * 0, the default: fairness keeps the details of the design; 1: it smooths.
     */
    int fairness_kind;
    /**
     * The weight of the recipe's own constraints. Default 1.
     */
    double weight;
    /**
     * The weight that draws each point to where it was; 0 for none. Default 0.05.
     */
    double closeness;
    /**
     * The weight of fairness; 0, the default, for none ("rationalize": for ten times the closeness).
     */
    double fairness;
    /**
     * In model units: the length that "equalize" draws edges to; 0, the default: their mean. The distance that "rationalize"
     * allows the diagonals of a quad; 0: planar quads. Other recipes refuse it.
     */
    double length;
    /**
     * The points that keep their place, `nb_anchors` indices. Default null.
     */
    const int *anchors;
    /**
     * The number of anchors.
     */
    int nb_anchors;
    /**
     * 1: all points of the boundary keep their place too. Default 0.
     */
    int anchor_boundary;
    /**
     * 1: the corners of the boundary keep their place too, where it turns by more than 75 degrees. Default 0.
     */
    int anchor_corners;
} shapeop_recipe_options;

/**
 * What `shapeop_canalSmooth` takes. Start from `shapeop_canalDefaultSmoothOptions`.
 */
typedef struct shapeop_canal_smooth_options {
    /**
     * In: `sizeof(shapeop_canal_smooth_options)`.
     */
    unsigned int struct_size;
    /**
     * The most iterations. Default 200.
     */
    unsigned int max_iterations;
    /**
     * 1: the normal stays on the cone of `cone_axis` and `cone_angle`. Default 0.
     */
    int has_cone;
    /**
     * 1: the tangents turn about the normal too. Default 0.
     */
    int turns_tangents;
    /**
     * The axis of the cone, x.
     */
    double cone_axis_x;
    /**
     * The axis of the cone, y.
     */
    double cone_axis_y;
    /**
     * The axis of the cone, z. Default 1.
     */
    double cone_axis_z;
    /**
     * The angle of the normal to the axis, in radians, 0 to pi. Default 0.
     */
    double cone_angle;
    /**
     * The most that two spacings of points change against each other, 1 (they stay) or more; may be infinite. Default
     * 4.
     */
    double spacing_ratio;
    /**
     * The most that a length changes, as a part of its first value, above 0; may be infinite. Default 0.25.
     */
    double length_change;
    /**
     * The weight that keeps lengths as they are. Default 0.
     */
    double length_weight;
    /**
     * The largest angle, in radians, from an arc's tangent to its chord. Default three quarters of pi.
     */
    double half_angle;
    /**
     * Stop where the largest entry of the gradient is at most this part of the value. Default 1e-6.
     */
    double relative_gradient;
    /**
     * Stop where the value fell by less than this part in five iterations. Default 1e-4.
     */
    double relative_decrease;
} shapeop_canal_smooth_options;

/**
 * What the progress callback of a call on surfaces is told.
 */
typedef struct shapeop_canal_progress {
    /**
     * `sizeof(shapeop_canal_progress)` in the library; fields may be added at the end.
     */
    unsigned int struct_size;
    /**
     * Iterations or steps made so far.
     */
    unsigned int iteration;
    /**
     * The part done, 0 to 1, of what may be needed.
     */
    double fraction;
    /**
     * What is being minimised, at the best so far; 0 where that is not known.
     */
    double value;
} shapeop_canal_progress;

/**
 * Called after every iteration, on the thread that made the call. Returns 0 to go on; anything else ends the call,
 * which succeeds with its best so far. It must return: no exception, no `longjmp`.
 */
typedef int (*shapeop_canal_progress_callback)(const struct shapeop_canal_progress *progress, void *user);

/**
 * What smoothing found.
 */
typedef struct shapeop_canal_smooth_report {
    /**
     * In: `sizeof(shapeop_canal_smooth_report)`.
     */
    unsigned int struct_size;
    /**
     * Why it stopped.
     */
    enum shapeop_canal_stop stop;
    /**
     * The functional at the start, the sum of squared curvatures, in one over squared model units.
     */
    double before;
    /**
     * At the end.
     */
    double after;
    /**
     * Iterations made.
     */
    unsigned int iterations;
    /**
     * 0; a gap that keeps the size a multiple of 8.
     */
    unsigned int reserved;
} shapeop_canal_smooth_report;

/**
 * What `shapeop_canalFit` and `shapeop_canalSectionPoints` take. Start from `shapeop_canalDefaultFitOptions`.
 */
typedef struct shapeop_canal_fit_options {
    /**
     * In: `sizeof(shapeop_canal_fit_options)`.
     */
    unsigned int struct_size;
    /**
     * How many circles, one through each of as many points of the first curve; at least 2, 3 on a closed curve.
     * Default 16.
     */
    int circle_count;
    /**
     * How many points of each circle; at least 2, 3 of whole circles. Default 12.
     */
    int column_count;
    /**
     * A `shapeop_canal_spacing`. Default 0; with `SO_CANAL_SPACING_POINTS` the number of circles is that of the
     * points.
     */
    int spacing;
    /**
     * A `shapeop_canal_section`. Default 0.
     */
    int section;
    /**
     * For `SO_CANAL_SECTION_TO_CURVE`, 1: around the far side of the circle. Default 0.
     */
    int is_long_way;
    /**
     * 1: the first normal is as near as possible to `normal_x`, `normal_y`, `normal_z`; 0, the default: it is at the
     * angle `angle`.
     */
    int has_normal;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    int reserved;
    /**
     * The angle, in radians, about the first tangent from the direction of z orthogonal to it (of x where it is along
     * z). Default 0.
     */
    double angle;
    /**
     * The first normal, x.
     */
    double normal_x;
    /**
     * The first normal, y.
     */
    double normal_y;
    /**
     * The first normal, z.
     */
    double normal_z;
    /**
     * Where `SO_CANAL_SECTION_ANGLES` starts, in radians from the point of the first curve. Default 0.
     */
    double from_angle;
    /**
     * Where it ends, on either side of the start. Default pi.
     */
    double to_angle;
    /**
     * A point of the plane of `SO_CANAL_SECTION_ABOVE`, x.
     */
    double plane_x;
    /**
     * A point of the plane, y.
     */
    double plane_y;
    /**
     * A point of the plane, z.
     */
    double plane_z;
    /**
     * The plane's normal, of any length, x.
     */
    double up_x;
    /**
     * The plane's normal, y.
     */
    double up_y;
    /**
     * The plane's normal, z. Default 1.
     */
    double up_z;
} shapeop_canal_fit_options;

/**
 * What `shapeop_canalFit` found.
 */
typedef struct shapeop_canal_fit_report {
    /**
     * In: `sizeof(shapeop_canal_fit_report)`.
     */
    unsigned int struct_size;
    /**
     * Whether the normal points away from the centers of the spheres.
     */
    int is_outward;
    /**
     * The largest distance of the second curve from a circle where it crosses the circle's plane.
     */
    double deviation;
    /**
     * The sum of the squared differences of the radii of spheres and their distances to the second curve.
     */
    double residual;
    /**
     * The largest difference of the surface's tangents from the first curve's.
     */
    double tangent_gap;
    /**
     * Of a closed first curve, how far the last frame is from the first after one turn; 0 of an open one.
     */
    double closing_gap;
} shapeop_canal_fit_report;

/**
 * What is true of a surface's net, see `shapeop_canalProperties`.
 */
typedef struct shapeop_canal_properties {
    /**
     * In: `sizeof(shapeop_canal_properties)`.
     */
    unsigned int struct_size;
    /**
     * The number of faces.
     */
    unsigned int face_count;
    /**
     * The number of faces that cross themselves.
     */
    unsigned int crossed_count;
    /**
     * Faces turned against most of their neighbours.
     */
    unsigned int flipped_count;
    /**
     * Faces of which an edge is shorter than a twentieth of the one opposite.
     */
    unsigned int shrunk_count;
    /**
     * 1 if one family of lines of curvature is planar.
     */
    int has_planar_curves;
    /**
     * 1 if the surface is isothermic by construction: one of revolution, or an inversion of one.
     */
    int is_isothermic_by_construction;
    /**
     * Whether lines of curvature can be lines of principal stress: 1, 0, or -1 where that could not be measured.
     */
    int has_stress_lines;
    /**
     * The largest planarity residual of a face.
     */
    double planarity;
    /**
     * The largest concyclicity residual of a face.
     */
    double concyclicity;
    /**
     * The largest distance of a row's point from its best-fit plane, over the row's extent.
     */
    double rows_off_plane;
    /**
     * The same of columns.
     */
    double columns_off_plane;
    /**
     * How far cross-ratios are from those of an isothermic net; 0 there.
     */
    double cross_ratio_residual;
    /**
     * The residual of the membrane under pressure on a refined net, 0 to 1; 0 where it could not be measured.
     */
    double stress_residual_coarse;
    /**
     * The same on a net refined more.
     */
    double stress_residual_fine;
} shapeop_canal_properties;

/**
 * How the asymptotic directions of a mesh are found. Start from `shapeop_ruledDefaultOptions`.
 */
typedef struct shapeop_ruled_options {
    /**
     * In: `sizeof(shapeop_ruled_options)`.
     */
    unsigned int struct_size;
    /**
     * Which of the two families rulings follow: 0, that of negative torsion, or 1. Default 0.
     */
    int family;
    /**
     * 1: signs of directions may disagree across some edges if they must. Default 0.
     */
    int allow_cut;
    /**
     * Rings of neighbours are added to a point until there are so many, 5 to 96. Default 18.
     */
    unsigned int least_neighbours;
    /**
     * Points whose Gaussian curvature is not below minus this times the square of the greatest curvature are masked, 0
     * to 1. Default 1e-6.
     */
    double flatness;
    /**
     * The part of the points that may be masked, 0 to 1; never all. Default 0.05.
     */
    double max_mask;
    /**
     * Directions point along this vector on the whole, x; all three 0: along x. Default 0.
     */
    double hint_x;
    /**
     * See `hint_x`.
     */
    double hint_y;
    /**
     * See `hint_x`.
     */
    double hint_z;
} shapeop_ruled_options;

/**
 * What is asked of a level function, by weights of 0 or more without units. Start from
 * `shapeop_ruledDefaultLevelOptions`.
 */
typedef struct shapeop_ruled_level_options {
    /**
     * In: `sizeof(shapeop_ruled_level_options)`.
     */
    unsigned int struct_size;
    /**
     * The most iterations. Default 30.
     */
    unsigned int max_iterations;
    /**
     * 1: a folded spherical image is used nevertheless. Default 0.
     */
    int allow_folds;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Boundaries orthogonal to the rulings, at a distance of one length.
     */
    double orthogonal;
    /**
     * Boundaries orthogonal to the rulings, at whatever distances.
     */
    double direction;
    /**
     * Boundaries at constant distances.
     */
    double equidistant;
    /**
     * Geodesic boundaries; one of the weights above must be positive too.
     */
    double geodesic;
    /**
     * Boundaries whose rulings are parallel to a plane; one of the first two weights must be positive too.
     */
    double conoidal;
    /**
     * Smoothness; keep it low.
     */
    double laplace;
    /**
     * Iterations end where the sum of the terms fell by less than this part of it. Default 1e-6.
     */
    double relative_decrease;
} shapeop_ruled_level_options;

/**
 * What is done to strip boundaries. Start from `shapeop_ruledDefaultBoundaryOptions`.
 */
typedef struct shapeop_ruled_boundary_options {
    /**
     * In: `sizeof(shapeop_ruled_boundary_options)`.
     */
    unsigned int struct_size;
    /**
     * 1: open ends are extended beyond the surface, so that strips cover it up to the rim. Default 1.
     */
    int extends;
    /**
     * 1: there is a boundary beyond the surface before the first and after the last. Default 1; drawn boundaries have
     * none.
     */
    int overshoots;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Level curves shorter than so many strip widths are dropped, unless that leaves none. Default 2.
     */
    double least_length;
} shapeop_ruled_boundary_options;

/**
 * What the progress callback of a call on designs is told.
 */
typedef struct shapeop_ruled_progress {
    /**
     * `sizeof(shapeop_ruled_progress)` in the library; fields may be added at the end.
     */
    unsigned int struct_size;
    /**
     * Iterations made so far.
     */
    unsigned int iteration;
    /**
     * The part done, 0 to 1, of what may be needed.
     */
    double fraction;
    /**
     * What is being minimised.
     */
    double value;
    /**
     * The largest distance of a sample of the strips to the mesh, in model units; 0 while a level function is found.
     */
    double largest_deviation;
    /**
     * The largest distance of neighbours' boundaries, in model units; 0 while a level function is found.
     */
    double largest_gap;
} shapeop_ruled_progress;

/**
 * Called before every iteration, on the thread that made the call. Returns 0 to go on; anything else ends the call,
 * which succeeds with its best so far. It must return: no exception, no `longjmp`.
 */
typedef int (*shapeop_ruled_progress_callback)(const struct shapeop_ruled_progress *progress, void *user);

/**
 * What was found of a level function.
 */
typedef struct shapeop_ruled_level_report {
    /**
     * In: `sizeof(shapeop_ruled_level_report)`.
     */
    unsigned int struct_size;
    /**
     * Why iterations ended; `SO_RULED_STOP_NONE` if a linear problem was all there was.
     */
    enum shapeop_ruled_stop stop;
    /**
     * Iterations made.
     */
    unsigned int iterations;
    /**
     * Points around which the function does not rise on one side and fall on the other.
     */
    unsigned int critical_count;
    /**
     * What the spherical image is like.
     */
    enum shapeop_ruled_image image;
    /**
     * Triangles without an image, or one without area.
     */
    unsigned int image_unused_count;
    /**
     * The least length of the gradient: 1 where boundaries are at the distance of their levels.
     */
    double least_slope;
    /**
     * The greatest length of the gradient.
     */
    double greatest_slope;
    /**
     * How much of the image is area, 0 to 1; 0 of none.
     */
    double image_extent;
    /**
     * The part of its area that is folded over, 0 to 1/2.
     */
    double image_folded;
    /**
     * How far directions are from one plane: their least singular value over the largest.
     */
    double image_flatness;
    /**
     * The unit vector that directions are most nearly orthogonal to, x.
     */
    double image_axis_x;
    /**
     * See `image_axis_x`.
     */
    double image_axis_y;
    /**
     * See `image_axis_x`.
     */
    double image_axis_z;
} shapeop_ruled_level_report;

/**
 * How strips are optimised. Start from `shapeop_ruledDefaultOptimiseOptions`. Weights are 0 or more; distances are in
 * units of the mesh's diagonal and terms are means, so that weights depend on neither size nor sampling.
 */
typedef struct shapeop_ruled_optimise_options {
    /**
     * In: `sizeof(shapeop_ruled_optimise_options)`.
     */
    unsigned int struct_size;
    /**
     * The most iterations. Default 50.
     */
    unsigned int max_iterations;
    /**
     * Samples along a boundary for each control point, 1 to 1000. Default 4.
     */
    unsigned int samples_along;
    /**
     * Samples along a ruling, 2 to 1000. Default 5.
     */
    unsigned int samples_across;
    /**
     * The weight of the squared distance from strips to the mesh. Default 1.
     */
    double proximity;
    /**
     * The part of it for what is beyond the boundary of the mesh, 0 to 1. Default 0.01.
     */
    double beyond;
    /**
     * The weight of the squared distance between boundaries that are to be one. Default 1.
     */
    double gap;
    /**
     * The weight of the squared distance from the mesh to the nearest strip. Default 1.
     */
    double coverage;
    /**
     * The weight of the thin plate energy of the way from the start. Default 1e-6.
     */
    double thin_plate;
    /**
     * The weight of the squared way of the control points from the start. Default 1e-4.
     */
    double proximal;
    /**
     * The largest distance of samples of the strips to the mesh, in model units; 0: no bound. Default 0.
     */
    double largest_deviation;
    /**
     * The least length of a ruling, in model units; 0: no bound. Default 0.
     */
    double least_width;
    /**
     * Stop where no control point moves by more than this multiple of the mesh's diagonal, or the value falls by less
     * than this part of it. Default 1e-6.
     */
    double tolerance;
} shapeop_ruled_optimise_options;

/**
 * What optimising found.
 */
typedef struct shapeop_ruled_optimise_report {
    /**
     * In: `sizeof(shapeop_ruled_optimise_report)`.
     */
    unsigned int struct_size;
    /**
     * Why it stopped.
     */
    enum shapeop_ruled_stop stop;
    /**
     * Iterations made.
     */
    unsigned int iterations;
    /**
     * Numbers that the conditions left free.
     */
    unsigned int free_count;
    /**
     * What is minimised, at the start, where the conditions are met.
     */
    double before;
    /**
     * At the end: the sum of the four terms, and the excess over bounds in units of the mesh's diagonal.
     */
    double after;
    /**
     * Its term of distances from strips to the mesh.
     */
    double proximity;
    /**
     * Its term of distances between neighbours.
     */
    double gap;
    /**
     * Its term of distances from the mesh to strips.
     */
    double coverage;
    /**
     * Its terms of the way from the start.
     */
    double way;
    /**
     * By how much a bound is exceeded at most, in model units.
     */
    double excess;
    /**
     * The largest distance of a sample within the boundary of the mesh to it, in model units.
     */
    double largest_deviation;
    /**
     * The largest distance of a sample of a boundary to the neighbour's, in model units; 0 where they are shared.
     */
    double largest_gap;
} shapeop_ruled_optimise_report;

/**
 * How strips are judged. Start from `shapeop_ruledDefaultReportOptions`.
 */
typedef struct shapeop_ruled_report_options {
    /**
     * In: `sizeof(shapeop_ruled_report_options)`.
     */
    unsigned int struct_size;
    /**
     * Samples in each span along a strip, 1 to 1000. Default 4.
     */
    unsigned int samples_along;
    /**
     * Samples across a strip, its boundaries included, 2 to 1000. Default 5.
     */
    unsigned int samples_across;
    /**
     * Columns of triangles in each span of a trimmed strip, 1 to 1000. Default 4.
     */
    unsigned int columns_per_span;
    /**
     * A strip is too wide where its width is above this multiple of the least radius of curvature. Default 0.5.
     */
    double feature_ratio;
    /**
     * How far the line along which a strip is cut may be from the boundary of the mesh, over its diagonal; above 0, at
     * most 0.01. Default 1e-7.
     */
    double trim_tolerance;
} shapeop_ruled_report_options;

/**
 * What there is to say of all strips.
 */
typedef struct shapeop_ruled_report {
    /**
     * In: `sizeof(shapeop_ruled_report)`.
     */
    unsigned int struct_size;
    /**
     * The number of strips.
     */
    unsigned int strip_count;
    /**
     * The number of pairs of neighbours.
     */
    unsigned int joint_count;
    /**
     * Strips that are too wide for the features of the mesh.
     */
    unsigned int too_wide_count;
    /**
     * The largest distance of the strips from the mesh, in model units; what is beyond its boundary does not count.
     */
    double largest_deviation;
    /**
     * The root mean square of it over the area.
     */
    double rms_deviation;
    /**
     * The largest distance of a point of the mesh from the nearest strip, in model units.
     */
    double largest_uncovered;
    /**
     * The root mean square of it over the area.
     */
    double rms_uncovered;
    /**
     * The area of the mesh.
     */
    double reference_area;
    /**
     * The area of all trimmed strips.
     */
    double trimmed_area;
    /**
     * The part of the mesh that some strip covers, 0 to 1, each of its spots counted once; known to about 0.001.
     */
    double coverage;
    /**
     * The largest gap between neighbours, in model units.
     */
    double largest_gap;
    /**
     * The mean gap.
     */
    double mean_gap;
    /**
     * The largest angle between tangent planes of neighbours along their boundary, in radians.
     */
    double largest_kink;
    /**
     * The mean angle.
     */
    double mean_kink;
    /**
     * The standard deviation of all widths over their mean.
     */
    double width_variation;
    /**
     * The part of the mesh that strips cover again: once for each strip but the first.
     */
    double overlap;
} shapeop_ruled_report;

/**
 * What there is to say of one strip.
 */
typedef struct shapeop_ruled_strip_report {
    /**
     * In: `sizeof(shapeop_ruled_strip_report)`.
     */
    unsigned int struct_size;
    /**
     * 1 if it is too wide for the features of the mesh.
     */
    int is_too_wide;
    /**
     * The largest distance from the mesh, in model units.
     */
    double largest_deviation;
    /**
     * The sample that has it, x.
     */
    double at_x;
    /**
     * See `at_x`.
     */
    double at_y;
    /**
     * See `at_x`.
     */
    double at_z;
    /**
     * The root mean square over the area.
     */
    double rms_deviation;
    /**
     * The area of the whole strip.
     */
    double area;
    /**
     * The area of what is left when it is trimmed.
     */
    double trimmed_area;
    /**
     * The least width, in model units.
     */
    double least_width;
    /**
     * The mean width.
     */
    double mean_width;
    /**
     * The greatest width.
     */
    double greatest_width;
    /**
     * The standard deviation of its widths over their mean.
     */
    double width_variation;
    /**
     * The greatest width over the least radius of curvature there.
     */
    double width_over_feature;
    /**
     * That radius, in model units; 0 if nothing of the strip is left when it is trimmed.
     */
    double feature_size;
} shapeop_ruled_strip_report;

/**
 * What there is to say of two neighbours.
 */
typedef struct shapeop_ruled_joint_report {
    /**
     * In: `sizeof(shapeop_ruled_joint_report)`.
     */
    unsigned int struct_size;
    /**
     * The strip whose second boundary it is.
     */
    int first;
    /**
     * The strip whose first boundary it is.
     */
    int second;
    /**
     * Samples of gaps; if 0, all gaps are 0 too.
     */
    unsigned int gap_count;
    /**
     * Samples of kinks.
     */
    unsigned int kink_count;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * The largest gap, in model units.
     */
    double largest_gap;
    /**
     * The mean gap.
     */
    double mean_gap;
    /**
     * The sample with the largest gap, x.
     */
    double gap_x;
    /**
     * See `gap_x`.
     */
    double gap_y;
    /**
     * See `gap_x`.
     */
    double gap_z;
    /**
     * The largest angle between tangent planes, in radians: 0 where the strips go on smoothly.
     */
    double largest_kink;
    /**
     * The mean angle.
     */
    double mean_kink;
    /**
     * The sample with the largest angle, x.
     */
    double kink_x;
    /**
     * See `kink_x`.
     */
    double kink_y;
    /**
     * See `kink_x`.
     */
    double kink_z;
} shapeop_ruled_joint_report;

/**
 * How a strip is cut into planks. Start from `shapeop_ruledDefaultPlankOptions`.
 */
typedef struct shapeop_ruled_plank_options {
    /**
     * In: `sizeof(shapeop_ruled_plank_options)`.
     */
    unsigned int struct_size;
    /**
     * 1: `first_cut` says where one of the cuts is. Default 0: at the first ruling.
     */
    int has_first_cut;
    /**
     * The thickness of the planks, in model units, above 0. It has no default.
     */
    double thickness;
    /**
     * How far the long sides of a plank are beyond the rulings, in model units, 0 or more. Default 0.
     */
    double depth;
    /**
     * `axis . x` of one of the cuts.
     */
    double first_cut;
    /**
     * The angle between rulings and planks that counts as none, in radians, 0 or more. Default 1e-4 degrees.
     */
    double tolerance;
} shapeop_ruled_plank_options;

/**
 * What there is to say of all planks of a strip.
 */
typedef struct shapeop_ruled_planks {
    /**
     * In: `sizeof(shapeop_ruled_planks)`.
     */
    unsigned int struct_size;
    /**
     * The number of planks.
     */
    unsigned int plank_count;
    /**
     * The axis, a unit vector across the planks, x.
     */
    double axis_x;
    /**
     * See `axis_x`.
     */
    double axis_y;
    /**
     * See `axis_x`.
     */
    double axis_z;
    /**
     * The thickness of all planks.
     */
    double thickness;
    /**
     * The greatest angle between a control ruling and the planks, in radians.
     */
    double deviation;
    /**
     * The area of all boards, in square model units.
     */
    double stock_area;
    /**
     * The part of it that is cut off.
     */
    double offcut;
} shapeop_ruled_planks;

/**
 * A plank: a prism of the planks' thickness over a flat outline. Lengths are in model units.
 */
typedef struct shapeop_ruled_plank {
    /**
     * In: `sizeof(shapeop_ruled_plank)`.
     */
    unsigned int struct_size;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * `axis . x` of the lower face.
     */
    double lower;
    /**
     * `axis . x` of the upper face.
     */
    double upper;
    /**
     * How much of its thickness has rulings: 1, but for the first and the last plank perhaps.
     */
    double filled;
    /**
     * The parameter of the strip's ruling in the lower face, or its first.
     */
    double first_u;
    /**
     * The parameter of the strip's ruling in the upper face, or its last.
     */
    double last_u;
    /**
     * The length of the board that it is cut from.
     */
    double length;
    /**
     * The width of that board.
     */
    double width;
    /**
     * The angle between the cut at the strip's first boundary and a square one, in radians.
     */
    double first_end_angle;
    /**
     * The angle between the cut at the strip's second boundary and a square one, in radians.
     */
    double second_end_angle;
    /**
     * The part of the board that is cut off.
     */
    double offcut;
} shapeop_ruled_plank;

/**
 * What a snake is like.
 */
typedef struct shapeop_snake_report {
    /**
     * In: `sizeof(shapeop_snake_report)`.
     */
    unsigned int struct_size;
    /**
     * The number of arcs.
     */
    unsigned int arc_count;
    /**
     * The number of control points.
     */
    unsigned int control_count;
    /**
     * 1 if the last arc goes on with the first.
     */
    int is_closed;
    /**
     * The sum of the arcs' lengths, in model units.
     */
    double length;
    /**
     * By how much a distance of control points that the arcs keep is off at most, in model units.
     */
    double residual;
    /**
     * The largest distance of a contact point or the middle of an arc from the surface, in model units; 0 without one.
     */
    double deviation;
} shapeop_snake_report;

/**
 * How a snake is fitted. Start from `shapeop_snakeDefaultFitOptions`.
 */
typedef struct shapeop_snake_fit_options {
    /**
     * In: `sizeof(shapeop_snake_fit_options)`.
     */
    unsigned int struct_size;
    /**
     * 1: all arcs have one radius, not only one length. Default 1.
     */
    int is_congruent;
    /**
     * Iterations at most, of each of three minimisations. Default 200.
     */
    unsigned int max_iterations;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * The curvature of all arcs, if it is known, in 1/model units; 0: it is found. Default 0.
     */
    double curvature;
    /**
     * The weight of nearness beside that of distances, above 0. Default 0.005.
     */
    double nearness;
} shapeop_snake_fit_options;

/**
 * What fitting found.
 */
typedef struct shapeop_snake_fit_report {
    /**
     * In: `sizeof(shapeop_snake_fit_report)`.
     */
    unsigned int struct_size;
    /**
     * Iterations of the minimisations.
     */
    unsigned int iterations;
    /**
     * 1 if steps or decreases became small; 0 if all iterations were used.
     */
    int is_converged;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * The largest distance of a point of the polyline from the nearest arc, in model units.
     */
    double deviation;
    /**
     * By how much a distance of control points is off at most, in model units.
     */
    double residual;
} shapeop_snake_fit_report;

/**
 * How a curve of given curvature is found. Start from `shapeop_snakeDefaultCurveOptions`.
 */
typedef struct shapeop_snake_curve_options {
    /**
     * In: `sizeof(shapeop_snake_curve_options)`.
     */
    unsigned int struct_size;
    /**
     * 0: it turns left, seen from where the surface's normal points; 1: right. Default 0.
     */
    int turns_right;
    /**
     * Into how many steps the length is divided, 1 to 1 000 000. Default 200.
     */
    unsigned int steps;
    /**
     * 0: the method of Runge and Kutta; 1: that of chords, of first order. Default 0.
     */
    int method;
} shapeop_snake_curve_options;

/**
 * What was found of a curve.
 */
typedef struct shapeop_snake_curve_report {
    /**
     * In: `sizeof(shapeop_snake_curve_report)`.
     */
    unsigned int struct_size;
    /**
     * Why it ends.
     */
    enum shapeop_snake_curve_end end;
    /**
     * Its length, in model units.
     */
    double length;
    /**
     * Where the surface bends more: the curvature asked for there, in 1/model units; otherwise 0.
     */
    double curvature;
    /**
     * Where the surface bends more: its normal curvature in the direction of the curve; otherwise 0.
     */
    double normal_curvature;
} shapeop_snake_curve_report;

/**
 * How a snake moves. Start from `shapeop_snakeDefaultOptions`. Weights are 0 or more: what squared differences of
 * velocities from what they are to be are multiplied by.
 */
typedef struct shapeop_snake_options {
    /**
     * In: `sizeof(shapeop_snake_options)`.
     */
    unsigned int struct_size;
    /**
     * Stop after so many steps. Default 100.
     */
    unsigned int max_steps;
    /**
     * 1: steps follow accelerations too, and can be longer. Default 0.
     */
    int is_second_order;
    /**
     * 1: distances of control points three apart stay, so that the snake moves rigidly; where that contradicts rails, as
     * well as possible. Default 0.
     */
    int keeps_torsions;
    /**
     * 1: stop when the snake is back where it started. Default 1.
     */
    int stops_at_cycle;
    /**
     * 1: steps are projected to the nearest position; only without a surface. Default 0.
     */
    int is_exact;
    /**
     * Iterations of a projection at most. Default 60.
     */
    unsigned int projection_iterations;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * The time of a step, above 0. Steps are halved where they lead too far. Default 0.05.
     */
    double step;
    /**
     * No step is shorter than this part of `step`; above 0, at most 1. Default 1e-4.
     */
    double least_step;
    /**
     * Stop before a contact point or the middle of an arc is farther from the surface than this, in model units; below 0:
     * anywhere. Default -1.
     */
    double max_deviation;
    /**
     * The weight of velocities tangential to the surface. Default 1.
     */
    double tangential;
    /**
     * The weight of speeds in the direction of `shapeop_snakeSetDirection`. Default 0.001.
     */
    double offset;
    /**
     * The weight of torsions that do not change. Default 0.
     */
    double rotation;
    /**
     * The weight of velocities at right angles to arcs. Default 0.
     */
    double orthogonal;
    /**
     * What accelerations along the surface count against those across it, above 0. Default 0.01.
     */
    double alpha;
    /**
     * What the squared way of a projection counts against squared errors of distances, above 0. Default 0.005.
     */
    double mu;
    /**
     * What squared errors of heights over the surface count against them, 0 or more: above 0 they are met to round-off
     * where that is possible. Default 0.01.
     */
    double surface_weight;
} shapeop_snake_options;

/**
 * What a projection found.
 */
typedef struct shapeop_snake_projection {
    /**
     * In: `sizeof(shapeop_snake_projection)`.
     */
    unsigned int struct_size;
    /**
     * Iterations of the first phase.
     */
    unsigned int iterations;
    /**
     * Steps of the second.
     */
    unsigned int steps;
    /**
     * 1 if it is the nearest position to round-off, where that was asked for.
     */
    int is_nearest;
    /**
     * By how much a distance is off at most, in model units.
     */
    double residual;
    /**
     * By how much a control point is from its target at most, in model units.
     */
    double moved;
} shapeop_snake_projection;

/**
 * What the progress callback of a call on snakes is told.
 */
typedef struct shapeop_snake_progress {
    /**
     * `sizeof(shapeop_snake_progress)` in the library; fields may be added at the end.
     */
    unsigned int struct_size;
    /**
     * Steps made so far.
     */
    unsigned int step;
    /**
     * The part done, 0 to 1, of what may be needed.
     */
    double fraction;
    /**
     * The time; of a linkage's motion 0.
     */
    double time;
    /**
     * The largest distance of a contact point or the middle of an arc from the surface, in model units; 0 without one.
     */
    double deviation;
    /**
     * By how much a distance or a rail is missed at most, in model units; of a linkage's motion 0.
     */
    double residual;
    /**
     * By how much the first arc of a linkage is turned from its start, in radians; of an evolution 0.
     */
    double first_angle;
    /**
     * By how much the last arc of a linkage is turned from its start, in radians; of an evolution 0.
     */
    double last_angle;
} shapeop_snake_progress;

/**
 * Called before every step, on the thread that made the call. Returns 0 to go on; anything else ends the call, which
 * succeeds with the positions so far. It must return: no exception, no `longjmp`.
 */
typedef int (*shapeop_snake_progress_callback)(const struct shapeop_snake_progress *progress, void *user);

/**
 * What an evolution found.
 */
typedef struct shapeop_snake_evolution {
    /**
     * In: `sizeof(shapeop_snake_evolution)`.
     */
    unsigned int struct_size;
    /**
     * Why it stopped.
     */
    enum shapeop_snake_stop stop;
    /**
     * The rail that stopped it, or -1.
     */
    int stop_rail;
    /**
     * The number of frames, the start among them.
     */
    unsigned int frame_count;
    /**
     * How far the snake would be from the surface, or from the rail, in model units; 0 where a driven point came to the
     * end of its rail, and for all other reasons.
     */
    double stop_distance;
    /**
     * The time of the last frame.
     */
    double time;
    /**
     * The largest deviation of all frames from the surface, in model units; 0 without one.
     */
    double deviation;
    /**
     * By how much a distance or a rail is missed at most in any frame, in model units.
     */
    double residual;
    /**
     * By how much the height of a control point over the surface differs from that at the start at most.
     */
    double height_residual;
    /**
     * By how much a distance of control points three apart is off at most, where those are kept.
     */
    double incongruence;
} shapeop_snake_evolution;

/**
 * How a linkage's motion is followed. Start from `shapeop_snakeDefaultCycleOptions`.
 */
typedef struct shapeop_snake_cycle_options {
    /**
     * In: `sizeof(shapeop_snake_cycle_options)`.
     */
    unsigned int struct_size;
    /**
     * Steps at most, at least 1. Default 20 000.
     */
    unsigned int max_steps;
    /**
     * 1: the first arc begins by turning clockwise about its hinge, seen against the direction from the first control
     * point to the second. Default 0.
     */
    int is_reversed;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * By which angle the driving arc turns in a step, in radians, above 0 and at most 0.2. Default 0.02.
     */
    double step;
} shapeop_snake_cycle_options;

/**
 * What was found of a linkage's motion.
 */
typedef struct shapeop_snake_cycle {
    /**
     * In: `sizeof(shapeop_snake_cycle)`.
     */
    unsigned int struct_size;
    /**
     * Why it ends.
     */
    enum shapeop_snake_cycle_end end;
    /**
     * In how many ways it can move at the last position, where the motion ends for that; otherwise 1.
     */
    unsigned int free;
    /**
     * The number of frames; a closed motion does not repeat the start.
     */
    unsigned int frame_count;
    /**
     * How far the first arc has turned when a closed motion is at its start again, in whole turns.
     */
    int first_turns;
    /**
     * The same of the last arc.
     */
    int last_turns;
    /**
     * How often the drive changed ends.
     */
    unsigned int switch_count;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * How far the position found in the end is from the first, as the largest distance of two control points, in model
     * units; -1 of a motion that is not closed.
     */
    double closing;
    /**
     * How far apart the extreme positions of the first arc are, in radians.
     */
    double first_range;
    /**
     * The same of the last arc.
     */
    double last_range;
    /**
     * By how much a distance is off at most in any frame, in model units.
     */
    double residual;
} shapeop_snake_cycle;

/**
 * How a covering is judged. Start from `shapeop_snakeDefaultCoveringOptions`.
 */
typedef struct shapeop_snake_covering_options {
    /**
     * In: `sizeof(shapeop_snake_covering_options)`.
     */
    unsigned int struct_size;
    /**
     * Intervals of each arc of the swept surface, 1 to 65 536. Default 8.
     */
    unsigned int per_arc;
    /**
     * 1: the last position is followed by the first. Default 0.
     */
    int comes_back;
    /**
     * 0; a gap that keeps the doubles aligned.
     */
    unsigned int reserved;
    /**
     * Arcs are of one kind if radii and lengths are both within this of the first's, relative to its, 0 or more. Default
     * 1e-6.
     */
    double tolerance;
    /**
     * A spot of the mesh is covered if the swept surface is within this distance, in model units; 0: 0.01 of the mesh's
     * diagonal. Default 0.
     */
    double distance;
} shapeop_snake_covering_options;

/**
 * What a covering comes to.
 */
typedef struct shapeop_snake_covering {
    /**
     * In: `sizeof(shapeop_snake_covering)`.
     */
    unsigned int struct_size;
    /**
     * Positions of the snake.
     */
    unsigned int position_count;
    /**
     * Arcs of all positions.
     */
    unsigned int arc_count;
    /**
     * Kinds of arcs.
     */
    unsigned int kind_count;
    /**
     * 1 if there is a mesh to compare with, and positions enough to sweep a surface; else what follows `residual` is 0.
     */
    int is_compared;
    /**
     * Samples of the swept surface that are beyond the boundary of the mesh.
     */
    unsigned int beyond_count;
    /**
     * The length of all arcs together, in model units.
     */
    double length;
    /**
     * The area of the swept surface; 0 with one position.
     */
    double area;
    /**
     * By how much a distance of control points is off in any position at most, in model units.
     */
    double residual;
    /**
     * The area of the mesh.
     */
    double reference_area;
    /**
     * The part of the mesh that the swept surface is near to, 0 to 1.
     */
    double coverage;
    /**
     * How near, in model units.
     */
    double distance;
    /**
     * The largest distance of a sample of the swept surface from the mesh, in model units; what is beyond its boundary
     * does not count.
     */
    double largest_deviation;
    /**
     * The sample that has it, x.
     */
    double at_x;
    /**
     * See `at_x`.
     */
    double at_y;
    /**
     * See `at_x`.
     */
    double at_z;
    /**
     * The root mean square of it over the area.
     */
    double rms_deviation;
} shapeop_snake_covering;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library, such as `0.1.0`. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_version(void);

/**
 * `SHAPEOP_ABI_VERSION` of the library, to be compared with the header's by a program that loads it.
 */
SHAPEOP_API int shapeop_abiVersion(void);

/**
 * Why the last call on `op` was refused, in words: the argument, what was expected, what was found. Empty if it
 * succeeded: every call but this, `shapeop_lastErrorCode`, `shapeop_version`, `shapeop_abiVersion`, `shapeop_errorText`
 * and `shapeop_delete` of null replaces the message. A call that was refused because `op` was busy leaves its message with its own thread
 * only, and the success of another thread's call does not hide it. If `op` is no solver, the text is about the calling
 * thread's last call of all.
 *
 * The text is the calling thread's own copy, valid until that thread's next call of this function.
 */
SHAPEOP_API
const char *shapeop_lastError(struct ShapeOpSolver *op);

/**
 * The error code of the call that `shapeop_lastError` tells of, for the functions that do not answer with one;
 * `SO_SUCCESS` if that call succeeded. Like `shapeop_lastError` it replaces no message.
 */
SHAPEOP_API enum shapeop_err shapeop_lastErrorCode(struct ShapeOpSolver *op);

/**
 * What an error code means, in words; for a number that is none, it says so. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_errorText(int error);

/**
 * Creates a solver without points. Null if 65536 solvers exist. Delete it with `shapeop_delete`.
 */
SHAPEOP_API struct ShapeOpSolver *shapeop_create(void);

/**
 * Deletes a solver and all it holds. Null does nothing; a busy solver is left alone, as is whatever is no solver.
 */
SHAPEOP_API void shapeop_delete(struct ShapeOpSolver *op);

/**
 * Prepares for static solving from the current points: masses, damping and time step are 1, velocities start at zero.
 * May be called again at any time. Returns 0, or 1 if the system cannot be factorised (numbers too large).
 */
SHAPEOP_API int shapeop_init(struct ShapeOpSolver *op);

/**
 * Prepares for dynamic solving from the current points with zero velocities. `masses` is that of every point, above 0;
 * `damping` the factor on velocities after each step, at least 0; `timestep` is above 0. Returns 0, or 1 if one of
 * them is not so or the system cannot be factorised; the solver is then as before.
 */
SHAPEOP_API int shapeop_initDynamic(struct ShapeOpSolver *op, double masses, double damping, double timestep);

/**
 * Static: so many local/global iterations from the current points. Dynamic: one time step with so many iterations.
 * They are the plain ones unless `shapeop_setAcceleration` asked for others.
 * Changes since the last call, of constraints too, take effect. Returns 0, or 1 with the points as before if the
 * solver was not initialised, if a force acts along a motion that no constraint resists, or if the numbers became too
 * large.
 */
SHAPEOP_API int shapeop_solve(struct ShapeOpSolver *op, unsigned int iteration);

/**
 * Changes the time step of the following steps, but not the inertia, which keeps the step of `shapeop_initDynamic`.
 * Before initialisation it has no effect. A step that is not finite and above 0 changes nothing.
 */
SHAPEOP_API void shapeop_setTimeStep(struct ShapeOpSolver *op, double timestep);

/**
 * Changes the damping of the following steps. Before initialisation it has no effect. A damping that is not finite and
 * at least 0 changes nothing.
 */
SHAPEOP_API void shapeop_setDamping(struct ShapeOpSolver *op, double damping);

/**
 * Sets the number of threads for large problems, at most 1024; 0, the default: as many as the machine has. The results
 * are the same bits for any number.
 */
SHAPEOP_API enum shapeop_err shapeop_setThreadCount(struct ShapeOpSolver *op, int nb_threads);

/**
 * Sets how the following solves are accelerated: `kind` is a `shapeop_acceleration`, `memory` the number of iterations
 * that are remembered for it, at most 64; 0: the method's default. Accelerated solves take far fewer iterations to the
 * same energy, and an accelerated step never raises it; the iterates are others than without. Every call, and so every
 * time step, begins anew: nothing is remembered from call to call. With a pressure or a normal force on faces all iterations
 * are plain, whatever is set. A refused call changes nothing.
 */
SHAPEOP_API
enum shapeop_err shapeop_setAcceleration(struct ShapeOpSolver *op,
                                         int kind,
                                         unsigned int memory);

/**
 * Sets how the linear system of an iteration is solved, from the next solve on; `linear_solver` is a
 * `shapeop_linear_solver`, and any other number is refused. The iterates agree to about 1e-10 of the model's size.
 * `shapeop_solve_report` says what ran.
 */
SHAPEOP_API enum shapeop_err shapeop_setLinearSolver(struct ShapeOpSolver *op, int linear_solver);

/**
 * Replaces the positions: `points` holds `x0 y0 z0 x1 ...` in model units. Rest states, targets and velocities stay.
 * Their number may change as long as no constraint or force refers beyond it; added points start at rest. Refused,
 * with nothing changed, if it may not, or if a coordinate is not finite.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles.
 */
SHAPEOP_API void shapeop_setPoints(struct ShapeOpSolver *op, double *points, int nb_points);

/**
 * Copies the positions to `points` as `x0 y0 z0 x1 ...` in model units. `nb_points` must be the solver's number of
 * points; otherwise nothing is written. From inside the progress callback: the current iterate.
 *
 * # Safety
 * `points` is null or writable for `3 * nb_points` doubles.
 */
SHAPEOP_API void shapeop_getPoints(struct ShapeOpSolver *op, double *points, int nb_points);

/**
 * The number of points, or -1.
 */
SHAPEOP_API int shapeop_pointCount(struct ShapeOpSolver *op);

/**
 * The number of points that no constraint of a weight above 0 holds, or -1. In static mode they keep their place.
 */
SHAPEOP_API int shapeop_unconstrainedCount(struct ShapeOpSolver *op);

/**
 * Adds a polyline for "OnCurve" constraints to refer to: its id, which is returned, is their scalar. Its coordinates are copied.
 * -1 if it has fewer than 2 points, or a coordinate is not finite. References stay until `shapeop_setProblem`.
 *
 * - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points. They are no points of the solver.
 * - `is_closed`: 1: a segment leads from the last point back to the first; 0: not.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles.
 */
SHAPEOP_API
int shapeop_addReferencePolyline(struct ShapeOpSolver *op,
                                 const double *points,
                                 int nb_points,
                                 int is_closed);

/**
 * Adds a triangle mesh for "OnMesh" constraints to refer to: its id, which is returned, is their scalar. Its numbers are copied.
 * -1 if it has no triangle, an index is out of range, or a coordinate is not finite. Else as `shapeop_addReferencePolyline`.
 *
 * - `triangles`: `3 * nb_triangles` indices into `points`, which are no points of the solver.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `triangles` for `3 * nb_triangles` ints.
 */
SHAPEOP_API
int shapeop_addReferenceMesh(struct ShapeOpSolver *op,
                             const double *points,
                             int nb_points,
                             const int *triangles,
                             int nb_triangles);

/**
 * The number of references, or -1.
 */
SHAPEOP_API int shapeop_referenceCount(struct ShapeOpSolver *op);

/**
 * Adds a constraint with its type's default scalars, at rest where the points are now. `ids` are point indices.
 * Returns its id (they count up from 0 and are never reused), or -1 if the type is unknown, their number does not fit
 * the type, one is out of range, or `weight` is negative or not finite.
 *
 * # Safety
 * `constraint_type` is null or ends with a zero; `ids` is null or readable for `nb_ids` ints.
 */
SHAPEOP_API
int shapeop_addConstraint(struct ShapeOpSolver *op,
                          const char *constraint_type,
                          int *ids,
                          int nb_ids,
                          double weight);

/**
 * Adds many constraints of one type, all or none, at rest where the points are now.
 *
 * - `ids`: the point indices of all constraints behind each other, `nb_ids` in all.
 * - `counts`: the number of indices of each. `nb_counts` 1: the same for all, so there are `nb_ids / counts[0]`
 *   constraints; otherwise one per constraint.
 * - `weights`: `nb_weights` 1: the same for all; otherwise one per constraint.
 * - `scalars`: scalar sets behind each other, `nb_scalars` numbers in all. `nb_scalar_sets` 0: the defaults of the
 *   type; 1: one set for all; otherwise one per constraint. For types that take shapes every set has the same number
 *   of shapes, each of its own constraint's number of points.
 * - `flags`: 0, or `SHAPEOP_HARD`: they are to be met exactly, see `shapeop_setHard`. Unknown bits are refused.
 * - `constraint_ids`: null, or where the ids go, one int per constraint.
 *
 * # Safety
 * `constraint_type` is null or ends with a zero; each array is null or readable for its number of values;
 * `constraint_ids` is null or writable for one int per constraint.
 */
SHAPEOP_API
enum shapeop_err shapeop_addConstraints(struct ShapeOpSolver *op,
                                        const char *constraint_type,
                                        const int *ids,
                                        int nb_ids,
                                        const int *counts,
                                        int nb_counts,
                                        const double *weights,
                                        int nb_weights,
                                        const double *scalars,
                                        int nb_scalars,
                                        int nb_scalar_sets,
                                        unsigned int flags,
                                        int *constraint_ids);

/**
 * Replaces the scalars of a constraint, of the type that it was added with; "Similarity" and "Rigid" may edit each
 * other's. The next solve uses them. Scalars already in force change nothing and cost nothing.
 *
 * Decided in this order: the type cannot be edited (1); the id is no constraint of that type (3); the number of
 * scalars does not fit (2); a scalar is outside its domain or not finite (16).
 *
 * # Safety
 * `constraint_type` is null or ends with a zero; `scalars` is null or readable for `nb_scl` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_editConstraint(struct ShapeOpSolver *op,
                                        const char *constraint_type,
                                        int constraint_id,
                                        const double *scalars,
                                        int nb_scl);

/**
 * Replaces the scalars of many constraints of one type, all or none; otherwise as `shapeop_editConstraint`.
 *
 * - `scalars`: scalar sets behind each other, `nb_scalars` numbers in all. `nb_scalar_sets` 1: one set for all;
 *   otherwise one per constraint, each of the same number of scalars, or of shapes.
 *
 * # Safety
 * `constraint_type` is null or ends with a zero; each array is null or readable for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_editConstraints(struct ShapeOpSolver *op,
                                         const char *constraint_type,
                                         const int *constraint_ids,
                                         int nb_constraint_ids,
                                         const double *scalars,
                                         int nb_scalars,
                                         int nb_scalar_sets);

/**
 * Sets the weight of a constraint: finite, at least 0. The next solve uses it.
 */
SHAPEOP_API enum shapeop_err shapeop_setWeight(struct ShapeOpSolver *op, int constraint_id, double weight);

/**
 * Sets the weights of many constraints, all or none: `nb_weights` 1: the same for all; otherwise one per constraint.
 *
 * # Safety
 * Each array is null or readable for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_setWeights(struct ShapeOpSolver *op,
                                    const int *constraint_ids,
                                    int nb_constraint_ids,
                                    const double *weights,
                                    int nb_weights);

/**
 * Removes a constraint. Its id is never given out again; arrays with one entry per constraint keep its place.
 */
SHAPEOP_API enum shapeop_err shapeop_removeConstraint(struct ShapeOpSolver *op, int constraint_id);

/**
 * The number of constraint ids given out, those of removed ones included, or -1. It is the length of every array with
 * one entry per constraint.
 */
SHAPEOP_API int shapeop_constraintCount(struct ShapeOpSolver *op);

/**
 * 1 if `constraint_id` is a constraint, 0 if it was removed or never given out, -1 if the call is refused.
 */
SHAPEOP_API int shapeop_isConstraint(struct ShapeOpSolver *op, int constraint_id);

/**
 * 1 if the rest state of the constraint spans too little to say what it asks for (a zero-length edge, a flat
 * triangle); it then asks for less or for nothing, as its type's documentation says. 0 if not; -1 if the call is
 * refused.
 */
SHAPEOP_API int shapeop_isDegenerate(struct ShapeOpSolver *op, int constraint_id);

/**
 * Adds a force on every point; `force` is its 3 components. Returns the force's id, or -1 if it is not finite.
 *
 * # Safety
 * `force` is null or readable for 3 doubles.
 */
SHAPEOP_API int shapeop_addGravityForce(struct ShapeOpSolver *op, double *force);

/**
 * Adds a force on the point `id`; `force` is its 3 components. Returns the force's id, or -1 if the point is out of
 * range or the force is not finite.
 *
 * # Safety
 * `force` is null or readable for 3 doubles.
 */
SHAPEOP_API int shapeop_addVertexForce(struct ShapeOpSolver *op, double *force, int id);

/**
 * Replaces the vertex force `force_id` by `force` on the point `id`. Refused, with nothing changed, if it is no vertex
 * force, the point is out of range or the force is not finite.
 *
 * # Safety
 * `force` is null or readable for 3 doubles.
 */
SHAPEOP_API void shapeop_editVertexForce(struct ShapeOpSolver *op, int force_id, double *force, int id);

/**
 * Adds a pressure on faces: `pressure` times the vector area of each face (its area times its normal) is shared among its
 * corners. It follows the points: each iteration has it where they are then, and acceleration is off. Returns the force's id,
 * or -1 if it is refused.
 *
 * - `indices`: the point indices of all faces behind each other, `nb_indices` in all. A normal points to where the corners
 *   run counter-clockwise.
 * - `counts`: the number of corners of each face, at least 3. `nb_counts` 1: the same for all; otherwise one per face.
 * - `pressure`: force per area; negative: against the normals.
 *
 * # Safety
 * Each array is null or readable for its number of values.
 */
SHAPEOP_API
int shapeop_addPressure(struct ShapeOpSolver *op,
                        const int *indices,
                        int nb_indices,
                        const int *counts,
                        int nb_counts,
                        double pressure);

/**
 * Adds a force of length `magnitude` on every corner of faces, once per point, along the normal there: that of the sum of the
 * vector areas of the faces around the point. Else as `shapeop_addPressure`.
 *
 * # Safety
 * Each array is null or readable for its number of values.
 */
SHAPEOP_API
int shapeop_addNormalForce(struct ShapeOpSolver *op,
                           const int *indices,
                           int nb_indices,
                           const int *counts,
                           int nb_counts,
                           double magnitude);

/**
 * Replaces the pressure, or the length of the normal force, of the force `force_id`. The next solve uses it. Refused if it is
 * no such force, or `magnitude` is not finite.
 */
SHAPEOP_API
enum shapeop_err shapeop_editForceMagnitude(struct ShapeOpSolver *op,
                                            int force_id,
                                            double magnitude);

/**
 * Removes a force. Its id is never given out again.
 */
SHAPEOP_API enum shapeop_err shapeop_removeForce(struct ShapeOpSolver *op, int force_id);

/**
 * The number of force ids given out, those of removed ones included, or -1.
 */
SHAPEOP_API int shapeop_forceCount(struct ShapeOpSolver *op);

/**
 * 1 if `force_id` is a force, 0 if it was removed or never given out, -1 if the call is refused.
 */
SHAPEOP_API int shapeop_isForce(struct ShapeOpSolver *op, int force_id);

/**
 * The number of constraint types, or -1. Their indices count from 0 and stay: new types are added behind them.
 */
SHAPEOP_API int shapeop_constraintTypeCount(void);

/**
 * Describes the constraint type `index` in `out`, whose `struct_size` must be set.
 *
 * # Safety
 * `out` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_constraintType(int index, struct shapeop_constraint_type *out);

/**
 * Describes the scalar `scalar_index` of the constraint type `index` in `out`, whose `struct_size` must be set. Types
 * that take shapes have no scalars to describe.
 *
 * # Safety
 * `out` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_constraintScalar(int index,
                                          int scalar_index,
                                          struct shapeop_constraint_scalar *out);

/**
 * What the point index `index_position` of a constraint of the type `index` means, such as "apex"; null if there is no
 * such type or its `index_name_count` is not above `index_position`. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_constraintIndexName(int index, int index_position);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_defaultSolveOptions(struct shapeop_solve_options *options);

/**
 * Iterates until `options` (null: the defaults) say to stop; in dynamic mode within one time step. Iterations are
 * accelerated unless `shapeop_setAcceleration` said otherwise. `progress` may be null; it is called with `user` after
 * every iteration. While it runs, reading calls on `op` from it answer with the current iterate, and all other calls
 * are refused as busy. `report` is null, or its `struct_size` is set; it is written on success.
 *
 * A force along a motion that no constraint resists is the outcome `SO_OUTCOME_UNBOUNDED` of a successful call, a graphics
 * card that was lost or refused work the outcome `SO_OUTCOME_BACKEND_FAILED`; `shapeop_lastError` says more.
 *
 * # Safety
 * `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
 * `progress` is null or a function of that signature. They do not overlap, and nobody changes them during the call.
 */
SHAPEOP_API
enum shapeop_err shapeop_solveUntil(struct ShapeOpSolver *op,
                                    const struct shapeop_solve_options *options,
                                    shapeop_progress_callback progress,
                                    void *user,
                                    struct shapeop_solve_report *report);

/**
 * Writes the energy at the current points to `out`: half the sum of the weighted squared distances to the projections,
 * in static mode minus the potential of the forces, in dynamic mode plus the inertia of the last step.
 *
 * # Safety
 * `out` is null or writable for one double.
 */
SHAPEOP_API enum shapeop_err shapeop_energy(struct ShapeOpSolver *op, double *out);

/**
 * Writes the violation of every constraint id at the current points to `out`, each in its type's unit; 0 for removed
 * ones. `nb` must be `shapeop_constraintCount`; otherwise nothing is written.
 *
 * # Safety
 * `out` is null or writable for `nb` doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_getViolations(struct ShapeOpSolver *op, double *out, int nb);

/**
 * Makes a constraint hard (`is_hard` 1), to be met exactly, or soft (0). The weight of a hard constraint is its
 * priority where not everything can be met. Solving goes on from where it is.
 */
SHAPEOP_API enum shapeop_err shapeop_setHard(struct ShapeOpSolver *op, int constraint_id, int is_hard);

/**
 * 1 if `constraint_id` is a hard constraint, 0 if it is soft or none, -1 if the call is refused.
 */
SHAPEOP_API int shapeop_isHard(struct ShapeOpSolver *op, int constraint_id);

/**
 * Makes a point a handle, drawn to `target` (3 coordinates), or moves its target. Solving goes on from where it is.
 *
 * # Safety
 * `target` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_setHandle(struct ShapeOpSolver *op, int point, const double *target);

/**
 * Lets a handle go: the point is drawn to where it was at initialisation, as the others are. Refused if it is none.
 */
SHAPEOP_API enum shapeop_err shapeop_releaseHandle(struct ShapeOpSolver *op, int point);

/**
 * Writes the default weights to `objective`, whose `struct_size` must be set.
 *
 * # Safety
 * `objective` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_defaultObjective(struct shapeop_objective *objective);

/**
 * Sets the weights of the objective; the rows of fairness stay.
 *
 * # Safety
 * `objective` is null, or its `struct_size` is set and it is readable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_setObjective(struct ShapeOpSolver *op, const struct shapeop_objective *objective);

/**
 * Sets what the fairness term measures: `kind` (a `shapeop_fairness`), with faces or polylines as lists of points.
 *
 * - `indices`: all lists behind each other, `nb_indices` in all.
 * - `counts`: the number of indices of each list, `nb_counts` in all.
 *
 * # Safety
 * Each array is null or readable for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_setFairness(struct ShapeOpSolver *op,
                                     int kind,
                                     const int *indices,
                                     int nb_indices,
                                     const int *counts,
                                     int nb_counts);

/**
 * Writes what the last exploration found to `out`, whose `struct_size` must be set. Refused if there was none.
 *
 * # Safety
 * `out` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_getExploration(struct ShapeOpSolver *op, struct shapeop_exploration *out);

/**
 * The number of hard constraints in the contradiction that the last exploration found; 0: none. Writes their ids to
 * `ids`, which is null or has room for `nb`; a smaller `nb` than that number writes nothing. Without them the others
 * can be met.
 *
 * # Safety
 * `ids` is null or writable for `nb` ints.
 */
SHAPEOP_API int shapeop_getConflicts(struct ShapeOpSolver *op, int *ids, int nb);

/**
 * The number of weight classes of the solution in hand, or -1 if it is none: handles, closeness, fairness, and one per
 * type of soft constraints.
 */
SHAPEOP_API int shapeop_weightClassCount(struct ShapeOpSolver *op);

/**
 * The name of a weight class: "handles", "closeness", "fairness", or the name of a type. Null if there is no such
 * class. Valid until the library is unloaded.
 */
SHAPEOP_API const char *shapeop_weightClassName(struct ShapeOpSolver *op, int index);

/**
 * How the solution in hand answers a change of each weight: refused unless the last solve ended in one.
 *
 * - `points`: null, or where `dp/d ln w` goes, in model units: 3 coordinates of every point for the first class, then
 *   for the next, `nb_points` points per class.
 * - `squares`: null, or where the change of every class's squares `w sum |.|^2` per change of the logarithm of a
 *   weight goes: a row per weight, a column per class.
 * - `nb_classes`: what `shapeop_weightClassCount` says.
 *
 * # Safety
 * Each array is null or writable for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_getSensitivities(struct ShapeOpSolver *op,
                                          double *points,
                                          int nb_points,
                                          double *squares,
                                          int nb_classes);

/**
 * Sets what carries out the iterations of the following solves; `backend` is a `shapeop_backend`, and any other number
 * is refused. `SO_BACKEND_GPU` is refused as `SO_BACKEND_UNAVAILABLE` if there is no graphics card, or if the library
 * was built without the feature `gpu`; `shapeop_lastError` says which. `SO_BACKEND_AUTOMATIC` is never refused.
 * `shapeop_solve_report` says what ran, and `shapeop_backendReason` why. A refused call changes nothing.
 */
SHAPEOP_API enum shapeop_err shapeop_setBackend(struct ShapeOpSolver *op, int backend);

/**
 * The `shapeop_backend` that was set, or -1.
 */
SHAPEOP_API int shapeop_getBackend(struct ShapeOpSolver *op);

/**
 * Chooses the graphics card of the following solves, and how much of it they may use. Without the feature `gpu` it has
 * no effect.
 *
 * - `adapter`: a part of its name, of any case; null or empty: any, the fastest kind first.
 * - `binding_bytes`: bytes of one binding at most; 0: what the card allows. Less makes more and smaller runs of a large
 *   model.
 * - `memory_bytes`: bytes of the card that the solver may take; 0: no limit.
 *
 * Both are whole numbers of at least 0.
 *
 * # Safety
 * `adapter` is null or ends with a zero.
 */
SHAPEOP_API
enum shapeop_err shapeop_setBackendOptions(struct ShapeOpSolver *op,
                                           const char *adapter,
                                           double binding_bytes,
                                           double memory_bytes);

/**
 * Describes the graphics card of the solver in `out`, whose `struct_size` must be set. Refused as
 * `SO_BACKEND_UNAVAILABLE` if there is none, or if the library was built without the feature `gpu`. The first call takes
 * a while: it opens the card.
 *
 * # Safety
 * `out` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_backendInfo(struct ShapeOpSolver *op,
                                     struct shapeop_backend_info *out);

/**
 * Why the last `shapeop_solveUntil` of the solver ran on the backend that its report names, in words; empty if there was
 * none yet, null if `op` is no solver. The text is the calling thread's own copy, valid until that thread's next call of
 * this function.
 */
SHAPEOP_API
const char *shapeop_backendReason(struct ShapeOpSolver *op);

/**
 * Gives the graphics card back, with all memory that solvers have on it: for a host that needs it for something else.
 * Solves that run on it end with `SO_OUTCOME_BACKEND_FAILED`, at the points of their last read-back; later ones open it
 * again. Where there is nothing to give back, it succeeds and does nothing.
 */
SHAPEOP_API enum shapeop_err shapeop_releaseBackend(void);

/**
 * Makes `op` the solver of a problem, whose JSON form `docs/problem.schema.json` states: everything in it is replaced,
 * and it is initialised in the problem's mode. Thread count and linear solver stay. `options` may be null; else its
 * `struct_size` is set, and it receives the problem's stopping rules for `shapeop_solveUntil`.
 *
 * A refusal names the place in the text, such as `constraints[17].indices[2]`, and leaves the solver as it was.
 *
 * # Safety
 * `json` is null or ends with a zero. `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_setProblem(struct ShapeOpSolver *op,
                                    const char *json,
                                    struct shapeop_solve_options *options);

/**
 * The JSON form of a problem, checked, with every default written out and a line per point, constraint, force and face;
 * null if the text is refused. It is the calling thread's own, valid until that thread's next call of this function or
 * of `shapeop_recipe`.
 *
 * # Safety
 * `json` is null or ends with a zero.
 */
SHAPEOP_API const char *shapeop_problemText(const char *json);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_defaultRecipeOptions(struct shapeop_recipe_options *options);

/**
 * The problem that a recipe makes of a mesh, as JSON for `shapeop_setProblem`: "planarize", "circularize", "smooth",
 * "regularize", "equalize" or "rationalize" (`shapeop_recipeName`); null if it is refused. Its points are those of the mesh
 * in their order. The text is the calling thread's own, valid until that thread's next call of this function or of
 * `shapeop_problemText`.
 *
 * - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points.
 * - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all.
 * - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
 * - `options`: null for the defaults.
 *
 * # Safety
 * `name` is null or ends with a zero; each array is null or readable for its number of values. `options` is null, or its
 * `struct_size` is set and it is readable for so many bytes, and its `anchors` for `nb_anchors` ints.
 */
SHAPEOP_API
const char *shapeop_recipe(const char *name,
                           const double *points,
                           int nb_points,
                           const int *face_indices,
                           int nb_face_indices,
                           const int *counts,
                           int nb_counts,
                           const struct shapeop_recipe_options *options);

/**
 * The number of recipes, or -1.
 */
SHAPEOP_API int shapeop_recipeCount(void);

/**
 * The name of the recipe `index`; null if there is none. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_recipeName(int index);

/**
 * Measures every face: "planarity" (the distance of the diagonals of a quad over their mean length, of other polygons the
 * greatest distance from the best-fit plane over the mean edge; 0.01 is one percent), "plane_distance" (model units),
 * "circularity" and "regularity" (over the mean edge), "mean_edge" (model units). `shapeop_measureName` lists the names.
 * Faces are as in `shapeop_recipe`; `out` has one number per face, and `nb` is the number of faces.
 *
 * # Safety
 * `measure` is null or ends with a zero; each array is null or readable, `out` writable, for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_measureFaces(const char *measure,
                                      const double *points,
                                      int nb_points,
                                      const int *face_indices,
                                      int nb_face_indices,
                                      const int *counts,
                                      int nb_counts,
                                      double *out,
                                      int nb);

/**
 * The number of measures of faces, or -1.
 */
SHAPEOP_API int shapeop_measureCount(void);

/**
 * The name of the measure `index`; null if there is none. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_measureName(int index);

/**
 * Creates a surface of a circular net: `rows` times `columns` points, row by row; `wraps` says which directions close.
 * `frame` is that at point (0, 0): the unit tangents `t1`, from row to row, and `t2`, from column to column,
 * orthogonal; the normal is their cross product. `kind` is a `shapeop_canal_kind`. Null if it is refused, as a net is
 * whose quads have no circles. Delete it with `shapeop_canalDelete`.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalCreate(const double *points,
                                         int rows,
                                         int columns,
                                         int wraps,
                                         const double *frame,
                                         int kind);

/**
 * Creates the surface that a text in JSON states (`docs/canal.schema.json`). Null if it is refused; the message names
 * the place in the text.
 *
 * # Safety
 * `json` is null or ends with a zero.
 */
SHAPEOP_API struct ShapeOpCanal *shapeop_canalFromJson(const char *json);

/**
 * Creates a copy of a surface; null if it is refused.
 */
SHAPEOP_API struct ShapeOpCanal *shapeop_canalCopy(struct ShapeOpCanal *surface);

/**
 * Deletes a surface. Null does nothing; a busy surface is left alone, as is whatever is no surface.
 */
SHAPEOP_API void shapeop_canalDelete(struct ShapeOpCanal *surface);

/**
 * The JSON form of a surface, its base and its chain of transformations; null if it is refused. The text is the
 * calling thread's own, valid until that thread's next call of a `shapeop_canal...` function that answers with a text.
 */
SHAPEOP_API const char *shapeop_canalText(struct ShapeOpCanal *surface);

/**
 * The name of a surface's family, such as `MC-canal`: `M` for an inversion, `C` for a Combescure transformation, the
 * last one first; null if it is refused. It is valid as long as that of `shapeop_canalText`.
 */
SHAPEOP_API const char *shapeop_canalFamily(struct ShapeOpCanal *surface);

/**
 * The kind of a surface's base, a `shapeop_canal_kind`, or -1.
 */
SHAPEOP_API int shapeop_canalKind(struct ShapeOpCanal *surface);

/**
 * The number of transformations in a surface's chain, or -1.
 */
SHAPEOP_API int shapeop_canalChainCount(struct ShapeOpCanal *surface);

/**
 * Writes the size of a surface's net: `rows`, `columns` and `wraps`, bits as in `shapeop_canalCreate`. Each may be
 * null.
 *
 * # Safety
 * Each is null or writable for one int.
 */
SHAPEOP_API enum shapeop_err shapeop_canalSize(struct ShapeOpCanal *surface, int *rows, int *columns, int *wraps);

/**
 * Writes the points of a surface's net, row by row, if there is room for `capacity` points, and their number to
 * `count`. With null and 0 it only tells the number.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalPoints(struct ShapeOpCanal *surface,
                                     double *points,
                                     int capacity,
                                     int *count);

/**
 * As `shapeop_canalPoints`, for the frames at the points: each the unit vectors `t1`, `t2` and the normal, 9 doubles.
 *
 * # Safety
 * `frames` is null or writable for `9 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalFrames(struct ShapeOpCanal *surface,
                                     double *frames,
                                     int capacity,
                                     int *count);

/**
 * As `shapeop_canalPoints`, for the net of the base.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalBasePoints(struct ShapeOpCanal *surface,
                                         double *points,
                                         int capacity,
                                         int *count);

/**
 * As `shapeop_canalPoints`, for the base that the inverse chain makes of the net: what differs from
 * `shapeop_canalBasePoints` is round-off.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalRestoredPoints(struct ShapeOpCanal *surface,
                                             double *points,
                                             int capacity,
                                             int *count);

/**
 * Inverts a surface: a point at the vector `q` from `center` goes to `ratio * q / |q|^2`; `ratio` is in squared model
 * units and not 0. The surface becomes M of what it was.
 *
 * # Safety
 * `center` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_canalInvert(struct ShapeOpCanal *surface, const double *center, double ratio);

/**
 * Moves a surface by a vector.
 *
 * # Safety
 * `vector` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_canalTranslate(struct ShapeOpCanal *surface, const double *vector);

/**
 * Scales a surface about the origin by a factor that is not 0.
 */
SHAPEOP_API enum shapeop_err shapeop_canalScale(struct ShapeOpCanal *surface, double factor);

/**
 * Turns a surface about the axis through the origin along `axis`, of any length but 0, by `angle` radians,
 * right-handed.
 *
 * # Safety
 * `axis` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_canalRotate(struct ShapeOpCanal *surface, const double *axis, double angle);

/**
 * The Combescure transformation of a surface: the parallel net whose edges along column 0 (from row to row) and along
 * row 0 are these multiples, none 0, of what they were. One factor for each edge. Lengths of a direction that wraps
 * must close it (`shapeop_canalCloseLengths`).
 *
 * # Safety
 * Each array is null or readable for its number of doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCombescureFactors(struct ShapeOpCanal *surface,
                                                const double *column,
                                                int nb_column,
                                                const double *row,
                                                int nb_row);

/**
 * Takes the last transformation off: 1, 0 if there is none, or -1.
 */
SHAPEOP_API int shapeop_canalUndo(struct ShapeOpCanal *surface);

/**
 * Creates the surface that `surface` is when every face is cut into `one` by `two` pieces along lines of curvature,
 * without a chain: the base is refined and transformed, so that old points stay. Null if it is refused.
 */
SHAPEOP_API struct ShapeOpCanal *shapeop_canalRefined(struct ShapeOpCanal *surface, int one, int two);

/**
 * As `shapeop_canalRefined`, with every face cut at the given fractions of the arcs of column 0 (`one`) and row 0
 * (`two`), ascending between 0 and 1; the net itself is cut, not its base.
 *
 * # Safety
 * Each array is null or readable for its number of doubles.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalRefinedAt(struct ShapeOpCanal *surface,
                                            const double *one,
                                            int nb_one,
                                            const double *two,
                                            int nb_two);

/**
 * Writes the point and the frame (9 doubles; each output may be null) of the patch over face `(i, j)` at the fractions
 * `u` and `v`, 0 to 1, of its arcs from row to row and from column to column.
 *
 * # Safety
 * `point` is null or writable for 3 doubles, `frame` for 9.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalEvaluate(struct ShapeOpCanal *surface,
                                       int i,
                                       int j,
                                       double u,
                                       double v,
                                       double *point,
                                       double *frame);

/**
 * Writes how far the frames come back from themselves across the seams of a surface that wraps, as a difference of
 * unit vectors: 0 where the surface is smooth there, or does not wrap.
 *
 * # Safety
 * `gap` is null or writable for one double.
 */
SHAPEOP_API enum shapeop_err shapeop_canalClosingGap(struct ShapeOpCanal *surface, double *gap);

/**
 * Writes how near any forces along the lines of curvature come to equilibrium under a pressure along the normals: 0,
 * the lines can be lines of principal stress; 1, no force carries anything.
 *
 * # Safety
 * `residual` is null or writable for one double.
 */
SHAPEOP_API enum shapeop_err shapeop_canalMembraneResidual(struct ShapeOpCanal *surface, double *residual);

/**
 * As `shapeop_canalMembraneResidual`, for given forces per length in both directions, one per face, above 0 for
 * tension under `pressure` along the normal, which is not 0.
 *
 * # Safety
 * The forces are null or readable for `nb_faces` doubles, `residual` is null or writable for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalMembraneResidualOf(struct ShapeOpCanal *surface,
                                                 double pressure,
                                                 const double *forces_one,
                                                 const double *forces_two,
                                                 int nb_faces,
                                                 double *residual);

/**
 * As `shapeop_canalCreate`, for a surface that is creased along some of its rows (`direction` is 1, in which they are
 * crossed) or columns (2): continuous there, but not smooth. `lines` has their indices, neither 0 nor beyond the last;
 * `angles`, in radians, by how much the frames from there on are turned about the line's tangent. The angles of a line
 * that is named twice are added.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6; `lines` and `angles` are null or
 * readable for `nb_kinks` values.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalCreateWithKinks(const double *points,
                                                  int rows,
                                                  int columns,
                                                  int wraps,
                                                  const double *frame,
                                                  int kind,
                                                  int direction,
                                                  const int *lines,
                                                  const double *angles,
                                                  int nb_kinks);

/**
 * Writes the kinks of a surface's base, as in `shapeop_canalCreateWithKinks`, if there is room for `capacity` of them,
 * and their number to `count`. `direction` is 0 without any. `lines`, `angles` and `direction` may be null.
 *
 * # Safety
 * `direction` and `count` are null or writable for one int, `lines` and `angles` for `capacity` values.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalKinks(struct ShapeOpCanal *surface,
                                    int *direction,
                                    int *lines,
                                    double *angles,
                                    int capacity,
                                    int *count);

/**
 * Measures how circular quads are; `quads` has 4 point indices for each. Each output may be null: `planarity` is the
 * distance of a quad's diagonals over its mean edge, `concyclicity` that of a corner from the circle through the other
 * three over its radius, `is_in_order` whether the corners follow each other around it, so that the quad does not
 * cross itself.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; each output is null or
 * writable for `nb_quads` values.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCheckCircular(const double *points,
                                            int nb_points,
                                            const int *quads,
                                            int nb_quads,
                                            double *planarity,
                                            double *concyclicity,
                                            int *is_in_order);

/**
 * Compares the edges of two meshes with the same points, pairs of point indices: writes the largest sine of the angle
 * between an edge and its counterpart, and how many point the other way. Each output may be null.
 *
 * # Safety
 * `a` and `b` are null or readable for `3 * nb_points` doubles, `edges` for `2 * nb_edges` ints; each output is null
 * or writable for one value.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCheckParallel(const double *a,
                                            const double *b,
                                            int nb_points,
                                            const int *edges,
                                            int nb_edges,
                                            double *largest_sine,
                                            int *reversed_count);

/**
 * Writes the lengths of a grid's edges along column 0, from row to row, and along row 0: one fewer than points there,
 * as many where the direction wraps. `rows` times `columns` points, row by row; `wraps`: `SHAPEOP_WRAPS_ROWS`,
 * `SHAPEOP_WRAPS_COLUMNS`.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles; `column` and `row` are null or writable for the
 * lengths.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalGridLengths(const double *points,
                                          int rows,
                                          int columns,
                                          int wraps,
                                          double *column,
                                          double *row);

/**
 * Writes the lengths for `shapeop_canalCombescure` along two polylines that replace column 0 and row 0 and whose edges
 * are parallel to theirs; below 0 where they point the other way. A polyline has one point more than edges.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles, each polyline for 3 times its number of points;
 * `column` and `row` are null or writable for one double per edge.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalPolylineLengths(const double *points,
                                              int rows,
                                              int columns,
                                              int wraps,
                                              const double *column_points,
                                              int nb_column_points,
                                              const double *row_points,
                                              int nb_row_points,
                                              double *column,
                                              double *row);

/**
 * Writes the lengths nearest to the given ones, by least squares, with which a grid that wraps closes.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles; `column` and `out_column` are null or readable and
 * writable for `nb_column` doubles, `row` and `out_row` for `nb_row`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCloseLengths(const double *points,
                                           int rows,
                                           int columns,
                                           int wraps,
                                           const double *column,
                                           int nb_column,
                                           const double *row,
                                           int nb_row,
                                           double *out_column,
                                           double *out_row);

/**
 * Writes the grid parallel to a circular one whose edges along column 0 and row 0 have given lengths, in model units,
 * below 0 where they point the other way; it is circular again. `origin` is its point (0, 0), that of the grid itself
 * if null; `reversed_count`, which may be null, the number of edges that point the other way.
 *
 * # Safety
 * `points` is null or readable, `out` null or writable, for `3 * rows * columns` doubles; `column` and `row` are null
 * or readable for their numbers of doubles, `origin` for 3; `reversed_count` is null or writable for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCombescure(const double *points,
                                         int rows,
                                         int columns,
                                         int wraps,
                                         const double *column,
                                         int nb_column,
                                         const double *row,
                                         int nb_row,
                                         const double *origin,
                                         double *out,
                                         int *reversed_count);

/**
 * Computes an orthonormal basis of the space of all meshes parallel to a mesh of quads, at most 1000 points, each of
 * them in a face: `dimension` vectors, each `x0 y0 z0 x1 ...`. They are written behind each other if `capacity`,
 * counted in vectors, suffices; with null and 0 only the dimension is told.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; `basis` is null or
 * writable for `3 * nb_points * capacity` doubles, `dimension` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalParallelSpace(const double *points,
                                            int nb_points,
                                            const int *quads,
                                            int nb_quads,
                                            double *basis,
                                            int capacity,
                                            int *dimension);

/**
 * Writes, of all meshes parallel to a mesh of quads, the one whose points `handles` are nearest to `targets` by the
 * sum of squares; among equally near ones that nearest to the mesh itself. Every point is in a face. Of a mesh of more
 * than 1000 points all points are targets of their own, a millionth as heavy as the handles, and edges are parallel to
 * 1e-12 or as near as 100 rounds bring them: `shapeop_canalCheckParallel` tells.
 *
 * # Safety
 * `points` is null or readable, `out` null or writable, for `3 * nb_points` doubles; `quads` is null or readable for
 * `4 * nb_quads` ints, `handles` for `nb_handles` ints, `targets` for `3 * nb_handles` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalNearestParallel(const double *points,
                                              int nb_points,
                                              const int *quads,
                                              int nb_quads,
                                              const int *handles,
                                              const double *targets,
                                              int nb_handles,
                                              double *out);

/**
 * Sorts a mesh of quads into grids: `grid_count` is the number of its components, and `rows`, `columns` and `wraps`
 * are those of component `component`. Its point (i, j) is point `indices[i * columns + j]` of the mesh; they are
 * written if there is room for `capacity` of them, and `count` is their number. The other outputs may be null.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; `indices` is null or
 * writable for `capacity` ints, all other outputs for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalGridOfMesh(const double *points,
                                         int nb_points,
                                         const int *quads,
                                         int nb_quads,
                                         int component,
                                         int *grid_count,
                                         int *rows,
                                         int *columns,
                                         int *wraps,
                                         int *indices,
                                         int capacity,
                                         int *count);

/**
 * Writes the frame (9 doubles: the unit vectors `t1`, `t2` and the normal `t1 x t2`) whose normal has the spherical
 * coordinates `theta`, from +z, and `lambda`, from +x about +z, turned about it by `psi`, all in radians.
 *
 * # Safety
 * `out` is null or writable for 9 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_canalFrameOfAngles(double lambda, double theta, double psi, double *out);

/**
 * Writes the frame that has the tangent `tangent`, of any length but 0, in `direction` 1 (from row to row) or 2 (from
 * column to column), and whose normal is as near as possible to `normal`.
 *
 * # Safety
 * `tangent` and `normal` are null or readable for 3 doubles; `out` is null or writable for 9.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalFrameOfTangent(const double *tangent,
                                             const double *normal,
                                             int direction,
                                             double *out);

/**
 * Writes the frame at the other end of an edge in `direction` 1 or 2: the mirror image in the plane that bisects it,
 * with the tangent of that direction turned round. `frame` has the unit vectors `t1` and `t2`, 6 doubles; `out` has 9.
 *
 * # Safety
 * `frame` is null or readable for 6 doubles, `edge` for 3; `out` is null or writable for 9.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalFrameAcross(const double *frame,
                                          const double *edge,
                                          int direction,
                                          double *out);

/**
 * Writes the frames at all points of a circular grid, 9 doubles each, from that at point (0, 0): `frame`, the unit
 * vectors `t1` and `t2`. `closing_gap`, which may be null, is that of `shapeop_canalClosingGap`.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6; `out` is null or writable for
 * `9 * rows * columns` doubles, `closing_gap` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalGridFrames(const double *points,
                                         int rows,
                                         int columns,
                                         int wraps,
                                         const double *frame,
                                         double *out,
                                         double *closing_gap);

/**
 * Looks for folds of a grid whose column 0 is the guide. Each output may be null: per row `evolute_ratios`, how far
 * its section reaches towards the evolute of the guide (1: up to it; 0 where the guide is straight) and
 * `is_near_evolute` (from 0.8 on); per face `edge_ratios`, the least ratio of opposite edges, and `face_flags`, bits
 * `SHAPEOP_FACE_...`.
 *
 * # Safety
 * `points` is null or readable for `3 * rows * columns` doubles; each output is null or writable for one value per row
 * or face.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalFolds(const double *points,
                                    int rows,
                                    int columns,
                                    int wraps,
                                    double *evolute_ratios,
                                    int *is_near_evolute,
                                    double *edge_ratios,
                                    int *face_flags);

/**
 * Writes the images of points under the inversion at `center`: a point at the vector `q` from there goes to
 * `ratio * q / |q|^2`. `ratio` is in squared model units and not 0; below 0 it mirrors in the center too.
 *
 * # Safety
 * `points` is null or readable, `out` null or writable, for `3 * nb_points` doubles; `center` is readable for 3.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalInvertPoints(const double *points,
                                           int nb_points,
                                           const double *center,
                                           double ratio,
                                           double *out);

/**
 * The same in the complex plane: `points` and `out` have 2 doubles for each point, its real and its imaginary part.
 *
 * # Safety
 * `points` is null or readable, `out` null or writable, for `2 * nb_points` doubles; `center` is readable for 2.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalInvertComplex(const double *points,
                                            int nb_points,
                                            const double *center,
                                            double ratio,
                                            double *out);

/**
 * Writes the image of a circle: its center, the unit vector along its axis and its radius, 7 doubles, as it is given.
 * A circle through the center of inversion goes to a line: `is_line` then is 1, and `out` a point of it, a unit vector
 * along it, and 0.
 *
 * # Safety
 * `circle` is null or readable for 7 doubles, `center` for 3; `out` is null or writable for 7 doubles, `is_line` for
 * one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalInvertCircle(const double *circle,
                                           const double *center,
                                           double ratio,
                                           double *out,
                                           int *is_line);

/**
 * Writes the image of a sphere. Either `is_plane` is 0 and `out` has a sphere: its center, three zeros, and its
 * radius. Or, for a sphere through the center of inversion, it is 1 and `out` has a plane: a point, the unit normal,
 * and 0.
 *
 * # Safety
 * `sphere_center` and `center` are null or readable for 3 doubles; `out` is null or writable for 7, `is_plane` for one
 * int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalInvertSphere(const double *sphere_center,
                                           double radius,
                                           const double *center,
                                           double ratio,
                                           double *out,
                                           int *is_plane);

/**
 * As `shapeop_canalInvertSphere`, for the plane through a point with a normal of any length but 0.
 *
 * # Safety
 * `point`, `normal` and `center` are null or readable for 3 doubles; `out` is null or writable for 7, `is_plane` for
 * one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalInvertPlane(const double *point,
                                          const double *normal,
                                          const double *center,
                                          double ratio,
                                          double *out,
                                          int *is_plane);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_canalDefaultSmoothOptions(struct shapeop_canal_smooth_options *options);

/**
 * Smooths a strip with a frame at its first point (`frame`: the unit tangents `t1`, near the guide's, and `t2`):
 * lowers the sum of the squared curvatures of the arcs over all edges by moving the guide's points along their curve,
 * the cubic spline through them, and by changing lengths and frame. The guide's ends and the direction of the first
 * crossing edge stay.
 *
 * `options` is null for the defaults. `progress` may be null. Outputs: the guide and the border, `nb_points` points
 * each, where each guide point is on the curve (`parameters`, in lengths of chords along the given points) and the
 * frame, 9 doubles; the last two may be null. `report` is null, or its `struct_size` is set. Of `history`, the
 * functional at the start and after every iteration, as many entries are written as there are if there is room for
 * `capacity`; `count` is their number. All three are null, 0 and null to leave it out.
 *
 * # Safety
 * `guide` and `border` are null or readable, `out_guide` and `out_border` null or writable, for `3 * nb_points`
 * doubles; `frame` is readable for 6. `parameters` is null or writable for `nb_points` doubles, `out_frame` for 9,
 * `history` for `capacity`, `count` for one int. `options` and `report` are null, or their `struct_size` is set and
 * they are readable or writable for so many bytes. `progress` is null or a function of that signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalSmooth(const double *guide,
                                     const double *border,
                                     int nb_points,
                                     const double *frame,
                                     const struct shapeop_canal_smooth_options *options,
                                     shapeop_canal_progress_callback progress,
                                     void *user,
                                     double *out_guide,
                                     double *out_border,
                                     double *parameters,
                                     double *out_frame,
                                     double *history,
                                     int capacity,
                                     int *count,
                                     struct shapeop_canal_smooth_report *report);

/**
 * Writes what `shapeop_canalSmooth` minimises, for a strip with a frame at its first point.
 *
 * # Safety
 * `guide` and `border` are null or readable for `3 * nb_points` doubles, `frame` for 6; `out` is null or writable for
 * one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStripEnergy(const double *guide,
                                          const double *border,
                                          int nb_points,
                                          const double *frame,
                                          double *out);

/**
 * Writes the border of the strip of circular quads along `points` that begins at `start` and whose crossing edges have
 * the given lengths, in model units, one for each point. Not every sequence of lengths is attainable: `flags` has bits
 * `SHAPEOP_STRIP_...`; without them a refusal says what is attainable, and the message has the quad.
 *
 * All outputs but `border` may be null: the lengths that were made, the largest attainable length at the end of each
 * quad, whether each quad crosses itself, whether each length was replaced, and the largest difference of a length
 * from that asked for.
 *
 * # Safety
 * `points` is null or readable, `border` null or writable, for `3 * nb_points` doubles; `start` is readable for 3.
 * `lengths`, `out_lengths` and `is_projected` have `nb_points` values, `attainable` and `is_flipped` one fewer,
 * `deviation` one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStrip(const double *points,
                                    int nb_points,
                                    const double *start,
                                    const double *lengths,
                                    unsigned int flags,
                                    double *border,
                                    double *out_lengths,
                                    double *attainable,
                                    int *is_flipped,
                                    int *is_projected,
                                    double *deviation);

/**
 * As `shapeop_canalStrip`, from the radius of each quad's circle, one fewer than points. `start` says in which
 * direction the first crossing edge goes. With `flags` `SHAPEOP_STRIP_STRICT` quads that cross themselves are refused.
 *
 * # Safety
 * As `shapeop_canalStrip`; `radii` is null or readable for `nb_points - 1` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStripOfRadii(const double *points,
                                           int nb_points,
                                           const double *start,
                                           const double *radii,
                                           unsigned int flags,
                                           double *border,
                                           double *out_lengths,
                                           int *is_flipped);

/**
 * As `shapeop_canalStrip`, from the lengths of the border's edges, one fewer than points. They are attainable from any
 * angle.
 *
 * # Safety
 * As `shapeop_canalStrip`; `edges` is null or readable for `nb_points - 1` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStripOfBorderEdges(const double *points,
                                                 int nb_points,
                                                 const double *start,
                                                 const double *edges,
                                                 double *border,
                                                 double *out_lengths,
                                                 int *is_flipped);

/**
 * Writes lengths of crossing edges, one for each point, that go from `first` to `last` evenly along the polyline.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `out` is null or writable for `nb_points`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalLengthsBetween(const double *points,
                                             int nb_points,
                                             double first,
                                             double last,
                                             double *out);

/**
 * Writes the lengths of the edges of a border that is `length` long in all, one fewer than points, each in the
 * proportion of the guide's edge.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `out` is null or writable for `nb_points - 1`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalEdgesOfBorder(const double *points,
                                            int nb_points,
                                            double length,
                                            double *out);

/**
 * Writes the circle of each quad of a strip: its center, the unit vector along its axis and its radius, 7 doubles; one
 * fewer than points on either side.
 *
 * # Safety
 * `guide` and `border` are null or readable for `3 * nb_points` doubles, `out` is null or writable for `7 * (nb_points
 * - 1)`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStripCircles(const double *guide,
                                           const double *border,
                                           int nb_points,
                                           double *out);

/**
 * Writes the strip whose quads have the given circles, two or more, of which consecutive ones meet in two points:
 * `nb_circles + 1` points on either side. The first crossing edge goes through the point of the first circle nearest
 * to `start`, the last one through that of the last circle nearest to `end`; either may be null. `distance`, which may
 * be null, is the largest distance of a point from a circle that it should be on.
 *
 * # Safety
 * `circles` is null or readable for `7 * nb_circles` doubles, `start` and `end` are null or readable for 3; `guide`
 * and `border` are null or writable for `3 * (nb_circles + 1)`, `distance` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalStripOfCircles(const double *circles,
                                             int nb_circles,
                                             const double *start,
                                             const double *end,
                                             double *guide,
                                             double *border,
                                             double *distance);

/**
 * Tells how a frame comes back around a closed polygon, whose last point may repeat the first. Each output may be
 * null: the product of the reflections, 9 doubles column by column; how far it is from what a smooth surface needs;
 * whether that is round-off; for an odd number of edges the first tangent that the frame must have (zero for an even
 * number, where it is free).
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles; `matrix` is null or writable for 9 doubles, `tangent` for
 * 3, `residual` and `closes` for one value.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalHolonomy(const double *points,
                                       int nb_points,
                                       double *matrix,
                                       double *residual,
                                       int *closes,
                                       double *tangent);

/**
 * Writes the frame at the first point of a closed polygon with which the surface is smooth across the seam and that is
 * nearest to `wish`, the unit tangents `t1` and `t2`; 9 doubles. Refused with `SO_NOT_CLOSED` where there is none.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `wish` for 6; `out` is null or writable for 9.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalClosedFrame(const double *points,
                                          int nb_points,
                                          const double *wish,
                                          double *out);

/**
 * Writes the closed polygon inscribed in a sphere about the origin whose edges are parallel to those of a closed
 * polygon and nearest to them in length, if there is room for `capacity` points, and their number to `count`: 0 if
 * there is none, as the polygon is not pseudo-spherical. `reversed_count`, which may be null, is the number of its
 * edges that point the other way.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles; `out` is null or writable for `3 * capacity` doubles,
 * `count` and `reversed_count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalParallelOnSphere(const double *points,
                                               int nb_points,
                                               double *out,
                                               int capacity,
                                               int *count,
                                               int *reversed_count);

/**
 * Writes the circle that closes a strip: `first_circle` goes through `start` and the guide's first point
 * `guide_first`, `last_circle` through the guide's last point `guide_last`. `first` is where `start` must be, `last`
 * the point opposite to `guide_last`. Other outputs may be null: `which_case` is 1 if both circles are on one sphere,
 * so that `start` stays, or 2; `is_crossed` whether the closing quad crosses itself.
 *
 * # Safety
 * Circles are null or readable for 7 doubles, points for 3; `circle` is null or writable for 7, `first` and `last` for
 * 3, the others for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCloseCircles(const double *first_circle,
                                           const double *last_circle,
                                           const double *start,
                                           const double *guide_first,
                                           const double *guide_last,
                                           double *circle,
                                           double *first,
                                           double *last,
                                           int *which_case,
                                           int *is_crossed);

/**
 * Closes a strip of `nb_points` points on either side with the guide's last point `last`: writes the border of
 * `nb_points + 1` points, of which the first moves where it must. `circle` (of the closing quad), `which_case` and
 * `is_flipped` (one for each quad, the closing one last) may be null.
 *
 * # Safety
 * `guide` and `border` are null or readable for `3 * nb_points` doubles, `last` for 3; `out_border` is null or
 * writable for `3 * (nb_points + 1)` doubles, `circle` for 7, `is_flipped` for `nb_points + 1` ints, `which_case` for
 * one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCloseStrip(const double *guide,
                                         const double *border,
                                         int nb_points,
                                         const double *last,
                                         double *out_border,
                                         double *circle,
                                         int *which_case,
                                         int *is_flipped);

/**
 * Writes points spread over the cubic spline through given ones, and its unit tangents there, which may be null.
 * `spacing` is a `shapeop_canal_spacing`; for `SO_CANAL_SPACING_POINTS` `nb` is that of the points themselves (without
 * a last one that repeats the first of a closed curve). A closed curve's first point is not repeated.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles; `out` and `tangents` are null or writable for `3 * nb`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCurvePoints(const double *points,
                                          int nb_points,
                                          int is_closed,
                                          int spacing,
                                          double *out,
                                          double *tangents,
                                          int nb);

/**
 * Writes normals along a curve through given points, the first one at an angle (see
 * `shapeop_canal_fit_options.angle`), or as near as possible to `first` if that is not null. `tangents`, of any
 * length, are those of the curve; null: of the spline through the points. `normals` turn as little as the curve
 * allows; `frames` (9 doubles each) are mirrored from point to point, as those of a cyclidic net along its guide. Each
 * of the two may be null. The last point of a closed curve must not repeat the first.
 *
 * # Safety
 * `points` and `tangents` are null or readable, `normals` is null or writable, for `3 * nb_points` doubles; `first` is
 * null or readable for 3; `frames` is null or writable for `9 * nb_points`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalNormals(const double *points,
                                      const double *tangents,
                                      int nb_points,
                                      int is_closed,
                                      double angle,
                                      const double *first,
                                      double *normals,
                                      double *frames);

/**
 * Writes the spheres that touch a curve in given points, with their centers along `normals` (of any length), and a
 * second curve, the spline through `curve`: the center and the radius, 4 doubles each. Each other output may be null:
 * how far each center is along its normal, where each sphere touches the second curve, bits `SHAPEOP_SPHERE_...` for
 * each, and the sum of the squared differences of radius and distance.
 *
 * # Safety
 * `points` and `normals` are null or readable for `3 * nb_points` doubles, `curve` for `3 * nb_curve`; for each point
 * `spheres` is null or writable for 4 doubles, `offsets` for one, `feet` for 3, `flags` for one int; `residual` for
 * one double.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalTouchingSpheres(const double *points,
                                              const double *normals,
                                              int nb_points,
                                              const double *curve,
                                              int nb_curve,
                                              int is_curve_closed,
                                              double *spheres,
                                              double *offsets,
                                              double *feet,
                                              int *flags,
                                              double *residual);

/**
 * Writes the circles in which each sphere (its center and its radius, 4 doubles) meets the next: one fewer than
 * spheres.
 *
 * # Safety
 * `spheres` is null or readable for `4 * nb_spheres` doubles, `out` is null or writable for `7 * (nb_spheres - 1)`.
 */
SHAPEOP_API enum shapeop_err shapeop_canalCharacteristicCircles(const double *spheres, int nb_spheres, double *out);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_canalDefaultFitOptions(struct shapeop_canal_fit_options *options);

/**
 * Creates the canal surface through the points of a first curve that touches a second one: the splines through `guide`
 * and `curve`. Row `i` is on circle `i`, from its point of the first curve on unless the section starts elsewhere.
 * Rows do not wrap; columns do around whole circles. `options` is null for the defaults. Null if it is refused.
 *
 * The outputs may be null (a count with them): the circles, 7 doubles each, and the spheres between them, 4 doubles
 * each, with bits `SHAPEOP_SPHERE_...`, are written if there is room for so many. `report` is null, or its
 * `struct_size` is set.
 *
 * # Safety
 * `guide` and `curve` are null or readable for 3 times their number of points; `circles` is null or writable for `7 *
 * circle_capacity` doubles, `spheres` for `4 * sphere_capacity`, `sphere_flags` for `sphere_capacity` ints, the counts
 * for one. `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so
 * many bytes.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalFit(const double *guide,
                                      int nb_guide,
                                      int is_guide_closed,
                                      const double *curve,
                                      int nb_curve,
                                      int is_curve_closed,
                                      const struct shapeop_canal_fit_options *options,
                                      double *circles,
                                      int circle_capacity,
                                      int *circle_count,
                                      double *spheres,
                                      int *sphere_flags,
                                      int sphere_capacity,
                                      int *sphere_count,
                                      struct shapeop_canal_fit_report *report);

/**
 * Writes points of a section of a circle at equal angles, from its point `start` on: as many as
 * `options->column_count` says. `target` is where the second curve passes, for `SO_CANAL_SECTION_TO_CURVE`; else null.
 * Of `options` those on the section count.
 *
 * # Safety
 * `circle` is null or readable for 7 doubles, `start` and `target` for 3; `options` is null, or its `struct_size` is
 * set and it is readable for so many bytes; `out` is null or writable for 3 times the number of points.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalSectionPoints(const double *circle,
                                            const double *start,
                                            const double *target,
                                            const struct shapeop_canal_fit_options *options,
                                            double *out);

/**
 * Writes the grid of which row `i` is on circle `i` and row 0 is given; `guide` has a point of each circle, along
 * which the rows lead from circle to circle. Consecutive circles are on one sphere. If `wraps` is 1 the rows close
 * around the circles.
 *
 * # Safety
 * `circles` is null or readable for `7 * nb_circles` doubles, `guide` for `3 * nb_circles`, `row` for `3 * nb_row`;
 * `out` is null or writable for `3 * nb_circles * nb_row`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalMeshCircles(const double *circles,
                                          const double *guide,
                                          int nb_circles,
                                          const double *row,
                                          int nb_row,
                                          int wraps,
                                          double *out);

/**
 * Writes a point of each circle from `start`, a point of the first, on. With `guide`, a point of each circle, they
 * make circular quads with it; with null they are a column along which a mesh closes around whole circles: the
 * circles' tangents there are mirror images of each other.
 *
 * # Safety
 * `circles` is null or readable for `7 * nb_circles` doubles, `start` for 3; `guide` is null or readable, `out` null
 * or writable, for `3 * nb_circles`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalColumn(const double *circles,
                                     int nb_circles,
                                     const double *start,
                                     const double *guide,
                                     double *out);

/**
 * Creates the surface of revolution of a profile about the axis through `axis_point` along `axis_direction`. Column 0
 * is the profile, row `i` runs along the circle of its point `i`, `columns` points from 0 to `angle` (0 to 2 pi,
 * right-handed); a full turn wraps. Null if it is refused, as a profile is that is not in a plane through the axis.
 *
 * # Safety
 * `profile` is null or readable for `3 * nb_profile` doubles, the axis for 3 each.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalRevolution(const double *profile,
                                             int nb_profile,
                                             const double *axis_point,
                                             const double *axis_direction,
                                             double angle,
                                             int columns);

/**
 * Creates the moulding surface of a planar rail and a profile in an orthogonal plane that starts on it. Column 0 is
 * the rail, row 0 the profile. Each output may be null: the angle, in radians, between the normal of the profile's
 * plane and the rail's start; how many edges point the other way than the rail's, where the profile reaches beyond the
 * rail's evolute; for a closed rail, how far the profile is from itself after one turn. Null if it is refused.
 *
 * # Safety
 * `rail` and `profile` are null or readable for 3 times their number of points; each output is null or writable for
 * one value.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalMoulding(const double *rail,
                                           int nb_rail,
                                           const double *profile,
                                           int nb_profile,
                                           double *obliquity,
                                           int *reversed_count,
                                           double *closing_gap);

/**
 * As `shapeop_canalMoulding`, for a rail in space and a planar profile that starts on it: the Monge surface, on which
 * the profile moves without twist.
 *
 * # Safety
 * As `shapeop_canalMoulding`.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalMonge(const double *rail,
                                        int nb_rail,
                                        const double *profile,
                                        int nb_profile,
                                        double *obliquity,
                                        int *reversed_count,
                                        double *closing_gap);

/**
 * Writes the surface of translation, `rail[i] + profile[j] - profile[0]`, if there is room for `capacity` points, and
 * their number to `count`. Its quads are planar but not circular, so it is no surface with a handle. With `factors`,
 * one above 0 for each rail point, it is the surface of scale-translation, `rail[i] + factors[i] (profile[j] -
 * profile[0])`; null for none. A rail or a profile whose last point repeats the first closes the grid. `rows`,
 * `columns` and `wraps` may be null.
 *
 * # Safety
 * `rail` and `profile` are null or readable for 3 times their number of points, `factors` for `nb_rail` doubles;
 * `points` is null or writable for `3 * capacity` doubles, the other outputs for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalTranslation(const double *rail,
                                          int nb_rail,
                                          const double *profile,
                                          int nb_profile,
                                          const double *factors,
                                          double *points,
                                          int capacity,
                                          int *count,
                                          int *rows,
                                          int *columns,
                                          int *wraps);

/**
 * Tells the centers of inversion that map four points of a circle, in order round it, to the corners of an isosceles
 * trapezoid with the parallel sides `P1 P2` and `P4 P3`. Each output may be null: the circle through them; the circle
 * of centers, 7 doubles as all circles, or if `is_line` is 1 the line: a point, a unit vector, and 0; and the two ends
 * of the open interval of ratios of the parallel sides for which there are solutions.
 *
 * # Safety
 * `corners` is null or readable for 12 doubles; `circle` and `centers` are null or writable for 7, `is_line` for one
 * int, `ratio_limits` for 2 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCenters(const double *corners,
                                      double *circle,
                                      double *centers,
                                      int *is_line,
                                      double *ratio_limits);

/**
 * Writes a center of inversion, its angle on the circle of centers and the ratio of the parallel sides that it leads
 * to. Each output may be null. `center_kind` is a `shapeop_canal_center` but `SO_CANAL_CENTER_CHORD`; `center_value`
 * and `center_point` belong to it. `is_infinite` is 1 where the center is at infinity, as no inversion is needed;
 * `center` then is zero.
 *
 * # Safety
 * `corners` is null or readable for 12 doubles, `center_point` for 3; `center` is null or writable for 3, the others
 * for one value.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalCenter(const double *corners,
                                     int center_kind,
                                     double center_value,
                                     const double *center_point,
                                     double *center,
                                     int *is_infinite,
                                     double *omega,
                                     double *ratio);

/**
 * Creates the M-revolution surface over a planar curve, of `columns` points along each arch. The curve runs from the
 * corner `P1` to `P4`; `p2` and `p3` are on one circle with its ends, and `up` is a direction off the plane, to whose
 * side the arches rise. The center is chosen as in `shapeop_canalCenter`. `omega`, its angle, and `axis`, a point and
 * a unit vector of the axis of revolution of the base, may be null. Null if it is refused.
 *
 * # Safety
 * `curve` is null or readable for `3 * nb_curve` doubles, `p2`, `p3`, `center_point` and `up` for 3; `omega` is null
 * or writable for one, `axis` for 6.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalMRevolution(const double *curve,
                                              int nb_curve,
                                              const double *p2,
                                              const double *p3,
                                              int center_kind,
                                              double center_value,
                                              const double *center_point,
                                              const double *up,
                                              int columns,
                                              double *omega,
                                              double *axis);

/**
 * As `shapeop_canalMRevolution`, over a curve on a sphere. `pole` is a point of the sphere off the curve, at which it
 * is flattened; null: one that is far from all points. Arches rise outside of the sphere if `is_outside` is 1, inside
 * if it is 0.
 *
 * # Safety
 * As `shapeop_canalMRevolution`; `sphere_center` and `pole` are null or readable for 3 doubles.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalSphericalMRevolution(const double *curve,
                                                       int nb_curve,
                                                       const double *p2,
                                                       const double *p3,
                                                       const double *sphere_center,
                                                       double radius,
                                                       const double *pole,
                                                       int is_outside,
                                                       int center_kind,
                                                       double center_value,
                                                       const double *center_point,
                                                       int columns,
                                                       double *omega,
                                                       double *axis);

/**
 * Creates the M-moulding surface through a planar curve, from `P1` to `P4`, and a rail in space, from `P1`. Column 0
 * is the curve, row 0 the rail. The center of inversion is the point `center_point` of the curve's plane if `p3` is
 * null; else it is chosen as in `shapeop_canalCenter`, or by `SO_CANAL_CENTER_CHORD`, for the far corner `p3`, which
 * is on one circle with `P1`, `P4` and the rail's end. Each output may be null: `obliquity`, `reversed_count` and
 * `closing_gap` as in `shapeop_canalMoulding`, and the distance of the surface's last corner from `p3` (0 without
 * one). Null if it is refused.
 *
 * # Safety
 * `curve` and `rail` are null or readable for 3 times their number of points, `p3` and `center_point` for 3 doubles;
 * each output is null or writable for one value.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalMMoulding(const double *curve,
                                            int nb_curve,
                                            const double *rail,
                                            int nb_rail,
                                            const double *p3,
                                            int center_kind,
                                            double center_value,
                                            const double *center_point,
                                            double *obliquity,
                                            int *reversed_count,
                                            double *closing_gap,
                                            double *corner_gap);

/**
 * Creates the C-canal surface along `guide` whose row 0 is the convex planar polyline `section`, which starts at the
 * guide's first point. The far ends of the sections are at the distances `lengths` from the guide, one for each of its
 * points, the first that of the section; or, if `lengths` is null, on a second curve, the spline through `curve`. If
 * `projects_lengths` is 1 a length that is not attainable is replaced by the nearest that is. `progress`, which may be
 * null, can cancel: the surface then ends where it was.
 *
 * Each output may be null; all have one entry for each row of the surface, of which there are at most `nb_guide`: the
 * distances made, how far each is off, the least and the greatest attainable ones, and whether a length was replaced.
 * Null if it is refused.
 *
 * # Safety
 * `guide`, `section` and `curve` are null or readable for 3 times their number of points, `lengths` for `nb_guide`
 * doubles; `out_lengths`, `deviations` and `is_projected` are null or writable for `nb_guide` values, `attainable` for
 * twice as many, `is_cancelled` for one. `progress` is null or a function of that signature.
 */
SHAPEOP_API
struct ShapeOpCanal *shapeop_canalCCanal(const double *guide,
                                         int nb_guide,
                                         const double *section,
                                         int nb_section,
                                         const double *lengths,
                                         const double *curve,
                                         int nb_curve,
                                         int is_curve_closed,
                                         int projects_lengths,
                                         shapeop_canal_progress_callback progress,
                                         void *user,
                                         double *out_lengths,
                                         double *deviations,
                                         double *attainable,
                                         int *is_projected,
                                         int *is_cancelled);

/**
 * The number of named families of super-canal surfaces, or -1.
 */
SHAPEOP_API int shapeop_canalFamilyCount(void);

/**
 * The name of the family `index`, such as `MC-canal`; null if there is none. Valid as long as the library is loaded.
 */
SHAPEOP_API const char *shapeop_canalFamilyName(int index);

/**
 * Writes how surfaces of a family are made: the `shapeop_canal_kind` of the base to `kind`, which may be null, and, if
 * there is room for `capacity` of them, the `shapeop_canal_step` of each transformation after it; `count` is their
 * number.
 *
 * # Safety
 * `name` is null or ends with a zero; `steps` is null or writable for `capacity` ints, `kind` and `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalFamilySteps(const char *name,
                                          int *kind,
                                          int *steps,
                                          int capacity,
                                          int *count);

/**
 * Measures a surface and writes what was found to `out`, whose `struct_size` must be set. It may take seconds for
 * large nets.
 *
 * # Safety
 * `out` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalProperties(struct ShapeOpCanal *surface,
                                         struct shapeop_canal_properties *out);

/**
 * Writes the node axes of a circular grid, a unit vector for each point, that are handed on by reflection from `first`
 * at point (0, 0): beams between them are planar and meet in the axes without torsion. `gaps`, which may be null, are
 * the differences between the depths along each axis down to which beams of height 1 reach.
 *
 * # Safety
 * `points` is null or readable, `axes` null or writable, for `3 * rows * columns` doubles; `first` is readable for 3,
 * `gaps` null or writable for `rows * columns`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalNodeAxes(const double *points,
                                       int rows,
                                       int columns,
                                       int wraps,
                                       const double *first,
                                       double *axes,
                                       double *gaps);

/**
 * As `shapeop_canalNodeAxes`, with the first axis for which the sum of the squared gaps is least. `progress` may be
 * null; a cancelled search gives the best so far, and `is_cancelled`, which may be null, is 1.
 *
 * # Safety
 * As `shapeop_canalNodeAxes`; `is_cancelled` is null or writable for one int, `progress` null or a function of that
 * signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalNodeAxesOfLeastGaps(const double *points,
                                                  int rows,
                                                  int columns,
                                                  int wraps,
                                                  shapeop_canal_progress_callback progress,
                                                  void *user,
                                                  double *axes,
                                                  double *gaps,
                                                  int *is_cancelled);

/**
 * Writes, for given axes, the gap at each point for beams of height 1, and the depth along each axis down to which the
 * deepest beam of `height` reaches. Each output may be null.
 *
 * # Safety
 * `points` and `axes` are null or readable for `3 * rows * columns` doubles; `gaps` and `depths` are null or writable
 * for `rows * columns`.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalNodeGaps(const double *points,
                                       int rows,
                                       int columns,
                                       int wraps,
                                       const double *axes,
                                       double height,
                                       double *gaps,
                                       double *depths);

/**
 * Writes a grid moved by `distance` along its axes. Along the normals of the frames of a circular grid all edges stay
 * parallel.
 *
 * # Safety
 * `points` and `axes` are null or readable, `out` is null or writable, for `3 * rows * columns` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalOffset(const double *points,
                                     int rows,
                                     int columns,
                                     int wraps,
                                     const double *axes,
                                     double distance,
                                     double *out);

/**
 * Writes a planar beam along every edge, `height` measured along each axis, against it: first the edges from row to
 * row, then those from column to column. `nodes` has 2 point indices for each, `corners` its 4 corners. They are
 * written if there is room for `capacity` beams; `count` is their number. `nodes` may be null.
 *
 * # Safety
 * `points` and `axes` are null or readable for `3 * rows * columns` doubles; `nodes` is null or writable for `2 *
 * capacity` ints, `corners` for `12 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalBeams(const double *points,
                                    int rows,
                                    int columns,
                                    int wraps,
                                    const double *axes,
                                    double height,
                                    int *nodes,
                                    double *corners,
                                    int capacity,
                                    int *count);

/**
 * Lays every face of a grid into a plane, with the axes at its corners. One entry for each face; each output may be
 * null: `outlines`, 4 corners with x and y, the first the origin, the second on +x; `lower_outlines`, those of the
 * lower side at `thickness` below, cut along the mitres; `mitres`, per edge the angle in radians between its cut,
 * which contains the axes, and the panel's normal; `circles` through the corners, 7 doubles, zeros where three corners
 * are on a line; `heights`, how far a corner is from the panel's plane.
 *
 * # Safety
 * `points` and `axes` are null or readable for `3 * rows * columns` doubles; for each face `outlines` and
 * `lower_outlines` are null or writable for 8 doubles, `mitres` for 4, `circles` for 7, `heights` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_canalPanels(const double *points,
                                     int rows,
                                     int columns,
                                     int wraps,
                                     const double *axes,
                                     double thickness,
                                     double *outlines,
                                     double *lower_outlines,
                                     double *mitres,
                                     double *circles,
                                     double *heights);

/**
 * The JSON form (`docs/canal-parts.schema.json`) of the panels and beams of a grid with given axes: panels with a
 * lower outline where `thickness` is above 0, beams of `height`. Null if it is refused. Valid as long as the text of
 * `shapeop_canalText`.
 *
 * # Safety
 * `points` and `axes` are null or readable for `3 * rows * columns` doubles.
 */
SHAPEOP_API
const char *shapeop_canalPartsText(const double *points,
                                   int rows,
                                   int columns,
                                   int wraps,
                                   const double *axes,
                                   double thickness,
                                   double height);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultOptions(struct shapeop_ruled_options *options);

/**
 * Creates the design of a mesh, and finds its asymptotic directions. Null if it is refused, as a mesh is that is not
 * negatively curved (`SO_CURVATURE_SIGN`) or no oriented surface. Delete it with `shapeop_ruledDelete`.
 *
 * - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points, all of which faces use.
 * - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all; quads are split along
 *   their shorter diagonal, larger faces into a fan.
 * - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
 * - `options`: null for the defaults.
 *
 * # Safety
 * Each array is null or readable for its number of values; `options` is null, or its `struct_size` is set and it is
 * readable for so many bytes.
 */
SHAPEOP_API
struct ShapeOpRuled *shapeop_ruledCreate(const double *points,
                                         int nb_points,
                                         const int *face_indices,
                                         int nb_face_indices,
                                         const int *counts,
                                         int nb_counts,
                                         const struct shapeop_ruled_options *options);

/**
 * Creates a copy of a design, with all that was made of it; null if it is refused.
 */
SHAPEOP_API struct ShapeOpRuled *shapeop_ruledCopy(struct ShapeOpRuled *design);

/**
 * Deletes a design. Null does nothing; a busy design is left alone, as is whatever is no design.
 */
SHAPEOP_API void shapeop_ruledDelete(struct ShapeOpRuled *design);

/**
 * Takes the directions of a family, 0 or 1, that point along `hint` on the whole (null: along x). With `allow_cut` 1
 * their signs may disagree across some edges if they must (`shapeop_ruledFlips`); otherwise a mesh around which no
 * signs agree is refused (`SO_NOT_ORIENTABLE`). Takes back boundaries and strips.
 *
 * # Safety
 * `hint` is null or readable for 3 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSelectFamily(struct ShapeOpRuled *design,
                                           int family,
                                           const double *hint,
                                           int allow_cut);

/**
 * Writes the triangles of a design's mesh, three points each, if there is room for `capacity` of them, and their
 * number to `count`.
 *
 * # Safety
 * `triangles` is null or writable for `3 * capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledTriangles(struct ShapeOpRuled *design,
                                        int *triangles,
                                        int capacity,
                                        int *count);

/**
 * Writes the curvature at each point of a design's mesh if there is room for `capacity` points, and their number to
 * `count`: `principal`, two curvatures in 1/model units, the greater first, positive where the surface bends towards
 * the normal; `directions`, their unit directions; `normals`, of higher order than those of triangles. Each output but
 * `count` may be null.
 *
 * # Safety
 * `principal` is null or writable for `2 * capacity` doubles, `directions` for `6 * capacity`, `normals` for
 * `3 * capacity`, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledCurvatures(struct ShapeOpRuled *design,
                                         double *principal,
                                         double *directions,
                                         double *normals,
                                         int capacity,
                                         int *count);

/**
 * Writes the asymptotic directions of a family, 0 or 1, at the points of a design's mesh if there is room for
 * `capacity` points, and their number to `count`: `directions`, unit vectors with any sign, 0 where there are none;
 * `status`, a `shapeop_ruled_point` each. Each output but `count` may be null.
 *
 * # Safety
 * `directions` is null or writable for `3 * capacity` doubles, `status` for `capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledDirections(struct ShapeOpRuled *design,
                                         int family,
                                         double *directions,
                                         int *status,
                                         int capacity,
                                         int *count);

/**
 * Writes the field that rulings follow, the directions of the family selected with signs that agree, as
 * `shapeop_ruledDirections` does; `is_known` is 0 where there is no direction.
 *
 * # Safety
 * `directions` is null or writable for `3 * capacity` doubles, `is_known` for `capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledField(struct ShapeOpRuled *design,
                                    double *directions,
                                    int *is_known,
                                    int capacity,
                                    int *count);

/**
 * Writes the edges, two points each, across which the field changes its sign, if there is room for `capacity` of them,
 * and their number to `count`.
 *
 * # Safety
 * `edges` is null or writable for `2 * capacity` ints, `count` for one.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledFlips(struct ShapeOpRuled *design, int *edges, int capacity, int *count);

/**
 * Follows the asymptotic curve of the field from the point of the mesh nearest to `seed`, along the field or, with
 * `is_backward` 1, against it, for `length` model units at most. A step is `step` edges long, above 0 and at most 0.5.
 * Writes its points, the start first, if there is room for `capacity` of them, their number to `count`, and to `end`,
 * which may be null, why it ends there (a `shapeop_ruled_end`).
 *
 * # Safety
 * `seed` is null or readable for 3 doubles; `points` is null or writable for `3 * capacity` doubles, `count` and `end`
 * for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledTrace(struct ShapeOpRuled *design,
                                    const double *seed,
                                    int is_backward,
                                    double step,
                                    double length,
                                    double *points,
                                    int capacity,
                                    int *count,
                                    int *end);

/**
 * Writes the default options for boundaries of a kind (a `shapeop_ruled_levels`) to `options`, whose `struct_size`
 * must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultLevelOptions(int kind, struct shapeop_ruled_level_options *options);

/**
 * Finds a function that rises along the field and takes level curves of it as strip boundaries, in the order along the
 * field. Which levels, exactly one of three says: `count`, so many, evenly spaced; `width`, as many as fit at this
 * distance, in model units; `values`, these, ascending, `nb_values` of them. The others are 0 or null. On a surface
 * with holes, around which the function jumps by a multiple of the levels' distance, values cannot be given.
 *
 * `options` and `boundaries` are null for the defaults. `progress` may be null; it is called before every iteration,
 * and what ends the call leaves the best so far. Takes back boundaries and strips.
 *
 * # Safety
 * `values` is null or readable for `nb_values` doubles. `options` and `boundaries` are null, or their `struct_size` is
 * set and they are readable for so many bytes. `progress` is null or a function of that signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetLevelBoundaries(struct ShapeOpRuled *design,
                                                 const struct shapeop_ruled_level_options *options,
                                                 int count,
                                                 double width,
                                                 const double *values,
                                                 int nb_values,
                                                 const struct shapeop_ruled_boundary_options *boundaries,
                                                 shapeop_ruled_progress_callback progress,
                                                 void *user);

/**
 * As `shapeop_ruledSetLevelBoundaries`, with other levels of the function that was found before; not on a surface with
 * holes.
 *
 * # Safety
 * `values` is null or readable for `nb_values` doubles. `boundaries` is null, or its `struct_size` is set and it is
 * readable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetLevels(struct ShapeOpRuled *design,
                                        int count,
                                        double width,
                                        const double *values,
                                        int nb_values,
                                        const struct shapeop_ruled_boundary_options *boundaries);

/**
 * Writes the values of the level function at the points of the mesh, in model units, the least 0, if there is room for
 * `capacity` of them, and their number to `count`.
 *
 * # Safety
 * `values` is null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledLevelValues(struct ShapeOpRuled *design,
                                          double *values,
                                          int capacity,
                                          int *count);

/**
 * Writes the sum of the terms of the level function at the start and after each iteration, if there is room for
 * `capacity` of them, and their number to `count`; none if a linear problem was all there was.
 *
 * # Safety
 * `values` is null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledLevelHistory(struct ShapeOpRuled *design,
                                           double *values,
                                           int capacity,
                                           int *count);

/**
 * Writes the points around which the level function does not rise on one side and fall on the other, if there is room
 * for `capacity` of them, and their number to `count`.
 *
 * # Safety
 * `points` is null or writable for `capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledCriticalPoints(struct ShapeOpRuled *design,
                                             int *points,
                                             int capacity,
                                             int *count);

/**
 * Writes what was found of the level function to `report`, whose `struct_size` must be set.
 *
 * # Safety
 * `report` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledLevelReport(struct ShapeOpRuled *design,
                                          struct shapeop_ruled_level_report *report);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultBoundaryOptions(struct shapeop_ruled_boundary_options *options);

/**
 * Takes plane sections as strip boundaries: for each plane the longest. `planes` has four numbers for each of
 * `nb_planes`, the normal and the offset of `normal . x = offset`; they follow each other along the field, or against
 * it. Sections should cross the field at `least_angle` or more, in radians (15 degrees are good): with
 * `refuses_oblique` 1 those that do not are refused (`SO_INFEASIBLE`). The least angle of each is written to `angles`,
 * which may be null. `boundaries` is null for the defaults. Takes back boundaries and strips.
 *
 * # Safety
 * `planes` is null or readable for `4 * nb_planes` doubles, `angles` is null or writable for `nb_planes`. `boundaries`
 * is null, or its `struct_size` is set and it is readable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetPlanarBoundaries(struct ShapeOpRuled *design,
                                                  const double *planes,
                                                  int nb_planes,
                                                  double least_angle,
                                                  int refuses_oblique,
                                                  const struct shapeop_ruled_boundary_options *boundaries,
                                                  double *angles);

/**
 * Takes the curves as strip boundaries along which the field is orthogonal to one of `nb_axes` vectors each, of any
 * length above 0: rulings that begin there are parallel to a plane. They follow each other along the field, or against
 * it. `boundaries` is null for the defaults. Takes back boundaries and strips.
 *
 * # Safety
 * `axes` is null or readable for `3 * nb_axes` doubles. `boundaries` is null, or its `struct_size` is set and it is
 * readable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetGreatCircleBoundaries(struct ShapeOpRuled *design,
                                                       const double *axes,
                                                       int nb_axes,
                                                       const struct shapeop_ruled_boundary_options *boundaries);

/**
 * Writes the curves on the mesh along which the field is orthogonal to `axis`, of any length above 0: the points of
 * all behind each other if there is room for `capacity` of them, and the number of points of each to `lengths` if
 * there is room for `curve_capacity` of them; a closed one has its first point again at its end. `count` and
 * `curve_count` tell how many there are.
 *
 * # Safety
 * `axis` is null or readable for 3 doubles; `points` is null or writable for `3 * capacity` doubles, `lengths` for
 * `curve_capacity` ints, `count` and `curve_count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledGreatCircle(struct ShapeOpRuled *design,
                                          const double *axis,
                                          double *points,
                                          int capacity,
                                          int *count,
                                          int *lengths,
                                          int curve_capacity,
                                          int *curve_count);

/**
 * Takes curves drawn by hand as strip boundaries, in their order along the field. Their points are moved to the
 * nearest of the mesh, and curves are turned around if need be.
 *
 * - `points`: the points of all curves behind each other, `nb_points` in all.
 * - `counts`: the number of points of each curve, `nb_counts` in all.
 * - `is_closed`: 1 for each curve whose last point is followed by its first, else 0; null if none is.
 * - `boundaries`: null for the defaults.
 *
 * Takes back boundaries and strips.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles, `counts` and `is_closed` for `nb_counts` ints.
 * `boundaries` is null, or its `struct_size` is set and it is readable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetDrawnBoundaries(struct ShapeOpRuled *design,
                                                 const double *points,
                                                 int nb_points,
                                                 const int *counts,
                                                 int nb_counts,
                                                 const int *is_closed,
                                                 const struct shapeop_ruled_boundary_options *boundaries);

/**
 * The number of strip boundaries, or -1.
 */
SHAPEOP_API int shapeop_ruledBoundaryCount(struct ShapeOpRuled *design);

/**
 * Writes the points of a boundary if there is room for `capacity` of them, and their number to `count`; to `is_closed`
 * 1 if the last point is followed by the first, and to `level` the value of the level function, or the number of the
 * plane, the axis or the curve. The last two may be null.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` and `is_closed` for one int, `level` for one
 * double.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledBoundary(struct ShapeOpRuled *design,
                                       int boundary,
                                       double *points,
                                       int capacity,
                                       int *count,
                                       int *is_closed,
                                       double *level);

/**
 * Writes the unit vector that the field along a boundary is most nearly orthogonal to (`axis`), and the root mean
 * square of the sine by which it is off (`error`): 0 where rulings that begin on the boundary are parallel to a plane.
 * Either may be null.
 *
 * # Safety
 * `axis` is null or writable for 3 doubles, `error` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledBoundaryAxis(struct ShapeOpRuled *design,
                                           int boundary,
                                           double *axis,
                                           double *error);

/**
 * Writes the two boundaries of each strip, before there are strips too, if there is room for `capacity` pairs, and
 * their number to `count`.
 *
 * # Safety
 * `pairs` is null or writable for `2 * capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledBoundaryPairs(struct ShapeOpRuled *design,
                                            int *pairs,
                                            int capacity,
                                            int *count);

/**
 * Writes the levels between which and the next one curves split, join or end, so that no strip is there, if there is
 * room for `capacity` of them, and their number to `count`.
 *
 * # Safety
 * `levels` is null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledUnmatchedLevels(struct ShapeOpRuled *design,
                                              double *levels,
                                              int capacity,
                                              int *count);

/**
 * Writes the curves that were too short to be boundaries if there is room for `capacity` of them, and their number to
 * `count`: the level of each and its length, in model units. Either may be null.
 *
 * # Safety
 * `levels` and `lengths` are null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledDroppedCurves(struct ShapeOpRuled *design,
                                            double *levels,
                                            double *lengths,
                                            int capacity,
                                            int *count);

/**
 * Makes a strip between each pair of boundaries, with rulings along asymptotic curves. A strip has `control_count`
 * control points on each boundary, at least 4 (12 are good). With `is_shared` 1 neighbours have their common boundary
 * as one, so that nothing can gape. Takes back strips and conditions.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledStart(struct ShapeOpRuled *design, int control_count, int is_shared);

/**
 * Writes, for each strip that was started, how many of its rulings did not meet the second boundary and went to its
 * nearest point (`missed`), and how many ended before those before them and were moved (`moved`), if there is room for
 * `capacity` strips, and their number to `count`. Each output but `count` may be null.
 *
 * # Safety
 * `missed` and `moved` are null or writable for `capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledStarted(struct ShapeOpRuled *design,
                                      int *missed,
                                      int *moved,
                                      int capacity,
                                      int *count);

/**
 * The number of strips, or -1.
 */
SHAPEOP_API int shapeop_ruledStripCount(struct ShapeOpRuled *design);

/**
 * Writes the pairs of strips that are neighbours, the second boundary of one being the first of the other, if there is
 * room for `capacity` pairs, and their number to `count`; to `is_shared`, which may be null, 1 if neighbours have
 * their common boundary as one.
 *
 * # Safety
 * `pairs` is null or writable for `2 * capacity` ints, `count` and `is_shared` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledJoints(struct ShapeOpRuled *design,
                                     int *pairs,
                                     int capacity,
                                     int *count,
                                     int *is_shared);

/**
 * Writes the control points of a strip, those of its first boundary, then those of its second, if there is room for
 * `capacity` of each, and the number of each to `count`; to `is_closed`, which may be null, 1 if its boundaries are
 * closed. The strip is the B-spline surface of degree 3 along its boundaries, with the knots of `shapeop_ruledKnots`,
 * and degree 1 along its rulings; of a closed one the first three control points of each boundary follow the last.
 *
 * # Safety
 * `control` is null or writable for `6 * capacity` doubles, `count` and `is_closed` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledControl(struct ShapeOpRuled *design,
                                      int strip,
                                      double *control,
                                      int capacity,
                                      int *count,
                                      int *is_closed);

/**
 * Writes the knots along the boundaries of a strip if there is room for `capacity` of them, and their number to
 * `count`: all of distance 1, those at both ends of an open strip four times. The parameter `u` goes from the fourth,
 * 0, to the fourth from the end.
 *
 * # Safety
 * `knots` is null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledKnots(struct ShapeOpRuled *design,
                                    int strip,
                                    double *knots,
                                    int capacity,
                                    int *count);

/**
 * Moves the control points of a strip, given as by `shapeop_ruledControl`; `count` is the number of each boundary's,
 * which stays. Boundaries that neighbours share move with it. Conditions stay.
 *
 * # Safety
 * `control` is null or readable for `6 * count` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledSetControl(struct ShapeOpRuled *design,
                                         int strip,
                                         const double *control,
                                         int count);

/**
 * Takes the strips that a text in JSON states (`shapeop_ruledStripsText`). Where they are as many as before, and open
 * or closed as those, neighbours and conditions stay; otherwise each joins the next.
 *
 * # Safety
 * `json` is null or ends with a zero.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledSetStripsText(struct ShapeOpRuled *design, const char *json);

/**
 * The JSON form of the strips (`docs/ruled.schema.json`): degrees, knots and control points; null if it is refused.
 * The text is the calling thread's own, valid until that thread's next call of a `shapeop_ruled...` function that
 * answers with a text.
 */
SHAPEOP_API const char *shapeop_ruledStripsText(struct ShapeOpRuled *design);

/**
 * Writes the point of a strip at `u`, from 0 to the last parameter of its boundaries, and `v`, 0 on its first boundary
 * to 1 on its second; the derivatives there by `u` and by `v`, 6 doubles; and the unit normal, their cross product
 * made 1 long, or 0 where they are parallel. Each output may be null.
 *
 * # Safety
 * `point` and `normal` are null or writable for 3 doubles, `derivatives` for 6.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledEvaluate(struct ShapeOpRuled *design,
                                       int strip,
                                       double u,
                                       double v,
                                       double *point,
                                       double *derivatives,
                                       double *normal);

/**
 * Adds the condition that a boundary is in a plane, of both strips beside it. `plane` has four numbers, the normal, of
 * any length above 0, and the offset of `normal . x = offset`; null for the plane that the boundary was cut by.
 *
 * A condition of the same kind for the same place is replaced. Conditions hold exactly after `shapeop_ruledOptimise`,
 * which refuses those that contradict each other (`SO_INFEASIBLE`).
 *
 * # Safety
 * `plane` is null or readable for 4 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledConstrainPlane(struct ShapeOpRuled *design,
                                             int boundary,
                                             const double *plane);

/**
 * Adds the conditions that all boundaries are in the planes that they were cut by; refused if none was
 * (`SO_NOT_INITIALISED`).
 */
SHAPEOP_API enum shapeop_err shapeop_ruledConstrainCutPlanes(struct ShapeOpRuled *design);

/**
 * Adds the condition that an end of a boundary is at a point: of the first (`side` 0) or second (1) boundary of an
 * open strip its start (`end` 0) or finish (1). `point` is null for where it is now.
 *
 * # Safety
 * `point` is null or readable for 3 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledConstrainPoint(struct ShapeOpRuled *design,
                                             int strip,
                                             int side,
                                             int end,
                                             const double *point);

/**
 * Adds the conditions that all ends of the boundaries of open strips stay where they are.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledConstrainEnds(struct ShapeOpRuled *design);

/**
 * Adds the condition that the ruling at the start (`end` 0) or finish (1) of an open strip is parallel to `direction`,
 * of any length above 0; null for the one that it has now.
 *
 * # Safety
 * `direction` is null or readable for 3 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledConstrainEndDirection(struct ShapeOpRuled *design,
                                                    int strip,
                                                    int end,
                                                    const double *direction);

/**
 * Adds the condition that a strip is a conoid: that all its rulings are orthogonal to `axis`, of any length above 0;
 * null for the axis that its rulings are most nearly orthogonal to now.
 *
 * # Safety
 * `axis` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledConstrainConoid(struct ShapeOpRuled *design, int strip, const double *axis);

/**
 * The number of conditions, or -1. A message about `conditions[k]` means the k-th that was added, from 0, of those
 * that are left.
 */
SHAPEOP_API int shapeop_ruledConditionCount(struct ShapeOpRuled *design);

/**
 * Takes all conditions away.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledClearConditions(struct ShapeOpRuled *design);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultOptimiseOptions(struct shapeop_ruled_optimise_options *options);

/**
 * Brings the strips as near as they come to the mesh and to each other, under the conditions, which hold exactly
 * afterwards. Conditions that contradict each other are refused (`SO_INFEASIBLE`): `conditions[k]` is the first that
 * contradicts those before it.
 *
 * `options` is null for the defaults. `progress` may be null; what ends the call leaves the best so far. `report` is
 * null, or its `struct_size` is set.
 *
 * # Safety
 * `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
 * `progress` is null or a function of that signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledOptimise(struct ShapeOpRuled *design,
                                       const struct shapeop_ruled_optimise_options *options,
                                       shapeop_ruled_progress_callback progress,
                                       void *user,
                                       struct shapeop_ruled_optimise_report *report);

/**
 * Writes the start and each iteration of the last optimisation, 10 numbers each, if there is room for `capacity` of
 * them, and their number to `count`: the value; its terms of proximity, gap, coverage and way; the excess over bounds,
 * in model units; the part of the step that was taken; how far a control point moved at most; the largest deviation
 * and the largest gap, in model units. Refused if strips changed since (`SO_NOT_INITIALISED`).
 *
 * # Safety
 * `rows` is null or writable for `10 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledHistory(struct ShapeOpRuled *design, double *rows, int capacity, int *count);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultReportOptions(struct shapeop_ruled_report_options *options);

/**
 * Measures the strips against the mesh and each other: writes to `report`, whose `struct_size` must be set, what there
 * is to say of all, and keeps the rest for `shapeop_ruledStripReport`, `shapeop_ruledJointReport` and
 * `shapeop_ruledReportText`. `options` is null for the defaults.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is readable for so many bytes; `report` is null, or its
 * `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledReport(struct ShapeOpRuled *design,
                                     const struct shapeop_ruled_report_options *options,
                                     struct shapeop_ruled_report *report);

/**
 * Writes what the last report says of a strip to `report`, whose `struct_size` must be set. Refused if strips changed
 * since (`SO_NOT_INITIALISED`).
 *
 * # Safety
 * `report` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledStripReport(struct ShapeOpRuled *design,
                                          int strip,
                                          struct shapeop_ruled_strip_report *report);

/**
 * Writes what the last report says of a pair of neighbours, numbered as by `shapeop_ruledJoints`, to `report`, whose
 * `struct_size` must be set. Refused if strips changed since (`SO_NOT_INITIALISED`).
 *
 * # Safety
 * `report` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledJointReport(struct ShapeOpRuled *design,
                                          int joint,
                                          struct shapeop_ruled_joint_report *report);

/**
 * Writes the strips that the last report calls too wide for the features of the mesh if there is room for `capacity`
 * of them, and their number to `count`.
 *
 * # Safety
 * `strips` is null or writable for `capacity` ints, `count` for one.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledTooWide(struct ShapeOpRuled *design, int *strips, int capacity, int *count);

/**
 * The JSON form of the last report (`docs/ruled-report.schema.json`), in which angles are in degrees; null if it is
 * refused. The text is valid as long
 * as that of `shapeop_ruledStripsText`.
 */
SHAPEOP_API const char *shapeop_ruledReportText(struct ShapeOpRuled *design);

/**
 * Writes strips as a mesh of quads whose edges across are rulings: the strip `strip`, or all (`SHAPEOP_RULED_ALL`),
 * with `columns_per_span` columns in each span and `rows` rows of points, 2 or more. Points are written if there is
 * room for `capacity` of them, and their number to `count`; faces, four points each, if there is room for
 * `face_capacity` of them, and their number to `face_count`. `normals`, the unit normals at the points, and
 * `strip_of`, the strip of each face, may be null. Strips share no points.
 *
 * # Safety
 * `points` and `normals` are null or writable for `3 * capacity` doubles, `faces` for `4 * face_capacity` ints,
 * `strip_of` for `face_capacity`, `count` and `face_count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledMesh(struct ShapeOpRuled *design,
                                   int strip,
                                   int columns_per_span,
                                   int rows,
                                   double *points,
                                   double *normals,
                                   int capacity,
                                   int *count,
                                   int *faces,
                                   int *strip_of,
                                   int face_capacity,
                                   int *face_count);

/**
 * As `shapeop_ruledMesh`, for what is left of strips within the boundary of the design's mesh, as triangles:
 * `columns_per_span` columns in each span, whose edges across are rulings; `faces` has three points each. The line
 * along which strips are cut is at most `tolerance` times the mesh's diagonal, above 0 and at most 0.01, from its
 * boundary. What was trimmed is kept until strips change, so that asking for the numbers first costs little.
 *
 * # Safety
 * `points` and `normals` are null or writable for `3 * capacity` doubles, `faces` for `3 * face_capacity` ints,
 * `strip_of` for `face_capacity`, `count` and `face_count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledTrimmedMesh(struct ShapeOpRuled *design,
                                          int strip,
                                          int columns_per_span,
                                          double tolerance,
                                          double *points,
                                          double *normals,
                                          int capacity,
                                          int *count,
                                          int *faces,
                                          int *strip_of,
                                          int face_capacity,
                                          int *face_count);

/**
 * Writes rulings of a strip or of all (`SHAPEOP_RULED_ALL`), `rulings` of each, evenly spread over its parameter; with
 * `is_trimmed` 1 what is left of them within the boundary of the design's mesh: several pieces of one ruling, or none.
 * For each piece `ends` has its two points, from the first boundary to the second, `parameters` its parameter `u` and
 * `strip_of` its strip, if there is room for `capacity` pieces; `count` is their number. Each output but `count` may
 * be null.
 *
 * # Safety
 * `ends` is null or writable for `6 * capacity` doubles, `parameters` for `capacity`, `strip_of` for `capacity` ints,
 * `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledRulings(struct ShapeOpRuled *design,
                                      int strip,
                                      int rulings,
                                      int is_trimmed,
                                      double *ends,
                                      double *parameters,
                                      int *strip_of,
                                      int capacity,
                                      int *count);

/**
 * The strips as B-spline surfaces of a Wavefront OBJ file, which CAD programs read; null if it is refused. The text is
 * valid as long as that of `shapeop_ruledStripsText`.
 */
SHAPEOP_API const char *shapeop_ruledSurfacesObj(struct ShapeOpRuled *design);

/**
 * Trimmed rulings, `rulings` of each strip, as lines of a Wavefront OBJ file; null if it is refused. The text is valid
 * as long as that of `shapeop_ruledStripsText`.
 */
SHAPEOP_API const char *shapeop_ruledRulingsObj(struct ShapeOpRuled *design, int rulings);

/**
 * Trimmed rulings, `rulings` of each strip, as a table of comma-separated values, with their ends and lengths; null if
 * it is refused. The text is valid as long as that of `shapeop_ruledStripsText`.
 */
SHAPEOP_API const char *shapeop_ruledRulingsCsv(struct ShapeOpRuled *design, int rulings);

/**
 * Writes what zebra stripes show at points of any surface, from -1, the middle of a dark stripe, to 1, the middle of a
 * light one: reflections of light tubes along `direction`, `nb_stripes` of them around a full turn, turned about it by
 * `turn` radians. `eye` is a point, or, with `is_parallel` 1, the direction in which all eyes look. Where normals are
 * continuous, so are stripes; where a surface has a kink they break off.
 *
 * # Safety
 * `points` and `normals` are null or readable for `3 * nb_points` doubles, `eye` and `direction` for 3; `out` is null
 * or writable for `nb_points` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledZebra(const double *points,
                                    const double *normals,
                                    int nb_points,
                                    const double *eye,
                                    int is_parallel,
                                    const double *direction,
                                    int nb_stripes,
                                    double turn,
                                    double *out);

/**
 * Writes the default options to `options`, whose `struct_size` must be set; the thickness is 0, and must be set too.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_ruledDefaultPlankOptions(struct shapeop_ruled_plank_options *options);

/**
 * Writes the unit vector that is most nearly orthogonal to all rulings of a strip, so that the strip rises along it,
 * and the greatest angle of a control ruling to the plane across it, in radians: 0 of a conoidal strip. Either may be
 * null.
 *
 * # Safety
 * `axis` is null or writable for 3 doubles, `deviation` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledStripAxis(struct ShapeOpRuled *design,
                                        int strip,
                                        double *axis,
                                        double *deviation);

/**
 * Cuts a conoidal strip into planks of constant thickness across `axis`, of any length above 0; null for its own.
 * Writes to `planks`, whose `struct_size` must be set, what there is to say of all, and keeps the rest for
 * `shapeop_ruledPlank`, `shapeop_ruledDowels`, `shapeop_ruledPlanksText` and `shapeop_ruledPlanksSvg`. A strip that is
 * not conoidal is refused (`SO_NOT_PLANAR`), as is one that folds back along the axis (`SO_DEGENERATE`).
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is readable for so many bytes; `axis` is null or readable for
 * 3 doubles; `planks` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledCutPlanks(struct ShapeOpRuled *design,
                                        int strip,
                                        const struct shapeop_ruled_plank_options *options,
                                        const double *axis,
                                        struct shapeop_ruled_planks *planks);

/**
 * Writes one of the planks that were cut last to `plank`, whose `struct_size` must be set. Refused if strips changed
 * since (`SO_NOT_INITIALISED`). The other outputs may be null:
 *
 * - `frame`: a point of its lower face, the unit vector along the plank, from the strip's first boundary to its
 *   second, and the unit vector across it, 9 doubles. Flat coordinates are along these from the point.
 * - `outline`: the four corners in flat coordinates, counterclockwise seen against the axis, 8 doubles.
 * - `rulings`: the ends of the ruling in the lower face, then of that in the upper, in flat coordinates, 8 doubles.
 *
 * # Safety
 * `plank` is null, or its `struct_size` is set and it is writable for so many bytes; `frame` is null or writable for 9
 * doubles, `outline` and `rulings` for 8.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledPlank(struct ShapeOpRuled *design,
                                    int index,
                                    struct shapeop_ruled_plank *plank,
                                    double *frame,
                                    double *outline,
                                    double *rulings);

/**
 * Writes the points of the strip's first (`side` 0) or second (1) boundary at the cuts between the planks that were
 * cut last, ends included, if there is room for `capacity` of them, and their number to `count`: dowels lie along
 * these.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_ruledDowels(struct ShapeOpRuled *design,
                                     int side,
                                     double *points,
                                     int capacity,
                                     int *count);

/**
 * The JSON form of the planks that were cut last (`docs/ruled-planks.schema.json`), in which angles are in degrees;
 * null if it is refused. The text is valid as long as that of `shapeop_ruledStripsText`.
 */
SHAPEOP_API const char *shapeop_ruledPlanksText(struct ShapeOpRuled *design);

/**
 * The planks that were cut last, drawn in true scale as SVG, with their numbers, sizes and angles: `name` stands above
 * them, `millimetres` are in a model unit. Null if it is refused. The text is valid as long as that of
 * `shapeop_ruledStripsText`.
 *
 * # Safety
 * `name` is null or ends with a zero.
 */
SHAPEOP_API const char *shapeop_ruledPlanksSvg(struct ShapeOpRuled *design, const char *name, double millimetres);

/**
 * Creates the snake with these control points, `nb_control` of them, open or, with `is_closed` 1, closed; null if it is
 * refused. The arcs follow from them: around a closed snake of an even number of arcs there are none or many, of which
 * `first_tangent` chooses, the distance from the first control point to both ends of its arc; otherwise it is 0. Delete
 * the snake with `shapeop_snakeDelete`.
 *
 * # Safety
 * `control` is null or readable for `3 * nb_control` doubles.
 */
SHAPEOP_API
struct ShapeOpSnake *shapeop_snakeCreate(const double *control,
                                         int nb_control,
                                         int is_closed,
                                         double first_tangent);

/**
 * Creates the open snake of arcs of these radii and lengths, `nb_arcs` of each, in model units; null if it is refused.
 * `torsions[j]` is by how much the plane turns from arc `j` to the next, in radians, counterclockwise about the tangent;
 * there is one fewer of them. The snake begins at `point` along `tangent`, and its first arc bends towards `normal`.
 *
 * # Safety
 * `radii` and `lengths` are null or readable for `nb_arcs` doubles, `torsions` for `nb_torsions`, the vectors for 3.
 */
SHAPEOP_API
struct ShapeOpSnake *shapeop_snakeCreateFromArcs(const double *radii,
                                                 const double *lengths,
                                                 int nb_arcs,
                                                 const double *torsions,
                                                 int nb_torsions,
                                                 const double *point,
                                                 const double *tangent,
                                                 const double *normal);

/**
 * Creates a copy of a snake, with all that belongs to it; null if it is refused.
 */
SHAPEOP_API struct ShapeOpSnake *shapeop_snakeCopy(struct ShapeOpSnake *snake);

/**
 * Deletes a snake. Null does nothing; a busy snake is left alone, as is whatever is no snake.
 */
SHAPEOP_API void shapeop_snakeDelete(struct ShapeOpSnake *snake);

/**
 * Writes what a snake is like to `report`, whose `struct_size` must be set.
 *
 * # Safety
 * `report` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeReport(struct ShapeOpSnake *snake, struct shapeop_snake_report *report);

/**
 * Writes the control points if there is room for `capacity` of them, and their number to `count`.
 *
 * # Safety
 * `control` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeControl(struct ShapeOpSnake *snake,
                                      double *control,
                                      int capacity,
                                      int *count);

/**
 * Puts the control points elsewhere, as many as there are; they need not keep the distances, see `shapeop_snakeProject`.
 * What was found of the snake's motion is forgotten.
 *
 * # Safety
 * `control` is null or readable for `3 * nb_control` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeSetControl(struct ShapeOpSnake *snake,
                                         const double *control,
                                         int nb_control);

/**
 * Writes the contact points if there is room for `capacity` of them, and their number to `count`.
 *
 * # Safety
 * `contacts` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeContacts(struct ShapeOpSnake *snake,
                                       double *contacts,
                                       int capacity,
                                       int *count);

/**
 * Writes the radii and lengths of the arcs, in model units, if there is room for `capacity` of them, and their number to
 * `count`. Each output but `count` may be null.
 *
 * # Safety
 * `radii` and `lengths` are null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeShapes(struct ShapeOpSnake *snake,
                                     double *radii,
                                     double *lengths,
                                     int capacity,
                                     int *count);

/**
 * Writes the angles by which the plane turns from each arc to the next, in radians, counterclockwise about the tangent,
 * of a closed snake also from the last to the first, if there is room for `capacity` of them, and their number to
 * `count`.
 *
 * # Safety
 * `torsions` is null or writable for `capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeTorsions(struct ShapeOpSnake *snake,
                                       double *torsions,
                                       int capacity,
                                       int *count);

/**
 * Writes the arcs of the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), 11 numbers each, if there is room for
 * `capacity` of them, and their number to `count`: the centre, the radius, the unit vector along the axis, about which
 * the arc turns counterclockwise, the point where it starts, the angle in radians.
 *
 * # Safety
 * `arcs` is null or writable for `11 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeArcs(struct ShapeOpSnake *snake,
                                   int frame,
                                   double *arcs,
                                   int capacity,
                                   int *count);

/**
 * Writes points along the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), `per_arc` intervals in each arc, if there
 * is room for `capacity` of them, and their number to `count`; the first point of a closed snake is not repeated.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeSample(struct ShapeOpSnake *snake,
                                     int frame,
                                     int per_arc,
                                     double *points,
                                     int capacity,
                                     int *count);

/**
 * Writes to `free` in how many ways the snake can move to first order, rigid motions among them, in space or, with
 * `on_surface` 1, where its control points move along its surface; to `conditions` and `rank` how many conditions there
 * are, and how many of them are independent. Each output may be null.
 *
 * # Safety
 * Each output is null or writable for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeFreedoms(struct ShapeOpSnake *snake,
                                       int on_surface,
                                       int *free,
                                       int *conditions,
                                       int *rank);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDefaultFitOptions(struct shapeop_snake_fit_options *options);

/**
 * Creates the snake of `nb_arcs` arcs of equal length along a polyline of `nb_points` points, open or, with `is_closed`
 * 1, closed; null if it is refused. Lengths and curvatures are those of the circles through three points in a row. Arcs
 * around a closed one are about of equal length and as curved as it is; of the options `is_congruent` and `curvature` do
 * not count then.
 * `options` is null for the defaults; `report` is null, or its `struct_size` is set.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles; `options` and `report` are null, or their `struct_size` is
 * set and they are readable or writable for so many bytes.
 */
SHAPEOP_API
struct ShapeOpSnake *shapeop_snakeFit(const double *points,
                                      int nb_points,
                                      int is_closed,
                                      int nb_arcs,
                                      const struct shapeop_snake_fit_options *options,
                                      struct shapeop_snake_fit_report *report);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDefaultCurveOptions(struct shapeop_snake_curve_options *options);

/**
 * Finds the curve of given curvature on a surface of a kind (a `shapeop_snake_surface`) that begins at the nearest point
 * to `start` in the direction of `tangent`. `curvatures`, `nb_curvatures` of 0 or more, in 1/model units, are those at
 * evenly spaced places along the length, linear in between; one is that of the whole curve. From a point there is one
 * curve that turns left and one that turns right as long as the surface itself bends less than the curve along it;
 * otherwise none (`SO_NO_SOLUTION` at the start; later the curve ends there).
 *
 * Writes its points, one for each step and the start, at most 2 more than steps, if there is room for `capacity` of
 * them, and their number to `count`; to `report`, which is null or has its `struct_size` set, what was found. `options`
 * is null for the defaults.
 *
 * # Safety
 * `numbers`, `curvatures` and the vectors are null or readable for `nb_numbers`, `nb_curvatures` and 3 doubles;
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int. `options` and `report` are null, or
 * their `struct_size` is set and they are readable or writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCurve(int kind,
                                    const double *numbers,
                                    int nb_numbers,
                                    const double *start,
                                    const double *tangent,
                                    const double *curvatures,
                                    int nb_curvatures,
                                    double length,
                                    const struct shapeop_snake_curve_options *options,
                                    double *points,
                                    int capacity,
                                    int *count,
                                    struct shapeop_snake_curve_report *report);

/**
 * As `shapeop_snakeCurve`, on a mesh as `shapeop_snakeSetMesh` takes it; `start` is nearer to it than its edges are
 * long.
 *
 * # Safety
 * As of both.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeMeshCurve(const double *mesh_points,
                                        int nb_mesh_points,
                                        const int *face_indices,
                                        int nb_face_indices,
                                        const int *counts,
                                        int nb_counts,
                                        const double *start,
                                        const double *tangent,
                                        const double *curvatures,
                                        int nb_curvatures,
                                        double length,
                                        const struct shapeop_snake_curve_options *options,
                                        double *points,
                                        int capacity,
                                        int *count,
                                        struct shapeop_snake_curve_report *report);

/**
 * Takes a mesh as the surface of a snake. The snake stays where it is.
 *
 * - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points, all of which faces use.
 * - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all; quads are split along
 *   their shorter diagonal, larger faces into a fan.
 * - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
 *
 * # Safety
 * Each array is null or readable for its number of values.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeSetMesh(struct ShapeOpSnake *snake,
                                      const double *points,
                                      int nb_points,
                                      const int *face_indices,
                                      int nb_face_indices,
                                      const int *counts,
                                      int nb_counts);

/**
 * Takes a surface of a kind (a `shapeop_snake_surface`) that `nb_numbers` numbers tell as that of a snake.
 *
 * # Safety
 * `numbers` is null or readable for `nb_numbers` doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeSetSurface(struct ShapeOpSnake *snake,
                                         int kind,
                                         const double *numbers,
                                         int nb_numbers);

/**
 * Takes the surface of a snake away.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeClearSurface(struct ShapeOpSnake *snake);

/**
 * Takes the direction (a `shapeop_snake_direction`) in which control points are to move. `along` is a vector of any
 * length above 0, or null for the other two.
 *
 * # Safety
 * `along` is null or readable for 3 doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeSetDirection(struct ShapeOpSnake *snake, int kind, const double *along);

/**
 * Takes speeds in that direction, in model units per time: one for all control points, or one for each. At first they
 * are 1.
 *
 * # Safety
 * `speeds` is null or readable for `nb_speeds` doubles.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeSetSpeeds(struct ShapeOpSnake *snake, const double *speeds, int nb_speeds);

/**
 * Takes the control points that stay where they are, `nb_points` of them, in place of those before.
 *
 * # Safety
 * `points` is null or readable for `nb_points` ints.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeSetFixed(struct ShapeOpSnake *snake, const int *points, int nb_points);

/**
 * Wishes that a control point moves with this velocity, in model units per time. What it differs by is squared and
 * multiplied by `weight`, 0 or more. Wishes add up until `shapeop_snakeClearWishes`.
 *
 * # Safety
 * `velocity` is null or readable for 3 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeWishVelocity(struct ShapeOpSnake *snake,
                                           int point,
                                           const double *velocity,
                                           double weight);

/**
 * Wishes that a control point moves in the plane with this normal, of any length above 0, with a weight.
 *
 * # Safety
 * `normal` is null or readable for 3 doubles.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeWishPlane(struct ShapeOpSnake *snake,
                                        int point,
                                        const double *normal,
                                        double weight);

/**
 * Takes all wishes away.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeClearWishes(struct ShapeOpSnake *snake);

/**
 * Adds a rail along which a control point runs: the cubic spline through `nb_points` points, open or, with `is_closed`
 * 1, closed. The run begins at the rail's point nearest to the control point, which is on it. `speed` is in lengths of
 * the points' polygon per time; below 0 it runs against their order. The rail's number, from 0 on, or -1.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles.
 */
SHAPEOP_API
int shapeop_snakeDriveRail(struct ShapeOpSnake *snake,
                           int point,
                           const double *points,
                           int nb_points,
                           int is_closed,
                           double speed);

/**
 * As `shapeop_snakeDriveRail`, for a control point that runs so that its distance from the point of the rail `leader`,
 * which is driven, stays.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles.
 */
SHAPEOP_API
int shapeop_snakeFollowRail(struct ShapeOpSnake *snake,
                            int point,
                            const double *points,
                            int nb_points,
                            int is_closed,
                            int leader);

/**
 * Adds a rail that the snake stays in touch with, at whatever place of either: it begins at a contact point of the
 * snake, and crosses it there.
 *
 * # Safety
 * `points` is null or readable for `3 * nb_points` doubles.
 */
SHAPEOP_API
int shapeop_snakeGlideRail(struct ShapeOpSnake *snake,
                           int contact,
                           const double *points,
                           int nb_points,
                           int is_closed);

/**
 * The number of rails, or -1.
 */
SHAPEOP_API int shapeop_snakeRailCount(struct ShapeOpSnake *snake);

/**
 * Takes all rails away.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeClearRails(struct ShapeOpSnake *snake);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDefaultOptions(struct shapeop_snake_options *options);

/**
 * Writes the velocities with which the snake would begin to move, in model units per time, if there is room for
 * `capacity` control points, and their number to `count`; to `residual`, which may be null, by how much they miss a
 * condition at most: round-off, unless conditions contradict each other. `options` is null for the defaults.
 *
 * # Safety
 * `velocities` is null or writable for `3 * capacity` doubles, `count` for one int, `residual` for one double. `options`
 * is null, or its `struct_size` is set and it is readable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeVelocity(struct ShapeOpSnake *snake,
                                       const struct shapeop_snake_options *options,
                                       double *velocities,
                                       int capacity,
                                       int *count,
                                       double *residual);

/**
 * Puts the snake to a position near the target, one point for each control point, that its arcs can have; with `is_exact`
 * 1 to the nearest one. Fixed points stay at their targets; the surface and rails do not count. Of `options`, which is
 * null for the defaults, `mu`, `is_exact` and `projection_iterations` count. `report` is null, or its `struct_size` is
 * set. What was found of the snake's motion is forgotten.
 *
 * # Safety
 * `target` is null or readable for `3 * nb_target` doubles; `options` and `report` are null, or their `struct_size` is
 * set and they are readable or writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeProject(struct ShapeOpSnake *snake,
                                      const double *target,
                                      int nb_target,
                                      const struct shapeop_snake_options *options,
                                      struct shapeop_snake_projection *report);

/**
 * Moves a snake step by step. The snake itself stays at its start; the positions are told by `shapeop_snakeFrames` and
 * others, and `shapeop_snakeTakeFrame` puts the snake to one of them.
 *
 * `options` is null for the defaults. `progress` may be null; what ends the call leaves the positions so far. `report`
 * is null, or its `struct_size` is set.
 *
 * # Safety
 * `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
 * `progress` is null or a function of that signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeEvolve(struct ShapeOpSnake *snake,
                                     const struct shapeop_snake_options *options,
                                     shapeop_snake_progress_callback progress,
                                     void *user,
                                     struct shapeop_snake_evolution *report);

/**
 * The number of positions that were found last, or -1: nothing was found since the snake was put where it is.
 */
SHAPEOP_API int shapeop_snakeFrameCount(struct ShapeOpSnake *snake);

/**
 * Writes the control points of all positions that were found last, one position after the other, if there is room for
 * `capacity` points, and their number to `count`.
 *
 * # Safety
 * `control` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeFrames(struct ShapeOpSnake *snake, double *control, int capacity, int *count);

/**
 * Writes the frames of the last evolution, 7 numbers each, if there is room for `capacity` of them, and their number to
 * `count`: the time; the deviation from the surface; by how much a distance or a rail is missed at most; by how much a
 * height differs from that at the start at most; by how much a distance of control points three apart is off, where
 * those are kept; by how much a distance was off before the projection; by how much the velocities that led there miss a
 * condition. In model units and times.
 *
 * # Safety
 * `rows` is null or writable for `7 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeFrameRows(struct ShapeOpSnake *snake,
                                        double *rows,
                                        int capacity,
                                        int *count);

/**
 * Puts the snake to a position that was found last, from which it can move on. What was found is forgotten.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeTakeFrame(struct ShapeOpSnake *snake, int frame);

/**
 * Tells how far two positions, `a` and `b`, of those found last are from being the same up to a rigid motion, in model
 * units: to `rms` the root of the mean squared distance of control points after the motion for which it is least; to
 * `distances` by how much the distance of any two control points differs at most. Each output may be null.
 *
 * # Safety
 * Each output is null or writable for one double.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCongruence(struct ShapeOpSnake *snake,
                                         int a,
                                         int b,
                                         double *rms,
                                         double *distances);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDefaultCycleOptions(struct shapeop_snake_cycle_options *options);

/**
 * Moves an open snake whose first two control points and last two are fixed, so that its end arcs turn about hinges,
 * until it is back where it began; one of six arcs can move in one way. The snake itself stays at its start; the
 * positions are told by `shapeop_snakeFrames` and others.
 *
 * `options` is null for the defaults. `progress` may be null; what ends the call leaves the positions so far. `report`
 * is null, or its `struct_size` is set.
 *
 * # Safety
 * `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
 * `progress` is null or a function of that signature.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCycle(struct ShapeOpSnake *snake,
                                    const struct shapeop_snake_cycle_options *options,
                                    shapeop_snake_progress_callback progress,
                                    void *user,
                                    struct shapeop_snake_cycle *report);

/**
 * In how many independent ways an open snake can move whose first two control points and last two are fixed, or -1: one
 * of six arcs in one way, unless it is in a special position.
 */
SHAPEOP_API int shapeop_snakeLinkageFreedoms(struct ShapeOpSnake *snake);

/**
 * Writes the determinant of the Plücker coordinates of the first six hinges of a linkage of six arcs to `determinant`,
 * moments in units of its size. It is 0 in singular positions; below 1e-6 or so one is near.
 *
 * # Safety
 * `determinant` is null or writable for one double.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDeterminant(struct ShapeOpSnake *snake, double *determinant);

/**
 * Writes by how much the first and the last arc of the linkage are turned at each frame, 2 angles in radians each, if
 * there is room for `capacity` frames, and their number to `count`: counterclockwise about the first edge and the last.
 *
 * # Safety
 * `angles` is null or writable for `2 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCycleAngles(struct ShapeOpSnake *snake,
                                          double *angles,
                                          int capacity,
                                          int *count);

/**
 * Writes the path of a contact point of the linkage, one point for each frame, if there is room for `capacity` of them,
 * and their number to `count`.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeContactPath(struct ShapeOpSnake *snake,
                                          int contact,
                                          double *points,
                                          int capacity,
                                          int *count);

/**
 * Writes the control points of the linkage at phases of its motion, one position after the other, if there is room for
 * `capacity` points, and their number to `count`. A phase of 0 is the start, 1 the start again, or the last position of a
 * motion that is not closed; phases go with the length of the way. Arcs keep their shapes to round-off.
 *
 * # Safety
 * `phases` is null or readable for `nb_phases` doubles; `control` is null or writable for `3 * capacity` doubles, `count`
 * for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeAtPhases(struct ShapeOpSnake *snake,
                                       const double *phases,
                                       int nb_phases,
                                       double *control,
                                       int capacity,
                                       int *count);

/**
 * Writes the control points of `nb_copies` copies of the linkage that move together, one copy after the other, if there
 * is room for `capacity` points, and their number to `count`: copy `k` is at the phase `phase + k * shift`, and moved by
 * `k` times `offset`.
 *
 * # Safety
 * `offset` is null or readable for 3 doubles; `control` is null or writable for `3 * capacity` doubles, `count` for one
 * int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCopies(struct ShapeOpSnake *snake,
                                     int nb_copies,
                                     double phase,
                                     double shift,
                                     const double *offset,
                                     double *control,
                                     int capacity,
                                     int *count);

/**
 * Writes the surface that the positions found last sweep as a mesh of quads: a row of points for each position,
 * `per_arc` intervals in each arc, as `shapeop_snakeSample` has them. With `comes_back` 1 the last position is followed by
 * the first. Points are written if there is room for `capacity` of them, and their number to `count`; quads, four points
 * each, if there is room for `quad_capacity` of them, and their number to `quad_count`.
 *
 * # Safety
 * `points` is null or writable for `3 * capacity` doubles, `quads` for `4 * quad_capacity` ints, `count` and
 * `quad_count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeSweepMesh(struct ShapeOpSnake *snake,
                                        int per_arc,
                                        int comes_back,
                                        double *points,
                                        int capacity,
                                        int *count,
                                        int *quads,
                                        int quad_capacity,
                                        int *quad_count);

/**
 * Writes the pipe of a radius around the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), as a mesh of quads that
 * face outward: `around` points, 3 or more, in each section, `per_arc` intervals in each arc. Outputs are as those of
 * `shapeop_snakeSweepMesh`.
 *
 * # Safety
 * As `shapeop_snakeSweepMesh`.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakePipe(struct ShapeOpSnake *snake,
                                   int frame,
                                   double radius,
                                   int per_arc,
                                   int around,
                                   double *points,
                                   int capacity,
                                   int *count,
                                   int *quads,
                                   int quad_capacity,
                                   int *quad_count);

/**
 * Writes the lamellae of a depth along the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), as a mesh of quads,
 * `per_arc` intervals in each arc. How they stand says `kind`, a `shapeop_snake_lamella`; `along` is a vector of any
 * length above 0, or null for the others. Flat ones are `depth` farther from the centres of the arcs, or nearer if it is
 * negative. Outputs are as those of `shapeop_snakeSweepMesh`.
 *
 * # Safety
 * `along` is null or readable for 3 doubles; else as `shapeop_snakeSweepMesh`.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeLamellae(struct ShapeOpSnake *snake,
                                       int frame,
                                       int kind,
                                       const double *along,
                                       double depth,
                                       int per_arc,
                                       double *points,
                                       int capacity,
                                       int *count,
                                       int *quads,
                                       int quad_capacity,
                                       int *quad_count);

/**
 * Writes the kinds of arcs that one position of the snake is made of, 3 numbers each, if there is room for `capacity` of
 * them, and their number to `count`: the radius, the length, how many there are. Arcs are of one kind if radii and
 * lengths are both within `tolerance` of the first's, relative to its. All positions have the same arcs.
 *
 * # Safety
 * `kinds` is null or writable for `3 * capacity` doubles, `count` for one int.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeKinds(struct ShapeOpSnake *snake,
                                    double tolerance,
                                    double *kinds,
                                    int capacity,
                                    int *count);

/**
 * Writes of which kind each arc is, as `shapeop_snakeKinds` numbers them, if there is room for `capacity` arcs, and
 * their number to `count`.
 *
 * # Safety
 * `kind_of` is null or writable for `capacity` ints, `count` for one.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeKindOf(struct ShapeOpSnake *snake,
                                     double tolerance,
                                     int *kind_of,
                                     int capacity,
                                     int *count);

/**
 * Writes the default options to `options`, whose `struct_size` must be set.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API enum shapeop_err shapeop_snakeDefaultCoveringOptions(struct shapeop_snake_covering_options *options);

/**
 * Judges the surface that the positions found last sweep, and how it covers the mesh that is the snake's surface: writes
 * to `report`, whose `struct_size` must be set. `options` is null for the defaults.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is readable for so many bytes; `report` is null, or its
 * `struct_size` is set and it is writable for so many bytes.
 */
SHAPEOP_API
enum shapeop_err shapeop_snakeCovering(struct ShapeOpSnake *snake,
                                       const struct shapeop_snake_covering_options *options,
                                       struct shapeop_snake_covering *report);

/**
 * The same as JSON (`docs/snake-report.schema.json`), with the kinds of arcs; null if it is refused. The text is valid as
 * long as that of `shapeop_snakeText`.
 *
 * # Safety
 * `options` is null, or its `struct_size` is set and it is readable for so many bytes.
 */
SHAPEOP_API
const char *shapeop_snakeCoveringText(struct ShapeOpSnake *snake,
                                      const struct shapeop_snake_covering_options *options);

/**
 * Creates a snake from its JSON form (`docs/snake.schema.json`); null if it is refused.
 *
 * # Safety
 * `json` is null or ends with a zero.
 */
SHAPEOP_API struct ShapeOpSnake *shapeop_snakeCreateFromText(const char *json);

/**
 * The JSON form of a snake as it is (`docs/snake.schema.json`); null if it is refused. The text is the calling thread's
 * own, valid until that thread's next call of a function of snakes that answers with a text.
 */
SHAPEOP_API const char *shapeop_snakeText(struct ShapeOpSnake *snake);

/**
 * The arcs of the snake at a frame, as it is (`SHAPEOP_SNAKE_NOW`) or at all positions found last (`SHAPEOP_SNAKE_ALL`)
 * as JSON (`docs/snake-arcs.schema.json`); null if it is refused. Arcs are of one kind if radii and lengths are both
 * within `tolerance` of the first's, relative to its. The text is valid as long as that of `shapeop_snakeText`.
 */
SHAPEOP_API const char *shapeop_snakeArcsText(struct ShapeOpSnake *snake, int frame, double tolerance);

/**
 * The same as a table, a line for each arc: frame, arc, kind, centre, radius, axis, start, angle in radians, length.
 */
SHAPEOP_API const char *shapeop_snakeArcsCsv(struct ShapeOpSnake *snake, int frame, double tolerance);

/**
 * The kinds of arcs of the same as a table, a line for each: kind, radius, length, count.
 */
SHAPEOP_API const char *shapeop_snakeKindsCsv(struct ShapeOpSnake *snake, int frame, double tolerance);

/**
 * The same arcs as a DXF drawing, a layer for each kind.
 */
SHAPEOP_API const char *shapeop_snakeArcsDxf(struct ShapeOpSnake *snake, int frame, double tolerance);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SHAPEOP_H */
