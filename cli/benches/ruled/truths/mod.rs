//! Analytic truths, recomputed from the public interface.

mod conditions;
mod directions;
mod functions;
mod images;
mod refusals;
mod strips;
mod widths;

use anyhow::Result;
use shapeop::error::Status;
use shapeop::geometry::ruled::optimise::Optimised;

use crate::group::Group;

type Truths = fn() -> Result<Group>;

const TRUTHS: [(&str, Truths); 10] = [
    ("directions", directions::closed_forms),
    ("families", directions::families),
    ("functions", functions::group),
    ("images", images::group),
    ("exact", strips::exact),
    ("free_form", strips::free_form_strips),
    ("joined", strips::joined),
    ("widths", widths::group),
    ("conditions", conditions::group),
    ("refusals", refusals::group),
];

/// Prints a line for each group, or for the one of this name.
pub fn print(name: Option<&str>) -> Result<()> {
    for (_, group) in TRUTHS.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", group()?);
    }
    Ok(())
}

/// A measure that is to be this, but for a part of it.
fn about(group: &mut Group, what: &str, value: f64, expected: f64, part: f64) {
    group.between(what, value, [(1.0 - part) * expected, (1.0 + part) * expected]);
}

/// 1 where a call is refused with this status at this place, else 0.
fn is_refused<T>(call: shapeop::error::Result<T>, status: Status, place: &str) -> f64 {
    f64::from(call.err().is_some_and(|error| error.status() == status && error.place() == place))
}

/// The iterations that do not fall strictly, or by less than what Armijo's rule asks.
fn bad_steps(found: &Optimised) -> usize {
    let is_bad = |pair: &[shapeop::geometry::ruled::optimise::Iteration]| {
        let [before, after] = [&pair[0], &pair[1]];
        !(after.value < before.value && after.value <= before.value - 1e-4 * after.taken * after.promised)
    };
    found.history.windows(2).filter(|pair| is_bad(pair)).count()
}

/// The largest of some numbers, at least 0.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, f64::max)
}
