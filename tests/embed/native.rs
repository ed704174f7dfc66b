//! Surfels in subpasses of the host's render pass: the picture equals the engine's and the composite's, with any seed.

use crate::fixture::{
    Fixture, SIZE, assert_silent, camera, meets, open, rising, sphere, surfels, upload, viewport,
};
use crate::host::Host;
use crate::host::frame::{self, Way};
use crate::host::memory::Counted;
use crate::host::mesh::Mesh;
use crate::host::native::{Kind, Native};
use crate::host::scene::{Corners, parallelogram};
use crate::host::under_way::UnderWay;
use crate::support::sampling::{self, Random};
use crate::{FOUR, ONE};
use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::View;
use surfel::embed::native::Renderer;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Alpha;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Splatting, Visibility};
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Outputs, Picture, Precision, Rasterizer, RenderOptions, Scene, Settings};

pub const D32: vk::Format = vk::Format::D32_SFLOAT;

/// A renderer is `Send`.
#[allow(dead_code, reason = "it compiles, or not")]
fn a_renderer_goes_to_another_thread(renderer: Renderer) -> impl Send {
    renderer
}

/// Float colours, one sample, and reversed depth as seed, between a mesh and fog.
pub const PLAIN: Kind = Kind {
    colour: vk::Format::R32G32B32A32_SFLOAT,
    depth: Some(D32),
    normals: false,
    samples: ONE,
    reversed: true,
    seed: true,
    around: [true, true],
};

pub fn method(name: &str) -> Settings {
    Settings { background: None, ..Method::named(name).unwrap().settings() }
}

/// The engine's frames by the raster path.
fn alone(surfels: &Surfels, settings: &Settings, camera: &Camera, normal: bool, depth: bool) -> Picture {
    let device = Device::open(&DeviceOptions::default()).unwrap();
    let outputs = Outputs { normal, depth, id: false };
    let rasterizer = Some(Rasterizer::Draw);
    let options = RenderOptions { size: SIZE, outputs, rasterizer, ..Default::default() };
    crate::support::gpu::render(&device, surfels, camera, settings, options)
}

/// A frame of a native host.
pub struct Drawn<'a> {
    pub host: &'a Host,
    pub native: Native,
    pub scene: Arc<Scene>,
    pub device: Arc<Device>,
}

impl<'a> Drawn<'a> {
    pub fn new(host: &'a Host, kind: Kind, size: [u32; 2], surfels: &Surfels, settings: &Settings) -> Self {
        let device = host.external_device(None).unwrap();
        let scene = upload(host, &device, surfels);
        let native = Native::new(host, &device, kind, size, &[(scene.streams(), settings)]).unwrap();
        Self { host, native, scene, device }
    }

    /// The same frame twice in a command buffer, so that validation checks their synchronization.
    pub fn render(&mut self, view: &View, settings: &Settings, mesh: Option<&Mesh>, foggy: bool) {
        let Self { host, native, scene, .. } = self;
        let mesh = mesh.map(|mesh| (mesh, Vec3::Y));
        host.run(|cmd| {
            for _ in 0..2 {
                // SAFETY: prepared outside the pass, drawn inside it, and waited for.
                unsafe {
                    native.renderer.prepare(cmd, &*scene, view, settings)?;
                    native.record(host, cmd, (mesh, view), |surfels| surfels.draw(cmd), foggy)?;
                }
            }
            Ok(())
        })
        .unwrap();
    }

    pub fn colours(&self) -> Vec<[f32; 4]> {
        bytemuck::pod_collect_to_vec(&self.native.picture(self.host, 16).unwrap())
    }

    pub fn depths(&self) -> Vec<f32> {
        bytemuck::pod_collect_to_vec(&self.native.depths(self.host, 4).unwrap())
    }

    pub fn normals(&self) -> Vec<[f32; 4]> {
        bytemuck::pod_collect_to_vec(&self.native.normals(self.host).unwrap())
    }

    pub fn destroy(self) {
        self.native.destroy(self.host);
    }
}

/// Colours over nothing: premultiplied.
fn multiplied(colours: &[[f32; 4]]) -> Vec<[f32; 4]> {
    colours.iter().map(|[r, g, b, a]| [a * r, a * g, a * b, *a]).collect()
}

fn count_different(a: &[[f32; 4]], b: &[[f32; 4]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn subpasses_draw_the_engines_own_picture_bit_for_bit() {
    let Some(host) = open(|all| all) else { return };
    let view = View::whole(camera(), SIZE);
    let stencilled = Some(vk::Format::D32_SFLOAT_S8_UINT);
    let kinds = [
        PLAIN,
        Kind { samples: FOUR, ..PLAIN },
        Kind { samples: FOUR, around: [false, false], seed: false, ..PLAIN },
        Kind { depth: stencilled, around: [true, false], ..PLAIN },
        Kind { samples: FOUR, depth: stencilled, around: [false, true], seed: false, ..PLAIN },
    ];
    for name in ["perspective-ewa", "object-ewa", "sprites", "sprites-unfiltered", "confetti"] {
        let settings = method(name);
        let own = alone(&surfels(), &settings, &camera(), false, true);
        assert!(own.colour.iter().filter(|colour| colour[3] == 1.0).count() > 5_000);
        for kind in kinds {
            let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
            drawn.render(&view, &settings, None, false);
            assert_eq!(count_different(&drawn.colours(), &own.colour), 0, "{name} {kind:?}");
            if kind.samples == ONE && kind.depth == Some(D32) {
                // The near plane is at 0.1, and the depth is 0.1 over the distance.
                for (found, distance) in drawn.depths().iter().zip(own.depth.as_ref().unwrap()) {
                    let exact = if *distance == 0.0 { 0.0 } else { 0.1 / f64::from(*distance) };
                    assert!((f64::from(*found) - exact).abs() <= 1.5e-7 * exact, "{found} {exact}");
                }
            }
            drawn.destroy();
        }
    }
    assert_silent(&host);
}

#[test]
fn clips_coverage_normals_and_parallel_rays_are_the_engines_own_too() {
    let Some(host) = open(|all| all) else { return };
    let mut random = Random(11);
    let mut clipped = surfels();
    sampling::clip(&mut clipped, &mut random);
    let mut painted = surfels();
    sampling::paint_linear(&mut painted, &mut random);
    sampling::stretch(&mut painted, &mut random);
    sampling::forget_sides(&mut painted, 0.3, &mut random);
    let parallel =
        Camera::orthographic([DVec3::new(1.1, 0.9, 3.0), DVec3::ZERO, DVec3::Y], 2.6, 4.0 / 3.0, [0.5, 9.0])
            .unwrap();
    let axis = Settings {
        splatting: Splatting { visibility: Visibility::Axis, ..Splatting::default() },
        ..method("perspective-ewa")
    };
    let covering = |name| Settings { alpha: Alpha::Coverage, ..method(name) };
    let bare = Kind { depth: None, around: [true, false], ..PLAIN };
    let cases = [
        ("clipped", &clipped, covering("perspective-ewa"), PLAIN),
        ("clipped", &clipped, method("object-ewa"), PLAIN),
        ("painted", &painted, covering("sprites-unfiltered"), Kind { samples: FOUR, ..PLAIN }),
        ("painted", &painted, axis, PLAIN),
        ("painted", &painted, method("perspective-ewa"), bare),
        ("painted", &painted, covering("perspective-ewa"), bare),
        ("painted", &painted, method("sprites-unfiltered"), bare),
    ];
    for (name, surfels, settings, kind) in cases {
        for (camera, normals) in [(camera(), kind.samples == ONE), (parallel, false)] {
            let own = alone(surfels, &settings, &camera, normals, kind.depth.is_some());
            let kind = Kind { normals, ..kind };
            let mut drawn = Drawn::new(&host, kind, SIZE, surfels, &settings);
            drawn.render(&View::whole(camera, SIZE), &settings, None, false);
            let expected = multiplied(&own.colour);
            assert!(expected.iter().filter(|colour| colour[3] > 0.0).count() > 4_000);
            assert_eq!(count_different(&drawn.colours(), &expected), 0, "{name} {settings:?} {kind:?}");
            if let (true, Some(normal)) = (normals, own.normal) {
                let seen = own.colour.iter().zip(normal);
                let expected: Vec<_> = seen
                    .map(|(colour, [x, y, z])| if colour[3] > 0.0 { [x, y, z, 1.0] } else { [0.0; 4] })
                    .collect();
                assert_eq!(count_different(&drawn.normals(), &expected), 0, "{name} {kind:?}");
            }
            drawn.destroy();
        }
    }
    assert_silent(&host);
}

#[test]
fn a_viewport_is_anywhere_and_runs_any_way() {
    let Some(host) = open(|all| all) else { return };
    let settings = Settings { alpha: Alpha::Coverage, ..method("perspective-ewa") };
    let own = multiplied(&alone(&surfels(), &settings, &camera(), false, true).colour);
    let larger = [SIZE[0] + 37, SIZE[1] + 11];
    let at = vk::Viewport { x: 30.0, y: 8.0, min_depth: 0.25, max_depth: 0.75, ..viewport(SIZE) };
    let over = vk::Viewport { y: at.y + at.height, height: -at.height, ..at };
    let mut up = camera();
    up.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * up.projection;
    for (camera, viewport, reversed) in [(camera(), at, true), (up, over, true), (rising(), at, false)] {
        let kind = Kind { reversed, ..PLAIN };
        let mut drawn = Drawn::new(&host, kind, larger, &surfels(), &settings);
        drawn.render(&View { camera, viewport }, &settings, None, false);
        let mut seen = 0;
        for (i, colour) in drawn.colours().iter().enumerate() {
            let [x, y] = [i % larger[0] as usize, i / larger[0] as usize].map(|at| at as i64);
            let inside = (0..160).contains(&(x - 30)) && (0..120).contains(&(y - 8));
            let expected = if inside { own[((y - 8) * 160 + x - 30) as usize] } else { [0.0; 4] };
            assert_eq!(*colour, expected, "{x} {y}");
            seen += usize::from(colour[3] > 0.0);
        }
        assert!(seen > 5_000);
        drawn.destroy();
    }
    assert_silent(&host);
}

/// A parallelogram through the sphere: its centre and the halves of its sides, orthogonal for `meets`.
fn plane() -> (DVec3, [DVec3; 2]) {
    let (centre, sides) =
        (DVec3::new(0.1, 0.05, 0.2), [DVec3::new(1.4, 0.2, 0.1), DVec3::new(0.0, 0.3, -1.1)]);
    (centre, [sides[0], sides[1] - sides[1].dot(sides[0]) / sides[0].length_squared() * sides[0]])
}

/// The composite's picture of the same scene.
fn composited(
    host: &Host,
    kind: Kind,
    view: &View,
    settings: &Settings,
    surfels: &Surfels,
    mesh: &Corners,
) -> Vec<[f32; 4]> {
    let Kind { colour, samples, reversed, .. } = kind;
    let kind = frame::Kind { way: Way::Subpass, colour, normals: false, samples, reversed };
    let mut fixture = Fixture::new(host, kind, SIZE, Some(Rasterizer::Draw), surfels);
    let mesh = Mesh::new(host, mesh, fixture.frame.mesh_target()).unwrap();
    let (colours, _) = fixture.render(host, view, settings, Some(&mesh));
    mesh.destroy(host);
    fixture.destroy(host);
    colours
}

#[test]
fn among_the_hosts_surfaces_the_picture_is_the_composites_and_the_references() {
    let Some(host) = open(|all| all) else { return };
    let (centre, sides) = plane();
    let corners = parallelogram(centre.as_vec3(), sides.map(|side| side.as_vec3()));
    let settings = method("perspective-ewa");
    let reference = surfel::verify::reference::render(&surfels(), &camera(), SIZE, &settings, &()).unwrap();
    let height = SIZE[1] as f32;
    let plain = viewport(SIZE);
    let turned = vk::Viewport { y: height, height: -height, min_depth: 0.25, max_depth: 0.75, ..plain };
    let mut up = camera();
    up.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * up.projection;
    let views = [(true, camera(), plain), (false, rising(), plain), (true, up, turned)];
    let alike =
        [(ONE, true), (ONE, false), (FOUR, true)].map(|(samples, seed)| Kind { samples, seed, ..PLAIN });
    for (kind, (reversed, camera, viewport)) in
        alike.into_iter().flat_map(|kind| views.map(|view| (kind, view)))
    {
        let kind = Kind { reversed, ..kind };
        let view = View { camera, viewport };
        let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
        let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
        drawn.render(&view, &settings, Some(&mesh), false);
        let colours = drawn.colours();
        let other = composited(&host, kind, &view, &settings, &surfels(), &corners);
        if kind.samples == ONE {
            let (mut counts, mut wrong) = ([[0; 2]; 2], 0);
            for (i, colour) in colours.iter().enumerate() {
                let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
                let surfel = reference.covered[i].then_some(reference.depth[i]);
                let of_host = meets(&self::camera(), at, centre, sides);
                let is_surfel = surfel.is_some_and(|z| of_host.is_none_or(|of_host| z <= of_host));
                let is_host = !is_surfel && of_host.is_some();
                let found = [colour[3] > 0.0 && !is_blue(colour), is_blue(colour)];
                wrong += usize::from(found != [is_surfel, is_host]);
                counts[usize::from(surfel.is_some() && of_host.is_some())][usize::from(is_host)] += 1;
            }
            assert!(counts[1].iter().all(|count| *count > 500), "either hides the other: {counts:?}");
            println!("{kind:?}: {wrong} px of {} differ from the reference", colours.len());
            assert!(wrong * 1000 <= colours.len(), "{wrong} px");
        }
        assert_eq!(count_different(&colours, &other), 0, "{kind:?} {viewport:?}");
        mesh.destroy(&host);
        drawn.destroy();
    }
    assert_silent(&host);
}

/// Whether a pixel shows the host's mesh, the only blue surface.
fn is_blue(colour: &[f32; 4]) -> bool {
    colour[3] > 0.0 && colour[2] > 1.5 * colour[0]
}

/// Difficult scenes, with a wall of the host through them.
#[test]
#[ignore = "takes long: tools/test --all"]
fn in_hard_scenes_the_picture_is_the_composites() {
    let Some(host) = open(|all| all) else { return };
    for case in crate::support::scenes::cases() {
        let settings = Settings { background: None, ..case.settings.clone() };
        let [mut different, mut shown] = [0; 2];
        let cameras = 0..2;
        for camera in &case.cameras[cameras] {
            let bounds = case.surfels.bounds().unwrap();
            let back = camera.view.inverse();
            let size = 0.25 * (bounds.max - bounds.min).length();
            let sides = [DVec3::X, DVec3::new(0.0, 0.7, 0.7)];
            let sides = sides.map(|side| (size * back.transform_vector3(side)).as_vec3());
            let corners = parallelogram(bounds.centre().as_vec3(), sides);
            let view = View::whole(*camera, SIZE);
            let kind = Kind { reversed: camera.reversed, ..PLAIN };
            let other = composited(&host, kind, &view, &settings, &case.surfels, &corners);
            for seed in [true, false] {
                let mut drawn = Drawn::new(&host, Kind { seed, ..kind }, SIZE, &case.surfels, &settings);
                let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
                drawn.render(&view, &settings, Some(&mesh), false);
                for (found, other) in drawn.colours().iter().zip(&other) {
                    shown += usize::from(seed && other[3] > 0.0);
                    if found != other {
                        // The host hides edge-on discs.
                        assert!(seed && is_blue(found), "{}: {found:?} {other:?}", case.name);
                        different += 1;
                    }
                }
                mesh.destroy(&host);
                drawn.destroy();
            }
        }
        println!("{}: {different} px of {shown} differ", case.name);
        // One scene has edge-on discs only.
        assert!(case.name == "edge-on" || 1000 * different <= shown, "{}", case.name);
    }
    assert_silent(&host);
}

#[test]
fn a_later_subpass_of_the_host_sees_the_depth_of_surfels() {
    let Some(host) = open(|all| all) else { return };
    let (settings, view) = (method("perspective-ewa"), View::whole(camera(), SIZE));
    let mut drawn = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings);
    drawn.render(&view, &settings, None, false);
    let (clear, depths) = (drawn.colours(), drawn.depths());
    drawn.render(&view, &settings, None, true);
    for ((foggy, clear), depth) in drawn.colours().iter().zip(clear).zip(depths) {
        let fog = (-crate::host::fog::DENSITY * depth).exp();
        for k in 0..3 {
            let expected = fog * crate::host::fog::COLOUR[k] + (1.0 - fog) * clear[k];
            assert!((foggy[k] - expected).abs() < 1e-5, "{foggy:?} {clear:?} {depth}");
        }
    }
    drawn.destroy();
    assert_silent(&host);
}

/// Number of fragments of each subpass that pass the tests.
fn count_fragments(drawn: &mut Drawn<'_>, view: &View, settings: &Settings, mesh: &Mesh) -> Vec<u64> {
    let Drawn { host, native, scene, .. } = drawn;
    let first = u32::from(native.kind.around[0]);
    let count = native.renderer.plan().subpasses().len() as u32;
    let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::OCCLUSION).query_count(count);
    // SAFETY: a query begins and ends in each subpass, and all are waited for.
    unsafe {
        let device = &host.device;
        let pool = device.create_query_pool(&info, None).unwrap();
        host.run(|cmd| {
            device.cmd_reset_query_pool(cmd, pool, 0, count);
            native.renderer.prepare(cmd, &*scene, view, settings)?;
            let mesh = Some((mesh, Vec3::Y));
            let each = |surfels: &Renderer| {
                surfels.draw_each(|subpass| {
                    if subpass > first {
                        device.cmd_end_query(cmd, pool, subpass - first - 1);
                    }
                    device.cmd_next_subpass(cmd, vk::SubpassContents::INLINE);
                    device.cmd_begin_query(cmd, pool, subpass - first, vk::QueryControlFlags::PRECISE);
                    cmd
                })?;
                device.cmd_end_query(cmd, pool, count - 1);
                Ok(())
            };
            native.record(host, cmd, (mesh, view), each, false)
        })
        .unwrap();
        let mut found = vec![0u64; count as usize];
        let wait = vk::QueryResultFlags::WAIT | vk::QueryResultFlags::TYPE_64;
        device.get_query_pool_results(pool, 0, &mut found, wait).unwrap();
        device.destroy_query_pool(pool, None);
        found
    }
}

#[test]
fn splats_that_the_host_hides_are_left_out_early() {
    let Some(host) = open(|all| all) else { return };
    let view = View::whole(camera(), SIZE);
    // Half of the view, in front of everything.
    let before = camera().view.inverse();
    let centre = before.transform_point3(DVec3::new(-1.0, 0.0, 1.0)).as_vec3();
    let sides = [DVec3::X, DVec3::Y].map(|side| before.transform_vector3(side).as_vec3());
    let corners = parallelogram(centre, sides);
    for name in ["perspective-ewa", "sprites-unfiltered"] {
        let settings = method(name);
        let counts = [true, false].map(|seed| {
            let kind = Kind { seed, ..PLAIN };
            let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
            let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
            let counts = count_fragments(&mut drawn, &view, &settings, &mesh);
            mesh.destroy(&host);
            drawn.destroy();
            counts
        });
        let [seeded, plain] = &counts;
        // The first seeded count is the seed's; the last ones draw the visible surfaces, to the host's depth.
        println!("{name}: {seeded:?} fragments, without a seed {plain:?}");
        assert_eq!(seeded[0], u64::from(SIZE[0] * SIZE[1]));
        let last = plain.len() - 1;
        assert_eq!(seeded[last + 1], plain[last]);
        for (with, without) in seeded[1..=last].iter().zip(plain) {
            assert!(10 * with < 7 * without, "{counts:?}");
        }
    }
    assert_silent(&host);
}

#[test]
fn a_thousand_frames_of_all_sizes_and_scenes_leave_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let settings = ["perspective-ewa", "sprites", "confetti"].map(method);
    let covering = Settings { alpha: Alpha::Coverage, ..method("object-ewa") };
    let settings: Vec<_> = settings.into_iter().chain([covering]).collect();
    {
        let scenes = [500, 2_000].map(|count| upload(&host, &device, &sphere(count)));
        let frames: Vec<_> = settings.iter().map(|settings| (scenes[0].streams(), settings)).collect();
        let kind = Kind { samples: FOUR, ..PLAIN };
        let mut native = Native::new(&host, &device, kind, [64, 48], &frames).unwrap();
        let (mut under_way, mut most) = (UnderWay::new(2), 0);
        for number in 0..1000usize {
            // Each size lasts for a few frames.
            let size = [[64, 48], [33, 48], [64, 1]][number / 7 % 3];
            if number > 0 && number % 7 == 0 {
                under_way.finish(&host).unwrap();
                native.resize(&host, size).unwrap();
            }
            let view = View::whole(camera(), size);
            under_way
                .submit(&host, |cmd| {
                    let (scene, settings) = (&scenes[number / 5 % 2], &settings[number / 11 % 4]);
                    // SAFETY: at most two frames are in flight.
                    unsafe {
                        native.renderer.prepare(cmd, scene, &view, settings)?;
                        native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), true)
                    }
                })
                .unwrap();
            most = most.max(counts.alive.load(Ordering::SeqCst));
        }
        under_way.finish(&host).unwrap();
        assert!(most < 80, "{most} pieces of memory at once");
        native.destroy(&host);
    }
    assert_eq!(Arc::strong_count(&device), 1);
    drop(device);
    assert_eq!(counts.alive.load(Ordering::SeqCst), 0);
    assert_silent(&host);
}

/// A plan for several kinds of frames draws each of them, and frames that need less.
#[test]
fn a_plan_for_several_frames_serves_each() {
    let Some(host) = open(|all| all) else { return };
    let device = host.external_device(None).unwrap();
    let mut painted = surfels();
    sampling::paint_linear(&mut painted, &mut Random(5));
    let both = [surfels(), painted];
    let scenes = both.each_ref().map(|surfels| upload(&host, &device, surfels));
    let settings = ["perspective-ewa", "sprites"].map(method);
    let frames = [(scenes[0].streams(), &settings[1]), (scenes[1].streams(), &settings[0])];
    let mut native = Native::new(&host, &device, PLAIN, SIZE, &frames).unwrap();
    let view = View::whole(camera(), SIZE);
    for (surfels, scene) in both.iter().zip(&scenes) {
        for settings in &settings {
            let own = alone(surfels, settings, &camera(), false, true);
            host.run(|cmd| {
                // SAFETY: prepared outside the pass, drawn inside it, and waited for.
                unsafe {
                    native.renderer.prepare(cmd, scene, &view, settings)?;
                    native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), false)
                }
            })
            .unwrap();
            let found: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&native.picture(&host, 16).unwrap());
            assert_eq!(count_different(&found, &own.colour), 0);
        }
    }
    native.destroy(&host);
    drop(scenes);
    assert_silent(&host);
}

/// Without blending of 32-bit floats, both use 16-bit sums.
#[test]
fn sums_of_16_bits_are_the_engines_own_too() {
    let Some(host) = open(|all| all) else { return };
    let settings = method("perspective-ewa");
    let own = Device::open(&DeviceOptions::default()).unwrap();
    let outputs = Outputs { depth: true, ..Outputs::default() };
    let (precision, rasterizer) = (Precision::Half, Some(Rasterizer::Draw));
    let options = RenderOptions { size: SIZE, outputs, precision, rasterizer, ..Default::default() };
    let own = crate::support::gpu::render(&own, &surfels(), &camera(), &settings, options);
    let limits = DeviceLimits { blend_float32: Some(false), ..Default::default() };
    let device = host.external_device_within(limits, None).unwrap();
    let scene = upload(&host, &device, &surfels());
    let frames = [(scene.streams(), &settings)];
    let mut native = Native::new(&host, &device, PLAIN, SIZE, &frames).unwrap();
    let view = View::whole(camera(), SIZE);
    host.run(|cmd| {
        // SAFETY: prepared outside the pass, drawn inside it, and waited for.
        unsafe {
            native.renderer.prepare(cmd, &scene, &view, &settings)?;
            native.record(&host, cmd, (None, &view), |surfels| surfels.draw(cmd), false)
        }
    })
    .unwrap();
    let found: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&native.picture(&host, 16).unwrap());
    assert_eq!(count_different(&found, &own.colour), 0);
    native.destroy(&host);
    drop(scene);
    assert_silent(&host);
}
