//! A circular arc in space.

use glam::DVec3;

use crate::mesh::fit::Circle;

/// A circular arc, run through from its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Its circle; the arc turns counterclockwise about the circle's normal.
    pub circle: Circle,
    /// Where it begins.
    pub start: DVec3,
    /// The angle that it turns by, in radians, above 0 and below π.
    pub angle_rad: f64,
}

impl Arc {
    /// The point at a part of its length, 0 to 1.
    pub fn point(&self, part: f64) -> DVec3 {
        let (x, y) = self.axes();
        let (sine, cosine) = (part * self.angle_rad).sin_cos();
        self.circle.center + cosine * x + sine * y
    }

    /// The unit tangent at a part of its length.
    pub fn tangent(&self, part: f64) -> DVec3 {
        let (x, y) = self.axes();
        let (sine, cosine) = (part * self.angle_rad).sin_cos();
        (cosine * y - sine * x) / self.circle.radius
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.circle.radius * self.angle_rad
    }

    /// The distance from a point to the arc: to its circle where the foot is on it, else to an end.
    pub fn distance(&self, point: DVec3) -> f64 {
        let (x, y) = self.axes();
        let from = point - self.circle.center;
        let angle = from.dot(y).atan2(from.dot(x));
        if (0.0..=self.angle_rad).contains(&angle) {
            return self.circle.distance(point);
        }
        point.distance(self.start).min(point.distance(self.point(1.0)))
    }

    /// From the centre to the start, and a quarter of a turn after it.
    fn axes(&self) -> (DVec3, DVec3) {
        let x = self.start - self.circle.center;
        (x, self.circle.normal.cross(x))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_quarter_of_a_circle() {
        let circle = Circle { center: DVec3::new(1.0, 0.0, 2.0), normal: DVec3::Z, radius: 2.0 };
        let arc = Arc { circle, start: DVec3::new(3.0, 0.0, 2.0), angle_rad: FRAC_PI_2 };
        assert!(arc.point(1.0).distance(DVec3::new(1.0, 2.0, 2.0)) < 1e-15);
        assert!(arc.tangent(0.0).distance(DVec3::Y) < 1e-15 && arc.tangent(1.0).distance(DVec3::NEG_X) < 1e-15);
        assert!((arc.length() - std::f64::consts::PI).abs() < 1e-15);
        assert!((arc.distance(DVec3::new(1.0, 5.0, 6.0)) - 5.0).abs() < 1e-14);
        assert!((arc.distance(DVec3::new(3.0, -3.0, 6.0)) - 5.0).abs() < 1e-14);
        assert!((arc.distance(DVec3::new(1.0, 0.0, 2.0)) - 2.0).abs() < 1e-14);
    }
}
