"""The three problems of tests/languages/README.md, with the Python package: three_problems.py MESH.obj FOLDER"""

import sys
from pathlib import Path

import shapeop


def write(path, points):
    """A line ``x y z`` for each point, with as many digits as it takes to read back the same double."""
    path.write_text("".join("{!r} {!r} {!r}\n".format(*map(float, point)) for point in points), encoding="utf-8")


def quad():
    """A quad between plane, unit square and a target."""
    with shapeop.Solver([[0, 0, 0.3], [1.2, 0, 0], [1, 1, 0.4], [0, 1.1, -0.1]]) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        solver.add("Rigid", [0, 1, 2, 3], weight=2, scalars=square)
        solver.add("Closeness", [0], weight=0.5, scalars=[0, 0, 0.2])
        solver.init()
        solver.solve(25)
        return solver.points


def planarise(path):
    """Every face of a mesh planar, every point near its place."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines()]
    points = [list(map(float, words[1:])) for words in lines if words[:1] == ["v"]]
    faces = [[int(word) - 1 for word in words[1:]] for words in lines if words[:1] == ["f"]]
    with shapeop.Solver(points) as solver:
        solver.add("Plane", faces)
        solver.add("Closeness", [[i] for i in range(len(points))], weight=0.05)
        solver.init()
        solver.solve(100)
        return solver.points


def cloth():
    """A cloth that hangs at three corners, one of which moves."""
    side = range(20)
    edges = []
    for j in side:
        for i in side:
            here = 20 * j + i
            edges += [[here, here + 1]] * (i < 19) + [[here, here + 20]] * (j < 19)
    with shapeop.Solver([[i, j, 0] for j in side for i in side]) as solver:
        solver.add("EdgeStrain", edges, weight=10, scalars=[1, 0.9, 1.1])
        corners = solver.add("Closeness", [[0], [19], [399]], weight=1000)
        solver.add_gravity([0, 0, -1])
        wind = solver.add_vertex_force([0.5, 0, 2], 380)
        solver.init_dynamic(masses=1, damping=0.95, timestep=0.1)
        for step in range(1, 61):
            if step == 11:
                solver.edit("Closeness", corners[2], [14, 14, 5])
            if step == 31:
                solver.edit_vertex_force(wind, [0, 0.5, -1], 380)
            solver.solve(5)
        return solver.points


def main():
    mesh, folder = map(Path, sys.argv[1:])
    write(folder / "quad.txt", quad())
    write(folder / "planarise.txt", planarise(mesh))
    write(folder / "cloth.txt", cloth())


if __name__ == "__main__":
    main()
