//! Refusals of the library under the names of options and files.

use std::path::Path;

use anyhow::anyhow;
use shapeop::error::Error;

/// What places of the library, by their beginnings, are called here.
pub struct Names(Vec<(&'static str, String)>);

impl Names {
    pub fn new(names: &[(&'static str, &str)]) -> Self {
        Self(names.iter().map(|(place, name)| (*place, (*name).to_owned())).collect())
    }

    /// Further ones; of two that fit the one that was added last counts.
    pub fn with(mut self, place: &'static str, name: impl Into<String>) -> Self {
        self.0.insert(0, (place, name.into()));
        self
    }

    /// A refusal under the name of the option or the file that it is about, where it is about one.
    pub fn of(&self, error: Error) -> anyhow::Error {
        let place = error.place().to_owned();
        let fits = |rest: &&str| rest.is_empty() || rest.starts_with(['.', '[']);
        let found = self.0.iter().find_map(|(name, option)| {
            let rest = place.strip_prefix(name).filter(fits)?;
            Some(format!("{option}{rest}"))
        });
        match found {
            Some(option) => error.with_place(option).into(),
            None => error.into(),
        }
    }
}

/// A refusal of a mesh, with the file and the line.
pub fn of_mesh(error: Error, path: &Path, face_lines: &[usize]) -> anyhow::Error {
    let face = error.place().strip_prefix("faces[").and_then(|rest| rest.split(']').next());
    let line = face.and_then(|k| face_lines.get(k.parse::<usize>().ok()?)).map(|line| format!(":{line}"));
    anyhow!("{}{}: {error}", path.display(), line.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use shapeop::error::Status;

    use super::*;

    #[test]
    fn places_become_options() {
        let names = Names::new(&[("options.step", "--step"), ("arc_count", "--arcs")]).with("arc_count", "SNAKE");
        let named = |place: &str| names.of(Error::new(Status::InvalidValue, "no").at(place)).to_string();
        assert_eq!(named("options.step"), "--step: no");
        assert_eq!(named("options.steps"), "options.steps: no");
        assert_eq!(named("arc_count[3]"), "SNAKE[3]: no");
    }
}
