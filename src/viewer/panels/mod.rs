//! Panels of the window: messages, choices, legend, start page and help.

mod axes;
mod buffers;
mod error;
mod filter;
mod help;
mod hint;
mod histogram;
mod kernel;
mod legend;
mod method;
mod raster;
mod render_settings;
mod split;
mod start;
mod times;
mod ui_state;
mod widgets;

use super::choices::Choices;
use super::keys::{Action, BINDINGS};
use super::scene_info::short_name;
use super::state::ViewState;
use egui::{Button, CollapsingHeader, Label, Panel, ProgressBar, Rect, RichText, ScrollArea, Ui, pos2};
use std::sync::Arc;
use std::time::Duration;
use surfel::thousands;
use surfel::vk::Device;
pub use ui_state::UiState;

/// Initial width of the panel, as part of the window.
const PART: f32 = 0.3;
/// Range of the initial width, points; the first is the minimum at any time.
const WIDTH: [f32; 2] = [240.0, 300.0];
/// Maximum width of the panel, as part of the window. A window in which that is below the minimum has no panel.
const MAX_PART: f32 = 0.5;
/// How often the progress of reading a property is shown.
const POLL_PERIOD: Duration = Duration::from_millis(100);
/// Number of inputs that are listed by name.
const LISTED: usize = 4;
/// Width for the value and the name beside a slider, points.
const SLIDER: f32 = 150.0;

/// Shows all panels; returns the width of the panel beside the picture, points.
pub fn show(ui: &mut Ui, state: &mut ViewState, ui_state: &mut UiState, device: &Arc<Device>) -> f32 {
    let whole = ui.max_rect();
    if let Some(choices) = state.choices() {
        ui_state.split.update(&choices);
    }
    if let Some((stage, part)) = ui_state.loading {
        Panel::bottom("loading").show(ui, |ui| {
            ui.horizontal(|ui| {
                state.cancel |= ui.button("Cancel").on_hover_text("Esc. The scene before stays.").clicked();
                ui.add(ProgressBar::new(part).text(stage));
            })
        });
    }
    messages(ui, ui_state);
    let covered = side_panel(ui, state, ui_state, device);
    let picture = Rect { max: pos2(whole.right() - covered, whole.bottom()), ..whole };
    let free = ui.available_rect_before_wrap();
    ui_state.split.divider(ui, [picture, free], state, &ui_state.times);
    match state.names() {
        Some(_) => legend::show(ui, free, picture, state, ui_state),
        None if ui_state.loading.is_none() => start::show(ui, free, state, &ui_state.layout),
        None => {}
    }
    if ui_state.panel_hidden && MAX_PART * whole.width() >= WIDTH[0] {
        ui_state.hint.show(ui, free, &ui_state.layout);
    }
    ui_state.errors.window.show(ui.ctx(), "error");
    ui_state.buffers.window.show(ui.ctx(), "buffer");
    help::show(ui.ctx(), &ui_state.layout, &mut ui_state.show_help);
    if let Some(dialog) = &mut state.dialog {
        state.dialog_result = dialog.show(ui).or(state.dialog_result.take());
    }
    if let Err(error) = state.apply(device) {
        ui_state.error = Some(error.to_string());
    }
    if state.is_reading() {
        ui.ctx().request_repaint_after(POLL_PERIOD);
    }
    covered
}

/// Shows the last message below and the last error above the picture, each with a button that closes it; an error of rendering stays while it
/// persists.
fn messages(ui: &mut Ui, ui_state: &mut UiState) {
    if let Some(message) = &ui_state.message {
        let panel = Panel::bottom("message").show(ui, |ui| closable(ui, message.into()));
        if panel.inner {
            ui_state.message = None;
        }
    }
    let error = |ui: &Ui, text: &str| RichText::new(text).color(ui.visuals().error_fg_color);
    if let Some(text) = &ui_state.error {
        if Panel::top("error").show(ui, |ui| closable(ui, error(ui, text))).inner {
            ui_state.error = None;
        }
    } else if let Some(text) = &ui_state.render_error {
        Panel::top("error").show(ui, |ui| ui.label(error(ui, text)));
    }
}

/// Shows a text after a button; returns whether the button was clicked.
fn closable(ui: &mut Ui, text: RichText) -> bool {
    let row = ui.horizontal_top(|ui| {
        let button = ui.small_button("×").on_hover_text("Closes this message.");
        ui.add(Label::new(text).wrap());
        button.clicked()
    });
    row.inner
}

/// Shows the panel on the right unless it is hidden or the window is too narrow; returns its width, points.
fn side_panel(ui: &mut Ui, state: &mut ViewState, ui_state: &mut UiState, device: &Arc<Device>) -> f32 {
    let (whole, [min, max_initial]) = (ui.max_rect(), WIDTH);
    let max = MAX_PART * whole.width();
    if ui_state.panel_hidden || max < min {
        return 0.0;
    }
    let initial = (PART * whole.width()).clamp(min, max_initial);
    let panel = Panel::right("choices").default_size(initial).size_range(min..=max);
    let panel = panel.show(ui, |ui| {
        ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| show_choices(ui, state, ui_state, device));
    });
    (whole.right() - panel.response.rect.left()).max(0.0)
}

fn show_choices(ui: &mut Ui, state: &mut ViewState, ui_state: &mut UiState, device: &Arc<Device>) {
    let [hide, help] = [Action::Panels, Action::Help].map(|action| {
        let binding = BINDINGS.iter().find(|binding| binding.action == action);
        binding.map_or(String::new(), |binding| ui_state.layout.name(binding))
    });
    ui.horizontal(|ui| {
        let listed = ui.add(Button::new("Keys and mouse").selected(ui_state.show_help));
        if listed.on_hover_text(format!("{help} shows or hides the list; Esc closes it.")).clicked() {
            ui_state.show_help = !ui_state.show_help;
        }
        ui.label(format!("{hide} hides this panel")).on_hover_text(format!("{hide} shows it again."));
    });
    let Some(choices) = &mut state.choices() else { return };
    // Leaves room for the scroll bar.
    ui.set_max_width(ui.available_width() - 10.0);
    ui.spacing_mut().slider_width = (ui.available_width() - SLIDER).clamp(40.0, 100.0);
    scene_info(ui, choices);
    filter::show(ui, choices);
    if let Some(estimated) = &choices.source.info().estimated {
        // Below the filter, which would move with every change of this text.
        ui.label(format!("Estimated: {estimated}"));
    }
    CollapsingHeader::new("Method").default_open(true).show(ui, |ui| method::show(ui, choices));
    CollapsingHeader::new("Render settings")
        .default_open(true)
        .show(ui, |ui| render_settings::show(ui, choices));
    let detail = times::FrameDetail {
        size: choices.size,
        scale: ui_state.scale,
        surfels: ui_state.surfels,
        all_surfels: choices.surfels,
    };
    ui_state.times.show(ui, &detail, choices.settings, ui_state.frame_ms);
    ui.collapsing("Split view", |ui| ui_state.split.show(ui, choices));
    ui.collapsing("Error", |ui| ui_state.errors.show(ui, choices, device));
    ui.collapsing("Buffers", |ui| ui_state.buffers.show(ui, choices, device));
}

/// Shows names and number of points.
fn scene_info(ui: &mut Ui, choices: &Choices<'_>) {
    let info = choices.source.info();
    for name in info.names.iter().take(LISTED) {
        ui.add(Label::new(RichText::new(short_name(name)).strong()).truncate()).on_hover_text(name);
    }
    if let Some(others) = info.names.get(LISTED..).filter(|others| !others.is_empty()) {
        ui.label(format!("and {} more", others.len())).on_hover_text(others.join("\n"));
    }
    let counted = match (info.points, info.dropped) {
        _ if choices.preview => format!("preview of {} points", thousands(choices.surfels)),
        (0, _) => format!("{} surfels", thousands(choices.surfels)),
        (points, 0) => format!("{} points", thousands(points)),
        (points, dropped) => format!("{} points, {} left out", thousands(points), thousands(dropped)),
    };
    ui.label(counted);
}
