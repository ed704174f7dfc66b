//! The smallest host: renders one disc from arrays and counts its pixels.

use surfel::geometry::{Camera, Surfels};
use surfel::glam::{DVec3, Vec3};
use surfel::vk::{Device, DeviceOptions};
use surfel::{RenderOptions, Renderer, Scene, Settings};

const SIZE: [u32; 2] = [64, 64];

fn main() -> surfel::Result<()> {
    let disc = Surfels {
        positions: vec![Vec3::ZERO],
        normals: vec![Vec3::Z],
        radii: vec![1.0],
        ..Surfels::default()
    };
    let device = Device::open(&DeviceOptions::default())?;
    let scene = Scene::upload(&device, &disc)?;
    let mut renderer = Renderer::new(&device, RenderOptions { size: SIZE, ..RenderOptions::default() })?;
    // The disc, of radius 1, fills the middle half of the picture's height: tan(fov / 2) = 1, at distance 2.
    let camera = Camera::look_at(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 90f64.to_radians(), 1.0, 1e-3)?;
    let (picture, _) = renderer.render_picture(&scene, &camera, &Settings::default())?;
    let covered = picture.colour.iter().filter(|pixel| pixel[3] > 0.5).count();
    // α is coverage, for which a disc counts up to 0.77 of its radius, as discs of a surface overlap: π · (0.77 · 16)² = 477 px.
    if !(445..=510).contains(&covered) {
        return Err(surfel::Error::Usage(format!("a disc of 477 px covers {covered}")));
    }
    println!("a disc of {covered} px on {}", device.description().name);
    Ok(())
}
