"""The solver."""

from __future__ import annotations

import ctypes
import weakref
from bisect import bisect_right
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, Optional, Union, overload

from . import _abi, _arrays
from ._library import (
    ArgumentError,
    ArgumentTypeError,
    ClosedError,
    ErrorCode,
    UnknownIdError,
    check,
    check_message,
    lib,
    text,
)
from ._progress import ProgressFunction, Watch
from .backend import BackendInfo, info_of
from .exploration import HARD, Exploring
from .report import Acceleration, Backend, LinearSolver, Report, report_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._arrays import Doubles, Ids, Numbers, PointsLike, ScalarsLike


_MOST_BYTES = 1 << 53
"""Bytes from which on doubles, in which the library takes them, skip whole numbers."""


class Solver(Exploring):
    """Points, constraints and forces, and the solver that finds the shape that meets them.

    ``points``: an (n, 3) array or a list of ``[x, y, z]``, in model units; they may also be set later.

    A solver belongs to the library. It is deleted by :meth:`close`, at the end of a ``with`` block, or when nothing
    refers to it any more. Any thread may use it; a call while another thread's call is using it raises
    :class:`BusyError`. Calls that are refused change nothing and raise an :class:`Error`.

    >>> with Solver([[0, 0, 0.1], [1, 0, -0.1], [1, 1, 0.1], [0, 1, -0.1]]) as solver:
    ...     plane = solver.add("Plane", [0, 1, 2, 3])
    ...     solver.init()
    ...     report = solver.solve_until()
    ...     violation = solver.violations[plane]
    >>> report.outcome.name
    'CONVERGED'
    """

    def __init__(self, points: Optional[PointsLike] = None) -> None:
        block = None if points is None else _arrays.points(points)
        handle = lib.shapeop_create()
        if handle is None:
            check_message()
        self._open_handle: Optional[int] = handle
        self._finalizer = weakref.finalize(self, lib.shapeop_delete, handle)
        # When to stop unless the caller says otherwise; a problem brings its own.
        self._options = _abi.shapeop_solve_options(struct_size=ctypes.sizeof(_abi.shapeop_solve_options))
        check(lib.shapeop_defaultSolveOptions(ctypes.byref(self._options)))
        # Runs of ids of one type: where each begins, and the type, for `edit` without a type.
        self._run_starts: list[int] = []
        self._run_types: list[str] = []
        if block is not None:
            self._set_points(block)

    def _set_problem(self, json: bytes, types: Sequence[str]) -> None:
        """Makes this the solver of a problem, whose constraints have the `types`."""
        check(lib.shapeop_setProblem(self._handle, json, ctypes.byref(self._options)), self._handle)
        self._run_starts, self._run_types = [], []
        for first, type_name in enumerate(types):
            self._note_type(first, type_name)

    def _note_type(self, first: int, type_name: str) -> None:
        if not self._run_types or self._run_types[-1] != type_name:
            self._run_starts.append(first)
            self._run_types.append(type_name)

    # Ownership.

    @property
    def _handle(self) -> int:
        if self._open_handle is None:
            raise ClosedError("the solver was closed", ErrorCode.INVALID_HANDLE)
        return self._open_handle

    def close(self) -> None:
        """Deletes the solver; every later call raises :class:`ClosedError`, except this one.

        Raises :class:`BusyError` if another call is using it.
        """
        if self._open_handle is not None:
            lib.shapeop_delete(self._open_handle)
            check_message()
            self._open_handle = None
            self._finalizer.detach()

    @property
    def is_closed(self) -> bool:
        """Whether it was closed."""
        return self._open_handle is None

    def __enter__(self) -> Solver:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.is_closed:
            return "<shapeop.Solver, closed>"
        return f"<shapeop.Solver of {lib.shapeop_pointCount(self._handle)} points>"

    # Points.

    def _set_points(self, block: _arrays.Block) -> None:
        lib.shapeop_setPoints(self._handle, block.pointer, block.length)
        check_message(self._handle)

    @property
    def point_count(self) -> int:
        """The number of points."""
        return self._count(lib.shapeop_pointCount(self._handle))

    @property
    def points(self) -> Doubles:
        """The positions in model units: a new (n, 3) float64 array; without numpy, a list of ``[x, y, z]``.

        Setting replaces the positions only: rest states, targets and velocities stay. A C-contiguous float64 array is
        passed without a copy. Their number may change as long as no constraint or force refers beyond it.
        """
        return self.get_points()

    @points.setter
    def points(self, points: PointsLike) -> None:
        self._set_points(_arrays.points(points))

    def get_points(self, out: Optional[Doubles] = None) -> Doubles:
        """The positions, as :attr:`points`; filled into ``out`` without a copy if it is given.

        ``out`` is a writable, C-contiguous float64 array of shape (n, 3), and is returned.
        """
        if out is not None:
            is_fit = _arrays.is_array(out) and out.dtype == float and out.dtype.isnative and out.flags.carray
            if not is_fit:
                expected = "a writable C-contiguous array of float64"
                raise ArgumentTypeError(f"out: expected {expected}, found {_arrays.found(out)}")
        count = self.point_count
        if out is not None and out.shape != (count, 3):
            raise ArgumentError(f"out: expected an array of shape ({count}, 3), found {_arrays.found(out)}")
        if out is None and _arrays.numpy is None:
            flat = (ctypes.c_double * (3 * count))()
            self._fill_points(flat, count)
            rows = iter(flat)
            return list(map(list, zip(rows, rows, rows)))
        if out is None:
            out = _arrays.numpy.empty((count, 3))
        self._fill_points(out.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), count)
        return out

    def _fill_points(self, pointer: Any, count: int) -> None:
        lib.shapeop_getPoints(self._handle, pointer, count)
        check_message(self._handle)

    # Constraints.

    @overload
    def add(
        self,
        type_name: str,
        indices: Sequence[int],
        *,
        weight: Numbers = 1.0,
        scalars: Optional[ScalarsLike] = None,
        hard: bool = False,
    ) -> int: ...

    @overload
    def add(
        self,
        type_name: str,
        indices: Sequence[Sequence[int]],
        *,
        weight: Numbers = 1.0,
        scalars: Optional[ScalarsLike] = None,
        hard: bool = False,
    ) -> range: ...

    @overload
    def add(
        self,
        type_name: str,
        indices: NDArray[Any],
        *,
        weight: Numbers = 1.0,
        scalars: Optional[ScalarsLike] = None,
        hard: bool = False,
    ) -> Any: ...

    def add(
        self,
        type_name: str,
        indices: Any,
        *,
        weight: Numbers = 1.0,
        scalars: Optional[ScalarsLike] = None,
        hard: bool = False,
    ) -> Union[int, range]:
        """Adds one constraint, or many of one type at once (all or none), at rest where the points are now.

        ``type_name``: see :func:`constraint_types`.
        ``indices``: one list (or 1-D integer array) of point indices adds one constraint and returns its id; a list of
        such lists, of different lengths or not, or an (n, k) integer array adds n and returns their ids as a ``range``.
        ``weight``: a number for all, or one per constraint; at least 0.
        ``scalars``: ``None`` for the defaults of the type; a flat list for all; or one such list per constraint. A
        shape may be nested, as a list of ``[x, y, z]``.
        ``hard``: whether they are to be met exactly (static mode); see :meth:`set_hard`.

        Ids count up from 0 and are never reused. Raises :class:`InvalidValueError` or :class:`IndexRangeError` for what
        the library refuses, :class:`ArgumentError` or :class:`ArgumentTypeError` for wrong shapes and types.
        """
        name = _arrays.name_bytes(type_name, "type_name")
        lists = _arrays.index_lists(indices, "indices")
        weights = _arrays.numbers(weight, "weight")
        sets, set_count = _arrays.scalar_sets(scalars, "scalars", None if lists.is_one else lists.list_count)
        flags = HARD if _arrays.truth(hard, "hard") else 0
        if lists.list_count == 0:
            return range(0)
        if weights.length not in (1, lists.list_count):
            found = f"found {weights.length} numbers"
            raise ArgumentError(f"weight: expected a number, or {lists.list_count}, one per constraint; {found}")
        ids = (ctypes.c_int * lists.list_count)()
        # One count stands for all.
        code = lib.shapeop_addConstraints(
            *(self._handle, name, *lists.indices, *lists.counts, *weights, *sets, set_count, flags, ids)
        )
        check(code, self._handle)
        first = ids[0]
        self._note_type(first, type_name)
        return first if lists.is_one else range(first, first + lists.list_count)

    def edit(self, type_name: Optional[str], ids: Ids, scalars: ScalarsLike) -> None:
        """Replaces the scalars of constraints, all or none. The next solve uses them; unchanged ones cost nothing.

        ``type_name``: the type that they were added with, or ``None`` to look it up.
        ``ids``: an id, or a list, range or 1-D integer array of ids of one type.
        ``scalars``: as for :meth:`add`.
        """
        if not hasattr(ids, "__len__"):
            one = _arrays.integer(ids, "ids")
            block, _ = _arrays.scalar_sets(scalars, "scalars", None)
            name = _arrays.name_bytes(type_name or self._type_of([one]), "type_name")
            check(lib.shapeop_editConstraint(self._handle, name, one, *block), self._handle)
            return
        many = _arrays.ids(ids, "ids")
        block, set_count = _arrays.scalar_sets(scalars, "scalars", many.length)
        if many.length > 0:
            name = _arrays.name_bytes(type_name or self._type_of(ids), "type_name")
            check(lib.shapeop_editConstraints(self._handle, name, *many, *block, set_count), self._handle)

    def _type_of(self, ids: Any) -> str:
        """The one type of all constraints in `ids`; an unknown id is the library's to refuse, under any type."""
        if not self._run_types:
            raise UnknownIdError(
                f"ids: expected constraint ids, found {_arrays.found(ids)}, but no constraint was added"
            )
        runs = {bisect_right(self._run_starts, i) - 1 for i in ids}
        names = sorted({self._run_types[max(run, 0)] for run in runs})
        if len(names) > 1:
            raise ArgumentError(f"ids: expected constraints of one type, found {' and '.join(names)}")
        return names[0]

    def set_weights(self, ids: Ids, weight: Numbers) -> None:
        """Sets the weights of constraints, all or none: an id or many; a number for all or one per id; at least 0."""
        many = _arrays.ids(ids if hasattr(ids, "__len__") else [ids], "ids")
        weights = _arrays.numbers(weight, "weight")
        check(lib.shapeop_setWeights(self._handle, *many, *weights), self._handle)

    def remove(self, ids: Ids) -> None:
        """Removes constraints, all or none: an id or many.

        The ids are never given out again; arrays with one entry per id keep their place.
        """
        many = _arrays.ids(ids if hasattr(ids, "__len__") else [ids], "ids")
        once = list(dict.fromkeys(many.pointer[: many.length]))
        # One that does not exist goes first: it is refused before any other is removed.
        for one in sorted(once, key=lambda id: lib.shapeop_isConstraint(self._handle, id) == 1):
            check(lib.shapeop_removeConstraint(self._handle, one), self._handle)

    @property
    def constraint_count(self) -> int:
        """The number of constraint ids given out, removed ones included: the length of :attr:`violations`."""
        return self._count(lib.shapeop_constraintCount(self._handle))

    def is_constraint(self, id: int) -> bool:
        """Whether ``id`` is a constraint: false if it was removed or never given out."""
        return self._count(lib.shapeop_isConstraint(self._handle, _arrays.integer(id, "id"))) == 1

    def is_degenerate(self, id: int) -> bool:
        """Whether the constraint's rest state spans too little to say what it asks for (a zero-length edge)."""
        return self._count(lib.shapeop_isDegenerate(self._handle, _arrays.integer(id, "id"))) == 1

    @property
    def unconstrained_count(self) -> int:
        """The number of points that no constraint of a weight above 0 holds; in static mode they keep their place."""
        return self._count(lib.shapeop_unconstrainedCount(self._handle))

    @property
    def violations(self) -> Doubles:
        """The violation of every constraint id at the current points, each in its type's unit; 0 for removed ones.

        A new (constraint_count,) float64 array; without numpy, a list.
        """
        count = self.constraint_count
        flat = (ctypes.c_double * count)()
        check(lib.shapeop_getViolations(self._handle, flat, count), self._handle)
        return _arrays.doubles(flat)

    # References.

    def add_reference_polyline(self, points: PointsLike, closed: bool = False) -> int:
        """Adds a polyline for ``OnCurve`` constraints to refer to: its id, which is returned, is their scalar.

        ``points``: as for the solver, at least 2; they are no points of the solver, and are copied.
        ``closed``: whether a segment leads from the last point back to the first.
        """
        block = _arrays.points(points)
        is_closed = int(_arrays.truth(closed, "closed"))
        return self._count(lib.shapeop_addReferencePolyline(self._handle, *block, is_closed))

    def add_reference_mesh(self, points: PointsLike, triangles: Any) -> int:
        """Adds a triangle mesh for ``OnMesh`` constraints to refer to: its id, which is returned, is their scalar.

        ``points``: as for the solver; they are no points of the solver, and are copied.
        ``triangles``: an (m, 3) integer array or a list of three indices into ``points`` each.
        """
        block = _arrays.points(points)
        lists = _arrays.face_lists(triangles, "triangles", 3)
        answer = lib.shapeop_addReferenceMesh(self._handle, *block, lists.indices.pointer, lists.list_count)
        return self._count(answer)

    @property
    def reference_count(self) -> int:
        """The number of references; a problem replaces them."""
        return self._count(lib.shapeop_referenceCount(self._handle))

    # Forces.

    def add_gravity(self, force: Sequence[float]) -> int:
        """Adds ``force`` (x, y, z) on every point and returns its id. In dynamic mode it is an acceleration."""
        return self._count(lib.shapeop_addGravityForce(self._handle, _arrays.vector(force, "force").pointer))

    def add_vertex_force(self, force: Sequence[float], point: int) -> int:
        """Adds ``force`` (x, y, z) on the point ``point`` and returns its id."""
        pointer = _arrays.vector(force, "force").pointer
        return self._count(lib.shapeop_addVertexForce(self._handle, pointer, _arrays.integer(point, "point")))

    def edit_vertex_force(self, id: int, force: Sequence[float], point: int) -> None:
        """Replaces the vertex force ``id`` by ``force`` on the point ``point``."""
        pointer = _arrays.vector(force, "force").pointer
        number, place = _arrays.integer(id, "id"), _arrays.integer(point, "point")
        lib.shapeop_editVertexForce(self._handle, number, pointer, place)
        check_message(self._handle)

    def add_pressure(self, faces: Any, pressure: float) -> int:
        """Adds a pressure on faces and returns the force's id.

        ``faces``: an (m, k) integer array or a list of index lists of at least 3 points; a normal points to where they
        run counter-clockwise. ``pressure``: force per area along the normals; below 0 against them.

        The force on a face, shared among its corners, follows the points, and iterations are plain with it.
        """
        lists, number = _arrays.face_lists(faces, "faces"), _arrays.real(pressure, "pressure")
        return self._count(lib.shapeop_addPressure(self._handle, *lists.indices, *lists.counts, number))

    def add_normal_force(self, faces: Any, magnitude: float) -> int:
        """Adds a force of length ``magnitude`` on every corner of faces, along the normal there; returns its id.

        The normal of a point is that of the sum of the vector areas of the faces around it. Else as
        :meth:`add_pressure`.
        """
        lists, number = _arrays.face_lists(faces, "faces"), _arrays.real(magnitude, "magnitude")
        return self._count(lib.shapeop_addNormalForce(self._handle, *lists.indices, *lists.counts, number))

    def edit_force_magnitude(self, id: int, magnitude: float) -> None:
        """Replaces the pressure, or the length of the normal force, of the force ``id``."""
        number, new = _arrays.integer(id, "id"), _arrays.real(magnitude, "magnitude")
        check(lib.shapeop_editForceMagnitude(self._handle, number, new), self._handle)

    def remove_force(self, id: int) -> None:
        """Removes a force. Its id is never given out again."""
        check(lib.shapeop_removeForce(self._handle, _arrays.integer(id, "id")), self._handle)

    # Solving.

    def init(self) -> None:
        """Prepares for static solving from the current points; velocities start at zero. May be called again."""
        if lib.shapeop_init(self._handle):
            check_message(self._handle)

    def init_dynamic(self, masses: float = 1.0, damping: float = 1.0, timestep: float = 1.0) -> None:
        """Prepares for dynamic solving from the current points with zero velocities.

        ``masses``: of every point, above 0. ``damping``: the factor on velocities after each step, at least 0.
        ``timestep``: in seconds, above 0.
        """
        numbers = (_arrays.real(masses, "masses"), _arrays.real(damping, "damping"), _arrays.real(timestep, "timestep"))
        if lib.shapeop_initDynamic(self._handle, *numbers):
            check_message(self._handle)

    def set_time_step(self, timestep: float) -> None:
        """Changes the time step (seconds, above 0) of the following steps, but not the inertia of ``init_dynamic``."""
        lib.shapeop_setTimeStep(self._handle, _arrays.real(timestep, "timestep"))
        check_message(self._handle)

    def set_damping(self, damping: float) -> None:
        """Changes the damping (at least 0) of the following steps."""
        lib.shapeop_setDamping(self._handle, _arrays.real(damping, "damping"))
        check_message(self._handle)

    def solve(self, iterations: int) -> None:
        """Static: so many plain iterations from the current points. Dynamic: one time step of so many iterations.

        Ctrl-C is answered when the call is over; :meth:`solve_until` answers it after every iteration.
        """
        if lib.shapeop_solve(self._handle, _arrays.integer(iterations, "iterations", 0, _arrays.UINT_MAX)):
            check_message(self._handle)

    def solve_until(
        self,
        max_iterations: Optional[int] = None,
        tolerance: Optional[float] = None,
        time_budget_seconds: Optional[float] = None,
        *,
        progress: Optional[ProgressFunction] = None,
    ) -> Report:
        """Iterates, accelerated, until it converges or may not go on; in dynamic mode within one time step.

        ``max_iterations``: 1000 by default. ``tolerance``: stop when the largest move of a point in an iteration,
        relative to the bounding-box diagonal, is below it; 1e-6 by default, 0 for never. ``time_budget_seconds``: 0,
        the default, for none. A solver made from a :class:`Problem` has the problem's settings as defaults.

        ``progress``: called with a :class:`Progress` after every iteration. If it returns ``False``, the solve ends and
        keeps what was reached; ``None`` or ``True`` go on. An exception in it ends the solve and is raised after; so
        does Ctrl-C. Inside it the solver can be read (points, energy, violations) and nothing else.
        """
        options = _abi.shapeop_solve_options.from_buffer_copy(self._options)
        if max_iterations is not None:
            options.max_iterations = _arrays.integer(max_iterations, "max_iterations", 0, _arrays.UINT_MAX)
        if tolerance is not None:
            options.tolerance = _arrays.real(tolerance, "tolerance")
        if time_budget_seconds is not None:
            options.time_budget_seconds = _arrays.real(time_budget_seconds, "time_budget_seconds")
        if progress is not None and not callable(progress):
            raise ArgumentTypeError(f"progress: expected a function, found {_arrays.found(progress)}")
        report = _abi.shapeop_solve_report(struct_size=ctypes.sizeof(_abi.shapeop_solve_report))
        pointers = ctypes.byref(options), ctypes.byref(report)
        with Watch(progress) as watch:
            code = lib.shapeop_solveUntil(self._handle, pointers[0], watch.callback, None, pointers[1])
            check(code, self._handle)
            message = text(lib.shapeop_lastError(self._handle))
            reason = text(lib.shapeop_backendReason(self._handle))
        return report_of(report, reason, message)

    @property
    def energy(self) -> float:
        """Half the sum of the weighted squared distances to the projections, at the current points.

        In static mode minus the potential of the forces, in dynamic mode plus the inertia of the last step.
        """
        energy = ctypes.c_double()
        check(lib.shapeop_energy(self._handle, ctypes.byref(energy)), self._handle)
        return energy.value

    # How it computes.

    def set_threads(self, count: int) -> None:
        """Sets the number of threads for large problems, at most 1024; 0: as many as the machine has.

        The results are the same bits for any number.
        """
        check(lib.shapeop_setThreadCount(self._handle, _arrays.integer(count, "count")), self._handle)

    def set_acceleration(self, kind: Union[Acceleration, str], memory: int = 0) -> None:
        """Sets how the following solves are accelerated: an :class:`Acceleration` or its name in lower case.

        ``memory``: the number of iterations that are remembered for it, at most 64; 0: the method's default.
        """
        number = _arrays.member(Acceleration, kind, "kind")
        most = _arrays.integer(memory, "memory", 0, _arrays.UINT_MAX)
        check(lib.shapeop_setAcceleration(self._handle, number, most), self._handle)

    def set_linear_solver(self, linear_solver: Union[LinearSolver, str]) -> None:
        """Sets how linear systems are solved: a :class:`LinearSolver` or its name in lower case."""
        number = _arrays.member(LinearSolver, linear_solver, "linear_solver")
        check(lib.shapeop_setLinearSolver(self._handle, number), self._handle)

    @property
    def backend(self) -> Backend:
        """What carries out the iterations of the following solves.

        Setting takes a :class:`Backend` or its name in lower case; ``"gpu"`` raises :class:`BackendError` where there
        is no graphics card, and in a library without the feature ``gpu``. The report of a solve says what ran, and why.
        """
        return Backend(self._count(lib.shapeop_getBackend(self._handle)))

    @backend.setter
    def backend(self, backend: Union[Backend, str]) -> None:
        number = _arrays.member(Backend, backend, "backend")
        check(lib.shapeop_setBackend(self._handle, number), self._handle)

    def set_backend_options(self, adapter: str = "", *, binding_bytes: int = 0, memory_bytes: int = 0) -> None:
        """Chooses the graphics card of the following solves, and how much of it they may use.

        ``adapter``: a part of its name, of any case; empty: any, the fastest kind first. ``binding_bytes``: of one
        binding at most; 0: what the card allows. ``memory_bytes``: that the solver may take of it; 0: no limit.
        """
        name = _arrays.name_bytes(adapter, "adapter")
        most = [
            float(_arrays.integer(number, word, 0, _MOST_BYTES))
            for number, word in ((binding_bytes, "binding_bytes"), (memory_bytes, "memory_bytes"))
        ]
        check(lib.shapeop_setBackendOptions(self._handle, name, *most), self._handle)

    def backend_info(self) -> BackendInfo:
        """The graphics card of this solver. The first call takes a while: it opens it.

        Raises :class:`BackendError` where there is none, and in a library without the feature ``gpu``.
        """
        info = _abi.shapeop_backend_info(struct_size=ctypes.sizeof(_abi.shapeop_backend_info))
        check(lib.shapeop_backendInfo(self._handle, ctypes.byref(info)), self._handle)
        return info_of(info)

    def _count(self, answer: int) -> int:
        """A count, truth or id that the library answered, where -1 is a refusal."""
        if answer < 0:
            check_message(self._handle)
        return answer
