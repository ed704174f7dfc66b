//! A host's frame with an embedded renderer.
#![allow(dead_code, reason = "no test uses all of it")]

use crate::host::Host;
use crate::host::frame::{Frame, Kind};
use crate::host::mesh::Mesh;
use crate::support::gpu::{Alone, alone};
use crate::support::sampling::{Random, bumpy_sphere};
use crate::support::skipping::say_skipped;
use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use std::ops::Deref;
use std::sync::Arc;
use surfel::embed::{self, Abilities, Options, Renderer, View};
use surfel::geometry::{Camera, Surfels};
use surfel::vk::Device;
use surfel::{Rasterizer, Scene, Settings};

/// Width and height of a frame, px.
pub const SIZE: [u32; 2] = [160, 120];

/// A host under validation.
pub struct TestHost {
    host: Host,
    _alone: Alone,
}

impl Deref for TestHost {
    type Target = Host;

    fn deref(&self) -> &Host {
        &self.host
    }
}

/// Opens a host; without a device, notes that the test is skipped and returns `None`. With `SURFEL_REQUIRE_GPU` set, it panics instead.
pub fn open(wanted: fn(Abilities) -> Abilities) -> Option<TestHost> {
    let alone = alone();
    match Host::open(wanted, true) {
        Ok(host) => Some(TestHost { host, _alone: alone }),
        Err(error) if std::env::var_os("SURFEL_REQUIRE_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            say_skipped(&error.to_string());
            None
        }
    }
}

pub fn assert_silent(host: &Host) {
    let messages = host.messages();
    assert!(messages.is_empty(), "{} validation messages: {messages:#?}", messages.len());
}

/// A host's frame with an embedded renderer.
pub struct Fixture {
    pub frame: Frame,
    pub renderer: Renderer,
    pub scene: Arc<Scene>,
    pub device: Arc<Device>,
}

impl Fixture {
    pub fn new(
        host: &Host,
        kind: Kind,
        size: [u32; 2],
        rasterizer: Option<Rasterizer>,
        surfels: &Surfels,
    ) -> Self {
        let device = host.external_device(None).unwrap();
        let frame = Frame::new(host, kind, size).unwrap();
        let options = Options { rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's.
        let renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        let scene = upload(host, &device, surfels);
        Self { frame, renderer, scene, device }
    }

    /// Renders the mesh, if any, and then the surfels.
    pub fn render(
        &mut self,
        host: &Host,
        view: &View,
        settings: &Settings,
        mesh: Option<&Mesh>,
    ) -> (Vec<[f32; 4]>, Vec<f32>) {
        let Self { frame, renderer, scene, .. } = self;
        host.run(|cmd| {
            // SAFETY: recorded outside and inside the frame's pass, submitted in order to the host's queue.
            unsafe {
                renderer.prepare(cmd, &*scene, view, settings)?;
                frame.begin(host, cmd);
                if let Some(mesh) = mesh {
                    let world_to_clip = view.camera.world_to_clip().as_mat4();
                    mesh.draw(host, cmd, view.viewport, world_to_clip, Vec3::Y);
                }
                renderer.draw(cmd)?;
                frame.end(host, cmd);
            }
            Ok(())
        })
        .unwrap();
        frame.read(host).unwrap()
    }

    pub fn destroy(self, host: &Host) {
        drop(self.renderer);
        self.frame.destroy(host);
    }
}

pub fn upload(host: &Host, device: &Arc<Device>, surfels: &Surfels) -> Arc<Scene> {
    // SAFETY: recorded outside a render pass, and waited for.
    let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(device, cmd, surfels)? })).unwrap();
    assert!(staging.bytes() > 0);
    Arc::new(scene)
}

pub fn surfels() -> Surfels {
    sphere(20_000)
}

pub fn sphere(count: usize) -> Surfels {
    bumpy_sphere(count, &mut Random(7))
}

pub fn camera() -> Camera {
    let eye = DVec3::new(1.1, 0.9, 3.0);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8, 4.0 / 3.0, 0.1).unwrap()
}

/// A camera with increasing depth, from 0 at the near plane to 1 at the far plane.
pub fn rising() -> Camera {
    let (near, far) = (0.1, 50.0);
    let mut camera = camera();
    camera.projection.z_axis.z = far / (far - near);
    camera.projection.w_axis.z = -near * far / (far - near);
    Camera { reversed: false, ..camera }
}

pub fn viewport([width, height]: [u32; 2]) -> vk::Viewport {
    vk::Viewport {
        x: 0.0,
        y: 0.0,
        width: width as f32,
        height: height as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    }
}

/// Distance from the eye plane of the parallelogram along the ray through the centre of a pixel, if they intersect.
pub fn meets(camera: &Camera, at: [u32; 2], centre: DVec3, sides: [DVec3; 2]) -> Option<f64> {
    let back: DMat4 = camera.world_to_clip().inverse();
    let clip = |depth: f64| {
        let ndc = |i: usize| 2.0 * (f64::from(at[i]) + 0.5) / f64::from(SIZE[i]) - 1.0;
        back.project_point3(DVec3::new(ndc(0), ndc(1), depth))
    };
    let (from, to) = (clip(1.0), clip(0.5));
    let ray = to - from;
    let normal = sides[0].cross(sides[1]);
    let t = normal.dot(centre - from) / normal.dot(ray);
    let point = from + t * ray;
    let inside = sides.iter().all(|side| (point - centre).dot(*side).abs() <= side.length_squared());
    (t > 0.0 && inside).then(|| camera.view.transform_point3(point).z)
}
