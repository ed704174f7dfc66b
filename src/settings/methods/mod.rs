//! Presets: one file per method with its paper, its pipeline figure, and its choices of [`Splatting`] or [`pull_push`].
//!
//! # How to add a method
//!
//! 1. `settings/methods/NAME.rs`: its paper and its pipeline figure in the documentation, and a [`Method`] of its choices.
//! 2. Here: its module, and its place at the end of [`Method::SPLATTING`], or of what [`Method::ALL`] adds to that: the first is the default.
//!    Command line, window, benchmark and tests go by these lists.
//!
//! A method that needs a choice which no axis has adds it to the axis' enum in [`splatting`](super::splatting), to the shader that branches
//! on it, and to the reference function with the shader's name.

pub mod confetti;
pub mod object_ewa;
pub mod perspective_ewa;
pub mod pull_push;
pub mod sprites;

use crate::settings::pull_push::PullPush;
use crate::settings::splatting::Splatting;
use crate::settings::{Cull, Settings, Widen};

/// A preset: a method as published, or as improved by measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Name on the command line and in reports.
    pub name: &'static str,
    /// Authors, title, year.
    pub paper: &'static str,
    /// The choice along each axis; unused with `pull_push`.
    pub splatting: Splatting,
    /// See [`Settings::pull_push`].
    pub pull_push: Option<PullPush>,
    /// See [`Settings::cutoff`].
    pub cutoff: f32,
    /// See [`Settings::lowpass`].
    pub lowpass: f32,
    /// See [`Settings::widen`].
    pub widen: Widen,
    /// See [`Settings::cull`].
    pub cull: Cull,
}

impl Method {
    /// All presets of splatting.
    pub const SPLATTING: [Self; 5] =
        [perspective_ewa::METHOD, object_ewa::METHOD, sprites::METHOD, sprites::UNFILTERED, confetti::METHOD];

    /// All presets.
    pub const ALL: [Self; 7] = {
        let [a, b, c, d, e] = Self::SPLATTING;
        [a, b, c, d, e, pull_push::METHOD, pull_push::PAPER]
    };

    /// The preset with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name == name)
    }

    /// Settings of the preset.
    pub fn settings(&self) -> Settings {
        Settings {
            splatting: self.splatting,
            pull_push: self.pull_push,
            cutoff: self.cutoff,
            lowpass: self.lowpass,
            widen: self.widen,
            cull: self.cull,
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_settings_are_those_of_the_first_method() {
        assert_eq!(perspective_ewa::METHOD.settings(), Settings::default());
    }

    #[test]
    fn presets_are_valid_and_distinct() {
        for method in Method::ALL {
            method.settings().check().unwrap();
            assert_eq!(Method::named(method.name), Some(method));
        }
    }
}
