"""Circular arc snakes: smooth chains of arcs that move while each arc keeps its shape (Bartoň et al. 2013).

A :class:`Snake` is made from control points, from arcs, or fitted to a polyline (:func:`fit`), such as a curve of given
curvature on a surface (:func:`curve`). :func:`evolve` moves it, along a surface or guided by rails, into an
:class:`Evolution`: positions, the surface that they sweep, the arcs that it is made of. :class:`Linkage` moves one of
six arcs on hinges around its cycle. Lengths are in model units, angles in radians.

What comes back are float64 arrays, or nested lists where numpy is not installed. What the library refuses raises
:class:`shapeop.Error`; geometry that does not fit a :class:`shapeop.GeometryError`.
"""

from ._curves import curve, fit
from ._evolve import Evolution, evolve, sweep, velocity
from ._kinds import (
    Arc,
    ArcKind,
    Congruence,
    Covering,
    Curve,
    CurveEnd,
    CycleEnd,
    Fitted,
    Freedoms,
    Mesh,
    Motion,
    Progress,
    ProgressFunction,
    Projection,
    Rail,
    Stop,
    Surface,
    Velocity,
    Wish,
    cylinder,
    drive,
    follow,
    glide,
    in_plane,
    plane,
    sphere,
    torus,
    with_velocity,
)
from ._linkage import Cycle, Linkage
from ._snake import Snake

__all__ = [
    "Arc",
    "ArcKind",
    "Congruence",
    "Covering",
    "Curve",
    "CurveEnd",
    "Cycle",
    "CycleEnd",
    "Evolution",
    "Fitted",
    "Freedoms",
    "Linkage",
    "Mesh",
    "Motion",
    "Progress",
    "ProgressFunction",
    "Projection",
    "Rail",
    "Snake",
    "Stop",
    "Surface",
    "Velocity",
    "Wish",
    "curve",
    "cylinder",
    "drive",
    "evolve",
    "fit",
    "follow",
    "glide",
    "in_plane",
    "plane",
    "sphere",
    "sweep",
    "torus",
    "velocity",
    "with_velocity",
]
