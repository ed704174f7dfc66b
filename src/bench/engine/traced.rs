//! Ray tracing instead of points.

use super::LoadedEngine;
use crate::bench::record::{Clock, Memory, Time};
use crate::bench::subject::Subject;
use crate::error::{Error, Result};
use crate::frame::times::Statistics;
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::settings::Settings;
use crate::verify::truth::{self, Filter, Mesh};
use crate::vk::PassTime;
use cpu_time::ProcessTime;
use std::rc::Rc;
use std::time::Instant;

/// Rays per pixel.
pub const RAYS: u32 = 16;

/// Pixel filter of traced pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TracedFilter {
    /// That of the exact pictures.
    Truth,
    /// The mean of the pixel's square, as of a triangle renderer with 16 samples a pixel.
    Box,
}

/// A subject's surface, or triangles between as many of its points, traced in float64 on the CPU with 16 rays a pixel.
pub struct TracedEngine {
    subject: Rc<Subject>,
    /// None for the subject's own surface.
    mesh: Option<Mesh>,
    size: [u32; 2],
    filter: Filter,
    time: Option<Time>,
}

impl TracedEngine {
    /// The surface of `points` points.
    ///
    /// # Errors
    /// [`Error::Usage`] if the subject has no surface, or so few points span no triangle.
    pub fn new(subject: &Rc<Subject>, points: u64, size: [u32; 2], filter: Filter) -> Result<Self> {
        let mesh = subject.coarse_mesh(points)?;
        Ok(Self { subject: subject.clone(), mesh, size, filter, time: None })
    }

    fn surface(&self) -> Result<&dyn truth::Traceable> {
        let own = self.mesh.as_ref().map(|mesh| mesh as &dyn truth::Traceable).or(self.subject.surface());
        own.ok_or_else(|| {
            Error::Usage(format!("{} has no triangles to trace: give --truth", self.subject.name))
        })
    }

    fn render(&self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        // No pixel is refined beyond the rays of its first strata.
        let options = truth::Options { filter: self.filter, error: f64::MAX, most_samples: RAYS };
        Ok(truth::render(self.surface()?, camera, settings, self.size, &options, &())?.picture)
    }
}

impl LoadedEngine for TracedEngine {
    fn frame(&mut self, camera: &Camera, settings: &Settings, _: bool) -> Result<Vec<PassTime>> {
        self.render(camera, settings).map(|_| Vec::new())
    }

    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        let (begin, spent) = (Instant::now(), ProcessTime::now());
        let picture = self.render(camera, settings)?;
        let once = |seconds: f64| Statistics::of(&[1e3 * seconds]).unwrap_or_default();
        self.time = Some(Time {
            clock: Clock::Cpu,
            frames: 1,
            warmup: 0,
            wall: once(begin.elapsed().as_secs_f64()),
            cpu: once(spent.elapsed().as_secs_f64()),
            passes: Vec::new(),
            device: None,
            others: None,
            baseline_ratio: None,
        });
        Ok(picture)
    }

    fn clock(&self) -> Clock {
        Clock::Cpu
    }

    fn memory(&self) -> Memory {
        Memory::default()
    }

    fn time_of_picture(&self) -> Option<Time> {
        self.time.clone()
    }
}
