//! Levels of detail: a scene with surfels that stand for several points, for frames while the camera moves.

use std::sync::Arc;
use surfel::Scene;
use surfel::geometry::{Levels, Model, Parts};
use surfel::vk::Device;

/// Uploads a model with its levels of detail; `None` for a model without: one of few points, or with normalization weights.
///
/// Without memory for it there are no levels either: resolution alone can adapt then.
pub fn upload(device: &Arc<Device>, model: &Model) -> Option<Arc<Scene>> {
    let levels = Levels::of(model.surfels.clone()).ok().filter(|levels| !levels.table.starts().is_empty())?;
    let parts = Parts { surfels: &levels.surfels, levels: Some(&levels.table), ..model.into() };
    Scene::upload(device, parts).ok().map(Arc::new)
}
