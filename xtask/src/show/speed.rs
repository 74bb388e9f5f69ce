//! `cargo xtask show speed`.

use anyhow::Result;

use super::{Figures, number};
use crate::bench::energies::{self, ERRORS, Energies};
use crate::bench::{self, measure::Measurements};

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

/// What acceleration is by default.
const DEFAULT_METHOD: &str = "quasi-newton";

pub fn show(figures: &mut Figures, reuse: bool, repetitions: Option<usize>) -> Result<()> {
    let (measurements, energies) = if reuse { bench::last()? } else { bench::measure_all(repetitions)? };
    println!("\n{}, measured on {}", measurements.machine, measurements.date);
    if let Some(reason) = &measurements.peer_missing {
        println!("compas-shapeop is missing: {}", reason.lines().next().unwrap_or_default());
    }
    beside_the_peer(figures, &measurements);
    floor(figures, &measurements);
    threads_and_size(figures, &measurements);
    acceleration(figures, &energies);
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
    if let Some(tets) = measurements.case("tets", 50_000).and_then(|case| case.two_threads.as_ref()) {
        let ours = [tets.init_ms, tets.iteration_ms];
        let words = ["to initialise", "per iteration"];
        for ((words, ours), other) in words.iter().zip(ours).zip(TETS_OF_LIBSHAPEOP) {
            figures.plain(&format!("tets 50k: ms {words}"), &number(ours));
            figures.plain(&format!("tets 50k: ms {words}, libShapeOp on another machine"), &number(other));
        }
    }
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

fn acceleration(figures: &mut Figures, energies: &Energies) {
    figures.group("evaluations (and seconds) to a relative error of the energy, 10k, on two threads");
    for name in PROBLEMS {
        let Some(problem) = energies.problem(name) else {
            figures.not_measured(&format!("{name}, plain and accelerated"), "a table");
            continue;
        };
        for (curve, error) in problem.curves.iter().flat_map(|curve| ERRORS.map(|error| (curve, error))) {
            let text = match problem.reached(curve, error) {
                Some((evaluations, seconds)) => format!("{evaluations} ({seconds:.3})"),
                None => "–".into(),
            };
            figures.plain(&format!("{name}, {}: to {error:e}", energies::name(&curve.method)), &text);
        }
    }
    figures.group(&format!("acceleration with {DEFAULT_METHOD}, 10k"));
    // One method for all, chosen beforehand: the best of many would flatter.
    let with_default =
        |name: &str| energies.problem(name).and_then(|problem| Some((problem, problem.curve(DEFAULT_METHOD)?)));
    let planar = with_default("planar_quads");
    let evaluations = planar.and_then(|(problem, curve)| problem.reached(curve, 1e-6));
    at_most(figures, "planar_quads: evaluations to 1e-6", evaluations.map(|(count, _)| f64::from(count)), 45.0);
    if let Some((problem, curve)) = planar {
        let ms = [problem.peer.as_ref().map(|peer| peer.total_ms), problem.total_ms(curve)];
        for (who, ms) in ["compas-shapeop", "this library"].iter().zip(ms) {
            let ms = ms.map_or("–".into(), |ms| format!("{ms:.1}"));
            figures.plain(&format!("planar_quads: ms to initialise and reach 1e-6, {who}"), &ms);
        }
    }
    let sooner = planar.and_then(|(problem, curve)| problem.times_sooner(curve));
    at_least(figures, "planar_quads: sooner at 1e-6 than compas-shapeop, times", sooner, 80.0);
    let evaluations = with_default("squares").and_then(|(problem, curve)| problem.reached_plain_end(curve));
    at_most(
        figures,
        "squares: evaluations to plain's energy after 2000",
        evaluations.map(|(count, _)| f64::from(count)),
        80.0,
    );
}
