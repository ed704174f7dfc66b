//! Render targets: their memory, bindings and uses.

use super::pass::{DrawTargets, InitialContents, Pass};
use super::pyramids::Pyramids;
use super::resource::Resource;
use super::scene_resources::copy_to_host;
use super::target_descriptions::{COVERAGE, Kind, TargetDescription, coverage, describe};
use super::tile_list;
use super::variant::Variant;
use crate::error::{Error, Result};
use crate::settings::Outputs;
use crate::vk::shaders;
use crate::vk::{
    Access, Attachment, Binding, Buffer, Capabilities, Commands, DescriptorSet, Device, Encoder, Image, Use,
};
use ash::vk::Format;
use std::sync::Arc;

/// Side of a tile, px: TILE of `lib/tile_size.glsl`.
pub const TILE: u32 = 8;

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

/// Whether the coverage of a picture of this size fits a storage buffer range.
pub fn coverage_fits(capabilities: &Capabilities, size: [u32; 2]) -> bool {
    COVERAGE * pixels_of(size) <= capabilities.max_storage_buffer_range
}

/// Whether the buffers of pixels of a frame of this variant and size fit a storage buffer range.
pub fn targets_fit(capabilities: &Capabilities, size: [u32; 2], variant: &Variant) -> bool {
    let bytes_of = |target: TargetDescription| match target.kind {
        Kind::Pixels(bytes) => bytes,
        Kind::Image(_) | Kind::Halved(_) | Kind::Tiles | Kind::PyramidTiles => 0,
    };
    let most = describe(variant).into_iter().map(bytes_of).max().unwrap_or(0);
    most * pixels_of(size) <= capabilities.max_storage_buffer_range
}

/// Number of pixels.
pub fn pixels_of(size: [u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1])
}

/// Columns and rows of tiles of a picture.
fn tiles_of(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(TILE))
}

/// Number of pyramid tiles of a picture.
fn pyramid_tiles_of(size: [u32; 2]) -> u64 {
    pixels_of(size.map(|side| side.div_ceil(tile_list::PYRAMID_TILE)))
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
                Kind::Halved(also) => {
                    let size = size.map(|side| side.div_ceil(2));
                    Memory::Image(Image::target(device, name, target.format, size, also)?)
                }
                Kind::Pixels(bytes) => {
                    Memory::Buffer(Buffer::storage(device, name, bytes * pixels_of(size))?)
                }
                Kind::Tiles => {
                    let bytes = tile_list::bytes(tile_list::HEADER, pixels_of(tiles_of(size)));
                    Memory::Buffer(Buffer::indirect(device, name, bytes)?)
                }
                Kind::PyramidTiles => {
                    let tiles = tile_list::with_padding(pyramid_tiles_of(size));
                    let bytes = tile_list::bytes(tile_list::PYRAMID_HEADER, tiles);
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
                (Memory::Image(image), Kind::Image(also) | Kind::Halved(also)) if also.is_stored() => {
                    Binding::Stored(image)
                }
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
            Some((Kind::Image(also) | Kind::Halved(also), Memory::Image(image))) if also.is_stored() => {
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

    /// Clears a target, if it exists: the final image to the background, nearest points and ids to ones, others to zeros.
    pub fn clear(&self, enc: &mut Encoder<'_, '_>, resource: Resource, background: [f32; 4]) {
        match (self.find(resource).map(|(_, memory)| memory), resource) {
            (Some(Memory::Image(image)), _) if resource == self.final_image() => {
                enc.clear_image(image, background);
            }
            (Some(Memory::Image(image)), Resource::Id) => enc.clear_image_to_ones(image),
            (Some(Memory::Image(image)), _) => enc.clear_image(image, [0.0; 4]),
            (Some(Memory::Buffer(buffer)), Resource::Nearest) => enc.ones(buffer),
            // Its pass writes the tiles.
            (Some(Memory::Buffer(buffer)), Resource::CoveredTiles) => {
                enc.zero_range(buffer, 0, tile_list::HEADER);
            }
            (Some(Memory::Buffer(buffer)), Resource::OccupiedTiles | Resource::FilledTiles) => {
                enc.zero_range(buffer, 0, tile_list::PYRAMID_HEADER);
                enc.ones_from(buffer, tile_list::PYRAMID_HEADER);
            }
            (Some(Memory::Buffer(buffer)), _) => enc.zero(buffer),
            (None, _) => {
                let pyramid = self.pyramids.as_ref().and_then(|pyramids| pyramids.of(resource));
                pyramid.into_iter().for_each(|pyramid| pyramid.clear(enc));
            }
        }
    }

    /// Reads back the tiles of the last frame that its boxes overlap, column and row of each; `None` if the frame has no list of them.
    pub fn read_covered_tiles(&self, device: &Arc<Device>) -> Result<Option<Vec<[u32; 2]>>> {
        let Some(list) = self.buffer(Resource::CoveredTiles) else { return Ok(None) };
        let target = Buffer::readback(device, "read tiles", list.size())?;
        Commands::new(device, false)?.run(|rec| copy_to_host(rec, list, &target))?;
        Ok(Some(tile_list::listed(target.bytes())))
    }

    /// The image after all passes.
    pub fn final_image(&self) -> Resource {
        if self.find(Resource::Filtered).is_some() { Resource::Filtered } else { Resource::Image }
    }

    /// Output images, to be read back.
    pub fn outputs(&self) -> impl Iterator<Item = &Image> {
        // Depths may be there for eye-dome lighting or ambient occlusion alone.
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

    /// Number of pyramid tiles.
    pub fn pyramid_tiles(&self) -> u64 {
        pyramid_tiles_of(self.size)
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
