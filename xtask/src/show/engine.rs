//! `cargo xtask show engine`.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;

use super::{Figures, number};
use crate::shell;

/// The quad meshes in `examples/meshes`, and the one of hexagons.
const QUADS: [&str; 6] =
    ["conical1", "costa_mesh_free2", "botanic-garden-bubble-0", "tubemesh", "hypar", "costa2k_poly"];
const HEXAGONS: &str = "hex_mesh_welded";

/// Reference trajectories in `tests/fixtures`.
const FIXTURES: usize = 149;

/// Random sequences of calls of the C functions.
const SEQUENCES: &str = "10000";

pub fn show(figures: &mut Figures) -> Result<()> {
    let out = shell::root().join("target/show");
    fs::create_dir_all(&out)?;
    let program = Program { out };

    figures.group("demo: a mesh, a report and two pictures");
    let report = program.run(&["demo"])?;
    let files = report["files"].as_object().context("the report names no files")?;
    let written = files.values().filter_map(Value::as_str).filter(|file| Path::new(file).is_file()).count();
    figures.exactly("files written", written, 4);
    figures.plain("planarity before, max", &percent(&report["quality"]["before"]["planarity"]["max"]));
    figures.plain("planarity after, max", &percent(&report["quality"]["after"]["planarity"]["max"]));

    figures.group("parity with libShapeOp 0.1.0: worst error over its tolerance");
    let text = shell::output(&mut super::test_command(&["--test", "parity"]))?;
    let mut count = 0;
    for words in text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>()) {
        if let ["parity", name, fixtures, "fixtures,", "worst", _, "of", "the", "diagonal,", worst, ..] = words[..] {
            count += fixtures.parse::<usize>()?;
            figures.at_most(&format!("{name}, {fixtures} fixtures"), worst.parse()?, 1.0);
        }
    }
    figures.exactly("fixtures", count, FIXTURES);

    figures.group("planarize as it is: plane weight 1, closeness 0.05");
    for mesh in QUADS {
        let report = program.planarize(mesh, &[])?;
        planarity(figures, mesh, &report);
        if mesh == "conical1" {
            let moved = &report["displacement"];
            figures.at_most("  stays put: largest move", float(&moved["absolute"]["max"])?, 1e-3);
            figures.at_most("  stays put: mean move / mean edge", float(&moved["mean_over_mean_edge"])?, 1e-4);
        }
    }

    figures.group("planarize with closeness 1e-5, at most 2000 plain iterations");
    let free = ["--closeness", "1e-5", "--iterations", "2000", "--tolerance", "0", "--acceleration", "none"];
    for mesh in ["hypar", "tubemesh", "costa_mesh_free2"] {
        let report = program.planarize(mesh, &free)?;
        planarity(figures, mesh, &report);
        let worst = float(&report["quality"]["after"]["planarity"]["max"])?;
        figures.at_most(&format!("  {mesh}: max planarity in %"), 100.0 * worst, 0.1);
    }
    let report = program.planarize(HEXAGONS, &free)?;
    let quality = &report["quality"];
    let edge = float(&quality["before"]["edge_length"]["mean"])?;
    let distance = float(&quality["after"]["plane_distance"]["max"])?;
    figures.at_most(&format!("{HEXAGONS}: distance from plane / mean edge"), distance / edge, 1e-3);

    figures.group("problem files: violation before and after, in % of the mean edge");
    for (name, measure) in [("circularize", "circularity"), ("regularize", "regularity")] {
        let report = program.run(&["solve", &format!("examples/{name}.json")])?;
        let [before, after] = ["before", "after"].map(|when| &report["quality"][when][measure]["max"]);
        figures.plain(&format!("{name}: worst before"), &percent(before));
        figures.at_most(&format!("{name}: worst after / before"), float(after)? / float(before)?, 1.0);
        picture(figures, name, &report);
    }
    let report = program.run(&["solve", "examples/hanging_cloth.json"])?;
    figures.plain("hanging_cloth: time steps", &report["steps"].to_string());
    let strain = float(&report["violations"]["EdgeStrain"]["spread"]["mean"])?;
    let edge = float(&report["quality"]["before"]["edge_length"]["mean"])?;
    figures.at_most("hanging_cloth, pulled far and let back: mean strain", strain / edge, 0.01);
    picture(figures, "hanging_cloth", &report);

    figures.group("a million vertices: planar quads and closeness, 10 iterations");
    let mut example = shell::cargo();
    example.args(["run", "--quiet", "--release", "--example", "million_vertices"]);
    for line in shell::output(&mut example)?.lines().filter(|line| !line.trim_start().starts_with("iteration")) {
        println!("  {line}");
    }

    figures.group("random sequences of C calls with random arguments");
    let text = shell::output(super::test_command(&["--test", "fuzz"]).env("SHAPEOP_FUZZ_SEQUENCES", SEQUENCES))?;
    let count = text.lines().filter(|line| line.contains("sequences")).inspect(|line| println!("  {line}")).count();
    figures.exactly("no crash, no point that is not finite", count.min(1), 1);
    Ok(())
}

/// The command line as built for release.
struct Program {
    out: PathBuf,
}

impl Program {
    /// Runs a command and returns its report.
    fn run(&self, arguments: &[&str]) -> Result<Value> {
        let mut command = shell::cargo();
        command.args(["run", "--quiet", "--release", "--"]).args(arguments).args(["--json", "--out"]).arg(&self.out);
        let text = shell::output(&mut command)?;
        serde_json::from_str(&text).with_context(|| format!("{arguments:?} printed no report"))
    }

    fn planarize(&self, mesh: &str, arguments: &[&str]) -> Result<Value> {
        let file = format!("examples/meshes/{mesh}.obj");
        self.run(&[&["planarize", &file], arguments].concat())
    }
}

fn planarity(figures: &mut Figures, mesh: &str, report: &Value) {
    let [before, after] = ["before", "after"].map(|when| {
        let planarity = &report["quality"][when]["planarity"];
        format!("{} / {}", percent(&planarity["mean"]), percent(&planarity["max"]))
    });
    let moved = &report["displacement"];
    let [mean, most] = ["mean_over_mean_edge", "max_over_mean_edge"].map(|name| percent(&moved[name]));
    let seconds = report["seconds"]["total"].as_f64().map_or_else(String::new, number);
    let iterations = &report["iterations"];
    figures.plain(&format!("{mesh}: planarity mean / max before"), &before);
    figures.plain("  after", &after);
    figures.plain("  moved, mean / max of the mean edge", &format!("{mean} / {most}"));
    figures.plain("  iterations, seconds", &format!("{iterations}, {seconds}"));
}

fn picture(figures: &mut Figures, name: &str, report: &Value) {
    let is_there = report["files"]["picture"].as_str().is_some_and(|file| Path::new(file).is_file());
    figures.exactly(&format!("{name}: picture"), usize::from(is_there), 1);
}

fn percent(value: &Value) -> String {
    value.as_f64().map_or_else(|| "-".to_owned(), |value| format!("{:.4} %", 100.0 * value))
}

fn float(value: &Value) -> Result<f64> {
    value.as_f64().with_context(|| format!("expected a number, found {value}"))
}
