//! Covered tiles: a frame draws the tiles that splats may cover, each once, and leaves nothing of earlier frames in the others.

use crate::frames::sphere;
use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::settings::splats_alone;
use glam::{DMat4, DVec3};
use std::collections::BTreeSet;
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::settings::methods::{Method, perspective_ewa};
use surfel::settings::{Alpha, Cull, Shading};
use surfel::vk::DeviceLimits;
use surfel::{Instance, Outputs, Picture, Rasterizer, RenderOptions, Renderer, Scene, Settings};

const TILE: u32 = 8;

fn options(size: [u32; 2]) -> RenderOptions {
    let outputs = Outputs { normal: true, depth: true, id: false };
    RenderOptions { size, outputs, rasterizer: Rasterizer::Compute.into(), ..Default::default() }
}

fn camera([width, height]: [u32; 2]) -> Camera {
    let aspect = f64::from(width) / f64::from(height);
    Camera::look_at(6.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), aspect, 1e-3).unwrap()
}

/// The tiles of the pixels with a depth.
fn tiles_with_a_surface(picture: &Picture, [width, _]: [u32; 2]) -> BTreeSet<[u32; 2]> {
    let depths = picture.depth.as_ref().unwrap().iter().zip(0..);
    let seen = depths.filter(|(depth, _)| **depth > 0.0);
    seen.map(|(_, pixel): (_, u32)| [pixel % width / TILE, pixel / width / TILE]).collect()
}

/// A scale of the sphere, and where it is.
fn placed(scale: f64, at: [f64; 3]) -> DMat4 {
    DMat4::from_translation(DVec3::from(at)) * DMat4::from_scale(DVec3::splat(scale))
}

#[test]
fn a_frame_draws_the_tiles_of_its_splats_once() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let scene = Arc::new(Scene::upload(&device, &sphere(5_000)).unwrap());
    let methods = ["perspective-ewa", "object-ewa", "sprites-unfiltered"];
    // The last picture has more tiles than a row of a dispatch; in the short run the sphere is in one place there.
    for (size, methods) in
        [([256, 192], &methods[..]), ([203, 131], &methods[..1]), ([2056, 1040], &methods[..1])]
    {
        for (name, transform) in methods.iter().flat_map(|name| {
            let places =
                [(1.0, [0.0; 3]), (0.05, [-1.1, 0.7, 0.0]), (1.0, [3.0, -1.5, 0.0]), (1.0, [0.0, 0.0, 20.0])];
            let some = places.into_iter().take(if_whole(4, if size[0] > 1000 { 1 } else { 4 }));
            some.map(move |(scale, at)| (*name, placed(scale, at)))
        }) {
            let mut renderer = Renderer::new(&device, options(size)).unwrap();
            let settings = Method::named(name).unwrap().settings();
            let instances = [Instance { scene: scene.clone(), transform }];
            let (picture, _) = renderer.render_picture(&instances[..], &camera(size), &settings).unwrap();
            let drawn = renderer.read_covered_tiles().unwrap().unwrap();
            let once: BTreeSet<_> = drawn.iter().copied().collect();
            assert_eq!(once.len(), drawn.len(), "{name}, {size:?}: a tile is drawn twice");
            let shown = tiles_with_a_surface(&picture, size);
            println!("{name}, {size:?}: {} drawn, {} with a surface", drawn.len(), shown.len());
            assert!(once.is_superset(&shown), "{name}, {size:?}: {:?} are missing", shown.difference(&once));
            assert!(
                drawn.len() <= shown.len() * 6 / 5 + 6,
                "{name}, {size:?}: {} for {}",
                drawn.len(),
                shown.len()
            );
            assert!(once.iter().all(|[x, y]| *x < size[0].div_ceil(TILE) && *y < size[1].div_ceil(TILE)));
        }
    }
    assert_silent(&device);
}

/// Asserts that pixels far from any with a depth have the background.
fn assert_background(picture: &Picture, [width, height]: [u32; 2], background: Option<[f32; 3]>, name: &str) {
    const FAR: u32 = 8;
    let depths = picture.depth.as_ref().unwrap();
    let empty = background.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
    let at = |[x, y]: [u32; 2]| (y * width + x) as usize;
    for pixel in (0..width).flat_map(|x| (0..height).map(move |y| [x, y])) {
        let near =
            |side: usize, size: u32| pixel[side].saturating_sub(FAR)..(pixel[side] + FAR + 1).min(size);
        let is_far = near(0, width).all(|x| near(1, height).all(|y| depths[at([x, y])] == 0.0));
        assert!(!is_far || picture.colour[at(pixel)] == empty, "{name}: {pixel:?}");
    }
}

#[test]
fn nothing_of_earlier_frames_is_left() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let size = [200, 130];
    let scene = Arc::new(Scene::upload(&device, &sphere(5_000)).unwrap());
    let lit = perspective_ewa::METHOD.settings();
    let unfiltered = Settings { pixel_filter: 0.0, ..lit.clone() };
    let background = Some([0.1, 0.4, 0.2]);
    let all = [
        ("mask", Settings { alpha: Alpha::Mask, ..lit.clone() }),
        ("background", Settings { background, ..lit.clone() }),
        ("unfiltered", Settings { background, ..unfiltered.clone() }),
        ("pull-push", Settings { background, ..Method::named("pull-push").unwrap().settings() }),
        ("eye-dome lighting", Settings { shading: Shading::Edl, background, ..lit.clone() }),
        ("nearest", Settings { background, ..Method::named("sprites-unfiltered").unwrap().settings() }),
        ("both sides", Settings { cull: Cull::None, background, ..unfiltered.clone() }),
        ("eye-dome lighting, unfiltered", Settings { shading: Shading::Edl, background, ..unfiltered }),
        ("ambient occlusion", Settings { ao: 1.0, ..lit.clone() }),
        ("default", lit),
        ("splats alone", splats_alone()),
        (
            "coverage by pull-push",
            Settings { alpha: Alpha::Coverage, ..Method::named("pull-push").unwrap().settings() },
        ),
        ("pull-push-paper", Method::named("pull-push-paper").unwrap().settings()),
        (
            "eye-dome lighting by pull-push",
            Settings { shading: Shading::Edl, background, ..Method::named("pull-push").unwrap().settings() },
        ),
    ];
    for (name, settings) in &all[..if_whole(all.len(), 6)] {
        let render = |renderer: &mut Renderer, at: [f64; 3]| {
            let instances = [Instance { scene: scene.clone(), transform: placed(0.5, at) }];
            renderer.render_picture(&instances[..], &camera(size), settings).unwrap().0
        };
        let new = || Renderer::new(&device, options(size)).unwrap();
        let mut moved = new();
        for at in [[0.1, 1.0, 0.0], [0.4, 0.8, 0.0], [1.0, -1.0, 0.5], [0.0, 0.0, 20.0]] {
            let [picture, expected] = [render(&mut moved, at), render(&mut new(), at)];
            assert!(picture == expected, "{name} at {at:?}");
            assert_background(&picture, size, settings.background, name);
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn nothing_of_earlier_frames_is_left_by_slices() {
    let Some(device) = device(DeviceLimits { limited_loops: Some(true), ..Default::default() }) else {
        return;
    };
    let size = [150, 130];
    let scene = Arc::new(Scene::upload(&device, &sphere(70_000)).unwrap());
    let background = Some([0.1, 0.4, 0.2]);
    let lit = Settings { background, ..perspective_ewa::METHOD.settings() };
    let nearest = Settings { background, ..Method::named("sprites-unfiltered").unwrap().settings() };
    for (name, settings) in [
        ("default", lit.clone()),
        ("nearest", nearest.clone()),
        ("nearest, filtered", Settings { pixel_filter: 0.75, ..nearest }),
        ("front faces", Settings { cull: Cull::Back, ..lit }),
    ] {
        let render = |renderer: &mut Renderer, at: [f64; 3]| {
            let instances = [Instance { scene: scene.clone(), transform: placed(0.05, at) }];
            renderer.render_picture(&instances[..], &camera(size), &settings).unwrap().0
        };
        let new = || Renderer::new(&device, options(size)).unwrap();
        let mut moved = new();
        for at in [[-1.0, 0.8, 0.0], [-0.95, 0.7, 0.0], [1.0, -1.0, 0.5], [0.0, 0.0, 20.0]] {
            let [picture, expected] = [render(&mut moved, at), render(&mut new(), at)];
            assert!(at[2] > 1.0 || moved.read_covered_tiles().unwrap().is_none(), "{name}: not in slices");
            assert!(picture == expected, "{name} at {at:?}");
            assert_background(&picture, size, background, name);
            let shown = tiles_with_a_surface(&picture, size).len();
            assert!(if at[2] > 1.0 { shown == 0 } else { (1..20).contains(&shown) }, "{name}: {shown} tiles");
        }
    }
    assert_silent(&device);
}
