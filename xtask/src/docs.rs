//! `cargo xtask docs`.

use anyhow::Result;

use crate::{licences, shell};

/// Writes the parts of the documentation that are made from the code, by running the tests that compare them, and the
/// licences of others.
pub fn run() -> Result<()> {
    for (features, test, variable) in [("", "docs", "SHAPEOP_WRITE_DOCS"), ("schema", "schema", "SHAPEOP_WRITE_SCHEMA")]
    {
        let arguments = ["test", "--quiet", "--package", "shapeop", "--features", features, "--test", test];
        shell::run(shell::cargo().args(arguments).env(variable, "1"))?;
    }
    licences::run(false)
}
