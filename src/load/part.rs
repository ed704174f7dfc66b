//! An input that was read.

use crate::Result;
use crate::formats::{Metadata, Report};
use crate::geometry::Cloud;
use crate::settings::Settings;
use glam::DVec3;

/// An input that was read, or several that were merged.
pub(super) struct Part {
    pub name: String,
    pub cloud: Cloud,
    /// Whether its faces are rendered, whatever the options say.
    pub draws_faces: bool,
    /// The up direction of its coordinates.
    pub up: DVec3,
    /// Name of the property that is its scalar.
    pub scalar: Option<String>,
    /// Whether its points have no normals, faces or lines, but estimated ones.
    pub is_bare: bool,
    /// Part of the points whose normals mean nothing, as the file tells.
    pub scattered: f64,
}

impl Part {
    /// A part of which only the points are known.
    pub fn of(name: String, cloud: Cloud, up: DVec3) -> Self {
        let is_bare = cloud.is_bare();
        Self { name, cloud, draws_faces: false, up, scalar: None, is_bare, scattered: 0.0 }
    }

    /// The part with what the report of its file tells.
    pub fn with(self, Report { scalar, metadata, .. }: &Report) -> Self {
        let Metadata { estimated, scattered, .. } = *metadata;
        Self { scalar: scalar.clone(), is_bare: self.is_bare || estimated, scattered, ..self }
    }

    /// All parts as one, with the up direction and the scalar of the first.
    pub fn merge(parts: Vec<Self>) -> Result<Self> {
        let name = match &parts[..] {
            [one] => one.name.clone(),
            several => format!("{} inputs", several.len()),
        };
        let draws_faces = parts.iter().any(|part| part.draws_faces);
        let is_bare = parts.iter().all(|part| part.is_bare);
        let points: usize = parts.iter().map(|part| part.cloud.len()).sum();
        let scattered: f64 = parts.iter().map(|part| part.scattered * part.cloud.len() as f64).sum();
        let (up, scalar) = parts.first().map_or((DVec3::Y, None), |part| (part.up, part.scalar.clone()));
        let clouds = parts.into_iter().map(|part| part.cloud).collect();
        let cloud = Cloud::merge(clouds, Settings::default().lighting.albedo)?;
        let scattered = scattered / points.max(1) as f64;
        Ok(Self { name, cloud, draws_faces, up, scalar, is_bare, scattered })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{self, Contents, WantedAttributes};
    use crate::load::{LoadOptions, LoadedModel, SuggestedShading, Suggestion, Uncoloured, load};
    use crate::settings::Shading;
    use std::path::Path;

    /// What the defaults of a picture are: the up direction, the shading, and what points are coloured by.
    fn defaults(path: &Path) -> (DVec3, SuggestedShading, Option<Suggestion>) {
        let loaded = open(path, Uncoloured::Suggest);
        (loaded.up, loaded.shading(), loaded.suggestion)
    }

    fn open(path: &Path, uncoloured: Uncoloured) -> LoadedModel {
        load(
            &[path],
            &LoadOptions { uncoloured, attributes: WantedAttributes::All, ..Default::default() },
            &(),
        )
        .unwrap()
    }

    /// Points in a flat box, on no surface, with other numbers after their coordinates.
    fn scattered(rest: impl Fn(i32) -> String) -> String {
        let mut state = 1u64;
        let mut number = |size: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            size * (state >> 40) as f64 / f64::from(1 << 24)
        };
        (0..600).map(|i| format!("{} {} {}{}\n", number(10.0), number(10.0), number(2.0), rest(i))).collect()
    }

    /// A plane that stands upright, with normals.
    fn wall() -> String {
        (0..400).map(|i| format!("{} {} 0 0 0 1\n", i % 20, i / 20)).collect()
    }

    #[test]
    fn a_written_file_has_the_picture_of_its_input() {
        let folder = tempfile::tempdir().unwrap();
        let height = Some(("height", Shading::Edl, DVec3::Z));
        let cases = [
            ("x y z\n", scattered(|_| String::new()), height),
            (
                "x y z intensity\n",
                scattered(|i| format!(" {}", i % 7)),
                Some(("intensity", Shading::Edl, DVec3::Z)),
            ),
            ("x y z nx ny nz\n", wall(), None),
        ];
        for (columns, rows, expected) in cases {
            let original = folder.path().join("a.xyz");
            std::fs::write(&original, columns.to_owned() + &rows).unwrap();
            let (up, shading, suggestion) = defaults(&original);
            let loaded = open(&original, Uncoloured::Plain);
            let name = suggestion.as_ref().map(|suggestion| suggestion.name.as_str());
            let (wanted, wanted_up) =
                (expected.map(|(name, ..)| name), expected.map_or(DVec3::Y, |(.., up)| up));
            assert_eq!((name, up), (wanted, wanted_up), "{columns}");
            assert_eq!(shading.shading, expected.map_or(Shading::Lit, |(_, shading, _)| shading));
            for extension in formats::writable_extensions() {
                let path = folder.path().join(format!("a.{extension}"));
                let contents = Contents {
                    inputs: &loaded.inputs,
                    metadata: loaded.metadata,
                    ..Contents::of(&loaded.model)
                };
                formats::write(&path, &contents, &()).unwrap();
                assert_eq!(defaults(&path), (up, shading, suggestion.clone()), "{columns}{extension}");
                let again = open(&path, Uncoloured::Plain);
                assert_eq!(again.metadata, loaded.metadata, "{columns}{extension}");
            }
        }
    }
}
