//! What the tests of kernels share: random constraints, projected by both backends.

use glam::DVec3;
use shapeop::solver::{Backend, Solver};

use crate::has_adapter;

/// Of the constraint's diameter: how near the card's answers are to be.
pub const NEAR: f64 = 1e-5;

/// Numbers of constraints around the sizes of workgroups, and many.
pub const COUNTS: [usize; 6] = [0, 1, 63, 64, 65, 10_001];

/// Random numbers that are the same on every run.
pub struct Random(u64);

/// One constraint on points of its own.
#[derive(Clone)]
pub struct Sample {
    pub points: Vec<DVec3>,
    /// `None`: the defaults.
    pub scalars: Option<Vec<f64>>,
    /// Where the points are when the constraint is created; `None`: as they are.
    pub rest: Option<Vec<DVec3>>,
}

/// A sample with what both backends made of it.
pub struct Compared<'a> {
    pub sample: &'a Sample,
    /// The scalars in force.
    pub scalars: Vec<f64>,
    pub cpu: Vec<DVec3>,
    pub gpu: Vec<DVec3>,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The finaliser of SplitMix64.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Uniform in `low..high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// One of `0..count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Uniform in the cube of half side 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0))
    }

    /// A size between 1e-3 and 1e3, all magnitudes alike.
    pub fn size(&mut self) -> f64 {
        10_f64.powf(self.within(-3.0, 3.0))
    }
}

/// The largest distance of a point from the first.
pub fn diameter(points: &[DVec3]) -> f64 {
    points.iter().map(|point| point.distance(points[0])).fold(0.0, f64::max)
}

/// A solver with one constraint of `type_name` for each sample, and its points as they are to be projected.
pub fn solver_of(type_name: &str, samples: &[Sample]) -> Solver {
    let mut solver = Solver::new();
    let rest: Vec<DVec3> = samples.iter().flat_map(|s| s.rest.as_ref().unwrap_or(&s.points)).copied().collect();
    let points: Vec<DVec3> = samples.iter().flat_map(|s| &s.points).copied().collect();
    solver.set_points(&rest).unwrap();
    let mut first = 0;
    for sample in samples {
        let indices: Vec<u32> = (first..).take(sample.points.len()).collect();
        first += sample.points.len() as u32;
        let id = solver.add_constraint(type_name, &indices, 1.0).unwrap();
        if let Some(scalars) = &sample.scalars {
            solver.edit_constraint(type_name, id, scalars).unwrap();
        }
    }
    solver.set_points(&points).unwrap();
    solver
}

/// Projects the samples on both backends and hands each to `judge`, which panics where the card's answer is wrong.
pub fn compare(type_name: &str, samples: &[Sample], mut judge: impl FnMut(usize, &Compared<'_>)) {
    if !has_adapter() {
        return;
    }
    let solver = solver_of(type_name, samples);
    let (cpu, gpu) = (solver.projections(Backend::Cpu).unwrap(), solver.projections(Backend::Gpu).unwrap());
    assert_eq!((cpu.len(), gpu.len()), (samples.len(), samples.len()));
    for (id, sample) in samples.iter().enumerate() {
        let scalars = solver.constraint(id).unwrap().scalars.to_vec();
        assert!(gpu[id].iter().all(|target| target.is_finite()), "{type_name} {id}: {:?}", gpu[id]);
        judge(id, &Compared { sample, scalars, cpu: cpu[id].clone(), gpu: gpu[id].clone() });
    }
}

/// What else than near the processor's answer the card's may be: where another is feasible and as near, to [`NEAR`] ...
pub const AS_GOOD: &str = "as feasible and as near";

/// ... and where the processor's own changes as much when points are moved by round-off.
pub const ILL_CONDITIONED: &str = "that round-off moves as far";

/// Says how the samples of one type came out where they are many: `cargo xtask show gpu` repeats it. `worst` is the largest
/// difference in sizes of a constraint, of all but `others`, which are told by number and kind.
pub fn account(type_name: &str, count: usize, worst: f64, others: &[(usize, &str)]) {
    if COUNTS.ends_with(&[count]) {
        let told = others.iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!(", {count} {kind}"));
        println!("kernel {type_name}: {count} constraints, within {worst:.1e}{}", told.collect::<String>());
    }
}

impl Compared<'_> {
    /// The largest distance between the targets of the two.
    pub fn difference(&self) -> f64 {
        self.cpu.iter().zip(&self.gpu).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }
}
