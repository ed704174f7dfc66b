//! Bounds of a scene's clusters of surfels, by which frames cull.

use super::Changes;
use super::groups::{self, GroupBounds};
use crate::error::Result;
use crate::geometry::{self, Quantized, Surfels};
use crate::vk::shaders::layout::Cluster;
use crate::vk::{Buffer, Uploads};
use glam::Vec3;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Consecutive surfels of a cluster.
pub(crate) const CLUSTER: u64 = geometry::CLUSTER as u64;

/// Bytes of the bounds of so many surfels' clusters.
pub(super) fn bytes(surfels: u64) -> u64 {
    surfels.div_ceil(CLUSTER) * size_of::<Cluster>() as u64
}

/// Bounds of all clusters.
pub(crate) struct Clusters {
    pub buffer: Buffer,
    chunks: Vec<Range<u64>>,
    known: Mutex<Known>,
}

/// Bounds, which updates extend.
pub(super) struct Known {
    /// The bounds in the buffer.
    clusters: Vec<ClusterBounds>,
    /// Those of groups of them, chunk by chunk.
    groups: Vec<Vec<GroupBounds>>,
}

/// Bounds of a cluster's surfels, without those that are certainly invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClusterBounds {
    pub low: Vec3,
    pub high: Vec3,
    pub radius: f32,
    cone: Cone,
    /// Some may be two-sided.
    two_sided: bool,
}

/// Cone of normals.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cone {
    /// No normals.
    Empty,
    /// Unit axis, and cosine of the largest angle of a normal from it, above 0.
    Of(Vec3, f32),
    /// All directions: normals differ by more, or some are of billboards.
    All,
}

/// Margin of cosines for rounding errors.
const ROUNDING: f32 = 1e-5;
/// A sine that no angle has.
const NO_CONE: f32 = 2.0;

impl Clusters {
    /// Bounds of the clusters of `surfels`, which have these chunks, as floats or as these codes.
    pub fn new(
        uploads: &Uploads<'_>,
        surfels: &Surfels,
        codes: Option<&Quantized>,
        chunks: &[Range<u64>],
    ) -> Result<Self> {
        let count = surfels.len() as u64;
        let all = Changes {
            positions: Some(&surfels.positions),
            normals: Some(&surfels.normals),
            radii: Some(&surfels.radii),
            two_sided: surfels.two_sided.as_deref(),
            ..Changes::default()
        };
        let clusters: Vec<_> = (0..count.div_ceil(CLUSTER))
            .map(|index| match codes {
                None => ClusterBounds::NONE.with(0..count, &all, range(index, count)),
                Some(codes) => ClusterBounds::quantized(surfels, codes, range(index, count)),
            })
            .collect();
        let words: Vec<_> = clusters.iter().map(ClusterBounds::words).collect();
        let buffer = uploads.buffer("clusters", bytemuck::cast_slice(&words))?;
        let known = Known { groups: groups::bounds(chunks, &clusters), clusters };
        Ok(Self { buffer, chunks: chunks.to_vec(), known: Mutex::new(known) })
    }

    /// Calls `body` with the bounds of the groups of clusters, chunk by chunk.
    pub fn with_groups<R>(&self, body: impl FnOnce(&[Vec<GroupBounds>]) -> R) -> R {
        body(&self.known.lock().unwrap_or_else(PoisonError::into_inner).groups)
    }

    /// Uploads the bounds of the clusters with surfels `changed` of `count`, changes included. They are known once the change is kept.
    pub fn change(
        &self,
        uploads: &Uploads<'_>,
        changed: Range<u64>,
        changes: &Changes<'_>,
        count: u64,
    ) -> Result<Option<ClusterChange<'_>>> {
        if changed.is_empty()
            || (changes.positions.is_none() && changes.normals.is_none() && changes.radii.is_none())
        {
            return Ok(None);
        }
        let first = changed.start / CLUSTER;
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let bounds: Vec<_> = (first..changed.end.div_ceil(CLUSTER))
            .map(|index| known.clusters[index as usize].with(changed.clone(), changes, range(index, count)))
            .collect();
        let words: Vec<_> = bounds.iter().map(ClusterBounds::words).collect();
        uploads.write(&self.buffer, first * size_of::<Cluster>() as u64, bytemuck::cast_slice(&words))?;
        Ok(Some(ClusterChange { known, chunks: &self.chunks, changed, bounds }))
    }
}

/// A change of bounds that is uploaded, and lost unless it is kept: a frame must not cull by the bounds of an update that failed.
pub(super) struct ClusterChange<'a> {
    known: MutexGuard<'a, Known>,
    chunks: &'a [Range<u64>],
    changed: Range<u64>,
    /// Of the clusters with changed surfels.
    bounds: Vec<ClusterBounds>,
}

impl ClusterChange<'_> {
    /// Keeps the change.
    pub fn keep(mut self) {
        let Known { clusters, groups } = &mut *self.known;
        clusters[(self.changed.start / CLUSTER) as usize..][..self.bounds.len()]
            .copy_from_slice(&self.bounds);
        groups::update(groups, self.chunks, clusters, &self.changed);
    }
}

/// Surfels of a cluster, of `count`.
fn range(index: u64, count: u64) -> Range<u64> {
    index * CLUSTER..((index + 1) * CLUSTER).min(count)
}

impl ClusterBounds {
    const NONE: Self = Self {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
        radius: 0.0,
        cone: Cone::Empty,
        two_sided: false,
    };

    /// Bounds of the surfels `own` as these codes store them.
    fn quantized(surfels: &Surfels, codes: &Quantized, own: Range<u64>) -> Self {
        let (mut positions, mut radii, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        for i in own.start as usize..own.end as usize {
            let (position, radius, normal) = codes.stored(i, (surfels.positions[i], surfels.radii[i]));
            positions.push(position);
            radii.push(radius.abs());
            normals.push(normal);
        }
        let changes = Changes {
            positions: Some(&positions),
            normals: Some(&normals),
            radii: Some(&radii),
            two_sided: surfels.two_sided.as_ref().map(|all| &all[own.start as usize..own.end as usize]),
            ..Changes::default()
        };
        Self::NONE.with(own.clone(), &changes, own)
    }

    /// These bounds of the surfels `own`, with changes of `changed`: extended, or replaced in the streams of which all values are new.
    fn with(&self, changed: Range<u64>, changes: &Changes<'_>, own: Range<u64>) -> Self {
        let common = own.start.max(changed.start)..own.end.min(changed.end);
        let old = if common == own { &Self::NONE } else { self };
        let part = (common.start - changed.start) as usize..(common.end - changed.start) as usize;
        let mut new = *self;
        if let Some(positions) = changes.positions {
            let bounded =
                positions[part.clone()].iter().filter(|p| p.abs().cmple(Vec3::splat(Surfels::LARGEST)).all());
            (new.low, new.high) =
                bounded.fold((old.low, old.high), |(low, high), p| (low.min(*p), high.max(*p)));
        }
        if let Some(radii) = changes.radii {
            new.radius = super::largest(&radii[part.clone()]).max(old.radius);
        }
        if let Some(normals) = changes.normals {
            new.cone = old.cone.with(&normals[part.clone()]);
        }
        if let Some(two_sided) = changes.two_sided {
            new.two_sided = old.two_sided || two_sided[part].contains(&true);
        }
        new
    }

    fn words(&self) -> Cluster {
        let (axis, cosine) = match self.cone {
            Cone::Of(axis, cosine) if !self.two_sided => {
                (axis, Some(cosine - ROUNDING).filter(|cosine| *cosine > 0.0))
            }
            _ => (Vec3::ZERO, None),
        };
        let sine = cosine.map_or(NO_CONE, |cosine| (1.0 - cosine * cosine).max(0.0).sqrt());
        let is_empty = self.low.cmpgt(self.high).any();
        let radius = if is_empty { -1.0 } else { self.radius };
        let [low, high] = if is_empty { [Vec3::ZERO; 2] } else { [self.low, self.high] };
        Cluster {
            low: low.extend(radius).to_array(),
            high: high.extend(sine).to_array(),
            axis: axis.extend(0.0).to_array(),
        }
    }
}

impl Cone {
    /// The cone with these normals; those that are not finite are invalid. Billboards face every eye.
    fn with(self, normals: &[Vec3]) -> Self {
        if normals.contains(&Vec3::ZERO) {
            return Self::All;
        }
        let units =
            || normals.iter().map(|normal| normal.normalize_or_zero()).filter(|unit| *unit != Vec3::ZERO);
        let (old, cosine) = match self {
            Self::Empty => (Vec3::ZERO, 1.0),
            Self::Of(axis, cosine) => (axis, cosine),
            Self::All => return Self::All,
        };
        let sum = units().sum::<Vec3>();
        // A cone about the old axis contains the old one.
        let axis = if old == Vec3::ZERO { sum.normalize_or_zero() } else { old };
        let least = units().map(|unit| unit.dot(axis)).fold(cosine, f32::min);
        if sum == Vec3::ZERO && old == Vec3::ZERO && units().next().is_none() {
            Self::Empty
        } else if axis != Vec3::ZERO && least > 0.0 {
            Self::Of(axis, least)
        } else {
            Self::All
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet() -> Surfels {
        let positions: Vec<_> = (0..100).map(|i| Vec3::new((i % 10) as f32, (i / 10) as f32, 0.0)).collect();
        let normals = positions.iter().map(|p| Vec3::new(0.01 * p.x, 0.0, 1.0).normalize()).collect();
        Surfels { normals, radii: vec![0.5; 100], positions, ..Surfels::default() }
    }

    fn bounds(surfels: &Surfels, two_sided: Option<&[bool]>) -> ClusterBounds {
        let all = Changes {
            positions: Some(&surfels.positions),
            normals: Some(&surfels.normals),
            radii: Some(&surfels.radii),
            two_sided,
            ..Changes::default()
        };
        ClusterBounds::NONE.with(0..100, &all, 0..64)
    }

    #[test]
    fn bounds_contain_the_surfels_of_the_cluster_only() {
        let mut surfels = sheet();
        surfels.positions[70].z = 9.0;
        surfels.positions[5] = Vec3::NAN;
        surfels.radii[7] = 0.75;
        let found = bounds(&surfels, None);
        assert_eq!((found.low, found.high, found.radius), (Vec3::ZERO, Vec3::new(9.0, 6.0, 0.0), 0.75));
        let Cone::Of(axis, cosine) = found.cone else { panic!("{found:?}") };
        assert!(surfels.normals[..64].iter().all(|normal| normal.dot(axis) >= cosine) && cosine > 0.99);
        assert!(found.words().high[3] < 0.1);
        let mut two_sided = vec![false; 100];
        two_sided[70] = true;
        assert_eq!(bounds(&surfels, Some(&two_sided)).cone, found.cone);
        two_sided[3] = true;
        let found = bounds(&surfels, Some(&two_sided));
        assert_eq!(found.words().high[3], NO_CONE);
        // New normals do not change the sides.
        let normals = Changes { normals: Some(&surfels.normals), ..Changes::default() };
        assert_eq!(found.with(0..100, &normals, 0..64).words().high[3], NO_CONE);
        surfels.normals[20] = Vec3::NEG_Z;
        assert_eq!(bounds(&surfels, None).cone, Cone::All);
        // Billboards face every eye.
        surfels = sheet();
        surfels.normals[20] = Vec3::ZERO;
        assert_eq!(bounds(&surfels, None).words().high[3], NO_CONE);
        let front = Changes { normals: Some(&[Vec3::Z]), ..Changes::default() };
        assert_eq!(bounds(&surfels, None).with(20..21, &front, 0..64).cone, Cone::All);
        surfels.positions = vec![Vec3::NAN; 100];
        assert!(bounds(&surfels, None).words().low[3] < 0.0);
    }

    #[test]
    fn updates_extend_bounds_and_replace_them_where_all_values_are_new() {
        let surfels = sheet();
        let old = bounds(&surfels, None);
        let far = vec![Vec3::splat(20.0); 64];
        let of_positions = |positions| Changes { positions: Some(positions), ..Changes::default() };
        let part = old.with(60..100, &of_positions(&far[..40]), 0..64);
        assert_eq!((part.low, part.high), (Vec3::ZERO, Vec3::splat(20.0)));
        let whole = old.with(0..64, &of_positions(&far), 0..64);
        assert_eq!((whole.low, whole.radius, whole.cone), (Vec3::splat(20.0), 0.5, old.cone));
        let turned = Changes { normals: Some(&[Vec3::NEG_Z]), ..Changes::default() };
        assert_eq!(old.with(10..11, &turned, 0..64).cone, Cone::All);
        let tilted = [Vec3::new(0.6, 0.0, 0.8)];
        let wider = old.with(10..11, &Changes { normals: Some(&tilted), ..Changes::default() }, 0..64).cone;
        assert!(matches!(wider, Cone::Of(_, cosine) if cosine < 0.84), "{wider:?}");
    }
}
