//! A scene's name and parameters: `scene:NAME?key=value&…`.

use super::catalogue::{self, SceneInfo};
use super::texture::Pattern;
use crate::error::{Error, Result};

/// Prefix of all scenes' names.
pub const PREFIX: &str = "scene:";

/// A parameter of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// Default value.
    pub default: &'static str,
    /// Allowed values.
    pub values: Values,
    /// Description, with the unit.
    pub meaning: &'static str,
}

/// Allowed values of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// A whole number from the first to the second.
    Whole(u64, u64),
    /// A number from the first to the second.
    Number(f64, f64),
    /// One of these words.
    Choice(&'static [&'static str]),
}

impl std::fmt::Display for Values {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Whole(0, u64::MAX) => write!(f, "a whole number, 0 or more"),
            Self::Whole(min, max) => write!(f, "a whole number from {min} to {max}"),
            Self::Number(min, max) => write!(f, "a number from {min} to {max}"),
            Self::Choice(words) => write!(f, "{}", either(words)),
        }
    }
}

impl Values {
    fn include(&self, value: &str) -> bool {
        match self {
            Self::Whole(min, max) => value.parse().is_ok_and(|value| (*min..=*max).contains(&value)),
            Self::Number(min, max) => value.parse().is_ok_and(|value| (*min..=*max).contains(&value)),
            Self::Choice(words) => words.contains(&value),
        }
    }
}

/// A parsed scene text; every value is valid.
pub struct Query<'a> {
    /// The scene.
    pub scene: &'static SceneInfo,
    given: Vec<(&'static str, &'a str)>,
}

impl<'a> Query<'a> {
    /// Parses `text`; [`Error::Usage`] if it is invalid, with a list of valid names.
    pub fn parse(text: &'a str) -> Result<Self> {
        let usage = |cause: String| Error::Usage(format!("{text}: {cause}"));
        let (name, query) = text.split_once('?').unwrap_or((text, ""));
        let scene = catalogue::list().iter().find(|scene| scene.name == name).ok_or_else(|| {
            let all: Vec<_> = catalogue::list().iter().map(|scene| scene.name).collect();
            usage(format!("there is no such scene: give {}", either(&all)))
        })?;
        let mut given: Vec<(&str, &str)> = Vec::new();
        for pair in query.split('&').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').unwrap_or((pair, ""));
            let parameter = scene.parameters().find(|parameter| parameter.name == key).ok_or_else(|| {
                let all: Vec<_> = scene.parameters().map(|parameter| parameter.name).collect();
                usage(format!("there is no parameter `{key}`: give {}", either(&all)))
            })?;
            if !parameter.values.include(value) {
                return Err(usage(format!("{key} is `{value}`: give {}", parameter.values)));
            }
            if given.iter().any(|(name, _)| *name == key) {
                return Err(usage(format!("{key} is given twice: give it once")));
            }
            given.push((parameter.name, value));
        }
        Ok(Self { scene, given })
    }

    /// Whether the text sets this parameter.
    pub fn is_given(&self, name: &str) -> bool {
        self.given.iter().any(|(given, _)| *given == name)
    }

    /// The value of a parameter that the scene has.
    pub fn word(&self, name: &str) -> &str {
        let given = self.given.iter().find(|(given, _)| *given == name).map(|(_, value)| *value);
        let default = || self.scene.parameters().find(|parameter| parameter.name == name);
        given.or_else(|| Some(default()?.default)).unwrap_or_default()
    }

    /// The value of a numeric parameter that the scene has.
    pub fn number(&self, name: &str) -> f64 {
        self.word(name).parse().unwrap_or_default()
    }

    /// The value of a whole-numbered parameter that the scene has.
    pub fn whole(&self, name: &str) -> u64 {
        self.word(name).parse().unwrap_or_default()
    }

    /// The pattern named by `albedo`.
    pub fn pattern(&self) -> Pattern {
        match self.word("albedo") {
            "checker" => Pattern::Checker,
            "stripes" => Pattern::Stripes,
            "zone" => Pattern::Zone,
            "gaussian" => Pattern::Gaussian,
            "noise" => Pattern::Noise,
            _ => Pattern::Plain,
        }
    }
}

/// `a, b or c`.
fn either(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [only] => (*only).into(),
        [rest @ .., last] => format!("{} or {last}", rest.join(", ")),
    }
}
