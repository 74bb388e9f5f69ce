"""Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018).

A grid is an array of shape (rows, columns, 3), or nested lists; direction 1 goes from row to row, along the guide
curve, direction 2 from column to column, along the section. ``wraps`` says for both whether the first follows the
last. A frame is given by its two unit tangents ``(t1, t2)``, and comes back with the normal as third. A circle is
``[cx, cy, cz, nx, ny, nz, radius]``.

What comes back are float64 arrays, or nested lists where numpy is not installed. What the library refuses raises
:class:`shapeop.Error`; geometry that does not fit (quads without circles, curves that do not meet) a
:class:`shapeop.GeometryError`.
"""

from __future__ import annotations

import ctypes
import signal
import threading
import weakref
from enum import IntEnum
from typing import Any, Callable, NamedTuple, Optional, Union

from . import _abi, _arrays
from ._library import ArgumentError, ClosedError, ErrorCode, check, check_message, lib, text

Wraps = tuple[bool, bool]
ProgressFunction = Callable[[float], object]
"""Called with the part done, 0 to 1; ``False`` (or anything false but ``None``) ends the call with its best so far."""


class Kind(IntEnum):
    """What the base of a surface is."""

    CANAL = _abi.SO_CANAL_KIND_CANAL
    REVOLUTION = _abi.SO_CANAL_KIND_REVOLUTION
    MOULDING = _abi.SO_CANAL_KIND_MOULDING
    CIRCULAR = _abi.SO_CANAL_KIND_CIRCULAR


class Center(IntEnum):
    """Which center of inversion to take."""

    MIDDLE = _abi.SO_CANAL_CENTER_MIDDLE
    ANGLE = _abi.SO_CANAL_CENTER_ANGLE
    RATIO_INSIDE = _abi.SO_CANAL_CENTER_RATIO_INSIDE
    RATIO_OUTSIDE = _abi.SO_CANAL_CENTER_RATIO_OUTSIDE
    POINT = _abi.SO_CANAL_CENTER_POINT
    CHORD = _abi.SO_CANAL_CENTER_CHORD


class Section(IntEnum):
    """Which part of the circles is meshed."""

    WHOLE = _abi.SO_CANAL_SECTION_WHOLE
    ANGLES = _abi.SO_CANAL_SECTION_ANGLES
    TO_CURVE = _abi.SO_CANAL_SECTION_TO_CURVE
    ABOVE = _abi.SO_CANAL_SECTION_ABOVE


class Spacing(IntEnum):
    """How points are spread over a curve."""

    ARC_LENGTH = _abi.SO_CANAL_SPACING_ARC_LENGTH
    PARAMETER = _abi.SO_CANAL_SPACING_PARAMETER
    POINTS = _abi.SO_CANAL_SPACING_POINTS


class Step(IntEnum):
    """What a transformation keeps."""

    SIMILARITY = _abi.SO_CANAL_STEP_SIMILARITY
    MOEBIUS = _abi.SO_CANAL_STEP_MOEBIUS
    COMBESCURE = _abi.SO_CANAL_STEP_COMBESCURE


class Stop(IntEnum):
    """Why smoothing stopped."""

    GRADIENT = _abi.SO_CANAL_STOP_GRADIENT
    DECREASE = _abi.SO_CANAL_STOP_DECREASE
    ITERATIONS = _abi.SO_CANAL_STOP_ITERATIONS
    LINE_SEARCH = _abi.SO_CANAL_STOP_LINE_SEARCH
    CANCELLED = _abi.SO_CANAL_STOP_CANCELLED
    INFEASIBLE = _abi.SO_CANAL_STOP_INFEASIBLE


class Quality(NamedTuple):
    """How circular quads are, one entry each."""

    planarity: Any
    concyclicity: Any
    is_in_order: list[bool]


class Strip(NamedTuple):
    """The border of a strip and how it was made."""

    border: Any
    lengths: Any
    attainable: Any
    is_flipped: list[bool]
    is_projected: list[bool]
    deviation: float


class Smoothed(NamedTuple):
    """A smoothed strip."""

    guide: Any
    border: Any
    frame: Any
    before: float
    after: float
    iterations: int
    stop: Stop


class Holonomy(NamedTuple):
    """How a frame comes back around a closed polygon."""

    matrix: Any
    residual: float
    closes: bool
    tangent: Any


class Closed(NamedTuple):
    """A closed strip."""

    border: Any
    circle: Any
    which_case: int
    is_flipped: list[bool]


class Fit(NamedTuple):
    """A canal surface that fits two curves."""

    surface: CanalSurface
    circles: Any
    spheres: Any
    deviation: float
    residual: float
    tangent_gap: float
    closing_gap: float
    is_outward: bool


class CCanal(NamedTuple):
    """A C-canal surface and how well it meets what was asked for; one entry for each row."""

    surface: CanalSurface
    lengths: Any
    deviations: Any
    is_projected: list[bool]
    is_cancelled: bool


class NodeAxes(NamedTuple):
    """Axes of nodes, (rows, columns, 3), and the gaps of beams of height 1, (rows, columns)."""

    axes: Any
    gaps: Any
    is_cancelled: bool


class Panels(NamedTuple):
    """Flat panels, one for each face."""

    outlines: Any
    lower_outlines: Any
    mitres: Any
    circles: Any
    heights: Any


def _doubles(count: int) -> Any:
    return (ctypes.c_double * max(count, 0))()


def _ints(count: int) -> Any:
    return (ctypes.c_int * max(count, 0))()


def _truths(values: Any) -> list[bool]:
    return [bool(value) for value in values]


def _vector(value: Any, name: str) -> Any:
    return _arrays.vector(value, name).pointer


def _optional(value: Any, name: str) -> Any:
    return None if value is None else _vector(value, name)


def _of_length(values: Any, name: str, count: int) -> Any:
    block = _arrays.numbers(values, name)
    if block.length != count:
        raise ArgumentError(f"{name}: expected {count} numbers, found {block.length}")
    return block.pointer


def _frame(value: Any, name: str = "frame") -> Any:
    rows = [list(row) for row in value]
    if len(rows) not in (2, 3) or any(len(row) != 3 for row in rows):
        raise ArgumentError(f"{name}: expected the tangents t1 and t2, found {_arrays.found(value)}")
    return _arrays.numbers([float(number) for row in rows[:2] for number in row], name).pointer


def _circles(values: Any, name: str) -> _arrays.Block:
    rows = [[float(number) for number in row] for row in values]
    if any(len(row) != 7 for row in rows):
        raise ArgumentError(f"{name}: expected 7 numbers for each circle, found {_arrays.found(values)}")
    return _arrays.Block(_arrays.numbers([number for row in rows for number in row], name).pointer, len(rows))


class _Grid:
    """A grid in the library's layout."""

    def __init__(self, values: Any, wraps: Wraps) -> None:
        if _arrays.is_array(values):
            if values.ndim != 3 or values.shape[2] != 3:
                raise ArgumentError(f"grid: expected shape (rows, columns, 3), found {_arrays.found(values)}")
            self.rows, self.columns = int(values.shape[0]), int(values.shape[1])
            flat = values.reshape(-1, 3)
        else:
            lists = [list(row) for row in values]
            self.rows, self.columns = len(lists), len(lists[0]) if lists else 0
            if any(len(row) != self.columns for row in lists):
                raise ArgumentError("grid: expected rows of one length")
            flat = [point for row in lists for point in row]
        self._points = _arrays.points(flat, "grid")
        self.wraps = [_arrays.truth(wrap, "wraps") for wrap in wraps]
        self.bits = int(self.wraps[0]) | int(self.wraps[1]) << 1
        self.arguments = (self._points.pointer, self.rows, self.columns, self.bits)
        self.count = self.rows * self.columns
        self.spans = (self.rows - 1 + self.wraps[0], self.columns - 1 + self.wraps[1])

    def shaped(self, values: Any) -> Any:
        return _arrays.shaped(values, self.rows, self.columns, 3)

    def axes(self, values: Any) -> Any:
        other = _Grid(values, (False, False))
        if (other.rows, other.columns) != (self.rows, self.columns):
            raise ArgumentError(f"axes: expected shape ({self.rows}, {self.columns}, 3), found {_arrays.found(values)}")
        return other._points.pointer


class _Watch:
    """From the library's progress callback to the caller's: no exception crosses over; Ctrl-C ends the call."""

    def __init__(self, progress: Optional[ProgressFunction]) -> None:
        self._progress = progress
        self._error: Optional[BaseException] = None
        self._interrupted = False
        self._handler: Any = None
        self.callback: Any = _abi.shapeop_canal_progress_callback(self._called)

    def __enter__(self) -> _Watch:
        if threading.current_thread() is threading.main_thread() and callable(signal.getsignal(signal.SIGINT)):
            self._handler = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.callback = None
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
        if error is None and self._error is not None:
            raise self._error
        if error is None and self._interrupted:
            raise KeyboardInterrupt

    def _note(self, number: int, frame: Any) -> None:
        self._interrupted = True

    def _called(self, told: Any, _user: Optional[int]) -> int:
        try:
            if self._interrupted:
                return 1
            answer = None if self._progress is None else self._progress(told.contents.fraction)
            return int(answer is not None and not answer)
        except BaseException as error:
            self._error = error
            return 1


class CanalSurface:
    """A circular net with a frame at each point, and the transformations that made it of its base.

    ``grid``: an array of shape (rows, columns, 3) whose quads have circles; ``frame``: the unit tangents ``(t1, t2)``
    at its first point. It is deleted by :meth:`close`, at the end of a ``with`` block, or when nothing refers to it
    any more.

    >>> torus = CanalSurface.revolution([[2, 0, 0.5], [1.6, 0, 0.3], [1.6, 0, -0.3], [2, 0, -0.5]], columns=12)
    >>> torus.invert([0, 0, 3], 4)
    >>> torus.family
    'M-revolution'
    """

    def __init__(
        self, grid: Any, frame: Any, kind: Union[Kind, str] = Kind.CIRCULAR, wraps: Wraps = (False, False)
    ) -> None:
        number = _arrays.member(Kind, kind, "kind")
        self._open(lib.shapeop_canalCreate(*_Grid(grid, wraps).arguments, _frame(frame), number))

    def _open(self, handle: Optional[int]) -> None:
        if handle is None:
            check_message()
        self._open_handle = handle
        self._finalizer = weakref.finalize(self, lib.shapeop_canalDelete, handle)

    @classmethod
    def _of(cls, handle: Optional[int]) -> CanalSurface:
        surface = cls.__new__(cls)
        surface._open(handle)
        return surface

    # Making.

    @classmethod
    def from_json(cls, json: str) -> CanalSurface:
        """The surface that a text states (``docs/canal.schema.json``)."""
        return cls._of(lib.shapeop_canalFromJson(_arrays.name_bytes(json, "json")))

    @classmethod
    def revolution(
        cls,
        profile: Any,
        axis_point: Any = (0.0, 0.0, 0.0),
        axis_direction: Any = (0.0, 0.0, 1.0),
        angle: float = 6.283185307179586,
        columns: int = 24,
    ) -> CanalSurface:
        """The surface of revolution of a profile in a plane through the axis; a full turn of ``angle`` wraps."""
        block = _arrays.points(profile, "profile")
        point, direction = _vector(axis_point, "axis_point"), _vector(axis_direction, "axis_direction")
        count = _arrays.integer(columns, "columns")
        return cls._of(lib.shapeop_canalRevolution(*block, point, direction, _arrays.real(angle, "angle"), count))

    @classmethod
    def moulding(cls, rail: Any, profile: Any) -> CanalSurface:
        """The moulding surface of a planar rail and a profile in an orthogonal plane that starts on it."""
        rails, profiles = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
        return cls._of(lib.shapeop_canalMoulding(*rails, *profiles, None, None, None))

    @classmethod
    def monge(cls, rail: Any, profile: Any) -> CanalSurface:
        """The Monge surface of a rail in space and a planar profile that starts on it and moves without twist."""
        rails, profiles = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
        return cls._of(lib.shapeop_canalMonge(*rails, *profiles, None, None, None))

    @classmethod
    def m_revolution(
        cls,
        curve: Any,
        p2: Any,
        p3: Any,
        up: Any,
        columns: int,
        center: Union[Center, str] = Center.MIDDLE,
        value: float = 0.0,
        point: Optional[Any] = None,
    ) -> CanalSurface:
        """The M-revolution surface over a planar curve from ``P1`` to ``P4``, whose arches rise to the side of ``up``.

        ``p2`` and ``p3`` are on one circle with the curve's ends. ``center`` says which center of inversion to take,
        with the angle or ratio ``value`` or the ``point``.
        """
        kind = _arrays.member(Center, center, "center")
        handle = lib.shapeop_canalMRevolution(
            *_arrays.points(curve, "curve"),
            _vector(p2, "p2"),
            _vector(p3, "p3"),
            kind,
            _arrays.real(value, "value"),
            _optional(point, "point"),
            _vector(up, "up"),
            _arrays.integer(columns, "columns"),
            None,
            None,
        )
        return cls._of(handle)

    @classmethod
    def spherical_m_revolution(
        cls,
        curve: Any,
        p2: Any,
        p3: Any,
        sphere_center: Any,
        radius: float,
        columns: int,
        is_outside: bool = True,
        pole: Optional[Any] = None,
        center: Union[Center, str] = Center.MIDDLE,
        value: float = 0.0,
        point: Optional[Any] = None,
    ) -> CanalSurface:
        """As :meth:`m_revolution`, over a curve on a sphere; arches rise outside of it or inside."""
        handle = lib.shapeop_canalSphericalMRevolution(
            *_arrays.points(curve, "curve"),
            _vector(p2, "p2"),
            _vector(p3, "p3"),
            _vector(sphere_center, "sphere_center"),
            _arrays.real(radius, "radius"),
            _optional(pole, "pole"),
            int(_arrays.truth(is_outside, "is_outside")),
            _arrays.member(Center, center, "center"),
            _arrays.real(value, "value"),
            _optional(point, "point"),
            _arrays.integer(columns, "columns"),
            None,
            None,
        )
        return cls._of(handle)

    @classmethod
    def m_moulding(
        cls,
        curve: Any,
        rail: Any,
        p3: Optional[Any] = None,
        center: Union[Center, str] = Center.CHORD,
        value: float = 0.0,
        point: Optional[Any] = None,
    ) -> CanalSurface:
        """The M-moulding surface through a planar curve and a rail in space that starts on it.

        ``p3``: the far corner, on one circle with the first point and both ends; without it ``point`` is the center
        of inversion.
        """
        handle = lib.shapeop_canalMMoulding(
            *_arrays.points(curve, "curve"),
            *_arrays.points(rail, "rail"),
            _optional(p3, "p3"),
            _arrays.member(Center, center, "center"),
            _arrays.real(value, "value"),
            _optional(point, "point"),
            None,
            None,
            None,
            None,
        )
        return cls._of(handle)

    # Ownership.

    @property
    def _handle(self) -> int:
        if self._open_handle is None:
            raise ClosedError("the surface was closed", ErrorCode.INVALID_HANDLE)
        return self._open_handle

    def close(self) -> None:
        """Deletes the surface; every later call raises :class:`shapeop.ClosedError`, except this one."""
        if self._open_handle is not None:
            lib.shapeop_canalDelete(self._open_handle)
            check_message()
            self._open_handle = None
            self._finalizer.detach()

    def __enter__(self) -> CanalSurface:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.canal.CanalSurface, closed>"
        rows, columns = self.shape
        return f"<shapeop.canal.CanalSurface {self.family} of {rows} by {columns} points>"

    def copy(self) -> CanalSurface:
        """Another surface like this one."""
        return self._of(lib.shapeop_canalCopy(self._handle))

    # Reading.

    def _size(self) -> tuple[int, int, int]:
        rows, columns, wraps = (ctypes.c_int() for _ in range(3))
        check(lib.shapeop_canalSize(self._handle, ctypes.byref(rows), ctypes.byref(columns), ctypes.byref(wraps)))
        return rows.value, columns.value, wraps.value

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of rows and of columns."""
        return self._size()[:2]

    @property
    def wraps(self) -> Wraps:
        """Whether row 0 follows the last row, and column 0 the last column."""
        bits = self._size()[2]
        return bool(bits & 1), bool(bits & 2)

    def _filled(self, function: Any, *shape: int) -> Any:
        rows, columns = self.shape
        count, total = ctypes.c_int(), 1
        for length in shape:
            total *= length
        values = _doubles(rows * columns * total)
        check(function(self._handle, values, rows * columns, ctypes.byref(count)))
        return _arrays.shaped(values, rows, columns, *shape)

    @property
    def points(self) -> Any:
        """The points, (rows, columns, 3)."""
        return self._filled(lib.shapeop_canalPoints, 3)

    @property
    def frames(self) -> Any:
        """The frames at the points, (rows, columns, 3, 3): t1, t2 and the normal."""
        return self._filled(lib.shapeop_canalFrames, 3, 3)

    @property
    def base_points(self) -> Any:
        """The points of the base."""
        return self._filled(lib.shapeop_canalBasePoints, 3)

    @property
    def restored_points(self) -> Any:
        """The base again, from the net through the inverse chain: :attr:`base_points` to rounding."""
        return self._filled(lib.shapeop_canalRestoredPoints, 3)

    @property
    def family(self) -> str:
        """The name of the family, such as ``MC-canal``."""
        return text(lib.shapeop_canalFamily(self._handle))

    @property
    def kind(self) -> Kind:
        """What the base is."""
        return Kind(lib.shapeop_canalKind(self._handle))

    @property
    def chain_length(self) -> int:
        """The number of transformations."""
        return int(lib.shapeop_canalChainCount(self._handle))

    def to_json(self) -> str:
        """The JSON form: the base and the chain."""
        return text(lib.shapeop_canalText(self._handle))

    def evaluate(self, i: int, j: int, u: float, v: float) -> tuple[Any, Any]:
        """The point and the frame of the patch over face (i, j) at the fractions ``u`` and ``v`` of its arcs."""
        point, frame = _doubles(3), _doubles(9)
        place = (_arrays.integer(i, "i"), _arrays.integer(j, "j"), _arrays.real(u, "u"), _arrays.real(v, "v"))
        check(lib.shapeop_canalEvaluate(self._handle, *place, point, frame))
        return _arrays.doubles(point), _arrays.shaped(frame, 3, 3)

    def refined(self, one: int, two: int) -> CanalSurface:
        """The surface whose faces are cut into ``one`` by ``two`` pieces; points stay. It has no chain."""
        pieces = (_arrays.integer(one, "one"), _arrays.integer(two, "two"))
        return self._of(lib.shapeop_canalRefined(self._handle, *pieces))

    @property
    def closing_gap(self) -> float:
        """How far frames come back from themselves across seams: 0 where the surface is smooth there."""
        gap = ctypes.c_double()
        check(lib.shapeop_canalClosingGap(self._handle, ctypes.byref(gap)))
        return gap.value

    @property
    def membrane_residual(self) -> float:
        """How near forces along lines of curvature come to equilibrium under pressure: 0 in equilibrium, to 1."""
        residual = ctypes.c_double()
        check(lib.shapeop_canalMembraneResidual(self._handle, ctypes.byref(residual)))
        return residual.value

    def properties(self) -> dict[str, Union[int, float]]:
        """What is true of the net, by the names of ``shapeop_canal_properties`` in the C header."""
        told = _abi.shapeop_canal_properties(struct_size=ctypes.sizeof(_abi.shapeop_canal_properties))
        check(lib.shapeop_canalProperties(self._handle, ctypes.byref(told)))
        names = [field[0] for field in told._fields_ if field[0] != "struct_size"]
        return {name: getattr(told, name) for name in names}

    # Transforming.

    def invert(self, center: Any, ratio: float) -> None:
        """Inverts the surface: a point at the vector q from ``center`` goes to ``ratio * q / |q|**2``."""
        check(lib.shapeop_canalInvert(self._handle, _vector(center, "center"), _arrays.real(ratio, "ratio")))

    def translate(self, vector: Any) -> None:
        """Moves the surface."""
        check(lib.shapeop_canalTranslate(self._handle, _vector(vector, "vector")))

    def scale(self, factor: float) -> None:
        """Scales the surface about the origin."""
        check(lib.shapeop_canalScale(self._handle, _arrays.real(factor, "factor")))

    def rotate(self, axis: Any, angle: float) -> None:
        """Turns the surface about the axis through the origin, right-handed, by ``angle`` radians."""
        check(lib.shapeop_canalRotate(self._handle, _vector(axis, "axis"), _arrays.real(angle, "angle")))

    def combescure(self, column: Any, row: Any) -> None:
        """The parallel net whose edges along column 0 and row 0 are these multiples of what they were."""
        columns, rows = _arrays.numbers(column, "column"), _arrays.numbers(row, "row")
        check(lib.shapeop_canalCombescureFactors(self._handle, *columns, *rows))

    def undo(self) -> bool:
        """Takes the last transformation off; ``False`` if there is none."""
        answer = int(lib.shapeop_canalUndo(self._handle))
        check_message()
        return answer == 1


# Points and grids.


def invert_points(points: Any, center: Any, ratio: float) -> Any:
    """The images of points under an inversion."""
    block = _arrays.points(points)
    out = _doubles(3 * block.length)
    check(lib.shapeop_canalInvertPoints(*block, _vector(center, "center"), _arrays.real(ratio, "ratio"), out))
    return _arrays.shaped(out, block.length, 3)


def invert_circle(circle: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a circle, and whether it is a line: then a point of it, its direction, and 0."""
    out, is_line = _doubles(7), ctypes.c_int()
    source, middle = _of_length(circle, "circle", 7), _vector(center, "center")
    check(lib.shapeop_canalInvertCircle(source, middle, _arrays.real(ratio, "ratio"), out, ctypes.byref(is_line)))
    return _arrays.doubles(out), bool(is_line.value)


def check_circular(points: Any, quads: Any) -> Quality:
    """How circular quads are: ``quads`` has 4 point indices for each."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    count = lists.list_count
    planarity, concyclicity, in_order = _doubles(count), _doubles(count), _ints(count)
    arguments = (*block, lists.indices.pointer, count)
    check(lib.shapeop_canalCheckCircular(*arguments, planarity, concyclicity, in_order))
    return Quality(_arrays.doubles(planarity), _arrays.doubles(concyclicity), _truths(in_order))


def grid_lengths(grid: Any, wraps: Wraps = (False, False)) -> tuple[Any, Any]:
    """The lengths of a grid's edges along column 0 and along row 0."""
    own = _Grid(grid, wraps)
    column, row = _doubles(own.spans[0]), _doubles(own.spans[1])
    check(lib.shapeop_canalGridLengths(*own.arguments, column, row))
    return _arrays.doubles(column), _arrays.doubles(row)


def close_lengths(grid: Any, column: Any, row: Any, wraps: Wraps) -> tuple[Any, Any]:
    """The lengths nearest to the given ones with which a grid that wraps closes."""
    own, columns, rows = _Grid(grid, wraps), _arrays.numbers(column, "column"), _arrays.numbers(row, "row")
    out_column, out_row = _doubles(columns.length), _doubles(rows.length)
    check(lib.shapeop_canalCloseLengths(*own.arguments, *columns, *rows, out_column, out_row))
    return _arrays.doubles(out_column), _arrays.doubles(out_row)


def combescure(
    grid: Any, column: Any, row: Any, origin: Optional[Any] = None, wraps: Wraps = (False, False)
) -> tuple[Any, int]:
    """The parallel grid with these lengths along column 0 and row 0, and how many edges point the other way."""
    own, columns, rows = _Grid(grid, wraps), _arrays.numbers(column, "column"), _arrays.numbers(row, "row")
    out, reversed_count = _doubles(3 * own.count), ctypes.c_int()
    first = _optional(origin, "origin")
    check(lib.shapeop_canalCombescure(*own.arguments, *columns, *rows, first, out, ctypes.byref(reversed_count)))
    return own.shaped(out), reversed_count.value


def parallel_space(points: Any, quads: Any) -> Any:
    """An orthonormal basis of all meshes parallel to a mesh of quads: (dimension, points, 3)."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    arguments, dimension = (*block, lists.indices.pointer, lists.list_count), ctypes.c_int()
    check(lib.shapeop_canalParallelSpace(*arguments, None, 0, ctypes.byref(dimension)))
    basis = _doubles(3 * block.length * dimension.value)
    check(lib.shapeop_canalParallelSpace(*arguments, basis, dimension.value, ctypes.byref(dimension)))
    return _arrays.shaped(basis, dimension.value, block.length, 3)


def nearest_parallel(points: Any, quads: Any, handles: Any, targets: Any) -> Any:
    """The parallel mesh whose points ``handles`` are nearest to ``targets``."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    indices, goals = _arrays.ids(handles, "handles"), _arrays.points(targets, "targets")
    if indices.length != goals.length:
        raise ArgumentError(f"targets: expected {indices.length}, one for each handle; found {goals.length}")
    out = _doubles(3 * block.length)
    mesh = (*block, lists.indices.pointer, lists.list_count)
    check(lib.shapeop_canalNearestParallel(*mesh, indices.pointer, goals.pointer, goals.length, out))
    return _arrays.shaped(out, block.length, 3)


def invert_complex(points: Any, center: complex, ratio: float) -> list[complex]:
    """The images of complex numbers under an inversion of the plane."""
    numbers = [complex(point) for point in points]
    block = _arrays.numbers([part for number in numbers for part in (number.real, number.imag)], "points")
    out, middle = _doubles(2 * len(numbers)), _arrays.numbers([center.real, center.imag], "center").pointer
    check(lib.shapeop_canalInvertComplex(block.pointer, len(numbers), middle, _arrays.real(ratio, "ratio"), out))
    return [complex(out[2 * k], out[2 * k + 1]) for k in range(len(numbers))]


def invert_sphere(sphere: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a sphere ``[x, y, z, radius]``, and whether it is a plane: see ``shapeop_canalInvertSphere``."""
    values = [float(number) for number in sphere]
    if len(values) != 4:
        raise ArgumentError(f"sphere: expected 4 numbers, found {_arrays.found(sphere)}")
    out, is_plane = _doubles(7), ctypes.c_int()
    middle, power = _vector(center, "center"), _arrays.real(ratio, "ratio")
    source = _vector(values[:3], "sphere")
    check(lib.shapeop_canalInvertSphere(source, values[3], middle, power, out, ctypes.byref(is_plane)))
    return _arrays.doubles(out), bool(is_plane.value)


def invert_plane(point: Any, normal: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a plane, and whether it is a plane again: see ``shapeop_canalInvertSphere``."""
    out, is_plane = _doubles(7), ctypes.c_int()
    plane = (_vector(point, "point"), _vector(normal, "normal"))
    middle, power = _vector(center, "center"), _arrays.real(ratio, "ratio")
    check(lib.shapeop_canalInvertPlane(*plane, middle, power, out, ctypes.byref(is_plane)))
    return _arrays.doubles(out), bool(is_plane.value)


def check_parallel(a: Any, b: Any, edges: Any) -> tuple[float, int]:
    """The largest sine between edges, pairs of point indices, of two meshes, and how many point the other way."""
    first, second, pairs = _arrays.points(a, "a"), _arrays.points(b, "b"), _arrays.face_lists(edges, "edges", 2)
    if first.length != second.length:
        raise ArgumentError(f"b: expected {first.length} points, found {second.length}")
    sine, reversed_count = ctypes.c_double(), ctypes.c_int()
    meshes = (first.pointer, second.pointer, first.length, pairs.indices.pointer, pairs.list_count)
    check(lib.shapeop_canalCheckParallel(*meshes, ctypes.byref(sine), ctypes.byref(reversed_count)))
    return sine.value, reversed_count.value


def translation(rail: Any, profile: Any, factors: Optional[Any] = None) -> Any:
    """The surface of translation, (rows, columns, 3), or of scale-translation with one factor for each rail point."""
    a, b = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
    own = None if factors is None else _of_length(factors, "factors", a.length)
    points, capacity = _doubles(3 * a.length * b.length), a.length * b.length
    count, rows, columns = (ctypes.c_int() for _ in range(3))
    outputs = (points, capacity, ctypes.byref(count), ctypes.byref(rows), ctypes.byref(columns), None)
    check(lib.shapeop_canalTranslation(*a, *b, own, *outputs))
    used = 3 * count.value
    return _arrays.shaped((ctypes.c_double * used)(*points[:used]), rows.value, columns.value, 3)


def grid_of_mesh(points: Any, quads: Any, component: int = 0) -> tuple[list[list[int]], Wraps, int]:
    """A component of a mesh of quads as a grid: point indices in rows, what wraps, and the number of components."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    total, rows, columns, bits, count = (ctypes.c_int() for _ in range(5))
    indices = _ints(block.length)
    mesh = (*block, lists.indices.pointer, lists.list_count, _arrays.integer(component, "component"))
    sizes = tuple(ctypes.byref(each) for each in (total, rows, columns, bits))
    check(lib.shapeop_canalGridOfMesh(*mesh, *sizes, indices, block.length, ctypes.byref(count)))
    own = [list(indices[i * columns.value : (i + 1) * columns.value]) for i in range(rows.value)]
    return own, (bool(bits.value & 1), bool(bits.value & 2)), total.value


def frame_of_angles(polar: float, azimuth: float, turn: float = 0.0) -> Any:
    """The frame (t1, t2, normal) whose normal is at ``polar`` from z and ``azimuth`` from x, turned about it."""
    out = _doubles(9)
    angles = (_arrays.real(azimuth, "azimuth"), _arrays.real(polar, "polar"), _arrays.real(turn, "turn"))
    check(lib.shapeop_canalFrameOfAngles(*angles, out))
    return _arrays.shaped(out, 3, 3)


def frame_of_tangent(tangent: Any, normal: Any, direction: int = 1) -> Any:
    """The frame with a tangent in direction 1 or 2 and the normal as near as possible to ``normal``."""
    out = _doubles(9)
    vectors = (_vector(tangent, "tangent"), _vector(normal, "normal"))
    check(lib.shapeop_canalFrameOfTangent(*vectors, _arrays.integer(direction, "direction"), out))
    return _arrays.shaped(out, 3, 3)


def grid_frames(grid: Any, frame: Any, wraps: Wraps = (False, False)) -> tuple[Any, float]:
    """The frames at all points of a circular grid, (rows, columns, 3, 3), and their gap across seams."""
    own, gap = _Grid(grid, wraps), ctypes.c_double()
    out = _doubles(9 * own.count)
    check(lib.shapeop_canalGridFrames(*own.arguments, _frame(frame), out, ctypes.byref(gap)))
    return _arrays.shaped(out, own.rows, own.columns, 3, 3), gap.value


def folds(grid: Any, wraps: Wraps = (False, False)) -> tuple[Any, Any, list[int]]:
    """Where a grid folds: per row how far it reaches towards the evolute of column 0 (1: up to it); per face the least
    ratio of opposite edges, and flags: 1 flipped, 2 shrunk."""
    own = _Grid(grid, wraps)
    count = max(own.spans[0], 0) * max(own.spans[1], 0)
    evolute, edges, flags = _doubles(own.rows), _doubles(count), _ints(count)
    check(lib.shapeop_canalFolds(*own.arguments, evolute, None, edges, flags))
    return _arrays.doubles(evolute), _arrays.doubles(edges), list(flags)


# Strips.


def _strip(function: Any, points: Any, start: Any, *arguments: Any, is_full: bool = False) -> Strip:
    count = points.length
    border, lengths, attainable, deviation = (
        _doubles(3 * count),
        _doubles(count),
        _doubles(count - 1),
        ctypes.c_double(),
    )
    flipped, projected = _ints(count - 1), _ints(count)
    rest = (attainable, flipped, projected, ctypes.byref(deviation)) if is_full else (flipped,)
    check(function(*points, _vector(start, "start"), *arguments, border, lengths, *rest))
    return Strip(
        _arrays.shaped(border, count, 3),
        _arrays.doubles(lengths),
        _arrays.doubles(attainable) if is_full else None,
        _truths(flipped),
        _truths(projected),
        deviation.value,
    )


def strip(
    points: Any,
    start: Any,
    lengths: Any,
    *,
    strict: bool = False,
    project_lengths: bool = False,
    fit_start: bool = False,
) -> Strip:
    """The strip of circular quads along ``points`` from ``start`` whose crossing edges have the given lengths.

    ``strict``: quads that cross themselves are refused. ``project_lengths``: a length that is not attainable is
    replaced by the nearest that is. ``fit_start``: the first crossing edge is turned to where the lengths can go on.
    """
    flags = int(strict) | int(project_lengths) << 1 | int(fit_start) << 2
    guide = _arrays.points(points)
    own = _of_length(lengths, "lengths", guide.length)
    return _strip(lib.shapeop_canalStrip, guide, start, own, flags, is_full=True)


def strip_of_radii(points: Any, start: Any, radii: Any, *, strict: bool = False) -> Strip:
    """The strip from the radius of each quad's circle."""
    guide = _arrays.points(points)
    own = _of_length(radii, "radii", max(guide.length - 1, 0))
    return _strip(lib.shapeop_canalStripOfRadii, guide, start, own, int(strict))


def strip_of_border_edges(points: Any, start: Any, edges: Any) -> Strip:
    """The strip from the lengths of the border's edges."""
    guide = _arrays.points(points)
    return _strip(
        lib.shapeop_canalStripOfBorderEdges, guide, start, _of_length(edges, "edges", max(guide.length - 1, 0))
    )


def strip_circles(guide: Any, border: Any) -> Any:
    """The circle of each quad of a strip, (n - 1, 7)."""
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    out = _doubles(7 * (a.length - 1))
    check(lib.shapeop_canalStripCircles(a.pointer, b.pointer, a.length, out))
    return _arrays.shaped(out, max(a.length - 1, 0), 7)


def strip_of_circles(circles: Any, start: Optional[Any] = None, end: Optional[Any] = None) -> tuple[Any, Any, float]:
    """The guide and the border of the strip whose quads have these circles, and how far points are off them."""
    block = _circles(circles, "circles")
    guide, border, distance = _doubles(3 * block.length + 3), _doubles(3 * block.length + 3), ctypes.c_double()
    ends = (_optional(start, "start"), _optional(end, "end"))
    check(lib.shapeop_canalStripOfCircles(*block, *ends, guide, border, ctypes.byref(distance)))
    count = block.length + 1
    return _arrays.shaped(guide, count, 3), _arrays.shaped(border, count, 3), distance.value


def smooth(
    guide: Any, border: Any, frame: Any, progress: Optional[ProgressFunction] = None, **options: float
) -> Smoothed:
    """Smooths a strip: less curvature of all arcs, with the guide's points on their curve.

    ``options``: the fields of ``shapeop_canal_smooth_options`` in the C header, such as ``max_iterations``.
    """
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    asked = _abi.shapeop_canal_smooth_options(struct_size=ctypes.sizeof(_abi.shapeop_canal_smooth_options))
    check(lib.shapeop_canalDefaultSmoothOptions(ctypes.byref(asked)))
    _set(asked, options)
    told = _abi.shapeop_canal_smooth_report(struct_size=ctypes.sizeof(_abi.shapeop_canal_smooth_report))
    out_guide, out_border, out_frame = _doubles(3 * a.length), _doubles(3 * a.length), _doubles(9)
    strip = (a.pointer, b.pointer, a.length, _frame(frame))
    outputs = (out_guide, out_border, None, out_frame, None, 0, None, ctypes.byref(told))
    with _Watch(progress) as watch:
        check(lib.shapeop_canalSmooth(*strip, ctypes.byref(asked), watch.callback, None, *outputs))
    return Smoothed(
        _arrays.shaped(out_guide, a.length, 3),
        _arrays.shaped(out_border, a.length, 3),
        _arrays.shaped(out_frame, 3, 3),
        told.before,
        told.after,
        told.iterations,
        Stop(told.stop),
    )


def _set(struct: Any, options: dict[str, Any]) -> None:
    """Sets the fields of an options struct."""
    types = {field[0]: field[1] for field in struct._fields_}
    for name, value in options.items():
        if name not in types or name in ("struct_size", "reserved"):
            names = ", ".join(key for key in types if key not in ("struct_size", "reserved"))
            raise ArgumentError(f"{name}: expected one of the options {names}")
        is_real = types[name] is ctypes.c_double
        setattr(struct, name, _arrays.real(value, name) if is_real else _arrays.integer(int(value), name))


def holonomy(points: Any) -> Holonomy:
    """How a frame comes back around a closed polygon."""
    block = _arrays.points(points)
    matrix, tangent, residual, closes = _doubles(9), _doubles(3), ctypes.c_double(), ctypes.c_int()
    check(lib.shapeop_canalHolonomy(*block, matrix, ctypes.byref(residual), ctypes.byref(closes), tangent))
    columns = list(matrix)
    rows = (ctypes.c_double * 9)(*(columns[3 * j + i] for i in range(3) for j in range(3)))
    return Holonomy(_arrays.shaped(rows, 3, 3), residual.value, bool(closes.value), _arrays.doubles(tangent))


def close_strip(guide: Any, border: Any, last: Any) -> Closed:
    """Closes a strip with the guide's last point: the border then has one point more, and its first may move."""
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    out, circle, case, flipped = _doubles(3 * a.length + 3), _doubles(7), ctypes.c_int(), _ints(a.length + 1)
    strip = (a.pointer, b.pointer, a.length, _vector(last, "last"))
    check(lib.shapeop_canalCloseStrip(*strip, out, circle, ctypes.byref(case), flipped))
    return Closed(_arrays.shaped(out, a.length + 1, 3), _arrays.doubles(circle), case.value, _truths(flipped))


def lengths_between(points: Any, first: float, last: float) -> Any:
    """Lengths of crossing edges that go from ``first`` to ``last`` evenly along a polyline."""
    block = _arrays.points(points)
    out = _doubles(block.length)
    check(lib.shapeop_canalLengthsBetween(*block, _arrays.real(first, "first"), _arrays.real(last, "last"), out))
    return _arrays.doubles(out)


def edges_of_border(points: Any, length: float) -> Any:
    """The lengths of the edges of a border that is ``length`` long in all, in the proportions of the guide's."""
    block = _arrays.points(points)
    out = _doubles(block.length - 1)
    check(lib.shapeop_canalEdgesOfBorder(*block, _arrays.real(length, "length"), out))
    return _arrays.doubles(out)


def closed_frame(points: Any, wish: Any) -> Any:
    """The frame nearest to ``wish`` with which a surface along a closed polygon is smooth across the seam."""
    out = _doubles(9)
    check(lib.shapeop_canalClosedFrame(*_arrays.points(points), _frame(wish, "wish"), out))
    return _arrays.shaped(out, 3, 3)


def parallel_on_sphere(points: Any) -> Optional[Any]:
    """The closed polygon on a sphere with edges parallel to those of a closed polygon; ``None`` if there is none."""
    block, count = _arrays.points(points), ctypes.c_int()
    out = _doubles(3 * block.length)
    check(lib.shapeop_canalParallelOnSphere(*block, out, block.length, ctypes.byref(count), None))
    used = 3 * count.value
    return _arrays.shaped((ctypes.c_double * used)(*out[:used]), count.value, 3) if used else None


def strip_energy(guide: Any, border: Any, frame: Any) -> float:
    """What :func:`smooth` lowers: the sum of the squared curvatures of all arcs of a strip."""
    a, b, out = _arrays.points(guide, "guide"), _arrays.points(border, "border"), ctypes.c_double()
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    check(lib.shapeop_canalStripEnergy(a.pointer, b.pointer, a.length, _frame(frame), ctypes.byref(out)))
    return out.value


# Surfaces from curves.


def fit(guide: Any, curve: Any, *, guide_closed: bool = False, curve_closed: bool = False, **options: Any) -> Fit:
    """The canal surface through the spline of ``guide`` that touches the spline of ``curve``.

    ``options``: the fields of ``shapeop_canal_fit_options`` in the C header, such as ``circle_count`` and ``angle``;
    ``section`` and ``spacing`` also by name.
    """
    a, b = _arrays.points(guide, "guide"), _arrays.points(curve, "curve")
    asked = _abi.shapeop_canal_fit_options(struct_size=ctypes.sizeof(_abi.shapeop_canal_fit_options))
    check(lib.shapeop_canalDefaultFitOptions(ctypes.byref(asked)))
    for name, kind in (("section", Section), ("spacing", Spacing)):
        if name in options:
            options[name] = _arrays.member(kind, options[name], name)
    _set(asked, options)
    told = _abi.shapeop_canal_fit_report(struct_size=ctypes.sizeof(_abi.shapeop_canal_fit_report))
    capacity = max(asked.circle_count, a.length) + 1
    circles, spheres, circle_count, sphere_count = (
        _doubles(7 * capacity),
        _doubles(4 * capacity),
        ctypes.c_int(),
        ctypes.c_int(),
    )
    handle = lib.shapeop_canalFit(
        *a,
        int(_arrays.truth(guide_closed, "guide_closed")),
        *b,
        int(_arrays.truth(curve_closed, "curve_closed")),
        ctypes.byref(asked),
        circles,
        capacity,
        ctypes.byref(circle_count),
        spheres,
        None,
        capacity,
        ctypes.byref(sphere_count),
        ctypes.byref(told),
    )
    surface = CanalSurface._of(handle)
    n, m = circle_count.value, sphere_count.value
    return Fit(
        surface,
        _arrays.shaped((ctypes.c_double * (7 * n))(*circles[: 7 * n]), n, 7),
        _arrays.shaped((ctypes.c_double * (4 * m))(*spheres[: 4 * m]), m, 4),
        told.deviation,
        told.residual,
        told.tangent_gap,
        told.closing_gap,
        bool(told.is_outward),
    )


def c_canal(
    guide: Any,
    section: Any,
    lengths: Optional[Any] = None,
    curve: Optional[Any] = None,
    *,
    curve_closed: bool = False,
    project_lengths: bool = False,
    progress: Optional[ProgressFunction] = None,
) -> CCanal:
    """The C-canal surface along ``guide`` from a convex planar ``section``: by ``lengths`` or to a ``curve``."""
    if (lengths is None) == (curve is None):
        raise ArgumentError("lengths: expected either lengths or a curve")
    a, b = _arrays.points(guide, "guide"), _arrays.points(section, "section")
    own = None if lengths is None else _of_length(lengths, "lengths", a.length)
    second = _arrays.Block(None, 0) if curve is None else _arrays.points(curve, "curve")
    made, deviations, projected, cancelled = _doubles(a.length), _doubles(a.length), _ints(a.length), ctypes.c_int()
    flags = (int(_arrays.truth(curve_closed, "curve_closed")), int(_arrays.truth(project_lengths, "project_lengths")))
    with _Watch(progress) as watch:
        outputs = (made, deviations, None, projected, ctypes.byref(cancelled))
        handle = lib.shapeop_canalCCanal(*a, *b, own, *second, *flags, watch.callback, None, *outputs)
        surface = CanalSurface._of(handle)
    rows = surface.shape[0]
    return CCanal(
        surface,
        _arrays.doubles((ctypes.c_double * rows)(*made[:rows])),
        _arrays.doubles((ctypes.c_double * rows)(*deviations[:rows])),
        _truths(projected[:rows]),
        bool(cancelled.value),
    )


def curve_points(
    points: Any, count: int, spacing: Union[Spacing, str] = Spacing.ARC_LENGTH, is_closed: bool = False
) -> tuple[Any, Any]:
    """``count`` points of the spline through ``points``, and its unit tangents there."""
    block, number = _arrays.points(points), _arrays.integer(count, "count")
    out, tangents = _doubles(3 * number), _doubles(3 * number)
    closed, kind = int(_arrays.truth(is_closed, "is_closed")), _arrays.member(Spacing, spacing, "spacing")
    check(lib.shapeop_canalCurvePoints(*block, closed, kind, out, tangents, number))
    return _arrays.shaped(out, number, 3), _arrays.shaped(tangents, number, 3)


def normals(points: Any, angle: float = 0.0, first: Optional[Any] = None, is_closed: bool = False) -> tuple[Any, Any]:
    """Normals along a curve through points that turn as little as possible; and frames mirrored from point to point."""
    block = _arrays.points(points)
    out, frames = _doubles(3 * block.length), _doubles(9 * block.length)
    closed, vector = int(_arrays.truth(is_closed, "is_closed")), _optional(first, "first")
    arguments = (block.pointer, None, block.length, closed, _arrays.real(angle, "angle"), vector)
    check(lib.shapeop_canalNormals(*arguments, out, frames))
    return _arrays.shaped(out, block.length, 3), _arrays.shaped(frames, block.length, 3, 3)


def touching_spheres(points: Any, normals: Any, curve: Any, curve_closed: bool = False) -> tuple[Any, list[int]]:
    """The spheres, (n, 4), that touch a curve in points, along its normals, and the spline of ``curve``; and flags."""
    a, b, c = _arrays.points(points), _arrays.points(normals, "normals"), _arrays.points(curve, "curve")
    if a.length != b.length:
        raise ArgumentError(f"normals: expected {a.length}, found {b.length}")
    spheres, flags = _doubles(4 * a.length), _ints(a.length)
    closed = int(_arrays.truth(curve_closed, "curve_closed"))
    outputs = (spheres, None, None, flags, None)
    check(lib.shapeop_canalTouchingSpheres(a.pointer, b.pointer, a.length, *c, closed, *outputs))
    return _arrays.shaped(spheres, a.length, 4), list(flags)


def characteristic_circles(spheres: Any) -> Any:
    """The circles in which each sphere ``[x, y, z, radius]`` meets the next."""
    rows = [[float(number) for number in sphere] for sphere in spheres]
    if any(len(row) != 4 for row in rows):
        raise ArgumentError(f"spheres: expected 4 numbers for each, found {_arrays.found(spheres)}")
    block = _arrays.numbers([number for row in rows for number in row], "spheres")
    out = _doubles(7 * (len(rows) - 1))
    check(lib.shapeop_canalCharacteristicCircles(block.pointer, len(rows), out))
    return _arrays.shaped(out, max(len(rows) - 1, 0), 7)


def mesh_circles(circles: Any, guide: Any, row: Any, wraps: bool = False) -> Any:
    """The grid of which row i is on circle i and row 0 is ``row``; ``guide`` has a point of each circle."""
    block, a, b = _circles(circles, "circles"), _arrays.points(guide, "guide"), _arrays.points(row, "row")
    if a.length != block.length:
        raise ArgumentError(f"guide: expected {block.length} points, found {a.length}")
    out, closed = _doubles(3 * block.length * b.length), int(_arrays.truth(wraps, "wraps"))
    check(lib.shapeop_canalMeshCircles(block.pointer, a.pointer, block.length, *b, closed, out))
    return _arrays.shaped(out, block.length, b.length, 3)


def center(
    corners: Any, kind: Union[Center, str] = Center.MIDDLE, value: float = 0.0, point: Optional[Any] = None
) -> tuple[Optional[Any], float, float]:
    """A center of inversion for four points of a circle (``None``: at infinity), its angle, and its ratio."""
    block = _arrays.points(corners, "corners")
    if block.length != 4:
        raise ArgumentError(f"corners: expected 4 points, found {block.length}")
    out, infinite, omega, ratio = _doubles(3), ctypes.c_int(), ctypes.c_double(), ctypes.c_double()
    choice = (_arrays.member(Center, kind, "kind"), _arrays.real(value, "value"), _optional(point, "point"))
    outputs = (out, ctypes.byref(infinite), ctypes.byref(omega), ctypes.byref(ratio))
    check(lib.shapeop_canalCenter(block.pointer, *choice, *outputs))
    return (None if infinite.value else _arrays.doubles(out)), omega.value, ratio.value


def ratio_limits(corners: Any) -> tuple[float, float]:
    """The ends of the open interval of ratios of parallel sides that four points of a circle allow."""
    block = _arrays.points(corners, "corners")
    if block.length != 4:
        raise ArgumentError(f"corners: expected 4 points, found {block.length}")
    limits = _doubles(2)
    check(lib.shapeop_canalCenters(block.pointer, None, None, None, limits))
    return limits[0], limits[1]


def family_names() -> tuple[str, ...]:
    """The names of the families of super-canal surfaces."""
    return tuple(text(lib.shapeop_canalFamilyName(i)) for i in range(lib.shapeop_canalFamilyCount()))


def family_steps(name: str) -> tuple[Kind, list[Step]]:
    """How surfaces of a family are made: the kind of the base, and the kinds of the transformations after it."""
    kind, count, steps = ctypes.c_int(), ctypes.c_int(), _ints(8)
    family = _arrays.name_bytes(name, "name")
    check(lib.shapeop_canalFamilySteps(family, ctypes.byref(kind), steps, 8, ctypes.byref(count)))
    return Kind(kind.value), [Step(step) for step in steps[: count.value]]


# Parts.


def node_axes(
    grid: Any,
    first: Optional[Any] = None,
    wraps: Wraps = (False, False),
    progress: Optional[ProgressFunction] = None,
) -> NodeAxes:
    """Axes of the nodes between torsion-free beams: handed on from ``first``, or, without it, those of least gaps."""
    own = _Grid(grid, wraps)
    axes, gaps, cancelled = _doubles(3 * own.count), _doubles(own.count), ctypes.c_int()
    if first is not None:
        check(lib.shapeop_canalNodeAxes(*own.arguments, _vector(first, "first"), axes, gaps))
    else:
        with _Watch(progress) as watch:
            outputs = (axes, gaps, ctypes.byref(cancelled))
            check(lib.shapeop_canalNodeAxesOfLeastGaps(*own.arguments, watch.callback, None, *outputs))
    return NodeAxes(own.shaped(axes), _arrays.shaped(gaps, own.rows, own.columns), bool(cancelled.value))


def offset(grid: Any, axes: Any, distance: float, wraps: Wraps = (False, False)) -> Any:
    """A grid moved by ``distance`` along its axes."""
    own = _Grid(grid, wraps)
    out = _doubles(3 * own.count)
    check(lib.shapeop_canalOffset(*own.arguments, own.axes(axes), _arrays.real(distance, "distance"), out))
    return own.shaped(out)


def panels(grid: Any, axes: Any, thickness: float = 0.0, wraps: Wraps = (False, False)) -> Panels:
    """The faces of a grid as flat panels with the mitres of their edges in radians."""
    own = _Grid(grid, wraps)
    count = max(own.spans[0], 0) * max(own.spans[1], 0)
    outlines, lower, mitres, circles, heights = (_doubles(n * count) for n in (8, 8, 4, 7, 1))
    outputs = (outlines, lower, mitres, circles, heights)
    check(lib.shapeop_canalPanels(*own.arguments, own.axes(axes), _arrays.real(thickness, "thickness"), *outputs))
    return Panels(
        _arrays.shaped(outlines, count, 4, 2),
        _arrays.shaped(lower, count, 4, 2),
        _arrays.shaped(mitres, count, 4),
        _arrays.shaped(circles, count, 7),
        _arrays.doubles(heights),
    )


def beams(grid: Any, axes: Any, height: float, wraps: Wraps = (False, False)) -> tuple[list[list[int]], Any]:
    """A planar beam along every edge: the indices of its nodes, and its corners, (beams, 4, 3)."""
    own = _Grid(grid, wraps)
    arguments, count = (*own.arguments, own.axes(axes), _arrays.real(height, "height")), ctypes.c_int()
    check(lib.shapeop_canalBeams(*arguments, None, None, 0, ctypes.byref(count)))
    nodes, corners = _ints(2 * count.value), _doubles(12 * count.value)
    check(lib.shapeop_canalBeams(*arguments, nodes, corners, count.value, ctypes.byref(count)))
    pairs = [[nodes[2 * k], nodes[2 * k + 1]] for k in range(count.value)]
    return pairs, _arrays.shaped(corners, count.value, 4, 3)


def parts_json(grid: Any, axes: Any, thickness: float, height: float, wraps: Wraps = (False, False)) -> str:
    """The JSON form of panels and beams for a workshop (``docs/canal-parts.schema.json``)."""
    own = _Grid(grid, wraps)
    numbers = (_arrays.real(thickness, "thickness"), _arrays.real(height, "height"))
    answer = lib.shapeop_canalPartsText(*own.arguments, own.axes(axes), *numbers)
    if answer is None:
        check_message()
    return text(answer)
