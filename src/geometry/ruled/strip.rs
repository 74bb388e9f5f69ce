//! A ruled strip: two boundaries that are cubic B-splines, joined by straight lines.

use std::ops::Range;

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::curve::{BSpline, CubicBasis, Curve, fit};
use crate::mesh::reference::SurfaceJet;
use crate::mesh::{Mesh, patterns};

/// The points and weights of Gauss's rule of 4 points over the interval from 0 to 1, exact for polynomials of degree 7.
pub(super) const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];

/// The surface `S(u, v) = (1 − v) Σ N_i(u) b_i0 + v Σ N_i(u) b_i1`, `v` from 0 to 1, `u` over the range of the basis.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    boundaries: [BSpline; 2],
}

impl Strip {
    /// The strip with these control points of its two boundaries.
    ///
    /// # Errors
    /// Not one point for each function, or a coordinate that is not finite; the place is `control[side]` or `control[side][i]`.
    pub fn new(basis: CubicBasis, [first, second]: [Vec<DVec3>; 2]) -> Result<Self> {
        let boundary = |side: usize, control| {
            BSpline::new(basis.clone(), control).map_err(|error| {
                let inner = error.place().trim_start_matches("control").to_owned();
                Error::with_place(error, format!("control[{side}]{inner}"))
            })
        };
        Ok(Self { boundaries: [boundary(0, first)?, boundary(1, second)?] })
    }

    /// The basis of both boundaries.
    pub fn basis(&self) -> &CubicBasis {
        self.boundaries[0].basis()
    }

    /// A boundary: 0 for `v = 0`, 1 for `v = 1`.
    pub fn boundary(&self, side: usize) -> &BSpline {
        &self.boundaries[side]
    }

    /// The control points of a boundary.
    pub fn control(&self, side: usize) -> &[DVec3] {
        self.boundaries[side].control()
    }

    /// The last parameter `u`; the first is 0.
    pub fn length_u(&self) -> f64 {
        self.basis().spans() as f64
    }

    /// The ends of the ruling at a parameter.
    pub fn ruling(&self, u: f64) -> [DVec3; 2] {
        let local = self.basis().at(u);
        [0, 1].map(|side| local.jet(self.control(side)).point)
    }

    /// Rulings, evenly spread over `u`, the first and the last included (of a closed strip these are one, given once).
    pub fn rulings(&self, count: usize) -> Vec<[DVec3; 2]> {
        self.ruling_parameters(count).into_iter().map(|u| self.ruling(u)).collect()
    }

    /// The parameters of [`Strip::rulings`].
    pub fn ruling_parameters(&self, count: usize) -> Vec<f64> {
        let parts = if self.basis().is_closed() { count } else { count.max(2) - 1 };
        (0..count).map(|i| self.length_u() * i as f64 / parts as f64).collect()
    }

    /// The surface at two parameters: derivatives by `u`, by `v`, twice by `u`, by both, twice by `v` (which is zero).
    pub fn at(&self, u: f64, v: f64) -> SurfaceJet {
        let local = self.basis().at(u);
        let [a, b] = [0, 1].map(|side| local.jet(self.control(side)));
        SurfaceJet {
            point: a.point.lerp(b.point, v),
            first: [a.first.lerp(b.first, v), b.point - a.point],
            second: [a.second.lerp(b.second, v), b.first - a.first, DVec3::ZERO],
        }
    }

    /// A mesh of `columns * rows` points, columns along the boundaries: point `(i, j)` is `row * columns + column`; faces as of
    /// [`patterns::parametric_surface`]. A closed strip has a seam, where points are there twice.
    ///
    /// # Errors
    /// Fewer than 2 columns or rows.
    pub fn mesh(&self, columns: usize, rows: usize) -> Result<Mesh> {
        patterns::parametric_surface(columns, rows, [0.0, self.length_u()], [0.0, 1.0], |u, v| self.at(u, v).point)
    }

    /// The part of an open strip over some of its spans, as a strip of its own: the same surface, to 1e-9 of its size at least, since
    /// between whole knots its boundaries are splines over these.
    ///
    /// # Errors
    /// A closed strip (`strip`), or spans that it does not have, or none (`spans`).
    pub fn part(&self, spans: Range<usize>) -> Result<Self> {
        if self.basis().is_closed() {
            return Err(Error::new(Status::InvalidValue, "expected an open strip, found a closed one").at("strip"));
        }
        if spans.is_empty() || spans.end > self.basis().spans() {
            let reason = format!("expected some of 0..{}, found {spans:?}", self.basis().spans());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("spans"));
        }
        let basis = CubicBasis::new(spans.len() + 3, false)?;
        let parameters: Vec<f64> = (0..=4 * spans.len()).map(|k| 0.25 * k as f64).collect();
        let side = |side: usize| {
            let point = |u: &f64| self.boundary(side).point(spans.start as f64 + u);
            let points: Vec<DVec3> = parameters.iter().map(point).collect();
            Ok(fit(basis.clone(), &parameters, &points)?.control().to_vec())
        };
        Self::new(basis.clone(), [side(0)?, side(1)?])
    }

    /// Its area in square model units: the integral of `|S_u × S_v|`, by Gauss's rule in each span.
    pub fn area(&self) -> f64 {
        let in_span = |span: usize| -> f64 {
            let at = |(u, v): (f64, f64)| {
                let jet = self.at(span as f64 + u, v);
                jet.first[0].cross(jet.first[1]).length()
            };
            GAUSS.iter().flat_map(|&(u, du)| GAUSS.map(|(v, dv)| du * dv * at((u, v)))).sum()
        };
        (0..self.basis().spans()).map(in_span).sum()
    }

    /// Whether all control points are one.
    pub(super) fn is_point(&self) -> bool {
        let first = self.control(0)[0];
        [0, 1].iter().all(|&side| self.control(side).iter().all(|point| *point == first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::coverage::NearestStrip;

    /// The saddle z = xy over [−1, 1]² with straight rulings: control points of a line at its Greville abscissae.
    fn saddle(count: usize) -> Strip {
        let basis = CubicBasis::new(count, false).unwrap();
        let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
        let x = |i: usize| 2.0 * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / (3.0 * spans) - 1.0;
        let control = [-1.0, 1.0].map(|y| (0..count).map(|i| DVec3::new(x(i), y, x(i) * y)).collect());
        Strip::new(basis, control).unwrap()
    }

    #[test]
    fn a_part_is_the_same_surface() {
        let wavy =
            |i: usize, side: f64| DVec3::new(i as f64, (1.7 * i as f64).sin() + side, side * (0.9 * i as f64).cos());
        let control = |side: f64| (0..9).map(|i| wavy(i, side)).collect::<Vec<_>>();
        let strip = Strip::new(CubicBasis::new(9, false).unwrap(), [control(0.0), control(1.0)]).unwrap();
        for spans in [0..6, 1..4, 5..6] {
            let part = strip.part(spans.clone()).unwrap();
            assert_eq!(part.basis().spans(), spans.len());
            for k in 0..=30 {
                let (u, v) = (f64::from(k) / 30.0 * spans.len() as f64, 0.3);
                let there = strip.at(spans.start as f64 + u, v).point;
                assert!(part.at(u, v).point.distance(there) < 1e-9, "{spans:?} {u}");
            }
        }
        for spans in [2..2, 3..7] {
            assert_eq!(strip.part(spans).unwrap_err().place(), "spans");
        }
        let closed = Strip::new(CubicBasis::new(6, true).unwrap(), [0, 1].map(|k| strip.control(k)[..6].to_vec()));
        assert_eq!(closed.unwrap().part(0..2).unwrap_err().place(), "strip");
    }

    #[test]
    fn the_saddle_is_a_strip() {
        for count in [4, 7] {
            let strip = saddle(count);
            for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 1.0), (0.77, 0.4)] {
                let jet = strip.at(u * strip.length_u(), v);
                let [x, y] = [2.0 * u - 1.0, 2.0 * v - 1.0];
                assert!(jet.point.distance(DVec3::new(x, y, x * y)) < 1e-14);
                let normal = DVec3::new(-y, -x, 1.0).normalize();
                assert!(jet.normal().distance(normal) < 1e-14 && jet.second[0].length() < 1e-13);
                let [a, b] = strip.ruling(u * strip.length_u());
                assert!(a.lerp(b, v).distance(jet.point) < 1e-14);
            }
            let search = NearestStrip::new(std::slice::from_ref(&strip)).unwrap();
            let foot = search.nearest(DVec3::new(0.3, -0.2, -0.06) + 0.2 * DVec3::new(0.2, -0.3, 1.0));
            assert!(foot.point.distance(DVec3::new(0.3, -0.2, -0.06)) < 1e-14);
        }
        let moments = [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0, 1.0 / 8.0];
        let moment = |k: usize| GAUSS.iter().map(|(x, weight)| weight * x.powi(k as i32)).sum::<f64>();
        assert!((0..8).all(|k| (moment(k) - moments[k]).abs() < 1e-15));
        // The mean of √(1 + x² + y²) over the square, by the midpoint rule.
        let n = 200;
        let at = |i: usize| 2.0 * (i as f64 + 0.5) / n as f64 - 1.0;
        let term = |i: usize| (1.0 + at(i % n).powi(2) + at(i / n).powi(2)).sqrt();
        let area = 4.0 * (0..n * n).map(term).sum::<f64>() / (n * n) as f64;
        assert!((saddle(9).area() / area - 1.0).abs() < 1e-4, "{} {area}", saddle(9).area());
    }

    #[test]
    fn meshes_and_rulings_are_on_the_strip_and_bad_control_points_are_named() {
        let strip = saddle(5);
        let mesh = strip.mesh(9, 3).unwrap();
        assert_eq!((mesh.points.len(), mesh.faces.len()), (27, 16));
        assert!(mesh.points.iter().all(|p| (p.z - p.x * p.y).abs() < 1e-14));
        let rulings = strip.rulings(9);
        assert!((0..9).all(|i| rulings[i][0].distance(mesh.points[i]) < 1e-14));
        assert!((0..9).all(|i| rulings[i][1].distance(mesh.points[18 + i]) < 1e-14));
        let basis = CubicBasis::new(4, true).unwrap();
        let ring =
            [0.0, 1.0].map(|z| [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|[x, y]| DVec3::new(x, y, z)));
        let ring = Strip::new(basis.clone(), ring.map(|side| side.to_vec())).unwrap();
        assert_eq!(ring.rulings(4).len(), 4);
        assert!(ring.rulings(4)[0][0].distance(ring.rulings(4)[2][0]) > 1.0);
        let mut control = [vec![DVec3::ZERO; 4], vec![DVec3::X; 4]];
        control[1][2].z = f64::INFINITY;
        let error = Strip::new(basis.clone(), control).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::InvalidValue, "control[1][2]"));
        let error = Strip::new(basis, [vec![DVec3::ZERO; 3], vec![DVec3::X; 4]]).unwrap_err();
        assert_eq!(error.place(), "control[0]");
    }
}
