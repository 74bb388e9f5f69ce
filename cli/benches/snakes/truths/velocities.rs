//! Velocities and what they are to be.

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::functionals::{
    Row, near_plane, near_vector, offset, orthogonal as orthogonal_rows, rotation_minimising, sideways, tangential,
    value,
};
use shapeop::geometry::snakes::velocity::{acceleration, velocity};

use crate::group::Group;
use crate::own::{largest, pairs};
use crate::shapes::{Random, circular, open_snake, small_circle};

/// The largest difference of a sum of squares' derivatives by velocities, from its rows, and central differences of the same
/// written out, over the largest derivative.
fn slope_error(rows: &[Row], written: &dyn Fn(&[DVec3]) -> f64, velocities: &[DVec3]) -> f64 {
    let mut slopes = vec![DVec3::ZERO; velocities.len()];
    for row in rows {
        let residual: f64 = row.terms.iter().map(|&(i, v)| v.dot(velocities[i as usize])).sum::<f64>() - row.right;
        row.terms.iter().for_each(|&(i, v)| slopes[i as usize] += 2.0 * row.weight * residual * v);
    }
    let h = 1e-3;
    let difference = |i: usize, axis: DVec3| {
        let at = |t: f64| {
            let mut moved = velocities.to_vec();
            moved[i] += t * axis;
            written(&moved)
        };
        (at(h) - at(-h)) / (2.0 * h)
    };
    let most = largest(slopes.iter().map(|s| s.abs().max_element()));
    let off =
        (0..velocities.len()).flat_map(|i| DVec3::AXES.map(|axis| (slopes[i].dot(axis) - difference(i, axis)).abs()));
    largest(off) / most
}

pub fn derivatives() -> Result<Group> {
    let mut group = Group::new(
        "truths: derivatives against central differences (Bartoň et al. 2013, section 3.1)",
        "Each functional written out as the paper has it; distances and what admissible velocities and accelerations do to\n\
         them. Relative.",
    );
    let snake = open_snake(7, 5)?;
    let (p, count) = (snake.control().to_vec(), snake.control().len());
    let mut random = Random::new(3);
    let v: Vec<DVec3> = (0..count).map(|_| random.vector()).collect();
    let normals: Vec<DVec3> = (0..count).map(|_| random.vector().normalize()).collect();
    let speeds: Vec<f64> = (0..count).map(|_| random.between(0.5, 1.5)).collect();
    let (given, plane) = (random.vector(), random.vector().normalize());
    let mut told = |name: &str, rows: &[Row], written: &dyn Fn(&[DVec3]) -> f64| {
        group.at_most(&format!("{name}: derivatives"), slope_error(rows, written, &v), 1e-6);
        let (own, theirs) = (written(&v), value(rows, &v));
        group.at_most(&format!("{name}: value"), (own - theirs).abs() / own, 1e-6);
    };
    told("tangential", &tangential(&normals, 0.7), &|v| {
        0.7 * normals.iter().zip(v).map(|(n, v)| n.dot(*v).powi(2)).sum::<f64>()
    });
    // Across the snake within the surface, by hand.
    let along = |i: usize| p[(i + 1).min(count - 1)] - p[i.saturating_sub(1)];
    let aside: Vec<DVec3> = (0..count).map(|i| normals[i].cross(along(i)).normalize()).collect();
    told("offset", &offset(&sideways(&snake, &normals)?, &speeds, 0.1), &|v| {
        0.1 * (0..count).map(|i| (aside[i].dot(v[i]) - speeds[i]).powi(2)).sum::<f64>()
    });
    told("near a vector", &near_vector(2, given, 0.3), &|v| 0.3 * v[2].distance_squared(given));
    told("near a plane", &[near_plane(4, plane, 0.9)], &|v| 0.9 * plane.dot(v[4]).powi(2));
    told("orthogonal", &orthogonal_rows(&snake, 0.2)?, &|v| {
        let within = |i: usize| {
            let j = i.clamp(1, count - 2);
            let e = (p[j + 1] - p[j]).normalize();
            let f = (p[j] - p[j - 1]).reject_from_normalized(e).normalize();
            e.dot(v[i]).powi(2) + f.dot(v[i]).powi(2)
        };
        0.2 * (0..count).map(within).sum::<f64>()
    });
    // The paper's, over the squared mean distance of points three apart.
    let mean = (3..count).map(|i| p[i].distance(p[i - 3])).sum::<f64>() / (count - 3) as f64;
    told("rotation minimising", &rotation_minimising(&snake, 0.4), &|v| {
        let of = |i: usize| ((p[i - 3] - p[i]).dot(v[i - 3] - v[i]) / mean).powi(2);
        0.4 * (3..count).map(of).sum::<f64>()
    });
    let mut wishes = tangential(&normals, 1.0);
    wishes.extend(offset(&aside, &speeds, 0.1));
    let first = velocity(&snake, &[], &wishes)?.vectors;
    let second = acceleration(&snake, &first, &[], &wishes)?.vectors;
    let fastest = largest(first.iter().map(|v| v.length()));
    // Squared distances along the parabola with these derivatives; the third power of the time is far below.
    let distance = |[i, j]: [usize; 2], t: f64| {
        let at = |i: usize| p[i] + t * first[i] + 0.5 * t * t * second[i];
        at(i).distance_squared(at(j))
    };
    let h = 1e-4;
    let rate = |pair| (distance(pair, h) - distance(pair, -h)) / (2.0 * h);
    let bend = |pair| (distance(pair, h) - 2.0 * distance(pair, 0.0) + distance(pair, -h)) / (h * h);
    let all = || pairs(count, false).into_iter();
    group.at_most("squared distances along velocities", largest(all().map(rate).map(f64::abs)) / fastest, 1e-6);
    group.at_most("twice, along accelerations", largest(all().map(bend).map(f64::abs)) / fastest.powi(2), 1e-6);
    Ok(group)
}

pub fn rigid() -> Result<Group> {
    let mut group = Group::new(
        "truths: rotation minimising velocities (Bartoň et al. 2013, section 3.1)",
        "Two points with the velocities of a rigid motion: all distances of all points stay.",
    );
    let mut worst = 0.0_f64;
    let mut random = Random::new(6);
    for seed in 0..20 {
        let snake = open_snake(10, seed)?;
        let (axis, speed) = (random.vector(), random.vector());
        let p = snake.control();
        let given: Vec<Row> = [0, 11].iter().flat_map(|&i| near_vector(i, speed + axis.cross(p[i]), 1.0)).collect();
        let v = velocity(&snake, &given, &rotation_minimising(&snake, 1.0))?.vectors;
        let rate = |i: usize, j: usize| (p[i] - p[j]).normalize().dot(v[i] - v[j]).abs();
        worst = worst.max(largest((0..12).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| rate(i, j))));
    }
    group.at_most("rates of distances, 20 snakes", worst, 1e-8);
    Ok(group)
}

/// The least root mean square speed along the snake of velocities that keep to a surface and lead sideways with speed 1.
fn least_along(snake: &Snake, normals: &[DVec3]) -> Result<f64> {
    let aside = sideways(snake, normals)?;
    let along: Vec<DVec3> = aside.iter().zip(normals).map(|(d, n)| d.cross(*n)).collect();
    let speeds = vec![1.0; aside.len()];
    let mut rows = tangential(normals, 1e3);
    rows.extend(offset(&aside, &speeds, 1e3));
    rows.extend(offset(&along, &vec![0.0; aside.len()], 1.0));
    let v = velocity(snake, &[], &rows)?.vectors;
    let squares: f64 = v.iter().zip(&along).map(|(v, a)| v.dot(*a).powi(2)).sum();
    Ok((squares / v.len() as f64).sqrt())
}

/// The least root mean square speed within arcs' planes of velocities that keep to a surface, the middle one sideways with
/// speed 1.
fn least_within(snake: &Snake, normals: &[DVec3]) -> Result<f64> {
    let aside = sideways(snake, normals)?;
    let mut conditions = tangential(normals, 1.0);
    let middle = aside.len() / 2;
    let mut row = conditions.get(middle).context("no middle")?.clone();
    (row.terms[0].1, row.right) = (aside[middle], 1.0);
    conditions.push(row);
    let rows = orthogonal_rows(snake, 1.0)?;
    let v = velocity(snake, &conditions, &rows)?.vectors;
    Ok((value(&rows, &v) / v.len() as f64).sqrt())
}

pub fn orthogonal() -> Result<Group> {
    let mut group = Group::new(
        "truths: only geodesics move at right angles to themselves (Bartoň et al. 2013, proposition 2.2)",
        "The least speed along the snake, beside sideways speeds of 1, and within the planes of arcs.",
    );
    let (straight, curved) = (circular(6, 1e-3)?, circular(6, 0.3)?);
    let flat = [DVec3::Z; 8];
    group.at_most("in the plane, arcs of 0.001 rad: along it", least_along(&straight, &flat)?, 4e-3);
    group.at_least("in the plane, arcs of 0.3 rad: along it", least_along(&curved, &flat)?, 0.1);
    let (great, small) = (circular(6, 0.25)?, small_circle(6, 0.6)?);
    let radial = |snake: &Snake| -> Vec<DVec3> { snake.control().iter().map(|p| p.normalize()).collect() };
    group.at_most("great circle of a sphere: within planes of arcs", least_within(&great, &radial(&great))?, 1e-8);
    group.at_least("small circle of a sphere: within planes of arcs", least_within(&small, &radial(&small))?, 0.1);
    Ok(group)
}
