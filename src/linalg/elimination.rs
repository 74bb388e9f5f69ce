//! Linear equations with few unknowns each, solved exactly for some unknowns in terms of the others.
//!
//! Every equation is reduced by those before it, and then solved for the unknown with the largest coefficient that is left. At the
//! end all unknowns are affine functions `x = Z y + c` of the free ones, `y`: whatever `y` is, the equations hold.

use std::collections::BTreeMap;

/// A coefficient below this, in an equation whose coefficients had unit length, is what round-off left.
const VANISHED: f64 = 1e-10;

/// An equation without coefficients contradicts the others where its right-hand side is above this multiple of the size given.
const CONTRADICTION: f64 = 1e-9;

/// Equations being collected.
#[derive(Clone, Debug)]
pub struct Equations {
    unknown_count: usize,
    /// How large unknowns are: what right-hand sides are compared with.
    size: f64,
    /// For each equation kept its unknown, and its value in terms of others that come free or are solved for later.
    pivots: Vec<(u32, Affine)>,
    /// Which equation solves for an unknown.
    solved_by: Vec<Option<u32>>,
}

/// What an equation says of those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Added {
    /// It is new.
    Independent,
    /// It follows from those before.
    Dependent,
    /// It contradicts them, and is left out.
    Contradicting,
}

/// `constant + Σ coefficient · unknown`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Affine {
    /// Unknowns, ascending, and their coefficients.
    pub terms: Vec<(u32, f64)>,
    /// What is added.
    pub constant: f64,
}

impl Equations {
    /// None yet. `size` is how large the unknowns are about.
    pub fn new(unknown_count: usize, size: f64) -> Self {
        Self { unknown_count, size, pivots: Vec::new(), solved_by: vec![None; unknown_count] }
    }

    /// Adds `Σ coefficient · unknown = right`; unknowns may repeat, and are below the count.
    pub fn add(&mut self, terms: &[(u32, f64)], right: f64) -> Added {
        let norm = terms.iter().map(|(_, a)| a * a).sum::<f64>().sqrt();
        let scale = if norm > 0.0 { 1.0 / norm } else { 1.0 };
        // Σ terms + constant = 0.
        let mut left = Affine { terms: terms.iter().map(|&(i, a)| (i, scale * a)).collect(), constant: -scale * right };
        left = self.substituted(left);
        let largest = left
            .terms
            .iter()
            .copied()
            .fold((0, 0.0_f64), |best, term| if term.1.abs() > best.1.abs() { term } else { best });
        if largest.1.abs() <= VANISHED {
            let is_met = left.constant.abs() <= CONTRADICTION * self.size;
            return if is_met { Added::Dependent } else { Added::Contradicting };
        }
        let (pivot, coefficient) = largest;
        let others = left.terms.iter().filter(|(i, a)| *i != pivot && a.abs() > VANISHED * VANISHED);
        let solved = Affine {
            terms: others.map(|&(i, a)| (i, -a / coefficient)).collect(),
            constant: -left.constant / coefficient,
        };
        self.solved_by[pivot as usize] = Some(self.pivots.len() as u32);
        self.pivots.push((pivot, solved));
        Added::Independent
    }

    /// Unknowns solved for are replaced until none is left. An unknown solved for is expressed by others that were not solved for
    /// then, so that each replacement leads to later equations only, and there is an end.
    fn substituted(&self, affine: Affine) -> Affine {
        let mut sum: BTreeMap<u32, f64> = BTreeMap::new();
        // By the equation that solves for it, so that each is taken once, after all that lead to it.
        let mut waiting: BTreeMap<u32, f64> = BTreeMap::new();
        let mut constant = affine.constant;
        let put = |sum: &mut BTreeMap<u32, f64>, waiting: &mut BTreeMap<u32, f64>, i: u32, a: f64| {
            *match self.solved_by[i as usize] {
                None => sum.entry(i),
                Some(k) => waiting.entry(k),
            }
            .or_insert(0.0) += a;
        };
        affine.terms.iter().for_each(|&(i, a)| put(&mut sum, &mut waiting, i, a));
        while let Some((k, factor)) = waiting.pop_first() {
            let solved = &self.pivots[k as usize].1;
            constant += factor * solved.constant;
            solved.terms.iter().for_each(|&(i, a)| put(&mut sum, &mut waiting, i, factor * a));
        }
        Affine { terms: sum.into_iter().collect(), constant }
    }

    /// All unknowns in terms of the free ones.
    pub fn solve(&self) -> Elimination {
        let mut number = vec![None; self.unknown_count];
        let mut free = Vec::new();
        for i in 0..self.unknown_count {
            if self.solved_by[i].is_none() {
                number[i] = Some(free.len() as u32);
                free.push(i as u32);
            }
        }
        let of = |i: usize| match self.solved_by[i] {
            None => Affine { terms: vec![(i as u32, 1.0)], constant: 0.0 },
            Some(k) => self.substituted(self.pivots[k as usize].1.clone()),
        };
        let renumbered = |affine: Affine| Affine {
            terms: affine.terms.into_iter().filter_map(|(i, a)| number[i as usize].map(|k| (k, a))).collect(),
            ..affine
        };
        Elimination { unknowns: (0..self.unknown_count).map(of).map(renumbered).collect(), free }
    }
}

/// All unknowns as affine functions of the free ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Elimination {
    unknowns: Vec<Affine>,
    free: Vec<u32>,
}

impl Elimination {
    /// Which unknowns are free.
    pub fn free(&self) -> &[u32] {
        &self.free
    }

    /// An unknown, its terms numbered by the places in [`Elimination::free`].
    pub fn unknown(&self, i: usize) -> &Affine {
        &self.unknowns[i]
    }

    /// All unknowns for values of the free ones.
    pub fn expand(&self, free: &[f64]) -> Vec<f64> {
        let value =
            |affine: &Affine| affine.constant + affine.terms.iter().map(|&(k, a)| a * free[k as usize]).sum::<f64>();
        self.unknowns.iter().map(value).collect()
    }

    /// `Zᵀ v`: the gradient by the free unknowns from that by all.
    pub fn reduce(&self, v: &[f64]) -> Vec<f64> {
        let mut reduced = vec![0.0; self.free.len()];
        for (affine, value) in self.unknowns.iter().zip(v) {
            affine.terms.iter().for_each(|&(k, a)| reduced[k as usize] += a * value);
        }
        reduced
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_of_equations_hold_whatever_the_free_unknowns_are() {
        // x_{i+1} − x_i + 0.3 x_{i+2} = i, in an order that makes earlier pivots depend on later ones.
        let count = 40;
        let mut equations = Equations::new(count, 1.0);
        let row = |i: usize| [(i as u32 + 1, 1.0), (i as u32, -1.0), (i as u32 + 2, 0.3)];
        let order: Vec<usize> = (0..count - 2).map(|k| (k * 7) % (count - 2)).collect();
        for &i in &order {
            assert_eq!(equations.add(&row(i), i as f64), Added::Independent);
        }
        assert_eq!(equations.add(&[(1, 2.0), (0, -1.0), (2, 0.6), (0, -1.0)], 0.0), Added::Dependent);
        assert_eq!(equations.add(&row(3), 3.1), Added::Contradicting);
        assert_eq!(
            (equations.add(&[], 0.0), equations.add(&[(3, 0.0)], 1.0)),
            (Added::Dependent, Added::Contradicting)
        );
        let solved = equations.solve();
        assert_eq!(solved.free().len(), 2);
        let x = solved.expand(&[0.7, -1.3]);
        let largest = x.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        for i in 0..count - 2 {
            let left: f64 = row(i).iter().map(|&(j, a)| a * x[j as usize]).sum();
            assert!((left - i as f64).abs() < 1e-13 * largest, "{i}: {left}");
        }
        for (k, &i) in solved.free().iter().enumerate() {
            assert_eq!(x[i as usize], [0.7, -1.3][k]);
        }
        // Zᵀ is the transpose: v · (Z y) = (Zᵀ v) · y.
        let v: Vec<f64> = (0..count).map(|i| (i as f64).sin()).collect();
        let zero = solved.expand(&[0.0, 0.0]);
        let left: f64 = (0..count).map(|i| v[i] * (x[i] - zero[i])).sum();
        let reduced = solved.reduce(&v);
        assert!((left - (0.7 * reduced[0] - 1.3 * reduced[1])).abs() < 1e-9 * largest);
    }
}
