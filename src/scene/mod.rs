//! Scenes: geometry on the GPU. A scene has only the streams that it needs.

mod chunks;
mod clips;
mod clusters;
mod external;
mod groups;
pub(crate) mod instance;
mod lattices;
mod live;
mod materials;
mod order;
mod primitives;
mod room;
mod similarity;
mod stream;
mod streams;
mod surfel_streams;
mod texture;
mod update;
mod weights;

use crate::error::{Error, Result};
use crate::geometry::{
    Bounds, Camera, Colours, Curvature, LevelTable, MostDrawn, Parts, Primitives, Quantized, RADIUS_ROUNDING,
    SurfelFormat, Surfels, Texture,
};
use crate::vk::shaders::{Resource, resource};
use crate::vk::{Binding, Buffer, Device, Uploads};
pub(crate) use chunks::LARGEST_STRIDE;
use chunks::{chunks, step};
pub(crate) use clips::ClipChunk;
use clips::ClipStream;
pub(crate) use clusters::CLUSTER;
use clusters::Clusters;
pub(crate) use external::ExternalBuffers;
use glam::{DVec3, Vec3};
pub(crate) use groups::{GROUP, GroupBounds, groups};
pub use instance::{Instance, Instances};
pub(crate) use materials::MaterialStream;
pub use order::Order;
pub(crate) use primitives::{Elements, PrimitiveStreams};
use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
pub(crate) use stream::Stream;
pub use stream::{NormalStream, SurfelLayout, Words};
pub use streams::{ColourStream, PrimitiveKinds, Streams};
use surfel_streams::{SCALAR, SurfelStreams};
pub(crate) use texture::TextureStream;
pub use update::Changes;
use weights::WeightBuffer;

/// Surfels, lines and triangles on a device.
pub struct Scene {
    pub(crate) id: u64,
    surfels: SurfelStreams,
    two_sided: bool,
    /// Whether some surfels may be billboards: at the upload, or by an update.
    billboards: AtomicBool,
    clips: Option<ClipStream>,
    /// Which surfels stand for others from afar.
    levels: Option<LevelTable>,
    /// Bounds by which frames cull; absent for surfels in arbitrary order and in buffers of the host, and beyond the limits of the device.
    clusters: Option<Clusters>,
    colours: Option<Stream>,
    pub(crate) weights: Option<WeightBuffer>,
    pub(crate) primitives: Option<PrimitiveStreams>,
    pub(crate) texture: Option<TextureStream>,
    pub(crate) materials: Option<MaterialStream>,
    colour_stream: ColourStream,
    chunks: Vec<Range<u64>>,
    /// Alignment of buffer bindings, bytes.
    alignment: u64,
    origin: DVec3,
    /// Largest radius so far, as bits; `None` if it is not known.
    largest: Option<AtomicU32>,
    /// The same of surfels with a curvature.
    largest_curved: AtomicU32,
    /// Whether the host owns the surfels' buffers.
    of_host: bool,
    /// Order of the surfels.
    order: Order,
    /// Box of the curve along which they are sorted, relative to the origin; `None`: the bounds.
    curve_box: Option<[Vec3; 2]>,
    /// Whether some surfels were invalid at the upload.
    had_invalid: bool,
    /// Whether updates may have made surfels invalid that have a radius other than 0.
    unchecked: AtomicBool,
    count: AtomicU64,
    bounds: Mutex<Bounds>,
    /// Whether all surfels are known to be within the bounds: they are not the host's.
    bounds_hold: AtomicBool,
}

impl Scene {
    /// Uploads surfels, lines and triangles to `device`. Surfels are best in Morton order ([`Surfels::sort_morton`]): frames by tiles sort those
    /// that are in arbitrary order ([`Order`]) again and again.
    ///
    /// Invalid elements ([`Surfels::is_valid`], [`Primitives::is_valid`](crate::geometry::Primitives::is_valid)) are not drawn: a warning
    /// gives their number, and frames count such surfels as `invalid`.
    ///
    /// # Errors
    /// [`Error::Usage`] for arrays of unequal length, and for a scene without valid elements.
    pub fn upload<'a>(device: &Arc<Device>, parts: impl Into<Parts<'a>>) -> Result<Self> {
        let parts = parts.into();
        Self::new(device, &Uploads::now(device)?, parts)
    }

    /// Like [`Scene::upload`], through `uploads`, which are of `device`.
    pub(crate) fn new(device: &Arc<Device>, uploads: &Uploads<'_>, parts: Parts<'_>) -> Result<Self> {
        let (scene, invalid) = Self::new_silently(device, uploads, parts)?;
        if invalid > 0 {
            warn_of(invalid, parts.surfels.len());
        }
        if let Some(primitives) = parts.primitives {
            warn_of_primitives(primitives.count_invalid(), primitives.count());
        }
        Ok(scene)
    }

    /// Like [`Scene::upload`] without warnings; also returns the number of invalid surfels.
    #[cfg(feature = "bench")]
    pub(crate) fn upload_silently<'a>(
        device: &Arc<Device>,
        parts: impl Into<Parts<'a>>,
    ) -> Result<(Self, usize)> {
        Self::new_silently(device, &Uploads::now(device)?, parts.into())
    }

    fn new_silently(device: &Arc<Device>, uploads: &Uploads<'_>, parts: Parts<'_>) -> Result<(Self, usize)> {
        let surfels = parts.surfels;
        parts.check()?;
        let image = parts.texture();
        if image.is_none() && parts.has_texture() {
            let baked = parts.baked();
            return Self::new_silently(
                device,
                uploads,
                Parts { levels: parts.levels, format: parts.format, ..(&baked).into() },
            );
        }
        room::check(device, &parts)?;
        let (bounds, invalid) = usable(&parts)?;
        let count = surfels.len() as u64;
        let chunks = chunks(count, device.capabilities(), 0);
        let textured =
            surfels.texture.as_ref().map(|texture| (texture, &surfels.positions[..], &surfels.radii[..]));
        let (colour_stream, colours) = colour_bytes(surfels.colours.as_ref(), textured);
        let weights = surfels
            .weights
            .as_ref()
            .map(|weights| WeightBuffer::new(device, uploads, surfels, weights, &chunks));
        // Each level is sorted.
        let order = Order::of(&surfels.positions[..parts.points()]);
        // The bounds of all clusters are bound at once.
        let most = device.capabilities().max_storage_buffer_range;
        let bounded = order == Order::Coherent && count > 0 && clusters::bytes(count) <= most;
        let radii = marked_radii(surfels, invalid);
        let quantize = parts.format == SurfelFormat::Quantized;
        let codes = quantize.then(|| Quantized::of(surfels, &radii)).flatten();
        let rounding = codes.as_ref().map_or(1.0, |_| RADIUS_ROUNDING);
        let largest = rounding * largest(&surfels.radii);
        let largest_curved = rounding * largest_curved(surfels);
        let clips = codes.as_ref().map_or(surfels.clips.as_ref(), |codes| codes.clips.as_ref());
        let scene = Self {
            id: next_id(),
            surfels: match &codes {
                None => SurfelStreams::floats(uploads, surfels, &radii)?,
                Some(codes) => {
                    SurfelStreams::quantized(uploads, codes, (&surfels.positions, &radii), &chunks)?
                }
            },
            two_sided: surfels.two_sided.is_some(),
            billboards: AtomicBool::new(surfels.normals.contains(&Vec3::ZERO)),
            colours: (colour_stream != ColourStream::None)
                .then(|| uploads.buffer("colours", &colours))
                .transpose()?
                .map(|buffer| Stream::side_by_side(buffer, colour_stream.bytes())),
            weights: weights.transpose()?,
            colour_stream,
            clips: clips.map(|clips| ClipStream::new(uploads, clips, &chunks)).transpose()?,
            levels: parts.levels.filter(|table| !table.starts().is_empty()).cloned(),
            clusters: bounded
                .then(|| Clusters::new(uploads, surfels, codes.as_ref(), &chunks))
                .transpose()?,
            primitives: PrimitiveStreams::new(device, uploads, &parts)?,
            texture: image.map(|image| TextureStream::new(device, uploads, image)).transpose()?,
            materials: MaterialStream::new(device, uploads, &parts)?,
            chunks,
            alignment: device.capabilities().storage_buffer_alignment,
            origin: parts.origin(),
            largest: Some(AtomicU32::new(largest.to_bits())),
            largest_curved: AtomicU32::new(largest_curved.to_bits()),
            of_host: false,
            order,
            curve_box: order::bulk(&surfels.positions),
            had_invalid: invalid > 0,
            unchecked: AtomicBool::new(false),
            count: AtomicU64::new(count),
            bounds: Mutex::new(bounds),
            bounds_hold: AtomicBool::new(true),
        };
        Ok((scene, invalid))
    }

    /// Whether the scene is on this device.
    pub fn is_on(&self, device: &Arc<Device>) -> bool {
        self.surfels.positions.buffer.is_on(device)
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        self.surfels.positions.buffer.device()
    }

    /// Returns an error unless the scene is on `device`.
    pub(crate) fn check_device(&self, device: &Arc<Device>) -> Result<()> {
        if self.is_on(device) {
            Ok(())
        } else {
            Err(Error::Usage("the scene is of another device: upload it to the renderer's".into()))
        }
    }

    /// Origin of the shaders' coordinates, world space.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Format of the colours.
    pub fn colour_stream(&self) -> ColourStream {
        self.colour_stream
    }

    /// Memory of the streams, without buffers of a host, bytes.
    pub fn bytes(&self) -> u64 {
        let clips = self.clips.as_ref().map(|clips| &clips.buffer);
        let clusters = self.clusters.as_ref().map(|clusters| &clusters.buffer);
        let weights = self.weights.as_ref().map(|weights| &weights.buffer);
        let texture = self.texture.as_ref().map(|texture| &texture.buffer);
        let materials = self.materials.as_ref().map(|materials| &materials.buffer);
        let colours = self.colours.as_ref().map(|colours| &colours.buffer);
        let others = [colours, clips, clusters, weights, texture, materials].into_iter().flatten();
        let buffers = self.surfels.buffers().chain(others).filter(|buffer| !buffer.is_external());
        let primitives = self.primitives.as_ref().map_or(0, PrimitiveStreams::bytes);
        buffers.map(Buffer::size).sum::<u64>() + primitives
    }

    /// Upper bounds of the number of surfels that are drawn, seen by `camera` in a picture of `size` px.
    pub fn most_drawn(&self, camera: &Camera, size: [u32; 2]) -> MostDrawn {
        let count = self.count();
        self.levels
            .as_ref()
            .map_or(MostDrawn::all(count), |table| table.most_drawn(count, self.origin, camera, size))
    }

    /// Number of points: of surfels without those that stand for others from afar.
    pub fn point_count(&self) -> u64 {
        let levels = self.levels.as_ref().and_then(|table| table.starts().first());
        levels.map_or(self.count(), |first| (*first).into())
    }

    /// Which of the surfels stand for others from afar, if any do.
    pub fn level_table(&self) -> Option<&LevelTable> {
        self.levels.as_ref()
    }

    /// Chunks of surfels: ranges that one descriptor set can bind.
    pub fn chunks(&self) -> &[Range<u64>] {
        &self.chunks
    }

    /// The streams of the scene.
    pub fn streams(&self) -> Streams {
        Streams {
            ellipses: self.surfels.ellipses.is_some(),
            curvatures: self.surfels.curvatures,
            two_sided: self.two_sided,
            billboards: self.billboards.load(Ordering::Relaxed),
            clips: self.clips.is_some(),
            weights: self.weights.as_ref().map(|weights| weights.corners),
            colours: self.colour_stream,
            primitives: self.primitives.as_ref().map_or(PrimitiveKinds::NONE, PrimitiveStreams::kinds),
            texture: self.texture.as_ref().map(|texture| texture.texels),
            materials: self.materials.is_some(),
            layout: self.layout(),
            unchecked: self.unchecked.load(Ordering::Relaxed),
            // Fewer buffers than every device has for shaders: clips and weights are of captured files, which are sorted.
            unordered: self.order == Order::Arbitrary && self.clips.is_none() && self.weights.is_none(),
            clusters: self.clusters.is_some(),
            levels: self.levels.is_some(),
        }
    }

    fn layout(&self) -> SurfelLayout {
        let words = |stream: &Stream| stream.words(self.alignment);
        let usual = SurfelLayout::side_by_side(self.colour_stream);
        let surfels = &self.surfels;
        SurfelLayout {
            positions: words(&surfels.positions),
            normals: words(&surfels.normals),
            normal_stream: surfels.normal_stream,
            radii: surfels.radii().map_or(usual.radii, words),
            colours: self.colours.as_ref().map_or(usual.colours, words),
            ellipses: surfels.ellipses.as_ref().map_or(usual.ellipses, words),
        }
    }

    /// Corners of the box of the curve along which surfels in arbitrary order are sorted, relative to the origin.
    pub(crate) fn curve_box(&self) -> [Vec3; 2] {
        let bounds = || {
            let bounds = self.bounds();
            [bounds.min, bounds.max].map(|corner| (corner - self.origin).as_vec3())
        };
        self.curve_box.unwrap_or_else(bounds)
    }

    /// The clips of each chunk, if any.
    pub(crate) fn clip_chunks(&self) -> Option<&[ClipChunk]> {
        self.clips.as_ref().map(|clips| clips.chunks.as_slice())
    }

    /// Resources and bindings of chunk `number`.
    pub(crate) fn bindings(&self, number: usize) -> Vec<(&'static Resource, Binding<'_>)> {
        let chunk = &self.chunks[number];
        let mut list: Vec<_> = self.surfels.bindings(number, chunk, self.alignment).collect();
        let colours = self.colours.as_ref();
        list.extend(colours.map(|colours| (&resource::COLOURS, colours.binding(chunk, self.alignment))));
        list.extend(self.clips.as_ref().map(|clips| (&resource::CLIPS, clips.binding(number))));
        list.extend(self.weights.as_ref().map(|weights| (&resource::WEIGHTS, weights.binding(number))));
        list
    }

    /// Calls `body` with the bounds of the groups of its clusters, chunk by chunk, if they are known.
    pub(crate) fn with_groups<R>(&self, body: impl FnOnce(Option<&[Vec<GroupBounds>]>) -> R) -> R {
        match &self.clusters {
            Some(clusters) => clusters.with_groups(|groups| body(Some(groups))),
            None => body(None),
        }
    }

    /// Bounds of its clusters of surfels.
    pub(crate) fn cluster_bindings(&self) -> Option<(&'static Resource, Binding<'_>)> {
        self.clusters.as_ref().map(|clusters| (&resource::CLUSTERS, Binding::whole(&clusters.buffer)))
    }

    /// Resources and bindings of the lines, or with `kind` 1 of the triangles.
    pub(crate) fn element_bindings(&self, kind: usize) -> Vec<(&'static Resource, Binding<'_>)> {
        let Some(PrimitiveStreams { vertices, line_directions, colours, lines, triangles, .. }) =
            &self.primitives
        else {
            return Vec::new();
        };
        let elements = [lines, triangles][kind].as_ref().map(|elements| &elements.buffer);
        let streams = [
            (&resource::VERTICES, Some(vertices)),
            (&resource::LINE_DIRECTIONS, line_directions.as_ref()),
            (&resource::VERTEX_COLOURS, colours.as_ref()),
            (&resource::ELEMENTS, elements),
        ];
        let there = streams.into_iter().filter_map(|(resource, buffer)| Some((resource, buffer?)));
        there.map(|(resource, buffer)| (resource, Binding::whole(buffer))).collect()
    }
}

/// Format and bytes of the colours. With a texture: its colours at points with these positions and radii.
fn colour_bytes<'a>(
    colours: Option<&'a Colours>,
    texture: Option<(&Texture, &[Vec3], &[f32])>,
) -> (ColourStream, Cow<'a, [u8]>) {
    if let Some((texture, positions, radii)) = texture {
        let colours = texture.colours(positions, Some(radii));
        let each = texture.coordinates.iter().zip(colours);
        let floats = each.map(|(at, [r, g, b])| [at.x, at.y, r, g, b]);
        return (ColourStream::Textured, bytemuck::pod_collect_to_vec(&floats.collect::<Vec<_>>()).into());
    }
    match colours {
        None => (ColourStream::None, Cow::Borrowed(&[])),
        Some(Colours::Srgb8(colours)) => (ColourStream::Srgb8, bytemuck::cast_slice(colours).into()),
        Some(Colours::Linear(colours)) => (ColourStream::Linear, bytemuck::cast_slice(colours).into()),
    }
}

/// The largest valid radius; 0 if there is none.
fn largest(radii: &[f32]) -> f32 {
    radii.iter().copied().filter(|radius| *radius <= Surfels::LARGEST).fold(0.0, f32::max)
}

/// The same of surfels with a curvature.
fn largest_curved(surfels: &Surfels) -> f32 {
    let curvatures = surfels.curvatures.iter().flatten();
    let curved = curvatures.zip(&surfels.radii).filter(|(curvature, _)| **curvature != Curvature::default());
    curved.fold(0.0, |most, (_, radius)| most.max(largest(&[*radius])))
}

/// A unique scene id.
fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Bounds of the valid elements, and the number of invalid surfels.
fn usable(parts: &Parts<'_>) -> Result<(Bounds, usize)> {
    let Some(bounds) = parts.bounds() else {
        let surfels = parts.surfels.len();
        let primitives = parts.primitives.map_or(0, Primitives::count);
        let text = format!(
            "the scene is empty: none of {surfels} surfels and {primitives} segments and triangles is valid"
        );
        return Err(Error::Usage(text));
    };
    Ok((bounds, parts.surfels.count_invalid()))
}

fn warn_of_primitives(invalid: usize, count: usize) {
    if invalid > 0 {
        log::warn!(
            "{invalid} of {count} segments and triangles are invalid and will not be drawn: a value of a vertex is NaN, infinite or \
             beyond {:e}, a direction is not a unit vector, or a radius is below 0",
            Surfels::LARGEST
        );
    }
}

fn warn_of(invalid: usize, count: usize) {
    log::warn!(
        "{invalid} of {count} surfels are invalid and will not be drawn: a value is NaN, infinite or beyond {:e}, a normal is neither a unit vector nor 0, an axis is not a unit vector, a radius or an aspect is not above 0, a clip line is not in the tangent plane",
        Surfels::LARGEST
    );
}

/// Radii: negative for two-sided surfels, and 0 for invalid ones.
fn marked_radii(surfels: &Surfels, invalid: usize) -> Cow<'_, [f32]> {
    if surfels.two_sided.is_none() && invalid == 0 {
        return Cow::Borrowed(&surfels.radii);
    }
    let two_sided = |i: usize| surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i]);
    let mark = |(i, &radius): (usize, &f32)| match (surfels.is_valid(i), two_sided(i)) {
        (false, _) => 0.0,
        (true, false) => radius,
        (true, true) => -radius,
    };
    surfels.radii.iter().enumerate().map(mark).collect()
}
