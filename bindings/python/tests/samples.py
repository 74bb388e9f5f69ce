"""Points and solvers that several tests use."""

from __future__ import annotations

from shapeop import Solver

SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]


def saddle(height: float) -> list[list[float]]:
    """A square whose corners are alternately above and below its plane, which is its best-fit plane."""
    return [[x, y, height if i % 2 == 0 else -height] for i, (x, y, _) in enumerate(SQUARE)]


def sheet(side: int) -> Solver:
    """A wavy sheet of quads, to be planar, held at its points: many iterations."""
    points = [[i, j, ((i * 7 + j * 3) % 5) * 0.3] for j in range(side) for i in range(side)]
    solver = Solver(points)
    rows = range(side - 1)
    solver.add("Plane", [[j * side + i + k for k in (0, 1, side + 1, side)] for j in rows for i in rows])
    solver.add("Closeness", [[i] for i in range(side * side)], weight=1e-3)
    solver.init()
    return solver
