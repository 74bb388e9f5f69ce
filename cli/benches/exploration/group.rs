//! A group of figures as a line of JSON.

use std::fmt;

use serde::Serialize;

/// What was measured, under a title.
#[derive(Default, Serialize)]
pub struct Group {
    pub title: String,
    /// What is done, and what is claimed.
    pub claim: String,
    pub measures: Vec<Measure>,
    /// The picture's file.
    pub picture: Option<String>,
}

/// A number with its bounds, if it has any.
#[derive(Serialize)]
pub struct Measure {
    what: String,
    value: f64,
    least: Option<f64>,
    most: Option<f64>,
}

impl Group {
    pub fn new(title: &str, claim: &str) -> Self {
        Self { title: title.to_owned(), claim: claim.to_owned(), ..Self::default() }
    }

    pub fn plain(&mut self, what: &str, value: f64) {
        self.push(what, value, None, None);
    }

    pub fn at_most(&mut self, what: &str, value: f64, most: f64) {
        self.push(what, value, None, Some(most));
    }

    pub fn at_least(&mut self, what: &str, value: f64, least: f64) {
        self.push(what, value, Some(least), None);
    }

    #[allow(dead_code, reason = "not every program has measures with both bounds")]
    pub fn between(&mut self, what: &str, value: f64, [least, most]: [f64; 2]) {
        self.push(what, value, Some(least), Some(most));
    }

    fn push(&mut self, what: &str, value: f64, least: Option<f64>, most: Option<f64>) {
        self.measures.push(Measure { what: what.to_owned(), value, least, most });
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&serde_json::to_string(self).map_err(|_| fmt::Error)?)
    }
}
