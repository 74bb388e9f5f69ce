//! The plot of Fig. 12: distance from the solution over time, this library and IPOPT, a panel per problem.

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::figure12::{Course, Runs};
use crate::bench::plot::{Drawn, FINENESS, GRID, INK, SIZE, fine, font, svg};

/// Seconds and distances that are shown.
const SECONDS: std::ops::Range<f64> = 1e-3..10.0;
const DISTANCES: std::ops::Range<f64> = 1e-10..2.0;

/// Names and colours.
const OWN: (&str, RGBColor) = ("this library", RGBColor(0x17, 0x43, 0x99));
const PEER: (&str, RGBColor) = ("IPOPT with MUMPS", RGBColor(0xe0, 0x8a, 0x1e));

/// The plot as SVG: of each solver the run of median length.
pub fn distances(problems: &[(u32, Runs, Runs)]) -> Result<String> {
    svg(&|text| draw(text, problems))
}

fn draw(text: &mut String, problems: &[(u32, Runs, Runs)]) -> Drawn {
    let root = SVGBackend::with_string(text, (fine(SIZE.0), fine(SIZE.1))).into_drawing_area();
    root.fill(&WHITE)?;
    let (top, panels) = root.split_vertically(fine(64));
    let at = |x: u32, y: u32| (fine(x) as i32, fine(y) as i32);
    let title = "Fig. 12: distance from the solution over that of the start, after so many seconds";
    top.draw(&Text::new(title, at(16, 10), font(18).color(&INK)))?;
    for (i, (name, colour)) in [OWN, PEER].into_iter().enumerate() {
        let x = 20 + 180 * i as u32;
        top.draw(&PathElement::new([at(x, 47), at(x + 30, 47)], colour.stroke_width(fine(2))))?;
        top.draw(&Text::new(name, at(x + 38, 39), font(15).color(&INK)))?;
    }
    let words = "dots: sweeps, iterations; the last of this library: the end of its Newton steps";
    top.draw(&Text::new(words, at(400, 39), font(15).color(&INK)))?;
    for ((n, own, peer), panel) in problems.iter().zip(panels.split_evenly((1, problems.len().max(1)))) {
        draw_panel(&panel, *n, own, peer)?;
    }
    root.present()?;
    Ok(())
}

/// The run of median length.
fn typical(runs: &Runs) -> Option<&Course> {
    let mut all: Vec<&Course> = runs.0.iter().collect();
    let length = |course: &Course| course.iterations.last().map_or(0.0, |last| last.seconds);
    all.sort_by(|a, b| length(a).total_cmp(&length(b)));
    all.get(all.len() / 2).copied()
}

fn draw_panel(panel: &DrawingArea<SVGBackend<'_>, Shift>, n: u32, own: &Runs, peer: &Runs) -> Drawn {
    let mut chart = ChartBuilder::on(panel)
        .margin(fine(10))
        .margin_right(fine(24))
        .caption(format!("{n} × {n} points"), font(15).color(&INK))
        .set_label_area_size(LabelAreaPosition::Left, fine(56))
        .set_label_area_size(LabelAreaPosition::Bottom, fine(44))
        .build_cartesian_2d(SECONDS.log_scale(), DISTANCES.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("seconds")
        .y_desc("δ")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .set_all_tick_mark_size(fine(4))
        .axis_style(INK.stroke_width(FINENESS))
        .light_line_style(WHITE)
        .bold_line_style(GRID.stroke_width(FINENESS))
        .label_style(font(12).color(&INK))
        .axis_desc_style(font(14).color(&INK))
        .draw()?;
    for (runs, (_, colour)) in [(peer, PEER), (own, OWN)] {
        let Some(course) = typical(runs) else { continue };
        let points: Vec<(f64, f64)> = course.iterations.iter().map(|at| (at.seconds, at.delta)).collect();
        chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(fine(2))))?;
        chart.draw_series(points.iter().map(|at| Circle::new(*at, fine(2), colour.filled())))?;
    }
    Ok(())
}
