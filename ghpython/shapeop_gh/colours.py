"""Numbers to colours, and the strain of edges. Colours are (red, green, blue), 0 to 255."""

from shapeop_gh.errors import ShapeOpError

# From met to missed: light blue-green, yellow, dark red. Their brightness falls, so they can be told apart in grey.
PLANARITY = ((214, 239, 223), (253, 203, 92), (165, 0, 38))
# Tension blue, nothing white, compression red.
TENSION, REST, COMPRESSION = (33, 102, 172), (247, 247, 247), (178, 24, 43)


def planarity(ratio, limit):
    """The colour of a face whose planarity is `ratio`: from 0 to `limit` (such as 0.01, one percent) and beyond."""
    return _between(PLANARITY, min(max(ratio / _positive(limit), 0.0), 1.0))


def strain(value, limit):
    """The colour of a strain: blue where positive (tension), red where negative (compression), full at `limit`."""
    share = min(max(value / _positive(limit), -1.0), 1.0)
    return _between((REST, TENSION if share > 0 else COMPRESSION), abs(share))


def strains(coordinates, edges, lengths):
    """(length now - length at rest) / length at rest, for every edge; `lengths`: one for all or one each."""
    if len(lengths) == 1:
        lengths = lengths * len(edges)
    if len(lengths) != len(edges):
        raise ShapeOpError("RestLengths: 1 or %d expected, found %d" % (len(edges), len(lengths)))
    return [(length(coordinates, e) - rest) / _positive(rest) for e, rest in zip(edges, lengths)]


def length(coordinates, edge):
    """The distance of the first and the last point of `edge`."""
    count = len(coordinates) // 3
    for i in edge:
        if not 0 <= i < count:
            raise ShapeOpError("PointIndices: index %d is out of range for %d points" % (i, count))
    a, b = 3 * edge[0], 3 * edge[-1]
    return sum((coordinates[b + c] - coordinates[a + c]) ** 2 for c in range(3)) ** 0.5


def _between(stops, share):
    """The colour at `share` (0 to 1) of the way along equally spaced `stops`."""
    place = share * (len(stops) - 1)
    low = min(int(place), len(stops) - 2)
    rest = place - low
    return tuple(int(round(a + (b - a) * rest)) for a, b in zip(stops[low], stops[low + 1]))


def _positive(value):
    if not 0 < value < float("inf"):
        raise ShapeOpError("a finite number above 0 expected, found %r" % value)
    return value
