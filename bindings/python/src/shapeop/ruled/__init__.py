"""Ruled free forms: a negatively curved mesh as strips of straight lines (Flöry et al. 2012).

A :class:`Design` goes from a mesh to strips step by step: asymptotic directions, strip boundaries across them, strips
to start from, conditions, strips that are optimal. Strips come back as control points of B-spline surfaces, meshes,
rulings and texts; conoidal ones are cut into planks. Lengths are in model units, angles in radians.

What comes back are float64 arrays, or nested lists where numpy is not installed. What the library refuses raises
:class:`shapeop.Error`; geometry that does not fit (a mesh that is not negatively curved, conditions that contradict
each other) a :class:`shapeop.GeometryError`.
"""

from ._design import Design, zebra
from ._kinds import (
    Axis,
    Boundary,
    Curvatures,
    Directions,
    Dropped,
    End,
    Evaluated,
    Field,
    Image,
    JointReport,
    LevelReport,
    Levels,
    Optimised,
    Plank,
    Planks,
    PointStatus,
    Progress,
    ProgressFunction,
    Report,
    Rulings,
    Started,
    Stop,
    Strip,
    StripMesh,
    StripReport,
    Trace,
    TraceEnd,
)

__all__ = [
    "Axis",
    "Boundary",
    "Curvatures",
    "Design",
    "Directions",
    "Dropped",
    "End",
    "Evaluated",
    "Field",
    "Image",
    "JointReport",
    "LevelReport",
    "Levels",
    "Optimised",
    "Plank",
    "Planks",
    "PointStatus",
    "Progress",
    "ProgressFunction",
    "Report",
    "Rulings",
    "Started",
    "Stop",
    "Strip",
    "StripMesh",
    "StripReport",
    "Trace",
    "TraceEnd",
    "zebra",
]
