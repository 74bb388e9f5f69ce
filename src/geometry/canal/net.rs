//! Cyclidic nets: a circular net with its frames, and its refinement.

use glam::DVec3;

use super::frame::{self, Direction, Frame, Kink};
use super::patch::Patch;
use crate::error::{Error, Result, Status};
use crate::mesh::Grid;

/// How far the lines of a refined net may miss their own start where a direction wraps, over the diagonal.
const NOT_CLOSED: f64 = 1e-9;

/// Points of a refined net at most: what 32-bit indices and a few gigabytes hold.
const MOST_POINTS: usize = 1 << 26;

/// A circular net with a frame at each point.
#[derive(Clone, Debug, PartialEq)]
pub struct Net {
    grid: Grid,
    frames: Vec<Frame>,
    kinks: Vec<Kink>,
}

impl Net {
    /// The cyclidic net on a circular net with the given frame at point `(0, 0)`.
    ///
    /// # Errors
    /// As [`frame::frames`].
    pub fn new(grid: Grid, frame: Frame) -> Result<Self> {
        Self::with_kinks(grid, frame, &[])
    }

    /// The same, creased along some of its rows or columns: continuous there, but not smooth.
    ///
    /// # Errors
    /// As [`frame::frames_with_kinks`].
    pub fn with_kinks(grid: Grid, frame: Frame, kinks: &[Kink]) -> Result<Self> {
        let frames = frame::frames_with_kinks(&grid, frame, kinks)?;
        Ok(Self { grid, frames, kinks: kinks.to_vec() })
    }

    /// The image of this net: its points and frames.
    pub(super) fn with_image(&self, grid: Grid, frames: Vec<Frame>) -> Self {
        Self { grid, frames, kinks: self.kinks.clone() }
    }

    /// The points.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The frame at each point, row by row.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The rows or columns along which it is creased.
    pub fn kinks(&self) -> &[Kink] {
        &self.kinks
    }

    /// The patch over face `(i, j)`.
    ///
    /// # Errors
    /// `i` or `j` out of range.
    pub fn patch(&self, i: usize, j: usize) -> Result<Patch> {
        let [rows, columns] = self.grid.spans();
        for (name, at, count) in [("i", i, rows), ("j", j, columns)] {
            if at >= count {
                let reason = format!("{at} is out of range for {count} faces");
                return Err(Error::new(Status::IndexOutOfRange, reason).at(name));
            }
        }
        Ok(self.patch_at(i, j))
    }

    fn patch_at(&self, i: usize, j: usize) -> Patch {
        Patch { corners: self.grid.corners(i, j), frame: self.frames[self.grid.index(i, j)] }
    }

    /// The net whose faces are cut in `one` by `two` pieces along lines of curvature, at equal angles of the arcs of column 0
    /// and row 0. The points of this net are points of it, at multiples of `one` and `two`.
    ///
    /// # Errors
    /// As [`Net::refined_at`]; `one` or `two` is 0.
    pub fn refined(&self, one: usize, two: usize) -> Result<Self> {
        for (name, count) in [("one", one), ("two", two)] {
            if count == 0 {
                return Err(Error::new(Status::InvalidValue, "expected at least 1, found 0").at(name));
            }
        }
        let fractions = |count: usize| (1..count).map(|k| k as f64 / count as f64).collect::<Vec<f64>>();
        if self.count_refined(one, two).is_none() {
            let reason = format!("faces cut in {one} by {two} make more than {MOST_POINTS} points");
            return Err(Error::new(Status::TooLarge, reason).at("one, two"));
        }
        self.refined_at(&fractions(one), &fractions(two))
    }

    /// The rows and columns after cutting each face in `one` by `two`, unless they are too many.
    fn count_refined(&self, one: usize, two: usize) -> Option<(usize, usize)> {
        let [rows, columns] = self.grid.spans();
        let [wraps_rows, wraps_columns] = self.grid.wraps();
        let rows = rows.checked_mul(one)? + usize::from(!wraps_rows);
        let columns = columns.checked_mul(two)? + usize::from(!wraps_columns);
        (rows.checked_mul(columns)? <= MOST_POINTS).then_some((rows, columns))
    }

    /// The net whose faces are cut at the given fractions of the arcs of column 0 (`one`) and row 0 (`two`), ascending between
    /// 0 and 1.
    ///
    /// # Errors
    /// Fractions that are not so. Status `Degenerate`: a boundary arc of a patch runs through infinity; the place is `faces[i]`.
    /// `NotClosed`: a direction wraps, and its lines of curvature do not close.
    pub fn refined_at(&self, one: &[f64], two: &[f64]) -> Result<Self> {
        check_fractions("one", one)?;
        check_fractions("two", two)?;
        let counts = [one.len() + 1, two.len() + 1];
        let Some((rows, columns)) = self.count_refined(counts[0], counts[1]) else {
            let reason = format!("faces cut in {} by {} make more than {MOST_POINTS} points", counts[0], counts[1]);
            return Err(Error::new(Status::TooLarge, reason).at("one, two"));
        };
        let [row_spans, column_spans] = self.grid.spans();
        let mut points = vec![DVec3::NAN; rows * columns];
        let mut frames = vec![self.frames[0]; rows * columns];
        // Points between the corners on the arcs of direction 2 above the current row of faces.
        let mut above: Vec<Vec<DVec3>> = (0..column_spans)
            .map(|j| {
                let arc = self.patch_at(0, j).arc_two();
                two.iter().map(|&fraction| arc.point(fraction)).collect()
            })
            .collect();
        let first_above = above.clone();
        let mut gap = 0.0_f64;
        let farthest = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        for i in 0..row_spans {
            let arc = self.patch_at(i, 0).arc_one();
            let mut left: Vec<DVec3> = one.iter().map(|&fraction| arc.point(fraction)).collect();
            let first_left = left.clone();
            for j in 0..column_spans {
                let patch = self.patch_at(i, j);
                if patch.runs_through_infinity() {
                    let reason = "one of its arcs runs through infinity; another frame would not";
                    return Err(Error::new(Status::Degenerate, reason).at(format!("faces[{}]", i * column_spans + j)));
                }
                let [x00, x10, x11, x01] = patch.corners;
                let right: Vec<DVec3> = left.iter().map(|&p| patch.across_two(p)).collect();
                let below: Vec<DVec3> = above[j].iter().map(|&r| patch.across_one(r)).collect();
                let around = |first: DVec3, inner: &[DVec3], last: DVec3| [&[first], inner, &[last]].concat();
                let (p, q) = (around(x00, &left, x10), around(x01, &right, x11));
                let (r, s) = (around(x00, &above[j], x01), around(x10, &below, x11));
                // A patch writes its last lines only where no other begins there.
                let ends_row = i + 1 == row_spans && !self.grid.wraps()[0];
                let ends_column = j + 1 == column_spans && !self.grid.wraps()[1];
                for a in 0..counts[0] + usize::from(ends_row) {
                    for b in 0..counts[1] + usize::from(ends_column) {
                        let point = if a == counts[0] { s[b] } else { patch.inside(p[a], q[a], r[b]) };
                        let index = (i * counts[0] + a) * columns + j * counts[1] + b;
                        points[index] = point;
                        frames[index] = patch.frame_at(p[a], point);
                    }
                }
                above[j] = below;
                left = right;
            }
            if self.grid.wraps()[1] {
                gap = gap.max(farthest(&left, &first_left));
            }
        }
        if self.grid.wraps()[0] {
            gap = above.iter().zip(&first_above).map(|(a, b)| farthest(a, b)).fold(gap, f64::max);
        }
        let grid = Grid::new(points, rows, columns, self.grid.wraps())?;
        let diagonal = grid.diagonal();
        if gap > NOT_CLOSED * diagonal {
            let reason = format!("lines of curvature come back {gap:e} off their start; the diagonal is {diagonal}");
            return Err(Error::new(Status::NotClosed, reason));
        }
        let pieces = |across: Direction| counts[usize::from(across == Direction::Two)];
        let kinks = self.kinks.iter().map(|kink| Kink { line: kink.line * pieces(kink.across), ..*kink });
        Ok(Self { grid, frames, kinks: kinks.collect() })
    }
}

fn check_fractions(name: &str, fractions: &[f64]) -> Result<()> {
    let before = |k: usize| if k == 0 { 0.0 } else { fractions[k - 1] };
    match (0..fractions.len()).find(|&k| !(fractions[k] > before(k) && fractions[k] < 1.0)) {
        None => Ok(()),
        Some(k) => {
            let reason = format!("expected fractions that ascend between 0 and 1, found {}", fractions[k]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("{name}[{k}]")))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::quality::{Quality, largest};

    #[test]
    fn a_refined_net_lies_on_the_cyclide_of_the_coarse_one() {
        let cyclide = Cyclide::new();
        for (u, v) in
            [([0.1, 2.0], [-0.5, 1.0]), ([0.0, TAU], [-0.5, 1.0]), ([0.1, 2.0], [0.0, TAU]), ([0.0, TAU], [0.0, TAU])]
        {
            let net = cyclide.net(u, v, 7, 6);
            let fine = net.refined(3, 2).unwrap();
            assert_eq!(fine.grid().spans(), [3 * net.grid().spans()[0], 2 * net.grid().spans()[1]]);
            for (k, (&point, frame)) in fine.grid().points().iter().zip(fine.frames()).enumerate() {
                assert!(cyclide.distance(point).abs() < 1e-12, "{u:?} {v:?} {k}: {}", cyclide.distance(point));
                frame.check("frame").unwrap();
            }
            for i in 0..net.grid().rows() {
                for j in 0..net.grid().columns() {
                    assert!(fine.grid().at(3 * i, 2 * j).distance(net.grid().at(i, j)) < 1e-13);
                }
            }
            let Quality { planarity, concyclicity, .. } = Quality::of(fine.grid());
            assert!(largest(&planarity) < 1e-12 && largest(&concyclicity) < 1e-12);
            let gap = frame::closing_gap(fine.grid(), fine.frames());
            assert!(gap < 1e-12, "{gap}");
        }
    }

    #[test]
    fn a_ring_whose_frame_does_not_close_is_refused() {
        // A closed polygon in space that no sphere is parallel to: frames come back turned, and so do lines of curvature.
        let cyclide = Cyclide::new();
        let mut net = cyclide.net([0.0, TAU], [-0.5, 1.0], 7, 4);
        let turned = Frame::of_tangent_one(net.frames[0].t1 + 0.2 * net.frames[0].t2, net.frames[0].normal).unwrap();
        net = Net::new(net.grid, turned).unwrap();
        assert!(frame::closing_gap(net.grid(), net.frames()) > 1e-3);
        assert_eq!(net.refined(2, 2).unwrap_err().status(), Status::NotClosed);
        // Open, the same net is smooth.
        let open = Grid::new(net.grid.points().to_vec(), 7, 4, [false; 2]).unwrap();
        assert!(Net::new(open, turned).unwrap().refined(2, 2).is_ok());
    }

    #[test]
    fn across_a_kink_a_refined_net_is_continuous_circular_and_creased() {
        let cyclide = Cyclide::new();
        let grid = cyclide.grid([0.1, 2.0], [-0.5, 1.0], 5, 5);
        let kink = Kink { across: Direction::Two, line: 2, angle_rad: -0.5 };
        let net = Net::with_kinks(grid, cyclide.frame(0.1, -0.5), &[kink]).unwrap();
        let fine = net.refined(3, 4).unwrap();
        let Quality { planarity, concyclicity, .. } = Quality::of(fine.grid());
        assert!(largest(&planarity) < 1e-11 && largest(&concyclicity) < 1e-11);
        let again = Net::with_kinks(fine.grid().clone(), fine.frames()[0], fine.kinks()).unwrap();
        assert!(again.frames().iter().zip(fine.frames()).all(|(a, b)| a.distance(b) < 1e-11));
        // On the cyclide before the kink, off it beyond.
        for i in 0..fine.grid().rows() {
            assert!((0..=8).all(|j| cyclide.distance(fine.grid().at(i, j)).abs() < 1e-12));
            assert!((9..12).all(|j| cyclide.distance(fine.grid().at(i, j)).abs() > 1e-4));
        }
    }

    #[test]
    fn fractions_and_indices_are_checked() {
        let net = Cyclide::new().net([0.2, 1.0], [0.0, 1.0], 3, 3);
        let place = |result: Result<Net>| result.unwrap_err().place().to_owned();
        assert_eq!(place(net.refined(0, 1)), "one");
        assert_eq!(place(net.refined(1, usize::MAX)), "one, two");
        assert_eq!(place(net.refined_at(&[0.5, 0.5], &[])), "one[1]");
        assert_eq!(place(net.refined_at(&[], &[f64::NAN])), "two[0]");
        assert_eq!(net.patch(0, 2).unwrap_err().to_string(), "j: 2 is out of range for 2 faces");
        assert_eq!(net.refined(1, 1).unwrap().grid(), net.grid());
    }
}
