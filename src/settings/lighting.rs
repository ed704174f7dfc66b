//! Lights and the material of surfaces.

use crate::error::{Error, Result};

/// Lights and material, all linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Colour of surfaces without colours.
    pub albedo: [f32; 3],
    /// Ambient light, as a factor of the albedo.
    pub ambient: f32,
    /// Lambertian factor of the headlight, which is at the eye.
    pub headlight: f32,
    /// Blinn–Phong's specular factor, the same for all lights.
    pub specular: f32,
    /// Blinn–Phong's exponent.
    pub shininess: f32,
    /// Further lights, at most [`Lighting::MAX_DIRECTIONAL`].
    pub directional: Vec<DirectionalLight>,
}

/// A light at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Unit vector from the surface to the light, world space.
    pub to_light: [f32; 3],
    /// Linear RGB radiance.
    pub radiance: [f32; 3],
}

impl Lighting {
    /// Maximum number of directional lights beside the headlight.
    pub const MAX_DIRECTIONAL: usize = 4;

    /// Validates the lights and the material.
    pub(super) fn check(&self) -> Result<()> {
        let lights = self.directional.len();
        if lights > Self::MAX_DIRECTIONAL {
            let most = Self::MAX_DIRECTIONAL;
            return Err(Error::Usage(format!("{lights} directional lights: give at most {most}")));
        }
        let factors = [self.ambient, self.headlight, self.specular, self.shininess];
        let directions = self.directional.iter().flat_map(|light| [light.to_light, light.radiance]).flatten();
        match self.albedo.into_iter().chain(factors).chain(directions).find(|number| !number.is_finite()) {
            Some(number) => Err(Error::Usage(format!(
                "a number of the lights or the material is {number}: give finite ones"
            ))),
            // The power of 0 that a highlight is at most of its surroundings would not be a number.
            None if self.shininess <= 0.0 => Err(Error::Usage(format!(
                "the exponent of the highlights is {}: give a number above 0",
                self.shininess
            ))),
            None => Ok(()),
        }
    }
}

impl Default for Lighting {
    fn default() -> Self {
        Self {
            albedo: [0.6; 3],
            ambient: 0.08,
            headlight: 0.87,
            specular: 0.06,
            shininess: 40.0,
            directional: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every lit picture and every stored measurement depends on these.
    #[test]
    fn the_default_light_and_material() {
        let Lighting { albedo, ambient, headlight, specular, shininess, directional } = Lighting::default();
        assert_eq!((albedo, ambient, headlight), ([0.6; 3], 0.08, 0.87));
        assert_eq!((specular, shininess, directional), (0.06, 40.0, Vec::new()));
    }

    #[test]
    fn lights_are_few_finite_and_have_highlights_with_a_size() {
        let refusal = |change: fn(&mut Lighting)| {
            let mut lighting = Lighting::default();
            change(&mut lighting);
            lighting.check().err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert_eq!(refusal(|_| {}), "");
        assert_eq!(refusal(|lighting| lighting.specular = 0.0), "");
        const LIGHT: DirectionalLight = DirectionalLight { to_light: [0.0, 0.0, 1.0], radiance: [1.0; 3] };
        assert!(refusal(|lighting| lighting.directional = vec![LIGHT; 5]).contains("5 directional lights"));
        assert!(refusal(|lighting| lighting.ambient = f32::NAN).contains("give finite ones"));
        assert!(refusal(|lighting| lighting.shininess = 0.0).contains("give a number above 0"));
        assert!(refusal(|lighting| lighting.shininess = -3.0).contains("give a number above 0"));
    }
}
