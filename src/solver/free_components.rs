//! Points that constraints hold together and that nothing holds against translation.

use crate::constraints::{ConstraintSet, Rows};

/// Row coefficients that add up to less than this multiple of their absolute sum leave translations free.
const TRANSLATION_FREE: f64 = 1e-9;

/// Points that constraints hold together and that nothing holds against translation.
pub(super) struct FreeComponent {
    /// Ascending; the first is held while solving.
    pub(super) points: Vec<u32>,
    /// What holds it: as much as its own diagonal entry; 0 where a proximal step takes care of translations too.
    pub(super) held_stiffness: f64,
}

/// The components that rows with coefficients leave free to translate, without the points that have no row at all.
pub(super) fn free_components(
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    unconstrained: &[u32],
    point_count: usize,
) -> Vec<FreeComponent> {
    let mut parents: Vec<u32> = (0..point_count as u32).collect();
    let mut is_held = vec![false; point_count];
    fn root(parents: &mut [u32], mut i: u32) -> u32 {
        while parents[i as usize] != i {
            parents[i as usize] = parents[parents[i as usize] as usize];
            i = parents[i as usize];
        }
        i
    }
    let mut join = |points: &mut dyn Iterator<Item = u32>| {
        if let Some(first) = points.next() {
            for point in points {
                let (a, b) = (root(&mut parents, first), root(&mut parents, point));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
    };
    for ((batch, _), stiffness) in constraints.batches().zip(stiffness) {
        for (slot, _) in stiffness.iter().enumerate().filter(|(_, s)| **s > 0.0) {
            let indices = batch.indices(slot);
            match batch.info().rows {
                Rows::Centred => join(&mut indices.iter().copied()),
                Rows::Pairs => indices.chunks_exact(2).for_each(|pair| join(&mut pair.iter().copied())),
                Rows::Linear(_) => {}
            }
            for row in batch.rows(slot).chunks_exact(indices.len()) {
                let touched = || indices.iter().zip(row).filter(|(_, a)| **a != 0.0).map(|(&i, _)| i);
                join(&mut touched());
                let (sum, size) = (row.iter().sum::<f64>(), row.iter().map(|a| a.abs()).sum::<f64>());
                if sum.abs() > TRANSLATION_FREE * size {
                    touched().for_each(|point| is_held[point as usize] = true);
                }
            }
        }
    }
    let mut component_of = vec![usize::MAX; point_count];
    let mut components: Vec<(FreeComponent, bool)> = Vec::new();
    let mut skip = unconstrained.iter().peekable();
    for point in 0..point_count as u32 {
        if skip.next_if_eq(&&point).is_some() {
            continue;
        }
        let slot = &mut component_of[root(&mut parents, point) as usize];
        if *slot == usize::MAX {
            *slot = components.len();
            components.push((FreeComponent { points: Vec::new(), held_stiffness: 0.0 }, false));
        }
        let (component, is_component_held) = &mut components[*slot];
        component.points.push(point);
        *is_component_held |= is_held[point as usize];
    }
    components.into_iter().filter(|(_, is_held)| !is_held).map(|(component, _)| component).collect()
}
