"""docs/from-compas-shapeop.md names every public method, and what it calls the same gives the same points."""

from __future__ import annotations

import inspect
import math
import re
from pathlib import Path
from typing import Any, Callable

import pytest

from shapeop import Solver

np = pytest.importorskip("numpy")
peer = pytest.importorskip("compas_shapeop.shapeop")
peer_mesh = pytest.importorskip("compas_shapeop.meshsolver")

POINTS = np.random.default_rng(1).random((4, 3)) + [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]
LENGTH = float(np.linalg.norm(POINTS[1] - POINTS[0]))
SQUARE = [[math.cos(angle), math.sin(angle), 0] for angle in np.arange(4) * math.pi / 2]

SAME: list[tuple[Callable[[Any], object], Callable[[Solver], object]]] = [
    (lambda x: x.add_closeness_constraint(0, 2.0), lambda x: x.add("Closeness", [0], weight=2.0)),
    (lambda x: x.add_closeness_constraints([0, 1], 2.0), lambda x: x.add("Closeness", [[0], [1]], weight=2.0)),
    (
        lambda x: x.add_closeness_constraint_with_position(0, 2.0, 5, 6, 7),
        lambda x: x.add("Closeness", [0], weight=2.0, scalars=[5, 6, 7]),
    ),
    (
        lambda x: x.add_edge_strain_constraint(0, 1, 3.0, 1.2, 1.3),
        lambda x: x.add("EdgeStrain", [0, 1], weight=3.0, scalars=[LENGTH, 1.2, 1.3]),
    ),
    (
        lambda x: x.add_shrinking_edge_constraint(0, 1, 3.0, 0.6),
        lambda x: x.add("EdgeStrain", [0, 1], weight=3.0, scalars=[LENGTH, 0.6 - 0.05, 0.6 + 0.05]),
    ),
    (lambda x: x.add_circle_constraint([0, 1, 2, 3], 2.0), lambda x: x.add("Circle", [0, 1, 2, 3], weight=2.0)),
    (lambda x: x.add_plane_constraint([0, 1, 2, 3], 2.0), lambda x: x.add("Plane", [0, 1, 2, 3], weight=2.0)),
    (
        lambda x: x.add_bending_constraint([0, 1, 2, 3], 2.0, 0.5, 0.6),
        lambda x: x.add("Bending", [0, 1, 2, 3], weight=2.0, scalars=[0.5, 0.6]),
    ),
    (lambda x: x.add_similarity_constraint([0, 1, 2, 3], 2.0), lambda x: x.add("Similarity", [0, 1, 2, 3], weight=2.0)),
    (
        lambda x: x.add_regular_polygon_constraint([0, 1, 2, 3], 2.0),
        lambda x: x.add("Similarity", [0, 1, 2, 3], weight=2.0, scalars=SQUARE),
    ),
    (lambda x: x.add_vertex_force(1, 0.1, 0.2, 0.3), lambda x: x.add_vertex_force([0.1, 0.2, 0.3], 1)),
    (lambda x: x.add_gravity_force(0.1, 0.2, 0.3), lambda x: x.add_gravity([0.1, 0.2, 0.3])),
]


@pytest.mark.parametrize("is_dynamic", [False, True])
@pytest.mark.parametrize(("theirs", "ours"), SAME)
def test_calls_that_are_said_to_be_the_same_give_the_same_points(
    theirs: Callable[[Any], object], ours: Callable[[Solver], object], is_dynamic: bool
) -> None:
    other = peer.Solver()
    other.points = POINTS.copy()
    for i in range(4):
        other.add_closeness_constraint(i, 0.5)
    # Moved on, so that a constraint that keeps its points as they are has something to do.
    other.add_vertex_force(2, 0.3, -0.2, 0.5)
    theirs(other)
    with Solver(POINTS) as solver:
        solver.add("Closeness", [[0], [1], [2], [3]], weight=0.5)
        solver.add_vertex_force([0.3, -0.2, 0.5], 2)
        ours(solver)
        if is_dynamic:
            other.init(dynamic=True, masses=2.0, damping=0.9, timestep=0.3)
            solver.init_dynamic(2.0, 0.9, 0.3)
        else:
            other.init()
            solver.init()
        for _ in range(3):
            other.solve(5)
            solver.solve(5)
        assert np.abs(solver.points - POINTS).max() > 1e-3
        assert np.abs(solver.points - other.points).max() < 1e-12


def public_methods(kind: type) -> set[str]:
    return {name for name, _ in inspect.getmembers(kind, callable) if not name.startswith("_")}


def test_every_public_method_is_on_the_page(repository: Path) -> None:
    page = (repository / "docs" / "from-compas-shapeop.md").read_text(encoding="utf-8")
    before, after = page.split("## MeshSolver")
    left = [line.split(" | ")[0] for line in before.splitlines() if line.startswith("| ")]
    right = [line.split(" | ")[0] for line in after.splitlines() if line.startswith("| ")]
    words = set(re.findall(r"\w+", " ".join(left))), set(re.findall(r"\w+", " ".join(right)))
    assert public_methods(peer.Solver) - words[0] == set()
    assert public_methods(peer_mesh.MeshSolver) - public_methods(peer.Solver) - words[1] == set()
    assert len(public_methods(peer_mesh.MeshSolver)) > 20


def test_what_the_page_calls_broken_is(recwarn: pytest.WarningsRecorder) -> None:
    other = peer.Solver()
    other.points = POINTS.copy()
    with pytest.raises(AttributeError):
        other.add_shape_constraint([0, 1, 2, 3])
