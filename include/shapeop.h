/* shapeop: constraint-based geometry. C99 and C++.
 *
 * Generated from the sources of the library: do not edit.
 *
 * Handles. A ShapeOpSolver* is a small integer (nonzero, below 2^31), not an address: never dereference it. A null
 * handle, one that was deleted, and one that never was a solver's are recognised and refused. Only the low 32 bits
 * count.
 *
 * Ownership. Every solver of shapeop_create belongs to the caller, who deletes it with shapeop_delete. Arrays belong
 * to the caller: the library copies what it reads and keeps no pointer. Texts belong to the library and are never
 * freed; how long they stay valid is said with each function.
 *
 * Arrays. Points are double[3 * n]: x y z of point 0, then of point 1, and so on. Lengths of points are counted in
 * points, all others in entries. An array of length 0 may be null. Results are written only if the call succeeds.
 *
 * Errors. A refused call changes nothing, and answers with an error code, with 1 (shapeop_init, shapeop_initDynamic,
 * shapeop_solve), with -1 (ids, counts, truths) or with null (shapeop_create, shapeop_constraintIndexName). In all
 * cases, functions without a result included, shapeop_lastError then says why and shapeop_lastErrorCode gives the
 * code; after a call that succeeded the text is empty and the code SO_SUCCESS. Numbers that are not finite are refused where they enter, and none is ever handed out.
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
     * A point index is out of range.
     */
    SO_INDEX_OUT_OF_RANGE = 17,
    /**
     * The id is no force of that kind.
     */
    SO_UNMATCHING_FORCE_ID = 18,
    /**
     * The solver was not initialised.
     */
    SO_NOT_INITIALISED = 19,
    /**
     * A force acts along a motion that no constraint resists.
     */
    SO_UNBOUNDED = 20,
    /**
     * Another call is using the solver.
     */
    SO_BUSY = 21,
    /**
     * The handle is null, was deleted, or never was a solver's.
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
     * Opposite edges of a quad are parallel where the fourth corner is found by meeting them.
     */
    SO_SINGULAR = 33,
    /**
     * A ring does not close.
     */
    SO_NOT_CLOSED = 34,
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
     * The weight of fairness; 0, the default, for none ("rationalize", "circumscribe": for ten times the closeness).
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
 * A force along a motion that no constraint resists is the outcome `SO_OUTCOME_UNBOUNDED` of a successful call.
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
 * "regularize", "equalize", "rationalize" or "circumscribe" (`shapeop_recipeName`); null if it is refused. Its points are those of the mesh
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

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SHAPEOP_H */
