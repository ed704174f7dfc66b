//! Quantized surfels: 16 bytes each with 8-bit colours and curvatures, in the place of 36, in the layout of `shaders-glsl/lib/surfels.glsl`.
//!
//! 64 consecutive surfels, a cluster, share a [`Lattice`]: their coordinates are 15-bit integers, their radii half floats in its steps.
//! Clusters whose surfels are too far apart for that stay exact. Normals and major axes are octahedral codes ([`codes`]); where the scene has
//! curvatures, their codes ([`curvatures`]) are in the bits that coordinates and coarser normals leave.

mod codes;
mod curvatures;
mod lattice;
mod normals;

use super::{Clips, Curvature, Ellipse, Surfels};
use codes::AXIS;
use glam::Vec3;
pub(crate) use lattice::Lattice;
pub(crate) use normals::NormalCodes;
use rayon::prelude::*;

/// Format of the surfels of a scene on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SurfelFormat {
    /// 32-bit floats: 28 bytes a surfel, 4 for a curvature, and 16 for an ellipse.
    #[default]
    Float,
    /// Integers and half floats: 12 bytes a surfel, with or without a curvature, and 4 for an ellipse. See [`Surfels::quantized`] for the errors, and for the surfels that
    /// stay floats.
    Quantized,
}

impl SurfelFormat {
    /// Quantized or not.
    pub fn quantized(quantized: bool) -> Self {
        if quantized { Self::Quantized } else { Self::Float }
    }
}

/// Consecutive surfels that share a lattice, and that frames cull together: CLUSTER_SIZE of `lib/cluster.glsl`.
pub(crate) const CLUSTER: usize = 64;

/// Largest ratio of a radius to the exact one, rounded up.
pub(crate) const RADIUS_ROUNDING: f32 = 1.0005;

/// Largest code of an aspect.
const ASPECTS: f32 = 1023.0;

/// Codes of surfels.
pub(crate) struct Quantized {
    /// Cluster by cluster; `None` for exact ones.
    pub lattices: Vec<Option<Lattice>>,
    /// Coordinates in steps of the lattice, below the upper bits of the curvature, and the radius.
    pub positions: Vec<[u16; 4]>,
    pub normals: NormalCodes,
    pub ellipses: Option<Vec<u32>>,
    /// Clip lines in the tangent planes of the stored normals.
    pub clips: Option<Clips>,
}

/// Position, radius and normal of a surfel.
pub(crate) type Stored = (Vec3, f32, Vec3);

impl Quantized {
    /// The codes of `surfels` with these radii: negative for two-sided surfels, 0 for invalid ones. `None` for surfels that stay floats.
    pub fn of(surfels: &Surfels, radii: &[f32]) -> Option<Self> {
        if !surfels.is_quantizable() {
            return None;
        }
        let clusters = surfels.positions.par_chunks(CLUSTER).zip(radii.par_chunks(CLUSTER));
        let lattices: Vec<_> =
            clusters.map(|(positions, radii)| Lattice::of(positions.iter().zip(radii))).collect();
        let exact = lattices.iter().filter(|lattice| lattice.is_none()).count();
        if 2 * exact > lattices.len() {
            return None;
        }
        let position = |i: usize| {
            let lattice = lattices[i / CLUSTER].filter(|_| radii[i] != 0.0)?;
            lattice.code(surfels.positions[i], radii[i])
        };
        let mut positions: Vec<_> =
            (0..surfels.len()).into_par_iter().map(|i| position(i).unwrap_or_default()).collect();
        let radius = |i: usize, position| match &lattices[i / CLUSTER] {
            Some(lattice) => lattice.surfel(position).1,
            None => radii[i],
        };
        let curvatures = surfels.curvatures.as_ref();
        let word = |(i, position): (usize, &mut [u16; 4])| {
            let curvature = curvatures.map(|curvatures| (curvatures[i], radius(i, *position)));
            let (word, bits) = NormalCodes::code(surfels.normals[i], curvature);
            position.iter_mut().zip(bits).for_each(|(coordinate, bit)| *coordinate |= bit << 15);
            word
        };
        let words = positions.par_iter_mut().enumerate().map(word).collect();
        let normals = NormalCodes { words, with_curvatures: curvatures.is_some() };
        let shape = |ellipse: &Ellipse| {
            let aspect = (ellipse.aspect * ASPECTS).round().clamp(1.0, ASPECTS) as u32;
            AXIS.word(ellipse.major, 11) | aspect << 22
        };
        Some(Self {
            positions,
            ellipses: surfels.ellipses.as_ref().map(|ellipses| ellipses.par_iter().map(shape).collect()),
            clips: surfels.clips.as_ref().and_then(|clips| clips_within(clips, &normals)),
            normals,
            lattices,
        })
    }

    /// Curvature at surfel `i`, whose stored radius is this.
    fn curvature(&self, i: usize, radius: f32) -> Curvature {
        let [x, y, z, _] = self.positions[i];
        self.normals.curvature(i, [x, y, z].map(|coordinate| coordinate >> 15), radius)
    }

    /// Surfel `i` as the device decodes it; `exact` is its position and radius in an exact cluster.
    pub fn stored(&self, i: usize, (position, radius): (Vec3, f32)) -> Stored {
        let normal = self.normals.normal(i);
        match &self.lattices[i / CLUSTER] {
            Some(lattice) => {
                let (position, radius) = lattice.surfel(self.positions[i]);
                (position, radius, normal)
            }
            None => (position, radius, normal),
        }
    }
}

/// Clips in the tangent planes of these normals; a clip without a line is none.
fn clips_within(clips: &Clips, normals: &NormalCodes) -> Option<Clips> {
    Clips::collect((0..normals.words.len()).map(|i| clips.get(i)?.within(normals.normal(i))))
}

impl Surfels {
    /// Whether they have nothing that depends on exact discs.
    pub(crate) fn is_quantizable(&self) -> bool {
        self.weights.is_none()
    }

    /// The surfels as scenes of [`SurfelFormat::Quantized`] store them. Positions move by at most 1/128 of their radii and stay in their
    /// cells of every level of detail; normals turn by at most 0.005°, with curvatures by 0.085°, and major axes by 0.12°; radii change by at
    /// most 1/2048 of themselves, aspects by 1/2046 or up to 1/1023, curvatures in any direction by 0.3 of the larger principal curvature.
    ///
    /// What stays as it is: invalid surfels; positions and radii of 64 consecutive surfels that are too far apart for such small errors; and all
    /// surfels if that are more than half, as in arbitrary order, or with normalization weights.
    pub fn quantized(mut self) -> Self {
        let radius = |i| if self.is_valid(i) { self.radii[i] } else { 0.0 };
        let radii: Vec<_> = (0..self.len()).map(radius).collect();
        let Some(codes) = Quantized::of(&self, &radii) else { return self };
        for i in (0..self.len()).filter(|i| radii[*i] != 0.0) {
            (self.positions[i], self.radii[i], self.normals[i]) =
                codes.stored(i, (self.positions[i], radii[i]));
            if let Some(curvatures) = &mut self.curvatures {
                curvatures[i] = codes.curvature(i, self.radii[i]);
            }
            if let (Some(own), Some(ellipses), false) =
                (&mut self.ellipses, &codes.ellipses, self.normals[i] == Vec3::ZERO)
            {
                own[i] = ellipse_of(ellipses[i], self.normals[i]);
            }
        }
        self.clips = codes.clips;
        self
    }
}

/// The ellipse of a code, orthogonal to a unit normal.
fn ellipse_of(code: u32, normal: Vec3) -> Ellipse {
    let major = AXIS.direction(code, 11).reject_from_normalized(normal).normalize();
    Ellipse { major, aspect: (code >> 22) as f32 / ASPECTS }
}

#[cfg(test)]
mod tests;
