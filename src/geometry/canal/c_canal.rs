//! C-canal surfaces from a guide curve, a planar cross-section and lengths across, or a second curve (section 5.2, Fig. 21).
//!
//! Sought is a canal surface along the guide whose Combescure transform has the cross-section as its first row, while the guide
//! stays. Planes of rows are kept, so all sections are planar.
//!
//! **The first circle** is that of `section_circle`.
//!
//! **The next ones.** The cyclidic net on the guide hands on the tangent of the circle by reflection. A circle of that tangent through
//! guide point `k + 1` is determined by one point, the end of its section, and that is on the circle of the quad across the strip:
//! one number is free, and the length of the transformed section, from the guide to its end, depends on it alone. So the sum of
//! equation 10 is minimised term by term, each by a bracketed search for its root. (The paper runs BFGS on each.)
//!
//! **Not every length is attainable** (see `strip`): where one is not, the nearest that is can be taken instead.

use std::ops::ControlFlow;

use glam::DVec3;

use super::chain::Transform;
use super::combescure::fourth_corner;
use super::frame::Frame;
use super::net::Net;
use super::polyline::{polyline, start_tangent};
use super::quad::Quad;
use super::section_circle::{first_circle, turned_along};
use super::strip::check_positive;
use super::surface::{BaseKind, SuperCanal};
use crate::error::{Error, Result, Status};
use crate::geometry::circle::{Circle, reflect, second_point};
use crate::mesh::curve::NearestOnCurve;
use crate::mesh::grid::diagonal;
use crate::mesh::{ClosestPoints, Grid};

/// How far the section's first point may be from the guide's, over the extent; and a first length from the section's, over that.
const APART: f64 = 1e-9;

/// Places between the ends of a quad's free arc at which a length is tried first, and how near to the ends: at an end the border
/// has no edge.
const TRIALS: usize = 48;
const NEAR_END: f64 = 0.01;

/// Halvings of a bracket; the false position needs a fifth of them.
const MOST_HALVINGS: usize = 200;

/// What the far ends of the sections are to meet.
#[derive(Clone, Copy, Debug)]
pub enum Target<'a> {
    /// The distance of each section's far end from its guide point, in model units: one per guide point, the first that of the
    /// section itself.
    Lengths(&'a [f64]),
    /// A second curve.
    Curve(&'a NearestOnCurve<'a>),
}

/// A C-canal surface and how well it meets what was asked for.
#[derive(Debug)]
pub struct CCanal {
    /// The surface: a canal surface and one Combescure transformation. Column 0 of its net is the guide, row 0 the section.
    pub surface: SuperCanal,
    /// The distances of the far ends of the sections from the guide.
    pub lengths: Vec<f64>,
    /// For each section, how far it is off: the length from the one asked for, or the far end from the second curve.
    pub deviations: Vec<f64>,
    /// For each section, the least and the greatest length that the sections before it leave attainable.
    pub attainable: Vec<[f64; 2]>,
    /// The sections whose length was replaced by the nearest attainable one.
    pub projected: Vec<usize>,
    /// Whether the run was cancelled: the surface ends where it was.
    pub is_cancelled: bool,
}

impl CCanal {
    /// `E` of equation 10, the sum of the squared deviations.
    pub fn residual(&self) -> f64 {
        self.deviations.iter().map(|deviation| deviation * deviation).sum()
    }

    /// How far the first section, refined, is from the polyline that was given: between its points a refined section consists of
    /// images of arcs. With more points of the section it falls; resample the section if it matters.
    ///
    /// # Errors
    /// As [`SuperCanal::refined`]; `pieces` is 0.
    pub fn section_distance(&self, pieces: usize) -> Result<f64> {
        let section = self.surface.net().grid().row(0);
        let fine = self.surface.refined(1, pieces)?;
        let polyline = ClosestPoints::of_polyline(section, false)?;
        Ok(fine.grid().row(0).iter().map(|&point| polyline.nearest(point).distance(point)).fold(0.0, f64::max))
    }
}

/// The C-canal surface along `guide`, of which the first point is that of the `section`, a convex planar polyline of 3 points or more.
/// `is_projected`: a length that is not attainable is replaced by the nearest that is. `progress` is called after each section with the
/// part done, 0 to 1, and can cancel.
///
/// # Errors
/// Too few points, a number that is not finite, another number of lengths than of guide points, a length that is not above 0, a first
/// length other than the section's, a section that does not start on the guide, or one that is not convex enough for any circle
/// (`section[j]`). Status `NotPlanar`: the section; `Degenerate`: consecutive edges of the section are parallel, points coincide
/// or are on a line; `NotCircular`: round-off leaves no circular net; `NoSolution`: a length is not attainable, unless
/// `is_projected`; the reason has the attainable interval. The place is `guide`, `section[j]`, `guide[k]` or `lengths[k]`.
pub fn c_canal(
    guide: &[DVec3],
    section: &[DVec3],
    target: Target<'_>,
    is_projected: bool,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<CCanal> {
    polyline("guide", guide)?;
    polyline("section", section)?;
    if section.len() < 3 {
        let reason = format!("expected at least 3 points, found {}", section.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("section"));
    }
    let extent = diagonal(guide).max(diagonal(section));
    let apart = guide[0].distance(section[0]);
    if apart > APART * extent {
        let reason = format!("expected the guide's first point, found one {apart:e} from it");
        return Err(Error::new(Status::InvalidValue, reason).at("section[0]"));
    }
    let first_length = section[0].distance(section[section.len() - 1]);
    if let Target::Lengths(lengths) = target {
        check_positive("lengths", lengths, guide.len())?;
        if !((lengths[0] - first_length).abs() <= APART * first_length) {
            let reason = format!("expected {first_length}, the distance of the section's ends, found {}", lengths[0]);
            return Err(Error::new(Status::InvalidValue, reason).at("lengths[0]"));
        }
    }
    let (circle, samples) = first_circle(section)?;
    let t2 = Circle { normal: turned_along(&circle, &samples), ..circle }.tangent_at(samples[0]);
    let along = start_tangent(guide).reject_from_normalized(t2);
    let frame = Frame::of_tangent_two(t2, along.cross(t2)).ok_or_else(|| {
        Error::new(Status::Degenerate, "the guide leaves the section along the section's circle").at("guide[1]")
    })?;
    let mut sections = vec![Section { canal: samples, image: section.to_vec(), t2 }];
    let mut result = Sections::start(first_length);
    for k in 1..guide.len() {
        let next = sections[k - 1].next_to(guide[k], k, &target, is_projected, &mut result)?;
        sections.push(next);
        if progress(k as f64 / (guide.len() - 1) as f64).is_break() {
            result.is_cancelled = k + 1 < guide.len();
            break;
        }
    }
    if let Target::Curve(curve) = target {
        result.deviations[0] = curve.nearest(section[section.len() - 1]).distance;
    }
    let points = sections.iter().flat_map(|section| section.canal.iter().copied()).collect();
    // Where guide and section are of very different sizes, round-off leaves no circles.
    let too_rough = |error: Error| {
        let reason = format!("along it the section makes no circular net: {error}");
        Error::new(error.status(), reason).at("guide")
    };
    let grid = Grid::new(points, sections.len(), section.len(), [false; 2]).map_err(too_rough)?;
    let mut surface = SuperCanal::new(Net::new(grid, frame).map_err(too_rough)?, BaseKind::Canal);
    let row = (1..section.len()).map(|j| {
        let canal = &sections[0].canal;
        section[j].distance(section[j - 1]) / canal[j].distance(canal[j - 1])
    });
    let stretched = Transform::Combescure { column: vec![1.0; sections.len() - 1], row: row.collect() };
    surface.push(stretched).map_err(too_rough)?;
    let Sections { lengths, deviations, attainable, projected, is_cancelled } = result;
    Ok(CCanal { surface, lengths, deviations, attainable, projected, is_cancelled })
}

/// What has been found so far.
struct Sections {
    lengths: Vec<f64>,
    deviations: Vec<f64>,
    attainable: Vec<[f64; 2]>,
    projected: Vec<usize>,
    is_cancelled: bool,
}

impl Sections {
    fn start(length: f64) -> Self {
        let (lengths, attainable) = (vec![length], vec![[length; 2]]);
        Self { lengths, deviations: vec![0.0], attainable, projected: Vec::new(), is_cancelled: false }
    }
}

/// A row of the canal surface, its image, and the circle's tangent at column 0.
struct Section {
    canal: Vec<DVec3>,
    image: Vec<DVec3>,
    t2: DVec3,
}

impl Section {
    fn end(&self) -> DVec3 {
        self.image[self.image.len() - 1]
    }

    fn length(&self) -> f64 {
        self.image[0].distance(self.end())
    }

    /// The next one, over the guide point `corner` and through `border`, a point of the circle of the strip's quad; `None` where
    /// opposite edges of a quad are parallel.
    fn through(&self, corner: DVec3, border: DVec3) -> Option<Self> {
        let last = self.canal.len() - 1;
        let previous = self.canal[0];
        let t2 = reflect(self.t2, corner - previous);
        let mut canal = Vec::with_capacity(last + 1);
        let mut image = Vec::with_capacity(last + 1);
        canal.push(corner);
        image.push(self.image[0] + (corner - previous));
        for j in 1..=last {
            let point = if j == last { border } else { second_point(corner, previous, self.canal[j], t2, border) };
            let (u, w) = (point - canal[j - 1], point - self.canal[j]);
            let corner = fourth_corner(image[j - 1], self.image[j], u, w)?;
            canal.push(point);
            image.push(corner);
        }
        Some(Self { canal, image, t2 })
    }

    /// The section over guide point `k` that meets its target.
    fn next_to(
        &self,
        corner: DVec3,
        k: usize,
        target: &Target<'_>,
        is_projected: bool,
        result: &mut Sections,
    ) -> Result<Self> {
        let degenerate = || {
            let reason = "the points of the strip's quad are on a line";
            Error::new(Status::Degenerate, reason).at(format!("guide[{k}]"))
        };
        let quad = Quad::new(self.canal[0], self.canal[self.canal.len() - 1], corner).ok_or_else(degenerate)?;
        let unit = quad.unit();
        // Fractions of 0 to 1 of the free arc, as of its image: a line.
        let at = |fraction: f64| self.through(corner, quad.point(unit * fraction / (1.0 - fraction)));
        let fractions = (0..TRIALS).map(|i| NEAR_END + (1.0 - 2.0 * NEAR_END) * i as f64 / (TRIALS - 1) as f64);
        let trials: Vec<(f64, Self)> = fractions.filter_map(|f| at(f).map(|section| (f, section))).collect();
        if trials.is_empty() {
            return Err(degenerate());
        }
        let lengths = trials.iter().map(|(_, section)| section.length());
        let range = [lengths.clone().fold(f64::INFINITY, f64::min), lengths.fold(0.0, f64::max)];
        let found = match target {
            Target::Lengths(lengths) => {
                let misfit = |section: &Self| section.length() - lengths[k];
                let root = root(&trials, &at, &misfit, (corner - self.canal[0]).length());
                if root.is_none() && !is_projected {
                    let reason = format!(
                        "{} is not attainable: after the sections before it, lengths from {} to {} are",
                        lengths[k], range[0], range[1]
                    );
                    return Err(Error::new(Status::NoSolution, reason).at(format!("lengths[{k}]")));
                }
                if root.is_none() {
                    result.projected.push(k);
                }
                let found = root.or_else(|| least(&trials, &at, &|section| misfit(section).abs()));
                let found = found.ok_or_else(degenerate)?;
                result.deviations.push(misfit(&found).abs());
                found
            }
            Target::Curve(curve) => {
                let distance = |section: &Self| curve.nearest(section.end()).distance;
                let found = least(&trials, &at, &distance).ok_or_else(degenerate)?;
                result.deviations.push(distance(&found));
                found
            }
        };
        let length = found.length();
        result.attainable.push([range[0].min(length), range[1].max(length)]);
        result.lengths.push(length);
        Ok(found)
    }
}

type At<'a> = dyn Fn(f64) -> Option<Section> + 'a;

/// Among the roots of `misfit` that the trials bracket, the one whose border edge is nearest to the guide's in length.
fn root(trials: &[(f64, Section)], at: &At<'_>, misfit: &dyn Fn(&Section) -> f64, guide_edge: f64) -> Option<Section> {
    let border = |section: &Section| section.canal[section.canal.len() - 1];
    // The border of the section before is where the arc starts.
    let start = border(&trials[0].1);
    let unlike = |section: &Section| (border(section).distance(start) / guide_edge).ln().abs();
    let brackets = trials.windows(2).filter(|pair| misfit(&pair[0].1) * misfit(&pair[1].1) <= 0.0);
    let best = brackets.min_by(|a, b| unlike(&a[1].1).total_cmp(&unlike(&b[1].1)))?;
    // False position with the Illinois rule: an end that stays has its value halved.
    let (mut a, mut b) = (best[0].0, best[1].0);
    let (mut at_a, mut at_b) = (misfit(&best[0].1), misfit(&best[1].1));
    let mut found = if at_a.abs() <= at_b.abs() { at(a)? } else { at(b)? };
    let mut least = at_a.abs().min(at_b.abs());
    for _ in 0..MOST_HALVINGS {
        let met = (a * at_b - b * at_a) / (at_b - at_a);
        let c = if (met - a) * (met - b) < 0.0 { met } else { 0.5 * (a + b) };
        if c == a || c == b || least == 0.0 {
            break;
        }
        let section = at(c)?;
        let at_c = misfit(&section);
        if at_c.abs() < least {
            (found, least) = (section, at_c.abs());
        }
        if at_c * at_b < 0.0 {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (c, at_c);
    }
    Some(found)
}

/// The section of the least `cost`: the best trial that is better than both neighbours, and from there by golden section between
/// these. Only where there is none, the best trial at an end: for a second curve the cost falls towards the far end of the section
/// before, which is on it.
fn least(trials: &[(f64, Section)], at: &At<'_>, cost: &dyn Fn(&Section) -> f64) -> Option<Section> {
    let costs: Vec<f64> = trials.iter().map(|(_, section)| cost(section)).collect();
    let is_dip = |&i: &usize| i > 0 && i + 1 < costs.len() && costs[i] < costs[i - 1] && costs[i] <= costs[i + 1];
    let best_of = |i: &mut dyn Iterator<Item = usize>| i.min_by(|&a, &b| costs[a].total_cmp(&costs[b]));
    let best = best_of(&mut (0..costs.len()).filter(is_dip)).or_else(|| best_of(&mut (0..costs.len())))?;
    let (mut low, mut high) = (trials[best.saturating_sub(1)].0, trials[(best + 1).min(trials.len() - 1)].0);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut found = at(trials[best].0)?;
    let mut least = costs[best];
    while high - low > 1e-12 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        let [first, second] = [at(a)?, at(b)?];
        let costs = [cost(&first), cost(&second)];
        for (section, cost) in [first, second].into_iter().zip(costs) {
            if cost < least {
                (found, least) = (section, cost);
            }
        }
        if costs[0] <= costs[1] { high = b } else { low = a }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::geometry::canal::quality::{Quality, largest};
    use crate::mesh::curve::Spline;
    use crate::mesh::fit::Plane;

    fn go_on(_: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// A curve in space that starts along +y, a little over 5 long.
    fn guide(count: usize) -> Vec<DVec3> {
        let at = |s: f64| DVec3::new(0.8 * (s * s - 0.1 * s * s * s), 2.0 * s, 0.2 * s * s);
        (0..=count).map(|k| at(2.0 * k as f64 / count as f64)).collect()
    }

    /// Part of an ellipse in the xz-plane, from the origin.
    fn ellipse(count: usize, height: f64) -> Vec<DVec3> {
        let at = |angle: f64| DVec3::new(-1.0 + angle.cos(), 0.0, height * angle.sin());
        (0..=count).map(|j| at(0.8 * PI * j as f64 / count as f64)).collect()
    }

    fn chord(section: &[DVec3]) -> f64 {
        section[0].distance(section[section.len() - 1])
    }

    fn worst(grid: &Grid) -> f64 {
        let quality = Quality::of(grid);
        largest(&quality.planarity).max(largest(&quality.concyclicity))
    }

    #[test]
    fn the_section_on_a_circle_is_its_own_canal_surface() {
        for section in [ellipse(9, 1.0), {
            let mut uneven = ellipse(12, 1.0);
            uneven.remove(4);
            uneven.remove(7);
            uneven
        }] {
            let lengths = vec![chord(&section); 17];
            let found = c_canal(&guide(16), &section, Target::Lengths(&lengths), false, &mut go_on).unwrap();
            let (base, net) = (found.surface.base().grid(), found.surface.net().grid());
            let moved = base.points().iter().zip(net.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(moved < 1e-12, "{moved}");
            assert!(found.residual() < 1e-24);
        }
    }

    #[test]
    fn sections_are_planar_and_parallel_in_planes_and_have_the_lengths_asked_for() {
        for n in [8, 16, 32, 64] {
            for height in [0.6, 1.0, 1.7] {
                let (guide, section) = (guide(n), ellipse(11, height));
                let lengths = vec![chord(&section); n + 1];
                let found = c_canal(&guide, &section, Target::Lengths(&lengths), false, &mut go_on).unwrap();
                let grid = found.surface.net().grid();
                for k in 0..=n {
                    assert!(grid.at(k, 0).distance(guide[k]) < 1e-12);
                    let row = grid.row(k);
                    let plane = Plane::fitting(row);
                    assert!(row.iter().all(|&point| plane.height(point).abs() < 1e-10));
                    assert!((chord(row) - lengths[k]).abs() < 1e-12, "{n} {height} {k}: {}", chord(row) - lengths[k]);
                }
                assert!(grid.row(0).iter().zip(&section).all(|(a, b)| a.distance(*b) < 1e-10));
                assert!(worst(grid) < 1e-10, "{}", worst(grid));
                assert!(worst(found.surface.base().grid()) < 1e-11);
                assert_eq!(Quality::of(grid).crossed_count(), 0);
                assert_eq!(found.surface.family(), "C-canal");
                // An arc over a chord c of a curve of radius r is about c²/8r off it: here c is 0.25 or less, r 0.3 or more.
                let distance = found.section_distance(4).unwrap();
                assert!(distance > 1e-4 && distance < 0.1, "{distance}");
            }
        }
    }

    #[test]
    fn a_length_that_is_not_attainable_is_refused_with_the_interval_or_replaced() {
        let (guide, section) = (guide(16), ellipse(11, 0.7));
        let lengths: Vec<f64> = (0..17).map(|k| chord(&section) * (1.0 + 0.2 * k as f64)).collect();
        let error = c_canal(&guide, &section, Target::Lengths(&lengths), false, &mut go_on).unwrap_err();
        assert_eq!(error.status(), Status::NoSolution);
        assert!(error.place().starts_with("lengths[") && error.to_string().contains("is not attainable"), "{error}");
        let found = c_canal(&guide, &section, Target::Lengths(&lengths), true, &mut go_on).unwrap();
        assert!(!found.projected.is_empty());
        for &k in &found.projected {
            let [low, high] = found.attainable[k];
            assert!(found.lengths[k] <= high + 1e-9 && found.lengths[k] >= low - 1e-9);
            assert!((found.lengths[k] - high).abs() < 1e-6, "the nearest is the greatest");
            assert!((found.deviations[k] - (lengths[k] - found.lengths[k])).abs() < 1e-12);
        }
        assert!(worst(found.surface.net().grid()) < 1e-9);
    }

    #[test]
    fn far_ends_come_as_near_to_a_second_curve_as_any_trial() {
        let (guide, section) = (guide(24), ellipse(11, 0.7));
        let lengths = vec![chord(&section); 25];
        let known = c_canal(&guide, &section, Target::Lengths(&lengths), false, &mut go_on).unwrap();
        // The curve through the far ends of a C-canal surface: found again.
        let ends = known.surface.net().grid().column(11);
        let curve = Spline::through(&ends, false).unwrap();
        let nearest = NearestOnCurve::new(&curve).unwrap();
        let found = c_canal(&guide, &section, Target::Curve(&nearest), false, &mut go_on).unwrap();
        assert!(largest(&found.deviations) < 1e-6, "{:?}", found.deviations);
        // Another curve beside it: no place of a far end is nearer.
        let moved: Vec<DVec3> = ends.iter().map(|&end| end + DVec3::new(-0.1, 0.0, 0.05)).collect();
        let curve = Spline::through(&moved, false).unwrap();
        let nearest = NearestOnCurve::new(&curve).unwrap();
        let found = c_canal(&guide, &section, Target::Curve(&nearest), false, &mut go_on).unwrap();
        assert!(largest(&found.deviations) < 0.2 && worst(found.surface.net().grid()) < 1e-9);
    }

    #[test]
    fn bad_sections_are_refused_where_they_err() {
        let guide = guide(4);
        let refusal = |section: &[[f64; 3]]| {
            let section: Vec<DVec3> = section.iter().map(|&point| DVec3::from_array(point)).collect();
            let lengths = vec![chord(&section); 5];
            let error = c_canal(&guide, &section, Target::Lengths(&lengths), false, &mut go_on).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let o = [0.0; 3];
        let section = |j: usize| format!("section[{j}]");
        assert_eq!(refusal(&[o, [-1.0, 0.0, 1.0]]), (Status::InvalidArgumentLength, "section".into()));
        assert_eq!(refusal(&[o, [-0.5, 0.0, 1.0], [-1.0, 0.3, 1.2], [-2.0, 0.0, 0.5]]).0, Status::NotPlanar);
        assert_eq!(refusal(&[o, [0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [-1.0, 0.0, 3.0]]), (Status::Degenerate, section(1)));
        let bent = [o, [0.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [-1.0, 0.0, 2.0], [-3.0, 0.0, 1.0]];
        assert_eq!(refusal(&bent), (Status::InvalidValue, section(2)));
        // Turns of 0.1, 1.4 and 0.1: edges in pairs span at most 0.2, yet two neighbours must span 2.8.
        let mut uneven = vec![o];
        for angle in [FRAC_PI_2, FRAC_PI_2 + 0.1, FRAC_PI_2 + 1.5, FRAC_PI_2 + 1.6_f64] {
            let [x, _, z] = uneven[uneven.len() - 1];
            uneven.push([x + angle.cos(), 0.0, z + angle.sin()]);
        }
        let (status, place) = refusal(&uneven);
        assert!(status == Status::InvalidValue && place.starts_with("section["), "{status:?} {place}");
        assert_eq!(refusal(&[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 1.0]]), (Status::InvalidValue, section(0)));
        assert_eq!(refusal(&[o, o, [-1.0, 0.0, 1.0]]), (Status::Degenerate, section(1)));
        assert_eq!(refusal(&[o, [f64::NAN, 0.0, 0.0], [-1.0, 0.0, 1.0]]), (Status::InvalidValue, section(1)));
        let ellipse = ellipse(5, 0.7);
        let place = |lengths: &[f64]| {
            c_canal(&guide, &ellipse, Target::Lengths(lengths), false, &mut go_on).unwrap_err().place().to_owned()
        };
        assert_eq!([place(&[1.0; 4]), place(&[1.0; 5]), place(&[-1.0; 5])], ["lengths", "lengths[0]", "lengths[0]"]);
    }

    #[test]
    fn a_cancelled_run_has_the_sections_so_far() {
        let section = ellipse(7, 0.7);
        let lengths = vec![chord(&section); 17];
        let mut stop = |done: f64| if done > 0.3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let found = c_canal(&guide(16), &section, Target::Lengths(&lengths), false, &mut stop).unwrap();
        assert!(found.is_cancelled);
        assert_eq!((found.surface.net().grid().rows(), found.lengths.len()), (6, 6));
    }
}
