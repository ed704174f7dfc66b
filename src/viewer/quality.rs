//! Quality of a frame: its resolution and its level of detail.

use super::cost::Work;

/// Resolution scales of the side. Neighbours differ by 1.6 in pixels, so that one step finer takes at most 1.6 times as long.
const SCALES: [f64; 7] = [1.0, 0.8, 0.63, 0.5, 0.4, 0.32, MIN_SCALE];
/// The least resolution scale: coarser pictures are unreadable.
pub const MIN_SCALE: f64 = 0.25;

/// Resolution and level of detail of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the picture as part of the full one's.
    pub scale: f64,
    /// Level of detail: 0 has all surfels, each further one fewer.
    pub level: usize,
}

impl Quality {
    /// Every pixel and every surfel.
    pub const FULL: Self = Self { scale: 1.0, level: 0 };

    /// Whether this is at most one step finer than `other`, in resolution or in level of detail. Only then do the times of frames at `other`
    /// predict those at this quality.
    pub fn is_one_step_finer_at_most(&self, other: Self) -> bool {
        let step = |scale: f64| SCALES.iter().position(|one| *one == scale).unwrap_or(0);
        let [pixels, surfels] =
            [step(other.scale).saturating_sub(step(self.scale)), other.level.saturating_sub(self.level)];
        pixels + surfels <= 1
    }
}

/// What a frame of full quality renders, and the levels of detail that there are.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Pixels of the window's picture.
    pub pixels: f64,
    /// Number of surfels of each level of detail, finest first.
    pub surfels: Vec<f64>,
    /// Diameter of the scene's bounding sphere in the picture, px.
    pub diameter_px: f64,
}

impl Workload {
    /// What a frame of this quality has to do.
    pub fn work(&self, Quality { scale, level }: Quality) -> Work {
        let surfels = self.surfels.get(level).or(self.surfels.last());
        Work { pixels: self.pixels * scale * scale, surfels: surfels.copied().unwrap_or(0.0) }
    }

    /// Size of the smallest detail that a frame shows, in px of full resolution: the distance of its pixels and that of its surfels, combined.
    pub fn blur(&self, quality: Quality) -> f64 {
        // The surfels are taken to be spread over a sphere, half of which faces the camera.
        let surfels = self.work(quality).surfels.max(1.0);
        let spacing = self.diameter_px * (0.5 * std::f64::consts::PI / surfels).sqrt();
        (1.0 / quality.scale).hypot(spacing)
    }

    /// Every combination of resolution scale and level of detail.
    pub fn choices(&self) -> impl Iterator<Item = Quality> + use<> {
        let levels = self.surfels.len().max(1);
        (0..levels).flat_map(|level| SCALES.map(|scale| Quality { scale, level }))
    }
}
