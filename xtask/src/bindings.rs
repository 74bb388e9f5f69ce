//! The tests of the bindings, and what they are set up with.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use anyhow::Result;

use crate::suites::{Places, Step, Suite};
use crate::{dist, setup, shell};

/// What the Python tests install, in `pip install`'s words.
const REQUIREMENTS: [&str; 7] = [
    "--requirement",
    "bindings/python/requirements-test.txt",
    "--requirement",
    "examples/paper/requirements.txt",
    "dotnetcore2==3.1.23",
    "mypy==2.4.1",
    "ruff==0.17.6",
];

/// What the Grasshopper tests install: apart, as COMPAS takes the stubs of Rhino for Rhino.
const GRASSHOPPER_REQUIREMENTS: [&str; 6] = [
    "--requirement",
    "ghpython/tests/requirements.txt",
    "--requirement",
    "ghpython/packaging/requirements-test.txt",
    "--requirement",
    "examples/paper/requirements.txt",
];

/// What the peers of exploration and their tests install.
const PEER_REQUIREMENTS: [&str; 3] = ["--requirement", "benches/peers/requirements.txt", "pytest==9.2.0"];

/// Packages that carry user objects of other authors, which ours are compared with.
const PUBLIC_FILES: [&str; 3] = ["compas==2.15.1", "compas-fab==2.0.1", "ladybug-grasshopper==1.72.5"];

/// Compiles the tests of the .NET binding, warnings refused.
const CSHARP_TESTS: Step = &[
    "mcs",
    "-langversion:7.2",
    "-warn:4",
    "-warnaserror",
    "-out:{work}/Tests.exe",
    "-recurse:{source}/bindings/csharp/ShapeOp/*.cs",
    "-recurse:{source}/tests/csharp/Tests/*.cs",
];

/// The tests of each binding beside the three problems.
pub const SUITES: [Suite; 18] = [
    // As long as all others together: first, so that nothing waits for it.
    Suite {
        name: "Grasshopper files",
        environment: &[("SHAPEOP_LIBRARY", "{library}"), ("SHAPEOP_GH_FILES", "{ghfiles}")],
        steps: &[&[
            "{ghpython}",
            "-m",
            "pytest",
            "-q",
            "-rs",
            "-p",
            "no:cacheprovider",
            "{source}/ghpython/packaging/tests",
        ]],
    },
    Suite {
        name: "format, lints and types of the Python sources",
        environment: &[],
        steps: &[
            &["{python}", "-m", "ruff", "format", "--no-cache", "--check", "{source}"],
            &["{python}", "-m", "ruff", "check", "--no-cache", "{source}"],
            &[
                "{python}",
                "-m",
                "mypy",
                "--config-file",
                "{source}/bindings/python/pyproject.toml",
                "--cache-dir",
                "{work}",
            ],
        ],
    },
    Suite {
        name: "C# on Mono: truths and refusals",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[CSHARP_TESTS, &["mono", "{work}/Tests.exe"]],
    },
    Suite {
        name: "C# on CoreCLR: truths and refusals",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[CSHARP_TESTS, &["{python}", "{source}/tests/csharp/coreclr.py", "{work}/Tests.exe"]],
    },
    Suite {
        name: "a NuGet package, unpacked and run on Mono",
        environment: &[],
        steps: &[
            &[
                "mcs",
                "-langversion:7.2",
                "-target:library",
                "-doc:{work}/ShapeOp.xml",
                "-out:{work}/ShapeOp.dll",
                "-recurse:{source}/bindings/csharp/ShapeOp/*.cs",
            ],
            &[
                "mcs",
                "-langversion:7.2",
                "-r:{work}/ShapeOp.dll",
                "-out:{work}/Tests.exe",
                "-recurse:{source}/tests/csharp/Tests/*.cs",
            ],
            &[
                "{python}",
                "{source}/bindings/csharp/pack.py",
                "{work}/ShapeOp.dll",
                "--native",
                "linux-x64={library}",
                "--out",
                "{work}",
            ],
            &["{python}", "{source}/tests/csharp/package.py", "{work}", "{work}/Tests.exe"],
        ],
    },
    Suite {
        name: "Grasshopper components under CPython 3",
        environment: &[("SHAPEOP_LIBRARY", "{library}")],
        steps: &[&["{ghpython}", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "{source}/ghpython/tests"]],
    },
    Suite {
        name: "Grasshopper components under CPython 3.9",
        environment: &[("SHAPEOP_LIBRARY", "{library}"), ("PYTHONDONTWRITEBYTECODE", "1")],
        steps: &[&["{python39}", "-m", "unittest", "discover", "-s", "{source}/ghpython/tests"]],
    },
    Suite {
        name: "Grasshopper components under CPython 2.7",
        environment: &[("SHAPEOP_LIBRARY", "{library}"), ("PYTHONDONTWRITEBYTECODE", "1")],
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
        steps: &[&["{python}", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "{source}/examples/paper"]],
    },
    Suite {
        name: "solvers of hard constraints to compare with",
        environment: &[("PYTHONDONTWRITEBYTECODE", "1")],
        steps: &[&["{peers}", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "{source}/benches/peers"]],
    },
    Suite {
        name: "tests of the Python package",
        environment: &[],
        steps: &[&["{python}", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "{source}/bindings/python"]],
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

/// Lays out the library and makes the Python environments; returns where they are.
pub fn set_up(profile: &str) -> Result<Places> {
    let root = shell::root();
    let mut places = Places::default();
    let folder = root.join("target/dist");
    dist::run(&folder, profile, false)?;
    // Side by side: each waits for its downloads.
    let (python, grasshopper, peers) = thread::scope(|scope| {
        let python = scope.spawn(|| environment(&root.join("target/python"), &REQUIREMENTS));
        let peers = scope.spawn(peers);
        let grasshopper = environment(&root.join("target/ghpython"), &GRASSHOPPER_REQUIREMENTS);
        (shell::joined(python), grasshopper, shell::joined(peers))
    });
    let (python, grasshopper) = (python?, grasshopper?);
    // The wheel with the library that the other tests use.
    let mut install = Command::new(&python);
    install.args(["-m", "pip", "--disable-pip-version-check", "install", "--quiet", "--force-reinstall", "--no-deps"]);
    install.arg(root.join("bindings/python")).env("SHAPEOP_LIBRARY_TO_BUNDLE", dist::library(&folder));
    shell::run(&mut install)?;
    places.set("library", dist::library(&folder));
    places.set("dist", folder);
    places.set("source", &root);
    places.set("ghfiles", public_files(&grasshopper, root.join("target/ghfiles"))?);
    places.set("ghpython", grasshopper);
    places.set("python", python);
    if let Some(python) = peers? {
        places.set("peers", python);
    }
    // Those of Rhino 7 and Rhino 8.
    for (name, version) in [("python27", "2.7"), ("python39", "3.9")] {
        if let Some(python) = setup::python(version) {
            places.set(name, python);
        }
    }
    Ok(places)
}

/// An environment of the newest CPython for which all of the requirements exist.
fn environment(folder: &Path, requirements: &[&str]) -> Result<PathBuf> {
    let found = ["3.12", "3.11", "3.10"].iter().find_map(|version| setup::python(version));
    let requirements: Vec<String> = requirements.iter().map(|&each| each.to_owned()).collect();
    setup::environment(&found.map_or_else(setup::any_python, Ok)?, folder, &requirements)
}

/// The Python of `benches/peers`; `None` without a CPython for which all that they need exists.
pub fn peers() -> Result<Option<PathBuf>> {
    let Some(python) = ["3.13", "3.12", "3.11"].iter().find_map(|version| setup::python(version)) else {
        return Ok(None);
    };
    let requirements = PEER_REQUIREMENTS.map(str::to_owned);
    setup::environment(&python, &shell::root().join("target/peers"), &requirements).map(Some)
}

/// The folder with the wheels of the public files; downloaded once.
fn public_files(python: &Path, folder: PathBuf) -> Result<PathBuf> {
    let wheels = || fs::read_dir(&folder).map_or(0, |entries| entries.flatten().count());
    if wheels() < PUBLIC_FILES.len() {
        let arguments = ["download", "--no-deps", "--only-binary", ":all:", "--dest"].map(str::to_owned);
        let packages = PUBLIC_FILES.map(str::to_owned);
        setup::pip(python, &[&arguments[..], &[folder.to_string_lossy().into_owned()], &packages].concat())?;
    }
    Ok(folder)
}
