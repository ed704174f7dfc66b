//! Frames: makes what a frame needs when the scene or the settings change, records and submits it, reads it back.

use crate::error::{Error, Result};
use crate::frame::frame;
use crate::geometry::Camera;
use crate::methods::{PerspectiveEwa, Views};
use crate::passes::{SplatLayout, Splats};
use crate::picture::Picture;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::targets::Targets;
use crate::variant::{Outputs, Precision, Variant};
use crate::vk::shaders::layout::{Counts, Frame};
use crate::vk::{Access, Buffer, Commands, Device, PassTime, Recorder};
use std::collections::HashMap;
use std::sync::Arc;

/// What stays the same from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Images beside the picture.
    pub outputs: Outputs,
    /// Float width of the weighted sums. A device that cannot blend 32-bit floats gets 16, see [`Renderer::precision`].
    pub precision: Precision,
    /// Time the passes.
    pub profile: bool,
    /// Count the splats by their fate.
    pub count: bool,
}

/// What is known of a rendered frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameReport {
    /// GPU time by pass, if the frame was profiled and the device has timestamps.
    pub pass_times: Vec<PassTime>,
    /// Surfels by their fate, if they were counted.
    pub counts: Option<SplatCounts>,
}

/// Surfels by their fate in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SplatCounts {
    /// Drawn.
    pub drawn: u32,
    /// The centre is not in front of the eye.
    pub behind: u32,
    /// The disc reaches the eye plane.
    pub eye_plane: u32,
    /// The normal faces away, and such are culled.
    pub back: u32,
    /// Off the picture.
    pub outside: u32,
}

/// Renders frames of one size on one device. One frame is under way at a time.
pub struct Renderer {
    // Fields are dropped in this order: views before what they view.
    canvas: Option<Canvas>,
    resident: Option<Resident>,
    methods: HashMap<Variant, PerspectiveEwa>,
    layout: SplatLayout,
    frame: Buffer,
    commands: Commands,
    options: RenderOptions,
    device: Arc<Device>,
}

/// Targets of the present variant.
struct Canvas {
    variant: Variant,
    views: Views,
    targets: Targets,
    readback: Vec<Buffer>,
}

/// Splats of the present scene.
struct Resident {
    scene: u64,
    splats: Splats,
}

impl Renderer {
    /// A renderer that has made nothing for any scene yet.
    pub fn new(device: &Arc<Device>, options: RenderOptions) -> Result<Self> {
        let mut options = options;
        if !device.capabilities().blend_float32 && options.precision == Precision::Full {
            log::warn!("{} cannot blend 32-bit floats: sums are kept in 16 bits", device.description().name);
            options.precision = Precision::Half;
        }
        Ok(Self {
            canvas: None,
            resident: None,
            methods: HashMap::new(),
            layout: SplatLayout::new(device)?,
            frame: Buffer::uniform(device, "frame", size_of::<Frame>() as u64)?,
            commands: Commands::new(device, options.profile)?,
            options,
            device: device.clone(),
        })
    }

    /// Renders a frame and waits for it. Makes nothing that an earlier frame of the same scene and kind has made.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, settings: &Settings) -> Result<FrameReport> {
        self.run(scene, camera, settings, false)
    }

    /// Renders a frame and reads it back.
    pub fn render_picture(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<(Picture, FrameReport)> {
        let report = self.run(scene, camera, settings, true)?;
        let canvas = self.canvas.as_ref().ok_or_else(|| Error::Usage("no frame was rendered".into()))?;
        Ok((canvas.picture(), report))
    }

    /// Float width of the weighted sums in use.
    pub fn precision(&self) -> Precision {
        self.options.precision
    }

    /// The targets of the last frame.
    pub fn targets(&self) -> Option<&Targets> {
        self.canvas.as_ref().map(|canvas| &canvas.targets)
    }

    /// The splats of the last frame.
    pub fn splats(&self) -> Option<&Splats> {
        self.resident.as_ref().map(|resident| &resident.splats)
    }

    fn run(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<FrameReport> {
        settings.check()?;
        let options = self.options;
        let block = frame(camera, settings, options.size, scene.origin(), scene.bounds())?;
        let perspective = camera.projection()?.perspective;
        let variant =
            Variant::new(scene, perspective, settings, options.outputs, options.precision, options.count);
        self.make_ready(scene, variant, read)?;
        self.frame.bytes_mut().copy_from_slice(bytemuck::bytes_of(&block));

        let (Some(canvas), Some(resident)) = (&self.canvas, &self.resident) else {
            return Ok(FrameReport::default());
        };
        let method = &self.methods[&variant];
        self.commands.run(|rec| {
            method.record(rec, &resident.splats, &canvas.views, &canvas.targets);
            if read {
                canvas.read_back(rec);
            }
        })?;
        Ok(FrameReport {
            pass_times: self.commands.pass_times()?,
            counts: options.count.then(|| resident.splats.counts().into()),
        })
    }

    fn make_ready(&mut self, scene: &Scene, variant: Variant, read: bool) -> Result<()> {
        if self.resident.as_ref().is_none_or(|resident| resident.scene != scene.id) {
            self.resident = None;
            let splats = Splats::new(&self.device, &self.layout, &self.frame, scene)?;
            self.resident = Some(Resident { scene: scene.id, splats });
        }
        if !self.methods.contains_key(&variant) {
            self.methods.insert(variant, PerspectiveEwa::new(&self.device, &self.layout, &variant)?);
        }
        if self.canvas.as_ref().is_none_or(|canvas| canvas.variant != variant) {
            self.canvas = None;
            let targets = Targets::new(&self.device, &variant, self.options.size)?;
            let views = self.methods[&variant].views(&self.device, &self.frame, &targets)?;
            self.canvas = Some(Canvas { variant, views, targets, readback: Vec::new() });
        }
        match &mut self.canvas {
            Some(canvas) if read => canvas.make_readback(&self.device),
            _ => Ok(()),
        }
    }
}

impl Canvas {
    fn make_readback(&mut self, device: &Arc<Device>) -> Result<()> {
        if !self.readback.is_empty() {
            return Ok(());
        }
        let [width, height] = self.targets.size();
        let pixels = u64::from(width) * u64::from(height);
        let buffer =
            |image: &crate::vk::Image| Buffer::readback(device, "readback", pixels * image.pixel_bytes());
        self.readback = self.targets.read_back().map(buffer).collect::<Result<_>>()?;
        Ok(())
    }

    fn read_back(&self, rec: &mut Recorder<'_>) {
        let pairs = || self.targets.read_back().zip(&self.readback);
        let copy = pairs()
            .flat_map(|(image, buffer)| [image.with(Access::COPY_READ), buffer.with(Access::COPY_WRITE)]);
        rec.pass("read back", &copy.collect::<Vec<_>>(), |enc| {
            pairs().for_each(|(image, buffer)| enc.copy_image(image, buffer));
        });
        let host: Vec<_> = self.readback.iter().map(|buffer| buffer.with(Access::HOST_READ)).collect();
        rec.pass("read back", &host, |_| {});
    }

    /// What the last frame left in the read-back buffers.
    fn picture(&self) -> Picture {
        let mut images = self.readback.iter().map(Buffer::bytes);
        let mut next = |there: bool| if there { images.next() } else { None };
        let colour = next(true).map(bytemuck::pod_collect_to_vec).unwrap_or_default();
        let normal = next(self.targets.normal.is_some()).map(|bytes| {
            let padded: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(bytes);
            padded.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()
        });
        let depth = next(self.targets.depth.is_some()).map(bytemuck::pod_collect_to_vec);
        Picture { size: self.targets.size(), colour, depth, normal }
    }
}

impl From<Counts> for SplatCounts {
    fn from(counts: Counts) -> Self {
        let Counts { drawn, behind, eye_plane, back, outside } = counts;
        Self { drawn, behind, eye_plane, back, outside }
    }
}
