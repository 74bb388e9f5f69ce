//! Strains, areas, volumes, bends, lengths and angles: each kernel against its twin, and against the definition of its set.
//!
//! A projection is right if it is the processor's within [`NEAR`] of the size of its rows. Where the nearest element is not
//! unique it may be another that is as feasible and as near. What is left must be ill-conditioned: the processor's own answer
//! changes by as much where the points move by [`STIR`]. The shares are printed, and small on random samples.

use std::f64::consts::PI;

use glam::{DMat3, DQuat, DVec3};
use shapeop::solver::Backend;

use crate::has_adapter;
use crate::kernels::{
    AS_GOOD, COUNTS, Compared, ILL_CONDITIONED, NEAR, Random, Sample, account, compare, diameter, solver_of,
};

/// Of the constraint's diameter: some units in the last place of single precision, in which coordinates are subtracted.
const STIR: f64 = 1e-6;

/// What rows of absolute points lose of the largest coordinate, some units in the last place: in the size that [`NEAR`] is a part
/// of.
const COORDINATE: f64 = 1e-15 / NEAR;

/// A model's unit: samples are of a thousand in theirs.
const UNITS: [f64; 3] = [1e-6, 1.0, 1e6];

/// So often is the processor asked how much its answer changes, by all of [`STIR`], a tenth and a hundredth of it in turn: where
/// singular values all but vanish the answer depends on their ratio.
const STIRS: usize = 500;

/// How a sample is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Points of a size like that at rest, anywhere.
    Random,
    /// Of any size against that at rest.
    AnySize,
    AtRest,
    /// At rest, but turned and moved.
    Turned,
    /// A little off rest.
    Strained,
    /// At rest, but larger or smaller: all stretches are alike.
    Scaled,
    /// At rest in a mirror.
    Mirrored,
    Planar,
    Collinear,
    /// Along a line but for a little.
    NearCollinear,
    /// Two of the points are one.
    Repeated,
    /// All points are one.
    Point,
    /// A thousandth as thick as wide at rest.
    Sliver,
    PlanarRest,
    CollinearRest,
    /// A quad whose planes are not unique: the hard case of DiagonalDistance.
    HardCase,
    /// A fold without one: it has no side to bend to.
    Unfolded,
}

/// What is made again and again.
const SHAPES: [Shape; 24] = [
    Shape::Random,
    Shape::AtRest,
    Shape::Random,
    Shape::Turned,
    Shape::Random,
    Shape::Strained,
    Shape::Strained,
    Shape::Random,
    Shape::Scaled,
    Shape::Mirrored,
    Shape::Random,
    Shape::Planar,
    Shape::Random,
    Shape::Collinear,
    Shape::NearCollinear,
    Shape::Random,
    Shape::Repeated,
    Shape::Point,
    Shape::Random,
    Shape::Sliver,
    Shape::PlanarRest,
    Shape::AnySize,
    Shape::CollinearRest,
    Shape::Random,
];

/// Points near a sample's, others in each round.
type Stir = dyn Fn(&Sample, usize, &mut Random) -> Vec<DVec3>;

/// What a type's answers are held to.
struct Law<'a> {
    /// `A x` by the definition of the rows.
    images: &'a dyn Fn(&Compared<'_>) -> Vec<DVec3>,
    /// The size of the rows.
    size: &'a dyn Fn(&Compared<'_>) -> f64,
    /// Points that the card may take a sample's for.
    stir: &'a Stir,
    /// True where the card may leave the constraint as it is, whatever the processor does.
    may_stay: &'a dyn Fn(&Compared<'_>) -> bool,
    /// How far targets are from the set, in the unit of the rows.
    violation: &'a dyn Fn(&Compared<'_>, &[DVec3]) -> f64,
}

/// Samples that are not near the processor's answer.
struct Doubtful {
    id: usize,
    cpu: Vec<DVec3>,
    gpu: Vec<DVec3>,
    images: Vec<DVec3>,
    allowed: f64,
}

fn flattened(points: &mut [DVec3], normal: DVec3, kept: f64) {
    let first = points[0];
    points.iter_mut().for_each(|point| *point -= (1.0 - kept) * (*point - first).dot(normal) * normal);
}

fn collinear(k: usize, place: DVec3, size: f64, random: &mut Random) -> Vec<DVec3> {
    let direction = random.vector().normalize();
    (0..k).map(|_| place + size * random.within(-1.0, 1.0) * direction).collect()
}

/// A sample of `k` points with default scalars, in a model of this unit.
fn sample(shape: Shape, k: usize, unit: f64, random: &mut Random) -> Sample {
    let (rest_size, place) = (unit * random.size(), 1e3 * unit * random.vector());
    let similar = rest_size * 10_f64.powf(random.within(-0.5, 0.5));
    let anywhere = |size: f64, random: &mut Random| (0..k).map(|_| place + size * random.vector()).collect::<Vec<_>>();
    let mut rest = anywhere(rest_size, random);
    let normal = random.vector().normalize();
    let as_at_rest = |rest: &[DVec3], map: &dyn Fn(DVec3) -> DVec3| -> Vec<DVec3> {
        rest.iter().map(|point| place + map(*point - rest[0])).collect()
    };
    let points = match shape {
        Shape::AtRest => rest.clone(),
        Shape::AnySize => anywhere(unit * random.size(), random),
        Shape::Turned => {
            let turn = DQuat::from_scaled_axis(PI * random.vector());
            as_at_rest(&rest, &|edge| turn * edge)
        }
        Shape::Strained => rest.iter().map(|point| *point + 0.1 * rest_size * random.vector()).collect(),
        Shape::Scaled => {
            let factor = random.within(0.2, 4.0);
            as_at_rest(&rest, &|edge| factor * edge)
        }
        Shape::Mirrored => as_at_rest(&rest, &|edge| edge - 2.0 * edge.dot(normal) * normal),
        Shape::Collinear => collinear(k, place, similar, random),
        Shape::NearCollinear => {
            let off = similar * 10_f64.powf(random.within(-8.0, -2.0));
            let mut points = collinear(k, place, similar, random);
            points.iter_mut().for_each(|point| *point += off * random.vector());
            points
        }
        Shape::Point => vec![place; k],
        _ => anywhere(similar, random),
    };
    let mut sample = Sample { points, rest: None, scalars: None };
    match shape {
        Shape::Planar => flattened(&mut sample.points, normal, 0.0),
        Shape::Repeated => sample.points[k - 1] = sample.points[random.below(k - 1)],
        Shape::Sliver => flattened(&mut rest, normal, 1e-3),
        Shape::PlanarRest => flattened(&mut rest, normal, 0.0),
        Shape::CollinearRest => rest = collinear(k, place, rest_size, random),
        _ => {}
    }
    sample.rest = Some(rest);
    sample
}

/// A range of ratios: of all kinds that are allowed.
fn range(random: &mut Random) -> Vec<f64> {
    let low = random.within(0.0, 1.2);
    match random.below(8) {
        0 => vec![1.0, 1.0],
        1 => vec![0.0, random.within(0.0, 2.0)],
        2 => vec![low, low],
        3 => vec![low, 1e290],
        4 => vec![0.9, 1.1],
        _ => vec![low, low + random.within(0.0, 1.0)],
    }
}

/// A range of angles: of all kinds that are allowed.
fn angles(random: &mut Random) -> Vec<f64> {
    let low = random.within(0.0, PI);
    match random.below(8) {
        0 => vec![0.0, PI],
        1 => vec![low, low],
        2 => vec![0.0, low],
        3 => vec![low, PI],
        4 => vec![0.5 * PI; 2],
        5 => [vec![0.0; 2], vec![PI; 2]][random.below(2)].clone(),
        _ => vec![low, random.within(low, PI)],
    }
}

/// The points on the line through the first and the one farthest from it.
fn straightened(points: &[DVec3]) -> Vec<DVec3> {
    let first = points[0];
    let farthest = points.iter().copied().max_by(|a, b| a.distance(first).total_cmp(&b.distance(first)));
    let along = (farthest.unwrap_or(first) - first).normalize_or_zero();
    points.iter().map(|point| first + (*point - first).dot(along) * along).collect()
}

/// How far a round stirs, of the size.
fn stir_by(round: usize) -> f64 {
    STIR * 0.1_f64.powi((round % 3) as i32)
}

/// The points moved by [`STIR`] of the diameter; first onto a line, if they are so near to one.
fn stir_points(sample: &Sample, round: usize, random: &mut Random) -> Vec<DVec3> {
    let (points, by) = (&sample.points, stir_by(round) * diameter(&sample.points));
    let straight = straightened(points);
    if round == 0 && straight.iter().zip(points).all(|(a, b)| a.distance(*b) <= by) {
        return straight;
    }
    points.iter().map(|point| *point + by * random.vector()).collect()
}

/// What takes the least singular value of three columns off, where it is far below the others: with the cofactors `C` that is
/// `−det C/‖C‖²`.
fn flattening(c: &[DVec3]) -> Vec<DVec3> {
    let cofactors = [c[1].cross(c[2]), c[2].cross(c[0]), c[0].cross(c[1])];
    let squared: f64 = cofactors.iter().map(|cofactor| cofactor.length_squared()).sum();
    let factor = if squared > 0.0 { c[0].dot(cofactors[0]) / squared } else { 0.0 };
    cofactors.iter().map(|cofactor| -factor * *cofactor).collect()
}

/// The points moved so that the deformation gradient changes by [`STIR`] of its size; first to a flat one, if it is so near.
fn stir_gradient(sample: &Sample, round: usize, random: &mut Random) -> Vec<DVec3> {
    let rest = sample.rest.as_ref().unwrap();
    let (inverse, (columns, size)) = (inverse(rest), gradient(rest, &sample.points));
    if inverse[0][0] == 0.0 && inverse[0][1] == 0.0 {
        return stir_points(sample, round, random);
    }
    let e = edges(rest);
    let along = e[0].normalize();
    let mut by: Vec<DVec3> = e.iter().map(|_| stir_by(round) * size * random.vector()).collect();
    if round == 0 && columns.len() == 3 {
        let flattening = flattening(&columns);
        by = if longest(&flattening) <= STIR * size { flattening } else { by };
    }
    let moved = |edge: &DVec3| match by[..] {
        [first, second] => edge.dot(along) * first + (*edge - edge.dot(along) * along).length() * second,
        _ => DMat3::from_cols(by[0], by[1], by[2]) * *edge,
    };
    let moves = std::iter::once(DVec3::ZERO).chain(e.iter().map(moved));
    sample.points.iter().zip(moves).map(|(point, by)| *point + by).collect()
}

/// The targets that the processor has for `samples` whose points are stirred: how far each may come from where it was.
fn spreads(type_name: &str, samples: &[Sample], doubtful: &[Doubtful], stir: &Stir, random: &mut Random) -> Vec<f64> {
    let chosen: Vec<Sample> = doubtful.iter().map(|one| samples[one.id].clone()).collect();
    let mut solver = solver_of(type_name, &chosen);
    let mut spreads = vec![0.0_f64; chosen.len()];
    for round in 0..STIRS {
        let stirred: Vec<DVec3> = chosen.iter().flat_map(|sample| stir(sample, round, random)).collect();
        solver.set_points(&stirred).unwrap();
        let found = solver.projections(Backend::Cpu).unwrap();
        for ((spread, found), one) in spreads.iter_mut().zip(found).zip(doubtful) {
            *spread = found.iter().zip(&one.cpu).map(|(a, b)| a.distance(*b)).fold(*spread, f64::max);
        }
    }
    spreads
}

fn norm(targets: &[DVec3], images: &[DVec3]) -> f64 {
    targets.iter().zip(images).map(|(target, image)| target.distance_squared(*image)).sum::<f64>().sqrt()
}

/// Holds the samples' projections to the law.
fn judge(type_name: &str, shapes: &[Shape], samples: &[Sample], law: &Law<'_>) {
    if !has_adapter() {
        return;
    }
    let (mut as_good, mut stayed, mut doubtful) = (Vec::new(), Vec::new(), Vec::<Doubtful>::new());
    let mut farthest = 0.0_f64;
    compare(type_name, samples, |id, found| {
        let size = (law.size)(found);
        let allowed = NEAR * size;
        let difference = found.difference();
        if difference <= allowed {
            farthest = farthest.max(if size > 0.0 { difference / size } else { 0.0 });
            return;
        }
        let images = (law.images)(found);
        let [cpu_off, gpu_off] = [&found.cpu, &found.gpu].map(|targets| (law.violation)(found, targets));
        let [cpu_cost, gpu_cost] = [&found.cpu, &found.gpu].map(|targets| norm(targets, &images));
        if gpu_off <= cpu_off + allowed && gpu_cost <= cpu_cost + allowed {
            as_good.push(id);
        } else if (law.may_stay)(found) && norm(&found.gpu, &images) <= allowed {
            stayed.push(id);
        } else {
            doubtful.push(Doubtful { id, cpu: found.cpu.clone(), gpu: found.gpu.clone(), images, allowed });
        }
    });
    let spreads = spreads(type_name, samples, &doubtful, law.stir, &mut Random::new(7));
    for (one, spread) in doubtful.iter().zip(&spreads) {
        let difference = one.cpu.iter().zip(&one.gpu).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let Sample { points, scalars, rest } = &samples[one.id];
        // Two answers of an ambiguous sample can be twice as far apart as each is from the one in between.
        assert!(
            difference <= 2.0 * spread,
            "{type_name} {} {:?}: off by {difference}, allowed {}, spread {spread}\ncpu {:?}\ngpu {:?}\nrows {:?}\n{points:?}\nrest {rest:?}\n{scalars:?}",
            one.id,
            shapes[one.id],
            one.allowed,
            one.cpu,
            one.gpu,
            one.images,
        );
    }
    let is_random = |id: &usize| shapes[*id] == Shape::Random;
    let random_count = (0..samples.len()).filter(is_random).count();
    let others: Vec<usize> = as_good.iter().chain(&stayed).copied().chain(doubtful.iter().map(|one| one.id)).collect();
    let random_others = others.iter().filter(|id| is_random(id)).count();
    if samples.len() > 1000 {
        let others = [(as_good.len(), AS_GOOD), (stayed.len(), "left as they are"), (doubtful.len(), ILL_CONDITIONED)];
        account(type_name, samples.len(), farthest, &others);
        assert!(random_others * 20 <= random_count, "{type_name}: too many need the second way");
    }
}

/// Samples of `k` points, edited by `edit`, in all counts.
fn check(
    type_name: &str,
    k: usize,
    seed: u64,
    law: &Law<'_>,
    mut edit: impl FnMut(&mut Random, &mut Shape, &mut Sample),
) {
    let mut random = Random::new(seed);
    // In other units some samples are enough.
    for (count, unit) in COUNTS.map(|count| (count, 1.0)).into_iter().chain(UNITS.map(|unit| (1000, unit))) {
        let made = |i: usize| {
            let mut shape = SHAPES[i % SHAPES.len()];
            let mut made = sample(shape, k, unit, &mut random);
            edit(&mut random, &mut shape, &mut made);
            (shape, made)
        };
        let (shapes, samples): (Vec<Shape>, Vec<Sample>) = (0..count).map(made).unzip();
        judge(type_name, &shapes, &samples, law);
    }
}

fn rest<'a>(found: &'a Compared<'_>) -> &'a [DVec3] {
    found.sample.rest.as_ref().unwrap()
}

fn edges(points: &[DVec3]) -> Vec<DVec3> {
    points[1..].iter().map(|point| *point - points[0]).collect()
}

/// How far a number is from a range.
fn off(value: f64, range: &[f64]) -> f64 {
    (value - value.clamp(range[0], range[1])).abs()
}

/// The largest coordinate.
fn largest(points: &[DVec3]) -> f64 {
    points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max)
}

fn longest(vectors: &[DVec3]) -> f64 {
    vectors.iter().map(|vector| vector.length()).fold(0.0, f64::max)
}

/// `R⁻¹` by its definition, a row for each point but the first; zero for flat rest shapes.
fn inverse(rest: &[DVec3]) -> Vec<Vec<f64>> {
    let e = edges(rest);
    if let [e, f] = e[..] {
        let along = e.normalize_or_zero();
        let (l, u) = (e.length(), f.dot(along));
        let h = (f - u * along).length();
        let longest = e.length().max(f.length()).max((f - e).length());
        if l <= 1e-12 * longest || h <= 1e-12 * longest {
            return vec![vec![0.0; 2]; 2];
        }
        return vec![vec![1.0 / l, -u / (l * h)], vec![0.0, 1.0 / h]];
    }
    let longest = longest(&[e[0], e[1], e[2], e[1] - e[0], e[2] - e[1], e[0] - e[2]]);
    let columns = DMat3::from_cols(e[0], e[1], e[2]);
    if columns.determinant().abs() <= 1e-12 * longest.powi(3) {
        return vec![vec![0.0; 3]; 3];
    }
    let inverse = columns.inverse();
    (0..3).map(|i| (0..3).map(|j| inverse.col(j)[i]).collect()).collect()
}

/// The columns of the deformation gradient, and the size of the terms that they are sums of.
fn gradient(rest: &[DVec3], points: &[DVec3]) -> (Vec<DVec3>, f64) {
    let (inverse, e) = (inverse(rest), edges(points));
    let column = |j: usize| e.iter().zip(&inverse).map(|(e, row)| row[j] * *e).sum::<DVec3>();
    let lost = COORDINATE * largest(points);
    let size = |j: usize| e.iter().zip(&inverse).map(|(e, row)| row[j].abs() * (e.length() + lost)).sum::<f64>();
    let n = e.len();
    ((0..n).map(column).collect(), (0..n).map(size).fold(0.0, f64::max))
}

fn gradient_of(found: &Compared<'_>) -> (Vec<DVec3>, f64) {
    gradient(rest(found), &found.sample.points)
}

/// In descending order, the least of three with the sign of the determinant.
fn singular_values(columns: &[DVec3]) -> Vec<f64> {
    let scale = longest(columns);
    if scale == 0.0 {
        return vec![0.0; columns.len()];
    }
    let c: Vec<DVec3> = columns.iter().map(|column| *column / scale).collect();
    if let [a, b] = c[..] {
        let (trace, area) = (a.length_squared() + b.length_squared(), a.cross(b).length());
        let greatest = (0.5 * (trace + (trace * trace - 4.0 * area * area).max(0.0).sqrt())).sqrt();
        return vec![scale * greatest, scale * area / greatest];
    }
    // The greatest eigenvalue of FᵀF as a root of the characteristic polynomial, by an angle. Of the other two the sum is known
    // from the cofactors, the product from the determinant.
    let gram = |i: usize, j: usize| c[i].dot(c[j]);
    let mean = (0..3).map(|i| gram(i, i)).sum::<f64>() / 3.0;
    let b = |i: usize, j: usize| gram(i, j) - if i == j { mean } else { 0.0 };
    let p = ((0..9).map(|n| b(n / 3, n % 3).powi(2)).sum::<f64>() / 6.0).sqrt().max(f64::MIN_POSITIVE);
    let shifted = DMat3::from_cols_array(&std::array::from_fn(|n| b(n / 3, n % 3) / p));
    let angle = (0.5 * shifted.determinant()).clamp(-1.0, 1.0).acos() / 3.0;
    let greatest = mean + 2.0 * p * angle.cos();
    let (determinant, first) = (c[0].cross(c[1]).dot(c[2]), greatest.sqrt());
    let product = determinant / first;
    let cofactors: f64 = (0..3).map(|i| c[i].cross(c[(i + 1) % 3]).length_squared()).sum();
    let sum = ((cofactors - product * product) / greatest).max(0.0);
    let second = (0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt())).sqrt();
    let third = if second > 0.0 { product / second } else { 0.0 };
    vec![scale * first, scale * second, scale * third]
}

/// True for a tetrahedron that is a line within round-off: the processor's steps divide by it.
fn is_line(found: &Compared<'_>) -> bool {
    let (columns, size) = gradient_of(found);
    singular_values(&columns)[1] <= 3.0 * STIR * size
}

/// The law of types that act on deformation gradients. Answers of areas and volumes can be far larger than the gradient.
fn of_gradients(type_name: &str, k: usize, seed: u64, violation: &dyn Fn(&Compared<'_>, &[DVec3]) -> f64) {
    let law = Law {
        images: &|found| gradient_of(found).0,
        size: &|found| gradient_of(found).1.max(longest(&found.cpu)),
        stir: &stir_gradient,
        may_stay: &|found| type_name == "Volume" && is_line(found),
        violation,
    };
    check(type_name, k, seed, &law, |random, _, sample| sample.scalars = Some(range(random)));
}

/// The largest distance of a stretch from the range.
fn strain_off(found: &Compared<'_>, targets: &[DVec3]) -> f64 {
    singular_values(targets).into_iter().map(|s| off(s, &found.scalars)).fold(0.0, f64::max)
}

/// The distance of the product of the stretches from the range, over what a stretch changes it by.
fn product_off(found: &Compared<'_>, targets: &[DVec3]) -> f64 {
    let product: f64 = singular_values(targets).iter().product();
    let size = gradient_of(found).1.max(longest(targets));
    let slope = targets.len() as f64 * size.powi(targets.len() as i32 - 1);
    if slope > 0.0 { off(product, &found.scalars) / slope } else { 0.0 }
}

#[test]
fn triangles_are_strained_alike() {
    of_gradients("TriangleStrain", 3, 11, &strain_off);
}

#[test]
fn tetrahedra_are_strained_alike() {
    of_gradients("TetrahedronStrain", 4, 12, &strain_off);
}

#[test]
fn areas_are_kept_alike() {
    of_gradients("Area", 3, 13, &product_off);
}

#[test]
fn volumes_are_kept_alike() {
    of_gradients("Volume", 4, 14, &product_off);
}

/// The cotangent at `a` in the triangle `a b c`; `None` if that is flat.
fn cotangent(a: DVec3, b: DVec3, c: DVec3) -> Option<f64> {
    let (e, f) = (b - a, c - a);
    let double_area = e.cross(f).length();
    let longest = e.length().max(f.length()).max((f - e).length());
    (double_area > 2e-12 * longest * longest).then(|| e.dot(f) / double_area)
}

/// The stencil of two rest triangles; zero if one is flat.
fn stencil(x: &[DVec3]) -> [f64; 4] {
    let at = |i: usize, j: usize, k: usize| cotangent(x[i], x[j], x[k]);
    let (Some(a0), Some(a1), Some(b0), Some(b1)) = (at(0, 1, 2), at(1, 0, 2), at(0, 1, 3), at(1, 0, 3)) else {
        return [0.0; 4];
    };
    [a1 + b1, a0 + b0, -a0 - a1, -b0 - b1]
}

/// `Σ c_i x_i`, and the size of its terms.
fn bend(coefficients: &[f64; 4], x: &[DVec3]) -> (DVec3, f64) {
    let terms = edges(x).into_iter().zip(&coefficients[1..]);
    terms.fold((DVec3::ZERO, 0.0), |(sum, size), (edge, c)| {
        (sum + *c * edge, size + c.abs() * (edge.length() + COORDINATE * largest(x)))
    })
}

/// The two triangles turned about their edge until they lie in one plane.
fn unfolded(rest: &[DVec3]) -> Vec<DVec3> {
    let along = (rest[1] - rest[0]).normalize_or_zero();
    let split = |point: DVec3| {
        let edge = point - rest[0];
        (edge.dot(along), edge - edge.dot(along) * along)
    };
    let ((_, beside), (ahead, off)) = (split(rest[2]), split(rest[3]));
    vec![rest[0], rest[1], rest[2], rest[0] + ahead * along - off.length() * beside.normalize_or_zero()]
}

#[test]
fn pairs_of_triangles_are_bent_alike() {
    let of = |found: &Compared<'_>| bend(&stencil(rest(found)), &found.sample.points);
    let rest_norm = |found: &Compared<'_>| {
        let norm = bend(&stencil(rest(found)), rest(found)).0.length();
        if norm > 1e-6 * diameter(rest(found)) { norm } else { 0.0 }
    };
    let law = Law {
        images: &|found| vec![of(found).0],
        size: &|found| of(found).1.max(longest(&found.cpu)),
        stir: &stir_points,
        may_stay: &|_| false,
        violation: &|found, targets| {
            let n = rest_norm(found);
            off(targets[0].length(), &[found.scalars[0] * n, found.scalars[1] * n])
        },
    };
    check("Bending", 4, 15, &law, |random, shape, sample| {
        sample.scalars = Some(range(random));
        if random.below(10) == 0 {
            *shape = Shape::Unfolded;
            sample.points = unfolded(sample.rest.as_ref().unwrap());
        }
    });
}

#[test]
fn edges_are_strained_alike() {
    let edge = |found: &Compared<'_>| edges(&found.sample.points)[0] / found.scalars[0];
    let law = Law {
        images: &|found| vec![edge(found)],
        size: &|found| edge(found).length().max(longest(&found.cpu)),
        stir: &stir_points,
        may_stay: &|_| false,
        violation: &|found, targets| off(targets[0].length(), &found.scalars[1..]),
    };
    check("EdgeStrain", 2, 16, &law, |random, _, sample| {
        let length = diameter(sample.rest.as_ref().unwrap()) * random.within(0.5, 2.0);
        sample.scalars = (length > 0.0).then(|| [vec![length], range(random)].concat());
    });
}

#[test]
fn lengths_of_edges_are_kept_alike() {
    let law = Law {
        images: &|found| edges(&found.sample.points),
        size: &|found| diameter(&found.sample.points).max(longest(&found.cpu)),
        stir: &stir_points,
        may_stay: &|_| false,
        violation: &|found, targets| off(targets[0].length(), &found.scalars),
    };
    check("EdgeLength", 2, 17, &law, |random, _, sample| {
        let length = diameter(sample.rest.as_ref().unwrap());
        sample.scalars = match random.below(3) {
            0 => None,
            _ => Some(range(random).into_iter().map(|ratio| length * ratio).collect()),
        };
    });
}

#[test]
fn lengths_are_made_equal_alike() {
    let edges = |found: &Compared<'_>| -> Vec<DVec3> {
        found.sample.points.chunks_exact(2).map(|pair| pair[1] - pair[0]).collect()
    };
    let law = Law {
        images: &edges,
        size: &|found| longest(&edges(found)),
        stir: &stir_points,
        may_stay: &|_| false,
        violation: &|_, targets| {
            let mean = targets.iter().map(|target| target.length()).sum::<f64>() / targets.len() as f64;
            targets.iter().map(|target| (target.length() - mean).abs()).fold(0.0, f64::max)
        },
    };
    for (k, seed) in [(4, 18), (6, 19), (10, 20)] {
        check("EqualLengths", k, seed, &law, |_, _, _| {});
    }
    let mut random = Random::new(21);
    for k in [64, 2000] {
        let samples: Vec<Sample> = (0..65).map(|_| sample(Shape::Random, k, 1.0, &mut random)).collect();
        judge("EqualLengths", &[Shape::Random; 65], &samples, &law);
    }
}

/// How far the angle is from its range, as the length of an arc of the shorter edge.
fn angle_off(found: &Compared<'_>, targets: &[DVec3]) -> f64 {
    let (e, f) = (targets[0], targets[1]);
    off(e.cross(f).length().atan2(e.dot(f)), &found.scalars) * e.length().min(f.length())
}

#[test]
fn angles_are_bounded_alike() {
    for (type_name, seed) in [("Angle", 22), ("BoundedAngle", 23)] {
        let law = Law {
            images: &|found| edges(&found.sample.points),
            size: &|found| diameter(&found.sample.points),
            stir: &stir_points,
            may_stay: &|_| false,
            violation: &angle_off,
        };
        check(type_name, 3, seed, &law, |random, _, sample| sample.scalars = Some(angles(random)));
    }
}

/// The diagonals, and the vector between their middles.
fn diagonals(x: &[DVec3]) -> [DVec3; 3] {
    [x[2] - x[0], x[3] - x[1], 0.5 * ((x[1] - x[0]) + (x[3] - x[2]))]
}

/// How far a quad is from lying between planes `epsilon` apart whose normal is that of its diagonals, or, where they are near
/// parallel and the card tells the normal by the way that it moves the points, of that.
fn diagonals_off(found: &Compared<'_>, targets: &[DVec3]) -> f64 {
    let (moved, [u, v, w]) = (centred(&found.sample.points), diagonals(targets));
    let by = moved.iter().zip(targets).map(|(point, target)| *target - *point);
    let way = by.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap().normalize_or_zero();
    let of = |n: DVec3| n.dot(u).abs().max(n.dot(v).abs()).max(n.dot(w).abs() - found.scalars[0]);
    let own = of(u.cross(v).normalize_or_zero());
    if way == DVec3::ZERO { own } else { own.min(of(way)) }
}

fn centred(x: &[DVec3]) -> Vec<DVec3> {
    let mean = edges(x).into_iter().sum::<DVec3>() / x.len() as f64;
    x.iter().map(|point| (*point - x[0]) - mean).collect()
}

#[test]
fn diagonals_are_brought_together_alike() {
    let law = Law {
        images: &|found| centred(&found.sample.points),
        size: &|found| diameter(&found.sample.points),
        stir: &stir_points,
        may_stay: &|_| false,
        violation: &diagonals_off,
    };
    check("DiagonalDistance", 4, 24, &law, |random, shape, sample| {
        let [u, v, w] = diagonals(&sample.points);
        let distance = w.dot(u.cross(v).normalize_or_zero()).abs();
        if random.below(10) == 0 {
            *shape = Shape::HardCase;
            let (turn, size) = (DQuat::from_scaled_axis(PI * random.vector()), diameter(sample.rest.as_ref().unwrap()));
            let quad = [[-3.0, 0.0, -1.0], [0.0, -0.5, 1.0], [3.0, 0.0, -1.0], [0.0, 0.5, 1.0]].map(DVec3::from);
            let place = sample.points[0];
            sample.points = quad.iter().map(|point| place + size * (turn * *point)).collect();
            sample.scalars = Some(vec![size * random.within(0.0, 2.2)]);
            return;
        }
        sample.scalars = match random.below(4) {
            0 => None,
            1 => Some(vec![0.0]),
            _ => Some(vec![distance * random.within(0.0, 1.2)]),
        };
    });
}

/// Where the nearest element is not unique, or the processor leaves what spans no plane, the card does as the processor.
#[test]
fn choices_are_those_of_the_processor() {
    const TYPES: [(&str, usize, Shape); 8] = [
        ("EdgeStrain", 2, Shape::Point),
        ("EdgeLength", 2, Shape::Point),
        ("EqualLengths", 4, Shape::Repeated),
        ("TriangleStrain", 3, Shape::Point),
        ("TetrahedronStrain", 4, Shape::Point),
        ("Volume", 4, Shape::Point),
        ("Angle", 3, Shape::Collinear),
        ("BoundedAngle", 3, Shape::Collinear),
    ];
    let mut random = Random::new(26);
    for (type_name, k, shape) in TYPES {
        let made = |_| {
            // Large enough for points of double precision to be along a line.
            let mut made = sample(shape, k, 1.0, &mut random);
            let size = random.within(1.0, 100.0);
            match type_name {
                "Angle" | "BoundedAngle" => {
                    made.points = collinear(k, 1e3 * random.vector(), size, &mut random);
                    made.scalars = Some(angles(&mut random));
                }
                "EqualLengths" => made.points[3] = made.points[2],
                _ => {}
            }
            made
        };
        let samples: Vec<Sample> = (0..1000).map(made).collect();
        compare(type_name, &samples, |id, found| {
            // Stretches are compared with 1, what they are at rest.
            let least = if type_name == "Volume" { 1.0 } else { 0.0 };
            let size = diameter(&found.sample.points).max(longest(&found.cpu)).max(least);
            assert!(found.difference() <= NEAR * size, "{type_name} {id}: {:?} {:?}", found.cpu, found.gpu);
        });
    }
}

/// Coordinates of all magnitudes beside each other, at rest and now: what the answers are is of no interest, but that there are.
#[test]
fn whatever_the_points_answers_are_finite() {
    const TYPES: [(&str, usize); 11] = [
        ("EdgeStrain", 2),
        ("TriangleStrain", 3),
        ("TetrahedronStrain", 4),
        ("Area", 3),
        ("Volume", 4),
        ("Bending", 4),
        ("Angle", 3),
        ("BoundedAngle", 3),
        ("DiagonalDistance", 4),
        ("EdgeLength", 2),
        ("EqualLengths", 6),
    ];
    let mut random = Random::new(25);
    for (type_name, k) in TYPES {
        let wild = |random: &mut Random| {
            let coordinate = |random: &mut Random| {
                let sign = [-1.0, 0.0, 1.0][random.below(3)];
                sign * 10_f64.powf(random.within(-12.0, 3.0))
            };
            (0..k).map(|_| DVec3::from_array(std::array::from_fn(|_| coordinate(random)))).collect::<Vec<_>>()
        };
        let made = |_| {
            let (rest, points) = (wild(&mut random), wild(&mut random));
            let scalars = match type_name {
                "EqualLengths" | "EdgeLength" | "EdgeStrain" | "DiagonalDistance" => None,
                "Angle" | "BoundedAngle" => Some(angles(&mut random)),
                _ => Some(range(&mut random)),
            };
            Sample { points, rest: Some(rest), scalars }
        };
        let samples: Vec<Sample> = (0..3000).map(made).collect();
        let mut count = 0;
        // Refuses what is not finite.
        compare(type_name, &samples, |_, found| count += usize::from(found.gpu.len() == found.cpu.len()));
        assert!(count == samples.len() || !has_adapter());
    }
}
