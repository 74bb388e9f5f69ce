//! Functions on the reference surface whose level curves are strip boundaries (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012,
//! section 2.1).
//!
//! First the gradient is brought near to the field by a linear least-squares problem. If more is asked for, the Gauss–Newton method
//! goes on from there. The terms are in `level_terms.rs`.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Field;
use super::level_terms::{Jumps, TermWeights, Terms, jump_places};
use super::spherical_image::{ImageKind, ImageReport, SphericalImage};
use crate::error::{Error, Result, Status};
use crate::linalg::gauss_newton::{self, Progress, Residuals, Stop};
use crate::linalg::least_squares::LeastSquares;
use crate::mesh::TriangleMesh;
use crate::mesh::level_curves::critical_points;

/// What is asked of a level function, by weights of 0 or more. All terms are without units: a surface twice as large, or a mesh
/// twice as fine, needs no other weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelWeights {
    /// Boundaries orthogonal to the field: the mean of `‖∇f − a‖²` over the area.
    pub orthogonal: f64,
    /// Boundaries orthogonal to the field, at whatever distances: the mean of the square of the part of `∇f` across `a`. The paper
    /// has no such term; where no function has the field as its gradient it serves where right angles count more than widths.
    pub direction: f64,
    /// Boundaries at constant distances: the mean of `(‖∇f‖ − 1)²`.
    pub equidistant: f64,
    /// Geodesic boundaries: the integral of the squared geodesic curvature `div(∇f/‖∇f‖)`. It is as small for any other function
    /// with the same level curves, so one of the weights above must be positive too.
    pub geodesic: f64,
    /// Boundaries whose rulings are parallel to a plane: the geodesic term on the spherical image. One of the first two weights must
    /// be positive too.
    pub conoidal: f64,
    /// Smoothness: the mean of `(div ∇f)²`, in units of the squared mean edge of the mesh; keep it low.
    pub laplace: f64,
}

impl LevelWeights {
    /// Boundaries orthogonal to the field.
    pub const ORTHOGONAL: Self =
        Self { orthogonal: 1.0, direction: 0.0, equidistant: 0.0, geodesic: 0.0, conoidal: 0.0, laplace: 1e-3 };
    /// Boundaries at right angles to the field, whatever their distances.
    pub const DIRECTION: Self = Self { orthogonal: 1e-3, direction: 1.0, ..Self::ORTHOGONAL };
    /// Boundaries at constant distances.
    pub const EQUIDISTANT: Self = Self { orthogonal: 0.1, equidistant: 1.0, ..Self::ORTHOGONAL };
    /// Geodesic boundaries.
    pub const GEODESIC: Self = Self { orthogonal: 0.05, geodesic: 1.0, ..Self::ORTHOGONAL };
    /// Boundaries of conoidal strips.
    pub const CONOIDAL: Self = Self { orthogonal: 0.05, conoidal: 10.0, ..Self::ORTHOGONAL };
}

/// How a level function is found.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelOptions {
    /// The weights of the terms.
    pub weights: LevelWeights,
    /// The edges across which the field changes its sign, each by its two points. If there are any, `a` and `−a` count as the same
    /// (of `∇f − a` only the part across `a`), and the weight `equidistant` must be above 0, as constants would be best otherwise.
    pub flips: Vec<[u32; 2]>,
    /// Whether a folded spherical image is used nevertheless.
    pub allows_folds: bool,
    /// The most iterations of the Gauss–Newton method.
    pub max_iterations: usize,
    /// It stops where the sum of the terms fell by less than this part of it.
    pub relative_decrease: f64,
}

impl Default for LevelOptions {
    fn default() -> Self {
        Self {
            weights: LevelWeights::ORTHOGONAL,
            flips: Vec::new(),
            allows_folds: false,
            max_iterations: 30,
            relative_decrease: 1e-6,
        }
    }
}

/// A level function.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelFunction {
    /// Its values at the points, in model units: the gradient is about as long as 1. The least is 0.
    pub values: Vec<f64>,
    /// The sum of the terms and so on, at the start and after each iteration of the Gauss–Newton method; empty if the linear
    /// problem is all there was.
    pub history: Vec<Progress>,
    /// Why the iteration stopped; none if there was none.
    pub stop: Option<Stop>,
    /// The points inside around which the function does not rise on one side and fall on the other. Level curves through their
    /// surroundings are no good boundaries.
    pub critical: Vec<u32>,
    /// The least and the greatest length of the gradient on triangles where the field is known.
    pub slope: [f64; 2],
    /// The spherical image, if the conoidal term was asked for. If it has collapsed, there was no such term.
    pub image: Option<ImageReport>,
}

/// Finds a level function for a field. `progress` is called before each Gauss–Newton iteration and can end it: then the best so far
/// comes back.
///
/// # Errors
/// Weights that are negative, not finite, all 0, or without what they need beside them (`options.weights`, `options.weights.name`);
/// an edge of `flips` that the mesh does not have (`options.flips[i]`); a `relative_decrease` that is not 0 or more
/// (`options.relative_decrease`). Status `CurvatureSign`: the field is known nowhere (`field`). `NotOrientable`: the spherical image
/// is folded (`field`).
pub fn level_function(
    mesh: &TriangleMesh,
    field: &Field,
    options: &LevelOptions,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<LevelFunction> {
    let (function, _) = solve(mesh, field, options, &Jumps::default(), progress)?;
    Ok(LevelFunction { critical: critical_points(mesh, &function.values)?, ..function })
}

/// As [`level_function`], for one that jumps across cuts, and by how much it does; its critical points are left to the caller.
pub(super) fn solve(
    mesh: &TriangleMesh,
    field: &Field,
    options: &LevelOptions,
    jumps: &Jumps,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<(LevelFunction, Vec<f64>)> {
    check(mesh, field, options)?;
    let image = image(mesh, field, options)?;
    let uses_image = image.as_ref().is_some_and(|image| is_area(image.report().kind));
    let weights = TermWeights {
        orthogonal: options.weights.orthogonal,
        direction: options.weights.direction,
        equidistant: options.weights.equidistant,
        geodesic: options.weights.geodesic,
        conoidal: if uses_image { options.weights.conoidal } else { 0.0 },
        laplace: options.weights.laplace,
    };
    let is_unoriented = !options.flips.is_empty();
    let linear = TermWeights { equidistant: 0.0, geodesic: 0.0, conoidal: 0.0, ..weights };
    let linear = TermWeights { orthogonal: if weights.orthogonal > 0.0 { weights.orthogonal } else { 1.0 }, ..linear };
    let directions = directions(mesh, field, &options.flips);
    let start = linear_start(mesh, directions.clone(), jumps, linear)?;
    let mut terms =
        Terms::new(mesh, directions.into_iter().map(|a| a.map(|a| a.0)).collect(), jumps, weights, is_unoriented);
    let has_more = weights.equidistant > 0.0 || weights.geodesic > 0.0 || weights.conoidal > 0.0;
    let (mut x, mut history, mut stop) = (start, Vec::new(), None);
    if has_more {
        terms.prepare_bending(&x, image.as_ref().map(|image| &image.metric), jumps);
        let newton = gauss_newton::Options {
            relative_decrease: options.relative_decrease,
            max_iterations: options.max_iterations,
            // Below this part of what it is for f = 0 the sum is round-off.
            value: 1e-28,
            ..Default::default()
        };
        let found = gauss_newton::minimise(&mut terms, &x, &newton, progress)?;
        (x, history, stop) = (found.x, found.history, Some(found.stop));
    }
    let lengths = terms.lengths(&x);
    let slope = [lengths.iter().copied().fold(f64::INFINITY, f64::min), lengths.iter().copied().fold(0.0, f64::max)];
    let places = jump_places(mesh.points().len(), jumps);
    let jump = |(place, value): (&u32, &Option<f64>)| value.unwrap_or_else(|| x[*place as usize]);
    let found_jumps = places.iter().zip(&jumps.values).map(jump).collect();
    x.truncate(mesh.points().len());
    let least = x.iter().copied().fold(f64::INFINITY, f64::min);
    x.iter_mut().for_each(|value| *value -= least);
    let image = image.map(|image| *image.report());
    Ok((LevelFunction { values: x, history, stop, critical: Vec::new(), slope, image }, found_jumps))
}

fn is_area(kind: ImageKind) -> bool {
    matches!(kind, ImageKind::Regular | ImageKind::Folded)
}

fn check(mesh: &TriangleMesh, field: &Field, options: &LevelOptions) -> Result<()> {
    let LevelWeights { orthogonal, direction, equidistant, geodesic, conoidal, laplace } = options.weights;
    let named = [
        ("weights.orthogonal", orthogonal),
        ("weights.direction", direction),
        ("weights.equidistant", equidistant),
        ("weights.geodesic", geodesic),
        ("weights.conoidal", conoidal),
        ("weights.laplace", laplace),
        ("relative_decrease", options.relative_decrease),
    ];
    let refusal = |place: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(place).at("options"));
    if let Some((name, value)) = named.iter().find(|(_, value)| !(*value >= 0.0 && value.is_finite())) {
        return refusal(name, format!("expected a finite number of 0 or more, found {value}"));
    }
    if orthogonal == 0.0 && equidistant == 0.0 {
        let reason =
            "expected a weight of orthogonal or equidistant above 0, without which f may be constant, found none";
        return refusal("weights", reason.into());
    }
    if !options.flips.is_empty() {
        if equidistant == 0.0 {
            let reason = "expected a number above 0 for a field that changes its sign, found 0".into();
            return refusal("weights.equidistant", reason);
        }
        if conoidal > 0.0 {
            let reason = format!("expected 0 for a field that changes its sign, found {conoidal}");
            return refusal("weights.conoidal", reason);
        }
    }
    let mut edges = mesh.edges();
    edges.sort_unstable();
    for (i, &[a, b]) in options.flips.iter().enumerate() {
        if edges.binary_search(&[a.min(b), a.max(b)]).is_err() {
            return refusal(&format!("flips[{i}]"), format!("expected an edge of the mesh, found {a} and {b}"));
        }
    }
    field.check(mesh)?;
    if (0..mesh.triangles().len()).all(|t| field.on_triangle(mesh, t).is_none()) {
        return Err(Error::new(Status::CurvatureSign, "the field is known on no triangle").at("field"));
    }
    Ok(())
}

fn image(mesh: &TriangleMesh, field: &Field, options: &LevelOptions) -> Result<Option<SphericalImage>> {
    if options.weights.conoidal == 0.0 {
        return Ok(None);
    }
    let image = SphericalImage::new(mesh, field)?;
    if image.report().kind == ImageKind::Folded && !options.allows_folds {
        let part = 100.0 * image.report().folded;
        let reason = format!("the spherical image is folded: {part:.1} % of its area has the other orientation");
        return Err(Error::new(Status::NotOrientable, reason).at("field"));
    }
    Ok(Some(image))
}

/// The field on each triangle, and whether its corners agree about the sign. Where they do not, those are turned that differ from
/// the first.
fn directions(mesh: &TriangleMesh, field: &Field, flips: &[[u32; 2]]) -> Vec<Option<(DVec3, bool)>> {
    let mut flips: Vec<[u32; 2]> = flips.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    flips.sort_unstable();
    let is_flip = |a: u32, b: u32| flips.binary_search(&[a.min(b), a.max(b)]).is_ok();
    let direction = |t: usize| {
        let [a, b, c] = mesh.triangles()[t];
        let signs = [1.0, if is_flip(a, b) { -1.0 } else { 1.0 }, if is_flip(a, c) { -1.0 } else { 1.0 }];
        if signs == [1.0; 3] && !is_flip(b, c) {
            return field.on_triangle(mesh, t).map(|a| (a, true));
        }
        let corners = [a, b, c].map(|i| i as usize);
        let is_known = corners.iter().all(|&i| field.is_known()[i]);
        let sum: DVec3 = (0..3).map(|k| signs[k] * field.directions()[corners[k]]).sum();
        let unit = sum.reject_from_normalized(mesh.normal(t)).try_normalize();
        unit.filter(|_| is_known).map(|a| (a, false))
    };
    (0..mesh.triangles().len()).map(direction).collect()
}

/// The minimum of the orthogonal and the Laplace term, which are quadratic. Where the field changes its sign it has no say.
fn linear_start(
    mesh: &TriangleMesh,
    directions: Vec<Option<(DVec3, bool)>>,
    jumps: &Jumps,
    weights: TermWeights,
) -> Result<Vec<f64>> {
    let agreed = directions.into_iter().map(|a| a.filter(|(_, is_agreed)| *is_agreed).map(|(a, _)| a)).collect();
    let mut terms = Terms::new(mesh, agreed, jumps, weights, false);
    let zero = vec![0.0; terms.unknown_count()];
    let mut equations = LeastSquares::new(zero.len());
    terms.linearise(&zero, &mut equations);
    equations.solve()
}
