//! Scene resources: splats, lists, counts and descriptor sets of a scene and all its instances.

mod instance_run;

use super::list_range::ListRange;
use super::pass::Scope;
use super::resource::Resource;
use super::scene_variant::SceneVariant;
use super::selection::Selection;
use super::splat_buffers::{ALIGNMENT, Batches, LIST_HEADER, SPLAT, SplatBuffers};
use super::splat_list::slots;
use super::surfel_order::SurfelOrder;
use super::uniforms::{self, VIEW};
use super::visible_clusters::VisibleClusters;
use crate::error::Result;
use crate::scene::{CLUSTER, Elements, LARGEST_STRIDE, Scene};
use crate::vk::shaders::layout::{Counts, Group, Splat};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer, Commands, DescriptorSet, Device, Encoder, Recorder, Update};
use bytemuck::Zeroable;
pub use instance_run::{ChunkRun, InstanceRun};
use std::ops::Range;
use std::sync::Arc;

/// Resources of a scene.
pub struct SceneResources {
    // Drop order: sets before the resources in them.
    sets: Sets,
    /// Descriptor set 2 of passes that count, one per chunk.
    count_sets: Vec<DescriptorSet>,
    splats: Option<SplatBuffers>,
    /// Its range of the frame's splat list, on the tile path.
    range: Option<ListRange>,
    /// Splats of discs moved by ε, if both kinds are needed at once.
    moved: Option<SplatBuffers>,
    /// Culled surfels by reason, per chunk.
    counts: Option<Buffer>,
    /// Lists of large triangles, one per instance.
    large_triangles: Option<Buffer>,
    /// Order of its surfels, chunk by chunk, if they are in arbitrary order.
    order: Option<SurfelOrder>,
    /// Groups and visible clusters, if the frame culls clusters.
    clusters: Option<VisibleClusters>,
    /// Groups of the frame, chunk by chunk in each batch, if it culls clusters.
    groups: Vec<Vec<Group>>,
    /// Surfels of culled groups.
    culled: Counts,
    /// Views of the instances, if scenes are instanced.
    pub views: Option<Buffer>,
    chunks: Vec<Range<u64>>,
    /// Clips per chunk.
    clips: Vec<u32>,
    /// Lines and triangles: their count and first id.
    elements: [Option<[u32; 2]>; 2],
    needs: Needs,
    batches: Batches,
    /// Surfels of the frame.
    count: u64,
    /// Instances of the frame.
    instances: u64,
}

/// Requirements of a frame on a scene's resources, besides the variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// The scene has its own splat buffers (raster path).
    pub splats: bool,
    /// Splats of moved discs are stored separately.
    pub moved: bool,
    /// Each instance has its own view.
    pub instanced: bool,
    /// Its clusters of surfels are culled.
    pub clusters: bool,
    /// Hidden ones, too.
    pub occlusion_culling: bool,
    /// Number of instances.
    pub instances: u64,
}

/// Descriptor sets 0 of the passes of a scene.
#[derive(Default)]
struct Sets {
    /// Batch by batch, chunk by chunk.
    surfels: Vec<DescriptorSet>,
    /// Sets of moved discs, likewise.
    moved: Vec<DescriptorSet>,
    /// Of clusters, batch by batch, chunk by chunk.
    clusters: Vec<DescriptorSet>,
    /// Of lines and of triangles, batch by batch.
    elements: [Vec<DescriptorSet>; 2],
}

impl Needs {
    /// Whether resources created for these requirements satisfy `others`.
    pub fn satisfies(&self, others: &Self) -> bool {
        let same = |needs: &Self| {
            let Self { splats, moved, instanced, clusters, occlusion_culling, .. } = *needs;
            (splats, moved, instanced, clusters, occlusion_culling)
        };
        let enough = others.instances..=4 * others.instances;
        same(self) == same(others) && enough.contains(&self.instances)
    }
}

impl SceneResources {
    /// Creates buffers and descriptor sets of a scene in frames of `variant`. The scene and `view` must outlive them.
    pub fn new(
        device: &Arc<Device>,
        scene: &Scene,
        variant: &SceneVariant,
        needs: Needs,
        view: &Buffer,
        range: Option<ListRange>,
    ) -> Result<Self> {
        let kinds = scene.primitives.as_ref();
        let of = |elements: &Elements| [elements.count, elements.first];
        let triangles = kinds.and_then(|kinds| kinds.triangles.as_ref()).map(of);
        let listed = triangles.map_or(0, |[count, _]| u64::from(count));
        let batches = batches_of(device, scene, needs.instances);
        let splats = |needed: bool| {
            let needed = needed && needs.splats;
            needed.then(|| SplatBuffers::new(device, scene, batches)).transpose()
        };
        let list = |_| {
            let bytes = batches.count() * batches.stride(LIST_HEADER, 4 * listed);
            Buffer::storage(device, "large triangles", bytes)
        };
        let views = || Buffer::uniform(device, "views", batches.count() * batches.stride(0, VIEW));
        let clips = scene.clip_chunks().unwrap_or_default();
        let mut resources = Self {
            sets: Sets::default(),
            count_sets: Vec::new(),
            splats: splats(true)?,
            range,
            moved: splats(needs.moved)?,
            counts: None,
            large_triangles: triangles.map(list).transpose()?,
            order: variant.unordered.then(|| SurfelOrder::new(device, scene)).transpose()?,
            clusters: needs
                .clusters
                .then(|| VisibleClusters::new(device, scene, batches, needs.occlusion_culling))
                .transpose()?,
            groups: Vec::new(),
            culled: Counts::zeroed(),
            views: needs.instanced.then(views).transpose()?,
            chunks: scene.chunks().to_vec(),
            clips: clips.iter().map(|clips| clips.count as u32).collect(),
            elements: [kinds.and_then(|kinds| kinds.lines.as_ref()).map(of), triangles],
            needs,
            batches,
            count: 0,
            instances: 0,
        };
        resources.sets = resources.make_sets(device, scene, variant, view)?;
        Ok(resources)
    }

    /// Requirements that it was created for.
    pub fn needs(&self) -> &Needs {
        &self.needs
    }

    /// Its range of the frame's splat list, on the tile path.
    pub fn range(&self) -> Option<&ListRange> {
        self.range.as_ref()
    }

    /// Sets the surfel and instance counts of the next frame, its groups, and the curve along which the scene's surfels are sorted. `at_end`:
    /// its splats are the last ones of the frame.
    pub fn set_frame(&mut self, scene: &Scene, instances: u64, selection: &Selection, at_end: bool) {
        (self.count, self.instances) = (selection.count(), instances);
        if self.clusters.is_some() {
            let room = self.range.as_ref().map_or(&[][..], ListRange::room);
            (self.groups, self.culled) = (selection.lists(room, at_end), selection.culled());
        }
        if let Some(order) = &mut self.order {
            order.set_curve(scene);
        }
    }

    /// Order of its surfels, if they are in arbitrary order.
    pub fn order(&self) -> Option<&SurfelOrder> {
        self.order.as_ref()
    }

    /// Creates the counters, if missing.
    pub fn make_counts(&mut self, device: &Arc<Device>) -> Result<()> {
        if self.counts.is_some() {
            return Ok(());
        }
        let chunks = self.chunks.len() as u64;
        let counts = Buffer::readback(device, "counts", (chunks * ALIGNMENT).max(ALIGNMENT))?;
        let set = |chunk: u64| {
            let binding = Binding::Storage(&counts, chunk * ALIGNMENT, ALIGNMENT);
            DescriptorSet::new(device, &[(&resource::COUNTS, binding)])
        };
        self.count_sets = (0..chunks).map(set).collect::<Result<_>>()?;
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
        let uniform_bindings = |batch: u64| {
            let [frame, view] = uniforms::bindings(view);
            let of_batch = |views| {
                let (start, bytes) = (batch * batches.stride(0, VIEW), batches.len(batch) * VIEW);
                (&resource::VIEWS, Binding::Uniform(views, start, bytes))
            };
            [frame, self.views.as_ref().map_or(view, of_batch)]
        };
        let of_surfels = variant.resources(Scope::Surfels);
        let surfels = |buffers: Option<&SplatBuffers>, batch: u64, index: usize| {
            let mut bindings = scene.bindings(index);
            bindings.extend(uniform_bindings(batch));
            bindings.extend(self.order.as_ref().map(|order| (&resource::ORDER, order.binding(index))));
            bindings.extend(self.clusters.iter().flat_map(|clusters| clusters.bindings(batch, index)));
            bindings.extend(buffers.into_iter().flat_map(|splats| splats.bindings(scene, batch, index)));
            let range = self.range.as_ref().filter(|_| buffers.is_none());
            bindings
                .extend(range.and_then(|range| range.bindings(batches, batch, index)).into_iter().flatten());
            bound_set(device, &of_surfels, bindings)
        };
        let chunks =
            || (0..batches.count()).flat_map(|batch| (0..self.chunks.len()).map(move |chunk| (batch, chunk)));
        let every = |buffers: Option<&SplatBuffers>| {
            chunks().map(|(batch, chunk)| surfels(buffers, batch, chunk)).collect::<Result<Vec<_>>>()
        };
        let of_clusters = variant.resources(Scope::Clusters);
        let clusters = |(batch, index)| {
            let bounds = scene.cluster_bindings();
            let lists = self.clusters.iter().flat_map(|clusters| clusters.bindings(batch, index));
            let bindings = uniform_bindings(batch).into_iter().chain(bounds).chain(lists);
            bound_set(device, &of_clusters, bindings.collect())
        };
        let elements = |kind: usize| {
            let declared = variant.resources([Scope::Lines, Scope::Triangles][kind]);
            let set = |batch: u64| {
                let mut bindings = scene.element_bindings(kind);
                bindings.extend(uniform_bindings(batch));
                bindings.extend(self.large_triangles.as_ref().map(|lists| {
                    let bytes = LIST_HEADER + batches.len(batch) * 4 * self.triangles();
                    (
                        &resource::LARGE_TRIANGLES,
                        Binding::Storage(lists, batch * self.triangle_stride(), bytes),
                    )
                }));
                bound_set(device, &declared, bindings)
            };
            let count = if self.elements[kind].is_some() { batches.count() } else { 0 };
            (0..count).map(set).collect::<Result<Vec<_>>>()
        };
        Ok(Sets {
            surfels: every(self.splats.as_ref())?,
            moved: self.moved.as_ref().map_or(Ok(Vec::new()), |moved| every(Some(moved)))?,
            clusters: chunks().filter(|_| self.clusters.is_some()).map(clusters).collect::<Result<_>>()?,
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
            Resource::Order => self.order.as_ref().map(SurfelOrder::buffer),
            Resource::VisibleClusters => self.clusters.as_ref().map(VisibleClusters::buffer),
            Resource::HiddenClusters => self.clusters.as_ref().and_then(VisibleClusters::hidden),
            Resource::LargeTriangles => self.large_triangles.as_ref(),
            _ => None,
        };
        of_splats.chain(other)
    }

    /// Clears the lists, or counters, of the instances in use.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, resource: Resource) {
        let batches = self.used_batches();
        match resource {
            Resource::LargeTriangles => {
                let Some(lists) = &self.large_triangles else { return };
                let starts = batches.map(|batch| batch * self.triangle_stride());
                starts.for_each(|start| enc.zero_range(lists, start, LIST_HEADER));
            }
            Resource::VisibleClusters => {
                self.clusters.iter().for_each(|clusters| clusters.clear(enc, batches.clone()));
            }
            Resource::HiddenClusters => {
                self.clusters.iter().for_each(|clusters| clusters.clear_hidden(enc));
            }
            _ => self.buffers(resource).for_each(|buffer| enc.zero(buffer)),
        }
    }

    /// Number of triangles.
    fn triangles(&self) -> u64 {
        self.elements[1].map_or(0, |[count, _]| u64::from(count))
    }

    /// Bytes of a batch's lists of large triangles.
    fn triangle_stride(&self) -> u64 {
        self.batches.stride(LIST_HEADER, 4 * self.triangles())
    }

    /// Offset of an instance's view in `views`, bytes.
    pub fn view_start(&self, instance: u64) -> u64 {
        let [batch, index] = self.batches.of(instance);
        batch * self.batches.stride(0, VIEW) + index * VIEW
    }

    /// Batches that the frame's instances use.
    fn used_batches(&self) -> Range<u64> {
        let last = self.instances.checked_sub(1).map(|last| self.batches.of(last)[0]);
        0..last.map_or(0, |last| last + 1)
    }

    /// Surfels of the frame, in all instances.
    pub fn count(&self) -> u64 {
        self.count * self.instances
    }

    /// Culled surfels of the last counted frame, by reason. The frame must have completed.
    pub fn counts(&self) -> Counts {
        self.counts.as_ref().map_or(Counts::zeroed(), |counts| sum(counts_in(counts.bytes()), self.culled))
    }

    /// Surfels of culled groups of the frame, by reason.
    pub fn culled(&self) -> Counts {
        self.culled
    }

    /// Groups of a chunk in a batch.
    fn groups_of(&self, batch: u64, chunk: usize) -> &[Group] {
        self.groups.get(batch as usize * self.chunks.len() + chunk).map_or(&[], |groups| groups)
    }

    /// Updates of the groups.
    pub fn group_updates(&self) -> impl Iterator<Item = Update<'_>> + Clone {
        self.clusters.iter().flat_map(|clusters| clusters.updates(&self.groups))
    }

    /// Memory of splats, counters, order and lists of clusters, bytes.
    pub fn bytes(&self) -> u64 {
        let splats = [&self.splats, &self.moved].into_iter().flatten().map(SplatBuffers::bytes);
        let order = self.order.as_ref().map(SurfelOrder::buffer);
        let others = [self.counts.as_ref(), order].into_iter().flatten().map(Buffer::size);
        splats.chain(others).chain(self.clusters.as_ref().map(VisibleClusters::bytes)).sum()
    }

    /// Reads back the splats of the last frame, one per surfel, instance by instance.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<Vec<Splat>>> {
        let (size, capacity) = (self.count * SPLAT, self.chunks.last().map_or(0, |chunk| chunk.end));
        let of_draws = self.splats.as_ref().map(|buffers| &buffers.splats);
        let of_frame = self.range.as_ref().and_then(|range| range.list.buffer(Resource::Splats));
        let Some(splats) = of_draws.or(of_frame).filter(|_| size > 0) else {
            return Ok(vec![Vec::new(); self.instances as usize]);
        };
        let target = Buffer::readback(device, "read splats", splats.size())?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, splats, &target))?;
        let list: &[Splat] = bytemuck::cast_slice(target.bytes());
        let order = self.order.as_ref().filter(|_| self.range.is_some());
        let order = order.map(|order| order.read(device).map(|words| (order, words))).transpose()?;
        let culled = match (&self.range, &self.clusters) {
            (Some(range), Some(_)) => Some((range, range.list.read_culled(device)?)),
            _ => None,
        };
        let of_instance = |instance: u64| {
            let in_slots = match (&self.splats, &self.range, &culled) {
                (None, Some(_), Some((range, culled))) => self.of_clusters(instance, list, range, culled),
                (buffers, range, _) => {
                    let [batch, index] = self.batches.of(instance);
                    let of_range = |range: &ListRange| range.first_splat(batch, 0) + index * slots(capacity);
                    let start = match (buffers, range) {
                        (Some(buffers), _) => buffers.splats_start(instance, capacity) / SPLAT,
                        (None, range) => range.as_ref().map_or(0, of_range),
                    } as usize;
                    list[start..start + self.count as usize].to_vec()
                }
            };
            match &order {
                Some((order, words)) => order.by_surfel(&in_slots, words),
                None => in_slots,
            }
        };
        Ok((0..self.instances).map(of_instance).collect())
    }

    /// The splats of an instance, surfel by surfel or in the order of surfels, from a list of which these clusters are culled.
    fn of_clusters(&self, instance: u64, list: &[Splat], range: &ListRange, culled: &[bool]) -> Vec<Splat> {
        let mut all = vec![Splat::zeroed(); self.count as usize];
        let [batch, index] = self.batches.of(instance);
        for (chunk, surfels) in self.chunks.iter().enumerate() {
            let first = range.first_splat(batch, chunk);
            let groups =
                self.groups_of(batch, chunk).iter().filter(|group| u64::from(group.instance) == index);
            let clusters = groups.flat_map(|group| {
                (0..group.count)
                    .map(|k| [group.first + k, group.slot + k].map(|index| CLUSTER * u64::from(index)))
            });
            for [surfel, slot] in clusters.map(|[surfel, slot]| [surfels.start + surfel, first + slot]) {
                let own = surfel as usize..(surfel + CLUSTER).min(self.count) as usize;
                if !culled[(slot / CLUSTER) as usize] {
                    all[own.clone()].copy_from_slice(&list[slot as usize..][..own.len()]);
                }
            }
        }
        all
    }

    /// Bytes of the counters; 0 if nothing is counted.
    pub fn counts_size(&self) -> u64 {
        self.counts.as_ref().map_or(0, Buffer::size)
    }
}

/// Batches of so many instances of a scene.
pub fn batches_of(device: &Device, scene: &Scene, instances: u64) -> Batches {
    let triangles = scene.primitives.as_ref().and_then(|kinds| kinds.triangles.as_ref());
    let listed = triangles.map_or(0, |triangles| u64::from(triangles.count));
    let bytes = (slots(scene.capacity()) * LARGEST_STRIDE).max(4 * listed);
    let range = device.capabilities().max_storage_buffer_range.saturating_sub(LIST_HEADER);
    Batches::new(instances, scene.chunks().len(), bytes, range)
}

/// Creates a descriptor set of those bindings that the layout declares.
fn bound_set(
    device: &Arc<Device>,
    declared: &[&'static shaders::Resource],
    mut bindings: Vec<(&'static shaders::Resource, Binding<'_>)>,
) -> Result<DescriptorSet> {
    bindings.retain(|(resource, _)| declared.contains(resource));
    DescriptorSet::new(device, &bindings)
}

pub(super) fn copy_to_host(rec: &mut Recorder<'_>, from: &Buffer, to: &Buffer) {
    use crate::vk::Access;
    let uses = [from.with(Access::COPY_READ), to.with(Access::COPY_WRITE)];
    rec.pass("read splats", &uses).copy(from, to, 0, to.size());
    rec.wait(&[to.with(Access::HOST_READ)]);
}

/// Sum of both.
pub fn sum(a: Counts, b: Counts) -> Counts {
    Counts {
        culled: std::array::from_fn(|i| a.culled[i].saturating_add(b.culled[i])),
        in_clusters: a.in_clusters.saturating_add(b.in_clusters),
    }
}

/// Sums the counters of all chunks.
pub fn counts_in(bytes: &[u8]) -> Counts {
    let chunks = bytes.chunks_exact(ALIGNMENT as usize);
    let counts = chunks.map(|chunk| bytemuck::pod_read_unaligned::<Counts>(&chunk[..size_of::<Counts>()]));
    counts.fold(Counts::zeroed(), sum)
}
