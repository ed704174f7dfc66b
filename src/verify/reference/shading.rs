//! Linear Blinn–Phong lighting, and decoding of sRGB colours.

use crate::geometry::Material;
use crate::settings::Lighting;
use glam::DVec3;

/// Specular reflection of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shine {
    specular: DVec3,
    shininess: f64,
}

impl Shine {
    /// Reflection of surfaces without a material: that of the frame's lighting.
    pub fn of_frame(lighting: &Lighting) -> Self {
        Self { specular: DVec3::splat(lighting.specular.into()), shininess: lighting.shininess.into() }
    }
}

impl From<Material> for Shine {
    fn from(material: Material) -> Self {
        Self {
            specular: DVec3::from_array(material.specular.map(f64::from)),
            shininess: material.shininess.into(),
        }
    }
}

/// Shades a surface of linear colour `albedo`. `normal` and `viewer`, from the surface to the eye, are unit vectors in
/// world space.
pub(crate) fn lit(lighting: &Lighting, shine: Shine, albedo: DVec3, normal: DVec3, viewer: DVec3) -> DVec3 {
    lit_by_mean(lighting, shine, albedo, normal, normal, viewer)
}

/// As [`lit`], with diffuse light by `mean`, a mean of unit normals, and highlights by its direction `normal`.
pub(crate) fn lit_by_mean(
    lighting: &Lighting,
    shine: Shine,
    albedo: DVec3,
    normal: DVec3,
    mean: DVec3,
    viewer: DVec3,
) -> DVec3 {
    by_cosines(lighting, shine, albedo, viewer, |towards| mean.dot(towards), |towards| normal.dot(towards))
}

/// Shades a line with unit `tangent`. For each light it takes the normal across the line that gives the brightest
/// shade, for highlights too (marroquim2008 section 4.2).
pub(crate) fn lit_line(
    lighting: &Lighting,
    shine: Shine,
    albedo: DVec3,
    tangent: DVec3,
    viewer: DVec3,
) -> DVec3 {
    let cosine = |towards: DVec3| line_normal(tangent, towards).dot(towards);
    by_cosines(lighting, shine, albedo, viewer, cosine, cosine)
}

/// The normal across a line that is closest to the direction `towards`; both arguments are unit vectors.
pub(crate) fn line_normal(tangent: DVec3, towards: DVec3) -> DVec3 {
    (towards - towards.dot(tangent) * tangent).try_normalize().unwrap_or(towards)
}

/// Blinn–Phong, given the cosine of the angle between the surface's normal and a direction: `lambert` for diffuse light, `cosine` for
/// highlights.
fn by_cosines(
    lighting: &Lighting,
    Shine { specular, shininess }: Shine,
    albedo: DVec3,
    viewer: DVec3,
    lambert: impl Fn(DVec3) -> f64,
    cosine: impl Fn(DVec3) -> f64,
) -> DVec3 {
    let [ambient, headlight] = [lighting.ambient, lighting.headlight].map(f64::from);
    // The headlight is at the eye: light, half-way and view directions coincide.
    let facing = cosine(viewer).max(0.0);
    let mut light =
        albedo * (ambient + headlight * lambert(viewer).max(0.0)) + specular * facing.powf(shininess);
    for lamp in &lighting.directional {
        let to_light = DVec3::from_array(lamp.to_light.map(f64::from));
        let diffuse = lambert(to_light);
        if diffuse > 0.0 {
            let half = cosine((to_light + viewer).normalize_or_zero()).max(0.0);
            let radiance = DVec3::from_array(lamp.radiance.map(f64::from));
            light += radiance * (albedo * diffuse + specular * half.powf(shininess));
        }
    }
    light
}

/// Decodes an 8-bit sRGB colour to linear light by the exact transfer function (IEC 61966-2-1).
pub(crate) fn linear(srgb: [u8; 4]) -> DVec3 {
    let decode = |byte: u8| {
        let c = f64::from(byte) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    DVec3::new(decode(srgb[0]), decode(srgb[1]), decode(srgb[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::DirectionalLight;

    #[test]
    fn light_on_a_sphere_has_the_closed_form() {
        let mut lighting =
            Lighting { ambient: 0.1, headlight: 0.8, specular: 0.2, shininess: 2.0, ..Default::default() };
        let shade = |lighting: &Lighting, degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            lit(lighting, Shine::of_frame(lighting), DVec3::splat(0.5), DVec3::new(sin, 0.0, cos), DVec3::Z)
        };
        let near = |a: DVec3, b: [f64; 3]| a.abs_diff_eq(DVec3::from_array(b), 1e-7);
        assert!(near(shade(&lighting, 0.0), [0.65; 3]));
        assert!(near(shade(&lighting, 60.0), [0.3; 3]));
        assert!(near(shade(&lighting, 120.0), [0.05; 3]), "no light from behind");

        // Light from the side; half-way vector at 45°, so n·l = sin 60° and n·h = cos 15°.
        lighting.directional =
            vec![DirectionalLight { to_light: [1.0, 0.0, 0.0], radiance: [1.0, 0.5, 0.0] }];
        let (lambert, specular) = (0.75f64.sqrt(), 0.2 * 15f64.to_radians().cos().powi(2));
        let side = 0.5 * lambert + specular;
        assert!(near(shade(&lighting, 60.0), [0.3 + side, 0.3 + 0.5 * side, 0.3]));
        assert!(near(shade(&lighting, -60.0), [0.3; 3]), "the light is below the horizon");
    }

    /// Two normals at ±60° to the eye: their mean points to the eye and has length ½.
    #[test]
    fn diffuse_light_of_a_mean_normal_is_the_mean_of_the_light() {
        let lighting = Lighting { specular: 0.2, shininess: 2.0, ..Default::default() };
        let (shine, albedo) = (Shine::of_frame(&lighting), DVec3::splat(0.5));
        let normals = [1.0, -1.0].map(|side| DVec3::new(side * 0.75f64.sqrt(), 0.0, 0.5));
        let mean = 0.5 * (normals[0] + normals[1]);
        let by_mean = lit_by_mean(&lighting, shine, albedo, mean.normalize(), mean, DVec3::Z);
        let dull = Lighting { specular: 0.0, ..lighting.clone() };
        let of_each = normals.map(|n| lit(&dull, Shine::of_frame(&dull), albedo, n, DVec3::Z));
        let highlight = DVec3::splat(0.2);
        assert!(by_mean.abs_diff_eq(0.5 * (of_each[0] + of_each[1]) + highlight, 1e-7), "{by_mean}");
    }

    #[test]
    fn srgb_is_decoded_exactly() {
        let decoded = linear([0, 10, 188, 255]);
        assert!(decoded.abs_diff_eq(DVec3::new(0.0, 10.0 / 255.0 / 12.92, 0.502_886_458), 1e-8), "{decoded}");
        assert_eq!(linear([255; 4]), DVec3::ONE);
    }
}
