//! Surfaces from a curve or two by a closed construction: revolution, moulding, Monge, and their inversions.

use anyhow::{Context, Result};
use shapeop::error::Error;
use shapeop::geometry::canal::bases::{self, InvertedBase, Swept};
use shapeop::geometry::canal::chain::Transform;
use shapeop::geometry::canal::m_moulding::{MouldingCenter, m_moulding as make_m_moulding};
use shapeop::geometry::canal::m_revolution::m_revolution as make_m_revolution;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::revolution_centers::Center;
use shapeop::geometry::canal::spherical_guide::{GuideSphere, spherical_m_revolution};
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::geometry::circle::Sphere;

use super::made::{Made, write};
use crate::Ending;
use crate::args::canal::{CenterArgs, MMouldingArgs, MRevolutionArgs, RevolutionArgs, SweepArgs};
use crate::curve_file::Curve;

/// The obliquity of a profile from which on it is told: beyond it lines of curvature along the rail visibly zigzag.
const OBLIQUE_DEG: f64 = 1.0;

/// Puts the curve's file before a refusal that names it.
pub fn in_files(error: Error, names: &[(&str, &Curve)]) -> anyhow::Error {
    let names_it =
        |name: &str| error.place().strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('['));
    match names.iter().find(|(name, _)| names_it(name)) {
        Some((_, curve)) => anyhow::anyhow!("{}: {error}", curve.name),
        None => error.into(),
    }
}

pub fn revolution(args: &RevolutionArgs, is_quiet: bool) -> Result<Ending> {
    let profile = Curve::read(&args.profile)?;
    let base = bases::revolution(&profile.points, args.through, args.axis, args.angle.to_radians(), args.columns)
        .map_err(|error| in_files(error, &[("profile", &profile)]))?;
    let surface = SuperCanal::new(Net::new(base.grid, base.frame)?, BaseKind::Revolution);
    let made = Made::new(surface).curve("profile", &profile, true);
    write("revolution", &args.profile, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}

pub fn sweep(kind: &'static str, args: &SweepArgs, is_quiet: bool) -> Result<Ending> {
    let (rail, profile) = (Curve::read(&args.rail)?, Curve::read(&args.profile)?);
    let is_moulding = kind == "moulding";
    let swept = if is_moulding {
        bases::moulding(&rail.points, &profile.points)
    } else {
        bases::monge(&rail.points, &profile.points)
    };
    let Swept { base, obliquity_rad, reversed_count, closing_gap } =
        swept.map_err(|error| in_files(error, &[("rail", &rail), ("profile", &profile)]))?;
    let base_kind = if is_moulding { BaseKind::Moulding } else { BaseKind::Circular };
    let surface = SuperCanal::new(Net::new(base.grid, base.frame)?, base_kind);
    let mut made = Made::new(surface).curve("rail", &rail, true).curve("profile", &profile, true);
    made.has_evolute = true;
    sweep_findings(&mut made, obliquity_rad, reversed_count, closing_gap);
    write(kind, &args.rail, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}

fn sweep_findings(made: &mut Made, obliquity_rad: f64, reversed_count: usize, closing_gap: f64) {
    made.find("obliquity_deg", obliquity_rad.to_degrees());
    made.find("reversed_edges", reversed_count);
    if obliquity_rad.to_degrees() > OBLIQUE_DEG {
        made.warn(format!(
            "the rail leaves the profile's plane {:.2} degrees off its normal: lines along it zigzag when refined",
            obliquity_rad.to_degrees()
        ));
    }
    if reversed_count > 0 {
        made.warn(format!("{reversed_count} edges are reversed: the profile reaches beyond the evolute of the rail"));
    }
    if closing_gap > 0.0 {
        made.find("closing_gap", closing_gap);
        made.warn(format!("the profile comes back {closing_gap:.3e} off its start"));
    }
}

/// The surface of a base and its inversions.
fn inverted(image: InvertedBase, kind: BaseKind) -> Result<SuperCanal> {
    let mut surface = SuperCanal::new(Net::new(image.base.grid, image.base.frame)?, kind);
    for inversion in image.inversions {
        surface.push(Transform::Inversion(inversion))?;
    }
    Ok(surface)
}

fn center(args: &CenterArgs) -> Center {
    match (args.omega, args.ratio, args.center) {
        (Some(degrees), ..) => Center::Angle(degrees.to_radians()),
        (_, Some(ratio), _) => Center::Ratio { ratio, is_inside: false },
        (.., Some(point)) => Center::At(point),
        _ => Center::Middle,
    }
}

pub fn m_revolution(args: &MRevolutionArgs, is_quiet: bool) -> Result<Ending> {
    let curve = Curve::read(&args.curve)?;
    let MRevolutionArgs { p2, p3, columns, .. } = *args;
    let center = center(&args.center);
    let found = match args.sphere.sphere {
        None => make_m_revolution(&curve.points, p2, p3, center, args.up, columns),
        Some((middle, radius)) => {
            let sphere = Sphere { center: middle, radius };
            let guide = GuideSphere { sphere, pole: args.sphere.pole, is_outside: !args.sphere.inside };
            spherical_m_revolution(&curve.points, p2, p3, &guide, center, columns)
        }
    };
    let found = found.map_err(|error| in_files(error, &[("curve", &curve), ("corners", &curve)]))?;
    let mut made = Made::new(inverted(found.image, BaseKind::Revolution)?).curve("curve", &curve, true);
    made.find("omega_deg", found.omega.to_degrees());
    made.find("ratio", found.corners.ratio_at(found.omega));
    write("m-revolution", &args.curve, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}

pub fn m_moulding(args: &MMouldingArgs, is_quiet: bool) -> Result<Ending> {
    let (curve, rail) = (Curve::read(&args.curve)?, Curve::read(&args.rail)?);
    let at = match (args.p3, args.center.center) {
        (None, point) => MouldingCenter::At(point.context("center: expected a point, or --p3")?),
        (Some(p3), None) if args.center.omega.is_none() && args.center.ratio.is_none() => MouldingCenter::Chord { p3 },
        (Some(p3), _) => MouldingCenter::Corner { p3, center: center(&args.center) },
    };
    let found = make_m_moulding(&curve.points, &rail.points, at)
        .map_err(|error| in_files(error, &[("curve", &curve), ("rail", &rail)]))?;
    let kind = if found.is_moulding { BaseKind::Moulding } else { BaseKind::Circular };
    let mut made = Made::new(inverted(found.image, kind)?).curve("curve", &curve, true).curve("rail", &rail, true);
    // Column 0 is the planar curve, whose evolute says nothing.
    made.has_evolute = false;
    made.find("is_moulding", found.is_moulding);
    if let Some(gap) = found.corner_gap {
        made.find("corner_gap", gap);
    }
    sweep_findings(&mut made, found.obliquity_rad, found.reversed_count, found.closing_gap);
    write("m-moulding", &args.curve, made, &args.output, is_quiet)?;
    Ok(Ending::Done)
}
