//! Surfels of the tests of changing scenes.

use crate::support::sampling::{Random, bumpy_sphere, forget_sides, narrow, paint_linear, paint_srgb};
use glam::DVec3;
use surfel::geometry::{Colours, Surfels};

pub fn sphere(count: usize) -> Surfels {
    let mut random = Random(11);
    let mut surfels = bumpy_sphere(count, &mut random);
    paint_srgb(&mut surfels, &mut random);
    surfels.sort_morton();
    surfels
}

/// Ellipses with linear colours, some of them two-sided.
pub fn ellipses(count: usize) -> Surfels {
    let mut random = Random(12);
    let mut surfels = bumpy_sphere(count, &mut random);
    paint_linear(&mut surfels, &mut random);
    forget_sides(&mut surfels, 0.4, &mut random);
    narrow(&mut surfels, &mut random);
    surfels.sort_morton();
    Surfels { origin: DVec3::new(0.125, -0.25, 0.0), ..surfels }
}

/// The first `count` surfels.
pub fn first(surfels: &Surfels, count: usize) -> Surfels {
    let mut part = surfels.clone();
    part.positions.truncate(count);
    part.normals.truncate(count);
    part.radii.truncate(count);
    part.ellipses.iter_mut().for_each(|ellipses| ellipses.truncate(count));
    part.two_sided.iter_mut().for_each(|two_sided| two_sided.truncate(count));
    match &mut part.colours {
        Some(Colours::Srgb8(colours)) => colours.truncate(count),
        Some(Colours::Linear(colours)) => colours.truncate(count),
        None => {}
    }
    part
}

/// The sphere, rotated and inflated, as by a simulation.
pub fn moved(surfels: &Surfels, step: usize) -> Surfels {
    let (turn, swell) = (glam::Quat::from_rotation_y(0.3 * step as f32), 1.0 + 0.02 * step as f32);
    let mut moved = surfels.clone();
    moved.positions.iter_mut().for_each(|p| *p = swell * (turn * *p));
    moved.normals.iter_mut().for_each(|n| *n = (turn * *n).normalize());
    moved
}

/// Surfels of which every 16th is invalid, each in another way.
pub fn spoil(surfels: &mut Surfels) -> usize {
    let spoils: [fn(&mut Surfels, usize); 12] = [
        |s, i| s.positions[i].y = f32::NAN,
        |s, i| s.positions[i].z = f32::NEG_INFINITY,
        |s, i| s.positions[i].x = -1.1e15,
        |s, i| s.normals[i] *= 0.5,
        |s, i| s.normals[i] *= 1.01,
        |s, i| s.normals[i].x = f32::NAN,
        |s, i| s.radii[i] = 0.0,
        |s, i| s.radii[i] = f32::NAN,
        |s, i| s.radii[i] = f32::INFINITY,
        |s, i| s.ellipses.as_mut().unwrap()[i].major = s.normals[i],
        |s, i| s.ellipses.as_mut().unwrap()[i].aspect = 1.5,
        |s, i| match &mut s.colours {
            Some(Colours::Linear(colours)) => colours[i][2] = f32::NAN,
            _ => panic!("colours are linear"),
        },
    ];
    let spoiled: Vec<usize> = (0..surfels.len()).filter(|i| i % 16 < spoils.len()).collect();
    spoiled.iter().for_each(|&i| spoils[i % 16](surfels, i));
    spoiled.len()
}
