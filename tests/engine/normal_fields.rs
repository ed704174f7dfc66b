//! Normals that vary over discs are those of the surface, of which discs of one normal make facets.

use crate::support::gpu::{assert_silent, device, new_device, render};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;
use surfel::estimate::Estimate;
use surfel::geometry::{Camera, Cloud, Surfels};
use surfel::settings::Shading;
use surfel::settings::methods::perspective_ewa;
use surfel::settings::splatting::{Filter, Footprint, Shade, Splatting};
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Rasterizer, RenderOptions, Renderer, Scene, Settings};

/// Width and height of the pictures, px.
const SIDE: u32 = 160;
/// Field of view, degrees.
const FOV: f64 = 40.0;
/// Most of the facets' error that fields may have.
const MOST_OF_FACETS: f64 = 0.25;

/// Points of a unit sphere along a spiral; `outwards` is 1 or −1, the side that normals face.
fn sphere(count: u32, outwards: f32) -> Surfels {
    let at = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (flat, angle) = ((1.0 - z * z).sqrt(), f64::from(i) * TAU * 0.618_034);
        DVec3::new(flat * angle.cos(), flat * angle.sin(), z).as_vec3()
    };
    let positions: Vec<Vec3> = (0..count).map(at).collect();
    let normals = Some(positions.iter().map(|position| outwards * *position).collect());
    Cloud { positions, normals, ..Cloud::default() }.into_surfels(&Estimate::default(), &()).unwrap().0
}

/// Root mean square of the angles between the picture's normals and the sphere's, degrees, where rays meet it at less than 60°.
fn error(normals: &[[f32; 3]], [eye, target]: [DVec3; 2]) -> f64 {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let (down, half) = (forward.cross(right), (0.5 * FOV.to_radians()).tan());
    let mut squares = Vec::new();
    for (i, found) in (0u32..).zip(normals) {
        let [x, y] =
            [i % SIDE, i / SIDE].map(|at| half * ((2.0 * f64::from(at) + 1.0) / f64::from(SIDE) - 1.0));
        let ray = (forward + x * right + y * down).normalize();
        let (along, squared) = (eye.dot(ray), eye.length_squared());
        let discriminant = along * along - squared + 1.0;
        // The near side from outside, the far one from inside.
        let root = if squared > 1.0 { -1.0 } else { 1.0 } * discriminant.max(0.0).sqrt();
        let exact = eye + (root - along) * ray;
        if discriminant > 0.0 && exact.dot(ray).abs() > 0.5 {
            let exact = -exact.dot(ray).signum() * exact;
            let angle = DVec3::from_array(found.map(f64::from)).dot(exact).clamp(-1.0, 1.0).acos();
            squares.push(angle.to_degrees().powi(2));
        }
    }
    assert!(squares.len() > 1000, "{} pixels", squares.len());
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[test]
fn large_discs_have_the_normals_of_the_surface() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let outside = [DVec3::new(1.0, 0.6, 3.0), DVec3::ZERO];
    let inside = [DVec3::new(0.1, 0.0, 0.2), DVec3::new(0.3, -0.1, -1.0)];
    for (outwards, [eye, target]) in [(1.0, outside), (-1.0, inside)] {
        let camera = Camera::look_at(eye, target, DVec3::Y, FOV.to_radians(), 1.0, 1e-3).unwrap();
        let surfels = sphere(2000, outwards);
        let cases = [
            (Footprint::Conic, Filter::Screen, Rasterizer::Compute),
            (Footprint::Conic, Filter::Screen, Rasterizer::Draw),
            (Footprint::Disc, Filter::Object, Rasterizer::Compute),
        ];
        let from_inside = outwards < 0.0;
        for (footprint, filter, rasterizer) in cases.into_iter().take(if from_inside { 1 } else { 3 }) {
            let error = |shade| {
                let splatting = Splatting { shade, footprint, filter, ..Splatting::default() };
                let settings =
                    Settings { splatting, shading: Shading::Lit, ..perspective_ewa::METHOD.settings() };
                let outputs = Outputs { normal: true, ..Outputs::default() };
                let size = [SIDE; 2];
                let options =
                    RenderOptions { size, outputs, rasterizer: rasterizer.into(), ..Default::default() };
                error(&render(&device, &surfels, &camera, &settings, options).normal.unwrap(), [eye, target])
            };
            let [facets, field] = [Shade::MeanNormal, Shade::NormalField].map(error);
            println!("{footprint:?} {rasterizer:?}: normals are off by {field:.3}°, of facets {facets:.3}°");
            assert!(field < MOST_OF_FACETS * facets, "{field} {facets}");
        }
    }
    assert_silent(&device);
}

#[test]
fn frames_of_small_discs_have_no_fields() {
    let Some(device) = new_device(DeviceLimits::default()) else { return };
    let camera = Camera::look_at(DVec3::Z * 4.0, DVec3::ZERO, DVec3::Y, FOV.to_radians(), 1.0, 1e-3).unwrap();
    let scene = Scene::upload(&device, &sphere(2000, 1.0)).unwrap();
    let draw = |side: u32, shade| {
        let splatting = Splatting { shade, ..Splatting::default() };
        let settings = Settings { splatting, shading: Shading::Lit, ..perspective_ewa::METHOD.settings() };
        let options = RenderOptions { size: [side; 2], ..Default::default() };
        let mut renderer = Renderer::new(&device, options).unwrap();
        renderer.render_picture(&scene, &camera, &settings).unwrap().0
    };
    for (side, has_fields) in [(16, false), (SIDE, true)] {
        let without = draw(side, Shade::MeanNormal);
        let made = device.usage().pipelines;
        let with = draw(side, Shade::NormalField);
        assert_eq!(device.usage().pipelines > made, has_fields, "pipelines at {side} px");
        assert_eq!(with != without, has_fields, "pictures of {side} px");
    }
    assert_silent(&device);
}
