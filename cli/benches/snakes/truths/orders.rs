//! Orders of steps before they are projected.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::evolution::{Options, evolve};
use shapeop::geometry::snakes::functionals::{near_vector, offset, sideways, tangential};
use shapeop::geometry::snakes::velocity::{acceleration, velocity};
use shapeop::mesh::ReferenceSurface;

use crate::group::Group;
use crate::own::{largest, pairs};
use crate::shapes::{Ball, on, screw, small_circle, torus};

/// The paper's weights of offsets, and of accelerations along the surface.
const WEIGHT: f64 = 0.1;
const ALPHA: f64 = 0.01;

/// Velocities on a surface, and for a step of time `h` the accelerations of equation (9) with targets at
/// the heights that control points have.
struct Rates<'a> {
    snake: &'a Snake,
    surface: &'a dyn ReferenceSurface,
    velocities: Vec<DVec3>,
}

impl<'a> Rates<'a> {
    fn new(snake: &'a Snake, surface: &'a dyn ReferenceSurface) -> Result<Self> {
        let normals: Vec<DVec3> = snake.control().iter().map(|p| surface.nearest(*p).normal).collect();
        let mut wishes = tangential(&normals, 1.0);
        wishes.extend(offset(&sideways(snake, &normals)?, &vec![1.0; normals.len()], WEIGHT));
        Ok(Self { snake, surface, velocities: velocity(snake, &[], &wishes)?.vectors })
    }

    fn accelerations(&self, h: f64) -> Result<Vec<DVec3>> {
        let mut wishes = Vec::new();
        for (i, (p, v)) in self.snake.control().iter().zip(&self.velocities).enumerate() {
            let now = self.surface.nearest(*p);
            let height = now.normal.dot(*p + h * *v - now.point);
            let foot = self.surface.nearest(*p + h * *v);
            let wanted = 2.0 / (h * h) * (foot.point + height * foot.normal - *p - h * *v);
            let mut across = near_vector(i, wanted, 1.0);
            across.truncate(1);
            (across[0].terms[0].1, across[0].right) = (foot.normal, foot.normal.dot(wanted));
            wishes.extend(across);
            wishes.extend(near_vector(i, wanted, ALPHA));
        }
        Ok(acceleration(self.snake, &self.velocities, &[], &wishes)?.vectors)
    }

    /// By how much an edge or a diagonal is off at most after a step, before it is projected.
    fn error(&self, h: f64, is_second_order: bool) -> Result<f64> {
        let bend = if is_second_order { self.accelerations(h)? } else { vec![DVec3::ZERO; self.velocities.len()] };
        let p = self.snake.control();
        let moved: Vec<DVec3> = (0..p.len()).map(|i| p[i] + h * self.velocities[i] + 0.5 * h * h * bend[i]).collect();
        let off = |[i, j]: [usize; 2]| (moved[i].distance(moved[j]) - p[i].distance(p[j])).abs();
        Ok(largest(pairs(p.len(), self.snake.is_closed()).into_iter().map(off)))
    }
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: orders of steps before the projection (Bartoň et al. 2013, section 3.4)",
        "Six arcs on the torus 2 / 0.7. With accelerations distances are off by the third power of the step, as equation (8) has\n\
         them when its first factor is the difference of positions.",
    );
    let torus = torus(2.0, 0.7)?;
    let snake = screw(6, 0.4)?;
    let snake = Snake::new(snake.control().iter().map(|p| 0.9 * *p + 1.9 * DVec3::X).collect(), false, None)?;
    let rates = Rates::new(&snake, &torus)?;
    for (is_second_order, name, order) in [(false, "first order", 2.0), (true, "second order", 3.0)] {
        for h in [0.04, 0.02] {
            let slope = (rates.error(h, is_second_order)? / rates.error(0.5 * h, is_second_order)?).log2();
            let what = format!("{name}: slope from {h} to {}", 0.5 * h);
            group.between(&what, slope, [order - 0.2, order + 0.2]);
        }
    }
    let stepped = |h: f64, is_second_order: bool| -> Result<f64> {
        let options = Options { step: h, least_step: 1.0, max_steps: 1, is_second_order, ..Options::default() };
        let found = evolve(&on(&snake, &torus), &options, &mut |_| ControlFlow::Continue(()))?;
        Ok(found.last().predicted_residual)
    };
    for (is_second_order, name, order) in [(false, "first order", 2.0), (true, "second order", 3.0)] {
        let slope = (stepped(0.02, is_second_order)? / stepped(0.01, is_second_order)?).log2();
        group.between(&format!("an evolution, {name}: slope from 0.02 to 0.01"), slope, [order - 0.2, order + 0.2]);
    }
    let ratio = rates.error(0.06, true)? / rates.error(0.02, false)?;
    group.at_most("error of second order at 0.06 over first order at 0.02", ratio, 1.0);
    let circle = small_circle(8, 0.6)?;
    let rates = Rates::new(&circle, &Ball)?;
    let size =
        |h: f64| -> Result<f64> { Ok(rates.accelerations(h)?.iter().map(|a| a.length_squared()).sum::<f64>().sqrt()) };
    let ratio = size(0.01)? / size(0.001)?;
    group.between("sphere: accelerations at h = 0.01 over 0.001", ratio, [0.95, 1.05]);
    Ok(group)
}
