//! Projections to the shape space.

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::projection::{Options, Task, project};

use crate::group::Group;
use crate::own::{basis, jacobian, largest, rest, stretch};
use crate::shapes::{Random, open_snake, regular};

fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: projection to the shape space (Bartoň et al. 2013, section 3.2)",
        "What keeps its distances stays; noisy positions come to the nearest one, whose way is at right angles to all motions\n\
         (checked by Gram and Schmidt on equations (4)). Residuals over the size of the snake.",
    );
    let exact = Options { is_exact: true, ..Options::default() };
    let still = [open_snake(1, 4)?, open_snake(12, 5)?, regular(8)?];
    let moved = |snake: &Snake| -> Result<f64> {
        let found = project(&Task::new(snake, snake.control()), &Options::default())?.snake;
        Ok(largest(found.control().iter().zip(snake.control()).map(|(a, b)| a.distance(*b))))
    };
    let moved = still.iter().map(moved).collect::<Result<Vec<_>>>()?;
    group.at_most("a snake in the shape space moves by", largest(moved.into_iter()), 1e-14);
    for noise in [0.005, 0.02, 0.05] {
        let (mut residual, mut ratio, mut along) = (0.0_f64, 0.0_f64, 0.0_f64);
        for seed in 0..20 {
            let snake = open_snake(8, 11 + seed)?;
            let mut random = Random::new(seed);
            let target: Vec<DVec3> = snake.control().iter().map(|&p| p + noise * random.vector()).collect();
            let task = Task::new(&snake, &target);
            let [near, nearest] = [project(&task, &Options::default())?.snake, project(&task, &exact)?.snake];
            residual = residual.max(stretch(&snake, &near).max(stretch(&snake, &nearest)) / snake.size());
            let way = apart(nearest.control(), &target);
            ratio = ratio.max(apart(near.control(), &target) / way);
            let vector: Vec<f64> =
                target.iter().zip(nearest.control()).flat_map(|(a, b)| ((*a - *b) / way).to_array()).collect();
            along = along.max(rest(&vector, &basis(jacobian(nearest.control(), false, &[]))));
        }
        group.at_most(&format!("noise {noise}: distances off by"), residual, 1e-13);
        group.at_most(&format!("noise {noise}: way over the shortest"), ratio, 1.001);
        group.at_most(&format!("noise {noise}: shortest way along motions"), along, 1e-9);
    }
    Ok(group)
}
