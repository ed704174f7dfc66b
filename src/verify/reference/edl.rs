//! Pass `edl`: darkens pixels behind their neighbours (boucheny2009).

use super::{Frame, Projector, filter};
use crate::settings::Shading;
use rayon::prelude::*;

/// The frame under eye-dome lighting, if the settings say so; over the background unless pixels are filtered, too.
pub(super) fn pass(projector: &Projector, frame: Frame) -> Frame {
    if projector.settings.shading != Shading::Edl {
        return frame;
    }
    Frame { colour: darkened(projector, &frame.colour, &frame.depth, frame.size), ..frame }
}

/// Darkens a picture of straight linear colours and α by its distances, row by row from the top left, without background.
pub fn darkened(
    projector: &Projector,
    colours: &[[f64; 4]],
    depths: &[f64],
    size: [u32; 2],
) -> Vec<[f64; 4]> {
    let settings = &projector.settings;
    filter::darkened(
        settings,
        colours,
        factors(projector, size, depths, depths),
        settings.filter_radius() == 0,
    )
}

/// The factors of a picture's colours, of pixels at the distances `own` with neighbours at the distances `others`; 0 and infinite ones have
/// no surface.
pub(super) fn factors(projector: &Projector, size: [u32; 2], own: &[f64], others: &[f64]) -> Vec<f64> {
    let [width, height] = size.map(i64::from);
    let strength = f64::from(projector.settings.edl);
    let factor = |i: usize| {
        let [x, y] = [i as i64 % width, i as i64 / width];
        let mut rise = 0.0;
        for v in (y - 1).max(0)..=(y + 1).min(height - 1) {
            for u in (x - 1).max(0)..=(x + 1).min(width - 1) {
                let near = others[(v * width + u) as usize];
                let step = ((u - x) as f64).hypot((v - y) as f64);
                if step > 0.0 && near > 0.0 && near < own[i] {
                    rise += projector.rise(near, own[i]) / step;
                }
            }
        }
        (-strength * rise / 8.0).exp()
    };
    (0..own.len()).into_par_iter().map(factor).collect()
}

impl Projector {
    /// How far a surface at distance `near` is in front of one at `far`, in widths of a pixel between both; infinitely far if `far` is infinite.
    fn rise(&self, near: f64, far: f64) -> f64 {
        let middle = if self.depth.perspective { 0.5 * (near + far) } else { 1.0 };
        let rise = if far.is_finite() { (far - near) / middle } else { far };
        rise / self.pixel_width()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Camera;
    use crate::settings::Settings;
    use glam::DVec3;

    /// Factor of the middle of 3 × 3 pixels by their distances.
    fn middle(camera: &Camera, depths: [f64; 9]) -> f64 {
        let settings = Settings { shading: Shading::Edl, edl: 2.0, ..Settings::default() };
        let projector = Projector::new(camera, [3; 2], &settings).unwrap();
        factors(&projector, [3; 2], &depths, &depths)[4]
    }

    #[test]
    fn only_neighbours_in_front_darken_by_their_slope() {
        let axes = [DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, DVec3::Y];
        // A pixel is 0.5 wide.
        let parallel = Camera::orthographic(axes, 1.5, 1.0, [0.1, 10.0]).unwrap();
        let own = 4.0;
        assert_eq!(middle(&parallel, [own; 9]), 1.0);
        let mut behind = [9.0, 0.0, 5.0, 4.5, own, 8.0, 0.0, 0.0, 6.0];
        assert_eq!(middle(&parallel, behind), 1.0);
        // A slope of 45° at one side, and on a diagonal.
        behind[1] = 3.5;
        assert!((middle(&parallel, behind) - (-2.0f64 / 8.0).exp()).abs() < 1e-12);
        behind[0] = 3.0;
        let both = (-2.0 / 8.0 * (1.0 + 2.0 / 2f64.sqrt())).exp();
        assert!((middle(&parallel, behind) - both).abs() < 1e-12);
    }

    #[test]
    fn a_plane_is_as_dark_at_every_distance_and_size() {
        let dark = |distance: f64, size: u32| {
            let camera =
                Camera::look_at(DVec3::new(0.0, 0.0, distance), DVec3::ZERO, DVec3::Y, 1.0, 1.0, 1e-3)
                    .unwrap();
            let settings = Settings { shading: Shading::Edl, edl: 1.0, ..Settings::default() };
            let projector = Projector::new(&camera, [size; 2], &settings).unwrap();
            // Turned by 60° about the vertical through the middle.
            let middle = 0.5 * f64::from(size) - 0.5;
            let depths: Vec<f64> = (0..size * size)
                .map(|i| 1.0 / (1.0 + (f64::from(i % size) - middle) * projector.pixel_width() * 3f64.sqrt()))
                .map(|depth| depth * distance)
                .collect();
            factors(&projector, [size; 2], &depths, &depths)[(size * (size / 2) + size / 2) as usize]
        };
        // A neighbour at the side, and two on diagonals.
        let expected = (-3f64.sqrt() * (1.0 + 2f64.sqrt()) / 8.0).exp();
        for (distance, size) in [(1.0, 301), (50.0, 301), (1.0, 1201)] {
            let found = dark(distance, size);
            assert!((found - expected).abs() < 5e-3, "{distance} {size}: {found}, {expected}");
        }
    }
}
