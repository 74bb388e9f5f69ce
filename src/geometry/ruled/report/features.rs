//! How large the features of a surface are.

use crate::mesh::TriangleMesh;

/// What is flat has features of this many diagonals.
const FLAT: f64 = 1e6;

/// The size of a mesh's features at each of its points, in model units: the least radius that its normals show along the edges of
/// the point. They turn by `|S e|` along a step `e`, with `S` the shape operator, so that it is between the two principal radii, and
/// `√(−1/K)` where these are opposite. At most a million diagonals, where it is flat.
pub fn feature_sizes(mesh: &TriangleMesh) -> Vec<f64> {
    let most = FLAT * mesh.diagonal();
    let mut sizes = vec![most; mesh.points().len()];
    for [a, b] in mesh.edges().into_iter().map(|ends| ends.map(|i| i as usize)) {
        let turn = mesh.point_normals()[a].distance(mesh.point_normals()[b]);
        let size = mesh.points()[a].distance(mesh.points()[b]) / turn;
        if size.is_finite() {
            sizes[a] = sizes[a].min(size);
            sizes[b] = sizes[b].min(size);
        }
    }
    sizes
}
