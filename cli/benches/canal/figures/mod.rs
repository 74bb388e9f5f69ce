//! Figures of Mesnil et al. 2018 on curves of our own: what each shows, measured from coordinates, and a picture.

mod fits;
mod inverse;
mod parts;
mod strips;

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::canal::quality::{Quality, largest};
use shapeop::mesh::Grid;
use shapeop::mesh::curve::Curve;

use crate::group::Group;

/// How planar and concyclic quads must be.
const EXACT: f64 = 1e-9;

/// How near input must be met that is met exactly, over the diagonal.
const MET: f64 = 1e-12;

type Figure = fn(&Path) -> Result<Group>;

const FIGURES: [(&str, Figure); 13] = [
    ("3", inverse::figure3),
    ("5", strips::figure5),
    ("7", strips::figure7),
    ("8", fits::figures8_to_11),
    ("15", strips::figure15),
    ("16", parts::figure16),
    ("17", parts::figure17),
    ("20", inverse::figure20),
    ("21", inverse::figure21),
    ("22", inverse::figure22),
    ("23", inverse::figure23),
    ("24", fits::figure24),
    ("25", fits::figure25),
];

/// Draws all figures, or the one of this name, and prints a line for each.
pub fn draw(folder: &Path, name: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for (_, figure) in FIGURES.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", figure(folder)?);
    }
    Ok(())
}

/// The worst planarity and concyclicity of grids, against their bound.
pub fn exact(group: &mut Group, grids: &[&Grid]) {
    let all: Vec<Quality> = grids.iter().map(|grid| Quality::of(grid)).collect();
    let worst = |of: &dyn Fn(&Quality) -> f64| all.iter().map(of).fold(0.0, f64::max);
    group.at_most("planarity, worst quad", worst(&|quality| largest(&quality.planarity)), EXACT);
    group.at_most("concyclicity, worst quad", worst(&|quality| largest(&quality.concyclicity)), EXACT);
}

/// How far input is missed at most, over the diagonal.
fn met(group: &mut Group, what: &str, distance: f64, grid: &Grid) {
    group.at_most(&format!("{what}, missed by / diagonal"), distance / grid.diagonal(), MET);
}

/// Points of a curve, for drawing.
fn sampled(curve: &dyn Curve, count: u32) -> Vec<DVec3> {
    let [start, end] = curve.range();
    (0..=count).map(|k| curve.point(start + (end - start) * f64::from(k) / f64::from(count))).collect()
}
