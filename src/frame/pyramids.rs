//! Pyramids of pull–push: two pyramids of samples, an attribute buffer per group of attributes (`lib/pyramid.glsl`).

use super::recording::grid_over;
use super::renderer::RenderOptions;
use super::resource::Resource;
use super::targets::{PerPixel, TargetInfo};
use super::variant::Variant;
use crate::error::Result;
use crate::settings::Precision;
use crate::settings::pull_push::Storage;
use crate::vk::shaders::{self, resource};
use crate::vk::{Access, Binding, Buffer, Capabilities, DescriptorSet, Device, Encoder, Use, pixel_bytes};
use ash::vk::Format;
use std::ops::Range;
use std::sync::Arc;

/// The pyramids of pull–push.
pub struct Pyramids {
    // Drop order: sets before the buffers in them.
    /// Descriptor sets 2 and 3 of each.
    pub sets: [DescriptorSet; 2],
    /// The pyramids, in the roles that [`Storage`] gives them.
    pub pyramids: [Pyramid; 2],
    /// Assignment of levels to pyramids.
    pub storage: Storage,
    /// Size of the viewport, px.
    size: [u32; 2],
}

/// Samples of all levels, fine to coarse.
pub struct Pyramid {
    /// Attributes that the scene lacks have no buffer.
    pub(crate) attributes: [Option<AttributeBuffer>; ATTRIBUTES],
}

/// Buffer of one group of attributes of all samples.
pub(crate) struct AttributeBuffer {
    pub name: &'static str,
    /// Format of a sample.
    pub format: Format,
    pub buffer: Buffer,
}

/// Most attribute buffers of a pyramid, one per binding: depths, displacements, normals, colours or texture coordinates, point ids.
pub(crate) const ATTRIBUTES: usize = 5;

/// Resources of the attribute buffers in set 2; set 3 has the same bindings.
const BINDINGS: [&shaders::Resource; ATTRIBUTES] = [
    &resource::TO_DEPTHS,
    &resource::TO_DISPLACEMENTS,
    &resource::TO_NORMALS,
    &resource::TO_COLOURS,
    &resource::TO_IDS,
];

/// Formats of a pyramid's attribute buffers in frames of `variant`.
fn formats(variant: &Variant) -> [Option<Format>; ATTRIBUTES] {
    let [depths, displacements, normals, colours, ids] = match variant.precision {
        Precision::Full => FULL,
        Precision::Half => compact(variant.unbounded_colours),
    };
    // With a texture, samples have coordinates instead.
    let coordinates = variant.texture.map(|_| Format::R32G32_SFLOAT);
    let colours = coordinates.or_else(|| variant.colours.then_some(colours));
    [Some(depths), Some(displacements), Some(normals), colours, variant.has_ids().then_some(ids)]
}

/// Index of the colour buffer.
const COLOURS: usize = 3;

/// Full precision: 48 bytes per sample, 36 without colours, and 4 for an id.
const FULL: [Format; ATTRIBUTES] = [
    Format::R32G32B32A32_SFLOAT,
    Format::R32G32_SFLOAT,
    Format::R32G32B32_SFLOAT,
    Format::R32G32B32_SFLOAT,
    Format::R32_UINT,
];

/// Compact formats (`lib/compact.glsl`): 24 bytes per sample, 20 without colours, and 4 for an id. Displacement and radius are half floats,
/// far − near has a longer exponent; bounded colours are square roots.
fn compact(unbounded_colours: bool) -> [Format; ATTRIBUTES] {
    let colours =
        if unbounded_colours { Format::E5B9G9R9_UFLOAT_PACK32 } else { Format::A2B10G10R10_UNORM_PACK32 };
    [Format::R32G32_SFLOAT, Format::R32G32_UINT, Format::R16G16_SNORM, colours, Format::R32_UINT]
}

fn storage(variant: &Variant) -> Storage {
    variant.pull_push.map_or(Storage::Apart, |pull_push| pull_push.storage)
}

/// Debug names of both pyramids' attribute buffers. Shaders name them by role: `from_depths`, `to_depths` and so on.
fn names(storage: Storage) -> [[&'static str; ATTRIBUTES]; 2] {
    match storage {
        Storage::Apart => [
            ["pulled depths", "pulled displacements", "pulled normals", "pulled colours", "pulled ids"],
            ["pushed depths", "pushed displacements", "pushed normals", "pushed colours", "pushed ids"],
        ],
        Storage::PingPong => [
            ["even depths", "even displacements", "even normals", "even colours", "even ids"],
            ["odd depths", "odd displacements", "odd normals", "odd colours", "odd ids"],
        ],
    }
}

impl Pyramid {
    fn new(
        device: &Arc<Device>,
        variant: &Variant,
        names: [&'static str; ATTRIBUTES],
        samples: u64,
    ) -> Result<Self> {
        let mut attributes = [const { None }; ATTRIBUTES];
        for ((attribute, name), format) in attributes.iter_mut().zip(names).zip(formats(variant)) {
            let Some(format) = format else { continue };
            let buffer = Buffer::storage(device, name, samples * pixel_bytes(format))?;
            *attribute = Some(AttributeBuffer { name, format, buffer });
        }
        Ok(Self { attributes })
    }

    /// Creates its descriptor set.
    fn set(&self, device: &Arc<Device>) -> Result<DescriptorSet> {
        let attributes = BINDINGS.into_iter().zip(&self.attributes);
        let bindings = attributes
            .filter_map(|(binding, attribute)| Some((binding, Binding::whole(&attribute.as_ref()?.buffer))));
        DescriptorSet::new(device, &bindings.collect::<Vec<_>>())
    }

    /// Clears all samples.
    pub(crate) fn clear(&self, enc: &mut Encoder<'_, '_>) {
        let [of_points @ .., ids] = &self.attributes;
        of_points.iter().flatten().for_each(|attribute| enc.zero(&attribute.buffer));
        ids.iter().for_each(|attribute| enc.ones(&attribute.buffer));
    }

    /// Copies a range of samples to the same range of `other`.
    pub(crate) fn copy(&self, enc: &mut Encoder<'_, '_>, other: &Self, samples: Range<u64>) {
        for (from, to) in self.attributes.iter().flatten().zip(other.attributes.iter().flatten()) {
            let bytes = pixel_bytes(from.format);
            let [start, size] = [samples.start, samples.end - samples.start].map(|count| count * bytes);
            enc.copy_range(&from.buffer, &to.buffer, start, size);
        }
    }

    /// Accesses of its attribute buffers.
    pub(crate) fn with(&self, access: Access) -> impl Iterator<Item = Use> {
        self.attributes.iter().flatten().map(move |attribute| attribute.buffer.with(access))
    }
}

impl Pyramids {
    /// Creates the pyramids of `variant`, which must be of pull–push, for `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let storage = storage(variant);
        let [first, second] = names(storage).map(|names| Pyramid::new(device, variant, names, samples(size)));
        let pyramids = [first?, second?];
        let [first, second] = pyramids.each_ref().map(|pyramid| pyramid.set(device));
        Ok(Self { sets: [first?, second?], pyramids, storage, size })
    }

    /// The pyramid of a resource.
    pub(super) fn of(&self, resource: Resource) -> Option<&Pyramid> {
        match resource {
            Resource::Pulled => Some(&self.pyramids[self.storage.pull(0)[1]]),
            Resource::Pushed => Some(&self.pyramids[self.storage.push(0)[1]]),
            _ => None,
        }
    }

    /// Push constants of a step that computes a level.
    pub(super) fn step(&self, level: u32) -> [u32; 2] {
        [level, self.levels()]
    }

    /// Workgroup counts of such a step.
    pub(super) fn grid(&self, level: u32) -> [u32; 3] {
        grid_over(self.level_pixels(level))
    }

    /// Whether pyramids of this size with all attributes fit storage buffer ranges.
    pub fn fit(capabilities: &Capabilities, options: &RenderOptions) -> bool {
        let size = options.size;
        let formats = match options.precision {
            Precision::Full => FULL,
            Precision::Half => compact(true),
        };
        let attribute = samples(size) * formats.map(pixel_bytes).into_iter().max().unwrap_or(0);
        attribute <= capabilities.max_storage_buffer_range
    }

    /// Largest size of about that aspect ratio whose pyramids fit; at least 1×1.
    pub fn largest(capabilities: &Capabilities, options: &RenderOptions) -> [u32; 2] {
        let size = options.size;
        let longest = size[0].max(size[1]);
        let shrunk = |side: u32| {
            size.map(|length| (u64::from(length) * u64::from(side) / u64::from(longest)).max(1) as u32)
        };
        let (mut fitting, mut too_large) = (1, longest + 1);
        while too_large - fitting > 1 {
            let middle = fitting + (too_large - fitting) / 2;
            match Self::fit(capabilities, &RenderOptions { size: shrunk(middle), ..*options }) {
                true => fitting = middle,
                false => too_large = middle,
            }
        }
        shrunk(fitting)
    }

    /// Bytes per pixel of the attribute buffers; each level has a quarter of the pixels of the finer one.
    pub fn per_pixel(variant: &Variant) -> PerPixel {
        let attributes = names(storage(variant)).into_iter().flat_map(|names| {
            let bytes =
                |(name, format): (_, Option<_>)| Some((name, 4.0 / 3.0 * pixel_bytes(format?) as f64));
            names.into_iter().zip(formats(variant)).filter_map(bytes)
        });
        attributes.collect()
    }

    /// Whether compact colours share an exponent.
    pub(crate) fn unbounded_colours(&self) -> bool {
        let of = |attribute: &AttributeBuffer| attribute.format == Format::E5B9G9R9_UFLOAT_PACK32;
        self.pyramids[0].attributes[COLOURS].as_ref().is_some_and(of)
    }

    /// Number of levels; the last has one pixel.
    pub fn levels(&self) -> u32 {
        levels(self.size)
    }

    /// Width and height of a level, pixels of that level.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        level_size(self.size, level)
    }

    /// Number of pixels of a level.
    pub fn level_pixels(&self, level: u32) -> u64 {
        level_pixels(self.size, level)
    }

    /// Sample indices of a level.
    pub fn level_range(&self, level: u32) -> Range<u64> {
        let start = (0..level).map(|finer| self.level_pixels(finer)).sum();
        start..start + self.level_pixels(level)
    }

    /// Accesses of a pass that reads one pyramid and writes one.
    pub(crate) fn uses(&self, [from, to]: [usize; 2]) -> Vec<Use> {
        let read = (from != to).then(|| self.pyramids[from].with(Access::COMPUTE_READ));
        read.into_iter().flatten().chain(self.pyramids[to].with(Access::COMPUTE_WRITE)).collect()
    }

    /// All attribute buffers.
    pub fn list(&self) -> impl Iterator<Item = TargetInfo> {
        let attributes = self.pyramids.iter().flat_map(|pyramid| pyramid.attributes.iter().flatten());
        attributes.map(|attribute| TargetInfo {
            name: attribute.name,
            format: attribute.format,
            bytes: attribute.buffer.size(),
        })
    }
}

/// Resources of a pyramid's descriptor set.
pub fn shader_resources(variant: &Variant) -> Vec<&'static shaders::Resource> {
    BINDINGS
        .into_iter()
        .zip(formats(variant))
        .filter_map(|(binding, format)| format.map(|_| binding))
        .collect()
}

/// Number of samples of a pyramid.
fn samples(size: [u32; 2]) -> u64 {
    (0..levels(size)).map(|level| level_pixels(size, level)).sum()
}

fn levels(size: [u32; 2]) -> u32 {
    let longest = size[0].max(size[1]);
    1 + longest.next_power_of_two().trailing_zeros()
}

fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| side.div_ceil(1 << level))
}

fn level_pixels(size: [u32; 2], level: u32) -> u64 {
    level_size(size, level).map(u64::from).iter().product()
}
