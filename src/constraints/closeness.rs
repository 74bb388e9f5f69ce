//! Closeness: a point at a given position.
//!
//! Set: `{t}`. Row: `x`. Projection: the target `t`, whatever `x` is; nearest. Scalars: `x y z` of `t` in model units,
//! by default the position at creation. Violation: the distance `‖x − t‖` in model units. Nothing can degenerate.
//! It is the one type that holds a model against translation. Source: Deuss et al. 2015, section 4.

use glam::DVec3;

use super::{Constraint, Kernel, Projection, Rows, Scalar, Scalars, Stencil, TypeInfo};

/// One Closeness constraint. Its target is its scalars, so it has no rest state.
#[derive(Clone, Debug)]
pub struct Closeness;

impl Constraint for Closeness {
    const INFO: TypeInfo = TypeInfo {
        name: "Closeness",
        help: "keeps a point at a position, by default where it was at creation",
        least_indices: 1,
        greatest_indices: Some(1),
        index_names: &["point"],
        scalars: Scalars::Named(&[
            Scalar { name: "x", default: None },
            Scalar { name: "y", default: None },
            Scalar { name: "z", default: None },
        ]),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Constant;

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend_from_slice(&x.at(0).to_array());
        Self
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients[0] = 1.0;
    }

    fn project(&self, scalars: &[f64], _x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = DVec3::from_slice(scalars);
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.at(0).distance(DVec3::from_slice(scalars))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_target_is_the_place_at_creation_until_it_is_edited() {
        let points = [DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO];
        let mut scalars = Vec::new();
        let closeness = Closeness::at_rest(Stencil::absolute(&points, &[0]), &mut scalars);
        let mut targets = [DVec3::ZERO];
        closeness.project(&scalars, Stencil::absolute(&points, &[1]), &mut targets);
        assert_eq!(targets[0], points[0]);
        assert_eq!(closeness.violation(&[0.0, 3.0, 4.0], Stencil::absolute(&points, &[1])), 5.0);
    }
}
