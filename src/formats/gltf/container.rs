//! The description and the buffers of a file, which may be inside it or beside it.

use super::schema::{Buffer, Document};
use crate::formats::quoted::{on_one_line, quoted};
use crate::formats::reader::Input;
use crate::formats::source::{Parsed, Source, check_regular};
use crate::geometry::memory;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::borrow::Cow;
use std::path::Path;

/// First bytes of a binary file.
const MAGIC: &[u8] = b"glTF";
/// Type of the chunk of the description.
const JSON: &[u8] = b"JSON";
/// Type of the chunk of the first buffer.
const BIN: &[u8] = b"BIN\0";

/// Whether a file with this beginning is glTF; `None` for other JSON.
pub fn is_gltf(beginning: &[u8]) -> Option<bool> {
    if beginning.starts_with(MAGIC) {
        return Some(true);
    }
    let text = beginning.strip_prefix(b"\xef\xbb\xbf").unwrap_or(beginning).trim_ascii_start();
    let is_named = || text.windows(7).any(|word| word == b"\"asset\"");
    match text.first() {
        Some(b'{') if is_named() => Some(true),
        Some(b'{') => None,
        _ => Some(false),
    }
}

/// Ranges of a file: the description, and the first buffer of a binary file.
struct Chunks {
    json: [u64; 2],
    bin: Option<[u64; 2]>,
}

/// The description.
pub fn document(source: &Source) -> Parsed<Document> {
    let Chunks { json: [start, length], .. } = chunks(source)?;
    let text = source.part(start, length)?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let wrong = |error: serde_json::Error| {
        format!("its description: {}: fetch or write it again", on_one_line(&error.to_string()))
    };
    let document: Document = serde_json::from_slice(text).map_err(wrong)?;
    if document.asset.version.split('.').next() != Some("2") {
        let version = quoted(document.asset.version.as_bytes());
        return Err(format!("version {version} is not supported: write it as glTF 2.0").into());
    }
    Ok(document)
}

fn chunks(source: &Source) -> Parsed<Chunks> {
    let size = source.size();
    let beginning = source.beginning()?;
    if !beginning.starts_with(MAGIC) {
        return Ok(Chunks { json: [0, size], bin: None });
    }
    let number = |at: usize| beginning.get(at..at + 4).and_then(|bytes| bytes.first_chunk()).copied();
    if number(4) != Some(2u32.to_le_bytes()) {
        return Err("a binary glTF file of another version than 2: write it as glTF 2.0".into());
    }
    let (kind, json) = chunk(source, 12)?.ok_or("the file ends within its header: fetch it again")?;
    if kind != JSON {
        return Err(
            format!("its first chunk is {}, not the description: fetch it again", quoted(&kind)).into()
        );
    }
    let next = (json[0] + json[1]).next_multiple_of(4);
    let bin = chunk(source, next)?.filter(|(kind, _)| kind == BIN).map(|(_, range)| range);
    Ok(Chunks { json, bin })
}

/// Type, start and length of the chunk at a byte; `None` at the end of the file.
fn chunk(source: &Source, at: u64) -> Parsed<Option<([u8; 4], [u64; 2])>> {
    let left = source.size().saturating_sub(at);
    if left < 8 {
        return Ok(None);
    }
    let header = source.part(at, 8)?;
    let (length, kind) = header.split_at(4);
    let number = |bytes: &[u8]| bytes.first_chunk().copied().unwrap_or_default();
    let length = u64::from(u32::from_le_bytes(number(length)));
    if length > left - 8 {
        return Err(format!(
            "a chunk of {length} bytes, but {} are left: the file is truncated; fetch it again",
            left - 8
        )
        .into());
    }
    Ok(Some((number(kind), [at + 8, length])))
}

/// The contents of all buffers.
pub fn buffers<'a>(input: &'a Input<'_>, document: &Document) -> Parsed<Vec<Cow<'a, [u8]>>> {
    let bin = chunks(&input.source)?.bin;
    let total = document.buffers.iter().fold(0u64, |sum, buffer| sum.saturating_add(buffer.byte_length));
    memory::check("its buffers", total)?;
    let contents = |(index, buffer): (usize, &Buffer)| {
        let contents = match (&buffer.uri, bin.filter(|_| index == 0)) {
            (Some(uri), _) => of_uri(uri, buffer.byte_length, input.folder),
            (None, Some([start, length])) => input.source.part(start, length.min(buffer.byte_length)),
            // That of a compressed view: an accessor that needs it is an error.
            (None, None) => return Ok(Cow::Borrowed(&[][..])),
        };
        let contents = contents.map_err(|cause| format!("buffer {index}: {cause}"))?;
        if (contents.len() as u64) < buffer.byte_length {
            return Err(format!(
                "buffer {index} has {} of {} bytes: fetch or write it again",
                contents.len(),
                buffer.byte_length
            )
            .into());
        }
        Ok(contents)
    };
    document.buffers.iter().enumerate().map(contents).collect()
}

/// The first `length` bytes that a URI names, fewer if there are no more.
pub fn of_uri<'a>(uri: &str, length: u64, folder: Option<&Path>) -> Parsed<Cow<'a, [u8]>> {
    if let Some(data) = uri.strip_prefix("data:") {
        let text = data.split_once(";base64,").map(|(_, text)| text);
        let text = text.ok_or("its data is not base64: write it again")?;
        let bytes = STANDARD.decode(text).map_err(|error| format!("its data: {error}: fetch it again"))?;
        return Ok(bytes.into());
    }
    let name = unescaped(uri);
    let shown = quoted(name.as_bytes());
    if name.contains("://") {
        return Err(format!("{shown} is not a file: fetch it, and name it in its place").into());
    }
    let folder =
        folder.ok_or_else(|| format!("{shown} is another file: give a file with its buffers inside"))?;
    let path = folder.join(&name);
    check_regular(&path)?;
    let source = Source::open(&path, |_| true).map_err(|error| error.to_string())?;
    let part = source.part(0, length.min(source.size()))?.into_owned();
    Ok(part.into())
}

/// A URI with its percent-encoded bytes.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, others)) = rest.split_first() {
        let digits =
            others.get(..2).filter(|digits| first == b'%' && digits.iter().all(u8::is_ascii_hexdigit));
        let code = digits.and_then(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = if code.is_some() { &others[2..] } else { others };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
