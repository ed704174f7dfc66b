//! HUD: lays out the panels with egui, gives them their input, and records them over the picture.

use super::panels::{self, UiState};
use super::state::ViewState;
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
    /// When the panels have to be drawn again without an event.
    wakes: Option<Instant>,
    /// The rectangle without panels, points.
    free: Rect,
    /// Width of the panel beside the picture, points.
    covered: f32,
    /// Position of the cursor, px.
    cursor: PhysicalPosition<f64>,
    /// Mouse buttons that are down.
    down: Vec<MouseButton>,
    /// Those of them whose events are the panels' until they are released.
    captured: Vec<MouseButton>,
    device: Arc<Device>,
}

fn convert_error(error: &RendererError) -> Error {
    match error {
        RendererError::Vulkan(result) => Error::Vulkan { call: "drawing the panels", result: *result },
        other => Error::Usage(format!("cannot draw the panels: {other}")),
    }
}

impl Hud {
    /// Panels of a window, which are drawn within the render pass `overlay`.
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
        let renderer = renderer.map_err(|error| convert_error(&error))?;
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
            captured: Vec::new(),
            device: device.clone(),
        })
    }

    /// Gives the panels an event; returns whether they consume it, and whether they need a redraw.
    pub fn on_window_event(&mut self, window: &Window, event: &WindowEvent) -> [bool; 2] {
        let response = self.egui_state.on_window_event(window, event);
        [self.consumes(event).unwrap_or(response.consumed), response.repaint]
    }

    /// Whether the panels consume a mouse event, by the cursor's present position; `None` for other events. egui's own answer is for the position
    /// at the last layout, which a fast cursor has left.
    fn consumes(&mut self, event: &WindowEvent) -> Option<bool> {
        match event {
            WindowEvent::CursorMoved { position, .. } => self.cursor = *position,
            WindowEvent::MouseWheel { .. } => return Some(self.is_over()),
            WindowEvent::MouseInput { state: ElementState::Pressed, button, .. } => {
                let consumed = !self.captured.is_empty() || self.is_over();
                self.down.push(*button);
                self.captured.extend(consumed.then_some(*button));
                return Some(consumed);
            }
            WindowEvent::MouseInput { state: ElementState::Released, button, .. } => {
                self.down.retain(|down| down != button);
                self.captured.retain(|captured| captured != button);
            }
            // Without the focus no release is reported.
            WindowEvent::Focused(false) => {
                self.down.clear();
                self.captured.clear();
                return None;
            }
            _ => return None,
        }
        Some(!self.captured.is_empty())
    }

    /// Whether the cursor is over a panel or a floating window.
    fn is_over(&self) -> bool {
        let LogicalPosition { x, y } = self.cursor.to_logical(self.context.pixels_per_point().into());
        let at = Pos2::new(x, y);
        let is_floating = |layer| layer != LayerId::background();
        !self.free.contains(at) || self.context.layer_id_at(at).is_some_and(is_floating)
    }

    /// Lays the panels out and sets the viewport's size to what they leave; returns whether they need another frame at once.
    pub fn lay_out(&mut self, window: &Window, state: &mut ViewState, ui_state: &mut UiState) -> bool {
        let input = self.egui_state.take_egui_input(window);
        let device = &self.device;
        let (free, covered) = (&mut self.free, &mut self.covered);
        let output = self.context.run_ui(input, |ui| {
            *covered = panels::show(ui, state, ui_state, device);
            *free = ui.available_rect_before_wrap();
        });
        let PhysicalSize { width, height } = window.inner_size();
        state.viewport.size = self.picture_size([width, height].map(|side| side.max(1)));
        if self.context.egui_is_using_pointer() {
            // The edge of a panel can be grabbed from beside it, too.
            self.captured.clone_from(&self.down);
        }
        self.egui_state.handle_platform_output(window, output.platform_output);
        self.shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        self.textures.append(output.textures_delta);
        let delay = output.viewport_output.values().map(|viewport| viewport.repaint_delay).min();
        let delay = delay.unwrap_or(Duration::MAX);
        self.wakes = Instant::now().checked_add(delay).filter(|_| delay < Duration::from_secs(3600));
        delay.is_zero()
    }

    /// Width and height of the picture in a window of this size, px: the window without the panel on the right as it was last laid out.
    pub fn picture_size(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let covered = (f64::from(self.covered * self.context.pixels_per_point())).floor() as u32;
        [width.saturating_sub(covered).max(1), height]
    }

    /// Whether a drop-down list or a menu is open.
    pub fn has_open_list(&self) -> bool {
        Popup::is_any_open(&self.context)
    }

    /// When the panels have to be drawn again without an event.
    pub fn wakes(&self) -> Option<Instant> {
        self.wakes
    }

    /// Records the panels over the window's picture. The GPU must have finished all frames but the last.
    pub fn record(&mut self, window: &mut Presented) -> Result<()> {
        self.update_textures()?;
        let [width, height] = window.size();
        let (extent, scale) = (vk::Extent2D { width, height }, self.context.pixels_per_point());
        let (renderer, shapes) = (&mut self.renderer, &self.shapes);
        let mut result = Ok(());
        window.over("hud", |cmd| result = renderer.cmd_draw(cmd, extent, scale, shapes));
        result.map_err(|error| convert_error(&error))
    }

    /// Updates the panels' textures. Waits for the GPU, which may still read them.
    fn update_textures(&mut self) -> Result<()> {
        let mut textures = std::mem::take(&mut self.textures);
        let set: Vec<_> = textures.set.drain().collect();
        let free: Vec<_> = textures.free.drain().collect();
        if set.is_empty() && free.is_empty() {
            return Ok(());
        }
        let Self { renderer, pool, .. } = self;
        let done = pool.submit(|queue, pool| {
            let mut all = set.iter().flat_map(|(id, deltas)| deltas.iter().map(move |delta| (*id, delta)));
            all.try_for_each(|(id, delta)| renderer.set_texture(queue, pool, id, delta))
        })?;
        done.map_err(|error| convert_error(&error))?;
        self.device.wait_idle()?;
        free.into_iter().try_for_each(|id| renderer.free_texture(id)).map_err(|error| convert_error(&error))
    }
}

impl Drop for Hud {
    fn drop(&mut self) {
        // Pending updates are not needed any more.
        self.textures.clear();
    }
}

#[cfg(test)]
mod tests {
    use crate::viewer::tests::device;
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;
    use surfel::vk::CommandPool;

    #[test]
    fn a_submission_and_a_wait_do_not_wait_for_each_other() {
        let Some(device) = device("a_submission_and_a_wait_do_not_wait_for_each_other") else { return };
        let (done, both) = mpsc::channel();
        let (drops, submits, dropping) = (done.clone(), done, device.clone());
        thread::spawn(move || {
            (0..500).for_each(|_| drop(CommandPool::new(&dropping).unwrap()));
            drops.send(())
        });
        thread::spawn(move || {
            let pool = CommandPool::new(&device).unwrap();
            (0..5_000).for_each(|_| pool.submit(|_, _| thread::yield_now()).unwrap());
            submits.send(())
        });
        (0..2).for_each(|_| both.recv_timeout(Duration::from_secs(60)).expect("they wait for each other"));
    }
}
