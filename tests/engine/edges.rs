//! Edges inside the picture: where a surface ends before another one, pixels show both, each by the part of the pixel that it covers.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::if_whole;
use crate::support::truth::{Truth, eye};
use glam::Vec3;
use std::sync::LazyLock;
use surfel::estimate::Estimate;
use surfel::geometry::{Cloud, Colours, Surfels};
use surfel::settings::methods::{Method, confetti, perspective_ewa};
use surfel::settings::{Alpha, Edges, Shading};
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Picture, Rasterizer, RenderOptions, Settings};

const SIDE: u32 = 512;
/// Colours of the sphere and of the wall behind it.
const RED: [f32; 3] = [1.0, 0.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
/// Most of the error of `nearest` that `mixed` may have at edges.
const MOST_OF_NEAREST: f64 = 0.5;
/// Colours are sums of float32.
const ROUNDING: f32 = 1e-5;

/// The surfels in one colour.
fn painted(surfels: Surfels, colour: [f32; 3]) -> Surfels {
    let colours = vec![colour; surfels.len()];
    Surfels { colours: Some(Colours::Linear(colours)), ..surfels }
}

static SCENE: LazyLock<Surfels> = LazyLock::new(sphere_before_a_wall);

/// A red sphere before a blue wall that fills the picture of [`Truth::camera`].
fn sphere_before_a_wall() -> Surfels {
    let sphere = scenes::open("scene:bumpy-sphere?points=50000&seed=1").unwrap();
    let (sphere, _) = Cloud::from(sphere).into_surfels(&Estimate::default(), &()).unwrap();
    let to_eye = eye().normalize().as_vec3();
    let right = to_eye.cross(Vec3::Y).normalize();
    let (up, half) = (right.cross(to_eye), 100);
    let place = |i: i32, j: i32| -2.5 * to_eye + 0.04 * (i as f32 * right + j as f32 * up);
    let positions: Vec<_> = (-half..=half).flat_map(|i| (-half..=half).map(move |j| place(i, j))).collect();
    let wall = Surfels {
        normals: vec![to_eye; positions.len()],
        radii: vec![0.05; positions.len()],
        positions,
        ..Default::default()
    };
    Surfels::merge(vec![painted(sphere, RED), painted(wall, BLUE)], [0.5; 3]).unwrap()
}

/// How far the red of pixels at edges is from the part that the sphere covers, in sum.
fn error(picture: &Picture, exact: &[f64]) -> f64 {
    let pairs = exact.iter().zip(&picture.colour).filter(|(part, _)| **part > 0.0 && **part < 1.0);
    pairs.map(|(part, colour)| (f64::from(colour[0]) - part).abs()).sum()
}

#[test]
fn pixels_at_edges_show_both_surfaces_by_what_they_cover() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = Truth::new(SIDE);
    let exact = truth.coverage();
    let rasterizers = [Rasterizer::Compute, Rasterizer::Draw];
    for (i, method) in [perspective_ewa::METHOD, confetti::METHOD].into_iter().enumerate() {
        for &rasterizer in &rasterizers[if_whole(0..2, i..i + 1)] {
            let options =
                RenderOptions { size: truth.size(), rasterizer: rasterizer.into(), ..Default::default() };
            let [nearest, mixed] = [Edges::Nearest, Edges::Mixed].map(|edges| {
                let settings = settings(&method, edges);
                render(&device, &*SCENE, &truth.camera(), &settings, options)
            });
            let [of_nearest, of_mixed] = [&nearest, &mixed].map(|picture| error(picture, &exact));
            println!(
                "{} {rasterizer:?}: {of_mixed:.1} px of red mixed, {of_nearest:.1} px by the nearest",
                method.name
            );
            assert!(of_mixed <= MOST_OF_NEAREST * of_nearest, "{of_mixed} of {of_nearest}");
            assert!(of_nearest > 100.0, "the edge is there");
            for (i, colour) in mixed.colour.iter().enumerate() {
                let [red, green, blue, alpha] = *colour;
                assert!(
                    (red + blue - 1.0).abs() < ROUNDING && green == 0.0,
                    "{colour:?}: of one of both, or of both"
                );
                assert_eq!(alpha, nearest.colour[i][3], "α stays");
            }
        }
    }
    assert_silent(&device);
}

fn settings(method: &Method, edges: Edges) -> Settings {
    Settings {
        shading: Shading::Colour,
        alpha: Alpha::Coverage,
        pixel_filter: 0.0,
        edges,
        ..method.settings()
    }
}

/// Depths and normals are those of the nearest surface.
#[test]
fn other_images_are_of_the_nearest_surface() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = Truth::new(128);
    for &rasterizer in &[Rasterizer::Draw, Rasterizer::Compute][..if_whole(2, 1)] {
        let outputs = surfel::settings::Outputs { normal: true, depth: true, id: false };
        let options = RenderOptions {
            size: truth.size(),
            rasterizer: rasterizer.into(),
            outputs,
            ..Default::default()
        };
        let [nearest, mixed] = [Edges::Nearest, Edges::Mixed].map(|edges| {
            let settings = settings(&perspective_ewa::METHOD, edges);
            render(&device, &*SCENE, &truth.camera(), &settings, options)
        });
        assert_ne!(nearest.colour, mixed.colour, "edges are mixed");
        assert!(nearest.depth == mixed.depth && nearest.normal == mixed.normal, "{rasterizer:?}");
    }
    assert_silent(&device);
}
