//! An input that was read.

use crate::Result;
use crate::estimate::{Estimate, Estimated, NormalSource};
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
    /// Part of the points whose normals mean nothing, as the file states of all its points; 0 if only some of them are read.
    pub scattered: f64,
}

impl Part {
    /// A part of which only the points are known.
    pub fn of(name: String, cloud: Cloud, up: DVec3) -> Self {
        let is_bare = cloud.is_bare();
        Self { name, cloud, draws_faces: false, up, scalar: None, is_bare, scattered: 0.0 }
    }

    /// The part with what the report of its file tells.
    pub fn with(self, Report { scalar, metadata, points, dropped, .. }: &Report) -> Self {
        let Metadata { estimated, scattered, .. } = *metadata;
        let is_whole = self.cloud.len() as u64 + dropped.position + dropped.transparent == *points;
        let scattered = if is_whole { scattered } else { 0.0 };
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

/// Number of surfels whose normals are unlike their neighbours': those that were counted, or, if a file states more, these. Of some formats the
/// normals of these surfels are missing and estimated again, so that both may count the same ones. What a file states does not hold for
/// other normals, or without its outliers.
pub(super) fn scattered(stated: f64, how: &Estimate, surfels: usize, counts: &Estimated) -> u64 {
    let has_others =
        how.normals == NormalSource::Estimate || counts.normals_contradictory > 0 || counts.outliers > 0;
    let stated = if has_others { 0.0 } else { stated * surfels as f64 };
    counts.scattered.max(stated.round() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::{self, Contents, Filter, WantedAttributes};
    use crate::load::{LoadOptions, LoadedModel, SuggestedShading, Suggestion, Uncoloured, load};
    use crate::settings::Shading;
    use std::num::NonZeroU64;
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

    #[test]
    fn what_a_file_states_holds_for_all_its_points_and_normals() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ply");
        let header =
            "ply\nformat ascii 1.0\ncomment surfel normals=estimated scattered=0.5\nelement vertex 400\n";
        let names: String =
            ["x", "y", "z", "nx", "ny", "nz"].iter().map(|name| format!("property float {name}\n")).collect();
        let open = |rows: String, options: LoadOptions| {
            std::fs::write(&path, format!("{header}{names}end_header\n{rows}")).unwrap();
            let loaded = load(&[&path], &options, &()).unwrap();
            assert_eq!(loaded.metadata.scattered, loaded.scattered);
            (loaded.scattered, loaded.estimated.scattered)
        };
        let of_filter = |filter| LoadOptions { filter, ..Default::default() };
        let of_estimate = |estimate| LoadOptions { estimate, ..Default::default() };
        let whole = [LoadOptions::default(), LoadOptions { voxel: Some(0.5), ..Default::default() }];
        for options in whole {
            assert_eq!(open(wall(), options), (0.5, 0));
        }
        let bounds = Some([DVec3::ZERO, DVec3::new(10.0, 20.0, 0.0)]);
        let others = [
            of_filter(Filter { every: NonZeroU64::new(2), ..Default::default() }),
            of_filter(Filter { bounds, ..Default::default() }),
            LoadOptions { points: Some(200), ..Default::default() },
            LoadOptions { voxel: Some(2.0), ..Default::default() },
            of_estimate(Estimate { normals: NormalSource::Estimate, ..Default::default() }),
        ];
        for (case, options) in others.into_iter().enumerate() {
            assert_eq!(open(wall(), options), (0.0, 0), "{case}");
        }
        let turned = wall().replace("1 0 0 0 1\n", "1 0 0 0 -1\n").replace("2 0 0 0 1\n", "2 0 0 0 -1\n");
        assert_eq!(open(turned, LoadOptions::default()), (0.0, 0), "contradictory normals");
    }
}
