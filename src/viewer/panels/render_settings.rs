//! Render settings panel: shading, colours, background, radii.

use super::histogram;
use super::raster::short_in;
use super::widgets::{choice, choice_combo, combo};
use crate::viewer::appearance::ColourAttribute;
use crate::viewer::choices::Choices;
use crate::viewer::distribution::Distribution;
use egui::{DragValue, ProgressBar, Slider, SliderClamping, Ui};
use surfel::Settings;
use surfel::geometry::{ColourMap, ValueRange};
use surfel::settings::{Alpha, Choice, Cull, Shading};

/// The first background, linear: white.
const BACKGROUND: [f32; 3] = [1.0; 3];

/// Shows the panel.
pub fn show(ui: &mut Ui, choices: &mut Choices<'_>) {
    let settings = &mut *choices.settings;
    choice_combo(ui, "shading", &mut settings.shading, None);
    if settings.shading == Shading::Edl {
        let slider = Slider::new(&mut settings.edl, 0.0..=1.0).clamping(SliderClamping::Edits);
        ui.add(slider.text("strength"))
            .on_hover_text("How much pixels behind their neighbours are darkened.");
    }
    if settings.shading.is_coloured() {
        ambient_occlusion(ui, &mut settings.ao);
    }
    colours(ui, choices);
    background(ui, choices);
    radii(ui, choices);
    let settings = &mut *choices.settings;
    let mut smooth = settings.alpha == Alpha::Coverage;
    ui.checkbox(&mut smooth, "smooth outlines")
        .on_hover_text("α is the fraction of a pixel that surfaces cover, in sixteenths; otherwise it is whether a surface covers its centre.");
    settings.alpha = if smooth { Alpha::Coverage } else { Alpha::Mask };
    choice_combo(ui, "edges", &mut settings.edges, None);
    culling(ui, settings);
    ui.checkbox(choices.legend, "legend")
        .on_hover_text("Tells what colours mean: on the picture, and in files that F12 saves.");
    ui.checkbox(choices.parallel, "parallel projection")
        .on_hover_text("Objects at the pivot's distance keep their size.");
}

/// Shows whether ambient occlusion darkens the picture, and how much.
fn ambient_occlusion(ui: &mut Ui, strength: &mut f32) {
    let mut on = *strength > 0.0;
    let changed = ui
        .checkbox(&mut on, "ambient occlusion")
        .on_hover_text("Darkens cavities and creases, where little light from around arrives.")
        .changed();
    if changed {
        *strength = if on { Settings::DEFAULT_AO } else { 0.0 };
    }
    if on {
        ui.add(Slider::new(strength, 0.1..=4.0).clamping(SliderClamping::Edits).text("strength"));
    }
}

/// Shows which surfels are culled by their orientation.
fn culling(ui: &mut Ui, settings: &mut Settings) {
    combo(ui, "culling", settings.cull.name(), "Which surfels are culled by their orientation.", |ui| {
        for cull in Cull::ALL {
            let is_refused = Settings { cull: *cull, ..settings.clone() }.check().is_err();
            let reason = is_refused.then_some("Only splats along viewing rays tell sides apart.");
            if choice(ui, settings.cull == *cull, cull.name(), cull.about(), reason) {
                settings.cull = *cull;
            }
        }
    });
}

/// Shows what surfels are coloured by, with colour map and range if that has values.
fn colours(ui: &mut Ui, choices: &mut Choices<'_>) {
    let source = &mut *choices.source;
    let mut clicked = None;
    combo(ui, "colour by", source.name(source.wanted.attribute), "What the points' colours show.", |ui| {
        let of_files = source.property_names().iter().enumerate();
        let help = "A property of the files, read when it is chosen.";
        let of_files = of_files.map(|(i, name)| (ColourAttribute::Property(i), name.as_str(), help));
        for (attribute, name, text) in ColourAttribute::ALL.into_iter().chain(of_files) {
            if choice(ui, source.wanted.attribute == attribute, name, text, None) {
                clicked = Some(attribute);
            }
        }
    });
    if let Some(attribute) = clicked {
        source.colour_by(attribute);
    }
    if let Some((stage, part)) = source.reading_progress() {
        ui.add(ProgressBar::new(part).text(stage));
    }
    if source.wanted.scale().is_none() {
        return;
    }
    map(ui, &mut source.wanted.map);
    let distribution = source.distribution(source.wanted.attribute);
    range(ui, &mut source.wanted.range, source.wanted.map, distribution.as_deref());
    ui.weak("With the shading `color`, surfels have exactly these colours.");
}

/// Shows the choice of the colour map.
pub fn map(ui: &mut Ui, map: &mut ColourMap) {
    choice_combo(ui, "colours", map, Some("Colour map of the values."));
}

/// Shows the values at both ends of the colour map; and the distribution of the values, if there are any, with a button for the default range.
pub fn range(ui: &mut Ui, range: &mut ValueRange, map: ColourMap, distribution: Option<&Distribution>) {
    if let Some(distribution) = distribution {
        histogram::show(ui, distribution, map, range);
    }
    ui.horizontal(|ui| {
        let speed = (0.005 * (range.max - range.min)).abs().max(f64::MIN_POSITIVE);
        let shown = *range;
        let ValueRange { min, max } = range;
        ui.add(DragValue::new(min).speed(speed).custom_formatter(|value, _| short_in(value, &shown)))
            .on_hover_text("Smaller values have the first colour.");
        ui.label("to");
        ui.add(DragValue::new(max).speed(speed).custom_formatter(|value, _| short_in(value, &shown)))
            .on_hover_text("Greater values have the last colour.");
        if let Some(Distribution { range: default, .. }) = distribution
            && ui.button("default").on_hover_text("From the 1st to the 99th percentile.").clicked()
        {
            *range = *default;
        }
    });
}

fn background(ui: &mut Ui, choices: &mut Choices<'_>) {
    ui.horizontal(|ui| {
        let background = &mut choices.settings.background;
        let mut on = background.is_some();
        let checkbox = ui.checkbox(&mut on, "background").on_hover_text(
            "Colour of pixels without a surface; partly covered pixels are blended with it. Without a background they are transparent in files, and \
             black in the window.",
        );
        if checkbox.changed() {
            *background = on.then_some(BACKGROUND);
        }
        if let Some(colour) = background {
            ui.color_edit_button_rgb(colour);
        }
    });
}

fn radii(ui: &mut Ui, choices: &mut Choices<'_>) {
    let fixed = choices.source.has_fixed_radii();
    ui.add_enabled_ui(!fixed, |ui| {
        let factor = &mut choices.source.wanted.radius_scale;
        ui.add(
            Slider::new(factor, 0.25..=4.0).logarithmic(true).clamping(SliderClamping::Edits).text("radii ×"),
        )
        .on_hover_text(
            "Factor of every surfel's radius: below 1 discs may leave holes, above 1 they overlap more.",
        )
        .on_disabled_hover_text(
            "There are no surfels, or they have normalization weights, which hold for these radii only.",
        );
    });
    if choices.primitives && !fixed {
        ui.weak("Lines keep their widths.");
    }
}
