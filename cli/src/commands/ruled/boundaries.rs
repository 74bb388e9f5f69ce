//! The boundaries of strips, of every kind.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::{Error, Status};
use shapeop::geometry::ruled::Axis;
use shapeop::geometry::ruled::boundaries::{BoundaryOptions, Drawn, Levels};
use shapeop::geometry::ruled::design::Design;
use shapeop::geometry::ruled::level_function::LevelOptions;
use shapeop::geometry::ruled::planar_boundaries::{PlanarOptions, Plane};
use shapeop::geometry::ruled::spherical_image::ImageKind;
use shapeop::mesh::SurfacePoint;

use super::asked::{Asked, LEVELS};
use super::places::Places;
use super::report::{AxisInReport, BoundariesInReport, DroppedInReport, ImageInReport};
use crate::args::ruled::{BoundaryArgs, BoundaryKind};
use crate::curve_file::Curve;
use crate::progress::{Progress, is_interrupted};

/// How levels were asked for, as an option.
pub fn levels_option(args: &BoundaryArgs) -> &'static str {
    match () {
        () if args.width.is_some() => "--width",
        () if args.values.is_some() => "--values",
        () => "--levels",
    }
}

fn levels(args: &BoundaryArgs) -> Levels {
    match (&args.values, args.width, args.levels) {
        (Some(values), ..) => Levels::Values(values.clone()),
        (_, Some(width), _) => Levels::Width(width),
        (.., count) => Levels::Count(count.unwrap_or(LEVELS)),
    }
}

/// Gives a design its boundaries.
pub fn set(
    design: &mut Design,
    args: &BoundaryArgs,
    asked: &Asked,
    curves: &[Curve],
    places: &Places<'_>,
    progress: &Progress,
) -> Result<BoundariesInReport> {
    let is_covering = !args.no_overshoot;
    let options = BoundaryOptions { extends: is_covering, overshoots: is_covering, least_length: args.least_length };
    let mut angles_deg = None;
    if let Some(weights) = asked.level_weights {
        let function = LevelOptions {
            weights,
            allows_folds: args.allow_folds,
            max_iterations: args.level_iterations,
            ..LevelOptions::default()
        };
        let mut shown = |now: &shapeop::linalg::gauss_newton::Progress| {
            progress.say(now.iteration, &format!("boundaries: {:.4e}", now.value));
            if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let set = design.set_level_boundaries(&function, &levels(args), &options, &mut shown);
        set.map_err(|error| places.of(error))?;
    } else if asked.kind == BoundaryKind::Planar {
        let planes = planes(design, args).map_err(|error| places.of(error))?;
        let planar = PlanarOptions {
            boundaries: options,
            least_angle_rad: args.least_angle.to_radians(),
            refuses_oblique: args.refuse_oblique,
        };
        let angles = design.set_planar_boundaries(&planes, &planar).map_err(|error| in_planes(error, args, places))?;
        angles_deg = Some(angles.into_iter().map(f64::to_degrees).collect());
    } else if asked.kind == BoundaryKind::Drawn {
        drawn(design, curves, &options).map_err(|error| places.of(error))?;
    } else {
        design.set_great_circle_boundaries(&args.axes, &options).map_err(|error| places.of(error))?;
    }
    Ok(in_report(design, asked, angles_deg))
}

/// Planes that were not given one by one are named by their normal.
fn in_planes(error: Error, args: &BoundaryArgs, places: &Places<'_>) -> anyhow::Error {
    let place = error.place().replace("planes", "--normal");
    if args.normal.is_some() && error.place().starts_with("planes") {
        return error.with_place(place).into();
    }
    places.of(error)
}

/// The planes that were given, or parallel ones.
fn planes(design: &Design, args: &BoundaryArgs) -> shapeop::error::Result<Vec<Plane>> {
    let Some(normal) = args.normal else {
        return Ok(args.planes.iter().map(|&(normal, offset)| Plane { normal, offset }).collect());
    };
    let Some(normal) = normal.try_normalize() else {
        let reason = format!("expected a vector of a length above 0, found {normal}");
        return Err(Error::new(Status::InvalidValue, reason).at("--normal"));
    };
    let heights = design.mesh().points().iter().map(|point| point.dot(normal));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    let offsets = spread(&levels(args), [low, high])?;
    Ok(offsets.into_iter().map(|offset| Plane { normal, offset }).collect())
}

/// Values between a least and a greatest one: so many half a distance from both, or at a distance, centred.
fn spread(levels: &Levels, [low, high]: [f64; 2]) -> shapeop::error::Result<Vec<f64>> {
    let (count, distance) = match levels {
        Levels::Values(values) => return Ok(values.clone()),
        Levels::Count(count) => (*count, (high - low) / *count as f64),
        Levels::Width(width) => (((high - low) / width).round().clamp(1.0, 1e6) as usize, *width),
    };
    if !(distance > 0.0 && distance.is_finite() && (1..=MOST_PLANES).contains(&count)) {
        let reason = format!("expected 1 to {MOST_PLANES} planes at a distance above 0, found {count} at {distance}");
        return Err(Error::new(Status::InvalidValue, reason).at("levels"));
    }
    let first = 0.5 * (low + high) - 0.5 * (count - 1) as f64 * distance;
    Ok((0..count).map(|k| first + k as f64 * distance).collect())
}

/// Parallel planes at most.
const MOST_PLANES: usize = 100_000;

/// Curves in their order, or where they were drawn against the field the other way round.
fn drawn(design: &mut Design, curves: &[Curve], options: &BoundaryOptions) -> shapeop::error::Result<()> {
    let form = |curve: &Curve| Drawn { points: curve.distinct().to_vec(), is_closed: curve.is_closed };
    let mut all: Vec<Drawn> = curves.iter().map(form).collect();
    design.set_drawn_boundaries(&all, options).or_else(|refusal| {
        all.reverse();
        design.set_drawn_boundaries(&all, options).map_err(|_| refusal)
    })
}

fn in_report(design: &Design, asked: &Asked, angles_deg: Option<Vec<f64>>) -> BoundariesInReport {
    let (found, function) = (design.boundaries(), design.function());
    let image = function.and_then(|function| function.image).map(|image| ImageInReport {
        kind: match image.kind {
            ImageKind::Regular => "regular",
            ImageKind::Folded => "folded",
            ImageKind::GreatCircle => "great circle",
            ImageKind::Curve => "curve",
        },
        extent: image.extent,
        folded: image.folded,
        axis: image.axis.to_array(),
        flatness: image.flatness,
    });
    let axis = |points: &[Option<SurfacePoint>]| {
        let on_surface: Vec<SurfacePoint> = points.iter().flatten().copied().collect();
        let axis = Axis::of_points(design.mesh(), design.field(), &on_surface)?;
        Some(AxisInReport { axis: axis.direction.to_array(), error: axis.error })
    };
    let is_conoidal = asked.kind == BoundaryKind::Conoidal;
    let on_surface = found.boundaries.iter().map(|boundary| axis(&boundary.on_surface));
    BoundariesInReport {
        kind: format!("{:?}", asked.kind).to_lowercase(),
        count: found.boundaries.len(),
        closed: found.boundaries.iter().filter(|boundary| boundary.is_closed).count(),
        levels: found.boundaries.iter().map(|boundary| boundary.level).collect(),
        weights: asked.level_weights.map(Into::into),
        iterations: function.map(|function| function.history.len().saturating_sub(1)),
        stop: function.and_then(|function| function.stop).map(|stop| format!("{stop:?}").to_lowercase()),
        slope: function.map(|function| function.slope),
        critical_points: function.map_or(0, |function| function.critical.len()),
        dropped: found
            .dropped
            .iter()
            .map(|d| DroppedInReport { level: d.level, points: d.point_count, length: d.length })
            .collect(),
        unmatched_levels: found.unmatched.clone(),
        least_angles_deg: angles_deg,
        spherical_image: image,
        axes: if is_conoidal { on_surface.collect() } else { Vec::new() },
    }
}

/// The points of boundaries on the mesh and those beyond it, as polylines: for pictures.
pub fn polylines(design: &Design) -> [Vec<Vec<DVec3>>; 2] {
    let (mut on, mut beyond) = (Vec::new(), Vec::new());
    for boundary in &design.boundaries().boundaries {
        let count = boundary.points.len();
        let pairs = if boundary.is_closed { count } else { count.saturating_sub(1) };
        let is_on = |i: usize| boundary.on_surface[i % count].is_some();
        let mut last: Option<bool> = None;
        for i in 0..pairs {
            let is_inside = is_on(i) && is_on(i + 1);
            let (a, b) = (boundary.points[i], boundary.points[(i + 1) % count]);
            let into = if is_inside { &mut on } else { &mut beyond };
            if last == Some(is_inside) {
                let line: Option<&mut Vec<DVec3>> = into.last_mut();
                line.into_iter().for_each(|line| line.push(b));
            } else {
                into.push(vec![a, b]);
            }
            last = Some(is_inside);
        }
    }
    [on, beyond]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_spread_evenly() {
        assert_eq!(spread(&Levels::Count(4), [0.0, 8.0]).unwrap(), [1.0, 3.0, 5.0, 7.0]);
        assert_eq!(spread(&Levels::Width(3.0), [-4.0, 4.0]).unwrap(), [-3.0, 0.0, 3.0]);
        assert_eq!(spread(&Levels::Values(vec![0.5]), [0.0, 1.0]).unwrap(), [0.5]);
        for wrong in [Levels::Count(0), Levels::Width(0.0), Levels::Width(-1.0), Levels::Width(f64::NAN)] {
            assert_eq!(spread(&wrong, [0.0, 1.0]).unwrap_err().place(), "levels", "{wrong:?}");
        }
    }
}
