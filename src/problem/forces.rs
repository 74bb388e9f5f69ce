//! Forces on points.

use glam::DVec3;

use super::{ForceKind, ForceSignature};
use crate::error::{Error, Result, Status};

/// The number of a force: they count up from 0 and are never reused.
pub type ForceId = usize;

/// One force. In dynamic mode it acts as an acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    /// The same on every point.
    Gravity(DVec3),
    /// On one point.
    Vertex {
        /// Its components.
        force: DVec3,
        /// The point's index.
        point: u32,
    },
}

impl Force {
    /// The force that a signature states.
    ///
    /// # Errors
    /// A vertex force without `id`, or gravity with one.
    pub fn from_signature(signature: &ForceSignature) -> Result<Self> {
        let force = DVec3::from_array(signature.force);
        match (signature.kind, signature.id) {
            (ForceKind::Gravity, None) => Ok(Self::Gravity(force)),
            (ForceKind::Vertex, Some(point)) => Ok(Self::Vertex { force, point }),
            (ForceKind::Gravity, Some(id)) => {
                let reason = format!("expected none, as gravity acts on every point; found {id}");
                Err(Error::new(Status::InvalidValue, reason).at("id"))
            }
            (ForceKind::Vertex, None) => {
                Err(Error::new(Status::InvalidValue, "expected the index of the point it acts on, found none").at("id"))
            }
        }
    }

    fn check(self, point_count: usize) -> Result<()> {
        let (Self::Gravity(force) | Self::Vertex { force, .. }) = self;
        if !force.is_finite() {
            let reason = format!("expected finite components, found {force}");
            return Err(Error::new(Status::InvalidValue, reason).at("force"));
        }
        match self {
            Self::Vertex { point, .. } if point as usize >= point_count => {
                let reason = format!("{point} is out of range for {point_count} points");
                Err(Error::new(Status::IndexOutOfRange, reason).at("id"))
            }
            _ => Ok(()),
        }
    }
}

/// All forces of a model.
#[derive(Clone, Debug, Default)]
pub struct ForceSet {
    /// By id; `None` once removed.
    forces: Vec<Option<Force>>,
}

impl ForceSet {
    /// The number of ids given out, removed ones included.
    pub fn id_count(&self) -> usize {
        self.forces.len()
    }

    /// True if `id` is a force that was not removed.
    pub fn contains(&self, id: ForceId) -> bool {
        self.forces.get(id).is_some_and(Option::is_some)
    }

    /// Adds a force.
    ///
    /// # Errors
    /// It is not finite, or its point is out of range.
    pub fn add(&mut self, force: Force, point_count: usize) -> Result<ForceId> {
        force.check(point_count)?;
        self.forces.push(Some(force));
        Ok(self.forces.len() - 1)
    }

    /// Replaces a vertex force.
    ///
    /// # Errors
    /// `id` is no vertex force, the new force is not finite, or its point is out of range.
    pub fn edit_vertex_force(&mut self, id: ForceId, force: DVec3, point: u32, point_count: usize) -> Result<()> {
        let new = Force::Vertex { force, point };
        match self.slot(id)? {
            Force::Vertex { .. } => {
                new.check(point_count)?;
                self.forces[id] = Some(new);
                Ok(())
            }
            Force::Gravity(_) => {
                let reason = format!("force {id} is gravity, not a vertex force");
                Err(Error::new(Status::UnmatchingForceId, reason).at("force id"))
            }
        }
    }

    /// Removes a force; its id is never given out again.
    ///
    /// # Errors
    /// `id` is no force.
    pub fn remove(&mut self, id: ForceId) -> Result<()> {
        self.slot(id)?;
        self.forces[id] = None;
        Ok(())
    }

    /// Writes the sum of the forces on each point into `sums`, one entry per point. Returns false if all are zero.
    pub(crate) fn sum_into(&self, sums: &mut [DVec3]) -> bool {
        let forces = || self.forces.iter().flatten();
        let gravity: DVec3 = forces().map(|force| if let Force::Gravity(g) = force { *g } else { DVec3::ZERO }).sum();
        sums.fill(gravity);
        for force in forces() {
            if let Force::Vertex { force, point } = force {
                sums[*point as usize] += *force;
            }
        }
        sums.iter().any(|sum| *sum != DVec3::ZERO)
    }

    /// The first vertex force on a point at or beyond `point_count`, with that point.
    pub(crate) fn first_beyond(&self, point_count: usize) -> Option<(ForceId, u32)> {
        self.forces.iter().enumerate().find_map(|(id, force)| match force {
            Some(Force::Vertex { point, .. }) if *point as usize >= point_count => Some((id, *point)),
            _ => None,
        })
    }

    fn slot(&self, id: ForceId) -> Result<Force> {
        match self.forces.get(id) {
            Some(Some(force)) => Ok(*force),
            Some(None) => Err(Error::new(Status::UnmatchingForceId, format!("force {id} was removed")).at("force id")),
            None => {
                let reason = format!("{id} is none of the {} ids given out", self.forces.len());
                Err(Error::new(Status::UnmatchingForceId, reason).at("force id"))
            }
        }
    }
}
