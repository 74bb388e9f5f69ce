import struct

from Rhino.Geometry.Collections import MeshFaceList, MeshTopologyEdgeList, MeshTopologyVertexList, MeshVertexList


class Point3d(object):
    def __init__(self, x, y, z):
        self.X, self.Y, self.Z = float(x), float(y), float(z)


class Point3f(object):
    def __init__(self, x, y, z):
        self.X, self.Y, self.Z = struct.unpack("3f", struct.pack("3f", x, y, z))


class Vector3d(object):
    def __init__(self, x, y, z):
        self.X, self.Y, self.Z = float(x), float(y), float(z)


class Curve(object):
    pass


class LineCurve(Curve):
    def __init__(self, start, end):
        self.PointAtStart, self.PointAtEnd = start, end


class Line(object):
    def __init__(self, start, end):
        self.From, self.To = start, end


class Point(object):
    def __init__(self, location):
        self.Location = location


class Polyline(object):
    def __init__(self, points):
        self._points = list(points)

    @property
    def First(self):
        return self._points[0]

    @property
    def Last(self):
        return self._points[-1]

    def __iter__(self):
        return iter(self._points)


class MeshFace(object):
    def __init__(self, a, b, c, d=None):
        self.A, self.B, self.C, self.D = a, b, c, c if d is None else d

    @property
    def IsQuad(self):
        return self.C != self.D

    @property
    def IsTriangle(self):
        return self.C == self.D


class Mesh(object):
    def __init__(self):
        self.Vertices = MeshVertexList(self)
        self.Faces = MeshFaceList(self)
        self._kept = {}

    @property
    def TopologyVertices(self):
        return self._keep(MeshTopologyVertexList)

    @property
    def TopologyEdges(self):
        return self._keep(MeshTopologyEdgeList)

    def _keep(self, kind):
        """Made anew only where vertices or faces were added: nothing else changes a mesh here."""
        counts = (self.Vertices.Count, self.Faces.Count)
        if self._kept.get(kind, (None, None))[0] != counts:
            self._kept[kind] = (counts, kind(self))
        return self._kept[kind][1]

    def GetNakedEdgePointStatus(self):
        naked = set(v for edge in self.TopologyEdges._naked() for v in edge)
        topology = self.TopologyVertices
        return [topology.TopologyVertexIndex(i) in naked for i in range(self.Vertices.Count)]

    def GetNakedEdges(self):
        """Closed polylines around the holes and borders; None of a closed mesh."""
        after = dict(self.TopologyEdges._naked())
        first = [self.TopologyVertices.MeshVertexIndices(i)[0] for i in range(self.TopologyVertices.Count)]
        loops = []
        while after:
            start = at = min(after)
            loop = [start]
            while at in after:
                at = after.pop(at)
                loop.append(at)
            assert at == start, "a stand-in for manifold borders only"
            loops.append(Polyline([self.Vertices.Point3dAt(first[v]) for v in loop]))
        return loops or None
