//! What frames are made with: pipelines, targets and splats, made when scene or settings change, and recorded in every frame.

mod residents;

use crate::error::Result;
use crate::frame::frame;
use crate::geometry::Camera;
use crate::methods::{Canvas, Pipelines};
use crate::passes::{SplatLayout, Splats};
use crate::renderer::{RenderOptions, rasterizer_of, width_of_blended_sums, width_of_sums};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::targets::check_size;
use crate::variant::{Precision, Rasterizer, SceneVariant, Variant};
use crate::vk::shaders::layout::Frame;
use crate::vk::{Buffer, Device, Recorder};
pub(crate) use residents::Residents;
use std::any::Any;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// Pipelines, targets and splats for frames of one size on one device.
pub(crate) struct Stage {
    // Fields are dropped in this order: views before what they view.
    present: Option<Present>,
    /// What was before it: who switches to and fro, as in progressive rendering, makes nothing.
    previous: Option<Present>,
    residents: Residents<Resident>,
    pipelines: HashMap<Variant, Pipelines>,
    layout: SplatLayout,
    frame: Arc<Buffer>,
    options: RenderOptions,
    device: Arc<Device>,
    retired: Retired,
    /// Number of targets made so far.
    made: u64,
}

/// What happens to what frames no longer need.
pub(crate) enum Retired {
    /// It goes at once: every frame is waited for.
    Dropped,
    /// It is kept for who knows when the GPU is done with it.
    Kept(Vec<Outgoing>),
}

/// What frames no longer need, kept for what it holds.
pub(crate) type Outgoing = Box<dyn Any + Send>;

/// Targets of the present variant.
pub(crate) struct Present {
    /// No other has it.
    pub(crate) id: u64,
    pub(crate) variant: Variant,
    pub(crate) canvas: Canvas,
    pub(crate) readback: Vec<Buffer>,
    /// What the canvas reads.
    _frame: Arc<Buffer>,
}

/// Splats of a scene.
pub(crate) struct Resident {
    /// What it makes splats for, if any.
    rasterizer: Option<Rasterizer>,
    pub(crate) splats: Splats,
    _frame: Arc<Buffer>,
}

impl Retired {
    fn take<T: Any + Send>(&mut self, outgoing: Option<T>) {
        if let (Self::Kept(list), Some(outgoing)) = (self, outgoing) {
            list.push(Box::new(outgoing));
        }
    }
}

/// What a frame is: its numbers and its variant. Refuses what cannot be rendered.
pub(crate) fn describe(
    device: &Device,
    options: &RenderOptions,
    scene: &Scene,
    camera: &Camera,
    settings: &Settings,
) -> Result<(Frame, SceneVariant)> {
    settings.check()?;
    settings.splatting.normalization.check_weights(scene.weights.is_some())?;
    settings.check_primitives(scene.primitives.is_some())?;
    settings.check_outputs(options.outputs)?;
    let block = frame(camera, settings, options.size, scene.origin(), &scene.bounds())?;
    let rasterizer = rasterizer_of(device, options, settings, scene)?;
    let perspective = camera.projection()?.perspective;
    let precision = match settings.pull_push {
        Some(_) => options.precision,
        None => width_of_sums(device, options, rasterizer),
    };
    let options = RenderOptions { precision, ..*options };
    let streams = scene.streams();
    let variant = Variant::new(&[streams], perspective, settings, &options, rasterizer);
    Ok((block, SceneVariant::new(variant, streams)))
}

impl Stage {
    /// Nothing is made for any scene yet.
    pub(crate) fn new(device: &Arc<Device>, options: RenderOptions, retired: Retired) -> Result<Self> {
        check_size(device, options.size)?;
        Ok(Self {
            present: None,
            previous: None,
            residents: Residents::default(),
            pipelines: HashMap::new(),
            layout: SplatLayout::new(device)?,
            frame: Arc::new(Buffer::uniform(device, "frame", size_of::<Frame>() as u64)?),
            options,
            device: device.clone(),
            retired,
            made: 0,
        })
    }

    /// Width of the samples of the last frame, if it was pull–push's, else of the weighted sums.
    pub(crate) fn precision(&self) -> Precision {
        let unknown = || width_of_blended_sums(&self.device, &self.options);
        self.present.as_ref().map_or_else(unknown, |present| present.variant.precision)
    }

    pub(crate) fn present(&self) -> Option<&Present> {
        self.present.as_ref()
    }

    pub(crate) fn resident(&self) -> Option<&Resident> {
        self.residents.present()
    }

    /// What went since this was last asked.
    pub(crate) fn outgoing(&mut self) -> Vec<Outgoing> {
        match &mut self.retired {
            Retired::Dropped => Vec::new(),
            Retired::Kept(list) => std::mem::take(list),
        }
    }

    /// Frames from now on have this size, px.
    pub(crate) fn resize(&mut self, size: [u32; 2]) {
        if self.options.size != size {
            self.options.size = size;
            for old in [self.present.take(), self.previous.take()] {
                self.retired.take(old);
            }
        }
    }

    /// Makes what a frame needs and is not there, with buffers to read it back where it is `read`: the frame's numbers, and what it is.
    pub(crate) fn prepare(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<(Frame, Variant)> {
        let (block, own) = describe(&self.device, &self.options, scene, camera, settings)?;
        let variant = own.frame;
        let splats = variant.pull_push.is_none().then_some(variant.rasterizer);
        self.make_resident(scene, splats)?;
        self.make_present(variant, read)?;
        if let Some(present) = &mut self.present {
            present.canvas.show(&self.device, &self.layout, &[own])?;
        }
        Ok((block, variant))
    }

    /// Records the frame that was prepared, with these numbers.
    pub(crate) fn record(&self, rec: &mut Recorder<'_>, block: &Frame) {
        rec.update(&self.frame, bytemuck::bytes_of(block));
        if let (Some(present), Some(resident)) = (&self.present, self.resident()) {
            present.canvas.record(rec, &[&resident.splats]);
        }
    }

    fn make_resident(&mut self, scene: &Scene, rasterizer: Option<Rasterizer>) -> Result<()> {
        let Self { residents, retired, device, layout, frame, .. } = self;
        let make = || {
            let splats = Splats::new(device, layout, frame, scene, rasterizer)?;
            Ok(Resident { rasterizer, splats, _frame: frame.clone() })
        };
        let fits = |resident: &Resident| resident.rasterizer == rasterizer;
        residents.turn(scene, fits, make, |gone| retired.take(Some(gone)))?;
        if let Some(resident) = residents.present_mut() {
            resident.splats.set_count(scene.count());
        }
        Ok(())
    }

    fn make_present(&mut self, variant: Variant, read: bool) -> Result<()> {
        let is_other = |present: &Option<Present>| present.as_ref().is_none_or(|p| p.variant != variant);
        if is_other(&self.present) {
            std::mem::swap(&mut self.present, &mut self.previous);
        }
        if is_other(&self.present) {
            self.retired.take(self.present.take());
            if variant.precision != self.options.precision {
                let name = &self.device.description().name;
                log::warn!("{name} cannot blend 32-bit floats: sums are kept in 16 bits");
            }
            let pipelines = match self.pipelines.entry(variant) {
                Entry::Occupied(made) => made.into_mut(),
                Entry::Vacant(room) => room.insert(Pipelines::new(&self.device, &self.layout, &variant)?),
            };
            let canvas =
                pipelines.canvas(&self.device, &self.layout, &self.frame, &variant, self.options.size)?;
            let frame = self.frame.clone();
            self.made += 1;
            self.present =
                Some(Present { id: self.made, variant, canvas, readback: Vec::new(), _frame: frame });
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
