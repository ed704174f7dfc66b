//! Surfels that a host shows in turn, each uploaded by the first frame that shows it.

use super::arguments::Arguments;
use super::demo::FRAMES_IN_FLIGHT;
use super::{Host, Result, scene};
use ash::vk;
use glam::{DMat4, DVec3};
use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;
use surfel::Scene;
use surfel::embed::{self, Staging};
use surfel::estimate::Estimate;
use surfel::formats;
use surfel::geometry::{Bounds, Surfels};
use surfel::scene::Streams;
use surfel::vk::Device;

/// Models, of which one is visible.
pub struct Models {
    device: Arc<Device>,
    all: [Surfels; 2],
    /// Whether the first is from a file, with any position and size.
    is_file: bool,
    shown: usize,
    scene: Option<Arc<Scene>>,
    /// Staging memory of uploads, oldest first, with the number of frames that may still use it.
    staging: VecDeque<(Staging, u32)>,
}

impl Models {
    /// Creates the model of the requested file, otherwise the host's `own` with `count` surfels; and another with fewer.
    pub fn new(
        device: &Arc<Device>,
        arguments: &Arguments,
        own: impl FnOnce(u32) -> Result<Surfels>,
        count: u32,
    ) -> Result<Self> {
        let count = arguments.points.unwrap_or(count);
        let first = arguments.model.as_deref().map_or_else(|| own(count), read)?;
        let all = [first, scene::egg(count.div_ceil(3))];
        let (is_file, staging) = (arguments.model.is_some(), VecDeque::new());
        Ok(Self { device: device.clone(), all, is_file, shown: 0, scene: None, staging })
    }

    /// The streams of each model, for plans.
    pub fn streams(&self, host: &Host) -> Result<[Streams; 2]> {
        let mut streams = Vec::new();
        for surfels in &self.all {
            // SAFETY: recorded outside a render pass; both are kept until `run` has waited.
            let (scene, _staging) =
                host.run(|cmd| Ok(unsafe { embed::upload(&self.device, cmd, surfels)? }))?;
            streams.push(scene.streams());
        }
        streams.try_into().map_err(|_| "two models have two streams".into())
    }

    /// Shows the other model from now on.
    pub fn change(&mut self) {
        self.shown = (self.shown + 1) % self.all.len();
        self.scene = None;
    }

    /// The scene of a frame that is being recorded outside a render pass; the GPU has finished all frames but the last.
    pub fn scene(&mut self, cmd: vk::CommandBuffer) -> Result<Arc<Scene>> {
        self.staging.iter_mut().for_each(|(_, frames)| *frames -= 1);
        self.staging.retain(|(_, frames)| *frames > 0);
        if let Some(scene) = &self.scene {
            return Ok(scene.clone());
        }
        // SAFETY: by the caller; the frame that copies is over before the staging memory is dropped, and the renderer keeps the scene.
        let (scene, staging) = unsafe { embed::upload(&self.device, cmd, &self.all[self.shown])? };
        self.staging.push_back((staging, FRAMES_IN_FLIGHT));
        Ok(self.scene.insert(Arc::new(scene)).clone())
    }

    /// Transform of a model with these bounds to the origin, with radius 1.
    pub fn to_unit(&self, bounds: &Bounds) -> DMat4 {
        if self.is_file && self.shown == 0 {
            DMat4::from_scale(DVec3::splat(1.0 / bounds.radius)) * DMat4::from_translation(-bounds.centre())
        } else {
            DMat4::IDENTITY
        }
    }
}

fn read(file: &Path) -> Result<Surfels> {
    let loaded = formats::read(file, &Default::default(), &())?;
    Ok(loaded.cloud.into_surfels(&Estimate::default(), &())?.0)
}
