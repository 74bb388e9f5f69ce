"""What functions on snakes take and answer with. Lengths are in model units, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Callable, NamedTuple, Optional

from .. import _abi, _arrays
from .._library import ArgumentError


class Progress(NamedTuple):
    """Where a run is. Time, deviation and residual are those of an evolution, the angles those of a linkage."""

    step: int
    fraction: float
    time: float
    deviation: float
    residual: float
    first_angle: float
    last_angle: float


ProgressFunction = Callable[[Progress], object]
"""Called before every step; ``False`` (or anything false but ``None``) ends the call with the positions so far."""


class Stop(IntEnum):
    """Why an evolution stopped."""

    STEPS = _abi.SO_SNAKE_STOP_STEPS
    DEVIATION = _abi.SO_SNAKE_STOP_DEVIATION
    SINGULAR = _abi.SO_SNAKE_STOP_SINGULAR
    RAIL_END = _abi.SO_SNAKE_STOP_RAIL_END
    PARALLEL = _abi.SO_SNAKE_STOP_PARALLEL
    CYCLE = _abi.SO_SNAKE_STOP_CYCLE
    STALLED = _abi.SO_SNAKE_STOP_STALLED
    CANCELLED = _abi.SO_SNAKE_STOP_CANCELLED


class CurveEnd(IntEnum):
    """Why a curve of given curvature ends."""

    LENGTH = _abi.SO_SNAKE_CURVE_LENGTH
    BOUNDARY = _abi.SO_SNAKE_CURVE_BOUNDARY
    BENDS_MORE = _abi.SO_SNAKE_CURVE_BENDS_MORE
    FOLD = _abi.SO_SNAKE_CURVE_FOLD


class CycleEnd(IntEnum):
    """Why a linkage's motion ends."""

    CLOSED = _abi.SO_SNAKE_CYCLE_CLOSED
    STEPS = _abi.SO_SNAKE_CYCLE_STEPS
    FREEDOMS = _abi.SO_SNAKE_CYCLE_FREEDOMS
    STALLED = _abi.SO_SNAKE_CYCLE_STALLED
    CANCELLED = _abi.SO_SNAKE_CYCLE_CANCELLED


class Surface(NamedTuple):
    """A surface that a few numbers tell: see :func:`plane`, :func:`sphere`, :func:`cylinder` and :func:`torus`."""

    kind: int
    numbers: tuple[float, ...]


def _surface(kind: int, *parts: tuple[Any, str]) -> Surface:
    numbers: list[float] = []
    for value, name in parts:
        if hasattr(value, "__len__"):
            numbers += _arrays.vector(value, name).pointer[0:3]
        else:
            numbers.append(_arrays.real(value, name))
    return Surface(kind, tuple(numbers))


def plane(point: Any, normal: Any) -> Surface:
    """The plane through a point with this normal, of any length."""
    return _surface(_abi.SO_SNAKE_SURFACE_PLANE, (point, "point"), (normal, "normal"))


def sphere(center: Any, radius: float) -> Surface:
    """A sphere. Normals point outward, here and below."""
    return _surface(_abi.SO_SNAKE_SURFACE_SPHERE, (center, "center"), (radius, "radius"))


def cylinder(point: Any, axis: Any, radius: float) -> Surface:
    """The cylinder about the axis through a point in this direction."""
    return _surface(_abi.SO_SNAKE_SURFACE_CYLINDER, (point, "point"), (axis, "axis"), (radius, "radius"))


def torus(center: Any, axis: Any, radius: float, tube: float) -> Surface:
    """A torus about an axis: a tube of the radius ``tube`` around the circle of ``radius``."""
    parts = ((center, "center"), (axis, "axis"), (radius, "radius"), (tube, "tube"))
    return _surface(_abi.SO_SNAKE_SURFACE_TORUS, *parts)


class Rail(NamedTuple):
    """A curve that guides a snake: see :func:`drive`, :func:`follow` and :func:`glide`."""

    role: str
    point: int
    """The control point; of a rail that the snake glides on the contact point."""
    curve: Any
    is_closed: bool
    speed: float
    leader: int


def drive(point: int, curve: Any, speed: float = 1.0, closed: bool = False) -> Rail:
    """A rail along which a control point runs, at a speed in model units per time.

    The rail is the spline through the points of ``curve``, which passes the control point: there the run begins. With a
    speed below 0 it goes against their order.
    """
    return Rail("drive", point, curve, closed, speed, -1)


def follow(point: int, curve: Any, leader: int = 0, closed: bool = False) -> Rail:
    """A rail along which a control point keeps its distance from that of another, driven rail.

    ``leader`` is that rail's place in the list, before this one.
    """
    return Rail("follow", point, curve, closed, 0.0, leader)


def glide(contact: int, curve: Any, closed: bool = False) -> Rail:
    """A rail that the snake stays in touch with, at whatever place of either; it begins at a contact point."""
    return Rail("glide", contact, curve, closed, 0.0, -1)


class Wish(NamedTuple):
    """What the velocity of a control point is to be: see :func:`with_velocity` and :func:`in_plane`."""

    is_plane: bool
    point: int
    vector: Any
    weight: float


def with_velocity(point: int, velocity: Any, weight: float = 1.0) -> Wish:
    """A control point is to move with this velocity."""
    return Wish(False, point, velocity, weight)


def in_plane(point: int, normal: Any, weight: float = 1.0) -> Wish:
    """A control point is to move in the plane with this normal."""
    return Wish(True, point, normal, weight)


class Arc(NamedTuple):
    """An arc; it turns counterclockwise about ``axis``, from ``start`` by ``angle``."""

    center: tuple[float, float, float]
    radius: float
    axis: tuple[float, float, float]
    start: tuple[float, float, float]
    angle: float


@dataclass(frozen=True)
class ArcKind:
    """Arcs to be made that are alike, and how many of them one position has."""

    radius: float
    length: float
    count: int


@dataclass(frozen=True)
class Covering:
    """What the positions of a snake come to.

    Of a surface that is no mesh, ``is_compared`` is ``False`` and what follows it is 0. ``coverage``: the part of the
    mesh that the swept surface is within ``distance`` of; ``largest_deviation``, at ``at``, of the swept surface from
    the mesh; ``beyond_count``: samples beyond the boundary of the mesh, which do not count.
    """

    position_count: int
    arc_count: int
    kind_count: int
    length: float
    area: float
    residual: float
    is_compared: bool
    reference_area: float
    coverage: float
    distance: float
    largest_deviation: float
    at: tuple[float, float, float]
    rms_deviation: float
    beyond_count: int
    json: str
    """The JSON form, with the kinds of arcs."""


class Freedoms(NamedTuple):
    """In how many ways a snake can move, the conditions on that, and how many of them are independent."""

    free: int
    conditions: int
    rank: int


class Congruence(NamedTuple):
    """How far two positions are from being the same up to a rigid motion.

    ``rms``: of the distances of control points after the best rigid motion; ``distances``: by how much the distance of
    two control points differs at most.
    """

    rms: float
    distances: float


class Velocity(NamedTuple):
    """The velocities of control points, (n, 3), and by how much they miss a condition at most."""

    vectors: Any
    residual: float


class Projection(NamedTuple):
    """What a projection found; ``moved``: by how much a control point is from its target at most."""

    residual: float
    moved: float
    iterations: int
    steps: int
    is_nearest: bool


class Curve(NamedTuple):
    """A curve of given curvature: its points, (n, 3), why it ends, and its length.

    Where the surface bends more than the curve may, the last two are the curvature asked for there, and the surface's.
    """

    points: Any
    end: CurveEnd
    length: float
    curvature: float
    normal_curvature: float


class Mesh(NamedTuple):
    """A mesh of quads: points, (n, 3), and four of them for each quad, (m, 4)."""

    points: Any
    faces: Any


@dataclass(frozen=True)
class Fitted:
    """A snake that was fitted, ``deviation`` from the polyline at most."""

    snake: Any
    deviation: float
    residual: float
    iterations: int
    is_converged: bool


@dataclass(frozen=True)
class Motion:
    """What was found of a linkage's motion.

    ``closing``: how far a motion that is closed is from its start, ``None`` of another; ``ranges``: how far apart the
    extreme positions of the first and the last arc are; ``turns``: whole turns of them in a cycle.
    """

    end: CycleEnd
    free: int
    closing: Optional[float]
    ranges: tuple[float, float]
    turns: tuple[int, int]
    switch_count: int
    residual: float


def points_of(values: Any, name: str) -> _arrays.Block:
    """Points that are given as an array or as lists, of which there is at least one."""
    block = _arrays.points(values, name)
    if block.length == 0:
        raise ArgumentError(f"{name}: expected points, found none")
    return block
