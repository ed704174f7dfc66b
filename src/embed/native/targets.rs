//! The attachments of one size.

use super::Plan;
use crate::error::Result;
use crate::vk::{Device, HostDepth, Image, ImageUse};
use ash::vk;
use std::sync::Arc;

/// The attachments of one size, and the host's depth beside them.
pub(super) struct Targets {
    pub(super) size: [u32; 2],
    pub(super) host_depth: Option<HostDepth>,
    images: Arc<Images>,
    sums_tell: bool,
}

struct Images {
    visibility: Image,
    sums0: Image,
    sums1: Option<Image>,
}

impl Targets {
    /// What `plan` needs at `size` px.
    pub(super) fn new(
        device: &Arc<Device>,
        plan: &Plan,
        size: [u32; 2],
        host_depth: Option<HostDepth>,
    ) -> Result<Self> {
        let image = |name, format| Image::target(device, name, format, size, ImageUse::Transient);
        let formats = &plan.formats;
        let images = Images {
            visibility: image("visibility", formats.visibility)?,
            sums0: image("sums0", formats.sums0)?,
            sums1: formats.sums1.map(|format| image("sums1", format)).transpose()?,
        };
        Ok(Self { size, host_depth, images: Arc::new(images), sums_tell: plan.kind().sums_tell })
    }

    /// The same beside another depth of the host.
    pub(super) fn beside(&self, host_depth: Option<HostDepth>) -> Self {
        Self { host_depth, images: self.images.clone(), ..*self }
    }

    /// Views in the order of the plan's attachments.
    pub(super) fn views(&self) -> Vec<vk::ImageView> {
        let Images { visibility, sums0, sums1 } = &*self.images;
        [Some(visibility), Some(sums0), sums1.as_ref()].into_iter().flatten().map(Image::view).collect()
    }

    /// What normalize reads: visibility, sums 0, sums 1; what it does not read is stood in for by sums 0.
    pub(super) fn inputs(&self) -> [&Image; 3] {
        let Images { visibility, sums0, sums1 } = &*self.images;
        [if self.sums_tell { sums0 } else { visibility }, sums0, sums1.as_ref().unwrap_or(sums0)]
    }
}
