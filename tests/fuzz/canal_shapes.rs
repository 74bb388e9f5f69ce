//! What makes shapes from curves and nets: two-curve fits, C-canal surfaces, smoothing of strips, and parts (panels, node axes,
//! beams). Input is good, or spoilt: numbers that are huge, tiny or not finite, points that repeat or are on a line, lists that are too
//! short or too long. Nothing panics, every number of what is returned is finite, and a refusal names one of the arguments.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::fmt::Debug;
use std::ops::ControlFlow;

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use shapeop::error::Result;
use shapeop::geometry::canal::c_canal::{CCanal, Target, c_canal};
use shapeop::geometry::canal::circles::{self, Section};
use shapeop::geometry::canal::file::PartsForm;
use shapeop::geometry::canal::fit::{FitOptions, fit, fit_guide};
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::node_axes::NodeAxes;
use shapeop::geometry::canal::normals::{Guide, Orientation, reflected_frames, rotation_minimising};
use shapeop::geometry::canal::panels::{beams, offset, panels};
use shapeop::geometry::canal::smoothing::{self, Cone, Input, smooth};
use shapeop::geometry::canal::strip::{Strip, of_border_edges};
use shapeop::geometry::canal::two_curves::{characteristic_circles, spheres_at_points};
use shapeop::geometry::circle::{Circle, Sphere};
use shapeop::mesh::Grid;
use shapeop::mesh::curve::{Curve, NearestOnCurve, Spacing, Spline};

use super::canal::number;

/// Cases of the ordinary run, of each of the four.
const CASES: u32 = 3_000;

type Checked<T> = std::result::Result<T, TestCaseError>;

/// What is done to good input.
#[derive(Clone, Debug)]
enum Spoil {
    /// One coordinate becomes another number.
    Number(usize, f64),
    /// A point becomes another one of the list.
    Repeat(usize, usize),
    /// All points are moved to a line: none, if there is no first edge.
    Line,
    /// All points are moved to a plane.
    Flat,
    Scale(f64),
    Move(f64),
    Cut(usize),
    Longer,
    Random(Vec<f64>),
}

fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![2 => number(), 1 => prop_oneof![Just(1e150), Just(-1e160), Just(1e-160), Just(1e15), Just(1e-9)]]
}

fn spoil() -> impl Strategy<Value = Spoil> {
    prop_oneof![
        6 => (any::<usize>(), extreme()).prop_map(|(at, value)| Spoil::Number(at, value)),
        2 => (any::<usize>(), any::<usize>()).prop_map(|(to, from)| Spoil::Repeat(to, from)),
        1 => Just(Spoil::Line),
        1 => Just(Spoil::Flat),
        2 => extreme().prop_map(Spoil::Scale),
        1 => extreme().prop_map(Spoil::Move),
        1 => (0..4_usize).prop_map(Spoil::Cut),
        1 => Just(Spoil::Longer),
        1 => proptest::collection::vec(number(), 0..24).prop_map(Spoil::Random),
    ]
}

/// A case: up to two lists of the input are spoilt, and numbers and choices for the rest.
#[derive(Clone, Debug)]
struct Case {
    spoils: Vec<(usize, Spoil)>,
    numbers: [f64; 8],
    choices: [usize; 6],
}

fn case() -> impl Strategy<Value = Case> {
    let numbers = [(); 8].map(|()| prop_oneof![3 => 0.1..1.5_f64, 1 => extreme()]);
    let choices = [(); 6].map(|()| any::<usize>());
    (proptest::collection::vec((any::<usize>(), spoil()), 0..3), numbers, choices)
        .prop_map(|(spoils, numbers, choices)| Case { spoils, numbers, choices })
}

impl Case {
    /// The lists, of which some are spoilt.
    fn spoilt<const N: usize>(&self, mut lists: [Vec<DVec3>; N]) -> [Vec<DVec3>; N] {
        for (which, spoil) in &self.spoils {
            let list = &mut lists[which % N];
            let count = list.len().max(1);
            match spoil {
                Spoil::Number(at, value) => {
                    if let Some(point) = list.get_mut(at % count) {
                        point[at / count % 3] = *value;
                    }
                }
                Spoil::Repeat(to, from) => {
                    if let Some(&point) = list.get(from % count) {
                        list[to % count] = point;
                    }
                }
                Spoil::Line => {
                    if let [first, second, ..] = list[..] {
                        let along = (second - first).normalize_or_zero();
                        list.iter_mut().for_each(|point| *point = first + (*point - first).dot(along) * along);
                    }
                }
                Spoil::Flat => list.iter_mut().for_each(|point| point.z = 0.0),
                Spoil::Scale(factor) => list.iter_mut().for_each(|point| *point *= *factor),
                Spoil::Move(shift) => list.iter_mut().for_each(|point| *point += *shift),
                Spoil::Cut(length) => list.truncate(*length),
                Spoil::Longer => list.extend(list.last().map(|&last| last + DVec3::ONE)),
                Spoil::Random(numbers) => *list = numbers.chunks_exact(3).map(DVec3::from_slice).collect(),
            }
        }
        lists
    }

    fn flag(&self, which: usize) -> bool {
        self.choices[which].is_multiple_of(4)
    }

    fn vector(&self, from: usize) -> DVec3 {
        DVec3::new(self.numbers[from], self.numbers[from + 1], self.numbers[from + 2])
    }
}

/// Passes on what was returned; `None` where it was refused.
///
/// All that there is of a value is in its debug form: a field added later is looked at too.
fn checked<T: Debug>(what: &str, found: Result<T>, arguments: &[&str]) -> Checked<Option<T>> {
    match found {
        Ok(value) => {
            let shown = format!("{value:?}");
            let is_bad = |word: &str| matches!(word, "NaN" | "inf");
            if shown.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').any(is_bad) {
                return Err(TestCaseError::fail(format!("{what} returned {shown}")));
            }
            Ok(Some(value))
        }
        Err(error) => {
            let place = error.place();
            let name = place.split(['[', '.', ':']).next().unwrap_or_default();
            if arguments.contains(&name) && error.to_string().len() > place.len() + 2 {
                return Ok(None);
            }
            Err(TestCaseError::fail(format!("{what}, of {arguments:?}, was refused with {error:?}")))
        }
    }
}

fn wave(count: usize, across: f64, up: f64) -> Vec<DVec3> {
    let point = |k: usize| {
        let s = k as f64 / count as f64;
        DVec3::new(3.0 * s, across + 0.3 * (4.0 * s).sin(), up + 0.2 * (3.0 * s + up).cos())
    };
    (0..count).map(point).collect()
}

/// A size up to `most`.
fn size(choice: usize, most: usize) -> usize {
    choice % (most + 1)
}

fn two_curves(case: &Case) -> Checked<bool> {
    let [first, second] = case.spoilt([wave(6, 0.0, 0.0), wave(7, 1.2, 0.5)]);
    let spline = |points: &[DVec3], is_closed| checked("spline", Spline::through(points, is_closed), &["points"]);
    let (Some(guide), Some(curve)) = (spline(&first, case.flag(0))?, spline(&second, case.flag(1))?) else {
        return Ok(false);
    };
    let orientation =
        if case.flag(2) { Orientation::Normal(case.vector(0)) } else { Orientation::Angle(case.numbers[0]) };
    let section = match case.choices[3] % 6 {
        0 | 1 => Section::Whole,
        2 => Section::Angles { from_rad: case.numbers[1], to_rad: -case.numbers[2] },
        3 => Section::Above { point: case.vector(3), normal: case.vector(5) },
        _ => Section::ToCurve { is_long_way: case.flag(4) },
    };
    let spacing = if case.flag(5) { Spacing::Parameter } else { Spacing::ArcLength };
    let column_count = size(case.choices[4], 8);
    let options = FitOptions { circle_count: size(case.choices[5], 12), spacing, column_count, orientation, section };
    // Arguments, fields of the options, and places that their documentation names.
    let arguments = [
        "guide",
        "curve",
        "count",
        "columns",
        "circle_count",
        "column_count",
        "orientation",
        "points",
        "tangents",
        "normals",
        "normal",
        "angle",
        "from_rad",
        "to_rad",
        "point",
        "plane",
        "edges",
        "faces",
    ];
    let found = checked("fit", fit(&guide, &curve, &options), &arguments)?;
    // The steps of a fit, each of which is there for callers as well.
    let tangents: Vec<DVec3> = first.iter().rev().copied().collect();
    let Some(nearest) = checked("nearest", NearestOnCurve::new(&curve), &["curve"])? else { return Ok(false) };
    if let Some(own) = checked("guide", Guide::new(&first, &tangents, case.flag(0)), &arguments)? {
        checked("fit along a guide", fit_guide(&own, &nearest, &options), &arguments)?;
        checked("normals", rotation_minimising(&own, orientation), &arguments)?;
        checked("frames", reflected_frames(&own, orientation), &arguments)?;
    }
    checked("spheres", spheres_at_points(&first, &tangents, &nearest), &arguments)?;
    let sphere = |(i, &center): (usize, &DVec3)| Sphere { center, radius: case.numbers[i % 8] };
    let spheres: Vec<Sphere> = first.iter().enumerate().map(sphere).collect();
    checked("circles", characteristic_circles(&spheres), &["spheres"])?;
    let Some(found) = found else { return Ok(false) };
    let [centers, normals, guide, row] = case.spoilt([
        found.strip.circles.iter().map(|circle| circle.center).collect(),
        found.strip.circles.iter().map(|circle| circle.normal).collect(),
        found.grid.column(0),
        found.grid.row(0).to_vec(),
    ]);
    let both = centers.iter().zip(&normals).zip(&found.strip.circles);
    let all: Vec<Circle> =
        both.map(|((&center, &normal), circle)| Circle { center, normal, radius: circle.radius }).collect();
    let arguments = [&arguments[..], &["circles", "row", "start", "target", "circle"]].concat();
    checked("mesh", circles::mesh(&all, &guide, &row, case.flag(1)), &arguments)?;
    let start = row.first().copied().unwrap_or_default();
    checked("strip", circles::strip(&all, &guide, start), &arguments)?;
    checked("column", circles::column(&all, start), &arguments)?;
    if let Some(circle) = all.first() {
        let target = guide.last().copied().filter(|_| case.flag(0));
        checked("section", section.samples(circle, start, column_count, target), &arguments)?;
    }
    Ok(true)
}

fn c_canal_surfaces(case: &Case) -> Checked<bool> {
    let guide: Vec<DVec3> =
        (0..6).map(|k| TAU * f64::from(k) / 30.0).map(|t| 3.0 * DVec3::new(t.cos() - 1.0, t.sin(), 0.1 * t)).collect();
    let section = (0..5).map(|j| 0.4 * f64::from(j)).map(|t| DVec3::new(1.0 - t.cos(), 0.0, t.sin())).collect();
    let lengths: Vec<DVec3> = (0..6).map(|k| DVec3::splat(1.0 - 0.01 * f64::from(k))).collect();
    let [guide, section, far, lengths] = case.spoilt([guide, section, wave(7, 1.2, 0.5), lengths]);
    let mut on =
        |_: f64| if case.choices[1].is_multiple_of(8) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let arguments = ["guide", "section", "lengths", "curve"];
    let used = |made: &CCanal| made.surface.to_json().is_empty() || made.residual().is_nan();
    let mut look = |target: Target<'_>| -> Checked<bool> {
        let found = c_canal(&guide, &section, target, !case.flag(0), &mut on);
        let made = checked("c-canal", found, &arguments)?;
        if let Some(made) = &made {
            prop_assert!(!used(made));
            let pieces = size(case.choices[2], 3);
            checked(
                "distance of the section",
                made.section_distance(pieces),
                &["pieces", "one", "two", "net", "chain"],
            )?;
        }
        Ok(made.is_some())
    };
    // The first length is the section's, where nothing is spoilt.
    let chord = section.first().zip(section.last()).map_or(1.0, |(first, last)| first.distance(*last));
    let lengths: Vec<f64> = lengths.iter().map(|length| length.x * chord).collect();
    let mut is_made = look(Target::Lengths(&lengths))?;
    if let Ok(curve) = Spline::through(&far, case.flag(3))
        && let Some(nearest) = checked("nearest", NearestOnCurve::new(&curve), &["curve"])?
    {
        is_made |= look(Target::Curve(&nearest))?;
    }
    Ok(is_made)
}

fn smoothing_of_strips(case: &Case) -> Checked<bool> {
    let guide = wave(6, 0.0, 0.0);
    let edges: Vec<f64> = guide.windows(2).map(|ends| ends[0].distance(ends[1]) * 0.9).collect();
    let start = guide[0] + DVec3::new(-0.2, 1.0, 0.1);
    let good = of_border_edges(&guide, start, &edges).unwrap();
    let tangent = (guide[1] - guide[0]).normalize();
    let frame = Frame::of_tangent_one(tangent, DVec3::Z).unwrap();
    let vectors = vec![frame.t1, frame.t2, frame.normal];
    let curve = Spline::through(&guide, false).unwrap();
    let parameters: Vec<DVec3> = curve.knots().iter().map(|&knot| DVec3::splat(knot)).collect();
    let [guide, border, vectors, parameters] =
        case.spoilt([good.guide.clone(), good.border.clone(), vectors, parameters]);
    let [t1, t2, normal, ..] = vectors[..] else { return Ok(false) };
    let frame = Frame { t1, t2, normal };
    let strip = Strip { guide: guide.clone(), border, ..good };
    checked("energy", smoothing::energy(&strip, &frame), &["strip", "frame"])?;
    let parameters: Vec<f64> = parameters.iter().map(|parameter| parameter.x).collect();
    let default = smoothing::Options::default();
    let asked = |which: usize, from: usize, value: f64| {
        if case.choices[which].is_multiple_of(3) { case.numbers[from] } else { value }
    };
    let options = smoothing::Options {
        cone: case.flag(0).then(|| Cone { axis: case.vector(0), angle_rad: case.numbers[3] }),
        turns_tangents: case.flag(1),
        spacing_ratio: asked(2, 4, default.spacing_ratio),
        length_change: asked(3, 5, default.length_change),
        length_weight: asked(4, 6, default.length_weight),
        half_angle_rad: asked(5, 7, default.half_angle_rad),
        max_iterations: size(case.choices[0], 12),
        relative_gradient: asked(1, 2, default.relative_gradient),
        relative_decrease: asked(2, 1, default.relative_decrease),
    };
    // The curve of the spoilt points, or the good one: one of a caller's own may be as bad as its points.
    let own = if case.flag(5) { None } else { Spline::through(&guide, false).ok() };
    let shift = if case.choices[4].is_multiple_of(9) { case.numbers[0] } else { 0.0 };
    let at = |parameter: f64| own.as_ref().unwrap_or(&curve).point(parameter) + shift;
    let input = Input { curve: &at, parameters: &parameters, strip: &strip, frame };
    let mut on = |_: &shapeop::linalg::bfgs::Progress| ControlFlow::Continue(());
    let arguments = [
        "parameters",
        "strip",
        "frame",
        "cone",
        "spacing_ratio",
        "length_change",
        "length_weight",
        "half_angle_rad",
        "relative_gradient",
        "relative_decrease",
    ];
    let found = checked("smooth", smooth(&input, &options, &mut on), &arguments)?;
    let is_done = found.is_some();
    if let Some(found) = found {
        prop_assert!(found.after <= found.before * (1.0 + 1e-9) || options.length_weight > 0.0, "{found:?}");
    }
    Ok(is_done)
}

fn parts(case: &Case) -> Checked<bool> {
    let wraps = [case.flag(0), case.flag(1)];
    let angle = |k: usize, wraps: bool| k as f64 * if wraps { TAU / 4.0 } else { 0.4 };
    // A torus: its lines of curvature make a circular net, its normals node axes.
    let at = |i: usize, j: usize| {
        let ((su, cu), (sv, cv)) = (angle(i, wraps[0]).sin_cos(), angle(j, wraps[1]).sin_cos());
        (DVec3::new((3.0 + cv) * cu, (3.0 + cv) * su, sv), DVec3::new(cv * cu, cv * su, sv))
    };
    let both = || (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
    let points = both().map(|(i, j)| at(i, j).0).collect();
    let normals = both().map(|(i, j)| at(i, j).1).collect();
    let [points, axes] = case.spoilt([points, normals]);
    let Some(grid) = checked("grid", Grid::new(points, 4, 4, wraps), &["points", "rows", "columns"])? else {
        return Ok(false);
    };
    let [thickness, height, distance, ..] = case.numbers;
    let arguments = ["points", "axes", "faces", "distance", "height", "thickness", "first", "grid"];
    let flat = checked("panels", panels(&grid, &axes), &arguments)?;
    for panel in flat.iter().flatten() {
        checked("lower outline", panel.lower_outline(thickness), &arguments)?;
    }
    checked("offset", offset(&grid, &axes, distance), &arguments)?;
    checked("beams", beams(&grid, &axes, height), &arguments)?;
    let mut steps = case.choices[2] % 30;
    let mut on = |_: f64| {
        steps = steps.saturating_sub(1);
        if steps == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut search = || NodeAxes::of_least_gaps(&grid, &mut on);
    let found = [
        checked("given axes", NodeAxes::of(&grid, &axes), &arguments)?,
        checked("axes handed on", NodeAxes::handed_on(&grid, case.vector(3)), &arguments)?,
        if case.choices[3].is_multiple_of(8) { checked("least gaps", search(), &arguments)? } else { None },
    ];
    for axes in found.into_iter().flatten() {
        checked("depths", axes.depths(&grid, height), &arguments)?;
        checked("parts", PartsForm::new(&grid, &axes, thickness, height), &arguments)?;
    }
    Ok(flat.is_some())
}

fn run(what: fn(&Case) -> Checked<bool>) {
    let config = Config { cases: CASES, failure_persistence: None, ..Config::default() };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[23; 32]);
    let made = Cell::new(0);
    let one = |case: Case| what(&case).map(|is_made| made.set(made.get() + u32::from(is_made)));
    TestRunner::new_with_rng(config, rng).run(&case(), one).unwrap();
    // Else only the checks of arguments were tried.
    assert!(made.get() > CASES / 5, "{} of {CASES} were not refused", made.get());
}

#[test]
fn no_input_of_two_curve_fits_panics_or_comes_back_not_finite() {
    run(two_curves);
}

#[test]
fn no_input_of_c_canal_surfaces_panics_or_comes_back_not_finite() {
    run(c_canal_surfaces);
}

#[test]
fn no_input_of_smoothing_panics_or_comes_back_not_finite() {
    run(smoothing_of_strips);
}

#[test]
fn no_input_of_parts_panics_or_comes_back_not_finite() {
    run(parts);
}
