//! Exit codes, and the line that says why.

use super::args::Surfel;
use clap::CommandFactory;
use std::process::ExitCode;
use surfel::Error;

/// An input cannot be read or used, an output cannot be written, or memory ran out.
const DATA: u8 = 1;
/// The command line is wrong.
const USAGE: u8 = 2;
/// No usable Vulkan device, no display for a window, or no validation layer where one is asked for.
const NO_DEVICE: u8 = 3;
/// A picture is not as good as the command line demands.
#[cfg(feature = "metrics")]
const VIOLATED: u8 = 4;
/// The device was lost.
const LOST: u8 = 5;
/// The validation layers found something: what BSD calls an internal error of the software.
const INVALID: u8 = 70;

/// Says what went wrong.
pub fn of_error(error: &Error) -> ExitCode {
    say(&format!("{error}{}", remedy(error)));
    ExitCode::from(code(error))
}

/// Says how many messages of the validation layers there were, if any; the layers' own words were logged.
pub fn of_messages(count: usize) -> ExitCode {
    match count {
        0 => ExitCode::SUCCESS,
        _ => {
            say(&format!(
                "the validation layers have {count} messages, see above: this is a mistake in surfel, report it"
            ));
            ExitCode::from(INVALID)
        }
    }
}

/// Says which limits were crossed; there is at least one.
#[cfg(feature = "metrics")]
pub fn of_violations(violations: &[String]) -> ExitCode {
    say(&violations.join("; "));
    ExitCode::from(VIOLATED)
}

/// Shows the help that was asked for, or says in one line what is wrong with the arguments.
pub fn of_arguments(error: &clap::Error) -> ExitCode {
    use clap::error::ErrorKind::{DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand, DisplayVersion};
    match error.kind() {
        DisplayHelp | DisplayVersion | DisplayHelpOnMissingArgumentOrSubcommand => {
            // Nothing can be said where the help itself cannot be shown.
            let _ = error.print();
        }
        _ => {
            let command =
                std::env::args().nth(1).filter(|name| Surfel::command().find_subcommand(name).is_some());
            let help = command.map_or("`surfel --help`".into(), |name| format!("`surfel {name} --help`"));
            say(&format!("{}; {help} says more", in_one_line(&error.render().to_string())));
        }
    }
    // clap's own code: 2 for mistakes, 0 for help.
    ExitCode::from(error.exit_code() as u8)
}

fn code(error: &Error) -> u8 {
    match error {
        _ if error.is_device_lost() => LOST,
        Error::Usage(_) => USAGE,
        Error::NoDevice(_) | Error::NoWindow(_) => NO_DEVICE,
        _ => DATA,
    }
}

/// By which option or command what an error asks for can be had; what to do about a failed Vulkan call.
fn remedy(error: &Error) -> &'static str {
    match error {
        Error::Usage(text) if text.contains("normalization weights: capture") => {
            " (`surfel convert --weights` captures them)"
        }
        Error::Usage(text) if text.contains("choose half precision") => " (--half is half precision)",
        Error::NoDevice(text) if text.ends_with("choose another device") => " with --device",
        Error::NoWindow(_) => "; `surfel render` needs no display",
        _ if error.is_device_lost() => {
            "; the driver gave up: try fewer points, or another device with --device"
        }
        Error::Vulkan { .. } => "; use fewer points or a smaller picture, or another device with --device",
        _ => "",
    }
}

/// clap explains itself in several paragraphs: the first says what is wrong, tips say what may have been meant.
fn in_one_line(text: &str) -> String {
    let mut paragraphs =
        text.split("\n\n").map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>().join(" "));
    let cause = paragraphs.next().unwrap_or_default();
    let tips: String =
        paragraphs.filter_map(|text| Some(format!("; {}", text.strip_prefix("tip: ")?))).collect();
    format!("{}{tips}", cause.trim_start_matches("error: "))
}

fn say(text: &str) {
    // A file may be named anything: a message stays one line.
    eprintln!("surfel: error: {}", text.replace(['\n', '\r'], " "));
}
