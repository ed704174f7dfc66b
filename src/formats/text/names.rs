//! Names of columns: as writers spell them, and as [PLY](crate::formats::ply) has them.

use super::lines::{cells, comment, is_row, of};
use crate::formats::quoted::{listed, quoted};
use crate::formats::source::Parsed;
use crate::formats::table::text::number;

/// Name of a column that is ignored; its cells may hold text.
pub const IGNORED: &str = "-";

/// Byte order mark of UTF-8, which other programs write before the text.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Names of three columns with a meaning, and how writers spell them in lower case, the preferred spelling first.
const TRIPLES: &[([&str; 3], &[[&str; 3]])] = &[
    (
        POSITION,
        &[
            POSITION,
            ["x coordinate", "y coordinate", "z coordinate"],
            ["points:0", "points:1", "points:2"],
            ["points_0", "points_1", "points_2"],
        ],
    ),
    (
        ["nx", "ny", "nz"],
        &[
            ["nx", "ny", "nz"],
            ["normalx", "normaly", "normalz"],
            ["normal_x", "normal_y", "normal_z"],
            ["normals:0", "normals:1", "normals:2"],
            ["normals_0", "normals_1", "normals_2"],
        ],
    ),
    (
        ["red", "green", "blue"],
        &[
            ["red", "green", "blue"],
            ["r", "g", "b"],
            ["rf", "gf", "bf"],
            ["rgb:0", "rgb:1", "rgb:2"],
            ["rgb_0", "rgb_1", "rgb_2"],
        ],
    ),
];

/// Names of the coordinates.
const POSITION: [&str; 3] = ["x", "y", "z"];

/// Spellings of the coordinates of surveys. Those of z mean others without x and y.
const SURVEYED: [&[&str]; 3] =
    [&["x", "easting"], &["y", "northing"], &["z", "elevation", "elev", "height", "altitude", "alt"]];

/// Names of one column with a meaning, and how writers spell them.
const SINGLES: &[(&str, &[&str])] = &[("radius", &["radius"]), ("intensity", &["intensity", "reflectance"])];

/// Spellings of angles on the globe.
const ANGLES: [&[&str]; 2] = [&["longitude", "lon", "long", "lng"], &["latitude", "lat"]];

/// The first line of a table, with the names of its columns.
pub struct Header {
    pub names: Vec<String>,
    /// Offset of the line after it, bytes.
    pub end: usize,
    /// Number of the line after it, from 1.
    pub next: u64,
}

impl Header {
    /// The first line with names of x, y and z, before any point; with names that are `given` for the columns, any line of words.
    pub fn of(beginning: &[u8], given: Option<&[String]>) -> Option<Self> {
        let mut end = start(beginning);
        for (line, next) in beginning[end..].split_inclusive(|byte| *byte == b'\n').zip(2..) {
            end += line.len();
            let line = line.trim_ascii();
            let names = meanings(cells(comment(line).unwrap_or(line)));
            let is_skipped = comment(line).is_none() && given.is_some() && is_words(line);
            if has_position(&names) || is_skipped {
                return Some(Self { names, end, next });
            }
            if comment(line).is_none() && !line.is_empty() {
                return None;
            }
        }
        None
    }
}

/// Offset of the text: after a byte order mark, if there is one.
pub fn start(beginning: &[u8]) -> usize {
    if beginning.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 }
}

/// Whether no cell of a line is a number.
fn is_words(line: &[u8]) -> bool {
    !line.is_empty() && numbers(line) == 0
}

/// How many cells of a line are numbers.
pub fn numbers(line: &[u8]) -> usize {
    cells(line).filter(|cell| number(cell).is_some()).count()
}

/// Whether x, y and z are among the names.
pub fn has_position(names: &[String]) -> bool {
    POSITION.iter().all(|axis| names.iter().any(|name| name == axis))
}

/// The names of columns, of which those with a meaning get that of PLY.
pub fn meanings<'a>(cells: impl Iterator<Item = &'a [u8]>) -> Vec<String> {
    let own = |cell| String::from_utf8_lossy(cell).trim_matches(['"', '\'', ' ']).to_owned();
    let mut names: Vec<String> = cells.map(own).collect();
    let bare = bare(&names);
    let column = |spelling: &str| bare.iter().position(|name| name == spelling);
    let any = |spellings: &[&str]| spellings.iter().find_map(|spelling| column(spelling));
    let all = |[a, b, c]: [&str; 3]| Some([column(a)?, column(b)?, column(c)?]);
    for (meaning, spellings) in TRIPLES {
        let found = spellings.iter().find_map(|spelling| all(*spelling));
        for (column, meaning) in found.into_iter().flatten().zip(meaning) {
            names[column] = (*meaning).into();
        }
    }
    for (meaning, spellings) in SINGLES {
        any(spellings).into_iter().for_each(|column| names[column] = (*meaning).into());
    }
    let surveyed = SURVEYED.map(any);
    if let ([Some(_), Some(_), Some(_)], false) = (surveyed, has_position(&names)) {
        for (column, axis) in surveyed.into_iter().flatten().zip(POSITION) {
            names[column] = axis.into();
        }
    }
    names
}

/// The names in lower case, without units in brackets.
fn bare(names: &[String]) -> Vec<String> {
    let bare =
        |name: &String| name.to_lowercase().split(['(', '[']).next().unwrap_or_default().trim().to_owned();
    names.iter().map(bare).collect()
}

/// Checks the names of the columns of a table, whose first point is a line.
pub fn check(names: &[String], first: &[u8]) -> Parsed<()> {
    let count = cells(first).count();
    if names.len() != count {
        return Err(format!(
            "its lines have {count} values, and {} columns are named: name each once, or `{IGNORED}` to ignore it",
            names.len()
        )
        .into());
    }
    if !has_position(names) {
        return Err(no_position(names, first).into());
    }
    let is_text = |(name, cell): &(&String, &[u8])| {
        let is_other = ![IGNORED, "x", "y", "z"].contains(&name.as_str());
        is_other && !cell.is_empty() && number(cell).is_none()
    };
    match names.iter().zip(cells(first)).find(is_text) {
        None => Ok(()),
        Some((name, cell)) => {
            let [name, text] = [name.as_bytes(), cell].map(quoted);
            Err(format!("its column {name} has text, {text}: {}", remedy(names, first)).into())
        }
    }
}

/// What is wrong with names of which none are x, y and z, and the remedy; `first` is the first point.
fn no_position(names: &[String], first: &[u8]) -> String {
    let listed = listed(names.iter().map(String::as_str));
    let bare = bare(names);
    if ANGLES.iter().all(|angle| bare.iter().any(|name| angle.contains(&name.as_str()))) {
        return format!(
            "its points have longitude and latitude ({listed}), which are degrees and no lengths: project them first, for example to UTM"
        );
    }
    format!("x, y and z are not all among its columns ({listed}): {}", remedy(names, first))
}

/// The remedy for these names: others, by which columns with text are ignored; `first` is the first point.
fn remedy(names: &[String], first: &[u8]) -> String {
    let has = |axis: &&str| names.iter().any(|name| name == axis);
    let mut axes = POSITION.into_iter().filter(|axis| !has(axis));
    let triples = || TRIPLES.iter().flat_map(|(names, _)| *names);
    let is_known = |name: &str| triples().chain(SINGLES.iter().map(|(name, _)| *name)).any(|own| own == name);
    let is_word = |name: &str| name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    let name = |(name, cell): (&String, &[u8])| {
        let own = if is_word(name) { name.as_str() } else { IGNORED };
        match number(cell) {
            None => IGNORED.to_owned(),
            Some(_) if is_known(name) => name.clone(),
            Some(_) => axes.next().unwrap_or(own).to_owned(),
        }
    };
    let names: Vec<String> = names.iter().zip(cells(first)).map(name).collect();
    format!("name the columns, for example `{}`", names.join(","))
}

/// What a table of points lacks whose first line has words, but no names of x, y and z.
pub fn unnamed(beginning: &[u8]) -> Option<String> {
    let mut rows = of(&beginning[start(beginning)..]).filter(|line| is_row(line));
    let first = rows.next()?;
    let names = if is_words(first) {
        meanings(cells(first))
    } else {
        (1..=cells(first).count()).map(|column| format!("column_{column}")).collect()
    };
    let point = if is_words(first) { rows.next()? } else { first };
    if numbers(point) < 3 || cells(point).count() != names.len() {
        return None;
    }
    if is_words(first) {
        return Some(no_position(&names, point));
    }
    let text = cells(first).find(|cell| number(cell).is_none())?;
    Some(format!("its first line has text, {}: {}", quoted(text), remedy(&names, first)))
}
