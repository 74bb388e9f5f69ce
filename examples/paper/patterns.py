"""Patterns: from the faces of a mesh to the point indices of constraints. Pure Python; README.md states what each one
gives."""


def edges(faces):
    """Every edge once, as `(smaller index, larger index)`, sorted."""
    return sorted(_faces_of_edges(faces))


def face_vertices(vertex_count, faces):
    return [list(face) for face in faces]


def edge_vertices(vertex_count, faces):
    return [list(edge) for edge in edges(faces)]


def vertex_neighbours(vertex_count, faces):
    neighbours = [[vertex] for vertex in range(vertex_count)]
    for start, end in edges(faces):
        neighbours[start].append(end)
        neighbours[end].append(start)
    return neighbours


def vertices_each(vertex_count, faces):
    return [[vertex] for vertex in range(vertex_count)]


def vertices_all(vertex_count, faces):
    return [list(range(vertex_count))]


def face_angle_vertices(vertex_count, faces):
    return [[face[i], face[(i + 1) % len(face)], face[i - 1]] for face in faces for i in range(len(face))]


def edge_face_vertices(vertex_count, faces):
    inner = []
    for edge, beside in sorted(_faces_of_edges(faces).items()):
        if len(beside) == 2:
            inner.append(list(edge) + [corner for face in beside for corner in face if corner not in edge])
    return inner


def naked_vertices(vertex_count, faces):
    naked = {}
    for edge, beside in _faces_of_edges(faces).items():
        if len(beside) == 1:
            for start, end in (edge, edge[::-1]):
                naked.setdefault(start, []).append(end)
    loops = []
    while naked:
        loop, reached = set(), [min(naked)]
        while reached:
            vertex = reached.pop()
            loop.add(vertex)
            reached += naked.pop(vertex, [])
        loops.append(sorted(loop))
    return loops


def hinges(faces):
    """For bending between polygons, no pattern but an explicit tree: for each inner edge, its two vertices, then from
    each face the vertex that follows the edge in that face's order. Of triangles it gives what `edgeFaceVertices`
    gives."""
    followers = {}
    for face in faces:
        for i, start in enumerate(face):
            end, follower = face[(i + 1) % len(face)], face[(i + 2) % len(face)]
            followers.setdefault((min(start, end), max(start, end)), []).append(follower)
    return [list(edge) + beside for edge, beside in sorted(followers.items()) if len(beside) == 2]


def _faces_of_edges(faces):
    """`{(smaller index, larger index): the faces that have this edge}`."""
    found = {}
    for face in faces:
        for i, start in enumerate(face):
            end = face[(i + 1) % len(face)]
            found.setdefault((min(start, end), max(start, end)), []).append(face)
    return found


PATTERNS = {
    "faceVertices": face_vertices,
    "edgeVertices": edge_vertices,
    "vertexNeighbours": vertex_neighbours,
    "verticesEach": vertices_each,
    "verticesAll": vertices_all,
    "faceAngleVertices": face_angle_vertices,
    "edgeFaceVertices": edge_face_vertices,
    "nakedVertices": naked_vertices,
}
