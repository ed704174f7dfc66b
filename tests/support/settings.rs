//! Settings of frames.

use surfel::Settings;
use surfel::settings::methods::pull_push;
use surfel::settings::pull_push::Rules;
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

/// The culling of the preset with these rules of pull–push.
pub fn cull_of(rules: Rules) -> Cull {
    match rules {
        Rules::Paper => pull_push::PAPER.cull,
        Rules::Robust => pull_push::METHOD.cull,
    }
}
