//! Barriers of frames: none waits for all earlier work of the host.

use crate::compare::settings;
use crate::fixture::{SIZE, assert_silent, camera, open, surfels, upload};
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::support::methods;
use crate::{FLOATS, ONE};
use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};
use surfel::Rasterizer;
use surfel::embed::{Options, Renderer, View};
use surfel::vk::Device;

/// Source stages of the barriers on the host's device.
static WAITED_FOR: Mutex<Vec<vk::PipelineStageFlags>> = Mutex::new(Vec::new());
/// The device's barrier function.
static RECORDING: Mutex<Option<vk::PFN_vkCmdPipelineBarrier>> = Mutex::new(None);

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
    WAITED_FOR.lock().unwrap().push(source);
    let record = RECORDING.lock().unwrap().unwrap();
    // SAFETY: the function is the device's.
    unsafe {
        record(cmd, source, target, dependencies, memories, memory, buffers, buffer, images, image);
    }
}

/// The host's device with a recording barrier function.
fn recorded_device(host: &Host) -> Arc<Device> {
    *RECORDING.lock().unwrap() = Some(host.device.fp_v1_0().cmd_pipeline_barrier);
    let replace = |name: &CStr| (name == c"vkCmdPipelineBarrier").then_some(barrier as *const c_void);
    host.external_device_replaced(replace).unwrap()
}

#[test]
fn no_barrier_waits_for_everything() {
    let Some(host) = open(|all| all) else { return };
    let device = recorded_device(&host);
    let scene = upload(&host, &device, &surfels());
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, SIZE).unwrap();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let options = Options { rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        for method in methods() {
            let settings = settings(method);
            for number in 0..3 {
                WAITED_FOR.lock().unwrap().clear();
                host.run(|cmd| {
                    // SAFETY: recorded outside and inside the frame's pass, and waited for.
                    unsafe {
                        renderer.prepare(cmd, &scene, &View::whole(camera(), SIZE), &settings)?;
                        frame.begin(&host, cmd);
                        renderer.draw(cmd)?;
                        frame.end(&host, cmd);
                    }
                    Ok(())
                })
                .unwrap();
                let waited_for = WAITED_FOR.lock().unwrap().clone();
                let too_much = vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::ALL_GRAPHICS;
                assert!(
                    !waited_for.is_empty() && !waited_for.iter().any(|stages| stages.intersects(too_much)),
                    "{} {rasterizer:?}, frame {number}: {waited_for:?}",
                    method.name
                );
                // Compute passes do not wait for the host's attachment writes.
                let attachments = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT;
                let drawn = waited_for.iter().any(|stages| stages.intersects(attachments));
                assert!(!drawn || rasterizer == Rasterizer::Draw, "{}: {waited_for:?}", method.name);
            }
        }
    }
    frame.destroy(&host);
    drop(scene);
    drop(device);
    assert_silent(&host);
}
