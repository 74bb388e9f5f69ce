//! Frames at the points of a circular net, handed on by reflection.
//!
//! A cyclidic net is a circular net with an orthonormal frame at one point: tangents of the two lines of curvature and the normal.
//! Across an edge the frame is mirrored in the plane that bisects the edge, since an arc makes the same angle with its chord at
//! both ends; the mirrored tangent along the edge then points backwards and is turned round. Around a circular quad the four
//! bisecting planes share the axis of its circle, and the frame comes back to itself. So it may be handed on along any path:
//! here along row 0, then down the columns, and every face is checked. Source: Bobenko & Huhnen-Venedey 2012, as cited in section
//! 2.2; the rule is derived here and verified by the tests.
//!
//! The paper speaks of two angles; an orthonormal frame has three degrees of freedom, so that a circular net carries a
//! three-parameter family of cyclidic nets.

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, Status};
use crate::geometry::circle::reflect;
use crate::mesh::Grid;

/// How far a frame may come back from itself around a face, as a difference of unit vectors.
const NOT_CIRCULAR: f64 = 1e-10;

/// The directions of a grid: 1 from row to row (along a guide curve), 2 from column to column (along a section).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From row to row.
    One,
    /// From column to column.
    Two,
}

/// A right-handed orthonormal frame: the unit tangents of both directions and the normal `t1 × t2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Along direction 1.
    pub t1: DVec3,
    /// Along direction 2.
    pub t2: DVec3,
    /// The normal.
    pub normal: DVec3,
}

impl Frame {
    /// The frame with the tangent `t2` of direction 2 whose normal is as near as possible to `normal`; `None` where the two
    /// are parallel.
    pub fn of_tangent_two(t2: DVec3, normal: DVec3) -> Option<Self> {
        let t2 = t2.try_normalize()?;
        let normal = normal.reject_from_normalized(t2).try_normalize()?;
        Some(Self { t1: t2.cross(normal), t2, normal })
    }

    /// The frame with the tangent `t1` of direction 1 whose normal is as near as possible to `normal`; `None` where the two
    /// are parallel.
    pub fn of_tangent_one(t1: DVec3, normal: DVec3) -> Option<Self> {
        let t1 = t1.try_normalize()?;
        let normal = normal.reject_from_normalized(t1).try_normalize()?;
        Some(Self { t1, t2: normal.cross(t1), normal })
    }

    /// The frame whose normal has the spherical coordinates `theta` (from +z, 0 to π) and `lambda` (from +x about +z), both in
    /// radians, turned about it by `psi`. At `psi` 0 the first tangent is the direction of growing `lambda`.
    pub fn of_angles(lambda: f64, theta: f64, psi: f64) -> Self {
        let ((sl, cl), (st, ct)) = (lambda.sin_cos(), theta.sin_cos());
        let normal = DVec3::new(st * cl, st * sl, ct);
        let (east, north) = (DVec3::new(-sl, cl, 0.0), DVec3::new(-ct * cl, -ct * sl, st));
        let (sp, cp) = psi.sin_cos();
        let t1 = cp * east + sp * north;
        Self { t1, t2: normal.cross(t1), normal }
    }

    /// The frame at the other end of an edge; the same one where the edge has no length.
    pub fn across(&self, edge: DVec3, direction: Direction) -> Self {
        if edge == DVec3::ZERO {
            return *self;
        }
        let [t1, t2, normal] = [self.t1, self.t2, self.normal].map(|v| reflect(v, edge));
        match direction {
            Direction::One => Self { t1: -t1, t2, normal },
            Direction::Two => Self { t1, t2: -t2, normal },
        }
    }

    /// Turned about `t1`, right-handed.
    fn turned_about_one(self, angle_rad: f64) -> Self {
        if angle_rad == 0.0 {
            return self;
        }
        let (sine, cosine) = angle_rad.sin_cos();
        let t2 = cosine * self.t2 + sine * self.normal;
        Self { t1: self.t1, t2, normal: self.t1.cross(t2) }
    }

    /// Turned about `t2`, right-handed.
    fn turned_about_two(self, angle_rad: f64) -> Self {
        if angle_rad == 0.0 {
            return self;
        }
        let (sine, cosine) = angle_rad.sin_cos();
        let t1 = cosine * self.t1 - sine * self.normal;
        Self { t1, t2: self.t2, normal: t1.cross(self.t2) }
    }

    /// The columns `t1`, `t2`, `normal`.
    pub fn matrix(&self) -> DMat3 {
        DMat3::from_cols(self.t1, self.t2, self.normal)
    }

    /// The largest difference of two frames' vectors.
    pub fn distance(&self, other: &Self) -> f64 {
        let differences = [self.t1 - other.t1, self.t2 - other.t2, self.normal - other.normal];
        differences.map(DVec3::length).into_iter().fold(0.0, f64::max)
    }

    /// Refuses what is no right-handed orthonormal frame; the place is `name`.
    pub(crate) fn check(&self, name: &str) -> Result<()> {
        let error = self.matrix().transpose() * self.matrix() - DMat3::IDENTITY;
        let is_orthonormal = error.to_cols_array().iter().all(|entry| entry.abs() <= 1e-9);
        if is_orthonormal && self.matrix().determinant() > 0.0 {
            return Ok(());
        }
        let reason = format!("expected a right-handed orthonormal frame, found {self:?}");
        Err(Error::new(Status::InvalidValue, reason).at(name))
    }
}

/// A line of a net along which the surface is creased: it is continuous there, but its normals turn (C⁰ in the place of C¹).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// The direction in which it is crossed: `Two` for a column, `One` for a row.
    pub across: Direction,
    /// The column or row, neither the first nor beyond the last.
    pub line: usize,
    /// By how much the frames of the next patches are turned about the line's tangent.
    pub angle_rad: f64,
}

/// The frames at all points of a circular net, from that at point `(0, 0)`, row by row.
///
/// # Errors
/// As [`frames_with_kinks`].
pub fn frames(grid: &Grid, frame: Frame) -> Result<Vec<Frame>> {
    frames_with_kinks(grid, frame, &[])
}

/// The same for a net that is creased along columns, or along rows. The frame of a point is that of the patch whose first corner it is: on
/// a kink, the one beyond it. Its tangent along the line is that of both sides, so neighbouring patches have their arc in common.
/// (Turns about the tangents of both families do not commute: kinks of both would not close around the faces beyond them.)
///
/// # Errors
/// `frame` is not right-handed and orthonormal; kinks of both families, of a line that does not exist, or with an angle that is not
/// finite (`kinks[k]`). Status `NotCircular`: the frame does not come back to itself around a face; the
/// place is `faces[i]`. Directions that wrap are not followed across the seam: see [`closing_gap`].
pub fn frames_with_kinks(grid: &Grid, frame: Frame, kinks: &[Kink]) -> Result<Vec<Frame>> {
    frame.check("frame")?;
    let turns = Turns::new(grid, kinks)?;
    let frames = handed_on(grid, frame, &turns);
    let worst = (0..grid.rows() - 1)
        .flat_map(|i| (0..grid.columns() - 1).map(move |j| (i, j)))
        .map(|(i, j)| {
            // Down the columns is by construction; what can fail is the edge of the next row.
            let edge = grid.at(i + 1, j + 1) - grid.at(i + 1, j);
            let across =
                frames[grid.index(i + 1, j)].across(edge, Direction::Two).turned_about_one(turns.columns[j + 1]);
            (i * grid.spans()[1] + j, across.distance(&frames[grid.index(i + 1, j + 1)]))
        })
        .find(|(_, gap)| !(*gap <= NOT_CIRCULAR * (grid.rows() + grid.columns()) as f64));
    match worst {
        None => Ok(frames),
        Some((face, gap)) => {
            let reason = format!("expected corners on a circle; the frame comes back from it turned by {gap:e}");
            Err(Error::new(Status::NotCircular, reason).at(format!("faces[{face}]")))
        }
    }
}

/// The turn at each row and column; 0 where there is no kink.
pub(super) struct Turns {
    rows: Vec<f64>,
    columns: Vec<f64>,
}

impl Turns {
    pub(super) fn none(grid: &Grid) -> Self {
        Self { rows: vec![0.0; grid.rows()], columns: vec![0.0; grid.columns()] }
    }

    fn new(grid: &Grid, kinks: &[Kink]) -> Result<Self> {
        let mut turns = Self::none(grid);
        for (k, kink) in kinks.iter().enumerate() {
            let refuse = |reason: String| Err(Error::new(Status::InvalidValue, reason).at(format!("kinks[{k}]")));
            let lines = if kink.across == Direction::Two { &mut turns.columns } else { &mut turns.rows };
            if kink.line == 0 || kink.line >= lines.len() {
                return refuse(format!("expected a line from 1 to {}, found {}", lines.len() - 1, kink.line));
            }
            if !kink.angle_rad.is_finite() {
                return refuse(format!("expected a finite angle, found {}", kink.angle_rad));
            }
            if kink.across != kinks[0].across {
                return refuse("expected kinks of rows or of columns, found both".to_owned());
            }
            lines[kink.line] += kink.angle_rad;
        }
        Ok(turns)
    }
}

/// Along row 0 and down the columns, unchecked.
pub(super) fn handed_on(grid: &Grid, frame: Frame, turns: &Turns) -> Vec<Frame> {
    let mut frames = Vec::with_capacity(grid.points().len());
    frames.push(frame);
    for j in 1..grid.columns() {
        let edge = grid.at(0, j) - grid.at(0, j - 1);
        frames.push(frames[j - 1].across(edge, Direction::Two).turned_about_one(turns.columns[j]));
    }
    for i in 1..grid.rows() {
        for j in 0..grid.columns() {
            let edge = grid.at(i, j) - grid.at(i - 1, j);
            frames.push(frames[grid.index(i - 1, j)].across(edge, Direction::One).turned_about_two(turns.rows[i]));
        }
    }
    frames
}

/// How far frames come back from themselves across the seams of a grid that wraps, as a difference of unit vectors; 0 where
/// nothing wraps. The cyclidic net is smooth across a seam where this is 0.
pub fn closing_gap(grid: &Grid, frames: &[Frame]) -> f64 {
    let [wraps_rows, wraps_columns] = grid.wraps();
    let gap = |from: (usize, usize), to: (usize, usize), direction| {
        let edge = grid.at(to.0, to.1) - grid.at(from.0, from.1);
        frames[grid.index(from.0, from.1)].across(edge, direction).distance(&frames[grid.index(to.0, to.1)])
    };
    let rows = (0..grid.columns()).map(|j| gap((grid.rows() - 1, j), (0, j), Direction::One));
    let columns = (0..grid.rows()).map(|i| gap((i, grid.columns() - 1), (i, 0), Direction::Two));
    rows.filter(|_| wraps_rows).chain(columns.filter(|_| wraps_columns)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn a_frame_comes_back_around_circular_quads_only() {
        let mut random = Random(9);
        for _ in 0..1000 {
            let frame = Frame::of_angles(random.between(0.0, 6.0), random.between(0.0, 3.0), random.between(0.0, 6.0));
            let mut angles: [f64; 4] = std::array::from_fn(|_| random.between(0.0, std::f64::consts::TAU));
            angles.sort_by(f64::total_cmp);
            let normal = DVec3::from_array(std::array::from_fn(|_| random.between(-0.5, 0.5))).normalize();
            let (x, y) = (normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector()));
            let corners = angles.map(|angle| angle.cos() * x + angle.sin() * y);
            let gap = |corners: &[DVec3; 4]| {
                let directions = [Direction::One, Direction::Two, Direction::One, Direction::Two];
                let mut around = frame;
                for k in 0..4 {
                    around = around.across(corners[(k + 1) % 4] - corners[k], directions[k]);
                }
                around.distance(&frame)
            };
            // The direction of an edge that is short has lost digits.
            let shortest = (0..4).map(|k| corners[k].distance(corners[(k + 1) % 4])).fold(1.0, f64::min);
            assert!(gap(&corners) < 1e-13 / shortest, "{} {shortest}", gap(&corners));
            let mut lifted = corners;
            lifted[2] += 0.1 * normal;
            assert!(gap(&lifted) > 1e-6);
            let grid = |c: [DVec3; 4]| Grid::new(vec![c[0], c[3], c[1], c[2]], 2, 2, [false; 2]).unwrap();
            assert!(shortest < 1e-3 || frames(&grid(corners), frame).is_ok());
            let error = frames(&grid(lifted), frame).unwrap_err();
            assert_eq!((error.status(), error.place()), (Status::NotCircular, "faces[0]"));
        }
    }

    #[test]
    fn kinks_turn_normals_about_their_line_and_close_around_every_face() {
        let cyclide = crate::geometry::canal::cyclide::Cyclide::new();
        let grid = cyclide.grid([0.2, 1.8], [-0.5, 1.0], 5, 6);
        let smooth = frames(&grid, cyclide.frame(0.2, -0.5)).unwrap();
        for (across, line) in [(Direction::Two, 3), (Direction::One, 2)] {
            let kink = Kink { across, line, angle_rad: 0.4 };
            let kinked = frames_with_kinks(&grid, smooth[0], &[kink]).unwrap();
            for i in 0..5 {
                for j in 0..6 {
                    let (a, b) = (smooth[grid.index(i, j)], kinked[grid.index(i, j)]);
                    let (at, along) = if across == Direction::Two { (j, a.t1 - b.t1) } else { (i, a.t2 - b.t2) };
                    if at < line {
                        assert!(a.distance(&b) < 1e-13);
                    } else if at == line {
                        assert!((a.normal.angle_between(b.normal) - 0.4).abs() < 1e-12 && along.length() < 1e-13);
                    } else {
                        assert!(a.normal.angle_between(b.normal) > 0.01);
                    }
                }
            }
            // Around the faces beyond the kink the frames close too: `frames_with_kinks` checked along rows; here along columns.
            for (i, j) in (0..4).flat_map(|i| (1..6).map(move |j| (i, j))) {
                let edge = grid.at(i + 1, j) - grid.at(i, j);
                let down = kinked[grid.index(i, j)].across(edge, Direction::One);
                let is_kink = across == Direction::One && i + 1 == line;
                assert!(is_kink || down.distance(&kinked[grid.index(i + 1, j)]) < 1e-12);
            }
        }
        let place = |kinks: &[Kink]| frames_with_kinks(&grid, smooth[0], kinks).unwrap_err().place().to_owned();
        let kink = |across, line, angle_rad| Kink { across, line, angle_rad };
        assert_eq!(place(&[kink(Direction::Two, 6, 0.1)]), "kinks[0]");
        assert_eq!(place(&[kink(Direction::Two, 0, 0.1)]), "kinks[0]");
        assert_eq!(place(&[kink(Direction::Two, 1, 0.1), kink(Direction::One, 1, 0.1)]), "kinks[1]");
        assert_eq!(place(&[kink(Direction::One, 1, f64::NAN)]), "kinks[0]");
    }

    #[test]
    fn frames_are_checked_and_made_of_angles_and_tangents() {
        let mut random = Random(2);
        for _ in 0..20 {
            let frame = Frame::of_angles(random.between(0.0, 6.0), random.between(0.0, 3.0), random.between(0.0, 6.0));
            frame.check("frame").unwrap();
            assert!(Frame::of_tangent_two(3.0 * frame.t2, frame.normal + frame.t2).unwrap().distance(&frame) < 1e-14);
            assert!(Frame::of_tangent_one(3.0 * frame.t1, frame.normal - frame.t1).unwrap().distance(&frame) < 1e-14);
        }
        let frame = Frame::of_angles(0.0, 0.0, 0.0);
        assert!(frame.normal == DVec3::Z && frame.t1 == DVec3::Y);
        assert!(Frame::of_tangent_one(DVec3::X, DVec3::X).is_none());
        let mirrored = Frame { t1: -frame.t1, ..frame };
        assert!(mirrored.check("frame").unwrap_err().to_string().starts_with("frame: expected a right-handed"));
    }
}
