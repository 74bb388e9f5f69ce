//! Boundaries of conoidal strips from great circles of the sphere that were chosen by hand (Flöry, Nagai, Isvoranu, Pottmann, Wallner
//! 2012, section 2.1): the field leads along rulings that are parallel to one plane from the points where it is orthogonal to an axis.

use glam::DVec3;

use super::Field;
use super::boundaries::{Boundaries, BoundaryOptions, longest, ordered};
use super::rim::Rim;
use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::level_curves::{LevelCurve, level_curves_within};

/// Boundaries along which the field is orthogonal to one axis each, in the order along the field or against it; `level` is the number
/// of the axis. Of several curves with an axis the longest is the boundary, the others are listed as dropped.
///
/// # Errors
/// As [`great_circle`] (`axes[k]`, `field`); no axis (`axes`); options out of range (`options.least_length`). Status `Infeasible`: the
/// field crosses a curve from both sides, or one is not ahead of that before it (`axes[k]`).
pub fn great_circle_boundaries(
    mesh: &TriangleMesh,
    field: &Field,
    axes: &[DVec3],
    options: &BoundaryOptions,
) -> Result<Boundaries> {
    options.check()?;
    field.check(mesh)?;
    if axes.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("axes"));
    }
    let rim = Rim::new(mesh, field)?;
    let (mut chain, mut dropped) = (Vec::with_capacity(axes.len()), Vec::new());
    for (k, &axis) in axes.iter().enumerate() {
        let place = format!("axes[{k}]");
        let curves = great_circle(mesh, field, axis).map_err(|error| error.with_place(&place))?;
        let boundary = longest(curves, k, rim.mean_edge(), &mut dropped);
        let crossed = boundary.and_then(|mut boundary| Some((rim.turn(&mut boundary)?, boundary)));
        match crossed.filter(|(angle, _)| *angle > 0.0) {
            Some((_, boundary)) => chain.push(boundary),
            None => {
                let reason = "expected a curve that the field crosses from one side";
                return Err(Error::new(Status::Infeasible, reason).at(place));
            }
        }
    }
    let chain = ordered(&rim, chain).map_err(|k| {
        let reason = "expected axes whose curves follow each other along the field, or against it";
        Error::new(Status::Infeasible, reason).at(format!("axes[{k}]"))
    })?;
    let boundaries = rim.complete(chain, false, options.extends, [options.overshoots; 2]);
    let strips = (1..boundaries.len()).map(|k| [k - 1, k]).collect();
    Ok(Boundaries { boundaries, strips, dropped, ..Boundaries::default() })
}

/// The curves on the mesh where the field is orthogonal to `axis`: what a great circle of the sphere is the image of. Given as a
/// boundary, it makes rulings that begin there parallel to one plane.
///
/// # Errors
/// An axis that is not finite or zero (`axis`); a field of another mesh (`field`). Status `NoIntersection`: the image does not meet the great circle (`axis`).
pub fn great_circle(mesh: &TriangleMesh, field: &Field, axis: DVec3) -> Result<Vec<LevelCurve>> {
    field.check(mesh)?;
    let Some(axis) = axis.try_normalize().filter(|axis| axis.is_finite()) else {
        let reason = format!("expected a direction, found {axis}");
        return Err(Error::new(Status::InvalidValue, reason).at("axis"));
    };
    let values: Vec<f64> = field.directions().iter().map(|a| a.dot(axis)).collect();
    let is_known = |t: usize| mesh.triangles()[t].iter().all(|&i| field.is_known()[i as usize]);
    let curves = level_curves_within(mesh, &values, 0.0, is_known)?;
    if curves.is_empty() {
        let reason = "the field is nowhere orthogonal to this direction";
        return Err(Error::new(Status::NoIntersection, reason).at("axis"));
    }
    Ok(curves)
}
