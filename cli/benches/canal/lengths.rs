//! C-canal surfaces of given lengths across: attained where that is possible, told and replaced where it is not.

use std::ops::ControlFlow;

use anyhow::Result;
use shapeop::error::Status;
use shapeop::geometry::canal::c_canal::{CCanal, Target, c_canal};

use crate::group::Group;
use crate::shapes::{c_guide, chord, ellipse};
use crate::truths::worst;

const COUNTS: [usize; 4] = [8, 16, 32, 64];

fn build(n: usize, height: f64, lengths: &[f64], is_projected: bool) -> shapeop::error::Result<CCanal> {
    let target = Target::Lengths(lengths);
    c_canal(&c_guide(n), &ellipse(11, height), target, is_projected, &mut |_| ControlFlow::Continue(()))
}

/// Lengths along the guide, those of the section times a factor of the part done.
fn lengths(n: usize, height: f64, factor: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..=n).map(|k| chord(&ellipse(11, height)) * factor(k as f64 / n as f64)).collect()
}

fn attained() -> Result<Group> {
    let mut group = Group::new(
        "C-canal surfaces: lengths that are attainable",
        "Sections of 11 edges, three heights; lengths constant, or shrinking by a fifth. Largest |L − L'| over \
            the section's chord.",
    );
    for n in COUNTS {
        let (mut off, mut exact) = (0.0_f64, 0.0_f64);
        for height in [0.6, 1.0, 1.7] {
            for shrinking in [0.0, 0.2] {
                let wanted = lengths(n, height, |s| 1.0 - shrinking * s * s);
                let found = build(n, height, &wanted, false)?;
                let grid = found.surface.net().grid();
                for (k, length) in wanted.iter().enumerate() {
                    off = off.max((chord(grid.row(k)) - length).abs() / wanted[0]);
                }
                exact = exact.max(worst(grid));
            }
        }
        group.at_most(&format!("n = {n}: largest |L − L'|"), off, 1e-12);
        group.at_most(&format!("n = {n}: planarity and concyclicity"), exact, 1e-10);
    }
    Ok(group)
}

fn growing() -> Result<Group> {
    let mut group = Group::new(
        "C-canal surfaces: lengths that grow too fast",
        "The section's chord times 1 + 3 s along the guide: refused with the attainable interval, or replaced \
            by its nearest end.",
    );
    for n in COUNTS {
        let wanted = lengths(n, 0.7, |s| 1.0 + 3.0 * s);
        let is_told = match build(n, 0.7, &wanted, false) {
            Ok(_) => false,
            Err(error) => error.status() == Status::NoSolution && error.to_string().contains("is not attainable"),
        };
        group.at_least(&format!("n = {n}: refused with the interval"), f64::from(is_told), 1.0);
        let found = build(n, 0.7, &wanted, true)?;
        group.at_least(&format!("n = {n}: lengths replaced"), found.projected.len() as f64, 1.0);
        let mut off = 0.0_f64;
        for &k in &found.projected {
            let [low, high] = found.attainable[k];
            off = off.max((found.lengths[k] - wanted[k].clamp(low, high)).abs() / wanted[0]);
        }
        group.at_most(&format!("n = {n}: those off the nearest end / chord"), off, 1e-6);
        if let Some(&k) = found.projected.first() {
            let [low, high] = found.attainable[k];
            group.plain(&format!("n = {n}: the first, section {k}: wanted / chord"), wanted[k] / wanted[0]);
            group.plain("   attainable from", low / wanted[0]);
            group.plain("   to", high / wanted[0]);
        }
        let kept = (0..=n).filter(|k| !found.projected.contains(k));
        let off = kept.map(|k| (found.lengths[k] - wanted[k]).abs() / wanted[0]).fold(0.0, f64::max);
        group.at_most(&format!("n = {n}: the others, largest |L − L'|"), off, 1e-12);
        let farthest = found.deviations.iter().map(|deviation| deviation.abs()).fold(0.0, f64::max);
        group.plain(&format!("n = {n}: largest |L − L'| of all / chord"), farthest / wanted[0]);
        group.at_most(&format!("n = {n}: planarity and concyclicity"), worst(found.surface.net().grid()), 1e-9);
    }
    Ok(group)
}

pub fn groups() -> Result<Vec<Group>> {
    Ok(vec![attained()?, growing()?])
}
