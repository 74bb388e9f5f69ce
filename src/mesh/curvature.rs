//! Curvature of the surface that a triangle mesh samples, by a polynomial fitted around each point.
//!
//! In a frame `(e1, e2, n)` at a point the surface is a height over its tangent plane. To the neighbours is fitted the jet
//!
//! ```text
//! z(x, y) = g1 x + g2 y + ½ a x² + b x y + ½ c y² + four terms of degree 3 + five of degree 4,
//! ```
//!
//! which goes through the point itself (Cazals and Pouget 2005, "Estimating differential quantities using polynomial fitting of
//! osculating jets"), by least squares with weights `exp(−r²/R²)`, where `R` is the distance of the farthest neighbour.
//! Coordinates are in units of `R`, so that columns are of one size at any scale. Where the frame's normal is that of the
//! surface, `g = 0` and `[[a, b], [b, c]]` is the second fundamental form. The normal is not known to begin with: the frame is
//! turned by the slope found, `n ← unit(n − g1 e1 − g2 e2)`, and the jet fitted anew, three times in all.
//!
//! Neighbours are gathered ring by ring. With 30 of them asymptotic directions were found to converge in third order in the edges at
//! least, at the boundary too, where all neighbours are on one side; with 24 they did not everywhere there. Jets of degree 3, to 18
//! neighbours, converge in second order: on a catenoid of 41 by 41 points directions were off by 1.7e-3 inside and 7.9e-3 at the
//! boundary, those of degree 4 by 1.0e-4 and 8.8e-4.

use glam::DVec3;
use rayon::prelude::*;

use super::TriangleMesh;
use crate::error::{Error, Result, Status};
use crate::linalg::householder::{solve, triangularise};

/// How often the jet is fitted, each time over the tangent plane of the fit before.
const FITS: usize = 3;

/// Terms of the jet of degree 2, 3 and 4.
const QUADRATIC: usize = 5;
const CUBIC: usize = 9;
const QUARTIC: usize = 14;

/// With fewer neighbours than this jets are of degree 3: at the boundary those of degree 4 would be off by any angle.
const QUARTIC_NEIGHBOURS: usize = 28;

/// A term counts as told apart by the neighbours where, of its column, more than this is left beside the columns before it.
/// Noise in the heights comes out larger by the reciprocal.
const INDEPENDENT: f64 = 1e-5;

/// The last ring is thinned, evenly, if it brings more than this: a point with thousands of triangles would otherwise make each
/// of its neighbours cost as much as the whole mesh.
const MOST_NEIGHBOURS: usize = 96;

/// How the jets are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Rings of neighbours are added until there are so many, 5 to 96; 30 by default. From 28 on jets are of degree 4, from 9 on of
    /// degree 3, below of degree 2.
    pub least_neighbours: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { least_neighbours: 30 }
    }
}

/// How much of the jet was found at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// All of it.
    Quartic,
    /// The neighbours are few or do not tell terms of degree 4 apart: they were left out, and curvatures are of second order in the
    /// edges.
    Cubic,
    /// The neighbours do not tell terms of degree 3 apart either: curvatures are of first order in the edges.
    Quadratic,
    /// The neighbours do not determine curvatures: those given are 0. The normal is that of the triangles.
    Degenerate,
}

/// What the surface does at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// The unit normal, on the side of that of the triangles.
    pub normal: DVec3,
    /// The principal curvatures, the greater first, in 1/model units; positive where the surface bends towards the normal.
    pub principal: [f64; 2],
    /// Their unit directions; with the normal they are a right-handed frame.
    pub directions: [DVec3; 2],
    /// How much of the jet was found.
    pub fit: Fit,
}

impl Curvature {
    /// The Gaussian curvature, in 1/square model units.
    pub fn gaussian(&self) -> f64 {
        self.principal[0] * self.principal[1]
    }

    /// The second fundamental form of two tangent vectors.
    pub fn second_form(&self, a: DVec3, b: DVec3) -> f64 {
        (0..2).map(|k| self.principal[k] * self.directions[k].dot(a) * self.directions[k].dot(b)).sum()
    }

    /// The geodesic torsion `II(d, n × d)` of the surface along a unit tangent vector, in 1/model units: how fast the tangent
    /// plane turns about it, positive like a right-handed screw. Neither `d → −d` nor `n → −n` changes it.
    pub fn torsion(&self, direction: DVec3) -> f64 {
        self.second_form(direction, self.normal.cross(direction))
    }

    fn degenerate(normal: DVec3) -> Self {
        let (first, second) = normal.any_orthonormal_pair();
        Self { normal, principal: [0.0; 2], directions: [first, second], fit: Fit::Degenerate }
    }
}

/// The curvature at each point of a mesh. In parallel; the same bits for any number of threads.
///
/// # Errors
/// `least_neighbours` is out of its range.
pub fn curvatures(mesh: &TriangleMesh, options: &Options) -> Result<Vec<Curvature>> {
    if !(QUADRATIC..=MOST_NEIGHBOURS).contains(&options.least_neighbours) {
        let reason = format!("expected {QUADRATIC} to {MOST_NEIGHBOURS}, found {}", options.least_neighbours);
        return Err(Error::new(Status::InvalidValue, reason).at("least_neighbours"));
    }
    let count = mesh.points().len();
    let scratch = || Scratch { stamps: vec![0; count], ..Scratch::default() };
    let work = |scratch: &mut Scratch, point: usize| scratch.curvature(mesh, point, options.least_neighbours);
    // Pieces of work are so large that the stamps of each are paid off.
    Ok((0..count).into_par_iter().with_min_len(count / 64 + 256).map_init(scratch, work).collect())
}

/// One row of the least squares problem: the terms of the jet at a neighbour, by degree so that the leading ones can be
/// fitted alone, then its height; all times its weight's root.
type Row = [f64; QUARTIC + 1];

#[derive(Default)]
struct Scratch {
    /// The last point, plus 1, that each point was a neighbour of.
    stamps: Vec<u32>,
    neighbours: Vec<u32>,
    /// From the point to each neighbour, over the greatest of these distances, and the root of its weight.
    sides: Vec<(DVec3, f64)>,
    rows: Vec<Row>,
}

/// The coefficients of a jet, in the units that were fitted.
struct Jet {
    slope: [f64; 2],
    second: [f64; 3],
    fit: Fit,
}

impl Scratch {
    fn curvature(&mut self, mesh: &TriangleMesh, point: usize, least: usize) -> Curvature {
        self.gather(mesh, point, least);
        let at = mesh.points()[point];
        let farthest = self.neighbours.iter().map(|&i| mesh.points()[i as usize].distance(at)).fold(0.0, f64::max);
        self.sides.clear();
        self.sides.extend(self.neighbours.iter().map(|&i| {
            let side = (mesh.points()[i as usize] - at) / farthest;
            (side, (-0.5 * side.length_squared()).exp())
        }));
        let first = mesh.point_normals()[point];
        let mut normal = first;
        let mut found = None;
        for pass in 0..FITS {
            let (e1, e2) = normal.any_orthonormal_pair();
            let Some(jet) = self.fit([e1, e2, normal]) else { return Curvature::degenerate(first) };
            if pass + 1 < FITS {
                let turned = normal - jet.slope[0] * e1 - jet.slope[1] * e2;
                let Some(turned) = turned.try_normalize() else { return Curvature::degenerate(first) };
                normal = turned;
            }
            found = Some((jet, e1, e2));
        }
        let is_sound = |c: &Curvature| c.principal.iter().all(|k| k.is_finite()) && c.normal.dot(first) > 0.0;
        let found = found.map(|(jet, e1, e2)| principal(jet, [e1, e2, normal], farthest));
        found.filter(is_sound).unwrap_or_else(|| Curvature::degenerate(first))
    }

    /// Ring by ring, in an order that the mesh alone determines.
    fn gather(&mut self, mesh: &TriangleMesh, point: usize, least: usize) {
        self.neighbours.clear();
        self.stamps[point] = point as u32 + 1;
        self.add_around(mesh, point, point);
        let mut ring = 0..self.neighbours.len();
        while self.neighbours.len() < least && !ring.is_empty() {
            for j in ring.clone() {
                self.add_around(mesh, self.neighbours[j] as usize, point);
            }
            ring = ring.end..self.neighbours.len();
        }
        if self.neighbours.len() > MOST_NEIGHBOURS {
            let kept = MOST_NEIGHBOURS - ring.start;
            for j in 0..kept {
                self.neighbours[ring.start + j] = self.neighbours[ring.start + j * ring.len() / kept];
            }
            self.neighbours.truncate(MOST_NEIGHBOURS);
        }
    }

    fn add_around(&mut self, mesh: &TriangleMesh, center: usize, point: usize) {
        let stamp = point as u32 + 1;
        for &i in mesh.fan(center).iter().flat_map(|&t| &mesh.triangles()[t as usize]) {
            if self.stamps[i as usize] != stamp {
                self.stamps[i as usize] = stamp;
                self.neighbours.push(i);
            }
        }
    }

    fn fit(&mut self, [e1, e2, normal]: [DVec3; 3]) -> Option<Jet> {
        self.rows.clear();
        self.rows.extend(self.sides.iter().map(|&(side, w)| {
            let (x, y, z) = (side.dot(e1), side.dot(e2), side.dot(normal));
            let (xx, xy, yy) = (x * x, x * y, y * y);
            let cubic = [x * xx, xx * y, x * yy, y * yy];
            let [a, b, c, d] = cubic;
            [x, y, 0.5 * xx, xy, 0.5 * yy, a, b, c, d, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy, z]
                .map(|term| w * term)
        }));
        let rank = triangularise(&mut self.rows, INDEPENDENT);
        let terms = match rank {
            QUARTIC if self.sides.len() >= QUARTIC_NEIGHBOURS => QUARTIC,
            CUBIC.. => CUBIC,
            QUADRATIC.. => QUADRATIC,
            _ => return None,
        };
        let [g1, g2, a, b, c, ..] = solve(&self.rows, terms);
        let fit = match terms {
            QUARTIC => Fit::Quartic,
            CUBIC => Fit::Cubic,
            _ => Fit::Quadratic,
        };
        Some(Jet { slope: [g1, g2], second: [a, b, c], fit })
    }
}

/// Curvatures and directions of the form `[[a, b], [b, c]]`, given in units of 1/`unit`.
fn principal(jet: Jet, [e1, e2, normal]: [DVec3; 3], unit: f64) -> Curvature {
    let [a, b, c] = jet.second.map(|entry| entry / unit);
    let (mean, half) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
    let (sine, cosine) = (0.5 * (2.0 * b).atan2(a - c)).sin_cos();
    let directions = [cosine * e1 + sine * e2, cosine * e2 - sine * e1];
    Curvature { normal, principal: [mean + half, mean - half], directions, fit: jet.fit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::patterns::{height_field, parametric_surface};

    const TAU: f64 = std::f64::consts::TAU;

    fn triangles(mesh: &Mesh) -> TriangleMesh {
        TriangleMesh::new(mesh).unwrap()
    }

    fn of(mesh: &TriangleMesh) -> Vec<Curvature> {
        curvatures(mesh, &Options::default()).unwrap()
    }

    /// The largest of `error` over the points inside, and over those on the boundary.
    fn worst(mesh: &TriangleMesh, error: impl Fn(DVec3, &Curvature) -> f64) -> [f64; 2] {
        let mut worst = [0.0_f64; 2];
        for (i, curvature) in of(mesh).iter().enumerate() {
            let on_boundary = usize::from(mesh.is_on_boundary(i));
            worst[on_boundary] = worst[on_boundary].max(error(mesh.points()[i], curvature));
        }
        worst
    }

    #[test]
    fn the_saddle_has_its_curvatures_to_third_order() {
        // z = xy: K = −1/(1 + x² + y²)², H = −xy/(1 + x² + y²)^(3/2) for the normal (−y, −x, 1).
        let error = |n: usize| {
            let mesh = triangles(&height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
            worst(&mesh, |p, c| {
                let w = 1.0 + p.x * p.x + p.y * p.y;
                let mean = 0.5 * (c.principal[0] + c.principal[1]);
                let normal = DVec3::new(-p.y, -p.x, 1.0) / w.sqrt();
                let apart = [c.gaussian() + 1.0 / (w * w), mean + p.x * p.y / w.powf(1.5), c.normal.distance(normal)];
                assert_eq!(c.fit, Fit::Quartic);
                apart.into_iter().fold(0.0, |worst, apart| apart.abs().max(worst))
            })
        };
        let errors = [11, 21, 41].map(error);
        assert!(errors[2][0] < 5e-4 && errors[2][1] < 2.5e-3, "{errors:?}");
        for (coarse, fine) in [(0, 1), (1, 2)] {
            assert!((0..2).all(|k| errors[coarse][k] / errors[fine][k] > 6.0), "{errors:?}");
        }
        // With fewer neighbours jets are of degree 3, and of second order.
        let few = |n: usize| {
            let mesh = triangles(&height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
            let found = curvatures(&mesh, &Options { least_neighbours: 18 }).unwrap();
            let inside = (0..mesh.points().len()).filter(|&i| found[i].fit == Fit::Cubic).map(|i| {
                let p = mesh.points()[i];
                (found[i].gaussian() + 1.0 / (1.0 + p.x * p.x + p.y * p.y).powi(2)).abs()
            });
            inside.fold(0.0, f64::max)
        };
        assert!(few(41) < 1e-2 && few(21) / few(41) > 3.0, "{} {}", few(21), few(41));
    }

    #[test]
    fn a_torus_has_its_principal_curvatures_and_directions_at_any_scale() {
        // Tube 1, ring 3, without its bottom: curvature −1 along the tube, −cos v/(3 + cos v) around, for the normal outward.
        let error = |scale: f64, n: usize| {
            let point =
                |u: f64, v: f64| scale * DVec3::new((3.0 + v.cos()) * u.cos(), (3.0 + v.cos()) * u.sin(), v.sin());
            let mesh = triangles(&parametric_surface(40 * n + 1, 30 * n + 1, [0.0, 3.0], [-2.5, 2.5], point).unwrap());
            let [inside, rim] = worst(&mesh, |p, c| {
                let p = p / scale;
                let outward = DVec3::new(p.x, p.y, 0.0).normalize();
                let normal = p - 3.0 * outward;
                let (cosine, around) = (normal.dot(outward), DVec3::Z.cross(outward));
                let expected = [-cosine / (3.0 + cosine), -1.0];
                let curvature = (0..2).map(|k| (c.principal[k] * scale - expected[k]).abs()).fold(0.0, f64::max);
                assert!((c.directions[0].cross(c.directions[1]) - c.normal).length() < 1e-14);
                curvature.max(c.directions[0].cross(around).length()).max(c.normal.distance(normal))
            });
            [inside, rim]
        };
        for scale in [1e-6, 1.0, 1e6] {
            let (coarse, fine) = (error(scale, 1), error(scale, 2));
            assert!(fine[0] < 2e-2 && fine[1] < 5e-2, "{fine:?}");
            assert!(coarse[0] / fine[0] > 3.3 && coarse[1] / fine[1] > 2.5, "{coarse:?} {fine:?}");
        }
    }

    #[test]
    fn the_torsion_of_a_right_handed_screw_is_positive() {
        // The helicoid (u cos v, u sin v, c v): along the ruling at u the tangent plane turns by −c/(c² + u²), along the helix
        // by as much the other way, and all this does not change with the side that normals are on.
        let c = 0.8;
        let mesh =
            parametric_surface(41, 41, [-1.0, 1.0], [-1.0, 1.0], |u, v| DVec3::new(u * v.cos(), u * v.sin(), c * v));
        let mut mesh = mesh.unwrap();
        for _ in 0..2 {
            let surface = triangles(&mesh);
            for (i, found) in of(&surface).iter().enumerate() {
                let p = surface.points()[i];
                let v = p.z / c;
                let ruling = DVec3::new(v.cos(), v.sin(), 0.0);
                let u = p.dot(ruling);
                let helix = DVec3::new(-u * v.sin(), u * v.cos(), c).normalize();
                let exact = c / (c * c + u * u);
                let tolerance = if surface.is_on_boundary(i) { 3e-2 } else { 1e-2 };
                assert!((found.torsion(ruling) + exact).abs() < tolerance, "{}", found.torsion(ruling) + exact);
                assert!((found.torsion(helix) - exact).abs() < tolerance, "{}", found.torsion(helix) - exact);
            }
            mesh.faces.iter_mut().for_each(|face| face.reverse());
        }
    }

    #[test]
    fn what_does_not_determine_curvatures_says_so() {
        let single = triangles(&height_field(2, 2, [0.0, 1.0], [0.0, 1.0], |x, y| x * y).unwrap());
        assert!(of(&single).iter().all(|c| c.fit == Fit::Degenerate && c.principal == [0.0; 2]));
        // Two rows: y(y − 1) vanishes at all points, and with it goes what tells a jet's terms apart.
        let strip = triangles(&height_field(30, 2, [0.0, 3.0], [0.0, 0.1], |x, y| x * y).unwrap());
        assert!(of(&strip).iter().all(|c| c.fit == Fit::Degenerate && c.normal.is_finite()));
        // Three: y (y − 1) (y − 2) does, so that there are no cubic terms.
        let strip = triangles(&height_field(30, 3, [0.0, 3.0], [-0.1, 0.1], |x, y| x * y).unwrap());
        for (p, c) in strip.points().iter().zip(of(&strip)) {
            let w = 1.0 + p.x * p.x + p.y * p.y;
            assert!(c.fit == Fit::Quadratic && (c.gaussian() + 1.0 / (w * w)).abs() < 0.2, "{c:?}");
        }
        let many = Options { least_neighbours: 97 };
        assert_eq!(curvatures(&single, &many).unwrap_err().place(), "least_neighbours");
        assert_eq!(curvatures(&single, &Options { least_neighbours: 4 }).unwrap_err().place(), "least_neighbours");
    }

    #[test]
    fn a_pole_with_many_triangles_is_fitted_to_some_all_around_it() {
        // A paraboloid z = r²/2 from its apex: both curvatures are 1 there.
        let (rings, spokes) = (3, 3000);
        let mut points = vec![DVec3::ZERO];
        for ring in 1..=rings {
            let r = 0.1 * f64::from(ring);
            points.extend((0..spokes).map(|i| {
                let angle = TAU * f64::from(i) / f64::from(spokes);
                DVec3::new(r * angle.cos(), r * angle.sin(), 0.5 * r * r)
            }));
        }
        let at = |ring: i32, i: i32| (1 + (ring - 1) * spokes + i % spokes) as u32;
        let mut faces: Vec<Vec<u32>> = (0..spokes).map(|i| vec![0, at(1, i), at(1, i + 1)]).collect();
        for ring in 1..rings {
            faces.extend((0..spokes).map(|i| vec![at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)]));
        }
        let mesh = triangles(&Mesh { points, faces });
        let found = of(&mesh);
        assert_eq!(found.len(), mesh.points().len());
        assert!(found.iter().all(|c| c.normal.is_finite() && c.principal.iter().all(|k| k.is_finite())));
        let apex = found[0];
        assert!(
            apex.normal.distance(DVec3::Z) < 1e-9 && apex.principal.iter().all(|k| (k - 1.0).abs() < 1e-9),
            "{apex:?}"
        );
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(one.install(|| of(&mesh)), found);
    }
}
