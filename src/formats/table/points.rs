//! From arrays to a cloud: removes and counts invalid points, and makes positions relative in float64.

use super::arrays::Arrays;
use super::columns::FILTER;
use super::convert::{Tally, is_position};
use super::layout::Layout;
use crate::error::Cause;
use crate::formats::attributes::{Attribute, Values};
use crate::formats::declared::Element;
use crate::formats::source::Parsed;
use crate::formats::{Dropped, Filter, FilterCounts};
use crate::geometry::{Clip, Clips, Cloud, Colours, View, Viewpoints, Weights};
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// The origin is 0 unless the coordinates are more than this many times larger than the extent; then it is near the middle. So ordinary
/// files keep their coordinates bit by bit, and the error of a position is at most one f32 ulp of the extent.
const FAR: f64 = 2.0;

/// Percentiles of each coordinate that determine extent and middle, so that a single stray point, such as a scanner's 0 0 0 for a missing
/// return, does not cost all others their precision.
const PERCENTILES: [f64; 2] = [0.01, 0.99];

/// Minimum number of points of a scan.
const MANY: usize = 100;
/// Maximum number of points for the percentiles.
const SAMPLE: usize = 1 << 12;

/// The points of a file, before faces are read.
pub struct Points {
    pub cloud: Cloud,
    pub dropped: Dropped,
    /// Number of vertices in the file.
    pub count: u64,
    /// Distance of the vertices that are read.
    step: u64,
    /// Point index of each vertex that is read, if some were dropped.
    map: Option<Vec<u32>>,
    /// Whether some points need normals or radii from faces.
    pub lacking: bool,
    /// Number of invalid clip lines.
    pub clip_lines: u64,
    /// Number of invalid normalization weights.
    pub weights: u64,
    /// Counts by class and return, if the layout has them.
    pub counts: Option<FilterCounts>,
    /// Least and greatest coordinates, in the file's own coordinate system.
    pub bounds: Option<[DVec3; 2]>,
    /// Texture coordinates, if any.
    pub coordinates: Vec<Vec2>,
    /// Material indices, if any.
    pub materials: Vec<u16>,
    /// The attributes of the layout.
    attributes: Vec<Values>,
}

/// Map entry of a dropped vertex.
const NOWHERE: u32 = u32::MAX;

impl Points {
    /// The points of arrays that were filled by the layout.
    pub fn new(mut arrays: Arrays, tally: Tally, layout: &Layout) -> Parsed<Self> {
        let read = arrays.narrow.len().max(arrays.wide.len());
        let read = u32::try_from(read).map_err(|_| "more than 2³² − 1 points: split the file")?;
        let Tally { dropped, transparent, thinned, filtered, outside, .. } = tally;
        let unread = thinned + outside;
        let dropped = Dropped { position: dropped, transparent, thinned, filtered: filtered + outside };
        let count = u64::from(read) + unread;
        if dropped.total() >= count {
            return Err(nothing(count, dropped));
        }
        let map = (dropped.total() > unread).then(|| leave_out(&mut arrays));
        let coordinates = std::mem::take(&mut arrays.coordinates);
        let materials = std::mem::take(&mut arrays.materials);
        let attributes = std::mem::take(&mut arrays.attributes);
        let cloud = cloud(arrays, layout.origin);
        let step = layout.filter.step();
        let Tally { lacking, clip_lines, weights, counts, bounds, .. } = tally;
        let has = [0, 1, 2].map(|index| layout.fills(FILTER + index));
        Ok(Self {
            cloud: if dropped.thinned > 0 { cloud.without_sizes() } else { cloud },
            dropped,
            count,
            step,
            map,
            lacking,
            clip_lines,
            weights,
            counts: counts.map(|counts| counts.of_points(has)),
            bounds,
            coordinates,
            materials,
            attributes,
        })
    }

    /// Sets where the points were seen from. The vertices of the file are those of scans of these numbers of points, one after the other, from
    /// these positions in its coordinates.
    pub fn set_scanners(&mut self, scans: &[(u64, Option<DVec3>)]) {
        let view = |(_, position): &(u64, Option<DVec3>)| {
            let eye = position.map(|position| (position - self.cloud.origin).as_vec3());
            eye.filter(|eye| eye.is_finite()).map_or(View::Unknown, View::From)
        };
        let views: Vec<View> = scans.iter().map(view).collect();
        if let [view] = views[..] {
            self.cloud.view = view;
            return;
        }
        let known = || views.iter().filter(|view| **view != View::Unknown);
        // Scans that were merged have no poses left: all are the same.
        if known().all(|view| Some(view) == known().next()) {
            return;
        }
        let of_points = self.scans(scans.iter().map(|(count, _)| *count));
        self.cloud.viewpoints = of_points.map(|scans| Viewpoints { views, scans });
    }

    /// The scan of each point; `None` if there are too many scans.
    fn scans(&self, counts: impl Iterator<Item = u64>) -> Option<Vec<u16>> {
        let mut end = 0;
        let ends = counts.map(|count| {
            end += count;
            end
        });
        let ends: Vec<u64> = ends.collect();
        u16::try_from(ends.len()).ok()?;
        let scan = |read: usize| ends.partition_point(|end| *end <= read as u64 * self.step) as u16;
        Some(match &self.map {
            None => (0..self.cloud.len()).map(scan).collect(),
            Some(map) => (0..map.len()).filter(|read| map[*read] != NOWHERE).map(scan).collect(),
        })
    }

    /// Takes the attributes of a layout out, with the names of their properties.
    pub fn take_attributes(&mut self, element: &Element, layout: &Layout) -> Vec<Attribute> {
        let name = |index: usize| element.properties.get(index).map(|property| property.name.clone());
        let named = layout.attributes.iter().zip(std::mem::take(&mut self.attributes));
        named
            .map(|((index, _), values)| Attribute { name: name(*index).unwrap_or_default(), values })
            .collect()
    }

    /// The point of a vertex; `None` if the vertex does not exist or was dropped.
    pub fn of_vertex(&self, vertex: f64) -> Option<u32> {
        // Only whole numbers survive the conversion and back.
        let index = vertex as u64;
        if index as f64 != vertex || index >= self.count || !index.is_multiple_of(self.step) {
            return None;
        }
        let read = index / self.step;
        match &self.map {
            None => u32::try_from(read).ok(),
            Some(map) => Some(map[read as usize]).filter(|point| *point != NOWHERE),
        }
    }

    /// The point of a vertex that a face or a line joins to others; `None` for all if one point in several is read, which leaves only a few
    /// faces and lines whole, here and there.
    pub fn of_corner(&self, vertex: f64) -> Option<u32> {
        if self.step > 1 { None } else { self.of_vertex(vertex) }
    }
}

fn nothing(count: u64, dropped: Dropped) -> Cause {
    if dropped.filtered > 0 {
        return format!(
            "none of its {count} points is left by the filter: choose other bounds, classes or returns"
        )
        .into();
    }
    if dropped.thinned > 0 {
        let read = count - dropped.thinned;
        return format!("none of the {read} that are read of its {count} points is left: read more of them")
            .into();
    }
    match (count, dropped.transparent) {
        (0, _) => "it has no points: give a file with at least one".into(),
        (_, 0) => format!("none of its {count} points has a finite position: fetch or write it again").into(),
        (_, transparent) => format!(
            "none of its {count} 3D Gaussians is left: {transparent} are less than a tenth opaque, the others have no finite position; give more opaque ones"
        )
        .into(),
    }
}

/// Removes points without a position; returns the new index of each vertex that is read.
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

fn cloud(arrays: Arrays, known: Option<DVec3>) -> Cloud {
    let origin = known.unwrap_or_else(|| {
        // Of the file's own coordinates.
        let narrow = sample(&arrays.narrow).map(|position| position.as_dvec3());
        origin(narrow.chain(sample(&arrays.wide).copied()).collect())
    });
    // Those of a known origin are relative to it.
    let by = if known.is_some() { DVec3::ZERO } else { origin };
    let colours = match (arrays.codes.is_empty(), arrays.linear.is_empty()) {
        (false, _) => Some(Colours::Srgb8(arrays.codes)),
        (_, false) => Some(Colours::Linear(arrays.linear)),
        _ => None,
    };
    // Arrays of zeros only are treated as absent.
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
        positions: positions(arrays.narrow, &arrays.wide, by),
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

/// Corner weights that are all 0 are absent.
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

/// Origin of the positions. A round number: it is a multiple of the power of two above the extent, so that coordinates translated by whole
/// metres, say, are unchanged. Computed from some of the positions.
fn origin(sample: Vec<DVec3>) -> DVec3 {
    let [min, max] = usual_box(sample);
    let largest = min.abs().max(max.abs()).max_element();
    let extent = (max - min).max_element();
    if largest <= FAR * extent {
        return DVec3::ZERO;
    }
    let middle = 0.5 * min + 0.5 * max;
    let step = 2.0 * extent.log2().floor().exp2();
    if step.is_normal() { (middle / step).round() * step } else { middle }
}

/// The box between the percentiles; for few points, the box of all.
fn usual_box(mut points: Vec<DVec3>) -> [DVec3; 2] {
    // Scanners write 0 0 0 for missing returns. Of few points each counts.
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

/// Number of points from which their origin is computed beforehand, from some of them: they need not be stored in float64 until it is known.
pub const MANY_POINTS: u64 = 500_000;

/// Number of points for that origin.
pub const SOME_POINTS: u64 = 1 << 10;

/// Least number of them.
const LEAST: usize = 8;

/// The origin of some of the points; `None` if too few of them have a position that the filter keeps.
pub fn origin_of_some(mut sample: Vec<DVec3>, filter: &Filter) -> Option<DVec3> {
    sample.retain(|at| is_position(*at) && filter.contains(*at));
    (sample.len() >= LEAST).then(|| origin(sample))
}

/// Evenly spread entries.
fn sample<T>(all: &[T]) -> impl Iterator<Item = &T> {
    all.iter().step_by(all.len().div_ceil(SAMPLE).max(1))
}
