//! Method panel: the method, its axes and its parameters.

use super::widgets::{choice, combo};
use super::{axes, kernel};
use crate::viewer::choices::Choices;
use egui::{Slider, SliderClamping, Ui};
use std::ops::RangeInclusive;
use surfel::Settings;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::Storage;
use surfel::settings::splatting::{Filter, Visibility};
use surfel::settings::{Choice, Widen};

/// Shows the panel.
pub fn show(ui: &mut Ui, choices: &mut Choices<'_>) {
    choose(ui, choices);
    let settings = &mut *choices.settings;
    let Some(pull_push) = settings.pull_push else {
        axes::show(ui, &mut settings.splatting, choices.weighted);
        if !settings.draws_points() {
            kernel::show(ui, &mut settings.splatting, settings.cutoff);
        }
        parameters(ui, settings);
        return;
    };
    ui.label(format!("rules: {}", pull_push.rules.name()))
        .on_hover_text("Which samples belong to one surface: as published (paper), or by perspective ellipses and means over the nearest surface alone (robust).");
    let mut storage = pull_push.storage;
    let help = "Where the levels of the pyramid are stored. Times and memory differ, the picture does not.";
    combo(ui, "storage", storage_name(storage), help, |ui| {
        ui.selectable_value(&mut storage, Storage::Apart, storage_name(Storage::Apart))
            .on_hover_text("Pulled levels in one pyramid, pushed ones in the other: nothing is copied.");
        ui.selectable_value(&mut storage, Storage::PingPong, storage_name(Storage::PingPong)).on_hover_text(
            "As published: even levels in one, odd ones in the other, and a pass that copies.",
        );
    });
    settings.pull_push = Some(surfel::settings::pull_push::PullPush { storage, ..pull_push });
}

fn storage_name(storage: Storage) -> &'static str {
    match storage {
        Storage::Apart => "apart",
        Storage::PingPong => "in turns",
    }
}

/// Shows the choice of the method.
fn choose(ui: &mut Ui, choices: &mut Choices<'_>) {
    let preset = Method::named(choices.method.name).map(|method| method.splatting);
    let splats = choices.settings.pull_push.is_none();
    let changed = splats && preset != Some(choices.settings.splatting);
    let text = if changed { format!("{}, changed", choices.method.name) } else { choices.method.name.into() };
    let (name, primitives) = (choices.method.name, choices.primitives);
    combo(ui, "method", &text, choices.method.paper, |ui| {
        if let Some(method) = list(ui, name, primitives) {
            choices.choose(method);
        }
    });
}

/// Lists the methods, with that of the name `chosen` selected; returns the one that is clicked. `primitives` is whether the scene has lines or
/// triangles.
pub fn list(ui: &mut Ui, chosen: &str, primitives: bool) -> Option<Method> {
    let mut clicked = None;
    for method in Method::CHOICES {
        let is_disabled = primitives && method.pull_push.is_none();
        let reason = is_disabled.then_some("Only pull-push renders lines and triangles.");
        if choice(ui, method.name == chosen, method.name, method.paper, reason) {
            clicked = Some(method);
        }
    }
    clicked
}

/// Shows the parameters of splatting.
fn parameters(ui: &mut Ui, settings: &mut Settings) {
    let slider = |ui: &mut Ui, value: &mut f32, range: RangeInclusive<f32>, name: &str, text: &str| {
        ui.add(Slider::new(value, range).clamping(SliderClamping::Edits).text(name)).on_hover_text(text);
    };
    if settings.draws_points() {
        let text = "Diameter of every point, whatever its distance.";
        return slider(ui, &mut settings.point_size, 1.0..=16.0, "point size, px", text);
    }
    let Settings { splatting, cutoff, lowpass, pixel_filter, epsilon, widen, .. } = settings;
    slider(
        ui,
        cutoff,
        1.0..=4.0,
        "cut-off, σ",
        "Where a splat's kernel ends, in standard deviations. Larger values are smoother and cover more pixels.",
    );
    ui.add_enabled_ui(splatting.filter != Filter::None, |ui| {
        slider(ui, lowpass, 0.0..=4.0, "low-pass, px²", "Variance of the anti-aliasing filter, which prevents flicker and moiré where splats are smaller than pixels.");
        combo(ui, "widens", widen.name(), "Which splats the low-pass filter widens.", |ui| {
            ui.selectable_value(widen, Widen::All, "all").on_hover_text("Every splat, as in the paper.");
            ui.selectable_value(widen, Widen::Small, "small")
                .on_hover_text("Only splats smaller than the filter; larger ones stay sharper.");
        });
    });
    slider(
        ui,
        pixel_filter,
        0.0..=2.0,
        "pixel filter, px²",
        "Variance of a Gaussian after shading, which also smooths edges. The low-pass filter has the rest of its own variance.",
    );
    ui.add_enabled_ui(splatting.visibility != Visibility::Nearest, |ui| {
        slider(
            ui,
            epsilon,
            0.1..=10.0,
            "ε, radii",
            "How far behind the nearest splat others are still blended with it, in radii of the splat.",
        );
    });
}
