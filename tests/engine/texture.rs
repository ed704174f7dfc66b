//! A sphere with a texture against rays through it.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::texture::{exact, textured};
use crate::support::{if_whole, methods};
#[allow(dead_code)] // of what is shared
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use surfel::geometry::{Camera, Colours, Levels, MipMap, Model, Surfels, Texture};
use surfel::settings::methods::{Method, perspective_ewa, pull_push};
use surfel::settings::{Settings, Shading};
use surfel::verify::reference;
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Picture, RenderOptions};

/// Width and height, px.
const SIDE: u32 = 256;
/// Rays along the side of a pixel.
const RAYS: u32 = 6;

fn eye() -> DVec3 {
    3.0 * DVec3::new(0.3, 0.5, 1.0).normalize()
}

fn camera() -> Camera {
    Camera::look_at(eye(), DVec3::ZERO, DVec3::Y, 45f64.to_radians(), 1.0, 0.1).unwrap()
}

/// Where a ray meets the sphere in the texture.
fn meet(at: DVec2) -> Option<DVec2> {
    let forward = -eye().normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let half = 22.5f64.to_radians().tan();
    let [x, y] = (half * (2.0 * at / f64::from(SIDE) - 1.0)).to_array();
    let ray = (forward + x * right + y * forward.cross(right)).normalize();
    let along = -eye().dot(ray);
    let inside = 1.0 - (eye().length_squared() - along * along);
    let p = eye() + (along - inside.max(0.0).sqrt()) * ray;
    (inside > 0.0).then(|| DVec2::new(p.x.atan2(p.z) / TAU, 0.5 + p.y.clamp(-1.0, 1.0).asin() / PI))
}

/// The colour of each pixel whose rays all meet the sphere.
fn truth() -> Vec<Option<DVec3>> {
    let pixel = |i: u32| {
        let corner = DVec2::new((i % SIDE).into(), (i / SIDE).into());
        let ray = |k: u32| {
            let at = DVec2::new((k % RAYS).into(), (k / RAYS).into()) + 0.5;
            meet(corner + at / f64::from(RAYS)).map(|at| DVec3::from_array(exact(at).map(f64::from)))
        };
        (0..RAYS * RAYS).map(ray).sum::<Option<DVec3>>().map(|sum| sum / f64::from(RAYS * RAYS))
    };
    (0..SIDE * SIDE).into_par_iter().map(pixel).collect()
}

/// Root mean square difference of the colours, linear.
fn rmse(truth: &[Option<DVec3>], picture: &Picture) -> f64 {
    let square = |(exact, [r, g, b, _]): (&Option<DVec3>, &[f32; 4])| {
        Some((exact.as_ref()? - DVec3::new((*r).into(), (*g).into(), (*b).into())).length_squared() / 3.0)
    };
    let squares: Vec<f64> = truth.iter().zip(&picture.colour).filter_map(square).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn sphere(points: u32) -> Model {
    textured(scenes::open(&format!("scene:sphere?points={points}&seed=1")).unwrap())
}

/// The same with the texture's exact colour at each point.
fn coloured(model: &Model) -> Surfels {
    let texture = model.surfels.texture.as_ref().unwrap();
    let colours = texture.coordinates.iter().map(|at| exact(at.as_dvec2())).collect();
    Surfels { texture: None, colours: Some(Colours::Linear(colours)), ..model.surfels.clone() }
}

fn settings(method: Method) -> Settings {
    Settings { shading: Shading::Colour, ..method.settings() }
}

#[test]
fn a_texture_is_sharper_than_the_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = truth();
    let options = RenderOptions { size: [SIDE; 2], ..Default::default() };
    let all = [(3_000, 0.4, 0.06), (100_000, 0.6, 0.035), (10_000, 0.4, 0.04)];
    for (points, share, most) in all.into_iter().take(if_whole(3, 2)) {
        let model = sphere(points);
        let settings = settings(pull_push::METHOD);
        let own = reference::render(&model, &camera(), [SIDE; 2], &settings, &()).unwrap().to_picture();
        let gpu = render(&device, &model, &camera(), &settings, options);
        let colours = render(&device, &coloured(&model), &camera(), &settings, options);
        let [own, gpu, colours] = [own, gpu, colours].map(|picture| rmse(&truth, &picture));
        println!(
            "{points} points: RMSE {gpu:.4} with a texture ({own:.4} by the reference), {colours:.4} with a colour a point"
        );
        assert!((own - gpu).abs() < 1e-3, "{points}: {own} {gpu}");
        assert!(gpu < share * colours && gpu < most, "{points}: {gpu} {colours}");
    }
    assert_silent(&device);
}

#[test]
fn every_method_shows_the_texture() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = truth();
    let options = RenderOptions { size: [SIDE; 2], ..Default::default() };
    let model = sphere(100_000);
    // The nearest splat alone is a tile.
    let most = |method: &Method| if method.name == "sprites-unfiltered" { 0.2 } else { 0.12 };
    // Pull–push of as many points is in the test before.
    for method in methods().into_iter().filter(|method| if_whole(true, method.pull_push.is_none())) {
        let settings = Settings { background: None, ..settings(method) };
        let own = reference::render(&model, &camera(), [SIDE; 2], &settings, &()).unwrap().to_picture();
        let gpu = render(&device, &model, &camera(), &settings, options);
        let [own, gpu] = [own, gpu].map(|picture| rmse(&truth, &picture));
        println!("{}: RMSE {gpu:.4}, {own:.4} by the reference", method.name);
        assert!(gpu < most(&method) && (own - gpu).abs() < 1e-3, "{}: {gpu} {own}", method.name);
    }
    assert_silent(&device);
}

#[test]
fn levels_of_detail_show_the_texture() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = truth();
    let options = RenderOptions { size: [SIDE; 2], ..Default::default() };
    let levels = Levels::of(sphere(100_000).surfels).unwrap();
    for method in [perspective_ewa::METHOD, pull_push::METHOD] {
        let settings = Settings { background: None, lod: 6.0, ..settings(method) };
        let own = reference::render(&levels, &camera(), [SIDE; 2], &settings, &()).unwrap();
        assert!(own.counts.other_level > 90_000, "{:?}", own.counts);
        let gpu = render(&device, &levels, &camera(), &settings, options);
        let [own, gpu] = [own.to_picture(), gpu].map(|picture| rmse(&truth, &picture));
        println!("{}: RMSE {gpu:.4}, {own:.4} by the reference", method.name);
        assert!(gpu < 0.12 && (own - gpu).abs() < 1e-3, "{}: {gpu} {own}", method.name);
    }
    assert_silent(&device);
}

/// Of one disc, or of three in a line, as large as you like, the texture's gradient is not known, or known along the line alone: each pixel has
/// the colour that is at the centre of the disc that covers it, or between two of them.
#[test]
fn a_disc_larger_than_the_picture_has_one_colour() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    for (places, radius) in [(vec![0.0], 40.0), (vec![-8.0, 0.0, 8.0], 12.0)] {
        let positions: Vec<Vec3> = places.iter().map(|x| Vec3::new(*x, 0.3 * x, 0.0)).collect();
        let count = positions.len();
        let image = Arc::new(MipMap::new(&crate::support::texture::picture()).unwrap());
        // The middle of a square.
        let coordinates = vec![Vec2::new(0.5 / 32.0, 0.5 / 16.0); count];
        let surfels = Surfels {
            positions,
            normals: vec![Vec3::Z; count],
            radii: vec![radius; count],
            texture: Some(Texture { image, coordinates }),
            ..Default::default()
        };
        let camera = Camera::look_at(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.1).unwrap();
        let options = RenderOptions { size: [512; 2], ..Default::default() };
        let picture = render(&device, &surfels, &camera, &settings(pull_push::METHOD), options);
        let expected = crate::support::texture::COLOURS[0];
        for (i, colour) in picture.colour.iter().enumerate() {
            let near = expected.iter().zip(colour).all(|(a, b)| (a - b).abs() < 1e-3);
            assert!(colour[3] == 1.0 && near, "{count} discs, pixel {i}: {colour:?} {expected:?}");
        }
    }
    assert_silent(&device);
}
