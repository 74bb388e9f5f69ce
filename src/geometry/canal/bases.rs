//! Base surfaces: grids from polylines and a rule of motion, and the exact frame at point `(0, 0)` of those that are circular.
//!
//! | rule | column 0 | row 0 | quads |
//! |---|---|---|---|
//! | [`revolution`] | the profile | a circle about the axis | planar and circular |
//! | [`monge`] | the rail, in space | the profile, planar | planar and circular |
//! | [`moulding`] | the rail, planar | the profile, in an orthogonal plane | planar and circular; rows and columns are planar |
//! | [`translation`] | the rail | the profile | planar (parallelograms), not circular in general |
//! | [`scale_translation`] | the rail | the profile | planar (trapezoids), not circular in general |
//!
//! A profile or rail whose last point repeats its first is closed: the repeated point is left out, and the grid wraps.
//!
//! All circular ones consist of isosceles trapezoids: two sides of a quad are mirror images of each other. That is exact, however
//! coarse the polylines are; nothing is a sample of a smooth surface that is circular only in the limit. Source: the kinds of
//! surfaces of section 1.2 and Table 1 of Mesnil et al. 2018; the discrete constructions are ours.

use glam::DVec3;

pub use super::base::{Base, InvertedBase};
use super::frame::Frame;
use super::polyline::{COINCIDE, NO_LENGTH, direction_of_straight, plane_normal, polyline, start_tangent};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::reflect;
use crate::mesh::Grid;
use crate::mesh::grid::{check_finite, diagonal};

/// What sweeping a profile along a rail gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Swept {
    /// The net and its frame.
    pub base: Base,
    /// The angle between the normal of the profile's plane and the tangent of the rail at its start. The net is circular
    /// whatever it is; arcs along the rail start along the normal, so lines of curvature follow a rail smoothly only if it is
    /// small.
    pub obliquity_rad: f64,
    /// The number of edges along the rail's direction that point the other way than the rail's own: there the profile reaches
    /// beyond the evolute, and quads cross themselves.
    pub reversed_count: usize,
    /// For a closed rail, how far the profile is from itself after one turn, in model units; else 0. Where it is more than
    /// 1e-9 of the extent the grid was left open, with the rail's start again as last row.
    pub closing_gap: f64,
}

/// The surface of revolution of a profile about an axis. Column 0 is the profile, row `i` runs along the circle of its point
/// `i`, `columns` points from 0 to `angle_rad` (0 to 2π, right-handed about `axis_direction`); a full turn wraps. Profile points
/// are moved into the plane through the axis, by at most 1e-9 of the extent.
///
/// # Errors
/// Fewer than two profile points or columns (three where they wrap), a number that is not finite or out of range. Status
/// `NotPlanar`: the profile is not in a plane through the axis; `Degenerate`: two consecutive points coincide, or the profile
/// meets or crosses the axis. The place is `profile[i]`.
pub fn revolution(
    profile: &[DVec3],
    axis_point: DVec3,
    axis_direction: DVec3,
    angle_rad: f64,
    columns: usize,
) -> Result<Base> {
    let (profile, is_closed) = polyline("profile", profile)?;
    let vector = |name: &str, value: DVec3| check_finite(name, &[value]).map_err(|error| error.with_place(name));
    vector("axis_point", axis_point)?;
    vector("axis_direction", axis_direction)?;
    let Some(axis) = axis_direction.try_normalize() else {
        return Err(Error::new(Status::InvalidValue, "expected a direction, found no length").at("axis_direction"));
    };
    let turn = std::f64::consts::TAU;
    if !(finite("angle_rad", angle_rad)? > 0.0 && angle_rad <= turn * (1.0 + COINCIDE)) {
        let reason = format!("expected an angle above 0 and up to 2π, found {angle_rad}");
        return Err(Error::new(Status::InvalidValue, reason).at("angle_rad"));
    }
    let wraps = angle_rad >= turn * (1.0 - COINCIDE);
    // Checked here as well as by the grid: below, one column would divide by 0.
    let least = if wraps { 3 } else { 2 };
    if columns < least {
        let reason = format!("expected at least {least}, found {columns}");
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("columns"));
    }
    // Before as many are allocated.
    if profile.len().checked_mul(columns).is_none_or(|count| u32::try_from(count).is_err()) {
        let reason = format!("{columns} times {} points do not fit 32-bit indices", profile.len());
        return Err(Error::new(Status::TooLarge, reason).at("columns"));
    }
    let across = |point: DVec3| (point - axis_point).reject_from_normalized(axis);
    let farthest = profile
        .iter()
        .map(|&point| across(point))
        .fold(DVec3::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
    let extent = farthest.length().max(diagonal(profile));
    // Outward in the profile's half-plane, and where the rotation goes first.
    let outward = farthest.normalize_or_zero();
    let forward = axis.cross(outward);
    let mut radii = Vec::with_capacity(profile.len());
    for (i, &point) in profile.iter().enumerate() {
        let (radius, height) = (across(point).dot(outward), across(point).dot(forward));
        if height.abs() > COINCIDE * extent {
            let reason = format!("expected the profile in a plane through the axis, found a point {height:e} off it");
            return Err(Error::new(Status::NotPlanar, reason).at(format!("profile[{i}]")));
        }
        if !(radius > COINCIDE * extent) {
            let reason =
                format!("expected the profile on one side of the axis, found a point at the distance {radius:e}");
            return Err(Error::new(Status::Degenerate, reason).at(format!("profile[{i}]")));
        }
        radii.push(radius);
    }
    let step = angle_rad / (if wraps { columns } else { columns - 1 }) as f64;
    let directions: Vec<DVec3> = (0..columns)
        .map(|j| {
            let (sine, cosine) = (j as f64 * step).sin_cos();
            cosine * outward + sine * forward
        })
        .collect();
    let foot = |point: DVec3| point - across(point);
    let row = |(&point, &radius): (&DVec3, &f64)| {
        directions.iter().map(|&direction| foot(point) + radius * direction).collect::<Vec<_>>()
    };
    let points = profile.iter().zip(&radii).flat_map(row).collect();
    let grid = Grid::new(points, profile.len(), columns, [is_closed, wraps])?;
    let tangent = start_tangent(&grid.column(0)).reject_from_normalized(forward);
    Ok(Base { grid, frame: oriented(tangent, forward)? })
}

/// The surface of translation: `rail[i] + profile[j] − profile[0]`. Its quads are parallelograms.
///
/// # Errors
/// Fewer than two points (three different ones where closed), a coordinate that is not finite; status `Degenerate`:
/// consecutive points coincide. The place is `rail[i]` or `profile[i]`.
pub fn translation(rail: &[DVec3], profile: &[DVec3]) -> Result<Grid> {
    scale_translation(rail, profile, &vec![1.0; rail.len()])
}

/// The surface of scale-translation (Glymph et al. 2004): `rail[i] + factors[i] (profile[j] − profile[0])`. Its quads are
/// trapezoids: edges of all rows are parallel. One factor, above 0, for each rail point; a closed rail closes the grid
/// if the last factor is the first.
///
/// # Errors
/// As [`translation`]; another number of factors, or one that is not above 0: the place is `factors` or `factors[i]`.
pub fn scale_translation(rail: &[DVec3], profile: &[DVec3], factors: &[f64]) -> Result<Grid> {
    if factors.len() != rail.len() {
        let reason = format!("expected one factor for each of {} rail points, found {}", rail.len(), factors.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("factors"));
    }
    for (i, &factor) in factors.iter().enumerate() {
        let name = format!("factors[{i}]");
        if !(finite(&name, factor)? > 0.0) {
            let reason = format!("expected a factor above 0, found {factor}");
            return Err(Error::new(Status::InvalidValue, reason).at(name));
        }
    }
    let (open_rail, repeats) = polyline("rail", rail)?;
    let (profile, wraps_columns) = polyline("profile", profile)?;
    let wraps_rows = repeats && (factors[rail.len() - 1] - factors[0]).abs() <= COINCIDE * factors[0];
    let rail = if wraps_rows { open_rail } else { rail };
    let row = |(&start, &factor): (&DVec3, &f64)| {
        profile.iter().map(|&point| start + factor * (point - profile[0])).collect::<Vec<_>>()
    };
    let points = rail.iter().zip(factors).flat_map(row).collect();
    Grid::new(points, rail.len(), profile.len(), [wraps_rows, wraps_columns])
}

/// The Monge surface of a rail in space and a planar profile that starts on it. Column 0 is the rail, row 0 the profile.
///
/// Row `i + 1` is row `i` mirrored in the plane that bisects rail edge `i` orthogonally. A quad between them has two sides that
/// are mirror images and two that are orthogonal to the mirror: an isosceles trapezoid. The normal of the profile's plane is
/// handed on as tangent of the rail. The double reflection that hands on rotation-minimising frames (Wang et al. 2008) mirrors
/// a second time in the new profile's own plane, which turns the tangent forwards and leaves the profile as it is: so the
/// profile moves along the rail without twist.
///
/// # Errors
/// Fewer than two points, a coordinate that is not finite, a profile that does not start on the rail. Status `NotPlanar`: the
/// profile is not planar; `Degenerate`: consecutive points coincide, the profile's plane holds the rail's first edge, or
/// a profile point is in a bisecting plane, so that an edge has no length. The place is `rail[i]` or `profile[i]`.
pub fn monge(rail: &[DVec3], profile: &[DVec3]) -> Result<Swept> {
    polyline("rail", rail)?;
    polyline("profile", profile)?;
    let normal = match direction_of_straight(profile) {
        None => plane_normal("profile", profile)?,
        Some(direction) => start_tangent(rail).reject_from_normalized(direction),
    };
    sweep(rail, profile, normal)
}

/// The moulding surface of a planar rail and a profile in an orthogonal plane that starts on it. Column 0 is the rail, row 0 the
/// profile. The construction is that of [`monge`]; here all mirrors are orthogonal to the rail's plane, so column `j` is in
/// a plane parallel to it and row `i` in one orthogonal to it. It is a Combescure transform of a surface of revolution whose
/// parallels are the columns: transpose it ([`Base::transposed`]) for the layout of [`revolution`].
///
/// # Errors
/// As [`monge`]. Status `NotPlanar`: the rail is not planar; `InvalidValue` at `profile`: the planes are not orthogonal.
pub fn moulding(rail: &[DVec3], profile: &[DVec3]) -> Result<Swept> {
    polyline("rail", rail)?;
    polyline("profile", profile)?;
    let rail_normal = match direction_of_straight(rail) {
        None => Some(plane_normal("rail", rail)?),
        Some(_) => None,
    };
    let normal = match (direction_of_straight(profile), rail_normal) {
        (None, _) => plane_normal("profile", profile)?,
        // Of the planes through a straight profile the one that is orthogonal to the rail's; all are if the profile is.
        (Some(direction), Some(rail_normal)) if rail_normal.cross(direction).length() > COINCIDE => {
            rail_normal.cross(direction)
        }
        (Some(direction), _) => start_tangent(rail).reject_from_normalized(direction),
    };
    let normal = normal.normalize_or_zero();
    let cosine = rail_normal.map_or(0.0, |rail_normal| rail_normal.dot(normal).abs());
    if cosine > COINCIDE {
        let reason = format!("expected its plane orthogonal to the rail's, found an angle of cosine {cosine:e}");
        return Err(Error::new(Status::InvalidValue, reason).at("profile"));
    }
    sweep(rail, profile, normal)
}

/// Sweeps a profile by reflections; `normal` is that of its plane, of any length.
pub(super) fn sweep(rail: &[DVec3], profile: &[DVec3], normal: DVec3) -> Result<Swept> {
    let (open_rail, is_closed) = polyline("rail", rail)?;
    let (profile, wraps_columns) = polyline("profile", profile)?;
    let extent = diagonal(rail).max(diagonal(profile));
    let gap = profile[0].distance(rail[0]);
    if gap > COINCIDE * extent {
        let reason = format!("expected the rail's first point, found one {gap:e} from it");
        return Err(Error::new(Status::InvalidValue, reason).at("profile[0]"));
    }
    let first = (rail[1] - rail[0]).normalize_or_zero();
    let along = normal.normalize_or_zero().dot(first);
    if along.abs() <= COINCIDE {
        let reason = "expected the rail to leave the profile's plane, found its first edge in it";
        return Err(Error::new(Status::Degenerate, reason).at("rail[1]"));
    }
    let t1 = along.signum() * normal.normalize_or_zero();
    let mut reversed_count = 0;
    let mut points = profile.to_vec();
    points[0] = rail[0];
    for i in 1..rail.len() {
        let (edge, middle) = (rail[i] - rail[i - 1], 0.5 * (rail[i] + rail[i - 1]));
        let direction = edge.normalize_or_zero();
        for j in 0..profile.len() {
            let from = points[points.len() - profile.len()];
            let to = if j == 0 { rail[i] } else { middle + reflect(from - middle, direction) };
            let length = (to - from).dot(direction);
            if length.abs() <= NO_LENGTH * extent {
                let reason =
                    format!("profile[{j}] is in the plane that bisects the edge before it: a quad has no side");
                return Err(Error::new(Status::Degenerate, reason).at(format!("rail[{i}]")));
            }
            reversed_count += usize::from(length < 0.0);
            points.push(to);
        }
    }
    let last = &points[points.len() - profile.len()..];
    let turned = last.iter().zip(&points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    let closing_gap = if is_closed { turned } else { 0.0 };
    let wraps_rows = is_closed && closing_gap <= COINCIDE * extent;
    let rows = if wraps_rows { open_rail.len() } else { rail.len() };
    points.truncate(rows * profile.len());
    let tangent = start_tangent(profile).reject_from_normalized(t1);
    let frame = oriented(t1, tangent)?;
    let grid = Grid::new(points, rows, profile.len(), [wraps_rows, wraps_columns])?;
    let obliquity_rad = t1.angle_between(start_tangent(rail));
    Ok(Swept { base: Base { grid, frame }, obliquity_rad, reversed_count, closing_gap })
}

/// The frame of two orthogonal tangents.
fn oriented(t1: DVec3, t2: DVec3) -> Result<Frame> {
    Frame::of_tangent_one(t1, t1.cross(t2))
        .ok_or_else(|| Error::new(Status::Degenerate, "the tangents at its first point are parallel").at("profile[0]"))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::geometry::canal::base::off_circle;
    use crate::geometry::canal::combescure::{Lengths, combescure};
    use crate::geometry::canal::frame::{closing_gap, frames};
    use crate::geometry::random::Random;

    /// `count` points of a circle in the xz-plane about (x, 0, 0), from angle `from` to `to`.
    fn arc(x: f64, radius: f64, from: f64, to: f64, count: i32) -> Vec<DVec3> {
        let at = |i: i32| from + (to - from) * f64::from(i) / f64::from(count - 1);
        (0..count).map(|i| DVec3::new(x + radius * at(i).cos(), 0.0, radius * at(i).sin())).collect()
    }

    fn refusal<T: std::fmt::Debug>(result: Result<T>) -> (Status, String) {
        let error = result.unwrap_err();
        (error.status(), error.place().to_owned())
    }

    #[test]
    fn a_circle_revolved_is_a_torus_with_its_frames() {
        let base = revolution(&arc(2.0, 0.7, 0.0, TAU, 13), DVec3::ZERO, 3.0 * DVec3::Z, TAU, 16).unwrap();
        assert_eq!((base.grid.rows(), base.grid.columns(), base.grid.wraps()), (12, 16, [true; 2]));
        assert!(off_circle(&base.grid) < 1e-13);
        let frames = frames(&base.grid, base.frame).unwrap();
        assert!(closing_gap(&base.grid, &frames) < 1e-12);
        for (point, frame) in base.grid.points().iter().zip(&frames) {
            // From the nearest point of the center circle outwards, as (east) × (along the meridian) is.
            let center = 2.0 * DVec3::new(point.x, point.y, 0.0).normalize();
            assert!((point.distance(center) - 0.7).abs() < 1e-14);
            assert!(frame.normal.distance((center - point) / 0.7) < 1e-12, "{frame:?}");
        }
        // Part of a turn about an axis anywhere: all parallels are arcs about it, and column 0 is the profile.
        let mut random = Random(8);
        let (foot, axis) = (random.vector(), random.vector().normalize());
        let outward = axis.any_orthonormal_vector();
        let profile: Vec<DVec3> =
            (0..7).map(|i| foot + (f64::from(i) - 2.0) * axis + random.between(0.5, 2.0) * outward).collect();
        let base = revolution(&profile, foot, -axis, 1.0, 9).unwrap();
        assert_eq!(base.grid.wraps(), [false; 2]);
        for i in 0..7 {
            assert!(base.grid.at(i, 0).distance(profile[i]) < 1e-14);
            let radius = (profile[i] - foot).dot(outward);
            let [first, last] = [0, 8].map(|j| (base.grid.at(i, j) - foot).reject_from_normalized(axis));
            assert!((last.length() - radius).abs() < 1e-14 && (first.angle_between(last) - 1.0).abs() < 1e-13);
            assert!(first.cross(last).dot(axis) < 0.0);
        }
        assert!(off_circle(&base.grid) < 1e-12);
        super::super::frame::frames(&base.grid, base.frame).unwrap();
        assert!(base.frame.t2.distance(-axis.cross(outward)) < 1e-14);
    }

    #[test]
    fn a_profile_off_its_plane_or_across_the_axis_is_refused() {
        let good = arc(2.0, 0.7, 0.0, 3.0, 5);
        let revolve = |profile: &[DVec3], angle, columns| revolution(profile, DVec3::ZERO, DVec3::Z, angle, columns);
        let mut bad = good.clone();
        bad[2].y = 1e-6;
        assert_eq!(refusal(revolve(&bad, PI, 5)), (Status::NotPlanar, "profile[2]".to_owned()));
        bad[2] = DVec3::Z;
        assert_eq!(refusal(revolve(&bad, PI, 5)), (Status::Degenerate, "profile[2]".to_owned()));
        bad[2] = DVec3::new(-0.1, 0.0, 1.0);
        assert_eq!(refusal(revolve(&bad, PI, 5)), (Status::Degenerate, "profile[2]".to_owned()));
        bad[2] = DVec3::NAN;
        assert_eq!(refusal(revolve(&bad, PI, 5)), (Status::InvalidValue, "profile[2]".to_owned()));
        for (angle, columns, expected) in [
            (PI, 1, (Status::InvalidArgumentLength, "columns")),
            (TAU, 2, (Status::InvalidArgumentLength, "columns")),
            (PI, usize::MAX, (Status::TooLarge, "columns")),
            (PI, 1 << 31, (Status::TooLarge, "columns")),
            (0.0, 5, (Status::InvalidValue, "angle_rad")),
            (7.0, 5, (Status::InvalidValue, "angle_rad")),
            (f64::NAN, 5, (Status::InvalidValue, "angle_rad")),
        ] {
            let (status, place) = refusal(revolve(&good, angle, columns));
            assert_eq!((status, place.as_str()), expected);
        }
        assert_eq!(refusal(revolution(&good, DVec3::ZERO, DVec3::ZERO, 1.0, 3)).1, "axis_direction");
        assert_eq!(refusal(revolution(&good, DVec3::NAN, DVec3::Z, 1.0, 3)).1, "axis_point");
        assert_eq!(refusal(revolve(&good[..1], PI, 5)), (Status::InvalidArgumentLength, "profile".to_owned()));
    }

    /// A rail in space and a profile in a plane that is orthogonal to it at its start.
    fn helix(count: i32) -> (Vec<DVec3>, Vec<DVec3>) {
        let at = |i: i32| 2.0 * f64::from(i) / f64::from(count);
        let rail: Vec<DVec3> =
            (0..=count).map(|i| DVec3::new(3.0 * at(i).cos(), 3.0 * at(i).sin(), 2.0 * at(i))).collect();
        let (x, y) = (DVec3::X, DVec3::new(0.0, -2.0, 3.0).normalize());
        let profile = [(0.0, 0.0), (0.4, 0.1), (0.7, 0.5), (0.6, 1.2)].map(|(a, b)| rail[0] + a * x + b * y);
        (rail, profile.to_vec())
    }

    #[test]
    fn a_monge_surface_is_circular_and_its_profile_keeps_its_shape() {
        let (rail, profile) = helix(12);
        let swept = monge(&rail, &profile).unwrap();
        let grid = &swept.base.grid;
        assert_eq!((grid.rows(), grid.columns(), swept.reversed_count, swept.closing_gap), (13, 4, 0, 0.0));
        assert!(grid.column(0) == rail && grid.row(0) == profile);
        assert!(off_circle(grid) < 1e-13);
        for i in 1..grid.rows() {
            for j in 0..4 {
                for k in 0..j {
                    let distance = grid.at(i, j).distance(grid.at(i, k));
                    assert!((distance - profile[j].distance(profile[k])).abs() < 1e-13);
                }
            }
            // Rows are planar: the profile's plane is mirrored with it.
            assert!(plane_normal("row", grid.row(i)).is_ok());
        }
        let frames = frames(grid, swept.base.frame).unwrap();
        for i in 0..grid.rows() {
            for j in 0..4 {
                // The rail's tangent is the normal of the row's plane, at all its points.
                let frame = frames[grid.index(i, j)];
                assert!(frame.t1.distance(frames[grid.index(i, 0)].t1) < 1e-12);
                assert!((grid.at(i, 3) - grid.at(i, 0)).dot(frame.t1).abs() < 1e-12);
            }
        }
        // Here the plane is exactly normal to the helix; the discrete tangent differs a little.
        assert!(swept.obliquity_rad < 2e-3, "{}", swept.obliquity_rad);
    }

    #[test]
    fn the_profile_moves_as_a_parallel_field_does() {
        // Oracle: a vector of the normal plane carried along the smooth helix without twist, v' = −(v·t') t, by 40000 steps.
        let rate = 13.0_f64.sqrt();
        let tangent = |s: f64| DVec3::new(-3.0 * s.sin(), 3.0 * s.cos(), 2.0) / rate;
        let derivative = |s: f64| DVec3::new(-3.0 * s.cos(), -3.0 * s.sin(), 0.0) / rate;
        let (mut v, h) = (DVec3::X, 2.0 / 40000.0);
        let change = |s: f64, v: DVec3| -v.dot(derivative(s)) * tangent(s);
        for i in 0..40000 {
            let s = f64::from(i) * h;
            v += h * change(s + 0.5 * h, v + 0.5 * h * change(s, v));
        }
        let error = |count: i32| {
            let (rail, profile) = helix(count);
            let x = [rail[0], rail[0] + 0.2 * DVec3::X, profile[3]];
            let grid = monge(&rail, &x).unwrap().base.grid;
            let last = grid.row(grid.rows() - 1);
            ((last[1] - last[0]) / 0.2).distance(v)
        };
        // Second order.
        assert!(error(10) < 0.02 && error(20) < 0.3 * error(10) && error(40) < 0.3 * error(20), "{}", error(40));
    }

    #[test]
    fn a_moulding_surface_is_a_combescure_transform_of_one_of_revolution() {
        // A circle of chords of 0.2 radians about (0, 0), and a rail whose edges are parallel to them, of any lengths.
        let mut random = Random(6);
        let circle: Vec<DVec3> =
            (0..11).map(|i| DVec3::from((glam::DVec2::from_angle(0.2 * f64::from(i)), 0.0))).collect();
        let mut rail = vec![DVec3::new(1.0, 0.0, 0.0)];
        for edge in circle.windows(2) {
            rail.push(rail[rail.len() - 1] + random.between(0.8, 3.0) * (edge[1] - edge[0]));
        }
        let profile = [(0.0, 0.0), (-0.1, 0.3), (-0.3, 0.5), (-0.3, 0.9)].map(|(x, z)| DVec3::new(1.0 + x, 0.0, z));
        let swept = moulding(&rail, &profile).unwrap();
        assert_eq!(swept.reversed_count, 0);
        let revolved = revolution(&profile, DVec3::ZERO, DVec3::Z, 2.0, 11).unwrap();
        let moulded = swept.base.transposed().unwrap();
        assert_eq!((moulded.grid.rows(), moulded.grid.columns()), (4, 11));
        let lengths = Lengths::of_polylines(&revolved.grid, &profile, &rail).unwrap();
        let image = combescure(&revolved.grid, &lengths, rail[0]).unwrap();
        for (a, b) in image.grid.points().iter().zip(moulded.grid.points()) {
            assert!(a.distance(*b) < 1e-13, "{a} {b}");
        }
        assert!(moulded.frame.distance(&revolved.frame) < 1e-13);
        moulded.frame.check("frame").unwrap();
        assert!(off_circle(&moulded.grid) < 1e-12);
        frames(&moulded.grid, moulded.frame).unwrap();
        frames(&swept.base.grid, swept.base.frame).unwrap();
        // Rails stay at their height, profiles stay upright.
        for i in 0..4 {
            assert!(moulded.grid.row(i).iter().all(|point| (point.z - profile[i].z).abs() < 1e-14));
        }
        for j in 0..11 {
            let column = moulded.grid.column(j);
            assert!((column[3] - column[2]).cross(column[1] - column[0]).z.abs() < 1e-14);
        }
    }

    #[test]
    fn a_closed_rail_closes_where_its_reflections_do() {
        // A regular polygon with a profile in the plane through its axis and a corner: the mirrors give a ring of revolution.
        for count in [6, 7] {
            let mut rail = crate::mesh::fit::regular_polygon(count);
            rail.push(rail[0]);
            let profile = [DVec3::X, DVec3::new(1.2, 0.0, 0.3), DVec3::new(1.3, 0.0, 0.9)];
            let swept = moulding(&rail, &profile).unwrap();
            assert_eq!((swept.base.grid.rows(), swept.base.grid.wraps()), (count, [true, false]));
            assert!(swept.closing_gap < 1e-14);
            let handed_on = frames(&swept.base.grid, swept.base.frame).unwrap();
            assert!(closing_gap(&swept.base.grid, &handed_on) < 1e-12);
            let revolved = revolution(&profile, DVec3::ZERO, DVec3::Z, TAU, count).unwrap().transposed().unwrap();
            let pairs = revolved.grid.points().iter().zip(swept.base.grid.points());
            assert!(pairs.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) < 1e-14);
        }
        // An irregular hexagon: left open, with the gap.
        let mut rail = crate::mesh::fit::regular_polygon(6);
        rail[2] *= 1.3;
        rail.push(rail[0]);
        let swept = moulding(&rail, &[DVec3::X, DVec3::new(1.2, 0.0, 0.3)]).unwrap();
        assert_eq!((swept.base.grid.rows(), swept.base.grid.wraps()), (7, [false; 2]));
        let gap = swept.base.grid.row(6)[1].distance(swept.base.grid.row(0)[1]);
        assert!(gap > 1e-3 && (swept.closing_gap - gap).abs() < 1e-15);
        assert!(off_circle(&swept.base.grid) < 1e-13);
    }

    #[test]
    fn translations_give_parallelograms_and_scalings_trapezoids() {
        let mut random = Random(12);
        let rail: Vec<DVec3> = (0..6).map(|_| random.vector()).collect();
        let profile: Vec<DVec3> = (0..5).map(|_| random.vector()).collect();
        let factors: Vec<f64> = (0..6).map(|_| random.between(0.5, 2.0)).collect();
        let (moved, scaled) =
            (translation(&rail, &profile).unwrap(), scale_translation(&rail, &profile, &factors).unwrap());
        for (i, j) in (0..5).flat_map(|i| (0..4).map(move |j| (i, j))) {
            let [a, b, c, d] = moved.corners(i, j);
            assert!((a - b + c - d).length() < 1e-15);
            let [a, b, c, d] = scaled.corners(i, j);
            assert!((d - a).cross(c - b).length() < 1e-14);
            assert!(crate::mesh::measure::planarity(&[a, b, c, d]) < 1e-14);
            assert!(((d - a).length() * factors[i + 1] - (c - b).length() * factors[i]).abs() < 1e-14);
        }
        assert_eq!(scaled.column(0), rail);
        // Not circular in general, as said.
        assert!(off_circle(&moved) > 0.1 && off_circle(&scaled) > 0.1);
        let closed = |points: &[DVec3]| [points, &points[..1]].concat();
        let ring = translation(&closed(&rail), &closed(&profile)).unwrap();
        assert_eq!((ring.rows(), ring.columns(), ring.wraps()), (6, 5, [true; 2]));
        let spiral: Vec<f64> = (0..7).map(|i| 1.0 + f64::from(i)).collect();
        assert_eq!(scale_translation(&closed(&rail), &profile, &spiral).unwrap().wraps(), [false; 2]);
        assert_eq!(refusal(scale_translation(&rail, &profile, &factors[1..])).1, "factors");
        assert_eq!(refusal(scale_translation(&rail, &profile, &[1.0, 1.0, 0.0, 1.0, 1.0, 1.0])).1, "factors[2]");
        assert_eq!(refusal(translation(&rail, &[DVec3::X, DVec3::X])), (Status::Degenerate, "profile[1]".to_owned()));
    }

    #[test]
    fn profiles_that_cannot_be_swept_are_refused() {
        let (rail, profile) = helix(12);
        let mut bad = profile.clone();
        bad[2] += 0.1 * (rail[1] - rail[0]);
        assert_eq!(refusal(monge(&rail, &bad)).0, Status::NotPlanar);
        let moved: Vec<DVec3> = profile.iter().map(|&point| point + 0.1 * DVec3::X).collect();
        assert_eq!(refusal(monge(&rail, &moved)), (Status::InvalidValue, "profile[0]".to_owned()));
        let (along, up) = ((rail[1] - rail[0]).normalize(), DVec3::X);
        let flat = [rail[0], rail[0] + up, rail[0] + up + along];
        assert_eq!(refusal(monge(&rail, &flat)), (Status::Degenerate, "rail[1]".to_owned()));
        // The second profile point is in the plane that bisects the first edge.
        let on_mirror = [rail[0], 0.5 * (rail[0] + rail[1]) + DVec3::X.reject_from_normalized(along)];
        assert_eq!(refusal(monge(&rail, &on_mirror)), (Status::Degenerate, "rail[1]".to_owned()));
        assert_eq!(refusal(moulding(&rail, &profile)).0, Status::NotPlanar);
        let flat_rail = arc(0.0, 1.0, 0.0, 1.0, 5);
        let oblique = [DVec3::X, DVec3::new(1.5, 0.3, 0.1), DVec3::new(1.6, 0.6, 0.5)];
        assert_eq!(refusal(moulding(&flat_rail, &oblique)), (Status::InvalidValue, "profile".to_owned()));
        assert_eq!(refusal(monge(&rail[..1], &profile)), (Status::InvalidArgumentLength, "rail".to_owned()));
        // Beyond the axis of the circle the sides are reversed: flagged, still circular.
        let across = [DVec3::X, DVec3::new(-0.5, 0.1, 0.0), DVec3::new(-0.6, 0.3, 0.0)];
        let swept = moulding(&flat_rail, &across).unwrap();
        assert_eq!(swept.reversed_count, 8);
        assert!(off_circle(&swept.base.grid) < 1e-13);
    }

    #[test]
    fn what_is_not_refused_is_finite() {
        let mut random = Random(77);
        let sizes = [0.0, 1e-300, 1e-160, 1e-9, 1.0, 1.0, 1e9, 1e160, 1e300];
        let mut built = 0;
        for _ in 0..3000 {
            let size = sizes[random.between(0.0, 9.0) as usize];
            let mut number = || {
                let factor =
                    if random.between(0.0, 1.0) < 0.9 { 1.0 } else { sizes[random.between(0.0, 9.0) as usize] };
                size * factor * random.between(-1.0, 1.0)
            };
            let rail: Vec<DVec3> = (0..4).map(|_| DVec3::new(number(), number(), 0.0)).collect();
            let profile: Vec<DVec3> =
                (0..4).map(|j| rail[0] + f64::from(j) * DVec3::new(0.0, number(), number())).collect();
            let axis = DVec3::new(number(), number(), number());
            let results = [
                monge(&rail, &profile).map(|swept| swept.base),
                moulding(&rail, &profile).map(|swept| swept.base),
                revolution(&rail, DVec3::new(number(), number(), 0.0), DVec3::new(axis.x, axis.y, 0.0), 1.0, 4),
            ];
            for base in results.into_iter().flatten() {
                built += 1;
                assert!(base.grid.points().iter().all(|point| point.is_finite()));
                base.frame.check("frame").unwrap();
            }
        }
        assert!(built > 300, "{built}");
    }

    #[test]
    fn straight_profiles_and_rails_have_a_plane_chosen() {
        let rail = arc(0.0, 1.0, 0.0, 1.0, 6);
        // A cone and a cylinder; an extrusion.
        for profile in [[DVec3::X, DVec3::new(1.2, 0.7, 0.0)], [DVec3::X, DVec3::new(1.0, 0.7, 0.0)]] {
            for swept in [moulding(&rail, &profile).unwrap(), monge(&rail, &profile).unwrap()] {
                assert!(swept.base.frame.t1.distance(DVec3::Z) < 1e-12 && swept.obliquity_rad < 1e-7);
                let last = swept.base.grid.at(5, 1);
                assert!((last.x.hypot(last.z) - profile[1].x).abs() < 1e-14 && (last.y - 0.7).abs() < 1e-14);
            }
        }
        let straight = [DVec3::ZERO, DVec3::Z, 3.0 * DVec3::Z];
        let profile = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)];
        let swept = moulding(&straight, &profile).unwrap();
        assert!(swept.base.grid.at(2, 2).distance(DVec3::new(1.0, 1.0, 3.0)) < 1e-15);
    }
}
