//! Boundaries on surfaces where they are known, and whether strips between them cover the surface.

use glam::DVec3;

use super::boundaries::{Boundaries, BoundaryOptions, Drawn, Levels, drawn_boundaries, level_boundaries};
use super::planar_boundaries::{PlanarOptions, Plane, planar_boundaries};
use super::{Boundary, Field};
use crate::error::Status;
use crate::mesh::TriangleMesh;
use crate::mesh::patterns::{height_field, parametric_surface};
use crate::mesh::reference::ReferenceMesh;

fn plane(n: usize, slope: impl Fn(f64, f64) -> DVec3) -> (TriangleMesh, Field) {
    let mesh = height_field(n, n, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap();
    let mesh = TriangleMesh::new(&mesh).unwrap();
    let slopes: Vec<DVec3> = mesh.points().iter().map(|p| slope(p.x, p.y).normalize_or_zero()).collect();
    let is_known = slopes.iter().map(|a| *a != DVec3::ZERO).collect();
    let field = Field::new(&mesh, slopes, is_known).unwrap();
    (mesh, field)
}

fn values(mesh: &TriangleMesh, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    mesh.points().iter().map(|p| f(p.x, p.y)).collect()
}

/// Whether the line from a point along a direction meets a polyline in the plane, on the side of the sign.
fn is_met(boundary: &Boundary, from: DVec3, along: DVec3, sign: f64) -> bool {
    boundary.points.windows(2).any(|pair| {
        let (d, e) = ((pair[1] - pair[0]).truncate(), along.truncate());
        let apart = (pair[0] - from).truncate();
        let cross = e.perp_dot(d);
        let (time, part) = (apart.perp_dot(d) / cross, apart.perp_dot(e) / cross);
        cross != 0.0 && (-1e-9..=1.0 + 1e-9).contains(&part) && sign * time > -1e-9
    })
}

/// Every point is between two boundaries of a strip, along the field.
fn covers(found: &Boundaries, mesh: &TriangleMesh, field: &Field) -> bool {
    mesh.points().iter().zip(field.directions()).all(|(&p, &a)| {
        let is_in = |strip: &[usize; 2]| {
            is_met(&found.boundaries[strip[0]], p, a, -1.0) && is_met(&found.boundaries[strip[1]], p, a, 1.0)
        };
        found.strips.iter().any(is_in)
    })
}

#[test]
fn levels_across_a_square_are_lines_at_even_distances() {
    let (mesh, field) = plane(12, |_, _| DVec3::X);
    let f = values(&mesh, |x, _| x);
    let found = level_boundaries(&mesh, &field, &f, &Levels::Count(5), &BoundaryOptions::default()).unwrap();
    assert_eq!(found.boundaries.len(), 7);
    assert_eq!(found.strips, [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]]);
    for (k, boundary) in found.boundaries[1..6].iter().enumerate() {
        assert!((boundary.level - (0.1 + 0.2 * k as f64)).abs() < 1e-15 && !boundary.is_closed);
        assert!(boundary.points.iter().all(|p| (p.x - boundary.level).abs() < 1e-14));
        // The field leads to the left: the boundary goes down.
        assert!(boundary.points[0].y > boundary.points[boundary.points.len() - 1].y);
        let on = boundary.points.iter().zip(&boundary.on_surface);
        assert!(on.filter_map(|(p, at)| Some((p, (*at)?))).all(|(p, at)| p.distance(mesh.position(at)) < 1e-15));
    }
    assert!(found.boundaries[0].points.iter().all(|p| p.x < 0.0 && p.x > -0.05));
    assert!(found.boundaries[6].points.iter().all(|p| p.x > 1.0 && p.x < 1.05));
    assert!(found.boundaries[0].on_surface.iter().all(Option::is_none));
    let bare = BoundaryOptions { extends: false, overshoots: false, ..Default::default() };
    let width = level_boundaries(&mesh, &field, &f, &Levels::Width(0.3), &bare).unwrap();
    assert_eq!(width.boundaries.iter().map(|b| (b.level * 1e9).round() / 1e9).collect::<Vec<_>>(), [0.2, 0.5, 0.8]);
    assert!(width.boundaries.iter().all(|b| b.on_surface.iter().all(Option::is_some)));
}

#[test]
fn strips_between_extended_boundaries_cover_what_they_are_oblique_to() {
    let diagonal = |_: f64, _: f64| DVec3::new(1.0, 0.7, 0.0);
    let bent = |x: f64, y: f64| DVec3::new(1.0 + 0.4 * y, 0.5 + 0.4 * x, 0.0);
    let round = |x: f64, y: f64| DVec3::new(x + 0.6, y + 0.5, 0.0);
    type Case<'a> = (&'a dyn Fn(f64, f64) -> DVec3, &'a dyn Fn(f64, f64) -> f64);
    let cases: [Case<'_>; 3] = [
        (&diagonal, &|x, y| x + 0.7 * y),
        (&bent, &|x, y| x + 0.5 * y + 0.4 * x * y),
        (&round, &|x, y| (x + 0.6).hypot(y + 0.5)),
    ];
    for (case, (slope, f)) in cases.into_iter().enumerate() {
        let (mesh, field) = plane(21, slope);
        let f = values(&mesh, f);
        for count in [1, 3, 8] {
            let levels = Levels::Count(count);
            let found = level_boundaries(&mesh, &field, &f, &levels, &BoundaryOptions::default()).unwrap();
            assert!(covers(&found, &mesh, &field), "{case} {count}");
            assert_eq!(found.boundaries.len() + found.dropped.len(), count + 2);
            let without = BoundaryOptions { extends: false, ..Default::default() };
            assert!(!covers(&level_boundaries(&mesh, &field, &f, &levels, &without).unwrap(), &mesh, &field));
            let longest = found.boundaries.iter().map(Boundary::length).fold(0.0, f64::max);
            assert!(longest < 4.0, "{longest}");
        }
    }
}

#[test]
fn levels_beyond_the_values_and_points_are_refused_by_name() {
    let (mesh, field) = plane(12, |x, y| DVec3::new(0.41 - x, 0.53 - y, 0.0));
    let f = values(&mesh, |x, y| -(x - 0.41).hypot(y - 0.53));
    let refused = |levels: &[f64]| {
        let levels = Levels::Values(levels.to_vec());
        let error = level_boundaries(&mesh, &field, &f, &levels, &BoundaryOptions::default()).unwrap_err();
        (error.status(), error.place().to_owned())
    };
    let top = f.iter().copied().fold(f64::MIN, f64::max);
    assert_eq!(refused(&[-0.3, -0.1, 0.2]), (Status::OutOfDomain, "levels[2]".into()));
    assert_eq!(refused(&[-0.3, top]), (Status::OutOfDomain, "levels[1]".into()));
    assert_eq!(refused(&[-0.3, -0.4]), (Status::InvalidValue, "levels[1]".into()));
    assert_eq!(refused(&[f64::NAN]), (Status::InvalidValue, "levels[0]".into()));
    assert_eq!(refused(&[]), (Status::InvalidArgumentLength, "levels".into()));
    let place = |values: &[f64], levels: Levels, options: &BoundaryOptions| {
        level_boundaries(&mesh, &field, values, &levels, options).unwrap_err().place().to_owned()
    };
    let options = BoundaryOptions::default();
    assert_eq!(place(&f[1..], Levels::Count(3), &options), "values");
    assert_eq!(place(&f, Levels::Count(0), &options), "levels");
    let (other, _) = plane(11, |_, _| DVec3::X);
    let error = level_boundaries(&other, &field, &f[..121], &Levels::Count(3), &options).unwrap_err();
    assert_eq!(error.place(), "field");
    assert_eq!(place(&f, Levels::Width(-1.0), &options), "levels");
    assert_eq!(place(&f, Levels::Count(3), &BoundaryOptions { least_length: -1.0, ..options }), "options.least_length");
    assert_eq!(place(&[2.0; 144], Levels::Count(3), &options), "levels[0]");
    // A small circle about the top is dropped and listed; it is no reason to refuse the others.
    let found = level_boundaries(&mesh, &field, &f, &Levels::Values(vec![-0.3, -0.2, -0.05]), &options).unwrap();
    assert!(
        found.dropped.len() == 1 && found.dropped[0].level == -0.05 && found.boundaries.iter().any(|b| b.is_closed)
    );
}

#[test]
fn curves_that_split_at_a_saddle_are_listed_alone() {
    let (mesh, field) = plane(31, |x, y| DVec3::new(x - 0.51, -(y - 0.49), 0.0));
    let f = values(&mesh, |x, y| 0.5 * (x - 0.51).powi(2) - 0.5 * (y - 0.49).powi(2));
    let levels = Levels::Values(vec![-0.06, -0.03, 0.02, 0.05]);
    let found =
        level_boundaries(&mesh, &field, &f, &levels, &BoundaryOptions { least_length: 0.0, ..Default::default() })
            .unwrap();
    // Two chains of two levels from below, two above; each with a boundary beyond the rim on its outer side only.
    assert_eq!(found.unmatched, [-0.03]);
    assert_eq!((found.boundaries.len(), found.strips.len()), (12, 8));
    let error = found.check().unwrap_err();
    assert!(error.status() == Status::NoSolution && error.to_string().contains("-0.03"));
    let strip_levels: Vec<[f64; 2]> = found.strips.iter().map(|s| s.map(|k| found.boundaries[k].level)).collect();
    assert!(strip_levels.iter().all(|[a, b]| a < b && a.signum() == b.signum()));
}

#[test]
fn drawn_curves_are_turned_and_put_on_the_surface() {
    let (mesh, field) = plane(21, |_, _| DVec3::X);
    let surface = ReferenceMesh::new(&mesh);
    let line = |x: f64, is_up: bool| {
        let points = (0..5).map(|i| DVec3::new(x, if is_up { i as f64 } else { 4.0 - i as f64 } / 4.0, 0.01)).collect();
        Drawn { points, is_closed: false }
    };
    let draw = |curves: &[Drawn]| drawn_boundaries(&surface, &field, curves, &BoundaryOptions::default());
    let found = draw(&[line(0.1, true), line(0.5, false), line(0.9, true)]).unwrap();
    assert_eq!((found.boundaries.len(), found.strips.len()), (3, 2));
    for boundary in &found.boundaries {
        assert!(boundary.points[0].y > boundary.points[4].y && boundary.points.iter().all(|p| p.z == 0.0));
    }
    let refused = |curves: &[Drawn]| {
        let error = draw(curves).unwrap_err();
        (error.status(), error.place().to_owned())
    };
    assert_eq!(refused(&[]), (Status::InvalidArgumentLength, "curves".into()));
    assert_eq!(refused(&[line(0.5, true), line(0.1, true)]), (Status::Infeasible, "curves[1]".into()));
    let mut bad = line(0.3, true);
    bad.points[2].y = f64::NAN;
    assert_eq!(refused(&[bad.clone()]), (Status::InvalidValue, "curves[0].points[2]".into()));
    bad.points[2] = bad.points[1];
    assert_eq!(refused(&[bad.clone()]), (Status::Degenerate, "curves[0].points[2]".into()));
    bad.points.truncate(1);
    assert_eq!(refused(&[line(0.1, true), bad]), (Status::InvalidArgumentLength, "curves[1].points".into()));
    let along = Drawn { points: vec![DVec3::new(0.2, 0.5, 0.0), DVec3::new(0.8, 0.5, 0.0)], is_closed: false };
    assert_eq!(refused(&[along]), (Status::Infeasible, "curves[0]".into()));
}

#[test]
fn plane_sections_stay_in_their_planes_also_beyond_the_surface() {
    let mesh = parametric_surface(25, 25, [-1.0, 1.0], [-1.0, 1.0], |x, y| DVec3::new(x, y, x * y)).unwrap();
    let mesh = TriangleMesh::new(&mesh).unwrap();
    let lines: Vec<DVec3> = mesh.points().iter().map(|p| DVec3::new(1.0, 0.0, p.y).normalize()).collect();
    let field = Field::new(&mesh, lines, vec![true; mesh.points().len()]).unwrap();
    let normal = DVec3::new(2.0, 0.5, 0.3);
    let at = |x: f64| Plane { normal, offset: normal.x * x };
    let planes = [at(-0.5), at(0.05), at(0.5)];
    let options = PlanarOptions::default();
    let found = planar_boundaries(&mesh, &field, &planes, &options).unwrap();
    assert_eq!((found.boundaries.boundaries.len(), found.planes.len(), found.angles_rad.len()), (5, 5, 3));
    for (boundary, plane) in found.boundaries.boundaries.iter().zip(&found.planes) {
        let plane = plane.unwrap();
        assert!(boundary.points.iter().all(|p| (plane.normal.dot(*p) - plane.offset).abs() < 1e-12));
    }
    assert!(
        found.planes[0].unwrap().offset < -1.0 && found.planes[4].unwrap().offset > 1.0 && found.oblique.is_empty()
    );
    assert!(covers(&found.boundaries, &mesh, &field));
    // The least angle, over the points of the section, from its formula: where n·(x, y, xy) = d it runs along n × normal.
    let angle = |k: usize| {
        let on = found.boundaries.boundaries[k + 1].points.iter().zip(&found.boundaries.boundaries[k + 1].on_surface);
        let angles = on.filter(|(_, at)| at.is_some()).map(|(p, _)| {
            let along = normal.cross(DVec3::new(-p.y, -p.x, 1.0));
            along.angle_between(DVec3::new(1.0, 0.0, p.y))
        });
        angles.map(|angle| angle.min(std::f64::consts::PI - angle)).fold(f64::MAX, f64::min)
    };
    assert!(
        (0..3).all(|k| (found.angles_rad[k] - angle(k)).abs() < 0.05),
        "{:?} {:?}",
        found.angles_rad,
        [0, 1, 2].map(angle)
    );
    let reversed: Vec<Plane> = planes.iter().rev().copied().collect();
    let again = planar_boundaries(&mesh, &field, &reversed, &options).unwrap();
    assert_eq!(again.boundaries.boundaries[1].points, found.boundaries.boundaries[1].points);
    let refused = |planes: &[Plane], options: &PlanarOptions| {
        let error = planar_boundaries(&mesh, &field, planes, options).unwrap_err();
        (error.status(), error.place().to_owned())
    };
    assert_eq!(refused(&[], &options), (Status::InvalidArgumentLength, "planes".into()));
    assert_eq!(refused(&[planes[0], at(9.0)], &options), (Status::NoIntersection, "planes[1]".into()));
    assert_eq!(refused(&[planes[0], planes[2], planes[1]], &options), (Status::Infeasible, "planes[2]".into()));
    assert_eq!(
        refused(&[Plane { normal: DVec3::ZERO, offset: 0.0 }], &options),
        (Status::InvalidValue, "planes[0]".into())
    );
    // A plane at a small angle to the lines: listed, or refused.
    let oblique = Plane { normal: DVec3::new(0.25, 1.0, 0.0), offset: 0.0 };
    let found = planar_boundaries(&mesh, &field, &[oblique], &options).unwrap();
    assert!(found.oblique == [0] && found.angles_rad[0] < 15_f64.to_radians());
    let strict = PlanarOptions { refuses_oblique: true, ..options };
    assert_eq!(refused(&[oblique], &strict), (Status::Infeasible, "planes[0]".into()));
    let wrong = PlanarOptions { least_angle_rad: 2.0, ..options };
    assert_eq!(refused(&planes, &wrong), (Status::InvalidValue, "options.least_angle_rad".into()));
}

#[test]
fn whatever_the_function_and_the_field_what_comes_back_is_finite() {
    // Sums of waves by a seed: closed curves, saddles, parts where the field is not known or runs along the levels.
    for seed in 0..40 {
        let wave = |k: f64, x: f64, y: f64| (k * 1.7 + (3.0 + k) * x).sin() + (k * 0.9 - (2.0 + 1.3 * k) * y).cos();
        let s = f64::from(seed) * 0.37;
        let (mesh, field) = plane(15, |x, y| {
            let slope = DVec3::new(wave(s, x, y), wave(s + 1.0, y, x), 0.0);
            if slope.length() < 0.4 { DVec3::ZERO } else { slope }
        });
        let f = values(&mesh, |x, y| wave(s + 0.5, x, y) + 0.5 * wave(s, y, x));
        for levels in [Levels::Count(7), Levels::Width(0.3)] {
            let options = BoundaryOptions { least_length: if seed % 2 == 0 { 0.0 } else { 2.0 }, ..Default::default() };
            let found = level_boundaries(&mesh, &field, &f, &levels, &options).unwrap();
            for boundary in &found.boundaries {
                assert!(boundary.points.len() >= 3 && boundary.points.len() == boundary.on_surface.len());
                assert!(boundary.points.iter().all(|p| p.is_finite() && p.length() < 20.0), "{seed}");
                assert!(boundary.points.windows(2).all(|pair| pair[0] != pair[1]), "{seed}");
            }
            assert!(found.strips.iter().flatten().all(|&k| k < found.boundaries.len()));
            assert_eq!(found.check().is_ok(), found.unmatched.is_empty());
            assert_eq!(level_boundaries(&mesh, &field, &f, &levels, &options).unwrap(), found);
        }
    }
}

#[test]
fn closed_curves_may_be_drawn_around_a_hole() {
    let ring =
        parametric_surface(61, 8, [0.0, 6.2], [0.5, 1.5], |u, v| v * DVec3::new(u.cos(), -u.sin(), 0.0)).unwrap();
    let mesh = TriangleMesh::new(&ring).unwrap();
    let field = Field::new(&mesh, mesh.points().iter().map(|p| p.normalize()).collect(), vec![true; 61 * 8]).unwrap();
    let circle = |radius: f64| {
        let at = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / 40.0;
            radius * DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        Drawn { points: (0..40).map(at).collect(), is_closed: true }
    };
    let options = BoundaryOptions::default();
    let found = drawn_boundaries(&ReferenceMesh::new(&mesh), &field, &[circle(0.7), circle(1.1)], &options).unwrap();
    assert!(found.boundaries.iter().all(|b| b.is_closed && b.points.len() == 40));
    let error =
        drawn_boundaries(&ReferenceMesh::new(&mesh), &field, &[circle(1.1), circle(0.7)], &options).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::Infeasible, "curves[1]"));
}

#[test]
fn where_a_level_leaves_the_surface_in_its_middle_its_curves_are_joined_beyond_the_rim() {
    // Below 0 the curves of f leave through the lower side, two of each level, one in each corner.
    let (mesh, field) = plane(31, |x, _| DVec3::new(-1.2 * (x - 0.5), 1.0, 0.0));
    let f = values(&mesh, |x, y| y - 0.6 * (x - 0.5).powi(2));
    let sign = |is_up: bool| if is_up { 1.0 } else { -1.0 };
    for is_up in [true, false] {
        // Against the field, short curves follow long ones.
        let directions = field.directions().iter().map(|a| sign(is_up) * *a).collect();
        let field = Field::new(&mesh, directions, vec![true; mesh.points().len()]).unwrap();
        let f: Vec<f64> = f.iter().map(|f| sign(is_up) * f).collect();
        let levels: Vec<f64> = [-0.12, -0.08, -0.04, 0.03, 0.3, 0.6, 0.8].iter().map(|l| sign(is_up) * l).collect();
        let levels = if is_up { levels } else { levels.into_iter().rev().collect() };
        let options = BoundaryOptions { least_length: 0.0, ..Default::default() };
        let found = level_boundaries(&mesh, &field, &f, &Levels::Values(levels), &options).unwrap();
        assert!(found.unmatched.is_empty() && found.check().is_ok());
        assert!(covers(&found, &mesh, &field), "{is_up}");
        // One bridge, over two curves.
        assert_eq!(found.meets.len(), 2);
        for &[ends, begins] in &found.meets {
            let [bridge, short] = if found.boundaries[ends].length() > found.boundaries[begins].length() {
                [ends, begins]
            } else {
                [begins, ends]
            };
            let [bridge, short] = [bridge, short].map(|k| &found.boundaries[k]);
            assert_eq!(bridge.level, short.level);
            let on = short.points.iter().zip(&short.on_surface).filter(|(_, at)| at.is_some());
            assert!(on.map(|(p, _)| p).all(|p| bridge.points.contains(p)));
            // Between the short curves the bridge is beyond the rim, and leads on from one to the other.
            let off = bridge.points.iter().zip(&bridge.on_surface).filter(|(_, at)| at.is_none());
            assert!(
                off.clone().count() > 5
                    && off.map(|(p, _)| p).all(|p| p.x < 0.0 || p.x > 1.0 || p.y < 0.0 || p.y > 1.0)
            );
            let inner = &bridge.points[1..bridge.points.len() - 1];
            assert!(inner.windows(2).all(|pair| pair[0].distance(pair[1]) < 0.2));
        }
    }
}
