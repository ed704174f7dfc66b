//! Colours of parts of triangles, from textures.

use super::face::Part;
use crate::geometry::{FaceTexture, FaceTextures, MipMap, TextureDetail};
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

/// Standard deviation of colours that is not seen, linear light: that over a triangle of an even gradient by 0.1.
const DEVIATION: f64 = 0.0236;
/// Side of the parts into which triangles of that deviation are divided, relative to the extent of the mesh. It is inversely proportional to the
/// deviation, so that the squared errors of the parts are equal.
const SIDE: f64 = 1.0 / 1000.0;

/// Textures of a mesh, and how much they vary.
pub(super) struct FaceColours<'a> {
    textures: &'a FaceTextures,
    /// Of each image.
    details: Vec<TextureDetail>,
}

impl<'a> FaceColours<'a> {
    pub fn new(textures: &'a FaceTextures) -> Self {
        let details = textures.images.par_iter().map(|image| TextureDetail::new(&image.levels)).collect();
        Self { textures, details }
    }

    /// Those of triangle `i`, if it has a texture; `side` is that of a square of its area, relative to the extent of the mesh.
    pub fn of(&self, i: usize, side: f64) -> Option<FaceColour<'_>> {
        let FaceTexture { image, corners } = self.textures.faces[i];
        let (image, detail) =
            self.textures.images.get(image as usize).zip(self.details.get(image as usize))?;
        let corners = corners.map(|at| at.as_dvec2());
        let size = DVec2::from(image.levels.level_size(0).map(f64::from));
        let [a, b] = [1, 2].map(|k| (corners[k] - corners[0]) * size);
        let texels = 0.5 * a.perp_dot(b).abs();
        let factor = image.factor.as_dvec3();
        texels.is_finite().then_some(FaceColour {
            levels: &image.levels,
            detail,
            factor,
            corners,
            texels,
            side,
        })
    }

    /// The area of the triangles whose textures vary, of those with these areas.
    pub fn varying(&self, areas: &[f64]) -> f64 {
        let whole = [DVec3::X, DVec3::Y, DVec3::Z];
        let varies = |i: usize| self.of(i, 1.0).is_some_and(|colour| colour.error(&whole) > 0.0);
        areas.par_iter().enumerate().map(|(i, area)| if varies(i) { *area } else { 0.0 }).sum()
    }
}

/// Colours of a triangle with a texture.
pub(super) struct FaceColour<'a> {
    levels: &'a MipMap,
    detail: &'a TextureDetail,
    factor: DVec3,
    corners: [DVec2; 3],
    /// Area of the triangle, texels of the finest level.
    texels: f64,
    side: f64,
}

impl FaceColour<'_> {
    /// The mean colour of a part of the triangle, linear light.
    pub fn mean(&self, part: &Part) -> DVec3 {
        // Texels are as large as half of a square of the part's area.
        let level = 0.5 * (0.25 * self.texels * share(part)).log2();
        self.factor * self.levels.sample(self.at(centre(part)), level)
    }

    /// The deviation of a part's colours from their mean times its side, relative to the limits; 0 if the deviation is not seen.
    pub fn error(&self, part: &Part) -> f64 {
        let size = DVec2::from(self.levels.level_size(0).map(f64::from));
        let [a, b, c] = part.map(|weights| self.at(weights) * size);
        // That of the longest side reaches all corners, however the texture is stretched.
        let reach = 0.5 * a.distance(b).max(b.distance(c)).max(c.distance(a));
        let variance = self.detail.variance(self.at(centre(part)), reach);
        let deviation = self.factor.max_element() * variance.sqrt();
        if deviation > DEVIATION {
            deviation / DEVIATION * share(part).sqrt() * self.side / SIDE
        } else {
            0.0
        }
    }

    /// Texture coordinates by weights of the corners.
    fn at(&self, weights: DVec3) -> DVec2 {
        self.corners[0] * weights.x + self.corners[1] * weights.y + self.corners[2] * weights.z
    }
}

fn centre(part: &Part) -> DVec3 {
    (part[0] + part[1] + part[2]) / 3.0
}

/// The area of a part relative to that of its triangle.
fn share(part: &Part) -> f64 {
    DMat3::from_cols(part[0], part[1], part[2]).determinant().abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Estimate;
    use crate::geometry::{Cloud, Colours, FaceImage, Surfels};
    use crate::picture::Picture;
    use glam::{Vec2, Vec3};
    use std::sync::Arc;

    /// A unit square of two triangles that shows a picture of 64×64 px, once over; `turned` is wound the other way.
    fn square(grey: impl Fn(f32, f32) -> f32, turned: bool) -> Cloud {
        let pixel = |i: u32| [grey((i % 64) as f32 + 0.5, 63.5 - (i / 64) as f32); 4];
        let picture =
            Picture { size: [64, 64], colour: (0..64 * 64).map(pixel).collect(), ..Default::default() };
        let corners: [Vec2; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        let mut triangles = vec![[0, 1, 2], [0, 2, 3]];
        triangles[1..].iter_mut().filter(|_| turned).for_each(|corners| corners.swap(0, 2));
        let face = |of: &[u32; 3]| FaceTexture { image: 0, corners: of.map(|i| corners[i as usize]) };
        let levels = Arc::new(MipMap::new(&picture).unwrap());
        Cloud {
            positions: corners.map(|at| at.extend(0.0)).to_vec(),
            colours: Some(Colours::Linear(vec![[0.9, 0.0, 0.0]; 4])),
            face_textures: Some(FaceTextures {
                images: vec![FaceImage { levels, factor: Vec3::new(1.0, 0.5, 1.0) }],
                faces: triangles.iter().map(face).collect(),
            }),
            triangles,
            ..Cloud::default()
        }
    }

    fn surfels(cloud: Cloud) -> Surfels {
        cloud.into_surfels(&Estimate::default(), &()).unwrap().0
    }

    /// Largest difference of the surfels' colours from the picture at their centres.
    fn difference(surfels: &Surfels, grey: impl Fn(f32, f32) -> f32) -> f32 {
        let Some(Colours::Linear(colours)) = &surfels.colours else { panic!("colours are kept") };
        let one = |(at, colour): (&Vec3, &[f32; 3])| {
            let grey = grey(64.0 * at.x, 64.0 * at.y);
            (Vec3::from(*colour) - Vec3::new(grey, 0.5 * grey, grey)).abs().max_element()
        };
        surfels.positions.iter().zip(colours).map(one).fold(0.0, f32::max)
    }

    #[test]
    fn triangles_are_as_fine_as_their_texture() {
        // Texels are 1/64, and the finest sides 1/1000 of the diagonal: down to the texels, some hundred times fewer where nothing varies.
        let disc =
            |x: f32, y: f32| if Vec2::new(x, y).distance(Vec2::new(20.0, 40.0)) < 8.0 { 1.0 } else { 0.2 };
        for turned in [false, true] {
            let fine = surfels(square(disc, turned));
            assert!((200..1000).contains(&fine.len()), "{} surfels", fine.len());
            let away = |at: &&Vec3| (at.truncate() * 64.0).distance(Vec2::new(20.0, 40.0)) > 30.0;
            let far = fine.positions.iter().filter(away).count();
            assert!(far < fine.len() / 10, "{far} surfels of {} where nothing varies", fine.len());
            // Off the border of the disc.
            let inside =
                |at: Vec3| ((at.truncate() * 64.0).distance(Vec2::new(20.0, 40.0)) - 8.0).abs() > 3.0;
            let kept: Vec<u32> =
                (0..fine.len() as u32).filter(|&i| inside(fine.positions[i as usize])).collect();
            let mut off = fine.clone();
            off.permute(&kept);
            assert!(difference(&off, disc) < 0.05, "{}", difference(&off, disc));
        }
    }

    #[test]
    fn an_even_texture_needs_no_more_surfels_than_an_even_colour() {
        let plain = Cloud { face_textures: None, ..square(|_, _| 0.5, false) };
        let even = surfels(square(|_, _| 0.5, false));
        assert_eq!(even.len(), surfels(plain).len());
        assert!(difference(&even, |_, _| 0.5) < 1e-6);
    }

    #[test]
    fn an_even_gradient_has_its_colours() {
        let gradient = |x: f32, y: f32| (x + 2.0 * y) / 192.0;
        let found = surfels(square(gradient, false));
        let off = |at: &Vec3| (at.truncate() - 0.5).abs().max_element() < 0.45;
        let kept: Vec<u32> = (0..found.len() as u32).filter(|&i| off(&found.positions[i as usize])).collect();
        let mut inner = found.clone();
        inner.permute(&kept);
        assert!(inner.len() > 50 && difference(&inner, gradient) < 0.01, "{}", difference(&inner, gradient));
    }

    #[test]
    fn textures_without_colours_or_of_other_triangles_are_refused() {
        let refused = |cloud: Cloud| cloud.into_surfels(&Estimate::default(), &()).unwrap_err().to_string();
        let bare = Cloud { colours: None, ..square(|_, _| 0.5, false) };
        assert!(refused(bare).contains("without colours of the points"));
        let mut fewer = square(|_, _| 0.5, false);
        fewer.triangles.pop();
        assert!(refused(fewer).contains("2 textures of 1 triangles"));
    }
}
