//! Scheme B: circles through the points of a guide, consecutive ones on spheres that touch a second curve.
//!
//! Spheres that touch the guide in its points meet in circles that miss it. So here a sphere belongs to an edge: it passes
//! through both of its ends. The circle of a point is where the spheres of its two edges meet; it passes through the
//! point, and consecutive circles are on one sphere. (The paper numbers spheres and circles alike, and says of the point of
//! the guide that it is on the circle, which holds in the limit only.)
//!
//! Which spheres? The circles and the guide shall be lines of curvature of one cyclidic net. Its frames go from point to
//! point by reflection in the bisecting planes of the edges (`frame.rs`), and `t2`, the tangent of the circle, with them. The
//! centers of the spheres of both edges of a point are on the plane through it orthogonal to `t2`, since a radius is orthogonal to
//! whatever touches the sphere. So the center of an edge's sphere is on the line in which this plane meets the bisecting plane of
//! the edge. Reflection maps the bisecting plane to itself and the plane of the one end to that of the other: both ends give
//! the same line. With `d` the direction of the edge, its length `e` and `σ = |d × t2|` the line has the direction
//! `m = d × t2 / σ`, and its point nearest to both ends is `V + (e/2σ) t2 × m`.
//!
//! A line through the middle of the edge, as one would have it in the smooth limit, differs by the second order in the edge's
//! length; with it the circles' tangents would not be mirror images of each other, and quads would not close around the circles.

use glam::DVec3;

use super::frame::{Direction, Frame};
use super::normals::{Guide, Orientation, reflected_frames};
use super::two_curves::{CenterLine, Touching, TouchingSpheres, extent, touch_all};
use crate::error::{Error, Result, Status};
use crate::geometry::circle::{Circle, Sphere, reflect};
use crate::mesh::curve::NearestOnCurve;

/// Sine of the angle between an edge and the circle below which its sphere is not determined.
const ALONG_CIRCLE: f64 = 1e-9;

/// Centers nearer than this multiple of the extent have no direction from one to the other that is worth its digits: they are
/// good to 1e-12 of it.
const SAME_CENTER: f64 = 1e-8;

/// A circle smaller than this multiple of its sphere is a point.
const POINT: f64 = 1e-9;

/// The circles of a canal surface through the points of a guide that touches a second curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CircleStrip {
    /// The circles, one through each point of the guide. Counterclockwise about its normal a circle leaves the point along `t2`.
    pub circles: Vec<Circle>,
    /// The frames of the cyclidic net at the points of the guide: `t1` along it, `t2` along the circle, the normal pointing away
    /// from the centers of the spheres (of the first where they change sides).
    pub frames: Vec<Frame>,
    /// The spheres of the guide's edges, one fewer than circles: sphere `k` holds circles `k` and `k + 1`. Offsets are along the
    /// normal that was asked for.
    pub spheres: TouchingSpheres,
    /// The sphere before the first circle and the one after the last: of the closing edge of a closed guide; of an open one, of
    /// an edge that mirrors the end.
    pub outer_spheres: [Sphere; 2],
    /// Whether the second curve ends before it would touch an outer sphere, whose center then goes on as the others' do.
    pub is_extrapolated: [bool; 2],
    /// Where the second curve crosses the plane of each circle, between the points of touch of its two spheres; `None` where it
    /// does not.
    pub crossings: Vec<Option<Crossing>>,
    /// The largest difference of `t1` from the guide's unit tangents.
    pub tangent_gap: f64,
    /// Of a closed guide, how far the last frame, mirrored in the closing edge, is from the first: the largest difference of
    /// their vectors.
    pub closing_gap: Option<f64>,
}

/// Where the second curve crosses the plane of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The parameter of the second curve.
    pub parameter: f64,
    /// Its point there.
    pub point: DVec3,
    /// Its distance from the circle: how far the surface is from the second curve there.
    pub distance: f64,
}

impl CircleStrip {
    /// The strip of circles through the points of `guide`, of which one normal is chosen, that touches `curve`.
    ///
    /// A closed guide is taken as one that runs once around: whether its circles close is a question of its own.
    ///
    /// # Errors
    /// As [`reflected_frames`]. Status `Degenerate`: the curves meet, a sphere is a plane, or a circle a point; `NoSolution`: a
    /// center does not settle. The place is `edges[k]` or `points[k]`, counted along the guide.
    pub fn new(guide: &Guide, orientation: Orientation, curve: &NearestOnCurve<'_>) -> Result<Self> {
        let mut frames = reflected_frames(guide, orientation)?;
        let points = guide.points();
        let (last, extent) = (points.len() - 1, extent(points, curve));
        let line = |k: usize| {
            outgoing(points[k], points[k + 1] - points[k], frames[k].t2).map_err(|e| e.at(format!("edges[{k}]")))
        };
        let lines = (0..last).map(line).collect::<Result<Vec<_>>>()?;
        let spheres = touch_all(&lines, curve, extent, "edges")?;
        let touching = &spheres.touching;
        // Into the first point and out of the last one.
        let closing = points[0] - points[last];
        let mirrored = |edge: DVec3, t1: DVec3| -reflect(edge, t1);
        let (before, after) = if guide.is_closed() {
            (closing, closing)
        } else {
            (mirrored(points[1] - points[0], frames[0].t1), mirrored(points[last] - points[last - 1], frames[last].t1))
        };
        // The line of an edge seen from its end is that of the reversed edge, in the same direction.
        let into = outgoing(points[0], -before, -frames[0].t2).map_err(|error| error.at("points[0]"))?;
        let out =
            outgoing(points[last], after, frames[last].t2).map_err(|error| error.at(format!("points[{last}]")))?;
        let backwards: Vec<Touching> = touching.iter().take(3).copied().collect();
        let forwards: Vec<Touching> = touching.iter().rev().take(3).copied().collect();
        let (first, final_) = (outer(&into, &backwards, curve, extent), outer(&out, &forwards, curve, extent));
        // Outwards is where the centers are not.
        if touching[0].offset > 0.0 {
            for frame in &mut frames {
                *frame = Frame { t2: -frame.t2, normal: -frame.normal, ..*frame };
            }
        }
        let mut around = vec![first.sphere];
        around.extend(spheres.spheres());
        around.push(final_.sphere);
        let circles = (0..points.len())
            .map(|k| {
                circle(points[k], &frames[k], [around[k], around[k + 1]], extent)
                    .map_err(|e| e.at(format!("points[{k}]")))
            })
            .collect::<Result<Vec<_>>>()?;
        let mut feet = vec![first.foot];
        feet.extend(touching.iter().map(|touching| touching.foot.parameter));
        feet.push(final_.foot);
        let crossings = (0..points.len()).map(|k| crossing(curve, &circles[k], [feet[k], feet[k + 1]])).collect();
        let gap = |(frame, &tangent): (&Frame, &DVec3)| frame.t1.distance(tangent);
        let tangent_gap = frames.iter().zip(guide.tangents()).map(gap).fold(0.0, f64::max);
        let closing_gap = guide.is_closed().then(|| frames[last].across(closing, Direction::One).distance(&frames[0]));
        Ok(Self {
            circles,
            frames,
            spheres,
            outer_spheres: [first.sphere, final_.sphere],
            is_extrapolated: [first.is_extrapolated, final_.is_extrapolated],
            crossings,
            tangent_gap,
            closing_gap,
        })
    }

    /// The largest distance of the second curve from a circle, where it crosses the circle's plane: how far the surface misses
    /// it. Between two circles a sphere touches it. 0 where it crosses none.
    pub fn deviation(&self) -> f64 {
        self.crossings.iter().flatten().map(|crossing| crossing.distance).fold(0.0, f64::max)
    }
}

/// The line of the center of the sphere of an edge that leaves `point`, where the circle has the tangent `t2`.
fn outgoing(point: DVec3, edge: DVec3, t2: DVec3) -> Result<CenterLine> {
    let length = edge.length();
    let across = (edge / length).cross(t2);
    let sine = across.length();
    if !(sine > ALONG_CIRCLE) {
        let reason = "the edge runs along the circle, across the tangent of the guide";
        return Err(Error::new(Status::Degenerate, reason));
    }
    let direction = across / sine;
    let half_chord = 0.5 * length / sine;
    Ok(CenterLine { origin: point + half_chord * t2.cross(direction), direction, half_chord, point })
}

/// A sphere beyond an end, its foot's parameter (or where that would be), and whether the second curve ends before.
struct Outer {
    sphere: Sphere,
    foot: f64,
    is_extrapolated: bool,
}

/// The sphere beyond an end: it touches the curve as all do. Where the curve has ended, or no such sphere is on the same side, the
/// offset goes on by a polynomial through the next three, at most quadratic.
fn outer(line: &CenterLine, next: &[Touching], curve: &NearestOnCurve<'_>, extent: f64) -> Outer {
    let proper = |touching: &Touching| !touching.is_at_end() && touching.offset * next[0].offset > 0.0;
    if let Some(found) = line.touch(curve, Some(&next[0]), extent).ok().filter(proper) {
        return Outer { sphere: found.sphere, foot: found.foot.parameter, is_extrapolated: false };
    }
    let on = |value: &dyn Fn(&Touching) -> f64| match next {
        [a, b, c, ..] => 3.0 * (value(a) - value(b)) + value(c),
        [a, b] => 2.0 * value(a) - value(b),
        _ => next.first().map_or(0.0, value),
    };
    let offset = on(&|touching| touching.offset);
    let offset = if offset * next[0].offset > 0.0 { offset } else { next[0].offset };
    let step = next.get(1).map_or(0.0, |second| next[0].foot.parameter - second.foot.parameter);
    Outer { sphere: line.sphere(offset), foot: next[0].foot.parameter + 2.0 * step, is_extrapolated: true }
}

/// The circle through `point` in which the spheres of its two edges meet; its tangent there is `t2`.
///
/// Its plane is orthogonal to the line of centers; the circle of that plane and of one sphere is also on the other. Nothing
/// cancels for nearly equal spheres: a wrong direction of the line moves the circle on the spheres, and both are nearly the same.
/// Of equal spheres every circle through the point will do; we take the one across the guide.
fn circle(point: DVec3, frame: &Frame, [before, after]: [Sphere; 2], extent: f64) -> Result<Circle> {
    let apart = after.center - before.center;
    let axis = if apart.length() > SAME_CENTER * extent { apart } else { frame.t1 };
    // Both centers are orthogonal to t2 from the point, but for rounding.
    let axis = axis.reject_from_normalized(frame.t2).normalize_or(frame.t1);
    let radius_vector = (point - after.center).reject_from_normalized(axis);
    let radius = radius_vector.length();
    if !(radius > POINT * after.radius) {
        let reason = "the circle shrinks to a point: the spheres of both edges touch each other there";
        return Err(Error::new(Status::Degenerate, reason));
    }
    let normal = if axis.cross(radius_vector).dot(frame.t2) < 0.0 { -axis } else { axis };
    Ok(Circle { center: point - radius_vector, normal, radius })
}

/// Where the curve crosses the plane of a circle between two parameters: Newton's method, kept between them by bisection.
fn crossing(curve: &NearestOnCurve<'_>, circle: &Circle, [from, to]: [f64; 2]) -> Option<Crossing> {
    let curve = curve.curve();
    let [start, end] = curve.range();
    // Around a closed curve the short way; an open one has no more than itself.
    let around = |t: f64| {
        if curve.is_closed() && (t - from).abs() > 0.5 * (end - start) {
            t - (end - start).copysign(t - from)
        } else {
            t
        }
    };
    let within = |t: f64| if curve.is_closed() { t } else { t.clamp(start, end) };
    let (mut low, mut high) = (within(from), within(around(to)));
    let height = |t: f64| (curve.point(t) - circle.center).dot(circle.normal);
    let (at_low, at_high) = (height(low), height(high));
    if !(at_low * at_high <= 0.0) {
        return None;
    }
    if at_low > 0.0 {
        (low, high) = (high, low);
    }
    let mut t = 0.5 * (low + high);
    for _ in 0..100 {
        let jet = curve.at(t);
        let height = (jet.point - circle.center).dot(circle.normal);
        if height < 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - height / jet.first.dot(circle.normal);
        let next = if (newton - low) * (newton - high) < 0.0 { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= 2.0 * f64::EPSILON * start.abs().max(end.abs()) {
            break;
        }
        t = next;
    }
    let point = curve.point(t);
    Some(Crossing { parameter: curve.inside(t), point, distance: circle.distance(point) })
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::canal::inversion::{GeneralCircle, Inversion};
    use crate::geometry::canal::two_curves::Findings;
    use crate::geometry::canal::two_curves::tests::{TORUS, inverted, on_torus, parallel, wave};
    use crate::mesh::curve::{Curve, FnCurve, Spacing, Spline};

    /// Points that make curves without symmetry: the second beside and above the first, whatever way it goes.
    pub(in super::super) fn free_form(count: usize) -> [Spline; 2] {
        let first = |s: f64| DVec3::new(4.0 * s, (3.0 * s).sin(), 0.5 * (4.0 * s).cos());
        let second = |s: f64| DVec3::new(4.3 * s - 0.2, (3.0 * s).sin() + 1.5 + 0.3 * (5.0 * s).cos(), 1.0 + 0.4 * s);
        let spline = |curve: &dyn Fn(f64) -> DVec3| {
            let points: Vec<DVec3> = (0..count).map(|i| curve(i as f64 / (count - 1) as f64)).collect();
            Spline::through(&points, false).unwrap()
        };
        [spline(&first), spline(&second)]
    }

    /// What makes a strip of circles exact, to rounding.
    fn check(strip: &CircleStrip, guide: &Guide, curve: &NearestOnCurve<'_>) {
        let spheres = strip.spheres.spheres();
        for (k, (circle, frame)) in strip.circles.iter().zip(&strip.frames).enumerate() {
            let point = guide.points()[k];
            assert!(circle.distance(point) < 1e-14 * (1.0 + circle.radius), "{k}: {:e}", circle.distance(point));
            assert!(circle.tangent_at(point).distance(frame.t2) < 1e-12, "{k}");
            let around = [
                if k == 0 { strip.outer_spheres[0] } else { spheres[k - 1] },
                if k == spheres.len() { strip.outer_spheres[1] } else { spheres[k] },
            ];
            for (angle, sphere) in [0.5, 2.0, 4.0].into_iter().flat_map(|angle| around.map(|sphere| (angle, sphere))) {
                let apart = sphere.distance(circle.point_at(point, angle));
                assert!(apart.abs() < 1e-13 * (1.0 + sphere.radius), "{k} {angle}: {apart:e}");
                // The frame's normal points away from the centers.
                assert!((point - sphere.center).dot(frame.normal) > 0.0);
            }
            if k > 0 {
                let edge = point - guide.points()[k - 1];
                assert!(strip.frames[k - 1].across(edge, Direction::One).distance(frame) < 1e-14);
            }
        }
        for (k, (sphere, it)) in spheres.iter().zip(&strip.spheres.touching).enumerate() {
            let nearest = curve.nearest(sphere.center);
            assert!((nearest.distance - sphere.radius).abs() < 1e-12 * (1.0 + sphere.radius), "{k}");
            assert!(it.is_at_end() || nearest.tangent.dot(nearest.point - sphere.center).abs() < 1e-11);
            for point in &guide.points()[k..k + 2] {
                assert!(sphere.distance(*point).abs() < 1e-14 * (1.0 + sphere.radius));
            }
        }
    }

    #[test]
    fn circles_of_two_free_curves_are_exact() {
        let [first, second] = free_form(12);
        let curve = NearestOnCurve::new(&second).unwrap();
        for count in [4, 5, 17, 64, 500] {
            for angle in [-0.3, -0.8, -1.4] {
                let guide = Guide::along(&first, count, Spacing::ArcLength).unwrap();
                let strip = CircleStrip::new(&guide, Orientation::Angle(angle), &curve).unwrap();
                check(&strip, &guide, &curve);
                let Findings { jumps, sign_changes, pierced, .. } = &strip.spheres.findings;
                assert!(jumps.is_empty() && sign_changes.is_empty() && pierced.is_empty(), "{count} {angle}");
                assert!(strip.spheres.residual < 1e-24, "{:e}", strip.spheres.residual);
                // Frames in whose terms the guide has little to give and none of it alternating.
                assert!(strip.tangent_gap < 5.0 / (count * count) as f64, "{count}: {}", strip.tangent_gap);
                // Inner circles pass the second curve by what is of the second order in their distance.
                assert!(strip.deviation() < 9.0 / (count * count) as f64, "{count}: {:e}", strip.deviation());
            }
        }
    }

    #[test]
    fn circles_tend_to_those_of_a_cyclide_with_the_second_order() {
        let inversion = Inversion::new(DVec3::new(0.3, -0.4, 1.9), 2.3).unwrap();
        let (torus_first, torus_second) = (parallel([0.0, 2.5], false), wave([0.0, 2.5], false));
        let (first, second) = (inverted(&torus_first, inversion), inverted(&torus_second, inversion));
        let curve = NearestOnCurve::new(&second).unwrap();
        let normal = inversion.direction(torus_first.point(0.0), DVec3::new(0.5_f64.cos(), 0.0, 0.5_f64.sin()));
        let errors = |count: usize| {
            let guide = Guide::along(&first, count, Spacing::Parameter).unwrap();
            let strip = CircleStrip::new(&guide, Orientation::Normal(normal), &curve).unwrap();
            check(&strip, &guide, &curve);
            let error = |(k, circle): (usize, &Circle)| {
                let u = 2.5 * k as f64 / (count - 1) as f64;
                let center = TORUS[0] * DVec3::new(u.cos(), u.sin(), 0.0);
                let meridian = Circle { center, normal: DVec3::new(-u.sin(), u.cos(), 0.0), radius: TORUS[1] };
                let GeneralCircle::Circle(exact) = inversion.circle(&meridian) else { panic!("a line") };
                (circle.center.distance(exact.center) + (circle.radius - exact.radius).abs()) / exact.radius
            };
            let errors: Vec<f64> = strip.circles.iter().enumerate().map(error).collect();
            let ends = errors[0].max(errors[count - 1]);
            let inner = errors[1..count - 1].iter().copied().fold(0.0, f64::max);
            // The second curve ends beside the end of the guide, so before it could touch the outer spheres.
            assert_eq!(strip.is_extrapolated, [true; 2]);
            [ends, inner, strip.deviation()]
        };
        let (coarse, fine) = (errors(33), errors(65));
        assert!(coarse[0] < 0.03 && coarse[1] < 0.03 && coarse[2] < 3e-3, "{coarse:?}");
        assert!((0..3).all(|i| (3.6..4.4).contains(&(coarse[i] / fine[i]))), "{coarse:?} {fine:?}");
    }

    #[test]
    fn circles_of_two_parallels_of_a_torus_are_its_meridians_all_around() {
        let level = FnCurve::new([0.0, TAU], true, |u| on_torus(u, [2.0, 0.0, 0.0])).unwrap();
        let curve = NearestOnCurve::new(&level).unwrap();
        let outward = Orientation::Normal(DVec3::new(0.5_f64.cos(), 0.0, 0.5_f64.sin()));
        for count in [24, 25] {
            let guide = Guide::along(&parallel([0.0, TAU], true), count, Spacing::ArcLength).unwrap();
            let strip = CircleStrip::new(&guide, outward, &curve).unwrap();
            check(&strip, &guide, &curve);
            assert!(strip.closing_gap.unwrap() < 1e-13 && strip.tangent_gap < 1e-14);
            assert_eq!(strip.is_extrapolated, [false; 2]);
            let radius = strip.circles[0].radius;
            assert!((radius / TORUS[1] - 1.0).abs() < 0.2);
            for (k, circle) in strip.circles.iter().enumerate() {
                let u = TAU * k as f64 / count as f64;
                assert!(circle.normal.cross(DVec3::new(-u.sin(), u.cos(), 0.0)).length() < 1e-11);
                assert!((circle.radius - radius).abs() < 1e-11);
            }
            // All as far from the second curve, which crosses all planes.
            let apart = strip.crossings.iter().map(|crossing| crossing.unwrap().distance);
            assert!(apart.clone().all(|distance| (distance - strip.deviation()).abs() < 1e-11));
            assert!(strip.deviation() > 1e-3 && strip.deviation() < 0.1);
        }
        // A closed guide that is not on a sphere does not come back to its frame.
        let ring = |u: f64| DVec3::new(3.0 * u.cos(), 3.0 * u.sin(), 0.7 * (2.0 * u).sin() + 0.3 * (3.0 * u).cos());
        let ring = |height: f64, scale: f64| {
            let points: Vec<DVec3> =
                (0..24).map(|i| scale * ring(TAU * f64::from(i) / 24.0) + height * DVec3::Z).collect();
            Spline::through(&points, true).unwrap()
        };
        let (first, second) = (ring(0.0, 1.0), ring(2.0, 0.8));
        let curve = NearestOnCurve::new(&second).unwrap();
        let guide = Guide::along(&first, 60, Spacing::ArcLength).unwrap();
        let strip = CircleStrip::new(&guide, Orientation::Angle(0.1), &curve).unwrap();
        check(&strip, &guide, &curve);
        assert!(strip.closing_gap.unwrap() > 1e-3);
    }

    #[test]
    fn circles_of_curves_on_a_sphere_and_of_lines() {
        // All spheres are the unit sphere: circles across the guide.
        let on_sphere = |latitude: f64, end: f64| {
            let (z, r) = latitude.sin_cos();
            FnCurve::new([0.0, end], false, move |t| {
                let (s, c) = t.sin_cos();
                [DVec3::new(r * c, r * s, z), DVec3::new(-r * s, r * c, 0.0), DVec3::new(-r * c, -r * s, 0.0)]
            })
            .unwrap()
        };
        let (first, second) = (on_sphere(0.0, 2.0), on_sphere(0.7, 2.2));
        let curve = NearestOnCurve::new(&second).unwrap();
        let guide = Guide::along(&first, 12, Spacing::ArcLength).unwrap();
        let strip = CircleStrip::new(&guide, Orientation::Normal(DVec3::X), &curve).unwrap();
        check(&strip, &guide, &curve);
        for circle in &strip.circles {
            assert!((circle.radius - 1.0).abs() < 1e-9 && circle.center.length() < 1e-9);
        }
        // A cylinder through parallel lines: centers (x, c cos β, c sin β) with c = (w² − (e/2)²)/(2w cos β).
        let (width, beta) = (1.5, 0.4_f64);
        let line = |y: f64| Spline::through(&[DVec3::new(0.0, y, 0.0), DVec3::new(4.0, y, 0.0)], false).unwrap();
        let (first, second) = (line(0.0), line(width));
        let curve = NearestOnCurve::new(&second).unwrap();
        let guide = Guide::along(&first, 9, Spacing::ArcLength).unwrap();
        let normal = DVec3::new(0.0, beta.cos(), beta.sin());
        let strip = CircleStrip::new(&guide, Orientation::Normal(normal), &curve).unwrap();
        check(&strip, &guide, &curve);
        let offset = (width * width - 0.0625) / (2.0 * width * beta.cos());
        for (k, circle) in strip.circles.iter().enumerate() {
            assert!(circle.center.distance(guide.points()[k] + offset * normal) < 1e-12);
            assert!((circle.radius - offset).abs() < 1e-12 && circle.normal.cross(DVec3::X).length() < 1e-12);
            assert!(strip.frames[k].normal.distance(-normal) < 1e-14);
        }
    }

    #[test]
    fn strips_without_spheres_are_refused_at_their_edge() {
        let [first, second] = free_form(12);
        let guide = Guide::along(&first, 20, Spacing::ArcLength).unwrap();
        let refusal = |guide: &Guide, orientation, curve: &dyn Curve| {
            let error = CircleStrip::new(guide, orientation, &NearestOnCurve::new(curve).unwrap()).unwrap_err();
            (error.status(), error.to_string())
        };
        let (status, text) = refusal(&guide, Orientation::Angle(0.3), &first);
        assert!(status == Status::Degenerate && text.starts_with("edges[0]: the second curve is"), "{text}");
        let (status, text) = refusal(&guide, Orientation::Angle(f64::NAN), &second);
        assert!(status == Status::InvalidValue && text.starts_with("orientation: "), "{text}");
        // Beside a line, in the plane at a right angle to its normal.
        let line = |y: f64| Spline::through(&[DVec3::new(0.0, y, 0.0), DVec3::new(4.0, y, 0.0)], false).unwrap();
        let guide = Guide::along(&line(0.0), 5, Spacing::ArcLength).unwrap();
        let (status, text) = refusal(&guide, Orientation::Normal(DVec3::Z), &line(3.0));
        assert!(status == Status::Degenerate && text.starts_with("edges[0]: the sphere is a plane"), "{text}");
    }
}
