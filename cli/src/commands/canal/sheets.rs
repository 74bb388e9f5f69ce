//! Panels laid out on a sheet in true scale, as SVG: one millimetre of the drawing is one of the panel.

use anyhow::Result;
use glam::DVec2;
use shapeop::geometry::canal::panels::Panel;
use svg::Document;
use svg::node::element::{Group, Polygon, Text};

use crate::raster::FONT_FAMILY;

/// Between panels and around them, over the largest panel of the sheet.
const GAP: f64 = 0.12;

/// Height of letters over the shortest edge of a panel.
const LETTERS: f64 = 0.09;

/// Lines that are cut are as thin as a laser's driver asks for, in millimetres.
const HAIRLINE_MM: f64 = 0.1;

/// One row of panels.
pub struct Sheet<'a> {
    pub name: &'a str,
    pub row: usize,
    pub panels: &'a [Panel],
    /// In model units; 0: none.
    pub thickness: f64,
    /// Millimetres in a model unit.
    pub millimetres: f64,
}

/// The drawing. Outlines are seen from the side that the axes point to, and their y runs up.
pub fn drawn(sheet: &Sheet<'_>) -> Result<String> {
    let scaled = |outline: [DVec2; 4]| outline.map(|corner| sheet.millimetres * corner);
    let mut laid = Vec::new();
    for panel in sheet.panels {
        let lower = if sheet.thickness > 0.0 { Some(scaled(panel.lower_outline(sheet.thickness)?)) } else { None };
        let outline = scaled(panel.outline);
        let all = || outline.into_iter().chain(lower.into_iter().flatten());
        let low = all().fold(DVec2::INFINITY, DVec2::min);
        let high = all().fold(DVec2::NEG_INFINITY, DVec2::max);
        laid.push((panel, outline, lower, low, high));
    }
    let largest = laid.iter().map(|(.., low, high)| (*high - *low).max_element()).fold(0.0, f64::max);
    let gap = GAP * largest;
    let title = 0.6 * gap;
    let width = laid.iter().map(|(.., low, high)| high.x - low.x + gap).sum::<f64>() + gap;
    let height = laid.iter().map(|(.., low, high)| high.y - low.y).fold(0.0, f64::max) + 2.0 * gap + title;
    let mut document = Document::new()
        .set("viewBox", format!("0 0 {width:.3} {height:.3}"))
        .set("width", format!("{width:.3}mm"))
        .set("height", format!("{height:.3}mm"))
        .set("font-family", FONT_FAMILY)
        .add(
            words(&format!("{}, row {}", sheet.name, sheet.row), DVec2::new(gap, gap), title)
                .set("text-anchor", "start"),
        );
    let mut left = gap;
    for (column, (panel, outline, lower, low, high)) in laid.into_iter().enumerate() {
        // Up is down on a screen.
        let place = |point: DVec2| DVec2::new(left + point.x - low.x, height - gap - (point.y - low.y));
        let mut group = Group::new().set("id", format!("panel-{}-{column}", sheet.row));
        let shape = |corners: [DVec2; 4]| {
            let points: Vec<String> =
                corners.iter().map(|&corner| place(corner)).map(|at| format!("{:.4},{:.4}", at.x, at.y)).collect();
            Polygon::new().set("points", points.join(" ")).set("fill", "none").set("stroke-width", HAIRLINE_MM)
        };
        if let Some(lower) = lower {
            let dash = format!("{:.2}", 0.05 * gap.max(1.0));
            group =
                group.add(shape(lower).set("stroke", "#0b6fb8").set("stroke-dasharray", dash).set("class", "lower"));
        }
        group = group.add(shape(outline).set("stroke", "#d00000").set("class", "cut"));
        let middle = outline.iter().sum::<DVec2>() / 4.0;
        let shortest = (0..4).map(|k| outline[k].distance(outline[(k + 1) % 4])).fold(f64::INFINITY, f64::min);
        let size = LETTERS * shortest;
        group = group.add(words(&format!("{}-{column}", sheet.row), place(middle), 1.6 * size));
        for k in 0..4 {
            let edge = outline[k].midpoint(outline[(k + 1) % 4]);
            let inside = edge + 0.2 * (middle - edge);
            group = group.add(words(&format!("{:.1}", panel.mitres_rad[k].to_degrees()), place(inside), size));
        }
        document = document.add(group);
        left += high.x - low.x + gap;
    }
    Ok(document.to_string())
}

fn words(text: &str, at: DVec2, size: f64) -> Text {
    Text::new(text)
        .set("x", format!("{:.3}", at.x))
        .set("y", format!("{:.3}", at.y + 0.35 * size))
        .set("font-size", format!("{size:.3}"))
        .set("text-anchor", "middle")
        .set("fill", "#1f2430")
}
