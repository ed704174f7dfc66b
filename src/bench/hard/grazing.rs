//! Planes at ever more grazing angles.

use super::case::{Case, View, decades, push, signed, vector};
use crate::error::Result;
use crate::geometry::{Camera, Surfels};
use crate::settings::Precision;
use crate::verify::scenes::random::Random;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Distance from the eye to the middle of the picture, which has height 2.
const DISTANCE: f64 = 10.0;
/// Distance of the eye from the magnified plane.
const FAR: f64 = 100.0;

/// Many planes; and one that is magnified, in perspective and in parallel projection.
pub fn cases() -> [Case; 3] {
    let parameter = "angle between plane and direction of view, degrees";
    let values = || decades(-4, 0).into_iter().chain([3.0, 10.0, 30.0, 60.0, 90.0]).collect();
    let case = |name, description, view, float32_limit| Case {
        name,
        description,
        parameter,
        logarithmic: true,
        values: values(),
        view,
        half: false,
        float32_limit,
    };
    [
        case(
            "grazing",
            "Eight planes of overlapping discs, all at one angle of view, until they appear as lines.",
            lines,
            |_, _| None,
        ),
        case(
            "grazing-magnified",
            "One plane, magnified until it fills the picture: discs a few px high and up to 10 million px wide.",
            perspective,
            too_wide,
        ),
        case("grazing-parallel", "The same in parallel projection.", parallel, too_wide),
    ]
}

fn too_wide(degrees: f64, _: Precision) -> Option<&'static str> {
    (degrees < 0.005).then_some(
        "half a unit in the last place of an axis moves the image of a disc 500,000 px away by fractions of a pixel",
    )
}

/// Two axes in a plane, and its normal; at no simple angle to the world's axes.
fn axes() -> DMat3 {
    DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7))
}

/// Eye, target and up vector for an angle with this sine and cosine.
fn stand(distance: f64, (sin, cos): (f64, f64)) -> [DVec3; 3] {
    let axes = axes();
    [distance * (axes * DVec3::new(0.0, -cos, sin)), DVec3::ZERO, axes * DVec3::new(0.0, sin, cos)]
}

/// Adds `columns` × `rows` overlapping discs of one radius in a plane. Displacement and tilt are as large as an angle
/// of view with this sine allows.
fn plane(
    surfels: &mut Surfels,
    random: &mut Random,
    [columns, rows]: [u32; 2],
    radius: f64,
    sine: f64,
    pose: DAffine3,
) {
    let axes = axes();
    for i in 0..columns * rows {
        let at = |k: u32, count: u32| (f64::from(k) - 0.5 * f64::from(count - 1)) / 1.5;
        let [x, y] = [at(i % columns, columns), at(i / columns, rows)].map(|v| v + 0.2 * signed(random));
        let position = radius * (axes * DVec3::new(x, y, 0.2 * sine * signed(random)));
        let normal = axes.z_axis + 0.1 * sine * vector(random);
        push(surfels, random, pose.transform_point3(position), pose.transform_vector3(normal), radius);
    }
}

/// Eight planes, moved by `pose(k)` with `k` from −0.9 to 0.9.
fn planes(sine: f64, pose: impl Fn(f64) -> DAffine3) -> Surfels {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(1, 1));
    for k in 0..8 {
        let pose = pose(1.8 * f64::from(k) / 7.0 - 0.9);
        plane(&mut surfels, &mut random, [17, 6], 0.2, sine, pose);
    }
    surfels
}

fn lines(degrees: f64) -> Result<View> {
    let angle = degrees.to_radians().sin_cos();
    let [eye, target, up] = stand(DISTANCE, angle);
    // Rotations around the eye, so that it sees all planes at one angle.
    let turn = |k: f64| {
        let about_eye = DAffine3::from_axis_angle(axes().x_axis, k / DISTANCE);
        DAffine3::from_translation(eye) * about_eye * DAffine3::from_translation(-eye)
    };
    // Near enough not to clip the planes, which extend below their images to under the eye.
    let near = 1e-3 * angle.0;
    let camera = Camera::look_at(eye, target, up, 2.0 * (1.0 / DISTANCE).atan(), 1.0, near)?;
    Ok(View::new(planes(angle.0, turn), camera))
}

/// The magnified plane.
fn one(sine: f64) -> Surfels {
    let mut surfels = Surfels::default();
    plane(&mut surfels, &mut Random::new(1, 2), [30, 30], 1.0, sine, DAffine3::IDENTITY);
    surfels
}

fn perspective(degrees: f64) -> Result<View> {
    let angle = degrees.to_radians().sin_cos();
    let [eye, target, up] = stand(FAR, angle);
    let camera = Camera::look_at(eye, target, up, 2.0 * (7.0 * angle.0 / FAR).atan(), 1.0, 1.0)?;
    Ok(View::new(one(angle.0), camera))
}

fn parallel(degrees: f64) -> Result<View> {
    let angle = degrees.to_radians().sin_cos();
    let camera = Camera::orthographic(stand(FAR, angle), 14.0 * angle.0, 1.0, [1.0, 2.0 * FAR])?;
    Ok(View::new(one(angle.0), camera))
}
