//! What the papers say and show, measured here: effects of their figures, costs, and tables of times.
//!
//! Each is an [item](super::record::Run::paper_item) of the suite `papers`, looked up here by name, and rendered by the presets as
//! [published](Method::PAPERS). Whether a result is as in a paper is decided only of what the paper says, with its
//! [quotation](quotation::Quotation). What we claim beyond the papers stands apart. The [`inventory`] lists every figure and table.

pub mod costs;
pub mod details;
pub mod effects;
pub mod inventory;
pub mod models;
pub mod quotation;
pub mod relation;
pub mod tables;
mod text;

pub use text::text;
pub(super) use text::{model_words, not_given, points, ratio, row_result, run_label};

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
