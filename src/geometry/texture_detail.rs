//! How much the colours of a texture vary within its parts.

use super::texture::{MipMap, halved, texels_around};
use glam::{DVec2, Vec4};

/// First and second moments of a texture's colours, a pyramid as its mip map.
pub(crate) struct TextureDetail {
    /// From level 1: size, and for each texel the means of the channels and of their squares, linear light.
    levels: Vec<([u32; 2], Vec<[f32; 4]>)>,
}

impl TextureDetail {
    pub fn new(image: &MipMap) -> Self {
        let mut levels: Vec<([u32; 2], Vec<[f32; 4]>)> = Vec::new();
        for level in 1..image.levels() {
            let (means, size) = match levels.last() {
                Some((size, finer)) => halved(|i| finer[i], *size),
                None => halved(|i| moments(image, i), image.level_size(level - 1)),
            };
            levels.push((size, means));
        }
        Self { levels }
    }

    /// The variance of the colours about texture coordinates, the mean of the channels', within a `reach` of the finest level's texels: under the
    /// tent of bilinear filtering that is at least as wide.
    pub fn variance(&self, at: DVec2, reach: f64) -> f64 {
        let level = reach.log2().ceil();
        if level.is_nan() || level < 1.0 || self.levels.is_empty() {
            return 0.0;
        }
        let (size, means) = &self.levels[(level as usize).min(self.levels.len()) - 1];
        let (texels, part) = texels_around(at, *size);
        let [upper, lower] = texels
            .map(|row| row.map(|i| Vec4::from(means[i]).as_dvec4()))
            .map(|[left, right]| left.lerp(right, part.x));
        let mean = upper.lerp(lower, part.y);
        (mean.w - mean.truncate().length_squared() / 3.0).max(0.0)
    }
}

/// The channels of a texel of level 0, and the mean of their squares.
fn moments(image: &MipMap, texel: usize) -> [f32; 4] {
    let colour = image.texels().light(texel).as_vec3();
    [colour.x, colour.y, colour.z, colour.length_squared() / 3.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    fn detail(size: [u32; 2], grey: impl Fn(u32, u32) -> f32) -> TextureDetail {
        let pixel = |i: u32| [grey(i % size[0], i / size[0]); 4];
        let colour = (0..size[0] * size[1]).map(pixel).collect();
        TextureDetail::new(&MipMap::new(&Picture { size, colour, ..Default::default() }).unwrap())
    }

    #[test]
    fn fine_detail_is_seen_at_every_size() {
        let checker = detail([64, 32], |x, y| ((x + y) % 2) as f32);
        for reach in [2.0, 8.0, 30.0, 1e9] {
            let variance = checker.variance(DVec2::new(0.3, 7.9), reach);
            assert!((variance - 0.25).abs() < 1e-5, "{reach}: {variance}");
        }
        for reach in [0.0, 1.0, f64::NAN] {
            assert_eq!(checker.variance(DVec2::ZERO, reach), 0.0);
        }
    }

    #[test]
    fn it_is_where_the_colours_differ() {
        // Black below, white above, with v upwards.
        let halves = detail([5, 30], |_, y| if y < 16 { 1.0 } else { 0.0 });
        // Where texels of a level meet at the border, too.
        for reach in [2.0, 4.0] {
            assert!(halves.variance(DVec2::new(0.5, 14.0 / 30.0), reach) > 0.1, "{reach}");
        }
        for v in [0.9, 0.15] {
            assert!(halves.variance(DVec2::new(0.5, v), 4.0) < 1e-6, "{v}");
        }
        assert_eq!(detail([1, 1], |_, _| 1.0).variance(DVec2::ZERO, 16.0), 0.0);
    }
}
