//! `cargo xtask schema`.

use anyhow::Result;

use crate::shell;

/// Writes the JSON schema of problems by running the test that compares it.
pub fn run() -> Result<()> {
    let arguments = ["test", "--quiet", "--package", "shapeop", "--features", "schema", "--test", "schema"];
    shell::run(shell::cargo().args(arguments).env("SHAPEOP_WRITE_SCHEMA", "1"))
}
