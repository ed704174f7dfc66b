//! Method panel: the method, its axes and its parameters.

use super::{axes, kernel};
use crate::viewer::choices::Choices;
use egui::{ComboBox, Slider, SliderClamping, Ui};
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
        kernel::show(ui, &mut settings.splatting, settings.cutoff);
        parameters(ui, settings);
        return;
    };
    ui.label(format!("rules: {}", pull_push.rules.name()))
        .on_hover_text("Which samples belong to one surface: as published (paper), or by perspective ellipses and means over the nearest surface alone (robust).");
    let mut storage = pull_push.storage;
    let text = "Where the levels of the pyramid are stored. Times and memory differ, the picture does not.";
    let combo = ComboBox::from_label("storage").selected_text(storage_name(storage)).show_ui(ui, |ui| {
        ui.selectable_value(&mut storage, Storage::Apart, storage_name(Storage::Apart))
            .on_hover_text("Pulled levels in one pyramid, pushed ones in the other: nothing is copied.");
        ui.selectable_value(&mut storage, Storage::PingPong, storage_name(Storage::PingPong)).on_hover_text(
            "As published: even levels in one, odd ones in the other, and a pass that copies.",
        );
    });
    combo.response.on_hover_text(text);
    settings.pull_push = Some(surfel::settings::pull_push::PullPush { storage, ..pull_push });
}

fn storage_name(storage: Storage) -> &'static str {
    match storage {
        Storage::Apart => "apart",
        Storage::PingPong => "in turns",
    }
}

fn choose(ui: &mut Ui, choices: &mut Choices<'_>) {
    let preset = Method::named(choices.method.name).map(|method| method.splatting);
    let splats = choices.settings.pull_push.is_none();
    let changed = splats && preset != Some(choices.settings.splatting);
    let text = if changed { format!("{}, changed", choices.method.name) } else { choices.method.name.into() };
    let combo = ComboBox::from_label("method").selected_text(text).show_ui(ui, |ui| {
        for method in Method::ALL {
            let splats = method.pull_push.is_none();
            ui.add_enabled_ui(!(splats && choices.primitives), |ui| {
                let label = ui.selectable_label(method.name == choices.method.name, method.name);
                let label = label.on_hover_text(method.paper);
                let label = label.on_disabled_hover_text("Only pull-push renders lines and triangles.");
                if label.clicked() {
                    choices.choose(method);
                }
            });
        }
    });
    combo.response.on_hover_text(choices.method.paper);
}

fn parameters(ui: &mut Ui, settings: &mut Settings) {
    let slider = |ui: &mut Ui, value: &mut f32, range: RangeInclusive<f32>, name: &str, text: &str| {
        ui.add(Slider::new(value, range).clamping(SliderClamping::Edits).text(name)).on_hover_text(text);
    };
    let Settings { splatting, cutoff, lowpass, epsilon, widen, .. } = settings;
    slider(
        ui,
        cutoff,
        1.0..=4.0,
        "cut-off, σ",
        "Where a splat's kernel ends, in standard deviations. Larger values are smoother and cover more pixels.",
    );
    ui.add_enabled_ui(splatting.filter != Filter::None, |ui| {
        slider(ui, lowpass, 0.0..=4.0, "low-pass, px²", "Variance of the anti-aliasing filter, which prevents flicker and moiré where splats are smaller than pixels.");
        let combo = ComboBox::from_label("widens").selected_text(widen.name()).show_ui(ui, |ui| {
            ui.selectable_value(widen, Widen::All, "all").on_hover_text("Every splat, as in the paper.");
            ui.selectable_value(widen, Widen::Small, "small")
                .on_hover_text("Only splats smaller than the filter; larger ones stay sharper.");
        });
        combo.response.on_hover_text("Which splats the low-pass filter widens.");
    });
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
