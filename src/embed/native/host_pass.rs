//! Description of the host's render pass for surfels in subpasses.

use crate::embed::attachments::{self, Purpose, is_srgb};
use crate::error::{Error, Result};
use crate::vk::Device;
use ash::vk;

/// Maximum number of the host's subpasses before and after.
const MOST_SUBPASSES: u32 = 1 << 16;

/// The host's render pass: its attachments and subpasses, without multiview (all view masks are 0).
#[derive(Clone, Debug)]
pub struct HostRenderPass<'a> {
    /// All attachments of the host. The engine's attachments follow.
    pub attachments: &'a [vk::AttachmentDescription],
    /// Number of the host's subpasses before and after the engine's.
    pub subpasses: [u32; 2],
    /// The attachment of the picture: premultiplied linear RGB, blended over the contents. Its sample count is that of the host's geometry.
    pub picture: u32,
    /// The single-sample attachment that the engine's last subpass resolves the picture to, if any.
    pub resolve: Option<u32>,
    /// The attachment of unit normals, world space, if any, of a signed format. Written where α ≥ ½.
    pub normal: Option<u32>,
    /// The host's depth. Without depth, the picture covers the contents.
    pub depth: Option<Depth>,
    /// Whether the shader encodes sRGB, for a UNORM format that is displayed as it is. sRGB formats encode in hardware.
    pub encode: bool,
}

/// Depth attachment of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Index of the attachment.
    pub attachment: u32,
    /// Whether depth is reversed: greater is nearer.
    pub reversed: bool,
    /// Whether splats far behind the host's earlier geometry are rejected early, which pays where much is hidden. The depth becomes an
    /// input attachment, too. The picture is the same except for pixels where the host's geometry is between an edge-on disc and the part
    /// that a filter has widened it to: these show the host.
    ///
    /// Nothing is rejected early if the largest radius is not known, as for radii in buffers of the host, with visibility by axis, and with
    /// clip lines where α is coverage.
    pub seed: bool,
}

impl HostRenderPass<'_> {
    /// Validates the description for `device`.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        // More would overflow the subpass indices; no driver supports as many.
        if self.subpasses.iter().any(|count| *count > MOST_SUBPASSES) {
            let [before, after] = self.subpasses;
            return refuse(format!(
                "{before} subpasses before and {after} after: at most {MOST_SUBPASSES} are supported"
            ));
        }
        let depth = self.depth.map(|depth| depth.attachment);
        let wanted = [
            ("the picture", Some(self.picture), Purpose::Blended),
            ("the resolved picture", self.resolve, Purpose::Replaced),
            ("normals", self.normal, Purpose::Normals),
            ("depth", depth, Purpose::Depth),
        ];
        for (i, (what, attachment, purpose)) in wanted.into_iter().enumerate() {
            let Some(attachment) = attachment else { continue };
            if wanted[..i].iter().any(|(_, other, _)| *other == Some(attachment)) {
                return refuse(format!("attachment {attachment} is given twice, also for {what}"));
            }
            self.check_attachment(device, what, attachment, purpose)?;
        }
        if self.encode && is_srgb(self.format(self.picture)) {
            return refuse("its format encodes sRGB itself: leave `encode` out");
        }
        if self.normal.is_some() && !device.capabilities().independent_blend {
            return refuse(
                "normals beside a picture need the feature independentBlend, which the external device does not have: enable it",
            );
        }
        if let Some(depth) = self.depth.filter(|depth| depth.seed)
            && self.subpasses[0] == 0
            && self.attachments[depth.attachment as usize].load_op != vk::AttachmentLoadOp::LOAD
        {
            return refuse(
                "a seed needs depth that is loaded or drawn in a subpass before: leave `seed` out",
            );
        }
        let layout = vk::Format::D32_SFLOAT_S8_UINT;
        let marks = device.format_features(layout).contains(vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT);
        if self.depth.is_some_and(|depth| depth.seed) && !marks {
            return refuse(format!(
                "{} does not support the depth format {layout:?}, whose stencil a seed needs: leave `seed` out",
                device.description().name
            ));
        }
        Ok(())
    }

    fn check_attachment(&self, device: &Device, what: &str, attachment: u32, purpose: Purpose) -> Result<()> {
        let Some(description) = self.attachments.get(attachment as usize) else {
            let count = self.attachments.len();
            return refuse(format!(
                "{what} has attachment index {attachment}, but there are {count} attachments: give an existing one"
            ));
        };
        let format = description.format;
        let one = vk::SampleCountFlags::TYPE_1;
        let resolved = self.resolve == Some(attachment);
        let samples = if resolved { one } else { self.samples() };
        if description.samples != samples {
            return refuse(format!(
                "{what} has {:?} samples in attachment {attachment}, but {samples:?} are needed",
                description.samples
            ));
        }
        let what = format!("{what} in attachment {attachment}");
        attachments::check(device, &what, purpose, format, samples).or_else(refuse)?;
        if resolved && (self.samples() == one || format != self.format(self.picture)) {
            refuse("resolving needs a multisampled picture and the same format")
        } else {
            Ok(())
        }
    }

    pub(super) fn format(&self, attachment: u32) -> vk::Format {
        self.attachments.get(attachment as usize).map_or(vk::Format::UNDEFINED, |found| found.format)
    }

    pub(super) fn samples(&self) -> vk::SampleCountFlags {
        let found = self.attachments.get(self.picture as usize);
        found.map_or(vk::SampleCountFlags::empty(), |found| found.samples)
    }
}

fn refuse(cause: impl std::fmt::Display) -> Result<()> {
    Err(Error::Usage(format!("the host's render pass is not supported: {cause}")))
}
