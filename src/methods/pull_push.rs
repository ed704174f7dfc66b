//! The passes of pull–push: *Efficient Image Reconstruction for Point-Based and Line-Based Rendering*, Marroquim, Kraus, Cavalcanti,
//! Computers & Graphics 2008.
//!
//! ```text
//! surfels, lines, triangles ─ project → the nearest point of each pixel ─ fetch → level 0
//! level 0 ─ pull → 1 ─ pull → … ─ pull → top           means of what is in front, fine to coarse
//! picture ← shade ← 0 ← push ← 1 ← push ← … ← push     holes filled, hidden points replaced, coarse to fine
//! ```
//!
//! The push reads what was pulled of a level and what is final of the coarser one. `pull-push` keeps the two apart, in a pyramid each.
//! `pull-push-paper` has them take turns as published (§3.5, figure 7), a level in the pyramid of its parity:
//!
//! ```text
//! pull   even 0 → odd 1 → even 2 → odd 3
//! copy   even 0 → odd, odd 1 → even, even 2 → odd, odd 3 → even     so that both have all levels
//! push   even 3 → odd 3 → even 2 → odd 1 → even 0                     each reads two levels of one; shade reads the last
//! ```

use super::canvas::PerScene;
use super::{Method, perspective_ewa};
use crate::error::Result;
use crate::passes::{
    PointViews, Project, ProjectScene, Pull, Push, PyramidSets, Shade, SplatLayout, Splats, copy,
};
use crate::pull_push::{Rules, Storage};
use crate::settings::Cull;
use crate::targets::Pyramids;
use crate::variant::{SceneVariant, Variant};
use crate::vk::{Buffer, DescriptorSet, Device, Recorder};
use std::sync::Arc;

/// The preset that holds.
pub const METHOD: Method =
    Method { name: "pull-push", pull_push: Some(crate::pull_push::PullPush::of(Rules::Robust)), ..PAPER };

/// The preset as published.
pub const PAPER: Method = Method {
    name: "pull-push-paper",
    paper: "Marroquim, Kraus, Cavalcanti, Efficient Image Reconstruction for Point-Based and Line-Based Rendering, 2008",
    pull_push: Some(crate::pull_push::PullPush::of(Rules::Paper)),
    cull: Cull::Back,
    ..perspective_ewa::METHOD
};

/// The passes' names, where the levels are so kept.
pub fn passes(storage: Storage) -> &'static [&'static str] {
    match storage {
        Storage::Apart => &["project", "fetch", "pull", "push", "shade"],
        Storage::PingPong => &["project", "fetch", "pull", "copy", "push", "shade"],
    }
}

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
    sets: PyramidSets,
    points: Option<PointViews>,
}

impl PerScene for PullPush {
    type Scene = ProjectScene;

    fn scene(
        &self,
        device: &Arc<Device>,
        layout: &SplatLayout,
        variant: &SceneVariant,
    ) -> Result<ProjectScene> {
        self.project.scene(device, layout, variant)
    }
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
            sets: PyramidSets::new(device, layout, targets)?,
            points: self.project.views(device, layout, targets)?,
        })
    }

    /// Records a frame.
    pub fn record(
        &self,
        rec: &mut Recorder<'_>,
        scenes: &[(&ProjectScene, &Splats)],
        views: &PullPushViews,
        targets: &Pyramids,
    ) {
        let PullPushViews { frame, sets, points } = views;
        self.project.record(rec, scenes, frame, sets, points.as_ref(), targets);
        self.pull.record(rec, frame, sets, targets);
        if targets.storage == Storage::PingPong {
            copy(rec, targets);
        }
        self.push.record(rec, frame, sets, targets);
        self.shade.record(rec, scenes.iter().map(|(_, splats)| *splats), frame, sets, targets);
    }
}
