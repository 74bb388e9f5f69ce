//! Signs for asymptotic directions: from a field of lines to a [`Field`] of vectors.
//!
//! An asymptotic direction is a line, and either of its unit vectors is as good. A function whose level sets are to cross the
//! lines needs vectors that agree. Two neighbours are compared by turning the tangent plane of one into that of the other, by
//! the least rotation, which takes normal to normal; the surer comparisons, those near ±1, are heeded first: along a maximum
//! spanning tree. Whatever edge is left then disagrees only if no choice of signs agrees everywhere: the lines turn by an odd
//! number of half turns around a flat point, as on the monkey saddle, or around a hole.

use glam::DVec3;

use super::Field;
use super::asymptotic::{AsymptoticDirections, PointStatus};
use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;

/// Neighbours whose vectors have a product within this of 0 tell nothing about their signs: they are 73° apart or more.
const UNSURE: f64 = 0.3;

/// A hint, or an axis, must be met by this part of the vectors' lengths for it to choose the sign.
const NO_SIGN: f64 = 1e-3;

/// How signs are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The vectors of each part of the mesh point this way on the whole. Without a hint, or where they are orthogonal to it, they
    /// point along x on the whole, or where this tells nothing y, or z.
    pub hint: Option<DVec3>,
    /// Whether signs may disagree across some edges if they must.
    pub allow_cut: bool,
}

/// A field, and where its signs disagree.
#[derive(Clone, Debug, PartialEq)]
pub struct Oriented {
    /// The vectors.
    pub field: Field,
    /// The edges across which the vector flips though the line does not, in the order of the mesh's edges. Empty unless a cut was
    /// allowed, save for edges across which even the line is unsure.
    ///
    /// There is no function whose gradient follows a field with flips. What is asked of a gradient must not depend on signs
    /// then, in every triangle: `∇f × a = 0`, not `∇f = a`, along with a term that keeps `f` from being constant. [`Field::at`]
    /// is a unit vector of the line in triangles with a flip too.
    pub flips: Vec<[u32; 2]>,
}

impl AsymptoticDirections {
    /// Gives the directions of a family signs that agree. Masked points have no direction, and parts of the mesh between which
    /// there are only such points are parts of their own.
    ///
    /// # Errors
    /// Not as many points as the mesh that directions were found on (`mesh`), `family` is not 0 or 1, or `hint` is no direction.
    /// Status `NotOrientable`: no signs agree across the edge named, and a cut is not allowed (`mesh`).
    pub fn orient(&self, mesh: &TriangleMesh, family: usize, options: &Options) -> Result<Oriented> {
        if mesh.points().len() != self.status().len() {
            let reason = format!("expected the mesh of {} points, found {}", self.status().len(), mesh.points().len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("mesh"));
        }
        let normals: Vec<DVec3> = self.curvatures().iter().map(|curvature| curvature.normal).collect();
        let is_known = self.status().iter().map(|status| *status == PointStatus::Good).collect();
        orient(mesh, &normals, self.family(family)?.to_vec(), is_known, options)
    }
}

/// Two neighbours and the product of their vectors.
struct Pair {
    edge: [u32; 2],
    product: f64,
}

fn orient(
    mesh: &TriangleMesh,
    normals: &[DVec3],
    mut directions: Vec<DVec3>,
    is_known: Vec<bool>,
    options: &Options,
) -> Result<Oriented> {
    let hint = options.hint.map(|hint| {
        let unit = if hint.is_finite() { hint.try_normalize() } else { None };
        let reason = || format!("expected a finite vector that is not 0, found {hint}");
        unit.ok_or_else(|| Error::new(Status::InvalidValue, reason()).at("hint"))
    });
    let hint = hint.transpose()?;
    let mut pairs: Vec<Pair> = Vec::new();
    for edge @ [i, j] in mesh.edges() {
        let [i, j] = [i as usize, j as usize];
        if is_known[i] && is_known[j] {
            let product = turned(directions[i], normals[i], normals[j]).dot(directions[j]);
            pairs.push(Pair { edge, product });
        }
    }
    let signs = Signs::along_spanning_tree(directions.len(), &pairs);
    let roots: Vec<(usize, bool)> = (0..directions.len()).map(|i| signs.root(i)).collect();
    for (direction, (_, is_turned)) in directions.iter_mut().zip(&roots) {
        *direction = if *is_turned { -*direction } else { *direction };
    }
    let is_flip = |pair: &&Pair| {
        let [i, j] = pair.edge.map(|i| roots[i as usize].1);
        (pair.product < 0.0) != (i != j)
    };
    let sure = pairs.iter().filter(is_flip).find(|pair| pair.product.abs() > UNSURE);
    if let (Some(Pair { edge: [i, j], .. }), false) = (sure, options.allow_cut) {
        let reason = format!(
            "expected lines that can be given signs, found that they turn by half a turn around a flat point or a hole: signs \
             disagree across the edge from point {i} to point {j}"
        );
        return Err(Error::new(Status::NotOrientable, reason).at("mesh"));
    }
    let flips = pairs.iter().filter(is_flip).map(|pair| pair.edge).collect();
    choose_signs(&mut directions, &is_known, &roots, hint);
    Ok(Oriented { field: Field::new(mesh, directions, is_known)?, flips })
}

/// The tangent vector `a` turned by the least rotation that takes the unit vector `from` to `to`: by as much as it is out of the
/// tangent plane of `to`, along `from + to`. Opposite normals have no least rotation; then `a` is left as it is.
fn turned(a: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let factor = 1.0 + from.dot(to);
    if factor < 1e-9 { a } else { a - (a.dot(to) / factor) * (from + to) }
}

/// For each point another one, nearer to the root of its tree, and whether its vector is turned against that one's.
struct Signs {
    parents: Vec<(u32, bool)>,
}

impl Signs {
    /// Kruskal's algorithm. Of edges with products of one size the first is taken first.
    fn along_spanning_tree(count: usize, pairs: &[Pair]) -> Self {
        let mut order: Vec<u32> = (0..pairs.len() as u32).collect();
        let size = |k: &u32| pairs[*k as usize].product.abs();
        order.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let mut signs = Self { parents: (0..count as u32).map(|i| (i, false)).collect() };
        let mut sizes = vec![1_u32; count];
        for Pair { edge: [i, j], product } in order.iter().map(|&k| &pairs[k as usize]) {
            let ((i, i_turned), (j, j_turned)) = (signs.root(*i as usize), signs.root(*j as usize));
            if i == j {
                continue;
            }
            // The smaller tree below the larger: no point is then more than log2 of all from its root.
            let (below, above) = if sizes[i] < sizes[j] { (i, j) } else { (j, i) };
            sizes[above] += sizes[below];
            signs.parents[below] = (above as u32, (*product < 0.0) != (i_turned != j_turned));
        }
        signs
    }

    /// The root of a point's tree, and whether its vector is turned against the root's.
    fn root(&self, mut point: usize) -> (usize, bool) {
        let mut is_turned = false;
        while self.parents[point].0 as usize != point {
            let (parent, turns) = self.parents[point];
            (point, is_turned) = (parent as usize, is_turned != turns);
        }
        (point, is_turned)
    }
}

/// Turns all vectors of a tree that do not point the way they should.
fn choose_signs(directions: &mut [DVec3], is_known: &[bool], roots: &[(usize, bool)], hint: Option<DVec3>) {
    let mut sums = vec![(DVec3::ZERO, 0.0); directions.len()];
    for i in (0..directions.len()).filter(|&i| is_known[i]) {
        sums[roots[i].0].0 += directions[i];
        sums[roots[i].0].1 += 1.0;
    }
    let ways: Vec<DVec3> = hint.into_iter().chain([DVec3::X, DVec3::Y, DVec3::Z]).collect();
    let points_against = |&(sum, count): &(DVec3, f64)| {
        ways.iter().map(|way| way.dot(sum)).find(|along| along.abs() > NO_SIGN * count).is_some_and(|along| along < 0.0)
    };
    let is_against: Vec<bool> = sums.iter().map(points_against).collect();
    for (direction, (root, _)) in directions.iter_mut().zip(roots) {
        *direction = if is_against[*root] { -*direction } else { *direction };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::asymptotic;
    use crate::mesh::Mesh;
    use crate::mesh::grid::Grid;
    use crate::mesh::patterns::height_field;

    fn directions(mesh: &Mesh) -> (TriangleMesh, AsymptoticDirections) {
        let mesh = TriangleMesh::new(mesh).unwrap();
        let found = AsymptoticDirections::new(&mesh, &asymptotic::Options::default()).unwrap();
        (mesh, found)
    }

    /// Columns around, rows outward or upward.
    fn tube(columns: usize, rows: usize, point: impl Fn(f64, f64) -> DVec3) -> Mesh {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * (i % columns) as f64 / columns as f64;
            point(angle, (i / columns) as f64 / (rows - 1) as f64)
        };
        Grid::new((0..columns * rows).map(at).collect(), rows, columns, [false, true]).unwrap().mesh()
    }

    fn agree(mesh: &TriangleMesh, field: &Field) -> bool {
        mesh.edges().iter().all(|edge| {
            let [a, b] = edge.map(|i| field.directions()[i as usize]);
            a.dot(b) > 0.0
        })
    }

    #[test]
    fn neighbours_agree_and_the_hint_chooses() {
        let (mesh, found) = directions(&height_field(21, 21, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
        for (family, along) in [(0, DVec3::Y), (1, DVec3::X)] {
            for hint in [along, -along] {
                let options = Options { hint: Some(hint + DVec3::new(0.1, 0.1, 5.0)), ..Options::default() };
                let oriented = found.orient(&mesh, family, &options).unwrap();
                assert!(oriented.flips.is_empty() && agree(&mesh, &oriented.field));
                assert!(oriented.field.directions().iter().all(|a| a.dot(hint) > 0.5));
            }
            let without = found.orient(&mesh, family, &Options::default()).unwrap();
            assert!(without.field.directions().iter().all(|a| a.dot(along) > 0.5));
        }
    }

    #[test]
    fn the_signs_given_do_not_matter() {
        let (mesh, found) = directions(&height_field(12, 9, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y + 0.2 * x).unwrap());
        let normals: Vec<DVec3> = found.curvatures().iter().map(|c| c.normal).collect();
        let orient = |directions: Vec<DVec3>| {
            let known = vec![true; directions.len()];
            orient(&mesh, &normals, directions, known, &Options::default()).unwrap()
        };
        let family = found.family(0).unwrap();
        let scrambled = family.iter().enumerate().map(|(i, &a)| if i * i % 7 < 3 { -a } else { a });
        assert_eq!(orient(scrambled.collect()), orient(family.to_vec()));
    }

    #[test]
    fn a_whole_hyperboloid_is_oriented_around_and_parts_each_for_themselves() {
        let hyperboloid = |shift: f64| {
            tube(60, 21, move |angle, t| {
                let z = 2.0 * t - 1.0;
                let r = (1.0 + z * z).sqrt();
                DVec3::new(r * angle.cos() + shift, r * angle.sin(), z)
            })
        };
        let (mut two, other) = (hyperboloid(0.0), hyperboloid(5.0));
        let count = two.points.len() as u32;
        two.points.extend(other.points);
        two.faces.extend(other.faces.iter().map(|face| face.iter().map(|i| i + count).collect()));
        let (mesh, found) = directions(&two);
        assert_eq!(mesh.components().1, 2);
        for family in 0..2 {
            let oriented = found.orient(&mesh, family, &Options::default()).unwrap();
            assert!(oriented.flips.is_empty() && agree(&mesh, &oriented.field));
            // Around, x and y even out: z is what decides.
            assert!(oriented.field.directions().iter().all(|a| a.z > 0.3));
        }
    }

    #[test]
    fn the_monkey_saddle_has_no_signs_and_every_loop_around_it_an_odd_number_of_flips() {
        let n = 21;
        let monkey = |x: f64, y: f64| x * x * x - 3.0 * x * y * y;
        let (mesh, found) = directions(&height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], monkey).unwrap());
        assert!((1..10).contains(&found.masked_count()), "{}", found.masked_count());
        assert_eq!(found.status()[n * n / 2], PointStatus::NotNegative);
        for family in 0..2 {
            let refusal = found.orient(&mesh, family, &Options::default()).unwrap_err();
            assert_eq!((refusal.status(), refusal.place()), (Status::NotOrientable, "mesh"));
            assert!(refusal.to_string().contains("edge from point"), "{refusal}");
            let options = Options { allow_cut: true, ..Options::default() };
            let Oriented { field, flips } = found.orient(&mesh, family, &options).unwrap();
            let is_flip = |a: usize, b: usize| flips.contains(&[a.min(b) as u32, a.max(b) as u32]);
            for distance in 3..=n / 2 {
                let (low, high) = (n / 2 - distance, n / 2 + distance);
                let mut around: Vec<usize> = (low..high).map(|i| low * n + i).collect();
                around.extend((low..high).map(|i| i * n + high));
                around.extend((low + 1..=high).rev().map(|i| high * n + i));
                around.extend((low + 1..=high).rev().map(|i| i * n + low));
                let steps = (0..around.len()).map(|k| [around[k], around[(k + 1) % around.len()]]);
                for [a, b] in steps.clone() {
                    let product = field.directions()[a].dot(field.directions()[b]);
                    assert_eq!(product < 0.0, is_flip(a, b));
                }
                assert_eq!(steps.filter(|[a, b]| is_flip(*a, *b)).count() % 2, 1);
            }
            // The line is one all the same.
            for t in 0..mesh.triangles().len() {
                let corners = mesh.triangles()[t].map(|i| field.directions()[i as usize]);
                let apart = (0..3).map(|k| corners[k].dot(corners[(k + 1) % 3]).abs()).fold(1.0, f64::min);
                if let (Some(line), true) = (field.on_triangle(&mesh, t), apart > 0.8) {
                    assert!(corners.iter().all(|corner| corner.dot(line).abs() > 0.6));
                }
            }
        }
    }

    #[test]
    fn lines_around_a_hole_have_signs_after_whole_turns_only() {
        let ring = |angle: f64, t: f64| (1.0 + t) * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let mesh = TriangleMesh::new(&tube(40, 6, ring)).unwrap();
        let count = mesh.points().len();
        let lines = |half_turns: f64| {
            let line = |p: &DVec3| {
                let angle = 0.5 * half_turns * p.y.atan2(p.x);
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            };
            let directions = mesh.points().iter().map(line).collect();
            orient(&mesh, &vec![DVec3::Z; count], directions, vec![true; count], &Options::default())
        };
        for half_turns in -4..=4 {
            match lines(f64::from(half_turns)) {
                Ok(oriented) => assert!(half_turns % 2 == 0 && oriented.flips.is_empty()),
                Err(error) => assert!(half_turns % 2 != 0 && error.status() == Status::NotOrientable),
            }
        }
    }

    #[test]
    fn bad_input_is_named() {
        let (mesh, found) = directions(&height_field(6, 6, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
        let hinted = |hint| found.orient(&mesh, 0, &Options { hint: Some(hint), ..Options::default() });
        assert_eq!(hinted(DVec3::ZERO).unwrap_err().place(), "hint");
        assert_eq!(hinted(DVec3::new(f64::NAN, 0.0, 1.0)).unwrap_err().place(), "hint");
        assert_eq!(found.orient(&mesh, 2, &Options::default()).unwrap_err().place(), "family");
        let (other, _) = directions(&height_field(7, 6, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
        assert_eq!(found.orient(&other, 0, &Options::default()).unwrap_err().place(), "mesh");
    }
}
