//! The CPU baseline: a plain native renderer of points and splats, without Vulkan. Times relative to it are comparable
//! between machines.
//!
//! Its features are frozen, so that relative times stay comparable between versions: points, and base EWA splatting of
//! circles and ellipses with a mask for α. It ignores clip lines and draws splats whole.
//!
//! It uses single precision on all threads of rayon's pool, for surfels in Morton order. It shares no code with the
//! shaders or the float64 [reference](crate::verify::reference), so it checks both independently.
//!
//! Tests compare it with the reference in all hard scenes without clip lines, with the rounding errors of
//! [`Tolerance::float32`](crate::verify::reference::Tolerance::float32). Only discs within 1° of edge-on need them:
//! their planes are single floats, where the shaders use sums of two.
//!
//! | kind | stages |
//! |---|---|
//! | [`Kind::Pixels`] | `clear`, `project`: one pixel per surfel, by atomic minima; `resolve`: pixels → picture |
//! | [`Kind::Splats`] | `footprint`: surfels → splats; `bin`: splats → lists per tile; then, tile by tile in the processor's cache, `visibility`, `attribute` and `normalize` as in [`perspective_ewa`](crate::settings::methods::perspective_ewa) |

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
use crate::settings::splatting::{Shade, Splatting};
use crate::settings::{Alpha, Cull, Edges, Settings, Shading, Widen};
use crate::vk::PassTime;
use clock::Stages;
use pixels::Pixels;
use splat::FLIPPED;
use splats::Splats;
use sums::Streams;
use target::Target;
use view::View;

/// Kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// One pixel per surfel, that of its centre. The nearest surfel wins; of equally near ones the first.
    Pixels,
    /// Splats of `perspective-ewa` alone: see [`settings`].
    Splats,
}

/// The settings by which the baseline renders what a frame with `other` settings shows: splats alone, as their cost does not depend on the
/// presets.
pub fn settings(other: &Settings) -> Settings {
    Settings {
        splatting: Splatting { shade: Shade::Pixel, ..Splatting::default() },
        pull_push: None,
        cutoff: 2.5,
        lowpass: 1.0,
        pixel_filter: 0.0,
        widen: Widen::Small,
        cull: Cull::None,
        alpha: Alpha::Mask,
        edges: Edges::Nearest,
        ..other.clone()
    }
}

/// Memory in use, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Surfels.
    pub scene: u64,
    /// Splats and their lists.
    pub splats: u64,
    /// Images and depths.
    pub targets: u64,
}

/// Renders frames of one scene. A frame allocates only what earlier frames of the same kind, size and outputs have not,
/// except lists that grow with the visible splats.
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
    /// Copies the [valid](Surfels::is_valid) ones of `surfels`, which should be in Morton order
    /// ([`Surfels::sort_morton`]). A texture is replaced by its colours at the points.
    ///
    /// # Errors
    /// [`Error::Usage`] for no surfels, for 2³¹ or more, and for arrays of unequal length.
    pub fn new(surfels: &Surfels) -> Result<Self> {
        surfels.check()?;
        let mut surfels = surfels.valid();
        if surfels.is_empty() || surfels.len() >= FLIPPED as usize {
            let count = surfels.len();
            return Err(Error::Usage(format!(
                "{count} surfels: the CPU baseline draws 1 to {}",
                FLIPPED - 1
            )));
        }
        if let Some(texture) = surfels.texture.take() {
            surfels.colours = Some(texture.baked(&surfels.positions, Some(&surfels.radii)));
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

    /// Renders a frame of `size` = width and height in px; returns the wall time of each stage, in order. Alternating
    /// stages divide their wall time in proportion to their thread time.
    ///
    /// # Errors
    /// [`Error::Usage`] for invalid settings, cameras and sizes; [`Error::Memory`] if memory runs out.
    pub fn frame(
        &mut self,
        kind: Kind,
        camera: &Camera,
        size: [u32; 2],
        settings: &Settings,
        outputs: Outputs,
    ) -> Result<&[PassTime]> {
        settings.check()?;
        let counts = matches!(settings.shading, Shading::Overlap | Shading::Weight | Shading::Edl);
        let own = self::settings(settings);
        let is_own = (settings.splatting, settings.alpha, settings.pixel_filter)
            == (own.splatting, own.alpha, own.pixel_filter);
        if !is_own || counts || settings.cull == Cull::Auto || settings.occludes() {
            let text = "the CPU baseline draws splats alone: choose the mask for α, culling other than auto, the other choices of `baseline::settings`, and neither overlaps, weights, eye-dome lighting nor ambient occlusion";
            return Err(Error::Usage(text.into()));
        }
        let view = View::new(camera, size, self.surfels.origin)?;
        self.target.fit(size, outputs)?;
        self.stages.times.clear();
        let (target, stages) = (&mut self.target, &mut self.stages);
        let streams = Streams::new(&self.surfels, &self.linear, &view, settings, outputs);
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

    /// The last frame, in the form of [`Renderer::render_picture`](crate::Renderer::render_picture); empty before the
    /// first frame.
    pub fn picture(&self) -> Picture {
        self.target.picture()
    }

    /// Memory in use.
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
