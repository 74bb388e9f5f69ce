//! `snake curve`: curves of constant curvature on a mesh.

use std::fmt::Write;
use std::time::Instant;

use anyhow::Result;
use glam::DVec3;
use serde::Serialize;
use shapeop::geometry::snakes::curvature_curve::Side;
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::file::read_source;
use shapeop::mesh::reference::ReferenceMesh;

use super::coverings::polylines_obj;
use super::names::of_mesh;
use super::pictures;
use super::report::Report;
use super::start::{CurveAsked, curve_on_mesh};
use crate::Ending;
use crate::args::snake::{CurveArgs, Turns};
use crate::output::{Output, say};

#[derive(Clone, Serialize)]
pub struct CurveInReport {
    pub curvature: f64,
    /// `left` or `right`.
    pub turn: &'static str,
    pub length: f64,
    pub points: usize,
}

pub fn run(args: &CurveArgs, is_quiet: bool) -> Result<Ending> {
    let clock = Instant::now();
    let source = read_source(&args.mesh)?;
    let mesh = TriangleMesh::new(&source.mesh).map_err(|error| of_mesh(error, &args.mesh, &source.face_lines))?;
    let reference = ReferenceMesh::new(&mesh);
    let sides: &[(Side, &str)] = match args.turn {
        Turns::Left => &[(Side::Left, "left")],
        Turns::Right => &[(Side::Right, "right")],
        Turns::Both => &[(Side::Left, "left"), (Side::Right, "right")],
    };
    let (mut curves, mut told, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    for &curvature in &args.curvature {
        for &(side, turn) in sides {
            let asked =
                CurveAsked { from: args.start.from, toward: args.start.toward, curvature, length: args.length, side };
            let (points, lengths, shorter) = curve_on_mesh(&reference, &asked, args.points)?;
            let length = lengths.last().copied().unwrap_or(0.0);
            told.push(CurveInReport { curvature, turn, length, points: points.len() });
            curves.push((points, lengths));
            warnings.extend(shorter);
        }
    }
    let mut output = Output::new(&args.place.out, &args.mesh, "curve", args.place.picture)?;
    let mut table = "curve,curvature,turn,length,x,y,z\n".to_owned();
    for (k, ((points, lengths), of)) in curves.iter().zip(&told).enumerate() {
        for (p, length) in points.iter().zip(lengths) {
            let _ = writeln!(table, "{k},{},{},{length},{},{},{}", of.curvature, of.turn, p.x, p.y, p.z);
        }
    }
    let lines: Vec<Vec<DVec3>> = curves.into_iter().map(|(points, _)| points).collect();
    output.text("curves", ".obj", &polylines_obj(&lines, false))?;
    output.text("table", ".csv", &table)?;
    let mut report = Report {
        command: "snake curve",
        input: args.mesh.display().to_string(),
        curves: told,
        warnings,
        seconds: [("curves", clock.elapsed().as_secs_f64())].into_iter().collect(),
        ..Report::default()
    };
    if output.wants_pictures() {
        output.picture("picture", &pictures::curves(&source.mesh, &mesh, &lines, &report))?;
    }
    report.write(&mut output)?;
    if !is_quiet {
        say(&if args.place.json { report.in_json()? } else { report.in_words(&output) })?;
    }
    Ok(Ending::Done)
}
