//! Pipelines are created when the host asks for it, and only once.

use crate::fixture::{SIZE, assert_silent, camera, open, sphere, surfels, upload};
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::host::native::{self, Native};
use crate::support::{if_whole, methods};
use crate::{FLOATS, ONE};
use ash::vk;
use glam::DVec3;
use std::ffi::{CStr, c_void};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use surfel::Settings;
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::settings::Alpha;
use surfel::settings::methods::Method;
use surfel::vk::Device;

/// Number of pipelines created by the host that counts.
static MADE: AtomicU64 = AtomicU64::new(0);
/// Pipeline creation functions of its device.
static MAKING: Mutex<Option<(vk::PFN_vkCreateGraphicsPipelines, vk::PFN_vkCreateComputePipelines)>> =
    Mutex::new(None);
/// Serializes the tests that count.
static COUNTING: Mutex<()> = Mutex::new(());

fn making() -> (vk::PFN_vkCreateGraphicsPipelines, vk::PFN_vkCreateComputePipelines) {
    MAKING.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).unwrap()
}

unsafe extern "system" fn graphics(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::GraphicsPipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    MADE.fetch_add(count.into(), Ordering::SeqCst);
    // SAFETY: the functions are the device's.
    unsafe { making().0(device, cache, count, infos, allocator, pipelines) }
}

unsafe extern "system" fn compute(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::ComputePipelineCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    MADE.fetch_add(count.into(), Ordering::SeqCst);
    // SAFETY: as above.
    unsafe { making().1(device, cache, count, infos, allocator, pipelines) }
}

/// The host's device with functions that count.
fn counted_device(host: &Host) -> Arc<Device> {
    let table = host.device.fp_v1_0();
    *MAKING.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) =
        Some((table.create_graphics_pipelines, table.create_compute_pipelines));
    let replace = |name: &CStr| match name.to_bytes() {
        b"vkCreateGraphicsPipelines" => Some(graphics as *const c_void),
        b"vkCreateComputePipelines" => Some(compute as *const c_void),
        _ => None,
    };
    host.external_device_replaced(replace).unwrap()
}

fn settings(name: &str) -> Settings {
    Settings { background: None, ..Method::named(name).unwrap().settings() }
}

/// Number of pipelines that `body` creates.
fn made(body: impl FnOnce()) -> u64 {
    let before = MADE.load(Ordering::SeqCst);
    body();
    MADE.load(Ordering::SeqCst) - before
}

#[test]
fn a_frame_whose_pipelines_are_there_makes_none() {
    let Some(host) = open(|all| all) else { return };
    let _alone = COUNTING.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let device = counted_device(&host);
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, SIZE).unwrap();
    // So few that no frame is sliced, which needs other pipelines.
    let scene = upload(&host, &device, &sphere(2_000));
    let options = Options { frames_in_flight: 1, ..Options::new(frame.target()) };
    let view = View::whole(camera(), SIZE);
    // The short run has one method of tiles and the one of pixels beside the first frame's.
    let some =
        |name: &&str| if_whole(true, ["perspective-ewa", "pull-push", "sprites-unfiltered"].contains(name));
    for name in methods().into_iter().map(|method| method.name).filter(some) {
        let (first, next) = (settings("sprites-unfiltered"), settings(name));
        // SAFETY: the target is the frame's; all commands are waited for.
        unsafe {
            let mut renderer = Renderer::new(&device, options.clone()).unwrap();
            let show = |renderer: &mut Renderer, settings: &Settings, body: &dyn Fn(&mut Renderer)| {
                host.run(|cmd| {
                    renderer.prepare(cmd, &scene, &view, settings)?;
                    body(renderer);
                    frame.begin(&host, cmd);
                    let drawn = renderer.draw(cmd);
                    frame.end(&host, cmd);
                    Ok(drawn?)
                })
                .unwrap();
            };
            show(&mut renderer, &first, &|_| {});
            renderer.make_pipelines(&scene, &view, &first).unwrap();
            let ahead = made(|| {
                // The prepared frame is still drawn.
                show(&mut renderer, &first, &|renderer| {
                    renderer.make_pipelines(&scene, &view, &next).unwrap();
                });
            });
            assert_eq!(ahead == 0, name == "sprites-unfiltered", "{name}: {ahead}");
            let later = made(|| {
                show(&mut renderer, &next, &|_| {});
                renderer.make_pipelines(&scene, &view, &first).unwrap();
                show(&mut renderer, &first, &|_| {});
            });
            assert_eq!(later, 0, "{name}");
            assert!(renderer.make_pipelines(&scene, &View::whole(camera(), [0, 1]), &first).is_err());
        }
    }
    drop(scene);
    frame.destroy(&host);
    assert_silent(&host);
}

/// By its camera and size a frame is of distant surfels or not, dense or not, and of more surfels than pixels or not.
#[test]
fn cameras_and_sizes_need_no_other_pipelines() {
    let Some(host) = open(|all| all) else { return };
    let device = host.external_device(None).unwrap();
    let kind = Kind { way: Way::Rendering, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, [64, 64]).unwrap();
    let scene = upload(&host, &device, &sphere(9_000));
    let options = Options { frames_in_flight: 1, ..Options::new(frame.target()) };
    // SAFETY: the target is the frame's.
    let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
    let settings = Settings { alpha: Alpha::Mask, pixel_filter: 0.0, ..settings("perspective-ewa") };
    let from = |distance: f64, angle: f64| {
        let eye = distance * DVec3::new(0.3, 0.2, 0.9);
        Camera::look_at(eye, DVec3::ZERO, DVec3::Y, angle, 1.0, 0.1).unwrap()
    };
    renderer.make_pipelines(&scene, &View::whole(from(3.0, 0.8), [64, 64]), &settings).unwrap();
    let before = device.usage().pipelines;
    for (camera, size) in
        [(from(3.0, 0.8), [64, 64]), (from(3.0, 0.8), [128, 128]), (from(60.0, 0.8), [64, 64])]
            .into_iter()
            .chain([(from(3e3, 0.8e-3), [64, 64]), (from(3e3, 0.02), [64, 64])])
    {
        let view = View::whole(camera, size);
        // SAFETY: recorded outside a render pass, and waited for.
        host.run(|cmd| Ok(unsafe { renderer.prepare(cmd, &scene, &view, &settings) }?)).unwrap();
        assert_eq!(device.usage().pipelines, before, "{view:?}");
    }
    drop((renderer, scene));
    frame.destroy(&host);
    assert_silent(&host);
}

#[test]
fn subpasses_whose_pipelines_are_there_make_none() {
    let Some(host) = open(|all| all) else { return };
    let _alone = COUNTING.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let device = counted_device(&host);
    let kind = native::Kind {
        colour: FLOATS,
        depth: Some(vk::Format::D32_SFLOAT),
        normals: false,
        samples: ONE,
        reversed: true,
        seed: true,
        around: [true, false],
    };
    let view = View::whole(camera(), SIZE);
    for name in &["perspective-ewa", "sprites", "object-ewa", "confetti"][..if_whole(4, 2)] {
        let scene = upload(&host, &device, &surfels());
        let settings = settings(name);
        let mut native = Native::new(&host, &device, kind, SIZE, &[(scene.streams(), &settings)]).unwrap();
        let ahead = made(|| native.renderer.make_pipelines(&scene, &view, &settings).unwrap());
        assert!(ahead > 3, "{name}: {ahead}");
        let later = made(|| {
            host.run(|cmd| {
                // SAFETY: prepared outside the pass, drawn inside it, and waited for.
                unsafe {
                    native.renderer.prepare(cmd, &scene, &view, &settings)?;
                    native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), false)
                }
            })
            .unwrap();
        });
        assert_eq!(later, 0, "{name}");
        let refused = native.renderer.make_pipelines(&scene, &view, &self::settings("pull-push"));
        assert!(refused.unwrap_err().to_string().contains("pull"), "a method without splats");
        native.destroy(&host);
    }
    assert_silent(&host);
}
