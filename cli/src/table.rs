//! Tables and histograms for the terminal.

use crate::quality::Quality;
use crate::report::{Report, Violations};

/// Rows of cells, the first left-aligned, the others right-aligned; a column is as wide as its widest cell.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells =
            row.iter().zip(&widths).enumerate().map(|(i, (cell, &width))| {
                if i == 0 { format!("  {cell:<width$}") } else { format!("{cell:>width$}") }
            });
        cells.collect::<Vec<_>>().join("   ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A number with four significant digits.
pub fn number(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&magnitude) {
        format!("{value:.3e}")
    } else {
        let decimals = (3 - magnitude.log10().floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    }
}

/// A ratio in percent.
pub fn percent(ratio: f64) -> String {
    let value = 100.0 * ratio;
    match value.abs() {
        0.0 => "0 %".to_owned(),
        ..1e-3 => format!("{value:.1e} %"),
        ..10.0 => format!("{value:.3} %"),
        _ => format!("{value:.1} %"),
    }
}

/// What a run did, before and after.
pub fn of_report(report: &Report) -> String {
    let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<String>>();
    let mut rows = Vec::new();
    // Triangles are planar: a table of zeros would tell nothing.
    if let Some(quality) = report.quality.as_ref().filter(|quality| !quality.before.has_only_triangles) {
        let (before, after) = (&quality.before, &quality.after);
        let mut pair = |name: &str, show: &dyn Fn(&Quality) -> String| {
            rows.push(vec![name.to_owned(), show(before), show(after)]);
        };
        pair("", &|quality| if std::ptr::eq(quality, before) { "before".to_owned() } else { "after".to_owned() });
        pair("planarity, mean", &|quality| percent(quality.planarity.mean));
        pair("planarity, max", &|quality| percent(quality.planarity.max));
        pair(&format!("faces over {}", percent(report.limit)), &|quality| quality.faces_over_limit.to_string());
        pair("distance from face plane, max", &|quality| number(quality.plane_distance.max));
        match report.command.as_str() {
            "circularize" => pair("circularity, max", &|quality| percent(quality.circularity.max)),
            "regularize" => {
                pair("regularity, mean", &|quality| percent(quality.regularity.mean));
                pair("regularity, max", &|quality| percent(quality.regularity.max));
            }
            "equalize" => {
                pair("edge length, min", &|quality| number(quality.edge_length.min));
                pair("edge length, mean", &|quality| number(quality.edge_length.mean));
                pair("edge length, max", &|quality| number(quality.edge_length.max));
            }
            _ => {}
        }
    }
    if report.command == "solve" {
        if !rows.is_empty() {
            rows.push(Vec::new());
        }
        rows.push(["violation at the end", "mean", "max", "at constraint", "unit"].map(str::to_owned).to_vec());
        for (name, Violations { unit, spread }) in &report.violations {
            let place = spread.max_at.to_string();
            rows.push(vec![name.clone(), number(spread.mean), number(spread.max), place, (*unit).to_owned()]);
        }
    }
    let moved = &report.displacement;
    let relative =
        |share: Option<f64>| share.map_or(String::new(), |share| format!(" ({} of the mean edge)", percent(share)));
    let mut text = aligned(&rows);
    if !text.is_empty() {
        text.push_str("\n\n");
    }
    let energy = format!("{} -> {}", number(report.energy.before), number(report.energy.after));
    let mut lines = vec![row(&[if report.exploration.is_some() { "objective" } else { "energy" }, &energy])];
    if let Some(exploration) = &report.exploration {
        lines.push(row(&["violation", &exploration.violation_in_words()]));
    }
    lines.extend([
        row(&["moved, mean", &format!("{}{}", number(moved.absolute.mean), relative(moved.mean_over_mean_edge))]),
        row(&["moved, max", &format!("{}{}", number(moved.absolute.max), relative(moved.max_over_mean_edge))]),
        row(&["iterations", &report.iterations.to_string()]),
        row(&["seconds", &format!("{:.2}", report.seconds.total)]),
    ]);
    if let Some(adapter) = &report.backend.adapter {
        let of_card = report.backend.gpu_iterations;
        lines.push(row(&["on the card", &format!("{of_card} of {} iterations: {adapter}", report.iterations)]));
    }
    let lines: Vec<String> = lines.iter().map(|line| format!("  {:<12} {}", line[0], line[1])).collect();
    text + &lines.join("\n")
}

/// A histogram of `values` over `[low, high]`, one line per bin; what lies beyond counts in the last bin.
pub fn histogram(values: &[f64], low: f64, high: f64, bins: usize, show: &dyn Fn(f64) -> String) -> String {
    const WIDTH: usize = 44;
    let mut counts = vec![0_usize; bins];
    let span = if high > low { high - low } else { 1.0 };
    for value in values {
        let bin = ((value - low) / span * bins as f64).floor();
        counts[(bin.max(0.0) as usize).min(bins - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let is_beyond = values.iter().any(|value| *value > high * (1.0 + 1e-12));
    let rows: Vec<Vec<String>> = counts
        .iter()
        .enumerate()
        .map(|(i, &count)| {
            let at = |share: usize| show(low + span * share as f64 / bins as f64);
            let range = if i + 1 == bins && is_beyond {
                format!("{} or more", at(i))
            } else {
                format!("{} - {}", at(i), at(i + 1))
            };
            // Every face that is there is seen.
            let length = (count * WIDTH).div_ceil(most);
            vec![range, count.to_string(), format!("{:<WIDTH$}", "#".repeat(length))]
        })
        .collect();
    aligned(&rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let cases = [
            (0.0, "0"),
            (1.0, "1.000"),
            (1234.56, "1235"),
            (0.012346, "0.01235"),
            (1e-9, "1.000e-9"),
            (-2.5, "-2.500"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        assert_eq!((percent(0.01), percent(1e-7)), ("1.000 %".to_owned(), "1.0e-5 %".to_owned()));
    }

    #[test]
    fn a_histogram_counts_everything_once() {
        let text = histogram(&[0.0, 0.1, 0.6, 1.0, 7.0], 0.0, 1.0, 2, &|value| format!("{value}"));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].contains("0 - 0.5") && lines[0].contains(" 2 "));
        assert!(lines[1].contains("0.5 or more") && lines[1].contains(" 3 "));
        assert!(!histogram(&[], 0.0, 0.0, 3, &|value| format!("{value}")).contains('#'));
    }
}
