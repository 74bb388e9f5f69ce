//! `docs/benchmarks.md`, and the table in `docs/acceleration.md`.

use anyhow::{Context, Result};

use super::energies::{ERRORS, Energies, Problem, name};
use super::measure::{Case, Measurements, Timing};

/// The page.
pub fn page(measurements: &Measurements) -> String {
    let mut page = String::from(
        "# Benchmarks\n\n`cargo xtask bench` measures all of this and writes this page; `cargo xtask show speed` holds it \
         to its targets.\n`cargo bench --bench kernels` times single projections.\n\n",
    );
    page += &format!("Measured on {}: {}.\n", measurements.date, measurements.machine);
    if measurements.profile != "release" {
        page += &format!("\n**Built with the profile `{}`: the times mean nothing.**\n", measurements.profile);
    }
    page += "\n![Time per iteration over the number of vertices](images/scaling.svg)\n";
    beside_the_peer(&mut page, measurements);
    all_problems(&mut page, measurements);
    floor(&mut page, measurements);
    scaling(&mut page, measurements);
    how(&mut page, measurements);
    page.lines().map(wrapped).collect()
}

/// The width of the pages in `docs`.
const WIDTH: usize = 128;

/// The line in as many lines as it needs; tables and code stay as they are.
fn wrapped(line: &str) -> String {
    let indent = if line.starts_with("- ") { "  " } else { "" };
    if line.starts_with('|') || line.starts_with("cargo ") {
        return format!("{line}\n");
    }
    let (mut text, mut width) = (String::new(), 0);
    for word in line.split(' ') {
        let length = word.chars().count();
        if width > 0 && width + 1 + length > WIDTH {
            text += "\n";
            text += indent;
            width = indent.len();
        } else if width > 0 {
            text += " ";
            width += 1;
        }
        text += word;
        width += length;
    }
    text + "\n"
}

fn beside_the_peer(page: &mut String, measurements: &Measurements) {
    *page += "\n## Beside compas-shapeop 0.1.2\n\n";
    if let Some(reason) = &measurements.peer_missing {
        let line = reason.lines().next().unwrap_or_default();
        *page += &format!("compas-shapeop was not to be had: {line}.\n");
        return;
    }
    *page += "compas-shapeop is libShapeOp's C++ core with Python bindings, and runs on one thread. *Times* is its time over \
              this library's.\n\n\
              | problem | vertices | compas-shapeop, ms per iteration | one thread | times | two threads | times | \
              compas-shapeop, ms to initialise | this library | times | points differ by |\n\
              |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for case in measurements.cases.iter().filter(|case| case.peer.is_some()) {
        let cells = [
            cell(case.peer.as_ref().map(|timing| timing.iteration_ms), ""),
            iteration(&case.one_thread),
            cell(case.ratio(0), ""),
            iteration(&case.two_threads),
            cell(case.ratio(1), ""),
            cell(case.peer.as_ref().map(|timing| timing.init_ms), ""),
            cell(case.two_threads.as_ref().map(|timing| timing.init_ms), ""),
            cell(case.init_ratio(1), ""),
            case.difference.map_or("–".into(), |difference| format!("{difference:.0e}")),
        ];
        *page += &row(case, &cells);
    }
    *page += "\n*Points differ by*: the largest distance between the points of both libraries after the same iterations from \
              the same model, over the diagonal of the model. In cloth it is nearly flat hinges \
              that differ. Quads of quad_circles have size 1, because libShapeOp takes small ones for straight, by an absolute \
              threshold, and only planarises them.\n";
}

fn all_problems(page: &mut String, measurements: &Measurements) {
    *page += "\n## All problems\n\n\
              | problem | vertices | ms to initialise | ms per iteration, one thread | two threads | one over two | \
              peak memory, MiB |\n|---|--:|--:|--:|--:|--:|--:|\n";
    for case in &measurements.cases {
        let cells = [
            cell(case.two_threads.as_ref().map(|timing| timing.init_ms), ""),
            iteration(&case.one_thread),
            iteration(&case.two_threads),
            cell(case.speedup(), ""),
            cell(case.two_threads.as_ref().and_then(|timing| timing.peak_mib), ""),
        ];
        *page += &row(case, &cells);
    }
    for case in measurements.cases.iter().filter(|case| !case.notes.is_empty()) {
        *page += &format!("\n{} at {} vertices: {}.\n", case.problem, case.size, case.notes.join("; "));
    }
    *page += "\nplanar_quads: Plane per quad, Closeness 0.05 per vertex. cloth (dynamic): EdgeStrain per edge, Bending 0.01 per \
              inner edge, three anchors, gravity. squares: Similarity to a square per quad, four anchors. quad_circles: Circle \
              per quad, Closeness 0.05 per vertex. shell (dynamic): EdgeStrain, Plane, Angle 80 to 110°, \
              LaplacianDisplacement, anchors, gravity upwards. tets: TetrahedronStrain and Volume per tetrahedron, two faces \
              pulled. circles: as quad_circles, and a Circle along every line of the grid, which libShapeOp has no memory for \
              beyond a few thousand vertices.\n";
}

fn floor(page: &mut String, measurements: &Measurements) {
    *page += "\n## How far from the floor\n\n\
              An iteration must at least stream its data from memory, as it is stored: the factor twice (values and row indices), and \
              right-hand sides, points, projections, and the constraints' indices, scalars, rest states and coefficients once. The floor is \
              these bytes over the rate at which as many threads read an array as large as the factor, measured in turns with \
              the iterations. Where that array fits a cache, the rate is the cache's, \
              and values arrive faster than they can be multiplied: then arithmetic takes longer than the floor.\n\n\
              | problem | vertices | factor, MB | the rest, MB | GB/s, one thread | two | floor, ms, one thread | two | \
              multiple, one thread | two |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for case in &measurements.cases {
        let Some(bytes) = &case.bytes else { continue };
        let rate = |i: usize| case.bandwidth.map(|rates| 1e-9 * rates[i]);
        let cells = [
            cell(Some(1e-6 * bytes.factor), ""),
            cell(Some(1e-6 * (bytes.total() - 2.0 * bytes.factor)), ""),
            cell(rate(0), ""),
            cell(rate(1), ""),
            cell(case.floor_ms(0), ""),
            cell(case.floor_ms(1), ""),
            cell(case.floor_multiple(0), ""),
            cell(case.floor_multiple(1), ""),
        ];
        *page += &row(case, &cells);
    }
}

fn scaling(page: &mut String, measurements: &Measurements) {
    *page += "\n## Growth, and one handle\n\n";
    for (threads, words) in ["one thread", "two threads"].iter().enumerate() {
        if let Some((exponent, from, to)) = measurements.exponent(threads) {
            *page += &format!(
                "- planar_quads from {from} to {to} vertices on {words}: the time per iteration grows with the power {exponent:.2} \
                 of the vertices (least squares over all sizes).\n"
            );
        }
    }
    let largest = measurements.cases.iter().max_by_key(|case| case.vertices);
    if let Some((case, peak)) = largest.and_then(|case| Some((case, case.two_threads.as_ref()?.peak_mib?))) {
        *page += &format!("- {} at {} vertices: peak memory {} MiB.\n", case.problem, case.vertices, figure(peak));
    }
    if let Some(handle) = &measurements.handle {
        *page += &format!(
            "- Moving one handle on {} vertices with {} auxiliary variables (planes and closeness), 5 iterations each on two \
             threads: {:.0} solves per second, from setting the target to having read the points.\n",
            handle.vertices, handle.auxiliary, handle.solves_per_second
        );
    }
}

/// What is around the measurements in `docs/acceleration.md`.
const MARKS: [&str; 2] = ["<!-- `cargo xtask bench` writes from here -->\n", "<!-- to here -->\n"];

/// `text` with `part` between the marks.
pub fn replaced(text: &str, part: &str) -> Result<String> {
    let (before, rest) = text.split_once(MARKS[0]).context("the first mark is missing")?;
    let (_, after) = rest.split_once(MARKS[1]).context("the second mark is missing")?;
    Ok([before, MARKS[0], "\n", part, "\n", MARKS[1], after].concat())
}

/// The plot and the table of energies.
pub fn energies(energies: &Energies) -> String {
    let mut part = format!(
        "Measured on {}, two threads: {}.\n\n\
         ![Relative error of the energy over evaluations](images/energy.svg)\n\n\
         | problem | vertices | method | to 1e-3 | to 1e-6 | to 1e-9 | to plain's end | left at the default stop |\n\
         |---|--:|---|--:|--:|--:|--:|--:|\n",
        energies.date, energies.machine
    );
    for problem in &energies.problems {
        for curve in &problem.curves {
            let cell = |reached: Option<(u32, f64)>| {
                reached.map_or("–".into(), |(evaluations, seconds)| format!("{evaluations} / {} s", figure(seconds)))
            };
            let errors = ERRORS.map(|error| cell(problem.reached(curve, error))).join(" | ");
            let left = curve.default_stop.map_or("–".into(), |stop| {
                format!("{:.0e} after {}", problem.errors(curve)[stop], curve.evaluations[stop])
            });
            part += &format!(
                "| {} | {} | {} | {errors} | {} | {left} |\n",
                problem.name,
                problem.vertices,
                name(&curve.method),
                cell(problem.reached_plain_end(curve))
            );
        }
    }
    for problem in &energies.problems {
        part += &beside_the_peer_to_an_error(problem).unwrap_or_default();
    }
    part.lines().map(wrapped).collect()
}

/// A sentence, where the peer was measured.
fn beside_the_peer_to_an_error(problem: &Problem) -> Option<String> {
    let peer = problem.peer.as_ref()?;
    let ours = problem.curves.iter().filter_map(|curve| {
        let [total_ms, times] = [problem.total_ms(curve)?, problem.times_sooner(curve)?].map(figure);
        Some(format!("{} {total_ms} ms, {times} times sooner", name(&curve.method)))
    });
    Some(format!(
        "\n{} to 1e-6, initialisation counted: compas-shapeop {} ms with {} iterations; {}.\n",
        problem.name,
        figure(peer.total_ms),
        peer.iterations,
        ours.collect::<Vec<_>>().join("; ")
    ))
}

/// What repeats the measurements.
const COMMANDS: &str = "cargo xtask bench                                      # all, and this page
cargo xtask bench --sizes 10000 --problems squares     # some of it, printed only
cargo xtask bench --energies                           # only the part of acceleration.md
cargo xtask show speed --reuse                         # the last measurements beside the targets";

fn how(page: &mut String, measurements: &Measurements) {
    *page += &format!(
        "\n## How it was measured\n\n\
         - Every run is a process of its own. The runs take turns: this library on one thread, on two, the other library; \
         repetitions: {}, from 100 000 vertices {}. The tables show medians.\n\
         - A run initialises, makes three iterations that do not count, then five equal groups of iterations, whose median \
         counts: 1000 iterations in all up to 5 000 vertices (new threads take some milliseconds to spread over the cores), then \
         50, 20 and 10. Dynamic problems make one time step per group.\n\
         - Both libraries get the same points, indices, weights and scalars to the last bit, in a file. The time in compas-shapeop \
         is that of its compiled `initialize` and `solve`, without its Python layer.\n\
         - For squares, compas-shapeop makes the shape of each quad from the quad; as scaling is allowed, it stands for the same \
         constraint.\n\
         - Small problems fit the caches, and a busy machine disturbs two threads more than one: the slowest of the repetitions of \
         this library took {} times as long as the fastest.\n\n\
         To repeat it, with Python 3 for compas-shapeop:\n\n```sh\n{COMMANDS}\n```\n",
        measurements.repetitions,
        measurements.repetitions.div_ceil(2),
        figure(spread(measurements)),
    );
}

/// The largest slowest over fastest repetition.
fn spread(measurements: &Measurements) -> f64 {
    let timings = measurements.cases.iter().flat_map(|case| [&case.one_thread, &case.two_threads]).flatten();
    timings.map(|Timing { iteration_range_ms: [least, most], .. }| most / least).fold(1.0, f64::max)
}

fn row(case: &Case, cells: &[String]) -> String {
    let vertices = if case.vertices > 0 { case.vertices } else { u64::from(case.size) };
    format!("| {} | {vertices} | {} |\n", case.problem, cells.join(" | "))
}

fn iteration(timing: &Option<Timing>) -> String {
    cell(timing.as_ref().map(|timing| timing.iteration_ms), "")
}

fn cell(value: Option<f64>, mark: &str) -> String {
    value.map_or("–".into(), |value| figure(value) + mark)
}

/// Three digits.
fn figure(value: f64) -> String {
    let digits = 2 - value.abs().max(1e-3).log10().floor() as i32;
    format!("{value:.*}", digits.clamp(0, 5) as usize)
}
