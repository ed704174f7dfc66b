//! What frames make of a scene, for all its instances: splats, lists and counts, and descriptor sets of all that its passes see.

use super::pass::{Pass, Scope};
use super::passes::{footprint, visibility};
use super::resource::Resource;
use super::splat_buffers::{ALIGNMENT, Batches, LIST_HEADER, SPLAT, SplatBuffers};
use super::splat_list::{Share, slots};
use super::uniforms::{self, VIEW};
use super::variant::SceneVariant;
use crate::error::Result;
use crate::scene::{Elements, Scene};
use crate::vk::shaders::layout::{Chunk, Counts, Splat};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Commands, DescriptorSet, Device, Encoder, Recorder};
use std::ops::Range;
use std::sync::Arc;

/// What frames make of a scene.
pub struct SceneResources {
    // Sets go before what they name.
    sets: Sets,
    /// Of the counts of each part, where they are counted: descriptor set 2 of what counts.
    count_sets: Vec<DescriptorSet>,
    splats: Option<SplatBuffers>,
    /// Its share of the splats of the frame, for tiles.
    share: Option<Share>,
    /// Those of discs moved away by ε, where they are wanted beside.
    moved: Option<SplatBuffers>,
    /// Culled surfels by reason, of each part.
    counts: Option<Buffer>,
    /// Numbers of triangles of many pixels, a list an instance.
    large_triangles: Option<Buffer>,
    /// The camera as each instance has it, where there are instances.
    pub views: Option<Buffer>,
    parts: Vec<Range<u64>>,
    /// Clips of each part.
    clips: Vec<u32>,
    /// Lines and triangles: how many, and the number of the first.
    elements: [Option<[u32; 2]>; 2],
    needs: Needs,
    batches: Batches,
    /// Surfels of the present frame.
    count: u64,
    /// Instances of the present frame.
    instances: u64,
}

/// What a frame needs of a scene beside its variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// Splats are made for draws.
    pub splats: bool,
    /// Splats of moved discs are kept beside the others.
    pub moved: bool,
    /// Each instance has the camera in its own axes.
    pub instanced: bool,
    /// How many instances there are.
    pub instances: u64,
}

/// Descriptor sets 0 of a scene's passes.
#[derive(Default)]
struct Sets {
    /// Batch by batch, part by part.
    surfels: Vec<DescriptorSet>,
    /// The same of moved discs.
    moved: Vec<DescriptorSet>,
    /// Of lines and of triangles, batch by batch.
    elements: [Vec<DescriptorSet>; 2],
}

/// Instances of a scene that follow each other in a frame, in one batch.
#[derive(Clone, Copy)]
pub struct Run<'a> {
    /// The scene.
    pub scene: &'a SceneResources,
    /// Number of the first instance in the frame.
    pub place: usize,
    /// Its number among those of the scene.
    pub first: u64,
    /// How many they are.
    pub count: u64,
}

/// What one descriptor set names, of each instance of a run: a part of a scene's surfels, its lines or its triangles.
pub struct Part<'a> {
    pub set: &'a DescriptorSet,
    /// Of its counts, if they are there.
    pub counts: Option<&'a DescriptorSet>,
    /// The push constants of `lib/instance.glsl`.
    pub chunk: Chunk,
    pub instances: u32,
    /// Instances that there is room for in the batch.
    pub room: u32,
}

impl Needs {
    /// Whether what was made for these does for `others`, too.
    pub fn cover(&self, others: &Self) -> bool {
        let same = |needs: &Self| (needs.splats, needs.moved, needs.instanced);
        let enough = others.instances..=4 * others.instances;
        same(self) == same(others) && enough.contains(&self.instances)
    }
}

impl SceneResources {
    /// Buffers and descriptor sets for a scene in frames of `variant`, which must outlive them, as must the `view`'s numbers.
    pub fn new(
        device: &Arc<Device>,
        scene: &Scene,
        variant: &SceneVariant,
        needs: Needs,
        view: &Buffer,
        share: Option<Share>,
    ) -> Result<Self> {
        let kinds = scene.primitives.as_ref();
        let of = |elements: &Elements| [elements.count, elements.first];
        let triangles = kinds.and_then(|kinds| kinds.triangles.as_ref()).map(of);
        let listed = triangles.map_or(0, |[count, _]| u64::from(count));
        let batches = batches_of(device, scene, needs.instances);
        let splats = |wanted: bool| {
            let wanted = wanted && needs.splats;
            wanted.then(|| SplatBuffers::new(device, scene, batches)).transpose()
        };
        let list = |_| {
            let bytes = batches.count() * batches.stride(LIST_HEADER, 4 * listed);
            Buffer::storage(device, "large triangles", bytes)
        };
        let views = || Buffer::uniform(device, "views", batches.count() * batches.stride(0, VIEW));
        let clips = scene.clip_chunks().unwrap_or_default();
        let mut made = Self {
            sets: Sets::default(),
            count_sets: Vec::new(),
            splats: splats(true)?,
            share,
            moved: splats(needs.moved)?,
            counts: None,
            large_triangles: triangles.map(list).transpose()?,
            views: needs.instanced.then(views).transpose()?,
            parts: scene.chunks().to_vec(),
            clips: clips.iter().map(|clips| clips.count as u32).collect(),
            elements: [kinds.and_then(|kinds| kinds.lines.as_ref()).map(of), triangles],
            needs,
            batches,
            count: 0,
            instances: 0,
        };
        made.sets = made.make_sets(device, scene, variant, view)?;
        Ok(made)
    }

    /// What it was made for.
    pub fn needs(&self) -> &Needs {
        &self.needs
    }

    /// Its share of the splats of the frame, for tiles.
    pub fn share(&self) -> Option<&Share> {
        self.share.as_ref()
    }

    /// Frames from now on are of the first `count` surfels of so many instances.
    pub fn show(&mut self, count: u64, instances: u64) {
        (self.count, self.instances) = (count, instances);
    }

    /// Frames from now on may count: makes what they count in, if it is not there.
    pub fn make_counts(&mut self, device: &Arc<Device>) -> Result<()> {
        if self.counts.is_some() {
            return Ok(());
        }
        let parts = self.parts.len() as u64;
        let counts = Buffer::readback(device, "counts", (parts * ALIGNMENT).max(ALIGNMENT))?;
        let set = |part: u64| {
            let binding = Binding::Storage(&counts, part * ALIGNMENT, ALIGNMENT);
            DescriptorSet::new(device, &[(&resource::COUNTS, binding)])
        };
        self.count_sets = (0..parts).map(set).collect::<Result<_>>()?;
        self.counts = Some(counts);
        Ok(())
    }

    fn make_sets(
        &self,
        device: &Arc<Device>,
        scene: &Scene,
        variant: &SceneVariant,
        view: &Buffer,
    ) -> Result<Sets> {
        let batches = &self.batches;
        let blocks = |batch: u64| {
            let [frame, view] = uniforms::bindings(view);
            let of_batch = |views| {
                let (start, bytes) = (batch * batches.stride(0, VIEW), batches.len(batch) * VIEW);
                (&resource::VIEWS, Binding::Uniform(views, start, bytes))
            };
            [frame, self.views.as_ref().map_or(view, of_batch)]
        };
        let of_surfels = variant.resources(Scope::Surfels);
        let surfels = |buffers: Option<&SplatBuffers>, batch: u64, number: usize| {
            let mut there = scene.bindings(number);
            there.extend(blocks(batch));
            there.extend(buffers.into_iter().flat_map(|splats| splats.bindings(scene, batch, number)));
            let share = self.share.as_ref().filter(|_| buffers.is_none());
            there.extend(share.into_iter().flat_map(|share| share.bindings(scene, batches, batch, number)));
            wanted_set(device, &of_surfels, there)
        };
        let every = |buffers: Option<&SplatBuffers>| {
            let parts =
                (0..batches.count()).flat_map(|batch| (0..self.parts.len()).map(move |part| (batch, part)));
            parts.map(|(batch, part)| surfels(buffers, batch, part)).collect::<Result<Vec<_>>>()
        };
        let elements = |kind: usize| {
            let wanted = variant.resources([Scope::Lines, Scope::Triangles][kind]);
            let set = |batch: u64| {
                let mut there = scene.element_bindings(kind);
                there.extend(blocks(batch));
                there.extend(self.large_triangles.as_ref().map(|lists| {
                    let bytes = LIST_HEADER + batches.len(batch) * 4 * self.triangles();
                    (
                        &resource::LARGE_TRIANGLES,
                        Binding::Storage(lists, batch * self.triangle_stride(), bytes),
                    )
                }));
                wanted_set(device, &wanted, there)
            };
            let count = if self.elements[kind].is_some() { batches.count() } else { 0 };
            (0..count).map(set).collect::<Result<Vec<_>>>()
        };
        Ok(Sets {
            surfels: every(self.splats.as_ref())?,
            moved: self.moved.as_ref().map_or(Ok(Vec::new()), |moved| every(Some(moved)))?,
            elements: [elements(0)?, elements(1)?],
        })
    }

    /// Its buffers of a resource.
    pub fn buffers(&self, resource: Resource) -> impl Iterator<Item = &Buffer> {
        let both = [&self.splats, &self.moved].into_iter().flatten();
        let of_splats = both.filter_map(move |splats| match resource {
            Resource::Splats => Some(&splats.splats),
            Resource::ScreenClips => splats.screen_clips.as_ref(),
            _ => None,
        });
        let other = match resource {
            Resource::Counts => self.counts.as_ref(),
            Resource::LargeTriangles => self.large_triangles.as_ref(),
            _ => None,
        };
        of_splats.chain(other)
    }

    /// Empties lists, or counts, of the present instances.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, resource: Resource) {
        let batches = self.present_batches();
        match resource {
            Resource::LargeTriangles => {
                let Some(lists) = &self.large_triangles else { return };
                let starts = batches.map(|batch| batch * self.triangle_stride());
                starts.for_each(|start| enc.zero_range(lists, start, LIST_HEADER));
            }
            _ => self.buffers(resource).for_each(|buffer| enc.zero(buffer)),
        }
    }

    /// How many triangles there are.
    fn triangles(&self) -> u64 {
        self.elements[1].map_or(0, |[count, _]| u64::from(count))
    }

    /// Bytes of a batch's lists of large triangles.
    fn triangle_stride(&self) -> u64 {
        self.batches.stride(LIST_HEADER, 4 * self.triangles())
    }

    /// Where the camera of an instance is in `views`, bytes.
    pub fn view_start(&self, instance: u64) -> u64 {
        let [batch, number] = self.batches.of(instance);
        batch * self.batches.stride(0, VIEW) + number * VIEW
    }

    /// The batches that instances of the present frame are in.
    fn present_batches(&self) -> Range<u64> {
        let last = self.instances.checked_sub(1).map(|last| self.batches.of(last)[0]);
        0..last.map_or(0, |last| last + 1)
    }

    /// Surfels of the present frame, in all instances.
    pub fn count(&self) -> u64 {
        self.count * self.instances
    }

    /// Culled surfels of the last counted frame, by reason; it must be over.
    pub fn counts(&self) -> Counts {
        self.counts.as_ref().map_or(Counts { culled: [0; 5] }, |counts| counts_in(counts.bytes()))
    }

    /// Memory of splats and what belongs to them, bytes.
    pub fn bytes(&self) -> u64 {
        let splats = [&self.splats, &self.moved].into_iter().flatten().map(SplatBuffers::bytes);
        splats.sum::<u64>() + self.counts.as_ref().map_or(0, Buffer::size)
    }

    /// Copies the splats of the last frame, one a surfel, to the CPU, instance by instance.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<Vec<Splat>>> {
        let (size, capacity) = (self.count * SPLAT, self.parts.last().map_or(0, |part| part.end));
        let of_draws = self.splats.as_ref().map(|made| &made.splats);
        let of_frame = self.share.as_ref().and_then(|share| share.list.buffer(Resource::Splats));
        let Some(made) = of_draws.or(of_frame).filter(|_| size > 0) else {
            return Ok(vec![Vec::new(); self.instances as usize]);
        };
        let target = Buffer::readback(device, "read splats", made.size())?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, made, &target))?;
        let of_instance = |instance: u64| {
            let start = match (&self.splats, &self.share) {
                (Some(made), _) => made.splats_start(instance, capacity),
                (None, Some(share)) => SPLAT * share.first_splat(capacity, &self.batches, instance),
                (None, None) => 0,
            } as usize;
            bytemuck::pod_collect_to_vec(&target.bytes()[start..start + size as usize])
        };
        Ok((0..self.instances).map(of_instance).collect())
    }

    /// Bytes of the counts; 0 where nothing is counted.
    pub fn counts_size(&self) -> u64 {
        self.counts.as_ref().map_or(0, Buffer::size)
    }
}

/// The batches of so many instances of a scene.
pub fn batches_of(device: &Device, scene: &Scene, instances: u64) -> Batches {
    let triangles = scene.primitives.as_ref().and_then(|kinds| kinds.triangles.as_ref());
    let listed = triangles.map_or(0, |triangles| u64::from(triangles.count));
    let bytes = (slots(scene.capacity()) * SPLAT).max(4 * listed);
    let range = device.capabilities().max_storage_buffer_range - LIST_HEADER;
    Batches::new(instances, scene.chunks().len(), bytes, range)
}

/// A descriptor set of what is wanted of what is there.
fn wanted_set(
    device: &Arc<Device>,
    wanted: &[&'static shaders::Resource],
    mut there: Vec<(&'static shaders::Resource, Binding<'_>)>,
) -> Result<DescriptorSet> {
    there.retain(|(resource, _)| wanted.contains(resource));
    DescriptorSet::new(device, &there)
}

fn copy_to_host(rec: &mut Recorder<'_>, from: &Buffer, to: &Buffer) {
    use crate::vk::Access;
    let uses = [from.with(Access::COPY_READ), to.with(Access::COPY_WRITE)];
    rec.pass("read splats", &uses).copy(from, to, 0, to.size());
    rec.wait(&[to.with(Access::HOST_READ)]);
}

/// Culled surfels by reason, of the counts of all parts.
pub fn counts_in(bytes: &[u8]) -> Counts {
    let parts = bytes.chunks_exact(ALIGNMENT as usize);
    let culled =
        parts.map(|part| bytemuck::pod_read_unaligned::<Counts>(&part[..size_of::<Counts>()]).culled);
    let add = |sum: [u32; 5], counts: [u32; 5]| std::array::from_fn(|i| sum[i].saturating_add(counts[i]));
    Counts { culled: culled.fold([0; 5], add) }
}

impl<'a> Run<'a> {
    /// Whether another begins where this ends, in the same batch.
    pub fn takes(&self, other: &Self) -> bool {
        std::ptr::eq(self.scene, other.scene)
            && other.first == self.first + self.count
            && self.scene.batches.of(other.first)[0] == self.scene.batches.of(self.first)[0]
    }

    /// All instances of its scene, batch by batch.
    pub fn batches(self) -> impl Iterator<Item = Self> {
        let batches = self.scene.present_batches().map(move |batch| self.scene.batches.range(batch));
        let present = batches.map(move |range| range.start..range.end.min(self.scene.instances));
        present.map(move |range| Self { first: range.start, count: range.end - range.start, ..self })
    }

    /// What a pass sees of this, descriptor set by descriptor set.
    pub fn parts(&self, scope: Scope, pass: &Pass) -> Vec<Part<'a>> {
        match scope {
            Scope::Surfels => self.surfels(pass).collect(),
            Scope::Lines | Scope::Triangles | Scope::View => self.elements(scope).into_iter().collect(),
        }
    }

    fn surfels(&self, pass: &Pass) -> impl Iterator<Item = Part<'a>> {
        let present = (self.first + self.count
            - self.scene.batches.range(self.scene.batches.of(self.first)[0]).start)
            as u32;
        let (scene, [batch, instance]) = (self.scene, self.scene.batches.of(self.first));
        let moved = [&raw const footprint::MOVED, &raw const visibility::DRAWN].contains(&&raw const *pass);
        let sets = if moved && scene.moved.is_some() { &scene.sets.moved } else { &scene.sets.surfels };
        let parts = scene.parts.len();
        let sets = &sets[parts * batch as usize..parts * (batch as usize + 1)];
        let instances = self.count as u32;
        sets.iter().zip(&scene.parts).enumerate().map(move |(number, (set, part))| {
            let own = part.end - part.start;
            let room = scene.share.as_ref().map_or(own, |_| slots(own));
            let chunk = Chunk {
                count: scene.count.saturating_sub(part.start).min(own) as u32,
                first_id: part.start as u32,
                capacity: own as u32,
                instance_stride: room as u32,
                clip_stride: scene.clips.get(number).copied().unwrap_or_default(),
                first_instance: instance as u32,
                first_clip: scene
                    .share
                    .as_ref()
                    .map_or(0, |share| share.first_clip(&scene.batches, batch, number))
                    as u32,
                attribute_rows: scene.share.as_ref().map_or(0, |share| share.list.rows()) as u32,
                instance_count: present,
            };
            let room = scene.batches.len(batch) as u32;
            Part { set, counts: scene.count_sets.get(number), chunk, instances, room }
        })
    }

    fn elements(&self, scope: Scope) -> Option<Part<'a>> {
        let kind = match scope {
            Scope::Lines => 0,
            Scope::Triangles => 1,
            Scope::View | Scope::Surfels => return None,
        };
        let [batch, instance] = self.scene.batches.of(self.first);
        let [count, first] = self.scene.elements[kind]?;
        let set = self.scene.sets.elements[kind].get(batch as usize)?;
        let instance = instance as u32;
        let chunk = Chunk {
            count,
            first_id: first,
            capacity: count,
            instance_stride: count,
            clip_stride: 0,
            first_instance: instance,
            first_clip: 0,
            attribute_rows: 0,
            instance_count: 0,
        };
        let instances = self.count as u32;
        Some(Part { set, counts: None, chunk, instances, room: instances })
    }
}
