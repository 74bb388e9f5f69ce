//! Zebra stripes: the reflections of parallel light tubes, whose breaks show kinks (Flöry et al. 2012, figure 2).
//!
//! Light tubes lie far away, all in one direction `l`, evenly around it. The eye looks along `e` at a point with the normal `n`, and
//! sees what is along `r = e − 2 (e·n) n`: of the tubes the one at the angle of `r` around `l`. Where normals are continuous, so
//! are stripes; where the surface has a kink, they break off; where curvatures jump, they have a corner.

use glam::DVec3;

use crate::error::{Error, Result, Status, finite};
use crate::mesh::grid::check_finite;

/// Where the eye is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// At a point.
    At(DVec3),
    /// Far away, looking along this direction.
    Along(DVec3),
}

/// The light tubes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripes {
    /// Their direction, of any length above 0; `x` by default.
    pub direction: DVec3,
    /// How many there are around a full turn, at least 1; 24 by default. As many dark stripes lie between them.
    pub count: u32,
    /// By how much they are turned about their direction, in radians; 0 by default.
    pub turn_rad: f64,
}

impl Default for Stripes {
    fn default() -> Self {
        Self { direction: DVec3::X, count: 24, turn_rad: 0.0 }
    }
}

/// A value for each point of a surface with the normal there, from −1, the middle of a dark stripe, to 1, the middle of a light one.
/// It is continuous where the normals are, but where the eye sees along the tubes, so that it may be interpolated over triangles
/// that are small against the stripes. A normal and its opposite reflect alike. Where a normal has no length the value is 0.
///
/// # Errors
/// Not one normal for each point (`normals`), what is not finite (`points[i]`, `normals[i]`, `eye`, `stripes.turn_rad`), a
/// direction of no length (`eye`, `stripes.direction`), or no stripe (`stripes.count`).
pub fn zebra(points: &[DVec3], normals: &[DVec3], eye: Eye, stripes: &Stripes) -> Result<Vec<f64>> {
    check_finite("points", points)?;
    check_finite("normals", normals)?;
    if normals.len() != points.len() {
        let reason = format!("expected one for each of {} points, found {}", points.len(), normals.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("normals"));
    }
    let unit = |name: &str, direction: DVec3| {
        let reason = || format!("expected a vector with a direction, found {direction}");
        direction.try_normalize().ok_or_else(|| Error::new(Status::InvalidValue, reason()).at(name))
    };
    let l = unit("stripes.direction", stripes.direction)?;
    finite("stripes.turn_rad", stripes.turn_rad)?;
    if stripes.count == 0 {
        return Err(Error::new(Status::InvalidValue, "expected at least 1, found 0").at("stripes.count"));
    }
    let eye = match eye {
        Eye::At(point) if !point.is_finite() => {
            let reason = format!("expected a finite point, found {point}");
            return Err(Error::new(Status::InvalidValue, reason).at("eye"));
        }
        Eye::Along(direction) => Eye::Along(unit("eye", direction)?),
        Eye::At(_) => eye,
    };
    let (a, b) = l.any_orthonormal_pair();
    let value = |(&point, &normal): (&DVec3, &DVec3)| {
        let sight = match eye {
            Eye::At(eye) => (point - eye).normalize_or_zero(),
            Eye::Along(direction) => direction,
        };
        let Some(normal) = normal.try_normalize() else { return 0.0 };
        let reflected = sight - 2.0 * sight.dot(normal) * normal;
        let angle = reflected.dot(b).atan2(reflected.dot(a)) + stripes.turn_rad;
        (f64::from(stripes.count) * angle).cos()
    };
    Ok(points.iter().zip(normals).map(value).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_about_the_tubes_direction_has_twice_their_number_evenly_spread() {
        // Around the cylinder normals turn by t, and reflections of a parallel view by 2 t: the value is cos(2 · count · t + c).
        let normals: Vec<DVec3> =
            (0..1000).map(|i| f64::from(i) * 1e-3).map(|t| DVec3::new(0.0, t.cos(), t.sin())).collect();
        let stripes = Stripes { count: 6, ..Stripes::default() };
        let found = zebra(&normals, &normals, Eye::Along(DVec3::new(0.3, -1.0, 0.2)), &stripes).unwrap();
        let phase = found[0].acos();
        for sign in [-1.0, 1.0] {
            let worst = (0..1000).map(|i| (found[i] - (12.0 * i as f64 * 1e-3 + sign * phase).cos()).abs());
            let other = (0..1000).map(|i| (found[i] - (-12.0 * i as f64 * 1e-3 + sign * phase).cos()).abs());
            if worst.fold(0.0, f64::max) < 1e-9 || other.fold(0.0, f64::max) < 1e-9 {
                return;
            }
        }
        panic!("{:?}", &found[..20]);
    }

    #[test]
    fn a_kink_breaks_stripes_and_a_smooth_joint_does_not() {
        let along = |x: f64| DVec3::new(x, 0.1, 0.0);
        let points: Vec<DVec3> = (0..100).map(|i| along(f64::from(i) / 99.0)).collect();
        let normals = |kink: f64| -> Vec<DVec3> {
            let turn = |p: &DVec3| 0.3 * p.x + if p.x > 0.5 { kink } else { 0.0 };
            points.iter().map(|p| DVec3::new(0.1, turn(p).sin(), turn(p).cos())).collect()
        };
        let jump = |kink: f64| {
            let found = zebra(&points, &normals(kink), Eye::At(DVec3::new(0.0, -1.0, 4.0)), &Stripes::default());
            found.unwrap().windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
        };
        assert!(jump(0.0) < 0.2, "{}", jump(0.0));
        assert!(jump(0.035) > 0.5, "{}", jump(0.035));
        let flipped: Vec<DVec3> = normals(0.1).iter().map(|n| -3.0 * *n).collect();
        let eye = Eye::At(DVec3::new(0.0, -1.0, 4.0));
        let [a, b] = [&normals(0.1), &flipped].map(|n| zebra(&points, n, eye, &Stripes::default()).unwrap());
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn bad_arguments_are_named() {
        let place = |normals: &[DVec3], eye, stripes: Stripes| {
            zebra(&[DVec3::ZERO], normals, eye, &stripes).unwrap_err().place().to_owned()
        };
        let (up, eye) = ([DVec3::Z], Eye::Along(DVec3::X));
        assert_eq!(place(&[], eye, Stripes::default()), "normals");
        assert_eq!(place(&up, Eye::Along(DVec3::ZERO), Stripes::default()), "eye");
        assert_eq!(place(&up, Eye::At(DVec3::NAN), Stripes::default()), "eye");
        assert_eq!(place(&up, eye, Stripes { count: 0, ..Stripes::default() }), "stripes.count");
        assert_eq!(place(&up, eye, Stripes { direction: DVec3::ZERO, ..Stripes::default() }), "stripes.direction");
        assert_eq!(place(&up, eye, Stripes { turn_rad: f64::NAN, ..Stripes::default() }), "stripes.turn_rad");
        let nowhere = zebra(&[DVec3::ZERO], &up, Eye::At(DVec3::ZERO), &Stripes::default()).unwrap();
        assert!(nowhere[0].is_finite());
    }
}
