//! Strips to start from: boundaries suggested on the reference surface, joined by straight lines.
//!
//! The first boundary of a strip is fitted by a spline. From points spread over it asymptotic curves lead to the second boundary;
//! the spline that fits their ends, at the parameters of where they began, is the other side. So rulings follow asymptotic curves
//! to the fourth power of the distance of knots (Flöry et al. 2012, section 2.2, join control points instead, which are not on the
//! curve).

use glam::DVec3;
use rayon::prelude::*;

use super::Strip;
use crate::error::{Error, Result, Status};
use crate::mesh::curve::{BSpline, Curve, Polyline, fit, fit_polyline};

/// Rulings that are traced in each span of a strip.
const RULINGS_PER_SPAN: usize = 4;

/// Where the ends of rulings go back along the second boundary by more than this part of all their ways, the strip is folded: less
/// than that is what a trace on a coarse mesh is wrong by, and is mended.
const MOST_BACKWARD: f64 = 0.2;

/// Beyond its ends a boundary goes on for this part of its length at most,
const MOST_BEYOND: f64 = 0.25;

/// along the chord over this part of it.
const CHORD: f64 = 1e-3;

/// Where the rulings of a strip end on its second boundary.
#[derive(Clone, Copy)]
pub enum Rulings<'a> {
    /// At the same part of its length as on the first.
    Proportional,
    /// Where this function says, given the strip and a point of its first boundary: where the asymptotic curve from that point
    /// meets the second boundary (of what it returns, the nearest point of the boundary is taken; where that is an end, the boundary
    /// goes on straight). Where it has no answer, at the nearest point.
    Traced(&'a (dyn Fn(usize, DVec3) -> Option<DVec3> + Sync)),
}

impl std::fmt::Debug for Rulings<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if matches!(self, Self::Proportional) { "Proportional" } else { "Traced" })
    }
}

/// How strips start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StartOptions {
    /// Control points of each boundary of a strip, at least 4.
    pub control_count: usize,
    /// Whether neighbours have their common boundary as one spline: the second boundary of a strip then is the first one of the
    /// next, so that nothing can gape. The boundaries after the first one have fewer ways to go for it.
    pub is_shared: bool,
}

impl Default for StartOptions {
    fn default() -> Self {
        Self { control_count: 12, is_shared: false }
    }
}

/// Strips to start from.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// The strips; strip `i` is between boundaries `i` and `i + 1`.
    pub strips: Vec<Strip>,
    /// For each strip, how many of its rulings had no answer and went to the nearest point.
    pub missed: Vec<usize>,
    /// For each strip, how many of its rulings ended before those before them, and were moved.
    pub moved: Vec<usize>,
}

/// Strips between each boundary and the next. Boundaries are polylines in their order; where one runs against the one before it, it
/// is taken backwards. A closed one may repeat its first point.
///
/// # Errors
/// Fewer than 2 boundaries or not one flag for each, fewer than 4 control points (`options.control_count`), a boundary that is no
/// polyline (`boundaries[i]`, `boundaries[i][j]`). Status `NoSolution`: a closed boundary next to an open one (`boundaries[i]`).
/// Status `Degenerate`: the rulings of a strip go back and forth along its second boundary, the strip is folded (`strips[i]`).
pub fn start(
    boundaries: &[Vec<DVec3>],
    is_closed: &[bool],
    rulings: Rulings<'_>,
    options: StartOptions,
) -> Result<Start> {
    if boundaries.len() < 2 {
        let reason = format!("expected at least 2, found {}", boundaries.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("boundaries"));
    }
    if is_closed.len() != boundaries.len() {
        let reason = format!("expected one for each of {} boundaries, found {}", boundaries.len(), is_closed.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("is_closed"));
    }
    if let Some(i) = (1..boundaries.len()).find(|&i| is_closed[i] != is_closed[i - 1]) {
        let kind = |is_closed| if is_closed { "a closed" } else { "an open" };
        let [this, before] = [kind(is_closed[i]), kind(is_closed[i - 1])];
        let reason = format!("no strip leads from {before} boundary to {this} one");
        return Err(Error::new(Status::NoSolution, reason).at(format!("boundaries[{i}]")));
    }
    let polyline = |i: usize| {
        Polyline::new(&boundaries[i], is_closed[i]).map_err(|error| {
            let inner = error.place().trim_start_matches("points").to_owned();
            error.with_place(format!("boundaries[{i}]{inner}"))
        })
    };
    let polylines = (0..boundaries.len()).map(polyline).collect::<Result<Vec<_>>>()?;
    let fitted = |polyline: &Polyline| {
        fit_polyline(polyline, options.control_count).map_err(|error| error.with_place("options.control_count"))
    };
    let mut found = Start { strips: Vec::new(), missed: Vec::new(), moved: Vec::new() };
    let mut first = fitted(&polylines[0])?;
    for i in 0..polylines.len() - 1 {
        let side = opposite(i, &first, [&polylines[i], &polylines[i + 1]], rulings)?;
        found.missed.push(side.missed);
        found.moved.push(side.moved);
        let control = [first.control().to_vec(), side.curve.control().to_vec()];
        found.strips.push(Strip::new(first.basis().clone(), control)?);
        first = if options.is_shared { side.curve } else { fitted(&polylines[i + 1])? };
    }
    Ok(found)
}

/// The second side of a strip.
struct Opposite {
    curve: BSpline,
    missed: usize,
    moved: usize,
}

/// The second side of strip `strip` with this first one.
fn opposite(strip: usize, first: &BSpline, [from, to]: [&Polyline; 2], rulings: Rulings<'_>) -> Result<Opposite> {
    let (basis, is_closed) = (first.basis().clone(), from.is_closed());
    let parts = RULINGS_PER_SPAN * basis.spans();
    let number = if is_closed { parts } else { parts + 1 };
    let parameters: Vec<f64> = (0..number).map(|k| basis.spans() as f64 * k as f64 / parts as f64).collect();
    let ends: Vec<(f64, bool)> = match rulings {
        Rulings::Proportional => proportional(first, &parameters, [from, to]),
        Rulings::Traced(trace) => {
            let end = |&parameter: &f64| {
                let point = from.at(from.nearest(first.point(parameter)));
                let hit = trace(strip, point).filter(|hit| hit.is_finite());
                (hit.map_or_else(|| to.nearest(point), |hit| along_beyond(to, hit)), hit.is_none())
            };
            parameters.par_iter().map(end).collect()
        }
    };
    let mut along: Vec<f64> = ends.iter().map(|end| end.0).collect();
    if is_closed {
        unwind(&mut along, to.length());
    }
    // A polyline that runs against the first one is as good.
    let sign = if along[number - 1] < along[0] { -1.0 } else { 1.0 };
    along.iter_mut().for_each(|along| *along *= sign);
    let folded = |what: String| {
        let reason = format!("the strip is folded: {what}");
        Err(Error::new(Status::Degenerate, reason).at(format!("strips[{strip}]")))
    };
    let steps: Vec<f64> = along.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let way: f64 = steps.iter().map(|step| step.abs()).sum();
    let back: f64 = steps.iter().map(|step| (-step).max(0.0)).sum();
    if !(way > 0.0) {
        return folded("its rulings end in one point".to_owned());
    }
    if back > MOST_BACKWARD * way {
        return folded(format!("its rulings end backwards over {:.0} % of their way", 100.0 * back / way));
    }
    let turn = to.length();
    let once = along[0] + turn;
    // From the last ruling to the first again is one step of the turn.
    if is_closed && (along[number - 1] - once).abs() > 0.5 * turn {
        return folded("its rulings end on a part of the closed boundary only".to_owned());
    }
    let before = along.clone();
    ascend(&mut along);
    if is_closed {
        along.iter_mut().for_each(|along| *along = along.min(once));
    }
    let moved = along.iter().zip(&before).filter(|(after, before)| after != before).count();
    let points: Vec<DVec3> = along.iter().map(|along| at_beyond(to, sign * along)).collect();
    let curve = fit(basis, &parameters, &points)?;
    Ok(Opposite { curve, missed: ends.iter().filter(|end| end.1).count(), moved })
}

/// The end of an open polyline, 0 or 1, and the unit tangent outward there.
fn end_of(polyline: &Polyline, end: usize) -> (DVec3, DVec3) {
    let (at, inward) = if end == 0 { (0.0, CHORD) } else { (polyline.length(), -CHORD) };
    let point = polyline.at(at);
    (point, (point - polyline.at(at + inward * polyline.length())).normalize_or_zero())
}

/// How far along a polyline its nearest point is; of an open one that goes on straight beyond its ends.
fn along_beyond(polyline: &Polyline, point: DVec3) -> f64 {
    let (along, length) = (polyline.nearest(point), polyline.length());
    if polyline.is_closed() || (along > 0.0 && along < length) {
        return along;
    }
    let end = usize::from(along > 0.0);
    let (last, outward) = end_of(polyline, end);
    let beyond = (point - last).dot(outward).clamp(0.0, MOST_BEYOND * length);
    if end == 0 { -beyond } else { length + beyond }
}

/// The point so far along a polyline; of an open one also beyond its ends.
fn at_beyond(polyline: &Polyline, along: f64) -> DVec3 {
    let inside = along.clamp(0.0, polyline.length());
    if polyline.is_closed() || inside == along {
        return polyline.at(along);
    }
    let (last, outward) = end_of(polyline, usize::from(along > 0.0));
    last + (along - inside).abs() * outward
}

/// The same part of the length on both boundaries, each closed one from the point nearest to the other's; the second one the way
/// that lets rulings cross the least: the one on which they are shorter together.
fn proportional(first: &BSpline, parameters: &[f64], [from, to]: [&Polyline; 2]) -> Vec<(f64, bool)> {
    let starts: Vec<f64> = parameters.iter().map(|&t| from.nearest(first.point(t)) / from.length()).collect();
    let origin = if from.is_closed() { to.nearest(first.point(0.0)) - starts[0] * to.length() } else { 0.0 };
    let forwards: Vec<f64> = starts.iter().map(|part| origin + part * to.length()).collect();
    let turned = |part: &f64| {
        if from.is_closed() { origin + (2.0 * starts[0] - part) * to.length() } else { (1.0 - part) * to.length() }
    };
    let backwards: Vec<f64> = starts.iter().map(turned).collect();
    let cost = |ends: &[f64]| -> f64 {
        parameters.iter().zip(ends).map(|(&t, &along)| to.at(along).distance_squared(first.point(t))).sum()
    };
    let best = if cost(&forwards) <= cost(&backwards) { forwards } else { backwards };
    best.into_iter().map(|along| (along, false)).collect()
}

/// Lengths along a closed polyline, each the nearest to the one before of those that are the same place.
fn unwind(along: &mut [f64], turn: f64) {
    for k in 1..along.len() {
        let step = (along[k] - along[k - 1]).rem_euclid(turn);
        along[k] = along[k - 1] + if step > 0.5 * turn { step - turn } else { step };
    }
}

/// The ascending numbers that are nearest in the sum of squares: where numbers descend, their mean is taken, with those before
/// while they are above it (isotonic regression; Robertson, Wright, Dykstra 1988, "Order restricted statistical inference").
fn ascend(numbers: &mut [f64]) {
    let mut blocks: Vec<(f64, usize)> = Vec::with_capacity(numbers.len());
    for &number in numbers.iter() {
        let mut block = (number, 1);
        while let Some(&(mean, count)) = blocks.last().filter(|(mean, _)| *mean > block.0) {
            let total = count + block.1;
            block = ((mean * count as f64 + block.0 * block.1 as f64) / total as f64, total);
            blocks.pop();
        }
        blocks.push(block);
    }
    let ascending = blocks.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    numbers.iter_mut().zip(ascending).for_each(|(number, mean)| *number = mean);
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Rulings of the saddle z = xy: from (x, y) to (x, y').
    fn rows(ys: &[f64], count: usize) -> Vec<Vec<DVec3>> {
        let point = |x: f64, y: f64| DVec3::new(x, y, x * y);
        let row = |&y: &f64| (0..count).map(|i| point(2.0 * i as f64 / (count - 1) as f64 - 1.0, y)).collect();
        ys.iter().map(row).collect()
    }

    fn across(ys: Vec<f64>) -> impl Fn(usize, DVec3) -> Option<DVec3> {
        move |strip, point| Some(DVec3::new(point.x, ys[strip + 1], point.x * ys[strip + 1]))
    }

    #[test]
    fn the_rulings_of_a_saddle_are_those_of_its_strips() {
        let ys = vec![-1.0, -0.2, 0.7];
        let trace = across(ys.clone());
        let mut boundaries = rows(&ys, 23);
        // A boundary may run the other way.
        boundaries[1].reverse();
        for is_shared in [false, true] {
            for rulings in [Rulings::Traced(&trace), Rulings::Proportional] {
                let options = StartOptions { control_count: 6, is_shared };
                // What the last boundary of a shared strip has from the one before, it has without the reversal.
                let found = start(&boundaries, &[false; 3], rulings, options).unwrap();
                assert_eq!((found.strips.len(), found.missed, found.moved), (2, vec![0, 0], vec![0, 0]));
                for (i, strip) in found.strips.iter().enumerate() {
                    for k in 0..=10 {
                        let u = strip.length_u() * f64::from(k) / 10.0;
                        let jets = [0.0, 0.3, 1.0].map(|v| strip.at(u, v).point);
                        assert!(jets.iter().all(|p| (p.z - p.x * p.y).abs() < 1e-9), "{jets:?}");
                        assert!((jets[0].y - ys[i]).abs() < 1e-9 && (jets[2].y - ys[i + 1]).abs() < 1e-9);
                        assert!((jets[0].x - jets[2].x).abs() < 1e-9, "{i} {k}: {jets:?}");
                    }
                }
                let is_one = found.strips[0].control(1) == found.strips[1].control(0);
                assert_eq!(is_one, is_shared);
            }
        }
    }

    #[test]
    fn closed_strips_go_around_from_wherever_their_boundaries_start() {
        // The hyperboloid x² + y² − z² = 1: the ruling from (cos t, sin t, 0) ends at height h at angle t + atan h.
        let ring = |height: f64, shift: f64, sign: f64| -> Vec<DVec3> {
            let radius = (1.0 + height * height).sqrt();
            let at = move |t: f64| DVec3::new(radius * t.cos(), radius * t.sin(), height);
            (0..400).map(|i| at(shift + sign * TAU * f64::from(i) / 400.0)).collect()
        };
        let trace = |_: usize, p: DVec3| Some(DVec3::new(p.x - 0.5 * p.y, p.y + 0.5 * p.x, 0.5));
        for sign in [1.0, -1.0] {
            let boundaries = [ring(0.0, 0.3, 1.0), ring(0.5, 4.0, sign)];
            let options = StartOptions { control_count: 24, ..StartOptions::default() };
            let found = start(&boundaries, &[true; 2], Rulings::Traced(&trace), options).unwrap();
            let strip = &found.strips[0];
            assert!(strip.basis().is_closed() && found.missed == [0]);
            for k in 0..50 {
                let p = strip.at(24.0 * f64::from(k) / 50.0, 0.6).point;
                assert!((p.x * p.x + p.y * p.y - p.z * p.z - 1.0).abs() < 1e-3, "{p}");
            }
            let straight = start(&boundaries, &[true; 2], Rulings::Proportional, options).unwrap();
            assert!(straight.strips[0].rulings(20).iter().all(|[a, b]| a.distance(*b) < 0.6));
        }
        // The way around on a part only.
        let half = |_: usize, p: DVec3| Some(DVec3::new(2.0 + p.x, p.y, 0.5));
        let error = start(
            &[ring(0.0, 0.0, 1.0), ring(0.5, 0.0, 1.0)],
            &[true; 2],
            Rulings::Traced(&half),
            StartOptions::default(),
        );
        assert_eq!(error.unwrap_err().status(), Status::Degenerate);
    }

    #[test]
    fn few_rulings_that_cross_are_mended_and_a_folded_strip_is_named() {
        let ys = vec![-1.0, -0.2, 0.7];
        let boundaries = rows(&ys, 50);
        let exact = across(ys);
        let noisy = |strip: usize, p: DVec3| {
            let shift = if strip == 1 && (p.x - 0.3).abs() < 0.08 { -0.2 } else { 0.0 };
            (strip == 1 || p.x < 0.9).then_some(())?;
            exact(strip, p + shift * DVec3::X)
        };
        let found = start(&boundaries, &[false; 3], Rulings::Traced(&noisy), StartOptions::default()).unwrap();
        assert!(found.missed[0] > 0 && found.missed[1] == 0 && found.moved[0] == 0 && found.moved[1] > 0, "{found:?}");
        let folded =
            |strip: usize, p: DVec3| exact(strip, if strip == 1 { DVec3::new(p.x.abs(), p.y, 0.0) } else { p });
        let error = start(&boundaries, &[false; 3], Rulings::Traced(&folded), StartOptions::default()).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "strips[1]"));
        assert!(error.to_string().contains("folded"));
        let mut numbers = [1.0, 3.0, 2.0, 2.5, 2.0, 5.0, 4.0];
        ascend(&mut numbers);
        assert_eq!(numbers, [1.0, 2.375, 2.375, 2.375, 2.375, 4.5, 4.5]);
    }

    #[test]
    fn bad_boundaries_are_named() {
        let boundaries = rows(&[0.0, 1.0, 2.0], 9);
        let place = |boundaries: &[Vec<DVec3>], is_closed: &[bool], control_count| {
            let options = StartOptions { control_count, ..StartOptions::default() };
            let error = start(boundaries, is_closed, Rulings::Proportional, options).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        assert_eq!(place(&boundaries[..1], &[false], 8).1, "boundaries");
        assert_eq!(place(&boundaries, &[false], 8).1, "is_closed");
        assert_eq!(place(&boundaries, &[false, true, true], 8), (Status::NoSolution, "boundaries[1]".to_owned()));
        assert_eq!(place(&boundaries, &[false; 3], 3).1, "options.control_count");
        let mut bad = boundaries.clone();
        bad[1].truncate(1);
        assert_eq!(place(&bad, &[false; 3], 8), (Status::InvalidArgumentLength, "boundaries[1]".to_owned()));
        bad[0][4].z = f64::NAN;
        assert_eq!(place(&bad, &[false; 3], 8).1, "boundaries[0][4]");
    }
}
