//! Directions of the world: its up axis, and the directions to view from.

use glam::DVec3;

/// Up axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Up {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Whether the axis points down.
    pub down: bool,
}

impl Up {
    /// The unit vector.
    pub fn vector(self) -> DVec3 {
        let sign = if self.down { -1.0 } else { 1.0 };
        sign * DVec3::AXES[self.axis]
    }
}

/// Direction to view from. From the `Front`, +z points towards the viewer if y is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewDirection {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
}

impl ViewDirection {
    /// Yaw and pitch of the camera, radians.
    pub fn yaw_and_pitch(self) -> [f64; 2] {
        let quarter = 0.5 * std::f64::consts::PI;
        match self {
            Self::Front => [0.0, 0.0],
            Self::Right => [quarter, 0.0],
            Self::Back => [2.0 * quarter, 0.0],
            Self::Left => [-quarter, 0.0],
            Self::Top => [0.0, quarter],
            Self::Bottom => [0.0, -quarter],
        }
    }
}
