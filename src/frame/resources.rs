//! What frames are made with: pipelines, targets and what is made of scenes, made when scene or settings change, and recorded in every frame.

use super::crowding::Crowding;
use super::description::{Description, describe};
use super::pass::{Commands, Pass, Programs};
use super::pipelines::{Host, Pipelines};
use super::rasterizer::width_of_blended_sums;
use super::recording::{Frame, Prepared};
use super::renderer::RenderOptions;
use super::scene_cache::SceneCache;
use super::scene_resources::{Needs, Run, SceneResources, batches_of};
use super::splat_list::{Room, Share, SplatList, room_for, room_of};
use super::targets::{HostBindings, RenderTargets, check_size};
use super::uniforms::{self, Blocks};
use super::variant::{SceneVariant, Variant};
use crate::error::Result;
use crate::geometry::Camera;
use crate::scene::Scene;
use crate::scene::instance::Placed;
use crate::settings::Precision;
use crate::settings::Settings;
use crate::settings::splatting::Visibility;
use crate::vk::shaders::resource;
use crate::vk::{Access, Binding, Buffer, DescriptorSet, Device, Framebuffer, Recorder};
use std::any::Any;
use std::sync::Arc;

/// Pipelines, targets and what is made of scenes, for frames of one size on one device.
pub struct FrameResources {
    // Fields are dropped in this order: views before what they view.
    present: Option<Present>,
    /// What was before it: who switches to and fro, as in progressive rendering, makes nothing.
    previous: Option<Present>,
    scenes: SceneCache,
    /// Of each place of the present frame: its scene in the cache, and which of that one's places it is.
    places: Vec<[usize; 2]>,
    /// The splats of the present frame, for tiles.
    splats: Option<Arc<SplatList>>,
    /// How many of them there are.
    splat_count: u64,
    crowding: Crowding,
    pipelines: Pipelines,
    view: Arc<Buffer>,
    options: RenderOptions,
    device: Arc<Device>,
    retired: Retired,
    /// Number of targets made so far.
    made: u64,
}

/// What becomes of resources that frames no longer use.
pub enum Retired {
    /// They are destroyed at once: every frame is waited for.
    Dropped,
    /// They are listed for deferred destruction.
    Kept(Vec<Deferred>),
}

/// A resource that no later frame uses, kept until the GPU is done with it.
pub type Deferred = Box<dyn Any + Send + Sync>;

/// Targets of a variant, and its passes.
pub struct Present {
    /// No other has it.
    pub id: u64,
    pub variant: Variant,
    /// Of the scenes for which the passes have pipelines.
    scenes: Vec<SceneVariant>,
    /// The list of splats that the passes see.
    splats: u64,
    passes: Vec<Prepared>,
    view: ViewSet,
    pub targets: RenderTargets,
    pub readback: Vec<Buffer>,
    /// What the view's set names.
    _view: Arc<Buffer>,
}

/// Descriptor set 0 of passes over pixels.
struct ViewSet {
    set: DescriptorSet,
    /// The scene whose texture or materials it names.
    scene: Option<u64>,
}

impl Retired {
    fn take<T: Any + Send + Sync>(&mut self, deferred: Option<T>) {
        if let (Self::Kept(list), Some(deferred)) = (self, deferred) {
            list.push(Box::new(deferred));
        }
    }
}

impl FrameResources {
    /// Nothing is made for any scene yet. With a `host`, what is drawn is drawn in its subpasses.
    pub fn new(
        device: &Arc<Device>,
        options: RenderOptions,
        retired: Retired,
        host: Option<Host>,
    ) -> Result<Self> {
        check_size(device, options.size)?;
        Ok(Self {
            present: None,
            previous: None,
            scenes: SceneCache::default(),
            places: Vec::new(),
            splats: None,
            splat_count: 0,
            crowding: Crowding::new(device)?,
            pipelines: Pipelines::new(host),
            view: Arc::new(Buffer::uniform(device, "frame", uniforms::BYTES)?),
            options,
            device: device.clone(),
            retired,
            made: 0,
        })
    }

    /// Width of the samples of the last frame, if it was pull–push's, else of the weighted sums.
    pub fn precision(&self) -> Precision {
        let unknown = || width_of_blended_sums(&self.device, &self.options);
        self.present.as_ref().map_or_else(unknown, |present| present.variant.precision)
    }

    /// What they are made on.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Targets of the last frame.
    pub fn present(&self) -> Option<&Present> {
        self.present.as_ref()
    }

    /// What is made of the scenes of the last frame, each once.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneResources> + Clone {
        self.scenes.present()
    }

    /// Memory of the splats of the last frame and what belongs to them, bytes.
    pub fn splat_bytes(&self) -> u64 {
        let tiled = self.present.as_ref().is_some_and(|present| present.variant.is_tiled());
        let of_frame = self.splats.as_ref().filter(|_| tiled).map_or(0, |splats| splats.bytes());
        of_frame + self.scenes().map(SceneResources::bytes).sum::<u64>()
    }

    /// The places of the last frame, in their order: the number of the scene and which of its places it is.
    pub fn places(&self) -> &[[usize; 2]] {
        &self.places
    }

    /// The resources that frames no longer use since the last call.
    pub fn take_deferred(&mut self) -> Vec<Deferred> {
        match &mut self.retired {
            Retired::Dropped => Vec::new(),
            Retired::Kept(list) => std::mem::take(list),
        }
    }

    /// Frames from now on have this size, px.
    pub fn resize(&mut self, size: [u32; 2]) {
        if self.options.size != size {
            self.options.size = size;
            self.forget_targets();
        }
    }

    /// The next frame has targets of its own, as where a host draws to others.
    pub fn forget_targets(&mut self) {
        for old in [self.present.take(), self.previous.take()] {
            self.retired.take(old);
        }
    }

    /// Whether frames from now on count their surfels.
    pub fn count(&mut self, on: bool) {
        self.options.count = on;
    }

    /// What a frame of these scenes is. Refuses what cannot be rendered.
    pub fn describe(
        &self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        size: [u32; 2],
    ) -> Result<Description> {
        // Where the work of a tile is bounded there are no slices.
        let crowded = self.most_splats().is_none() && self.crowding.is_crowded(scenes, camera, size);
        describe(&self.device, &RenderOptions { size, ..self.options }, scenes, camera, settings, crowded)
    }

    /// See [`RenderOptions::most_splats`].
    pub fn most_splats(&self) -> Option<u32> {
        self.options.most_splats
    }

    /// Whether a frame that is over lacked splats since the last call.
    pub fn learn(&mut self) -> bool {
        self.crowding.learn()
    }

    /// Makes what a frame needs and is not there, with buffers to read it back where it is `read`: the frame's numbers, and what it is.
    pub fn prepare(
        &mut self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<(Blocks, Variant)> {
        let frame = self.describe(scenes, camera, settings, self.options.size)?;
        self.make(scenes, &frame, self.options.size, &[])?;
        self.crowding.begin(scenes, camera, self.options.size);
        match &mut self.present {
            Some(present) if read && present.readback.is_empty() => {
                present.readback = present.targets.make_readback(&self.device)?;
            }
            _ => {}
        }
        Ok((frame.blocks, frame.variant))
    }

    /// Makes what a frame needs and is not there; in a host's subpasses with targets of `size` px, of which shaders see `bindings`.
    pub fn make(
        &mut self,
        scenes: &[Placed<'_>],
        frame: &Description,
        size: [u32; 2],
        bindings: HostBindings<'_>,
    ) -> Result<()> {
        self.make_scenes(scenes, frame)?;
        self.make_present(scenes, frame.variant, size)?;
        self.make_passes(&frame.scenes, bindings)
    }

    /// Makes the pipelines of such a frame, and nothing else.
    pub fn make_pipelines(&mut self, frame: &Description) -> Result<()> {
        for pass in self.pipelines.passes(&frame.variant, frame.scenes.len()) {
            self.pipelines.of(&self.device, pass, &frame.variant, &frame.scenes)?;
        }
        Ok(())
    }

    /// Records the frame that was prepared, with these numbers, but for what is drawn in subpasses of a host: for that everything is made ready.
    pub fn record(&self, rec: &mut Recorder<'_>, blocks: &Blocks) {
        self.update(rec, blocks);
        let Some((present, frame)) = self.frame() else { return };
        let mut awaited = Vec::new();
        for prepared in &present.passes {
            if self.pipelines.is_of_host(prepared.pass) {
                frame.clear(rec, prepared.pass.clears);
                awaited.extend(frame.uses(&prepared.accesses));
            } else {
                prepared.record(rec, &frame);
            }
        }
        if present.variant.count {
            let counts = self.scenes().flat_map(|scene| scene.buffers(super::resource::Resource::Counts));
            awaited.extend(counts.map(|counts| counts.with(Access::HOST_READ)));
        }
        if present.variant.is_tiled() {
            awaited.push(self.crowding.buffer().with(Access::HOST_READ));
        }
        if !awaited.is_empty() {
            rec.wait(&awaited);
        }
    }

    /// The frame that was prepared, to be recorded.
    pub fn frame(&self) -> Option<(&Present, Frame<'_>)> {
        let present = self.present.as_ref()?;
        let scenes: Vec<_> = self.scenes().collect();
        let one = |place: usize| {
            let [scene, number] = self.places[place];
            Run { scene: scenes[scene], place, first: number as u64, count: 1 }
        };
        let (mut runs, mut batches): (Vec<Run<'_>>, Vec<Run<'_>>) = Default::default();
        for run in (0..self.places.len()).map(one) {
            match runs.last_mut() {
                Some(last) if last.takes(&run) => last.count += 1,
                _ => runs.push(run),
            }
            if run.first == 0 {
                batches.extend(run.batches());
            }
        }
        let Present { variant, targets, view, .. } = present;
        let splats = self.splats.as_deref().filter(|_| variant.is_tiled());
        let frame = Frame {
            variant,
            view: &view.set,
            targets,
            splats,
            splat_count: self.splat_count,
            most_splats: self.most_splats(),
            number: self.crowding.frame(),
            runs,
            batches,
        };
        Some((present, frame))
    }

    /// Records the writing of a frame's numbers.
    fn update(&self, rec: &mut Recorder<'_>, blocks: &Blocks) {
        let of_scenes: Vec<_> = self.scenes().collect();
        let mut own: Vec<Vec<u8>> = vec![Vec::new(); of_scenes.len()];
        for ([scene, number], block) in self.places.iter().zip(&blocks.instances) {
            let (start, bytes) =
                (of_scenes[*scene].view_start(*number as u64) as usize, bytemuck::bytes_of(block));
            own[*scene].resize(start + bytes.len(), 0);
            own[*scene][start..].copy_from_slice(bytes);
        }
        let bytes = blocks.bytes();
        let view = (&*self.view, &*bytes);
        let frames =
            self.scenes().zip(&own).filter_map(|(scene, bytes)| Some((scene.views.as_ref()?, &**bytes)));
        rec.update(&std::iter::once(view).chain(frames).collect::<Vec<_>>());
    }

    /// Makes what is not there of these scenes, for as many surfels as each has now.
    fn make_scenes(&mut self, placed: &[Placed<'_>], frame: &Description) -> Result<()> {
        let instanced = !frame.blocks.instances.is_empty();
        let variant = &frame.variant;
        let mut list: Vec<&Scene> = Vec::new();
        let mut first_of: Vec<usize> = Vec::new();
        let mut counts: Vec<u64> = Vec::new();
        self.places.clear();
        let mut known = std::collections::HashMap::new();
        for (i, Placed { scene, .. }) in placed.iter().enumerate() {
            let number = *known.entry(scene.id).or_insert(list.len());
            if number == list.len() {
                list.push(scene);
                first_of.push(i);
                counts.push(0);
            }
            self.places.push([number, counts[number] as usize]);
            counts[number] += 1;
        }
        let splats = variant.pull_push.is_none() && !variant.is_tiled();
        let of_host = self.pipelines.has_host();
        let shares = self.make_splats(&list, &counts, variant)?;
        let needs = |scene: usize| Needs {
            splats,
            moved: of_host && splats && variant.visibility == Visibility::Axis,
            instanced,
            instances: room_for(counts[scene]),
        };
        let Self { scenes, retired, device, view, splats: splat_list, .. } = self;
        let splat_list = splat_list.as_ref();
        let fits = |made: &SceneResources, scene: usize| {
            made.needs().cover(&needs(scene))
                && match splat_list {
                    Some(splats) if variant.is_tiled() => {
                        made.needs() == &needs(scene)
                            && made.share().is_some_and(|share| share.is(splats, shares[scene]))
                    }
                    _ => made.share().is_none(),
                }
        };
        let make = |scene: usize| {
            let variant = &frame.scenes[first_of[scene]];
            let share = splat_list.filter(|_| variant.frame.is_tiled());
            let share = share.map(|splats| Share::new(splats, list[scene], shares[scene]));
            SceneResources::new(device, list[scene], variant, needs(scene), view, share)
        };
        let updated = scenes.update(&list, fits, make, |gone| retired.take(Some(gone)));
        if updated.is_err() {
            self.places.clear();
        }
        updated?;
        for ((made, scene), instances) in scenes.present_mut().zip(list).zip(counts) {
            made.show(scene.count(), instances);
            if variant.count {
                made.make_counts(device)?;
            }
        }
        Ok(())
    }

    /// Makes the list of the splats of these scenes, each once, of which there are so many instances: where the share of each begins.
    fn make_splats(&mut self, scenes: &[&Scene], instances: &[u64], variant: &Variant) -> Result<Vec<Room>> {
        let mut room = Room::default();
        let mut shares = Vec::new();
        if !variant.is_tiled() {
            return Ok(shares);
        }
        for (scene, instances) in scenes.iter().zip(instances) {
            shares.push(room);
            room = room.with(room_of(scene, &batches_of(&self.device, scene, room_for(*instances))));
        }
        self.splat_count = room.splats;
        if !self.splats.as_ref().is_some_and(|splats| splats.fits(variant, room)) {
            self.made += 1;
            let made =
                SplatList::new(variant, room, self.made, self.splats.as_deref(), self.crowding.buffer())?;
            self.retired.take(self.splats.replace(Arc::new(made)));
        }
        Ok(shares)
    }

    fn make_present(&mut self, scenes: &[Placed<'_>], variant: Variant, size: [u32; 2]) -> Result<()> {
        let is_other = |present: &Option<Present>| present.as_ref().is_none_or(|p| p.variant != variant);
        if is_other(&self.present) {
            std::mem::swap(&mut self.present, &mut self.previous);
        }
        let with_lookups = scenes.iter().find(|placed| {
            variant.texture.is_some() && placed.scene.texture.is_some()
                || variant.materials && placed.scene.materials.is_some()
        });
        let with_lookups = with_lookups.map(|placed| placed.scene);
        if is_other(&self.present) {
            self.retired.take(self.present.take());
            if variant.precision != self.options.precision {
                let name = &self.device.description().name;
                log::warn!("{name} cannot blend 32-bit floats: sums are kept in 16 bits");
            }
            let targets = match self.pipelines.has_host() {
                true => RenderTargets::of_host(&self.device, &variant, size)?,
                false => RenderTargets::new(&self.device, &variant, size)?,
            };
            self.made += 1;
            self.present = Some(Present {
                id: self.made,
                variant,
                scenes: Vec::new(),
                splats: 0,
                passes: Vec::new(),
                view: ViewSet::new(&self.device, &self.view, &variant, with_lookups)?,
                targets,
                readback: Vec::new(),
                _view: self.view.clone(),
            });
        }
        match &mut self.present {
            Some(present) if present.view.scene != with_lookups.map(|scene| scene.id) => {
                let view = ViewSet::new(&self.device, &self.view, &variant, with_lookups)?;
                self.retired.take(Some(std::mem::replace(&mut present.view, view).set));
            }
            _ => {}
        }
        Ok(())
    }

    /// Makes the pipelines of the present passes for such scenes, if they are others than before.
    fn make_passes(&mut self, scenes: &[SceneVariant], of_host: HostBindings<'_>) -> Result<()> {
        let Self { present: Some(present), pipelines, device, splats, .. } = self else { return Ok(()) };
        let splats = splats.as_ref().filter(|_| present.variant.is_tiled());
        let splats_id = splats.map_or(0, |splats| splats.id);
        let of_splats = present.splats == splats_id;
        if !present.passes.is_empty() && present.scenes == scenes && of_splats {
            return Ok(());
        }
        let beside: Vec<_> = match splats {
            Some(splats) => of_host.iter().copied().chain(splats.bindings(&present.variant)).collect(),
            None => of_host.to_vec(),
        };
        let list = pipelines.passes(&present.variant, scenes.len());
        let same = of_splats
            && list.len() == present.passes.len()
            && list.iter().zip(&present.passes).all(|(pass, prepared)| std::ptr::eq(*pass, prepared.pass));
        // All is made before any of it is exchanged: after an error the passes are those of the scenes before.
        let fresh =
            list.iter().filter(|_| !same).map(|pass| prepared(device, pass, pipelines, present, &beside));
        let fresh = fresh.collect::<Result<Vec<_>>>()?;
        let made = list.iter().map(|pass| pipelines.of(device, pass, &present.variant, scenes));
        let made = made.collect::<Result<Vec<_>>>()?;
        if !same {
            self.retired.take(Some(std::mem::replace(&mut present.passes, fresh)));
        }
        for (prepared, made) in present.passes.iter_mut().zip(made) {
            let to_own = prepared.framebuffer.is_some();
            prepared.accesses = prepared.pass.accesses(&present.variant, scenes, to_own);
            prepared.pipelines = made;
        }
        present.scenes = scenes.to_vec();
        present.splats = splats_id;
        Ok(())
    }
}

impl Present {
    /// A pass of the frame.
    pub fn pass(&self, pass: &'static Pass) -> Option<&Prepared> {
        self.passes.iter().find(|prepared| std::ptr::eq(prepared.pass, pass))
    }
}

/// A pass without its pipelines.
fn prepared(
    device: &Arc<Device>,
    pass: &'static Pass,
    pipelines: &mut Pipelines,
    present: &Present,
    of_host: HostBindings<'_>,
) -> Result<Prepared> {
    let framebuffer = match (pipelines.render_pass(device, pass, &present.variant)?, &pass.commands) {
        (Some(into), Commands::Draws(targets)) => {
            Some(Framebuffer::new(device, &into, &targets.images(&present.targets))?)
        }
        _ => None,
    };
    let targets = match pass.programs {
        Programs::None => None,
        Programs::OfFrame(_) | Programs::OfScene(_) => Some(present.targets.set(device, pass, of_host)?),
    };
    Ok(Prepared { pass, accesses: Vec::new(), targets, framebuffer, pipelines: Vec::new() })
}

impl ViewSet {
    fn new(device: &Arc<Device>, view: &Buffer, variant: &Variant, scene: Option<&Scene>) -> Result<Self> {
        let texture = scene.and_then(|scene| scene.texture.as_ref()).filter(|_| variant.texture.is_some());
        let materials = scene.and_then(|scene| scene.materials.as_ref()).filter(|_| variant.materials);
        let lookups = [
            texture.map(|texture| (&resource::TEXTURE, Binding::whole(&texture.buffer))),
            materials.map(|materials| (&resource::MATERIALS, Binding::whole(&materials.buffer))),
        ];
        let all: Vec<_> = uniforms::bindings(view).into_iter().chain(lookups.into_iter().flatten()).collect();
        Ok(Self { set: DescriptorSet::new(device, &all)?, scene: scene.map(|scene| scene.id) })
    }
}
