//! Textures that files of points name.

use super::image;
use super::source::{Parsed, check_regular};
use crate::geometry::MipMap;
use std::path::Path;
use std::sync::Arc;

/// The texture of a picture that another file names.
pub fn read(path: &Path) -> Parsed<Arc<MipMap>> {
    check_regular(path)?;
    let image = image::read(path).and_then(|picture| MipMap::new(&picture));
    image.map(Arc::new).map_err(|error| error.to_string().into())
}
