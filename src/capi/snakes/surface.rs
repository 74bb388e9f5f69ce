//! The surface that a snake moves on.

use std::ffi::c_int;

use super::super::problem::mesh;
use super::super::{code, shapeop_err};
use super::guard;
use super::io::{self, placed};
use super::snake::ShapeOpSnake;
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::draft::{NamedSurface, Surface, SurfaceKind};
use crate::mesh::TriangleMesh;

/// A surface that a few numbers tell. Normals point outward, that of a plane as given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_surface {
    /// A point and the normal: 6 numbers.
    SO_SNAKE_SURFACE_PLANE = 0,
    /// The centre and the radius: 4 numbers.
    SO_SNAKE_SURFACE_SPHERE = 1,
    /// A point of the axis, its direction, the radius: 7 numbers.
    SO_SNAKE_SURFACE_CYLINDER = 2,
    /// The centre, the direction of the axis, the distance of the tube's middle from it, the radius of the tube: 8
    /// numbers.
    SO_SNAKE_SURFACE_TORUS = 3,
}

/// The surface of a kind with these numbers.
///
/// # Safety
/// `numbers` is null or readable for `nb_numbers` doubles.
pub(super) unsafe fn named(kind: c_int, numbers: *const f64, nb_numbers: c_int) -> Result<Surface> {
    let of = match kind {
        k if k == shapeop_snake_surface::SO_SNAKE_SURFACE_PLANE as c_int => SurfaceKind::Plane,
        k if k == shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE as c_int => SurfaceKind::Sphere,
        k if k == shapeop_snake_surface::SO_SNAKE_SURFACE_CYLINDER as c_int => SurfaceKind::Cylinder,
        k if k == shapeop_snake_surface::SO_SNAKE_SURFACE_TORUS as c_int => SurfaceKind::Torus,
        _ => {
            let reason = format!("expected a shapeop_snake_surface, 0 to 3, found {kind}");
            return Err(Error::new(Status::InvalidValue, reason).at("kind"));
        }
    };
    // SAFETY: the caller vouches for the array.
    let numbers = unsafe { io::numbers("numbers", numbers, "nb_numbers", nb_numbers)? };
    let refused = |error: Error| {
        let is_count = error.place() == "numbers";
        if is_count { error.with_place("nb_numbers") } else { error }
    };
    Ok(Surface::Named(NamedSurface::new(of, &numbers).map_err(refused)?))
}

/// The surface of a mesh.
///
/// # Safety
/// Each array is null or readable for its number of values.
pub(super) unsafe fn meshed(
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
) -> Result<Surface> {
    // SAFETY: the caller vouches for the arrays.
    let mesh = unsafe { mesh(points, nb_points, face_indices, nb_face_indices, counts, nb_counts)? };
    Ok(Surface::Mesh(TriangleMesh::new(&mesh).map_err(|error| placed(error, &[("mesh", "points")]))?))
}

/// Takes a mesh as the surface of a snake. The snake stays where it is.
///
/// - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points, all of which faces use.
/// - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all; quads are split along
///   their shorter diagonal, larger faces into a fan.
/// - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
///
/// # Safety
/// Each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetMesh(
    snake: *mut ShapeOpSnake,
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the arrays.
        let surface = unsafe { meshed(points, nb_points, face_indices, nb_face_indices, counts, nb_counts)? };
        draft.set_surface(Some(surface));
        Ok(())
    }))
}

/// Takes a surface of a kind (a `shapeop_snake_surface`) that `nb_numbers` numbers tell as that of a snake.
///
/// # Safety
/// `numbers` is null or readable for `nb_numbers` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetSurface(
    snake: *mut ShapeOpSnake,
    kind: c_int,
    numbers: *const f64,
    nb_numbers: c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array.
        draft.set_surface(Some(unsafe { named(kind, numbers, nb_numbers)? }));
        Ok(())
    }))
}

/// Takes the surface of a snake away.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeClearSurface(snake: *mut ShapeOpSnake) -> shapeop_err {
    code(guard(snake, |draft| {
        draft.set_surface(None);
        Ok(())
    }))
}
