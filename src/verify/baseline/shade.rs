//! Shading, four pixels at a time.

use super::view::View;
use crate::settings::{Lighting, Settings, Shading};
use glam::{BVec4A, Mat3, Vec3, Vec4};

/// A vector for each of four pixels, coordinate by coordinate.
pub(super) type Vectors = [Vec4; 3];

/// The surface at four adjacent pixels of a row.
pub(super) struct Surface {
    /// Which pixels are covered.
    pub covered: BVec4A,
    /// Linear RGB.
    pub colour: Vectors,
    /// Σ w n, or a parallel vector.
    pub normal: Vectors,
    /// Σ w.
    pub weight: Vec4,
    /// Distance.
    pub depth: Vec4,
}

/// Values of four pixels.
pub(super) struct PixelValues {
    /// RGB and α.
    pub colour: [Vec4; 4],
    /// Unit normal.
    pub normal: Vectors,
    /// Distance.
    pub depth: Vec4,
}

/// Shading of a frame.
pub(super) struct Shader<'a> {
    settings: &'a Settings,
    perspective: bool,
    ray: Mat3,
    forward: Vec3,
    /// Whether normals are summed.
    normals: bool,
}

impl<'a> Shader<'a> {
    pub fn new(settings: &'a Settings, view: &View, normals: bool) -> Self {
        let ray = view.ray.as_mat3();
        Self { settings, perspective: view.perspective, ray, forward: view.forward.as_vec3(), normals }
    }

    /// Values of empty pixels.
    pub fn background(&self) -> PixelValues {
        let colour = self.settings.background.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        PixelValues { colour: colour.map(Vec4::splat), normal: [Vec4::ZERO; 3], depth: Vec4::ZERO }
    }

    /// Shades the pixels with centres at `x` and `y`, px.
    #[inline]
    pub fn shade(&self, x: Vec4, y: f32, surface: &Surface) -> PixelValues {
        let empty = self.background();
        if !surface.covered.any() {
            return empty;
        }
        let to_eye = self.to_eye(x, y);
        let normal = if self.normals { unit(surface, to_eye) } else { [Vec4::ZERO; 3] };
        let value = match self.settings.shading {
            Shading::Lit => lit(&self.settings.lighting, surface.colour, normal, to_eye),
            Shading::Colour => surface.colour,
            Shading::Normal => normal,
            Shading::Depth => [surface.depth; 3],
            // Rejected before the frame starts.
            Shading::Overlap | Shading::Weight | Shading::Edl => [Vec4::ONE; 3],
        };
        let [r, g, b] = value;
        let select = |here: Vec4, otherwise: Vec4| Vec4::select(surface.covered, here, otherwise);
        PixelValues {
            colour: [(r, 0), (g, 1), (b, 2), (Vec4::ONE, 3)].map(|(v, i)| select(v, empty.colour[i])),
            normal: normal.map(|v| select(v, Vec4::ZERO)),
            depth: select(surface.depth, Vec4::ZERO),
        }
    }

    /// Unit vectors to the eye.
    #[inline]
    fn to_eye(&self, x: Vec4, y: f32) -> Vectors {
        if !self.perspective {
            return (-self.forward).to_array().map(Vec4::splat);
        }
        let ray = [0, 1, 2].map(|i| x * self.ray.x_axis[i] + (y * self.ray.y_axis[i] + self.ray.z_axis[i]));
        let inverse = -1.0 / dot(ray, ray).sqrt();
        ray.map(|v| v * inverse)
    }
}

/// The unit normal; the direction to the eye where normals cancel.
#[inline]
fn unit(surface: &Surface, to_eye: Vectors) -> Vectors {
    let length = dot(surface.normal, surface.normal).sqrt();
    let cancelled = length.cmplt(1e-6 * surface.weight);
    let inverse = 1.0 / length;
    [0, 1, 2].map(|i| Vec4::select(cancelled, to_eye[i], surface.normal[i] * inverse))
}

/// Linear Blinn–Phong; all vectors are unit vectors.
#[inline]
fn lit(lighting: &Lighting, albedo: Vectors, normal: Vectors, to_eye: Vectors) -> Vectors {
    let power = |v: Vec4| Vec4::from_array(v.to_array().map(|v| v.powf(lighting.shininess)));
    // The headlight is at the eye: light, half-way and view directions coincide.
    let facing = dot(normal, to_eye).max(Vec4::ZERO);
    let highlight = lighting.specular * power(facing);
    let mut light = albedo.map(|a| a * (lighting.ambient + lighting.headlight * facing) + highlight);
    for lamp in &lighting.directional {
        let to_light = lamp.to_light.map(Vec4::splat);
        let lambert = dot(normal, to_light);
        let half = [0, 1, 2].map(|i| to_light[i] + to_eye[i]);
        let length = dot(half, half).sqrt().max(Vec4::splat(f32::MIN_POSITIVE));
        let highlight = lighting.specular * power((dot(normal, half) / length).max(Vec4::ZERO));
        let reached = lambert.cmpgt(Vec4::ZERO);
        for i in 0..3 {
            let added = lamp.radiance[i] * (albedo[i] * lambert + highlight);
            light[i] += Vec4::select(reached, added, Vec4::ZERO);
        }
    }
    light
}

#[inline]
fn dot(a: Vectors, b: Vectors) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
