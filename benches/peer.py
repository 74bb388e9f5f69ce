"""Times compas-shapeop on a model that `problems write` wrote, and prints the same line of JSON as `problems`.

    peer.py MODEL ITERATIONS [POINTS_FILE]

It calls the compiled module, not the Python layer above it, and times only initialising and solving: what is measured
is the C++ core of libShapeOp. Dynamic models run dynamically, with gravity.
"""

import json
import resource
import sys
import time

import numpy
from compas_shapeop._shapeop import SolverWrapper


def read(path):
    with open(path, "rb") as file:
        header = json.loads(file.readline())

        def take(dtype, count):
            return numpy.frombuffer(file.read(numpy.dtype(dtype).itemsize * count), dtype)

        points = take("<f8", 3 * header["points"]).reshape(-1, 3)
        for group in header["groups"]:
            group["indices"] = take("<u4", group["indices"]).reshape(-1, group["arity"]).tolist()
            group["scalars"] = take("<f8", group["scalars"])
    return header, points


def is_regular_polygon(scalars, k):
    """The peer has no other shapes: it makes one of the first three points, of any size, as scaling is allowed."""
    if len(scalars) != 3 * k:
        return False
    corners = scalars.reshape(k, 3) - scalars.reshape(k, 3).mean(axis=0)
    radii = numpy.linalg.norm(corners, axis=1)
    sides = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=0), axis=1)
    return numpy.ptp(radii) < 1e-12 * radii.max() and numpy.ptp(sides) < 1e-12 * sides.max()


def add(solver, group):
    kind, weight, scalars = group["type"], group["weight"], group["scalars"]
    if kind == "Similarity":
        if not is_regular_polygon(scalars, group["arity"]):
            sys.exit("compas-shapeop has no Similarity to other shapes than regular polygons")
    elif len(scalars):
        sys.exit(f"compas-shapeop is asked for a {kind} with scalars")
    call = {
        "Plane": lambda i: solver.add_plane_constraint(i, weight),
        "Circle": lambda i: solver.add_circle_constraint(i, weight),
        "Closeness": lambda i: solver.add_closeness_constraint(i[0], weight),
        "EdgeStrain": lambda i: solver.add_edge_strain_constraint(i[0], i[1], weight, 1.0, 1.0),
        "Bending": lambda i: solver.add_bending_constraint(i, weight, 1.0, 1.0),
        "Similarity": lambda i: solver.add_regular_polygon_constraint(i, weight),
    }.get(kind)
    if call is None:
        sys.exit(f"compas-shapeop has no {kind}")
    for indices in group["indices"]:
        # It returns whether the new id is above 0, which it is not for the first constraint.
        call(indices)


def main():
    model, iterations = sys.argv[1], int(sys.argv[2])
    header, points = read(model)
    solver = SolverWrapper()
    # A copy in its order: it takes no read-only array.
    solver.set_points(numpy.array(points.T, order="F"))
    for group in header["groups"]:
        add(solver, group)
    if any(header["gravity"]):
        solver.add_gravity_force(*header["gravity"])
    dynamics = header["dynamics"]
    started = time.perf_counter()
    is_ready = solver.initialize(dynamics is not None, *(dynamics or [1.0, 1.0, 1.0]))
    init_seconds = time.perf_counter() - started
    if not is_ready:
        sys.exit("compas-shapeop could not initialise")
    started = time.perf_counter()
    solver.solve(3)
    solve_seconds = time.perf_counter() - started
    iterations = -(-iterations // 5)
    steps = []
    for _ in range(5):
        started = time.perf_counter()
        solver.solve(iterations)
        steps.append((time.perf_counter() - started) / iterations)
    solve_seconds += iterations * sum(steps)
    if len(sys.argv) > 3:
        numpy.ascontiguousarray(solver.get_points().T, "<f8").tofile(sys.argv[3])
    line = {
        "vertices": header["points"],
        "init_ms": 1e3 * init_seconds,
        "iteration_ms": 1e3 * sorted(steps)[2],
        "iterations": 3 + 5 * iterations,
        "solve_ms": 1e3 * solve_seconds,
        "peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }
    print(json.dumps(line))


main()
