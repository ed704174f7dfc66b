//! Colours of points from the textures and the materials of their faces.

use super::materials::{self, Material};
use crate::formats::source::{Parsed, room};
use crate::formats::table::Points;
use crate::formats::texture;
use crate::geometry::{Colours, MipMap, srgb};
use crate::settings::Lighting;
use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Number of a point's material where it has none.
const NONE: u16 = u16::MAX;

/// Where a point's colour comes from: the first of its faces.
#[derive(Clone, Copy, bytemuck::Zeroable)]
struct Place {
    material: u16,
    /// Texture coordinates; not finite where the corner has none.
    at: Vec2,
    /// Their mean change along the two sides of the face.
    step: Vec2,
}

const NOWHERE: Place = Place { material: NONE, at: Vec2::NAN, step: Vec2::ZERO };

/// Places of the points, collected face by face.
pub struct Places<'a> {
    points: &'a Points,
    coordinates: &'a [Vec2],
    of: Vec<Place>,
    /// Names of the materials, by number.
    names: HashMap<Vec<u8>, u16>,
    material: u16,
}

impl<'a> Places<'a> {
    /// `coordinates` are those of the file. With `wanted`, places are kept.
    pub fn new(points: &'a Points, coordinates: &'a [Vec2], wanted: bool) -> Parsed<Self> {
        let mut of = room(if wanted { points.cloud.len() as u64 } else { 0 })?;
        of.fill(NOWHERE);
        Ok(Self { points, coordinates, of, names: HashMap::new(), material: NONE })
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
        let at = |corner: &Option<i64>| {
            let index = corner.and_then(|index| usize::try_from(index).ok());
            index.and_then(|index| self.coordinates.get(index)).copied().unwrap_or(Vec2::NAN)
        };
        let all: Vec<Vec2> = corners.iter().map(at).collect();
        for (k, vertex) in vertices.iter().enumerate() {
            let place = self.points.of_vertex(*vertex).and_then(|point| self.of.get_mut(point as usize));
            let Some(place) = place.filter(|place| !place.at.is_finite()) else { continue };
            let beside = [(k + 1) % all.len(), (k + all.len() - 1) % all.len()];
            let step = beside.map(|other| (all[other] - all[k]).abs());
            *place = Place { material: self.material, at: all[k], step: 0.5 * (step[0] + step[1]) };
        }
    }

    /// The places, and the names of their materials.
    pub fn finish(self) -> Painting {
        let mut names = vec![Vec::new(); self.names.len()];
        self.names.into_iter().for_each(|(name, number)| names[number as usize] = name);
        Painting { places: self.of, names }
    }
}

/// Places of the points, and the materials that they name.
#[derive(Default)]
pub struct Painting {
    places: Vec<Place>,
    names: Vec<Vec<u8>>,
}

/// What a material shows.
enum Paint {
    Texture(Arc<MipMap>),
    Plain(DVec3),
    Nothing,
}

impl Painting {
    /// Colours the points, and returns why a texture is missing. `given` replaces the textures of all materials. Without a texture, materials count
    /// if they differ and the points have no colours.
    pub fn apply(
        &self,
        points: &mut Points,
        (folder, files): (Option<&Path>, &[Vec<u8>]),
        given: Option<&Arc<MipMap>>,
    ) -> Option<String> {
        if self.places.is_empty() {
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
        let paints = self.paints(&materials, given, &mut missing);
        let without = given.map_or(Paint::Nothing, |given| Paint::Texture(given.clone()));
        let paint = |place: &Place| paints.get(place.material as usize).unwrap_or(&without);
        let has_texture = |place: &&Place| matches!(paint(place), Paint::Texture(_));
        let is_textured = self.places.iter().filter(has_texture).any(|place| place.at.is_finite());
        if !is_textured && self.places.iter().any(|place| has_texture(&place)) {
            missing.get_or_insert("the corners of its faces have no texture coordinates (vt)".into());
        }
        let mut plain: Vec<DVec3> = Vec::new();
        for paint in &paints {
            if let Paint::Plain(colour) = paint
                && !plain.contains(colour)
            {
                plain.push(*colour);
            }
        }
        if is_textured || points.cloud.colours.is_none() && plain.len() > 1 {
            points.cloud.colours = Some(self.colours(points, paint));
        }
        missing.filter(|_| !is_textured || given.is_none())
    }

    fn paints(
        &self,
        materials: &HashMap<Vec<u8>, Material>,
        given: Option<&Arc<MipMap>>,
        missing: &mut Option<String>,
    ) -> Vec<Paint> {
        let mut textures: HashMap<PathBuf, Option<Arc<MipMap>>> = HashMap::new();
        let mut load = |path: &PathBuf| match texture::read(path) {
            Ok(texture) => Some(texture),
            Err(cause) => {
                missing.get_or_insert(cause.to_string());
                None
            }
        };
        let paint = |name: &Vec<u8>| {
            if let Some(given) = given {
                return Paint::Texture(given.clone());
            }
            let Some(material) = materials.get(name) else { return Paint::Nothing };
            let texture = material.texture.as_ref();
            let texture = texture
                .and_then(|path| textures.entry(path.clone()).or_insert_with(|| load(path)).clone())
                .map(Paint::Texture);
            texture.or(material.colour.map(Paint::Plain)).unwrap_or(Paint::Nothing)
        };
        self.names.iter().map(paint).collect()
    }

    /// Colours of all points: of the texture's level whose texels are as large as half of a side of the face; where there is none the point's own, or
    /// the default albedo.
    fn colours<'p>(&self, points: &Points, paint: impl Fn(&Place) -> &'p Paint + Sync) -> Colours {
        let albedo = DVec3::from(Lighting::default().albedo.map(f64::from));
        let own = |i: usize| points.cloud.colours.as_ref().map_or(albedo, |colours| colours.light(i));
        let colour = |(i, place): (usize, &Place)| match paint(place) {
            Paint::Texture(texture) if place.at.is_finite() => {
                let texels = place.step.as_dvec2() * DVec2::from(texture.level_size(0).map(f64::from));
                texture.sample(place.at.as_dvec2(), (0.5 * texels.length()).log2())
            }
            Paint::Plain(colour) => *colour,
            _ => own(i),
        };
        let code = |linear: DVec3| {
            let [red, green, blue] = linear.as_vec3().to_array().map(srgb::encode8);
            [red, green, blue, 0]
        };
        Colours::Srgb8(self.places.par_iter().enumerate().map(colour).map(code).collect())
    }
}
