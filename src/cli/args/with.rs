//! `--with` of `surfel bench`: options of `surfel render` in one argument.

use super::{Axes, RenderSettings};
use clap::Parser;
use std::ffi::OsString;
use surfel::settings::methods::Method;
use surfel::settings::{Hierarchy, Settings};
use surfel::{Error, Result};

/// Options that change the settings of methods.
#[derive(Clone, Debug)]
pub struct With {
    /// The options as they were given.
    pub text: String,
    options: Options,
}

#[derive(Clone, Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Options {
    #[command(flatten)]
    settings: RenderSettings,
    #[command(flatten)]
    axes: Axes,
}

impl With {
    /// The settings of a method with these options.
    ///
    /// # Errors
    /// [`Error::Usage`] if the method cannot render so.
    pub fn settings(&self, method: &Method) -> Result<Settings> {
        let settings = self.options.settings.settings(&self.options.axes, method);
        let why = |error| match error {
            Error::Usage(cause) => Error::Usage(format!("--with '{}', {}: {cause}", self.text, method.name)),
            error => error,
        };
        settings.check().map_err(why)?;
        Ok(settings)
    }
}

impl std::str::FromStr for With {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let options = Options::try_parse_from(text.split_whitespace().map(OsString::from));
        let options = options.map_err(|error| first_line(&error))?;
        let RenderSettings { shading, ao, point_size, max_points, hierarchy, edl, ref background, .. } =
            options.settings;
        let taken = [
            // It implies its shading.
            ("--edl", edl == Settings::DEFAULT_EDL),
            ("--shading", shading.is_none()),
            ("--ao", ao.is_none()),
            ("--background", background.linear().is_none()),
            ("--point-size", point_size.is_none()),
            ("--max-points", max_points.is_none()),
            ("--hierarchy", hierarchy == Hierarchy::default()),
        ];
        match taken.into_iter().find(|(_, is_default)| !is_default) {
            Some((name, _)) => Err(format!("{name} is not measured: leave it out")),
            None if text.trim().is_empty() => Err("no options: write such as '--lod 2'".into()),
            None => Ok(Self { text: text.into(), options }),
        }
    }
}

/// The cause alone: what follows in clap's message is of a command of its own.
fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use surfel::settings::methods::{perspective_ewa, pull_push};
    use surfel::settings::{Alpha, Edges};

    #[test]
    fn options_change_what_they_name() {
        let with: With = "--lod 2 --edges nearest  --alpha=mask".parse().unwrap();
        let preset = perspective_ewa::METHOD.settings();
        let expected = Settings { lod: 2.0, edges: Edges::Nearest, alpha: Alpha::Mask, ..preset };
        assert_eq!(with.settings(&perspective_ewa::METHOD).unwrap(), expected);
    }

    #[test]
    fn options_that_change_nothing_measured_are_refused() {
        let refused = |text: &str| text.parse::<With>().unwrap_err();
        for option in ["--shading edl", "--edl 2", "--ao", "--background white", "--point-size 3"] {
            let name = option.split(' ').next().unwrap();
            assert!(refused(option).starts_with(name), "{}", refused(option));
        }
        assert!(refused("--max-points 5").starts_with("--max-points"));
        assert!(refused("--hierarchy paper").starts_with("--hierarchy"));
        assert!(refused("--lod two").contains("two"));
        assert!(refused("--speed 2").contains("--speed"));
        assert!(refused(" ").contains("no options"));
    }

    #[test]
    fn a_method_that_cannot_render_so_is_named() {
        let with: With = "--shade splat".parse().unwrap();
        assert!(with.settings(&perspective_ewa::METHOD).is_ok());
        let error = with.settings(&pull_push::METHOD).unwrap_err().to_string();
        assert!(error.contains("--shade splat") && error.contains("pull-push"), "{error}");
    }
}
