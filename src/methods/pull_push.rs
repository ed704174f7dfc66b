//! The passes of pull–push: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! surfels, lines, triangles ─ project → the nearest point of each pixel ─ fetch → level 0
//! level 0 ─ pull → 1 ─ pull → … ─ pull → top           means of what is in front, fine to coarse
//! picture ← shade ← 0 ← push ← 1 ← push ← … ← push     holes filled, hidden points replaced, coarse to fine
//! ```

use super::{Method, perspective_ewa};
use crate::error::Result;
use crate::passes::{PointViews, Project, Pull, Push, PyramidSet, Shade, SplatLayout, Splats};
use crate::pull_push::Rules;
use crate::settings::Cull;
use crate::targets::Pyramids;
use crate::variant::Variant;
use crate::vk::{Buffer, DescriptorSet, Device, Recorder};
use std::sync::Arc;

/// The preset that holds.
pub const METHOD: Method = Method {
    name: "pull-push",
    pull_push: Some(crate::pull_push::PullPush { rules: Rules::Robust }),
    ..PAPER
};

/// The preset as published.
pub const PAPER: Method = Method {
    name: "pull-push-paper",
    paper: "Marroquim, Kraus, Cavalcanti, Efficient Image Reconstruction for Point-Based and Line-Based Rendering, 2008",
    pull_push: Some(crate::pull_push::PullPush { rules: Rules::Paper }),
    cull: Cull::Back,
    ..perspective_ewa::METHOD
};

/// Their names.
pub const PASSES: [&str; 5] = ["project", "fetch", "pull", "push", "shade"];

/// The passes.
pub struct PullPush {
    project: Project,
    pull: Pull,
    push: Push,
    shade: Shade,
}

/// Their views of what a frame writes and reads.
pub struct PullPushViews {
    frame: DescriptorSet,
    set: PyramidSet,
    points: Option<PointViews>,
}

impl PullPush {
    /// Makes the pipelines.
    pub fn new(device: &Arc<Device>, layout: &SplatLayout, variant: &Variant) -> Result<Self> {
        Ok(Self {
            project: Project::new(device, layout, variant)?,
            pull: Pull::new(device, layout, variant)?,
            push: Push::new(device, layout, variant)?,
            shade: Shade::new(device, layout, variant)?,
        })
    }

    /// Their views of `frame` and `targets`, which must outlive them.
    pub fn views(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        frame: &Buffer,
        targets: &Pyramids,
    ) -> Result<PullPushViews> {
        Ok(PullPushViews {
            frame: self.shade.view(device, frame)?,
            set: PyramidSet::new(device, layout, targets)?,
            points: self.project.views(device, layout, targets)?,
        })
    }

    /// Records a frame.
    pub fn record(&self, rec: &mut Recorder<'_>, splats: &Splats, views: &PullPushViews, targets: &Pyramids) {
        let PullPushViews { frame, set, points } = views;
        self.project.record(rec, splats, frame, set, points.as_ref(), targets);
        self.pull.record(rec, frame, set, targets);
        self.push.record(rec, frame, set, targets);
        self.shade.record(rec, frame, set, targets);
    }
}
