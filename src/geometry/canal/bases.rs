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

use super::frame::Frame;
use super::inversion::Inversion;
use super::polyline::{COINCIDE, NO_LENGTH, direction_of_straight, plane_normal, polyline, start_tangent};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::reflect;
use crate::mesh::Grid;
use crate::mesh::grid::{check_finite, diagonal};

/// A circular base: its net and its frame at point `(0, 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// The net.
    pub grid: Grid,
    /// Tangents to both families of lines of curvature, and the normal, at point `(0, 0)`.
    pub frame: Frame,
}

impl Base {
    /// The same surface with rows for columns. The normal turns round, since the tangents change places.
    ///
    /// # Errors
    /// None for a base of this module.
    pub fn transposed(&self) -> Result<Self> {
        let grid = &self.grid;
        let points = (0..grid.columns()).flat_map(|j| grid.column(j)).collect();
        let [wraps_rows, wraps_columns] = grid.wraps();
        let Frame { t1, t2, normal } = self.frame;
        Ok(Self {
            grid: Grid::new(points, grid.columns(), grid.rows(), [wraps_columns, wraps_rows])?,
            frame: Frame { t1: t2, t2: t1, normal: -normal },
        })
    }
}

/// A base and the inversions that map it to a surface, the first one first. No inversion is the identity.
#[derive(Clone, Debug, PartialEq)]
pub struct InvertedBase {
    /// What is inverted.
    pub base: Base,
    /// Applied in this order.
    pub inversions: Vec<Inversion>,
}

impl InvertedBase {
    /// The net of the surface.
    ///
    /// # Errors
    /// Status `Degenerate`: a point of the base is at a center of inversion.
    pub fn grid(&self) -> Result<Grid> {
        let start = self.base.grid.points().to_vec();
        let points = self.inversions.iter().try_fold(start, |points, inversion| inversion.points(&points))?;
        self.base.grid.with_points(points)
    }

    /// The frame of the surface at point `(0, 0)`: the images of both tangents, and `t1 × t2`. An inversion of positive ratio
    /// turns orientation round, so the normal is the image of the base's normal or its opposite.
    pub fn frame(&self) -> Frame {
        let Frame { mut t1, mut t2, .. } = self.base.frame;
        let mut point = self.base.grid.at(0, 0);
        for inversion in &self.inversions {
            t1 = inversion.direction(point, t1).normalize_or_zero();
            t2 = inversion.direction(point, t2).normalize_or_zero();
            point = inversion.point(point);
        }
        Frame { t1, t2, normal: t1.cross(t2) }
    }
}

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
