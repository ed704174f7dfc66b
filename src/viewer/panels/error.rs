//! Error panel: compares the picture with the float64 reference or with the exact surface.

use super::raster::{Raster, RasterWindow, Values};
use super::widgets::{choice, combo};
use crate::viewer::choices::Choices;
use crate::viewer::comparison::{Against, Comparison, Task, Truth};
use crate::viewer::events::{ComparisonInfo, Event};
use crate::viewer::job::Job;
use egui::{Button, Grid, ProgressBar, Slider, SliderClamping, Ui};
use std::sync::Arc;
use std::time::Duration;
use surfel::geometry::ColourMap;
use surfel::verify::reference::Tolerance;
use surfel::vk::Device;
use surfel::{Error, RenderOptions};

/// How often the progress of a comparison is shown.
const POLL_PERIOD: Duration = Duration::from_millis(200);

/// The panel, and the result of the last comparison.
pub struct Errors {
    against: Against,
    job: Option<Job<Comparison>>,
    found: Option<Comparison>,
    error: Option<String>,
    /// Whether the last result or error is not in the event log yet.
    is_new: bool,
    /// The largest difference of a channel that counts as equal, linear.
    tolerance: f32,
    pub(super) window: RasterWindow,
}

impl Default for Errors {
    fn default() -> Self {
        let tolerance = Tolerance::default().colour as f32;
        let window = RasterWindow::default();
        Self {
            against: Against::Reference,
            job: None,
            found: None,
            error: None,
            is_new: false,
            tolerance,
            window,
        }
    }
}

impl Errors {
    /// Shows the choices or the progress of a comparison, and the last result.
    pub fn show(&mut self, ui: &mut Ui, choices: &Choices<'_>, device: &Arc<Device>) {
        self.poll(ui);
        match &self.job {
            Some(job) => {
                let (stage, part) = job.at();
                ui.add(ProgressBar::new(part).text(stage));
                if ui.button("Cancel").clicked() {
                    job.cancel();
                }
            }
            None => self.show_choices(ui, choices, device),
        }
        if let Some(error) = &self.error {
            ui.colored_label(ui.visuals().error_fg_color, error);
        }
        self.show_result(ui, choices);
    }

    /// Takes the result of the comparison once it is done.
    fn poll(&mut self, ui: &Ui) {
        let Some(job) = &mut self.job else { return };
        match job.take() {
            None => ui.ctx().request_repaint_after(POLL_PERIOD),
            Some(outcome) => {
                self.job = None;
                self.is_new = !matches!(outcome, Err(Error::Cancelled));
                match outcome {
                    Ok(found) => {
                        let values = Values::Numbers(found.errors.clone());
                        let name = "largest difference of a channel, linear";
                        self.window.raster =
                            Some(Raster::new(name, found.content.size, values).with(ColourMap::Magma, 0.0));
                        self.found = Some(found);
                    }
                    Err(Error::Cancelled) => {}
                    Err(error) => self.error = Some(error.to_string()),
                }
            }
        }
    }

    fn show_choices(&mut self, ui: &mut Ui, choices: &Choices<'_>, device: &Arc<Device>) {
        let unknown = choices.source.surface().err();
        if unknown.is_some() {
            self.against = Against::Reference;
        }
        let [name, text] = self.against.name_and_help();
        combo(ui, "against", name, text, |ui| {
            for against in [Against::Reference, Against::Surface] {
                let [name, text] = against.name_and_help();
                let reason = unknown.filter(|_| against == Against::Surface);
                if choice(ui, self.against == against, name, text, reason) {
                    self.against = against;
                }
            }
        });
        if let Some(reason) = unknown {
            ui.label(reason);
        }
        let Some(content) = choices.content() else { return };
        let button = ui.add(Button::new("Compare this picture"));
        if button.on_hover_text("Renders the picture that the window shows at rest again, and the reference or exact picture; takes seconds to minutes.").clicked() {
            self.error = None;
            let truth = match choices.source.surface() {
                Ok(surface) if self.against == Against::Surface => Truth::Surface(surface.clone()),
                _ => Truth::Reference(choices.source.visible_model()),
            };
            let task = Task {
                truth,
                device: device.clone(),
                scene: choices.scene.clone(),
                content,
                options: RenderOptions { size: choices.size, rasterizer: choices.rasterizer, ..Default::default() },
            };
            self.job = Some(Job::start(move |progress| task.run(progress)));
        }
    }

    fn show_result(&mut self, ui: &mut Ui, choices: &Choices<'_>) {
        let Some(found) = &self.found else { return };
        let same = choices.content().is_some_and(|content| content == found.content);
        ui.separator();
        ui.label(format!(
            "Compared with the {}{}",
            found.against.name_and_help()[0],
            if same { "" } else { ": an earlier picture" }
        ));
        let beyond = found.errors.iter().filter(|error| **error > self.tolerance).count();
        let (worst, [x, y]) = found.worst;
        Grid::new("errors").num_columns(2).show(ui, |ui| {
            let rows = [
                ("RMSE", format!("{:.3e}", found.rmse), "Root mean square of all differences, of linear colours over the background; the difference of white from black is 1."),
                ("worst", format!("{worst:.3e} at ({x}, {y})"), "Largest difference of a channel, and its pixel from the top left."),
                ("beyond", format!("{:.4} %, {beyond} px", 100.0 * beyond as f64 / found.errors.len().max(1) as f64), "Pixels with a channel whose difference is above the tolerance."),
                ("took", format!("{:.1} s", found.took.as_secs_f64()), "Time to render the reference or exact picture."),
            ];
            let noise = found.standard_error.map(|error| ("noise", format!("{error:.1e}"), "Standard error of the exact picture, root mean square: its rays are samples."));
            for (name, value, text) in rows.into_iter().chain(noise) {
                ui.label(name).on_hover_text(text);
                ui.monospace(value);
                ui.end_row();
            }
        });
        ui.add(
            Slider::new(&mut self.tolerance, 1e-7..=1.0)
                .logarithmic(true)
                .clamping(SliderClamping::Edits)
                .text("tolerance"),
        )
        .on_hover_text("The largest difference of a channel that counts as equal, in linear light.");
        ui.checkbox(&mut self.window.open, "show as a picture");
    }

    /// The event of the last comparison, if the log does not have it yet.
    pub fn take_event(&mut self) -> Option<Event<'_>> {
        if !std::mem::take(&mut self.is_new) {
            return None;
        }
        if let Some(error) = &self.error {
            return Some(Event::Error { error });
        }
        self.found.as_ref().map(|found| {
            Event::Compared(ComparisonInfo {
                against: found.against.name_and_help()[0],
                picture: found.content.size,
                rmse: found.rmse,
                worst: found.worst.0,
                took_ms: 1e3 * found.took.as_secs_f64(),
            })
        })
    }
}
