"""The caller that declares nothing: ctypes without argtypes and restype, as the published client has it.

Every argument is what ctypes makes of it by itself (int for a handle, so 32 bits), every result an int. Usage:
undeclared.py; the library is found by its name ShapeOp.0.1.0.dll alone.
"""

import ctypes
import sys

lib = ctypes.CDLL("ShapeOp.0.1.0.dll")


def doubles(values):
    return (ctypes.c_double * len(values))(*values)


def ints(values):
    return (ctypes.c_int * len(values))(*values)


def add(op, type_name, ids, weight):
    return lib.shapeop_addConstraint(op, type_name, ints(ids), len(ids), ctypes.c_double(weight))


def near(a, b, tolerance=1e-12):
    return len(a) == len(b) and all(abs(x - y) <= tolerance for x, y in zip(a, b))


def corners(height, offset):
    flat = [(0, 0), (1, 0), (1, 1), (0, 1)]
    return [c for i, (x, y) in enumerate(flat) for c in (x + offset, y, height if i % 2 == 0 else -height)]


def main():
    # Several solvers at once: each keeps its own points, constraints and ids.
    solvers = []
    for _ in range(40):
        op = lib.shapeop_create()
        assert 0 < op < 2**31, op
        solvers.append(op)
    assert len(set(solvers)) == len(solvers)
    for n, op in enumerate(solvers):
        points = doubles(corners(0.01 * (n + 1), n))
        lib.shapeop_setPoints(op, points, 4)
        assert add(op, b"Plane", [0, 1, 2, 3], 1.0) == 0
        assert [add(op, b"Closeness", [i], 0.25) for i in range(4)] == [1, 2, 3, 4]
        assert add(op, b"NoSuchType", [0], 1.0) == -1
        assert add(op, b"Plane", [0, 1, 99], 1.0) == -1
    for op in solvers:
        assert lib.shapeop_init(op) == 0
        assert lib.shapeop_solve(op, 1) == 0
    for n, op in enumerate(solvers):
        points = doubles([0.0] * 12)
        lib.shapeop_getPoints(op, points, 4)
        # Along z each corner minimises w (z - h)^2 + z^2 with w = 1/4, so z = h / 5.
        assert near(list(points), corners(0.002 * (n + 1), n)), list(points)

    # Edits and forces.
    op = solvers[0]
    assert lib.shapeop_editConstraint(op, b"Closeness", 1, doubles([0.0, 0.0, 0.3]), 3) == 0
    assert lib.shapeop_editConstraint(op, b"Plane", 0, doubles([0.0]), 1) == 1
    assert lib.shapeop_editConstraint(op, b"Closeness", 77, doubles([0.0] * 3), 3) == 3
    assert lib.shapeop_editConstraint(op, b"Closeness", 1, doubles([0.0] * 2), 2) == 2
    assert lib.shapeop_addGravityForce(op, doubles([0.0, 0.0, -1.0])) == 0
    assert lib.shapeop_addVertexForce(op, doubles([0.0, 0.0, 1.0]), 2) == 1
    lib.shapeop_editVertexForce(op, 1, doubles([0.0, 0.0, 2.0]), 3)
    assert lib.shapeop_initDynamic(op, ctypes.c_double(1), ctypes.c_double(0.9), ctypes.c_double(0.1)) == 0
    lib.shapeop_setTimeStep(op, ctypes.c_double(0.05))
    lib.shapeop_setDamping(op, ctypes.c_double(0.5))
    assert lib.shapeop_solve(op, 5) == 0

    # Deleted, deleted again, never there.
    for op in solvers[1:]:
        lib.shapeop_delete(op)
        lib.shapeop_delete(op)
        assert lib.shapeop_solve(op, 1) == 1
        assert add(op, b"Plane", [0, 1, 2], 1.0) == -1
    for nothing in (0, 1, -1, 123456789):
        assert lib.shapeop_init(nothing) == 1
        lib.shapeop_delete(nothing)
    # New solvers do not get the handles of old ones.
    again = [lib.shapeop_create() for _ in range(40)]
    assert not set(again) & set(solvers)
    assert lib.shapeop_pointCount(solvers[0]) == 4
    print("undeclared: all is well under Python", sys.version.split()[0])


main()
