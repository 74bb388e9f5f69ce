//! The sum of what constraints pull at each point with: one thread per point adds up the results that belong to it, in a fixed
//! order. No atomics, so the bits are the same on every run.

use bytemuck::{Pod, Zeroable};

use super::card::{Access, Card, GROUP, Run, THREADS};
use super::frame::Four;
use super::local_step::LocalStep;
use crate::constraints::ConstraintSet;
use crate::error::Result;

/// See `struct Lists` in `gather.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Lists {
    first: u32,
    count: u32,
}

/// The runs that add the pulls of all constraints to `sums`, one number of four per point: first the pull, then the energy.
pub(super) fn runs(
    card: &Card,
    constraints: &ConstraintSet,
    step: &LocalStep,
    point_count: usize,
    sums: &wgpu::Buffer,
) -> Result<Vec<Run>> {
    let accesses = [Access::Uniform, Access::Read, Access::Read, Access::Read, Access::Write];
    let kernel = card.kernel("gather", &[include_str!("shaders/gather.wgsl"), THREADS], &accesses)?;
    let mut runs = Vec::new();
    for (page, (results, _)) in step.pages.iter().enumerate() {
        let (starts, places) = lists_of(constraints, step, page, point_count);
        // Cut where the entries would exceed a binding.
        let most = (card.binding_bytes() / size_of::<u32>() as u64) as usize;
        for part in sliced(&starts, &places, most) {
            let uniform = card.uniform(&Lists { first: part.first as u32, count: part.count as u32 });
            let starts = card.buffer("where the lists of points begin", &part.starts)?;
            let entries = card.buffer("the constraints of points", &part.entries)?;
            runs.push(card.run_of(&kernel, &[&uniform, &starts, &entries, results, sums], part.count));
        }
    }
    Ok(runs)
}

/// The results of one page that belong to each point, point after point.
fn lists_of(constraints: &ConstraintSet, step: &LocalStep, page: usize, point_count: usize) -> (Vec<usize>, Vec<u32>) {
    let each = |visit: &mut dyn FnMut(u32, usize)| {
        for bucket in step.buckets.iter().filter(|bucket| bucket.page == page) {
            let (batch, count) = (constraints.batch(bucket.batch), bucket.slots.len());
            for (i, &slot) in bucket.slots.iter().enumerate() {
                for (j, &point) in batch.indices(slot as usize).iter().enumerate() {
                    visit(point, bucket.first + j * count + i);
                }
            }
        }
    };
    let mut starts = vec![0_usize; point_count + 1];
    each(&mut |point, _| starts[point as usize + 1] += 1);
    for i in 0..point_count {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut places = vec![0_u32; starts[point_count]];
    each(&mut |point, place| {
        places[next[point as usize]] = place as u32;
        next[point as usize] += 1;
    });
    (starts, places)
}

/// Lists of consecutive points for one run: in slices of [`GROUP`] points, entry `n` of all of them behind each other, so that
/// neighbouring threads read neighbouring entries. What a shorter list lacks is [`NOTHING`].
struct Part {
    first: usize,
    count: usize,
    /// Where each slice begins, and the end.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

/// No entry.
const NOTHING: u32 = u32::MAX;

fn sliced(starts: &[usize], places: &[u32], most_entries: usize) -> Vec<Part> {
    let point_count = starts.len() - 1;
    let group = GROUP as usize;
    let mut parts: Vec<Part> = Vec::new();
    for first in (0..point_count).step_by(group) {
        let points = first..(first + group).min(point_count);
        let longest = points.clone().map(|i| starts[i + 1] - starts[i]).max().unwrap_or(0);
        let is_full = |part: &Part| part.entries.len() + longest * group > most_entries;
        if parts.last().is_none_or(is_full) {
            parts.push(Part { first, count: 0, starts: vec![0], entries: Vec::new() });
        }
        let Some(part) = parts.last_mut() else { continue };
        let start = part.entries.len();
        part.entries.resize(start + longest * group, NOTHING);
        for (lane, i) in points.clone().enumerate() {
            for (n, place) in places[starts[i]..starts[i + 1]].iter().enumerate() {
                part.entries[start + n * group + lane] = *place;
            }
        }
        part.starts.push(part.entries.len() as u32);
        part.count += points.len();
    }
    parts
}

/// Bytes of a vector of `count` entries.
pub(super) fn vector_bytes(count: usize) -> u64 {
    (count * size_of::<Four>()) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_hold_every_entry_once_however_they_are_cut() {
        let counts: Vec<usize> = (0..300).map(|i| i * 7 % 5).collect();
        let mut starts = vec![0];
        counts.iter().for_each(|count| starts.push(starts[starts.len() - 1] + count));
        let places: Vec<u32> = (0..starts[300] as u32).collect();
        for most in [1, 300, 600, 1 << 20] {
            let parts = sliced(&starts, &places, most);
            let mut found = vec![Vec::new(); 300];
            for part in &parts {
                for i in 0..part.count {
                    let (slice, lane) = (i / 64, i % 64);
                    let entries = &part.entries[part.starts[slice] as usize..part.starts[slice + 1] as usize];
                    let own = entries.iter().skip(lane).step_by(64).filter(|entry| **entry != NOTHING);
                    found[part.first + i].extend(own.copied());
                }
            }
            for (i, own) in found.iter().enumerate() {
                assert_eq!(own.as_slice(), &places[starts[i]..starts[i + 1]], "{most}");
            }
        }
    }
}
