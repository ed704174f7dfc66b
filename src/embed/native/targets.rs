//! The engine's attachments of one size.

use super::Plan;
use crate::error::Result;
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Device, HostDepth, Image, ImageUse};
use ash::vk;
use std::sync::Arc;

/// The engine's attachments of one size, with the host's depth.
pub(super) struct Targets {
    pub(super) size: [u32; 2],
    pub(super) host_depth: Option<HostDepth>,
    images: Arc<Images>,
}

struct Images {
    visibility: Image,
    sums0: Image,
    sums1: Option<Image>,
}

impl Targets {
    /// Creates the attachments of `plan` at `size` px.
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
        Ok(Self { size, host_depth, images: Arc::new(images) })
    }

    /// The same attachments with another depth of the host.
    pub(super) fn beside(&self, host_depth: Option<HostDepth>) -> Self {
        Self { host_depth, images: self.images.clone(), ..*self }
    }

    /// Views in the order of the plan's attachments.
    pub(super) fn views(&self) -> Vec<vk::ImageView> {
        let Images { visibility, sums0, sums1 } = &*self.images;
        [Some(visibility), Some(sums0), sums1.as_ref()].into_iter().flatten().map(Image::view).collect()
    }

    /// Descriptor bindings of these attachments and the host's depth.
    pub(super) fn bindings(
        &self,
        seen: &[&'static shaders::Resource],
    ) -> Vec<(&'static shaders::Resource, Binding<'_>)> {
        let Images { visibility, sums0, sums1 } = &*self.images;
        let all = [
            (&resource::VISIBILITY_INPUT, Some(Binding::Input(visibility))),
            (&resource::SUMS0_INPUT, Some(Binding::Input(sums0))),
            (&resource::SUMS1_INPUT, sums1.as_ref().map(Binding::Input)),
            (&resource::HOST_DEPTH, self.host_depth.map(Binding::HostDepth)),
        ];
        let wanted = all.into_iter().filter(|(resource, _)| seen.contains(resource));
        wanted.filter_map(|(resource, binding)| Some((resource, binding?))).collect()
    }
}
