//! Which code this program was built from.

/// Digest of its source files: what was measured by a program of another digest may be out of date.
pub const DIGEST: &str = env!("SURFEL_CODE");

/// The commit, with `+` behind it if files had been changed since; empty if it was built outside a repository.
pub const COMMIT: &str = env!("SURFEL_COMMIT");
