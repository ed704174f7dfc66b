//! The library: pictures against the float64 reference and exact truth, files, estimates, measurements. One program, whose tests run side by
//! side.

mod agreement;
mod baseline;
mod bench;
mod bench_advice;
mod bench_machines;
mod bench_report;
mod bench_schema;
mod bench_session;
mod bench_text;
mod capture;
mod creases;
mod discs;
mod disturbance;
mod edges;
mod estimate;
mod filter;
mod footprint;
mod frames;
mod hard;
mod hostile;
mod instances;
mod levels;
mod lines;
mod materials;
mod mesh_outlines;
mod papers;
mod ply_edge;
mod pull_push;
mod pull_push_levels;
mod pull_push_lines;
mod pull_push_points;
mod pull_push_sizes;
mod pull_push_surfaces;
mod rasterizers;
mod reference;
mod scans;
#[cfg(feature = "compile-shaders")]
mod shaders;
mod sides;
mod specks;
mod sphere;
#[path = "../support/mod.rs"]
mod support;
mod texture;
mod tiles;
