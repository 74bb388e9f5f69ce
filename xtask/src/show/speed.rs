//! `cargo xtask show speed`.

use anyhow::Result;

use super::{Figures, number};
use crate::bench::{self, measure::Measurements};
use crate::shell;

/// At least so many times faster per iteration than compas-shapeop, at these sizes.
const RATIOS: [(&str, [f64; 3]); 4] = [
    ("planar_quads", [8.0, 15.0, 15.0]),
    ("squares", [15.0, 25.0, 25.0]),
    ("cloth", [4.0, 6.0, 6.0]),
    ("quad_circles", [6.0, 10.0, 10.0]),
];
const RATIO_SIZES: [u32; 3] = [1_000, 10_000, 50_000];

/// The six problems.
const PROBLEMS: [&str; 6] = ["planar_quads", "cloth", "squares", "shell", "tets", "circles"];

/// libShapeOp 0.1.0 with tets at 50k, measured once on another machine: ms to initialise and per iteration.
const TETS_OF_LIBSHAPEOP: [f64; 2] = [47_998.0, 768.0];

/// The relative errors of the energy that [`Accelerated`] has evaluations for.
const ERRORS: [&str; 3] = ["1e-3", "1e-6", "1e-9"];

/// The method with its default memory, as the example calls it.
const DEFAULT_METHOD: &str = "quasi-Newton 5";

pub fn show(figures: &mut Figures, reuse: bool, repetitions: Option<usize>) -> Result<()> {
    let measurements = if reuse { bench::last()? } else { bench::measure_all(repetitions)? };
    println!("\n{}, measured on {}", measurements.machine, measurements.date);
    if let Some(reason) = &measurements.peer_missing {
        println!("compas-shapeop is missing: {}", reason.lines().next().unwrap_or_default());
    }
    beside_the_peer(figures, &measurements);
    floor(figures, &measurements);
    threads_and_size(figures, &measurements);
    acceleration(figures, &measurements);
    Ok(())
}

/// A figure that must reach its target, or "not measured".
fn at_least(figures: &mut Figures, name: &str, value: Option<f64>, target: f64) {
    match value {
        Some(value) => figures.at_least(name, value, target),
        None => figures.not_measured(name, &format!("at least {}", number(target))),
    }
}

fn at_most(figures: &mut Figures, name: &str, value: Option<f64>, target: f64) {
    match value {
        Some(value) => figures.at_most(name, value, target),
        None => figures.not_measured(name, &format!("at most {}", number(target))),
    }
}

fn beside_the_peer(figures: &mut Figures, measurements: &Measurements) {
    figures.group("compas-shapeop's time per iteration over this library's on two threads (on one thread)");
    for (problem, targets) in RATIOS {
        for (size, target) in RATIO_SIZES.into_iter().zip(targets) {
            let case = measurements.case(problem, size);
            let one = case.and_then(|case| case.ratio(0)).map_or("–".into(), |ratio| format!("{ratio:.1}"));
            let name = format!("{problem} {}k: times faster per iteration ({one})", size / 1000);
            at_least(figures, &name, case.and_then(|case| case.ratio(1)), target);
        }
    }
    figures.group("compas-shapeop's time to initialise over this library's, 50k");
    for problem in ["planar_quads", "cloth"] {
        let ratio = measurements.case(problem, 50_000).and_then(|case| case.init_ratio(1));
        at_least(figures, &format!("{problem} 50k: times faster to initialise"), ratio, 3.0);
    }
    figures.group("beyond libShapeOp");
    let circles = measurements.case("circles", 10_000).and_then(|case| case.two_threads.as_ref());
    figures.exactly("circles along every grid line: runs at 10k", usize::from(circles.is_some()), 1);
    if let Some(timing) = circles {
        figures.plain("circles 10k: ms to initialise", &number(timing.init_ms));
        figures.plain("circles 10k: ms per iteration", &number(timing.iteration_ms));
    }
    let tets = measurements.case("tets", 50_000).and_then(|case| case.two_threads.as_ref());
    let [init, iteration] = TETS_OF_LIBSHAPEOP;
    at_most(figures, "tets 50k: ms to initialise", tets.map(|timing| timing.init_ms), init);
    at_most(figures, "tets 50k: ms per iteration", tets.map(|timing| timing.iteration_ms), iteration);
}

fn floor(figures: &mut Figures, measurements: &Measurements) {
    figures.group("ms per iteration as a multiple of the floor, on two threads (on one thread)");
    for problem in PROBLEMS {
        for size in [10_000, 50_000] {
            let case = measurements.case(problem, size);
            let multiple = |threads| case.and_then(|case| case.floor_multiple(threads));
            let one = multiple(0).map_or("–".into(), |multiple| format!("{multiple:.1}"));
            let name = format!("{problem} {}k: multiple of the floor ({one})", size / 1000);
            match (problem, size, multiple(1)) {
                ("planar_quads" | "cloth", 50_000, value) => at_most(figures, &name, value, 3.0),
                (_, _, Some(value)) => figures.plain(&name, &number(value)),
                _ => figures.not_measured(&name, "a figure"),
            }
        }
    }
    let is_estimate = |case: &bench::measure::Case| case.bytes.as_ref().is_some_and(|bytes| bytes.factor_is_estimate);
    if measurements.cases.iter().any(is_estimate) {
        figures.plain("the bytes of the factors are", "estimated");
    }
}

fn threads_and_size(figures: &mut Figures, measurements: &Measurements) {
    figures.group("one thread's time per iteration over that of two, 50k");
    for problem in PROBLEMS {
        let speedup = measurements.case(problem, 50_000).and_then(|case| case.speedup());
        at_least(figures, &format!("{problem} 50k: two threads, times faster than one"), speedup, 1.5);
    }
    figures.group("planar_quads from 1k to 1M vertices");
    for (threads, words) in ["one thread", "two threads"].iter().enumerate() {
        let exponent = measurements.exponent(threads).filter(|(_, from, to)| (*from, *to) == (1_000, 1_000_000));
        let name = format!("planar_quads: exponent of the time per iteration, {words}");
        at_most(figures, &name, exponent.map(|(exponent, ..)| exponent), 1.15);
    }
    let largest = measurements.case("planar_quads", 1_000_000).and_then(|case| case.two_threads.as_ref()?.peak_mib);
    match largest {
        Some(mib) => figures.plain("peak memory at 1M, MiB", &format!("{mib:.0}")),
        None => figures.not_measured("peak memory at 1M, MiB", "a figure"),
    }
    figures.group("moving one handle, 5 iterations each, on two threads");
    let handle = measurements.handle.as_ref();
    if let Some(handle) = handle {
        figures.plain("vertices", &handle.vertices.to_string());
        figures.plain("auxiliary variables", &handle.auxiliary.to_string());
    }
    at_least(figures, "solves per second", handle.map(|handle| handle.solves_per_second), 60.0);
}

/// What `examples/acceleration.rs` prints of one way to solve one problem.
struct Accelerated {
    method: String,
    /// Evaluations and seconds to each of [`ERRORS`], then to the energy that the plain way ended at.
    reached: [Option<(f64, f64)>; 4],
}

fn acceleration(figures: &mut Figures, measurements: &Measurements) {
    figures.group("evaluations (and seconds) to a relative error of the energy, 10k");
    let mut planar = Vec::new();
    let mut squares = Vec::new();
    for problem in ["planar_quads", "cloth", "squares", "shell", "tets", "quad_circles"] {
        let runs = accelerated(problem);
        if runs.is_empty() {
            figures.not_measured(&format!("{problem}, plain and accelerated"), "a table");
            continue;
        }
        for run in &runs {
            for (error, reached) in ERRORS.iter().zip(&run.reached) {
                let text = reached.map_or("–".into(), |(evaluations, seconds)| format!("{evaluations} ({seconds})"));
                figures.plain(&format!("{problem}, {}: to {error}", run.method), &text);
            }
        }
        match problem {
            "planar_quads" => planar = runs,
            "squares" => squares = runs,
            _ => {}
        }
    }
    figures.group(&format!("acceleration with {DEFAULT_METHOD}, 10k"));
    // One method for all, chosen beforehand: the best of many would flatter.
    let with_default = |runs: &[Accelerated], which: usize| {
        runs.iter().find(|run| run.method == DEFAULT_METHOD).and_then(|run| run.reached[which])
    };
    let own = with_default(&planar, 1);
    at_most(figures, "planar_quads: evaluations to 1e-6", own.map(|own| own.0), 45.0);
    // The peer's iterates are those of the plain way, so it needs as many evaluations.
    let sooner = || {
        let case = measurements.case("planar_quads", 10_000)?;
        let (peer, ours) = (case.peer.as_ref()?, case.two_threads.as_ref()?);
        let evaluations = planar.iter().find(|run| run.method == "plain")?.reached[1]?.0;
        Some((peer.init_ms + evaluations * peer.iteration_ms) / (ours.init_ms + 1e3 * own?.1))
    };
    at_least(figures, "planar_quads: sooner at 1e-6 than compas-shapeop, times", sooner(), 80.0);
    at_most(
        figures,
        "squares: evaluations to plain's energy after 2000",
        with_default(&squares, 3).map(|reached| reached.0),
        80.0,
    );
}

/// Runs the example, if it is there, on one problem of 10k vertices on two threads, and reads its table.
fn accelerated(problem: &str) -> Vec<Accelerated> {
    if !shell::root().join("examples/acceleration.rs").is_file() {
        return Vec::new();
    }
    let arguments = ["run", "--quiet", "--release", "--example", "acceleration", "10000", "2", problem];
    let text = match shell::output(shell::cargo().args(arguments)) {
        Ok(text) => text,
        Err(error) => {
            println!("{error:#}");
            return Vec::new();
        }
    };
    let rows = text.lines().filter_map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        // | method | to 1e-3 | to 1e-6 | to 1e-9 | to plain's last | … |, each "45 / 0.123 s" or "–".
        let ["", method, first, second, third, last, ..] = cells[..] else { return None };
        let reached = |cell: &str| {
            let (evaluations, seconds) = cell.split_once(" / ")?;
            Some((evaluations.parse().ok()?, seconds.trim_end_matches(" s").parse().ok()?))
        };
        let run = Accelerated { method: method.to_owned(), reached: [first, second, third, last].map(reached) };
        run.reached.iter().any(Option::is_some).then_some(run)
    });
    rows.collect()
}
