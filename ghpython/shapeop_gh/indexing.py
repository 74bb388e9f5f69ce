"""Patterns of point indices: which vertices of a mesh belong to one constraint. Nearest points.

A mesh is a Rhino.Geometry.Mesh. Patterns come in the order that RhinoCommon gives, so that weights and scalars of
existing definitions keep their places. Each is a list of (path, indices).
"""

import struct

from shapeop_gh.errors import ShapeOpError


def pattern(name, mesh):
    if name not in PATTERNS:
        raise ShapeOpError("Pattern: one of %s expected, found %r" % (", ".join(sorted(PATTERNS)), name))
    return PATTERNS[name](mesh)


def faces(mesh):
    """The corners of every face."""
    corners = []
    for i in range(mesh.Faces.Count):
        face = mesh.Faces[i]
        corners.append([face.A, face.B, face.C, face.D] if face.IsQuad else [face.A, face.B, face.C])
    return corners


def _neighbours(mesh):
    return [list(mesh.Vertices.GetConnectedVertices(i) or ()) for i in range(mesh.Vertices.Count)]


def _vertex_neighbours(mesh):
    return _numbered([i] + others for i, others in enumerate(_neighbours(mesh)))


def _edge_vertices(mesh):
    return _numbered([i, j] for i, others in enumerate(_neighbours(mesh)) for j in others if j > i)


def _edge_face_vertices(mesh):
    """Per inner edge: its ends, then the other corners of its two faces. The path is the edge's index in the mesh."""
    first = [mesh.TopologyVertices.MeshVertexIndices(i)[0] for i in range(mesh.TopologyVertices.Count)]
    branches = []
    for edge in range(mesh.TopologyEdges.Count):
        beside = mesh.TopologyEdges.GetConnectedFaces(edge)
        if len(beside) != 2:
            continue
        pair = mesh.TopologyEdges.GetTopologyVertices(edge)
        ends = sorted([first[pair.I], first[pair.J]])
        others = []
        for face in beside:
            for corner in mesh.Faces.GetTopologicalVertices(face):
                if first[corner] not in ends and first[corner] not in others:
                    others.append(first[corner])
        branches.append((edge, ends + others))
    return branches


def _face_angle_vertices(mesh):
    """Per corner of every face: the corner, the next one, the one before."""
    return _numbered(
        [corners[k], corners[(k + 1) % len(corners)], corners[k - 1]]
        for corners in faces(mesh)
        for k in range(len(corners))
    )


def _naked_vertices(mesh):
    """Per closed boundary loop: its vertices in the order of their indices."""
    naked = mesh.GetNakedEdgePointStatus()
    vertices = [(i, _single(mesh.Vertices[i])) for i in range(mesh.Vertices.Count) if naked[i]]
    branches = []
    for path, loop in enumerate(mesh.GetNakedEdges() or ()):
        places = set(_single(point) for point in loop)
        on_loop = [i for i, vertex in vertices if vertex in places]
        if on_loop:
            branches.append((path, on_loop))
    return branches


def _numbered(lists):
    return list(enumerate(lists))


def _single(point):
    """The coordinates in single precision, in which a mesh hands out its vertices."""
    return struct.unpack("3f", struct.pack("3f", point.X, point.Y, point.Z))


PATTERNS = {
    "faceVertices": lambda mesh: _numbered(faces(mesh)),
    "vertexNeighbours": _vertex_neighbours,
    "edgeVertices": _edge_vertices,
    "verticesAll": lambda mesh: [(0, list(range(mesh.Vertices.Count)))],
    "verticesEach": lambda mesh: _numbered([i] for i in range(mesh.Vertices.Count)),
    "edgeFaceVertices": _edge_face_vertices,
    "faceAngleVertices": _face_angle_vertices,
    "nakedVertices": _naked_vertices,
}


def ends(geometry, what):
    """Where a handle grabs and where it pulls to: the ends of a curve, line or polyline; twice the same of a point."""
    for start, end in (("PointAtStart", "PointAtEnd"), ("From", "To"), ("First", "Last"), ("Location", "Location")):
        if hasattr(geometry, start):
            return getattr(geometry, start), getattr(geometry, end)
    if hasattr(geometry, "X"):
        return geometry, geometry
    raise ShapeOpError("%s: a point or curve expected, found %r" % (what, geometry))


def nearest(points, place):
    """The index of the point nearest to `place`, the first of equals."""
    if not points:
        raise ShapeOpError("Points: at least one expected, found none")
    x, y, z = place.X, place.Y, place.Z
    return min(
        range(len(points)), key=lambda i: (points[i].X - x) ** 2 + (points[i].Y - y) ** 2 + (points[i].Z - z) ** 2
    )
