//! Textures on the triangles of a mesh.

use super::texture::MipMap;
use crate::error::{Error, Result};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Textures on the triangles of a mesh: several images, each with parts on many triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceTextures {
    /// The images.
    pub images: Vec<FaceImage>,
    /// What each triangle shows; as many as triangles.
    pub faces: Vec<FaceTexture>,
}

/// An image that triangles show.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceImage {
    /// Its levels.
    pub levels: Arc<MipMap>,
    /// Factor of its colours, linear.
    pub factor: Vec3,
}

/// The part of an image that a triangle shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceTexture {
    /// Index of the image, or [`FaceTexture::NO_IMAGE`].
    pub image: u32,
    /// Texture coordinates at the corners, as in [`Texture::coordinates`](super::Texture::coordinates).
    pub corners: [Vec2; 3],
}

impl FaceTexture {
    /// The image of a triangle that has none.
    pub const NO_IMAGE: u32 = u32::MAX;
    /// Of a triangle without an image.
    pub const NONE: Self = Self { image: Self::NO_IMAGE, corners: [Vec2::ZERO; 3] };
}

impl FaceTextures {
    /// Checks that there is one entry for each of so many triangles, of an image that exists.
    ///
    /// # Errors
    /// [`Error::Usage`] with the first that is not.
    pub(crate) fn check(&self, triangles: usize) -> Result<()> {
        if self.faces.len() != triangles {
            let count = self.faces.len();
            return Err(Error::Usage(format!("{count} textures of {triangles} triangles: give one each")));
        }
        let exists = |face: &FaceTexture| {
            face.image == FaceTexture::NO_IMAGE || (face.image as usize) < self.images.len()
        };
        match self.faces.iter().position(|face| !exists(face)) {
            None => Ok(()),
            Some(i) => Err(Error::Usage(format!(
                "triangle {i} has the image {} of {}: count from 0",
                self.faces[i].image,
                self.images.len()
            ))),
        }
    }

    /// The entries of the triangles for which `kept` returns `true`.
    pub(crate) fn keep(&mut self, mut kept: impl FnMut(usize) -> bool) {
        let mut i = 0;
        self.faces.retain(|_| {
            i += 1;
            kept(i - 1)
        });
    }

    /// Joins those of parts with so many triangles each; `None` if no part has any.
    pub(super) fn join(parts: impl Iterator<Item = (Option<Self>, usize)>) -> Option<Self> {
        let mut joined = Self::default();
        for (part, triangles) in parts {
            let first = joined.images.len() as u32;
            let Some(part) = part else {
                joined.faces.resize(joined.faces.len() + triangles, FaceTexture::NONE);
                continue;
            };
            joined.images.extend(part.images);
            joined.faces.extend(part.faces.into_iter().map(|face| match face.image {
                FaceTexture::NO_IMAGE => face,
                image => FaceTexture { image: first + image, ..face },
            }));
        }
        (!joined.images.is_empty()).then_some(joined)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    fn of(image: u32) -> FaceTexture {
        FaceTexture { image, corners: [Vec2::ZERO, Vec2::X, Vec2::Y] }
    }

    fn textures(grey: f32, images: &[u32]) -> FaceTextures {
        let picture = Picture { size: [1, 1], colour: vec![[grey, grey, grey, 1.0]], ..Default::default() };
        let levels = Arc::new(MipMap::new(&picture).unwrap());
        FaceTextures {
            images: vec![FaceImage { levels, factor: Vec3::ONE }],
            faces: images.iter().map(|&image| of(image)).collect(),
        }
    }

    #[test]
    fn parts_keep_their_images() {
        let [a, b] = [textures(0.0, &[0]), textures(1.0, &[FaceTexture::NO_IMAGE, 0])];
        let parts = [(Some(a), 1), (None, 2), (Some(b), 2)];
        let joined = FaceTextures::join(parts.into_iter()).unwrap();
        assert!(joined.check(5).is_ok() && joined.images.len() == 2);
        let none = FaceTexture::NO_IMAGE;
        assert_eq!(joined.faces.iter().map(|face| face.image).collect::<Vec<_>>(), [0, none, none, none, 1]);
        assert_eq!(FaceTextures::join([(None, 3)].into_iter()), None);
    }

    #[test]
    fn faces_that_are_missing_or_have_other_images_are_refused() {
        let error = |textures: FaceTextures, triangles| textures.check(triangles).unwrap_err().to_string();
        assert_eq!(error(textures(0.0, &[0]), 2), "1 textures of 2 triangles: give one each");
        assert_eq!(error(textures(0.0, &[0, 1]), 2), "triangle 1 has the image 1 of 1: count from 0");
    }
}
