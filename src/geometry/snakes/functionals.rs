//! What velocities of a snake are to be: sums of squares of linear functions of them, each with its rows.

use glam::DVec3;

use super::Snake;
use crate::error::Result;
use crate::mesh::curve::Curve;

use super::freedoms::check_normals;

/// `Σ vector · v_i − right`, where `v_i` is the velocity (or acceleration, or position) of control point `i`. As a wish it is to be
/// near 0: `weight` times its square is added to what is minimised. As a condition it is 0, and the weight does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Control points and vectors.
    pub terms: Vec<(u32, DVec3)>,
    /// What the sum is to be.
    pub right: f64,
    /// What its square is multiplied by, 0 or more.
    pub weight: f64,
}

impl Row {
    /// `Σ vector · v_i − right` for these vectors, one for each control point.
    pub fn residual(&self, vectors: &[DVec3]) -> f64 {
        self.terms.iter().map(|&(i, vector)| vector.dot(vectors[i as usize])).sum::<f64>() - self.right
    }

    fn of(point: usize, vector: DVec3, right: f64, weight: f64) -> Self {
        Self { terms: vec![(point as u32, vector)], right, weight }
    }
}

/// The weighted sum of the squares of rows for these vectors.
pub fn value(rows: &[Row], vectors: &[DVec3]) -> f64 {
    rows.iter().map(|row| row.weight * row.residual(vectors).powi(2)).sum()
}

/// Velocities tangential to a surface with these unit normals at the feet of the control points: `n_i · ṗ_i` is to be 0. It keeps
/// their heights over the surface to first order.
pub fn tangential(normals: &[DVec3], weight: f64) -> Vec<Row> {
    normals.iter().enumerate().map(|(i, &normal)| Row::of(i, normal, 0.0, weight)).collect()
}

/// Speeds in given unit directions, in length per time: `d_i · ṗ_i` is to be `speeds[i]`.
pub fn offset(directions: &[DVec3], speeds: &[f64], weight: f64) -> Vec<Row> {
    let rows = directions.iter().zip(speeds).enumerate();
    rows.map(|(i, (&direction, &speed))| Row::of(i, direction, speed, weight)).collect()
}

/// The velocity of control point `i` is to be near `velocity`.
pub fn near_vector(i: usize, velocity: DVec3, weight: f64) -> Vec<Row> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    axes.into_iter().zip(velocity.to_array()).map(|(axis, right)| Row::of(i, axis, right, weight)).collect()
}

/// The velocity of control point `i` is to be near the plane through 0 with this unit normal.
pub fn near_plane(i: usize, normal: DVec3, weight: f64) -> Row {
    Row::of(i, normal, 0.0, weight)
}

/// Velocities at right angles to the planes of the arcs: `e · ṗ_i` is to be 0 for two orthonormal vectors `e` in the plane of the
/// arc at `p_i`. An end of an open snake has the plane of its arc.
///
/// # Errors
/// Status `Degenerate`: a plane is not determined (`snake`).
pub fn orthogonal(snake: &Snake, weight: f64) -> Result<Vec<Row>> {
    let (arcs, count) = (snake.arcs(), snake.control().len());
    let plane = |i: usize| {
        let j = if snake.is_closed() { i } else { i.clamp(1, count - 2) - 1 };
        (i, arcs[j].circle.normal)
    };
    let mut rows = Vec::with_capacity(2 * count);
    for (i, normal) in (0..count).map(plane) {
        let Some(normal) = normal.try_normalize() else {
            let reason = format!("expected the edges at control point {i} to span a plane");
            return Err(crate::error::Error::new(crate::error::Status::Degenerate, reason).at("snake"));
        };
        let (a, b) = normal.any_orthonormal_pair();
        rows.extend([Row::of(i, a, 0.0, weight), Row::of(i, b, 0.0, weight)]);
    }
    Ok(rows)
}

/// The pairs of control points that are three apart, with their distances: none of a snake with fewer than 4 control points. Around
/// a closed snake each pair comes once.
pub fn three_apart(snake: &Snake) -> Vec<super::Distance> {
    let control = snake.control();
    let count = control.len();
    let pairs = match (snake.is_closed(), count) {
        // Of a closed snake of 5 or fewer, points three apart are two apart the other way around.
        (true, 0..=5) => 0,
        (true, 6) => 3,
        (true, _) => count,
        (false, _) => count.saturating_sub(3),
    };
    let pair = |i: usize| {
        let j = (i + 3) % count;
        super::Distance { points: [i as u32, j as u32], length: control[i].distance(control[j]) }
    };
    (0..pairs).map(pair).collect()
}

/// Velocities that turn arcs about contacts as little as possible: `(p_i − p_{i+3}) · (ṗ_i − ṗ_{i+3})` is to be 0 (Bartoň et al.
/// 2013, section 3.1). We divide by the mean of those distances: the result is a speed, whose square compares with the others.
pub fn rotation_minimising(snake: &Snake, weight: f64) -> Vec<Row> {
    let (pairs, control) = (three_apart(snake), snake.control());
    let mean = pairs.iter().map(|pair| pair.length).sum::<f64>() / pairs.len().max(1) as f64;
    let scale = if mean > 0.0 { 1.0 / mean } else { 0.0 };
    let row = |pair: &super::Distance| {
        let [i, j] = pair.points;
        let apart = scale * (control[i as usize] - control[j as usize]);
        Row { terms: vec![(i, apart), (j, -apart)], right: 0.0, weight }
    };
    pairs.iter().map(row).collect()
}

/// The unit vectors `n_i × t_i` to the left of the snake within a surface with these normals, where `t_i` is along `p_{i+1} −
/// p_{i−1}`, at an end along the edge. All are on one side, as long as the normals are.
///
/// # Errors
/// Not one normal for each control point, or one that is no direction (`normals`, `normals[i]`). Status `Degenerate`: the snake is
/// along a normal (`normals[i]`).
pub fn sideways(snake: &Snake, normals: &[DVec3]) -> Result<Vec<DVec3>> {
    check_normals(snake, normals)?;
    let (control, count) = (snake.control(), snake.control().len());
    let neighbours = |i: usize| {
        if snake.is_closed() {
            [(i + count - 1) % count, (i + 1) % count]
        } else {
            [i.saturating_sub(1), (i + 1).min(count - 1)]
        }
    };
    let direction = |i: usize| {
        let [before, after] = neighbours(i).map(|j| control[j]);
        normals[i].cross(after - before).try_normalize().ok_or_else(|| {
            let reason = "expected a normal that is not along the snake";
            crate::error::Error::new(crate::error::Status::Degenerate, reason).at(format!("normals[{i}]"))
        })
    };
    (0..count).map(direction).collect()
}

/// Conditions: the velocity of control point `i` is that of a curve that it is on, `speed` times the derivative at `parameter`.
pub fn along(i: usize, curve: &dyn Curve, parameter: f64, speed: f64) -> Vec<Row> {
    near_vector(i, speed * curve.at(parameter).first, 1.0)
}
