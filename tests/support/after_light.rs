//! The reference's passes after shading.

use surfel::Settings;
use surfel::settings::Shading;
use surfel::verify::reference::{Projector, darkened, filtered, occluded};

/// A picture of colours and depths after the passes that follow its shading.
pub fn after_light(
    projector: &Projector,
    settings: &Settings,
    colours: Vec<[f64; 4]>,
    depths: &[f64],
    size: [u32; 2],
) -> Vec<[f64; 4]> {
    let mut picture = colours;
    if settings.occludes() {
        picture = occluded(projector, &picture, depths, size);
    }
    if settings.shading == Shading::Edl {
        picture = darkened(projector, &picture, depths, size);
    }
    if settings.filter_radius() > 0 {
        picture = filtered(settings, &picture, size);
    }
    picture
}
