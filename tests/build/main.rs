//! What `build.rs` makes: compiled shaders, their reflection as Rust, the digest of the code; and what holds for all
//! sources and texts: layers, words, links.

mod code_digest;
mod hosts;
mod layers;
mod links;
mod roots;
mod shaders;
mod words;

#[allow(dead_code)]
#[path = "../../tools/code_digest.rs"]
mod build_code_digest;
#[allow(dead_code)]
#[path = "../../tools/shader_build/mod.rs"]
mod shader_build;
#[allow(dead_code)]
#[path = "../support/skipping.rs"]
mod skipping;
