//! A relief: a horizontal square with waves.

use super::patch::{Jet, Parametric};
use glam::{DVec2, DVec3};

/// Waves by their wave vectors, radians per unit, and their shares of the relief's height.
const WAVES: [([f64; 2], f64); 4] =
    [([2.1, 0.7], 0.4), ([-1.3, 2.9], 0.3), ([4.7, -3.1], 0.2), ([1.9, 7.3], 0.1)];

/// The square `|x|, |z| ≤ half`, raised by a sum of four waves; u is along z, v along x, and the outer side is above.
#[derive(Clone, Copy, Debug)]
pub struct Relief {
    /// Half the square's side.
    pub half: f64,
    /// Greatest possible height above, and depth below, `y = 0`.
    pub height: f64,
}

impl Relief {
    /// Height above `y = 0`, and its derivatives by x and z.
    pub fn elevation(&self, x: f64, z: f64) -> (f64, DVec2) {
        let wave = |([kx, kz], part): ([f64; 2], f64)| {
            let (sin, cos) = (kx * x + kz * z).sin_cos();
            (self.height * part * sin, self.height * part * cos * DVec2::new(kx, kz))
        };
        WAVES.into_iter().map(wave).fold((0.0, DVec2::ZERO), |sum, wave| (sum.0 + wave.0, sum.1 + wave.1))
    }
}

impl Parametric for Relief {
    fn jet(&self, uv: DVec2) -> Jet {
        let (z, x) = (self.half * (2.0 * uv.x - 1.0), self.half * (2.0 * uv.y - 1.0));
        let (y, slope) = self.elevation(x, z);
        Jet {
            position: DVec3::new(x, y, z),
            du: 2.0 * self.half * DVec3::new(0.0, slope.y, 1.0),
            dv: 2.0 * self.half * DVec3::new(1.0, slope.x, 0.0),
        }
    }

    fn extent(&self) -> DVec2 {
        DVec2::splat(2.0 * self.half)
    }
}
