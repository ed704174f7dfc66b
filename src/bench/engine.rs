//! Who renders: each method behind the same few calls.

use super::record::{Contender, Memory, PIXELS, SPLATS};
use crate::error::Result;
use crate::geometry::{Camera, Surfels};
use crate::methods::perspective_ewa;
use crate::passes::Splats;
use crate::picture::Picture;
use crate::settings::Settings;
use crate::vk::{Device, PassTime};
use crate::yardstick::{self, Kind, Yardstick};
use crate::{Outputs, Precision, Rasterizer, RenderOptions, Renderer, Scene};
use std::sync::Arc;

/// A way to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Engine {
    /// `perspective-ewa` on a Vulkan device; without a rasterizer, with the one that the device is faster with.
    PerspectiveEwa {
        /// What visits the pixels.
        rasterizer: Option<Rasterizer>,
        /// Width of the sums.
        precision: Precision,
    },
    /// What a plain program on the CPU makes of the same.
    Yardstick(Kind),
}

impl Engine {
    /// `perspective-ewa` as it is shipped.
    pub const DEFAULT: Self = Self::PerspectiveEwa { rasterizer: None, precision: Precision::Full };

    /// Its name in the results.
    pub fn contender(&self) -> Contender {
        match self {
            Self::PerspectiveEwa { rasterizer, precision } => {
                let rasterizer = rasterizer.map(|rasterizer| match rasterizer {
                    Rasterizer::Draw => "draw",
                    Rasterizer::Compute => "compute",
                });
                let half = (*precision == Precision::Half).then_some("16-bit sums");
                let variant = rasterizer.into_iter().chain(half).collect::<Vec<_>>().join(", ");
                Contender { method: perspective_ewa::METHOD.name.into(), variant }
            }
            Self::Yardstick(Kind::Splats) => Contender { method: SPLATS.into(), variant: String::new() },
            Self::Yardstick(Kind::Pixels) => Contender { method: PIXELS.into(), variant: String::new() },
        }
    }
}

/// An engine with a scene in it, ready for frames of one size.
pub trait Ready {
    /// Renders a frame and waits for it; `timed` times its passes, which may cost time.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    fn frame(&mut self, camera: &Camera, settings: &Settings, timed: bool) -> Result<Vec<PassTime>>;

    /// Renders a frame with normals and depths, and reads it back.
    ///
    /// # Errors
    /// As [`Renderer::render_picture`].
    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture>;

    /// What the last frame took.
    fn memory(&self) -> Memory;
}

/// Surfels on a Vulkan device, with a renderer that makes no more than the picture and one that adds normals and depths.
pub struct OnDevice {
    scene: Scene,
    lean: Renderer,
    whole: Renderer,
}

impl OnDevice {
    /// Uploads `surfels`.
    ///
    /// # Errors
    /// As [`Scene::upload`] and [`Renderer::new`].
    pub fn new(
        device: &Arc<Device>,
        surfels: &Surfels,
        size: [u32; 2],
        rasterizer: Option<Rasterizer>,
        precision: Precision,
    ) -> Result<Self> {
        let lean = RenderOptions { size, rasterizer, precision, profile: true, ..Default::default() };
        let outputs = Outputs { normal: true, depth: true };
        let whole = RenderOptions { outputs, profile: false, ..lean };
        Ok(Self {
            scene: Scene::upload(device, surfels)?,
            lean: Renderer::new(device, lean)?,
            whole: Renderer::new(device, whole)?,
        })
    }
}

impl Ready for OnDevice {
    fn frame(&mut self, camera: &Camera, settings: &Settings, timed: bool) -> Result<Vec<PassTime>> {
        self.lean.profile(timed);
        Ok(self.lean.render(&self.scene, camera, settings)?.pass_times)
    }

    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        Ok(self.whole.render_picture(&self.scene, camera, settings)?.0)
    }

    fn memory(&self) -> Memory {
        Memory {
            scene: self.scene.bytes(),
            splats: self.lean.splats().map_or(0, Splats::bytes),
            targets: self.lean.targets().iter().map(|target| target.bytes).sum(),
        }
    }
}

/// Surfels in the yardstick.
pub struct OnHost {
    yardstick: Yardstick,
    kind: Kind,
    size: [u32; 2],
}

impl OnHost {
    /// Takes a copy of `surfels`.
    ///
    /// # Errors
    /// As [`Yardstick::new`].
    pub fn new(surfels: &Surfels, size: [u32; 2], kind: Kind) -> Result<Self> {
        Ok(Self { yardstick: Yardstick::new(surfels)?, kind, size })
    }
}

impl Ready for OnHost {
    fn frame(&mut self, camera: &Camera, settings: &Settings, _: bool) -> Result<Vec<PassTime>> {
        let outputs = Outputs::default();
        Ok(self.yardstick.frame(self.kind, camera, self.size, settings, outputs)?.to_vec())
    }

    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        let outputs = Outputs { normal: true, depth: true };
        self.yardstick.frame(self.kind, camera, self.size, settings, outputs)?;
        Ok(self.yardstick.picture())
    }

    fn memory(&self) -> Memory {
        let yardstick::Memory { scene, splats, targets } = self.yardstick.bytes();
        Memory { scene, splats, targets }
    }
}
