//! The forces of a solver: adding, editing, removing.

use glam::DVec3;

use super::Solver;
use crate::error::Result;
use crate::problem::{Force, ForceId};

impl Solver {
    /// The number of force ids given out, removed ones included.
    pub fn force_count(&self) -> usize {
        self.forces.id_count()
    }

    /// True if `id` is a force that was not removed.
    pub fn is_force(&self, id: ForceId) -> bool {
        self.forces.contains(id)
    }

    /// Adds a force.
    ///
    /// # Errors
    /// It is not finite, a point is out of range, there is no face, or one of fewer than 3 corners.
    pub fn add_force(&mut self, force: Force) -> Result<ForceId> {
        self.forces.add(force, self.points.len())
    }

    /// Replaces a vertex force.
    ///
    /// # Errors
    /// `id` is no vertex force, the force is not finite, or the point is out of range.
    pub fn edit_vertex_force(&mut self, id: ForceId, force: DVec3, point: u32) -> Result<()> {
        self.forces.edit_vertex_force(id, force, point, self.points.len())
    }

    /// Replaces the magnitude of a force on faces: a pressure, or the length of a normal force.
    ///
    /// # Errors
    /// `id` is no force on faces, or the magnitude is not finite.
    pub fn edit_force_magnitude(&mut self, id: ForceId, magnitude: f64) -> Result<()> {
        self.forces.edit_magnitude(id, magnitude)
    }

    /// Removes a force; its id is never given out again.
    ///
    /// # Errors
    /// `id` is no force.
    pub fn remove_force(&mut self, id: ForceId) -> Result<()> {
        self.forces.remove(id)
    }
}
