//! Bounds on strips: inequalities, by quadratic programs.
//!
//! A bound can be out of reach, and is not kept by the start. So the largest excess `t ≥ 0` over all bounds is a variable, and what
//! falls is `F + t/D` with the size `D`: a penalty that is exact, since moving a strip by a part of `D` changes `F`, a mean of
//! squares in units of `D`, by far less than that part. Bounds are kept wherever they can be (Nocedal & Wright 2006, section 18.5).

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver,
    SolverStatus::{AlmostSolved, Solved},
    SupportedConeT::NonnegativeConeT,
};
use glam::DVec3;

use super::Strip;
use super::layout::Layout;
use super::system::Model;
use super::terms::Evaluation;
use crate::error::{Error, Result, Status, finite};
use crate::linalg::elimination::Elimination;

/// The tolerance of the quadratic programs.
const TOLERANCE: f64 = 1e-10;

/// Samples whose deviation is below this part of its bound, and rulings longer than its inverse times theirs, are left out of a
/// quadratic program: a step that brings one of them to its bound is cut by the line search.
const NEAR: f64 = 0.25;

/// Rulings whose length counts, for each span.
const RULINGS_PER_SPAN: usize = 4;

/// Bounds, each if any; in model units, above 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// The largest distance of samples of the strips to the reference surface.
    pub largest_deviation: Option<f64>,
    /// The least length of a ruling: of the strip's width.
    pub least_width: Option<f64>,
}

impl Bounds {
    pub(super) fn check(&self) -> Result<()> {
        let named = [("largest_deviation", self.largest_deviation), ("least_width", self.least_width)];
        for (name, bound) in named {
            let place = format!("bounds.{name}");
            if let Some(bound) = bound
                && finite(&place, bound)? <= 0.0
            {
                let reason = format!("expected a number above 0, found {bound}");
                return Err(Error::new(Status::InvalidValue, reason).at(place));
            }
        }
        Ok(())
    }

    pub(super) fn is_any(&self) -> bool {
        self.largest_deviation.is_some() || self.least_width.is_some()
    }

    /// By how much the bounds are exceeded, in model units.
    pub(super) fn excess(&self, at: &Evaluation, strips: &[Strip]) -> f64 {
        let deviation = self.largest_deviation.map_or(0.0, |bound| at.largest_deviation - bound);
        let width = self.least_width.map_or(0.0, |bound| bound - least_width(strips));
        deviation.max(width).max(0.0)
    }
}

fn parameters(strip: &Strip) -> impl Iterator<Item = f64> + '_ {
    (0..=RULINGS_PER_SPAN * strip.basis().spans()).map(|k| k as f64 / RULINGS_PER_SPAN as f64)
}

/// The shortest of the rulings that count.
fn least_width(strips: &[Strip]) -> f64 {
    let width = |strip: &Strip, u| {
        let [a, b] = strip.ruling(u);
        a.distance(b)
    };
    strips.iter().flat_map(|strip| parameters(strip).map(move |u| width(strip, u))).fold(f64::INFINITY, f64::min)
}

/// `coefficients · step ≤ room + t`.
struct Row {
    coefficients: Vec<(u32, f64)>,
    room: f64,
}

/// A step, and the excess that it is to leave, in model units.
pub(super) struct Bounded {
    pub(super) step: Vec<f64>,
    pub(super) excess: f64,
}

/// The step to the least value of the model plus the excess over the size; none if no quadratic program is solved.
pub(super) fn step(
    bounds: &Bounds,
    model: &Model,
    (at, strips): (&Evaluation, &[Strip]),
    (layout, elimination): (&Layout, &Elimination),
    size: f64,
) -> Option<Bounded> {
    let mut rows = Vec::new();
    let mut add = |at: &[(u32, f64)], direction: DVec3, room: f64| {
        let mut coefficients: Vec<(u32, f64)> = Vec::new();
        for &(point, weight) in at.iter().filter(|(_, weight)| *weight != 0.0) {
            for axis in 0..3 {
                let terms = &elimination.unknown(3 * point as usize + axis).terms;
                coefficients.extend(terms.iter().map(|&(k, a)| (k, weight * a * direction[axis])));
            }
        }
        rows.push(Row { coefficients, room });
    };
    if let Some(bound) = bounds.largest_deviation {
        for foot in at.feet.iter().filter(|foot| !foot.is_beyond && foot.height.abs() > NEAR * bound) {
            let points: Vec<(u32, f64)> = foot.at.0.into_iter().zip(foot.at.1).collect();
            add(&points, foot.direction, bound - foot.height);
            add(&points, -foot.direction, bound + foot.height);
        }
    }
    if let Some(bound) = bounds.least_width {
        for (i, strip) in strips.iter().enumerate() {
            for u in parameters(strip) {
                let [a, b] = strip.ruling(u);
                let Some(direction) = (b - a).try_normalize().filter(|_| a.distance(b) * NEAR < bound) else {
                    continue;
                };
                let ends = [(layout.weights(i, u, 0.0), 1.0), (layout.weights(i, u, 1.0), -1.0)];
                let point = |((points, weights), sign): (([u32; 8], [f64; 8]), f64)| {
                    points.into_iter().zip(weights.map(|weight| sign * weight))
                };
                let points: Vec<(u32, f64)> = ends.into_iter().flat_map(point).collect();
                // A ruling is at least as long as its part along where it was.
                add(&points, direction, a.distance(b) - bound);
            }
        }
    }
    solve(model, &rows, size)
}

/// Unknowns are in units of the size, and the whole is scaled to second derivatives about 1.
fn solve(model: &Model, rows: &[Row], size: f64) -> Option<Bounded> {
    let count = model.gradient.len();
    let scale = 1.0 / (model.mean_diagonal() * size * size);
    let (mut i, mut j, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for &(k, l, value) in &model.entries {
        i.push(l as usize);
        j.push(k as usize);
        values.push(scale * size * size * value);
    }
    let p = CscMatrix::new_from_triplets(count + 1, count + 1, i, j, values);
    let mut q: Vec<f64> = model.gradient.iter().map(|g| scale * size * g).collect();
    q.push(scale);
    let (mut i, mut j, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (number, row) in rows.iter().enumerate() {
        for &(k, value) in &row.coefficients {
            i.push(number);
            j.push(k as usize);
            values.push(value);
        }
        i.push(number);
        j.push(count);
        values.push(-1.0);
    }
    i.push(rows.len());
    j.push(count);
    values.push(-1.0);
    let a = CscMatrix::new_from_triplets(rows.len() + 1, count + 1, i, j, values);
    let mut b: Vec<f64> = rows.iter().map(|row| row.room / size).collect();
    b.push(0.0);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(TOLERANCE)
        .tol_gap_rel(TOLERANCE)
        .tol_feas(TOLERANCE)
        .build()
        .ok()?;
    let mut solver = DefaultSolver::new(&p, &q, &a, &b, &[NonnegativeConeT(b.len())], settings).ok()?;
    solver.solve();
    let is_solved = matches!(solver.solution.status, Solved | AlmostSolved);
    let x: Vec<f64> = solver.solution.x.iter().map(|x| size * x).collect();
    let is_finite = x.iter().all(|x| x.is_finite());
    (is_solved && is_finite).then(|| Bounded { excess: x[count].max(0.0), step: x[..count].to_vec() })
}
