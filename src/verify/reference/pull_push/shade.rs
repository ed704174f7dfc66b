//! Pass `shade`: shades the picture pixel by pixel (marroquim2008 section 3.4).

use super::super::normalize::{Value, picture_pixel, uncovered};
use super::super::{Frame, Shine, line_normal, lit, lit_line};
use super::{Decisions, Level, PassProgress, Reconstruction, Sample, coverage, texture};
use crate::settings::pull_push::Rules;
use crate::settings::{Alpha, Shading};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub fn pass(frame: &Reconstruction, pushed: &Level, progress: &PassProgress<'_>) -> Frame {
    let value = |(sample, at): (Option<Sample>, [i64; 2])| match sample {
        Some(sample) if !progress.is_cancelled() => {
            let alpha = alpha(frame, pushed, at, &Decisions::new());
            let colour = texture::colour(frame, pushed, at, &sample);
            value(frame, &Sample { colour, ..sample }, pushed.centre(at), alpha)
        }
        _ => uncovered(&frame.projector),
    };
    let values: Vec<Value> = pixels(pushed).map(value).collect();
    progress.advance(values.len() as u64);
    let id = pushed.samples.iter().map(|sample| sample.map_or(Frame::NOBODY, |sample| sample.id)).collect();
    Frame { id: Some(id), ..Frame::of(&values, pushed.size) }
}

/// Gaps of the decisions about the α of each pixel.
pub fn gaps(frame: &Reconstruction, pushed: &Level) -> Vec<f64> {
    let gap = |(sample, at): (Option<Sample>, [i64; 2])| {
        let decisions = Decisions::new();
        if sample.is_some() {
            alpha(frame, pushed, at, &decisions);
        }
        decisions.least_gap()
    };
    pixels(pushed).map(gap).collect()
}

/// The samples of a level with their pixel coordinates.
fn pixels(level: &Level) -> impl IndexedParallelIterator<Item = (Option<Sample>, [i64; 2])> {
    let width = i64::from(level.size[0]);
    let place = move |i: usize| [i as i64 % width, i as i64 / width];
    level.samples.par_iter().enumerate().map(move |(i, sample)| (*sample, place(i)))
}

/// α of a pixel that has a disc.
fn alpha(frame: &Reconstruction, pushed: &Level, at: [i64; 2], decisions: &Decisions) -> f64 {
    match frame.projector.settings.drawn_alpha() {
        Alpha::Mask => 1.0,
        Alpha::Coverage => coverage::of(frame, pushed, at, decisions),
    }
}

fn value(frame: &Reconstruction, sample: &Sample, at: DVec2, alpha: f64) -> Value {
    let projector = &frame.projector;
    let viewer = projector.to_viewer(at);
    let (depth, normal) = match (sample.tube, frame.pull_push.rules) {
        (false, _) => (sample.depth, projector.to_world(sample.normal)),
        (true, Rules::Paper) => (sample.depth, line_normal(projector.to_world(sample.normal), viewer)),
        (true, Rules::Robust) => {
            let (depth, normal) = frame.rays.on_tube(sample, at + sample.displacement, at);
            (depth, projector.to_world(normal))
        }
    };
    let settings = &projector.settings;
    let lighting = &settings.lighting;
    let material = frame.materials.as_ref().and_then(|materials| materials.material(sample.id as usize));
    let shine = material.map_or(Shine::of_frame(lighting), Shine::from);
    let is_line = sample.tube && frame.pull_push.rules == Rules::Paper;
    let shown = match settings.shading {
        Shading::Lit if is_line => {
            lit_line(lighting, shine, sample.colour, projector.to_world(sample.normal), viewer)
        }
        Shading::Lit => lit(lighting, shine, sample.colour, normal, viewer),
        Shading::Colour | Shading::Edl => sample.colour,
        Shading::Normal => normal,
        Shading::Depth => DVec3::splat(depth),
        // A pixel shows one point, or the reconstruction of several.
        Shading::Overlap | Shading::Weight => DVec3::ONE,
    };
    let colour = picture_pixel(projector, shown, alpha);
    Value { covered: true, colour, depth, normal: normal.to_array() }
}
