//! The snake at the start: from a curve of one curvature, a curve file, a plane section of a mesh, or a file.

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::Serialize;
use shapeop::geometry::snakes::curvature_curve::{Course, End, Method, Options as CurveOptions, Side};
use shapeop::geometry::snakes::fit::{FittedSnake, Options, fit, fit_closed, fit_curve};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::geometry::snakes::{Snake, file};
use shapeop::linalg::gauss_newton::{Progress as FitProgress, Stop};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::curve::{Curve as _, Polyline, Spacing, Spline, fit_polyline, resample};
use shapeop::mesh::level_curves::level_curves;
use shapeop::mesh::reference::ReferenceMesh;

use super::names::Names;
use crate::args::snake::{FitOptionArgs, Spot, StartArgs, Turn};
use crate::curve_file::{Curve, text_of};
use crate::progress::{Progress, is_interrupted};
use crate::table::number;

/// Points of a curve for each arc: as many as a fit looks at.
const PER_ARC: usize = 32;

/// Curves of fewer points for each arc are taken as splines through them.
const LEAST_PER_ARC: usize = 6;

/// Control points, for each arc, of the spline that stands for a section of a mesh, whose own points are too uneven to have curvatures.
const CONTROL_PER_ARC: usize = 3;

/// A point at the end of a curve that is nearer to the one before than this part of a step is left out.
const LAST_STEP: f64 = 1e-2;

/// The snake that is to move, and how it was found.
pub struct Start {
    pub snake: Snake,
    pub told: StartInReport,
    pub warnings: Vec<String>,
}

#[derive(Serialize)]
pub struct StartInReport {
    /// `curvature`, `curve`, `section` or `snake`.
    pub kind: &'static str,
    /// The file, where it is from one.
    pub file: Option<String>,
    /// The length of the curve.
    pub length: Option<f64>,
    /// The largest distance of a point of the curve from the nearest arc.
    pub fit_deviation: Option<f64>,
}

/// The start of an evolution over a mesh.
pub fn on_mesh(args: &StartArgs, reference: &ReferenceMesh<'_>, is_quiet: bool) -> Result<Start> {
    if let Some(path) = &args.snake {
        return from_file(path);
    }
    // Every other start asks for it.
    let arcs = args.arcs.context("--arcs: expected a number")?;
    if let Some(path) = &args.curve {
        return along_file(path, arcs, &args.fit, is_quiet);
    }
    match (args.section, args.from, args.toward, args.curvature, args.length) {
        (Some(plane), ..) => section(reference.mesh(), plane, arcs, &args.fit, is_quiet),
        (_, Some(from), Some(toward), Some(curvature), Some(length)) => {
            let side = if args.turn == Turn::Left { Side::Left } else { Side::Right };
            let course = CurveAsked { from, toward, curvature, length, side };
            along_curvature(reference, &course, arcs, &args.fit, is_quiet)
        }
        _ => bail!("--from: expected with --toward, --curvature and --length"),
    }
}

/// A snake from its file.
pub fn read(path: &Path) -> Result<Snake> {
    file::from_json(&text_of(path)?).with_context(|| path.display().to_string())
}

pub fn from_file(path: &Path) -> Result<Start> {
    let told =
        StartInReport { kind: "snake", file: Some(path.display().to_string()), length: None, fit_deviation: None };
    Ok(Start { snake: read(path)?, told, warnings: Vec::new() })
}

/// Arcs along a curve file.
pub fn along_file(path: &Path, arcs: usize, args: &FitOptionArgs, is_quiet: bool) -> Result<Start> {
    let curve = Curve::read(path)?;
    let names = fit_names(&format!("{}: points", curve.name));
    along_points(curve.distinct(), curve.is_closed, arcs, args, is_quiet)
        .map_err(|error| names.of(error))
        .map(|found| start_of("curve", Some(curve.name.clone()), length(&curve.points), found))
}

/// Arcs along points: those themselves where there are enough, else a spline through them.
fn along_points(
    points: &[DVec3],
    is_closed: bool,
    arcs: usize,
    args: &FitOptionArgs,
    is_quiet: bool,
) -> shapeop::error::Result<FittedSnake> {
    let options = options(args, None);
    fitting(arcs, is_quiet, &mut |progress| {
        if points.len() >= LEAST_PER_ARC.saturating_mul(arcs) {
            return if is_closed {
                fit_closed(points, arcs, &options, progress)
            } else {
                fit(points, arcs, &options, progress)
            };
        }
        let spline = Spline::through(points, is_closed)?;
        if !is_closed {
            return fit_curve(&spline, arcs, &options, progress);
        }
        let parameters = resample(&spline, PER_ARC.saturating_mul(arcs.clamp(1, MOST_RESAMPLED)), Spacing::ArcLength)?;
        let points: Vec<DVec3> = parameters.into_iter().map(|parameter| spline.point(parameter)).collect();
        fit_closed(&points, arcs, &options, progress)
    })
}

/// Beyond so many arcs the fit refuses.
const MOST_RESAMPLED: usize = 10_000;

/// A curve of one curvature that is asked for.
pub struct CurveAsked {
    pub from: Spot,
    pub toward: DVec3,
    pub curvature: f64,
    pub length: f64,
    pub side: Side,
}

/// A curve of constant curvature on a mesh, and why it is shorter than asked for, if it is.
pub fn curve_on_mesh(
    reference: &ReferenceMesh<'_>,
    asked: &CurveAsked,
    steps: usize,
) -> Result<(Vec<DVec3>, Vec<f64>, Option<String>)> {
    let constant = |_: f64| asked.curvature;
    let course = Course { curvature: &constant, length: asked.length, side: asked.side };
    let options = CurveOptions { steps, method: Method::RungeKutta };
    let from = spot(reference.mesh(), asked.from)?;
    let found = mesh_curve(reference, from, asked.toward, &course, &options).map_err(|error| {
        let names = [
            ("start", "--from"),
            ("tangent", "--toward"),
            ("course.length", "--length"),
            ("course.curvature", "--curvature"),
            ("options.steps", "--points"),
        ];
        Names::new(&names).of(error)
    })?;
    let mut curve = found.curve;
    let count = curve.points.len();
    let is_short = |lengths: &[f64]| lengths[count - 1] - lengths[count - 2] < LAST_STEP * asked.length / steps as f64;
    if count > 2 && is_short(&curve.lengths) {
        curve.points.pop();
        curve.lengths.pop();
    }
    let last = curve.lengths.last().copied().unwrap_or(0.0);
    let why = match curve.end {
        End::Length => None,
        End::Boundary => Some("the mesh ends there".to_owned()),
        End::Fold => Some("the mesh folds there".to_owned()),
        End::NoSolution { normal_curvature, .. } => {
            Some(format!("the mesh itself bends by {} there", number(normal_curvature.abs())))
        }
    };
    let told = why.map(|why| {
        let of = format!("the curve of curvature {}", number(asked.curvature));
        format!("{of} is {} long instead of {}: {why}", number(last), number(asked.length))
    });
    Ok((curve.points, curve.lengths, told))
}

/// The point that is meant.
fn spot(mesh: &TriangleMesh, from: Spot) -> Result<DVec3> {
    let (x, y) = match from {
        Spot::Near(point) => return Ok(point),
        Spot::Over(x, y) => (x, y),
    };
    let height = |t: usize| {
        let corners = mesh.corners(t);
        // Twice the signed areas that the point makes with the sides, seen from above.
        let side = |k: usize| {
            let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            (a.x - x) * (b.y - y) - (a.y - y) * (b.x - x)
        };
        let sides = [side(0), side(1), side(2)];
        let whole: f64 = sides.iter().sum();
        let is_over = whole != 0.0 && sides.iter().all(|side| side / whole >= -ON_SIDE);
        is_over.then(|| (0..3).map(|k| sides[k] / whole * corners[k].z).sum::<f64>())
    };
    let highest = (0..mesh.triangles().len()).filter_map(height).fold(f64::NEG_INFINITY, f64::max);
    if highest.is_finite() {
        return Ok(DVec3::new(x, y, highest));
    }
    bail!("--from: expected x,y under or over the mesh, or x,y,z near it; no point of the mesh is over {x},{y}")
}

/// A point on the side of a triangle is in it, by this part of its area.
const ON_SIDE: f64 = 1e-12;

fn along_curvature(
    reference: &ReferenceMesh<'_>,
    asked: &CurveAsked,
    arcs: usize,
    args: &FitOptionArgs,
    is_quiet: bool,
) -> Result<Start> {
    let steps = PER_ARC.saturating_mul(arcs.clamp(1, MOST_RESAMPLED)).max(200);
    let (points, lengths, shorter) = curve_on_mesh(reference, asked, steps)?;
    if points.len() < 3 {
        bail!("--from: {}", shorter.unwrap_or_else(|| "expected a curve of some length".to_owned()));
    }
    let options = options(args, (asked.curvature > 0.0).then_some(asked.curvature));
    let names = fit_names("--curvature").with("options.curvature", "--curvature");
    let found = fitting(arcs, is_quiet, &mut |progress| fit(&points, arcs, &options, progress));
    let length = lengths.last().copied().unwrap_or(0.0);
    let mut start = start_of("curvature", None, length, found.map_err(|error| names.of(error))?);
    start.warnings.extend(shorter);
    Ok(start)
}

/// Arcs along the section of a mesh with a plane.
fn section(
    mesh: &TriangleMesh,
    (normal, distance): (DVec3, f64),
    arcs: usize,
    args: &FitOptionArgs,
    is_quiet: bool,
) -> Result<Start> {
    if normal.length() == 0.0 {
        bail!("--section: expected a normal other than 0,0,0");
    }
    let values: Vec<f64> = mesh.points().iter().map(|point| normal.dot(*point)).collect();
    let curves = level_curves(mesh, &values, distance).map_err(|error| error.with_place("--section"))?;
    let Some(longest) = curves.iter().max_by(|a, b| a.length().total_cmp(&b.length())) else {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        bail!(
            "--section: expected D from {} to {}, where the plane meets the mesh; found {distance}",
            number(low),
            number(high)
        );
    };
    let mut points = longest.positions();
    points.dedup();
    let names = fit_names("--section").with("count", "--arcs");
    let smooth = || {
        let polyline = Polyline::new(&points, longest.is_closed)?;
        let spline = fit_polyline(&polyline, CONTROL_PER_ARC.saturating_mul(arcs.clamp(1, MOST_RESAMPLED)).max(8))?;
        let count = PER_ARC * arcs.clamp(1, MOST_RESAMPLED) + usize::from(!longest.is_closed);
        let parameters = resample(&spline, count, Spacing::ArcLength)?;
        Ok(parameters.into_iter().map(|parameter| spline.point(parameter)).collect::<Vec<DVec3>>())
    };
    let smoothed = smooth().map_err(|error| names.of(error))?;
    let options = options(args, None);
    let found = fitting(arcs, is_quiet, &mut |progress| {
        if longest.is_closed {
            fit_closed(&smoothed, arcs, &options, progress)
        } else {
            fit(&smoothed, arcs, &options, progress)
        }
    });
    let mut start = start_of("section", None, longest.length(), found.map_err(|error| names.of(error))?);
    if curves.len() > 1 {
        let length = number(longest.length());
        start.warnings.push(format!("the section has {} pieces: the longest is taken, {length} long", curves.len()));
    }
    Ok(start)
}

fn start_of(kind: &'static str, file: Option<String>, length: f64, found: FittedSnake) -> Start {
    let mut warnings = Vec::new();
    match found.stop {
        Stop::Cancelled => warnings.push("the fit was stopped with Ctrl-C".to_owned()),
        Stop::Iterations => warnings.push("the fit used all its iterations".to_owned()),
        _ => {}
    }
    let told = StartInReport { kind, file, length: Some(length), fit_deviation: Some(found.deviation) };
    Start { snake: found.snake, told, warnings }
}

/// What is called before each iteration of a fit.
type Watch<'a> = &'a mut dyn FnMut(&FitProgress) -> ControlFlow<()>;

/// Fits with a bar.
fn fitting<T>(arcs: usize, is_quiet: bool, fit: &mut dyn FnMut(Watch<'_>) -> T) -> T {
    let progress = Progress::new(3 * Options::default().max_iterations as u32, is_quiet);
    progress.say(0, &format!("fit of {arcs} arcs"));
    let found = fit(&mut |now| {
        progress.say(now.iteration, &format!("fit of {arcs} arcs: {:.4e}", now.value));
        if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    found
}

fn options(args: &FitOptionArgs, curvature: Option<f64>) -> Options {
    Options { is_congruent: !args.free_radii, curvature, nearness: args.nearness, ..Options::default() }
}

fn fit_names(points: &str) -> Names {
    let names = [("arc_count", "--arcs"), ("options.nearness", "--nearness"), ("points", points), ("curve", points)];
    Names::new(&names)
}

fn length(points: &[DVec3]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}
