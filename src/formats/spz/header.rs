//! The header, and the sizes that it states.

use crate::formats::source::Parsed;
use flate2::read::GzDecoder;
use std::io::Read;

/// First bytes of the header.
pub const MAGIC: &[u8] = b"NGSP";
/// First bytes of a gzip stream.
const GZIP: &[u8] = b"\x1f\x8b";

/// Size of the header, bytes.
pub const SIZE: usize = 16;

/// Largest ratio of the sizes before and after compression by deflate: two bits may stand for 258 bytes.
const RATIO: u64 = 1032;

/// Flag of data after the arrays.
const EXTENDED: u8 = 2;

/// Coefficients of spherical harmonics without the constant one, by their degree.
const COEFFICIENTS: [u64; 5] = [0, 3, 8, 15, 24];

/// A valid header.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub version: u32,
    /// Number of Gaussians.
    pub count: u64,
    degree: u8,
    /// Bits after the point of coordinates.
    pub fraction: u8,
    flags: u8,
}

/// Whether a file with this beginning is SPZ, of any version.
pub fn is_spz(beginning: &[u8]) -> bool {
    let mut magic = [0; MAGIC.len()];
    beginning.starts_with(MAGIC)
        || beginning.starts_with(GZIP)
            && GzDecoder::new(beginning).read_exact(&mut magic).is_ok()
            && magic == MAGIC
}

/// The error for a header of another version.
pub fn unsupported(header: &[u8]) -> String {
    let version = header.get(4..8).and_then(|bytes| bytes.first_chunk()).copied().unwrap_or_default();
    let version = u32::from_le_bytes(version);
    format!("SPZ version {version} is not supported, only 1 to 3: write it as version 3, or as PLY")
}

impl Header {
    /// Parses and validates a header.
    pub fn parse(bytes: [u8; SIZE]) -> Parsed<Self> {
        let number = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        let [degree, fraction, flags] = [bytes[12], bytes[13], bytes[14]];
        let version = number(4);
        if !(1..=3).contains(&version) {
            return Err(unsupported(&bytes).into());
        }
        if usize::from(degree) >= COEFFICIENTS.len() {
            return Err(format!(
                "its spherical harmonics have the degree {degree}, more than 4: fetch it again"
            )
            .into());
        }
        Ok(Self { version, count: number(8).into(), degree, fraction, flags })
    }

    /// Bytes of the position of a Gaussian.
    pub fn position_size(&self) -> usize {
        if self.version == 1 { 6 } else { 9 }
    }

    /// Bytes of the rotation of a Gaussian.
    pub fn rotation_size(&self) -> usize {
        if self.version == 3 { 4 } else { 3 }
    }

    /// Bytes of a Gaussian without spherical harmonics: position, opacity, colour, scales, rotation.
    pub fn stride(&self) -> u64 {
        (self.position_size() + 1 + 3 + 3 + self.rotation_size()) as u64
    }

    /// Bytes of the arrays that are read.
    pub fn used(&self) -> u64 {
        self.count * self.stride()
    }

    /// Bytes of all arrays.
    pub fn whole(&self) -> u64 {
        self.count * (self.stride() + 3 * COEFFICIENTS[usize::from(self.degree)])
    }

    /// Whether data of extensions follow the arrays.
    pub fn is_extended(&self) -> bool {
        self.flags & EXTENDED != 0
    }

    /// Returns an error if a file of `size` bytes cannot hold the stated Gaussians.
    pub fn refuse_lie(&self, size: u64) -> Parsed<()> {
        if self.whole() <= RATIO.saturating_mul(size) {
            return Ok(());
        }
        Err(format!(
            "the header claims {} points in {} bytes, but {size} compressed bytes hold at most {RATIO} times as many: it is truncated or \
             wrong; fetch it again",
            self.count,
            self.whole()
        )
        .into())
    }

    /// Facts by name.
    pub fn details(&self) -> Vec<(String, String)> {
        let facts = [("version", self.version.to_string()), ("degree of harmonics", self.degree.to_string())];
        facts.map(|(name, value)| (name.to_owned(), value)).into()
    }
}
