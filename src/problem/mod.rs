//! A problem as plain data: points, constraint signatures, forces and settings, with a JSON form.
//!
//! A [`Problem`] can be saved, sent, replayed and compared; a `Solver` is made from it. The rest state of every
//! constraint is taken from `points`. Validation names the place that errs:
//! `constraints[17].indices[2]: 5000 is out of range for 4096 points`.

mod faces;
mod forces;
pub(crate) mod json;
mod objective;
pub mod recipes;
mod references;

pub use faces::Faces;
pub use forces::{Force, ForceId, ForceSet};
pub use objective::{Fairness, FairnessRows, Handle, Objective};
pub use references::Reference;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::constraints::{ConstraintId, ConstraintSet, NewConstraints};
use crate::error::{Error, Result, Status, finite};
use crate::mesh::{Mesh, Topology, polylines};

/// The version of the JSON form that this library writes and reads.
pub const VERSION: u32 = 1;

/// Iterations that acceleration remembers at most: far more than any problem gained from. Each costs two vectors.
pub const MOST_MEMORY: u32 = 64;

/// Whether the points keep their momentum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// Optimise for an equilibrium.
    #[default]
    Static,
    /// Simulate with implicit Euler steps.
    Dynamic,
}

/// One constraint as the user states it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Signature {
    /// The name of its type, such as `Plane`.
    #[serde(rename = "type")]
    pub type_name: String,
    /// Indices into the points; their number and meaning depend on the type.
    pub indices: Vec<u32>,
    /// How much it counts against the others; at least 0.
    #[serde(default = "one")]
    pub weight: f64,
    /// Its scalars, as its type states them; absent or null: the defaults.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scalars: Option<Vec<f64>>,
    /// True if it must be met exactly (static mode); its weight is then its priority where not everything can be.
    #[serde(default, skip_serializing_if = "is_false")]
    pub hard: bool,
}

/// What a force acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ForceKind {
    /// Every point.
    Gravity,
    /// The point `id`.
    Vertex,
    /// The `faces`: `magnitude` is a pressure, a force per area along their normals. It follows the points.
    Pressure,
    /// The corners of the `faces`: a force of length `magnitude` along the normal of each. It follows the points.
    Normal,
}

impl ForceKind {
    fn name(self) -> &'static str {
        match self {
            Self::Gravity => "gravity",
            Self::Vertex => "vertex",
            Self::Pressure => "pressure",
            Self::Normal => "normal",
        }
    }
}

/// One force as the user states it; in dynamic mode it acts as an acceleration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ForceSignature {
    /// What it acts on.
    pub kind: ForceKind,
    /// The components of gravity or a vertex force; absent for the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<[f64; 3]>,
    /// The point that a vertex force acts on; absent for the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
    /// A pressure, or the length of a normal force; negative: against the normals. Absent for the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub magnitude: Option<f64>,
    /// The faces that a pressure or a normal force acts on, each as at least 3 point indices; absent for the others.
    /// Normals point to where the corners run counter-clockwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<Vec<u32>>,
}

/// New scalars of a constraint from a time step on: a handle that is moved, a length that changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Edit {
    /// The time step, from 1, before which it is made.
    pub before_step: u32,
    /// The constraint, by its place in `constraints`.
    pub constraint: u32,
    /// Its scalars, as its type states them.
    pub scalars: Vec<f64>,
}

/// How iterations are accelerated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Acceleration {
    /// Quasi-Newton where a solve has stopping rules, none where it makes a given number of iterations.
    #[default]
    Automatic,
    /// Not at all: every iteration is one local and one global step.
    None,
    /// Safeguarded Anderson acceleration.
    Anderson,
    /// L-BFGS with the matrix of the global step as initial Hessian, and a line search.
    QuasiNewton,
}

/// When to stop, and how to get there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// Iterations at most, in dynamic mode within each time step.
    pub max_iterations: u32,
    /// Stop when the largest move of a point in one iteration, relative to the bounding-box diagonal, falls below this.
    pub tolerance: f64,
    /// Stop after so many seconds; 0: no limit.
    pub time_budget_seconds: f64,
    /// The number of time steps in dynamic mode.
    pub steps: u32,
    /// How iterations are accelerated.
    pub acceleration: Acceleration,
    /// Iterations that acceleration remembers, at most 64; 0: the method's default.
    pub acceleration_memory: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_iterations: 1000,
            tolerance: 1e-6,
            time_budget_seconds: 0.0,
            steps: 1,
            acceleration: Acceleration::Automatic,
            acceleration_memory: 0,
        }
    }
}

/// Points, constraints, forces and settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// The version of this form: 1.
    pub version: u32,
    /// Static or dynamic.
    #[serde(default)]
    pub mode: Mode,
    /// The mass of every point (dynamic mode), above 0.
    #[serde(default = "one")]
    pub masses: f64,
    /// The factor on the velocities after each step (dynamic mode), at least 0.
    #[serde(default = "one")]
    pub damping: f64,
    /// The time step (dynamic mode), above 0.
    #[serde(default = "one")]
    pub timestep: f64,
    /// Coordinates `[x, y, z]` in model units.
    pub points: Vec<[f64; 3]>,
    /// Shapes that constraints refer to, in the order of their ids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub references: Vec<Reference>,
    /// The constraints, in the order of their ids.
    #[serde(default)]
    pub constraints: Vec<Signature>,
    /// The forces, in the order of their ids.
    #[serde(default)]
    pub forces: Vec<ForceSignature>,
    /// What is minimised while hard constraints are met (static mode). Absent: the defaults, if there is a hard
    /// constraint or a handle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Points that are drawn to targets (static mode).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub handles: Vec<Handle>,
    /// Edits of constraints between time steps (dynamic mode), for whoever makes the steps: see
    /// [`Problem::edits_before`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edits: Vec<Edit>,
    /// When to stop.
    #[serde(default)]
    pub settings: Settings,
    /// Faces as lists of point indices: for files, pictures, and the fairness of an objective.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<Vec<u32>>,
    /// Edges as pairs of point indices: for files, pictures, and the fairness of an objective.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<[u32; 2]>,
    /// Anything else that its author wants to keep; never read.
    #[serde(default, skip_serializing_if = "serde_json::Map::is_empty")]
    pub extra: serde_json::Map<String, serde_json::Value>,
}

fn is_false(value: &bool) -> bool {
    !value
}

fn one() -> f64 {
    1.0
}

impl Default for Problem {
    fn default() -> Self {
        Self {
            version: VERSION,
            mode: Mode::Static,
            masses: 1.0,
            damping: 1.0,
            timestep: 1.0,
            points: Vec::new(),
            references: Vec::new(),
            constraints: Vec::new(),
            forces: Vec::new(),
            objective: None,
            handles: Vec::new(),
            edits: Vec::new(),
            settings: Settings::default(),
            faces: Vec::new(),
            edges: Vec::new(),
            extra: serde_json::Map::new(),
        }
    }
}

impl Problem {
    /// Reads the JSON form and checks everything in it.
    ///
    /// # Errors
    /// The place in the text and what was expected there.
    pub fn from_json(text: &str) -> Result<Self> {
        let problem: Self = json::from_text(text)?;
        problem.check()?;
        Ok(problem)
    }

    /// The JSON form: a line per point, constraint, force, face and edge, ending in a newline.
    pub fn to_json(&self) -> String {
        json::to_text(self)
    }

    /// The edits to make before a time step, counted from 1: the type's name, the constraint and its new scalars, as
    /// `Solver::edit_constraint` takes them.
    pub fn edits_before(&self, step: u32) -> impl Iterator<Item = (&str, ConstraintId, &[f64])> {
        let edits = self.edits.iter().filter(move |edit| edit.before_step == step);
        edits.filter_map(|edit| {
            let id = edit.constraint as ConstraintId;
            Some((self.constraints.get(id)?.type_name.as_str(), id, edit.scalars.as_slice()))
        })
    }

    /// Checks everything that a solver would refuse.
    ///
    /// # Errors
    /// The first place that errs.
    pub fn check(&self) -> Result<()> {
        self.assemble().map(drop)
    }

    /// The parts that a solver works on.
    pub(crate) fn assemble(&self) -> Result<(Vec<DVec3>, ConstraintSet, ForceSet)> {
        let invalid = |place: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(place));
        if self.version != VERSION {
            return invalid("version", format!("expected {VERSION}, found {}", self.version));
        }
        for (name, value) in [("masses", self.masses), ("timestep", self.timestep)] {
            if finite(name, value)? <= 0.0 {
                return invalid(name, format!("expected a number above 0, found {value}"));
            }
        }
        let settings = &self.settings;
        let at_least_0 = [
            ("damping", self.damping),
            ("settings.tolerance", settings.tolerance),
            ("settings.time_budget_seconds", settings.time_budget_seconds),
        ];
        for (name, value) in at_least_0 {
            if finite(name, value)? < 0.0 {
                return invalid(name, format!("expected at least 0, found {value}"));
            }
        }
        if settings.acceleration_memory > MOST_MEMORY {
            let found = settings.acceleration_memory;
            let reason = format!("expected 1 to {MOST_MEMORY}, or 0 for the default, found {found}");
            return invalid("settings.acceleration_memory", reason);
        }
        let points: Vec<DVec3> = self.points.iter().copied().map(DVec3::from_array).collect();
        if let Some(i) = points.iter().position(|point| !point.is_finite()) {
            return invalid(
                &format!("points[{i}]"),
                format!("expected finite coordinates, found {:?}", self.points[i]),
            );
        }
        let in_range = |place: String, list: &[u32]| match list.iter().position(|&i| i as usize >= points.len()) {
            None => Ok(()),
            Some(j) => {
                let reason = format!("{} is out of range for {} points", list[j], points.len());
                Err(Error::new(Status::IndexOutOfRange, reason).at(format!("{place}[{j}]")))
            }
        };
        for (i, face) in self.faces.iter().enumerate() {
            in_range(format!("faces[{i}]"), face)?;
        }
        for (i, edge) in self.edges.iter().enumerate() {
            in_range(format!("edges[{i}]"), edge)?;
        }
        let mut constraints = ConstraintSet::default();
        for (i, reference) in self.references.iter().enumerate() {
            let place = |error: Error| error.at(reference.kind()).at(format!("references[{i}]"));
            constraints.add_reference(reference.shape().map_err(place)?);
        }
        for signature in &self.constraints {
            let scalars = signature.scalars.as_deref();
            let scalar_count = scalars.map(<[f64]>::len);
            let new = NewConstraints {
                type_name: &signature.type_name,
                indices: &signature.indices,
                counts: &[signature.indices.len()],
                weights: &[signature.weight],
                scalars: scalars.unwrap_or_default(),
                scalar_counts: scalar_count.as_slice(),
            };
            constraints.add(&points, new, |id| format!("constraints[{id}]"))?;
        }
        let hard = self.constraints.iter().enumerate().filter(|(_, signature)| signature.hard);
        for (id, _) in hard {
            constraints.set_hard(id, true).map_err(|error| error.at(format!("constraints[{id}].hard")))?;
        }
        self.check_exploration()?;
        let mut forces = ForceSet::default();
        for (i, signature) in self.forces.iter().enumerate() {
            let force = Force::from_signature(signature);
            force
                .and_then(|force| forces.add(force, points.len()))
                .map_err(|error| error.at(format!("forces[{i}]")))?;
        }
        for (i, edit) in self.edits.iter().enumerate() {
            self.check_edit(edit, &constraints).map_err(|error| error.at(format!("edits[{i}]")))?;
        }
        Ok((points, constraints, forces))
    }

    /// Refuses handles and objectives that do not fit, and anything to explore in dynamic mode.
    fn check_exploration(&self) -> Result<()> {
        let is_hard = |signature: &Signature| signature.hard;
        if self.mode == Mode::Dynamic {
            let found = [
                (self.objective.is_some(), "objective".to_owned()),
                (!self.handles.is_empty(), "handles".to_owned()),
                (
                    self.constraints.iter().any(is_hard),
                    format!("constraints[{}].hard", self.constraints.iter().position(is_hard).unwrap_or_default()),
                ),
            ];
            if let Some((_, place)) = found.into_iter().find(|(is_there, _)| *is_there) {
                let reason = "it is for mode \"static\", found \"dynamic\"";
                return Err(Error::new(Status::InvalidValue, reason).at(place));
            }
        }
        for (i, handle) in self.handles.iter().enumerate() {
            let check = || -> Result<()> {
                if handle.point as usize >= self.points.len() {
                    let reason = format!("{} is out of range for {} points", handle.point, self.points.len());
                    return Err(Error::new(Status::IndexOutOfRange, reason).at("point"));
                }
                if self.handles[..i].iter().any(|other| other.point == handle.point) {
                    let reason = format!("point {} has a handle already", handle.point);
                    return Err(Error::new(Status::InvalidValue, reason).at("point"));
                }
                handle.target.iter().try_for_each(|value| finite("target", *value).map(drop))
            };
            check().map_err(|error| error.at(format!("handles[{i}]")))?;
        }
        if let Some(objective) = &self.objective {
            objective.check().map_err(|error| error.at("objective"))?;
            if objective.fairness_weight > 0.0 && self.fairness_rows()?.iter().next().is_none() {
                let reason = format!(
                    "{} needs faces, edges or polylines to be fair along: give them, or set it to 0",
                    objective.fairness_weight
                );
                return Err(Error::new(Status::InvalidValue, reason).at("objective.fairness_weight"));
            }
        }
        Ok(())
    }

    /// The rows of the fairness term: of faces and edges, or of polylines.
    pub(crate) fn fairness_rows(&self) -> Result<FairnessRows> {
        let objective = self.objective.clone().unwrap_or_default();
        let mesh =
            || Mesh { points: self.points.iter().copied().map(DVec3::from_array).collect(), faces: self.faces.clone() };
        if objective.fairness == Fairness::Laplacian {
            let mut edges = if self.faces.is_empty() { Vec::new() } else { Topology::new(&mesh())?.edges().to_vec() };
            edges.extend_from_slice(&self.edges);
            return Ok(FairnessRows::laplacian(self.points.len(), &edges));
        }
        for (i, polyline) in objective.polylines.iter().enumerate() {
            if let Some(j) = polyline.iter().position(|&point| point as usize >= self.points.len()) {
                let reason = format!("{} is out of range for {} points", polyline[j], self.points.len());
                return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("objective.polylines[{i}][{j}]")));
            }
        }
        if !objective.polylines.is_empty() || self.faces.is_empty() {
            return Ok(FairnessRows::differences(&objective.polylines, objective.fairness));
        }
        Ok(FairnessRows::differences(&polylines(&mesh())?, objective.fairness))
    }

    fn check_edit(&self, edit: &Edit, constraints: &ConstraintSet) -> Result<()> {
        let id = edit.constraint as ConstraintId;
        let Some(signature) = self.constraints.get(id) else {
            let reason = format!("{id} is out of range for {} constraints", self.constraints.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("constraint"));
        };
        if self.mode == Mode::Static {
            let reason = "edits are made between time steps: expected mode \"dynamic\", found \"static\"";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        if edit.before_step == 0 {
            let reason = "steps count from 1, found 0";
            return Err(Error::new(Status::InvalidValue, reason).at("before_step"));
        }
        constraints.check_edit(&signature.type_name, id, &edit.scalars)
    }
}
