//! How surfels become pixels: the method, what is changed of it, and its numbers.

use super::{axes, kernel};
use crate::viewer::state::Choices;
use egui::{ComboBox, Slider, SliderClamping, Ui};
use std::ops::RangeInclusive;
use surfel::Settings;
use surfel::settings::methods;
use surfel::settings::methods::Method;
use surfel::settings::pull_push::Storage;
use surfel::settings::splatting::{Filter, Visibility};
use surfel::settings::{Choice, Widen};

/// Method, axes, kernel, numbers.
pub fn show(ui: &mut Ui, chosen: &mut Choices<'_>) {
    choose(ui, chosen);
    let settings = &mut *chosen.settings;
    let Some(pull_push) = settings.pull_push else {
        axes::show(ui, &mut settings.splatting, chosen.weighted);
        kernel::show(ui, &mut settings.splatting, settings.cutoff);
        numbers(ui, settings);
        return;
    };
    ui.label(format!("rules: {}", pull_push.rules.name()))
        .on_hover_text("what decides which samples are one surface: as published (paper), or perspective ellipses and means over the nearest surface alone (robust)");
    let mut storage = pull_push.storage;
    let text =
        "Where the levels of the pyramid are kept. The picture stays the same; times and memory change.";
    let shown = ComboBox::from_label("storage").selected_text(storage_name(storage)).show_ui(ui, |ui| {
        ui.selectable_value(&mut storage, Storage::Apart, storage_name(Storage::Apart))
            .on_hover_text("pulled levels in one pyramid, pushed ones in the other: nothing is copied");
        ui.selectable_value(&mut storage, Storage::PingPong, storage_name(Storage::PingPong))
            .on_hover_text("as published: even levels in one, odd ones in the other, and a pass that copies");
    });
    shown.response.on_hover_text(text);
    settings.pull_push = Some(surfel::settings::pull_push::PullPush { storage, ..pull_push });
}

fn storage_name(storage: Storage) -> &'static str {
    match storage {
        Storage::Apart => "apart",
        Storage::PingPong => "in turns",
    }
}

fn choose(ui: &mut Ui, chosen: &mut Choices<'_>) {
    let preset = Method::named(chosen.method.name).map(|method| method.splatting);
    let splats = chosen.settings.pull_push.is_none();
    let changed = splats && preset != Some(chosen.settings.splatting);
    let text = if changed { format!("{}, changed", chosen.method.name) } else { chosen.method.name.into() };
    let shown = ComboBox::from_label("method").selected_text(text).show_ui(ui, |ui| {
        for method in methods::Method::ALL {
            let splats = method.pull_push.is_none();
            ui.add_enabled_ui(!(splats && chosen.primitives), |ui| {
                let label = ui.selectable_label(method.name == chosen.method.name, method.name);
                let label = label.on_hover_text(method.paper);
                let label = label.on_disabled_hover_text("lines and triangles are drawn by pull-push alone");
                if label.clicked() {
                    chosen.choose(method);
                }
            });
        }
    });
    shown.response.on_hover_text(chosen.method.paper);
}

fn numbers(ui: &mut Ui, settings: &mut Settings) {
    let slider = |ui: &mut Ui, value: &mut f32, range: RangeInclusive<f32>, name: &str, text: &str| {
        ui.add(Slider::new(value, range).clamping(SliderClamping::Edits).text(name)).on_hover_text(text);
    };
    let Settings { splatting, cutoff, lowpass, epsilon, widen, .. } = settings;
    slider(
        ui,
        cutoff,
        1.0..=4.0,
        "cut-off, σ",
        "Where a splat's kernel ends, in standard deviations: the disc's rim. Larger is smoother and costs more pixels.",
    );
    ui.add_enabled_ui(splatting.filter != Filter::None, |ui| {
        slider(ui, lowpass, 0.0..=4.0, "low-pass, px²", "Variance of the anti-aliasing filter: against flicker and moiré where splats are smaller than pixels.");
        let shown = ComboBox::from_label("widens").selected_text(widen.name()).show_ui(ui, |ui| {
            ui.selectable_value(widen, Widen::All, "all").on_hover_text("every splat, as the paper does");
            ui.selectable_value(widen, Widen::Small, "small")
                .on_hover_text("only what is smaller than the filter: the rest stays sharper");
        });
        shown.response.on_hover_text("Which splats the low-pass filter widens.");
    });
    ui.add_enabled_ui(splatting.visibility != Visibility::Nearest, |ui| {
        slider(
            ui,
            epsilon,
            0.1..=10.0,
            "ε, radii",
            "How far behind the nearest splat others still blend with it, in radii of the splat.",
        );
    });
}
