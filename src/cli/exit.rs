//! Exit codes, and the line that says why.

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
        _ => say(&format!("{}; `surfel --help` and `surfel render --help` say more", first_paragraph(error))),
    }
    // clap's own code: 2 for mistakes, 0 for help.
    ExitCode::from(error.exit_code() as u8)
}

fn code(error: &Error) -> u8 {
    match error {
        _ if error.is_device_lost() => LOST,
        Error::Usage(_) => USAGE,
        Error::NoDevice(_) | Error::NoWindow(_) => NO_DEVICE,
        Error::Input { .. }
        | Error::Io { .. }
        | Error::Memory { .. }
        | Error::Vulkan { .. }
        | Error::Cancelled => DATA,
    }
}

/// What to do about a failed Vulkan call; every other error says it itself.
fn remedy(error: &Error) -> &'static str {
    match error {
        _ if error.is_device_lost() => {
            "; the driver gave up: try fewer points, or another device with --device"
        }
        Error::Vulkan { .. } => "; use fewer points or a smaller picture, or another device with --device",
        _ => "",
    }
}

/// clap explains itself in several paragraphs: the first says what is wrong.
fn first_paragraph(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let words = text.split("\n\n").next().unwrap_or_default().split_whitespace();
    words.collect::<Vec<_>>().join(" ").trim_start_matches("error: ").to_owned()
}

fn say(text: &str) {
    // A file may be named anything: a message stays one line.
    eprintln!("surfel: error: {}", text.replace(['\n', '\r'], " "));
}
