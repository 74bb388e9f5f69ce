//! Plots on logarithmic axes: energy and largest move over the iterations or time steps; the distance from the final shape over
//! time.

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use shapeop::problem::Mode;

use crate::run::History;

/// Width and height of the plot in the units of its SVG.
const SIZE: (u32, u32) = (1280, 760);

/// The same for one curve.
const HALF_SIZE: (u32, u32) = (1280, 480);

/// Distances, over that at the start, which rounding alone leaves.
const ROUNDING: f64 = 1e-13;

/// The backend rounds coordinates to whole units: it draws so many times larger, and the view is shrunk.
const FINENESS: u32 = 4;

const ENERGY: RGBColor = RGBColor(0x85, 0x26, 0x73);
const MOVE: RGBColor = RGBColor(0x17, 0x43, 0x99);
const INK: RGBColor = RGBColor(0x1f, 0x24, 0x30);
const BEGIN: RGBColor = RGBColor(0xa9, 0xb0, 0xbb);
const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xeb);

/// One curve, with what its axis says.
struct Curve<'a> {
    over: &'a str,
    axis: &'a str,
    points: Vec<(f64, f64)>,
    colour: RGBColor,
    /// A level to mark, with its name.
    mark: Option<(f64, String)>,
    /// Places on the horizontal axis to mark.
    begins: Vec<f64>,
}

impl<'a> Curve<'a> {
    /// Over the numbers from 1.
    fn counted(over: &'a str, axis: &'a str, values: &[f64], colour: RGBColor) -> Self {
        let points = values.iter().enumerate().map(|(i, value)| ((i + 1) as f64, *value)).collect();
        Self { over, axis, points, colour, mark: None, begins: Vec::new() }
    }
}

/// The plot as SVG; `None` without two values to draw a line between. A static problem is plotted over its iterations, a
/// dynamic one over its time steps. `measure` is what the history has as energy.
pub fn convergence(
    title: &str,
    history: &History,
    mode: Mode,
    measure: Measure,
    tolerance: f64,
) -> Result<Option<String>> {
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
    let energy = match measure {
        Measure::Residual => Curve::counted(over, "residual of the sweeps", &energy, ENERGY),
        Measure::Energy if least > 0.0 => Curve::counted(over, "energy", &energy, ENERGY),
        // Forces can pull the energy below zero, where a logarithm cannot follow.
        Measure::Energy => {
            let above: Vec<f64> = energy.iter().map(|energy| energy - least).collect();
            Curve::counted(over, "energy above its least", &above, ENERGY)
        }
    };
    // The tolerance bounds the moves of iterations, not those of time steps, and explorations end by Newton steps.
    let is_bounded = tolerance > 0.0 && mode == Mode::Static && measure == Measure::Energy;
    let mark = is_bounded.then(|| (tolerance, format!("tolerance {tolerance:e}")));
    let largest_move = Curve { mark, ..Curve::counted(over, "largest move / diagonal", &moves, MOVE) };
    to_svg(title, SIZE, &[energy, largest_move]).map(Some)
}

/// What a history has as energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    Energy,
    /// How far the sweeps of an exploration are from agreeing.
    Residual,
}

/// The distance from the final shape over that at the start, over seconds; `begins` are the beginnings of frames. `None` without
/// two values above 0.
pub fn distance(title: &str, distances: &[(f64, f64)], begins: &[f64]) -> Result<Option<String>> {
    // At the end the distance is 0, or what rounding leaves, and says nothing but that it is the end.
    let points: Vec<(f64, f64)> = distances.iter().copied().filter(|(_, distance)| *distance > ROUNDING).collect();
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Ok(None) };
    if last.0 <= first.0 {
        return Ok(None);
    }
    let begins = begins.iter().copied().filter(|begin| *begin <= last.0).collect();
    let axis = "δ: distance from the final shape / at the start";
    let curve =
        Curve { over: "seconds of solving (grey: a frame begins)", axis, points, colour: ENERGY, mark: None, begins };
    to_svg(title, HALF_SIZE, &[curve]).map(Some)
}

fn to_svg(title: &str, size: (u32, u32), curves: &[Curve<'_>]) -> Result<String> {
    let mut text = String::new();
    draw(&mut text, title, size, curves).map_err(|error| anyhow!("the plot could not be drawn: {error}"))?;
    let drawn = format!("width=\"{}\" height=\"{}\"", size.0 * FINENESS, size.1 * FINENESS);
    Ok(text.replacen(&drawn, &format!("width=\"{}\" height=\"{}\"", size.0, size.1), 1))
}

fn draw(
    text: &mut String,
    title: &str,
    size: (u32, u32),
    curves: &[Curve<'_>],
) -> Result<(), Box<dyn std::error::Error>> {
    let fine = |size: u32| size * FINENESS;
    let font = |size: u32| ("Noto Sans", fine(size)).into_font();
    let root = SVGBackend::with_string(text, (fine(size.0), fine(size.1))).into_drawing_area();
    root.fill(&WHITE)?;
    let root = root.margin(fine(20), fine(12), fine(12), fine(20));
    root.draw(&Text::new(title.to_owned(), (fine(16) as i32, 0), font(22).style(FontStyle::Bold).color(&INK)))?;
    let root = root.margin(fine(40), 0, 0, 0);
    for (area, curve) in root.split_evenly((curves.len(), 1)).iter().zip(curves) {
        let positive =
            || curve.points.iter().map(|(_, value)| *value).filter(|value| *value > 0.0 && value.is_finite());
        let marked = curve.mark.as_ref().map(|(level, _)| *level);
        let low = positive().chain(marked).fold(f64::INFINITY, f64::min);
        let high = positive().chain(marked).fold(f64::NEG_INFINITY, f64::max);
        // All zero: there is nothing to see, but the axes say so.
        let (low, high) = if low <= high { (low, high) } else { (1e-16, 1.0) };
        let range = (low * 0.7)..(high * 1.4).max(low * 10.0);
        let (start, end) = match (curve.points.first(), curve.points.last()) {
            (Some(first), Some(last)) if last.0 > first.0 => (first.0, last.0),
            _ => (0.0, 1.0),
        };
        let is_counted = curve.points.iter().all(|(x, _)| x.fract() == 0.0);
        let decimals = if is_counted { 0 } else { 1 + (-(end - start).log10().floor()).max(0.0) as usize };
        let mut chart = ChartBuilder::on(area)
            .margin(fine(10))
            .set_label_area_size(LabelAreaPosition::Left, fine(86))
            .set_label_area_size(LabelAreaPosition::Bottom, fine(48))
            .build_cartesian_2d(start..end, range.log_scale())?;
        chart
            .configure_mesh()
            .x_desc(curve.over)
            .y_desc(curve.axis)
            .x_label_formatter(&|x| format!("{x:.decimals$}"))
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
            let line = [(start, *level), (end, *level)];
            chart.draw_series(DashedLineSeries::new(line, fine(6), fine(5), INK.stroke_width(FINENESS)))?;
            // At the left: the curve comes down to it at the right.
            let at = (start + 0.008 * (end - start), *level * (high / low).powf(0.09));
            chart.draw_series([Text::new(name.clone(), at, font(14).color(&INK))])?;
        }
        for begin in &curve.begins {
            let line = [(*begin, low * 0.7), (*begin, high * 1.4)];
            chart.draw_series(LineSeries::new(line, BEGIN.stroke_width(FINENESS)))?;
        }
        let line = curve.points.iter().copied().filter(|(_, value)| *value > 0.0 && value.is_finite());
        chart.draw_series(LineSeries::new(line, curve.colour.stroke_width(2 * FINENESS)))?;
    }
    root.present()?;
    Ok(())
}
