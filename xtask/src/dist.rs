//! `cargo xtask dist`: an installation, which works wherever its folder is moved to.
//!
//! | folder | what is in it |
//! |---|---|
//! | `lib/` | the library; on Windows its import library too |
//! | `lib/pkgconfig/`, `lib/cmake/shapeop/` | how build systems find it |
//! | `include/` | the C header and the C++ wrapper |
//! | `compat/` | the headers and file names that programs written for libShapeOp look for |
//! | `share/licenses/shapeop/` | the licences |

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::{licences, shell};

/// The library's file name on this platform.
#[cfg(windows)]
pub const LIBRARY: &str = "shapeop.dll";
#[cfg(target_os = "macos")]
pub const LIBRARY: &str = "libshapeop.dylib";
#[cfg(not(any(windows, target_os = "macos")))]
pub const LIBRARY: &str = "libshapeop.so";

/// What a linker on Windows needs beside the library: what it is built as, and the name under which linkers look for it.
#[cfg(all(windows, target_env = "msvc"))]
const IMPORT_LIBRARY: Option<(&str, &str)> = Some(("shapeop.dll.lib", "shapeop.lib"));
#[cfg(all(windows, not(target_env = "msvc")))]
const IMPORT_LIBRARY: Option<(&str, &str)> = Some(("libshapeop.dll.a", "libshapeop.dll.a"));
#[cfg(not(windows))]
const IMPORT_LIBRARY: Option<(&str, &str)> = None;

/// The names under which old hosts look for the library. They lie in a folder of their own, because `libshapeop` and
/// `libShapeOp` are one name on Windows and macOS. The library has no SONAME, so a program that is linked with one of
/// these files asks for it by its own name.
#[cfg(target_os = "macos")]
const COMPAT_NAMES: [&str; 3] = ["libShapeOp.so", "ShapeOp.0.1.0.dll", "libShapeOp.dylib"];
#[cfg(not(target_os = "macos"))]
const COMPAT_NAMES: [&str; 2] = ["libShapeOp.so", "ShapeOp.0.1.0.dll"];

/// The C++ wrapper, below `bindings/cpp/include` and below `include`.
const WRAPPER: [&str; 7] = [
    "shapeop.hpp",
    "shapeop/error.hpp",
    "shapeop/exploration.hpp",
    "shapeop/problem.hpp",
    "shapeop/registry.hpp",
    "shapeop/solver.hpp",
    "shapeop/span.hpp",
];

/// What build systems read, below `bindings/cmake` (with the ending `.in`), and where it goes.
const BUILD_SYSTEM_FILES: [(&str, &str); 4] = [
    ("shapeop.pc", "lib/pkgconfig"),
    ("shapeop-config.cmake", "lib/cmake/shapeop"),
    ("shapeop-config-version.cmake", "lib/cmake/shapeop"),
    ("shapeop-targets.cmake", "lib/cmake/shapeop"),
];

/// Builds the library, with the graphics card if asked for, and fills `folder`.
pub fn run(folder: &Path, profile: &str, has_gpu: bool) -> Result<()> {
    // With the workspace's selection of packages, so that what `cargo test --workspace` built is used.
    let features = if has_gpu { "shapeop/gpu" } else { "" };
    let mut build = shell::cargo();
    build.args(["build", "--quiet", "--workspace", "--lib", "--profile", profile, "--features", features]);
    shell::run(&mut build)?;
    let built = shell::built(profile);
    let library = built.join(LIBRARY);
    let root = shell::root();
    copy(&library, &folder.join("lib").join(LIBRARY))?;
    set_install_name(&folder.join("lib").join(LIBRARY), LIBRARY)?;
    if let Some((built_as, name)) = IMPORT_LIBRARY {
        copy(&built.join(built_as), &folder.join("lib").join(name))?;
    }
    copy(&root.join("include/shapeop.h"), &folder.join("include/shapeop.h"))?;
    for header in WRAPPER {
        copy(&root.join("bindings/cpp/include").join(header), &folder.join("include").join(header))?;
    }
    for (name, place) in BUILD_SYSTEM_FILES {
        let template = root.join("bindings/cmake").join(format!("{name}.in"));
        let text =
            fs::read_to_string(&template).with_context(|| format!("{} could not be read", template.display()))?;
        write(&folder.join(place).join(name), &fill_in(&text).with_context(|| template.display().to_string())?)?;
    }
    let of_gpu = has_gpu.then_some(licences::FILE_OF_GPU);
    for licence in ["LICENSE-APACHE", "LICENSE-MIT", licences::FILE].into_iter().chain(of_gpu) {
        copy(&root.join(licence), &folder.join("share/licenses/shapeop").join(licence))?;
    }
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

/// A template with its `@PLACEHOLDERS@` filled in.
fn fill_in(template: &str) -> Result<String> {
    let version = env!("CARGO_PKG_VERSION");
    let import_library = IMPORT_LIBRARY.map(|(_, name)| format!("lib/{name}")).unwrap_or_default();
    let import_library_file = if import_library.is_empty() { String::new() } else { format!("\"{import_library}\"") };
    let platform_property = if cfg!(windows) {
        format!("IMPORTED_IMPLIB \"${{_shapeop_prefix}}/{import_library}\"")
    } else if cfg!(target_os = "macos") {
        format!("IMPORTED_SONAME \"@rpath/{LIBRARY}\"")
    } else {
        // Else programs would ask for it by its whole path.
        "IMPORTED_NO_SONAME TRUE".to_owned()
    };
    let text = template
        .replace("@VERSION@", version)
        .replace("@SAME@", compatible_prefix(version))
        .replace("@POINTER_BYTES@", &size_of::<usize>().to_string())
        .replace("@LIBRARY@", LIBRARY)
        .replace("@IMPORT_LIBRARY_FILE@", &import_library_file);
    ensure!(text.matches('@').count() == 2 * text.matches("@PLATFORM_PROPERTY@").count(), "a placeholder is unknown");
    Ok(text.replace("@PLATFORM_PROPERTY@", &platform_property))
}

/// What compatible versions begin with: all numbers up to the first that is not 0.
fn compatible_prefix(version: &str) -> &str {
    let digit = version.find(|c: char| c.is_ascii_digit() && c != '0').unwrap_or(version.len());
    let end = version[digit..].find('.').map_or(version.len(), |dot| digit + dot);
    &version[..end]
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

/// Makes the way free for a file: its folder is there, the file is not.
fn clear(to: &Path) -> Result<()> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).with_context(|| format!("{} could not be made", folder.display()))?;
    }
    // A file that a running program has loaded must not be written to: take it away first.
    if to.exists() {
        fs::remove_file(to).with_context(|| format!("{} could not be replaced", to.display()))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    clear(to)?;
    fs::copy(from, to).with_context(|| format!("{} could not be copied to {}", from.display(), to.display()))?;
    Ok(())
}

fn write(to: &Path, text: &str) -> Result<()> {
    clear(to)?;
    fs::write(to, text).with_context(|| format!("{} could not be written", to.display()))
}

/// The library in a folder that [`run`] filled.
pub fn library(folder: &Path) -> PathBuf {
    folder.join("lib").join(LIBRARY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_with_an_unknown_placeholder_is_refused() {
        assert_eq!(
            fill_in("@VERSION@ in lib/@LIBRARY@").unwrap(),
            format!("{} in lib/{LIBRARY}", env!("CARGO_PKG_VERSION"))
        );
        assert!(fill_in("@VERSION@ @VERSOIN@").is_err());
    }

    #[test]
    fn versions_are_compatible_up_to_the_first_number_that_is_not_0() {
        assert_eq!(compatible_prefix("0.1.0"), "0.1");
        assert_eq!(compatible_prefix("0.0.10"), "0.0.10");
        assert_eq!(compatible_prefix("1.2.3"), "1");
        assert_eq!(compatible_prefix("10.2.3"), "10");
    }
}
