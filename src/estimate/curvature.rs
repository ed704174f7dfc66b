//! Curvatures from the nearest points: how far a surface bends away from the tangent plane.

use super::sites::Sites;
use crate::Progress;
use crate::error::Result;
use crate::geometry::Surfels;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of neighbours.
const NEIGHBOURS: usize = 10;
/// Cosine above which normals are of the same side of a surface.
const SAME_SIDE: f64 = 0.0;
/// Number of surfels per task.
const PIECE: usize = 1 << 12;

/// The second largest curvature at every surfel towards one of its neighbours, 1 / the positions' unit: a single stray one does not bend the
/// surface. 0 at two-sided surfels, and without two neighbours of the same side.
pub(super) fn curvatures(surfels: &Surfels, sites: &Sites, progress: &dyn Progress) -> Result<Vec<f32>> {
    let mut curvatures = vec![0.0; surfels.len()];
    let (done, total) = (AtomicU64::new(0), surfels.len() as u64);
    curvatures.par_chunks_mut(PIECE).enumerate().try_for_each(|(piece, curvatures)| {
        let first = piece * PIECE;
        curvatures.iter_mut().zip(first..).for_each(|(curvature, i)| {
            *curvature = curvature_at(surfels, sites, i).unwrap_or_default();
        });
        let piece = curvatures.len() as u64;
        progress.at("estimating curvatures", done.fetch_add(piece, Ordering::Relaxed) + piece, total);
        progress.check_cancelled()
    })?;
    Ok(curvatures)
}

fn curvature_at(surfels: &Surfels, sites: &Sites, i: usize) -> Option<f32> {
    let normal = surfels.normals[i].as_dvec3();
    let is_two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    if is_two_sided(i) {
        return None;
    }
    let site = sites.of_point[i];
    let circles = sites.nearest(site, NEIGHBOURS).filter_map(|other| {
        let point = sites.point[other as usize] as usize;
        let is_same_side = !is_two_sided(point) && surfels.normals[point].as_dvec3().dot(normal) > SAME_SIDE;
        let offset = (sites.at(other) - sites.at(site)).as_dvec3();
        // Through the centre and the neighbour, tangent to the disc.
        is_same_side.then(|| -2.0 * offset.dot(normal) / offset.length_squared())
    });
    let second = |[most, second]: [f64; 2], circle: f64| [most.max(circle), second.max(most.min(circle))];
    let [_, curvature] =
        circles.fold([f64::NEG_INFINITY; 2], second).map(|circle| circle / f64::from(sites.unit));
    Some(curvature as f32).filter(|curvature| curvature.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// The curvatures of `count` points of a surface, given by the position and normal at parameters from 0 to 1.
    fn of(count: usize, surface: impl Fn(f32, f32) -> [Vec3; 2]) -> Vec<f32> {
        let at = |i: usize| surface((i as f32 + 0.5) / count as f32, (i as f32 * 0.618_034).fract());
        let surfels = Surfels {
            positions: (0..count).map(|i| at(i)[0]).collect(),
            normals: (0..count).map(|i| at(i)[1]).collect(),
            radii: vec![1.0; count],
            ..Surfels::default()
        };
        let sites = Sites::new(&surfels.positions, &()).unwrap();
        curvatures(&surfels, &sites, &()).unwrap()
    }

    fn middle(mut values: Vec<f32>) -> f32 {
        values.sort_by(f32::total_cmp);
        values[values.len() / 2]
    }

    #[test]
    fn spheres_of_any_size_have_the_inverse_of_their_radius() {
        for radius in [1e-20_f32, 0.1, 1.0, 1e15] {
            for outwards in [1.0, -1.0] {
                let sphere = |s: f32, t: f32| {
                    let (z, angle) = (2.0 * s - 1.0, t * std::f32::consts::TAU);
                    let unit =
                        Vec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z);
                    [radius * unit, outwards * unit]
                };
                let found = of(4000, sphere);
                let wrong = |k: &&f32| (**k * radius * outwards - 1.0).abs() > 0.01;
                assert_eq!(found.iter().filter(wrong).count(), 0, "{radius} {outwards}");
            }
        }
    }

    #[test]
    fn of_a_cylinder_and_a_saddle_it_is_the_larger_principal_one() {
        let cylinder = |s: f32, t: f32| {
            let normal = Vec3::new((3.0 * t).cos(), (3.0 * t).sin(), 0.0);
            [normal + 2.0 * s * Vec3::Z, normal]
        };
        assert!((middle(of(4000, cylinder)) - 1.0).abs() < 0.1);
        // z = −3 x² / 2 + y² / 2 near the origin: curvatures 3 and −1.
        let saddle = |s: f32, t: f32| {
            let (x, y) = (0.02 * (s - 0.5), 0.02 * (t - 0.5));
            [Vec3::new(x, y, -1.5 * x * x + 0.5 * y * y), Vec3::new(3.0 * x, -y, 1.0).normalize()]
        };
        assert!((middle(of(1000, saddle)) - 3.0).abs() < 0.3);
    }

    #[test]
    fn planes_have_none() {
        assert!(of(500, |s, t| [Vec3::new(s, t, 0.0), Vec3::Z]).iter().all(|k| *k == 0.0));
    }

    #[test]
    fn the_other_side_of_a_sheet_does_not_bend_it() {
        let sheet = |s: f32, t: f32| {
            let up = if ((s * 1000.0) as u32).is_multiple_of(2) { 1.0 } else { -1.0 };
            [Vec3::new(s, t, 1e-3 * up), up * Vec3::Z]
        };
        assert!(of(1000, sheet).iter().all(|k| *k == 0.0));
    }
}
