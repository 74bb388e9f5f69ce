//! Curves that guide a snake, and where they start on it.

use std::path::Path;

use anyhow::{Result, anyhow, bail};
use glam::DVec3;
use serde::Serialize;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::rails::Rail;
use shapeop::mesh::curve::{ArcLength, Curve as _, NearestOnCurve, Spline};

use crate::args::snake::{Point, RailAt};
use crate::curve_file::Curve;
use crate::table::number;

/// Rails that start farther from the snake than this part of its length do not start on it.
const ON_SNAKE: f64 = 1e-6;

/// What a rail does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A control point runs along it, at this speed of the parameter.
    Drive { point: u32, speed: f64 },
    /// A control point follows the one that the first rail drives.
    Follow { point: u32 },
    /// The snake meets it, first in this contact.
    Glide { contact: u32 },
}

/// A curve that guides a snake.
pub struct Guide {
    /// The option or argument, and the file.
    pub name: String,
    pub curve: Spline,
    pub kind: Kind,
    /// The parameter at which it starts.
    pub start: f64,
    pub told: RailInReport,
}

#[derive(Clone, Serialize)]
pub struct RailInReport {
    pub file: String,
    /// `drive`, `follow` or `glide`.
    pub kind: &'static str,
    /// The control point, or the contact in which a gliding snake meets it first.
    pub point: u32,
    pub length: f64,
    /// How far it was moved so that it starts on the snake.
    pub moved: f64,
}

/// A rail as it was asked for.
pub struct Asked<'a> {
    pub option: &'static str,
    pub file: &'a Path,
    pub point: Option<Point>,
    pub kind: AskedKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedKind {
    Drive,
    Follow,
    Glide,
}

impl<'a> Asked<'a> {
    pub fn of(option: &'static str, rail: &'a RailAt, kind: AskedKind) -> Self {
        Self { option, file: &rail.file, point: rail.point, kind }
    }
}

impl Guide {
    pub fn rail(&self) -> Rail<'_> {
        let (curve, start) = (&self.curve, self.start);
        match self.kind {
            Kind::Drive { point, speed } => Rail::Driven { point, curve, start, speed },
            Kind::Follow { point } => Rail::Following { point, curve, start, leader: 0 },
            Kind::Glide { contact } => Rail::Gliding { contact, curve, start },
        }
    }

    /// Points along it, for pictures.
    pub fn line(&self) -> Vec<DVec3> {
        let [low, high] = self.curve.range();
        (0..=128).map(|k| self.curve.point(low + (high - low) * f64::from(k) / 128.0)).collect()
    }
}

/// Reads rails and finds where they start on a snake; `speed` is that of a control point. With `snaps` rails are moved onto it.
pub fn guides(asked: &[Asked<'_>], snake: &Snake, speed: &dyn Fn(u32) -> f64, snaps: bool) -> Result<Vec<Guide>> {
    let mut taken = Vec::new();
    let mut found = Vec::with_capacity(asked.len());
    for asked in asked {
        let guide = guide(asked, snake, &taken, speed, snaps)?;
        if let Kind::Drive { point, .. } | Kind::Follow { point } = guide.kind {
            taken.push(point);
        }
        found.push(guide);
    }
    Ok(found)
}

fn guide(asked: &Asked<'_>, snake: &Snake, taken: &[u32], speed: &dyn Fn(u32) -> f64, snaps: bool) -> Result<Guide> {
    let curve = Curve::read(asked.file)?;
    let name = format!("{}: {}", asked.option, curve.name);
    let spline = Spline::through(curve.distinct(), curve.is_closed).map_err(|error| anyhow!("{name}: {error}"))?;
    let near = NearestOnCurve::new(&spline).map_err(|error| anyhow!("{name}: {error}"))?;
    let (points, what) = match asked.kind {
        AskedKind::Glide => (snake.contacts(), "contacts"),
        _ => (snake.control().to_vec(), "control points"),
    };
    let last = points.len() - 1;
    let candidates: Vec<usize> = match asked.point {
        Some(Point::Number(number)) if number as usize <= last => vec![number as usize],
        Some(Point::Number(number)) => bail!("{name}: point {number} is out of range for {} {what}", points.len()),
        Some(Point::Start) => vec![0],
        Some(Point::End) => vec![last],
        None if asked.kind == AskedKind::Glide || snake.is_closed() => (0..=last).collect(),
        None => vec![0, last],
    };
    let is_free = |&&i: &&usize| asked.point.is_some() || !taken.contains(&(i as u32));
    let distance = |i: usize| near.nearest(points[i]).distance;
    let Some(&point) = candidates.iter().filter(is_free).min_by(|&&a, &&b| distance(a).total_cmp(&distance(b))) else {
        bail!("{name}: both ends are on other rails: say which point runs on this one, as FILE@2");
    };
    let foot = near.nearest(points[point]);
    let is_on = foot.distance <= ON_SNAKE * snake.length();
    if !is_on && !snaps {
        let of = if asked.kind == AskedKind::Glide { "contact" } else { "control point" };
        bail!(
            "{name}: expected a rail through {of} {point} of the snake, found one {} from it; --snap moves it there",
            number(foot.distance)
        );
    }
    let moved = if is_on { DVec3::ZERO } else { points[point] - foot.point };
    let start = foot.parameter;
    let spline = if is_on {
        spline.clone()
    } else {
        let points: Vec<DVec3> = curve.distinct().iter().map(|at| *at + moved).collect();
        Spline::through(&points, curve.is_closed).map_err(|error| anyhow!("{name}: {error}"))?
    };
    let [low, high] = spline.range();
    // Away from the nearer end.
    let sense = if !curve.is_closed && start - low > high - start { -1.0 } else { 1.0 };
    let at = point as u32;
    let (kind, word) = match asked.kind {
        AskedKind::Drive => (Kind::Drive { point: at, speed: sense * speed(at) }, "drive"),
        AskedKind::Follow => (Kind::Follow { point: at }, "follow"),
        AskedKind::Glide => (Kind::Glide { contact: at }, "glide"),
    };
    let length = ArcLength::new(&spline).map_err(|error| anyhow!("{name}: {error}"))?.total();
    let told = RailInReport { file: curve.name, kind: word, point: at, length, moved: moved.length() };
    Ok(Guide { name, curve: spline, kind, start: start.clamp(low, high), told })
}
