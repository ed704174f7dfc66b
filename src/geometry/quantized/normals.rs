//! Codes of normals, alone or with curvatures.

use super::codes::{COARSE_NORMAL, NORMAL};
use super::curvatures;
use crate::geometry::Curvature;
use glam::Vec3;

/// Code of the normal of a billboard: NO_NORMAL of `lib/surfels.glsl`.
const NO_NORMAL: u32 = 0x8000_8000;
/// The same with curvatures: NO_COARSE_NORMAL of `lib/surfels.glsl`.
const NO_COARSE_NORMAL: u32 = u32::MAX;

/// Bits of the code of a curvature beside a normal.
pub const BITS: u32 = 9;
const _: () = assert!(curvatures::CODES <= 1 << (BITS + 3), "a bit above each coordinate is left");

/// Normals, one word each.
#[derive(Debug)]
pub(crate) struct NormalCodes {
    pub words: Vec<u32>,
    /// Octahedral codes of 23 bits above the lower bits of curvatures, in the place of octahedral codes of 16 bits a coordinate.
    pub with_curvatures: bool,
}

impl NormalCodes {
    /// Word of a normal, or 0 for a billboard, and the upper bits of the code of the curvature, which is that of a disc with this stored radius.
    pub fn code(normal: Vec3, curvature: Option<(Curvature, f32)>) -> (u32, [u16; 3]) {
        let alone = |word| (word, [0; 3]);
        match curvature {
            None if normal == Vec3::ZERO => alone(NO_NORMAL),
            None => alone(NORMAL.word(normal, 16)),
            Some(_) if normal == Vec3::ZERO => alone(NO_COARSE_NORMAL),
            Some((curvature, radius)) => {
                let pair = COARSE_NORMAL.pair(normal);
                let stored = COARSE_NORMAL.direction_of_pair(pair).normalize();
                let code = curvatures::code(curvature.turned(normal.as_dvec3(), stored.as_dvec3()), radius);
                let bits = [0, 1, 2].map(|bit| (code >> (BITS + bit) & 1) as u16);
                (pair << BITS | code & ((1 << BITS) - 1), bits)
            }
        }
    }

    /// Normal of surfel `i`, a unit vector, or 0.
    pub fn normal(&self, i: usize) -> Vec3 {
        match self.words[i] {
            NO_NORMAL if !self.with_curvatures => Vec3::ZERO,
            NO_COARSE_NORMAL if self.with_curvatures => Vec3::ZERO,
            word if self.with_curvatures => COARSE_NORMAL.direction_of_pair(word >> BITS).normalize(),
            word => NORMAL.direction(word, 16).normalize(),
        }
    }

    /// Curvature at surfel `i`, whose stored radius is this, with the upper bits of its code.
    pub fn curvature(&self, i: usize, bits: [u16; 3], radius: f32) -> Curvature {
        let word = self.words[i];
        if !self.with_curvatures || word == NO_COARSE_NORMAL {
            return Curvature::default();
        }
        let upper = bits.iter().rev().fold(0, |upper, bit| upper << 1 | u32::from(*bit));
        curvatures::curvature(upper << BITS | word & ((1 << BITS) - 1), radius)
    }
}
