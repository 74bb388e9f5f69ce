//! The whole way: from a mesh to strips that are nearest to it.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::optimise::{self, Optimised};
use shapeop::geometry::ruled::start::StartOptions;
use shapeop::geometry::ruled::{Strip, asymptotic, orientation};
use shapeop::mesh::Mesh;
use shapeop::mesh::curve::End;
use shapeop::mesh::file::read_source;

use super::asked::Asked;
use super::made::{self, Made};
use super::places::{Places, in_options};
use super::report::{ConditionsInReport, OptimisationInReport, Seconds, StartInReport};
use super::{boundaries, field, pictures, single};
use crate::Ending;
use crate::args::ruled::{FieldArgs, RuledArgs};
use crate::curve_file::Curve;
use crate::output::Output;
use crate::progress::{Progress, catch_interrupts, is_interrupted};
use crate::table::number;

/// Points of the mesh that strips are asked to cover at most.
pub const MOST_COVERED: usize = 5_000;

pub fn run(args: &RuledArgs, is_quiet: bool) -> Result<Ending> {
    let path = args.mesh.as_deref().context("MESH: expected a mesh file")?;
    let asked = Asked::of(args);
    check(args, &asked)?;
    catch_interrupts();
    let source = read_source(path)?;
    let read = args.boundaries.curves.iter().map(|path| Curve::read_all(path)).collect::<Result<Vec<_>>>()?;
    let curves: Vec<Curve> = read.into_iter().flatten().collect();
    let places = Places {
        mesh: path,
        face_lines: &source.face_lines,
        levels: boundaries::levels_option(&args.boundaries),
        curves: &curves,
    };
    let job = Job { args, asked: &asked, mesh: &source.mesh, places: &places, curves: &curves, is_quiet };
    let made = if args.boundaries.single { single::make(&job)? } else { along_field(&job)? };
    let place = &args.output.place;
    let output = Output::new(&place.out, path, "ruled", place.picture)?;
    made::write(&job, made, path, output)
}

/// What is done, and with what.
pub struct Job<'a> {
    pub args: &'a RuledArgs,
    pub asked: &'a Asked,
    pub mesh: &'a Mesh,
    pub places: &'a Places<'a>,
    pub curves: &'a [Curve],
    pub is_quiet: bool,
}

impl Job<'_> {
    /// The bar of a phase of so many steps at most.
    pub fn phase(&self, name: &str, length: usize) -> Progress {
        let progress = Progress::new(length.min(u32::MAX as usize) as u32, self.is_quiet);
        progress.say(0, name);
        progress
    }

    pub fn start_options(&self) -> StartOptions {
        StartOptions { control_count: self.args.strips.control_points, is_shared: self.args.strips.shared }
    }

    /// A refusal of the optimisation under the name of an option.
    pub fn in_conditions(&self, error: shapeop::error::Error, conditions: &[Condition]) -> anyhow::Error {
        let rest = error.place().strip_prefix("conditions[").and_then(|rest| rest.split(']').next());
        let condition = rest.and_then(|k| k.parse::<usize>().ok()).and_then(|k| conditions.get(k));
        let option = condition.map(|condition| match condition {
            Condition::PlanarBoundary { .. } => "--planar",
            Condition::FixedEnd { .. } => "--fixed-ends",
            Condition::FixedEndRuling { .. } => "--fixed-end-rulings",
            Condition::Conoidal { .. } => "--conoidal",
        });
        match option {
            Some(option) => error.with_place(option).into(),
            None => self.places.of(error),
        }
    }
}

/// What can be refused before the mesh is read.
fn check(args: &RuledArgs, asked: &Asked) -> Result<()> {
    asked.optimise.check().map_err(|error| {
        let place = format!("options.{}", error.place());
        in_options(error.with_place(place))
    })?;
    for (option, value, is_zero_good) in
        [("--planks", args.output.planks, false), ("--depth", Some(args.output.depth), true)]
    {
        if let Some(value) =
            value.filter(|value| !(value.is_finite() && (*value > 0.0 || is_zero_good && *value == 0.0)))
        {
            let least = if is_zero_good { "of at least 0" } else { "above 0" };
            bail!("{option}: expected a finite number {least}, found {value}");
        }
    }
    if !(2..=100_000).contains(&args.output.rulings) {
        bail!("--rulings: expected 2 to 100000, found {}", args.output.rulings);
    }
    Ok(())
}

/// How the field was asked for.
pub fn field_options(args: &FieldArgs) -> FieldOptions {
    FieldOptions {
        directions: asymptotic::Options {
            flatness: args.flatness,
            max_mask: args.max_mask,
            ..asymptotic::Options::default()
        },
        family: args.family,
        orientation: orientation::Options { hint: args.hint, allow_cut: args.allow_cut },
    }
}

/// Strips whose rulings follow a field.
fn along_field(job: &Job<'_>) -> Result<Made> {
    let (args, asked) = (job.args, job.asked);
    let mut seconds = Seconds::default();
    let clock = Instant::now();
    let progress = job.phase("directions of rulings", 1);
    let design = Design::new(job.mesh, &field_options(&args.field)).map_err(|error| job.places.of(error));
    progress.finish();
    let mut design = design?;
    seconds.field = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let progress = job.phase("boundaries", args.boundaries.level_iterations);
    let set = boundaries::set(&mut design, &args.boundaries, asked, job.curves, job.places, &progress);
    progress.finish();
    let boundaries_found = set?;
    seconds.boundaries = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let progress = job.phase("strips", 1);
    let started = design.start(job.start_options()).map_err(|error| job.places.of(error));
    progress.finish();
    started?;
    seconds.strips = clock.elapsed().as_secs_f64();
    let (conditions, counts) = conditions(&design, job)?;

    let clock = Instant::now();
    let progress = job.phase("optimisation", asked.optimise.max_iterations);
    let found = design.optimise(None, &conditions, &asked.optimise, &mut |now| shown(now, &progress));
    progress.finish();
    let found = found.map_err(|error| job.in_conditions(error, &conditions))?;
    seconds.optimisation = clock.elapsed().as_secs_f64();

    let start = design.started().context("strips: none were started")?;
    let in_report = StartInReport {
        control_points: args.strips.control_points,
        shared: args.strips.shared,
        missed_rulings: start.missed.clone(),
        moved_rulings: start.moved.clone(),
    };
    let mut warnings = field::warnings(&design);
    warnings.extend(boundary_warnings(&boundaries_found, args.boundaries.least_angle));
    warnings.extend(start_warnings(&in_report));
    warnings.extend(optimisation_warnings(&found, asked));
    let drawn = args.output.place.picture != crate::args::PictureFormat::None;
    Ok(Made {
        field: Some(field::in_report(&design, args.field.family)),
        curves: if drawn { pictures::families(&design)? } else { Default::default() },
        boundary_lines: boundaries::polylines(&design),
        boundaries: boundaries_found,
        start: in_report,
        optimisation: OptimisationInReport::of(&found, &asked.optimise, counts),
        strips: found.strips,
        joints: design.joints().pairs.clone(),
        mesh: design.mesh().clone(),
        warnings,
        seconds,
    })
}

/// Shows an iteration, and ends the run if that was asked for.
pub fn shown(now: &optimise::Progress, progress: &Progress) -> ControlFlow<()> {
    let deviation = number(now.last.largest_deviation);
    progress.say(now.iteration, &format!("optimisation: {:.4e}  deviation {deviation}", now.last.value));
    if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The side conditions that were asked for.
fn conditions(design: &Design, job: &Job<'_>) -> Result<(Vec<Condition>, ConditionsInReport)> {
    let (strips, asked, mut counts) = (design.strips(), job.asked, ConditionsInReport::default());
    let mut conditions = if asked.is_planar { design.planar_conditions() } else { Vec::new() };
    counts.planar_boundaries = conditions.len();
    if asked.is_conoidal {
        let refused = |error: shapeop::error::Error| {
            let place = format!("--conoidal: {}", error.place());
            error.with_place(place)
        };
        let (found, off_deg) = design.conoidal_conditions().map_err(refused)?;
        counts.conoidal_strips = found.len();
        counts.conoidal_start_deg = Some(off_deg);
        conditions.extend(found);
    }
    if asked.has_fixed_ends {
        // Both ends of a ruling that are fixed are not orthogonal to an axis.
        let has_before = |strip: usize| design.joints().pairs.iter().any(|pair| pair[1] == strip);
        let is_kept = |condition: &Condition| match *condition {
            Condition::FixedEnd { strip, side, .. } if asked.is_conoidal => {
                side == 0 && !(job.args.strips.shared && has_before(strip))
            }
            _ => true,
        };
        let found = Condition::fixed_ends(strips).into_iter().filter(is_kept);
        let before = conditions.len();
        conditions.extend(found);
        counts.fixed_ends = conditions.len() - before;
    }
    if job.args.strips.fixed_end_rulings {
        let axis = |k: usize| axis_of(&conditions, k);
        let found: Vec<Condition> =
            strips.iter().enumerate().flat_map(|(k, strip)| end_rulings(k, strip, axis(k))).collect();
        counts.fixed_end_rulings = found.len();
        conditions.extend(found);
    }
    Ok((conditions, counts))
}

/// The axis to which all rulings of a strip are to be orthogonal, if any.
pub fn axis_of(conditions: &[Condition], of: usize) -> Option<DVec3> {
    conditions.iter().find_map(|condition| match *condition {
        Condition::Conoidal { strip, axis } if strip == of => Some(axis),
        _ => None,
    })
}

/// The conditions that keep the directions of the first and the last ruling of an open strip; with an axis, those of them across it,
/// as otherwise no ruling but one without length would meet both.
pub fn end_rulings(strip: usize, of: &Strip, axis: Option<DVec3>) -> Vec<Condition> {
    let last = of.basis().count() - 1;
    let condition = |(end, i): (End, usize)| {
        let ruling = of.control(1)[i] - of.control(0)[i];
        let direction = axis.map_or(ruling, |axis| ruling.reject_from(axis));
        (direction.length() > 0.0).then_some(Condition::FixedEndRuling { strip, end, direction })
    };
    let ends = if of.basis().is_closed() { Vec::new() } else { vec![(End::Start, 0), (End::Finish, last)] };
    ends.into_iter().filter_map(condition).collect()
}

fn boundary_warnings(found: &super::report::BoundariesInReport, least_angle: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    if !found.dropped.is_empty() {
        let longest = found.dropped.iter().map(|curve| curve.length).fold(0.0, f64::max);
        let count = found.dropped.len();
        warnings.push(format!("{count} curves were left out as too short, the longest {} long", number(longest)));
    }
    if !found.unmatched_levels.is_empty() {
        let levels: Vec<String> = found.unmatched_levels.iter().map(|level| number(*level)).collect();
        warnings.push(format!(
            "curves split, join or end between the levels {} and the next: there are no strips there",
            levels.join(", ")
        ));
    }
    if found.critical_points > 0 {
        warnings.push(format!(
            "the level function has {} critical points: boundaries near them are no good ones",
            found.critical_points
        ));
    }
    for (k, angle) in found.least_angles_deg.iter().flatten().enumerate().filter(|(_, angle)| **angle < least_angle) {
        warnings.push(format!("plane {k} crosses the rulings at an angle of only {}°", number(*angle)));
    }
    match found.spherical_image.as_ref().map(|image| image.kind) {
        Some("great circle") => warnings.push(
            "all rulings are parallel to one plane: every strip is conoidal, whatever its boundaries, which are orthogonal".into(),
        ),
        Some("curve") => warnings.push(
            "the surface consists of straight lines that are not parallel to a plane: no boundaries make conoidal strips of them".into(),
        ),
        Some("folded") => warnings.push("the spherical image is folded: boundaries at the fold are no good ones".into()),
        _ => {}
    }
    warnings
}

fn start_warnings(start: &StartInReport) -> Vec<String> {
    let sum = |list: &[usize]| list.iter().sum::<usize>();
    let mut warnings = Vec::new();
    for (count, what) in [
        (
            sum(&start.missed_rulings),
            "rulings did not meet the next boundary along their asymptotic curves, and lead to its nearest point",
        ),
        (sum(&start.moved_rulings), "rulings crossed those before them, and were moved"),
    ] {
        if count > 0 {
            warnings.push(format!("at the start {count} {what}"));
        }
    }
    warnings
}

pub fn optimisation_warnings(found: &Optimised, asked: &Asked) -> Vec<String> {
    let mut warnings = Vec::new();
    match found.stop {
        optimise::Stop::MostIterations if asked.optimise.max_iterations > 0 => {
            warnings.push("the optimisation used all its iterations: --iterations allows more".into());
        }
        optimise::Stop::LineSearch => warnings.push("the optimisation stopped where no step lowers the sum".into()),
        optimise::Stop::Cancelled => warnings.push("stopped with Ctrl-C: these strips are the best so far".into()),
        _ => {}
    }
    let excess = found.last().excess;
    if excess > 0.0 {
        let bounds = [
            ("--largest-deviation", asked.optimise.bounds.largest_deviation.is_some()),
            ("--least-width", asked.optimise.bounds.least_width.is_some()),
        ];
        let names: Vec<&str> = bounds.iter().filter(|(_, is_given)| *is_given).map(|(name, _)| *name).collect();
        warnings.push(format!(
            "{} cannot be kept everywhere: it is exceeded by up to {}",
            names.join(" or "),
            number(excess)
        ));
    }
    warnings
}

/// The name of a file, for titles.
pub fn title(path: &Path) -> String {
    crate::commands::recipe::file_name(path)
}
