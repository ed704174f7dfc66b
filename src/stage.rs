//! What frames are made with: pipelines, targets and splats, made when scene or settings change, and recorded in every frame.

mod residents;

use crate::error::{Error, Result};
use crate::frame::Blocks;
use crate::geometry::Camera;
use crate::instance::{Placed, first_numbers};
use crate::methods::{Canvas, Pipelines};
use crate::passes::{SplatLayout, Splats};
use crate::renderer::{RenderOptions, rasterizer_of, width_of_blended_sums, width_of_sums};
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
pub(crate) type Outgoing = Box<dyn Any + Send + Sync>;

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
    frame: Numbers,
}

/// The buffer of the numbers that a scene is seen by.
#[derive(Clone)]
pub(crate) enum Numbers {
    /// That of passes over pixels.
    View(Arc<Buffer>),
    /// One of its own.
    Own(Arc<Buffer>),
}

impl Numbers {
    /// The view's, or another of the scene's `own`.
    pub(crate) fn new(device: &Arc<Device>, view: &Arc<Buffer>, own: bool) -> Result<Self> {
        if !own {
            return Ok(Self::View(view.clone()));
        }
        let buffer = Buffer::uniform(device, "frame of a scene", size_of::<Frame>() as u64)?;
        Ok(Self::Own(Arc::new(buffer)))
    }

    pub(crate) fn buffer(&self) -> &Buffer {
        match self {
            Self::View(buffer) | Self::Own(buffer) => buffer,
        }
    }

    pub(crate) fn is_own(&self) -> bool {
        matches!(self, Self::Own(_))
    }
}

/// Records the writing of a frame's numbers, of `scenes` where they have their own.
pub(crate) fn update<'a>(
    rec: &mut Recorder<'_>,
    view: &'a Buffer,
    scenes: impl Iterator<Item = &'a Numbers>,
    blocks: &'a Blocks,
) {
    let own = scenes.map(Numbers::buffer).zip(&blocks.scenes);
    let all = std::iter::once((view, &blocks.view)).chain(own);
    let updates: Vec<_> = all.map(|(buffer, block)| (buffer, bytemuck::bytes_of(block))).collect();
    rec.update(&updates);
}

impl Retired {
    fn take<T: Any + Send + Sync>(&mut self, outgoing: Option<T>) {
        if let (Self::Kept(list), Some(outgoing)) = (self, outgoing) {
            list.push(Box::new(outgoing));
        }
    }
}

/// What a frame is.
pub(crate) struct Description {
    pub(crate) blocks: Blocks,
    pub(crate) variant: Variant,
    /// What each of its scenes is.
    pub(crate) scenes: Vec<SceneVariant>,
}

/// What a frame of these scenes is. Refuses what cannot be rendered.
pub(crate) fn describe(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
    camera: &Camera,
    settings: &Settings,
) -> Result<Description> {
    settings.check()?;
    for Placed { scene, .. } in scenes {
        settings.splatting.normalization.check_weights(scene.weights.is_some())?;
        settings.check_primitives(scene.primitives.is_some())?;
    }
    settings.check_outputs(options.outputs)?;
    let blocks = Blocks::new(camera, settings, options.size, scenes)?;
    let rasterizer = rasterizer_of(device, options, settings, scenes)?;
    let perspective = camera.projection()?.perspective;
    let precision = match settings.pull_push {
        Some(_) => options.precision,
        None => width_of_sums(device, options, rasterizer),
    };
    let options = RenderOptions { precision, ..*options };
    let streams: Vec<_> = scenes.iter().map(|placed| placed.scene.streams()).collect();
    let variant = Variant::new(&streams, perspective, settings, &options, rasterizer);
    check_lookups(&variant, scenes)?;
    let own =
        |(streams, placed): (_, &Placed<'_>)| SceneVariant::new(variant, streams, placed.placement.is_some());
    let scenes = streams.into_iter().zip(scenes).map(own).collect();
    Ok(Description { blocks, variant, scenes })
}

/// Those of a variant, which are made if they are not there.
fn pipelines_of<'a>(
    made: &'a mut HashMap<Variant, Pipelines>,
    device: &Arc<Device>,
    layout: &SplatLayout,
    variant: Variant,
) -> Result<&'a Pipelines> {
    Ok(match made.entry(variant) {
        Entry::Occupied(made) => made.into_mut(),
        Entry::Vacant(room) => room.insert(Pipelines::new(device, layout, &variant)?),
    })
}

/// Refuses several scenes of which one has what is looked up pixel by pixel, where there is but one table of it.
fn check_lookups(variant: &Variant, scenes: &[Placed<'_>]) -> Result<()> {
    let refuse = |what: &str| {
        Err(Error::Usage(format!(
            "{} scenes in a frame of pull-push, of which one has {what}, which its pixels look up as if all were of that scene: leave {what} \
             out, show the scene alone, or choose a method that splats",
            scenes.len()
        )))
    };
    // Coordinates are the same wherever the scene stands; the numbers of its points are not.
    let alike = scenes.windows(2).all(|pair| pair[0].scene.id == pair[1].scene.id);
    if variant.texture.is_some() && !alike {
        return refuse("a texture");
    }
    if variant.materials && scenes.len() > 1 {
        return refuse("materials");
    }
    Ok(())
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

    pub(crate) fn device(&self) -> &Arc<Device> {
        &self.device
    }

    pub(crate) fn present(&self) -> Option<&Present> {
        self.present.as_ref()
    }

    /// What is made for the scenes of the last frame, in their order.
    pub(crate) fn residents(&self) -> impl Iterator<Item = &Resident> + Clone {
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

    /// Whether frames from now on count their surfels.
    pub(crate) fn count(&mut self, on: bool) {
        self.options.count = on;
    }

    /// Makes what a frame needs and is not there, with buffers to read it back where it is `read`: the frame's numbers, and what it is.
    pub(crate) fn prepare(
        &mut self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<(Blocks, Variant)> {
        let Description { blocks, variant, scenes: own } =
            describe(&self.device, &self.options, scenes, camera, settings)?;
        let splats = variant.pull_push.is_none().then_some(variant.rasterizer);
        self.make_residents(scenes, splats, !blocks.scenes.is_empty())?;
        self.make_present(variant, read)?;
        if let Some(present) = &mut self.present {
            present.canvas.show(&self.device, &self.layout, &own)?;
        }
        Ok((blocks, variant))
    }

    /// Makes the pipelines of a frame like this one of `size` px, and nothing else; what it is.
    pub(crate) fn make_pipelines(
        &mut self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        size: [u32; 2],
    ) -> Result<Variant> {
        let options = RenderOptions { size, ..self.options };
        let Description { variant, scenes, .. } = describe(&self.device, &options, scenes, camera, settings)?;
        let Self { pipelines, layout, device, .. } = self;
        pipelines_of(pipelines, device, layout, variant)?.show(device, layout, &scenes)?;
        Ok(variant)
    }

    /// Records the frame that was prepared, with these numbers.
    pub(crate) fn record(&self, rec: &mut Recorder<'_>, blocks: &Blocks) {
        update(rec, &self.frame, self.residents().map(|resident| &resident.frame), blocks);
        if let Some(present) = &self.present {
            let splats: Vec<_> = self.residents().map(|resident| &resident.splats).collect();
            present.canvas.record(rec, &splats);
        }
    }

    /// Makes the splats of these scenes that are not there, for as many surfels as each has now; with numbers of each scene's `own`, or those
    /// of the view.
    fn make_residents(
        &mut self,
        scenes: &[Placed<'_>],
        rasterizer: Option<Rasterizer>,
        own: bool,
    ) -> Result<()> {
        let Self { residents, retired, device, layout, frame, .. } = self;
        let list: Vec<_> = scenes.iter().map(|placed| placed.scene).collect();
        let make = |place: usize| {
            let frame = Numbers::new(device, frame, own)?;
            let splats = Splats::new(device, layout, frame.buffer(), list[place], rasterizer)?;
            Ok(Resident { rasterizer, splats, frame })
        };
        let fits = |resident: &Resident| resident.rasterizer == rasterizer && resident.frame.is_own() == own;
        residents.turn(&list, fits, make, |gone| retired.take(Some(gone)))?;
        for ((resident, scene), first) in residents.present_mut().zip(&list).zip(first_numbers(scenes)) {
            resident.splats.set_count(scene.count());
            resident.splats.set_first(first);
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
            let pipelines = pipelines_of(&mut self.pipelines, &self.device, &self.layout, variant)?;
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
