//! `surfel completions` and `surfel man`: shell completions and man pages from the arguments.

use super::args::{Completions, Man, Surfel};
use super::files::print;
use clap::CommandFactory;
use surfel::formats::atomic;
use surfel::{Error, Result};

const NAME: &str = "surfel";

/// Prints the completion script of a shell.
pub fn completions(args: &Completions) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Surfel::command(), NAME, &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Writes the man pages.
pub fn man(args: &Man) -> Result<()> {
    const ACTION: &str = "cannot write the manual";
    atomic::create_folder(&args.folder, ACTION)?;
    clap_mangen::generate_to(Surfel::command(), &args.folder).map_err(Error::io(&args.folder, ACTION))
}
