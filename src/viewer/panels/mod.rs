//! The panels: what they say, and what they let one choose.

mod axes;
mod buffers;
mod error;
mod help;
mod kernel;
mod legend;
mod look;
mod method;
mod raster;
mod split;
mod start;
mod times;

use super::about::{short_name, thousands};
use super::keys::{Action, BINDINGS};
use super::layout::Layout;
use super::screen::Asked;
use super::state::{Choices, State, quick};
use buffers::Buffers;
use egui::{Button, CollapsingHeader, Label, Panel, ProgressBar, Rect, RichText, ScrollArea, Ui, pos2};
use error::Errors;
use split::Split;
use std::sync::Arc;
use std::time::Duration;
use surfel::Settings;
use surfel::geometry::ValueRange;
use surfel::settings::Shading;
use surfel::vk::Device;
use times::Times;

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

/// What the panels tell beside what they let one choose.
#[derive(Default)]
pub struct Told {
    /// A stage of loading, and how much of it is done.
    pub loading: Option<(&'static str, f32)>,
    /// What went wrong last.
    pub wrong: Option<String>,
    /// Why the last frame could not be rendered, if it could not.
    pub refused: Option<String>,
    /// What was done last, for who asked for it.
    pub done: Option<String>,
    /// How long the last frame took, ms.
    pub frame: f64,
    /// Its side, as part of the whole picture's.
    pub side: f64,
    /// How many surfels it had.
    pub surfels: f64,
    /// The least and the greatest number that the pictures show, left and right, where they show numbers, and what these are.
    pub ranges: [Option<(Shading, ValueRange)>; 2],
    /// Whether keys are listed.
    pub help: bool,
    /// What is known of the keyboard.
    pub layout: Layout,
    /// Whether the panel beside the picture is hidden.
    pub hidden: bool,
    /// What frames tell.
    pub times: Times,
    errors: Errors,
    split: Split,
    buffers: Buffers,
}

impl Told {
    /// Nothing is told yet; the panel may be hidden.
    pub fn new(hidden: bool) -> Self {
        Self { hidden, ..Self::default() }
    }

    /// Closes the window on top of the picture, if there is one.
    pub fn close(&mut self) -> bool {
        std::mem::take(&mut self.help) || self.errors.close() || self.buffers.close()
    }

    /// Nothing is kept that belongs to a context that goes.
    pub fn leave_context(&mut self) {
        self.errors.leave_context();
        self.buffers.leave_context();
    }

    /// How the picture beside the first is rendered, if there is one.
    pub fn beside(&self, state: &State) -> Option<Settings> {
        let asked = state.settings().and_then(|settings| self.split.asked(settings));
        asked.map(|(settings, _)| settings)
    }

    /// What is asked of the next frame, which may be of surfels that stand for others.
    pub fn asked(&self, state: &State, coarser: bool) -> Asked {
        let split = state.settings().and_then(|settings| self.split.asked(settings));
        let split = split.map(|(settings, at)| match coarser {
            true => (quick(&settings).into_owned(), at),
            false => (settings, at),
        });
        Asked { measured: self.times.is_open(), version: state.version(), split }
    }
}

/// All panels; gives the width of the one beside the picture, points.
pub fn show(ui: &mut Ui, state: &mut State, told: &mut Told, device: &Arc<Device>) -> f32 {
    let whole = ui.max_rect();
    if let Some((stage, part)) = told.loading {
        Panel::bottom("loading").show(ui, |ui| {
            ui.horizontal(|ui| {
                state.cancel |=
                    ui.button("give up").on_hover_text("Esc; what was shown before stays").clicked();
                ui.add(ProgressBar::new(part).text(stage));
            })
        });
    }
    if let Some(done) = &told.done {
        Panel::bottom("done").show(ui, |ui| ui.label(done));
    }
    if let Some(wrong) = told.wrong.as_ref().or(told.refused.as_ref()) {
        Panel::top("wrong").show(ui, |ui| ui.colored_label(ui.visuals().error_fg_color, wrong));
    }
    let covered = beside(ui, state, told, device);
    let picture = Rect { max: pos2(whole.right() - covered, whole.bottom()), ..whole };
    told.split.divider(ui, picture, state, &told.times);
    let free = ui.available_rect_before_wrap();
    match state.names() {
        Some(_) => legend::show(ui, free, picture, state, told),
        None if told.loading.is_none() => start::show(ui, free, state, &told.layout),
        None => {}
    }
    told.errors.picture(ui.ctx());
    told.buffers.picture(ui.ctx());
    if told.help {
        help::show(ui.ctx(), &told.layout);
    }
    if let Some(opening) = &mut state.opening {
        state.answer = opening.show(ui).or(state.answer.take());
    }
    if let Err(error) = state.apply(device) {
        told.wrong = Some(error.to_string());
    }
    if state.is_reading() {
        ui.ctx().request_repaint_after(OFTEN);
    }
    covered
}

/// The panel on the right, unless it is hidden or the window is too narrow; gives its width, points.
fn beside(ui: &mut Ui, state: &mut State, told: &mut Told, device: &Arc<Device>) -> f32 {
    let (whole, [least, usual]) = (ui.max_rect(), WIDTH);
    let most = MOST * whole.width();
    if told.hidden || most < least {
        return 0.0;
    }
    let first = (PART * whole.width()).clamp(least, usual);
    let panel = Panel::right("choices").default_size(first).size_range(least..=most);
    let panel = panel.show(ui, |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| choices(ui, state, told, device));
    });
    (whole.right() - panel.response.rect.left()).max(0.0)
}

fn choices(ui: &mut Ui, state: &mut State, told: &mut Told, device: &Arc<Device>) {
    let [hide, help] = [Action::Panels, Action::Help].map(|action| {
        let binding = BINDINGS.iter().find(|binding| binding.action == action);
        binding.map_or(String::new(), |binding| told.layout.name(binding))
    });
    ui.horizontal(|ui| {
        let listed = ui.add(Button::new("Keys and mouse").selected(told.help));
        if listed.on_hover_text(format!("{help}; Esc closes them")).clicked() {
            told.help = !told.help;
        }
        ui.label(format!("{hide} hides this panel")).on_hover_text(format!("{hide} shows it again"));
    });
    let Some(chosen) = &mut state.choices() else { return };
    // Beside the scroll bar.
    ui.set_max_width(ui.available_width() - 10.0);
    ui.spacing_mut().slider_width = (ui.available_width() - SLIDER).clamp(40.0, 100.0);
    about(ui, chosen);
    CollapsingHeader::new("Method").default_open(true).show(ui, |ui| method::show(ui, chosen));
    CollapsingHeader::new("Look").default_open(true).show(ui, |ui| look::show(ui, chosen));
    let quality = times::Quality {
        size: chosen.size,
        side: told.side,
        surfels: told.surfels as u64,
        of: chosen.surfels,
    };
    told.times.show(ui, &quality, chosen.settings, told.frame);
    ui.collapsing("Side by side", |ui| told.split.show(ui, chosen));
    ui.collapsing("Error", |ui| told.errors.show(ui, chosen, device));
    ui.collapsing("Buffers", |ui| told.buffers.show(ui, chosen, device));
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
