//! Projections against an oracle that knows none of their formulas.
//!
//! The oracle is Levenberg and Marquardt's method with numeric derivatives, started from many random places, on a
//! parametrisation that covers the set. It says how far the nearest element of the set is; no projection may be
//! further.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::Constraint;
use super::laws::{Sample, Stream, points, squared_distance};

/// Random configurations per type.
const CASES: usize = 200;

/// Random starts of the oracle per configuration.
const STARTS: usize = 12;

/// Steps from one start.
const STEPS: usize = 80;

/// What the squared distance may exceed the oracle's by, relative to it.
const WORST_EXCESS: f64 = 1e-6;

/// What may remain of a violation, relative to the size: common normals of nearly parallel lines lose digits.
const ROUND_OFF: f64 = 1e-10;

/// The step of central differences, for parameters about 1 in size.
const DIFFERENCE: f64 = 1e-6;

/// A map from parameters to elements of the set of `sample`, written to the last argument.
type Parametrised<T> = fn(&Sample<T>, &[f64], &mut [DVec3]);

/// Solves `a x = b` by elimination with partial pivots; `None` if a pivot vanishes.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for pivot in 0..n {
        let best = (pivot..n).max_by(|&i, &j| a[i][pivot].abs().total_cmp(&a[j][pivot].abs()))?;
        a.swap(pivot, best);
        b.swap(pivot, best);
        if a[pivot][pivot].abs() < f64::MIN_POSITIVE {
            return None;
        }
        for row in pivot + 1..n {
            let factor = a[row][pivot] / a[pivot][pivot];
            for column in pivot..n {
                a[row][column] -= factor * a[pivot][column];
            }
            b[row] -= factor * b[pivot];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|column| a[row][column] * b[column]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    Some(b)
}

/// The least squared distance of `image` from what `element` reaches from the parameters `start`.
fn descended(image: &[DVec3], start: Vec<f64>, element: impl Fn(&[f64], &mut [DVec3])) -> f64 {
    let residuals = |parameters: &[f64]| -> Vec<f64> {
        let mut found = vec![DVec3::ZERO; image.len()];
        element(parameters, &mut found);
        found.iter().zip(image).flat_map(|(found, image)| (*found - *image).to_array()).collect()
    };
    let cost = |residuals: &[f64]| residuals.iter().map(|r| r * r).sum::<f64>();
    let (mut parameters, mut damping) = (start, 1e-3);
    let mut current = residuals(&parameters);
    let n = parameters.len();
    for _ in 0..STEPS {
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let at = |step: f64| {
                    let mut moved = parameters.clone();
                    moved[i] += step;
                    residuals(&moved)
                };
                let (above, below) = (at(DIFFERENCE), at(-DIFFERENCE));
                above.iter().zip(below).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)).collect()
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gradient: Vec<f64> = columns.iter().map(|column| dot(column, &current)).collect();
        let before = cost(&current);
        loop {
            let entry = |i: usize, j: usize| dot(&columns[i], &columns[j]) + if i == j { damping } else { 0.0 };
            let normal = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
            let Some(step) = solved(normal, gradient.clone()) else { return before };
            let moved: Vec<f64> = parameters.iter().zip(&step).map(|(p, s)| p - s).collect();
            let next = residuals(&moved);
            if cost(&next) < before {
                (parameters, current) = (moved, next);
                damping *= 0.2;
                break;
            }
            damping *= 5.0;
            if damping > 1e9 {
                return before;
            }
        }
        if before - cost(&current) <= 1e-13 * before {
            break;
        }
    }
    cost(&current)
}

/// Compares the projections of random configurations that `state` makes violate the constraint.
fn compare<T: Constraint>(
    state: fn(&mut Sample<T>, &[DVec3], &mut Stream),
    parameter_count: fn(usize) -> usize,
    set: Parametrised<T>,
) {
    let name = T::INFO.name;
    let (mut count, mut met, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..50 * CASES as u64 {
        let (rest, x, mut stream) = points(&T::INFO, seed);
        let mut sample = Sample::<T>::at_rest(&rest);
        state(&mut sample, &x, &mut stream);
        T::check_scalars(&sample.scalars).unwrap();
        sample.constraint.scalars_changed(&sample.scalars);
        if sample.violation(&x) < 1e-3 {
            continue;
        }
        let image = sample.image(&x);
        let distance = squared_distance(&image, &sample.project(&x));
        let best = (0..STARTS)
            .map(|_| {
                let start = (0..parameter_count(x.len())).map(|_| 3.0 * stream.next() - 1.5).collect();
                descended(&image, start, |parameters, found| set(&sample, parameters, found))
            })
            .fold(f64::INFINITY, f64::min);
        let excess = distance / best - 1.0;
        assert!(excess <= WORST_EXCESS, "{name}, sample {seed}: {distance} where the oracle found {best}");
        worst = worst.max(excess);
        met += usize::from(excess >= -WORST_EXCESS);
        count += 1;
        if count == CASES {
            break;
        }
    }
    assert_eq!(count, CASES, "{name}: too few configurations violate it");
    // Else the oracle is too weak to say anything.
    assert!(met * 10 >= 9 * CASES, "{name}: the oracle came as near in {met} cases only");
    println!("projection {name}: {count} cases, worst relative excess {worst:.1e}");
}

/// The vector of three parameters.
fn vector(parameters: &[f64], at: usize) -> DVec3 {
    DVec3::new(parameters[at], parameters[at + 1], parameters[at + 2])
}

/// A unit vector by three parameters.
fn unit(parameters: &[f64], at: usize) -> DVec3 {
    vector(parameters, at).try_normalize().unwrap_or(DVec3::X)
}

#[test]
fn diagonal_distance() {
    use super::diagonal_distance::DiagonalDistance;
    compare::<DiagonalDistance>(
        |sample, x, stream| {
            // From a plane to nearly the distance as it is.
            let as_it_is = Sample::<DiagonalDistance>::at_rest(x).scalars[0];
            sample.scalars = vec![as_it_is * (1.2 * stream.next() - 0.2).max(0.0)];
        },
        |_| 16,
        |sample, p, found| {
            // The feet of the common normal of the lines, their directions, and where on them the corners are.
            let (middle, n) = (vector(p, 0), unit(p, 3));
            let lift = 0.5 * sample.scalars[0] * n;
            let (u, v) = (n.cross(vector(p, 6)), n.cross(vector(p, 9)));
            found[0] = middle - lift + p[12] * u;
            found[2] = middle - lift + p[13] * u;
            found[1] = middle + lift + p[14] * v;
            found[3] = middle + lift + p[15] * v;
        },
    );
}

#[test]
fn edge_length() {
    use super::edge_length::EdgeLength;
    compare::<EdgeLength>(
        |sample, _, stream| {
            let min = 1.5 * stream.next();
            sample.scalars = vec![min, min + 0.5 * stream.next()];
        },
        |_| 4,
        |sample, p, found| {
            let [min, max] = [sample.scalars[0], sample.scalars[1]];
            found[0] = (min + (max - min) * p[3].sin().powi(2)) * unit(p, 0);
        },
    );
}

#[test]
fn regular_polygon() {
    compare::<super::regular_polygon::RegularPolygon>(
        |_, _, _| {},
        |_| 7,
        |_, p, found| {
            let (turn, count) = (DQuat::from_scaled_axis(3.0 * vector(p, 0)), found.len() as f64);
            for (i, found) in found.iter_mut().enumerate() {
                let (sin, cos) = (2.0 * PI * i as f64 / count).sin_cos();
                *found = vector(p, 3) + p[6] * (turn * DVec3::new(cos, sin, 0.0));
            }
        },
    );
}

#[test]
fn bounded_angle() {
    use super::bounded_angle::BoundedAngle;
    compare::<BoundedAngle>(
        |sample, x, stream| {
            // Corrections of up to 75°, from either side.
            let angle = (x[1] - x[0]).angle_between(x[2] - x[0]);
            let (correction, slack) = (75_f64.to_radians() * stream.next(), 0.5 * stream.next());
            let range = if stream.next() < 0.5 {
                [angle - correction - slack, angle - correction]
            } else {
                [angle + correction, angle + correction + slack]
            };
            // Where that leaves [0, π] there may be no violation; such samples are passed over.
            sample.scalars = range.map(|bound| bound.clamp(0.0, PI)).to_vec();
        },
        |_| 6,
        |sample, p, found| {
            let [min, max] = [sample.scalars[0], sample.scalars[1]];
            let (sin, cos) = (min + (max - min) * p[5].sin().powi(2)).sin_cos();
            let turn = DQuat::from_scaled_axis(3.0 * vector(p, 0));
            found[0] = p[3] * p[3] * (turn * DVec3::X);
            found[1] = p[4] * p[4] * (turn * DVec3::new(cos, sin, 0.0));
        },
    );
}

/// A point and a direction other than the defaults.
fn anywhere<T>(sample: &mut Sample<T>, _: &[DVec3], stream: &mut Stream) {
    sample.scalars = [stream.vector(), 3.0 * stream.vector()].iter().flat_map(DVec3::to_array).collect();
}

#[test]
fn on_plane() {
    compare::<super::on_plane::OnPlane>(
        anywhere,
        |_| 2,
        |sample, p, found| {
            let (u, v) = unit(&sample.scalars, 3).any_orthonormal_pair();
            found[0] = vector(&sample.scalars, 0) + p[0] * u + p[1] * v;
        },
    );
}

#[test]
fn on_line() {
    compare::<super::on_line::OnLine>(
        anywhere,
        |_| 1,
        |sample, p, found| found[0] = vector(&sample.scalars, 0) + p[0] * vector(&sample.scalars, 3),
    );
}

#[test]
fn equal_lengths() {
    compare::<super::equal_lengths::EqualLengths>(
        |_, _, _| {},
        |k| 1 + 3 * (k / 2),
        |_, p, found| {
            for (i, found) in found.iter_mut().enumerate() {
                *found = p[0] * unit(p, 1 + 3 * i);
            }
        },
    );
}

#[test]
fn orientation() {
    compare::<super::orientation::Orientation>(
        |sample, _, stream| sample.scalars = (3.0 * stream.vector()).to_array().to_vec(),
        |k| 1 + 2 * k,
        |sample, p, found| {
            let n = unit(&sample.scalars, 0);
            let (u, v) = n.any_orthonormal_pair();
            for (i, found) in found.iter_mut().enumerate() {
                *found = p[0] * n + p[2 * i + 1] * u + p[2 * i + 2] * v;
            }
        },
    );
}

/// Configurations that say little or nothing, for types of `k` points: coincident, collinear, repeated, flat.
fn degenerate(k: usize) -> Vec<Vec<DVec3>> {
    let (a, b, c) = (DVec3::new(0.3, -0.7, 0.2), DVec3::new(0.4, 0.1, -0.3), DVec3::new(-0.1, 0.5, 0.6));
    let all = |point: &dyn Fn(usize) -> DVec3| (0..k).map(point).collect::<Vec<_>>();
    let kinds = [
        all(&|_| DVec3::ZERO),
        all(&|_| a),
        all(&|i| a + i as f64 * b),
        all(&|i| a + ((i * i) % 5) as f64 * b),
        all(&|i| a + (i % 2) as f64 * b),
        all(&|i| a + (i / 2) as f64 * b),
        all(&|i| a + (i % 2) as f64 * b + (i / 2) as f64 * c),
    ];
    kinds.iter().flat_map(|kind| [1.0, 1e6].map(|scale| kind.iter().map(|point| scale * *point).collect())).collect()
}

/// Projects degenerate configurations, those of [`degenerate`] and `others`, of constraints at rest at an ordinary and
/// at the degenerate one; what is projected must be finite and in the set.
fn stays_finite<T: Constraint>(k: usize, scalars: &[&[f64]], others: &[Vec<DVec3>]) {
    let name = T::INFO.name;
    let ordinary: Vec<DVec3> = (0..k).map(|i| DVec3::new(i as f64, (i * i % 3) as f64, (i * i % 7) as f64)).collect();
    let mut count = 0;
    for x in degenerate(k).iter().chain(others) {
        for rest in [&ordinary, x] {
            for scalars in scalars {
                let mut sample = Sample::<T>::at_rest(rest);
                if !scalars.is_empty() {
                    sample.scalars = scalars.to_vec();
                    sample.constraint.scalars_changed(scalars);
                }
                let targets = sample.project(x);
                assert!(targets.iter().all(|target| target.is_finite()), "{name}: {scalars:?}, {x:?}: {targets:?}");
                let (before, after) = (sample.violation(x), sample.violation(&sample.lift(x, &targets)));
                let size = 1.0 + x.iter().chain(&targets).map(|point| point.length()).fold(0.0, f64::max);
                assert!(before.is_finite(), "{name}: {scalars:?}, {x:?}");
                assert!(
                    after <= ROUND_OFF * size,
                    "{name}: {scalars:?}, {x:?}: {after} remains of {before}, {targets:?}"
                );
                count += 1;
            }
        }
    }
    println!("degenerate {name}: {count} cases, all finite");
}

fn quad(corners: [[f64; 3]; 4]) -> Vec<DVec3> {
    corners.map(DVec3::from).to_vec()
}

#[test]
fn degenerate_input_is_projected_into_the_set() {
    stays_finite::<super::diagonal_distance::DiagonalDistance>(
        4,
        &[&[], &[0.0], &[0.1]],
        &[
            // Parallel diagonals, nearly parallel ones, one of no length, a hard case, both on one axis.
            quad([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]),
            quad([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1e-5]]),
            quad([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1e-12]]),
            quad([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [1.0, -1.0, 0.5]]),
            quad([[-3.0, 0.0, -1.0], [0.0, -0.5, 1.0], [3.0, 0.0, -1.0], [0.0, 0.5, 1.0]]),
            quad([[-1.0, 0.0, -1.0], [0.0, -1.0, 1.0], [1.0, 0.0, -1.0], [0.0, 1.0, 1.0]]),
        ],
    );
    stays_finite::<super::edge_length::EdgeLength>(2, &[&[], &[0.0, 0.0], &[1.0, 2.0]], &[]);
    for k in [3, 4, 6] {
        stays_finite::<super::regular_polygon::RegularPolygon>(k, &[&[]], &[]);
    }
    stays_finite::<super::bounded_angle::BoundedAngle>(
        3,
        &[&[], &[0.5, 1.0], &[2.0, 2.5], &[0.0, 0.0], &[PI, PI], &[0.1, 0.1]],
        &[
            // Edges along one line, the same way and opposed; nearly so; of no length; corrections beyond a right angle.
            [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X].to_vec(),
            [DVec3::ZERO, DVec3::X, -2.0 * DVec3::X].to_vec(),
            [DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1e-9, 0.0)].to_vec(),
            [DVec3::ZERO, DVec3::X, DVec3::new(-2.0, 0.0, 1e-7)].to_vec(),
            [DVec3::ONE, DVec3::ONE, DVec3::X].to_vec(),
            [DVec3::ZERO, DVec3::X, DVec3::new(-1.0, 0.1, 0.0)].to_vec(),
            [DVec3::ZERO, 1e-5 * DVec3::X, DVec3::new(-1.0, 0.1, 0.0)].to_vec(),
        ],
    );
    let directions: &[&[f64]] = &[&[], &[1.0, 2.0, 3.0, 1e-200, 0.0, 0.0], &[0.0, 0.0, 0.0, 1e200, -1e200, 1e200]];
    stays_finite::<super::on_plane::OnPlane>(1, directions, &[]);
    stays_finite::<super::on_line::OnLine>(1, directions, &[]);
    for k in [4, 6, 10] {
        stays_finite::<super::equal_lengths::EqualLengths>(k, &[&[]], &[]);
    }
    stays_finite::<super::orientation::Orientation>(4, &[&[], &[1e-200, 0.0, 0.0], &[1.0, 1.0, 0.0]], &[]);
}
