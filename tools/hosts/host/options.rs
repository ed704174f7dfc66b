//! The hosts' command lines.

use std::path::PathBuf;

/// What a host is asked to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// A picture in a file, a PNG.
    Picture(PathBuf),
    /// A window, for so many frames or until it is closed.
    Window(Option<u64>),
    /// A comparison with the engine's own frames.
    Check,
}

/// Reads the arguments: a file, `--window`, `--frames` with a number, `--check`. The window, if there are none.
pub fn wanted(arguments: impl IntoIterator<Item = std::ffi::OsString>) -> Result<Wanted, String> {
    let mut wanted = None;
    let mut frames = None;
    let mut arguments = arguments.into_iter().skip(1);
    while let Some(argument) = arguments.next() {
        let next = match argument.to_str() {
            Some("--window") => Wanted::Window(None),
            Some("--check") => Wanted::Check,
            Some("--frames") => {
                let number = arguments.next().and_then(|number| number.to_str()?.parse().ok());
                frames = Some(number.ok_or("--frames wants a number")?);
                continue;
            }
            Some(option) if option.starts_with('-') => {
                return Err(format!("{option} is no option: give FILE.png, --window or --check"));
            }
            _ => Wanted::Picture(argument.into()),
        };
        if wanted.replace(next).is_some() {
            return Err("give one of FILE.png, --window and --check".into());
        }
    }
    match (wanted.unwrap_or(Wanted::Window(None)), frames) {
        (Wanted::Window(_), frames) => Ok(Wanted::Window(frames)),
        (wanted, None) => Ok(wanted),
        (_, Some(_)) => Err("--frames is for --window".into()),
    }
}
