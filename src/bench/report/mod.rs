//! The HTML report: one file without external resources, and each plot as an SVG file beside it.

mod aliasing;
mod baseline;
mod budget;
mod ceilings;
mod convergence;
mod effects;
mod glossary;
mod hard;
mod images;
mod inventory;
mod lowpass;
mod machines;
mod page;
mod papers;
mod path;
mod path_page;
mod plot;
mod provenance;
mod pull_push;
mod scaling;
mod summary;
mod views;

pub use path_page::PathReport;

use super::record::Results;
use crate::error::{Error, Result};
use crate::formats::atomic;
use page::Page;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes `index.html` and the plots into `folder`, which is created if it is missing. Returns the paths of all files,
/// `index.html` first.
///
/// `code` is the present program's source digest and `commit` its commit: results of other code are marked as out of
/// date.
///
/// # Errors
/// [`Error::Io`] if the folder cannot be created or a file cannot be written. Files are written atomically.
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
