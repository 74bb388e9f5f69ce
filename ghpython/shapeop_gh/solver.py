"""One solver of the native library: Python lists in, Python lists out, a refused call raises ShapeOpError."""

import ctypes

from shapeop_gh import library as native
from shapeop_gh.errors import ShapeOpError


class Solver(object):
    def __init__(self):
        self._library = native.load()
        self._handle = self._library.shapeop_create()
        if not self._handle:
            raise ShapeOpError(native.error_of(self._library, None))
        self._points = None  # a C array that lives as long as the number of points stays

    def delete(self):
        """Frees the solver; every later call is refused by the library."""
        self._library.shapeop_delete(self._handle)

    def set_points(self, coordinates):
        """`coordinates`: x y z of point 0, then of point 1, and so on."""
        array = native.doubles(coordinates, "Points")
        self._library.shapeop_setPoints(self._handle, array, len(array) // 3)
        self._check_text()
        self._points = array

    def points(self):
        self._library.shapeop_getPoints(self._handle, self._points, len(self._points) // 3)
        self._check_text()
        return self._points[:]

    def add(self, type_name, index_lists, weights):
        """Adds constraints of one type with their default scalars; returns their ids. `weights`: one, or one each."""
        ids = (ctypes.c_int * len(index_lists))()
        indices = native.ints([i for one in index_lists for i in one], type_name + " PointIndices")
        counts = native.ints([len(one) for one in index_lists], type_name)
        weights = native.doubles(weights, type_name + " Weights")
        self._check(
            self._library.shapeop_addConstraints(
                self._handle,
                native.to_c(type_name),
                indices,
                len(indices),
                counts,
                len(counts),
                weights,
                len(weights),
                None,
                0,
                0,
                0,
                ids,
            )
        )
        return ids[:]

    def edit(self, type_name, ids, scalar_lists):
        """Replaces the scalars of constraints of one type; `scalar_lists`: one list per id."""
        alike = len(set(len(one) for one in scalar_lists)) == 1
        batches = [(ids, scalar_lists)] if alike else [([i], [s]) for i, s in zip(ids, scalar_lists)]
        for some_ids, some_lists in batches:
            scalars = native.doubles([s for one in some_lists for s in one], type_name + " Scalars")
            c_ids = native.ints(some_ids, "ids")
            self._check(
                self._library.shapeop_editConstraints(
                    self._handle, native.to_c(type_name), c_ids, len(c_ids), scalars, len(scalars), len(some_lists)
                )
            )

    def set_weights(self, ids, weights):
        c_ids, c_weights = native.ints(ids, "ids"), native.doubles(weights, "Weights")
        self._check(self._library.shapeop_setWeights(self._handle, c_ids, len(c_ids), c_weights, len(c_weights)))

    def remove(self, constraint_id):
        self._check(self._library.shapeop_removeConstraint(self._handle, constraint_id))

    def set_hard(self, ids, is_hard):
        """Makes constraints hard, to be met exactly, or soft."""
        for constraint in ids:
            self._check(self._library.shapeop_setHard(self._handle, constraint, int(is_hard)))

    def set_handle(self, point, target):
        """Makes a point a handle, drawn to `target` (x y z), or moves its target."""
        self._check(self._library.shapeop_setHandle(self._handle, point, native.doubles(target, "Handles")))

    def release_handle(self, point):
        self._check(self._library.shapeop_releaseHandle(self._handle, point))

    def set_handle_weight(self, weight):
        """Sets the weight of all handles; the other weights of the objective are the library's defaults."""
        abi = native.declarations()
        objective = abi.shapeop_objective()
        objective.struct_size = ctypes.sizeof(abi.shapeop_objective)
        self._check(self._library.shapeop_defaultObjective(ctypes.byref(objective)))
        objective.handle_weight = native.doubles([weight], "Strength")[0]
        self._check(self._library.shapeop_setObjective(self._handle, ctypes.byref(objective)))

    def conflicts(self):
        """The ids of the hard constraints that contradict each other, as far as the last solve found any."""
        count = self._library.shapeop_getConflicts(self._handle, None, 0)
        if count <= 0:
            self._check_text()
            return []
        ids = (ctypes.c_int * count)()
        self._library.shapeop_getConflicts(self._handle, ids, count)
        self._check_text()
        return ids[:]

    def add_force(self, force, index):
        """A force on the point `index`, or on every point if it is None. Returns the force's id."""
        vector = native.doubles(force, "Force")
        if index is None:
            force_id = self._library.shapeop_addGravityForce(self._handle, vector)
        else:
            force_id = self._library.shapeop_addVertexForce(self._handle, vector, native.ints([index], "Force")[0])
        self._check_text()
        return force_id

    def edit_vertex_force(self, force_id, force, index):
        vector = native.doubles(force, "Force")
        self._library.shapeop_editVertexForce(self._handle, force_id, vector, native.ints([index], "Force")[0])
        self._check_text()

    def remove_force(self, force_id):
        self._check(self._library.shapeop_removeForce(self._handle, force_id))

    def init_static(self):
        self._check(self._library.shapeop_init(self._handle))

    def init_dynamic(self, mass, damping, time_step):
        mass, damping, time_step = native.doubles([mass, damping, time_step], "Mass, Damping, TimeStep")[:]
        self._check(self._library.shapeop_initDynamic(self._handle, mass, damping, time_step))

    def set_damping(self, damping):
        self._library.shapeop_setDamping(self._handle, native.doubles([damping], "Damping")[0])
        self._check_text()

    def set_time_step(self, time_step):
        self._library.shapeop_setTimeStep(self._handle, native.doubles([time_step], "TimeStep")[0])
        self._check_text()

    def accelerate(self):
        """Makes the iterations of `solve` accelerated ones."""
        abi = native.declarations()
        self._check(self._library.shapeop_setAcceleration(self._handle, abi.SO_ACCELERATION_QUASI_NEWTON, 0))

    def solve(self, iterations):
        self._check(self._library.shapeop_solve(self._handle, whole_number(iterations, "Iterations")))

    def solve_until(self, max_iterations, tolerance, seconds):
        """Solves to the end; returns the report (a struct of `_abi`)."""
        abi = native.declarations()
        options = abi.shapeop_solve_options()
        options.struct_size = ctypes.sizeof(abi.shapeop_solve_options)
        options.max_iterations = whole_number(max_iterations, "MaxIterations")
        options.tolerance, options.time_budget_seconds = native.doubles([tolerance, seconds], "Tolerance, Seconds")[:]
        report = abi.shapeop_solve_report()
        report.struct_size = ctypes.sizeof(abi.shapeop_solve_report)
        nothing = abi.shapeop_progress_callback()
        self._check(
            self._library.shapeop_solveUntil(self._handle, ctypes.byref(options), nothing, None, ctypes.byref(report))
        )
        if report.outcome == abi.SO_OUTCOME_UNBOUNDED:
            raise ShapeOpError(native.error_of(self._library, self._handle))
        return report

    def energy(self):
        out = (ctypes.c_double * 1)()
        self._check(self._library.shapeop_energy(self._handle, out))
        return out[0]

    def violations(self):
        """One number per constraint id, in its type's unit."""
        count = self._library.shapeop_constraintCount(self._handle)
        out = (ctypes.c_double * max(count, 0))()
        self._check(self._library.shapeop_getViolations(self._handle, out, count))
        return out[:]

    def _check(self, code):
        if code != 0:
            raise ShapeOpError(native.error_of(self._library, self._handle))

    def _check_text(self):
        """For functions that return no code: the text is empty after a call that succeeded."""
        text = native.error_of(self._library, self._handle)
        if text:
            raise ShapeOpError(text)


def whole_number(value, what):
    number = native.ints([value], what)[0]
    if number < 0:
        raise ShapeOpError("%s: a whole number of at least 0 expected, found %r" % (what, value))
    return number
