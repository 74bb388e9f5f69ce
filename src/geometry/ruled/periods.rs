//! Level functions and boundaries on surfaces with holes, such as tubes (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012, Fig. 8).
//!
//! Once around a hole a function whose gradient follows a field does not come back to its value. The surface is cut from loop to
//! loop of its boundary until one is left, and `f` may jump across each cut, by an amount that is the same all along it: gradients
//! agree on both sides. The amounts are unknowns like the values of `f`. If a jump is a multiple of the distance between levels,
//! level curves that end at the cut on one side go on at the other. So jumps are rounded to the nearest multiple, and the function
//! found again with these.
//!
//! With jumps of `m` levels, and no jump that `m` does not divide, level `k` and level `k + m` are the same curves: the boundaries
//! number `m`, and the first follows the last. Without jumps levels are as on a disk, though curves may be closed.

use std::ops::ControlFlow;

use super::Field;
use super::boundaries::{Boundaries, BoundaryOptions, Dropped, Levels, level_boundaries, of_curve};
use super::cuts::{Split, corners, cuts};
use super::level_function::{LevelFunction, LevelOptions, solve};
use super::level_terms::Jumps;
use super::rim::Rim;
use super::stitching::{Stitched, stitched};
use crate::error::{Error, Result, Status};
use crate::linalg::gauss_newton::Progress;
use crate::mesh::TriangleMesh;
use crate::mesh::level_curves::critical_points;

/// Levels around a tube at most.
const MOST_LEVELS: f64 = 1e5;

/// Which levels are boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spacing {
    /// So many around the first hole at which there is a jump; without any as [`Levels::Count`].
    Count(usize),
    /// At about this distance, in model units where the gradient is 1 long.
    Width(f64),
}

/// A cut between two loops of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// The points of the mesh along it.
    pub points: Vec<u32>,
    /// By how much more `f` is on its left than on its right: as found,
    pub found: f64,
    /// and as rounded to a multiple of the distance between levels.
    pub jump: f64,
}

/// Boundaries on a surface with holes.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicBoundaries {
    /// The level function with rounded jumps: at points of cuts its values on their right. Critical points beside cuts are left out.
    pub function: LevelFunction,
    /// The cuts, one fewer than the loops of the boundary.
    pub cuts: Vec<Cut>,
    /// The boundaries.
    pub boundaries: Boundaries,
    /// Whether the first boundary follows the last; that strip is the last one.
    pub is_cyclic: bool,
    /// For each boundary how often it crosses a cut from right to left more than from left to right, of all cuts the most: 2 and
    /// more, or −2 and less, is a spiral. 0 where no cut has a jump.
    pub windings: Vec<i32>,
}

/// Finds a level function on a surface with holes, and the boundaries along it. `progress` is as in
/// [`level_function`](super::level_function::level_function), called for both runs; ending the first ends the second before it
/// begins.
///
/// # Errors
/// As [`level_function`](super::level_function::level_function) and [`level_boundaries`]; a spacing that is not above 0, or so small
/// that there are more than 100 000 levels (`spacing`). Status `Infeasible`: the surface has handles or several parts, or no cuts
/// without common points exist (`mesh`).
pub fn periodic_boundaries(
    mesh: &TriangleMesh,
    field: &Field,
    level_options: &LevelOptions,
    spacing: Spacing,
    options: &BoundaryOptions,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<PeriodicBoundaries> {
    options.check()?;
    let paths = cuts(mesh)?;
    let mut jumps = Jumps { corners: corners(mesh, &paths), values: vec![None; paths.len()] };
    let mut is_ended = false;
    let mut noted = |now: &Progress| {
        let flow = if is_ended { ControlFlow::Break(()) } else { progress(now) };
        is_ended = flow.is_break();
        flow
    };
    let (first, found) = solve(mesh, field, level_options, &jumps, &mut noted)?;
    let width = width(&first, &found, spacing, mesh.mean_edge())?;
    let counts: Vec<i64> = found.iter().map(|jump| (jump / width).round() as i64).collect();
    jumps.values = counts.iter().map(|&count| Some(count as f64 * width)).collect();
    let (function, rounded) = solve(mesh, field, level_options, &jumps, &mut noted)?;
    let split = Split::new(mesh, &jumps)?;
    let critical = critical_points(&split.mesh, &split.values(&function.values, &rounded))?;
    let is_at_cut = |i: &u32| paths.iter().any(|path| path.contains(i));
    let critical = critical.into_iter().filter(|i| (*i as usize) < mesh.points().len() && !is_at_cut(i)).collect();
    let function = LevelFunction { critical, ..function };
    let cuts = paths.into_iter().zip(found).zip(&rounded);
    let cuts: Vec<Cut> = cuts.map(|((points, found), &jump)| Cut { points, found, jump }).collect();
    let period = counts.iter().fold(0, |a, &b| gcd(a, b.abs()));
    if period == 0 {
        let levels = match spacing {
            Spacing::Count(count) => Levels::Count(count),
            Spacing::Width(width) => Levels::Width(width),
        };
        let boundaries = level_boundaries(mesh, field, &function.values, &levels, options)?;
        let windings = vec![0; boundaries.boundaries.len()];
        return Ok(PeriodicBoundaries { function, cuts, boundaries, is_cyclic: false, windings });
    }
    let values = split.values(&function.values, &rounded);
    let rim = Rim::new(mesh, field)?;
    let (mut chain, mut levels, mut windings, mut dropped) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for Stitched { level, curve, winding } in stitched(&split, mesh, &values, width, &counts, period)? {
        let boundary = of_curve(curve, (level as f64 + 0.5) * width, rim.mean_edge());
        if boundary.points.len() < 3 || boundary.length() < options.least_length * width {
            let (point_count, length) = (boundary.points.len(), boundary.length());
            dropped.push(Dropped { level: boundary.level, point_count, length });
        } else {
            chain.push(boundary);
            levels.push(level);
            windings.push(winding);
        }
    }
    if chain.is_empty() {
        let reason = "expected levels with curves of some strip widths, found none";
        return Err(Error::new(Status::OutOfDomain, reason).at("spacing"));
    }
    // One curve for each level, or strips are not told.
    let is_single = chain.len() == period as usize && levels.windows(2).all(|pair| pair[0] < pair[1]);
    let count = chain.len();
    let boundaries = if is_single {
        let strips = (0..count).filter(|_| count > 1).map(|k| [k, (k + 1) % count]).collect();
        let boundaries = rim.complete(chain, true, options.extends, [false; 2]);
        Boundaries { boundaries, strips, dropped, ..Boundaries::default() }
    } else {
        levels.dedup();
        let unmatched = levels.into_iter().map(|level| (level as f64 + 0.5) * width).collect();
        Boundaries { boundaries: chain, dropped, unmatched, ..Boundaries::default() }
    };
    Ok(PeriodicBoundaries { function, cuts, boundaries, is_cyclic: is_single, windings })
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The distance between levels.
fn width(function: &LevelFunction, jumps: &[f64], spacing: Spacing, mean_edge: f64) -> Result<f64> {
    let range = function.values.iter().copied().fold(0.0, f64::max);
    let width = match spacing {
        Spacing::Width(width) => width,
        // A jump below an edge is none: it would have a level or none.
        Spacing::Count(count) => {
            let around = jumps.iter().map(|jump| jump.abs()).find(|jump| *jump > mean_edge).unwrap_or(range);
            around / count as f64
        }
    };
    let most = jumps.iter().fold(range, |most, jump| most.max(jump.abs()));
    if width > 0.0 && width.is_finite() && most / width <= MOST_LEVELS {
        return Ok(width);
    }
    let reason =
        format!("expected levels at a distance above 0, of which at most {MOST_LEVELS} fit, found {spacing:?}");
    Err(Error::new(Status::InvalidValue, reason).at("spacing"))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{SQRT_2, TAU};

    use glam::DVec3;

    use super::super::level_function::LevelWeights;
    use super::*;
    use crate::mesh::Grid;

    /// A whole catenoid between two heights, with one family of its asymptotic directions, which cross its meridians at 45°.
    fn tube(around: usize, rows: usize, height: f64) -> (TriangleMesh, Field) {
        let at = |k: usize| {
            let (u, v) = (
                height * (2.0 * (k / around) as f64 / (rows - 1) as f64 - 1.0),
                TAU * (k % around) as f64 / around as f64,
            );
            let radial = DVec3::new(v.cos(), v.sin(), 0.0);
            let along = (u.sinh() * radial + DVec3::Z) / u.cosh();
            (u.cosh() * radial + u * DVec3::Z, (along + DVec3::new(-v.sin(), v.cos(), 0.0)) / SQRT_2)
        };
        let (points, directions): (Vec<DVec3>, Vec<DVec3>) = (0..around * rows).map(at).unzip();
        let mesh = TriangleMesh::new(&Grid::new(points, rows, around, [false, true]).unwrap().mesh()).unwrap();
        let field = Field::new(&mesh, directions, vec![true; around * rows]).unwrap();
        (mesh, field)
    }

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn find(tube: &(TriangleMesh, Field), weights: LevelWeights, spacing: Spacing) -> PeriodicBoundaries {
        let options = LevelOptions { weights, ..Default::default() };
        periodic_boundaries(&tube.0, &tube.1, &options, spacing, &BoundaryOptions::default(), &mut on).unwrap()
    }

    #[test]
    fn the_jump_around_a_catenoid_is_that_of_the_best_function() {
        // In the coordinates u, v the metric is cosh²u (du² + dv²) and a = cosh u (du + dv)/√2. With p the slope of f around,
        // ∫ (p − cosh u/√2)² du dv is least for p = sinh 1/√2.
        let tube = tube(96, 41, 1.0);
        let found = find(&tube, LevelWeights::ORTHOGONAL, Spacing::Width(0.261));
        let expected = TAU * 1_f64.sinh() / SQRT_2;
        assert_eq!(found.cuts.len(), 1);
        assert!((found.cuts[0].found.abs() / expected - 1.0).abs() < 2e-3, "{} {expected}", found.cuts[0].found);
        assert!((found.cuts[0].jump.abs() - 20.0 * 0.261).abs() < 1e-12);
    }

    #[test]
    fn boundaries_around_a_catenoid_close_up_at_right_angles() {
        // The greatest angle is of first order: 1.4° with 96 points around.
        let tube = tube(192, 81, 1.0);
        let jump = find(&tube, LevelWeights::DIRECTION, Spacing::Count(20)).cuts[0].found.abs();
        // Rounding changes the jump by 2 %.
        for spacing in [Spacing::Count(20), Spacing::Width(jump / 20.4)] {
            let found = find(&tube, LevelWeights::DIRECTION, spacing);
            let boundaries = &found.boundaries.boundaries;
            assert!(found.is_cyclic && boundaries.len() == 20 && found.boundaries.strips.len() == 20);
            assert!(found.boundaries.dropped.is_empty() && found.boundaries.unmatched.is_empty());
            assert_eq!(found.boundaries.strips[19], [19, 0]);
            assert!(found.windings.iter().all(|w| w.abs() <= 1) && found.function.critical.is_empty());
            let rim = Rim::new(&tube.0, &tube.1).unwrap();
            let mut worst: f64 = 0.0;
            for (k, boundary) in boundaries.iter().enumerate() {
                assert!(!boundary.is_closed);
                // From rim to rim, without a gap at the cut; extensions beyond.
                let on: Vec<DVec3> = (0..boundary.points.len())
                    .filter(|&i| boundary.on_surface[i].is_some())
                    .map(|i| boundary.points[i])
                    .collect();
                let (low, high) = (on[0].z.min(on[on.len() - 1].z), on[0].z.max(on[on.len() - 1].z));
                assert!((low + 1.0).abs() < 1e-12 && (high - 1.0).abs() < 1e-12);
                assert!(on.windows(2).all(|pair| pair[0].distance(pair[1]) < 0.1));
                for sine in rim.crossings(boundary).into_iter().flatten() {
                    assert!(sine > 0.0);
                    worst = worst.max(sine.min(1.0).acos().to_degrees());
                }
                assert!(rim.is_ahead(&boundaries[(k + 1) % 20], boundary));
            }
            assert!(worst < 1.0, "{worst}° for {spacing:?}");
        }
    }

    #[test]
    fn levels_that_close_around_a_tube_need_no_jump() {
        let (mesh, _) = tube(48, 21, 1.0);
        let up = |p: &DVec3| {
            let radial = DVec3::new(p.x, p.y, 0.0).normalize();
            (p.z.sinh() * radial + DVec3::Z) / p.z.cosh()
        };
        let field = Field::new(&mesh, mesh.points().iter().map(up).collect(), vec![true; mesh.points().len()]).unwrap();
        let found = find(&(mesh, field), LevelWeights::ORTHOGONAL, Spacing::Count(6));
        let boundaries = &found.boundaries.boundaries;
        assert!(!found.is_cyclic && found.cuts[0].jump == 0.0 && found.cuts[0].found.abs() < 5e-3);
        // Six levels, and one beyond each rim.
        assert!(boundaries.len() == 8 && boundaries.iter().all(|boundary| boundary.is_closed));
        assert!(boundaries[0].points[0].z < -1.0 && boundaries[7].points[0].z > 1.0);
    }

    #[test]
    fn spacings_without_end_are_refused() {
        let tube = tube(24, 7, 0.5);
        let refused = |spacing| {
            let (weights, options) = (LevelOptions::default(), BoundaryOptions::default());
            periodic_boundaries(&tube.0, &tube.1, &weights, spacing, &options, &mut on).unwrap_err().place().to_owned()
        };
        assert_eq!(refused(Spacing::Width(0.0)), "spacing");
        assert_eq!(refused(Spacing::Width(1e-9)), "spacing");
        assert_eq!(refused(Spacing::Width(f64::NAN)), "spacing");
        assert_eq!(refused(Spacing::Count(0)), "spacing");
    }

    #[test]
    fn levels_of_a_slope_around_a_cylinder_are_spirals() {
        // f = (z + 0.1 v)/√1.01 rises by 0.2 π/√1.01 around; its levels fall by 0.2 π on the way, three times and more from z = 2 to 0.
        let around = 60;
        let at = |k: usize| {
            let (z, v) = (2.0 * (k / around) as f64 / 20.0, TAU * (k % around) as f64 / around as f64);
            let ahead = DVec3::new(-v.sin(), v.cos(), 0.0);
            (DVec3::new(v.cos(), v.sin(), z), (DVec3::Z + 0.1 * ahead).normalize())
        };
        let (points, directions): (Vec<DVec3>, Vec<DVec3>) = (0..around * 21).map(at).unzip();
        let mesh = TriangleMesh::new(&Grid::new(points, 21, around, [false, true]).unwrap().mesh()).unwrap();
        let field = Field::new(&mesh, directions, vec![true; around * 21]).unwrap();
        let found = find(&(mesh, field), LevelWeights::ORTHOGONAL, Spacing::Count(2));
        assert!((found.cuts[0].found.abs() - 0.2 * std::f64::consts::PI / 1.01_f64.sqrt()).abs() < 5e-3);
        assert!(found.is_cyclic && found.boundaries.boundaries.len() == 2);
        assert!(found.windings.iter().all(|w| (2..=4).contains(&w.abs())), "{:?}", found.windings);
        // Down a slope of 1 in 10 around a circle, and 2 in all.
        for boundary in &found.boundaries.boundaries {
            let on = boundary.on_surface.iter().flatten().count();
            let points: Vec<DVec3> = boundary
                .points
                .iter()
                .zip(&boundary.on_surface)
                .filter(|(_, at)| at.is_some())
                .map(|(p, _)| *p)
                .collect();
            let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            assert!(on > 100 && (length / (20.0 * 1.01_f64.sqrt()) - 1.0).abs() < 5e-3, "{length}");
        }
    }
}
