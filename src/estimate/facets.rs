//! Plane faces in the neighbourhood of a point, by the samples' normals.

use glam::DVec3;

/// Maximum number of faces: a disc has at most two clip lines.
const MOST: usize = 2;
/// Minimum number of samples of a face: fewer may be noise.
const LEAST: usize = 3;
/// Iterations of the selection of a face's samples by its mean normal.
const SETTLING: usize = 2;

/// A neighbouring sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub at: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

/// A plane that several samples agree on: `normal · x = offset`.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    /// Mean of the samples' normals, a unit vector.
    pub normal: DVec3,
    /// Median of the samples' offsets, robust against outliers.
    pub offset: f64,
    /// Positions of the samples.
    pub members: Vec<DVec3>,
}

/// The two largest faces. Normals of a face's samples are within `spread` of its mean, radians; means of faces are at least twice that
/// apart.
pub(super) fn facets(samples: &[Sample], spread: f64) -> Vec<Facet> {
    let near = spread.cos();
    let mut left = samples.to_vec();
    let mut facets: Vec<Facet> = Vec::new();
    while facets.len() < MOST && left.len() >= LEAST {
        let Some(normal) = densest(&left, near) else { break };
        let (members, rest): (Vec<Sample>, Vec<Sample>) =
            left.iter().partition(|samples| samples.normal.dot(normal) >= near);
        if members.len() < LEAST {
            break;
        }
        // The remainder of a rounded face is not another face.
        let apart = |facet: &Facet| facet.normal.dot(normal) < (2.0 * spread).cos();
        if facets.iter().all(apart) {
            let offset = median(members.iter().map(|samples| samples.at.dot(normal)).collect());
            facets.push(Facet {
                normal,
                offset,
                members: members.iter().map(|samples| samples.at).collect(),
            });
        }
        left = rest;
    }
    facets
}

/// The mean normal of the largest group of samples with similar normals.
fn densest(samples: &[Sample], near: f64) -> Option<DVec3> {
    let around = |normal: DVec3| samples.iter().filter(move |samples| samples.normal.dot(normal) >= near);
    let mut normal = samples.iter().max_by_key(|samples| around(samples.normal).count())?.normal;
    for _ in 0..SETTLING {
        normal = around(normal).map(|samples| samples.normal).sum::<DVec3>().try_normalize()?;
    }
    Some(normal)
}

/// Median: the middle value, or the mean of the middle two; NaN for no values.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let at = |i: usize| values.get(i).copied().unwrap_or(f64::NAN);
    0.5 * (at(values.len().saturating_sub(1) / 2) + at(values.len() / 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(x: f64, normal: DVec3) -> Sample {
        Sample { at: DVec3::new(x, 0.1 * x, 0.0), normal: normal.normalize() }
    }

    #[test]
    fn the_two_largest_faces_are_found_among_strays() {
        let mut samples: Vec<Sample> =
            (0..5).map(|i| sample(2.0, DVec3::new(1.0, 0.02 * f64::from(i), 0.0))).collect();
        samples.push(sample(9.0, DVec3::X));
        samples.extend([sample(3.0, DVec3::Y); 4]);
        samples.extend([sample(5.0, DVec3::NEG_Z); 2]);
        let found = facets(&samples, 0.35);
        assert_eq!(found.iter().map(|facet| facet.members.len()).collect::<Vec<_>>(), [6, 4]);
        assert!(found[0].normal.x > 0.999 && (found[0].offset - 2.0).abs() < 0.02, "{found:?}");
        assert!((found[1].normal - DVec3::Y).length() < 1e-12 && (found[1].offset - 0.3).abs() < 1e-12);
        assert!(facets(&samples[..2], 0.35).is_empty() && facets(&[], 0.35).is_empty());
    }

    #[test]
    fn a_rounded_face_is_one() {
        let around = (0..30)
            .map(|i| sample(1.0, DVec3::new((0.04 * f64::from(i)).cos(), (0.04 * f64::from(i)).sin(), 0.0)));
        let found = facets(&around.collect::<Vec<_>>(), 0.35);
        assert_eq!(found.len(), 1, "{found:?}");
    }

    #[test]
    fn a_median_is_in_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 9.0]), 3.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 9.0]), 3.0);
        assert!(median(vec![]).is_nan());
    }
}
