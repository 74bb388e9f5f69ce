//! What is recomputed from control points alone, sharing no code with what it judges.

use glam::{DMat3, DVec3};
use shapeop::geometry::snakes::Snake;

/// Radius and length of each arc, read from control points: from the tangent length of arc 0 on, or of an open snake from its
/// first edge on.
pub fn shapes(control: &[DVec3], closed: Option<f64>) -> Vec<[f64; 2]> {
    let count = control.len();
    let side = |i: usize| control[(i + 1) % count] - control[i % count];
    let (arcs, first) = if closed.is_some() { (count, 0) } else { (count - 2, 1) };
    let mut tangent = closed.unwrap_or_else(|| side(0).length());
    let mut found = Vec::with_capacity(arcs);
    for j in 0..arcs {
        let i = j + first;
        let (a, b) = (side(i + count - 1), side(i));
        let half = 0.5 * a.cross(b).length().atan2(a.dot(b));
        let radius = tangent / half.tan();
        found.push([radius, 2.0 * half * radius]);
        tangent = b.length() - tangent;
    }
    found
}

/// By how much radii and lengths that the control points of another position say differ from those of the start at most.
pub fn shape_error(start: &Snake, now: &Snake) -> f64 {
    let tangent = |snake: &Snake| {
        let (a, b) = (snake.control()[0], snake.contacts()[0]);
        snake.is_closed().then(|| a.distance(b))
    };
    let [a, b] = [start, now].map(|snake| shapes(snake.control(), tangent(snake)));
    let off = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    largest(a.iter().zip(&b).map(off))
}

/// Pairs of control points one or two apart.
pub fn pairs(count: usize, is_closed: bool) -> Vec<[usize; 2]> {
    let of = |step: usize| (0..if is_closed { count } else { count - step }).map(move |i| [i, (i + step) % count]);
    of(1).chain(of(2)).collect()
}

/// By how much edges and diagonals differ between two positions at most.
pub fn stretch(a: &Snake, b: &Snake) -> f64 {
    let (p, q) = (a.control(), b.control());
    let off = |[i, j]: [usize; 2]| (p[i].distance(p[j]) - q[i].distance(q[j])).abs();
    largest(pairs(p.len(), a.is_closed()).into_iter().map(off))
}

/// By how much a distance of any two points differs between two positions at most.
pub fn incongruence(a: &[DVec3], b: &[DVec3]) -> f64 {
    let all = (0..a.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    largest(all.map(|(i, j)| (a[i].distance(a[j]) - b[i].distance(b[j])).abs()))
}

/// The root mean square distance of points after the rigid motion for which it is least, found from three frames of points by
/// Newton's method for rotations: each step turns by the small rotation that lowers the sum most.
pub fn procrustes(a: &[DVec3], b: &[DVec3]) -> f64 {
    let mean = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len() as f64;
    let (from, to) = (mean(a), mean(b));
    let frame = |points: &[DVec3]| {
        let x = (points[points.len() - 1] - points[0]).normalize();
        let y = (points[points.len() / 2] - points[0]).reject_from_normalized(x).normalize();
        DMat3::from_cols(x, y, x.cross(y))
    };
    let mut turn = frame(b) * frame(a).transpose();
    for _ in 0..60 {
        // Σ |ω × q + q − r|² with q = turn (a − from), r = b − to: (Σ |q|² I − q qᵀ) ω = Σ q × r, for small ω.
        let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for (p, r) in a.iter().zip(b) {
            let (q, r) = (turn * (*p - from), *r - to);
            matrix +=
                DMat3::from_diagonal(DVec3::splat(q.length_squared())) - DMat3::from_cols(q * q.x, q * q.y, q * q.z);
            right += q.cross(r);
        }
        let step = matrix.inverse() * right;
        if step.length() < 1e-15 {
            break;
        }
        turn = DMat3::from_axis_angle(step.normalize(), step.length()) * turn;
    }
    let sum: f64 = a.iter().zip(b).map(|(p, r)| (turn * (*p - from)).distance_squared(*r - to)).sum();
    (sum / a.len() as f64).sqrt()
}

/// Rows that velocities of these control points must be at right angles to: distances, and normals if there are any.
pub fn jacobian(control: &[DVec3], is_closed: bool, normals: &[DVec3]) -> Vec<Vec<f64>> {
    let count = control.len();
    let mut rows = Vec::new();
    let mut put = |terms: &[(usize, DVec3)]| {
        let mut row = vec![0.0; 3 * count];
        for &(i, v) in terms {
            v.to_array().into_iter().enumerate().for_each(|(k, value)| row[3 * i + k] += value);
        }
        rows.push(row);
    };
    for [i, j] in pairs(count, is_closed) {
        let side = (control[i] - control[j]).normalize();
        put(&[(i, side), (j, -side)]);
    }
    normals.iter().enumerate().for_each(|(i, normal)| put(&[(i, normal.normalize())]));
    rows
}

/// An orthonormal basis of the span of rows, by Gram and Schmidt with the longest rest first; rests below 1e-9 are round-off.
pub fn basis(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::new();
    while !rows.is_empty() {
        let norm = |row: &[f64]| dot(row, row).sqrt();
        let best = (0..rows.len()).fold(0, |best, i| if norm(&rows[i]) > norm(&rows[best]) { i } else { best });
        let mut row = rows.swap_remove(best);
        // Twice, so that it is at right angles to round-off.
        found.iter().for_each(|other| reduce(&mut row, other));
        let length = norm(&row);
        if length < 1e-9 {
            break;
        }
        row.iter_mut().for_each(|value| *value /= length);
        rows.iter_mut().for_each(|other| reduce(other, &row));
        found.push(row);
    }
    found
}

/// The part of a vector across the span of an orthonormal basis.
pub fn rest(vector: &[f64], basis: &[Vec<f64>]) -> f64 {
    let mut rest = vector.to_vec();
    (0..2).for_each(|_| basis.iter().for_each(|other| reduce(&mut rest, other)));
    dot(&rest, &rest).sqrt()
}

fn reduce(vector: &mut [f64], unit: &[f64]) {
    let along = dot(vector, unit);
    vector.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The determinant of a square matrix, by elimination.
pub fn determinant(mut a: Vec<Vec<f64>>) -> f64 {
    let mut product = 1.0;
    for k in 0..a.len() {
        let pivot = (k..a.len()).fold(k, |best, i| if a[i][k].abs() > a[best][k].abs() { i } else { best });
        if pivot != k {
            a.swap(pivot, k);
            product = -product;
        }
        product *= a[k][k];
        for i in k + 1..a.len() {
            let factor = if a[k][k] == 0.0 { 0.0 } else { a[i][k] / a[k][k] };
            let (upper, lower) = a.split_at_mut(i);
            lower[0].iter_mut().zip(&upper[k]).for_each(|(value, other)| *value -= factor * other);
        }
    }
    product
}

/// The distance of a point from arcs, through points of theirs: the nearest of `per_arc` chords of each.
pub fn from_polyline(point: DVec3, polyline: &[DVec3]) -> f64 {
    let of = |pair: &[DVec3]| {
        let side = pair[1] - pair[0];
        let t = ((point - pair[0]).dot(side) / side.length_squared()).clamp(0.0, 1.0);
        point.distance(pair[0] + t * side)
    };
    polyline.windows(2).map(of).fold(f64::INFINITY, f64::min)
}

/// The largest of some numbers, at least 0; not a number if one is none.
pub fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| if most.is_nan() || number.is_nan() { f64::NAN } else { most.max(number) })
}
