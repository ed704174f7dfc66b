//! Pull–push on the GPU, in the terms of the float64 reference.

use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Colours, Parts};
use surfel::scene::ColourStream;
use surfel::settings::pull_push::PullPush;
use surfel::verify::reference::Frame;
use surfel::verify::reference::pull_push::{Compact, Level, Pyramid, Reconstruction, Sample};
use surfel::vk::Device;
use surfel::{
    Outputs, Picture, Precision, PyramidLevel, PyramidSample, RenderOptions, Renderer, Scene, Settings,
};

/// A frame whose passes are compared one by one.
pub struct FrameCase<'a> {
    /// Name for messages.
    pub name: String,
    pub parts: Parts<'a>,
    pub camera: Camera,
    /// Width and height, px.
    pub size: [u32; 2],
    pub settings: Settings,
    pub pull_push: PullPush,
    /// Float width of the samples.
    pub precision: Precision,
}

/// A frame with its pyramids.
pub struct Rendered {
    pub frame: Frame,
    pub pyramid: Pyramid,
}

impl FrameCase<'_> {
    /// The reference of the frame.
    pub fn reconstruction(&self) -> Reconstruction {
        let full = Reconstruction::new(&self.camera, self.size, &self.settings, self.pull_push).unwrap();
        let full = full.of(self.parts).unwrap();
        match self.compact() {
            Some(compact) => full.with_compact(compact),
            None => full,
        }
    }

    /// What its samples are rounded to, if they are.
    pub fn compact(&self) -> Option<Compact> {
        let primitives = self.parts.primitives.and_then(|primitives| primitives.colours.as_ref());
        let given: Vec<_> = [self.parts.surfels.colours.as_ref(), primitives].into_iter().flatten().collect();
        let colours = match given.iter().any(|colours| matches!(colours, Colours::Linear(_))) {
            true => ColourStream::Linear,
            false if given.is_empty() => ColourStream::None,
            false => ColourStream::Srgb8,
        };
        (self.precision == Precision::Half).then_some(Compact { colours })
    }

    /// Computes it by the reference, with as many levels as needed.
    pub fn by_reference(&self) -> Rendered {
        let reference = self.reconstruction();
        let visible = reference.project(self.parts).level;
        let top = Reconstruction::top_level(&visible);
        let pyramid = reference.pyramid(visible, top);
        Rendered { frame: reference.shade(&pyramid.pushed[0]), pyramid }
    }

    /// By the GPU.
    pub fn by_gpu(&self, device: &Arc<Device>) -> Rendered {
        let scene = Scene::upload(device, self.parts).unwrap();
        let outputs = Outputs { normal: true, depth: true, id: true };
        let options = RenderOptions {
            size: self.size,
            outputs,
            precision: self.precision,
            split: true,
            ..Default::default()
        };
        let mut renderer = Renderer::new(device, options).unwrap();
        let (picture, _) = renderer.render_picture(&scene, &self.camera, &self.settings).unwrap();
        let levels = renderer.read_pyramids().unwrap().unwrap();
        let as_reference =
            |levels: Vec<PyramidLevel>| (0..).zip(levels).map(|(i, l)| self.level(i, &l)).collect();
        let [pulled, pushed] = levels.map(as_reference);
        Rendered { frame: frame_of(&picture), pyramid: Pyramid { pulled, pushed } }
    }

    /// A GPU level in the reference's terms: normals are in eye space.
    fn level(&self, level: u32, made: &PyramidLevel) -> Level {
        let to_eye = DMat3::from_mat4(self.camera.view);
        let albedo = self.settings.lighting.albedo;
        let sample = |sample: &PyramidSample| {
            let [x, y] = sample.displacement.map(f64::from);
            Sample {
                near: sample.near.into(),
                far: sample.far.into(),
                depth: sample.depth.into(),
                displacement: DVec2::new(x, y),
                radius: sample.radius.into(),
                normal: to_eye * DVec3::from_array(sample.normal.map(f64::from)),
                tube: sample.tube,
                subpixel: sample.subpixel,
                back: sample.back,
                colour: DVec3::from_array(sample.colour.unwrap_or(albedo).map(f64::from)),
                coordinates: sample.coordinates.map_or(DVec2::ZERO, |at| DVec2::from(at.map(f64::from))),
                id: sample.id.unwrap(),
            }
        };
        let samples = made.samples.iter().map(|made| made.as_ref().map(sample)).collect();
        Level { level, size: made.size, samples }
    }
}

/// A picture with normals and depths as a frame of the reference.
fn frame_of(picture: &Picture) -> Frame {
    let (depths, normals) = (picture.depth.as_ref().unwrap(), picture.normal.as_ref().unwrap());
    Frame {
        size: picture.size,
        colour: picture.colour.iter().map(|colour| colour.map(f64::from)).collect(),
        depth: depths.iter().copied().map(f64::from).collect(),
        normal: normals.iter().map(|normal| normal.map(f64::from)).collect(),
        covered: picture.colour.iter().map(|colour| colour[3] > 0.0).collect(),
        id: picture.id.clone(),
        counts: Default::default(),
        dual_form: 0,
    }
}
