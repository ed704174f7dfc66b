//! Surfels in subpasses among the host's surfaces: they hide each other, and a later subpass of the host sees their depth.

use crate::fixture::{Fixture, SIZE, assert_silent, camera, meets, open, rising, surfels, viewport};
use crate::host::Host;
use crate::host::frame::{self, Way};
use crate::host::mesh::Mesh;
use crate::host::native::Kind;
use crate::host::scene::{Corners, parallelogram};
use crate::native_rig::{Drawn, PLAIN, count_different, method};
use crate::support::if_whole;
use crate::{FOUR, ONE};
use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use surfel::embed::View;
use surfel::embed::native::Renderer;
use surfel::geometry::{Camera, Surfels};
use surfel::settings::Alpha;
use surfel::{Rasterizer, Settings};

/// A parallelogram through the sphere: its centre and the halves of its sides, orthogonal for `meets`.
fn plane() -> (DVec3, [DVec3; 2]) {
    let (centre, sides) =
        (DVec3::new(0.1, 0.05, 0.2), [DVec3::new(1.4, 0.2, 0.1), DVec3::new(0.0, 0.3, -1.1)]);
    (centre, [sides[0], sides[1] - sides[1].dot(sides[0]) / sides[0].length_squared() * sides[0]])
}

/// From a thousand times as far away, in a field of view in which the sphere is as large.
fn distant() -> Camera {
    let eye = 1e3 * DVec3::new(1.1, 0.9, 3.0);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.8e-3, 4.0 / 3.0, 0.1).unwrap()
}

/// The composite's picture of the same scene.
fn composited(
    host: &Host,
    kind: Kind,
    view: &View,
    settings: &Settings,
    surfels: &Surfels,
    mesh: &Corners,
) -> Vec<[f32; 4]> {
    let Kind { colour, samples, reversed, .. } = kind;
    let kind = frame::Kind { way: Way::Subpass, colour, normals: false, samples, reversed };
    let mut fixture = Fixture::new(host, kind, SIZE, Some(Rasterizer::Draw), surfels);
    let mesh = Mesh::new(host, mesh, fixture.frame.mesh_target()).unwrap();
    let (colours, _) = fixture.render(host, view, settings, Some(&mesh));
    mesh.destroy(host);
    fixture.destroy(host);
    colours
}

#[test]
fn among_the_hosts_surfaces_the_picture_is_the_composites_and_the_references() {
    let Some(host) = open(|all| all) else { return };
    let (centre, sides) = plane();
    let corners = parallelogram(centre.as_vec3(), sides.map(|side| side.as_vec3()));
    let settings = Settings { alpha: Alpha::Mask, ..method("perspective-ewa") };
    let reference =
        |camera| surfel::verify::reference::render(&surfels(), &camera, SIZE, &settings, &()).unwrap();
    let references = [camera(), distant()].map(|camera| (camera, reference(camera)));
    let height = SIZE[1] as f32;
    let plain = viewport(SIZE);
    let turned = vk::Viewport { y: height, height: -height, min_depth: 0.25, max_depth: 0.75, ..plain };
    let mut up = camera();
    up.projection = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0)) * up.projection;
    // With the reference of the same picture.
    let [near, far] = &references;
    let views = [
        (true, camera(), plain, near),
        (false, rising(), plain, near),
        (true, up, turned, near),
        (true, distant(), plain, far),
    ];
    let alike =
        [(ONE, true), (ONE, false), (FOUR, true)].map(|(samples, seed)| Kind { samples, seed, ..PLAIN });
    let pairs = alike.into_iter().flat_map(|kind| views.map(|view| (kind, view))).enumerate();
    // The short run has a third of the pairs, with every kind and every view.
    let pairs = pairs.filter(|&(i, _)| if_whole(true, (i / 4 + i % 4).is_multiple_of(3)));
    for (_, (kind, (reversed, camera, viewport, (seen_by, reference)))) in pairs {
        let kind = Kind { reversed, ..kind };
        let view = View { camera, viewport };
        let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
        let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
        drawn.render(&view, &settings, Some(&mesh), false);
        let colours = drawn.colours();
        let other = composited(&host, kind, &view, &settings, &surfels(), &corners);
        if kind.samples == ONE {
            let (mut counts, mut wrong) = ([[0; 2]; 2], 0);
            for (i, colour) in colours.iter().enumerate() {
                let at = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
                let surfel = reference.covered[i].then_some(reference.depth[i]);
                let of_host = meets(seen_by, at, centre, sides);
                let is_surfel = surfel.is_some_and(|z| of_host.is_none_or(|of_host| z <= of_host));
                let is_host = !is_surfel && of_host.is_some();
                let found = [colour[3] > 0.0 && !is_blue(colour), is_blue(colour)];
                wrong += usize::from(found != [is_surfel, is_host]);
                counts[usize::from(surfel.is_some() && of_host.is_some())][usize::from(is_host)] += 1;
            }
            assert!(counts[1].iter().all(|count| *count > 500), "either hides the other: {counts:?}");
            println!("{kind:?}: {wrong} px of {} differ from the reference", colours.len());
            assert!(wrong * 1000 <= colours.len(), "{wrong} px");
        }
        // A seed may hide edge-on discs at the outline: see the guide, Accuracy.
        let hidden = colours.iter().zip(&other).filter(|(found, other)| found != other && is_blue(found));
        let hidden = if kind.seed && std::ptr::eq(reference, &far.1) { hidden.count() } else { 0 };
        assert!(hidden <= 1 && count_different(&colours, &other) == hidden, "{kind:?} {viewport:?}");
        mesh.destroy(&host);
        drawn.destroy();
    }
    assert_silent(&host);
}

/// Whether a pixel shows the host's mesh, the only blue surface.
fn is_blue(colour: &[f32; 4]) -> bool {
    colour[3] > 0.0 && colour[2] > 1.5 * colour[0]
}

/// Difficult scenes, with a wall of the host through them.
#[test]
#[ignore = "takes long: tools/test --all"]
fn in_hard_scenes_the_picture_is_the_composites() {
    let Some(host) = open(|all| all) else { return };
    for case in crate::support::scenes::cases() {
        let settings = Settings { background: None, ..case.settings.clone() };
        let [mut different, mut shown] = [0; 2];
        let cameras = 0..2;
        for camera in &case.cameras[cameras] {
            let bounds = case.surfels.bounds().unwrap();
            let back = camera.view.inverse();
            let size = 0.25 * (bounds.max - bounds.min).length();
            let sides = [DVec3::X, DVec3::new(0.0, 0.7, 0.7)];
            let sides = sides.map(|side| (size * back.transform_vector3(side)).as_vec3());
            let corners = parallelogram(bounds.centre().as_vec3(), sides);
            let view = View::whole(*camera, SIZE);
            let kind = Kind { reversed: camera.reversed, ..PLAIN };
            let other = composited(&host, kind, &view, &settings, &case.surfels, &corners);
            for seed in [true, false] {
                let mut drawn = Drawn::new(&host, Kind { seed, ..kind }, SIZE, &case.surfels, &settings);
                let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
                drawn.render(&view, &settings, Some(&mesh), false);
                for (found, other) in drawn.colours().iter().zip(&other) {
                    shown += usize::from(seed && other[3] > 0.0);
                    if found != other {
                        // The host hides edge-on discs.
                        assert!(seed && is_blue(found), "{}: {found:?} {other:?}", case.name);
                        different += 1;
                    }
                }
                mesh.destroy(&host);
                drawn.destroy();
            }
        }
        println!("{}: {different} px of {shown} differ", case.name);
        // One scene has edge-on discs only.
        assert!(case.name == "edge-on" || 1000 * different <= shown, "{}", case.name);
    }
    assert_silent(&host);
}

#[test]
fn a_later_subpass_of_the_host_sees_the_depth_of_surfels() {
    let Some(host) = open(|all| all) else { return };
    let (settings, view) = (method("perspective-ewa"), View::whole(camera(), SIZE));
    let mut drawn = Drawn::new(&host, PLAIN, SIZE, &surfels(), &settings);
    drawn.render(&view, &settings, None, false);
    let (clear, depths) = (drawn.colours(), drawn.depths());
    drawn.render(&view, &settings, None, true);
    for ((foggy, clear), depth) in drawn.colours().iter().zip(clear).zip(depths) {
        let fog = (-crate::host::fog::DENSITY * depth).exp();
        for k in 0..3 {
            let expected = fog * crate::host::fog::COLOUR[k] + (1.0 - fog) * clear[k];
            assert!((foggy[k] - expected).abs() < 1e-5, "{foggy:?} {clear:?} {depth}");
        }
    }
    drawn.destroy();
    assert_silent(&host);
}

/// Number of fragments of each subpass that pass the tests.
fn count_fragments(drawn: &mut Drawn<'_>, view: &View, settings: &Settings, mesh: &Mesh) -> Vec<u64> {
    let Drawn { host, native, scene, .. } = drawn;
    let first = u32::from(native.kind.around[0]);
    let count = native.renderer.plan().subpasses().len() as u32;
    let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::OCCLUSION).query_count(count);
    // SAFETY: a query begins and ends in each subpass, and all are waited for.
    unsafe {
        let device = &host.device;
        let pool = device.create_query_pool(&info, None).unwrap();
        host.run(|cmd| {
            device.cmd_reset_query_pool(cmd, pool, 0, count);
            native.renderer.prepare(cmd, &*scene, view, settings)?;
            let mesh = Some((mesh, Vec3::Y));
            let each = |surfels: &Renderer| {
                surfels.draw_each(|subpass| {
                    if subpass > first {
                        device.cmd_end_query(cmd, pool, subpass - first - 1);
                    }
                    device.cmd_next_subpass(cmd, vk::SubpassContents::INLINE);
                    device.cmd_begin_query(cmd, pool, subpass - first, vk::QueryControlFlags::PRECISE);
                    cmd
                })?;
                device.cmd_end_query(cmd, pool, count - 1);
                Ok(())
            };
            native.record(host, cmd, (mesh, view), each, false)
        })
        .unwrap();
        let mut found = vec![0u64; count as usize];
        let wait = vk::QueryResultFlags::WAIT | vk::QueryResultFlags::TYPE_64;
        device.get_query_pool_results(pool, 0, &mut found, wait).unwrap();
        device.destroy_query_pool(pool, None);
        found
    }
}

#[test]
fn splats_that_the_host_hides_are_left_out_early() {
    let Some(host) = open(|all| all) else { return };
    let all = [
        ("perspective-ewa", camera()),
        ("sprites-unfiltered", distant()),
        ("perspective-ewa", distant()),
        ("sprites-unfiltered", camera()),
    ];
    for (name, camera) in all.into_iter().take(if_whole(4, 2)) {
        let view = View::whole(camera, SIZE);
        // Half of the view, in front of everything.
        let before = camera.view.inverse();
        let centre = before.transform_point3(DVec3::new(-1.0, 0.0, 1.0)).as_vec3();
        let sides = [DVec3::X, DVec3::Y].map(|side| before.transform_vector3(side).as_vec3());
        let corners = parallelogram(centre, sides);
        let settings = method(name);
        let counts = [true, false].map(|seed| {
            let kind = Kind { seed, ..PLAIN };
            let mut drawn = Drawn::new(&host, kind, SIZE, &surfels(), &settings);
            let mesh = Mesh::new(&host, &corners, drawn.native.mesh_target()).unwrap();
            let counts = count_fragments(&mut drawn, &view, &settings, &mesh);
            mesh.destroy(&host);
            drawn.destroy();
            counts
        });
        let [seeded, plain] = &counts;
        // The first seeded count is the seed's; the last ones draw the visible surfaces, to the host's depth.
        println!("{name}: {seeded:?} fragments, without a seed {plain:?}");
        assert_eq!(seeded[0], u64::from(SIZE[0] * SIZE[1]));
        let last = plain.len() - 1;
        assert_eq!(seeded[last + 1], plain[last]);
        for (with, without) in seeded[1..=last].iter().zip(plain) {
            assert!(10 * with < 7 * without, "{counts:?}");
        }
    }
    assert_silent(&host);
}
