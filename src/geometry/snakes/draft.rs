//! A snake together with what it moves on, what it is to do, and what was found of it last: what a program in another language holds.

use std::ops::ControlFlow;

use glam::DVec3;

use super::arc_list::ArcList;
use super::covering::{flat_lamellae, lamella};
use super::cycle::{self, Motion, cycle};
use super::evolution::{self, Direction, Evolution, Stop, Task, evolve};
use super::freedoms::{Freedoms, freedoms, freedoms_on_surface};
use super::functionals::{Row, near_plane, near_vector};
use super::projection::{self, Projected, project};
use super::rails::{self, Rail};
use super::report::{self, Reference, Report, ReportOptions};
use super::sweep::swept_grid;
use super::velocity::Admissible;
use super::{Congruence, Linkage, Snake, congruence};
use crate::error::{Error, Result, Status, finite};
use crate::mesh::ReferenceSurface;
use crate::mesh::curve::{NearestOnCurve, Spline};
use crate::mesh::grid::{Grid, check_finite};
use crate::mesh::reference::ReferenceMesh;
use crate::problem::json;

mod surface;

pub use surface::{NamedSurface, Surface, SurfaceKind};

/// What a rail does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// A control point runs along it with a speed, in lengths of the curve's chords per time.
    Driven {
        /// The control point.
        point: u32,
        /// The speed; below 0 against the order of the curve's points.
        speed: f64,
    },
    /// A control point keeps its distance from that of the rail `leader`, a driven one that came before.
    Following {
        /// The control point.
        point: u32,
        /// The rail.
        leader: usize,
    },
    /// The snake stays in touch with it; where is free.
    Gliding {
        /// The contact point where they meet at the start.
        contact: u32,
    },
}

/// A rail: the spline through given points, and what it does. A run begins at its point that is nearest to the snake's.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// The curve.
    pub curve: Spline,
    /// What it does.
    pub role: Role,
}

/// How lamellae stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stand {
    /// In the planes of the arcs, one for each.
    Flat,
    /// Along the normals of the surface, one for the snake.
    Normal,
    /// In one direction, one for the snake.
    Along(DVec3),
}

/// Positions that were found.
#[derive(Clone, Debug, PartialEq)]
pub enum Track {
    /// Of an evolution.
    Evolution(Evolution),
    /// Of the motion of a linkage.
    Cycle(Motion),
}

/// A snake in work. What was found of it is forgotten when it is put elsewhere.
#[derive(Clone, Debug)]
pub struct Draft {
    snake: Snake,
    surface: Option<Surface>,
    direction: Direction,
    speeds: Vec<f64>,
    fixed: Vec<u32>,
    wishes: Vec<Row>,
    guides: Vec<Guide>,
    track: Option<Track>,
}

impl Draft {
    /// A snake alone.
    pub fn new(snake: Snake) -> Self {
        let (direction, speeds) = (Direction::Free, vec![1.0]);
        Self { snake, surface: None, direction, speeds, fixed: vec![], wishes: vec![], guides: vec![], track: None }
    }

    /// The snake.
    pub fn snake(&self) -> &Snake {
        &self.snake
    }

    /// Puts the control points elsewhere; they need not keep the distances.
    ///
    /// # Errors
    /// As [`Snake::moved`].
    pub fn set_control(&mut self, control: Vec<DVec3>) -> Result<()> {
        self.snake = self.snake.moved(control)?;
        self.track = None;
        Ok(())
    }

    /// The surface.
    pub fn surface(&self) -> Option<&Surface> {
        self.surface.as_ref()
    }

    /// Takes a surface, or none.
    pub fn set_surface(&mut self, surface: Option<Surface>) {
        self.surface = surface;
    }

    /// Takes the direction in which the snake is to move.
    ///
    /// # Errors
    /// One of no length, or not finite (`direction`).
    pub fn set_direction(&mut self, direction: Direction) -> Result<()> {
        if let Direction::Along(along) = direction
            && !(along.is_finite() && along.try_normalize().is_some())
        {
            let reason = format!("expected a direction of finite length above 0, found {along}");
            return Err(Error::new(Status::InvalidValue, reason).at("direction"));
        }
        self.direction = direction;
        Ok(())
    }

    /// Takes one speed for all control points, or one for each.
    ///
    /// # Errors
    /// Another count, or one that is not finite (`speeds`, `speeds[i]`).
    pub fn set_speeds(&mut self, speeds: Vec<f64>) -> Result<()> {
        let count = self.snake.control().len();
        if speeds.len() != 1 && speeds.len() != count {
            let reason = format!("expected 1, or {count}, one for each control point, found {}", speeds.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("speeds"));
        }
        for (i, &speed) in speeds.iter().enumerate() {
            finite(&format!("speeds[{i}]"), speed)?;
        }
        self.speeds = speeds;
        Ok(())
    }

    /// Takes the control points that stay.
    ///
    /// # Errors
    /// One that does not exist, or comes twice (`fixed[k]`).
    pub fn set_fixed(&mut self, fixed: Vec<u32>) -> Result<()> {
        for (k, &i) in fixed.iter().enumerate() {
            self.check_point(&format!("fixed[{k}]"), i)?;
            if fixed[..k].contains(&i) {
                let reason = format!("expected each control point once, found {i} again");
                return Err(Error::new(Status::InvalidValue, reason).at(format!("fixed[{k}]")));
            }
        }
        self.fixed = fixed;
        Ok(())
    }

    fn check_point(&self, place: &str, i: u32) -> Result<()> {
        let count = self.snake.control().len();
        if (i as usize) < count {
            return Ok(());
        }
        let reason = format!("{i} is out of range for {count} control points");
        Err(Error::new(Status::IndexOutOfRange, reason).at(place))
    }

    /// Wishes a velocity of a control point.
    ///
    /// # Errors
    /// No such point, numbers that are not finite, a negative weight (`point`, `velocity`, `weight`).
    pub fn wish_velocity(&mut self, point: u32, velocity: DVec3, weight: f64) -> Result<()> {
        self.check_wish(point, "velocity", velocity, weight)?;
        self.wishes.extend(near_vector(point as usize, velocity, weight));
        Ok(())
    }

    /// Wishes that a control point moves in a plane with this normal, of any length above 0.
    ///
    /// # Errors
    /// No such point, numbers that are not finite, a normal of no length, a negative weight (`point`, `normal`, `weight`).
    pub fn wish_plane(&mut self, point: u32, normal: DVec3, weight: f64) -> Result<()> {
        self.check_wish(point, "normal", normal, weight)?;
        let Some(normal) = normal.try_normalize() else {
            let reason = format!("expected a direction of finite length above 0, found {normal}");
            return Err(Error::new(Status::InvalidValue, reason).at("normal"));
        };
        self.wishes.push(near_plane(point as usize, normal, weight));
        Ok(())
    }

    fn check_wish(&self, point: u32, name: &str, vector: DVec3, weight: f64) -> Result<()> {
        self.check_point("point", point)?;
        check_finite(name, &[vector]).map_err(|error| error.with_place(name))?;
        if weight >= 0.0 && weight.is_finite() {
            return Ok(());
        }
        let reason = format!("expected a finite number of 0 or more, found {weight}");
        Err(Error::new(Status::InvalidValue, reason).at("weight"))
    }

    /// Takes all wishes away.
    pub fn clear_wishes(&mut self) {
        self.wishes.clear();
    }

    /// The rails.
    pub fn guides(&self) -> &[Guide] {
        &self.guides
    }

    /// Adds a rail, the spline through points, and gives its number.
    ///
    /// # Errors
    /// As [`Spline::through`]; a control point that does not exist or that another rail has (`point`), such a contact (`contact`), a
    /// leader that is no driven rail (`leader`), a speed that is not finite (`speed`), a curve that does not pass the snake there
    /// (`points`). Status `Degenerate`: a gliding rail along the snake (`points`).
    pub fn add_rail(&mut self, points: &[DVec3], is_closed: bool, role: Role) -> Result<usize> {
        let guide = Guide { curve: Spline::through(points, is_closed)?, role };
        if let Role::Driven { point, .. } | Role::Following { point, .. } = role {
            let is_taken = |guide: &Guide| match guide.role {
                Role::Driven { point: own, .. } | Role::Following { point: own, .. } => own == point,
                Role::Gliding { .. } => false,
            };
            if self.guides.iter().any(is_taken) {
                let reason = format!("expected a control point that no other rail drives, found {point}");
                return Err(Error::new(Status::InvalidValue, reason).at("point"));
            }
        }
        let k = self.guides.len();
        self.guides.push(guide);
        let checked = self.rails().and_then(|rails| rails::start(&self.snake, &rails));
        match checked {
            Ok(_) => Ok(k),
            Err(error) => {
                self.guides.pop();
                let own = format!("rails[{k}]");
                let place = match error.place().strip_prefix(&own) {
                    Some("") => "points".to_owned(),
                    Some(field) => field.trim_start_matches('.').to_owned(),
                    // Another one, as the snake moved since it was added.
                    None => error.place().to_owned(),
                };
                Err(error.with_place(place))
            }
        }
    }

    /// Takes all rails away.
    pub fn clear_rails(&mut self) {
        self.guides.clear();
    }

    fn rails(&self) -> Result<Vec<Rail<'_>>> {
        let contacts = self.snake.contacts();
        self.guides.iter().enumerate().map(|(k, guide)| self.rail(k, guide, &contacts)).collect()
    }

    fn rail<'a>(&self, k: usize, guide: &'a Guide, contacts: &[DVec3]) -> Result<Rail<'a>> {
        let (points, field, i) = match guide.role {
            Role::Driven { point, .. } | Role::Following { point, .. } => (self.snake.control(), "point", point),
            Role::Gliding { contact } => (contacts, "contact", contact),
        };
        let Some(&at) = points.get(i as usize) else {
            let what = if field == "point" { "control" } else { "contact" };
            let reason = format!("{i} is out of range for {} {what} points", points.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("rails[{k}].{field}")));
        };
        let nearest = NearestOnCurve::new(&guide.curve).map_err(|error| error.with_place(format!("rails[{k}]")))?;
        let (curve, start) = (&guide.curve, nearest.nearest(at).parameter);
        Ok(match guide.role {
            Role::Driven { point, speed } => Rail::Driven { point, curve, start, speed },
            Role::Following { point, leader } => Rail::Following { point, curve, start, leader },
            Role::Gliding { contact } => Rail::Gliding { contact, curve, start },
        })
    }

    /// Calls `call` with what the snake is to do.
    fn with_task<T>(&self, call: impl FnOnce(&Task<'_>) -> Result<T>) -> Result<T> {
        let rails = self.rails()?;
        let ask = |surface: Option<&dyn ReferenceSurface>| {
            let (snake, direction, speeds, fixed) = (&self.snake, self.direction, &self.speeds[..], &self.fixed[..]);
            call(&Task { snake, surface, direction, speeds, fixed, rails: &rails, wishes: &self.wishes })
        };
        match &self.surface {
            Some(surface) => surface.with(|surface| ask(Some(surface))),
            None => ask(None),
        }
    }

    /// In how many ways the snake can move in space, or on its surface.
    ///
    /// # Errors
    /// As [`freedoms`]; there is no surface (`surface`).
    pub fn freedoms(&self, on_surface: bool) -> Result<Freedoms> {
        if !on_surface {
            return freedoms(&self.snake);
        }
        let normals: Vec<DVec3> = self
            .needed_surface()?
            .with(|surface| self.snake.control().iter().map(|&point| surface.nearest(point).normal).collect());
        freedoms_on_surface(&self.snake, &normals)
    }

    fn needed_surface(&self) -> Result<&Surface> {
        self.surface.as_ref().ok_or_else(|| {
            Error::new(Status::NotInitialised, "expected a surface of the snake, found none").at("surface")
        })
    }

    /// The largest distance of a contact point or the middle of an arc from the surface.
    ///
    /// # Errors
    /// There is no surface (`surface`).
    pub fn deviation(&self) -> Result<f64> {
        let points = self.snake.contacts().into_iter().chain(self.snake.arcs().into_iter().map(|arc| arc.point(0.5)));
        let surface = self.needed_surface()?;
        Ok(surface.with(|surface| points.map(|p| surface.nearest(p).point.distance(p)).fold(0.0, f64::max)))
    }

    /// The velocities with which an evolution begins.
    ///
    /// # Errors
    /// As [`evolution::velocity`].
    pub fn velocity(&self, options: &evolution::Options) -> Result<Admissible> {
        self.with_task(|task| evolution::velocity(task, options))
    }

    /// Puts the snake to the nearest position to a target, one point for each control point. Fixed points stay at their targets.
    ///
    /// # Errors
    /// As [`project`].
    pub fn project(&mut self, target: &[DVec3], options: &projection::Options) -> Result<Projected> {
        let task = projection::Task { fixed: &self.fixed, ..projection::Task::new(&self.snake, target) };
        let found = project(&task, options)?;
        check_numbers(&[found.residual, found.moved])?;
        self.snake = found.snake.clone();
        self.track = None;
        Ok(found)
    }

    /// Moves the snake; the draft keeps the start, and the track that was found.
    ///
    /// # Errors
    /// As [`evolve`].
    pub fn evolve(
        &mut self,
        options: &evolution::Options,
        progress: &mut dyn FnMut(&evolution::Progress<'_>) -> ControlFlow<()>,
    ) -> Result<&Evolution> {
        let found = self.with_task(|task| evolve(task, options, progress))?;
        for frame in &found.frames {
            check_numbers(&frame.figures())?;
        }
        if let Stop::Deviation(by) | Stop::RailEnd { distance: by, .. } = found.stop {
            check_numbers(&[by])?;
        }
        match self.track.insert(Track::Evolution(found)) {
            Track::Evolution(found) => Ok(found),
            Track::Cycle(_) => Err(nothing()),
        }
    }

    /// Moves the snake as a linkage, on hinges at its end arcs.
    ///
    /// # Errors
    /// As [`Linkage::new`] and [`cycle()`].
    pub fn cycle(
        &mut self,
        options: &cycle::Options,
        progress: &mut dyn FnMut(&cycle::Progress) -> ControlFlow<()>,
    ) -> Result<&Motion> {
        let found = cycle(&self.linkage()?, options, progress)?;
        check_numbers(&[found.residual, found.closing.unwrap_or(0.0)])?;
        match self.track.insert(Track::Cycle(found)) {
            Track::Cycle(found) => Ok(found),
            Track::Evolution(_) => Err(nothing()),
        }
    }

    /// The snake on hinges.
    ///
    /// # Errors
    /// As [`Linkage::new`].
    pub fn linkage(&self) -> Result<Linkage> {
        Linkage::new(self.snake.clone())
    }

    /// What was found last.
    ///
    /// # Errors
    /// Status `NotInitialised`: nothing since the snake was put where it is.
    pub fn track(&self) -> Result<&Track> {
        self.track.as_ref().ok_or_else(nothing)
    }

    /// The evolution that was found last.
    ///
    /// # Errors
    /// Status `NotInitialised`: there was none since the snake was put where it is, or a motion as a linkage came after it.
    pub fn evolution(&self) -> Result<&Evolution> {
        match self.track()? {
            Track::Evolution(evolution) => Ok(evolution),
            Track::Cycle(_) => Err(nothing()),
        }
    }

    /// The motion of the linkage that was found last.
    ///
    /// # Errors
    /// Status `NotInitialised`: there was none since the snake was put where it is, or an evolution came after it.
    pub fn motion(&self) -> Result<&Motion> {
        match self.track()? {
            Track::Cycle(motion) => Ok(motion),
            Track::Evolution(_) => {
                let reason = "nothing is known of its motion as a linkage: find its cycle first";
                Err(Error::new(Status::NotInitialised, reason).at("snake"))
            }
        }
    }

    /// The control points of all positions found.
    ///
    /// # Errors
    /// As [`Draft::track`].
    pub fn frames(&self) -> Result<Vec<Vec<DVec3>>> {
        Ok(match self.track()? {
            Track::Evolution(found) => found.frames.iter().map(|frame| frame.snake.control().to_vec()).collect(),
            Track::Cycle(found) => found.frames.clone(),
        })
    }

    /// The times of all positions found; of a linkage's motion they are counted.
    ///
    /// # Errors
    /// As [`Draft::track`].
    pub fn times(&self) -> Result<Vec<f64>> {
        Ok(match self.track()? {
            Track::Evolution(found) => found.frames.iter().map(|frame| frame.time).collect(),
            Track::Cycle(found) => (0..found.frames.len()).map(|k| k as f64).collect(),
        })
    }

    /// The snake at a position found, or as it is.
    ///
    /// # Errors
    /// As [`Draft::track`]; there is no such frame (`frame`).
    pub fn at(&self, frame: Option<usize>) -> Result<Snake> {
        let Some(frame) = frame else { return Ok(self.snake.clone()) };
        let (count, control) = match self.track()? {
            Track::Evolution(found) => (found.frames.len(), found.frames.get(frame).map(|at| at.snake.control())),
            Track::Cycle(found) => (found.frames.len(), found.frames.get(frame).map(Vec::as_slice)),
        };
        let Some(control) = control else {
            let reason = format!("{frame} is out of range for {count} frames");
            return Err(Error::new(Status::IndexOutOfRange, reason).at("frame"));
        };
        self.snake.moved(control.to_vec())
    }

    /// Puts the snake to a position found, and forgets what was found.
    ///
    /// # Errors
    /// As [`Draft::at`].
    pub fn take_frame(&mut self, frame: usize) -> Result<()> {
        self.snake = self.at(Some(frame))?;
        self.track = None;
        Ok(())
    }

    /// How congruent two positions are.
    ///
    /// # Errors
    /// As [`Draft::at`].
    pub fn congruence(&self, a: usize, b: usize) -> Result<Congruence> {
        congruence(self.at(Some(a))?.control(), self.at(Some(b))?.control())
    }

    /// The grid that the positions found make.
    ///
    /// # Errors
    /// As [`swept_grid`].
    pub fn swept(&self, per_arc: usize, comes_back: bool) -> Result<Grid> {
        swept_grid(&self.snake, &self.frames()?, per_arc, comes_back)
    }

    /// The arcs of all positions found.
    ///
    /// # Errors
    /// As [`Draft::frames`] and [`ArcList::new`].
    pub fn arc_list(&self, tolerance: f64) -> Result<ArcList> {
        ArcList::new(&self.snake, &self.frames()?, &self.times()?, tolerance)
    }

    /// What the positions found come to, compared with the snake's surface where that is a mesh.
    ///
    /// # Errors
    /// As [`Draft::frames`] and [`report`](report::report).
    pub fn report(&self, options: &ReportOptions) -> Result<Report> {
        let frames = self.frames()?;
        match &self.surface {
            Some(Surface::Mesh(mesh)) => {
                let surface = ReferenceMesh::new(mesh);
                report::report(&self.snake, &frames, Some(Reference { mesh, surface: &surface }), options)
            }
            _ => report::report(&self.snake, &frames, None, options),
        }
    }

    /// The JSON form of a report.
    pub fn report_json(report: &Report) -> String {
        json::to_text(report)
    }

    /// Lamellae of a depth along the snake at a position found, or as it is.
    ///
    /// # Errors
    /// As [`flat_lamellae`] and [`lamella`]; along normals without a surface (`surface`).
    pub fn lamellae(&self, frame: Option<usize>, depth: f64, per_arc: usize, stand: Stand) -> Result<Vec<Grid>> {
        let snake = self.at(frame)?;
        let one = |grid: Grid| vec![grid];
        match stand {
            Stand::Flat => flat_lamellae(&snake, depth, per_arc),
            Stand::Along(direction) => lamella(&snake, depth, per_arc, &|_| direction).map(one),
            Stand::Normal => self
                .needed_surface()?
                .with(|surface| lamella(&snake, depth, per_arc, &|point| surface.nearest(point).normal))
                .map(one),
        }
    }
}

/// Refuses what is found of a snake that is so large that squares of lengths are not finite.
fn check_numbers(found: &[f64]) -> Result<()> {
    if found.iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    let reason = "coordinates are so large that the result is not finite";
    Err(Error::new(Status::InvalidValue, reason).at("snake"))
}

fn nothing() -> Error {
    Error::new(Status::NotInitialised, "nothing is known of its motion: let it evolve first").at("snake")
}

#[cfg(test)]
mod tests;
