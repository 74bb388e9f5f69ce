//! Curves of given curvature, and snakes fitted to them.

use std::f64::consts::{PI, TAU};
use std::ffi::c_int;
use std::ptr;

use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::*;

#[test]
fn curves_of_constant_curvature_on_a_sphere_are_circles_and_snakes_fit_them() {
    let (kind, sphere) = (shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE as c_int, [0.0, 0.0, 0.0, 2.0]);
    let (start, tangent) = ([2.0, 0.0, 0.0], [0.0, 1.0, 1.0]);
    let curve = |curvatures: &[f64], length: f64, options: *const shapeop_snake_curve_options, room: &mut [f64]| {
        let (nb, capacity, mut count) = (curvatures.len() as c_int, room.len() as c_int / 3, -1);
        let mut told = sized!(shapeop_snake_curve_report);
        // SAFETY: live arrays of the stated lengths, live structs.
        let code = unsafe {
            let (start, tangent) = (start.as_ptr(), tangent.as_ptr());
            let (at, to) = (curvatures.as_ptr(), room.as_mut_ptr());
            let (count, told, sphere) = (&raw mut count, &raw mut told, sphere.as_ptr());
            shapeop_snakeCurve(kind, sphere, 4, start, tangent, at, nb, length, options, to, capacity, count, told)
        };
        (code, count, told)
    };
    let mut room = vec![0.0; 3 * 202];
    let null = ptr::null();
    let (code, count, told) = curve(&[0.8], 3.0, null, &mut room);
    assert_eq!((code, count), (SO_SUCCESS, 201), "{}", message());
    let at = points(&room[..603]);
    assert!(told.end == shapeop_snake_curve_end::SO_SNAKE_CURVE_LENGTH && (told.length - 3.0).abs() < 1e-12);
    assert!(at.iter().all(|p| (length(*p) - 2.0).abs() < 1e-9));
    let chord = 2.0 / 0.8 * (0.5 * 3.0 * 0.8_f64).sin();
    assert!((distance(at[0], at[200]) - chord).abs() < 1e-6);
    // One arc is all there is of it.
    let mut fitted = sized!(shapeop_snake_fit_report);
    // SAFETY: live arrays of the stated lengths, live structs.
    let fit = |points: *const f64, nb, closed, arcs, options, report| unsafe {
        shapeop_snakeFit(points, nb, closed, arcs, options, report)
    };
    let snake = Snake(fit(room.as_ptr(), 201, 0, 2, null.cast(), &raw mut fitted));
    assert!(!snake.0.is_null() && fitted.deviation < 1e-6 && fitted.residual < 1e-12, "{} {fitted:?}", message());
    assert!((report(&snake).length - 3.0).abs() < 1e-5);
    // The other side is the mirror image; where the sphere bends more there is none.
    let mut own = defaults!(shapeop_snake_curve_options, shapeop_snakeDefaultCurveOptions);
    own.turns_right = 1;
    let mut right = vec![0.0; 603];
    assert_eq!(curve(&[0.8], 3.0, &own, &mut right).1, 201);
    let mirrored = points(&right);
    assert!(mirrored.iter().zip(&at).all(|(a, b)| (a[0] - b[0]).abs() < 1e-6));
    assert!(distance(mirrored[200], at[200]) > 0.5);
    let untouched = room.clone();
    let (code, count, _) = curve(&[0.4], 3.0, null, &mut room);
    assert_eq!((code, count), (SO_NO_SOLUTION, -1));
    assert!(names("curvatures") && room == untouched);
    // Along the way it ends there, and says how much each bends.
    let (code, _, told) = curve(&[0.9, 0.1], 3.0, null, &mut room);
    assert_eq!(code, SO_SUCCESS);
    assert_eq!(told.end, shapeop_snake_curve_end::SO_SNAKE_CURVE_BENDS_MORE);
    assert!(told.curvature < 0.5 && (told.normal_curvature.abs() - 0.5).abs() < 1e-6 && told.length < 2.0, "{told:?}");
    for (curvatures, length, place) in [
        (&[][..], 1.0, "nb_curvatures"),
        (&[1.0, -1.0], 1.0, "curvatures[1]"),
        (&[f64::NAN], 1.0, "curvatures[0]"),
        (&[1.0], 0.0, "length"),
        (&[1.0], f64::INFINITY, "length"),
    ] {
        assert_ne!(curve(curvatures, length, null, &mut room).0, SO_SUCCESS);
        assert!(names(place));
    }
    own.steps = 0;
    assert_eq!(curve(&[1.0], 1.0, &own, &mut room).0, SO_INVALID_VALUE);
    assert!(names("options->steps"));
    (own.steps, own.method) = (20, 2);
    assert_eq!(curve(&[1.0], 1.0, &own, &mut room).0, SO_INVALID_VALUE);
    assert!(names("options->method"));
    none(fit(room.as_ptr(), 2, 0, 2, null.cast(), ptr::null_mut()), "points");
    none(fit(room.as_ptr(), 9, 0, 0, null.cast(), ptr::null_mut()), "nb_arcs");
    none(fit(room.as_ptr(), 9, 2, 1, null.cast(), ptr::null_mut()), "is_closed");
    none(fit(null.cast(), 9, 0, 1, null.cast(), ptr::null_mut()), "points");
    let mut own = defaults!(shapeop_snake_fit_options, shapeop_snakeDefaultFitOptions);
    own.nearness = 0.0;
    none(fit(room.as_ptr(), 9, 0, 1, &raw const own, ptr::null_mut()), "options->nearness");
    (own.nearness, own.curvature) = (0.005, f64::NAN);
    none(fit(room.as_ptr(), 9, 0, 1, &raw const own, ptr::null_mut()), "options->curvature");
}

#[test]
fn curves_on_a_mesh_end_at_its_boundary() {
    // A plane as a mesh of quads.
    let at = |k: c_int| f64::from(k) / 5.0 - 1.0;
    let grid: Vec<f64> = (0..121).flat_map(|k| [at(k % 11), at(k / 11), 0.0]).collect();
    let quads: Vec<c_int> = (0..110).filter(|k| (k + 1) % 11 != 0).flat_map(|k| [k, k + 1, k + 12, k + 11]).collect();
    let trace = |start: [f64; 3], tangent: [f64; 3], curvature: f64, room: &mut [f64]| {
        let (mut told, mut count) = (sized!(shapeop_snake_curve_report), 0);
        let capacity = room.len() as c_int / 3;
        // SAFETY: live arrays of the stated lengths, live structs.
        let code = unsafe {
            let (start, tangent, null, to) = (start.as_ptr(), tangent.as_ptr(), ptr::null(), room.as_mut_ptr());
            let nb = quads.len() as c_int;
            let (points, faces, corners) = (grid.as_ptr(), quads.as_ptr(), &4);
            let (at, count, told) = (&curvature, &raw mut count, &raw mut told);
            shapeop_snakeMeshCurve(
                points, 121, faces, nb, corners, 1, start, tangent, at, 1, 2.0, null, to, capacity, count, told,
            )
        };
        (code, count, told)
    };
    let mut room = vec![0.0; 3 * 202];
    let (code, count, told) = trace([0.1, -0.3, 0.0], [1.0, 0.2, 0.0], 2.0, &mut room);
    assert_eq!((code, count, told.end), (SO_SUCCESS, 201, shapeop_snake_curve_end::SO_SNAKE_CURVE_LENGTH));
    let found = points(&room);
    let chord = 2.0 * 0.5 * (2.0_f64).sin();
    assert!((distance(found[0], found[200]) - chord).abs() < 1e-6 && found.iter().all(|p| p[2].abs() < 1e-12));
    let (code, count, told) = trace([0.1, 0.0, 0.0], X, 0.0, &mut room);
    assert_eq!((code, told.end), (SO_SUCCESS, shapeop_snake_curve_end::SO_SNAKE_CURVE_BOUNDARY));
    assert!((told.length - 0.9).abs() < 1e-9 && count == 92, "{told:?} {count}");
    assert_eq!(trace([0.1, 0.0, 9.0], X, 0.0, &mut room).0, SO_OUT_OF_DOMAIN);
    assert!(names("start"));
    assert_eq!(trace([0.1, 0.0, 0.0], Z, 0.0, &mut room).0, SO_INVALID_VALUE);
    assert!(names("tangent"));
    assert_eq!(trace(NAN, X, 0.0, &mut room).0, SO_INVALID_VALUE);
    assert!(names("start"));
}

#[test]
fn a_closed_snake_is_fitted_to_a_closed_polyline() {
    let circle: Vec<f64> = around([1.5, 0.0, 0.3], [0.0, TAU])[..ON_RAIL as usize].concat();
    let mut found = sized!(shapeop_snake_fit_report);
    // SAFETY: a live array of the stated length, a live struct.
    let snake = Snake(unsafe { shapeop_snakeFit(circle.as_ptr(), ON_RAIL, 1, 8, ptr::null(), &mut found) });
    assert!(!snake.0.is_null(), "{}", message());
    let told = report(&snake);
    assert_eq!((told.is_closed, told.arc_count, control(&snake).len()), (1, 8, 8));
    assert!(found.deviation < 1e-9 && found.residual < 1e-12 && (told.length - 3.0 * PI).abs() < 1e-9, "{found:?}");
}
