//! The picture that is being looked at: its size, what is seen in it, and what of it panels leave free.

use glam::DVec2;

/// Least part of the picture's width in which scenes are framed beside what covers the rest: a narrower one shows less of them than the whole
/// picture, covered as it is.
const LEAST_FREE: f64 = 1.0 / 3.0;

/// A picture that is being looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Vertical angle of view, degrees.
    pub fov_y_deg: f64,
    /// Rays are parallel; what is as far as the pivot is as large as in perspective.
    pub parallel: bool,
    /// Width of what lies over the picture on its right, px.
    pub covered: f64,
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

    /// The middle of what is not covered, px.
    pub fn middle(&self) -> DVec2 {
        0.5 * DVec2::new(self.free(), self.size[1].into())
    }

    /// Width of what is not covered, on the left, px; all of it if that is too narrow.
    fn free(&self) -> f64 {
        let width = f64::from(self.size[0]);
        let free = width - self.covered;
        if free < LEAST_FREE * width { width } else { free }
    }

    /// Slopes of the sight at both sides of what is not covered, and half its height.
    pub fn slopes(&self) -> [f64; 3] {
        let px = self.px(1.0);
        let middle = 0.5 * f64::from(self.size[0]);
        [-middle * px, (self.free() - middle) * px, self.slope()]
    }

    /// From the middle of the picture, x to the right and y upwards, px.
    pub fn off_middle(&self, at: DVec2) -> DVec2 {
        let half = 0.5 * DVec2::from(self.size.map(f64::from));
        (at - half) * DVec2::new(1.0, -1.0)
    }
}
