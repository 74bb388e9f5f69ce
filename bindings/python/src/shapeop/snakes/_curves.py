"""Curves on surfaces, and snakes that are fitted to them."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _abi, _arrays
from .._calls import doubles, set_options, struct, vector
from .._library import ArgumentError, check, lib
from ._handle import mesh_arguments
from ._kinds import Curve, CurveEnd, Fitted, Surface
from ._snake import Snake


def curve(
    surface: Any,
    start: Any,
    tangent: Any,
    curvature: Any,
    length: float,
    *,
    turns: str = "left",
    steps: Optional[int] = None,
    method: str = "runge-kutta",
) -> Curve:
    """The curve of given curvature on a surface that begins at the nearest point to ``start`` along ``tangent``.

    ``surface``: a :class:`Surface`, a mesh of COMPAS, meshio or trimesh, or a pair of points and faces. ``curvature``:
    a number of 0 or more, or those at evenly spaced places along the length. Of two curves one turns ``"left"``, seen
    from where the surface's normal points, the other ``"right"``. There is none where the surface itself bends more.
    """
    sides, methods = {"left": False, "right": True}, {"runge-kutta": False, "chords": True}
    if turns not in sides:
        raise ArgumentError(f"turns: expected 'left' or 'right', found {turns!r}")
    if method not in methods:
        raise ArgumentError(f"method: expected 'runge-kutta' or 'chords', found {method!r}")
    options = struct(_abi.shapeop_snake_curve_options)
    check(lib.shapeop_snakeDefaultCurveOptions(ctypes.byref(options)))
    set_options(options, {"turns_right": sides[turns], "steps": steps, "method": methods[method]})
    told, count = struct(_abi.shapeop_snake_curve_report), ctypes.c_int()
    capacity = options.steps + 2
    points, bends = doubles(3 * capacity), _arrays.numbers(curvature, "curvature")
    how = (vector(start, "start"), vector(tangent, "tangent"), *bends, _arrays.real(length, "length"))
    room = (ctypes.byref(options), points, capacity, ctypes.byref(count), ctypes.byref(told))
    if isinstance(surface, Surface):
        of = _arrays.numbers(list(surface.numbers), "surface")
        check(lib.shapeop_snakeCurve(surface.kind, of.pointer, of.length, *how, *room))
    else:
        check(lib.shapeop_snakeMeshCurve(*mesh_arguments(surface), *how, *room))
    n = count.value
    found = doubles(3 * n)
    found[:] = points[: 3 * n]
    bent = (told.curvature, told.normal_curvature)
    return Curve(_arrays.shaped(found, n, 3), CurveEnd(told.end), told.length, *bent)


def fit(
    points: Any,
    arc_count: int,
    *,
    closed: bool = False,
    congruent: bool = True,
    curvature: Optional[float] = None,
    nearness: Optional[float] = None,
    max_iterations: Optional[int] = None,
) -> Fitted:
    """The snake of ``arc_count`` arcs of equal length along a polyline, open or ``closed``.

    ``congruent``: all arcs of an open one have one radius; ``curvature``: that of all arcs, if it is known. Arcs around
    a closed one are as curved as it is.
    """
    options = struct(_abi.shapeop_snake_fit_options)
    check(lib.shapeop_snakeDefaultFitOptions(ctypes.byref(options)))
    given = {"curvature": curvature, "nearness": nearness, "max_iterations": max_iterations}
    set_options(options, {**given, "is_congruent": _arrays.truth(congruent, "congruent")})
    told = struct(_abi.shapeop_snake_fit_report)
    block, is_closed = _arrays.points(points, "points"), int(_arrays.truth(closed, "closed"))
    how = (is_closed, _arrays.integer(arc_count, "arc_count"), ctypes.byref(options), ctypes.byref(told))
    snake = Snake._of(lib.shapeop_snakeFit(*block, *how))
    return Fitted(snake, told.deviation, told.residual, told.iterations, bool(told.is_converged))
