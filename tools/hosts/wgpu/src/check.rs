//! Comparison of the host's frames with the engine's.

use crate::Result;
use crate::arguments::Arguments;
use crate::demo::{Demo, PANE, Parts, SURFELS};
use crate::frame::Frame;
use crate::gpu::{Gpu, instance};
use crate::scene::{SIZE, camera, sphere};
use glam::DVec3;
use surfel::geometry::Camera;
use surfel::settings::Alpha;
use surfel::settings::methods::Method;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Outputs, Picture, RenderOptions, Renderer, Scene, Settings};

const METHODS: [&str; 3] = ["perspective-ewa", "sprites-unfiltered", "pull-push"];
const NOTHING: Parts = Parts { ring: false, surfels: false, glass: false };
/// Relative depth difference of sums with another order of terms.
const ORDER: f32 = 2e-5;

/// A frame on the CPU: sRGB codes, and single-sample depths.
struct Shot {
    colours: Vec<[u8; 4]>,
    depths: Vec<f32>,
}

/// Compares frames of several methods; an error if they differ.
pub fn all() -> Result<()> {
    let gpu = Gpu::open(&instance()?, None)?;
    let name = gpu.adapter.get_info().name;
    let device = Device::open(&DeviceOptions { select: Some(name), ..Default::default() })?;
    for method in METHODS {
        let settings = Method::named(method).ok_or("no such method")?.settings();
        // Soft outlines blend with the ring, and have depth in part only.
        let settings = Settings { background: None, alpha: Alpha::Mask, ..settings };
        let own = own(&device, &settings)?;
        for samples in [1, 4] {
            let frame = Frame::new(&gpu, SIZE, samples);
            let mut demo = Demo::new(&gpu, &Arguments::default(), samples)?;
            demo.settings = settings.clone();
            demo.embedded.attach(&frame)?;
            let mut shoot = |parts| shot(&gpu, &frame, &mut demo, parts);
            let surfels = shoot(Parts { surfels: true, ..NOTHING })?;
            alone(&surfels, &own).map_err(|error| format!("{method}, {samples} samples: {error}"))?;
            if samples == 1 {
                let ring = shoot(Parts { ring: true, ..NOTHING })?;
                let both = shoot(Parts { ring: true, surfels: true, glass: false })?;
                let all = shoot(Parts { ring: true, surfels: true, glass: true })?;
                let counts = [among(&ring, &surfels, &both), glass(&both, &all)];
                let [among, glass] = counts.map(|made| made.map_err(|error| format!("{method}: {error}")));
                println!("{method}: {}; {}", among?, glass?);
            }
        }
    }
    Ok(())
}

/// The engine's frame.
fn own(device: &std::sync::Arc<Device>, settings: &Settings) -> Result<Picture> {
    let outputs = Outputs { depth: true, ..Default::default() };
    let mut renderer = Renderer::new(device, RenderOptions { size: SIZE, outputs, ..Default::default() })?;
    let scene = Scene::upload(device, &sphere(SURFELS))?;
    Ok(renderer.render_picture(&scene, &camera(0.0, SIZE)?, settings)?.0)
}

fn shot(gpu: &Gpu, frame: &Frame, demo: &mut Demo, parts: Parts) -> Result<Shot> {
    gpu.queue.submit(demo.record(gpu, frame, &camera(0.0, SIZE)?, parts)?);
    let colours = bytemuck::pod_collect_to_vec(&frame.read(gpu, frame.picture())?);
    let depths = if frame.samples == 1 { frame.read(gpu, &frame.depth)? } else { Vec::new() };
    Ok(Shot { colours, depths: bytemuck::pod_collect_to_vec(&depths) })
}

/// Checks that surfels alone equal the engine's up to one code, and that their depth is 0.1 over the distance.
fn alone(found: &Shot, own: &Picture) -> Result<()> {
    let coded = |linear: f32| {
        let linear = linear.clamp(0.0, 1.0);
        let coded =
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        (255.0 * coded).round() as u8
    };
    let wrong = found.colours.iter().zip(&own.colour).filter(|(found, own)| {
        let [r, g, b, a] = **own;
        let expected = [r, g, b].map(|linear| coded(linear * a));
        (0..3).any(|i| found[i].abs_diff(expected[i]) > 1)
    });
    let wrong = wrong.count();
    let distances = own.depth.as_ref().ok_or("the engine gave no depths")?;
    let off = found.depths.iter().zip(distances).filter(|(found, distance)| {
        let expected = if **distance == 0.0 { 0.0 } else { 0.1 / **distance };
        (**found - expected).abs() > (ORDER + 3e-7) * expected
    });
    let off = off.count();
    let covered = own.colour.iter().filter(|colour| colour[3] == 1.0).count();
    match (wrong, off, covered) {
        (0, 0, 100_000..) => Ok(()),
        _ => Err(format!("{wrong} colours and {off} depths of {covered} pixels are not the engine's").into()),
    }
}

/// Checks that each pixel of both shows the nearer one of ring and surfels.
fn among(ring: &Shot, surfels: &Shot, both: &Shot) -> Result<String> {
    let (mut hidden, mut wrong) = ([0, 0], 0);
    for i in 0..both.colours.len() {
        let depths = [ring.depths[i], surfels.depths[i]];
        let nearer = depths[0].max(depths[1]);
        let close = |a: f32, b: f32| (a - b).abs() <= ORDER * nearer;
        let is_of = |shot: &Shot| (0..3).all(|c| shot.colours[i][c].abs_diff(both.colours[i][c]) <= 1);
        let tie = close(depths[0], depths[1]);
        let of_ring = is_of(ring) && (depths[0] >= depths[1] || tie);
        let of_surfels = is_of(surfels) && (depths[1] >= depths[0] || tie);
        wrong += usize::from(!(of_ring || of_surfels) || !close(both.depths[i], nearer));
        if depths[0].min(depths[1]) > 0.0 {
            hidden[usize::from(depths[0] > depths[1])] += 1;
        }
    }
    let [ring, surfels] = hidden;
    match (wrong, ring.min(surfels)) {
        (0, 5_000..) => {
            Ok(format!("surfels hide {ring} px of the ring, it hides {surfels} px of them, none is wrong"))
        }
        _ => Err(format!("{wrong} px demo the wrong surface; {ring} and {surfels} px are hidden").into()),
    }
}

/// Checks that glass, drawn after the surfels, is visible where it is nearest.
fn glass(before: &Shot, after: &Shot) -> Result<String> {
    let camera = camera(0.0, SIZE)?;
    let [mut seen, mut hidden, mut wrong] = [0; 3];
    for i in 0..before.colours.len() {
        let Some(depth) = pane(&camera, [i as u32 % SIZE[0], i as u32 / SIZE[0]]) else {
            wrong += usize::from(before.colours[i] != after.colours[i]);
            continue;
        };
        let nearer = depth > f64::from(before.depths[i]);
        seen += usize::from(nearer);
        hidden += usize::from(!nearer);
        wrong += usize::from(nearer != (before.colours[i] != after.colours[i]));
    }
    // Edges of triangles depend on float rounding.
    match (seen.min(hidden) > 5_000, wrong * 1000 <= before.colours.len()) {
        (true, true) => {
            Ok(format!("{hidden} px of the glass are hidden, {seen} are seen, {wrong} are wrong"))
        }
        _ => Err(format!("{wrong} px of the glass are wrong; {hidden} are hidden, {seen} are seen").into()),
    }
}

/// Depth of the glass at the centre of a pixel, in float64.
fn pane(camera: &Camera, at: [u32; 2]) -> Option<f64> {
    let [centre, u, v] = PANE.map(|v| v.as_dvec3());
    let back = camera.world_to_clip().inverse();
    let point = |depth: f64| {
        let clip = |i: usize| 2.0 * (f64::from(at[i]) + 0.5) / f64::from(SIZE[i]) - 1.0;
        back.project_point3(DVec3::new(clip(0), clip(1), depth))
    };
    let (from, to) = (point(1.0), point(0.5));
    let normal = u.cross(v);
    let t = normal.dot(centre - from) / normal.dot(to - from);
    let meets = from + t * (to - from);
    let inside = [u, v].iter().all(|side| (meets - centre).dot(*side).abs() <= side.length_squared());
    (t > 0.0 && inside).then(|| camera.world_to_clip().project_point3(meets).z)
}
