"""What the methods of designs take and answer with. Lengths are in model units, angles in radians."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Callable, NamedTuple

from .. import _abi


class Progress(NamedTuple):
    """Where a run is; the last two are 0 while a level function is found."""

    iteration: int
    fraction: float
    value: float
    largest_deviation: float
    largest_gap: float


ProgressFunction = Callable[[Progress], object]
"""Called before every iteration; ``False`` (or anything false but ``None``) ends the call with its best so far."""


class PointStatus(IntEnum):
    """What was found at a point of the mesh."""

    GOOD = _abi.SO_RULED_POINT_GOOD
    NOT_NEGATIVE = _abi.SO_RULED_POINT_NOT_NEGATIVE
    NOT_FITTED = _abi.SO_RULED_POINT_NOT_FITTED


class TraceEnd(IntEnum):
    """Why an asymptotic curve ends."""

    BOUNDARY = _abi.SO_RULED_END_BOUNDARY
    UNKNOWN = _abi.SO_RULED_END_UNKNOWN
    LENGTH = _abi.SO_RULED_END_LENGTH
    STEPS = _abi.SO_RULED_END_STEPS


class Levels(IntEnum):
    """What strip boundaries are to be."""

    ORTHOGONAL = _abi.SO_RULED_LEVELS_ORTHOGONAL
    DIRECTION = _abi.SO_RULED_LEVELS_DIRECTION
    EQUIDISTANT = _abi.SO_RULED_LEVELS_EQUIDISTANT
    GEODESIC = _abi.SO_RULED_LEVELS_GEODESIC
    CONOIDAL = _abi.SO_RULED_LEVELS_CONOIDAL


class Image(IntEnum):
    """What the spherical image of a field is like."""

    NONE = _abi.SO_RULED_IMAGE_NONE
    REGULAR = _abi.SO_RULED_IMAGE_REGULAR
    FOLDED = _abi.SO_RULED_IMAGE_FOLDED
    GREAT_CIRCLE = _abi.SO_RULED_IMAGE_GREAT_CIRCLE
    CURVE = _abi.SO_RULED_IMAGE_CURVE


class Stop(IntEnum):
    """Why a run stopped."""

    NONE = _abi.SO_RULED_STOP_NONE
    CONVERGED = _abi.SO_RULED_STOP_CONVERGED
    ITERATIONS = _abi.SO_RULED_STOP_ITERATIONS
    LINE_SEARCH = _abi.SO_RULED_STOP_LINE_SEARCH
    CANCELLED = _abi.SO_RULED_STOP_CANCELLED


class End(IntEnum):
    """An end of an open strip."""

    START = 0
    FINISH = 1


class Curvatures(NamedTuple):
    """Of each point: two principal curvatures, the greater first, (n, 2); their directions, (n, 2, 3); the normal."""

    principal: Any
    directions: Any
    normals: Any


class Directions(NamedTuple):
    """A family of asymptotic directions, (n, 3), with any sign; 0 where there are none. ``status`` says why."""

    vectors: Any
    status: list[PointStatus]


class Field(NamedTuple):
    """The directions that rulings follow, with signs that agree, (n, 3), and where they are known."""

    vectors: Any
    is_known: list[bool]


class Trace(NamedTuple):
    """An asymptotic curve: its points, the start first, and why it ends."""

    points: Any
    end: TraceEnd


class Boundary(NamedTuple):
    """A strip boundary, whether its last point is followed by the first, and its level.

    The level is the value of the level function, or the number of the plane, axis or curve.
    """

    points: Any
    is_closed: bool
    level: float


class Axis(NamedTuple):
    """The unit vector that directions are most nearly orthogonal to, and by how much they are off."""

    direction: Any
    error: float


class Dropped(NamedTuple):
    """A curve that was too short to be a boundary."""

    level: float
    length: float


@dataclass(frozen=True)
class LevelReport:
    """What was found of a level function."""

    stop: Stop
    iterations: int
    critical_count: int
    least_slope: float
    greatest_slope: float
    image: Image
    image_extent: float
    image_folded: float
    image_flatness: float
    image_axis: tuple[float, float, float]
    image_unused_count: int


class Started(NamedTuple):
    """For each strip: rulings that did not meet the second boundary, and those moved to follow each other."""

    missed: list[int]
    moved: list[int]


class Strip(NamedTuple):
    """A strip: the control points of its two boundaries, (2, n, 3), and the knots along them.

    It is a B-spline surface of degree 3 along its boundaries and 1 along its rulings. Of a closed one the first three
    control points of each boundary follow the last.
    """

    control: Any
    knots: Any
    is_closed: bool


class Evaluated(NamedTuple):
    """A point of a strip, the derivatives by ``u`` and ``v``, and the unit normal."""

    point: Any
    du: Any
    dv: Any
    normal: Any


@dataclass(frozen=True)
class Optimised:
    """What optimising found. ``before`` and ``after`` are the value that is minimised, the next four its terms."""

    stop: Stop
    iterations: int
    free_count: int
    before: float
    after: float
    proximity: float
    gap: float
    coverage: float
    way: float
    excess: float
    largest_deviation: float
    largest_gap: float


@dataclass(frozen=True)
class StripReport:
    """What there is to say of one strip."""

    is_too_wide: bool
    largest_deviation: float
    at: tuple[float, float, float]
    rms_deviation: float
    area: float
    trimmed_area: float
    least_width: float
    mean_width: float
    greatest_width: float
    width_variation: float
    width_over_feature: float
    feature_size: float


@dataclass(frozen=True)
class JointReport:
    """What there is to say of two neighbours: gaps in model units, kinks in radians."""

    strips: tuple[int, int]
    gap_count: int
    kink_count: int
    largest_gap: float
    mean_gap: float
    gap_at: tuple[float, float, float]
    largest_kink: float
    mean_kink: float
    kink_at: tuple[float, float, float]


@dataclass(frozen=True)
class Report:
    """What there is to say of strips.

    ``largest_deviation``: the largest distance of the strips from the mesh; ``largest_uncovered``: of a point of the
    mesh from the nearest strip; ``coverage``: the part of the mesh that some strip covers;
    ``overlap``: the part that strips cover again.
    """

    largest_deviation: float
    rms_deviation: float
    largest_uncovered: float
    rms_uncovered: float
    reference_area: float
    trimmed_area: float
    coverage: float
    overlap: float
    largest_gap: float
    mean_gap: float
    largest_kink: float
    mean_kink: float
    width_variation: float
    strips: tuple[StripReport, ...]
    joints: tuple[JointReport, ...]
    too_wide: tuple[int, ...]
    json: str
    """The JSON form, in which angles are in degrees."""


class StripMesh(NamedTuple):
    """Strips as a mesh: quads, or triangles of trimmed ones, whose edges across are rulings, and the strip of each."""

    points: Any
    faces: Any
    normals: Any
    strip_of: list[int]


class Rulings(NamedTuple):
    """Rulings, or pieces of them: both ends of each, (n, 2, 3), its parameter and its strip."""

    ends: Any
    parameters: Any
    strip_of: list[int]


@dataclass(frozen=True)
class Plank:
    """A plank: a prism over a flat outline.

    ``frame`` has a point of its lower face, the unit vector along it, from the strip's first boundary to its second,
    and the one across it. The corners of ``outline``, (4, 2), and the ends of the ``rulings`` in its lower and its
    upper face, (2, 2, 2), are in flat coordinates along these. ``heights`` are along the axis, ``parameters`` those
    of the rulings.
    """

    heights: tuple[float, float]
    filled: float
    parameters: tuple[float, float]
    frame: Any
    outline: Any
    rulings: Any
    length: float
    width: float
    end_angles: tuple[float, float]
    offcut: float


@dataclass(frozen=True)
class Planks:
    """The planks of a conoidal strip; ``dowels`` are the points of both boundaries at the cuts."""

    axis: tuple[float, float, float]
    thickness: float
    deviation: float
    stock_area: float
    offcut: float
    planks: tuple[Plank, ...]
    dowels: tuple[Any, Any]
    json: str
    """The JSON form, in which angles are in degrees."""
