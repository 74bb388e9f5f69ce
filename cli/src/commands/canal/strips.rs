//! Circular strips: along a guide, of circles, closed; and the arcs over them.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use anyhow::{Context, Result, anyhow, bail};
use glam::DVec3;
use shapeop::geometry::canal::closing::{Case, closed_frame, closed_strip, holonomy};
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::normals::{Guide, fitting_tangent};
use shapeop::geometry::canal::smoothing::{self, Cone, Input};
use shapeop::geometry::canal::strip::{self, Options, Strip};
use shapeop::geometry::canal::strip_of_circles::from_circles;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::geometry::circle::Circle;
use shapeop::linalg::bfgs::Stop;
use shapeop::mesh::Grid;
use shapeop::mesh::curve::{Curve as _, Spacing, Spline, resample};

use super::made::{Made, named, write};
use crate::Ending;
use crate::args::canal::{ArcArgs, CirclesArgs, FacadeArgs, MeasureArgs, Numbers, SmoothingArgs, StripArgs};
use crate::curve_file::{Curve, read_circles, read_numbers};
use crate::output::Output;
use crate::progress::{Progress, catch_interrupts, is_interrupted};

/// How each face of a strip is cut if nothing is asked for: a strip is one quad wide, and its arcs are what is looked for.
const REFINE: [usize; 2] = [4, 12];

/// The sine of the angle to the guide from which on a crossing edge has a direction of its own.
const ALONG_GUIDE: f64 = 1e-6;

pub fn strip(args: &StripArgs, is_quiet: bool) -> Result<Ending> {
    let guide = Curve::read(&args.guide)?;
    let spline = Spline::through(guide.distinct(), guide.is_closed).map_err(|error| in_guide(error, &guide))?;
    let (points, parameters) = match args.points {
        None => (guide.points.clone(), spline.knots().to_vec()),
        Some(count) => {
            let mut parameters = resample(&spline, count, Spacing::ArcLength)?;
            parameters.extend(guide.is_closed.then(|| spline.range()[1]));
            (parameters.iter().map(|&parameter| spline.point(parameter)).collect(), parameters)
        }
    };
    let options = Options { is_strict: args.strict, projects_lengths: args.project, fits_start: args.fit_start };
    let mut strip = measured(&points, args.start, &args.measure, &options).map_err(|error| in_strip(error, &guide))?;
    let mut frame = frame_of(&strip, &points, false, &args.arcs)?;
    let mut smoothed = None;
    let mut ending = Ending::Done;
    let is_smoothed = args.smoothing.smooth;
    // Both are wanted, side by side: the one does not overwrite the other.
    let command = if is_smoothed { "strip.smooth" } else { "strip" };
    if is_smoothed {
        let options = smoothing_options(&args.smoothing, &frame);
        Output::new(&args.output.out, &args.guide, command, args.output.picture)?;
        catch_interrupts();
        let progress = Progress::new(u32::try_from(options.max_iterations).unwrap_or(u32::MAX), is_quiet);
        let curve = |parameter: f64| spline.point(parameter);
        let input = Input { curve: &curve, parameters: &parameters, strip: &strip, frame };
        let found = smoothing::smooth(&input, &options, &mut |at| {
            progress.say(at.iteration, &format!("sum of squared curvatures {:.4e}", at.value));
            if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        progress.finish();
        let found = found.map_err(|error| in_strip(error.into(), &guide))?;
        if found.stop == Stop::Cancelled {
            ending = Ending::Interrupted;
        }
        (strip, frame) = (found.strip.clone(), found.frame);
        smoothed = Some(found);
    }
    let mut made = of_strip(&strip, frame)?.curve("guide", &guide, args.points.is_none() && !is_smoothed);
    if let Some(found) = smoothed {
        made.find("sum_of_squared_curvatures_before", found.before);
        made.find("sum_of_squared_curvatures_after", found.after);
        made.find("iterations", found.history.len().saturating_sub(1));
        made.find("smoothing_stopped", stop_in_words(found.stop));
        made.find("parameters", &found.parameters);
    }
    if guide.is_closed {
        made.warn("the guide is closed, the strip is not: canal facade closes it");
    }
    write(command, &args.guide, made, &args.output, is_quiet)?;
    Ok(ending)
}

fn smoothing_options(args: &SmoothingArgs, frame: &Frame) -> smoothing::Options {
    // An axis without a direction is refused later.
    let at_start = |axis: DVec3| axis.try_normalize().map_or(0.0, |axis| frame.normal.angle_between(axis));
    let angle = |axis| args.cone_angle.map_or_else(|| at_start(axis), f64::to_radians);
    smoothing::Options {
        cone: args.cone.map(|axis| Cone { axis, angle_rad: angle(axis) }),
        spacing_ratio: args.spacing_ratio,
        length_change: args.length_change,
        max_iterations: args.iterations,
        ..smoothing::Options::default()
    }
}

fn stop_in_words(stop: Stop) -> &'static str {
    match stop {
        Stop::Gradient => "the gradient vanished",
        Stop::Decrease => "it hardly fell any more",
        Stop::Iterations => "all iterations were used",
        Stop::LineSearch => "no step lowered it",
        Stop::Cancelled => "stopped with Ctrl-C",
        Stop::Infeasible => "the start is not feasible",
    }
}

pub fn circles(args: &CirclesArgs, is_quiet: bool) -> Result<Ending> {
    let circles = read_circles(&args.circles)?;
    let name = args.circles.display();
    let found = from_circles(&circles, args.start, args.end).map_err(|error| anyhow!("{name}: {error}"))?;
    let frame = frame_of(&found.strip, &found.strip.guide, false, &args.arcs)?;
    let mut made = of_strip(&found.strip, frame)?;
    made.find("circles", circles.len());
    made.find("distance_from_circles", found.distance);
    let radius = circles.iter().map(|circle| circle.radius).fold(0.0, f64::max);
    if found.distance > 1e-9 * radius {
        made.warn(format!(
            "the circles do not meet in two points each: the strip is up to {:.3e} off them",
            found.distance
        ));
    }
    for circle in &circles {
        let start = circle.center + circle.radius * circle.normal.any_orthonormal_vector();
        let points: Vec<DVec3> = (0..=48).map(|k| circle.point_at(start, TAU * f64::from(k) / 48.0)).collect();
        made = made.drawn(points);
    }
    write("circles", &args.circles, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}

pub fn facade(args: &FacadeArgs, is_quiet: bool) -> Result<Ending> {
    let guide = Curve::read(&args.guide)?;
    if !guide.is_closed {
        bail!("{}: expected a closed curve: one that repeats its first point, or with \"closed\": true", guide.name);
    }
    let ring = guide.distinct();
    if ring.len() < 3 {
        bail!("{}: expected at least 3 different points, found {}", guide.name, ring.len());
    }
    let (last, open) = ring.split_last().with_context(|| format!("{}: no points", guide.name))?;
    let strip =
        measured(open, args.start, &args.measure, &Options::default()).map_err(|error| in_strip(error, &guide))?;
    let closed = closed_strip(&strip, *last).map_err(|error| in_guide(error, &guide))?;
    let around = holonomy(ring).map_err(|error| in_guide(error, &guide))?;
    let whole = Strip { guide: closed.guide.clone(), border: closed.border.clone(), ..strip.clone() };
    let mut frame = frame_of(&whole, ring, true, &args.arcs)?;
    let mut grid = closed.grid()?;
    if around.closes {
        frame = closed_frame(ring, &frame).map_err(|error| in_guide(error, &guide))?;
    } else {
        // The same net with a crease at the seam, where the first row is repeated.
        let points = [grid.points(), grid.row(0)].concat();
        grid = Grid::new(points, grid.rows() + 1, 2, [false; 2])?;
    }
    let mut made = Made::new(SuperCanal::new(Net::new(grid, frame)?, BaseKind::Canal)).curve("guide", &guide, true);
    made.refine = REFINE;
    made.find("closes_smoothly", around.closes);
    made.find("holonomy_residual", around.residual);
    let case = match closed.closing.case {
        Case::OneSphere => "one sphere",
        Case::TwoSpheres => "two spheres",
    };
    made.find("closing_case", case);
    made.find("first_point_moved", closed.closing.first.distance(args.start));
    if !around.closes {
        made.warn(format!(
            "frames come back off by {:.3e} around the guide: the seam is a crease, and the surface is left open there",
            around.residual
        ));
    }
    if !closed.flipped.is_empty() {
        made.warn(format!("quads of the strip cross themselves: {}", named(&closed.flipped)));
    }
    write("facade", &args.guide, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}

/// The strip along `points` of which the numbers in `measure` are given.
fn measured(points: &[DVec3], start: DVec3, measure: &MeasureArgs, options: &Options) -> Result<Strip> {
    if let Some(lengths) = &measure.lengths {
        let lengths = lengths_of(lengths, points)?;
        return Ok(strip::of_lengths(points, start, &lengths, options)?);
    }
    if let Some(radii) = &measure.radii {
        return Ok(strip::of_radii(points, start, &for_quads(radii, points)?, options.is_strict)?);
    }
    if let Some(edges) = &measure.border_edges {
        return Ok(strip::of_border_edges(points, start, &for_quads(edges, points)?)?);
    }
    let length = measure.border_length.context("expected --lengths, --radii, --border-edges or --border-length")?;
    Ok(strip::of_border_edges(points, start, &strip::edges_of_border(points, length)?)?)
}

/// Numbers for each quad along some points: one for all, or all.
fn for_quads(given: &Numbers, points: &[DVec3]) -> Result<Vec<f64>> {
    Ok(match numbers(given)?[..] {
        [number] => vec![number; points.len().saturating_sub(1)],
        ref list => list.to_vec(),
    })
}

/// Lengths for each of some points: one for all, two for the first and the last, or all.
pub fn lengths_of(lengths: &Numbers, points: &[DVec3]) -> Result<Vec<f64>> {
    Ok(match numbers(lengths)?[..] {
        [length] => vec![length; points.len()],
        [first, last] if points.len() != 2 => strip::lengths_between(points, first, last)?,
        ref list => list.to_vec(),
    })
}

fn numbers(numbers: &Numbers) -> Result<Vec<f64>> {
    match numbers {
        Numbers::List(list) => Ok(list.clone()),
        Numbers::File(path) => read_numbers(path),
    }
}

/// The surface of a strip.
fn of_strip(strip: &Strip, frame: Frame) -> Result<Made> {
    let mut made = Made::new(SuperCanal::new(Net::new(strip.grid()?, frame)?, BaseKind::Canal));
    made.refine = REFINE;
    made.find("length_deviation", strip.deviation);
    made.find("lengths", &strip.lengths);
    made.find("attainable", &strip.attainable);
    if !strip.projected.is_empty() {
        made.warn(format!(
            "lengths are not attainable and were replaced, by up to {:.3e}: {}",
            strip.deviation,
            named(&strip.projected)
        ));
    }
    if !strip.flipped.is_empty() {
        made.warn(format!("quads of the strip cross themselves: {}", named(&strip.flipped)));
    }
    Ok(made)
}

/// The frame at the first point of a strip: its first tangent fits the curve through `points`, its second leaves the first face at
/// the angle asked for.
fn frame_of(strip: &Strip, points: &[DVec3], is_closed: bool, arcs: &ArcArgs) -> Result<Frame> {
    let t1 = tangent(points, is_closed)?;
    let (chord, edge) = (strip.border[0] - strip.guide[0], strip.guide[1] - strip.guide[0]);
    let aside = chord.reject_from_normalized(t1);
    let flat = aside.try_normalize().filter(|_| aside.length() > ALONG_GUIDE * chord.length());
    let flat = flat.context("start: the first crossing edge runs along the guide")?;
    let face = chord.cross(edge);
    let above = if face.dot(arcs.up) < 0.0 { -face } else { face };
    let across = t1.cross(flat);
    let lift = if across.dot(above) < 0.0 { -across } else { across };
    let (sine, cosine) = arcs.rise.to_radians().sin_cos();
    let t2 = cosine * flat + sine * lift;
    Frame::of_tangent_one(t1, t1.cross(t2)).context("rise: expected an angle in degrees")
}

/// The tangent at the first of some points from which lines of curvature go smoothly along them.
pub fn tangent(points: &[DVec3], is_closed: bool) -> Result<DVec3> {
    Ok(fitting_tangent(&guide_of(points, is_closed)?)?)
}

/// Points, each once, with the tangents of the circles through each and its neighbours: those of arcs, which lines of curvature
/// of cyclidic nets consist of.
pub fn guide_of(points: &[DVec3], is_closed: bool) -> Result<Guide> {
    let last = points.len().saturating_sub(1);
    let tangent = |k: usize| {
        let middle = if is_closed { k } else { k.clamp(1, last.saturating_sub(1).max(1)) };
        let around = |at: usize| points.get(at % (last + 1)).copied().unwrap_or_default();
        let [before, here, after] = [around(middle + last), around(middle), around(middle + 1)];
        match Circle::through(before, here, after) {
            Some(circle) if points.len() > 2 => circle.tangent_at(points[k]),
            _ if k == last && !is_closed => points[k] - around(k + last),
            _ => around(k + 1) - points[k],
        }
    };
    let tangents: Vec<DVec3> = (0..points.len()).map(tangent).collect();
    Ok(Guide::new(points, &tangents, is_closed)?)
}

fn in_guide(error: shapeop::error::Error, guide: &Curve) -> anyhow::Error {
    anyhow!("{}: {error}", guide.name)
}

/// Arguments of strips and their smoothing that are options under other names.
const OPTIONS: [(&str, &str); 5] = [
    ("edges", "border-edges"),
    ("spacing_ratio", "spacing-ratio"),
    ("length_change", "length-change"),
    ("cone.axis", "cone"),
    ("cone.angle_rad", "cone-angle"),
];

/// Puts the guide's file before a refusal that names its points, and the option's name into one that names an option's value.
fn in_strip(error: anyhow::Error, guide: &Curve) -> anyhow::Error {
    let error = match error.downcast::<shapeop::error::Error>() {
        Ok(error) if error.place().starts_with("points") => return in_guide(error, guide),
        Ok(error) => error,
        Err(error) => return error,
    };
    let place = error.place().to_owned();
    let option =
        OPTIONS.iter().find_map(|(name, option)| place.strip_prefix(name).map(|rest| format!("{option}{rest}")));
    match option {
        Some(option) => error.with_place(option).into(),
        None => error.into(),
    }
}
