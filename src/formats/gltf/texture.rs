//! Base colour textures.

use super::accessor::{Contents, Numbers};
use super::container;
use super::schema::{BaseColourTexture, Material, Primitive};
use crate::formats::image;
use crate::formats::source::Parsed;
use crate::geometry::MipMap;
use glam::{DVec2, Vec2};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Pixels of images after which no more are read: small files may hold large images.
const MOST_PIXELS: u64 = 4 * image::MOST_PIXELS;

/// Textures of a document, each read once.
pub struct Textures<'a> {
    contents: &'a Contents<'a>,
    folder: Option<&'a Path>,
    /// In place of all.
    given: Option<&'a Arc<MipMap>>,
    /// By image; `None` where one cannot be read.
    read: HashMap<u32, Option<Arc<MipMap>>>,
    /// Pixels of all images that were read.
    pixels: u64,
    /// Why the first one is missing that cannot be read.
    pub missing: Option<String>,
}

/// The texture of a primitive's vertices.
pub struct Texturing<'a> {
    pub image: Arc<MipMap>,
    coordinates: Numbers<'a>,
    transform: Transform,
    /// Change of the coordinates to a vertex beside, by rank; negative where none is known.
    steps: Vec<Vec2>,
}

/// KHR_texture_transform: its equation, in which the rotation takes u to v.
#[derive(Clone, Copy)]
struct Transform {
    offset: DVec2,
    rotation: f64,
    scale: DVec2,
}

impl<'a> Textures<'a> {
    /// `given` replaces the textures of all materials.
    pub fn new(contents: &'a Contents<'a>, folder: Option<&'a Path>, given: Option<&'a Arc<MipMap>>) -> Self {
        Self { contents, folder, given, read: HashMap::new(), pixels: 0, missing: None }
    }

    /// That of a primitive, if its material has one, or one is given, and its vertices have coordinates.
    pub fn of(
        &mut self,
        primitive: &Primitive,
        material: Option<&Material>,
        count: usize,
    ) -> Parsed<Option<Texturing<'a>>> {
        let texture = material.and_then(Material::texture);
        if texture.is_none() && self.given.is_none() {
            return Ok(None);
        }
        let set = texture.map_or(0, BaseColourTexture::set);
        let Some(accessor) = primitive.attributes.coordinates(set) else {
            if texture.is_some() {
                self.missing.get_or_insert(format!("a primitive has no TEXCOORD_{set}"));
            }
            return Ok(None);
        };
        let coordinates = self.contents.numbers(accessor, &[2])?;
        if coordinates.count != count {
            return Err(
                "a primitive has more or fewer texture coordinates than vertices: fetch or write it again"
                    .into(),
            );
        }
        let image = match (self.given, texture) {
            (Some(given), _) => Some(given.clone()),
            (None, Some(texture)) => self.image(texture.index),
            (None, None) => None,
        };
        let [offset, scale] =
            texture.map_or([DVec2::ZERO, DVec2::ONE], |texture| [texture.offset(), texture.scale()]);
        let rotation = texture.map_or(0.0, BaseColourTexture::rotation);
        let transform = Transform { offset, rotation, scale };
        Ok(image.map(|image| Texturing { image, coordinates, transform, steps: Vec::new() }))
    }

    fn image(&mut self, texture: u32) -> Option<Arc<MipMap>> {
        let source = self.source(texture);
        let known = source.as_ref().ok().and_then(|source| self.read.get(source));
        if let Some(known) = known {
            return known.clone();
        }
        let read = source.map(|source| (source, self.read_image(source)));
        let cause = match read {
            Ok((source, Ok(image))) => {
                return self.read.entry(source).or_insert(Some(Arc::new(image))).clone();
            }
            Ok((source, Err(cause))) => {
                self.read.insert(source, None);
                cause
            }
            Err(cause) => cause,
        };
        self.missing.get_or_insert(format!("texture {texture}: {cause}"));
        None
    }

    /// The image of a texture.
    fn source(&self, texture: u32) -> Parsed<u32> {
        let texture = self.contents.document.textures.get(texture as usize).ok_or("it does not exist")?;
        Ok(texture.source.ok_or("it has no PNG or JPEG image: write it again with one")?)
    }

    fn read_image(&mut self, source: u32) -> Parsed<MipMap> {
        let document = self.contents.document;
        let image = document.images.get(source as usize).ok_or("its image does not exist")?;
        if self.pixels > MOST_PIXELS {
            return Err("the images before have too many pixels: write it again with smaller ones".into());
        }
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => container::of_uri(uri, image::MOST_BYTES, self.folder)?,
            (None, Some(view)) => self.contents.view(view)?.into(),
            (None, None) => {
                return Err("its image has neither a file nor a buffer view: write it again".into());
            }
        };
        let picture = image::decode(&bytes)?;
        self.pixels += picture.colour.len() as u64;
        MipMap::new(&picture).map_err(|error| error.to_string().into())
    }
}

impl Texturing<'_> {
    /// Learns from a primitive's corners how far the coordinates of its vertices are apart; `rank` is that of a vertex, of `count` that are used.
    /// Corners `run` by `run` are of one face, or all with 0.
    pub fn learn(
        &mut self,
        corners: impl Iterator<Item = u32>,
        run: usize,
        count: usize,
        rank: impl Fn(u32) -> Option<u32>,
    ) {
        self.steps.resize(count, Vec2::NEG_ONE);
        let mut last: Option<u32> = None;
        for (i, corner) in corners.enumerate() {
            let before = last.replace(corner).filter(|_| run == 0 || i % run > 0);
            let Some((a, b)) = before.zip(Some(corner)) else { continue };
            let Some((rank_a, rank_b)) = rank(a).zip(rank(b)) else { continue };
            let step = (self.at(b as usize) - self.at(a as usize)).abs().as_vec2();
            for rank in [rank_a, rank_b] {
                if let Some(own) = self.steps.get_mut(rank as usize).filter(|own| own.x < 0.0) {
                    *own = step;
                }
            }
        }
    }

    /// Coordinates of a vertex, v upwards.
    pub fn at(&self, vertex: usize) -> DVec2 {
        let at = DVec2::from([0, 1].map(|axis| self.coordinates.get(vertex, axis)));
        let turned = DVec2::from_angle(self.transform.rotation).rotate(self.transform.scale * at);
        let at = self.transform.offset + turned;
        DVec2::new(at.x, 1.0 - at.y)
    }

    /// The colour at a vertex, linear light: from the level whose texels are as large as half the way to one beside.
    pub fn colour(&self, vertex: usize, rank: usize) -> [f64; 3] {
        let step = self.steps.get(rank).copied().unwrap_or(Vec2::ZERO).max(Vec2::ZERO);
        let texels = step.as_dvec2() * DVec2::from(self.image.level_size(0).map(f64::from));
        self.image.sample(self.at(vertex), (0.5 * texels.length()).log2()).to_array()
    }
}
