//! Figures of Bartoň et al. 2013 on surfaces of our own: what each shows, measured, and a picture.

mod coverings;
mod curves;
mod drawing;
mod guided;
mod linkages;
mod meshes;

use std::path::Path;

use anyhow::Result;

use crate::group::Group;

type Figure = fn(&Path) -> Result<Group>;

/// Each with the name of its picture.
const FIGURES: [(&str, Figure); 14] = [
    ("covering", coverings::figure2),
    ("tower", coverings::figure5),
    ("curvatures", curves::figure7),
    ("rotation", curves::example2),
    ("initialisation", curves::figure9),
    ("driven", guided::figure10),
    ("offset", meshes::figure11),
    ("rigid", meshes::figure12),
    ("guided", guided::figure13),
    ("kinematic", guided::figure14),
    ("spacing", guided::figure15),
    ("cycle", linkages::figure16),
    ("array", linkages::figure17),
    ("singular", linkages::figure18),
];

/// Draws all figures, or the one of this name, and prints a line for each.
pub fn draw(folder: &Path, name: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for (_, figure) in FIGURES.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", figure(folder)?);
    }
    Ok(())
}
