//! Analytic truths, recomputed from the public interface.

mod curves;
mod linkages;
mod model;
mod motions;
mod orders;
mod projections;
mod rails;
mod refusals;
mod velocities;

use anyhow::Result;
use shapeop::error::Status;

use crate::group::Group;

type Truths = fn() -> Result<Group>;

const TRUTHS: [(&str, Truths); 16] = [
    ("model", model::arcs),
    ("freedoms", model::freedoms),
    ("projection", projections::group),
    ("derivatives", velocities::derivatives),
    ("rigid", velocities::rigid),
    ("orthogonal", velocities::orthogonal),
    ("evolutions", motions::shapes_stay),
    ("surfaces", motions::surfaces),
    ("rings", motions::rings),
    ("orders", orders::group),
    ("curves", curves::closed_forms),
    ("meshes", curves::on_meshes),
    ("fits", curves::fits),
    ("rails", rails::group),
    ("linkage", linkages::group),
    ("refusals", refusals::group),
];

/// Prints a line for each group, or for the one of this name.
pub fn print(name: Option<&str>) -> Result<()> {
    for (_, group) in TRUTHS.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", group()?);
    }
    Ok(())
}

/// A measure that is to be exactly this.
fn exactly(group: &mut Group, what: &str, value: usize, expected: usize) {
    group.between(what, value as f64, [expected as f64; 2]);
}

/// A measure that is to be true.
fn holds(group: &mut Group, what: &str, is_true: bool) {
    group.at_least(what, f64::from(is_true), 1.0);
}

/// 1 where a call is refused with this status at this place, else 0.
fn is_refused<T>(call: shapeop::error::Result<T>, status: Status, place: &str) -> bool {
    call.err().is_some_and(|error| error.status() == status && error.place() == place)
}
