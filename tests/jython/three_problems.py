"""Three problems (tests/languages/README.md) from Jython, through the SWIG classes: three_problems.py MESH FOLDER."""

import os
import sys

import doubleArray
import intArray
import shapeop_err
from shapeopJava import *


def doubles(values):
    array = doubleArray(len(values))
    for i, value in enumerate(values):
        array.setitem(i, value)
    return array


def ints(values):
    array = intArray(len(values))
    for i, value in enumerate(values):
        array.setitem(i, value)
    return array


def checked(op, is_done):
    if not is_done:
        sys.exit("three_problems.py: " + shapeop_lastError(op))


def start(points):
    op = shapeop_create()
    shapeop_setPoints(op, doubles([x for point in points for x in point]), len(points))
    checked(op, shapeop_lastError(op) == "")
    return op


def add(op, constraint_type, ids, weight, scalars=()):
    constraint = shapeop_addConstraint(op, constraint_type, ints(ids), len(ids), weight)
    checked(op, constraint >= 0)
    if scalars:
        edit(op, constraint_type, constraint, scalars)
    return constraint


def edit(op, constraint_type, constraint, scalars):
    error = shapeop_editConstraint(op, constraint_type, constraint, doubles(scalars), len(scalars))
    checked(op, error == shapeop_err.SO_SUCCESS)


def solve(op, iterations):
    checked(op, shapeop_solve(op, iterations) == 0)


def finish(op, point_count, path):
    """Writes the points and deletes the solver."""
    points = doubleArray(3 * point_count)
    shapeop_getPoints(op, points, point_count)
    checked(op, shapeop_lastError(op) == "")
    with open(path, "w") as file:
        for i in range(0, 3 * point_count, 3):
            file.write("%.17g %.17g %.17g\n" % (points.getitem(i), points.getitem(i + 1), points.getitem(i + 2)))
    shapeop_delete(op)


def quad(path):
    op = start([(0, 0, 0.3), (1.2, 0, 0), (1, 1, 0.4), (0, 1.1, -0.1)])
    add(op, "Plane", [0, 1, 2, 3], 1)
    add(op, "Rigid", [0, 1, 2, 3], 2, [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0])
    add(op, "Closeness", [0], 0.5, [0, 0, 0.2])
    checked(op, shapeop_init(op) == 0)
    solve(op, 25)
    finish(op, 4, path)


def planarise(mesh, path):
    points, faces = [], []
    with open(mesh) as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                faces.append([int(word) - 1 for word in words[1:]])
    op = start(points)
    for face in faces:
        add(op, "Plane", face, 1)
    for i in range(len(points)):
        add(op, "Closeness", [i], 0.05)
    checked(op, shapeop_init(op) == 0)
    solve(op, 100)
    finish(op, len(points), path)


def cloth(path):
    size = 20
    op = start([(i, j, 0) for j in range(size) for i in range(size)])
    for j in range(size):
        for i in range(size):
            point = size * j + i
            if i < size - 1:
                add(op, "EdgeStrain", [point, point + 1], 10, [1, 0.9, 1.1])
            if j < size - 1:
                add(op, "EdgeStrain", [point, point + size], 10, [1, 0.9, 1.1])
    add(op, "Closeness", [0], 1000)
    add(op, "Closeness", [19], 1000)
    corner = add(op, "Closeness", [399], 1000)
    checked(op, shapeop_addGravityForce(op, doubles([0, 0, -1])) >= 0)
    pull = shapeop_addVertexForce(op, doubles([0.5, 0, 2]), 380)
    checked(op, pull >= 0)
    checked(op, shapeop_initDynamic(op, 1, 0.95, 0.1) == 0)
    for step in range(1, 61):
        if step == 11:
            edit(op, "Closeness", corner, [14, 14, 5])
        if step == 31:
            shapeop_editVertexForce(op, pull, doubles([0, 0.5, -1]), 380)
            checked(op, shapeop_lastError(op) == "")
        solve(op, 5)
    finish(op, size * size, path)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: three_problems.py MESH FOLDER")
    quad(os.path.join(sys.argv[2], "quad.txt"))
    planarise(sys.argv[1], os.path.join(sys.argv[2], "planarise.txt"))
    cloth(os.path.join(sys.argv[2], "cloth.txt"))
