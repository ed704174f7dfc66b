//! Judges a picture against the float64 frame.

use super::bands::Bands;
use super::doubt::{Admissible, Doubt};
use super::footprint::Scene;
use super::margin::Margins;
use super::slack::Slack;
use super::{Frame, Projector, Value, draw};
use crate::error::{Error, Result};
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::settings::{Settings, Shading};

/// Failures that are kept in full.
const KEPT: usize = 20;

/// Largest differences that pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of each linear channel and of α, absolute.
    pub colour: f64,
    /// Of each component of the unit normal, absolute.
    pub normal: f64,
    /// Of the depth, relative to it.
    pub depth_relative: f64,
    /// Rounding error of a unit vector's component in float32, for the conditioning of steep splats; 0 judges strictly.
    ///
    /// A plane seen at an angle θ turns rounding errors of its normal, its centre and the ray into depth errors 1 / cos θ as
    /// large, and so `√|V|` with its weight: no float32 renderer can know better. Where that exceeds the other margins the
    /// ε test is in doubt over that much depth, and the pixel's tolerance widens to the weighted mean of its splats'
    /// and by as much as cancelling normals amplify it.
    pub rounding: f64,
}

impl Tolerance {
    /// What float32 can hold: the default with a rounding of four half units in the last place.
    pub fn float32() -> Self {
        Self { rounding: 4.0 * 2f64.powi(-24), ..Self::default() }
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { colour: 2e-4, normal: 2e-4, depth_relative: 1e-5, rounding: 0.0 }
    }
}

/// One image of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Linear RGB, or whatever the shading shows.
    Colour,
    /// α, and with it coverage.
    Coverage,
    /// Eye-space distance.
    Depth,
    /// World-space normal.
    Normal,
}

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

/// Largest differences, in the units of [`Tolerance`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Of colour and α.
    pub colour: f64,
    /// Of the normal.
    pub normal: f64,
    /// Of the depth, relative.
    pub depth: f64,
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
        let projector = Projector::new(camera, size, settings)?;
        let scene = Scene::project(&projector, surfels);
        let bands = Bands::new(&projector, &scene, size);
        let doubt =
            Doubt::new(&Margins { projector: &projector, rounding: tolerance.rounding }, &scene, &bands);
        let depth_shown = settings.shading == Shading::Depth;
        Ok(Self { frame: draw(&projector, &scene, &bands), doubt, tolerance: *tolerance, depth_shown })
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

impl Worst {
    fn widen(&mut self, other: &Self) {
        // Not `f64::max`, which would pass over what is not a number.
        let max = |a: f64, b: f64| if b.is_nan() || a < b { b } else { a };
        self.colour = max(self.colour, other.colour);
        self.normal = max(self.normal, other.normal);
        self.depth = max(self.depth, other.depth);
    }
}

/// How two values of a pixel are told apart.
struct Judge {
    /// Largest differences that pass.
    limit: Worst,
    /// The colour holds depths, which are compared as such.
    depth_shown: bool,
}

impl Judge {
    fn new(tolerance: &Tolerance, slack: Slack, depth_shown: bool) -> Self {
        let gain = 1.0 + slack.turn;
        let limit = Worst {
            colour: gain * tolerance.colour.max(slack.attribute),
            normal: gain * tolerance.normal.max(slack.attribute),
            depth: tolerance.depth_relative.max(slack.depth),
        };
        Self { limit, depth_shown }
    }

    fn differences(&self, a: &Value, b: &Value) -> Worst {
        let unit = if b.depth == 0.0 { 1.0 } else { b.depth.abs() };
        let mut worst = Worst {
            colour: largest(&a.colour[3..], &b.colour[3..]),
            normal: largest(&a.normal, &b.normal),
            depth: (a.depth - b.depth).abs() / unit,
        };
        let shown = largest(&a.colour[..3], &b.colour[..3]);
        match self.depth_shown && b.covered {
            true => worst.widen(&Worst { depth: shown / unit, ..Default::default() }),
            false => worst.widen(&Worst { colour: shown, ..Default::default() }),
        }
        worst
    }

    /// The largest difference in tolerances: passes up to 1.
    fn excess(&self, d: &Worst) -> f64 {
        let parts = [d.colour / self.limit.colour, d.normal / self.limit.normal, d.depth / self.limit.depth];
        parts.into_iter().fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
    }

    /// The first image out of tolerance, and what both hold there.
    fn first_difference(&self, seen: &Value, own: &Value) -> (Channel, [f64; 4], [f64; 4]) {
        let d = self.differences(seen, own);
        let beyond = |difference: f64, limit: f64| difference.is_nan() || difference > limit;
        let first = |v: f64| [v, 0.0, 0.0, 0.0];
        let pad = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
        if seen.covered != own.covered || beyond((seen.colour[3] - own.colour[3]).abs(), self.limit.colour) {
            (Channel::Coverage, first(seen.colour[3]), first(own.colour[3]))
        } else if beyond(d.depth, self.limit.depth) {
            (Channel::Depth, first(seen.depth), first(own.depth))
        } else if beyond(d.normal, self.limit.normal) {
            (Channel::Normal, pad(seen.normal), pad(own.normal))
        } else {
            (Channel::Colour, seen.colour, own.colour)
        }
    }
}

/// The largest absolute difference; NaN if there is one.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
}
