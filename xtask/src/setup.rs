//! What the tests need beside Rust: programs from Debian, a Python environment, files from PyPI.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Context, Result, bail};

use crate::shell;

/// A program that tests run, and the Debian package that brings it.
pub struct Tool {
    /// Any of these will do.
    names: &'static [&'static str],
    /// What it is called with to see whether it runs.
    probe: &'static str,
    package: &'static str,
}

const fn tool(names: &'static [&'static str], package: &'static str) -> Tool {
    Tool { names, probe: "--version", package }
}

/// What the tests need beside Rust. They leave out what is not there, and say so.
const TOOLS: [Tool; 13] = [
    tool(&["cc", "gcc", "clang"], "gcc"),
    tool(&["c++", "g++", "clang++"], "g++"),
    tool(&["python3", "python"], "python3"),
    tool(&["readelf"], "binutils"),
    tool(&["cmake"], "cmake"),
    tool(&["make"], "make"),
    tool(&["pkg-config"], "pkg-config"),
    Tool { names: &["swig"], probe: "-version", package: "swig" },
    tool(&["javac"], "openjdk-17-jdk-headless"),
    tool(&["jar"], "openjdk-17-jdk-headless"),
    tool(&["jython"], "jython"),
    tool(&["mcs"], "mono-mcs"),
    tool(&["mono"], "mono-runtime"),
];

/// A library that tests load, and the Debian packages that bring it: Polyscope draws with the first where there is no
/// window, and graphics cards are found through the second.
const LIBRARIES: [(&str, &[&str]); 2] =
    [("libEGL.so.1", &["libegl1", "libgl1-mesa-dri"]), ("libvulkan.so.1", &["libvulkan1"])];

/// The graphics card that is a program, which tests solve on where there is no other: the folder that Vulkan looks for
/// drivers in, how the file begins that names this one, and the Debian package that brings it.
const SOFTWARE_CARD: (&str, &str, &str) = ("/usr/share/vulkan/icd.d", "lvp_icd", "mesa-vulkan-drivers");

/// Tries of a download before giving up, with pauses of 5, 10, ... seconds between them.
const DOWNLOAD_TRIES: u64 = 4;

/// True if nothing may be left out.
pub fn is_ci() -> bool {
    std::env::var("CI").as_deref() == Ok("true")
}

/// Installs what is missing, where that is possible. With `CI=true` it fails if something is missing still.
pub fn install_tools() -> Result<()> {
    let wanted = missing();
    if wanted.is_empty() {
        return Ok(());
    }
    install(&wanted);
    let still_missing = missing();
    if is_ci() && !still_missing.is_empty() {
        bail!("CI leaves nothing out, but these packages are missing: {}", still_missing.join(", "));
    }
    Ok(())
}

/// The packages of the tools and libraries that are not there.
fn missing() -> Vec<&'static str> {
    let mut packages: Vec<&str> = TOOLS.iter().filter(|tool| !tool.is_there()).map(|tool| tool.package).collect();
    if cfg!(target_os = "linux") {
        let known = Command::new("/sbin/ldconfig").arg("-p").output();
        let known = known.map_or_else(|_| String::new(), |output| String::from_utf8_lossy(&output.stdout).into_owned());
        let not_known = LIBRARIES.iter().filter(|(name, _)| !known.contains(name));
        packages.extend(not_known.flat_map(|(_, packages)| packages.iter()));
        let (folder, start, package) = SOFTWARE_CARD;
        if !has_file(Path::new(folder), start) {
            packages.push(package);
        }
    }
    packages
}

impl Tool {
    fn is_there(&self) -> bool {
        self.names.iter().any(|name| quiet(name, &[self.probe]))
    }
}

/// True if a file in `folder` begins with `start`.
fn has_file(folder: &Path, start: &str) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.into_iter().any(|entry| entry.file_name().to_string_lossy().starts_with(start))
}

fn quiet(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Installs Debian packages where that is possible: as root, with apt-get. What it cannot do, the caller finds missing.
pub fn install(packages: &[&str]) {
    let wanted = packages.join(" ");
    if !quiet("apt-get", &["--version"]) || !is_root() {
        println!("Missing: {wanted}. Install them yourself: this needs root and apt-get.");
        return;
    }
    println!("Installing {wanted}");
    let apt = |arguments: &[&str]| {
        let mut command = Command::new("apt-get");
        command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive");
        shell::run(&mut command)
    };
    let arguments = [&["install", "--yes", "--no-install-recommends"], packages].concat();
    let _ = tried(|| apt(&["update"]).and_then(|()| apt(&arguments)));
}

/// Runs a download, again after a pause if it fails.
fn tried(download: impl Fn() -> Result<()>) -> Result<()> {
    for try_number in 1.. {
        match download() {
            Err(error) if try_number < DOWNLOAD_TRIES => {
                println!("Try {try_number} of {DOWNLOAD_TRIES} failed: {error}; waiting");
                sleep(Duration::from_secs(5 * try_number));
            }
            result => return result,
        }
    }
    Ok(())
}

#[cfg(unix)]
fn is_root() -> bool {
    let output = Command::new("id").arg("-u").output();
    output.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

#[cfg(not(unix))]
fn is_root() -> bool {
    // There is no apt-get either.
    false
}

/// A CPython of this version, such as `3.9` or `2.7`: on the path, or among those of pyenv. What cannot say its version (a
/// shim without a Python behind it) does not count.
pub fn python(version: &str) -> Option<PathBuf> {
    let on_path = PathBuf::from(format!("python{version}"));
    let home = std::env::var_os("PYENV_ROOT").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".pyenv")));
    let mut of_pyenv: Vec<PathBuf> = home
        .and_then(|home| fs::read_dir(home.join("versions")).ok())
        .into_iter()
        .flatten()
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(&format!("{version}.")))
        .map(|entry| entry.path().join("bin/python"))
        .collect();
    of_pyenv.sort();
    of_pyenv.into_iter().rev().chain([on_path]).find(|python| quiet(&python.to_string_lossy(), &["--version"]))
}

/// Any Python 3.
///
/// # Errors
/// There is none.
pub fn any_python() -> Result<PathBuf> {
    let found = ["python3", "python"].into_iter().find(|name| quiet(name, &["--version"]));
    found.map(PathBuf::from).context("there is no Python")
}

/// Makes an environment of `python` in `folder`, unless it is there with the same requirements, and returns its Python.
/// Requirements are arguments of `pip install`.
pub fn environment(python: &Path, folder: &Path, requirements: &[String]) -> Result<PathBuf> {
    let inside = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = folder.join("requirements.stamp");
    let mut wanted = requirements.join("\n");
    for file in requirements.iter().filter(|each| each.ends_with(".txt")) {
        wanted += &fs::read_to_string(shell::root().join(file))?;
    }
    if fs::read_to_string(&stamp).is_ok_and(|made| made == wanted) && quiet(&inside.to_string_lossy(), &["--version"]) {
        return Ok(inside);
    }
    let make = || shell::output(Command::new(python).args(["-m", "venv", "--clear"]).arg(folder));
    if make().is_err() {
        // Debian has it in a package of its own.
        install(&["python3-venv"]);
        make()?;
    }
    if !requirements.is_empty() {
        pip(&inside, &[&["install".to_owned()], requirements].concat())?;
    }
    fs::write(stamp, wanted)?;
    Ok(inside)
}

/// Runs pip in the root of the repository, again if a download fails.
pub fn pip(python: &Path, arguments: &[String]) -> Result<()> {
    tried(|| {
        let mut command = Command::new(python);
        command.args(["-m", "pip", "--disable-pip-version-check", "--quiet"]).args(arguments);
        shell::run(command.current_dir(shell::root()))
    })
}
