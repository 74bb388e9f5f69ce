//! Gradient and divergence of functions on a triangle mesh.
//!
//! A function has a value at each point and is linear on triangles; a field has a vector in the plane of each triangle. With
//! `φ_k` the function that is 1 at corner `k` and 0 at the others, `e_k` the edge opposite to it (counterclockwise) and `n` the
//! unit normal, `∇φ_k = n × e_k / 2A`. The divergence at a point is weak: `div X(v) = −1/A_v Σ A ∇φ_v · X`, with the mixed
//! Voronoi area `A_v` of Meyer, Desbrun, Schröder and Barr 2003, "Discrete differential-geometry operators for triangulated
//! 2-manifolds". At points of the boundary this misses the flow over the boundary: it is no divergence there, and left to the
//! caller to skip. On irregular meshes values at single points do not converge under refinement; sums of many do.

use glam::DVec3;

use super::TriangleMesh;

/// The gradients of the three functions that are 1 at one corner of a triangle.
pub fn gradients_of_corners(mesh: &TriangleMesh, triangle: usize) -> [DVec3; 3] {
    let ([a, b, c], normal) = (mesh.corners(triangle), mesh.normal(triangle));
    let factor = 0.5 / mesh.area(triangle);
    [c - b, a - c, b - a].map(|edge| factor * normal.cross(edge))
}

/// The gradient of a function with these values at the points, on each triangle, in units of the function per model unit.
pub fn gradient(mesh: &TriangleMesh, values: &[f64]) -> Vec<DVec3> {
    (0..mesh.triangles().len()).map(|t| gradient_on(mesh, values, t)).collect()
}

/// The gradient on one triangle.
pub fn gradient_on(mesh: &TriangleMesh, values: &[f64], triangle: usize) -> DVec3 {
    let corners = mesh.triangles()[triangle].map(|i| values[i as usize]);
    let gradients = gradients_of_corners(mesh, triangle);
    (0..3).map(|k| corners[k] * gradients[k]).sum()
}

/// The mixed Voronoi area of each point, in square model units; they add up to the area of the mesh.
///
/// The part of a triangle at a corner without obtuse angles is that which is nearest to the corner; a triangle with an obtuse
/// angle gives half of its area to that corner and a quarter to each other.
pub fn mixed_areas(mesh: &TriangleMesh) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.points().len()];
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        let parts = mixed_parts(mesh.corners(t), mesh.area(t));
        (0..3).for_each(|k| areas[triangle[k] as usize] += parts[k]);
    }
    areas
}

/// What a triangle of this area, above 0, gives of it to each of its corners: [`mixed_areas`] adds them up.
pub fn mixed_parts(corners: [DVec3; 3], area: f64) -> [f64; 3] {
    let side = |k: usize| corners[(k + 1) % 3] - corners[k % 3];
    // The dot product of the two sides at a corner, which is below 0 for an obtuse angle.
    let dots = [0, 1, 2].map(|k| side(k).dot(-side(k + 2)));
    if let Some(obtuse) = dots.iter().position(|&dot| dot < 0.0) {
        return [0, 1, 2].map(|k| if k == obtuse { 0.5 * area } else { 0.25 * area });
    }
    // An eighth of each side's square times the cotangent of the angle opposite to it, which is its dot product over 2A.
    [0, 1, 2].map(|k| {
        let (next, last) = (side(k).length_squared(), side(k + 2).length_squared());
        (next * dots[(k + 2) % 3] + last * dots[(k + 1) % 3]) / (16.0 * area)
    })
}

/// The weak divergence of a field at each point, in units of the field per model unit. `areas` are [`mixed_areas`].
pub fn divergence(mesh: &TriangleMesh, areas: &[f64], field: &[DVec3]) -> Vec<f64> {
    let mut flow = vec![0.0; mesh.points().len()];
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        let gradients = gradients_of_corners(mesh, t);
        (0..3).for_each(|k| flow[triangle[k] as usize] -= mesh.area(t) * gradients[k].dot(field[t]));
    }
    flow.iter().zip(areas).map(|(flow, area)| flow / area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::height_field;

    fn mesh(n: usize, height: impl Fn(f64, f64) -> f64) -> TriangleMesh {
        TriangleMesh::new(&height_field(n + 1, n + 1, [0.0, 1.0], [0.0, 1.0], height).unwrap()).unwrap()
    }

    #[test]
    fn a_linear_function_has_its_gradient_everywhere() {
        let tilted = mesh(5, |x, y| 0.5 * x - 2.0 * y);
        let slope = DVec3::new(1.0, 2.0, -3.0);
        let values: Vec<f64> = tilted.points().iter().map(|p| slope.dot(*p) + 4.0).collect();
        // What is left of the slope in the plane.
        let normal = DVec3::new(-0.5, 2.0, 1.0).normalize();
        let expected = slope - slope.dot(normal) * normal;
        assert!(gradient(&tilted, &values).iter().all(|g| g.distance(expected) < 1e-13));
    }

    #[test]
    fn areas_of_points_add_up_and_obtuse_triangles_are_shared() {
        let curved = mesh(7, |x, y| (3.0 * x).sin() * y);
        let areas = mixed_areas(&curved);
        assert!((areas.iter().sum::<f64>() - curved.total_area()).abs() < 1e-14 && areas.iter().all(|a| *a > 0.0));
        // Equilateral: a third each. Right isosceles: half at the right angle, a quarter at the others.
        let third = mixed_parts([DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.75_f64.sqrt(), 0.0)], 0.75_f64.sqrt() / 2.0);
        assert!(third.iter().all(|part| (part - 0.75_f64.sqrt() / 6.0).abs() < 1e-15));
        assert_eq!(mixed_parts([DVec3::ZERO, DVec3::X, DVec3::Y], 0.5), [0.25, 0.125, 0.125]);
        assert_eq!(mixed_parts([DVec3::ZERO, DVec3::X, DVec3::new(-1.0, 1.0, 0.0)], 0.5), [0.25, 0.125, 0.125]);
    }

    #[test]
    fn the_divergence_is_the_gradients_adjoint_and_the_laplacian_of_a_paraboloid_is_four() {
        let flat = mesh(6, |_, _| 0.0);
        let values: Vec<f64> = flat.points().iter().map(|p| p.x * p.x + p.y * p.y).collect();
        let areas = mixed_areas(&flat);
        let field = gradient(&flat, &values);
        let laplacian = divergence(&flat, &areas, &field);
        for i in (0..flat.points().len()).filter(|&i| !flat.is_on_boundary(i)) {
            assert!((laplacian[i] - 4.0).abs() < 1e-12, "{}", laplacian[i]);
        }
        let other: Vec<f64> = flat.points().iter().map(|p| (5.0 * p.x).cos() + p.y * p.x).collect();
        let left: f64 = (0..other.len()).map(|i| areas[i] * other[i] * laplacian[i]).sum();
        let dots = gradient(&flat, &other).iter().zip(&field).map(|(a, b)| a.dot(*b)).collect::<Vec<_>>();
        let right: f64 = dots.iter().enumerate().map(|(t, dot)| flat.area(t) * dot).sum();
        assert!((left + right).abs() < 1e-13);
    }
}
