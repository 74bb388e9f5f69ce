//! `cargo xtask test`.

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Result, bail};

use crate::shell;

/// A program that tests run, and the Debian package that brings it.
struct Tool {
    /// Any of these will do.
    names: &'static [&'static str],
    package: &'static str,
}

/// What the tests need beside Rust. They leave out what is not there, and say so.
const TOOLS: [Tool; 4] = [
    Tool { names: &["cc", "gcc", "clang"], package: "gcc" },
    Tool { names: &["c++", "g++", "clang++"], package: "g++" },
    Tool { names: &["python3", "python"], package: "python3" },
    Tool { names: &["readelf"], package: "binutils" },
];

/// Tries of a download before giving up, with pauses of 5, 10, ... seconds between them.
const DOWNLOAD_TRIES: u64 = 4;

/// Sets up what the tests need, runs all of them, and says what was left out. With `CI=true` nothing may be.
pub fn run() -> Result<()> {
    let is_ci = std::env::var("CI").as_deref() == Ok("true");
    let missing: Vec<&Tool> = TOOLS.iter().filter(|tool| !tool.is_there()).collect();
    if !missing.is_empty() {
        install(&missing.iter().map(|tool| tool.package).collect::<Vec<_>>());
    }
    let still_missing: Vec<&str> = missing.iter().filter(|tool| !tool.is_there()).map(|tool| tool.package).collect();
    if is_ci && !still_missing.is_empty() {
        bail!("CI leaves nothing out, but these packages are missing: {}", still_missing.join(", "));
    }

    // Tests write what they leave out into this file, one line each.
    let left_out = shell::root().join("target/left-out.txt");
    fs::create_dir_all(shell::root().join("target"))?;
    fs::write(&left_out, "")?;
    let cargo_test = |arguments: &[&str]| {
        println!("cargo test {}", arguments.join(" "));
        shell::run(shell::cargo().arg("test").args(arguments).env("SHAPEOP_LEFT_OUT", &left_out))
    };
    cargo_test(&["--workspace"])?;
    cargo_test(&["--workspace", "--features", "shapeop/schema", "--test", "schema"])?;

    let mut lines: Vec<String> = fs::read_to_string(&left_out)?.lines().map(str::to_owned).collect();
    lines.sort();
    lines.dedup();
    if lines.is_empty() {
        println!("All tests passed; nothing was left out.");
    } else {
        println!("All tests passed, but {} THINGS WERE LEFT OUT:", lines.len());
        lines.iter().for_each(|line| println!("  LEFT OUT: {line}"));
    }
    Ok(())
}

impl Tool {
    fn is_there(&self) -> bool {
        let runs = |name: &&str| quiet(name, &["--version"]);
        self.names.iter().any(runs)
    }
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
        shell::run(&mut command).is_ok()
    };
    for try_number in 1..=DOWNLOAD_TRIES {
        let arguments = [&["install", "--yes", "--no-install-recommends"], packages].concat();
        if apt(&["update"]) && apt(&arguments) {
            return;
        }
        if try_number < DOWNLOAD_TRIES {
            println!("Try {try_number} of {DOWNLOAD_TRIES} failed; waiting");
            sleep(Duration::from_secs(5 * try_number));
        }
    }
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
