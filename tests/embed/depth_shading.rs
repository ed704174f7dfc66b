//! Eye-dome lighting and ambient occlusion after a native host's render pass: the engine's own, and the reference's of the depth that is there.

use crate::FOUR;
use crate::fixture::{SIZE, assert_silent, camera, open, rising, surfels, viewport};
use crate::host::Host;
use crate::host::darkening::Darkening;
use crate::host::frame::Way;
use crate::host::mesh::Mesh;
use crate::host::native::Kind;
use crate::host::scene::parallelogram;
use crate::host::under_way::UnderWay;
use crate::native_rig::{D32, Drawn, PLAIN, count_different, method};
use crate::support::after_light::after_light;
use crate::support::if_whole;
use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use surfel::embed::native::Renderer;
use surfel::embed::{Measured, View};
use surfel::geometry::srgb::{decode, encode};
use surfel::geometry::{Camera, Surfels};
use surfel::settings::{Alpha, Shading};
use surfel::verify::reference::Projector;
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, RenderOptions, Settings};

/// Half a unit in the last place of a float32 near 1.
const ROUNDING: f64 = 1.0 / (1 << 24) as f64;

/// With eye-dome lighting, with ambient occlusion, and with both, as the engine's own pictures have them.
fn kinds() -> [Settings; 3] {
    let plain = Settings { alpha: Alpha::Mask, ..method("perspective-ewa") };
    let edl = Settings { shading: Shading::Edl, edl: 0.5, ..plain.clone() };
    [edl.clone(), Settings { ao: 1.0, ..plain }, Settings { ao: 2.0, ..edl }]
}

/// Bound of the errors of a factor whose distances have errors of `units` half units in the last place.
fn tolerance(camera: &Camera, size: [u32; 2], settings: &Settings, units: f64) -> f64 {
    let projection = camera.projection;
    let [x, y] = [projection.x_axis.x, projection.y_axis.y].map(f64::abs);
    let pixel_width = (2.0 / (x * f64::from(size[0]))).max(2.0 / (y * f64::from(size[1])));
    // In parallel projection, surfaces are at most 5 away.
    let distance = if projection.row(3).z == 0.0 { 5.0 } else { 1.0 };
    // Error of the difference of two distances in widths of a pixel.
    let rise = 2.0 * units * ROUNDING * distance / pixel_width;
    let edl = if settings.shading == Shading::Edl {
        // As in the engine's own frames, beside the error of a mean of rises.
        30.0 * ROUNDING + f64::from(settings.edl) * rise
    } else {
        0.0
    };
    // The sine of the angle to a sample, two pixels away or more, is wrong by that; where it is near 1, its part of the occlusion in one of the
    // 16 blocks around a pixel is wrong by the square root of twice as much.
    let ao = f64::from(settings.ao) * (2.0 * (40.0 * ROUNDING + 0.5 * rise)).sqrt() / 16.0;
    edl + ao
}

/// The factors of a picture of these distances, 0 without a surface; and the bound of their errors.
fn factors(camera: &Camera, size: [u32; 2], settings: &Settings, distances: &[f64]) -> (Vec<f64>, f64) {
    let projector = Projector::new(camera, size, settings).unwrap();
    let white = vec![[1.0; 4]; distances.len()];
    let dark = after_light(&projector, settings, white, distances, size);
    (dark.iter().map(|colour| colour[0]).collect(), tolerance(camera, size, settings, 4.0))
}

/// A native host's frame with the pass after it.
struct Shaded<'a> {
    drawn: Drawn<'a>,
    darkening: Darkening,
}

impl<'a> Shaded<'a> {
    fn new(host: &'a Host, kind: Kind, way: Way, surfels: &Surfels) -> Self {
        let [_, lit, _] = kinds();
        let drawn = Drawn::new(host, kind, SIZE, surfels, &lit);
        let darkening = Darkening::new(host, &drawn.device, &drawn.native, way).unwrap();
        Self { drawn, darkening }
    }

    fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        (view, settings): (&View, &Settings),
        (mesh, surfels, dark): (Option<&Mesh>, bool, bool),
    ) -> crate::host::Result<()> {
        let Drawn { host, native, scene, .. } = &mut self.drawn;
        // SAFETY: prepared outside the pass, and drawn inside it.
        unsafe {
            native.renderer.prepare(cmd, &*scene, view, settings)?;
            let mesh = mesh.map(|mesh| (mesh, Vec3::Y));
            let draw = |own: &Renderer| {
                if surfels {
                    return own.draw(cmd);
                }
                own.skip(cmd);
                Ok(())
            };
            native.record(host, cmd, (mesh, view), draw, false)?;
        }
        if dark { self.darkening.record(host, cmd, native, (view, settings)) } else { Ok(()) }
    }

    /// The colours of a frame, with a mesh and with surfels where they are given. It is recorded twice, so that validation checks their
    /// synchronization.
    fn colours(
        &mut self,
        view: &View,
        settings: &Settings,
        contents: (Option<&Mesh>, bool, bool),
    ) -> Vec<[f32; 4]> {
        let host = self.drawn.host;
        host.run(|cmd| {
            self.record(cmd, (view, settings), contents)?;
            self.record(cmd, (view, settings), contents)
        })
        .unwrap();
        self.drawn.colours()
    }

    fn destroy(self) {
        self.darkening.destroy(self.drawn.host);
        self.drawn.destroy();
    }
}

/// Largest difference of colours from those before, times their factors; α stays.
fn difference(before: &[[f32; 4]], after: &[[f32; 4]], factors: &[f64]) -> f64 {
    assert!(before.len() == after.len() && before.len() == factors.len());
    let pixels = before.iter().zip(after).zip(factors);
    let channels = pixels.flat_map(|((before, after), factor)| {
        (0..4).map(move |k| {
            let factor = if k == 3 { 1.0 } else { *factor };
            (f64::from(after[k]) - f64::from(before[k]) * factor).abs()
        })
    });
    channels.fold(0.0, |most, one| if one.is_nan() || one > most { one } else { most })
}

#[test]
fn surfels_are_darkened_as_in_the_engines_own_pictures() {
    let Some(host) = open(|all| all) else { return };
    let view = View::whole(camera(), SIZE);
    let device = crate::support::gpu::device(DeviceLimits::default()).unwrap();
    let rasterizer = Some(Rasterizer::Draw);
    let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
    let own = kinds().map(|settings| {
        crate::support::gpu::render(&device, &surfels(), &camera(), &settings, options).colour
    });
    let four = Kind { samples: FOUR, ..PLAIN };
    // Every kind in the everyday test, in a render pass.
    let cases = [
        (PLAIN, Way::Subpass, 0..3),
        (PLAIN, Way::Rendering, if_whole(0..3, 0..1)),
        (four, Way::Subpass, if_whole(0..3, 2..3)),
    ];
    for (kind, way, some) in cases {
        let mut shaded = Shaded::new(&host, kind, way, &surfels());
        for (settings, own) in kinds()[some.clone()].iter().zip(&own[some]) {
            let plain = shaded.colours(&view, settings, (None, true, false));
            let found = shaded.colours(&view, settings, (None, true, true));
            // The host's depths are rounded, too.
            let tolerance = tolerance(&camera(), SIZE, settings, 6.0);
            let same = vec![1.0; own.len()];
            let premultiplied = crate::native::multiplied(own);
            let (most, dark) = (difference(&premultiplied, &found, &same), difference(&plain, &found, &same));
            println!("{kind:?} {way:?}: {most:.1e} of {tolerance:.1e}, darker by {dark:.2}");
            assert!(most <= tolerance && dark > 20.0 * tolerance, "{most} {dark}");
        }
        shaded.destroy();
    }
    assert_silent(&host);
}

/// A part of a picture, row by row.
fn crop<T: Copy>(values: &[T], [x, y, width, height]: [usize; 4]) -> Vec<T> {
    (y..y + height).flat_map(|row| &values[row * SIZE[0] as usize + x..][..width]).copied().collect()
}

/// Distances of the host's depths within the viewport; 0 at the far plane and beyond.
fn distances(camera: &Camera, viewport: vk::Viewport, depths: &[f64]) -> Vec<f64> {
    let back = camera.projection.inverse();
    let [first, last] = [viewport.min_depth, viewport.max_depth].map(f64::from);
    let distance = |depth: &f64| {
        let depth = (depth - first) / (last - first);
        let is_empty = if camera.reversed { depth <= 1e-6 } else { depth >= 1.0 - 1e-6 };
        if is_empty { 0.0 } else { back.project_point3(DVec3::new(0.0, 0.0, depth)).z }
    };
    depths.iter().map(distance).collect()
}

/// A view of the sphere in parallel projection.
fn parallel() -> Camera {
    let eye = DVec3::new(1.1, 0.9, 3.0);
    Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 2.6, 4.0 / 3.0, [0.1, 10.0]).unwrap()
}

/// A parallelogram through the sphere.
fn plane(host: &Host, shaded: &Shaded<'_>) -> Mesh {
    let sides = [Vec3::new(1.4, 0.2, 0.1), Vec3::new(0.1, 0.3, -1.1)];
    let corners = parallelogram(Vec3::new(0.1, 0.05, 0.2), sides);
    Mesh::new(host, &corners, shaded.drawn.native.mesh_target()).unwrap()
}

#[test]
fn the_hosts_surfaces_and_surfels_are_darkened_by_the_depth_that_is_there() {
    let Some(host) = open(|all| all) else { return };
    let plain = viewport(SIZE);
    // A part of the target, upside down, in a part of the depths.
    let turned =
        vk::Viewport { x: 21.0, y: 110.0, width: 127.0, height: -95.0, min_depth: 0.25, max_depth: 0.75 };
    let mut up = camera();
    up.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * up.projection;
    let stencilled = vk::Format::D32_SFLOAT_S8_UINT;
    let cases = [
        (camera(), camera(), plain, D32),
        (rising(), rising(), plain, D32),
        (up, camera(), turned, stencilled),
        (parallel(), parallel(), plain, D32),
        (parallel(), parallel(), plain, vk::Format::D16_UNORM),
    ];
    for (i, (camera, upright, viewport, depth)) in cases.into_iter().enumerate() {
        if !host.has_depth(depth) {
            println!("no {depth:?}");
            continue;
        }
        let kind = Kind { reversed: camera.reversed, depth: Some(depth), ..PLAIN };
        let view = View { camera, viewport };
        let mut shaded = Shaded::new(&host, kind, Way::Subpass, &surfels());
        // The background is not darkened: along outlines it would be.
        shaded.drawn.native.clear_to([0.5, 0.5, 0.25, 0.5]);
        let mesh = plane(&host, &shaded);
        let contents = |dark| (Some(&mesh), true, dark);
        let height = viewport.height.abs();
        let area = [viewport.x, viewport.y.min(viewport.y + viewport.height), viewport.width, height];
        let area = area.map(|side| side as usize);
        let size = [area[2] as u32, area[3] as u32];
        // Every kind in the everyday test, with some view.
        for settings in &kinds()[if_whole(0..3, 2 * i % 3..2 * i % 3 + 1)] {
            let before = shaded.colours(&view, settings, contents(false));
            let depths = crop(&shaded.drawn.native.read_depths(&host).unwrap(), area);
            let distances = distances(&upright, viewport, &depths);
            let after = shaded.colours(&view, settings, contents(true));
            let (factors, tolerance) = factors(&upright, size, settings, &distances);
            let (inside, dark) = (crop(&before, area), crop(&after, area));
            let most = difference(&inside, &dark, &factors);
            let darkened = |blue: bool| {
                let pixels = inside.iter().zip(&factors);
                pixels.filter(|(c, f)| **f < 0.9 && (c[2] > 1.5 * c[0]) == blue && c[3] > 0.0).count()
            };
            let counts = [true, false].map(darkened);
            println!("{depth:?} {viewport:?} {counts:?}: {most:.1e} of {tolerance:.1e}");
            assert!(most <= tolerance, "{most}");
            assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
            // Beyond the viewport nothing changes.
            let changed = count_different(&before, &after);
            assert!(changed > 0 && changed == count_different(&inside, &dark));
        }
        mesh.destroy(&host);
        shaded.destroy();
    }
    assert_silent(&host);
}

#[test]
fn of_several_samples_the_nearest_is_a_pixels_surface() {
    let Some(host) = open(|all| all) else { return };
    let (view, [edl, ..]) = (View::whole(camera(), SIZE), kinds());
    let mut shaded = Shaded::new(&host, Kind { samples: FOUR, ..PLAIN }, Way::Subpass, &surfels());
    // A wall two units in front of the eye, with slanted edges.
    let before = camera().view.inverse();
    let centre = before.transform_point3(DVec3::new(-0.4, 0.1, 1.5)).as_vec3();
    let sides = [DVec3::new(0.5, 0.1, 0.0), DVec3::new(0.13, -0.4, 0.0)];
    let corners = parallelogram(centre, sides.map(|side| before.transform_vector3(side).as_vec3()));
    let mesh = Mesh::new(&host, &corners, shaded.drawn.native.mesh_target()).unwrap();
    let wall = shaded.colours(&view, &edl, (Some(&mesh), false, false));
    let partly = wall.iter().filter(|colour| colour[3] > 0.0 && colour[3] < 1.0).count();
    assert!(partly > 50, "{partly} px show a part of the wall");
    let plain = shaded.colours(&view, &edl, (Some(&mesh), true, false));
    let dark = shaded.colours(&view, &edl, (Some(&mesh), true, true));
    let mut single = Drawn::new(&host, PLAIN, SIZE, &surfels(), &edl);
    single.render(&view, &edl, None, false);
    let near = 0.1;
    let behind =
        single.depths().into_iter().map(|depth| if depth > 0.0 { near / f64::from(depth) } else { 0.0 });
    let distances: Vec<_> =
        behind.zip(&wall).map(|(behind, wall)| if wall[3] > 0.0 { 1.5 } else { behind }).collect();
    let (factors, tolerance) = factors(&camera(), SIZE, &edl, &distances);
    let most = difference(&plain, &dark, &factors);
    println!("{partly} px show a part of the wall: {most:.1e} of {tolerance:.1e}");
    assert!(most <= tolerance, "{most}");
    mesh.destroy(&host);
    single.destroy();
    shaded.destroy();
    assert_silent(&host);
}

/// A target in an sRGB format is darkened in linear light: each code is at most one off, half from the one before and half from its own rounding.
#[test]
fn srgb_targets_are_darkened_in_linear_light() {
    let Some(host) = open(|all| all) else { return };
    let (view, [edl, ..]) = (View::whole(camera(), SIZE), kinds());
    let kind = Kind { colour: vk::Format::R8G8B8A8_SRGB, ..PLAIN };
    let mut shaded = Shaded::new(&host, kind, Way::Subpass, &surfels());
    let [before, after] = [false, true].map(|dark| {
        host.run(|cmd| shaded.record(cmd, (&view, &edl), (None, true, dark))).unwrap();
        shaded.drawn.native.picture(&host, 4).unwrap()
    });
    let depths = shaded.drawn.native.read_depths(&host).unwrap();
    let (factors, _) = factors(&camera(), SIZE, &edl, &distances(&camera(), viewport(SIZE), &depths));
    let (mut most, mut dark) = (0.0f64, 0);
    for ((before, after), factor) in before.chunks_exact(4).zip(after.chunks_exact(4)).zip(factors) {
        let [code, found] = [before[0], after[0]].map(|code| f64::from(code) / 255.0);
        most = most.max(255.0 * (encode(factor * decode(code)) - found).abs());
        dark += usize::from(factor < 0.8 && code > 0.0);
        assert_eq!(before[3], after[3]);
    }
    println!("{dark} px: codes are at most {most:.2} off");
    assert!(dark > 500 && most <= 1.0, "{dark} px, {most}");
    shaded.destroy();
    assert_silent(&host);
}

#[test]
fn without_either_setting_the_picture_stays_as_it_is() {
    let Some(host) = open(|all| all) else { return };
    let view = View::whole(camera(), SIZE);
    let mut shaded = Shaded::new(&host, PLAIN, Way::Subpass, &surfels());
    let normals = Settings { shading: Shading::Normal, ao: 1.0, ..method("perspective-ewa") };
    for settings in [method("perspective-ewa"), normals] {
        let before = shaded.colours(&view, &settings, (None, true, false));
        let after = shaded.colours(&view, &settings, (None, true, true));
        assert!(before.iter().any(|colour| colour[3] > 0.0));
        assert_eq!(count_different(&before, &after), 0);
    }
    shaded.destroy();
    assert_silent(&host);
}

/// Frames of two sizes and settings take turns, two in flight: none uses what another has replaced. The times are those of its passes.
#[test]
fn frames_in_flight_keep_their_images() {
    let Some(host) = open(|all| all) else { return };
    let mut shaded = Shaded::new(&host, PLAIN, Way::Subpass, &surfels());
    shaded.darkening.shading.measure(Measured { times: true, counts: false });
    let whole = View::whole(camera(), SIZE);
    let part = View { viewport: vk::Viewport { width: 96.0, height: 72.0, ..viewport(SIZE) }, ..whole };
    let [edl, _, both] = kinds();
    let turns = [(&whole, &both), (&part, &edl)];
    let alone = turns.map(|(view, settings)| shaded.colours(view, settings, (None, true, true)));
    shaded.darkening.shading.make_pipelines(&whole, &both).unwrap();
    let mut frames = UnderWay::new(2);
    for turn in 0..5 {
        let frame = turns[turn % 2];
        frames.submit(&host, |cmd| shaded.record(cmd, frame, (None, true, true))).unwrap();
    }
    frames.finish(&host).unwrap();
    assert_eq!(count_different(&shaded.drawn.colours(), &alone[0]), 0);
    assert!(count_different(&alone[0], &alone[1]) > 1000);
    // SAFETY: all frames are over.
    unsafe { shaded.darkening.shading.finish() }.unwrap();
    let report = shaded.darkening.shading.report().unwrap();
    let labels: Vec<_> = report.pass_times.iter().map(|time| time.label).collect();
    assert_eq!(labels, ["distance", "occlusion", "ambient", "edl", "darken"]);
    shaded.destroy();
    assert_silent(&host);
}
