//! Measuring speed against error.

pub mod hard;
pub mod record;
mod times;

pub use record::Results;
pub use times::{Statistics, Times};
