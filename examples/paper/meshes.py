"""Meshes of the figures, made by rule, and OBJ files of them. A mesh is `(points, faces)`: an (n, 3) array and lists
of indices."""

import math

import numpy as np

#: Decimals of coordinates in files: a ten-thousandth of a millimetre of a model in metres, and one text everywhere.
DECIMALS = 7


def read_obj(path):
    points, faces = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return np.array(points), faces


def obj_text(mesh):
    points, faces = mesh
    rounded = np.round(points, DECIMALS) + 0.0  # + 0.0: no negative zeros
    lines = ["v " + " ".join("%.10g" % c for c in point) for point in rounded]
    lines += ["f " + " ".join(str(index + 1) for index in face) for face in faces]
    return "\n".join(lines) + "\n"


def grid(columns, rows, place):
    """`columns * rows` quads; vertex `(i, j)` has the index `(columns + 1) j + i` and lies at `place(i, j)`."""
    stride = columns + 1
    points = [place(i, j) for j in range(rows + 1) for i in range(stride)]
    faces = [
        [stride * j + i, stride * j + i + 1, stride * (j + 1) + i + 1, stride * (j + 1) + i]
        for j in range(rows)
        for i in range(columns)
    ]
    return np.array(points, dtype=float), faces


def grid_lines(columns, rows):
    """The rows and then the columns of vertices of `grid`."""
    stride = columns + 1
    along = [[stride * j + i for i in range(stride)] for j in range(rows + 1)]
    across = [[stride * j + i for j in range(rows + 1)] for i in range(stride)]
    return along + across


def cloth(count, size):
    """A flat square of `count * count` squares, each cut into two triangles by diagonals of alternating direction."""
    step = size / count
    points, quads = grid(count, count, lambda i, j: (i * step - size / 2, j * step - size / 2, 0.0))
    faces = []
    for index, (a, b, c, d) in enumerate(quads):
        is_even = (index % count + index // count) % 2 == 0
        faces += [[a, b, c], [a, c, d]] if is_even else [[a, b, d], [b, c, d]]
    return points, faces


def box(length, width, height):
    """A closed box of unit squares along x, y and z, normals outward; its ends lie at x = 0 and x = `length`."""
    sizes = (length, width, height)
    sides = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for level in (0, sizes[axis]):
            for i in range(sizes[u]):
                for j in range(sizes[v]):
                    corners = []
                    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        corner = [0, 0, 0]
                        corner[axis], corner[u], corner[v] = level, i + du, j + dv
                        corners.append(tuple(corner))
                    sides.append(corners if level else corners[::-1])
    return welded(sides)


def hexagon(count, edge):
    """A flat regular hexagon as three rhombi of `count * count` quads that meet in its centre, all edges equal."""
    directions = [np.array([math.cos(math.radians(a)), math.sin(math.radians(a)), 0.0]) for a in (0, 120, 240)]
    polygons = []
    for k in range(3):
        u, v = directions[k] * edge, directions[(k + 1) % 3] * edge
        for i in range(count):
            for j in range(count):
                polygons.append([i * u + j * v, (i + 1) * u + j * v, (i + 1) * u + (j + 1) * v, i * u + (j + 1) * v])
    return welded(polygons)


def snub_square(count):
    """`2 count²` squares and the regular triangles between them, all edges 1, five faces about each inner vertex;
    centred, flat. The squares, in a chequerboard, are turned by 60 and 30 degrees; three of their corners that are 1
    apart make a triangle."""
    spacing = math.sqrt(2 + math.sqrt(3))
    squares = []
    for i in range(count):
        for j in range(count):
            for shift, turn in ((0.0, 60), (0.5, 30)):
                centre = ((np.array([i, j]) + shift) - (count - 0.5) / 2) * spacing
                angles = np.radians(turn + 90 * np.arange(4))
                x, y = centre[:, None] + np.stack([np.cos(angles), np.sin(angles)]) / math.sqrt(2)
                squares.append(np.stack([x, y, np.zeros(4)], axis=1))
    points, faces = welded(squares)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    beside = [set(np.flatnonzero(np.abs(row - 1) < 1e-6).tolist()) for row in distances]
    for a in range(len(points)):
        for b in sorted(beside[a]):
            for c in sorted(beside[a] & beside[b]):
                if a < b < c:
                    is_left = np.cross(points[b] - points[a], points[c] - points[a])[2] > 0
                    faces.append([a, b, c] if is_left else [a, c, b])
    return points, faces


def welded(polygons):
    """The mesh of polygons given by their corners; corners at the same place become one vertex."""
    indices, points, faces = {}, [], []
    for polygon in polygons:
        face = []
        for corner in polygon:
            key = tuple(np.round(np.asarray(corner, dtype=float), 6) + 0.0)
            if key not in indices:
                indices[key] = len(points)
                points.append(corner)
            face.append(indices[key])
        faces.append(face)
    return np.array(points, dtype=float), faces


def canopy(around, rings, seed):
    """A random canopy between two rough boundaries: `around * rings` quads about a middle. Smooth waves lift, push
    and twist it, the same ones at every resolution, and every vertex is shaken by up to a fifth of its edges. Radii
    grow evenly by a factor from ring to ring, so that faces are about as wide as long."""
    random = np.random.RandomState(seed)  # whose numbers are the same in every version of numpy
    waves = [
        (k, random.uniform(-1, 1, 3), random.uniform(0, 2 * math.pi, 3), random.uniform(0.5, 2, 3))
        for k in (1, 2, 3, 4)
    ]
    inner, outer = 3.0, 10.0
    points = []
    for j in range(rings + 1):
        share = j / rings
        for i in range(around):
            angle = 2 * math.pi * i / around
            lift, push, twist = (
                sum(
                    size[c] / k * math.sin(k * angle + phase[c] + 2 * speed[c] * share)
                    for k, size, phase, speed in waves
                )
                for c in range(3)
            )
            radius = inner * (outer / inner) ** share
            edge = 2 * math.pi * radius / around
            radius *= 1 + 0.10 * push
            angle += 0.5 * share**1.5 + 0.10 * twist
            height = 4.0 * math.sin(math.pi * 0.75 * share) + 1.2 * share * lift
            shaken = random.uniform(-0.2, 0.2, 3) * edge
            points.append(
                [radius * math.cos(angle) + shaken[0], radius * math.sin(angle) + shaken[1], height + 0.5 * shaken[2]]
            )
    faces = [
        [around * j + i, around * j + (i + 1) % around, around * (j + 1) + (i + 1) % around, around * (j + 1) + i]
        for j in range(rings)
        for i in range(around)
    ]
    return np.array(points), faces
