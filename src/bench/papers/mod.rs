//! What the papers show and say, measured here: their figures' effects, what they say that something costs, their tables of times.
//!
//! Each is a [part](super::record::Run::part) of the suite `papers` by its name: what it is of, and what is expected, is looked up here.

pub mod claims;
pub mod details;
pub mod effects;
pub mod tables;
mod text;

pub use text::text;
pub(super) use text::{here, published, ratio, side, verdicts};

use super::record::{Figure, Run};

/// The runs of a part, in the order in which they were planned.
pub fn runs<'a>(all: &'a [Run], figure: Figure, part: &str) -> Vec<&'a Run> {
    all.iter().filter(|run| run.figure == figure && run.part == part).collect()
}
