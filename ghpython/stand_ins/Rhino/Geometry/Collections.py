import Rhino


class MeshVertexList(object):
    def __init__(self, mesh):
        self._mesh, self._points = mesh, []

    @property
    def Count(self):
        return len(self._points)

    def Add(self, x, y, z):
        self._points.append(Rhino.Geometry.Point3d(x, y, z))
        return len(self._points) - 1

    def __getitem__(self, index):
        point = self._points[index]
        return Rhino.Geometry.Point3f(point.X, point.Y, point.Z)

    def Point3dAt(self, index):
        return self._points[index]

    def ToPoint3dArray(self):
        return list(self._points)

    def GetConnectedVertices(self, index):
        """The vertices that share an edge, by way of the edges around a topology vertex."""
        topology = self._mesh.TopologyVertices
        here = topology.TopologyVertexIndex(index)
        found = []
        for edge in self._mesh.TopologyEdges._pairs():
            if here in edge:
                other = edge[1] if edge[0] == here else edge[0]
                found.extend(topology.MeshVertexIndices(other))
        return found


class MeshFaceList(object):
    def __init__(self, mesh):
        self._mesh, self._faces = mesh, []

    @property
    def Count(self):
        return len(self._faces)

    def AddFace(self, *corners):
        self._faces.append(Rhino.Geometry.MeshFace(*corners))
        return len(self._faces) - 1

    def __getitem__(self, index):
        return self._faces[index]

    def _corners(self, index):
        face = self._faces[index]
        return [face.A, face.B, face.C, face.D] if face.IsQuad else [face.A, face.B, face.C]

    def GetTopologicalVertices(self, index):
        return [self._mesh.TopologyVertices.TopologyVertexIndex(i) for i in self._corners(index)]


class MeshTopologyVertexList(object):
    """Vertices at the same place are one topology vertex."""

    def __init__(self, mesh):
        self._groups, self._of = [], []
        places = {}
        for i in range(mesh.Vertices.Count):
            vertex = mesh.Vertices[i]
            place = (vertex.X, vertex.Y, vertex.Z)
            if place not in places:
                places[place] = len(self._groups)
                self._groups.append([])
            self._groups[places[place]].append(i)
            self._of.append(places[place])

    @property
    def Count(self):
        return len(self._groups)

    def MeshVertexIndices(self, index):
        return list(self._groups[index])

    def TopologyVertexIndex(self, vertex):
        return self._of[vertex]


class MeshTopologyEdgeList(object):
    def __init__(self, mesh):
        self._edges, self._faces, self._directed = [], {}, []
        for face in range(mesh.Faces.Count):
            corners = mesh.Faces.GetTopologicalVertices(face)
            for start, end in zip(corners, corners[1:] + corners[:1]):
                edge = (min(start, end), max(start, end))
                if edge not in self._faces:
                    self._edges.append(edge)
                self._faces.setdefault(edge, []).append(face)
                self._directed.append((start, end))

    @property
    def Count(self):
        return len(self._edges)

    def GetConnectedFaces(self, edge):
        return list(self._faces[self._edges[edge]])

    def GetTopologyVertices(self, edge):
        return Rhino.IndexPair(*self._edges[edge])

    def _pairs(self):
        return self._edges

    def _naked(self):
        return [(a, b) for a, b in self._directed if len(self._faces[min(a, b), max(a, b)]) == 1]
