//! The files of a run: all written whole, under names that tell what they are.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use shapeop::mesh::Mesh;
use shapeop::mesh::file::{Format, encode, write_whole};

use crate::args::PictureFormat;
use crate::raster;
use crate::report::Report;

/// Where a run writes: `DIR/STEM.COMMAND` and what follows it.
pub struct Output {
    folder: PathBuf,
    stem: String,
    picture: PictureFormat,
    /// What was written, by what it is.
    written: Vec<(&'static str, PathBuf)>,
    frames: Vec<PathBuf>,
    sheets: Vec<PathBuf>,
}

impl Output {
    /// Makes the folder if it is not there.
    pub fn new(folder: &Path, input: &Path, command: &str, picture: PictureFormat) -> Result<Self> {
        std::fs::create_dir_all(folder).with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
        let name = input.file_stem().map_or("problem".into(), |stem| stem.to_string_lossy());
        Ok(Self {
            folder: folder.to_owned(),
            stem: format!("{name}.{command}"),
            picture,
            written: Vec::new(),
            frames: Vec::new(),
            sheets: Vec::new(),
        })
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}{ending}", self.stem))
    }

    fn write(&mut self, what: &'static str, ending: &str, bytes: &[u8]) -> Result<()> {
        let path = self.path(ending);
        write_whole(&path, bytes)?;
        self.written.push((what, path));
        Ok(())
    }

    /// Writes a text; `ending` follows the run's name.
    pub fn text(&mut self, what: &'static str, ending: &str, text: &str) -> Result<()> {
        self.write(what, ending, text.as_bytes())
    }

    /// Writes a drawing of many.
    pub fn sheet(&mut self, number: usize, svg: &str) -> Result<()> {
        let path = self.path(&format!(".sheet-{number:03}.svg"));
        write_whole(&path, svg.as_bytes())?;
        self.sheets.push(path);
        Ok(())
    }

    /// Where [`Self::mesh`] writes.
    pub fn mesh_path(&self, format: Format) -> String {
        self.path(&format!(".{format}")).display().to_string()
    }

    /// Writes the mesh of a frame; returns where.
    pub fn frame(&mut self, number: usize, mesh: &Mesh, format: Format) -> Result<String> {
        let path = self.path(&format!(".frame-{number:03}.{format}"));
        write_whole(&path, &encode(mesh, format)?)?;
        let name = path.display().to_string();
        self.frames.push(path);
        Ok(name)
    }

    /// Writes a frame that is no mesh.
    pub fn text_frame(&mut self, number: usize, extension: &str, text: &str) -> Result<()> {
        let path = self.path(&format!(".frame-{number:03}.{extension}"));
        write_whole(&path, text.as_bytes())?;
        self.frames.push(path);
        Ok(())
    }

    /// Writes what is no text; `ending` follows the run's name.
    pub fn bytes(&mut self, what: &'static str, ending: &str, bytes: &[u8]) -> Result<()> {
        self.write(what, ending, bytes)
    }

    pub fn mesh(&mut self, mesh: &Mesh, format: Format) -> Result<()> {
        self.write("mesh", &format!(".{format}"), &encode(mesh, format)?)
    }

    /// Writes another mesh than the main one; `ending` follows the run's name, before the extension.
    pub fn other_mesh(&mut self, what: &'static str, ending: &str, mesh: &Mesh, format: Format) -> Result<()> {
        self.write(what, &format!("{ending}.{format}"), &encode(mesh, format)?)
    }

    /// Writes a picture given as SVG in the format asked for. `what` also names the file, except for the first picture.
    pub fn picture(&mut self, what: &'static str, svg: &str) -> Result<()> {
        let Some(extension) = self.picture.extension() else { return Ok(()) };
        let ending = if what == "picture" { format!(".{extension}") } else { format!(".{what}.{extension}") };
        let bytes = if self.picture == PictureFormat::Svg { svg.as_bytes().to_vec() } else { raster::png(svg)? };
        self.write(what, &ending, &bytes)
    }

    pub fn wants_pictures(&self) -> bool {
        self.picture != PictureFormat::None
    }

    /// Writes the report, last, so that it lists the other files.
    pub fn report(&mut self, report: &mut Report) -> Result<()> {
        self.report_with(|files| {
            report.files = files;
            report.to_json()
        })
    }

    /// The same for any report: `to_json` is given the files by what they are.
    pub fn report_with(&mut self, to_json: impl FnOnce(BTreeMap<String, String>) -> Result<String>) -> Result<()> {
        let path = self.path(".json");
        let files = self.written.iter().map(|(what, path)| ((*what).to_owned(), path.display().to_string()));
        let text = to_json(files.chain([("report".to_owned(), path.display().to_string())]).collect())?;
        self.write("report", ".json", text.as_bytes())
    }

    /// The files written, in lines for the table.
    pub fn in_lines(&self) -> String {
        let line = |what: &str, path: &Path| format!("  {what:<12} {}", path.display());
        let mut lines: Vec<String> = self.written.iter().map(|(what, path)| line(what, path)).collect();
        for (many, one, paths) in [("frames", "frame", &self.frames), ("sheets", "sheet", &self.sheets)] {
            if let [first, .., last] = paths.as_slice() {
                let last = last.file_name().unwrap_or_default().to_string_lossy();
                lines.push(format!("{} … {last}", line(many, first)));
            } else if let [only] = paths.as_slice() {
                lines.push(line(one, only));
            }
        }
        lines.join("\n")
    }
}

/// Prints to standard output. A reader that has seen enough, such as `head`, is no failure.
pub fn say(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("standard output cannot be written"),
        _ => Ok(()),
    }
}
