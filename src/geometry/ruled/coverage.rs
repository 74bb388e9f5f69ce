//! The nearest strip to a point of the reference surface.
//!
//! That strips are near to the surface keeps them from leaving it, but not from sliding together and shrinking to a point on it.
//! What keeps them is that every point of the surface is to be near to some strip.

use glam::{DMat3, DVec3};

use super::Strip;
use super::pull::{across, along};
use crate::mesh::ClosestPoints;
use crate::mesh::grid::diagonal;
use crate::mesh::reference::{nearest_from, snapped};

/// Columns of quads in each span, and rows, of the mesh in which the nearest strip is looked for.
const COLUMNS_PER_SPAN: usize = 4;
const ROWS: usize = 2;

/// A step that moves the nearest point by less than this part of the strips' diagonal is taken though the distance does not fall, as
/// then is round-off.
const STILL: f64 = 1e-7;

/// The nearest point of strips.
#[derive(Clone, Copy, Debug)]
pub(super) struct StripFoot {
    pub(super) strip: usize,
    pub(super) parameters: [f64; 2],
    pub(super) point: DVec3,
    /// The projection onto the directions in which the distance from the foot's surroundings grows: the normal's; beyond a
    /// boundary, those across it; beyond a corner, all.
    pub(super) directions: DMat3,
    /// The unit normal of the strip there; zero where it has none.
    normal: DVec3,
    /// Whether it is at an end of the strip beyond which the distance falls.
    is_at_end: bool,
}

impl StripFoot {
    /// How far the point asked for is beyond the strip, along its tangent plane; 0 where it is beside it.
    pub(super) fn overhang(&self, point: DVec3) -> f64 {
        if self.is_at_end { (point - self.point).reject_from_normalized(self.normal).length() } else { 0.0 }
    }
}

/// Strips ready to be asked for their nearest point.
pub(super) struct NearestStrip<'a> {
    strips: &'a [Strip],
    closest: ClosestPoints,
    /// The strip and the column of each pair of triangles' quad.
    quads: Vec<(u32, u32)>,
    still: f64,
}

impl<'a> NearestStrip<'a> {
    /// None if no mesh of them is finite.
    pub(super) fn new(strips: &'a [Strip]) -> Option<Self> {
        let (mut points, mut triangles, mut quads) = (Vec::new(), Vec::new(), Vec::new());
        for (k, strip) in strips.iter().enumerate() {
            let columns = COLUMNS_PER_SPAN * strip.basis().spans();
            let first = points.len() as u32;
            for column in 0..=columns {
                let [a, b] = strip.ruling(column as f64 / COLUMNS_PER_SPAN as f64);
                points.extend((0..=ROWS).map(|row| a.lerp(b, row as f64 / ROWS as f64)));
            }
            let width = ROWS as u32 + 1;
            for column in 0..columns as u32 {
                for row in 0..ROWS as u32 {
                    let a = first + column * width + row;
                    triangles.extend([[a, a + width, a + width + 1], [a, a + width + 1, a + 1]]);
                    quads.push((k as u32, column));
                }
            }
        }
        let closest = ClosestPoints::of_triangles(&points, &triangles).ok()?;
        Some(Self { strips, closest, quads, still: STILL * diagonal(&points) })
    }

    /// The nearest point. The strip is the one whose mesh is nearest; the point is found on it by Newton's method on half the
    /// squared distance from where the mesh is nearest, within the strip, as for any surface with two parameters.
    pub(super) fn nearest(&self, point: DVec3) -> StripFoot {
        let (near, piece) = self.closest.nearest_on_piece(point);
        self.found(point, near, piece)
    }

    /// The strips whose meshes come nearer to a point than `distance`, ascending, each with the piece of its mesh that is nearest.
    pub(super) fn within(&self, point: DVec3, distance: f64) -> Vec<(usize, usize)> {
        let mut found: Vec<(usize, usize, f64)> = Vec::new();
        for (piece, apart) in self.closest.within(point, distance) {
            let strip = self.quads[piece / 2].0 as usize;
            match found.last_mut().filter(|last| last.0 == strip) {
                Some(last) if last.2 <= apart => {}
                Some(last) => (last.1, last.2) = (piece, apart),
                None => found.push((strip, piece, apart)),
            }
        }
        found.into_iter().map(|(strip, piece, _)| (strip, piece)).collect()
    }

    /// The nearest point of the strip of a piece of its mesh, found from there.
    pub(super) fn nearest_on_piece(&self, point: DVec3, piece: usize) -> StripFoot {
        self.found(point, point, piece)
    }

    fn found(&self, point: DVec3, near: DVec3, piece: usize) -> StripFoot {
        let (strip_index, column) = self.quads[piece / 2];
        let strip = &self.strips[strip_index as usize];
        let start = inside(strip, seed(strip, f64::from(column) / COLUMNS_PER_SPAN as f64, near));
        let around = if strip.basis().is_closed() { f64::INFINITY } else { 0.0 };
        let ranges = [[-around, strip.length_u() + around], [0.0, 1.0]];
        let (parameters, jet, is_held) =
            nearest_from(point, start, ranges, self.still, |at| inside(strip, at), |at| strip.at(at[0], at[1]));
        let directions = match is_held {
            [false, false] => along(jet.normal()),
            [false, true] => across(jet.first[0].normalize_or_zero()),
            [true, false] => across(jet.first[1].normalize_or_zero()),
            [true, true] => DMat3::IDENTITY,
        };
        let (normal, is_at_end) = (jet.normal(), is_held != [false; 2]);
        StripFoot { strip: strip_index as usize, parameters, point: jet.point, directions, normal, is_at_end }
    }
}

/// Parameters near a point of the quad of a mesh that starts at `u`: on the ruling through its column's middle and where the
/// quad's sides say, which is near enough to go on from.
fn seed(strip: &Strip, u: f64, near: DVec3) -> [f64; 2] {
    let width = 1.0 / COLUMNS_PER_SPAN as f64;
    let part = |from: DVec3, to: DVec3| {
        let way = to - from;
        let part = (near - from).dot(way) / way.length_squared();
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 }
    };
    let [[a, b], [c, d]] = [strip.ruling(u), strip.ruling(u + width)];
    let v = part(0.5 * (a + c), 0.5 * (b + d));
    let along = part(a.lerp(b, v), c.lerp(d, v));
    let [a, b] = strip.ruling(u + along * width);
    [u + along * width, part(a, b)]
}

/// Around a closed strip; the nearer end otherwise.
fn inside(strip: &Strip, [u, v]: [f64; 2]) -> [f64; 2] {
    let length = strip.length_u();
    let u = if strip.basis().is_closed() { u.rem_euclid(length) } else { snapped(u, [0.0, length]) };
    [u, snapped(v, [0.0, 1.0])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::curve::CubicBasis;

    #[test]
    fn no_sample_of_any_strip_is_nearer() {
        let count = 7;
        let row = |y: f64, k: f64| -> Vec<DVec3> {
            let at = |i: usize| 2.0 * i as f64 / (count - 1) as f64 - 1.0;
            (0..count).map(|i| DVec3::new(at(i), y + 0.05 * (k * at(i)).sin(), at(i) * y)).collect()
        };
        let basis = CubicBasis::new(count, false).unwrap();
        let strip = |y: f64| Strip::new(basis.clone(), [row(y, 2.0), row(y + 0.5, 3.0)]).unwrap();
        let ring =
            |z: f64| (0..8).map(|i| 0.785 * f64::from(i)).map(|t| DVec3::new(3.0 + t.cos(), t.sin(), z)).collect();
        let tube = Strip::new(CubicBasis::new(8, true).unwrap(), [ring(-0.4), ring(0.5)]).unwrap();
        let strips = [strip(-0.5), strip(0.05), tube];
        let search = NearestStrip::new(&strips).unwrap();
        let samples: Vec<DVec3> = strips.iter().flat_map(|strip| strip.mesh(200, 60).unwrap().points).collect();
        let mut kinds = [0; 3];
        for i in 0..300 {
            let t = f64::from(i);
            let point = DVec3::new(1.5 + 2.6 * (2.3 * t).sin(), (1.7 * t).cos(), 0.7 * (0.9 * t).sin());
            let foot = search.nearest(point);
            let strip = &strips[foot.strip];
            assert!(strip.at(foot.parameters[0], foot.parameters[1]).point == foot.point);
            let nearest = samples.iter().map(|s| s.distance(point)).fold(f64::INFINITY, f64::min);
            // The mesh that tells strips apart is within 5e-3 of the tube.
            assert!(foot.point.distance(point) <= nearest + 6e-3, "{i}: {} {nearest}", foot.point.distance(point));
            // The way to the point is within the directions.
            let apart = point - foot.point;
            assert!((foot.directions * apart).distance(apart) < 1e-6 * (1.0 + apart.length()), "{i} {apart}");
            let trace = foot.directions.x_axis.x + foot.directions.y_axis.y + foot.directions.z_axis.z;
            kinds[trace.round() as usize - 1] += 1;
        }
        assert!(kinds.iter().all(|&count| count > 5), "{kinds:?}");
    }
}
