//! The three problems of `tests/languages/README.md` in every language, compared with the Rust program's points.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::shell;
use crate::suites::{LeftOut, Places, Suite};

/// The files that a program writes.
pub const PROBLEMS: [&str; 3] = ["quad", "planarise", "cloth"];

/// The largest difference, of the model's size, that passes.
pub const TOLERANCE: f64 = 1e-12;

/// How a program is built from its sources and run, in every language.
const LANGUAGES: [Suite; 9] = [
    Suite {
        name: "C",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[
            &[
                "cc",
                "-std=c99",
                "-O1",
                "-I{dist}/include",
                "{source}/tests/c/three_problems.c",
                "-L{dist}/lib",
                "-lshapeop",
                "-lm",
                "-o",
                "{work}/program",
            ],
            &["{work}/program", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "C++",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[
            &[
                "c++",
                "-std=c++17",
                "-O1",
                "-I{dist}/include",
                "{source}/tests/cpp/three_problems.cpp",
                "-L{dist}/lib",
                "-lshapeop",
                "-o",
                "{work}/program",
            ],
            &["{work}/program", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "Python",
        environment: &[],
        steps: &[&["{python}", "{source}/tests/python/three_problems.py", "{mesh}", "{out}"]],
    },
    Suite {
        name: "C# on Mono",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[
            &[
                "mcs",
                "-langversion:7.2",
                "-out:{work}/ThreeProblems.exe",
                "-recurse:{source}/bindings/csharp/ShapeOp/*.cs",
                "{source}/tests/csharp/ThreeProblems.cs",
            ],
            &["mono", "{work}/ThreeProblems.exe", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "C# on CoreCLR",
        environment: &[("LD_LIBRARY_PATH", "{dist}/lib")],
        steps: &[
            &[
                "mcs",
                "-langversion:7.2",
                "-out:{work}/ThreeProblems.exe",
                "-recurse:{source}/bindings/csharp/ShapeOp/*.cs",
                "{source}/tests/csharp/ThreeProblems.cs",
            ],
            &["{python}", "{source}/tests/csharp/coreclr.py", "{work}/ThreeProblems.exe", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "SWIG Python",
        environment: &[("PYTHONPATH", "{work}")],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "python", "--prefix", "{dist}", "--work", "{work}"],
            &["{python}", "{source}/tests/swig/three_problems.py", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "SWIG Java",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "java", "--prefix", "{dist}", "--work", "{work}"],
            &["javac", "-cp", "{work}/shapeopJava.jar", "-d", "{work}/java", "{source}/tests/java/ThreeProblems.java"],
            &[
                "java",
                "-Djava.library.path={work}",
                "-cp",
                "{work}/shapeopJava.jar:{work}/java",
                "ThreeProblems",
                "{mesh}",
                "{out}",
            ],
        ],
    },
    Suite {
        name: "SWIG C#",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "csharp", "--prefix", "{dist}", "--work", "{work}"],
            &[
                "mcs",
                "-r:{work}/shapeopCSharp.dll",
                "-out:{work}/ThreeProblems.exe",
                "{source}/tests/swig/ThreeProblems.cs",
            ],
            &["mono", "{work}/ThreeProblems.exe", "{mesh}", "{out}"],
        ],
    },
    Suite {
        name: "Jython",
        environment: &[],
        steps: &[
            &["{python}", "{source}/bindings/swig/build.py", "java", "--prefix", "{dist}", "--work", "{work}"],
            &[
                "java",
                "-Djava.library.path={work}",
                "-cp",
                "/usr/share/java/jython.jar:{work}/shapeopJava.jar",
                "org.python.util.jython",
                "{source}/tests/jython/three_problems.py",
                "{mesh}",
                "{out}",
            ],
        ],
    },
];

/// A language and its largest difference in each problem, of the model's size.
pub struct Row {
    /// The language.
    pub name: &'static str,
    /// One difference per problem, or why there is none.
    pub differences: Result<[f64; 3], LeftOut>,
}

/// Builds and runs every language's program; prints the table.
pub fn run(places: &Places, profile: &str) -> Result<Vec<Row>> {
    let mut places = places.clone();
    let mesh = shell::root().join("examples/meshes/botanic-garden-bubble-0.obj");
    let reference = shell::root().join("target/suites/Rust");
    fs::create_dir_all(&reference)?;
    // With the workspace's selection of packages, so that what the other tests built is used.
    let mut build = shell::cargo();
    shell::run(build.args(["build", "--quiet", "--workspace", "--profile", profile, "--example", "three_problems"]))?;
    let program = shell::built(profile).join("examples/three_problems");
    shell::run(Command::new(program).args([&mesh, &reference]))?;
    places.set("mesh", mesh);

    println!("\nThe largest difference to the Rust result, of the model's size:");
    println!("  {:<16} {:>12} {:>12} {:>12}", "language", PROBLEMS[0], PROBLEMS[1], PROBLEMS[2]);
    let mut rows = Vec::new();
    for language in &LANGUAGES {
        let differences = match language.run(&places)? {
            Err(left_out) => Err(left_out),
            Ok(_) => Ok(differences(&reference, &language.folder().join("out")).context(language.name)?),
        };
        match &differences {
            Ok([a, b, c]) => println!("  {:<16} {a:>12.1e} {b:>12.1e} {c:>12.1e}", language.name),
            Err(LeftOut(why)) => println!("  {:<16} left out: {why}", language.name),
        }
        rows.push(Row { name: language.name, differences });
    }
    Ok(rows)
}

fn differences(reference: &Path, folder: &Path) -> Result<[f64; 3]> {
    let mut all = [0.0; 3];
    for (difference, problem) in all.iter_mut().zip(PROBLEMS) {
        let file = format!("{problem}.txt");
        let (expected, found) = (points(&reference.join(&file))?, points(&folder.join(&file))?);
        if expected.len() != found.len() {
            bail!("{problem}: expected {} points, found {}", expected.len(), found.len());
        }
        let pairs = expected.iter().flatten().zip(found.iter().flatten());
        *difference = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / diagonal(&expected);
    }
    Ok(all)
}

/// The points of a file: a line `x y z` each.
fn points(file: &Path) -> Result<Vec<[f64; 3]>> {
    let text = fs::read_to_string(file).with_context(|| format!("{} could not be read", file.display()))?;
    let point = |(number, line): (usize, &str)| {
        let coordinates: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let point: Option<[f64; 3]> = coordinates.ok().and_then(|found| found.try_into().ok());
        point
            .filter(|point| point.iter().all(|coordinate| coordinate.is_finite()))
            .with_context(|| format!("{} line {}: expected x y z, found {line}", file.display(), number + 1))
    };
    text.lines().enumerate().map(point).collect()
}

/// The diagonal of the box that holds the points.
fn diagonal(points: &[[f64; 3]]) -> f64 {
    let extent = |axis: usize| {
        let coordinates = || points.iter().map(|point| point[axis]);
        coordinates().fold(f64::NEG_INFINITY, f64::max) - coordinates().fold(f64::INFINITY, f64::min)
    };
    (0..3).map(|axis| extent(axis).powi(2)).sum::<f64>().sqrt()
}
