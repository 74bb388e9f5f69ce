"""Positions of a snake, and what they are for."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import doubles, set_options, struct, told_text
from .._library import ArgumentError, check, lib
from ._handle import ALL, Handle, mesh_of
from ._kinds import Arc, Congruence, Covering, Mesh
from ._snake import Snake


class Frames(Handle):
    """The positions of a snake that moved; the first is its start."""

    def __len__(self) -> int:
        return self._count(lib.shapeop_snakeFrameCount(self._handle))

    def _frame(self, frame: int) -> int:
        number = _arrays.integer(frame, "frame", -len(self))
        return number + len(self) if number < 0 else number

    @property
    def frames(self) -> Any:
        """The control points of all positions, (frames, n, 3)."""
        values, count = self._doubles(lib.shapeop_snakeFrames, 3), len(self)
        return _arrays.shaped(values, count, len(values) // 3 // count, 3)

    def snake(self, frame: int = -1) -> Snake:
        """The snake at a position, the last by default; frames below 0 count from the end."""
        number = self._frame(frame)
        snake = Snake._of(lib.shapeop_snakeCopy(self._handle))
        check(lib.shapeop_snakeTakeFrame(snake._handle, number))
        return snake

    def arcs(self, frame: int = -1) -> list[Arc]:
        """The arcs at a position."""
        return self._arcs(self._frame(frame))

    def sample(self, frame: int = -1, per_arc: int = 8) -> Any:
        """Points along the snake at a position."""
        return self._sample(self._frame(frame), per_arc)

    def mesh(self, per_arc: int = 8, comes_back: bool = False) -> Mesh:
        """The surface that the positions sweep, ``per_arc`` quads across each arc.

        With ``comes_back`` the last position is followed by the first.
        """
        how = (_arrays.integer(per_arc, "per_arc"), int(_arrays.truth(comes_back, "comes_back")))
        return mesh_of(lib.shapeop_snakeSweepMesh, self._handle, *how)

    def pipe(self, radius: float, frame: int = -1, per_arc: int = 8, around: int = 12) -> Mesh:
        """The pipe of a radius around the snake at a position."""
        return self._pipe(self._frame(frame), radius, per_arc, around)

    def lamellae(self, depth: float, frame: int = -1, along: Any = None, per_arc: int = 8) -> Mesh:
        """Lamellae of a depth at a position: flat ones in the planes of the arcs, or a band ``along`` a vector.

        Along ``"normal"`` it stands on the surface that the snake moved on.
        """
        return self._lamellae(self._frame(frame), depth, along, per_arc)

    def congruence(self, a: int = 0, b: int = -1) -> Congruence:
        """How far two positions are from being the same up to a rigid motion; the first and the last by default."""
        rms, distances = ctypes.c_double(), ctypes.c_double()
        pair = (self._frame(a), self._frame(b))
        check(lib.shapeop_snakeCongruence(self._handle, *pair, ctypes.byref(rms), ctypes.byref(distances)))
        return Congruence(rms.value, distances.value)

    def covering(
        self,
        *,
        distance: Optional[float] = None,
        per_arc: int = 8,
        comes_back: bool = False,
        tolerance: float = 1e-6,
    ) -> Covering:
        """Judges the surface that the positions sweep, and how it covers the mesh that the snake moved on.

        A spot of the mesh is covered if the swept surface is within ``distance``, by default 0.01 of its diagonal.
        """
        options = struct(_abi.shapeop_snake_covering_options)
        check(lib.shapeop_snakeDefaultCoveringOptions(ctypes.byref(options)))
        back = _arrays.truth(comes_back, "comes_back")
        given = {"distance": distance, "per_arc": per_arc, "comes_back": back, "tolerance": tolerance}
        set_options(options, given)
        told = struct(_abi.shapeop_snake_covering)
        check(lib.shapeop_snakeCovering(self._handle, ctypes.byref(options), ctypes.byref(told)))
        json = told_text(lib.shapeop_snakeCoveringText(self._handle, ctypes.byref(options)))
        names = [
            name for name, _ in told._fields_ if name not in ("struct_size", "is_compared", "at_x", "at_y", "at_z")
        ]
        numbers = {name: getattr(told, name) for name in names}
        at = (told.at_x, told.at_y, told.at_z)
        return Covering(is_compared=bool(told.is_compared), at=at, json=json, **numbers)

    def to_json(self, tolerance: float = 1e-6) -> str:
        """All positions and their arcs as JSON; arcs within ``tolerance`` are of one kind."""
        return self._text(lib.shapeop_snakeArcsText, ALL, tolerance)

    def to_csv(self, tolerance: float = 1e-6) -> str:
        """A table of all arcs: frame, arc, kind, centre, radius, axis, start, angle, length."""
        return self._text(lib.shapeop_snakeArcsCsv, ALL, tolerance)

    def kinds_csv(self, tolerance: float = 1e-6) -> str:
        """A table of the kinds of arcs, and how many there are of each in all positions."""
        return self._text(lib.shapeop_snakeKindsCsv, ALL, tolerance)

    def to_dxf(self, tolerance: float = 1e-6) -> str:
        """All arcs as a DXF drawing, a layer for each kind."""
        return self._text(lib.shapeop_snakeArcsDxf, ALL, tolerance)


def control_points(values: Any, count: int, name: str) -> Any:
    """Control points of several positions that a function wrote."""
    if count == 0:
        raise ArgumentError(f"{name}: expected at least 1, found none")
    room = doubles(len(values))
    room[:] = values[:]
    return _arrays.shaped(room, count, len(values) // 3 // count, 3)
