//! One short file a method: its paper, its pipeline figure, and what it chooses along the axes of [`Splatting`]; and the passes that the
//! choices lead to, [`blended`] or [`nearest`]; or a [`pull_push`] of points.

pub mod blended;
mod canvas;
pub mod confetti;
pub mod nearest;
pub mod object_ewa;
pub mod perspective_ewa;
pub mod pull_push;
pub mod sprites;

pub use canvas::{Canvas, Composited, Pipelines};

use crate::pull_push::PullPush;
use crate::settings::{Cull, Settings, Widen};
use crate::splatting::{Splatting, Visibility};
use crate::variant::{Rasterizer, Variant};

/// A method as its paper has it, or as measurements improve on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// The name on the command line and in reports.
    pub name: &'static str,
    /// Authors, title, year.
    pub paper: &'static str,
    /// Its choice along each axis; of no use where it is one of `pull_push`.
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
    /// Every preset that splats.
    pub const SPLATTING: [Self; 5] =
        [perspective_ewa::METHOD, object_ewa::METHOD, sprites::METHOD, sprites::UNFILTERED, confetti::METHOD];

    /// Every preset.
    pub const ALL: [Self; 7] = {
        let [a, b, c, d, e] = Self::SPLATTING;
        [a, b, c, d, e, pull_push::METHOD, pull_push::PAPER]
    };

    /// The preset of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name == name)
    }

    /// The preset with these axes.
    pub fn of(splatting: &Splatting) -> Option<Self> {
        Self::SPLATTING.into_iter().find(|method| method.splatting == *splatting)
    }

    /// Its settings.
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

/// The passes of a frame, in their order; what only clears or reads back is none.
pub fn passes(variant: &Variant) -> Vec<&'static str> {
    if let Some(PullPush { storage, .. }) = variant.pull_push {
        return pull_push::passes(storage).into();
    }
    let computed = variant.rasterizer == Rasterizer::Compute;
    let list = match variant.visibility {
        Visibility::Nearest if computed => &["footprint", "nearest", "resolve", "normalize"][..],
        Visibility::Nearest => &["footprint", "nearest", "normalize"],
        Visibility::Ray if computed => &["footprint", "visibility", "tiles", "attribute", "normalize"],
        Visibility::Ray => &["footprint", "visibility", "attribute", "normalize"],
        Visibility::Axis if computed => {
            &["footprint", "visibility", "tiles", "footprint", "attribute", "normalize"]
        }
        Visibility::Axis => &["footprint", "visibility", "footprint", "attribute", "normalize"],
    };
    list.to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_settings_are_those_of_the_first_method() {
        assert_eq!(perspective_ewa::METHOD.settings(), Settings::default());
    }

    #[test]
    fn presets_can_be_rendered_and_told_apart() {
        for method in Method::ALL {
            method.settings().check().unwrap();
            assert_eq!(Method::named(method.name), Some(method));
        }
        for method in Method::SPLATTING {
            assert_eq!(Method::of(&method.splatting), Some(method));
        }
    }
}
