"""The handle of a snake, and what all of its positions have."""

from __future__ import annotations

import ctypes
import weakref
from typing import Any, Optional

from .. import _abi, _arrays, meshes
from .._calls import CallWatch, doubles, integers, ints, sized, told_text, vector
from .._library import ArgumentError, ClosedError, ErrorCode, check, check_message, lib, refusal
from ._kinds import Arc, ArcKind, Mesh, Progress, ProgressFunction, Surface

NOW = -1
"""For a frame: the snake as it is."""

ALL = -2
"""For a frame: all positions."""


def watch(progress: Optional[ProgressFunction]) -> CallWatch:
    """What calls ``progress``."""

    def told(now: Any) -> Progress:
        return Progress(*(getattr(now, name) for name in Progress._fields))

    return CallWatch(_abi.shapeop_snake_progress_callback, progress, told)


def mesh_of(function: Any, *how: Any) -> Mesh:
    """A mesh of quads that a function writes."""
    count, quad_count = ctypes.c_int(), ctypes.c_int()
    counts = (ctypes.byref(count), ctypes.byref(quad_count))
    check(function(*how, None, 0, counts[0], None, 0, counts[1]))
    points, quads = doubles(3 * count.value), ints(4 * quad_count.value)
    check(function(*how, points, count.value, counts[0], quads, quad_count.value, counts[1]))
    return Mesh(_arrays.shaped(points, count.value, 3), integers(quads, quad_count.value, 4))


def arc_of(numbers: Any) -> Arc:
    """An arc from its 11 numbers."""
    x, y, z, radius, a, b, c, p, q, r, angle = (float(number) for number in numbers)
    return Arc((x, y, z), radius, (a, b, c), (p, q, r), angle)


class Handle:
    """A snake of the library: deleted by ``close()``, at the end of a ``with`` block, or when nothing refers to it."""

    def _open(self, handle: Optional[int]) -> None:
        if handle is None:
            check_message()
            raise refusal(ErrorCode.INTERNAL, "the library gave no handle")
        self._open_handle: Optional[int] = handle
        self._finalizer = weakref.finalize(self, lib.shapeop_snakeDelete, handle)

    @property
    def _handle(self) -> int:
        if self._open_handle is None:
            raise ClosedError("the snake was closed", ErrorCode.INVALID_HANDLE)
        return self._open_handle

    def close(self) -> None:
        """Deletes it; every later call raises :class:`shapeop.ClosedError`, except this one."""
        if self._open_handle is not None:
            lib.shapeop_snakeDelete(self._open_handle)
            check_message()
            self._open_handle = None
            self._finalizer.detach()

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def _doubles(self, function: Any, unit: int, *before: Any) -> Any:
        return sized(doubles, unit, lambda out, room, count: function(self._handle, *before, out, room, count))

    def _points(self, function: Any, *before: Any) -> Any:
        values = self._doubles(function, 3, *before)
        return _arrays.shaped(values, len(values) // 3, 3)

    def _count(self, number: int) -> int:
        if number < 0:
            check_message()
        return number

    def _arcs(self, frame: int) -> list[Arc]:
        values = self._doubles(lib.shapeop_snakeArcs, 11, frame)
        return [arc_of(values[k : k + 11]) for k in range(0, len(values), 11)]

    def _sample(self, frame: int, per_arc: int) -> Any:
        return self._points(lib.shapeop_snakeSample, frame, _arrays.integer(per_arc, "per_arc"))

    def _pipe(self, frame: int, radius: float, per_arc: int, around: int) -> Mesh:
        numbers = (_arrays.integer(per_arc, "per_arc"), _arrays.integer(around, "around"))
        return mesh_of(lib.shapeop_snakePipe, self._handle, frame, _arrays.real(radius, "radius"), *numbers)

    def _lamellae(self, frame: int, depth: float, along: Any, per_arc: int) -> Mesh:
        kind, direction = _abi.SO_SNAKE_LAMELLA_FLAT, None
        if isinstance(along, str):
            if along != "normal":
                raise ArgumentError(f"along: expected a vector, 'normal' or None, found {along!r}")
            kind = _abi.SO_SNAKE_LAMELLA_NORMAL
        elif along is not None:
            kind, direction = _abi.SO_SNAKE_LAMELLA_ALONG, vector(along, "along")
        how = (kind, direction, _arrays.real(depth, "depth"), _arrays.integer(per_arc, "per_arc"))
        return mesh_of(lib.shapeop_snakeLamellae, self._handle, frame, *how)

    def kinds(self, tolerance: float = 1e-6) -> list[ArcKind]:
        """The kinds of arcs that one position is made of; all positions have the same.

        Arcs are alike if radii and lengths are both within ``tolerance``, relative to them.
        """
        values = self._doubles(lambda *a: lib.shapeop_snakeKinds(a[0], _arrays.real(tolerance, "tolerance"), *a[1:]), 3)
        return [ArcKind(values[k], values[k + 1], round(values[k + 2])) for k in range(0, len(values), 3)]

    def kind_of(self, tolerance: float = 1e-6) -> list[int]:
        """Of which kind each arc is, as :meth:`kinds` has them."""
        how = _arrays.real(tolerance, "tolerance")
        return list(
            sized(ints, 1, lambda out, room, count: lib.shapeop_snakeKindOf(self._handle, how, out, room, count))
        )

    def _text(self, function: Any, frame: int, tolerance: float) -> str:
        return told_text(function(self._handle, frame, _arrays.real(tolerance, "tolerance")))

    def _set_surface(self, surface: Any) -> None:
        """Takes a surface, a mesh, a pair of points and faces, or none."""
        if surface is None:
            check(lib.shapeop_snakeClearSurface(self._handle))
        elif isinstance(surface, Surface):
            numbers = _arrays.numbers(list(surface.numbers), "surface")
            check(lib.shapeop_snakeSetSurface(self._handle, surface.kind, numbers.pointer, numbers.length))
        else:
            check(lib.shapeop_snakeSetMesh(self._handle, *mesh_arguments(surface)))


def mesh_arguments(surface: Any) -> tuple[Any, ...]:
    """A mesh of COMPAS, meshio or trimesh, or a pair of points and faces, as the library takes it."""
    if isinstance(surface, (tuple, list)) and len(surface) == 2:
        view = meshes.view(surface[0], surface[1])
    else:
        view = meshes.view(surface)
    points, lists = _arrays.points(view.points), _arrays.face_lists(view.faces, "faces")
    return (*points, *lists.indices, *lists.counts)
