//! Widgets that several panels share.

use egui::{ComboBox, Ui};
use surfel::settings::Choice;

/// Shows a combo box with a tooltip; `add` adds its choices.
pub fn combo(ui: &mut Ui, label: &str, selected: &str, help: &str, add: impl FnOnce(&mut Ui)) {
    let combo = ComboBox::from_label(label).selected_text(selected).show_ui(ui, add);
    combo.response.on_hover_text(help);
}

/// Shows a choice of a list; returns whether it was clicked. `disabled` is the reason why it cannot be chosen, if there is one.
pub fn choice(ui: &mut Ui, selected: bool, name: &str, help: &str, disabled: Option<&str>) -> bool {
    let show = |ui: &mut Ui| {
        let label = ui.selectable_label(selected, name).on_hover_text(help);
        label.on_disabled_hover_text(disabled.unwrap_or_default()).clicked()
    };
    ui.add_enabled_ui(disabled.is_none(), show).inner
}

/// Shows a combo box of all choices; its tooltip is `help`, or else that of the chosen one.
pub fn choice_combo<T: Choice>(ui: &mut Ui, label: &str, value: &mut T, help: Option<&str>) {
    let (name, help) = (value.name(), help.unwrap_or(value.about()));
    combo(ui, label, name, help, |ui| {
        for other in T::ALL {
            if choice(ui, other.name() == name, other.name(), other.about(), None) {
                *value = *other;
            }
        }
    });
}
