//! Albedo of a mesh.

use crate::geometry::{Cloud, Colours, FaceTexture, FaceTextures, Texture};
use crate::verify::reference::linear;
use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;
use xxhash_rust::xxh3::Xxh3;

/// Albedo of a mesh, linear.
pub enum Albedo {
    /// That of the lighting.
    Lighting,
    /// Colours of the corners, interpolated between them.
    Corners(Vec<DVec3>),
    /// The finest level of a texture, at coordinates that are interpolated between the corners.
    Texture(Texture),
    /// The finest levels of the triangles' textures, and the colours of the corners for those without one.
    Faces(FaceTextures, Vec<DVec3>),
}

impl Albedo {
    /// The textures or the colours of a cloud.
    pub fn of(cloud: &Cloud) -> Self {
        let textures = cloud.face_textures.as_ref();
        let textures = textures.filter(|textures| textures.check(cloud.triangles.len()).is_ok());
        match (&cloud.texture, textures, &cloud.colours) {
            (Some(texture), _, _) => Self::Texture(texture.clone()),
            (None, Some(textures), Some(colours)) => Self::Faces(textures.clone(), decoded(colours)),
            (None, _, Some(colours)) => Self::Corners(decoded(colours)),
            (None, _, None) => Self::Lighting,
        }
    }

    /// The albedo of a point of triangle `index`, by the weights of its corners; `None` for the lighting's.
    pub fn at(&self, index: usize, corners: [u32; 3], weights: DVec3) -> Option<[f64; 3]> {
        let corners = corners.map(|corner| corner as usize);
        let place = |coordinates: [Vec2; 3]| {
            let at = super::mean(coordinates.map(|at| at.as_dvec2().extend(0.0)), weights);
            DVec2::new(at.x, at.y)
        };
        let colour = match self {
            Self::Lighting => return None,
            Self::Corners(colours) => super::mean(corners.map(|corner| colours[corner]), weights),
            Self::Texture(Texture { image, coordinates }) => {
                image.sample(place(corners.map(|corner| coordinates[corner])), 0.0)
            }
            Self::Faces(textures, colours) => {
                let face = textures.faces[index];
                match textures.images.get(face.image as usize) {
                    Some(image) => image.factor.as_dvec3() * image.levels.sample(place(face.corners), 0.0),
                    None => super::mean(corners.map(|corner| colours[corner]), weights),
                }
            }
        };
        Some(colour.to_array())
    }

    /// The albedo of some corners, in this order, between which there are other triangles.
    pub fn of_corners(&self, kept: &[u32]) -> Self {
        match self {
            Self::Lighting => Self::Lighting,
            Self::Corners(colours) | Self::Faces(_, colours) => {
                Self::Corners(kept.iter().map(|&corner| colours[corner as usize]).collect())
            }
            Self::Texture(Texture { image, coordinates }) => {
                let coordinates = kept.iter().map(|&corner| coordinates[corner as usize]).collect();
                Self::Texture(Texture { image: image.clone(), coordinates })
            }
        }
    }

    /// Adds the albedo to a hash.
    pub fn hash(&self, hash: &mut Xxh3) {
        match self {
            Self::Lighting => super::hash_vectors(hash, &[]),
            Self::Corners(colours) => super::hash_vectors(hash, colours),
            Self::Texture(Texture { image, coordinates }) => {
                super::hash_vectors(hash, &decoded(image.texels()));
                let coordinates: Vec<_> = coordinates.iter().map(|at| at.as_dvec2().extend(0.0)).collect();
                super::hash_vectors(hash, &coordinates);
            }
            Self::Faces(textures, colours) => {
                super::hash_vectors(hash, colours);
                for image in &textures.images {
                    super::hash_vectors(hash, &decoded(image.levels.texels()));
                    super::hash_vectors(hash, &[image.factor.as_dvec3()]);
                }
                let faces = textures.faces.iter();
                let of =
                    |face: &FaceTexture| face.corners.map(|at| at.as_dvec2().extend(f64::from(face.image)));
                super::hash_vectors(hash, &faces.flat_map(of).collect::<Vec<_>>());
            }
        }
    }
}

fn decoded(colours: &Colours) -> Vec<DVec3> {
    match colours {
        Colours::Srgb8(codes) => codes.par_iter().map(|code| linear(*code)).collect(),
        Colours::Linear(colours) => colours.iter().map(|colour| DVec3::from(colour.map(f64::from))).collect(),
    }
}
