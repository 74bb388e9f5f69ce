//! What a picture shows of a mesh: which number per face or edge, on which scale, which is the worst.

use shapeop::mesh::Mesh;
use shapeop::mesh::measure::{self, Spread};

use crate::args::Colour;
use crate::colours::Scale;
use crate::picture::{On, Panel};
use crate::table::percent;

/// Planarity and circularity are shown from 0 to this, in percent; beyond it everything is equally bad.
const FINE_PERCENT: f64 = 1.0;

/// Regularity is shown from 0 to this, in percent.
const COARSE_PERCENT: f64 = 10.0;

/// Strains are shown at least up to this, in percent: less is nothing to worry about.
const LEAST_STRAIN_PERCENT: f64 = 1.0;

/// A choice of numbers, with what they are compared with.
pub struct Shown<'a> {
    what: Colour,
    limit_percent: f64,
    before: &'a Mesh,
    mean_edge: f64,
    /// The length and the range of strain that each edge should have, for strains.
    rest: Option<&'a [RestLength]>,
}

/// What an EdgeStrain constraint asks of an edge.
#[derive(Clone, Copy, Debug)]
pub struct RestLength {
    pub edge: [u32; 2],
    pub length: f64,
}

impl<'a> Shown<'a> {
    pub fn new(
        what: Colour,
        limit_percent: f64,
        before: &'a Mesh,
        edges: &[[u32; 2]],
        rest: Option<&'a [RestLength]>,
    ) -> Self {
        let mean_edge = Spread::of(&lengths(before, edges)).mean;
        Self { what, limit_percent, before, mean_edge, rest }
    }

    /// A panel of `mesh` with its numbers, in percent.
    pub fn panel<'b>(&self, mesh: &'b Mesh, edges: &'b [[u32; 2]], title: String) -> Panel<'b> {
        let of_faces = |measure: fn(&[glam::DVec3]) -> f64| -> Vec<f64> {
            mesh.faces.iter().map(|face| 100.0 * measure(&mesh.corners(face))).collect()
        };
        let over_edge = |length: f64| if self.mean_edge > 0.0 { 100.0 * length / self.mean_edge } else { 0.0 };
        let (on, values) = match self.what {
            Colour::Planarity | Colour::Auto => (On::Faces, of_faces(measure::planarity)),
            Colour::Circularity => (On::Faces, of_faces(measure::circularity)),
            Colour::Regularity => (On::Faces, of_faces(measure::regularity)),
            Colour::Displacement => (On::Faces, self.displacement_of_faces(mesh).into_iter().map(over_edge).collect()),
            Colour::Strain => (On::Edges, self.strains(mesh)),
            Colour::Lengths => {
                let own = lengths(mesh, edges);
                let mean = Spread::of(&own).mean;
                let deviation = |length: &f64| if mean > 0.0 { 100.0 * (length / mean - 1.0) } else { 0.0 };
                (On::Edges, own.iter().map(deviation).collect())
            }
            Colour::None => (On::Faces, Vec::new()),
        };
        let mut panel = Panel { edges, values, on, ..Panel::new(mesh, title) };
        if let Some((index, words)) = worst_of(&panel) {
            (panel.pointed_at, panel.caption) = (Some(index), words);
        }
        panel
    }

    /// The scale of the numbers in `panels`.
    pub fn scale(&self, panels: &[Panel<'_>]) -> Option<Scale> {
        let largest = panels.iter().map(|panel| largest_of(Some(panel))).fold(0.0, f64::max);
        let (title, high) = match self.what {
            Colour::None => return None,
            Colour::Planarity | Colour::Auto => ("planarity", FINE_PERCENT),
            Colour::Circularity => ("circularity", FINE_PERCENT),
            Colour::Regularity => ("irregularity", COARSE_PERCENT),
            Colour::Displacement => ("moved / mean edge", round_up(largest)),
            // The end is what matters; on the way there strains may be extreme.
            Colour::Strain => ("strain", round_up(largest_of(panels.last()).max(LEAST_STRAIN_PERCENT))),
            Colour::Lengths => ("length / mean − 1", round_up(largest)),
        };
        let is_diverging = matches!(self.what, Colour::Strain | Colour::Lengths);
        let mark = matches!(self.what, Colour::Planarity | Colour::Auto).then(|| {
            let name = format!("{} %", (1000.0 * self.limit_percent).round() / 1000.0);
            (self.limit_percent, format!("tolerance {name}"))
        });
        Some(Scale {
            title: title.to_owned(),
            unit: "%",
            range: if is_diverging { [-high, high] } else { [0.0, high] },
            is_diverging,
            mark,
            end_words: match self.what {
                Colour::Strain => ["tension", "compression"],
                Colour::Lengths => ["longer", "shorter"],
                _ => ["", ""],
            },
        })
    }

    fn displacement_of_faces(&self, mesh: &Mesh) -> Vec<f64> {
        let moved = measure::displacements(&self.before.points, &mesh.points).unwrap_or_default();
        let of_face = |face: &Vec<u32>| {
            face.iter().filter_map(|&point| moved.get(point as usize)).sum::<f64>() / face.len().max(1) as f64
        };
        mesh.faces.iter().map(of_face).collect()
    }

    fn strains(&self, mesh: &Mesh) -> Vec<f64> {
        let strain = |rest: &RestLength| {
            let length = lengths(mesh, &[rest.edge]).first().copied().unwrap_or(0.0);
            if rest.length > 0.0 { 100.0 * (length / rest.length - 1.0) } else { 0.0 }
        };
        self.rest.unwrap_or_default().iter().map(strain).collect()
    }
}

/// The worst face or edge of a panel, with what to say of it.
pub fn worst_of(panel: &Panel<'_>) -> Option<(usize, String)> {
    let (at, value) = panel.values.iter().copied().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    if value == 0.0 {
        return None;
    }
    let mean = panel.values.iter().map(|value| value.abs()).sum::<f64>() / panel.values.len() as f64;
    let place = match panel.on {
        On::Faces => format!("face {at}"),
        On::Edges => panel.edges.get(at).map(|[a, b]| format!("edge {a}-{b}"))?,
    };
    Some((at, format!("mean {}, worst {} at {place}", percent(mean / 100.0), percent(value / 100.0))))
}

/// The largest size of a number in a panel.
fn largest_of(panel: Option<&Panel<'_>>) -> f64 {
    panel.into_iter().flat_map(|panel| &panel.values).fold(0.0, |most, value| most.max(value.abs()))
}

fn lengths(mesh: &Mesh, edges: &[[u32; 2]]) -> Vec<f64> {
    let length = |edge: &[u32; 2]| match mesh.corners(edge).as_slice() {
        [a, b] => a.distance(*b),
        _ => 0.0,
    };
    edges.iter().map(length).collect()
}

/// The next of 1, 2, 5 times a power of ten, so that the ticks are numbers that one reads.
pub fn round_up(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|digit| digit * power).find(|high| *high >= value * 0.999).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_end_at_round_numbers() {
        for (value, end) in [(0.7, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (7.0, 10.0), (0.0, 1.0), (f64::NAN, 1.0)] {
            assert!((round_up(value) - end).abs() < 1e-12, "{value}");
        }
    }
}
