//! Clip lines at creases, where the discs of two faces meet (Zwicker et al. 2004, section 5, which intersects the tangent planes of surfels
//! on either side).
//!
//! A single surfel's plane is as noisy as its normal, so the plane beyond an edge is that of all neighbours that agree on it.

use super::Estimate;
use super::facets::{Facet, Sample, facets, median};
use super::sites::Sites;
use crate::Progress;
use crate::error::Result;
use crate::geometry::{Clip, ClipLine, Clips, Surfels};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicU64, Ordering};

/// Search distance in radii: the neighbours beyond an edge that just touches the disc's rim.
const WINDOW: f64 = 2.0;
/// Number of neighbours relative to that of normal estimation.
const WIDER: usize = 4;
/// Angle below a half turn from which two faces are the sides of a thin sheet instead of a blade, radians.
const BACK: f64 = PI / 6.0;
/// A normal is between two others if its angle to each is at most this part of the angle between them.
const BETWEEN: f64 = 0.75;
/// Ratio of samples with normals in between to samples of the face beyond from which the surface is curved.
const CURVED: f64 = 0.2;
/// Part of the radius by which noise may move a sample of the face beyond across its edge.
const MARGIN: f64 = 0.15;
/// Minimum number of samples beyond one line but not the other for a concave corner.
const EVIDENCE: usize = 2;
/// Number of surfels per task.
const PIECE: usize = 1 << 12;

/// Clips discs at creases where normals turn by more than `angle`, radians. Existing clips are kept. Returns the number of new clips.
/// Surfels are best in Morton order.
pub(super) fn clip(
    surfels: &mut Surfels,
    angle: f32,
    how: &Estimate,
    progress: &dyn Progress,
) -> Result<u64> {
    let sites = Sites::new(&surfels.positions, progress)?;
    let finder = Finder { surfels, sites: &sites, angle: angle.into(), count: WIDER * how.neighbours };
    let (done, total) = (AtomicU64::new(0), surfels.len() as u64);
    let piece = |first: usize| {
        let piece = first..surfels.len().min(first + PIECE);
        let (count, mut found) = (piece.len(), 0);
        let clip = |index: usize| {
            surfels.clips.as_ref().and_then(|clips| clips.get(index)).copied().or_else(|| {
                let clip = finder.clip(index);
                found += u64::from(clip.is_some());
                clip
            })
        };
        let clips = Clips::collect(piece.map(clip));
        let done = done.fetch_add(count as u64, Ordering::Relaxed) + count as u64;
        progress.at("looking for sharp edges", done, total);
        ((clips, count), found)
    };
    let pieces = (0..surfels.len()).into_par_iter().step_by(PIECE).map(piece);
    let (clips, found): (Vec<_>, Vec<u64>) = pieces.unzip();
    surfels.clips = Clips::join(clips);
    Ok(found.iter().sum())
}

/// Detects clips of surfels.
struct Finder<'a> {
    surfels: &'a Surfels,
    sites: &'a Sites,
    /// Least angle of a crease, radians.
    angle: f64,
    /// Number of neighbours.
    count: usize,
}

impl Finder<'_> {
    /// The clip of a surfel whose disc reaches a crease.
    fn clip(&self, index: usize) -> Option<Clip> {
        if self.surfels.is_billboard(index) {
            return None;
        }
        let normal = self.surfels.normals[index].as_dvec3();
        let samples = self.around(index);
        let turn = |samples: &Sample| normal.angle_between(samples.normal);
        let is_other = |samples: &&Sample| (self.angle..PI - BACK).contains(&turn(samples));
        let others: Vec<Sample> = samples.iter().filter(is_other).copied().collect();
        let facets = facets(&others, 0.5 * self.angle);
        let creases = facets.iter().filter(|facet| is_crease(facet, &samples, normal));
        let lines: Vec<ClipLine> = creases.filter_map(|facet| line(facet, normal)).collect();
        let is_own = |samples: &&Sample| turn(samples) < self.angle && samples.at.length() <= 1.0;
        let own = samples.iter().filter(is_own).map(|samples| samples.at);
        let mut clip = decide(&lines, &own.chain([DVec3::ZERO]).collect::<Vec<_>>(), normal)?;
        clip.lines.iter_mut().for_each(|line| line.offset *= self.surfels.radii[index]);
        Some(clip)
    }

    /// The samples around a surfel, relative to its centre and in units of its radius.
    fn around(&self, index: usize) -> Vec<Sample> {
        let Self { surfels, sites, .. } = self;
        let [centre, normal] = [surfels.positions[index], surfels.normals[index]].map(|v| v.as_dvec3());
        let is_two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
        let sample = |site: u32| {
            let other = sites.point[site as usize] as usize;
            let at = (surfels.positions[other].as_dvec3() - centre) / f64::from(surfels.radii[index]);
            let facing = surfels.normals[other].as_dvec3();
            let unknown = is_two_sided(index) || is_two_sided(other);
            Sample { at, normal: if unknown { agreeing(normal, facing, at) } else { facing } }
        };
        let has_normal = |site: &u32| !surfels.is_billboard(sites.point[*site as usize] as usize);
        let near = sites.nearest(sites.of_point[index], self.count).filter(has_normal).map(sample);
        near.take_while(|samples| samples.at.length() <= WINDOW).collect()
    }
}

/// Whether the surface turns to a facet abruptly: a curved surface has samples with normals in between.
fn is_crease(facet: &Facet, samples: &[Sample], normal: DVec3) -> bool {
    let most = BETWEEN * normal.angle_between(facet.normal);
    let is_between = |samples: &&Sample| {
        normal.angle_between(samples.normal) < most && facet.normal.angle_between(samples.normal) < most
    };
    samples.iter().filter(is_between).count() as f64 <= CURVED * facet.members.len() as f64
}

/// The side of a normal at `at` that agrees with one at 0, also across a crease: the other is mirrored as on a circle between them.
fn agreeing(normal: DVec3, facing: DVec3, at: DVec3) -> DVec3 {
    let along = at.normalize_or_zero();
    let mirrored = normal - 2.0 * along.dot(normal) * along;
    if mirrored.dot(facing) < 0.0 { -facing } else { facing }
}

/// The intersection of a disc's plane with a facet. A facet below the plane is convex: the solid is behind both; a facet above is concave.
fn line(facet: &Facet, normal: DVec3) -> Option<ClipLine> {
    let heights: Vec<f64> = facet.members.iter().map(|at| at.dot(normal)).collect();
    let side = if median(heights) < 0.0 { 1.0 } else { -1.0 };
    ClipLine::of_half_space(side * facet.normal, side * facet.offset, normal.as_vec3())
}

/// The clip that lines make of a disc of radius 1, given the samples of its own face.
fn decide(lines: &[ClipLine], own: &[DVec3], normal: DVec3) -> Option<Clip> {
    let beyond =
        |line: &ClipLine, at: &DVec3| line.outward.as_dvec3().dot(*at) > f64::from(line.offset) + MARGIN;
    if let [a, b] = *lines
        && corner(&a, &b, normal).is_some_and(|corner| corner.length() < 1.0)
    {
        let [mut one, mut both] = [0, 0];
        for at in own {
            let count = usize::from(beyond(&a, at)) + usize::from(beyond(&b, at));
            one += usize::from(count == 1);
            both += usize::from(count == 2);
        }
        if one >= EVIDENCE && both == 0 {
            return Some(Clip { lines: [a, b], concave: true });
        }
    }
    // A line with samples of the own face beyond it is not an edge here. The centre is one of the samples: noise alone can put it there.
    let is_edge = |line: &&ClipLine| line.offset < 1.0 && !own.iter().any(|at| beyond(line, at));
    let mut edges =
        lines.iter().filter(is_edge).map(|line| ClipLine { offset: line.offset.max(0.0), ..*line });
    Clip::of_some([edges.next(), edges.next()], false)
}

/// The intersection of two lines in a plane, relative to the disc's centre; `None` if they are parallel.
fn corner(a: &ClipLine, b: &ClipLine, normal: DVec3) -> Option<DVec3> {
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |line: &ClipLine| {
        let outward = line.outward.as_dvec3();
        DVec2::new(outward.dot(x), outward.dot(y))
    };
    let (u, v) = (flat(a), flat(b));
    let at = (f64::from(b.offset) * u - f64::from(a.offset) * v).perp() / u.perp_dot(v);
    at.is_finite().then(|| at.x * x + at.y * y)
}
