//! End-to-end tests of the `surfel` program: arguments in; exit code, streams and files out.

mod against_mesh;
mod bench;
mod cameras;
mod colours;
mod compare;
mod convert;
mod errors;
mod formats;
mod guide;
mod hierarchy;
mod info;
mod inputs;
mod lines;
mod listings;
#[path = "../support/matrix.rs"]
mod matrix;
mod program;
mod render;
mod report;
mod scans;
mod scenes;
mod truth;
