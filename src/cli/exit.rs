//! Exit codes and error messages.

use super::args::Surfel;
use clap::CommandFactory;
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;
use surfel::Error;

/// An input cannot be read or used, an output cannot be written, or memory ran out.
const DATA: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;
/// No usable Vulkan device, no display for a window, or no validation layer where one is asked for.
const NO_DEVICE: u8 = 3;
/// A metric violates a limit of the command line.
#[cfg(feature = "metrics")]
const VIOLATED: u8 = 4;
/// The device was lost.
const LOST: u8 = 5;
/// The validation layers reported a message: an internal software error, as in BSD's sysexits.
const INVALID: u8 = 70;

/// Prints an error; returns its exit code. A program that reads standard output and stops, as `head` does, has what it wants.
pub fn of_error(error: &Error) -> ExitCode {
    if is_closed_pipe(error) {
        return ExitCode::SUCCESS;
    }
    let detached =
        detached_value(error, std::env::args_os()).map_or(String::new(), |text| format!("; {text}"));
    print_error(&format!("{error}{}{detached}", remedy(error)));
    ExitCode::from(code(error))
}

/// Whether nothing reads standard output any more.
fn is_closed_pipe(error: &Error) -> bool {
    let Error::Io { path, source, .. } = error else { return false };
    path == Path::new("-") && source.kind() == ErrorKind::BrokenPipe
}

/// What to write instead, if a file that does not exist comes after an option that takes its value after `=` alone.
fn detached_value(error: &Error, arguments: impl Iterator<Item = OsString>) -> Option<String> {
    let Error::Io { path, source, .. } = error else { return None };
    let arguments: Vec<String> = arguments.map(|text| text.to_string_lossy().into_owned()).collect();
    let surfel = Surfel::command();
    let command = surfel.find_subcommand(arguments.get(1)?)?;
    let takes_value = |option: &String| {
        let name = option.strip_prefix("--").filter(|name| !name.is_empty());
        let is_named = |arg: &clap::Arg| {
            let aliases = arg.get_all_aliases().unwrap_or_default();
            arg.get_long() == name || name.is_some_and(|name| aliases.contains(&name))
        };
        command.get_arguments().any(|arg| name.is_some() && arg.is_require_equals_set() && is_named(arg))
    };
    let is_value = |value: &String| source.kind() == ErrorKind::NotFound && Path::new(value) == path;
    let (option, value) =
        arguments.iter().zip(arguments.iter().skip(1)).find(|(a, b)| takes_value(a) && is_value(b))?;
    Some(format!("{option} takes its value with `=`: {option}={value}"))
}

/// Prints the number of messages of the validation layers, if there are any; the messages themselves were logged.
pub fn of_messages(count: usize) -> ExitCode {
    match count {
        0 => ExitCode::SUCCESS,
        _ => {
            print_error(&format!(
                "the validation layers reported {count} messages, see above: this is a bug of surfel, please report it"
            ));
            ExitCode::from(INVALID)
        }
    }
}

/// Prints the violated limits; there is at least one.
#[cfg(feature = "metrics")]
pub fn of_violations(violations: &[String]) -> ExitCode {
    print_error(&violations.join("; "));
    ExitCode::from(VIOLATED)
}

/// Prints the help, or one line that says what is wrong with the arguments.
pub fn of_arguments(error: &clap::Error) -> ExitCode {
    use clap::error::ErrorKind::{DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand, DisplayVersion};
    match error.kind() {
        DisplayHelp | DisplayVersion | DisplayHelpOnMissingArgumentOrSubcommand => {
            // If the help cannot be printed, neither can an error.
            let _ = error.print();
        }
        _ => {
            let command =
                std::env::args().nth(1).filter(|name| Surfel::command().find_subcommand(name).is_some());
            let help = command.map_or("`surfel --help`".into(), |name| format!("`surfel {name} --help`"));
            print_error(&format!("{}; {help} says more", in_one_line(&error.render().to_string())));
        }
    }
    // clap's exit code: 2 for errors, 0 for help.
    ExitCode::from(error.exit_code() as u8)
}

/// Exit code of an error.
fn code(error: &Error) -> u8 {
    match error {
        _ if error.is_device_lost() => LOST,
        Error::Usage(_) => USAGE,
        Error::NoDevice(_) | Error::NoWindow(_) => NO_DEVICE,
        _ => DATA,
    }
}

/// What to do about an error: the option or command that remedies it.
pub(super) fn remedy(error: &Error) -> &'static str {
    match error {
        Error::Usage(text) if text.contains("normalization weights: capture") => {
            " (`surfel convert --weights` captures them)"
        }
        Error::Usage(text) if text.starts_with("the pyramids of a picture") => " with --size",
        Error::Input { cause, .. } if cause.ends_with("no spacing: give a radius") => " with --radius",
        Error::Input { cause, .. } if cause.contains("name the columns, ") => " with --columns",
        Error::NoDevice(text) if text.ends_with("choose another device") => " with --device",
        Error::NoWindow(_) => "; `surfel render` needs no display",
        _ if error.is_device_lost() => {
            "; the driver reset the device: try fewer points, or another device with --device"
        }
        Error::Vulkan { .. } => "; use fewer points or a smaller picture, or another device with --device",
        _ => "",
    }
}

/// Joins an error of clap to one line: its first paragraph is the cause, tips are suggestions.
fn in_one_line(text: &str) -> String {
    let mut paragraphs =
        text.split("\n\n").map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>().join(" "));
    let cause = paragraphs.next().unwrap_or_default();
    let tips: String =
        paragraphs.filter_map(|text| Some(format!("; {}", text.strip_prefix("tip: ")?))).collect();
    format!("{}{tips}", cause.trim_start_matches("error: "))
}

/// Prints an error line to standard error.
fn print_error(text: &str) {
    // Names of files may contain line breaks.
    eprintln!("surfel: error: {}", text.replace(['\n', '\r'], " "));
}
