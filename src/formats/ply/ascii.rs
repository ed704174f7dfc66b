//! Text records: numbers between white space, independent of line breaks.

use super::Parsed;
use super::records::Reader;
use crate::formats::declared::{Element, Kind, Scalar};
use crate::formats::quoted::quoted;
use crate::formats::table::text::number;

/// A position in the text.
#[derive(Clone)]
pub(super) struct Tokens<'a> {
    rest: &'a [u8],
}

impl<'a> Tokens<'a> {
    pub fn new(rest: &'a [u8]) -> Self {
        Self { rest }
    }

    fn next(&mut self) -> Parsed<&'a [u8]> {
        loop {
            let blank = |byte: &u8| byte.is_ascii_whitespace();
            let start = self.rest.iter().position(|byte| !blank(byte)).unwrap_or(self.rest.len());
            let rest = &self.rest[start..];
            let end = rest.iter().position(blank).unwrap_or(rest.len());
            let (token, rest) = rest.split_at(end);
            self.rest = rest;
            match token {
                b"" => return Err("the file ends here".into()),
                // Some writers put comments between the records.
                b"comment" | b"obj_info" => {
                    let line = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
                    self.rest = &rest[line.unwrap_or(rest.len())..];
                }
                _ => return Ok(token),
            }
        }
    }
}

impl Reader for Tokens<'_> {
    /// One more than there are, for the space that the last number may lack.
    fn left(&self) -> usize {
        self.rest.len() + 1
    }

    /// A digit and a space per number; a list has at least its length.
    fn least_size(element: &Element) -> u64 {
        2 * element.properties.len() as u64
    }

    fn number(&mut self, _: Scalar) -> Parsed<f64> {
        let token = self.next()?;
        number(token).ok_or_else(|| format!("{} is not a number", quoted(token)).into())
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Parsed<()> {
        (0..count).try_for_each(|_| self.next().map(drop))
    }

    fn length(&mut self, _: Scalar, _: Scalar) -> Parsed<u64> {
        let token = self.next()?;
        let length = number(token).filter(|length| *length >= 0.0 && length.fract() == 0.0);
        let length = length.ok_or_else(|| format!("{} is not a list length", quoted(token)))?;
        if length > self.left() as f64 / 2.0 {
            return Err(format!(
                "a list of {length} numbers does not fit into the {} bytes left",
                self.rest.len()
            )
            .into());
        }
        Ok(length as u64)
    }

    /// Numbers may continue on the next line. Two lines with an equal number of values that is larger than a record's, and not a multiple
    /// of it, belong to a different table.
    fn check(&self, element: &Element) -> Parsed<()> {
        let declared = element.properties.len();
        let scalars = element.properties.iter().all(|property| matches!(property.kind, Kind::Scalar(_)));
        let lines = self.rest.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
        let is_text = |line: &&[u8]| {
            !line.is_empty() && !line.starts_with(b"comment") && !line.starts_with(b"obj_info")
        };
        let count = |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
        let mut counts = lines.filter(is_text).map(count);
        let (words, next) = (counts.next().unwrap_or(0), counts.next());
        if element.count < 2
            || !scalars
            || words <= declared
            || words.is_multiple_of(declared)
            || next != Some(words)
        {
            return Ok(());
        }
        let name = quoted(element.name.as_bytes());
        Err(format!(
            "its rows of element {name} have {words} values, and the header declares {declared} properties: add a `property` line for each of \
             the others"
        ).into())
    }

    fn trailing(&self) -> usize {
        self.rest.trim_ascii_start().len()
    }
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
