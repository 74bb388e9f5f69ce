//! What strips are worth, in a table and in plain words.

use serde::Serialize;
use shapeop::geometry::ruled::report::{Report, StripReport};

use crate::table::{number, percent};

/// Strips that cover less than this part of the mesh are told.
const COVERED: f64 = 0.995;

/// A gap above this part of the diagonal is told.
const GAP: f64 = 1e-3;

/// A kink above this is told, in degrees: it is seen as an edge.
const KINK_DEG: f64 = 5.0;

/// Places that a warning names.
const MOST_NAMED: usize = 8;

/// Lengths over the diagonal of the mesh.
#[derive(Clone, Copy, Serialize)]
pub struct Relative {
    strips_to_mesh_max: f64,
    strips_to_mesh_rms: f64,
    mesh_to_strips_max: f64,
    mesh_to_strips_rms: f64,
    max_gap: f64,
    mean_gap: f64,
}

impl Relative {
    pub fn of(report: &Report, diagonal: f64) -> Self {
        Self {
            strips_to_mesh_max: report.strips_to_reference.max / diagonal,
            strips_to_mesh_rms: report.strips_to_reference.rms / diagonal,
            mesh_to_strips_max: report.reference_to_strips.max / diagonal,
            mesh_to_strips_rms: report.reference_to_strips.rms / diagonal,
            max_gap: report.max_gap / diagonal,
            mean_gap: report.mean_gap / diagonal,
        }
    }
}

/// The figures that matter.
pub fn rows(report: &Report, diagonal: f64) -> Vec<Vec<String>> {
    let row = |name: &str, cells: [String; 4]| [vec![name.to_owned()], cells.to_vec()].concat();
    let of_diagonal = |length: f64| percent(length / diagonal);
    let mut rows = vec![row("", ["max", "rms or mean", "max", "rms or mean"].map(str::to_owned))];
    let mut lengths = |name: &str, [max, mean]: [f64; 2]| {
        rows.push(row(name, [number(max), number(mean), of_diagonal(max), of_diagonal(mean)]));
    };
    let (there, back) = (&report.strips_to_reference, &report.reference_to_strips);
    lengths("from strips to the mesh", [there.max, there.rms]);
    lengths("from the mesh to strips", [back.max, back.rms]);
    if !report.joints.is_empty() {
        lengths("gap between strips", [report.max_gap, report.mean_gap]);
        let degrees = |angle: f64| format!("{}°", number(angle));
        let kinks = [degrees(report.max_kink_deg), degrees(report.mean_kink_deg), String::new(), String::new()];
        rows.push(row("kink between strips", kinks));
    }
    let widths = |value: fn(&StripReport) -> f64| report.strips.iter().map(value);
    let least = widths(|strip| strip.widths.min).fold(f64::INFINITY, f64::min);
    let most = widths(|strip| strip.widths.max).fold(0.0, f64::max);
    rows.push(vec![
        "width of strips".to_owned(),
        number(most),
        String::new(),
        format!("least {}", number(least)),
        format!("varies by {}", percent(report.width_variation)),
    ]);
    rows.push(vec!["covered".to_owned(), percent(report.coverage)]);
    rows
}

/// What is not as it should be.
pub fn warnings(report: &Report, diagonal: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    let worst = report.too_wide.iter().max_by(|a, b| {
        let ratio = |i: usize| report.strips[i].width_over_feature;
        ratio(**a).total_cmp(&ratio(**b))
    });
    if let Some(&worst) = worst {
        let strip = &report.strips[worst];
        warnings.push(format!(
            "{}: about as wide as the features of the mesh; strip {worst} is up to {} wide, {} times the least radius of \
             curvature there; narrower strips follow the mesh better",
            strips_named(&report.too_wide),
            number(strip.widths.max),
            number(strip.width_over_feature)
        ));
    }
    if report.coverage < COVERED {
        warnings.push(format!("strips cover {} of the mesh", percent(report.coverage)));
    }
    if report.max_gap > GAP * diagonal {
        let at = report.joints.iter().max_by(|a, b| a.max_gap.total_cmp(&b.max_gap)).map(|joint| joint.strips);
        let at = at.map_or(String::new(), |[a, b]| format!(" between strips {a} and {b}"));
        warnings.push(format!("a gap of {}{at}: --shared closes gaps", number(report.max_gap)));
    }
    if report.max_kink_deg > KINK_DEG {
        let joints = report.joints.iter();
        let at = joints.max_by(|a, b| a.max_kink_deg.total_cmp(&b.max_kink_deg)).map(|joint| joint.strips);
        let at = at.map_or(String::new(), |[a, b]| format!(" between strips {a} and {b}"));
        warnings.push(format!("a kink of {}°{at}: it will be seen", number(report.max_kink_deg)));
    }
    warnings
}

/// A count with its noun.
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The first of a list of strips.
fn strips_named(list: &[usize]) -> String {
    let names: Vec<String> = list.iter().take(MOST_NAMED).map(usize::to_string).collect();
    let rest = if list.len() > MOST_NAMED { format!(", ... ({} in all)", list.len()) } else { String::new() };
    format!("strip{} {}{rest}", if list.len() == 1 { "" } else { "s" }, names.join(", "))
}
