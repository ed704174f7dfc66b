//! A host with a frame into which surfels are drawn.
#![allow(dead_code, reason = "no test uses all of it")]

use crate::host::Host;
use crate::host::frame::{Frame, Kind};
use crate::host::mesh::Mesh;
use glam::Vec3;
use std::sync::Arc;
use surfel::embed::{self, Abilities, Options, Renderer, View};
use surfel::geometry::Surfels;
use surfel::vk::Device;
use surfel::{Precision, Rasterizer, Scene, Settings};

/// A host; `None`, said aloud, where there is no device. With `SURFEL_REQUIRE_GPU` set, the lack of one is a failure.
pub fn open(wanted: fn(Abilities) -> Abilities) -> Option<Host> {
    match Host::open(wanted, true) {
        Ok(host) => Some(host),
        Err(error) if std::env::var_os("SURFEL_REQUIRE_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            eprintln!("SKIPPED, not passed: {error}");
            None
        }
    }
}

pub fn assert_silent(host: &Host) {
    let messages = host.messages();
    assert!(messages.is_empty(), "{} validation messages: {messages:#?}", messages.len());
}

/// A host's frame with the renderer that draws into it.
pub struct Stand {
    pub frame: Frame,
    pub renderer: Renderer,
    pub scene: Arc<Scene>,
    pub device: Arc<Device>,
}

impl Stand {
    pub fn new(
        host: &Host,
        kind: Kind,
        size: [u32; 2],
        rasterizer: Option<Rasterizer>,
        surfels: &Surfels,
    ) -> Self {
        let device = host.lend(None).unwrap();
        let frame = Frame::new(host, kind, size).unwrap();
        let options =
            Options { target: frame.target(), frames_in_flight: 2, precision: Precision::Full, rasterizer };
        // SAFETY: the target is the frame's.
        let renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        let scene = upload(host, &device, surfels);
        Self { frame, renderer, scene, device }
    }

    /// A frame of the mesh, if there is one, and then the surfels.
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
                renderer.prepare(cmd, scene, view, settings)?;
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
