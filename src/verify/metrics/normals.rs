//! Angle between the normals of both pictures, over pixels that both cover: `atan2(|a × b|, a · b)`, which is exact for
//! small angles, unlike the arc cosine, and does not need unit vectors.
//!
//! Unit: degrees; range 0 to 180; less is better. Normals face the eye in both pictures, so a flipped normal counts in
//! full.

use super::Pair;
use super::statistics::Sorted;
use glam::DVec3;

/// Angles over the pixels that both cover, degrees. Percentiles by the nearest-rank definition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalError {
    /// Median.
    pub median: f64,
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Maximum.
    pub max: f64,
}

/// Compares the normals; `None` if a picture has none, or if no pixel is covered in both.
pub fn normals(pair: &Pair<'_>) -> Option<NormalError> {
    let (ours, truth) = (pair.picture().normal.as_ref()?, pair.truth().normal.as_ref()?);
    let angles = Sorted::new(pair.covered_in_both().map(|i| angle(ours[i], truth[i])))?;
    let [median, p95] = [0.5, 0.95].map(|share| angles.percentile(share));
    Some(NormalError { median, mean: angles.mean(), p95, max: angles.max() })
}

fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|normal| DVec3::from_array(normal.map(f64::from)));
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;
    use glam::DQuat;

    fn picture(normals: &[[f32; 3]]) -> Picture {
        Picture {
            size: [normals.len() as u32, 1],
            colour: vec![[1.0; 4]; normals.len()],
            normal: Some(normals.to_vec()),
            ..Default::default()
        }
    }

    fn rotated(normals: &[[f32; 3]], degrees: &[f64]) -> Picture {
        let rotate = |(normal, degrees): (&[f32; 3], &f64)| {
            let normal = DVec3::from_array(normal.map(f64::from));
            let turned =
                DQuat::from_axis_angle(normal.any_orthonormal_vector(), degrees.to_radians()) * normal;
            turned.to_array().map(|value| value as f32)
        };
        picture(&normals.iter().zip(degrees).map(rotate).collect::<Vec<_>>())
    }

    const NORMALS: [[f32; 3]; 4] = [[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [-0.48, 0.6, 0.64], [1.0, 0.0, 0.0]];

    #[test]
    fn known_rotations_are_found() {
        let truth = picture(&NORMALS);
        let same = normals(&Pair::new(&truth, &truth).unwrap()).unwrap();
        assert!(same.max < 1e-9, "{same:?}");
        let turned = rotated(&NORMALS, &[3.0, 0.001, 90.0, 180.0]);
        let found = normals(&Pair::new(&turned, &truth).unwrap()).unwrap();
        for (found, expected) in
            [(found.median, 3.0), (found.mean, 273.001 / 4.0), (found.p95, 180.0), (found.max, 180.0)]
        {
            assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        }
        let small = rotated(&NORMALS, &[0.001; 4]);
        let found = normals(&Pair::new(&small, &truth).unwrap()).unwrap();
        assert!((found.mean - 0.001).abs() < 5e-6, "{found:?}");
    }

    #[test]
    fn percentiles_are_those_of_their_names() {
        let degrees: Vec<f64> = (1..=100).map(f64::from).collect();
        let all = [NORMALS[1]; 100];
        let (truth, turned) = (picture(&all), rotated(&all, &degrees));
        let found = normals(&Pair::new(&turned, &truth).unwrap()).unwrap();
        assert!((found.median - 50.0).abs() < 1e-4 && (found.p95 - 95.0).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn only_pixels_that_both_cover_count() {
        let truth = picture(&NORMALS);
        let mut turned = rotated(&NORMALS, &[1.0, 70.0, 80.0, 2.0]);
        turned.normal.as_mut().unwrap()[1] = [0.0; 3];
        turned.colour[2][3] = 0.0;
        let found = normals(&Pair::new(&turned, &truth).unwrap()).unwrap();
        assert!((found.max - 2.0).abs() < 1e-5 && (found.mean - 1.5).abs() < 1e-5, "{found:?}");
        turned.colour = vec![[0.0; 4]; 4];
        assert_eq!(normals(&Pair::new(&turned, &truth).unwrap()), None);
        turned.normal = None;
        assert_eq!(normals(&Pair::new(&turned, &truth).unwrap()), None);
    }
}
