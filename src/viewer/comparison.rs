//! Comparison of the picture with the float64 reference or with the exact surface.

use super::choices::PictureContent;
use super::exact_surface::ExactSurface;
use std::sync::Arc;
use std::time::{Duration, Instant};
use surfel::geometry::{Levels, Model, Parts};
use surfel::verify::{metrics, reference, truth};
use surfel::vk::Device;
use surfel::{Error, Picture, Progress, RenderOptions, Renderer, Result, Scene};

/// What the picture is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    Reference,
    Surface,
}

impl Against {
    /// Name, and text for the user.
    pub const fn name_and_help(self) -> [&'static str; 2] {
        match self {
            Self::Reference => [
                "float64 reference",
                "The same method, camera and settings in float64 on the CPU: shows the error of rounding and of the GPU.",
            ],
            Self::Surface => [
                "exact surface",
                "Rays against the surface itself, or a file's triangles: shows the error of points, method and filter, edges included.",
            ],
        }
    }
}

/// What a picture is compared with, before that is rendered.
pub enum Truth {
    /// The model, of which the float64 reference is rendered.
    Reference(Arc<Model>),
    /// The surface, of which the exact picture is rendered.
    Surface(ExactSurface),
}

/// A rendered reference or exact picture.
struct Rendered {
    picture: Picture,
    standard_error: Option<f64>,
    took: Duration,
}

/// A comparison to run.
pub struct Task {
    pub truth: Truth,
    pub device: Arc<Device>,
    pub scene: Arc<Scene>,
    pub content: PictureContent,
    pub options: RenderOptions,
}

/// Result of a comparison.
pub struct Comparison {
    pub against: Against,
    /// Of the picture that was compared.
    pub content: PictureContent,
    /// Of linear colours over the background.
    pub rmse: f64,
    /// The largest difference of a channel of each pixel.
    pub errors: Vec<f32>,
    /// The largest of these, and its pixel.
    pub worst: (f32, [u32; 2]),
    /// Standard error of the exact picture, root mean square.
    pub standard_error: Option<f64>,
    /// Time to render the reference or the exact picture, without reading triangles.
    pub took: Duration,
}

impl Task {
    /// Runs the comparison.
    ///
    /// # Errors
    /// Those of rendering, of reading the triangles of a file, and [`Error::Cancelled`].
    pub fn run(self, progress: &dyn Progress) -> Result<Comparison> {
        let (picture, _) = Renderer::new(&self.device, self.options)?.render_picture(
            &self.scene,
            &self.content.camera,
            &self.content.settings,
        )?;
        let Rendered { picture: truth, standard_error, took } = self.render_truth(progress)?;
        if progress.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let Self { truth: against, content, .. } = self;
        let (size, over) = (content.size, content.settings.background.unwrap_or_default());
        let [picture, truth] = [picture, truth].map(|picture| composite(&picture, over));
        let rmse = metrics::rmse::rmse(&picture, &truth);
        let errors = differences(&picture, &truth);
        let worst = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let worst =
            worst.map_or((0.0, [0, 0]), |(i, error)| (*error, [i as u32 % size[0], i as u32 / size[0]]));
        let against = match against {
            Truth::Reference(_) => Against::Reference,
            Truth::Surface(_) => Against::Surface,
        };
        Ok(Comparison { against, content, rmse, errors, worst, standard_error, took })
    }

    /// Renders what the picture is compared with. The time is without reading triangles.
    fn render_truth(&self, progress: &dyn Progress) -> Result<Rendered> {
        let PictureContent { camera, settings, size, .. } = &self.content;
        match &self.truth {
            Truth::Reference(model) => {
                // Of the surfels that stand for several points, too, if the scene has them.
                let detailed = self.scene.level_table().is_some();
                let levels = detailed.then(|| Levels::build(model.surfels.clone(), progress)).transpose()?;
                let mut parts = Parts::from(&**model);
                if let Some(levels) = &levels {
                    (parts.surfels, parts.levels) = (&levels.surfels, Some(&levels.table));
                }
                let start = Instant::now();
                let picture = reference::render(parts, camera, *size, settings, progress)?.to_picture();
                Ok(Rendered { picture, standard_error: None, took: start.elapsed() })
            }
            Truth::Surface(surface) => {
                let surface = surface.get(progress)?;
                let start = Instant::now();
                let options = truth::Options::default();
                let exact = truth::render(&*surface, camera, settings, *size, &options, progress)?;
                let standard_error = Some(exact.error.rms);
                Ok(Rendered { picture: exact.picture, standard_error, took: start.elapsed() })
            }
        }
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
    use crate::viewer::Loaded;
    use crate::viewer::levels::upload_with;
    use crate::viewer::source::Source;
    use crate::viewer::state::tests::{origin, state};
    use crate::viewer::tests::device;
    use surfel::geometry::SurfelFormat;
    use surfel::settings::methods::Method;
    use surfel::verify::scenes;

    #[test]
    fn surfels_that_stand_for_several_points_are_compared_with_the_reference_of_them() {
        let test = "surfels_that_stand_for_several_points_are_compared_with_the_reference_of_them";
        let Some(device) = device(test) else { return };
        let (model, method) = (scenes::model("scene:bumpy-sphere?points=60000").unwrap(), Method::ALL[0]);
        let scene = upload_with(&device, &model, SurfelFormat::default(), &()).unwrap();
        assert!(scene.level_table().is_some());
        let mut state = state();
        state.viewport.size = [64, 48];
        state.set_scene(scene, (method, Source::new(Loaded::new(model, method))), origin(1, false));
        let choices = state.choices().unwrap();
        let task = Task {
            truth: Truth::Reference(choices.source.visible_model()),
            device,
            scene: choices.scene.clone(),
            content: choices.content().unwrap(),
            options: RenderOptions { size: choices.size, ..Default::default() },
        };
        let found = task.run(&()).unwrap();
        assert!(found.rmse < 1e-4, "{}", found.rmse);
    }

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
