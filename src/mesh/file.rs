//! Mesh files: OBJ, OFF and PLY, by the extension of their name.
//!
//! Text keeps every bit of a coordinate (the shortest decimal that reads back as the same number is written), binary PLY
//! holds doubles. Errors name the file and, in text, the line.

use std::fmt;
use std::fs;
use std::io::Write;
use std::path::Path;

use glam::DVec3;

use super::{Mesh, obj, off, ply};
use crate::error::{Error, Result, Status};

/// How a mesh is written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ, text.
    Obj,
    /// Object File Format, text.
    Off,
    /// Polygon File Format, text.
    PlyText,
    /// Polygon File Format, binary, least significant byte first: what `.ply` means when writing.
    Ply,
    /// Polygon File Format, binary, most significant byte first.
    PlyBigEndian,
}

impl Format {
    /// The format that the extension of `path` stands for.
    ///
    /// # Errors
    /// Status `InvalidInput` if it is none of `.obj`, `.off`, `.ply`, in whatever case.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("obj") => Ok(Self::Obj),
            Some("off") => Ok(Self::Off),
            Some("ply") => Ok(Self::Ply),
            found => {
                let found = found.map_or("none".to_owned(), |extension| format!("\".{extension}\""));
                let reason = format!("expected the extension .obj, .off or .ply of a mesh file, found {found}");
                Err(Error::new(Status::InvalidInput, reason).at(path.display()))
            }
        }
    }

    /// The extension of its files, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Off => "off",
            Self::PlyText | Self::Ply | Self::PlyBigEndian => "ply",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.extension())
    }
}

/// A mesh with the lines it was read from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// The mesh; it passes [`Mesh::check`].
    pub mesh: Mesh,
    /// The line, from 1, that each face stands on; empty for binary files.
    pub face_lines: Vec<usize>,
}

/// Reads a mesh file. See [`decode`] for what is read of it.
///
/// # Errors
/// It cannot be opened, its extension is unknown, or as [`decode`]; the place is `path` or `path:line`.
pub fn read(path: impl AsRef<Path>) -> Result<Mesh> {
    read_source(path).map(|source| source.mesh)
}

/// As [`read`], with the lines that the faces stand on.
///
/// # Errors
/// As [`read`].
pub fn read_source(path: impl AsRef<Path>) -> Result<Source> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    let bytes = fs::read(path)
        .map_err(|error| Error::new(Status::InvalidInput, format!("cannot be read: {error}")).at(path.display()))?;
    decode(&bytes, format, &path.display().to_string())
}

/// Reads a mesh from the contents of a file; `name` stands for it in errors. Any kind of PLY passes for any other.
///
/// Positions and faces are read, in their order. Texture coordinates, normals, colours, materials, groups, lines and the
/// weight `w` of an OBJ vertex (which only rational curves and surfaces have a use for) are passed over.
///
/// # Errors
/// Status `InvalidInput`, with `name:line` (in binary files `name`) as place: a number cannot be read or is not finite, a
/// face has fewer than 3 corners or one that does not exist, the file ends early or goes on after its end.
pub fn decode(bytes: &[u8], format: Format, name: &str) -> Result<Source> {
    let source = match format {
        Format::Obj => obj::read(bytes),
        Format::Off => off::read(bytes),
        Format::PlyText | Format::Ply | Format::PlyBigEndian => ply::read(bytes),
    };
    source.map_err(|refusal| refusal.in_file(name))
}

/// Reads the polylines of the contents of an OBJ file; `name` stands for it in errors. They are those of its `l` elements, of
/// which consecutive ones that go on from vertex to vertex are one; without any, the one through all vertices in their order. A
/// closed one repeats its first point.
///
/// # Errors
/// As [`decode`]; an element of fewer than 2 vertices, or faces and no `l` element.
pub fn decode_polylines(bytes: &[u8], name: &str) -> Result<Vec<Vec<DVec3>>> {
    obj::read_polylines(bytes).map_err(|refusal| refusal.in_file(name))
}

/// The contents of a file with `mesh` in it.
///
/// # Errors
/// As [`Mesh::check`].
pub fn encode(mesh: &Mesh, format: Format) -> Result<Vec<u8>> {
    mesh.check()?;
    match format {
        Format::Obj => Ok(obj::write(mesh)),
        Format::Off => Ok(off::write(mesh)),
        Format::PlyText | Format::Ply | Format::PlyBigEndian => ply::write(mesh, format),
    }
}

/// Writes a mesh file in the format of its extension, all of it or nothing.
///
/// # Errors
/// The extension is unknown, the mesh fails [`Mesh::check`], or as [`write_whole`].
pub fn write(mesh: &Mesh, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    write_whole(path, &encode(mesh, Format::of(path)?)?)
}

/// Writes a file under a temporary name beside `path` and renames it: a reader never sees half of it, and what was there
/// stays if anything fails.
///
/// # Errors
/// Status `InvalidInput` with `path` as place and the system's reason.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let refuse = |error: std::io::Error| {
        Error::new(Status::InvalidInput, format!("cannot be written: {error}")).at(path.display())
    };
    let Some(file_name) = path.file_name() else {
        return Err(refuse(std::io::Error::other("it names no file")));
    };
    let mut temporary_name = std::ffi::OsString::from(".");
    temporary_name.push(file_name);
    temporary_name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(temporary_name);
    let written = fs::File::create(&temporary)
        .and_then(|mut file| file.write_all(bytes).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|error| {
        // It may not be there; the first error is the one to tell.
        let _ = fs::remove_file(&temporary);
        refuse(error)
    })
}

/// Why a text could not be read, with its line from 1; 0 where there is none.
#[derive(Debug)]
pub(super) struct Refusal {
    pub line: usize,
    pub reason: String,
}

impl Refusal {
    pub fn new(line: usize, reason: impl Into<String>) -> Self {
        Self { line, reason: reason.into() }
    }

    fn in_file(self, name: &str) -> Error {
        let place = if self.line > 0 { format!("{name}:{}", self.line) } else { name.to_owned() };
        Error::new(Status::InvalidInput, self.reason).at(place)
    }
}

/// Reads a finite number.
pub(super) fn number(text: &str, line: usize) -> std::result::Result<f64, Refusal> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(Refusal::new(line, format!("expected a finite number, found \"{}\"", shortened(text)))),
    }
}

/// Reads the three coordinates that `words` begin with.
pub(super) fn position<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    line: usize,
) -> std::result::Result<DVec3, Refusal> {
    let mut coordinates = [0.0; 3];
    for (i, coordinate) in coordinates.iter_mut().enumerate() {
        let Some(word) = words.next() else {
            return Err(Refusal::new(line, format!("expected 3 coordinates, found {i}")));
        };
        *coordinate = number(word, line)?;
    }
    Ok(DVec3::from_array(coordinates))
}

/// Refuses a face with too few corners.
pub(super) fn check_corner_count(count: usize, line: usize) -> std::result::Result<(), Refusal> {
    if count >= 3 {
        return Ok(());
    }
    Err(Refusal::new(line, format!("expected a face of at least 3 corners, found {count}")))
}

/// The beginning of a text that may be long, for an error.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 80;
    if text.chars().count() <= MOST { text.to_owned() } else { text.chars().take(MOST).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polylines_of_an_obj_file_are_its_elements_or_all_vertices() {
        let vertices = "v 0 0 0\nv 1 0 0 1\nv 1 1 0\n";
        let read = |text: &str| decode_polylines(format!("{vertices}{text}").as_bytes(), "c.obj");
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]].map(DVec3::from);
        assert_eq!(read("# all\n").unwrap(), [points.to_vec()]);
        assert_eq!(read("l 1 2\nl 2 3\nl -1 1/1\n").unwrap(), [[points.to_vec(), vec![points[0]]].concat()]);
        assert_eq!(read("l 2 1\nl 3 2\n").unwrap(), [[points[1], points[0]], [points[2], points[1]]]);
        let refusal = |text: &str| read(text).unwrap_err().to_string();
        assert_eq!(refusal("l 1\n"), "c.obj:4: expected at least 2 vertices, found 1");
        assert_eq!(refusal("\nl 1 4\n"), "c.obj:5: vertex 4 is out of range for 3 vertices");
        assert_eq!(refusal("f 1 2 3\n"), "c.obj:4: expected a polyline \"l 1 2 3\", found a face: is it a mesh?");
        assert_eq!(refusal("v 1 2\n"), "c.obj:4: expected 3 coordinates, found 2");
    }

    #[test]
    fn the_extension_decides_in_any_case() {
        assert_eq!(Format::of(Path::new("a/B.OBJ")).unwrap(), Format::Obj);
        assert_eq!(Format::of(Path::new("b.Off")).unwrap(), Format::Off);
        assert_eq!(Format::of(Path::new("b.ply")).unwrap(), Format::Ply);
        let refusal = |path: &str| Format::of(Path::new(path)).unwrap_err().to_string();
        assert_eq!(refusal("b.3dm"), "b.3dm: expected the extension .obj, .off or .ply of a mesh file, found \".3dm\"");
        assert!(refusal("obj").ends_with("found none"));
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("shapeop-write-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        // A folder is in the way: the rename fails after the temporary file was written.
        let taken = folder.join("taken.obj");
        fs::create_dir_all(&taken).unwrap();
        let error = write_whole(&taken, b"v 0 0 0\n").unwrap_err().to_string();
        assert!(error.contains("taken.obj: cannot be written"), "{error}");
        let left: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["taken.obj"]);
        write_whole(&folder.join("free.obj"), b"v 0 0 0\n").unwrap();
        assert_eq!(fs::read(folder.join("free.obj")).unwrap(), b"v 0 0 0\n");
        fs::remove_dir_all(&folder).unwrap();
    }
}
