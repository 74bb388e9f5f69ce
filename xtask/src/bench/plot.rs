//! The plots, on logarithmic axes: time per iteration over the number of vertices, and energies over evaluations.

use anyhow::{Result, anyhow};
use plotters::coord::Shift;
use plotters::prelude::*;

use super::energies::{Energies, Problem, name};
use super::measure::{Case, Measurements};

/// Width and height of a plot in the units of its SVG.
pub const SIZE: (u32, u32) = (1000, 640);

/// The backend rounds coordinates to whole units: it draws so many times larger, and the view is shrunk.
pub const FINENESS: u32 = 4;

/// The colour of text and axes.
pub const INK: RGBColor = RGBColor(0x1f, 0x24, 0x30);
/// The colour of grid lines.
pub const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xeb);

/// A colour per problem that both libraries have.
const COLOURS: [(&str, RGBColor); 4] = [
    ("planar_quads", RGBColor(0x17, 0x43, 0x99)),
    ("cloth", RGBColor(0x85, 0x26, 0x73)),
    ("squares", RGBColor(0xb4, 0x53, 0x09)),
    ("quad_circles", RGBColor(0x0f, 0x76, 0x6e)),
];

/// What methods of acceleration are drawn in: colour and width. The last drawn lies on top and is thin, so that lines below
/// it are seen.
const METHODS: [(&str, RGBColor, u32); 3] = [
    ("plain", RGBColor(0x6b, 0x72, 0x80), 2),
    ("anderson", RGBColor(0xe0, 0x8a, 0x1e), 4),
    ("quasi-newton", RGBColor(0x17, 0x43, 0x99), 2),
];

/// The relative error of the energy at the lower edge of its panels.
const LEAST_ERROR: f64 = 1e-10;

/// Panels beside each other.
const PANELS_PER_ROW: usize = 3;

/// What a function that draws returns.
pub type Drawn = Result<(), Box<dyn std::error::Error>>;

/// The plot of scaling as SVG: this library on two threads in full lines, compas-shapeop in dashed ones.
pub fn scaling(measurements: &Measurements) -> Result<String> {
    svg(&|text| draw_scaling(text, measurements))
}

/// The plot of energies as SVG: the relative error over evaluations, a panel per problem.
pub fn energies(energies: &Energies) -> Result<String> {
    svg(&|text| draw_energies(text, energies))
}

/// A drawing as SVG.
pub fn svg(draw: &dyn Fn(&mut String) -> Drawn) -> Result<String> {
    let mut text = String::new();
    draw(&mut text).map_err(|error| anyhow!("the plot could not be drawn: {error}"))?;
    let drawn = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    Ok(text.replacen(&drawn, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1))
}

/// A length in units of the drawing.
pub fn fine(size: u32) -> u32 {
    size * FINENESS
}

/// A font in units of the drawing.
pub fn font(size: u32) -> FontDesc<'static> {
    ("sans-serif", fine(size)).into_font()
}

fn draw_scaling(text: &mut String, measurements: &Measurements) -> Drawn {
    let ours = |case: &Case| Some((case.vertices as f64, case.two_threads.as_ref()?.iteration_ms));
    let peers = |case: &Case| Some((case.vertices as f64, case.peer.as_ref()?.iteration_ms));
    let all: Vec<(f64, f64)> = measurements.cases.iter().flat_map(|case| [ours(case), peers(case)]).flatten().collect();
    let bounds = |values: &dyn Fn(&(f64, f64)) -> f64| {
        let low = all.iter().map(values).fold(f64::INFINITY, f64::min);
        (low, all.iter().map(values).fold(0.0, f64::max))
    };
    let ((least_x, most_x), (least_y, most_y)) = (bounds(&|point| point.0), bounds(&|point| point.1));
    let root = SVGBackend::with_string(text, (fine(SIZE.0), fine(SIZE.1))).into_drawing_area();
    root.fill(&WHITE)?;
    // Room at the right for the names of the lines.
    let mut chart = ChartBuilder::on(&root)
        .margin(fine(16))
        .caption("Time per iteration: this library on two threads, compas-shapeop dashed", font(18).color(&INK))
        .set_label_area_size(LabelAreaPosition::Left, fine(80))
        .set_label_area_size(LabelAreaPosition::Bottom, fine(48))
        .build_cartesian_2d((0.8 * least_x..6.0 * most_x).log_scale(), (0.6 * least_y..2.0 * most_y).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("vertices")
        .y_desc("ms per iteration")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y}"))
        .set_all_tick_mark_size(fine(5))
        .axis_style(INK.stroke_width(FINENESS))
        .light_line_style(WHITE)
        .bold_line_style(GRID.stroke_width(FINENESS))
        .label_style(font(13).color(&INK))
        .axis_desc_style(font(15).color(&INK))
        .draw()?;
    // Names stand at the ends of their lines, and move up where they would cover the one before.
    let mut names: Vec<(f64, f64, String, RGBColor)> = Vec::new();
    for (problem, colour) in COLOURS {
        let of = |pick: &dyn Fn(&Case) -> Option<(f64, f64)>| -> Vec<(f64, f64)> {
            measurements.cases.iter().filter(|case| case.problem == problem).filter_map(pick).collect()
        };
        let (own, other) = (of(&ours), of(&peers));
        let style = colour.stroke_width(2 * FINENESS);
        chart.draw_series(LineSeries::new(own.iter().copied(), style))?;
        chart.draw_series(own.iter().map(|at| Circle::new(*at, fine(3), colour.filled())))?;
        chart.draw_series(DashedLineSeries::new(other.iter().copied(), fine(7), fine(5), style))?;
        chart.draw_series(other.iter().map(|at| Circle::new(*at, fine(3), colour.stroke_width(FINENESS))))?;
        let ends = [(own.last(), problem.to_owned()), (other.last(), format!("{problem}, compas-shapeop"))];
        names.extend(ends.into_iter().filter_map(|(end, name)| end.map(|&(x, y)| (x, y, name, colour))));
    }
    names.sort_by(|a, b| a.1.total_cmp(&b.1));
    let step = (most_y / least_y).powf(0.045);
    let mut lowest = 0.0_f64;
    for (x, y, name, colour) in names {
        let y = y.max(lowest);
        lowest = y * step;
        chart.draw_series([Text::new(name, (1.15 * x, y * step.powf(0.5)), font(13).color(&colour))])?;
    }
    root.present()?;
    Ok(())
}

fn draw_energies(text: &mut String, energies: &Energies) -> Drawn {
    let root = SVGBackend::with_string(text, (fine(SIZE.0), fine(SIZE.1))).into_drawing_area();
    root.fill(&WHITE)?;
    let (top, panels) = root.split_vertically(fine(44));
    top.draw(&Text::new(
        "Relative error of the energy over evaluations:",
        (fine(16) as i32, fine(15) as i32),
        font(18).color(&INK),
    ))?;
    for (i, (method, colour, width)) in METHODS.into_iter().enumerate() {
        let at = |x: u32, y: u32| (fine(x + 150 * i as u32) as i32, fine(y) as i32);
        top.draw(&PathElement::new([at(440, 25), at(475, 25)], colour.stroke_width(fine(width))))?;
        top.draw(&Text::new(name(method), at(482, 16), font(16).color(&INK)))?;
    }
    // quad_circles is left out if it is one too many: circles has all of its constraints.
    let count = energies.problems.len().min(2 * PANELS_PER_ROW);
    let most = |problem: &Problem| problem.curves.iter().filter_map(|curve| curve.evaluations.last()).max().copied();
    let most = energies.problems.iter().filter_map(most).max().unwrap_or(1);
    let rows = panels.split_evenly((count.div_ceil(PANELS_PER_ROW), PANELS_PER_ROW));
    for (problem, panel) in energies.problems.iter().zip(&rows) {
        draw_panel(panel, problem, f64::from(most.max(10)))?;
    }
    root.present()?;
    Ok(())
}

/// One problem's curves, over evaluations from 1 to `most`.
fn draw_panel(panel: &DrawingArea<SVGBackend<'_>, Shift>, problem: &Problem, most: f64) -> Drawn {
    let highest = problem.curves.iter().flat_map(|curve| problem.errors(curve)).fold(1.0, f64::max);
    let mut chart = ChartBuilder::on(panel)
        .margin(fine(8))
        .margin_right(fine(24))
        .caption(format!("{}, {} vertices", problem.name, problem.vertices), font(15).color(&INK))
        .set_label_area_size(LabelAreaPosition::Left, fine(44))
        .set_label_area_size(LabelAreaPosition::Bottom, fine(26))
        .build_cartesian_2d((1.0..most).log_scale(), (LEAST_ERROR..2.0 * highest).log_scale())?;
    chart
        .configure_mesh()
        .y_labels(8)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .set_all_tick_mark_size(fine(4))
        .axis_style(INK.stroke_width(FINENESS))
        .light_line_style(WHITE)
        .bold_line_style(GRID.stroke_width(FINENESS))
        .label_style(font(12).color(&INK))
        .draw()?;
    for (method, colour, width) in METHODS {
        let Some(curve) = problem.curve(method) else { continue };
        let errors = problem.errors(curve);
        // What lies along the lower edge at the end tells nothing.
        let end = errors.iter().rposition(|error| *error > LEAST_ERROR).map_or(0, |last| (last + 2).min(errors.len()));
        let points = curve.evaluations.iter().zip(&errors).take(end);
        let points = points.map(|(evaluations, error)| (f64::from(*evaluations), error.max(LEAST_ERROR)));
        // Nearer points than these would cover each other.
        let mut last = 0.0;
        let is_apart = |point: &(f64, f64)| {
            let is_apart = point.0 >= 1.005 * last;
            last = if is_apart { point.0 } else { last };
            is_apart
        };
        let points = points.filter(is_apart);
        chart.draw_series(LineSeries::new(points, colour.stroke_width(fine(width))))?;
    }
    Ok(())
}
