//! `canal fit`: the canal surface along one curve that touches another.

use anyhow::{Result, anyhow};
use shapeop::geometry::canal::circles::Section;
use shapeop::geometry::canal::fit::{FitOptions, fit_guide};
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::normals::Orientation;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::mesh::curve::{Curve as _, NearestOnCurve, Spacing, Spline, resample};

use super::made::{Made, named, write};
use super::strips::guide_of;
use crate::Ending;
use crate::args::canal::{FitArgs, SectionKind};
use crate::curve_file::Curve;

pub fn run(args: &FitArgs, is_quiet: bool) -> Result<Ending> {
    let (guide, curve) = (Curve::read(&args.guide)?, Curve::read(&args.curve)?);
    let spline = |curve: &Curve| {
        Spline::through(curve.distinct(), curve.is_closed).map_err(|error| anyhow!("{}: {error}", curve.name))
    };
    let section = match args.section {
        SectionKind::ToCurve => Section::ToCurve { is_long_way: false },
        SectionKind::LongWay => Section::ToCurve { is_long_way: true },
        SectionKind::Whole => Section::Whole,
    };
    let guide_spline = spline(&guide)?;
    let points = match args.circles {
        None => guide.distinct().to_vec(),
        Some(count) => {
            let parameters = resample(&guide_spline, count, Spacing::ArcLength)?;
            parameters.into_iter().map(|parameter| guide_spline.point(parameter)).collect()
        }
    };
    let options = FitOptions {
        circle_count: points.len(),
        spacing: Spacing::ArcLength,
        column_count: args.columns,
        orientation: Orientation::Angle(args.phi.to_radians()),
        section,
    };
    let second = spline(&curve)?;
    let found = fit_guide(&guide_of(&points, guide.is_closed)?, &NearestOnCurve::new(&second)?, &options)?;
    let surface = SuperCanal::new(Net::new(found.grid, found.frame)?, BaseKind::Canal);
    let mut made =
        Made::new(surface).curve("guide", &guide, args.circles.is_none()).curve("second curve", &curve, false);
    made.find("phi_deg", args.phi);
    made.find("deviation_from_second_curve", found.deviation);
    let strip = &found.strip;
    made.find("equation_6", strip.spheres.residual);
    made.find("tangent_gap", strip.tangent_gap);
    if let Some(gap) = strip.closing_gap {
        made.find("closing_gap", gap);
        if gap > 1e-9 {
            made.warn(format!(
                "the guide is closed but its frames come back off by {gap:.3e}: the surface is left open"
            ));
        }
    }
    let findings = &strip.spheres.findings;
    for (list, what) in [
        (&findings.ends, "spheres only pass through an end of the second curve"),
        (&findings.jumps, "spheres touch another branch of the second curve than the one before"),
        (&findings.sign_changes, "spheres are on the other side of the first curve than the one before"),
        (&findings.pierced, "spheres are pierced by the second curve elsewhere"),
    ] {
        if !list.is_empty() {
            made.warn(format!("{what}: {}", named(list)));
        }
    }
    if strip.is_extrapolated.contains(&true) {
        made.warn("the second curve ends before the first does: circles there go on as the others do");
    }
    write("fit", &args.guide, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}
