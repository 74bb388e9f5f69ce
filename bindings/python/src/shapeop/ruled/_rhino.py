"""Strips as surfaces of a Rhino file."""

from __future__ import annotations

import os
from typing import Any, Union

from .._library import ArgumentError
from ._kinds import Strip


def _surface(rhino: Any, strip: Strip) -> Any:
    control = [[[float(number) for number in point] for point in side] for side in strip.control]
    # Of a closed strip the first control points come again.
    count = len(strip.knots) - 4
    surface = rhino.NurbsSurface.Create(3, False, 4, 2, count, 2)
    for side in (0, 1):
        for i in range(count):
            surface.Points[(i, side)] = rhino.Point4d(*control[side][i % len(control[side])], 1.0)
    # openNURBS leaves the first knot and the last one out.
    for i, knot in enumerate([float(knot) for knot in strip.knots][1:-1]):
        surface.KnotsU[i] = knot
    surface.KnotsV[0], surface.KnotsV[1] = 0.0, 1.0
    return surface


def write(path: Union[str, os.PathLike[str]], strips: list[Strip], unit: str) -> None:
    """Writes a file of openNURBS 7: a surface for each strip, named ``strip-0`` and so on."""
    try:
        import rhino3dm
    except ImportError as error:
        raise ImportError("to_3dm: expected the package rhino3dm (pip install rhino3dm), which is missing") from error
    system = getattr(rhino3dm.UnitSystem, unit.capitalize(), None)
    if system is None:
        raise ArgumentError(f"unit: expected a unit of rhino3dm, such as 'meters' or 'millimeters'; found {unit!r}")
    model: Any = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = system
    for i, strip in enumerate(strips):
        attributes: Any = rhino3dm.ObjectAttributes()
        attributes.Name = f"strip-{i}"
        model.Objects.AddSurface(_surface(rhino3dm, strip), attributes)
    if not model.Write(os.fspath(path), 7):
        raise OSError(f"path: expected a file that can be written, found {os.fspath(path)!r}")
