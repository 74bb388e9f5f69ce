//! The plot of convergence: energy and largest move over the iterations or time steps, on logarithmic axes.

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use shapeop::problem::Mode;

use crate::run::History;

/// Width and height of the plot in the units of its SVG.
const SIZE: (u32, u32) = (1280, 760);

/// The backend rounds coordinates to whole units: it draws so many times larger, and the view is shrunk.
const FINENESS: u32 = 4;

const ENERGY: RGBColor = RGBColor(0x85, 0x26, 0x73);
const MOVE: RGBColor = RGBColor(0x17, 0x43, 0x99);
const INK: RGBColor = RGBColor(0x1f, 0x24, 0x30);
const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xeb);

/// One curve, with what its axis says.
struct Curve<'a> {
    over: &'a str,
    axis: &'a str,
    values: Vec<f64>,
    colour: RGBColor,
    /// A level to mark, with its name.
    mark: Option<(f64, String)>,
}

/// The plot as SVG; `None` without two values to draw a line between. A static problem is plotted over its iterations, a
/// dynamic one over its time steps.
pub fn convergence(title: &str, history: &History, mode: Mode, tolerance: f64) -> Result<Option<String>> {
    let (over, energy, moves) = match mode {
        Mode::Static => ("iteration", history.energy.clone(), history.largest_move.clone()),
        Mode::Dynamic => {
            let (energy, moves) = history.steps.iter().copied().unzip();
            ("time step", energy, moves)
        }
    };
    if energy.len() < 2 {
        return Ok(None);
    }
    let least = energy.iter().copied().fold(f64::INFINITY, f64::min);
    // Forces can pull the energy below zero, where a logarithm cannot follow.
    let energy = if least > 0.0 {
        Curve { over, axis: "energy", values: energy, colour: ENERGY, mark: None }
    } else {
        let values = energy.iter().map(|energy| energy - least).collect();
        Curve { over, axis: "energy above its least", values, colour: ENERGY, mark: None }
    };
    // The tolerance bounds the moves of iterations, not those of time steps.
    let mark = (tolerance > 0.0 && mode == Mode::Static).then(|| (tolerance, format!("tolerance {tolerance:e}")));
    let largest_move = Curve { over, axis: "largest move / diagonal", values: moves, colour: MOVE, mark };
    let mut text = String::new();
    draw(&mut text, title, &[energy, largest_move]).map_err(|error| anyhow!("the plot could not be drawn: {error}"))?;
    let drawn = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    Ok(Some(text.replacen(&drawn, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1)))
}

fn draw(text: &mut String, title: &str, curves: &[Curve<'_>]) -> Result<(), Box<dyn std::error::Error>> {
    let fine = |size: u32| size * FINENESS;
    let font = |size: u32| ("Noto Sans", fine(size)).into_font();
    let root = SVGBackend::with_string(text, (fine(SIZE.0), fine(SIZE.1))).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.margin(fine(20), fine(12), fine(12), fine(20));
    root.draw(&Text::new(title.to_owned(), (fine(16) as i32, 0), font(22).style(FontStyle::Bold).color(&INK)))?;
    let root = root.margin(fine(40), 0, 0, 0);
    for (area, curve) in root.split_evenly((curves.len(), 1)).iter().zip(curves) {
        let positive = || curve.values.iter().copied().filter(|value| *value > 0.0 && value.is_finite());
        let marked = curve.mark.as_ref().map(|(level, _)| *level);
        let low = positive().chain(marked).fold(f64::INFINITY, f64::min);
        let high = positive().chain(marked).fold(f64::NEG_INFINITY, f64::max);
        // All zero: there is nothing to see, but the axes say so.
        let (low, high) = if low <= high { (low, high) } else { (1e-16, 1.0) };
        let range = (low * 0.7)..(high * 1.4).max(low * 10.0);
        let end = curve.values.len() as f64;
        let mut chart = ChartBuilder::on(area)
            .margin(fine(10))
            .set_label_area_size(LabelAreaPosition::Left, fine(86))
            .set_label_area_size(LabelAreaPosition::Bottom, fine(48))
            .build_cartesian_2d(1.0..end, range.log_scale())?;
        chart
            .configure_mesh()
            .x_desc(curve.over)
            .y_desc(curve.axis)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .y_labels(6)
            .set_all_tick_mark_size(fine(5))
            .axis_style(INK.stroke_width(FINENESS))
            .light_line_style(WHITE)
            .bold_line_style(GRID.stroke_width(FINENESS))
            .label_style(font(14).color(&INK))
            .axis_desc_style(font(16).color(&INK))
            .draw()?;
        if let Some((level, name)) = &curve.mark {
            let line = [(1.0, *level), (end, *level)];
            chart.draw_series(DashedLineSeries::new(line, fine(6), fine(5), INK.stroke_width(FINENESS)))?;
            // At the left: the curve comes down to it at the right.
            let at = (1.0 + 0.008 * (end - 1.0), *level * (high / low).powf(0.09));
            chart.draw_series([Text::new(name.clone(), at, font(14).color(&INK))])?;
        }
        let points = curve.values.iter().enumerate().filter(|(_, value)| **value > 0.0 && value.is_finite());
        let line = points.map(|(i, value)| ((i + 1) as f64, *value));
        chart.draw_series(LineSeries::new(line, curve.colour.stroke_width(2 * FINENESS)))?;
    }
    root.present()?;
    Ok(())
}
