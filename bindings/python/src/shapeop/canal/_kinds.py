"""What the functions of this package take and answer with."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, Callable, NamedTuple

from .. import _abi

Wraps = tuple[bool, bool]
ProgressFunction = Callable[[float], object]
"""Called with the part done, 0 to 1; ``False`` (or anything false but ``None``) ends the call with its best so far."""


class Kind(IntEnum):
    """What the base of a surface is."""

    CANAL = _abi.SO_CANAL_KIND_CANAL
    REVOLUTION = _abi.SO_CANAL_KIND_REVOLUTION
    MOULDING = _abi.SO_CANAL_KIND_MOULDING
    CIRCULAR = _abi.SO_CANAL_KIND_CIRCULAR


class Center(IntEnum):
    """Which center of inversion to take."""

    MIDDLE = _abi.SO_CANAL_CENTER_MIDDLE
    ANGLE = _abi.SO_CANAL_CENTER_ANGLE
    RATIO_INSIDE = _abi.SO_CANAL_CENTER_RATIO_INSIDE
    RATIO_OUTSIDE = _abi.SO_CANAL_CENTER_RATIO_OUTSIDE
    POINT = _abi.SO_CANAL_CENTER_POINT
    CHORD = _abi.SO_CANAL_CENTER_CHORD


class Section(IntEnum):
    """Which part of the circles is meshed."""

    WHOLE = _abi.SO_CANAL_SECTION_WHOLE
    ANGLES = _abi.SO_CANAL_SECTION_ANGLES
    TO_CURVE = _abi.SO_CANAL_SECTION_TO_CURVE
    ABOVE = _abi.SO_CANAL_SECTION_ABOVE


class Spacing(IntEnum):
    """How points are spread over a curve."""

    ARC_LENGTH = _abi.SO_CANAL_SPACING_ARC_LENGTH
    PARAMETER = _abi.SO_CANAL_SPACING_PARAMETER
    POINTS = _abi.SO_CANAL_SPACING_POINTS


class Step(IntEnum):
    """What a transformation keeps."""

    SIMILARITY = _abi.SO_CANAL_STEP_SIMILARITY
    MOEBIUS = _abi.SO_CANAL_STEP_MOEBIUS
    COMBESCURE = _abi.SO_CANAL_STEP_COMBESCURE


class Stop(IntEnum):
    """Why smoothing stopped."""

    GRADIENT = _abi.SO_CANAL_STOP_GRADIENT
    DECREASE = _abi.SO_CANAL_STOP_DECREASE
    ITERATIONS = _abi.SO_CANAL_STOP_ITERATIONS
    LINE_SEARCH = _abi.SO_CANAL_STOP_LINE_SEARCH
    CANCELLED = _abi.SO_CANAL_STOP_CANCELLED
    INFEASIBLE = _abi.SO_CANAL_STOP_INFEASIBLE


class Quality(NamedTuple):
    """How circular quads are, one entry each."""

    planarity: Any
    concyclicity: Any
    is_in_order: list[bool]


class Strip(NamedTuple):
    """The border of a strip and how it was made."""

    border: Any
    lengths: Any
    attainable: Any
    is_flipped: list[bool]
    is_projected: list[bool]
    deviation: float


class Smoothed(NamedTuple):
    """A smoothed strip."""

    guide: Any
    border: Any
    frame: Any
    before: float
    after: float
    iterations: int
    stop: Stop


class Holonomy(NamedTuple):
    """How a frame comes back around a closed polygon."""

    matrix: Any
    residual: float
    closes: bool
    tangent: Any


class Closed(NamedTuple):
    """A closed strip."""

    border: Any
    circle: Any
    which_case: int
    is_flipped: list[bool]


class ClosingCircle(NamedTuple):
    """The circle that closes a strip, where the strip then starts, and the point across from the guide's last one."""

    circle: Any
    first: Any
    last: Any
    which_case: int
    is_crossed: bool


class Kinks(NamedTuple):
    """Lines along which a surface is creased: rows if ``direction`` is 1, columns if it is 2.

    ``lines``: their indices, neither 0 nor beyond the last. ``angles``: by how much the frames from there on are
    turned about each, in radians.
    """

    direction: int
    lines: Any
    angles: Any


class NodeAxes(NamedTuple):
    """Axes of nodes, (rows, columns, 3), and the gaps of beams of height 1, (rows, columns)."""

    axes: Any
    gaps: Any
    is_cancelled: bool


class Panels(NamedTuple):
    """Flat panels, one for each face."""

    outlines: Any
    lower_outlines: Any
    mitres: Any
    circles: Any
    heights: Any
