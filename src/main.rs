//! The `surfel` program.
fn main() {}
