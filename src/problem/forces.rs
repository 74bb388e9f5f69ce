//! Forces on points.

use glam::DVec3;

use super::{Faces, ForceKind, ForceSignature};
use crate::error::{Error, Result, Status, finite};

/// The number of a force: they count up from 0 and are never reused.
pub type ForceId = usize;

/// One force. In dynamic mode it acts as an acceleration.
#[derive(Clone, Debug, PartialEq)]
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
    /// Across faces: the pressure times the vector area of each, shared among its corners. It follows the points.
    Pressure {
        /// Force per area, along the normals; negative: against them.
        pressure: f64,
        /// The faces; a normal points to where the corners run counter-clockwise.
        faces: Faces,
    },
    /// On every corner of faces along its normal, which is that of the sum of the vector areas of the faces around it. It
    /// follows the points.
    Normal {
        /// The length of the force on each point; negative: against the normal.
        magnitude: f64,
        /// The faces.
        faces: Faces,
    },
}

impl Force {
    /// The force that a signature states.
    ///
    /// # Errors
    /// A field that its kind needs is absent, or one that its kind does not take is there; it is the place.
    pub fn from_signature(signature: &ForceSignature) -> Result<Self> {
        let ForceSignature { kind, force, id, magnitude, faces } = signature;
        let invalid = |name: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(name));
        let is_on_faces = matches!(kind, ForceKind::Pressure | ForceKind::Normal);
        let unwanted = |what: &str| format!("expected none for a force of kind \"{}\"{what}", kind.name());
        match id {
            Some(id) if *kind == ForceKind::Gravity => {
                return invalid("id", format!("expected none, as gravity acts on every point; found {id}"));
            }
            Some(id) if is_on_faces => return invalid("id", unwanted(&format!(", found {id}"))),
            _ => {}
        }
        if is_on_faces {
            if let Some(force) = force {
                return invalid("force", unwanted(&format!(", which has a magnitude; found {force:?}")));
            }
            let Some(magnitude) = *magnitude else {
                return invalid("magnitude", "expected a number, found none".to_owned());
            };
            let faces = faces.iter().collect();
            return Ok(match kind {
                ForceKind::Pressure => Self::Pressure { pressure: magnitude, faces },
                _ => Self::Normal { magnitude, faces },
            });
        }
        if let Some(magnitude) = magnitude {
            return invalid("magnitude", unwanted(&format!(", which has a force; found {magnitude}")));
        }
        if !faces.is_empty() {
            return invalid("faces", unwanted(&format!(", found {}", faces.len())));
        }
        let Some(force) = force.map(DVec3::from_array) else {
            return invalid("force", "expected its components [x, y, z], found none".to_owned());
        };
        match id {
            Some(point) => Ok(Self::Vertex { force, point: *point }),
            None if *kind == ForceKind::Vertex => {
                invalid("id", "expected the index of the point it acts on, found none".to_owned())
            }
            None => Ok(Self::Gravity(force)),
        }
    }

    fn check(&self, point_count: usize) -> Result<()> {
        match self {
            Self::Gravity(force) | Self::Vertex { force, .. } if !force.is_finite() => {
                let reason = format!("expected finite components, found {force}");
                Err(Error::new(Status::InvalidValue, reason).at("force"))
            }
            Self::Vertex { point, .. } if *point as usize >= point_count => {
                let reason = format!("{point} is out of range for {point_count} points");
                Err(Error::new(Status::IndexOutOfRange, reason).at("id"))
            }
            Self::Pressure { pressure: magnitude, faces } | Self::Normal { magnitude, faces } => {
                finite("magnitude", *magnitude)?;
                faces.check(point_count)
            }
            Self::Gravity(_) | Self::Vertex { .. } => Ok(()),
        }
    }

    fn is_on_faces(&self) -> bool {
        matches!(self, Self::Pressure { .. } | Self::Normal { .. })
    }

    /// What it is, in words.
    fn description(&self) -> &'static str {
        match self {
            Self::Gravity(_) => "gravity",
            Self::Vertex { .. } => "a vertex force",
            Self::Pressure { .. } => "a pressure",
            Self::Normal { .. } => "a normal force",
        }
    }
}

/// All forces of a model.
#[derive(Clone, Debug, Default)]
pub struct ForceSet {
    /// By id; `None` once removed.
    forces: Vec<Option<Force>>,
    /// The number of forces on faces, so that the others cost nothing in each iteration.
    on_faces_count: usize,
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
    /// It is not finite, a point is out of range, there is no face, or one of fewer than 3 corners.
    pub fn add(&mut self, force: Force, point_count: usize) -> Result<ForceId> {
        force.check(point_count)?;
        self.on_faces_count += usize::from(force.is_on_faces());
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
            other => {
                let reason = format!("force {id} is {}, not a vertex force", other.description());
                Err(Error::new(Status::UnmatchingForceId, reason).at("force id"))
            }
        }
    }

    /// Replaces the magnitude of a force on faces: a pressure, or the length of a normal force.
    ///
    /// # Errors
    /// `id` is no force on faces, or the new magnitude is not finite.
    pub fn edit_magnitude(&mut self, id: ForceId, new: f64) -> Result<()> {
        let description = self.slot(id)?.description();
        match &mut self.forces[id] {
            Some(Force::Pressure { pressure: magnitude, .. } | Force::Normal { magnitude, .. }) => {
                *magnitude = finite("magnitude", new)?;
                Ok(())
            }
            _ => {
                let reason = format!("force {id} is {description}, not a pressure or a normal force");
                Err(Error::new(Status::UnmatchingForceId, reason).at("force id"))
            }
        }
    }

    /// Removes a force; its id is never given out again.
    ///
    /// # Errors
    /// `id` is no force.
    pub fn remove(&mut self, id: ForceId) -> Result<()> {
        self.on_faces_count -= usize::from(self.slot(id)?.is_on_faces());
        self.forces[id] = None;
        Ok(())
    }

    /// True if there are forces on faces, which follow the points.
    pub(crate) fn has_forces_on_faces(&self) -> bool {
        self.on_faces_count > 0
    }

    /// Adds the forces on faces at `points` to the `sums`; `normals` is room for one entry per point.
    pub(crate) fn add_forces_on_faces(&self, points: &[DVec3], normals: &mut Vec<DVec3>, sums: &mut [DVec3]) {
        if !self.has_forces_on_faces() {
            return;
        }
        normals.clear();
        normals.resize(points.len(), DVec3::ZERO);
        for force in self.forces.iter().flatten() {
            match force {
                Force::Pressure { pressure, faces } => faces.add_pressure(*pressure, points, sums),
                Force::Normal { magnitude, faces } => faces.add_along_normals(*magnitude, points, normals, sums),
                Force::Gravity(_) | Force::Vertex { .. } => {}
            }
        }
    }

    /// What the pressures have done at `points`: the sum of pressure times volume.
    pub(crate) fn work_of_pressures(&self, points: &[DVec3]) -> f64 {
        if !self.has_forces_on_faces() {
            return 0.0;
        }
        let work = |force: &Force| match force {
            Force::Pressure { pressure, faces } => pressure * faces.volume(points),
            _ => 0.0,
        };
        self.forces.iter().flatten().map(work).sum()
    }

    /// Writes the sum of the forces on each point, those on faces left out, into `sums`, one entry per point. Returns false if
    /// all are zero.
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

    /// The first force on a point at or beyond `point_count`, with that point.
    pub(crate) fn first_beyond(&self, point_count: usize) -> Option<(ForceId, u32)> {
        let last_point = |force: &Force| match force {
            Force::Gravity(_) => None,
            Force::Vertex { point, .. } => Some(*point),
            Force::Pressure { faces, .. } | Force::Normal { faces, .. } => faces.last_point(),
        };
        self.forces.iter().enumerate().find_map(|(id, force)| {
            let point = last_point(force.as_ref()?)?;
            (point as usize >= point_count).then_some((id, point))
        })
    }

    fn slot(&self, id: ForceId) -> Result<&Force> {
        match self.forces.get(id) {
            Some(Some(force)) => Ok(force),
            Some(None) => Err(Error::new(Status::UnmatchingForceId, format!("force {id} was removed")).at("force id")),
            None => {
                let reason = format!("{id} is none of the {} ids given out", self.forces.len());
                Err(Error::new(Status::UnmatchingForceId, reason).at("force id"))
            }
        }
    }
}
