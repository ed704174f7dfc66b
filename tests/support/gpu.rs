//! A device under validation, for tests that need one.

use std::sync::Arc;
use surfel::geometry::{Camera, Parts};
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{Picture, RenderOptions, Renderer, Scene, Settings};

/// A device under validation, less what `limits` hide; `None`, said aloud, where there is none. With `SURFEL_REQUIRE_GPU` set, the
/// lack of one is a failure.
pub fn device(limits: DeviceLimits) -> Option<Arc<Device>> {
    match Device::open(&DeviceOptions { validate: true, limits, ..Default::default() }) {
        Ok(device) => Some(device),
        Err(error) if std::env::var_os("SURFEL_REQUIRE_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            eprintln!("SKIPPED, not passed: {error}");
            None
        }
    }
}

/// Fails on any message of the validation layers.
pub fn assert_silent(device: &Device) {
    let messages = device.validation_messages();
    assert!(messages.is_empty(), "{} validation messages: {messages:#?}", messages.len());
}

/// One frame of `parts` on `device`.
pub fn render<'a>(
    device: &Arc<Device>,
    parts: impl Into<Parts<'a>>,
    camera: &Camera,
    settings: &Settings,
    options: RenderOptions,
) -> Picture {
    let scene = Scene::upload(device, parts).unwrap();
    let mut renderer = Renderer::new(device, options).unwrap();
    renderer.render_picture(&scene, camera, settings).unwrap().0
}
