//! Curves of fields whose curves are known.

use super::*;
use crate::geometry::ruled::{asymptotic, orientation};
use crate::mesh::Mesh;
use crate::mesh::grid::Grid;
use crate::mesh::patterns::{height_field, parametric_surface};
use crate::mesh::reference::ReferenceMesh;

fn field(mesh: &Mesh, family: usize, options: &orientation::Options) -> (TriangleMesh, Field) {
    let mesh = TriangleMesh::new(mesh).unwrap();
    let found = asymptotic::AsymptoticDirections::new(&mesh, &asymptotic::Options::default()).unwrap();
    let oriented = found.orient(&mesh, family, options).unwrap();
    (mesh, oriented.field)
}

fn exact(mesh: &Mesh, direction: impl Fn(DVec3) -> DVec3) -> (TriangleMesh, Field) {
    let mesh = TriangleMesh::new(mesh).unwrap();
    let directions = mesh.points().iter().map(|&p| direction(p).normalize()).collect();
    let field = Field::new(&mesh, directions, vec![true; mesh.points().len()]).unwrap();
    (mesh, field)
}

/// Points are where they say, steps no longer than half an edge, and lengths those of the polyline or, over edges, a bit more.
fn assert_sound(mesh: &TriangleMesh, trace: &Trace, most: f64) {
    assert!(trace.points.len() == trace.positions.len() && trace.lengths.len() == trace.positions.len());
    for (at, position) in trace.points.iter().zip(&trace.positions) {
        assert!(at.weights.iter().all(|w| (0.0..=1.0 + 1e-15).contains(w)));
        assert!((at.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14 && mesh.position(*at) == *position);
    }
    for i in 1..trace.positions.len() {
        let (chord, walked) =
            (trace.positions[i].distance(trace.positions[i - 1]), trace.lengths[i] - trace.lengths[i - 1]);
        assert!(walked > 0.0 && walked < most && chord < walked * (1.0 + 1e-9) && chord > 0.9 * walked);
    }
}

#[test]
fn asymptotic_lines_of_the_hyperboloid_are_straight() {
    let n = 41;
    let point = |v: f64, z: f64| {
        let r = (1.0 + z * z).sqrt();
        DVec3::new(r * v.cos(), r * v.sin(), z)
    };
    let surface = parametric_surface(n, n, [0.0, 1.6], [-0.8, 0.8], point).unwrap();
    let (mut worst, mut apart) = (0.0_f64, 0.0_f64);
    for family in 0..2 {
        let (mesh, field) = field(&surface, family, &orientation::Options::default());
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let reference = ReferenceMesh::new(&mesh);
        for k in 0..15 {
            let seed = point(0.2 + 0.085 * f64::from(k), 0.7 * (2.1 * f64::from(k)).sin());
            let start = reference.locate(seed);
            let back = tracer.trace(start, Sense::Backward, 10.0).unwrap();
            let on = tracer.trace(start, Sense::Forward, 10.0).unwrap();
            assert!(back.end == End::Boundary && on.end == End::Boundary);
            assert_sound(&mesh, &on, 0.05);
            let line: Vec<DVec3> = back.positions.iter().rev().chain(&on.positions[1..]).copied().collect();
            let (first, last) = (line[0], line[line.len() - 1]);
            let length = first.distance(last);
            let along = (last - first) / length;
            let off = line.iter().map(|p| (*p - first).reject_from_normalized(along).length());
            worst = worst.max(off.fold(0.0, f64::max) / length);
            // And the line is the one through the seed: (x z ∓ y, y z ± x, x² + y²).
            let sign = if family == 0 { -1.0 } else { 1.0 };
            let ruling =
                DVec3::new(seed.x * seed.z - sign * seed.y, seed.y * seed.z + sign * seed.x, 1.0 + seed.z * seed.z);
            apart = apart.max(along.cross(ruling.normalize()).length());
        }
    }
    assert!(worst < 1e-3 && apart < 3e-3, "{worst} {apart}");
}

#[test]
fn a_curve_along_edges_goes_through_points() {
    // Rulings of z = xy from points of a grid follow its edges.
    let surface = height_field(11, 11, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
    let (mesh, field) = exact(&surface, |p| DVec3::new(1.0, 0.0, p.y));
    let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
    for point in 0..mesh.points().len() {
        let p = mesh.points()[point];
        for (sense, end) in [(Sense::Forward, 1.0), (Sense::Backward, -1.0)] {
            // From whichever triangle around the point. Those at the boundary may be left by it at once.
            if p.y.abs() > 0.99 || (p.x - end).abs() < 0.01 {
                continue;
            }
            for &triangle in mesh.fan(point) {
                let weights = mesh.triangles()[triangle as usize].map(|i| f64::from(u8::from(i as usize == point)));
                let trace = tracer.trace(SurfacePoint { triangle, weights }, sense, 10.0).unwrap();
                assert_sound(&mesh, &trace, 0.2);
                assert_eq!(trace.end, End::Boundary);
                let last = trace.positions[trace.positions.len() - 1];
                // The first direction is that in the plane of the triangle it began in.
                assert!((last.x - end).abs() < 1e-14 && (last.y - p.y).abs() < 3e-2, "{p} {last}");
            }
        }
    }
}

#[test]
fn helices_of_the_helicoid_to_second_order() {
    let c = 0.8;
    let helix = |u: f64, v: f64| DVec3::new(u * v.cos(), u * v.sin(), c * v);
    let error = |n: usize| {
        let surface = parametric_surface(n, n, [0.2, 1.2], [0.0, 1.5], helix).unwrap();
        let (mesh, field) = exact(&surface, |p| {
            let (sine, cosine) = (p.z / c).sin_cos();
            let u = p.x * cosine + p.y * sine;
            DVec3::new(-u * sine, u * cosine, c)
        });
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let reference = ReferenceMesh::new(&mesh);
        let mut worst = 0.0_f64;
        for k in 0..9 {
            let u = 0.4 + 0.07 * f64::from(k);
            let length = 1.2 * u.hypot(c);
            let start = reference.locate(helix(u, 0.1));
            let followed = tracer.follow(start, Sense::Forward, length, |_, _| ControlFlow::Continue(())).unwrap();
            assert!(followed.end == End::Length && (followed.length - length).abs() < 1e-12);
            worst = worst.max(followed.position.distance(helix(u, 1.3)));
        }
        worst
    };
    let errors = [11, 21, 41].map(error);
    assert!(errors[0] / errors[1] > 3.0 && errors[1] / errors[2] > 3.0 && errors[2] < 1e-3, "{errors:?}");
}

#[test]
fn a_curve_goes_around_a_tube_as_long_as_asked() {
    let at = |i: usize| {
        let angle = std::f64::consts::TAU * (i % 40) as f64 / 40.0;
        DVec3::new(angle.cos(), angle.sin(), 0.1 * (i / 40) as f64)
    };
    let tube = Grid::new((0..440).map(at).collect(), 11, 40, [false, true]).unwrap().mesh();
    let (mesh, field) = exact(&tube, |p| DVec3::new(-p.y, p.x, 0.0));
    let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
    let start = ReferenceMesh::new(&mesh).locate(DVec3::new(0.9, 0.3, 0.53));
    // Ten times around the polygon.
    let length = 10.0 * 80.0 * (std::f64::consts::PI / 40.0).sin();
    let trace = tracer.trace(start, Sense::Backward, length).unwrap();
    assert_sound(&mesh, &trace, 0.1);
    assert_eq!(trace.end, End::Length);
    assert!(trace.positions[trace.positions.len() - 1].distance(trace.positions[0]) < 1e-9);
    assert!(trace.positions.iter().all(|p| (p.z - trace.positions[0].z).abs() < 1e-12));
    let few = Tracer::new(&mesh, &field, &Options { most_steps: 7, ..Options::default() }).unwrap();
    let trace = few.trace(start, Sense::Forward, length).unwrap();
    assert!(trace.end == End::Steps && trace.positions.len() == 8);
    let mut last = mesh.position(start);
    let mut count = 0;
    let stopped = tracer.follow(start, Sense::Forward, length, |from, followed| {
        let to = followed.position;
        assert_eq!(from, last);
        (last, count) = (to, count + 1);
        if count == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let stopped = stopped.unwrap();
    assert!(stopped.end == End::Caller && stopped.position == last && count == 5);
}

#[test]
fn on_rough_meshes_curves_go_on_to_the_boundary() {
    // Hills as steep as 2, points moved about, a spike, and a start at each corner and each middle of an edge.
    let mut surface = height_field(13, 13, [-1.0, 1.0], [-1.0, 1.0], |x, y| 0.4 * (5.0 * x).sin() * (4.0 * y).cos());
    for (i, p) in surface.iter_mut().flat_map(|mesh| mesh.points.iter_mut()).enumerate() {
        let t = i as f64;
        *p += 0.04 * DVec3::new((7.3 * t).sin(), (3.9 * t).cos(), (5.1 * t).sin());
        p.z += if i == 84 { 0.1 } else { 0.0 };
    }
    let surface = surface.unwrap();
    for k in 0..5 {
        let (sine, cosine) = (1.3 * f64::from(k)).sin_cos();
        let (mesh, field) = exact(&surface, |_| DVec3::new(cosine, sine, 0.0));
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let reference = ReferenceMesh::new(&mesh);
        let halves = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
        for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().chain(halves) {
            for triangle in 0..mesh.triangles().len() as u32 {
                let start = SurfacePoint { triangle, weights };
                let trace = tracer.trace(start, Sense::Forward, 40.0).unwrap();
                let last = trace.points[trace.points.len() - 1];
                assert!(trace.end == End::Boundary && reference.is_on_boundary(last), "{start:?} {:?}", trace.end);
                assert!(trace.points.len() > 1 || reference.is_on_boundary(start));
                // Steps may go over a ridge, but not beyond what they say.
                let steps = trace.positions.windows(2).map(|ends| ends[0].distance(ends[1]));
                assert!(steps.zip(trace.lengths.windows(2)).all(|(chord, l)| chord <= (l[1] - l[0]) * (1.0 + 1e-9)));
            }
        }
    }
}

#[test]
fn a_curve_ends_before_what_is_not_known_and_passes_where_signs_flip() {
    let monkey = |x: f64, y: f64| x * x * x - 3.0 * x * y * y;
    let surface = height_field(41, 41, [-1.0, 1.0], [-1.0, 1.0], monkey).unwrap();
    let cut = orientation::Options { allow_cut: true, ..orientation::Options::default() };
    for family in 0..2 {
        let (mesh, field) = field(&surface, family, &cut);
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let masked = mesh.points().iter().position(|p| p.length() < 1e-12).unwrap();
        let triangle = mesh.fan(masked)[0];
        let trace = tracer.trace(SurfacePoint { triangle, weights: [0.5, 0.5, 0.0] }, Sense::Forward, 1.0).unwrap();
        assert!(trace.end == End::Unknown && trace.positions.len() == 1);
        let mut sharpest = 1.0_f64;
        for triangle in (0..mesh.triangles().len() as u32).step_by(7) {
            let start = SurfacePoint { triangle, weights: [0.2, 0.3, 0.5] };
            if mesh.position(start).length() < 0.3 {
                continue;
            }
            let trace = tracer.trace(start, Sense::Forward, 5.0).unwrap();
            assert!(trace.end == End::Boundary || trace.end == End::Unknown, "{:?}", trace.end);
            for three in trace.positions.windows(3) {
                let (a, b) = (three[1] - three[0], three[2] - three[1]);
                // Around the flat point curves do turn.
                if three[1].length() > 0.3 && b.length() > 1e-6 {
                    sharpest = sharpest.min(a.normalize().dot(b.normalize()));
                }
            }
        }
        assert!(sharpest > 0.98, "{sharpest}");
    }
}

#[test]
fn bad_input_is_named() {
    let surface = height_field(5, 5, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
    let (mesh, field) = exact(&surface, |p| DVec3::new(1.0, 0.0, p.y));
    let place = |options| Tracer::new(&mesh, &field, &options).unwrap_err().place().to_owned();
    assert_eq!(place(Options { step: 0.6, ..Options::default() }), "step");
    assert_eq!(place(Options { step: f64::NAN, ..Options::default() }), "step");
    assert_eq!(place(Options { most_steps: 0, ..Options::default() }), "most_steps");
    let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
    let place = |triangle, weights, length| {
        let start = SurfacePoint { triangle, weights };
        tracer.trace(start, Sense::Forward, length).unwrap_err().place().to_owned()
    };
    assert_eq!(place(32, [1.0, 0.0, 0.0], 1.0), "start");
    assert_eq!(place(3, [1.1, -0.1, 0.0], 1.0), "start");
    assert_eq!(place(3, [f64::NAN, 0.0, 1.0], 1.0), "start");
    assert_eq!(place(3, [1.0, 0.0, 0.0], f64::INFINITY), "length");
    assert_eq!(place(3, [1.0, 0.0, 0.0], 0.0), "length");
    let other = TriangleMesh::new(&height_field(4, 5, [0.0, 1.0], [0.0, 1.0], |x, y| x * y).unwrap()).unwrap();
    assert_eq!(Tracer::new(&other, &field, &Options::default()).unwrap_err().place(), "field");
}
