//! Pyramids of pull–push: two pyramids of samples, whose levels lie side by side in images (`lib/pyramid.glsl`).

use super::recording::grid_over_pixels;
use super::renderer::RenderOptions;
use super::resource::Resource;
use super::target_descriptions::PerPixel;
use super::targets::{TargetInfo, pixels_of};
use super::variant::Variant;
use crate::error::Result;
use crate::settings::Precision;
use crate::settings::pull_push::Storage;
use crate::vk::shaders::layout::Step;
use crate::vk::shaders::{self, resource};
use crate::vk::{
    Access, Binding, Capabilities, DescriptorSet, Device, Encoder, Image, ImageUse, Use, pixel_bytes,
};
use ash::vk::Format;
use std::sync::Arc;

/// The pyramids of pull–push.
pub struct Pyramids {
    /// The pyramids, in the roles that [`Storage`] gives them.
    pub pyramids: [Pyramid; 2],
    /// Assignment of levels to pyramids.
    pub storage: Storage,
    /// Levels of the picture's size.
    pub levels: Levels,
    /// Words of a sample.
    pub(super) words: WordFormat,
}

/// Samples of levels, from the finest that it has to the coarsest.
pub struct Pyramid {
    // Drop order: sets before the images in them.
    /// Descriptor set 2 of passes that write it.
    pub written: DescriptorSet,
    /// Descriptor set 3, or 2, of passes that only read it.
    pub read: DescriptorSet,
    /// Four words of each sample, or one.
    pub(super) images: Vec<(&'static str, Image)>,
    /// Finest level.
    pub(super) finest: u32,
    /// Its levels, the finest as level 0.
    levels: Levels,
}

/// The levels of pyramids. Each has half the side of the finer one, rounded up; the last has one pixel.
///
/// ```text
/// wide pictures   0 0 0 0      others   0 0 1
///                 0 0 0 0               0 0 1
///                 1 1 2 3               0 0 2
///                 1 1                   0 0 3
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Levels {
    /// Size of level 0, px.
    size: [u32; 2],
}

/// What the words of a sample are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WordFormat {
    pub precision: Precision,
    pub unbounded_colours: bool,
    /// Words of the colour or of texture coordinates.
    pub colour: u32,
    pub coordinates: bool,
    pub ids: bool,
}

/// Bytes of the nearest point of a pixel.
pub const NEAREST_POINT: u64 = 8;

/// Most images of a pyramid: three of four words a texel, two of one.
const IMAGES: usize = 5;

/// Format of each image.
const FORMATS: [Format; IMAGES] = [
    Format::R32G32B32A32_UINT,
    Format::R32G32B32A32_UINT,
    Format::R32G32B32A32_UINT,
    Format::R32_UINT,
    Format::R32_UINT,
];

/// Resources of the images in set 2, as storage images.
const WRITTEN: [&shaders::Resource; IMAGES] = [
    &resource::TO_IMAGE0,
    &resource::TO_IMAGE1,
    &resource::TO_IMAGE2,
    &resource::TO_IMAGE3,
    &resource::TO_IMAGE4,
];

/// Resources of the images in sets 2 and 3, as sampled images.
const READ: [&shaders::Resource; IMAGES] = [
    &resource::FROM_QUAD0,
    &resource::FROM_QUAD1,
    &resource::FROM_QUAD2,
    &resource::FROM_SINGLE0,
    &resource::FROM_SINGLE1,
];

/// Debug names of both pyramids' images. Shaders name them by role: `from_quad0`, `to_image0` and so on.
fn names(storage: Storage) -> [[&'static str; IMAGES]; 2] {
    match storage {
        Storage::Apart => [
            [
                "pulled words 0–3",
                "pulled words 4–7",
                "pulled words 8–11",
                "pulled word",
                "pulled second word",
            ],
            [
                "pushed words 0–3",
                "pushed words 4–7",
                "pushed words 8–11",
                "pushed word",
                "pushed second word",
            ],
        ],
        Storage::PingPong => [
            ["even words 0–3", "even words 4–7", "even words 8–11", "even word", "even second word"],
            ["odd words 0–3", "odd words 4–7", "odd words 8–11", "odd word", "odd second word"],
        ],
    }
}

impl WordFormat {
    /// The words of samples in frames of `variant`.
    pub fn of(variant: &Variant) -> Self {
        let coordinates = variant.texture.is_some();
        let colour = match (coordinates, variant.colours, variant.precision) {
            (true, ..) => 2,
            (_, false, _) => 0,
            (_, true, Precision::Full) => 3,
            (_, true, Precision::Half) => 1,
        };
        Self {
            precision: variant.precision,
            unbounded_colours: variant.unbounded_colours,
            colour,
            coordinates,
            ids: variant.has_ids(),
        }
    }

    /// Number of words before those of the colour.
    pub fn before_colour(self) -> u32 {
        match self.precision {
            Precision::Full => 9,
            Precision::Half => 5,
        }
    }

    /// Number of words of a sample.
    pub fn words(self) -> u32 {
        self.before_colour() + self.colour + u32::from(self.ids)
    }

    /// Words that the images store of a texel, unused ones too.
    pub fn stored_words(self) -> usize {
        self.images().map(|i| pixel_bytes(FORMATS[i]) as usize / 4).sum()
    }

    /// Images, as indices into [`FORMATS`]: four words a texel, and one a texel for one or two that are left.
    fn images(self) -> impl Iterator<Item = usize> {
        let quads = self.words().div_ceil(4) - u32::from(matches!(self.words() % 4, 1 | 2));
        let singles = self.words().saturating_sub(4 * quads);
        (0..quads as usize).chain(3..3 + singles as usize)
    }
}

impl Pyramid {
    fn new(
        device: &Arc<Device>,
        format: WordFormat,
        names: [&'static str; IMAGES],
        (finest, levels): (u32, Levels),
    ) -> Result<Self> {
        let image = |i: usize| {
            let image = Image::target(device, names[i], FORMATS[i], levels.extent(), ImageUse::Stored)?;
            Ok((names[i], image))
        };
        let images = format.images().map(image).collect::<Result<Vec<_>>>()?;
        let all = || format.images().zip(&images);
        let read: Vec<_> = all().map(|(i, (_, image))| (READ[i], Binding::Fetched(image))).collect();
        let stored = all().map(|(i, (_, image))| (WRITTEN[i], Binding::Stored(image)));
        let written: Vec<_> = stored.chain(read.iter().copied()).collect();
        let [written, read] = [written, read].map(|bindings| DescriptorSet::new(device, &bindings));
        Ok(Self { written: written?, read: read?, images, finest, levels })
    }

    /// First texel of a level that it has.
    pub(super) fn origin(&self, level: u32) -> [u32; 2] {
        self.levels.origin(level.saturating_sub(self.finest))
    }

    /// Makes all samples empty: their first image has the distances, which are 0 then; their other words stay undefined.
    pub(super) fn clear(&self, enc: &mut Encoder<'_, '_>) {
        if let Some((_, image)) = self.images.first() {
            enc.clear_image(image, [0.0; 4]);
        }
    }

    /// Accesses of its images.
    pub(crate) fn with(&self, access: Access) -> impl Iterator<Item = Use> {
        self.images.iter().map(move |(_, image)| image.with(access.in_general()))
    }
}

impl Levels {
    /// The levels of a picture of `size` px.
    pub fn of(size: [u32; 2]) -> Self {
        Self { size }
    }

    /// Number of levels.
    pub fn count(self) -> u32 {
        1 + self.size[0].max(self.size[1]).next_power_of_two().trailing_zeros()
    }

    /// Width and height of a level, pixels of that level; 0 beyond the last.
    pub fn size_of(self, level: u32) -> [u32; 2] {
        if level < self.count() { self.size.map(|side| side.div_ceil(1 << level)) } else { [0; 2] }
    }

    /// First texel of a level.
    pub fn origin(self, level: u32) -> [u32; 2] {
        let along = (1..level).map(|finer| self.size_of(finer)[self.along()]).sum();
        let mut origin = [0; 2];
        if level > 0 {
            origin[self.along()] = along;
            origin[1 - self.along()] = self.size[1 - self.along()];
        }
        origin
    }

    /// Width and height of the images, px.
    pub fn extent(self) -> [u32; 2] {
        let ends = (0..self.count()).map(|level| {
            let ([x, y], [width, height]) = (self.origin(level), self.size_of(level));
            [x + width, y + height]
        });
        ends.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]).unwrap_or_default()
    }

    /// Axis along which the coarser levels lie.
    fn along(self) -> usize {
        if self.size[0] > self.size[1] { 0 } else { 1 }
    }
}

impl Pyramids {
    /// Creates the pyramids of `variant`, which must be of pull–push, for `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let (storage, words) = (storage(variant), WordFormat::of(variant));
        let [first, second] = names(storage);
        let finest = finest_pushed(variant);
        let pushed = (finest, Levels::of(size.map(|side| side.div_ceil(1 << finest))));
        let first = Pyramid::new(device, words, first, (0, Levels::of(size)))?;
        let second = Pyramid::new(device, words, second, pushed)?;
        Ok(Self { pyramids: [first, second], storage, levels: Levels::of(size), words })
    }

    /// The pyramid of a resource.
    pub(super) fn of(&self, resource: Resource) -> Option<&Pyramid> {
        match resource {
            Resource::Pulled => Some(&self.pyramids[self.storage.pull(0)[1]]),
            Resource::Pushed => Some(&self.pyramids[self.storage.push(0)[1]]),
            _ => None,
        }
    }

    /// Push constants of a pull to a level.
    pub(super) fn pull_step(&self, level: u32) -> Step {
        let [from, to] = self.storage.pull(level);
        self.step(level, [from, to], (from, level - 1))
    }

    /// Push constants of a copy of a pulled level to the other pyramid.
    pub(super) fn copy_step(&self, level: u32) -> Step {
        let ([_, from], [to, _]) = (self.storage.pull(level), self.storage.push(level));
        self.step(level, [from, to], (from, level))
    }

    /// Push constants of a push to a level.
    pub(super) fn push_step(&self, level: u32) -> Step {
        let [from, to] = self.storage.push(level);
        let coarser = match self.storage {
            Storage::Apart => to,
            Storage::PingPong => from,
        };
        self.step(level, [from, to], (coarser, level + 1))
    }

    /// Push constants of a dispatch that reads the final samples of a level.
    pub(super) fn final_step(&self, level: u32) -> Step {
        let [_, last] = self.storage.push(level);
        self.step(level, [last, last], (last, level))
    }

    fn step(&self, level: u32, [from, to]: [usize; 2], (of_adjacent, adjacent): (usize, u32)) -> Step {
        let signed = |pair: [u32; 2]| pair.map(|value| value as i32);
        let origin = |pyramid: usize, level| signed(self.pyramids[pyramid].origin(level));
        Step {
            size: signed(self.levels.size_of(level)),
            to_origin: origin(to, level),
            from_origin: origin(from, level),
            adjacent_size: signed(self.levels.size_of(adjacent)),
            adjacent_origin: origin(of_adjacent, adjacent),
            level,
        }
    }

    /// Finest level that push stores.
    pub(super) fn finest_pushed(&self) -> u32 {
        self.pyramids[1].finest
    }

    /// Workgroup counts of such a step.
    pub(super) fn grid(&self, level: u32) -> [u32; 3] {
        grid_over_pixels(self.levels.size_of(level))
    }

    /// Whether pyramids of this size fit a device, and their nearest points, unless these are rasterized.
    pub fn fit(capabilities: &Capabilities, size: [u32; 2], rasterized: bool) -> bool {
        let images = Levels::of(size).extent().iter().all(|side| *side <= capabilities.max_image_side);
        images && (rasterized || NEAREST_POINT * pixels_of(size) <= capabilities.max_storage_buffer_range)
    }

    /// Largest size of about that aspect ratio whose pyramids fit; at least 1×1.
    pub fn largest(capabilities: &Capabilities, options: &RenderOptions, rasterized: bool) -> [u32; 2] {
        let size = options.size;
        let longest = size[0].max(size[1]);
        let shrunk = |side: u32| {
            size.map(|length| (u64::from(length) * u64::from(side) / u64::from(longest)).max(1) as u32)
        };
        let (mut fitting, mut too_large) = (1, longest + 1);
        while too_large - fitting > 1 {
            let middle = fitting + (too_large - fitting) / 2;
            match Self::fit(capabilities, shrunk(middle), rasterized) {
                true => fitting = middle,
                false => too_large = middle,
            }
        }
        shrunk(fitting)
    }

    /// Bytes per pixel of the images of a square picture.
    pub fn per_pixel(variant: &Variant) -> PerPixel {
        let format = WordFormat::of(variant);
        // The coarser levels are half as wide as the finest one, and as high.
        let texels = finest_texels(variant).map(|texels| 1.5 * texels);
        let images = names(storage(variant)).into_iter().zip(texels).flat_map(|(names, texels)| {
            format.images().map(move |i| (names[i], texels * pixel_bytes(FORMATS[i]) as f64))
        });
        images.collect()
    }

    /// Bytes per pixel of the finest stored level of the pulled and of the pushed pyramid.
    pub fn finest_level(variant: &Variant) -> [f64; 2] {
        let sample: u64 = WordFormat::of(variant).images().map(|i| pixel_bytes(FORMATS[i])).sum();
        finest_texels(variant).map(|texels| texels * sample as f64)
    }

    /// Bytes per pixel of what [`Pyramid::clear`] clears of the finest stored levels.
    pub fn cleared(variant: &Variant) -> [f64; 2] {
        finest_texels(variant).map(|texels| texels * pixel_bytes(FORMATS[0]) as f64)
    }

    /// Accesses of a pass that reads one pyramid and writes one.
    pub(crate) fn uses(&self, [from, to]: [usize; 2]) -> Vec<Use> {
        let read = (from != to).then(|| self.pyramids[from].with(Access::COMPUTE_READ));
        read.into_iter().flatten().chain(self.pyramids[to].with(Access::COMPUTE_WRITE)).collect()
    }

    /// All images.
    pub fn list(&self) -> impl Iterator<Item = TargetInfo> {
        let images = self.pyramids.iter().flat_map(|pyramid| &pyramid.images);
        images.map(|(name, image)| TargetInfo { name, format: image.format(), bytes: image.bytes() })
    }
}

/// Texels of the finest stored level of the pulled and of the pushed pyramid, per pixel.
fn finest_texels(variant: &Variant) -> [f64; 2] {
    [1.0, 1.0 / f64::from(1_u32 << (2 * finest_pushed(variant)))]
}

/// Finest level that push stores: shade may reconstruct level 0.
fn finest_pushed(variant: &Variant) -> u32 {
    u32::from(variant.reconstructs_in_shade())
}

fn storage(variant: &Variant) -> Storage {
    variant.pull_push.map_or(Storage::Apart, |pull_push| pull_push.storage)
}

/// Resources of a pyramid's descriptor set.
pub fn shader_resources(variant: &Variant, written: bool) -> Vec<&'static shaders::Resource> {
    let images = || WordFormat::of(variant).images();
    let stored = images().filter(|_| written).map(|i| WRITTEN[i]);
    stored.chain(images().map(|i| READ[i])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_do_not_overlap() {
        for size in [[1, 1], [1, 9], [9, 1], [5, 5], [64, 64], [1920, 1080], [1080, 1920], [1023, 1025]] {
            let levels = Levels::of(size);
            let boxes: Vec<_> =
                (0..levels.count()).map(|level| (levels.origin(level), levels.size_of(level))).collect();
            assert_eq!(boxes.last().unwrap().1, [1, 1]);
            for (i, (a, a_size)) in boxes.iter().enumerate() {
                for (b, b_size) in &boxes[..i] {
                    let apart = (0..2)
                        .any(|axis| a[axis] + a_size[axis] <= b[axis] || b[axis] + b_size[axis] <= a[axis]);
                    assert!(apart, "{size:?}: {boxes:?}");
                }
            }
        }
    }

    #[test]
    fn images_have_all_words_and_at_most_one_that_is_unused() {
        for (precision, colours) in [(Precision::Full, [0, 2, 3]), (Precision::Half, [0, 1, 2])] {
            for (colour, ids) in colours.into_iter().flat_map(|colour| [(colour, false), (colour, true)]) {
                let format =
                    WordFormat { precision, unbounded_colours: false, colour, coordinates: false, ids };
                let (stored, words) = (format.stored_words(), format.words() as usize);
                assert!(words <= stored && stored <= words + 1, "{format:?}: {stored}");
            }
        }
    }
}
