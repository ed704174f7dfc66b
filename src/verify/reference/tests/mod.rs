//! Passes against closed forms.

mod coverage;
mod error_bounds;
mod footprint;
mod kinds;
mod passes;

use super::*;
use crate::geometry::{Clip, ClipLine, Clips, Colours, Curvature, Ellipse, Surfels};
use crate::settings::{Alpha, Cull, Edges, Shading, Widen};
use glam::{DMat2, DVec2, DVec3, DVec4};

const SIZE: [u32; 2] = [64, 64];

/// Looks along +z from the origin; one unit at distance 1 is 64 px.
fn perspective() -> Camera {
    let fov = 2.0 * 0.5f64.atan();
    Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, fov, 1.0, 0.01).unwrap()
}

/// Parallel projection in the same direction; one unit is 16 px.
fn parallel() -> Camera {
    Camera::orthographic([DVec3::ZERO, DVec3::Z, DVec3::NEG_Y], 4.0, 1.0, [0.1, 100.0]).unwrap()
}

/// Splats alone: a σ is half a radius, every splat is drawn and widened, and α is a mask.
fn plain() -> Settings {
    Settings {
        shading: Shading::Colour,
        cutoff: 2.0,
        pixel_filter: 0.0,
        widen: Widen::All,
        cull: Cull::None,
        alpha: Alpha::Mask,
        ..Default::default()
    }
}

fn disc(position: DVec3, normal: DVec3, radius: f64) -> Surfel {
    let normal = normal.normalize();
    let major = normal.any_orthonormal_vector();
    let weights = [1.0; 4];
    Surfel {
        billboard: false,
        position,
        normal,
        radius,
        major,
        aspect: 1.0,
        two_sided: false,
        weights,
        colour: None,
        curvature: Curvature::default(),
        clip: None,
    }
}

fn scene(discs: &[Surfel]) -> Surfels {
    Surfels {
        positions: discs.iter().map(|d| d.position.as_vec3()).collect(),
        normals: discs.iter().map(|d| d.normal.as_vec3()).collect(),
        radii: discs.iter().map(|d| d.radius as f32).collect(),
        ellipses: discs.iter().any(|d| d.aspect < 1.0).then(|| {
            let shape = |d: &Surfel| Ellipse { major: d.major.as_vec3(), aspect: d.aspect as f32 };
            discs.iter().map(shape).collect()
        }),
        two_sided: Some(discs.iter().map(|d| d.two_sided).collect()),
        colours: discs[0].colour.map(|_| {
            Colours::Linear(discs.iter().map(|d| d.colour.unwrap_or_default().as_vec3().to_array()).collect())
        }),
        ..Default::default()
    }
}

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / 2f64.powi(52) - 1.0
}

fn random_vector(state: &mut u64) -> DVec3 {
    DVec3::new(random(state), random(state), random(state))
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}
