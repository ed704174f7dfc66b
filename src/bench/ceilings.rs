//! Rates that bound the passes of a device: copy bandwidth, atomics, fill rate.

use super::record::{Ceilings, Rate};
use crate::error::Result;
use crate::frame::times::Interval;
use crate::vk::shaders::{self, Module, layout, resource};
use crate::vk::{
    Access, Attachment, Binding, Blend, Buffer, Commands, ComputePipeline, Constants, DepthTest,
    DescriptorSet, Device, DrawPipeline, DrawState, Framebuffer, Image, ImageUse, Recorder, RenderPass,
    SetLayout, Topology, Use, pixel_bytes,
};
use ash::vk::{Format, ShaderStageFlags};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Sizes of the measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Bytes of each of the two buffers of a copy.
    pub copy: u64,
    /// Words of the buffer of atomics, a power of two.
    pub words: u32,
    /// Width and height of the target that is filled, px.
    pub side: u32,
}

/// Repetitions: fewer give no 95 % interval of the median.
const REPETITIONS: usize = 9;
/// Least time of a repetition, which consists of as many passes as that takes.
const LEAST: Duration = Duration::from_millis(4);
/// Most passes of a repetition: fewer than a frame has timestamps for.
const MOST_PASSES: u32 = 32;
/// Workgroups of a dispatch of atomics, of [`WORKGROUP`] invocations.
const WORKGROUPS: [u32; 3] = [1024, 64, 1];
const WORKGROUP: u64 = 64;
/// Format of the filled target: that of pictures and of sums.
const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

impl Sizes {
    /// Sizes beyond the caches of most devices that take at most a quarter of the memory.
    pub fn of(device: &Device) -> Self {
        let capabilities = device.capabilities();
        Self {
            copy: (256 << 20).min(capabilities.memory / 16).next_multiple_of(4),
            // A word per pixel of 2048 × 2048, of 8 bytes at most.
            words: 1 << (capabilities.max_storage_buffer_range / 8).clamp(1, 1 << 22).ilog2(),
            side: capabilities.max_image_side.min(2048),
        }
    }
}

/// Measures the rates of a device, within a few seconds.
///
/// # Errors
/// [`Error::Memory`](crate::Error::Memory) if the buffers do not fit, and errors of the device.
pub fn measure(device: &Arc<Device>, sizes: &Sizes) -> Result<Ceilings> {
    let mut watch = Watch { commands: Commands::new(device, true)?, device };
    let wide = device.capabilities().int64_atomics;
    Ok(Ceilings {
        timestamps: device.capabilities().timestamps.is_some(),
        copy: copy(&mut watch, sizes.copy)?,
        atomics: atomics(&mut watch, sizes.words, false)?,
        wide_atomics: wide.then(|| atomics(&mut watch, sizes.words, true)).transpose()?,
        fill: fill(&mut watch, sizes.side)?,
    })
}

/// Records commands, and times them.
struct Watch<'a> {
    commands: Commands,
    device: &'a Arc<Device>,
}

impl Watch<'_> {
    /// The rate of passes of so many operations each.
    fn rate(&mut self, (operations, memory): (u64, u64), pass: impl Fn(&mut Recorder<'_>)) -> Result<Rate> {
        let mut passes = 1;
        // The first frames warm up: they create what the driver creates late, and raise clocks.
        while self.seconds(passes, &pass)? < LEAST.as_secs_f64() && passes < MOST_PASSES {
            passes *= 2;
        }
        self.seconds(passes, &pass)?;
        let operations = operations * u64::from(passes);
        let rates = (0..REPETITIONS).map(|_| Ok(operations as f64 / self.seconds(passes, &pass)?));
        let rates = rates.collect::<Result<Vec<_>>>()?;
        Ok(Rate { operations, memory, per_second: Interval::of(&rates).unwrap_or_default() })
    }

    /// Time of so many passes: by timestamps, or by the clock of the caller without them.
    fn seconds(&mut self, passes: u32, pass: &impl Fn(&mut Recorder<'_>)) -> Result<f64> {
        let start = Instant::now();
        self.commands.run(|rec| (0..passes).for_each(|_| pass(rec)))?;
        let wall = start.elapsed().as_secs_f64();
        let times = self.commands.pass_times()?;
        Ok(if times.is_empty() { wall } else { times.iter().map(|time| 1e-3 * time.milliseconds).sum() })
    }

    /// A buffer of bits that are set: memory that was never written may not exist.
    fn buffer(&mut self, name: &str, bytes: u64) -> Result<Buffer> {
        let buffer = Buffer::storage(self.device, name, bytes)?;
        self.commands.run(|rec| rec.pass("set", &[buffer.with(Access::COPY_WRITE)]).ones(&buffer))?;
        Ok(buffer)
    }
}

/// Bytes read and written by copies of a buffer.
fn copy(watch: &mut Watch<'_>, bytes: u64) -> Result<Rate> {
    let (from, to) = (watch.buffer("copy source", bytes)?, watch.buffer("copy target", bytes)?);
    watch.rate((2 * bytes, 2 * bytes), |rec| {
        let uses = [from.with(Access::COPY_READ), to.with(Access::COPY_WRITE)];
        rec.pass("copy", &uses).copy(&from, &to, 0, bytes);
    })
}

/// Atomic minima of words of 32 or 64 bits.
fn atomics(watch: &mut Watch<'_>, words: u32, wide: bool) -> Result<Rate> {
    let (module, words_of, size): (&'static Module, _, u64) = match wide {
        true => (&shaders::ATOMICS_WIDE_COMPUTE, &resource::WIDE_WORDS, 8),
        false => (&shaders::ATOMICS_COMPUTE, &resource::WORDS, 4),
    };
    let buffer = watch.buffer("words", size * u64::from(words))?;
    let set = DescriptorSet::new(watch.device, &[(words_of, Binding::whole(&buffer))])?;
    let layout = SetLayout::of(watch.device, [words_of])?;
    let pipeline = ComputePipeline::new(watch.device, &[&layout], module, &Constants::default(), false)?;
    let options = layout::AtomicOptions { mask: words - 1, seed: 1 };
    let invocations = WORKGROUP * WORKGROUPS.into_iter().map(u64::from).product::<u64>();
    watch.rate((invocations, buffer.size()), |rec| {
        let access = Access::of_shader(ShaderStageFlags::COMPUTE, true);
        rec.pass("atomics", &[buffer.with(access)]).dispatch(&pipeline, &[&set], &options, WORKGROUPS);
    })
}

/// Pixels written by triangles over a whole target.
fn fill(watch: &mut Watch<'_>, side: u32) -> Result<Rate> {
    let target = Image::target(watch.device, "filled", FORMAT, [side; 2], ImageUse::Sampled)?;
    let pass = RenderPass::new(watch.device, &[Attachment::Overwritten(FORMAT)], None)?;
    let framebuffer = Framebuffer::new(watch.device, &pass, &[&target])?;
    let state = DrawState { topology: Topology::Triangles, depth: DepthTest::None, blend: Blend::Replace };
    let modules = [&shaders::FILL_VERTEX, &shaders::FILL_FRAGMENT];
    let pipeline = DrawPipeline::new(watch.device, &[], modules, &Constants::default(), &pass, state)?;
    let options = layout::FillOptions { scale: [0.37, 0.61, 0.013, 1.0] };
    let pixels = u64::from(side) * u64::from(side);
    watch.rate((pixels, pixels * pixel_bytes(FORMAT)), |rec| {
        let uses: [Use; 1] = [target.with(Access::COLOUR_WRITE)];
        rec.pass("fill", &uses).render(&framebuffer).draw(&pipeline, &[], &options, 3);
    })
}
