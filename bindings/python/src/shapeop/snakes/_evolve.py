"""How snakes move."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import doubles, set_options, struct, vector
from .._library import ArgumentError, check, check_message, lib
from ._frames import Frames
from ._handle import Handle, watch
from ._kinds import ProgressFunction, Rail, Stop, Velocity, Wish, points_of
from ._snake import Snake


def _add_rail(handle: int, rail: Rail) -> None:
    curve = (*points_of(rail.curve, "curve"), int(_arrays.truth(rail.is_closed, "closed")))
    point = _arrays.integer(rail.point, "contact" if rail.role == "glide" else "point")
    if rail.role == "drive":
        number = lib.shapeop_snakeDriveRail(handle, point, *curve, _arrays.real(rail.speed, "speed"))
    elif rail.role == "follow":
        number = lib.shapeop_snakeFollowRail(handle, point, *curve, _arrays.integer(rail.leader, "leader"))
    else:
        number = lib.shapeop_snakeGlideRail(handle, point, *curve)
    if number < 0:
        check_message()


def _add_wish(handle: int, wish: Wish) -> None:
    function = lib.shapeop_snakeWishPlane if wish.is_plane else lib.shapeop_snakeWishVelocity
    point, name = _arrays.integer(wish.point, "point"), "normal" if wish.is_plane else "velocity"
    check(function(handle, point, vector(wish.vector, name), _arrays.real(wish.weight, "weight")))


def _set_up(
    of: Handle,
    surface: Any,
    direction: Any,
    speeds: Any,
    fixed: Any,
    rails: Sequence[Rail],
    wishes: Sequence[Wish],
) -> None:
    handle = of._handle
    of._set_surface(surface)
    kind, along = _abi.SO_SNAKE_DIRECTION_FREE, None
    if isinstance(direction, str):
        if direction != "sideways":
            raise ArgumentError(f"direction: expected 'sideways', a vector or None, found {direction!r}")
        kind = _abi.SO_SNAKE_DIRECTION_SIDEWAYS
    elif direction is not None:
        kind, along = _abi.SO_SNAKE_DIRECTION_ALONG, vector(direction, "direction")
    check(lib.shapeop_snakeSetDirection(handle, kind, along))
    check(lib.shapeop_snakeSetSpeeds(handle, *_arrays.numbers(speeds, "speeds")))
    check(lib.shapeop_snakeSetFixed(handle, *_arrays.ids(list(fixed), "fixed")))
    for rail in rails:
        _add_rail(handle, rail)
    for wish in wishes:
        _add_wish(handle, wish)


def _options(given: dict[str, Any]) -> Any:
    options = struct(_abi.shapeop_snake_options)
    check(lib.shapeop_snakeDefaultOptions(ctypes.byref(options)))
    return set_options(options, given)


class Evolution(Frames):
    """The positions of a snake that moved, why it stopped, and the surface that it swept.

    ``stop_rail`` is the rail that stopped it, if one did; ``stop_distance`` by how much it would have missed that rail,
    or the surface.
    """

    stop: Stop
    stop_rail: Optional[int]
    stop_distance: float

    def __enter__(self) -> Evolution:
        self._handle  # noqa: B018 - raises if it was closed
        return self

    def __repr__(self) -> str:
        if self._open_handle is None:
            return "<shapeop.snakes.Evolution, closed>"
        return f"<shapeop.snakes.Evolution of {len(self)} positions, stopped by {self.stop.name}>"

    def _column(self, k: int) -> Any:
        rows = self._doubles(lib.shapeop_snakeFrameRows, 7)
        column = doubles(len(rows) // 7)
        column[:] = rows[k::7]
        return _arrays.doubles(column)

    @property
    def times(self) -> Any:
        """When the snake is at each position."""
        return self._column(0)

    @property
    def deviations(self) -> Any:
        """The largest distance of a contact point or the middle of an arc from the surface, at each position."""
        return self._column(1)

    @property
    def residuals(self) -> Any:
        """By how much a distance or a rail is missed at most, at each position."""
        return self._column(2)

    @property
    def height_residuals(self) -> Any:
        """By how much the height of a control point over the surface differs from that at the start at most."""
        return self._column(3)

    @property
    def incongruences(self) -> Any:
        """By how much a distance of control points three apart is off, where those are kept."""
        return self._column(4)

    @property
    def predicted_residuals(self) -> Any:
        """By how much a distance was off at most before each position was projected."""
        return self._column(5)


def evolve(
    snake: Snake,
    surface: Any = None,
    *,
    direction: Any = None,
    speeds: Any = 1.0,
    fixed: Any = (),
    rails: Sequence[Rail] = (),
    wishes: Sequence[Wish] = (),
    step: Optional[float] = None,
    max_steps: Optional[int] = None,
    max_deviation: Optional[float] = None,
    tangential: Optional[float] = None,
    offset: Optional[float] = None,
    rotation: Optional[float] = None,
    orthogonal: Optional[float] = None,
    second_order: bool = False,
    keeps_torsions: bool = False,
    stops_at_cycle: bool = True,
    alpha: Optional[float] = None,
    least_step: Optional[float] = None,
    mu: Optional[float] = None,
    surface_weight: Optional[float] = None,
    exact: bool = False,
    progress: Optional[ProgressFunction] = None,
) -> Evolution:
    """Moves a snake step by step while its arcs keep their shapes; the snake itself stays where it is.

    ``surface``: a :class:`Surface`, a mesh of COMPAS, meshio or trimesh, or a pair of points and faces that the snake
    keeps its height over. ``direction``: ``"sideways"`` on the surface, to the left of the snake, or a vector, with
    ``speeds``, one or one for each control point; ``fixed``: control points that stay; ``rails`` and ``wishes`` as
    :func:`drive`, :func:`follow`, :func:`glide`, :func:`with_velocity` and :func:`in_plane` make them.

    ``max_deviation``: it stops before an arc is farther from the surface. ``tangential``, ``offset``, ``rotation`` and
    ``orthogonal`` are weights: of velocities along the surface, of the speeds asked for, of torsions that do not
    change, of velocities across the arcs. ``keeps_torsions``: it moves rigidly, as well as rails allow.
    """
    flags = {
        "is_second_order": _arrays.truth(second_order, "second_order"),
        "keeps_torsions": _arrays.truth(keeps_torsions, "keeps_torsions"),
        "stops_at_cycle": _arrays.truth(stops_at_cycle, "stops_at_cycle"),
        "is_exact": _arrays.truth(exact, "exact"),
    }
    numbers = {
        "step": step,
        "max_steps": max_steps,
        "max_deviation": max_deviation,
        "tangential": tangential,
        "offset": offset,
        "rotation": rotation,
        "orthogonal": orthogonal,
        "alpha": alpha,
        "least_step": least_step,
        "mu": mu,
        "surface_weight": surface_weight,
    }
    if max_deviation is not None and _arrays.real(max_deviation, "max_deviation") < 0:
        raise ArgumentError(f"max_deviation: expected a number of 0 or more, found {max_deviation}")
    options, told = _options({**flags, **numbers}), struct(_abi.shapeop_snake_evolution)
    evolution = Evolution.__new__(Evolution)
    evolution._open(lib.shapeop_snakeCopy(snake._handle))
    _set_up(evolution, surface, direction, speeds, fixed, rails, wishes)
    with watch(progress) as watching:
        answer = lib.shapeop_snakeEvolve(
            evolution._handle, ctypes.byref(options), watching.callback, None, ctypes.byref(told)
        )
    check(answer)
    evolution.stop = Stop(told.stop)
    evolution.stop_rail = None if told.stop_rail < 0 else told.stop_rail
    evolution.stop_distance = told.stop_distance
    return evolution


def velocity(
    snake: Snake,
    surface: Any = None,
    *,
    direction: Any = None,
    speeds: Any = 1.0,
    fixed: Any = (),
    rails: Sequence[Rail] = (),
    wishes: Sequence[Wish] = (),
    tangential: Optional[float] = None,
    offset: Optional[float] = None,
    rotation: Optional[float] = None,
    orthogonal: Optional[float] = None,
    keeps_torsions: bool = False,
) -> Velocity:
    """The velocities with which :func:`evolve` would begin."""
    weights = {"tangential": tangential, "offset": offset, "rotation": rotation, "orthogonal": orthogonal}
    options = _options({**weights, "keeps_torsions": _arrays.truth(keeps_torsions, "keeps_torsions")})
    residual = ctypes.c_double()
    with snake.copy() as other:
        _set_up(other, surface, direction, speeds, fixed, rails, wishes)
        how = (ctypes.byref(options),)
        off = ctypes.byref(residual)
        vectors = other._points(lambda *a: lib.shapeop_snakeVelocity(*a, off), *how)
    return Velocity(vectors, residual.value)


def sweep(snake: Snake, rails: Sequence[Rail], *, rigid: bool = True, **options: Any) -> Evolution:
    """Moves a snake along rails alone, rigidly as far as they allow; ``options`` are those of :func:`evolve`.

    A surface of congruent snakes: one end is driven along a rail, the other follows on another, and the snake glides on
    a third one in between.
    """
    return evolve(snake, rails=rails, keeps_torsions=rigid, **options)
