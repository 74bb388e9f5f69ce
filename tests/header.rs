//! The C headers: they compile alone and together, and say what the library says.

mod programs;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use programs::{Language, compiler, scratch};
use shapeop::error::Status;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

fn read(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap()
}

/// `name -> number` of every error code.
fn enumerators(header: &str) -> BTreeMap<String, i32> {
    let (_, from) = header.split_once("enum shapeop_err {").unwrap();
    let (codes, _) = from.split_once('}').unwrap();
    let numbered = codes.lines().filter_map(|line| line.trim().trim_end_matches(',').split_once(" = "));
    numbered.map(|(name, number)| (name.to_owned(), number.parse().unwrap())).collect()
}

/// The names of the functions that lines with `marker` outside of comments declare or define.
fn functions(text: &str, marker: &str) -> Vec<String> {
    let is_code = |line: &&str| !line.trim_start().starts_with(['*', '/', '#']) && line.contains(marker);
    let before_arguments = text.lines().filter(is_code).filter_map(|line| Some(line.split_once('(')?.0));
    let last_word = before_arguments.filter_map(|line| line.split([' ', '*']).next_back());
    let mut names: Vec<String> = last_word.filter(|word| word.starts_with("shapeop_")).map(str::to_owned).collect();
    names.sort();
    names
}

#[test]
fn both_headers_number_errors_as_the_library_does() {
    let generated = enumerators(&read("include/shapeop.h"));
    assert_eq!(generated, enumerators(&read("include/compat/API.h")));
    assert_eq!(generated.len(), Status::ALL.len() + 1);
    assert_eq!(generated["SO_SUCCESS"], 0);
    for status in Status::ALL {
        let snake = format!("{status:?}").chars().fold(String::new(), |name, c| {
            if c.is_uppercase() { name + "_" + &c.to_string() } else { name + &c.to_uppercase().to_string() }
        });
        assert_eq!(generated[&format!("SO{snake}")], *status as i32);
    }
}

#[test]
fn the_header_declares_every_function_of_the_boundary() {
    let mut defined = Vec::new();
    for folder in ["src/capi", "src/capi/canal", "src/capi/ruled", "src/capi/snakes"] {
        let files = fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        for file in files.filter(|path| path.is_file()) {
            defined.extend(functions(&fs::read_to_string(file).unwrap(), "extern \"C\" fn "));
        }
    }
    defined.sort();
    let declared = functions(&read("include/shapeop.h"), "shapeop_");
    assert_eq!(declared, defined);
    assert!(declared.len() > 35);
}

#[test]
fn the_compatibility_header_declares_the_fourteen_functions() {
    let declared = functions(&read("include/compat/API.h"), "SHAPEOP_API ");
    let expected = [
        "addConstraint",
        "addGravityForce",
        "addVertexForce",
        "create",
        "delete",
        "editConstraint",
        "editVertexForce",
        "getPoints",
        "init",
        "initDynamic",
        "setDamping",
        "setPoints",
        "setTimeStep",
        "solve",
    ];
    assert_eq!(declared, expected.map(|name| format!("shapeop_{name}")));
}

#[test]
fn headers_compile_alone_and_together_as_c99_and_cpp17() {
    let folder = scratch("headers");
    let sources = [
        ("shapeop", "#include \"shapeop.h\"\n"),
        ("api", "#include \"API.h\"\n"),
        ("common", "#include \"Common.h\"\nextern ShapeOpScalar x;\n"),
        ("both", "#include \"shapeop.h\"\n#include \"API.h\"\n"),
        ("reversed", "#include \"API.h\"\n#include \"shapeop.h\"\n"),
        ("twice", "#include \"API.h\"\n#include \"Common.h\"\n#include \"API.h\"\n"),
    ];
    for language in [Language::C, Language::Cpp] {
        let Some(compiler) = compiler(language) else { continue };
        for (name, source) in sources {
            // Uses what the header declares, so that a guard that swallowed it is seen.
            let use_it = match name {
                "common" => "",
                "api" | "twice" => "shapeop_err f(ShapeOpSolver *op); int g(void) { return shapeop_init(0); }\n",
                _ => "shapeop_err f(ShapeOpSolver *op) { return shapeop_energy(op, 0); }\n",
            };
            let file = folder.join(name).with_extension(language.extension());
            fs::write(&file, format!("{source}{use_it}")).unwrap();
            let mut command = Command::new(&compiler);
            command.args(language.strict()).arg("-c").arg(&file).arg("-o").arg(folder.join("out.o"));
            let output = command.arg("-I").arg(root().join("include")).arg("-I").arg(root().join("include/compat"));
            let output = output.output().unwrap();
            assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        }
    }
}
