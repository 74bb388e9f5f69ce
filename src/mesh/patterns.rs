//! Meshes made by rule: quads over a height field, a translation surface, triangles with hexagons, rhombi.
//!
//! All are disks. Points run row by row: y grows from row to row, x along a row, as seen from +z; faces run
//! counterclockwise. For a curved mesh with the faces of a flat one, move its points.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Mesh;
use crate::error::{Error, Result, Status, finite};

/// Vertices of a grid, or hexagons of a pattern, at most: a few gigabytes make it, and indices stay far below 2³².
const MAX_CELLS: usize = 1 << 22;

/// The steps from the center of a hexagon to its corners, counterclockwise from +x, on the lattice of [`on_lattice`].
const CORNERS: [[i64; 2]; 6] = [[1, 0], [0, 1], [-1, 1], [-1, 0], [0, -1], [1, -1]];

/// Quads over the rectangle `x[0]..x[1]` times `y[0]..y[1]`, their vertices at `z = height(x, y)`: `columns * rows`
/// vertices, evenly spaced with the ends included, and `(columns - 1) * (rows - 1)` faces, row by row; all in model
/// units.
///
/// Vertex `row * columns + column`; a face is its corner of least x and y, then the next along x.
///
/// # Errors
/// `columns` or `rows` below 2, or too many; an end that is not finite or not above the other; a height that is not
/// finite (its place is that of the point).
pub fn height_field(
    columns: usize,
    rows: usize,
    x: [f64; 2],
    y: [f64; 2],
    height: impl Fn(f64, f64) -> f64,
) -> Result<Mesh> {
    parametric([columns, rows], [("x", x), ("y", y)], |x, y| DVec3::new(x, y, height(x, y)))
}

/// The surface `point(u, v)` over the rectangle of parameters from `u[0]` to `u[1]` and from `v[0]` to `v[1]`: as
/// [`height_field`], which is the surface `(x, y, height(x, y))`. Columns go along `u`.
///
/// # Errors
/// As [`height_field`].
pub fn parametric_surface(
    columns: usize,
    rows: usize,
    u: [f64; 2],
    v: [f64; 2],
    point: impl Fn(f64, f64) -> DVec3,
) -> Result<Mesh> {
    parametric([columns, rows], [("u", u), ("v", v)], point)
}

fn parametric(
    [columns, rows]: [usize; 2],
    ranges: [(&str, [f64; 2]); 2],
    point: impl Fn(f64, f64) -> DVec3,
) -> Result<Mesh> {
    check_counts(columns, rows, 2)?;
    for (name, ends) in ranges {
        finite(name, ends[0])?;
        finite(name, ends[1])?;
        if ends[1] <= ends[0] {
            let reason = format!("expected the greater end second, found {} and {}", ends[0], ends[1]);
            return Err(Error::new(Status::InvalidValue, reason).at(name));
        }
    }
    // Weighted ends: the last is met to the last bit, a range about 0 is symmetric, and huge ends do not overflow.
    let at = |ends: [f64; 2], i: usize, count: usize| {
        let last = (count - 1) as f64;
        ends[0] * ((count - 1 - i) as f64 / last) + ends[1] * (i as f64 / last)
    };
    let [(_, u), (_, v)] = ranges;
    let point = |i: usize| point(at(u, i % columns, columns), at(v, i / columns, rows));
    let corners = (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column));
    let quad = |i: usize| [i, i + 1, i + columns + 1, i + columns].map(|corner| corner as u32).to_vec();
    let mesh = Mesh { points: (0..columns * rows).map(point).collect(), faces: corners.map(quad).collect() };
    mesh.check()?;
    Ok(mesh)
}

/// `n × n` vertices of the translation surface `p(u, v) = (n/2) (u, v, 0.35 (cos 1.2u + cos 1.5v))`, u and v evenly
/// spaced over `[−1, 1]`: the mesh on which `benches/peers` compares solvers of hard constraints. Order as in
/// [`height_field`].
///
/// A sum of a curve in u and one in v, so that every face is a parallelogram and planar. Edges are about 1 long.
///
/// # Errors
/// `n` below 2, or too large.
pub fn translation_surface(n: usize) -> Result<Mesh> {
    check_count(n, 2, "n")?;
    check_counts(n, n, 2).map_err(|_| too_many(n.saturating_mul(n)).at("n * n"))?;
    let half = 0.5 * n as f64;
    let height = |x: f64, y: f64| 0.35 * half * ((1.2 * (x / half)).cos() + (1.5 * (y / half)).cos());
    height_field(n, n, [-half, half], [-half, half], height)
}

/// Regular hexagons and triangles of side `edge` in the plane z = 0: the trihexagonal tiling (3.6.3.6). Inside, every
/// vertex has valence four, with hexagons and triangles in turn.
///
/// `rows` rows of `columns` hexagons, each row half a hexagon to the right or back to the left, and the triangles that
/// lie between three of these hexagons. Faces: the hexagons row by row, then the triangles row by row.
///
/// # Errors
/// `columns` or `rows` below 2 (hexagons of one row meet at points only), or too many; `edge` not above 0, or not
/// finite.
pub fn tri_hex(columns: usize, rows: usize, edge: f64) -> Result<Mesh> {
    check_counts(columns, rows, 2)?;
    check_length(edge)?;
    let (columns, rows) = (columns as i64, rows as i64);
    // Centers are two steps of the lattice apart. Its rows lean to the right: every second one is put back by a center.
    let is_center = |q: i64, r: i64| (0..rows).contains(&r) && (0..columns).contains(&(q + r / 2));
    let centers = || (0..rows).flat_map(move |r| (0..columns).map(move |column| [column - r / 2, r]));
    let around = |[q, r]: [i64; 2], steps: &[[i64; 2]]| steps.iter().map(|[a, b]| [2 * q + a, 2 * r + b]).collect();
    let mut faces: Vec<Vec<[i64; 2]>> = centers().map(|center| around(center, &CORNERS)).collect();
    for center @ [q, r] in centers().filter(|[q, r]| is_center(q + 1, *r)) {
        if is_center(q + 1, r - 1) {
            faces.push(around(center, &[[1, 0], [1, -1], [2, -1]]));
        }
        if is_center(q, r + 1) {
            faces.push(around(center, &[[1, 0], [1, 1], [0, 1]]));
        }
    }
    on_lattice(&faces, edge, |_| 0.0)
}

/// Rhombi of side `edge`: the rhombille tiling (hexagons cut into three), or lifted, the surface of stacked cubes.
/// Three rhombi meet inside every hexagon and, in turn, six and three at its corners.
///
/// `columns` columns of `rows` hexagons. At `lift` 0 the mesh is flat, with corner angles of 60 and 120 degrees; at 1
/// the faces are squares, three at every vertex of valence three as on a cube; towards √3 they become upright slivers.
/// Faces are planar and sides `edge` long throughout. Faces: the hexagons column by column, three quads each, which
/// begin at the hexagon's center.
///
/// This is how we read the mesh of Fig. 10 of Deng et al. 2015, "a quad mesh with valence three for all interior
/// vertices", where regular faces "induce a cube-like pattern across the surface". To the letter, no such mesh covers a
/// surface: where neighbouring interior vertices have three quads each, these close up as one cube, of six faces. What
/// has corners of cubes all over are these hexagons, whose one interior vertex has valence three; with two thirds of
/// all interior vertices of valence three, the others have valence six, as the mean is four.
///
/// # Errors
/// `columns` or `rows` of 0, or too many; `edge` not above 0; `lift` below 0 or not below √3; either not finite.
pub fn rhombille(columns: usize, rows: usize, edge: f64, lift: f64) -> Result<Mesh> {
    check_counts(columns, rows, 1)?;
    check_length(edge)?;
    finite("lift", lift)?;
    if !(0.0..3.0_f64.sqrt()).contains(&lift) {
        let reason = format!("expected at least 0 and less than the square root of 3, found {lift}");
        return Err(Error::new(Status::InvalidValue, reason).at("lift"));
    }
    // A side of a cube seen along its diagonal rises by edge/√3; what is left of it is horizontal.
    let rise = lift * edge / 3.0_f64.sqrt();
    let run = edge * (1.0 - lift * lift / 3.0).sqrt();
    let (columns, rows) = (columns as i64, rows as i64);
    let centers = (0..columns).flat_map(|column| {
        (0..rows).map(move |row| {
            let up = row - column / 2;
            [column - up, column + 2 * up]
        })
    });
    let quad = |[a, b]: [i64; 2], corners: [usize; 3]| {
        let corner = |i: usize| [a + CORNERS[i][0], b + CORNERS[i][1]];
        [[a, b], corner(corners[0]), corner(corners[1]), corner(corners[2])].to_vec()
    };
    let faces: Vec<_> =
        centers.flat_map(|center| [[0, 1, 2], [2, 3, 4], [4, 5, 0]].map(|corners| quad(center, corners))).collect();
    // Centers are up, the corners that they are joined to level, the others down.
    let level = |[a, b]: [i64; 2]| [1.0, 0.0, -1.0][(a - b).rem_euclid(3) as usize];
    on_lattice(&faces, run, |at| rise * level(at))
}

/// The mesh whose faces are given by places `[a, b]` on the lattice of equilateral triangles of side `side`, at
/// `x = side (a + b/2)`, `y = side b √3/2`.
fn on_lattice(faces: &[Vec<[i64; 2]>], side: f64, height: impl Fn([i64; 2]) -> f64) -> Result<Mesh> {
    let mut numbers: BTreeMap<(i64, i64), u32> = faces.iter().flatten().map(|&[a, b]| ((b, a), 0)).collect();
    for (number, at) in (0..).zip(numbers.values_mut()) {
        *at = number;
    }
    let point = |&(b, a): &(i64, i64)| {
        let (x, y) = (a as f64 + 0.5 * b as f64, b as f64 * 0.75_f64.sqrt());
        DVec3::new(side * x, side * y, height([a, b]))
    };
    let mesh = Mesh {
        points: numbers.keys().map(point).collect(),
        faces: faces.iter().map(|face| face.iter().map(|&[a, b]| numbers[&(b, a)]).collect()).collect(),
    };
    mesh.check()?;
    Ok(mesh)
}

fn check_counts(columns: usize, rows: usize, least: usize) -> Result<()> {
    check_count(columns, least, "columns")?;
    check_count(rows, least, "rows")?;
    let cells = columns.saturating_mul(rows);
    if cells > MAX_CELLS { Err(too_many(cells).at("columns * rows")) } else { Ok(()) }
}

fn check_count(count: usize, least: usize, name: &str) -> Result<()> {
    if count >= least {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected at least {least}, found {count}")).at(name))
}

fn too_many(cells: usize) -> Error {
    Error::new(Status::TooLarge, format!("expected at most {MAX_CELLS}, found {cells}"))
}

fn check_length(edge: f64) -> Result<()> {
    finite("edge", edge)?;
    if edge > 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected more than 0, found {edge}")).at("edge"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::mesh::Topology;
    use crate::mesh::measure::{edge_lengths, of_faces, planarity, regularity};

    /// The number of vertices inside and their valences, each with how many have it.
    fn interior_valences(mesh: &Mesh) -> BTreeMap<usize, usize> {
        let topology = Topology::new(mesh).unwrap();
        let mut found = BTreeMap::new();
        for (point, is_on_boundary) in (0..).zip(topology.boundary_points()) {
            let neighbours = topology.neighbours(point);
            assert!(neighbours.is_ordered, "the faces around point {point} are no fan");
            if !is_on_boundary {
                *found.entry(neighbours.points.len()).or_insert(0) += 1;
            }
        }
        found
    }

    /// One boundary loop, Euler's number 1, no edge against the orientation, every face counterclockwise from above.
    fn assert_is_disk(mesh: &Mesh) {
        mesh.check_polygons().unwrap();
        let topology = Topology::new(mesh).unwrap();
        let counts = [mesh.points.len(), topology.edges().len(), mesh.faces.len()].map(|count| count as i64);
        assert_eq!(counts[0] - counts[1] + counts[2], 1);
        assert_eq!(topology.boundary().len(), 1);
        assert!(topology.non_manifold_edges().is_empty() && topology.misoriented_edges().is_empty());
        for face in &mesh.faces {
            let corners = mesh.corners(face);
            let turn = |i: usize| (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]).z;
            assert!((1..corners.len() - 1).all(|i| turn(i) > 0.0), "{corners:?}");
        }
    }

    fn assert_edges(mesh: &Mesh, expected: f64) {
        let lengths = edge_lengths(mesh).unwrap();
        assert!(lengths.iter().all(|length| (length / expected - 1.0).abs() < 1e-12));
    }

    fn worst(mesh: &Mesh, measure: fn(&[DVec3]) -> f64) -> f64 {
        of_faces(mesh, measure).unwrap().into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn a_height_field_has_its_grid_and_its_heights() {
        let mesh = height_field(4, 3, [-1.0, 2.0], [0.0, 1.0], |x, y| x * y).unwrap();
        assert_eq!((mesh.points.len(), mesh.faces.len()), (12, 6));
        assert_is_disk(&mesh);
        assert_eq!(interior_valences(&mesh), BTreeMap::from([(4, 2)]));
        assert_eq!(mesh.faces[4], [5, 6, 10, 9]);
        assert_eq!(mesh.points[0], DVec3::new(-1.0, 0.0, 0.0));
        assert_eq!(mesh.points[11], DVec3::new(2.0, 1.0, 2.0));
        assert!(mesh.points[6].distance(DVec3::new(1.0, 0.5, 0.5)) < 1e-15);
    }

    #[test]
    fn a_translation_surface_is_made_of_parallelograms() {
        for n in [2, 5, 21, 61] {
            let mesh = translation_surface(n).unwrap();
            assert_eq!((mesh.points.len(), mesh.faces.len()), (n * n, (n - 1) * (n - 1)));
            assert_is_disk(&mesh);
            let size = mesh.diagonal();
            for face in &mesh.faces {
                let [a, b, c, d] = mesh.corners(face)[..] else { panic!("{face:?}") };
                assert!((a + c - b - d).length() < 1e-15 * size);
            }
            assert!(worst(&mesh, planarity) < 1e-14);
        }
    }

    #[test]
    fn the_translation_surface_is_that_of_the_peers() {
        // p(±1, ±1) = (n/2) (±1, ±1, 0.35 (cos 1.2 + cos 1.5)); p(0, 0) is the top, at 0.35 n.
        let mesh = translation_surface(21).unwrap();
        let height = 10.5 * 0.35 * (1.2_f64.cos() + 1.5_f64.cos());
        assert!(mesh.points[20].distance(DVec3::new(10.5, -10.5, height)) < 1e-14);
        assert!(mesh.points[220].distance(DVec3::new(0.0, 0.0, 0.35 * 21.0)) < 1e-14);
        // The mean edges that tests/exploration keeps: made by another program.
        for (n, mean_edge) in [(21, 1.0990548833725202), (61, 1.0642488389284628)] {
            let lengths = edge_lengths(&translation_surface(n).unwrap()).unwrap();
            let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
            assert!((mean - mean_edge).abs() < 1e-13, "{mean}");
        }
    }

    #[test]
    fn triangles_and_hexagons_meet_four_at_a_vertex() {
        for (columns, rows) in [(2, 2), (5, 4), (3, 7)] {
            let mesh = tri_hex(columns, rows, 0.5).unwrap();
            assert_is_disk(&mesh);
            assert_edges(&mesh, 0.5);
            let count = |corners: usize| mesh.faces.iter().filter(|face| face.len() == corners).count();
            assert_eq!(count(6), columns * rows);
            // Two rows have 2 columns − 1 pairs of neighbours between them, any two pairs in turn a triangle.
            assert_eq!(count(3), (rows - 1) * (2 * columns - 2));
            assert_eq!(count(3) + count(6), mesh.faces.len());
            // Neighbouring hexagons share one vertex, and no vertex has three.
            let neighbours = rows * (columns - 1) + (rows - 1) * (2 * columns - 1);
            assert_eq!(mesh.points.len(), 6 * columns * rows - neighbours);
            // Inside is where a pair has a triangle on either side: all but the first and last pair between two rows,
            // and the pairs within a row that is neither the first nor the last.
            let inside = (rows - 1) * (2 * columns - 3) + (rows - 2) * (columns - 1);
            assert_eq!(interior_valences(&mesh), BTreeMap::from([(4, inside)]));
            assert!(worst(&mesh, regularity) < 1e-13 && worst(&mesh, planarity) < 1e-14);
        }
    }

    #[test]
    fn three_and_six_rhombi_meet_at_a_vertex_and_lifted_they_are_squares() {
        for (columns, rows) in [(1, 1), (2, 1), (1, 3), (4, 5), (7, 3)] {
            for lift in [0.0, 0.4, 1.0, 1.6] {
                let mesh = rhombille(columns, rows, 2.0, lift).unwrap();
                assert_is_disk(&mesh);
                assert_edges(&mesh, 2.0);
                assert_eq!(mesh.faces.len(), 3 * columns * rows);
                // Euler's number of the hexagons, of which neighbours share an edge, and one vertex inside each.
                let neighbours = (rows - 1) * columns + (columns - 1) * (2 * rows - 1);
                assert_eq!(mesh.points.len(), 1 + 6 * columns * rows - neighbours);
                let valences = interior_valences(&mesh);
                assert!(valences.keys().all(|valence| [3, 6].contains(valence)), "{valences:?}");
                assert!(valences[&3] >= columns * rows);
                let topology = Topology::new(&mesh).unwrap();
                for face in &mesh.faces {
                    assert_eq!(topology.neighbours(face[0]).points.len(), 3);
                }
                assert!(worst(&mesh, planarity) < 1e-14);
                assert_eq!(worst(&mesh, regularity) < 1e-13, lift == 1.0);
            }
        }
        assert_eq!(interior_valences(&rhombille(9, 9, 1.0, 0.0).unwrap()).len(), 2);
    }

    #[test]
    fn flat_rhombi_have_angles_of_60_and_120_degrees() {
        let mesh = rhombille(1, 1, 1.0, 0.0).unwrap();
        // A regular hexagon of side 1 and its center, row by row.
        let h = 0.75_f64.sqrt();
        let expected = [(-0.5, -h), (0.5, -h), (-1.0, 0.0), (0.0, 0.0), (1.0, 0.0), (-0.5, h), (0.5, h)];
        assert_eq!(mesh.points.len(), 7);
        for (point, (x, y)) in mesh.points.iter().zip(expected) {
            assert!(point.distance(DVec3::new(x, y, 0.0)) < 1e-15, "{point}");
        }
        assert_eq!(mesh.faces, [[3, 4, 6, 5], [3, 5, 2, 0], [3, 0, 1, 4]]);
    }

    #[test]
    fn what_makes_no_mesh_is_refused_by_name() {
        let refusal = |made: Result<Mesh>| made.unwrap_err().to_string();
        let flat = |_: f64, _: f64| 0.0;
        assert_eq!(refusal(tri_hex(1, 5, 1.0)), "columns: expected at least 2, found 1");
        assert_eq!(refusal(rhombille(3, 0, 1.0, 0.0)), "rows: expected at least 1, found 0");
        assert_eq!(refusal(translation_surface(1)), "n: expected at least 2, found 1");
        assert_eq!(
            refusal(translation_surface(usize::MAX)),
            format!("n * n: expected at most 4194304, found {}", usize::MAX)
        );
        assert_eq!(refusal(tri_hex(4096, 4096, 1.0)), "columns * rows: expected at most 4194304, found 16777216");
        assert_eq!(refusal(tri_hex(3, 3, 0.0)), "edge: expected more than 0, found 0");
        assert_eq!(refusal(rhombille(3, 3, f64::NAN, 0.0)), "edge: expected a finite number, found NaN");
        let lift = "lift: expected at least 0 and less than the square root of 3, found";
        assert_eq!(refusal(rhombille(3, 3, 1.0, -0.5)), format!("{lift} -0.5"));
        assert_eq!(refusal(rhombille(3, 3, 1.0, 2.0)), format!("{lift} 2"));
        let ends = "y: expected the greater end second, found 1 and 1";
        assert_eq!(refusal(height_field(2, 2, [0.0, 1.0], [1.0, 1.0], flat)), ends);
        let infinite = refusal(height_field(2, 2, [0.0, f64::INFINITY], [0.0, 1.0], flat));
        assert_eq!(infinite, "x: expected a finite number, found inf");
        let pole = refusal(height_field(3, 3, [-1.0, 1.0], [-1.0, 1.0], |x, y| 1.0 / x.hypot(y)));
        assert!(pole.starts_with("points[4]: expected finite coordinates"), "{pole}");
        assert!(refusal(tri_hex(3, 3, f64::MAX)).starts_with("points["));
        let widest = height_field(3, 2, [-f64::MAX, f64::MAX], [0.0, 1.0], flat).unwrap();
        assert_eq!(widest.points[1], DVec3::ZERO);
    }
}
