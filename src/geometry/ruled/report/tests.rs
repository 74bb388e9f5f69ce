use super::*;
use crate::geometry::ruled::trim::tests::straight;
use crate::mesh::patterns::height_field;
use crate::mesh::reference::{ParametricSurface, SurfaceJet};
use crate::mesh::surfaces;

fn saddle_mesh(n: usize) -> TriangleMesh {
    TriangleMesh::new(&height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()).unwrap()
}

fn saddle_surface() -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
    ParametricSurface::new([[-1.0, 1.0], [-1.0, 1.0]], [17, 17], surfaces::saddle()).unwrap()
}

/// Strips of z = xy + lift between the given values of y, along x over [−x, x].
fn strips(x: f64, ys: &[f64], lift: f64) -> Vec<Strip> {
    let at = |x: f64, y: f64| DVec3::new(x, y, x * y + lift);
    let one = |y: &[f64]| straight(5, [at(-x, y[0]), at(-x, y[1])], [at(x, y[0]), at(x, y[1])]);
    ys.windows(2).map(one).collect()
}

#[test]
fn exact_strips_deviate_by_nothing_and_cover_all() {
    let (mesh, surface) = (saddle_mesh(41), saddle_surface());
    let reference = ReferenceMesh::new(&mesh);
    let strips = strips(1.1, &[-1.1, -0.4, 0.3, 1.2], 0.0);
    let found = report(&strips, &reference, &surface, &ReportOptions::default()).unwrap();
    assert!(found.strips_to_reference.max < 1e-13, "{:?}", found.strips_to_reference);
    assert!(found.strips_to_reference.count > 80);
    assert!(found.reference_to_strips.max < 1e-13 && found.reference_to_strips.count == 41 * 41);
    assert!(found.coverage == 1.0 && found.overlap < 2e-3, "{} {}", found.coverage, found.overlap);
    assert_eq!((found.joints.len(), found.strips.len()), (2, 3));
    assert!(found.max_gap < 1e-14 && found.max_kink_deg < 1e-5);
    assert!(found.joints.iter().all(|joint| joint.gap_count > 10 && joint.kink_count == joint.gap_count));
    // Against the mesh: its chords are off by up to 1/4 of the square of an edge.
    let chords = report(&strips, &reference, &reference, &ReportOptions::default()).unwrap();
    let max = chords.strips_to_reference.max;
    assert!(max > 1e-5 && max < 0.05 * 0.05 / 4.0 && chords.strips_to_reference.rms < max);
    let text = serde_json::to_string(&found).unwrap();
    assert_eq!(serde_json::from_str::<Report>(&text).unwrap(), found);
}

#[test]
fn what_is_off_is_found_where_it_is() {
    let flat = TriangleMesh::new(&height_field(11, 11, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&flat);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    // The first strip is lifted by 0.02, the second starts 0.01 beside it and leaves out the part beyond y = 0.8.
    let lower = straight(4, [p(-0.1, -0.1, 0.02), p(-0.1, 0.5, 0.02)], [p(1.1, -0.1, 0.02), p(1.1, 0.5, 0.02)]);
    let upper = straight(6, [p(-0.2, 0.51, 0.0), p(-0.2, 0.8, 0.0)], [p(1.2, 0.51, 0.0), p(1.2, 0.8, 0.0)]);
    let found = report(&[lower, upper], &reference, &reference, &ReportOptions::default()).unwrap();
    let [first, second] = [found.strips[0], found.strips[1]];
    assert!((first.deviation.max - 0.02).abs() < 1e-15 && (first.deviation.rms - 0.02).abs() < 1e-15);
    assert!(second.deviation.max < 1e-15 && (found.strips_to_reference.max - 0.02).abs() < 1e-15);
    assert!((found.reference_to_strips.max - 0.2).abs() < 1e-12 && found.reference_to_strips.at[1] == 1.0);
    assert!((found.trimmed_area - 0.79).abs() < 1e-6 && (found.coverage - 0.79).abs() < 2e-3 && found.overlap == 0.0);
    let gap = 0.01_f64.hypot(0.02);
    assert!((found.max_gap - gap).abs() < 1e-12 && (found.mean_gap - gap).abs() < 1e-12);
    assert!((first.widths.mean - 0.6).abs() < 1e-12 && first.widths.variation < 1e-12 && !first.is_too_wide);
    assert!((first.area - 0.72).abs() < 1e-12 && (first.trimmed_area - 0.5).abs() < 1e-6);
    assert!(found.width_variation > 0.1);
    assert!(found.max_kink_deg < 1e-12);
}

#[test]
fn two_planes_at_ten_degrees_have_a_kink_of_ten_degrees() {
    let flat = TriangleMesh::new(&height_field(5, 5, [-1.0, 1.0], [-1.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&flat);
    let kinks = |degrees: f64, is_turned: bool| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let side = |x: f64, y: f64| DVec3::new(x, y * cos, y * sin);
        let first = straight(5, [p(-0.9, -0.8), p(-0.9, 0.0)], [p(0.9, -0.6), p(0.9, 0.0)]);
        let [start, end] = [[p(-0.8, 0.0), side(-0.9, 0.6)], [p(0.8, 0.0), side(0.8, 0.7)]];
        let second = if is_turned { straight(7, end, start) } else { straight(7, start, end) };
        let found = report(&[first, second], &reference, &reference, &ReportOptions::default()).unwrap();
        assert!(found.max_gap < 1e-14);
        [found.max_kink_deg, found.mean_kink_deg]
    };
    for is_turned in [false, true] {
        for degrees in [0.0, 10.0, 75.0, 120.0] {
            assert!(kinks(degrees, is_turned).iter().all(|kink| (kink - degrees).abs() < 1e-9));
        }
    }
}

#[test]
fn kinks_fall_with_the_square_of_the_width_or_faster() {
    // Chords of z = xy + y²/2 across y: strips that are not tangent to it, whose kinks are of first order in their width.
    let mesh = TriangleMesh::new(&height_field(41, 41, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y + 0.5 * y * y).unwrap());
    let mesh = mesh.unwrap();
    let reference = ReferenceMesh::new(&mesh);
    let kink = |count: usize| {
        let at = |x: f64, y: f64| DVec3::new(x, y, x * y + 0.5 * y * y);
        let y = |k: usize| -1.0 + 2.0 * k as f64 / count as f64;
        let one = |k: usize| straight(4, [at(-1.0, y(k)), at(-1.0, y(k + 1))], [at(1.0, y(k)), at(1.0, y(k + 1))]);
        let strips: Vec<Strip> = (0..count).map(one).collect();
        report(&strips, &reference, &reference, &ReportOptions::default()).unwrap().max_kink_deg.to_radians()
    };
    // In the section x = −y, where the surface is least inclined, slopes of neighbouring chords differ by the width.
    let (coarse, fine) = (kink(8), kink(16));
    assert!(coarse > 0.15 && coarse < 0.26 && (coarse / fine - 2.0).abs() < 0.05, "{coarse} {fine}");
}

#[test]
fn strips_as_wide_as_features_are_warned_of() {
    let mesh = saddle_mesh(21);
    // At x = y = 1/2, with W² = 1 + x² + y², the mean curvature is −xy/W³ and Gauss's −1/W⁴.
    let (sizes, w) = (feature_sizes(&mesh), 1.5_f64.sqrt());
    let (mean, gauss) = (-0.25 / w.powi(3), -1.0 / w.powi(4));
    let root = (mean * mean - gauss).sqrt();
    let exact = 1.0 / (mean - root).abs().max((mean + root).abs());
    assert!((sizes[330] / exact - 1.0).abs() < 1e-3, "{} {exact}", sizes[330]);
    let flat = TriangleMesh::new(&height_field(3, 3, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
    assert!(feature_sizes(&flat).iter().all(|size| *size > 1e5 && size.is_finite()));
    let reference = ReferenceMesh::new(&mesh);
    let strips = strips(1.0, &[-1.0, -0.7, 0.7, 1.0], 0.0);
    let found = report(&strips, &reference, &reference, &ReportOptions::default()).unwrap();
    assert_eq!(found.too_wide, [1]);
    // The widest is 1.4 √2, where the radius is least: 1 in the middle.
    let worst = found.strips[1];
    assert!((1.0..2.0).contains(&worst.width_over_feature), "{worst:?}");
    assert!((0.95..1.6).contains(&worst.feature_size), "{worst:?}");
    assert!(worst.width_over_feature * worst.feature_size <= worst.widths.max * (1.0 + 1e-12));
    let options = ReportOptions { feature_sizes: Some(vec![10.0; 441]), ..ReportOptions::default() };
    let found = report(&strips, &reference, &reference, &options).unwrap();
    assert!(found.too_wide.is_empty() && (found.strips[1].width_over_feature - 0.14 * 2.0_f64.sqrt()).abs() < 0.06);
}

#[test]
fn bad_arguments_are_named() {
    let mesh = saddle_mesh(5);
    let reference = ReferenceMesh::new(&mesh);
    let strips = strips(1.0, &[-1.0, 0.0, 1.0], 0.0);
    let place =
        |options: ReportOptions| report(&strips, &reference, &reference, &options).unwrap_err().place().to_owned();
    let with = ReportOptions::default;
    assert_eq!(place(ReportOptions { samples_along: 0, ..with() }), "options.samples_along");
    assert_eq!(place(ReportOptions { samples_across: 1, ..with() }), "options.samples_across");
    assert_eq!(place(ReportOptions { joints: Some(vec![[0, 1], [1, 2]]), ..with() }), "options.joints[1][1]");
    assert_eq!(place(ReportOptions { feature_sizes: Some(vec![1.0]), ..with() }), "options.feature_sizes");
    assert_eq!(place(ReportOptions { feature_sizes: Some(vec![f64::NAN; 25]), ..with() }), "options.feature_sizes[0]");
    assert_eq!(place(ReportOptions { feature_ratio: f64::NAN, ..with() }), "options.feature_ratio");
    let trim = TrimOptions { tolerance: 1.0, ..TrimOptions::default() };
    assert_eq!(place(ReportOptions { trim, ..with() }), "options.trim.tolerance");
    assert_eq!(report(&[], &reference, &reference, &with()).unwrap_err().place(), "strips");
    assert_eq!(consecutive(3, true), [[0, 1], [1, 2], [2, 0]]);
    assert!(consecutive(0, true).is_empty());
}

#[test]
fn what_strips_cover_twice_counts_once_and_is_told_apart() {
    let flat = TriangleMesh::new(&height_field(9, 7, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&flat);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    // From 0.03 to 0.61, and turned from 0.23 to 0.87 at one side, from 0.33 to 0.97 at the other; far below, one that is no cover.
    let first = straight(4, [p(-0.1, 0.03, 0.0), p(-0.1, 0.61, 0.0)], [p(1.1, 0.03, 0.0), p(1.1, 0.61, 0.0)]);
    let second = straight(5, [p(0.0, 0.23, 0.001), p(0.0, 0.87, 0.001)], [p(1.0, 0.33, 0.001), p(1.0, 0.97, 0.001)]);
    let below = straight(4, [p(0.0, 0.0, -0.1), p(0.0, 1.0, -0.1)], [p(1.0, 0.0, -0.1), p(1.0, 1.0, -0.1)]);
    let found = report(&[first, second, below], &reference, &reference, &ReportOptions::default()).unwrap();
    assert!((found.coverage - 0.89).abs() < 1e-3, "{}", found.coverage);
    assert!((found.overlap - 0.33).abs() < 1e-3, "{}", found.overlap);
    assert!((found.trimmed_area - 0.58 - 0.64 - 1.0).abs() < 1e-6);
}

#[test]
fn a_closed_strip_has_no_seam() {
    let tube = |z: f64| {
        (0..24)
            .map(|i| f64::from(i) * 0.1 * std::f64::consts::TAU / 2.4)
            .map(|t| DVec3::new(t.cos(), t.sin(), z))
            .collect()
    };
    let basis = crate::mesh::curve::CubicBasis::new(24, true).unwrap();
    let strip = Strip::new(basis, [tube(0.0), tube(1.0)]).unwrap();
    // A spline with control points on a circle of radius 1 has one of (2 + cos(2π/24)) / 3 at its knots.
    let radius = (2.0 + (std::f64::consts::TAU / 24.0).cos()) / 3.0;
    let ring = |v: f64| std::f64::consts::TAU * v;
    let mesh = crate::mesh::patterns::parametric_surface(97, 5, [0.0, 1.0], [0.1, 0.9], |u, v| {
        DVec3::new(radius * (ring(u) + 0.1).cos(), radius * (ring(u) + 0.1).sin(), v)
    });
    let mesh = TriangleMesh::new(&mesh.unwrap()).unwrap();
    let reference = ReferenceMesh::new(&mesh);
    let found = report(&[strip], &reference, &reference, &ReportOptions::default()).unwrap();
    assert!(
        found.reference_to_strips.max < 2e-5 && found.coverage == 1.0,
        "{} {}",
        found.reference_to_strips.max,
        found.coverage
    );
    assert!(
        (found.trimmed_area / found.reference_area - 1.0).abs() < 1e-3,
        "{}",
        found.trimmed_area / found.reference_area
    );
}
