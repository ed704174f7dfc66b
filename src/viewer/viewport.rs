//! Viewport: the size of the rendered picture and its angle of view.

use glam::DVec2;

/// Size and projection of the rendered picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Vertical angle of view, degrees.
    pub fov_y_deg: f64,
    /// Whether the projection is parallel. At the pivot's distance its scale is that of the perspective projection.
    pub parallel: bool,
}

impl Viewport {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Half the height of the view volume at a distance of 1.
    pub fn tan_half_fov(&self) -> f64 {
        (0.5 * self.fov_y_deg.to_radians()).tan()
    }

    /// World units per pixel at a distance.
    pub fn units_per_px(&self, distance: f64) -> f64 {
        2.0 * distance * self.tan_half_fov() / f64::from(self.size[1])
    }

    /// The centre of the picture, px from its top left.
    pub fn centre(&self) -> DVec2 {
        0.5 * DVec2::from(self.size.map(f64::from))
    }

    /// Half the width and half the height of the view volume at a distance of 1.
    pub fn tan_half_fovs(&self) -> [f64; 2] {
        [self.aspect() * self.tan_half_fov(), self.tan_half_fov()]
    }

    /// Converts px from the top left to px from the centre, x to the right and y upwards.
    pub fn offset_from_centre(&self, at: DVec2) -> DVec2 {
        (at - self.centre()) * DVec2::new(1.0, -1.0)
    }
}
