//! A design together with the conditions on its strips and what was found of them last: what a program in another language holds.

use std::ops::ControlFlow;

use super::{Design, FieldOptions};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::conditions::Condition;
use crate::geometry::ruled::layout::Layout;
use crate::geometry::ruled::optimise::{self, Optimised};
use crate::geometry::ruled::planks::{self, PlankOptions, Planks};
use crate::geometry::ruled::report::{Report, ReportOptions};
use crate::geometry::ruled::trim::{TrimOptions, Trimmed, trim};
use crate::geometry::ruled::{Strip, file};
use crate::mesh::Mesh;
use crate::mesh::reference::ReferenceMesh;
use crate::problem::json;

/// A design in work. What was found of strips is forgotten when they change, conditions when there are other strips.
#[derive(Clone, Debug)]
pub struct Draft {
    design: Design,
    conditions: Vec<Condition>,
    optimised: Option<Optimised>,
    report: Option<Report>,
    trimmed: Option<(TrimOptions, Vec<Trimmed>)>,
    planks: Option<Planks>,
}

impl Draft {
    /// The design of a mesh.
    ///
    /// # Errors
    /// As [`Design::new`].
    pub fn new(mesh: &Mesh, options: &FieldOptions) -> Result<Self> {
        let design = Design::new(mesh, options)?;
        Ok(Self { design, conditions: Vec::new(), optimised: None, report: None, trimmed: None, planks: None })
    }

    /// The design.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Makes a step that takes back the strips, and conditions with them, or makes new ones. A step that is refused changes nothing.
    ///
    /// # Errors
    /// Those of the step.
    pub fn step<T>(&mut self, step: impl FnOnce(&mut Design) -> Result<T>) -> Result<T> {
        let made = step(&mut self.design)?;
        self.conditions.clear();
        self.forget();
        Ok(made)
    }

    /// Takes strips from elsewhere; conditions stay if they are alike those before.
    ///
    /// # Errors
    /// As [`Design::set_strips`].
    pub fn set_strips(&mut self, strips: Vec<Strip>) -> Result<()> {
        self.design.set_strips(strips)?;
        let layout = Layout::new(&self.design.strips, &self.design.joints)?.0;
        self.conditions.retain(|condition| condition.check(&layout).is_ok());
        self.forget();
        Ok(())
    }

    /// Moves the control points of a strip.
    ///
    /// # Errors
    /// As [`Design::set_control`].
    pub fn set_control(&mut self, strip: usize, control: [Vec<glam::DVec3>; 2]) -> Result<()> {
        self.design.set_control(strip, control)?;
        self.forget();
        Ok(())
    }

    fn forget(&mut self) {
        (self.optimised, self.report, self.trimmed, self.planks) = (None, None, None, None);
    }

    /// The conditions, in the order in which they were added.
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// Adds conditions, all or none. One of the same kind for the same place is replaced.
    ///
    /// # Errors
    /// As [`optimise`](optimise::optimise()) of conditions, without contradictions; the place is the field of the condition. There are no
    /// strips yet (`strips`).
    pub fn constrain(&mut self, conditions: impl IntoIterator<Item = Condition>) -> Result<()> {
        let layout = Layout::new(&self.design.strips, &self.design.joints)?.0;
        let mut all = self.conditions.clone();
        for condition in conditions {
            condition.check(&layout)?;
            all.retain(|old| !old.is_of_the_place_of(&condition));
            all.push(condition);
        }
        self.conditions = all;
        Ok(())
    }

    /// Takes all conditions away.
    pub fn clear_conditions(&mut self) {
        self.conditions.clear();
    }

    /// Brings the strips as near as they come to the mesh and to each other, under the conditions.
    ///
    /// # Errors
    /// As [`Design::optimise`].
    pub fn optimise(
        &mut self,
        options: &optimise::Options,
        progress: &mut dyn FnMut(&optimise::Progress) -> ControlFlow<()>,
    ) -> Result<&Optimised> {
        let found = self.design.optimise(None, &self.conditions, options, progress)?;
        self.forget();
        Ok(self.optimised.insert(found))
    }

    /// What the last optimisation found of the strips as they are.
    ///
    /// # Errors
    /// Status `NotInitialised`: there was none since they changed.
    pub fn optimised(&self) -> Result<&Optimised> {
        found(self.optimised.as_ref(), "optimise the strips first")
    }

    /// Judges the strips.
    ///
    /// # Errors
    /// As [`Design::report`].
    pub fn judge(&mut self, options: &ReportOptions) -> Result<&Report> {
        let made = self.design.report(None, options)?;
        Ok(self.report.insert(made))
    }

    /// The last report of the strips as they are.
    ///
    /// # Errors
    /// Status `NotInitialised`: there was none since they changed.
    pub fn report(&self) -> Result<&Report> {
        found(self.report.as_ref(), "ask for a report first")
    }

    /// The strips, each with what is left of it within the boundary of the mesh.
    ///
    /// # Errors
    /// As [`trim`](trim()).
    pub fn trimmed(&mut self, options: &TrimOptions) -> Result<(&[Strip], &[Trimmed])> {
        let kept = self.trimmed.take().filter(|(of, _)| of == options);
        let trimmed = match kept {
            Some((_, trimmed)) => trimmed,
            None => trim(&self.design.strips, &ReferenceMesh::new(&self.design.mesh), options)?,
        };
        let (_, trimmed) = self.trimmed.insert((*options, trimmed));
        Ok((&self.design.strips, trimmed))
    }

    /// Cuts a conoidal strip into planks.
    ///
    /// # Errors
    /// As [`planks`](planks::planks()); there is no such strip (`strip`).
    pub fn cut(&mut self, strip: usize, options: &PlankOptions) -> Result<&Planks> {
        let Some(of) = self.design.strips.get(strip) else {
            let reason = format!("{strip} is out of range for {} strips", self.design.strips.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("strip"));
        };
        let made = planks::planks(of, options)?;
        Ok(self.planks.insert(made))
    }

    /// The planks that were cut last of the strips as they are.
    ///
    /// # Errors
    /// Status `NotInitialised`: there were none since they changed.
    pub fn planks(&self) -> Result<&Planks> {
        found(self.planks.as_ref(), "cut planks first")
    }

    /// The JSON form of the strips ([`file::to_json`]).
    pub fn strips_json(&self) -> String {
        file::to_json(&self.design.strips)
    }

    /// The JSON form of the last report.
    ///
    /// # Errors
    /// As [`Draft::report`].
    pub fn report_json(&self) -> Result<String> {
        Ok(json::to_text(self.report()?))
    }

    /// The JSON form of the last planks.
    ///
    /// # Errors
    /// As [`Draft::planks`].
    pub fn planks_json(&self) -> Result<String> {
        Ok(json::to_text(self.planks()?))
    }
}

fn found<'a, T>(made: Option<&'a T>, first: &str) -> Result<&'a T> {
    made.ok_or_else(|| {
        Error::new(Status::NotInitialised, format!("nothing is known of the strips as they are: {first}"))
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::ruled::boundaries::{BoundaryOptions, Levels};
    use crate::geometry::ruled::level_function::LevelOptions;
    use crate::geometry::ruled::start::StartOptions;
    use crate::mesh::curve::End;
    use crate::mesh::patterns::height_field;

    fn quiet<P>(_: &P) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn saddle(is_shared: bool) -> Draft {
        let mesh = height_field(17, 17, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
        let mut draft = Draft::new(&mesh, &FieldOptions::default()).unwrap();
        let (levels, options) = (Levels::Count(2), BoundaryOptions::default());
        let function = LevelOptions::default();
        draft.step(|design| design.set_level_boundaries(&function, &levels, &options, &mut quiet)).unwrap();
        draft.step(|design| design.start(StartOptions { control_count: 6, is_shared })).unwrap();
        draft
    }

    #[test]
    fn what_was_found_is_forgotten_when_strips_change() {
        let mut draft = saddle(false);
        assert_eq!(draft.report().unwrap_err().status(), Status::NotInitialised);
        draft.judge(&ReportOptions::default()).unwrap();
        let before = draft.report().unwrap().clone();
        draft.optimise(&optimise::Options::default(), &mut quiet).unwrap();
        assert_eq!(draft.report().unwrap_err().status(), Status::NotInitialised);
        assert!(draft.optimised().is_ok());
        assert_ne!(*draft.judge(&ReportOptions::default()).unwrap(), before);
        let strips = draft.design().strips().to_vec();
        draft.set_strips(strips).unwrap();
        assert!(draft.optimised().is_err() && draft.report_json().is_err());
    }

    #[test]
    fn a_condition_replaces_the_one_of_its_place_and_goes_with_its_strip() {
        let mut draft = saddle(false);
        let at = |side: usize, x: f64| {
            let position = DVec3::new(x, 0.0, 0.0);
            Condition::FixedEnd { strip: 1, side, end: End::Start, position }
        };
        draft.constrain([at(0, 1.0), at(1, 2.0), at(0, 3.0)]).unwrap();
        assert_eq!(draft.conditions(), [at(1, 2.0), at(0, 3.0)]);
        assert_eq!(draft.constrain([at(0, 4.0), at(2, 4.0)]).unwrap_err().place(), "side");
        assert_eq!(draft.conditions(), [at(1, 2.0), at(0, 3.0)]);
        let first = draft.design().strips()[..1].to_vec();
        draft.set_strips(first).unwrap();
        assert!(draft.conditions().is_empty());
        draft.step(|design| design.start(StartOptions::default())).unwrap();
        assert_eq!(draft.design().strips().len(), 3);
    }

    #[test]
    fn shared_boundaries_move_together() {
        let mut draft = saddle(true);
        let control = [0, 1].map(|side| {
            let moved = draft.design().strips()[1].control(side).iter().map(|p| *p + DVec3::Z);
            moved.collect::<Vec<_>>()
        });
        draft.set_control(1, control.clone()).unwrap();
        let strips = draft.design().strips();
        assert_eq!([strips[0].control(1), strips[2].control(0)], [&control[0][..], &control[1][..]]);
        assert_eq!(draft.set_control(9, control.clone()).unwrap_err().place(), "strip");
        let short = [control[0][1..].to_vec(), control[1].clone()];
        assert_eq!(draft.set_control(1, short).unwrap_err().place(), "control[0]");
    }
}
