//! Measuring speed against error.

pub mod record;
mod times;

pub use record::Results;
pub use times::{Statistics, Times};
