use std::ops::ControlFlow;

use glam::DVec3;

use super::*;
use crate::mesh::curve::{CubicBasis, End};
use crate::mesh::reference::{ParametricSurface, ReferenceMesh, SurfaceJet};
use crate::mesh::{TriangleMesh, patterns};

fn on(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The surface over [−1, 1] × [−h, h] of z = xy + c (x³ − 3xy²).
fn saddle(cubic: f64, half: f64) -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
    let jet = move |x: f64, y: f64| SurfaceJet {
        point: DVec3::new(x, y, x * y + cubic * (x.powi(3) - 3.0 * x * y * y)),
        first: [
            DVec3::new(1.0, 0.0, y + cubic * (3.0 * x * x - 3.0 * y * y)),
            DVec3::new(0.0, 1.0, x - 6.0 * cubic * x * y),
        ],
        second: [6.0 * cubic * x * DVec3::Z, (1.0 - 6.0 * cubic * y) * DVec3::Z, -6.0 * cubic * x * DVec3::Z],
    };
    ParametricSurface::new([[-1.0, 1.0], [-half, half]], [41, 41], jet).unwrap()
}

/// Numbers between −1 and 1 that look random.
fn noise(seed: usize) -> impl FnMut() -> f64 {
    let mut state = (seed as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Strips between rows of the surface, with rulings over x = const, all but the corners moved by noise.
fn rows<F: Fn(f64, f64) -> SurfaceJet + Sync>(
    surface: &ParametricSurface<F>,
    ys: &[f64],
    count: usize,
    amount: f64,
) -> Vec<Strip> {
    let basis = CubicBasis::new(count, false).unwrap();
    let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
    let x = |i: usize| 2.0 * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / (3.0 * spans) - 1.0;
    let mut noise = noise(7);
    let mut row = |y: f64| -> Vec<DVec3> {
        let point = |i: usize| {
            let shift = DVec3::new(noise(), noise(), noise());
            let is_end = i == 0 || i == count - 1;
            surface.at(x(i), y).point + if is_end { DVec3::ZERO } else { amount * shift }
        };
        (0..count).map(point).collect()
    };
    ys.windows(2).map(|pair| Strip::new(basis.clone(), [row(pair[0]), row(pair[1])]).unwrap()).collect()
}

/// The largest distance of samples of the strips to the surface, those within its boundary, and of the surface's to the strips.
fn deviations(strips: &[Strip], surface: &dyn ReferenceSurface, samples: &[DVec3]) -> [f64; 2] {
    let of_strip = |strip: &Strip| strip.mesh(61, 9).unwrap().points;
    let feet = strips.iter().flat_map(of_strip).map(|p| (p, surface.nearest(p)));
    let there = feet.filter(|(_, foot)| foot.overhang < 1e-9).map(|(p, foot)| p.distance(foot.point));
    let surfaces: Vec<_> = strips.iter().map(|strip| strip.surface().unwrap()).collect();
    let back = samples.iter().map(|&p| {
        surfaces.iter().map(|s| s.nearest(p).point.distance(p)).fold(f64::INFINITY, f64::min)
    });
    [there.fold(0.0, f64::max), back.fold(0.0, f64::max)]
}

/// Values fall strictly, and each step has the decrease of Armijo.
fn falls(found: &Optimised) -> bool {
    found.history.windows(2).all(|pair| {
        let [before, after] = [&pair[0], &pair[1]];
        after.value < before.value && after.value <= before.value - 1e-4 * after.taken * after.promised
    })
}

/// Ends fixed and nothing else that holds strips back.
static NO_JOINTS: Joints = Joints { pairs: Vec::new(), is_shared: false };

const BARE: Options = Options {
    weights: Weights { proximity: 1.0, beyond: 1e-2, gap: 1.0, coverage: 0.0, thin_plate: 0.0, proximal: 0.0 },
    bounds: Bounds { largest_deviation: None, least_width: None },
    samples: [4, 5],
    max_iterations: 50,
    tolerance: 1e-12,
};

fn task<'a>(strips: &'a [Strip], reference: &'a dyn ReferenceSurface, joints: &'a Joints, conditions: &'a [Condition]) -> Task<'a> {
    Task { strips, joints, reference, cover: &[], conditions }
}

#[test]
fn the_saddle_is_one_strip_exactly() {
    let surface = saddle(0.0, 1.0);
    let size = surface.diagonal();
    for count in [4, 11] {
        let strips = rows(&surface, &[-1.0, 1.0], count, 0.05);
        let conditions = Condition::fixed_ends(&strips);
        let cover: Vec<DVec3> = surface.mesh(21, 21).unwrap().points;
        let options = Options { weights: Weights { coverage: 1.0, ..BARE.weights }, ..BARE };
        let task = Task { cover: &cover, ..task(&strips, &surface, &NO_JOINTS, &conditions) };
        let found = optimise(task, &options, &mut on).unwrap();
        eprintln!("{count} {:?} {:?}", found.stop, found.history.iter().map(|h| (h.value, h.taken, h.moved)).collect::<Vec<_>>());
        assert!(falls(&found));
        assert!(found.last().parts.proximity <= 1e-20, "{:?}", found.history);
        let [there, back] = deviations(&found.strips, &surface, &cover);
        assert!(there <= 1e-10 * size && back <= 1e-10 * size, "{there} {back}");
    }
}

#[test]
fn freeform_width() {
    let surface = saddle(0.1, 0.8);
    for (count, expected) in [(1, 0.133), (2, 0.034), (4, 0.0085)] {
        let ys: Vec<f64> = (0..=count).map(|i| -0.8 + 1.6 * i as f64 / count as f64).collect();
        let strips = rows(&surface, &ys, 11, 0.02);
        let conditions = Condition::fixed_ends(&strips);
        let cover: Vec<DVec3> = surface.mesh(21, 21).unwrap().points;
        for conditions in [&conditions[..], &[]] {
        let joints = Joints::chain(count);
        let task = Task { cover: &cover, ..task(&strips, &surface, &joints, conditions) };
        let found = optimise(task, &Options::default(), &mut on).unwrap();
        let [there, back] = deviations(&found.strips, &surface, &cover);
        eprintln!("{count} {expected} {there} {back} {:?} {:?}", found.stop, found.history.iter().map(|h| (h.value, h.taken, h.moved, h.largest_gap)).collect::<Vec<_>>());}
    }
}

#[test]
fn gradients_are_those_of_the_value() {
    let surface = saddle(0.1, 0.8);
    let cover: Vec<DVec3> = surface.mesh(11, 11).unwrap().points;
    let ys = [-0.75, 0.1, 0.7];
    for amount in [0.02, 0.1] {
    let strips = rows(&surface, &ys, 6, amount);
    let joints = Joints::chain(2);
    for (name, weights) in [("proximity", [1.0, 0.0, 0.0, 0.0]), ("gap", [0.0, 1.0, 0.0, 0.0]), ("coverage", [0.0, 0.0, 1.0, 0.0]), ("way", [0.0, 0.0, 0.0, 1.0])] {
        let [proximity, gap, coverage, way] = weights;
        let weights = Weights { proximity, beyond: 0.5, gap, coverage, thin_plate: way, proximal: way };
        let (layout, start) = Layout::new(&strips, &joints).unwrap();
        let aim = Aim { reference: &surface, cover: &cover, joints: &joints };
        let terms = Terms::new(aim, (layout, start.clone()), weights, [4, 5]).unwrap();
        let mut noise = noise(3);
        let points: Vec<DVec3> = start.iter().map(|p| *p + 0.02 * DVec3::new(noise(), noise(), noise())).collect();
        let at = terms.evaluate(&points).unwrap();
        let gradient = super::super::system::flat(&super::super::system::gradient(&terms, &at, &points));
        let x = super::super::system::flat(&points);
        let largest = gradient.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        let mut worst = 0.0_f64;
        for i in 0..x.len() {
            let value = |h: f64| {
                let mut x = x.clone();
                x[i] += h;
                terms.evaluate(&points_of(&x)).unwrap().parts.total()
            };
            let h = 1e-5;
            let e = ((value(h) - value(-h)) / (2.0 * h) - gradient[i]).abs() / largest;
            if e > 1e-4 { eprintln!("{i} {e} {} {} {}", value(h), value(-h), value(0.0)); }
            worst = worst.max(e);
        }
        eprintln!("{name} {amount} {worst}");
    }
    }
}
