//! Points whose normals mean little, and points on no surface: in vegetation, in noise, at the edges of what a depth camera sees.

use super::neighbours::Survey;
use glam::Vec3;

/// Mean 1 − |cosine| between a point's normal and those of its neighbours above which the normals have little in common: that of 37°; of random
/// directions it is ½.
const UNLIKE: f32 = 0.2;
/// The same, averaged over the neighbourhood, above which its points are on no surface, if they are rough, too. At creases and in noise normals
/// differ in places, in vegetation everywhere.
const UNLIKE_AROUND: f32 = 0.25;
/// Roughness, averaged over the neighbourhood, above which its points are on no surface. In the volume of a ball it is 0.2, and 0.14 at most in
/// scans of smooth objects.
const ROUGH_AROUND: f32 = 0.12;
/// Least part of the points on no surface. Thin parts of an object, such as the tip of an ear, look alike, and would get holes: these are 3 % at
/// most in scans of objects. Airborne scans with trees have 10 %.
const LEAST_PART: f64 = 0.05;
/// Radius of the disc of a point on no surface, in distances of its third neighbour: such discs touch, and do not merge.
pub(super) const RADIUS: f32 = 0.5;

/// Of every site: what its neighbourhood is.
pub(super) struct Scatter {
    /// Whether its normal and those of its neighbours have little in common.
    pub scattered: Vec<bool>,
    /// Whether it is on no surface.
    pub volume: Vec<bool>,
}

impl Scatter {
    pub fn new(survey: &Survey, normals: &[Vec3]) -> Self {
        let (mut unlike, mut rough) = (vec![0.0; normals.len()], vec![0.0; normals.len()]);
        for (site, patch, near) in survey.each() {
            let normal = normals[site as usize];
            unlike[site as usize] = mean(near, |other| 1.0 - normals[other as usize].dot(normal).abs());
            rough[site as usize] = patch.roughness;
        }
        let around = |values: &[f32], site: u32, near: &[u32]| {
            (mean(near, |other| values[other as usize]) * near.len() as f32 + values[site as usize])
                / (near.len() + 1) as f32
        };
        let mut thick = vec![0.0; normals.len()];
        for (site, _, near) in survey.each() {
            let is_thick =
                around(&rough, site, near) > ROUGH_AROUND && around(&unlike, site, near) > UNLIKE_AROUND;
            thick[site as usize] = f32::from(u8::from(is_thick));
        }
        // By majority: vegetation has no spots of surface, nor a surface spots of vegetation.
        let mut volume = vec![false; normals.len()];
        survey.each().for_each(|(site, _, near)| volume[site as usize] = around(&thick, site, near) > 0.5);
        let count = volume.iter().filter(|volume| **volume).count();
        if (count as f64) < LEAST_PART * survey.each().count() as f64 {
            volume.fill(false);
        }
        Self { scattered: unlike.iter().map(|unlike| *unlike > UNLIKE).collect(), volume }
    }
}

fn mean(near: &[u32], value: impl Fn(u32) -> f32) -> f32 {
    near.iter().map(|&other| value(other)).sum::<f32>() / near.len() as f32
}

#[cfg(test)]
mod tests {
    use crate::estimate::Estimate;
    use crate::geometry::{Cloud, Surfels};
    use glam::Vec3;

    /// The surfels of points, and the shares of those with normals unlike their neighbours' and of billboards.
    fn estimated(positions: Vec<Vec3>, how: &Estimate) -> (Surfels, [f64; 2]) {
        let (surfels, counts) = Cloud { positions, ..Default::default() }.into_surfels(how, &()).unwrap();
        let share = |count: u64| count as f64 / surfels.len() as f64;
        let shares = [counts.scattered, counts.billboards].map(share);
        (surfels, shares)
    }

    /// Pseudo-random points.
    fn in_cube(i: usize) -> Vec3 {
        let part = |axis: u64| {
            let hash = (3 * i as u64 + axis + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let hash = (hash ^ (hash >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
            ((hash ^ (hash >> 32)) >> 40) as f32 / (1 << 24) as f32
        };
        Vec3::new(part(0), part(1), part(2))
    }

    /// Points of a low-discrepancy sequence on a square.
    fn on_square(i: usize) -> Vec3 {
        let part = |step: f64| (step * i as f64).fract() as f32;
        Vec3::new(part(0.754_877_7), part(0.569_840_3), 0.0)
    }

    /// On a cylinder of six spacings' radius.
    fn on_cylinder(i: usize) -> Vec3 {
        let part = |step: f64| (step * i as f64).fract() as f32;
        let (sin, cos) = (std::f32::consts::TAU * part(0.754_877_7)).sin_cos();
        Vec3::new(cos, sin, 8.0 * part(0.569_840_3))
    }

    #[test]
    fn points_of_a_volume_are_billboards_and_those_of_surfaces_are_not() {
        let share = |positions: Vec<Vec3>| estimated(positions, &Estimate::default()).1;
        let [scattered, billboards] = share((0..2000).map(in_cube).collect());
        assert!(scattered > 0.4 && billboards > 0.9, "{scattered} {billboards}");
        assert_eq!(share((0..2000).map(on_square).collect()), [0.0; 2]);
        assert_eq!(share((0..2000).map(on_cylinder).collect()), [0.0; 2]);
        // Normals differ at the edges of a box, and nowhere else.
        let on_box = |i: usize| {
            let (point, side) = (in_cube(i), (i % 2) as f32);
            if i % 4 < 2 { point.with_x(side) } else { point.with_y(side) }
        };
        let [scattered, billboards] = share((0..6000).map(on_box).collect());
        assert!(scattered < 0.2 && billboards == 0.0, "{scattered} {billboards}");
    }

    #[test]
    fn discs_of_a_volume_stay_separate() {
        let (surfels, _) = estimated((0..2000).map(in_cube).collect(), &Estimate::default());
        for i in (0..surfels.len()).filter(|&i| surfels.is_billboard(i)) {
            let distance = |j: usize| surfels.positions[i].distance(surfels.positions[j]);
            let mut distances: Vec<f32> = (0..surfels.len()).map(distance).collect();
            let third = *distances.select_nth_unstable_by(3, f32::total_cmp).1;
            assert!(surfels.radii[i] <= 0.5001 * third, "{} {third}", surfels.radii[i]);
        }
    }

    #[test]
    fn without_billboards_every_point_has_a_normal() {
        let how = Estimate { billboards: false, ..Estimate::default() };
        let (surfels, [scattered, billboards]) = estimated((0..2000).map(in_cube).collect(), &how);
        assert!(scattered > 0.4 && billboards == 0.0);
        assert!(surfels.normals.iter().all(|normal| normal.is_normalized()));
    }

    #[test]
    fn declared_billboards_stay_and_other_points_without_normals_do_not() {
        let (surfels, _) = estimated((0..2000).map(in_cube).collect(), &Estimate::default());
        let how = Estimate { billboards: false, ..Estimate::default() };
        let (again, counts) = Cloud::from(surfels.clone()).into_surfels(&how, &()).unwrap();
        assert_eq!((&again.normals, &again.radii), (&surfels.normals, &surfels.radii));
        assert_eq!(counts.normals_given, 2000);
        let (bare, counts) =
            Cloud { two_sided: None, ..Cloud::from(surfels) }.into_surfels(&how, &()).unwrap();
        assert!(counts.billboards == 0 && !bare.normals.contains(&Vec3::ZERO));
    }
}
