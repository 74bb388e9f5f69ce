//! Building and running programs in other languages against the library as `cargo xtask dist` lays it out.

#![allow(dead_code, reason = "no test uses all of it")]

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::time::Duration;

/// The age of a folder that no running test uses.
const EARLIER: Duration = Duration::from_secs(3600);

/// A language of the system compiler.
#[derive(Clone, Copy, Debug)]
pub enum Language {
    C,
    Cpp,
}

impl Language {
    pub fn extension(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Cpp => "cpp",
        }
    }

    /// The standard and the warnings that our sources keep to.
    pub fn strict(self) -> &'static [&'static str] {
        match self {
            Self::C => &["-xc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"],
            Self::Cpp => &["-xc++", "-std=c++17", "-pedantic", "-Wall", "-Wextra", "-Werror"],
        }
    }
}

/// Says loudly that a part of a test is left out, here and in the file that `cargo xtask test` reads; with CI=true,
/// fails.
pub fn leave_out(what: &str) {
    assert!(std::env::var("CI").as_deref() != Ok("true"), "CI leaves nothing out, but: {what}");
    println!("LEFT OUT: {what}");
    if let Some(file) = std::env::var_os("SHAPEOP_LEFT_OUT") {
        let opened = fs::OpenOptions::new().create(true).append(true).open(file);
        writeln!(opened.unwrap(), "{what}").unwrap();
    }
}

fn works(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// The first of the programs that can be run.
pub fn program(variable: &str, names: &[&str]) -> Option<String> {
    let named = std::env::var(variable).ok();
    named.iter().map(String::as_str).chain(names.iter().copied()).find(|name| works(name)).map(str::to_owned)
}

/// The system compiler; says so if there is none.
pub fn compiler(language: Language) -> Option<String> {
    let found = match language {
        Language::C => program("CC", &["cc", "gcc", "clang"]),
        Language::Cpp => program("CXX", &["c++", "g++", "clang++"]),
    };
    if found.is_none() {
        leave_out(&format!("what needs a compiler for {language:?}, as none was found"));
    }
    found
}

/// An empty folder for the files of a test of this process. Those of earlier runs are removed: after an hour, none runs.
pub fn scratch(name: &str) -> PathBuf {
    let all = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let is_old = |entry: &fs::DirEntry| {
        let age = entry.metadata().and_then(|data| data.modified()).ok().and_then(|time| time.elapsed().ok());
        entry.file_name().to_string_lossy().starts_with(&format!("{name}-")) && age.is_some_and(|age| age > EARLIER)
    };
    for entry in fs::read_dir(all).into_iter().flatten().flatten().filter(is_old) {
        // Another process may be removing it, too.
        let _ = fs::remove_dir_all(entry.path());
    }
    let folder = all.join(format!("{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The folder that `cargo xtask dist` makes, made once per process.
pub fn dist() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = scratch("dist");
        let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
        let mut command = Command::new(env!("CARGO"));
        command.args(["run", "--quiet", "--package", "xtask", "--", "dist", "--profile", profile]).arg(&folder);
        let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
        assert!(output.status.success(), "dist failed: {}", said(&output));
        folder
    })
}

/// What a program said.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// True if programs can be built and run under the sanitizers.
fn has_sanitizer(language: Language, compiler: &str) -> bool {
    let folder = scratch(&format!("sanitizer-{language:?}-{:?}", std::thread::current().id()));
    let (source, program) = (folder.join("none.c"), folder.join("none"));
    fs::write(&source, "int main(void) { return 0; }\n").unwrap();
    let mut build = Command::new(compiler);
    build.args(["-fsanitize=address,undefined", "-x", "c"]).arg(&source).arg("-o").arg(&program);
    build.output().is_ok_and(|output| output.status.success())
        && Command::new(&program).output().is_ok_and(|output| output.status.success())
}

/// Builds `source` (in `tests/`) against the library `name` in `folder` of the distribution, and runs it. An old
/// program, in `compat`, sees only that folder.
pub fn build_and_run(language: Language, source: &str, folder: &str, name: &str) -> Option<Output> {
    let compiler = compiler(language)?;
    let libraries = dist().join(folder);
    let program =
        scratch(&format!("{language:?}-{}", source.replace(['/', '.'], "-"))).join(format!("program{EXE_SUFFIX}"));
    let mut command = Command::new(&compiler);
    command.args(language.strict()).args(["-g", "-O1"]);
    if has_sanitizer(language, &compiler) {
        command.args(["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"]);
    } else {
        leave_out(&format!("AddressSanitizer for {source}, as {compiler} has none"));
    }
    command.arg("-I").arg(dist().join("compat"));
    if folder != "compat" {
        command.arg("-I").arg(dist().join("include"));
    }
    command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(source));
    command.arg("-L").arg(&libraries).arg(format!("-l{name}")).args(["-lm", "-lpthread", "-o"]).arg(&program);
    command.arg(format!("-Wl,-rpath,{}", libraries.display()));
    let built = command.output().unwrap();
    assert!(built.status.success(), "{source}: {}", said(&built));
    let output = Command::new(&program).output().unwrap();
    assert!(output.status.success(), "{source} ended with {}: {}", output.status, said(&output));
    Some(output)
}
