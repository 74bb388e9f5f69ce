//! `cargo xtask test`.

use std::fs;
use std::num::NonZero;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use anyhow::{Result, bail};

use crate::languages::{self, TOLERANCE};
use crate::suites::{LeftOut, Places, Suite};
use crate::{bindings, licences, setup, shell};

/// The profile that `cargo test` builds with, so that the bindings' tests take the library as it is then.
const PROFILE: &str = "dev";

/// Sets up what the tests need, runs all of them, and says what was left out. With `CI=true` nothing may be.
pub fn run() -> Result<()> {
    setup::install_tools()?;

    // Tests write what they leave out into this file, one line each.
    let left_out = shell::root().join("target/left-out.txt");
    fs::create_dir_all(shell::root().join("target"))?;
    fs::write(&left_out, "")?;
    let cargo_test = |arguments: &[&str]| {
        let line = format!("cargo test {}", arguments.join(" "));
        timed(&line, || shell::run(shell::cargo().arg("test").args(arguments).env("SHAPEOP_LEFT_OUT", &left_out)))
    };
    // With all features, so that one build serves all tests. The bindings' tests below are those of a library without.
    cargo_test(&["--workspace", "--features", "shapeop/schema,shapeop/gpu"])?;

    timed("licences of the crates inside the library", || licences::run(true))?;
    let places = timed("set-up of the bindings' tests", || bindings::set_up(PROFILE))?;
    let mut lines: Vec<String> = fs::read_to_string(&left_out)?.lines().map(str::to_owned).collect();
    lines.extend(timed("the tests of all bindings", || run_suites(&places, &left_out))?);
    lines.extend(run_languages(&places)?);
    lines.sort();
    lines.dedup();
    if setup::is_ci() && !lines.is_empty() {
        bail!("CI leaves nothing out, but: {}", lines.join("; "));
    }
    if lines.is_empty() {
        println!("All tests passed; nothing was left out.");
    } else {
        println!("All tests passed, but {} THINGS WERE LEFT OUT:", lines.len());
        lines.iter().for_each(|line| println!("  LEFT OUT: {line}"));
    }
    Ok(())
}

/// The tests of every binding, as many at once as there are processors: most keep one busy. Returns what was left out.
fn run_suites(places: &Places, left_out: &Path) -> Result<Vec<String>> {
    let mut places = places.clone();
    places.set("leftout", left_out);
    let next = AtomicUsize::new(0);
    let run_some = || -> Result<Vec<String>> {
        let mut lines = Vec::new();
        while let Some(suite) = bindings::SUITES.get(next.fetch_add(1, Ordering::Relaxed)) {
            lines.extend(run_suite(suite, &places)?);
        }
        Ok(lines)
    };
    thread::scope(|scope| {
        let count = thread::available_parallelism().map_or(1, NonZero::get);
        let workers: Vec<_> = (0..count).map(|_| scope.spawn(run_some)).collect();
        workers.into_iter().map(shell::joined).collect::<Result<Vec<_>>>().map(|lines| lines.concat())
    })
}

fn run_suite(suite: &Suite, places: &Places) -> Result<Vec<String>> {
    let started = Instant::now();
    let outcome = suite.run(places)?;
    let seconds = started.elapsed().as_secs_f64();
    match outcome {
        Err(LeftOut(why)) => Ok(vec![format!("{}: {why}", suite.name)]),
        Ok(printed) => {
            let last = printed.lines().rev().find(|line| line.contains(" passed") || line.starts_with("Ran "));
            let last = last.or(printed.lines().last()).unwrap_or("done");
            println!("-- {}: {seconds:.0} s\n  {last}", suite.name);
            // What pytest says behind the tests. Those of unittest leave out only what their Python cannot do.
            let skipped = printed.lines().filter_map(|line| line.strip_prefix("SKIPPED "));
            Ok(skipped.map(|what| format!("{}: {what}", suite.name)).collect())
        }
    }
}

/// The three problems in every language; returns what was left out.
fn run_languages(places: &Places) -> Result<Vec<String>> {
    let rows = timed("the three problems in every language", || languages::run(places, PROFILE))?;
    let mut lines = Vec::new();
    for row in rows {
        match row.differences {
            Err(LeftOut(why)) => lines.push(format!("three problems in {}: {why}", row.name)),
            Ok(differences) if differences.iter().any(|difference| *difference > TOLERANCE) => {
                bail!("{} differs by {differences:?} of the model's size: at most {TOLERANCE} passes", row.name)
            }
            Ok(_) => {}
        }
    }
    Ok(lines)
}

fn timed<T>(name: &str, run: impl FnOnce() -> Result<T>) -> Result<T> {
    println!("-- {name}");
    let started = Instant::now();
    let result = run()?;
    println!("-- {name}: {:.0} s", started.elapsed().as_secs_f64());
    Ok(result)
}
