//! Descriptions of a frame's targets: resource, format, storage, and the frames that have them.

use super::pyramids::{NEAREST_POINT, Pyramids};
use super::resource::Resource;
use super::targets::TILE;
use super::tile_list;
use super::variant::Variant;
use crate::settings::pull_push::Storage;
use crate::settings::splatting::Visibility;
use crate::settings::{Precision, Rasterizer};
use crate::vk::shaders::{self, resource};
use crate::vk::{ImageUse, pixel_bytes};
use ash::vk::Format;

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
    /// An image with a pixel per 2 × 2 pixels of the picture.
    Halved(ImageUse),
    /// A buffer of so many bytes per pixel, row by row from the top left.
    Pixels(u64),
    /// A list of tiles.
    Tiles,
    /// A list of pyramid tiles.
    PyramidTiles,
}

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
            Self::HiddenClusters => &[&resource::HIDDEN_CLUSTERS],
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
            Self::CoveredTiles => &[&resource::COVERED_TILES],
            Self::OpenTiles => &[&resource::OPEN_TILES],
            Self::EdgeTiles => &[&resource::EDGE_TILES],
            Self::RevealedTiles => &[&resource::REVEALED_TILES],
            Self::OccupiedTiles => &[&resource::OCCUPIED_TILES],
            Self::FilledTiles => &[&resource::FILLED_TILES],
            Self::Coverage => &[&resource::COVERAGE],
            Self::Behind => &[&resource::BEHIND_DEPTHS, &resource::BEHIND_IMAGE],
            Self::Nearest => &[&resource::NEAREST],
            Self::NearestDepth => &[&resource::NEAREST_DEPTH],
            Self::NearestId => &[&resource::NEAREST_ID],
            Self::Pulled => &[&resource::TO_IMAGE0],
            Self::Pushed => &[&resource::FINAL_QUAD0],
            Self::HostDepth => &[&resource::HOST_DEPTH],
            Self::IncompleteFrame => &[&resource::INCOMPLETE_FRAME],
            Self::Image => &[&resource::IMAGE_OUTPUT],
            Self::Occlusion => &[&resource::OCCLUSION],
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
    [filtered(variant), occlusion(variant)].into_iter().chain(list).flatten().collect()
}

/// The filtered picture.
fn filtered(variant: &Variant) -> Option<TargetDescription> {
    let filtered = stored(Resource::Filtered, COLOUR, &resource::FILTERED);
    (variant.filter_radius > 0).then_some(filtered)
}

/// The ambient occlusion.
fn occlusion(variant: &Variant) -> Option<TargetDescription> {
    let shader = Some(&resource::OCCLUSION);
    let kind = Kind::Halved(ImageUse::StoredOutput);
    variant.ao.then_some(TargetDescription { resource: Resource::Occlusion, format: COLOUR, kind, shader })
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
pub const COVERAGE: u64 = 4;

/// The coverage mask.
pub fn coverage(variant: &Variant) -> Option<TargetDescription> {
    let coverage = pixels(Resource::Coverage, Format::R32_UINT, COVERAGE, &resource::COVERAGE);
    variant.coverage.then_some(coverage)
}

/// Format of the picture, of normals, and of ambient occlusion.
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
    let picture = match variant.filter_radius > 0 || variant.mixed || variant.reads_depth() {
        false => output(Resource::Image, COLOUR),
        true => loaded(Resource::Image, COLOUR, &resource::IMAGE_OUTPUT),
    };
    let depth = match variant.reads_depth() {
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
    let covered = variant.lists_tiles().then_some(tile_list::COVERED);
    let visibility = pixels(Resource::Visibility, Format::R32_UINT, 4, &resource::VISIBILITY);
    if !variant.split && !variant.sliced {
        let visibility = (variant.cull_auto || variant.mixed).then_some(visibility);
        let open = variant.opens_tiles().then_some(tile_list::OPEN);
        let edges = variant.mixed.then_some(tile_list::EDGES);
        let revealed = variant.occlusion_culling.then_some(tile_list::REVEALED);
        let coverage = coverage(variant).filter(|_| variant.mixed);
        return [covered, visibility, open, edges, revealed, coverage].into_iter().chain(outputs).collect();
    }
    if variant.visibility == Visibility::Nearest {
        // State between the slices of the nearest pass: depths and ids of splats.
        let nearest_splats = pixels(Resource::Sums0, Format::R32_UINT, 4, &resource::SUMS0);
        return [covered, Some(visibility), Some(nearest_splats), coverage(variant)]
            .into_iter()
            .chain(outputs)
            .collect();
    }
    let sums = |resource, wide: bool, shader| {
        let format = sums_format(Precision::Full, wide);
        pixels(resource, format, pixel_bytes(format), shader)
    };
    let behind = pixels(Resource::Behind, Format::R32_UINT, 4, &resource::BEHIND_DEPTHS);
    let stages = [
        Some(visibility),
        Some(sums(Resource::Sums0, variant.wide_sums0(), &resource::SUMS0)),
        variant.has_sums1().then(|| sums(Resource::Sums1, variant.wide_sums1(), &resource::SUMS1)),
        coverage(variant),
        (variant.sliced && variant.mixed).then_some(behind),
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
        Some(tile_list::OCCUPIED),
        Some(tile_list::FILLED),
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

/// Whether frames clear a target before a pass that declares it.
pub fn is_cleared(resource: Resource, variant: &Variant) -> bool {
    match resource {
        // Of the image, the filter reads covered tiles alone.
        Resource::Image => !variant.lists_tiles() || variant.filter_radius == 0,
        // Pyramids that alternate by level are one, which has the pulled samples.
        Resource::Pushed => variant.pull_push.is_some_and(|pull_push| pull_push.storage == Storage::Apart),
        // Dispatches over all tiles write all of them.
        Resource::Visibility | Resource::Coverage if variant.is_tiled() => {
            variant.lists_tiles() || variant.sliced
        }
        _ => true,
    }
}

/// Bytes of a target per pixel.
pub fn pixel_size(target: &TargetDescription) -> f64 {
    match target.kind {
        Kind::Image(_) => pixel_bytes(target.format) as f64,
        Kind::Halved(_) => pixel_bytes(target.format) as f64 / 4.0,
        Kind::Pixels(bytes) => bytes as f64,
        Kind::Tiles => tile_list::ENTRY as f64 / f64::from(TILE * TILE),
        Kind::PyramidTiles => {
            tile_list::ENTRY as f64 / f64::from(tile_list::PYRAMID_TILE * tile_list::PYRAMID_TILE)
        }
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
