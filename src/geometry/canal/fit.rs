//! The canal surface that fits two curves: the first is one of its lines of curvature, the second is touched by it (section 4.1).

use super::circle_strip::CircleStrip;
use super::circles::{Section, mesh};
use super::frame::{Direction, Frame};
use super::normals::{Guide, Orientation};
use crate::error::Result;
use crate::mesh::Grid;
use crate::mesh::curve::{Curve, NearestOnCurve, Spacing};

/// What is free in the fit of a canal surface to two curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// How many circles, one through each of as many points of the first curve; at least 2, 3 on a closed curve.
    pub circle_count: usize,
    /// How these points are spread.
    pub spacing: Spacing,
    /// How many points of each circle; at least 2, 3 of whole circles.
    pub column_count: usize,
    /// The normal of the surface at the first point. The opposite one makes the same surface.
    pub orientation: Orientation,
    /// Which part of the circles.
    pub section: Section,
}

/// A canal surface through one curve that touches another.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Row `i` is on circle `i`, from its point of the first curve on (unless the section starts elsewhere). Rows do not wrap, on a
    /// closed curve either; columns do around whole circles.
    pub grid: Grid,
    /// The frame at point `(0, 0)`: `t1` along the guide, `t2` along the row. With it the grid is a cyclidic net whose rows are
    /// the circles. The normal is `t1 × t2`.
    pub frame: Frame,
    /// Whether the normal points away from the centers of the spheres. It does but where the section runs clockwise.
    pub is_outward: bool,
    /// Circles, spheres, and what was found about them.
    pub strip: CircleStrip,
    /// The largest distance of the second curve from a circle where it crosses the circle's plane.
    pub deviation: f64,
}

/// Fits a canal surface to two curves: `guide`, which becomes a line of curvature, and `curve`, which its spheres touch.
///
/// # Errors
/// As [`Guide::along`], [`NearestOnCurve::new`], [`CircleStrip::new`], [`Section::samples`] and [`mesh`].
pub fn fit(guide: &dyn Curve, curve: &dyn Curve, options: &FitOptions) -> Result<Fit> {
    let guide = Guide::along(guide, options.circle_count, options.spacing)?;
    fit_guide(&guide, &NearestOnCurve::new(curve)?, options)
}

/// The same along a guide of given points and tangents; the number of circles and their spacing are those of the guide.
///
/// # Errors
/// As [`fit`].
pub fn fit_guide(guide: &Guide, curve: &NearestOnCurve<'_>, options: &FitOptions) -> Result<Fit> {
    let strip = CircleStrip::new(guide, options.orientation, curve)?;
    // Where the second curve does not reach the plane of the first circle, the sphere next to it tells where it is.
    let nearby = strip.spheres.touching[0].foot.point;
    let target = strip.crossings[0].map_or(nearby, |crossing| crossing.point);
    let start = guide.points()[0];
    let samples = options.section.samples(&strip.circles[0], start, options.column_count, Some(target))?;
    let grid = mesh(&strip.circles, guide.points(), &samples.points, samples.is_whole)?;
    // Along the circle to where the row starts, then in the sense of the row.
    let frame = strip.frames[0];
    let frame =
        if samples.points[0] == start { frame } else { frame.across(samples.points[0] - start, Direction::Two) };
    let frame = if samples.is_reversed { Frame { t2: -frame.t2, normal: -frame.normal, ..frame } } else { frame };
    Ok(Fit { grid, frame, is_outward: !samples.is_reversed, deviation: strip.deviation(), strip })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::error::Status;
    use crate::geometry::canal::circle_strip::tests::free_form;
    use crate::geometry::canal::circles::tests::gaps;
    use crate::geometry::canal::frame::frames;
    use crate::geometry::canal::two_curves::Findings;
    use crate::geometry::canal::two_curves::tests::{TORUS, on_torus, parallel, wave};
    use crate::geometry::random::Random;
    use crate::mesh::curve::{FnCurve, Spline};

    fn options(circle_count: usize, column_count: usize, section: Section) -> FitOptions {
        let orientation = Orientation::Angle(-0.8);
        FitOptions { circle_count, column_count, section, orientation, spacing: Spacing::ArcLength }
    }

    const TO_CURVE: Section = Section::ToCurve { is_long_way: false };

    #[test]
    fn the_grid_of_two_free_curves_is_circular_and_its_rows_are_circles_of_the_cyclidic_net() {
        let [first, second] = free_form(12);
        let sections = [
            Section::Whole,
            TO_CURVE,
            Section::ToCurve { is_long_way: true },
            Section::Angles { from_rad: 0.4, to_rad: -1.0 },
            Section::Above { point: DVec3::new(0.0, 0.0, 0.4), normal: DVec3::Z },
        ];
        for section in sections {
            let fit = fit(&first, &second, &options(64, 17, section)).unwrap();
            let [planarity, circularity] = gaps(&fit.grid);
            assert!(planarity < 1e-12 && circularity < 1e-12, "{section:?}: {planarity:e} {circularity:e}");
            assert_eq!(
                (fit.grid.rows(), fit.grid.columns(), fit.grid.wraps()),
                (64, 17, [false, section == Section::Whole])
            );
            assert!(fit.strip.spheres.residual < 1e-24 && fit.deviation < 2e-3);
            if matches!(section, Section::Whole | Section::ToCurve { .. }) {
                let guide = NearestOnCurve::new(&first).unwrap();
                assert!(fit.grid.column(0).into_iter().all(|point| guide.nearest(point).distance < 1e-14));
            }
            // The frame at (0, 0) handed on over the grid keeps to the circles.
            let net = frames(&fit.grid, fit.frame).unwrap();
            for (i, circle) in fit.strip.circles.iter().enumerate() {
                for j in 0..17 {
                    let (frame, tangent) = (net[fit.grid.index(i, j)], circle.tangent_at(fit.grid.at(i, j)));
                    let tangent = if fit.is_outward { tangent } else { -tangent };
                    assert!(frame.t2.distance(tangent) < 1e-8, "{section:?} {i} {j}: {:e}", frame.t2.distance(tangent));
                }
            }
            // It goes along the guide and along the row, and out of the sphere.
            let [down, right] = [fit.grid.at(1, 0), fit.grid.at(0, 1)].map(|point| point - fit.grid.at(0, 0));
            assert!(fit.frame.t1.dot(down) > 0.0 && fit.frame.t2.dot(right) > 0.0);
            let outward = fit.grid.at(0, 0) - fit.strip.spheres.touching[0].sphere.center;
            assert_eq!(fit.frame.normal.dot(outward) > 0.0, fit.is_outward, "{section:?}");
        }
    }

    #[test]
    fn the_last_column_starts_where_the_second_curve_passes_and_stays_by_a_parallel() {
        let level = FnCurve::new([-0.5, 3.0], false, |u| on_torus(u, [2.0, 0.0, 0.0])).unwrap();
        let outward = Orientation::Normal(DVec3::new(0.5_f64.cos(), 0.0, 0.5_f64.sin()));
        let options = FitOptions { orientation: outward, ..options(33, 9, TO_CURVE) };
        let fit = fit(&parallel([0.0, 2.5], false), &level, &options).unwrap();
        let curve = NearestOnCurve::new(&level).unwrap();
        for point in fit.grid.column(8) {
            let apart = curve.nearest(point).distance;
            assert!(apart <= 1.01 * fit.deviation && fit.deviation < 5e-3, "{apart:e} {:e}", fit.deviation);
        }
        // All of it is on the torus but for what is of the second order.
        for point in fit.grid.points() {
            let apart = (point.x.hypot(point.y) - TORUS[0]).hypot(point.z) - TORUS[1];
            assert!(apart.abs() < 5e-3);
        }
    }

    #[test]
    fn a_fit_scales_with_its_curves() {
        let [first, second] = free_form(12);
        let scaled = |curve: &Spline, scale: f64| {
            let points: Vec<DVec3> = curve.knots().iter().map(|&knot| scale * curve.point(knot)).collect();
            Spline::through(&points, false).unwrap()
        };
        let options = options(20, 9, Section::Whole);
        let plain = fit(&first, &second, &options).unwrap();
        for scale in [1e-6, 1e6] {
            let fit = fit(&scaled(&first, scale), &scaled(&second, scale), &options).unwrap();
            for (point, expected) in fit.grid.points().iter().zip(plain.grid.points()) {
                assert!((*point / scale).distance(*expected) < 1e-9, "{scale}");
            }
            assert!((fit.deviation / scale - plain.deviation).abs() < 1e-10);
            assert_eq!(fit.strip.spheres.findings, plain.strip.spheres.findings);
        }
    }

    #[test]
    fn whatever_curves_do_a_fit_is_finite_or_refused() {
        let mut random = Random(12);
        let (mut fitted, mut refused) = (0, 0);
        for case in 0..400 {
            let mut curve = |count: usize, is_closed| {
                let points: Vec<DVec3> = (0..count).map(|_| random.vector()).collect();
                Spline::through(&points, is_closed).unwrap()
            };
            let (first, second) = (curve(3 + case % 5, case % 7 == 0), curve(3 + case % 4, case % 3 == 0));
            let section = [Section::Whole, TO_CURVE, Section::Angles { from_rad: -1.0, to_rad: 2.0 }][case % 3];
            let orientation = Orientation::Angle(random.between(0.0, 6.0));
            let options = FitOptions { orientation, ..options(5 + 20 * (case % 4), 6, section) };
            match fit(&first, &second, &options) {
                Err(error) => {
                    assert!(!error.place().is_empty() && error.status() != Status::InvalidValue, "{case}: {error}");
                    refused += 1;
                }
                Ok(fit) => {
                    fitted += 1;
                    assert!(fit.deviation.is_finite() && fit.strip.spheres.residual.is_finite());
                    assert!(
                        fit.strip.circles.iter().all(|circle| circle.radius.is_finite() && circle.center.is_finite())
                    );
                    // All spheres that nothing is told of touch: so says the functional of those alone.
                    let Findings { pierced, .. } = &fit.strip.spheres.findings;
                    assert!(!pierced.is_empty() || fit.strip.spheres.residual < 1e-16, "{case}");
                }
            }
        }
        assert!(fitted > 50 && refused > 20, "{fitted} {refused}");
    }

    #[test]
    fn explicit_guides_ends_and_refusals() {
        let (first, second) = (parallel([0.0, 2.5], false), wave([0.8, 1.7], false));
        let guide = Guide::along(&first, 20, Spacing::ArcLength).unwrap();
        let curve = NearestOnCurve::new(&second).unwrap();
        let inward = Orientation::Normal(-DVec3::new(0.5_f64.cos(), 0.0, 0.5_f64.sin()));
        let options =
            FitOptions { orientation: inward, ..options(0, 5, Section::Angles { from_rad: 0.0, to_rad: 1.0 }) };
        let fit = fit_guide(&guide, &curve, &options).unwrap();
        assert_eq!(fit.grid.rows(), 20);
        // Second curve from u = 0.8 to 1.7, edges about u = 2.5 (k + ½)/19.
        let beyond = |k: &usize| !(0.8..1.7).contains(&(2.5 * (*k as f64 + 0.5) / 19.0));
        assert_eq!(fit.strip.spheres.findings.ends, (0..19).filter(beyond).collect::<Vec<_>>());
        assert!(fit.strip.crossings[0].is_none() && fit.strip.crossings[9].is_some());
        let refusal = |options: &FitOptions| {
            let error = super::fit(&first, &second, options).unwrap_err();
            (error.status(), error.place().to_string())
        };
        assert_eq!(refusal(&options), (Status::InvalidArgumentLength, "count".into()));
        let short = FitOptions { circle_count: 9, column_count: 1, ..options };
        assert_eq!(refusal(&short), (Status::InvalidArgumentLength, "count".into()));
        let same = super::fit(&first, &first, &FitOptions { circle_count: 9, ..options }).unwrap_err();
        assert_eq!((same.status(), same.place()), (Status::Degenerate, "edges[0]"));
        let line = Spline::through(&[DVec3::ZERO, DVec3::X], false).unwrap();
        let flat = FitOptions { circle_count: 9, orientation: Orientation::Normal(DVec3::X), ..options };
        assert_eq!(super::fit(&line, &second, &flat).unwrap_err().status(), Status::Degenerate);
    }
}
