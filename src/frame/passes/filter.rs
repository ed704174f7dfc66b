//! Filter: the lit picture → the picture convolved with a Gaussian, over the background (zwicker2004 equation 3, after light; `filter.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{FilteredRows, Image};
use crate::vk::shaders::{FILTER_COLUMNS_COMPUTE, FILTER_COMPUTE};

/// Filters along the rows.
pub static ROWS: Pass = Pass {
    name: "filter",
    reads: &[Image],
    writes: &[FilteredRows],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILTER_COMPUTE, Domain::Pixels)]),
    commands: Commands::Dispatches,
};

/// Filters along the columns, and blends with the background.
pub static COLUMNS: Pass = Pass {
    name: "filter",
    reads: &[FilteredRows],
    writes: &[Image],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILTER_COLUMNS_COMPUTE, Domain::Pixels)]),
    commands: Commands::Dispatches,
};
