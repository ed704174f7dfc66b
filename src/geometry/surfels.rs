//! Surfels: oriented discs that sample a surface.

use super::{Clips, Curvature, Materials, Texture, Weights, srgb};
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// Surfels as a structure of arrays; every array has one entry per surfel.
///
/// A surfel is a disc with centre, unit normal and radius. The radius is the extent of the splat: `r = F σ`, with the cut-off `F` and the
/// kernel's standard deviation `σ`. A surfel whose normal is 0 is a billboard, which faces the eye. Invalid surfels ([`Surfels::is_valid`]) are not drawn, and are counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfels {
    /// Origin of [`Surfels::positions`], in the file's unit and frame: keeps large (geodetic) coordinates exact while positions are f32.
    pub origin: DVec3,
    /// Centres, relative to `origin`.
    pub positions: Vec<Vec3>,
    /// Unit normals, or 0 for billboards ([`Surfels::is_billboard`]).
    pub normals: Vec<Vec3>,
    /// Radii of the discs, in the positions' unit; of elliptical discs, the longer semi-axes.
    pub radii: Vec<f32>,
    /// Shapes of the discs; `None` if all are circles.
    pub ellipses: Option<Vec<Ellipse>>,
    /// Normal curvatures of the surface at the centres; `None` if all are unknown. With coverage, discs end where a convex surface turns away
    /// from the eye; with [`Shade::NormalField`](crate::settings::splatting::Shade::NormalField), normals vary over discs.
    pub curvatures: Option<Vec<Curvature>>,
    /// Surfels that are two-sided, so that neither side is the back; `None` if there are none.
    pub two_sided: Option<Vec<bool>>,
    /// Clip lines of discs at sharp edges; `None` if all are whole.
    pub clips: Option<Clips>,
    /// Factors of the kernels for sums without division ([`crate::settings::splatting::Normalization::Surfel`]).
    pub weights: Option<Weights>,
    /// Colours, if the input has them.
    pub colours: Option<Colours>,
    /// Texture, in place of [`Surfels::colours`].
    pub texture: Option<Texture>,
    /// Materials for the lighting of pull–push; `None` if all have the frame's.
    pub materials: Option<Materials>,
    /// Index of each surfel's point in the inputs, one after the other, or [`Surfels::NO_POINT`]; `None` if it is not known.
    pub point_indices: Option<Vec<u32>>,
}

/// Shape of an elliptical disc whose longer semi-axis is the surfel's radius. The other axis is normal × major.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Ellipse {
    /// Direction of the longer axis: a unit vector orthogonal to the normal.
    pub major: Vec3,
    /// Shorter semi-axis divided by the longer one, above 0 and at most 1.
    pub aspect: f32,
}

impl Ellipse {
    /// Both semi-axes of a disc with this unit normal and radius, the longer one first.
    pub fn semi_axes(&self, normal: Vec3, radius: f32) -> [Vec3; 2] {
        [self.major * radius, normal.cross(self.major) * (radius * self.aspect)]
    }

    /// A circle with the unit normal `normal` and an arbitrary major axis.
    pub fn circle(normal: Vec3) -> Self {
        Self { major: normal.any_orthonormal_vector(), aspect: 1.0 }
    }
}

/// One colour per surfel.
#[derive(Clone, Debug, PartialEq)]
pub enum Colours {
    /// sRGB-encoded, 8 bits per channel; the fourth byte is padding.
    Srgb8(Vec<[u8; 4]>),
    /// Linear light.
    Linear(Vec<[f32; 3]>),
}

impl Colours {
    /// The colour of surfel `i`, linear light.
    pub(crate) fn light(&self, i: usize) -> DVec3 {
        match self {
            Self::Linear(linear) => DVec3::from_array(linear[i].map(f64::from)),
            Self::Srgb8(codes) => {
                let [r, g, b, _] = codes[i].map(|code| srgb::decode(f64::from(code) / 255.0));
                DVec3::new(r, g, b)
            }
        }
    }
}

impl Surfels {
    /// Index of a surfel that is no point of the inputs.
    pub const NO_POINT: u32 = u32::MAX;

    /// Number of surfels.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Whether surfel `index` is a billboard: a circle that faces the eye of every frame, for a point on no surface. Its normal is 0. `false`
    /// beyond the end.
    pub fn is_billboard(&self, index: usize) -> bool {
        self.normals.get(index) == Some(&Vec3::ZERO)
    }

    /// Validates the lengths of the arrays, the origin, and the indices of clips, corner weights and materials.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the array, origin, clip, corner weight or material.
    pub fn check(&self) -> Result<()> {
        if !self.origin.is_finite() {
            return Err(Error::Usage(format!("the surfels' origin is {}: give a finite one", self.origin)));
        }
        let count = self.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("radii", self.radii.len()),
            ("ellipses", self.ellipses.as_ref().map_or(count, Vec::len)),
            ("curvatures", self.curvatures.as_ref().map_or(count, Vec::len)),
            ("sides", self.two_sided.as_ref().map_or(count, Vec::len)),
            ("clips", self.clips.as_ref().map_or(count, |clips| clips.of.len())),
            ("weights", self.weights.as_ref().map_or(count, |weights| weights.of.len())),
            ("colours", self.colours.as_ref().map_or(count, Colours::len)),
            ("texture coordinates", self.texture.as_ref().map_or(count, |texture| texture.coordinates.len())),
            ("materials", self.materials.as_ref().map_or(count, |materials| materials.of.len())),
            ("indices of points", self.point_indices.as_ref().map_or(count, Vec::len)),
        ];
        if let Some((what, length)) = lengths.iter().find(|(_, length)| *length != count) {
            return Err(Error::Usage(format!(
                "{count} positions and {length} {what}: give one per position"
            )));
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
        self.curvatures.iter_mut().for_each(|curvatures| gather(curvatures, order));
        self.two_sided.iter_mut().for_each(|two_sided| gather(two_sided, order));
        self.clips.iter_mut().for_each(|clips| clips.permute(order));
        self.weights.iter_mut().for_each(|weights| weights.permute(order));
        self.texture.iter_mut().for_each(|texture| gather(&mut texture.coordinates, order));
        self.materials.iter_mut().for_each(|materials| gather(&mut materials.of, order));
        self.point_indices.iter_mut().for_each(|indices| gather(indices, order));
        match &mut self.colours {
            Some(Colours::Srgb8(colours)) => gather(colours, order),
            Some(Colours::Linear(colours)) => gather(colours, order),
            None => {}
        }
    }
}

impl Colours {
    /// The colours at `indices`, in that order.
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
