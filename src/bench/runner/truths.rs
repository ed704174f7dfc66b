//! What runs are compared with, each rendered once.

use super::{Job, ModelKey, Runner};
use crate::error::Result;
use crate::geometry::Camera;
use crate::settings::Settings;
use crate::verify::truth::{self, Cache, StandardError, Traceable, Truth};
use std::rc::Rc;

impl Runner {
    /// The exact picture, or the supersampled reference if the surface is unknown. Each is rendered once.
    pub(super) fn truth(&mut self, job: &Job<'_>, camera: &Camera) -> Result<Rc<Truth>> {
        let own = &job.plan.settings;
        let settings = match job.subject.surface() {
            Some(_) => Settings {
                shading: own.shading,
                background: own.background,
                lighting: own.lighting.clone(),
                ..Default::default()
            },
            // A model without levels of detail is drawn whole.
            None => Settings { lod: 0.0, ..own.clone() },
        };
        let key = format!("{} {:?} {settings:?} {camera:?}", job.plan.scene, job.plan.size);
        if let Some(truth) = self.truths.get(&key) {
            return Ok(truth.clone());
        }
        let truth = Rc::new(match job.subject.surface() {
            Some(surface) => self.exact(job, surface, camera, &settings)?,
            None => self.supersampled(job, camera, &settings)?,
        });
        self.truths.insert(key, truth.clone());
        Ok(truth)
    }

    /// The exact picture of a surface, cached on disk if there is a folder.
    fn exact(
        &self,
        job: &Job<'_>,
        surface: &dyn Traceable,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Truth> {
        let (size, options, digest) = (job.plan.size, &self.options.truth, &job.subject.digest);
        match &self.options.cache {
            Some(folder) => Cache::new(folder).render(digest, surface, camera, settings, size, options, &()),
            None => truth::render(surface, camera, settings, size, options, &()),
        }
    }

    /// The float64 reference of all points, with 64 rays a pixel.
    fn supersampled(&self, job: &Job<'_>, camera: &Camera, settings: &Settings) -> Result<Truth> {
        let points = job.subject.most_points().unwrap_or(job.plan.points);
        let key = ModelKey { points, ..self.key(job.plan) };
        let model = self.model(&job.subject, &key)?;
        let (size, filter) = (job.plan.size, self.options.truth.filter);
        let picture = truth::supersampled(&model, camera, settings, size, filter, &())?;
        Ok(Truth { picture, error: StandardError::default() })
    }
}

/// Name of the pixel filter in results.
pub(super) fn filter_name(options: &truth::Options) -> String {
    match options.filter {
        truth::Filter::Gaussian { .. } => "gaussian".into(),
        truth::Filter::Box => "box".into(),
        truth::Filter::Point => "point".into(),
    }
}
