//! Measuring speed against error.

pub mod advice;
pub mod csv;
pub mod falling;
pub mod record;
pub mod report;
mod show;
mod table;
mod times;

pub use record::Results;
pub use table::table;
pub use times::{Statistics, Times};
