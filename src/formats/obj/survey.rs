//! What a file has: counts of its lines by their keywords, and the range of its colours.

use super::vertices;
use crate::formats::declared::Scalar;
use crate::formats::text::{columns, lines};
use std::collections::BTreeMap;

/// Keyword of vertices.
pub const VERTEX: &str = "v";
/// Keyword of normals.
pub const NORMAL: &str = "vn";
/// Keyword of faces.
pub const FACE: &str = "f";
/// Keyword of points.
pub const POINT: &str = "p";
/// Keyword of texture coordinates.
pub const TEXTURE: &str = "vt";
/// Keyword of files of materials, which name textures.
pub const MATERIALS: &str = "mtllib";
/// Keyword of the material of the faces after it.
pub const USED_MATERIAL: &str = "usemtl";

/// Keywords that are known; all others count as one.
const OTHERS: [&str; 13] =
    [NORMAL, FACE, POINT, TEXTURE, MATERIALS, "vp", "l", "o", "g", "s", USED_MATERIAL, "usemap", "fo"];

/// Name of all lines with other keywords.
const UNKNOWN: &str = "other";

/// Counts of lines.
#[derive(Default)]
pub struct Survey {
    pub vertices: u64,
    pub normals: u64,
    pub faces: u64,
    /// Values of the lines that name files of materials.
    pub materials: Vec<Vec<u8>>,
    others: BTreeMap<&'static str, u64>,
    /// Largest channel of a colour; `None` if no vertex has one.
    largest: Option<f64>,
}

/// The keyword of a line, and its values; `None` for comments and empty lines.
pub fn keyword(line: &[u8]) -> Option<(&[u8], &[u8])> {
    let line = line.trim_ascii();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    (end > 0 && line[0] != b'#').then(|| line.split_at(end))
}

/// Whether the first line of a file with this beginning that is no comment has a keyword and values that fit it.
pub fn is_obj(beginning: &[u8]) -> bool {
    let mut lines = lines::of(beginning).filter_map(keyword);
    lines.next().is_some_and(|(word, values)| match word {
        b"v" | b"vn" => values.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty()).count() >= 3,
        b"vt" | b"o" | b"g" | b"s" | b"mtllib" | b"usemtl" => true,
        _ => false,
    })
}

/// Counts the lines of a piece; returns the number of vertices, too.
pub fn look(bytes: &[u8]) -> (usize, Survey) {
    let mut survey = Survey::default();
    for (word, values) in lines::of(bytes).filter_map(keyword) {
        if word == VERTEX.as_bytes() {
            survey.vertices += 1;
            survey.largest = larger(survey.largest, vertices::largest_channel(values));
            continue;
        }
        if word == MATERIALS.as_bytes() {
            survey.materials.push(values.trim_ascii().to_vec());
        }
        let known = OTHERS.iter().find(|known| known.as_bytes() == word);
        *survey.others.entry(known.copied().unwrap_or(UNKNOWN)).or_default() += 1;
    }
    let count = |word: &str| survey.others.get(word).copied().unwrap_or_default();
    let (normals, faces) = (count(NORMAL), count(FACE));
    (survey.vertices as usize, Survey { normals, faces, ..survey })
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (a, b) => a.or(b),
    }
}

impl Survey {
    /// The sum of two pieces.
    pub fn merge(mut self, other: Self) -> Self {
        self.materials.extend(other.materials);
        other.others.iter().for_each(|(word, count)| *self.others.entry(word).or_default() += count);
        Self {
            vertices: self.vertices + other.vertices,
            normals: self.normals + other.normals,
            faces: self.faces + other.faces,
            largest: larger(self.largest, other.largest),
            ..self
        }
    }

    /// Keywords other than those of vertices, with their numbers of lines.
    pub fn others(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.others.iter().map(|(word, count)| (*word, *count))
    }

    /// Type of the colours, and the factor of the channels.
    pub fn colour(&self) -> Option<(Scalar, f64)> {
        self.largest.map(columns::colour)
    }
}
