use super::*;
use crate::mesh::TriangleMesh;
use crate::mesh::curve::CubicBasis;
use crate::mesh::patterns::{height_field, parametric_surface};

/// The strip whose boundaries are straight lines from `from[side]` to `to[side]`, run through evenly.
pub fn straight(count: usize, from: [DVec3; 2], to: [DVec3; 2]) -> Strip {
    let basis = CubicBasis::new(count, false).unwrap();
    let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
    let t = |i: usize| (knots[i + 1] + knots[i + 2] + knots[i + 3]) / (3.0 * spans);
    let control = [0, 1].map(|side| (0..count).map(|i| from[side].lerp(to[side], t(i))).collect());
    Strip::new(basis, control).unwrap()
}

fn flat(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

fn square(n: usize) -> TriangleMesh {
    TriangleMesh::new(&height_field(n, n, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap()).unwrap()
}

fn trimmed(strip: &Strip, mesh: &TriangleMesh) -> Trimmed {
    trim(std::slice::from_ref(strip), &ReferenceMesh::new(mesh), &TrimOptions::default()).unwrap().remove(0)
}

/// The area of a mesh's triangles.
fn mesh_area(mesh: &Mesh) -> f64 {
    TriangleMesh::new(mesh).unwrap().total_area()
}

#[test]
fn what_overshoots_a_square_is_cut_off() {
    let mesh = square(6);
    // Affine parameters; turned by 30°; a plane of crossed parameters, where straight edges are curves in (u, v).
    let turn = glam::DQuat::from_rotation_z(0.5);
    let affine = straight(7, [flat(-0.3, -0.2), flat(-0.3, 1.4)], [flat(1.2, -0.2), flat(1.2, 1.4)]);
    let middle = flat(0.5, 0.5);
    let around = |p: DVec3| middle + turn * (1.7 * (p - middle));
    let turned = straight(
        6,
        [around(flat(-0.3, -0.2)), around(flat(-0.3, 1.4))],
        [around(flat(1.2, -0.2)), around(flat(1.2, 1.4))],
    );
    let crossed = straight(5, [flat(-0.5, -0.2), flat(-0.2, 1.4)], [flat(1.6, -0.4), flat(1.2, 1.1)]);
    for strip in [affine, turned, crossed] {
        let trimmed = trimmed(&strip, &mesh);
        assert!((trimmed.area() - 1.0).abs() < 1e-6, "{}", trimmed.area());
        assert_eq!((trimmed.pieces().len(), trimmed.pieces()[0].len()), (1, 1));
        let cut = trimmed.mesh(&strip);
        assert!((mesh_area(&cut) - 1.0).abs() < 1e-6);
        assert!(cut.points.iter().all(|p| p.clamp(DVec3::ZERO, flat(1.0, 1.0)).distance(*p) < 1e-6));
        // Each ruling is cut where the square cuts its line: by the slabs 0 ≤ x ≤ 1 and 0 ≤ y ≤ 1.
        for ruling in trimmed.rulings(&strip, 23) {
            let [a, b] = strip.ruling(ruling.u);
            let slab = |a: f64, b: f64| {
                let ends = [-a / (b - a), (1.0 - a) / (b - a)];
                if (b - a).abs() < 1e-12 {
                    [f64::NEG_INFINITY, f64::INFINITY]
                } else {
                    [ends[0].min(ends[1]), ends[0].max(ends[1])]
                }
            };
            let (x, y) = (slab(a.x, b.x), slab(a.y, b.y));
            let inside = |t: f64| {
                (0.0..=1.0).contains(&(a.x + t * (b.x - a.x))) && (0.0..=1.0).contains(&(a.y + t * (b.y - a.y)))
            };
            let (low, high) = (x[0].max(y[0]).max(0.0), x[1].min(y[1]).min(1.0));
            if high - low < 1e-3 || !inside(0.5 * (low + high)) {
                assert!(ruling.pieces.iter().all(|piece| piece[0].distance(piece[1]) < 0.01), "{ruling:?}");
                continue;
            }
            let [start, end] = ruling.pieces[0];
            assert!(ruling.pieces.len() == 1 && start.distance(a.lerp(b, low)) < 1e-5, "{start} {}", a.lerp(b, low));
            assert!(end.distance(a.lerp(b, high)) < 1e-5);
        }
    }
}

#[test]
fn strips_beside_each_other_share_the_square() {
    let mesh = square(9);
    let strip = |k: f64| {
        straight(
            5,
            [flat(-0.2, k / 4.0), flat(-0.1, (k + 1.0) / 4.0)],
            [flat(1.3, k / 4.0), flat(1.2, (k + 1.0) / 4.0)],
        )
    };
    let strips: Vec<Strip> = [-1.0, 0.0, 1.0, 2.0, 3.0, 4.0].map(strip).to_vec();
    let trimmed = trim(&strips, &ReferenceMesh::new(&mesh), &TrimOptions::default()).unwrap();
    for (k, trimmed) in trimmed.iter().enumerate() {
        let expected = if (1..5).contains(&k) { 0.25 } else { 0.0 };
        assert!((trimmed.area() - expected).abs() < 1e-6, "{k}: {}", trimmed.area());
    }
    assert!(trimmed[0].pieces().is_empty() && trimmed[0].mesh(&strips[0]).faces.is_empty());
    // A strip inside keeps all of itself, its last ruling too.
    let inner = straight(4, [flat(0.2, 0.3), flat(0.2, 0.6)], [flat(0.8, 0.3), flat(0.8, 0.6)]);
    let whole = self::trimmed(&inner, &mesh);
    assert!((whole.area() - 0.18).abs() < 1e-9);
    assert!(whole.rulings(&inner, 5).iter().all(|ruling| ruling.pieces.len() == 1));
    assert_eq!(whole.ruling_parts(inner.length_u()), [[0.0, 1.0]]);
}

#[test]
fn holes_and_bays_leave_holes_and_pieces() {
    // A square of 8 × 8 cells, of side 8, with a hole of 2 × 2 and a bay of 2 × 3 from above.
    let full = height_field(9, 9, [0.0, 8.0], [0.0, 8.0], |_, _| 0.0).unwrap();
    let is_out = |face: &Vec<u32>| {
        let p = full.points[face[0] as usize];
        let hole = (2.0..4.0).contains(&p.x) && (2.0..4.0).contains(&p.y);
        hole || ((5.0..7.0).contains(&p.x) && p.y >= 5.0)
    };
    let faces: Vec<Vec<u32>> = full.faces.iter().filter(|face| !is_out(face)).cloned().collect();
    let mut number = vec![u32::MAX; full.points.len()];
    let mut points = Vec::new();
    faces.iter().flatten().for_each(|&i| {
        if number[i as usize] == u32::MAX {
            number[i as usize] = points.len() as u32;
            points.push(full.points[i as usize]);
        }
    });
    let faces = faces.iter().map(|face| face.iter().map(|&i| number[i as usize]).collect()).collect();
    let mesh = TriangleMesh::new(&Mesh { points, faces }).unwrap();
    assert_eq!(mesh.boundary().len(), 2);
    let all = straight(8, [flat(-1.0, -1.0), flat(-1.0, 9.0)], [flat(9.0, -1.0), flat(9.0, 9.0)]);
    let found = trimmed(&all, &mesh);
    assert!((found.area() - 54.0).abs() < 1e-5, "{}", found.area());
    assert_eq!((found.pieces().len(), found.pieces()[0].len()), (1, 2));
    assert!((mesh_area(&found.mesh(&all)) - 54.0).abs() < 1e-5);
    let u = |x: f64| (x + 1.0) / 10.0 * all.length_u();
    let lengths = |x: f64| found.ruling_parts(u(x)).iter().map(|part| (part[1] - part[0]) * 10.0).collect::<Vec<_>>();
    for (x, expected) in [(1.0, vec![8.0]), (3.0, vec![2.0, 4.0]), (6.0, vec![5.0]), (8.5, vec![])] {
        let found = lengths(x);
        assert_eq!(found.len(), expected.len(), "{x}");
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-5), "{x}: {found:?}");
    }
    // A strip across the bay is in two pieces.
    let high = straight(5, [flat(-1.0, 6.0), flat(-1.0, 7.0)], [flat(9.0, 6.0), flat(9.0, 7.0)]);
    let found = trimmed(&high, &mesh);
    assert_eq!(found.pieces().len(), 2);
    assert!((found.area() - 6.0).abs() < 1e-6);
}

#[test]
fn a_closed_strip_of_a_tube_is_cut_around() {
    // The hyperboloid x² + y² − z² = 1 between z = −0.4 and 0.5, the strip longer at both ends, its seam in the mesh.
    let point = |angle: f64, z: f64| DVec3::new(angle.cos(), angle.sin(), 0.0) * (1.0 + z * z).sqrt() + z * DVec3::Z;
    let (columns, rows) = (361, 31);
    let open = parametric_surface(columns, rows, [0.0, std::f64::consts::TAU], [-0.4, 0.5], point).unwrap();
    let wrap = |i: u32| if i as usize % columns == columns - 1 { i + 1 - columns as u32 } else { i };
    let number: Vec<u32> = (0..open.points.len()).map(|i| (i - i / columns) as u32).collect();
    let points = (0..open.points.len()).filter(|i| i % columns != columns - 1).map(|i| open.points[i]).collect();
    let faces = open.faces.iter().map(|face| face.iter().map(|&i| number[wrap(i) as usize]).collect()).collect();
    let mesh = TriangleMesh::new(&Mesh { points, faces }).unwrap();
    assert_eq!(mesh.boundary().len(), 2);
    // Rulings of the hyperboloid: directions (−sin, cos, 1) from the waist circle.
    let count = 40;
    let basis = CubicBasis::new(count, true).unwrap();
    // Control points that make the circle: the mask 1/6, 4/6, 1/6 shrinks radii by (2 + cos h) / 3.
    let h = std::f64::consts::TAU / count as f64;
    let side = |t: f64| {
        (0..count).map(move |i| {
            let (sin, cos) = (h * i as f64 + 0.3).sin_cos();
            let grown = 3.0 / (2.0 + h.cos());
            DVec3::new(grown * (cos - t * sin), grown * (sin + t * cos), t)
        })
    };
    let strip = Strip::new(basis, [side(-0.7).collect(), side(0.9).collect()]).unwrap();
    let found = trimmed(&strip, &mesh);
    // The area of the hyperboloid: 2π ∫ √(1 + 2z²) dz, by the midpoint rule.
    let n = 2000;
    let z = |i: usize| -0.4 + 0.9 * (i as f64 + 0.5) / n as f64;
    let exact = std::f64::consts::TAU * (0..n).map(|i| (1.0 + 2.0 * z(i) * z(i)).sqrt()).sum::<f64>() * 0.9 / n as f64;
    assert!((found.area() / exact - 1.0).abs() < 5e-5, "{} {exact}", found.area());
    for ruling in found.rulings(&strip, 17) {
        assert_eq!(ruling.pieces.len(), 1, "{ruling:?}");
        assert!((ruling.pieces[0][0].z + 0.4).abs() < 1e-3 && (ruling.pieces[0][1].z - 0.5).abs() < 1e-3);
    }
}

#[test]
fn a_surface_without_boundary_trims_nothing_and_options_are_checked() {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(DVec3::from);
    let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(|face: [u32; 3]| face.to_vec());
    let mesh = TriangleMesh::new(&Mesh { points: corners.to_vec(), faces: faces.to_vec() }).unwrap();
    let strip = straight(4, [flat(0.2, 0.3), flat(0.2, 0.6)], [flat(0.8, 0.3), flat(0.8, 0.6)]);
    assert!((trimmed(&strip, &mesh).area() - 0.18).abs() < 1e-12);
    let place = |options: TrimOptions| {
        trim(std::slice::from_ref(&strip), &ReferenceMesh::new(&mesh), &options).unwrap_err().place().to_owned()
    };
    assert_eq!(place(TrimOptions { tolerance: 0.0, ..TrimOptions::default() }), "options.tolerance");
    assert_eq!(place(TrimOptions { tolerance: f64::NAN, ..TrimOptions::default() }), "options.tolerance");
    assert_eq!(place(TrimOptions { columns_per_span: 0, ..TrimOptions::default() }), "options.columns_per_span");
    let point = Strip::new(CubicBasis::new(4, false).unwrap(), [vec![DVec3::ONE; 4], vec![DVec3::ONE; 4]]).unwrap();
    let error = trim(&[strip.clone(), point], &ReferenceMesh::new(&mesh), &TrimOptions::default()).unwrap_err();
    assert_eq!(error.place(), "strips[1]");
}

#[test]
fn needles_are_cut_off_wherever_a_polygon_begins() {
    let mut polygon: Contour =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.3, 1.0], [1.7, 1.0], [1.4, 1.0 + 1e-6], [1.0, 1.0 + 1e-6], [0.0, 1.0]]
            .to_vec();
    for _ in 0..polygon.len() {
        polygon.rotate_left(1);
        let mut left = without_needles(&polygon, DVec2::new(1.0, 2.0), 4e-6);
        left.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert!(left.iter().all(|at| at[0] < 1.0 + 1e-9) && left.len() >= 4, "{left:?}");
        // Wider ones are shapes.
        assert_eq!(without_needles(&polygon, DVec2::new(1.0, 2.0), 1e-7).len(), polygon.len());
    }
}
