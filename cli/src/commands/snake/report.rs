//! What a run found, as JSON (docs/snakes.md tells the fields) and in words.

use std::collections::BTreeMap;

use anyhow::Result;
use serde::Serialize;
use shapeop::geometry::snakes::evolution::Options;
use shapeop::geometry::snakes::report::Report as Covering;

use super::curve::CurveInReport;
use super::figures::{FrameInReport, KeptInReport, SnakeInReport, lowest_and_greatest};
use super::rails::RailInReport;
use super::start::StartInReport;
use crate::args::snake::MotionArgs;
use crate::commands::canal::in_json;
use crate::commands::ruled::counted;
use crate::output::Output;
use crate::table::{number, percent};

/// The version of the report's form.
const VERSION: u32 = 1;

#[derive(Serialize)]
pub struct Report {
    pub version: u32,
    pub program: &'static str,
    pub command: &'static str,
    pub input: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<StartInReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub snake: Option<SnakeInReport>,
    /// Why it ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<StopInReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evolution: Option<EvolutionInReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linkage: Option<LinkageInReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<Measures>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<CurveInReport>,
    pub warnings: Vec<String>,
    pub was_interrupted: bool,
    pub seconds: BTreeMap<&'static str, f64>,
    pub files: BTreeMap<String, String>,
}

impl Default for Report {
    fn default() -> Self {
        Self {
            version: VERSION,
            program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            command: "",
            input: String::new(),
            start: None,
            snake: None,
            stop: None,
            evolution: None,
            linkage: None,
            measures: None,
            curves: Vec::new(),
            warnings: Vec::new(),
            was_interrupted: false,
            seconds: BTreeMap::new(),
            files: BTreeMap::new(),
        }
    }
}

#[derive(Serialize)]
pub struct StopInReport {
    /// In a word or two.
    pub reason: &'static str,
    pub words: String,
    /// What can be done about it.
    pub advice: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rail: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
}

#[derive(Serialize)]
pub struct EvolutionInReport {
    pub motion: MotionInReport,
    /// Control points that stay.
    pub fixed: Vec<u32>,
    pub rails: Vec<RailInReport>,
    /// The start and the position after each step.
    pub frames: Vec<FrameInReport>,
}

#[derive(Serialize)]
pub struct MotionInReport {
    /// `left`, `right`, `along` or `rails`.
    pub way: &'static str,
    /// At the start of the snake and at its end.
    pub speed: [f64; 2],
    pub step: f64,
    pub max_steps: usize,
    pub max_deviation: Option<f64>,
    pub second_order: bool,
    pub alpha: f64,
    pub keep_torsions: bool,
    pub tangential_weight: f64,
    pub offset_weight: f64,
    pub rotation_weight: f64,
    pub orthogonal_weight: f64,
}

impl MotionInReport {
    pub fn of(way: &'static str, args: &MotionArgs, options: &Options) -> Self {
        Self {
            way,
            speed: args.speed.0,
            step: options.step,
            max_steps: options.max_steps,
            max_deviation: options.max_deviation.is_finite().then_some(options.max_deviation),
            second_order: options.is_second_order,
            alpha: options.alpha,
            keep_torsions: options.keeps_torsions,
            tangential_weight: options.weights.tangential,
            offset_weight: options.weights.offset,
            rotation_weight: options.weights.rotation,
            orthogonal_weight: options.weights.orthogonal,
        }
    }
}

#[derive(Serialize)]
pub struct LinkageInReport {
    /// In how many independent ways it can move at the start.
    pub freedoms: usize,
    /// That of the first six hinges at the start: 0 in singular positions.
    pub determinant: Option<f64>,
    pub positions: usize,
    /// How far the position found in the end is from the first; null if the motion did not close.
    pub closing: Option<f64>,
    /// By how much a distance is off at most.
    pub residual: f64,
    /// How far apart the extreme positions of the first and of the last arc are.
    pub ranges_deg: [f64; 2],
    /// Whole turns of both in a closed motion: 0 of one that rocks.
    pub turns: Option<[i32; 2]>,
    pub drive_switches: usize,
    pub array: ArrayInReport,
}

#[derive(Serialize)]
pub struct ArrayInReport {
    pub copies: usize,
    pub phase: f64,
    pub shift: f64,
    pub offset: [f64; 3],
}

/// What all positions come to.
#[derive(Serialize)]
pub struct Measures {
    /// docs/snake-report.schema.json
    pub covering: Covering,
    pub kept: KeptInReport,
    /// That of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diagonal: Option<f64>,
}

impl Report {
    pub fn in_json(&self) -> Result<String> {
        Ok(in_json(self)?.trim_end().to_owned())
    }

    /// Writes it, with the files before it.
    pub fn write(&mut self, output: &mut Output) -> Result<()> {
        output.report_with(|files| {
            self.files = files;
            in_json(self)
        })
    }

    /// The figures that matter, warnings, and files.
    pub fn in_words(&self, output: &Output) -> String {
        let mut rows: Vec<[String; 2]> = Vec::new();
        let mut row = |name: &str, value: String| rows.push([name.to_owned(), value]);
        if let Some(start) = &self.start
            && let Some(deviation) = start.fit_deviation
        {
            row("fit to the curve", format!("{} at most", number(deviation)));
        }
        if let Some(linkage) = &self.linkage {
            let determinant = linkage
                .determinant
                .map_or(String::new(), |determinant| format!(", determinant {}", number(determinant)));
            row("freedoms", format!("{}{determinant}", linkage.freedoms));
            let closing = linkage.closing.map_or(String::new(), |closing| format!(", closed to {}", number(closing)));
            row("motion", format!("{} positions{closing}", linkage.positions));
            for (k, name) in ["first arc", "last arc"].into_iter().enumerate() {
                let turns = linkage.turns.map_or(0, |turns| turns[k]);
                let word = if turns == 0 { "rocks by" } else { "turns around, by" };
                row(name, format!("{word} {}°", number(linkage.ranges_deg[k])));
            }
            row("drive", format!("changes ends {}", counted(linkage.drive_switches, "time")));
        }
        if let Some(evolution) = &self.evolution {
            row("steps", evolution.frames.len().saturating_sub(1).to_string());
        }
        if let Some(stop) = &self.stop {
            let advice = stop.advice.as_ref().map_or(String::new(), |advice| format!(" ({advice})"));
            row("stopped", format!("{}{advice}", stop.words));
        }
        if let Some(measures) = &self.measures {
            let covering = &measures.covering;
            let kinds = covering.kinds.len();
            let each = match covering.kinds.as_slice() {
                [one] => format!(", radius {}, length {}", number(one.radius), number(one.length)),
                _ => String::new(),
            };
            row("arcs", format!("{} of {}{each}", covering.instances, counted(kinds, "kind")));
            let kept = &measures.kept;
            row("radii kept to", number(kept.radius));
            row("lengths kept to", number(kept.length));
            row("torsions change by", format!("{}°", number(kept.torsion_deg)));
            if self.linkage.is_none() {
                let all = covering.positions;
                let count = kept.congruent_positions;
                let is_partial = count > 1 && count < all;
                let first = if is_partial { format!("; the first {count} of {all} to 1e-9") } else { String::new() };
                row("congruent to", format!("{} (rms after a rigid motion{first})", number(kept.congruence_rms)));
            }
            if covering.area > 0.0 {
                row("area swept", number(covering.area));
            }
            if let (Some(reference), Some(diagonal)) = (&covering.reference, measures.diagonal) {
                let deviation = reference.deviation;
                let part = percent(deviation.max / diagonal);
                let words = format!(
                    "{} at most ({part} of the diagonal), {} rms",
                    number(deviation.max),
                    number(deviation.rms)
                );
                row("from the mesh", words);
                let within = number(reference.distance);
                row("covered", format!("{} of the mesh, within {within}", percent(reference.coverage)));
            }
        }
        if let Some(snake) = &self.snake {
            row("radii", lowest_and_greatest(&snake.radii));
            row("lengths", lowest_and_greatest(&snake.lengths));
            row("distances kept to", number(snake.residual));
        }
        for curve in &self.curves {
            row(
                &format!("curvature {}", number(curve.curvature)),
                format!("{}, {} long", curve.turn, number(curve.length)),
            );
        }
        let seconds: Vec<String> = self.seconds.iter().map(|(what, time)| format!("{what} {time:.2}")).collect();
        row("seconds", seconds.join(", "));
        let width = rows.iter().map(|[name, _]| name.chars().count()).max().unwrap_or(0);
        let table: Vec<String> = rows.iter().map(|[name, value]| format!("  {name:<width$}   {value}")).collect();
        let warnings: String = self.warnings.iter().map(|warning| format!("\n  warning: {warning}")).collect();
        let warnings = if warnings.is_empty() { warnings } else { format!("\n{warnings}") };
        format!("{} {}\n\n{}{warnings}\n\n{}", self.command, self.input, table.join("\n"), output.in_lines())
    }
}
