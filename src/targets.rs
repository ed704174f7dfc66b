//! Every render target: name, format, and when a frame has it. Each name is that of the variable in the shaders, but
//! for planes of pyramids, which passes take in turns.

mod drawn_points;
mod pyramids;

pub use drawn_points::DrawnPoints;
pub(crate) use pyramids::PLANES;
pub use pyramids::{Pyramid, Pyramids};

use crate::error::{Error, Result};
use crate::splatting::Visibility;
use crate::variant::{Outputs, Precision, Variant};
use crate::vk::{Buffer, Capabilities, Device, Image, ImageUse, pixel_bytes};
use ash::vk::Format;
use std::sync::Arc;

/// Targets that are drawn to.
pub struct Images {
    /// Depth key of the nearest surface, moved back by ε; 0 where there is none.
    pub visibility: Image,
    /// `(Σw, Σw a)`: `a` is the normal where normals are wanted, else the colour.
    pub sums0: Image,
    /// `(Σw κ, Σw rgb)`, where depth is wanted, or colour beside normals.
    pub sums1: Option<Image>,
    /// The picture, linear.
    pub image: Image,
    /// Unit normals, where they are asked for.
    pub normal: Option<Image>,
    /// Eye-space depth, where it is asked for.
    pub depth: Option<Image>,
    /// The samples of each pixel that a surface covers, a bit each, where α is coverage.
    pub coverage: Option<Buffer>,
}

/// Targets that compute shaders write, pixel by pixel from the top left.
pub struct Buffers {
    /// See [`Images::visibility`]; where the nearest splat is seen alone, its number is beside the key.
    pub visibility: Buffer,
    /// See [`Images::sums0`].
    pub sums0: Buffer,
    /// See [`Images::sums1`].
    pub sums1: Option<Buffer>,
    /// Least visibility of each tile of [`Buffers::TILE`]² pixels, empty ones aside; where splats are blended.
    pub tiles: Option<Buffer>,
    /// See [`Images::coverage`].
    pub coverage: Option<Buffer>,
    /// The picture.
    pub picture: PictureBuffer,
}

/// A picture that compute shaders write, pixel by pixel from the top left: all pixels' colour (4 floats), then all normals (3), then all
/// depths (1), then all numbers of points (1, a word), as far as they are asked for.
pub struct PictureBuffer {
    /// The floats.
    pub buffer: Buffer,
    /// What it holds.
    pub outputs: Outputs,
    /// Width and height, px.
    pub size: [u32; 2],
}

/// Format of each image of a [`Variant`]; `None` where there is no such target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// See [`Images::visibility`].
    pub visibility: Format,
    /// See [`Images::sums0`].
    pub sums0: Format,
    /// See [`Images::sums1`].
    pub sums1: Option<Format>,
    /// See [`Images::image`].
    pub image: Format,
    /// See [`Images::normal`].
    pub normal: Option<Format>,
    /// See [`Images::depth`].
    pub depth: Option<Format>,
    /// See [`Images::coverage`]; of a pixel in a buffer.
    pub coverage: Option<Format>,
}

/// A target as a report shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TargetInfo {
    /// Its name.
    pub name: &'static str,
    /// Its format; for buffers, that of a pixel.
    pub format: Format,
    /// Memory that it occupies, bytes.
    pub bytes: u64,
}

impl Formats {
    /// What a frame of this variant needs, and no more.
    pub fn of(variant: &Variant) -> Self {
        let sums = |wide: bool| match (variant.precision, wide) {
            (Precision::Full, true) => Format::R32G32B32A32_SFLOAT,
            (Precision::Full, false) => Format::R32_SFLOAT,
            (Precision::Half, true) => Format::R16G16B16A16_SFLOAT,
            (Precision::Half, false) => Format::R16_SFLOAT,
        };
        Self {
            visibility: Format::D32_SFLOAT,
            sums0: sums(variant.wide_sums0()),
            sums1: variant.has_sums1().then(|| sums(variant.wide_sums1())),
            image: Format::R32G32B32A32_SFLOAT,
            normal: variant.outputs.normal.then_some(Format::R32G32B32A32_SFLOAT),
            depth: variant.outputs.depth.then_some(Format::R32_SFLOAT),
            coverage: variant.coverage.then_some(Format::R32_UINT),
        }
    }

    /// What the images take.
    pub fn per_pixel(&self) -> PerPixel {
        let always = [("visibility", Some(self.visibility)), ("sums0", Some(self.sums0))];
        let optional = [
            ("sums1", self.sums1),
            ("image", Some(self.image)),
            ("normal", self.normal),
            ("depth", self.depth),
            ("coverage", self.coverage),
        ];
        let bytes = |(name, format): (_, Option<Format>)| Some((name, pixel_bytes(format?) as f64));
        always.into_iter().chain(optional).filter_map(bytes).collect()
    }
}

/// Targets by name with the bytes of a pixel, of which a tile's are shared.
pub type PerPixel = Vec<(&'static str, f64)>;

/// Refuses a size that `device` has no targets of, with its limit.
pub fn check_size(device: &Device, size: [u32; 2]) -> Result<()> {
    let limit = device.capabilities().max_image_side;
    let [width, height] = size;
    match size.contains(&0) || size.iter().any(|side| *side > limit) {
        false => Ok(()),
        true => {
            let name = &device.description().name;
            Err(Error::Usage(format!(
                "a picture of {width}x{height} px: {name} draws from 1x1 to {limit}x{limit}"
            )))
        }
    }
}

/// Where α is coverage, its target.
pub(crate) fn coverage(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Option<Buffer>> {
    let bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
    variant.coverage.then(|| Buffer::storage(device, "coverage", bytes)).transpose()
}

fn coverage_info(buffer: &Buffer) -> TargetInfo {
    TargetInfo { name: "coverage", format: Format::R32_UINT, bytes: buffer.size() }
}

impl Images {
    /// The targets of `variant` at `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let formats = Formats::of(variant);
        let target = |name, format, also| Image::target(device, name, format, size, also);
        let optional =
            |name, format: Option<Format>, also| format.map(|format| target(name, format, also)).transpose();
        Ok(Self {
            visibility: target("visibility", formats.visibility, ImageUse::Sampled)?,
            sums0: target("sums0", formats.sums0, ImageUse::Sampled)?,
            sums1: optional("sums1", formats.sums1, ImageUse::Sampled)?,
            image: target("image", formats.image, ImageUse::Output)?,
            normal: optional("normal", formats.normal, ImageUse::Output)?,
            depth: optional("depth", formats.depth, ImageUse::Output)?,
            coverage: coverage(device, variant, size)?,
        })
    }

    /// The images that are read on the CPU.
    pub fn outputs(&self) -> impl Iterator<Item = &Image> {
        [Some(&self.image), self.normal.as_ref(), self.depth.as_ref()].into_iter().flatten()
    }

    /// Every target that there is.
    pub fn list(&self) -> Vec<TargetInfo> {
        let always = [("visibility", &self.visibility), ("sums0", &self.sums0), ("image", &self.image)];
        let optional = [("sums1", &self.sums1), ("normal", &self.normal), ("depth", &self.depth)];
        let there = optional.into_iter().filter_map(|(name, image)| Some((name, image.as_ref()?)));
        let info =
            |(name, image): (_, &Image)| TargetInfo { name, format: image.format(), bytes: image.bytes() };
        let images = always.into_iter().chain(there).map(info);
        images.chain(self.coverage.iter().map(coverage_info)).collect()
    }
}

impl Buffers {
    /// The targets of `variant` at `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let buffer = |name, floats: u64| Buffer::storage(device, name, 4 * floats * pixels);
        let floats = |wide: bool| if wide { 4 } else { 1 };
        let sums1 = variant.has_sums1().then(|| buffer("sums1", floats(variant.wide_sums1())));
        let nearest = variant.visibility == Visibility::Nearest;
        let tiles = (!nearest).then(|| Buffer::storage(device, "tiles", 4 * Self::tiles(size)));
        Ok(Self {
            visibility: buffer("visibility", if nearest { 2 } else { 1 })?,
            sums0: buffer("sums0", floats(variant.wide_sums0()))?,
            sums1: sums1.transpose()?,
            tiles: tiles.transpose()?,
            coverage: coverage(device, variant, size)?,
            picture: PictureBuffer::new(device, variant.outputs, size)?,
        })
    }

    /// Whether the coverage of a picture of this size fits a buffer that shaders of the device can see.
    pub fn fit_coverage(capabilities: &Capabilities, size: [u32; 2]) -> bool {
        4 * u64::from(size[0]) * u64::from(size[1]) <= capabilities.max_storage_buffer_range
    }

    /// Whether a picture of this size fits the buffers that shaders of the device can see.
    pub fn fit(capabilities: &Capabilities, outputs: Outputs, size: [u32; 2]) -> bool {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        // The picture has the largest pixels.
        4 * PictureBuffer::floats(outputs) * pixels <= capabilities.max_storage_buffer_range
    }

    /// What the buffers take.
    pub fn per_pixel(variant: &Variant) -> PerPixel {
        let nearest = variant.visibility == Visibility::Nearest;
        let floats = |wide: bool| if wide { 16.0 } else { 4.0 };
        let mut list =
            vec![("visibility", if nearest { 8.0 } else { 4.0 }), ("sums0", floats(variant.wide_sums0()))];
        list.extend(variant.has_sums1().then(|| ("sums1", floats(variant.wide_sums1()))));
        list.extend((!nearest).then_some(("tiles", 4.0 / f64::from(Self::TILE * Self::TILE))));
        list.extend(variant.coverage.then_some(("coverage", 4.0)));
        list.push(("picture", 4.0 * PictureBuffer::floats(variant.outputs) as f64));
        list
    }

    /// Side of a tile, px; as in `lib/pixels.glsl`.
    pub const TILE: u32 = 8;

    /// Number of tiles of a picture of `size` px.
    pub fn tiles(size: [u32; 2]) -> u64 {
        let [x, y] = size.map(|side| u64::from(side.div_ceil(Self::TILE)));
        x * y
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        self.picture.pixels()
    }

    /// Every target that there is.
    pub fn list(&self) -> Vec<TargetInfo> {
        let float = Format::R32_SFLOAT;
        let sums = |buffer: &Buffer| match buffer.size() == 4 * self.pixels() {
            true => float,
            false => Format::R32G32B32A32_SFLOAT,
        };
        let info = |name, buffer: &Buffer, format| TargetInfo { name, format, bytes: buffer.size() };
        let key = if self.tiles.is_some() { Format::R32_UINT } else { Format::R64_UINT };
        let mut list =
            vec![info("visibility", &self.visibility, key), info("sums0", &self.sums0, sums(&self.sums0))];
        list.extend(self.sums1.as_ref().map(|buffer| info("sums1", buffer, sums(buffer))));
        list.extend(self.tiles.as_ref().map(|tiles| info("tiles", tiles, Format::R32_UINT)));
        list.extend(self.coverage.as_ref().map(coverage_info));
        list.push(self.picture.info());
        list
    }
}

impl PictureBuffer {
    fn new(device: &Arc<Device>, outputs: Outputs, size: [u32; 2]) -> Result<Self> {
        let bytes = 4 * Self::floats(outputs) * u64::from(size[0]) * u64::from(size[1]);
        Ok(Self { buffer: Buffer::storage(device, "picture", bytes)?, outputs, size })
    }

    /// Floats of a pixel.
    fn floats(outputs: Outputs) -> u64 {
        4 + 3 * u64::from(outputs.normal) + u64::from(outputs.depth) + u64::from(outputs.id)
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    fn info(&self) -> TargetInfo {
        TargetInfo { name: "picture", format: Format::R32_SFLOAT, bytes: self.buffer.size() }
    }
}
