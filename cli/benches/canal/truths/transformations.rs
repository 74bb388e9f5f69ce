//! Inversions, Combescure transformations, frames and patches.

use std::f64::consts::TAU;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::canal::chain::Transform;
use shapeop::geometry::canal::combescure::{Lengths, combescure};
use shapeop::geometry::canal::frame::{Direction, Frame, frames};
use shapeop::geometry::canal::inversion::{GeneralCircle, GeneralSphere, Inversion};
use shapeop::geometry::canal::parallel::{ParallelMeshes, check_parallel};
use shapeop::geometry::canal::patch::Patch;
use shapeop::geometry::canal::quality::{Quality, largest};
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::geometry::circle::{Circle, Sphere};
use shapeop::mesh::Grid;
use shapeop::mesh::grid::diagonal;

use super::{is_refused, worst};
use crate::group::Group;
use crate::shapes::{Cyclide, Random, farthest};

pub fn group() -> Result<Group> {
    let mut group = Group::new("truths: inversions, Combescure transformations, frames, patches", "");
    inversions(&mut group)?;
    parallel_nets(&mut group)?;
    patches(&mut group)?;
    Ok(group)
}

fn inversions(group: &mut Group) -> Result<()> {
    let mut random = Random(11);
    let inversion = Inversion::new(DVec3::new(0.3, -0.4, 0.2), 2.3)?;
    let points: Vec<DVec3> = (0..1000).map(|_| random.vector()).collect();
    let size = diagonal(&points);
    let points: Vec<DVec3> = points.into_iter().filter(|p| p.distance(inversion.center()) >= 1e-3 * size).collect();
    let back = inversion.points(&inversion.points(&points)?)?;
    group.at_most("T-C1 inversion twice, from the identity / diagonal", farthest(&points, &back) / size, 1e-13);

    let mut off = 0.0_f64;
    for _ in 0..200 {
        let inversion = Inversion::new(random.vector(), random.between(0.1, 2.0))?;
        let normal = random.vector().normalize();
        let circle = Circle { center: random.vector(), normal, radius: 0.2 + random.between(0.0, 1.0) };
        let GeneralCircle::Circle(image) = inversion.circle(&circle) else { continue };
        for i in 0..50 {
            let point = inversion.point(circle.point_at(DVec3::X, f64::from(i)));
            off = off.max(image.distance(point) / image.radius.max(point.distance(inversion.center())));
        }
    }
    group.at_most("T-C2 images of 50 points off the closed form's circle", off, 1e-11);

    let inversion = Inversion::new(DVec3::new(1.0, 2.0, 3.0), 1.5)?;
    let through = Sphere { center: DVec3::new(1.0, 2.0, 5.0), radius: 2.0 };
    let circle = Circle { center: DVec3::new(1.0, 4.0, 3.0), normal: DVec3::Z, radius: 2.0 };
    let flags = matches!(inversion.sphere(&through), GeneralSphere::Plane(..))
        && matches!(inversion.plane(DVec3::ZERO, DVec3::Z), GeneralSphere::Sphere(_))
        && matches!(inversion.plane(inversion.center(), DVec3::Z), GeneralSphere::Plane(..))
        && matches!(inversion.circle(&circle), GeneralCircle::Line(..));
    group.at_least("T-C3 spheres, planes, lines recognised", f64::from(flags), 1.0);

    let mut off = 0.0_f64;
    for _ in 0..1000 {
        let inversion = Inversion::new(random.vector(), random.between(0.1, 1.0))?;
        let [point, a, b] = std::array::from_fn(|_| random.vector());
        let [x, y] = [a, b].map(|direction| inversion.direction(point, direction));
        off = off.max((a.angle_between(b) - x.angle_between(y)).abs());
    }
    group.at_most("T-C4 angles kept, radians", off, 1e-9);
    Ok(())
}

fn parallel_nets(group: &mut Group) -> Result<()> {
    let mut random = Random(17);
    let cyclide = Cyclide::new()?;
    let grid = cyclide.grid([0.2, 2.2], [-0.9, 1.4], 41, 26)?;
    let own = Lengths::of(&grid);
    let lengths = own.scaled(&random.list(40, 0.5, 2.0), &random.list(25, 0.5, 2.0))?;
    let image = combescure(&grid, &lengths, DVec3::new(5.0, -1.0, 0.3))?.grid;
    let quality = Quality::of(&image);
    group.at_most("T-C5 40 × 25 faces: largest sine of edges", check_parallel(&grid, &image)?.largest_sine, 1e-12);
    group.at_most("T-C5 planarity", largest(&quality.planarity), 1e-11);
    group.at_most("T-C5 concyclicity", largest(&quality.concyclicity), 1e-11);
    let back = combescure(&image, &own, grid.at(0, 0))?.grid;
    let off = farthest(back.points(), grid.points()) / grid.diagonal();
    group.at_most("T-C6 lengths restored, from the identity / diagonal", off, 1e-10);

    let (mut wrong, mut gap) = (0.0, f64::INFINITY);
    for (n, m) in [(2, 3), (4, 4), (5, 3), (9, 7)] {
        let space = ParallelMeshes::of(&cyclide.grid([0.2, 1.8], [-0.6, 1.2], n + 1, m + 1)?.mesh())?;
        wrong += f64::from(space.basis().len() != n + m + 3);
        let rank = 3 * (n + 1) * (m + 1) - (n + m + 3);
        let values = space.singular_values();
        gap = gap.min(values[rank - 1] / values.get(rank).copied().unwrap_or(0.0));
    }
    group.at_most("T-C7 null spaces not of N + M + 3 dimensions", wrong, 0.0);
    group.at_least("T-C7 gap of the singular values at the rank", gap.min(1e300), 1e6);

    group.at_most("T-C8 equation 4 with interior angles, 1000 quads", interior_form(&mut random)?, 1e-12);

    let start =
        || -> Result<SuperCanal> { Ok(SuperCanal::new(cyclide.net([0.2, 1.9], [-0.7, 1.3], 5, 4)?, BaseKind::Canal)) };
    let invert = Transform::Inversion(Inversion::new(DVec3::new(0.1, 0.4, 0.9), -1.3)?);
    let scale = Transform::Combescure { column: random.list(4, 0.8, 1.25), row: random.list(3, 0.8, 1.25) };
    let (mut mc, mut cm) = (start()?, start()?);
    [&scale, &invert].into_iter().try_for_each(|link| mc.push(link.clone()))?;
    [&invert, &scale].into_iter().try_for_each(|link| cm.push(link.clone()))?;
    let (mc, cm) = (mc.net().grid(), cm.net().grid());
    group.at_least("T-C9 MC and CM apart / diagonal", farthest(mc.points(), cm.points()) / mc.diagonal(), 1e-2);
    group.at_most("T-C9 both planar and concyclic", worst(mc).max(worst(cm)), 1e-11);
    Ok(())
}

/// How far lengths are from equation 4, written with interior angles.
fn interior_form(random: &mut Random) -> Result<f64> {
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let angles: [f64; 4] = std::array::from_fn(|k| (k as f64 + random.between(0.1, 0.9)) * TAU / 4.0);
        let [a, b, c, d] = angles.map(|angle| DVec3::new(angle.cos(), angle.sin(), 0.0));
        let (l0, l3) = (random.between(0.2, 2.0), random.between(0.2, 2.0));
        let grid = Grid::new(vec![a, d, b, c], 2, 2, [false; 2])?;
        let image = combescure(&grid, &Lengths { column: vec![l0], row: vec![l3] }, DVec3::ZERO)?.grid;
        let l1 = (image.at(1, 1) - image.at(1, 0)).dot((c - b).normalize());
        let l2 = (image.at(1, 1) - image.at(0, 1)).dot((c - d).normalize());
        let angle = |at: DVec3, from: DVec3, to: DVec3| (from - at).angle_between(to - at);
        let (alpha, beta, delta) = (angle(a, b, d), angle(b, a, c), angle(d, a, c));
        let first = l0 - l3 * alpha.cos() - beta.cos() * l1 + (alpha + delta).cos() * l2;
        let second = l3 * alpha.sin() - beta.sin() * l1 - (alpha + delta).sin() * l2;
        worst = worst.max(first.abs()).max(second.abs());
    }
    Ok(worst)
}

fn patches(group: &mut Group) -> Result<()> {
    let mut random = Random(9);
    let (mut closed, mut open, mut refused) = (0.0_f64, f64::INFINITY, 0.0);
    for _ in 0..1000 {
        let frame = Frame::of_angles(random.between(0.0, 6.0), random.between(0.0, 3.0), random.between(0.0, 6.0));
        let angles: [f64; 4] = std::array::from_fn(|k| (k as f64 + random.between(0.1, 0.9)) * TAU / 4.0);
        let normal = random.vector().normalize();
        let x = normal.any_orthonormal_vector();
        let corners = angles.map(|angle| angle.cos() * x + angle.sin() * normal.cross(x));
        let gap = |corners: &[DVec3; 4]| {
            let directions = [Direction::One, Direction::Two, Direction::One, Direction::Two];
            let step = |around: Frame, k: usize| around.across(corners[(k + 1) % 4] - corners[k], directions[k]);
            (0..4).fold(frame, step).distance(&frame)
        };
        closed = closed.max(gap(&corners));
        let mut lifted = corners;
        lifted[2] += 0.1 * normal;
        open = open.min(gap(&lifted));
        let [a, b, c, d] = lifted;
        refused += is_refused(frames(&Grid::new(vec![a, d, b, c], 2, 2, [false; 2])?, frame), Status::NotCircular);
    }
    group.at_most("T-C10 frames around 1000 circular quads, from themselves", closed, 1e-13);
    group.at_least("T-C10 around quads with a lifted corner, at least", open, 1e-6);
    group.at_least("T-C10 those refused as not circular", refused, 1000.0);

    let cyclide = Cyclide::new()?;
    let corners = [(0.2, -0.4), (1.5, -0.4), (1.5, 1.3), (0.2, 1.3)].map(|(u, v)| cyclide.point(u, v));
    let patch = Patch { corners, frame: cyclide.frame(0.2, -0.4) };
    let off = (0..81).map(|k| patch.at(f64::from(k / 9) / 8.0, f64::from(k % 9) / 8.0).0);
    let off = off.map(|point| cyclide.distance(point).abs()).fold(0.0, f64::max);
    group.at_most("T-C11 9 × 9 points of a patch off their cyclide", off, 1e-13);

    let mut surface = SuperCanal::new(cyclide.net([0.2, 1.9], [-0.7, 1.3], 5, 4)?, BaseKind::Canal);
    surface.push(Transform::Combescure { column: random.list(4, 0.8, 1.25), row: random.list(3, 0.8, 1.25) })?;
    let (mut points, mut normals) = (0.0_f64, 0.0_f64);
    for i in 0..3 {
        for j in 0..3 {
            let (here, next) = (surface.net().patch(i, j)?, surface.net().patch(i + 1, j)?);
            for k in 1..10 {
                let (point, frame) = here.at(1.0, 0.1 * f64::from(k));
                let (other, other_frame) = next.at(0.0, next.arc_two().fraction_of(point));
                points = points.max(point.distance(other));
                normals = normals.max(frame.normal.distance(other_frame.normal));
            }
        }
    }
    group.at_most("T-C12 neighbouring patches along their arc: points", points, 1e-12);
    group.at_most("T-C12 their normals", normals, 1e-12);
    Ok(())
}
