//! The C functions as a Rust test calls them: slices for pointers and counts, texts for C strings.

#![allow(dead_code, reason = "no test uses all of it")]

use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr;

use shapeop::capi::*;

/// A solver's handle; deleted when dropped.
#[derive(Debug)]
pub struct Abi(pub *mut ShapeOpSolver);

// SAFETY: a handle is a number.
unsafe impl Send for Abi {}
// SAFETY: a handle is a number.
unsafe impl Sync for Abi {}

impl Drop for Abi {
    fn drop(&mut self) {
        shapeop_delete(self.0);
    }
}

/// A copy of a text of the library.
pub fn text(text: *const c_char) -> String {
    assert!(!text.is_null());
    // SAFETY: the library's texts end with a zero and are valid until this thread's next call.
    unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
}

/// The message for a handle.
pub fn last_error(op: *mut ShapeOpSolver) -> String {
    text(shapeop_lastError(op))
}

fn count<T>(values: &[T]) -> c_int {
    values.len() as c_int
}

impl Abi {
    pub fn new() -> Self {
        let op = shapeop_create();
        assert!(!op.is_null());
        Self(op)
    }

    pub fn with_points(points: &[f64]) -> Self {
        let abi = Self::new();
        abi.set_points(points);
        assert_eq!(abi.message(), "");
        abi
    }

    pub fn message(&self) -> String {
        last_error(self.0)
    }

    pub fn set_points(&self, points: &[f64]) {
        // SAFETY: a live slice, only read.
        unsafe { shapeop_setPoints(self.0, points.as_ptr().cast_mut(), (points.len() / 3) as c_int) };
    }

    /// The coordinates; empty if the call was refused.
    pub fn points(&self) -> Vec<f64> {
        let point_count = shapeop_pointCount(self.0).max(0);
        let mut points = vec![f64::NAN; 3 * point_count as usize];
        // SAFETY: as long as it says.
        unsafe { shapeop_getPoints(self.0, points.as_mut_ptr(), point_count) };
        points
    }

    pub fn add(&self, type_name: &str, ids: &[c_int], weight: f64) -> c_int {
        let name = CString::new(type_name).unwrap();
        // SAFETY: live values of the stated lengths, only read.
        unsafe { shapeop_addConstraint(self.0, name.as_ptr(), ids.as_ptr().cast_mut(), count(ids), weight) }
    }

    pub fn edit(&self, type_name: &str, id: c_int, scalars: &[f64]) -> shapeop_err {
        let name = CString::new(type_name).unwrap();
        // SAFETY: live values of the stated lengths, only read.
        unsafe { shapeop_editConstraint(self.0, name.as_ptr(), id, scalars.as_ptr(), count(scalars)) }
    }

    /// Adds one set of constraints; returns the code and the ids.
    pub fn add_many(&self, new: &Many<'_>) -> (shapeop_err, Vec<c_int>) {
        let name = CString::new(new.type_name).unwrap();
        let constraint_count = match new.counts {
            [each] if *each > 0 => new.ids.len() / *each as usize,
            counts => counts.len(),
        };
        let mut ids = vec![-7; constraint_count];
        // SAFETY: live values of the stated lengths; `ids` has one entry per constraint.
        let code = unsafe {
            shapeop_addConstraints(
                self.0,
                name.as_ptr(),
                new.ids.as_ptr(),
                count(new.ids),
                new.counts.as_ptr(),
                count(new.counts),
                new.weights.as_ptr(),
                count(new.weights),
                new.scalars.as_ptr(),
                count(new.scalars),
                new.scalar_sets,
                new.flags,
                ids.as_mut_ptr(),
            )
        };
        (code, ids)
    }

    pub fn gravity(&self, mut force: [f64; 3]) -> c_int {
        // SAFETY: 3 doubles.
        unsafe { shapeop_addGravityForce(self.0, force.as_mut_ptr()) }
    }

    pub fn vertex_force(&self, mut force: [f64; 3], point: c_int) -> c_int {
        // SAFETY: 3 doubles.
        unsafe { shapeop_addVertexForce(self.0, force.as_mut_ptr(), point) }
    }

    pub fn edit_vertex_force(&self, id: c_int, mut force: [f64; 3], point: c_int) {
        // SAFETY: 3 doubles.
        unsafe { shapeop_editVertexForce(self.0, id, force.as_mut_ptr(), point) };
    }

    pub fn polyline(&self, points: &[f64], is_closed: c_int) -> c_int {
        // SAFETY: a live slice.
        unsafe { shapeop_addReferencePolyline(self.0, points.as_ptr(), count(points) / 3, is_closed) }
    }

    pub fn mesh(&self, points: &[f64], triangles: &[c_int]) -> c_int {
        let (points_data, triangles_data) = (points.as_ptr(), triangles.as_ptr());
        // SAFETY: live slices.
        unsafe {
            shapeop_addReferenceMesh(self.0, points_data, count(points) / 3, triangles_data, count(triangles) / 3)
        }
    }

    /// A polyline and a mesh, so that constraints of any type can be added.
    pub fn any_references(&self) {
        let points = [0.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 2.0, 1.0];
        assert_eq!((self.polyline(&points, 1), self.mesh(&points, &[0, 1, 2])), (0, 1));
    }

    /// A pressure on faces of the given numbers of corners.
    pub fn pressure(&self, indices: &[c_int], counts: &[c_int], pressure: f64) -> c_int {
        let (data, counts_data) = (indices.as_ptr(), counts.as_ptr());
        // SAFETY: live slices.
        unsafe { shapeop_addPressure(self.0, data, count(indices), counts_data, count(counts), pressure) }
    }

    /// A force along the normals of faces of the given numbers of corners.
    pub fn normal_force(&self, indices: &[c_int], counts: &[c_int], magnitude: f64) -> c_int {
        let (data, counts_data) = (indices.as_ptr(), counts.as_ptr());
        // SAFETY: live slices.
        unsafe { shapeop_addNormalForce(self.0, data, count(indices), counts_data, count(counts), magnitude) }
    }

    pub fn init(&self) -> c_int {
        shapeop_init(self.0)
    }

    pub fn solve(&self, iterations: u32) -> c_int {
        shapeop_solve(self.0, iterations)
    }

    /// Solves with the default options and the given limit.
    pub fn solve_until(&self, max_iterations: u32) -> (shapeop_err, shapeop_solve_report) {
        let (options, mut report) = (shapeop_solve_options { max_iterations, ..options() }, report());
        // SAFETY: both carry their size.
        let code = unsafe { shapeop_solveUntil(self.0, &options, None, ptr::null_mut(), &mut report) };
        (code, report)
    }

    pub fn energy(&self) -> (shapeop_err, f64) {
        let mut energy = f64::NAN;
        // SAFETY: one double.
        (unsafe { shapeop_energy(self.0, &mut energy) }, energy)
    }

    pub fn violations(&self, length: usize) -> (shapeop_err, Vec<f64>) {
        let mut violations = vec![f64::NAN; length];
        // SAFETY: as long as it says.
        (unsafe { shapeop_getViolations(self.0, violations.as_mut_ptr(), length as c_int) }, violations)
    }
}

/// What `shapeop_addConstraints` takes.
#[derive(Debug)]
pub struct Many<'a> {
    pub type_name: &'a str,
    pub ids: &'a [c_int],
    pub counts: &'a [c_int],
    pub weights: &'a [f64],
    pub scalars: &'a [f64],
    pub scalar_sets: c_int,
    pub flags: u32,
}

impl Default for Many<'_> {
    fn default() -> Self {
        Self { type_name: "Plane", ids: &[], counts: &[], weights: &[1.0], scalars: &[], scalar_sets: 0, flags: 0 }
    }
}

/// The default options.
pub fn options() -> shapeop_solve_options {
    let mut options = shapeop_solve_options {
        struct_size: size_of::<shapeop_solve_options>() as u32,
        max_iterations: 0,
        tolerance: 0.0,
        time_budget_seconds: 0.0,
    };
    // SAFETY: it carries its size.
    assert_eq!(unsafe { shapeop_defaultSolveOptions(&mut options) }, shapeop_err::SO_SUCCESS);
    options
}

/// An empty report.
pub fn report() -> shapeop_solve_report {
    shapeop_solve_report {
        struct_size: size_of::<shapeop_solve_report>() as u32,
        outcome: shapeop_outcome::SO_OUTCOME_CONVERGED,
        iterations: 0,
        unconstrained_count: 0,
        energy_before: -1.0,
        energy_after: -1.0,
        largest_move: -1.0,
        analysis_seconds: -1.0,
        factorisation_seconds: -1.0,
        local_seconds: -1.0,
        global_seconds: -1.0,
        evaluations: u32::MAX,
        rejected_energy_rose: u32::MAX,
        rejected_not_finite: u32::MAX,
        rejected_ill_conditioned: u32::MAX,
        rejected_not_descent: u32::MAX,
        rejected_line_search: u32::MAX,
        ordering_count: u32::MAX,
        factorisation_count: u32::MAX,
        linear_solver: shapeop_linear_solver::SO_LINEAR_SOLVER_AUTOMATIC,
        linear_iterations: u32::MAX,
        backend: shapeop_backend::SO_BACKEND_AUTOMATIC,
        gpu_iterations: u32::MAX,
        read_back_iteration: u32::MAX,
        reserved: u32::MAX,
        gpu_seconds: -1.0,
        transfer_seconds: -1.0,
    }
}

/// A unit square whose corners are 0.1 above and below its plane in turn.
pub const WARPED: [f64; 12] = [0.0, 0.0, 0.1, 1.0, 0.0, -0.1, 1.0, 1.0, 0.1, 0.0, 1.0, -0.1];

/// [`WARPED`] with a plane and a closeness of weight ¼ per corner.
pub fn warped() -> Abi {
    let abi = Abi::with_points(&WARPED);
    assert_eq!(abi.add("Plane", &[0, 1, 2, 3], 1.0), 0);
    for i in 0..4 {
        assert_eq!(abi.add("Closeness", &[i], 0.25), i + 1);
    }
    abi
}
