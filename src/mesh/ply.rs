//! The Polygon File Format, positions and faces, through the crate made for it.

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Ply, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

use super::file::{Format, Refusal, Source, shortened};
use super::{Mesh, check_face};
use crate::error::{Error, Result, Status};

/// The names that programs give the list of corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The longest reason of the crate that is told in full, in characters.
const MAX_REASON: usize = 400;

/// One row of a file: what it may have of a vertex and of a face.
#[derive(Default)]
struct Element {
    position: DVec3,
    corners: Vec<u32>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
        match (axis, as_f64(&property)) {
            (Some(axis), Some(value)) => self.position[axis] = value,
            (Some(_), None) => return PropertyAccessResult::UnsupportedType,
            (None, _) if CORNERS.contains(&name) => match property.to_u32_list() {
                Some(corners) => self.corners = corners,
                None => return PropertyAccessResult::UnsupportedType,
            },
            (None, _) => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }

    fn get_double(&self, name: &str) -> Option<f64> {
        ["x", "y", "z"].iter().position(|axis| *axis == name).map(|axis| self.position[axis])
    }

    fn get_list_uint(&self, name: &str) -> Option<&[u32]> {
        CORNERS.contains(&name).then_some(&self.corners)
    }
}

fn as_f64(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(value) => Some(value.into()),
        Property::UChar(value) => Some(value.into()),
        Property::Short(value) => Some(value.into()),
        Property::UShort(value) => Some(value.into()),
        Property::Int(value) => Some(value.into()),
        Property::UInt(value) => Some(value.into()),
        Property::Float(value) => Some(value.into()),
        Property::Double(value) => Some(value),
        _ => None,
    }
}

pub(super) fn read(bytes: &[u8]) -> std::result::Result<Source, Refusal> {
    let refuse = |error: ParseError| Refusal::new(error.line().unwrap_or(0), reason_of(&error));
    let mut reader = Reader::new(bytes);
    let parser = Parser::<Element>::new();
    let header = parser.read_header(&mut reader).map_err(refuse)?;
    let is_text = header.encoding == Encoding::Ascii;
    let Some(vertex) = header.elements.get("vertex") else {
        return Err(Refusal::new(0, "expected an element \"vertex\" in the header, found none"));
    };
    if let Some(axis) = ["x", "y", "z"].iter().find(|axis| !vertex.properties.contains_key(**axis)) {
        return Err(Refusal::new(0, format!("expected a property \"{axis}\" of the vertices, found none")));
    }
    if header.elements.get("face").is_some_and(|face| !CORNERS.iter().any(|name| face.properties.contains_key(*name))) {
        return Err(Refusal::new(0, "expected a property list \"vertex_indices\" of the faces, found none"));
    }
    if header.elements.contains_key("tristrips") {
        return Err(Refusal::new(0, "expected faces, found triangle strips: save it with faces"));
    }
    // An element without properties takes no bytes in a binary file: any number of them could be claimed.
    if let Some((name, _)) = header.elements.iter().find(|(_, element)| element.properties.is_empty()) {
        return Err(Refusal::new(0, format!("expected properties of the element \"{name}\", found none")));
    }
    let mut source = Source::default();
    for (name, definition) in &header.elements {
        let first_line = reader.line();
        let elements = parser.read_payload_for_element(&mut reader, definition, &header).map_err(refuse)?;
        match name.as_str() {
            "vertex" => source.mesh.points = elements.iter().map(|element| element.position).collect(),
            "face" => {
                if is_text {
                    source.face_lines = (first_line..).take(elements.len()).collect();
                }
                source.mesh.faces = elements.into_iter().map(|element| element.corners).collect();
            }
            _ => {}
        }
    }
    check(&source)?;
    let rest = reader.into_inner();
    let is_blank = rest.iter().all(u8::is_ascii_whitespace);
    if is_blank || !is_text && rest.iter().all(|byte| *byte == 0) {
        Ok(source)
    } else {
        Err(Refusal::new(
            0,
            format!("expected the end of the file after its elements, found {} more bytes", rest.len()),
        ))
    }
}

fn check(source: &Source) -> std::result::Result<(), Refusal> {
    let Source { mesh: Mesh { points, faces }, face_lines } = source;
    if let Some(i) = points.iter().position(|point| !point.is_finite()) {
        return Err(Refusal::new(0, format!("vertex {i}: expected finite coordinates, found {}", points[i])));
    }
    for (i, face) in faces.iter().enumerate() {
        check_face(face, points.len()).map_err(|error| {
            let line = face_lines.get(i).copied().unwrap_or(0);
            Refusal::new(line, format!("face {i}: {error}"))
        })?;
    }
    Ok(())
}

/// The crate's message in one line, without the line number that our place has.
fn reason_of(error: &ParseError) -> String {
    let text = error.to_string();
    let without_line = text.strip_prefix("Line ").and_then(|rest| rest.split_once(": "));
    let reason = without_line.map_or(text.as_str(), |(_, reason)| reason);
    let words: Vec<&str> = reason.split_whitespace().collect();
    let reason = words.join(" ");
    // It quotes the line, twice, before it says what is wrong with it.
    if reason.chars().count() > MAX_REASON { shortened(&reason) } else { reason }
}

pub(super) fn write(mesh: &Mesh, format: Format) -> Result<Vec<u8>> {
    let mut ply = Ply::<Element>::new();
    ply.header.encoding = match format {
        Format::PlyText => Encoding::Ascii,
        Format::PlyBigEndian => Encoding::BinaryBigEndian,
        _ => Encoding::BinaryLittleEndian,
    };
    let mut vertex = ElementDef::new("vertex".to_owned());
    for axis in ["x", "y", "z"] {
        let property = PropertyDef::new(axis.to_owned(), PropertyType::Scalar(ScalarType::Double));
        vertex.properties.insert(axis.to_owned(), property);
    }
    // A byte for the number of corners is what most programs expect.
    let is_small = mesh.faces.iter().all(|face| face.len() <= usize::from(u8::MAX));
    let count_type = if is_small { ScalarType::UChar } else { ScalarType::UInt };
    let mut face = ElementDef::new("face".to_owned());
    let corners = PropertyDef::new(CORNERS[0].to_owned(), PropertyType::List(count_type, ScalarType::UInt));
    face.properties.insert(CORNERS[0].to_owned(), corners);
    let elements = [
        (vertex, mesh.points.iter().map(|&position| Element { position, corners: Vec::new() }).collect::<Vec<_>>()),
        (face, mesh.faces.iter().map(|face| Element { position: DVec3::ZERO, corners: face.clone() }).collect()),
    ];
    for (definition, payload) in elements {
        ply.payload.insert(definition.name.clone(), payload);
        ply.header.elements.insert(definition.name.clone(), definition);
    }
    let mut bytes = Vec::new();
    Writer::new()
        .write_ply(&mut bytes, &mut ply)
        .map_err(|error| Error::new(Status::Internal, format!("PLY could not be written: {error}")))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty double x\n\
                          property double y\nproperty double z\nproperty uchar red\nelement face 1\n\
                          property list uchar int vertex_index\nend_header\n";

    fn refusal(text: &str) -> (usize, String) {
        let Refusal { line, reason } = read(text.as_bytes()).unwrap_err();
        (line, reason)
    }

    #[test]
    fn other_properties_and_elements_are_passed_over() {
        let text = HEADER.replace("element face", "element light 2\nproperty float power\nelement face");
        let source = read(format!("{text}0 0 0 255\n1 0 0 9\n0 1 0.1 9\n0.5\n0.5\n3 0 1 2\n").as_bytes()).unwrap();
        assert_eq!(source.mesh.points[2], DVec3::new(0.0, 1.0, 0.1));
        assert_eq!((source.mesh.faces, source.face_lines), (vec![vec![0, 1, 2]], vec![19]));
    }

    #[test]
    fn what_errs_is_named_with_its_line() {
        let points = "0 0 0 1\n1 0 0 1\n0 1 0 1\n";
        let cases = [
            (format!("{HEADER}{points}3 0 1 3\n"), 15, "face 0: [2]: 3 is out of range for 3 points"),
            (format!("{HEADER}{points}2 0 1\n"), 15, "face 0: expected a face of at least 3 corners, found 2"),
            (format!("{HEADER}{points}3 0 1 2\n3 0 1 2\n"), 0, "expected the end of the file after its elements"),
            (
                format!("{HEADER}0 0 0 1\n0 0 nan 1\n0 0 0 1\n3 0 1 2\n"),
                13,
                "Couldn't read element line. String: '0 0 nan 1 '",
            ),
            (format!("{HEADER}0 0 0 1\n0 0\n"), 13, "Couldn't read element line."),
            (format!("{HEADER}0 0 0 1\n"), 13, "Unexpected end of file while reading"),
            (HEADER.replace("double z", "double w"), 0, "expected a property \"z\" of the vertices, found none"),
            (HEADER.replace("vertex_index", "corners"), 0, "expected a property list \"vertex_indices\" of the faces"),
            (HEADER.replace("vertex 3", "point 3"), 0, "expected an element \"vertex\" in the header, found none"),
            ("solid\n".to_owned(), 1, "Expected magic number 'ply'."),
            (
                "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nend_header\n".to_owned(),
                0,
                "expected a property \"x\"",
            ),
            (
                HEADER
                    .replace("ascii", "binary_little_endian")
                    .replace("element face", "element a 99999999999999\nelement face"),
                0,
                "expected properties of the element \"a\", found none",
            ),
        ];
        for (text, line, reason) in cases {
            let found = refusal(&text);
            assert!(found.0 == line && found.1.starts_with(reason), "{text:?}: {found:?}");
        }
    }
}
