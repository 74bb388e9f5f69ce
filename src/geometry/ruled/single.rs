//! One strip between two curves, general or conoidal (Flöry et al. 2012, Fig. 12).

use std::ops::ControlFlow;

use glam::DVec3;

use super::conditions::Condition;
use super::layout::Joints;
use super::optimise::{Optimised, Options, Progress, Task, optimise};
use super::start::{Rulings, StartOptions, start};
use super::{Axis, Strip};
use crate::error::{Error, Result, Status};
use crate::mesh::reference::ReferenceSurface;

/// Rulings in each span of which the axis is found.
const RULINGS_PER_SPAN: usize = 4;

/// How a strip is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleOptions {
    /// Control points of each boundary, at least 4.
    pub control_count: usize,
    /// Whether all rulings are to be orthogonal to the axis of those at the start.
    pub is_conoidal: bool,
    /// Whether the ends of open boundaries stay where they were drawn: of a conoidal strip those of the first one, since end
    /// rulings are not orthogonal to the axis at the start.
    pub has_fixed_ends: bool,
    /// How it is optimised. What the strip is to cover is for the caller to say; without it a proximal weight holds it.
    pub optimise: Options,
}

impl Default for SingleOptions {
    fn default() -> Self {
        Self { control_count: 12, is_conoidal: false, has_fixed_ends: true, optimise: Options::default() }
    }
}

/// A strip between two curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Single {
    /// The strip at the start.
    pub start: Strip,
    /// The optimised strip and how it was found.
    pub found: Optimised,
    /// The unit vector to which the rulings at the start are most nearly orthogonal.
    pub axis: DVec3,
    /// The root mean square of the angles of rulings to the planes across the axis, at the start and of the optimised strip.
    pub tilt_rad: [f64; 2],
}

impl Single {
    /// The optimised strip.
    pub fn strip(&self) -> &Strip {
        // One went in.
        &self.found.strips[0]
    }
}

/// The strip between two polylines that is nearest to the reference surface. Rulings start as [`start`] says.
///
/// # Errors
/// As [`start`] and [`optimise`], with the places that they say; boundaries 0 and 1 are `first` and `second`.
pub fn single(
    [first, second]: [&[DVec3]; 2],
    is_closed: bool,
    rulings: Rulings<'_>,
    (reference, cover): (&dyn ReferenceSurface, &[DVec3]),
    options: &SingleOptions,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Single> {
    let start_options = StartOptions { control_count: options.control_count, is_shared: false };
    let boundaries = [first.to_vec(), second.to_vec()];
    let started = start(&boundaries, &[is_closed; 2], rulings, start_options).map_err(|error| {
        let place = error.place().replace("boundaries[0]", "first").replace("boundaries[1]", "second");
        error.with_place(place)
    })?;
    let axis = axis(&started.strips[0])?;
    let is_kept = |condition: &Condition| match condition {
        Condition::FixedEnd { side, .. } => options.has_fixed_ends && !(options.is_conoidal && *side == 1),
        _ => true,
    };
    let mut conditions: Vec<Condition> = Condition::fixed_ends(&started.strips).into_iter().filter(is_kept).collect();
    if options.is_conoidal {
        conditions.push(Condition::Conoidal { strip: 0, axis });
    }
    let joints = Joints::default();
    let task = Task { strips: &started.strips, joints: &joints, reference, cover, conditions: &conditions };
    let found = optimise(task, &options.optimise, progress)?;
    let tilt_rad = [tilt(&started.strips[0], axis), tilt(&found.strips[0], axis)];
    let start = started.strips[0].clone();
    Ok(Single { start, found, axis, tilt_rad })
}

/// The unit vectors of rulings; of those that have a length.
fn directions(strip: &Strip) -> Vec<DVec3> {
    let count = RULINGS_PER_SPAN * strip.basis().spans() + 1;
    strip.rulings(count).iter().filter_map(|[a, b]| (*b - *a).try_normalize()).collect()
}

/// The unit vector to which the rulings of a strip are most nearly orthogonal: for which the sum of `(r·w)²` is least. Of parallel
/// rulings any that is orthogonal to them.
///
/// # Errors
/// Status `Degenerate`: no ruling has a length; the place is `strip`.
pub fn axis(strip: &Strip) -> Result<DVec3> {
    let none = || Error::new(Status::Degenerate, "expected rulings of a length above 0").at("strip");
    Axis::new(&directions(strip)).map(|axis| axis.direction).ok_or_else(none)
}

/// The root mean square of the angles, in radians, of the rulings of a strip to the planes across a unit axis; 0 where none has a
/// length.
pub fn tilt(strip: &Strip, axis: DVec3) -> f64 {
    let directions = directions(strip);
    let angle = |r: &DVec3| r.dot(axis).clamp(-1.0, 1.0).asin();
    (directions.iter().map(|r| angle(r).powi(2)).sum::<f64>() / directions.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::coverage::NearestStrip;
    use crate::mesh::reference::{ParametricSurface, SurfaceJet};

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// The conoid (s cos φ, s sin φ, t) with φ = t + 0.3 sin t, a little bent: with z lifted by c s (s − 1) (s − 2).
    fn conoid(c: f64) -> ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync> {
        let jet = move |t: f64, s: f64| {
            let (phi, d, dd) = (t + 0.3 * t.sin(), 1.0 + 0.3 * t.cos(), -0.3 * t.sin());
            let (e, f) = (DVec3::new(phi.cos(), phi.sin(), 0.0), DVec3::new(-phi.sin(), phi.cos(), 0.0));
            let lift = [c * s * (s - 1.0) * (s - 2.0), c * (3.0 * s * s - 6.0 * s + 2.0), c * (6.0 * s - 6.0)];
            SurfaceJet {
                point: s * e + (t + lift[0]) * DVec3::Z,
                first: [s * d * f + DVec3::Z, e + lift[1] * DVec3::Z],
                second: [s * (dd * f - d * d * e), d * f, lift[2] * DVec3::Z],
            }
        };
        ParametricSurface::new([[0.0, 2.0], [1.0, 2.0]], [41, 21], jet).unwrap()
    }

    fn curve<F: Fn(f64, f64) -> SurfaceJet + Sync>(surface: &ParametricSurface<F>, s: f64) -> Vec<DVec3> {
        (0..=4000).map(|i| surface.at(f64::from(i) / 2000.0, s).point).collect()
    }

    #[test]
    fn a_conoid_is_one_conoidal_strip() {
        let surface = conoid(0.0);
        let (first, second) = (curve(&surface, 1.0), curve(&surface, 2.0));
        let cover = surface.mesh(41, 9).unwrap().points;
        let across = |_: usize, p: DVec3| Some(DVec3::new(2.0 * p.x, 2.0 * p.y, p.z));
        let options = SingleOptions { control_count: 13, is_conoidal: true, ..SingleOptions::default() };
        let found =
            single([&first, &second], false, Rulings::Traced(&across), (&surface, &cover), &options, &mut on).unwrap();
        assert!(found.axis.abs_diff_eq(DVec3::Z, 1e-6) || found.axis.abs_diff_eq(-DVec3::Z, 1e-6), "{}", found.axis);
        let strip = found.strip();
        for i in 0..13 {
            let ruling = strip.control(1)[i] - strip.control(0)[i];
            assert!(ruling.dot(found.axis).abs() <= 1e-10);
        }
        assert!(found.tilt_rad[1] <= 1e-10 && found.tilt_rad[0] < 1e-4, "{:?}", found.tilt_rad);
        let there = |p: &DVec3| {
            let foot = surface.nearest(*p);
            foot.normal.dot(*p - foot.point).abs()
        };
        let deviation = strip.mesh(201, 9).unwrap().points.iter().map(there).fold(0.0, f64::max);
        let back = NearestStrip::new(std::slice::from_ref(strip)).unwrap();
        let back = cover.iter().map(|p| back.nearest(*p).point.distance(*p)).fold(0.0, f64::max);
        let size = surface.diagonal();
        assert!(deviation <= 1e-5 * size && back <= 1e-5 * size, "{deviation} {back} {size}");
    }

    #[test]
    fn the_conoid_condition_costs_what_the_surface_is_not() {
        let surface = conoid(0.15);
        let (first, second) = (curve(&surface, 1.0), curve(&surface, 1.6));
        let place = |i: u32| surface.at(0.05 * f64::from(i % 41), 1.0 + 0.1 * f64::from(i / 41)).point;
        let cover: Vec<DVec3> = (0..41 * 7).map(place).collect();
        let find = |is_conoidal, has_fixed_ends| {
            let options = SingleOptions { is_conoidal, has_fixed_ends, ..SingleOptions::default() };
            let rulings = Rulings::Proportional;
            single([&first, &second], false, rulings, (&surface, &cover), &options, &mut on).unwrap()
        };
        let (general, conoidal) = (find(false, false), find(true, false));
        assert!(
            conoidal.tilt_rad[1] < 1e-10 && general.tilt_rad[1] > 1e-3,
            "{:?} {:?}",
            conoidal.tilt_rad,
            general.tilt_rad
        );
        assert_eq!((general.axis, general.tilt_rad[0]), (conoidal.axis, conoidal.tilt_rad[0]));
        let [free, bound] = [&general, &conoidal].map(|found| found.found.last().parts.proximity);
        assert!(free < bound, "{free} {bound}");
        // Neither shrinks away from the drawn curves.
        for found in [&general, &conoidal] {
            assert!(found.strip().area() > 0.8 * found.start.area());
        }
        // Ends stay where they were drawn.
        let (general, conoidal) = (find(false, true), find(true, true));
        assert!(general.strip().control(1)[11].distance(second[4000]) < 1e-14);
        assert!(conoidal.strip().control(0)[0].distance(first[0]) < 1e-14);
    }

    #[test]
    fn bad_curves_are_named() {
        let surface = conoid(0.0);
        let (first, second) = (curve(&surface, 1.0), curve(&surface, 2.0));
        let place = |first: &[DVec3], second: &[DVec3], options: &SingleOptions| {
            let found = single([first, second], false, Rulings::Proportional, (&surface, &[]), options, &mut on);
            found.unwrap_err().place().to_owned()
        };
        let options = SingleOptions::default();
        assert_eq!(place(&first, &second[..1], &options), "second");
        assert_eq!(place(&[DVec3::NAN, DVec3::X], &second, &options), "first[0]");
        let mut few = options;
        few.control_count = 3;
        assert_eq!(place(&first, &second, &few), "options.control_count");
        let mut weights = options;
        weights.optimise.weights.gap = -1.0;
        assert_eq!(place(&first, &second, &weights), "options.weights.gap");
    }
}
