//! The plot of scaling: time per iteration over the number of vertices, on logarithmic axes.

use anyhow::{Result, anyhow};
use plotters::prelude::*;

use super::measure::{Case, Measurements};

/// Width and height of the plot in the units of its SVG.
const SIZE: (u32, u32) = (1000, 640);

/// The backend rounds coordinates to whole units: it draws so many times larger, and the view is shrunk.
const FINENESS: u32 = 4;

const INK: RGBColor = RGBColor(0x1f, 0x24, 0x30);
const GRID: RGBColor = RGBColor(0xe3, 0xe6, 0xeb);

/// A colour per problem that both libraries have.
const COLOURS: [(&str, RGBColor); 4] = [
    ("planar_quads", RGBColor(0x17, 0x43, 0x99)),
    ("cloth", RGBColor(0x85, 0x26, 0x73)),
    ("squares", RGBColor(0xb4, 0x53, 0x09)),
    ("quad_circles", RGBColor(0x0f, 0x76, 0x6e)),
];

/// The plot as SVG: this library on two threads in full lines, compas-shapeop in dashed ones.
pub fn scaling(measurements: &Measurements) -> Result<String> {
    let mut text = String::new();
    draw(&mut text, measurements).map_err(|error| anyhow!("the plot could not be drawn: {error}"))?;
    let drawn = format!("width=\"{}\" height=\"{}\"", SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    Ok(text.replacen(&drawn, &format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1), 1))
}

fn draw(text: &mut String, measurements: &Measurements) -> Result<(), Box<dyn std::error::Error>> {
    let ours = |case: &Case| Some((case.vertices as f64, case.two_threads.as_ref()?.iteration_ms));
    let peers = |case: &Case| Some((case.vertices as f64, case.peer.as_ref()?.iteration_ms));
    let all: Vec<(f64, f64)> = measurements.cases.iter().flat_map(|case| [ours(case), peers(case)]).flatten().collect();
    let bounds = |values: &dyn Fn(&(f64, f64)) -> f64| {
        let low = all.iter().map(values).fold(f64::INFINITY, f64::min);
        (low, all.iter().map(values).fold(0.0, f64::max))
    };
    let ((least_x, most_x), (least_y, most_y)) = (bounds(&|point| point.0), bounds(&|point| point.1));
    let fine = |size: u32| size * FINENESS;
    let font = |size: u32| ("sans-serif", fine(size)).into_font();
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
