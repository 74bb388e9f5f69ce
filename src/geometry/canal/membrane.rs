//! Membrane forces under uniform normal pressure, when the lines of curvature are lines of principal stress.
//!
//! On lines of curvature `u`, `v` with the Lamé coefficients `A₁`, `A₂` a membrane without shear under the pressure `p` is in
//! equilibrium when (Rogers & Schief 2003, as cited in section 3.4)
//!
//! ```text
//! (N₁ A₂)_u = N₂ A₂,u      (N₂ A₁)_v = N₁ A₁,v      κ₁ N₁ + κ₂ N₂ = p
//! ```
//!
//! These are three equations for two forces: on most surfaces they have no solution. On canal surfaces they do. The paper says so
//! of C-canal surfaces too, and that is not right as it stands: a cylinder over a curve is a limit of one, and there the second
//! equation makes the hoop force constant around the curve, the third makes it `p / κ₂`; so the curve must be a circle. Tests show
//! both. Solutions need not be unique: the edges of an open net can be loaded.
//!
//! Here `N₁` and `N₂` are unknowns of each face of a net, lengths `A` are those of arcs, curvatures those of the arcs in the
//! direction of the normal; the first two equations belong to edges between faces. All are solved by least squares, each weighted by
//! its area; the residual, relative to `p`, falls under refinement where the statement holds. The oracles are the closed forms of
//! sphere and torus: with `R₁` the radius of curvature of a meridian, `R₂` that of the section across, `N_φ = p R₂ / 2` along
//! meridians and `N_θ = p R₂ (1 − R₂ / 2 R₁)` around, where the shell is closed at a pole.

use super::combescure::check_count;
use super::net::Net;
use crate::error::{Error, Result, Status, finite};
use crate::linalg::least_squares::LeastSquares;

/// The mean geometry of a face.
struct Cell {
    /// Arc lengths in direction 1 and 2.
    lengths: [f64; 2],
    /// Curvatures of the lines in direction 1 and 2, above 0 where they bend away from the normal (a sphere's with the
    /// normal outwards).
    curvatures: [f64; 2],
}

/// How near any forces come to equilibrium under pressure along the normals: the root of the area's mean of the squared residuals
/// over the pressure, for the forces of least squares. 0: lines of curvature can be lines of principal stress; 1: no force carries
/// anything.
///
/// # Errors
/// Status `Degenerate`: an arc of a face runs through infinity; the place is `faces[i]`.
pub fn least_residual(net: &Net) -> Result<f64> {
    let equations = equations(net)?;
    Ok(norm(&equations.residuals(&equations.solve()?)))
}

/// How far given forces are from equilibrium, measured as in [`least_residual`]: forces per length in direction 1 and 2, one per face
/// in the order of [`Grid::quads`](crate::mesh::Grid::quads), above 0 for tension under a pressure along the normal.
///
/// # Errors
/// As [`least_residual`]; `pressure` is 0 or not finite, or there are other numbers of forces than of faces.
pub fn residual_of(net: &Net, pressure: f64, forces_one: &[f64], forces_two: &[f64]) -> Result<f64> {
    if finite("pressure", pressure)? == 0.0 {
        return Err(Error::new(Status::InvalidValue, "expected a pressure other than 0, found 0").at("pressure"));
    }
    let [rows, columns] = net.grid().spans();
    check_count("forces_one", forces_one, rows * columns)?;
    check_count("forces_two", forces_two, rows * columns)?;
    let unit = pressure * net.grid().diagonal();
    let unknowns: Vec<f64> =
        forces_one.iter().zip(forces_two).flat_map(|(one, two)| [one / unit, two / unit]).collect();
    Ok(norm(&equations(net)?.residuals(&unknowns)))
}

fn norm(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum::<f64>().sqrt()
}

/// The equations for the pressure 1. Unknown `2 k` is the force of face `k` in direction 1, `2 k + 1` in direction 2, both in
/// units of pressure times the diagonal, so that all are about 1.
fn equations(net: &Net) -> Result<LeastSquares> {
    let grid = net.grid();
    let [rows, columns] = grid.spans();
    let mut cells = Vec::with_capacity(rows * columns);
    for i in 0..rows {
        for j in 0..columns {
            cells.push(cell(net, i, j).map_err(|error| error.at(format!("faces[{}]", i * columns + j)))?);
        }
    }
    let [wraps_rows, wraps_columns] = grid.wraps();
    let face = |i: usize, j: usize| (i % rows) * columns + j % columns;
    let area = |k: usize| cells[k].lengths[0] * cells[k].lengths[1];
    let total: f64 = (0..cells.len()).map(area).sum();
    let size = grid.diagonal();
    let one = |face: usize| 2 * face as u32;
    let two = |face: usize| 2 * face as u32 + 1;
    let mut system = LeastSquares::new(2 * cells.len());
    for k in 0..cells.len() {
        let weight = (area(k) / total).sqrt();
        let [first, second] = cells[k].curvatures;
        system.add(&[(one(k), weight * size * first), (two(k), weight * size * second)], weight);
    }
    // With N across the edge between two faces, M along it and B their lengths along it:
    // N' B' − N B = ½ (M + M') (B' − B), divided by the faces' mean area.
    let mut balance = |k: usize, next: usize, n: &dyn Fn(usize) -> u32, m: &dyn Fn(usize) -> u32, along: usize| {
        let [b, b_next] = [k, next].map(|k| cells[k].lengths[along]);
        let area = 0.5 * (area(k) + area(next));
        let weight = (area / total).sqrt() * size / area;
        let half = 0.5 * (b_next - b);
        let entries = [(n(next), b_next), (n(k), -b), (m(k), -half), (m(next), -half)];
        system.add(&entries.map(|(unknown, value)| (unknown, weight * value)), 0.0);
    };
    for i in 0..rows {
        for j in 0..columns {
            if i + 1 < rows || wraps_rows {
                balance(face(i, j), face(i + 1, j), &one, &two, 1);
            }
            if j + 1 < columns || wraps_columns {
                balance(face(i, j), face(i, j + 1), &two, &one, 0);
            }
        }
    }
    Ok(system)
}

fn cell(net: &Net, i: usize, j: usize) -> Result<Cell> {
    let patch = net.patch(i, j)?;
    if patch.runs_through_infinity() {
        return Err(Error::new(Status::Degenerate, "one of its arcs runs through infinity"));
    }
    let grid = net.grid();
    let normal = |i: usize, j: usize| net.frames()[grid.index(i, j)].normal;
    let length = |arc: &crate::geometry::circle::Arc| {
        let phi = arc.half_angle();
        // A chord is 2 r sin φ, its arc 2 r φ.
        arc.start.distance(arc.end) * if phi < 1e-9 { 1.0 } else { phi / phi.sin() }
    };
    let (a, a_far, b, b_far) = (patch.arc_one(), patch.far_arc_one(), patch.arc_two(), patch.far_arc_two());
    let bent = |arc: &crate::geometry::circle::Arc, i: usize, j: usize| -arc.curvature().dot(normal(i, j));
    Ok(Cell {
        lengths: [0.5 * (length(&a) + length(&a_far)), 0.5 * (length(&b) + length(&b_far))],
        curvatures: [0.5 * (bent(&a, i, j) + bent(&a_far, i, j + 1)), 0.5 * (bent(&b, i, j) + bent(&b_far, i + 1, j))],
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::DVec3;

    use super::*;
    use crate::geometry::canal::chain::Transform;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::frame::Frame;
    use crate::geometry::canal::inversion::Inversion;
    use crate::geometry::canal::surface::{BaseKind, SuperCanal};
    use crate::geometry::random::Random;
    use crate::mesh::Grid;

    /// Rows around z, columns along the meridian `(radius, height)`; the first frame looks outwards at `normal`.
    fn revolution(meridian: impl Fn(usize) -> (f64, f64), rows: usize, columns: usize, wraps: [bool; 2]) -> Grid {
        let point = |k: usize| {
            let (i, j) = (k / columns, k % columns);
            let (angle, (radius, height)) = (TAU * i as f64 / rows as f64, meridian(j));
            DVec3::new(radius * angle.cos(), radius * angle.sin(), height)
        };
        Grid::new((0..rows * columns).map(point).collect(), rows, columns, wraps).unwrap()
    }

    #[test]
    fn sphere_and_torus_carry_pressure_as_their_closed_forms_say() {
        let (radius, pressure) = (1.7, 2.5);
        let at = |j: usize| 0.3 + (PI - 0.6) * j as f64 / 60.0;
        let grid = revolution(|j| (radius * at(j).sin(), -radius * at(j).cos()), 48, 61, [true, false]);
        let outwards = DVec3::new(at(0).sin(), 0.0, -at(0).cos());
        let net = Net::new(grid, Frame::of_tangent_one(DVec3::Y, outwards).unwrap()).unwrap();
        let forces = vec![0.5 * pressure * radius; 48 * 60];
        let residual = residual_of(&net, pressure, &forces, &forces).unwrap();
        assert!(residual < 1e-3, "{residual}");
        let (ring, tube, columns) = (3.0, 0.8, 160);
        let angle = |j: f64| TAU * j / columns as f64;
        let meridian = |j: usize| (ring + tube * angle(j as f64).cos(), tube * angle(j as f64).sin());
        let grid = revolution(meridian, 48, columns, [true, true]);
        let net = Net::new(grid, Frame::of_tangent_one(DVec3::Y, DVec3::X).unwrap()).unwrap();
        // Around the tube: p r (2R + r cos φ) / 2 (R + r cos φ); along the ring: p r / 2.
        let around = |k: usize| {
            let cosine = angle((k % columns) as f64 + 0.5).cos();
            0.5 * pressure * tube * (2.0 * ring + tube * cosine) / (ring + tube * cosine)
        };
        let forces_one = vec![0.5 * pressure * tube; 48 * columns];
        let forces_two: Vec<f64> = (0..48 * columns).map(around).collect();
        let residual = residual_of(&net, pressure, &forces_one, &forces_two).unwrap();
        assert!(residual < 1e-3, "{residual}");
        assert!(least_residual(&net).unwrap() < 1e-6);
        // Forces that are wrong by a tenth, or in the wrong direction, are found out.
        let heavier: Vec<f64> = forces_two.iter().map(|force| 1.1 * force).collect();
        assert!(residual_of(&net, pressure, &forces_one, &heavier).unwrap() > 0.05);
        assert!(residual_of(&net, pressure, &forces_two, &forces_one).unwrap() > 0.05);
    }

    #[test]
    fn a_canal_surface_is_in_equilibrium_and_its_images_are_not() {
        let mut random = Random(3);
        let mut surface = SuperCanal::new(Cyclide::new().net([0.2, 2.0], [-0.5, 1.2], 5, 5), BaseKind::Canal);
        let residuals = |surface: &SuperCanal| {
            [2, 4, 8].map(|pieces| least_residual(&surface.refined(pieces, pieces).unwrap()).unwrap())
        };
        let canal = residuals(&surface);
        assert!(canal[0] < 1e-4 && canal[1] < 0.3 * canal[0] && canal[2] < 0.3 * canal[1], "{canal:?}");
        let mut factors = || (0..4).map(|_| random.between(0.6, 1.7)).collect();
        surface.push(Transform::Combescure { column: factors(), row: factors() }).unwrap();
        let c_canal = residuals(&surface);
        surface.push(Transform::Inversion(Inversion::new(DVec3::new(0.2, 0.9, 1.0), 1.0).unwrap())).unwrap();
        let mc_canal = residuals(&surface);
        assert!(c_canal[2] > 0.01 && mc_canal[2] > 0.01, "{c_canal:?} {mc_canal:?}");
    }

    #[test]
    fn a_cylinder_is_in_equilibrium_over_a_circle_only() {
        // Half of an ellipse, along which direction 2 runs.
        let residual = |height: f64| {
            let point = |k: usize| {
                let angle = PI * (k % 41) as f64 / 40.0;
                DVec3::new(angle.cos(), (k / 41) as f64, height * angle.sin())
            };
            let grid = Grid::new((0..5 * 41).map(point).collect(), 5, 41, [false; 2]).unwrap();
            let net = Net::new(grid, Frame::of_tangent_one(DVec3::Y, DVec3::X).unwrap()).unwrap();
            least_residual(&net).unwrap()
        };
        assert!(residual(1.0) < 1e-6 && residual(0.7) > 0.05, "{} {}", residual(1.0), residual(0.7));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let net = Cyclide::new().net([0.2, 1.0], [-0.5, 1.2], 3, 3);
        let place = |pressure: f64, count: usize| {
            residual_of(&net, pressure, &vec![1.0; count], &[1.0; 4]).unwrap_err().place().to_owned()
        };
        assert_eq!([place(0.0, 4), place(f64::NAN, 4), place(1.0, 3)], ["pressure", "pressure", "forces_one"]);
    }
}
