"""The mesh with its vertices at other points."""
Moved = Mesh.DuplicateMesh() if Mesh and Points and len(Points) == Mesh.Vertices.Count else None
if Moved:
    for index, point in enumerate(Points):
        Moved.Vertices.SetVertex(index, point.X, point.Y, point.Z)
    Moved.Normals.ComputeNormals()
