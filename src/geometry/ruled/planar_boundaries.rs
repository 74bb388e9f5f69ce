//! Strip boundaries as plane sections (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012, section 2.1, Fig. 6).
//!
//! A plane section is a level curve of a linear function. It serves as a boundary if the rulings cross it at angles that are not too
//! small: then neighbouring rulings stay apart.

use glam::DVec3;

use super::Field;
use super::boundaries::{Boundaries, BoundaryOptions, Dropped, longest, ordered};
use super::boundary::Boundary;
use super::rim::Rim;
use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::level_curves::level_curves;

/// Beyond the surface a boundary is moved into a plane only if no point moves by more than this multiple of its way.
const MOST_STRETCH: f64 = 10.0;

/// The plane `normal · x = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Its normal, of any length above 0.
    pub normal: DVec3,
    /// In model units times the length of the normal.
    pub offset: f64,
}

/// What is asked of plane sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarOptions {
    /// What is done to the boundaries; `least_length` is not used.
    pub boundaries: BoundaryOptions,
    /// Sections should cross the field at no smaller angle, 0 to π/2. The default is 15°.
    pub least_angle_rad: f64,
    /// Whether one that does is refused; otherwise it is listed.
    pub refuses_oblique: bool,
}

impl Default for PlanarOptions {
    fn default() -> Self {
        Self { boundaries: BoundaryOptions::default(), least_angle_rad: 15_f64.to_radians(), refuses_oblique: false }
    }
}

/// Plane sections as strip boundaries.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarBoundaries {
    /// The boundaries; `level` is the number of the plane, `dropped` the shorter sections by planes with several.
    pub boundaries: Boundaries,
    /// The plane of each boundary: the one given, or for those beyond the surface a parallel one; none if a parallel one is too far
    /// away in places.
    pub planes: Vec<Option<Plane>>,
    /// For each plane given, the least angle at which its section crosses the field.
    pub angles_rad: Vec<f64>,
    /// The planes with angles below the least one asked for.
    pub oblique: Vec<usize>,
}

/// Cuts the surface with planes that follow each other along the field, or against it. Each plane is one boundary: its longest
/// section.
///
/// # Errors
/// No plane, a normal of length 0, or a number that is not finite (`planes`, `planes[k]`); options out of range
/// (`options.least_angle_rad`); a field of another mesh (`field`). Status `NoIntersection`: a plane misses the surface, or touches it (`planes[k]`). `Infeasible`: a
/// plane is not ahead of the one before it along the field, its section runs along the field or where it is not known, or, if that
/// is refused, crosses it at too small an angle (`planes[k]`).
pub fn planar_boundaries(
    mesh: &TriangleMesh,
    field: &Field,
    planes: &[Plane],
    options: &PlanarOptions,
) -> Result<PlanarBoundaries> {
    options.boundaries.check()?;
    field.check(mesh)?;
    if !(0.0..=std::f64::consts::FRAC_PI_2).contains(&options.least_angle_rad) {
        let reason = format!("expected an angle from 0 to π/2, found {}", options.least_angle_rad);
        return Err(Error::new(Status::InvalidValue, reason).at("options.least_angle_rad"));
    }
    if planes.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("planes"));
    }
    let rim = Rim::new(mesh, field)?;
    let (mut chain, mut dropped) = (Vec::<Boundary>::new(), Vec::new());
    let (mut angles_rad, mut oblique) = (Vec::new(), Vec::new());
    for (k, plane) in planes.iter().enumerate() {
        let refusal = |status, reason: String| Err(Error::new(status, reason).at(format!("planes[{k}]")));
        let mut boundary = section(mesh, &rim, plane, k, &mut dropped).map_err(|e| e.at(format!("planes[{k}]")))?;
        let Some(angle) = rim.turn(&mut boundary).filter(|angle| *angle > 0.0) else {
            return refusal(Status::Infeasible, "expected a section that the field crosses from one side".into());
        };
        if angle < options.least_angle_rad {
            if options.refuses_oblique {
                let [angle, least] = [angle, options.least_angle_rad].map(f64::to_degrees);
                let reason = format!("expected a section at {least}° or more to the field, found {angle:.1}°");
                return refusal(Status::Infeasible, reason);
            }
            oblique.push(k);
        }
        angles_rad.push(angle);
        chain.push(boundary);
    }
    let chain = ordered(&rim, chain).map_err(|k| {
        let reason = "expected planes that follow each other along the field, or against it";
        Error::new(Status::Infeasible, reason).at(format!("planes[{k}]"))
    })?;
    let overshoots = [options.boundaries.overshoots; 2];
    let mut boundaries = rim.complete(chain, false, options.boundaries.extends, overshoots);
    let planes = flatten(&mut boundaries, planes);
    let strips = (1..boundaries.len()).map(|k| [k - 1, k]).collect();
    let boundaries = Boundaries { boundaries, strips, dropped, ..Boundaries::default() };
    Ok(PlanarBoundaries { boundaries, planes, angles_rad, oblique })
}

fn section(
    mesh: &TriangleMesh,
    rim: &Rim<'_>,
    plane: &Plane,
    k: usize,
    dropped: &mut Vec<Dropped>,
) -> Result<Boundary> {
    let length = plane.normal.length();
    if !(length > 0.0 && length.is_finite() && plane.offset.is_finite()) {
        let reason = format!("expected a normal that is not 0 and finite numbers, found {plane:?}");
        return Err(Error::new(Status::InvalidValue, reason));
    }
    let values: Vec<f64> = mesh.points().iter().map(|p| plane.normal.dot(*p) / length).collect();
    let curves = level_curves(mesh, &values, plane.offset / length)?;
    longest(curves, k, rim.mean_edge(), dropped).ok_or_else(|| {
        Error::new(Status::NoIntersection, "expected a plane that cuts the surface, found one that does not")
    })
}

/// Moves the points of the boundaries beyond the surface along their ways into a plane parallel to that of the boundary that they
/// were made from, as far away as the farthest of them. Returns the plane of each boundary.
fn flatten(boundaries: &mut [Boundary], planes: &[Plane]) -> Vec<Option<Plane>> {
    let count = boundaries.len();
    let is_beyond = |b: &Boundary| b.on_surface.iter().all(Option::is_none);
    let own = |b: &Boundary| planes.get(b.level.round().max(0.0) as usize).copied();
    let mut found: Vec<Option<Plane>> = boundaries.iter().map(|b| if is_beyond(b) { None } else { own(b) }).collect();
    for (k, from) in [(0, 1), (count - 1, count.saturating_sub(2))] {
        let (true, true, Some(plane)) = (is_beyond(&boundaries[k]), count > 1, found[from.min(count - 1)]) else {
            continue;
        };
        let source = boundaries[from].points.clone();
        let ways: Vec<DVec3> = boundaries[k].points.iter().zip(&source).map(|(p, q)| *p - *q).collect();
        let rises: Vec<f64> = ways.iter().map(|way| plane.normal.dot(*way)).collect();
        let farthest =
            rises.iter().copied().fold(0.0, |far: f64, rise| if rise.abs() > far.abs() { rise } else { far });
        if rises.iter().all(|rise| rise / farthest * MOST_STRETCH >= 1.0) {
            for ((point, from), (way, rise)) in
                boundaries[k].points.iter_mut().zip(&source).zip(ways.iter().zip(&rises))
            {
                *point = *from + farthest / rise * *way;
            }
            found[k] = Some(Plane { offset: plane.offset + farthest, ..plane });
        }
    }
    found
}
