//! The panels: what they say, and what they let one choose.

mod axes;
mod buffers;
mod error;
mod help;
mod kernel;
mod legend;
mod method;
mod raster;
mod render_settings;
mod split;
mod start;
mod times;
mod ui_state;

use super::about::{short_name, thousands};
use super::keys::{Action, BINDINGS};
use super::state::{Choices, State};
use egui::{Button, CollapsingHeader, Label, Panel, ProgressBar, Rect, RichText, ScrollArea, Ui, pos2};
use std::sync::Arc;
use std::time::Duration;
use surfel::vk::Device;
pub use ui_state::UiState;

/// Width of the panel at first, as part of the window; and its least and usual one, points.
const PART: f32 = 0.3;
const WIDTH: [f32; 2] = [240.0, 300.0];
/// Part of the window that the panel takes at most: a window in which that is less than its least width has none.
const MOST: f32 = 0.5;
/// How often numbers that are being read are asked for.
const OFTEN: Duration = Duration::from_millis(100);
/// How many inputs are listed by name.
const LISTED: usize = 4;
/// What stands beside a slider at most: its number and its name, points.
const SLIDER: f32 = 150.0;

/// All panels; gives the width of the one beside the picture, points.
pub fn show(ui: &mut Ui, state: &mut State, ui_state: &mut UiState, device: &Arc<Device>) -> f32 {
    let whole = ui.max_rect();
    if let Some((stage, part)) = ui_state.loading {
        Panel::bottom("loading").show(ui, |ui| {
            ui.horizontal(|ui| {
                state.cancel |=
                    ui.button("give up").on_hover_text("Esc; what was shown before stays").clicked();
                ui.add(ProgressBar::new(part).text(stage));
            })
        });
    }
    if let Some(done) = &ui_state.message {
        Panel::bottom("done").show(ui, |ui| ui.label(done));
    }
    if let Some(wrong) = ui_state.error.as_ref().or(ui_state.render_error.as_ref()) {
        Panel::top("wrong").show(ui, |ui| ui.colored_label(ui.visuals().error_fg_color, wrong));
    }
    let covered = beside(ui, state, ui_state, device);
    let picture = Rect { max: pos2(whole.right() - covered, whole.bottom()), ..whole };
    ui_state.split.divider(ui, picture, state, &ui_state.times);
    let free = ui.available_rect_before_wrap();
    match state.names() {
        Some(_) => legend::show(ui, free, picture, state, ui_state),
        None if ui_state.loading.is_none() => start::show(ui, free, state, &ui_state.layout),
        None => {}
    }
    ui_state.errors.picture(ui.ctx());
    ui_state.buffers.picture(ui.ctx());
    if ui_state.show_help {
        help::show(ui.ctx(), &ui_state.layout);
    }
    if let Some(opening) = &mut state.opening {
        state.answer = opening.show(ui).or(state.answer.take());
    }
    if let Err(error) = state.apply(device) {
        ui_state.error = Some(error.to_string());
    }
    if state.is_reading() {
        ui.ctx().request_repaint_after(OFTEN);
    }
    covered
}

/// The panel on the right, unless it is hidden or the window is too narrow; gives its width, points.
fn beside(ui: &mut Ui, state: &mut State, ui_state: &mut UiState, device: &Arc<Device>) -> f32 {
    let (whole, [least, usual]) = (ui.max_rect(), WIDTH);
    let most = MOST * whole.width();
    if ui_state.panel_hidden || most < least {
        return 0.0;
    }
    let first = (PART * whole.width()).clamp(least, usual);
    let panel = Panel::right("choices").default_size(first).size_range(least..=most);
    let panel = panel.show(ui, |ui| {
        ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| choices(ui, state, ui_state, device));
    });
    (whole.right() - panel.response.rect.left()).max(0.0)
}

fn choices(ui: &mut Ui, state: &mut State, ui_state: &mut UiState, device: &Arc<Device>) {
    let [hide, help] = [Action::Panels, Action::Help].map(|action| {
        let binding = BINDINGS.iter().find(|binding| binding.action == action);
        binding.map_or(String::new(), |binding| ui_state.layout.name(binding))
    });
    ui.horizontal(|ui| {
        let listed = ui.add(Button::new("Keys and mouse").selected(ui_state.show_help));
        if listed.on_hover_text(format!("{help}; Esc closes them")).clicked() {
            ui_state.show_help = !ui_state.show_help;
        }
        ui.label(format!("{hide} hides this panel")).on_hover_text(format!("{hide} shows it again"));
    });
    let Some(chosen) = &mut state.choices() else { return };
    // Beside the scroll bar.
    ui.set_max_width(ui.available_width() - 10.0);
    ui.spacing_mut().slider_width = (ui.available_width() - SLIDER).clamp(40.0, 100.0);
    about(ui, chosen);
    CollapsingHeader::new("Method").default_open(true).show(ui, |ui| method::show(ui, chosen));
    CollapsingHeader::new("Render settings")
        .default_open(true)
        .show(ui, |ui| render_settings::show(ui, chosen));
    let quality = times::Quality {
        size: chosen.size,
        side: ui_state.scale,
        surfels: ui_state.surfels as u64,
        of: chosen.surfels,
    };
    ui_state.times.show(ui, &quality, chosen.settings, ui_state.frame_ms);
    ui.collapsing("Side by side", |ui| ui_state.split.show(ui, chosen));
    ui.collapsing("Error", |ui| ui_state.errors.show(ui, chosen, device));
    ui.collapsing("Buffers", |ui| ui_state.buffers.show(ui, chosen, device));
}

/// What is looked at: names, how many points, what of them is estimated.
fn about(ui: &mut Ui, chosen: &Choices<'_>) {
    let about = chosen.source.about();
    for name in about.names.iter().take(LISTED) {
        ui.add(Label::new(RichText::new(short_name(name)).strong()).truncate()).on_hover_text(name);
    }
    if let Some(others) = about.names.get(LISTED..).filter(|others| !others.is_empty()) {
        ui.label(format!("and {} more", others.len())).on_hover_text(others.join("\n"));
    }
    let counted = match (about.points, about.dropped) {
        (0, _) => format!("{} surfels", thousands(chosen.surfels)),
        (points, 0) => format!("{} points", thousands(points)),
        (points, dropped) => format!("{} points, {} left out", thousands(points), thousands(dropped)),
    };
    ui.label(counted);
    if let Some(estimated) = &about.estimated {
        ui.label(format!("Estimated: {estimated}"));
    }
}
