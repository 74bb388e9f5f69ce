//! Running the program, and looking at what it wrote.

#![allow(dead_code, reason = "each test program uses some of it")]

use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Stdio;
use std::process::{Command, Output};
#[cfg(unix)]
use std::time::{Duration, Instant};

use serde_json::Value;
use shapeop::mesh::{Mesh, file};

pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

pub fn mesh_path(name: &str) -> String {
    repository().join("examples/meshes").join(name).display().to_string()
}

pub fn example(name: &str) -> String {
    repository().join("examples").join(name).display().to_string()
}

/// A folder of its own for a test, removed at the end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("shapeop-cli-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.path(name), text).unwrap();
        self.path(name).display().to_string()
    }

    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs the program and stops it with Ctrl-C, so long after `begun` is there if it is given, after the start otherwise. The exit code
/// is that of programs that are stopped so; returns what it printed.
#[cfg(unix)]
pub fn interrupt(arguments: &[&str], begun: Option<&Path>, after: Duration) -> String {
    let child = Command::new(env!("CARGO_BIN_EXE_shapeop")).args(arguments).stdout(Stdio::piped()).spawn().unwrap();
    let started = Instant::now();
    while begun.is_some_and(|path| !path.exists()) && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(after);
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    String::from_utf8(output.stdout).unwrap()
}

pub fn shapeop(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_shapeop")).args(arguments).output().unwrap()
}

pub fn shapeop_into(folder: &Folder, arguments: &[&str]) -> Output {
    let out = folder.0.display().to_string();
    shapeop(&[arguments, &["-o", &out]].concat())
}

/// A folder with the examples of an area, where commands of its help and documentation find them.
pub fn workplace(name: &str, area: &str) -> Folder {
    let folder = Folder::new(name);
    let examples = folder.path("examples").join(area);
    std::fs::create_dir_all(&examples).unwrap();
    for entry in std::fs::read_dir(repository().join("examples").join(area)).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, examples.join(path.file_name().unwrap())).unwrap();
    }
    folder
}

/// Runs a line as someone would type it, with further options.
#[track_caller]
pub fn run_line(folder: &Folder, line: &str, options: &[&str]) {
    let mut words = line.split_whitespace();
    assert_eq!(words.next(), Some("shapeop"), "{line}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_shapeop"));
    let output = command.args(words).args(options).current_dir(&folder.0).output().unwrap();
    assert!(output.status.success(), "{line}\n{}", String::from_utf8_lossy(&output.stderr));
}

/// The lines of a document's shell blocks that call the program.
pub fn commands_of(document: &str) -> Vec<String> {
    let text = std::fs::read_to_string(repository().join(document)).unwrap();
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let lines = blocks.flat_map(str::lines).filter(|line| line.starts_with("shapeop "));
    lines.map(|line| line.split(" #").next().unwrap_or_default().to_owned()).collect()
}

/// A mesh as the text of an OBJ file.
pub fn obj(mesh: &Mesh) -> String {
    String::from_utf8(file::encode(mesh, file::Format::Obj).unwrap()).unwrap()
}

#[track_caller]
pub fn said(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What was said on standard error by a call that was refused.
#[track_caller]
pub fn refused(output: &Output, code: i32) -> String {
    let stderr = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(code), "{stderr}");
    assert!(output.stdout.is_empty());
    stderr
}

pub fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Width and height of a PNG, which its first chunk states.
pub fn png_size(path: &Path) -> (u32, u32) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

#[track_caller]
pub fn assert_close(value: &Value, expected: f64) {
    let value = value.as_f64().unwrap();
    assert!((value - expected).abs() <= 1e-12 * expected.abs().max(1e-12), "{value} is not {expected}");
}
