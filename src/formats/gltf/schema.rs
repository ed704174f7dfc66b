//! The parts of the JSON description that are read.
//!
//! Transformations keep float64: geographic models have translations of millions of metres.

use crate::formats::declared::Scalar;
use glam::{DMat4, DQuat, DVec2, DVec3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;

/// A glTF document.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Document {
    pub asset: Asset,
    #[serde(default)]
    pub extensions_required: Vec<String>,
    pub scene: Option<u32>,
    #[serde(default)]
    pub scenes: Vec<Scene>,
    #[serde(default)]
    pub nodes: Vec<Node>,
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    #[serde(default)]
    pub materials: Vec<Material>,
    #[serde(default)]
    pub textures: Vec<Texture>,
    #[serde(default)]
    pub images: Vec<Image>,
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub buffers: Vec<Buffer>,
}

#[derive(Deserialize)]
pub struct Asset {
    pub version: String,
    pub generator: Option<String>,
}

#[derive(Deserialize)]
pub struct Scene {
    #[serde(default)]
    pub nodes: Vec<u32>,
}

/// A node; boxes keep a description of many empty ones small.
#[derive(Deserialize)]
pub struct Node {
    #[serde(default)]
    pub children: Vec<u32>,
    pub mesh: Option<u32>,
    matrix: Option<Box<[f64; 16]>>,
    translation: Option<Box<[f64; 3]>>,
    rotation: Option<Box<[f64; 4]>>,
    scale: Option<Box<[f64; 3]>>,
}

#[derive(Deserialize)]
pub struct Mesh {
    pub primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<u32>,
    pub material: Option<u32>,
    pub mode: Option<u32>,
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

/// Accessors of the attributes of vertices.
#[derive(Clone, Copy, Deserialize, Eq, Hash, PartialEq)]
pub struct Attributes {
    #[serde(rename = "POSITION")]
    pub position: Option<u32>,
    #[serde(rename = "NORMAL")]
    pub normal: Option<u32>,
    #[serde(rename = "COLOR_0")]
    pub colour: Option<u32>,
    #[serde(rename = "TEXCOORD_0")]
    coordinates_0: Option<u32>,
    #[serde(rename = "TEXCOORD_1")]
    coordinates_1: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Material {
    pbr_metallic_roughness: Option<Roughness>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Roughness {
    base_color_factor: Option<[f64; 4]>,
    base_color_texture: Option<BaseColourTexture>,
}

/// A reference to a texture.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct BaseColourTexture {
    pub index: u32,
    #[serde(default)]
    tex_coord: u32,
    #[serde(default)]
    extensions: TextureExtensions,
}

#[derive(Default, Deserialize)]
struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct TextureTransform {
    offset: Option<[f64; 2]>,
    rotation: Option<f64>,
    scale: Option<[f64; 2]>,
    tex_coord: Option<u32>,
}

#[derive(Deserialize)]
pub struct Texture {
    pub source: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Image {
    pub uri: Option<String>,
    pub buffer_view: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    pub buffer_view: Option<u32>,
    #[serde(default)]
    pub byte_offset: u64,
    pub component_type: u32,
    #[serde(default)]
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub shape: String,
    pub sparse: Option<Box<Sparse>>,
}

#[derive(Deserialize)]
pub struct Sparse {
    pub count: u64,
    pub indices: SparsePart,
    pub values: SparsePart,
}

/// Indices or values of a sparse accessor; values have no type of their own.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparsePart {
    pub buffer_view: u32,
    #[serde(default)]
    pub byte_offset: u64,
    #[serde(default)]
    pub component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct BufferView {
    pub buffer: u32,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: Option<u64>,
    #[serde(default)]
    pub extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
}

impl Node {
    /// The transformation to the coordinates of the parent.
    pub fn matrix(&self) -> DMat4 {
        if let Some(matrix) = &self.matrix {
            return DMat4::from_cols_array(matrix);
        }
        let translation = self.translation.as_ref().map_or(DVec3::ZERO, |all| DVec3::from(**all));
        let rotation = self.rotation.as_ref().map_or(DQuat::IDENTITY, |all| DQuat::from_array(**all));
        let scale = self.scale.as_ref().map_or(DVec3::ONE, |all| DVec3::from(**all));
        // A rotation of all zeros is none.
        let square = rotation.length_squared();
        let rotation = if square > 0.0 { rotation * square.sqrt().recip() } else { DQuat::IDENTITY };
        DMat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}

impl Material {
    /// Linear factor of the colours.
    pub fn factor(&self) -> [f64; 3] {
        let factor = self.pbr_metallic_roughness.as_ref().and_then(|own| own.base_color_factor);
        factor.map_or([1.0; 3], |[red, green, blue, _]| [red, green, blue])
    }

    pub fn texture(&self) -> Option<&BaseColourTexture> {
        self.pbr_metallic_roughness.as_ref()?.base_color_texture.as_ref()
    }
}

impl BaseColourTexture {
    fn transform(&self) -> Option<&TextureTransform> {
        self.extensions.transform.as_ref()
    }

    /// Set of the texture coordinates.
    pub fn set(&self) -> u32 {
        self.transform().and_then(|transform| transform.tex_coord).unwrap_or(self.tex_coord)
    }

    pub fn offset(&self) -> DVec2 {
        self.transform().and_then(|transform| transform.offset).map_or(DVec2::ZERO, DVec2::from)
    }

    pub fn scale(&self) -> DVec2 {
        self.transform().and_then(|transform| transform.scale).map_or(DVec2::ONE, DVec2::from)
    }

    /// Radians, from u to v.
    pub fn rotation(&self) -> f64 {
        self.transform().and_then(|transform| transform.rotation).unwrap_or_default()
    }
}

impl Attributes {
    /// The accessor of a set of texture coordinates.
    pub fn coordinates(&self, set: u32) -> Option<u32> {
        match set {
            0 => self.coordinates_0,
            1 => self.coordinates_1,
            _ => None,
        }
    }
}

/// The type with this number.
pub fn component(number: u32) -> Option<Scalar> {
    Some(match number {
        5120 => Scalar::I8,
        5121 => Scalar::U8,
        5122 => Scalar::I16,
        5123 => Scalar::U16,
        5125 => Scalar::U32,
        5126 => Scalar::F32,
        _ => return None,
    })
}
