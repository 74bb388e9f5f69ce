"""The mesh with its vertices at other points."""
import Rhino.Geometry as rg

Moved = None
if Mesh and Points:
    Moved = rg.Mesh()
    for point in Points:
        Moved.Vertices.Add(point.X, point.Y, point.Z)
    for index in range(Mesh.Faces.Count):
        face = Mesh.Faces[index]
        corners = (face.A, face.B, face.C, face.D) if face.IsQuad else (face.A, face.B, face.C)
        Moved.Faces.AddFace(*corners)
