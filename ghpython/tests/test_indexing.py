import unittest

from support import Canvas, grid, plain
from Rhino.Geometry import Line, LineCurve, Mesh, Point, Point3d, Polyline

from shapeop_gh import indexing
from shapeop_gh.errors import ShapeOpError


def indices(pattern, mesh):
    return plain(Canvas().add("ShapeOpMeshIndexer").run(Pattern=pattern, Mesh=mesh)["PointIndices"])


def two_faces():
    """A quad 0 1 2 3 and a triangle 1 4 2 that share the edge 1 2."""
    mesh = Mesh()
    for x, y in ((0, 0), (1, 0), (1, 1), (0, 1), (2, 0)):
        mesh.Vertices.Add(x, y, 0)
    mesh.Faces.AddFace(0, 1, 2, 3)
    mesh.Faces.AddFace(1, 4, 2)
    return mesh


class Patterns(unittest.TestCase):
    def test_face_vertices_are_the_corners_of_quads_and_triangles(self):
        self.assertEqual(indices("faceVertices", two_faces()), [([0], [0, 1, 2, 3]), ([1], [1, 4, 2])])

    def test_vertex_neighbours_begin_with_the_vertex(self):
        branches = indices("vertexNeighbours", two_faces())
        self.assertEqual([branch[0] for _, branch in branches], [0, 1, 2, 3, 4])
        self.assertEqual([set(branch[1:]) for _, branch in branches], [{1, 3}, {0, 2, 4}, {1, 3, 4}, {0, 2}, {1, 2}])

    def test_edge_vertices_name_every_edge_once(self):
        branches = indices("edgeVertices", two_faces())
        self.assertEqual([path for path, _ in branches], [[n] for n in range(6)])
        edges = [tuple(branch) for _, branch in branches]
        self.assertEqual(set(edges), {(0, 1), (0, 3), (1, 2), (2, 3), (1, 4), (2, 4)})
        self.assertEqual(edges, sorted(edges, key=lambda e: e[0]))

    def test_vertices_all_is_one_branch_and_each_is_many(self):
        self.assertEqual(indices("verticesAll", two_faces()), [([0], [0, 1, 2, 3, 4])])
        self.assertEqual(indices("verticesEach", two_faces()), [([n], [n]) for n in range(5)])

    def test_edge_face_vertices_are_ends_then_opposite_corners_at_the_path_of_the_edge(self):
        mesh = Mesh()
        for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
            mesh.Vertices.Add(x, y, 0)
        mesh.Faces.AddFace(0, 1, 2)
        mesh.Faces.AddFace(0, 2, 3)
        branches = indices("edgeFaceVertices", mesh)
        self.assertEqual(len(branches), 1)
        (path,), branch = branches[0]
        ends = mesh.TopologyEdges.GetTopologyVertices(path)
        self.assertEqual(sorted([ends.I, ends.J]), [0, 2])
        self.assertEqual((branch[:2], sorted(branch[2:])), ([0, 2], [1, 3]))

    def test_face_angle_vertices_are_corner_next_and_previous(self):
        branches = [branch for _, branch in indices("faceAngleVertices", two_faces())]
        self.assertEqual(branches, [[0, 1, 3], [1, 2, 0], [2, 3, 1], [3, 0, 2], [1, 4, 2], [4, 2, 1], [2, 1, 4]])

    def test_naked_vertices_are_sorted_by_loop(self):
        mesh = grid(4, 4)
        mesh.Faces._faces.pop(4)  # the middle face: its corners are a hole's
        self.assertEqual(
            [branch for _, branch in indices("nakedVertices", mesh)],
            [[0, 1, 2, 3, 4, 7, 8, 11, 12, 13, 14, 15], [5, 6, 9, 10]],
        )

    def test_naked_vertices_are_found_where_coordinates_are_not_single_precision(self):
        mesh = Mesh()
        for x, y in ((0.1, 0.2), (1.1, 0.3), (0.7, 1.3)):
            mesh.Vertices.Add(x, y, 1 / 3.0)
        mesh.Faces.AddFace(0, 1, 2)
        self.assertEqual(indices("nakedVertices", mesh), [([0], [0, 1, 2])])

    def test_an_unwelded_mesh_has_one_edge_between_its_faces(self):
        mesh = Mesh()
        for x, y in ((0, 0), (1, 0), (0, 1), (1, 0), (1, 1), (0, 1)):
            mesh.Vertices.Add(x, y, 0)
        mesh.Faces.AddFace(0, 1, 2)
        mesh.Faces.AddFace(3, 4, 5)
        self.assertEqual([branch for _, branch in indices("edgeFaceVertices", mesh)], [[1, 2, 0, 4]])

    def test_an_unknown_pattern_is_an_error_that_names_the_known_ones(self):
        indexer = Canvas().add("ShapeOpMeshIndexer")
        self.assertEqual(indexer.run(Pattern="faces", Mesh=grid(2, 2)), {"PointIndices": None})
        self.assertIn("faceVertices", indexer.errors()[0])
        self.assertIn("'faces'", indexer.errors()[0])

    def test_without_a_mesh_there_are_no_indices(self):
        self.assertEqual(Canvas().add("ShapeOpMeshIndexer").run(Pattern="faceVertices"), {"PointIndices": []})


class Anchors(unittest.TestCase):
    def test_a_point_holds_the_nearest_vertex_where_it_is(self):
        made = Canvas().add("ShapeOpAnchorsIndexer").run(Mesh=grid(3, 3), AnchorGeo=[Point3d(1.9, 1.8, 0.3)])
        self.assertEqual(plain(made["PointIndices"]), [([0], [8])])
        self.assertEqual([(p.X, p.Y, p.Z) for p in plain(made["AnchorPts"])[0][1]], [(1.9, 1.8, 0.3)])

    def test_a_curve_holds_the_vertex_at_its_start_at_its_end(self):
        for kind in (LineCurve, Line, lambda a, b: Polyline([a, Point3d(5, 5, 5), b])):
            anchors = [Point3d(0, 0, 0), kind(Point3d(2, 0, 0.1), Point3d(2, 0, 4))]
            made = Canvas().add("ShapeOpAnchorsIndexer").run(Mesh=grid(3, 3), AnchorGeo=anchors)
            self.assertEqual(plain(made["PointIndices"]), [([0], [0]), ([1], [2])])
            self.assertEqual(plain(made["AnchorPts"])[1][1][0].Z, 4.0)

    def test_what_is_neither_point_nor_curve_is_an_error(self):
        anchors = Canvas().add("ShapeOpAnchorsIndexer")
        made = anchors.run(Mesh=grid(2, 2), AnchorGeo=["nowhere"])
        self.assertEqual(made, {"PointIndices": None, "AnchorPts": None})
        self.assertIn("AnchorGeo", anchors.errors()[0])
        self.assertIn("'nowhere'", anchors.errors()[0])

    def test_a_point_object_counts_as_its_location(self):
        place = Point3d(1, 2, 3)
        self.assertEqual(indexing.ends(Point(place), ""), (place, place))

    def test_of_equally_near_points_the_first_is_taken(self):
        self.assertEqual(indexing.nearest([Point3d(1, 0, 0), Point3d(-1, 0, 0)], Point3d(0, 0, 0)), 0)
        self.assertRaises(ShapeOpError, indexing.nearest, [], Point3d(0, 0, 0))


if __name__ == "__main__":
    unittest.main()
