//! Figures of Deng et al. 2015 on meshes of our own: what each claims, measured from coordinates, and a picture.

mod figure1;
mod figure10;
mod figure11;
mod figure2;
mod figure5;
mod figure8;
mod figure9;

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::Mesh;
use shapeop_cli::colours::Scale;
use shapeop_cli::picture::{On, Panel, Picture};
use shapeop_cli::raster;

use crate::group::Group;
use crate::session::Session;

/// How planar hard faces must be, and how near bounds must be met, over the mean edge.
const EXACT: f64 = 1e-8;

/// Pixels per unit of a picture.
const PIXELS: f32 = 1.0;

/// A figure that is given the folder for its picture.
type Figure = fn(&Path) -> Result<Group>;

const FIGURES: [(&str, Figure); 7] = [
    ("1", figure1::group),
    ("2", figure2::group),
    ("5", figure5::group),
    ("8", figure8::group),
    ("9", figure9::group),
    ("10", figure10::group),
    ("11", figure11::group),
];

/// Solves and draws all figures, or the one of this name, and prints a line for each.
pub fn draw(folder: &Path, name: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for (_, figure) in FIGURES.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", figure(folder)?);
    }
    Ok(())
}

/// A mesh kept for a panel, with the handles that are shown and a line of words.
struct Kept {
    title: String,
    caption: String,
    mesh: Mesh,
    on: On,
    values: Vec<f64>,
    handles: Vec<[DVec3; 2]>,
}

impl Kept {
    /// The mesh as it stands, a number on every face, and those of its handles that are among `shown`.
    fn faces(session: &Session, title: &str, on_face: impl Fn(&[DVec3]) -> f64, shown: &[u32]) -> Self {
        let mesh = session.mesh();
        let values = mesh.faces.iter().map(|face| on_face(&mesh.corners(face))).collect();
        Self::new(session, mesh, title, (On::Faces, values), shown)
    }

    /// The same with a number on every edge, of its length.
    fn edges(session: &Session, title: &str, of_length: impl Fn(f64) -> f64, shown: &[u32]) -> Self {
        let mesh = session.mesh();
        let values = session.lengths().into_iter().map(of_length).collect();
        Self::new(session, mesh, title, (On::Edges, values), shown)
    }

    fn new(session: &Session, mesh: Mesh, title: &str, (on, values): (On, Vec<f64>), shown: &[u32]) -> Self {
        let handles = session.solver.handles().filter(|(point, _)| shown.contains(point));
        let handles = handles.map(|(point, target)| [mesh.points[point as usize], target]).collect();
        Self { title: title.to_owned(), caption: String::new(), mesh, on, values, handles }
    }

    fn panel<'a>(&'a self, edges: &'a [[u32; 2]]) -> Panel<'a> {
        Panel {
            edges,
            values: self.values.clone(),
            on: self.on,
            caption: self.caption.clone(),
            handles: self.handles.clone(),
            ..Panel::new(&self.mesh, self.title.clone())
        }
    }

    fn caption(mut self, caption: String) -> Self {
        self.caption = caption;
        self
    }
}

/// What stands in a picture beside the meshes.
struct Words<'a> {
    title: &'a str,
    subtitle: &'a str,
    scale: Scale,
}

/// Draws meshes side by side into `folder/NAME.png`; returns the file's name.
fn picture(folder: &Path, name: &str, words: Words<'_>, edges: &[[u32; 2]], kept: &[Kept]) -> Result<String> {
    let panels = kept.iter().map(|kept| kept.panel(edges)).collect();
    let (title, subtitle, scale) = (words.title.to_owned(), words.subtitle.to_owned(), Some(words.scale));
    let svg = Picture { title, subtitle, panels, scale, fits_each: false }.to_svg();
    let file = folder.join(format!("{name}.png"));
    std::fs::write(&file, raster::png_at(&svg, PIXELS)?)?;
    Ok(file.display().to_string())
}

/// A scale from 0 to `high`.
fn scale(title: &str, unit: &'static str, high: f64) -> Scale {
    let title = title.to_owned();
    let end_words = ["", ""];
    Scale { title, unit, range: [0.0, high], is_diverging: false, mark: None, end_words }
}
