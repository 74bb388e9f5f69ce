//! Planks drawn in true scale, as SVG: one millimetre of the drawing is one of the plank.

use glam::DVec2;
use svg::Document;
use svg::node::element::{Group, Line, Polygon, Text};

use super::{Plank, Planks};
use crate::error::{Error, Result, Status};

/// Lines that are cut are as thin as a laser's driver asks for, in millimetres.
const HAIRLINE_MM: f64 = 0.1;

/// Height of letters over the widest plank, and between planks.
const LETTERS: f64 = 0.16;

/// The planks one below the other, each seen against the axis: its outline (red: cut), the rulings in its lower face (blue) and its
/// upper face (dashed), its number, length, width and the angles of its cuts. `name` stands above; `millimetres` are in a
/// model unit.
///
/// # Errors
/// `millimetres` is not above 0; the place is `millimetres`.
pub fn sheet(planks: &Planks, name: &str, millimetres: f64) -> Result<String> {
    if !(millimetres > 0.0 && millimetres.is_finite()) {
        let reason = format!("expected a number above 0, found {millimetres}");
        return Err(Error::new(Status::InvalidValue, reason).at("millimetres"));
    }
    let largest = |value: fn(&Plank) -> f64| planks.planks.iter().map(value).fold(0.0, f64::max) * millimetres;
    let (length, width) = (largest(|plank| plank.length), largest(|plank| plank.width));
    let letters = LETTERS * width;
    let step = width + 4.0 * letters;
    let [wide, high] = [length + 4.0 * letters, 3.0 * letters + step * planks.planks.len() as f64];
    let title = format!(
        "{name}: {} planks, thickness {:.1} mm, offcut {:.1} %",
        planks.planks.len(),
        planks.thickness * millimetres,
        100.0 * planks.offcut
    );
    let mut document = Document::new()
        .set("viewBox", format!("0 0 {wide:.3} {high:.3}"))
        .set("width", format!("{wide:.3}mm"))
        .set("height", format!("{high:.3}mm"))
        .set("font-family", "sans-serif")
        .add(words(&title, DVec2::new(2.0 * letters, 1.5 * letters), letters));
    for (k, plank) in planks.planks.iter().enumerate() {
        document = document.add(drawn(plank, k, millimetres, letters, 3.0 * letters + step * k as f64));
    }
    Ok(document.to_string())
}

/// A plank whose drawing starts at the height `top`.
fn drawn(plank: &Plank, k: usize, millimetres: f64, letters: f64, top: f64) -> Group {
    let scaled = |corner: [f64; 2]| millimetres * DVec2::from_array(corner);
    let corners = plank.outline.map(scaled);
    let low = corners.iter().fold(DVec2::INFINITY, |low, corner| low.min(*corner));
    let high = corners.iter().fold(DVec2::NEG_INFINITY, |high, corner| high.max(*corner));
    // Up is down on a screen.
    let place = |point: DVec2| DVec2::new(2.0 * letters + point.x - low.x, top + high.y - point.y);
    let points: Vec<String> =
        corners.iter().map(|&corner| place(corner)).map(|at| format!("{:.4},{:.4}", at.x, at.y)).collect();
    let outline = Polygon::new()
        .set("points", points.join(" "))
        .set("fill", "none")
        .set("stroke", "#d00000")
        .set("stroke-width", HAIRLINE_MM)
        .set("class", "cut");
    let mut group = Group::new().set("id", format!("plank-{k}")).add(outline);
    for (face, ruling) in plank.rulings.iter().enumerate() {
        let [a, b] = ruling.map(|end| place(scaled(end)));
        let line = Line::new()
            .set("x1", format!("{:.4}", a.x))
            .set("y1", format!("{:.4}", a.y))
            .set("x2", format!("{:.4}", b.x))
            .set("y2", format!("{:.4}", b.y))
            .set("stroke", "#0b6fb8")
            .set("stroke-width", HAIRLINE_MM)
            .set("class", ["lower", "upper"][face]);
        group = group.add(if face == 1 { line.set("stroke-dasharray", format!("{:.2}", 0.3 * letters)) } else { line });
    }
    let size = [plank.length, plank.width].map(|length| length * millimetres);
    let dimensions = format!(
        "{k}: {:.1} × {:.1} mm, cuts {:.2}° and {:.2}°",
        size[0], size[1], plank.end_angles_deg[0], plank.end_angles_deg[1]
    );
    group.add(words(&dimensions, DVec2::new(2.0 * letters, top + size[1] + 1.5 * letters), letters))
}

fn words(text: &str, at: DVec2, size: f64) -> Text {
    Text::new(text)
        .set("x", format!("{:.3}", at.x))
        .set("y", format!("{:.3}", at.y))
        .set("font-size", format!("{size:.3}"))
        .set("fill", "#1f2430")
}
