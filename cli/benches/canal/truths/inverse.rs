//! Inverse problems, smoothing, remeshing, membrane forces.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::canal::bases::revolution;
use shapeop::geometry::canal::c_canal::{Target, c_canal};
use shapeop::geometry::canal::chain::{self, Transform};
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::inversion::{GeneralCircle, Inversion};
use shapeop::geometry::canal::m_revolution::m_revolution;
use shapeop::geometry::canal::membrane::{least_residual, residual_of};
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::revolution_centers::{Center, Corners};
use shapeop::geometry::canal::smoothing::{Input, Options, smooth};
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::geometry::circle::Circle;
use shapeop::mesh::Grid;
use shapeop::mesh::fit::Plane;

use super::{is_refused, off_circle, worst};
use crate::group::Group;
use crate::shapes::{Cyclide, Random, c_guide, chord, ellipse, farthest, planar_curve};
use crate::speed::{rough_strip, wave};

pub fn group() -> Result<Group> {
    let mut group = Group::new("truths: inverse problems, smoothing, remeshing, membrane forces", "");
    centers(&mut group)?;
    revolutions(&mut group)?;
    sections(&mut group)?;
    smoothing(&mut group)?;
    remeshing(&mut group)?;
    membrane(&mut group)?;
    Ok(group)
}

/// Four points of a circle anywhere in space, at least 0.1 radians from each other.
fn on_circle(random: &mut Random) -> [DVec3; 4] {
    let normal = random.vector().normalize();
    let circle = Circle { center: random.vector(), normal, radius: random.between(0.2, 3.0) };
    loop {
        let mut angles: [f64; 4] = std::array::from_fn(|_| random.between(0.0, TAU));
        angles.sort_by(f64::total_cmp);
        let gaps = (0..4).map(|k| if k < 3 { angles[k + 1] - angles[k] } else { angles[0] + TAU - angles[3] });
        if gaps.fold(TAU, f64::min) > 0.1 {
            return angles.map(|angle| circle.point_at(circle.center + DVec3::X, angle));
        }
    }
}

/// How far four points are from an isosceles trapezoid with parallel sides `P1 P2` and `P4 P3`; the ratio of the
/// sides; the height
/// over the longer of them.
fn trapezoid([p1, p2, p3, p4]: [DVec3; 4]) -> [f64; 3] {
    let (first, second) = (p2 - p1, p3 - p4);
    let size = first.length().max(second.length());
    let parallel = first.normalize().distance(second.normalize());
    let legs = (p1.distance(p4) - p2.distance(p3)).abs() / size;
    let height = (p4 - p1).reject_from_normalized(first.normalize()).length() / size;
    [parallel.max(legs), first.length() / second.length(), height]
}

fn centers(group: &mut Group) -> Result<()> {
    let mut random = Random(21);
    let (mut off, mut flattest, mut refused) = (0.0_f64, f64::INFINITY, 0.0);
    for _ in 0..500 {
        let points = on_circle(&mut random);
        let corners = Corners::new(points)?;
        let [low, high] = corners.ratio_limits();
        let ratio = low * (high / low).powf(random.between(0.02, 0.98));
        for omega in corners.angles_of_ratio(ratio)? {
            let center = corners.center_at(omega).context("a center at infinity")?;
            let inversion = Inversion::new(center, center.distance_squared(points[0]))?;
            let [error, found, height] = trapezoid(points.map(|point| inversion.point(point)));
            off = off.max(error).max((found / ratio - 1.0).abs());
            flattest = flattest.min(height);
        }
        for outside in [0.9 * low, 1.1 * high, 0.0, -1.0] {
            refused += is_refused(corners.angles_of_ratio(outside), Status::NoSolution);
        }
    }
    group.at_most("T-C21 500 quads: images off isosceles trapezoids", off, 1e-9);
    group.at_least("T-C22 ratios outside their interval refused", refused, 2000.0);
    group.at_least("T-C22 least height of a solution's trapezoid", flattest, 1e-4);
    Ok(())
}

fn revolutions(group: &mut Group) -> Result<()> {
    let meridian = |k: i32| {
        let s = f64::from(k) / 11.0;
        DVec3::new(1.0 + 0.8 * (4.0 * s).sin() * s, 2.0 * s, 0.0)
    };
    let meridian: Vec<DVec3> = (0..12).map(meridian).collect();
    let base = revolution(&meridian, DVec3::ZERO, DVec3::NEG_Y, PI, 7)?;
    let (mut off_circle_of_centers, mut off_root, mut off_points) = (0.0_f64, 0.0_f64, 0.0_f64);
    // Off the axis, whose image is a circle then.
    for (x, y, power) in [(-0.2, 3.5, 1.0), (0.15, -1.0, 2.0), (0.1, 0.7, -1.3)] {
        let center = DVec3::new(x, y, 0.0);
        let points = Inversion::new(center, power)?.points(base.grid.points())?;
        let at = |i: usize, j: usize| points[7 * i + j];
        let corners = Corners::new([at(0, 0), at(0, 6), at(11, 6), at(11, 0)])?;
        let GeneralCircle::Circle(circle) = corners.circle_of_centers() else { bail!("expected a circle") };
        off_circle_of_centers = off_circle_of_centers.max(circle.distance(center));
        let roots = corners.angles_of_ratio(meridian[0].x / meridian[11].x)?;
        let nearest = roots.iter().filter_map(|&omega| corners.center_at(omega)).map(|root| root.distance(center));
        off_root = off_root.max(nearest.fold(f64::INFINITY, f64::min));
        let curve: Vec<DVec3> = (0..12).map(|i| at(i, 0)).collect();
        let up = at(3, 3) - at(3, 0);
        let found = m_revolution(&curve, at(0, 6), at(11, 6), Center::At(center), up, 7)?;
        off_points = off_points.max(farthest(found.image.grid()?.points(), &points));
    }
    group.at_most("T-C23 known center off its circle of centers", off_circle_of_centers, 1e-9);
    group.at_most("T-C23 nearest root off the known center", off_root, 1e-9);
    group.at_most("T-C23 surface found off the known one", off_points, 1e-9);

    let isosceles = [(-2.0, 0.0), (2.0, 0.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let corners = Corners::new(isosceles)?;
    let roots = corners.angles_of_ratio(2.0)?.map(|omega| corners.center_at(omega));
    let finite: Vec<DVec3> = roots.into_iter().flatten().collect();
    let is_one = finite.len() == 1 && finite[0].distance(corners.circle().center) < 1e-9;
    group.at_least("T-C24 isosceles already: identity and one root", f64::from(is_one), 1.0);

    let (curve, p2, p3) = planar_curve(23);
    let (mut upright, mut off) = (0.0_f64, 0.0_f64);
    for center in [Center::Middle, Center::Angle(0.4), Center::Angle(-2.5)] {
        let grid = m_revolution(&curve, p2, p3, center, DVec3::Z, 9)?.image.grid()?;
        off = off.max(off_circle(&grid));
        for i in 0..23 {
            let circle = Circle::through(grid.at(i, 0), grid.at(i, 4), grid.at(i, 8)).context("no circle")?;
            upright = upright.max(circle.normal.z.abs());
            off = grid.row(i).iter().map(|point| circle.distance(*point)).fold(off, f64::max);
        }
    }
    group.at_most("T-C25 parallels off vertical planes", upright, 1e-10);
    group.at_most("T-C25 points and quads off their circles", off, 1e-10);
    Ok(())
}

fn sections(group: &mut Group) -> Result<()> {
    let mut on = |_: f64| ControlFlow::Continue(());
    let circle = ellipse(9, 1.0);
    let lengths = vec![chord(&circle); 17];
    let found = c_canal(&c_guide(16), &circle, Target::Lengths(&lengths), false, &mut on)?;
    let (base, net) = (found.surface.base().grid(), found.surface.net().grid());
    group.at_most("T-C26 section on a circle: from the identity", farthest(base.points(), net.points()), 1e-12);
    group.at_most("T-C26 E", found.residual(), 1e-24);
    let (mut off_plane, mut off_section, mut off) = (0.0_f64, 0.0_f64, 0.0_f64);
    for height in [0.6, 1.7] {
        let section = ellipse(11, height);
        let lengths = vec![chord(&section); 33];
        let found = c_canal(&c_guide(32), &section, Target::Lengths(&lengths), false, &mut on)?;
        let grid = found.surface.net().grid();
        for k in 0..grid.rows() {
            let plane = Plane::fitting(grid.row(k));
            off_plane = grid.row(k).iter().map(|&point| plane.height(point).abs()).fold(off_plane, f64::max);
        }
        off_section = off_section.max(farthest(grid.row(0), &section));
        off = off.max(worst(grid));
    }
    group.at_most("T-C27 sections off their planes", off_plane, 1e-10);
    group.at_most("T-C27 first row off the section given", off_section, 1e-10);
    group.at_most("T-C27 planarity and concyclicity", off, 1e-10);
    Ok(())
}

fn smoothing(group: &mut Group) -> Result<()> {
    let (parameters, strip, frame) = rough_strip(16)?;
    let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
    let options = Options { max_iterations: 2000, ..Options::default() };
    let found = smooth(&input, &options, &mut |_| ControlFlow::Continue(()))?;
    group.plain("T-C28 F before, 16 circles", found.before);
    group.at_most("T-C28 F after", found.after, found.before);
    let rising = found.history.windows(2).filter(|pair| pair[1] > pair[0]).count();
    group.at_most("T-C28 iterations at which it rose", rising as f64, 0.0);
    let on_curve: Vec<DVec3> = found.parameters.iter().map(|&u| wave(u)).collect();
    group.at_most("T-C28 guide off its curve", farthest(&found.strip.guide, &on_curve), 1e-12);
    Ok(())
}

fn remeshing(group: &mut Group) -> Result<()> {
    let mut random = Random(5);
    let mut surface = SuperCanal::new(Cyclide::new()?.net([0.2, 1.9], [-0.7, 1.3], 5, 4)?, BaseKind::Canal);
    for _ in 0..2 {
        surface.push(Transform::Combescure { column: random.list(4, 0.8, 1.25), row: random.list(3, 0.8, 1.25) })?;
        surface.push(Transform::Inversion(Inversion::new(DVec3::new(0.1, 0.4, 0.9), -1.3)?))?;
    }
    let coarse = surface.net().grid();
    let (mut kept, mut off, mut back) = (0.0_f64, 0.0_f64, 0.0_f64);
    for pieces in [2, 4] {
        let fine = surface.refined(pieces, pieces)?;
        for i in 0..coarse.rows() {
            for j in 0..coarse.columns() {
                kept = kept.max(fine.grid().at(pieces * i, pieces * j).distance(coarse.at(i, j)) / coarse.diagonal());
            }
        }
        off = off.max(worst(fine.grid()));
        let restored = chain::apply(&chain::inverse(surface.chain()), &fine, [pieces; 2])?;
        let base = surface.base().refined(pieces, pieces)?;
        back = back.max(farthest(restored.grid().points(), base.grid().points()) / base.grid().diagonal());
    }
    group.at_most("T-C29 2 × and 4 × finer: old points / diagonal", kept, 1e-9);
    group.at_most("T-C29 new quads: planarity and concyclicity", off, 1e-9);
    group.at_most("T-C29 chain and inverse, from the identity / diagonal", back, 1e-9);
    Ok(())
}

/// Rows around z, columns along the meridian `(radius, height)`.
fn around(meridian: impl Fn(usize) -> (f64, f64), columns: usize, wraps: bool) -> Result<Grid> {
    let point = |k: usize| {
        let (angle, (radius, height)) = (TAU * (k / columns) as f64 / 48.0, meridian(k % columns));
        DVec3::new(radius * angle.cos(), radius * angle.sin(), height)
    };
    Ok(Grid::new((0..48 * columns).map(point).collect(), 48, columns, [true, wraps])?)
}

fn membrane(group: &mut Group) -> Result<()> {
    let (radius, pressure) = (1.7, 2.5);
    let at = |j: usize| 0.3 + (PI - 0.6) * j as f64 / 60.0;
    let grid = around(|j| (radius * at(j).sin(), -radius * at(j).cos()), 61, false)?;
    let normal = DVec3::new(at(0).sin(), 0.0, -at(0).cos());
    let net = Net::new(grid, Frame::of_tangent_one(DVec3::Y, normal).context("no frame")?)?;
    let forces = vec![0.5 * pressure * radius; 48 * 60];
    group.at_most("T-C30 sphere: p R / 2 both ways, residual", residual_of(&net, pressure, &forces, &forces)?, 1e-3);
    let (ring, tube, columns) = (3.0, 0.8, 160);
    let angle = |j: f64| TAU * j / 160.0;
    let grid = around(|j| (ring + tube * angle(j as f64).cos(), tube * angle(j as f64).sin()), columns, true)?;
    let net = Net::new(grid, Frame::of_tangent_one(DVec3::Y, DVec3::X).context("no frame")?)?;
    let force = |k: usize| {
        let cosine = angle((k % columns) as f64 + 0.5).cos();
        0.5 * pressure * tube * (2.0 * ring + tube * cosine) / (ring + tube * cosine)
    };
    let one = vec![0.5 * pressure * tube; 48 * columns];
    let two: Vec<f64> = (0..48 * columns).map(force).collect();
    group.at_most("T-C30 torus: p r / 2 along the ring, residual", residual_of(&net, pressure, &one, &two)?, 1e-3);

    let mut random = Random(3);
    let mut surface = SuperCanal::new(Cyclide::new()?.net([0.2, 2.0], [-0.5, 1.2], 5, 5)?, BaseKind::Canal);
    let residual =
        |surface: &SuperCanal, pieces: usize| -> Result<f64> { Ok(least_residual(&surface.refined(pieces, pieces)?)?) };
    let (coarse, fine) = (residual(&surface, 2)?, residual(&surface, 4)?);
    group.plain("T-C30 canal surface, forces of least squares, residual", coarse);
    group.at_most("T-C30 canal surface, twice as fine", fine, 0.5 * coarse);
    surface.push(Transform::Combescure { column: random.list(4, 0.6, 1.7), row: random.list(4, 0.6, 1.7) })?;
    group.plain("T-C30 C-canal surface beside it", residual(&surface, 2)?);
    group.plain("T-C30 C-canal surface, twice as fine", residual(&surface, 4)?);
    surface.push(Transform::Inversion(Inversion::new(DVec3::new(0.2, 0.9, 1.0), 1.0)?))?;
    group.plain("T-C30 MC-canal surface beside it", residual(&surface, 2)?);
    group.plain("T-C30 MC-canal surface, twice as fine", residual(&surface, 4)?);
    Ok(())
}
