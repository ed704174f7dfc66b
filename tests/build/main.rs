//! What `build.rs` makes: compiled shaders, their reflection as Rust, the digest of the code.

#[allow(dead_code)]
#[path = "../../build.rs"]
mod build;
mod code_digest;
mod shaders;
