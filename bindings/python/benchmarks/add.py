"""Seconds to add 200 000 constraints in one call, from a list of lists and from an array, as JSON.

Usage: add.py [REPEATS]. Each figure is the least of so many repeats (5), each on a new solver.
"""

from __future__ import annotations

import json
import platform
import sys
import time
from typing import Any, Callable

import shapeop

COUNT = 200_000
SIDE = 449  # 448 x 448 quads, of which COUNT are used


def least(repeats: int, call: Callable[[shapeop.Solver], Any]) -> float:
    """The least seconds that `call` takes on a new solver of the grid."""
    points = [[float(i), float(j), 0.0] for j in range(SIDE) for i in range(SIDE)]
    seconds = []
    for _ in range(repeats):
        with shapeop.Solver(points) as solver:
            begin = time.perf_counter()
            call(solver)
            seconds.append(time.perf_counter() - begin)
            assert solver.constraint_count == COUNT
    return min(seconds)


def main() -> None:
    """Prints the figures."""
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    rows = range(SIDE - 1)
    quads = [[j * SIDE + i + k for k in (0, 1, SIDE + 1, SIDE)] for j in rows for i in rows][:COUNT]
    cases: dict[str, Callable[[shapeop.Solver], Any]] = {
        "list of lists": lambda solver: solver.add("Plane", quads),
        "list of lists, own weights": lambda solver: solver.add("Plane", quads, weight=weights),
        "list of lists, own scalars": lambda solver: solver.add("Closeness", quads_first, scalars=targets),
    }
    weights = [1.0 + i % 3 for i in range(COUNT)]
    quads_first = [quad[:1] for quad in quads]
    targets = [[float(quad[0]), 0.0, 1.0] for quad in quads]
    try:
        import numpy as np
    except ImportError:
        pass
    else:
        array, array32 = np.array(quads), np.array(quads, dtype=np.int32)
        cases["array of int64"] = lambda solver: solver.add("Plane", array)
        cases["array of int32"] = lambda solver: solver.add("Plane", array32)
    seconds = {name: round(least(repeats, call), 4) for name, call in cases.items()}
    print(json.dumps({"python": platform.python_version(), "constraints": COUNT, "seconds": seconds}, indent=2))


if __name__ == "__main__":
    main()
