//! A native host's frames: surfels in subpasses of its render pass.

use crate::ONE;
use crate::fixture::upload;
use crate::host::Host;
use crate::host::mesh::Mesh;
use crate::host::native::{Kind, Native};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;
use surfel::embed::View;
use surfel::geometry::Surfels;
use surfel::settings::methods::Method;
use surfel::vk::Device;
use surfel::{Scene, Settings};

pub const D32: vk::Format = vk::Format::D32_SFLOAT;

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
    Settings { background: None, ..Method::named(name).unwrap().settings().in_subpasses() }
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

pub fn count_different(a: &[[f32; 4]], b: &[[f32; 4]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}
