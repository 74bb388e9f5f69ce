//! The tests of the bindings, and what they are set up with.

use std::path::{Path, PathBuf};

use anyhow::Result;

use crate::suites::{Places, Suite};
use crate::{dist, setup, shell};

/// What the Python tests install, in `pip install`'s words.
const REQUIREMENTS: [&str; 7] = [
    "--requirement",
    "bindings/python/requirements-test.txt",
    "--requirement",
    "examples/paper/requirements.txt",
    "--requirement",
    "ghpython/tests/requirements.txt",
    "dotnetcore2==3.1.23",
];

/// The tests of each binding beside the three problems.
pub const SUITES: [Suite; 11] = [
    Suite {
        name: "Grasshopper components under CPython 3",
        environment: &[("SHAPEOP_LIBRARY", "{dist}/lib/libshapeop.so")],
        steps: &[&["{python}", "-m", "pytest", "-q", "-p", "no:cacheprovider", "{source}/ghpython/tests"]],
    },
    Suite {
        name: "Grasshopper components under CPython 2.7",
        environment: &[("SHAPEOP_LIBRARY", "{dist}/lib/libshapeop.so"), ("PYTHONDONTWRITEBYTECODE", "1")],
        steps: &[&["{python27}", "-m", "unittest", "discover", "-s", "{source}/ghpython/tests"]],
    },
    Suite {
        name: "Grasshopper components under Jython",
        environment: &[("PYTHONDONTWRITEBYTECODE", "1")],
        steps: &[&["jython", "-m", "unittest", "discover", "-s", "{source}/ghpython/tests"]],
    },
    Suite {
        name: "a CMake project against a moved installation",
        environment: &[],
        steps: &[
            &["cmake", "-E", "copy_directory", "{dist}", "{work}/moved"],
            &["cmake", "-S", "{source}/tests/cpp", "-B", "{work}/build", "-DSHAPEOP_PREFIX={work}/moved"],
            &["cmake", "--build", "{work}/build"],
            &["ctest", "--test-dir", "{work}/build", "--output-on-failure"],
        ],
    },
    Suite {
        name: "cc with pkg-config against a moved installation",
        environment: &[],
        steps: &[
            &["cmake", "-E", "copy_directory", "{dist}", "{work}/moved"],
            &["cmake", "-DSHAPEOP_PREFIX={work}/moved", "-DWORK={work}", "-P", "{source}/tests/cpp/pkg_config.cmake"],
        ],
    },
    Suite {
        name: "the eight examples of the ShapeOp paper",
        environment: &[],
        steps: &[&["{python}", "-m", "pytest", "-q", "-p", "no:cacheprovider", "{source}/examples/paper"]],
    },
    Suite {
        name: "tests of the Python package",
        environment: &[],
        steps: &[&["{python}", "-m", "pytest", "-q", "-p", "no:cacheprovider", "{source}/bindings/python"]],
    },
    Suite {
        name: "mistakes in SWIG Python",
        environment: &[("PYTHONPATH", "{work}")],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "python", "--prefix", "{dist}", "--work", "{work}"],
            &["{python}", "{source}/tests/swig/mistakes.py"],
        ],
    },
    Suite {
        name: "mistakes in SWIG Java",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "java", "--prefix", "{dist}", "--work", "{work}"],
            &["javac", "-cp", "{work}/shapeopJava.jar", "-d", "{work}/java", "{source}/tests/java/Mistakes.java"],
            // Compiled at once, so that arrays are collected as early as they can be.
            &[
                "java",
                "-Xcomp",
                "-XX:CompileOnly=Mistakes,shapeopJava,doubleArray",
                "-Djava.library.path={work}",
                "-cp",
                "{work}/shapeopJava.jar:{work}/java",
                "Mistakes",
            ],
        ],
    },
    Suite {
        name: "mistakes in SWIG C#",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "csharp", "--prefix", "{dist}", "--work", "{work}"],
            &["mcs", "-r:{work}/shapeopCSharp.dll", "-out:{work}/Mistakes.exe", "{source}/tests/swig/Mistakes.cs"],
            &["mono", "{work}/Mistakes.exe"],
        ],
    },
    Suite {
        name: "mistakes in Jython",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "java", "--prefix", "{dist}", "--work", "{work}"],
            &[
                "java",
                "-Djava.library.path={work}",
                "-cp",
                "/usr/share/java/jython.jar:{work}/shapeopJava.jar",
                "org.python.util.jython",
                "{source}/tests/jython/mistakes.py",
            ],
        ],
    },
];

/// Lays out the library and makes the Python environment; returns where they are.
pub fn set_up(profile: &str) -> Result<Places> {
    let root = shell::root();
    let mut places = Places::default();
    let folder = root.join("target/dist");
    dist::run(&folder, profile)?;
    let python = python(&root.join("target/python"))?;
    // The wheel with the library that the other tests use.
    let mut install = std::process::Command::new(&python);
    install.args(["-m", "pip", "--disable-pip-version-check", "install", "--quiet", "--force-reinstall", "--no-deps"]);
    install.arg(root.join("bindings/python")).env("SHAPEOP_LIBRARY_TO_BUNDLE", dist::library(&folder));
    shell::run(&mut install)?;
    places.set("dist", folder);
    places.set("source", &root);
    places.set("python", python);
    if let Some(python27) = setup::python("2.7") {
        places.set("python27", python27);
    }
    Ok(places)
}

/// The environment of the tests, of the newest CPython for which all of the requirements exist.
fn python(folder: &Path) -> Result<PathBuf> {
    let found = ["3.12", "3.11", "3.10"].iter().find_map(|version| setup::python(version));
    setup::environment(&found.map_or_else(setup::any_python, Ok)?, folder, &REQUIREMENTS.map(str::to_owned))
}
