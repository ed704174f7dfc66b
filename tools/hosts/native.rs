//! A host whose render pass has surfels' passes among its own subpasses: `cargo run --example native -- FILE.png`.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod host;

use ash::vk;
use glam::{DVec3, Vec3};
use host::Host;
use host::mesh::Mesh;
use host::native::{Kind, Native};
use host::scene::{sphere, torus};
use std::sync::Arc;
use surfel::embed::{self, View};
use surfel::geometry::Camera;
use surfel::{Scene, Settings};

/// Width and height, px.
const SIZE: [u32; 2] = [960, 720];

fn main() -> host::Result<()> {
    let file = std::env::args_os().nth(1).ok_or("give the picture's file: native FILE.png")?;
    let host = Host::open(|all| all, false)?;
    let device = host.lend(None)?;
    // SAFETY: recorded outside a render pass; `staging` stays until `run` has waited.
    let (scene, staging) = host.run(|cmd| Ok(unsafe { embed::upload(&device, cmd, &sphere(200_000))? }))?;
    drop(staging);
    let kind = Kind {
        colour: vk::Format::R8G8B8A8_SRGB,
        depth: Some(vk::Format::D32_SFLOAT),
        normals: false,
        samples: vk::SampleCountFlags::TYPE_4,
        reversed: true,
        seed: true,
        around: [true, true],
    };
    let settings = Settings::default();
    let mut native = Native::new(&host, &device, kind, SIZE, &[(scene.streams(), &settings)])?;
    let mesh = Mesh::new(&host, &torus(Vec3::ZERO, [1.0, 0.22], 96), native.place())?;
    let shown = render(&host, &mut native, &mesh, &Arc::new(scene), &settings);
    let bytes = shown.and_then(|()| native.picture(&host, 4));
    mesh.destroy(&host);
    native.destroy(&host);
    let messages = host.messages();
    if !messages.is_empty() {
        return Err(format!("validation: {}", messages.join("; ")).into());
    }
    let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], bytes?).ok_or("the picture is too short")?;
    Ok(picture.save(file)?)
}

/// A frame: footprints outside the render pass; in it the mesh, surfels' own subpasses, the fog over both.
fn render(
    host: &Host,
    native: &mut Native,
    mesh: &Mesh,
    scene: &Arc<Scene>,
    settings: &Settings,
) -> host::Result<()> {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let camera = Camera::look_at(DVec3::new(1.2, 1.4, 2.9), DVec3::ZERO, DVec3::Y, 0.75, aspect, 0.1)?;
    let [width, height] = SIZE.map(|side| side as f32);
    let viewport = vk::Viewport { width, height, max_depth: 1.0, ..Default::default() };
    let view = View { camera, viewport };
    host.run(|cmd| {
        // SAFETY: prepared outside the pass and drawn inside it, submitted in this order, and waited for.
        unsafe {
            native.renderer.prepare(cmd, scene, &view, settings)?;
            let lit = (mesh, Vec3::new(0.4, 0.8, 0.45).normalize());
            native.record(host, cmd, (Some(lit), &view), |surfels| surfels.draw(cmd), true)
        }
    })
}
