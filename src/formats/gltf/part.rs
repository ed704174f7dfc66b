//! Vertices and faces of primitives.

use super::accessor::{Contents, Numbers};
use super::scene::{Placed, missing, unsupported};
use super::schema::{Attributes, Primitive};
use super::texture::{Textures, Texturing};
use crate::formats::declared::Scalar;
use crate::formats::source::{Parsed, room};
use crate::formats::table::Collector;
use crate::geometry::{FaceImage, FaceTexture, FaceTextures, memory};
use glam::{DMat3, DMat4, DVec3};
use std::collections::HashMap;

/// Number of values of a vertex: position, normal, colour.
pub const VALUES: usize = 9;

/// Rank of a vertex that no primitive uses.
const UNUSED: u32 = u32::MAX;

/// Mode of primitives.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Points,
    Lines,
    Triangles,
    Strip,
    Fan,
}

/// The vertices of primitives that have them in common.
pub struct Part<'a> {
    position: Numbers<'a>,
    normal: Option<Numbers<'a>>,
    colour: Option<Numbers<'a>>,
    texturing: Option<Texturing<'a>>,
    /// Linear factor of the colours.
    factor: [f64; 3],
    matrix: DMat4,
    normal_matrix: DMat3,
    primitives: Vec<(Mode, Option<Numbers<'a>>)>,
    /// The used vertices, and the rank of each among them; `None` if all are used.
    used: Option<Used>,
}

struct Used {
    vertices: Vec<u32>,
    ranks: Vec<u32>,
}

/// What all parts take. Few bytes of a file can name the same vertices and indices any number of times.
#[derive(Default)]
struct Total {
    bytes: u64,
    /// Up to which number the free memory is checked.
    checked: u64,
}

impl Total {
    /// Adds `count` times as many bytes; returns an error if there is too little memory.
    fn add(&mut self, count: usize, bytes: u64) -> Parsed<()> {
        self.bytes = self.bytes.saturating_add((count as u64).saturating_mul(bytes));
        // Asking the system takes longer than a small primitive.
        if self.bytes > self.checked {
            memory::check("its vertices and triangles", self.bytes)?;
            self.checked = self.bytes.saturating_add(self.bytes / 8).max(1 << 20);
        }
        Ok(())
    }
}

/// All parts of a scene.
pub struct Parts<'a> {
    pub all: Vec<Part<'a>>,
    /// Number of primitives of lines, which are not read.
    pub lines: u64,
}

impl<'a> Parts<'a> {
    /// Collects the primitives: those of a node with the same attributes and material share their vertices.
    pub fn of(contents: &Contents<'a>, placed: &[Placed], textures: &mut Textures<'a>) -> Parsed<Self> {
        let mut parts = Self { all: Vec::new(), lines: 0 };
        let mut known: HashMap<(u32, Attributes, Option<u32>), usize> = HashMap::new();
        let mut total = Total::default();
        for Placed { primitive, node, matrix } in placed {
            let mode = mode(primitive)?;
            if mode == Mode::Lines {
                parts.lines += 1;
                continue;
            }
            let key = (*node, primitive.attributes, primitive.material);
            let index = match known.get(&key) {
                Some(index) => *index,
                None => {
                    let part = Part::of(contents, primitive, *matrix, textures)?;
                    // Ranks and indices of the used vertices, and steps of their texture coordinates.
                    total.add(part.position.count, 16)?;
                    parts.all.push(part);
                    known.insert(key, parts.all.len() - 1);
                    parts.all.len() - 1
                }
            };
            let indices = primitive.indices.map(|indices| contents.numbers(indices, &[1])).transpose()?;
            let is_unsigned =
                |numbers: &Numbers| matches!(numbers.scalar, Scalar::U8 | Scalar::U16 | Scalar::U32);
            if !indices.as_ref().is_none_or(is_unsigned) {
                return Err("its indices are not unsigned integers: fetch or write it again".into());
            }
            let corners = indices.as_ref().map_or(parts.all[index].position.count, |indices| indices.count);
            // A triangle for each corner of a strip, with its texture coordinates and its corners as given.
            total.add(corners, if parts.all[index].image().is_some() { 64 } else { 12 })?;
            parts.all[index].primitives.push((mode, indices));
        }
        for part in &mut parts.all {
            part.find_used()?;
            part.find_steps();
        }
        Ok(parts)
    }
}

fn mode(primitive: &Primitive) -> Parsed<Mode> {
    Ok(match primitive.mode.unwrap_or(4) {
        0 => Mode::Points,
        1..=3 => Mode::Lines,
        4 => Mode::Triangles,
        5 => Mode::Strip,
        6 => Mode::Fan,
        other => return Err(format!("{other} is not a mode of primitives: fetch or write it again").into()),
    })
}

impl<'a> Part<'a> {
    fn of(
        contents: &Contents<'a>,
        primitive: &Primitive,
        matrix: DMat4,
        textures: &mut Textures<'a>,
    ) -> Parsed<Self> {
        let Attributes { position, normal, colour, .. } = primitive.attributes;
        let read = |index: u32, widths: &[usize]| {
            contents.numbers(index, widths).map_err(|cause| {
                let compressed = primitive.extensions.keys().find(|name| name.ends_with("_compression"));
                compressed.map_or(cause, |name| unsupported(name).into())
            })
        };
        let position = position.ok_or("a primitive has no POSITION: write it again with one")?;
        let position = read(position, &[3])?;
        let normal = normal.map(|normal| read(normal, &[3])).transpose()?;
        let colour = colour.map(|colour| read(colour, &[3, 4])).transpose()?;
        let others = [&normal, &colour].into_iter().flatten();
        if others.map(|numbers| numbers.count).any(|count| count != position.count) {
            return Err(
                "the attributes of a primitive differ in their numbers of elements: fetch or write it again"
                    .into(),
            );
        }
        let material = match primitive.material {
            Some(index) => Some(
                contents.document.materials.get(index as usize).ok_or_else(|| missing("material", index))?,
            ),
            None => None,
        };
        let texturing = textures.of(primitive, material, position.count)?;
        Ok(Self {
            position,
            normal,
            colour,
            texturing,
            factor: material.map_or([1.0; 3], |material| material.factor()),
            matrix,
            normal_matrix: DMat3::from_mat4(matrix).inverse().transpose(),
            primitives: Vec::new(),
            used: None,
        })
    }

    /// Finds the vertices that the primitives use.
    fn find_used(&mut self) -> Parsed<()> {
        if self.primitives.iter().any(|(_, indices)| indices.is_none()) {
            return Ok(());
        }
        let mut ranks: Vec<u32> = room(self.position.count as u64)?;
        for (_, indices) in &self.primitives {
            for index in indices.iter().flat_map(Numbers::indices) {
                if let Some(rank) = ranks.get_mut(index as usize) {
                    *rank = 1;
                }
            }
        }
        let vertices: Vec<u32> =
            (0..).zip(&ranks).filter(|(_, rank)| **rank == 1).map(|(vertex, _)| vertex).collect();
        ranks.fill(UNUSED);
        vertices.iter().zip(0..).for_each(|(vertex, rank)| ranks[*vertex as usize] = rank);
        if vertices.len() < ranks.len() {
            self.used = Some(Used { vertices, ranks });
        }
        Ok(())
    }

    /// Finds how far the texture coordinates of the vertices are apart.
    fn find_steps(&mut self) {
        let (count, all) = (self.len(), self.position.count as u32);
        let Some(mut texturing) = self.texturing.take() else { return };
        for (mode, indices) in &self.primitives {
            let run = if *mode == Mode::Triangles { 3 } else { 0 };
            match indices {
                Some(indices) => texturing.learn(indices.indices(), run, count, |index| self.corner(index)),
                None => texturing.learn(0..all, run, count, |index| self.corner(index)),
            }
        }
        self.texturing = Some(texturing);
    }

    /// Number of vertices that are used.
    pub fn len(&self) -> usize {
        self.used.as_ref().map_or(self.position.count, |used| used.vertices.len())
    }

    pub fn has_normals(&self) -> bool {
        self.normal.is_some()
    }

    pub fn has_colours(&self) -> bool {
        self.colour.is_some() || self.texturing.is_some() || self.factor != [1.0; 3]
    }

    /// Whether f32 holds the positions exactly.
    pub fn is_narrow(&self) -> bool {
        self.matrix == DMat4::IDENTITY
            && (self.position.scalar == Scalar::F32 || self.position.scalar.size() <= 2)
    }

    /// Position, normal or 0, and linear colour of the used vertex `rank`.
    pub fn values(&self, rank: usize) -> [f64; VALUES] {
        let vertex = self.vertex(rank);
        let three = |numbers: &Numbers| [0, 1, 2].map(|axis| numbers.get(vertex, axis));
        let position = self.matrix.transform_point3(three(&self.position).into()).to_array();
        let normal = self
            .normal
            .as_ref()
            .map_or(DVec3::ZERO, |normal| self.normal_matrix * DVec3::from(three(normal)));
        let colour = self.colour.as_ref().map_or([1.0; 3], three);
        let texture = self.texturing.as_ref().map_or([1.0; 3], |texturing| texturing.colour(vertex, rank));
        let mut values = [0.0; VALUES];
        values[..3].copy_from_slice(&position);
        values[3..6].copy_from_slice(&normal.to_array());
        (0..3).for_each(|channel| {
            values[6 + channel] = colour[channel] * texture[channel] * self.factor[channel]
        });
        values
    }

    /// Adds the triangles; `first` is the number of the part's first vertex.
    pub fn add_faces(&self, first: usize, collector: &mut Collector) {
        // A mirrored triangle has the other side outside.
        let mirrored = self.matrix.determinant() < 0.0;
        let corner = |index: u32| self.corner(index).map_or(f64::NAN, |rank| first as f64 + f64::from(rank));
        for (mode, indices) in &self.primitives {
            match indices {
                Some(indices) => mode.add(indices.indices().map(corner), mirrored, collector),
                None => mode.add((0..self.position.count as u32).map(corner), mirrored, collector),
            }
        }
    }

    /// The image of its triangles; none where colours of vertices are another factor.
    pub fn image(&self) -> Option<FaceImage> {
        let levels = self.texturing.as_ref().filter(|_| self.colour.is_none())?.image.clone();
        Some(FaceImage { levels, factor: DVec3::from(self.factor).as_vec3() })
    }

    /// Adds the textures of its triangles, which have these corners; `first` is the number of the part's first vertex.
    pub fn add_textures(
        &self,
        first: usize,
        triangles: impl Iterator<Item = [f64; 3]>,
        textures: &mut FaceTextures,
    ) {
        let number = self.image().map(|image| {
            textures.images.push(image);
            textures.images.len() as u32 - 1
        });
        let texture = |corners: [f64; 3]| {
            let (image, texturing) = number.zip(self.texturing.as_ref())?;
            let at = |corner: f64| texturing.at(self.vertex(corner as usize - first)).as_vec2();
            let corners = corners.map(at);
            corners.iter().all(|at| at.is_finite()).then_some(FaceTexture { image, corners })
        };
        textures.faces.extend(triangles.map(|corners| texture(corners).unwrap_or(FaceTexture::NONE)));
    }

    /// The vertex of a rank among those that are used.
    fn vertex(&self, rank: usize) -> usize {
        self.used.as_ref().map_or(rank, |used| used.vertices[rank] as usize)
    }

    /// The rank of a vertex, if it exists.
    fn corner(&self, index: u32) -> Option<u32> {
        match &self.used {
            Some(used) => used.ranks.get(index as usize).copied().filter(|rank| *rank != UNUSED),
            None => Some(index).filter(|index| (*index as usize) < self.position.count),
        }
    }
}

impl Mode {
    /// Adds the triangles between corners.
    fn add(self, mut corners: impl Iterator<Item = f64>, mirrored: bool, collector: &mut Collector) {
        let mut face = |[a, b, c]: [f64; 3]| collector.face(&if mirrored { [a, c, b] } else { [a, b, c] });
        match self {
            Self::Points | Self::Lines => {}
            Self::Triangles => {
                while let (Some(a), Some(b), Some(c)) = (corners.next(), corners.next(), corners.next()) {
                    face([a, b, c]);
                }
            }
            Self::Strip => {
                let mut all: Vec<f64> = corners.collect();
                // A triangle without an area turns all others.
                all.splice(0..0, all.first().copied().filter(|_| mirrored));
                collector.strip(&all);
            }
            Self::Fan => {
                let (centre, rest) = (corners.next(), corners.collect::<Vec<_>>());
                let pairs = rest.windows(2);
                pairs.filter_map(|pair| Some([centre?, pair[0], pair[1]])).for_each(face);
            }
        }
    }
}
