//! Closed strips: whether the cyclidic net of a closed guide is smooth, and the last circle of a strip that closes (section 4.2).
//!
//! **Holonomy.** Around a closed polygon of `n` edges a frame is mirrored at each edge's bisecting plane, and its first tangent
//! turned round as often (see `frame.rs`). With `H` the product of the reflections it comes back as `t1 → (−1)ⁿ H t1`, `t2 → H
//! t2`, `n → H n`. So for even `n` it comes back to itself where `H = 1`, whatever the frame; for odd `n` where `H` is a
//! reflection, and then `t1` must be the vector that it reverses.
//!
//! **Pseudo-spherical.** The paper says that a closed net is smooth if and only if the polygon is parallel to one inscribed in
//! a sphere. The chords of a sphere about the origin are mirrored into each other, `y_{k+1} = y_k − 2 (y_k·d_k) d_k`: such a
//! polygon exists where `H` has a fixed vector `y_0` (whose chords are not all zero, and point forwards if lengths are to be
//! positive). For odd `n` a fixed vector makes `H` a reflection, and both are the same. For even `n` `H` is a rotation, which
//! always fixes its axis; that it is the identity is one condition more. Planar polygons inscribed in a circle meet it for all
//! `n`, random hexagons on a sphere do not.
//!
//! **The last circle.** `C_0` is the circle of the first quad, through `P_0` and the strip's first other point `P`; `C_f` that
//! of the last but one, through the last point `P_f` of the guide (Fig. 14). The closing quad's circle goes through `P_0` and
//! `P_f` and meets `C_0` and `C_f` once more. If `C_0` and `C_f` are on one sphere it is that through `P`. If not, it is on the
//! sphere through `C_0` and `P_f` and on that through `C_f` and `P_0`, and `P` must move to where their circle meets `C_0`.
//!
//! The inversion at `P_0` makes planes of both spheres, a line of `C_0` and of the circle that is sought; so planar strips are no
//! exception and no root is to be chosen.

use glam::{DMat3, DVec3};

use super::frame::Frame;
use super::inversion::{GeneralCircle, Inversion};
use super::strip::{Strip, on_a_line};
use super::strip_of_circles::check_circle;
use crate::error::{Error, Result, Status};
use crate::geometry::circle::{Circle, PARALLEL, reflect};
use crate::linalg::small::symmetric_eigen;
use crate::mesh::Grid;
use crate::mesh::grid::{check_finite, diagonal};

/// How far a frame may come back from itself for each edge, as a difference of unit vectors: round-off is below 1e-15.
const CLOSED: f64 = 1e-11;

/// Distance of the first and the last point, over the diagonal, below which the last repeats the first.
const REPEATED: f64 = 1e-12;

/// Distance of points from circles, and of `C_f` from the sphere of `C_0`, over the circles' extent, up to which they are on it.
const ON: f64 = 1e-9;

/// How a frame comes back around a closed polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Holonomy {
    /// The product of the reflections.
    pub matrix: DMat3,
    /// The Frobenius norm of its difference from the identity, for an even number of edges, or from the reflection that
    /// reverses `tangent`, for an odd one. It is of first order in the angle that is missing; the trace, which the latter makes
    /// 1, of second.
    pub residual: f64,
    /// Whether the residual is round-off: the net is smooth across the seam.
    pub closes: bool,
    /// For an odd number of edges, the first tangent that the frame at the first point must have, along the first edge rather
    /// than against it.
    pub tangent: Option<DVec3>,
    /// Whether the last point repeated the first and was left out.
    pub is_merged: bool,
}

/// The holonomy of a closed polygon, 3 points or more; the last is followed by the first and need not repeat it.
///
/// # Errors
/// Fewer than 3 points, a coordinate that is not finite; status `Degenerate`: consecutive points coincide.
pub fn holonomy(points: &[DVec3]) -> Result<Holonomy> {
    let (ring, is_merged) = ring(points)?;
    let matrix = product(&edges(ring));
    let odd = ring.len() % 2 == 1;
    let tangent = odd.then(|| {
        // H = (reflection reversing t) (rotation about t): its symmetric part has the eigenvalues −1 and twice the cosine.
        let (_, [tangent, ..]) = symmetric_eigen(0.5 * (matrix + matrix.transpose()));
        if tangent.dot(ring[1] - ring[0]) < 0.0 { -tangent } else { tangent }
    });
    let wanted = match tangent {
        Some(t) => DMat3::IDENTITY - 2.0 * DMat3::from_cols(t.x * t, t.y * t, t.z * t),
        None => DMat3::IDENTITY,
    };
    let residual = (matrix - wanted).to_cols_array().iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    Ok(Holonomy { matrix, residual, closes: residual <= CLOSED * ring.len() as f64, tangent, is_merged })
}

/// A frame at the first point of a closed polygon with which the cyclidic net is smooth across the seam: `wish`, for an even number
/// of edges; with the first tangent that is possible and the normal as near as possible, for an odd one.
///
/// # Errors
/// As [`holonomy`], or `wish` is no frame. Status `NotClosed`: no frame comes back to itself; the reason has the residual.
/// `Degenerate`: the normal wished for is along the only first tangent.
pub fn closed_frame(points: &[DVec3], wish: &Frame) -> Result<Frame> {
    wish.check("wish")?;
    let found = holonomy(points)?;
    if !found.closes {
        let reason = format!("a frame that is handed on around the polygon comes back off by {:e}", found.residual);
        return Err(Error::new(Status::NotClosed, reason).at("points"));
    }
    let Some(tangent) = found.tangent else { return Ok(*wish) };
    Frame::of_tangent_one(tangent, wish.normal).ok_or_else(|| {
        let reason = "its normal is along the only first tangent with which the frame closes";
        Error::new(Status::Degenerate, reason).at("wish")
    })
}

/// A closed polygon inscribed in a sphere about the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Spherical {
    /// Its points, as many as the ring has.
    pub points: Vec<DVec3>,
    /// The number of its edges that have no length or point the other way than the ring's.
    pub reversed_count: usize,
}

/// The closed polygon inscribed in a sphere whose edges are parallel to those of a ring and nearest to them in length; none where
/// the ring is not pseudo-spherical. Where the ring itself is inscribed in a sphere and its net closes, it is the ring, moved.
///
/// # Errors
/// As [`holonomy`].
pub fn parallel_on_sphere(points: &[DVec3]) -> Result<Option<Spherical>> {
    let (ring, _) = ring(points)?;
    let edges = edges(ring);
    let matrix = product(&edges);
    let (_, vectors) = symmetric_eigen(0.5 * (matrix + matrix.transpose()));
    let is_fixed = |v: &DVec3| (matrix * *v).distance(*v) <= CLOSED * ring.len() as f64;
    let fixed: Vec<DVec3> = vectors.into_iter().filter(is_fixed).collect();
    // The lengths −2 y_k·d_k are linear in y_0 = Σ cᵢ vᵢ: least squares for c, with the pseudo-inverse of the 3×3 normal
    // equations (a fixed vector at right angles to all edges gives none any length).
    let lengths = |first: DVec3| {
        let mut y = first;
        let mut length = |edge: &DVec3| {
            let length = -2.0 * y.dot(edge.normalize());
            y = reflect(y, *edge);
            length
        };
        edges.iter().map(&mut length).collect::<Vec<f64>>()
    };
    let columns: Vec<Vec<f64>> = (0..3).map(|i| fixed.get(i).map_or(vec![0.0; edges.len()], |&v| lengths(v))).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let wanted: Vec<f64> = edges.iter().map(|edge| edge.length()).collect();
    let normal = DMat3::from_cols_array(&std::array::from_fn(|k| dot(&columns[k / 3], &columns[k % 3])));
    let right = DVec3::from_array(std::array::from_fn(|i| dot(&columns[i], &wanted)));
    let (values, vectors) = symmetric_eigen(normal);
    let terms = (0..3).filter(|&i| values[i] > 1e-12 * edges.len() as f64);
    let solution = terms.map(|i| vectors[i].dot(right) / values[i] * vectors[i]).sum::<DVec3>();
    let first = fixed.iter().zip(solution.to_array()).map(|(v, c)| c * *v).sum::<DVec3>();
    if !(first.length() > 1e-9 * wanted.iter().sum::<f64>() / edges.len() as f64) {
        return Ok(None);
    }
    let reversed_count = lengths(first).into_iter().filter(|&length| length <= 1e-12 * first.length()).count();
    let mut points = vec![first];
    edges[..edges.len() - 1].iter().for_each(|&edge| points.push(reflect(points[points.len() - 1], edge)));
    Ok(Some(Spherical { points, reversed_count }))
}

/// Which circles were on one sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Case {
    /// `C_0` and `C_f` are on one sphere or plane; `P` stays.
    OneSphere,
    /// They are not; `P` moves.
    TwoSpheres,
}

/// The circle that closes a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closing {
    /// Which of the paper's two cases it is.
    pub case: Case,
    /// The circle of the closing quad.
    pub circle: Circle,
    /// The strip's first point beside the guide, on `C_0`: `P`, or where it moves.
    pub first: DVec3,
    /// The last, on `C_f`.
    pub last: DVec3,
    /// Whether the closing quad `P_f`, `last`, `first`, `P_0` crosses itself.
    pub is_crossed: bool,
}

/// The last circle of a closing strip: `first_circle` is `C_0`, through `start`, `P`, and the guide's first point, `P_0`;
/// `last_circle` is `C_f`, through the guide's last point, `P_f`.
///
/// # Errors
/// Coordinates that are not finite, a circle that is none. Status `NotCircular`: a point is not on its circle (1e-9 of the extent).
/// `Degenerate`: points coincide, a circle goes through the other one's point, or the circle sought touches `C_0` or `C_f`.
pub fn close(first_circle: &Circle, last_circle: &Circle, start: DVec3, p0: DVec3, pf: DVec3) -> Result<Closing> {
    check_circle(first_circle).map_err(|error| error.at("first_circle"))?;
    check_circle(last_circle).map_err(|error| error.at("last_circle"))?;
    let extent = first_circle.radius + last_circle.radius + first_circle.center.distance(last_circle.center);
    for (name, point, circle) in [("start", start, first_circle), ("p0", p0, first_circle), ("pf", pf, last_circle)] {
        check_finite(name, &[point]).map_err(|error| error.with_place(name))?;
        let distance = circle.distance(point);
        if !(distance <= ON * extent) {
            let reason = format!("it is {distance:e} off its circle; the circles are {extent} large");
            return Err(Error::new(Status::NotCircular, reason).at(name));
        }
    }
    let degenerate = |name: &str, reason: &str| Error::new(Status::Degenerate, reason).at(name);
    let squared = p0.distance_squared(pf);
    if !(squared > (ON * extent).powi(2)) {
        return Err(degenerate("pf", "it coincides with p0"));
    }
    if !(start.distance(p0) > ON * extent) {
        return Err(degenerate("start", "it coincides with p0"));
    }
    let inversion = Inversion::new(p0, squared)?;
    let (p, f) = (inversion.point(start), inversion.point(pf));
    // The line that is C_0's image is along its tangent at P_0.
    let along = first_circle.tangent_at(p0);
    let plane = along.cross(f - p);
    if !(plane.length() > PARALLEL * (f - p).length()) {
        return Err(degenerate("pf", "it is on the first circle"));
    }
    let plane = plane.normalize();
    let GeneralCircle::Circle(image) = inversion.circle(last_circle) else {
        return Err(degenerate("last_circle", "it goes through p0"));
    };
    // How far C_f is off the sphere of C_0 and P_f; the inversion scales lengths at a point by its squared distance from P_0
    // over the ratio.
    let off = (0..6).map(|k| {
        let point = last_circle.point_at(pf, f64::from(k) * std::f64::consts::FRAC_PI_3);
        (inversion.point(point) - f).dot(plane).abs() * point.distance_squared(p0) / squared
    });
    let case = if off.fold(0.0, f64::max) <= ON * extent { Case::OneSphere } else { Case::TwoSpheres };
    let (direction, first) = match case {
        Case::OneSphere => ((f - p).reject_from_normalized(image.normal), start),
        Case::TwoSpheres => {
            let direction = plane.cross(image.normal);
            // Where the line through f meets C_0's, both in one plane.
            let across = plane.cross(along);
            let s = (p - f).dot(across) / direction.dot(across);
            let met = f + s * direction;
            if !(direction.dot(across).abs() > PARALLEL * direction.length() && met.is_finite()) {
                return Err(degenerate("first_circle", "the closing circle touches it at p0"));
            }
            (direction, inversion.point(met))
        }
    };
    let direction = direction.normalize_or_zero();
    let half = (image.center - f).dot(direction);
    if !(half.abs() > ON * image.radius) {
        return Err(degenerate("last_circle", "the closing circle touches it at pf"));
    }
    let last = inversion.point(f + 2.0 * half * direction);
    let circle = Circle::through(pf, last, p0);
    let circle = circle.ok_or_else(|| degenerate("pf", "the corners of the closing quad are on a line"))?;
    let is_crossed = is_crossed(&circle, [pf, last, first, p0]);
    Ok(Closing { case, circle, first, last, is_crossed })
}

/// A closed strip: as many quads as points on either side.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedStrip {
    /// The guide's points.
    pub guide: Vec<DVec3>,
    /// The points on the other side.
    pub border: Vec<DVec3>,
    /// The closing circle.
    pub closing: Closing,
    /// The quads that cross themselves; quad `n − 1` is the closing one.
    pub flipped: Vec<usize>,
}

impl ClosedStrip {
    /// The strip as a grid of two columns, the guide first, whose rows wrap.
    ///
    /// # Errors
    /// None for a strip that [`closed_strip`] made.
    pub fn grid(&self) -> Result<Grid> {
        let points = self.guide.iter().zip(&self.border).flat_map(|(&p, &q)| [p, q]).collect();
        Grid::new(points, self.guide.len(), 2, [true, false])
    }
}

/// Closes a strip, of 2 points on either side or more, with the guide's last point `last`: the point opposite to it follows,
/// and the strip's first point beside the guide moves where it must.
///
/// # Errors
/// As [`close`], or `last` coincides with the strip's last point.
pub fn closed_strip(strip: &Strip, last: DVec3) -> Result<ClosedStrip> {
    check_finite("last", &[last]).map_err(|error| error.with_place("last"))?;
    let count = strip.guide.len();
    if count < 2 || strip.border.len() != count {
        let reason = format!("expected 2 points or more on either side, found {count} and {}", strip.border.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("strip"));
    }
    let mut guide = strip.guide.clone();
    guide.push(last);
    let mut border = strip.border.clone();
    let circle = |k: usize| Circle::through(guide[k + 1], border[k], guide[k]).ok_or_else(|| on_a_line(k));
    let closing = close(&circle(0)?, &circle(count - 1)?, border[0], guide[0], last)?;
    border[0] = closing.first;
    border.push(closing.last);
    let mut flipped = Vec::new();
    for k in 0..=count {
        let next = if k == count { 0 } else { k + 1 };
        let corners = [guide[k], border[k], border[next], guide[next]];
        let circle = Circle::through(corners[0], corners[1], corners[3]).ok_or_else(|| on_a_line(k))?;
        if is_crossed(&circle, corners) {
            flipped.push(k);
        }
    }
    Ok(ClosedStrip { guide, border, closing, flipped })
}

/// Whether the corners are not in cyclic order.
fn is_crossed(circle: &Circle, corners: [DVec3; 4]) -> bool {
    let [_, b, c, d] = corners.map(|corner| circle.angle_between(corners[0], corner));
    !(b < c && c < d || b > c && c > d)
}

/// The polygon without a repeated end, and whether there was one.
fn ring(points: &[DVec3]) -> Result<(&[DVec3], bool)> {
    check_finite("points", points)?;
    let is_merged = points.len() > 1 && points[0].distance(points[points.len() - 1]) <= REPEATED * diagonal(points);
    let ring = if is_merged { &points[..points.len() - 1] } else { points };
    if ring.len() < 3 {
        let reason = format!("expected at least 3 points, found {}", ring.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
    }
    let diagonal = diagonal(ring);
    match (0..ring.len()).find(|&k| ring[k].distance(ring[(k + 1) % ring.len()]) <= REPEATED * diagonal) {
        None => Ok((ring, is_merged)),
        Some(k) => Err(Error::new(Status::Degenerate, "it coincides with the next").at(format!("points[{k}]"))),
    }
}

fn edges(ring: &[DVec3]) -> Vec<DVec3> {
    (0..ring.len()).map(|k| ring[(k + 1) % ring.len()] - ring[k]).collect()
}

/// The product of the reflections, that at the first edge applied first.
fn product(edges: &[DVec3]) -> DMat3 {
    let image = |v: DVec3| edges.iter().fold(v, |v, edge| reflect(v, edge.normalize()));
    DMat3::from_cols(image(DVec3::X), image(DVec3::Y), image(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::canal::frame::{closing_gap, frames};
    use crate::geometry::canal::strip::{of_border_edges, of_lengths};
    use crate::geometry::random::Random;

    fn polygon(count: usize) -> Vec<DVec3> {
        let angle = |k: usize| TAU * k as f64 / count as f64;
        (0..count).map(|k| DVec3::new(angle(k).cos(), angle(k).sin(), 0.0)).collect()
    }

    fn spherical(random: &mut Random, count: usize) -> Vec<DVec3> {
        (0..count).map(|_| DVec3::new(1.0, 2.0, 3.0) + 1.7 * random.vector().normalize()).collect()
    }

    /// How far a frame comes back from itself, handed on edge by edge.
    fn gap(points: &[DVec3], frame: Frame) -> f64 {
        let back =
            edges(points).iter().fold(frame, |frame, &edge| frame.across(edge, super::super::frame::Direction::One));
        back.distance(&frame)
    }

    #[test]
    fn polygons_close_or_do_not() {
        let mut random = Random(12);
        let wish = Frame::of_angles(0.3, 0.8, 1.9);
        let cases = [
            ("hexagon", polygon(6), true),
            ("heptagon", polygon(7), true),
            ("spherical heptagon", spherical(&mut random, 7), true),
            ("spherical hexagon", spherical(&mut random, 6), false),
            ("heptagon in space", (0..7).map(|_| random.vector()).collect(), false),
            ("hexagon in space", (0..6).map(|_| random.vector()).collect(), false),
        ];
        for (name, points, closes) in cases {
            let found = holonomy(&points).unwrap();
            let n = points.len();
            assert_eq!(found.closes, closes, "{name} {}", found.residual);
            assert!((found.residual < 1e-13 * n as f64) == closes, "{name} {}", found.residual);
            let trace = found.matrix.x_axis.x + found.matrix.y_axis.y + found.matrix.z_axis.z;
            assert_eq!((trace - if n % 2 == 1 { 1.0 } else { 3.0 }).abs() < 1e-10, closes, "{name} {trace}");
            assert_eq!(found.tangent.is_some(), n % 2 == 1);
            match closed_frame(&points, &wish) {
                Ok(frame) => {
                    assert!(closes && gap(&points, frame) < 1e-10, "{name}");
                    assert!(n % 2 == 0 || frame.t1.dot(points[1] - points[0]) > 0.0);
                    // For odd n no other first tangent does.
                    assert_eq!(gap(&points, wish) < 1e-10, n % 2 == 0);
                }
                Err(error) => {
                    assert!(!closes && error.to_string().contains("off by"), "{name}");
                    assert_eq!((error.status(), error.place()), (Status::NotClosed, "points"));
                    assert!(gap(&points, wish) > 1e-3);
                }
            }
            // A repeated end is left out.
            let repeated = [points.clone(), vec![points[0]]].concat();
            let again = holonomy(&repeated).unwrap();
            assert!(again.is_merged && again.matrix == found.matrix && !found.is_merged);
        }
    }

    #[test]
    fn parallel_polygons_on_a_sphere_are_found() {
        let mut random = Random(3);
        let points = spherical(&mut random, 7);
        // Parallel to it, other lengths that close: the sum of a spherical one and of a change that keeps it closed.
        let found = parallel_on_sphere(&points).unwrap().unwrap();
        assert_eq!(found.reversed_count, 0);
        let offset = found.points[0] - points[0];
        assert!(found.points.iter().zip(&points).all(|(a, b)| a.distance(*b + offset) < 1e-9));
        assert!(found.points.iter().all(|p| (p.length() - 1.7).abs() < 1e-9));
        for count in [5, 6] {
            let scaled: Vec<DVec3> = polygon(count).iter().map(|p| 2.0 * *p + DVec3::ONE).collect();
            let found = parallel_on_sphere(&scaled).unwrap().unwrap();
            assert!(found.reversed_count == 0);
            assert!(found.points.iter().all(|p| (p.length() - 2.0).abs() < 1e-9), "{count}");
        }
        // An odd polygon in space is not; an even one always is, if edges may turn round.
        let space: Vec<DVec3> = (0..7).map(|_| random.vector()).collect();
        assert_eq!(parallel_on_sphere(&space).unwrap(), None);
        let found = parallel_on_sphere(&space[..6]).unwrap().unwrap();
        let radius = found.points[0].length();
        for k in 0..6 {
            let (edge, parallel) = (space[(k + 1) % 6] - space[k], found.points[(k + 1) % 6] - found.points[k]);
            assert!(edge.cross(parallel).length() < 1e-12 * edge.length() * radius);
            assert!((found.points[k].length() - radius).abs() < 1e-12 * radius);
        }
        assert!(!holonomy(&space[..6]).unwrap().closes);
    }

    /// Points of a torus at uneven angles.
    fn on_torus(count: usize, v: f64) -> Vec<DVec3> {
        let angle = |k: usize| TAU * (k as f64 + 0.2 * (k as f64).sin()) / count as f64;
        let point =
            |u: f64| DVec3::new((2.0 + 0.7 * v.cos()) * u.cos(), (2.0 + 0.7 * v.cos()) * u.sin(), 0.7 * v.sin());
        (0..count).map(|k| point(angle(k))).collect()
    }

    fn off_circles(closed: &ClosedStrip) -> f64 {
        let n = closed.guide.len();
        let off = |k: usize| {
            let next = (k + 1) % n;
            let circle = Circle::through(closed.guide[k], closed.border[k], closed.guide[next]).unwrap();
            circle.distance(closed.border[next])
        };
        (0..n).map(off).fold(0.0, f64::max)
    }

    #[test]
    fn a_strip_of_a_torus_closes_through_its_first_point() {
        for (count, v) in [(9, 1.2), (12, 1.2), (12, -0.4)] {
            let (guide, across) = (on_torus(count, 0.5), on_torus(count, v));
            let length = guide[0].distance(across[0]);
            let lengths = vec![length; count - 1];
            let strip = of_lengths(&guide[..count - 1], across[0], &lengths, &Default::default()).unwrap();
            let closed = closed_strip(&strip, guide[count - 1]).unwrap();
            assert_eq!(closed.closing.case, Case::OneSphere);
            assert!(closed.border.iter().zip(&across).all(|(a, b)| a.distance(*b) < 1e-10));
            assert!(off_circles(&closed) < 1e-10 && closed.flipped.is_empty() && !closed.closing.is_crossed);
            assert!(closed.border[0] == across[0]);
            // Its guide is on a circle, so that the net is smooth across the seam.
            let frame = closed_frame(&closed.guide, &Frame::of_angles(0.1, 0.2, 1.5)).unwrap();
            let grid = closed.grid().unwrap();
            assert!(closing_gap(&grid, &frames(&grid, frame).unwrap()) < 1e-10);
        }
    }

    #[test]
    fn a_disturbed_strip_closes_after_its_first_point_moved() {
        let mut random = Random(8);
        for count in [9, 12] {
            for is_planar in [false, true] {
                let (mut guide, mut across) = (on_torus(count, 0.5), on_torus(count, 1.2)[0]);
                if is_planar {
                    guide.iter_mut().for_each(|p| p.z = 0.0);
                    across.z = 0.0;
                } else {
                    guide.iter_mut().for_each(|p| *p += 0.02 * random.vector());
                }
                let ratio = across.length() / guide[0].length();
                let edges: Vec<f64> = guide[..count - 1]
                    .windows(2)
                    .map(|pair| ratio * pair[0].distance(pair[1]) * random.between(0.97, 1.03))
                    .collect();
                let strip = of_border_edges(&guide[..count - 1], across, &edges).unwrap();
                let closed = closed_strip(&strip, guide[count - 1]).unwrap();
                let first = Circle::through(guide[1], across, guide[0]).unwrap();
                let moved = closed.border[0].distance(across);
                // In a plane all circles are on one.
                let case = if is_planar { Case::OneSphere } else { Case::TwoSpheres };
                assert_eq!(closed.closing.case, case);
                assert!(is_planar == (moved == 0.0) && first.distance(closed.border[0]) < 1e-10);
                assert!(off_circles(&closed) < 1e-10 && closed.flipped.is_empty(), "{}", off_circles(&closed));
                // The points of the closing quad are on both spheres.
                let circle = closed.closing.circle;
                for point in [guide[count - 1], guide[0], closed.border[0], closed.border[count - 1]] {
                    assert!(circle.distance(point) < 1e-10);
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_closed_is_named() {
        let place = |error: Error| (error.status(), error.place().to_string());
        let case = |status, place: &str| (status, place.to_string());
        assert_eq!(place(holonomy(&polygon(2)).unwrap_err()), case(Status::InvalidArgumentLength, "points"));
        let mut points = polygon(5);
        points[3] = points[2];
        assert_eq!(place(holonomy(&points).unwrap_err()), case(Status::Degenerate, "points[2]"));
        points[3] = DVec3::NAN;
        assert_eq!(place(parallel_on_sphere(&points).unwrap_err()), case(Status::InvalidValue, "points[3]"));
        let (guide, across) = (on_torus(9, 0.5), on_torus(9, 1.2));
        let first = Circle::through(guide[0], across[0], guide[1]).unwrap();
        let last = Circle::through(guide[7], across[7], guide[8]).unwrap();
        let (p, p0, pf) = (across[0], guide[0], guide[8]);
        assert!(close(&first, &last, p, p0, pf).is_ok());
        let refusal = |a: &Circle, b: &Circle, p, p0, pf| place(close(a, b, p, p0, pf).unwrap_err());
        assert_eq!(refusal(&first, &last, p + DVec3::Z, p0, pf), case(Status::NotCircular, "start"));
        assert_eq!(refusal(&first, &last, p, p0, pf * 1.1), case(Status::NotCircular, "pf"));
        assert_eq!(refusal(&first, &last, p, DVec3::NAN, pf), case(Status::InvalidValue, "p0"));
        assert_eq!(refusal(&first, &last, p0, p0, pf), case(Status::Degenerate, "start"));
        assert_eq!(refusal(&first, &first, p, p0, p0), case(Status::Degenerate, "pf"));
        assert_eq!(refusal(&first, &first, p, p0, guide[1]), case(Status::Degenerate, "pf"));
        let broken = Circle { radius: 0.0, ..first };
        assert_eq!(refusal(&broken, &last, p, p0, pf), case(Status::InvalidValue, "first_circle"));
        let strip = of_lengths(&guide[..8], p, &[p.distance(p0); 8], &Default::default()).unwrap();
        assert_eq!(place(closed_strip(&strip, guide[0]).unwrap_err()).0, Status::Degenerate);
        assert_eq!(place(closed_strip(&strip, DVec3::NAN).unwrap_err()), case(Status::InvalidValue, "last"));
        let wish = Frame { t1: DVec3::ZERO, ..Frame::of_angles(0.0, 0.0, 0.0) };
        assert_eq!(place(closed_frame(&polygon(6), &wish).unwrap_err()), case(Status::InvalidValue, "wish"));
    }
}
