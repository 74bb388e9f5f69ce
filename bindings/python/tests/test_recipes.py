"""Recipes and measures, on every kind of mesh."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

import shapeop
from near import assert_near, flat
from samples import SQUARE, saddle

FACE = [[0, 1, 2, 3]]


def bump(side: int) -> tuple[list[list[float]], list[list[int]]]:
    """A grid of quads with a bump, none of them planar, and one pentagon's worth of nothing else."""
    points = [[float(i), float(j), math.sin(i * 1.3) * math.cos(j * 0.9)] for j in range(side) for i in range(side)]
    rows = range(side - 1)
    return points, [[j * side + i + k for k in (0, 1, side + 1, side)] for j in rows for i in rows]


def worst(points: Any, faces: Any) -> float:
    return float(max(shapeop.measure_faces("planarity", points, faces)))


def test_the_names_are_the_library_s_and_each_is_a_function() -> None:
    assert "planarize" in shapeop.recipe_names()
    points, faces = bump(4)
    for name in shapeop.recipe_names():
        recipe = getattr(shapeop, name)
        assert isinstance(recipe, shapeop.Recipe)
        assert name in dir(shapeop)
        result = recipe(points, faces, max_iterations=500)
        hard = [i for i, one in enumerate(shapeop.recipe(name, points, faces).constraints) if one.hard]
        if hard:
            # They are met within the recipe's tolerance, 1e-9 of the model's size, which costs energy.
            assert max(result.violations[i] for i in hard) < 5e-9
        else:
            assert result.report.energy_after < result.report.energy_before
        with shapeop.recipe(name, points, faces).solver() as solver:
            solver.solve_until(500)
            assert_near(solver.points, result.points, 0)
    with pytest.raises(AttributeError, match="no attribute 'planarise_all'"):
        shapeop.planarise_all  # noqa: B018


def test_a_saddle_becomes_as_planar_as_its_closeness_allows() -> None:
    # Each corner minimises c (z - h)^2 + w z^2.
    result = shapeop.planarize(saddle(0.1), FACE, closeness=0.5, weight=2, tolerance=1e-12)
    assert_near(result.points, saddle(0.1 * 0.5 / 2.5), 1e-9)
    assert result.mesh is result.points  # type: ignore[comparison-overlap]
    assert result.report.outcome is shapeop.Outcome.CONVERGED
    # One plane, and the distance of each corner from its place.
    assert_near(result.violations, [0.02, 0.08, 0.08, 0.08, 0.08], 1e-9)
    # The distance of the diagonals over their mean length.
    assert_near(shapeop.measure_faces("planarity", result.mesh, FACE), [0.04 / math.sqrt(2 + 0)], 1e-9)
    assert_near(shapeop.measure_faces("plane_distance", saddle(0.1), FACE), [0.1])
    assert_near(shapeop.measure_faces("mean_edge", SQUARE, FACE), [1])


def test_options_reach_the_library() -> None:
    points, faces = bump(5)
    free = shapeop.planarize(points, faces).points
    anchored = shapeop.planarize(points, faces, anchors=[12]).points
    assert math.dist(free[12], points[12]) > 100 * math.dist(anchored[12], points[12])
    corners = shapeop.planarize(points, faces, anchor_corners=True).points
    assert max(math.dist(corners[i], points[i]) for i in (0, 4, 20, 24)) < 1e-3
    assert math.dist(corners[2], points[2]) > 1e-3
    boundary = shapeop.planarize(points, faces, anchor_boundary=True).points
    assert max(math.dist(boundary[i], points[i]) for i in (2, 10, 14, 22)) < 1e-3
    even = shapeop.equalize(points, faces, length=2, closeness=0).points
    assert abs(math.dist(even[0], even[1]) - 2) < 0.05
    smooth = shapeop.planarize(points, faces, fairness=1, fairness_kind="smooth").points
    keep = shapeop.planarize(points, faces, fairness=1, fairness_kind=shapeop.FairnessKind.KEEP_DETAIL).points
    assert flat(smooth) != flat(keep) != flat(free)
    stopped = shapeop.planarize(points, faces, progress=lambda told: told.iteration < 3)
    assert (stopped.report.outcome, stopped.report.iterations) == (shapeop.Outcome.CANCELLED, 3)
    assert shapeop.planarize(points, faces, max_iterations=2, tolerance=0).report.iterations == 2


@pytest.mark.parametrize(
    ("call", "kind", "text"),
    [
        (lambda: shapeop.planarize(SQUARE), shapeop.ArgumentTypeError, "mesh: expected a mesh .* or points together"),
        (lambda: shapeop.planarize(SQUARE, []), shapeop.Error, "face"),
        (lambda: shapeop.planarize(SQUARE, [0, 1, 2, 3]), shapeop.ArgumentError, "faces: expected a list of faces"),
        (lambda: shapeop.planarize(SQUARE, [[0, 1, 2, 9]]), shapeop.Error, r"faces\[0\]\[3\].*9"),
        (lambda: shapeop.planarize(SQUARE, FACE, weight=-1), shapeop.Error, "weight.*-1"),
        (lambda: shapeop.planarize(SQUARE, FACE, closeness=float("nan")), shapeop.Error, "closeness.*NaN"),
        (lambda: shapeop.planarize(SQUARE, FACE, anchors=[9]), shapeop.Error, "anchors.*9"),
        (
            lambda: shapeop.planarize(SQUARE, FACE, anchors=[0.5]),  # type: ignore[list-item]
            shapeop.ArgumentTypeError,
            "anchors: expected integers",
        ),
        (lambda: shapeop.planarize(SQUARE, FACE, length=2), shapeop.Error, "length.*only .equalize. and .rational"),
        (lambda: shapeop.equalize(SQUARE, FACE, length=-2), shapeop.Error, "length.*-2"),
        (lambda: shapeop.planarize(SQUARE, FACE, fairness_kind="x"), shapeop.ArgumentError, "keep-detail, smooth"),
        (lambda: shapeop.planarize(SQUARE, FACE, colour=1), TypeError, "colour"),  # type: ignore[call-arg]
        (lambda: shapeop.recipe("flatten", SQUARE, FACE), shapeop.Error, "recipes planarize"),
        (lambda: shapeop.measure_faces("beauty", SQUARE, FACE), shapeop.InvalidValueError, "measures planarity"),
        (lambda: shapeop.measure_faces("planarity", SQUARE, [[0, 1]]), shapeop.Error, r"faces\[0\]"),
    ],
)
def test_mistakes_are_named(call: Any, kind: type[Exception], text: str) -> None:
    with pytest.raises(kind, match=text):
        call()


def test_measures_are_listed() -> None:
    for name in shapeop.measure_names():
        assert all(value >= 0 for value in shapeop.measure_faces(name, *bump(3)))
    assert shapeop.measure_faces("planarity", SQUARE, [[0, 1, 2], [0, 1, 2, 3]])[1] == 0


def test_arrays_give_what_lists_give() -> None:
    np = pytest.importorskip("numpy")
    points, faces = bump(5)
    result = shapeop.planarize(np.array(points), np.array(faces))
    assert isinstance(result.points, np.ndarray)
    assert flat(result.points) == flat(shapeop.planarize(points, faces).points)
    assert flat(shapeop.measure_faces("planarity", np.array(points), np.array(faces))) == flat(
        shapeop.measure_faces("planarity", points, faces)
    )
    anchored = shapeop.planarize(points, faces, anchors=np.array([12]))
    assert flat(anchored.points) == flat(shapeop.planarize(points, faces, anchors=[12]).points)


def test_a_compas_mesh_becomes_one_of_the_same_keys(meshes: Path) -> None:
    pytest.importorskip("numpy")
    datastructures = pytest.importorskip("compas.datastructures")
    mesh = datastructures.Mesh.from_obj(meshes / "hypar.obj")
    mesh.name = "roof"
    mesh.delete_face(3)
    mesh.vertex_attribute(7, "load", 12.5)
    key = max(mesh.vertices())
    mesh.delete_vertex(0)  # Keys and indices differ from now on.
    before = {key: mesh.vertex_coordinates(key) for key in mesh.vertices()}
    result = shapeop.planarize(mesh, closeness=0.001, anchors=[key])
    assert isinstance(result.mesh, datastructures.Mesh)
    assert list(result.mesh.vertices()) == list(before)
    assert list(result.mesh.faces()) == list(mesh.faces())
    assert (result.mesh.name, result.mesh.vertex_attribute(7, "load")) == ("roof", 12.5)
    assert {key: mesh.vertex_coordinates(key) for key in mesh.vertices()} == before
    assert_near(result.mesh.vertices_attributes("xyz"), result.points, 0)
    assert math.dist(result.mesh.vertex_coordinates(key), before[key]) < 1e-4
    moved = max(math.dist(result.mesh.vertex_coordinates(key), before[key]) for key in before)
    assert moved > 1e-3
    assert worst(result.mesh, None) < worst(mesh, None)
    with pytest.raises(shapeop.ArgumentError, match="anchors: expected vertex keys of the mesh, found 0"):
        shapeop.planarize(mesh, anchors=[0])


def test_a_meshio_mesh_keeps_its_cells_and_data() -> None:
    meshio = pytest.importorskip("meshio")
    np = pytest.importorskip("numpy")
    points, faces = bump(4)
    cells = [("line", [[0, 1]]), ("quad", faces[:-1]), ("triangle", [faces[-1][:3]])]
    mesh = meshio.Mesh(np.array(points), cells, point_data={"load": np.arange(16.0)})
    result = shapeop.planarize(mesh)
    assert isinstance(result.mesh, meshio.Mesh)
    assert [block.type for block in result.mesh.cells] == ["line", "quad", "triangle"]
    assert np.array_equal(result.mesh.point_data["load"], np.arange(16.0))
    assert np.array_equal(result.mesh.points, result.points)
    assert flat(result.points) == flat(shapeop.planarize(points, [*faces[:-1], faces[-1][:3]]).points)
    assert np.array_equal(mesh.points, points)
    with pytest.raises(shapeop.ArgumentError, match="found cells of type 'tetra'"):
        shapeop.planarize(meshio.Mesh(np.array(points), [("tetra", [[0, 1, 2, 4]])]))
    with pytest.raises(shapeop.ArgumentError, match="found cells of type 'triangle6'"):
        shapeop.planarize(meshio.Mesh(np.array(points), [("triangle6", [[0, 1, 2, 4, 5, 6]])]))


def test_a_trimesh_mesh_keeps_its_faces_and_metadata() -> None:
    trimesh = pytest.importorskip("trimesh")
    np = pytest.importorskip("numpy")
    points, quads = bump(4)
    faces = [corner for a, b, c, d in quads for corner in ([a, b, c], [a, c, d])]
    mesh = trimesh.Trimesh(points, faces, metadata={"name": "roof"})
    result = shapeop.smooth(mesh)
    assert isinstance(result.mesh, trimesh.Trimesh)
    assert np.array_equal(result.mesh.faces, mesh.faces)
    assert np.array_equal(result.mesh.vertices, result.points)
    assert result.mesh.metadata["name"] == "roof"
    assert np.array_equal(mesh.vertices, points)
    assert np.abs(result.points - points).max() > 0.01
    assert len(shapeop.measure_faces("regularity", result.mesh)) == len(faces)
