//! Exact images: what a picture of a scene would be if nothing stood between its surface and the camera.
//!
//! A ray tracer in float64 with the camera, the rays and the shading of the float64 [reference](crate::verify::reference), over anything that
//! can be [traced](Scene): the [built-in scenes](crate::verify::scenes) and triangle [meshes](Mesh). Rays are spread over every pixel in
//! strata, more where what they see differs, until the standard error of what the [`Filter`] makes of them is as small as the
//! [`Options`] ask.
//!
//! What the pixels hold, where `w` is the filter's weight of a ray's stratum:
//!
//! | | |
//! |---|---|
//! | α | `Σ w` of the rays that hit / `Σ w` of all |
//! | colour, normal | `Σ w c / Σ w` over the rays that hit, as splatting divides; each ray is shaded by itself. Normals are made unit again |
//! | depth | that of the ray through the pixel's centre, or of the nearest one to it that hits: a mean of two surfaces is none |
//!
//! Both sides of a surface are seen. [`Settings`] that concern splats (cut-off, low-pass, ε, culling) mean nothing here.

mod band;
mod cache;
mod eye;
mod kernel;
mod mesh;
mod options;
mod pixel;
mod scene;
mod sums;
#[cfg(test)]
mod tests;

pub use cache::Cache;
pub use eye::{Eye, Seen};
pub use mesh::Mesh;
pub use options::{Filter, MOST_SAMPLES, MOST_VARIANCE, Options};
pub use scene::{Hit, Scene};

use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::progress::Progress;
use crate::settings::Settings;
use band::Plan;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use sums::Sums;

/// An exact image.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Colour and α, depth and normals.
    pub picture: Picture,
    /// How exact it is.
    pub error: Achieved,
}

/// How exact an image is: the estimated standard error of its pixels, the larger of α's and, for lit and coloured pictures, of the
/// channels' of linear light multiplied by α; for pictures of normals, of the coordinates' before they are made unit. On the careful side:
/// where nothing jumps it is about twice what it should be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Achieved {
    /// Root mean square over all pixels.
    pub rms: f64,
    /// Of the worst pixel.
    pub max: f64,
    /// Pixels with more than was asked for, which ran into [`Options::most_samples`].
    pub above: u64,
}

/// Most pixels of an image: their sums take some 5 GiB, and running out of memory would stop the process.
pub const MOST_PIXELS: u64 = 1 << 26;

/// Stage of the progress; its unit is the band of rows.
const STAGE: &str = "tracing";

/// Bands that are held in memory at once, a thread.
const AHEAD: usize = 4;

/// Renders `scene` as `camera` sees it, `size` = width and height in px. The same request gives the same image, whatever the number of
/// threads.
///
/// # Errors
/// [`Error::Usage`] for options, settings, sizes and cameras of which no image can be made; [`Error::Cancelled`] where `progress` has it given up.
pub fn render<S: Scene + ?Sized>(
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
    let eye = Eye::new(scene, camera, settings, size)?;
    let plan = Plan::new(&eye, size, settings.shading, options);
    let mut sums = Sums::new(size);
    let (bands, done) = (plan.bands(), AtomicU64::new(0));
    progress.at(STAGE, 0, bands.len() as u64);
    for some in bands.chunks(AHEAD * rayon::current_num_threads()) {
        if progress.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let traced: Vec<_> = some
            .par_iter()
            .map(|rows| {
                let band = plan.trace(rows.clone());
                progress.at(STAGE, done.fetch_add(1, Ordering::Relaxed) + 1, bands.len() as u64);
                band
            })
            .collect();
        // One after the other, so that rounding does not depend on the threads.
        traced.iter().for_each(|band| sums.add(band));
    }
    Ok(sums.resolve(settings, options.error))
}
