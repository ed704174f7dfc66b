//! `object-ewa` and `object-ewa-paper`: *Object Space EWA Surface Splatting: A Hardware Accelerated Approach to High Quality Point Rendering*, Ren, Pfister,
//! Zwicker, Eurographics 2002.
//!
//! ```text
//! footprint    V + J⁻¹ H J⁻ᵀ in the tangent plane (equation 7) → the parallelogram that it stretches (§5.2)
//! visibility   opaque quads + ε along the viewing ray (§5.1)
//! attribute    Σ w (rgb, 1/z), lit at each splat, over the splats within ε (§5.2)
//! normalize    / Σ w: per-pixel normalization (§7); or weights of the surfels: per-surfel normalization (§7.1)
//! ```
//!
//! [`Progressive`] divides at each pixel only while the camera rests (§8).
//!
//! `J` is singular edge-on, where the parallelogram would reach behind the eye: its scale is limited to the range from ½ to 2.

use super::{Method, PIXEL_FILTER};
use crate::geometry::Camera;
use crate::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use crate::settings::{Alpha, Cull, Edges, Settings, Widen};

/// The preset.
pub const METHOD: Method = Method {
    name: "object-ewa",
    paper: "Ren et al., Object Space EWA Surface Splatting, 2002",
    splatting: Splatting {
        footprint: Footprint::Parallelogram,
        kernel: Kernel::Gaussian,
        filter: Filter::Object,
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::Splat,
    },
    pull_push: None,
    // §5.2: ½ y·y ≤ c = 1.
    cutoff: std::f32::consts::SQRT_2,
    lowpass: 1.0,
    pixel_filter: PIXEL_FILTER,
    widen: Widen::All,
    cull: Cull::Auto,
    alpha: Alpha::Coverage,
    edges: Edges::Mixed,
};

/// The preset as published, of the higher quality: "refined by per-pixel normalization" (§8). That of higher speed needs surfels with
/// normalization weights, `--normalization surfel`. The paper gives no number for the depth threshold: "the average distance between the
/// surfels" (§5.1).
pub const PAPER: Method = Method {
    name: "object-ewa-paper",
    splatting: Splatting {
        footprint: Footprint::Parallelogram,
        kernel: Kernel::Gaussian,
        // Equation 7.
        filter: Filter::Object,
        // §5.1.
        visibility: Visibility::Ray,
        normalization: Normalization::Pixel,
        shade: Shade::Splat,
    },
    // §5.2: ½ y·y ≤ c = 1.
    cutoff: std::f32::consts::SQRT_2,
    // §3: "the identity matrix".
    lowpass: 1.0,
    pixel_filter: 0.0,
    // Equation 5.
    widen: Widen::All,
    // §6.2, there of whole blocks.
    cull: Cull::Back,
    alpha: Alpha::Mask,
    edges: Edges::Nearest,
    ..METHOD
};

/// The preset with normalization by surfel while the camera is `moving`, which needs surfels with normalization weights; otherwise by
/// pixel. A [`Renderer`](crate::Renderer) keeps the pipelines of both.
pub fn progressive(moving: bool) -> Settings {
    let normalization = if moving { Normalization::Surfel } else { Normalization::Pixel };
    Settings { splatting: Splatting { normalization, ..METHOD.splatting }, ..METHOD.settings() }
}

/// Progressive rendering. A camera moves while it differs from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct Progressive {
    last: Option<Camera>,
}

impl Progressive {
    /// Settings of the next frame with `camera`. The first frame counts as moving.
    pub fn settings(&mut self, camera: &Camera) -> Settings {
        progressive(self.last.replace(*camera) != Some(*camera))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DVec3};

    #[test]
    fn a_camera_that_rests_is_normalized_by_pixel() {
        let still = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0, 1.0, 0.1).unwrap();
        let turned = Camera { view: still.view * DMat4::from_rotation_y(1e-6), ..still };
        let mut progressive = Progressive::default();
        let frames = [still, still, still, turned, still, still].map(|camera| progressive.settings(&camera));
        let (moves, rests) = (Normalization::Surfel, Normalization::Pixel);
        let expected = [moves, rests, rests, moves, moves, rests];
        assert_eq!(frames.each_ref().map(|settings| settings.splatting.normalization), expected);
        assert_eq!(frames[1], METHOD.settings());
    }
}
