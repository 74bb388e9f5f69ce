"""Patterns: from the faces of a mesh to the point indices of constraints. Pure Python; README.md states what each one gives."""


def edges(faces):
    """Every edge once, as `(start, end)` in the direction and order in which the faces first meet it."""
    return [key[0] for key in _faces_of_edges(faces).values()]


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
    return [
        [face[i], face[(i + 1) % len(face)], face[i - 1]]
        for face in faces
        for i in range(len(face))
    ]


def edge_face_vertices(vertex_count, faces):
    inner = []
    for (start, end), *followers in _faces_of_edges(faces).values():
        if len(followers) == 2:
            inner.append([start, end] + followers)
    return inner


def naked_vertices(vertex_count, faces):
    naked = {
        vertex
        for edge, *followers in _faces_of_edges(faces).values()
        if len(followers) == 1
        for vertex in edge
    }
    return [[vertex] for vertex in sorted(naked)]


def _faces_of_edges(faces):
    """For each undirected edge: `[(start, end), the vertex that follows the edge in each of its faces ...]`."""
    found = {}
    for face in faces:
        for i, start in enumerate(face):
            end, follower = face[(i + 1) % len(face)], face[(i + 2) % len(face)]
            found.setdefault(frozenset((start, end)), [(start, end)]).append(follower)
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
