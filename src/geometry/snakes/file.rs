//! The JSON form of a snake (`docs/snake.schema.json`).

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{ArcShape, Pose, Snake};
use crate::error::{Error, Result, Status};
use crate::problem::json;

/// The version of the form.
const VERSION: u32 = 1;

/// A snake. It is given by its control points, or by its arcs, how they turn against each other and where the first begins.
/// Lengths are in model units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SnakeForm {
    /// 1.
    pub version: u32,
    /// Whether the last arc goes on with the first.
    #[serde(default)]
    pub closed: bool,
    /// The control points, at least 3: of a closed snake one for each arc, of an open one its two ends besides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub control: Option<Vec<[f64; 3]>>,
    /// The arcs, in order. They follow from control points, up to round-off, except around a closed snake with an even number of
    /// them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arcs: Option<Vec<ArcShape>>,
    /// Without arcs, around a closed snake with an even number of control points: the distance from control point 0 to both ends of
    /// its arc.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_tangent: Option<f64>,
    /// Without control points: by how much the plane turns from each arc to the next about their common tangent, in radians, one
    /// fewer than arcs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torsions_rad: Option<Vec<f64>>,
    /// Without control points: where the snake begins, by default at 0 along x, bending towards y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<PoseForm>,
}

/// Where a snake begins, and how.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PoseForm {
    /// The first point of the first arc.
    pub point: [f64; 3],
    /// The tangent there, of any length.
    pub tangent: [f64; 3],
    /// The direction in which the first arc bends; what is along the tangent does not count.
    pub normal: [f64; 3],
}

impl From<&Snake> for SnakeForm {
    fn from(snake: &Snake) -> Self {
        Self {
            version: VERSION,
            closed: snake.is_closed(),
            control: Some(snake.control().iter().map(DVec3::to_array).collect()),
            arcs: Some(snake.shapes().to_vec()),
            first_tangent: None,
            torsions_rad: None,
            pose: None,
        }
    }
}

impl From<PoseForm> for Pose {
    fn from(form: PoseForm) -> Self {
        let [point, tangent, normal] = [form.point, form.tangent, form.normal].map(DVec3::from_array);
        Self { point, tangent, normal }
    }
}

impl TryFrom<SnakeForm> for Snake {
    type Error = Error;

    fn try_from(form: SnakeForm) -> Result<Self> {
        let refuse = |place: &str, reason: &str| Err(Error::new(Status::InvalidValue, reason).at(place));
        if form.version != VERSION {
            return refuse("version", &format!("expected {VERSION}, found {}", form.version));
        }
        if form.first_tangent.is_some() && form.arcs.is_some() {
            return refuse("first_tangent", "expected none beside arcs, which say it");
        }
        let Some(control) = form.control else {
            let Some(arcs) = form.arcs else {
                return refuse("control", "expected control points, or arcs, found neither");
            };
            if form.closed {
                return refuse("control", "expected the control points of a closed snake, found none");
            }
            let origin = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
            let torsions = form.torsions_rad.unwrap_or_default();
            return Self::from_arcs(&arcs, &torsions, &form.pose.map_or(origin, Pose::from)).map_err(|error| {
                let place = error.place().replace("torsions", "torsions_rad");
                error.with_place(place)
            });
        };
        for (place, is_given) in [("torsions_rad", form.torsions_rad.is_some()), ("pose", form.pose.is_some())] {
            if is_given {
                return refuse(place, "expected none beside control points, which say it");
            }
        }
        let control = control.into_iter().map(DVec3::from_array).collect();
        match form.arcs {
            Some(arcs) => Self::with_arcs(control, arcs, form.closed),
            None => Self::new(control, form.closed, form.first_tangent),
        }
    }
}

/// The snake that a JSON text states.
///
/// # Errors
/// Status `InvalidInput`: the text is no such form; the place is that in the text. Otherwise the place is that of the form: another
/// `version`, neither control points nor arcs (`control`), what contradicts them (`first_tangent`, `torsions_rad`, `pose`), or what
/// [`Snake::new`], [`Snake::with_arcs`] or [`Snake::from_arcs`] refuse.
pub fn from_json(text: &str) -> Result<Snake> {
    Snake::try_from(json::from_text::<SnakeForm>(text)?)
}

/// The JSON form of a snake: a line for each control point and arc, ending in a newline. Read again it is the same, bit by bit.
pub fn to_json(snake: &Snake) -> String {
    json::to_text(&SnakeForm::from(snake))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::snakes::snake::tests::random_snake;

    fn hexagon() -> Vec<[f64; 3]> {
        (0..6).map(|i| f64::from(i).to_radians() * 60.0).map(|t| [t.cos(), t.sin(), 0.0]).collect()
    }

    #[test]
    fn snakes_are_read_as_they_were_written() {
        let control = hexagon().into_iter().map(DVec3::from_array).collect();
        let closed = Snake::new(control, true, Some(0.4)).unwrap();
        for snake in [random_snake(1, 3).3, random_snake(12, 5).3, closed] {
            let text = to_json(&snake);
            assert_eq!(from_json(&text).unwrap(), snake);
            assert_eq!(text.lines().count(), snake.control().len() + snake.shapes().len() + 8);
        }
    }

    #[test]
    fn arcs_or_control_points_suffice() {
        let (arcs, torsions, pose, snake) = random_snake(4, 9);
        let form = SnakeForm {
            control: None,
            arcs: Some(arcs.clone()),
            torsions_rad: Some(torsions),
            pose: Some(PoseForm {
                point: pose.point.to_array(),
                tangent: pose.tangent.to_array(),
                normal: pose.normal.to_array(),
            }),
            ..SnakeForm::from(&snake)
        };
        assert_eq!(from_json(&json::to_text(&form)).unwrap(), snake);
        let form = SnakeForm { arcs: None, ..SnakeForm::from(&snake) };
        let found = from_json(&json::to_text(&form)).unwrap();
        assert!(found.shapes().iter().zip(&arcs).all(|(a, b)| (a.radius - b.radius).abs() < 1e-11));
        let one = from_json(r#"{"version": 1, "arcs": [{"radius": 2, "length": 3}]}"#).unwrap();
        assert!(one.control()[0] == DVec3::ZERO && one.control()[1].y == 0.0 && one.control()[2].y > 0.0);
    }

    #[test]
    fn a_form_that_errs_is_refused_with_its_place() {
        let snake = random_snake(3, 2).3;
        let form = SnakeForm::from(&snake);
        let refused = |form: SnakeForm| from_json(&json::to_text(&form)).unwrap_err().place().to_owned();
        assert_eq!(refused(SnakeForm { version: 2, ..form.clone() }), "version");
        assert_eq!(refused(SnakeForm { first_tangent: Some(1.0), ..form.clone() }), "first_tangent");
        assert_eq!(refused(SnakeForm { torsions_rad: Some(vec![]), ..form.clone() }), "torsions_rad");
        assert_eq!(refused(SnakeForm { control: None, arcs: None, ..form.clone() }), "control");
        assert_eq!(refused(SnakeForm { control: None, closed: true, ..form.clone() }), "control");
        assert_eq!(refused(SnakeForm { control: None, ..form.clone() }), "torsions_rad");
        assert_eq!(refused(SnakeForm { closed: true, ..form.clone() }), "control");
        let arcs = |change: fn(&mut Vec<ArcShape>)| {
            let mut arcs = snake.shapes().to_vec();
            change(&mut arcs);
            refused(SnakeForm { arcs: Some(arcs), ..form.clone() })
        };
        assert_eq!(arcs(|arcs| arcs[1].length *= 1.0 + 1e-6), "control");
        assert_eq!(arcs(|arcs| arcs[1].length = 4.0 * arcs[1].radius), "arcs[1]");
        assert_eq!(arcs(|arcs| arcs.clear()), "arcs");
        let hexagon = SnakeForm { closed: true, control: Some(hexagon()), arcs: None, ..form.clone() };
        assert_eq!(refused(hexagon.clone()), "first_tangent");
        let text = json::to_text(&SnakeForm { first_tangent: Some(0.5), ..hexagon });
        assert_eq!(from_json(&text).unwrap().shapes().len(), 6);
        let error = from_json(&to_json(&snake).replacen("\"radius\"", "\"radios\"", 1)).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::InvalidInput, "arcs[0].radios"));
    }
}
