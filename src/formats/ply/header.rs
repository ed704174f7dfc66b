//! The PLY header, parsed byte by byte: comments may have any encoding, and no claim is trusted.

use super::Parsed;
use crate::formats::declared::{Element, Encoding, Kind, Property, Scalar};
use crate::formats::metadata::{Metadata, OWNER};
use crate::formats::quoted::quoted;
use std::collections::HashSet;

/// Maximum size of a header, bytes. The longest known ones have a few hundred properties.
pub(super) const LIMIT: usize = 1 << 20;

/// A parsed header.
#[derive(Debug, PartialEq)]
pub(super) struct Header {
    pub encoding: Encoding,
    /// Elements in the order of their records.
    pub elements: Vec<Element>,
    /// Offset of the records from the start of the file, bytes.
    pub payload: usize,
    /// Columns and rows of a range grid, from `obj_info num_cols` and `num_rows`.
    pub grid: [Option<u64>; 2],
    /// Name of the first texture, from `comment TextureFile`.
    pub texture: Option<String>,
    /// Text of the [`Metadata`], from the last `comment surfel` with such a text.
    pub metadata: Option<String>,
}

/// Whether a file with this beginning is a PLY file.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    Lines::new(bytes).first().trim_ascii_end() == b"ply"
}

/// Parses the header of a PLY file with this beginning.
pub(super) fn parse(bytes: &[u8]) -> Parsed<Header> {
    let mut lines = Lines::new(bytes);
    lines.first();
    let (mut encoding, mut elements, mut grid) = (None, Vec::new(), [None; 2]);
    let (mut texture, mut metadata) = (None, None);
    let mut names = HashSet::new();
    loop {
        let line = lines.next()?;
        let keyword = line.split(u8::is_ascii_whitespace).next().unwrap_or_default();
        let done = match keyword {
            b"" => Ok(()),
            b"comment" => {
                texture = texture.or_else(|| comment(line, "TextureFile"));
                let written = comment(line, OWNER).filter(|text| Metadata::is_text(text));
                metadata = written.or(metadata);
                Ok(())
            }
            b"obj_info" => {
                parse_info(line, &mut grid);
                Ok(())
            }
            b"format" => parse_format(line, &mut encoding),
            b"element" => parse_element(line, &mut elements, &mut names),
            b"property" => parse_property(line, &mut elements),
            b"end_header" => break,
            _ => Err(format!(
                "{} is not a header keyword: mark the line as `comment` if it is one",
                quoted(keyword)
            )
            .into()),
        };
        done.map_err(|cause| format!("header line {}: {cause}", lines.number))?;
    }
    let encoding =
        encoding.ok_or("the header has no `format` line: write the file again with a complete header")?;
    Ok(Header { encoding, elements, payload: lines.at, grid, texture, metadata })
}

/// The text after a keyword in a comment, which may contain spaces; `None` for other comments.
fn comment(line: &[u8], keyword: &str) -> Option<String> {
    let text = String::from_utf8_lossy(line);
    let text = text.trim_start_matches("comment").trim_start().strip_prefix(keyword)?;
    let text = Some(text).filter(|text| text.starts_with(char::is_whitespace)).map(str::trim)?;
    (!text.is_empty()).then(|| text.into())
}

/// Reads the size of a range grid from free text.
fn parse_info(line: &[u8], grid: &mut [Option<u64>; 2]) {
    if let [_, name, value] = words(line)[..] {
        let value = std::str::from_utf8(value).ok().and_then(|text| text.parse().ok());
        match name {
            b"num_cols" => grid[0] = value,
            b"num_rows" => grid[1] = value,
            _ => {}
        }
    }
}

fn words(line: &[u8]) -> Vec<&[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect()
}

fn parse_format(line: &[u8], header: &mut Option<Encoding>) -> Parsed<()> {
    let (encoding, version) = match words(line)[..] {
        [_, encoding, version] => (encoding, version),
        _ => return Err("expected `format <encoding> 1.0`".into()),
    };
    if version != b"1.0" {
        return Err(format!("version {} is not supported: only 1.0 is", quoted(version)).into());
    }
    let parsed = match encoding {
        b"ascii" => Encoding::Ascii,
        b"binary_little_endian" => Encoding::BinaryLittleEndian,
        b"binary_big_endian" => Encoding::BinaryBigEndian,
        _ => {
            return Err(format!(
                "{} is not an encoding: use ascii, binary_little_endian or binary_big_endian",
                quoted(encoding)
            )
            .into());
        }
    };
    match header.replace(parsed) {
        None => Ok(()),
        Some(_) => Err("a second `format` line: remove one".into()),
    }
}

fn parse_element<'a>(
    line: &'a [u8],
    elements: &mut Vec<Element>,
    names: &mut HashSet<&'a [u8]>,
) -> Parsed<()> {
    let [_, name, count] = words(line)[..] else {
        return Err("expected `element <name> <count>`".into());
    };
    let digits =
        std::str::from_utf8(count).ok().filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()));
    let Some(count) = digits.and_then(|text| text.parse().ok()) else {
        return Err(format!(
            "{} is not a number of records: expected an integer from 0 to 2⁶⁴ − 1",
            quoted(count)
        )
        .into());
    };
    if !names.insert(name) {
        return Err(format!("a second element {}: rename or remove one", quoted(name)).into());
    }
    let name = String::from_utf8_lossy(name).into_owned();
    elements.push(Element { name, count, properties: Vec::new() });
    Ok(())
}

fn parse_property(line: &[u8], elements: &mut [Element]) -> Parsed<()> {
    let element = elements.last_mut().ok_or("a property before any `element` line")?;
    let (kind, name) = match words(line)[..] {
        [_, b"list", length, item, name] => {
            (Kind::List { length: parse_length(length)?, item: parse_scalar(item)? }, name)
        }
        [_, b"list", ..] => return Err("expected `property list <length type> <item type> <name>`".into()),
        [_, scalar, name] => (Kind::Scalar(parse_scalar(scalar)?), name),
        _ => return Err("expected `property <type> <name>`".into()),
    };
    element.properties.push(Property { name: String::from_utf8_lossy(name).into_owned(), kind });
    Ok(())
}

fn parse_length(name: &[u8]) -> Parsed<Scalar> {
    match parse_scalar(name)? {
        scalar if scalar.is_float() => {
            Err(format!("{} cannot be the type of a list's length: use uchar or int", quoted(name)).into())
        }
        scalar => Ok(scalar),
    }
}

fn parse_scalar(name: &[u8]) -> Parsed<Scalar> {
    Scalar::of_name(name).ok_or_else(|| match name {
        b"int64" | b"uint64" | b"long" | b"ulong" | b"longlong" | b"ulonglong" | b"i64" | b"u64" => {
            let text = "is a 64-bit integer, which PLY does not have: convert it to int or double";
            format!("{} {text}", quoted(name)).into()
        }
        _ => format!(
            "{} is not a type: PLY has char, uchar, short, ushort, int, uint, float and double",
            quoted(name)
        )
        .into(),
    })
}

/// Returns an error for duplicate property names in an element, which are ambiguous.
pub(super) fn refuse_duplicates(elements: &[Element]) -> Parsed<()> {
    for element in elements {
        let mut seen = HashSet::new();
        if let Some(twice) = element.properties.iter().find(|property| !seen.insert(&property.name)) {
            let (element, name) = (quoted(element.name.as_bytes()), quoted(twice.name.as_bytes()));
            return Err(
                format!("element {element} has two properties named {name}: rename or remove one").into()
            );
        }
    }
    Ok(())
}

/// The header's lines, without line ends and surrounding white space.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    number: usize,
    /// Byte that ends a line: LF, also for CR LF, or CR in files of old Macintoshes. The first line determines it, because a binary payload
    /// may start with either byte.
    end: u8,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let first = bytes[at..]
            .iter()
            .take(LIMIT)
            .position(|byte| matches!(byte, b'\r' | b'\n'))
            .map(|i| &bytes[at + i..]);
        let end = match first {
            Some([b'\r', b'\n', ..]) | None => b'\n',
            Some(rest) => rest[0],
        };
        Self { bytes, at, number: 0, end }
    }

    /// The first line; empty if there is none.
    fn first(&mut self) -> &'a [u8] {
        self.next().unwrap_or_default()
    }

    fn next(&mut self) -> Parsed<&'a [u8]> {
        let rest = &self.bytes[self.at..self.bytes.len().min(LIMIT)];
        let length = match rest.iter().position(|&byte| byte == self.end) {
            Some(length) => length,
            None if self.bytes.len() > LIMIT => {
                return Err(format!("the header is longer than {LIMIT} bytes: shorten its comments").into());
            }
            None if rest.is_empty() => return Err("the file ends within its header: fetch it again".into()),
            None => rest.len(),
        };
        self.number += 1;
        self.at = (self.at + length + 1).min(self.bytes.len());
        Ok(rest[..length].trim_ascii())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cause(text: &[u8]) -> String {
        parse(text)
            .and_then(|header| refuse_duplicates(&header.elements).map(|()| header))
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn line_ends_comments_white_space_and_marks_change_nothing() {
        let plain = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty list uchar int i\nend_header\n";
        let expected = parse(plain.as_bytes()).unwrap();
        assert_eq!(expected.payload, plain.len());
        assert_eq!(
            expected.elements[0].properties[1].kind,
            Kind::List { length: Scalar::U8, item: Scalar::I32 }
        );
        let odd: &[&[u8]] = &[
            &plain.replace('\n', "\r\n").into_bytes(),
            &plain.replace('\n', "\r").into_bytes(),
            &plain.replace('\n', "\n\n\t ").into_bytes(),
            &[b"\xef\xbb\xbf", plain.as_bytes()].concat(),
            b"ply\ncomment \xff\xfe caf\xe9\nformat ascii 1.0\nobj_info \xff\nelement vertex 2\nproperty float32 x\ncomment\n\
              property list uint8 int32 i\ncomment end\nend_header",
        ];
        for (case, text) in odd.iter().enumerate() {
            let header = parse(text).unwrap_or_else(|cause| panic!("case {case}: {cause}"));
            assert_eq!(
                (header.encoding, header.elements),
                (expected.encoding, expected.elements.clone()),
                "case {case}"
            );
        }
    }

    #[test]
    fn only_comments_of_assignments_are_metadata() {
        let metadata = |comments: &str| {
            parse(format!("ply\nformat ascii 1.0\n{comments}end_header\n").as_bytes()).unwrap().metadata
        };
        let notes =
            "comment surfel reconstruction by Poisson up=0,0,1\ncomment surfel =\ncomment surfels a=b\n";
        assert_eq!(metadata(notes), None);
        let own = "comment surfel up=0,0,1 later=2\n";
        let text = Some("up=0,0,1 later=2".to_owned());
        assert_eq!(metadata(&(notes.to_owned() + own)), text);
        assert_eq!(metadata(&(own.to_owned() + notes)), text);
        assert_eq!(metadata(&format!("comment surfel up=0,1,0\n{own}")), text, "the last one counts");
    }

    #[test]
    fn the_payload_may_begin_with_a_line_end() {
        for (line_end, payload) in [("\n", "\n"), ("\n", "\r\n"), ("\r\n", "\n"), ("\r", "\n")] {
            let header = ["ply", "format binary_little_endian 1.0", "end_header", ""].join(line_end);
            assert_eq!(
                parse((header.clone() + payload).as_bytes()).unwrap().payload,
                header.len(),
                "{line_end:?}"
            );
        }
    }

    #[test]
    fn wrong_lines_are_named_with_their_cause() {
        let cases: &[(&str, &str)] = &[
            ("format ascii 1.0\nformat ascii 1.0", "line 3: a second `format`"),
            ("format ascii 2.0", "line 2: version `2.0`"),
            ("format ascii", "expected `format"),
            ("format utf8 1.0", "`utf8` is not an encoding"),
            ("end_header", "no `format` line"),
            ("format ascii 1.0\nelement vertex", "expected `element"),
            ("format ascii 1.0\nelement vertex -1", "`-1` is not a number of records"),
            ("format ascii 1.0\nelement vertex +1", "`+1` is not a number of records"),
            ("format ascii 1.0\nelement vertex 1.5", "`1.5` is not a number of records"),
            ("format ascii 1.0\nelement vertex 99999999999999999999", "is not a number of records"),
            ("format ascii 1.0\nelement v 1\nelement v 2", "line 4: a second element `v`"),
            ("format ascii 1.0\nproperty float x", "before any `element`"),
            ("format ascii 1.0\nelement v 1\nproperty float", "expected `property <type>"),
            ("format ascii 1.0\nelement v 1\nproperty list uchar int", "expected `property list"),
            (
                "format ascii 1.0\nelement v 1\nproperty list float int i",
                "cannot be the type of a list's length",
            ),
            ("format ascii 1.0\nelement v 1\nproperty int64 x", "64-bit integer"),
            ("format ascii 1.0\nelement v 1\nproperty half x", "`half` is not a type"),
            (
                "format ascii 1.0\nelement v 1\nproperty int x\nproperty float x\nend_header",
                "two properties named `x`",
            ),
            ("format ascii 1.0\nCreated by hand", "line 3: `Created` is not a header keyword"),
            ("format ascii 1.0", "ends within its header"),
        ];
        for (text, expected) in cases {
            let cause = cause(format!("ply\n{text}\n").as_bytes());
            assert!(cause.contains(expected), "{text:?}: {cause}");
        }
    }

    #[test]
    fn a_header_without_end_is_given_up_at_the_limit() {
        let text = "ply\nformat ascii 1.0\n".to_owned() + &"comment\n".repeat(LIMIT / 8);
        assert!(cause(text.as_bytes()).contains("longer than 1048576 bytes"));
        assert!(cause(&[b"ply\ncomment ", vec![b'a'; LIMIT].as_slice()].concat()).contains("longer than"));
    }
}
