//! Comparison of frames of changing scenes.

use crate::rig::{Rendered, SIZE, view};
use std::sync::Arc;
use surfel::settings::methods::Method;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Picture, Rasterizer, RenderOptions, Scene, Settings, SplatCounts};

/// Limits so low that a scene of 20,000 surfels has several chunks, with a coarser alignment than a vertex.
pub const NARROW: DeviceLimits = DeviceLimits {
    max_storage_buffer_range: Some(512 << 10),
    blend_float32: None,
    subgroup_size: None,
    max_sort_runs: None,
    max_texels: None,
    limited_loops: None,
    int64_atomics: None,
    fragment_writes: None,
    independent_blend: None,
    subgroup_size_control: None,
    subgroup_uniform_control_flow: None,
    shared_lanes: None,
    dynamic_rendering: None,
    timestamps: None,
    storage_buffer_alignment: Some(256),
    max_storage_buffers: None,
    max_image_side: None,
    memory: None,
};

pub fn settings(method: Method) -> Settings {
    Settings { background: None, ..method.settings() }
}

/// Number of pixels in which two frames differ by more than `most`.
pub fn differing((colours, depths): &Rendered, (others, other_depths): &Rendered, most: f32) -> usize {
    assert_eq!((colours.len(), depths.len()), (others.len(), other_depths.len()));
    let near = |a: f32, b: f32| (a - b).abs() <= most;
    let same = |i: &usize| {
        colours[*i].iter().zip(&others[*i]).all(|(a, b)| near(*a, *b)) && near(depths[*i], other_depths[*i])
    };
    (0..colours.len()).filter(|i| !same(i)).count()
}

pub fn covered((colours, _): &Rendered) -> usize {
    colours.iter().filter(|colour| colour[3] > 0.0).count()
}

/// The engine's frame of a scene, with counts.
pub fn alone(
    device: &Arc<Device>,
    scene: &Scene,
    name: &str,
    rasterizer: Rasterizer,
) -> (Picture, SplatCounts) {
    let options =
        RenderOptions { size: SIZE, rasterizer: rasterizer.into(), count: true, ..Default::default() };
    let mut renderer = surfel::Renderer::new(device, options).unwrap();
    let settings = settings(Method::named(name).unwrap());
    let (picture, report) = renderer.render_picture(scene, &view().camera, &settings).unwrap();
    (picture, report.counts.unwrap())
}

pub const ALONE: [(&str, Rasterizer); 3] = [
    ("sprites-unfiltered", Rasterizer::Draw),
    ("pull-push", Rasterizer::Draw),
    ("pull-push", Rasterizer::Compute),
];

pub fn refused<T>(made: surfel::Result<T>, expected: &str) {
    let text = made.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(text.contains(expected), "`{expected}` is not in `{text}`");
}

/// Checks a host's depths with the near plane at 0.1: 0.1 over the picture's distances where α ≥ ½, elsewhere none. A pixel that only the
/// filter of pixels covers has the depth of the nearest surface.
pub fn assert_depths(found: &[f32], own: &Picture) {
    let [width, height] = own.size.map(|side| side as i32);
    let distances = own.depth.as_ref().unwrap();
    for (i, (found, colour)) in (0..).zip(found.iter().zip(&own.colour)) {
        let [x, y] = [i % width, i / width];
        let around = (-6..=6).flat_map(|dy| (-6..=6).map(move |dx| (dx, dy)));
        let surfaces = around.filter_map(|(dx, dy)| {
            let [u, v] = [x + dx, y + dy];
            let is_inside = (0..width).contains(&u) && (0..height).contains(&v);
            let distance = is_inside.then(|| distances[(v * width + u) as usize])?;
            (distance > 0.0).then_some((dx * dx + dy * dy, distance))
        });
        let exact: Vec<f64> = match (distances[i as usize], colour[3]) {
            (_, ..0.5) => vec![0.0],
            (0.0, _) => {
                let surfaces: Vec<_> = surfaces.collect();
                let least = surfaces.iter().map(|(square, _)| *square).min();
                let nearest = surfaces.iter().filter(|(square, _)| Some(*square) == least);
                nearest.map(|(_, distance)| 0.1 / f64::from(*distance)).collect()
            }
            (distance, _) => vec![0.1 / f64::from(distance)],
        };
        let is_near = |exact: &f64| (f64::from(*found) - exact).abs() <= 1.5e-7 * exact;
        assert!(exact.iter().any(is_near), "{x} {y}: {found} {exact:?}");
    }
}
