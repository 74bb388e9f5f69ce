//! The C functions of ruled strips: what they answer, and what they refuse without a change.

mod abi;

use std::ffi::{CString, c_int, c_uint, c_void};
use std::ptr;

use abi::{Abi, last_error, text};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

/// Points along a side of the meshes.
const SIDE: c_int = 21;

/// The chord error of the saddle's mesh: a quarter of its squared edge.
const CHORD: f64 = 0.1 * 0.1 / 4.0;

/// A design's handle; deleted when dropped.
struct Design(*mut ShapeOpRuled);

impl Drop for Design {
    fn drop(&mut self) {
        shapeop_ruledDelete(self.0);
    }
}

fn message() -> String {
    last_error(ptr::null_mut())
}

/// A grid of `SIDE` times `SIDE` points over [-1, 1]², as quads.
fn grid(point: impl Fn(f64, f64) -> [f64; 3]) -> (Vec<f64>, Vec<c_int>) {
    let at = |k: c_int| 2.0 * f64::from(k) / f64::from(SIDE - 1) - 1.0;
    let points = (0..SIDE * SIDE).flat_map(|k| point(at(k % SIDE), at(k / SIDE))).collect();
    let corners = |k: c_int| [k, k + 1, k + 1 + SIDE, k + SIDE];
    (points, (0..SIDE * (SIDE - 1)).filter(|k| (k + 1) % SIDE != 0).flat_map(corners).collect())
}

fn create(points: &[f64], quads: &[c_int], options: Option<&shapeop_ruled_options>) -> *mut ShapeOpRuled {
    let (nb_points, nb_indices) = (points.len() as c_int / 3, quads.len() as c_int);
    let options = options.map_or(ptr::null(), ptr::from_ref);
    // SAFETY: live arrays of the stated lengths.
    unsafe { shapeop_ruledCreate(points.as_ptr(), nb_points, quads.as_ptr(), nb_indices, &4, 1, options) }
}

fn made(point: impl Fn(f64, f64) -> [f64; 3]) -> Design {
    let (points, quads) = grid(point);
    let design = Design(create(&points, &quads, None));
    assert!(!design.0.is_null(), "{}", message());
    design
}

/// z = xy: both families of asymptotic curves are straight lines.
fn saddle() -> Design {
    made(|x, y| [x, y, x * y])
}

/// What a function with a capacity writes, `unit` values for each of its results.
fn all<T: Clone>(empty: T, unit: usize, call: impl Fn(*mut T, c_int, *mut c_int) -> shapeop_err) -> Vec<T> {
    let mut count = -7;
    assert_eq!(call(ptr::null_mut(), 0, &mut count), SO_SUCCESS, "{}", message());
    let mut room = vec![empty; unit * count as usize];
    assert_eq!(call(room.as_mut_ptr(), count, &mut count), SO_SUCCESS, "{}", message());
    room
}

/// A vector of three neighbouring numbers.
fn points(numbers: &[f64]) -> Vec<[f64; 3]> {
    numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn set_levels(design: &Design, count: c_int) -> shapeop_err {
    let (null, none) = (ptr::null(), ptr::null_mut());
    // SAFETY: null for what is left out.
    unsafe { shapeop_ruledSetLevelBoundaries(design.0, null, count, 0.0, ptr::null(), 0, ptr::null(), None, none) }
}

fn optimise(design: &Design) -> shapeop_ruled_optimise_report {
    let mut report = optimise_report();
    // SAFETY: null for what is left out, and a live struct.
    let code = unsafe { shapeop_ruledOptimise(design.0, ptr::null(), None, ptr::null_mut(), &mut report) };
    assert_eq!(code, SO_SUCCESS, "{}", message());
    report
}

fn optimise_report() -> shapeop_ruled_optimise_report {
    // SAFETY: numbers, and an enum that has a 0.
    let mut report: shapeop_ruled_optimise_report = unsafe { std::mem::zeroed() };
    report.struct_size = size_of::<shapeop_ruled_optimise_report>() as c_uint;
    report
}

fn control(design: &Design, strip: c_int) -> Vec<[f64; 3]> {
    // SAFETY: `all` gives room for the stated capacity.
    points(&all(0.0, 6, |out, capacity, count| unsafe {
        shapeop_ruledControl(design.0, strip, out, capacity, count, ptr::null_mut())
    }))
}

fn evaluate(design: &Design, strip: c_int, u: f64, v: f64) -> [f64; 3] {
    let mut point = [0.0; 3];
    // SAFETY: an output for three numbers, null for the others.
    let code =
        unsafe { shapeop_ruledEvaluate(design.0, strip, u, v, point.as_mut_ptr(), ptr::null_mut(), ptr::null_mut()) };
    assert_eq!(code, SO_SUCCESS, "{}", message());
    point
}

#[test]
fn directions_of_the_saddle_are_its_lines() {
    let design = saddle();
    let at: Vec<[f64; 3]> = points(&grid(|x, y| [x, y, x * y]).0);
    let mut status = vec![7; at.len()];
    let mut seen = Vec::new();
    for family in 0..2 {
        let states = status.as_mut_ptr();
        // SAFETY: `all` gives room for the stated capacity, as the states have.
        let found = points(&all(0.0, 3, |out, capacity, count| unsafe {
            shapeop_ruledDirections(design.0, family, out, states, capacity, count)
        }));
        assert!(status.iter().all(|state| *state == shapeop_ruled_point::SO_RULED_POINT_GOOD as c_int));
        // Along x the direction is (1, 0, y), along y it is (0, 1, x).
        let sine = |i: usize, along: [f64; 3]| (1.0 - (dot(found[i], along) / length(along)).powi(2)).max(0.0).sqrt();
        let worst = [0, 1].map(|axis| {
            let along = |i: usize| if axis == 0 { [1.0, 0.0, at[i][1]] } else { [0.0, 1.0, at[i][0]] };
            (0..at.len()).map(|i| sine(i, along(i))).fold(0.0, f64::max)
        });
        seen.push(if worst[0] < worst[1] { 0 } else { 1 });
        assert!(worst[0].min(worst[1]) < 0.025 && worst[0].max(worst[1]) > 0.5, "{worst:?}");
    }
    assert_eq!(seen[0] + seen[1], 1);
    // SAFETY: `all` gives room for the stated capacity.
    let principal = all(0.0, 2, |out, capacity, count| unsafe {
        shapeop_ruledCurvatures(design.0, out, ptr::null_mut(), ptr::null_mut(), capacity, count)
    });
    for (k, [x, y, _]) in principal.chunks_exact(2).zip(&at) {
        assert!((k[0] * k[1] + (1.0 + x * x + y * y).powi(-2)).abs() < 0.02, "{k:?}");
    }
    let hint = [0.0, -1.0, 0.0];
    for family in 0..2 {
        // SAFETY: a live vector; `all` gives room for the stated capacity.
        unsafe {
            assert_eq!(shapeop_ruledSelectFamily(design.0, family, hint.as_ptr(), 0), SO_SUCCESS);
            let field = points(&all(0.0, 3, |out, capacity, count| {
                shapeop_ruledField(design.0, out, ptr::null_mut(), capacity, count)
            }));
            let down = field.iter().filter(|a| a[1] < 0.0).count();
            assert!(seen[family as usize] == 0 || down == field.len());
            // A line of the saddle: one of its coordinates stays.
            let (seed, mut end) = ([0.13, 0.21, 0.0273], 9);
            let ending = &raw mut end;
            let trace = points(&all(0.0, 3, |out, capacity, count| {
                shapeop_ruledTrace(design.0, seed.as_ptr(), 0, 0.5, 9.0, out, capacity, count, ending)
            }));
            let fixed = 1 - seen[family as usize];
            let moved = trace.iter().map(|p| (p[fixed] - seed[fixed]).abs()).fold(0.0, f64::max);
            assert!(trace.len() > 3 && moved < 2e-3 && end == 0, "{moved}");
        }
    }
}

#[test]
fn strips_of_the_saddle_lie_on_it_and_cover_it() {
    let design = saddle();
    assert_eq!(set_levels(&design, 3), SO_SUCCESS, "{}", message());
    assert_eq!(shapeop_ruledBoundaryCount(design.0), 5);
    assert_eq!(shapeop_ruledStart(design.0, 8, 0), SO_SUCCESS, "{}", message());
    assert_eq!(shapeop_ruledStripCount(design.0), 4);
    let found = optimise(&design);
    assert!(found.after < found.before && found.iterations > 0, "{found:?}");
    // SAFETY: `all` gives room for the stated capacity.
    let rows = all(0.0, 10, |out, capacity, count| unsafe { shapeop_ruledHistory(design.0, out, capacity, count) });
    assert_eq!(rows.len(), 10 * (found.iterations as usize + 1));
    assert!(rows.chunks_exact(10).zip(rows.chunks_exact(10).skip(1)).all(|(a, b)| b[0] < a[0]));
    let last = &rows[rows.len() - 10..];
    assert!((last[0] - last[1..5].iter().sum::<f64>()).abs() < 1e-15 && last[0] == found.after);
    // How far from z = xy: counted here, where x and y are within the mesh.
    let (mut worst, mut inside) = (0.0_f64, 0);
    for strip in 0..4 {
        for (i, j) in (0..=20).flat_map(|i| (0..=8).map(move |j| (i, j))) {
            let [x, y, z] = evaluate(&design, strip, 5.0 * f64::from(i) / 20.0, f64::from(j) / 8.0);
            if x.abs() <= 1.0 && y.abs() <= 1.0 {
                worst = worst.max((z - x * y).abs());
                inside += 1;
            }
        }
    }
    assert!(worst < 2.0 * CHORD && inside > 200, "{worst} of {inside}");
    // SAFETY: structs of numbers.
    let (mut report, mut one): (shapeop_ruled_report, shapeop_ruled_strip_report) = unsafe { std::mem::zeroed() };
    report.struct_size = size_of::<shapeop_ruled_report>() as c_uint;
    one.struct_size = size_of::<shapeop_ruled_strip_report>() as c_uint;
    // SAFETY: live structs of the stated sizes.
    unsafe {
        assert_eq!(shapeop_ruledStripReport(design.0, 0, &mut one), SO_NOT_INITIALISED);
        assert_eq!(shapeop_ruledReport(design.0, ptr::null(), &mut report), SO_SUCCESS, "{}", message());
        assert_eq!(shapeop_ruledStripReport(design.0, 1, &mut one), SO_SUCCESS);
    }
    assert_eq!((report.strip_count, report.joint_count), (4, 3));
    assert!(report.coverage > 0.995 && report.coverage < 1.02, "{}", report.coverage);
    assert!(one.largest_deviation <= report.largest_deviation && report.largest_deviation < 2.0 * CHORD);
    assert!(one.least_width > 0.0 && one.least_width <= one.mean_width && one.mean_width <= one.greatest_width);
    // Seen from above, the triangles of trimmed strips cover the square.
    let (mut count, mut face_count) = (0, 0);
    // SAFETY: queries of sizes, then arrays of these.
    unsafe {
        let mesh = |points, capacity, count, faces, face_capacity, face_count| {
            let (null, none) = (ptr::null_mut(), ptr::null_mut());
            let all = SHAPEOP_RULED_ALL;
            shapeop_ruledTrimmedMesh(
                design.0,
                all,
                4,
                1e-7,
                points,
                null,
                capacity,
                count,
                faces,
                none,
                face_capacity,
                face_count,
            )
        };
        assert_eq!(mesh(ptr::null_mut(), 0, &mut count, ptr::null_mut(), 0, &mut face_count), SO_SUCCESS);
        let (mut at, mut faces) = (vec![0.0; 3 * count as usize], vec![0; 3 * face_count as usize]);
        let code = mesh(at.as_mut_ptr(), count, &mut count, faces.as_mut_ptr(), face_count, &mut face_count);
        assert_eq!(code, SO_SUCCESS);
        let at = points(&at);
        assert!(at.iter().all(|p| p[0].abs() < 1.01 && p[1].abs() < 1.01));
        let area = |face: &[c_int]| {
            let [a, b, c] = [0, 1, 2].map(|k| at[face[k] as usize]);
            let (e, f) = (minus(b, a), minus(c, a));
            0.5 * (e[0] * f[1] - e[1] * f[0]).abs()
        };
        let sum: f64 = faces.chunks_exact(3).map(area).sum();
        assert!((sum - 4.0).abs() < 0.02, "{sum}");
    }
    assert!(text(shapeop_ruledSurfacesObj(design.0)).contains("cstype bspline"));
    assert_eq!(text(shapeop_ruledRulingsCsv(design.0, 9)).lines().next().map(|line| line.split(',').count()), Some(11));
    assert!(text(shapeop_ruledReportText(design.0)).contains("max_kink_deg"));
}

#[test]
fn strips_are_copied_and_read_again_from_their_text() {
    let design = saddle();
    assert_eq!((set_levels(&design, 2), shapeop_ruledStart(design.0, 6, 1)), (SO_SUCCESS, SO_SUCCESS));
    let other = Design(shapeop_ruledCopy(design.0));
    let before: Vec<_> = (0..3).map(|strip| control(&design, strip)).collect();
    // Neighbours have one boundary.
    assert_eq!(before[0][6..], before[1][..6]);
    let moved: Vec<f64> = before[1].iter().flat_map(|p| [p[0], p[1], p[2] + 0.5]).collect();
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        assert_eq!(shapeop_ruledSetControl(design.0, 1, moved.as_ptr(), 6), SO_SUCCESS, "{}", message());
        assert_eq!(shapeop_ruledSetControl(design.0, 1, moved.as_ptr(), 5), SO_INVALID_ARGUMENT_LENGTH);
        let mut nan = moved.clone();
        nan[3 * 8] = f64::NAN;
        assert_eq!(shapeop_ruledSetControl(design.0, 1, nan.as_ptr(), 6), SO_INVALID_VALUE);
        assert!(message().starts_with("control[8]"), "{}", message());
    }
    assert_eq!(control(&design, 0)[6..], points(&moved)[..6]);
    assert_eq!(control(&design, 2)[..6], points(&moved)[6..]);
    assert_eq!((0..3).map(|strip| control(&other, strip)).collect::<Vec<_>>(), before);
    let json = CString::new(text(shapeop_ruledStripsText(other.0))).unwrap();
    // SAFETY: a live text.
    assert_eq!(unsafe { shapeop_ruledSetStripsText(design.0, json.as_ptr()) }, SO_SUCCESS);
    assert_eq!((0..3).map(|strip| control(&design, strip)).collect::<Vec<_>>(), before);
    // SAFETY: live texts, or null.
    unsafe {
        assert_eq!(shapeop_ruledSetStripsText(design.0, c"{}".as_ptr()), SO_INVALID_INPUT);
        assert_eq!(shapeop_ruledSetStripsText(design.0, ptr::null()), SO_NULL_POINTER);
        assert_eq!(
            shapeop_ruledSetStripsText(design.0, c"{\"version\": 1, \"strips\": []}".as_ptr()),
            SO_INVALID_ARGUMENT_LENGTH
        );
    }
    assert_eq!(shapeop_ruledStripCount(design.0), 3);
    // SAFETY: `all` gives room for the stated capacity.
    let knots = all(0.0, 1, |out, capacity, count| unsafe { shapeop_ruledKnots(design.0, 0, out, capacity, count) });
    assert_eq!(knots, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0]);
}

#[test]
fn conditions_hold_exactly_and_contradictions_are_named() {
    let design = made(|x, y| [x, y, x * y + 0.1 * (x * x * x - 3.0 * x * y * y)]);
    let planes = [-0.6, 0.1, 0.7].map(|offset| [1.0, 0.2, 0.0, offset]).concat();
    let mut angles = [9.0; 3];
    // SAFETY: live arrays of the stated lengths.
    let cut = |family| unsafe {
        assert_eq!(shapeop_ruledSelectFamily(design.0, family, ptr::null(), 0), SO_SUCCESS);
        shapeop_ruledSetPlanarBoundaries(design.0, planes.as_ptr(), 3, 0.26, 0, ptr::null(), angles.as_mut_ptr())
    };
    assert!([0, 1].into_iter().map(cut).any(|code| code == SO_SUCCESS), "{}", message());
    assert!(angles.iter().all(|angle| *angle > 0.26 && *angle < 1.6), "{angles:?}");
    assert_eq!(shapeop_ruledConstrainCutPlanes(design.0), SO_INVALID_ARGUMENT_LENGTH);
    assert!(message().starts_with("strips"), "{}", message());
    assert_eq!(shapeop_ruledStart(design.0, 7, 0), SO_SUCCESS, "{}", message());
    assert_eq!(shapeop_ruledConstrainCutPlanes(design.0), SO_SUCCESS, "{}", message());
    let (corner, along) = ([-0.4, 1.3, -0.3], [1.0, 0.3, 0.2]);
    // SAFETY: live vectors.
    unsafe {
        // In its plane x + 0.2 y = -0.6 or on the other side of that strip.
        let at = [-0.6 - 0.2 * corner[1], corner[1], corner[2]];
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 1, 0, 0, at.as_ptr()), SO_SUCCESS, "{}", message());
        assert_eq!(shapeop_ruledConstrainEndDirection(design.0, 1, 1, along.as_ptr()), SO_SUCCESS);
        let count = shapeop_ruledConditionCount(design.0);
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 1, 0, 0, at.as_ptr()), SO_SUCCESS);
        assert_eq!(shapeop_ruledConditionCount(design.0), count);
        optimise(&design);
        let strip = control(&design, 1);
        assert!(length(minus(strip[0], at)) < 1e-10, "{:?}", strip[0]);
        let ruling = minus(strip[13], strip[6]);
        let off = (dot(ruling, along) / (length(ruling) * length(along))).abs();
        assert!((1.0 - off).abs() < 1e-10, "{off}");
        for (i, offset) in [(0, -0.6), (7, 0.1)] {
            assert!(strip[i..i + 7].iter().all(|p| (p[0] + 0.2 * p[1] - offset).abs() < 1e-10));
        }
        let off_plane = [at[0] + 0.1, at[1], at[2]];
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 1, 0, 0, off_plane.as_ptr()), SO_SUCCESS);
        let (none, mut report) = (ptr::null_mut(), optimise_report());
        assert_eq!(shapeop_ruledOptimise(design.0, ptr::null(), None, none, &mut report), SO_INFEASIBLE);
        assert!(message().starts_with("conditions[") && report.iterations == 0, "{}", message());
        assert_eq!(control(&design, 1), strip);
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 9, 0, 0, at.as_ptr()), SO_INDEX_OUT_OF_RANGE);
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 1, 2, 0, at.as_ptr()), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledConstrainPoint(design.0, 1, 0, 3, at.as_ptr()), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledConstrainConoid(design.0, 1, [0.0; 3].as_ptr()), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledConstrainPlane(design.0, 1, [0.0, 0.0, 0.0, 1.0].as_ptr()), SO_INVALID_VALUE);
        assert!(message().starts_with("plane"), "{}", message());
        assert_eq!(shapeop_ruledClearConditions(design.0), SO_SUCCESS);
        assert_eq!(shapeop_ruledConditionCount(design.0), 0);
    }
}

#[test]
fn a_conoid_becomes_planks() {
    // A bent conoid with rulings from the axis: planks across it turn like stairs.
    let conoid = |s: f64, t: f64| {
        let (r, bend) = (1.5 + 0.5 * s, 0.02 * s * (1.0 - s * s));
        [r * t.cos(), r * t.sin(), t + bend]
    };
    let design = made(conoid);
    let curve = |s: f64| (0..=40).flat_map(move |k| conoid(s, f64::from(k) / 20.0 - 1.0)).collect::<Vec<_>>();
    let drawn = [curve(-1.0), curve(1.0)].concat();
    // SAFETY: live arrays of the stated lengths.
    let draw = |family| unsafe {
        let hint = [1.0, 0.0, 0.0];
        assert_eq!(shapeop_ruledSelectFamily(design.0, family, hint.as_ptr(), 0), SO_SUCCESS);
        let counts = [41, 41];
        shapeop_ruledSetDrawnBoundaries(design.0, drawn.as_ptr(), 82, counts.as_ptr(), 2, ptr::null(), ptr::null())
            == SO_SUCCESS
            && shapeop_ruledStart(design.0, 8, 0) == SO_SUCCESS
            && (evaluate(&design, 0, 2.0, 0.0)[2] - evaluate(&design, 0, 2.0, 1.0)[2]).abs() < 0.1
    };
    assert!(draw(0) || draw(1), "{}", message());
    let (mut axis, mut deviation) = ([0.0; 3], 9.0);
    // SAFETY: live outputs.
    unsafe {
        assert_eq!(shapeop_ruledStripAxis(design.0, 0, axis.as_mut_ptr(), &mut deviation), SO_SUCCESS);
        assert!(axis[2].abs() > 0.95 && deviation < 0.5, "{axis:?} {deviation}");
        let up = [0.0, 0.0, 2.0];
        assert_eq!(shapeop_ruledConstrainConoid(design.0, 0, up.as_ptr()), SO_SUCCESS);
    }
    optimise(&design);
    let strip = control(&design, 0);
    assert!((0..8).all(|i| (strip[i][2] - strip[i + 8][2]).abs() < 1e-10));
    // SAFETY: structs of numbers.
    let (mut options, mut planks, mut plank): (shapeop_ruled_plank_options, shapeop_ruled_planks, shapeop_ruled_plank) =
        unsafe { std::mem::zeroed() };
    options.struct_size = size_of_val(&options) as c_uint;
    planks.struct_size = size_of_val(&planks) as c_uint;
    plank.struct_size = size_of_val(&plank) as c_uint;
    // SAFETY: live structs and arrays.
    unsafe {
        assert_eq!(shapeop_ruledDefaultPlankOptions(&mut options), SO_SUCCESS);
        assert_eq!(shapeop_ruledCutPlanks(design.0, 0, &options, ptr::null(), &mut planks), SO_INVALID_VALUE);
        assert!(message().starts_with("options->thickness"), "{}", message());
        assert_eq!(
            shapeop_ruledPlank(design.0, 0, &mut plank, ptr::null_mut(), ptr::null_mut(), ptr::null_mut()),
            SO_NOT_INITIALISED
        );
        options.thickness = 0.25;
        options.depth = 0.1;
        assert_eq!(
            shapeop_ruledCutPlanks(design.0, 0, &options, ptr::null(), &mut planks),
            SO_SUCCESS,
            "{}",
            message()
        );
        let height = (strip[7][2] - strip[0][2]).abs();
        assert_eq!(planks.plank_count, (height / 0.25).ceil() as c_uint);
        assert!((planks.axis_z.abs() - 1.0).abs() < 1e-9 && planks.offcut > 0.0 && planks.offcut < 1.0);
        let mut filled = 0.0;
        for index in 0..planks.plank_count as c_int {
            let (mut frame, mut outline, mut rulings) = ([0.0; 9], [0.0; 8], [0.0; 8]);
            let (frame_out, outline_out) = (frame.as_mut_ptr(), outline.as_mut_ptr());
            let code = shapeop_ruledPlank(design.0, index, &mut plank, frame_out, outline_out, rulings.as_mut_ptr());
            assert_eq!(code, SO_SUCCESS);
            assert!((plank.upper - plank.lower - 0.25).abs() < 1e-12 && plank.width > 0.2);
            filled += 0.25 * plank.filled;
            // Each ruling is within the outline, which is convex.
            for end in rulings.chunks_exact(2) {
                for k in 0..4 {
                    let [a, b] = [k, (k + 1) % 4].map(|k| [outline[2 * k], outline[2 * k + 1]]);
                    let side = (b[0] - a[0]) * (end[1] - a[1]) - (b[1] - a[1]) * (end[0] - a[0]);
                    assert!(side > -1e-9, "plank {index}, side {k}: {side}");
                }
            }
            let [origin, along, across] = [0, 3, 6].map(|k| [frame[k], frame[k + 1], frame[k + 2]]);
            assert!(along[2].abs() < 1e-9 && dot(along, across).abs() < 1e-12);
            assert!((dot(origin, [planks.axis_x, planks.axis_y, planks.axis_z]) - plank.lower).abs() < 1e-9);
        }
        assert!((filled - height).abs() < 1e-6, "{filled} {height}");
        // SAFETY: `all` gives room for the stated capacity.
        let dowels = all(0.0, 3, |out, capacity, count| shapeop_ruledDowels(design.0, 1, out, capacity, count));
        assert_eq!(dowels.len(), 3 * (planks.plank_count as usize + 1));
        let sheet = text(shapeop_ruledPlanksSvg(design.0, c"a < b".as_ptr(), 1000.0));
        assert!(sheet.contains("<svg") && sheet.contains("a &lt; b"), "{sheet}");
        assert!(shapeop_ruledPlanksSvg(design.0, c"a".as_ptr(), 0.0).is_null());
        assert!(text(shapeop_ruledPlanksText(design.0)).contains("\"stock_area\""));
        // Strips that change forget them.
        optimise(&design);
        assert!(shapeop_ruledPlanksText(design.0).is_null());
    }
}

extern "C" fn stop_at_second(told: *const shapeop_ruled_progress, user: *mut c_void) -> c_int {
    // SAFETY: the library passes a live struct, the test a count and the design.
    unsafe {
        let seen = user.cast::<(c_int, *mut ShapeOpRuled, c_int)>();
        (*seen).0 += 1;
        (*seen).2 = shapeop_ruledStripCount((*seen).1);
        c_int::from((*told).iteration >= 1)
    }
}

#[test]
fn a_callback_ends_a_run_with_its_best_and_finds_the_design_busy() {
    let design = saddle();
    assert_eq!((set_levels(&design, 2), shapeop_ruledStart(design.0, 6, 0)), (SO_SUCCESS, SO_SUCCESS));
    let mut seen = (0, design.0, 7);
    let mut report = optimise_report();
    let user = (&raw mut seen).cast();
    // SAFETY: a live struct, and what the callback takes.
    let code = unsafe { shapeop_ruledOptimise(design.0, ptr::null(), Some(stop_at_second), user, &mut report) };
    assert_eq!((code, report.stop), (SO_SUCCESS, shapeop_ruled_stop::SO_RULED_STOP_CANCELLED));
    assert_eq!((seen.0, seen.2, report.iterations), (2, -1, 1));
    assert!(report.after < report.before);
}

#[test]
fn handles_of_another_kind_and_stale_ones_are_refused() {
    let solver = Abi::with_points(&[0.0; 9]);
    let design = saddle();
    assert_eq!(shapeop_ruledStripCount(solver.0.cast()), -1);
    assert!(message().contains("design: expected a design's handle"), "{}", message());
    assert_eq!(shapeop_ruledStart(ptr::null_mut(), 8, 0), SO_INVALID_HANDLE);
    assert_eq!((shapeop_pointCount(design.0.cast()), shapeop_canalKind(design.0.cast())), (-1, -1));
    shapeop_delete(design.0.cast());
    shapeop_ruledDelete(solver.0.cast());
    assert_eq!((shapeop_ruledStripCount(design.0), shapeop_pointCount(solver.0)), (0, 3));
    let stale = Design(shapeop_ruledCopy(design.0));
    shapeop_ruledDelete(stale.0);
    assert_eq!(shapeop_ruledStart(stale.0, 8, 0), SO_INVALID_HANDLE);
    assert!(shapeop_ruledStripsText(stale.0).is_null() && shapeop_ruledCopy(stale.0).is_null());
}

#[test]
fn refused_calls_name_their_argument_and_change_nothing() {
    let (mesh, quads) = grid(|x, y| [x, y, x * y]);
    // Spheres, numbers that are not finite, indices beyond, counts that do not fit.
    let (bowl, _) = grid(|x, y| [x, y, x * x + y * y]);
    assert!(create(&bowl, &quads, None).is_null() && shapeop_lastErrorCode(ptr::null_mut()) == SO_CURVATURE_SIGN);
    let mut wrong = mesh.clone();
    wrong[4] = f64::NAN;
    assert!(create(&wrong, &quads, None).is_null() && message().starts_with("points[1]"), "{}", message());
    let mut beyond = quads.clone();
    beyond[5] = SIDE * SIDE;
    assert!(create(&mesh, &beyond, None).is_null() && message().starts_with("faces[1]"), "{}", message());
    assert!(create(&mesh, &quads[1..], None).is_null() && message().starts_with("nb_face_indices"), "{}", message());
    assert!(create(&[], &[], None).is_null());
    // SAFETY: a struct of numbers, and null.
    let mut options: shapeop_ruled_options = unsafe { std::mem::zeroed() };
    assert!(create(&mesh, &quads, Some(&options)).is_null() && message().starts_with("options->struct_size"));
    options.struct_size = size_of::<shapeop_ruled_options>() as c_uint;
    // SAFETY: a live struct.
    assert_eq!(unsafe { shapeop_ruledDefaultOptions(&mut options) }, SO_SUCCESS);
    let refused = |change: &dyn Fn(&mut shapeop_ruled_options)| {
        let mut changed = options;
        change(&mut changed);
        assert!(create(&mesh, &quads, Some(&changed)).is_null());
        message().split(':').next().unwrap_or_default().to_owned()
    };
    assert_eq!(refused(&|options| options.max_mask = 2.0), "options->max_mask");
    assert_eq!(refused(&|options| options.family = 2), "options->family");
    assert_eq!(refused(&|options| options.least_neighbours = 1), "options->least_neighbours");
    assert_eq!(refused(&|options| options.hint_y = f64::NAN), "options->hint_x");
    // Steps in the wrong order.
    let design = saddle();
    let (none, nothing): (*mut f64, *mut c_void) = (ptr::null_mut(), ptr::null_mut());
    let mut count = 7;
    assert_eq!(shapeop_ruledStart(design.0, 8, 0), SO_NO_SOLUTION);
    // SAFETY: live arrays, structs of the stated sizes, or null.
    unsafe {
        assert_eq!(
            shapeop_ruledOptimise(design.0, ptr::null(), None, nothing, ptr::null_mut()),
            SO_INVALID_ARGUMENT_LENGTH
        );
        assert!(message().starts_with("strips"), "{}", message());
        assert_eq!(shapeop_ruledLevelValues(design.0, none, 0, &mut count), SO_NOT_INITIALISED);
        assert_eq!(shapeop_ruledSetLevels(design.0, 3, 0.0, none, 0, ptr::null()), SO_NOT_INITIALISED);
        assert_eq!(shapeop_ruledHistory(design.0, none, 0, &mut count), SO_NOT_INITIALISED);
        assert_eq!(shapeop_ruledConstrainEnds(design.0), SO_INVALID_ARGUMENT_LENGTH);
        assert!(shapeop_ruledSurfacesObj(design.0).is_null());
        assert_eq!(count, 7);
        assert_eq!(set_levels(&design, 3), SO_SUCCESS);
        let before = shapeop_ruledBoundaryCount(design.0);
        // One of count, width and values.
        let levels = |count, width, values: &[f64]| {
            let (values, nb) = (values.as_ptr(), values.len() as c_int);
            let code = shapeop_ruledSetLevels(design.0, count, width, values, nb, ptr::null());
            (code, message().split(':').next().unwrap_or_default().to_owned())
        };
        assert_eq!(levels(0, 0.0, &[]), (SO_INVALID_VALUE, "count".into()));
        assert_eq!(levels(3, 0.5, &[]), (SO_INVALID_VALUE, "count".into()));
        assert_eq!(levels(-3, 0.0, &[]).0, SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(levels(0, f64::NAN, &[]), (SO_INVALID_VALUE, "width".into()));
        assert_eq!(levels(0, 0.0, &[0.3, 0.2]), (SO_INVALID_VALUE, "values[1]".into()));
        assert_eq!(levels(0, 0.0, &[1e9]), (SO_OUT_OF_DOMAIN, "values[0]".into()));
        let (zero, far) = ([0.0; 3], [1.0, 0.0, 0.0, 99.0]);
        let planes = |plane: &[f64; 4]| {
            shapeop_ruledSetPlanarBoundaries(design.0, plane.as_ptr(), 1, 0.2, 0, ptr::null(), ptr::null_mut())
        };
        assert_eq!(planes(&far), SO_NO_INTERSECTION);
        assert_eq!(planes(&[0.0; 4]), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledSetGreatCircleBoundaries(design.0, zero.as_ptr(), 1, ptr::null()), SO_INVALID_VALUE);
        assert!(message().starts_with("axes[0]"), "{}", message());
        assert_eq!(shapeop_ruledSetGreatCircleBoundaries(design.0, ptr::null(), 1, ptr::null()), SO_NULL_POINTER);
        let drawn = [0.0; 9];
        let (counts, closed) = ([2, 3], [0, 2]);
        let draw = |nb, closed| {
            shapeop_ruledSetDrawnBoundaries(design.0, drawn.as_ptr(), 3, counts.as_ptr(), nb, closed, ptr::null())
        };
        assert_eq!(
            (draw(2, ptr::null()), draw(1, ptr::null())),
            (SO_INVALID_ARGUMENT_LENGTH, SO_INVALID_ARGUMENT_LENGTH)
        );
        assert_eq!(draw(2, closed.as_ptr()), SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(shapeop_ruledBoundaryCount(design.0), before);
        let seed = [f64::INFINITY, 0.0, 0.0];
        let end = ptr::null_mut();
        assert_eq!(
            shapeop_ruledTrace(design.0, seed.as_ptr(), 0, 0.5, 1.0, none, 0, &mut count, end),
            SO_INVALID_VALUE
        );
        assert_eq!(
            shapeop_ruledTrace(design.0, zero.as_ptr(), 0, 0.7, 1.0, none, 0, &mut count, end),
            SO_INVALID_VALUE
        );
        assert!(message().starts_with("step"), "{}", message());
        assert_eq!(
            shapeop_ruledTrace(design.0, zero.as_ptr(), 2, 0.5, 1.0, none, 0, &mut count, end),
            SO_INVALID_VALUE
        );
        assert_eq!(shapeop_ruledBoundary(design.0, 99, none, 0, &mut count, end, none), SO_INDEX_OUT_OF_RANGE);
        assert_eq!(shapeop_ruledBoundary(design.0, 0, none, 0, ptr::null_mut(), end, none), SO_NULL_POINTER);
        assert_eq!(shapeop_ruledStart(design.0, 3, 0), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledStart(design.0, c_int::MAX, 0), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledStart(design.0, 6, 0), SO_SUCCESS);
        assert_eq!(shapeop_ruledEvaluate(design.0, 0, 3.1, 0.0, none, none, none), SO_INVALID_VALUE);
        assert_eq!(shapeop_ruledEvaluate(design.0, 0, 0.0, f64::NAN, none, none, none), SO_INVALID_VALUE);
        let mut weights: shapeop_ruled_optimise_options = std::mem::zeroed();
        weights.struct_size = size_of::<shapeop_ruled_optimise_options>() as c_uint;
        assert_eq!(shapeop_ruledDefaultOptimiseOptions(&mut weights), SO_SUCCESS);
        let refused = |change: &dyn Fn(&mut shapeop_ruled_optimise_options)| {
            let mut changed = weights;
            change(&mut changed);
            assert_eq!(shapeop_ruledOptimise(design.0, &changed, None, nothing, ptr::null_mut()), SO_INVALID_VALUE);
            message().split(':').next().unwrap_or_default().to_owned()
        };
        assert_eq!(refused(&|weights| weights.proximity = -1.0), "options->proximity");
        assert_eq!(refused(&|weights| weights.largest_deviation = f64::NAN), "options->largest_deviation");
        assert_eq!(refused(&|weights| weights.samples_across = 1), "options->samples_across");
        assert_eq!(refused(&|weights| weights.samples_along = c_uint::MAX), "options->samples_along");
        assert_eq!(refused(&|weights| weights.tolerance = -1.0), "options->tolerance");
        // A strip that is no conoid has no planks.
        let (mut planks, mut options): (shapeop_ruled_planks, shapeop_ruled_plank_options) = std::mem::zeroed();
        planks.struct_size = size_of_val(&planks) as c_uint;
        options.struct_size = size_of_val(&options) as c_uint;
        assert_eq!(shapeop_ruledDefaultPlankOptions(&mut options), SO_SUCCESS);
        options.thickness = 0.1;
        let up = [0.0, 0.0, 1.0];
        assert_eq!(shapeop_ruledCutPlanks(design.0, 0, &options, up.as_ptr(), &mut planks), SO_NOT_PLANAR);
        assert_eq!(shapeop_ruledCutPlanks(design.0, 0, ptr::null(), up.as_ptr(), &mut planks), SO_NULL_POINTER);
    }
}
