//! Meshes on strips of circles of which consecutive ones are on one sphere.
//!
//! A plane through one edge between two such circles meets each in a second point, and the four points are on a circle: that
//! in which the plane meets the sphere. So a mesh is known from its points on the first circle and one column (section 4.1,
//! Figs. 12 and 13): point `(i + 1, j + 1)` is where the plane through `(i, j)`, `(i, j + 1)` and `(i + 1, j)` meets circle `i + 1`
//! again. (The paper prints the new point with the index of the known one.)
//!
//! Not every column will do. If the tangents of the circles in its points are mirror images of each other, all lines from points
//! of a circle to their partners on the next one meet in one point (there are two such points for each pair of circles on a
//! sphere); then any two columns make circular quads. Else columns that follow each other zigzag about such ones, and an odd
//! number of them does not close around the circles. [`column()`] finds columns with mirrored tangents; a guide of
//! [`CircleStrip`](super::circle_strip::CircleStrip) is one.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::{Circle, PARALLEL, Sphere, reflect};
use crate::mesh::Grid;
use crate::mesh::grid::check_finite;

/// How far a point may be from the circle, or a corner from the circle through the other three, over the circle's radius or
/// the quad's diagonal.
const NOT_CIRCULAR: f64 = 1e-9;

/// Tangents are mirror images of each other up to this difference of unit vectors: some multiple of round-off.
const MIRRORED: f64 = 1e-11;

/// Points count as one below this multiple of the circle's radius.
const SAME_POINT: f64 = 1e-12;

/// Which part of a circle is meshed, from one of its points on. Angles are in radians, counterclockwise about the circle's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// All of it; the mesh closes around it.
    Whole,
    /// From one angle to another, measured from the point; less than a full turn. Column 0 is the guide if it starts at 0.
    Angles {
        /// Where it starts.
        from_rad: f64,
        /// Where it ends, on either side of the start.
        to_rad: f64,
    },
    /// From the point to the one nearest to where the second curve passes, so that the last column starts at the second curve.
    ToCurve {
        /// Around the far side of the circle.
        is_long_way: bool,
    },
    /// What is above a plane, on the side of its normal. If the point is in the plane, the section starts there.
    Above {
        /// A point of the plane.
        point: DVec3,
        /// Its normal, of any length.
        normal: DVec3,
    },
}

/// Points on a circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// The points, at equal angles.
    pub points: Vec<DVec3>,
    /// Whether the first follows the last.
    pub is_whole: bool,
    /// Whether they run clockwise.
    pub is_reversed: bool,
}

impl Section {
    /// `count` points of the section of a circle from `start`, a point of it. `target` is where the second curve passes.
    ///
    /// # Errors
    /// `count` below 2 (3 of a whole circle), a number that is not finite, an empty range or one of a full turn and more, a
    /// normal that is zero, or no target where one is needed. Status `NotCircular`: `start` is not on the circle;
    /// `NoIntersection`: the circle does not meet the plane; `Degenerate`: the target is on the circle's axis, or at its start.
    pub fn samples(self, circle: &Circle, start: DVec3, count: usize, target: Option<DVec3>) -> Result<Samples> {
        check_circle(circle).map_err(|error| error.at("circle"))?;
        check_on(circle, start).map_err(|error| error.at("start"))?;
        let is_whole = self == Self::Whole;
        let least = if is_whole { 3 } else { 2 };
        if count < least {
            let reason = format!("expected at least {least}, found {count}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("count"));
        }
        let (from, to) = match self {
            Self::Whole => (0.0, TAU),
            Self::Angles { from_rad, to_rad } => angles(from_rad, to_rad)?,
            Self::ToCurve { is_long_way } => {
                let target = target.ok_or_else(|| {
                    Error::new(Status::InvalidValue, "expected a point of the second curve, found none").at("target")
                })?;
                check_finite("target", &[target]).map_err(|error| error.with_place("target"))?;
                (0.0, to_target(circle, start, target, is_long_way)?)
            }
            Self::Above { point, normal } => above(circle, start, point, normal)?,
        };
        let steps = if is_whole { count } else { count - 1 } as f64;
        let at = |j: usize| {
            let angle = from + (to - from) * (j as f64 / steps);
            if angle == 0.0 { start } else { circle.point_at(start, angle) }
        };
        Ok(Samples { points: (0..count).map(at).collect(), is_whole, is_reversed: to < from })
    }
}

fn angles(from: f64, to: f64) -> Result<(f64, f64)> {
    let (from, to) = (finite("from_rad", from)?, finite("to_rad", to)?);
    if 0.0 < (to - from).abs() && (to - from).abs() < TAU {
        return Ok((from, to));
    }
    let reason = format!("expected another angle less than a turn from {from}, found {to}");
    Err(Error::new(Status::InvalidValue, reason).at("to_rad"))
}

fn to_target(circle: &Circle, start: DVec3, target: DVec3, is_long_way: bool) -> Result<f64> {
    let across = (target - circle.center).reject_from_normalized(circle.normal);
    if !(across.length() > NOT_CIRCULAR * circle.radius) {
        let reason = format!("all of the circle is as near to {target}, on its axis");
        return Err(Error::new(Status::Degenerate, reason).at("target"));
    }
    let angle = circle.angle_between(start, target);
    if angle.min(TAU - angle) <= NOT_CIRCULAR {
        return Err(Error::new(Status::Degenerate, "it is nearest to where the section starts").at("target"));
    }
    let is_counterclockwise = (angle <= PI) != is_long_way;
    Ok(if is_counterclockwise { angle } else { angle - TAU })
}

/// The height above the plane at an angle is `h + r (a cos + b sin)`, `a` and `b` the normal's components along the axes at angle
/// 0 and a quarter turn: it is above 0 within `acos(−h/(r√(a² + b²)))` of the angle `atan2(b, a)`.
fn above(circle: &Circle, start: DVec3, point: DVec3, normal: DVec3) -> Result<(f64, f64)> {
    check_finite("point", &[point]).map_err(|error| error.with_place("point"))?;
    check_finite("normal", &[normal]).map_err(|error| error.with_place("normal"))?;
    let zero = || Error::new(Status::Degenerate, "expected a direction, found zero").at("normal");
    let normal = normal.try_normalize().ok_or_else(zero)?;
    let x = (start - circle.center).normalize();
    let (a, b) = (x.dot(normal), circle.normal.cross(x).dot(normal));
    let (height, swing) = ((circle.center - point).dot(normal), circle.radius * a.hypot(b));
    if !(height.abs() < swing) {
        let side = if height > 0.0 { "above" } else { "below" };
        let reason = format!("the circle is wholly {side} the plane");
        return Err(Error::new(Status::NoIntersection, reason).at("plane"));
    }
    let (middle, half) = (b.atan2(a), (-height / swing).acos());
    let turned = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
    // An end at the start, but for rounding, is the start.
    if turned(middle - half).abs() < NOT_CIRCULAR {
        Ok((0.0, 2.0 * half))
    } else if turned(middle + half).abs() < NOT_CIRCULAR {
        Ok((0.0, -2.0 * half))
    } else {
        Ok((middle - half, middle + half))
    }
}

/// The grid of which row `i` is on circle `i`, with row 0 given; it closes around the circles if `wraps`. The guide, a point of
/// each circle, is column 0 where it goes through the first point; else it only leads from circle to circle.
///
/// # Errors
/// Fewer than 2 circles or 2 points of row 0 (3 if it wraps), another number of guide points, or a number that is not finite.
/// Status `NotCircular`: a point is not on its circle, or a quad not on one: consecutive circles are not on one sphere, or, if
/// `wraps`, the circles' tangents along the guide are not mirror images; `Degenerate`: a quad's plane touches the next circle, or
/// two points of the row are one. The place is `circles[i]`, `guide[i]`, `row[j]` or `faces[i]`.
pub fn mesh(circles: &[Circle], guide: &[DVec3], row: &[DVec3], wraps: bool) -> Result<Grid> {
    check_strip(circles, guide)?;
    check_finite("row", row)?;
    for (j, &point) in row.iter().enumerate() {
        check_on(&circles[0], point).map_err(|error| error.at(format!("row[{j}]")))?;
        let before = if j > 0 { Some(j - 1) } else { (wraps && row.len() > 1).then(|| row.len() - 1) };
        if let Some(k) = before.filter(|&k| row[k].distance(point) <= SAME_POINT * circles[0].radius) {
            let reason = format!("expected another point than row[{k}], found {point} again");
            return Err(Error::new(Status::Degenerate, reason).at(format!("row[{j}]")));
        }
    }
    let columns = row.len();
    let face_columns = if wraps { columns } else { columns.saturating_sub(1) };
    let mut points = row.to_vec();
    points.reserve(columns * (circles.len() - 1));
    for i in 0..circles.len() - 1 {
        let at = |j: usize| format!("faces[{}]", i * face_columns + j.min(face_columns.saturating_sub(1)));
        // The edge that is known between the two circles: that of the guide for all where its tangents are mirrored (so that errors
        // do not add up, nor grow where columns come close to each other), else the last found.
        let mut known = [guide[i], guide[i + 1]];
        let tangents = [i, i + 1].map(|k| circles[k].tangent_at(guide[k]));
        let mirrored = reflect(tangents[0], known[1] - known[0]);
        let is_mirrored = mirrored.cross(tangents[1]).length() <= MIRRORED;
        for j in 0..columns {
            let point = points[i * columns + j];
            // Columns that are the guide stay with it.
            if point.distance(guide[i]) <= SAME_POINT * circles[i].radius && (is_mirrored || j == 0) {
                points.push(guide[i + 1]);
                continue;
            }
            let next = partner(&circles[i + 1], known, point).map_err(|error| error.at(at(j.saturating_sub(1))))?;
            points.push(next);
            if !is_mirrored {
                known = [point, next];
            }
        }
    }
    let grid = Grid::new(points, circles.len(), columns, [false, wraps])
        .map_err(|error| if error.place() == "columns" { error.with_place("row") } else { error })?;
    check_quads(&grid)?;
    Ok(grid)
}

/// The strip of points on the circles that makes circular quads with the guide, from `start`, a point of the first circle: one more
/// column of a mesh.
///
/// # Errors
/// As [`mesh`].
pub fn strip(circles: &[Circle], guide: &[DVec3], start: DVec3) -> Result<Vec<DVec3>> {
    let first = guide.first().copied().unwrap_or_default();
    let in_row = |error: Error| if error.place().starts_with("row[") { error.with_place("start") } else { error };
    Ok(mesh(circles, guide, &[first, start], false).map_err(in_row)?.column(1))
}

/// Refuses quads that are not on a circle.
fn check_quads(grid: &Grid) -> Result<()> {
    let [rows, columns] = grid.spans();
    for i in 0..rows {
        for j in 0..columns {
            let [a, b, c, d] = grid.corners(i, j);
            let size = a.distance(c).max(b.distance(d));
            let place = || format!("faces[{}]", i * columns + j);
            // The distance of the fourth corner; of corners on a line, from the line.
            let apart = match Circle::through(a, b, c) {
                Some(circle) => circle.distance(d),
                None => (d - a).reject_from((c - a).try_normalize().unwrap_or(DVec3::X)).length(),
            };
            if !(size > 0.0) {
                return Err(Error::new(Status::Degenerate, "all its corners are one point").at(place()));
            }
            if !(apart <= NOT_CIRCULAR * size) {
                let reason = format!("its corners are {:e} of its size from being on a circle", apart / size);
                return Err(Error::new(Status::NotCircular, reason).at(place()));
            }
        }
    }
    Ok(())
}

/// The point of `circle` in the plane through `known`, a point of the circle before and one of this circle, and `point`.
fn partner(circle: &Circle, known: [DVec3; 2], point: DVec3) -> Result<DVec3> {
    let plane_normal = (known[1] - known[0]).cross(point - known[0]);
    let found = circle.second_point(known[1], plane_normal);
    let moved = found.filter(|found| found.distance(known[1]) > SAME_POINT * circle.radius);
    moved.ok_or_else(|| {
        let reason = "the plane of this quad meets the next circle in no second point";
        Error::new(Status::Degenerate, reason)
    })
}

/// The column from `start`, a point of the first circle, along which the tangents of the circles are mirror images of each other:
/// with it a mesh closes around whole circles. All circles run in the sense of the first: about its normal, or about that of
/// their two normals which makes less than a right angle with that of the circle before.
///
/// The tangent of a circle in a point `V` meets the plane of the next circle in `X = V + s t`. From there two tangents reach
/// that circle, in points as far from `X` as `V` since all is on one sphere; the segments from `V` to both are bisected by planes
/// through `X` that mirror the tangents. One of them runs in the given sense: with `q = X − c` and `q² = r² + s²` it is
/// `c + (r² q − r s ν × q)/q²`. Divided by `s`, this also holds for a tangent parallel to that plane.
///
/// # Errors
/// No circle, or a number that is not finite. Status `NotCircular`: `start` is not on the first circle, or a circle is on no sphere
/// with the one before; `Degenerate`: circles of one plane, or that touch at the column. The place is `circles[i]` or `start`.
pub fn column(circles: &[Circle], start: DVec3) -> Result<Vec<DVec3>> {
    check_circles(circles)?;
    check_on(&circles[0], start).map_err(|error| error.at("start"))?;
    let mut points = vec![start];
    let mut before = circles[0];
    for (i, &next) in circles[1..].iter().enumerate() {
        let place = |error: Error| error.at(format!("circles[{}]", i + 1));
        check_one_sphere(&before, &next).map_err(place)?;
        let next = if next.normal.dot(before.normal) < 0.0 { Circle { normal: -next.normal, ..next } } else { next };
        let (point, tangent) = (points[i], before.tangent_at(points[i]));
        // X = V + s t with s = height/rate; in units of s: the inverse u = rate/height may be 0, not infinite.
        let (rate, height) = (tangent.dot(next.normal), (next.center - point).dot(next.normal));
        let scale = height.hypot(rate * next.radius);
        if !(scale > SAME_POINT * next.radius) {
            let reason = "it touches the circle before at this column";
            return Err(place(Error::new(Status::Degenerate, reason)));
        }
        // q·rate = (V − c) rate + height t, within the plane of the next circle.
        let q = (rate * (point - next.center) + height * tangent).reject_from_normalized(next.normal);
        let squared = q.length_squared();
        let r = next.radius;
        let found = next.center + (r * r * rate * q - r * height * next.normal.cross(q)) / squared;
        // Of what the formula rounds off only the part along the circle stays.
        let out = (found - next.center).reject_from_normalized(next.normal);
        points.push(next.center + r * out.normalize_or(next.normal.any_orthonormal_vector()));
        before = next;
    }
    check_finite("circles", &points)?;
    Ok(points)
}

/// The sphere through the one circle and a point of the other holds two more of its points.
fn check_one_sphere(circle: &Circle, other: &Circle) -> Result<()> {
    let points = [0.0, TAU / 3.0, 2.0 * TAU / 3.0].map(|angle| other.point_at(circle.center, angle));
    let farthest = |a: &DVec3, b: &DVec3| {
        let height = |point: &DVec3| (*point - circle.center).dot(circle.normal).abs();
        if height(b) > height(a) { *b } else { *a }
    };
    let through = points.iter().skip(1).fold(points[0], |far, point| farthest(&far, point));
    let Some(sphere) = Sphere::through(circle, through) else {
        return Err(Error::new(Status::Degenerate, "it is in one plane with the circle before"));
    };
    let apart = points.iter().map(|&point| sphere.distance(point).abs()).fold(0.0, f64::max);
    if apart <= NOT_CIRCULAR * (circle.radius + other.radius) {
        return Ok(());
    }
    let reason = format!("it is {apart:e} from being on a sphere with the circle before");
    Err(Error::new(Status::NotCircular, reason))
}

fn check_circle(circle: &Circle) -> Result<()> {
    let is_unit = (circle.normal.length() - 1.0).abs() <= 1e-9;
    if circle.center.is_finite() && is_unit && circle.radius > 0.0 && circle.radius.is_finite() {
        return Ok(());
    }
    let reason = format!("expected a circle with a unit normal and a radius above 0, found {circle:?}");
    Err(Error::new(Status::InvalidValue, reason))
}

fn check_circles(circles: &[Circle]) -> Result<()> {
    if circles.len() < 2 {
        let reason = format!("expected at least 2, found {}", circles.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("circles"));
    }
    let check = |(i, circle)| check_circle(circle).map_err(|error| error.at(format!("circles[{i}]")));
    circles.iter().enumerate().try_for_each(check)
}

fn check_strip(circles: &[Circle], guide: &[DVec3]) -> Result<()> {
    check_circles(circles)?;
    if guide.len() != circles.len() {
        let reason = format!("expected one for each of {} circles, found {}", circles.len(), guide.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("guide"));
    }
    let check = |(i, (circle, &point))| check_on(circle, point).map_err(|error| error.at(format!("guide[{i}]")));
    circles.iter().zip(guide).enumerate().try_for_each(check)
}

fn check_on(circle: &Circle, point: DVec3) -> Result<()> {
    check_finite("point", &[point]).map_err(|error| error.with_place(""))?;
    let apart = circle.distance(point);
    // A large circle far away is given to rounding of its coordinates.
    let resolution = NOT_CIRCULAR * circle.radius + PARALLEL * circle.center.length();
    if apart <= resolution {
        return Ok(());
    }
    let reason = format!("expected a point of the circle, found {point}, {apart:e} away from it");
    Err(Error::new(Status::NotCircular, reason))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::canal::circle_strip::CircleStrip;
    use crate::geometry::canal::circle_strip::tests::free_form;
    use crate::geometry::canal::normals::{Guide, Orientation};
    use crate::geometry::random::Random;
    use crate::mesh::curve::{NearestOnCurve, Spacing};

    /// Circles through a guide, consecutive ones on one sphere.
    fn circles(count: usize) -> (Vec<Circle>, Vec<DVec3>) {
        let [first, second] = free_form(12);
        let guide = Guide::along(&first, count, Spacing::ArcLength).unwrap();
        let strip = CircleStrip::new(&guide, Orientation::Angle(-0.8), &NearestOnCurve::new(&second).unwrap()).unwrap();
        (strip.circles, guide.points().to_vec())
    }

    /// How far quads are from planar and from concyclic, by the circle through three corners and the fourth's place on it.
    pub(in super::super) fn gaps(grid: &Grid) -> [f64; 2] {
        let mut gaps = [0.0_f64; 2];
        for [a, b, c, d] in grid.quads().map(|quad| quad.map(|corner| grid.points()[corner])) {
            let normal = (c - a).cross(d - b).normalize();
            let mean_edge = 0.25 * (a.distance(b) + b.distance(c) + c.distance(d) + d.distance(a));
            gaps[0] = gaps[0].max((b - a).dot(normal).abs() / mean_edge);
            let (u, v) = (b - a, c - a);
            let w = u.cross(v);
            let center =
                a + (w.cross(u) * v.length_squared() + v.cross(w) * u.length_squared()) / (2.0 * w.length_squared());
            let radius = center.distance(a);
            gaps[1] = gaps[1].max((d.distance(center) - radius).abs() / radius);
        }
        gaps
    }

    #[test]
    fn meshes_close_around_whole_circles_and_quads_are_circular() {
        let (circles, guide) = circles(20);
        for count in [3, 4, 17, 60] {
            let samples = Section::Whole.samples(&circles[0], guide[0], count, None).unwrap();
            assert!(samples.is_whole && !samples.is_reversed && samples.points.len() == count);
            let grid = mesh(&circles, &guide, &samples.points, true).unwrap();
            assert_eq!((grid.column(0), grid.wraps()), (guide.clone(), [false, true]));
            let [planarity, circularity] = gaps(&grid);
            assert!(planarity < 1e-12 && circularity < 1e-12, "{planarity:e} {circularity:e}");
            for (i, circle) in circles.iter().enumerate() {
                assert!(grid.row(i).iter().all(|&point| circle.distance(point) < 1e-13 * (1.0 + circle.radius)));
                // In order around the circle, once.
                let angles: Vec<f64> = grid.row(i).iter().map(|&point| circle.angle_between(guide[i], point)).collect();
                assert!(angles.windows(2).skip(1).all(|pair| pair[0] < pair[1]), "{i}: {angles:?}");
            }
            // A column of the mesh is the strip from its first point.
            let column = strip(&circles, &guide, samples.points[1]).unwrap();
            assert!(column.iter().zip(grid.column(1)).all(|(a, b)| a.distance(b) < 1e-12));
        }
        // Without the guide among the points, and with the guide led by another column: the same columns.
        let samples = Section::Angles { from_rad: 1.0, to_rad: -2.0 }.samples(&circles[0], guide[0], 9, None).unwrap();
        let grid = mesh(&circles, &guide, &samples.points, false).unwrap();
        assert!(samples.is_reversed && gaps(&grid).iter().all(|&gap| gap < 1e-12), "{:?}", gaps(&grid));
        let other = mesh(&circles, &grid.column(8), &samples.points, false).unwrap();
        assert!(grid.points().iter().zip(other.points()).all(|(a, b)| a.distance(*b) < 1e-10));
    }

    #[test]
    fn columns_with_mirrored_tangents_are_found_without_a_guide() {
        let (circles, guide) = circles(20);
        let found = column(&circles, guide[0]).unwrap();
        for (i, (point, expected)) in found.iter().zip(&guide).enumerate() {
            assert!(point.distance(*expected) < 1e-11, "{i}: {:e}", point.distance(*expected));
        }
        // The normals' senses do not matter, but for the first.
        let turned: Vec<Circle> = circles
            .iter()
            .enumerate()
            .map(|(i, circle)| if i % 3 == 1 { Circle { normal: -circle.normal, ..*circle } } else { *circle })
            .collect();
        assert!(column(&turned, guide[0]).unwrap().iter().zip(&found).all(|(a, b)| a.distance(*b) < 1e-13));
        // Circles with tangents parallel to each other's planes: those of a cylinder, and of a cone along its axis.
        for slope in [0.0, 0.4] {
            let circle = |x: f64| Circle { center: x * DVec3::X, normal: DVec3::X, radius: 1.0 + slope * x };
            let found = column(&[0.0, 0.5, 2.0].map(circle), DVec3::Y).unwrap();
            for (point, x) in found.iter().zip([0.0, 0.5, 2.0]) {
                assert!(point.distance(DVec3::new(x, 1.0 + slope * x, 0.0)) < 1e-14);
            }
        }
    }

    #[test]
    fn sections_are_the_parts_of_a_circle_that_they_say() {
        let circle = Circle { center: DVec3::new(1.0, 2.0, 3.0), normal: DVec3::Z, radius: 2.0 };
        let at = |angle: f64| circle.center + 2.0 * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let start = at(0.3);
        let angles = |section: Section, target: Option<DVec3>| {
            let samples = section.samples(&circle, start, 5, target).unwrap();
            let near = |point: &DVec3| circle.angle_between(start, *point);
            assert!(samples.points.iter().all(|&point| circle.distance(point) < 1e-14));
            (near(&samples.points[0]), near(&samples.points[1]), near(&samples.points[4]), samples.is_reversed)
        };
        let close = |found: (f64, f64, f64, bool), expected: (f64, f64, f64, bool)| {
            let apart = |a: f64, b: f64| ((a - b + PI).rem_euclid(TAU) - PI).abs();
            let worst = apart(found.0, expected.0).max(apart(found.1, expected.1)).max(apart(found.2, expected.2));
            assert!(worst < 1e-12 && found.3 == expected.3, "{found:?} {expected:?}");
        };
        close(angles(Section::Whole, None), (0.0, TAU / 5.0, 0.8 * TAU, false));
        close(angles(Section::Angles { from_rad: 0.0, to_rad: 1.0 }, None), (0.0, 0.25, 1.0, false));
        close(angles(Section::Angles { from_rad: 0.5, to_rad: -0.5 }, None), (0.5, 0.25, -0.5, true));
        // The target is off the circle and its plane.
        let target = |angle: f64| Some(circle.center + 3.3 * (at(angle) - circle.center) + 5.0 * DVec3::Z);
        let to_curve = |is_long_way| Section::ToCurve { is_long_way };
        close(angles(to_curve(false), target(1.5)), (0.0, 0.3, 1.2, false));
        close(angles(to_curve(true), target(1.5)), (0.0, (1.2 - TAU) / 4.0, 1.2, true));
        close(angles(to_curve(false), target(-0.9)), (0.0, -0.3, -1.2, true));
        // Above y = 3: sin > 1/2 from the center's y = 2.
        let above = |y: f64, normal: DVec3| Section::Above { point: DVec3::new(7.0, y, -1.0), normal };
        close(angles(above(3.0, 5.0 * DVec3::Y), None), (PI / 6.0 - 0.3, PI / 3.0 - 0.3, 5.0 * PI / 6.0 - 0.3, false));
        // In the plane: the section starts there, whichever way it goes.
        let height = start.y;
        close(angles(above(height, DVec3::Y), None), (0.0, (PI - 0.6) / 4.0, PI - 0.6, false));
        close(angles(above(height, DVec3::NEG_Y), None), (0.0, -(PI + 0.6) / 4.0, -(PI + 0.6), true));
        let samples = above(height, DVec3::Y).samples(&circle, start, 5, None).unwrap();
        assert_eq!(samples.points[0], start);
    }

    #[test]
    fn sections_that_are_none_are_refused() {
        let circle = Circle { center: DVec3::ZERO, normal: DVec3::Z, radius: 2.0 };
        let start = 2.0 * DVec3::X;
        let refusal = |section: Section, circle: &Circle, start, count, target| {
            let error = section.samples(circle, start, count, target).unwrap_err();
            (error.status(), error.place().to_string())
        };
        let plain = |section| refusal(section, &circle, start, 4, None);
        let angles = |from_rad, to_rad| Section::Angles { from_rad, to_rad };
        assert_eq!(plain(angles(1.0, 1.0)), (Status::InvalidValue, "to_rad".into()));
        assert_eq!(plain(angles(-4.0, 3.0)), (Status::InvalidValue, "to_rad".into()));
        assert_eq!(plain(angles(f64::NAN, 3.0)), (Status::InvalidValue, "from_rad".into()));
        assert_eq!(plain(angles(0.0, f64::INFINITY)), (Status::InvalidValue, "to_rad".into()));
        let above = |z: f64, normal| Section::Above { point: z * DVec3::Z, normal };
        assert_eq!(plain(above(1.0, DVec3::Z)), (Status::NoIntersection, "plane".into()));
        assert_eq!(plain(above(1.0, DVec3::ZERO)), (Status::Degenerate, "normal".into()));
        assert_eq!(plain(above(1.0, DVec3::NAN)), (Status::InvalidValue, "normal".into()));
        assert_eq!(plain(above(f64::NAN, DVec3::Z)), (Status::InvalidValue, "point".into()));
        let far = Section::Above { point: 2.5 * DVec3::X, normal: DVec3::new(1.0, 0.0, 0.0) };
        assert_eq!(plain(far), (Status::NoIntersection, "plane".into()));
        let to_curve = Section::ToCurve { is_long_way: false };
        assert_eq!(plain(to_curve), (Status::InvalidValue, "target".into()));
        let target = |target| refusal(to_curve, &circle, start, 4, Some(target));
        assert_eq!(target(3.0 * DVec3::Z), (Status::Degenerate, "target".into()));
        assert_eq!(target(3.0 * DVec3::X), (Status::Degenerate, "target".into()));
        assert_eq!(target(DVec3::NAN), (Status::InvalidValue, "target".into()));
        let count = (Status::InvalidArgumentLength, "count".to_string());
        assert_eq!(refusal(Section::Whole, &circle, start, 2, None), count);
        assert_eq!(refusal(angles(0.0, 1.0), &circle, start, 1, None), count);
        assert_eq!(refusal(Section::Whole, &circle, DVec3::X, 4, None), (Status::NotCircular, "start".into()));
        let bad = Circle { radius: 0.0, ..circle };
        assert_eq!(refusal(Section::Whole, &bad, start, 4, None), (Status::InvalidValue, "circle".into()));
    }

    #[test]
    fn strips_that_make_no_circular_mesh_are_refused_at_their_face() {
        let (circles, guide) = circles(8);
        let row =
            Section::Angles { from_rad: 0.0, to_rad: 1.5 }.samples(&circles[0], guide[0], 6, None).unwrap().points;
        let refusal = |circles: &[Circle], guide: &[DVec3], row: &[DVec3], wraps| {
            let error = mesh(circles, guide, row, wraps).unwrap_err();
            (error.status(), error.place().to_string())
        };
        // One circle turned about its tangent at the guide: it leaves both spheres, and quads their circles.
        let mut turned = circles.clone();
        let arm = (guide[4] - circles[4].center).normalize();
        let tilt = (circles[4].normal + 0.05 * arm).normalize();
        let arm = arm.reject_from_normalized(tilt).normalize();
        turned[4] = Circle { center: guide[4] - circles[4].radius * arm, normal: tilt, ..circles[4] };
        assert_eq!(refusal(&turned, &guide, &row, false), (Status::NotCircular, "faces[15]".into()));
        let off_sphere = column(&turned, guide[0]).unwrap_err();
        assert_eq!((off_sphere.status(), off_sphere.place()), (Status::NotCircular, "circles[4]"));
        // A guide whose tangents are not mirror images makes circular quads from column to column; they close for an even number
        // of columns only.
        let mut random = Random(3);
        let drifted: Vec<DVec3> = circles
            .iter()
            .zip(&guide)
            .map(|(circle, &point)| circle.point_at(point, random.between(-0.1, 0.1)))
            .collect();
        let whole = |count| Section::Whole.samples(&circles[0], drifted[0], count, None).unwrap().points;
        for wraps in [false, true] {
            let grid = mesh(&circles, &drifted, &whole(12), wraps).unwrap();
            assert!(gaps(&grid).iter().all(|&gap| gap < 1e-9), "{:?}", gaps(&grid));
        }
        assert!(mesh(&circles, &drifted, &whole(13), false).is_ok());
        assert_eq!(refusal(&circles, &drifted, &whole(13), true), (Status::NotCircular, "faces[12]".into()));
        // Counts, places, numbers.
        assert_eq!(refusal(&circles[..1], &guide[..1], &row, false), (Status::InvalidArgumentLength, "circles".into()));
        assert_eq!(refusal(&circles, &guide[..7], &row, false), (Status::InvalidArgumentLength, "guide".into()));
        assert_eq!(refusal(&circles, &guide, &row[..1], false), (Status::InvalidArgumentLength, "row".into()));
        assert_eq!(refusal(&circles, &guide, &row[..2], true), (Status::InvalidArgumentLength, "row".into()));
        assert_eq!(refusal(&circles, &guide, &[], true), (Status::InvalidArgumentLength, "row".into()));
        let moved = |points: &[DVec3], k: usize, by: DVec3| {
            let mut points = points.to_vec();
            points[k] += by;
            points
        };
        assert_eq!(refusal(&circles, &moved(&guide, 3, 0.1 * DVec3::Z), &row, false).1, "guide[3]");
        assert_eq!(refusal(&circles, &guide, &moved(&row, 2, 0.1 * DVec3::Z), false).1, "row[2]");
        let nan = refusal(&circles, &moved(&guide, 3, DVec3::NAN), &row, false);
        assert_eq!(nan, (Status::InvalidValue, "guide[3]".into()));
        assert_eq!(
            refusal(&circles, &guide, &moved(&row, 2, DVec3::NAN), false),
            (Status::InvalidValue, "row[2]".into())
        );
        let mut bad = circles.clone();
        bad[2].radius = f64::NAN;
        assert_eq!(refusal(&bad, &guide, &row, false), (Status::InvalidValue, "circles[2]".into()));
        let twice = [row[0], row[1], row[1]];
        assert_eq!(refusal(&circles, &guide, &twice, false), (Status::Degenerate, "row[2]".into()));
        assert_eq!(refusal(&circles, &guide, &[row[0], row[1], row[0]], true), (Status::Degenerate, "row[0]".into()));
        let start = strip(&circles, &guide, row[2] + DVec3::Z).unwrap_err();
        assert_eq!((start.status(), start.place()), (Status::NotCircular, "start"));
        assert_eq!(strip(&circles, &[], row[2]).unwrap_err().place(), "guide");
        let start = strip(&circles, &guide, guide[0]).unwrap_err();
        assert_eq!((start.status(), start.place()), (Status::Degenerate, "start"));
        // Circles in one plane, and circles that touch where the column is.
        let flat = [1.0, 2.0].map(|radius| Circle { center: DVec3::ZERO, normal: DVec3::Z, radius });
        assert_eq!(column(&flat, DVec3::X).unwrap_err().status(), Status::Degenerate);
        let touching = [DVec3::Z, DVec3::Y].map(|normal| Circle { center: DVec3::ZERO, normal, radius: 1.0 });
        assert_eq!(column(&touching, DVec3::X).unwrap().len(), 2);
        assert_eq!(column(&touching, DVec3::Z).unwrap_err().place(), "start");
    }
}
