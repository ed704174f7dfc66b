//! The panels: what they say, and what they let one choose.

use super::keys;
use super::state::{SHADINGS, State};
use egui::{ComboBox, Panel, ProgressBar, Slider, Ui, Window};
use surfel::methods::Method;

/// What the panels tell beside what they let one choose.
#[derive(Default)]
pub struct Told {
    /// A stage of loading, and how much of it is done.
    pub loading: Option<(&'static str, f32)>,
    /// What went wrong last.
    pub wrong: Option<String>,
    /// How long the last frame took, ms.
    pub frame: f64,
    /// Its side, as part of the window's.
    pub side: f64,
    /// How many surfels it had.
    pub surfels: f64,
    /// Whether keys are listed.
    pub help: bool,
}

/// All panels.
pub fn show(ui: &mut Ui, state: &mut State, told: &Told) {
    if let Some((stage, part)) = told.loading {
        Panel::bottom("loading").show(ui, |ui| {
            ui.horizontal(|ui| {
                state.cancel |=
                    ui.button("give up").on_hover_text("Esc; what was shown before stays").clicked();
                ui.add(ProgressBar::new(part).text(stage));
            })
        });
    }
    if let Some(wrong) = &told.wrong {
        Panel::top("wrong").show(ui, |ui| ui.colored_label(ui.visuals().error_fg_color, wrong));
    }
    Panel::right("choices").show(ui, |ui| choices(ui, state, told));
    if told.help {
        Window::new("Keys and mouse").show(ui.ctx(), help);
    }
}

fn choices(ui: &mut Ui, state: &mut State, told: &Told) {
    let quality = match told.side {
        side if side < 1.0 => format!("{:.0} % of the pixels", 100.0 * side * side),
        _ => "all pixels".into(),
    };
    ui.label(format!("{:.0} ms a frame, {quality}", told.frame));
    let Some(mut chosen) = state.choices() else {
        ui.label("Drop files on the window to look at them.");
        return;
    };
    ui.label(match told.surfels as u64 {
        fewer if fewer < chosen.surfels => format!("{fewer} of {} surfels", chosen.surfels),
        _ => format!("{} surfels", chosen.surfels),
    });
    ui.separator();
    ComboBox::from_label("method").selected_text(chosen.method.name).show_ui(ui, |ui| {
        for method in Method::ALL {
            if ui
                .selectable_label(method.name == chosen.method.name, method.name)
                .on_hover_text(method.paper)
                .clicked()
            {
                chosen.choose(method);
            }
        }
    });
    let settings = &mut *chosen.settings;
    ComboBox::from_label("shading").selected_text(settings.shading.name()).show_ui(ui, |ui| {
        for shading in SHADINGS {
            ui.selectable_value(&mut settings.shading, shading, shading.name());
        }
    });
    let slider = |ui: &mut Ui, value: &mut f32, range, text: &str, what: &str| {
        ui.add(Slider::new(value, range).text(text)).on_hover_text(what);
    };
    if settings.pull_push.is_none() {
        slider(ui, &mut settings.cutoff, 1.0..=4.0, "cut-off, σ", "where a splat's kernel ends");
        slider(ui, &mut settings.lowpass, 0.0..=4.0, "low-pass, px²", "variance of the anti-aliasing filter");
        slider(
            ui,
            &mut settings.epsilon,
            0.1..=10.0,
            "ε, radii",
            "how far behind the nearest splat others still blend with it",
        );
    }
    ui.checkbox(chosen.parallel, "parallel rays");
    ui.separator();
    ui.label("H: keys and mouse");
}

fn help(ui: &mut Ui) {
    egui::Grid::new("keys").show(ui, |ui| {
        let mouse = [
            ("left", "turn"),
            ("double left", "turn about this point from now on"),
            ("middle, Shift+left", "move across the picture"),
            ("wheel, right", "nearer and farther"),
            ("W A S D, E Q", "fly ahead, left, back, right, up, down"),
        ];
        let bound = keys::BINDINGS.map(|binding| (binding.name, binding.does));
        for (name, does) in mouse.into_iter().chain(bound) {
            ui.strong(name);
            ui.label(does);
            ui.end_row();
        }
    });
}
