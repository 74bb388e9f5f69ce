//! How large the features of a surface are.

use crate::mesh::TriangleMesh;
use crate::mesh::curvature::{Fit, Options, curvatures};

/// What is flat has features of this many diagonals.
const FLAT: f64 = 1e6;

/// The size of a mesh's features at each of its points, in model units: the least radius of curvature there, the reciprocal of the
/// greater of both principal curvatures, from the jets of [`curvatures`]. Where these are not determined, and where the surface is
/// flat, a million diagonals.
///
/// A strip of width `w` leaves a surface of this radius by `w² / 8r` at most, where it runs across that curvature; along asymptotic
/// curves by much less, but that the surface bends alike all across the strip is then what both rely on.
pub fn feature_sizes(mesh: &TriangleMesh) -> Vec<f64> {
    let most = FLAT * mesh.diagonal();
    let found = curvatures(mesh, &Options::default()).unwrap_or_default();
    let size = |i: usize| {
        let curvature = found.get(i).filter(|curvature| curvature.fit != Fit::Degenerate);
        let greatest =
            curvature.map_or(0.0, |curvature| curvature.principal[0].abs().max(curvature.principal[1].abs()));
        greatest.recip().min(most)
    };
    (0..mesh.points().len()).map(size).collect()
}
