//! A device under validation, for tests that need one.

use super::skipping::say_skipped;
use std::cell::RefCell;
use std::ops::Deref;
use std::rc::{Rc, Weak};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use surfel::geometry::{Camera, Parts};
use surfel::vk::{Device, DeviceLimits, DeviceOptions};
use surfel::{FrameReport, Instances, Picture, RenderOptions, Renderer, Scene, Settings};

/// A device under validation.
pub struct TestDevice {
    device: Arc<Device>,
    /// Of devices that are not shared.
    _alone: Option<Alone>,
}

impl Deref for TestDevice {
    type Target = Arc<Device>;

    fn deref(&self) -> &Arc<Device> {
        &self.device
    }
}

/// A device under validation, less what `limits` hide. Without one the test is skipped with a note, or fails if `SURFEL_REQUIRE_GPU` is set.
/// Without limits all tests share one device with the pipelines that they make, and its validation messages.
pub fn device(limits: DeviceLimits) -> Option<TestDevice> {
    if limits == DeviceLimits::default() {
        shared().map(|device| TestDevice { device, _alone: None })
    } else {
        new_device(limits)
    }
}

/// As [`device`], but a new one, for tests that count what is allocated or made.
pub fn new_device(limits: DeviceLimits) -> Option<TestDevice> {
    let alone = alone();
    open(limits).map(|device| TestDevice { device, _alone: Some(alone) })
}

fn shared() -> Option<Arc<Device>> {
    static SHARED: OnceLock<Option<Arc<Device>>> = OnceLock::new();
    SHARED.get_or_init(|| open(DeviceLimits::default())).clone()
}

fn open(limits: DeviceLimits) -> Option<Arc<Device>> {
    match Device::open(&DeviceOptions { validate: true, limits, ..Default::default() }) {
        Ok(device) => Some(device),
        Err(error) if std::env::var_os("SURFEL_REQUIRE_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            say_skipped(&error.to_string());
            None
        }
    }
}

/// While it is held, no other thread has devices of its own under validation.
///
/// The validation layers (1.3.239) find what they know of a device by a hash table that `vkCreateDevice` and `vkDestroyDevice` change without
/// a lock: calls by other threads, of whatever device, may crash. The first instance of a process and its first device are not in that table,
/// so the shared device is opened before all others.
pub type Alone = Rc<MutexGuard<'static, ()>>;

/// Waits until no other thread has devices of its own. A thread that has some may have more.
pub fn alone() -> Alone {
    static ALONE: Mutex<()> = Mutex::new(());
    thread_local! {
        static HELD: RefCell<Weak<MutexGuard<'static, ()>>> = const { RefCell::new(Weak::new()) };
    }
    shared();
    HELD.with_borrow_mut(|held| {
        held.upgrade().unwrap_or_else(|| {
            let alone = Rc::new(ALONE.lock().unwrap_or_else(PoisonError::into_inner));
            *held = Rc::downgrade(&alone);
            alone
        })
    })
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

/// Renderers that keep what they have made from picture to picture: pipelines cost more than small pictures do.
#[allow(dead_code, reason = "some tests render a single picture")]
pub struct Renderers {
    device: Arc<Device>,
    made: RefCell<Vec<(RenderOptions, Renderer)>>,
}

#[allow(dead_code, reason = "some tests render a single picture")]
impl Renderers {
    pub fn new(device: &Arc<Device>) -> Self {
        Self { device: device.clone(), made: RefCell::default() }
    }

    /// [`render`], by the renderer of these options.
    pub fn render<'a>(
        &self,
        parts: impl Into<Parts<'a>>,
        camera: &Camera,
        settings: &Settings,
        options: RenderOptions,
    ) -> Picture {
        self.render_instances(&Scene::upload(&self.device, parts).unwrap(), camera, settings, options).0
    }

    /// One frame of scenes that are on the device, and its report, by the renderer of these options.
    pub fn render_instances<'a>(
        &self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
        options: RenderOptions,
    ) -> (Picture, FrameReport) {
        let mut made = self.made.borrow_mut();
        let place = made.iter().position(|(of, _)| *of == options).unwrap_or_else(|| {
            made.push((options, Renderer::new(&self.device, options).unwrap()));
            made.len() - 1
        });
        made[place].1.render_picture(scenes, camera, settings).unwrap()
    }
}
