//! Every render target: name, format, and when a frame has it.

use crate::error::{Error, Result};
use crate::scene::ColourStream;
use crate::variant::{Precision, Variant};
use crate::vk::{Device, Image, ImageUse};
use ash::vk::Format;
use std::sync::Arc;

/// The targets of a frame of `perspective-ewa`.
pub struct Targets {
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
}

/// Format of each target of a [`Variant`]; `None` where there is no such target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// See [`Targets::visibility`].
    pub visibility: Format,
    /// See [`Targets::sums0`].
    pub sums0: Format,
    /// See [`Targets::sums1`].
    pub sums1: Option<Format>,
    /// See [`Targets::image`].
    pub image: Format,
    /// See [`Targets::normal`].
    pub normal: Option<Format>,
    /// See [`Targets::depth`].
    pub depth: Option<Format>,
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
        let colours = variant.colours != ColourStream::None;
        let both = variant.normals && colours;
        Self {
            visibility: Format::D32_SFLOAT,
            sums0: sums(variant.normals || colours),
            sums1: (both || variant.depth).then(|| sums(both)),
            image: Format::R32G32B32A32_SFLOAT,
            normal: variant.outputs.normal.then_some(Format::R32G32B32A32_SFLOAT),
            depth: variant.outputs.depth.then_some(Format::R32_SFLOAT),
        }
    }
}

impl Targets {
    /// The targets of `variant` at `size` px. [`Error::Usage`] with the limit if the device has no targets of that size.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let limit = device.capabilities().max_image_side;
        let [width, height] = size;
        if size.contains(&0) || size.iter().any(|side| *side > limit) {
            let name = &device.description().name;
            return Err(Error::Usage(format!(
                "a picture of {width}x{height} px: {name} draws from 1x1 to {limit}x{limit}"
            )));
        }
        let formats = Formats::of(variant);
        let target = |name, format, also| Image::target(device, name, format, size, also);
        let optional =
            |name, format: Option<Format>, also| format.map(|format| target(name, format, also)).transpose();
        Ok(Self {
            visibility: target("visibility", formats.visibility, ImageUse::Sampled)?,
            sums0: target("sums0", formats.sums0, ImageUse::Sampled)?,
            sums1: optional("sums1", formats.sums1, ImageUse::Sampled)?,
            image: target("image", formats.image, ImageUse::Copied)?,
            normal: optional("normal", formats.normal, ImageUse::Copied)?,
            depth: optional("depth", formats.depth, ImageUse::Copied)?,
        })
    }

    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        self.image.size()
    }

    /// Every target that there is, with its name.
    pub fn list(&self) -> impl Iterator<Item = (&'static str, &Image)> {
        let always = [("visibility", &self.visibility), ("sums0", &self.sums0), ("image", &self.image)];
        let optional = [("sums1", &self.sums1), ("normal", &self.normal), ("depth", &self.depth)];
        always
            .into_iter()
            .chain(optional.into_iter().filter_map(|(name, image)| Some((name, image.as_ref()?))))
    }

    /// The targets that are read on the CPU.
    pub(crate) fn read_back(&self) -> impl Iterator<Item = &Image> {
        [Some(&self.image), self.normal.as_ref(), self.depth.as_ref()].into_iter().flatten()
    }
}
