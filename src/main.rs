//! The `surfel` program: what it does is in `cli`.

mod cli;
#[cfg(feature = "viewer")]
mod viewer;

fn main() -> std::process::ExitCode {
    cli::run()
}
