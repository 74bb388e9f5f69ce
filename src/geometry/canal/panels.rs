//! What a workshop cuts: flat panels with their circles and mitre cuts, node axes, planar beams.
//!
//! Node axes are vectors handed on by reflection, such as the normals of the frames. At the two ends of an edge they are mirror images,
//! so they are in one plane with it: a beam between them is planar, and beams meet along the axes (torsion-free nodes). Two plates
//! that meet at an edge are cut along the same plane. Source: Mesnil et al. 2018, section 4.3, Figs. 16 to 18.

use glam::{DVec2, DVec3};

use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::Circle;
use crate::mesh::Grid;
use crate::mesh::fit::Plane;
use crate::mesh::grid::check_finite;

/// A flat panel: one face, laid into a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The corners in space.
    pub corners: [DVec3; 4],
    /// The corners in the panel's plane, in model units, seen from the side that the axes point to: the first is the origin, and
    /// the second is on +x. Corners that are not planar are dropped onto the plane.
    pub outline: [DVec2; 4],
    /// The circle through the corners; its normal is the panel's, on the side that the axes point to. `None` where three
    /// corners are on a line.
    pub circle: Option<Circle>,
    /// For each edge, from one corner to the next: the angle between the cut along it, which contains the axes at its ends, and
    /// the panel's normal. 0 is a square cut; above 0 the panel is longer below (away from the axes).
    pub mitres_rad: [f64; 4],
    /// How far the farthest corner is from the panel's plane.
    pub height: f64,
    /// The axes at the corners, in the panel's coordinates: x, y in the plane, z along its normal.
    axes: [DVec3; 4],
}

/// A planar beam along an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// The indices of its nodes.
    pub nodes: [usize; 2],
    /// Its corners: first node, second node, and both below along their axes.
    pub corners: [DVec3; 4],
}

impl Panel {
    fn new(corners: [DVec3; 4], axes: [DVec3; 4]) -> Result<Self> {
        let degenerate = |reason: &str| Error::new(Status::Degenerate, reason);
        let plane = Plane::fitting(&corners);
        let along = axes.iter().sum::<DVec3>().dot(plane.normal);
        let normal = if along < 0.0 { -plane.normal } else { plane.normal };
        let x = (corners[1] - corners[0]).reject_from_normalized(normal);
        let Some(x) = x.try_normalize() else { return Err(degenerate("its first edge has no length")) };
        let y = normal.cross(x);
        let into = |v: DVec3| DVec3::new(v.dot(x), v.dot(y), v.dot(normal));
        let flat = corners.map(|corner| into(corner - corners[0]));
        let axes = axes.map(into);
        if axes.iter().any(|axis| axis.z.abs() < 1e-6 * axis.length()) {
            return Err(degenerate("an axis at one of its corners lies in its plane"));
        }
        let outline = flat.map(DVec3::truncate);
        // Counterclockwise outlines have the outside on the right of each edge.
        let area: f64 = (0..4).map(|k| outline[k].perp_dot(outline[(k + 1) % 4])).sum();
        let mitre = |k: usize| {
            let edge = (outline[(k + 1) % 4] - outline[k]).normalize_or_zero();
            let outwards = -edge.perp() * area.signum();
            // Both axes, as far as they are orthogonal to the edge, are alike: their sum has less round-off.
            let axis = axes[k] / axes[k].length() + axes[(k + 1) % 4] / axes[(k + 1) % 4].length();
            // Going down along the axis by 1 moves the edge outwards by −axis·outwards / axis.z.
            (-axis.truncate().dot(outwards)).atan2(axis.z)
        };
        let [a, b, c, _] = corners;
        let circle = Circle::through(a, b, c).map(|circle| Circle { normal, ..circle });
        let height = flat.iter().map(|corner| corner.z - (plane.center - corners[0]).dot(normal)).map(f64::abs);
        Ok(Self {
            corners,
            outline,
            circle,
            mitres_rad: std::array::from_fn(mitre),
            height: height.fold(0.0, f64::max),
            axes,
        })
    }

    /// The outline of the panel's lower side, at `thickness` below the outline (away from the axes), cut along its mitres.
    ///
    /// # Errors
    /// A thickness that is not finite, or with which the outline is not.
    pub fn lower_outline(&self, thickness: f64) -> Result<[DVec2; 4]> {
        finite("thickness", thickness)?;
        // The cuts at a corner meet along its axis.
        let corner = |k: usize| self.outline[k] - thickness / self.axes[k].z * self.axes[k].truncate();
        let lower: [DVec2; 4] = std::array::from_fn(corner);
        if lower.iter().all(|corner| corner.is_finite()) {
            return Ok(lower);
        }
        let reason = format!("expected one for which the lower side is finite, found {thickness}");
        Err(Error::new(Status::InvalidValue, reason).at("thickness"))
    }
}

/// Refuses axes that do not belong to a grid's points.
pub(super) fn check_axes(grid: &Grid, axes: &[DVec3]) -> Result<()> {
    if axes.len() != grid.points().len() {
        let reason = format!("expected one for each of {} points, found {}", grid.points().len(), axes.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("axes"));
    }
    check_finite("axes", axes)?;
    // Lengths come from squares: below and beyond what can be squared an axis has no direction.
    match axes.iter().position(|axis| !axis.length_squared().is_normal()) {
        None => Ok(()),
        Some(k) => {
            let reason = format!("expected a vector other than zero, neither tiny nor huge; found {}", axes[k]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("axes[{k}]")))
        }
    }
}

/// The panels of a grid, in the order of its faces, with the axis at each of its points.
///
/// # Errors
/// Another number of axes than of points, an axis that is zero, not finite, or so short or long that its square is. Status
/// `Degenerate`: an edge without a length, or an axis in the plane of a panel; the place is `faces[i]`.
pub fn panels(grid: &Grid, axes: &[DVec3]) -> Result<Vec<Panel>> {
    check_axes(grid, axes)?;
    let panel = |(i, quad): (usize, [usize; 4])| {
        let panel = Panel::new(quad.map(|corner| grid.points()[corner]), quad.map(|corner| axes[corner]));
        panel.map_err(|error| error.at(format!("faces[{i}]")))
    };
    grid.quads().enumerate().map(panel).collect()
}

/// The grid moved by `distance` along its axes (below 0: against them). Along the unit normals of the frames of a circular net all edges
/// stay parallel, and every point has that distance from its image.
///
/// # Errors
/// As [`panels`], or a distance that is not finite.
pub fn offset(grid: &Grid, axes: &[DVec3], distance: f64) -> Result<Grid> {
    check_axes(grid, axes)?;
    finite("distance", distance)?;
    grid.with_points(grid.points().iter().zip(axes).map(|(&point, &axis)| point + distance * axis).collect())
}

/// A beam along every edge, between the axes at its ends, `height` measured along each axis, against it: first the edges from row to
/// row, then those from column to column.
///
/// # Errors
/// As [`offset`].
pub fn beams(grid: &Grid, axes: &[DVec3], height: f64) -> Result<Vec<Beam>> {
    let lower = offset(grid, axes, -height)?;
    let beam = |nodes: [usize; 2]| {
        let [a, b] = nodes;
        Beam { nodes, corners: [grid.points()[a], grid.points()[b], lower.points()[b], lower.points()[a]] }
    };
    Ok(edges(grid).map(beam).collect())
}

/// The edges of a grid as pairs of point indices: first those from row to row, then those from column to column.
pub fn edges(grid: &Grid) -> impl Iterator<Item = [usize; 2]> + '_ {
    let [rows, columns] = grid.spans();
    let down = (0..rows).flat_map(move |i| (0..grid.columns()).map(move |j| [grid.index(i, j), grid.index(i + 1, j)]));
    let along = (0..grid.rows()).flat_map(move |i| (0..columns).map(move |j| [grid.index(i, j), grid.index(i, j + 1)]));
    down.chain(along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::parallel::check_parallel;

    fn net() -> (Grid, Vec<DVec3>) {
        let net = Cyclide::new().net([0.2, 1.8], [-0.6, 1.2], 5, 4);
        (net.grid().clone(), net.frames().iter().map(|frame| frame.normal).collect())
    }

    #[test]
    fn outlines_have_the_lengths_and_angles_of_the_faces_and_their_circle() {
        let (grid, axes) = net();
        for panel in panels(&grid, &axes).unwrap() {
            for k in 0..4 {
                for l in 0..4 {
                    let (flat, space) =
                        (panel.outline[k].distance(panel.outline[l]), panel.corners[k].distance(panel.corners[l]));
                    assert!((flat - space).abs() < 1e-12);
                }
                let circle = panel.circle.unwrap();
                assert!((panel.corners[k].distance(circle.center) - circle.radius).abs() < 1e-12);
            }
            assert!(panel.height < 1e-12 && panel.outline[0] == DVec2::ZERO && panel.outline[1].y.abs() < 1e-15);
        }
    }

    #[test]
    fn plates_meet_along_their_mitres() {
        // The lower outlines of two neighbours, put back into space, end on the common cut: the plane of edge and axes.
        let (grid, axes) = net();
        let thickness = 0.02;
        for (quad, panel) in grid.quads().zip(panels(&grid, &axes).unwrap()) {
            let normal = panel.circle.unwrap().normal;
            let x = (panel.corners[1] - panel.corners[0]).normalize();
            let y = normal.cross(x);
            let lower = panel.lower_outline(thickness).unwrap();
            for k in 0..4 {
                let next = (k + 1) % 4;
                let edge = (panel.corners[next] - panel.corners[k]).normalize();
                let cut = edge.cross(axes[quad[k]]).normalize();
                let space = |flat: DVec2| panel.corners[0] + flat.x * x + flat.y * y - thickness * normal;
                assert!((space(lower[k]) - panel.corners[k]).dot(cut).abs() < 1e-12);
                assert!((space(lower[next]) - panel.corners[k]).dot(cut).abs() < 1e-12);
                // The mitre is the angle of that plane to the normal; outwards positive.
                let angle = (cut.dot(normal)).asin();
                assert!((panel.mitres_rad[k].abs() - angle.abs()).abs() < 1e-12);
                let edge = panel.outline[next] - panel.outline[k];
                let outwards =
                    if panel.outline[1].perp_dot(panel.outline[2]) > 0.0 { -edge.perp() } else { edge.perp() };
                let moved = (lower[k] - panel.outline[k]).dot(outwards.normalize());
                assert!((moved - thickness * panel.mitres_rad[k].tan()).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn offsets_are_parallel_at_a_constant_distance_and_beams_planar() {
        let (grid, axes) = net();
        let moved = offset(&grid, &axes, 0.1).unwrap();
        assert!(check_parallel(&grid, &moved).unwrap().largest_sine < 1e-12);
        for (a, b) in grid.points().iter().zip(moved.points()) {
            assert!((a.distance(*b) - 0.1).abs() < 1e-14);
        }
        let beams = beams(&grid, &axes, 0.1).unwrap();
        assert_eq!(beams.len(), 4 * 4 + 5 * 3);
        for beam in &beams {
            let [a, b, c, d] = beam.corners;
            assert!((b - a).cross(d - a).dot(c - a).abs() < 1e-14);
        }
    }

    #[test]
    fn axes_that_do_not_fit_are_refused() {
        let (grid, mut axes) = net();
        assert_eq!(panels(&grid, &axes[1..]).unwrap_err().place(), "axes");
        axes[3] = DVec3::ZERO;
        assert_eq!(offset(&grid, &axes, 0.1).unwrap_err().place(), "axes[3]");
        axes[3] = grid.at(0, 3) - grid.at(0, 2);
        assert_eq!(panels(&grid, &axes).unwrap_err().place(), "faces[2]");
        axes[3] = DVec3::NAN;
        assert_eq!(beams(&grid, &axes, 0.1).unwrap_err().place(), "axes[3]");
        axes[3] = DVec3::Z;
        assert_eq!(offset(&grid, &axes, f64::NAN).unwrap_err().place(), "distance");
    }
}
