//! Exact images: pictures of a scene's true surface, without points or splats.
//!
//! A float64 ray tracer with the camera, rays and shading of the float64 [reference](crate::verify::reference), for
//! anything [`Traceable`]: the [built-in scenes](crate::verify::scenes) and triangle [meshes](Mesh). Rays are
//! stratified in every pixel and refined where they differ, until the standard error of the filtered value meets
//! [`Options::error`].
//!
//! Values of a pixel, where `w` is the [`Filter`]'s weight of a ray's stratum:
//!
//! | | |
//! |---|---|
//! | α | `Σ w` over the rays that hit / `Σ w` over all |
//! | colour, normal | `Σ w c / Σ w` over the rays that hit, as in splatting; each ray is shaded separately, and normals
//! are normalized |
//! | depth | that of the ray through the pixel's centre, or of the nearest ray that hits; depths of two surfaces are
//! not averaged |
//!
//! Both sides of a surface are visible. [`Settings`] of splats (cut-off, low-pass, ε, culling) are ignored.

mod band;
mod cache;
mod eye;
mod kernel;
mod mesh;
mod options;
mod pixel;
mod sums;
mod supersampled;
#[cfg(test)]
mod tests;
mod traceable;

pub use cache::Cache;
pub use eye::{Eye, SurfaceHit};
pub use mesh::Mesh;
pub use options::{Filter, MOST_SAMPLES, MOST_VARIANCE, Options};
pub use supersampled::{MOST_SUPERSAMPLED, supersampled};
pub use traceable::{Hit, Traceable};

use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::progress::Progress;
use crate::settings::{Settings, Shading};
use band::Plan;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use sums::Sums;

/// An exact image.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Colour and α, depth and normals.
    pub picture: Picture,
    /// Its standard error.
    pub error: StandardError,
}

/// Standard error of an image, estimated per pixel: the larger of α's and, for shaded and coloured pictures, of the
/// channels' of linear light times α; for pictures of normals, of the coordinates' before normalization. It is
/// conservative: in smooth regions about twice the actual error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StandardError {
    /// Root mean square over all pixels.
    pub rms: f64,
    /// Of the worst pixel.
    pub max: f64,
    /// Pixels above the requested error, which reached [`Options::most_samples`].
    pub above: u64,
}

/// Most pixels of an image: their sums take about 5 GiB, and running out of memory would abort the process.
pub const MOST_PIXELS: u64 = 1 << 26;

/// Stage of the progress, in bands of rows.
const STAGE: &str = "tracing";

/// Bands in memory at once, per thread.
const AHEAD: usize = 4;

/// Renders `scene` as seen by `camera`; `size` is width and height in px. The same request gives the same image,
/// whatever the number of threads.
///
/// # Errors
/// [`Error::Usage`] for invalid options, settings, sizes and cameras; [`Error::Cancelled`] if `progress` cancels it.
pub fn render<S: Traceable + ?Sized>(
    scene: &S,
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Truth> {
    options.check()?;
    let [width, height] = size;
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(Error::Usage(format!(
            "an exact image of {width}x{height} px: give at most {MOST_PIXELS} pixels"
        )));
    }
    if settings.shading == Shading::Edl {
        let text = "eye-dome lighting darkens pixels, and has no exact picture: shade by color, or lit";
        return Err(Error::Usage(text.into()));
    }
    if settings.occludes() {
        let text = "ambient occlusion is of what a picture shows, and has no exact picture: leave it out";
        return Err(Error::Usage(text.into()));
    }
    let eye = Eye::new(scene, camera, settings, size)?;
    let plan = Plan::new(&eye, size, settings.shading, options);
    let mut sums = Sums::new(size);
    let (bands, done) = (plan.bands(), AtomicU64::new(0));
    progress.at(STAGE, 0, bands.len() as u64);
    for some in bands.chunks(AHEAD * rayon::current_num_threads()) {
        let traced: Option<Vec<_>> = some
            .par_iter()
            .map(|rows| {
                // Each band may take a second.
                if progress.is_cancelled() {
                    return None;
                }
                let band = plan.trace(rows.clone());
                progress.at(STAGE, done.fetch_add(1, Ordering::Relaxed) + 1, bands.len() as u64);
                Some(band)
            })
            .collect();
        // Sequentially, so that rounding does not depend on the threads.
        traced.ok_or(Error::Cancelled)?.iter().for_each(|band| sums.add(band));
    }
    Ok(sums.resolve(settings, options.error))
}
