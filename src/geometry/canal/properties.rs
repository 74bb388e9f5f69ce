//! What a surface's net has to offer: the properties of table 2 of the paper, measured where they can be.
//!
//! - *Circular, planar quads*: measured.
//! - *Planar curves*: measured, for rows and for columns.
//! - *Stress lines*: whether lines of curvature can be lines of principal stress under uniform pressure. Measured on the refined net
//!   at two densities: the residual of `membrane` must fall.
//! - *Isothermic*: stated by construction, and measured. Surfaces of revolution are isothermic, and so are their images under
//!   Möbius transformations. The table says the same of Combescure transforms. That does not hold in general: with the rail's
//!   curvature `κ(u)` and the profile's distance `x(v)` a moulding surface has the Lamé coefficients `1 − κ x` and 1, whose quotient is a
//!   product of functions of `u` and of `v` only if `κ` is constant. So Combescure transforms are not stated to be isothermic here.
//!   What is measured is the cross-ratio of each quad, `|ab| |cd| / |bc| |da|`: on an isothermic net it is a product of
//!   a number of the row and a number of the column.

use glam::DVec3;

use super::chain::Kind;
use super::folds::Folds;
use super::membrane::least_residual;
use super::quality::{Quality, largest};
use super::surface::{BaseKind, SuperCanal};
use crate::error::{Error, Result, Status};
use crate::mesh::Grid;
use crate::mesh::fit::Plane;
use crate::mesh::grid::diagonal;

/// Curves whose points are within this part of their extent from a plane count as planar.
pub const PLANAR: f64 = 1e-9;

/// Faces up to which a net is refined for stress lines: some seconds.
const MOST_FACES: usize = 40_000;

/// A residual of the membrane below this is the round-off of refining and solving.
const ROUND_OFF: f64 = 1e-6;

/// The properties of a surface's net.
#[derive(Clone, Debug)]
pub struct Properties {
    /// The name of its family.
    pub family: String,
    /// The number of faces.
    pub face_count: usize,
    /// The largest planarity residual of a face, and the largest concyclicity residual: see [`Quality`].
    pub planarity: f64,
    /// As above.
    pub concyclicity: f64,
    /// The number of faces that cross themselves.
    pub crossed_count: usize,
    /// The largest distance of a row's point from the row's best-fit plane, over the row's extent; and of a column's.
    pub off_plane: [f64; 2],
    /// Whether it is isothermic by construction: a surface of revolution, or a Möbius image of one.
    pub is_isothermic_by_construction: bool,
    /// How far logarithms of cross-ratios are from sums of a number of the row and one of the column, at most: 0 on an
    /// isothermic net.
    pub cross_ratio_residual: f64,
    /// Whether lines of curvature can be lines of principal stress.
    pub stress_lines: Result<StressLines>,
    /// Where panels fold over or shrink.
    pub folds: Folds,
}

/// The residual of the membrane at two densities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressLines {
    /// Into how many by how many pieces faces were cut.
    pub pieces: [usize; 2],
    /// The residuals: 0 in equilibrium, 1 where no force carries anything.
    pub residuals: [f64; 2],
}

impl StressLines {
    /// Whether the residual falls as it does where lines of curvature are lines of principal stress.
    pub fn holds(&self) -> bool {
        self.residuals[1] < ROUND_OFF || self.residuals[1] < 0.6 * self.residuals[0]
    }

    fn of(surface: &SuperCanal) -> Result<Self> {
        let [rows, columns] = surface.base().grid().spans();
        let pieces = [8, 4, 2].into_iter().find(|pieces| rows * columns * pieces * pieces <= MOST_FACES);
        let Some(fine) = pieces else {
            let reason = format!("{} faces, refined, make more than {MOST_FACES}", rows * columns);
            return Err(Error::new(Status::TooLarge, reason));
        };
        let pieces = [fine / 2, fine];
        let residual = |pieces: usize| least_residual(&surface.refined(pieces, pieces)?);
        Ok(Self { pieces, residuals: [residual(pieces[0])?, residual(pieces[1])?] })
    }
}

impl Properties {
    /// Measures a surface.
    pub fn of(surface: &SuperCanal) -> Self {
        let grid = surface.net().grid();
        let quality = Quality::of(grid);
        let rows = (0..grid.rows()).map(|i| off_plane(grid.row(i)));
        let columns = (0..grid.columns()).map(|j| off_plane(&grid.column(j)));
        let has_combescure = surface.chain().iter().any(|transform| transform.kind() == Kind::Combescure);
        Self {
            family: surface.family(),
            face_count: quality.planarity.len(),
            planarity: largest(&quality.planarity),
            concyclicity: largest(&quality.concyclicity),
            crossed_count: quality.crossed_count(),
            off_plane: [rows.fold(0.0, f64::max), columns.fold(0.0, f64::max)],
            is_isothermic_by_construction: surface.kind() == BaseKind::Revolution && !has_combescure,
            cross_ratio_residual: cross_ratio_residual(grid),
            stress_lines: StressLines::of(surface),
            folds: Folds::of(grid),
        }
    }

    /// Whether one family of lines of curvature is planar.
    pub fn has_planar_curves(&self) -> bool {
        self.off_plane.iter().any(|&distance| distance <= PLANAR)
    }
}

fn off_plane(points: &[DVec3]) -> f64 {
    let plane = Plane::fitting(points);
    let farthest = points.iter().map(|&point| plane.height(point).abs()).fold(0.0, f64::max);
    let extent = diagonal(points);
    if extent > 0.0 { farthest / extent } else { 0.0 }
}

fn cross_ratio_residual(grid: &Grid) -> f64 {
    let [rows, columns] = grid.spans();
    let logarithm = |i: usize, j: usize| {
        let [a, b, c, d] = grid.corners(i, j);
        (a.distance(b) * c.distance(d) / (b.distance(c) * d.distance(a))).ln()
    };
    let first: Vec<f64> = (0..columns).map(|j| logarithm(0, j)).collect();
    let mut residual = 0.0_f64;
    for i in 0..rows {
        let shift = logarithm(i, 0) - first[0];
        for j in 0..columns {
            let apart = (logarithm(i, j) - first[j] - shift).abs();
            // An edge without a length says nothing.
            residual = if apart.is_finite() { residual.max(apart) } else { residual };
        }
    }
    residual
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::geometry::canal::bases::{moulding, revolution};
    use crate::geometry::canal::chain::Transform;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::families::Family;
    use crate::geometry::canal::inversion::Inversion;
    use crate::geometry::canal::net::Net;

    fn vase() -> Net {
        let profile: Vec<DVec3> =
            (0..7).map(|i| DVec3::new(1.0 + 0.3 * f64::from(i).sin(), 0.0, 0.4 * f64::from(i))).collect();
        let base = revolution(&profile, DVec3::ZERO, DVec3::Z, PI, 9).unwrap();
        Net::new(base.grid, base.frame).unwrap()
    }

    fn inversion() -> Transform {
        Transform::Inversion(Inversion::new(DVec3::new(0.3, 2.2, 1.0), 3.0).unwrap())
    }

    #[test]
    fn properties_follow_the_family_as_far_as_they_can_be_measured() {
        let uneven = Transform::Combescure {
            column: vec![1.2, 0.9, 1.1, 0.8, 1.3, 1.0],
            row: vec![1.0, 1.2, 1.4, 1.2, 1.0, 0.8, 0.7, 0.9],
        };
        for (family, chain, is_isothermic, has_planar_curves) in [
            (Family::Revolution, vec![], true, true),
            (Family::MRevolution, vec![inversion()], true, true),
            (Family::CMRevolution, vec![inversion(), uneven.clone()], false, true),
            (Family::MCMRevolution, vec![inversion(), uneven.clone(), inversion()], false, false),
        ] {
            let found = Properties::of(&family.build(vase(), chain).unwrap());
            assert_eq!(found.family, family.name());
            assert_eq!(found.is_isothermic_by_construction, is_isothermic);
            assert_eq!(found.cross_ratio_residual < 1e-9, is_isothermic, "{found:?}");
            assert_eq!(found.has_planar_curves(), has_planar_curves, "{} {:?}", found.family, found.off_plane);
            assert!(found.planarity < 1e-10 && found.concyclicity < 1e-10);
            let holds = found.stress_lines.as_ref().unwrap().holds();
            let is_canal = matches!(family, Family::Revolution | Family::MRevolution);
            assert_eq!(holds, is_canal, "{} {:?}", found.family, found.stress_lines);
        }
    }

    #[test]
    fn a_moulding_surface_is_isothermic_only_if_its_rail_is_a_circle() {
        let profile: Vec<DVec3> =
            (0..6).map(|j| DVec3::new(0.0, 0.15 * f64::from(j), 0.3 * f64::from(j).sin())).collect();
        let residual = |bend: f64| {
            let rail: Vec<DVec3> = (0..=24)
                .map(|i| {
                    let angle = 0.05 * f64::from(i);
                    DVec3::new(angle.sin() * (1.0 + bend * angle), 1.0 - angle.cos(), 0.0)
                })
                .collect();
            let base = moulding(&rail, &profile).unwrap().base;
            let surface = Family::Moulding.build(Net::new(base.grid, base.frame).unwrap(), vec![]).unwrap();
            Properties::of(&surface).cross_ratio_residual
        };
        assert!(residual(0.0) < 1e-10 && residual(0.5) > 1e-2, "{} {}", residual(0.0), residual(0.5));
    }

    #[test]
    fn what_cannot_be_refined_says_so() {
        let net = Cyclide::new().net([0.2, 1.9], [-0.7, 1.3], 120, 120);
        let found = Properties::of(&SuperCanal::new(net, BaseKind::Canal));
        assert_eq!(found.stress_lines.unwrap_err().status(), Status::TooLarge);
    }
}
