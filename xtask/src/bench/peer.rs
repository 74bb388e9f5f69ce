//! compas-shapeop from PyPI, in a virtual environment of its own.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Context, Result, bail};

use crate::shell;
use crate::test;

/// Tries of the download, with pauses of 5, 10, ... seconds between them.
const TRIES: u64 = 4;

/// The Python that has compas-shapeop, installed into `folder` if it is not there yet.
pub fn set_up(folder: &Path) -> Result<PathBuf> {
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let is_there = || {
        let mut command = Command::new(&python);
        shell::output(command.args(["-c", "import compas_shapeop._shapeop"])).is_ok()
    };
    if is_there() {
        return Ok(python);
    }
    let system = ["python3", "python"].into_iter().find(|name| shell::output(Command::new(name).arg("-V")).is_ok());
    let system = system.context("there is no Python")?;
    let make = || shell::output(Command::new(system).args(["-m", "venv", "--clear"]).arg(folder));
    if make().is_err() {
        // Debian has it in a package of its own.
        test::install(&["python3-venv"]);
        make()?;
    }
    let requirements = shell::root().join("benches/requirements.txt");
    for try_number in 1..=TRIES {
        let mut pip = Command::new(&python);
        pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps"]);
        // A wheel as published: what an own compiler makes of the source would be another peer.
        pip.args(["--only-binary", ":all:", "--requirement"]).arg(&requirements);
        match shell::output(&mut pip) {
            Ok(_) => break,
            Err(error) if try_number == TRIES => return Err(error),
            Err(_) => sleep(Duration::from_secs(5 * try_number)),
        }
    }
    if !is_there() {
        bail!("compas-shapeop was installed but cannot be imported");
    }
    Ok(python)
}
