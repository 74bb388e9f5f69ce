use std::ops::ControlFlow;

use glam::DVec3;

use super::*;
use crate::error::Status;
use crate::geometry::ruled::coverage::NearestStrip;
use crate::geometry::ruled::start::{Rulings, StartOptions, start};
use crate::geometry::ruled::system::{flat, gradient};
use crate::mesh::curve::{CubicBasis, End};
use crate::mesh::reference::{ParametricSurface, ReferenceMesh, SurfaceJet};
use crate::mesh::{TriangleMesh, surfaces};

mod side_conditions;

fn on(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The surface over [−1, 1] × [−h, h] of z = xy + c (x³ − 3xy²).
fn saddle(cubic: f64, half: f64) -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
    saddle_over(cubic, [1.0, half])
}

fn saddle_over(cubic: f64, halves: [f64; 2]) -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
    ParametricSurface::new(halves.map(|half| [-half, half]), [41, 41], surfaces::bent_saddle(cubic)).unwrap()
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
    let search = NearestStrip::new(strips).unwrap();
    let back = samples.iter().map(|&p| search.nearest(p).point.distance(p));
    [there.fold(0.0, f64::max), back.fold(0.0, f64::max)]
}

/// Values fall strictly, and each step has the decrease of Armijo.
fn falls(found: &Optimised) -> bool {
    found.history.windows(2).all(|pair| {
        let [before, after] = [&pair[0], &pair[1]];
        after.value < before.value && after.value <= before.value - 1e-4 * after.taken * after.promised
    })
}

/// Nothing that holds else that holds strips back.
static NO_JOINTS: Joints = Joints { pairs: Vec::new(), is_shared: false, partial: Vec::new() };

const BARE: Options = Options {
    weights: Weights { proximity: 1.0, beyond: 1e-2, gap: 1.0, coverage: 0.0, thin_plate: 0.0, proximal: 0.0 },
    bounds: Bounds { largest_deviation: None, least_width: None },
    samples: [4, 5],
    max_iterations: 50,
    tolerance: 1e-12,
};

fn task<'a>(
    strips: &'a [Strip],
    reference: &'a dyn ReferenceSurface,
    joints: &'a Joints,
    conditions: &'a [Condition],
) -> Task<'a> {
    Task { strips, joints, reference, cover: &[], conditions }
}

#[test]
fn the_saddle_is_one_strip_exactly() {
    let surface = saddle(0.0, 1.0);
    let size = surface.diagonal();
    let cover = surface.mesh(21, 21).unwrap().points;
    for count in [4, 11] {
        let strips = rows(&surface, &[-1.0, 1.0], count, 0.05);
        let conditions = Condition::fixed_ends(&strips);
        let options = Options { weights: Weights { coverage: 1.0, ..BARE.weights }, ..BARE };
        let task = Task { cover: &cover, ..task(&strips, &surface, &NO_JOINTS, &conditions) };
        let found = optimise(task, &options, &mut on).unwrap();
        assert!(falls(&found) && found.free_count == 6 * count - 12);
        assert!(found.last().parts.proximity <= 1e-20 && found.history.len() <= 10, "{:?}", found.history);
        let [there, back] = deviations(&found.strips, &surface, &cover);
        assert!(there <= 1e-10 * size && back <= 1e-10 * size, "{there} {back}");
    }
}

#[test]
fn a_mesh_is_met_as_well_as_its_chords_are_the_surface() {
    let surface = saddle(0.0, 1.0);
    let mesh = TriangleMesh::new(&surface.mesh(41, 41).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&mesh);
    let cover = crate::geometry::ruled::terms::points_to_cover(&mesh, 400);
    assert_eq!(cover.len(), 400);
    let strips = rows(&surface, &[-1.0, 1.0], 8, 0.03);
    let conditions = Condition::fixed_ends(&strips);
    let task = Task { cover: &cover, ..task(&strips, &reference, &NO_JOINTS, &conditions) };
    let found = optimise(task, &Options::default(), &mut on).unwrap();
    let there = deviations(&found.strips, &reference, &[])[0];
    // A twist of 1 over half an edge both ways is a quarter of 0.05², on the normal less.
    assert!(falls(&found) && there <= 2.0 * 1.8e-4 * surface.diagonal(), "{there} {:?}", found.stop);
}

/// With fixed end rulings that are no asymptotic curves the deviation is of the second order of the width, and known.
#[test]
fn deviation_falls_with_the_square_of_the_width_where_end_rulings_are_fixed() {
    let surface = saddle(0.1, 0.8);
    let cover = surface.mesh(21, 21).unwrap().points;
    let mut last = None;
    for (count, expected) in [(1_u32, 0.133), (2, 0.034), (4, 0.0085)] {
        let ys: Vec<f64> = (0..=count).map(|i| -0.8 + 1.6 * f64::from(i) / f64::from(count)).collect();
        let strips = rows(&surface, &ys, 11, 0.02);
        let conditions = Condition::fixed_ends(&strips);
        let joints = Joints::chain(strips.len());
        let task = Task { cover: &cover, ..task(&strips, &surface, &joints, &conditions) };
        let found = optimise(task, &Options::default(), &mut on).unwrap();
        assert!(falls(&found));
        let there = deviations(&found.strips, &surface, &[])[0];
        assert!((there / expected - 1.0).abs() < 0.2, "{count}: {there}");
        assert!(last.is_none_or(|last: f64| last / there >= 3.5), "{last:?} {there}");
        last = Some(there);
    }
}

/// Where the asymptotic curve of z = xy + c (x³ − 3xy²) that runs across the rows leads from a point to a row: the direction (p, 1)
/// in the parameters has p² z_xx + 2 p z_xy + z_yy = 0, of whose roots it is the one that is near 0.
fn asymptotic(cubic: f64, from: DVec3, row: f64) -> DVec3 {
    let slope = |x: f64, y: f64| {
        let [a, b, c] = [6.0 * cubic * x, 1.0 - 6.0 * cubic * y, -6.0 * cubic * x];
        -c / (b + (b * b - a * c).sqrt())
    };
    let steps = 40;
    let (mut x, mut y, h) = (from.x, from.y, (row - from.y) / f64::from(steps));
    for _ in 0..steps {
        let k1 = slope(x, y);
        let k2 = slope(x + 0.5 * h * k1, y + 0.5 * h);
        let k3 = slope(x + 0.5 * h * k2, y + 0.5 * h);
        let k4 = slope(x + h * k3, y + h);
        x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        y += h;
    }
    DVec3::new(x, y, x * y + cubic * (x.powi(3) - 3.0 * x * y * y))
}

#[test]
fn deviation_falls_with_the_third_power_of_the_width_along_asymptotic_curves() {
    let cubic = 0.1;
    // Along these curves x grows with y: the first row is short, and all curves that start in it meet the others.
    let surface = saddle_over(cubic, [1.5, 0.85]);
    let middle = |i: u32| surface.at(0.05 * f64::from(i % 21) - 0.5, 0.08 * f64::from(i / 21) - 0.8).point;
    let cover: Vec<DVec3> = (0..21 * 21).map(middle).collect();
    let mut all = Vec::new();
    for count in [2_u32, 4, 8, 16] {
        let ys: Vec<f64> = (0..=count).map(|i| -0.8 + 1.6 * f64::from(i) / f64::from(count)).collect();
        let row = |y: &f64| -> Vec<DVec3> {
            let half = if *y == -0.8 { 0.6 } else { 1.4 };
            (0..=2000).map(|i| surface.at(half * (f64::from(i) / 1000.0 - 1.0), *y).point).collect()
        };
        let boundaries: Vec<Vec<DVec3>> = ys.iter().map(row).collect();
        let trace = |strip: usize, p: DVec3| Some(asymptotic(cubic, p, ys[strip + 1]));
        let options = StartOptions { control_count: 14, is_shared: true };
        let started = start(&boundaries, &vec![false; ys.len()], Rulings::Traced(&trace), options).unwrap();
        let joints = Joints { is_shared: true, ..Joints::chain(started.strips.len()) };
        let task = Task { cover: &cover, ..task(&started.strips, &surface, &joints, &[]) };
        let found = optimise(task, &Options::default(), &mut on).unwrap();
        assert!(falls(&found));
        let [there, back] = deviations(&found.strips, &surface, &cover);
        let before = deviations(&started.strips, &surface, &cover);
        let started = before[0].max(before[1]);
        assert!(there.max(back) <= started, "{before:?} {there} {back}");
        all.push([started, there.max(back)]);
    }
    // Wide strips gain more by being optimised, from two strips to four by a third.
    for (k, least) in [(0, [6.0; 3]), (1, [5.0, 6.0, 6.0])] {
        let factors = all.windows(2).map(|pair| pair[0][k] / pair[1][k]);
        assert!(factors.zip(least).all(|(factor, least)| factor >= least), "{all:?}");
    }
}

#[test]
fn a_helicoid_is_met_to_the_fourth_power_of_the_distance_of_knots() {
    let jet = |u: f64, v: f64| {
        let (e, f) = (DVec3::new(v.cos(), v.sin(), 0.0), DVec3::new(-v.sin(), v.cos(), 0.0));
        SurfaceJet {
            point: u * e + 0.8 * v * DVec3::Z,
            first: [e, u * f + 0.8 * DVec3::Z],
            second: [DVec3::ZERO, f, -u * e],
        }
    };
    let surface = ParametricSurface::new([[0.4, 1.6], [-0.2, 3.2]], [25, 61], jet).unwrap();
    let boundary = |u: f64| -> Vec<DVec3> { (0..=30_000).map(|i| jet(u, f64::from(i) / 10_000.0).point).collect() };
    let trace = |_: usize, p: DVec3| Some(DVec3::new(3.0 * p.x, 3.0 * p.y, p.z));
    let cover: Vec<DVec3> =
        (0..300).map(|i| jet(0.6 + 0.2 * f64::from(i % 5), 0.05 * f64::from(i / 5)).point).collect();
    let roots = |spans: usize| {
        let options = StartOptions { control_count: spans + 3, is_shared: false };
        let boundaries = [boundary(0.5), boundary(1.5)];
        let started = start(&boundaries, &[false; 2], Rulings::Traced(&trace), options).unwrap();
        let task = Task { cover: &cover, ..task(&started.strips, &surface, &NO_JOINTS, &[]) };
        let found = optimise(task, &Options::default(), &mut on).unwrap();
        assert!(falls(&found));
        [&found.history[0], found.last()].map(|iteration| iteration.parts.proximity.sqrt())
    };
    let (coarse, fine) = (roots(6), roots(12));
    assert!((0..2).all(|k| coarse[k] / fine[k] >= 10.0), "{coarse:?} {fine:?}");
}

#[test]
fn strips_do_not_shrink() {
    let surface = saddle(0.1, 0.8);
    let cover = surface.mesh(21, 21).unwrap().points;
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 11, 0.02);
    let joints = Joints::chain(2);
    let bare = task(&strips, &surface, &joints, &[]);
    let error = optimise(bare, &BARE, &mut on).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::InvalidValue, "strips[0]"));
    let fixed = Condition::fixed_ends(&strips[..1]);
    assert_eq!(optimise(Task { conditions: &fixed, ..bare }, &BARE, &mut on).unwrap_err().place(), "strips[1]");
    for cover in [&cover[..], &[]] {
        let found = optimise(Task { cover, ..bare }, &Options::default(), &mut on).unwrap();
        assert!(falls(&found));
        for (after, before) in found.strips.iter().zip(&strips) {
            assert!(after.area() >= 0.5 * before.area(), "{} {}", after.area(), before.area());
        }
        if !cover.is_empty() {
            let [there, back] = deviations(&found.strips, &surface, cover);
            assert!(there < 0.03 && back < 0.03, "{there} {back}");
        }
    }
}

#[test]
fn gaps_close_and_shared_boundaries_have_none() {
    let surface = saddle(0.05, 1.0);
    let cover = surface.mesh(21, 21).unwrap().points;
    let mut strips = rows(&surface, &[-1.0, 0.0], 11, 0.0);
    strips.extend(rows(&surface, &[0.01, 1.0], 11, 0.0));
    let joints = Joints::chain(2);
    let task = Task { cover: &cover, ..task(&strips, &surface, &joints, &[]) };
    let options = Options { max_iterations: 10, ..Options::default() };
    let found = optimise(task, &options, &mut on).unwrap();
    let gap = |strips: &[Strip]| {
        let curve = crate::mesh::curve::NearestOnCurve::new(strips[1].boundary(0)).unwrap();
        let apart = |[_, end]: &[DVec3; 2]| curve.nearest(*end).distance;
        strips[0].rulings(200).iter().map(apart).fold(0.0, f64::max)
    };
    assert!(gap(&strips) > 9e-3 && gap(&found.strips) <= 1e-4 * surface.diagonal(), "{}", gap(&found.strips));
    assert!((found.history[0].largest_gap / gap(&strips) - 1.0).abs() < 0.05);
    let shared = Joints { is_shared: true, ..joints.clone() };
    let one = optimise(Task { joints: &shared, ..task }, &options, &mut on).unwrap();
    assert_eq!((one.strips[0].control(1), one.last().largest_gap), (one.strips[1].control(0), 0.0));
    assert_eq!((one.free_count, found.free_count), (3 * 33, 3 * 44));
}

#[test]
fn gradients_are_those_of_the_value() {
    let surface = saddle(0.1, 0.8);
    let cover: Vec<DVec3> = surface.mesh(11, 11).unwrap().points;
    let joints = Joints::chain(2);
    for amount in [0.02, 0.1] {
        let strips = rows(&surface, &[-0.75, 0.1, 0.7], 6, amount);
        for weights in [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]] {
            let [proximity, gap, coverage, way] = weights;
            let weights = Weights { proximity, beyond: 0.5, gap, coverage, thin_plate: way, proximal: way };
            let (layout, start) = Layout::new(&strips, &joints).unwrap();
            let aim = Aim { reference: &surface, cover: &cover, joints: &joints };
            let terms = Terms::new(aim, (layout, start.clone()), weights, [4, 5]).unwrap();
            let mut noise = noise(3);
            let points: Vec<DVec3> = start.iter().map(|p| *p + 0.02 * DVec3::new(noise(), noise(), noise())).collect();
            let at = terms.evaluate(&points).unwrap();
            let (slopes, x) = (flat(&gradient(&terms, &at, &points)), flat(&points));
            let largest = slopes.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
            for i in 0..x.len() {
                let value = |h: f64| {
                    let mut x = x.clone();
                    x[i] += h;
                    terms.evaluate(&points_of(&x)).unwrap().parts.total()
                };
                let quotient = (value(1e-5) - value(-1e-5)) / 2e-5;
                assert!((quotient - slopes[i]).abs() <= 1e-6 * largest, "{weights:?} {i}: {quotient} {}", slopes[i]);
            }
        }
    }
}

#[test]
fn runs_are_cancelled_and_repeat_to_the_bit_on_any_number_of_threads() {
    let surface = saddle(0.1, 0.8);
    let cover = surface.mesh(15, 15).unwrap().points;
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 8, 0.02);
    let joints = Joints::chain(2);
    let task = Task { cover: &cover, ..task(&strips, &surface, &joints, &[]) };
    let options = Options { max_iterations: 6, ..Options::default() };
    let on_threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| optimise(task, &options, &mut on).unwrap())
    };
    let one = on_threads(1);
    assert_eq!(one, on_threads(3));
    assert_eq!((one.stop, one.history.len()), (Stop::MostIterations, 7));
    let cancelled = optimise(task, &options, &mut |progress| {
        if progress.iteration == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let cancelled = cancelled.unwrap();
    assert_eq!((cancelled.stop, &cancelled.history[..]), (Stop::Cancelled, &one.history[..3]));
    let place = |options: Options| optimise(task, &options, &mut on).unwrap_err().place().to_owned();
    assert_eq!(place(Options { samples: [0, 5], ..options }), "options.samples[0]");
    assert_eq!(place(Options { tolerance: f64::NAN, ..options }), "options.tolerance");
    let weights = Weights { proximity: 0.0, gap: 0.0, coverage: 0.0, ..Weights::default() };
    assert_eq!(place(Options { weights, ..options }), "options.weights");
    let bounds = Bounds { least_width: Some(0.0), ..Bounds::default() };
    assert_eq!(place(Options { bounds, ..options }), "options.bounds.least_width");
    let bad = [DVec3::NAN];
    assert_eq!(optimise(Task { cover: &bad, ..task }, &options, &mut on).unwrap_err().place(), "cover[0]");
}
