//! The code that this program was built from.

/// Digest of the source files: results of a program with another digest may be out of date.
pub const DIGEST: &str = env!("SURFEL_CODE");

/// The commit, with `+` appended if files had been changed; empty if it was built outside a repository.
pub const COMMIT: &str = env!("SURFEL_COMMIT");
