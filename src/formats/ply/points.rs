//! From the arrays to a cloud: what cannot be drawn is left out and counted, positions are made relative in float64.

use super::arrays::Arrays;
use super::convert::Tally;
use super::{Dropped, Parsed};
use crate::error::Cause;
use crate::geometry::{Clip, Clips, Cloud, Colours, Weights};
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// The origin is 0 unless the coordinates are more than this many times larger than the extent; then it is near the middle. So ordinary
/// files keep their coordinates bit by bit, and the error of a position is at most one f32 ulp of the extent.
const FAR: f64 = 2.0;

/// Extent and middle are those of the points between these percentiles of each coordinate: a single stray point, such as a scanner's 0 0 0
/// where nothing came back, must not cost all others their precision.
const PERCENTILES: [f64; 2] = [0.01, 0.99];

/// So many points are a scan.
const MANY: usize = 100;
/// Most points that the percentiles are taken of.
const SAMPLE: usize = 1 << 12;

/// A file's points, before its faces are looked at.
pub(super) struct Points {
    pub cloud: Cloud,
    pub dropped: Dropped,
    /// Number of vertices in the file.
    pub count: u32,
    /// Which point each vertex has become, if some were dropped.
    map: Option<Vec<u32>>,
    /// Whether some points lack normals or radii, which faces can tell.
    pub lacking: bool,
    /// Clip lines that are none.
    pub clip_lines: u64,
    /// Normalization weights that are none.
    pub weights: u64,
    /// Coordinates in a texture, if the file has some.
    pub coordinates: Vec<Vec2>,
    /// Numbers of materials, if the file has some.
    pub materials: Vec<u16>,
}

/// What stands in the map for a vertex that was dropped.
const NOWHERE: u32 = u32::MAX;

impl Points {
    pub fn new(mut arrays: Arrays, tally: Tally) -> Parsed<Self> {
        let count = arrays.narrow.len().max(arrays.wide.len());
        let count = u32::try_from(count).map_err(|_| "more than 2³² − 1 vertices: split the file")?;
        let dropped = Dropped { position: tally.dropped, transparent: tally.transparent };
        if dropped.total() >= u64::from(count) {
            return Err(nothing(count, dropped));
        }
        let map = (dropped.total() > 0).then(|| leave_out(&mut arrays));
        let coordinates = std::mem::take(&mut arrays.coordinates);
        let materials = std::mem::take(&mut arrays.materials);
        let cloud = cloud(arrays);
        let Tally { lacking, clip_lines, weights, .. } = tally;
        Ok(Self { cloud, dropped, count, map, lacking, clip_lines, weights, coordinates, materials })
    }

    /// The point that a vertex has become; `None` if there is no such vertex, or if it was dropped.
    pub fn of_vertex(&self, vertex: f64) -> Option<u32> {
        // Whole numbers alone survive the way there and back.
        let index = vertex as u32;
        if f64::from(index) != vertex || index >= self.count {
            return None;
        }
        match &self.map {
            None => Some(index),
            Some(map) => Some(map[index as usize]).filter(|point| *point != NOWHERE),
        }
    }
}

fn nothing(count: u32, dropped: Dropped) -> Cause {
    match (count, dropped.transparent) {
        (0, _) => "it has no vertices: give a file with at least one".into(),
        (_, 0) => format!("none of its {count} vertices has a finite position: fetch or write it again").into(),
        (_, transparent) => format!(
            "none of its {count} 3D Gaussians is left: {transparent} are less than a tenth opaque, the others nowhere; give more \
             opaque ones"
        )
        .into(),
    }
}

/// Leaves out what has no position; gives the index that each vertex has then.
fn leave_out(arrays: &mut Arrays) -> Vec<u32> {
    let kept: Vec<bool> = if arrays.wide.is_empty() {
        arrays.narrow.iter().map(|position| position.is_finite()).collect()
    } else {
        arrays.wide.iter().map(|position| position.is_finite()).collect()
    };
    arrays.retain(&kept);
    let mut next = 0;
    let mut place = |kept: bool| {
        next += u32::from(kept);
        if kept { next - 1 } else { NOWHERE }
    };
    kept.iter().map(|kept| place(*kept)).collect()
}

fn cloud(arrays: Arrays) -> Cloud {
    let origin = origin(&arrays);
    let colours = match (arrays.codes.is_empty(), arrays.linear.is_empty()) {
        (false, _) => Some(Colours::Srgb8(arrays.codes)),
        (_, false) => Some(Colours::Linear(arrays.linear)),
        _ => None,
    };
    // Arrays that the file has, but nothing but zeros in them, are none.
    let normals = Some(arrays.normals).filter(|normals| normals.iter().any(|n| *n != Vec3::ZERO));
    let radii = Some(arrays.radii).filter(|radii| radii.iter().any(|radius| *radius > 0.0));
    let tangents = Some(arrays.tangents).filter(|tangents| tangents.iter().any(|t| *t != Vec3::ZERO));
    let ellipses =
        Some(arrays.ellipses).filter(|all| !all.is_empty() && normals.is_some() && radii.is_some());
    let weights = weights(&arrays.weights, &arrays.corners).filter(|weights| {
        weights.of.iter().any(|weight| *weight > 0.0) && normals.is_some() && radii.is_some()
    });
    Cloud {
        origin,
        positions: positions(arrays.narrow, &arrays.wide, origin),
        normals,
        radii,
        ellipses,
        clips: Clips::collect(arrays.clips.into_iter().map(|clip| (clip != Clip::default()).then_some(clip))),
        weights,
        two_sided: Some(arrays.two_sided).filter(|flags| !flags.is_empty()),
        colours,
        tangents,
        scalar: Some(arrays.scalar).filter(|values| !values.is_empty()),
        ..Default::default()
    }
}

/// Corners whose weights are all 0 are none.
fn weights(weights: &[f32], corners: &[[f32; 4]]) -> Option<Weights> {
    let corners_of = |i: usize| corners.get(i).copied().filter(|corners| *corners != [0.0; 4]);
    let each = weights.iter().enumerate().map(|(i, &weight)| (weight, corners_of(i)));
    (!weights.is_empty()).then(|| Weights::collect(each))
}

fn positions(mut narrow: Vec<Vec3>, wide: &[DVec3], origin: DVec3) -> Vec<Vec3> {
    if !wide.is_empty() {
        return wide.par_iter().map(|position| (position - origin).as_vec3()).collect();
    }
    if origin != DVec3::ZERO {
        narrow.par_iter_mut().for_each(|position| *position = (position.as_dvec3() - origin).as_vec3());
    }
    narrow
}

/// What positions are made relative to. A round number: the power of two next above the extent divides it, so that coordinates which have
/// been moved by whole metres, say, come back as they were.
fn origin(arrays: &Arrays) -> DVec3 {
    let [min, max] = usual_box(arrays);
    let largest = min.abs().max(max.abs()).max_element();
    let extent = (max - min).max_element();
    if largest <= FAR * extent {
        return DVec3::ZERO;
    }
    let middle = 0.5 * min + 0.5 * max;
    let step = 2.0 * extent.log2().floor().exp2();
    if step.is_normal() { (middle / step).round() * step } else { middle }
}

/// The box between the percentiles; of few points, that of all of them.
fn usual_box(arrays: &Arrays) -> [DVec3; 2] {
    let mut points: Vec<DVec3> = if arrays.wide.is_empty() {
        sample(&arrays.narrow).map(|position| position.as_dvec3()).collect()
    } else {
        sample(&arrays.wide).copied().collect()
    };
    // Scanners write 0 0 0 for many a ray that came back from nothing. Of few points each counts.
    if points.iter().filter(|point| **point != DVec3::ZERO).count() >= MANY {
        points.retain(|point| *point != DVec3::ZERO);
    }
    PERCENTILES.map(|percentile| {
        let rank = (percentile * points.len().saturating_sub(1) as f64).round() as usize;
        DVec3::from([0, 1, 2].map(|axis: usize| {
            points.select_nth_unstable_by(rank, |a, b| a[axis].total_cmp(&b[axis])).1[axis]
        }))
    })
}

/// Evenly spread entries.
fn sample<T>(all: &[T]) -> impl Iterator<Item = &T> {
    all.iter().step_by(all.len().div_ceil(SAMPLE).max(1))
}
