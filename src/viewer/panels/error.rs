//! Error panel: compares the picture with the float64 reference or with the exact surface.

use super::raster::{Raster, RasterWindow, Values};
use super::widgets::{choice, combo};
use crate::viewer::choices::Choices;
use crate::viewer::job::Job;
use egui::{Button, Grid, ProgressBar, Slider, SliderClamping, Ui};
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::geometry::{Camera, ColourMap, Model};
use surfel::verify::metrics;
use surfel::verify::reference::{self, Tolerance};
use surfel::verify::scenes;
use surfel::verify::truth;
use surfel::vk::Device;
use surfel::{Error, Picture, Progress, RenderOptions, Renderer, Result, Scene, Settings};

/// How often the progress of a comparison is shown.
const POLL_PERIOD: Duration = Duration::from_millis(200);

/// What the picture is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Against {
    Reference,
    Truth,
}

impl Against {
    const fn name_and_help(self) -> [&'static str; 2] {
        match self {
            Self::Reference => [
                "float64 reference",
                "The same method, camera and settings in float64 on the CPU: shows the error of rounding and of the GPU.",
            ],
            Self::Truth => [
                "exact surface",
                "Rays against the surface itself: shows the error of points, method and filter, edges included.",
            ],
        }
    }
}

/// The panel, and the result of the last comparison.
pub struct Errors {
    against: Against,
    job: Option<Job<Comparison>>,
    found: Option<Comparison>,
    error: Option<String>,
    /// The largest difference of a channel that counts as equal, linear.
    tolerance: f32,
    pub(super) window: RasterWindow,
}

/// A comparison to run.
struct Task {
    against: Against,
    device: Arc<Device>,
    scene: Arc<Scene>,
    model: Arc<Model>,
    surface: Option<String>,
    camera: Camera,
    settings: Settings,
    size: [u32; 2],
    options: RenderOptions,
}

/// Result of a comparison.
struct Comparison {
    against: Against,
    camera: Camera,
    settings: Settings,
    size: [u32; 2],
    rmse: f64,
    /// The largest difference of a channel of each pixel.
    errors: Vec<f32>,
    worst: (f32, [u32; 2]),
    took: Duration,
}

impl Default for Errors {
    fn default() -> Self {
        let tolerance = Tolerance::default().colour as f32;
        let window = RasterWindow::default();
        Self { against: Against::Reference, job: None, found: None, error: None, tolerance, window }
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
                match outcome {
                    Ok(found) => {
                        let values = Values::Numbers(found.errors.clone());
                        let name = "largest difference of a channel, linear";
                        self.window.raster =
                            Some(Raster::new(name, found.size, values).with(ColourMap::Magma, 0.0));
                        self.found = Some(found);
                    }
                    Err(Error::Cancelled) => {}
                    Err(error) => self.error = Some(error.to_string()),
                }
            }
        }
    }

    fn show_choices(&mut self, ui: &mut Ui, choices: &Choices<'_>, device: &Arc<Device>) {
        let exact = choices.source.surface().is_some();
        if !exact {
            self.against = Against::Reference;
        }
        let [name, text] = self.against.name_and_help();
        combo(ui, "against", name, text, |ui| {
            for against in [Against::Reference, Against::Truth] {
                let [name, text] = against.name_and_help();
                let reason = "Only built-in scenes in their own colours have an exact surface.";
                let reason = (!exact && against == Against::Truth).then_some(reason);
                if choice(ui, self.against == against, name, text, reason) {
                    self.against = against;
                }
            }
        });
        let Some(Ok(camera)) = &choices.camera else { return };
        let button = ui.add(Button::new("Compare this picture"));
        if button.on_hover_text("Renders the picture again at full quality, and the reference or exact picture; takes seconds to minutes.").clicked() {
            self.error = None;
            let task = Task {
                against: self.against,
                device: device.clone(),
                scene: choices.scene.clone(),
                model: choices.source.visible_model(),
                surface: choices.source.surface().map(Into::into),
                camera: *camera,
                settings: choices.settings.clone(),
                size: choices.size,
                options: RenderOptions { size: choices.size, rasterizer: choices.rasterizer, ..Default::default() },
            };
            self.job = Some(Job::start(move |progress| task.run(progress)));
        }
    }

    fn show_result(&mut self, ui: &mut Ui, choices: &Choices<'_>) {
        let Some(found) = &self.found else { return };
        let same = matches!(&choices.camera, Some(Ok(camera)) if *camera == found.camera)
            && *choices.settings == found.settings;
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
            for (name, value, text) in rows {
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
}

impl Task {
    /// Runs the comparison.
    fn run(self, progress: &dyn Progress) -> Result<Comparison> {
        let Self { against, device, scene, model, surface, camera, settings, size, options } = self;
        let (picture, _) = Renderer::new(&device, options)?.render_picture(&scene, &camera, &settings)?;
        let start = Instant::now();
        let truth = match (against, surface) {
            (Against::Truth, Some(surface)) => {
                let surface = scenes::surface(&surface)?;
                truth::render(&*surface, &camera, &settings, size, &truth::Options::default(), progress)?
                    .picture
            }
            _ => reference::render(&*model, &camera, size, &settings, progress)?.to_picture(),
        };
        if progress.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let took = start.elapsed();
        let over = settings.background.unwrap_or_default();
        let [picture, truth] = [picture, truth].map(|picture| composite(&picture, over));
        let rmse = metrics::rmse::rmse(&picture, &truth);
        let errors = differences(&picture, &truth);
        let worst = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let worst =
            worst.map_or((0.0, [0, 0]), |(i, error)| (*error, [i as u32 % size[0], i as u32 / size[0]]));
        Ok(Comparison { against, camera, settings, size, rmse, errors, worst, took })
    }
}

/// Composites colours over a background, as the window shows them.
fn composite(picture: &Picture, over: [f32; 3]) -> Vec<[f64; 3]> {
    let pixel = |[r, g, b, a]: &[f32; 4]| {
        let channel =
            |i: usize, c: f32| f64::from(c) * f64::from(*a) + f64::from(over[i]) * (1.0 - f64::from(*a));
        [channel(0, *r), channel(1, *g), channel(2, *b)]
    };
    picture.colour.iter().map(pixel).collect()
}

/// The largest difference of a channel of each pixel.
fn differences(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<f32> {
    let largest =
        |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) as f32;
    a.iter().zip(b).map(largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_composited_and_the_largest_difference_counts() {
        let picture = Picture {
            size: [2, 1],
            colour: vec![[1.0, 0.5, 0.0, 1.0], [1.0, 1.0, 1.0, 0.25]],
            ..Default::default()
        };
        let over = composite(&picture, [0.0, 1.0, 0.5]);
        assert_eq!(over, [[1.0, 0.5, 0.0], [0.25, 1.0, 0.625]]);
        assert_eq!(differences(&over, &[[1.0, 0.0, 0.25], [0.25, 1.0, 0.625]]), [0.5, 0.0]);
    }
}
