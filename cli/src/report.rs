//! The report of a run: a JSON file beside the mesh. `docs/report.md` explains its fields.

use std::collections::BTreeMap;

use anyhow::Result;
use serde::Serialize;
use serde_json::Value;
use shapeop::mesh::Mesh;
use shapeop::mesh::measure::{Spread, displacements};
use shapeop::problem::{Mode, Problem, Settings};
use shapeop::solver::{Backend, Outcome};

use crate::exploration::Exploration;
use crate::plot::Measure;
use crate::quality::Quality;
use crate::run::{History, Run};

/// The version of the report's form.
const VERSION: u32 = 1;

#[derive(Serialize)]
pub struct Report {
    pub version: u32,
    pub program: &'static str,
    pub command: String,
    pub input: String,
    pub mode: Mode,
    pub points: usize,
    pub faces: usize,
    /// Constraints by type.
    pub constraints: BTreeMap<String, usize>,
    /// Those of them that are hard, by type.
    pub hard_constraints: BTreeMap<String, usize>,
    /// What the recipe was asked for; null for a problem file.
    pub options: Value,
    pub settings: Settings,
    /// How the run ended: converged, iteration limit, time budget, cancelled, stalled, infeasible.
    pub outcome: &'static str,
    pub iterations: u32,
    /// Local steps at points that were tried, kept or not.
    pub evaluations: u32,
    /// What acceleration tried in vain, by cause.
    pub rejections: BTreeMap<&'static str, u32>,
    pub steps: u32,
    pub backend: Machine,
    pub seconds: Seconds,
    pub energy: BeforeAfter<f64>,
    /// The largest move of a point in the last iteration over the bounding-box diagonal.
    pub largest_move: f64,
    /// The planarity that is still good enough, as a ratio.
    pub limit: f64,
    /// The measures of the mesh; null without faces.
    pub quality: Option<BeforeAfter<Quality>>,
    pub displacement: Displacement,
    /// The violation of the constraints at the end, by type, in the type's unit; places are constraint ids.
    pub violations: BTreeMap<String, Violations>,
    /// What was found with hard constraints, handles or an objective; null without any.
    pub exploration: Option<Exploration>,
    /// Points that no constraint of a weight above 0 holds; they keep their place.
    pub unconstrained_points: usize,
    /// Constraints whose rest state spans too little to say what they ask for.
    pub degenerate_constraints: Vec<usize>,
    /// One entry per iteration, those of all time steps one after the other.
    pub history: History,
    /// The files written, by what they are.
    pub files: BTreeMap<String, String>,
}

#[derive(Clone, Serialize)]
pub struct BeforeAfter<T> {
    pub before: T,
    pub after: T,
}

/// What iterated.
#[derive(Serialize)]
pub struct Machine {
    /// `cpu`, or `gpu` if the graphics card made any of the iterations.
    pub used: &'static str,
    /// Why, in words.
    pub reason: String,
    /// What happened to the card, if it was lost or refused work.
    pub fault: Option<String>,
    /// The card, if it made any of the iterations.
    pub adapter: Option<String>,
    pub gpu_iterations: u32,
    /// In which the card worked, and in which points went to it and back.
    pub gpu_seconds: f64,
    pub transfer_seconds: f64,
}

impl Machine {
    fn of(run: &Run) -> Self {
        let report = &run.report;
        let is_gpu = report.backend == Backend::Gpu;
        let card = || {
            run.solver.backend_info().ok().map(|info| format!("{} ({}, {})", info.adapter, info.kind.text(), info.api))
        };
        Self {
            used: if is_gpu { "gpu" } else { "cpu" },
            reason: report.backend_reason.clone(),
            fault: (report.outcome == Outcome::BackendFailed).then(|| report.message.clone()),
            adapter: if is_gpu { card() } else { None },
            gpu_iterations: report.gpu_iterations,
            gpu_seconds: report.gpu_seconds,
            transfer_seconds: report.transfer_seconds,
        }
    }
}

/// Where the time went. The parts do not add up to the total: reading, progress and measuring are not among them.
#[derive(Serialize)]
pub struct Seconds {
    pub total: f64,
    pub analysis: f64,
    pub factorisation: f64,
    pub local_steps: f64,
    pub global_steps: f64,
}

#[derive(Serialize)]
pub struct Displacement {
    /// In model units; places are points.
    pub absolute: Spread,
    /// The mean and the greatest over the mean edge of the mesh before; null without faces.
    pub mean_over_mean_edge: Option<f64>,
    pub max_over_mean_edge: Option<f64>,
}

#[derive(Serialize)]
pub struct Violations {
    pub unit: &'static str,
    pub spread: Spread,
}

/// What a report is made of besides the run.
pub struct Subject<'a> {
    pub command: &'a str,
    pub input: &'a str,
    pub problem: &'a Problem,
    pub settings: Settings,
    pub options: Value,
    pub limit: f64,
    pub before: &'a Mesh,
    pub after: &'a Mesh,
}

impl Report {
    pub fn new(subject: &Subject<'_>, run: &Run) -> Result<Self> {
        let Subject { problem, before, after, limit, .. } = *subject;
        let (mut constraints, mut hard_constraints) = (BTreeMap::new(), BTreeMap::new());
        let mut by_type: BTreeMap<&str, Vec<(usize, f64)>> = BTreeMap::new();
        let mut degenerate_constraints = Vec::new();
        for (id, violation) in run.solver.violations().into_iter().enumerate() {
            let Some(view) = run.solver.constraint(id) else { continue };
            *constraints.entry(view.info.name.to_owned()).or_insert(0) += 1;
            if view.is_hard {
                *hard_constraints.entry(view.info.name.to_owned()).or_insert(0) += 1;
            }
            by_type.entry(view.info.name).or_default().push((id, violation));
            if view.is_degenerate {
                degenerate_constraints.push(id);
            }
        }
        let violations = by_type.into_iter().map(|(name, list)| {
            let values: Vec<f64> = list.iter().map(|(_, violation)| *violation).collect();
            let mut spread = Spread::of(&values);
            (spread.min_at, spread.max_at) = (list[spread.min_at].0, list[spread.max_at].0);
            let unit = run.solver.constraint(spread.max_at).map_or("", |view| view.info.violation_unit);
            (name.to_owned(), Violations { unit, spread })
        });
        let quality = if problem.faces.is_empty() {
            None
        } else {
            Some(BeforeAfter { before: Quality::of(before, limit)?, after: Quality::of(after, limit)? })
        };
        let moved = Spread::of(&displacements(&before.points, &after.points)?);
        let edge = quality.as_ref().map(|quality| quality.before.edge_length.mean).filter(|edge| *edge > 0.0);
        let solver_report = &run.report;
        let rejections = solver_report.rejections;
        Ok(Self {
            version: VERSION,
            program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            command: subject.command.to_owned(),
            input: subject.input.to_owned(),
            mode: problem.mode,
            points: problem.points.len(),
            faces: problem.faces.len(),
            constraints,
            hard_constraints,
            options: subject.options.clone(),
            settings: subject.settings,
            outcome: solver_report.outcome.text(),
            iterations: solver_report.iterations,
            evaluations: solver_report.evaluations,
            rejections: BTreeMap::from([
                ("energy_rose", rejections.energy_rose),
                ("not_finite", rejections.not_finite),
                ("ill_conditioned", rejections.ill_conditioned),
                ("not_descent", rejections.not_descent),
                ("line_search", rejections.line_search),
            ]),
            steps: run.steps,
            backend: Machine::of(run),
            seconds: Seconds {
                total: run.seconds,
                analysis: solver_report.analysis_seconds,
                factorisation: solver_report.factorisation_seconds,
                local_steps: solver_report.local_seconds,
                global_steps: solver_report.global_seconds,
            },
            energy: BeforeAfter { before: solver_report.energy_before, after: solver_report.energy_after },
            largest_move: solver_report.largest_move,
            limit,
            quality,
            displacement: Displacement {
                absolute: moved,
                mean_over_mean_edge: edge.map(|edge| moved.mean / edge),
                max_over_mean_edge: edge.map(|edge| moved.max / edge),
            },
            violations: violations.collect(),
            exploration: Exploration::of(&run.solver),
            unconstrained_points: run.solver.unconstrained_count(),
            degenerate_constraints,
            history: run.history.clone(),
            files: BTreeMap::new(),
        })
    }

    /// True if hard constraints contradict each other.
    pub fn is_infeasible(&self) -> bool {
        self.outcome == Outcome::Infeasible.text()
    }

    /// What the history has as energy.
    pub fn measure(&self) -> Measure {
        if self.exploration.is_some() { Measure::Residual } else { Measure::Energy }
    }

    /// "converged after 81 iterations in 0.32 s".
    pub fn ending(&self) -> String {
        let outcome = match self.outcome {
            cancelled if cancelled == Outcome::Cancelled.text() => "stopped with Ctrl-C",
            _ if self.is_infeasible() => "hard constraints contradict each other: stopped",
            outcome => outcome,
        };
        let plural = |count: u32, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let (iterations, seconds) = (plural(self.iterations, "iteration"), self.seconds.total);
        if self.mode == Mode::Static {
            return format!("{outcome} after {iterations} in {seconds:.2} s");
        }
        let is_whole = self.steps == self.settings.steps;
        let start = if is_whole { String::new() } else { format!("{outcome} after ") };
        format!("{start}{}, {iterations} in {seconds:.2} s", plural(self.steps, "time step"))
    }

    pub fn to_json(&self) -> Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }
}
