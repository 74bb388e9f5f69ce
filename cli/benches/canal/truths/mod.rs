//! Analytic truths and independent checks of every part, recomputed from the public interface.

mod inverse;
mod strips;
mod transformations;

use anyhow::{Result, bail};
use shapeop::error::{Error, Status};
use shapeop::geometry::canal::quality::{Quality, largest};
use shapeop::geometry::circle::Circle;
use shapeop::mesh::Grid;

use crate::group::Group;

pub fn groups() -> Result<Vec<Group>> {
    Ok(vec![transformations::group()?, strips::group()?, inverse::group()?])
}

/// The largest distance of a quad's fourth corner from the circle through three, over the mean edge; shares no code
/// with
/// [`Quality`].
fn off_circle(grid: &Grid) -> f64 {
    let off = |quad: [usize; 4]| {
        let corners = quad.map(|corner| grid.points()[corner]);
        let mean = (0..4).map(|k| corners[k].distance(corners[(k + 1) % 4])).sum::<f64>() / 4.0;
        Circle::through(corners[0], corners[1], corners[2]).map_or(f64::INFINITY, |c| c.distance(corners[3]) / mean)
    };
    grid.quads().map(off).fold(0.0, f64::max)
}

/// The worst planarity and concyclicity.
pub fn worst(grid: &Grid) -> f64 {
    let quality = Quality::of(grid);
    largest(&quality.planarity).max(largest(&quality.concyclicity))
}

/// The error of a call that must be refused.
fn refused<T>(call: shapeop::error::Result<T>) -> Result<Error> {
    match call {
        Ok(_) => bail!("expected a refusal"),
        Err(error) => Ok(error),
    }
}

/// 1 where a call is refused with this status, else 0.
fn is_refused<T>(call: shapeop::error::Result<T>, status: Status) -> f64 {
    f64::from(call.err().is_some_and(|error| error.status() == status))
}
