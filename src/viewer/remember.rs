//! What is remembered from one run to the next: the method, its settings, and the panel.

use super::panels::UiState;
use super::state::State;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use surfel::formats::atomic;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::{PullPush, Storage};
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::settings::{Alpha, Choice, Cull, Shading, Widen};
use surfel::{Error, Result, Settings};

/// What is remembered, by the names that options have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Remembered {
    method: String,
    footprint: String,
    /// Confetti's a and n; `None` is the Gaussian.
    confetti: Option<[f32; 2]>,
    filter: String,
    visibility: String,
    normalization: String,
    shade: String,
    /// Whether the levels of pull–push are kept in turns.
    in_turns: bool,
    cutoff: f32,
    lowpass: f32,
    widen: String,
    epsilon: f32,
    cull: String,
    alpha: String,
    shading: String,
    /// Linear.
    background: Option<[f32; 3]>,
    /// Whether the panel is hidden.
    pub hidden: bool,
}

impl Remembered {
    /// What was remembered; `None` where nothing was, or nothing that can be used, which the log says.
    pub fn read(path: &Path) -> Option<Self> {
        let text = match std::fs::read(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
            text => text.map_err(|error| error.to_string()),
        };
        let read =
            text.and_then(|text| serde_json::from_slice::<Self>(&text).map_err(|error| error.to_string()));
        let usable = read.and_then(|read| match read.settings() {
            Some(_) => Ok(read),
            None => Err("it names what there is not".into()),
        });
        usable.map_err(|cause| log::warn!("{}: what was remembered is ignored: {cause}", path.display())).ok()
    }

    /// What there is to remember, if something is looked at.
    pub fn of(state: &State, ui_state: &UiState) -> Option<Self> {
        let ([method, _], settings) = state.names().zip(state.settings())?;
        Some(Self::of_settings(method, settings, ui_state.panel_hidden))
    }

    fn of_settings(method: &str, settings: &Settings, hidden: bool) -> Self {
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
            widen: settings.widen.name().into(),
            epsilon: settings.epsilon,
            cull: settings.cull.name().into(),
            alpha: settings.alpha.name().into(),
            shading: settings.shading.name().into(),
            background: settings.background,
            hidden,
        }
    }

    /// Writes it, whole or not at all, into a folder that is made where there is none.
    pub fn write(&self, path: &Path) -> Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(Error::io(folder, "cannot make the folder"))?;
        }
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        atomic::write(path, |out| writeln!(out, "{text}"))
    }

    /// The method and its settings; `None` for what there is not, or what cannot be rendered.
    pub fn settings(&self) -> Option<(Method, Settings)> {
        let method = Method::named(&self.method)?;
        let preset = method.settings();
        let storage = if self.in_turns { Storage::PingPong } else { Storage::Apart };
        let settings = Settings {
            splatting: self.splatting()?,
            pull_push: preset.pull_push.map(|pull_push| PullPush { storage, ..pull_push }),
            cutoff: self.cutoff,
            lowpass: self.lowpass,
            widen: Widen::named(&self.widen)?,
            epsilon: self.epsilon,
            cull: Cull::named(&self.cull)?,
            alpha: Alpha::named(&self.alpha)?,
            shading: Shading::named(&self.shading)?,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_and_what_is_changed_of_it_comes_back() {
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
            epsilon: 0.3,
            cull: Cull::Back,
            alpha: Alpha::Coverage,
            shading: Shading::Normal,
            background: Some([0.1, 0.2, 1.0]),
            ..Settings::default()
        };
        let presets = Method::ALL.map(|method| (method.name, method.settings()));
        for (name, settings) in presets.into_iter().chain([("sprites", changed)]) {
            Remembered::of_settings(name, &settings, true).write(&path).unwrap();
            let read = Remembered::read(&path).unwrap();
            let (method, found) = read.settings().unwrap();
            assert_eq!((method.name, found, read.hidden), (name, settings, true));
        }
    }

    #[test]
    fn what_is_broken_is_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("viewer.json");
        assert_eq!(Remembered::read(&path), None);
        let good = Remembered::of_settings("sprites", &Method::ALL[2].settings(), false);
        let wrong = [
            Remembered { method: "none such".into(), ..good.clone() },
            Remembered { cutoff: -1.0, ..good.clone() },
            Remembered { filter: "object".into(), ..good.clone() },
        ];
        for wrong in wrong {
            wrong.write(&path).unwrap();
            assert_eq!(Remembered::read(&path), None);
        }
        for text in ["", "{", "[]", "{\"method\":\"sprites\"}", "\u{0}"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(Remembered::read(&path), None, "{text}");
        }
        good.write(&path).unwrap();
        assert_eq!(Remembered::read(&path), Some(good));
    }
}
