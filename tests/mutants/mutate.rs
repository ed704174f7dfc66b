//! Damage, by chance but reproducibly.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Words that matter in a header or among records.
const WORDS: &[&str] = &[
    "ply",
    "format",
    "ascii",
    "binary_little_endian",
    "binary_big_endian",
    "1.0",
    "element",
    "vertex",
    "face",
    "tristrips",
    "range_grid",
    "camera",
    "edge",
    "property",
    "list",
    "char",
    "uchar",
    "short",
    "ushort",
    "int",
    "uint",
    "float",
    "double",
    "int64",
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "radius",
    "value",
    "red",
    "green",
    "blue",
    "ux",
    "vertex_indices",
    "vertex_index",
    "two_sided",
    "opacity",
    "scale_2",
    "obj_info",
    "num_cols",
    "num_rows",
    "comment",
    "end_header",
    "nan",
    "-inf",
    "1e308",
    "1e-320",
    "-nan(ind)",
];

/// Numbers that programs trip over.
const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "5",
    "6",
    "7",
    "12",
    "127",
    "128",
    "255",
    "256",
    "65535",
    "65536",
    "1000000",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "1.5",
    "1e9",
];

/// Binary values that programs trip over, little-endian.
const BYTES: &[&[u8]] = &[
    &[0; 4],
    &[0xff; 4],
    &[0xff; 8],
    &[0, 0, 0x80, 0x7f],
    &[0, 0, 0xc0, 0x7f],
    &[0, 0, 0x80, 0xff],
    &[0xff, 0xff, 0x7f, 0x7f],
    &[1, 0, 0, 0],
    &[0, 0, 0, 0x80],
    &[0xff, 0xff, 0xff, 0x7f],
    &[0, 0, 0, 0, 0, 0, 0xf0, 0x7f],
    &[0xff],
    &[0x80],
    b"\r",
    b"\n",
];

/// A stream of numbers that a seed determines.
pub struct Random(Pcg32);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(Pcg32::seed_from_u64(seed))
    }

    /// A number below `end`; 0 if there is none.
    fn below(&mut self, end: usize) -> usize {
        (self.0.next_u64() % end.max(1) as u64) as usize
    }

    fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

/// One of the files with one to three kinds of damage, mostly one.
pub fn mutant(files: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = random.pick(files).clone();
    for _ in 0..=random.below(3) / 2 * random.below(3) {
        damage(&mut bytes, files, random);
    }
    bytes
}

fn damage(bytes: &mut Vec<u8>, files: &[Vec<u8>], random: &mut Random) {
    // Half of it among the records: what befalls a header is found out at once, as a rule.
    let payload = match random.below(2) {
        0 => bytes.windows(10).position(|bytes| bytes == b"end_header").map_or(0, |at| at + 11),
        _ => 0,
    };
    let payload = payload.min(bytes.len());
    let at = payload + random.below(bytes.len() - payload);
    let length = random.below(24).min(bytes.len().saturating_sub(at));
    match random.below(10) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        1 if at < bytes.len() => bytes[at] = random.below(256) as u8,
        2 => drop(bytes.drain(at..at + length)),
        3 => {
            let inserted: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
            bytes.splice(at..at, inserted);
        }
        4 => bytes.truncate(at),
        5 => {
            let other = random.pick(files);
            let from = random.below(other.len());
            let piece = &other[from..other.len().min(from + random.below(200))];
            bytes.splice(at..at + length, piece.iter().copied());
        }
        6 => {
            let value = *random.pick(BYTES);
            let end = bytes.len().min(at + value.len());
            bytes.splice(at..end, value.iter().copied());
        }
        7 => swap_token(bytes, random, |_| true, WORDS),
        8 => swap_token(bytes, random, |token| token.iter().all(u8::is_ascii_digit), NUMBERS),
        _ => swap_lines(bytes, random),
    }
}

/// Puts a word in the place of a token of the file's first thousand bytes, most of which are header.
fn swap_token(bytes: &mut Vec<u8>, random: &mut Random, is: impl Fn(&[u8]) -> bool, words: &[&str]) {
    let start = &bytes[..bytes.len().min(1000)];
    let mut tokens = Vec::new();
    let mut at = 0;
    for token in start.split(u8::is_ascii_whitespace) {
        if !token.is_empty() && is(token) {
            tokens.push(at..at + token.len());
        }
        at += token.len() + 1;
    }
    if !tokens.is_empty() {
        let range = random.pick(&tokens).clone();
        bytes.splice(range, random.pick(words).bytes());
    }
}

/// Exchanges two lines, or repeats one.
fn swap_lines(bytes: &mut Vec<u8>, random: &mut Random) {
    let mut lines: Vec<Vec<u8>> = bytes.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    let (a, b) = (random.below(lines.len()), random.below(lines.len()));
    match lines.get(a).cloned() {
        Some(line) if random.below(2) == 0 => lines.insert(b, line),
        Some(_) => lines.swap(a, b),
        None => {}
    }
    *bytes = lines.concat();
}

/// Writes the checksums of an E57 file's pages, so that damage within them is read.
pub fn renew_checksums(bytes: &mut [u8]) {
    for page in bytes.chunks_exact_mut(1024) {
        let (data, checksum) = page.split_at_mut(1020);
        checksum.copy_from_slice(&crc32c(data).to_be_bytes());
    }
}

/// The cyclic redundancy check with Castagnoli's polynomial.
fn crc32c(data: &[u8]) -> u32 {
    let shift = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0x82f6_3b78 } else { crc >> 1 };
    !data.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), shift))
}
