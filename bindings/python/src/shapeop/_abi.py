"""The C functions of the library, declared for ctypes. Python 2.7 and 3.

Generated from the sources of the library: do not edit. include/shapeop.h documents the functions.
"""

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int, c_uint, c_void_p

ABI_VERSION = 1

# shapeop_err
SO_SUCCESS = 0
SO_INVALID_CONSTRAINT_TYPE = 1
SO_INVALID_ARGUMENT_LENGTH = 2
SO_UNMATCHING_CONSTRAINT_ID = 3
SO_INVALID_VALUE = 16
SO_INDEX_OUT_OF_RANGE = 17
SO_UNMATCHING_FORCE_ID = 18
SO_NOT_INITIALISED = 19
SO_UNBOUNDED = 20
SO_BUSY = 21
SO_INVALID_HANDLE = 22
SO_NULL_POINTER = 23
SO_INVALID_INPUT = 24
SO_TOO_LARGE = 25
SO_INTERNAL = 26
SO_NOT_GRID = 27
SO_NOT_PLANAR = 28
SO_NOT_CIRCULAR = 29
SO_DEGENERATE = 30
SO_NO_INTERSECTION = 31
SO_NO_SOLUTION = 32
SO_SINGULAR = 33
SO_NOT_CLOSED = 34

# shapeop_acceleration
SO_ACCELERATION_NONE = 0
SO_ACCELERATION_ANDERSON = 1
SO_ACCELERATION_QUASI_NEWTON = 2
SO_ACCELERATION_AUTOMATIC = 3

# shapeop_linear_solver
SO_LINEAR_SOLVER_AUTOMATIC = 0
SO_LINEAR_SOLVER_DIRECT = 1
SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS = 2

# shapeop_projection
SO_PROJECTION_NEAREST = 0
SO_PROJECTION_FEASIBLE = 1
SO_PROJECTION_APPROXIMATE = 2

# shapeop_outcome
SO_OUTCOME_CONVERGED = 0
SO_OUTCOME_ITERATION_LIMIT = 1
SO_OUTCOME_TIME_BUDGET = 2
SO_OUTCOME_CANCELLED = 3
SO_OUTCOME_STALLED = 4
SO_OUTCOME_UNBOUNDED = 5
SO_OUTCOME_INFEASIBLE = 6

# shapeop_fairness
SO_FAIRNESS_LAPLACIAN = 0
SO_FAIRNESS_SECOND_DIFFERENCES = 1
SO_FAIRNESS_THIRD_DIFFERENCES = 2


class shapeop_constraint_type(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("least_indices", c_int),
        ("greatest_indices", c_int),
        ("scalar_count", c_int),
        ("index_name_count", c_int),
        ("projection", c_int),
        ("is_centred", c_int),
        ("energy_scale_power", c_int),
        ("name", c_char_p),
        ("help", c_char_p),
        ("violation_unit", c_char_p),
        ("edited_as", c_char_p),
    ]


class shapeop_constraint_scalar(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("has_default", c_int),
        ("default_value", c_double),
        ("name", c_char_p),
    ]


class shapeop_solve_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_iterations", c_uint),
        ("tolerance", c_double),
        ("time_budget_seconds", c_double),
    ]


class shapeop_solve_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("outcome", c_int),
        ("iterations", c_uint),
        ("unconstrained_count", c_uint),
        ("energy_before", c_double),
        ("energy_after", c_double),
        ("largest_move", c_double),
        ("analysis_seconds", c_double),
        ("factorisation_seconds", c_double),
        ("local_seconds", c_double),
        ("global_seconds", c_double),
        ("evaluations", c_uint),
        ("rejected_energy_rose", c_uint),
        ("rejected_not_finite", c_uint),
        ("rejected_ill_conditioned", c_uint),
        ("rejected_not_descent", c_uint),
        ("rejected_line_search", c_uint),
        ("ordering_count", c_uint),
        ("factorisation_count", c_uint),
        ("linear_solver", c_int),
        ("linear_iterations", c_uint),
    ]


class shapeop_progress(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("iteration", c_uint),
        ("energy", c_double),
        ("largest_move", c_double),
    ]


class shapeop_objective(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("reserved", c_uint),
        ("handle_weight", c_double),
        ("closeness_weight", c_double),
        ("fairness_weight", c_double),
        ("tolerance", c_double),
    ]


class shapeop_exploration(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("sweep_count", c_uint),
        ("newton_step_count", c_uint),
        ("is_solution", c_int),
        ("largest_violation", c_double),
        ("worst_constraint", c_int),
        ("capped_count", c_int),
        ("primal_residual", c_double),
        ("dual_residual", c_double),
        ("handle_term", c_double),
        ("closeness_term", c_double),
        ("fairness_term", c_double),
        ("soft_term", c_double),
        ("penalty", c_double),
    ]


class shapeop_recipe_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("fairness_kind", c_int),
        ("weight", c_double),
        ("closeness", c_double),
        ("fairness", c_double),
        ("length", c_double),
        ("anchors", POINTER(c_int)),
        ("nb_anchors", c_int),
        ("anchor_boundary", c_int),
        ("anchor_corners", c_int),
    ]


shapeop_progress_callback = CFUNCTYPE(c_int, POINTER(shapeop_progress), c_void_p)

# What each function returns, and what it takes.
FUNCTIONS = {
    "shapeop_version": (c_char_p, []),
    "shapeop_abiVersion": (c_int, []),
    "shapeop_lastError": (c_char_p, [c_void_p]),
    "shapeop_lastErrorCode": (c_int, [c_void_p]),
    "shapeop_errorText": (c_char_p, [c_int]),
    "shapeop_create": (c_void_p, []),
    "shapeop_delete": (None, [c_void_p]),
    "shapeop_init": (c_int, [c_void_p]),
    "shapeop_initDynamic": (c_int, [c_void_p, c_double, c_double, c_double]),
    "shapeop_solve": (c_int, [c_void_p, c_uint]),
    "shapeop_setTimeStep": (None, [c_void_p, c_double]),
    "shapeop_setDamping": (None, [c_void_p, c_double]),
    "shapeop_setThreadCount": (c_int, [c_void_p, c_int]),
    "shapeop_setAcceleration": (c_int, [c_void_p, c_int, c_uint]),
    "shapeop_setLinearSolver": (c_int, [c_void_p, c_int]),
    "shapeop_setPoints": (None, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_getPoints": (None, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_pointCount": (c_int, [c_void_p]),
    "shapeop_unconstrainedCount": (c_int, [c_void_p]),
    "shapeop_addReferencePolyline": (c_int, [c_void_p, POINTER(c_double), c_int, c_int]),
    "shapeop_addReferenceMesh": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int), c_int]),
    "shapeop_referenceCount": (c_int, [c_void_p]),
    "shapeop_addConstraint": (c_int, [c_void_p, c_char_p, POINTER(c_int), c_int, c_double]),
    "shapeop_addConstraints": (
        c_int,
        [
            c_void_p,
            c_char_p,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            c_int,
            c_uint,
            POINTER(c_int),
        ],
    ),
    "shapeop_editConstraint": (c_int, [c_void_p, c_char_p, c_int, POINTER(c_double), c_int]),
    "shapeop_editConstraints": (c_int, [c_void_p, c_char_p, POINTER(c_int), c_int, POINTER(c_double), c_int, c_int]),
    "shapeop_setWeight": (c_int, [c_void_p, c_int, c_double]),
    "shapeop_setWeights": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_double), c_int]),
    "shapeop_removeConstraint": (c_int, [c_void_p, c_int]),
    "shapeop_constraintCount": (c_int, [c_void_p]),
    "shapeop_isConstraint": (c_int, [c_void_p, c_int]),
    "shapeop_isDegenerate": (c_int, [c_void_p, c_int]),
    "shapeop_addGravityForce": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_addVertexForce": (c_int, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_editVertexForce": (None, [c_void_p, c_int, POINTER(c_double), c_int]),
    "shapeop_addPressure": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int), c_int, c_double]),
    "shapeop_addNormalForce": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int), c_int, c_double]),
    "shapeop_editForceMagnitude": (c_int, [c_void_p, c_int, c_double]),
    "shapeop_removeForce": (c_int, [c_void_p, c_int]),
    "shapeop_forceCount": (c_int, [c_void_p]),
    "shapeop_isForce": (c_int, [c_void_p, c_int]),
    "shapeop_constraintTypeCount": (c_int, []),
    "shapeop_constraintType": (c_int, [c_int, POINTER(shapeop_constraint_type)]),
    "shapeop_constraintScalar": (c_int, [c_int, c_int, POINTER(shapeop_constraint_scalar)]),
    "shapeop_constraintIndexName": (c_char_p, [c_int, c_int]),
    "shapeop_defaultSolveOptions": (c_int, [POINTER(shapeop_solve_options)]),
    "shapeop_solveUntil": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_solve_options),
            shapeop_progress_callback,
            c_void_p,
            POINTER(shapeop_solve_report),
        ],
    ),
    "shapeop_energy": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_getViolations": (c_int, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_setHard": (c_int, [c_void_p, c_int, c_int]),
    "shapeop_isHard": (c_int, [c_void_p, c_int]),
    "shapeop_setHandle": (c_int, [c_void_p, c_int, POINTER(c_double)]),
    "shapeop_releaseHandle": (c_int, [c_void_p, c_int]),
    "shapeop_defaultObjective": (c_int, [POINTER(shapeop_objective)]),
    "shapeop_setObjective": (c_int, [c_void_p, POINTER(shapeop_objective)]),
    "shapeop_setFairness": (c_int, [c_void_p, c_int, POINTER(c_int), c_int, POINTER(c_int), c_int]),
    "shapeop_getExploration": (c_int, [c_void_p, POINTER(shapeop_exploration)]),
    "shapeop_getConflicts": (c_int, [c_void_p, POINTER(c_int), c_int]),
    "shapeop_weightClassCount": (c_int, [c_void_p]),
    "shapeop_weightClassName": (c_char_p, [c_void_p, c_int]),
    "shapeop_getSensitivities": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_double), c_int]),
    "shapeop_setProblem": (c_int, [c_void_p, c_char_p, POINTER(shapeop_solve_options)]),
    "shapeop_problemText": (c_char_p, [c_char_p]),
    "shapeop_defaultRecipeOptions": (c_int, [POINTER(shapeop_recipe_options)]),
    "shapeop_recipe": (
        c_char_p,
        [
            c_char_p,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(shapeop_recipe_options),
        ],
    ),
    "shapeop_recipeCount": (c_int, []),
    "shapeop_recipeName": (c_char_p, [c_int]),
    "shapeop_measureFaces": (
        c_int,
        [
            c_char_p,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            c_int,
        ],
    ),
    "shapeop_measureCount": (c_int, []),
    "shapeop_measureName": (c_char_p, [c_int]),
}


def declare(library):
    """Tells ctypes what the functions of a loaded library take and return."""
    for name, (result, arguments) in FUNCTIONS.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library
