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

/// The committed file of the crates that the feature `gpu` adds. It goes into packages with that feature, beside [`FILE`].
pub const FILE_OF_GPU: &str = "LICENSE-THIRD-PARTY-GPU";

/// Licences that a crate inside the library may have: they ask for little more than that their texts are passed on.
const ACCEPTED: [&str; 6] = ["MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "MPL-2.0", "Zlib"];

/// Those that the feature `gpu` brings beside them, each with its reason.
const ACCEPTED_WITH_GPU: [&str; 2] = [
    // libloading, which finds the driver: says in other words what BSD-2-Clause says.
    "ISC",
    // unicode-ident, for its tables of characters, which the compiler of kernels reads names by: asks for what MIT asks.
    "Unicode-3.0",
];

/// The platforms that the library is built for: each may need other crates.
const PLATFORMS: [&str; 3] = ["x86_64-unknown-linux-gnu", "x86_64-pc-windows-msvc", "aarch64-apple-darwin"];

/// What files with a licence are called.
const NAMES: [&str; 5] = ["licen", "copying", "notice", "unlicense", "copyright"];

/// The crates, as `name version, licence`, and their folders.
type Crates = BTreeMap<String, PathBuf>;

/// Writes [`FILE`] and [`FILE_OF_GPU`], or fails if they are not what it would write. Fails too if a crate's licence is
/// not accepted.
pub fn run(check: bool) -> Result<()> {
    let crates = crates_of_library("")?;
    check_licences(&crates, &ACCEPTED)?;
    let mut added = crates_of_library("gpu")?;
    added.retain(|name, _| !crates.contains_key(name));
    check_licences(&added, &[&ACCEPTED[..], &ACCEPTED_WITH_GPU].concat())?;
    let intro = "The library shapeop is made of its own code and of the crates below, each under its own licence.\n\
                 Where a crate offers a choice, all of its texts are here.\n";
    let intro_of_gpu = format!(
        "With the feature \"gpu\" the library shapeop is made of the crates below too, beside those of {FILE}, each under its\n\
         own licence. Where a crate offers a choice, all of its texts are here.\n"
    );
    for (name, intro, crates) in [(FILE, intro, &crates), (FILE_OF_GPU, &intro_of_gpu, &added)] {
        let (file, text) = (shell::root().join(name), text(intro, crates)?);
        if !check {
            fs::write(&file, text)?;
            println!("{}", file.display());
        } else if fs::read_to_string(&file).unwrap_or_default() != text {
            bail!("{name} is not that of Cargo.lock: run `cargo xtask docs`");
        }
    }
    Ok(())
}

/// The crates that are linked into the library on any platform.
fn crates_of_library(features: &str) -> Result<Crates> {
    let mut crates = Crates::new();
    for platform in PLATFORMS {
        crates.extend(crates_on(platform, features)?);
    }
    Ok(crates)
}

fn check_licences(crates: &Crates, accepted: &[&str]) -> Result<()> {
    let is_refused = |name: &&String| !is_accepted(name, accepted);
    let refused: Vec<&str> = crates.keys().filter(is_refused).map(String::as_str).collect();
    if refused.is_empty() {
        return Ok(());
    }
    bail!("inside the library, but under a licence that is not among {}: {}", accepted.join(", "), refused.join("; "))
}

/// True if the licence of `name version, licence` leaves a choice that is accepted, and each of several parts does.
fn is_accepted(name: &str, accepted: &[&str]) -> bool {
    let licence = name.split_once(", ").map_or("", |(_, licence)| licence);
    let is_one_accepted = |part: &str| {
        let mut choices = part.split(" OR ").flat_map(|choice| choice.split('/'));
        choices.any(|choice| accepted.contains(&choice.trim_matches(['(', ')', ' '])))
    };
    licence.split(" AND ").all(is_one_accepted)
}

/// Every licence text once, under the crates that have it.
fn text(intro: &str, crates: &Crates) -> Result<String> {
    // By the words alone: many texts differ in their line breaks only.
    let mut owners: BTreeMap<String, (BTreeSet<&str>, String)> = BTreeMap::new();
    let mut without = Vec::new();
    for (name, folder) in crates {
        let texts = licence_texts(folder)?;
        if texts.is_empty() {
            without.push(name.as_str());
        }
        for text in texts {
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            owners.entry(words).or_insert((BTreeSet::new(), text)).0.insert(name);
        }
    }
    let mut all = intro.to_owned();
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

/// The crates that are linked into the library on a platform.
fn crates_on(platform: &str, features: &str) -> Result<Crates> {
    let mut command = shell::cargo();
    command.args(["metadata", "--locked", "--format-version", "1", "--filter-platform", platform]);
    command.args(["--features", features]);
    let metadata: Value = serde_json::from_str(&shell::output(&mut command)?)?;
    let by_id = |list: &Value| -> Result<BTreeMap<String, Value>> {
        let entries = list.as_array().context("cargo metadata lists no packages")?;
        Ok(entries.iter().map(|entry| (text_of(&entry["id"]), entry.clone())).collect())
    };
    let (packages, nodes) = (by_id(&metadata["packages"])?, by_id(&metadata["resolve"]["nodes"])?);
    let library = packages.values().find(|package| package["name"] == "shapeop").context("there is no shapeop")?;
    let mut waiting = vec![text_of(&library["id"])];
    let mut seen = BTreeSet::new();
    let mut crates = Crates::new();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_licence_is_accepted_if_every_part_of_it_leaves_an_accepted_choice() {
        let accepted = ["MIT", "GPL-3.0 OR MIT", "Apache-2.0/MIT", "(MIT OR Apache-2.0) AND Zlib", "Unlicense OR MIT"];
        assert!(accepted.iter().all(|licence| is_accepted(&format!("a 1.0, {licence}"), &ACCEPTED)));
        let refused = ["", "GPL-3.0", "MIT AND GPL-3.0", "(GPL-3.0 OR LGPL-3.0) AND MIT", "MITNFA"];
        assert!(!refused.iter().any(|licence| is_accepted(&format!("a 1.0, {licence}"), &ACCEPTED)));
    }
}
