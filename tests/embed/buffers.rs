//! Surfels in buffers of the host, in any layout and format: read in place, and rejected if they cannot be read.

use crate::compare::{ALONE, NARROW, alone, covered, differing, refused, settings};
use crate::fixture::{assert_silent, open, upload};
use crate::inputs::{ellipses, first, sphere, spoil};
use crate::raw_buffer::RawBuffer;
use crate::rig::{HostBuffer, Rig, lay};
use crate::support::layouts::Layout;
use crate::support::{if_whole, methods};
use ash::vk::{self, Format};
use glam::Vec3;
use std::sync::Arc;
use surfel::embed::{self, Buffers, Changes, Radii};
use surfel::geometry::{Colours, Surfels};
use surfel::scene::Order;
use surfel::settings::methods::Method;
use surfel::vk::DeviceLimits;
use surfel::{Rasterizer, Scene};

#[test]
fn a_hosts_buffers_give_the_picture_of_an_upload_by_every_method() {
    let Some(host) = open(|all| all) else { return };
    let cases = [
        (Layout::apart(6_000), sphere(6_000)),
        (Layout::vertices(), sphere(6_000)),
        (Layout::wide(), ellipses(6_000)),
    ];
    for (by, rasterizer) in [Rasterizer::Draw, Rasterizer::Compute].into_iter().enumerate() {
        let mut rig = Rig::new(&host, Some(rasterizer), DeviceLimits::default());
        for (number, (layout, surfels)) in cases.iter().enumerate() {
            let (external, buffer) = lay(&host, &rig.device, layout, surfels);
            let own = upload(&host, &rig.device, surfels);
            assert!(
                external.bytes() < 100 && own.bytes() > 100_000,
                "nothing is copied: {}",
                external.bytes()
            );
            // In the short run every layout by every method, with either rasterizer in turns.
            let is_tested = |i: &usize| if_whole(true, (i + number + by).is_multiple_of(2));
            for (_, method) in methods().into_iter().enumerate().filter(|(i, _)| is_tested(i)) {
                let settings = settings(method);
                let [found, expected] = [&external, &own].map(|scene| rig.render(&host, scene, &settings));
                assert!(covered(&expected) > 5_000);
                let wrong = differing(&found, &expected, 0.0);
                assert_eq!(wrong, 0, "{} {rasterizer:?} {layout:?}", method.name);
            }
            drop(external);
            buffer.destroy(&host);
        }
        rig.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn every_format_gives_what_it_holds() {
    let Some(host) = open(|all| all) else { return };
    let mut rig = Rig::new(&host, Some(Rasterizer::Draw), DeviceLimits::default());
    let base = Layout { colours: None, ..Layout::apart(6_000) };
    let linear = |format, few, values: fn(Vec3) -> Vec3| {
        let mut surfels = sphere(6_000);
        let colours = surfels.positions.iter().map(|p| values(*p).to_array()).collect();
        surfels.colours = Some(Colours::Linear(colours));
        (Layout { colours: Some((28 * 6_000, 16, format)), ..base }, surfels, few)
    };
    let normals = |format, stride, most| {
        (
            Layout { normals: (32 * 6_000, stride, format), ..base },
            Surfels { colours: None, ..sphere(6_000) },
            most,
        )
    };
    let bare = || Surfels { colours: None, ..sphere(6_000) };
    let cases = [
        (base, bare(), 0),
        (Layout { radii: None, ..base }, bare(), 0),
        // Numbers that half floats represent exactly.
        linear(Format::R16G16B16A16_SFLOAT, 0, |p| (64.0 * p).round() / 16.0),
        linear(Format::R32G32B32_SFLOAT, 0, |p| p),
        linear(Format::R32G32B32A32_SFLOAT, 0, |p| 3.0 * p),
        // The rounding of a quotient by 255 is implementation-defined.
        linear(Format::R8G8B8A8_UNORM, 20, |p| (0.5 * p + 0.5).clamp(Vec3::ZERO, Vec3::ONE)),
        // So is that of unit vectors: a few pixels at the rims of discs may differ.
        normals(Format::R8G8B8A8_SNORM, 4, 20),
        normals(Format::R16G16B16A16_SNORM, 12, 20),
        normals(Format::R16G16B16A16_SFLOAT, 8, 20),
    ];
    for (by, name) in ["sprites-unfiltered", "pull-push"].into_iter().enumerate() {
        let settings = settings(Method::named(name).unwrap());
        // The short run has every format by one method, in turns.
        let is_tested = |i: usize| if_whole(true, (i + by).is_multiple_of(2));
        for (_, (layout, surfels, few)) in cases.iter().enumerate().filter(|(i, _)| is_tested(*i)) {
            let (external, buffer) = lay(&host, &rig.device, layout, surfels);
            let found = rig.render(&host, &external, &settings);
            let expected = rig.render_uploaded(&host, &layout.held(surfels.clone()), &external, &settings);
            assert!(covered(&expected) > 5_000);
            let wrong = differing(&found, &expected, if *few > 0 { 1e-6 } else { 0.0 });
            assert!(wrong <= *few, "{name} {layout:?}: {wrong} px");
            if *few > 0 {
                // The format has an effect: unrounded normals give another picture.
                let rounded = rig.render_uploaded(&host, surfels, &external, &settings);
                assert!(differing(&found, &rounded, 1e-6) > 1_000, "{name} {layout:?}");
            }
            drop(external);
            buffer.destroy(&host);
        }
    }
    rig.destroy(&host);
    assert_silent(&host);
}

/// Whatever the order, and with values that are not numbers, tiles show the same surfels.
#[test]
fn a_hosts_surfels_in_arbitrary_order_are_sorted() {
    let Some(host) = open(|all| all) else { return };
    let layout = Layout::wide();
    let mut surfels = ellipses(6_000);
    spoil(&mut surfels);
    for limits in [DeviceLimits::default(), NARROW] {
        let mut rig = Rig::new(&host, Some(Rasterizer::Compute), limits);
        let buffer = HostBuffer::new(&host, &layout.bytes(&surfels));
        let [arbitrary, coherent] = [Order::Arbitrary, Order::Coherent].map(|order| {
            let buffers = Buffers { order, ..layout.buffers(&surfels, buffer.0) };
            // SAFETY: the buffer is of the device, and is destroyed last.
            Arc::new(unsafe { Scene::from_buffers(&rig.device, &buffers) }.unwrap())
        });
        assert!(arbitrary.streams().unordered && !coherent.streams().unordered);
        let settings = settings(Method::named("perspective-ewa").unwrap());
        for count in [6_000, 4_001, 1] {
            [&arbitrary, &coherent].into_iter().for_each(|scene| scene.set_count(count).unwrap());
            let [found, expected] = [&arbitrary, &coherent].map(|scene| rig.render(&host, scene, &settings));
            assert_eq!(differing(&found, &expected, 2e-5), 0, "{count} surfels");
            assert!(count == 1 || covered(&expected) > 3_000);
        }
        drop((arbitrary, coherent));
        rig.destroy(&host);
        buffer.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn chunks_of_interleaved_buffers_fit_and_follow_the_count() {
    let Some(host) = open(|all| all) else { return };
    let (layout, surfels) = (Layout::wide(), ellipses(20_000));
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let mut rig = Rig::new(&host, Some(rasterizer), NARROW);
        let (external, buffer) = lay(&host, &rig.device, &layout, &surfels);
        let own = upload(&host, &rig.device, &surfels);
        assert!(external.chunks().len() > 2, "{:?}", external.chunks());
        let border = external.chunks()[0].end;
        for name in ["perspective-ewa", "sprites-unfiltered", "pull-push"] {
            let settings = settings(Method::named(name).unwrap());
            // The clusters of uploads have bounds: in frames that cull hidden ones, tiles visit splats in another order.
            let is_culled = rasterizer == Rasterizer::Compute && name == "perspective-ewa";
            let rounding = if is_culled { 1e-6 } else { 0.0 };
            let is_tested = |count: &u64| if_whole(true, ![border + 1, 1].contains(count));
            let counts = [20_000, border + 1, border, border - 1, 1, 0];
            for count in counts.into_iter().filter(is_tested) {
                [&external, &own].into_iter().for_each(|scene| scene.set_count(count).unwrap());
                assert_eq!((external.count(), external.capacity()), (count, 20_000));
                let [found, again] = [&external, &own].map(|scene| rig.render(&host, scene, &settings));
                assert_eq!(differing(&found, &again, rounding), 0, "{name} {rasterizer:?} {count}");
                if count == 0 {
                    assert_eq!(covered(&found), 0, "{name} {rasterizer:?}");
                    continue;
                }
                let fresh =
                    rig.render_uploaded(&host, &first(&surfels, count as usize), &external, &settings);
                assert_eq!(differing(&found, &fresh, rounding), 0, "{name} {rasterizer:?} {count}");
                assert!(count == 1 || covered(&fresh) > 0);
            }
        }
        drop(external);
        buffer.destroy(&host);
        rig.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn what_is_invalid_in_a_hosts_buffer_is_culled_and_counted() {
    let Some(device) = crate::support::gpu::device(DeviceLimits::default()) else { return };
    let mut surfels = ellipses(6_000);
    let spoiled = spoil(&mut surfels);
    assert_eq!(surfels.count_invalid(), spoiled);
    let own = Scene::upload(&device, &surfels).unwrap();
    let layout = Layout::wide();
    let bytes = layout.bytes(&surfels);
    let buffer = RawBuffer::new(&device, &bytes);
    // SAFETY: the buffer is of the device, and is dropped last.
    let external = unsafe { Scene::from_buffers(&device, &layout.buffers(&surfels, buffer.buffer)) }.unwrap();
    for (name, rasterizer) in ALONE {
        let [found, expected] = [&external, &own].map(|scene| alone(&device, scene, name, rasterizer));
        assert_eq!(expected.1.invalid as usize, spoiled);
        assert_eq!(found.1, expected.1, "{name} {rasterizer:?}");
        assert!(found.0 == expected.0, "{name} {rasterizer:?}");
        assert!(found.0.colour.iter().filter(|colour| colour[3] > 0.0).count() > 2_000);
    }
    drop((own, external, buffer));
    crate::support::gpu::assert_silent(&device);
}

#[test]
fn buffers_that_cannot_be_read_are_refused_and_named() {
    let Some(host) = open(|all| all) else { return };
    let device = host.external_device_within(NARROW, None).unwrap();
    let surfels = ellipses(1_000);
    let layout = Layout::wide();
    let buffer = HostBuffer::new(&host, &layout.bytes(&surfels));
    let good = layout.buffers(&surfels, buffer.0);
    type Change = fn(&mut Buffers);
    let changes: [(Change, &str); 17] = [
        (
            |b| b.positions.format = Format::R16G16B16A16_SFLOAT,
            "positions cannot be read: they are R16G16B16A16_SFLOAT",
        ),
        (|b| b.normals.format = Format::R8G8B8A8_UNORM, "normals cannot be read: they are R8G8B8A8_UNORM"),
        (|b| b.colours.as_mut().unwrap().format = Format::R8G8B8_SRGB, "colours cannot be read"),
        (|b| b.ellipses.as_mut().unwrap().format = Format::R32G32B32_SFLOAT, "give R32G32B32A32_SFLOAT"),
        (|b| b.positions.stride = 70, "the stride 70: give multiples of 4"),
        (|b| b.normals.offset = 38, "the offset is 38 bytes"),
        (|b| b.positions.stride = 8, "a stride from 12 bytes"),
        (
            |b| b.positions.size = 71_950,
            "positions cannot be read: 1000 values from byte 20 on, with a stride of 72 bytes, do not fit 71950",
        ),
        (|b| b.normals.offset = u64::MAX - 3, "do not fit"),
        (|b| b.capacity = 0, "give a capacity from 1"),
        (|b| b.capacity = 1 << 40, "give a capacity from 1"),
        (|b| b.count = 1_001, "1001 of 1000"),
        (|b| b.origin.y = f64::NAN, "origin"),
        (|b| b.bounds.radius = f64::INFINITY, "bounds"),
        (|b| b.radii = Radii::All(-1.0e16), "radius of all is -1"),
        (|b| (b.radii, b.two_sided) = (Radii::All(-1.0), false), "radius of all is -1"),
        (|b| b.normals.buffer = vk::Buffer::null(), "buffer is null"),
    ];
    for (change, expected) in changes {
        let mut buffers = good;
        change(&mut buffers);
        // SAFETY: nothing is created for a rejected description.
        refused(unsafe { Scene::from_buffers(&device, &buffers) }, expected);
    }
    let mut sparse = good;
    (sparse.positions.stride, sparse.positions.size) = (4 << 10, 4 << 20);
    // SAFETY: as above.
    refused(unsafe { Scene::from_buffers(&device, &sparse) }, "maxStorageBufferRange");
    // SAFETY: the buffer is of the device, and is dropped last.
    let scene = unsafe { Scene::from_buffers(&device, &good) }.unwrap();
    refused(scene.set_count(1_001), "room for 1000");
    let one = Changes { positions: Some(&[Vec3::ZERO]), ..Default::default() };
    // SAFETY: recorded outside a render pass, and waited for.
    let update = |scene: &Scene| host.run(|cmd| Ok(unsafe { embed::update(cmd, scene, 0, &one) })).unwrap();
    refused(update(&scene), "buffers of the host");
    assert!(update(&upload(&host, &device, &surfels)).is_ok());
    drop(scene);
    buffer.destroy(&host);
    drop(device);
    assert_silent(&host);
}
