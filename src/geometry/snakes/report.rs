//! What a covering by the positions of a snake comes to: how many arcs of which kinds it takes, how much of a reference surface it
//! covers, and how far it is from it.

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::arc_list::KindForm;
use super::sweep::{arc_kinds, swept_grid};
use super::{Snake, sweep};
use crate::error::{Error, Result, Status};
use crate::mesh::deviation::Deviation;
use crate::mesh::{ClosestPoints, Grid, ReferenceSurface, TriangleMesh};

/// Triangles of the reference are divided until there are so many parts at least.
const LEAST_PARTS: usize = 20_000;

/// What is farther beyond the boundary of the reference than this part of its diagonal is not compared with it.
const BEYOND: f64 = 1e-6;

/// How a covering is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportOptions {
    /// Arcs are of one kind if radii and lengths are within this of those of the first, relative to them; 0 or more.
    pub tolerance: f64,
    /// Intervals of each arc of the swept surface, at least 1.
    pub per_arc: usize,
    /// A spot of the reference is covered if the swept surface is within this distance, in model units, above 0; by default 0.01
    /// of the reference's diagonal.
    pub distance: Option<f64>,
    /// Whether the last position is followed by the first.
    pub comes_back: bool,
}

impl Default for ReportOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, per_arc: 8, distance: None, comes_back: false }
    }
}

/// The surface that is to be covered: `mesh` has its area; distances are from `surface`, which may be the mesh again or the surface
/// that it is a mesh of.
#[derive(Clone, Copy)]
pub struct Reference<'a> {
    /// The mesh.
    pub mesh: &'a TriangleMesh,
    /// The surface.
    pub surface: &'a dyn ReferenceSurface,
}

impl std::fmt::Debug for Reference<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Reference").field("mesh", &self.mesh).finish_non_exhaustive()
    }
}

/// What there is to say of a covering. Lengths are in model units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// The kinds of arcs, with how many there are of each in all positions together.
    pub kinds: Vec<KindForm>,
    /// Positions of the snake.
    pub positions: usize,
    /// Arcs of all positions.
    pub instances: usize,
    /// The length of all arcs together.
    pub length: f64,
    /// The area of the swept surface, in square model units; 0 with one position.
    pub area: f64,
    /// By how much a distance of control points is off in any position at most: by that arcs do not keep their shapes.
    pub residual: f64,
    /// How it compares with the surface that is to be covered, if there is one and there are positions enough to sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Covering>,
}

/// How a swept surface compares with a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Covering {
    /// The area of the reference, in square model units.
    pub area: f64,
    /// The part of it to which the swept surface is within `distance`, from 0 to 1. A margin of that width around the swept surface
    /// counts too.
    pub coverage: f64,
    /// That distance.
    pub distance: f64,
    /// How far samples of the swept surface are from the reference: the greatest, and where, is the deviation of the covering. Those
    /// beyond the boundary of the reference do not count.
    pub deviation: Deviation,
    /// How many samples are beyond it.
    pub beyond: usize,
}

/// Judges the positions of a snake, as of an evolution.
///
/// # Errors
/// No position (`frames`), one with another number of control points or with coordinates that are not finite (`frames[i]`); options
/// out of their ranges (`options.FIELD`); too large a grid (`points`). Fewer than 2 positions, or 3 that come back, are no surface:
/// then nothing is compared.
pub fn report(
    snake: &Snake,
    frames: &[Vec<DVec3>],
    reference: Option<Reference<'_>>,
    options: &ReportOptions,
) -> Result<Report> {
    let kinds = arc_kinds(snake.shapes(), options.tolerance).map_err(|error| error.at("options"))?;
    sweep::check_intervals("options.per_arc", options.per_arc)?;
    if let Some(distance) = options.distance.filter(|distance| !(*distance > 0.0 && distance.is_finite())) {
        let reason = format!("expected a finite number above 0, found {distance}");
        return Err(Error::new(Status::InvalidValue, reason).at("options.distance"));
    }
    if frames.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("frames"));
    }
    let mut residual = 0.0_f64;
    for (i, frame) in frames.iter().enumerate() {
        let moved = snake.moved(frame.clone()).map_err(|error| sweep::of_frame(i, &error))?;
        residual = residual.max(moved.residual());
    }
    let mut found = Report {
        kinds: kinds.iter().map(|kind| KindForm::of(kind, frames.len())).collect(),
        positions: frames.len(),
        instances: frames.len() * snake.shapes().len(),
        length: frames.len() as f64 * snake.length(),
        residual,
        ..Report::default()
    };
    let least = if options.comes_back { 3 } else { 2 };
    if frames.len() >= least {
        let grid = swept_grid(snake, frames, options.per_arc, options.comes_back)?;
        let areas = areas(&grid);
        found.area = areas.iter().sum();
        found.reference = reference.map(|reference| covering(&grid, &areas, reference, options)).transpose()?;
    }
    Ok(found)
}

fn halves([a, b, c, d]: [usize; 4]) -> [[usize; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// The area that each point of a grid stands for: a third of the triangles around it.
fn areas(grid: &Grid) -> Vec<f64> {
    let mut areas = vec![0.0; grid.points().len()];
    for triangle in grid.quads().flat_map(halves) {
        let [a, b, c] = triangle.map(|i| grid.points()[i]);
        let area = 0.5 * (b - a).cross(c - a).length();
        triangle.iter().for_each(|&i| areas[i] += area / 3.0);
    }
    areas
}

fn covering(
    grid: &Grid,
    areas: &[f64],
    Reference { mesh, surface }: Reference<'_>,
    options: &ReportOptions,
) -> Result<Covering> {
    let triangles: Vec<[u32; 3]> =
        grid.quads().flat_map(halves).map(|triangle| triangle.map(|corner| corner as u32)).collect();
    let swept = ClosestPoints::of_triangles(grid.points(), &triangles)?;
    let distance = options.distance.unwrap_or(0.01 * mesh.diagonal());
    let parts = LEAST_PARTS.div_ceil(mesh.triangles().len()).isqrt() + 1;
    let covered = |t: usize| {
        let middles = middles(mesh.corners(t), parts);
        let near = middles.iter().filter(|point| swept.nearest(**point).distance(**point) <= distance);
        mesh.area(t) * near.count() as f64 / middles.len() as f64
    };
    // Summed up in order: the same with any number of threads.
    let covered: Vec<f64> = (0..mesh.triangles().len()).into_par_iter().map(covered).collect();
    let sample = |(point, &area): (&DVec3, &f64)| {
        let foot = surface.nearest(*point);
        (foot.overhang <= BEYOND * surface.diagonal()).then(|| (*point, foot.point.distance(*point), area))
    };
    let samples: Vec<Option<(DVec3, f64, f64)>> = grid.points().par_iter().zip(areas).map(sample).collect();
    let inside: Vec<(DVec3, f64, f64)> = samples.iter().flatten().copied().collect();
    Ok(Covering {
        area: mesh.total_area(),
        coverage: (covered.iter().sum::<f64>() / mesh.total_area()).min(1.0),
        distance,
        deviation: Deviation::of(&inside),
        beyond: samples.len() - inside.len(),
    })
}

/// The middles of the `parts²` triangles that a triangle is divided into.
fn middles([a, b, c]: [DVec3; 3], parts: usize) -> Vec<DVec3> {
    let third = 1.0 / (3.0 * parts as f64);
    let at = |i: usize, j: usize, extra: usize| {
        let [u, v] = [i, j].map(|k| (3 * k + extra) as f64 * third);
        a + u * (b - a) + v * (c - a)
    };
    let rows = (0..parts).flat_map(|i| (0..parts - i).map(move |j| (i, j)));
    // Those that lie as the whole, and between them those the other way around.
    rows.flat_map(|(i, j)| {
        [(1, true), (2, i + j + 1 < parts)].map(|(extra, is_there)| is_there.then(|| at(i, j, extra)))
    })
    .flatten()
    .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::geometry::snakes::{ArcShape, Pose};
    use crate::mesh::reference::{ParametricSurface, ReferenceMesh};
    use crate::mesh::surfaces::cylinder;

    /// A third of a circle of radius `radius` about the z axis, as two arcs, at heights from 0 on.
    fn stack(radius: f64, heights: &[f64]) -> (Snake, Vec<Vec<DVec3>>) {
        let shape = ArcShape { radius, length: radius * PI / 3.0 };
        let pose = Pose { point: DVec3::new(radius, 0.0, 0.0), tangent: DVec3::Y, normal: DVec3::NEG_X };
        let snake = Snake::from_arcs(&[shape; 2], &[0.0], &pose).unwrap();
        let frame = |z: &f64| snake.control().iter().map(|p| *p + *z * DVec3::Z).collect();
        let frames = heights.iter().map(frame).collect();
        (snake, frames)
    }

    #[test]
    fn a_part_of_a_cylinder_is_covered() {
        let surface = ParametricSurface::new([[0.0, TAU], [0.0, 3.0]], [60, 3], cylinder(2.0)).unwrap();
        let mesh = TriangleMesh::new(&surface.mesh(181, 31).unwrap()).unwrap();
        let reference = Some(Reference { mesh: &mesh, surface: &surface });
        let (snake, frames) = stack(2.1, &[0.0, 0.5, 1.0, 1.5]);
        let options = ReportOptions { distance: Some(0.11), per_arc: 40, ..Default::default() };
        let found = report(&snake, &frames, reference, &options).unwrap();
        assert_eq!((found.positions, found.instances, found.kinds.len(), found.kinds[0].count), (4, 8, 1, 8));
        assert!((found.length - 4.0 * 2.1 * TAU / 3.0).abs() < 1e-12 && found.residual < 1e-14);
        assert!((found.area / (1.5 * 2.1 * TAU / 3.0) - 1.0).abs() < 1e-4);
        let covering = found.reference.unwrap();
        assert!((covering.area / (6.0 * TAU) - 1.0).abs() < 1e-3);
        // A third of the half, and beside it a margin of √(0.11² − 0.1²) or less.
        let exact = 1.0 / 6.0;
        assert!(covering.coverage > exact && covering.coverage < exact + 0.02, "{}", covering.coverage);
        assert!((covering.deviation.max - 0.1).abs() < 1e-12 && (covering.deviation.rms - 0.1).abs() < 1e-12);
        assert_eq!((covering.beyond, covering.deviation.count), (0, 4 * 81));
        let at = DVec3::from_array(covering.deviation.at);
        assert!((at.x.hypot(at.y) - 2.1).abs() < 1e-12);
        // A little nearer than the swept surface is there is nothing.
        let options = ReportOptions { distance: Some(0.099), ..options };
        assert_eq!(report(&snake, &frames, reference, &options).unwrap().reference.unwrap().coverage, 0.0);
        // What is beyond the boundary is no deviation.
        let (snake, frames) = stack(2.0, &[0.0, 2.0, 4.0]);
        let found = report(&snake, &frames, reference, &ReportOptions::default()).unwrap().reference.unwrap();
        assert_eq!(found.beyond, 17);
        assert!(found.deviation.max < 1e-12 && found.deviation.count == 34, "{found:?}");
        let margin = 2.0 * found.distance / (2.0 * TAU);
        assert!((found.coverage - 1.0 / 3.0 - margin).abs() < 2e-3, "{found:?}");
    }

    #[test]
    fn all_of_a_mesh_is_covered_by_itself() {
        let surface = ParametricSurface::new([[0.0, TAU / 3.0], [0.0, 1.0]], [30, 3], cylinder(1.0)).unwrap();
        let mesh = TriangleMesh::new(&surface.mesh(31, 11).unwrap()).unwrap();
        let reference = ReferenceMesh::new(&mesh);
        let (snake, frames) = stack(1.0, &[0.0, 1.0]);
        let judged = Some(Reference { mesh: &mesh, surface: &reference });
        let found = report(&snake, &frames, judged, &ReportOptions::default()).unwrap().reference.unwrap();
        assert_eq!(found.coverage, 1.0);
        assert!(found.deviation.max < 1e-3 && found.distance == 0.01 * mesh.diagonal());
        // One position is no surface.
        let one = report(&snake, &frames[..1], judged, &ReportOptions::default()).unwrap();
        assert!(one.reference.is_none() && one.area == 0.0 && one.kinds[0].count == 2);
    }

    #[test]
    fn middles_are_spread_evenly() {
        let corners = [DVec3::ZERO, 3.0 * DVec3::X, DVec3::new(0.0, 6.0, 1.0)];
        for parts in [1, 2, 5] {
            let found = middles(corners, parts);
            assert_eq!(found.len(), parts * parts);
            let mean: DVec3 = found.iter().sum::<DVec3>() / found.len() as f64;
            assert!(mean.distance((corners[0] + corners[1] + corners[2]) / 3.0) < 1e-14);
        }
    }

    #[test]
    fn bad_options_are_refused() {
        let (snake, frames) = stack(1.0, &[0.0, 1.0]);
        let refused = |frames: &[Vec<DVec3>], options: ReportOptions| {
            report(&snake, frames, None, &options).unwrap_err().place().to_owned()
        };
        let default = ReportOptions::default();
        assert_eq!(refused(&frames, ReportOptions { tolerance: -1.0, ..default }), "options.tolerance");
        assert_eq!(refused(&frames, ReportOptions { per_arc: 0, ..default }), "options.per_arc");
        assert_eq!(refused(&frames, ReportOptions { distance: Some(0.0), ..default }), "options.distance");
        assert_eq!(refused(&[], default), "frames");
        assert_eq!(refused(&[frames[0].clone(), vec![DVec3::NAN; 4]], default), "frames[1][0]");
    }
}
