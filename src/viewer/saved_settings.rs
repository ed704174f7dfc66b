//! Saved settings: method, render settings and panel, kept from one run to the next.

use super::panels::UiState;
use super::state::ViewState;
use serde::{Deserialize, Serialize};
use std::io::{ErrorKind, Write};
use std::path::Path;
use surfel::formats::atomic;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::{PullPush, Storage};
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::settings::{Alpha, Choice, Cull, Edges, Shading, Widen};
use surfel::{Error, Result, Settings};

/// Method and settings, by the names of the command line's options.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSettings {
    method: String,
    footprint: String,
    /// a and n of the confetti kernel; `None` for the Gaussian.
    confetti: Option<[f32; 2]>,
    filter: String,
    visibility: String,
    normalization: String,
    shade: String,
    /// Whether pull–push stores its levels alternately in two pyramids.
    in_turns: bool,
    cutoff: f32,
    lowpass: f32,
    #[serde(default)]
    pixel_filter: f32,
    widen: String,
    #[serde(default = "default_point_size")]
    point_size: f32,
    epsilon: f32,
    cull: String,
    alpha: String,
    #[serde(default = "nearest")]
    edges: String,
    shading: String,
    #[serde(default = "default_edl")]
    edl: f32,
    #[serde(default)]
    ao: f32,
    /// Linear colour.
    background: Option<[f32; 3]>,
    /// Whether the panel is hidden.
    #[serde(rename = "hidden")]
    pub panel_hidden: bool,
    /// Whether there is a legend.
    #[serde(default = "shown")]
    pub legend: bool,
}

impl SavedSettings {
    /// Reads the saved settings; `None` if there are none or they are unusable, which is logged as a warning.
    pub fn read(path: &Path) -> Option<Self> {
        match Self::try_read(path) {
            Err(Error::Io { source, .. }) if source.kind() == ErrorKind::NotFound => None,
            Err(error) => {
                log::warn!("{error}; the saved settings are ignored");
                None
            }
            Ok(saved) => Some(saved),
        }
    }

    fn try_read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(Error::io(path, "cannot read"))?;
        let unusable = |cause: String| Error::input(path.display().to_string(), cause);
        let saved: Self = serde_json::from_slice(&text).map_err(|error| unusable(error.to_string()))?;
        let usable = saved.settings().is_some();
        usable.then_some(saved).ok_or_else(|| unusable("it holds unknown names or invalid values".into()))
    }

    /// The settings of the view, for any scene; `None` if no scene is shown.
    pub fn of(state: &ViewState, ui_state: &UiState) -> Option<Self> {
        let ([method, _], settings) = state.names().zip(state.settings_to_save())?;
        Some(Self::of_settings(method, &settings, [ui_state.panel_hidden, state.legend]))
    }

    fn of_settings(method: &str, settings: &Settings, [panel_hidden, legend]: [bool; 2]) -> Self {
        let Splatting { footprint, kernel, filter, visibility, normalization, shade } = settings.splatting;
        let storage = settings.pull_push.map(|pull_push| pull_push.storage);
        Self {
            method: method.into(),
            footprint: footprint.name().into(),
            confetti: match kernel {
                Kernel::Gaussian => None,
                Kernel::Confetti { a, n } => Some([a, n]),
            },
            filter: filter.name().into(),
            visibility: visibility.name().into(),
            normalization: normalization.name().into(),
            shade: shade.name().into(),
            in_turns: storage == Some(Storage::PingPong),
            cutoff: settings.cutoff,
            lowpass: settings.lowpass,
            pixel_filter: settings.pixel_filter,
            widen: settings.widen.name().into(),
            point_size: settings.point_size,
            epsilon: settings.epsilon,
            cull: settings.cull.name().into(),
            alpha: settings.alpha.name().into(),
            edges: settings.edges.name().into(),
            shading: settings.shading.name().into(),
            edl: settings.edl,
            ao: settings.ao,
            background: settings.background,
            panel_hidden,
            legend,
        }
    }

    /// Writes the file atomically and creates its folder if needed.
    pub fn write(&self, path: &Path) -> Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot create the folder"))?;
        }
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        atomic::write(path, |out| writeln!(out, "{text}"))
    }

    /// The method and its settings; `None` if a name is unknown or the settings are invalid.
    pub fn settings(&self) -> Option<(Method, Settings)> {
        let method = Method::named(&self.method)?;
        let preset = method.settings();
        let storage = if self.in_turns { Storage::PingPong } else { Storage::Apart };
        let settings = Settings {
            splatting: self.splatting()?,
            pull_push: preset.pull_push.map(|pull_push| PullPush { storage, ..pull_push }),
            cutoff: self.cutoff,
            lowpass: self.lowpass,
            pixel_filter: self.pixel_filter,
            point_size: self.point_size,
            lod: 0.0,
            max_points: None,
            widen: Widen::named(&self.widen)?,
            epsilon: self.epsilon,
            cull: Cull::named(&self.cull)?,
            alpha: Alpha::named(&self.alpha)?,
            edges: Edges::named(&self.edges)?,
            shading: Shading::named(&self.shading)?,
            edl: self.edl,
            ao: self.ao,
            background: self.background,
            lighting: preset.lighting,
        };
        settings.check().ok().map(|()| (method, settings))
    }

    fn splatting(&self) -> Option<Splatting> {
        Some(Splatting {
            footprint: Footprint::named(&self.footprint)?,
            kernel: self.confetti.map_or(Kernel::Gaussian, |[a, n]| Kernel::Confetti { a, n }),
            filter: Filter::named(&self.filter)?,
            visibility: Visibility::named(&self.visibility)?,
            normalization: Normalization::named(&self.normalization)?,
            shade: Shade::named(&self.shade)?,
        })
    }
}

/// Edges of files that do not contain them.
fn nearest() -> String {
    Edges::Nearest.name().into()
}

/// The legend of files that do not say whether there is one.
fn shown() -> bool {
    true
}

/// Strength of eye-dome lighting of files that do not contain it.
fn default_edl() -> f32 {
    Settings::DEFAULT_EDL
}

/// Size of points of files that do not contain it, px.
fn default_point_size() -> f32 {
    Settings::DEFAULT_POINT_SIZE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_and_changed_settings_are_restored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new").join("viewer.json");
        let changed = Settings {
            splatting: Splatting {
                footprint: Footprint::WholeSprite,
                kernel: Kernel::Confetti { a: 4.5, n: 5.0 },
                filter: Filter::None,
                shade: Shade::Splat,
                ..Splatting::default()
            },
            cutoff: 3.25,
            pixel_filter: 0.4,
            point_size: 7.5,
            epsilon: 0.3,
            cull: Cull::Back,
            alpha: Alpha::Coverage,
            edges: Edges::Nearest,
            shading: Shading::Normal,
            edl: 0.7,
            ao: 0.8,
            background: Some([0.1, 0.2, 1.0]),
            ..Settings::default()
        };
        let presets = Method::CHOICES.map(|method| (method.name, method.settings()));
        for (name, settings) in presets.into_iter().chain([("sprites", changed)]) {
            SavedSettings::of_settings(name, &settings, [true, false]).write(&path).unwrap();
            let read = SavedSettings::read(&path).unwrap();
            let (method, found) = read.settings().unwrap();
            assert_eq!((method.name, found), (name, settings));
            assert_eq!([read.panel_hidden, read.legend], [true, false]);
        }
    }

    #[test]
    fn unusable_files_are_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("viewer.json");
        assert_eq!(SavedSettings::read(&path), None);
        let good = SavedSettings::of_settings("sprites", &Method::ALL[2].settings(), [false, true]);
        let wrong = [
            SavedSettings { method: "none such".into(), ..good.clone() },
            SavedSettings { cutoff: -1.0, ..good.clone() },
            SavedSettings { filter: "object".into(), ..good.clone() },
        ];
        for wrong in wrong {
            wrong.write(&path).unwrap();
            assert_eq!(SavedSettings::read(&path), None);
        }
        for text in ["", "{", "[]", "{\"method\":\"sprites\"}", "\u{0}"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(SavedSettings::read(&path), None, "{text}");
        }
        good.write(&path).unwrap();
        assert_eq!(SavedSettings::read(&path), Some(good));
    }
}
