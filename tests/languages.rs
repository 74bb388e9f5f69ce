//! Programs in C, C++ and Python against the library as `cargo xtask dist` lays it out.

mod programs;

use std::path::Path;
use std::process::Command;

use programs::{Language, build_and_run, dist, leave_out, program, said};

#[test]
fn an_old_program_runs_with_only_its_old_header_and_library_name() {
    if let Some(output) = build_and_run(Language::C, "c/old_program.c", "compat", "ShapeOp") {
        assert!(said(&output).contains("all is well"));
    }
}

#[test]
fn an_old_program_runs_as_cpp_too() {
    if let Some(output) = build_and_run(Language::Cpp, "c/old_program.c", "compat", "ShapeOp") {
        assert!(said(&output).contains("all is well"));
    }
}

#[test]
fn a_c_program_uses_the_whole_header() {
    if let Some(output) = build_and_run(Language::C, "c/new_program.c", "lib", "shapeop") {
        let said = said(&output);
        assert!(said.contains("Plane (") && said.contains("EdgeStrain ("), "{said}");
    }
}

#[test]
fn a_cpp_program_solves_on_many_threads() {
    if let Some(output) = build_and_run(Language::Cpp, "cpp/program.cpp", "lib", "shapeop") {
        assert!(said(&output).contains("all is well"));
    }
}

/// Runs a script that loads `ShapeOp.0.1.0.dll` by that name alone.
fn run_python(script: &str) {
    let Some(python) = program("PYTHON", &["python3", "python"]) else {
        return leave_out(&format!("{script}, as no Python was found"));
    };
    let compat = dist().join("compat");
    // Where each platform's loader looks for a bare name.
    let variable = match std::env::consts::OS {
        "windows" => "PATH",
        "macos" => "DYLD_LIBRARY_PATH",
        _ => "LD_LIBRARY_PATH",
    };
    let mut paths = vec![compat];
    paths.extend(std::env::var_os(variable).iter().flat_map(std::env::split_paths));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python").join(script);
    let mut command = Command::new(python);
    let output = command.arg(file).env(variable, std::env::join_paths(paths).unwrap()).output().unwrap();
    assert!(output.status.success(), "{script} ended with {}: {}", output.status, said(&output));
    println!("{}", said(&output).trim());
}

#[test]
fn a_python_caller_that_declares_nothing_works() {
    run_python("undeclared.py");
}

#[test]
fn the_published_client_s_loop_costs_no_factorisation() {
    run_python("client_loop.py");
}

#[test]
#[cfg(target_os = "linux")]
fn a_library_under_an_old_name_is_asked_for_by_that_name() {
    // A SONAME would make a program that was linked with libShapeOp.so ask for another file.
    let Some(readelf) = program("READELF", &["readelf"]) else {
        return leave_out("the look at the SONAME, as readelf was not found");
    };
    for name in ["libShapeOp.so", "ShapeOp.0.1.0.dll"] {
        let output = Command::new(&readelf).arg("--dynamic").arg(dist().join("compat").join(name)).output().unwrap();
        let said = said(&output);
        assert!(said.contains("NEEDED") && !said.contains("SONAME"), "{said}");
    }
}
