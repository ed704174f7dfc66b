//! Capture of normalization weights (Ren, Pfister, Zwicker 2002, section 7.2).
//!
//! ```text
//! views ─ render Σw and depth, without filter and division → 1/Σw of every visible surfel → median over the views → weights
//!                                      other surfels ─ overlap: Σw computed from the surfels around each ────┘
//! ```
//!
//! Where the surface ends, or the sum varies strongly between the centre of a surfel's square and a corner, each corner
//! gets a weight of its own. The paper's factor γ, which keeps 8-bit sums from overflowing, is not needed with floats.

mod corner_fit;
mod overlap;
mod samples;
mod views;
mod weight_view;

pub use overlap::overlaps;

use crate::Progress;
use crate::error::{Error, Result};
use crate::frame::{RenderOptions, Renderer};
use crate::geometry::{Camera, Surfels, Weights};
use crate::scene::Scene;
use crate::settings::Outputs;
use crate::settings::splatting::{Filter, Normalization, Splatting, Visibility};
use crate::settings::{Settings, Shading};
use crate::vk::Device;
use samples::Samples;
use std::sync::Arc;
use weight_view::WeightView;

/// Default number of views of a whole scene: about six of them see each point of a closed surface from less than 60°.
pub const VIEWS: u32 = 24;

/// Sources of captured weights, in numbers of surfels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Captured {
    /// Visible in a view.
    pub seen: u64,
    /// Of those, with a weight at each corner.
    pub borders: u64,
    /// Visible in no view: computed from the surfels around them.
    pub computed: u64,
}

/// Captures weights of all `surfels` in orthographic views from `views` directions, evenly distributed over a sphere.
/// They depend on the kernel, cut-off, footprint, ε and culling of `settings`. The stage of the progress is `capturing
/// weights`, in pictures.
///
/// # Errors
/// [`Error::Usage`] if there are no views, no valid surfels, or invalid settings; errors of rendering.
pub fn capture(
    device: &Arc<Device>,
    surfels: &Surfels,
    settings: &Settings,
    views: u32,
    progress: &dyn Progress,
) -> Result<(Weights, Captured)> {
    if views == 0 {
        return Err(Error::Usage("weights captured from no view: give 1 or more".into()));
    }
    let scene = Scene::upload(device, surfels)?;
    let (size, cameras) = views::cameras(surfels, &scene.bounds(), views)?;
    let mut renderer = renderer(device, [size; 2])?;
    let settings = plain(settings);
    let mut samples = Samples::default();
    for (done, camera) in (0..).zip(&cameras) {
        progress.at("capturing weights", done, cameras.len() as u64);
        samples.add(WeightView::new(&mut renderer, &scene, camera, &settings)?.samples(surfels));
    }
    progress.at("capturing weights", cameras.len() as u64, cameras.len() as u64);
    Ok(complete(surfels, &settings, samples))
}

/// Captures again the weights of the surfels that `camera` sees in a picture of `size` px, and returns their number.
/// Other weights stay, or become 1 if there were none. Surfels of less than two pixels, or seen from more than 60°, are
/// not captured.
///
/// # Errors
/// As [`capture`].
pub fn capture_region(
    device: &Arc<Device>,
    surfels: &mut Surfels,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
) -> Result<u64> {
    let scene = Scene::upload(device, &*surfels)?;
    let mut samples = Samples::default();
    samples.add(
        WeightView::new(&mut renderer(device, size)?, &scene, camera, &plain(settings))?.samples(surfels),
    );
    let seen = samples.medians();
    let before = surfels.weights.take();
    let weight = |i: usize| match (seen.get(i), &before) {
        (Some(weight), _) => weight,
        (None, Some(before)) => (before.of[i], before.corners_of(i)),
        (None, None) => (1.0, None),
    };
    surfels.weights = Some(Weights::collect((0..surfels.len()).map(weight)));
    Ok(seen.len() as u64)
}

/// The medians, and computed weights for the surfels that no view shows.
fn complete(surfels: &Surfels, settings: &Settings, samples: Samples) -> (Weights, Captured) {
    let seen = samples.medians();
    let unseen = |&i: &u32| seen.get(i as usize).is_none() && surfels.is_valid(i as usize);
    let unseen: Vec<u32> = (0..surfels.len() as u32).filter(unseen).collect();
    let mut weights = Weights::collect((0..surfels.len()).map(|i| seen.get(i).unwrap_or_default()));
    for (&surfel, sum) in unseen.iter().zip(overlaps(surfels, settings, &unseen)) {
        weights.of[surfel as usize] = (1.0 / sum) as f32;
    }
    let (borders, computed) = (weights.corners.len() as u64, unseen.len() as u64);
    let captured = Captured { seen: seen.len() as u64, borders, computed };
    // The remaining surfels are invalid and never drawn.
    (weights.filled().unwrap_or_default(), captured)
}

fn renderer(device: &Arc<Device>, size: [u32; 2]) -> Result<Renderer> {
    let outputs = Outputs { depth: true, ..Default::default() };
    Renderer::new(device, RenderOptions { size, outputs, ..Default::default() })
}

/// The two passes without filter and normalization, showing Σw: the settings that weights depend on.
pub(crate) fn plain(settings: &Settings) -> Settings {
    let (filter, normalization) = (Filter::None, Normalization::None);
    let splatting = Splatting { filter, normalization, visibility: Visibility::Ray, ..settings.splatting };
    Settings { splatting, shading: Shading::Weight, background: None, ..settings.clone() }
}
