//! Where to look at a mesh from: z is up, the long side lies across, and the faces are seen rather from the front.

use glam::{DVec2, DVec3};

/// The eye's distance from the middle over the radius of the model: far enough to bend no straight edge visibly.
const DISTANCE: f64 = 6.0;

/// How far the view is turned from the long side, in radians; the one that shows the faces best is taken, of equals the
/// last.
const TURNS_RAD: [f64; 4] = [-0.65, 0.65, -0.4, 0.4];

/// Heights of the eye over the horizon, in radians.
const HEIGHTS_RAD: [f64; 2] = [0.42, 0.7];

/// A view of the model. Screen coordinates: x to the right, y up, in units of the model.
#[derive(Clone, Debug)]
pub struct Camera {
    middle: DVec3,
    radius: f64,
    right: DVec3,
    up: DVec3,
    /// From the model to the eye.
    toward: DVec3,
}

impl Camera {
    /// A view that fits `points`; `normals` are those of the faces, of any length.
    pub fn fitting(points: &[DVec3], normals: &[DVec3]) -> Self {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = if points.is_empty() { DVec3::ZERO } else { low.midpoint(high) };
        let farthest = points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
        let radius = if farthest > 0.0 && farthest.is_finite() { farthest } else { 1.0 };
        let long_side = long_side_rad(points, middle, radius);
        let candidates = HEIGHTS_RAD.iter().flat_map(|&height| TURNS_RAD.iter().map(move |&turn| (height, turn)));
        let views = candidates.map(|(height, turn)| Self::looking(middle, radius, long_side + turn, height));
        let best = views.max_by(|a, b| a.frontality(normals).total_cmp(&b.frontality(normals)));
        best.unwrap_or_else(|| Self::looking(middle, radius, 0.0, HEIGHTS_RAD[0]))
    }

    /// `azimuth` turns the screen's x axis from the model's, `height` lifts the eye.
    fn looking(middle: DVec3, radius: f64, azimuth_rad: f64, height_rad: f64) -> Self {
        let right = DVec3::new(azimuth_rad.cos(), azimuth_rad.sin(), 0.0);
        let ahead = DVec3::Z.cross(right);
        let toward = height_rad.sin() * DVec3::Z - height_rad.cos() * ahead;
        Self { middle, radius, right, up: toward.cross(right), toward }
    }

    /// How much of the faces is turned towards the eye: the mean sine of its height over them, not weighted by size.
    fn frontality(&self, normals: &[DVec3]) -> f64 {
        let seen = normals.iter().filter_map(|normal| normal.try_normalize()).map(|n| n.dot(self.toward).abs());
        seen.sum::<f64>()
    }

    /// The direction from the eye to the middle of the model.
    pub fn sight(&self) -> DVec3 {
        -self.toward
    }

    /// Where `point` is on the screen, and how near the eye it is.
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let offset = (point - self.middle) / self.radius;
        let nearness = offset.dot(self.toward);
        let magnification = DISTANCE / (DISTANCE - nearness).max(0.1);
        (self.radius * magnification * DVec2::new(offset.dot(self.right), offset.dot(self.up)), nearness)
    }

    /// How bright a face with this normal is, about 0.8 to 1, lit from over the left shoulder; its back is a little darker.
    pub fn light(&self, normal: DVec3) -> f64 {
        let Some(normal) = normal.try_normalize() else { return 1.0 };
        let lamp = (self.toward + 0.5 * self.up - 0.6 * self.right).normalize();
        let is_front = normal.dot(self.toward) >= 0.0;
        0.84 + 0.16 * normal.dot(lamp).abs() - if is_front { 0.0 } else { 0.04 }
    }
}

/// The direction in which the plan of the model is longest, as an angle from +x. For a square plan: +x.
fn long_side_rad(points: &[DVec3], middle: DVec3, radius: f64) -> f64 {
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for offset in points.iter().map(|&point| (point - middle) / radius) {
        xx += offset.x * offset.x;
        xy += offset.x * offset.y;
        yy += offset.y * offset.y;
    }
    // Below this share the plan has no long side, and round-off would choose one.
    let is_square = (xx - yy).hypot(2.0 * xy) < 0.02 * (xx + yy);
    if is_square { 0.0 } else { 0.5 * (2.0 * xy).atan2(xx - yy) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_long_side_lies_across() {
        // A plan five times as long in y as in x.
        let points: Vec<DVec3> = (0..60).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3), 0.0)).collect();
        let camera = Camera::fitting(&points, &[DVec3::Z]);
        let across = |direction: DVec3| (camera.project(direction).0 - camera.project(DVec3::ZERO).0).x.abs();
        assert!(across(DVec3::Y) > 1.5 * across(DVec3::X));
    }

    #[test]
    fn up_is_up_and_nearer_is_larger() {
        let points = [DVec3::ZERO, DVec3::new(4.0, 1.0, 2.0)];
        let camera = Camera::fitting(&points, &[]);
        let at = |point: DVec3| camera.project(point);
        assert!(at(DVec3::Z).0.y > at(DVec3::ZERO).0.y);
        assert!((at(DVec3::Z).0.x - at(DVec3::ZERO).0.x).abs() < 0.2);
    }

    #[test]
    fn a_point_and_nothing_have_a_view() {
        for points in [vec![], vec![DVec3::ONE], vec![DVec3::ONE; 3]] {
            let (screen, nearness) = Camera::fitting(&points, &[]).project(DVec3::ONE);
            assert!(screen.is_finite() && nearness.is_finite());
        }
        assert_eq!(Camera::fitting(&[], &[]).light(DVec3::ZERO), 1.0);
    }
}
