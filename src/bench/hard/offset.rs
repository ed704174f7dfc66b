//! The same scene far from the world's origin, and in other units.

use super::case::{Case, View, ball, decades, look};
use crate::error::Result;
use crate::verify::scenes::random::Random;
use glam::DVec3;

const DISTANCE: &str = "distance from the world's origin, radii of the object";

/// Cases of a sphere of radius 1.
pub fn cases() -> [Case; 3] {
    let case = |name, description, parameter, values, view| Case {
        name,
        description,
        parameter,
        logarithmic: true,
        values,
        view,
        half: false,
        float32_limit: |_, _| None,
    };
    [
        case(
            "offset-origin",
            "A sphere far from the world's origin, seen from nearby, with the offset in the surfels' float64 origin.",
            DISTANCE,
            decades(0, 8),
            |value| view(value, true, 1.0),
        ),
        case(
            "offset-positions",
            "The same with the offset in the float32 positions; the reference uses the rounded positions.",
            DISTANCE,
            decades(0, 8),
            |value| view(value, false, 1.0),
        ),
        case(
            "unit",
            "A sphere and its camera in other units of length.",
            "radius of the object",
            decades(-12, 12).into_iter().step_by(3).collect(),
            |value| view(0.0, true, value),
        ),
    ]
}

fn view(offset: f64, as_origin: bool, unit: f64) -> Result<View> {
    let mut surfels = ball(1500, &mut Random::new(4, 1));
    let middle = offset * DVec3::new(0.6, -0.64, 0.48);
    for position in &mut surfels.positions {
        let within = position.as_dvec3() * unit;
        *position = if as_origin { within } else { middle + within }.as_vec3();
    }
    surfels.radii.iter_mut().for_each(|radius| *radius *= unit as f32);
    surfels.origin = if as_origin { middle } else { DVec3::ZERO };
    let eye = middle + unit * DVec3::new(2.1, 1.0, 2.6);
    Ok(View::new(surfels, look(eye, middle, 40.0, 1e-3 * unit)?))
}
