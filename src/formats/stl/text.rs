//! STL files as text.

use super::mesh::{Mesh, Welder};
use crate::formats::meter::Meter;
use crate::formats::quoted::quoted;
use crate::formats::source::{Parsed, Source};
use crate::formats::table::text::number;
use crate::formats::text::lines;

/// Whether this is the beginning of a file as text: `solid`, and the end of it or a facet. Binary files may begin with `solid`, too.
pub fn is_stl(beginning: &[u8]) -> bool {
    let mut words = lines::of(beginning).filter_map(|line| cells(line).next());
    words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && words.any(|word| word.eq_ignore_ascii_case(b"facet") || word.eq_ignore_ascii_case(b"endsolid"))
}

/// Reads the triangles of all solids.
pub fn read(source: &Source, meter: &Meter) -> Parsed<Mesh> {
    let look = |bytes: &[u8]| {
        let found = Found::of(bytes);
        (found.corners.len(), found)
    };
    let (mut welder, mut loops, mut corners, mut is_open) = (Welder::default(), 0, 0, true);
    let mut triangle = [[0.0; 3]; 3];
    for (piece, found) in lines::survey(source, 0, 1, look, meter)? {
        if let Some((line, cause)) = found.fault {
            return Err(format!("line {}: {cause}", piece.line + line).into());
        }
        loops += found.loops;
        is_open = found.is_open.unwrap_or(is_open);
        for corner in found.corners {
            triangle[corners % 3] = corner;
            corners += 1;
            if corners.is_multiple_of(3) {
                welder.triangle(triangle)?;
            }
        }
    }
    if is_open {
        return Err(
            "it ends without `endsolid`: it may be truncated; fetch it again, or add a line `endsolid`"
                .into(),
        );
    }
    if corners != 3 * loops {
        return Err(format!(
            "its {loops} facets have {corners} corners, and not three each: write it again as triangles"
        )
        .into());
    }
    Ok(welder.finish(0))
}

/// What some lines hold.
#[derive(Default)]
struct Found {
    corners: Vec<[f64; 3]>,
    /// Number of lines `endloop`.
    loops: usize,
    /// Whether a solid is not at its end; `None` if none begins or ends here.
    is_open: Option<bool>,
    /// The first line that is not as it has to be, from 0.
    fault: Option<(u64, String)>,
}

impl Found {
    fn of(bytes: &[u8]) -> Self {
        let mut found = Self::default();
        for (line, index) in lines::of(bytes).zip(0..) {
            let mut cells = cells(line);
            let Some(word) = cells.next() else { continue };
            if word.eq_ignore_ascii_case(b"vertex") {
                match corner(cells) {
                    Ok(corner) => found.corners.push(corner),
                    Err(cause) => {
                        found.fault = Some((index, cause));
                        break;
                    }
                }
            } else if word.eq_ignore_ascii_case(b"endloop") {
                found.loops += 1;
            } else if word.eq_ignore_ascii_case(b"solid") {
                found.is_open = Some(true);
            } else if word.eq_ignore_ascii_case(b"endsolid") {
                found.is_open = Some(false);
            }
        }
        found
    }
}

fn cells(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty())
}

fn corner<'a>(mut cells: impl Iterator<Item = &'a [u8]>) -> Result<[f64; 3], String> {
    let mut corner = [0.0; 3];
    for coordinate in &mut corner {
        let cell = cells.next().ok_or("a vertex has x, y and z: write the file again")?;
        *coordinate = number(cell)
            .ok_or_else(|| format!("{} is not a number: fetch or write the file again", quoted(cell)))?;
    }
    match cells.next() {
        Some(cell) => Err(format!("{} after x, y and z: write the file again", quoted(cell))),
        None => Ok(corner),
    }
}
