//! Files of curves, of circles and of numbers: CSV, JSON, and polylines in OBJ. Errors name the file and the line.

use std::fmt;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use glam::DVec3;
use serde::de::{DeserializeOwned, Deserializer, MapAccess, SeqAccess, Visitor, value};
use serde::{Deserialize, Serialize};
use shapeop::geometry::circle::Circle;
use shapeop::mesh::file::decode_polylines;

/// The last point of a curve repeats the first below this multiple of the extent: files round coordinates.
const REPEATED: f64 = 1e-9;

/// A polyline that someone drew.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The file.
    pub name: String,
    /// Its points, in model units; a closed one has its first point again at the end.
    pub points: Vec<DVec3>,
    pub is_closed: bool,
    /// Whether the end was repeated in the file (rather than called closed).
    pub repeats_end: bool,
}

impl Curve {
    /// Reads a file of one curve, by its extension.
    pub fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        let (points, is_called_closed) = match extension(path).as_str() {
            "csv" | "txt" => (points_of_csv(&text_of(path)?, &name)?, false),
            "json" => {
                let JsonCurve { points, closed } = from_json(&text_of(path)?, &name)?;
                (points.into_iter().map(|JsonPoint(point)| point).collect(), closed)
            }
            "obj" => {
                let mut polylines = decode_polylines(&bytes_of(path)?, &name)?;
                if polylines.len() != 1 {
                    bail!("{name}: expected one polyline, found {}", polylines.len());
                }
                (polylines.remove(0), false)
            }
            found => bail!("{name}: expected the extension .csv, .json or .obj of a curve file, found \".{found}\""),
        };
        Self::new(name, points, is_called_closed)
    }

    /// Reads the curves of a file: of an OBJ file all its polylines, otherwise the one that it holds.
    pub fn read_all(path: &Path) -> Result<Vec<Self>> {
        if extension(path) != "obj" {
            return Ok(vec![Self::read(path)?]);
        }
        let name = path.display().to_string();
        let polylines = decode_polylines(&bytes_of(path)?, &name)?;
        polylines.into_iter().map(|points| Self::new(name.clone(), points, false)).collect()
    }

    fn new(name: String, mut points: Vec<DVec3>, is_called_closed: bool) -> Result<Self> {
        let least = if is_called_closed { 3 } else { 2 };
        if points.len() < least {
            bail!("{name}: expected a curve of at least {least} points, found {}", points.len());
        }
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let ends_meet = points[0].distance(points[points.len() - 1]) <= REPEATED * low.distance(high);
        let repeats_end = points.len() > 3 && ends_meet;
        if is_called_closed && !repeats_end {
            points.push(points[0]);
        }
        Ok(Self { name, points, is_closed: is_called_closed || repeats_end, repeats_end })
    }

    /// The points, each once.
    pub fn distinct(&self) -> &[DVec3] {
        &self.points[..self.points.len() - usize::from(self.is_closed)]
    }
}

/// Numbers of an option: written there, or in a file of one number a line (CSV) or of an array (JSON).
pub fn read_numbers(path: &Path) -> Result<Vec<f64>> {
    let name = path.display().to_string();
    match extension(path).as_str() {
        "csv" | "txt" => {
            let rows = rows_of_csv(&text_of(path)?, &name, &[1], "one number")?;
            Ok(rows.into_iter().map(|row| row[0]).collect())
        }
        "json" => from_json(&text_of(path)?, &name),
        _ => bail!("{name}: expected numbers separated by commas, or a file .csv or .json of numbers"),
    }
}

/// Reads circles: CSV of `x,y,r`, `x,y,z,r` or `x,y,z,r,nx,ny,nz` a line, or a JSON array of
/// `{"center": [x, y, z], "radius": r, "normal": [x, y, z]}`. A circle without a normal lies flat.
pub fn read_circles(path: &Path) -> Result<Vec<Circle>> {
    let name = path.display().to_string();
    let text = text_of(path)?;
    let circles: Vec<(DVec3, f64, DVec3)> = match extension(path).as_str() {
        "csv" | "txt" => {
            let what = "x,y,r or x,y,z,r or x,y,z,r,nx,ny,nz";
            let circle = |row: Vec<f64>| match row[..] {
                [x, y, r] => (DVec3::new(x, y, 0.0), r, DVec3::Z),
                [x, y, z, r] => (DVec3::new(x, y, z), r, DVec3::Z),
                _ => (DVec3::new(row[0], row[1], row[2]), row[3], DVec3::new(row[4], row[5], row[6])),
            };
            rows_of_csv(&text, &name, &[3, 4, 7], what)?.into_iter().map(circle).collect()
        }
        "json" => {
            let form = |circle: JsonCircle| {
                (circle.center.0, circle.radius, circle.normal.map_or(DVec3::Z, |JsonPoint(normal)| normal))
            };
            from_json::<Vec<JsonCircle>>(&text, &name)?.into_iter().map(form).collect()
        }
        found => bail!("{name}: expected the extension .csv or .json of a file of circles, found \".{found}\""),
    };
    let circle = |(i, (center, radius, normal)): (usize, (DVec3, f64, DVec3))| match normal.try_normalize() {
        Some(normal) => Ok(Circle { center, normal, radius }),
        None => Err(anyhow!("{name}: circles[{i}]: expected a normal other than zero")),
    };
    circles.into_iter().enumerate().map(circle).collect()
}

/// What a JSON text says; an error names the file, the line and the place in the text.
pub fn from_json<T: DeserializeOwned>(text: &str, name: &str) -> Result<T> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let path = error.path().to_string();
        let place = if path == "." { String::new() } else { format!("{path}: ") };
        in_line(name, &place, &error.into_inner())
    })?;
    deserializer.end().map_err(|error| in_line(name, "", &error))?;
    Ok(value)
}

fn in_line(name: &str, place: &str, error: &serde_json::Error) -> anyhow::Error {
    let reason = error.to_string();
    let reason = reason.split(" at line ").next().unwrap_or(&reason);
    anyhow!("{name}:{}: {place}{reason}", error.line())
}

/// The text of a file.
pub fn text_of(path: &Path) -> Result<String> {
    String::from_utf8(bytes_of(path)?).with_context(|| format!("{}: expected a text", path.display()))
}

fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| anyhow!("{}: cannot be read: {error}", path.display()))
}

pub fn extension(path: &Path) -> String {
    path.extension().map_or(String::new(), |extension| extension.to_string_lossy().to_ascii_lowercase())
}

fn points_of_csv(text: &str, name: &str) -> Result<Vec<DVec3>> {
    let point = |row: Vec<f64>| DVec3::new(row[0], row[1], row.get(2).copied().unwrap_or(0.0));
    Ok(rows_of_csv(text, name, &[2, 3], "x,y or x,y,z")?.into_iter().map(point).collect())
}

/// Rows of numbers, all as long as the first, of one of `counts`. The first line may be a header: no cell of it is a number.
fn rows_of_csv(text: &str, name: &str, counts: &[usize], what: &str) -> Result<Vec<Vec<f64>>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (number, record) in reader.records().enumerate() {
        let record = record.with_context(|| format!("{name}: expected {what}"))?;
        let line = record.position().map_or(0, csv::Position::line);
        if number == 0 && record.iter().all(|cell| cell.parse::<f64>().is_err()) {
            continue;
        }
        if !counts.contains(&record.len()) {
            bail!("{name}:{line}: expected {what}, found {} values", record.len());
        }
        if let Some(first) = rows.first().filter(|first| first.len() != record.len()) {
            bail!("{name}:{line}: expected {} values as above, found {}", first.len(), record.len());
        }
        let finite = |cell: &str| match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(anyhow!("{name}:{line}: expected a finite number, found \"{cell}\"")),
        };
        rows.push(record.iter().map(finite).collect::<Result<_>>()?);
    }
    Ok(rows)
}

/// `[x, y]` or `[x, y, z]`.
struct JsonPoint(DVec3);

impl<'de> Deserialize<'de> for JsonPoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Coordinates;
        impl<'de> Visitor<'de> for Coordinates {
            type Value = DVec3;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a point [x, y] or [x, y, z]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<DVec3, A::Error> {
                let mut coordinates = Vec::new();
                while let Some(value) = sequence.next_element::<f64>()? {
                    coordinates.push(value);
                }
                match coordinates[..] {
                    [x, y] => Ok(DVec3::new(x, y, 0.0)),
                    [x, y, z] => Ok(DVec3::new(x, y, z)),
                    _ => Err(serde::de::Error::invalid_length(coordinates.len(), &self)),
                }
            }
        }
        deserializer.deserialize_seq(Coordinates).map(Self)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JsonCircle {
    center: JsonPoint,
    radius: f64,
    #[serde(default)]
    normal: Option<JsonPoint>,
}

/// An array of points, or an object with it and whether the curve is closed.
struct JsonCurve {
    points: Vec<JsonPoint>,
    closed: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct JsonObject {
    points: Vec<JsonPoint>,
    #[serde(default)]
    closed: bool,
}

impl<'de> Deserialize<'de> for JsonCurve {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = JsonCurve;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of points, or {\"points\": [...], \"closed\": true}")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<JsonCurve, A::Error> {
                let points = Vec::deserialize(value::SeqAccessDeserializer::new(sequence))?;
                Ok(JsonCurve { points, closed: false })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<JsonCurve, A::Error> {
                let JsonObject { points, closed } = JsonObject::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(JsonCurve { points, closed })
            }
        }
        deserializer.deserialize_any(Either)
    }
}

/// A curve as a report tells of it.
#[derive(Clone, Debug, Serialize)]
pub struct CurveInReport {
    pub what: &'static str,
    pub file: String,
    /// Each once.
    pub points: usize,
    pub closed: bool,
    pub repeats_end: bool,
    /// The largest distance of one of its points from the mesh, in model units; null where the mesh is not meant to meet it.
    pub distance: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_has_comments_a_header_and_lines() {
        let text = "# a guide\nx, y\n0,0\n\n 1 , 2.5\n";
        assert_eq!(points_of_csv(text, "c.csv").unwrap(), [DVec3::ZERO, DVec3::new(1.0, 2.5, 0.0)]);
        let refusal = |text: &str| points_of_csv(text, "c.csv").unwrap_err().to_string();
        assert_eq!(refusal("0,0\n1,2,3\n"), "c.csv:2: expected 2 values as above, found 3");
        assert_eq!(refusal("x,y\n0,0\n1,inf\n"), "c.csv:3: expected a finite number, found \"inf\"");
        assert_eq!(refusal("0;0\n1;1\n"), "c.csv:2: expected x,y or x,y,z, found 1 values");
    }

    #[test]
    fn json_is_an_array_or_an_object() {
        let read = |text: &str| from_json::<JsonCurve>(text, "c.json");
        assert_eq!(read("[[0, 0], [1, 2, 3]]").unwrap().points[1].0, DVec3::new(1.0, 2.0, 3.0));
        assert!(read("{\"points\": [[0, 0]], \"closed\": true}").unwrap().closed);
        let refusal = |text: &str| read(text).err().unwrap().to_string();
        let found = refusal("{\"points\": [\n[0, 0],\n[1]]}");
        assert_eq!(found, "c.json:3: points[1]: invalid length 1, expected a point [x, y] or [x, y, z]");
        assert!(
            refusal("[[0, 0],\n[1, \"a\"]]").starts_with("c.json:2: [1][1]: invalid type: string \"a\", expected f64")
        );
        assert!(refusal("7").contains("expected an array of points, or {\"points\""));
        assert!(refusal("{\"point\": []}").contains("unknown field `point`"));
        assert!(refusal("[]\n7").starts_with("c.json:2: trailing characters"));
    }

    #[test]
    fn a_curve_is_closed_if_it_says_so_or_repeats_its_end() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        let curve = |points: &[DVec3], closed| Curve::new("c".to_owned(), points.to_vec(), closed).unwrap();
        let open = curve(&square, false);
        assert!(!open.is_closed && open.distinct().len() == 3);
        let said = curve(&square, true);
        assert!(said.is_closed && !said.repeats_end && said.points.len() == 4 && said.distinct() == square);
        let repeated = curve(&said.points, false);
        assert!(repeated.is_closed && repeated.repeats_end && repeated.distinct() == square);
        assert!(Curve::new("c".to_owned(), square[..2].to_vec(), true).is_err());
    }
}
