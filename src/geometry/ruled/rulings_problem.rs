//! Strips as a problem for the solver, so that they can be moved by hand, held, loaded, and weighed against any other constraint.
//!
//! Some rulings of each strip become rows of points with a `Line` each; the points are drawn to the reference mesh by `OnMesh`.
//! Where a strip meets the next, the rulings of that one start where its own end, and the point there is one for both, so that what
//! comes back is watertight. `Closeness` to where the strips have the points, of low weight, keeps them from sliding along the
//! surface, which nothing else resists.

use glam::DVec3;

use super::strip::Strip;
use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::curve::NearestOnCurve;
use crate::problem::{Problem, Reference, Signature};

/// A ruling's end is beside the next strip's boundary, not beyond its end, while the cosine of the angle is below this.
const BESIDE: f64 = 1e-6;

/// Rulings of a strip this near to each other, in spans, are one.
const SAME_RULING: f64 = 1e-6;

/// How strips become a problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RulingsOptions {
    /// Rulings of the first strip, evenly spread over its parameter, at least 2; 21 by default. Other strips have those that
    /// start where these end.
    pub rulings: usize,
    /// Points on each ruling, both ends included, at least 3; 5 by default.
    pub points_per_ruling: usize,
    /// The weight of straight rulings, at least 0; 1 by default.
    pub straight: f64,
    /// Whether rulings must be straight exactly: `Line` as a hard constraint, `straight` its priority. Not by default.
    pub is_straight_hard: bool,
    /// The weight of being on the reference mesh, at least 0; 0.1 by default.
    pub on_reference: f64,
    /// The weight of staying where the strips have the points, at least 0; 1e-3 by default.
    pub closeness: f64,
}

impl Default for RulingsOptions {
    fn default() -> Self {
        Self {
            rulings: 21,
            points_per_ruling: 5,
            straight: 1.0,
            is_straight_hard: false,
            on_reference: 0.1,
            closeness: 1e-3,
        }
    }
}

impl RulingsOptions {
    fn check(&self) -> Result<()> {
        let refuse =
            |name: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(format!("options.{name}")));
        if !(2..=100_000).contains(&self.rulings) {
            return refuse("rulings", format!("expected 2 to 100000, found {}", self.rulings));
        }
        if !(3..=1000).contains(&self.points_per_ruling) {
            return refuse("points_per_ruling", format!("expected 3 to 1000, found {}", self.points_per_ruling));
        }
        let weights = [("straight", self.straight), ("on_reference", self.on_reference), ("closeness", self.closeness)];
        match weights.into_iter().find(|(_, weight)| !(*weight >= 0.0 && weight.is_finite())) {
            Some((name, weight)) => refuse(name, format!("expected at least 0, found {weight}")),
            None => Ok(()),
        }
    }
}

/// A problem, and which of its points are on which ruling.
#[derive(Clone, Debug, PartialEq)]
pub struct RulingsProblem {
    /// The problem: its `faces` are the quads between rulings, its one reference is the mesh.
    pub problem: Problem,
    /// For each strip and each of its rulings, in order, the points from the first boundary to the second.
    pub rulings: Vec<Vec<Vec<u32>>>,
}

/// The problem of keeping the rulings of strips straight and near to `reference`, neighbouring strips together. Strip `i` meets
/// strip `i + 1` with its second boundary.
///
/// # Errors
/// No strip (`strips`), an option out of range (`options.…`). Status `NoIntersection`: fewer than 2 rulings of a strip end beside the
/// next one; the place is that one's, `strips[i]`.
pub fn rulings_problem(strips: &[Strip], reference: &TriangleMesh, options: &RulingsOptions) -> Result<RulingsProblem> {
    options.check()?;
    let Some(first) = strips.first() else {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("strips"));
    };
    let (mut points, mut rulings): (Vec<DVec3>, Vec<Vec<Vec<u32>>>) = (Vec::new(), Vec::new());
    // Where rulings of the strip start, and the point that is there already.
    let mut starts: Vec<(f64, Option<u32>)> =
        first.ruling_parameters(options.rulings).into_iter().map(|u| (u, None)).collect();
    for (i, strip) in strips.iter().enumerate() {
        if i > 0 {
            starts = continued(&points, &rulings[i - 1], strip)?;
            if starts.len() < 2 {
                let reason =
                    format!("expected rulings of strip {} to end beside this one, found {}", i - 1, starts.len());
                return Err(Error::new(Status::NoIntersection, reason).at(format!("strips[{i}]")));
            }
        }
        rulings.push(starts.iter().map(|&start| ruling(&mut points, strip, start, options)).collect());
    }
    let faces = strips.iter().zip(&rulings).flat_map(|(strip, rulings)| quads(strip, rulings)).collect();
    let constraint = |type_name: &str, indices: Vec<u32>, weight: f64, scalars: Option<Vec<f64>>, hard: bool| {
        Signature { type_name: type_name.to_owned(), indices, weight, scalars, hard }
    };
    let mut constraints: Vec<Signature> = rulings
        .iter()
        .flatten()
        .map(|ruling| constraint("Line", ruling.clone(), options.straight, None, options.is_straight_hard))
        .collect();
    for (i, point) in (0..).zip(&points) {
        constraints.push(constraint("OnMesh", vec![i], options.on_reference, Some(vec![0.0]), false));
        let target = Some(point.to_array().to_vec());
        constraints.push(constraint("Closeness", vec![i], options.closeness, target, false));
    }
    constraints.retain(|constraint| constraint.weight > 0.0);
    let problem = Problem {
        points: points.iter().map(DVec3::to_array).collect(),
        references: vec![Reference::Mesh {
            points: reference.points().iter().map(DVec3::to_array).collect(),
            triangles: reference.triangles().to_vec(),
        }],
        constraints,
        faces,
        ..Problem::default()
    };
    problem.check()?;
    Ok(RulingsProblem { problem, rulings })
}

/// The points of the ruling that starts at a parameter, in a point that is there or in a new one.
fn ruling(
    points: &mut Vec<DVec3>,
    strip: &Strip,
    (u, start): (f64, Option<u32>),
    options: &RulingsOptions,
) -> Vec<u32> {
    let [a, b] = strip.ruling(u);
    let count = options.points_per_ruling;
    let at = |k: usize| a.lerp(b, k as f64 / (count - 1) as f64);
    let mut indices = Vec::with_capacity(count);
    if let Some(start) = start {
        // Across a gap the point is half-way.
        points[start as usize] = points[start as usize].midpoint(a);
        indices.push(start);
    }
    for k in indices.len()..count {
        indices.push(points.len() as u32);
        points.push(at(k));
    }
    indices
}

/// Where the rulings of a strip end beside the next strip: parameters there, in order, each with the point.
fn continued(points: &[DVec3], rulings: &[Vec<u32>], next: &Strip) -> Result<Vec<(f64, Option<u32>)>> {
    let curve = NearestOnCurve::new(next.boundary(0))?;
    let mut starts = Vec::with_capacity(rulings.len());
    for end in rulings.iter().filter_map(|ruling| ruling.last().copied()) {
        let foot = curve.nearest(points[end as usize]);
        let is_beyond = foot.end.is_some() && foot.cosine.abs() > BESIDE && foot.distance > BESIDE * size(next);
        if !is_beyond {
            starts.push((foot.parameter, Some(end)));
        }
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.dedup_by(|later, earlier| later.0 - earlier.0 < SAME_RULING);
    Ok(starts)
}

/// The length of a strip's first ruling or of its boundary's chord, whichever is greater.
fn size(strip: &Strip) -> f64 {
    let [[a, b], [c, _]] = [strip.ruling(0.0), strip.ruling(strip.length_u())];
    a.distance(b).max(a.distance(c))
}

/// The quads between neighbouring rulings, of a closed strip between the last and the first too.
fn quads(strip: &Strip, rulings: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let pairs = if strip.basis().is_closed() { rulings.len() } else { rulings.len() - 1 };
    let between = |i: usize| {
        let (a, b) = (&rulings[i], &rulings[(i + 1) % rulings.len()]);
        (0..a.len() - 1).map(|k| vec![a[k], b[k], b[k + 1], a[k + 1]]).collect::<Vec<_>>()
    };
    (0..pairs).flat_map(between).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::trim::tests::straight;
    use crate::mesh::patterns::height_field;
    use crate::solver::{SolveOptions, Solver};

    fn saddle_mesh() -> TriangleMesh {
        TriangleMesh::new(&height_field(21, 21, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()).unwrap()
    }

    /// Strips of z = xy between these y, along x from −1 to 1.
    fn strips(ys: &[f64]) -> Vec<Strip> {
        let at = |x: f64, y: f64| DVec3::new(x, y, x * y);
        let one = |y: &[f64]| straight(5, [at(-1.0, y[0]), at(-1.0, y[1])], [at(1.0, y[0]), at(1.0, y[1])]);
        ys.windows(2).map(one).collect()
    }

    fn solved(problem: &Problem) -> Vec<DVec3> {
        let mut solver = Solver::from_problem(problem).unwrap();
        let options = SolveOptions { max_iterations: 3000, tolerance: 1e-12, time_budget_seconds: 0.0 };
        solver.solve_until(&options, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
        solver.points().to_vec()
    }

    /// How far the points of rulings are from their chords at most.
    fn bend(points: &[DVec3], rulings: &[Vec<Vec<u32>>]) -> f64 {
        let one = |ruling: &Vec<u32>| {
            let [a, b] = [ruling[0], ruling[ruling.len() - 1]].map(|i| points[i as usize]);
            let along = (b - a).normalize();
            ruling.iter().map(|&i| (points[i as usize] - a).reject_from_normalized(along).length()).fold(0.0, f64::max)
        };
        rulings.iter().flatten().map(one).fold(0.0, f64::max)
    }

    #[test]
    fn exact_strips_stay_and_disturbed_ones_come_back_straight() {
        // Rulings at x = −1, −0.9, … are on edges of the mesh: there it is the surface itself.
        let mesh = saddle_mesh();
        let made = rulings_problem(&strips(&[-1.0, -0.2, 0.4, 1.0]), &mesh, &RulingsOptions::default()).unwrap();
        assert_eq!((made.rulings.len(), made.rulings[2].len(), made.problem.references.len()), (3, 21, 1));
        assert_eq!(made.problem.points.len(), 21 * (3 * 5 - 2));
        assert_eq!(made.problem.faces.len(), 3 * 20 * 4);
        let start: Vec<DVec3> = made.problem.points.iter().map(|&p| DVec3::from_array(p)).collect();
        let stays = solved(&made.problem);
        assert!(start.iter().zip(&stays).all(|(a, b)| a.distance(*b) < 1e-9));
        let mut disturbed = made.problem.clone();
        for (i, point) in disturbed.points.iter_mut().enumerate() {
            let t = i as f64;
            let step = [(12.9 * t).sin(), (7.3 * t).cos(), (3.7 * t).sin()].map(|part| 0.02 * part);
            (0..3).for_each(|k| point[k] += step[k]);
        }
        let moved: Vec<DVec3> = disturbed.points.iter().map(|&p| DVec3::from_array(p)).collect();
        let back = solved(&disturbed);
        let bends = [bend(&moved, &made.rulings), bend(&back, &made.rulings)];
        assert!(bends[0] > 0.02 && bends[1] < 1e-6, "{bends:?}");
        // Up to the chords of the mesh, which are up to h²/4 below the surface.
        let off = back.iter().map(|p| (p.z - p.x * p.y).abs()).fold(0.0, f64::max);
        assert!(off < 0.0025, "{off}");
    }

    #[test]
    fn neighbours_share_points_and_rulings_that_end_beyond_are_left() {
        // The second strip is shorter: from x = −0.55 on.
        let at = |x: f64, y: f64| DVec3::new(x, y, x * y);
        let mut all = strips(&[-1.0, 0.0]);
        all.push(straight(6, [at(-0.55, 0.0), at(-0.55, 1.0)], [at(1.0, 0.0), at(1.0, 1.0)]));
        let options = RulingsOptions { is_straight_hard: true, ..RulingsOptions::default() };
        let made = rulings_problem(&all, &saddle_mesh(), &options).unwrap();
        assert_eq!((made.rulings[0].len(), made.rulings[1].len()), (21, 16));
        for (before, after) in made.rulings[0][5..].iter().zip(&made.rulings[1]) {
            assert_eq!(before[4], after[0]);
            let [x, z] = [before[0], after[4]].map(|i| made.problem.points[i as usize][0]);
            assert!((x - z).abs() < 1e-9);
        }
        assert!(made.problem.constraints.iter().all(|c| c.hard == (c.type_name == "Line")));
        let apart =
            [strips(&[-1.0, 0.0]), vec![straight(4, [at(3.0, 0.0), at(3.0, 1.0)], [at(4.0, 0.0), at(4.0, 1.0)])]];
        let error = rulings_problem(&apart.concat(), &saddle_mesh(), &options).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::NoIntersection, "strips[1]"));
    }

    #[test]
    fn bad_options_are_named() {
        let place = |options: RulingsOptions| {
            rulings_problem(&strips(&[-1.0, 1.0]), &saddle_mesh(), &options).unwrap_err().place().to_owned()
        };
        let with = RulingsOptions::default;
        assert_eq!(place(RulingsOptions { rulings: 1, ..with() }), "options.rulings");
        assert_eq!(place(RulingsOptions { points_per_ruling: 2, ..with() }), "options.points_per_ruling");
        assert_eq!(place(RulingsOptions { straight: f64::NAN, ..with() }), "options.straight");
        assert_eq!(place(RulingsOptions { closeness: -1.0, ..with() }), "options.closeness");
        assert_eq!(rulings_problem(&[], &saddle_mesh(), &with()).unwrap_err().place(), "strips");
    }
}
