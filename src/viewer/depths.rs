//! Depths of a picture: the surface point under the cursor.

use glam::{DVec2, DVec3};
use surfel::geometry::Camera;

/// Distance from the cursor within which a surface counts as under it, px of the picture: points may leave holes.
const NEAR: i32 = 4;

/// Depths of a picture, and the camera that it was rendered with.
pub struct Depths<'a> {
    pub camera: Camera,
    /// Width and height, px.
    pub size: [u32; 2],
    /// A 4-byte float per pixel, row by row from the top left; reversed, 0 without a surface.
    pub bytes: &'a [u8],
}

impl Depths<'_> {
    /// The surface point that is nearest to a position on the picture, in world space; `None` if there is none near it. The position is given
    /// as parts of width and height, from the top left.
    pub fn surface_at(&self, part: DVec2) -> Option<DVec3> {
        let size = DVec2::from(self.size.map(f64::from));
        let near = (-NEAR..=NEAR).flat_map(|y| (-NEAR..=NEAR).map(move |x| [x, y]));
        let found = near.filter_map(|offset| {
            let at = part * size + DVec2::from(offset.map(f64::from));
            let [x, y] = offset;
            self.depth(at).map(|depth| (x * x + y * y, at, depth))
        });
        let (_, at, depth) = found.min_by_key(|(distance, ..)| *distance)?;
        let clip = (2.0 * at / size - 1.0).extend(depth);
        Some(self.camera.world_to_clip().inverse().project_point3(clip)).filter(|point| point.is_finite())
    }

    /// Depth of the pixel at a position, px; `None` outside the picture and where there is no surface.
    fn depth(&self, at: DVec2) -> Option<f64> {
        let [width, height] = self.size.map(f64::from);
        if !(at.min_element() >= 0.0 && at.x < width && at.y < height) {
            return None;
        }
        let first = 4 * (at.y as usize * self.size[0] as usize + at.x as usize);
        let bytes = self.bytes.get(first..first + 4)?.try_into().ok()?;
        Some(f64::from(f32::from_ne_bytes(bytes))).filter(|depth| *depth > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use surfel::geometry::{Bounds, Pose, Span};

    #[test]
    fn the_nearest_surface_is_found_where_it_is() {
        let (eye, target) = (DVec3::new(1.0, 2.0, 9.0), DVec3::new(1.0, 2.0, 0.0));
        let pose = Pose { eye, target, up: DVec3::Y, span: Span::Angle(46.0) };
        let bounds = Bounds::of_box(DVec3::splat(-1.0), DVec3::ONE);
        let (camera, size) = (pose.camera(&bounds, 2.0).unwrap(), [40u32, 20]);
        let near = Camera::near_for(eye, &bounds);
        let mut depths = vec![0.0f32; 800];
        // Two pixels with surfaces, 5 and 3 ahead of the eye.
        for (x, y, distance) in [(10, 6, 5.0), (17, 6, 3.0)] {
            depths[40 * y + x] = (near / distance) as f32;
        }
        let bytes: Vec<u8> = depths.iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let depths = Depths { camera, size, bytes: &bytes };
        let at = |x: f64, y: f64| depths.surface_at(DVec2::new(x / 40.0, y / 20.0));
        for (x, y, z) in [(10.5, 6.5, 4.0), (12.5, 7.5, 4.0), (17.5, 6.5, 6.0), (14.6, 6.5, 6.0)] {
            let point = at(x, y).unwrap();
            assert!((point.z - z).abs() < 1e-5, "{x} {y}: {point}");
        }
        let on_axis = DVec3::new(1.0 + 5.0 * 2.0 * 23f64.to_radians().tan() * (10.5 / 20.0 - 1.0), 0.0, 0.0);
        assert!((at(10.5, 6.5).unwrap().x - on_axis.x).abs() < 1e-5);
        assert_eq!([at(30.0, 10.0), at(-9.0, 6.5), at(f64::NAN, 6.5)], [None; 3]);
    }
}
