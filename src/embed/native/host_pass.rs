//! Where in a host's render pass surfels are drawn.

use crate::embed::attachments::{self, Purpose, is_srgb};
use crate::error::{Error, Result};
use crate::vk::Device;
use ash::vk;

/// Most subpasses of a host before and after.
const MOST_SUBPASSES: u32 = 1 << 16;

/// Where in a render pass surfels are drawn.
#[derive(Clone, Debug)]
pub struct HostRenderPass<'a> {
    /// The host's attachments, all of them: surfel's follow.
    pub attachments: &'a [vk::AttachmentDescription],
    /// How many subpasses of the host come before surfel's, and how many after.
    pub subpasses: [u32; 2],
    /// The attachment that gets the picture: linear RGB times α over what is there. Its samples are those of the host's surfaces.
    pub picture: u32,
    /// The attachment of one sample that the picture is resolved to, if surfel's last subpass is to do that.
    pub resolve: Option<u32>,
    /// The attachment that gets unit normals, world space, if any.
    pub normal: Option<u32>,
    /// The host's depth. Without, the picture covers what is there.
    pub depth: Option<Depth>,
    /// Whether the shader has to encode colours as sRGB, as where the format is UNORM and shown as it is. Formats of sRGB do it themselves.
    pub encode: bool,
}

/// A host's depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Its attachment.
    pub attachment: u32,
    /// Whether it falls with distance, and greater is nearer.
    pub reversed: bool,
    /// Whether splats far behind what the host has drawn before are left out as early as can be: worth it where much is hidden. The depth is then
    /// an input attachment, too. The picture stays the same, but for pixels where a surface of the host is between a disc, seen edge-on, and what
    /// a filter has widened it to: they show the host.
    ///
    /// Where the largest radius is not known, as of radii in buffers of a host, with visibility by axis, and with clip lines where α is coverage,
    /// nothing is left out early.
    pub seed: bool,
}

impl HostRenderPass<'_> {
    /// Refuses what cannot be drawn to on `device`.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        // More would overflow the numbers of subpasses; no driver takes as many.
        if self.subpasses.iter().any(|count| *count > MOST_SUBPASSES) {
            let [before, after] = self.subpasses;
            return refuse(format!(
                "{before} subpasses before and {after} after: at most {MOST_SUBPASSES} are known"
            ));
        }
        let depth = self.depth.map(|depth| depth.attachment);
        let wanted = [
            ("the picture", Some(self.picture), Purpose::Blended),
            ("the resolved picture", self.resolve, Purpose::Replaced),
            ("normals", self.normal, Purpose::Replaced),
            ("depth", depth, Purpose::Depth),
        ];
        for (i, (what, attachment, purpose)) in wanted.into_iter().enumerate() {
            let Some(attachment) = attachment else { continue };
            if wanted[..i].iter().any(|(_, other, _)| *other == Some(attachment)) {
                return refuse(format!("attachment {attachment} is given twice, for {what}, too"));
            }
            self.check_attachment(device, what, attachment, purpose)?;
        }
        if self.encode && is_srgb(self.format(self.picture)) {
            return refuse("its format encodes sRGB itself: leave `encode` out");
        }
        if self.normal.is_some() && !device.capabilities().independent_blend {
            return refuse(
                "normals beside a picture want the feature independentBlend, without which the device was lent: enable it",
            );
        }
        if let Some(depth) = self.depth.filter(|depth| depth.seed)
            && self.subpasses[0] == 0
            && self.attachments[depth.attachment as usize].load_op != vk::AttachmentLoadOp::LOAD
        {
            return refuse(
                "splats are to start from a depth that nothing has been drawn to: leave `seed` out",
            );
        }
        let layout = vk::Format::D32_SFLOAT_S8_UINT;
        let marks = device.format_features(layout).contains(vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT);
        if self.depth.is_some_and(|depth| depth.seed) && !marks {
            return refuse(format!(
                "{} has no depth attachments of {layout:?}, in which what is seeded is told apart: leave `seed` out",
                device.description().name
            ));
        }
        Ok(())
    }

    fn check_attachment(&self, device: &Device, what: &str, attachment: u32, purpose: Purpose) -> Result<()> {
        let Some(description) = self.attachments.get(attachment as usize) else {
            let count = self.attachments.len();
            return refuse(format!(
                "{what} wants attachment {attachment} of {count}: give one that there is"
            ));
        };
        let format = description.format;
        let one = vk::SampleCountFlags::TYPE_1;
        let resolved = self.resolve == Some(attachment);
        let samples = if resolved { one } else { self.samples() };
        if description.samples != samples {
            return refuse(format!(
                "{what} has {:?} samples in attachment {attachment}, where {samples:?} are wanted",
                description.samples
            ));
        }
        let what = format!("{what} in attachment {attachment}");
        attachments::check(device, &what, purpose, format, samples).or_else(refuse)?;
        if resolved && (self.samples() == one || format != self.format(self.picture)) {
            refuse("only a multisampled picture is resolved, to the same format")
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
    Err(Error::Usage(format!("the host's render pass cannot be drawn in: {cause}")))
}
