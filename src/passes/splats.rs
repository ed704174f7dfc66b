//! The splats between the footprint pass, which writes them, and the passes that rasterize them.

use super::coverage::whole;
use super::normalize::frame_layout;
use super::points::drawn_layout;
use super::primitives::{PrimitiveSets, primitive_layout};
use super::pyramid::{lookups_layout, plain_layout, pyramid_layout};
use super::scatter::pixel_layout;
use crate::error::Result;
use crate::scene::{ClipWindow, Scene};
use crate::variant::Rasterizer;
use crate::vk::shaders::layout::{Counts, LargeSplats, ScreenClip, Splat};
use crate::vk::{
    Access, Binding, Buffer, Commands, DescriptorSet, Device, DrawPipeline, Draws, Encoder, Framebuffer,
    Recorder, SetLayout, Use,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::ops::Range;
use std::sync::Arc;

/// Layouts of descriptor sets 0 and 1 of the footprint, visibility and attribute passes, and of those of pull–push.
pub struct SplatLayout {
    pub(super) splats: SetLayout,
    /// The frame's numbers alone.
    pub(super) frame: SetLayout,
    pub(super) pixels: SetLayout,
    /// One buffer: a word or more a pixel.
    pub(super) plain: SetLayout,
    /// What is looked up: a texture, materials.
    pub(super) lookups: SetLayout,
    /// The planes of a pyramid.
    pub(super) pyramid: SetLayout,
    pub(super) primitives: SetLayout,
    pub(super) drawn_points: SetLayout,
}

/// A splat a surfel, with descriptor sets over windows of surfels and splats.
pub struct Splats {
    splats: Buffer,
    /// [`Counts`] of each window, at multiples of [`COUNTS_STEP`].
    counts: Buffer,
    /// Indices of splats of many pixels, a list a window; only for the compute rasterizer.
    large: Option<Buffer>,
    /// A [`ScreenClip`] a clip, those of a window at a multiple of [`COUNTS_STEP`]; only of a scene that has clips.
    screen_clips: Option<Buffer>,
    windows: Vec<Window>,
    primitives: Option<PrimitiveSets>,
    lookups: Option<DescriptorSet>,
}

/// As many splats as one descriptor can name.
pub(super) struct Window {
    pub(super) set: DescriptorSet,
    /// Surfels of this frame.
    pub(super) count: u32,
    /// Surfels that there is room for.
    capacity: u32,
    /// Where its first surfel is in the scene.
    start: u32,
    /// The number of that in the frame.
    first: u32,
    /// Where its list of large splats starts, bytes.
    list: u64,
}

/// From one window's counts to the next, bytes; no device aligns to more.
const COUNTS_STEP: u64 = 256;
/// Bytes of the push constants of `lib/window.glsl`.
pub(super) const WINDOW: u32 = 8;
/// Bytes before the indices of a list of large splats.
const LIST_HEADER: u64 = size_of::<LargeSplats>() as u64;

impl SplatLayout {
    /// Bindings as in `lib/frame.glsl`, `lib/splat.glsl`, `footprint.glsl`, `attribute.glsl`, `lib/scatter_splat.glsl` and
    /// `lib/weights.glsl`.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let (compute, vertex) = (ShaderStageFlags::COMPUTE, ShaderStageFlags::VERTEX);
        let storage = |stages| (DescriptorType::STORAGE_BUFFER, stages);
        let frame = (DescriptorType::UNIFORM_BUFFER, compute | ShaderStageFlags::ALL_GRAPHICS);
        let bindings = [
            frame,
            storage(compute | vertex),                              // splats
            storage(compute | vertex),                              // positions
            storage(compute | vertex),                              // normals
            storage(compute | vertex),                              // radii
            storage(compute | vertex),                              // colours
            storage(compute),                                       // counts
            storage(compute),                                       // large splats
            storage(compute | vertex),                              // ellipses
            storage(compute | vertex | ShaderStageFlags::FRAGMENT), // clips
            storage(compute | ShaderStageFlags::FRAGMENT),          // screen clips
            storage(compute | vertex),                              // weights
        ];
        Ok(Self {
            splats: SetLayout::new(device, &bindings)?,
            frame: frame_layout(device)?,
            pixels: pixel_layout(device)?,
            plain: plain_layout(device)?,
            lookups: lookups_layout(device)?,
            pyramid: pyramid_layout(device)?,
            primitives: primitive_layout(device)?,
            drawn_points: drawn_layout(device)?,
        })
    }
}

impl Window {
    /// The push constants of `lib/window.glsl`.
    pub(super) fn push(&self) -> [u32; 2] {
        [self.count, self.first]
    }
}

impl Splats {
    /// Room for the splats of `scene`, if any are made of its surfels. `frame` and `scene` must outlive it.
    pub fn new(
        device: &Arc<Device>,
        layout: &SplatLayout,
        frame: &Buffer,
        scene: &Scene,
        rasterizer: Option<Rasterizer>,
    ) -> Result<Self> {
        let stride = size_of::<Splat>() as u64;
        let room = if rasterizer.is_some() { scene.capacity() * stride } else { 0 }.max(COUNTS_STEP);
        let splats = Buffer::storage(device, "splats", room)?;
        let counts = Buffer::readback(device, "counts", (scene.windows().len() as u64).max(1) * COUNTS_STEP)?;
        let lists = scene.windows().len() as u64 * LIST_HEADER + 4 * scene.capacity();
        let large = match rasterizer {
            None | Some(Rasterizer::Draw) => None,
            Some(Rasterizer::Compute) => Some(Buffer::storage(device, "large splats", lists)?),
        };
        let clip_bytes = |clips: &ClipWindow| (clips.count * size_of::<ScreenClip>() as u64).max(COUNTS_STEP);
        let clip_starts: Vec<u64> = scene
            .clip_windows()
            .unwrap_or_default()
            .iter()
            .scan(0, |end, clips| {
                let start = *end;
                *end = (start + clip_bytes(clips)).next_multiple_of(COUNTS_STEP);
                Some(start)
            })
            .collect();
        let last = scene.clip_windows().and_then(|windows| windows.last()).zip(clip_starts.last());
        let screen_clips = last
            .map(|(clips, start)| Buffer::storage(device, "screen clips", start + clip_bytes(clips)))
            .transpose()?;
        let window = |(number, range): (u64, &Range<u64>)| {
            let count = range.end - range.start;
            let list = number * LIST_HEADER + 4 * range.start;
            let [positions, normals, radii, colours, ellipses, clips, weights] =
                scene.bindings(number as usize);
            // Where none are made, something must stand at their binding all the same.
            let of_splats = || match rasterizer {
                Some(_) => Binding::Storage(&splats, range.start * stride, count * stride),
                None => Binding::Storage(&splats, 0, COUNTS_STEP),
            };
            let tally = Binding::Storage(&counts, number * COUNTS_STEP, COUNTS_STEP);
            // Without the compute rasterizer nothing is listed, and the counts stand in.
            let large =
                large.as_ref().map_or(tally, |large| Binding::Storage(large, list, LIST_HEADER + 4 * count));
            let frame = Binding::Uniform(frame);
            let on_screen = match (&screen_clips, scene.clip_windows()) {
                (Some(buffer), Some(windows)) => {
                    let number = number as usize;
                    Binding::Storage(buffer, clip_starts[number], clip_bytes(&windows[number]))
                }
                // Not touched, but what stands there is waited for as if it were.
                _ => of_splats(),
            };
            let bindings = [
                frame,
                of_splats(),
                positions,
                normals,
                radii,
                colours,
                tally,
                large,
                ellipses,
                clips,
                on_screen,
                weights,
            ];
            let set = DescriptorSet::new(device, &layout.splats, &bindings)?;
            let count = count as u32;
            let start = range.start as u32;
            Ok(Window { set, count, capacity: count, start, first: start, list })
        };
        let windows = (0..).zip(scene.windows()).map(window).collect::<Result<_>>()?;
        let primitives = scene
            .primitives
            .as_ref()
            .map(|streams| PrimitiveSets::new(device, layout, frame, streams))
            .transpose()?;
        let texture = scene.texture.as_ref().map(|texture| &texture.buffer);
        let materials = scene.materials.as_ref().map(|materials| &materials.buffer);
        // Where there is but one of them, it stands at the other's binding, too.
        let lookups = texture.or(materials).zip(materials.or(texture));
        let lookups = lookups.map(|(texture, materials)| {
            DescriptorSet::new(device, &layout.lookups, &[texture, materials].map(whole))
        });
        let lookups = lookups.transpose()?;
        Ok(Self { splats, counts, large, screen_clips, windows, primitives, lookups })
    }

    /// The scene's texture and materials, if it has any.
    pub(super) fn lookups(&self) -> Option<&DescriptorSet> {
        self.lookups.as_ref()
    }

    pub(super) fn primitives(&self) -> Option<&PrimitiveSets> {
        self.primitives.as_ref()
    }

    /// Frames from now on are of the first `count` surfels.
    pub(crate) fn set_count(&mut self, count: u64) {
        for window in &mut self.windows {
            let here = count.saturating_sub(window.start.into()).min(window.capacity.into());
            window.count = here as u32;
        }
    }

    /// The scene's points have numbers from `first` on in frames from now on.
    pub(crate) fn set_first(&mut self, first: u32) {
        for window in &mut self.windows {
            window.first = first + window.start;
        }
        if let Some(primitives) = &mut self.primitives {
            primitives.set_first(first);
        }
    }

    /// Surfels of this frame.
    pub(crate) fn count(&self) -> u64 {
        self.windows.iter().map(|window| u64::from(window.count)).sum()
    }

    pub(super) fn windows(&self) -> &[Window] {
        &self.windows
    }

    pub(super) fn with(&self, access: Access) -> Use {
        self.splats.with(access)
    }

    /// The counts, as what counts touches them.
    pub(super) fn counted(&self) -> Use {
        self.counts.with(Access::COMPUTE_WRITE)
    }

    /// What is touched when the splats are made: themselves, the counts where `count`, the lists where there are any.
    pub(super) fn made(&self, count: bool) -> Vec<Use> {
        let write = Access::COMPUTE_WRITE;
        let counts = count.then(|| self.counted());
        let optional =
            [&self.large, &self.screen_clips].map(|made| made.as_ref().map(|made| made.with(write)));
        [Some(self.with(write)), counts].into_iter().chain(optional).flatten().collect()
    }

    /// What the compute rasterizer reads.
    pub(super) fn read_by_scatter(&self) -> Vec<Use> {
        let read = Access::COMPUTE_READ;
        let optional =
            [&self.large, &self.screen_clips].map(|made| made.as_ref().map(|made| made.with(read)));
        [Some(self.with(read))].into_iter().chain(optional).flatten().collect()
    }

    /// What drawing reads.
    pub(crate) fn read_by_draws(&self) -> Vec<Use> {
        let clips = self.screen_clips.as_ref().unwrap_or(&self.splats);
        vec![self.with(Access::VERTEX_READ), clips.with(Access::FRAGMENT_READ)]
    }

    /// Draws the triangle of every splat of each scene, by its pipeline, into `framebuffer`, with `more` at the descriptor sets from 1 on.
    pub(super) fn draw(
        enc: &mut Encoder<'_>,
        scenes: &[(&DrawPipeline, &Self)],
        framebuffer: &Framebuffer,
        more: &[&DescriptorSet],
    ) {
        enc.render(framebuffer, |draws| {
            scenes.iter().for_each(|(pipeline, splats)| splats.draw_in(draws, pipeline, more));
        });
    }

    /// The same within a render pass that has begun.
    pub(super) fn draw_in(&self, draws: &mut Draws<'_>, pipeline: &DrawPipeline, more: &[&DescriptorSet]) {
        for window in &self.windows {
            let sets: Vec<_> = std::iter::once(&window.set).chain(more.iter().copied()).collect();
            draws.draw(pipeline, &sets, &window.push(), 3 * window.count);
        }
    }

    /// Empties the lists of each, and the counts of those that are counted.
    pub(super) fn record_clear<'a>(
        rec: &mut Recorder<'_>,
        scenes: impl Iterator<Item = (&'a Self, bool)> + Clone,
    ) {
        let cleared = |(splats, counted): (&'a Self, bool)| {
            [counted.then_some(&splats.counts), splats.large.as_ref()].into_iter().flatten()
        };
        let cleared = scenes.clone().flat_map(cleared);
        let uses: Vec<_> = cleared.map(|buffer| buffer.with(Access::COPY_WRITE)).collect();
        if uses.is_empty() {
            return;
        }
        rec.pass("clear", &uses, |enc| scenes.for_each(|(splats, counted)| splats.clear(enc, counted)));
    }

    fn clear(&self, enc: &mut Encoder<'_>, counted: bool) {
        if counted {
            enc.zero(&self.counts);
        }
        if let Some(large) = &self.large {
            self.windows.iter().for_each(|window| enc.zero_range(large, window.list, 4));
        }
    }

    /// Leaves the counts ready for the CPU.
    pub(super) fn record_counted<'a>(rec: &mut Recorder<'_>, scenes: impl Iterator<Item = &'a Self>) {
        let uses: Vec<_> = scenes.map(|splats| splats.counts.with(Access::HOST_READ)).collect();
        rec.wait(&uses);
    }

    /// Bytes of the counts.
    pub(crate) fn counts_size(&self) -> u64 {
        self.counts.size()
    }

    /// Copies the counts of all of these to `to`, one after the other, which has room for the [sizes](Splats::counts_size) of all: the next
    /// frame empties them.
    pub(crate) fn record_counts(list: &[&Self], rec: &mut Recorder<'_>, to: &Buffer) {
        let from = list.iter().map(|splats| splats.counts.with(Access::COPY_READ));
        let uses: Vec<_> = from.chain([to.with(Access::COPY_WRITE)]).collect();
        rec.pass("read back", &uses, |enc| {
            let mut at = 0;
            for Self { counts, .. } in list {
                enc.copy(counts, to, at, counts.size());
                at += counts.size();
            }
        });
        rec.wait(&[to.with(Access::HOST_READ)]);
    }

    /// Culled surfels of the last counted frame, by reason; it must be over.
    pub fn counts(&self) -> Counts {
        Self::counts_in(self.counts.bytes())
    }

    /// The same of counts that were copied.
    pub(crate) fn counts_in(bytes: &[u8]) -> Counts {
        let windows = bytes.chunks_exact(COUNTS_STEP as usize);
        let culled = windows
            .map(|window| bytemuck::pod_read_unaligned::<Counts>(&window[..size_of::<Counts>()]).culled);
        let add = |sum: [u32; 5], counts: [u32; 5]| std::array::from_fn(|i| sum[i] + counts[i]);
        Counts { culled: culled.fold([0; 5], add) }
    }

    /// Memory of the splats and what belongs to them, bytes.
    pub fn bytes(&self) -> u64 {
        let optional = [&self.large, &self.screen_clips].map(|made| made.as_ref().map_or(0, Buffer::size));
        self.splats.size() + self.counts.size() + optional.iter().sum::<u64>()
    }

    /// Copies the splats of the last frame, one a surfel, to the CPU.
    pub fn read(&self, device: &Arc<Device>) -> Result<Vec<Splat>> {
        let size = (self.count() * size_of::<Splat>() as u64).min(self.splats.size());
        if size == 0 {
            return Ok(Vec::new());
        }
        let target = Buffer::readback(device, "read splats", size)?;
        Commands::new(device, false)?.run(|rec| {
            let uses = [self.splats.with(Access::COPY_READ), target.with(Access::COPY_WRITE)];
            rec.pass("read splats", &uses, |enc| enc.copy(&self.splats, &target, 0, size));
            rec.wait(&[target.with(Access::HOST_READ)]);
        })?;
        Ok(bytemuck::pod_collect_to_vec(target.bytes()))
    }
}
