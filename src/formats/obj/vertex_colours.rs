//! Colours of points and triangles from textures and materials.

use super::materials::{self, Material};
use crate::formats::source::{Parsed, room};
use crate::formats::table::Points;
use crate::formats::texture;
use crate::geometry::{Colours, FaceImage, FaceTexture, FaceTextures, MipMap, srgb};
use crate::settings::Lighting;
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Number of a point's material where it has none.
const NONE: u16 = u16::MAX;

/// Where the colour of a point comes from: the corner of the first face that has texture coordinates there.
#[derive(Clone, Copy, bytemuck::Zeroable)]
struct CornerColour {
    material: u16,
    /// Texture coordinates; not finite where the corner has none.
    at: Vec2,
    /// Their mean change along the two sides of the face.
    step: Vec2,
}

/// Where the colours of a triangle come from.
struct TriangleColour {
    material: u16,
    /// Texture coordinates of the corners, some not finite where one has none.
    corners: [Vec2; 3],
}

const UNSET: CornerColour = CornerColour { material: NONE, at: Vec2::NAN, step: Vec2::ZERO };

/// Materials and texture coordinates of points and triangles, collected face by face.
pub struct CornerColours<'a> {
    points: &'a Points,
    coordinates: &'a [Vec2],
    of: Vec<CornerColour>,
    triangles: Vec<TriangleColour>,
    /// Names of the materials, by number.
    names: HashMap<Vec<u8>, u16>,
    material: u16,
}

impl<'a> CornerColours<'a> {
    /// `coordinates` are those of the file. Without `wanted`, nothing is kept.
    pub fn new(points: &'a Points, coordinates: &'a [Vec2], wanted: bool) -> Parsed<Self> {
        let mut of = room(if wanted { points.cloud.len() as u64 } else { 0 })?;
        of.fill(UNSET);
        Ok(Self { points, coordinates, of, triangles: Vec::new(), names: HashMap::new(), material: NONE })
    }

    /// The material of the faces from here on.
    pub fn set_material(&mut self, name: &[u8]) {
        let next = self.names.len().min(NONE as usize) as u16;
        self.material = match self.names.get(name) {
            Some(number) => *number,
            None if next == NONE => NONE,
            None => *self.names.entry(name.to_vec()).or_insert(next),
        };
    }

    /// Adds a face of these vertices and indices of texture coordinates.
    pub fn face(&mut self, vertices: &[f64], corners: &[Option<i64>]) {
        if self.of.is_empty() || vertices.len() != corners.len() {
            return;
        }
        let all: Vec<Vec2> = corners.iter().map(|corner| self.at(*corner)).collect();
        for (k, vertex) in vertices.iter().enumerate() {
            let place = self.points.of_vertex(*vertex).and_then(|point| self.of.get_mut(point as usize));
            let Some(place) = place.filter(|place| !place.at.is_finite()) else { continue };
            let beside = [(k + 1) % all.len(), (k + all.len() - 1) % all.len()];
            let step = beside.map(|other| (all[other] - all[k]).abs());
            *place = CornerColour { material: self.material, at: all[k], step: 0.5 * (step[0] + step[1]) };
        }
    }

    /// Adds a triangle of the face of these vertices and indices of texture coordinates.
    pub fn triangle(&mut self, triangle: [f64; 3], vertices: &[f64], corners: &[Option<i64>]) {
        let place = |vertex: f64| vertices.iter().position(|other| *other == vertex);
        let corners = triangle.map(|vertex| self.at(place(vertex).and_then(|k| *corners.get(k)?)));
        self.triangles.push(TriangleColour { material: self.material, corners });
    }

    /// Whether colours are collected.
    pub fn is_wanted(&self) -> bool {
        !self.of.is_empty()
    }

    /// Texture coordinates by their index; not finite where there are none.
    fn at(&self, corner: Option<i64>) -> Vec2 {
        let index = corner.and_then(|index| usize::try_from(index).ok());
        index.and_then(|index| self.coordinates.get(index)).copied().unwrap_or(Vec2::NAN)
    }

    /// The result, after all faces.
    pub fn finish(self) -> VertexColours {
        let mut names = vec![Vec::new(); self.names.len()];
        self.names.into_iter().for_each(|(name, number)| names[number as usize] = name);
        VertexColours { corners: self.of, triangles: self.triangles, names }
    }
}

/// Materials and texture coordinates of points and triangles, and the names of the materials.
#[derive(Default)]
pub struct VertexColours {
    corners: Vec<CornerColour>,
    triangles: Vec<TriangleColour>,
    names: Vec<Vec<u8>>,
}

/// What a material shows.
enum MaterialColour {
    Texture(Arc<MipMap>),
    Plain(DVec3),
    Nothing,
}

impl VertexColours {
    /// Colours the points, and returns why a texture is missing. `given` replaces the textures of all materials. Without a texture, materials count
    /// if they differ and the points have no colours.
    pub fn apply(
        &self,
        points: &mut Points,
        (folder, files): (Option<&Path>, &[Vec<u8>]),
        given: Option<&Arc<MipMap>>,
    ) -> Option<String> {
        if self.corners.is_empty() {
            return None;
        }
        let (materials, mut missing) = match (folder, files) {
            (_, []) => (HashMap::new(), None),
            (None, _) => (HashMap::new(), Some("the file of materials is sought beside a file only".into())),
            (Some(folder), files) => match materials::read(folder, files) {
                Ok(materials) => (materials, None),
                Err(cause) => (HashMap::new(), Some(cause.to_string())),
            },
        };
        let materials_shown = self.materials_shown(&materials, given, &mut missing);
        let without = given.map_or(MaterialColour::Nothing, |given| MaterialColour::Texture(given.clone()));
        let shown = |material: u16| materials_shown.get(material as usize).unwrap_or(&without);
        let has_texture = |place: &&CornerColour| matches!(shown(place.material), MaterialColour::Texture(_));
        let is_textured = self.corners.iter().filter(has_texture).any(|place| place.at.is_finite());
        if !is_textured && self.corners.iter().any(|place| has_texture(&place)) {
            missing.get_or_insert("the corners of its faces have no texture coordinates (vt)".into());
        }
        let mut plain: Vec<DVec3> = Vec::new();
        for shown in &materials_shown {
            if let MaterialColour::Plain(colour) = shown
                && !plain.contains(colour)
            {
                plain.push(*colour);
            }
        }
        if is_textured || points.cloud.colours.is_none() && plain.len() > 1 {
            points.cloud.colours = Some(self.colours(points, shown));
        }
        if is_textured {
            points.cloud.face_textures = self.face_textures(shown);
        }
        missing.filter(|_| !is_textured || given.is_none())
    }

    fn materials_shown(
        &self,
        materials: &HashMap<Vec<u8>, Material>,
        given: Option<&Arc<MipMap>>,
        missing: &mut Option<String>,
    ) -> Vec<MaterialColour> {
        let mut textures: HashMap<PathBuf, Option<Arc<MipMap>>> = HashMap::new();
        let mut load = |path: &PathBuf| match texture::read(path) {
            Ok(texture) => Some(texture),
            Err(cause) => {
                missing.get_or_insert(cause.to_string());
                None
            }
        };
        let shown = |name: &Vec<u8>| {
            if let Some(given) = given {
                return MaterialColour::Texture(given.clone());
            }
            let Some(material) = materials.get(name) else { return MaterialColour::Nothing };
            let texture = material.texture.as_ref();
            let texture = texture
                .and_then(|path| textures.entry(path.clone()).or_insert_with(|| load(path)).clone())
                .map(MaterialColour::Texture);
            texture.or(material.colour.map(MaterialColour::Plain)).unwrap_or(MaterialColour::Nothing)
        };
        self.names.iter().map(shown).collect()
    }

    /// Colours of all points: of the texture's level whose texels are as large as half of a side of the face; where there is none the point's own, or
    /// the default albedo.
    fn colours<'p>(&self, points: &Points, shown: impl Fn(u16) -> &'p MaterialColour + Sync) -> Colours {
        let albedo = DVec3::from(Lighting::default().albedo.map(f64::from));
        let own = |i: usize| points.cloud.colours.as_ref().map_or(albedo, |colours| colours.light(i));
        let colour = |(i, place): (usize, &CornerColour)| match shown(place.material) {
            MaterialColour::Texture(texture) if place.at.is_finite() => {
                let texels = place.step.as_dvec2() * DVec2::from(texture.level_size(0).map(f64::from));
                texture.sample(place.at.as_dvec2(), (0.5 * texels.length()).log2())
            }
            MaterialColour::Plain(colour) => *colour,
            _ => own(i),
        };
        let code = |linear: DVec3| {
            let [red, green, blue] = linear.as_vec3().to_array().map(srgb::encode8);
            [red, green, blue, 0]
        };
        Colours::Srgb8(self.corners.par_iter().enumerate().map(colour).map(code).collect())
    }

    /// Textures of the triangles.
    fn face_textures<'p>(&self, shown: impl Fn(u16) -> &'p MaterialColour) -> Option<FaceTextures> {
        let mut images: Vec<FaceImage> = Vec::new();
        let mut numbers: HashMap<u16, u32> = HashMap::new();
        let mut number = |material: u16| {
            let MaterialColour::Texture(levels) = shown(material) else { return FaceTexture::NO_IMAGE };
            let same = images.iter().position(|image| Arc::ptr_eq(&image.levels, levels));
            same.unwrap_or_else(|| {
                images.push(FaceImage { levels: levels.clone(), factor: Vec3::ONE });
                images.len() - 1
            }) as u32
        };
        let face = |triangle: &TriangleColour| {
            let is_textured = triangle.corners.iter().all(|at| at.is_finite());
            let image = *numbers.entry(triangle.material).or_insert_with(|| number(triangle.material));
            if is_textured { FaceTexture { image, corners: triangle.corners } } else { FaceTexture::NONE }
        };
        let faces = self.triangles.iter().map(face).collect();
        (!images.is_empty()).then_some(FaceTextures { images, faces })
    }
}
