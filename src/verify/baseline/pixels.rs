//! One-pixel points: each surfel's centre is projected to a pixel, and the nearest surfel wins.

use super::clock::Stages;
use super::shade::{Shader, Surface, Vectors};
use super::splat::FLIPPED;
use super::sums::Streams;
use super::target::{Target, TargetTile, resize, tile_pixel, tiles};
use super::tile::{BLOCKS, LANES, centres, corner};
use super::view::View;
use crate::error::Result;
use crate::geometry::Surfels;
use crate::settings::{Cull, Settings};
use glam::{BVec4A, Mat3A, Vec2, Vec3, Vec3A, Vec4};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Surfels per task.
const CHUNK: usize = 1 << 14;
/// Value of an empty pixel.
const EMPTY: u64 = u64::MAX;

/// Buffer that is reused between frames: for every pixel, in the target's order, the nearest surfel. The bits of its
/// depth precede its index, so that the least value is the nearest surfel, and the first of equally near ones.
#[derive(Debug, Default)]
pub(super) struct Pixels {
    nearest: Vec<AtomicU64>,
}

/// Projection of a scene's surfels in a frame.
struct Projection<'a> {
    surfels: &'a Surfels,
    view: &'a View,
    cull: bool,
    /// The eye as a sum of two floats.
    eye: [Vec3; 2],
    pixel: Mat3A,
    middle: Vec2,
    forward: Vec3,
    /// Origin of depths, so that none is below 0.
    base: f32,
    /// Depths of the near and the far plane.
    range: [f32; 2],
    /// Colour of a scene without colours.
    albedo: Vectors,
}

impl Pixels {
    /// Renders a frame.
    pub fn frame(
        &mut self,
        surfels: &Surfels,
        streams: &Streams,
        view: &View,
        settings: &Settings,
        target: &mut Target,
        stages: &mut Stages,
    ) -> Result<()> {
        resize(&mut self.nearest, tiles(view.size) * BLOCKS * LANES, "the CPU baseline's pixels", || {
            AtomicU64::new(EMPTY)
        })?;
        stages.time("clear", || {
            let tiles = self.nearest.par_chunks_mut(BLOCKS * LANES);
            tiles.for_each(|tile| tile.iter_mut().for_each(|nearest| *nearest.get_mut() = EMPTY));
        });
        let projection = Projection::new(surfels, view, settings);
        stages.time("project", || {
            let chunks = (0..surfels.len()).into_par_iter().step_by(CHUNK);
            chunks.for_each(|first| {
                let last = surfels.len().min(first + CHUNK);
                (first..last).for_each(|index| projection.project(index, &self.nearest));
            });
        });
        let shader = Shader::new(settings, view, streams.normals);
        stages.time("resolve", || {
            let tiles = self.nearest.par_chunks_mut(BLOCKS * LANES);
            target.target_tiles().zip(tiles).for_each(|(mut output, nearest)| {
                projection.resolve(streams, &shader, nearest, &mut output);
            });
        });
        Ok(())
    }

    /// Memory in use, bytes.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.nearest.as_slice()) as u64
    }
}

impl<'a> Projection<'a> {
    fn new(surfels: &'a Surfels, view: &'a View, settings: &Settings) -> Self {
        let high = view.eye.as_vec3();
        let base = if view.perspective { 0.0 } else { view.near };
        Self {
            surfels,
            view,
            cull: settings.cull == Cull::Back,
            eye: [high, (view.eye - high.as_dvec3()).as_vec3()],
            pixel: Mat3A::from(view.pixel.as_mat3()),
            middle: view.middle.as_vec2(),
            forward: view.forward.as_vec3(),
            base: base as f32,
            range: [view.near, view.far].map(|plane| (plane - base) as f32),
            albedo: settings.lighting.albedo.map(Vec4::splat),
        }
    }

    /// Projects a surfel, and stores it if its pixel has no nearer one.
    #[inline]
    fn project(&self, index: usize, nearest: &[AtomicU64]) {
        let position = self.position(index);
        let image = self.pixel * Vec3A::from(position);
        let depth = image.z - self.base;
        // NaN fails the comparison.
        if !(depth >= self.range[0] && depth <= self.range[1]) {
            return;
        }
        let (x, y) = if self.view.perspective {
            (image.x / depth, image.y / depth)
        } else {
            (image.x + self.middle.x, image.y + self.middle.y)
        };
        let [width, height] = self.view.size;
        let inside = x >= 0.0 && y >= 0.0 && x < width as f32 && y < height as f32;
        if !inside || self.is_culled(index, position) {
            return;
        }
        let (tile, pixel) = tile_pixel(self.view.size, [x as u32, y as u32]);
        let nearest_in_pixel = &nearest[tile * BLOCKS * LANES + pixel];
        // Never −0, whose bits are large.
        let key = u64::from(depth.abs().to_bits()) << 32 | index as u64;
        // Most surfels lose: a load first is cheaper.
        if key < nearest_in_pixel.load(Ordering::Relaxed) {
            nearest_in_pixel.fetch_min(key, Ordering::Relaxed);
        }
    }

    /// Position relative to the eye.
    #[inline]
    fn position(&self, index: usize) -> Vec3 {
        (self.surfels.positions[index] - self.eye[0]) - self.eye[1]
    }

    /// Whether the normal points away from the eye.
    #[inline]
    fn is_turned(&self, index: usize, position: Vec3) -> bool {
        let ray = if self.view.perspective { position } else { self.forward };
        self.surfels.normals[index].dot(ray) >= 0.0 && !self.surfels.is_billboard(index)
    }

    #[inline]
    fn is_culled(&self, index: usize, position: Vec3) -> bool {
        let two_sided = || self.surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[index]);
        self.cull && self.is_turned(index, position) && !two_sided()
    }

    /// Shades a tile from the visible surfels of its pixels.
    fn resolve(
        &self,
        streams: &Streams,
        shader: &Shader,
        nearest: &mut [AtomicU64],
        output: &mut TargetTile,
    ) {
        for (block, nearest) in nearest.chunks_exact_mut(LANES).enumerate() {
            let (x, y) = centres(corner(output.at), block);
            let surface = self.surface(streams, nearest);
            output.put(block, &shader.shade(x, y, &surface));
        }
    }

    /// The surface of four pixels from their surfels.
    fn surface(&self, streams: &Streams, nearest: &mut [AtomicU64]) -> Surface {
        let mut attributes = [[0f32; LANES]; 6];
        let mut depth = [0f32; LANES];
        let mut covered = [false; LANES];
        for (lane, nearest) in nearest.iter_mut().map(|nearest| *nearest.get_mut()).enumerate() {
            if nearest == EMPTY {
                continue;
            }
            let index = nearest as u32;
            let turned = streams.normals && self.is_turned(index as usize, self.position(index as usize));
            let of = streams.attributes(if turned { index | FLIPPED } else { index });
            attributes.iter_mut().zip(of).for_each(|(lanes, value)| lanes[lane] = value);
            depth[lane] = f32::from_bits((nearest >> 32) as u32) + self.base;
            covered[lane] = true;
        }
        let vectors = |first: usize| [0, 1, 2].map(|i| Vec4::from_array(attributes[first + i]));
        Surface {
            covered: BVec4A::from_array(covered),
            colour: if streams.colours { vectors(streams.colour_channel()) } else { self.albedo },
            normal: vectors(0),
            weight: Vec4::ONE,
            depth: Vec4::from_array(depth),
        }
    }
}
