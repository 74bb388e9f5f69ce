//! Cyclidic patches: the piece of a Dupin cyclide over a circular quad with a frame.
//!
//! The frame's tangents at corner `x00` fix two boundary arcs, `x00 → x10` and `x00 → x01`; the frames at the other corners,
//! handed on by reflection, fix the other two. The lines of curvature inside are circular arcs, and any four of them cut out a
//! circular quad with a frame of the same family: that is how a patch is evaluated, and how a net is refined. Written with
//! `second_point` of two circles that share a point and a sphere:
//!
//! 1. `p` on the arc `x00 → x10`; the circle of direction 2 through it has the reflected tangent.
//! 2. `q` across on the arc `x01 → x11`: where it meets the circle through `x00`, `x01`, `p` again.
//! 3. `r` on the arc `x00 → x01`.
//! 4. The point itself: where the arc `p → q` meets the circle through `x00`, `p`, `r` again.
//!
//! Neither needs a choice of a root. Source: Bobenko & Huhnen-Venedey 2012, as cited in section 2.1.

use glam::DVec3;

use super::frame::{Direction, Frame};
use crate::geometry::circle::{Arc, second_point};

/// A cyclidic patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// `x00`, `x10`, `x11`, `x01`: as [`Grid::corners`](crate::mesh::Grid::corners) has them.
    pub corners: [DVec3; 4],
    /// The frame at `x00`.
    pub frame: Frame,
}

impl Patch {
    /// The boundary arc of direction 1 that starts at `x00`.
    pub fn arc_one(&self) -> Arc {
        let [x00, x10, ..] = self.corners;
        Arc { start: x00, tangent: self.frame.t1, end: x10 }
    }

    /// The boundary arc of direction 2 that starts at `x00`.
    pub fn arc_two(&self) -> Arc {
        let [x00, _, _, x01] = self.corners;
        Arc { start: x00, tangent: self.frame.t2, end: x01 }
    }

    /// The boundary arc of direction 1 that starts at `x01`.
    pub fn far_arc_one(&self) -> Arc {
        let [x00, _, x11, x01] = self.corners;
        Arc { start: x01, tangent: self.frame.across(x01 - x00, Direction::Two).t1, end: x11 }
    }

    /// The boundary arc of direction 2 that starts at `x10`.
    pub fn far_arc_two(&self) -> Arc {
        let [x00, x10, x11, _] = self.corners;
        Arc { start: x10, tangent: self.frame.across(x10 - x00, Direction::One).t2, end: x11 }
    }

    /// Whether one of the boundary arcs runs through infinity: the patch cannot be evaluated.
    pub fn runs_through_infinity(&self) -> bool {
        [self.arc_one(), self.arc_two(), self.far_arc_one(), self.far_arc_two()].iter().any(Arc::runs_through_infinity)
    }

    /// The point of the arc `x01 → x11` on the line of curvature through `p`, a point of the arc `x00 → x10`.
    pub fn across_two(&self, p: DVec3) -> DVec3 {
        let [x00, x10, x11, x01] = self.corners;
        if p == x00 || p == x10 {
            return if p == x00 { x01 } else { x11 };
        }
        second_point(x01, x00, p, self.far_arc_one().tangent, x11)
    }

    /// The point of the arc `x10 → x11` on the line of curvature through `r`, a point of the arc `x00 → x01`.
    pub fn across_one(&self, r: DVec3) -> DVec3 {
        let [x00, x10, x11, x01] = self.corners;
        if r == x00 || r == x01 {
            return if r == x00 { x10 } else { x11 };
        }
        second_point(x10, x00, r, self.far_arc_two().tangent, x11)
    }

    /// The point where the lines of curvature through `p` on the arc `x00 → x10` and `r` on the arc `x00 → x01` meet; `q` is
    /// [`Patch::across_two`] of `p`.
    pub fn inside(&self, p: DVec3, q: DVec3, r: DVec3) -> DVec3 {
        let [x00, .., x01] = self.corners;
        if p == x00 || r == x00 {
            return if p == x00 { r } else { p };
        }
        if r == x01 {
            return q;
        }
        second_point(p, x00, r, self.frame.across(p - x00, Direction::One).t2, q)
    }

    /// The frame at `point`, reached from `x00` through `p` on the arc `x00 → x10`.
    pub fn frame_at(&self, p: DVec3, point: DVec3) -> Frame {
        self.frame.across(p - self.corners[0], Direction::One).across(point - p, Direction::Two)
    }

    /// The point and frame at the fractions `u` of the arc `x00 → x10` and `v` of the arc `x00 → x01`, each 0 to 1.
    pub fn at(&self, u: f64, v: f64) -> (DVec3, Frame) {
        let (p, r) = (self.arc_one().point(u), self.arc_two().point(v));
        let point = self.inside(p, self.across_two(p), r);
        (point, self.frame_at(p, point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;

    fn patch(cyclide: &Cyclide, u: [f64; 2], v: [f64; 2]) -> Patch {
        let corners = [(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])].map(|(u, v)| cyclide.point(u, v));
        Patch { corners, frame: cyclide.frame(u[0], v[0]) }
    }

    #[test]
    fn a_patch_lies_on_the_cyclide_through_its_corners() {
        let cyclide = Cyclide::new();
        let patch = patch(&cyclide, [0.2, 1.5], [-0.4, 1.3]);
        for i in 0..9 {
            for j in 0..9 {
                let (u, v) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                let (point, frame) = patch.at(u, v);
                assert!(cyclide.distance(point).abs() < 1e-13, "{}", cyclide.distance(point));
                // The normal is the gradient of the distance.
                let h = 1e-5;
                let slope = |t: DVec3| (cyclide.distance(point + h * t) - cyclide.distance(point - h * t)) / (2.0 * h);
                assert!(slope(frame.t1).abs() < 1e-8 && slope(frame.t2).abs() < 1e-8);
                // Swapping the directions gives the same point.
                let [x00, x10, x11, x01] = patch.corners;
                let Frame { t1, t2, normal } = patch.frame;
                let swapped = Patch { corners: [x00, x01, x11, x10], frame: Frame { t1: t2, t2: t1, normal: -normal } };
                assert!(swapped.at(v, u).0.distance(point) < 3e-14);
            }
        }
        assert_eq!([patch.at(0.0, 0.0).0, patch.at(1.0, 0.0).0], [patch.corners[0], patch.corners[1]]);
        assert_eq!([patch.at(1.0, 1.0).0, patch.at(0.0, 1.0).0], [patch.corners[2], patch.corners[3]]);
    }

    #[test]
    fn neighbours_share_points_and_normals_along_their_arc() {
        let cyclide = Cyclide::new();
        // Neighbours in direction 2 that are on two cyclides: the second quad is moved along its own circle.
        let first = patch(&cyclide, [0.2, 0.9], [-0.4, 0.3]);
        let [_, _, x11, x01] = first.corners;
        let frame = first.frame.across(x01 - first.corners[0], Direction::Two);
        let beyond = crate::geometry::circle::Circle::through(x01, x11, cyclide.point(0.5, 1.4)).unwrap();
        let second = Patch { corners: [x01, x11, beyond.point_at(x01, -2.0), beyond.point_at(x01, -0.7)], frame };
        for k in 1..8 {
            let p = first.arc_one().point(f64::from(k) / 8.0);
            let q = first.across_two(p);
            let arc = second.arc_one();
            let other = arc.point(arc.fraction_of(q));
            assert!(q.distance(other) < 1e-12);
            let normals = [first.frame_at(p, q).normal, second.frame.across(q - x01, Direction::One).normal];
            assert!(normals[0].distance(normals[1]) < 1e-12);
        }
    }

    #[test]
    fn flat_and_straight_patches_are_no_exceptions() {
        let frame = Frame { t1: DVec3::X, t2: DVec3::Y, normal: DVec3::Z };
        let rectangle = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::Y];
        let patch = Patch { corners: rectangle, frame };
        let (point, at) = patch.at(0.25, 0.5);
        assert!(point.distance(DVec3::new(0.5, 0.5, 0.0)) < 1e-15 && at.distance(&frame) < 1e-15);
        // Polar coordinates: rays are straight, circles concentric, all in one plane.
        let (s, c) = 1.0_f64.sin_cos();
        let sector = [DVec3::X, 3.0 * DVec3::X, DVec3::new(3.0 * c, 3.0 * s, 0.0), DVec3::new(c, s, 0.0)];
        let (point, _) = Patch { corners: sector, frame }.at(0.5, 0.5);
        assert!(point.distance(2.0 * DVec3::new(0.5_f64.cos(), 0.5_f64.sin(), 0.0)) < 1e-14);
        let backwards = Frame { t1: DVec3::NEG_X, t2: DVec3::NEG_Y, normal: DVec3::Z };
        assert!(Patch { corners: rectangle, frame: backwards }.runs_through_infinity());
    }
}
