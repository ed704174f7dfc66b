//! Statements of the papers, measured here: effects that their figures show, costs, and tables of times.
//!
//! Each is an [item](super::record::Run::paper_item) of the suite `papers`; its source and expectation are looked up
//! here by name.

pub mod claims;
pub mod details;
pub mod effects;
pub mod tables;
mod text;

pub use text::text;
pub(super) use text::{expectations, published, ratio, row_result, run_label};

use super::record::{Experiment, Run};
use crate::settings::methods::Method;

/// The runs of an item, in the order of their plans.
pub fn runs<'a>(all: &'a [Run], experiment: Experiment, item: &str) -> Vec<&'a Run> {
    all.iter().filter(|run| run.experiment == experiment && run.paper_item == item).collect()
}

/// The method of this name; the default one if there is none.
fn method(name: &str) -> Method {
    Method::named(name).unwrap_or(Method::SPLATTING[0])
}
