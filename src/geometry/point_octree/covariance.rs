//! Generic homogeneous covariance (pajarola2004 section 4.2).

use glam::{DMat3, DMat4, DVec3, DVec4};

/// The sum Σ p′ p′ᵀ over points, p′ = (p, 1): covariance about the origin, from which that about any centre follows. Each point adds the
/// covariance of its disc, since a node of one or two points spans no area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Covariance(DMat4);

impl Covariance {
    /// That of no points.
    pub const NONE: Self = Self(DMat4::ZERO);

    /// That of a point and its disc.
    pub fn of(position: DVec3, disc: DMat3) -> Self {
        let p = position.extend(1.0);
        let square = DMat4::from_cols(p * p.x, p * p.y, p * p.z, p);
        let [x, y, z] = [disc.x_axis, disc.y_axis, disc.z_axis].map(|axis| axis.extend(0.0));
        Self(square + DMat4::from_cols(x, y, z, DVec4::ZERO))
    }

    /// That of both sets of points (equation 4).
    pub fn with(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    /// Mean of the points.
    pub fn mean(&self) -> DVec3 {
        self.0.w_axis.truncate() / self.0.w_axis.w
    }

    /// The covariance about `centre` (equations 2 and 3), k⁻¹ T M Tᵀ.
    pub fn about(&self, centre: DVec3) -> DMat3 {
        let moved = DMat4::from_translation(-centre);
        DMat3::from_mat4(moved * self.0 * moved.transpose()) * (1.0 / self.0.w_axis.w)
    }
}
