//! The same picture from farther and farther away.

use super::case::{Case, View, ball, decades, look};
use crate::error::Result;
use crate::geometry::Camera;
use crate::settings::Precision;
use crate::verify::scenes::random::Random;
use glam::DVec3;

/// Height of the picture at the object, in its radii.
const HEIGHT: f64 = 2.4;

/// Cases of a sphere of radius 1.
pub fn cases() -> [Case; 2] {
    let case = |name, description, values, view, float32_limit| Case {
        name,
        description,
        parameter: "distance of the eye, radii of the object",
        logarithmic: true,
        values,
        view,
        half: false,
        float32_limit,
    };
    [
        case(
            "eye-distance",
            "A sphere from farther and farther away, in a field of view that shows it in the same size.",
            decades(1, 7),
            perspective,
            coarse,
        ),
        case(
            "eye-distance-parallel",
            "The same by parallel rays, with the near plane at the eye and the far plane behind the sphere as far away as the eye.",
            decades(1, 8),
            parallel,
            |_, _| None,
        ),
    ]
}

fn coarse(distance: f64, _: Precision) -> Option<&'static str> {
    (distance >= 1e7)
        .then_some("two floats round positions by 2⁻⁴⁸ of the distance, which kernels with a steep rim show")
}

fn eye(distance: f64) -> DVec3 {
    distance * DVec3::new(2.1, 1.0, 2.6).normalize()
}

fn perspective(distance: f64) -> Result<View> {
    let degrees = 2.0 * (0.5 * HEIGHT / distance).atan().to_degrees();
    let camera = look(eye(distance), DVec3::ZERO, degrees, 1e-3 * distance)?;
    Ok(View::new(ball(1500, &mut Random::new(6, 1)), camera))
}

fn parallel(distance: f64) -> Result<View> {
    let view = [eye(distance), DVec3::ZERO, DVec3::Y];
    let camera = Camera::orthographic(view, HEIGHT, 1.0, [0.0, 2.0 * distance])?;
    Ok(View::new(ball(1500, &mut Random::new(6, 1)), camera))
}
