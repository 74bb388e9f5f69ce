//! The C functions of super-canal surfaces: what they answer, and what they refuse without a change.

mod abi;

use std::ffi::{CString, c_int, c_void};
use std::ptr;

use abi::{Abi, last_error, text};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

const PROFILE: [f64; 12] = [2.7, 0.0, 0.0, 2.5, 0.0, 0.5, 2.0, 0.0, 0.7, 1.5, 0.0, 0.5];

/// A surface's handle; deleted when dropped.
struct Surface(*mut ShapeOpCanal);

impl Drop for Surface {
    fn drop(&mut self) {
        shapeop_canalDelete(self.0);
    }
}

fn message() -> String {
    last_error(ptr::null_mut())
}

fn revolution(columns: c_int) -> *mut ShapeOpCanal {
    let (point, axis) = ([0.0; 3], [0.0, 0.0, 1.0]);
    // SAFETY: live arrays of the stated lengths.
    unsafe { shapeop_canalRevolution(PROFILE.as_ptr(), 4, point.as_ptr(), axis.as_ptr(), 1.5, columns) }
}

fn torus() -> Surface {
    let surface = revolution(5);
    assert!(!surface.is_null(), "{}", message());
    Surface(surface)
}

fn points(surface: &Surface) -> Vec<f64> {
    let mut count = -7;
    // SAFETY: an output for the count; then an array of that many points.
    unsafe {
        assert_eq!(shapeop_canalPoints(surface.0, ptr::null_mut(), 0, &mut count), SO_SUCCESS);
        let mut points = vec![f64::NAN; 3 * count as usize];
        assert_eq!(shapeop_canalPoints(surface.0, points.as_mut_ptr(), count, &mut count), SO_SUCCESS);
        points
    }
}

#[test]
fn a_size_query_tells_the_count_and_writes_nothing_else() {
    let surface = torus();
    let (mut count, mut room) = (0, [7.0; 60]);
    // SAFETY: arrays as long as it says.
    unsafe {
        assert_eq!(shapeop_canalPoints(surface.0, room.as_mut_ptr(), 19, &mut count), SO_SUCCESS);
        assert_eq!((count, room), (20, [7.0; 60]));
        assert_eq!(shapeop_canalPoints(surface.0, ptr::null_mut(), 20, &mut count), SO_NULL_POINTER);
        assert_eq!(shapeop_canalPoints(surface.0, room.as_mut_ptr(), -1, &mut count), SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(shapeop_canalPoints(surface.0, room.as_mut_ptr(), 20, ptr::null_mut()), SO_NULL_POINTER);
        assert_eq!((count, room), (20, [7.0; 60]));
    }
    let (mut rows, mut columns, mut wraps) = (0, 0, 9);
    // SAFETY: one int each.
    assert_eq!(unsafe { shapeop_canalSize(surface.0, &mut rows, &mut columns, &mut wraps) }, SO_SUCCESS);
    assert_eq!((rows, columns, wraps), (4, 5, 0));
    for (i, point) in points(&surface).chunks(3).enumerate() {
        let (radius, angle) = (PROFILE[3 * (i / 5)], 1.5 * (i % 5) as f64 / 4.0);
        assert!((point[0] - radius * angle.cos()).abs() + (point[1] - radius * angle.sin()).abs() < 1e-12);
    }
}

#[test]
fn handles_of_another_kind_and_stale_ones_are_refused() {
    let solver = Abi::with_points(&[0.0; 9]);
    let surface = torus();
    assert_eq!(shapeop_canalKind(solver.0.cast()), -1);
    assert!(message().contains("expected a surface's handle"), "{}", message());
    assert_eq!(shapeop_canalScale(ptr::null_mut(), 2.0), SO_INVALID_HANDLE);
    assert_eq!(shapeop_pointCount(surface.0.cast()), -1);
    assert!(message().starts_with("op: expected a solver's handle"), "{}", message());
    // Neither deletes the other.
    shapeop_delete(surface.0.cast());
    shapeop_canalDelete(solver.0.cast());
    assert_eq!((shapeop_canalKind(surface.0), shapeop_pointCount(solver.0)), (1, 3));
    let stale = Surface(shapeop_canalCopy(surface.0));
    shapeop_canalDelete(stale.0);
    assert_eq!(shapeop_canalScale(stale.0, 2.0), SO_INVALID_HANDLE);
    assert!(shapeop_canalText(stale.0).is_null());
}

#[test]
fn a_chain_is_made_undone_and_read_again_from_its_text() {
    let surface = torus();
    let base = points(&surface);
    let (center, column, row) = ([0.0, 0.0, 3.0], [1.2, 0.9, 1.0], [1.0, 1.4, 0.8, 1.0]);
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        assert_eq!(shapeop_canalCombescureFactors(surface.0, column.as_ptr(), 3, row.as_ptr(), 4), SO_SUCCESS);
        assert_eq!(shapeop_canalInvert(surface.0, center.as_ptr(), 4.0), SO_SUCCESS);
    }
    assert_eq!((shapeop_canalChainCount(surface.0), text(shapeop_canalFamily(surface.0))), (2, "M-moulding".into()));
    let json = CString::new(text(shapeop_canalText(surface.0))).unwrap();
    // SAFETY: a live text.
    let again = Surface(unsafe { shapeop_canalFromJson(json.as_ptr()) });
    assert_eq!(points(&again), points(&surface));
    assert_eq!((shapeop_canalUndo(again.0), shapeop_canalUndo(again.0), shapeop_canalUndo(again.0)), (1, 1, 0));
    assert_eq!(points(&again), base);
    let (quads, count) = quads();
    let (mut planarity, mut concyclicity) = ([9.0; 12], [9.0; 12]);
    let image = points(&surface);
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        let (out, none) = (planarity.as_mut_ptr(), ptr::null_mut());
        let code =
            shapeop_canalCheckCircular(image.as_ptr(), 20, quads.as_ptr(), count, out, concyclicity.as_mut_ptr(), none);
        assert_eq!(code, SO_SUCCESS);
    }
    assert!(planarity.iter().chain(&concyclicity).all(|residual| *residual < 1e-10));
}

fn quads() -> (Vec<c_int>, c_int) {
    let corner = |i: c_int, j: c_int| 5 * i + j;
    let all = (0..3)
        .flat_map(|i| (0..4).map(move |j| [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]));
    let all: Vec<c_int> = all.flatten().collect();
    let count = all.len() as c_int / 4;
    (all, count)
}

#[test]
fn refused_calls_change_nothing_and_write_nothing() {
    let surface = torus();
    let before = points(&surface);
    let (nan, origin) = ([f64::NAN, 0.0, 0.0], [0.0; 3]);
    let point_of_it = [before[0], before[1], before[2]];
    // SAFETY: live arrays of the stated lengths, or null.
    unsafe {
        assert_eq!(shapeop_canalInvert(surface.0, ptr::null(), 1.0), SO_NULL_POINTER);
        assert_eq!(shapeop_canalInvert(surface.0, nan.as_ptr(), 1.0), SO_INVALID_VALUE);
        assert_eq!(shapeop_canalInvert(surface.0, origin.as_ptr(), 0.0), SO_INVALID_VALUE);
        assert_eq!(shapeop_canalInvert(surface.0, point_of_it.as_ptr(), 1.0), SO_DEGENERATE);
        assert_eq!(shapeop_canalRotate(surface.0, origin.as_ptr(), 1.0), SO_INVALID_VALUE);
        assert_eq!(shapeop_canalTranslate(surface.0, nan.as_ptr()), SO_INVALID_VALUE);
        let code = shapeop_canalCombescureFactors(surface.0, origin.as_ptr(), 3, origin.as_ptr(), 3);
        assert_ne!(code, SO_SUCCESS);
        let mut out = [5.0; 9];
        let place = out.as_mut_ptr();
        assert_eq!(shapeop_canalEvaluate(surface.0, 3, 0, 0.5, 0.5, place, ptr::null_mut()), SO_INDEX_OUT_OF_RANGE);
        assert_eq!(shapeop_canalEvaluate(surface.0, 0, 0, 0.5, f64::NAN, place, ptr::null_mut()), SO_INVALID_VALUE);
        assert_eq!(shapeop_canalInvertPoints(nan.as_ptr(), 1, origin.as_ptr(), 1.0, place), SO_INVALID_VALUE);
        assert_eq!(shapeop_canalInvertPoints(origin.as_ptr(), 1, origin.as_ptr(), 1.0, place), SO_DEGENERATE);
        assert_eq!(shapeop_canalFrameOfAngles(f64::INFINITY, 0.0, 0.0, place), SO_INVALID_VALUE);
        assert_eq!(out, [5.0; 9]);
        let frame = [1.0, 0.0, 0.0, 0.5, 1.0, 0.0];
        assert!(shapeop_canalCreate(before.as_ptr(), 4, 5, 0, frame.as_ptr(), 3).is_null());
        assert!(message().starts_with("frame"), "{}", message());
        assert!(shapeop_canalCreate(before.as_ptr(), 4, 5, 9, frame.as_ptr(), 3).is_null());
        assert!(message().starts_with("wraps"), "{}", message());
        assert!(shapeop_canalCreate(before.as_ptr(), c_int::MAX, c_int::MAX, 0, frame.as_ptr(), 3).is_null());
        assert!(shapeop_canalFromJson(c"{}".as_ptr()).is_null());
        assert!(shapeop_canalFromJson(ptr::null()).is_null());
    }
    assert_eq!(shapeop_canalScale(surface.0, 0.0), SO_INVALID_VALUE);
    assert_eq!(shapeop_canalScale(surface.0, f64::NAN), SO_INVALID_VALUE);
    assert!(shapeop_canalRefined(surface.0, 0, 2).is_null());
    assert!(shapeop_canalRefined(surface.0, c_int::MAX, c_int::MAX).is_null());
    assert!(message().contains("at most"), "{}", message());
    assert!(revolution(c_int::MAX).is_null() && revolution(-1).is_null());
    assert_eq!((points(&surface), shapeop_canalChainCount(surface.0)), (before, 0));
}

#[test]
fn a_strip_of_lengths_is_made_or_the_quad_is_named() {
    let guide: Vec<f64> =
        (0..8).flat_map(|k| [3.0 * (0.2 * f64::from(k)).cos(), 3.0 * (0.2 * f64::from(k)).sin(), 0.0]).collect();
    let start = [4.0, 0.0, 0.0];
    let (mut border, mut flipped) = ([7.0; 24], [7; 7]);
    let strip = |lengths: &[f64; 8], border: &mut [f64; 24], flipped: &mut [c_int; 7]| {
        let none = ptr::null_mut();
        // SAFETY: live arrays of the stated lengths.
        unsafe {
            let (at, flags) = (border.as_mut_ptr(), flipped.as_mut_ptr());
            shapeop_canalStrip(
                guide.as_ptr(),
                8,
                start.as_ptr(),
                lengths.as_ptr(),
                0,
                at,
                none,
                none,
                flags,
                ptr::null_mut(),
                none,
            )
        }
    };
    let mut lengths = [1.0; 8];
    lengths[4] = 1e6;
    assert_eq!(strip(&lengths, &mut border, &mut flipped), SO_NO_INTERSECTION);
    assert!(message().starts_with("lengths[4]"), "{}", message());
    assert_eq!((border, flipped), ([7.0; 24], [7; 7]));
    assert_eq!(strip(&[1.0; 8], &mut border, &mut flipped), SO_SUCCESS);
    assert!(border.chunks(3).all(|q| (q[0].hypot(q[1]) - 4.0).abs() < 1e-9) && flipped == [0; 7]);
}

extern "C" fn stop(_: *const shapeop_canal_progress, user: *mut c_void) -> c_int {
    // SAFETY: the test passes a count.
    unsafe { *user.cast::<c_int>() += 1 };
    1
}

#[test]
fn a_callback_ends_a_call_with_its_best() {
    let surface = torus();
    let grid = points(&surface);
    let (mut axes, mut cancelled, mut calls) = ([0.0; 60], 7, 0);
    let user = (&raw mut calls).cast();
    // SAFETY: live arrays of the stated lengths.
    let code = unsafe {
        let out = axes.as_mut_ptr();
        shapeop_canalNodeAxesOfLeastGaps(grid.as_ptr(), 4, 5, 0, Some(stop), user, out, ptr::null_mut(), &mut cancelled)
    };
    assert_eq!((code, cancelled, calls), (SO_SUCCESS, 1, 1));
    assert!(axes.chunks(3).all(|axis| (axis.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-12));
}

#[test]
fn kinks_turn_frames_and_are_told_again() {
    // Unit squares in the plane: along a crease of column 1 the tangents t2 lean by the angle, and back at column 2.
    let points: Vec<f64> = (0..9).flat_map(|k| [f64::from(k / 3), f64::from(k % 3), 0.0]).collect();
    let frame = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let kind = shapeop_canal_kind::SO_CANAL_KIND_CIRCULAR as c_int;
    let create = |direction: c_int, lines: &[c_int], angles: &[f64]| {
        let (points, frame, nb_kinks) = (points.as_ptr(), frame.as_ptr(), lines.len() as c_int);
        // SAFETY: live arrays of the stated lengths.
        unsafe {
            let (lines, angles) = (lines.as_ptr(), angles.as_ptr());
            shapeop_canalCreateWithKinks(points, 3, 3, 0, frame, kind, direction, lines, angles, nb_kinks)
        }
    };
    let surface = Surface(create(2, &[1], &[0.3]));
    assert!(!surface.0.is_null(), "{}", message());
    let (mut frames, mut count) = ([0.0; 81], 0);
    let (mut direction, mut line, mut angle) = (0, 0, 0.0);
    // SAFETY: outputs for so many values.
    unsafe {
        assert_eq!(shapeop_canalFrames(surface.0, frames.as_mut_ptr(), 9, &mut count), SO_SUCCESS);
        let kinks = shapeop_canalKinks(surface.0, &mut direction, &mut line, &mut angle, 1, &mut count);
        assert_eq!((kinks, direction, line, angle, count), (SO_SUCCESS, 2, 1, 0.3, 1));
        // Without room only the number; no kinks of a surface without.
        let [null, nothing] = [ptr::null_mut(), ptr::null_mut()];
        assert_eq!(shapeop_canalKinks(surface.0, null, nothing, ptr::null_mut(), 0, &mut count), SO_SUCCESS);
        assert_eq!(count, 1);
        assert_eq!(shapeop_canalKinks(torus().0, &mut direction, &mut line, &mut angle, 1, &mut count), SO_SUCCESS);
        assert_eq!((direction, line, angle, count), (0, 1, 0.3, 0));
        assert_eq!(
            shapeop_canalKinks(surface.0, null, nothing, ptr::null_mut(), -1, &mut count),
            SO_INVALID_ARGUMENT_LENGTH
        );
    }
    for (k, frame) in frames.chunks_exact(9).enumerate() {
        let lean = [0.0, 0.3, -0.3][k % 3];
        let expected = [1.0, 0.0, 0.0, 0.0, f64::cos(lean), f64::sin(lean), 0.0, -f64::sin(lean), f64::cos(lean)];
        assert!(frame.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{k}: {frame:?}");
    }
    for (direction, line, angle, place) in [
        (3, 1, 0.3, "direction"),
        (2, 0, 0.3, "lines[0]"),
        (1, 3, 0.3, "lines[0]"),
        (1, -1, 0.3, "lines[0]"),
        (1, 1, f64::NAN, "angles[0]"),
    ] {
        assert!(create(direction, &[line], &[angle]).is_null());
        assert!(message().contains(place), "{}", message());
    }
}

#[test]
fn a_large_mesh_follows_a_handle_parallel_to_itself() {
    // Parallel to squares are all meshes of rectangles. Pulled by a corner with the weight 1 only its column moves,
    // whose 33 points stay with a millionth of that each: the least of (d - 3.2)^2 + 33e-6 d^2.
    let count = 33;
    let points: Vec<f64> = (0..count * count).flat_map(|k| [f64::from(k % count), f64::from(k / count), 0.0]).collect();
    let quads: Vec<c_int> = (0..count * (count - 1))
        .filter(|k| (k + 1) % count != 0)
        .flat_map(|k| [k, k + 1, k + 1 + count, k + count])
        .collect();
    let (handle, target) = (count * count - 1, [f64::from(count - 1) + 3.2, f64::from(count - 1), 0.0]);
    let mut out = vec![0.0; points.len()];
    // SAFETY: live arrays of the stated lengths.
    let answer = unsafe {
        let (nb_points, nb_quads) = (count * count, quads.len() as c_int / 4);
        let (points, quads, out) = (points.as_ptr(), quads.as_ptr(), out.as_mut_ptr());
        shapeop_canalNearestParallel(points, nb_points, quads, nb_quads, &handle, target.as_ptr(), 1, out)
    };
    assert_eq!(answer, SO_SUCCESS, "{}", message());
    for (k, (found, point)) in out.chunks_exact(3).zip(points.chunks_exact(3)).enumerate() {
        let moved = if k % 33 == 32 { 3.2 / (1.0 + 33e-6) } else { 0.0 };
        let expected = [point[0] + moved, point[1], 0.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{k}: {found:?} {expected:?}");
    }
}
