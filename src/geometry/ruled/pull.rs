//! What draws control points: squared lengths of linear functions of them, and the quadratic model of their sum.

use glam::{DMat3, DVec3};

/// A squared distance at a point that is a sum of control points with weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// The unknown points; weights of 0 for those there are too many.
    pub(super) points: [u32; 8],
    /// How much of each the point has.
    pub(super) weights: [f64; 8],
    /// The squared distance, times its weight in the whole.
    pub(super) value: f64,
    /// Its gradient by the point.
    pub(super) slope: DVec3,
    /// A matrix for its second derivatives by the point, symmetric, with no negative eigenvalue, whose range holds the slope: the
    /// model then has a least value.
    pub(super) curvature: DMat3,
}

impl Pull {
    /// `weight ‖apart‖²`, where `apart` but for round-off is in the range of the projection `directions`: only those count as
    /// curved.
    pub(super) fn new(at: ([u32; 8], [f64; 8]), weight: f64, apart: DVec3, directions: DMat3) -> Self {
        Self {
            points: at.0,
            weights: at.1,
            value: weight * apart.length_squared(),
            slope: 2.0 * weight * (directions * apart),
            curvature: 2.0 * weight * directions,
        }
    }

    /// `weight height²`, the gradient of `height` being given.
    pub(super) fn of_height(at: ([u32; 8], [f64; 8]), weight: f64, height: f64, gradient: DVec3) -> Self {
        Self {
            points: at.0,
            weights: at.1,
            value: weight * height * height,
            slope: 2.0 * weight * height * gradient,
            curvature: 2.0 * weight * along(gradient),
        }
    }
}

/// `d dᵀ`.
pub(super) fn along(d: DVec3) -> DMat3 {
    DMat3::from_cols(d * d.x, d * d.y, d * d.z)
}

/// `I − d dᵀ`.
pub(super) fn across(d: DVec3) -> DMat3 {
    DMat3::IDENTITY - along(d)
}

/// A quadratic form of points that is the same in each coordinate: `Σ k_ij z_i · z_j`.
#[derive(Clone, Debug, Default)]
pub(super) struct Form {
    /// `(i, j, k_ij)` with `j ≤ i`, ascending, each pair once; `k_ij` stands for both orders.
    pub(super) entries: Vec<(u32, u32, f64)>,
}

impl Form {
    pub(super) fn value(&self, z: &[DVec3]) -> f64 {
        let term = |&(i, j, k): &(u32, u32, f64)| {
            let double = if i == j { 1.0 } else { 2.0 };
            double * k * z[i as usize].dot(z[j as usize])
        };
        self.entries.iter().map(term).sum()
    }

    /// Adds its gradient.
    pub(super) fn add_gradient(&self, z: &[DVec3], gradient: &mut [DVec3]) {
        for &(i, j, k) in &self.entries {
            let (i, j) = (i as usize, j as usize);
            gradient[i] += 2.0 * k * z[j];
            if i != j {
                gradient[j] += 2.0 * k * z[i];
            }
        }
    }
}

/// A symmetric matrix of blocks of 3 by 3, one for each pair of points: row `i` has the blocks `(i, j)` with `j ≤ i`.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    pub(super) rows: Vec<Vec<(u32, DMat3)>>,
}

impl Blocks {
    pub(super) fn new(point_count: usize) -> Self {
        Self { rows: vec![Vec::new(); point_count] }
    }

    fn block(&mut self, i: u32, j: u32) -> &mut DMat3 {
        let row = &mut self.rows[i as usize];
        let place = row.partition_point(|&(column, _)| column < j);
        if row.get(place).is_none_or(|&(column, _)| column != j) {
            row.insert(place, (j, DMat3::ZERO));
        }
        &mut row[place].1
    }

    /// Adds the second derivatives of a pull.
    pub(super) fn add_pull(&mut self, pull: &Pull) {
        for a in 0..8 {
            for b in 0..8 {
                // Each ordered pair stands for one block; a point that is there twice makes each pair of its two places.
                let (i, j) = (pull.points[a], pull.points[b]);
                let factor = pull.weights[a] * pull.weights[b];
                if j <= i && factor != 0.0 {
                    *self.block(i, j) += factor * pull.curvature;
                }
            }
        }
    }

    /// Adds the second derivatives of a form.
    pub(super) fn add_form(&mut self, form: &Form) {
        for &(i, j, k) in &form.entries {
            *self.block(i, j) += DMat3::from_diagonal(DVec3::splat(2.0 * k));
        }
    }
}
