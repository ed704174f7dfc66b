//! Frames: makes what a frame needs when the scene or the settings change, records and submits it, reads it back.

use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::instance::{Instances, Placed};
use crate::passes::Splats;
use crate::picture::Picture;
use crate::readback::PyramidLevel;
use crate::scene::Scene;
use crate::settings::{Alpha, Settings};
use crate::splatting::Visibility;
use crate::stage::{Resident, Retired, Stage};
use crate::targets::{Buffers, Pyramids, TargetInfo};
use crate::variant::{Outputs, Precision, Rasterizer};
use crate::vk::shaders::layout::Counts;
pub use crate::vk::shaders::layout::Splat;
use crate::vk::{Commands, Device, DeviceDescription, PassTime};
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
#[non_exhaustive]
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
    /// The centre is not in front of the eye; by pull–push, not between the near and the far plane.
    pub behind: u32,
    /// The disc reaches the eye plane, or comes within 1/20000 of its distance to it; by pull–push, none.
    pub eye_plane: u32,
    /// The normal faces away, and such are culled.
    pub back: u32,
    /// Off the picture, by pull–push with the centre, or without an area on it: exactly edge-on, or too small to weigh anything.
    pub outside: u32,
    /// Not [valid](crate::geometry::Surfels::is_valid), or with an image too large for float32.
    pub invalid: u32,
}

/// Renders frames of one size on one device. One frame is under way at a time.
pub struct Renderer {
    stage: Stage,
    commands: Commands,
}

/// Width of the weighted sums that `rasterizer` keeps on `device`: drawing them blends, which the device may not do in 32 bits.
pub(crate) fn width_of_sums(device: &Device, options: &RenderOptions, rasterizer: Rasterizer) -> Precision {
    let blends = rasterizer == Rasterizer::Compute || device.capabilities().blend_float32;
    if blends { options.precision } else { Precision::Half }
}

/// [`width_of_sums`] where it is not known yet what is rendered.
pub(crate) fn width_of_blended_sums(device: &Device, options: &RenderOptions) -> Precision {
    let rasterizer = rasterizer_for(device, options, true, Alpha::Mask);
    rasterizer.map_or(options.precision, |rasterizer| width_of_sums(device, options, rasterizer))
}

impl Renderer {
    /// A renderer that has made nothing for any scene yet.
    pub fn new(device: &Arc<Device>, options: RenderOptions) -> Result<Self> {
        Ok(Self {
            stage: Stage::new(device, options, Retired::Dropped)?,
            commands: Commands::new(device, options.profile)?,
        })
    }

    /// Renders a frame of a scene, or of several where they are placed, and waits for it. Makes nothing that an earlier frame of the same
    /// scenes and kind has made, if no more than one other kind came between.
    pub fn render<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<FrameReport> {
        self.run(scenes.into(), camera, settings, false)
    }

    /// Renders a frame and reads it back.
    pub fn render_picture<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<(Picture, FrameReport)> {
        let report = self.run(scenes.into(), camera, settings, true)?;
        let picture = self.stage.present().map(|present| present.canvas.picture(&present.readback));
        Ok((picture.unwrap_or_default(), report))
    }

    /// Whether later frames are profiled, if [`RenderOptions::profile`] was asked for: what a whole frame costs is best timed without.
    pub fn profile(&mut self, on: bool) {
        self.commands.time(on);
    }

    /// Float width of the samples of the last frame, if it was pull–push's, else of the weighted sums.
    pub fn precision(&self) -> Precision {
        self.stage.precision()
    }

    /// The targets of the last frame.
    pub fn targets(&self) -> Vec<TargetInfo> {
        self.stage.present().map_or(Vec::new(), |present| present.canvas.targets())
    }

    /// What visits the pixels in the last frame.
    pub fn rasterizer(&self) -> Option<Rasterizer> {
        self.stage.present().map(|present| present.variant.rasterizer)
    }

    /// Memory of the splats of the last frame and what belongs to them, bytes.
    pub fn splat_bytes(&self) -> u64 {
        self.splats().map(Splats::bytes).sum()
    }

    /// Copies the splats of the last frame to the CPU: one a surfel, scene by scene; none if it was pull–push's.
    pub fn read_splats(&self) -> Result<Vec<Vec<Splat>>> {
        self.splats().map(|splats| splats.read(self.stage.device())).collect()
    }

    /// Copies the levels of the last frame's pyramids to the CPU, fine to coarse, as they were pulled and as they were pushed; `None` if it was
    /// not pull–push's.
    pub fn read_pyramids(&self) -> Result<Option<[Vec<PyramidLevel>; 2]>> {
        let pyramids = self.stage.present().and_then(|present| present.canvas.pyramids());
        pyramids.map(|pyramids| pyramids.read(self.stage.device())).transpose()
    }

    fn splats(&self) -> impl Iterator<Item = &Splats> {
        self.stage.residents().map(|resident| &resident.splats)
    }

    fn run(
        &mut self,
        scenes: Instances<'_, Scene>,
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<FrameReport> {
        let placed = scenes.placed(self.stage.device())?;
        let (blocks, variant) = self.stage.prepare(&placed, camera, settings, read)?;
        self.commands.run(|rec| {
            self.stage.record(rec, &blocks);
            if let Some(present) = self.stage.present().filter(|_| read) {
                present.canvas.record_readback(rec, &present.readback);
            }
        })?;
        Ok(FrameReport {
            pass_times: self.commands.pass_times()?,
            counts: variant.count.then(|| SplatCounts::of(self.stage.residents())),
        })
    }
}

/// What visits the pixels of a frame of these settings: what is asked for, or what is faster on `device`.
pub(crate) fn rasterizer_of(
    device: &Device,
    options: &RenderOptions,
    settings: &Settings,
    scenes: &[Placed<'_>],
) -> Result<Rasterizer> {
    let blends = settings.splatting.visibility != Visibility::Nearest;
    match settings.pull_push {
        Some(_) => rasterizer_of_points(device, options, scenes),
        None => rasterizer_for(device, options, blends, settings.alpha),
    }
}

/// The faster of what `device` can do with the surfels of `scenes` by pull–push; lines and triangles are computed.
///
/// Atomic minima are faster wherever they were measured: see README, Cost, and Schütz, Kerbl, Wimmer, *Rendering Point Clouds with Compute
/// Shaders and Vertex Order Optimization*, 2021.
fn rasterizer_of_points(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
) -> Result<Rasterizer> {
    let (capabilities, name) = (device.capabilities(), &device.description().name);
    let refuse = |what, remedy| {
        Err(Error::Usage(format!(
            "pull-push needs 64-bit atomics in buffers for {what}, which {name} does not have: {remedy}"
        )))
    };
    match options.rasterizer {
        _ if !Pyramids::fit(capabilities, options) => Err(too_large(device, options)),
        _ if scenes.iter().any(|placed| placed.scene.primitives.is_some()) && !capabilities.int64_atomics => {
            refuse("lines and triangles", "leave them out, or choose another device")
        }
        Some(Rasterizer::Compute) if !capabilities.int64_atomics => {
            refuse("computed points", "choose the draw rasterizer, or leave it open")
        }
        // Without surfels there is nothing to draw.
        _ if scenes.iter().all(|placed| placed.scene.capacity() == 0) => Ok(Rasterizer::Compute),
        Some(rasterizer) => Ok(rasterizer),
        None if capabilities.int64_atomics => Ok(Rasterizer::Compute),
        None => Ok(Rasterizer::Draw),
    }
}

/// That pyramids do not fit the device, and what would.
fn too_large(device: &Device, options: &RenderOptions) -> Error {
    let capabilities = device.capabilities();
    let half = RenderOptions { precision: Precision::Half, ..*options };
    let halved = match Pyramids::fit(capabilities, &half) {
        true => "half precision, or ",
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
pub(crate) fn rasterizer_for(
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
        Some(Rasterizer::Compute) if !can_compute => {
            let (name, most) = (&device.description().name, capabilities.max_storage_buffer_range);
            let cause = match (atomics, fits) {
                (false, _) => format!("{needed} in buffers, which {name} does not have"),
                (true, false) => {
                    format!("a picture within the {most} bytes of a buffer that shaders of {name} see")
                }
                (true, true) => "32-bit sums, and half precision is wanted".into(),
            };
            Err(Error::Usage(format!("the compute rasterizer needs {cause}: choose the draw rasterizer")))
        }
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
    /// Of so many surfels, of which these are culled.
    pub(crate) fn new(surfels: u64, Counts { culled }: Counts) -> Self {
        let [behind, eye_plane, back, outside, invalid] = culled;
        let drawn = surfels.saturating_sub(culled.iter().copied().map(u64::from).sum()) as u32;
        Self { drawn, behind, eye_plane, back, outside, invalid }
    }

    /// Those of all scenes together.
    fn of<'a>(scenes: impl Iterator<Item = &'a Resident> + Clone) -> Self {
        let add = |sum: [u32; 5], counts: Counts| std::array::from_fn(|i| sum[i] + counts.culled[i]);
        let culled = scenes.clone().map(|scene| scene.splats.counts()).fold([0; 5], add);
        Self::new(scenes.map(|scene| scene.splats.count()).sum(), Counts { culled })
    }
}
