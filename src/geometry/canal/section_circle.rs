//! The circle under a C-canal surface's cross-section: that of the canal surface's first row.
//!
//! Its polyline must have edges in the directions of the section's, at the angles `δ_j`. A chord from the angle
//! `φ_j` to `φ_{j+1}` of a circle is at a right angle to their mean: `φ_j + φ_{j+1} = 2 δ_j − π`, so `φ_j = β_j + (−1)^j φ_0` with known
//! `β_j`: one number is free. We take the one of the least sum of squared second differences of `φ`, whose second differences are
//! `β''_j − 4 (−1)^j φ_0`, as far as no edge is reversed. The radius makes its end chord as long as the section's. Where the
//! section is on a circle already, that circle is taken.

use glam::{DVec2, DVec3};

use crate::error::{Error, Result, Status};
use crate::geometry::circle::Circle;
use crate::mesh::fit::Plane;
use crate::mesh::grid::diagonal;

/// How far the section's points may be from their plane, or from a circle that counts as theirs, over the extent.
const NOT_PLANAR: f64 = 1e-9;

/// Turns of the section below this angle leave the circle without a point between two edges.
const PARALLEL_EDGES: f64 = 1e-9;

/// Part of the range of the free angle that is kept away from where an edge of the circle's polyline has no length.
const MARGIN: f64 = 0.1;

/// The circle's normal, or its opposite, about which the samples run counterclockwise.
pub(super) fn turned_along(circle: &Circle, samples: &[DVec3]) -> DVec3 {
    let turn = (samples[1] - samples[0]).cross(samples[2] - samples[1]).dot(circle.normal);
    if turn < 0.0 { -circle.normal } else { circle.normal }
}

/// The circle of the module's documentation, and its points.
pub(super) fn first_circle(section: &[DVec3]) -> Result<(Circle, Vec<DVec3>)> {
    let extent = diagonal(section);
    let plane = Plane::fitting(section);
    if let Some(j) = section.iter().position(|&point| plane.height(point).abs() > NOT_PLANAR * extent) {
        let height = plane.height(section[j]);
        let reason = format!("expected a planar section, found a point {height:e} from its plane");
        return Err(Error::new(Status::NotPlanar, reason).at(format!("section[{j}]")));
    }
    let last = section.len() - 1;
    if let Some(own) = Circle::through(section[0], section[last / 2], section[last])
        && section.iter().all(|&point| own.distance(point) <= NOT_PLANAR * extent)
    {
        check_turns(&flat_edges(section, own.normal, own.normal.any_orthonormal_vector()))?;
        return Ok((own, section.to_vec()));
    }
    let x = plane.normal.any_orthonormal_vector();
    // Seen so that it turns to the left.
    let edges = flat_edges(section, plane.normal, x);
    let turning: f64 = edges.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum();
    let normal = if turning < 0.0 { -plane.normal } else { plane.normal };
    let y = normal.cross(x);
    let edges = flat_edges(section, normal, x);
    check_turns(&edges)?;
    let angles = angles(&edges)?;
    let half = 0.5 * (angles[last] - angles[0]);
    let radius = section[0].distance(section[last]) / (2.0 * half.sin().abs());
    if !(radius < 1e6 * extent) {
        let reason = "the section's ends are so near that the circle would be closed";
        return Err(Error::new(Status::Degenerate, reason).at(format!("section[{last}]")));
    }
    let at = |angle: f64| radius * (angle.cos() * x + angle.sin() * y);
    let center = section[0] - at(angles[0]);
    let samples = angles.iter().map(|&angle| center + at(angle)).collect();
    Ok((Circle { center, normal, radius }, samples))
}

fn flat_edges(section: &[DVec3], normal: DVec3, x: DVec3) -> Vec<DVec2> {
    let y = normal.cross(x);
    section.windows(2).map(|ends| ends[1] - ends[0]).map(|edge| DVec2::new(edge.dot(x), edge.dot(y))).collect()
}

/// Refuses edges that are parallel to the ones before, or turn the other way.
fn check_turns(edges: &[DVec2]) -> Result<()> {
    let turning: f64 = edges.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum();
    for j in 1..edges.len() {
        let turn = turning.signum() * edges[j - 1].angle_to(edges[j]);
        if turn.abs() < PARALLEL_EDGES {
            let reason = "its edges are parallel: no circle has a point between them";
            return Err(Error::new(Status::Degenerate, reason).at(format!("section[{j}]")));
        }
        if turn < 0.0 {
            let reason = "the section is not convex: it turns the other way here";
            return Err(Error::new(Status::InvalidValue, reason).at(format!("section[{j}]")));
        }
    }
    Ok(())
}

/// The angles `φ_j` of the circle's points for edges that turn to the left.
fn angles(edges: &[DVec2]) -> Result<Vec<f64>> {
    let mut base = vec![0.0];
    let mut direction = edges[0].to_angle();
    for (j, edge) in edges.iter().enumerate() {
        if j > 0 {
            direction += edges[j - 1].angle_to(*edge);
        }
        base.push(2.0 * direction - std::f64::consts::PI - base[j]);
    }
    let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    let count = base.len();
    let sum: f64 = (1..count - 1).map(|j| sign(j) * (base[j - 1] - 2.0 * base[j] + base[j + 1])).sum();
    let best = sum / (4.0 * (count - 2) as f64);
    // Edge j spans base[j + 1] − base[j] − 2 (−1)^j φ₀, which must be above 0.
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut low_at, mut high_at) = (0, 0);
    for j in 0..count - 1 {
        let bound = 0.5 * sign(j) * (base[j + 1] - base[j]);
        if sign(j) > 0.0 && bound < high {
            (high, high_at) = (bound, j);
        }
        if sign(j) < 0.0 && bound > low {
            (low, low_at) = (bound, j);
        }
    }
    if !(low < high) {
        let reason = "the section is not convex enough: its turns alternate so much that a circle's polyline with these directions \
                      has a reversed edge here; spread its points more evenly";
        return Err(Error::new(Status::InvalidValue, reason).at(format!("section[{}]", low_at.max(high_at))));
    }
    let margin = MARGIN * (high - low);
    let first = best.clamp(low + margin, high - margin);
    Ok(base.iter().enumerate().map(|(j, base)| base + sign(j) * first).collect())
}
