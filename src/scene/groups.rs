//! Groups of clusters, which frames cull on the CPU before the GPU culls clusters: there are few of them in the largest scene.

use super::clusters::{CLUSTER, ClusterBounds};
use glam::Vec3;
use std::ops::Range;

/// Clusters of a group: at most as many as a workgroup has invocations.
pub(crate) const GROUP: u64 = 64;
/// Surfels of a group.
const SURFELS: u64 = GROUP * CLUSTER;

/// Bounds of the surfels of a group, without invalid ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GroupBounds {
    /// Least corner of the centres, relative to the scene's origin.
    pub low: Vec3,
    /// Greatest corner.
    pub high: Vec3,
    /// Largest radius.
    pub radius: f32,
}

impl GroupBounds {
    /// Bounds of these clusters.
    fn of(clusters: &[ClusterBounds]) -> Self {
        let empty = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, radius: 0.0 };
        clusters.iter().fold(empty, |all, cluster| Self {
            low: all.low.min(cluster.low),
            high: all.high.max(cluster.high),
            radius: all.radius.max(cluster.radius),
        })
    }

    /// Whether no surfel is valid.
    pub fn is_empty(&self) -> bool {
        self.low.cmpgt(self.high).any()
    }
}

/// Bounds of the groups of these chunks of surfels with these clusters, chunk by chunk.
pub(super) fn bounds(chunks: &[Range<u64>], clusters: &[ClusterBounds]) -> Vec<Vec<GroupBounds>> {
    let group = |surfels: Range<u64>| GroupBounds::of(&clusters[indices(&surfels)]);
    chunks.iter().map(|chunk| groups(chunk).map(group).collect()).collect()
}

/// Updates the bounds of the groups with surfels of `changed`.
pub(super) fn update(
    bounds: &mut [Vec<GroupBounds>],
    chunks: &[Range<u64>],
    clusters: &[ClusterBounds],
    changed: &Range<u64>,
) {
    let all = chunks.iter().zip(bounds).flat_map(|(chunk, bounds)| groups(chunk).zip(bounds));
    for (surfels, bounds) in all {
        if surfels.start < changed.end && changed.start < surfels.end {
            *bounds = GroupBounds::of(&clusters[indices(&surfels)]);
        }
    }
}

/// The surfels of each group of a chunk.
pub(crate) fn groups(chunk: &Range<u64>) -> impl Iterator<Item = Range<u64>> + use<> {
    let end = chunk.end;
    (chunk.start..end).step_by(SURFELS as usize).map(move |first| first..(first + SURFELS).min(end))
}

/// Indices of the clusters of these surfels, which begin with a cluster.
fn indices(surfels: &Range<u64>) -> Range<usize> {
    (surfels.start / CLUSTER) as usize..surfels.end.div_ceil(CLUSTER) as usize
}
