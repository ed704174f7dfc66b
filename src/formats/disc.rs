//! Properties of discs in files, by which they are read back.

use super::DiscProperties;
use super::declared::Scalar;
use super::table::columns::{CLIP_CONCAVE, CLIP_LINES, CORNER_NAMES, WEIGHT_NAME};
use crate::geometry::{ClipLine, Surfels};
use glam::Vec3;

/// Names of the semi-axes of an elliptical disc.
const AXES: [&str; 6] = ["ux", "uy", "uz", "vx", "vy", "vz"];
/// Name of the flag of discs without a side.
const TWO_SIDED: &str = "two_sided";

/// Number of properties.
const COUNT: usize = 25;

/// Names of all properties of a disc.
pub const NAMES: [&str; COUNT] = names();

/// Number of the radius among the properties; those of the normal come before it.
pub const RADIUS: usize = 3;
/// Number of the first property of semi-axes.
const FIRST_AXIS: usize = 4;
/// Number of the flag of discs without a side.
const FLAG: usize = 10;
/// Number of the first property of clip lines.
const FIRST_CLIP: usize = 11;
/// Number of the flag of concave corners.
const CONCAVE: usize = 19;
/// Number of the normalization weight; those of corners follow.
pub const WEIGHT: usize = 20;

const fn names() -> [&'static str; COUNT] {
    let [a, b] = CLIP_LINES;
    let [u0, u1, u2, v0, v1, v2] = AXES;
    let [c0, c1, c2, c3] = CORNER_NAMES;
    [
        "nx",
        "ny",
        "nz",
        "radius",
        u0,
        u1,
        u2,
        v0,
        v1,
        v2,
        TWO_SIDED,
        a[0],
        a[1],
        a[2],
        a[3],
        b[0],
        b[1],
        b[2],
        b[3],
        CLIP_CONCAVE,
        WEIGHT_NAME,
        c0,
        c1,
        c2,
        c3,
    ]
}

/// Type of a property.
pub fn scalar(property: usize) -> Scalar {
    if matches!(property, FLAG | CONCAVE) { Scalar::U8 } else { Scalar::F32 }
}

/// The properties that the discs have, of those that are written.
pub fn present(surfels: &Surfels, written: DiscProperties) -> impl Iterator<Item = usize> {
    let end = match written {
        DiscProperties::All => COUNT,
        DiscProperties::Normals => RADIUS,
        DiscProperties::None => 0,
    };
    let weights = surfels.weights.as_ref();
    let has = [
        (0..FIRST_AXIS, true),
        (FIRST_AXIS..FLAG, surfels.ellipses.is_some()),
        (FLAG..FIRST_CLIP, surfels.two_sided.is_some() || surfels.normals.contains(&Vec3::ZERO)),
        (FIRST_CLIP..WEIGHT, surfels.clips.is_some()),
        (WEIGHT..WEIGHT + 1, weights.is_some()),
        (WEIGHT + 1..COUNT, weights.is_some_and(|weights| !weights.corners.is_empty())),
    ];
    let present = has.into_iter().filter(|(_, has)| *has).flat_map(|(properties, _)| properties);
    present.take_while(move |property| *property < end)
}

/// All properties of disc `i`; 0 for those that it does not have.
pub fn numbers(surfels: &Surfels, i: usize) -> [f32; COUNT] {
    let (normal, radius) = (surfels.normals[i], surfels.radii[i]);
    // Circles that face the eye have no axes.
    let ellipses = surfels.ellipses.as_ref().filter(|_| normal != Vec3::ZERO);
    let [u, v] = ellipses.map_or([Vec3::ZERO; 2], |all| all[i].semi_axes(normal, radius));
    let clip = surfels.clips.as_ref().and_then(|clips| clips.get(i)).copied().unwrap_or_default();
    let line = |ClipLine { outward, offset }: ClipLine| [outward.x, outward.y, outward.z, offset];
    let flag = |is: bool| f32::from(u8::from(is));
    let weights = surfels.weights.as_ref();
    let mut all = [0.0; COUNT];
    all[..RADIUS].copy_from_slice(&normal.to_array());
    all[RADIUS] = radius;
    all[FIRST_AXIS..FIRST_AXIS + 3].copy_from_slice(&u.to_array());
    all[FIRST_AXIS + 3..FLAG].copy_from_slice(&v.to_array());
    // A billboard is a two-sided disc without a normal.
    all[FLAG] = flag(surfels.is_billboard(i) || surfels.two_sided.as_ref().is_some_and(|flags| flags[i]));
    all[FIRST_CLIP..FIRST_CLIP + 4].copy_from_slice(&line(clip.lines[0]));
    all[FIRST_CLIP + 4..CONCAVE].copy_from_slice(&line(clip.lines[1]));
    all[CONCAVE] = flag(clip.concave);
    all[WEIGHT] = weights.map_or(0.0, |weights| weights.of[i]);
    all[WEIGHT + 1..].copy_from_slice(&weights.and_then(|weights| weights.corners_of(i)).unwrap_or_default());
    all
}
