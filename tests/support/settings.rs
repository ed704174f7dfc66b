//! Settings of frames.

use surfel::Settings;
use surfel::settings::splatting::{Shade, Splatting};
use surfel::settings::{Alpha, Cull};

/// Splats alone: every splat is drawn, α is a mask, and pixels are neither filtered nor lit by mean normals.
pub fn splats_alone() -> Settings {
    Settings {
        splatting: Splatting { shade: Shade::Pixel, ..Splatting::default() },
        cutoff: 2.5,
        pixel_filter: 0.0,
        cull: Cull::None,
        alpha: Alpha::Mask,
        ..Settings::default()
    }
}

/// The same for pull–push, which has no splats.
pub fn points_alone() -> Settings {
    Settings { splatting: Splatting::default(), ..splats_alone() }
}
