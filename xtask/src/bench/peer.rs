//! compas-shapeop from PyPI, in a virtual environment of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::{setup, shell};

/// The Python that has compas-shapeop, installed into `folder` if it is not there yet.
pub fn set_up(folder: &Path) -> Result<PathBuf> {
    // A wheel as published: what an own compiler makes of the source would be another peer.
    let requirements = ["--no-deps", "--only-binary", ":all:", "--requirement", "benches/requirements.txt"];
    let python = setup::environment(&setup::any_python()?, folder, &requirements.map(str::to_owned))?;
    shell::output(Command::new(&python).args(["-c", "import compas_shapeop._shapeop"]))
        .context("compas-shapeop was installed but cannot be imported")?;
    Ok(python)
}
