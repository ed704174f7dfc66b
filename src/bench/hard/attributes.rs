//! Surfels with an attribute that is zero, NaN, infinite, or extreme.

use super::case::{Case, View, ball, look};
use crate::error::Result;
use crate::geometry::{Colours, Ellipse, Surfels};
use crate::verify::scenes::random::Random;
use glam::{DVec3, Vec3};

/// Names and values that are inserted.
const VALUES: [(&str, f32); 7] = [
    ("0", 0.0),
    ("NaN", f32::NAN),
    ("infinity", f32::INFINITY),
    ("-infinity", f32::NEG_INFINITY),
    ("1e-40", 1e-40),
    ("1e14", 1e14),
    ("3e38", 3e38),
];

/// Changes one attribute of a surfel.
type Change = fn(&mut Surfels, usize, f32);
const ATTRIBUTES: [(&str, Change); 6] = [
    ("position", |surfels, i, value| surfels.positions[i].y = value),
    ("normal", |surfels, i, value| surfels.normals[i] = Vec3::splat(value)),
    ("radius", |surfels, i, value| surfels.radii[i] = value),
    ("longer axis", |surfels, i, value| {
        with_ellipse(surfels, i, |ellipse| ellipse.major = Vec3::splat(value))
    }),
    ("aspect", |surfels, i, value| with_ellipse(surfels, i, |ellipse| ellipse.aspect = value)),
    ("colour", |surfels, i, value| {
        if let Some(Colours::Linear(colours)) = &mut surfels.colours {
            colours[i] = [value; 3];
        }
    }),
];

fn with_ellipse(surfels: &mut Surfels, i: usize, change: impl Fn(&mut Ellipse)) {
    surfels.ellipses.iter_mut().for_each(|ellipses| change(&mut ellipses[i]));
}

/// Every attribute with every value.
pub fn case() -> Case {
    Case {
        name: "attributes",
        description: "A sphere of discs. Every 20th has one attribute replaced; no other disc may change.",
        parameter: "index of the attribute and its value",
        logarithmic: false,
        values: (1..=ATTRIBUTES.len() * VALUES.len()).map(|number| number as f64).collect(),
        view,
        half: false,
        float32_limit: |number, _| {
            (named(number) == ("colour", "1e14"))
                .then_some("errors are relative to the colour, the tolerance is absolute")
        },
    }
}

/// Indices of an attribute and a value.
fn places(number: f64) -> (usize, usize) {
    let index = number as usize - 1;
    (index / VALUES.len(), index % VALUES.len())
}

/// Names of an attribute and a value.
fn named(number: f64) -> (&'static str, &'static str) {
    let (attribute, value) = places(number);
    (ATTRIBUTES[attribute].0, VALUES[value].0)
}

fn view(number: f64) -> Result<View> {
    let (attribute, value) = places(number);
    let (change, value) = (ATTRIBUTES[attribute].1, VALUES[value].1);
    let mut surfels = ball(1000, &mut Random::new(9, 1));
    surfels.ellipses = Some(surfels.normals.iter().map(|normal| Ellipse::circle(*normal)).collect());
    for i in (0..surfels.len()).step_by(20) {
        change(&mut surfels, i, value);
    }
    let camera = look(DVec3::new(2.1, 1.0, 2.6), DVec3::ZERO, 40.0, 1e-3)?;
    let (attribute, value) = named(number);
    Ok(View { note: format!("{attribute} is {value}"), ..View::new(surfels, camera) })
}
