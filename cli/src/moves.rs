//! The moves of a drag, frame by frame, and their file.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use serde::{Deserialize, Serialize};
use shapeop::problem::{Handle, Problem};

/// The version of the file's form.
const VERSION: u32 = 1;

/// A drag: frames in their order. `docs/exploration.md` states the form.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Moves {
    pub version: u32,
    pub frames: Vec<Frame>,
}

/// What changes before a frame is solved; everything else stays as it is.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Frame {
    /// Points that become handles or whose targets move.
    pub handles: Vec<Handle>,
    /// Handles that are let go.
    pub releases: Vec<u32>,
}

impl Moves {
    /// Reads the moves of `problem`. What errs is named with its frame and field.
    pub fn read(path: &Path, problem: &Problem) -> Result<Self> {
        let name = path.display();
        let text = std::fs::read_to_string(path).with_context(|| format!("{name}: cannot be read"))?;
        Self::from_json(&text, problem).with_context(|| name.to_string())
    }

    fn from_json(text: &str, problem: &Problem) -> Result<Self> {
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let moves: Self = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
            let place = error.path().to_string();
            if place == "." { anyhow!("{}", error.inner()) } else { anyhow!("{place}: {}", error.inner()) }
        })?;
        deserializer.end()?;
        if moves.version != VERSION {
            bail!("version: expected {VERSION}, found {}", moves.version);
        }
        if moves.frames.is_empty() {
            bail!("frames: expected at least one frame, found none");
        }
        let mut held: BTreeSet<u32> = problem.handles.iter().map(|handle| handle.point).collect();
        for (i, frame) in moves.frames.iter().enumerate() {
            frame.check(problem.points.len(), &mut held).map_err(|error| anyhow!("frames[{i}].{error}"))?;
        }
        Ok(moves)
    }
}

impl Frame {
    /// Refuses what a solver would refuse, and a point that is named twice. `held`: the handles before the frame, then after it.
    fn check(&self, point_count: usize, held: &mut BTreeSet<u32>) -> Result<()> {
        let mut named = BTreeSet::new();
        for (j, point) in self.releases.iter().enumerate() {
            if !held.remove(point) {
                bail!("releases[{j}]: point {point} is no handle at this frame");
            }
            named.insert(*point);
        }
        for (j, Handle { point, target }) in self.handles.iter().enumerate() {
            if *point as usize >= point_count {
                bail!("handles[{j}].point: {point} is out of range for {point_count} points");
            }
            if let Some(value) = target.iter().find(|value| !value.is_finite()) {
                bail!("handles[{j}].target: expected a finite number, found {value}");
            }
            if !named.insert(*point) {
                bail!("handles[{j}].point: point {point} is named twice in this frame");
            }
        }
        held.extend(self.handles.iter().map(|handle| handle.point));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem() -> Problem {
        let handles = vec![Handle { point: 2, target: [0.0; 3] }];
        Problem { points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], handles, ..Problem::default() }
    }

    #[test]
    fn a_frame_moves_and_releases() {
        let text = r#"{"version": 1, "frames": [
            {"handles": [{"point": 0, "target": [0, 0, 1.5]}]}, {"releases": [2, 0]}, {},
            {"handles": [{"point": 2, "target": [0, 0, 1]}]}]}"#;
        let moves = Moves::from_json(text, &problem()).unwrap();
        assert_eq!(moves.frames.len(), 4);
        assert_eq!(moves.frames[0].handles, [Handle { point: 0, target: [0.0, 0.0, 1.5] }]);
        assert_eq!((moves.frames[1].releases.as_slice(), &moves.frames[2]), (&[2, 0][..], &Frame::default()));
    }

    #[test]
    fn what_errs_is_named_by_frame_and_field() {
        let at_0 = r#"{"point": 0, "target": [0, 0, 0]}"#;
        let cases = [
            (r#"{"version": 2, "frames": []}"#.to_owned(), "version: expected 1, found 2"),
            (r#"{"version": 1, "frames": []}"#.to_owned(), "frames: expected at least one frame, found none"),
            (r#"{"frames": []}"#.to_owned(), "missing field `version`"),
            (frames(r#"{}, {"handels": []}"#), "frames[1].handels: unknown field `handels`"),
            (frames(r#"{"handles": [{"point": 0}]}"#), "frames[0].handles[0]: missing field `target`"),
            (
                frames(r#"{"handles": [{"point": 0, "target": [0, "up", 0]}]}"#),
                "frames[0].handles[0].target[1]: invalid",
            ),
            (
                frames(r#"{"handles": [{"point": 3, "target": [0, 0, 0]}]}"#),
                "handles[0].point: 3 is out of range for 3 points",
            ),
            (
                frames(&format!(r#"{{"handles": [{at_0}, {at_0}]}}"#)),
                "frames[0].handles[1].point: point 0 is named twice",
            ),
            (frames(r#"{"releases": [1]}"#), "frames[0].releases[0]: point 1 is no handle at this frame"),
            (frames(r#"{"releases": [2]}, {"releases": [2]}"#), "frames[1].releases[0]: point 2 is no handle"),
            (format!("{} 1", frames("{}")), "trailing characters"),
        ];
        for (text, expected) in cases {
            let told = Moves::from_json(&text, &problem()).unwrap_err().to_string();
            assert!(told.contains(expected), "{told}");
        }
    }

    fn frames(text: &str) -> String {
        format!(r#"{{"version": 1, "frames": [{text}]}}"#)
    }
}
