//! Coarser surfels: fewer and larger discs of the same surface, for quick previews.

use super::{Colours, Ellipse, Surfels, morton};
use crate::geometry::srgb;
use glam::Vec3;
use rayon::prelude::*;
use std::array;

/// One disc in place of several.
struct Merged {
    position: Vec3,
    normal: Vec3,
    radius: f32,
    /// Linear light.
    colour: [f32; 3],
    two_sided: bool,
    /// Index of the surfel that is nearest to the centre.
    nearest: u32,
}

impl Surfels {
    /// About `count` surfels that cover the same surface, in Morton order. Surfels in a cell of the Z-curve with normals on one side of a
    /// plane become one, with the means of position, normal and colour, weighted by area, and a radius that reaches the far ends of their
    /// discs. The result may have down to a third of `count`, depending on the occupied cells, and a few more where a surface is thinner
    /// than a cell.
    ///
    /// Discs are circles without clips and weights; texture coordinates and materials are those of one of the merged surfels. Invalid
    /// surfels ([`Surfels::is_valid`]) are removed.
    pub fn coarser(&self, count: usize) -> Self {
        let keys = morton::keys(&self.positions);
        let bits = bits(&keys, count);
        let cells: Vec<&[(u64, u32)]> = keys.chunk_by(|a, b| prefix(a.0 ^ b.0, bits) == 0).collect();
        let light = srgb::decode_table();
        let merged: Vec<Merged> = cells
            .par_iter()
            .flat_map_iter(|cell| self.merge_cell(cell, &light).into_iter().flatten())
            .collect();
        self.of_merged(&merged)
    }

    /// The discs of a cell, one per side.
    fn merge_cell(&self, cell: &[(u64, u32)], light: &[f32; 256]) -> [Option<Merged>; 2] {
        let valid = || cell.iter().map(|&(_, i)| i).filter(|&i| self.is_valid(i as usize));
        let Some(first) = valid().next() else { return [None, None] };
        let reference = self.normals[first as usize];
        let faces = |i: u32| self.normals[i as usize].dot(reference) >= 0.0 || self.is_two_sided(i);
        let merge = |side: bool| self.merge_discs(|| valid().filter(|&i| faces(i) == side), reference, light);
        [merge(true), merge(false)]
    }

    fn merge_discs<I: Iterator<Item = u32>>(
        &self,
        members: impl Fn() -> I,
        reference: Vec3,
        light: &[f32; 256],
    ) -> Option<Merged> {
        let first = members().next()?;
        // Relative to one surfel and in units of its radius, so that nothing overflows or loses precision.
        let [at, unit] = [self.positions[first as usize], Vec3::splat(self.radii[first as usize])];
        let (mut offset, mut normal, mut colour, mut weight) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, 0.0);
        let mut two_sided = false;
        for i in members() {
            let own = self.normals[i as usize];
            let turned = self.is_two_sided(i) && own.dot(reference) < 0.0;
            let area = (self.radii[i as usize] / unit.x).powi(2).max(f32::MIN_POSITIVE);
            offset += area * (self.positions[i as usize] - at);
            normal += area * if turned { -own } else { own };
            colour += area * self.light(i, light);
            weight += area;
            two_sided |= self.is_two_sided(i);
        }
        let position = at + offset / weight;
        let normal = normal.try_normalize().unwrap_or(self.normals[first as usize]);
        let (mut radius, mut nearest) = (0.0f32, (f32::INFINITY, first));
        for i in members() {
            let way = self.positions[i as usize] - position;
            let within = way - way.dot(normal) * normal;
            radius = radius.max(within.length() + self.radii[i as usize]);
            if way.length() < nearest.0 {
                nearest = (way.length(), i);
            }
        }
        let colour = (colour / weight).to_array();
        let merged = Merged { position, normal, radius, colour, two_sided, nearest: nearest.1 };
        (position.is_finite() && radius.is_finite()).then_some(merged)
    }

    pub(super) fn is_two_sided(&self, i: u32) -> bool {
        self.two_sided.as_ref().is_some_and(|two_sided| two_sided[i as usize])
    }

    /// The colour in linear light; 0 without colours.
    pub(super) fn light(&self, i: u32, light: &[f32; 256]) -> Vec3 {
        match &self.colours {
            Some(Colours::Srgb8(codes)) => {
                let code = codes[i as usize];
                Vec3::from_array(array::from_fn(|channel| light[usize::from(code[channel])]))
            }
            Some(Colours::Linear(linear)) => linear[i as usize].into(),
            None => Vec3::ZERO,
        }
    }

    /// Surfels of `merged` discs with the streams of `self`.
    fn of_merged(&self, merged: &[Merged]) -> Self {
        let nearest: Vec<u32> = merged.iter().map(|disc| disc.nearest).collect();
        let code = |disc: &Merged| {
            let [r, g, b] = disc.colour.map(srgb::encode8);
            [r, g, b, u8::MAX]
        };
        Self {
            origin: self.origin,
            positions: merged.iter().map(|disc| disc.position).collect(),
            normals: merged.iter().map(|disc| disc.normal).collect(),
            radii: merged.iter().map(|disc| disc.radius).collect(),
            ellipses: self
                .ellipses
                .is_some()
                .then(|| merged.iter().map(|disc| Ellipse::circle(disc.normal)).collect()),
            two_sided: self.two_sided.is_some().then(|| merged.iter().map(|disc| disc.two_sided).collect()),
            colours: self.colours.as_ref().map(|colours| match colours {
                Colours::Srgb8(_) => Colours::Srgb8(merged.par_iter().map(code).collect()),
                Colours::Linear(_) => Colours::Linear(merged.iter().map(|disc| disc.colour).collect()),
            }),
            texture: self.texture.as_ref().map(|texture| texture.gather(&nearest)),
            materials: self.materials.as_ref().map(|materials| materials.gather(&nearest)),
            curvatures: None,
            clips: None,
            weights: None,
        }
    }
}

/// The first `bits` of a 63-bit key, or of the difference of two keys.
fn prefix(key: u64, bits: u32) -> u64 {
    (key << 1).checked_shr(64 - bits).unwrap_or(0)
}

/// Number of leading bits in which sorted keys form at most `count` cells.
fn bits(keys: &[(u64, u32)], count: usize) -> u32 {
    // Number of neighbours whose first difference is at each bit, bit 1 being the first.
    let mut differ = [0usize; 65];
    for pair in keys.windows(2) {
        differ[(pair[0].0 ^ pair[1].0).leading_zeros() as usize] += 1;
    }
    let mut boxes = 1;
    // Keys have 63 bits; the first of 64 is 0.
    (0..63)
        .take_while(|bit| {
            boxes += differ[*bit as usize + 1];
            boxes <= count
        })
        .count() as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::scenes;

    /// Whether discs of `few` cover the disc of surfel `i` of `all`, one of them facing the same way.
    fn covers(few: &Surfels, all: &Surfels, i: usize) -> bool {
        (0..few.len()).any(|disc| {
            let (normal, way) = (few.normals[disc], all.positions[i] - few.positions[disc]);
            let within = (way - way.dot(normal) * normal).length() + all.radii[i];
            normal.dot(all.normals[i]) > 0.0 && within <= few.radii[disc] * (1.0 + 1e-5)
        })
    }

    #[test]
    fn fewer_discs_cover_every_disc_and_stay_on_the_surface() {
        let all = scenes::open("scene:bumpy-sphere?points=20000").unwrap();
        for count in [8000, 2000, 500] {
            let few = all.coarser(count);
            assert!(few.len() <= count + count / 20 && 3 * few.len() > count, "{} of {count}", few.len());
            assert_eq!((few.check().is_ok(), few.count_invalid()), (true, 0));
            let missed = (0..all.len()).step_by(37).filter(|&i| !covers(&few, &all, i)).count();
            assert_eq!(missed, 0, "{count}");
            // No larger than boxes of the sphere's surface that are as many.
            let radius = (4.0 * std::f32::consts::PI / few.len() as f32).sqrt();
            let mut radii = few.radii.clone();
            radii.sort_unstable_by(f32::total_cmp);
            assert!(radii[radii.len() / 2] < 1.5 * radius, "{} {radius}", radii[radii.len() / 2]);
        }
    }

    #[test]
    fn two_sides_of_a_sheet_stay_two_and_colours_are_those_of_their_light() {
        let normals = vec![Vec3::Z, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Z];
        let sheet = Surfels {
            positions: [0.0, 1.0, 0.0, 1.0].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec(),
            radii: vec![0.5; 4],
            colours: Some(Colours::Srgb8(vec![[0; 4], [255; 4], [255, 0, 0, 0], [255, 0, 0, 0]])),
            two_sided: Some(vec![false; 4]),
            normals,
            ..Default::default()
        };
        let two = sheet.coarser(1);
        assert_eq!((two.len(), &two.normals), (2, &vec![Vec3::Z, Vec3::NEG_Z]));
        assert_eq!((two.positions[0], two.radii[0]), (Vec3::new(0.5, 0.0, 0.0), 1.0));
        let Some(Colours::Srgb8(colours)) = &two.colours else { panic!("no codes") };
        assert_eq!(colours[0][..3], [188; 3]);
        assert_eq!(colours[1][..3], [255, 0, 0]);
        let one = Surfels { two_sided: Some(vec![true; 4]), ..sheet.clone() }.coarser(1);
        assert_eq!((one.len(), one.two_sided), (1, Some(vec![true])));
        assert_eq!(sheet.coarser(100).len(), 4);
    }

    #[test]
    fn what_is_invalid_is_left_out() {
        let all = scenes::open("scene:sphere?points=1000").unwrap();
        let mut broken = all.clone();
        (broken.positions[3].x, broken.radii[7], broken.normals[9]) = (f32::NAN, 0.0, Vec3::ZERO);
        assert_eq!(broken.coarser(2000).len(), 997);
        assert!(broken.coarser(0).len() <= 2);
        assert!(Surfels::default().coarser(5).is_empty());
    }
}
