//! What the picture shows of the scene: shading, colours, background, radii.

use super::raster::short;
use crate::viewer::source::By;
use crate::viewer::state::Choices;
use egui::{ComboBox, DragValue, ProgressBar, Slider, SliderClamping, Ui};
use surfel::geometry::{ColourMap, ValueRange};
use surfel::settings::{Alpha, Choice, Cull, Shading};

/// All of it.
pub fn show(ui: &mut Ui, chosen: &mut Choices<'_>) {
    let settings = &mut *chosen.settings;
    let shown = ComboBox::from_label("shading").selected_text(settings.shading.name()).show_ui(ui, |ui| {
        for &shading in Shading::ALL {
            ui.selectable_value(&mut settings.shading, shading, shading.name())
                .on_hover_text(shading.about());
        }
    });
    shown.response.on_hover_text(settings.shading.about());
    colours(ui, chosen);
    background(ui, chosen);
    radii(ui, chosen);
    let settings = &mut *chosen.settings;
    let mut smooth = settings.alpha == Alpha::Coverage;
    ui.checkbox(&mut smooth, "smooth outlines")
        .on_hover_text("α is the part of a pixel that surfaces cover, in sixteenths, rather than whether one owns its centre");
    settings.alpha = if smooth { Alpha::Coverage } else { Alpha::Mask };
    let mut back = settings.cull == Cull::Back;
    ui.checkbox(&mut back, "leave out what faces away")
        .on_hover_text("right for closed surfaces whose normals point outwards");
    settings.cull = if back { Cull::Back } else { Cull::None };
    ui.checkbox(chosen.parallel, "parallel rays")
        .on_hover_text("as far as the pivot, all stays as large as it is");
}

/// What surfels are coloured by, with the range and a bar where that is a number.
fn colours(ui: &mut Ui, chosen: &mut Choices<'_>) {
    let source = &mut *chosen.source;
    let mut picked = None;
    let shown =
        ComboBox::from_label("colour by").selected_text(source.name(source.changed.by)).show_ui(ui, |ui| {
            let own = By::ALL.map(|(by, name, text)| (by, name, text));
            let of_file = source.names().iter().enumerate();
            let of_file = of_file.map(|(i, name)| {
                (By::Number(i), name.as_str(), "a number of the file's points, read when it is wanted")
            });
            for (by, name, text) in own.into_iter().chain(of_file) {
                if ui.selectable_label(source.changed.by == by, name).on_hover_text(text).clicked() {
                    picked = Some(by);
                }
            }
        });
    shown.response.on_hover_text("What the points' colours show.");
    if let Some(by) = picked {
        source.colour_by(by);
    }
    if let Some((stage, part)) = source.reading() {
        ui.add(ProgressBar::new(part).text(stage));
    }
    if source.changed.scale().is_none() {
        return;
    }
    map(ui, &mut source.changed.map);
    let usual = source.usual(source.changed.by);
    range(ui, &mut source.changed.range, usual);
    ui.weak("Under shading `color` the surfels have exactly these colours.");
}

/// Which colours numbers have.
pub fn map(ui: &mut Ui, map: &mut ColourMap) {
    let shown = ComboBox::from_label("colours").selected_text(map.name()).show_ui(ui, |ui| {
        for &other in ColourMap::ALL {
            ui.selectable_value(map, other, other.name()).on_hover_text(other.about());
        }
    });
    shown.response.on_hover_text("Which colours numbers have.");
}

/// The numbers at both ends of the colours.
pub fn range(ui: &mut Ui, range: &mut ValueRange, usual: Option<ValueRange>) {
    ui.horizontal(|ui| {
        let speed = (0.005 * (range.max - range.min)).abs().max(f64::MIN_POSITIVE);
        let ValueRange { min, max } = range;
        ui.add(DragValue::new(min).speed(speed).custom_formatter(|value, _| short(value)))
            .on_hover_text("what is less has the first colour");
        ui.label("to");
        ui.add(DragValue::new(max).speed(speed).custom_formatter(|value, _| short(value)))
            .on_hover_text("what is more has the last colour");
        if let Some(usual) = usual
            && ui.button("usual").on_hover_text("from the 1st to the 99th percentile").clicked()
        {
            *range = usual;
        }
    });
}

fn background(ui: &mut Ui, chosen: &mut Choices<'_>) {
    ui.horizontal(|ui| {
        let mut colour = chosen.settings.background.unwrap_or_default();
        if ui.color_edit_button_rgb(&mut colour).changed() {
            chosen.settings.background = Some(colour);
        }
        ui.label("background").on_hover_text("where nothing is; what is partly covered is blended with it");
    });
}

fn radii(ui: &mut Ui, chosen: &mut Choices<'_>) {
    let fixed = chosen.source.has_fixed_radii();
    ui.add_enabled_ui(!fixed, |ui| {
        let factor = &mut chosen.source.changed.radii;
        ui.add(
            Slider::new(factor, 0.25..=4.0).logarithmic(true).clamping(SliderClamping::Edits).text("radii ×"),
        )
        .on_hover_text(
            "Factor of every surfel's radius: below 1 discs may leave holes, above 1 they overlap more.",
        )
        .on_disabled_hover_text(
            "There are no surfels, or their normalization weights are those of these discs.",
        );
    });
    if chosen.primitives && !fixed {
        ui.weak("Lines keep their widths.");
    }
}
