//! What a host may hand over by mistake: scenes, settings, cameras, places, sizes and updates that make no sense. Each is refused in words, or
//! drawn without what cannot be drawn; nothing panics, no picture holds what is no number, and the validation layers are silent.

use crate::support::gpu::{assert_silent, device};
use crate::support::{if_whole, methods};
use glam::{DMat4, DVec3, DVec4, Vec3};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use surfel::geometry::{Bounds, Camera, Colours, Ellipse, Model, Primitives, Surfels};
use surfel::scene::Changes;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Kernel, Normalization};
use surfel::settings::{Cull, DirectionalLight, Shading};
use surfel::verify::scenes;
use surfel::vk::{Device, DeviceLimits};
use surfel::{
    Error, Instance, Outputs, Picture, Precision, Rasterizer, RenderOptions, Renderer, Result, Scene,
    Settings,
};

const SIZE: [u32; 2] = [96, 64];
const BOTH: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];

fn options(rasterizer: Rasterizer) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() }
}

fn camera() -> Camera {
    Camera::look_at(DVec3::new(2.0, 1.6, 3.2), DVec3::ZERO, DVec3::Y, 0.8, 1.5, 1e-3).unwrap()
}

fn sphere() -> Surfels {
    scenes::open("scene:bumpy-sphere?points=600").unwrap()
}

/// What came of an attack.
#[derive(Debug, PartialEq)]
enum Outcome {
    Refused,
    Drawn { covered: usize },
}

/// Makes an attack, and fails if it panics, is refused without words or by the driver, or draws what is no number.
fn meet(name: &str, attack: impl FnOnce() -> Result<Picture>) -> Outcome {
    let made = catch_unwind(AssertUnwindSafe(attack)).unwrap_or_else(|_| panic!("{name}: it panics"));
    match made {
        Err(Error::Vulkan { call, result }) => panic!("{name}: {call} says {result:?}: refuse it before"),
        Err(error) => {
            let text = error.to_string();
            assert!(text.len() > 10 && !text.contains('\n'), "{name}: {text}");
            println!("{name}: refused: {text}");
            Outcome::Refused
        }
        Ok(picture) => {
            let colours = picture.colour.iter().flatten();
            let others = picture.normal.iter().flatten().flatten().chain(picture.depth.iter().flatten());
            let wrong = colours.chain(others).filter(|value| !value.is_finite()).count();
            assert_eq!(wrong, 0, "{name}: numbers that are none");
            let covered = picture.colour.iter().filter(|colour| colour[3] > 0.0).count();
            println!("{name}: drawn, {covered} px covered");
            Outcome::Drawn { covered }
        }
    }
}

fn draw(
    device: &Arc<Device>,
    surfels: &Surfels,
    settings: &Settings,
    rasterizer: Rasterizer,
) -> Result<Picture> {
    let scene = Scene::upload(device, surfels)?;
    Ok(Renderer::new(device, options(rasterizer))?.render_picture(&scene, &camera(), settings)?.0)
}

#[test]
fn surfels_that_are_none() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    type Attack = (&'static str, fn(&mut Surfels));
    let refused: [Attack; 10] = [
        ("a normal too few", |s| s.normals.truncate(599)),
        ("a radius too many", |s| s.radii.push(1.0)),
        ("ellipses of half of them", |s| s.ellipses = Some(vec![Ellipse::circle(Vec3::Z); 300])),
        ("two sides of one", |s| s.two_sided = Some(vec![true])),
        ("colours of one", |s| s.colours = Some(Colours::Srgb8(vec![[0; 4]]))),
        ("linear colours of too many", |s| s.colours = Some(Colours::Linear(vec![[0.5; 3]; 601]))),
        ("an origin that is no number", |s| s.origin.y = f64::NAN),
        ("an origin at infinity", |s| s.origin.x = f64::INFINITY),
        ("an origin without positions", |s| s.positions.clear()),
        ("nothing but normals", |s| {
            *s = Surfels { normals: s.normals.clone(), ..Default::default() };
        }),
    ];
    for (name, attack) in refused {
        let mut surfels = sphere();
        attack(&mut surfels);
        let outcome = meet(name, || draw(&device, &surfels, &Settings::default(), Rasterizer::Draw));
        assert_eq!(outcome, Outcome::Refused, "{name}");
    }
    // With the least that is seen of the rest, px.
    type Survivor = (&'static str, usize, fn(&mut Surfels));
    let drawn: [Survivor; 14] = [
        ("none", 0, |s| *s = Surfels::default()),
        ("one", 1000, |s| {
            *s = Surfels {
                positions: vec![s.positions[0]],
                normals: vec![Vec3::Z],
                radii: vec![2.0],
                ..Default::default()
            };
        }),
        ("positions that are no numbers", 0, |s| s.positions.fill(Vec3::NAN)),
        ("every third at infinity", 1000, |s| {
            s.positions.iter_mut().step_by(3).for_each(|p| p.z = f32::INFINITY)
        }),
        ("positions at the end of floats", 1000, |s| {
            s.positions.iter_mut().step_by(2).for_each(|p| *p *= 1e38)
        }),
        ("all points coincide", 1, |s| s.positions.fill(Vec3::ONE)),
        ("normals of length 0", 1000, |s| s.normals.fill(Vec3::ZERO)),
        ("normals of length 1000", 1000, |s| s.normals.iter_mut().step_by(2).for_each(|n| *n *= 1e3)),
        ("radii below 0", 0, |s| s.radii.fill(-1.0)),
        ("radii of 1e30", 1000, |s| s.radii.iter_mut().step_by(5).for_each(|r| *r = 1e30)),
        ("radii of 1e-30", 0, |s| s.radii.fill(1e-30)),
        ("radii that are denormal", 0, |s| s.radii.fill(1e-44)),
        ("ellipses without a width", 0, |s| {
            let flat = |normal: &Vec3| Ellipse { aspect: 0.0, ..Ellipse::circle(*normal) };
            s.ellipses = Some(s.normals.iter().map(flat).collect());
        }),
        ("colours beyond all light", 1000, |s| {
            let mut colours = vec![[0.5f32; 3]; s.len()];
            (colours[0], colours[1], colours[2]) = ([f32::NAN; 3], [f32::INFINITY; 3], [-1e38; 3]);
            s.colours = Some(Colours::Linear(colours));
        }),
    ];
    for rasterizer in BOTH {
        // One for all, so that pipelines are made once.
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        // The short run has each method by one of them.
        let of_both = methods().into_iter().enumerate();
        let some = of_both.filter(|(i, _)| if_whole(true, rasterizer == BOTH[i % 2]));
        for (_, method) in some {
            for (name, least, attack) in &drawn {
                let mut surfels = sphere();
                attack(&mut surfels);
                let name = format!("{name}, {} {rasterizer:?}", method.name);
                let outcome = meet(&name, || {
                    let scene = Scene::upload(&device, &surfels)?;
                    Ok(renderer.render_picture(&scene, &camera(), &method.settings())?.0)
                });
                let covered = if let Outcome::Drawn { covered } = outcome { covered } else { 0 };
                assert!(covered >= *least, "{name}: {covered} px");
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn lines_and_triangles_that_are_none() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let square = || Primitives {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE],
        directions: vec![Vec3::Z; 4],
        radii: vec![0.1; 4],
        triangles: vec![[0, 1, 2], [1, 2, 3]],
        ..Default::default()
    };
    type Attack = (&'static str, bool, fn(&mut Primitives));
    let attacks: [Attack; 9] = [
        ("a corner that is none", true, |p| p.triangles[1][2] = 4),
        ("an end that is none", true, |p| p.ribbons = vec![[0, u32::MAX]]),
        ("a radius too few", true, |p| p.radii.truncate(2)),
        ("a triangle without an area", false, |p| p.triangles[0] = [1, 1, 1]),
        ("a line without a length", false, |p| p.tubes = vec![[2, 2]]),
        ("corners that are no places", false, |p| p.positions[1] = Vec3::NAN),
        ("radii that are no numbers", false, |p| p.radii.fill(f32::NAN)),
        ("directions of length 0", false, |p| p.directions.fill(Vec3::ZERO)),
        ("a thousand of the same", false, |p| p.triangles = vec![[0, 1, 3]; 1000]),
    ];
    for (i, (name, is_refused, attack)) in attacks.into_iter().enumerate() {
        let mut primitives = square();
        attack(&mut primitives);
        let model = Model { surfels: sphere(), primitives };
        for &rasterizer in &BOTH[if_whole(0..2, i % 2..i % 2 + 1)] {
            let outcome = meet(name, || {
                let scene = Scene::upload(&device, &model)?;
                let settings = Method::named("pull-push").unwrap().settings();
                Ok(Renderer::new(&device, options(rasterizer))?
                    .render_picture(&scene, &camera(), &settings)?
                    .0)
            });
            assert!(outcome == Outcome::Refused || !is_refused, "{name}: {outcome:?}");
        }
    }
    assert_silent(&device);
}

#[test]
fn settings_that_make_no_sense() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere()).unwrap();
    type Attack = (&'static str, fn(&mut Settings));
    let attacks: [Attack; 24] = [
        ("a cut-off of 0", |s| s.cutoff = 0.0),
        ("a cut-off that is no number", |s| s.cutoff = f32::NAN),
        ("a cut-off of 1000", |s| s.cutoff = 1e3),
        ("the least cut-off", |s| s.cutoff = 0.1),
        ("the greatest cut-off", |s| s.cutoff = 8.0),
        ("an epsilon of 0", |s| s.epsilon = 0.0),
        ("an epsilon below 0", |s| s.epsilon = -1.0),
        ("an epsilon of 1e30", |s| s.epsilon = 1e30),
        ("an epsilon of 1e-30", |s| s.epsilon = 1e-30),
        ("a filter below 0", |s| s.lowpass = -1.0),
        ("a filter at infinity", |s| s.lowpass = f32::INFINITY),
        ("the widest filter", |s| s.lowpass = 100.0),
        ("a background that is no colour", |s| s.background = Some([f32::NAN, 0.0, 0.0])),
        ("a background below 0", |s| s.background = Some([-5.0; 3])),
        ("an albedo at infinity", |s| s.lighting.albedo = [f32::INFINITY; 3]),
        ("a shininess of 0", |s| s.lighting.shininess = 0.0),
        ("a shininess of 1e30", |s| s.lighting.shininess = 1e30),
        ("a shininess below 0", |s| s.lighting.shininess = -3.0),
        ("a specular that is no number", |s| s.lighting.specular = f32::NAN),
        ("five lights", |s| {
            s.lighting.directional =
                vec![DirectionalLight { to_light: [0.0, 0.0, 1.0], radiance: [1.0; 3] }; 5];
        }),
        ("a light from nowhere", |s| {
            s.lighting.directional = vec![DirectionalLight { to_light: [0.0; 3], radiance: [1.0; 3] }];
        }),
        ("a kernel without a shape", |s| s.splatting.kernel = Kernel::Confetti { a: f32::NAN, n: 0.0 }),
        ("a kernel of a point", |s| s.splatting.kernel = Kernel::Confetti { a: 1e30, n: 1e30 }),
        ("weights that are not there", |s| s.splatting.normalization = Normalization::Surfel),
    ];
    for (i, method) in methods().into_iter().enumerate() {
        // What is refused does not depend on the rasterizer: in the short run methods have either in turns.
        for rasterizer in &BOTH[if_whole(0..2, i % 2..i % 2 + 1)] {
            let mut renderer = Renderer::new(&device, options(*rasterizer)).unwrap();
            for (name, attack) in attacks {
                let mut settings = Settings { cull: Cull::Back, ..method.settings() };
                attack(&mut settings);
                let name = format!("{name}, {} {rasterizer:?}", method.name);
                meet(&name, || Ok(renderer.render_picture(&scene, &camera(), &settings)?.0));
            }
            // What was refused leaves nothing behind.
            let after =
                meet(method.name, || Ok(renderer.render_picture(&scene, &camera(), &method.settings())?.0));
            assert!(
                matches!(after, Outcome::Drawn { covered } if covered > 500),
                "{}: {after:?}",
                method.name
            );
        }
    }
    assert_silent(&device);
}

#[test]
fn cameras_that_see_nothing() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Scene::upload(&device, &sphere()).unwrap();
    let (eye, zero, up) = (DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y);
    let changed = |change: fn(&mut Camera)| {
        let mut camera = camera();
        change(&mut camera);
        Ok(camera)
    };
    let cameras: [(&str, Result<Camera>); 21] = [
        ("at its own target", Camera::look_at(zero, zero, up, 0.8, 1.5, 0.1)),
        ("upwards along what is up", Camera::look_at(eye, zero, DVec3::Z, 0.8, 1.5, 0.1)),
        ("without an up", Camera::look_at(eye, zero, zero, 0.8, 1.5, 0.1)),
        ("from no place", Camera::look_at(DVec3::NAN, zero, up, 0.8, 1.5, 0.1)),
        ("of half a turn", Camera::look_at(eye, zero, up, std::f64::consts::PI, 1.5, 0.1)),
        ("of a billionth of a degree", Camera::look_at(eye, zero, up, 1e-11, 1.5, 0.1)),
        ("without a width", Camera::look_at(eye, zero, up, 0.8, 0.0, 0.1)),
        ("of infinite width", Camera::look_at(eye, zero, up, 0.8, f64::INFINITY, 0.1)),
        ("with a near plane at the eye", Camera::look_at(eye, zero, up, 0.8, 1.5, 0.0)),
        ("with a near plane behind the eye", Camera::look_at(eye, zero, up, 0.8, 1.5, -1.0)),
        ("with a near plane behind the scene", Camera::look_at(eye, zero, up, 0.8, 1.5, 100.0)),
        ("a light year away", Camera::look_at(1e16 * DVec3::Z, zero, up, 0.8, 1.5, 1.0)),
        ("within a surfel", Camera::look_at(1.0001 * DVec3::Z, zero, up, 0.8, 1.5, 1e-9)),
        ("parallel, without a height", Camera::orthographic([eye, zero, up], 0.0, 1.5, [0.1, 9.0])),
        ("parallel, without a depth", Camera::orthographic([eye, zero, up], 2.0, 1.5, [4.0, 4.0])),
        ("parallel, from behind", Camera::orthographic([eye, zero, up], 2.0, 1.5, [-9.0, -1.0])),
        ("with a view that is no number", changed(|c| c.view.x_axis.x = f64::NAN)),
        ("with a view that shears", changed(|c| c.view.y_axis.x += 0.5)),
        ("with a view that scales", changed(|c| c.view = DMat4::from_scale(DVec3::splat(2.0)) * c.view)),
        ("with a projection of zeros", changed(|c| c.projection = DMat4::ZERO)),
        ("with a projection that squints", changed(|c| c.projection.x_axis = DVec4::new(1.0, 1.0, 1.0, 1.0))),
    ];
    for (i, method) in methods().into_iter().enumerate() {
        for &rasterizer in &BOTH[if_whole(0..2, i % 2..i % 2 + 1)] {
            // One for all, so that pipelines are made once.
            let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
            for (name, camera) in &cameras {
                let camera = match camera {
                    Ok(camera) => camera,
                    Err(error) => {
                        println!("{name}: refused: {error}");
                        continue;
                    }
                };
                let name = format!("{name}, {} {rasterizer:?}", method.name);
                let outcome =
                    meet(&name, || Ok(renderer.render_picture(&scene, camera, &method.settings())?.0));
                let is_matrix = name.contains("with a view") || name.contains("with a projection");
                assert!(outcome == Outcome::Refused || !is_matrix, "{name}: {outcome:?}");
            }
        }
    }
    assert_silent(&device);
}

#[test]
fn places_where_nothing_stands() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Arc::new(Scene::upload(&device, &sphere()).unwrap());
    let turn = DMat4::from_rotation_y(0.5);
    let refused = [
        ("a transform that is no number", DMat4::from_translation(DVec3::NAN)),
        ("a scale of 0", DMat4::from_scale(DVec3::ZERO)),
        ("a mirror", DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))),
        ("a stretch", DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0))),
        ("a projection", camera().projection),
        ("an infinite scale", DMat4::from_scale(DVec3::INFINITY)),
    ];
    let drawn = [
        ("a scale of 1e-30", DMat4::from_scale(DVec3::splat(1e-30))),
        ("a scale of 1e30", DMat4::from_scale(DVec3::splat(1e30))),
        ("a light year away", DMat4::from_translation(DVec3::splat(1e16))),
    ];
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        for (name, transform) in refused {
            let both = [Instance::new(&scene, turn), Instance::new(&scene, transform)];
            let outcome =
                meet(name, || Ok(renderer.render_picture(&both[..], &camera(), &Settings::default())?.0));
            assert_eq!(outcome, Outcome::Refused, "{name}");
        }
        for (name, transform) in drawn {
            let both = [Instance::new(&scene, turn), Instance::new(&scene, transform)];
            meet(name, || Ok(renderer.render_picture(&both[..], &camera(), &Settings::default())?.0));
        }
        let none: [Instance; 0] = [];
        let outcome =
            meet("nobody", || Ok(renderer.render_picture(&none[..], &camera(), &Settings::default())?.0));
        assert_eq!(outcome, Outcome::Drawn { covered: 0 });
        let same: Vec<_> = (0..40).map(|_| Instance::new(&scene, turn)).collect();
        meet("forty in one place", || {
            Ok(renderer.render_picture(&same[..], &camera(), &Settings::default())?.0)
        });
    }
    assert_silent(&device);
}

#[test]
fn updates_that_do_not_fit() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = sphere();
    let scene = Scene::upload(&device, &surfels).unwrap();
    let (positions, radii, normals) = ([Vec3::ZERO; 10], [0.1f32; 10], [Vec3::Z; 9]);
    let linear = Colours::Linear(vec![[0.5; 3]; 10]);
    let ellipses = [Ellipse::circle(Vec3::Z); 10];
    let nowhere = Bounds { min: DVec3::NAN, max: DVec3::NAN, radius: f64::NAN };
    let all = Changes { positions: Some(&positions), radii: Some(&radii), ..Default::default() };
    let attacks = [
        ("beyond the end", 595, all),
        ("far beyond the end", u64::MAX, all),
        ("of unequal lengths", 0, Changes { normals: Some(&normals), ..all }),
        ("with colours of another kind", 0, Changes { colours: Some(&linear), ..Default::default() }),
        ("with ellipses of discs", 0, Changes { ellipses: Some(&ellipses), ..Default::default() }),
        ("with bounds that are none", 0, Changes { bounds: Some(nowhere), ..all }),
    ];
    let mut renderer = Renderer::new(&device, options(Rasterizer::Draw)).unwrap();
    let mut picture = || renderer.render_picture(&scene, &camera(), &Settings::default()).unwrap().0;
    let before = picture();
    for (name, first, changes) in attacks {
        let refused = scene.update(first, &changes);
        assert!(matches!(refused, Err(Error::Usage(_))), "{name}: {refused:?}");
        assert!(picture() == before, "{name}: something is changed all the same");
    }
    scene.update(600, &Changes::default()).unwrap();
    scene.update(0, &Changes { radii: Some(&[f32::NAN; 600]), ..Default::default() }).unwrap();
    let after = meet("radii that are no numbers", || Ok(picture()));
    assert_eq!(after, Outcome::Drawn { covered: 0 });
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn sizes_devices_and_readings_out_of_turn() {
    let limits = DeviceLimits { max_image_side: Some(16_384), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let Some(other) = self::device(DeviceLimits::default()) else { return };
    for size in [[0, 5], [5, 0], [u32::MAX, 1], [1 << 20, 1 << 20], [20_000, 20_000]] {
        let refused =
            Renderer::new(&device, RenderOptions { size, ..Default::default() }).and_then(|mut renderer| {
                renderer.render_picture(&Scene::upload(&device, &sphere())?, &camera(), &Settings::default())
            });
        assert!(
            matches!(refused, Err(Error::Usage(_) | Error::Memory { .. })),
            "{size:?}: {:?}",
            refused.err()
        );
    }
    let (scene, theirs) =
        (Scene::upload(&device, &sphere()).unwrap(), Scene::upload(&other, &sphere()).unwrap());
    for rasterizer in BOTH {
        let mut renderer = Renderer::new(&device, options(rasterizer)).unwrap();
        assert!(renderer.read_splats().is_ok_and(|splats| splats.is_empty()), "before a frame");
        assert!(renderer.read_pyramids().is_ok_and(|pyramids| pyramids.is_none()), "before a frame");
        let refused = renderer.render(&theirs, &camera(), &Settings::default());
        assert!(matches!(refused, Err(Error::Usage(_))), "a scene of another device: {refused:?}");
        let numbers =
            RenderOptions { outputs: Outputs { id: true, ..Default::default() }, ..options(rasterizer) };
        let refused = Renderer::new(&device, numbers)
            .and_then(|mut renderer| renderer.render(&scene, &camera(), &Settings::default()));
        assert!(matches!(refused, Err(Error::Usage(_))), "numbers of splats: {refused:?}");
        for (i, shading) in [Shading::Overlap, Shading::Weight].into_iter().enumerate() {
            let both = [Precision::Full, Precision::Half];
            // The other pairs with the other rasterizer.
            let some = (i + usize::from(rasterizer == BOTH[1])) % 2;
            for &precision in &both[if_whole(0..2, some..some + 1)] {
                let options = RenderOptions { precision, ..options(rasterizer) };
                for method in methods() {
                    let settings = Settings { shading, ..method.settings() };
                    let name = format!("{shading:?} by {} {rasterizer:?} {precision:?}", method.name);
                    meet(&name, || {
                        Ok(Renderer::new(&device, options)?.render_picture(&scene, &camera(), &settings)?.0)
                    });
                }
            }
        }
        // Who goes first is nobody's concern.
        let kept = Scene::upload(&device, &sphere()).unwrap();
        renderer.render(&kept, &camera(), &Settings::default()).unwrap();
        drop(kept);
        assert!(renderer.read_splats().is_ok());
        renderer.render(&scene, &camera(), &Settings::default()).unwrap();
    }
    assert_silent(&device);
    assert_silent(&other);
}
