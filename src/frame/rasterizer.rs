//! What visits the pixels of a frame, and how wide its sums are: what is asked for, or what is faster, as far as the device can do it.

use super::pyramids::Pyramids;
use super::renderer::RenderOptions;
use super::targets::{coverage_fits, stage_targets_fit};
use crate::error::{Error, Result};
use crate::scene::instance::Placed;
use crate::settings::{Alpha, Settings};
use crate::settings::{Precision, Rasterizer};
use crate::vk::{Device, DeviceDescription};

/// Width of the weighted sums that `rasterizer` keeps on `device`: drawing them blends, which the device may not do in 32 bits.
pub(crate) fn width_of_sums(device: &Device, options: &RenderOptions, rasterizer: Rasterizer) -> Precision {
    let blends = rasterizer == Rasterizer::Compute || device.capabilities().blend_float32;
    if blends { options.precision } else { Precision::Half }
}

/// [`width_of_sums`] where it is not known yet what is rendered.
pub(crate) fn width_of_blended_sums(device: &Device, options: &RenderOptions) -> Precision {
    let rasterizer = rasterizer_for(device, options, Alpha::Mask, Fit::ALL);
    rasterizer.map_or(options.precision, |rasterizer| width_of_sums(device, options, rasterizer))
}

/// What of a frame by the compute path fits the buffers that shaders of the device can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fit {
    /// The splats of all scenes.
    pub splats: bool,
    /// The targets between passes, if the frame has such.
    pub targets: bool,
}

impl Fit {
    /// Everything fits.
    pub const ALL: Self = Self { splats: true, targets: true };

    /// Of a frame of these options, whose stages are passes of their own if it is `crowded`.
    pub fn new(device: &Device, options: &RenderOptions, splats: bool, crowded: bool) -> Self {
        let has_targets = options.split || crowded;
        Self { splats, targets: !has_targets || stage_targets_fit(device.capabilities(), options.size) }
    }
}

/// The rasterizer of a frame with these settings: the requested one, or the faster one on `device`.
pub(crate) fn rasterizer_of(
    device: &Device,
    options: &RenderOptions,
    settings: &Settings,
    scenes: &[Placed<'_>],
    fit: Fit,
) -> Result<Rasterizer> {
    match settings.pull_push {
        Some(_) => rasterizer_of_points(device, options, scenes),
        None => rasterizer_for(device, options, settings.alpha, fit),
    }
}

/// The faster of what `device` can do with the surfels of `scenes` by pull–push; lines and triangles are computed.
///
/// Atomic minima are faster wherever they were measured: see the guide, Cost, and Schütz, Kerbl, Wimmer, *Rendering Point Clouds with Compute
/// Shaders and Vertex Order Optimization*, 2021.
fn rasterizer_of_points(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
) -> Result<Rasterizer> {
    let (capabilities, name) = (device.capabilities(), &device.description().name);
    let refuse = |what, remedy| {
        Err(Error::Usage(format!(
            "pull-push needs 64-bit atomics in buffers for {what}, which {name} does not have: {remedy}"
        )))
    };
    match options.rasterizer {
        _ if !Pyramids::fit(capabilities, options) => Err(too_large(device, options)),
        _ if scenes.iter().any(|placed| placed.scene.primitives.is_some()) && !capabilities.int64_atomics => {
            refuse("lines and triangles", "leave them out, or choose another device")
        }
        Some(Rasterizer::Compute) if !capabilities.int64_atomics => {
            refuse("computed points", "choose the draw rasterizer, or leave it open")
        }
        // Without surfels there is nothing to draw.
        _ if scenes.iter().all(|placed| placed.scene.capacity() == 0) => Ok(Rasterizer::Compute),
        Some(rasterizer) => Ok(rasterizer),
        None if capabilities.int64_atomics => Ok(Rasterizer::Compute),
        None => Ok(Rasterizer::Draw),
    }
}

/// That pyramids do not fit the device, and what would.
fn too_large(device: &Device, options: &RenderOptions) -> Error {
    let capabilities = device.capabilities();
    let half = RenderOptions { precision: Precision::Half, ..*options };
    let halved = match Pyramids::fit(capabilities, &half) {
        true => "half precision, or ",
        false => "",
    };
    let ([width, height], [most_width, most_height]) =
        (options.size, Pyramids::largest(capabilities, options));
    Error::Usage(format!(
        "pyramids of {width}x{height} px do not fit the {} bytes of a buffer that shaders of {} can see (maxStorageBufferRange): \
         choose {halved}at most {most_width}x{most_height} px",
        capabilities.max_storage_buffer_range,
        device.description().name
    ))
}

/// The faster of what `device` can do with these options.
pub(crate) fn rasterizer_for(
    device: &Device,
    options: &RenderOptions,
    alpha: Alpha,
    fit: Fit,
) -> Result<Rasterizer> {
    let capabilities = device.capabilities();
    let can_compute = options.precision == Precision::Full && fit == Fit::ALL;
    let covers = capabilities.fragment_writes && coverage_fits(capabilities, options.size);
    let can_draw = alpha == Alpha::Mask || covers;
    match options.rasterizer {
        Some(Rasterizer::Compute) if !can_compute => {
            let (name, most) = (&device.description().name, capabilities.max_storage_buffer_range);
            let cause = match (fit.targets, fit.splats) {
                (false, _) => {
                    format!(
                        "weighted sums within the {most} bytes of a buffer that shaders of {name} see, as its stages are passes of their own"
                    )
                }
                (_, false) => format!(
                    "the splats of all scenes within a buffer that shaders of {name} see: {most} bytes, or {} texels",
                    capabilities.max_texels
                ),
                (true, true) => "32-bit sums, and half precision is wanted".into(),
            };
            Err(Error::Usage(format!("the compute rasterizer needs {cause}: choose the draw rasterizer")))
        }
        Some(Rasterizer::Draw) | None if !can_draw && (options.rasterizer.is_some() || !can_compute) => {
            Err(Error::Usage(format!(
                "coverage by the draw rasterizer needs buffers that fragment shaders write to (fragmentStoresAndAtomics), and 4 bytes a \
                 pixel within {}, which {} does not have at this size: choose the compute rasterizer, or a mask as α",
                capabilities.max_storage_buffer_range,
                device.description().name
            )))
        }
        Some(rasterizer) => Ok(rasterizer),
        // Measured on CPU devices only; a GPU's own rasterizer is taken until a measurement says otherwise, if it keeps 32 bits.
        None if can_compute
            && (!can_draw
                || device.description().kind == DeviceDescription::CPU
                || !capabilities.blend_float32) =>
        {
            Ok(Rasterizer::Compute)
        }
        None => Ok(Rasterizer::Draw),
    }
}
