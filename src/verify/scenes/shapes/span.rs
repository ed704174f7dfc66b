//! Parts of parametrised surfaces.

use super::patch::{Jet, Parametric};
use glam::DVec2;

/// A surface restricted to a range of u.
#[derive(Clone, Copy, Debug)]
pub struct Span<P> {
    /// The whole surface.
    pub surface: P,
    /// Start of the range.
    pub from: f64,
    /// Length of the range.
    pub length: f64,
}

impl<P: Parametric> Parametric for Span<P> {
    fn jet(&self, uv: DVec2) -> Jet {
        let jet = self.surface.jet(DVec2::new(self.from + self.length * uv.x, uv.y));
        Jet { du: self.length * jet.du, ..jet }
    }

    fn extent(&self) -> DVec2 {
        self.surface.extent() * DVec2::new(self.length, 1.0)
    }
}
