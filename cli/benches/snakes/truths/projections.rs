//! Projections to the shape space.

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::projection::{Options, Task, project};

use crate::group::Group;
use crate::own::{basis, jacobian, largest, rest, stretch};
use crate::shapes::{Random, open_snake, regular, unit_arcs};

fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: projection to the shape space (Bartoň et al. 2013, section 3.2)",
        "What keeps its distances stays; noisy positions come to the nearest one, whose way is at right angles to all motions\n\
         (checked by Gram and Schmidt on equations (4)). Residuals over the length of the control polygon.",
    );
    let still = [open_snake(1, 4)?, open_snake(12, 5)?, regular(8)?];
    let moved = |snake: &Snake| -> Result<f64> {
        let found = project(&Task::new(snake, snake.control()), &Options::default())?.snake;
        Ok(largest(found.control().iter().zip(snake.control()).map(|(a, b)| a.distance(*b))))
    };
    let moved = still.iter().map(moved).collect::<Result<Vec<_>>>()?;
    group.at_most("a snake in the shape space moves by", largest(moved.into_iter()), 1e-14);
    for noise in [0.005, 0.02, 0.05] {
        let [residual, ratio, along] = worst(noise, &|seed| unit_arcs(8, 11 + seed))?;
        group.at_most(&format!("noise {noise}: distances off by"), residual, 1e-13);
        group.at_most(&format!("noise {noise}: way over the shortest"), ratio, 1.001);
        group.at_most(&format!("noise {noise}: shortest way along motions"), along, 1e-9);
    }
    // Arcs as short as the noise.
    let [residual, ratio, along] = worst(0.05, &|seed| open_snake(8, 11 + seed))?;
    group.plain("noise 0.05, uneven arcs down to 0.3: distances off by", residual);
    group.plain("noise 0.05, uneven arcs down to 0.3: way over the shortest", ratio);
    group.at_most("noise 0.05, uneven arcs down to 0.3: shortest way along motions", along, 1e-9);
    Ok(group)
}

/// Of 20 snakes with noise: by how much distances are off over the length of the control polygon, the way over the shortest, and the part of that which is
/// along motions, at most.
fn worst(noise: f64, snake: &dyn Fn(u64) -> Result<Snake>) -> Result<[f64; 3]> {
    let exact = Options { is_exact: true, ..Options::default() };
    let mut worst = [0.0_f64; 3];
    for seed in 0..20 {
        let snake = snake(seed)?;
        let mut random = Random::new(seed);
        let target: Vec<DVec3> = snake.control().iter().map(|&p| p + noise * random.vector()).collect();
        let task = Task::new(&snake, &target);
        let [near, nearest] = [project(&task, &Options::default())?.snake, project(&task, &exact)?.snake];
        let length = snake.distances()[..snake.control().len() - 1].iter().map(|edge| edge.length).sum::<f64>();
        let way = apart(nearest.control(), &target);
        let vector: Vec<f64> =
            target.iter().zip(nearest.control()).flat_map(|(a, b)| ((*a - *b) / way).to_array()).collect();
        let found = [
            stretch(&snake, &near).max(stretch(&snake, &nearest)) / length,
            apart(near.control(), &target) / way,
            rest(&vector, &basis(jacobian(nearest.control(), false, &[]))),
        ];
        worst.iter_mut().zip(found).for_each(|(worst, found)| *worst = worst.max(found));
    }
    Ok(worst)
}
