//! What the window shows beneath its panels: a picture of the scene, or two side by side.
#![allow(unsafe_code, reason = "it is a host of `embed`, which is one of Vulkan")]

use super::side::{COLOUR, DEPTH, Seen, Side};
use glam::DVec2;
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::vk::{Attachment, Device, Presented, Recorder, RenderPass};
use surfel::{FrameReport, Rasterizer, Result, Scene, Settings};

/// Renders scenes and shows them.
pub struct Screen {
    // Fields are dropped in this order: what frames under way may use goes when the presenter, which waits for them, is gone.
    left: Side,
    /// Where there have been two pictures.
    right: Option<Side>,
    asked: Asked,
    /// Whether the last frame drew something anew.
    drew: bool,
    rasterizer: Option<Rasterizer>,
    pass: RenderPass,
    device: Arc<Device>,
}

/// What is asked of frames beside the scene.
#[derive(Clone, Default)]
pub struct Asked {
    /// Whether they tell their times and counts.
    pub measured: bool,
    /// Another for the same scene with other contents.
    pub version: u64,
    /// How the scene is rendered on the right, and where that begins, as part of the width.
    pub split: Option<(Settings, f64)>,
}

/// What the pictures tell that were drawn anew.
pub struct Reports {
    /// Of the only picture, or of the left one.
    pub left: Option<FrameReport>,
    pub right: Option<FrameReport>,
}

/// A place in a window's picture.
#[derive(Clone, Copy, Debug)]
pub struct Pick {
    /// Px.
    pub at: DVec2,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
}

impl Screen {
    pub fn new(device: &Arc<Device>, rasterizer: Option<Rasterizer>) -> Result<Self> {
        let pass = RenderPass::new(device, &[Attachment::Cleared(COLOUR)], Some(Attachment::Cleared(DEPTH)))?;
        let left = Side::new(device, &pass, rasterizer)?;
        let (asked, device) = (Asked::default(), device.clone());
        Ok(Self { left, right: None, asked, drew: false, rasterizer, pass, device })
    }

    /// What is asked of frames from now on.
    pub fn ask(&mut self, asked: Asked) {
        self.asked = asked;
    }

    /// Records a frame of `scene`, if there is one, of `size` px into the window's. After an error that is empty.
    pub fn record(
        &mut self,
        window: &Presented,
        size: [u32; 2],
        scene: Option<(&Arc<Scene>, &Camera, &Settings)>,
    ) -> Result<()> {
        let Asked { measured, version, split } = self.asked.clone();
        let seen = scene.map(|(scene, camera, settings)| Seen {
            scene: scene.clone(),
            camera: *camera,
            settings: settings.clone(),
            size,
            version,
            measured,
        });
        let drawn = self.left.record(window, &self.pass, seen.as_ref());
        self.drew = *drawn.as_ref().unwrap_or(&false);
        let mut drawn = drawn.map(|_| ());
        let (other, divider) = split.filter(|_| seen.is_some()).unzip();
        let divider = divider.unwrap_or(1.0);
        if let Some((seen, settings)) = seen.zip(other) {
            let right = self.record_right(window, &Seen { settings, ..seen });
            drawn = drawn.and(right);
        }
        // SAFETY: the presenter's command buffer is being recorded, and it submits in order.
        let mut rec = unsafe { Recorder::of_host(&self.device, window.cmd) };
        self.left.show(&mut rec, window, [0.0, divider]);
        if let Some(right) = self.right.as_ref().filter(|_| divider < 1.0) {
            right.show(&mut rec, window, [divider, 1.0]);
        }
        drawn
    }

    fn record_right(&mut self, window: &Presented, seen: &Seen) -> Result<()> {
        let right = match &mut self.right {
            Some(right) => right,
            none => none.insert(Side::new(&self.device, &self.pass, self.rasterizer)?),
        };
        self.drew |= right.record(window, &self.pass, Some(seen))?;
        Ok(())
    }

    /// Whether the last frame drew a picture anew, rather than show one that was there.
    pub fn drew(&self) -> bool {
        self.drew
    }

    /// What the last frame, which must be over, tells, once; nothing where it was not measured.
    pub fn reports(&mut self) -> Result<Reports> {
        let right = self.right.as_mut().map_or(Ok(None), Side::report)?;
        Ok(Reports { left: self.left.report()?, right })
    }

    /// The depth of the last frame at a place, which must be over; `None` where nothing is.
    pub fn pick(&self, Pick { at, size }: Pick) -> Option<f64> {
        let (own, depths) = self.left.depths()?;
        let part = at / DVec2::from(size.map(f64::from));
        let [x, y] = [0, 1].map(|axis| {
            let place = (part[axis] * f64::from(own[axis])).floor();
            (place >= 0.0 && place < f64::from(own[axis])).then_some(place as usize)
        });
        let first = 4 * (y? * own[0] as usize + x?);
        let depth = f32::from_ne_bytes(depths.get(first..first + 4)?.try_into().ok()?);
        (depth > 0.0).then_some(depth.into())
    }
}
