//! Wavefront OBJ, positions and faces.
//!
//! Our own reader: a constraint names points by their place in the file, so their order, the points that no face uses,
//! all 53 bits of a coordinate, polygons of any size and the line of an error have to survive.

use std::fmt::Write;

use glam::DVec3;

use super::Mesh;
use super::file::{Refusal, Source, check_corner_count, number, position, shortened};

/// A line as the format means it: comments cut off, lines that end in `\` joined with what follows.
struct Statement {
    line: usize,
    text: String,
}

pub(super) fn read(bytes: &[u8]) -> Result<Source, Refusal> {
    // Names and comments come in all encodings; what is read here is ASCII.
    let text = String::from_utf8_lossy(bytes);
    let mut source = Source::default();
    let Source { mesh: Mesh { points, faces }, face_lines } = &mut source;
    for Statement { line, text } in statements(&text) {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => {
                points.push(position(&mut words, line)?);
                // w, or a colour, or both.
                for word in words {
                    number(word, line)?;
                }
            }
            Some("f" | "fo") => {
                let corners = words.map(|word| corner(word, points.len(), line));
                let face = corners.collect::<Result<Vec<u32>, Refusal>>()?;
                check_corner_count(face.len(), line)?;
                faces.push(face);
                face_lines.push(line);
            }
            // Texture coordinates, normals, lines, groups, materials, curves, and what programs added to the format.
            Some(keyword) if keyword.starts_with(|first: char| first.is_ascii_alphabetic()) => {}
            Some(keyword) => {
                let found = shortened(keyword);
                return Err(Refusal::new(line, format!("expected a keyword such as v or f, found \"{found}\"")));
            }
            None => {}
        }
    }
    if points.is_empty() {
        return Err(Refusal::new(0, "expected lines \"v x y z\", found none: is it an OBJ file?"));
    }
    // A face may refer to vertices further down, so this waits for the end.
    for (face, &line) in faces.iter().zip(face_lines.iter()) {
        if let Some(point) = face.iter().find(|&&point| point as usize >= points.len()) {
            let reason = format!("vertex {} is out of range for {} vertices", u64::from(*point) + 1, points.len());
            return Err(Refusal::new(line, reason));
        }
    }
    Ok(source)
}

/// The polylines of `l` elements; consecutive ones that go on from vertex to vertex are one. Without any, that through all vertices.
pub(super) fn read_polylines(bytes: &[u8]) -> Result<Vec<Vec<DVec3>>, Refusal> {
    let text = String::from_utf8_lossy(bytes);
    let mut points = Vec::new();
    let mut lines: Vec<(usize, Vec<u32>)> = Vec::new();
    let mut first_face = None;
    for Statement { line, text } in statements(&text) {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => points.push(position(&mut words, line)?),
            Some("f" | "fo") => first_face = first_face.or(Some(line)),
            Some("l") => {
                let indices =
                    words.map(|word| corner(word, points.len(), line)).collect::<Result<Vec<u32>, Refusal>>()?;
                if indices.len() < 2 {
                    return Err(Refusal::new(line, format!("expected at least 2 vertices, found {}", indices.len())));
                }
                match lines.last_mut() {
                    Some((_, before)) if before.last() == indices.first() => before.extend(&indices[1..]),
                    _ => lines.push((line, indices)),
                }
            }
            Some(keyword) if keyword.starts_with(|first: char| first.is_ascii_alphabetic()) => {}
            Some(keyword) => {
                let found = shortened(keyword);
                return Err(Refusal::new(line, format!("expected a keyword such as v or l, found \"{found}\"")));
            }
            None => {}
        }
    }
    if points.is_empty() {
        return Err(Refusal::new(0, "expected lines \"v x y z\", found none: is it an OBJ file?"));
    }
    if lines.is_empty() {
        return match first_face {
            Some(line) => Err(Refusal::new(line, "expected a polyline \"l 1 2 3\", found a face: is it a mesh?")),
            None => Ok(vec![points]),
        };
    }
    let polyline = |(line, indices): (usize, Vec<u32>)| {
        let at = |index: u32| {
            points.get(index as usize).copied().ok_or_else(|| {
                let reason = format!("vertex {} is out of range for {} vertices", u64::from(index) + 1, points.len());
                Refusal::new(line, reason)
            })
        };
        indices.into_iter().map(at).collect()
    };
    lines.into_iter().map(polyline).collect()
}

fn statements(text: &str) -> impl Iterator<Item = Statement> + '_ {
    let mut lines = text.split('\n').map(|line| line.strip_suffix('\r').unwrap_or(line)).zip(1..);
    std::iter::from_fn(move || {
        let (first, line) = lines.next()?;
        let mut text = without_comment(first).to_owned();
        while let Some(continued) = text.trim_end().strip_suffix('\\') {
            text = format!("{continued} ");
            let Some((next, _)) = lines.next() else { break };
            text.push_str(without_comment(next));
        }
        Some(Statement { line, text })
    })
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

/// The point of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 1, or from -1 backwards from the last vertex so far.
fn corner(word: &str, point_count: usize, line: usize) -> Result<u32, Refusal> {
    let refuse = |what: String| Refusal::new(line, what);
    let mut parts = word.split('/');
    let vertex = parts.next().unwrap_or_default();
    let is_index = |part: &str| part.is_empty() || part.parse::<i64>().is_ok();
    let rest: Vec<&str> = parts.collect();
    let (Ok(index), true) = (vertex.parse::<i64>(), rest.len() <= 2 && rest.iter().copied().all(is_index)) else {
        return Err(refuse(format!("expected a corner v, v/vt, v//vn or v/vt/vn, found \"{}\"", shortened(word))));
    };
    let point = match index {
        0 => return Err(refuse("vertices count from 1, found 0".to_owned())),
        1.. => index - 1,
        // saturating: i64::MIN is an index that does not exist, like any other.
        _ => index.saturating_add(point_count as i64),
    };
    u32::try_from(point)
        .map_err(|_| refuse(format!("vertex {index} is out of range for the {point_count} vertices up to here")))
}

pub(super) fn write(mesh: &Mesh) -> Vec<u8> {
    let mut text = format!("# {} vertices, {} faces\n", mesh.points.len(), mesh.faces.len());
    // Writing to a String cannot fail.
    for DVec3 { x, y, z } in &mesh.points {
        let _ = writeln!(text, "v {x:?} {y:?} {z:?}");
    }
    for face in &mesh.faces {
        text.push('f');
        for &point in face {
            let _ = write!(text, " {}", u64::from(point) + 1);
        }
        text.push('\n');
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces(text: &str) -> Vec<Vec<u32>> {
        read(text.as_bytes()).unwrap().mesh.faces
    }

    fn refusal(text: &str) -> (usize, String) {
        let Refusal { line, reason } = read(text.as_bytes()).unwrap_err();
        (line, reason)
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn every_way_to_name_a_corner_names_the_same() {
        for face in ["1 2 3 4", "1/1 2/2 3/1 4/9", "1//1 2//1 3//1 4//1", "1/1/1 2/1/1 3/1/1 4/1/1", "-4 -3 -2 -1"] {
            assert_eq!(faces(&format!("{SQUARE}f {face}\n")), [[0, 1, 2, 3]]);
        }
    }

    #[test]
    fn negative_indices_count_from_the_vertices_so_far() {
        assert_eq!(faces(&format!("{SQUARE}f -4 -3 -2\nv 5 5 5\nf -1 -2 -3\n")), [[0, 1, 2], [4, 3, 2]]);
    }

    #[test]
    fn what_the_mesh_has_no_place_for_is_passed_over() {
        let text = "# by hand\nmtllib a.mtl\no one\nv 0 0 0 # corner\nv 1 0 0 1.0\nvt 0 0\nvn 0 0 1\ng left\nusemtl m\n\
                    s off\nl 1 2\np 1\no two\nv 1 1 0 0.5 0.5 0.5\nf 1 2 3\n\n";
        let source = read(text.as_bytes()).unwrap();
        assert_eq!(source.mesh.points, [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
        assert_eq!((source.mesh.faces, source.face_lines), (vec![vec![0, 1, 2]], vec![15]));
    }

    #[test]
    fn points_that_no_face_uses_and_equal_points_are_kept() {
        let source = read(b"v 0 0 0\nv 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 4 5\n").unwrap();
        assert_eq!(source.mesh.points.len(), 5);
        assert_eq!(source.mesh.faces, [[2, 3, 4]]);
    }

    #[test]
    fn carriage_returns_continued_lines_and_other_encodings_are_read() {
        let source = read(b"# Stra\xdfe\r\nv 0 0 \\\r\n 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 \\\r\n3\r\n").unwrap();
        assert_eq!(source.mesh.faces, [[0, 1, 2]]);
        assert_eq!(source.face_lines, [6]);
        assert_eq!(read(b"v 0 0 0 \\").unwrap().mesh.points.len(), 1);
    }

    #[test]
    fn a_face_may_come_before_its_vertices() {
        assert_eq!(faces(&format!("f 1 2 3\n{SQUARE}")), [[0, 1, 2]]);
    }

    #[test]
    fn what_errs_is_named_with_its_line() {
        let cases = [
            ("v 0 0\n".to_owned(), 1, "expected 3 coordinates, found 2"),
            ("v 0 0 zero\n".to_owned(), 1, "expected a finite number, found \"zero\""),
            ("v 0 0 nan\n".to_owned(), 1, "expected a finite number, found \"nan\""),
            ("v 0 0 1e999\n".to_owned(), 1, "expected a finite number, found \"1e999\""),
            ("v 0 0 0 inf\n".to_owned(), 1, "expected a finite number, found \"inf\""),
            (format!("{SQUARE}f 1 2\n"), 5, "expected a face of at least 3 corners, found 2"),
            (format!("{SQUARE}f 1 2 5\n"), 5, "vertex 5 is out of range for 4 vertices"),
            (format!("{SQUARE}f 1 2 0\n"), 5, "vertices count from 1, found 0"),
            (format!("{SQUARE}f 1 2 -5\n"), 5, "vertex -5 is out of range for the 4 vertices up to here"),
            (format!("{SQUARE}f 1 2 99999999999\n"), 5, "vertex 99999999999 is out of range for the 4 vertices"),
            (format!("{SQUARE}f 1 2 -9223372036854775808\n"), 5, "vertex -9223372036854775808 is out of range"),
            (format!("{SQUARE}f 1 2 3/x\n"), 5, "expected a corner v, v/vt, v//vn or v/vt/vn, found \"3/x\""),
            (format!("{SQUARE}f 1 2 1.5\n"), 5, "expected a corner v, v/vt, v//vn or v/vt/vn, found \"1.5\""),
            ("\n\n3 0 0 0\n".to_owned(), 3, "expected a keyword such as v or f, found \"3\""),
            (String::new(), 0, "expected lines \"v x y z\", found none"),
            ("solid stl\n".to_owned(), 0, "expected lines \"v x y z\", found none"),
        ];
        for (text, line, reason) in cases {
            let found = refusal(&text);
            assert!(found.0 == line && found.1.starts_with(reason), "{text:?}: {found:?}");
        }
    }
}
