//! Spheres that touch two curves: the first in given points with given normals, the second wherever it is nearest.
//!
//! A canal surface is the envelope of a family of spheres. Where one curve is to be a line of curvature, the center `C` of a
//! sphere is on a known line: the normal of the surface at a point of the curve. The sphere touches the second curve too where
//! the center is as far from both (section 4.1, equation 6).
//!
//! On the line `O + c m`, `m` a unit vector, whose points are as far from a guide point `V` as `√(c² + b²)` (`O` is nearest to `V`,
//! at the distance `b`), sought is the root of `h(c) = c² + b² − min |C − q|²` over all points `q` of the second curve. With
//! `w = q − O` that is the largest of the linear functions `2 c m·w + b² − w²`, so `h` is convex, and its derivative is `2 m·w`
//! of the nearest point (that this point moves with `c` does not matter). Newton's step solves the linear function of the
//! nearest point:
//!
//! `c ← (w² − b²) / (2 m·w)`
//!
//! At `c = 0` the function is below 0 unless the second curve comes nearer to `O` than the guide. A step then leads beyond
//! the root or onto it, and, as for any convex function, all further ones come back to it from there. The paper starts with
//! `C = P`, where its own functional (not squared) has no derivative; here that is no exception.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::geometry::circle::{Circle, PARALLEL, Sphere};
use crate::mesh::curve::{Foot, NearestOnCurve};
use crate::mesh::grid::{check_finite, diagonal};

/// Steps of the center at most; it takes three to five.
const MOST_STEPS: usize = 50;

/// A center has settled when it moves by less than this multiple of the curves' extent (or of its own distance).
const SETTLED: f64 = 1e-12;

/// Cosine of the angle between the normal and the direction to the second curve below which the sphere is a plane.
const PLANE: f64 = 1e-9;

/// The curves meet where they are nearer than this multiple of their extent.
const MEETING: f64 = 1e-9;

/// A sphere is not tangent to the second curve where the cosine of the angle between the two is above this.
const TANGENT: f64 = 1e-9;

/// A step of the second curve's parameter is a jump above this multiple of the median step.
const JUMP: f64 = 3.0;

/// A sphere that touches the second curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touching {
    /// The sphere; it passes through its guide points to rounding.
    pub sphere: Sphere,
    /// How far the center is along the normal, below 0 on the other side; in scheme B from the middle of the edge, nearly.
    pub offset: f64,
    /// Where it touches the second curve.
    pub foot: Foot,
    /// The steps that it took.
    pub step_count: usize,
}

/// What was found about a family of spheres; each list holds indices of spheres, ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// The nearest point is an end of the second curve: the sphere passes through it but is not tangent to the curve.
    pub ends: Vec<usize>,
    /// The point of touch is farther from the one before, in the parameter, than three times the median: another branch.
    pub jumps: Vec<usize>,
    /// The center is on the other side of the first curve than the one before.
    pub sign_changes: Vec<usize>,
    /// Another branch of the second curve is nearer to the center, and so inside the sphere.
    pub pierced: Vec<usize>,
}

/// The spheres that touch two curves.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingSpheres {
    /// One for each point or edge of the first curve, in their order.
    pub touching: Vec<Touching>,
    /// What is not as it should be.
    pub findings: Findings,
    /// The functional of equation 6: the sum of the squared differences of radius and distance to the second curve, over the
    /// whole of it.
    pub residual: f64,
}

impl TouchingSpheres {
    /// The spheres.
    pub fn spheres(&self) -> Vec<Sphere> {
        self.touching.iter().map(|touching| touching.sphere).collect()
    }
}

/// The line of a center: `origin`, the unit vector `direction`, the distance of `origin` from the guide point, and that point.
pub(super) struct CenterLine {
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    pub(super) half_chord: f64,
    pub(super) point: DVec3,
}

impl CenterLine {
    /// The sphere about the point of the line at `offset`, through the guide point.
    pub(super) fn sphere(&self, offset: f64) -> Sphere {
        let center = self.origin + offset * self.direction;
        Sphere { center, radius: center.distance(self.point) }
    }

    /// The sphere that touches `curve`, from where the neighbour's offset and foot are, or from scratch.
    pub(super) fn touch(
        &self,
        curve: &NearestOnCurve<'_>,
        neighbour: Option<&Touching>,
        extent: f64,
    ) -> Result<Touching> {
        let mut offset = neighbour.map_or(0.0, |touching| touching.offset);
        let center = |offset: f64| self.origin + offset * self.direction;
        let mut foot = match neighbour {
            None => curve.nearest(self.origin),
            Some(touching) => curve.nearest_from(center(offset), touching.foot.parameter),
        };
        let mut change = 0.0;
        for step in 1..=MOST_STEPS {
            let w = foot.point - self.origin;
            let (distance, along) = (w.length(), self.direction.dot(w));
            if distance - self.half_chord <= MEETING * extent {
                let reason = if self.half_chord > 0.0 {
                    let least = self.half_chord;
                    format!("the second curve is {distance} from the middle of the edge: expected more than {least}")
                } else {
                    format!("the second curve meets the first here: it comes as near as {distance:e}")
                };
                return Err(Error::new(Status::Degenerate, reason));
            }
            if along.abs() < PLANE * distance {
                let reason = "the sphere is a plane: the second curve is at a right angle to the normal";
                return Err(Error::new(Status::Degenerate, reason));
            }
            let next = (distance - self.half_chord) * (distance + self.half_chord) / (2.0 * along);
            (change, offset) = ((next - offset).abs(), next);
            foot = curve.nearest_from(center(offset), foot.parameter);
            if change <= SETTLED * extent.max(offset.abs()) {
                return Ok(Touching { sphere: self.sphere(offset), offset, foot, step_count: step });
            }
        }
        let reason =
            format!("no sphere touches both curves: its center still moved by {change:e} in step {MOST_STEPS}");
        Err(Error::new(Status::NoSolution, reason))
    }
}

impl Touching {
    /// Whether the sphere only passes through an end of the curve.
    pub(super) fn is_at_end(&self) -> bool {
        self.foot.end.is_some() && self.foot.cosine.abs() > TANGENT
    }
}

/// The extent of both curves.
pub(super) fn extent(points: &[DVec3], curve: &NearestOnCurve<'_>) -> f64 {
    diagonal(&[points, curve.samples()].concat())
}

/// The spheres with centers on the lines, in their order. Errors are placed at `name[k]`.
pub(super) fn touch_all(
    lines: &[CenterLine],
    curve: &NearestOnCurve<'_>,
    extent: f64,
    name: &str,
) -> Result<TouchingSpheres> {
    let mut touching: Vec<Touching> = Vec::with_capacity(lines.len());
    for (k, line) in lines.iter().enumerate() {
        // The neighbour keeps a sphere on its branch of the curve and its side; where that fails, its own nearest point may do.
        let followed = touching.last().and_then(|before| line.touch(curve, Some(before), extent).ok());
        let found = followed.map_or_else(|| line.touch(curve, None, extent), Ok);
        touching.push(found.map_err(|error| error.at(format!("{name}[{k}]")))?);
    }
    let mut findings = Findings::default();
    let mut residual = 0.0;
    for (k, it) in touching.iter().enumerate() {
        let nearest = curve.nearest(it.sphere.center).distance.min(it.foot.distance);
        residual += (it.sphere.radius - nearest) * (it.sphere.radius - nearest);
        findings.pierced.extend((it.sphere.radius - nearest > MEETING * extent.max(it.sphere.radius)).then_some(k));
        findings.ends.extend(it.is_at_end().then_some(k));
        findings.sign_changes.extend((k > 0 && it.offset * touching[k - 1].offset < 0.0).then_some(k));
    }
    findings.jumps = jumps(&touching, curve);
    Ok(TouchingSpheres { touching, findings, residual })
}

/// The spheres whose foot is more than [`JUMP`] median steps from the one before. Feet that rest at an end make no steps.
fn jumps(touching: &[Touching], curve: &NearestOnCurve<'_>) -> Vec<usize> {
    let [start, end] = curve.curve().range();
    let step = |k: usize| {
        let apart = (touching[k].foot.parameter - touching[k - 1].foot.parameter).abs();
        if curve.curve().is_closed() { apart.min(end - start - apart) } else { apart }
    };
    let rests = |k: usize| touching[k].is_at_end() && touching[k - 1].is_at_end();
    let steps: Vec<(usize, f64)> = (1..touching.len()).filter(|&k| !rests(k)).map(|k| (k, step(k))).collect();
    let mut sorted: Vec<f64> = steps.iter().map(|&(_, step)| step).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let resolution = MEETING * (end - start);
    steps.into_iter().filter(|&(_, step)| step > JUMP * median.max(resolution)).map(|(k, _)| k).collect()
}

/// Scheme A: the spheres that touch the first curve in `points`, with their centers on the lines along `normals` (of any length),
/// and the second curve.
///
/// # Errors
/// No point, another number of normals, or a coordinate that is not finite. Status `Degenerate`: a normal is zero, the curves
/// meet, or a sphere is a plane; `NoSolution`: a center does not settle. The place is `points`, `points[k]`, `normals` or
/// `normals[k]`.
pub fn spheres_at_points(points: &[DVec3], normals: &[DVec3], curve: &NearestOnCurve<'_>) -> Result<TouchingSpheres> {
    check_finite("points", points)?;
    check_finite("normals", normals)?;
    for (name, expected, found) in
        [("points", points.len().max(1), points.len()), ("normals", points.len(), normals.len())]
    {
        if expected != found {
            let reason = format!("expected {expected}, found {found}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
        }
    }
    let line = |(k, (&point, normal)): (usize, (&DVec3, &DVec3))| {
        let zero = || Error::new(Status::Degenerate, "expected a direction, found zero").at(format!("normals[{k}]"));
        let direction = normal.try_normalize().ok_or_else(zero)?;
        Ok(CenterLine { origin: point, direction, half_chord: 0.0, point })
    };
    let lines = points.iter().zip(normals).enumerate().map(line).collect::<Result<Vec<_>>>()?;
    touch_all(&lines, curve, extent(points, curve), "points")
}

/// The circles in which each sphere meets the next: one fewer than spheres. In the limit of close spheres they are the circles of
/// their envelope. They do not, in general, meet the curve in whose points the spheres touch it; those of
/// [`CircleStrip`](super::circle_strip::CircleStrip) do.
///
/// # Errors
/// A number that is not finite, or a radius not above 0. Status `NoIntersection`: a sphere contains the next or is apart from it,
/// so that they have no envelope; `Degenerate`: they are the same. The place is `spheres[k]`, the first of the two.
pub fn characteristic_circles(spheres: &[Sphere]) -> Result<Vec<Circle>> {
    for (k, sphere) in spheres.iter().enumerate() {
        if !(sphere.center.is_finite() && sphere.radius > 0.0 && sphere.radius.is_finite()) {
            let reason = format!("expected a sphere with a radius above 0, found {sphere:?}");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("spheres[{k}]")));
        }
    }
    let meet = |(k, pair): (usize, &[Sphere])| {
        pair[0].meet(&pair[1]).ok_or_else(|| {
            let (distance, [r, s]) = (pair[0].center.distance(pair[1].center), [pair[0].radius, pair[1].radius]);
            let same = distance <= PARALLEL * r.max(s) && (r - s).abs() <= PARALLEL * r.max(s);
            let (status, reason) = if same {
                (Status::Degenerate, "it is the same as the next".to_string())
            } else {
                let reason = format!("it does not meet the next: radii {r} and {s}, centers {distance} apart");
                (Status::NoIntersection, reason)
            };
            Error::new(status, reason).at(format!("spheres[{k}]"))
        })
    };
    spheres.windows(2).enumerate().map(meet).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::canal::inversion::{GeneralSphere, Inversion};
    use crate::geometry::canal::normals::{Guide, Orientation, rotation_minimising};
    use crate::mesh::curve::{Curve, FnCurve, Spacing, Spline};

    /// A torus: the radius of its axis, and that of its tube.
    pub(in super::super) const TORUS: [f64; 2] = [2.0, 0.7];

    /// Point, first and second derivative at `u` of the curve on the torus with `[v, v', v'']`, angles around axis and tube.
    pub(in super::super) fn on_torus(u: f64, [v, v1, v2]: [f64; 3]) -> [DVec3; 3] {
        let [axis, tube] = TORUS;
        let ((su, cu), (sv, cv)) = (u.sin_cos(), v.sin_cos());
        let (rho, rho1) = (axis + tube * cv, -tube * sv * v1);
        let rho2 = -tube * (cv * v1 * v1 + sv * v2);
        [
            DVec3::new(rho * cu, rho * su, tube * sv),
            DVec3::new(rho1 * cu - rho * su, rho1 * su + rho * cu, tube * cv * v1),
            DVec3::new(
                rho2 * cu - 2.0 * rho1 * su - rho * cu,
                rho2 * su + 2.0 * rho1 * cu - rho * su,
                tube * (cv * v2 - sv * v1 * v1),
            ),
        ]
    }

    /// The parallel of the torus at `v = 0.5`.
    pub(in super::super) fn parallel(range: [f64; 2], is_closed: bool) -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
        FnCurve::new(range, is_closed, |u| on_torus(u, [0.5, 0.0, 0.0])).unwrap()
    }

    /// The curve `v = 2 + 0.3 sin 2u` on the torus.
    pub(in super::super) fn wave(range: [f64; 2], is_closed: bool) -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
        let v = |u: f64| [2.0 + 0.3 * (2.0 * u).sin(), 0.6 * (2.0 * u).cos(), -1.2 * (2.0 * u).sin()];
        FnCurve::new(range, is_closed, move |u| on_torus(u, v(u))).unwrap()
    }

    /// The image of a curve by an inversion: with `q = p − C`, `s = q²` and `f = k q/s`, the derivatives of `f`.
    pub(in super::super) fn inverted(curve: &dyn Curve, inversion: Inversion) -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
        FnCurve::new(curve.range(), curve.is_closed(), move |t| {
            let jet = curve.at(t);
            let (q, q1, q2) = (jet.point - inversion.center(), jet.first, jet.second);
            let (s, s1, s2) = (q.dot(q), 2.0 * q.dot(q1), 2.0 * (q1.dot(q1) + q.dot(q2)));
            let first = q1 / s - q * (s1 / (s * s));
            let second = q2 / s - q1 * (2.0 * s1 / (s * s)) + q * (2.0 * s1 * s1 / (s * s * s) - s2 / (s * s));
            let k = inversion.ratio();
            [inversion.center() + k * q / s, k * first, k * second]
        })
        .unwrap()
    }

    /// The normal of the torus on the parallel, towards the tube's axis.
    fn inward(u: f64) -> DVec3 {
        -DVec3::new(0.5_f64.cos() * u.cos(), 0.5_f64.cos() * u.sin(), 0.5_f64.sin())
    }

    fn tube_center(u: f64) -> DVec3 {
        TORUS[0] * DVec3::new(u.cos(), u.sin(), 0.0)
    }

    fn parameters(count: usize) -> Vec<f64> {
        (0..count).map(|k| 2.5 * k as f64 / (count - 1) as f64).collect()
    }

    #[test]
    fn spheres_that_touch_two_curves_of_a_torus_are_those_of_its_tube() {
        let (first, second) = (parallel([0.0, 2.5], false), wave([-0.5, 3.0], false));
        let curve = NearestOnCurve::new(&second).unwrap();
        let us = parameters(24);
        let points: Vec<DVec3> = us.iter().map(|&u| first.point(u)).collect();
        let guide = Guide::along(&first, 24, Spacing::ArcLength).unwrap();
        let turned = rotation_minimising(&guide, Orientation::Normal(inward(0.0))).unwrap();
        let exact: Vec<DVec3> = us.iter().map(|&u| inward(u)).collect();
        for normals in [exact, turned] {
            let found = spheres_at_points(&points, &normals, &curve).unwrap();
            for (it, &u) in found.touching.iter().zip(&us) {
                assert!((it.offset - TORUS[1]).abs() < 1e-10 && (it.sphere.radius - TORUS[1]).abs() < 1e-10);
                assert!(it.sphere.center.distance(tube_center(u)) < 1e-10);
                assert!((it.foot.parameter - u).abs() < 1e-9 && it.step_count <= 5, "{it:?}");
            }
            assert_eq!(found.findings, Findings::default());
            assert!(found.residual < 1e-20);
        }
        // The same from the other side: the opposite normal, the same spheres.
        let outward: Vec<DVec3> = us.iter().map(|&u| -inward(u)).collect();
        let found = spheres_at_points(&points, &outward, &curve).unwrap();
        assert!(found.touching.iter().all(|it| (it.offset + TORUS[1]).abs() < 1e-10));
    }

    #[test]
    fn spheres_that_touch_two_curves_of_a_cyclide_are_images_of_those_of_the_torus() {
        let inversion = Inversion::new(DVec3::new(0.3, -0.4, 1.9), 2.3).unwrap();
        let (torus_first, torus_second) = (parallel([0.0, 2.5], false), wave([-0.5, 3.0], false));
        let second = inverted(&torus_second, inversion);
        let curve = NearestOnCurve::new(&second).unwrap();
        let us = parameters(24);
        let points: Vec<DVec3> = us.iter().map(|&u| inversion.point(torus_first.point(u))).collect();
        let normals: Vec<DVec3> =
            us.iter().map(|&u| inversion.direction(torus_first.point(u), inward(u)).normalize()).collect();
        let found = spheres_at_points(&points, &normals, &curve).unwrap();
        for (it, &u) in found.touching.iter().zip(&us) {
            let tube = Sphere { center: tube_center(u), radius: TORUS[1] };
            let GeneralSphere::Sphere(expected) = inversion.sphere(&tube) else { panic!("a plane") };
            assert!(it.sphere.center.distance(expected.center) < 1e-9 * expected.radius);
            assert!((it.sphere.radius - expected.radius).abs() < 1e-9 * expected.radius);
            assert!((it.foot.parameter - u).abs() < 1e-8);
        }
        assert_eq!(found.findings, Findings::default());
        assert!(found.residual < 1e-18);
        // The normals are those that turn least: the curve is a line of curvature of the cyclide.
        let first = inverted(&torus_first, inversion);
        let guide = Guide::along(&first, 200, Spacing::Parameter).unwrap();
        let turned = rotation_minimising(&guide, Orientation::Normal(normals[0])).unwrap();
        let end = inversion.direction(torus_first.point(2.5), inward(2.5)).normalize();
        assert!(turned[199].distance(end) < 1e-8, "{}", turned[199].distance(end));
    }

    fn lines(width: f64) -> [Spline; 2] {
        let line = |y: f64| Spline::through(&[DVec3::new(0.0, y, 0.0), DVec3::new(4.0, y, 0.0)], false).unwrap();
        [line(0.0), line(width)]
    }

    #[test]
    fn two_parallel_lines_are_touched_by_the_spheres_of_a_cylinder() {
        let width = 1.5;
        let [first, second] = lines(width);
        let curve = NearestOnCurve::new(&second).unwrap();
        let guide = Guide::along(&first, 9, Spacing::ArcLength).unwrap();
        for beta in [-1.2_f64, 0.0, 0.3, 1.0, 1.5, 2.0] {
            // From z towards −y about x: the normal (0, cos β, sin β).
            let angle = Orientation::Angle(beta - 0.25 * std::f64::consts::TAU);
            let normals = rotation_minimising(&guide, angle).unwrap();
            assert!(normals[3].distance(DVec3::new(0.0, beta.cos(), beta.sin())) < 1e-15);
            let found = spheres_at_points(guide.points(), &normals, &curve).unwrap();
            let expected = width / (2.0 * beta.cos());
            for it in &found.touching {
                assert!((it.offset - expected).abs() < 1e-12 * expected.abs(), "{beta} {}", it.offset);
            }
            // At both ends the foot is an end of the second line, and the sphere is tangent there.
            assert_eq!(found.findings, Findings::default());
            assert!(found.residual < 1e-24 * expected * expected);
        }
        let across = spheres_at_points(guide.points(), &[DVec3::Z; 9], &curve).unwrap_err();
        assert_eq!((across.status(), across.place()), (Status::Degenerate, "points[0]"));
        assert!(across.to_string().contains("the sphere is a plane"));
    }

    #[test]
    fn ends_sides_and_branches_of_the_second_curve_are_told() {
        let [first, _] = lines(1.0);
        let guide = Guide::along(&first, 41, Spacing::ArcLength).unwrap();
        let normals = vec![DVec3::Y; 41];
        // Shorter than the guide at both ends: above its points from x = 1 to x = 3 only.
        let short = Spline::through(&[DVec3::new(1.0, 1.0, 0.0), DVec3::new(3.0, 1.0, 0.0)], false).unwrap();
        let curve = NearestOnCurve::new(&short).unwrap();
        let found = spheres_at_points(guide.points(), &normals, &curve).unwrap();
        assert_eq!(found.findings.ends, (0..10).chain(31..41).collect::<Vec<_>>());
        // Through the end (1, 1) and touching at x with a center (x, c): c = ((1 − x)² + 1)/2.
        for (k, it) in found.touching.iter().enumerate().take(10) {
            let x = 0.1 * k as f64;
            assert!((it.offset - 0.5 * ((1.0 - x) * (1.0 - x) + 1.0)).abs() < 1e-12);
        }
        assert!(found.residual < 1e-24);
        // Normals that turn over.
        let turned: Vec<DVec3> = (0..41).map(|k| if k < 20 { DVec3::Y } else { DVec3::NEG_Y }).collect();
        let found = spheres_at_points(guide.points(), &turned, &NearestOnCurve::new(&lines(1.0)[1]).unwrap()).unwrap();
        assert_eq!(found.findings.sign_changes, [20]);
        // A wave above: a sphere stays in its trough until that has no nearest point any more, and then falls into the next.
        // Before, the next one pierces it.
        let wave = FnCurve::new([0.0, 4.0], false, |x| {
            let (s, c) = (4.0 * x).sin_cos();
            [DVec3::new(x, 1.5 - 0.5 * s, 0.0), DVec3::new(1.0, -2.0 * c, 0.0), DVec3::new(0.0, 8.0 * s, 0.0)]
        })
        .unwrap();
        let found = spheres_at_points(guide.points(), &normals, &NearestOnCurve::new(&wave).unwrap()).unwrap();
        let Findings { jumps, pierced, .. } = &found.findings;
        assert_eq!(jumps.len(), 2, "{jumps:?}");
        assert!(!pierced.is_empty() && found.residual > 1e-6, "{pierced:?}");
        assert!(jumps.iter().all(|k| pierced.contains(&(k - 1))), "{jumps:?} {pierced:?}");
    }

    #[test]
    fn spheres_of_no_or_of_bad_curves_are_refused() {
        let [first, second] = lines(1.0);
        let curve = NearestOnCurve::new(&second).unwrap();
        let refusal = |points: &[DVec3], normals: &[DVec3], curve: &NearestOnCurve<'_>| {
            let error = spheres_at_points(points, normals, curve).unwrap_err();
            (error.status(), error.place().to_string())
        };
        let own = NearestOnCurve::new(&first).unwrap();
        let points = [DVec3::X, 2.0 * DVec3::X];
        assert_eq!(refusal(&points, &[DVec3::Y; 2], &own), (Status::Degenerate, "points[0]".into()));
        assert_eq!(refusal(&points, &[DVec3::Y], &curve), (Status::InvalidArgumentLength, "normals".into()));
        assert_eq!(refusal(&[], &[], &curve), (Status::InvalidArgumentLength, "points".into()));
        assert_eq!(refusal(&points, &[DVec3::Y, DVec3::ZERO], &curve), (Status::Degenerate, "normals[1]".into()));
        let bad = [DVec3::X, DVec3::NAN];
        assert_eq!(refusal(&bad, &[DVec3::Y; 2], &curve), (Status::InvalidValue, "points[1]".into()));
        assert_eq!(refusal(&points, &bad, &curve), (Status::InvalidValue, "normals[1]".into()));
    }

    #[test]
    fn spheres_of_a_tube_meet_in_its_meridians() {
        let us = parameters(10);
        let spheres: Vec<Sphere> = us.iter().map(|&u| Sphere { center: tube_center(u), radius: TORUS[1] }).collect();
        let half_chord = TORUS[0] * (0.5 * us[1]).sin();
        for (k, circle) in characteristic_circles(&spheres).unwrap().iter().enumerate() {
            let u = 0.5 * (us[k] + us[k + 1]);
            assert!(circle.center.distance((0.5 * us[1]).cos() * tube_center(u)) < 1e-14);
            assert!(circle.normal.distance(DVec3::new(-u.sin(), u.cos(), 0.0)) < 1e-13);
            assert!((circle.radius - (TORUS[1] * TORUS[1] - half_chord * half_chord).sqrt()).abs() < 1e-14);
        }
        let refusal = |center: DVec3, radius: f64| {
            let spheres = [Sphere { center: DVec3::ZERO, radius: 1.0 }, Sphere { center, radius }];
            let error = characteristic_circles(&spheres).unwrap_err();
            (error.status(), error.place().to_string())
        };
        assert_eq!(refusal(3.0 * DVec3::X, 1.0), (Status::NoIntersection, "spheres[0]".into()));
        assert_eq!(refusal(0.2 * DVec3::X, 0.5), (Status::NoIntersection, "spheres[0]".into()));
        assert_eq!(refusal(DVec3::ZERO, 0.5), (Status::NoIntersection, "spheres[0]".into()));
        assert_eq!(refusal(DVec3::ZERO, 1.0), (Status::Degenerate, "spheres[0]".into()));
        assert_eq!(refusal(DVec3::X, -1.0), (Status::InvalidValue, "spheres[1]".into()));
        assert_eq!(refusal(DVec3::NAN, 1.0), (Status::InvalidValue, "spheres[1]".into()));
    }
}
