//! From a mesh to ruled strips, step by step: directions, boundaries, strips to start from, strips that are optimal.

mod draft;

pub use draft::Draft;

use std::ops::ControlFlow;

use glam::DVec3;

use super::asymptotic::{self, AsymptoticDirections};
use super::boundaries::{Boundaries, BoundaryOptions, Drawn, Levels, drawn_boundaries, level_boundaries};
use super::conditions::Condition;
use super::great_circles::great_circle_boundaries;
use super::layout::Layout;
use super::level_function::{LevelFunction, LevelOptions, level_function};
use super::optimise::{self, Optimised, Task, optimise};
use super::periods::{Spacing, periodic_boundaries};
use super::planar_boundaries::{PlanarOptions, Plane, planar_boundaries};
use super::report::{Report, ReportOptions, report};
use super::ruling_ends::RulingEnds;
use super::start::{Rulings, Start, StartOptions, start};
use super::terms::{points_beside, points_to_cover};
use super::{Boundary, Field, Joints, Strip, orientation, planks};
use crate::error::{Error, Result, Status};
use crate::linalg::gauss_newton;
use crate::mesh::reference::ReferenceMesh;
use crate::mesh::{Mesh, ReferenceSurface, TriangleMesh};

/// Points of the mesh that strips are asked to cover: more do not change what is found, and each costs a search.
const MOST_COVERED: usize = 5_000;

/// How the asymptotic directions are found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldOptions {
    /// Curvatures, and which points have no directions.
    pub directions: asymptotic::Options,
    /// Which of the two families rulings follow: 0 or 1, of negative or positive torsion.
    pub family: usize,
    /// The signs of the directions.
    pub orientation: orientation::Options,
}

/// A mesh and the strips that are made of it. Each step needs those before it, and takes back those after it.
#[derive(Clone, Debug)]
pub struct Design {
    mesh: TriangleMesh,
    directions: AsymptoticDirections,
    field: Field,
    flips: Vec<[u32; 2]>,
    function: Option<LevelFunction>,
    boundaries: Boundaries,
    /// Whether boundaries are on both sides of all of the surface.
    is_whole: bool,
    /// The plane of each boundary, if they are plane sections.
    planes: Vec<Option<Plane>>,
    start: Option<Start>,
    strips: Vec<Strip>,
    joints: Joints,
}

impl Design {
    /// The design of a mesh, with the directions of a family.
    ///
    /// # Errors
    /// As [`TriangleMesh::new`], [`AsymptoticDirections::new`] and [`AsymptoticDirections::orient`].
    pub fn new(mesh: &Mesh, options: &FieldOptions) -> Result<Self> {
        let mesh = TriangleMesh::new(mesh)?;
        let directions = AsymptoticDirections::new(&mesh, &options.directions)?;
        let oriented = directions.orient(&mesh, options.family, &options.orientation)?;
        Ok(Self {
            mesh,
            directions,
            field: oriented.field,
            flips: oriented.flips,
            function: None,
            boundaries: Boundaries::default(),
            is_whole: false,
            planes: Vec::new(),
            start: None,
            strips: Vec::new(),
            joints: Joints::default(),
        })
    }

    /// The triangles of the mesh.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Both families of directions.
    pub fn directions(&self) -> &AsymptoticDirections {
        &self.directions
    }

    /// The family that rulings follow.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// The edges across which the field changes its sign.
    pub fn flips(&self) -> &[[u32; 2]] {
        &self.flips
    }

    /// The function whose level curves the boundaries are; none if they are not level curves.
    pub fn function(&self) -> Option<&LevelFunction> {
        self.function.as_ref()
    }

    /// The boundaries, in the order along the field, and the strips between them.
    pub fn boundaries(&self) -> &Boundaries {
        &self.boundaries
    }

    /// The strips that the last step made.
    pub fn strips(&self) -> &[Strip] {
        &self.strips
    }

    /// Which strips are neighbours.
    pub fn joints(&self) -> &Joints {
        &self.joints
    }

    /// What was found when strips were started.
    pub fn started(&self) -> Option<&Start> {
        self.start.as_ref()
    }

    /// Takes the directions of another family, or of other signs, and takes back what was made with those before.
    ///
    /// # Errors
    /// As [`AsymptoticDirections::orient`].
    pub fn orient(&mut self, family: usize, options: &orientation::Options) -> Result<()> {
        let oriented = self.directions.orient(&self.mesh, family, options)?;
        (self.field, self.flips) = (oriented.field, oriented.flips);
        self.take(Boundaries::default(), Vec::new(), None, false);
        Ok(())
    }

    /// Takes level curves of a function as boundaries; on a surface with holes, of one that may jump by a multiple of the levels'
    /// distance around each. A surface with handles is refused (`mesh`). The edges where the field flips are added to those of `function`.
    ///
    /// # Errors
    /// As [`level_function`](fn@level_function) and [`level_boundaries`], or [`periodic_boundaries`] on a surface with holes, where levels cannot be
    /// given by their values (`levels`).
    pub fn set_level_boundaries(
        &mut self,
        function: &LevelOptions,
        levels: &Levels,
        options: &BoundaryOptions,
        progress: &mut dyn FnMut(&gauss_newton::Progress) -> ControlFlow<()>,
    ) -> Result<()> {
        let mut function = function.clone();
        function.flips.extend(&self.flips);
        let (function, boundaries) = if has_periods(&self.mesh) {
            let spacing = match levels {
                Levels::Count(count) => Spacing::Count(*count),
                Levels::Width(width) => Spacing::Width(*width),
                Levels::Values(_) => {
                    let reason = "expected a count or a width, as values mean nothing around a hole; found values";
                    return Err(Error::new(Status::InvalidValue, reason).at("levels"));
                }
            };
            let found = periodic_boundaries(&self.mesh, &self.field, &function, spacing, options, progress)?;
            (found.function, found.boundaries)
        } else {
            let found = level_function(&self.mesh, &self.field, &function, progress)?;
            let boundaries = level_boundaries(&self.mesh, &self.field, &found.values, levels, options)?;
            (found, boundaries)
        };
        self.take(boundaries, Vec::new(), Some(function), options.overshoots);
        Ok(())
    }

    /// Takes other level curves of the function found before as boundaries.
    ///
    /// # Errors
    /// As [`level_boundaries`]. Status `NotInitialised`: there is no function (`levels`). `InvalidValue`: the surface has holes, around
    /// which the function goes with the distance of levels, and is to be found anew (`levels`).
    pub fn set_levels(&mut self, levels: &Levels, options: &BoundaryOptions) -> Result<()> {
        let Some(function) = &self.function else {
            let reason = "expected levels of a function found before, but there is none yet";
            return Err(Error::new(Status::NotInitialised, reason).at("levels"));
        };
        if self.mesh.boundary().len() > 1 {
            let reason = "around a hole the function goes with the distance of levels: find it anew";
            return Err(Error::new(Status::InvalidValue, reason).at("levels"));
        }
        let boundaries = level_boundaries(&self.mesh, &self.field, &function.values, levels, options)?;
        let function = self.function.take();
        self.take(boundaries, Vec::new(), function, options.overshoots);
        Ok(())
    }

    /// Takes plane sections as boundaries; gives the least angles at which they cross the field, for each plane.
    ///
    /// # Errors
    /// As [`planar_boundaries`].
    pub fn set_planar_boundaries(&mut self, planes: &[Plane], options: &PlanarOptions) -> Result<Vec<f64>> {
        let found = planar_boundaries(&self.mesh, &self.field, planes, options)?;
        self.take(found.boundaries, found.planes, None, options.boundaries.overshoots);
        Ok(found.angles_rad)
    }

    /// Takes the curves as boundaries along which the field is orthogonal to one of these axes each.
    ///
    /// # Errors
    /// As [`great_circle_boundaries`].
    pub fn set_great_circle_boundaries(&mut self, axes: &[DVec3], options: &BoundaryOptions) -> Result<()> {
        let boundaries = great_circle_boundaries(&self.mesh, &self.field, axes, options)?;
        self.take(boundaries, Vec::new(), None, options.overshoots);
        Ok(())
    }

    /// Takes curves drawn by hand as boundaries.
    ///
    /// # Errors
    /// As [`drawn_boundaries`].
    pub fn set_drawn_boundaries(&mut self, curves: &[Drawn], options: &BoundaryOptions) -> Result<()> {
        let boundaries = drawn_boundaries(&ReferenceMesh::new(&self.mesh), &self.field, curves, options)?;
        self.take(boundaries, Vec::new(), None, false);
        Ok(())
    }

    fn take(
        &mut self,
        boundaries: Boundaries,
        planes: Vec<Option<Plane>>,
        function: Option<LevelFunction>,
        is_whole: bool,
    ) {
        self.boundaries = boundaries;
        self.is_whole = is_whole;
        self.planes = planes;
        self.function = function;
        self.start = None;
        self.strips.clear();
        self.joints = Joints::default();
    }

    /// Makes strips between the boundaries, their rulings along asymptotic curves.
    ///
    /// # Errors
    /// As [`start`](fn@start). Status `NoSolution`: there are no boundaries with strips between them (`boundaries`).
    pub fn start(&mut self, options: StartOptions) -> Result<()> {
        if self.boundaries.strips.is_empty() {
            let reason = "expected boundaries with a strip between two of them at least, found none";
            return Err(Error::new(Status::NoSolution, reason).at("boundaries"));
        }
        let reference = ReferenceMesh::new(&self.mesh);
        let mut found = Start { strips: Vec::new(), missed: Vec::new(), moved: Vec::new() };
        let mut joints = Joints { is_shared: options.is_shared, ..Joints::default() };
        for chain in chains(&self.boundaries.strips) {
            let along: Vec<&Boundary> = chain.iter().map(|&k| &self.boundaries.boundaries[k]).collect();
            let ends = RulingEnds::new(&reference, &self.field, &along)?;
            let points: Vec<Vec<DVec3>> = along.iter().map(|boundary| boundary.points.clone()).collect();
            let is_closed: Vec<bool> = along.iter().map(|boundary| boundary.is_closed).collect();
            let first = found.strips.len();
            let traced = |strip: usize, point: DVec3| ends.end(strip, point);
            let made = start(&points, &is_closed, Rulings::Traced(&traced), options)?;
            let count = made.strips.len();
            joints.pairs.extend((1..count).map(|i| [first + i - 1, first + i]));
            if count > 1 && chain[0] == chain[count] {
                joints.pairs.push([first + count - 1, first]);
            }
            found.strips.extend(made.strips);
            found.missed.extend(made.missed);
            found.moved.extend(made.moved);
        }
        let sides = self.chained_sides();
        let strip_at = |boundary: usize, side: usize| {
            sides.iter().find(|found| (found.1, found.2) == (side, boundary)).map(|found| found.0)
        };
        let meets =
            self.boundaries.meets.iter().filter_map(|&[end, start]| Some([strip_at(end, 1)?, strip_at(start, 0)?]));
        joints.partial = meets.collect();
        self.strips.clone_from(&found.strips);
        self.joints = joints;
        self.start = Some(found);
        Ok(())
    }

    /// Takes strips from elsewhere. Where they are as many as before, and open or closed as those, they are neighbours as before;
    /// otherwise each joins the next, and planes of boundaries are forgotten.
    ///
    /// # Errors
    /// No strips, or strips that cannot be neighbours (`strips`, `joints.pairs[k]`).
    pub fn set_strips(&mut self, strips: Vec<Strip>) -> Result<()> {
        let kinds = |strips: &[Strip]| strips.iter().map(|strip| strip.basis().is_closed()).collect::<Vec<_>>();
        let is_alike = kinds(&strips) == kinds(&self.strips);
        let joints = if is_alike { self.joints.clone() } else { Joints::chain(strips.len()) };
        Layout::new(&strips, &joints)?;
        if !is_alike {
            self.planes.clear();
        }
        (self.strips, self.joints) = (strips, joints);
        Ok(())
    }

    /// Moves the control points of a strip; shared boundaries of its neighbours go along.
    ///
    /// # Errors
    /// There is no such strip (`strip`), or not as many control points of both boundaries as it has, finite ones (`control[side]`,
    /// `control[side][i]`).
    pub fn set_control(&mut self, strip: usize, control: [Vec<DVec3>; 2]) -> Result<()> {
        let mut strips = self.strips.clone();
        let Some(of) = strips.get_mut(strip) else {
            let reason = format!("{strip} is out of range for {} strips", self.strips.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("strip"));
        };
        *of = Strip::new(of.basis().clone(), control.clone())?;
        for &[first, second] in self.joints.pairs.iter().filter(|_| self.joints.is_shared) {
            if first == strip {
                let own = strips[second].control(1).to_vec();
                strips[second] = Strip::new(strips[second].basis().clone(), [control[1].clone(), own])?;
            } else if second == strip {
                let own = strips[first].control(0).to_vec();
                strips[first] = Strip::new(strips[first].basis().clone(), [own, control[0].clone()])?;
            }
        }
        self.strips = strips;
        Ok(())
    }

    /// The strips beside a boundary, each with the side that it has there.
    pub fn sides_of(&self, boundary: usize) -> Vec<(usize, usize)> {
        let sides = self.chained_sides().into_iter().filter(|side| side.2 == boundary);
        sides.map(|(strip, side, _)| (strip, side)).filter(|(strip, _)| *strip < self.strips.len()).collect()
    }

    /// The plane that a boundary was cut by, if it was.
    pub fn plane_of(&self, boundary: usize) -> Option<Plane> {
        *self.planes.get(boundary)?
    }

    /// The conditions that keep boundaries in the planes that they were cut by; none if they were not.
    pub fn planar_conditions(&self) -> Vec<Condition> {
        let sides = self.chained_sides();
        let planes = sides.into_iter().filter_map(|(strip, side, boundary)| {
            let Plane { normal, offset } = (*self.planes.get(boundary)?)?;
            Some(Condition::PlanarBoundary { strip, side, normal, offset })
        });
        planes.collect()
    }

    /// The conditions that make each strip a conoid about the axis that its rulings have now, with the greatest angle in degrees
    /// by which they are off it.
    ///
    /// # Errors
    /// Status `Degenerate`: all rulings of a strip are parallel (`strips[i]`).
    pub fn conoidal_conditions(&self) -> Result<(Vec<Condition>, f64)> {
        let mut worst = 0.0_f64;
        let mut conditions = Vec::with_capacity(self.strips.len());
        for (strip, of) in self.strips.iter().enumerate() {
            let axis = planks::axis(of).map_err(|error| error.with_place(format!("strips[{strip}]")))?;
            worst = worst.max(axis.deviation_deg);
            conditions.push(Condition::Conoidal { strip, axis: axis.direction });
        }
        Ok((conditions, worst))
    }

    /// For each strip both sides: the strip, the side, the boundary.
    fn chained_sides(&self) -> Vec<(usize, usize, usize)> {
        let chains = chains(&self.boundaries.strips);
        let pairs = chains.iter().flat_map(|chain| chain.windows(2));
        pairs.enumerate().flat_map(|(strip, pair)| [(strip, 0, pair[0]), (strip, 1, pair[1])]).collect()
    }

    /// Brings the strips as near as they come to the reference and to each other: to the mesh, or to `surface`, the surface that it
    /// is a mesh of. What was found is returned; the strips of the design are those that it holds.
    ///
    /// # Errors
    /// As [`optimise`](fn@optimise).
    pub fn optimise(
        &mut self,
        surface: Option<&dyn ReferenceSurface>,
        conditions: &[Condition],
        options: &optimise::Options,
        progress: &mut dyn FnMut(&optimise::Progress) -> ControlFlow<()>,
    ) -> Result<Optimised> {
        let mesh = ReferenceMesh::new(&self.mesh);
        let reference = surface.unwrap_or(&mesh);
        // Where strips are to end before the rim, what is beyond must not draw them there.
        let cover = if self.is_whole {
            points_to_cover(&self.mesh, MOST_COVERED)
        } else {
            points_beside(&self.strips, &self.mesh, MOST_COVERED)
        };
        let task = Task { strips: &self.strips, joints: &self.joints, reference, cover: &cover, conditions };
        let found = optimise(task, options, progress)?;
        self.strips.clone_from(&found.strips);
        Ok(found)
    }

    /// Judges the strips. Those that are neighbours are those of the design, whatever `options.joints` says.
    ///
    /// # Errors
    /// As [`report`](fn@report).
    pub fn report(&self, surface: Option<&dyn ReferenceSurface>, options: &ReportOptions) -> Result<Report> {
        let mesh = ReferenceMesh::new(&self.mesh);
        let joints = self.joints.pairs.iter().chain(&self.joints.partial).copied().collect();
        let options = ReportOptions { joints: Some(joints), ..options.clone() };
        report(&self.strips, &mesh, surface.unwrap_or(&mesh), &options)
    }
}

/// Whether a part of a mesh is no disk: a function whose gradient is given may then jump around its holes or handles.
fn has_periods(mesh: &TriangleMesh) -> bool {
    mesh.points().len() + mesh.triangles().len() != mesh.edges().len() + mesh.components().1
}

/// Boundaries that strips lead from one to the next; a ring has its first again at its end.
fn chains(strips: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut chains: Vec<Vec<usize>> = Vec::new();
    for &[from, to] in strips {
        match chains.last_mut().filter(|chain| chain.last() == Some(&from)) {
            Some(chain) => chain.push(to),
            None => chains.push(vec![from, to]),
        }
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::parametric_surface;
    use crate::mesh::surfaces;

    fn quiet<P>(_: &P) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    #[test]
    fn strips_follow_each_other() {
        assert_eq!(chains(&[[0, 1], [1, 2], [3, 4]]), [vec![0, 1, 2], vec![3, 4]]);
        assert_eq!(chains(&[[0, 1], [1, 2], [2, 0]]), [vec![0, 1, 2, 0]]);
        assert!(chains(&[]).is_empty());
    }

    #[test]
    fn holes_and_handles_have_periods() {
        let grid = |closed: [bool; 2]| {
            let torus = surfaces::torus(3.0, 1.0);
            let at = |k: usize| torus(0.5 * (k % 12) as f64, 0.5 * (k / 12) as f64).point;
            crate::mesh::grid::Grid::new((0..144).map(at).collect(), 12, 12, closed).unwrap().mesh()
        };
        let mut torn = grid([true, true]);
        torn.faces.remove(50);
        let with = |mesh: &Mesh| has_periods(&TriangleMesh::new(mesh).unwrap());
        assert!(!with(&grid([false, false])) && with(&grid([true, false])) && with(&grid([true, true])));
        // One boundary, but no disk.
        assert!(TriangleMesh::new(&torn).unwrap().boundary().len() == 1 && with(&torn));
        let error = super::super::cuts::cuts(&TriangleMesh::new(&torn).unwrap()).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Infeasible, "mesh"));
    }

    #[test]
    fn strips_cover_a_free_form_whose_levels_split_at_the_rim() {
        let surface = surfaces::bent_saddle(0.1);
        let mesh = parametric_surface(41, 41, [-1.0, 1.0], [-0.8, 0.8], |x, y| surface(x, y).point).unwrap();
        for (family, is_shared) in [(0, false), (1, false), (1, true)] {
            let mut design = Design::new(&mesh, &FieldOptions { family, ..FieldOptions::default() }).unwrap();
            let (levels, options) = (Levels::Count(10), BoundaryOptions::default());
            design.set_level_boundaries(&LevelOptions::default(), &levels, &options, &mut quiet).unwrap();
            assert!(design.boundaries().check().is_ok() && design.boundaries().dropped.len() < 5);
            design.start(StartOptions { control_count: 16, is_shared }).unwrap();
            assert_eq!(design.joints().partial.is_empty(), design.boundaries().meets.is_empty());
            assert!(family == 0 || design.joints().partial.len() == 4);
            let started = design.report(None, &ReportOptions::default()).unwrap();
            let found = design.optimise(None, &[], &optimise::Options::default(), &mut quiet).unwrap();
            let report = design.report(None, &ReportOptions::default()).unwrap();
            assert!(started.coverage > 0.999 && report.coverage > 0.9999, "{} {}", started.coverage, report.coverage);
            assert!(report.overlap < 1e-3 && report.max_gap < 1e-3, "{} {}", report.overlap, report.max_gap);
            // The chords of the mesh are off by 4e-4.
            assert!(report.strips_to_reference.max < 8e-4, "{}", report.strips_to_reference.max);
            assert!(found.stop == optimise::Stop::Converged && found.history.len() <= 20, "{}", found.history.len());
        }
    }

    #[test]
    fn a_saddle_becomes_strips_that_cover_it() {
        let saddle = surfaces::saddle();
        let mesh = parametric_surface(31, 31, [-1.0, 1.0], [-1.0, 1.0], |x, y| saddle(x, y).point).unwrap();
        for family in [0, 1] {
            let mut design = Design::new(&mesh, &FieldOptions { family, ..FieldOptions::default() }).unwrap();
            let (levels, options) = (Levels::Count(4), BoundaryOptions::default());
            design.set_level_boundaries(&LevelOptions::default(), &levels, &options, &mut quiet).unwrap();
            design.set_levels(&Levels::Count(2), &options).unwrap();
            assert!(design.boundaries().boundaries.len() == 4 && design.function().is_some());
            design.set_levels(&levels, &options).unwrap();
            assert!(design.start(StartOptions::default()).is_ok());
            let found = design.optimise(None, &[], &optimise::Options::default(), &mut quiet).unwrap();
            assert!(found.history.windows(2).all(|pair| pair[1].value < pair[0].value));
            let report = design.report(None, &ReportOptions::default()).unwrap();
            let diagonal = design.mesh().diagonal();
            // Rulings are straight on a saddle: what is left is the mesh's chord error, a quarter of the squared edge.
            assert!(report.coverage > 0.9999 && report.overlap < 1e-3, "{} {}", report.coverage, report.overlap);
            assert!(
                report.strips_to_reference.max < 1.2e-3 * diagonal,
                "{}",
                report.strips_to_reference.max / diagonal
            );
            assert!(
                report.reference_to_strips.max < 1.2e-3 * diagonal,
                "{}",
                report.reference_to_strips.max / diagonal
            );
            assert!(report.max_gap < 1e-3 * diagonal, "{}", report.max_gap / diagonal);
        }
    }

    #[test]
    fn steps_out_of_order_and_spheres_are_refused() {
        let sphere = surfaces::sphere(1.0);
        let mesh = parametric_surface(12, 12, [0.0, 1.0], [-0.5, 0.5], |u, v| sphere(u, v).point).unwrap();
        let refused = Design::new(&mesh, &FieldOptions::default()).unwrap_err();
        assert_eq!(refused.status(), Status::CurvatureSign);
        let saddle = surfaces::saddle();
        let mesh = parametric_surface(12, 12, [-1.0, 1.0], [-1.0, 1.0], |x, y| saddle(x, y).point).unwrap();
        let mut design = Design::new(&mesh, &FieldOptions::default()).unwrap();
        assert_eq!(design.start(StartOptions::default()).unwrap_err().place(), "boundaries");
        let refused = design.optimise(None, &[], &optimise::Options::default(), &mut quiet).unwrap_err();
        assert_eq!(refused.place(), "strips");
    }
}
