//! One short file a method: its paper and its passes in their order.

pub mod perspective_ewa;
