//! Recipes: from a mesh to a problem that makes its faces planar, circular or regular, its edges equal, or itself smooth.
//!
//! Every recipe states a goal of [`RecipeOptions::weight`] against keeping the design: each point is drawn to where it was
//! by a `Closeness` of weight [`RecipeOptions::closeness`], and the goal is met as nearly as that allows. Twice both
//! weights is the same problem; what counts is their ratio. All terms are squares of lengths, so a mesh in millimetres
//! and the same mesh in metres give the same result: `EdgeStrain`, whose own energy grows with the length and not with its
//! square, gets its weight multiplied by `L²/L₀` (target over rest length), which makes its energy `½ w (‖e‖ − L)²`.
//!
//! [`rationalize`] is the exception: its goal is hard, met to the last digits whatever that moves, and the other weights say which of
//! the shapes that meet it is taken.
//!
//! The points of the problem are those of the mesh in their order, its `faces` are those of the mesh.

use glam::DVec3;

use super::{Handle, Objective, Problem, Settings, Signature};
use crate::error::{Error, Result, Status, finite};
use crate::mesh::fit::regular_polygon;
use crate::mesh::measure::{Spread, edge_lengths};
use crate::mesh::{Mesh, Topology};

/// How much heavier than the heaviest other weight an anchor is: it then moves about a ten-thousandth of what it would
/// move without, and the system stays far from the limits of an f64.
const ANCHOR_FACTOR: f64 = 1e4;

/// The same for anchors of [`rationalize`], which are handles: where faces that must be planar do not allow all of them to stay, an
/// anchor that weighs more would only take more sweeps to give in.
const HANDLE_FACTOR: f64 = 1e3;

/// Fairness over closeness where [`rationalize`] is given no fairness: the ratio of Deng et al. 2015.
const FAIR: f64 = 10.0;

/// How exactly [`rationalize`] meets its constraints, over the bounding-box diagonal: 30 nanometres on a roof of 30 metres.
const EXACT: f64 = 1e-9;

/// The turn of the boundary, in radians (75 degrees), from which a boundary point counts as a corner: the corners of a
/// patch of quads turn by about 90 degrees, the teeth of a boundary of hexagons by 60.
const CORNER_TURN_RAD: f64 = 75.0 * std::f64::consts::PI / 180.0;

/// Iterations at most unless the caller says otherwise: enough for the meshes in `examples/` to come to rest, or within
/// sight of it where little holds them.
const MAX_ITERATIONS: u32 = 2000;

/// Which points keep their place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Anchors {
    /// Their indices.
    pub points: Vec<u32>,
    /// All points on boundary edges too.
    pub boundary: bool,
    /// The corners of the boundary too: where it turns by more than 75 degrees.
    pub corners: bool,
}

/// What a fairness weight asks for, at every point of the mesh: inside against all neighbours of a point, on the boundary
/// against its two neighbours along the boundary. Corners of the boundary are left alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fairness {
    /// That neighbours move alike (`LaplacianDisplacement`): the folds and details of the design stay, and the moves that
    /// the goal needs are spread.
    #[default]
    KeepDetail,
    /// That the mesh is smooth (`Laplacian`): details of the design go, and it shrinks where it is curved.
    Smooth,
}

/// What all recipes take.
#[derive(Clone, Debug, PartialEq)]
pub struct RecipeOptions {
    /// The weight of the recipe's own constraints; 1 by default.
    pub weight: f64,
    /// The weight that draws each point to where it was; 0.05 by default, 0 for none.
    pub closeness: f64,
    /// The weight of fairness; 0 by default, for none (for [`rationalize`] and [`circumscribe`]: for ten times the closeness).
    pub fairness: f64,
    /// What fairness asks for.
    pub fairness_kind: Fairness,
    /// The points that keep their place, by a `Closeness` 10⁴ times as heavy as the heaviest of the weights above; as handles in
    /// [`rationalize`] and [`circumscribe`].
    pub anchors: Anchors,
}

impl Default for RecipeOptions {
    fn default() -> Self {
        Self {
            weight: 1.0,
            closeness: 0.05,
            fairness: 0.0,
            fairness_kind: Fairness::default(),
            anchors: Anchors::default(),
        }
    }
}

/// A recipe: from a mesh, a length (that only [`equalize`] and [`rationalize`] take) and options to a problem.
pub type Recipe = fn(&Mesh, Option<f64>, &RecipeOptions) -> Result<Problem>;

/// Every recipe with its name, for programs that let people choose.
pub const RECIPES: [(&str, Recipe); 6] = [
    ("planarize", |mesh, _, options| planarize(mesh, options)),
    ("circularize", |mesh, _, options| circularize(mesh, options)),
    ("smooth", |mesh, _, options| smooth(mesh, options)),
    ("regularize", |mesh, _, options| regularize(mesh, options)),
    ("equalize", equalize),
    ("rationalize", rationalize),
];

/// The recipes that take a length.
pub const TAKE_LENGTH: [&str; 2] = ["equalize", "rationalize"];

/// Makes every face planar: a `Plane` per face. Triangles are planar as they are and get none.
///
/// # Errors
/// As [`Mesh::check_polygons`]; the mesh has no faces; a weight is negative or not finite; an anchor is out of range.
pub fn planarize(mesh: &Mesh, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    for face in mesh.faces.iter().filter(|face| face.len() > 3) {
        draft.add("Plane", face.clone(), options.weight, None);
    }
    draft.finish()
}

/// Gives every face a circumscribed circle, which makes it planar too: a `Circle` per face, none for triangles.
///
/// # Errors
/// As [`planarize`].
pub fn circularize(mesh: &Mesh, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    for face in mesh.faces.iter().filter(|face| face.len() > 3) {
        draft.add("Circle", face.clone(), options.weight, None);
    }
    draft.finish()
}

/// Smooths the mesh: a `Laplacian` per point, inside against all neighbours, on the boundary along the boundary, so that
/// it keeps its outline. Corners of the boundary have none.
///
/// # Errors
/// As [`planarize`].
pub fn smooth(mesh: &Mesh, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    draft.add_laplacians("Laplacian", options.weight);
    draft.finish()
}

/// Draws every face towards a regular polygon of its number of corners, in any place and size: a `Similarity` per face.
///
/// # Errors
/// As [`planarize`].
pub fn regularize(mesh: &Mesh, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    for face in &mesh.faces {
        let shape = regular_polygon(face.len()).iter().flat_map(|corner| corner.to_array()).collect();
        draft.add("Similarity", face.clone(), options.weight, Some(shape));
    }
    draft.finish()
}

/// Draws every edge towards one length: an `EdgeStrain` per edge, whose length is edited to `length`, by default the mean
/// of the edges as they are. Its energy is `½ weight (‖e‖ − length)²`.
///
/// # Errors
/// As [`planarize`]; `length` is not finite and above 0, or not given for a mesh whose edges all have length 0.
pub fn equalize(mesh: &Mesh, length: Option<f64>, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    let rest_lengths = edge_lengths(mesh)?;
    let length = check_length(length.unwrap_or_else(|| Spread::of(&rest_lengths).mean))?;
    let edges = draft.topology.edges().to_vec();
    for (edge, rest_length) in edges.into_iter().zip(rest_lengths) {
        // Where the rest length is 0, EdgeStrain measures by the edited length instead.
        let measure = if rest_length > 0.0 { rest_length } else { length };
        let weight = options.weight * length * (length / measure);
        draft.add("EdgeStrain", edge.to_vec(), weight, Some(vec![length, 1.0, 1.0]));
    }
    draft.problem.edges = draft.topology.edges().to_vec();
    draft.finish()
}

fn check_length(length: f64) -> Result<f64> {
    if length > 0.0 && length.is_finite() {
        return Ok(length);
    }
    let reason = format!("expected a finite number above 0, found {length}");
    Err(Error::new(Status::InvalidValue, reason).at("length"))
}

/// Makes every face planar exactly, near the design and with fair moves: a hard `Plane` per face, none for triangles. With `length`
/// a quad gets a hard `DiagonalDistance` instead: its diagonals, as lines, may be so far apart, in model units.
///
/// Of all shapes that meet this, the one is found for which [`RecipeOptions::closeness`] times the squares of the moves plus
/// [`RecipeOptions::fairness`] times those of what fairness measures is least. Without fairness exact planarity leaves kinks, so 0 is
/// ten times the closeness here. [`RecipeOptions::weight`] counts only where faces contradict each other, as their priority. Anchors
/// are handles at their places, 10³ times as heavy as the heavier of the other weights: they give in where planar faces do not allow
/// all of them.
///
/// # Errors
/// As [`planarize`]; the closeness or `length` is not finite and above 0.
pub fn rationalize(mesh: &Mesh, length: Option<f64>, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    check_closeness(options)?;
    let length = length.map(check_length).transpose()?;
    for face in mesh.faces.iter().filter(|face| face.len() > 3) {
        let (type_name, scalars) = match length {
            Some(length) if face.len() == 4 => ("DiagonalDistance", Some(vec![length])),
            _ => ("Plane", None),
        };
        draft.add_hard(type_name, face.clone(), options.weight, scalars);
    }
    draft.finish_exact()
}

/// Gives every face a circumscribed circle to the last digits, for going on with a circular net: a hard `Circle` per face, none
/// for triangles. Of all such meshes that is found which is nearest to the design and whose moves are fair; a circular net stays what it
/// is until a handle moves. Edges of circular quads follow lines of principal curvature: a mesh laid out otherwise (along the straight
/// lines of a hyperbolic paraboloid, or with a boundary held fast) has far to go, or none is found; sweeps are slow there, as the
/// projection onto a circle is not the nearest one. What is left when iterations run out is told by the report. Anchors are handles,
/// as in [`rationalize`].
///
/// # Errors
/// As [`planarize`]; `closeness` is 0.
pub fn circumscribe(mesh: &Mesh, options: &RecipeOptions) -> Result<Problem> {
    let mut draft = Draft::new(mesh, options)?;
    check_closeness(options)?;
    for face in mesh.faces.iter().filter(|face| face.len() > 3) {
        draft.add_hard("Circle", face.clone(), options.weight, None);
    }
    draft.finish_exact()
}

/// Refuses a closeness that leaves the nearest of all exact meshes open.
fn check_closeness(options: &RecipeOptions) -> Result<()> {
    if options.closeness > 0.0 {
        return Ok(());
    }
    let reason = format!("expected a number above 0, as it makes the result unique; found {}", options.closeness);
    Err(Error::new(Status::InvalidValue, reason).at("closeness"))
}

/// The boundary points where the boundary turns by more than 75 degrees.
///
/// # Errors
/// As [`Mesh::check`].
pub fn boundary_corners(mesh: &Mesh) -> Result<Vec<u32>> {
    let topology = Topology::new(mesh)?;
    let stencils = boundary_stencils(mesh, &topology);
    Ok((0..).zip(stencils).filter(|(_, stencil)| matches!(stencil, Stencil::Corner)).map(|(point, _)| point).collect())
}

/// Where a point lies, with the points that its Laplacian compares it with.
#[derive(Clone, PartialEq)]
enum Stencil {
    Inside,
    Boundary([u32; 2]),
    Corner,
}

fn boundary_stencils(mesh: &Mesh, topology: &Topology) -> Vec<Stencil> {
    let mut stencils = vec![Stencil::Inside; mesh.points.len()];
    let at = |point: u32| mesh.points[point as usize];
    for chain in topology.boundary() {
        let k = chain.points.len();
        for (i, &point) in chain.points.iter().enumerate() {
            let (last, next) = (chain.points[(i + k - 1) % k], chain.points[(i + 1) % k]);
            let turn = angle_rad(at(point) - at(last), at(next) - at(point));
            let is_end = !chain.is_closed && (i == 0 || i + 1 == k);
            // A point that the boundary passes twice is held by both passes: a corner.
            let is_first_pass = stencils[point as usize] == Stencil::Inside;
            stencils[point as usize] = if is_end || !is_first_pass || last == next || turn > CORNER_TURN_RAD {
                Stencil::Corner
            } else {
                Stencil::Boundary([last, next])
            };
        }
    }
    stencils
}

/// The angle between two vectors in radians, 0 to π; 0 if one has no length.
fn angle_rad(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// A problem in the making.
struct Draft<'a> {
    mesh: &'a Mesh,
    options: &'a RecipeOptions,
    topology: Topology,
    problem: Problem,
}

impl<'a> Draft<'a> {
    fn new(mesh: &'a Mesh, options: &'a RecipeOptions) -> Result<Self> {
        mesh.check_polygons()?;
        if mesh.faces.is_empty() {
            return Err(Error::new(Status::InvalidValue, "expected at least one face, found none").at("faces"));
        }
        let weights = [("weight", options.weight), ("closeness", options.closeness), ("fairness", options.fairness)];
        for (name, weight) in weights {
            if finite(name, weight)? < 0.0 {
                let reason = format!("expected at least 0, found {weight}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        let problem = Problem {
            points: mesh.points.iter().map(DVec3::to_array).collect(),
            faces: mesh.faces.clone(),
            settings: Settings { max_iterations: MAX_ITERATIONS, ..Settings::default() },
            ..Problem::default()
        };
        Ok(Self { mesh, options, topology: Topology::new(mesh)?, problem })
    }

    fn add(&mut self, type_name: &str, indices: Vec<u32>, weight: f64, scalars: Option<Vec<f64>>) {
        if weight > 0.0 {
            self.problem.constraints.push(Signature {
                type_name: type_name.to_owned(),
                indices,
                weight,
                scalars,
                hard: false,
            });
        }
    }

    fn add_hard(&mut self, type_name: &str, indices: Vec<u32>, weight: f64, scalars: Option<Vec<f64>>) {
        let type_name = type_name.to_owned();
        self.problem.constraints.push(Signature { type_name, indices, weight, scalars, hard: true });
    }

    /// One Laplacian of the type per point, as [`Fairness`] states.
    fn add_laplacians(&mut self, type_name: &str, weight: f64) {
        for (point, stencil) in (0..).zip(boundary_stencils(self.mesh, &self.topology)) {
            let neighbours = match stencil {
                Stencil::Inside => self.topology.neighbours(point).points,
                Stencil::Boundary(neighbours) => neighbours.to_vec(),
                Stencil::Corner => continue,
            };
            if !neighbours.is_empty() {
                let indices = [point].into_iter().chain(neighbours).collect();
                self.add(type_name, indices, weight, None);
            }
        }
    }

    /// Adds fairness, closeness and anchors.
    fn finish(mut self) -> Result<Problem> {
        let options = self.options;
        let kind = match options.fairness_kind {
            Fairness::KeepDetail => "LaplacianDisplacement",
            Fairness::Smooth => "Laplacian",
        };
        if options.fairness > 0.0 {
            self.add_laplacians(kind, options.fairness);
        }
        let is_anchor = self.anchors()?;
        let heaviest = options.weight.max(options.closeness).max(options.fairness);
        let anchor_weight = ANCHOR_FACTOR * if heaviest > 0.0 { heaviest } else { 1.0 };
        for (point, is_anchor) in (0..).zip(is_anchor) {
            let weight = if is_anchor { anchor_weight } else { options.closeness };
            self.add("Closeness", vec![point], weight, None);
        }
        Ok(self.problem)
    }

    /// Adds fairness, closeness and anchors as an objective and handles beside hard constraints.
    fn finish_exact(mut self) -> Result<Problem> {
        let closeness = self.options.closeness;
        let fairness = if self.options.fairness > 0.0 { self.options.fairness } else { FAIR * closeness };
        let is_kept = self.options.fairness_kind == Fairness::KeepDetail;
        if !is_kept {
            self.add_laplacians("Laplacian", fairness);
        }
        let anchors = (0..).zip(self.anchors()?).filter(|(_, is_anchor)| *is_anchor);
        let target = |point: u32| self.mesh.points[point as usize].to_array();
        self.problem.handles = anchors.map(|(point, _)| Handle { point, target: target(point) }).collect();
        self.problem.objective = Some(Objective {
            handle_weight: HANDLE_FACTOR * closeness.max(fairness),
            closeness_weight: closeness,
            fairness_weight: if is_kept { fairness } else { 0.0 },
            tolerance: EXACT,
            ..Objective::default()
        });
        Ok(self.problem)
    }

    fn anchors(&self) -> Result<Vec<bool>> {
        let Anchors { points, boundary, corners } = &self.options.anchors;
        let point_count = self.mesh.points.len();
        let mut is_anchor = if *boundary { self.topology.boundary_points() } else { vec![false; point_count] };
        if *corners {
            boundary_corners(self.mesh)?.iter().for_each(|&corner| is_anchor[corner as usize] = true);
        }
        for (j, &point) in points.iter().enumerate() {
            let Some(flag) = is_anchor.get_mut(point as usize) else {
                let reason = format!("{point} is out of range for {point_count} points");
                return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("anchors[{j}]")));
            };
            *flag = true;
        }
        Ok(is_anchor)
    }
}
