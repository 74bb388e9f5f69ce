"""Reads the text of an OBJ file.

Mesh has the faces, Points the vertices: a mesh of Rhino may keep its vertices with seven digits, points have sixteen."""
import Rhino.Geometry as rg

Mesh = rg.Mesh()
Points = []
for number, line in enumerate((Text or "").splitlines(), 1):
    words = line.split()
    if words[:1] == ["v"]:
        point = rg.Point3d(*[float(word) for word in words[1:4]])
        Points.append(point)
        Mesh.Vertices.Add(point.X, point.Y, point.Z)
    elif words[:1] == ["f"]:
        corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
        if len(corners) not in (3, 4):
            raise ValueError("line %d: a face of %d corners; Rhino's meshes have triangles and quads" % (number, len(corners)))
        Mesh.Faces.AddFace(*corners)
