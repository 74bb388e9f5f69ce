//! `explore`: a drag replayed frame by frame, hard constraints met all the way.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::Serialize;
use shapeop::mesh::file::Format;
use shapeop::mesh::measure::{Spread, displacements, edge_lengths};
use shapeop::mesh::{Mesh, Topology};
use shapeop::problem::{Mode, Objective, Problem};
use shapeop::solver::{Outcome, Solver};

use super::recipe::file_name;
use crate::args::{Colour, ExploreArgs};
use crate::cells::Cells;
use crate::drag::{self, Drag, Limits, Seen, Solved};
use crate::exploration::{Conflict, WhatWeightsDo, explained};
use crate::moves::Moves;
use crate::output::{Output, say};
use crate::picture::Picture;
use crate::run::explores;
use crate::shown::Shown;
use crate::table::{aligned, number, percent};
use crate::{Ending, plot, progress};

/// Frames in the picture between start and end.
const PICTURED: usize = 4;

/// Rows of the table of frames at most.
const TABLED: usize = 16;

/// The report; `docs/exploration.md` explains its fields.
#[derive(Serialize)]
struct Report {
    version: u32,
    program: &'static str,
    command: &'static str,
    input: String,
    moves: String,
    points: usize,
    faces: usize,
    constraints: BTreeMap<&'static str, Count>,
    objective: Objective,
    budget_seconds: f64,
    max_iterations: u32,
    outcome: &'static str,
    frames: Vec<Solved>,
    settled: Option<Solved>,
    conflicts: Vec<Conflict>,
    sensitivities: Option<WhatWeightsDo>,
    /// How far points are from where they started, in model units; over the mean edge where there are faces or edges.
    displacement: Spread,
    max_over_mean_edge: Option<f64>,
    /// Seconds of solving, and the distance from the final shape over that at the start.
    distance: Vec<(f64, f64)>,
    files: BTreeMap<String, String>,
}

/// Constraints of a type.
#[derive(Default, Serialize)]
struct Count {
    hard: usize,
    soft: usize,
}

/// What is kept of a frame for the picture.
struct Kept {
    title: String,
    mesh: Mesh,
    violations: Vec<f64>,
    handles: Vec<[DVec3; 2]>,
}

impl Kept {
    fn of(title: String, solver: &Solver, faces: &[Vec<u32>]) -> Self {
        let points = solver.points();
        Self {
            title,
            mesh: Mesh { points: points.to_vec(), faces: faces.to_vec() },
            violations: solver.violations(),
            handles: solver.handles().map(|(point, target)| [points[point as usize], target]).collect(),
        }
    }
}

pub fn run(args: &ExploreArgs, is_quiet: bool) -> Result<Ending> {
    let name = args.problem.display();
    let text = std::fs::read_to_string(&args.problem).with_context(|| format!("{name}: cannot be read"))?;
    let problem = Problem::from_json(&text).with_context(|| name.to_string())?;
    if problem.mode == Mode::Dynamic {
        bail!("{name}: mode: expected \"static\", found \"dynamic\"");
    }
    if !explores(&problem) {
        bail!("{name}: expected a hard constraint, a handle or an objective; without any there is nothing to explore");
    }
    let moves = Moves::read(&args.handles, &problem)?;
    let format = args.output.format.map_or(Format::Obj, Into::into);
    let mut output = Output::new(&args.output.out, &args.problem, "explore", args.output.picture)?;
    progress::catch_interrupts();
    let limits = Limits {
        budget_seconds: args.budget_ms / 1000.0,
        max_iterations: args.iterations.unwrap_or(problem.settings.max_iterations),
        tolerance: problem.settings.tolerance,
    };
    let start = Solver::from_problem(&problem)?;
    let mut kept = vec![Kept::of("start".to_owned(), &start, &problem.faces)];
    let count = moves.frames.len();
    // Evenly spaced, and not the last: the end follows it.
    let is_pictured = |frame: usize| {
        count <= PICTURED || (1..=PICTURED).any(|i| frame == (i * count).div_ceil(PICTURED + 1).saturating_sub(1))
    };
    let mut look = |seen: &Seen<'_>| -> Result<String> {
        let Some(frame) = seen.frame else { return Ok(output.mesh_path(format)) };
        if is_pictured(frame) {
            kept.push(Kept::of(format!("frame {frame}"), seen.solver, &problem.faces));
        }
        let mesh = Mesh { points: seen.solver.points().to_vec(), faces: problem.faces.clone() };
        output.frame(frame, &mesh, format)
    };
    let mut drag =
        drag::replay(&problem, &moves, &limits, args.threads, is_quiet, &mut look).with_context(|| name.to_string())?;
    let last = if drag.settled.is_some() { "end" } else { "where it was stopped" };
    kept.push(Kept::of(last.to_owned(), &drag.solver, &problem.faces));

    let after = Mesh { points: drag.solver.points().to_vec(), faces: problem.faces.clone() };
    output.mesh(&after, format)?;
    let mut report = Report::new(args, &problem, &limits, &mut drag)?;
    if output.wants_pictures() {
        output.picture("picture", &picture(args, &problem, &start, &kept, &report)?)?;
        let title = format!("{}: how fast the final shape is approached", file_name(&args.problem));
        if let Some(svg) = plot::distance(&title, &report.distance, &drag.track.begins)? {
            output.picture("distance", &svg)?;
        }
    }
    output.report_with(|files| {
        report.files = files;
        report.to_json()
    })?;
    if !is_quiet {
        say(&if args.output.json { report.to_json()?.trim_end().to_owned() } else { report.in_words(&output) })?;
    }
    Ok(match drag.outcome {
        Outcome::Cancelled => Ending::Interrupted,
        Outcome::Infeasible => Ending::Infeasible,
        _ => Ending::Done,
    })
}

impl Report {
    fn new(args: &ExploreArgs, problem: &Problem, limits: &Limits, drag: &mut Drag) -> Result<Self> {
        let mut constraints: BTreeMap<&'static str, Count> = BTreeMap::new();
        for view in (0..drag.solver.constraint_count()).filter_map(|id| drag.solver.constraint(id)) {
            let count = constraints.entry(view.info.name).or_default();
            *(if view.is_hard { &mut count.hard } else { &mut count.soft }) += 1;
        }
        let is_solution = drag.settled.as_ref().is_some_and(|settled| settled.found.is_solution);
        let sensitivities = if is_solution { Some(WhatWeightsDo::of(&drag.solver.sensitivities()?)) } else { None };
        let before: Vec<DVec3> = problem.points.iter().copied().map(DVec3::from_array).collect();
        let displacement = Spread::of(&displacements(&before, drag.solver.points())?);
        let edge = mean_edge(problem, &before)?;
        let last = drag.settled.as_ref().or(drag.frames.last());
        Ok(Self {
            version: 1,
            program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            command: "explore",
            input: args.problem.display().to_string(),
            moves: args.handles.display().to_string(),
            points: problem.points.len(),
            faces: problem.faces.len(),
            constraints,
            objective: drag.solver.objective(),
            budget_seconds: limits.budget_seconds,
            max_iterations: limits.max_iterations,
            outcome: drag.outcome.text(),
            conflicts: last.map(|last| last.found.conflicts.clone()).unwrap_or_default(),
            frames: drag.frames.clone(),
            settled: drag.settled.clone(),
            sensitivities,
            max_over_mean_edge: edge.map(|edge| displacement.max / edge),
            displacement,
            distance: drag.track.distances(drag.solver.points()),
            files: BTreeMap::new(),
        })
    }

    fn to_json(&self) -> Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }

    fn mean_edge(&self) -> Option<f64> {
        self.max_over_mean_edge.filter(|share| *share > 0.0).map(|share| self.displacement.max / share)
    }

    /// "12 frames in 0.31 s of solving, 18 ms at most; settled in 5 ms: converged".
    fn ending(&self) -> String {
        let count = self.frames.len();
        let longest = self.frames.iter().map(|frame| frame.seconds).fold(0.0, f64::max);
        let total = self.settled.as_ref().or(self.frames.last()).map_or(0.0, |last| last.at_seconds);
        let plural = if count == 1 { "" } else { "s" };
        let end = match &self.settled {
            Some(settled) => format!("the end: {}", settled.outcome),
            None => "stopped with Ctrl-C".to_owned(),
        };
        format!("{count} frame{plural}, {total:.2} s of solving, at most {:.1} ms a frame; {end}", 1000.0 * longest)
    }

    fn in_words(&self, output: &Output) -> String {
        let counted = |(name, Count { hard, soft }): (&&str, &Count)| {
            let part = |count: &usize, what: &str| (*count > 0).then(|| format!("{count} {name}{what}"));
            [part(hard, " (hard)"), part(soft, "")].into_iter().flatten().collect::<Vec<_>>().join(", ")
        };
        let constraints: Vec<String> = self.constraints.iter().map(counted).collect();
        let mut parts = vec![
            format!(
                "explore {} with {}: {} points, {} faces; {}\n{}",
                self.input,
                self.moves,
                self.points,
                self.faces,
                constraints.join(", "),
                self.ending()
            ),
            self.frames_in_lines(),
        ];
        if self.outcome == Outcome::Infeasible.text() {
            parts.push(explained(&self.conflicts));
        } else if let Some(sensitivities) = &self.sensitivities {
            parts.push(sensitivities.in_lines(self.mean_edge()));
        } else if self.settled.is_some() {
            parts.push(self.no_solution_in_words());
        }
        parts.push(output.in_lines());
        parts.join("\n\n")
    }

    fn no_solution_in_words(&self) -> String {
        let start = "  What weights do can be told of a solution only, and the last solve did not reach one";
        match self.settled.as_ref().and_then(|settled| Some((settled.found.worst?, settled.found.largest_violation))) {
            Some((worst, violation)) => format!(
                "{start}: constraint {worst} is off by {}.\n  It may need more sweeps (--iterations), or hard constraints \
                 contradict each other.",
                number(violation)
            ),
            None => format!("{start}; it may need more sweeps (--iterations)."),
        }
    }

    fn frames_in_lines(&self) -> String {
        let head = ["frame", "handles", "sweeps", "Newton", "ms", "violation", "outcome"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let row = |name: String, solved: &Solved| {
            vec![
                name,
                solved.handles.to_string(),
                solved.found.sweeps.to_string(),
                solved.found.newton_steps.to_string(),
                format!("{:.1}", 1000.0 * solved.seconds),
                solved.found.worst.map_or("–".to_owned(), |_| number(solved.found.largest_violation)),
                solved.outcome.to_owned(),
            ]
        };
        let stride = self.frames.len().div_ceil(TABLED).max(1);
        let shown = self.frames.iter().enumerate().filter(|(i, _)| i % stride == 0 || i + 1 == self.frames.len());
        rows.extend(shown.map(|(i, solved)| row(i.to_string(), solved)));
        rows.extend(self.settled.as_ref().map(|settled| row("end".to_owned(), settled)));
        let moved =
            self.max_over_mean_edge.map_or(String::new(), |share| format!(" ({} of the mean edge)", percent(share)));
        format!("{}\n\n  moved, max   {}{moved}", aligned(&rows), number(self.displacement.max))
    }
}

/// The mean length of the edges; `None` without any, or if all are points.
fn mean_edge(problem: &Problem, points: &[DVec3]) -> Result<Option<f64>> {
    let lengths = if problem.faces.is_empty() {
        problem.edges.iter().map(|[a, b]| points[*a as usize].distance(points[*b as usize])).collect()
    } else {
        edge_lengths(&Mesh { points: points.to_vec(), faces: problem.faces.clone() })?
    };
    Ok(Some(Spread::of(&lengths).mean).filter(|mean| *mean > 0.0))
}

fn picture(args: &ExploreArgs, problem: &Problem, start: &Solver, kept: &[Kept], report: &Report) -> Result<String> {
    let before = &kept[0].mesh;
    let edges = if problem.edges.is_empty() { Topology::new(before)?.edges().to_vec() } else { problem.edges.clone() };
    let cells = if args.output.colour == Colour::Auto { Cells::of(problem, before, start) } else { None };
    let what = if args.output.colour == Colour::Auto { Colour::Displacement } else { args.output.colour };
    let shown = Shown::new(what, args.output.limit, before, &edges, None);
    let mut panels = Vec::new();
    for Kept { title, mesh, violations, handles } in kept {
        let mut panel = match &cells {
            Some(cells) => cells.panel(mesh, &edges, title.clone(), violations),
            None => shown.panel(mesh, &edges, title.clone()),
        };
        panel.handles.clone_from(handles);
        panels.push(panel);
    }
    let scale = cells.as_ref().map_or_else(|| shown.scale(&panels), |cells| Some(cells.scale()));
    let title = format!("{}: explore", file_name(&args.problem));
    let subtitle = format!("{}; blue: handles, and where they are drawn to", report.ending());
    Ok(Picture { title, subtitle, panels, scale, fits_each: false }.to_svg())
}
