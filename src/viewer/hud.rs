//! Panels over the picture and beside it: what is shown, how, and what keys do.

use super::panels::{self, UiState};
use super::state::State;
use super::style;
use ash::vk;
use egui::{ClippedPrimitive, LayerId, Popup, Pos2, Rect, TexturesDelta};
use egui_ash_renderer::allocator::DefaultAllocator;
use egui_ash_renderer::{Options, RenderMode, Renderer, RendererError};
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::vk::{CommandPool, Device, FRAMES_IN_FLIGHT, Presented};
use surfel::{Error, Result};
use winit::dpi::{LogicalPosition, PhysicalPosition, PhysicalSize};
use winit::event::{ElementState, MouseButton, WindowEvent};
use winit::window::Window;

/// The panels of a window.
pub struct Hud {
    renderer: Renderer<DefaultAllocator>,
    pool: CommandPool,
    context: egui::Context,
    egui_state: egui_winit::State,
    textures: TexturesDelta,
    shapes: Vec<ClippedPrimitive>,
    /// When the panels want to be drawn again.
    wakes: Option<Instant>,
    /// Where no panel is over the picture or beside it, points.
    free: Rect,
    /// Width of the panel beside the picture, points.
    covered: f32,
    /// Where the cursor is, px.
    cursor: PhysicalPosition<f64>,
    /// Buttons that are down, and those of them that are the panels' until they are let go: they went down over one, or have hold of something.
    down: Vec<MouseButton>,
    held: Vec<MouseButton>,
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
        style::apply(&context);
        let egui_state =
            egui_winit::State::new(context.clone(), egui::ViewportId::ROOT, window, None, None, None);
        let options = Options {
            in_flight_frames: FRAMES_IN_FLIGHT as usize,
            srgb_framebuffer: true,
            ..Default::default()
        };
        let (raw, mode) = (device.handle().clone(), RenderMode::RenderPass(overlay));
        let renderer =
            Renderer::with_default_allocator(device.instance(), device.physical(), raw, mode, options);
        let renderer = renderer.map_err(|error| failed(&error))?;
        let pool = CommandPool::new(device)?;
        let (textures, shapes) = (TexturesDelta::default(), Vec::new());
        Ok(Self {
            renderer,
            pool,
            context,
            egui_state,
            textures,
            shapes,
            wakes: None,
            free: Rect::EVERYTHING,
            covered: 0.0,
            cursor: PhysicalPosition::default(),
            down: Vec::new(),
            held: Vec::new(),
            device: device.clone(),
        })
    }

    /// Tells the panels of an event; whether it is theirs, and whether they look different now.
    pub fn tell(&mut self, window: &Window, event: &WindowEvent) -> [bool; 2] {
        let response = self.egui_state.on_window_event(window, event);
        [self.is_theirs(event).unwrap_or(response.consumed), response.repaint]
    }

    /// Whether the mouse's events are the panels': by where the cursor is now. Their own answer is of where it was when they were laid out, and a
    /// quick hand has left them since.
    fn is_theirs(&mut self, event: &WindowEvent) -> Option<bool> {
        match event {
            WindowEvent::CursorMoved { position, .. } => self.cursor = *position,
            WindowEvent::MouseWheel { .. } => return Some(self.is_over()),
            WindowEvent::MouseInput { state: ElementState::Pressed, button, .. } => {
                let theirs = !self.held.is_empty() || self.is_over();
                self.down.push(*button);
                self.held.extend(theirs.then_some(*button));
                return Some(theirs);
            }
            WindowEvent::MouseInput { state: ElementState::Released, button, .. } => {
                self.down.retain(|down| down != button);
                self.held.retain(|held| held != button);
            }
            // What is let go now nobody tells.
            WindowEvent::Focused(false) => {
                self.down.clear();
                self.held.clear();
                return None;
            }
            _ => return None,
        }
        Some(!self.held.is_empty())
    }

    /// Whether the cursor is over a panel, or over what can be taken hold of.
    fn is_over(&self) -> bool {
        let LogicalPosition { x, y } = self.cursor.to_logical(self.context.pixels_per_point().into());
        let at = Pos2::new(x, y);
        let floats = |layer| layer != LayerId::background();
        !self.free.contains(at) || self.context.layer_id_at(at).is_some_and(floats)
    }

    /// Lays the panels out, beside which the picture is; whether they want to be drawn again at once.
    pub fn lay_out(&mut self, window: &Window, state: &mut State, ui_state: &mut UiState) -> bool {
        let input = self.egui_state.take_egui_input(window);
        let device = &self.device;
        let (free, covered) = (&mut self.free, &mut self.covered);
        let output = self.context.run_ui(input, |ui| {
            *covered = panels::show(ui, state, ui_state, device);
            *free = ui.available_rect_before_wrap();
        });
        let PhysicalSize { width, height } = window.inner_size();
        state.viewport.size = self.beside([width, height].map(|side| side.max(1)));
        if self.context.egui_is_using_pointer() {
            // An edge is taken hold of from a little beside it, too.
            self.held.clone_from(&self.down);
        }
        self.egui_state.handle_platform_output(window, output.platform_output);
        self.shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.textures.append(output.textures_delta);
        let delay = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min();
        let delay = delay.unwrap_or(Duration::MAX);
        self.wakes = Instant::now().checked_add(delay).filter(|_| delay < Duration::from_secs(3600));
        delay.is_zero()
    }

    /// Width and height of the picture in a window of so many px: what the panel on the right leaves of it, as it was laid out last.
    pub fn beside(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let covered = (f64::from(self.covered * self.context.pixels_per_point())).floor() as u32;
        [width.saturating_sub(covered).max(1), height]
    }

    /// Whether a drop-down list or a menu is open.
    pub fn has_open_list(&self) -> bool {
        Popup::is_any_open(&self.context)
    }

    /// When the panels want to be drawn again, if nothing happens before.
    pub fn wakes(&self) -> Option<Instant> {
        self.wakes
    }

    /// Records the panels over the window's picture, when the GPU is done with all but the last frame.
    pub fn record(&mut self, window: &mut Presented) -> Result<()> {
        self.take_textures()?;
        let [width, height] = window.size();
        let (extent, scale) = (vk::Extent2D { width, height }, self.context.pixels_per_point());
        let (renderer, shapes) = (&mut self.renderer, &self.shapes);
        let mut drawn = Ok(());
        window.over("hud", |cmd| drawn = renderer.cmd_draw(cmd, extent, scale, shapes));
        drawn.map_err(|error| failed(&error))
    }

    /// Brings the panels' textures up to date: each is set behind everything that was submitted, which is waited for.
    fn take_textures(&mut self) -> Result<()> {
        let mut textures = std::mem::take(&mut self.textures);
        let set: Vec<_> = textures.set.drain().collect();
        let free: Vec<_> = textures.free.drain().collect();
        if set.is_empty() && free.is_empty() {
            return Ok(());
        }
        let (renderer, pool) = (&mut self.renderer, self.pool.handle());
        let done = self.device.submit(|queue, _| {
            let mut all = set.iter().flat_map(|(id, deltas)| deltas.iter().map(move |delta| (*id, delta)));
            all.try_for_each(|(id, delta)| renderer.set_texture(queue, pool, id, delta))
        })?;
        done.map_err(|error| failed(&error))?;
        self.device.wait_idle()?;
        free.into_iter().try_for_each(|id| renderer.free_texture(id)).map_err(|error| failed(&error))
    }
}

impl Drop for Hud {
    fn drop(&mut self) {
        // Of a window that closes nobody sees them.
        self.textures.clear();
    }
}
