"""Patterns, meshes and measures against truths that are known or counted in the plainest way."""

import itertools
import math

import numpy as np
import pytest

import measure
import meshes
import patterns

ANNULUS = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
GRID = meshes.grid(3, 2, lambda i, j: (i, j, 0))[1]
MESHES = {
    "annulus": (8, ANNULUS),
    "tetrahedron": (4, TETRAHEDRON),
    "grid": (12, GRID),
    "hexagon": (6, [[0, 1, 2, 3, 4, 5]]),
}


def sides(face):
    return {frozenset((face[i], face[i - 1])) for i in range(len(face))}


@pytest.fixture(params=sorted(MESHES))
def mesh(request):
    return MESHES[request.param]


def given(name, mesh):
    return patterns.PATTERNS[name](*mesh)


def test_every_pair_of_vertices_that_share_a_side_is_one_edge(mesh):
    count, faces = mesh
    pairs = [
        set(pair) for pair in itertools.combinations(range(count), 2) if any(frozenset(pair) in sides(f) for f in faces)
    ]
    assert [set(edge) for edge in given("edgeVertices", mesh)] == pairs


def test_neighbours_are_the_other_ends_of_a_vertexs_sides(mesh):
    count, faces = mesh
    for vertex, (centre, *others) in enumerate(given("vertexNeighbours", mesh)):
        assert centre == vertex
        assert len(set(others)) == len(others)
        assert set(others) == {
            w for w in range(count) if w != vertex and any(frozenset((vertex, w)) in sides(f) for f in faces)
        }


def test_each_corner_of_each_face_has_one_angle_between_its_two_sides(mesh):
    found = given("faceAngleVertices", mesh)
    assert len(found) == sum(len(face) for face in mesh[1])
    for apex, first, second in found:
        assert any({frozenset((apex, first)), frozenset((apex, second))} <= sides(face) for face in mesh[1])
    assert len({tuple(corner) for corner in found}) == len(found)


def test_an_inner_edge_comes_with_all_other_corners_of_its_two_faces(mesh):
    for start, end, *others in given("edgeFaceVertices", mesh):
        beside = [face for face in mesh[1] if frozenset((start, end)) in sides(face)]
        assert len(beside) == 2
        assert sorted(others) == sorted(v for face in beside for v in face if v not in (start, end))
    inner = sum(1 for e in given("edgeVertices", mesh) if sum(frozenset(e) in sides(f) for f in mesh[1]) == 2)
    assert len(given("edgeFaceVertices", mesh)) == inner


def test_naked_vertices_are_listed_boundary_by_boundary():
    assert given("nakedVertices", MESHES["annulus"]) == [[0, 1, 2, 3], [4, 5, 6, 7]]
    assert given("nakedVertices", MESHES["tetrahedron"]) == []
    assert given("nakedVertices", MESHES["grid"]) == [[0, 1, 2, 3, 4, 7, 8, 9, 10, 11]]


def test_faces_vertices_and_all_vertices_are_listed_in_order(mesh):
    assert given("faceVertices", mesh) == mesh[1]
    assert given("verticesEach", mesh) == [[v] for v in range(mesh[0])]
    assert given("verticesAll", mesh) == [list(range(mesh[0]))]


def test_hinges_name_on_each_side_the_vertex_that_follows_the_edge():
    assert patterns.hinges(TETRAHEDRON) == given("edgeFaceVertices", MESHES["tetrahedron"])
    assert [1, 5, 4, 2] in patterns.hinges(GRID)


@pytest.mark.parametrize(
    ("made", "characteristic"),
    [
        (meshes.cloth(4, 1.0), 1),
        (meshes.box(4, 2, 3), 2),
        (meshes.hexagon(3, 1.8), 1),
        (meshes.snub_square(3), 1),
        (meshes.canopy(12, 3, 9), 0),
    ],
)
def test_made_meshes_are_whole_and_oriented_alike(made, characteristic):
    points, faces = made
    edges = patterns.edges(faces)
    assert len(points) - len(edges) + len(faces) == characteristic
    directed = [(face[i], face[(i + 1) % len(face)]) for face in faces for i in range(len(face))]
    assert len(set(directed)) == len(directed)
    assert {v for face in faces for v in face} == set(range(len(points)))


def test_the_snub_square_tiling_is_of_regular_triangles_and_squares():
    points, faces = meshes.snub_square(3)
    assert np.allclose(measure.edge_lengths(points, patterns.edges(faces)), 1)
    for face in faces:
        assert np.allclose(measure.face_angles(points, face), {3: 60, 4: 90}[len(face)])
    degrees = np.bincount([v for edge in patterns.edges(faces) for v in edge])
    assert degrees.max() == 5


def test_planarity_is_the_distance_of_the_diagonals_over_their_mean_length():
    # Diagonals along x and y, 2 long, 0.1 apart.
    points = np.array([[-1, 0, 0], [0, -1, 0.1], [1, 0, 0], [0, 1, 0.1]])
    assert measure.planarity(points, [[0, 1, 2, 3]]) == pytest.approx([5.0])
    # The best plane lies midway between the diagonals.
    assert measure.plane_distances(points, [[0, 1, 2, 3]]) == pytest.approx([0.05])


def test_strain_is_positive_in_tension():
    rest = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0]])
    assert measure.strains(rest * [1.5, 0.5, 1], rest, [[0, 1], [1, 2]]) == pytest.approx([0.5, -0.5])


def test_the_best_circle_is_the_best_in_the_least_squares_sense():
    random = np.random.RandomState(5)
    angles = np.linspace(0, 2, 15)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    flat = np.stack([3 * np.cos(angles), 3 * np.sin(angles), 0 * angles], axis=1)
    exact = flat @ turn + [4, 5, 6]
    assert measure.circle_distances(exact).max() < 1e-12
    radial = flat * (1 + 0.02 * random.standard_normal(15))[:, None]
    best = (measure.circle_distances(radial @ turn) ** 2).sum()
    for centre in random.uniform(-0.2, 0.2, (200, 2)):
        distances = np.linalg.norm(radial[:, :2] - centre, axis=1)
        assert best <= ((distances - distances.mean()) ** 2).sum() + 1e-12


def test_the_nearest_shape_is_found_from_any_corner_turn_and_side():
    random = np.random.RandomState(6)
    shapes = np.array([[[0, 0, 0], [w, 0, 0], [w, 1, 0], [0, 1, 0]] for w in (1, 1.5, 2)])
    for which in range(3):
        for start in range(4):
            turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
            corners = np.roll(shapes[which], start, axis=0)[:: random.choice([1, -1])] @ turn + random.standard_normal(
                3
            )
            index, distance = measure.nearest_shapes(shapes, corners[None])
            assert (index[0], distance[0]) == (which, pytest.approx(0, abs=1e-12))
            # A shape 0.1 too long is 0.05 too long at either end.
            longer = (
                np.roll(shapes[which] * [(shapes[which][1, 0] + 0.1) / shapes[which][1, 0], 1, 1], start, axis=0) @ turn
            )
            index, distance = measure.nearest_shapes(shapes, longer[None])
            assert (index[0], distance[0]) == (which, pytest.approx(0.05))


def test_similar_shapes_match_only_if_scale_is_allowed():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    assert measure.nearest_shapes([square], 3 * square[None], allow_scale=True)[1][0] < 1e-12
    assert measure.nearest_shapes([square], 3 * square[None])[1][0] == pytest.approx(math.sqrt(2))


def test_faces_of_a_box_are_squares_of_area_one_at_right_angles():
    points, faces = meshes.box(2, 1, 1)
    assert np.allclose(measure.areas(points, faces), 1)
    assert np.allclose(measure.all_angles(points, faces), 90)
    assert set(np.round(measure.face_face_angles(points, faces)).astype(int)) == {90, 180}
    outward = [
        n @ (points[f].mean(axis=0) - points.mean(axis=0))
        for n, f in zip(measure.face_normals(points, faces), faces, strict=True)
    ]
    assert min(outward) > 0


def test_obj_files_read_back_as_written(tmp_path):
    points, faces = meshes.snub_square(2)
    (tmp_path / "mesh.obj").write_text(meshes.obj_text((points, faces)))
    again, same = meshes.read_obj(tmp_path / "mesh.obj")
    assert same == faces
    assert np.abs(again - points).max() <= 0.5001 * 10.0**-meshes.DECIMALS
