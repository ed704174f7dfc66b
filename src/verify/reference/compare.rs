//! Judges a picture against the float64 frame.

use super::bands::Bands;
use super::doubt::{Admissible, Doubt};
use super::judge::{Channel, Judge, Tolerance, Worst};
use super::margin::Margins;
use super::scene::Scene;
use super::slack::Slack;
use super::{Frame, Projector, Value, draw};
use crate::error::{Error, Result};
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::settings::{Settings, Shading};

/// Failures that are kept in full.
const KEPT: usize = 20;

/// A wrong pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// The first image out of tolerance, in the order coverage, depth, normal, colour.
    pub channel: Channel,
    /// What the picture holds in that image; unused entries are 0.
    pub gpu: [f64; 4],
    /// What the reference holds there.
    pub reference: [f64; 4],
}

/// What [`compare`] found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels of the picture.
    pub pixels: usize,
    /// Pixels that the reference covers.
    pub object_pixels: usize,
    /// Pixels in doubt.
    pub doubtful: usize,
    /// Pixels in doubt whose admissible values are too many to try; each counts as wrong unless the frame's own value passes.
    pub unresolvable: usize,
    /// Wrong pixels.
    pub failed: usize,
    /// The first of them.
    pub failures: Vec<Failure>,
    /// Largest differences over the pixels that are not in doubt.
    pub worst: Worst,
    /// Largest differences over all pixels; those in doubt against the admissible value that comes nearest.
    pub worst_of_all: Worst,
}

impl Comparison {
    /// Whether every pixel is right.
    pub fn passed(&self) -> bool {
        self.failed == 0
    }
}

/// The float64 frame and its pixels in doubt: all that is needed to judge any number of pictures of it.
pub struct Expected {
    /// The frame.
    pub frame: Frame,
    /// Its pixels in doubt.
    pub doubt: Doubt,
    tolerance: Tolerance,
    depth_shown: bool,
}

/// Compares a picture that carries depth and normals with the float64 one of the same scene; see [`Expected::compare`].
pub fn compare(
    surfels: &Surfels,
    camera: &Camera,
    size: [u32; 2],
    settings: &Settings,
    gpu: &Picture,
    tolerance: &Tolerance,
) -> Result<Comparison> {
    Expected::new(surfels, camera, size, settings, tolerance)?.compare(gpu)
}

impl Expected {
    /// Renders the frame and finds the pixels in doubt.
    pub fn new(
        surfels: &Surfels,
        camera: &Camera,
        size: [u32; 2],
        settings: &Settings,
        tolerance: &Tolerance,
    ) -> Result<Self> {
        if settings.pull_push.is_some() {
            let text = "what rounding may turn is known of splats alone: compare pull-push with the reference's picture";
            return Err(Error::Usage(text.into()));
        }
        settings.splatting.normalization.check_weights(surfels.weights.is_some())?;
        let projector = Projector::new(camera, size, settings)?;
        let scene = Scene::project(&projector, surfels);
        let bands = Bands::new(&projector, &scene, size);
        let doubt =
            Doubt::new(&Margins { projector: &projector, rounding: tolerance.rounding }, &scene, &bands);
        let depth_shown = settings.shading == Shading::Depth;
        Ok(Self { frame: draw(&projector, &scene, &bands, &()), doubt, tolerance: *tolerance, depth_shown })
    }

    /// Holds every pixel of `gpu` against the frame's value or, where that fails and the pixel is in doubt, against its
    /// other admissible values. Fails if the picture has another size or lacks depth or normals.
    pub fn compare(&self, gpu: &Picture) -> Result<Comparison> {
        let mut found = Comparison {
            pixels: self.frame.depth.len(),
            object_pixels: self.frame.covered.iter().filter(|c| **c).count(),
            doubtful: self.doubt.len(),
            ..Default::default()
        };
        let (depths, normals) = self.images(gpu)?;
        for (i, colour) in gpu.colour.iter().enumerate() {
            let seen = Value {
                covered: depths[i] != 0.0,
                colour: colour.map(f64::from),
                depth: depths[i].into(),
                normal: normals[i].map(f64::from),
            };
            self.pixel(i, &seen, &mut found);
        }
        Ok(found)
    }

    fn images<'a>(&self, gpu: &'a Picture) -> Result<(&'a [f32], &'a [[f32; 3]])> {
        let refuse = |cause: &str| Err(Error::input("the picture to compare", cause));
        let (Some(depths), Some(normals)) = (&gpu.depth, &gpu.normal) else {
            return refuse("has no depth or no normals: ask for both when it is rendered");
        };
        let lengths = [gpu.colour.len(), depths.len(), normals.len()];
        if gpu.size != self.frame.size || lengths != [self.frame.depth.len(); 3] {
            return refuse("has another size than the reference: render both alike");
        }
        Ok((depths, normals))
    }

    fn pixel(&self, index: usize, seen: &Value, found: &mut Comparison) {
        let own = self.frame.value(index);
        let judge = self.judge(self.doubt.slack(index));
        let verdict = |(value, slack): (Value, Slack)| {
            let judge = self.judge(slack);
            let differences = judge.differences(seen, &value);
            (judge.excess(&differences), differences)
        };
        let mut best = verdict((own, self.doubt.slack(index)));
        match self.doubt.admissible(index) {
            Admissible::Definite => found.worst.widen(&best.1),
            Admissible::Unresolvable => found.unresolvable += 1,
            Admissible::Values(values) => {
                let nearest = values.map(verdict).min_by(|a, b| a.0.total_cmp(&b.0));
                best = nearest.unwrap_or(best);
            }
        }
        found.worst_of_all.widen(&best.1);
        if best.0 <= 1.0 {
            return;
        }
        found.failed += 1;
        if found.failures.len() < KEPT {
            let width = self.frame.size[0] as usize;
            let [x, y] = [index % width, index / width].map(|v| v as u32);
            let (channel, gpu, reference) = judge.first_difference(seen, &own);
            found.failures.push(Failure { x, y, channel, gpu, reference });
        }
    }

    fn judge(&self, slack: Slack) -> Judge {
        Judge::new(&self.tolerance, slack, self.depth_shown)
    }
}
