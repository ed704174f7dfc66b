//! Light: linear Blinn–Phong, and the decoding of colours.

use crate::settings::Lighting;
use glam::DVec3;

/// The shade of a surface of linear colour `albedo`; `normal` and `viewer` (from the surface to the eye) are unit vectors in
/// world space.
pub(super) fn lit(lighting: &Lighting, albedo: DVec3, normal: DVec3, viewer: DVec3) -> DVec3 {
    let [ambient, headlight, specular, shininess] =
        [lighting.ambient, lighting.headlight, lighting.specular, lighting.shininess].map(f64::from);
    // The headlight stands at the eye: light, half-way and view direction are one.
    let facing = normal.dot(viewer).max(0.0);
    let mut light = albedo * (ambient + headlight * facing) + specular * facing.powf(shininess);
    for lamp in &lighting.directional {
        let to_light = DVec3::from_array(lamp.to_light.map(f64::from));
        let lambert = normal.dot(to_light);
        if lambert > 0.0 {
            let half = normal.dot((to_light + viewer).normalize_or_zero()).max(0.0);
            let radiance = DVec3::from_array(lamp.radiance.map(f64::from));
            light += radiance * (albedo * lambert + specular * half.powf(shininess));
        }
    }
    light
}

/// An 8-bit sRGB colour in linear light, by the exact transfer function (IEC 61966-2-1).
pub(super) fn linear(srgb: [u8; 4]) -> DVec3 {
    let decode = |byte: u8| {
        let c = f64::from(byte) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    DVec3::new(decode(srgb[0]), decode(srgb[1]), decode(srgb[2]))
}
