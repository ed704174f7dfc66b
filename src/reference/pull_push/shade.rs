//! Pass `shade`: the picture, lit pixel by pixel (marroquim2008 section 3.4).

use super::super::normalize::{Value, uncovered};
use super::super::{Frame, line_normal, lit, lit_line};
use super::{Level, Reconstruction, Sample};
use crate::pull_push::Rules;
use crate::settings::Shading;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub fn pass(frame: &Reconstruction, pushed: &Level) -> Frame {
    let width = i64::from(pushed.size[0]);
    let values: Vec<Value> = pushed
        .samples
        .par_iter()
        .enumerate()
        .map(|(i, sample)| match sample {
            Some(sample) => value(frame, sample, pushed.centre([i as i64 % width, i as i64 / width])),
            None => uncovered(&frame.projector),
        })
        .collect();
    Frame::of(&values, pushed.size)
}

fn value(frame: &Reconstruction, sample: &Sample, at: DVec2) -> Value {
    let projector = &frame.projector;
    let viewer = projector.to_viewer(at);
    let (depth, normal) = match (sample.tube, frame.pull_push.rules) {
        (false, _) => (sample.depth, projector.to_world(sample.normal)),
        (true, Rules::Paper) => (sample.depth, line_normal(projector.to_world(sample.normal), viewer)),
        (true, Rules::Robust) => {
            let (depth, normal) = frame.lens.on_tube(sample, at + sample.displacement, at);
            (depth, projector.to_world(normal))
        }
    };
    let settings = &projector.settings;
    let is_line = sample.tube && frame.pull_push.rules == Rules::Paper;
    let shown = match settings.shading {
        Shading::Lit if is_line => {
            lit_line(&settings.lighting, sample.colour, projector.to_world(sample.normal), viewer)
        }
        Shading::Lit => lit(&settings.lighting, sample.colour, normal, viewer),
        Shading::Colour => sample.colour,
        Shading::Normal => normal,
        Shading::Depth => DVec3::splat(depth),
        // A pixel shows one point, or what is made of those about it.
        Shading::Overlap | Shading::Weight => DVec3::ONE,
    };
    Value { covered: true, colour: shown.extend(1.0).to_array(), depth, normal: normal.to_array() }
}
