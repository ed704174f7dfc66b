//! Validation of settings.

use super::pull_push::PullPush;
use super::splatting::Splatting;
use super::{Outputs, Settings};
use crate::error::{Error, Result};
use std::ops::RangeInclusive;

impl Settings {
    /// Returns an error if the scene has lines or triangles, as `there` tells, and the method draws splats only.
    pub fn check_primitives(&self, there: bool) -> Result<()> {
        if there && self.pull_push.is_none() {
            Err(Error::Usage(
                "only pull-push and pull-push-paper draw lines and triangles: choose one of these methods, or leave them out".into(),
            ))
        } else {
            Ok(())
        }
    }

    /// Returns an error if point ids are requested of a method that blends several points.
    pub fn check_outputs(&self, outputs: Outputs) -> Result<()> {
        if outputs.id && self.pull_push.is_none() {
            Err(Error::Usage(
                "only pull-push and pull-push-paper have point ids, as splats are summed: choose one of these methods, or leave the ids out"
                    .into(),
            ))
        } else {
            Ok(())
        }
    }

    /// Validates the settings.
    pub fn check(&self) -> Result<()> {
        if self.pull_push.is_some() && self.splatting != Splatting::default() {
            return Err(Error::Usage(
                "pull-push has no splats: leave out footprint, kernel, filter, visibility, normalization and shade".into(),
            ));
        }
        self.pull_push.map_or(Ok(()), PullPush::check)?;
        self.splatting.check()?;
        within("the cut-off", self.cutoff, Self::CUTOFFS, " of standard deviations")?;
        if !(self.epsilon.is_finite() && self.epsilon > 0.0) {
            return Err(Error::Usage(format!("epsilon is {}: give a finite number above 0", self.epsilon)));
        }
        within("the low-pass variance", self.lowpass, 0.0..=Self::MOST_LOWPASS, " of px²")?;
        let filter = "the variance of the pixel filter";
        within(filter, self.pixel_filter, 0.0..=Self::MOST_PIXEL_FILTER, " of px²")?;
        within("the strength of eye-dome lighting", self.edl, 0.0..=Self::MOST_EDL, "")?;
        within("the strength of ambient occlusion", self.ao, 0.0..=Self::MOST_AO, "")?;
        within("the size of points", self.point_size, Self::POINT_SIZES, " of px")?;
        within("the level of detail", self.lod, 0.0..=Self::MOST_LOD, " of px")?;
        if self.max_points == Some(0) {
            return Err(Error::Usage("at most 0 points may be drawn: give a number above 0".into()));
        }
        self.lighting.check()?;
        if self.background.is_some_and(|colour| !colour.iter().all(|channel| channel.is_finite())) {
            return Err(Error::Usage(format!(
                "the background is {:?}: give finite numbers",
                self.background
            )));
        }
        Ok(())
    }
}

/// Returns an error if the value of `name` is outside of `range`; `unit` continues "a number".
fn within(name: &str, value: f32, range: RangeInclusive<f32>, unit: &str) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let (least, most) = range.into_inner();
    Err(Error::Usage(format!("{name} is {value}: give a number{unit} from {least} to {most}")))
}
