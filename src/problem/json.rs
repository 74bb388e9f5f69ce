//! Reading and writing JSON forms. What is written has a line per point, constraint, force, face and edge, so that files are
//! short, a change is a changed line, and the line of an error is the thing that errs.

use std::io::{Result, Write};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::ser::Formatter;

use crate::error::{self, Error, Status};

/// Arrays and objects nested deeper than this stand on one line: 1 is the problem itself, 2 the list of points.
const LAST_BROKEN_DEPTH: usize = 2;

/// What a text says; an error names the place in it.
pub(crate) fn from_text<T: DeserializeOwned>(text: &str) -> error::Result<T> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let place = error.path().to_string();
        let refusal = Error::new(Status::InvalidInput, error.inner().to_string());
        if place == "." { refusal } else { refusal.at(place) }
    })?;
    deserializer.end().map_err(|error| Error::new(Status::InvalidInput, error.to_string()))?;
    Ok(value)
}

/// `value` as text that ends in a newline.
pub(crate) fn to_text(value: &impl Serialize) -> String {
    let mut bytes = Vec::new();
    // Neither the memory nor the plain data that is written can fail.
    let _ = value.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, Lines::default()));
    bytes.push(b'\n');
    String::from_utf8(bytes).unwrap_or_default()
}

#[derive(Default)]
struct Lines {
    depth: usize,
    has_entries: bool,
}

impl Lines {
    fn open<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> Result<()> {
        self.depth += 1;
        self.has_entries = false;
        writer.write_all(bracket)
    }

    fn close<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> Result<()> {
        let is_broken = self.has_entries && self.depth <= LAST_BROKEN_DEPTH;
        self.depth -= 1;
        if is_broken {
            self.indent(writer)?;
        }
        self.has_entries = true;
        writer.write_all(bracket)
    }

    fn entry<W: ?Sized + Write>(&mut self, writer: &mut W, is_first: bool) -> Result<()> {
        if !is_first {
            writer.write_all(b",")?;
        }
        if self.depth <= LAST_BROKEN_DEPTH {
            self.indent(writer)
        } else if is_first {
            Ok(())
        } else {
            writer.write_all(b" ")
        }
    }

    fn indent<W: ?Sized + Write>(&self, writer: &mut W) -> Result<()> {
        writer.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| writer.write_all(b"  "))
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.close(writer, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, is_first: bool) -> Result<()> {
        self.entry(writer, is_first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, _writer: &mut W) -> Result<()> {
        self.has_entries = true;
        Ok(())
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.open(writer, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, is_first: bool) -> Result<()> {
        self.entry(writer, is_first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> Result<()> {
        writer.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, _writer: &mut W) -> Result<()> {
        self.has_entries = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_thing_stands_on_a_line() {
        let value = serde_json::json!({
            "points": [[0.0, 1.0], [2.0, 3.0]], "none": [], "extra": {"a": [1, {"b": 2}], "c": {}}, "version": 1
        });
        let text = "{\n  \"extra\": {\n    \"a\": [1, {\"b\": 2}],\n    \"c\": {}\n  },\n  \"none\": [],\n  \"points\": \
                    [\n    [0.0, 1.0],\n    [2.0, 3.0]\n  ],\n  \"version\": 1\n}\n";
        assert_eq!(to_text(&value), text);
    }
}
