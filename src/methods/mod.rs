//! One short file a method: its paper and its passes in their order.

mod perspective_ewa;

pub use perspective_ewa::{PerspectiveEwa, Views};
