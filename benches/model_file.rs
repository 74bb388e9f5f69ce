//! A model as a file for programs in other languages: one line of JSON that says what follows, then the arrays as
//! little-endian bytes, so that every number arrives to the last bit.

use std::fs::File;
use std::io::{BufWriter, Result, Write};

use serde_json::json;

use crate::models::Model;

/// Writes `model`: the header, the points, then indices (32 bits) and scalars of each group.
pub fn write(model: &Model, file: &str) -> Result<()> {
    let mut out = BufWriter::new(File::create(file)?);
    let groups = model.groups.iter().map(|group| {
        json!({
            "type": group.type_name,
            "arity": group.counts.first(),
            "indices": group.indices.len(),
            "weight": group.weight,
            "scalars": group.scalars.len(),
        })
    });
    let header = json!({
        "points": model.points.len(),
        "gravity": model.gravity.to_array(),
        "dynamics": model.dynamics,
        "groups": groups.collect::<Vec<_>>(),
    });
    writeln!(out, "{header}")?;
    for point in &model.points {
        doubles(&mut out, &point.to_array())?;
    }
    for group in &model.groups {
        for index in &group.indices {
            out.write_all(&index.to_le_bytes())?;
        }
        doubles(&mut out, &group.scalars)?;
    }
    out.flush()
}

/// Writes points as doubles: `x0 y0 z0 x1 …`.
pub fn write_points(points: &[glam::DVec3], file: &str) -> Result<()> {
    let mut out = BufWriter::new(File::create(file)?);
    for point in points {
        doubles(&mut out, &point.to_array())?;
    }
    out.flush()
}

fn doubles(out: &mut impl Write, values: &[f64]) -> Result<()> {
    values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
}
