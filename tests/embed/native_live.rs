//! Changing surfels in subpasses of a host: growing radii, fewer surfels, alternating buffers.

use crate::fixture::{SIZE, assert_silent, camera, open, sphere, upload};
use crate::host::Host;
use crate::host::mesh::Mesh;
use crate::host::native::{Kind, Native};
use crate::host::scene::parallelogram;
use crate::rig::lay;
use crate::support::layouts::Layout;
use ash::vk;
use glam::Vec3;
use std::sync::Arc;
use surfel::embed::{self, Changes, View};
use surfel::geometry::Surfels;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Splatting, Visibility};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Scene, Settings};

/// A mesh of the host before the surfels, which may be seeded by its depth.
fn kind(seed: bool) -> Kind {
    Kind {
        colour: vk::Format::R32G32B32A32_SFLOAT,
        depth: Some(vk::Format::D32_SFLOAT),
        normals: false,
        samples: vk::SampleCountFlags::TYPE_1,
        reversed: true,
        seed,
        around: [true, false],
    }
}

fn settings(visibility: Visibility) -> Settings {
    let preset = Method::named("perspective-ewa").unwrap().settings();
    Settings { background: None, splatting: Splatting { visibility, ..preset.splatting }, ..preset }
}

/// A native host with a mesh that intersects the surfels.
struct NativeHost<'a> {
    host: &'a Host,
    native: Native,
    mesh: Mesh,
    device: Arc<Device>,
}

impl<'a> NativeHost<'a> {
    fn new(host: &'a Host, seed: bool, like: &Surfels, settings: &Settings) -> Self {
        let device = host.external_device_within(DeviceLimits::default(), None).unwrap();
        let scene = upload(host, &device, like);
        let native = Native::new(host, &device, kind(seed), SIZE, &[(scene.streams(), settings)]).unwrap();
        let sides = [Vec3::new(1.4, 0.2, 0.1), Vec3::new(-0.01, 0.3, -1.1)];
        let mesh =
            Mesh::new(host, &parallelogram(Vec3::new(0.1, 0.05, 0.2), sides), native.mesh_target()).unwrap();
        Self { host, native, mesh, device }
    }

    fn frame(&mut self, scene: &Arc<Scene>, settings: &Settings) -> Vec<[f32; 4]> {
        let Self { host, native, mesh, .. } = self;
        let view = View::whole(camera(), SIZE);
        host.run(|cmd| {
            // SAFETY: prepared outside the pass, drawn inside it, and waited for.
            unsafe {
                native.renderer.prepare(cmd, scene, &view, settings)?;
                native.record(host, cmd, (Some((mesh, Vec3::Y)), &view), |surfels| surfels.draw(cmd), false)
            }
        })
        .unwrap();
        bytemuck::pod_collect_to_vec(&native.picture(host, 16).unwrap())
    }

    fn destroy(self) {
        self.mesh.destroy(self.host);
        self.native.destroy(self.host);
    }
}

fn first(surfels: &Surfels, count: usize) -> Surfels {
    let mut some = Surfels { colours: None, ..surfels.clone() };
    some.positions.truncate(count);
    some.normals.truncate(count);
    some.radii.truncate(count);
    some
}

#[test]
fn a_seed_heeds_radii_that_grow() {
    let Some(host) = open(|all| all) else { return };
    let usual = sphere(20_000);
    let scaled = |by: f32| usual.radii.iter().map(|radius| by * radius).collect::<Vec<_>>();
    // A seed's reach is some ten times that of the largest disc.
    let (small, radii) = (Surfels { radii: scaled(0.02), ..usual.clone() }, scaled(12.0));
    let settings = settings(Visibility::Ray);
    let mut shown = [true, false].map(|seed| NativeHost::new(&host, seed, &small, &settings));
    let pictures = shown.each_mut().map(|shown| {
        let scene = upload(&host, &shown.device, &small);
        shown.frame(&scene, &settings);
        let grown = Changes { radii: Some(&radii), ..Default::default() };
        // SAFETY: recorded outside a render pass, and waited for.
        let staging = host.run(|cmd| Ok(unsafe { embed::update(cmd, &scene, 0, &grown)? })).unwrap();
        let picture = shown.frame(&scene, &settings);
        drop(staging);
        picture
    });
    let [seeded, plain] = &pictures;
    let different = seeded.iter().zip(plain).filter(|(a, b)| a != b).count();
    println!("{different} px differ by the seed");
    // Where a filter widens edge-on discs.
    assert!(different <= 5, "{different}");
    shown.into_iter().for_each(NativeHost::destroy);
    assert_silent(&host);
}

#[test]
fn the_declared_number_of_surfels_is_drawn() {
    let Some(host) = open(|all| all) else { return };
    let all = first(&sphere(20_000), 20_000);
    for visibility in [Visibility::Ray, Visibility::Axis, Visibility::Nearest] {
        let settings = match visibility {
            Visibility::Nearest => {
                Settings { background: None, ..Method::named("sprites-unfiltered").unwrap().settings() }
            }
            other => settings(other),
        };
        let mut shown = NativeHost::new(&host, true, &all, &settings);
        let scene = upload(&host, &shown.device, &all);
        let whole = shown.frame(&scene, &settings);
        scene.set_count(9_001).unwrap();
        let fewer = shown.frame(&scene, &settings);
        let anew = upload(&host, &shown.device, &first(&all, 9_001));
        anew.set_bounds(scene.bounds()).unwrap();
        assert!(fewer == shown.frame(&anew, &settings) && fewer != whole, "{visibility:?}");
        scene.set_count(20_000).unwrap();
        assert!(shown.frame(&scene, &settings) == whole, "{visibility:?}");
        shown.destroy();
    }
    assert_silent(&host);
}

#[test]
fn buffers_that_take_turns_keep_what_is_made_for_them() {
    let Some(host) = open(|all| all) else { return };
    let surfels = first(&sphere(5_000), 5_000);
    let settings = settings(Visibility::Axis);
    let device = host.external_device_within(DeviceLimits::default(), None).unwrap();
    let layout = Layout { colours: None, ..Layout::apart(5_000) };
    let external = [(); 3].map(|()| lay(&host, &device, &layout, &surfels));
    let native =
        Native::new(&host, &device, kind(true), SIZE, &[(external[0].0.streams(), &settings)]).unwrap();
    let sides = [Vec3::X, Vec3::Z];
    let mesh = Mesh::new(&host, &parallelogram(Vec3::ZERO, sides), native.mesh_target()).unwrap();
    let mut shown = NativeHost { host: &host, native, mesh, device: device.clone() };
    let mut round = || external.each_ref().map(|(scene, _)| shown.frame(scene, &settings));
    let pictures = round();
    let made = device.usage();
    assert!((0..3).all(|_| round() == pictures) && pictures[0] == pictures[2]);
    assert_eq!(device.usage(), made);
    shown.destroy();
    for (scene, buffer) in external {
        drop(scene);
        buffer.destroy(&host);
    }
    assert_silent(&host);
}
