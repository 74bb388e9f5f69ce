//! Smoother cyclidic strips by moving points along the guide curve and changing lengths and the frame (section 3.3, Fig. 7).
//!
//! A strip with a frame at `P_0` carries a cyclidic net, all of whose edges are arcs. What is minimised, by BFGS, is the sum of
//! their squared curvatures over all edges, along and across (equation 5),
//!
//! ```text
//! F(u, L, λ, θ) = Σ 1/R²,     1/R² = 4 (d² − (d·t)²) / d⁴    for an edge d with the arc's unit tangent t at its start
//! ```
//!
//! over the parameters `u` of the guide's inner points (both ends stay), the lengths `L` of the crossing edges and the angles of
//! the frame. The guide curve is met exactly whatever the parameters. The first crossing edge keeps its direction.
//!
//! Lengths and spacings stay within bounds; without them they drift away. Strips that do not exist or are crossed, and arcs of more
//! than a stated angle, are infeasible. Where the least value is beside them, the gradient does not vanish there: the run ends
//! because `F` hardly falls. The coordinates in which this is done are those of `smoothing_net.rs`.

use std::ops::ControlFlow;

use glam::DVec3;

use super::frame::Frame;
use super::smoothing_net::{Net, State};
use super::strip::{self, Strip};
use crate::error::{Error, Result, Status, finite};
use crate::linalg::bfgs::{self, Found, Objective, Progress, Stop};

/// The part of its value that a run must have gained to be begun again.
const RESTART: f64 = 0.05;

/// What is smoothed.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// The guide curve.
    pub curve: &'a dyn Fn(f64) -> DVec3,
    /// Where on it the guide's points are, `n + 1`, rising or falling.
    pub parameters: &'a [f64],
    /// The strip, whose guide is there; its quads in cyclic order.
    pub strip: &'a Strip,
    /// The frame at the first point of the guide; its first tangent near the guide's.
    pub frame: Frame,
}

impl std::fmt::Debug for Input<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { curve: _, parameters, strip, frame } = self;
        f.debug_struct("Input")
            .field("parameters", parameters)
            .field("strip", strip)
            .field("frame", frame)
            .finish_non_exhaustive()
    }
}

/// A cone on which the normal stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Its axis: a normal of the reference plane.
    pub axis: DVec3,
    /// The angle of the normal to it, 0 to π.
    pub angle_rad: f64,
}

/// Bounds, weights and stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The normal's angle to an axis, if it is given.
    pub cone: Option<Cone>,
    /// Whether the tangents turn about the normal (`ψ`).
    pub turns_tangents: bool,
    /// The most that two spacings of parameters change against each other, 1 (they stay) or more; may be infinite.
    pub spacing_ratio: f64,
    /// The most that a length changes, as a part of its first value, above 0; may be infinite.
    pub length_change: f64,
    /// Weight of `Σ (L/L⁰ − 1)²` beside `D² F`, `D` the diagonal of the strip at the start.
    pub length_weight: f64,
    /// The largest angle from an arc's tangent to its chord, half of the angle that the arc spans; arcs that are near it
    /// or beyond at the start may exceed it by a little.
    pub half_angle_rad: f64,
    /// The most iterations.
    pub max_iterations: usize,
    /// Stop where the largest entry of the gradient is at most this part of the value,
    pub relative_gradient: f64,
    /// or where the value fell by less than this part in five iterations.
    pub relative_decrease: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            cone: None,
            turns_tangents: false,
            spacing_ratio: 4.0,
            length_change: 0.25,
            length_weight: 0.0,
            half_angle_rad: 0.75 * std::f64::consts::PI,
            max_iterations: 200,
            relative_gradient: 1e-6,
            relative_decrease: 1e-4,
        }
    }
}

/// A smoothed strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Where on the curve the guide's points are.
    pub parameters: Vec<f64>,
    /// The strip.
    pub strip: Strip,
    /// The frame at its first point.
    pub frame: Frame,
    /// `F` at the start.
    pub before: f64,
    /// `F` at the end.
    pub after: f64,
    /// What is minimised over `D²`, that is `F`, the barrier and the weight on lengths, at the start, where it is `F`, and after
    /// every iteration: never rising.
    pub history: Vec<f64>,
    /// Why it stopped; cancelled runs have their best so far.
    pub stop: Stop,
}

/// Smooths a strip.
///
/// # Errors
/// Another number of parameters than of points on either side, fewer than 2, what is not finite, parameters that do not rise or fall
/// throughout or where the curve is not at the guide's points, a frame that is none, an option outside its domain. Status
/// `NotCircular`: a quad has no circle; `NoSolution`: it is crossed; `Degenerate`: three corners are on a line, or the cone and the
/// first tangent allow no frame.
pub fn smooth(
    input: &Input<'_>,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Smoothed> {
    let mut net = Net::new(input, options)?;
    let limits = bfgs::Options {
        gradient: 0.0,
        relative_gradient: options.relative_gradient,
        relative_decrease: options.relative_decrease,
        decrease_iterations: 5,
        max_iterations: options.max_iterations,
        first_step: 0.1,
    };
    let before = net.energy_at_start;
    let squared = net.diagonal * net.diagonal;
    let mut found = Found {
        x: vec![0.0; net.unknown_count()],
        history: Vec::new(),
        gradient: 0.0,
        evaluation_count: 0,
        stop: Stop::Iterations,
    };
    // Beside a barrier the approximate Hessian can go stale: a run that ends because values hardly fall begins once more where it
    // is, and goes on as long as that helps.
    loop {
        let done = found.history.len().saturating_sub(1);
        let mut shown = |at: &Progress| {
            let (value, gradient) = (at.value / squared, at.gradient / squared);
            progress(&Progress { iteration: done + at.iteration, value, gradient })
        };
        let limits = bfgs::Options { max_iterations: options.max_iterations - done, ..limits };
        let next = bfgs::minimise(&mut net, &found.x, &limits, &mut shown);
        let (first, last) = (next.history[0], next.history[next.history.len() - 1]);
        found.x = next.x;
        found.stop = next.stop;
        found.history.pop();
        found.history.extend(next.history);
        if next.stop != Stop::Decrease || first - last < RESTART * first {
            break;
        }
    }
    net.value(&found.x);
    let at = net.at.clone();
    if found.stop == Stop::Infeasible || at.states.len() < at.points.len() {
        let reason = "the strip at the start is at the border of what is feasible";
        return Err(Error::new(Status::NoSolution, reason).at("strip"));
    }
    let border = at.states.iter().map(|state| state.border).collect();
    let strip = strip::of_borders(at.points, border).map_err(|error| error.with_place("strip"))?;
    let frame = net.orientation.frame(&at.angles).unwrap_or(input.frame);
    let after = at.states[at.states.len() - 1].energy;
    let history = found.history.iter().map(|value| value / squared).collect();
    Ok(Smoothed { parameters: at.parameters, strip, frame, before, after, history, stop: found.stop })
}

/// `F` of a strip with a frame at its first point, in one over squared model units.
///
/// # Errors
/// The frame is none, the strip has no points, or consecutive points or both ends of a crossing edge coincide.
pub fn energy(strip: &Strip, frame: &Frame) -> Result<f64> {
    frame.check("frame")?;
    let mut edges = strip.guide.iter().zip(&strip.border);
    let first = edges.next().map(|(&p, &q)| State::first(p, q, frame));
    let last = first.map(|first| edges.fold(first, |state, (&p, &q)| state.next(p, q).0));
    match last {
        Some(state) if state.energy.is_finite() => Ok(state.energy),
        _ => Err(Error::new(Status::Degenerate, "it has no points, or an edge without length").at("strip")),
    }
}

pub(super) fn check(input: &Input<'_>, options: &Options) -> Result<()> {
    let parameters = input.parameters;
    if parameters.len() < 2 {
        let reason = format!("expected at least 2, found {}", parameters.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("parameters"));
    }
    super::combescure::check_count("parameters", parameters, parameters.len())?;
    let Strip { guide, border, .. } = input.strip;
    if guide.len() != parameters.len() || border.len() != parameters.len() {
        let (count, found) = (parameters.len(), (guide.len(), border.len()));
        let reason =
            format!("expected {count} points on either side, as many as parameters, found {} and {}", found.0, found.1);
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("strip"));
    }
    crate::mesh::grid::check_finite("strip.guide", guide)?;
    crate::mesh::grid::check_finite("strip.border", border)?;
    let is_rising = parameters[1] > parameters[0];
    let in_order = |pair: &[f64]| if is_rising { pair[1] > pair[0] } else { pair[1] < pair[0] };
    if let Some(k) = parameters.windows(2).position(|pair| !in_order(pair)) {
        let reason = format!("expected parameters that rise or fall throughout, found {}", parameters[k + 1]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("parameters[{}]", k + 1)));
    }
    input.frame.check("frame")?;
    let within = |name: &str, value: f64, is_fine: bool, expected: &str| {
        let reason = || format!("expected {expected}, found {value}");
        if is_fine { Ok(()) } else { Err(Error::new(Status::InvalidValue, reason()).at(name)) }
    };
    let Options { spacing_ratio, length_change, length_weight, half_angle_rad, .. } = *options;
    within("spacing_ratio", spacing_ratio, spacing_ratio >= 1.0, "1 or more")?;
    within("length_change", length_change, length_change > 0.0, "a number above 0")?;
    let is_weight = (0.0..f64::INFINITY).contains(&length_weight);
    within("length_weight", length_weight, is_weight, "0 or more")?;
    let is_angle = half_angle_rad > 0.0 && half_angle_rad <= std::f64::consts::PI;
    within("half_angle_rad", half_angle_rad, is_angle, "above 0 up to π")?;
    within("relative_gradient", options.relative_gradient, options.relative_gradient >= 0.0, "0 or more")?;
    within("relative_decrease", options.relative_decrease, options.relative_decrease >= 0.0, "0 or more")?;
    if let Some(cone) = options.cone {
        finite("cone.angle_rad", cone.angle_rad)?;
        crate::mesh::grid::check_finite("cone.axis", &[cone.axis]).map_err(|error| error.with_place("cone.axis"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::frame;
    use crate::geometry::canal::strip::tests::misfit;
    use crate::geometry::canal::strip::{of_border_edges, of_lengths};
    use crate::geometry::circle::Arc;
    use crate::geometry::random::Random;

    fn wave(u: f64) -> DVec3 {
        DVec3::new(4.0 * u, (2.5 * u).sin(), 0.3 * u * u)
    }

    /// A strip of sixteen circles with border edges that vary at random, and a frame whose crossing arcs rise from it.
    fn rough(curve: &dyn Fn(f64) -> DVec3) -> (Vec<f64>, Strip, Frame) {
        let mut random = Random(77);
        let parameters: Vec<f64> = (0..=16).map(|k| 2.0 * f64::from(k) / 16.0).collect();
        let points: Vec<DVec3> = parameters.iter().map(|&u| curve(u)).collect();
        let tangent = (curve(1e-6) - points[0]).normalize();
        let start = points[0] + 1.5 * DVec3::Z.cross(tangent).normalize();
        let even = strip::Options { fits_start: true, ..Default::default() };
        let even = of_lengths(&points, start, &[1.5; 17], &even).unwrap();
        let edges: Vec<f64> =
            even.border.windows(2).map(|pair| pair[0].distance(pair[1]) * random.between(0.7, 1.3)).collect();
        let start = even.border[0];
        let strip = of_border_edges(&points, start, &edges).unwrap();
        let frame = Frame::of_tangent_one(tangent, DVec3::Z + (points[0] - start).normalize()).unwrap();
        (parameters, strip, frame)
    }

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn smoothed(options: &Options) -> (Smoothed, Strip, Frame) {
        let (parameters, strip, frame) = rough(&wave);
        let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
        (smooth(&input, options, &mut on).unwrap(), strip, frame)
    }

    /// The sum over all edges of the grid with frames at all points, by the arcs themselves.
    fn energy_of_arcs(strip: &Strip, first: Frame) -> f64 {
        let grid = strip.grid().unwrap();
        let frames = frame::frames(&grid, first).unwrap();
        let curvature = |from: (usize, usize), to: (usize, usize), along: bool| {
            let frame = frames[grid.index(from.0, from.1)];
            let tangent = if along { frame.t1 } else { frame.t2 };
            Arc { start: grid.at(from.0, from.1), tangent, end: grid.at(to.0, to.1) }.curvature().length_squared()
        };
        let n = grid.rows();
        let along = (0..n - 1).flat_map(|i| [0, 1].map(|j| curvature((i, j), (i + 1, j), true)));
        along.sum::<f64>() + (0..n).map(|i| curvature((i, 0), (i, 1), false)).sum::<f64>()
    }

    #[test]
    fn a_rough_strip_becomes_smoother_and_stays_on_its_curve() {
        let options = Options::default();
        let (found, strip, frame) = smoothed(&options);
        assert!(found.history.windows(2).all(|pair| pair[1] <= pair[0]) && found.history.len() > 10);
        assert!((found.history[0] / found.before - 1.0).abs() < 1e-9);
        assert!(found.after < 0.1 * found.before, "{} {}", found.after, found.before);
        assert!(matches!(found.stop, Stop::Decrease | Stop::Iterations) && found.history.len() <= 201);
        let (long, ..) = smoothed(&Options { max_iterations: 5000, ..options });
        assert!(long.stop == Stop::Decrease && long.after <= found.after);
        let (short, ..) = smoothed(&Options { max_iterations: 10, ..options });
        assert_eq!((short.stop, short.history.len()), (Stop::Iterations, 11));
        // By the arcs of the net, whose frames come back around every quad.
        assert!((energy_of_arcs(&strip, frame) / found.before - 1.0).abs() < 1e-9);
        assert!((energy_of_arcs(&found.strip, found.frame) / found.after - 1.0).abs() < 1e-9);
        assert!((energy(&found.strip, &found.frame).unwrap() / found.after - 1.0).abs() < 1e-12);
        for (point, &u) in found.strip.guide.iter().zip(&found.parameters) {
            assert!(point.distance(wave(u)) < 1e-12);
        }
        assert_eq!((found.strip.guide[0], found.strip.guide[16]), (strip.guide[0], strip.guide[16]));
        assert!(misfit(&found.strip).0 < 1e-11 && misfit(&found.strip).1 == 0);
        // The bounds.
        let spacings: Vec<f64> = found.parameters.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (low, high) = spacings.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &s| (l.min(s), h.max(s)));
        assert!(low > 0.0 && high / low <= 4.0 + 1e-9);
        let changes = found.strip.lengths.iter().zip(&strip.lengths).map(|(now, then)| (now / then - 1.0).abs());
        let largest = changes.fold(0.0, f64::max);
        assert!(largest > 0.1 && largest <= 0.25);
    }

    #[test]
    fn straight_edges_cost_nothing_and_are_found() {
        let line = |u: f64| 4.0 * u * DVec3::X;
        let (parameters, strip, _) = rough(&line);
        // Straight up to the crossing edges, then tilted.
        let flat = Frame::of_tangent_one(DVec3::X, DVec3::Z).unwrap();
        let bulging = Frame::of_tangent_one(DVec3::new(1.0, 0.1, 0.0), DVec3::new(0.0, -0.4, 1.0)).unwrap();
        assert!(energy(&strip, &flat).unwrap() < energy(&strip, &bulging).unwrap());
        let input = Input { curve: &line, parameters: &parameters, strip: &strip, frame: bulging };
        let options = Options { turns_tangents: true, relative_decrease: 0.0, ..Options::default() };
        let found = smooth(&input, &options, &mut on).unwrap();
        assert!(found.after < 1e-3 * found.before, "{} {} {:?}", found.after, found.before, found.stop);
        assert!(found.frame.normal.cross(DVec3::Z).length() < 0.05);
    }

    #[test]
    fn the_gradient_that_goes_on_from_points_is_that_of_the_whole() {
        let (parameters, strip, frame) = rough(&wave);
        let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
        let cone = Cone { axis: 2.0 * DVec3::Z, angle_rad: 0.9 };
        for options in [
            Options { turns_tangents: true, length_weight: 3.0, ..Options::default() },
            Options { cone: Some(cone), ..Options::default() },
        ] {
            let mut net = Net::new(&input, &options).unwrap();
            let mut random = Random(5);
            let x: Vec<f64> = (0..net.unknown_count()).map(|_| random.between(-0.02, 0.02)).collect();
            let value = net.value(&x);
            assert!(value.is_finite());
            let (mut found, mut whole) = (vec![0.0; x.len()], vec![0.0; x.len()]);
            net.gradient(&x, value, &mut found);
            bfgs::central_differences(&mut |x| net.value(x), &x, value, &vec![1.0; x.len()], &mut whole);
            let scale = whole.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
            assert!(found.iter().zip(&whole).all(|(found, whole)| (found - whole).abs() < 1e-6 * scale));
        }
    }

    #[test]
    fn a_cone_a_weight_and_a_request_to_stop_are_kept() {
        let cone = Cone { axis: 2.0 * DVec3::Z, angle_rad: 0.7 };
        let (found, ..) = smoothed(&Options { cone: Some(cone), ..Options::default() });
        assert!((found.frame.normal.angle_between(DVec3::Z) - 0.7).abs() < 1e-12);
        assert!(found.after < found.before && found.history.windows(2).all(|pair| pair[1] <= pair[0]));
        let change = |found: &Smoothed, strip: &Strip| {
            let changes = found.strip.lengths.iter().zip(&strip.lengths).map(|(now, then)| (now / then - 1.0).powi(2));
            changes.sum::<f64>()
        };
        let (free, strip, _) = smoothed(&Options::default());
        let (held, ..) = smoothed(&Options { length_weight: 1e4, ..Options::default() });
        assert!(change(&held, &strip) < 0.1 * change(&free, &strip) && held.after < held.before);
        let (unbound, ..) =
            smoothed(&Options { length_change: f64::INFINITY, spacing_ratio: f64::INFINITY, ..Options::default() });
        assert!(unbound.after < free.after);
        let (parameters, strip, frame) = rough(&wave);
        let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
        let mut stop =
            |at: &Progress| if at.iteration == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let found = smooth(&input, &Options::default(), &mut stop).unwrap();
        assert_eq!((found.stop, found.history.len()), (Stop::Cancelled, 4));
        assert!(found.after < found.before);
    }

    #[test]
    fn input_that_cannot_be_smoothed_is_named() {
        let (parameters, strip, frame) = rough(&wave);
        let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
        let refusal = |input: &Input<'_>, options: Options| {
            let error = smooth(input, &options, &mut on).unwrap_err();
            (error.status(), error.place().to_string())
        };
        let case = |status, place: &str| (status, place.to_string());
        let options = Options::default();
        let mut disordered = parameters.clone();
        disordered.swap(4, 5);
        let value = Status::InvalidValue;
        assert_eq!(refusal(&Input { parameters: &disordered, ..input }, options), case(value, "parameters[5]"));
        let short = case(Status::InvalidArgumentLength, "parameters");
        assert_eq!(refusal(&Input { parameters: &parameters[..1], ..input }, options), short);
        let broken = |u: f64| if u > 1.9 { DVec3::NAN } else { wave(u) };
        assert_eq!(refusal(&Input { curve: &broken, ..input }, options), case(value, "parameters[16]"));
        let mirrored = Frame { t1: -frame.t1, ..frame };
        assert_eq!(refusal(&Input { frame: mirrored, ..input }, options), case(value, "frame"));
        let changed = |change: &dyn Fn(&mut Strip)| {
            let mut strip = strip.clone();
            change(&mut strip);
            refusal(&Input { strip: &strip, ..input }, options)
        };
        assert_eq!(changed(&|s| s.border[8] *= 1.01), case(Status::NotCircular, "strip: quad 7"));
        assert_eq!(changed(&|s| s.border[16] = s.border[15]), case(Status::NoSolution, "strip: quad 15"));
        assert_eq!(changed(&|s| s.guide[3].z += 1e-3), case(value, "parameters[3]"));
        assert_eq!(changed(&|s| s.border[3].z = f64::NAN), case(value, "strip.border[3]"));
        assert_eq!(changed(&|s| s.border.truncate(5)), case(Status::InvalidArgumentLength, "strip"));
        for (bad, place) in [
            (Options { spacing_ratio: 0.5, ..options }, "spacing_ratio"),
            (Options { length_change: 0.0, ..options }, "length_change"),
            (Options { length_weight: f64::NAN, ..options }, "length_weight"),
            (Options { half_angle_rad: 4.0, ..options }, "half_angle_rad"),
            (Options { cone: Some(Cone { axis: DVec3::ZERO, angle_rad: 1.0 }), ..options }, "cone.axis"),
            (Options { cone: Some(Cone { axis: DVec3::Z, angle_rad: f64::NAN }), ..options }, "cone.angle_rad"),
        ] {
            assert_eq!(refusal(&input, bad), case(value, place));
        }
        let along = Cone { axis: frame.t1, angle_rad: 0.0 };
        assert_eq!(refusal(&input, Options { cone: Some(along), ..options }), case(Status::Degenerate, "cone"));
    }
}
