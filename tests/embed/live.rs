//! Scenes that change on the GPU: surfels in buffers of the host, and updates of uploaded surfels.

use crate::fixture::{assert_silent, open, upload};
use crate::host::frame::Frame;
use crate::host::memory::Counted;
use crate::host::{Host, Submitted};
use crate::rig::{HostBuffer, KIND, Rendered, Rig, SIZE, lay, view};
use crate::support::layouts::Layout;
use crate::support::sampling::{Random, bumpy_sphere, forget_sides, narrow, paint_linear, paint_srgb};
use ash::vk::{self, Format};
use glam::{DVec3, Vec3};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use surfel::embed::{self, Buffers, Changes, Options, READ_ACCESS, READ_STAGES, Radii, Renderer};
use surfel::geometry::{Bounds, Colours, Surfels};
use surfel::settings::methods::Method;
use surfel::settings::splatting::Visibility;
use surfel::vk::{Device, DeviceLimits};
use surfel::{Picture, Rasterizer, RenderOptions, Scene, Settings, SplatCounts};

/// Limits so low that a scene of 20,000 surfels has several chunks, with a coarser alignment than a vertex.
pub const NARROW: DeviceLimits = DeviceLimits {
    max_storage_buffer_range: Some(512 << 10),
    blend_float32: None,
    subgroup_size: None,
    max_texels: None,
    int64_atomics: None,
    fragment_writes: None,
    independent_blend: None,
    dynamic_rendering: None,
    timestamps: None,
    storage_buffer_alignment: Some(256),
    max_storage_buffers: None,
    max_image_side: None,
    memory: None,
};

pub fn sphere(count: usize) -> Surfels {
    let mut random = Random(11);
    let mut surfels = bumpy_sphere(count, &mut random);
    paint_srgb(&mut surfels, &mut random);
    surfels
}

/// Ellipses with linear colours, some of them two-sided.
pub fn ellipses(count: usize) -> Surfels {
    let mut random = Random(12);
    let mut surfels = bumpy_sphere(count, &mut random);
    paint_linear(&mut surfels, &mut random);
    forget_sides(&mut surfels, 0.4, &mut random);
    narrow(&mut surfels, &mut random);
    Surfels { origin: DVec3::new(0.125, -0.25, 0.0), ..surfels }
}

pub fn settings(method: Method) -> Settings {
    Settings { background: None, ..method.settings() }
}

/// Tolerance of two frames: atomic sums have an arbitrary order.
fn most(settings: &Settings, rasterizer: Rasterizer) -> f32 {
    let blends = settings.pull_push.is_none() && settings.splatting.visibility != Visibility::Nearest;
    if blends && rasterizer == Rasterizer::Compute { 2e-5 } else { 0.0 }
}

/// Number of pixels in which two frames differ by more than `most`.
pub fn differing((colours, depths): &Rendered, (others, other_depths): &Rendered, most: f32) -> usize {
    assert_eq!((colours.len(), depths.len()), (others.len(), other_depths.len()));
    let near = |a: f32, b: f32| (a - b).abs() <= most;
    let same = |i: &usize| {
        colours[*i].iter().zip(&others[*i]).all(|(a, b)| near(*a, *b)) && near(depths[*i], other_depths[*i])
    };
    (0..colours.len()).filter(|i| !same(i)).count()
}

fn covered((colours, _): &Rendered) -> usize {
    colours.iter().filter(|colour| colour[3] > 0.0).count()
}

#[test]
fn a_hosts_buffers_give_the_picture_of_an_upload_by_every_method() {
    let Some(host) = open(|all| all) else { return };
    let cases = [
        (Layout::apart(6_000), sphere(6_000)),
        (Layout::vertices(), sphere(6_000)),
        (Layout::wide(), ellipses(6_000)),
    ];
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let mut rig = Rig::new(&host, Some(rasterizer), DeviceLimits::default());
        for (layout, surfels) in &cases {
            let (external, buffer) = lay(&host, &rig.device, layout, surfels);
            let own = upload(&host, &rig.device, surfels);
            assert!(
                external.bytes() < 100 && own.bytes() > 100_000,
                "nothing is copied: {}",
                external.bytes()
            );
            for method in Method::ALL {
                let settings = settings(method);
                let [found, expected] = [&external, &own].map(|scene| rig.render(&host, scene, &settings));
                assert!(covered(&expected) > 5_000);
                let wrong = differing(&found, &expected, most(&settings, rasterizer));
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
    for name in ["sprites-unfiltered", "pull-push"] {
        let settings = settings(Method::named(name).unwrap());
        for (layout, surfels, few) in &cases {
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
            let most = most(&settings, rasterizer);
            for count in [20_000, border + 1, border, border - 1, 1, 0] {
                [&external, &own].into_iter().for_each(|scene| scene.set_count(count).unwrap());
                assert_eq!((external.count(), external.capacity()), (count, 20_000));
                let [found, again] = [&external, &own].map(|scene| rig.render(&host, scene, &settings));
                assert_eq!(differing(&found, &again, most), 0, "{name} {rasterizer:?} {count}");
                if count == 0 {
                    assert_eq!(covered(&found), 0, "{name} {rasterizer:?}");
                    continue;
                }
                let fresh =
                    rig.render_uploaded(&host, &first(&surfels, count as usize), &external, &settings);
                assert_eq!(differing(&found, &fresh, most), 0, "{name} {rasterizer:?} {count}");
                assert!(covered(&fresh) > 0);
            }
        }
        drop(external);
        buffer.destroy(&host);
        rig.destroy(&host);
    }
    assert_silent(&host);
}

/// The first `count` surfels.
fn first(surfels: &Surfels, count: usize) -> Surfels {
    let mut part = surfels.clone();
    part.positions.truncate(count);
    part.normals.truncate(count);
    part.radii.truncate(count);
    part.ellipses.iter_mut().for_each(|ellipses| ellipses.truncate(count));
    part.two_sided.iter_mut().for_each(|two_sided| two_sided.truncate(count));
    match &mut part.colours {
        Some(Colours::Srgb8(colours)) => colours.truncate(count),
        Some(Colours::Linear(colours)) => colours.truncate(count),
        None => {}
    }
    part
}

/// The sphere, rotated and inflated, as by a simulation.
pub fn moved(surfels: &Surfels, step: usize) -> Surfels {
    let (turn, swell) = (glam::Quat::from_rotation_y(0.3 * step as f32), 1.0 + 0.02 * step as f32);
    let mut moved = surfels.clone();
    moved.positions.iter_mut().for_each(|p| *p = swell * (turn * *p));
    moved.normals.iter_mut().for_each(|n| *n = (turn * *n).normalize());
    moved
}

/// Rewrites the buffer between barriers for the readers of the frames before and after.
fn rewrite(host: &Host, cmd: vk::CommandBuffer, from: &HostBuffer, to: &HostBuffer, size: u64) {
    let transfer = vk::PipelineStageFlags::TRANSFER;
    let barrier = |from, to, memory: &[vk::MemoryBarrier<'_>]| {
        // SAFETY: recorded outside a render pass.
        unsafe {
            host.device.cmd_pipeline_barrier(cmd, from, to, vk::DependencyFlags::empty(), memory, &[], &[])
        };
    };
    barrier(READ_STAGES, transfer, &[]);
    let region = vk::BufferCopy { size, ..Default::default() };
    // SAFETY: both buffers have this size, and are kept until the copy is executed.
    unsafe { host.device.cmd_copy_buffer(cmd, from.0, to.0, &[region]) };
    let seen = vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(READ_ACCESS);
    barrier(transfer, READ_STAGES, &[seen]);
}

#[test]
fn what_moves_every_frame_is_seen_where_it_is_with_frames_in_flight() {
    const FRAMES: usize = 6;
    let Some(host) = open(|all| all) else { return };
    let (layout, surfels) = (Layout::vertices(), sphere(6_000));
    let steps: Vec<_> = (0..FRAMES).map(|step| moved(&surfels, step)).collect();
    for (name, rasterizer) in [
        ("sprites-unfiltered", Rasterizer::Draw),
        ("perspective-ewa", Rasterizer::Draw),
        ("perspective-ewa", Rasterizer::Compute),
        ("pull-push", Rasterizer::Draw),
        ("pull-push", Rasterizer::Compute),
    ] {
        let settings = settings(Method::named(name).unwrap());
        let mut rig = Rig::new(&host, Some(rasterizer), DeviceLimits::default());
        let (external, buffer) = lay(&host, &rig.device, &layout, &surfels);
        let sources: Vec<_> = steps.iter().map(|step| HostBuffer::new(&host, &layout.bytes(step))).collect();
        let frames: Vec<_> = steps.iter().map(|_| Frame::new(&host, KIND, SIZE).unwrap()).collect();
        let size = layout.bytes(&surfels).len() as u64;
        let submit = |(source, frame): (&HostBuffer, &Frame)| -> Submitted {
            let (submitted, ()) = host
                .submit(|cmd| {
                    rewrite(&host, cmd, source, &buffer, size);
                    rig.record(&host, cmd, Some(frame), &external, &settings);
                    Ok(())
                })
                .unwrap();
            submitted
        };
        let under_way: Vec<_> = sources.iter().zip(&frames).map(submit).collect();
        under_way.into_iter().for_each(|submitted| host.wait(submitted).unwrap());
        let mut before: Option<Rendered> = None;
        for (step, frame) in steps.iter().zip(&frames) {
            let found = frame.read(&host).unwrap();
            let expected = rig.render_uploaded(&host, step, &external, &settings);
            assert_eq!(differing(&found, &expected, most(&settings, rasterizer)), 0, "{name} {rasterizer:?}");
            assert!(before.is_none_or(|before| differing(&before, &found, 1e-3) > 1_000), "it moves");
            before = Some(found);
        }
        drop(external);
        frames.into_iter().for_each(|frame| frame.destroy(&host));
        sources.into_iter().chain([buffer]).for_each(|buffer| buffer.destroy(&host));
        rig.destroy(&host);
    }
    assert_silent(&host);
}

#[test]
fn buffers_that_take_turns_make_nothing() {
    let Some(host) = open(|all| all) else { return };
    let (memory, counts) = Counted::new(&host);
    let device = host.external_device(Some(Box::new(memory))).unwrap();
    let frame = Frame::new(&host, KIND, SIZE).unwrap();
    // For tiles splats are the frame's, not the scenes'.
    let rasterizer = Some(Rasterizer::Draw);
    let options = Options { rasterizer, ..Options::new(frame.target()) };
    // SAFETY: the target is the frame's.
    let mut rig = Rig { renderer: unsafe { Renderer::new(&device, options) }.unwrap(), device, frame };
    let (layout, surfels) = (Layout::vertices(), sphere(2_000));
    let scenes: Vec<_> =
        (0..3).map(|step| lay(&host, &rig.device, &layout, &moved(&surfels, step))).collect();
    let settings = settings(Method::named("perspective-ewa").unwrap());
    let mut made = Vec::new();
    for number in 0..12 {
        let shown = rig.render(&host, &scenes[number % 3].0, &settings);
        assert!(covered(&shown) > 5_000);
        made.push(counts.left.load(Ordering::SeqCst));
    }
    assert!(made[3..].iter().all(|left| *left == made[3]), "{made:?}");
    // Resources of dropped scenes are destroyed.
    let alive = counts.alive.load(Ordering::SeqCst);
    (0..8).for_each(|_| drop(rig.render(&host, &scenes[0].0, &settings)));
    assert!(counts.alive.load(Ordering::SeqCst) < alive);
    let (kept, buffer): (Vec<_>, Vec<_>) = scenes.into_iter().unzip();
    drop(kept);
    let Rig { renderer, device, frame } = rig;
    drop(renderer);
    assert_eq!((Arc::strong_count(&device), counts.alive.load(Ordering::SeqCst)), (1, 0));
    drop(device);
    frame.destroy(&host);
    buffer.into_iter().for_each(|buffer| buffer.destroy(&host));
    assert_silent(&host);
}

/// The engine's frame of a scene, with counts.
pub fn alone(
    device: &Arc<Device>,
    scene: &Scene,
    name: &str,
    rasterizer: Rasterizer,
) -> (Picture, SplatCounts) {
    let options =
        RenderOptions { size: SIZE, rasterizer: Some(rasterizer), count: true, ..Default::default() };
    let mut renderer = surfel::Renderer::new(device, options).unwrap();
    let settings = settings(Method::named(name).unwrap());
    let (picture, report) = renderer.render_picture(scene, &view().camera, &settings).unwrap();
    (picture, report.counts.unwrap())
}

pub const ALONE: [(&str, Rasterizer); 3] = [
    ("sprites-unfiltered", Rasterizer::Draw),
    ("pull-push", Rasterizer::Draw),
    ("pull-push", Rasterizer::Compute),
];

/// Surfels of which every 16th is invalid, each in another way.
pub fn spoil(surfels: &mut Surfels) -> usize {
    let spoils: [fn(&mut Surfels, usize); 12] = [
        |s, i| s.positions[i].y = f32::NAN,
        |s, i| s.positions[i].z = f32::NEG_INFINITY,
        |s, i| s.positions[i].x = -1.1e15,
        |s, i| s.normals[i] = Vec3::ZERO,
        |s, i| s.normals[i] *= 1.01,
        |s, i| s.normals[i].x = f32::NAN,
        |s, i| s.radii[i] = 0.0,
        |s, i| s.radii[i] = f32::NAN,
        |s, i| s.radii[i] = f32::INFINITY,
        |s, i| s.ellipses.as_mut().unwrap()[i].major = s.normals[i],
        |s, i| s.ellipses.as_mut().unwrap()[i].aspect = 1.5,
        |s, i| match &mut s.colours {
            Some(Colours::Linear(colours)) => colours[i][2] = f32::NAN,
            _ => panic!("colours are linear"),
        },
    ];
    let spoiled: Vec<usize> = (0..surfels.len()).filter(|i| i % 16 < spoils.len()).collect();
    spoiled.iter().for_each(|&i| spoils[i % 16](surfels, i));
    spoiled.len()
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

/// A buffer that is not created by the engine, on the engine's device.
struct RawBuffer {
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    device: Arc<Device>,
}

impl RawBuffer {
    fn new(device: &Arc<Device>, bytes: &[u8]) -> Self {
        let raw = device.handle();
        let info = vk::BufferCreateInfo::default()
            .size(bytes.len() as u64)
            .usage(vk::BufferUsageFlags::STORAGE_BUFFER);
        let seen = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: plain Vulkan; `drop` destroys the objects.
        unsafe {
            let buffer = raw.create_buffer(&info, None).unwrap();
            let needs = raw.get_buffer_memory_requirements(buffer);
            let types = device.instance().get_physical_device_memory_properties(device.physical());
            let kind = types.memory_types_as_slice().iter().enumerate().position(|(i, kind)| {
                needs.memory_type_bits & 1 << i != 0 && kind.property_flags.contains(seen)
            });
            let kind = kind.expect("every device has such a type") as u32;
            let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
            let memory = raw.allocate_memory(&info, None).unwrap();
            raw.bind_buffer_memory(buffer, memory, 0).unwrap();
            let mapped = raw.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()).unwrap();
            mapped.cast::<u8>().copy_from_nonoverlapping(bytes.as_ptr(), bytes.len());
            Self { buffer, memory, device: device.clone() }
        }
    }
}

impl Drop for RawBuffer {
    fn drop(&mut self) {
        // SAFETY: every frame that reads it was waited for.
        unsafe {
            self.device.handle().destroy_buffer(self.buffer, None);
            self.device.handle().free_memory(self.memory, None);
        }
    }
}

#[test]
fn bounds_follow_positions_or_are_declared() {
    let Some(device) = crate::support::gpu::device(DeviceLimits::default()) else { return };
    let surfels = sphere(500);
    let scene = Scene::upload(&device, &surfels).unwrap();
    assert_eq!(scene.bounds(), surfels.bounds().unwrap());
    let far = [Vec3::new(9.0, 0.0, 0.0), Vec3::NAN];
    scene.update(3, &Changes { positions: Some(&far), ..Default::default() }).unwrap();
    let reach = f64::from(surfels.radii.iter().copied().fold(0.0, f32::max));
    assert!(scene.bounds().max.x == 9.0 + reach && scene.bounds().min == surfels.bounds().unwrap().min);
    // Positions that are not finite do not change the bounds.
    let before = scene.bounds();
    for nowhere in [vec![Vec3::NAN], vec![Vec3::INFINITY; 500]] {
        scene.update(0, &Changes { positions: Some(&nowhere), ..Default::default() }).unwrap();
        assert_eq!(scene.bounds(), before);
    }
    let all = moved(&surfels, 2);
    let whole = Changes { positions: Some(&all.positions), radii: Some(&all.radii), ..Default::default() };
    scene.update(0, &whole).unwrap();
    assert_eq!(scene.bounds(), all.bounds().unwrap());
    let expected = Bounds::of_box(DVec3::splat(-2.0), DVec3::splat(5.0));
    scene.update(0, &Changes { bounds: Some(expected), ..whole }).unwrap();
    assert_eq!(scene.bounds(), expected);
    assert!(scene.set_bounds(Bounds { radius: f64::NAN, ..expected }).is_err());
    crate::support::gpu::assert_silent(&device);
}

pub fn refused<T>(made: surfel::Result<T>, expected: &str) {
    let text = made.err().map(|error| error.to_string()).unwrap_or_default();
    assert!(text.contains(expected), "`{expected}` is not in `{text}`");
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
