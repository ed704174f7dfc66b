//! Barriers of frames: none waits for all earlier work of the host, and none is missing between dispatches.
//!
//! A software rasterizer runs dispatches one after another, and synchronization validation does not compare their accesses to buffers: a
//! missing barrier shows in no picture here. So the commands are recorded.

use crate::compare::settings;
use crate::fixture::{SIZE, assert_silent, camera, open, sphere, upload};
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::support::methods;
use crate::{FLOATS, ONE};
use ash::vk;
use glam::{DMat4, DVec3};
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, OnceLock};
use surfel::embed::{Options, Renderer, View};
use surfel::geometry::Camera;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::Storage;
use surfel::vk::Device;
use surfel::{Rasterizer, Settings};

/// A command of the engine on the host's device.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Command {
    Barrier {
        source: vk::PipelineStageFlags,
        target: vk::PipelineStageFlags,
        /// Accesses of its memory barriers, before and after.
        accesses: [vk::AccessFlags; 2],
    },
    Bind(vk::PipelineBindPoint, vk::Pipeline),
    Dispatch,
}

/// The commands of a frame.
static COMMANDS: Mutex<Vec<Command>> = Mutex::new(Vec::new());
/// The host's device.
static DEVICE: OnceLock<ash::Device> = OnceLock::new();

/// Keeps a command, and returns the device's functions, of which one records it.
fn functions(command: Command) -> &'static ash::DeviceFnV1_0 {
    COMMANDS.lock().unwrap().push(command);
    DEVICE.get().unwrap().fp_v1_0()
}

unsafe extern "system" fn barrier(
    cmd: vk::CommandBuffer,
    source: vk::PipelineStageFlags,
    target: vk::PipelineStageFlags,
    dependencies: vk::DependencyFlags,
    memories: u32,
    memory: *const vk::MemoryBarrier<'_>,
    buffers: u32,
    buffer: *const vk::BufferMemoryBarrier<'_>,
    images: u32,
    image: *const vk::ImageMemoryBarrier<'_>,
) {
    let mut accesses = [vk::AccessFlags::empty(); 2];
    for i in 0..memories as usize {
        // SAFETY: the caller gives so many memory barriers.
        let memory = unsafe { *memory.add(i) };
        accesses[0] |= memory.src_access_mask;
        accesses[1] |= memory.dst_access_mask;
    }
    let record = functions(Command::Barrier { source, target, accesses }).cmd_pipeline_barrier;
    // SAFETY: the function is the device's.
    unsafe {
        record(cmd, source, target, dependencies, memories, memory, buffers, buffer, images, image);
    }
}

unsafe extern "system" fn bind(cmd: vk::CommandBuffer, point: vk::PipelineBindPoint, pipeline: vk::Pipeline) {
    // SAFETY: the function is the device's.
    unsafe { (functions(Command::Bind(point, pipeline)).cmd_bind_pipeline)(cmd, point, pipeline) }
}

unsafe extern "system" fn dispatch(cmd: vk::CommandBuffer, x: u32, y: u32, z: u32) {
    // SAFETY: the function is the device's.
    unsafe { (functions(Command::Dispatch).cmd_dispatch)(cmd, x, y, z) }
}

unsafe extern "system" fn dispatch_indirect(
    cmd: vk::CommandBuffer,
    buffer: vk::Buffer,
    offset: vk::DeviceSize,
) {
    // SAFETY: the function is the device's.
    unsafe { (functions(Command::Dispatch).cmd_dispatch_indirect)(cmd, buffer, offset) }
}

/// The host's device with functions that record.
fn recorded_device(host: &Host) -> Arc<Device> {
    DEVICE.get_or_init(|| host.device.clone());
    let replace = |name: &CStr| match name.to_bytes() {
        b"vkCmdPipelineBarrier" => Some(barrier as *const c_void),
        b"vkCmdBindPipeline" => Some(bind as *const c_void),
        b"vkCmdDispatch" => Some(dispatch as *const c_void),
        b"vkCmdDispatchIndirect" => Some(dispatch_indirect as *const c_void),
        _ => None,
    };
    host.external_device_replaced(replace).unwrap()
}

/// Whether a barrier makes what compute shaders wrote visible to later ones.
fn between_dispatches(command: &Command) -> bool {
    let Command::Barrier { source, target, accesses: [before, after] } = *command else { return false };
    let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
    (source & target).contains(compute)
        && before.contains(vk::AccessFlags::SHADER_WRITE)
        && after.contains(vk::AccessFlags::SHADER_READ)
}

/// Numbers of dispatches, of those of the pipeline of the one before them, and of those with neither a barrier nor a draw since that one.
fn count_dispatches(commands: &[Command]) -> [usize; 3] {
    let mut counts = [0; 3];
    let (mut bound, mut last, mut separate) = (None, None, true);
    for command in commands {
        match *command {
            Command::Bind(vk::PipelineBindPoint::COMPUTE, pipeline) => bound = Some(pipeline),
            // Draws have barriers of their own, most of them of images.
            Command::Bind(..) => separate = true,
            Command::Barrier { .. } => separate |= between_dispatches(command),
            Command::Dispatch => {
                counts[0] += 1;
                counts[1] += usize::from(bound == last);
                counts[2] += usize::from(!separate);
                (last, separate) = (bound, false);
            }
        }
    }
    counts
}

/// The last frame of the first method has all surfels in one tile, whose passes it slices, and that of pull–push the pyramids as published, which
/// it copies.
fn frame_of(number: u32, method: Method) -> (Camera, Settings) {
    let (mut camera, mut settings) = (camera(), settings(method));
    if number == 2 && method == Method::ALL[0] {
        camera.view = DMat4::from_translation(DVec3::new(0.0, 0.0, 30.0)) * camera.view;
    }
    if number == 2 {
        settings.pull_push.iter_mut().for_each(|pull_push| pull_push.storage = Storage::PingPong);
    }
    (camera, settings)
}

/// What is wrong with the barriers of a frame by this rasterizer.
fn wrong(commands: &[Command], rasterizer: Rasterizer) -> Option<String> {
    let waited_for: Vec<_> = commands
        .iter()
        .filter_map(|command| match command {
            Command::Barrier { source, .. } => Some(*source),
            _ => None,
        })
        .collect();
    let waits_for = |stages| waited_for.iter().any(|source| source.intersects(stages));
    // Compute passes do not wait for the host's attachment writes.
    let drawn = waits_for(vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT);
    let too_much = waits_for(vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::ALL_GRAPHICS);
    if waited_for.is_empty() || too_much || drawn && rasterizer == Rasterizer::Compute {
        return Some(format!("waits for {waited_for:?}"));
    }
    let [_, _, missing] = count_dispatches(commands);
    (missing > 0).then(|| format!("{missing} dispatches without a barrier before them: {commands:?}"))
}

#[test]
fn barriers_wait_for_dispatches_and_not_for_everything() {
    let Some(host) = open(|all| all) else { return };
    let device = recorded_device(&host);
    // More than a slice of the tile passes holds.
    let scene = upload(&host, &device, &sphere(33_000));
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, SIZE).unwrap();
    let mut failed = Vec::new();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let options = Options { rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        for method in methods() {
            let mut repeated = Vec::new();
            for number in 0..3 {
                let (camera, settings) = frame_of(number, method);
                COMMANDS.lock().unwrap().clear();
                host.run(|cmd| {
                    // SAFETY: recorded outside and inside the frame's pass, and waited for.
                    unsafe {
                        renderer.prepare(cmd, &scene, &View::whole(camera, SIZE), &settings)?;
                        frame.begin(&host, cmd);
                        renderer.draw(cmd)?;
                        frame.end(&host, cmd);
                    }
                    Ok(())
                })
                .unwrap();
                let commands = COMMANDS.lock().unwrap().clone();
                repeated.push(count_dispatches(&commands)[1]);
                let wrong = wrong(&commands, rasterizer);
                failed.extend(wrong.map(|wrong| format!("{} {rasterizer:?} {number}: {wrong}", method.name)));
            }
            // Levels; slices or copies.
            let [levels, more] = [repeated[1] > 2, repeated[2] > repeated[1]];
            let (pull_push, compute) = (method.pull_push.is_some(), rasterizer == Rasterizer::Compute);
            let copies = method.pull_push.is_some_and(|pull_push| pull_push.storage != Storage::PingPong);
            let expected = [pull_push || compute, copies || compute && method == Method::ALL[0]];
            assert_eq!([levels, more], expected, "{} {rasterizer:?}: {repeated:?}", method.name);
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    frame.destroy(&host);
    drop(scene);
    drop(device);
    assert_silent(&host);
}
