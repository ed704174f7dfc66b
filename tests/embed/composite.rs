//! Composites: the pictures equal the engine's, occlusion is correct, and the host's state is its own.

use crate::compare::assert_depths;
use crate::fixture::{Fixture, assert_silent, open, upload};
use crate::host::Host;
use crate::host::frame::{Frame, IDS, Kind, Way};
use crate::host::memory::Counted;
use crate::host::mesh::Mesh;
use crate::host::scene::parallelogram;
use crate::host::under_way::UnderWay;
use crate::native::multiplied;
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use crate::{FLOATS, FOUR, ONE};
use ash::vk;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::{self, Abilities, Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Error, Outputs, Picture, Rasterizer, RenderOptions, Scene, Settings};

use crate::fixture::{SIZE, camera, meets, rising, sphere, surfels, viewport};

/// A renderer is `Send`.
#[allow(dead_code, reason = "it compiles, or not")]
fn a_renderer_goes_to_another_thread(renderer: Renderer) -> impl Send {
    renderer
}

/// The engine's frame: colours, and distances.
fn alone(settings: &Settings, camera: &Camera, rasterizer: Option<Rasterizer>) -> Picture {
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { normal: false, depth: true, id: false };
    let options = RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
    crate::support::gpu::render(&device, &surfels(), camera, settings, options)
}

fn kinds() -> impl Iterator<Item = Kind> {
    let ways = [Way::Subpass, Way::Rendering];
    let samples = move |way| {
        [ONE, FOUR].map(move |samples| Kind { way, colour: FLOATS, normals: false, samples, reversed: true })
    };
    ways.into_iter().flat_map(samples)
}

/// The methods by both rasterizers.
pub fn frames() -> Vec<(Settings, Option<Rasterizer>)> {
    let of = |name: &str| Method::named(name).unwrap().settings();
    let both = [Rasterizer::Draw, Rasterizer::Compute].map(Some);
    let splats = ["perspective-ewa", "sprites-unfiltered"].map(of);
    let splats = splats.into_iter().flat_map(|settings| both.map(|by| (settings.clone(), by)));
    splats
        .chain([(of("pull-push"), None)])
        .map(|(settings, by)| (Settings { background: None, ..settings }, by))
        .collect()
}

#[test]
fn an_embedded_picture_is_the_engines_own_bit_for_bit() {
    let Some(host) = open(|all| all) else { return };
    for (i, (settings, rasterizer)) in frames().into_iter().enumerate() {
        let own = alone(&settings, &camera(), rasterizer);
        assert!(own.colour.iter().filter(|colour| colour[3] > 0.0).count() > 5_000);
        // The short run has a third of the pairs.
        let is_tested = |k: usize| if_whole(true, (i + k).is_multiple_of(3));
        for (_, kind) in kinds().enumerate().filter(|(k, _)| is_tested(*k)) {
            let mut fixture = Fixture::new(&host, kind, SIZE, rasterizer, &surfels());
            let view = View::whole(camera(), SIZE);
            let (colours, depths) = fixture.render(&host, &view, &settings, None);
            assert!(colours == multiplied(&own.colour), "{kind:?} {rasterizer:?}");
            assert_depths(&depths, &own);
            fixture.destroy(&host);
        }
    }
    assert_silent(&host);
}

#[test]
fn pictures_and_normals_are_where_the_host_wants_them() {
    let Some(host) = open(|all| all) else { return };
    // Without blending, splats have one picture whatever their order.
    let settings = Settings { background: None, ..Method::named("sprites-unfiltered").unwrap().settings() };
    // In a larger target.
    let larger = [SIZE[0] + 37, SIZE[1] + 11];
    let at = vk::Viewport { x: 30.0, y: 8.0, ..viewport(SIZE) };
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    for (rasterizer, way) in
        [Rasterizer::Draw, Rasterizer::Compute].into_iter().zip([Way::Rendering, Way::Subpass])
    {
        let outputs = Outputs { normal: true, depth: true, id: false };
        let options =
            RenderOptions { size: SIZE, outputs, rasterizer: rasterizer.into(), ..Default::default() };
        let own = crate::support::gpu::render(&device, &surfels(), &camera(), &settings, options);
        let kind = Kind { way, colour: FLOATS, normals: true, samples: ONE, reversed: true };
        let mut fixture = Fixture::new(&host, kind, larger, Some(rasterizer), &surfels());
        let (colours, _) = fixture.render(&host, &View { camera: camera(), viewport: at }, &settings, None);
        let normals = fixture.frame.read_normals(&host).unwrap();
        let (normal, mut seen) = (own.normal.unwrap(), 0);
        for (i, colour) in colours.iter().enumerate() {
            let [x, y] = [i % larger[0] as usize, i / larger[0] as usize].map(|at| at as i64);
            let inside = (0..160).contains(&(x - 30)) && (0..120).contains(&(y - 8));
            let there =
                inside.then(|| ((y - 8) * 160 + x - 30) as usize).filter(|i| own.colour[*i][3] == 1.0);
            let expected = there.map_or(([0.0; 4], [0.0; 4]), |i| {
                (own.colour[i], [normal[i][0], normal[i][1], normal[i][2], 1.0])
            });
            assert_eq!((*colour, normals[i]), expected, "{rasterizer:?} {x} {y}");
            seen += usize::from(there.is_some());
        }
        assert!(seen > 5_000);
        fixture.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn numbers_are_the_engines_own() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { background: None, ..Method::named("pull-push").unwrap().settings() };
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let outputs = Outputs { normal: true, depth: true, id: true };
    let options = RenderOptions { size: SIZE, outputs, ..Default::default() };
    let own = crate::support::gpu::render(&device, &surfels(), &camera(), &settings, options);
    let (numbers, normals) = (own.id.unwrap(), own.normal.unwrap());
    assert!(numbers.iter().filter(|number| **number < 20_000).count() > 5_000);
    let formats: [&[vk::Format]; 3] = [&[IDS], &[IDS, FLOATS], &[FLOATS, IDS]];
    for (more, way, has_depth) in [
        (formats[0], Way::Subpass, true),
        (formats[0], Way::Subpass, false),
        (formats[1], Way::Rendering, true),
        (formats[2], Way::Subpass, false),
    ] {
        let kind = Kind { way, colour: FLOATS, normals: false, samples: ONE, reversed: true };
        let frame = Frame::with(&host, kind, SIZE, more).unwrap();
        let device = host.external_device(None).unwrap();
        let depth = frame.target().depth.filter(|_| has_depth);
        let target = embed::Target { depth, ..frame.target() };
        let options = Options { frames_in_flight: 1, ..Options::new(target) };
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        let scene = upload(&host, &device, &surfels());
        let view = View::whole(camera(), SIZE);
        draw(&host, &frame, &mut renderer, &scene, &view, &settings).unwrap();
        assert!(frame.read_ids(&host).unwrap() == numbers, "{more:?} {way:?} {has_depth}");
        assert!(frame.read(&host).unwrap().0 == own.colour);
        for (found, own) in frame.read_normals(&host).unwrap().iter().zip(&normals) {
            assert_eq!(found[..3], *own);
        }
        // Sums have no point ids.
        let refused = draw(&host, &frame, &mut renderer, &scene, &view, &splats_alone());
        assert!(refused.is_err_and(|error| error.to_string().contains("pull-push-paper have point ids")));
        drop(renderer);
        frame.destroy(&host);
    }
    assert_silent(&host);
}

/// A frame of surfels only.
fn draw(
    host: &Host,
    frame: &Frame,
    renderer: &mut Renderer,
    scene: &Arc<Scene>,
    view: &View,
    settings: &Settings,
) -> crate::host::Result<()> {
    host.run(|cmd| {
        // SAFETY: recorded outside and inside the frame's pass, and waited for.
        unsafe {
            renderer.prepare(cmd, scene, view, settings)?;
            frame.begin(host, cmd);
            let drawn = renderer.draw(cmd);
            frame.end(host, cmd);
            Ok(drawn?)
        }
    })
}

#[test]
fn colours_are_encoded_by_the_shader_as_by_the_format() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { background: None, ..splats_alone() };
    let bytes = [vk::Format::R8G8B8A8_UNORM, vk::Format::R8G8B8A8_SRGB].map(|colour| {
        let kind = Kind { way: Way::Subpass, colour, normals: false, samples: ONE, reversed: true };
        let device = host.external_device(None).unwrap();
        let frame = Frame::new(&host, kind, SIZE).unwrap();
        let target = embed::Target { encode: colour == vk::Format::R8G8B8A8_UNORM, ..frame.target() };
        let options = Options { frames_in_flight: 1, ..Options::new(target) };
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        let scene = upload(&host, &device, &surfels());
        let view = View::whole(camera(), SIZE);
        draw(&host, &frame, &mut renderer, &scene, &view, &settings).unwrap();
        let bytes = frame.read_bytes(&host, 4).unwrap();
        frame.destroy(&host);
        bytes
    });
    assert!(bytes[0].iter().filter(|byte| **byte > 100).count() > 20_000);
    // Both round to the nearest code, of values that differ by the last bits of a power.
    assert!(bytes[0].iter().zip(&bytes[1]).all(|(a, b)| a.abs_diff(*b) <= 1));
    assert_silent(&host);
}

#[test]
fn what_is_in_front_hides_what_is_behind_either_way() {
    let Some(host) = open(|all| all) else { return };
    let (centre, sides) =
        (DVec3::new(0.1, 0.05, 0.2), [DVec3::new(1.4, 0.2, 0.1), DVec3::new(0.0, 0.3, -1.1)]);
    // Orthogonal, for `meets`.
    let sides = [sides[0], sides[1] - sides[1].dot(sides[0]) / sides[0].length_squared() * sides[0]];
    let corners = parallelogram(centre.as_vec3(), sides.map(|side| side.as_vec3()));
    let settings = Settings { background: None, ..splats_alone() };
    let reference = surfel::verify::reference::render(&surfels(), &camera(), SIZE, &settings, &()).unwrap();
    let conventions = [(true, false, [0.0, 1.0]), (false, false, [0.0, 1.0]), (true, true, [0.25, 0.75])];
    let pairs = [Way::Subpass, Way::Rendering].into_iter().flat_map(|way| conventions.map(|c| (way, c)));
    // The short run has each convention once, by either way in turns.
    for (way, (reversed, up, range)) in pairs.step_by(if_whole(1, 2)) {
        let mut camera = if reversed { camera() } else { rising() };
        let height = SIZE[1] as f32;
        let [min_depth, max_depth] = range;
        let mut viewport = vk::Viewport { min_depth, max_depth, ..viewport(SIZE) };
        if up {
            // The host's y points up, and its viewport flips it.
            viewport = vk::Viewport { y: height, height: -height, ..viewport };
            camera.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * camera.projection;
        }
        let kind = Kind { way, colour: FLOATS, normals: false, samples: ONE, reversed };
        let mut fixture = Fixture::new(&host, kind, SIZE, None, &surfels());
        let mesh = Mesh::new(&host, &corners, fixture.frame.mesh_target()).unwrap();
        let (colours, _) = fixture.render(&host, &View { camera, viewport }, &settings, Some(&mesh));
        let mut counts = [[0; 2]; 2];
        let mut wrong = 0;
        for (i, colour) in colours.iter().enumerate() {
            let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
            let surfel = reference.covered[i].then_some(reference.depth[i]);
            let of_host = meets(&self::camera(), at, centre, sides);
            let is_surfel = surfel.is_some_and(|z| of_host.is_none_or(|of_host| z <= of_host));
            let is_host = !is_surfel && of_host.is_some();
            // Only the mesh is blue.
            let found = [
                colour[3] > 0.0 && colour[2] <= 1.5 * colour[0],
                colour[3] > 0.0 && colour[2] > 1.5 * colour[0],
            ];
            wrong += usize::from(found != [is_surfel, is_host]);
            counts[usize::from(surfel.is_some() && of_host.is_some())][usize::from(is_host)] += 1;
        }
        println!("{way:?}, reversed {reversed}, up {up}: {wrong} px of {} differ", colours.len());
        assert!(counts[1].iter().all(|count| *count > 500), "either hides the other: {counts:?}");
        assert!(wrong * 1000 <= colours.len(), "{wrong} px");
        mesh.destroy(&host);
        fixture.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn many_frames_of_all_sizes_and_scenes_leave_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, [64, 48]).unwrap();
    {
        let scenes = [500, 2_000].map(|count| upload(&host, &device, &sphere(count)));
        let target = frame.target();
        let options = Options::new(target);
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        let settings = ["perspective-ewa", "pull-push", "sprites-unfiltered"]
            .map(|name| Method::named(name).unwrap().settings());
        let mut under_way = UnderWay::new(2);
        let mut most = 0;
        for number in 0..if_whole(1000, 36usize) {
            // Each size lasts for a few frames.
            let size = [[64, 48], [33, 48], [64, 1]][number / 7 % 3];
            let view = View::whole(camera(), size);
            under_way
                .submit(&host, |cmd| {
                    // SAFETY: as `Options::frames_in_flight` requires: at most two are in flight.
                    unsafe {
                        renderer.prepare(cmd, &scenes[number / 5 % 2], &view, &settings[number / 11 % 3])?;
                        frame.begin(&host, cmd);
                        renderer.draw(cmd)?;
                        frame.end(&host, cmd);
                    }
                    Ok(())
                })
                .unwrap();
            most = most.max(counts.alive.load(Ordering::SeqCst));
        }
        under_way.finish(&host).unwrap();
        assert!(most < 80, "{most} pieces of memory at once");
    }
    frame.destroy(&host);
    assert_eq!(Arc::strong_count(&device), 1);
    drop(device);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    assert_silent(&host);
}

#[test]
fn without_memory_there_is_an_error_and_then_there_is_memory() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let kind = Kind { way: Way::Rendering, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, SIZE).unwrap();
    let options = Options { frames_in_flight: 1, ..Options::new(frame.target()) };
    // SAFETY: the target is the frame's.
    let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
    let scene = upload(&host, &device, &surfels());
    let view = View::whole(camera(), SIZE);
    let mut refused = 0;
    for left in 0.. {
        counts.left.store(left, Ordering::SeqCst);
        let before = counts.alive.load(Ordering::SeqCst);
        // SAFETY: recorded outside a render pass, and waited for.
        let made = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &surfels()) })).unwrap();
        // SAFETY: as above.
        let prepared =
            host.run(|cmd| Ok(unsafe { renderer.prepare(cmd, &scene, &view, &splats_alone()) })).unwrap();
        if made.is_ok() && prepared.is_ok() {
            break;
        }
        for error in [made.err(), prepared.as_ref().err().map(|_| ()).and(None)].into_iter().flatten() {
            assert!(
                matches!(&error, Error::Memory { cause, .. } if cause.contains("no memory left")),
                "{error}"
            );
        }
        if let Err(error) = prepared {
            assert!(matches!(error, Error::Memory { .. }), "{error}");
            // SAFETY: nothing is recorded without a picture to draw.
            let nothing = host.run(|cmd| Ok(unsafe { renderer.draw(cmd) })).unwrap();
            assert!(nothing.unwrap_err().to_string().contains("no picture to draw"));
        }
        assert!(counts.alive.load(Ordering::SeqCst) >= before);
        refused += 1;
    }
    assert!(refused > 5, "{refused}");
    drop((renderer, scene));
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    frame.destroy(&host);
    drop(device);
    assert_silent(&host);
}

#[test]
fn what_cannot_be_served_is_refused_and_says_why() {
    let Some(host) = open(|all| Abilities { independent_blend: false, ..all }) else { return };
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let mut fixture = Fixture::new(&host, kind, SIZE, None, &surfels());
    let target = fixture.frame.target();
    type Change = fn(&mut embed::Target);
    let changes: [(Change, &str); 18] = [
        (|t| t.picture = 1, "location of the picture is 1 of 1 colour attachments"),
        (|t| t.normal = Some(0), "both the picture and normals"),
        (|t| t.id = Some(0), "both the picture and point ids"),
        (
            |t| (t.colours, t.normal, t.id) = (vec![FLOATS, IDS], Some(1), Some(1)),
            "both normals and point ids",
        ),
        (
            |t| (t.colours, t.id) = (vec![FLOATS; 2], Some(1)),
            "point ids at location 1 need R32_UINT, but the format is R32G32B32A32_SFLOAT",
        ),
        (
            |t| t.colours[0] = vk::Format::R32G32B32A32_UINT,
            "cannot draw the picture at location 0 to R32G32B32A32_UINT",
        ),
        (
            |t| (t.colours, t.normal) = (vec![FLOATS, vk::Format::R8G8B8A8_UNORM], Some(1)),
            "normals at location 1 have negative components, which R8G8B8A8_UNORM cannot store",
        ),
        (|t| t.colours.push(FLOATS), "independentBlend"),
        (|t| t.depth = Some(FLOATS), "cannot draw depth to R32G32B32A32_SFLOAT"),
        (|t| t.depth = Some(vk::Format::S8_UINT), "cannot draw depth to S8_UINT"),
        (|t| t.stencil = FLOATS, "cannot draw the stencil to R32G32B32A32_SFLOAT"),
        (|t| t.stencil = vk::Format::D32_SFLOAT_S8_UINT, "both are one attachment"),
        (|t| t.samples = ONE | FOUR, "1, 4 samples per pixel"),
        (|t| t.samples = vk::SampleCountFlags::empty(), "no samples per pixel"),
        (|t| t.samples = vk::SampleCountFlags::TYPE_64, "has 64 samples per pixel, but"),
        (|t| t.colours = vec![FLOATS; 9], "9 colour attachments, but"),
        (|t| t.pass = embed::Pass::Subpass { pass: vk::RenderPass::null(), subpass: 0 }, "no render pass"),
        (|t| (t.colours[0], t.encode) = (vk::Format::R8G8B8A8_SRGB, true), "encodes sRGB itself"),
    ];
    let make = |target, frames_in_flight| {
        let options = Options { frames_in_flight, ..Options::new(target) };
        // SAFETY: nothing is created for a rejected target.
        unsafe { Renderer::new(&fixture.device, options) }
    };
    for (change, expected) in changes {
        let mut target = target.clone();
        change(&mut target);
        let text = make(target, 2).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(text.contains(expected), "`{expected}` is not in `{text}`");
    }
    let hidden = host
        .external_device_within(DeviceLimits { dynamic_rendering: Some(false), ..Default::default() }, None)
        .unwrap();
    let rendering = embed::Target { pass: embed::Pass::Rendering, ..target.clone() };
    let options = Options::new(rendering);
    // SAFETY: nothing is created for a rejected target.
    let refused = unsafe { Renderer::new(&hidden, options) }.err().unwrap().to_string();
    assert!(refused.contains("the feature dynamicRendering"), "{refused}");
    let few = DeviceLimits { max_storage_buffers: Some(14), ..Default::default() };
    let refused = host.external_device_within(few, None).err().unwrap().to_string();
    assert!(refused.contains("needs 15 storage buffers") && refused.contains("allows 14"), "{refused}");
    for frames in [0, u32::MAX] {
        let expected = format!("{frames} frames in flight");
        assert!(make(target.clone(), frames).is_err_and(|error| error.to_string().contains(&expected)));
    }

    let other = host.external_device(None).unwrap();
    let elsewhere = upload(&host, &other, &surfels());
    let good = View::whole(camera(), SIZE);
    let bad = |change: fn(&mut View)| {
        let mut view = good;
        change(&mut view);
        view
    };
    let scene = fixture.scene.clone();
    for (scene, view, expected) in [
        (&elsewhere, good, "of another device"),
        (&scene, bad(|view| view.viewport.width = 0.0), "0x120"),
        (&scene, bad(|view| view.viewport.x = 0.5), "whole pixels"),
        (&scene, bad(|view| view.viewport.height = f32::NAN), "whole pixels"),
        (&scene, bad(|view| view.viewport.x = 60_000.0), "the device supports targets of at most"),
        (&scene, bad(|view| view.viewport.max_depth = f32::NAN), "from 0 to 1"),
        (&scene, bad(|view| (view.viewport.min_depth, view.viewport.max_depth) = (-1.0, 2.0)), "from 0 to 1"),
        (&scene, bad(|view| view.camera = rising()), "rises with distance, the target's falls"),
        (&scene, bad(|view| view.camera.projection = DMat4::ZERO), "projection matrix"),
    ] {
        // SAFETY: recorded outside a render pass, and waited for.
        let made = host
            .run(|cmd| Ok(unsafe { fixture.renderer.prepare(cmd, scene, &view, &splats_alone()) }))
            .unwrap();
        let text = made.unwrap_err().to_string();
        assert!(text.contains(expected), "`{expected}` is not in `{text}`");
    }
    // Rejected frames leave the state unchanged.
    let (colours, _) = fixture.render(&host, &good, &Settings { background: None, ..splats_alone() }, None);
    assert!(colours.iter().any(|colour| colour[3] == 1.0));
    // The engine does not submit to an external device.
    assert!(
        Scene::upload(&fixture.device, &surfels())
            .is_err_and(|error| error.to_string().contains("belongs to a host"))
    );
    drop(scene);
    fixture.destroy(&host);
    drop((elsewhere, other));
    assert_silent(&host);
}
