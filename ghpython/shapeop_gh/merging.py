"""Points closer than a tolerance are one point, as an unwelded mesh or separate lines bring them."""

from math import floor

from shapeop_gh.errors import ShapeOpError


def merge(coordinates, tolerance):
    """Returns the coordinates of the points that remain, and for each given point which of them it is.

    Points are taken in order: each joins the nearest of the remaining ones within `tolerance` (in model units), or
    remains itself. Tolerance 0 or None merges nothing.
    """
    count = len(coordinates) // 3
    if not tolerance:
        return list(coordinates), list(range(count))
    if not 0 < tolerance < float("inf"):
        raise ShapeOpError("Tolerance: a finite number of at least 0 expected, found %r" % tolerance)
    kept, index_of, cells = [], [], {}
    for i in range(count):
        point = coordinates[3 * i : 3 * i + 3]
        cell = tuple(int(floor(c / tolerance)) for c in point)
        found = _nearest_kept(point, cell, kept, cells, tolerance)
        if found is None:
            found = len(kept) // 3
            kept.extend(point)
            cells.setdefault(cell, []).append(found)
        index_of.append(found)
    return kept, index_of


def _nearest_kept(point, cell, kept, cells, tolerance):
    """The remaining point nearest to `point` within the tolerance, the first of equals, or None."""
    best, least = None, tolerance * tolerance
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for dz in (-1, 0, 1):
                for k in cells.get((cell[0] + dx, cell[1] + dy, cell[2] + dz), ()):
                    distance = sum((point[c] - kept[3 * k + c]) ** 2 for c in range(3))
                    if distance < least or (distance == least and (best is None or k < best)):
                        best, least = k, distance
    return best
