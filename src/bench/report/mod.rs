//! The page: what was measured, drawn and said, in one HTML file that loads nothing, with each plot as SVG beside it.

mod aliasing;
mod baseline;
mod budget;
mod effects;
mod glance;
mod hard;
mod lowpass;
mod machines;
mod made;
mod page;
mod papers;
mod pictures;
mod plot;
mod points;
mod points_alone;
mod scaling;
mod terms;

use super::record::Results;
use crate::error::{Error, Result};
use crate::formats::atomic;
use page::Page;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes `index.html` and the plots into `folder`, which is made if it is missing; the paths of all files, the page first.
///
/// `code` is the digest of the present program's code and `commit` its commit: what was measured by other code is marked as such.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be made or a file not be written. Each file appears whole or not at all.
pub fn write(results: &Results, code: &str, commit: &str, folder: &Path) -> Result<Vec<PathBuf>> {
    let mut page = Page::new(results, code, commit);
    let html = page.build().map_err(Error::io(folder, "cannot draw a plot of"))?;
    std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot make the folder"))?;
    let plots = page.plots.into_iter().map(|(name, svg)| (name + ".svg", svg));
    let mut paths = Vec::new();
    for (name, text) in std::iter::once(("index.html".to_owned(), html)).chain(plots) {
        let path = folder.join(name);
        atomic::write(&path, |out| out.write_all(text.as_bytes()))?;
        paths.push(path);
    }
    Ok(paths)
}
