//! Commands in other languages: what they are called with, and where the things are that they name.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::shell;

/// A program's name and arguments; `{name}` stands for a place.
pub type Step = &'static [&'static str];

/// Commands that follow each other in one folder, and what they need.
pub struct Suite {
    /// What it is called.
    pub name: &'static str,
    /// Variables of its commands.
    pub environment: &'static [(&'static str, &'static str)],
    /// Its commands.
    pub steps: &'static [Step],
}

/// Where things are, by the names that steps use in braces.
#[derive(Clone, Default)]
pub struct Places(BTreeMap<&'static str, String>);

/// Why a suite was not run.
pub struct LeftOut(pub String);

impl Places {
    /// Gives `name` a place.
    pub fn set(&mut self, name: &'static str, place: impl Into<PathBuf>) {
        self.0.insert(name, place.into().to_string_lossy().into_owned());
    }

    /// The place of `name`.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// `word` with places for their names.
    fn fill(&self, word: &str) -> Result<String, LeftOut> {
        let mut filled = word.to_owned();
        for (name, place) in &self.0 {
            filled = filled.replace(&format!("{{{name}}}"), place);
        }
        match filled.split_once('{').and_then(|(_, rest)| rest.split_once('}')) {
            Some((name, _)) if name.chars().all(char::is_alphanumeric) && !name.is_empty() => {
                Err(LeftOut(format!("there is no {name}")))
            }
            _ => Ok(filled),
        }
    }
}

impl Suite {
    /// Where its commands run.
    pub fn folder(&self) -> PathBuf {
        shell::root().join("target/suites").join(self.name.replace([' ', ':', ',', '/'], "-"))
    }

    /// Runs the commands in an empty folder, `{work}`; returns what they printed.
    pub fn run(&self, places: &Places) -> Result<Result<String, LeftOut>> {
        let folder = self.folder();
        if folder.exists() {
            fs::remove_dir_all(&folder).with_context(|| format!("{} could not be emptied", folder.display()))?;
        }
        fs::create_dir_all(folder.join("out"))?;
        let mut places = places.clone();
        places.set("work", &folder);
        places.set("out", folder.join("out"));
        let mut printed = String::new();
        for step in self.steps {
            let words = step.iter().map(|word| places.fill(word)).collect::<Result<Vec<_>, _>>();
            let words = match words {
                Ok(words) => words,
                Err(left_out) => return Ok(Err(left_out)),
            };
            let [program, arguments @ ..] = words.as_slice() else { bail!("{}: an empty command", self.name) };
            let mut command = Command::new(program);
            command.args(arguments).current_dir(&folder);
            for (name, value) in self.environment {
                match places.fill(value) {
                    Ok(value) => command.env(name, value),
                    Err(left_out) => return Ok(Err(left_out)),
                };
            }
            if !shell::can_start(program) {
                return Ok(Err(LeftOut(format!("{program} was not found"))));
            }
            printed += &shell::said(&mut command).context(self.name)?.concat();
        }
        Ok(Ok(printed))
    }
}
