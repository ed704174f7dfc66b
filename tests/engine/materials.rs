//! Points that shine in their own way: against the closed form, and against the float64 reference.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::if_whole;
use glam::{DVec2, DVec3, Vec3};
use surfel::geometry::{Camera, Colours, Material, Materials, Model, Parts, Surfels};
use surfel::settings::methods::{Method, perspective_ewa, pull_push};
use surfel::settings::{DirectionalLight, Lighting, Settings};
use surfel::verify::scenes;
use surfel::vk::DeviceLimits;
use surfel::{Outputs, Picture, Precision, Rasterizer, RenderOptions, Renderer, Scene};

/// Width and height, px.
const SIDE: u32 = 256;
/// Of a pixel of a half of the sheet.
const ALBEDO: [f32; 3] = [0.3, 0.2, 0.1];
/// From point to point of the sheet.
const STEP: f32 = 1.0 / 64.0;

fn table() -> [Material; 2] {
    [
        Material { specular: [0.9, 0.7, 0.2], shininess: 60.0 },
        Material { specular: [0.1, 0.1, 0.4], shininess: 5.0 },
    ]
}

fn lighting() -> Lighting {
    let to_light = Vec3::new(0.3, 0.4, 1.0).normalize().to_array();
    let lamp = DirectionalLight { to_light, radiance: [0.5, 0.6, 0.7] };
    Lighting { directional: vec![lamp], ..Default::default() }
}

/// A sheet across z = 0 that fills the picture: in the left part of one material, in the right of another, and in a band on top of none.
fn sheet() -> Surfels {
    let side = 160;
    let place = |i: usize| STEP * (i as f32 - side as f32 / 2.0 + 0.5);
    let positions: Vec<Vec3> =
        (0..side * side).map(|i| Vec3::new(place(i % side), place(i / side), 0.0)).collect();
    let of = positions.iter().map(|p| if p.y > 0.5 { Materials::NONE } else { u16::from(p.x > 0.0) });
    Surfels {
        materials: Some(Materials { table: table().into(), of: of.collect() }),
        colours: Some(Colours::Linear(vec![ALBEDO; positions.len()])),
        normals: vec![Vec3::Z; positions.len()],
        radii: vec![1.5 * STEP; positions.len()],
        positions,
        ..Default::default()
    }
}

fn camera() -> Camera {
    Camera::look_at(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, DVec3::Y, 0.9, 1.0, 0.1).unwrap()
}

/// Where the ray of a pixel meets the sheet.
fn place(pixel: u32) -> DVec2 {
    let at = DVec2::new((pixel % SIDE).into(), (pixel / SIDE).into()) + 0.5;
    let half = 2.0 * 0.45f64.tan();
    half * (2.0 * at / f64::from(SIDE) - 1.0) * DVec2::new(1.0, -1.0)
}

/// Blinn–Phong at a place of the sheet, written out.
fn light(at: DVec2, material: Option<Material>) -> DVec3 {
    let lighting = lighting();
    let (specular, shininess) = match material {
        Some(material) => (DVec3::from_array(material.specular.map(f64::from)), material.shininess),
        None => (DVec3::splat(lighting.specular.into()), lighting.shininess),
    };
    let albedo = DVec3::from_array(ALBEDO.map(f64::from));
    let view = (DVec3::new(0.0, 0.0, 2.0) - at.extend(0.0)).normalize();
    let lamp = lighting.directional[0];
    let [to_light, radiance] = [lamp.to_light, lamp.radiance].map(|v| DVec3::from_array(v.map(f64::from)));
    let shine = |cosine: f64| specular * cosine.powf(shininess.into());
    f64::from(lighting.ambient) * albedo
        + f64::from(lighting.headlight) * view.z * albedo
        + shine(view.z)
        + radiance * (albedo * to_light.z + shine((to_light + view).normalize().z))
}

fn settings(method: Method) -> Settings {
    Settings { lighting: lighting(), ..method.settings() }
}

fn differ(a: DVec3, [r, g, b, _]: [f32; 4]) -> f64 {
    (a - DVec3::new(r.into(), g.into(), b.into())).abs().max_element()
}

#[test]
fn a_sheet_of_two_materials_has_the_closed_form() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let sheet = sheet();
    let [left, right] = table().map(Some);
    let all = [
        (pull_push::METHOD, Precision::Full, 2e-5),
        // Colours keep 9 bits and a common exponent, directions 16.
        (pull_push::METHOD, Precision::Half, 2e-3),
        (pull_push::PAPER, Precision::Full, 2e-5),
    ];
    for (method, precision, most) in all.into_iter().take(if_whole(3, 2)) {
        let options = RenderOptions { size: [SIDE; 2], precision, ..Default::default() };
        let picture = render(&device, &sheet, &camera(), &settings(method), options);
        let (mut seen, mut border) = ([0; 3], 0);
        for (i, colour) in picture.colour.iter().enumerate() {
            let at = place(i as u32);
            let all = [None, left, right].map(|material| differ(light(at, material), *colour));
            // A pixel takes the number of a point no further than two radii.
            let near = |distance: f64| distance.abs() < 3.0 * f64::from(STEP);
            if near(at.y - 0.5) || at.y < 0.5 && near(at.x) {
                border += 1;
                assert!(all.iter().any(|error| *error <= most), "{} {at}: {all:?}", method.name);
                continue;
            }
            let own = if at.y > 0.5 { 0 } else { 1 + usize::from(at.x > 0.0) };
            seen[own] += 1;
            assert!(all[own] <= most, "{} {precision:?} {at}: {all:?}", method.name);
        }
        assert!(seen.iter().all(|count| *count > 10_000) && border < 6_000, "{seen:?} {border}");
    }
    assert_silent(&device);
}

#[test]
fn the_rasterizers_shine_alike_and_splats_as_the_frame_says() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let sheet = sheet();
    let plain = Surfels { materials: None, ..sheet.clone() };
    let picture = |surfels: &Surfels, method, rasterizer: Rasterizer| {
        let options = RenderOptions { size: [SIDE; 2], rasterizer: rasterizer.into(), ..Default::default() };
        render(&device, surfels, &camera(), &settings(method), options)
    };
    let [drawn, computed] =
        [Rasterizer::Draw, Rasterizer::Compute].map(|by| picture(&sheet, pull_push::METHOD, by));
    assert!(drawn.colour == computed.colour);
    let [with, without] = [&sheet, &plain].map(|s| picture(s, perspective_ewa::METHOD, Rasterizer::Draw));
    assert!(with.colour == without.colour);
    assert_silent(&device);
}

/// Every so many points of the model have the next of three materials, or none.
fn motley(mut model: Model) -> Model {
    let table: Vec<Material> =
        (0..3u8).map(|i| Material { specular: [0.2 * f32::from(i), 0.3, 0.1], shininess: 9.0 }).collect();
    let materials = |count: usize| {
        let of = (0..count).map(|i| [0, 1, 2, Materials::NONE][i / 7 % 4]).collect();
        Some(Materials { table: table.clone().into(), of })
    };
    model.surfels.materials = materials(model.surfels.len());
    model.primitives.materials = materials(model.primitives.len());
    model
}

/// Pixels that differ in what is there, or by more than 10⁻³ in colour.
fn differences(a: &Picture, b: &Picture) -> usize {
    let near = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-3);
    a.colour.iter().zip(&b.colour).filter(|pair| !near(*pair)).count()
}

#[test]
fn lines_polygons_and_points_shine_as_the_reference_says() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let names =
        ["scene:mixed?primitives=on&segments=50&points=20000", "scene:tree?primitives=on&segments=12"];
    for name in &names[..if_whole(2, 1)] {
        let plain = scenes::model(name).unwrap();
        let model = motley(plain.clone());
        let camera =
            scenes::camera(name).unwrap().camera(1.0, &Parts::from(&model).bounds().unwrap()).unwrap();
        let settings = Settings { lighting: lighting(), ..pull_push::METHOD.settings() };
        let options = RenderOptions {
            size: [SIDE; 2],
            outputs: Outputs { id: true, ..Default::default() },
            ..Default::default()
        };
        let found = render(&device, &model, &camera, &settings, options);
        let reference = |model: &Model| {
            surfel::verify::reference::render(model, &camera, [SIDE; 2], &settings, &()).unwrap().to_picture()
        };
        let (reference, without) = (reference(&model), reference(&plain));
        let object = reference.colour.iter().filter(|colour| colour[3] > 0.0).count();
        let [other, changed] = [differences(&found, &reference), differences(&reference, &without)];
        println!("{name}: {other} of {object} differ; materials change {changed}");
        assert!(200 * other <= object && 4 * changed > object, "{name}: {other} {changed} of {object}");
    }
    assert_silent(&device);
}

/// Segments and triangles keep their numbers, and with these their materials, however many surfels are drawn before them.
#[test]
fn fewer_surfels_leave_the_others_their_materials() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let name = "scene:mixed?primitives=on&segments=50&points=20000";
    let model = motley(scenes::model(name).unwrap());
    let camera = scenes::camera(name).unwrap().camera(1.0, &Parts::from(&model).bounds().unwrap()).unwrap();
    let settings = Settings { lighting: lighting(), ..pull_push::METHOD.settings() };
    let count = 7_001;
    let mut fewer = model.clone();
    let Surfels { positions, normals, radii, colours, materials, .. } = &mut fewer.surfels;
    positions.truncate(count);
    normals.truncate(count);
    radii.truncate(count);
    match colours {
        Some(Colours::Srgb8(codes)) => codes.truncate(count),
        Some(Colours::Linear(linear)) => linear.truncate(count),
        None => {}
    }
    materials.as_mut().unwrap().of.truncate(count);
    for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][..if_whole(2, 1)] {
        let options = RenderOptions { size: [SIDE; 2], rasterizer: rasterizer.into(), ..Default::default() };
        let scene = Scene::upload(&device, &model).unwrap();
        scene.set_count(count as u64).unwrap();
        let mut renderer = Renderer::new(&device, options).unwrap();
        let (found, _) = renderer.render_picture(&scene, &camera, &settings).unwrap();
        assert!(
            found.colour == render(&device, &fewer, &camera, &settings, options).colour,
            "{rasterizer:?}"
        );
    }
    assert_silent(&device);
}
