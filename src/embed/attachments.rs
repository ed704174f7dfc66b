//! Validation of a host's attachments.

use crate::error::Cause;
use crate::vk::Device;
use ash::vk;

/// Use of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Blended colours.
    Blended,
    /// Colours without blending.
    Replaced,
    /// Normals without blending.
    Normals,
    /// Point ids without blending.
    Ids,
    /// Colours of the host only.
    Other,
    /// Depth.
    Depth,
    /// Depth that shaders read after it is drawn.
    SampledDepth,
    /// Stencil.
    Stencil,
}

/// Returns an error if `device` cannot draw `what` to attachments of this format and sample count, or not sample depth.
pub(super) fn check(
    device: &Device,
    what: &str,
    purpose: Purpose,
    format: vk::Format,
    samples: vk::SampleCountFlags,
) -> Result<(), Cause> {
    use vk::FormatFeatureFlags as Can;
    let name = &device.description().name;
    let (needed, usage) = match purpose {
        Purpose::Blended => {
            (Can::COLOR_ATTACHMENT | Can::COLOR_ATTACHMENT_BLEND, vk::ImageUsageFlags::COLOR_ATTACHMENT)
        }
        Purpose::Replaced | Purpose::Normals | Purpose::Ids | Purpose::Other => {
            (Can::COLOR_ATTACHMENT, vk::ImageUsageFlags::COLOR_ATTACHMENT)
        }
        Purpose::Depth | Purpose::Stencil => {
            (Can::DEPTH_STENCIL_ATTACHMENT, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT)
        }
        Purpose::SampledDepth => (
            Can::DEPTH_STENCIL_ATTACHMENT | Can::SAMPLED_IMAGE,
            vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        ),
    };
    let fits = match purpose {
        Purpose::Blended | Purpose::Replaced => !is_integer(format),
        Purpose::Normals => is_signed(format),
        Purpose::Ids => format == vk::Format::R32_UINT,
        Purpose::Other => true,
        Purpose::Depth | Purpose::SampledDepth => has_depth(format),
        Purpose::Stencil => has_stencil(format),
    };
    if !fits && purpose == Purpose::Ids {
        return Err(format!("{what} need R32_UINT, but the format is {format:?}").into());
    }
    if !fits && purpose == Purpose::Normals {
        return Err(format!(
            "{what} have negative components, which {format:?} cannot store: give a signed format, such as R16G16B16A16_SFLOAT or \
             R8G8B8A8_SNORM"
        )
        .into());
    }
    if !fits || !device.format_features(format).contains(needed) {
        return Err(match purpose {
            Purpose::SampledDepth => format!("{name} cannot sample {what} of {format:?}"),
            _ => format!("{name} cannot draw {what} to {format:?}"),
        }
        .into());
    }
    if samples.as_raw().count_ones() != 1 {
        return Err(format!(
            "{what} has {} samples per pixel: give one sample count",
            sample_counts(samples)
        )
        .into());
    }
    let there = device.attachment_samples(format, usage);
    if !there.contains(samples) {
        return Err(format!(
            "{what} has {} samples per pixel, but {name} supports {format:?} with {}",
            sample_counts(samples),
            sample_counts(there)
        )
        .into());
    }
    Ok(())
}

/// Step between adjacent depths of `format`, beyond float rounding.
pub(super) fn depth_step(format: vk::Format) -> f64 {
    match format {
        vk::Format::D16_UNORM | vk::Format::D16_UNORM_S8_UINT => 1.0 / 65535.0,
        vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => 1.0 / 16_777_215.0,
        _ => 0.0,
    }
}

/// Sample counts as text.
fn sample_counts(samples: vk::SampleCountFlags) -> String {
    let there = (0..32).map(|bit| 1 << bit).filter(|bit| samples.as_raw() & bit != 0);
    let list: Vec<_> = there.map(|bit| bit.to_string()).collect();
    if list.is_empty() { "no".into() } else { list.join(", ") }
}

pub(super) fn is_integer(format: vk::Format) -> bool {
    ["UINT", "SINT"].iter().any(|kind| format!("{format:?}").contains(kind))
}

fn is_signed(format: vk::Format) -> bool {
    ["SNORM", "SFLOAT"].iter().any(|kind| format!("{format:?}").contains(kind))
}

pub(super) fn is_srgb(format: vk::Format) -> bool {
    format!("{format:?}").contains("SRGB")
}

fn has_depth(format: vk::Format) -> bool {
    let name = format!("{format:?}");
    ["D16_", "D24_", "D32_", "X8_D24"].iter().any(|kind| name.starts_with(kind))
}

fn has_stencil(format: vk::Format) -> bool {
    format!("{format:?}").contains("S8_UINT")
}

#[cfg(test)]
mod tests {
    use super::*;
    use vk::{Format, SampleCountFlags as Samples};

    #[test]
    fn formats_have_the_aspects_of_their_names() {
        let depths =
            [Format::D16_UNORM, Format::X8_D24_UNORM_PACK32, Format::D32_SFLOAT, Format::D16_UNORM_S8_UINT];
        assert!(
            depths.into_iter().all(has_depth)
                && !has_depth(Format::S8_UINT)
                && !has_depth(Format::R32_SFLOAT)
        );
        let stencils = [Format::S8_UINT, Format::D24_UNORM_S8_UINT, Format::D32_SFLOAT_S8_UINT];
        assert!(stencils.into_iter().all(has_stencil) && !has_stencil(Format::D32_SFLOAT));
    }

    #[test]
    fn samples_are_numbers() {
        assert_eq!(sample_counts(Samples::empty()), "no");
        assert_eq!(sample_counts(Samples::TYPE_1 | Samples::TYPE_4 | Samples::TYPE_64), "1, 4, 64");
    }
}
