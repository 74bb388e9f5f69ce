//! Snakes and their freedoms.

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::freedoms::{freedoms as of, freedoms_on_surface};
use shapeop::geometry::snakes::{ArcShape, Pose, Snake};

use super::exactly;
use crate::group::Group;
use crate::own::{basis, jacobian, largest};
use crate::shapes::{Random, circular, open_snake, random_arcs, regular};

/// Contacts of arcs laid one after the other, each in the frame in which the last one ends.
fn laid(arcs: &[ArcShape], torsions: &[f64], pose: &Pose) -> Vec<DVec3> {
    let mut t = pose.tangent.normalize();
    let mut n = (pose.normal - pose.normal.dot(t) * t).normalize();
    let mut contacts = vec![pose.point];
    for (j, arc) in arcs.iter().enumerate() {
        let (sine, cosine) = (arc.length / arc.radius).sin_cos();
        let last = contacts[contacts.len() - 1];
        contacts.push(last + arc.radius * (sine * t + (1.0 - cosine) * n));
        let b = t.cross(n);
        (t, n) = (cosine * t + sine * n, cosine * n - sine * t);
        if let Some(torsion) = torsions.get(j) {
            n = torsion.cos() * n + torsion.sin() * b;
        }
    }
    contacts
}

/// The unit tangent, at the last of three points of an arc, of the circle through them.
fn end_tangent([p, q, r]: [DVec3; 3]) -> DVec3 {
    // From the chords: the tangent is the last chord turned on by the angle between it and the one from first to last.
    let (chord, whole) = ((r - q).normalize(), (r - p).normalize());
    (2.0 * chord * chord.dot(whole) - whole).normalize()
}

pub fn arcs() -> Result<Group> {
    let mut group = Group::new(
        "truths: arcs, torsions and pose to control points and back (Bartoň et al. 2013, section 2)",
        "100 random snakes of 1 to 12 arcs of radii about 1, beside arcs laid one after the other.",
    );
    let (mut contacts, mut shapes, mut torsions, mut smooth, mut unequal) =
        (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for seed in 0..100 {
        let count = [1, 2, 3, 6, 12][seed as usize % 5];
        let (arcs, turns, pose) = random_arcs(count, seed);
        let snake = Snake::from_arcs(&arcs, &turns, &pose)?;
        let expected = laid(&arcs, &turns, &pose);
        contacts = contacts.max(largest(snake.contacts().iter().zip(&expected).map(|(a, b)| a.distance(*b))));
        let again = Snake::new(snake.control().to_vec(), false, None)?;
        let off = |(a, b): (&ArcShape, &ArcShape)| (a.radius - b.radius).abs().max((a.length - b.length).abs());
        shapes = shapes.max(largest(again.shapes().iter().zip(&arcs).map(off)));
        torsions = torsions.max(largest(again.torsions().iter().zip(&turns).map(|(a, b)| (a - b).abs())));
        // Contacts are as far from the vertex on both sides (equation 1).
        let (found, control) = (again.contacts(), again.control());
        let sides =
            (0..count).map(|j| (control[j + 1].distance(found[j]) - control[j + 1].distance(found[j + 1])).abs());
        unequal = unequal.max(largest(sides));
        // From three points of each arc that share no tangent with it.
        let arcs = again.arcs();
        let point = |j: usize, part: f64| arcs[j].point(part);
        let kinks = (1..count).map(|j| {
            let before = end_tangent([point(j - 1, 0.0), point(j - 1, 0.5), point(j - 1, 1.0)]);
            let after = -end_tangent([point(j, 1.0), point(j, 0.5), point(j, 0.0)]);
            before.distance(after)
        });
        smooth = smooth.max(largest(kinks));
    }
    group.at_most("contact points", contacts, 1e-12);
    group.at_most("radii and lengths", shapes, 1e-12);
    group.at_most("torsions", torsions, 1e-12);
    group.at_most("tangent lengths at a vertex, unequal by", unequal, 1e-12);
    group.at_most("tangents of neighbouring arcs at contacts, from points", smooth, 1e-12);
    Ok(group)
}

pub fn freedoms() -> Result<Group> {
    let mut group = Group::new(
        "truths: freedoms of snakes (Bartoň et al. 2013, section 2)",
        "Ours, and by Gram and Schmidt on equations (4): N + 5 of an open snake, N of a closed one with six arcs or more,\n\
         3 on a surface.",
    );
    let both = |group: &mut Group, name: &str, snake: &Snake, normals: &[DVec3], expected: usize| -> Result<()> {
        let free = if normals.is_empty() { of(snake)? } else { freedoms_on_surface(snake, normals)? }.free;
        let rank = basis(jacobian(snake.control(), snake.is_closed(), normals)).len();
        exactly(group, &format!("{name}, ours"), free, expected);
        exactly(group, &format!("{name}, by rows"), 3 * snake.control().len() - rank, expected);
        Ok(())
    };
    for (count, free) in [(1, 6), (3, 8), (6, 11), (12, 17)] {
        both(&mut group, &format!("open, {count} arcs"), &open_snake(count, 3)?, &[], free)?;
    }
    let mut random = Random::new(8);
    for (count, free) in [(5, 6), (6, 6), (7, 7), (10, 10)] {
        let flat = regular(count)?;
        let shaken = flat.moved(flat.control().iter().map(|p| *p + 0.2 * random.vector()).collect())?;
        both(&mut group, &format!("closed, {count} arcs"), &shaken, &[], free)?;
    }
    let circle = circular(8, 0.3)?;
    both(&mut group, "open, 8 arcs in a plane", &circle, &[DVec3::Z; 10], 3)?;
    let radial: Vec<DVec3> = circle.control().iter().map(|p| *p - 0.6 * DVec3::Z).collect();
    both(&mut group, "small circle, 8 arcs on a sphere", &circle, &radial, 3)?;
    for count in [3, 12] {
        let normals: Vec<DVec3> = (0..count + 2).map(|_| random.vector()).collect();
        both(&mut group, &format!("{count} arcs, any normals"), &open_snake(count, 9)?, &normals, 3)?;
    }
    Ok(group)
}
