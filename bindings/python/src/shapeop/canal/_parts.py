"""What a workshop cuts: node axes, panels, beams."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _arrays
from .._library import check, check_message, lib, text
from ._arguments import _doubles, _Grid, _ints, _vector, _Watch
from ._kinds import NodeAxes, Panels, ProgressFunction, Wraps


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


def node_gaps(grid: Any, axes: Any, height: float = 1.0, wraps: Wraps = (False, False)) -> tuple[Any, Any]:
    """What given axes make of beams, (rows, columns) each.

    The gaps: for beams of height 1, the difference of the depths along an axis down to which they reach. The depths:
    how far the deepest beam of ``height`` reaches.
    """
    own = _Grid(grid, wraps)
    gaps, depths = _doubles(own.count), _doubles(own.count)
    check(lib.shapeop_canalNodeGaps(*own.arguments, own.axes(axes), _arrays.real(height, "height"), gaps, depths))
    return _arrays.shaped(gaps, own.rows, own.columns), _arrays.shaped(depths, own.rows, own.columns)


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
