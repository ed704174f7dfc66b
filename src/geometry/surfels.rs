//! A set of surfels: oriented discs that sample a surface.

use super::{Clips, Materials, Texture, Weights};
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// Surfels as a structure of arrays; every array has one entry a surfel.
///
/// A surfel is a disc with centre, unit normal and radius. The radius is that of the disc which the splat covers: `r = F σ`, where `F`
/// is the cut-off and `σ` the kernel's 1-σ length. What is not [valid](Surfels::is_valid) is never drawn, and counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfels {
    /// Added to every position: the point that [`Surfels::positions`] are relative to, in the file's unit and frame. Keeps large
    /// (geodetic) coordinates exact while positions stay f32.
    pub origin: DVec3,
    /// Centres, relative to `origin`.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Radii of the covered discs, in the positions' unit; of elliptical discs, the longer semi-axes.
    pub radii: Vec<f32>,
    /// Shapes of the discs; all are circles where there are none.
    pub ellipses: Option<Vec<Ellipse>>,
    /// Surfels whose normals may as well point the other way, so that neither side is ever the back; none where there is no array.
    pub two_sided: Option<Vec<bool>>,
    /// Where discs end at sharp edges; all are whole where there are none.
    pub clips: Option<Clips>,
    /// What kernels are multiplied by where nothing is divided by their sum ([`crate::settings::splatting::Normalization::Surfel`]).
    pub weights: Option<Weights>,
    /// Colours, where the input has them.
    pub colours: Option<Colours>,
    /// What has the colours in place of [`Surfels::colours`].
    pub texture: Option<Texture>,
    /// How they shine, where pull–push lights them; all as the frame's lighting says where there are none.
    pub materials: Option<Materials>,
}

/// The shape of an elliptical disc whose longer semi-axis is the surfel's radius. The other axis is normal × major.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Ellipse {
    /// Direction of the longer axis: a unit vector at a right angle to the normal.
    pub major: Vec3,
    /// Shorter semi-axis divided by the longer, above 0 and at most 1.
    pub aspect: f32,
}

impl Ellipse {
    /// The circle of a disc with the unit normal `normal`; its major axis is any.
    pub fn circle(normal: Vec3) -> Self {
        Self { major: normal.any_orthonormal_vector(), aspect: 1.0 }
    }
}

/// One colour a surfel, in the form in which it came.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// sRGB-encoded, 8 bits a channel; the fourth byte is padding.
    Srgb8(Vec<[u8; 4]>),
    /// Linear light.
    Linear(Vec<[f32; 3]>),
}

impl Surfels {
    /// Number of surfels.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Refuses arrays of unequal length, an origin that is not finite, and clips, corners and materials that do not exist.
    ///
    /// # Errors
    /// [`Error::Usage`], with the array, the origin, the clip, the corners or the material.
    pub fn check(&self) -> Result<()> {
        if !self.origin.is_finite() {
            return Err(Error::Usage(format!("the surfels' origin is {}: give a finite one", self.origin)));
        }
        let count = self.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("radii", self.radii.len()),
            ("ellipses", self.ellipses.as_ref().map_or(count, Vec::len)),
            ("sides", self.two_sided.as_ref().map_or(count, Vec::len)),
            ("clips", self.clips.as_ref().map_or(count, |clips| clips.of.len())),
            ("weights", self.weights.as_ref().map_or(count, |weights| weights.of.len())),
            ("colours", self.colours.as_ref().map_or(count, Colours::len)),
            ("texture coordinates", self.texture.as_ref().map_or(count, |texture| texture.coordinates.len())),
            ("materials", self.materials.as_ref().map_or(count, |materials| materials.of.len())),
        ];
        if let Some((what, length)) = lengths.iter().find(|(_, length)| *length != count) {
            return Err(Error::Usage(format!("{count} positions and {length} {what}: give one a position")));
        }
        self.clips.as_ref().map_or(Ok(()), Clips::check)?;
        self.materials.as_ref().map_or(Ok(()), Materials::check)?;
        self.weights.as_ref().map_or(Ok(()), Weights::check)
    }

    /// Reorders every array: entry `i` of the result is entry `order[i]` of `self`.
    pub(crate) fn permute(&mut self, order: &[u32]) {
        fn gather<T: Copy + Send + Sync>(values: &mut Vec<T>, order: &[u32]) {
            use rayon::prelude::*;
            *values = order.par_iter().map(|&i| values[i as usize]).collect();
        }
        gather(&mut self.positions, order);
        gather(&mut self.normals, order);
        gather(&mut self.radii, order);
        self.ellipses.iter_mut().for_each(|ellipses| gather(ellipses, order));
        self.two_sided.iter_mut().for_each(|two_sided| gather(two_sided, order));
        self.clips.iter_mut().for_each(|clips| clips.permute(order));
        self.weights.iter_mut().for_each(|weights| weights.permute(order));
        self.texture.iter_mut().for_each(|texture| gather(&mut texture.coordinates, order));
        self.materials.iter_mut().for_each(|materials| gather(&mut materials.of, order));
        match &mut self.colours {
            Some(Colours::Srgb8(colours)) => gather(colours, order),
            Some(Colours::Linear(colours)) => gather(colours, order),
            None => {}
        }
    }
}

impl Colours {
    /// Those at `indices`, in that order.
    pub(crate) fn gather(&self, indices: &[u32]) -> Self {
        match self {
            Self::Srgb8(codes) => Self::Srgb8(indices.iter().map(|&i| codes[i as usize]).collect()),
            Self::Linear(linear) => Self::Linear(indices.iter().map(|&i| linear[i as usize]).collect()),
        }
    }

    /// Number of colours.
    pub fn len(&self) -> usize {
        match self {
            Self::Srgb8(colours) => colours.len(),
            Self::Linear(colours) => colours.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
