//! Metadata of written files: what the defaults of a picture depend on, and the points do not tell.

use glam::DVec3;
use std::fmt;

/// Where the normals of a file come from, and which direction is up. Files that [`write()`](super::write()) wrote have it, as a text such as
/// `up=0,0,1 normals=estimated scattered=0.12`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metadata {
    /// The up direction, a unit vector; `None` if it is not known.
    pub up: Option<DVec3>,
    /// Whether all normals are estimated from points that had neither normals nor faces nor lines.
    pub estimated: bool,
    /// Whether no normal has a known side, for formats without a flag of each point.
    pub two_sided: bool,
    /// Part of the points whose estimated normals mean nothing.
    pub scattered: f64,
}

/// Name by which files mark the text as one of this program.
pub(super) const OWNER: &str = "surfel";

impl Metadata {
    /// Whether a text has the form of one that is written: each word is `name=value`.
    pub(super) fn is_text(text: &str) -> bool {
        let is_assignment = |word: &str| {
            word.split_once('=').is_some_and(|(name, value)| !name.is_empty() && !value.is_empty())
        };
        text.split_whitespace().all(is_assignment)
    }

    /// Parses a text. What it does not know, as of later versions, is left out.
    pub(super) fn parse(text: &str) -> Self {
        let mut metadata = Self::default();
        for (name, value) in text.split_whitespace().filter_map(|word| word.split_once('=')) {
            match name {
                "up" => metadata.up = direction(value),
                "normals" => metadata.estimated = value == "estimated",
                "sides" => metadata.two_sided = value == "unknown",
                "scattered" => metadata.scattered = part(value).unwrap_or_default(),
                _ => {}
            }
        }
        metadata
    }

    /// The text; `None` if there is nothing to tell.
    pub(super) fn text(&self) -> Option<String> {
        (*self != Self::default()).then(|| self.to_string())
    }
}

impl fmt::Display for Metadata {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let up = self.up.map(|up| format!("up={},{},{}", up.x, up.y, up.z));
        let estimated = self.estimated.then(|| "normals=estimated".to_owned());
        let sides = self.two_sided.then(|| "sides=unknown".to_owned());
        let scattered = (self.scattered > 0.0).then(|| format!("scattered={}", self.scattered));
        let words: Vec<String> = [up, estimated, sides, scattered].into_iter().flatten().collect();
        f.write_str(&words.join(" "))
    }
}

/// A unit vector of three numbers.
fn direction(text: &str) -> Option<DVec3> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.parse().ok()).collect();
    let up = DVec3::from(<[f64; 3]>::try_from(numbers?).ok()?);
    // One that is written is not changed by rounding.
    if up.is_normalized() { Some(up) } else { up.try_normalize() }
}

/// A number from 0 to 1.
fn part(text: &str) -> Option<f64> {
    text.parse().ok().filter(|part| (0.0..=1.0).contains(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_reads_back() {
        let up = DVec3::new(0.1, -0.7, 1.0 / 3.0).normalize();
        for metadata in [
            Metadata { up: Some(DVec3::Z), ..Default::default() },
            Metadata { up: Some(up), estimated: true, two_sided: true, scattered: 1.0 / 3.0 },
        ] {
            assert_eq!(Metadata::parse(&metadata.text().unwrap()), metadata);
        }
        assert_eq!(Metadata::default().text(), None);
    }

    #[test]
    fn damaged_words_are_left_out() {
        let parsed = Metadata::parse("up=0,0 normals=given sides=all scattered=nan colour=red up scattered");
        assert_eq!(parsed, Metadata::default());
        assert_eq!(Metadata::parse("up=0,0,0").up.or(Metadata::parse("up=0,inf,0").up), None);
        assert_eq!(Metadata::parse("later=1,2\tup=0,0,2").up, Some(DVec3::Z));
        assert_eq!(Metadata::parse("scattered=1.5").scattered, 0.0);
    }
}
