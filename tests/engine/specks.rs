//! Specks of the default picture: pixels whose normal is another surface's, and pixels brighter than all around them.

use crate::support::{gpu, if_whole, skipping};
use glam::{DVec3, Vec3};
use std::path::Path;
use std::sync::Arc;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Extent, Pose, Span};
use surfel::load::{LoadOptions, load};
use surfel::settings::Outputs;
use surfel::verify::truth::{self, Filter, Options};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Picture, RenderOptions, Settings};

const SIDE: usize = 512;
/// Rays a pixel along each axis.
const RAYS: usize = 4;
/// Cosine of the angle beyond which a normal is another surface's: 60°.
const OTHER: f32 = 0.5;
/// How much brighter a speck is than all its neighbours, linear light.
const BRIGHTER: f32 = 0.2;

/// Specks of a picture.
#[derive(Debug)]
struct Specks {
    /// Part of the surface's px whose normals are more than 60° off those of all rays of the pixel.
    normals: f64,
    /// Px inside the surface that are brighter than all their neighbours.
    bright: usize,
}

/// Compares a picture with one ray for each of 4 × 4 parts of its pixels.
fn specks(picture: &Picture, rays: &Picture) -> Specks {
    let [ours, exact] = [picture, rays].map(|picture| picture.normal.as_ref().unwrap());
    let of_pixel = |i: usize| {
        let first = i / SIDE * RAYS * SIDE * RAYS + i % SIDE * RAYS;
        (0..RAYS * RAYS).map(move |k| first + k / RAYS * SIDE * RAYS + k % RAYS)
    };
    let hits = |i: usize| of_pixel(i).filter(|&ray| rays.colour[ray][3] > 0.0).count();
    let is_covered = |i: usize| picture.colour[i][3] > 0.5 && 2 * hits(i) > RAYS * RAYS;
    let both: Vec<usize> = (0..SIDE * SIDE).filter(|&i| is_covered(i)).collect();
    let is_off = |&&i: &&usize| {
        let ours = Vec3::from_array(ours[i]);
        of_pixel(i).all(|ray| ours.dot(Vec3::from_array(exact[ray])) < OTHER)
    };
    let around = |i: usize| {
        let rows = [i - SIDE, i, i + SIDE];
        rows.into_iter().flat_map(|i| [i - 1, i, i + 1]).filter(move |&j| j != i)
    };
    let inner = SIDE + 1..SIDE * (SIDE - 1) - 1;
    let light = |i: usize| picture.colour[i][1];
    let is_bright = |&&i: &&usize| {
        inner.contains(&i) && around(i).all(|j| hits(j) == RAYS * RAYS && light(i) > light(j) + BRIGHTER)
    };
    Specks {
        normals: both.iter().filter(is_off).count() as f64 / both.len() as f64,
        bright: both.iter().filter(is_bright).count(),
    }
}

/// Specks of the points of a file.
fn check(device: &Arc<Device>, points: &Path, subject: &Subject, camera: &Camera) -> Specks {
    let settings = Settings::default();
    let options = Options { filter: Filter::Point, ..Default::default() };
    let size = [SIDE as u32; 2];
    let surface = subject.surface().expect("a mesh");
    let rays = truth::render(surface, camera, &settings, size.map(|side| side * RAYS as u32), &options, &());
    let outputs = Outputs { normal: true, ..Default::default() };
    let options = RenderOptions { size, outputs, ..Default::default() };
    let model = load(&[points], &LoadOptions::default(), &()).unwrap().model;
    specks(&gpu::render(device, &model, camera, &settings, options), &rays.unwrap().picture)
}

/// The first camera of a model in `tests/cameras.json`.
fn first_camera(name: &str, subject: &Subject) -> Camera {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cameras.json");
    let all: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let model = all["models"].as_array().unwrap().iter().find(|model| model["name"] == name).unwrap();
    let camera = &model["cameras"][0];
    let vector = |key: &str| {
        let components: Vec<f64> =
            camera[key].as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
        DVec3::from_slice(&components)
    };
    let span = Span::Angle(camera["fov_y_deg"].as_f64().unwrap());
    let [eye, target, up] = ["eye", "target", "up"].map(vector);
    Pose { eye, target, up, span }.camera(&subject.bounds(), 1.0).unwrap()
}

#[test]
fn closed_scans_have_no_specks() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let models = [
        ("bun_zipper", "stanford/bunny/bun_zipper.ply", "stanford/bunny/bun_zipper.ply", 0.0001),
        ("igea", "classic/igea.ply", "classic/igea.ply", 0.0001),
        (
            "dragon_vrip_res2",
            "stanford/dragon/dragon_vrip_res2.ply",
            "stanford/dragon/dragon_vrip.ply",
            0.0006,
        ),
        ("buddha_50k", "stanford/buddha/buddha_50k.ply", "stanford/buddha/buddha_50k.ply", 0.001),
    ];
    let mut failed = Vec::new();
    for (name, points, surface, most) in &models[..if_whole(models.len(), 1)] {
        let [Some(points), Some(surface)] = [points, surface].map(|path| skipping::data(path)) else {
            continue;
        };
        let subject = Subject::scan(&points, Some(&surface), &()).unwrap();
        let found = check(&device, &points, &subject, &first_camera(name, &subject));
        println!("{name}: {found:?}");
        if found.normals > *most || found.bright > 0 {
            failed.push(format!("{name}: {found:?}"));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    gpu::assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn open_scans_have_no_specks_from_either_side() {
    let Some(device) = gpu::device(DeviceLimits::default()) else { return };
    let names = ["bun000", "bun045", "bun090", "bun180", "bun270", "bun315", "chin", "top2"];
    let mut failed = Vec::new();
    for name in &names {
        let Some(path) = skipping::data(&format!("stanford/bunny/range/{name}.ply")) else { continue };
        let subject = Subject::scan(&path, None, &()).unwrap();
        let extent = Extent::from(&subject.bounds());
        // The scanner looked along −z.
        for side in [1.0, -1.0] {
            let middle = extent.centre();
            let eye = middle + 2.6 * extent.bounds().radius * DVec3::new(0.1, 0.1, side).normalize();
            let pose = Pose { eye, target: middle, up: DVec3::Y, span: Span::Angle(45.0) };
            let found = check(&device, &path, &subject, &pose.camera(&subject.bounds(), 1.0).unwrap());
            println!("{name}, side {side}: {found:?}");
            if found.normals > 0.0005 || found.bright > 0 {
                failed.push(format!("{name}, side {side}: {found:?}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    gpu::assert_silent(&device);
}
