//! The picture that is being looked at: its size, and what is seen in it.

use glam::DVec2;

/// A picture that is being looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Vertical angle of view, degrees.
    pub fov_y_deg: f64,
    /// Rays are parallel; what is as far as the pivot is as large as in perspective.
    pub parallel: bool,
}

impl Lens {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Half the height of what is seen at a distance of 1.
    pub fn slope(&self) -> f64 {
        (0.5 * self.fov_y_deg.to_radians()).tan()
    }

    /// World units a px, at a distance.
    pub fn px(&self, distance: f64) -> f64 {
        2.0 * distance * self.slope() / f64::from(self.size[1])
    }

    /// The middle, px.
    pub fn middle(&self) -> DVec2 {
        0.5 * DVec2::from(self.size.map(f64::from))
    }

    /// Half the width and half the height of what is seen at a distance of 1.
    pub fn slopes(&self) -> [f64; 2] {
        [self.aspect() * self.slope(), self.slope()]
    }

    /// From the middle of the picture, x to the right and y upwards, px.
    pub fn off_middle(&self, at: DVec2) -> DVec2 {
        (at - self.middle()) * DVec2::new(1.0, -1.0)
    }
}
