//! Filter panel: which points of the files are read, by class and by return.

use crate::viewer::choices::Choices;
use egui::{CollapsingHeader, RadioButton, Ui};
use std::collections::BTreeMap;
use surfel::formats::{Filter, FilterCounts, Returns, class_name};
use surfel::settings::Choice;
use surfel::thousands;

/// Shows the panel, if the points have classes or returns.
pub fn show(ui: &mut Ui, choices: &mut Choices<'_>) {
    let FilterCounts { classes: by_class, returns: by_return } = &choices.source.info().counts;
    if by_class.is_none() && by_return.is_none() {
        return;
    }
    CollapsingHeader::new("Points").default_open(true).show(ui, |ui| {
        if let Some(counts) = by_class {
            classes(ui, counts, choices.filter);
        }
        if let Some(counts) = by_return {
            returns(ui, counts, &mut choices.filter.returns);
        }
    });
}

/// Shows a check box for each class.
fn classes(ui: &mut Ui, counts: &BTreeMap<u8, u64>, filter: &mut Filter) {
    ui.horizontal(|ui| {
        ui.label("classes").on_hover_text("Points of the checked classes are read, as with --class.");
        if ui.small_button("all").clicked() {
            filter.classes = None;
        }
        if ui.small_button("none").on_hover_text("Then check those to read.").clicked() {
            filter.classes = Some(Vec::new());
        }
    });
    for (&class, &count) in counts {
        let mut checked = is_checked(filter, class);
        if ui.checkbox(&mut checked, class_text(class, count)).changed() {
            check(filter, counts, class, checked);
        }
    }
    if filter.classes.as_ref().is_some_and(Vec::is_empty) {
        ui.weak("No class is checked: the points stay until one is.");
    }
}

/// Shows which returns are read.
fn returns(ui: &mut Ui, counts: &[u64; 3], returns: &mut Option<Returns>) {
    ui.label("returns").on_hover_text("Points of these returns of a pulse are read, as with --returns.");
    ui.radio_value(returns, None, "all");
    for (which, count) in Returns::ALL.iter().zip(counts) {
        let radio =
            RadioButton::new(*returns == Some(*which), format!("{}: {}", which.name(), thousands(*count)));
        if ui.add_enabled(*count > 0, radio).on_hover_text(which.about()).clicked() {
            *returns = Some(*which);
        }
    }
}

fn class_text(class: u8, count: u64) -> String {
    let count = thousands(count);
    match class_name(class.into()) {
        Some(name) => format!("{class} {name}: {count}"),
        None => format!("{class}: {count}"),
    }
}

fn is_checked(filter: &Filter, class: u8) -> bool {
    filter.classes.as_ref().is_none_or(|chosen| chosen.contains(&class))
}

/// Adds a class to the filter or removes it.
fn check(filter: &mut Filter, counts: &BTreeMap<u8, u64>, class: u8, checked: bool) {
    let is_chosen = |other: u8| if other == class { checked } else { is_checked(filter, other) };
    let chosen: Vec<u8> = counts.keys().copied().filter(|other| is_chosen(*other)).collect();
    // All of them are no filter.
    filter.classes = (chosen.len() < counts.len()).then_some(chosen);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checked_classes_are_read_and_all_of_them_are_no_filter() {
        let counts = BTreeMap::from([(1, 10), (2, 20), (6, 5)]);
        let mut filter = Filter::default();
        let mut after = |class, checked| {
            check(&mut filter, &counts, class, checked);
            filter.classes.clone()
        };
        assert_eq!(after(1, false), Some(vec![2, 6]));
        assert_eq!(after(2, false), Some(vec![6]));
        assert_eq!(after(6, false), Some(vec![]));
        assert_eq!(after(2, true), Some(vec![2]));
        assert_eq!(after(1, true), Some(vec![1, 2]));
        assert_eq!(after(6, true), None);
        // Of the command line, with a class that no point has.
        let mut filter = Filter { classes: Some(vec![9, 6]), ..Default::default() };
        check(&mut filter, &counts, 2, true);
        assert_eq!(filter.classes, Some(vec![2, 6]));
    }

    #[test]
    fn classes_have_their_names() {
        assert_eq!(class_text(2, 1234567), "2 ground: 1,234,567");
        assert_eq!(class_text(64, 5), "64: 5");
    }
}
