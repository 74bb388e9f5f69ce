//! What an exploration found, for reports and in words: violations, constraints that contradict each other, what weights do.

use serde::Serialize;
use shapeop::solver::{Sensitivities, Solver};

use crate::table::{aligned, number, percent};

/// What the last solve found besides the points. Lengths are in model units.
#[derive(Clone, Serialize)]
pub struct Exploration {
    pub sweeps: u32,
    pub newton_steps: u32,
    /// The largest distance of a hard constraint from its set, and which constraint it is.
    pub largest_violation: f64,
    pub worst: Option<usize>,
    pub residuals: Option<Residuals>,
    /// True if the points solve the problem: both residuals within the tolerance and nothing given up.
    pub is_solution: bool,
    /// Constraints whose multiplier is at its cap.
    pub capped: usize,
    pub penalty: f64,
    pub factorisations: u32,
    /// The terms of the objective, each with its weight.
    pub objective: Terms,
    /// A small set of hard constraints without which the others can be met.
    pub conflicts: Vec<Conflict>,
}

#[derive(Clone, Serialize)]
pub struct Residuals {
    pub primal: f64,
    pub dual: f64,
}

#[derive(Clone, Serialize)]
pub struct Terms {
    pub handles: f64,
    pub closeness: f64,
    pub fairness: f64,
    pub soft: f64,
}

#[derive(Clone, Serialize)]
pub struct Conflict {
    pub constraint: usize,
    #[serde(rename = "type")]
    pub type_name: &'static str,
    pub indices: Vec<u32>,
    /// Its weight.
    pub priority: f64,
    pub violation: f64,
    pub unit: &'static str,
}

impl Exploration {
    /// What the solver found; `None` if it did not explore.
    pub fn of(solver: &Solver) -> Option<Self> {
        let found = solver.found()?;
        let violations = solver.violations();
        let conflict = |id: &usize| {
            let view = solver.constraint(*id)?;
            Some(Conflict {
                constraint: *id,
                type_name: view.info.name,
                indices: view.indices.to_vec(),
                priority: view.weight,
                violation: violations.get(*id).copied().unwrap_or(0.0),
                unit: view.info.violation_unit,
            })
        };
        Some(Self {
            sweeps: found.sweeps,
            newton_steps: found.newton_steps,
            largest_violation: found.largest_violation,
            worst: found.worst,
            residuals: found.residuals.map(|residuals| Residuals { primal: residuals.primal, dual: residuals.dual }),
            is_solution: found.is_solution,
            capped: found.capped,
            penalty: found.penalty,
            factorisations: found.factorisations,
            objective: Terms {
                handles: found.terms.handles,
                closeness: found.terms.closeness,
                fairness: found.terms.fairness,
                soft: found.terms.soft,
            },
            conflicts: found.conflicts.iter().filter_map(conflict).collect(),
        })
    }

    /// "1.2e-10 at constraint 12", "no hard constraints".
    pub fn violation_in_words(&self) -> String {
        match self.worst {
            Some(worst) => format!("{} at constraint {worst}", number(self.largest_violation)),
            None => "no hard constraints".to_owned(),
        }
    }
}

/// Conflicts named before the rest is counted.
const NAMED_CONFLICTS: usize = 10;

/// The corners of a constraint that are listed.
const LISTED_POINTS: usize = 6;

/// What to say of hard constraints that contradict each other.
pub fn explained(conflicts: &[Conflict]) -> String {
    if conflicts.is_empty() {
        return "  The hard constraints could not all be met from here; no small set of them could be told apart.\n  \
                Start from a shape nearer to what they ask for, or make some of them soft (\"hard\": false)."
            .to_owned();
    }
    let mut rows = vec![["constraint", "type", "points", "off by", "priority"].map(str::to_owned).to_vec()];
    for conflict in conflicts.iter().take(NAMED_CONFLICTS) {
        let mut points: Vec<String> = conflict.indices.iter().take(LISTED_POINTS).map(u32::to_string).collect();
        if conflict.indices.len() > LISTED_POINTS {
            points.push("…".to_owned());
        }
        rows.push(vec![
            conflict.constraint.to_string(),
            conflict.type_name.to_owned(),
            points.join(" "),
            format!("{} {}", number(conflict.violation), conflict.unit),
            number(conflict.priority),
        ]);
    }
    let more = conflicts.len().saturating_sub(NAMED_CONFLICTS);
    let more = if more > 0 { format!("\n  and {more} more: the report lists them") } else { String::new() };
    let (count, whom, what) = match conflicts.len() {
        1 => ("One of them stands".to_owned(), "it", "what it asks for"),
        count => (format!("{count} of them stand"), "them", "what they ask for"),
    };
    format!(
        "  The hard constraints cannot all be met. {count} against the others:\n\n{}{more}\n\n  The shape that was written \
         meets all the others. To go on, make {whom} soft (\"hard\": false), or change {what}.\n  If others should give way \
         instead, give them a lower weight: for hard constraints it is their priority.\n  The set is a small one, not always \
         the only one.",
        aligned(&rows)
    )
}

/// What a change of each weight does, estimated at a solution.
#[derive(Clone, Serialize)]
pub struct WhatWeightsDo {
    /// The weight classes: handles, closeness, fairness, and types of soft constraints.
    pub classes: Vec<&'static str>,
    /// By class, the squares of its term, `Σ w ‖·‖²`: twice the term of the objective.
    pub squares: Vec<f64>,
    /// By class: what happens if its weight is doubled.
    pub doubled: Vec<Doubled>,
}

#[derive(Clone, Serialize)]
pub struct Doubled {
    pub class: &'static str,
    /// How far points move, about, in model units.
    pub largest_move: f64,
    pub largest_move_at: usize,
    pub mean_move: f64,
    /// By class, the change of its squares as a ratio, the weight in front held: −0.5 is half of them. Null where there are none.
    pub changes: Vec<Option<f64>>,
}

impl WhatWeightsDo {
    /// From derivatives by the logarithms of weights. Moves are extrapolated along a straight line in the logarithm, squares along
    /// a power law, `E (2)/E (1) = 2^s` with `s = d ln E/d ln w`: they cannot fall below nothing, as they would along a line.
    pub fn of(found: &Sensitivities) -> Self {
        let doubled = found.classes.iter().enumerate().map(|(i, class)| {
            let moves = || found.points[i].iter().map(|point| std::f64::consts::LN_2 * point.length());
            let largest = moves().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
            let changes = found.squares[i].iter().zip(&found.values);
            Doubled {
                class: class.name(),
                largest_move: largest.1,
                largest_move_at: largest.0,
                mean_move: moves().sum::<f64>() / found.points[i].len().max(1) as f64,
                changes: changes.map(|(slope, value)| change(*slope, *value)).collect(),
            }
        });
        Self {
            classes: found.classes.iter().map(|class| class.name()).collect(),
            squares: found.values.clone(),
            doubled: doubled.collect(),
        }
    }

    /// A table of what doubling each weight does; `mean_edge` is what moves are compared with.
    pub fn in_lines(&self, mean_edge: Option<f64>) -> String {
        let mut head = vec!["twice the weight of".to_owned(), "moves points, most".to_owned(), "mean".to_owned()];
        head.extend(self.classes.iter().map(|name| (*name).to_owned()));
        let length = |length: f64| match mean_edge.filter(|edge| *edge > 0.0) {
            Some(edge) => percent(length / edge),
            None => number(length),
        };
        let mut rows = vec![head];
        for doubled in &self.doubled {
            let mut row = vec![doubled.class.to_owned(), length(doubled.largest_move), length(doubled.mean_move)];
            row.extend(doubled.changes.iter().map(|change| change.map_or("–".to_owned(), signed_percent)));
            rows.push(row);
        }
        let unit = if mean_edge.is_some() { "in percent of the mean edge" } else { "in model units" };
        format!(
            "  What a weight will do, estimated at this shape (moves {unit}; at the right, how much is left undone\n  of each \
             wish: − is nearer to it, + farther from it)\n\n{}",
            aligned(&rows)
        )
    }
}

/// The relative change of `value` along a power law whose slope in the logarithm of the weight is `slope`.
fn change(slope: f64, value: f64) -> Option<f64> {
    let exponent = slope / value;
    (value > 0.0 && exponent.is_finite()).then(|| (std::f64::consts::LN_2 * exponent).exp_m1())
}

fn signed_percent(ratio: f64) -> String {
    let value = 100.0 * ratio;
    if value.abs() < 0.05 {
        return "0 %".to_owned();
    }
    let sign = if value < 0.0 { "−" } else { "+" };
    let value = value.abs();
    if value < 10.0 { format!("{sign}{value:.1} %") } else { format!("{sign}{value:.0} %") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring of stiffness `w` against one of stiffness 1 that pulls from 1: x = 1/(1 + w), and for stiff ones E = w x² falls as w⁻¹,
    /// x² as w⁻², which twice the weight makes a quarter.
    #[test]
    fn squares_follow_a_power_law() {
        assert!((change(-2.0 * 0.3, 0.3).unwrap() + 0.75).abs() < 1e-15);
        assert!((change(0.5, 0.5).unwrap() - 1.0).abs() < 1e-15);
        assert_eq!((change(0.0, 2.0), change(0.0, 0.0), change(1.0, 0.0)), (Some(0.0), None, None));
        assert_eq!(["−75 %", "+3.2 %", "0 %"].map(str::to_owned), [-0.75, 0.032, 1e-5].map(signed_percent));
    }

    #[test]
    fn conflicts_are_named_calmly() {
        let one = Conflict {
            constraint: 40,
            type_name: "EdgeLength",
            indices: vec![3, 4],
            priority: 1.0,
            violation: 0.5,
            unit: "model units",
        };
        let text = explained(std::slice::from_ref(&one));
        for part in
            ["One of them stands against the others", "40", "EdgeLength", "3 4", "0.5000 model units", "make it soft"]
        {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        let text = explained(&vec![one; 13]);
        assert!(text.contains("13 of them stand") && text.contains("and 3 more") && text.contains("what they ask for"));
        assert!(explained(&[]).contains("no small set"));
    }
}
