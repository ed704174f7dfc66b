//! Render targets: name, format, binding, and the frames that have them.

use super::pass::{DrawTargets, InitialContents, Pass};
use super::pyramids::{NEAREST_POINT, Pyramids};
use super::resource::Resource;
use super::tile_list;
use super::variant::Variant;
use crate::error::{Error, Result};
use crate::settings::splatting::Visibility;
use crate::settings::{Outputs, Precision, Rasterizer};
use crate::vk::shaders::{self, resource};
use crate::vk::{
    Access, Attachment, Binding, Buffer, Capabilities, DescriptorSet, Device, Encoder, Image, ImageUse, Use,
    pixel_bytes,
};
use ash::vk::Format;
use std::sync::Arc;

/// Side of a tile, px: TILE of `lib/tile_size.glsl`.
pub const TILE: u32 = 8;

/// Description of a target.
#[derive(Clone, Copy, Debug)]
pub struct TargetDescription {
    pub resource: Resource,
    /// Format of a pixel.
    pub format: Format,
    pub kind: Kind,
    /// Resource that shaders declare, if any.
    pub shader: Option<&'static shaders::Resource>,
}

/// Storage of a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// An image.
    Image(ImageUse),
    /// A buffer of so many bytes per pixel, row by row from the top left.
    Pixels(u64),
    /// A list of tiles.
    Tiles,
}

/// The targets of a frame.
pub struct RenderTargets {
    list: Vec<(TargetDescription, Memory)>,
    /// Pyramids of pull–push.
    pub pyramids: Option<Pyramids>,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Outputs of the picture.
    pub outputs: Outputs,
}

enum Memory {
    Image(Image),
    Buffer(Buffer),
}

/// Name, format and memory of a target, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TargetInfo {
    /// Its name.
    pub name: &'static str,
    /// Its format; for buffers, that of a pixel.
    pub format: Format,
    /// Memory, bytes.
    pub bytes: u64,
}

/// Bindings of a host's attachments.
pub type HostBindings<'a> = &'a [(&'static shaders::Resource, Binding<'a>)];

/// Bytes per pixel of targets by name; fractions for values shared by several pixels.
pub type PerPixel = Vec<(&'static str, f64)>;

impl Resource {
    /// Whether shaders declare it as `shader`.
    pub fn is_bound_as(self, shader: &shaders::Resource) -> bool {
        let known: &[&shaders::Resource] = match self {
            Self::Splats => &[
                &resource::SPLATS,
                &resource::SPLAT_LAYOUT,
                &resource::FRAME_SPLATS,
                &resource::SPLAT_TEXELS,
            ],
            Self::Order => &[&resource::ORDER],
            Self::VisibleClusters => &[&resource::VISIBLE_CLUSTERS],
            Self::Boxes => &[&resource::SPLAT_BOXES, &resource::BOXES, &resource::BOX_TEXELS],
            Self::Attributes => {
                &[&resource::SPLAT_ATTRIBUTES, &resource::FRAME_ATTRIBUTES, &resource::ATTRIBUTE_TEXELS]
            }
            Self::ScreenClips => &[&resource::SCREEN_CLIPS, &resource::FRAME_CLIPS, &resource::CLIP_TEXELS],
            Self::Counts => &[&resource::COUNTS],
            Self::LargeTriangles => &[&resource::LARGE_TRIANGLES],
            Self::Visibility => {
                &[&resource::VISIBILITY, &resource::VISIBILITY_IMAGE, &resource::VISIBILITY_INPUT]
            }
            Self::Sums0 => &[&resource::SUMS0, &resource::SUMS0_IMAGE, &resource::SUMS0_INPUT],
            Self::Sums1 => &[&resource::SUMS1, &resource::SUMS1_IMAGE, &resource::SUMS1_INPUT],
            Self::OpenTiles => &[&resource::OPEN_TILES],
            Self::EdgeTiles => &[&resource::EDGE_TILES],
            Self::Coverage => &[&resource::COVERAGE],
            Self::Behind => &[&resource::BEHIND_IMAGE],
            Self::Nearest => &[&resource::NEAREST],
            Self::NearestDepth => &[&resource::NEAREST_DEPTH],
            Self::NearestId => &[&resource::NEAREST_ID],
            Self::Pulled => &[&resource::TO_IMAGE0],
            Self::Pushed => &[&resource::FINAL_QUAD0],
            Self::HostDepth => &[&resource::HOST_DEPTH],
            Self::IncompleteFrame => &[&resource::INCOMPLETE_FRAME],
            Self::Image => &[&resource::IMAGE_OUTPUT],
            Self::Filtered => &[&resource::FILTERED],
            Self::Normal => &[&resource::NORMAL_OUTPUT],
            Self::Depth => &[&resource::DEPTH_OUTPUT],
            Self::Id => &[&resource::ID_OUTPUT],
        };
        known.contains(&shader)
    }
}

/// Targets of a frame of this variant, without the pyramids of pull–push.
pub fn describe(variant: &Variant) -> Vec<TargetDescription> {
    let list = match (variant.pull_push, variant.rasterizer) {
        (Some(_), _) => pull_push_targets(variant),
        (None, Rasterizer::Draw) => raster_targets(variant),
        (None, Rasterizer::Compute) => compute_targets(variant),
    };
    std::iter::once(filtered(variant)).chain(list).flatten().collect()
}

/// The filtered picture.
fn filtered(variant: &Variant) -> Option<TargetDescription> {
    let filtered = stored(Resource::Filtered, COLOUR, &resource::FILTERED);
    (variant.filter_radius > 0).then_some(filtered)
}

fn image(
    resource: Resource,
    format: Format,
    also: ImageUse,
    shader: Option<&'static shaders::Resource>,
) -> TargetDescription {
    TargetDescription { resource, format, kind: Kind::Image(also), shader }
}

fn pixels(
    resource: Resource,
    format: Format,
    bytes: u64,
    shader: &'static shaders::Resource,
) -> TargetDescription {
    TargetDescription { resource, format, kind: Kind::Pixels(bytes), shader: Some(shader) }
}

/// Format of sums of one channel, or of four.
pub fn sums_format(precision: Precision, wide: bool) -> Format {
    match (precision, wide) {
        (Precision::Full, true) => Format::R32G32B32A32_SFLOAT,
        (Precision::Full, false) => Format::R32_SFLOAT,
        (Precision::Half, true) => Format::R16G16B16A16_SFLOAT,
        (Precision::Half, false) => Format::R16_SFLOAT,
    }
}

/// Bytes of coverage per pixel: one bit per sample.
const COVERAGE: u64 = 4;

/// The coverage mask.
fn coverage(variant: &Variant) -> Option<TargetDescription> {
    let coverage = pixels(Resource::Coverage, Format::R32_UINT, COVERAGE, &resource::COVERAGE);
    variant.coverage.then_some(coverage)
}

/// Format of the picture, and of normals.
const COLOUR: Format = Format::R32G32B32A32_SFLOAT;

/// An image that compute shaders store.
fn stored(resource: Resource, format: Format, shader: &'static shaders::Resource) -> TargetDescription {
    image(resource, format, ImageUse::StoredOutput, Some(shader))
}

/// Output images of compute passes.
fn stored_outputs(variant: &Variant) -> [Option<TargetDescription>; 4] {
    let outputs = variant.outputs;
    [
        Some(stored(Resource::Image, COLOUR, &resource::IMAGE_OUTPUT)),
        outputs.normal.then(|| stored(Resource::Normal, COLOUR, &resource::NORMAL_OUTPUT)),
        variant.stores_depth().then(|| stored(Resource::Depth, Format::R32_SFLOAT, &resource::DEPTH_OUTPUT)),
        outputs.id.then(|| stored(Resource::Id, Format::R32_UINT, &resource::ID_OUTPUT)),
    ]
}

fn raster_targets(variant: &Variant) -> Vec<Option<TargetDescription>> {
    let sums = |wide| sums_format(variant.precision, wide);
    let sampled = |resource, format, shader| image(resource, format, ImageUse::Sampled, Some(shader));
    let output = |resource, format| image(resource, format, ImageUse::Output, None);
    let [sums0, sums1] = [sums(variant.wide_sums0()), sums(variant.wide_sums1())];
    let loaded = |resource, format, shader| image(resource, format, ImageUse::FilteredOutput, Some(shader));
    let picture = match variant.filter_radius > 0 || variant.mixed || variant.edl {
        false => output(Resource::Image, COLOUR),
        true => loaded(Resource::Image, COLOUR, &resource::IMAGE_OUTPUT),
    };
    let depth = match variant.edl {
        false => variant.outputs.depth.then(|| output(Resource::Depth, Format::R32_SFLOAT)),
        true => Some(loaded(Resource::Depth, Format::R32_SFLOAT, &resource::DEPTH_OUTPUT)),
    };
    vec![
        Some(sampled(Resource::Visibility, Format::D32_SFLOAT, &resource::VISIBILITY_IMAGE)),
        Some(sampled(Resource::Sums0, sums0, &resource::SUMS0_IMAGE)),
        variant.has_sums1().then(|| sampled(Resource::Sums1, sums1, &resource::SUMS1_IMAGE)),
        Some(picture),
        variant.outputs.normal.then(|| output(Resource::Normal, COLOUR)),
        depth,
        coverage(variant),
        variant.mixed.then(|| sampled(Resource::Behind, Format::D32_SFLOAT, &resource::BEHIND_IMAGE)),
    ]
}

fn compute_targets(variant: &Variant) -> Vec<Option<TargetDescription>> {
    let outputs = stored_outputs(variant).into_iter();
    let visibility = pixels(Resource::Visibility, Format::R32_UINT, 4, &resource::VISIBILITY);
    if !variant.split && !variant.sliced {
        let visibility = (variant.cull_auto || variant.mixed).then_some(visibility);
        let open = variant.opens_tiles().then_some(tile_list::OPEN);
        let edges = variant.mixed.then_some(tile_list::EDGES);
        let coverage = coverage(variant).filter(|_| variant.mixed);
        return [visibility, open, edges, coverage].into_iter().chain(outputs).collect();
    }
    if variant.visibility == Visibility::Nearest {
        // State between the slices of the nearest pass: depths and ids of splats.
        let nearest_splats = pixels(Resource::Sums0, Format::R32_UINT, 4, &resource::SUMS0);
        return [Some(visibility), Some(nearest_splats), coverage(variant)]
            .into_iter()
            .chain(outputs)
            .collect();
    }
    let sums = |resource, wide: bool, shader| {
        let format = sums_format(Precision::Full, wide);
        pixels(resource, format, pixel_bytes(format), shader)
    };
    let stages = [
        Some(visibility),
        Some(sums(Resource::Sums0, variant.wide_sums0(), &resource::SUMS0)),
        variant.has_sums1().then(|| sums(Resource::Sums1, variant.wide_sums1(), &resource::SUMS1)),
        coverage(variant),
    ];
    stages.into_iter().chain(outputs).collect()
}

fn pull_push_targets(variant: &Variant) -> Vec<Option<TargetDescription>> {
    let raster_target = |resource, format, shader| {
        variant.has_raster_points().then(|| image(resource, format, ImageUse::Sampled, Some(shader)))
    };
    let nearest = pixels(Resource::Nearest, Format::R64_UINT, NEAREST_POINT, &resource::NEAREST);
    let points = [
        variant.has_compute_points().then_some(nearest),
        raster_target(Resource::NearestDepth, Format::D32_SFLOAT, &resource::NEAREST_DEPTH),
        raster_target(Resource::NearestId, Format::R32_UINT, &resource::NEAREST_ID),
    ];
    points.into_iter().chain(stored_outputs(variant)).collect()
}

/// Resources of descriptor set 1.
pub fn shader_resources(variant: &Variant) -> Vec<&'static shaders::Resource> {
    let of_targets = describe(variant);
    let of_splats = if variant.is_tiled() { splat_resources(variant) } else { Vec::new() };
    of_targets.iter().filter_map(|target| target.shader).chain(of_splats).collect()
}

/// Resources of the splat list in tile passes.
fn splat_resources(variant: &Variant) -> Vec<&'static shaders::Resource> {
    let (of_splats, clips) = if variant.workgroup.subgroups {
        (
            &[&resource::BOX_TEXELS, &resource::SPLAT_TEXELS, &resource::ATTRIBUTE_TEXELS][..],
            &resource::CLIP_TEXELS,
        )
    } else {
        (&[&resource::FRAME_SPLATS, &resource::FRAME_ATTRIBUTES][..], &resource::FRAME_CLIPS)
    };
    let clips = variant.clips.then_some(clips);
    let others = [&resource::BOXES, &resource::INCOMPLETE_FRAME];
    of_splats.iter().copied().chain(others).chain(clips).collect()
}

/// Bytes of a target per pixel.
pub fn pixel_size(target: &TargetDescription) -> f64 {
    match target.kind {
        Kind::Image(_) => pixel_bytes(target.format) as f64,
        Kind::Pixels(bytes) => bytes as f64,
        Kind::Tiles => tile_list::ENTRY as f64 / f64::from(TILE * TILE),
    }
}

/// Bytes per pixel of a frame's targets.
pub fn per_pixel(variant: &Variant) -> PerPixel {
    let named = |target: &TargetDescription| (target.resource.name(), pixel_size(target));
    let mut list: PerPixel = describe(variant).iter().map(named).collect();
    if variant.pull_push.is_some() {
        // The picture is last.
        list.splice(list.len() - 1..list.len() - 1, Pyramids::per_pixel(variant));
    }
    list
}

/// Whether the coverage of a picture of this size fits a storage buffer range.
pub fn coverage_fits(capabilities: &Capabilities, size: [u32; 2]) -> bool {
    COVERAGE * pixels_of(size) <= capabilities.max_storage_buffer_range
}

/// Whether the targets between compute passes, which split and sliced frames have, fit a storage buffer range.
pub fn stage_targets_fit(capabilities: &Capabilities, size: [u32; 2]) -> bool {
    pixel_bytes(sums_format(Precision::Full, true)) * pixels_of(size) <= capabilities.max_storage_buffer_range
}

/// Number of pixels.
pub fn pixels_of(size: [u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1])
}

/// Columns and rows of tiles of a picture.
fn tiles_of(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(TILE))
}

/// Rejects sizes beyond the limits of `device`.
pub fn check_size(device: &Device, size: [u32; 2]) -> Result<()> {
    let limit = device.capabilities().max_image_side;
    let [width, height] = size;
    match size.contains(&0) || size.iter().any(|side| *side > limit) {
        false => Ok(()),
        true => {
            let name = &device.description().name;
            Err(Error::Usage(format!(
                "a picture of {width}x{height} px: {name} draws from 1x1 to {limit}x{limit}"
            )))
        }
    }
}

impl RenderTargets {
    /// Creates the targets of `variant` at `size` px.
    pub fn new(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let make = |target: TargetDescription| {
            let name = target.resource.name();
            let memory = match target.kind {
                Kind::Image(also) => Memory::Image(Image::target(device, name, target.format, size, also)?),
                Kind::Pixels(bytes) => {
                    Memory::Buffer(Buffer::storage(device, name, bytes * pixels_of(size))?)
                }
                Kind::Tiles => {
                    let bytes = tile_list::bytes(pixels_of(tiles_of(size)));
                    Memory::Buffer(Buffer::indirect(device, name, bytes)?)
                }
            };
            Ok((target, memory))
        };
        let list = describe(variant).into_iter().map(make).collect::<Result<Vec<_>>>()?;
        let pyramids = variant.pull_push.map(|_| Pyramids::new(device, variant, size)).transpose()?;
        Ok(Self { list, pyramids, size, outputs: variant.outputs })
    }

    /// Creates coverage, if needed, for targets of a host.
    pub fn of_host(device: &Arc<Device>, variant: &Variant, size: [u32; 2]) -> Result<Self> {
        let make = |target: TargetDescription| {
            let buffer = Buffer::storage(device, target.resource.name(), COVERAGE * pixels_of(size))?;
            Ok((target, Memory::Buffer(buffer)))
        };
        let list = coverage(variant).into_iter().map(make).collect::<Result<Vec<_>>>()?;
        Ok(Self { list, pyramids: None, size, outputs: variant.outputs })
    }

    fn bindings(&self) -> impl Iterator<Item = (&'static shaders::Resource, Binding<'_>)> {
        self.list.iter().filter_map(|(target, memory)| {
            let binding = match (memory, target.kind) {
                (Memory::Image(image), Kind::Image(also)) if also.is_stored() => Binding::Stored(image),
                (Memory::Image(image), _) => Binding::Sampled(image),
                (Memory::Buffer(buffer), _) => Binding::whole(buffer),
            };
            Some((target.shader?, binding))
        })
    }

    /// Creates descriptor set 1 of a pass, of these and a host's targets. It must not outlive them.
    pub fn set(&self, device: &Arc<Device>, pass: &Pass, of_host: HostBindings<'_>) -> Result<DescriptorSet> {
        let all = self.bindings().chain(of_host.iter().copied());
        DescriptorSet::new(device, &all.filter(|(resource, _)| pass.binds(resource)).collect::<Vec<_>>())
    }

    fn find(&self, resource: Resource) -> Option<(Kind, &Memory)> {
        let found = self.list.iter().find(|(target, _)| target.resource == resource);
        found.map(|(target, memory)| (target.kind, memory))
    }

    /// The image of a target.
    pub fn image(&self, resource: Resource) -> Option<&Image> {
        match self.find(resource)?.1 {
            Memory::Image(image) => Some(image),
            Memory::Buffer(_) => None,
        }
    }

    /// The buffer of a target.
    pub fn buffer(&self, resource: Resource) -> Option<&Buffer> {
        match self.find(resource)?.1 {
            Memory::Image(_) => None,
            Memory::Buffer(buffer) => Some(buffer),
        }
    }

    /// Adds the access of a target to `uses`, if it exists.
    pub fn extend_uses(&self, uses: &mut Vec<Use>, resource: Resource, access: Access) {
        match self.find(resource) {
            Some((Kind::Image(also), Memory::Image(image))) if also.is_stored() => {
                uses.push(image.with(access.of_stored_image()));
            }
            Some((_, Memory::Image(image))) => uses.push(image.with(access.of_image())),
            Some((_, Memory::Buffer(buffer))) => uses.push(buffer.with(access)),
            None => uses.extend(self.pyramid_uses(resource, access)),
        }
    }

    /// Accesses of a pyramid's images.
    fn pyramid_uses(&self, resource: Resource, access: Access) -> impl Iterator<Item = Use> {
        let pyramid = self.pyramids.as_ref().and_then(|pyramids| pyramids.of(resource));
        pyramid.into_iter().flat_map(move |pyramid| pyramid.with(access))
    }

    /// Clears a target, if it exists: nearest points to ones, others to zeros.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, resource: Resource) {
        match (self.buffer(resource), resource) {
            (Some(buffer), Resource::Nearest) => enc.ones(buffer),
            (Some(buffer), Resource::OpenTiles | Resource::EdgeTiles) => {
                enc.zero_range(buffer, 0, tile_list::HEADER)
            }
            (Some(buffer), _) => enc.zero(buffer),
            (None, _) => {}
        }
    }

    /// The image after all passes.
    pub fn final_image(&self) -> Resource {
        if self.find(Resource::Filtered).is_some() { Resource::Filtered } else { Resource::Image }
    }

    /// Output images, to be read back.
    pub fn outputs(&self) -> impl Iterator<Item = &Image> {
        // Depths may be there for eye-dome lighting alone.
        let depth = self.outputs.depth.then_some(Resource::Depth);
        [Some(self.final_image()), Some(Resource::Normal), depth, Some(Resource::Id)]
            .into_iter()
            .flatten()
            .filter_map(|output| self.image(output))
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        pixels_of(self.size)
    }

    /// Columns and rows of tiles.
    pub fn tiles(&self) -> [u32; 2] {
        tiles_of(self.size)
    }

    /// All targets.
    pub fn list(&self) -> Vec<TargetInfo> {
        let info = |(target, memory): &(TargetDescription, Memory)| TargetInfo {
            name: target.resource.name(),
            format: target.format,
            bytes: match memory {
                Memory::Image(image) => image.bytes(),
                Memory::Buffer(buffer) => buffer.size(),
            },
        };
        let mut list: Vec<_> = self.list.iter().map(info).collect();
        if let Some(pyramids) = &self.pyramids {
            list.splice(list.len() - 1..list.len() - 1, pyramids.list());
        }
        list
    }
}

impl DrawTargets {
    /// Attachments of its render pass in frames of `variant`: colours, and depth.
    pub fn attachments(&self, variant: &Variant) -> (Vec<Attachment>, Option<Attachment>) {
        let all = describe(variant);
        let attachment = |(resource, contents): &(Resource, InitialContents)| {
            let found = all.iter().find(|target| target.resource == *resource);
            found.map_or(Attachment::Absent, |target| match contents {
                InitialContents::Cleared => Attachment::Cleared(target.format),
                InitialContents::Overwritten => Attachment::Overwritten(target.format),
                InitialContents::Tested => Attachment::Tested(target.format),
            })
        };
        (self.colours.iter().map(attachment).collect(), self.depth.as_ref().map(attachment))
    }

    /// Images of its framebuffer: colours in order, then depth.
    pub fn images<'a>(&self, targets: &'a RenderTargets) -> Vec<&'a Image> {
        let all = self.colours.iter().chain(&self.depth);
        all.filter_map(|(resource, _)| targets.image(*resource)).collect()
    }

    /// Accesses of its attachments.
    pub fn accesses(&self) -> impl Iterator<Item = (Resource, Access)> {
        let depth = self.depth.map(|(resource, contents)| match contents {
            InitialContents::Tested => (resource, Access::DEPTH_TEST),
            InitialContents::Cleared | InitialContents::Overwritten => (resource, Access::DEPTH_WRITE),
        });
        self.colours.iter().map(|(resource, _)| (*resource, Access::COLOUR_WRITE)).chain(depth)
    }
}
