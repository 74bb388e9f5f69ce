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
SO_NOT_MANIFOLD = 35
SO_CURVATURE_SIGN = 36
SO_NOT_ORIENTABLE = 37
SO_INFEASIBLE = 38
SO_OUT_OF_DOMAIN = 39
SO_BACKEND_UNAVAILABLE = 40
SO_BACKEND_FAILED = 41

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
SO_OUTCOME_BACKEND_FAILED = 7

# shapeop_fairness
SO_FAIRNESS_LAPLACIAN = 0
SO_FAIRNESS_SECOND_DIFFERENCES = 1
SO_FAIRNESS_THIRD_DIFFERENCES = 2

# shapeop_backend
SO_BACKEND_CPU = 0
SO_BACKEND_GPU = 1
SO_BACKEND_AUTOMATIC = 2

# shapeop_adapter_kind
SO_ADAPTER_DISCRETE = 0
SO_ADAPTER_INTEGRATED = 1
SO_ADAPTER_VIRTUAL = 2
SO_ADAPTER_OTHER = 3
SO_ADAPTER_SOFTWARE = 4

# shapeop_canal_kind
SO_CANAL_KIND_CANAL = 0
SO_CANAL_KIND_REVOLUTION = 1
SO_CANAL_KIND_MOULDING = 2
SO_CANAL_KIND_CIRCULAR = 3

# shapeop_canal_stop
SO_CANAL_STOP_GRADIENT = 0
SO_CANAL_STOP_DECREASE = 1
SO_CANAL_STOP_ITERATIONS = 2
SO_CANAL_STOP_LINE_SEARCH = 3
SO_CANAL_STOP_CANCELLED = 4
SO_CANAL_STOP_INFEASIBLE = 5

# shapeop_canal_spacing
SO_CANAL_SPACING_ARC_LENGTH = 0
SO_CANAL_SPACING_PARAMETER = 1
SO_CANAL_SPACING_POINTS = 2

# shapeop_canal_section
SO_CANAL_SECTION_WHOLE = 0
SO_CANAL_SECTION_ANGLES = 1
SO_CANAL_SECTION_TO_CURVE = 2
SO_CANAL_SECTION_ABOVE = 3

# shapeop_canal_center
SO_CANAL_CENTER_MIDDLE = 0
SO_CANAL_CENTER_ANGLE = 1
SO_CANAL_CENTER_RATIO_INSIDE = 2
SO_CANAL_CENTER_RATIO_OUTSIDE = 3
SO_CANAL_CENTER_POINT = 4
SO_CANAL_CENTER_CHORD = 5

# shapeop_canal_step
SO_CANAL_STEP_SIMILARITY = 0
SO_CANAL_STEP_MOEBIUS = 1
SO_CANAL_STEP_COMBESCURE = 2

# shapeop_ruled_point
SO_RULED_POINT_GOOD = 0
SO_RULED_POINT_NOT_NEGATIVE = 1
SO_RULED_POINT_NOT_FITTED = 2

# shapeop_ruled_end
SO_RULED_END_BOUNDARY = 0
SO_RULED_END_UNKNOWN = 1
SO_RULED_END_LENGTH = 2
SO_RULED_END_STEPS = 3

# shapeop_ruled_levels
SO_RULED_LEVELS_ORTHOGONAL = 0
SO_RULED_LEVELS_DIRECTION = 1
SO_RULED_LEVELS_EQUIDISTANT = 2
SO_RULED_LEVELS_GEODESIC = 3
SO_RULED_LEVELS_CONOIDAL = 4

# shapeop_ruled_image
SO_RULED_IMAGE_NONE = 0
SO_RULED_IMAGE_REGULAR = 1
SO_RULED_IMAGE_FOLDED = 2
SO_RULED_IMAGE_GREAT_CIRCLE = 3
SO_RULED_IMAGE_CURVE = 4

# shapeop_ruled_stop
SO_RULED_STOP_NONE = 0
SO_RULED_STOP_CONVERGED = 1
SO_RULED_STOP_ITERATIONS = 2
SO_RULED_STOP_LINE_SEARCH = 3
SO_RULED_STOP_CANCELLED = 4

# shapeop_snake_curve_end
SO_SNAKE_CURVE_LENGTH = 0
SO_SNAKE_CURVE_BOUNDARY = 1
SO_SNAKE_CURVE_BENDS_MORE = 2
SO_SNAKE_CURVE_FOLD = 3

# shapeop_snake_surface
SO_SNAKE_SURFACE_PLANE = 0
SO_SNAKE_SURFACE_SPHERE = 1
SO_SNAKE_SURFACE_CYLINDER = 2
SO_SNAKE_SURFACE_TORUS = 3

# shapeop_snake_direction
SO_SNAKE_DIRECTION_FREE = 0
SO_SNAKE_DIRECTION_SIDEWAYS = 1
SO_SNAKE_DIRECTION_ALONG = 2

# shapeop_snake_stop
SO_SNAKE_STOP_STEPS = 0
SO_SNAKE_STOP_DEVIATION = 1
SO_SNAKE_STOP_SINGULAR = 2
SO_SNAKE_STOP_RAIL_END = 3
SO_SNAKE_STOP_PARALLEL = 4
SO_SNAKE_STOP_CYCLE = 5
SO_SNAKE_STOP_STALLED = 6
SO_SNAKE_STOP_CANCELLED = 7

# shapeop_snake_cycle_end
SO_SNAKE_CYCLE_CLOSED = 0
SO_SNAKE_CYCLE_STEPS = 1
SO_SNAKE_CYCLE_FREEDOMS = 2
SO_SNAKE_CYCLE_STALLED = 3
SO_SNAKE_CYCLE_CANCELLED = 4

# shapeop_snake_lamella
SO_SNAKE_LAMELLA_FLAT = 0
SO_SNAKE_LAMELLA_NORMAL = 1
SO_SNAKE_LAMELLA_ALONG = 2


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
        ("backend", c_int),
        ("gpu_iterations", c_uint),
        ("read_back_iteration", c_uint),
        ("reserved", c_uint),
        ("gpu_seconds", c_double),
        ("transfer_seconds", c_double),
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


class shapeop_backend_info(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("kind", c_int),
        ("group_count", c_uint),
        ("reserved", c_uint),
        ("buffer_bytes", c_double),
        ("binding_bytes", c_double),
        ("adapter", c_char_p),
        ("api", c_char_p),
        ("driver", c_char_p),
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


class shapeop_canal_progress(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("iteration", c_uint),
        ("fraction", c_double),
        ("value", c_double),
    ]


class shapeop_canal_smooth_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_iterations", c_uint),
        ("has_cone", c_int),
        ("turns_tangents", c_int),
        ("cone_axis_x", c_double),
        ("cone_axis_y", c_double),
        ("cone_axis_z", c_double),
        ("cone_angle", c_double),
        ("spacing_ratio", c_double),
        ("length_change", c_double),
        ("length_weight", c_double),
        ("half_angle", c_double),
        ("relative_gradient", c_double),
        ("relative_decrease", c_double),
    ]


class shapeop_canal_smooth_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("stop", c_int),
        ("before", c_double),
        ("after", c_double),
        ("iterations", c_uint),
        ("reserved", c_uint),
    ]


class shapeop_canal_fit_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("circle_count", c_int),
        ("column_count", c_int),
        ("spacing", c_int),
        ("section", c_int),
        ("is_long_way", c_int),
        ("has_normal", c_int),
        ("reserved", c_int),
        ("angle", c_double),
        ("normal_x", c_double),
        ("normal_y", c_double),
        ("normal_z", c_double),
        ("from_angle", c_double),
        ("to_angle", c_double),
        ("plane_x", c_double),
        ("plane_y", c_double),
        ("plane_z", c_double),
        ("up_x", c_double),
        ("up_y", c_double),
        ("up_z", c_double),
    ]


class shapeop_canal_fit_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("is_outward", c_int),
        ("deviation", c_double),
        ("residual", c_double),
        ("tangent_gap", c_double),
        ("closing_gap", c_double),
    ]


class shapeop_canal_properties(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("face_count", c_uint),
        ("crossed_count", c_uint),
        ("flipped_count", c_uint),
        ("shrunk_count", c_uint),
        ("has_planar_curves", c_int),
        ("is_isothermic_by_construction", c_int),
        ("has_stress_lines", c_int),
        ("planarity", c_double),
        ("concyclicity", c_double),
        ("rows_off_plane", c_double),
        ("columns_off_plane", c_double),
        ("cross_ratio_residual", c_double),
        ("stress_residual_coarse", c_double),
        ("stress_residual_fine", c_double),
    ]


class shapeop_ruled_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("family", c_int),
        ("allow_cut", c_int),
        ("least_neighbours", c_uint),
        ("flatness", c_double),
        ("max_mask", c_double),
        ("hint_x", c_double),
        ("hint_y", c_double),
        ("hint_z", c_double),
    ]


class shapeop_ruled_level_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_iterations", c_uint),
        ("allow_folds", c_int),
        ("reserved", c_uint),
        ("orthogonal", c_double),
        ("direction", c_double),
        ("equidistant", c_double),
        ("geodesic", c_double),
        ("conoidal", c_double),
        ("laplace", c_double),
        ("relative_decrease", c_double),
    ]


class shapeop_ruled_level_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("stop", c_int),
        ("iterations", c_uint),
        ("critical_count", c_uint),
        ("image", c_int),
        ("image_unused_count", c_uint),
        ("least_slope", c_double),
        ("greatest_slope", c_double),
        ("image_extent", c_double),
        ("image_folded", c_double),
        ("image_flatness", c_double),
        ("image_axis_x", c_double),
        ("image_axis_y", c_double),
        ("image_axis_z", c_double),
    ]


class shapeop_ruled_boundary_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("extends", c_int),
        ("overshoots", c_int),
        ("reserved", c_uint),
        ("least_length", c_double),
    ]


class shapeop_ruled_progress(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("iteration", c_uint),
        ("fraction", c_double),
        ("value", c_double),
        ("largest_deviation", c_double),
        ("largest_gap", c_double),
    ]


class shapeop_ruled_optimise_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_iterations", c_uint),
        ("samples_along", c_uint),
        ("samples_across", c_uint),
        ("proximity", c_double),
        ("beyond", c_double),
        ("gap", c_double),
        ("coverage", c_double),
        ("thin_plate", c_double),
        ("proximal", c_double),
        ("largest_deviation", c_double),
        ("least_width", c_double),
        ("tolerance", c_double),
    ]


class shapeop_ruled_optimise_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("stop", c_int),
        ("iterations", c_uint),
        ("free_count", c_uint),
        ("before", c_double),
        ("after", c_double),
        ("proximity", c_double),
        ("gap", c_double),
        ("coverage", c_double),
        ("way", c_double),
        ("excess", c_double),
        ("largest_deviation", c_double),
        ("largest_gap", c_double),
    ]


class shapeop_ruled_report_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("samples_along", c_uint),
        ("samples_across", c_uint),
        ("columns_per_span", c_uint),
        ("feature_ratio", c_double),
        ("trim_tolerance", c_double),
    ]


class shapeop_ruled_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("strip_count", c_uint),
        ("joint_count", c_uint),
        ("too_wide_count", c_uint),
        ("largest_deviation", c_double),
        ("rms_deviation", c_double),
        ("largest_uncovered", c_double),
        ("rms_uncovered", c_double),
        ("reference_area", c_double),
        ("trimmed_area", c_double),
        ("coverage", c_double),
        ("largest_gap", c_double),
        ("mean_gap", c_double),
        ("largest_kink", c_double),
        ("mean_kink", c_double),
        ("width_variation", c_double),
        ("overlap", c_double),
    ]


class shapeop_ruled_strip_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("is_too_wide", c_int),
        ("largest_deviation", c_double),
        ("at_x", c_double),
        ("at_y", c_double),
        ("at_z", c_double),
        ("rms_deviation", c_double),
        ("area", c_double),
        ("trimmed_area", c_double),
        ("least_width", c_double),
        ("mean_width", c_double),
        ("greatest_width", c_double),
        ("width_variation", c_double),
        ("width_over_feature", c_double),
        ("feature_size", c_double),
    ]


class shapeop_ruled_joint_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("first", c_int),
        ("second", c_int),
        ("gap_count", c_uint),
        ("kink_count", c_uint),
        ("reserved", c_uint),
        ("largest_gap", c_double),
        ("mean_gap", c_double),
        ("gap_x", c_double),
        ("gap_y", c_double),
        ("gap_z", c_double),
        ("largest_kink", c_double),
        ("mean_kink", c_double),
        ("kink_x", c_double),
        ("kink_y", c_double),
        ("kink_z", c_double),
    ]


class shapeop_ruled_plank_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("has_first_cut", c_int),
        ("thickness", c_double),
        ("depth", c_double),
        ("first_cut", c_double),
        ("tolerance", c_double),
    ]


class shapeop_ruled_planks(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("plank_count", c_uint),
        ("axis_x", c_double),
        ("axis_y", c_double),
        ("axis_z", c_double),
        ("thickness", c_double),
        ("deviation", c_double),
        ("stock_area", c_double),
        ("offcut", c_double),
    ]


class shapeop_ruled_plank(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("reserved", c_uint),
        ("lower", c_double),
        ("upper", c_double),
        ("filled", c_double),
        ("first_u", c_double),
        ("last_u", c_double),
        ("length", c_double),
        ("width", c_double),
        ("first_end_angle", c_double),
        ("second_end_angle", c_double),
        ("offcut", c_double),
    ]


class shapeop_snake_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("arc_count", c_uint),
        ("control_count", c_uint),
        ("is_closed", c_int),
        ("length", c_double),
        ("residual", c_double),
        ("deviation", c_double),
    ]


class shapeop_snake_fit_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("is_congruent", c_int),
        ("max_iterations", c_uint),
        ("reserved", c_uint),
        ("curvature", c_double),
        ("nearness", c_double),
    ]


class shapeop_snake_fit_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("iterations", c_uint),
        ("is_converged", c_int),
        ("reserved", c_uint),
        ("deviation", c_double),
        ("residual", c_double),
    ]


class shapeop_snake_curve_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("turns_right", c_int),
        ("steps", c_uint),
        ("method", c_int),
    ]


class shapeop_snake_curve_report(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("end", c_int),
        ("length", c_double),
        ("curvature", c_double),
        ("normal_curvature", c_double),
    ]


class shapeop_snake_progress(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("step", c_uint),
        ("fraction", c_double),
        ("time", c_double),
        ("deviation", c_double),
        ("residual", c_double),
        ("first_angle", c_double),
        ("last_angle", c_double),
    ]


class shapeop_snake_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_steps", c_uint),
        ("is_second_order", c_int),
        ("keeps_torsions", c_int),
        ("stops_at_cycle", c_int),
        ("is_exact", c_int),
        ("projection_iterations", c_uint),
        ("reserved", c_uint),
        ("step", c_double),
        ("least_step", c_double),
        ("max_deviation", c_double),
        ("tangential", c_double),
        ("offset", c_double),
        ("rotation", c_double),
        ("orthogonal", c_double),
        ("alpha", c_double),
        ("mu", c_double),
        ("surface_weight", c_double),
    ]


class shapeop_snake_evolution(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("stop", c_int),
        ("stop_rail", c_int),
        ("frame_count", c_uint),
        ("stop_distance", c_double),
        ("time", c_double),
        ("deviation", c_double),
        ("residual", c_double),
        ("height_residual", c_double),
        ("incongruence", c_double),
    ]


class shapeop_snake_projection(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("iterations", c_uint),
        ("steps", c_uint),
        ("is_nearest", c_int),
        ("residual", c_double),
        ("moved", c_double),
    ]


class shapeop_snake_cycle_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("max_steps", c_uint),
        ("is_reversed", c_int),
        ("reserved", c_uint),
        ("step", c_double),
    ]


class shapeop_snake_cycle(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("end", c_int),
        ("free", c_uint),
        ("frame_count", c_uint),
        ("first_turns", c_int),
        ("last_turns", c_int),
        ("switch_count", c_uint),
        ("reserved", c_uint),
        ("closing", c_double),
        ("first_range", c_double),
        ("last_range", c_double),
        ("residual", c_double),
    ]


class shapeop_snake_covering_options(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("per_arc", c_uint),
        ("comes_back", c_int),
        ("reserved", c_uint),
        ("tolerance", c_double),
        ("distance", c_double),
    ]


class shapeop_snake_covering(ctypes.Structure):
    _fields_ = [
        ("struct_size", c_uint),
        ("position_count", c_uint),
        ("arc_count", c_uint),
        ("kind_count", c_uint),
        ("is_compared", c_int),
        ("beyond_count", c_uint),
        ("length", c_double),
        ("area", c_double),
        ("residual", c_double),
        ("reference_area", c_double),
        ("coverage", c_double),
        ("distance", c_double),
        ("largest_deviation", c_double),
        ("at_x", c_double),
        ("at_y", c_double),
        ("at_z", c_double),
        ("rms_deviation", c_double),
    ]


shapeop_progress_callback = CFUNCTYPE(c_int, POINTER(shapeop_progress), c_void_p)
shapeop_canal_progress_callback = CFUNCTYPE(c_int, POINTER(shapeop_canal_progress), c_void_p)
shapeop_ruled_progress_callback = CFUNCTYPE(c_int, POINTER(shapeop_ruled_progress), c_void_p)
shapeop_snake_progress_callback = CFUNCTYPE(c_int, POINTER(shapeop_snake_progress), c_void_p)

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
    "shapeop_setBackend": (c_int, [c_void_p, c_int]),
    "shapeop_getBackend": (c_int, [c_void_p]),
    "shapeop_setBackendOptions": (c_int, [c_void_p, c_char_p, c_double, c_double]),
    "shapeop_backendInfo": (c_int, [c_void_p, POINTER(shapeop_backend_info)]),
    "shapeop_backendReason": (c_char_p, [c_void_p]),
    "shapeop_releaseBackend": (c_int, []),
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
    "shapeop_canalCreate": (c_void_p, [POINTER(c_double), c_int, c_int, c_int, POINTER(c_double), c_int]),
    "shapeop_canalFromJson": (c_void_p, [c_char_p]),
    "shapeop_canalCopy": (c_void_p, [c_void_p]),
    "shapeop_canalDelete": (None, [c_void_p]),
    "shapeop_canalText": (c_char_p, [c_void_p]),
    "shapeop_canalFamily": (c_char_p, [c_void_p]),
    "shapeop_canalKind": (c_int, [c_void_p]),
    "shapeop_canalChainCount": (c_int, [c_void_p]),
    "shapeop_canalSize": (c_int, [c_void_p, POINTER(c_int), POINTER(c_int), POINTER(c_int)]),
    "shapeop_canalPoints": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_canalFrames": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_canalBasePoints": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_canalRestoredPoints": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_canalInvert": (c_int, [c_void_p, POINTER(c_double), c_double]),
    "shapeop_canalTranslate": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_canalScale": (c_int, [c_void_p, c_double]),
    "shapeop_canalRotate": (c_int, [c_void_p, POINTER(c_double), c_double]),
    "shapeop_canalCombescureFactors": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_double), c_int]),
    "shapeop_canalUndo": (c_int, [c_void_p]),
    "shapeop_canalRefined": (c_void_p, [c_void_p, c_int, c_int]),
    "shapeop_canalRefinedAt": (c_void_p, [c_void_p, POINTER(c_double), c_int, POINTER(c_double), c_int]),
    "shapeop_canalEvaluate": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            c_double,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalClosingGap": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_canalMembraneResidual": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_canalMembraneResidualOf": (
        c_int,
        [
            c_void_p,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCreateWithKinks": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            c_int,
            POINTER(c_int),
            POINTER(c_double),
            c_int,
        ],
    ),
    "shapeop_canalKinks": (
        c_int,
        [
            c_void_p,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCheckCircular": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCheckParallel": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalGridLengths": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalPolylineLengths": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCloseLengths": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCombescure": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalParallelSpace": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_canalNearestParallel": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
        ],
    ),
    "shapeop_canalGridOfMesh": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_canalFrameOfAngles": (c_int, [c_double, c_double, c_double, POINTER(c_double)]),
    "shapeop_canalFrameOfTangent": (c_int, [POINTER(c_double), POINTER(c_double), c_int, POINTER(c_double)]),
    "shapeop_canalFrameAcross": (c_int, [POINTER(c_double), POINTER(c_double), c_int, POINTER(c_double)]),
    "shapeop_canalGridFrames": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalFolds": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalInvertPoints": (c_int, [POINTER(c_double), c_int, POINTER(c_double), c_double, POINTER(c_double)]),
    "shapeop_canalInvertComplex": (c_int, [POINTER(c_double), c_int, POINTER(c_double), c_double, POINTER(c_double)]),
    "shapeop_canalInvertCircle": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalInvertSphere": (
        c_int,
        [
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalInvertPlane": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalDefaultSmoothOptions": (c_int, [POINTER(shapeop_canal_smooth_options)]),
    "shapeop_canalSmooth": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(shapeop_canal_smooth_options),
            shapeop_canal_progress_callback,
            c_void_p,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(shapeop_canal_smooth_report),
        ],
    ),
    "shapeop_canalStripEnergy": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalStrip": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_uint,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalStripOfRadii": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_uint,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalStripOfBorderEdges": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalLengthsBetween": (c_int, [POINTER(c_double), c_int, c_double, c_double, POINTER(c_double)]),
    "shapeop_canalEdgesOfBorder": (c_int, [POINTER(c_double), c_int, c_double, POINTER(c_double)]),
    "shapeop_canalStripCircles": (c_int, [POINTER(c_double), POINTER(c_double), c_int, POINTER(c_double)]),
    "shapeop_canalStripOfCircles": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalHolonomy": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalClosedFrame": (c_int, [POINTER(c_double), c_int, POINTER(c_double), POINTER(c_double)]),
    "shapeop_canalParallelOnSphere": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCloseCircles": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCloseStrip": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCurvePoints": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
        ],
    ),
    "shapeop_canalNormals": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            c_int,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalTouchingSpheres": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCharacteristicCircles": (c_int, [POINTER(c_double), c_int, POINTER(c_double)]),
    "shapeop_canalDefaultFitOptions": (c_int, [POINTER(shapeop_canal_fit_options)]),
    "shapeop_canalFit": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            c_int,
            POINTER(shapeop_canal_fit_options),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_double),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            POINTER(shapeop_canal_fit_report),
        ],
    ),
    "shapeop_canalSectionPoints": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(shapeop_canal_fit_options),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalMeshCircles": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            c_int,
            POINTER(c_double),
        ],
    ),
    "shapeop_canalColumn": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalRevolution": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_double,
            c_int,
        ],
    ),
    "shapeop_canalMoulding": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalMonge": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalTranslation": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalCenters": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCenter": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalMRevolution": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalSphericalMRevolution": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            c_int,
            c_int,
            c_double,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalMMoulding": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalCCanal": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            shapeop_canal_progress_callback,
            c_void_p,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalFamilyCount": (c_int, []),
    "shapeop_canalFamilyName": (c_char_p, [c_int]),
    "shapeop_canalFamilySteps": (c_int, [c_char_p, POINTER(c_int), POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_canalProperties": (c_int, [c_void_p, POINTER(shapeop_canal_properties)]),
    "shapeop_canalNodeAxes": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalNodeAxesOfLeastGaps": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            shapeop_canal_progress_callback,
            c_void_p,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
        ],
    ),
    "shapeop_canalNodeGaps": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalOffset": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            POINTER(c_double),
        ],
    ),
    "shapeop_canalBeams": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            POINTER(c_int),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_canalPanels": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_canalPartsText": (
        c_char_p,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            c_double,
        ],
    ),
    "shapeop_ruledDefaultOptions": (c_int, [POINTER(shapeop_ruled_options)]),
    "shapeop_ruledCreate": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(shapeop_ruled_options),
        ],
    ),
    "shapeop_ruledCopy": (c_void_p, [c_void_p]),
    "shapeop_ruledDelete": (None, [c_void_p]),
    "shapeop_ruledSelectFamily": (c_int, [c_void_p, c_int, POINTER(c_double), c_int]),
    "shapeop_ruledTriangles": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledCurvatures": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledDirections": (c_int, [c_void_p, c_int, POINTER(c_double), POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledField": (c_int, [c_void_p, POINTER(c_double), POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledFlips": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledTrace": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            c_double,
            c_double,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledDefaultLevelOptions": (c_int, [c_int, POINTER(shapeop_ruled_level_options)]),
    "shapeop_ruledSetLevelBoundaries": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_ruled_level_options),
            c_int,
            c_double,
            POINTER(c_double),
            c_int,
            POINTER(shapeop_ruled_boundary_options),
            shapeop_ruled_progress_callback,
            c_void_p,
        ],
    ),
    "shapeop_ruledSetLevels": (
        c_int,
        [
            c_void_p,
            c_int,
            c_double,
            POINTER(c_double),
            c_int,
            POINTER(shapeop_ruled_boundary_options),
        ],
    ),
    "shapeop_ruledLevelValues": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledLevelHistory": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledCriticalPoints": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledLevelReport": (c_int, [c_void_p, POINTER(shapeop_ruled_level_report)]),
    "shapeop_ruledDefaultBoundaryOptions": (c_int, [POINTER(shapeop_ruled_boundary_options)]),
    "shapeop_ruledSetPlanarBoundaries": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            c_double,
            c_int,
            POINTER(shapeop_ruled_boundary_options),
            POINTER(c_double),
        ],
    ),
    "shapeop_ruledSetGreatCircleBoundaries": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            POINTER(shapeop_ruled_boundary_options),
        ],
    ),
    "shapeop_ruledGreatCircle": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledSetDrawnBoundaries": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            POINTER(shapeop_ruled_boundary_options),
        ],
    ),
    "shapeop_ruledBoundaryCount": (c_int, [c_void_p]),
    "shapeop_ruledBoundary": (
        c_int,
        [
            c_void_p,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_ruledBoundaryAxis": (c_int, [c_void_p, c_int, POINTER(c_double), POINTER(c_double)]),
    "shapeop_ruledBoundaryPairs": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledUnmatchedLevels": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledDroppedCurves": (c_int, [c_void_p, POINTER(c_double), POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledStart": (c_int, [c_void_p, c_int, c_int]),
    "shapeop_ruledStarted": (c_int, [c_void_p, POINTER(c_int), POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledStripCount": (c_int, [c_void_p]),
    "shapeop_ruledJoints": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int), POINTER(c_int)]),
    "shapeop_ruledControl": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, POINTER(c_int), POINTER(c_int)]),
    "shapeop_ruledKnots": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledSetControl": (c_int, [c_void_p, c_int, POINTER(c_double), c_int]),
    "shapeop_ruledSetStripsText": (c_int, [c_void_p, c_char_p]),
    "shapeop_ruledStripsText": (c_char_p, [c_void_p]),
    "shapeop_ruledEvaluate": (
        c_int,
        [
            c_void_p,
            c_int,
            c_double,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_ruledConstrainPlane": (c_int, [c_void_p, c_int, POINTER(c_double)]),
    "shapeop_ruledConstrainCutPlanes": (c_int, [c_void_p]),
    "shapeop_ruledConstrainPoint": (c_int, [c_void_p, c_int, c_int, c_int, POINTER(c_double)]),
    "shapeop_ruledConstrainEnds": (c_int, [c_void_p]),
    "shapeop_ruledConstrainEndDirection": (c_int, [c_void_p, c_int, c_int, POINTER(c_double)]),
    "shapeop_ruledConstrainConoid": (c_int, [c_void_p, c_int, POINTER(c_double)]),
    "shapeop_ruledConditionCount": (c_int, [c_void_p]),
    "shapeop_ruledClearConditions": (c_int, [c_void_p]),
    "shapeop_ruledDefaultOptimiseOptions": (c_int, [POINTER(shapeop_ruled_optimise_options)]),
    "shapeop_ruledOptimise": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_ruled_optimise_options),
            shapeop_ruled_progress_callback,
            c_void_p,
            POINTER(shapeop_ruled_optimise_report),
        ],
    ),
    "shapeop_ruledHistory": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledDefaultReportOptions": (c_int, [POINTER(shapeop_ruled_report_options)]),
    "shapeop_ruledReport": (c_int, [c_void_p, POINTER(shapeop_ruled_report_options), POINTER(shapeop_ruled_report)]),
    "shapeop_ruledStripReport": (c_int, [c_void_p, c_int, POINTER(shapeop_ruled_strip_report)]),
    "shapeop_ruledJointReport": (c_int, [c_void_p, c_int, POINTER(shapeop_ruled_joint_report)]),
    "shapeop_ruledTooWide": (c_int, [c_void_p, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_ruledReportText": (c_char_p, [c_void_p]),
    "shapeop_ruledMesh": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledTrimmedMesh": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledRulings": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_ruledSurfacesObj": (c_char_p, [c_void_p]),
    "shapeop_ruledRulingsObj": (c_char_p, [c_void_p, c_int]),
    "shapeop_ruledRulingsCsv": (c_char_p, [c_void_p, c_int]),
    "shapeop_ruledZebra": (
        c_int,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(c_double),
        ],
    ),
    "shapeop_ruledDefaultPlankOptions": (c_int, [POINTER(shapeop_ruled_plank_options)]),
    "shapeop_ruledStripAxis": (c_int, [c_void_p, c_int, POINTER(c_double), POINTER(c_double)]),
    "shapeop_ruledCutPlanks": (
        c_int,
        [
            c_void_p,
            c_int,
            POINTER(shapeop_ruled_plank_options),
            POINTER(c_double),
            POINTER(shapeop_ruled_planks),
        ],
    ),
    "shapeop_ruledPlank": (
        c_int,
        [
            c_void_p,
            c_int,
            POINTER(shapeop_ruled_plank),
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_ruledDowels": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_ruledPlanksText": (c_char_p, [c_void_p]),
    "shapeop_ruledPlanksSvg": (c_char_p, [c_void_p, c_char_p, c_double]),
    "shapeop_snakeCreate": (c_void_p, [POINTER(c_double), c_int, c_int, c_double]),
    "shapeop_snakeCreateFromArcs": (
        c_void_p,
        [
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
        ],
    ),
    "shapeop_snakeCopy": (c_void_p, [c_void_p]),
    "shapeop_snakeDelete": (None, [c_void_p]),
    "shapeop_snakeReport": (c_int, [c_void_p, POINTER(shapeop_snake_report)]),
    "shapeop_snakeControl": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeSetControl": (c_int, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_snakeContacts": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeShapes": (c_int, [c_void_p, POINTER(c_double), POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeTorsions": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeArcs": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeSample": (c_int, [c_void_p, c_int, c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeFreedoms": (c_int, [c_void_p, c_int, POINTER(c_int), POINTER(c_int), POINTER(c_int)]),
    "shapeop_snakeDefaultFitOptions": (c_int, [POINTER(shapeop_snake_fit_options)]),
    "shapeop_snakeFit": (
        c_void_p,
        [
            POINTER(c_double),
            c_int,
            c_int,
            c_int,
            POINTER(shapeop_snake_fit_options),
            POINTER(shapeop_snake_fit_report),
        ],
    ),
    "shapeop_snakeDefaultCurveOptions": (c_int, [POINTER(shapeop_snake_curve_options)]),
    "shapeop_snakeCurve": (
        c_int,
        [
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(shapeop_snake_curve_options),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(shapeop_snake_curve_report),
        ],
    ),
    "shapeop_snakeMeshCurve": (
        c_int,
        [
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_double),
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            c_double,
            POINTER(shapeop_snake_curve_options),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(shapeop_snake_curve_report),
        ],
    ),
    "shapeop_snakeSetMesh": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            c_int,
            POINTER(c_int),
            c_int,
        ],
    ),
    "shapeop_snakeSetSurface": (c_int, [c_void_p, c_int, POINTER(c_double), c_int]),
    "shapeop_snakeClearSurface": (c_int, [c_void_p]),
    "shapeop_snakeSetDirection": (c_int, [c_void_p, c_int, POINTER(c_double)]),
    "shapeop_snakeSetSpeeds": (c_int, [c_void_p, POINTER(c_double), c_int]),
    "shapeop_snakeSetFixed": (c_int, [c_void_p, POINTER(c_int), c_int]),
    "shapeop_snakeWishVelocity": (c_int, [c_void_p, c_int, POINTER(c_double), c_double]),
    "shapeop_snakeWishPlane": (c_int, [c_void_p, c_int, POINTER(c_double), c_double]),
    "shapeop_snakeClearWishes": (c_int, [c_void_p]),
    "shapeop_snakeDriveRail": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, c_int, c_double]),
    "shapeop_snakeFollowRail": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, c_int, c_int]),
    "shapeop_snakeGlideRail": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, c_int]),
    "shapeop_snakeRailCount": (c_int, [c_void_p]),
    "shapeop_snakeClearRails": (c_int, [c_void_p]),
    "shapeop_snakeDefaultOptions": (c_int, [POINTER(shapeop_snake_options)]),
    "shapeop_snakeVelocity": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_snake_options),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_double),
        ],
    ),
    "shapeop_snakeProject": (
        c_int,
        [
            c_void_p,
            POINTER(c_double),
            c_int,
            POINTER(shapeop_snake_options),
            POINTER(shapeop_snake_projection),
        ],
    ),
    "shapeop_snakeEvolve": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_snake_options),
            shapeop_snake_progress_callback,
            c_void_p,
            POINTER(shapeop_snake_evolution),
        ],
    ),
    "shapeop_snakeFrameCount": (c_int, [c_void_p]),
    "shapeop_snakeFrames": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeFrameRows": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeTakeFrame": (c_int, [c_void_p, c_int]),
    "shapeop_snakeCongruence": (c_int, [c_void_p, c_int, c_int, POINTER(c_double), POINTER(c_double)]),
    "shapeop_snakeDefaultCycleOptions": (c_int, [POINTER(shapeop_snake_cycle_options)]),
    "shapeop_snakeCycle": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_snake_cycle_options),
            shapeop_snake_progress_callback,
            c_void_p,
            POINTER(shapeop_snake_cycle),
        ],
    ),
    "shapeop_snakeLinkageFreedoms": (c_int, [c_void_p]),
    "shapeop_snakeDeterminant": (c_int, [c_void_p, POINTER(c_double)]),
    "shapeop_snakeCycleAngles": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeContactPath": (c_int, [c_void_p, c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeAtPhases": (c_int, [c_void_p, POINTER(c_double), c_int, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeCopies": (
        c_int,
        [
            c_void_p,
            c_int,
            c_double,
            c_double,
            POINTER(c_double),
            POINTER(c_double),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_snakeSweepMesh": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_snakePipe": (
        c_int,
        [
            c_void_p,
            c_int,
            c_double,
            c_int,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_snakeLamellae": (
        c_int,
        [
            c_void_p,
            c_int,
            c_int,
            POINTER(c_double),
            c_double,
            c_int,
            POINTER(c_double),
            c_int,
            POINTER(c_int),
            POINTER(c_int),
            c_int,
            POINTER(c_int),
        ],
    ),
    "shapeop_snakeKinds": (c_int, [c_void_p, c_double, POINTER(c_double), c_int, POINTER(c_int)]),
    "shapeop_snakeKindOf": (c_int, [c_void_p, c_double, POINTER(c_int), c_int, POINTER(c_int)]),
    "shapeop_snakeDefaultCoveringOptions": (c_int, [POINTER(shapeop_snake_covering_options)]),
    "shapeop_snakeCovering": (
        c_int,
        [
            c_void_p,
            POINTER(shapeop_snake_covering_options),
            POINTER(shapeop_snake_covering),
        ],
    ),
    "shapeop_snakeCoveringText": (c_char_p, [c_void_p, POINTER(shapeop_snake_covering_options)]),
    "shapeop_snakeCreateFromText": (c_void_p, [c_char_p]),
    "shapeop_snakeText": (c_char_p, [c_void_p]),
    "shapeop_snakeArcsText": (c_char_p, [c_void_p, c_int, c_double]),
    "shapeop_snakeArcsCsv": (c_char_p, [c_void_p, c_int, c_double]),
    "shapeop_snakeKindsCsv": (c_char_p, [c_void_p, c_int, c_double]),
    "shapeop_snakeArcsDxf": (c_char_p, [c_void_p, c_int, c_double]),
}


def declare(library):
    """Tells ctypes what the functions of a loaded library take and return."""
    for name, (result, arguments) in FUNCTIONS.items():
        function = getattr(library, name)
        function.restype = result
        function.argtypes = arguments
    return library
