//! `canal sections`: a C-canal surface along a guide, with a planar cross-section, and lengths across or a second curve.

use std::ops::ControlFlow;

use anyhow::{Context, Result, anyhow};
use shapeop::geometry::canal::c_canal::{Target, c_canal};
use shapeop::mesh::curve::{NearestOnCurve, Spline};

use super::bases::in_files;
use super::made::{Made, named, write};
use super::strips::lengths_of;
use crate::Ending;
use crate::args::canal::SectionsArgs;
use crate::curve_file::Curve;
use crate::output::Output;
use crate::progress::{Progress, catch_interrupts, is_interrupted};

/// Steps of the progress bar.
const STEPS: u32 = 100;

pub fn run(args: &SectionsArgs, is_quiet: bool) -> Result<Ending> {
    let (guide, section) = (Curve::read(&args.guide)?, Curve::read(&args.section)?);
    let second = args.curve.as_deref().map(Curve::read).transpose()?;
    let spline = match &second {
        None => None,
        Some(curve) => {
            let spline = Spline::through(curve.distinct(), curve.is_closed);
            Some(spline.map_err(|error| anyhow!("{}: {error}", curve.name))?)
        }
    };
    let nearest = spline.as_ref().map(|spline| NearestOnCurve::new(spline)).transpose()?;
    let lengths = args.lengths.as_ref().map(|lengths| lengths_of(lengths, &guide.points)).transpose()?;
    let target = match (&nearest, &lengths) {
        (Some(nearest), _) => Target::Curve(nearest),
        (None, lengths) => Target::Lengths(lengths.as_deref().context("expected --lengths or --curve")?),
    };
    Output::new(&args.output.out, &args.guide, "sections", args.output.picture)?;
    catch_interrupts();
    let progress = Progress::new(STEPS, is_quiet);
    let found = c_canal(&guide.points, &section.points, target, args.project, &mut |share| {
        progress.say((share * f64::from(STEPS)) as usize, "sections");
        if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    let found = found.map_err(|error| in_files(error, &[("guide", &guide), ("section", &section)]))?;
    let ending = if found.is_cancelled { Ending::Interrupted } else { Ending::Done };
    let (residual, largest) = (found.residual(), found.deviations.iter().copied().fold(0.0, f64::max));
    let mut made =
        Made::new(found.surface).curve("guide", &guide, !found.is_cancelled).curve("section", &section, true);
    if let Some(curve) = &second {
        made = made.curve("second curve", curve, false);
    }
    made.find("equation_10", residual);
    made.find("largest_deviation", largest);
    made.find("deviations", &found.deviations);
    made.find("lengths", &found.lengths);
    made.find("attainable", &found.attainable);
    if !found.projected.is_empty() {
        let list = named(&found.projected);
        made.warn(format!("lengths are not attainable and were replaced, by up to {largest:.3e}: {list}"));
    }
    if found.is_cancelled {
        made.warn("stopped with Ctrl-C: the surface ends where it was");
    }
    write("sections", &args.guide, made, &args.output, is_quiet)?;
    Ok(ending)
}
