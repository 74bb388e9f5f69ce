//! `cargo xtask show bindings`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use serde_json::Value;

use super::Figures;
use crate::languages::{self, PROBLEMS, TOLERANCE};
use crate::suites::{LeftOut, Places};
use crate::{bindings, setup, shell};

const PYTHONS: [&str; 5] = ["3.9", "3.10", "3.11", "3.12", "3.13"];
const COMPAS: &str = "compas==2.15.1";

/// The reference trajectories that have no force but gravity.
const PUBLISHED_FIXTURES: f64 = 139.0;

/// The figures of the ShapeOp paper that are solved, measured and drawn.
const PAPER_FIGURES: usize = 8;

pub fn show(figures: &mut Figures) -> Result<()> {
    setup::install_tools()?;
    let places = bindings::set_up("release")?;
    let out = shell::root().join("target/show/bindings");
    fs::create_dir_all(&out)?;
    python_package(figures, &out)?;
    published_components(figures, &places)?;
    grasshopper_files(figures, &places, &out)?;
    all_languages(figures, &places)?;
    paper(figures, &places, &out)
}

/// A new environment of every Python: the package as a user installs it, the README's program, the time to add.
fn python_package(figures: &mut Figures, out: &Path) -> Result<()> {
    let script = readme_program()?;
    for version in PYTHONS {
        figures.group(&format!("Python {version}: pip install ./bindings/python into an empty environment"));
        let Some(python) = setup::python(version) else {
            figures.not_measured(&format!("CPython {version} is missing"), "installed");
            continue;
        };
        let folder = out.join(format!("python{version}"));
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        let python = setup::environment(&python, &folder, &[])?;
        setup::pip(&python, &["install".to_owned(), "./bindings/python".to_owned()])?;
        setup::pip(&python, &["install".to_owned(), COMPAS.to_owned()])?;
        let printed = shell::output(Command::new(&python).args(["-c", &script]).current_dir(&folder))?;
        figures.says(printed.trim());
        figures.exactly("the README's program: meshes written", count(&folder, "obj")?, 1);
        let text = shell::output(Command::new(&python).arg(shell::root().join("bindings/python/benchmarks/add.py")))?;
        let seconds: Value = serde_json::from_str(&text)?;
        for (way, seconds) in seconds["seconds"].as_object().context("no seconds")? {
            figures.at_most(&format!("seconds to add 200 000, {way}"), number(seconds)?, 0.2);
        }
    }
    Ok(())
}

/// The program under "From Python", which can run in any folder.
fn readme_program() -> Result<String> {
    let readme = fs::read_to_string(shell::root().join("README.md"))?;
    let program = readme.split_once("```python\n").and_then(|(_, rest)| rest.split_once("```"));
    let (program, _) = program.context("README.md has no ```python")?;
    let meshes = shell::root().join("examples/meshes");
    Ok(program.replace("examples/meshes", &meshes.to_string_lossy()))
}

/// The six components in the published client's order of calls, under both Pythons that can call the library.
fn published_components(figures: &mut Figures, places: &Places) -> Result<()> {
    let tests = shell::root().join("ghpython/tests");
    for name in ["ghpython", "python27"] {
        let Some(python) = places.get(name) else {
            figures.not_measured(name, "installed");
            continue;
        };
        let version = "import platform; print(platform.python_version())";
        let version = shell::output(Command::new(python).args(["-c", version]))?;
        figures.group(&format!("the published client's components under CPython {}", version.trim()));
        let mut command = Command::new(python);
        command.args(["-m", "unittest", "test_fixtures", "test_published"]).current_dir(&tests);
        command.env("SHAPEOP_LIBRARY", library(places)?).env("PYTHONDONTWRITEBYTECODE", "1");
        let [printed, said] = shell::said(&mut command)?;
        for (component, least) in [("ConstraintSolver", PUBLISHED_FIXTURES), ("LiveSolver", PUBLISHED_FIXTURES)] {
            let [played, worst] = numbers_behind(&printed, &format!("{component}:"))?;
            figures.at_least(&format!("{component}: fixtures played"), played, least);
            figures.at_most(&format!("{component}: worst error over its tolerance"), worst, 1.0);
        }
        let [passed, _] = numbers_behind(&said, "Ran ")?;
        figures.plain("tests passed: calls as through C, ctypes without types", &passed.to_string());
    }
    Ok(())
}

/// Public files through our reader and writer; one of ours as text.
fn grasshopper_files(figures: &mut Figures, places: &Places, out: &Path) -> Result<()> {
    figures.group("public .ghuser files, read and written again");
    let python = places.get("ghpython").context("there is no ghpython")?;
    let packaging = shell::root().join("ghpython/packaging");
    let mut command = Command::new(python);
    command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]).arg(packaging.join("tests/test_archive.py"));
    command.env("SHAPEOP_GH_FILES", places.get("ghfiles").unwrap_or_default());
    let printed = shell::output(&mut command)?;
    for (what, head) in
        [("files", "files:"), ("archives inside them", "inner archives:"), ("through XML", "through XML:")]
    {
        let [tried, identical] = numbers_behind(&printed, head)?;
        figures.plain(&format!("{what}: tried"), &tried.to_string());
        figures.at_least(&format!("{what}: identical, byte for byte"), identical, tried);
    }

    figures.group("one of ours as text");
    let objects = out.join("grasshopper");
    let mut build = Command::new(python);
    build.arg(packaging.join("build.py")).arg(&objects).arg("--library").arg(library(places)?);
    shell::output(&mut build)?;
    let ours = find(&objects, "ShapeOpConstraintSolver.ghuser")?;
    println!("{}", shell::output(Command::new(python).arg(packaging.join("dump.py")).arg(ours))?);
    Ok(())
}

fn all_languages(figures: &mut Figures, places: &Places) -> Result<()> {
    let rows = languages::run(places, "release")?;
    figures.group("languages and problems: the largest difference to the Rust result, of the model's size");
    for row in rows {
        for (index, problem) in PROBLEMS.iter().enumerate() {
            let name = format!("{}: {problem}", row.name);
            match &row.differences {
                Ok(differences) => figures.at_most(&name, differences[index], TOLERANCE),
                Err(LeftOut(why)) => figures.not_measured(&format!("{name}: {why}"), "measured"),
            }
        }
    }
    Ok(())
}

fn paper(figures: &mut Figures, places: &Places, out: &Path) -> Result<()> {
    let python = places.get("python").context("there is no python")?;
    let pictures = out.join("paper");
    // It fails if a claim is not met; then the figures below say which.
    let _ = shell::output(Command::new(python).arg(shell::root().join("examples/paper/run.py")).arg(&pictures));
    let table: Value = serde_json::from_str(&fs::read_to_string(pictures.join("measures.json"))?)?;
    for (figure, entry) in table.as_object().context("no figures")? {
        figures.group(&format!("{figure}, {}", entry["title"].as_str().unwrap_or_default()));
        figures.says(entry["claim"].as_str().unwrap_or_default());
        for measure in entry["measures"].as_array().context("no measures")? {
            figures.measure(measure)?;
        }
    }
    figures.group("pictures of the paper's examples");
    figures.says(&pictures.display().to_string());
    figures.exactly("written", count(&pictures, "png")?, PAPER_FIGURES);
    Ok(())
}

fn library(places: &Places) -> Result<&str> {
    places.get("library").context("there is no library")
}

fn number(value: &Value) -> Result<f64> {
    value.as_f64().with_context(|| format!("expected a number, found {value}"))
}

/// The first two numbers behind `head` in the line that begins with it.
fn numbers_behind(printed: &str, head: &str) -> Result<[f64; 2]> {
    let behind = printed.lines().find_map(|line| line.trim_start().strip_prefix(head));
    let behind = behind.with_context(|| format!("no line begins with {head:?} in\n{printed}"))?;
    let mut numbers = behind.split_whitespace().filter_map(|word| word.trim_end_matches('s').parse().ok());
    let mut next = || numbers.next().with_context(|| format!("expected two numbers behind {head:?}, found {behind}"));
    Ok([next()?, next()?])
}

/// The files in `folder` with this ending.
fn count(folder: &Path, ending: &str) -> Result<usize> {
    let entries = fs::read_dir(folder).with_context(|| format!("{} could not be read", folder.display()))?;
    Ok(entries.flatten().filter(|entry| entry.path().extension().is_some_and(|found| found == ending)).count())
}

/// The file of this name in `folder` or a folder in it.
fn find(folder: &Path, name: &str) -> Result<PathBuf> {
    let folders = fs::read_dir(folder)?.flatten().map(|entry| entry.path());
    let mut candidates = folders.map(|inner| inner.join(name)).chain([folder.join(name)]);
    candidates.find(|file| file.is_file()).with_context(|| format!("no {name} in {}", folder.display()))
}
