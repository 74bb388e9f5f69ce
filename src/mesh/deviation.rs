//! How far a shape is from another one.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Distances of samples from another shape, in model units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Deviation {
    /// The number of samples; if 0, all else is 0 too.
    pub count: usize,
    /// The greatest.
    pub max: f64,
    /// The sample that has it.
    pub at: [f64; 3],
    /// The root of the mean square, each sample weighted by the area it stands for.
    pub rms: f64,
}

impl Deviation {
    /// Of samples: a point, its distance, the area that it stands for.
    pub fn of(distances: &[(DVec3, f64, f64)]) -> Self {
        let mut found = Self { count: distances.len(), ..Self::default() };
        let (mut squares, mut areas) = (0.0, 0.0);
        for (i, &(point, distance, area)) in distances.iter().enumerate() {
            if i == 0 || distance > found.max {
                (found.max, found.at) = (distance, point.to_array());
            }
            squares += area * distance * distance;
            areas += area;
        }
        found.rms = if areas > 0.0 { (squares / areas).sqrt() } else { found.max };
        found
    }
}
