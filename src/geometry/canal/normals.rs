//! Normals along a line of curvature, of which one is chosen.
//!
//! Along a line of curvature the derivative of the surface normal is tangent to the line: the normal turns about the tangent as
//! little as it can. So it is known everywhere once it is chosen somewhere, by one angle, and the lines along the normals make a
//! developable surface (section 4.1, Fig. 9).
//!
//! *Scheme A* takes the tangents of the curve as they are and hands the normal on by double reflection, whose error over the
//! whole curve is of the fourth order in the spacing (Wang, Jüttler, Zheng & Liu 2008, "Computation of rotation minimizing
//! frames").
//!
//! *Scheme B* is the rule of cyclidic nets (`frame.rs`): one reflection for each edge. It needs no tangents but the first, and
//! is exact in the sense of discrete lines of curvature. An error of the first tangent goes from edge to edge with alternating
//! signs; so the first tangent is chosen for the least sum of squared differences to those of the curve.

use glam::DVec3;

use super::frame::{Direction, Frame};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::reflect;
use crate::mesh::curve::{Curve, Spacing, resample};
use crate::mesh::grid::{check_finite, diagonal};

/// Sine of the angle between a tangent and z below which z has no projection that is worth its digits.
const UPRIGHT: f64 = 1e-6;

/// Neighbouring points count as one below this multiple of the points' extent.
const REPEATED: f64 = 1e-12;

/// The last point of a closed guide repeats the first below this multiple of the points' extent: files round coordinates.
const SEAM: f64 = 1e-9;

/// Points along a curve with its unit tangents there.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    points: Vec<DVec3>,
    tangents: Vec<DVec3>,
    is_closed: bool,
    is_merged: bool,
}

impl Guide {
    /// A guide of points, in model units, and tangents of any length. Of a closed one the first point follows the last; where
    /// the last repeats the first (within 1e-9 of the extent) it is left out, and [`Guide::is_merged`] says so.
    ///
    /// # Errors
    /// Fewer than 2 points (3 of a closed guide), another number of tangents, a coordinate that is not finite. Status
    /// `Degenerate`: a point repeats the one before it, or a tangent is zero. The place is `points`, `points[i]`, `tangents` or
    /// `tangents[i]`.
    pub fn new(points: &[DVec3], tangents: &[DVec3], is_closed: bool) -> Result<Self> {
        check_finite("points", points)?;
        check_finite("tangents", tangents)?;
        if tangents.len() != points.len() {
            let reason = format!("expected one for each of {} points, found {}", points.len(), tangents.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("tangents"));
        }
        let extent = diagonal(points);
        let is_merged = is_closed && points.len() > 1 && points[0].distance(points[points.len() - 1]) <= SEAM * extent;
        let (points, tangents) =
            if is_merged { (&points[..points.len() - 1], &tangents[..points.len() - 1]) } else { (points, tangents) };
        let least = if is_closed { 3 } else { 2 };
        if points.len() < least {
            let reason = format!("expected at least {least}, found {}", points.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        if let Some(i) = (1..points.len()).find(|&i| points[i].distance(points[i - 1]) <= REPEATED * extent) {
            let reason = format!("expected another point than points[{}], found {} again", i - 1, points[i]);
            return Err(Error::new(Status::Degenerate, reason).at(format!("points[{i}]")));
        }
        let unit = |(i, tangent): (usize, &DVec3)| {
            let zero = || Error::new(Status::Degenerate, format!("expected a direction, found {tangent}"));
            tangent.try_normalize().ok_or_else(|| zero().at(format!("tangents[{i}]")))
        };
        let tangents = tangents.iter().enumerate().map(unit).collect::<Result<_>>()?;
        Ok(Self { points: points.to_vec(), tangents, is_closed, is_merged })
    }

    /// `count` points of a curve and its tangents there; closed where the curve is.
    ///
    /// # Errors
    /// As [`resample`]; status `Degenerate`: the curve stands still at a point.
    pub fn along(curve: &dyn Curve, count: usize, spacing: Spacing) -> Result<Self> {
        let jets: Vec<_> = resample(curve, count, spacing)?.into_iter().map(|t| curve.at(t)).collect();
        let (points, tangents): (Vec<_>, Vec<_>) = jets.iter().map(|jet| (jet.point, jet.first)).unzip();
        Self::new(&points, &tangents, curve.is_closed())
    }

    /// The points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The unit tangents.
    pub fn tangents(&self) -> &[DVec3] {
        &self.tangents
    }

    /// Whether the first point follows the last.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Whether the last point given repeated the first of a closed guide, and was left out.
    pub fn is_merged(&self) -> bool {
        self.is_merged
    }
}

/// What the first normal is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// The direction of [`reference()`] turned about the first tangent by an angle, in radians.
    Angle(f64),
    /// As near as possible to this direction, of any length.
    Normal(DVec3),
}

/// The direction, orthogonal to a unit tangent, from which angles are measured: the projection of z; that of x where the
/// tangent is parallel to z.
pub fn reference(tangent: DVec3) -> DVec3 {
    let projection = |axis: DVec3| axis.reject_from_normalized(tangent);
    let up = projection(DVec3::Z);
    if up.length() > UPRIGHT { up.normalize() } else { projection(DVec3::X).normalize_or(DVec3::X) }
}

impl Orientation {
    /// The unit normal for a unit tangent, orthogonal to it.
    ///
    /// # Errors
    /// A number that is not finite. Status `Degenerate`: a normal parallel to the tangent, or zero. The place is `orientation`.
    pub fn normal(self, tangent: DVec3) -> Result<DVec3> {
        match self {
            Self::Angle(angle_rad) => {
                let (sine, cosine) = finite("orientation", angle_rad)?.sin_cos();
                let reference = reference(tangent);
                Ok(cosine * reference + sine * tangent.cross(reference))
            }
            Self::Normal(normal) => {
                check_finite("orientation", &[normal]).map_err(|error| error.with_place("orientation"))?;
                let across = normal.normalize_or_zero().reject_from_normalized(tangent);
                if across.length() > UPRIGHT {
                    return Ok(across.normalize());
                }
                let reason = format!("expected a normal across the first tangent {tangent}, found {normal}");
                Err(Error::new(Status::Degenerate, reason).at("orientation"))
            }
        }
    }
}

/// Scheme A: the normals at the points of a guide that turn as little as the curve allows.
///
/// Across an edge the normal and the tangent are mirrored in the plane that bisects it, and then in the plane that bisects the
/// mirrored tangent and that of the curve, which so become one.
///
/// # Errors
/// As [`Orientation::normal`].
pub fn rotation_minimising(guide: &Guide, orientation: Orientation) -> Result<Vec<DVec3>> {
    let mut normals = vec![orientation.normal(guide.tangents[0])?];
    for k in 1..guide.points.len() {
        let edge = guide.points[k] - guide.points[k - 1];
        let mirrored = reflect(guide.tangents[k - 1], edge);
        let normal = reflect(reflect(normals[k - 1], edge), guide.tangents[k] - mirrored);
        // Of what round-off adds up only the part across the tangent stays.
        normals.push(normal.reject_from_normalized(guide.tangents[k]).normalize());
    }
    Ok(normals)
}

/// Scheme B: the frames at the points of a guide, `t1` along it, each the mirror image of the one before as [`Frame::across`]
/// says. The first tangent is that of [`fitting_tangent`].
///
/// # Errors
/// As [`Orientation::normal`] and [`fitting_tangent`].
pub fn reflected_frames(guide: &Guide, orientation: Orientation) -> Result<Vec<Frame>> {
    let tangent = fitting_tangent(guide)?;
    let normal = orientation.normal(tangent)?;
    let mut frames = vec![Frame { t1: tangent, t2: normal.cross(tangent), normal }];
    for ends in guide.points.windows(2) {
        frames.push(frames[frames.len() - 1].across(ends[1] - ends[0], Direction::One));
    }
    Ok(frames)
}

/// The first tangent whose mirror images differ least from the tangents `τ` of the guide.
///
/// The tangent at point `k` is `t_k = B_k t_0` with `B_k` the product of all `−ρ` before, `ρ` the reflections, which are
/// symmetric. `Σ |B_k t_0 − τ_k|²` is least for the unit vector along `Σ B_kᵀ τ_k`; the sum is built from its end:
/// `s_k = τ_k − ρ_k s_{k+1}`.
///
/// # Errors
/// Status `Degenerate`: the tangents contradict each other so that their mean vanishes; the place is `tangents`.
pub fn fitting_tangent(guide: &Guide) -> Result<DVec3> {
    let count = guide.points.len();
    let mut sum = guide.tangents[count - 1];
    for k in (0..count - 1).rev() {
        sum = guide.tangents[k] - reflect(sum, guide.points[k + 1] - guide.points[k]);
    }
    if sum.length() > 1e-6 * count as f64 {
        return Ok(sum.normalize());
    }
    let reason = "expected tangents that agree with the points, found ones that cancel each other along it";
    Err(Error::new(Status::Degenerate, reason).at("tangents"))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::random::Random;
    use crate::mesh::curve::FnCurve;

    /// Radius 1, 0.4 upwards for each radian; the length of a radian.
    const RISE: f64 = 0.4;

    fn helix(end: f64) -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
        FnCurve::new([0.0, end], false, |t| {
            let (s, c) = t.sin_cos();
            [DVec3::new(c, s, RISE * t), DVec3::new(-s, c, RISE), DVec3::new(-c, -s, 0.0)]
        })
        .unwrap()
    }

    /// In the frame of principal normal N and binormal B the normal that turns least turns by minus the torsion: by the angle
    /// −RISE t/√(1 + RISE²) after t radians.
    fn exact_normal(t: f64, start_rad: f64) -> DVec3 {
        let (s, c) = t.sin_cos();
        let tangent = DVec3::new(-s, c, RISE).normalize();
        let principal = DVec3::new(-c, -s, 0.0);
        let angle = start_rad - RISE * t / RISE.hypot(1.0);
        angle.cos() * principal + angle.sin() * tangent.cross(principal)
    }

    fn errors(count: usize, normals: &[DVec3]) -> f64 {
        let exact = |k: usize| exact_normal(5.0 * k as f64 / (count - 1) as f64, 0.3);
        normals.iter().enumerate().map(|(k, normal)| normal.distance(exact(k))).fold(0.0, f64::max)
    }

    #[test]
    fn double_reflection_follows_a_helix_with_the_fourth_order() {
        let error = |count: usize| {
            let guide = Guide::along(&helix(5.0), count, Spacing::ArcLength).unwrap();
            let normals = rotation_minimising(&guide, Orientation::Normal(exact_normal(0.0, 0.3))).unwrap();
            for (normal, tangent) in normals.iter().zip(guide.tangents()) {
                assert!((normal.length() - 1.0).abs() < 1e-15 && normal.dot(*tangent).abs() < 1e-15);
            }
            errors(count, &normals)
        };
        let errors = [21, 41, 81].map(error);
        assert!(errors[0] < 1e-4, "{errors:?}");
        for pair in errors.windows(2) {
            assert!((15.0..17.0).contains(&(pair[0] / pair[1])), "{errors:?}");
        }
    }

    #[test]
    fn single_reflection_follows_a_helix_with_the_second_order_and_without_oscillation() {
        let frames = |count: usize| {
            let guide = Guide::along(&helix(5.0), count, Spacing::ArcLength).unwrap();
            let frames = reflected_frames(&guide, Orientation::Normal(exact_normal(0.0, 0.3))).unwrap();
            let gap = frames.iter().zip(guide.tangents()).map(|(f, t)| f.t1.distance(*t)).fold(0.0, f64::max);
            let normals: Vec<DVec3> = frames.iter().map(|frame| frame.normal).collect();
            (errors(count, &normals), gap)
        };
        let (coarse, fine) = (frames(21), frames(41));
        assert!(coarse.0 < 0.05 && coarse.1 < 0.05, "{coarse:?}");
        assert!(
            (3.5..4.5).contains(&(coarse.0 / fine.0)) && (3.5..4.5).contains(&(coarse.1 / fine.1)),
            "{coarse:?} {fine:?}"
        );
    }

    #[test]
    fn the_first_tangent_fits_best_and_is_exact_on_circles() {
        let mut random = Random(4);
        let guide = Guide::along(&helix(7.0), 15, Spacing::Parameter).unwrap();
        let cost = |first: DVec3| {
            let mut tangent = first;
            let mut sum = tangent.distance_squared(guide.tangents()[0]);
            for k in 1..guide.points().len() {
                tangent = -reflect(tangent, guide.points()[k] - guide.points()[k - 1]);
                sum += tangent.distance_squared(guide.tangents()[k]);
            }
            sum
        };
        let best = fitting_tangent(&guide).unwrap();
        for _ in 0..100 {
            let other = (best + random.between(0.0, 0.1) * random.vector()).normalize();
            assert!(cost(other) >= cost(best));
        }
        // On a circle, however uneven the points, mirrored tangents are tangents.
        let turn = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
        let angles = [0.0, 0.3, 1.0, 1.1, 2.5, 4.0];
        let guide = Guide::new(&angles.map(turn), &angles.map(|a| turn(a + TAU / 4.0)), false).unwrap();
        for frame in reflected_frames(&guide, Orientation::Angle(0.7)).unwrap().iter().zip(guide.tangents()) {
            assert!(frame.0.t1.distance(*frame.1) < 1e-15);
            assert!((frame.0.normal.z - 0.7_f64.cos()).abs() < 1e-15);
        }
    }

    #[test]
    fn angles_are_measured_from_z_and_from_x() {
        let normal = |angle: f64, tangent: DVec3| Orientation::Angle(angle).normal(tangent).unwrap();
        assert!(normal(0.0, DVec3::X).distance(DVec3::Z) < 1e-15);
        assert!(normal(TAU / 4.0, DVec3::X).distance(DVec3::NEG_Y) < 1e-15);
        assert!(normal(0.0, DVec3::Z).distance(DVec3::X) < 1e-15);
        assert!(normal(TAU / 4.0, DVec3::Z).distance(DVec3::Y) < 1e-15);
        let steep = DVec3::new(0.0, 1e-3, 1.0).normalize();
        assert!(normal(0.0, steep).distance(DVec3::NEG_Y) < 1e-2);
    }

    #[test]
    fn what_is_no_guide_is_refused() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::ONE];
        let tangents = [DVec3::X; 3];
        let refusal = |points: &[DVec3], tangents: &[DVec3], is_closed| {
            let error = Guide::new(points, tangents, is_closed).unwrap_err();
            (error.status(), error.to_string())
        };
        let (status, text) = refusal(&points[..1], &tangents[..1], false);
        assert_eq!((status, &text[..]), (Status::InvalidArgumentLength, "points: expected at least 2, found 1"));
        assert_eq!(refusal(&points[..2], &tangents[..2], true).1, "points: expected at least 3, found 2");
        assert_eq!(refusal(&points, &tangents[..2], true).1, "tangents: expected one for each of 3 points, found 2");
        let twice = [DVec3::ZERO, DVec3::X, DVec3::X];
        assert!(refusal(&twice, &tangents, false).1.starts_with("points[2]: expected another point than points[1]"));
        assert!(refusal(&[DVec3::ZERO, DVec3::NAN], &tangents[..2], false).1.starts_with("points[1]: expected finite"));
        assert_eq!(refusal(&points, &[DVec3::X, DVec3::ZERO, DVec3::X], false).0, Status::Degenerate);
        let ring = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::ZERO];
        assert!(Guide::new(&ring, &[DVec3::X; 4], true).unwrap().is_merged());
        let guide = Guide::new(&points, &tangents, false).unwrap();
        for orientation in [Orientation::Normal(DVec3::X), Orientation::Normal(DVec3::ZERO)] {
            assert_eq!(rotation_minimising(&guide, orientation).unwrap_err().status(), Status::Degenerate);
        }
        for orientation in [Orientation::Normal(DVec3::NAN), Orientation::Angle(f64::NAN)] {
            let error = reflected_frames(&guide, orientation).unwrap_err();
            assert_eq!((error.status(), error.place()), (Status::InvalidValue, "orientation"));
        }
        // Tangents that cancel: along a straight guide all mirror images are the first tangent.
        let opposed = Guide::new(&[DVec3::ZERO, DVec3::X], &[DVec3::X, DVec3::NEG_X], false).unwrap();
        assert_eq!(fitting_tangent(&opposed).unwrap_err().place(), "tangents");
    }
}
