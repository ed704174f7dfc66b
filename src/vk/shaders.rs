//! SPIR-V of every stage, layouts of the structs shared with it and numbers of its specialization constants, written by `build.rs`.

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
