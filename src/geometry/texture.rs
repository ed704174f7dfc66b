//! Textures.

use super::Colours;
use crate::error::{Error, Result};
use crate::geometry::srgb;
use crate::picture::Picture;
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::sync::Arc;

/// A texture and coordinates in it, one entry per point.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The texture's levels.
    pub image: Arc<MipMap>,
    /// u to the right, v upwards, from 0 to 1 between the edges; the texture repeats.
    pub coordinates: Vec<Vec2>,
}

/// A mip map (Williams, *Pyramidal Parametrics*, SIGGRAPH 1983).
#[derive(Clone, Debug, PartialEq)]
pub struct MipMap {
    size: [u32; 2],
    /// Texels of all levels, fine to coarse, each row by row from the top left.
    texels: Colours,
}

/// Maximum number of point pairs in the estimate of a texture's density.
const PAIRS: usize = 1 << 12;

impl Texture {
    /// Coordinates at `indices`, in that order.
    pub(crate) fn gather(&self, indices: &[u32]) -> Self {
        let coordinates = indices.iter().map(|&i| self.coordinates[i as usize]).collect();
        Self { image: self.image.clone(), coordinates }
    }

    /// Joins parts that share one mip map; otherwise `None`.
    pub(super) fn join<'a>(mut parts: impl Iterator<Item = Option<&'a Self>> + Clone) -> Option<Self> {
        let image = parts.clone().flatten().next()?.image.clone();
        let same = |part: Option<&Self>| part.is_some_and(|part| part.image == image);
        if !parts.clone().all(same) {
            return None;
        }
        let coordinates =
            parts.by_ref().flatten().flat_map(|part| part.coordinates.iter().copied()).collect();
        Some(Self { image, coordinates })
    }

    /// Colours of the points for methods that blend one colour per point: linear, from the level whose texels are as large as the disc's
    /// radius, or without radii as the distance between points.
    pub(crate) fn colours(&self, positions: &[Vec3], radii: Option<&[f32]>) -> Vec<[f32; 3]> {
        let [density, spacing] = self.density(positions);
        let colour = |(i, at): (usize, &Vec2)| {
            let radius = radii.map_or(0.0, |radii| f64::from(radii[i]));
            let reach = if radius > 0.0 { radius } else { spacing };
            self.image.sample(at.as_dvec2(), (density * reach).log2()).as_vec3().to_array()
        };
        self.coordinates.par_iter().enumerate().map(colour).collect()
    }

    /// The same in the texture's own encoding.
    pub(crate) fn baked(&self, positions: &[Vec3], radii: Option<&[f32]>) -> Colours {
        let linear = self.colours(positions, radii);
        match self.image.texels {
            Colours::Srgb8(_) => Colours::Srgb8(linear.par_iter().map(code).collect()),
            Colours::Linear(_) => Colours::Linear(linear),
        }
    }

    /// Texels of the finest level per unit of length, and distance between points: medians over consecutive points.
    fn density(&self, positions: &[Vec3]) -> [f64; 2] {
        let size = DVec2::from(self.image.size.map(f64::from));
        let step = positions.len().div_ceil(PAIRS).max(1);
        let pairs = (0..positions.len().saturating_sub(1)).step_by(step);
        let mut found: Vec<[f64; 2]> = pairs
            .map(|i| {
                let [a, b] = [i, i + 1].map(|i| self.coordinates[i].as_dvec2());
                let apart = f64::from(positions[i].distance(positions[i + 1]));
                [((b - a - (b - a).round()) * size).length() / apart, apart]
            })
            .filter(|pair| pair.iter().all(|value| value.is_finite() && *value > 0.0))
            .collect();
        let middle = found.len() / 2;
        let mut median = |k: usize| {
            found.sort_unstable_by(|a, b| a[k].total_cmp(&b[k]));
            found.get(middle).map_or(0.0, |pair| pair[k])
        };
        [median(0), median(1)]
    }
}

impl MipMap {
    /// Creates the mip map of a linear picture; its α is ignored. Colours that 8-bit sRGB represents exactly are stored that way.
    ///
    /// # Errors
    /// [`Error::Usage`] if the number of pixels is 0 or differs from `picture.size`.
    pub fn new(picture: &Picture) -> Result<Self> {
        let (size, pixels) = (picture.size, picture.colour.len());
        if pixels == 0 || pixels as u64 != u64::from(size[0]) * u64::from(size[1]) {
            return Err(Error::Usage(format!(
                "{pixels} pixels for a texture of {}×{} px: give that many, at least one",
                size[0], size[1]
            )));
        }
        let finest: Vec<[f32; 3]> = picture.colour.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        let decode = |code: u8| srgb::decode(f64::from(code) / 255.0) as f32;
        let exact = |colour: &[f32; 3]| colour.iter().all(|&value| decode(srgb::encode8(value)) == value);
        let coded = finest.par_iter().all(exact);
        let mut texels = finest.clone();
        let mut level = (finest, size);
        while level.1 != [1, 1] {
            level = halved(|i| level.0[i], level.1);
            texels.extend_from_slice(&level.0);
        }
        let texels = if coded {
            Colours::Srgb8(texels.par_iter().map(code).collect())
        } else {
            Colours::Linear(texels)
        };
        Ok(Self { size, texels })
    }

    /// Number of levels, down to one texel.
    pub fn levels(&self) -> u32 {
        1 + self.size[0].max(self.size[1]).ilog2()
    }

    /// Width and height of a level, texels.
    pub fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }

    /// Texels of all levels, fine to coarse, each row by row from the top left.
    pub fn texels(&self) -> &Colours {
        &self.texels
    }

    /// The colour at texture coordinates, linear, trilinearly filtered. Levels below 0 are the finest, levels beyond the last are the
    /// coarsest.
    pub fn sample(&self, at: DVec2, level: f64) -> DVec3 {
        // NaN is the finest level.
        let level = if level > 0.0 { level.min(f64::from(self.levels() - 1)) } else { 0.0 };
        let (finer, part) = (level as u32, level.fract());
        let colour = self.bilinear(at, finer);
        if part > 0.0 { colour.lerp(self.bilinear(at, finer + 1), part) } else { colour }
    }

    fn bilinear(&self, at: DVec2, level: u32) -> DVec3 {
        let size = self.level_size(level);
        let first: usize = (0..level)
            .map(|level| self.level_size(level).map(|side| side as usize))
            .map(|[w, h]| w * h)
            .sum();
        let (texels, part) = texels_around(at, size);
        let [upper, lower] = texels
            .map(|row| row.map(|i| self.texels.light(first + i)))
            .map(|[left, right]| left.lerp(right, part.x));
        upper.lerp(lower, part.y)
    }
}

/// The four texels about texture coordinates, in rows of a picture of this size that repeats, and the place between their centres.
pub(super) fn texels_around(at: DVec2, size: [u32; 2]) -> ([[usize; 2]; 2], DVec2) {
    let at = DVec2::new(at.x - at.x.floor(), 1.0 - (at.y - at.y.floor()));
    let place = at * DVec2::from(size.map(f64::from)) - 0.5;
    let corner = place.floor();
    let texel = |dx: i64, dy: i64| {
        let [x, y] = [(corner.x as i64 + dx, size[0]), (corner.y as i64 + dy, size[1])]
            .map(|(i, side)| i.rem_euclid(side.into()) as usize);
        y * size[0] as usize + x
    };
    ([0, 1].map(|dy| [0, 1].map(|dx| texel(dx, dy))), place - corner)
}

/// The sRGB code of a colour.
fn code(&[r, g, b]: &[f32; 3]) -> [u8; 4] {
    let [r, g, b] = [r, g, b].map(srgb::encode8);
    [r, g, b, 0]
}

/// The next coarser level: each texel is the mean of the texels that it covers, weighted by area.
pub(super) fn halved<const N: usize>(
    texels: impl Fn(usize) -> [f32; N] + Sync,
    [width, height]: [u32; 2],
) -> (Vec<[f32; N]>, [u32; 2]) {
    let size = [width, height].map(|side| (side / 2).max(1));
    let [columns, rows] = [shares(width, size[0]), shares(height, size[1])];
    let mean = |i: usize| {
        let (row, column) = (&rows[i / columns.len()], &columns[i % columns.len()]);
        let mut sum = [0.0; N];
        for ((y, h), (x, w)) in row.iter().flat_map(|y| column.iter().map(move |x| (y, x))) {
            let texel = texels(y * width as usize + x);
            sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += h * w * value);
        }
        sum
    };
    ((0..columns.len() * rows.len()).into_par_iter().map(mean).collect(), size)
}

/// For each of `to` equal parts of `from` texels, the texels that it covers and their shares.
fn shares(from: u32, to: u32) -> Vec<Vec<(usize, f32)>> {
    let side = f64::from(from) / f64::from(to);
    let part = |i: u32| {
        let [low, high] = [i, i + 1].map(|i| f64::from(i) * side);
        let covered = |k: u32| high.min(f64::from(k + 1)) - low.max(f64::from(k));
        let all = low as u32..(high.ceil() as u32).min(from);
        all.map(|k| (k as usize, (covered(k) / side) as f32)).collect()
    };
    (0..to).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: [u32; 2], colour: impl Fn(u32, u32) -> f32) -> Picture {
        let pixel = |i: u32| {
            let grey = colour(i % size[0], i / size[0]);
            [grey, grey, grey, 1.0]
        };
        Picture { size, colour: (0..size[0] * size[1]).map(pixel).collect(), ..Default::default() }
    }

    fn red(image: &MipMap, at: [f64; 2], level: f64) -> f64 {
        image.sample(at.into(), level).x
    }

    #[test]
    fn v_points_upwards_and_the_picture_is_repeated() {
        let image = MipMap::new(&picture([4, 2], |x, y| (4 * y + x) as f32)).unwrap();
        // The texel in the lower left corner.
        for turns in [[0.0, 0.0], [3.0, -2.0]] {
            let at = |u: f64, v: f64| [u + turns[0], v + turns[1]];
            assert_eq!(red(&image, at(0.125, 0.25), 0.0), 4.0);
            assert_eq!(red(&image, at(0.875, 0.75), 0.0), 3.0);
            assert_eq!(red(&image, at(0.25, 0.75), 0.0), 0.5, "half way between two centres");
            assert_eq!(red(&image, at(0.0, 0.75), 0.0), 1.5, "between the last and the first");
        }
    }

    #[test]
    fn coarser_levels_are_means_of_what_they_cover() {
        let image = MipMap::new(&picture([5, 3], |x, y| (5 * y + x) as f32 + 0.25)).unwrap();
        let sizes: Vec<_> = (0..image.levels()).map(|level| image.level_size(level)).collect();
        assert_eq!(sizes, [[5, 3], [2, 1], [1, 1]]);
        // Columns 0, 1 and half of 2; the mean of all is in the middle.
        let left = (0.0 + 1.0 + 0.5 * 2.0) / 2.5 + 5.25;
        assert!((red(&image, [0.25, 0.5], 1.0) - left).abs() < 1e-5);
        for level in [2.0, 9.0] {
            assert!((red(&image, [0.3, 0.9], level) - 7.25).abs() < 1e-5);
        }
        assert!((red(&image, [0.25, 0.5], 1.5) - 0.5 * (left + 7.25)).abs() < 1e-5);
        assert_eq!(red(&image, [0.1, 0.5], f64::NAN), 5.25);
    }

    #[test]
    fn codes_stay_codes() {
        let half = srgb::decode(128.0 / 255.0) as f32;
        let texels = |value: f32| MipMap::new(&picture([1, 1], |_, _| value)).unwrap().texels;
        assert_eq!(texels(half), Colours::Srgb8(vec![[128, 128, 128, 0]]));
        assert_eq!(texels(2.5), Colours::Linear(vec![[2.5; 3]]));
        assert!(MipMap::new(&Picture { size: [2, 1], ..picture([1, 1], |_, _| 0.0) }).is_err());
    }

    #[test]
    fn colours_of_large_discs_are_means() {
        let image = Arc::new(MipMap::new(&picture([64, 64], |x, y| ((x + y) % 2) as f32)).unwrap());
        let positions: Vec<Vec3> = (0..100).map(|i| Vec3::new(i as f32 * 0.01, 0.0, 0.0)).collect();
        let coordinates = positions.iter().map(|p| Vec2::new(p.x, 0.5 / 64.0)).collect();
        let texture = Texture { image, coordinates };
        // 64 texels a unit.
        let [density, spacing] = texture.density(&positions);
        assert!((density - 64.0).abs() < 0.01 && (spacing - 0.01).abs() < 1e-4);
        let large = texture.colours(&positions, Some(&[0.1; 100]));
        assert!(large.iter().all(|colour| (colour[0] - 0.5).abs() < 0.01));
        let small = texture.colours(&positions, None);
        assert!(small.iter().any(|colour| colour[0] > 0.9) && small.iter().any(|colour| colour[0] < 0.1));
    }

    #[test]
    fn textures_join_where_they_are_one() {
        let image = |grey| Arc::new(MipMap::new(&picture([1, 1], |_, _| grey)).unwrap());
        let texture = |image, u| Texture { image, coordinates: vec![Vec2::new(u, 0.0)] };
        let [a, b, c] = [texture(image(0.0), 0.25), texture(image(0.0), 0.5), texture(image(1.0), 0.0)];
        let joined = Texture::join([Some(&a), Some(&b)].into_iter()).unwrap();
        assert_eq!(joined.coordinates, [Vec2::new(0.25, 0.0), Vec2::new(0.5, 0.0)]);
        assert!(Texture::join([Some(&a), Some(&c)].into_iter()).is_none());
        assert!(Texture::join([Some(&a), None].into_iter()).is_none());
        assert!(Texture::join([None, None].into_iter()).is_none());
    }
}
