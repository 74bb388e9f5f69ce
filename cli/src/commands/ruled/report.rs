//! What a run found, as JSON (docs/ruled.md tells the fields).

use std::collections::BTreeMap;

use serde::Serialize;
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::optimise::{Iteration, Optimised, Options};
use shapeop::geometry::ruled::report::Report as Measures;

use super::measures::Relative;

/// The version of the report's form.
pub const VERSION: u32 = 1;

#[derive(Serialize)]
pub struct Report {
    pub version: u32,
    pub program: &'static str,
    pub command: &'static str,
    pub input: String,
    pub mesh: MeshInReport,
    /// None with --single, which needs no field.
    pub field: Option<FieldInReport>,
    pub boundaries: BoundariesInReport,
    pub start: StartInReport,
    pub optimisation: OptimisationInReport,
    /// docs/ruled-report.schema.json
    pub measures: Measures,
    pub relative: Relative,
    pub planks: Vec<PlanksInReport>,
    pub warnings: Vec<String>,
    pub was_interrupted: bool,
    pub seconds: Seconds,
    pub files: BTreeMap<String, String>,
}

#[derive(Clone, Copy, Serialize)]
pub struct MeshInReport {
    pub points: usize,
    pub triangles: usize,
    pub area: f64,
    pub diagonal: f64,
    pub mean_edge: f64,
    /// Closed loops of the boundary: 1 of a disk, 2 of a tube.
    pub boundary_loops: usize,
}

impl MeshInReport {
    pub fn of(mesh: &shapeop::mesh::TriangleMesh) -> Self {
        Self {
            points: mesh.points().len(),
            triangles: mesh.triangles().len(),
            area: mesh.total_area(),
            diagonal: mesh.diagonal(),
            mean_edge: mesh.mean_edge(),
            boundary_loops: mesh.boundary().len(),
        }
    }
}

#[derive(Clone, Serialize)]
pub struct FieldInReport {
    pub family: usize,
    /// Points without directions: flat or positively curved, or without neighbours enough to tell.
    pub masked_points: usize,
    pub not_negative: usize,
    pub not_fitted: usize,
    /// Edges across which the field changes its sign.
    pub flipped_edges: usize,
    /// Of points with directions: the least and the greatest Gaussian curvature.
    pub gaussian_curvature: [f64; 2],
}

#[derive(Default, Serialize)]
pub struct BoundariesInReport {
    pub kind: String,
    pub count: usize,
    pub closed: usize,
    pub levels: Vec<f64>,
    pub weights: Option<LevelWeightsInReport>,
    pub iterations: Option<usize>,
    pub stop: Option<String>,
    /// The least and the greatest length of the level function's gradient.
    pub slope: Option<[f64; 2]>,
    pub critical_points: usize,
    pub dropped: Vec<DroppedInReport>,
    pub unmatched_levels: Vec<f64>,
    /// Of planar boundaries, for each plane: the least angle to the rulings.
    pub least_angles_deg: Option<Vec<f64>>,
    pub spherical_image: Option<ImageInReport>,
    /// Of conoidal boundaries: to what the field along each is most nearly orthogonal; null beyond the mesh.
    pub axes: Vec<Option<AxisInReport>>,
}

#[derive(Serialize)]
pub struct LevelWeightsInReport {
    orthogonal: f64,
    direction: f64,
    equidistant: f64,
    geodesic: f64,
    conoidal: f64,
    laplace: f64,
}

impl From<LevelWeights> for LevelWeightsInReport {
    fn from(weights: LevelWeights) -> Self {
        let LevelWeights { orthogonal, direction, equidistant, geodesic, conoidal, laplace } = weights;
        Self { orthogonal, direction, equidistant, geodesic, conoidal, laplace }
    }
}

#[derive(Serialize)]
pub struct DroppedInReport {
    pub level: f64,
    pub points: usize,
    pub length: f64,
}

#[derive(Serialize)]
pub struct ImageInReport {
    pub kind: &'static str,
    pub extent: f64,
    pub folded: f64,
    pub axis: [f64; 3],
    pub flatness: f64,
}

#[derive(Serialize)]
pub struct AxisInReport {
    pub axis: [f64; 3],
    /// The root mean square of the field's part along the axis.
    pub error: f64,
}

#[derive(Serialize)]
pub struct StartInReport {
    pub control_points: usize,
    pub shared: bool,
    /// For each strip, rulings that met no asymptotic curve's end and went to the nearest point.
    pub missed_rulings: Vec<usize>,
    /// For each strip, rulings that crossed those before them and were moved.
    pub moved_rulings: Vec<usize>,
}

#[derive(Serialize)]
pub struct OptimisationInReport {
    pub weights: WeightsInReport,
    /// What holds exactly, by kind.
    pub conditions: ConditionsInReport,
    pub unknowns: usize,
    pub iterations: usize,
    pub stop: String,
    /// By how much bounds are exceeded at most.
    pub excess: f64,
    /// The start and each iteration.
    pub history: Vec<IterationInReport>,
}

#[derive(Serialize)]
pub struct WeightsInReport {
    proximity: f64,
    beyond: f64,
    gap: f64,
    coverage: f64,
    thin_plate: f64,
    proximal: f64,
}

/// How many conditions of each kind there are.
#[derive(Clone, Copy, Default, Serialize)]
pub struct ConditionsInReport {
    pub planar_boundaries: usize,
    pub conoidal_strips: usize,
    pub fixed_ends: usize,
    pub fixed_end_rulings: usize,
    /// Of conoidal strips: the greatest angle by which a ruling was off its axis at the start.
    pub conoidal_start_deg: Option<f64>,
}

#[derive(Serialize)]
pub struct IterationInReport {
    value: f64,
    proximity: f64,
    gap: f64,
    coverage: f64,
    way: f64,
    moved: f64,
    taken: f64,
    largest_deviation: f64,
    largest_gap: f64,
}

impl From<&Iteration> for IterationInReport {
    fn from(iteration: &Iteration) -> Self {
        Self {
            value: iteration.value,
            proximity: iteration.parts.proximity,
            gap: iteration.parts.gap,
            coverage: iteration.parts.coverage,
            way: iteration.parts.way,
            moved: iteration.moved,
            taken: iteration.taken,
            largest_deviation: iteration.largest_deviation,
            largest_gap: iteration.largest_gap,
        }
    }
}

impl OptimisationInReport {
    pub fn of(found: &Optimised, options: &Options, conditions: ConditionsInReport) -> Self {
        let weights = options.weights;
        Self {
            weights: WeightsInReport {
                proximity: weights.proximity,
                beyond: weights.beyond,
                gap: weights.gap,
                coverage: weights.coverage,
                thin_plate: weights.thin_plate,
                proximal: weights.proximal,
            },
            conditions,
            unknowns: found.free_count,
            iterations: found.history.len() - 1,
            stop: match found.stop {
                shapeop::geometry::ruled::optimise::Stop::Converged => "converged",
                shapeop::geometry::ruled::optimise::Stop::MostIterations => "most iterations",
                shapeop::geometry::ruled::optimise::Stop::LineSearch => "line search",
                shapeop::geometry::ruled::optimise::Stop::Cancelled => "stopped with Ctrl-C",
            }
            .to_owned(),
            excess: found.last().excess,
            history: found.history.iter().map(Into::into).collect(),
        }
    }
}

#[derive(Serialize)]
pub struct PlanksInReport {
    pub strip: usize,
    /// The spans that were cut, from one knot to another: those beside the mesh; null: all.
    pub spans: Option<[usize; 2]>,
    /// Why there are none; null if there are.
    pub refusal: Option<String>,
    pub planks: usize,
    /// The greatest angle between a ruling and the planks.
    pub deviation_deg: f64,
    pub longest: f64,
    pub widest: f64,
    pub stock_area: f64,
    pub offcut: f64,
}

/// The time of each phase.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Seconds {
    pub field: f64,
    pub boundaries: f64,
    pub strips: f64,
    pub optimisation: f64,
    pub report: f64,
    pub files: f64,
}
