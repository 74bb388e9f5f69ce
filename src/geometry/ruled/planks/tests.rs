use glam::DVec2;

use super::*;
use crate::geometry::ruled::trim::tests::straight;
use crate::linalg::dense::Svd;
use crate::mesh::curve::CubicBasis;

/// The strip with these boundaries, interpolated at the Greville abscissae.
fn through(count: usize, at: impl Fn(f64) -> [DVec3; 2]) -> Strip {
    let basis = CubicBasis::new(count, false).unwrap();
    let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
    let abscissae: Vec<f64> = (0..count).map(|i| (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3.0).collect();
    let columns: Vec<Vec<f64>> = (0..count)
        .map(|j| {
            let value = |&u: &f64| {
                let local = basis.at(u);
                (0..4).filter(|&k| local.functions[k] == j).map(|k| local.values[k]).sum()
            };
            abscissae.iter().map(value).collect()
        })
        .collect();
    let svd = Svd::new(count, &columns).unwrap();
    let side = |side: usize| -> Vec<DVec3> {
        let solved = [0, 1, 2].map(|axis| {
            let right: Vec<f64> = abscissae.iter().map(|u| at(u / spans)[side][axis]).collect();
            svd.least_norm(&right, 1e-14)
        });
        (0..count).map(|i| DVec3::new(solved[0][i], solved[1][i], solved[2][i])).collect()
    };
    Strip::new(basis.clone(), [side(0), side(1)]).unwrap()
}

/// A turn of space, so that no axis is one of the coordinates.
fn turned(p: DVec3) -> DVec3 {
    glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.7, 1.1) * p + DVec3::new(3.0, -2.0, 5.0)
}

/// The conoid (s cos φ(t), s sin φ(t), t) for s from 1 to 3 and t from 0 to 2, φ = 0.3 + 0.5 t + 0.1 t².
fn conoid() -> Strip {
    through(12, |x| {
        let t = 2.0 * x;
        let (sin, cos) = (0.3 + 0.5 * t + 0.1 * t * t).sin_cos();
        [1.0, 3.0].map(|s| turned(DVec3::new(s * cos, s * sin, t)))
    })
}

#[test]
fn a_conoid_has_its_axis() {
    let found = axis(&conoid()).unwrap();
    let expected = turned(DVec3::Z) - turned(DVec3::ZERO);
    assert!(found.direction.distance(expected) < 1e-9 && found.deviation_deg < 1e-9, "{found:?}");
    // Both families of z = xy: rulings at right angles to y, or to x.
    let saddle = straight(
        5,
        [DVec3::new(-1.0, -1.0, 1.0), DVec3::new(-1.0, 1.0, -1.0)],
        [DVec3::new(1.0, -1.0, -1.0), DVec3::ONE],
    );
    assert!(axis(&saddle).unwrap().direction.distance(DVec3::X) < 1e-12);
    let flat = straight(5, [DVec3::ZERO, DVec3::Y], [DVec3::X, DVec3::X + DVec3::Y]);
    let error = axis(&flat).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::Degenerate, "strip"));
}

#[test]
fn planks_hold_all_rulings_of_their_slab() {
    let strip = conoid();
    for (depth, thickness) in [(0.0, 0.2), (0.05, 0.15), (0.0, 0.9)] {
        let found = planks(&strip, &PlankOptions { depth, ..PlankOptions::new(thickness) }).unwrap();
        assert_eq!(found.planks.len(), (2.0_f64 / thickness - 1e-6).ceil() as usize);
        let axis = DVec3::from_array(found.axis);
        let heights = |u: f64| strip.at(u, 0.3).point.dot(axis);
        for (k, plank) in found.planks.iter().enumerate() {
            let [along, across, origin] = [plank.along, plank.across, plank.origin].map(DVec3::from_array);
            assert!(along.cross(across).distance(axis) < 1e-14 && (origin.dot(axis) - plank.heights[0]).abs() < 1e-13);
            assert!((plank.heights[1] - plank.heights[0] - thickness).abs() < 1e-13);
            let corners = plank.outline.map(DVec2::from_array);
            let mut least = [f64::INFINITY; 4];
            for i in 0..=60 {
                let u = plank.parameters[0] + (plank.parameters[1] - plank.parameters[0]) * f64::from(i) / 60.0;
                let height = heights(u);
                assert!(height > plank.heights[0] - 1e-12 && height < plank.heights[1] + 1e-12);
                for j in 0..=4 {
                    let p = strip.at(u, f64::from(j) / 4.0).point - origin;
                    let p = DVec2::new(p.dot(along), p.dot(across));
                    for side in 0..4 {
                        let (a, b) = (corners[side], corners[(side + 1) % 4]);
                        least[side] = least[side].min((b - a).normalize().perp_dot(p - a));
                    }
                }
            }
            // All within, and each side is met but for the depth.
            for (side, expected) in [(0, depth), (1, 0.0), (2, depth), (3, 0.0)] {
                assert!(least[side] > expected - 1e-12 && least[side] < expected + 1e-3, "{k} {side}: {least:?}");
            }
            // The board and what is cut off it, by the shoelace formula.
            let area: f64 = (0..4).map(|i| 0.5 * corners[i].perp_dot(corners[(i + 1) % 4])).sum();
            assert!((area - plank.length * plank.width * (1.0 - plank.offcut)).abs() < 1e-12);
            let xs = corners.map(|corner| corner.x);
            let length =
                xs.iter().fold(0.0_f64, |most, x| most.max(*x)) - xs.iter().fold(0.0_f64, |least, x| least.min(*x));
            assert!((length - plank.length).abs() < 1e-12 && plank.length >= 2.0 && plank.offcut < 0.7);
            // Cuts are as far off square as said.
            for (angle, [a, b]) in plank.end_angles_deg.into_iter().zip([[0, 3], [1, 2]]) {
                let cut = corners[b] - corners[a];
                assert!((cut.x.atan2(cut.y).to_degrees() - angle).abs() < 1e-9);
            }
            let [lower, upper] = plank.corners();
            assert!((0..4).all(|i| (upper[i] - lower[i]).distance(thickness * axis) < 1e-12));
            assert!((lower[0] - origin).dot(axis).abs() < 1e-12);
        }
        let filled: f64 = found.planks.iter().map(|plank| plank.filled).sum();
        assert!((filled * thickness - 2.0).abs() < 1e-9);
        for side in 0..2 {
            assert_eq!(found.dowels[side].len(), found.planks.len() + 1);
            for (point, plank) in found.dowels[side].iter().zip(&found.planks).skip(1) {
                assert!((DVec3::from_array(*point).dot(axis) - plank.heights[0]).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_straight_wall_is_of_equal_square_boards() {
    // All rulings are parallel, so that the axis must be given.
    let wall = straight(6, [DVec3::ZERO, 4.0 * DVec3::X], [3.0 * DVec3::Z, 4.0 * DVec3::X + 3.0 * DVec3::Z]);
    let options = PlankOptions { axis: Some(-7.0 * DVec3::Z), depth: 0.1, ..PlankOptions::new(0.5) };
    let found = planks(&wall, &options).unwrap();
    assert_eq!((found.planks.len(), found.offcut), (6, 0.0));
    for plank in &found.planks {
        assert!(
            (plank.length - 4.0).abs() < 1e-14 && (plank.width - 0.2).abs() < 1e-14 && plank.end_angles_deg == [0.0; 2]
        );
    }
    assert!((found.stock_area - 6.0 * 0.8).abs() < 1e-13);
    // Cuts at a given height: the first and the last plank are partly filled.
    let found = planks(&wall, &PlankOptions { first_cut: Some(10.2), ..options }).unwrap();
    let filled: Vec<f64> = found.planks.iter().map(|plank| plank.filled).collect();
    assert!(filled.len() == 7 && (filled[0] - 0.4).abs() < 1e-12 && (filled[6] - 0.6).abs() < 1e-12, "{filled:?}");
}

#[test]
fn what_cannot_be_planks_is_refused() {
    let refusal = |strip: &Strip, options: PlankOptions| {
        let error = planks(strip, &options).unwrap_err();
        (error.status(), error.place().to_owned(), error.to_string())
    };
    // z = sin t comes back.
    let folded = through(20, |x| {
        let (sin, cos) = (2.0 * x).sin_cos();
        [1.0, 2.0].map(|s| DVec3::new(s * cos, s * sin, (2.5 * x).sin()))
    });
    let (status, place, reason) = refusal(&folded, PlankOptions::new(0.1));
    assert!((status, place.as_str()) == (Status::Degenerate, "strip") && reason.contains("folded"), "{reason}");
    // A one-sheet hyperboloid is no conoid: its rulings (−sin, cos, 1) are at 45 degrees to every horizontal plane.
    let hyperboloid = through(12, |x| {
        let (sin, cos) = (1.5 * x).sin_cos();
        [-0.5, 0.5].map(|t| DVec3::new(cos - t * sin, sin + t * cos, t))
    });
    let (status, place, reason) = refusal(&hyperboloid, PlankOptions::new(0.1));
    assert!((status, place.as_str()) == (Status::NotPlanar, "strip") && reason.contains("degrees"), "{reason}");
    let with = |change: fn(&mut PlankOptions)| {
        let mut options = PlankOptions::new(0.1);
        change(&mut options);
        refusal(&conoid(), options).1
    };
    assert_eq!(with(|options| options.thickness = 0.0), "options.thickness");
    assert_eq!(with(|options| options.thickness = 1e-9), "options.thickness");
    assert_eq!(with(|options| options.depth = f64::NAN), "options.depth");
    assert_eq!(with(|options| options.tolerance_deg = -1.0), "options.tolerance_deg");
    assert_eq!(with(|options| options.axis = Some(DVec3::ZERO)), "options.axis");
    assert_eq!(with(|options| options.first_cut = Some(1e300)), "options.first_cut");
}

#[test]
fn a_sheet_has_every_plank_in_true_scale() {
    let found = planks(&conoid(), &PlankOptions::new(0.25)).unwrap();
    let text = sheet::sheet(&found, "conoid", 1000.0).unwrap();
    assert_eq!(text.matches("class=\"cut\"").count(), 8);
    assert_eq!(text.matches("class=\"upper\"").count(), 8);
    // The first outline, read back: its sides are as long as the plank's, in millimetres.
    let points = text.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
    let corners: Vec<DVec2> = points
        .split(' ')
        .map(|pair| {
            let (x, y) = pair.split_once(',').unwrap();
            DVec2::new(x.parse().unwrap(), y.parse().unwrap())
        })
        .collect();
    for i in 0..4 {
        let [a, b] = [found.planks[0].outline[i], found.planks[0].outline[(i + 1) % 4]].map(DVec2::from_array);
        assert!((corners[i].distance(corners[(i + 1) % 4]) - 1000.0 * a.distance(b)).abs() < 1e-3);
    }
    assert!(text.contains(&format!(
        "0: {:.1} × {:.1} mm",
        1000.0 * found.planks[0].length,
        1000.0 * found.planks[0].width
    )));
    assert_eq!(sheet::sheet(&found, "conoid", 0.0).unwrap_err().place(), "millimetres");
}
