//! Figures of Flöry et al. 2012.
use anyhow::Result;
use std::path::Path;
pub fn draw(_: &Path, _: Option<&str>) -> Result<()> {
    Ok(())
}
