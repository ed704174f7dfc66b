//! Text records: numbers between white space, wherever the lines break.

use super::layout::{COLUMNS, Layout};
use super::table::{refuse_lie, room};
use super::types::{Element, Kind};
use super::{Parsed, shown};

/// The rows of element `vertex`, after the records of the elements `before` it.
pub(super) fn rows(
    payload: &[u8],
    before: &[Element],
    vertex: &Element,
    layout: &Layout,
) -> Parsed<Vec<[f64; COLUMNS]>> {
    let mut tokens = Tokens { rest: payload };
    for element in before {
        refuse_lie(element, least_size(element), tokens.room())?;
        // Records without properties have no text, however many there are.
        let count = if element.properties.is_empty() { 0 } else { element.count };
        (0..count).try_for_each(|record| tokens.record(element, record, |_, _| Ok(())))?;
    }
    refuse_lie(vertex, least_size(vertex), tokens.room())?;
    let mut rows = room(vertex)?;
    let mut values = vec![0.0; vertex.properties.len()];
    for record in 0..vertex.count {
        tokens.record(vertex, record, |index, token| {
            if layout.uses(index) {
                values[index] = number(token).ok_or_else(|| format!("{} is no number", shown(token)))?;
            }
            Ok(())
        })?;
        rows.push(layout.columns.map(|column| column.map_or(0.0, |index| values[index])));
    }
    Ok(rows)
}

/// A digit and a space for every number; a list has at least its length.
fn least_size(element: &Element) -> u64 {
    2 * element.properties.len() as u64
}

struct Tokens<'a> {
    rest: &'a [u8],
}

impl<'a> Tokens<'a> {
    /// Bytes left, and one for the space that the last number may lack.
    fn room(&self) -> usize {
        self.rest.len() + 1
    }

    /// Reads one record and hands over its single numbers' text.
    fn record(
        &mut self,
        element: &Element,
        record: u64,
        mut value: impl FnMut(usize, &[u8]) -> Parsed<()>,
    ) -> Parsed<()> {
        for (index, property) in element.properties.iter().enumerate() {
            let done = match property.kind {
                Kind::Scalar(_) => self.next().and_then(|token| value(index, token)),
                Kind::List { .. } => self.skip_list(),
            };
            done.map_err(|cause| {
                let (element, property) = (shown(element.name.as_bytes()), shown(property.name.as_bytes()));
                format!("record {record} of element {element}, {property}: {cause}; the file is damaged: fetch it again")
            })?;
        }
        Ok(())
    }

    fn skip_list(&mut self) -> Parsed<()> {
        let token = self.next()?;
        let length = number(token).filter(|length| *length >= 0.0 && length.fract() == 0.0);
        let length = length.ok_or_else(|| format!("{} is no length of a list", shown(token)))?;
        if length > self.room() as f64 / 2.0 {
            return Err(format!(
                "a list of {length} numbers does not fit into the {} bytes left",
                self.rest.len()
            ));
        }
        (0..length as u64).try_for_each(|_| self.next().map(drop))
    }

    fn next(&mut self) -> Parsed<&'a [u8]> {
        loop {
            self.rest = self.rest.trim_ascii_start();
            let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
            let (token, rest) = self.rest.split_at(end);
            self.rest = rest;
            match token {
                b"" => return Err("the file ends here".into()),
                // Some writers put comments between the records, too.
                b"comment" | b"obj_info" => {
                    let line =
                        rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
                    self.rest = &rest[line..];
                }
                _ => return Ok(token),
            }
        }
    }
}

/// The number that a token spells, `nan` and `inf` in all spellings included.
fn number(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    text.parse().ok().or_else(|| {
        // What C libraries print: nan(ind), -1.#IND, 1.#QNAN, 1.#INF. All of it is no finite number, and the point is dropped.
        let odd = ["nan(", "-nan(", "+nan(", "1.#", "-1.#", "+1.#"];
        odd.iter()
            .any(|start| text.get(..start.len()).is_some_and(|text| text.eq_ignore_ascii_case(start)))
            .then_some(f64::NAN)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_of_a_number() {
        for (text, value) in
            [(".5", 0.5), ("1E-3", 1e-3), ("5.", 5.0), ("+7", 7.0), ("-0", 0.0), ("1e400", f64::INFINITY)]
        {
            assert_eq!(number(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["nan", "-NaN", "-nan(ind)", "1.#QNAN", "-1.#IND"] {
            assert!(number(text.as_bytes()).is_some_and(f64::is_nan), "{text}");
        }
        for text in ["", "0x10", "1,5", "1e", "abc", "é", "--1"] {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
    }
}
