//! Saved settings: method, render settings and panel, kept from one run to the next.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io::{ErrorKind, Write};
use std::path::Path;
use surfel::formats::atomic;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::{PullPush, Storage};
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::settings::{Alpha, Choice, Cull, Edges, Shading, Widen};
use surfel::{Error, Result, Settings};

/// Names of the fields that do not depend on the method.
const OF_PICTURES: [&str; 5] = ["alpha", "shading", "edl", "ao", "background"];

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

    /// These settings with what the user has changed from the `first` method and settings of a scene to those of `now`. `given` are the settings
    /// that the present method has if nobody changes them.
    ///
    /// A method that the inputs or the command line require is not kept, and neither are its settings.
    pub fn with_changes(
        &self,
        first: (Method, &Settings),
        now: (Method, &Settings),
        given: &Settings,
    ) -> Self {
        let panel = [self.panel_hidden, self.legend];
        let fields =
            |method: Method, settings: &Settings| Self::of_settings(method.name, settings, panel).fields();
        let (is_chosen, own) = (first.0.name != now.0.name, self.method == now.0.name);
        let (before, after) = (fields(first.0, first.1), fields(now.0, now.1));
        let unchanged = if is_chosen { fields(now.0, given) } else { before.clone() };
        let mut kept = self.fields();
        if is_chosen {
            let preset = fields(now.0, &now.0.settings());
            kept.extend(preset.into_iter().filter(|(name, _)| !is_of_pictures(name)));
        }
        let changed = after.into_iter().filter(|(name, value)| {
            let (is_kept, old) =
                if is_of_pictures(name) { (true, &before) } else { (is_chosen || own, &unchanged) };
            is_kept && old.get(name) != Some(value)
        });
        kept.extend(changed);
        let kept = serde_json::from_value(Value::Object(kept)).ok();
        kept.filter(|kept: &Self| kept.settings().is_some()).unwrap_or_else(|| self.clone())
    }

    /// The fields of the file.
    fn fields(&self) -> Map<String, Value> {
        match serde_json::to_value(self) {
            Ok(Value::Object(fields)) => fields,
            _ => Map::new(),
        }
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

impl Default for SavedSettings {
    fn default() -> Self {
        let method = Method::ALL[0];
        Self::of_settings(method.name, &method.settings(), [false, true])
    }
}

fn is_of_pictures(field: &str) -> bool {
    OF_PICTURES.contains(&field)
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
    fn what_the_user_changes_is_kept_and_nothing_else() {
        let saved = SavedSettings::default();
        let [own, ewa, pull] = ["perspective-ewa", "object-ewa", "pull-push"].map(|name| {
            let method = Method::named(name).unwrap();
            (method, method.settings())
        });
        let kept = |saved: &SavedSettings, from: &(Method, Settings), to: &(Method, Settings)| {
            let given = Settings { cutoff: 2.0, ..to.0.settings() };
            saved.with_changes((from.0, &from.1), (to.0, &to.1), &given)
        };
        let with = |of: &(Method, Settings), change: fn(&mut Settings)| {
            let mut settings = of.1.clone();
            change(&mut settings);
            (of.0, settings)
        };
        // A required method, a shading of the command line.
        let depth = with(&pull, |settings| settings.shading = Shading::Depth);
        assert_eq!(kept(&saved, &depth, &depth), saved);
        let white = with(&depth, |settings| settings.background = Some([1.0; 3]));
        assert_eq!(
            kept(&saved, &depth, &white),
            SavedSettings { background: Some([1.0; 3]), ..saved.clone() }
        );
        // A method that was chosen, with a cut-off of the command line.
        let cut = with(&ewa, |settings| settings.cutoff = 2.0);
        let chosen = kept(&saved, &own, &cut);
        assert_eq!(chosen, SavedSettings::of_settings("object-ewa", &ewa.1, [false, true]));
        let deep = with(&cut, |settings| settings.epsilon = 3.0);
        assert_eq!(kept(&saved, &own, &deep).settings().unwrap().1, Settings { epsilon: 3.0, ..ewa.1 });
        assert_eq!(kept(&chosen, &cut, &deep), kept(&saved, &own, &deep));
        // The method stays after a scene of lines, and its settings, too.
        assert_eq!(kept(&chosen, &pull, &pull), chosen);
        let in_turns = with(&pull, |settings| {
            settings.pull_push.iter_mut().for_each(|pull| pull.storage = Storage::PingPong);
        });
        assert_eq!(kept(&chosen, &pull, &in_turns), chosen);
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
