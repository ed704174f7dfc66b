//! Instances in frames of hosts: the pictures equal the engine's, whatever list each frame has.

use crate::compare::assert_depths;
use crate::fixture::{SIZE, assert_silent, camera, open, upload};
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::host::memory::Counted;
use crate::host::native::{self, Native};
use crate::host::under_way::UnderWay;
use crate::native::multiplied;
use crate::support::if_whole;
use crate::support::placing::{exact, painted, plain, rich, turned};
use crate::{FLOATS, ONE};
use ash::vk;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::Surfels;
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

const KIND: Kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
/// Splats are seeded by the host's depth.
const NATIVE: native::Kind = native::Kind {
    colour: FLOATS,
    depth: Some(vk::Format::D32_SFLOAT),
    normals: false,
    samples: ONE,
    reversed: true,
    seed: true,
    around: [true, true],
};

fn method(name: &str) -> Settings {
    Settings { background: None, ..Method::named(name).unwrap().settings() }
}

fn view() -> View {
    View::whole(camera(), SIZE)
}

/// Two intersecting clouds, one of them without colours.
fn parts() -> [(Surfels, DMat4); 2] {
    let place = turned(0.6, [0.2, 1.0, -0.5], 1.9, [0.7, 0.1, 0.3]);
    [(plain(8_000), exact(1.0, [1.0, 0.0, 2.0], [0.0; 3])), (rich(3_000), place)]
}

fn instances(scenes: impl IntoIterator<Item = Arc<Scene>>) -> Vec<Instance> {
    scenes.into_iter().zip(parts()).map(|(scene, (_, place))| Instance::new(&scene, place)).collect()
}

/// The engine's frame of the instances.
fn alone(settings: &Settings, rasterizer: Rasterizer) -> Picture {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { normal: false, depth: true, id: false };
    let options = RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
    let scenes = parts().map(|(surfels, _)| Arc::new(Scene::upload(&device, &surfels).unwrap()));
    let mut renderer = surfel::Renderer::new(&device, options).unwrap();
    renderer.render_picture(&instances(scenes), &camera(), settings).unwrap().0
}

fn options(frame: &Frame, rasterizer: Option<Rasterizer>) -> Options {
    Options { rasterizer: rasterizer.into(), ..Options::new(frame.target()) }
}

/// A frame of the instances; empty after an error.
fn draw(
    host: &Host,
    frame: &Frame,
    renderer: &mut Renderer,
    list: &[Instance],
    settings: &Settings,
) -> surfel::Result<()> {
    let drawn = host.run(|cmd| {
        // SAFETY: recorded outside and inside the frame's pass, and waited for.
        unsafe {
            let prepared = renderer.prepare(cmd, list, &view(), settings);
            frame.begin(host, cmd);
            let drawn = renderer.draw(cmd);
            frame.end(host, cmd);
            Ok(prepared.and(drawn))
        }
    });
    drawn.unwrap()
}

#[test]
fn a_composite_of_several_scenes_is_the_engines_own() {
    let Some(host) = open(|all| all) else { return };
    let names = ["perspective-ewa", "sprites-unfiltered", "pull-push", "object-ewa"];
    for (i, name) in names.into_iter().take(if_whole(4, 3)).enumerate() {
        let settings = method(name);
        for &rasterizer in &[Rasterizer::Compute, Rasterizer::Draw][if_whole(0..2, i % 2..i % 2 + 1)] {
            let own = alone(&settings, rasterizer);
            assert!(own.colour.iter().filter(|colour| colour[3] > 0.0).count() > 4_000);
            let device = host.external_device(None).unwrap();
            let frame = Frame::new(&host, KIND, SIZE).unwrap();
            // SAFETY: the target is the frame's.
            let mut renderer = unsafe { Renderer::new(&device, options(&frame, Some(rasterizer))) }.unwrap();
            let list = instances(parts().map(|(surfels, _)| upload(&host, &device, &surfels)));
            draw(&host, &frame, &mut renderer, &list, &settings).unwrap();
            let (colours, depths) = frame.read(&host).unwrap();
            for (i, (colour, own)) in colours.iter().zip(&multiplied(&own.colour)).enumerate() {
                assert_eq!(colour, own, "{name} {rasterizer:?}, pixel {i}");
            }
            assert_depths(&depths, &own);
            drop((renderer, list));
            frame.destroy(&host);
        }
    }
    assert_silent(&host);
}

#[test]
fn subpasses_of_several_scenes_draw_the_engines_own_picture() {
    let Some(host) = open(|all| all) else { return };
    for method in Method::SPLATTING.into_iter().step_by(if_whole(1, 2)) {
        let settings = method.settings().in_subpasses();
        let own = alone(&settings, Rasterizer::Draw);
        let device = host.external_device(None).unwrap();
        let list = instances(parts().map(|(surfels, _)| upload(&host, &device, &surfels)));
        let frames: Vec<_> = list.iter().map(|instance| (instance.scene.streams(), &settings)).collect();
        let mut native = Native::new(&host, &device, NATIVE, SIZE, &frames).unwrap();
        host.run(|cmd| {
            // SAFETY: prepared outside the pass, drawn inside it, and waited for.
            unsafe {
                native.renderer.prepare(cmd, &list, &view(), &settings)?;
                native.record(&host, cmd, (None, &view()), |surfels| surfels.draw(cmd), false)
            }
        })
        .unwrap();
        let found: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&native.picture(&host, 16).unwrap());
        let differ = found.iter().zip(&multiplied(&own.colour)).filter(|(a, b)| a != b).count();
        assert_eq!(differ, 0, "{}", method.name);
        native.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn what_is_refused_records_nothing_and_the_next_frame_is_right() {
    let Some(host) = open(|all| all) else { return };
    let device = host.external_device(None).unwrap();
    let frame = Frame::new(&host, KIND, SIZE).unwrap();
    let settings = method("sprites-unfiltered");
    {
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options(&frame, None)) }.unwrap();
        let mut list = instances(parts().map(|(surfels, _)| upload(&host, &device, &surfels)));
        draw(&host, &frame, &mut renderer, &list, &settings).unwrap();
        let before = frame.read(&host).unwrap();
        let place = std::mem::replace(&mut list[1].transform, DMat4::from_scale(DVec3::new(1.0, 2.0, 1.0)));
        let error = draw(&host, &frame, &mut renderer, &list, &settings).unwrap_err().to_string();
        assert!(error.contains("instance 1"), "{error}");
        // Nothing is drawn.
        assert!(frame.read(&host).unwrap().0.iter().all(|colour| colour[3] == 0.0));
        list[1].transform = place;
        let other = host.external_device(None).unwrap();
        list[1].scene = upload(&host, &other, &painted(500));
        let error = draw(&host, &frame, &mut renderer, &list, &settings).unwrap_err().to_string();
        assert!(error.contains("another device"), "{error}");
        list[1].scene = upload(&host, &device, &parts()[1].0);
        draw(&host, &frame, &mut renderer, &list, &settings).unwrap();
        assert!(frame.read(&host).unwrap() == before);
        // An empty list is an empty picture.
        draw(&host, &frame, &mut renderer, &[], &settings).unwrap();
        assert!(frame.read(&host).unwrap().0.iter().all(|colour| colour[3] == 0.0));
    }
    frame.destroy(&host);
    assert_silent(&host);
}

/// The instances of a frame: scenes come and go, move, occur twice, or not at all.
fn list(number: usize, scenes: &[Arc<Scene>; 3]) -> Vec<Instance> {
    let place = |i: usize| {
        let angle = (number + 3 * i) as f64;
        turned(0.4 + 0.1 * i as f64, [0.1, 1.0, 0.2], angle, [i as f64 - 1.0, 0.0, 0.2])
    };
    let picked: &[usize] = [&[0, 1, 2][..], &[2, 0], &[1], &[0, 0, 1], &[], &[2, 1, 0, 2]][number % 6];
    picked.iter().enumerate().map(|(i, scene)| Instance::new(&scenes[*scene], place(i))).collect()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn lists_that_change_with_every_frame_leave_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let frame = Frame::new(&host, KIND, SIZE).unwrap();
    {
        let scenes = [painted(500), plain(900), rich(700)].map(|surfels| upload(&host, &device, &surfels));
        let start = counts.alive.load(Ordering::SeqCst);
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options(&frame, None)) }.unwrap();
        let names = ["perspective-ewa", "pull-push", "sprites-unfiltered"];
        let settings = names.map(method);
        let mut under_way = UnderWay::new(2);
        for number in 0..if_whole(60, 24) {
            under_way
                .submit(&host, |cmd| {
                    // SAFETY: at most two frames are in flight, as declared.
                    unsafe {
                        let list = list(number, &scenes);
                        renderer.prepare(cmd, &list, &view(), &settings[number / 7 % 3])?;
                        frame.begin(&host, cmd);
                        renderer.draw(cmd)?;
                        frame.end(&host, cmd);
                    }
                    Ok(())
                })
                .unwrap();
        }
        under_way.finish(&host).unwrap();
        drop(renderer);
        assert_eq!(counts.alive.load(Ordering::SeqCst), start);
    }
    frame.destroy(&host);
    assert_eq!(Arc::strong_count(&device), 1);
    drop(device);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    assert_silent(&host);
}

#[test]
fn native_lists_that_change_with_every_frame_leave_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let settings = method("perspective-ewa");
    {
        let scenes = [painted(500), plain(900), rich(700)].map(|surfels| upload(&host, &device, &surfels));
        let start = counts.alive.load(Ordering::SeqCst);
        let frames: Vec<_> = scenes.iter().map(|scene| (scene.streams(), &settings)).collect();
        let mut native = Native::new(&host, &device, NATIVE, SIZE, &frames).unwrap();
        for number in 0..if_whole(50, 18) {
            host.run(|cmd| {
                // SAFETY: prepared outside the pass, drawn inside it, and waited for.
                unsafe {
                    native.renderer.prepare(cmd, &list(number, &scenes), &view(), &settings)?;
                    native.record(&host, cmd, (None, &view()), |surfels| surfels.draw(cmd), false)
                }
            })
            .unwrap();
        }
        native.destroy(&host);
        assert_eq!(counts.alive.load(Ordering::SeqCst), start);
    }
    assert_eq!(Arc::strong_count(&device), 1);
    drop(device);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    assert_silent(&host);
}
