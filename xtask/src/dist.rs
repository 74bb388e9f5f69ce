//! `cargo xtask dist`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::shell;

/// The library's file name on this platform.
#[cfg(windows)]
const LIBRARY: &str = "shapeop.dll";
#[cfg(target_os = "macos")]
const LIBRARY: &str = "libshapeop.dylib";
#[cfg(not(any(windows, target_os = "macos")))]
const LIBRARY: &str = "libshapeop.so";

/// What a linker on Windows needs beside the library.
#[cfg(windows)]
const IMPORT_LIBRARY: &str = "shapeop.dll.lib";

/// The names under which old hosts look for the library. They lie in a folder of their own, because `libshapeop` and
/// `libShapeOp` are one name on Windows and macOS. The library has no SONAME, so a program that is linked with one of
/// these files asks for it by its own name.
#[cfg(target_os = "macos")]
const COMPAT_NAMES: [&str; 3] = ["libShapeOp.so", "ShapeOp.0.1.0.dll", "libShapeOp.dylib"];
#[cfg(not(target_os = "macos"))]
const COMPAT_NAMES: [&str; 2] = ["libShapeOp.so", "ShapeOp.0.1.0.dll"];

/// Builds the library and fills `folder`: `lib/`, `include/`, `compat/`.
pub fn run(folder: &Path, profile: &str) -> Result<()> {
    // With the workspace's selection of packages, so that what `cargo test --workspace` built is used.
    shell::run(shell::cargo().args(["build", "--quiet", "--workspace", "--lib", "--profile", profile]))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| shell::root().join("target"), Into::into);
    // The profiles dev and test build into `debug`.
    let built = target.join(if profile == "dev" || profile == "test" { "debug" } else { profile });
    let library = built.join(LIBRARY);
    let root = shell::root();
    copy(&library, &folder.join("lib").join(LIBRARY))?;
    #[cfg(windows)]
    copy(&built.join(IMPORT_LIBRARY), &folder.join("lib").join(IMPORT_LIBRARY))?;
    copy(&root.join("include/shapeop.h"), &folder.join("include/shapeop.h"))?;
    for header in ["API.h", "Common.h"] {
        copy(&root.join("include/compat").join(header), &folder.join("compat").join(header))?;
    }
    for name in COMPAT_NAMES {
        let to = folder.join("compat").join(name);
        copy(&library, &to)?;
        set_install_name(&to, name)?;
    }
    println!("{}", folder.display());
    Ok(())
}

/// On macOS a library carries the name under which programs linked with it look for it: that of the copy, not of the
/// original. Changing it voids the signature, so it is signed anew, without an identity.
#[cfg(target_os = "macos")]
fn set_install_name(library: &Path, name: &str) -> Result<()> {
    use std::process::Command;
    shell::run(Command::new("install_name_tool").args(["-id", &format!("@rpath/{name}")]).arg(library))?;
    shell::run(Command::new("codesign").args(["--force", "--sign", "-"]).arg(library))
}

#[cfg(not(target_os = "macos"))]
fn set_install_name(_library: &Path, _name: &str) -> Result<()> {
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).with_context(|| format!("{} could not be made", folder.display()))?;
    }
    // A file that a running program has loaded must not be written to: take it away first.
    if to.exists() {
        fs::remove_file(to).with_context(|| format!("{} could not be replaced", to.display()))?;
    }
    fs::copy(from, to).with_context(|| format!("{} could not be copied to {}", from.display(), to.display()))?;
    Ok(())
}
