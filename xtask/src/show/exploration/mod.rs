//! `cargo xtask show exploration`. What the program `cli/benches/exploration` measures, and what tests print.

mod figure12;
mod plot;

use anyhow::{Context, Result};

use super::Figures;
use super::program::Program;
use crate::shell;

/// Types whose projections are new, each against a multi-start optimiser, and its cases.
const PROJECTIONS: usize = 8;
const CASES: f64 = 200.0;

/// Planted contradictions, and problems that have none.
const CONTRADICTIONS: usize = 10;
const SWEEPS: f64 = 300.0;

/// Of coordinates, in sizes of the model.
const BOUND: f64 = 4.0;

pub fn show(figures: &mut Figures) -> Result<()> {
    let program = Program::build("exploration")?;
    projections(figures)?;
    program.show(figures, &["costa"])?;
    let images = shell::root().join("docs/images/exploration");
    figure12::show(figures, &program, &images)?;
    program.show(figures, &["figures", &images.to_string_lossy()])?;
    program.show(figures, &["drag"])?;
    contradictions(figures)?;
    program.show(figures, &["sensitivities"])
}

fn projections(figures: &mut Figures) -> Result<()> {
    figures.group("projections against a multi-start optimiser: worst relative excess of the distance");
    let text = test_output(&["--lib", "oracle"])?;
    let mut count = 0;
    for words in lines_with(&text, "projection ") {
        if let [name, cases, "cases,", "worst", "relative", "excess", excess] = words[..] {
            count += usize::from(cases.parse::<f64>()? >= CASES);
            figures.at_most(&format!("{} {cases} cases", name.replace(':', ",")), excess.parse()?, 1e-6);
        }
    }
    figures.exactly(&format!("types with at least {CASES} cases"), count, PROJECTIONS);
    let degenerate: Vec<_> = lines_with(&text, "degenerate ").collect();
    degenerate.iter().for_each(|words| figures.says(&format!("degenerate {}", words.join(" "))));
    let finite = degenerate.iter().filter(|words| words.ends_with(&["all", "finite"])).count();
    figures.exactly("lists of degenerate cases, all finite", finite, degenerate.len().max(PROJECTIONS));
    Ok(())
}

fn contradictions(figures: &mut Figures) -> Result<()> {
    figures.group("contradictions: planted sets named, iterates bounded; problems without any");
    let text = test_output(&["--test", "contradictions"])?;
    let (mut planted_count, mut named, mut sweeps, mut farthest) = (0_u32, 0, 0.0_f64, 0.0_f64);
    for words in lines_with(&text, "infeasible ") {
        planted_count += 1;
        figures.says(&words.join(" "));
        if let [
            ..,
            "named",
            found,
            "of",
            planted,
            "exactly,",
            count,
            "sweeps,",
            "largest",
            "coordinate",
            size,
            "sizes",
        ] = words[..]
        {
            named += usize::from(found == planted);
            sweeps = sweeps.max(count.parse()?);
            farthest = farthest.max(size.parse()?);
        }
    }
    figures.at_least("problems with a planted set", f64::from(planted_count), CONTRADICTIONS as f64);
    figures.exactly("planted sets named exactly", named, planted_count as usize);
    figures.at_most("sweeps until the last was recognised", sweeps, SWEEPS);
    figures.at_most("largest coordinate over the model's size", farthest, BOUND);
    let (mut calm, mut worst) = (0, 0.0_f64);
    for words in lines_with(&text, "feasible ") {
        figures.says(&words.join(" "));
        if let [.., "no", "conflict,", "largest", "violation", violation] = words[..] {
            calm += 1;
            worst = worst.max(violation.parse()?);
        }
    }
    figures.exactly("problems without conflict", calm, CONTRADICTIONS);
    figures.at_most("their largest violation", worst, 1e-9);
    Ok(())
}

/// What a test of the library prints, passed or not: the figures say what is short.
fn test_output(which: &[&str]) -> Result<String> {
    let output = super::test_command(which).output().context("Cargo could not be started")?;
    if !output.status.success() {
        eprintln!("{}", String::from_utf8_lossy(&output.stderr));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The words behind `head`, up to a semicolon, in every line that begins with it or with the dots of tests that passed.
fn lines_with<'a>(text: &'a str, head: &'a str) -> impl Iterator<Item = Vec<&'a str>> {
    let behind = move |line: &'a str| {
        let rest = line.trim_start_matches('.').strip_prefix(head);
        rest.map(|rest| rest.split(';').next().unwrap_or_default().split_whitespace().collect())
    };
    text.lines().filter_map(behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_behind_dots_and_end_at_a_semicolon() {
        let text =
            "running 2 tests\n.infeasible grid: named 1 of 1 exactly; more\nfeasible hypar: no conflict\nprojection";
        let words = |head| lines_with(text, head).map(|words| words.join(" ")).collect::<Vec<_>>();
        assert_eq!(words("infeasible "), ["grid: named 1 of 1 exactly"]);
        assert_eq!(words("feasible "), ["hypar: no conflict"]);
        assert!(words("projection ").is_empty());
    }
}
