//! The `surfel` program: what it does is in `cli`.

mod cli;
#[cfg(test)]
#[allow(dead_code, reason = "no test of the program reads data")]
#[path = "../tests/support/skipping.rs"]
mod skipping;
#[cfg(feature = "viewer")]
mod viewer;

fn main() -> std::process::ExitCode {
    cli::run()
}
