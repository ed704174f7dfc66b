//! What several integration tests share; none uses all of it.
#![allow(dead_code)]

pub mod gpu;
pub mod layouts;
pub mod mesh;
pub mod placing;
pub mod pyramids;
pub mod results;
pub mod sampling;
pub mod scenes;
pub mod settings;
pub mod texture;
pub mod truth;

/// Whether every combination is tested, as `tools/test --all` does, rather than some of each choice.
pub fn whole_matrix() -> bool {
    std::env::var_os("SURFEL_TEST_ALL").is_some()
}

/// The first in the whole matrix, else the second.
pub fn if_whole<T>(whole: T, short: T) -> T {
    if whole_matrix() { whole } else { short }
}
