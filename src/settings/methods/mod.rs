//! Presets: one file per method with its paper, its pipeline figure, and its choices of [`Splatting`] or [`pull_push`].
//!
//! # How to add a method
//!
//! 1. `settings/methods/NAME.rs`: its paper and its pipeline figure in the documentation, and a [`Method`] of its choices.
//! 2. Here: its module, and its place at the end of [`Method::SPLATTING`], or of what [`Method::OWN`] adds to that: the first is the default.
//!    As published, it belongs at the end of [`Method::PAPERS`]. Command line, window, benchmark and tests go by these lists.
//!
//! A method that needs a choice which no axis has adds it to the axis' enum in [`splatting`](super::splatting), to the shader that branches
//! on it, and to the reference function with the shader's name.

pub mod confetti;
pub mod object_ewa;
pub mod perspective_ewa;
pub mod points;
pub mod pull_push;
pub mod sprites;

use crate::settings::pull_push::PullPush;
use crate::settings::splatting::Splatting;
use crate::settings::{Alpha, Cull, Edges, Settings, Widen};

/// Variance of the pixel filter of our presets, px²: three quarters of a low-pass variance of 1. The rest, in the splats, has no effect on
/// outlines.
const PIXEL_FILTER: f32 = 0.75;

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
    /// See [`Settings::pixel_filter`].
    pub pixel_filter: f32,
    /// See [`Settings::widen`].
    pub widen: Widen,
    /// See [`Settings::cull`].
    pub cull: Cull,
    /// See [`Settings::alpha`].
    pub alpha: Alpha,
    /// See [`Settings::edges`].
    pub edges: Edges,
}

impl Method {
    /// All presets of splatting.
    pub const SPLATTING: [Self; 5] =
        [perspective_ewa::METHOD, object_ewa::METHOD, sprites::METHOD, sprites::UNFILTERED, confetti::METHOD];

    /// Our presets: the papers' methods, improved where measurements support it.
    pub const OWN: [Self; 6] = {
        let [a, b, c, d, e] = Self::SPLATTING;
        [a, b, c, d, e, pull_push::METHOD]
    };

    /// The presets as published, which changes of our presets do not affect. The suite `papers` renders by them; they are never recommended.
    pub const PAPERS: [Self; 5] =
        [perspective_ewa::PAPER, object_ewa::PAPER, sprites::PAPER, confetti::PAPER, pull_push::PAPER];

    /// All presets.
    pub const ALL: [Self; 11] = {
        let [a, b, c, d, e, f] = Self::OWN;
        let [g, h, i, j, k] = Self::PAPERS;
        [a, b, c, d, e, f, g, h, i, j, k]
    };

    /// All that can be chosen: the presets, and points of a fixed size.
    pub const CHOICES: [Self; 12] = {
        let [a, b, c, d, e, f, g, h, i, j, k] = Self::ALL;
        [a, b, c, d, e, f, g, h, i, j, k, points::METHOD]
    };

    /// The choice with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::CHOICES.into_iter().find(|method| method.name == name)
    }

    /// Whether it is one of [`Self::PAPERS`].
    pub fn is_as_published(&self) -> bool {
        Self::PAPERS.iter().any(|method| method.name == self.name)
    }

    /// Settings of the preset.
    pub fn settings(&self) -> Settings {
        Settings {
            splatting: self.splatting,
            pull_push: self.pull_push,
            cutoff: self.cutoff,
            lowpass: self.lowpass,
            pixel_filter: self.pixel_filter,
            widen: self.widen,
            cull: self.cull,
            alpha: self.alpha,
            edges: self.edges,
            ..Default::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::splatting::{Filter, Footprint, Kernel, Shade};

    #[test]
    fn the_default_settings_are_those_of_the_first_method() {
        assert_eq!(perspective_ewa::METHOD.settings(), Settings::default());
    }

    #[test]
    fn presets_are_valid_and_distinct() {
        for method in Method::CHOICES {
            method.settings().check().unwrap();
            assert_eq!(Method::named(method.name), Some(method));
        }
        let [own, papers] = [&Method::OWN[..], &Method::PAPERS].map(|list| list.iter());
        assert!(own.clone().all(|method| !method.is_as_published()));
        assert!(papers.clone().all(|method| method.name.ends_with("-paper")));
    }

    /// The numbers of our presets: a change of one changes every picture and makes stored measurements incomparable.
    #[test]
    fn our_presets_have_these_numbers() {
        let confetti = Kernel::Confetti { a: 6.0, n: 3.0 };
        let [all, small] = [Widen::All, Widen::Small];
        let expected = [
            ("perspective-ewa", 3.5, 1.0, 0.75, small, Kernel::Gaussian),
            ("object-ewa", std::f32::consts::SQRT_2, 1.0, 0.75, all, Kernel::Gaussian),
            ("sprites", 2.0, 0.0, 0.75, all, Kernel::Gaussian),
            ("sprites-unfiltered", 2.0, 0.0, 0.0, all, Kernel::Gaussian),
            ("confetti", 2.0, 0.0, 0.75, all, confetti),
            ("pull-push", 3.5, 1.0, 0.0, small, Kernel::Gaussian),
        ];
        let numbers = |m: Method| (m.name, m.cutoff, m.lowpass, m.pixel_filter, m.widen, m.splatting.kernel);
        assert_eq!(Method::OWN.map(numbers), expected);
        for method in Method::CHOICES {
            let Settings { epsilon, edl, ao, point_size, lod, max_points, .. } = method.settings();
            let common = ([epsilon, edl, ao, point_size, lod], max_points);
            assert_eq!(common, ([1.0, 0.25, 0.0, 2.0, 0.0], None), "{}", method.name);
        }
        let where_none_is_given = [Settings::DEFAULT_AO, Settings::DEFAULT_PIXEL_FILTER];
        assert_eq!(where_none_is_given, [1.0, 0.75]);
    }

    /// The values that the papers state, with their sections in the presets' files.
    #[test]
    fn presets_as_published_have_the_published_values() {
        for method in Method::PAPERS.into_iter().filter(|method| method.pull_push.is_none()) {
            assert_eq!((method.splatting.shade, method.widen), (Shade::Splat, Widen::All), "{}", method.name);
        }
        let [perspective, object, sprites, confetti, pull_push] = Method::PAPERS;
        assert!(perspective.cutoff > 1.0 && perspective.cutoff < 2.0);
        assert_eq!((perspective.lowpass, object.lowpass), (1.0, 1.0));
        assert!((0.5 * object.cutoff * object.cutoff - 1.0).abs() < 1e-6);
        assert_eq!(sprites.splatting.footprint, Footprint::WholeSprite);
        assert_eq!(confetti.splatting.kernel, Kernel::Confetti { a: 6.0, n: 3.0 });
        let filters = [sprites, confetti].map(|method| method.splatting.filter);
        assert_eq!(filters, [Filter::None; 2]);
        assert!([object, sprites, confetti, pull_push].iter().all(|method| method.cull == Cull::Back));
    }
}
