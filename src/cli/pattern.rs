//! Names of numbered pictures.

use std::ffi::{OsStr, OsString};
use surfel::{Error, Result};

/// Maximum number of digits.
const MOST_DIGITS: usize = 9;

/// Pattern of the pictures' names.
pub struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Parses a name with one `%d`, or `%04d` for numbers of at least four digits.
    pub fn parse(name: &OsStr) -> Result<Self> {
        let refuse = || {
            Error::Usage(format!(
                "{}: pictures are numbered: name them with %04d, once, as in frames/%04d.png",
                name.display()
            ))
        };
        let text = name.to_str().ok_or_else(refuse)?;
        let (before, rest) = text.split_once('%').ok_or_else(refuse)?;
        let (width, after) = rest.split_once('d').ok_or_else(refuse)?;
        let digits = match width {
            "" => 1,
            _ => width.strip_prefix('0').and_then(|digits| digits.parse().ok()).ok_or_else(refuse)?,
        };
        if !(1..=MOST_DIGITS).contains(&digits) || after.contains('%') {
            return Err(refuse());
        }
        Ok(Self { before: before.into(), digits, after: after.into() })
    }

    /// The name of a picture.
    pub fn file(&self, number: u32) -> OsString {
        let Self { before, digits, after } = self;
        format!("{before}{number:0digits$}{after}").into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_contain_the_number() {
        let file = |name: &str, number| Pattern::parse(name.as_ref()).unwrap().file(number);
        assert_eq!(file("frames/%04d.png", 7), "frames/0007.png");
        assert_eq!(file("%d.exr", 12), "12.exr");
        assert_eq!(file("a%02db.png", 123), "a123b.png");
        for bad in ["a.png", "-", "%.png", "%4d.png", "%0d.png", "%s.png", "%d%d.png", "%d%.png", "%099d.png"]
        {
            let error = Pattern::parse(bad.as_ref()).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains("%04d") && error.contains(bad), "{error}");
        }
    }
}
