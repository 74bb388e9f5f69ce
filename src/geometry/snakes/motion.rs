//! One step of an evolution: velocities, accelerations, where they lead to, and the projection back.

use glam::DVec3;

use super::Snake;
use super::evolution::{Direction, Options, Task};
use super::functionals::{
    Row, near_vector, offset, orthogonal, rotation_minimising, sideways, tangential, three_apart,
};
use super::projection::{self, Projected, Surface, height, project};
use super::rails::{Halt, OnRail, Rail, across, arc_point, at_distance, follower_rate, meet};
use super::snake::Distance;
use super::velocity::{Admissible, Kept, admissible, centripetal};
use crate::error::{Error, Result, Status};

/// Velocities that miss a condition by this part of the fastest contradict each other.
const CONTRADICTING: f64 = 1e-8;

/// What distances three apart count where they contradict other conditions.
const STRONG: f64 = 1e3;

/// Heights are taken to round-off where that takes no more than this part of a step back.
const REACH: f64 = 0.5;

/// How often at most a snake is projected again since it met its rails elsewhere, and the distance, in parts of its length, at
/// which it meets them.
const MOST_ROUNDS: usize = 8;
const MEETS: f64 = 1e-13;

/// What is the same in all steps.
#[derive(Debug)]
pub(super) struct Motion<'a> {
    pub task: &'a Task<'a>,
    pub options: &'a Options,
    /// The heights over the surface at the start.
    heights: Vec<f64>,
    /// Distances kept besides the snake's own.
    further: Vec<Distance>,
    /// The distance of each follower from its leader; 0 of other rails.
    leads: Vec<f64>,
    fixed: Vec<u32>,
    pub length: f64,
}

/// A position.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub snake: Snake,
    pub rails: Vec<OnRail>,
}

/// How a position moves.
#[derive(Clone, Debug)]
pub(super) struct Rates {
    pub velocity: Admissible,
    /// The rate of each rail's parameter.
    pub rails: Vec<f64>,
}

/// Where a step leads to.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub state: State,
    pub projected: Projected,
    /// By how much a distance was off at most before the projection.
    pub predicted_residual: f64,
    /// By how much distances three apart are off, where they are to be kept.
    pub incongruence: f64,
    /// The largest way that the projection took.
    pub taken_back: f64,
}

/// Why a step leads nowhere.
#[derive(Clone, Debug)]
pub(super) enum Failure {
    Rail(usize, Halt),
    Refused(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

impl<'a> Motion<'a> {
    pub fn new(task: &'a Task<'a>, options: &'a Options, rails: &[OnRail]) -> Self {
        let control = task.snake.control();
        let heights = match task.surface {
            Some(surface) => control.iter().map(|&point| height(surface, point)).collect(),
            None => Vec::new(),
        };
        let on = |k: usize| task.rails[k].curve().point(rails[k].parameter);
        let lead = |k: usize| match task.rails[k] {
            Rail::Following { leader, .. } => on(k).distance(on(leader)),
            _ => 0.0,
        };
        let mut fixed = task.fixed.to_vec();
        fixed.extend(task.rails.iter().filter_map(Rail::point));
        Self {
            task,
            options,
            heights,
            further: if options.keeps_torsions { three_apart(task.snake) } else { Vec::new() },
            leads: (0..rails.len()).map(lead).collect(),
            fixed,
            length: task.snake.length(),
        }
    }

    fn normals(&self, snake: &Snake) -> Option<Vec<DVec3>> {
        let surface = self.task.surface?;
        Some(snake.control().iter().map(|&point| surface.nearest(point).normal).collect())
    }

    /// What velocities are to be.
    fn wishes(&self, snake: &Snake) -> Result<Vec<Row>> {
        let weights = &self.options.weights;
        let normals = self.normals(snake);
        let mut rows = self.task.wishes.to_vec();
        if let Some(normals) = &normals {
            rows.extend(tangential(normals, weights.tangential));
        }
        let directions = match (self.task.direction, &normals) {
            (Direction::Along(direction), _) => vec![direction.normalize(); snake.control().len()],
            (Direction::Sideways, Some(normals)) => {
                sideways(snake, normals).map_err(|error| error.with_place("surface"))?
            }
            _ => Vec::new(),
        };
        let speeds = |i: usize| self.task.speeds[if self.task.speeds.len() == 1 { 0 } else { i }];
        let speeds: Vec<f64> = (0..directions.len()).map(speeds).collect();
        rows.extend(offset(&directions, &speeds, weights.offset));
        if weights.rotation > 0.0 {
            rows.extend(rotation_minimising(snake, weights.rotation));
        }
        if weights.orthogonal > 0.0 {
            rows.extend(orthogonal(snake, weights.orthogonal)?);
        }
        Ok(rows)
    }

    /// The rates of the rails' parameters that are known beforehand, and with them velocity and acceleration of their points.
    fn runs(&self, rails: &[OnRail]) -> Vec<(f64, [DVec3; 2])> {
        let mut found: Vec<(f64, [DVec3; 2])> = Vec::with_capacity(rails.len());
        for (rail, at) in self.task.rails.iter().zip(rails) {
            let jet = rail.curve().at(at.parameter);
            let rate = match *rail {
                Rail::Driven { speed, .. } => speed,
                Rail::Following { leader, .. } => {
                    let apart = jet.point - self.task.rails[leader].curve().point(rails[leader].parameter);
                    follower_rate(apart, jet.first, jet.second, found[leader].1)
                }
                Rail::Gliding { .. } => 0.0,
            };
            found.push((rate, [rate * jet.first, rate * rate * jet.second]));
        }
        found
    }

    pub fn velocity(&self, state: &State) -> std::result::Result<Rates, Failure> {
        let snake = &state.snake;
        let runs = self.runs(&state.rails);
        let mut conditions: Vec<Row> = Vec::new();
        self.task.fixed.iter().for_each(|&i| conditions.extend(near_vector(i as usize, DVec3::ZERO, 1.0)));
        for (k, rail) in self.task.rails.iter().enumerate() {
            match rail.point() {
                Some(point) => conditions.extend(near_vector(point as usize, runs[k].1[0], 1.0)),
                None => {
                    let at = state.rails[k];
                    let direction = across(snake, rail.curve(), at).map_err(|halt| Failure::Rail(k, halt))?;
                    conditions.push(arc_point(snake, at.arc as usize, at.angle_rad)[0].row(direction, 0.0));
                }
            }
        }
        let mut wishes = self.wishes(snake)?;
        let velocity = self.admissible(snake, None, &conditions, &mut wishes)?;
        let mut rails: Vec<f64> = runs.iter().map(|run| run.0).collect();
        for (k, rail) in self.gliding() {
            rails[k] = self.glide(state, rail, k, &velocity.vectors)[1];
        }
        Ok(Rates { velocity, rails })
    }

    /// The rates of the angle and of the parameter of a gliding rail: `γ' τ̇ − m' φ̇ = ṁ`, by least squares.
    fn glide(&self, state: &State, rail: &Rail<'_>, k: usize, velocities: &[DVec3]) -> [f64; 2] {
        let at = state.rails[k];
        let [point, along, _] = arc_point(&state.snake, at.arc as usize, at.angle_rad);
        let (a, b) = (along.of(state.snake.control()), rail.curve().at(at.parameter).first);
        let v = point.of(velocities);
        let determinant = a.length_squared() * b.length_squared() - a.dot(b).powi(2);
        let (of_a, of_b) = (-a.dot(v), b.dot(v));
        let angle = (of_a * b.length_squared() + of_b * a.dot(b)) / determinant;
        let parameter = (of_b * a.length_squared() + of_a * a.dot(b)) / determinant;
        [angle, parameter].map(|rate| if rate.is_finite() { rate } else { 0.0 })
    }

    /// With the distances three apart as conditions, and where those contradict others as strong wishes.
    fn admissible(
        &self,
        snake: &Snake,
        velocities: Option<&[DVec3]>,
        conditions: &[Row],
        wishes: &mut Vec<Row>,
    ) -> Result<Admissible> {
        let own = snake.distances();
        let mut all = own.clone();
        all.extend_from_slice(&self.further);
        let rights = |distances: &[Distance]| match velocities {
            Some(velocities) => centripetal(snake, distances, velocities),
            None => Ok(vec![0.0; distances.len()]),
        };
        let right = rights(&all)?;
        let found = admissible(snake, Kept { distances: &all, rights: &right }, conditions, wishes)?;
        let fastest = found.vectors.iter().map(|v| v.length()).fold(0.0, f64::max);
        if self.further.is_empty() || found.residual <= CONTRADICTING * fastest {
            return Ok(found);
        }
        let control = snake.control();
        for (distance, right) in self.further.iter().zip(&right[own.len()..]) {
            let [i, j] = distance.points;
            let direction = (control[i as usize] - control[j as usize]).normalize_or_zero();
            wishes.push(Row { terms: vec![(i, direction), (j, -direction)], right: *right, weight: STRONG });
        }
        admissible(snake, Kept { distances: &own, rights: &right[..own.len()] }, conditions, wishes)
    }

    /// The accelerations for a step of time `h` (Bartoň et al. 2013, equation 9), with targets beside where the velocities lead to. As
    /// control points are off the surface, accelerations towards its feet themselves would grow like `h⁻²`; we take points at the
    /// heights `η` that control points have and that velocities change at their rates. By differences along the velocity that is an
    /// acceleration of `−η″` along the normal: on a mesh, whose normals are blended, `n · v` is not quite the rate of the height, and
    /// accelerations from it would grow like `h⁻¹`. What is along the surface is to be small.
    pub fn acceleration(&self, state: &State, rates: &Rates, h: f64) -> std::result::Result<Vec<DVec3>, Failure> {
        let snake = &state.snake;
        let velocities = &rates.velocity.vectors;
        let runs = self.runs(&state.rails);
        let mut conditions: Vec<Row> = Vec::new();
        self.task.fixed.iter().for_each(|&i| conditions.extend(near_vector(i as usize, DVec3::ZERO, 1.0)));
        for (k, rail) in self.task.rails.iter().enumerate() {
            match rail.point() {
                // A follower's parameter is solved for after the step; its own acceleration along the rail is left to the
                // conditions.
                Some(point) => {
                    let wanted = runs[k].1[1];
                    if matches!(rail, Rail::Driven { .. }) {
                        conditions.extend(near_vector(point as usize, wanted, 1.0));
                    } else {
                        let tangent = rail.curve().tangent(state.rails[k].parameter);
                        let (a, b) = tangent.any_orthonormal_pair();
                        let row =
                            |axis: DVec3| Row { terms: vec![(point, axis)], right: axis.dot(wanted), weight: 1.0 };
                        conditions.extend([row(a), row(b)]);
                    }
                }
                None => {
                    let at = state.rails[k];
                    let direction = across(snake, rail.curve(), at).map_err(|halt| Failure::Rail(k, halt))?;
                    let [angle, parameter] = self.glide(state, rail, k, velocities);
                    let [point, first, second] = arc_point(snake, at.arc as usize, at.angle_rad);
                    let bend = parameter * parameter * rail.curve().at(at.parameter).second
                        - 2.0 * angle * first.of(velocities)
                        - angle * angle * second.of(snake.control());
                    conditions.push(point.row(direction, direction.dot(bend)));
                }
            }
        }
        let mut wishes = Vec::new();
        for (i, (p, v)) in snake.control().iter().zip(velocities).enumerate() {
            let mut wanted = DVec3::ZERO;
            if let Some(surface) = self.task.surface {
                let [before, now] = [*p - h * *v, *p].map(|point| height(surface, point));
                let foot = surface.nearest(*p + h * *v);
                let after = foot.normal.dot(*p + h * *v - foot.point);
                let bend = (2.0 * now - before - after) / (h * h);
                wanted = bend * foot.normal;
                wishes.push(Row { terms: vec![(i as u32, foot.normal)], right: bend, weight: 1.0 });
            }
            wishes.extend(near_vector(i, wanted, self.options.alpha));
        }
        if self.options.weights.rotation > 0.0 {
            let mut rows = rotation_minimising(snake, self.options.weights.rotation);
            for row in &mut rows {
                // The second derivative of half the squared distance is to be 0.
                let [(i, apart), (j, _)] = row.terms[..] else { continue };
                let of_control = (snake.control()[i as usize] - snake.control()[j as usize]).length();
                let rate = velocities[i as usize].distance_squared(velocities[j as usize]);
                row.right = if of_control > 0.0 { -rate * apart.length() / of_control } else { 0.0 };
            }
            wishes.extend(rows);
        }
        Ok(self.admissible(snake, Some(velocities), &conditions, &mut wishes)?.vectors)
    }

    /// Where velocities, and accelerations, lead to in the time `h`, before the projection.
    pub fn predict(&self, state: &State, rates: &Rates, h: f64) -> std::result::Result<Vec<DVec3>, Failure> {
        let velocities = &rates.velocity.vectors;
        let first = state.snake.control().iter().zip(velocities).map(|(p, v)| p + h * v);
        if !self.options.is_second_order {
            return Ok(first.collect());
        }
        let accelerations = self.acceleration(state, rates, h)?;
        Ok(first.zip(&accelerations).map(|(p, a)| p + 0.5 * h * h * a).collect())
    }

    /// The next position after the time `h`.
    pub fn step(&self, state: &State, rates: &Rates, h: f64) -> std::result::Result<Step, Failure> {
        let predicted = self.predict(state, rates, h)?;
        let mut target = predicted.clone();
        self.task.fixed.iter().for_each(|&i| target[i as usize] = self.task.snake.control()[i as usize]);
        let mut rails = state.rails.clone();
        for (k, rail) in self.task.rails.iter().enumerate() {
            let wanted = rails[k].parameter + h * rates.rails[k];
            rails[k].parameter = match *rail {
                Rail::Following { leader, curve, .. } => {
                    let from = self.task.rails[leader].curve().point(rails[leader].parameter);
                    at_distance(curve, from, self.leads[k], wanted).map_err(|halt| Failure::Rail(k, halt))?
                }
                _ => rail.curve().inside(wanted),
            };
            if let Some(point) = rail.point() {
                target[point as usize] = rail.curve().point(rails[k].parameter);
            }
        }
        let mut near = state.snake.moved(target.clone())?;
        let predicted_residual = near.residual();
        let mut round = 0;
        let way = |(a, b): (&DVec3, &DVec3)| a.distance(*b);
        let longest = state.snake.control().iter().zip(&target).map(way).fold(0.0, f64::max);
        let reach = (REACH * longest).max(f64::MIN_POSITIVE);
        let (projected, incongruence) = loop {
            let mut conditions = Vec::new();
            for (k, rail) in self.gliding() {
                let halted = |halt| Failure::Rail(k, halt);
                rails[k] = meet(&near, rail.curve(), rails[k]).map_err(halted)?;
                let direction = across(&near, rail.curve(), rails[k]).map_err(halted)?;
                let on = rail.curve().point(rails[k].parameter);
                let [point, ..] = arc_point(&near, rails[k].arc as usize, rails[k].angle_rad);
                conditions.push(point.row(direction, direction.dot(on)));
            }
            let (found, incongruence) = self.project(&target, &conditions, reach)?;
            round += 1;
            let misses = self.misses(&found.snake, &mut rails)? > MEETS * self.length;
            if !misses || round == MOST_ROUNDS {
                break (found, incongruence);
            }
            near = found.snake;
        };
        let taken = projected.snake.control().iter().zip(&predicted).map(|(a, b)| a.distance(*b));
        let taken_back = taken.fold(0.0, f64::max);
        let state = State { snake: projected.snake.clone(), rails };
        Ok(Step { state, projected, predicted_residual, incongruence, taken_back })
    }

    /// The rails that the snake glides on.
    fn gliding(&self) -> impl Iterator<Item = (usize, &'a Rail<'a>)> {
        self.task.rails.iter().enumerate().filter(|(_, rail)| rail.point().is_none())
    }

    /// By how much a snake misses gliding rails at most. `rails` become where they are nearest.
    fn misses(&self, snake: &Snake, rails: &mut [OnRail]) -> std::result::Result<f64, Failure> {
        let mut most = 0.0_f64;
        for (k, rail) in self.gliding() {
            rails[k] = meet(snake, rail.curve(), rails[k]).map_err(|halt| Failure::Rail(k, halt))?;
            let [point, ..] = arc_point(snake, rails[k].arc as usize, rails[k].angle_rad);
            most = most.max(point.of(snake.control()).distance(rail.curve().point(rails[k].parameter)));
        }
        Ok(most)
    }

    /// The projection, with the distances three apart if they can be kept, and by how much those are off.
    fn project(&self, target: &[DVec3], conditions: &[Row], reach: f64) -> Result<(Projected, f64)> {
        let surface = self.task.surface.map(|reference| Surface { reference, heights: &self.heights, reach });
        let options = projection::Options {
            is_exact: self.options.projection.is_exact && surface.is_none(),
            ..self.options.projection
        };
        let mut task = projection::Task {
            snake: self.task.snake,
            distances: &self.further,
            target,
            fixed: &self.fixed,
            conditions,
            surface,
        };
        let found = match project(&task, &options) {
            Err(error)
                if !self.further.is_empty() && matches!(error.status(), Status::Singular | Status::NoSolution) =>
            {
                task.distances = &[];
                project(&task, &options)
            }
            found => found,
        }?;
        let control = found.snake.control();
        let off = |distance: &Distance| {
            let [i, j] = distance.points.map(|i| control[i as usize]);
            (i.distance(j) - distance.length).abs()
        };
        let incongruence = self.further.iter().map(off).fold(0.0, f64::max);
        Ok((found, incongruence))
    }

    /// The largest distance of a contact point or the middle of an arc from the surface; 0 without one.
    pub fn deviation(&self, snake: &Snake) -> f64 {
        let Some(surface) = self.task.surface else { return 0.0 };
        let middles = snake.arcs().into_iter().map(|arc| arc.point(0.5));
        let points = snake.contacts().into_iter().chain(middles);
        points.map(|point| surface.nearest(point).point.distance(point)).fold(0.0, f64::max)
    }
}
