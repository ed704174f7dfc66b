//! Description of the host's pass in which the picture is drawn.

use super::attachments::{self, Purpose, is_srgb};
use super::composite::{Composite, CompositeKind};
use crate::error::{Cause, Error, Result};
use crate::vk::{Blend, Device, Within};
use ash::vk;
use std::sync::Arc;

/// Maximum number of colour targets of a composite; every device supports as many.
const MOST: usize = 4;

/// The host's pass in which the picture is drawn, without multiview: its view mask is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// A subpass of a render pass, or of any compatible render pass.
    Subpass {
        /// The render pass.
        pass: vk::RenderPass,
        /// Index of the subpass.
        subpass: u32,
    },
    /// Dynamic rendering, which the device has enabled.
    Rendering,
}

/// The host's attachments for the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The pass.
    pub pass: Pass,
    /// Formats of the pass's colour attachments by location; `UNDEFINED` for an unused location.
    pub colours: Vec<vk::Format>,
    /// Format of the depth attachment. Without depth, the picture covers the contents.
    pub depth: Option<vk::Format>,
    /// Format of the stencil attachment, for dynamic rendering; `UNDEFINED` without stencil.
    pub stencil: vk::Format,
    /// Whether depth is reversed: greater is nearer.
    pub reversed: bool,
    /// Whether depth is written where α ≥ ½. If not, it is only tested, and the attachment may be in a read-only layout.
    pub write_depth: bool,
    /// Sample count. All samples of a pixel get its picture, except those that the host's geometry hides.
    pub samples: vk::SampleCountFlags,
    /// Location of the picture, below 4: premultiplied linear RGB, blended over the contents.
    pub picture: u32,
    /// Location of unit normals, world space, if any, below 4, of a signed format. Written where α ≥ ½.
    pub normal: Option<u32>,
    /// Location of point ids as of [`Picture::id`](crate::Picture::id), of format `R32_UINT`, if any, below 4. Pixels of α < ½, or
    /// with the host's surface in front, keep their contents: clear it to [`Picture::NOBODY`](crate::Picture::NOBODY). Methods without point ids
    /// are then rejected.
    pub id: Option<u32>,
    /// Whether the shader encodes sRGB, for a UNORM format that is displayed as it is. sRGB formats encode in hardware.
    pub encode: bool,
}

impl Target {
    /// Validates the target for `device`.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        let refuse = |cause: Cause| Err(Error::Usage(format!("the host's target is not supported: {cause}")));
        self.check_pass(device).or_else(refuse)?;
        self.check_locations(device).or_else(refuse)?;
        if self.encode && is_srgb(self.colours[self.picture as usize]) {
            return refuse("its format encodes sRGB itself: leave `encode` out".into());
        }
        if self.colours.len() > 1 && !device.capabilities().independent_blend {
            return refuse(
                "several colour attachments need the feature independentBlend, which the external device does not have: enable it".into(),
            );
        }
        self.check_depth(device).or_else(refuse)
    }

    fn check_pass(&self, device: &Device) -> Result<(), Cause> {
        match self.pass {
            Pass::Subpass { pass, .. } if pass == vk::RenderPass::null() => Err("there is no render pass".into()),
            Pass::Rendering if !device.capabilities().dynamic_rendering => Err(
                "dynamic rendering needs the feature dynamicRendering, which the external device does not have: enable it and set `dynamic_rendering`, or use a \
                 render pass"
                    .into(),
            ),
            _ => Ok(()),
        }
    }

    fn check_locations(&self, device: &Device) -> Result<(), Cause> {
        let most = device.capabilities().max_colour_attachments;
        if self.colours.len() > most as usize {
            let (name, count) = (&device.description().name, self.colours.len());
            return Err(format!("{count} colour attachments, but {name} supports at most {most}").into());
        }
        let wanted = [
            ("the picture", Some(self.picture), Purpose::Blended),
            ("normals", self.normal, Purpose::Normals),
            ("point ids", self.id, Purpose::Ids),
        ];
        for [a, b] in [[0, 1], [0, 2], [1, 2]] {
            let ((one, location, ..), (other, same, ..)) = (wanted[a], wanted[b]);
            if let Some(location) = location.filter(|location| same == Some(*location)) {
                return Err(format!("location {location} is given for both {one} and {other}").into());
            }
        }
        for (what, location, _) in wanted {
            let Some(location) = location.map(|location| location as usize) else { continue };
            if location >= self.colours.len().min(MOST) {
                let count = self.colours.len();
                return Err(format!(
                    "the location of {what} is {location} of {count} colour attachments: give an existing one below {MOST}"
                )
                .into());
            }
        }
        for (location, &format) in (0..).zip(&self.colours) {
            let ours = wanted.iter().find(|(_, wanted, _)| *wanted == Some(location));
            let (what, purpose) =
                ours.map_or(("an attachment", Purpose::Other), |(what, _, purpose)| (what, *purpose));
            if ours.is_some() || format != vk::Format::UNDEFINED {
                attachments::check(
                    device,
                    &format!("{what} at location {location}"),
                    purpose,
                    format,
                    self.samples,
                )?;
            }
        }
        Ok(())
    }

    fn check_depth(&self, device: &Device) -> Result<(), Cause> {
        if let Some(depth) = self.depth {
            attachments::check(device, "depth", Purpose::Depth, depth, self.samples)?;
        }
        if self.stencil == vk::Format::UNDEFINED {
            return Ok(());
        }
        attachments::check(device, "the stencil", Purpose::Stencil, self.stencil, self.samples)?;
        match self.depth {
            Some(depth) if depth != self.stencil => Err(format!(
                "depth is {depth:?} and the stencil {:?}: both are one attachment, so give one format",
                self.stencil
            )
            .into()),
            _ => Ok(()),
        }
    }

    /// Creates the composite pass for pictures of this kind.
    ///
    /// # Safety
    /// The target describes the pass correctly.
    pub(super) unsafe fn composite(&self, device: &Arc<Device>, kind: CompositeKind) -> Result<Composite> {
        // SAFETY: by the caller.
        let within = unsafe { self.within(Blend::Over) };
        Composite::new(device, kind, &within)
    }

    /// The pass, with this blending of the picture; normals and ids are replaced, and other colours masked.
    ///
    /// # Safety
    /// The target describes the pass correctly.
    pub(super) unsafe fn within(&self, picture: Blend) -> Within {
        let blend = |location: usize| match location as u32 {
            location if location == self.picture => Some(picture),
            location if [self.normal, self.id].contains(&Some(location)) => Some(Blend::Replace),
            _ => None,
        };
        let colours: Vec<_> = (0..self.colours.len()).map(blend).collect();
        let formats = (&self.colours[..], self.depth.unwrap_or(vk::Format::UNDEFINED), self.stencil);
        // SAFETY: by the caller.
        unsafe {
            match self.pass {
                Pass::Subpass { pass, subpass } => Within::subpass((pass, subpass), &colours, self.samples),
                Pass::Rendering => Within::rendering(formats, &colours, self.samples),
            }
        }
    }
}
