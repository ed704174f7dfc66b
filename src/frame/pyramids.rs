//! The targets of pull–push: two pyramids of samples, plane by plane (`lib/pyramid.glsl`).

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
    // Sets go before what they name.
    /// What passes see of each: descriptor sets 2 and 3.
    pub sets: [DescriptorSet; 2],
    /// Which of these holds what: [`Storage`].
    pub pyramids: [Pyramid; 2],
    /// Where the levels are kept.
    pub storage: Storage,
    /// Of the picture, px.
    size: [u32; 2],
}

/// Samples of all levels, fine to coarse.
pub struct Pyramid {
    /// What the scene lacks has none.
    pub(crate) planes: [Option<Plane>; PLANES],
}

/// A group of attributes of all samples of a pyramid.
pub(crate) struct Plane {
    pub name: &'static str,
    /// Of a sample.
    pub format: Format,
    pub buffer: Buffer,
}

/// How many planes a pyramid may have, one a binding: depths, places, normals, colours or coordinates in a texture, numbers of points.
pub(crate) const PLANES: usize = 5;

/// Where shaders see the planes: in set 2, and in the same places of set 3.
const BINDINGS: [&shaders::Resource; PLANES] = [
    &resource::TO_DEPTHS,
    &resource::TO_DISPLACEMENTS,
    &resource::TO_NORMALS,
    &resource::TO_COLOURS,
    &resource::TO_IDS,
];

/// The planes of a pyramid of `variant`, each by the format of a sample.
fn formats(variant: &Variant) -> [Option<Format>; PLANES] {
    let [depths, places, normals, colours, ids] = match variant.precision {
        Precision::Full => FULL,
        Precision::Half => compact(variant.unbounded_colours),
    };
    // A texture has the colours.
    let coordinates = variant.texture.map(|_| Format::R32G32_SFLOAT);
    let colours = coordinates.or_else(|| variant.colours.then_some(colours));
    [Some(depths), Some(places), Some(normals), colours, variant.has_ids().then_some(ids)]
}

/// The plane of colours.
const COLOURS: usize = 3;

/// The planes of 32-bit floats: 48 bytes a sample, 36 without colours; and 4 for a number.
const FULL: [Format; PLANES] = [
    Format::R32G32B32A32_SFLOAT,
    Format::R32G32_SFLOAT,
    Format::R32G32B32_SFLOAT,
    Format::R32G32B32_SFLOAT,
    Format::R32_UINT,
];

/// The compact planes (`lib/compact.glsl`): 24 bytes a sample, 20 without colours, and 4 for a number. Of the places three numbers are half
/// floats, and one has more exponent; bounded colours are square roots.
fn compact(unbounded_colours: bool) -> [Format; PLANES] {
    let colours = match unbounded_colours {
        true => Format::E5B9G9R9_UFLOAT_PACK32,
        false => Format::A2B10G10R10_UNORM_PACK32,
    };
    [Format::R32G32_SFLOAT, Format::R32G32_UINT, Format::R16G16_SNORM, colours, Format::R32_UINT]
}

fn storage(variant: &Variant) -> Storage {
    variant.pull_push.map_or(Storage::Apart, |pull_push| pull_push.storage)
}

/// What the planes of either pyramid are called. In shaders they are `from_depths`, `to_depths` and so on, by what a pass does with them.
fn names(storage: Storage) -> [[&'static str; PLANES]; 2] {
    match storage {
        Storage::Apart => [
            ["pulled depths", "pulled places", "pulled normals", "pulled colours", "pulled ids"],
            ["pushed depths", "pushed places", "pushed normals", "pushed colours", "pushed ids"],
        ],
        Storage::PingPong => [
            ["even depths", "even places", "even normals", "even colours", "even ids"],
            ["odd depths", "odd places", "odd normals", "odd colours", "odd ids"],
        ],
    }
}

impl Pyramid {
    fn new(
        device: &Arc<Device>,
        variant: &Variant,
        names: [&'static str; PLANES],
        samples: u64,
    ) -> Result<Self> {
        let mut planes = [const { None }; PLANES];
        for ((plane, name), format) in planes.iter_mut().zip(names).zip(formats(variant)) {
            let Some(format) = format else { continue };
            let buffer = Buffer::storage(device, name, samples * pixel_bytes(format))?;
            *plane = Some(Plane { name, format, buffer });
        }
        Ok(Self { planes })
    }

    /// What passes see of it.
    fn set(&self, device: &Arc<Device>) -> Result<DescriptorSet> {
        let planes = BINDINGS.into_iter().zip(&self.planes);
        let there =
            planes.filter_map(|(binding, plane)| Some((binding, Binding::whole(&plane.as_ref()?.buffer))));
        DescriptorSet::new(device, &there.collect::<Vec<_>>())
    }

    /// Leaves nothing in any sample.
    pub(crate) fn clear(&self, enc: &mut Encoder<'_, '_>) {
        let [of_points @ .., ids] = &self.planes;
        of_points.iter().flatten().for_each(|plane| enc.zero(&plane.buffer));
        ids.iter().for_each(|plane| enc.ones(&plane.buffer));
    }

    /// Copies a range of samples to the same place of `other`.
    pub(crate) fn copy(&self, enc: &mut Encoder<'_, '_>, other: &Self, samples: Range<u64>) {
        for (from, to) in self.planes.iter().flatten().zip(other.planes.iter().flatten()) {
            let bytes = pixel_bytes(from.format);
            let [start, size] = [samples.start, samples.end - samples.start].map(|count| count * bytes);
            enc.copy_range(&from.buffer, &to.buffer, start, size);
        }
    }

    /// Its planes, as a pass uses them.
    pub(crate) fn with(&self, access: Access) -> impl Iterator<Item = Use> {
        self.planes.iter().flatten().map(move |plane| plane.buffer.with(access))
    }
}

impl Pyramids {
    /// The pyramids of `variant`, which is one of pull–push, of a picture of `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let storage = storage(variant);
        let [first, second] = names(storage).map(|names| Pyramid::new(device, variant, names, samples(size)));
        let pyramids = [first?, second?];
        let [first, second] = pyramids.each_ref().map(|pyramid| pyramid.set(device));
        Ok(Self { sets: [first?, second?], pyramids, storage, size })
    }

    /// The one that is called so.
    pub(super) fn of(&self, resource: Resource) -> Option<&Pyramid> {
        match resource {
            Resource::Pulled => Some(&self.pyramids[self.storage.pull(0)[1]]),
            Resource::Pushed => Some(&self.pyramids[self.storage.push(0)[1]]),
            _ => None,
        }
    }

    /// The push constants of a step that makes a level.
    pub(super) fn step(&self, level: u32) -> [u32; 2] {
        [level, self.levels()]
    }

    /// The workgroups of such a step.
    pub(super) fn grid(&self, level: u32) -> [u32; 3] {
        grid_over(self.level_pixels(level))
    }

    /// Whether pyramids of a picture of this size, with all planes, fit the buffers that shaders of the device can see.
    pub fn fit(capabilities: &Capabilities, options: &RenderOptions) -> bool {
        let size = options.size;
        let formats = match options.precision {
            Precision::Full => FULL,
            Precision::Half => compact(true),
        };
        let plane = samples(size) * formats.map(pixel_bytes).into_iter().max().unwrap_or(0);
        plane <= capabilities.max_storage_buffer_range
    }

    /// The largest picture of about that shape whose pyramids fit; 1×1 if none does.
    pub fn largest(capabilities: &Capabilities, options: &RenderOptions) -> [u32; 2] {
        let size = options.size;
        let longest = size[0].max(size[1]);
        let shrunk =
            |side: u32| size.map(|own| (u64::from(own) * u64::from(side) / u64::from(longest)).max(1) as u32);
        let (mut fitting, mut beyond) = (1, longest + 1);
        while beyond - fitting > 1 {
            let middle = fitting + (beyond - fitting) / 2;
            match Self::fit(capabilities, &RenderOptions { size: shrunk(middle), ..*options }) {
                true => fitting = middle,
                false => beyond = middle,
            }
        }
        shrunk(fitting)
    }

    /// What the planes take; a level has a quarter of the pixels of the one below.
    pub fn per_pixel(variant: &Variant) -> PerPixel {
        let planes = names(storage(variant)).into_iter().flat_map(|names| {
            let bytes =
                |(name, format): (_, Option<_>)| Some((name, 4.0 / 3.0 * pixel_bytes(format?) as f64));
            names.into_iter().zip(formats(variant)).filter_map(bytes)
        });
        planes.collect()
    }

    /// Whether colours, if they are rounded, share an exponent.
    pub(crate) fn unbounded_colours(&self) -> bool {
        let of = |plane: &Plane| plane.format == Format::E5B9G9R9_UFLOAT_PACK32;
        self.pyramids[0].planes[COLOURS].as_ref().is_some_and(of)
    }

    /// Number of levels: up to one of a single pixel.
    pub fn levels(&self) -> u32 {
        levels(self.size)
    }

    /// Width and height of a level, its pixels.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        level_size(self.size, level)
    }

    /// Number of pixels of a level.
    pub fn level_pixels(&self, level: u32) -> u64 {
        level_pixels(self.size, level)
    }

    /// The samples of a level, by number.
    pub fn level_range(&self, level: u32) -> Range<u64> {
        let start = (0..level).map(|finer| self.level_pixels(finer)).sum();
        start..start + self.level_pixels(level)
    }

    /// What a pass uses that reads one of the pyramids and writes one.
    pub(crate) fn uses(&self, [from, to]: [usize; 2]) -> Vec<Use> {
        let read = (from != to).then(|| self.pyramids[from].with(Access::COMPUTE_READ));
        read.into_iter().flatten().chain(self.pyramids[to].with(Access::COMPUTE_WRITE)).collect()
    }

    /// Every plane that there is.
    pub fn list(&self) -> impl Iterator<Item = TargetInfo> {
        let planes = self.pyramids.iter().flat_map(|pyramid| pyramid.planes.iter().flatten());
        planes.map(|plane| TargetInfo { name: plane.name, format: plane.format, bytes: plane.buffer.size() })
    }
}

/// What passes see of a pyramid.
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
