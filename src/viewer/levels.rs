//! Levels of detail: coarser scenes of ever fewer and larger surfels, for frames while the camera moves.

use std::borrow::Cow;
use std::sync::Arc;
use surfel::Scene;
use surfel::geometry::Model;
use surfel::vk::Device;

/// Ratio of the numbers of surfels of neighbouring levels.
const RATIO: f64 = 1.6;
/// About the number of surfels of the coarsest level.
pub const COARSEST: usize = 4000;
/// The least number of surfels of a level.
pub const MIN_SURFELS: usize = 2500;
/// Levels with at least this fraction of all surfels, 1/4, are made of all of them, which fits best. Coarser ones are made of the first level below
/// it, which takes far less time.
const EXACT_FRACTION: usize = 4;

/// Uploads the coarser levels of a model, finest first; none for a model with lines or triangles, which have no coarser form.
///
/// Stops at the first level that cannot be uploaded, and as soon as `is_cancelled`: resolution alone can adapt then.
pub fn upload(device: &Arc<Device>, model: &Model, is_cancelled: impl Fn() -> bool) -> Vec<Arc<Scene>> {
    let (mut scenes, all) = (Vec::new(), model.surfels.len());
    if !model.primitives.is_empty() {
        return scenes;
    }
    let (mut base, mut wanted, mut fewest) = (Cow::Borrowed(&model.surfels), all, all);
    while wanted > COARSEST && !is_cancelled() {
        wanted = (wanted as f64 / RATIO) as usize;
        let fewer = base.coarser(wanted);
        // Discs of opposite sides do not merge: a thin two-sided sheet may have no coarser level.
        if fewer.len() >= fewest || fewer.len() < MIN_SURFELS {
            continue;
        }
        fewest = fewer.len();
        let Ok(scene) = Scene::upload(device, &fewer) else { return scenes };
        scenes.push(Arc::new(scene));
        if fewest < all / EXACT_FRACTION && base.len() == all {
            base = Cow::Owned(fewer);
        }
    }
    scenes
}
