//! Strips for other programs: surfaces, lines and meshes.
//!
//! CAD programs take surfaces as free-form elements of Wavefront OBJ, which Rhino and Alias read as NURBS: it has degrees and knots as
//! they are here, so that nothing is lost. STEP would be read by more, but the crates that write it are young and bring far more
//! than a list of numbers needs.

use std::fmt::Write;

use glam::DVec3;

use super::file::KNOTS_V;
use super::strip::Strip;
use super::trim::{Trimmed, TrimmedRuling};
use crate::error::{Error, Result, Status};
use crate::mesh::Mesh;

/// The strips as B-spline surfaces of an OBJ file, each an object of its own: `cstype bspline`, degrees 3 and 1.
pub fn surfaces_obj(strips: &[Strip]) -> String {
    let mut text = String::from("# ruled strips as B-spline surfaces: u along boundaries, v along rulings\n");
    let mut first = 1;
    for (i, strip) in strips.iter().enumerate() {
        // Of a closed strip the first control points come again.
        let count = strip.basis().knots().len() - 4;
        let _ = writeln!(text, "o strip-{i}");
        for side in 0..2 {
            (0..count).for_each(|j| vertex(&mut text, strip.control(side)[j % strip.basis().count()]));
        }
        let _ = write!(text, "cstype bspline\ndeg 3 1\nsurf 0 {} 0 1", strip.length_u());
        (first..first + 2 * count).for_each(|vertex| _ = write!(text, " {vertex}"));
        for (name, knots) in [("u", strip.basis().knots()), ("v", KNOTS_V.as_slice())] {
            let _ = write!(text, "\nparm {name}");
            knots.iter().for_each(|knot| _ = write!(text, " {knot}"));
        }
        text.push_str("\nend\n");
        first += 2 * count;
    }
    text
}

/// What is left of the rulings of each strip as lines of an OBJ file, each strip an object of its own.
pub fn rulings_obj(rulings: &[Vec<TrimmedRuling>]) -> String {
    let mut text = String::from("# rulings\n");
    let mut next = 1;
    for (i, rulings) in rulings.iter().enumerate() {
        let _ = writeln!(text, "o strip-{i}");
        for ends in rulings.iter().flat_map(|ruling| &ruling.pieces) {
            ends.iter().for_each(|&end| vertex(&mut text, end));
            let _ = writeln!(text, "l {next} {}", next + 1);
            next += 2;
        }
    }
    text
}

/// What is left of the rulings of each strip as a table, with a line of names: strip, ruling, piece, the parameter `u`, both ends
/// and the length.
pub fn rulings_csv(rulings: &[Vec<TrimmedRuling>]) -> String {
    let mut text = String::from("strip,ruling,piece,u,x0,y0,z0,x1,y1,z1,length\n");
    for (i, rulings) in rulings.iter().enumerate() {
        for (j, ruling) in rulings.iter().enumerate() {
            for (k, [a, b]) in ruling.pieces.iter().enumerate() {
                let _ = write!(text, "{i},{j},{k},{}", ruling.u);
                a.to_array().iter().chain(&b.to_array()).for_each(|value| _ = write!(text, ",{value}"));
                let _ = writeln!(text, ",{}", a.distance(*b));
            }
        }
    }
    text
}

fn vertex(text: &mut String, point: DVec3) {
    let _ = writeln!(text, "v {} {} {}", point.x, point.y, point.z);
}

/// All strips as one mesh of quads whose edges across are rulings, `columns_per_span` in each span, with the strip of each face.
/// Strips share no points.
///
/// # Errors
/// `columns_per_span` is 0, or a mesh too large ([`Strip::mesh`]).
pub fn mesh(strips: &[Strip], columns_per_span: usize, rows: usize) -> Result<(Mesh, Vec<u32>)> {
    if columns_per_span == 0 {
        return Err(Error::new(Status::InvalidValue, "expected at least 1, found 0").at("columns_per_span"));
    }
    let one =
        |strip: &Strip| strip.mesh(columns_per_span.saturating_mul(strip.basis().spans()).saturating_add(1), rows);
    Ok(joined(strips.iter().map(one).collect::<Result<_>>()?))
}

/// The unit normals of the strips at the points of [`mesh`], for zebra stripes; zero where a strip has none.
///
/// # Errors
/// As [`mesh`].
pub fn mesh_normals(strips: &[Strip], columns_per_span: usize, rows: usize) -> Result<Vec<DVec3>> {
    let count = mesh(strips, columns_per_span, rows)?.0.points.len();
    let mut normals = Vec::with_capacity(count);
    for strip in strips {
        let columns = columns_per_span * strip.basis().spans() + 1;
        let at = |i: usize, last: usize| i as f64 / last as f64;
        normals.extend((0..columns * rows).map(|i| {
            let (u, v) = (at(i % columns, columns - 1), at(i / columns, rows - 1));
            strip.at(strip.length_u() * u, v).normal()
        }));
    }
    Ok(normals)
}

/// All trimmed strips as one mesh of triangles, with the strip of each. `trimmed` are those of [`trim`](super::trim::trim).
///
/// # Errors
/// Not one for each strip; the place is `trimmed`.
pub fn trimmed_mesh(strips: &[Strip], trimmed: &[Trimmed]) -> Result<(Mesh, Vec<u32>)> {
    if trimmed.len() != strips.len() {
        let reason = format!("expected one for each of {} strips, found {}", strips.len(), trimmed.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("trimmed"));
    }
    Ok(joined(strips.iter().zip(trimmed).map(|(strip, trimmed)| trimmed.mesh(strip)).collect()))
}

fn joined(meshes: Vec<Mesh>) -> (Mesh, Vec<u32>) {
    let (mut all, mut part_of) = (Mesh { points: Vec::new(), faces: Vec::new() }, Vec::new());
    for (part, mesh) in (0..).zip(meshes) {
        let first = all.points.len() as u32;
        part_of.extend(std::iter::repeat_n(part, mesh.faces.len()));
        all.faces.extend(mesh.faces.into_iter().map(|face| face.into_iter().map(|i| first + i).collect::<Vec<u32>>()));
        all.points.extend(mesh.points);
    }
    (all, part_of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::trim::tests::straight;
    use crate::geometry::ruled::trim::{TrimOptions, trim};
    use crate::mesh::curve::CubicBasis;
    use crate::mesh::patterns::height_field;
    use crate::mesh::reference::ReferenceMesh;
    use crate::mesh::{TriangleMesh, file};

    /// De Boor's algorithm on what a file says, for one row of control points.
    fn de_boor(degree: usize, knots: &[f64], control: &[DVec3], t: f64) -> DVec3 {
        let last = control.len();
        let span = (degree..last).rev().find(|&k| knots[k] <= t).unwrap();
        let mut d: Vec<DVec3> = (0..=degree).map(|j| control[span - degree + j]).collect();
        for r in 1..=degree {
            for j in (r..=degree).rev() {
                let i = span - degree + j;
                let alpha = (t - knots[i]) / (knots[i + degree + 1 - r] - knots[i]);
                d[j] = d[j - 1].lerp(d[j], alpha);
            }
        }
        d[degree]
    }

    fn numbers<'a>(text: &'a str, keyword: &'a str) -> impl Iterator<Item = Vec<f64>> + 'a {
        let lines = text.lines().filter_map(move |line| line.strip_prefix(keyword));
        lines.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
    }

    #[test]
    fn surfaces_are_those_that_the_file_says() {
        let side = |z: f64| (0..6).map(|i| DVec3::new((1.3 * f64::from(i)).sin(), f64::from(i * i), z)).collect();
        let closed = Strip::new(CubicBasis::new(6, true).unwrap(), [side(0.0), side(1.0)]).unwrap();
        let open = Strip::new(CubicBasis::new(6, false).unwrap(), [side(-1.0), side(0.5)]).unwrap();
        let strips = [open, closed];
        let text = surfaces_obj(&strips);
        let points: Vec<DVec3> = numbers(&text, "v ").map(|v| DVec3::new(v[0], v[1], v[2])).collect();
        let surfaces: Vec<Vec<f64>> = numbers(&text, "surf").collect();
        let (u, v): (Vec<_>, Vec<_>) = (numbers(&text, "parm u").collect(), numbers(&text, "parm v").collect());
        assert_eq!((surfaces.len(), points.len()), (2, 2 * 6 + 2 * 9));
        for (i, strip) in strips.iter().enumerate() {
            let control: Vec<DVec3> = surfaces[i][4..].iter().map(|&k| points[k as usize - 1]).collect();
            assert_eq!(surfaces[i][..4], [0.0, strip.length_u(), 0.0, 1.0]);
            // u runs faster than v.
            let row = control.len() / 2;
            for (s, t) in [(0.0, 0.0), (0.2, 0.7), (0.55, 0.4), (0.99, 1.0)] {
                let at = s * strip.length_u();
                let rows = [&control[..row], &control[row..]].map(|row| de_boor(3, &u[i], row, at));
                let found = de_boor(1, &v[i], &rows, t);
                assert!(found.distance(strip.at(at, t).point) < 1e-12);
            }
        }
    }

    #[test]
    fn rulings_and_meshes_are_read_again() {
        let flat = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let mesh_of = TriangleMesh::new(&height_field(4, 4, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
        let strip = |y: f64| straight(5, [flat(-0.2, y), flat(-0.2, y + 0.6)], [flat(1.2, y), flat(1.2, y + 0.6)]);
        let strips = [strip(-0.1), strip(0.5)];
        let trimmed = trim(&strips, &ReferenceMesh::new(&mesh_of), &TrimOptions::default()).unwrap();
        let rulings: Vec<_> = strips.iter().zip(&trimmed).map(|(strip, trimmed)| trimmed.rulings(strip, 8)).collect();
        let pieces: Vec<[DVec3; 2]> = rulings.iter().flatten().flat_map(|ruling| ruling.pieces.clone()).collect();
        // x = −0.2 + 0.2 i: six of eight rulings of each strip, the outer two on the sides of the square.
        assert!(pieces.len() >= 8 && pieces.len() <= 12);
        assert!(pieces.iter().all(|[a, b]| (a.distance(*b) - 0.5).abs() < 1e-5));
        let lines = file::decode_polylines(rulings_obj(&rulings).as_bytes(), "rulings.obj").unwrap();
        assert_eq!(lines.len(), pieces.len());
        assert!(lines.iter().zip(&pieces).all(|(line, piece)| line[..] == piece[..]));
        let table = rulings_csv(&rulings);
        for (line, [a, b]) in table.lines().skip(1).zip(&pieces) {
            let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            assert_eq!((row[4..7].to_vec(), row[7..10].to_vec()), (a.to_array().to_vec(), b.to_array().to_vec()));
            assert!((row[10] - a.distance(*b)).abs() < 1e-15 && row.len() == 11);
        }
        let (all, of_strip) = mesh(&strips, 3, 2).unwrap();
        assert_eq!((all.faces.len(), of_strip.len(), all.points.len()), (12, 12, 28));
        assert_eq!((of_strip[5], of_strip[6]), (0, 1));
        all.check().unwrap();
        let normals = mesh_normals(&strips, 3, 2).unwrap();
        assert!(normals.len() == 28 && normals.iter().all(|normal| normal.distance(DVec3::Z) < 1e-15));
        assert!(trimmed[0].normals(&strips[0]).iter().all(|normal| normal.distance(DVec3::Z) < 1e-15));
        let (cut, of_strip) = trimmed_mesh(&strips, &trimmed).unwrap();
        cut.check().unwrap();
        assert_eq!(cut.faces.len(), of_strip.len());
        let area: f64 = TriangleMesh::new(&cut).unwrap().total_area();
        assert!((area - 1.0).abs() < 1e-6);
        assert_eq!(mesh(&strips, 0, 2).unwrap_err().place(), "columns_per_span");
        assert_eq!(trimmed_mesh(&strips, &trimmed[..1]).unwrap_err().place(), "trimmed");
    }
}
