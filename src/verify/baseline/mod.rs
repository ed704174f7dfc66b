//! The CPU baseline: what a plain native program makes of the same frames, without Vulkan. Times of a machine become comparable with
//! those of another as multiples of it.
//!
//! It is frozen, so that multiples stay comparable from version to version: points, and base EWA splatting of circles and ellipses with a
//! mask for α. It ignores clip lines: splats are drawn whole.
//!
//! Single precision on all threads of rayon's pool, for surfels in Morton order; it shares no code with the shaders or the float64
//! [reference](crate::verify::reference), so that it is a third opinion on what a picture should be.
//!
//! The tests hold it to the reference with the allowance for rounding of [`Tolerance::float32`](crate::verify::reference::Tolerance::float32),
//! in all of the hard scenes that the GPU is held to, but for those with clip lines. Only the discs that these show within 1° of edge-on need it: their planes are kept
//! in single floats, where the shaders have sums of two.
//!
//! | kind | stages |
//! |---|---|
//! | [`Kind::Pixels`] | `clear`, `project`: one pixel a surfel, by atomic minima; `resolve`: pixel → picture |
//! | [`Kind::Splats`] | `footprint`: surfel → splat; `bin`: splats → lists of tiles; then, tile by tile in the processor's cache, `visibility`, `attribute` and `normalize` as in [`perspective_ewa`](crate::settings::methods::perspective_ewa) |

mod chunk;
mod clock;
mod cover;
mod exp;
mod pixels;
mod shade;
mod shape;
mod splat;
mod splats;
mod sums;
mod target;
mod tile;
mod view;

use crate::error::{Error, Result};
use crate::geometry::srgb;
use crate::geometry::{Camera, Colours, Surfels};
use crate::picture::Picture;
use crate::settings::Outputs;
use crate::settings::splatting::Splatting;
use crate::settings::{Alpha, Settings, Shading};
use crate::vk::PassTime;
use clock::Stages;
use pixels::Pixels;
use splat::FLIPPED;
use splats::Splats;
use sums::Streams;
use target::Target;
use view::View;

/// What a baseline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// One pixel a surfel: its centre's, all of it. The nearest wins; of several as near the first.
    Pixels,
    /// The picture of the method `perspective-ewa`.
    Splats,
}

/// Memory in use, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// The surfels.
    pub scene: u64,
    /// What is made of them in a frame.
    pub splats: u64,
    /// What is drawn to: pictures and depths.
    pub targets: u64,
}

/// Draws frames of one scene. A frame makes nothing that an earlier one of the same kind, size and outputs has made, but for lists that
/// grow with what is seen.
pub struct Baseline {
    surfels: Surfels,
    /// Linear light of the 8-bit sRGB codes.
    linear: [f32; 256],
    pixels: Pixels,
    splats: Splats,
    target: Target,
    stages: Stages,
}

impl Baseline {
    /// Takes a copy of the [valid](Surfels::is_valid) ones of `surfels`, which are best in Morton order ([`Surfels::sort_morton`]).
    ///
    /// # Errors
    /// [`Error::Usage`] for none, for 2³¹ or more, and for arrays of unequal length.
    pub fn new(surfels: &Surfels) -> Result<Self> {
        surfels.check()?;
        let surfels = surfels.valid();
        if surfels.is_empty() || surfels.len() >= FLIPPED as usize {
            let count = surfels.len();
            return Err(Error::Usage(format!(
                "{count} surfels: the CPU baseline draws 1 to {}",
                FLIPPED - 1
            )));
        }
        Ok(Self {
            surfels,
            linear: std::array::from_fn(|code| srgb::decode(code as f64 / 255.0) as f32),
            pixels: Pixels::default(),
            splats: Splats::default(),
            target: Target::default(),
            stages: Stages::default(),
        })
    }

    /// Draws a frame of `size` = width and height in px; returns the wall time of each stage, in their order. Stages that run
    /// interleaved share their wall time as they share the threads' time.
    ///
    /// # Errors
    /// [`Error::Usage`] for settings, cameras and sizes of which no picture can be made; [`Error::Memory`] if there is too little.
    pub fn frame(
        &mut self,
        kind: Kind,
        camera: &Camera,
        size: [u32; 2],
        settings: &Settings,
        outputs: Outputs,
    ) -> Result<&[PassTime]> {
        settings.check()?;
        let counts = matches!(settings.shading, Shading::Overlap | Shading::Weight);
        if settings.splatting != Splatting::default() || counts || settings.alpha != Alpha::Mask {
            let text = "the CPU baseline draws as perspective-ewa does, with a mask for α, and neither overlaps nor weights: choose those";
            return Err(Error::Usage(text.into()));
        }
        let view = View::new(camera, size, self.surfels.origin)?;
        self.target.fit(size, outputs)?;
        self.stages.times.clear();
        let (target, stages) = (&mut self.target, &mut self.stages);
        let streams = Streams::new(&self.surfels, &self.linear, settings, outputs);
        match kind {
            Kind::Pixels => {
                self.pixels.frame(&self.surfels, &streams, &view, settings, target, stages)?;
            }
            Kind::Splats => {
                self.splats.frame(&self.surfels, streams, &view, settings, target, stages);
            }
        }
        Ok(&self.stages.times)
    }

    /// The last frame, as [`Renderer::render_picture`](crate::Renderer::render_picture) would give it; empty before the first.
    pub fn picture(&self) -> Picture {
        self.target.picture()
    }

    /// Memory in use, as the frames so far made it.
    pub fn bytes(&self) -> Memory {
        let s = &self.surfels;
        let colours = match &s.colours {
            Some(Colours::Srgb8(colours)) => size_of_val(colours.as_slice()),
            Some(Colours::Linear(colours)) => size_of_val(colours.as_slice()),
            None => 0,
        };
        let shapes =
            s.ellipses.as_deref().map_or(0, size_of_val) + s.two_sided.as_deref().map_or(0, size_of_val);
        let vectors = size_of_val(s.positions.as_slice()) + size_of_val(s.normals.as_slice());
        Memory {
            scene: (vectors + size_of_val(s.radii.as_slice()) + shapes + colours) as u64,
            splats: self.splats.bytes(),
            targets: self.target.bytes() + self.pixels.bytes(),
        }
    }
}
