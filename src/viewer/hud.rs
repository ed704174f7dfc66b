//! Panels over the picture: what is shown, how, and what keys do.
#![allow(unsafe_code, reason = "egui's renderer records by Vulkan's own handles")]

use super::panels::{self, Told};
use super::state::State;
use ash::vk;
use egui::{ClippedPrimitive, TexturesDelta};
use egui_ash_renderer::allocator::DefaultAllocator;
use egui_ash_renderer::{Options, RenderMode, Renderer, RendererError};
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::vk::{Device, FRAMES_IN_FLIGHT, Presented, Recorder};
use surfel::{Error, Result};
use winit::event::WindowEvent;
use winit::window::Window;

/// The panels of a window.
pub struct Hud {
    renderer: Renderer<DefaultAllocator>,
    pool: vk::CommandPool,
    context: egui::Context,
    hands: egui_winit::State,
    textures: TexturesDelta,
    shapes: Vec<ClippedPrimitive>,
    /// When the panels want to be drawn again.
    wakes: Option<Instant>,
    device: Arc<Device>,
}

fn failed(error: &RendererError) -> Error {
    match error {
        RendererError::Vulkan(result) => Error::Vulkan { call: "drawing the panels", result: *result },
        other => Error::Usage(format!("the panels cannot be drawn: {other}")),
    }
}

impl Hud {
    /// Panels drawn within the render pass `overlay`.
    pub fn new(device: &Arc<Device>, window: &Window, overlay: vk::RenderPass) -> Result<Self> {
        let context = egui::Context::default();
        let hands = egui_winit::State::new(context.clone(), egui::ViewportId::ROOT, window, None, None, None);
        let options = Options {
            in_flight_frames: FRAMES_IN_FLIGHT as usize,
            srgb_framebuffer: true,
            ..Default::default()
        };
        let (raw, mode) = (device.handle().clone(), RenderMode::RenderPass(overlay));
        let renderer =
            Renderer::with_default_allocator(device.instance(), device.physical(), raw, mode, options);
        let renderer = renderer.map_err(|error| failed(&error))?;
        let pool = device.submit(|_, family| {
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
            // SAFETY: the family is the device's; the pool is destroyed in `drop`.
            unsafe { device.handle().create_command_pool(&info, None) }
        })?;
        let pool = pool.map_err(Error::vulkan("vkCreateCommandPool"))?;
        let (textures, shapes) = (TexturesDelta::default(), Vec::new());
        Ok(Self { renderer, pool, context, hands, textures, shapes, wakes: None, device: device.clone() })
    }

    /// Tells the panels of an event; whether it is theirs, and whether they look different now.
    pub fn tell(&mut self, window: &Window, event: &WindowEvent) -> [bool; 2] {
        let response = self.hands.on_window_event(window, event);
        [response.consumed, response.repaint]
    }

    /// Lays the panels out; whether they want to be drawn again at once.
    pub fn lay_out(&mut self, window: &Window, state: &mut State, told: &mut Told) -> bool {
        let input = self.hands.take_egui_input(window);
        let device = &self.device;
        let output = self.context.run_ui(input, |ui| panels::show(ui, state, told, device));
        self.hands.handle_platform_output(window, output.platform_output);
        self.shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.textures.append(output.textures_delta);
        let delay = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min();
        let delay = delay.unwrap_or(Duration::MAX);
        self.wakes = Instant::now().checked_add(delay).filter(|_| delay < Duration::from_secs(3600));
        delay.is_zero()
    }

    /// When the panels want to be drawn again, if nothing happens before.
    pub fn wakes(&self) -> Option<Instant> {
        self.wakes
    }

    /// Records the panels over the window's picture, when the GPU is done with all but the last frame.
    pub fn record(&mut self, window: &Presented) -> Result<()> {
        self.take_textures()?;
        let [width, height] = window.size;
        let (extent, scale) = (vk::Extent2D { width, height }, self.context.pixels_per_point());
        let (renderer, shapes) = (&mut self.renderer, &self.shapes);
        let mut drawn = Ok(());
        // SAFETY: the presenter's command buffer is being recorded, and it submits in order.
        let mut rec = unsafe { Recorder::of_host(&self.device, window.cmd) };
        rec.over("hud", window, || drawn = renderer.cmd_draw(window.cmd, extent, scale, shapes));
        drawn.map_err(|error| failed(&error))
    }

    /// Brings the panels' textures up to date: each is set behind everything that was submitted, which is waited for.
    fn take_textures(&mut self) -> Result<()> {
        let mut textures = std::mem::take(&mut self.textures);
        let (renderer, pool) = (&mut self.renderer, self.pool);
        if textures.set.is_empty() && textures.free.is_empty() {
            return Ok(());
        }
        let device = self.device.handle();
        let done = self.device.submit(|queue, _| -> Result<(), RendererError> {
            for (id, deltas) in textures.set.drain() {
                deltas.iter().try_for_each(|delta| renderer.set_texture(queue, pool, id, delta))?;
            }
            // SAFETY: the queue is locked.
            unsafe { device.queue_wait_idle(queue)? };
            textures.free.drain().try_for_each(|id| renderer.free_texture(id))
        })?;
        done.map_err(|error| failed(&error))
    }
}

impl Drop for Hud {
    fn drop(&mut self) {
        // SAFETY: the presenter has waited for the device.
        unsafe { self.device.handle().destroy_command_pool(self.pool, None) };
    }
}
