//! Albedo of a mesh.

use crate::geometry::{Cloud, Colours, Texture};
use crate::verify::reference::linear;
use glam::{DVec2, DVec3};
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
}

impl Albedo {
    /// The texture or the colours of a cloud.
    pub fn of(cloud: &Cloud) -> Self {
        match (&cloud.texture, &cloud.colours) {
            (Some(texture), _) => Self::Texture(texture.clone()),
            (None, Some(colours)) => Self::Corners(decoded(colours)),
            (None, None) => Self::Lighting,
        }
    }

    /// The albedo of a point of a triangle, by the weights of its corners; `None` for the lighting's.
    pub fn at(&self, corners: [u32; 3], weights: DVec3) -> Option<[f64; 3]> {
        let corners = corners.map(|corner| corner as usize);
        let colour = match self {
            Self::Lighting => return None,
            Self::Corners(colours) => super::mean(corners.map(|corner| colours[corner]), weights),
            Self::Texture(Texture { image, coordinates }) => {
                let at =
                    super::mean(corners.map(|corner| coordinates[corner].as_dvec2().extend(0.0)), weights);
                image.sample(DVec2::new(at.x, at.y), 0.0)
            }
        };
        Some(colour.to_array())
    }

    /// The albedo of some corners, in this order.
    pub fn of_corners(&self, kept: &[u32]) -> Self {
        match self {
            Self::Lighting => Self::Lighting,
            Self::Corners(colours) => {
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
        }
    }
}

fn decoded(colours: &Colours) -> Vec<DVec3> {
    match colours {
        Colours::Srgb8(codes) => codes.par_iter().map(|code| linear(*code)).collect(),
        Colours::Linear(colours) => colours.iter().map(|colour| DVec3::from(colour.map(f64::from))).collect(),
    }
}
