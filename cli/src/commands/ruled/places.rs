//! Refusals of the library under the names of options and files.

use std::path::Path;

use anyhow::anyhow;
use shapeop::error::Error;

use crate::curve_file::Curve;

/// Places of the library, by their beginnings, and what they are called here.
const OPTIONS: [(&str, &str); 17] = [
    ("options.control_count", "--control-points"),
    ("options.bounds.largest_deviation", "--largest-deviation"),
    ("options.bounds.least_width", "--least-width"),
    ("options.samples", "--samples"),
    ("options.tolerance", "--tolerance"),
    ("options.least_length", "--least-length"),
    ("options.least_angle_rad", "--least-angle"),
    ("options.feature_ratio", "--feature-ratio"),
    ("options.thickness", "--planks"),
    ("options.depth", "--depth"),
    ("options.weights", "--weights"),
    ("max_mask", "--max-mask"),
    ("flatness", "--flatness"),
    ("family", "--family"),
    ("hint", "--hint"),
    ("planes", "--planes"),
    ("axes", "--axes"),
];

/// What a refusal can be about.
pub struct Places<'a> {
    pub mesh: &'a Path,
    /// The line of each face in the file of the mesh.
    pub face_lines: &'a [usize],
    /// How levels were asked for, as an option.
    pub levels: &'static str,
    /// The curves in their order.
    pub curves: &'a [Curve],
}

impl Places<'_> {
    /// A refusal with the option or the file that it is about.
    pub fn of(&self, error: Error) -> anyhow::Error {
        let place = error.place().to_owned();
        let mesh = self.mesh.display();
        if let Some(k) = index(&place, "faces") {
            let line = self.face_lines.get(k).map_or(String::new(), |line| format!(", line {line}"));
            return anyhow!("{mesh}{line}: {error}");
        }
        if place == "mesh" || place == "faces" || place.starts_with("points") {
            return anyhow!("{mesh}: {error}");
        }
        if let Some(k) = index(&place, "curves") {
            let file = self.curves.get(k).map_or(String::new(), |curve| format!("{}: ", curve.name));
            return anyhow!("--curves: {file}{error}");
        }
        if place == "spacing" || place.starts_with("levels") {
            let rest = place.trim_start_matches("levels").trim_start_matches("spacing");
            let rest = rest.to_owned();
            return error.with_place(format!("{}{rest}", self.levels)).into();
        }
        in_options(error)
    }
}

/// A refusal under the name of the option that it is about, where it is about one.
pub fn in_options(error: Error) -> anyhow::Error {
    let place = error.place().to_owned();
    let found =
        OPTIONS.iter().find_map(|(name, option)| place.strip_prefix(name).map(|rest| format!("{option}{rest}")));
    match found {
        Some(option) => error.with_place(option.replace("thin_plate", "thin-plate")).into(),
        None => error.into(),
    }
}

/// The number in a place such as `faces[3].x`.
fn index(place: &str, name: &str) -> Option<usize> {
    place.strip_prefix(name)?.strip_prefix('[')?.split(']').next()?.parse().ok()
}
