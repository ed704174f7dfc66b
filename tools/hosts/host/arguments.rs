//! Command line of the hosts.

use std::ffi::OsString;
use std::path::PathBuf;
use surfel::Settings;
use surfel::settings::Shading;
use surfel::settings::methods::Method;

/// Mode of a host.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Renders a picture to a PNG file.
    Picture(PathBuf),
    /// Opens a window.
    #[default]
    Window,
    /// Opens a window that changes its size and contents by itself.
    Soak,
    /// Compares with the engine's frames.
    Check,
}

/// Parsed command line.
#[derive(Clone, Debug, Default)]
pub struct Arguments {
    pub mode: Mode,
    pub method: Option<Method>,
    /// A PLY file, in place of the host's surfels.
    pub model: Option<PathBuf>,
    /// Number of the host's surfels.
    pub points: Option<u32>,
    /// Number of frames; the last one is the picture.
    pub frames: Option<u64>,
    /// Eye-dome lighting.
    pub edl: bool,
    /// Ambient occlusion.
    pub ao: bool,
}

const USAGE: &str = "give FILE.png, --window, --soak or --check; \
    and --method NAME, --model FILE.ply, --points N, --frames N, --edl, --ao where they are wanted";

impl Arguments {
    /// Parses the program's arguments; a window without any.
    pub fn of_program() -> Result<Self, String> {
        Self::of(std::env::args_os().skip(1))
    }

    fn of(arguments: impl IntoIterator<Item = OsString>) -> Result<Self, String> {
        let (mut parsed, mut mode) = (Self::default(), None);
        let mut arguments = arguments.into_iter();
        while let Some(argument) = arguments.next() {
            let name = argument.to_str().unwrap_or_default().to_owned();
            let mut value = || arguments.next().ok_or_else(|| format!("{name} wants a value: {USAGE}"));
            let next = match name.as_str() {
                "--window" => Mode::Window,
                "--soak" => Mode::Soak,
                "--check" => Mode::Check,
                "--method" => {
                    parsed.method = Some(method(&value()?)?);
                    continue;
                }
                "--model" => {
                    parsed.model = Some(value()?.into());
                    continue;
                }
                "--points" => {
                    parsed.points = Some(number(&name, &value()?)?);
                    continue;
                }
                "--frames" => {
                    parsed.frames = Some(number(&name, &value()?)?);
                    continue;
                }
                "--edl" => {
                    parsed.edl = true;
                    continue;
                }
                "--ao" => {
                    parsed.ao = true;
                    continue;
                }
                option if option.starts_with('-') => return Err(format!("{option} is no option: {USAGE}")),
                _ => Mode::Picture(argument.into()),
            };
            if mode.replace(next).is_some() {
                return Err(format!("one thing at a time: {USAGE}"));
            }
        }
        Ok(Self { mode: mode.unwrap_or_default(), ..parsed })
    }

    /// Render settings.
    pub fn settings(&self) -> Settings {
        let mut settings = self.method.map_or_else(Settings::default, |method| method.settings());
        if self.edl {
            settings.shading = Shading::Edl;
        }
        if self.ao {
            settings.ao = Settings::DEFAULT_AO;
        }
        settings
    }
}

fn method(name: &OsString) -> Result<Method, String> {
    let found = name.to_str().and_then(Method::named);
    let names = || Method::ALL.map(|method| method.name).join(", ");
    found.ok_or_else(|| format!("{} is no method: give one of {}", name.display(), names()))
}

/// A number above 0.
fn number<T: std::str::FromStr + Default + PartialEq>(name: &str, text: &OsString) -> Result<T, String> {
    let number = text.to_str().and_then(|text| text.parse().ok()).filter(|number| *number != T::default());
    number.ok_or_else(|| format!("{name} wants a whole number above 0, not {}", text.display()))
}
