//! Rasterizer and float width of the sums: the requested ones, or those that the device supports.

use super::pyramids::Pyramids;
use super::renderer::RenderOptions;
use super::targets::{coverage_fits, targets_fit};
use super::variant::Variant;
use crate::error::{Error, Result};
use crate::scene::instance::Placed;
use crate::settings::{Alpha, Settings};
use crate::settings::{Precision, Rasterizer, RasterizerChoice, RasterizerReason};
use crate::vk::Device;

/// Float width of the weighted sums of `rasterizer` on `device`: the raster path blends, which the device may not support for 32-bit
/// floats.
pub(crate) fn width_of_sums(device: &Device, options: &RenderOptions, rasterizer: Rasterizer) -> Precision {
    let blends = rasterizer == Rasterizer::Compute || device.capabilities().blend_float32;
    if blends { options.precision } else { Precision::Half }
}

/// [`width_of_sums`] before the rasterizer of a frame is known.
pub(crate) fn width_of_blended_sums(device: &Device, options: &RenderOptions) -> Precision {
    let rasterizer = rasterizer_for(device, options, Alpha::Mask, Fit::ALL);
    rasterizer.map_or(options.precision, |(rasterizer, _)| width_of_sums(device, options, rasterizer))
}

/// Parts of a frame on the compute path that fit storage buffers of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fit {
    /// Splats of all scenes.
    pub splats: bool,
    /// Targets between passes, if the frame has any: 4 or 16 bytes a pixel.
    pub targets: bool,
}

impl Fit {
    /// Everything fits.
    pub const ALL: Self = Self { splats: true, targets: true };

    /// Whether the targets of `variant` fit at this size, if it is drawn on the compute path.
    pub fn new(device: &Device, size: [u32; 2], splats: bool, variant: &Variant) -> Self {
        Self { splats, targets: targets_fit(device.capabilities(), size, variant) }
    }
}

/// Rasterizer of a frame, and the reason for it.
pub(crate) fn rasterizer_of(
    device: &Device,
    options: &RenderOptions,
    settings: &Settings,
    scenes: &[Placed<'_>],
    fit: Fit,
) -> Result<(Rasterizer, RasterizerReason)> {
    match settings.pull_push {
        Some(_) => rasterizer_of_points(device, options, scenes),
        None => rasterizer_for(device, options, settings.drawn_alpha(), fit),
    }
}

/// Rasterizer of pull–push's surfels: the compute path, if `device` supports it. Lines and triangles take the compute path.
///
/// Atomic minima are faster on all measured devices: see the guide, Cost, and Schütz, Kerbl, Wimmer, *Rendering Point Clouds with Compute
/// Shaders and Vertex Order Optimization*, 2021.
fn rasterizer_of_points(
    device: &Device,
    options: &RenderOptions,
    scenes: &[Placed<'_>],
) -> Result<(Rasterizer, RasterizerReason)> {
    let (capabilities, name) = (device.capabilities(), &device.description().name);
    let refuse = |what, remedy| {
        Err(Error::Usage(format!(
            "pull-push needs 64-bit atomics in buffers for {what}, which {name} does not have: {remedy}"
        )))
    };
    let primitives = scenes.iter().any(|placed| placed.scene.primitives.is_some());
    let required = options.rasterizer;
    let rasterized = required == RasterizerChoice::Require(Rasterizer::Draw) && !primitives;
    match required {
        _ if !Pyramids::fit(capabilities, options.size, rasterized) => {
            Err(too_large(device, options, rasterized))
        }
        _ if primitives && !capabilities.int64_atomics => {
            refuse("lines and triangles", "leave them out, or choose another device")
        }
        RasterizerChoice::Require(Rasterizer::Compute) if !capabilities.int64_atomics => {
            refuse("points on the compute path", "choose the draw rasterizer, or none")
        }
        // Without surfels there are no points to rasterize.
        _ if scenes.iter().all(|placed| placed.scene.capacity() == 0) => {
            Ok((Rasterizer::Compute, RasterizerReason::OnlySupported))
        }
        RasterizerChoice::Require(rasterizer) => Ok((rasterizer, RasterizerReason::Required)),
        _ if capabilities.int64_atomics => Ok((Rasterizer::Compute, RasterizerReason::Default)),
        _ => Ok((Rasterizer::Draw, RasterizerReason::OnlySupported)),
    }
}

/// Error: the pyramids do not fit the device; names a size that does.
fn too_large(device: &Device, options: &RenderOptions, rasterized: bool) -> Error {
    let capabilities = device.capabilities();
    let ([width, height], [most_width, most_height]) =
        (options.size, Pyramids::largest(capabilities, options, rasterized));
    Error::Usage(format!(
        "the pyramids of a picture of {width}x{height} px do not fit the images of {} (at most {} px wide and high), or its nearest points \
         the {} bytes of a storage buffer: choose at most {most_width}x{most_height} px",
        device.description().name,
        capabilities.max_image_side,
        capabilities.max_storage_buffer_range,
    ))
}

/// Rasterizer of splats with these options, and the reason for it.
pub(crate) fn rasterizer_for(
    device: &Device,
    options: &RenderOptions,
    alpha: Alpha,
    fit: Fit,
) -> Result<(Rasterizer, RasterizerReason)> {
    let capabilities = device.capabilities();
    let can_compute = options.precision == Precision::Full && fit == Fit::ALL;
    let covers = capabilities.fragment_writes && coverage_fits(capabilities, options.size);
    let can_draw = (alpha == Alpha::Mask || covers) && options.most_splats.is_none();
    // Sums of 16 bits are no equal.
    let draws_alike = can_draw && (capabilities.blend_float32 || options.precision == Precision::Half);
    match options.rasterizer {
        RasterizerChoice::Require(Rasterizer::Compute) if !can_compute => Err(no_compute_path(device, fit)),
        RasterizerChoice::Require(Rasterizer::Draw) if !can_draw => Err(no_raster_path(device, options)),
        RasterizerChoice::Require(rasterizer) => Ok((rasterizer, RasterizerReason::Required)),
        RasterizerChoice::Prefer(rasterizer) if can_compute && draws_alike => {
            Ok((rasterizer, RasterizerReason::Faster))
        }
        _ if can_compute && draws_alike => Ok((Rasterizer::Compute, RasterizerReason::Default)),
        _ if can_compute => Ok((Rasterizer::Compute, RasterizerReason::OnlySupported)),
        _ if can_draw => Ok((Rasterizer::Draw, RasterizerReason::OnlySupported)),
        _ => Err(no_path(device, options)),
    }
}

/// Error: the compute path is required, and does not support the frame.
fn no_compute_path(device: &Device, fit: Fit) -> Error {
    let (capabilities, name) = (device.capabilities(), &device.description().name);
    let most = capabilities.max_storage_buffer_range;
    let cause = match (fit.targets, fit.splats) {
        (false, _) => {
            format!(
                "what its passes leave for each pixel within the {most} bytes of a buffer that shaders of {name} see"
            )
        }
        (_, false) => format!(
            "the splats of all scenes within a buffer that shaders of {name} see: {most} bytes, or {} texels",
            capabilities.max_texels
        ),
        (true, true) => "full precision, and half is requested".into(),
    };
    Error::Usage(format!("the compute rasterizer needs {cause}: choose the draw rasterizer"))
}

/// Error: the raster path is required, and does not support the frame.
fn no_raster_path(device: &Device, options: &RenderOptions) -> Error {
    if options.most_splats.is_some() {
        return Error::Usage(
            "the draw rasterizer has no bound on the splats of a tile (most_splats): leave the bound out, or choose the compute rasterizer"
                .into(),
        );
    }
    Error::Usage(format!(
        "coverage by the draw rasterizer needs buffers that fragment shaders write to (fragmentStoresAndAtomics), and 4 bytes a pixel within \
         {}, which {} does not have at this size: choose the compute rasterizer, or a mask as α",
        device.capabilities().max_storage_buffer_range,
        device.description().name
    ))
}

/// Error: no rasterizer supports the frame.
fn no_path(device: &Device, options: &RenderOptions) -> Error {
    if options.most_splats.is_none() {
        return no_raster_path(device, options);
    }
    Error::Usage(format!(
        "only the compute rasterizer bounds the splats of a tile (most_splats), and {} cannot run it for this frame: leave the bound out, or \
         render fewer surfels or pixels at once",
        device.description().name
    ))
}
