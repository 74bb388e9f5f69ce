//! The surface that a moving snake sweeps, and which arcs it is made of (Bartoň et al. 2013, sections 4.1 and 4.2).

use glam::DVec3;

use super::{ArcShape, Snake};
use crate::error::{Error, Result, Status};
use crate::mesh::grid::{Grid, check_finite_point};

/// Intervals of an arc at most.
pub(super) const MOST_INTERVALS: usize = 1 << 16;

/// The grid that the positions of a snake make, in row `i` the points along the snake at position `i`, each arc divided into
/// `per_arc` intervals. Where two arcs meet, tangents agree, so that rows are smooth curves. Rows wrap if the snake is closed,
/// columns if `comes_back`: the last position is followed by the first. All quads are there, see [`Grid::mesh`].
///
/// # Errors
/// Fewer than 2 positions, or 3 that come back (`frames`), one with another number of control points or with coordinates that are
/// not finite (`frames[i]`), a number of intervals that is 0 or above 65 536 (`per_arc`), more points than 32-bit indices hold
/// (`points`).
pub fn swept_grid(snake: &Snake, frames: &[Vec<DVec3>], per_arc: usize, comes_back: bool) -> Result<Grid> {
    check_intervals("per_arc", per_arc)?;
    let least = if comes_back { 3 } else { 2 };
    if frames.len() < least {
        let reason = format!("expected at least {least}, found {}", frames.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("frames"));
    }
    let columns = snake.shapes().len() * per_arc + usize::from(!snake.is_closed());
    if columns.checked_mul(frames.len()).is_none_or(|count| u32::try_from(count).is_err()) {
        let reason = format!("{} rows of {columns} points do not fit 32-bit indices", frames.len());
        return Err(Error::new(Status::TooLarge, reason).at("points"));
    }
    let mut points = Vec::with_capacity(columns * frames.len());
    for (i, frame) in frames.iter().enumerate() {
        let moved = snake.moved(frame.clone()).map_err(|error| of_frame(i, &error))?;
        points.extend(moved.sample(per_arc));
    }
    Grid::new(points, frames.len(), columns, [comes_back, snake.is_closed()])
}

/// An error in the control points of a position.
pub(super) fn of_frame(i: usize, error: &Error) -> Error {
    let place = format!("frames[{i}]{}", error.place().strip_prefix("control").unwrap_or_default());
    error.clone().with_place(place)
}

pub(super) fn check_intervals(name: &str, count: usize) -> Result<()> {
    if (1..=MOST_INTERVALS).contains(&count) {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected 1 to {MOST_INTERVALS}, found {count}")).at(name))
}

/// An arc that is to be made, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcKind {
    /// Its radius and length: the means of all that count as it.
    pub shape: ArcShape,
    /// How many there are of it.
    pub count: usize,
    /// Which ones, by their places in the list given.
    pub arcs: Vec<usize>,
}

impl ArcKind {
    pub(super) fn of(arcs: &[ArcShape], members: Vec<usize>) -> Self {
        let mean = |of: fn(&ArcShape) -> f64| members.iter().map(|&i| of(&arcs[i])).sum::<f64>() / members.len() as f64;
        let shape = ArcShape { radius: mean(|arc| arc.radius), length: mean(|arc| arc.length) };
        Self { shape, count: members.len(), arcs: members }
    }
}

/// The different arcs among `arcs`, as of one snake ([`Snake::shapes`]) or of many, in the order in which each comes first. Arcs
/// count as one if radii and lengths are both within `tolerance` of the first's, relative to its.
///
/// All positions of an evolving snake have the same arcs: those of `n` positions are the kinds of one, each `n` times.
///
/// # Errors
/// A tolerance that is negative or not finite (`tolerance`), a radius or a length that is not above 0 or not finite (`arcs[i]`).
pub fn arc_kinds(arcs: &[ArcShape], tolerance: f64) -> Result<Vec<ArcKind>> {
    if !(tolerance >= 0.0 && tolerance.is_finite()) {
        let reason = format!("expected a finite number of at least 0, found {tolerance}");
        return Err(Error::new(Status::InvalidValue, reason).at("tolerance"));
    }
    let is_positive = |value: f64| value > 0.0 && value.is_finite();
    if let Some(i) = arcs.iter().position(|arc| !(is_positive(arc.radius) && is_positive(arc.length))) {
        let reason =
            format!("expected a finite radius and length above 0, found {} and {}", arcs[i].radius, arcs[i].length);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("arcs[{i}]")));
    }
    let mut kinds: Vec<Vec<usize>> = Vec::new();
    let is_near = |a: f64, b: f64| (a - b).abs() <= tolerance * b;
    for (i, arc) in arcs.iter().enumerate() {
        let is_same = |kind: &&mut Vec<usize>| {
            let first = arcs[kind[0]];
            is_near(arc.radius, first.radius) && is_near(arc.length, first.length)
        };
        match kinds.iter_mut().find(is_same) {
            Some(kind) => kind.push(i),
            None => kinds.push(vec![i]),
        }
    }
    Ok(kinds.into_iter().map(|members| ArcKind::of(arcs, members)).collect())
}

/// Refuses a direction of a sample that is none.
pub(super) fn check_direction(name: &str, direction: DVec3) -> Result<DVec3> {
    check_finite_point(name, direction)?;
    direction
        .try_normalize()
        .ok_or_else(|| Error::new(Status::InvalidValue, format!("expected a direction, found {direction}")).at(name))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::ops::ControlFlow;

    use glam::DMat3;

    use super::*;
    use crate::geometry::snakes::Pose;
    use crate::geometry::snakes::cycle::cycle;

    /// The circle of radius `tube` about (`radius`, 0, 0) in the xz plane, of five arcs.
    fn circle(radius: f64, tube: f64) -> Snake {
        let half = TAU / 10.0;
        let at = |i: i32| {
            let (sine, cosine) = (2.0 * half * f64::from(i)).sin_cos();
            DVec3::new(radius + tube / half.cos() * cosine, 0.0, tube / half.cos() * sine)
        };
        Snake::new((0..5).map(at).collect(), true, None).unwrap()
    }

    #[test]
    fn a_circle_sweeps_a_torus() {
        let snake = circle(3.0, 1.0);
        let count = 24;
        let frames: Vec<Vec<DVec3>> = (0..count)
            .map(|i| {
                let turn = DMat3::from_rotation_z(TAU * f64::from(i) / f64::from(count));
                snake.control().iter().map(|p| turn * *p).collect()
            })
            .collect();
        let grid = swept_grid(&snake, &frames, 4, true).unwrap();
        assert_eq!((grid.rows(), grid.columns(), grid.wraps()), (24, 20, [true, true]));
        for p in grid.points() {
            assert!(((p.x.hypot(p.y) - 3.0).hypot(p.z) - 1.0).abs() < 1e-14);
        }
        let mesh = grid.mesh();
        assert_eq!((mesh.points.len(), mesh.faces.len()), (480, 480));
        // Frames come back from the grid: contacts are every fourth point of a row.
        for (i, frame) in frames.iter().enumerate() {
            let contacts = snake.moved(frame.clone()).unwrap().contacts();
            assert!(contacts.iter().enumerate().all(|(j, contact)| grid.at(i, 4 * j).distance(*contact) < 1e-14));
        }
        // Only one arc is needed, for all positions.
        let all: Vec<ArcShape> = frames.iter().flat_map(|_| snake.shapes().to_vec()).collect();
        let kinds = arc_kinds(&all, 1e-9).unwrap();
        assert_eq!((kinds.len(), kinds[0].count), (1, 120));
        assert!((kinds[0].shape.radius - 1.0).abs() < 1e-14 && (kinds[0].shape.length - TAU / 5.0).abs() < 1e-14);
    }

    #[test]
    fn an_open_snake_sweeps_an_open_grid() {
        let shape = ArcShape { radius: 2.0, length: 1.0 };
        let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
        let snake = Snake::from_arcs(&[shape; 3], &[0.5, -0.4], &pose).unwrap();
        let frames: Vec<Vec<DVec3>> =
            (0..4).map(|i| snake.control().iter().map(|p| *p + f64::from(i) * DVec3::Z).collect()).collect();
        let grid = swept_grid(&snake, &frames, 5, false).unwrap();
        assert_eq!((grid.rows(), grid.columns(), grid.wraps(), grid.quads().count()), (4, 16, [false, false], 45));
        let last = snake.control()[4];
        assert!(grid.at(3, 15).distance(last + 3.0 * DVec3::Z) < 1e-14);
        let refused = |frames: &[Vec<DVec3>], per_arc, comes_back| {
            swept_grid(&snake, frames, per_arc, comes_back).unwrap_err().place().to_owned()
        };
        assert_eq!(refused(&frames, 0, false), "per_arc");
        assert_eq!(refused(&frames[..1], 3, false), "frames");
        assert_eq!(refused(&frames[..2], 3, true), "frames");
        let mut bad = frames.clone();
        bad[2][1] = DVec3::NAN;
        assert_eq!(refused(&bad, 3, false), "frames[2][1]");
        bad[2].pop();
        assert_eq!(refused(&bad, 3, false), "frames[2]");
    }

    #[test]
    fn the_motion_of_a_linkage_sweeps_a_surface_that_comes_back() {
        let linkage = crate::geometry::snakes::linkage::tests::six_arcs();
        let motion = cycle(&linkage, &Default::default(), &mut |_| ControlFlow::Continue(())).unwrap();
        let grid = swept_grid(linkage.snake(), &motion.frames, 8, true).unwrap();
        assert_eq!((grid.rows(), grid.columns(), grid.wraps()), (motion.frames.len(), 49, [true, false]));
        // All rows are of one length: chords of arcs of 60 degrees in eight parts.
        let chord = 2.0 * (TAU / 96.0).sin();
        for i in 0..grid.rows() {
            assert!(grid.row(i).windows(2).all(|pair| (pair[0].distance(pair[1]) - chord).abs() < 1e-13));
            // The end arcs turn about their hinges: all points of theirs keep the distance from the fixed points.
            let apart = |j: usize, point: DVec3| grid.at(i, j).distance(point) - grid.at(0, j).distance(point);
            assert!(apart(5, linkage.snake().control()[1]).abs() < 1e-13);
        }
        let paths = motion.contact_paths().unwrap();
        assert!((0..grid.rows()).all(|i| grid.at(i, 24).distance(paths[3][i]) < 1e-14));
    }

    #[test]
    fn arcs_are_counted_by_kind() {
        let arc = |radius, length| ArcShape { radius, length };
        let arcs =
            [arc(1.0, 0.5), arc(2.0, 0.5), arc(1.0 + 1e-7, 0.5), arc(1.0, 0.5 - 1e-7), arc(2.0, 0.6), arc(2.0, 0.5)];
        let kinds = arc_kinds(&arcs, 1e-6).unwrap();
        let found: Vec<(usize, &[usize])> = kinds.iter().map(|kind| (kind.count, kind.arcs.as_slice())).collect();
        assert_eq!(found, [(3, &[0, 2, 3][..]), (2, &[1, 5]), (1, &[4])]);
        assert!((kinds[0].shape.radius - 1.0 - 1e-7 / 3.0).abs() < 1e-15);
        assert_eq!(arc_kinds(&arcs, 0.0).unwrap().len(), 5);
        assert_eq!(arc_kinds(&[], 0.1).unwrap(), []);
        assert_eq!(arc_kinds(&arcs, -1.0).unwrap_err().place(), "tolerance");
        assert_eq!(arc_kinds(&[arc(1.0, 1.0), arc(f64::NAN, 1.0)], 0.1).unwrap_err().place(), "arcs[1]");
    }
}
