"""Snakes as they are."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import doubles, set_options, struct, told_text, vector
from .._library import ArgumentError, check, lib
from ._handle import NOW, Handle
from ._kinds import Arc, Freedoms, Mesh, Projection, points_of


class Snake(Handle):
    """A smooth chain of circular arcs.

    ``control``: its control points, (n, 3). Of an open snake these are its first point, the vertices of its arcs and
    its last point; of a closed one the vertices. Around a closed snake of an even number of arcs there are many, of
    which ``first_tangent`` chooses: the distance from the first control point to both ends of its arc.

    >>> from math import cos, pi, sin
    >>> ring = [[cos(2 * pi * k / 7), sin(2 * pi * k / 7), 0.0] for k in range(7)]
    >>> snake = Snake(ring, closed=True)
    >>> len(snake.arcs), round(snake.length / cos(pi / 7), 6) == round(2 * pi, 6)
    (7, True)
    """

    def __init__(self, control: Any, closed: bool = False, first_tangent: Optional[float] = None) -> None:
        points = _arrays.points(control, "control")
        tangent = 0.0 if first_tangent is None else _arrays.real(first_tangent, "first_tangent")
        self._open(lib.shapeop_snakeCreate(*points, int(_arrays.truth(closed, "closed")), tangent))

    @classmethod
    def _of(cls, handle: Optional[int]) -> Snake:
        snake = cls.__new__(cls)
        snake._open(handle)
        return snake

    @classmethod
    def from_arcs(
        cls,
        radii: Any,
        lengths: Any,
        torsions: Any = (),
        point: Any = (0.0, 0.0, 0.0),
        tangent: Any = (1.0, 0.0, 0.0),
        normal: Any = (0.0, 1.0, 0.0),
    ) -> Snake:
        """The open snake of these arcs. It begins at ``point`` along ``tangent``, and bends towards ``normal`` first.

        ``torsions``, one fewer than arcs, are the angles by which the plane turns from each arc to the next,
        counterclockwise about the tangent.
        """
        a, b = _arrays.numbers(radii, "radii"), _arrays.numbers(lengths, "lengths")
        if a.length != b.length:
            raise ArgumentError(f"lengths: expected {a.length}, as many as radii, found {b.length}")
        turns = _arrays.numbers(torsions, "torsions")
        pose = (vector(point, "point"), vector(tangent, "tangent"), vector(normal, "normal"))
        return cls._of(lib.shapeop_snakeCreateFromArcs(a.pointer, b.pointer, a.length, *turns, *pose))

    @classmethod
    def from_json(cls, json: str) -> Snake:
        """A snake from its JSON form."""
        return cls._of(lib.shapeop_snakeCreateFromText(_arrays.name_bytes(json, "json")))

    def __enter__(self) -> Snake:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.snakes.Snake, closed>"
        kind = "closed" if self.is_closed else "open"
        return f"<shapeop.snakes.Snake of {len(self.radii)} arcs, {kind}>"

    def copy(self) -> Snake:
        """Another snake like this one."""
        return Snake._of(lib.shapeop_snakeCopy(self._handle))

    def _report(self) -> Any:
        told = struct(_abi.shapeop_snake_report)
        check(lib.shapeop_snakeReport(self._handle, ctypes.byref(told)))
        return told

    @property
    def control(self) -> Any:
        """The control points, (n, 3)."""
        return self._points(lib.shapeop_snakeControl)

    @property
    def contacts(self) -> Any:
        """The contact points, where arcs meet; of an open snake its ends too."""
        return self._points(lib.shapeop_snakeContacts)

    @property
    def radii(self) -> Any:
        """The radii of the arcs."""
        return _arrays.doubles(self._doubles(lambda *a: lib.shapeop_snakeShapes(a[0], a[1], None, *a[2:]), 1))

    @property
    def lengths(self) -> Any:
        """The lengths of the arcs."""
        return _arrays.doubles(self._doubles(lambda *a: lib.shapeop_snakeShapes(a[0], None, *a[1:]), 1))

    @property
    def torsions(self) -> Any:
        """The angles by which the plane turns from each arc to the next."""
        return _arrays.doubles(self._doubles(lib.shapeop_snakeTorsions, 1))

    @property
    def arcs(self) -> list[Arc]:
        """The arcs, in order."""
        return self._arcs(NOW)

    @property
    def is_closed(self) -> bool:
        """Whether the last arc goes on with the first."""
        return bool(self._report().is_closed)

    @property
    def length(self) -> float:
        """The sum of the lengths of the arcs."""
        return float(self._report().length)

    @property
    def residual(self) -> float:
        """By how much a distance of control points that the arcs keep is off at most."""
        return float(self._report().residual)

    def sample(self, per_arc: int = 8) -> Any:
        """Points along the snake, ``per_arc`` intervals in each arc; the first of a closed one is not repeated."""
        return self._sample(NOW, per_arc)

    def deviation(self, surface: Any) -> float:
        """The largest distance of a contact point or the middle of an arc from a surface."""
        with self.copy() as other:
            other._set_surface(surface)
            return float(other._report().deviation)

    def freedoms(self, surface: Any = None) -> Freedoms:
        """In how many ways it can move to first order, in space, or where its control points move along a surface."""
        numbers = [ctypes.c_int() for _ in Freedoms._fields]
        with self.copy() as other:
            other._set_surface(surface)
            told = (ctypes.byref(number) for number in numbers)
            check(lib.shapeop_snakeFreedoms(other._handle, int(surface is not None), *told))
        return Freedoms(*(number.value for number in numbers))

    def move(self, control: Any) -> None:
        """Puts the control points elsewhere, as many as there are; they need not keep the distances."""
        check(lib.shapeop_snakeSetControl(self._handle, *points_of(control, "control")))

    def project(
        self,
        target: Any,
        *,
        fixed: Any = (),
        exact: bool = False,
        mu: Optional[float] = None,
        max_iterations: Optional[int] = None,
    ) -> Projection:
        """Puts the snake to a position near ``target`` that its arcs can have; with ``exact`` to the nearest one.

        ``target``: one point for each control point. Those that are ``fixed`` stay at their targets.
        """
        options = struct(_abi.shapeop_snake_options)
        check(lib.shapeop_snakeDefaultOptions(ctypes.byref(options)))
        given = {"mu": mu, "projection_iterations": max_iterations, "is_exact": _arrays.truth(exact, "exact")}
        set_options(options, given)
        told = struct(_abi.shapeop_snake_projection)
        points = points_of(target, "target")
        block = _arrays.ids(list(fixed), "fixed")
        with self.copy() as other:
            check(lib.shapeop_snakeSetFixed(other._handle, *block))
            check(lib.shapeop_snakeProject(other._handle, *points, ctypes.byref(options), ctypes.byref(told)))
            count = ctypes.c_int()
            control = doubles(3 * points.length)
            check(lib.shapeop_snakeControl(other._handle, control, points.length, ctypes.byref(count)))
        check(lib.shapeop_snakeSetControl(self._handle, control, points.length))
        return Projection(told.residual, told.moved, told.iterations, told.steps, bool(told.is_nearest))

    def pipe(self, radius: float, per_arc: int = 8, around: int = 12) -> Mesh:
        """The pipe of a radius around the snake; quads face outward."""
        return self._pipe(NOW, radius, per_arc, around)

    def lamellae(self, depth: float, along: Any = None, per_arc: int = 8) -> Mesh:
        """Lamellae of a depth: flat ones in the planes of the arcs, or a band ``along`` a vector."""
        return self._lamellae(NOW, depth, along, per_arc)

    def to_json(self) -> str:
        """The JSON form."""
        return told_text(lib.shapeop_snakeText(self._handle))

    def arcs_csv(self, tolerance: float = 1e-6) -> str:
        """A table with a line for each arc: kind, centre, radius, axis, start, angle, length."""
        return self._text(lib.shapeop_snakeArcsCsv, NOW, tolerance)

    def to_dxf(self, tolerance: float = 1e-6) -> str:
        """The arcs as a DXF drawing, a layer for each kind."""
        return self._text(lib.shapeop_snakeArcsDxf, NOW, tolerance)
