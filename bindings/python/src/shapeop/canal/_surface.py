"""Surfaces: making, transforming, reading."""

from __future__ import annotations

import ctypes
import weakref
from typing import Any, Optional, Union

from .. import _abi, _arrays
from .._library import ArgumentError, ClosedError, ErrorCode, check, check_message, lib, text
from ._arguments import _doubles, _frame, _Grid, _ints, _optional, _vector
from ._kinds import Center, Kind, Kinks, Wraps


def _m_moulding(curve: Any, rail: Any, p3: Any, center: Any, value: Any, point: Any, outputs: Any) -> Optional[int]:
    curves = (*_arrays.points(curve, "curve"), *_arrays.points(rail, "rail"))
    kind, number = _arrays.member(Center, center, "center"), _arrays.real(value, "value")
    choice = (_optional(p3, "p3"), kind, number, _optional(point, "point"))
    handle: Optional[int] = lib.shapeop_canalMMoulding(*curves, *choice, *outputs)
    return handle


class CanalSurface:
    """A circular net with a frame at each point, and the transformations that made it of its base.

    ``grid``: an array of shape (rows, columns, 3) whose quads have circles; ``frame``: the unit tangents ``(t1, t2)``
    at its first point; ``kinks``: the rows or columns along which it is creased. It is deleted by :meth:`close`, at the
    end of a ``with`` block, or when nothing refers to it any more.

    >>> torus = CanalSurface.revolution([[2, 0, 0.5], [1.6, 0, 0.3], [1.6, 0, -0.3], [2, 0, -0.5]], columns=12)
    >>> torus.invert([0, 0, 3], 4)
    >>> torus.family
    'M-revolution'
    """

    def __init__(
        self,
        grid: Any,
        frame: Any,
        kind: Union[Kind, str] = Kind.CIRCULAR,
        wraps: Wraps = (False, False),
        kinks: Optional[Kinks] = None,
    ) -> None:
        arguments = (*_Grid(grid, wraps).arguments, _frame(frame), _arrays.member(Kind, kind, "kind"))
        if kinks is None:
            self._open(lib.shapeop_canalCreate(*arguments))
            return
        direction, lines, angles = _arrays.integer(kinks[0], "direction"), *kinks[1:]
        indices, turns = _arrays.ids(lines, "lines"), _arrays.numbers(angles, "angles")
        if turns.length != indices.length:
            raise ArgumentError(f"angles: expected {indices.length}, one for each line; found {turns.length}")
        creased = (direction, indices.pointer, turns.pointer, turns.length)
        self._open(lib.shapeop_canalCreateWithKinks(*arguments, *creased))

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
        """The moulding surface of a planar rail and a profile in an orthogonal plane that starts on it.

        What was found of it, :func:`moulding` tells too.
        """
        rails, profiles = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
        return cls._of(lib.shapeop_canalMoulding(*rails, *profiles, None, None, None))

    @classmethod
    def monge(cls, rail: Any, profile: Any) -> CanalSurface:
        """The Monge surface of a rail in space and a planar profile that starts on it and moves without twist.

        What was found of it, :func:`monge` tells too.
        """
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
        of inversion. What was found of it, :func:`m_moulding` tells too.
        """
        return cls._of(_m_moulding(curve, rail, p3, center, value, point, (None, None, None, None)))

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
    def kinks(self) -> Optional[Kinks]:
        """The lines along which the base is creased; ``None`` without any."""
        direction, count = ctypes.c_int(), ctypes.c_int()
        check(lib.shapeop_canalKinks(self._handle, None, None, None, 0, ctypes.byref(count)))
        lines, angles = _ints(count.value), _doubles(count.value)
        outputs = (ctypes.byref(direction), lines, angles, count.value, ctypes.byref(count))
        check(lib.shapeop_canalKinks(self._handle, *outputs))
        return Kinks(direction.value, list(lines), _arrays.doubles(angles)) if direction.value else None

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

    def refined_at(self, one: Any, two: Any) -> CanalSurface:
        """As :meth:`refined`, with faces of the net itself cut at fractions of the arcs of column 0 and row 0.

        They ascend between 0 and 1.
        """
        a, b = _arrays.numbers(one, "one"), _arrays.numbers(two, "two")
        return self._of(lib.shapeop_canalRefinedAt(self._handle, *a, *b))

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

    def membrane_residual_of(self, pressure: float, forces_one: Any, forces_two: Any) -> float:
        """As :attr:`membrane_residual`, for given forces per length: one per face in both directions.

        They are above 0 for tension under ``pressure`` along the normal.
        """
        one, two = _arrays.numbers(forces_one, "forces_one"), _arrays.numbers(forces_two, "forces_two")
        if one.length != two.length:
            raise ArgumentError(f"forces_two: expected {one.length} numbers, found {two.length}")
        residual, forces = ctypes.c_double(), (one.pointer, two.pointer, one.length)
        load = _arrays.real(pressure, "pressure")
        check(lib.shapeop_canalMembraneResidualOf(self._handle, load, *forces, ctypes.byref(residual)))
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
