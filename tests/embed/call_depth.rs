//! Depth of the call stack from a renderer's `prepare` to a dispatch: few functions to step through.
//!
//! Optimised builds hide functions that are inlined, unless there are line tables, and functions whose last call is a jump.
//! All are counted with `CARGO_PROFILE_DEV_OPT_LEVEL=0 CARGO_PROFILE_DEV_DEBUG=line-tables-only`.

use crate::compare::settings;
use crate::fixture::{SIZE, assert_silent, camera, open, surfels, upload};
use crate::host::Host;
use crate::host::frame::{Frame, Kind, Way};
use crate::host::native::Native;
use crate::native_rig::PLAIN;
use crate::support::methods;
use crate::{FLOATS, ONE};
use ash::vk;
use std::backtrace::Backtrace;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};
use surfel::Rasterizer;
use surfel::embed::{Options, Renderer, View};
use surfel::settings::methods::Method;
use surfel::vk::Device;

/// Maximum number of the engine's functions on the stack of a dispatch: the renderer's, the frame's, the pass's, the one for
/// its dispatches, and the encoder's.
const MOST: usize = 5;

/// The engine's functions on the stack of each dispatch, innermost first.
static STACKS: Mutex<Vec<Vec<String>>> = Mutex::new(Vec::new());
/// The device's dispatch function.
static DISPATCH: Mutex<Option<vk::PFN_vkCmdDispatch>> = Mutex::new(None);

unsafe extern "system" fn dispatch(cmd: vk::CommandBuffer, x: u32, y: u32, z: u32) {
    STACKS.lock().unwrap().push(of_engine(&Backtrace::force_capture().to_string()));
    let dispatch = DISPATCH.lock().unwrap().unwrap();
    // SAFETY: the function is the device's.
    unsafe { dispatch(cmd, x, y, z) };
}

/// The functions of the engine in a backtrace: by their files, or without line tables by their names.
fn of_engine(backtrace: &str) -> Vec<String> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/src/");
    let mut functions: Vec<(&str, Option<&str>)> = Vec::new();
    for line in backtrace.lines().map(str::trim_start) {
        match (line.strip_prefix("at "), functions.last_mut()) {
            (Some(file), Some((_, found))) => *found = Some(file),
            _ => functions
                .push((line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':').trim(), None)),
        }
    }
    let is_own = |(name, file): &(&str, Option<&str>)| match file {
        Some(file) => file.starts_with("./src/") || file.starts_with(root),
        None => name.starts_with("surfel::") || name.starts_with("<surfel::"),
    };
    functions
        .into_iter()
        .filter(is_own)
        .map(|(name, file)| format!("{name} {}", file.unwrap_or("")))
        .collect()
}

/// The host's device, whose dispatches are recorded.
fn recorded_device(host: &Host) -> Arc<Device> {
    *DISPATCH.lock().unwrap() = Some(host.device.fp_v1_0().cmd_dispatch);
    let replace = |name: &CStr| (name == c"vkCmdDispatch").then_some(dispatch as *const c_void);
    host.external_device_replaced(replace).unwrap()
}

/// Checks the stacks since the last call.
fn check(name: &str) {
    let stacks = std::mem::take(&mut *STACKS.lock().unwrap());
    assert!(!stacks.is_empty() && stacks.iter().all(|stack| !stack.is_empty()), "{name}: {stacks:?}");
    for stack in stacks {
        // The call of Vulkan is the encoder's last one.
        let hidden = usize::from(!stack[0].contains("encoder"));
        assert!(stack.len() + hidden <= MOST, "{name}: {stack:#?}");
    }
}

#[test]
fn few_calls_lead_from_a_renderer_to_a_dispatch() {
    let Some(host) = open(|all| all) else { return };
    let device = recorded_device(&host);
    let scene = upload(&host, &device, &surfels());
    let kind = Kind { way: Way::Subpass, colour: FLOATS, normals: false, samples: ONE, reversed: true };
    let frame = Frame::new(&host, kind, SIZE).unwrap();
    let view = View::whole(camera(), SIZE);
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute].map(Some) {
        let options =
            Options { frames_in_flight: 1, rasterizer: rasterizer.into(), ..Options::new(frame.target()) };
        // SAFETY: the target is the frame's.
        let mut renderer = unsafe { Renderer::new(&device, options) }.unwrap();
        for method in methods() {
            let settings = settings(method);
            host.run(|cmd| {
                // SAFETY: recorded outside a render pass, and waited for.
                unsafe { renderer.prepare(cmd, &scene, &view, &settings)? };
                Ok(())
            })
            .unwrap();
            check(&format!("{} {rasterizer:?}", method.name));
        }
    }
    let settings = settings(Method::ALL[0]);
    let mut native = Native::new(&host, &device, PLAIN, SIZE, &[(scene.streams(), &settings)]).unwrap();
    host.run(|cmd| {
        // SAFETY: as above.
        unsafe { native.renderer.prepare(cmd, &scene, &view, &settings)? };
        Ok(())
    })
    .unwrap();
    check("subpasses");
    native.destroy(&host);
    frame.destroy(&host);
    drop(scene);
    drop(device);
    assert_silent(&host);
}

#[test]
fn functions_of_the_engine_are_found_in_a_backtrace() {
    let without_lines = [
        "   0: embed::call_depth::dispatch",
        "   1: <ash::device::Device>::cmd_dispatch",
        "   2: surfel::vk::encoder::Encoder::dispatch",
        "  13: <surfel::frame::recording::Prepared>::dispatch",
        "  14: core::ops::function::FnOnce::call_once",
    ];
    assert_eq!(of_engine(&without_lines.join("\n")).len(), 2);
    let with_lines = [
        "   0: dispatch",
        "             at ./tests/embed/call_depth.rs:28:30",
        "   1: cmd_dispatch",
        "             at /registry/ash-0.38.0/src/device.rs:1:2",
        "      dispatch<()>",
        "             at ./src/vk/encoder.rs:96:20",
        "   2: record",
        concat!("             at ", env!("CARGO_MANIFEST_DIR"), "/src/frame/recording.rs:1:2"),
    ];
    assert_eq!(of_engine(&with_lines.join("\n")).len(), 2);
}
