//! Frame resources: pipelines, targets and scene resources, created when scene or settings change and reused by frames.

use super::description::{Description, describe};
use super::distinct::Distinct;
use super::list_layout::ListLayout;
use super::list_range::ListRange;
use super::pipelines::{Host, Pipelines};
use super::rasterizer::width_of_blended_sums;
use super::recording::Frame;
use super::renderer::RenderOptions;
use super::resource::Resource;
use super::scene_cache::SceneCache;
use super::scene_resources::{InstanceRun, Needs, SceneResources};
use super::scene_variant::SceneVariant;
use super::slicing::Slicing;
use super::splat_list::{ListExtent, SplatList, padded_instances};
use super::targets::{HostBindings, RenderTargets, check_size};
use super::tile_rect::{TileRect, tiles_of_slices};
use super::uniforms::{self, Uniforms};
use super::variant::Variant;
use super::variant_resources::{VariantResources, ViewSet, prepared};
use crate::error::Result;
use crate::geometry::Camera;
use crate::scene::instance::Placed;
use crate::settings::splatting::Visibility;
use crate::settings::{Precision, RasterizerReason, Settings};
use crate::vk::{Access, Buffer, Device, Recorder, Update};
use std::any::Any;
use std::sync::Arc;

/// Frames that targets of another size may be unused.
const UNUSED_FRAMES: u32 = 4;

/// Frame resources for frames on one device, of one size at a time.
pub struct FrameResources {
    // Fields drop in this order: views before their buffers.
    current: Option<VariantResources>,
    /// Reason for its rasterizer.
    reason: Option<RasterizerReason>,
    /// Level of detail of the last frame, px.
    lod: f32,
    /// Resources of the previous variant or size: alternating between two, as progressive rendering does, creates nothing.
    previous: Option<VariantResources>,
    /// Frames since they were used.
    unused_frames: u32,
    scenes: SceneCache,
    /// Per instance of the frame: index of its scene in the cache, and its index among that scene's instances.
    placements: Vec<[usize; 2]>,
    /// Splats of the frame, on the tile path.
    splats: Option<Arc<SplatList>>,
    /// Number of splats, padding included.
    splat_count: u64,
    /// The tiles that the splats of each slice may cover, of a sliced frame.
    tiles_of_slices: Vec<TileRect>,
    slicing: Slicing,
    pipelines: Pipelines,
    view: Arc<Buffer>,
    options: RenderOptions,
    device: Arc<Device>,
    disposal: Disposal,
    /// Number of objects created so far: source of ids.
    created: u64,
}

/// Disposal of unused resources.
pub enum Disposal {
    /// Destroy at once: every frame is waited for.
    Immediate,
    /// Collect for deferred destruction.
    Deferred(Vec<Deferred>),
}

/// An unused resource, kept until the GPU has finished with it.
pub type Deferred = Box<dyn Any + Send + Sync>;

impl Disposal {
    fn add<T: Any + Send + Sync>(&mut self, deferred: Option<T>) {
        if let (Self::Deferred(list), Some(deferred)) = (self, deferred) {
            list.push(Box::new(deferred));
        }
    }
}

impl FrameResources {
    /// Creates frame resources without scenes. With a `host`, raster passes are drawn in its subpasses.
    pub fn new(
        device: &Arc<Device>,
        options: RenderOptions,
        disposal: Disposal,
        host: Option<Host>,
    ) -> Result<Self> {
        check_size(device, options.size)?;
        Ok(Self {
            current: None,
            reason: None,
            lod: 0.0,
            previous: None,
            unused_frames: 0,
            scenes: SceneCache::default(),
            placements: Vec::new(),
            splats: None,
            splat_count: 0,
            tiles_of_slices: Vec::new(),
            slicing: Slicing::new(device)?,
            pipelines: Pipelines::new(host),
            view: Arc::new(Buffer::uniform(device, "frame", uniforms::BYTES)?),
            options,
            device: device.clone(),
            disposal,
            created: 0,
        })
    }

    /// Float width of the last frame's samples (pull–push) or weighted sums.
    pub fn precision(&self) -> Precision {
        let unknown = || width_of_blended_sums(&self.device, &self.options);
        self.current.as_ref().map_or_else(unknown, |current| current.variant.precision)
    }

    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Resources of the last frame's variant.
    pub fn current(&self) -> Option<&VariantResources> {
        self.current.as_ref()
    }

    /// Reason for the rasterizer of the last frame.
    pub fn rasterizer_reason(&self) -> Option<RasterizerReason> {
        self.reason
    }

    /// Level of detail of the last frame, px.
    pub fn lod(&self) -> f32 {
        self.lod
    }

    /// Resources of the last frame's scenes, each once.
    pub fn scenes(&self) -> impl Iterator<Item = &SceneResources> + Clone {
        self.scenes.current()
    }

    /// Memory of splats, attributes and counters of the last frame, bytes.
    pub fn splat_bytes(&self) -> u64 {
        let tiled = self.current.as_ref().is_some_and(|current| current.variant.is_tiled());
        let of_frame = self.splats.as_ref().filter(|_| tiled).map_or(0, |splats| splats.bytes());
        of_frame + self.scenes().map(SceneResources::bytes).sum::<u64>()
    }

    /// The instances of the last frame in order: index of the scene, and index among its instances.
    pub fn placements(&self) -> &[[usize; 2]] {
        &self.placements
    }

    /// Takes the resources that became unused since the last call.
    pub fn take_deferred(&mut self) -> Vec<Deferred> {
        match &mut self.disposal {
            Disposal::Immediate => Vec::new(),
            Disposal::Deferred(list) => std::mem::take(list),
        }
    }

    /// Sets the size of the next frames, px.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.options.size = size;
    }

    /// Discards the targets, such as when a host changes its own.
    pub fn discard_targets(&mut self) {
        for old in [self.current.take(), self.previous.take()] {
            self.disposal.add(old);
        }
    }

    /// Enables or disables counting.
    pub fn count(&mut self, on: bool) {
        self.options.count = on;
    }

    /// Describes a frame; rejects unsupported frames.
    pub fn describe(
        &self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        size: [u32; 2],
    ) -> Result<Description> {
        let options = RenderOptions { size, ..self.options };
        describe(&self.device, &options, scenes, camera, settings, &self.slicing)
    }

    /// See [`RenderOptions::most_splats`].
    pub fn most_splats(&self) -> Option<u32> {
        self.options.most_splats
    }

    /// Whether a frame that is over lacked splats since the last call.
    pub fn learn(&mut self) -> bool {
        self.slicing.learn()
    }

    /// Creates missing resources of a frame, with readback buffers if `read`; returns uniforms and variant.
    pub fn prepare(
        &mut self,
        scenes: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<(Uniforms, Variant)> {
        let frame = self.describe(scenes, camera, settings, self.options.size)?;
        self.make(scenes, &frame, self.options.size, &[])?;
        self.slicing.begin(scenes, frame.splats_per_tile);
        match &mut self.current {
            Some(current) if read && current.readback.is_empty() => {
                current.readback = current.targets.make_readback(&self.device)?;
            }
            _ => {}
        }
        Ok((frame.uniforms, frame.variant))
    }

    /// Creates missing resources of a frame; in a host's subpasses with targets of `size` px and the host's `bindings`.
    pub fn make(
        &mut self,
        scenes: &[Placed<'_>],
        frame: &Description,
        size: [u32; 2],
        bindings: HostBindings<'_>,
    ) -> Result<()> {
        self.make_scenes(scenes, frame)?;
        self.make_current(scenes, frame.variant, size)?;
        self.reason = Some(frame.reason);
        self.lod = frame.lod;
        self.make_passes(&frame.scenes, bindings)
    }

    /// Creates the pipelines of a frame, and of others that differ by camera, size and density only. Creates no other resources.
    pub fn make_pipelines(&mut self, frame: &Description) -> Result<()> {
        for (variant, scenes) in frame.choices() {
            let list = self.pipelines.passes(&variant);
            self.pipelines.for_passes(&self.device, &list, &variant, &scenes)?;
        }
        Ok(())
    }

    /// Records the prepared frame with these uniforms. Passes in a host's subpasses are not recorded, but their inputs are synchronized.
    pub fn record(&self, rec: &mut Recorder<'_>, uniforms: &Uniforms) {
        self.update(rec, uniforms);
        let Some((current, frame)) = self.frame() else { return };
        let frame = Frame { background: uniforms.frame.background, ..frame };
        // Several passes count.
        frame.clear(rec, &[Resource::Counts]);
        let mut awaited = Vec::new();
        for prepared in &current.passes {
            if self.pipelines.is_host_pass(prepared.pass) {
                frame.clear(rec, prepared.pass.clears);
                awaited.extend(frame.uses(&prepared.accesses));
            } else {
                prepared.record(rec, &frame);
            }
        }
        if current.variant.count {
            let counts = self.scenes().flat_map(|scene| scene.buffers(Resource::Counts));
            awaited.extend(counts.map(|counts| counts.with(Access::HOST_READ)));
        }
        if current.variant.is_tiled() {
            awaited.push(self.slicing.buffer().with(Access::HOST_READ));
        }
        if !awaited.is_empty() {
            rec.wait(&awaited);
        }
    }

    /// Context to record the prepared frame.
    pub fn frame(&self) -> Option<(&VariantResources, Frame<'_>)> {
        let current = self.current.as_ref()?;
        let scenes: Vec<_> = self.scenes().collect();
        let one = |index: usize| {
            let [scene, instance] = self.placements[index];
            InstanceRun { scene: scenes[scene], index, first: instance as u64, count: 1 }
        };
        let (mut runs, mut batches): (Vec<InstanceRun<'_>>, Vec<InstanceRun<'_>>) = Default::default();
        for run in (0..self.placements.len()).map(one) {
            match runs.last_mut() {
                Some(last) if last.continues_with(&run) => last.count += 1,
                _ => runs.push(run),
            }
            if run.first == 0 {
                batches.extend(run.batches());
            }
        }
        let VariantResources { variant, targets, view, .. } = current;
        let splats = self.splats.as_deref().filter(|_| variant.is_tiled());
        let frame = Frame {
            variant,
            view: &view.set,
            targets,
            splats,
            splat_count: self.splat_count,
            tiles_of_slices: &self.tiles_of_slices,
            most_splats: self.most_splats(),
            number: self.slicing.frame(),
            background: [0.0; 4],
            runs,
            batches,
        };
        Some((current, frame))
    }

    /// Records the update of the uniform buffers.
    fn update(&self, rec: &mut Recorder<'_>, uniforms: &Uniforms) {
        let of_scenes: Vec<_> = self.scenes().collect();
        let mut bytes_of_scenes: Vec<Vec<u8>> = vec![Vec::new(); of_scenes.len()];
        for ([scene, instance], block) in self.placements.iter().zip(&uniforms.instances) {
            let (start, bytes) =
                (of_scenes[*scene].view_start(*instance as u64) as usize, bytemuck::bytes_of(block));
            bytes_of_scenes[*scene].resize(start + bytes.len(), 0);
            bytes_of_scenes[*scene][start..].copy_from_slice(bytes);
        }
        let uniform = |buffer, bytes| Update { buffer, start: 0, bytes, read: Access::UNIFORM_READ };
        let bytes = uniforms.bytes();
        let views = of_scenes.iter().zip(&bytes_of_scenes);
        let views = views.filter_map(|(scene, bytes)| Some(uniform(scene.views.as_ref()?, bytes)));
        let groups = of_scenes.iter().flat_map(|scene| scene.group_updates());
        rec.update(std::iter::once(uniform(&self.view, &bytes)).chain(views).chain(groups));
    }

    /// Creates missing resources of these scenes, and sets their surfel counts.
    fn make_scenes(&mut self, placed: &[Placed<'_>], frame: &Description) -> Result<()> {
        let instanced = !frame.uniforms.instances.is_empty();
        let variant = &frame.variant;
        let distinct = Distinct::new(placed);
        let splats = variant.pull_push.is_none() && !variant.is_tiled();
        let of_host = self.pipelines.has_host();
        let ranges = self.make_splats(&distinct, frame)?;
        let Distinct { scenes: list, instances, placements } = distinct;
        self.placements = placements;
        let counts: Vec<_> = instances.iter().map(|instances| instances.len() as u64).collect();
        let needs = |scene: usize| Needs {
            splats,
            moved: of_host && splats && variant.visibility == Visibility::Axis,
            instanced,
            clusters: variant.clusters,
            occlusion_culling: variant.occlusion_culling,
            instances: padded_instances(counts[scene]),
        };
        let Self { scenes, disposal, device, view, splats: splat_list, .. } = self;
        let splat_list = splat_list.as_ref();
        let fits = |resources: &SceneResources, scene: usize| {
            resources.needs().satisfies(&needs(scene))
                && match (splat_list, ranges.get(scene)) {
                    (Some(splats), Some((start, room))) => {
                        resources.needs() == &needs(scene)
                            && resources.range().is_some_and(|range| range.is_range_of(splats, *start, room))
                    }
                    _ => resources.range().is_none(),
                }
        };
        let make = |scene: usize| {
            let variant = &frame.scenes[instances[scene][0]];
            let range = splat_list.zip(ranges.get(scene));
            let range = range
                .map(|(splats, (start, room))| ListRange::new(splats, list[scene], *start, room.clone()));
            SceneResources::new(device, list[scene], variant, needs(scene), view, range)
        };
        let updated = scenes.update(&list, fits, make, |evicted| disposal.add(Some(evicted)));
        if updated.is_err() {
            self.placements.clear();
        }
        updated?;
        let last = list.len().saturating_sub(1);
        let all = scenes.current_mut().zip(list).zip(counts).zip(&frame.selections).enumerate();
        for (index, (((resources, scene), instances), selection)) in all {
            resources.set_frame(scene, instances, selection, index == last);
            if variant.count {
                resources.make_counts(device)?;
            }
        }
        Ok(())
    }

    /// Creates the splat list of these scenes; returns the start and the room of each scene's range, on the tile path.
    fn make_splats(
        &mut self,
        scenes: &Distinct<'_>,
        frame: &Description,
    ) -> Result<Vec<(ListExtent, Vec<u64>)>> {
        let variant = &frame.variant;
        self.tiles_of_slices.clear();
        if !variant.is_tiled() {
            return Ok(Vec::new());
        }
        let layout = ListLayout::new(&self.device, scenes, &frame.selections, variant, &self.scenes);
        self.tiles_of_slices = tiles_of_slices(&layout, &frame.selections);
        let ListLayout { ranges, extent, splats } = layout;
        self.splat_count = splats;
        if !self.splats.as_ref().is_some_and(|splats| splats.fits(variant, extent)) {
            self.created += 1;
            let (old, incomplete) = (self.splats.as_deref(), self.slicing.buffer());
            let splats = SplatList::new(variant, extent, self.created, old, incomplete)?;
            self.disposal.add(self.splats.replace(Arc::new(splats)));
        }
        Ok(ranges)
    }

    /// Discards the previous targets if they are of another size than this, and have been unused for some frames, as after a resize.
    fn discard_unused(&mut self, size: [u32; 2]) {
        self.unused_frames += 1;
        let is_old = self.unused_frames > UNUSED_FRAMES;
        if is_old && self.previous.as_ref().is_some_and(|previous| previous.targets.size != size) {
            self.disposal.add(self.previous.take());
        }
    }

    fn make_current(&mut self, scenes: &[Placed<'_>], variant: Variant, size: [u32; 2]) -> Result<()> {
        let is_other = |current: &Option<VariantResources>| {
            current.as_ref().is_none_or(|made| (made.variant, made.targets.size) != (variant, size))
        };
        if is_other(&self.current) {
            std::mem::swap(&mut self.current, &mut self.previous);
            self.unused_frames = 0;
        }
        self.discard_unused(size);
        let with_lookups = scenes.iter().find(|placed| {
            variant.texture.is_some() && placed.scene.texture.is_some()
                || variant.materials && placed.scene.materials.is_some()
        });
        let with_lookups = with_lookups.map(|placed| placed.scene);
        if is_other(&self.current) {
            self.disposal.add(self.current.take());
            if variant.precision != self.options.precision {
                let name = &self.device.description().name;
                log::warn!("{name} cannot blend 32-bit floats: sums are kept in 16 bits");
            }
            let targets = if self.pipelines.has_host() {
                RenderTargets::of_host(&self.device, &variant, size)?
            } else {
                RenderTargets::new(&self.device, &variant, size)?
            };
            self.created += 1;
            self.current = Some(VariantResources {
                id: self.created,
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
        match &mut self.current {
            Some(current) if current.view.scene != with_lookups.map(|scene| scene.id) => {
                let view = ViewSet::new(&self.device, &self.view, &variant, with_lookups)?;
                self.disposal.add(Some(std::mem::replace(&mut current.view, view).set));
            }
            _ => {}
        }
        Ok(())
    }

    /// Creates pipelines and descriptor sets of the current passes, if scenes or splat list changed.
    fn make_passes(&mut self, scenes: &[SceneVariant], of_host: HostBindings<'_>) -> Result<()> {
        let Self { current: Some(current), pipelines, device, splats, .. } = self else { return Ok(()) };
        let splats = splats.as_ref().filter(|_| current.variant.is_tiled());
        let splats_id = splats.map_or(0, |splats| splats.id);
        let of_splats = current.splats == splats_id;
        if !current.passes.is_empty() && current.scenes == scenes && of_splats {
            return Ok(());
        }
        let all_bindings: Vec<_> = match splats {
            Some(splats) => of_host.iter().copied().chain(splats.bindings(&current.variant)).collect(),
            None => of_host.to_vec(),
        };
        let list = pipelines.passes(&current.variant);
        let same = of_splats
            && list.len() == current.passes.len()
            && list.iter().zip(&current.passes).all(|(pass, prepared)| std::ptr::eq(*pass, prepared.pass));
        // Exchanged only after all are created: after an error the previous passes remain valid.
        let created_passes = list
            .iter()
            .filter(|_| !same)
            .map(|pass| prepared(device, pass, pipelines, current, &all_bindings));
        let created_passes = created_passes.collect::<Result<Vec<_>>>()?;
        let created = pipelines.for_passes(device, &list, &current.variant, scenes)?;
        if !same {
            self.disposal.add(Some(std::mem::replace(&mut current.passes, created_passes)));
        }
        for (prepared, pipelines) in current.passes.iter_mut().zip(created) {
            let to_own = prepared.framebuffer.is_some();
            prepared.accesses = prepared.pass.accesses(&current.variant, scenes, to_own);
            prepared.pipelines = pipelines;
        }
        current.scenes = scenes.to_vec();
        current.splats = splats_id;
        Ok(())
    }
}
