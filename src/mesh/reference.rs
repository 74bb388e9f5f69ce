//! Reference surfaces: what other shapes are to be near to, as a mesh or as a formula.

use std::fmt;

use glam::DVec3;

use super::{ClosestPoints, SurfacePoint, TriangleMesh, patterns};
use crate::error::{Error, Result, Status};

/// Steps of Newton's method at most: from a sample it takes 3 or 4.
const MOST_STEPS: usize = 50;

/// How often a step that leads nowhere nearer is halved.
const MOST_HALVINGS: usize = 30;

/// A point on the boundary of a mesh has a weight below this for a corner off the boundary.
const ON_EDGE: f64 = 1e-9;

/// Both ends of a range are one where they are within this part of the surface's size, at so many intervals along them.
const SEAM: f64 = 1e-9;
const SEAM_SAMPLES: usize = 16;

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceFoot {
    /// The point itself.
    pub point: DVec3,
    /// The unit normal there, continuous over the surface.
    pub normal: DVec3,
    /// How far the point asked for is beyond the boundary, measured along the surface's tangent plane, in model units; 0 if the
    /// nearest point is inside.
    pub overhang: f64,
}

/// A surface that can be asked for its nearest point.
pub trait ReferenceSurface: Sync {
    /// The nearest point to a finite point.
    fn nearest(&self, point: DVec3) -> SurfaceFoot;

    /// The diagonal of the box that holds it, in model units.
    fn diagonal(&self) -> f64;
}

/// A triangle mesh as a reference surface. Normals are blended from those of the points, so that they do not jump at edges.
#[derive(Clone, Debug)]
pub struct ReferenceMesh<'a> {
    mesh: &'a TriangleMesh,
    closest: ClosestPoints,
}

impl<'a> ReferenceMesh<'a> {
    /// Prepares the search.
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        // What a triangle mesh holds is never refused: it has triangles, and finite points that exist.
        let closest = ClosestPoints::of_triangles(mesh.points(), mesh.triangles());
        Self { mesh, closest: closest.unwrap_or_else(|error| unreachable!("{error}")) }
    }

    /// The mesh.
    pub fn mesh(&self) -> &'a TriangleMesh {
        self.mesh
    }

    /// Where on the mesh the nearest point is.
    pub fn locate(&self, point: DVec3) -> SurfacePoint {
        let (nearest, triangle) = self.closest.nearest_on_piece(point);
        self.mesh.surface_point(triangle, nearest)
    }

    /// Whether a point of the mesh is on its boundary.
    pub fn is_on_boundary(&self, at: SurfacePoint) -> bool {
        let (t, corners) = (at.triangle as usize, self.mesh.triangles()[at.triangle as usize]);
        // On edge k the corner after its end has no weight; at a corner two edges, or none of this triangle's, are the boundary.
        let is_on_edge = |k: usize| at.weights[(k + 2) % 3] <= ON_EDGE && self.mesh.across(t, k).is_none();
        let is_at_corner = |k: usize| at.weights[k] >= 1.0 - ON_EDGE && self.mesh.is_on_boundary(corners[k] as usize);
        (0..3).any(|k| is_on_edge(k) || is_at_corner(k))
    }
}

impl ReferenceSurface for ReferenceMesh<'_> {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let at = self.locate(point);
        let (foot, normal) = (self.mesh.position(at), self.mesh.normal_at(at));
        let is_on_boundary = self.is_on_boundary(at);
        let overhang = if is_on_boundary { (point - foot).reject_from_normalized(normal).length() } else { 0.0 };
        SurfaceFoot { point: foot, normal, overhang }
    }

    fn diagonal(&self) -> f64 {
        self.mesh.diagonal()
    }
}

/// What a surface given by two parameters does at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    /// Its point.
    pub point: DVec3,
    /// The first derivatives of the point by each parameter.
    pub first: [DVec3; 2],
    /// The second derivatives: twice by the first parameter, by both, twice by the second.
    pub second: [DVec3; 3],
}

impl SurfaceJet {
    /// The unit normal; zero where the parameters are no coordinates.
    pub fn normal(&self) -> DVec3 {
        self.first[0].cross(self.first[1]).normalize_or_zero()
    }
}

/// A surface given as a function of two parameters over a rectangle, with derivatives. A rectangle that closes around, as of a
/// whole cylinder, has a seam like a boundary: what is nearest across it is found by its other side.
pub struct ParametricSurface<F> {
    ranges: [[f64; 2]; 2],
    function: F,
    samples: ClosestPoints,
    triangles: Vec<[u32; 3]>,
    parameters: Vec<[f64; 2]>,
    points: Vec<DVec3>,
    diagonal: f64,
}

impl<F: Fn(f64, f64) -> SurfaceJet + Sync> ParametricSurface<F> {
    /// The surface of `function` over the parameters from `ranges[k][0]` to `ranges[k][1]`. Each search for a nearest point starts
    /// from a mesh of `samples[k]` points in each direction: they must be close enough to tell its parts from each other.
    ///
    /// # Errors
    /// Fewer than 2 samples (`columns`, `rows`), a range that is not finite or empty (`u`, `v`), a sample that is not finite
    /// (`points[i]`), or samples that are all one (`function`).
    pub fn new(ranges: [[f64; 2]; 2], samples: [usize; 2], function: F) -> Result<Self> {
        let [columns, rows] = samples;
        let mesh = patterns::parametric_surface(columns, rows, ranges[0], ranges[1], |u, v| function(u, v).point)?;
        let at = |k: usize, i: usize| ranges[k][0] + (ranges[k][1] - ranges[k][0]) * i as f64 / (samples[k] - 1) as f64;
        let parameters = (0..columns * rows).map(|i| [at(0, i % columns), at(1, i / columns)]).collect();
        let halves = |face: &Vec<u32>| [[face[0], face[1], face[2]], [face[0], face[2], face[3]]];
        let triangles: Vec<[u32; 3]> = mesh.faces.iter().flat_map(halves).collect();
        let samples = ClosestPoints::of_triangles(&mesh.points, &triangles)?;
        let diagonal = mesh.diagonal();
        if !diagonal.is_finite() || diagonal <= 0.0 {
            let reason = format!("expected a surface of finite size above 0, found {diagonal}");
            return Err(Error::new(Status::InvalidValue, reason).at("function"));
        }
        Ok(Self { ranges, function, samples, triangles, parameters, points: mesh.points, diagonal })
    }

    /// The surface at two parameters.
    pub fn at(&self, u: f64, v: f64) -> SurfaceJet {
        (self.function)(u, v)
    }

    /// The parameters that it is over, from the first to the second of each.
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        self.ranges
    }

    /// Whether it goes around in each direction: both ends of the range are one curve, with the same derivatives.
    pub fn goes_around(&self) -> [bool; 2] {
        [0, 1].map(|k| {
            let [low, high] = self.ranges[k];
            let other = self.ranges[1 - k];
            let at = |end: f64, part: f64| {
                let along = other[0] + part * (other[1] - other[0]);
                if k == 0 { self.at(end, along) } else { self.at(along, end) }
            };
            (0..=SEAM_SAMPLES).all(|i| {
                let part = i as f64 / SEAM_SAMPLES as f64;
                let (a, b) = (at(low, part), at(high, part));
                let is_near = |a: DVec3, b: DVec3, size: f64| a.distance(b) <= SEAM * size;
                is_near(a.point, b.point, self.diagonal)
                    && (0..2).all(|l| is_near(a.first[l], b.first[l], a.first[l].length().max(b.first[l].length())))
            })
        })
    }

    /// A mesh of it, as [`patterns::parametric_surface`] lays it out.
    ///
    /// # Errors
    /// Fewer than 2 columns or rows.
    pub fn mesh(&self, columns: usize, rows: usize) -> Result<super::Mesh> {
        patterns::parametric_surface(columns, rows, self.ranges[0], self.ranges[1], |u, v| self.at(u, v).point)
    }

    /// The parameters at the point of the sampled triangles that is nearest.
    fn seed(&self, point: DVec3) -> [f64; 2] {
        let (nearest, piece) = self.samples.nearest_on_piece(point);
        let corners = self.triangles[piece];
        let [a, b, c] = corners.map(|i| self.points[i as usize]);
        let normal = (b - a).cross(c - a);
        let part = |from: DVec3, to: DVec3| normal.dot((to - from).cross(nearest - from)).max(0.0);
        let parts = [part(b, c), part(c, a), part(a, b)];
        let sum: f64 = parts.iter().sum();
        let weights = if sum > 0.0 { parts.map(|part| part / sum) } else { [1.0, 0.0, 0.0] };
        [0, 1].map(|axis| (0..3).map(|k| weights[k] * self.parameters[corners[k] as usize][axis]).sum())
    }

    fn clamped(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| snapped(at[k], self.ranges[k]))
    }

    /// The parameters of the nearest point to a finite point ([`nearest_from`]).
    pub fn nearest_parameters(&self, point: DVec3) -> [f64; 2] {
        self.foot(point).0
    }

    fn foot(&self, point: DVec3) -> ([f64; 2], SurfaceJet, [bool; 2]) {
        let start = self.clamped(self.seed(point));
        let (ranges, still) = (self.ranges, 1e-7 * self.diagonal);
        nearest_from(point, start, ranges, still, |at| self.clamped(at), |at| self.at(at[0], at[1]))
    }
}

/// The parameters of the point of a surface that is nearest to a finite point, the surface there, and whether each parameter is at
/// an end of its range beyond which the distance falls: by Newton's method on half the squared distance, from `at` on, within
/// `ranges`. `inside` puts parameters up to round-off into them; a step that moves the point by less than `still`, in model units, is
/// taken though the distance does not fall.
///
/// With `d = S − p` the gradient is `(d·S_u, d·S_v)`, and the second derivatives are `S_u·S_u + d·S_uu` and so on. Where they
/// are not positive definite the terms of `d` are left out, which leads downhill. A parameter at an end of its range that the
/// gradient pushes outward stays there, and a step that would leave the rectangle ends where it meets its side: to take the
/// nearest point of the rectangle instead could lead uphill.
pub(crate) fn nearest_from(
    point: DVec3,
    mut at: [f64; 2],
    ranges: [[f64; 2]; 2],
    still: f64,
    inside: impl Fn([f64; 2]) -> [f64; 2],
    surface: impl Fn([f64; 2]) -> SurfaceJet,
) -> ([f64; 2], SurfaceJet, [bool; 2]) {
    let mut jet = surface(at);
    let held = |at: [f64; 2], jet: &SurfaceJet| {
        let slope = jet.first.map(|first| (jet.point - point).dot(first));
        [0, 1].map(|k| (at[k] <= ranges[k][0] && slope[k] >= 0.0) || (at[k] >= ranges[k][1] && slope[k] <= 0.0))
    };
    for _ in 0..MOST_STEPS {
        let apart = jet.point - point;
        let slope = jet.first.map(|first| apart.dot(first));
        let step = step_within(at, ranges, held(at, &jet), |is_held| newton_step(&jet, apart, slope, is_held));
        let is_small = |k: usize| step[k].abs() <= 4.0 * f64::EPSILON * (1.0 + at[k].abs());
        if is_small(0) && is_small(1) {
            break;
        }
        let mut factor = 1.0;
        let found = (0..MOST_HALVINGS).find_map(|_| {
            let trial = inside([at[0] + factor * step[0], at[1] + factor * step[1]]);
            factor *= 0.5;
            let jet = surface(trial);
            (jet.point.distance_squared(point) < apart.length_squared()).then_some((trial, jet))
        });
        match found {
            Some(next) => (at, jet) = next,
            None => {
                // Distances no longer tell points apart: the whole step is right if it is small.
                let trial = inside([at[0] + step[0], at[1] + step[1]]);
                let there = surface(trial);
                if there.point.distance(jet.point) < still {
                    (at, jet) = (trial, there);
                }
                break;
            }
        }
    }
    let slope = jet.first.map(|first| (jet.point - point).dot(first));
    let is_beyond = |k: usize| (at[k] <= ranges[k][0] && slope[k] > 0.0) || (at[k] >= ranges[k][1] && slope[k] < 0.0);
    (at, jet, [0, 1].map(is_beyond))
}

/// The parameter within a range, at an end that it is within round-off of: what is to be at the end is there to the last bit.
pub(crate) fn snapped(at: f64, [low, high]: [f64; 2]) -> f64 {
    let round_off = 4.0 * f64::EPSILON * (high - low).max(low.abs()).max(high.abs());
    if at - low <= round_off {
        low
    } else if high - at <= round_off {
        high
    } else {
        at
    }
}

/// The step that `step` gives for the parameters that are not held, shortened to where it leaves the ranges. Where it would leave them
/// from where it is, though downhill is inward, each parameter takes the step that it takes alone.
fn step_within(
    at: [f64; 2],
    ranges: [[f64; 2]; 2],
    is_held: [bool; 2],
    step: impl Fn([bool; 2]) -> [f64; 2],
) -> [f64; 2] {
    let mut found = step(is_held);
    let leaves = |k: usize| (at[k] <= ranges[k][0] && found[k] < 0.0) || (at[k] >= ranges[k][1] && found[k] > 0.0);
    if leaves(0) || leaves(1) {
        found = [step([is_held[0], true])[0], step([true, is_held[1]])[1]];
    }
    let room = |k: usize| match found[k] {
        step if step > 0.0 => (ranges[k][1] - at[k]) / step,
        step if step < 0.0 => (ranges[k][0] - at[k]) / step,
        _ => f64::INFINITY,
    };
    let part = room(0).min(room(1)).min(1.0);
    found.map(|step| part * step)
}

fn newton_step(jet: &SurfaceJet, apart: DVec3, slope: [f64; 2], is_held: [bool; 2]) -> [f64; 2] {
    let [u, v] = jet.first;
    let metric = [u.dot(u), u.dot(v), v.dot(v)];
    let full = [0, 1, 2].map(|k| metric[k] + apart.dot(jet.second[k]));
    match is_held {
        [true, true] => [0.0, 0.0],
        [true, false] => [0.0, -slope[1] / if full[2] > 0.0 { full[2] } else { metric[2] }],
        [false, true] => [-slope[0] / if full[0] > 0.0 { full[0] } else { metric[0] }, 0.0],
        [false, false] => {
            let determinant = |h: [f64; 3]| h[0] * h[2] - h[1] * h[1];
            let h = if full[0] > 0.0 && determinant(full) > 0.0 { full } else { metric };
            let solve = |a: f64, b: f64, c: f64, d: f64| -(a * b - c * d) / determinant(h);
            [solve(slope[0], h[2], slope[1], h[1]), solve(slope[1], h[0], slope[0], h[1])]
        }
    }
    .map(|step| if step.is_finite() { step } else { 0.0 })
}

impl<F: Fn(f64, f64) -> SurfaceJet + Sync> ReferenceSurface for ParametricSurface<F> {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let (at, jet, _) = self.foot(point);
        let normal = jet.normal();
        let is_at_end = (0..2).any(|k| self.ranges[k].contains(&at[k]));
        let overhang = if is_at_end { (point - jet.point).reject_from_normalized(normal).length() } else { 0.0 };
        SurfaceFoot { point: jet.point, normal, overhang }
    }

    fn diagonal(&self) -> f64 {
        self.diagonal
    }
}

impl<F> fmt::Debug for ParametricSurface<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ParametricSurface").field("ranges", &self.ranges).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn saddle() -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
        let jet = |x: f64, y: f64| SurfaceJet {
            point: DVec3::new(x, y, x * y),
            first: [DVec3::new(1.0, 0.0, y), DVec3::new(0.0, 1.0, x)],
            second: [DVec3::ZERO, DVec3::Z, DVec3::ZERO],
        };
        ParametricSurface::new([[-1.0, 1.0], [-1.0, 1.0]], [33, 33], jet).unwrap()
    }

    #[test]
    fn a_point_above_the_saddle_comes_back_to_its_foot() {
        // Curvature radii of z = xy are at least 1 at its middle: half of that along the normal is still nearest.
        let saddle = saddle();
        for (x, y, height) in [(0.3, -0.4, 0.4), (0.0, 0.0, -0.5), (0.9, 0.8, 0.1), (-0.71, 0.2, 0.3)] {
            let jet = saddle.at(x, y);
            let foot = saddle.nearest(jet.point + height * jet.normal());
            assert!(foot.point.distance(jet.point) < 1e-14, "{x} {y}: {}", foot.point.distance(jet.point));
            assert!(foot.normal.distance(jet.normal()) < 1e-13 && foot.overhang == 0.0);
        }
    }

    #[test]
    fn what_closes_goes_around() {
        use crate::mesh::surfaces::{cylinder, torus};
        let pi = std::f64::consts::PI;
        let around = [-pi, pi];
        let torus = ParametricSurface::new([around; 2], [9, 9], torus(2.0, 0.7)).unwrap();
        assert_eq!((torus.goes_around(), torus.ranges()), ([true, true], [around; 2]));
        let tube = |range| ParametricSurface::new([range, [0.0, 1.0]], [9, 3], cylinder(2.0)).unwrap().goes_around();
        assert_eq!((tube([0.0, 2.0 * pi]), tube([0.0, 1.9 * pi])), ([true, false], [false, false]));
        assert_eq!(saddle().goes_around(), [false, false]);
    }

    #[test]
    fn no_sample_is_nearer() {
        let saddle = saddle();
        for i in 0..200 {
            let t = f64::from(i);
            let point = DVec3::new((2.3 * t).sin(), (1.7 * t).cos(), (0.9 * t).sin()) * 1.4;
            let foot = saddle.nearest(point);
            let at = |k: usize, i: usize| saddle.ranges[k][0] + 2.0 * i as f64 / 300.0;
            let samples = (0..301 * 301).map(|i| saddle.at(at(0, i % 301), at(1, i / 301)).point.distance(point));
            assert!(foot.point.distance(point) <= samples.fold(f64::INFINITY, f64::min) + 1e-12);
        }
    }

    #[test]
    fn what_is_beyond_the_boundary_says_how_far() {
        let flat = SurfaceJet { point: DVec3::ZERO, first: [DVec3::X, DVec3::Y], second: [DVec3::ZERO; 3] };
        let plane = move |u: f64, v: f64| SurfaceJet { point: DVec3::new(u, v, 0.0), ..flat };
        let square = ParametricSurface::new([[0.0, 1.0], [0.0, 1.0]], [2, 2], plane).unwrap();
        let mesh = TriangleMesh::new(&square.mesh(4, 5).unwrap()).unwrap();
        let mesh = ReferenceMesh::new(&mesh);
        for surface in [&square as &dyn ReferenceSurface, &mesh] {
            let beside = surface.nearest(DVec3::new(1.3, 0.4, 0.7));
            assert!((beside.overhang - 0.3).abs() < 1e-14 && beside.point.distance(DVec3::new(1.0, 0.4, 0.0)) < 1e-14);
            let corner = surface.nearest(DVec3::new(-0.3, 1.4, 0.1));
            assert!((corner.overhang - 0.5).abs() < 1e-14 && corner.point.distance(DVec3::Y) < 1e-14);
            let above = surface.nearest(DVec3::new(1.0, 0.4, 0.7));
            assert!(above.overhang < 1e-14 && above.normal.distance(DVec3::Z) < 1e-15);
            assert_eq!(surface.nearest(DVec3::new(0.5, 0.4, 0.7)).overhang, 0.0);
            assert!((surface.diagonal() - 2.0_f64.sqrt()).abs() < 1e-15);
        }
    }

    #[test]
    fn a_mesh_is_as_near_as_its_chords_and_its_normals_are_continuous() {
        let saddle = saddle();
        let mesh = TriangleMesh::new(&saddle.mesh(41, 41).unwrap()).unwrap();
        let reference = ReferenceMesh::new(&mesh);
        let mut last: Option<DVec3> = None;
        for i in 0..=1000 {
            let t = f64::from(i) / 1000.0;
            let exact = saddle.at(0.8 * t - 0.3, 0.9 - 1.3 * t);
            let foot = reference.nearest(exact.point);
            // Twist 1 over half an edge of 0.05 in both directions, and a normal to first order.
            assert!(foot.point.distance(exact.point) < 0.05 * 0.05 / 4.0 + 1e-12);
            assert!(foot.normal.distance(exact.normal()) < 0.02);
            if let Some(last) = last {
                assert!(foot.normal.distance(last) < 0.005, "at {i} a jump of {}", foot.normal.distance(last));
            }
            last = Some(foot.normal);
        }
    }

    #[test]
    fn bad_surfaces_are_refused() {
        let jet = |u: f64, v: f64| SurfaceJet {
            point: DVec3::new(u, v, 1.0 / u),
            first: [DVec3::X, DVec3::Y],
            second: [DVec3::ZERO; 3],
        };
        assert_eq!(ParametricSurface::new([[0.0, 1.0], [0.0, 1.0]], [5, 5], jet).unwrap_err().place(), "points[0]");
        assert_eq!(ParametricSurface::new([[1.0, 2.0], [1.0, 0.0]], [5, 5], jet).unwrap_err().place(), "v");
    }
}
