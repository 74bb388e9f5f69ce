//! Pipes and lamellae along a snake: the tubular and the laminar covering of a surface (Bartoň et al. 2013, figure 2).
//!
//! A pipe is a piece of a torus around each arc. Points of a section go straight on to the next: along an arc a section turns about
//! the axis of the arc's circle, which is the motion that does not turn about the tangent. Around a closed snake that leaves an
//! angle between the last section and the first; it is spread evenly over the length, so that sections fit each other.
//!
//! Lamellae are bands of a constant depth. Flat ones are sectors of rings in the planes of the arcs, one for each arc, which meet
//! along the arcs' ends only. Those across a surface go in given directions, as of its normal, and are one band.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::sweep::{check_direction, check_intervals};
use super::{Arc, Snake};
use crate::error::{Error, Result, Status};
use crate::linalg::small::any_orthogonal;
use crate::mesh::grid::Grid;

/// Across is at least this part of a direction: what is left has a direction to round-off then.
const ACROSS: f64 = 1e-9;

/// The pipe of a radius around a snake, in row `i` the points of a section, `around` of them, at `per_arc` intervals in each arc.
/// Quads face outward. An open snake's pipe is open at its ends, a closed one's wraps around.
///
/// # Errors
/// A radius that is not above 0, or not below the radii of the arcs, as the pipe would fold (`radius`); no intervals or more than
/// 65 536 (`per_arc`), fewer than 3 points around or more than 65 536 (`around`); more points than 32-bit indices hold (`points`).
pub fn pipe(snake: &Snake, radius: f64, per_arc: usize, around: usize) -> Result<Grid> {
    check_intervals("per_arc", per_arc)?;
    check_intervals("around", around)?;
    if around < 3 {
        return Err(Error::new(Status::InvalidValue, format!("expected at least 3, found {around}")).at("around"));
    }
    let least = snake.shapes().iter().map(|shape| shape.radius).fold(f64::INFINITY, f64::min);
    if !(radius > 0.0 && radius < least) {
        let reason = format!("expected above 0 and below {least}, the least radius of an arc; found {radius}");
        return Err(Error::new(Status::InvalidValue, reason).at("radius"));
    }
    let rows = row_count(snake, per_arc);
    check_size(rows, around)?;
    let arcs = snake.arcs();
    let tangent = arcs[0].tangent(0.0);
    let first = any_orthogonal(tangent).normalize();
    // Where each arc begins: a direction across it, and the part of the snake's length before it.
    let (mut starts, mut out, mut along) = (Vec::with_capacity(arcs.len()), first, 0.0);
    for arc in &arcs {
        starts.push((out, along));
        out = transported(arc, out, 1.0);
        along += arc.length() / snake.length();
    }
    let rest = if snake.is_closed() { tangent.dot(out.cross(first)).atan2(out.dot(first)) } else { 0.0 };
    let section = |row: usize| {
        let (j, part) = place(arcs.len(), per_arc, row);
        let (arc, (out, before)) = (&arcs[j], starts[j]);
        let (center, tangent) = (arc.point(part), arc.tangent(part));
        let twist = rest * (before + part * arc.length() / snake.length());
        let out = DMat3::from_axis_angle(tangent, twist) * transported(arc, out, part);
        let aside = out.cross(tangent);
        (0..around).map(move |k| {
            let (sine, cosine) = (TAU * k as f64 / around as f64).sin_cos();
            center + radius * (cosine * out + sine * aside)
        })
    };
    let points = (0..rows).flat_map(section).collect();
    Grid::new(points, rows, around, [snake.is_closed(), true])
}

/// A vector across the start of an arc, taken along to a part of its length.
fn transported(arc: &Arc, out: DVec3, part: f64) -> DVec3 {
    DMat3::from_axis_angle(arc.circle.normal, part * arc.angle_rad) * out
}

/// The arc of a sample along a snake, and at which part of its length; beyond the last arc its end.
fn place(arc_count: usize, per_arc: usize, sample: usize) -> (usize, f64) {
    match sample / per_arc {
        j if j < arc_count => (j, (sample % per_arc) as f64 / per_arc as f64),
        _ => (arc_count - 1, 1.0),
    }
}

fn row_count(snake: &Snake, per_arc: usize) -> usize {
    snake.shapes().len() * per_arc + usize::from(!snake.is_closed())
}

fn check_size(rows: usize, columns: usize) -> Result<()> {
    if rows.checked_mul(columns).is_some_and(|count| u32::try_from(count).is_ok()) {
        return Ok(());
    }
    let reason = format!("{rows} rows of {columns} points do not fit 32-bit indices");
    Err(Error::new(Status::TooLarge, reason).at("points"))
}

/// The flat lamellae of a snake, one for each arc: in row 0 the arc, in row 1 the concentric one that is `depth` farther from the
/// centre, or nearer if it is negative. Arcs of one kind have lamellae of one kind.
///
/// # Errors
/// A depth of 0, or one that reaches the centre of an arc (`depth`); no intervals or more than 65 536 (`per_arc`).
pub fn flat_lamellae(snake: &Snake, depth: f64, per_arc: usize) -> Result<Vec<Grid>> {
    check_intervals("per_arc", per_arc)?;
    let least = snake.shapes().iter().map(|shape| shape.radius).fold(f64::INFINITY, f64::min);
    if !(depth > -least && depth != 0.0 && depth.is_finite()) {
        let reason = format!("expected a finite number other than 0 and above {}, found {depth}", -least);
        return Err(Error::new(Status::InvalidValue, reason).at("depth"));
    }
    let lamella = |arc: &Arc| {
        let inner = || (0..=per_arc).map(|k| arc.point(k as f64 / per_arc as f64));
        let factor = depth / arc.circle.radius;
        let outer = inner().map(|point| point + factor * (point - arc.circle.center));
        Grid::new(inner().chain(outer).collect(), 2, per_arc + 1, [false, false])
    };
    snake.arcs().iter().map(lamella).collect()
}

/// The lamella of a snake in given directions: in row 0 the points along the snake, `per_arc` intervals in each arc, in row 1 the
/// same moved by `depth` at right angles to the snake, as `direction` leads from them. With the normals of a surface it stands on
/// it.
///
/// # Errors
/// A depth of 0 or one that is not finite (`depth`), a direction that is not finite, 0, or along the snake (`direction`); no
/// intervals or more than 65 536 (`per_arc`).
pub fn lamella(snake: &Snake, depth: f64, per_arc: usize, direction: &dyn Fn(DVec3) -> DVec3) -> Result<Grid> {
    check_intervals("per_arc", per_arc)?;
    if !(depth != 0.0 && depth.is_finite()) {
        let reason = format!("expected a finite number other than 0, found {depth}");
        return Err(Error::new(Status::InvalidValue, reason).at("depth"));
    }
    let columns = row_count(snake, per_arc);
    let (mut points, mut moved) = (Vec::with_capacity(2 * columns), Vec::with_capacity(columns));
    let arcs = snake.arcs();
    for k in 0..columns {
        let (j, part) = place(arcs.len(), per_arc, k);
        let arc = &arcs[j];
        let (point, tangent) = (arc.point(part), arc.tangent(part));
        let across = check_direction("direction", direction(point))?.reject_from_normalized(tangent);
        if across.length() < ACROSS {
            let reason = format!("expected a direction across the snake, found one along it at {point}");
            return Err(Error::new(Status::InvalidValue, reason).at("direction"));
        }
        points.push(point);
        moved.push(point + depth * across.normalize());
    }
    points.extend(moved);
    Grid::new(points, 2, columns, [false, snake.is_closed()])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::geometry::random::Random;
    use crate::geometry::snakes::{ArcShape, Pose};

    /// A circle of radius 2 about the z axis of seven arcs; with noise a snake that is not flat.
    fn closed(noise: f64) -> Snake {
        let half = TAU / 14.0;
        let at = |i: i32| {
            let (sine, cosine) = (2.0 * half * f64::from(i)).sin_cos();
            2.0 / half.cos() * DVec3::new(cosine, sine, 0.0)
        };
        let snake = Snake::new((0..7).map(at).collect(), true, None).unwrap();
        if noise == 0.0 {
            return snake;
        }
        let mut random = Random(4);
        let control: Vec<DVec3> = snake.control().iter().map(|p| *p + noise * random.vector()).collect();
        Snake::new(control, true, None).unwrap()
    }

    fn open() -> Snake {
        let pose = Pose { point: DVec3::ONE, tangent: DVec3::X, normal: DVec3::Y };
        let arc = |radius, length| ArcShape { radius, length };
        Snake::from_arcs(&[arc(1.0, 1.5), arc(2.0, 2.0), arc(0.8, 0.9)], &[2.0, -0.7], &pose).unwrap()
    }

    /// The volume inside a closed mesh with outward faces.
    fn volume(grid: &Grid) -> f64 {
        let piece = |[a, b, c, d]: [usize; 4]| {
            let [a, b, c, d] = [a, b, c, d].map(|i| grid.points()[i]);
            (a.dot(b.cross(c)) + a.dot(c.cross(d))) / 6.0
        };
        grid.quads().map(piece).sum()
    }

    #[test]
    fn a_pipe_around_a_circle_is_a_torus() {
        let grid = pipe(&closed(0.0), 0.5, 20, 60).unwrap();
        assert_eq!((grid.rows(), grid.columns(), grid.wraps()), (140, 60, [true, true]));
        for p in grid.points() {
            assert!(((p.x.hypot(p.y) - 2.0).hypot(p.z) - 0.5).abs() < 1e-13);
        }
        // 2 π² R r², less what chords cut off.
        assert!((volume(&grid) / (2.0 * PI * PI * 2.0 * 0.25) - 1.0).abs() < 5e-3, "{}", volume(&grid));
    }

    #[test]
    fn pipes_keep_their_distance_and_do_not_twist() {
        for snake in [open(), closed(0.3)] {
            let radius = 0.3;
            assert!(snake.torsions().iter().any(|torsion| torsion.abs() > 0.1));
            let grid = pipe(&snake, radius, 40, 12).unwrap();
            let centers = snake.sample(40);
            assert_eq!((grid.rows(), grid.wraps()), (centers.len(), [snake.is_closed(), true]));
            for (i, center) in centers.iter().enumerate() {
                assert!(grid.row(i).iter().all(|p| (p.distance(*center) - radius).abs() < 1e-13));
                let mean: DVec3 = grid.row(i).iter().sum::<DVec3>() / 12.0;
                assert!(mean.distance(*center) < 1e-13);
            }
            // From section to section each point goes about along the tangent: what is around it is the spread rest, if any.
            let spans = grid.spans()[0];
            for i in 0..spans {
                let (from, to) = (centers[i], centers[(i + 1) % centers.len()]);
                for j in 0..12 {
                    let (a, b) = (grid.at(i, j) - from, grid.at(i + 1, j) - to);
                    let along = (to - from).normalize();
                    let around = along.dot(a.cross(b)) / (radius * radius);
                    let most = if snake.is_closed() { 1.01 * PI / spans as f64 * 2.0 } else { 1e-12 };
                    assert!(around.abs() < most, "{i} {j}: {around}");
                }
            }
        }
    }

    #[test]
    fn flat_lamellae_are_sectors_of_rings() {
        let snake = open();
        for depth in [0.4, -0.3] {
            let lamellae = flat_lamellae(&snake, depth, 60).unwrap();
            assert_eq!(lamellae.len(), 3);
            for (arc, grid) in snake.arcs().iter().zip(&lamellae) {
                let (r, n) = (arc.circle.radius, arc.circle.normal);
                for (a, b) in grid.row(0).iter().zip(grid.row(1)) {
                    assert!(((*b - arc.circle.center).length() - r - depth).abs() < 1e-13);
                    assert!(
                        (a.distance(*b) - depth.abs()).abs() < 1e-13 && n.dot(*b - arc.circle.center).abs() < 1e-13
                    );
                }
                let area: f64 = (0..60)
                    .map(|j| {
                        let [a, b, c, d] = grid.corners(0, j);
                        0.5 * (c - a).cross(d - b).length()
                    })
                    .sum();
                let exact = 0.5 * arc.angle_rad * ((r + depth).powi(2) - r * r).abs();
                assert!((area / exact - 1.0).abs() < 1e-3, "{area} {exact}");
            }
        }
    }

    #[test]
    fn lamellae_stand_in_their_direction() {
        // Radially on a circle: a flat ring from 2 to 3.
        let grid = lamella(&closed(0.0), 1.0, 6, &|p| DVec3::new(p.x, p.y, 0.0)).unwrap();
        assert_eq!((grid.rows(), grid.columns(), grid.wraps()), (2, 42, [false, true]));
        assert!(grid.row(1).iter().all(|p| (p.length() - 3.0).abs() < 1e-13 && p.z.abs() < 1e-15));
        // A direction that leans along the snake counts across it only.
        let snake = open();
        let grid = lamella(&snake, 0.25, 6, &|_| DVec3::new(0.3, 0.2, 1.0)).unwrap();
        assert_eq!(grid.columns(), 19);
        let arcs = snake.arcs();
        for k in 0..19 {
            let side = grid.at(1, k) - grid.at(0, k);
            let (arc, part) = if k == 18 { (&arcs[2], 1.0) } else { (&arcs[k / 6], (k % 6) as f64 / 6.0) };
            assert!((side.length() - 0.25).abs() < 1e-14 && side.dot(arc.tangent(part)).abs() < 1e-14);
            assert!(grid.at(0, k).distance(arc.point(part)) < 1e-14 && side.dot(DVec3::new(0.3, 0.2, 1.0)) > 0.0);
        }
    }

    #[test]
    fn bad_coverings_are_refused() {
        let snake = open();
        let place = |grid: Result<Grid>| grid.unwrap_err().place().to_owned();
        assert_eq!(place(pipe(&snake, 0.8, 4, 6)), "radius");
        assert_eq!(place(pipe(&snake, f64::NAN, 4, 6)), "radius");
        assert_eq!(place(pipe(&snake, 0.1, 0, 6)), "per_arc");
        assert_eq!(place(pipe(&snake, 0.1, 4, 2)), "around");
        assert_eq!(flat_lamellae(&snake, -0.8, 4).unwrap_err().place(), "depth");
        assert_eq!(flat_lamellae(&snake, 0.0, 4).unwrap_err().place(), "depth");
        assert_eq!(place(lamella(&snake, f64::INFINITY, 4, &|p| p)), "depth");
        assert_eq!(place(lamella(&snake, 0.1, 4, &|_| DVec3::X)), "direction");
        assert_eq!(place(lamella(&snake, 0.1, 4, &|_| DVec3::NAN)), "direction");
    }
}
