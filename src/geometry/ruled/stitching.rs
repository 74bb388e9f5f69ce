//! Level curves of functions that jump across cuts.
//!
//! On the mesh cut open levels have pieces that end at cuts. If the jump there is `m` distances of levels, level `k` on the right side
//! of the cut goes on as level `k + m` on its left.

use std::collections::BTreeMap;

use super::cuts::Split;
use crate::error::Result;
use crate::mesh::TriangleMesh;
use crate::mesh::level_curves::{LevelCurve, LevelPoint, level_curves};

/// A level curve, whole.
#[derive(Clone, Debug)]
pub(super) struct Stitched {
    /// The number of its level, from 0 to below the period.
    pub level: i64,
    pub curve: LevelCurve,
    /// How often it crosses a cut from right to left more than from left to right, of all cuts the most.
    pub winding: i32,
}

/// If both ends of an edge are on one cut: the edge of the mesh, the cut, and whether this is its left side.
fn side(
    split: &Split,
    original: &TriangleMesh,
    point: &LevelPoint,
    on_cut: &[Option<u32>],
) -> Option<([u32; 2], usize, bool)> {
    let copy = |i: u32| (i as usize).checked_sub(split.point_count).map(|k| split.copies[k]);
    let mut edge = point.edge.map(|i| copy(i).map_or(i, |(i, _)| i));
    edge.sort_unstable();
    let cut = on_cut[edge[0] as usize].filter(|_| on_cut[edge[0] as usize] == on_cut[edge[1] as usize])?;
    let is_left = point.edge.iter().all(|&i| copy(i).is_some());
    // Points of a cut beside each other on the boundary are no cut edge.
    let triangle = point.at.triangle as usize;
    let k = (0..3).find(|&k| {
        let corners = [original.triangles()[triangle][k], original.triangles()[triangle][(k + 1) % 3]];
        edge.iter().all(|i| corners.contains(i))
    })?;
    original.across(triangle, k)?;
    Some((edge, cut as usize, is_left))
}

/// The curves of all levels `(k + ½) · width` modulo the period, each with its number and winding, in order of the numbers.
pub(super) fn stitched(
    split: &Split,
    original: &TriangleMesh,
    values: &[f64],
    width: f64,
    counts: &[i64],
    period: i64,
) -> Result<Vec<Stitched>> {
    let mut on_cut = vec![None; split.point_count];
    split.copies.iter().for_each(|&(i, cut)| on_cut[i as usize] = Some(cut));
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mut pieces: Vec<(i64, LevelCurve)> = Vec::new();
    for k in (low / width).floor() as i64 - 1..=(high / width).ceil() as i64 {
        let curves = level_curves(&split.mesh, values, (k as f64 + 0.5) * width)?;
        pieces.extend(curves.into_iter().filter(|curve| curve.points.len() > 1).map(|curve| (k, curve)));
    }
    // Where pieces begin at cuts, by the edge and the level on the right side.
    let end = |piece: usize, is_last: bool| {
        let (k, curve) = &pieces[piece];
        let point = if is_last { curve.points.last()? } else { curve.points.first()? };
        let (edge, cut, is_left) = side(split, original, point, &on_cut).filter(|_| !curve.is_closed)?;
        Some(((edge, if is_left { k - counts[cut] } else { *k }), cut, is_left))
    };
    let mut begins = BTreeMap::new();
    for piece in 0..pieces.len() {
        begins.extend(end(piece, false).map(|(key, ..)| (key, piece)));
    }
    let mut is_used = vec![false; pieces.len()];
    let mut found = Vec::new();
    for wants_closed in [false, true] {
        for first in 0..pieces.len() {
            if is_used[first] || (!wants_closed && end(first, false).is_some()) {
                continue;
            }
            let mut winding = vec![0_i32; counts.len()];
            let (mut points, mut now) = (Vec::new(), first);
            let is_closed = loop {
                is_used[now] = true;
                points.extend_from_slice(&pieces[now].1.points);
                if pieces[now].1.is_closed {
                    break true;
                }
                let Some((key, cut, is_left)) = end(now, true) else { break false };
                winding[cut] += if is_left { -1 } else { 1 };
                match begins.get(&key) {
                    Some(&next) if next == first => break true,
                    Some(&next) if !is_used[next] => {
                        // The point on the cut is there twice.
                        points.pop();
                        now = next;
                    }
                    _ => break false,
                }
            };
            if is_closed && points.len() > 1 && !pieces[now].1.is_closed {
                points.pop();
            }
            let most =
                winding.into_iter().fold(0, |most: i32, count| if count.abs() > most.abs() { count } else { most });
            let level = pieces[first].0.rem_euclid(period);
            found.push(Stitched { level, curve: LevelCurve { points, is_closed }, winding: most });
        }
    }
    found.sort_by_key(|stitched| stitched.level);
    Ok(found)
}
