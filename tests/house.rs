//! The house's rules: which module may import which, where unsafe code may be, and what only a feature brings.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What each module of the crate may import; `error` is free for all.
const ALLOWED: [(&str, &[&str]); 8] = [
    ("error", &[]),
    ("linalg", &[]),
    ("mesh", &["linalg"]),
    ("constraints", &["linalg", "mesh"]),
    ("problem", &["constraints", "mesh"]),
    ("solver", &["problem", "constraints", "linalg"]),
    ("geometry", &["problem", "solver", "mesh", "linalg"]),
    ("capi", &["linalg", "mesh", "constraints", "problem", "solver", "geometry"]),
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

fn library_sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    files.sort();
    let relative = |file: &Path| file.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
    files.iter().map(|file| (relative(file), fs::read_to_string(file).unwrap())).collect()
}

/// The modules that a source names as `crate::module`.
fn imports(text: &str) -> Vec<String> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| is_word(*c)).collect())
        .collect()
}

#[test]
fn modules_import_only_what_the_house_allows() {
    let mut wrong = Vec::new();
    let files = library_sources();
    assert!(files.len() > 20, "the sources were not found");
    for (file, text) in files.iter().filter(|(file, _)| file != "lib.rs") {
        let module = file.split(['/', '.']).next().unwrap();
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == module) else {
            panic!("{file} is in no room of the house");
        };
        assert!(!text.contains("use crate::{"), "{file}: name one module per use, so that this test can read it");
        for import in imports(text) {
            if import != "error" && import != module && !allowed.contains(&import.as_str()) {
                wrong.push(format!("{file} imports {import}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unsafe_code_is_only_in_capi() {
    for (file, text) in library_sources().iter().filter(|(file, _)| !file.starts_with("capi/")) {
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//") && !line.contains("unsafe_code"));
        for line in code {
            assert!(!line.contains("unsafe"), "{file}: {line}");
        }
    }
}

/// The crates inside what is selected.
fn crates_of(selection: &[&str]) -> Vec<String> {
    let mut command = Command::new(env!("CARGO"));
    command.args(["tree", "--locked", "--edges", "normal", "--prefix", "none"]).args(selection);
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

#[test]
fn only_the_feature_gpu_brings_crates_of_the_graphics_card() {
    let of_card = |features: &str| {
        let mut crates = crates_of(&["--workspace", "--features", features]);
        assert!(crates.contains(&"faer".to_owned()), "{features}: the crates were not read");
        crates.retain(|name| name.starts_with("wgpu") || name.starts_with("naga") || name == "pollster");
        crates
    };
    assert_eq!(of_card(""), [""; 0]);
    assert_eq!(of_card("shapeop/schema"), [""; 0]);
    let with_feature = of_card("shapeop/gpu");
    assert!(["wgpu", "naga", "pollster"].iter().all(|name| with_feature.contains(&(*name).to_owned())));
}

#[test]
fn no_crate_inside_the_default_library_is_built_unoptimised() {
    let inside = crates_of(&["--package", "shapeop"]);
    assert!(inside.contains(&"faer".to_owned()), "the crates were not read");
    let manifest = include_str!("../Cargo.toml");
    let unoptimised: Vec<&str> =
        manifest.lines().filter_map(|line| line.strip_suffix(" = { opt-level = 0 }")).collect();
    assert!(unoptimised.contains(&"naga"), "the profile was not read");
    let both: Vec<&&str> = unoptimised.iter().filter(|name| inside.iter().any(|other| other == *name)).collect();
    assert!(both.is_empty(), "{both:?}");
}

#[test]
fn the_reader_of_imports_reads() {
    let text =
        "use crate::mesh::Mesh;\n// use crate::solver::Solver;\nlet x = crate::linalg::small::svd(crate::error::y);";
    assert_eq!(imports(text), ["mesh", "linalg", "error"]);
}
