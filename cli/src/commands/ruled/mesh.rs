//! The mesh of trimmed strips.

use std::collections::HashMap;

use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::trim::Trimmed;
use shapeop::mesh::Mesh;

/// How often each triangle is cut in four. Triangles that are as long as a strip is wide are near to it but inclined: rulings are
/// twisted, and shading and area would be wrong by the square of what they turn along one edge.
const CUTS: u32 = 2;

/// All that is left of strips as triangles. Those of a strip share points, strips share none.
pub fn trimmed_mesh(strips: &[Strip], trimmed: &[Trimmed]) -> Mesh {
    let mut mesh = Mesh { points: Vec::new(), faces: Vec::new() };
    for (strip, trimmed) in strips.iter().zip(trimmed) {
        let (mut parameters, mut triangles) = (trimmed.parameters().to_vec(), trimmed.triangles().to_vec());
        for _ in 0..CUTS {
            triangles = quartered(&mut parameters, &triangles);
        }
        let first = mesh.points.len() as u32;
        mesh.points.extend(parameters.iter().map(|&[u, v]| strip.at(u, v).point));
        mesh.faces.extend(triangles.iter().map(|triangle| triangle.iter().map(|i| first + i).collect::<Vec<u32>>()));
    }
    mesh
}

/// Each triangle as four, with the middles of edges as points.
fn quartered(parameters: &mut Vec<[f64; 2]>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let [p, q] = [parameters[a as usize], parameters[b as usize]];
            parameters.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
            parameters.len() as u32 - 1
        })
    };
    let four = |&[a, b, c]: &[u32; 3]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    triangles.iter().flat_map(four).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarters_share_the_middles_of_edges() {
        let mut parameters = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
        let triangles = quartered(&mut parameters, &[[0, 1, 2], [2, 1, 3]]);
        assert_eq!((parameters.len(), triangles.len()), (9, 8));
        let area = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| parameters[*i as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        assert!(triangles.iter().all(|triangle| (area(triangle) - 0.125).abs() < 1e-15));
    }
}
