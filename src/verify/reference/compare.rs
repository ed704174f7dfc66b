//! Compares a picture with the float64 frame.

use super::bands::Bands;
use super::error_bounds::{Admissible, ErrorBounds};
use super::error_model::{DEPTH_TOLERANCE, ErrorModel};
use super::filtered_bounds::{FilteredBounds, PixelRange};
use super::projected_scene::ProjectedScene;
use super::rounding::RoundingBound;
use super::tolerance::{Channel, Differences, Limits, Tolerance};
use super::{Frame, Projector, Value, after_light, draw, sides};
use crate::error::{Error, Result};
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::settings::{Settings, Shading};
use rayon::prelude::*;

/// Failures that are recorded in full.
const RECORDED: usize = 20;

/// A wrong pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// The first channel out of tolerance, in the order coverage, depth, normal, colour.
    pub channel: Channel,
    /// Value of the picture in that channel; unused entries are 0.
    pub gpu: [f64; 4],
    /// Value of the reference in that channel.
    pub reference: [f64; 4],
}

/// Result of [`compare`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels of the picture.
    pub pixels: usize,
    /// Pixels that the reference covers.
    pub object_pixels: usize,
    /// Ambiguous pixels: rounding can flip one of their decisions.
    pub ambiguous: usize,
    /// Ambiguous pixels with too many admissible values to try. Each counts as failed unless the frame's own value
    /// passes.
    pub unresolvable: usize,
    /// Pixels out of tolerance.
    pub failed: usize,
    /// The first of them.
    pub failures: Vec<Failure>,
    /// Largest differences over the unambiguous pixels.
    pub worst: Differences,
    /// Largest differences over all pixels; ambiguous ones are compared with their nearest admissible value.
    pub worst_of_all: Differences,
}

impl Comparison {
    /// Whether every pixel is within tolerance.
    pub fn passed(&self) -> bool {
        self.failed == 0
    }
}

/// The float64 frame and its error bounds, to compare any number of pictures with.
pub struct Expected {
    /// The frame.
    pub frame: Frame,
    /// Its values before the filter, which `frame` has if pixels are not filtered.
    unfiltered: Option<Frame>,
    filtered: Option<FilteredBounds>,
    /// Its error bounds.
    pub bounds: ErrorBounds,
    tolerance: Tolerance,
    depth_shown: bool,
}

/// Compares a picture that has depth and normals with the float64 frame of the same scene; see [`Expected::compare`].
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
    /// Renders the frame and computes its error bounds.
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
        if settings.occludes() {
            let text = "what rounding may turn is not known under ambient occlusion: compare pictures without it, and with `occluded` of their own distances";
            return Err(Error::Usage(text.into()));
        }
        settings.splatting.normalization.check_weights(surfels.weights.is_some())?;
        let projector = Projector::new(camera, size, settings)?;
        let model = ErrorModel::new(&projector, surfels, tolerance.rounding);
        let scene = ProjectedScene::project(&projector, surfels);
        let possible = sides::possible(&model, scene.clone(), size);
        let bounds = ErrorBounds::new(&model, &possible, &Bands::new(&projector, &possible, size));
        let scene = sides::pass(&projector, scene, size);
        let bands = Bands::new(&projector, &scene, size);
        let depth_shown = settings.shading == Shading::Depth;
        let frame = draw(&projector, &scene, &bands, &());
        let mut expected =
            Self { frame, unfiltered: None, filtered: None, bounds, tolerance: *tolerance, depth_shown };
        if settings.has_late_background() {
            let ranges = (0..expected.frame.depth.len()).into_par_iter().map(|i| expected.range(i)).collect();
            expected.filtered = Some(FilteredBounds::new(&projector, ranges, size));
            let frame = after_light(&projector, expected.frame.clone());
            expected.unfiltered = Some(std::mem::replace(&mut expected.frame, frame));
        }
        Ok(expected)
    }

    /// Compares every pixel of `gpu` with the frame's value. If that fails and the pixel is ambiguous, compares it with
    /// its other admissible values. Fails if the picture has another size, or lacks depth or normals.
    pub fn compare(&self, gpu: &Picture) -> Result<Comparison> {
        let mut found = Comparison {
            pixels: self.frame.depth.len(),
            object_pixels: self.frame.covered.iter().filter(|c| **c).count(),
            ambiguous: self.bounds.ambiguous_pixels().len(),
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

    /// Range of a pixel's values before the filter.
    fn range(&self, index: usize) -> PixelRange {
        let rounding = self.bounds.rounding(index);
        let limit = |bound: RoundingBound| self.limits(bound).colour();
        let depth = |bound: RoundingBound| bound.depth.max(DEPTH_TOLERANCE);
        let own = PixelRange::new(0.0).with(&self.frame.value(index), limit(rounding), depth(rounding));
        match self.bounds.admissible(index) {
            Admissible::Definite => own,
            Admissible::Unresolvable => PixelRange::unknown(),
            Admissible::Values(values) => {
                values.fold(own, |range, (value, bound)| range.with(&value, limit(bound), depth(bound)))
            }
        }
    }

    /// A value without what is compared after the filter: colour and α.
    fn without_filtered(&self, value: &Value) -> Value {
        let colour = if self.filtered.is_some() { [0.0; 4] } else { value.colour };
        Value { colour, ..*value }
    }

    fn pixel(&self, index: usize, seen: &Value, found: &mut Comparison) {
        let filtered = self.filtered.as_ref().map(|bounds| bounds.distance(index, seen));
        let seen = &self.without_filtered(seen);
        let own = self.unfiltered.as_ref().unwrap_or(&self.frame).value(index);
        let limits = self.limits(self.bounds.rounding(index));
        let compared = |(value, bound): (Value, RoundingBound)| {
            let limits = self.limits(bound);
            let differences = limits.differences(seen, &self.without_filtered(&value));
            (limits.excess(&differences), differences)
        };
        let mut best = compared((own, self.bounds.rounding(index)));
        match self.bounds.admissible(index) {
            Admissible::Definite => found.worst.take_max(&best.1),
            Admissible::Unresolvable => found.unresolvable += 1,
            Admissible::Values(values) => {
                let nearest = values.map(compared).min_by(|a, b| a.0.total_cmp(&b.0));
                best = nearest.unwrap_or(best);
            }
        }
        if let Some((distance, limit)) = filtered {
            best.0 = best.0.max(distance / limit);
            best.1.colour = best.1.colour.max(distance);
            found.worst.colour = found.worst.colour.max(if limit.is_finite() { distance } else { 0.0 });
        }
        found.worst_of_all.take_max(&best.1);
        if best.0 <= 1.0 {
            return;
        }
        found.failed += 1;
        if found.failures.len() < RECORDED {
            let width = self.frame.size[0] as usize;
            let [x, y] = [index % width, index / width].map(|v| v as u32);
            let (channel, gpu, reference) = limits.first_difference(seen, &self.without_filtered(&own));
            found.failures.push(Failure { x, y, channel, gpu, reference });
        }
    }

    fn limits(&self, bound: RoundingBound) -> Limits {
        Limits::new(&self.tolerance, bound, self.depth_shown)
    }
}
