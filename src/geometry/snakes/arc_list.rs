//! The arcs of a snake's positions for other programs: as JSON (`docs/snake-arcs.schema.json`), as tables, and as a drawing; and the
//! parts list, which says how many arcs of which kind they take.

use std::fmt::Write;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::sweep::{ArcKind, arc_kinds, of_frame};
use super::{Arc, ArcShape, Snake};
use crate::error::{Error, Result, Status, finite};
use crate::problem::json;

/// The version of the form.
const VERSION: u32 = 1;

/// What is read agrees with what follows from it to this part of it.
const AGREES: f64 = 1e-9;

/// The arcs of a snake at some times. Lengths are in model units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArcListForm {
    /// 1.
    pub version: u32,
    /// Whether the last arc goes on with the first.
    #[serde(default)]
    pub closed: bool,
    /// The kinds of arcs, in the order in which each comes first along the snake.
    pub kinds: Vec<KindForm>,
    /// The positions, at least one.
    pub frames: Vec<FrameForm>,
}

/// Arcs that count as one.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct KindForm {
    /// Their radius: the mean.
    pub radius: f64,
    /// Their length: the mean.
    pub length: f64,
    /// How many there are in all positions together.
    pub count: usize,
}

impl KindForm {
    pub(super) fn of(kind: &ArcKind, positions: usize) -> Self {
        Self { radius: kind.shape.radius, length: kind.shape.length, count: kind.count * positions }
    }
}

/// A position.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FrameForm {
    /// When.
    pub time: f64,
    /// The control points.
    pub control: Vec<[f64; 3]>,
    /// The arcs, in order.
    pub arcs: Vec<ArcForm>,
}

/// An arc in space.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArcForm {
    /// Which of the kinds it is, counted from 0.
    pub kind: usize,
    /// The centre of its circle.
    pub center: [f64; 3],
    /// The radius.
    pub radius: f64,
    /// The unit vector about which it turns counterclockwise.
    pub axis: [f64; 3],
    /// Where it begins.
    pub start: [f64; 3],
    /// The angle that it turns by, in radians, above 0 and below π.
    pub angle_rad: f64,
}

/// The positions of a snake at some times, and the kinds of its arcs.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcList {
    snakes: Vec<Snake>,
    times: Vec<f64>,
    kinds: Vec<ArcKind>,
    kind_of: Vec<usize>,
}

impl ArcList {
    /// The positions of a snake: the control points at each time. Arcs are of one kind if radii and lengths are within `tolerance`
    /// of those of its first, relative to them ([`arc_kinds`]).
    ///
    /// # Errors
    /// No position (`frames`), one with another number of control points or with coordinates that are not finite (`frames[i]`); not
    /// one time for each, or one that is not finite (`times`, `times[i]`); a tolerance that is negative or not finite (`tolerance`).
    pub fn new(snake: &Snake, frames: &[Vec<DVec3>], times: &[f64], tolerance: f64) -> Result<Self> {
        if times.len() != frames.len() {
            let reason = format!("expected {}, one for each position, found {}", frames.len(), times.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("times"));
        }
        for (i, time) in times.iter().enumerate() {
            finite(&format!("times[{i}]"), *time)?;
        }
        if frames.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("frames"));
        }
        let moved = |(i, frame): (usize, &Vec<DVec3>)| snake.moved(frame.clone()).map_err(|error| of_frame(i, &error));
        let snakes = frames.iter().enumerate().map(moved).collect::<Result<Vec<_>>>()?;
        let kinds = arc_kinds(snake.shapes(), tolerance)?;
        Ok(Self::of(snakes, times.to_vec(), kinds))
    }

    fn of(snakes: Vec<Snake>, times: Vec<f64>, kinds: Vec<ArcKind>) -> Self {
        let mut kind_of = vec![0; snakes[0].shapes().len()];
        for (kind, arcs) in kinds.iter().enumerate() {
            arcs.arcs.iter().for_each(|&j| kind_of[j] = kind);
        }
        Self { snakes, times, kinds, kind_of }
    }

    /// The snake at each time.
    pub fn snakes(&self) -> &[Snake] {
        &self.snakes
    }

    /// The times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The kinds of arcs along one position.
    pub fn kinds(&self) -> &[ArcKind] {
        &self.kinds
    }

    /// The kind of each arc along the snake.
    pub fn kind_of(&self) -> &[usize] {
        &self.kind_of
    }

    /// The control points of each position, as [`swept_grid`](super::sweep::swept_grid) takes them.
    pub fn positions(&self) -> Vec<Vec<DVec3>> {
        self.snakes.iter().map(|snake| snake.control().to_vec()).collect()
    }

    /// All arcs, with the position and the place along it.
    fn arcs(&self) -> impl Iterator<Item = (usize, usize, Arc)> {
        let snakes = self.snakes.iter().enumerate();
        snakes.flat_map(|(i, snake)| snake.arcs().into_iter().enumerate().map(move |(j, arc)| (i, j, arc)))
    }

    fn form(&self) -> ArcListForm {
        let arc = |(j, arc): (usize, Arc)| ArcForm {
            kind: self.kind_of[j],
            center: arc.circle.center.to_array(),
            radius: arc.circle.radius,
            axis: arc.circle.normal.to_array(),
            start: arc.start.to_array(),
            angle_rad: arc.angle_rad,
        };
        let frame = |(snake, &time): (&Snake, &f64)| FrameForm {
            time,
            control: snake.control().iter().map(DVec3::to_array).collect(),
            arcs: snake.arcs().into_iter().enumerate().map(arc).collect(),
        };
        ArcListForm {
            version: VERSION,
            closed: self.snakes[0].is_closed(),
            kinds: self.kinds.iter().map(|kind| KindForm::of(kind, self.snakes.len())).collect(),
            frames: self.snakes.iter().zip(&self.times).map(frame).collect(),
        }
    }

    /// The JSON form: a line for each kind and each position, ending in a newline.
    pub fn to_json(&self) -> String {
        json::to_text(&self.form())
    }

    /// The list that a JSON text states. Where arcs are follows from control points and is not read.
    ///
    /// # Errors
    /// Status `InvalidInput`: the text is no such form; the place is that in the text. Otherwise the place is that of the form:
    /// another `version`, no position (`frames`), times that are not finite, positions whose arcs are others than those of the first
    /// or that do not fit their control points (`frames[i]`), kinds that do not exist (`frames[i].arcs[j].kind`) or are of another
    /// shape or number than their arcs (`kinds[k]`).
    pub fn from_json(text: &str) -> Result<Self> {
        let form: ArcListForm = json::from_text(text)?;
        let refuse = |place: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(place));
        if form.version != VERSION {
            return refuse("version", format!("expected {VERSION}, found {}", form.version));
        }
        let Some(first) = form.frames.first() else {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("frames"));
        };
        let shape = |arc: &ArcForm| ArcShape { radius: arc.radius, length: arc.radius * arc.angle_rad };
        let shapes: Vec<ArcShape> = first.arcs.iter().map(shape).collect();
        let mut snakes = Vec::with_capacity(form.frames.len());
        for (i, frame) in form.frames.iter().enumerate() {
            finite(&format!("frames[{i}].time"), frame.time)?;
            let is_same = |a: &ArcForm, b: &ArcForm| {
                a.kind == b.kind && agree(a.radius, b.radius) && agree(a.angle_rad, b.angle_rad)
            };
            if frame.arcs.len() != shapes.len() || !frame.arcs.iter().zip(&first.arcs).all(|(a, b)| is_same(a, b)) {
                return refuse(&format!("frames[{i}].arcs"), "expected the arcs of frames[0], found others".into());
            }
            let control = frame.control.iter().copied().map(DVec3::from_array).collect();
            let snake = Snake::with_arcs(control, shapes.clone(), form.closed);
            snakes.push(snake.map_err(|error| error.at(format!("frames[{i}]")))?);
        }
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); form.kinds.len()];
        for (j, arc) in first.arcs.iter().enumerate() {
            match members.get_mut(arc.kind) {
                Some(members) => members.push(j),
                None => {
                    let reason = format!("{} is out of range for {} kinds", arc.kind, form.kinds.len());
                    return refuse(&format!("frames[0].arcs[{j}].kind"), reason);
                }
            }
        }
        let mut kinds = Vec::with_capacity(members.len());
        for (k, (kind, arcs)) in form.kinds.iter().zip(members).enumerate() {
            let found = ArcKind::of(&shapes, arcs);
            let count = found.count * snakes.len();
            let is_right = agree(kind.radius, found.shape.radius) && agree(kind.length, found.shape.length);
            if !is_right || kind.count != count {
                let reason = format!("expected {count} of {:?}, as the arcs are, found {kind:?}", found.shape);
                return refuse(&format!("kinds[{k}]"), reason);
            }
            kinds.push(found);
        }
        let times = form.frames.iter().map(|frame| frame.time).collect();
        Ok(Self::of(snakes, times, kinds))
    }

    /// All arcs as a table, with a line of names: position, arc, kind, centre, radius, axis, start, angle in radians, length.
    pub fn to_csv(&self) -> String {
        let mut text = String::from(
            "frame,arc,kind,center_x,center_y,center_z,radius,axis_x,axis_y,axis_z,start_x,start_y,start_z,angle_rad,length\n",
        );
        for (i, j, arc) in self.arcs() {
            let _ = write!(text, "{i},{j},{}", self.kind_of[j]);
            let mut values = arc.circle.center.to_array().to_vec();
            values.push(arc.circle.radius);
            values.extend(arc.circle.normal.to_array());
            values.extend(arc.start.to_array());
            values.extend([arc.angle_rad, arc.length()]);
            values.iter().for_each(|value| _ = write!(text, ",{value}"));
            text.push('\n');
        }
        text
    }

    /// The parts list as a table, with a line of names: kind, radius, length, how many in all positions together.
    pub fn kinds_csv(&self) -> String {
        let mut text = String::from("kind,radius,length,count\n");
        for (k, kind) in self.form().kinds.into_iter().enumerate() {
            let _ = writeln!(text, "{k},{},{},{}", kind.radius, kind.length, kind.count);
        }
        text
    }

    /// All arcs as a drawing in the format DXF, release 12, which all programs read: each an entity ARC, on the layer `kind-K` of
    /// its kind. Numbers are as exact as the arcs.
    ///
    /// The crate dxf reads these drawings in the tests. It does not write them, as it says in each when it was made, stops the
    /// program where clocks were set at the beginning of 1900, as in Stockholm, and needs another 25 crates.
    pub fn to_dxf(&self) -> String {
        // Pairs of lines: a group code, and its value.
        let mut text = format!(
            "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n{}\n",
            self.kinds.len()
        );
        for k in 0..self.kinds.len() {
            // The colours 1 to 6 are red, yellow, green, cyan, blue and magenta.
            let _ = write!(text, "0\nLAYER\n2\nkind-{k}\n70\n0\n62\n{}\n6\nCONTINUOUS\n", 1 + k % 6);
        }
        text.push_str("0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
        for (_, j, arc) in self.arcs() {
            let ([x, y, z], [from, to]) = drawn(&arc);
            let _ = write!(text, "0\nARC\n8\nkind-{}\n10\n{x}\n20\n{y}\n30\n{z}\n", self.kind_of[j]);
            let DVec3 { x, y, z } = arc.circle.normal;
            let radius = arc.circle.radius;
            let _ = write!(text, "40\n{radius}\n50\n{from}\n51\n{to}\n210\n{x}\n220\n{y}\n230\n{z}\n");
        }
        text.push_str("0\nENDSEC\n0\nEOF\n");
        text
    }
}

/// The centre of an arc, and the angles in degrees where it begins and ends, in the axes that a drawing has for what is in a plane:
/// those that the format derives from its normal.
fn drawn(arc: &Arc) -> ([f64; 3], [f64; 2]) {
    let normal = arc.circle.normal;
    let is_near_z = normal.x.abs() < 1.0 / 64.0 && normal.y.abs() < 1.0 / 64.0;
    let x = if is_near_z { DVec3::Y } else { DVec3::Z }.cross(normal).normalize_or_zero();
    let y = normal.cross(x);
    let center = arc.circle.center;
    let from = arc.start - center;
    let start = from.dot(y).atan2(from.dot(x));
    let turn = |angle: f64| angle.to_degrees().rem_euclid(360.0);
    ([x, y, normal].map(|axis| center.dot(axis)), [start, start + arc.angle_rad].map(turn))
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= AGREES * b.abs()
}

#[cfg(test)]
mod tests;
