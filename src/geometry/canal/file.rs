//! JSON forms: of a surface with its chain (`docs/canal.schema.json`), and of what a workshop cuts
//! (`docs/canal-parts.schema.json`).

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::chain::Transform;
use super::frame::{Direction, Frame, Kink};
use super::inversion::Inversion;
use super::net::Net;
use super::node_axes::NodeAxes;
use super::panels::{self, beams};
use super::surface::{BaseKind, SuperCanal};
use crate::error::{Error, Result, Status};
use crate::mesh::Grid;
use crate::problem::json;

/// The version of both forms.
const VERSION: u32 = 1;

/// A super-canal surface: its base and the transformations applied to it. Lengths are in model units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SurfaceForm {
    /// 1.
    pub version: u32,
    /// What the base is.
    pub base: BaseForm,
    /// The number of rows of points: along the guide curve.
    pub rows: usize,
    /// The number of columns of points: along the sections.
    pub columns: usize,
    /// Whether row 0 follows the last row, and column 0 the last column.
    #[serde(default)]
    pub wraps: [bool; 2],
    /// The unit tangents at point (0, 0): along the guide, along the section. The normal is their cross product.
    pub frame: [[f64; 3]; 2],
    /// The rows, or the columns, along which the base is creased.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub kinks: Vec<KinkForm>,
    /// The points of the base, row by row: point (i, j) at `i * columns + j`.
    pub points: Vec<[f64; 3]>,
    /// The transformations, in the order in which they are applied.
    #[serde(default)]
    pub chain: Vec<LinkForm>,
}

/// A line along which a base is creased.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct KinkForm {
    /// 1 for a row, which is crossed along the guide; 2 for a column.
    pub direction: u8,
    /// Which one, neither the first nor beyond the last.
    pub line: usize,
    /// By how much frames turn there about the line's tangent, in radians.
    pub angle_rad: f64,
}

/// What a base is.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum BaseForm {
    /// A canal surface: its sections are circles.
    Canal,
    /// A surface of revolution.
    Revolution,
    /// A moulding surface.
    Moulding,
    /// Any circular net.
    Circular,
}

/// A transformation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LinkForm {
    /// An inversion: `center + ratio (x - center) / |x - center|^2`.
    Inversion {
        /// Its center.
        center: [f64; 3],
        /// Its ratio, other than 0, in squared model units.
        ratio: f64,
    },
    /// Every point moves by this vector.
    Translation([f64; 3]),
    /// Every point's position vector is multiplied by this number, other than 0.
    Scaling(f64),
    /// Every point turns about the origin by a unit quaternion `x y z w`.
    Rotation([f64; 4]),
    /// The parallel net whose edges along column 0 and row 0 are these multiples, none 0, of what they were.
    Combescure {
        /// Along column 0, one per edge from row to row.
        column: Vec<f64>,
        /// Along row 0, one per edge from column to column.
        row: Vec<f64>,
    },
}

impl From<BaseKind> for BaseForm {
    fn from(kind: BaseKind) -> Self {
        match kind {
            BaseKind::Canal => Self::Canal,
            BaseKind::Revolution => Self::Revolution,
            BaseKind::Moulding => Self::Moulding,
            BaseKind::Circular => Self::Circular,
        }
    }
}

impl From<BaseForm> for BaseKind {
    fn from(form: BaseForm) -> Self {
        match form {
            BaseForm::Canal => Self::Canal,
            BaseForm::Revolution => Self::Revolution,
            BaseForm::Moulding => Self::Moulding,
            BaseForm::Circular => Self::Circular,
        }
    }
}

impl From<&Transform> for LinkForm {
    fn from(transform: &Transform) -> Self {
        match transform {
            Transform::Inversion(inversion) => {
                Self::Inversion { center: inversion.center().to_array(), ratio: inversion.ratio() }
            }
            Transform::Translation(step) => Self::Translation(step.to_array()),
            Transform::Scaling(factor) => Self::Scaling(*factor),
            Transform::Rotation(turn) => Self::Rotation(turn.to_array()),
            Transform::Combescure { column, row } => Self::Combescure { column: column.clone(), row: row.clone() },
        }
    }
}

impl TryFrom<&LinkForm> for Transform {
    type Error = Error;

    fn try_from(form: &LinkForm) -> Result<Self> {
        let transform = match form {
            LinkForm::Inversion { center, ratio } => {
                Self::Inversion(Inversion::new(DVec3::from_array(*center), *ratio)?)
            }
            LinkForm::Translation(step) => Self::Translation(DVec3::from_array(*step)),
            LinkForm::Scaling(factor) => Self::Scaling(*factor),
            LinkForm::Rotation(turn) => Self::Rotation(DQuat::from_array(*turn)),
            LinkForm::Combescure { column, row } => Self::Combescure { column: column.clone(), row: row.clone() },
        };
        transform.check()?;
        Ok(transform)
    }
}

impl SuperCanal {
    /// The surface that a JSON text states.
    ///
    /// # Errors
    /// Status `InvalidInput`: the text is no such form; the place is that in the text. Otherwise as [`Net::new`] and
    /// [`SuperCanal::push`]; the place of a transformation is `chain[k]`.
    pub fn from_json(text: &str) -> Result<Self> {
        let form: SurfaceForm = json::from_text(text)?;
        if form.version != VERSION {
            let reason = format!("expected {VERSION}, found {}", form.version);
            return Err(Error::new(Status::InvalidValue, reason).at("version"));
        }
        let points = form.points.iter().map(|&point| DVec3::from_array(point)).collect();
        let [t1, t2] = form.frame.map(DVec3::from_array);
        let grid = Grid::new(points, form.rows, form.columns, form.wraps)?;
        let kink = |(k, form): (usize, &KinkForm)| {
            let across = match form.direction {
                1 => Direction::One,
                2 => Direction::Two,
                other => {
                    let reason = format!("expected 1 or 2, found {other}");
                    return Err(Error::new(Status::InvalidValue, reason).at("direction").at(format!("kinks[{k}]")));
                }
            };
            Ok(Kink { across, line: form.line, angle_rad: form.angle_rad })
        };
        let kinks = form.kinks.iter().enumerate().map(kink).collect::<Result<Vec<_>>>()?;
        let base = Net::with_kinks(grid, Frame { t1, t2, normal: t1.cross(t2) }, &kinks)?;
        let mut surface = Self::new(base, form.base.into());
        for (k, link) in form.chain.iter().enumerate() {
            let pushed = Transform::try_from(link).and_then(|transform| surface.push(transform));
            pushed.map_err(|error| error.at(format!("chain[{k}]")))?;
        }
        Ok(surface)
    }

    /// Its JSON form: a line per point and transformation, ending in a newline. Read again it is the same, bit by bit.
    pub fn to_json(&self) -> String {
        let grid = self.base().grid();
        let frame = self.base().frames()[0];
        json::to_text(&SurfaceForm {
            version: VERSION,
            base: self.kind().into(),
            rows: grid.rows(),
            columns: grid.columns(),
            wraps: grid.wraps(),
            frame: [frame.t1, frame.t2].map(|tangent| tangent.to_array()),
            kinks: self
                .base()
                .kinks()
                .iter()
                .map(|kink| KinkForm {
                    direction: if kink.across == Direction::One { 1 } else { 2 },
                    line: kink.line,
                    angle_rad: kink.angle_rad,
                })
                .collect(),
            points: grid.points().iter().map(DVec3::to_array).collect(),
            chain: self.chain().iter().map(LinkForm::from).collect(),
        })
    }
}

/// What a workshop cuts: flat panels and planar beams between node axes. Lengths are in model units.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PartsForm {
    /// 1.
    pub version: u32,
    /// The points of the net.
    pub points: Vec<[f64; 3]>,
    /// A unit vector at each point: the axis of its node.
    pub axes: Vec<[f64; 3]>,
    /// The difference of the depths along each axis that beams of height 1 need there.
    pub gaps: Vec<f64>,
    /// A panel for each face.
    pub panels: Vec<PanelForm>,
    /// A beam for each edge.
    pub beams: Vec<BeamForm>,
}

/// A flat panel.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PanelForm {
    /// The indices of its corners.
    pub corners: [usize; 4],
    /// The corners in the panel's plane, seen from the side that the axes point to: the first at the origin, the second on +x.
    pub outline: [[f64; 2]; 4],
    /// The outline of the lower side, where a thickness was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_outline: Option<[[f64; 2]; 4]>,
    /// For each edge, from corner to next corner, the angle in degrees between its cut and a square one; above 0 the panel is
    /// longer below.
    pub mitres_deg: [f64; 4],
    /// The circle through the corners; none where three of them are on a line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<CircleForm>,
    /// How far the farthest corner is from the panel's plane.
    pub height: f64,
}

/// A circle in space.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CircleForm {
    /// Its center.
    pub center: [f64; 3],
    /// A unit vector along its axis.
    pub normal: [f64; 3],
    /// Its radius.
    pub radius: f64,
}

/// A planar beam.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BeamForm {
    /// The indices of its nodes.
    pub nodes: [usize; 2],
    /// Its corners in space: first node, second node, and both below along their axes.
    pub corners: [[f64; 3]; 4],
}

impl PartsForm {
    /// The panels of a grid, with a lower outline where `thickness` is above 0, and the beams of the given height along each axis.
    ///
    /// # Errors
    /// As [`panels::panels`] and [`beams`].
    pub fn new(grid: &Grid, axes: &NodeAxes, thickness: f64, height: f64) -> Result<Self> {
        let panel = |(panel, corners): (&panels::Panel, [usize; 4])| {
            let flat = |outline: [glam::DVec2; 4]| outline.map(|corner| corner.to_array());
            let lower = if thickness > 0.0 { Some(flat(panel.lower_outline(thickness)?)) } else { None };
            let circle = panel.circle.map(|circle| CircleForm {
                center: circle.center.to_array(),
                normal: circle.normal.to_array(),
                radius: circle.radius,
            });
            Ok(PanelForm {
                corners,
                outline: flat(panel.outline),
                lower_outline: lower,
                mitres_deg: panel.mitres_rad.map(f64::to_degrees),
                circle,
                height: panel.height,
            })
        };
        let panels = panels::panels(grid, &axes.axes)?;
        let beams = beams(grid, &axes.axes, height)?;
        Ok(Self {
            version: VERSION,
            points: grid.points().iter().map(DVec3::to_array).collect(),
            axes: axes.axes.iter().map(DVec3::to_array).collect(),
            gaps: axes.gaps.clone(),
            panels: panels.iter().zip(grid.quads()).map(panel).collect::<Result<_>>()?,
            beams: beams
                .iter()
                .map(|beam| BeamForm { nodes: beam.nodes, corners: beam.corners.map(|corner| corner.to_array()) })
                .collect(),
        })
    }

    /// Its JSON form: a line per point, panel and beam.
    pub fn to_json(&self) -> String {
        json::to_text(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;

    fn surface() -> SuperCanal {
        let mut surface = SuperCanal::new(Cyclide::new().net([0.2, 1.9], [-0.7, 1.3], 4, 3), BaseKind::Canal);
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8);
        for transform in [
            Transform::Combescure { column: vec![1.1, 0.9, 1.3], row: vec![0.8, 1.0] },
            Transform::Inversion(Inversion::new(DVec3::new(0.1, 0.4, 0.9), -1.3).unwrap()),
            Transform::Rotation(turn),
            Transform::Scaling(0.5),
            Transform::Translation(DVec3::ONE),
        ] {
            surface.push(transform).unwrap();
        }
        surface
    }

    #[test]
    fn a_surface_is_read_as_it_was_written() {
        let surface = surface();
        assert_eq!(SuperCanal::from_json(&surface.to_json()).unwrap().to_json(), surface.to_json());
        let read = SuperCanal::from_json(&surface.to_json()).unwrap();
        assert_eq!(read.net().grid(), surface.net().grid());
    }

    #[test]
    fn kinks_are_kept() {
        let cyclide = Cyclide::new();
        let kink = Kink { across: Direction::Two, line: 1, angle_rad: 0.25 };
        let grid = cyclide.grid([0.2, 1.9], [-0.7, 1.3], 4, 3);
        let base = Net::with_kinks(grid, cyclide.frame(0.2, -0.7), &[kink]).unwrap();
        let surface = SuperCanal::new(base, BaseKind::Circular);
        let text = surface.to_json();
        assert_eq!(SuperCanal::from_json(&text).unwrap().base(), surface.base());
        let wrong = SuperCanal::from_json(&text.replace("\"direction\": 2", "\"direction\": 3")).unwrap_err();
        assert_eq!(wrong.place(), "kinks[0].direction");
    }

    #[test]
    fn a_form_that_errs_is_refused_with_its_place() {
        let text = surface().to_json();
        let refusal = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            SuperCanal::from_json(&text.replacen(from, to, 1)).unwrap_err().place().to_owned()
        };
        assert_eq!(refusal("\"version\": 1", "\"version\": 2"), "version");
        assert_eq!(refusal("\"rows\": 4", "\"rows\": 5"), "points");
        assert_eq!(refusal("\"ratio\": -1.3", "\"ratio\": 0"), "chain[1].ratio");
        assert_eq!(refusal("[1.1, 0.9, 1.3]", "[1.1, 0.9]"), "chain[0].column");
        assert_eq!(refusal("\"scaling\": 0.5", "\"shrinking\": 0.5"), "chain[3]");
        assert_eq!(refusal("\"canal\"", "\"channel\""), "base");
    }

    #[test]
    fn parts_have_a_panel_for_each_face_and_a_beam_for_each_edge() {
        let surface = surface();
        let grid = surface.net().grid();
        let normals: Vec<DVec3> = surface.net().frames().iter().map(|frame| frame.normal).collect();
        let axes = NodeAxes::of(grid, &normals).unwrap();
        let parts = PartsForm::new(grid, &axes, 0.01, 0.1).unwrap();
        assert_eq!((parts.panels.len(), parts.beams.len(), parts.axes.len()), (6, 3 * 3 + 4 * 2, 12));
        assert!(parts.panels.iter().all(|panel| panel.lower_outline.is_some() && panel.height < 1e-12));
        let read: PartsForm = json::from_text(&parts.to_json()).unwrap();
        assert_eq!(read, parts);
        assert!(PartsForm::new(grid, &axes, 0.0, 0.1).unwrap().panels[0].lower_outline.is_none());
    }
}
