"""Surfaces from curves, and the steps between."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Optional, Union

from .. import _abi, _arrays
from .._library import ArgumentError, check, lib, text
from ._arguments import _circles, _doubles, _ints, _of_length, _optional, _truths, _vector, _Watch
from ._kinds import Center, Kind, ProgressFunction, Section, Spacing, Step
from ._strips import _set
from ._surface import CanalSurface, _m_moulding


class Fit(NamedTuple):
    """A canal surface that fits two curves.

    ``sphere_flags``, one for each sphere: bits 1, it passes through an end of the second curve and is not tangent to
    it; 2, it touches another branch than the sphere before; 4, it is on the other side of the first curve than that; 8,
    another branch is inside.
    """

    surface: CanalSurface
    circles: Any
    spheres: Any
    deviation: float
    residual: float
    tangent_gap: float
    closing_gap: float
    is_outward: bool
    sphere_flags: list[int]


class Swept(NamedTuple):
    """A surface of a profile that moves along a rail, and what was found.

    ``obliquity``: the angle in radians between the normal of the profile's plane and the rail's start.
    ``reversed_count``: how many edges point the other way than the rail's, where the profile reaches beyond the rail's
    evolute. ``closing_gap``: for a closed rail, how far the profile is from itself after one turn.
    """

    surface: CanalSurface
    obliquity: float
    reversed_count: int
    closing_gap: float


class MMoulding(NamedTuple):
    """As :class:`Swept`, for the base of an inversion; ``corner_gap``: how far the last corner is from ``p3``, or 0."""

    surface: CanalSurface
    obliquity: float
    reversed_count: int
    closing_gap: float
    corner_gap: float


class CCanal(NamedTuple):
    """A C-canal surface and how well it meets what was asked for; one entry for each row.

    ``attainable``: the least and the greatest length that the rows before left, (rows, 2).
    """

    surface: CanalSurface
    lengths: Any
    deviations: Any
    is_projected: list[bool]
    is_cancelled: bool
    attainable: Any


def _fit_options(options: dict[str, Any]) -> Any:
    asked = _abi.shapeop_canal_fit_options(struct_size=ctypes.sizeof(_abi.shapeop_canal_fit_options))
    check(lib.shapeop_canalDefaultFitOptions(ctypes.byref(asked)))
    for name, kind in (("section", Section), ("spacing", Spacing)):
        if name in options:
            options[name] = _arrays.member(kind, options[name], name)
    _set(asked, options)
    return asked


def fit(guide: Any, curve: Any, *, guide_closed: bool = False, curve_closed: bool = False, **options: Any) -> Fit:
    """The canal surface through the spline of ``guide`` that touches the spline of ``curve``.

    ``options``: the fields of ``shapeop_canal_fit_options`` in the C header, such as ``circle_count`` and ``angle``;
    ``section`` and ``spacing`` also by name.
    """
    a, b = _arrays.points(guide, "guide"), _arrays.points(curve, "curve")
    asked = _fit_options(options)
    told = _abi.shapeop_canal_fit_report(struct_size=ctypes.sizeof(_abi.shapeop_canal_fit_report))
    capacity = max(asked.circle_count, a.length) + 1
    circles, spheres, flags = _doubles(7 * capacity), _doubles(4 * capacity), _ints(capacity)
    circle_count, sphere_count = ctypes.c_int(), ctypes.c_int()
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
        flags,
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
        list(flags[:m]),
    )


def _swept(function: Any, rail: Any, profile: Any) -> Swept:
    rails, profiles = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
    obliquity, reversed_count, gap = ctypes.c_double(), ctypes.c_int(), ctypes.c_double()
    outputs = (ctypes.byref(obliquity), ctypes.byref(reversed_count), ctypes.byref(gap))
    surface = CanalSurface._of(function(*rails, *profiles, *outputs))
    return Swept(surface, obliquity.value, reversed_count.value, gap.value)


def moulding(rail: Any, profile: Any) -> Swept:
    """The moulding surface of a planar rail and a profile in an orthogonal plane that starts on it, and findings."""
    return _swept(lib.shapeop_canalMoulding, rail, profile)


def monge(rail: Any, profile: Any) -> Swept:
    """The Monge surface of a rail in space and a planar profile that starts on it, and findings."""
    return _swept(lib.shapeop_canalMonge, rail, profile)


def m_moulding(
    curve: Any,
    rail: Any,
    p3: Optional[Any] = None,
    center: Union[Center, str] = Center.CHORD,
    value: float = 0.0,
    point: Optional[Any] = None,
) -> MMoulding:
    """The surface of :meth:`CanalSurface.m_moulding`, and findings."""
    obliquity, gap, corner_gap, reversed_count = *(ctypes.c_double() for _ in range(3)), ctypes.c_int()
    outputs = tuple(ctypes.byref(each) for each in (obliquity, reversed_count, gap, corner_gap))
    surface = CanalSurface._of(_m_moulding(curve, rail, p3, center, value, point, outputs))
    return MMoulding(surface, obliquity.value, reversed_count.value, gap.value, corner_gap.value)


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
    made, deviations, attainable = (_doubles(n * a.length) for n in (1, 1, 2))
    projected, cancelled = _ints(a.length), ctypes.c_int()
    flags = (int(_arrays.truth(curve_closed, "curve_closed")), int(_arrays.truth(project_lengths, "project_lengths")))
    with _Watch(progress) as watch:
        outputs = (made, deviations, attainable, projected, ctypes.byref(cancelled))
        handle = lib.shapeop_canalCCanal(*a, *b, own, *second, *flags, watch.callback, None, *outputs)
        surface = CanalSurface._of(handle)
    rows = surface.shape[0]
    return CCanal(
        surface,
        _arrays.doubles((ctypes.c_double * rows)(*made[:rows])),
        _arrays.doubles((ctypes.c_double * rows)(*deviations[:rows])),
        _truths(projected[:rows]),
        bool(cancelled.value),
        _arrays.shaped((ctypes.c_double * (2 * rows))(*attainable[: 2 * rows]), rows, 2),
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


def column_on_circles(circles: Any, start: Any, guide: Optional[Any] = None) -> Any:
    """A point of each circle, from ``start``, a point of the first, on.

    With ``guide``, a point of each circle, both make a strip of circular quads; without, it is a column along which a
    mesh closes around whole circles.
    """
    block, first = _circles(circles, "circles"), _vector(start, "start")
    other = _arrays.Block(None, block.length) if guide is None else _arrays.points(guide, "guide")
    if other.length != block.length:
        raise ArgumentError(f"guide: expected {block.length} points, found {other.length}")
    out = _doubles(3 * block.length)
    check(lib.shapeop_canalColumn(*block, first, other.pointer, out))
    return _arrays.shaped(out, block.length, 3)


def section_points(
    circle: Any,
    start: Any,
    count: int,
    section: Union[Section, str] = Section.WHOLE,
    target: Optional[Any] = None,
    **options: Any,
) -> Any:
    """``count`` points of a section of a circle at equal angles, from its point ``start`` on.

    ``target``: where the second curve passes, for :attr:`Section.TO_CURVE`. ``options``: those on the section of
    ``shapeop_canal_fit_options`` in the C header, such as ``to_angle``.
    """
    number = _arrays.integer(count, "count")
    options = {**options, "section": _arrays.member(Section, section, "section"), "column_count": number}
    out, asked, own = _doubles(3 * number), _fit_options(options), _of_length(circle, "circle", 7)
    points = (_vector(start, "start"), _optional(target, "target"))
    check(lib.shapeop_canalSectionPoints(own, *points, ctypes.byref(asked), out))
    return _arrays.shaped(out, number, 3)


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
