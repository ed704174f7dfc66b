//! How much of the matrix of choices is tested.

/// Whether every combination is tested, as `tools/test --all` does, rather than some of each choice.
pub fn whole_matrix() -> bool {
    std::env::var_os("SURFEL_TEST_ALL").is_some()
}

/// The first in the whole matrix, else the second.
pub fn if_whole<T>(whole: T, short: T) -> T {
    if whole_matrix() { whole } else { short }
}
