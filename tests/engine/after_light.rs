//! Pictures after the passes that read the depths of shaded ones, against the reference's of the same colours and depths, or of exact ones.

use crate::support::after_light::after_light;
use crate::support::gpu::{Renderers, render};
use glam::DVec3;
use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::methods::Method;
use surfel::settings::{Cull, Edges, Shading};
use surfel::verify::reference::Projector;
use surfel::verify::scenes;
use surfel::verify::truth;
use surfel::vk::Device;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

/// Width and height, px: no multiples of a workgroup's.
pub const SIZE: [u32; 2] = [75, 53];

pub const RASTERIZERS: [Rasterizer; 2] = [Rasterizer::Draw, Rasterizer::Compute];
pub const DEPTHS: Outputs = Outputs { normal: false, depth: true, id: false };

pub fn perspective() -> Camera {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    Camera::look_at(DVec3::new(0.6, 0.5, 2.2), DVec3::ZERO, DVec3::Y, 0.8, aspect, 0.1).unwrap()
}

pub fn parallel() -> Camera {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let axes = [DVec3::new(0.6, 0.5, 2.2), DVec3::ZERO, DVec3::Y];
    Camera::orthographic(axes, 1.7, aspect, [0.1, 10.0]).unwrap()
}

fn colours(picture: &Picture) -> Vec<[f64; 4]> {
    picture.colour.iter().map(|colour| colour.map(f64::from)).collect()
}

/// Largest difference of premultiplied colours and α from the reference's passes after the picture without them.
pub fn difference(
    renderers: &Renderers,
    surfels: &Surfels,
    camera: &Camera,
    settings: &Settings,
    rasterizer: Rasterizer,
) -> f64 {
    let options = RenderOptions { size: SIZE, rasterizer: rasterizer.into(), ..Default::default() };
    let shading = if settings.shading == Shading::Edl { Shading::Colour } else { settings.shading };
    let before = Settings {
        shading,
        ao: 0.0,
        lowpass: settings.lowpass - settings.pixel_filter,
        pixel_filter: 0.0,
        background: None,
        ..settings.clone()
    };
    let before = renderers.render(surfels, camera, &before, RenderOptions { outputs: DEPTHS, ..options });
    let depths: Vec<f64> = before.depth.as_ref().unwrap().iter().map(|z| f64::from(*z)).collect();
    let projector = Projector::new(camera, SIZE, settings).unwrap();
    let expected = after_light(&projector, settings, colours(&before), &depths, SIZE);
    let after = renderers.render(surfels, camera, settings, options);
    assert!(after.depth.is_none(), "depths are of the passes alone, and not asked for");
    let premultiplied = |[r, g, b, a]: [f64; 4]| [a * r, a * g, a * b, a];
    let pairs = colours(&after).into_iter().map(premultiplied).zip(expected.into_iter().map(premultiplied));
    let differences = pairs.flat_map(|(a, b)| (0..4).map(move |k| (a[k] - b[k]).abs()));
    differences.fold(0.0, |most, one| if one.is_nan() || one > most { one } else { most })
}

/// Exact depths of the bumpy sphere, and points of it.
pub struct ExactDepths {
    size: [u32; 2],
    camera: Camera,
    depths: Vec<f64>,
    white: Surfels,
}

impl ExactDepths {
    /// Those of a picture of this side, px, and so many points.
    pub fn new(side: u32, points: u32) -> Self {
        let camera =
            Camera::look_at(DVec3::new(1.7, 1.4, 2.7), DVec3::ZERO, DVec3::Y, FRAC_PI_4, 1.0, 0.1).unwrap();
        let subject = Subject::scene("scene:bumpy-sphere").unwrap();
        let settings = Settings { shading: Shading::Depth, pixel_filter: 0.0, ..Settings::default() };
        let options = truth::Options { filter: truth::Filter::Box, ..Default::default() };
        let surface = subject.surface().unwrap();
        let exact = truth::render(surface, &camera, &settings, [side; 2], &options, &()).unwrap();
        let depth = |c: &[f32; 4]| if c[3] >= 1.0 { c[0].into() } else { 0.0 };
        let depths = exact.picture.colour.iter().map(depth).collect();
        let surfels = scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap();
        Self { size: [side; 2], camera, depths, white: Surfels { colours: None, ..surfels } }
    }

    /// Errors of the factors by which a method's pictures with a change are darkened: the median, and what 95 % are below.
    pub fn errors(&self, device: &Arc<Device>, method: Method, change: &dyn Fn(&mut Settings)) -> [f64; 2] {
        let preset = method.settings();
        let mut settings = Settings {
            shading: Shading::Colour,
            pixel_filter: 0.0,
            cull: Cull::Back,
            edges: Edges::Nearest,
            ..preset
        };
        change(&mut settings);
        let options = RenderOptions { size: self.size, ..Default::default() };
        let picture = render(device, &self.white, &self.camera, &settings, options);
        let projector = Projector::new(&self.camera, self.size, &settings).unwrap();
        let albedo = settings.lighting.albedo.map(f64::from);
        let whole = vec![[albedo[0], albedo[1], albedo[2], 1.0]; self.depths.len()];
        let expected = after_light(&projector, &settings, whole, &self.depths, self.size);
        let inside = (0..self.depths.len()).filter(|i| self.depths[*i] > 0.0 && picture.colour[*i][3] == 1.0);
        let mut errors: Vec<f64> =
            inside.map(|i| (f64::from(picture.colour[i][0]) - expected[i][0]).abs() / albedo[0]).collect();
        errors.sort_by(f64::total_cmp);
        let pixels = errors.len();
        assert!(pixels > 10_000);
        let [median, most] = [0.5, 0.95].map(|part| errors[(part * pixels as f64) as usize]);
        println!(
            "{}: error of the factor of {pixels} px: median {median:.4}, 95 % below {most:.4}",
            method.name
        );
        [median, most]
    }
}
