//! What a snake and its positions are like, measured on their control points.

use serde::Serialize;
use shapeop::geometry::snakes::evolution::Frame;
use shapeop::geometry::snakes::freedoms::freedoms;
use shapeop::geometry::snakes::{ArcShape, Linkage, Snake, congruence};

use crate::table::number;

/// Intervals of each arc where positions are compared.
const PER_ARC: usize = 2;

#[derive(Serialize)]
pub struct SnakeInReport {
    pub closed: bool,
    pub arcs: usize,
    pub length: f64,
    pub radii: Vec<f64>,
    pub lengths: Vec<f64>,
    pub angles_deg: Vec<f64>,
    /// Between arcs; of a closed snake the last is between the last arc and the first.
    pub torsions_deg: Vec<f64>,
    /// By how much a distance of control points is off at most.
    pub residual: f64,
    /// In how many independent ways it can move, to first order; the six of rigid motions are among them.
    pub freedoms: usize,
    /// Of an open snake of 3 arcs or more, with the end arcs on hinges.
    pub linkage_freedoms: Option<usize>,
    /// Of six arcs: that of the first six hinges.
    pub determinant: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub on_surface: Option<OnSurface>,
}

#[derive(Serialize)]
pub struct OnSurface {
    pub mesh: String,
    /// The largest distance of a contact or the middle of an arc from the mesh.
    pub deviation: f64,
    /// In how many ways it can move at right angles to the normals.
    pub freedoms: usize,
}

impl SnakeInReport {
    pub fn of(snake: &Snake) -> Self {
        let shapes = snake.shapes();
        let linkage = Linkage::new(snake.clone()).ok();
        Self {
            closed: snake.is_closed(),
            arcs: shapes.len(),
            length: snake.length(),
            radii: shapes.iter().map(|shape| shape.radius).collect(),
            lengths: shapes.iter().map(|shape| shape.length).collect(),
            angles_deg: shapes.iter().map(|shape| shape.angle_rad().to_degrees()).collect(),
            torsions_deg: snake.torsions().into_iter().map(f64::to_degrees).collect(),
            residual: snake.residual(),
            freedoms: freedoms(snake).map_or(0, |found| found.free),
            linkage_freedoms: linkage.as_ref().map(Linkage::freedoms),
            determinant: linkage.as_ref().and_then(|linkage| linkage.determinant().ok()),
            on_surface: None,
        }
    }
}

#[derive(Serialize)]
pub struct FrameInReport {
    pub time: f64,
    /// The largest distance of a contact or the middle of an arc from the mesh; 0 without one.
    pub deviation: f64,
    /// By how much a distance or a rail is missed at most.
    pub residual: f64,
    /// By how much heights over the mesh changed since the start.
    pub height_residual: f64,
    /// By how much a distance of control points three apart changed, where those are kept.
    pub incongruence: f64,
    /// By how much velocities missed a condition, in model units a time.
    pub predicted_residual: f64,
    pub velocity_residual: f64,
}

impl FrameInReport {
    pub fn of(frame: &Frame) -> Self {
        Self {
            time: frame.time,
            deviation: frame.deviation,
            residual: frame.residual,
            height_residual: frame.height_residual,
            incongruence: frame.incongruence,
            predicted_residual: frame.predicted_residual,
            velocity_residual: frame.velocity_residual,
        }
    }
}

/// What holds in all positions, measured anew.
#[derive(Serialize)]
pub struct KeptInReport {
    /// By how much the radius and the length of an arc differ at most from those of the start.
    pub radius: f64,
    pub length: f64,
    /// By how much a torsion differs at most from that of the start.
    pub torsion_deg: f64,
    /// How far positions are from being the start moved rigidly: the largest root mean square of the distances of points after
    /// the best rigid motion, and the largest difference of two points' distance.
    pub congruence_rms: f64,
    pub congruence_distances: f64,
    /// How many positions in a row, from the start on, have the former below 1e-9 of the snake's size.
    pub congruent_positions: usize,
}

/// Positions are congruent where they are so to this part of the snake's size.
const CONGRUENT: f64 = 1e-9;

impl KeptInReport {
    /// Arcs found from control points alone.
    pub fn of(start: &Snake, positions: &[Snake]) -> Self {
        let mut kept = Self {
            radius: 0.0,
            length: 0.0,
            torsion_deg: 0.0,
            congruence_rms: 0.0,
            congruence_distances: 0.0,
            congruent_positions: 0,
        };
        let size = start.size();
        let (shapes, torsions, points) = (start.shapes(), start.torsions(), start.sample(PER_ARC));
        for (i, snake) in positions.iter().enumerate() {
            for (found, shape) in measured(snake).iter().zip(shapes) {
                kept.radius = kept.radius.max((found.radius - shape.radius).abs());
                kept.length = kept.length.max((found.length - shape.length).abs());
            }
            for (a, b) in snake.torsions().into_iter().zip(&torsions) {
                let turn = ((a - b).to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
                kept.torsion_deg = kept.torsion_deg.max(turn.abs());
            }
            if let Ok(found) = congruence(&points, &snake.sample(PER_ARC)) {
                kept.congruence_rms = kept.congruence_rms.max(found.rms);
                let is_in_row = kept.congruent_positions == i && found.rms <= CONGRUENT * size;
                kept.congruent_positions += usize::from(is_in_row);
                kept.congruence_distances = kept.congruence_distances.max(found.distances);
            }
        }
        kept
    }
}

/// The shapes of arcs that control points have: each turns by the angle of the edges, and both tangents of it are half of what is
/// left of the edges beside its neighbours' tangents.
fn measured(snake: &Snake) -> Vec<ArcShape> {
    let (control, shapes, count) = (snake.control(), snake.shapes(), snake.control().len());
    let shape = |j: usize| {
        let i = snake.vertex(j);
        let [before, at, after] = [(i + count - 1) % count, i, (i + 1) % count].map(|i| control[i]);
        let (a, b) = (at - before, after - at);
        let angle = a.cross(b).length().atan2(a.dot(b));
        let tangent = |j: Option<usize>| j.and_then(|j| shapes.get(j)).map_or(0.0, ArcShape::tangent_length);
        let (last, next) = if snake.is_closed() {
            (Some((j + shapes.len() - 1) % shapes.len()), Some((j + 1) % shapes.len()))
        } else {
            (j.checked_sub(1), Some(j + 1))
        };
        let own = 0.5 * (a.length() - tangent(last) + b.length() - tangent(next));
        let radius = own / (0.5 * angle).tan();
        ArcShape { radius, length: radius * angle }
    };
    (0..shapes.len()).map(shape).collect()
}

/// One number, or the least and the greatest.
pub fn lowest_and_greatest(values: &[f64]) -> String {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let [low, high] = [low, high].map(number);
    if low == high { low } else { format!("{low} to {high}") }
}
