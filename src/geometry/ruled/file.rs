//! The JSON form of strips (`docs/ruled.schema.json`): B-spline surfaces with all that another program needs to make them.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::strip::Strip;
use crate::error::{Error, Result, Status};
use crate::mesh::curve::CubicBasis;
use crate::problem::json;

/// The version of the form.
const VERSION: u32 = 1;

/// Cubic along the boundaries, linear across.
const DEGREES: [u32; 2] = [3, 1];

/// Strips, in order: where each meets the next, it does so with its second boundary. Lengths are in model units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StripsForm {
    /// 1.
    pub version: u32,
    /// The strips.
    pub strips: Vec<StripForm>,
}

/// A strip: a B-spline surface that is not rational.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StripForm {
    /// The degrees along the boundaries and along the rulings: 3 and 1.
    pub degrees: [u32; 2],
    /// Whether the boundaries are closed: control point `count + i` then is control point `i` again, for `i` from 0 to 2.
    #[serde(default)]
    pub closed: bool,
    /// The knots along the boundaries, all of distance 1, those at both ends of an open strip four times; 4 more than control
    /// points, of a closed strip 7 more. The parameter `u` is from the fourth to the fourth from the end.
    pub knots_u: Vec<f64>,
    /// The knots along the rulings: 0, 0, 1, 1.
    pub knots_v: Vec<f64>,
    /// The control points of the first boundary and of the second, as many of each, at least 4.
    pub control: [Vec<[f64; 3]>; 2],
}

impl From<&Strip> for StripForm {
    fn from(strip: &Strip) -> Self {
        Self {
            degrees: DEGREES,
            closed: strip.basis().is_closed(),
            knots_u: strip.basis().knots().to_vec(),
            knots_v: KNOTS_V.to_vec(),
            control: [0, 1].map(|side| strip.control(side).iter().map(DVec3::to_array).collect()),
        }
    }
}

/// The knots across a strip.
pub(super) const KNOTS_V: [f64; 4] = [0.0, 0.0, 1.0, 1.0];

impl TryFrom<&StripForm> for Strip {
    type Error = Error;

    fn try_from(form: &StripForm) -> Result<Self> {
        let refuse = |place: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(place));
        if form.degrees != DEGREES {
            return refuse("degrees", format!("expected {DEGREES:?}, found {:?}", form.degrees));
        }
        let count = form.control[0].len();
        let basis = CubicBasis::new(count, form.closed).map_err(|error| error.with_place("control[0]"))?;
        for (place, expected, found) in
            [("knots_u", basis.knots(), &form.knots_u), ("knots_v", &KNOTS_V, &form.knots_v)]
        {
            if expected != found {
                let at = expected.iter().zip(found).position(|(a, b)| a != b);
                let reason = match at {
                    _ if expected.len() != found.len() => {
                        format!("expected {} knots for {count} control points, found {}", expected.len(), found.len())
                    }
                    Some(i) => format!("expected {} as knot {i}, found {}", expected[i], found[i]),
                    None => continue,
                };
                return refuse(place, reason);
            }
        }
        let side = |side: usize| form.control[side].iter().map(|&point| DVec3::from_array(point)).collect();
        Self::new(basis, [side(0), side(1)])
    }
}

/// The strips that a JSON text states.
///
/// # Errors
/// Status `InvalidInput`: the text is no such form; the place is that in the text. Otherwise `version` or a place in
/// `strips[i]`: degrees or knots other than those of a [`Strip`], or control points that [`Strip::new`] refuses.
pub fn from_json(text: &str) -> Result<Vec<Strip>> {
    let form: StripsForm = json::from_text(text)?;
    if form.version != VERSION {
        let reason = format!("expected {VERSION}, found {}", form.version);
        return Err(Error::new(Status::InvalidValue, reason).at("version"));
    }
    let strip =
        |(i, form): (usize, &StripForm)| Strip::try_from(form).map_err(|error| error.at(format!("strips[{i}]")));
    form.strips.iter().enumerate().map(strip).collect()
}

/// The JSON form of strips: a line per strip, ending in a newline. Read again they are the same, bit by bit.
pub fn to_json(strips: &[Strip]) -> String {
    json::to_text(&StripsForm { version: VERSION, strips: strips.iter().map(StripForm::from).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strips() -> Vec<Strip> {
        let one = |count: usize, is_closed: bool| {
            let point = |i: usize, side: f64| DVec3::new((i as f64).sin() / 3.0, (i as f64).sqrt(), side * 0.1);
            let side = |side: f64| (0..count).map(|i| point(i, side)).collect();
            Strip::new(CubicBasis::new(count, is_closed).unwrap(), [side(0.0), side(1.0)]).unwrap()
        };
        vec![one(4, false), one(9, false), one(6, true)]
    }

    #[test]
    fn strips_are_read_as_they_were_written() {
        let text = to_json(&strips());
        assert_eq!(from_json(&text).unwrap(), strips());
        assert_eq!(text.lines().count(), 8);
        assert_eq!(from_json(&to_json(&[])).unwrap(), []);
    }

    #[test]
    fn a_form_that_errs_is_refused_with_its_place() {
        let text = to_json(&strips()[..1]);
        let refusal = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}: {text}");
            let error = from_json(&text.replacen(from, to, 1)).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let at = |place: &str| (Status::InvalidValue, place.to_owned());
        assert_eq!(refusal("\"version\": 1", "\"version\": 2"), at("version"));
        assert_eq!(refusal("[3, 1]", "[3, 2]"), at("strips[0].degrees"));
        assert_eq!(refusal("[0.0, 0.0, 1.0, 1.0]", "[0.0, 0.0, 2.0, 2.0]"), at("strips[0].knots_v"));
        assert_eq!(refusal("[0.0, 0.0, 0.0, 0.0,", "[0.0, 0.0, 0.0,"), at("strips[0].knots_u"));
        let (status, place) = refusal("\"closed\": false", "\"closed\": 7");
        assert_eq!((status, place.as_str()), (Status::InvalidInput, "strips[0].closed"));
        assert_eq!(refusal("\"closed\": false", "\"closed\": true"), at("strips[0].knots_u"));
        assert_eq!(refusal("0.1]]]", "0.1], [1.0, 2.0, 3.0]]]").1, "strips[0].control[1]");
        let short =
            r#"{"version": 1, "strips": [{"degrees": [3, 1], "knots_u": [], "knots_v": [], "control": [[], []]}]}"#;
        assert_eq!(from_json(short).unwrap_err().place(), "strips[0].control[0]");
    }
}
