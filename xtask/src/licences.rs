//! The licence texts of the crates that are inside the library: whoever passes it on passes them on too.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::shell;

/// The committed file, in the root of the repository. It goes into every package.
pub const FILE: &str = "LICENSE-THIRD-PARTY";

/// The platforms that the library is built for: each may need other crates.
const PLATFORMS: [&str; 3] = ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-msvc", "aarch64-apple-darwin"];

/// What files with a licence are called.
const NAMES: [&str; 5] = ["licen", "copying", "notice", "unlicense", "copyright"];

/// Writes [`FILE`], or fails if it is not what it would write.
pub fn run(check: bool) -> Result<()> {
    let file = shell::root().join(FILE);
    let text = text()?;
    if !check {
        fs::write(&file, text)?;
        println!("{}", file.display());
    } else if fs::read_to_string(&file).unwrap_or_default() != text {
        bail!("{FILE} is not that of Cargo.lock: run `cargo xtask docs`");
    }
    Ok(())
}

/// Every licence text once, under the crates that have it.
fn text() -> Result<String> {
    let mut crates = BTreeMap::new();
    for platform in PLATFORMS {
        crates.extend(crates_of_library(platform)?);
    }
    // By the words alone: many texts differ in their line breaks only.
    let mut owners: BTreeMap<String, (BTreeSet<&str>, String)> = BTreeMap::new();
    let mut without = Vec::new();
    for (name, folder) in &crates {
        let texts = licence_texts(folder)?;
        if texts.is_empty() {
            without.push(name.as_str());
        }
        for text in texts {
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            owners.entry(words).or_insert((BTreeSet::new(), text)).0.insert(name);
        }
    }
    let mut all = String::from(
        "The library shapeop is made of its own code and of the crates below, each under its own licence.\n\
         Where a crate offers a choice, all of its texts are here.\n",
    );
    if !without.is_empty() {
        write!(all, "\nThese packages carry no text of the licence that they state:\n\n")?;
        without.iter().try_for_each(|name| writeln!(all, "  {name}"))?;
    }
    for (names, text) in owners.values() {
        write!(all, "\n{}\n\n", "=".repeat(80))?;
        names.iter().try_for_each(|name| writeln!(all, "  {name}"))?;
        let lines: Vec<&str> = text.trim().lines().map(str::trim_end).collect();
        write!(all, "\n{}\n", lines.join("\n"))?;
    }
    Ok(all)
}

/// The crates that are linked into the library on a platform, as `name version, licence`, and their folders.
fn crates_of_library(platform: &str) -> Result<BTreeMap<String, PathBuf>> {
    let mut command = shell::cargo();
    command.args(["metadata", "--locked", "--format-version", "1", "--filter-platform", platform]);
    let metadata: Value = serde_json::from_str(&shell::output(&mut command)?)?;
    let by_id = |list: &Value| -> Result<BTreeMap<String, Value>> {
        let entries = list.as_array().context("cargo metadata lists no packages")?;
        Ok(entries.iter().map(|entry| (text_of(&entry["id"]), entry.clone())).collect())
    };
    let (packages, nodes) = (by_id(&metadata["packages"])?, by_id(&metadata["resolve"]["nodes"])?);
    let library = packages.values().find(|package| package["name"] == "shapeop").context("there is no shapeop")?;
    let mut waiting = vec![text_of(&library["id"])];
    let mut seen = BTreeSet::new();
    let mut crates = BTreeMap::new();
    while let Some(id) = waiting.pop() {
        let package = &packages[&id];
        if !seen.insert(id.clone()) || is_macro(package) {
            continue;
        }
        if package["name"] != "shapeop" {
            let [name, version, licence] = ["name", "version", "license"].map(|key| text_of(&package[key]));
            let folder = Path::new(&text_of(&package["manifest_path"])).with_file_name("");
            crates.insert(format!("{name} {version}, {licence}"), folder);
        }
        let links = nodes[&id]["deps"].as_array().into_iter().flatten();
        waiting.extend(links.filter(|link| is_linked(link)).map(|link| text_of(&link["pkg"])));
    }
    Ok(crates)
}

/// True if the dependency is more than one of build scripts or tests.
fn is_linked(link: &Value) -> bool {
    link["dep_kinds"].as_array().into_iter().flatten().any(|kind| kind["kind"].is_null())
}

/// True for a crate that runs in the compiler only.
fn is_macro(package: &Value) -> bool {
    package["targets"].as_array().into_iter().flatten().any(|target| target["kind"][0] == "proc-macro")
}

fn text_of(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn licence_texts(folder: &Path) -> Result<Vec<String>> {
    let entries = fs::read_dir(folder).with_context(|| format!("{} could not be read", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    files.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        NAMES.iter().any(|start| name.starts_with(start))
    });
    files.sort();
    let read = |path: &PathBuf| Ok(String::from_utf8_lossy(&fs::read(path)?).into_owned());
    files.iter().map(read).collect()
}
