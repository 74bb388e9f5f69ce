//! What an exploration minimises while hard constraints are met: handles at their targets, the other points where they
//! were, a fair displacement. Source: Deng et al. 2015, "Interactive design exploration for constrained meshes",
//! section 2.2.

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, Status, finite};

/// What the fairness term measures the displacement `p − p⁰` with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Fairness {
    /// `d_i` minus the mean over the neighbours of `i`, at every point, those on the boundary included.
    #[default]
    Laplacian,
    /// `d_{i−1} − 2 d_i + d_{i+1}` along polylines.
    SecondDifferences,
    /// `−d_{i−1} + 3 d_i − 3 d_{i+1} + d_{i+2}` along polylines.
    ThirdDifferences,
}

/// The weights of the objective `½ w_h Σ ‖p_i − t_i‖²` over handles `+ ½ w_c Σ ‖p_i − p⁰_i‖²` over the other points `+
/// ½ w_f ‖L (p − p⁰)‖²` plus the soft constraints, and how exactly hard constraints are to be met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Objective {
    /// `w_h`, above 0.
    pub handle_weight: f64,
    /// `w_c`, above 0: it makes the solution unique where nothing else does.
    pub closeness_weight: f64,
    /// `w_f`, at least 0; it needs faces, edges or polylines.
    pub fairness_weight: f64,
    /// `L`.
    pub fairness: Fairness,
    /// The polylines of differences, as lists of point indices. Empty: they are found on the faces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub polylines: Vec<Vec<u32>>,
    /// How far a hard constraint may be from its set, and how far from zero the gradient, relative to the bounding-box
    /// diagonal (of the points, and of the forces that would move each point by it).
    pub tolerance: f64,
}

/// The least tolerance: what is left of a coordinate of the model's size after round-off.
const LEAST_TOLERANCE: f64 = 1e-14;

impl Default for Objective {
    fn default() -> Self {
        Self {
            handle_weight: 100.0,
            closeness_weight: 0.1,
            fairness_weight: 1.0,
            fairness: Fairness::Laplacian,
            polylines: Vec::new(),
            tolerance: 1e-12,
        }
    }
}

impl Objective {
    /// Refuses weights and tolerances outside their domain. Polylines are checked where they are used.
    ///
    /// # Errors
    /// Status `InvalidValue`, with the field as place.
    pub fn check(&self) -> Result<()> {
        let refuse = |name: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(name));
        for (name, weight) in [("handle_weight", self.handle_weight), ("closeness_weight", self.closeness_weight)] {
            if finite(name, weight)? <= 0.0 {
                return refuse(name, format!("expected a number above 0, found {weight}"));
            }
        }
        if finite("fairness_weight", self.fairness_weight)? < 0.0 {
            return refuse("fairness_weight", format!("expected at least 0, found {}", self.fairness_weight));
        }
        if finite("tolerance", self.tolerance)? < LEAST_TOLERANCE {
            let reason =
                format!("expected at least {LEAST_TOLERANCE:e}, which is round-off; found {:e}", self.tolerance);
            return refuse("tolerance", reason);
        }
        Ok(())
    }
}

/// A point that is drawn to a target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Handle {
    /// The point.
    pub point: u32,
    /// Where it is drawn to, in model units.
    pub target: [f64; 3],
}

/// The rows of `L`, each a combination of some points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FairnessRows {
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl FairnessRows {
    /// The row `Σ coefficient · point` behind the others.
    fn push(&mut self, row: impl IntoIterator<Item = (u32, f64)>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.entries.extend(row);
        self.starts.push(self.entries.len());
    }

    /// A row for every point that has neighbours: the point minus their mean. `edges` names each pair of neighbours
    /// once.
    pub fn laplacian(point_count: usize, edges: &[[u32; 2]]) -> Self {
        let mut neighbours = vec![Vec::new(); point_count];
        for &[a, b] in edges {
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
        }
        let mut rows = Self::default();
        for (point, around) in (0..).zip(&mut neighbours).filter(|(_, around)| !around.is_empty()) {
            around.sort_unstable();
            around.dedup();
            let share = -1.0 / around.len() as f64;
            rows.push(std::iter::once((point, 1.0)).chain(around.iter().map(|&other| (other, share))));
        }
        rows
    }

    /// Second or third differences along polylines; a closed one repeats its first point at the end.
    pub fn differences(polylines: &[Vec<u32>], fairness: Fairness) -> Self {
        let coefficients: &[f64] = match fairness {
            Fairness::ThirdDifferences => &[-1.0, 3.0, -3.0, 1.0],
            Fairness::SecondDifferences | Fairness::Laplacian => &[1.0, -2.0, 1.0],
        };
        let mut rows = Self::default();
        for polyline in polylines {
            let mut points = polyline.clone();
            if let [first, middle @ .., last] = polyline.as_slice()
                && first == last
            {
                points.extend(middle.iter().take(coefficients.len() - 2));
            }
            for window in points.windows(coefficients.len()) {
                rows.push(window.iter().copied().zip(coefficients.iter().copied()));
            }
        }
        rows
    }

    /// The rows.
    pub fn iter(&self) -> impl Iterator<Item = &[(u32, f64)]> {
        self.starts.windows(2).map(|ends| &self.entries[ends[0]..ends[1]])
    }

    /// The greatest point that a row refers to.
    pub fn greatest_point(&self) -> Option<u32> {
        self.entries.iter().map(|(point, _)| *point).max()
    }
}
