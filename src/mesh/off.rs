//! The Object File Format, positions and faces.
//!
//! Our own reader: the crate for this format holds coordinates in single precision. Read are `OFF` and its variants with
//! colours, normals and texture coordinates (`STCNOFF`), which follow the position and are passed over.

use std::fmt::Write;

use glam::DVec3;

use super::Mesh;
use super::file::{Refusal, Source, check_corner_count, position, shortened};

pub(super) fn read(bytes: &[u8]) -> Result<Source, Refusal> {
    let text = String::from_utf8_lossy(bytes);
    let lines = text.split('\n').zip(1..).map(|(line, number)| (line.split('#').next().unwrap_or_default(), number));
    let mut lines = lines.map(|(line, number)| (line.trim(), number)).filter(|(line, _)| !line.is_empty()).peekable();
    let last_line = text.split('\n').count();
    let ends = |what: String| Refusal::new(last_line, format!("expected {what}, found the end of the file"));

    let (header, header_line) = lines.next().ok_or_else(|| ends("OFF".to_owned()))?;
    let rest = after_header(header).map_err(|reason| Refusal::new(header_line, reason))?;
    // The counts may follow the header on its line.
    let (counts, counts_line) = match rest {
        "" => lines.next().ok_or_else(|| ends("the numbers of vertices, faces and edges".to_owned()))?,
        counts => (counts, header_line),
    };
    let mut words = counts.split_whitespace();
    let point_count = count(words.next(), "the number of vertices", counts_line)?;
    let face_count = count(words.next(), "the number of faces", counts_line)?;

    // The counts are only claims: memory grows with what is there.
    let mut source = Source::default();
    for i in 0..point_count {
        let (line, number) = lines.next().ok_or_else(|| ends(format!("{point_count} vertices after {i}")))?;
        source.mesh.points.push(position(&mut line.split_whitespace(), number)?);
    }
    for i in 0..face_count {
        let (line, number) = lines.next().ok_or_else(|| ends(format!("{face_count} faces after {i}")))?;
        let mut words = line.split_whitespace();
        let corner_count = count(words.next(), "the number of corners", number)?;
        check_corner_count(corner_count, number)?;
        let mut face = Vec::new();
        for j in 0..corner_count {
            let what = || format!("{corner_count} corners after {j}");
            let point = count(words.next(), &what(), number)?;
            match u32::try_from(point) {
                Ok(index) if point < point_count => face.push(index),
                _ => {
                    let reason = format!("vertex {point} is out of range for {point_count} vertices, counted from 0");
                    return Err(Refusal::new(number, reason));
                }
            }
        }
        source.mesh.faces.push(face);
        source.face_lines.push(number);
    }
    match lines.next() {
        None => Ok(source),
        Some((line, number)) => {
            let found = shortened(line);
            Err(Refusal::new(
                number,
                format!("expected the end of the file after {face_count} faces, found \"{found}\""),
            ))
        }
    }
}

/// What follows the header on its line, or why it is none of ours.
fn after_header(line: &str) -> Result<&str, String> {
    // Known files glue the counts to the keyword: "OFF8 6 12".
    let keyword_length = line.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(line.len());
    let (keyword, rest) = line.split_at(keyword_length);
    let prefix = keyword.strip_suffix("OFF").map(|prefix| prefix.strip_prefix("ST").unwrap_or(prefix));
    let is_known = prefix.is_some_and(|prefix| ["", "C", "N", "CN"].contains(&prefix));
    let rest = rest.trim();
    if !is_known {
        return Err(format!("expected OFF, found \"{}\"", shortened(line)));
    }
    if rest.starts_with("BINARY") {
        return Err("expected OFF as text, found OFF BINARY: save it as text, or as PLY".to_owned());
    }
    Ok(rest)
}

fn count(word: Option<&str>, what: &str, line: usize) -> Result<usize, Refusal> {
    let found = word.map_or("the end of the line".to_owned(), |word| format!("\"{}\"", shortened(word)));
    let value = word.and_then(|word| word.parse().ok());
    value.ok_or_else(|| Refusal::new(line, format!("expected {what}, found {found}")))
}

pub(super) fn write(mesh: &Mesh) -> Vec<u8> {
    let mut text = format!("OFF\n{} {} 0\n", mesh.points.len(), mesh.faces.len());
    // Writing to a String cannot fail.
    for DVec3 { x, y, z } in &mesh.points {
        let _ = writeln!(text, "{x:?} {y:?} {z:?}");
    }
    for face in &mesh.faces {
        let _ = write!(text, "{}", face.len());
        for point in face {
            let _ = write!(text, " {point}");
        }
        text.push('\n');
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

    #[test]
    fn comments_colours_and_headers_of_all_kinds_are_read() {
        for header in
            ["OFF\n4 1 0\n", "OFF 4 1 0\n", "OFF4 1 0\n", "# made\n\nCNOFF # kind\n\n4 1\n", "STCNOFF\r\n4 1 4\r\n"]
        {
            let text = format!("{header}{POINTS}# faces\n4 0 1 2 3 255 0 0\n\n");
            let source = read(text.as_bytes()).unwrap();
            assert_eq!(source.mesh.points[2], DVec3::new(1.0, 1.0, 0.0));
            assert_eq!(source.mesh.faces, [[0, 1, 2, 3]]);
        }
        let coloured = "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n0 1 0 0 0 0 0\n3 0 1 2\n";
        assert_eq!(read(coloured.as_bytes()).unwrap().face_lines, [6]);
    }

    #[test]
    fn what_errs_is_named_with_its_line() {
        let cases = [
            (String::new(), 1, "expected OFF, found the end of the file"),
            ("ply\n".to_owned(), 1, "expected OFF, found \"ply\""),
            ("OFF BINARY\n".to_owned(), 1, "expected OFF as text, found OFF BINARY"),
            ("4OFF\n4 1 0\n".to_owned(), 1, "expected OFF, found \"4OFF\""),
            ("OFF\nfour 1 0\n".to_owned(), 2, "expected the number of vertices, found \"four\""),
            ("OFF\n4\n".to_owned(), 2, "expected the number of faces, found the end of the line"),
            ("OFF\n99999999999 1 0\n0 0 0\n".to_owned(), 4, "expected 99999999999 vertices after 1, found the end"),
            (format!("OFF\n4 2 0\n{POINTS}3 0 1 2\n"), 8, "expected 2 faces after 1, found the end of the file"),
            (format!("OFF\n4 1 0\n{POINTS}3 0 1 4\n"), 7, "vertex 4 is out of range for 4 vertices, counted from 0"),
            (format!("OFF\n4 1 0\n{POINTS}3 0 1 -1\n"), 7, "expected 3 corners after 2, found \"-1\""),
            (format!("OFF\n4 1 0\n{POINTS}4 0 1 2\n"), 7, "expected 4 corners after 3, found the end of the line"),
            (format!("OFF\n4 1 0\n{POINTS}2 0 1\n"), 7, "expected a face of at least 3 corners, found 2"),
            (format!("OFF\n4 1 0\n{POINTS}3 0 1 2\n3 0 1 3\n"), 8, "expected the end of the file after 1 faces"),
            ("OFF\n1 0 0\n0 0 inf\n".to_owned(), 3, "expected a finite number, found \"inf\""),
            ("OFF\n1 0 0\n0 0\n".to_owned(), 3, "expected 3 coordinates, found 2"),
        ];
        for (text, line, reason) in cases {
            let Refusal { line: found_line, reason: found } = read(text.as_bytes()).unwrap_err();
            assert!(found_line == line && found.starts_with(reason), "{text:?}: line {found_line}: {found}");
        }
    }
}
