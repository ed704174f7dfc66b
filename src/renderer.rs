//! Frames: makes what a frame needs when the scene or the settings change, records and submits it, reads it back.

use crate::error::{Error, Result};
use crate::frame::frame;
use crate::geometry::Camera;
use crate::methods::{Canvas, Pipelines};
use crate::passes::{SplatLayout, Splats};
use crate::picture::Picture;
use crate::scene::Scene;
use crate::settings::{Alpha, Settings};
use crate::splatting::Visibility;
use crate::targets::{Buffers, Pyramids, TargetInfo, check_size};
use crate::variant::{Outputs, Precision, Rasterizer, Variant};
use crate::vk::shaders::layout::{Counts, Frame};
use crate::vk::{Buffer, Commands, Device, DeviceDescription, PassTime};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// What stays the same from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Images beside the picture.
    pub outputs: Outputs,
    /// Float width of the weighted sums, or of the samples of pull–push. A device that cannot blend 32-bit floats gets sums of 16, see
    /// [`Renderer::precision`].
    pub precision: Precision,
    /// What visits the pixels; `None` takes what is faster on the device.
    pub rasterizer: Option<Rasterizer>,
    /// Time the passes; see also [`Renderer::profile`].
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
    /// The disc reaches the eye plane, or comes within 1/20000 of its distance to it.
    pub eye_plane: u32,
    /// The normal faces away, and such are culled.
    pub back: u32,
    /// Off the picture, or without an area on it: exactly edge-on, or too small to weigh anything.
    pub outside: u32,
    /// Not [valid](crate::geometry::Surfels::is_valid), or with an image too large for float32.
    pub invalid: u32,
}

/// Renders frames of one size on one device. One frame is under way at a time.
pub struct Renderer {
    // Fields are dropped in this order: views before what they view.
    present: Option<Present>,
    /// What was before it: who switches to and fro, as in progressive rendering, makes nothing.
    previous: Option<Present>,
    resident: Option<Resident>,
    pipelines: HashMap<Variant, Pipelines>,
    layout: SplatLayout,
    frame: Buffer,
    commands: Commands,
    options: RenderOptions,
    /// Width of the weighted sums, which the device may not have as it was asked for.
    sums: Precision,
    device: Arc<Device>,
}

/// Targets of the present variant.
struct Present {
    variant: Variant,
    canvas: Canvas,
    readback: Vec<Buffer>,
}

/// Splats of the present scene.
struct Resident {
    scene: u64,
    /// What it makes splats for, if any.
    rasterizer: Option<Rasterizer>,
    splats: Splats,
}

impl Renderer {
    /// A renderer that has made nothing for any scene yet.
    pub fn new(device: &Arc<Device>, options: RenderOptions) -> Result<Self> {
        check_size(device, options.size)?;
        let rasterizer = rasterizer_for(device, &options, true, Alpha::Mask)?;
        let blends = device.capabilities().blend_float32;
        let mut sums = options.precision;
        if rasterizer == Rasterizer::Draw && options.precision == Precision::Full && !blends {
            log::warn!("{} cannot blend 32-bit floats: sums are kept in 16 bits", device.description().name);
            sums = Precision::Half;
        }
        Ok(Self {
            present: None,
            previous: None,
            resident: None,
            pipelines: HashMap::new(),
            layout: SplatLayout::new(device)?,
            frame: Buffer::uniform(device, "frame", size_of::<Frame>() as u64)?,
            commands: Commands::new(device, options.profile)?,
            options,
            sums,
            device: device.clone(),
        })
    }

    /// Renders a frame and waits for it. Makes nothing that an earlier frame of the same scene and kind has made,
    /// if no more than one other kind came between.
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
        let picture = self.present.as_ref().map(|present| present.canvas.picture(&present.readback));
        Ok((picture.unwrap_or_default(), report))
    }

    /// Whether later frames are profiled, if [`RenderOptions::profile`] was asked for: what a whole frame costs is best timed without.
    pub fn profile(&mut self, on: bool) {
        self.commands.time(on);
    }

    /// Float width of the samples of the last frame, if it was pull–push's, else of the weighted sums.
    pub fn precision(&self) -> Precision {
        self.present.as_ref().map_or(self.sums, |present| present.variant.precision)
    }

    /// The targets of the last frame.
    pub fn targets(&self) -> Vec<TargetInfo> {
        self.present.as_ref().map_or(Vec::new(), |present| present.canvas.targets())
    }

    /// What visits the pixels in the last frame.
    pub fn rasterizer(&self) -> Option<Rasterizer> {
        self.present.as_ref().map(|present| present.variant.rasterizer)
    }

    /// The splats of the last frame.
    pub fn splats(&self) -> Option<&Splats> {
        self.resident.as_ref().map(|resident| &resident.splats)
    }

    /// The pyramids of the last frame, if it was pull–push's.
    pub fn pyramids(&self) -> Option<&Pyramids> {
        self.present.as_ref().and_then(|present| present.canvas.pyramids())
    }

    fn run(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<FrameReport> {
        settings.check()?;
        settings.splatting.normalization.check_weights(scene.weights.is_some())?;
        settings.check_primitives(scene.primitives.is_some())?;
        settings.check_outputs(self.options.outputs)?;
        let block = frame(camera, settings, self.options.size, scene.origin(), scene.bounds())?;
        let blends = settings.splatting.visibility != Visibility::Nearest;
        let rasterizer = match settings.pull_push {
            Some(_) => projects(&self.device, &self.options)?,
            None => rasterizer_for(&self.device, &self.options, blends, settings.alpha)?,
        };
        let perspective = camera.projection()?.perspective;
        let precision = if settings.pull_push.is_some() { self.options.precision } else { self.sums };
        let options = RenderOptions { precision, ..self.options };
        let variant = Variant::new(scene.streams(), perspective, settings, &options, rasterizer);
        let splats = variant.pull_push.is_none().then_some(variant.rasterizer);
        self.make_resident(scene, splats)?;
        self.make_present(variant, read)?;
        self.frame.bytes_mut().copy_from_slice(bytemuck::bytes_of(&block));

        let (Some(present), Some(resident)) = (&self.present, &self.resident) else {
            return Ok(FrameReport::default());
        };
        self.commands.run(|rec| {
            present.canvas.record(rec, &resident.splats);
            if read {
                present.canvas.record_readback(rec, &present.readback);
            }
        })?;
        Ok(FrameReport {
            pass_times: self.commands.pass_times()?,
            counts: (variant.count && variant.pull_push.is_none())
                .then(|| SplatCounts::new(scene.count(), resident.splats.counts())),
        })
    }

    fn make_resident(&mut self, scene: &Scene, rasterizer: Option<Rasterizer>) -> Result<()> {
        if self
            .resident
            .as_ref()
            .is_none_or(|resident| (resident.scene, resident.rasterizer) != (scene.id, rasterizer))
        {
            self.resident = None;
            let splats = Splats::new(&self.device, &self.layout, &self.frame, scene, rasterizer)?;
            self.resident = Some(Resident { scene: scene.id, rasterizer, splats });
        }
        Ok(())
    }

    fn make_present(&mut self, variant: Variant, read: bool) -> Result<()> {
        let is_other = |present: &Option<Present>| present.as_ref().is_none_or(|p| p.variant != variant);
        if is_other(&self.present) {
            std::mem::swap(&mut self.present, &mut self.previous);
        }
        if is_other(&self.present) {
            self.present = None;
            let pipelines = match self.pipelines.entry(variant) {
                Entry::Occupied(made) => made.into_mut(),
                Entry::Vacant(room) => room.insert(Pipelines::new(&self.device, &self.layout, &variant)?),
            };
            let canvas =
                pipelines.canvas(&self.device, &self.layout, &self.frame, &variant, self.options.size)?;
            self.present = Some(Present { variant, canvas, readback: Vec::new() });
        }
        match &mut self.present {
            Some(present) if read && present.readback.is_empty() => {
                present.readback = present.canvas.make_readback(&self.device)?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// What projects points: compute shaders.
fn projects(device: &Device, options: &RenderOptions) -> Result<Rasterizer> {
    let name = &device.description().name;
    match options.rasterizer {
        Some(Rasterizer::Draw) => {
            Err(Error::Usage("pull-push is computed alone: leave the rasterizer open".into()))
        }
        _ if !device.capabilities().int64_atomics => Err(Error::Usage(format!(
            "pull-push needs 64-bit atomics in buffers, which {name} does not have: choose a method that splats"
        ))),
        _ if !Pyramids::fit(device.capabilities(), options) => Err(too_large(device, options)),
        _ => Ok(Rasterizer::Compute),
    }
}

/// That pyramids do not fit the device, and what would.
fn too_large(device: &Device, options: &RenderOptions) -> Error {
    let capabilities = device.capabilities();
    let half = RenderOptions { precision: Precision::Half, ..*options };
    let halved = match Pyramids::fit(capabilities, &half) {
        true => "samples of 16 bits (--half), or ",
        false => "",
    };
    let ([width, height], [most_width, most_height]) =
        (options.size, Pyramids::largest(capabilities, options));
    Error::Usage(format!(
        "pyramids of {width}x{height} px do not fit the {} bytes of a buffer that shaders of {} can see (maxStorageBufferRange): \
         choose {halved}at most {most_width}x{most_height} px",
        capabilities.max_storage_buffer_range,
        device.description().name
    ))
}

/// The faster of what `device` can do with these options, for frames that blend splats or do not.
fn rasterizer_for(
    device: &Device,
    options: &RenderOptions,
    blends: bool,
    alpha: Alpha,
) -> Result<Rasterizer> {
    let capabilities = device.capabilities();
    let fits = Buffers::fit(capabilities, options.outputs, options.size);
    let (needed, atomics) = match blends {
        true => ("float atomics", capabilities.float_atomics),
        false => ("64-bit atomics", capabilities.int64_atomics),
    };
    let can_compute = atomics && options.precision == Precision::Full && fits;
    let covers = capabilities.fragment_writes && Buffers::fit_coverage(capabilities, options.size);
    let can_draw = alpha == Alpha::Mask || covers;
    match options.rasterizer {
        Some(Rasterizer::Compute) if !can_compute => Err(Error::Usage(format!(
            "the compute rasterizer needs {needed} in buffers, 32-bit sums and a picture within {} bytes, which {} does \
             not have at this size: choose the draw rasterizer",
            capabilities.max_storage_buffer_range,
            device.description().name
        ))),
        Some(Rasterizer::Draw) | None if !can_draw && (options.rasterizer.is_some() || !can_compute) => {
            Err(Error::Usage(format!(
                "coverage by the draw rasterizer needs buffers that fragment shaders write to (fragmentStoresAndAtomics), and 4 bytes a \
                 pixel within {}, which {} does not have at this size: choose the compute rasterizer, or a mask as α",
                capabilities.max_storage_buffer_range,
                device.description().name
            )))
        }
        Some(rasterizer) => Ok(rasterizer),
        // Measured on CPU devices only; a GPU's own rasterizer is taken until a measurement says otherwise, if it keeps 32 bits.
        None if can_compute
            && (!can_draw
                || device.description().kind == DeviceDescription::CPU
                || blends && !capabilities.blend_float32) =>
        {
            Ok(Rasterizer::Compute)
        }
        None => Ok(Rasterizer::Draw),
    }
}

impl SplatCounts {
    fn new(surfels: u64, Counts { culled }: Counts) -> Self {
        let [behind, eye_plane, back, outside, invalid] = culled;
        let drawn = surfels as u32 - culled.iter().sum::<u32>();
        Self { drawn, behind, eye_plane, back, outside, invalid }
    }
}
