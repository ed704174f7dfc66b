//! Levels of detail: a scene with surfels that stand for several points.

use std::sync::Arc;
use surfel::geometry::{Levels, Model, Parts, SurfelFormat};
use surfel::vk::Device;
use surfel::{Progress, Result, Scene};

/// Uploads a model; with its levels of detail, if it has any and there is memory for them.
///
/// # Errors
/// Those of [`Scene::upload`] without levels, and [`surfel::Error::Cancelled`].
pub fn upload_with(
    device: &Arc<Device>,
    model: &Model,
    format: SurfelFormat,
    progress: &dyn Progress,
) -> Result<Arc<Scene>> {
    match upload(device, model, format, progress)? {
        Some(scene) => Ok(scene),
        None => Scene::upload(device, Parts { format, ..model.into() }).map(Arc::new),
    }
}

/// Uploads a model with its levels of detail; `None` for a model without: one of few points, or with normalization weights.
///
/// Without memory for it there are no levels either: resolution alone can adapt then.
///
/// # Errors
/// [`surfel::Error::Cancelled`].
pub fn upload(
    device: &Arc<Device>,
    model: &Model,
    format: SurfelFormat,
    progress: &dyn Progress,
) -> Result<Option<Arc<Scene>>> {
    if model.surfels.weights.is_some() {
        return Ok(None);
    }
    let levels = Levels::build(model.surfels.clone(), progress)?;
    if levels.table.starts().is_empty() {
        return Ok(None);
    }
    let parts = Parts { surfels: &levels.surfels, levels: Some(&levels.table), format, ..model.into() };
    Ok(Scene::upload(device, parts).ok().map(Arc::new))
}
