//! What frames make of a scene, for every place in which it stands: splats, lists and counts, and descriptor sets of all that its passes see.

use super::pass::{Pass, Scope};
use super::passes::{footprint, visibility};
use super::resource::Resource;
use super::variant::SceneVariant;
use crate::error::Result;
use crate::scene::{Elements, Scene};
use crate::settings::Rasterizer;
use crate::vk::shaders::{self, layout, resource};
use crate::vk::{Binding, Buffer, Commands, DescriptorSet, Device, Encoder, Recorder};
use layout::{Counts, LargeSplats, ScreenClip, Splat};
use std::ops::Range;
use std::sync::Arc;

/// Places in buffers start at multiples of this, bytes; no device aligns to more.
const ALIGNMENT: u64 = 256;
/// Bytes of a splat.
const SPLAT: u64 = size_of::<Splat>() as u64;
/// Bytes before the indices of a list of large splats.
const LIST_HEADER: u64 = size_of::<LargeSplats>() as u64;
/// Bytes from one place's numbers to the next's.
pub const FRAME_STRIDE: u64 = (size_of::<layout::Frame>() as u64).next_multiple_of(ALIGNMENT);

/// What frames make of a scene.
pub struct SceneResources {
    // Sets go before what they name.
    sets: Sets,
    /// Of the counts of each part of each place, where they are counted: descriptor set 2 of what counts.
    count_sets: Vec<DescriptorSet>,
    splats: Option<SplatBuffers>,
    /// Those of discs moved away by ε, where they are wanted beside.
    moved: Option<SplatBuffers>,
    /// Culled surfels by reason, of each part of each place.
    counts: Option<Buffer>,
    /// Numbers of triangles of many pixels, after how many there are, of each place.
    large_triangles: Option<Buffer>,
    /// The numbers of each place, where it is not the view's that the scene is seen by.
    pub frames: Option<Buffer>,
    parts: Vec<Range<u64>>,
    /// Lines and triangles: how many, and the number of the first.
    elements: [Option<[u32; 2]>; 2],
    needs: Needs,
    /// Surfels of the present frame.
    count: u64,
    /// The numbers of the first points of the places of the present frame.
    firsts: Vec<u32>,
}

/// What a frame needs of a scene beside its variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// What splats are made for; `None` makes none.
    pub rasterizer: Option<Rasterizer>,
    /// Splats of moved discs are kept beside the others.
    pub moved: bool,
    /// Each place has numbers of its own.
    pub own_frames: bool,
    /// Places in which it stands.
    pub places: u64,
}

/// Splats of all places of a scene, and what is made with them.
struct SplatBuffers {
    splats: Buffer,
    /// Indices of splats of many pixels, a list a part; only for the compute rasterizer.
    large: Option<Buffer>,
    /// A [`ScreenClip`] a clip; only of a scene that has clips.
    screen_clips: Option<Buffer>,
}

/// Descriptor sets 0 of a scene's passes.
#[derive(Default)]
struct Sets {
    /// Place by place, part by part.
    surfels: Vec<DescriptorSet>,
    /// The same of moved discs.
    moved: Vec<DescriptorSet>,
    /// Of lines and of triangles, place by place.
    elements: [Vec<DescriptorSet>; 2],
}

/// A scene where it stands.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    /// The scene.
    pub scene: &'a SceneResources,
    /// Which of its places in the frame it is.
    pub number: usize,
}

/// As many surfels as one descriptor set names.
pub struct SurfelPart<'a> {
    pub set: &'a DescriptorSet,
    /// Of its counts, if they are there.
    pub counts: Option<&'a DescriptorSet>,
    /// How many.
    pub count: u32,
    /// The number of the first in the frame.
    pub first: u32,
}

/// Lines or triangles of a scene.
pub struct ElementPart<'a> {
    pub set: &'a DescriptorSet,
    /// How many.
    pub count: u32,
    /// The number of the first in the frame.
    pub first: u32,
}

impl SplatBuffers {
    fn new(device: &Arc<Device>, scene: &Scene, rasterizer: Rasterizer, places: u64) -> Result<Self> {
        let buffer = |name, bytes: u64| Buffer::storage(device, name, (places * bytes).max(ALIGNMENT));
        let clips =
            scene.clip_windows().map(|_| screen_clip_starts(scene)).and_then(|starts| starts.last().copied());
        Ok(Self {
            splats: buffer("splats", splat_stride(scene))?,
            large: (rasterizer == Rasterizer::Compute)
                .then(|| buffer("large splats", list_stride(scene)))
                .transpose()?,
            screen_clips: clips.map(|bytes| buffer("screen clips", bytes)).transpose()?,
        })
    }

    fn bytes(&self) -> u64 {
        let optional = [&self.large, &self.screen_clips].map(|made| made.as_ref().map_or(0, Buffer::size));
        self.splats.size() + optional.iter().sum::<u64>()
    }

    /// Splats, list and screen clips of a part of a place.
    fn bindings(
        &self,
        scene: &Scene,
        place: u64,
        number: usize,
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let part = &scene.windows()[number];
        let count = part.end - part.start;
        let first = place * splat_stride(scene) + part.start * SPLAT;
        let mut list = vec![(&resource::SPLATS, Binding::Storage(&self.splats, first, count * SPLAT))];
        if let Some(large) = &self.large {
            let start = list_start(scene, place, number);
            list.push((&resource::LARGE_SPLATS, Binding::Storage(large, start, LIST_HEADER + 4 * count)));
        }
        if let Some(clips) = &self.screen_clips {
            let starts = screen_clip_starts(scene);
            let start = place * starts.last().copied().unwrap_or_default() + starts[number];
            let bytes = starts[number + 1] - starts[number];
            list.push((&resource::SCREEN_CLIPS, Binding::Storage(clips, start, bytes)));
        }
        list
    }
}

/// Bytes of a place's splats.
fn splat_stride(scene: &Scene) -> u64 {
    (scene.capacity() * SPLAT).next_multiple_of(ALIGNMENT)
}

/// Bytes of a place's lists of large splats.
fn list_stride(scene: &Scene) -> u64 {
    (scene.windows().len() as u64 * LIST_HEADER + 4 * scene.capacity()).next_multiple_of(ALIGNMENT)
}

/// Where the list of a part of a place starts, bytes.
fn list_start(scene: &Scene, place: u64, part: usize) -> u64 {
    place * list_stride(scene) + part as u64 * LIST_HEADER + 4 * scene.windows()[part].start
}

/// Where the screen clips of each part of a place start, and where the last ends, bytes.
fn screen_clip_starts(scene: &Scene) -> Vec<u64> {
    let bytes = |clips: u64| (clips * size_of::<ScreenClip>() as u64).max(1).next_multiple_of(ALIGNMENT);
    let mut starts = vec![0];
    for clips in scene.clip_windows().unwrap_or_default() {
        starts.push(starts[starts.len() - 1] + bytes(clips.count));
    }
    starts
}

impl Needs {
    /// Whether what was made for these does for `others`, too.
    pub fn cover(&self, others: &Self) -> bool {
        let same = |needs: &Self| (needs.rasterizer, needs.moved, needs.own_frames);
        let enough = others.places..=4 * others.places;
        same(self) == same(others) && enough.contains(&self.places)
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
    ) -> Result<Self> {
        let splats = |wanted: bool| {
            let rasterizer = needs.rasterizer.filter(|_| wanted);
            rasterizer
                .map(|rasterizer| SplatBuffers::new(device, scene, rasterizer, needs.places))
                .transpose()
        };
        let kinds = scene.primitives.as_ref();
        let of = |elements: &Elements| [elements.count, elements.first];
        let triangles = kinds.and_then(|kinds| kinds.triangles.as_ref()).map(of);
        let list = |[count, _]: [u32; 2]| {
            Buffer::storage(device, "large triangles", needs.places * triangle_stride(count))
        };
        let frames = || Buffer::uniform(device, "frames of a scene", needs.places * FRAME_STRIDE);
        let mut made = Self {
            sets: Sets::default(),
            count_sets: Vec::new(),
            splats: splats(true)?,
            moved: splats(needs.moved)?,
            counts: None,
            large_triangles: triangles.map(list).transpose()?,
            frames: needs.own_frames.then(frames).transpose()?,
            parts: scene.windows().to_vec(),
            elements: [kinds.and_then(|kinds| kinds.lines.as_ref()).map(of), triangles],
            needs,
            count: 0,
            firsts: Vec::new(),
        };
        made.sets = made.make_sets(device, scene, variant, view)?;
        Ok(made)
    }

    /// What it was made for.
    pub fn needs(&self) -> &Needs {
        &self.needs
    }

    /// Frames from now on are of the first `count` surfels, in places whose first points have these numbers.
    pub fn show(&mut self, count: u64, firsts: Vec<u32>) {
        (self.count, self.firsts) = (count, firsts);
    }

    /// Frames from now on may count: makes what they count in, if it is not there.
    pub fn make_counts(&mut self, device: &Arc<Device>) -> Result<()> {
        if self.counts.is_some() {
            return Ok(());
        }
        let parts = self.needs.places * self.parts.len() as u64;
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
        let frame = |place: u64| {
            let size = size_of::<layout::Frame>() as u64;
            let numbers = self.frames.as_ref().map(|frames| (frames, place * FRAME_STRIDE));
            let (buffer, start) = numbers.unwrap_or((view, 0));
            (&resource::FRAME, Binding::Uniform(buffer, start, size))
        };
        let of_surfels = variant.resources(Scope::Surfels);
        let surfels = |buffers: Option<&SplatBuffers>, place: u64, number: usize| {
            let mut there = scene.bindings(number);
            there.push(frame(place));
            there.extend(buffers.into_iter().flat_map(|splats| splats.bindings(scene, place, number)));
            wanted_set(device, &of_surfels, there)
        };
        let every = |buffers: Option<&SplatBuffers>| {
            let places = 0..self.needs.places;
            let parts = places.flat_map(|place| (0..self.parts.len()).map(move |part| (place, part)));
            parts.map(|(place, part)| surfels(buffers, place, part)).collect::<Result<Vec<_>>>()
        };
        let elements = |kind: usize| {
            let wanted = variant.resources([Scope::Lines, Scope::Triangles][kind]);
            let set = |place: u64| {
                let mut there = scene.element_bindings(kind);
                there.push(frame(place));
                let large = self.large_triangles.as_ref().zip(self.elements[1]).map(|(list, [count, _])| {
                    let bytes = 4 * (1 + u64::from(count));
                    let binding = Binding::Storage(list, place * triangle_stride(count), bytes);
                    (&resource::LARGE_TRIANGLES, binding)
                });
                there.extend(large);
                wanted_set(device, &wanted, there)
            };
            let places = if self.elements[kind].is_some() { self.needs.places } else { 0 };
            (0..places).map(set).collect::<Result<Vec<_>>>()
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
            Resource::LargeSplats => splats.large.as_ref(),
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

    /// Empties a list, or counts, of the present places.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, resource: Resource) {
        for buffer in self.buffers(resource) {
            match resource {
                Resource::LargeSplats => {
                    self.list_starts().for_each(|start| enc.zero_range(buffer, start, 4))
                }
                Resource::LargeTriangles => {
                    let count = self.elements[1].map_or(0, |[count, _]| count);
                    let starts = (0..self.firsts.len() as u64).map(|place| place * triangle_stride(count));
                    starts.for_each(|start| enc.zero_range(buffer, start, 4));
                }
                _ => enc.zero(buffer),
            }
        }
    }

    /// Where the lists of large splats of the present places start, bytes.
    fn list_starts(&self) -> impl Iterator<Item = u64> {
        let capacity = self.parts.last().map_or(0, |part| part.end);
        let stride = (self.parts.len() as u64 * LIST_HEADER + 4 * capacity).next_multiple_of(ALIGNMENT);
        (0..self.firsts.len() as u64).flat_map(move |place| {
            let starts = self.parts.iter().zip(0u64..);
            starts.map(move |(part, number)| place * stride + number * LIST_HEADER + 4 * part.start)
        })
    }

    /// Surfels of the present frame, in all places.
    pub fn count(&self) -> u64 {
        self.count * self.firsts.len() as u64
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

    /// Copies the splats of the last frame, one a surfel, to the CPU, place by place.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<Vec<Splat>>> {
        let (size, capacity) = (self.count * SPLAT, self.parts.last().map_or(0, |part| part.end));
        let Some(SplatBuffers { splats, .. }) = self.splats.as_ref().filter(|_| size > 0) else {
            return Ok(vec![Vec::new(); self.firsts.len()]);
        };
        let stride = (capacity * SPLAT).next_multiple_of(ALIGNMENT);
        let target = Buffer::readback(device, "read splats", self.firsts.len() as u64 * stride)?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, splats, &target))?;
        let places = target.bytes().chunks(stride as usize);
        Ok(places.map(|bytes| bytemuck::pod_collect_to_vec(&bytes[..size as usize])).collect())
    }

    /// Bytes of the counts; 0 where nothing is counted.
    pub fn counts_size(&self) -> u64 {
        self.counts.as_ref().map_or(0, Buffer::size)
    }
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

/// Bytes of a place's list of large triangles.
fn triangle_stride(triangles: u32) -> u64 {
    (4 * (1 + u64::from(triangles))).next_multiple_of(ALIGNMENT)
}

/// Culled surfels by reason, of the counts of all parts.
pub fn counts_in(bytes: &[u8]) -> Counts {
    let parts = bytes.chunks_exact(ALIGNMENT as usize);
    let culled =
        parts.map(|part| bytemuck::pod_read_unaligned::<Counts>(&part[..size_of::<Counts>()]).culled);
    let add = |sum: [u32; 5], counts: [u32; 5]| std::array::from_fn(|i| sum[i].saturating_add(counts[i]));
    Counts { culled: culled.fold([0; 5], add) }
}

impl<'a> Place<'a> {
    /// The surfels that a pass sees, part by part.
    pub fn surfels(&self, pass: &Pass) -> impl Iterator<Item = SurfelPart<'a>> {
        let Self { scene, number } = *self;
        let moved = [&raw const footprint::MOVED, &raw const visibility::DRAWN].contains(&&raw const *pass);
        let sets = if moved && scene.moved.is_some() { &scene.sets.moved } else { &scene.sets.surfels };
        let parts = scene.parts.len();
        let own = parts * number..parts * (number + 1);
        let counts = scene.count_sets.get(own.clone()).unwrap_or_default();
        let counts = counts.iter().map(Some).chain(std::iter::repeat(None));
        let first = scene.firsts[number];
        sets[own].iter().zip(&scene.parts).zip(counts).map(move |((set, part), counts)| {
            let count = scene.count.saturating_sub(part.start).min(part.end - part.start);
            SurfelPart { set, counts, count: count as u32, first: first + part.start as u32 }
        })
    }

    /// Lines or triangles of the scene, if there are any.
    pub fn elements(&self, scope: Scope) -> Option<ElementPart<'a>> {
        let kind = match scope {
            Scope::Lines => 0,
            Scope::Triangles => 1,
            Scope::View | Scope::Surfels => return None,
        };
        let [count, start] = self.scene.elements[kind]?;
        let set = self.scene.sets.elements[kind].get(self.number)?;
        Some(ElementPart { set, count, first: self.scene.firsts[self.number] + start })
    }
}
