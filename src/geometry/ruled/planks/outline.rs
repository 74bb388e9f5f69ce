//! The outline of one plank.

use glam::{DVec2, DVec3};

use super::Plank;
use crate::geometry::ruled::Strip;
use crate::mesh::curve::Curve;

/// The greatest angle between a cut and a square one, in radians (75 degrees).
const SLANTED: f64 = 75.0 * std::f64::consts::PI / 180.0;

/// A cut is along the boundary if this part of a plank's length is in the slab; of a shorter piece the direction is rounding.
const NO_CHORD: f64 = 1e-9;

/// The plank between two heights, with the strip's rulings between two parameters.
pub(super) fn outline(
    strip: &Strip,
    axis: DVec3,
    heights: [f64; 2],
    filled: f64,
    parameters: [f64; 2],
    depth: f64,
) -> Plank {
    let middle = 0.5 * (parameters[0] + parameters[1]);
    let direction = |u: f64| {
        let [a, b] = strip.ruling(u);
        (b - a).reject_from_normalized(axis).normalize_or_zero()
    };
    // Where rulings turn by half a circle within the slab, or have no length, any board is as good.
    let sum = direction(parameters[0]) + direction(middle) + direction(parameters[1]);
    let along = sum.try_normalize().or(direction(middle).try_normalize()).unwrap_or(axis.any_orthonormal_vector());
    let across = axis.cross(along);
    let center = strip.at(middle, 0.5).point;
    let origin = center + (heights[0] - center.dot(axis)) * axis;
    let flat = |point: DVec3| DVec2::new((point - origin).dot(along), (point - origin).dot(across));
    let in_space = |direction: DVec2| direction.x * along + direction.y * across;
    // How far all rulings reach along a flat direction: their ends do, as rulings are straight.
    let reach = |towards: DVec2| {
        let ends = (0..2)
            .flat_map(|side| extremes(strip, side, in_space(towards), parameters).into_iter().map(move |u| (side, u)));
        ends.map(|(side, u)| flat(strip.boundary(side).point(u)).dot(towards)).fold(f64::NEG_INFINITY, f64::max)
    };
    let sides = [-reach(-DVec2::Y) - depth, reach(DVec2::Y) + depth];
    let rulings = parameters.map(|u| strip.ruling(u).map(&flat));
    let chords = [0, 1].map(|side: usize| rulings[1][side] - rulings[0][side]);
    let length = rulings.iter().map(|[a, b]| a.distance(*b)).fold(0.0, f64::max);
    let slanted = chords.map(|chord| {
        let chord = if chord.y < 0.0 { -chord } else { chord };
        let angle = chord.x.atan2(chord.y);
        if chord.length() > NO_CHORD * length && angle.abs() <= SLANTED { angle } else { 0.0 }
    });
    // The corners with these angles of the cuts.
    let corners = |angles: [f64; 2]| {
        let ends = [0, 1].map(|end| {
            let outward = DVec2::new(angles[end].cos(), -angles[end].sin()) * [-1.0, 1.0][end];
            let reach = reach(outward);
            sides.map(|y| DVec2::new((reach - outward.y * y) / outward.x, y))
        });
        [ends[0][0], ends[1][0], ends[1][1], ends[0][1]]
    };
    // Of a plank that is wider than long slanted cuts can cross.
    let is_quad = |[a, b, c, d]: [DVec2; 4]| b.x > a.x && c.x > d.x;
    let with = |angles| Some((angles, corners(angles)));
    let (angles, corners) =
        with(slanted).filter(|(_, found)| is_quad(*found)).unwrap_or_else(|| ([0.0; 2], corners([0.0; 2])));
    let reach = |x: f64| corners.iter().map(|corner| corner.x * x).fold(f64::NEG_INFINITY, f64::max);
    let (length, width) = (reach(1.0) + reach(-1.0), sides[1] - sides[0]);
    let [a, b, c, d] = corners;
    let area = 0.5 * ((c - a).perp_dot(d - b));
    let stock = length * width;
    Plank {
        heights,
        filled,
        parameters,
        origin: origin.to_array(),
        along: along.to_array(),
        across: across.to_array(),
        outline: corners.map(|corner| corner.to_array()),
        length,
        width,
        end_angles_deg: angles.map(f64::to_degrees),
        offcut: if stock > 0.0 { (1.0 - area / stock).clamp(0.0, 1.0) } else { 0.0 },
        rulings: rulings.map(|ends| ends.map(|end| end.to_array())),
    }
}

/// The quadratic `a t² + b t + c` with these values at 0, 1/2 and 1, as `(a, b, c)`.
pub(super) fn quadratic([start, middle, end]: [f64; 3]) -> (f64, f64, f64) {
    (2.0 * (start - 2.0 * middle + end), 4.0 * middle - 3.0 * start - end, start)
}

/// The ends of a range of parameters and those within at which a boundary of the strip reaches farthest one way or the other along
/// a direction: in each span the derivative is quadratic.
fn extremes(strip: &Strip, side: usize, direction: DVec3, [low, high]: [f64; 2]) -> Vec<f64> {
    let slope = |u: f64| strip.boundary(side).at(u).first.dot(direction);
    let mut found = vec![low, high];
    let mut start = low;
    while start < high {
        let end = (start.floor() + 1.0).min(high);
        let (a, b, c) = quadratic([start, 0.5 * (start + end), end].map(slope));
        // Stable roots: the one of greater size, and the other by their product c/a.
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        let q = -0.5 * (b + root.copysign(b));
        let inside = [q / a, c / q].into_iter().filter(|t| (0.0..=1.0).contains(t));
        found.extend(inside.map(|t| start + t * (end - start)));
        start = end;
    }
    found
}
