//! What tests of writers read and write.

use super::{Loaded, PointSource, ReadOptions, WantedAttributes};
use crate::geometry::{Cloud, Surfels};
use glam::Vec3;

/// Options that keep all attributes.
pub fn all() -> ReadOptions {
    ReadOptions { attributes: WantedAttributes::All, ..Default::default() }
}

/// The surfels of a file's points, in reverse order, what the file has beyond them, and its points.
pub fn reversed(Loaded { cloud, report, attributes }: Loaded) -> (Surfels, PointSource, Cloud) {
    let points = cloud.len();
    let reversed: Vec<u32> = (0..points as u32).rev().collect();
    let mut surfels = Surfels {
        origin: cloud.origin,
        positions: cloud.positions.clone(),
        normals: cloud.normals.clone().unwrap_or_else(|| vec![Vec3::new(0.6, 0.0, 0.8); points]),
        radii: cloud.radii.clone().unwrap_or_else(|| vec![1.0; points]),
        colours: cloud.colours.clone(),
        point_indices: Some((0..points as u32).collect()),
        ..Default::default()
    };
    surfels.permute(&reversed);
    let skipped = report.others();
    let source = PointSource { points, attributes, survey: report.survey, skipped };
    (surfels, source, cloud)
}
