//! Engines: every way to render, behind one interface.

mod traced;

pub use traced::{RAYS, TracedEngine, TracedFilter};

use super::record::{Axes, BOX_FILTER, Clock, Implementation, Memory, PIXELS, SPLATS, TRACED, Time};
use crate::error::Result;
use crate::frame::PassTraffic;
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::settings::methods::Method;
use crate::settings::{Choice, Settings};
use crate::verify::baseline::{self, Baseline, Kind};
use crate::vk::{Device, DeviceDescription, PassTime};
use crate::{Outputs, Precision, Rasterizer, RenderOptions, Renderer, Scene};
use std::rc::Rc;
use std::sync::Arc;

/// A way to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Engine {
    /// Splats on a Vulkan device, by the method that the settings choose.
    Splatting {
        /// Rasterizer of the splats; chosen as without options if `None`.
        rasterizer: Option<Rasterizer>,
        /// Width of the sums.
        precision: Precision,
    },
    /// The CPU baseline.
    Baseline(Kind),
    /// No points: the surface or the scan's triangles, ray traced on the CPU.
    Traced(TracedFilter),
}

impl Engine {
    /// The default method with default options.
    pub const DEFAULT: Self = Self::Splatting { rasterizer: None, precision: Precision::Full };

    /// Name in the results, with these settings: after the preset that is nearest to them, of equal ones ours.
    pub fn implementation(&self, settings: &Settings) -> Implementation {
        self.implementation_from(&preset(settings), settings)
    }

    /// Name in the results, with these settings: after this preset.
    pub fn implementation_from(&self, method: &Method, settings: &Settings) -> Implementation {
        match self {
            Self::Splatting { rasterizer, precision } => {
                let rasterizer = rasterizer.map(|rasterizer| match rasterizer {
                    Rasterizer::Draw => "--rasterizer draw",
                    Rasterizer::Compute => "--rasterizer compute",
                });
                let half = (*precision == Precision::Half).then_some("--half");
                let ways = rasterizer.into_iter().chain(half).map(str::to_owned);
                let variant = changes(method, settings).into_iter().chain(ways).collect::<Vec<_>>().join(" ");
                Implementation { method: method.name.into(), variant }
            }
            Self::Baseline(Kind::Splats) => Implementation { method: SPLATS.into(), variant: String::new() },
            Self::Baseline(Kind::Pixels) => Implementation { method: PIXELS.into(), variant: String::new() },
            Self::Traced(TracedFilter::Truth) => {
                Implementation { method: TRACED.into(), variant: String::new() }
            }
            Self::Traced(TracedFilter::Box) => {
                Implementation { method: TRACED.into(), variant: BOX_FILTER.into() }
            }
        }
    }
}

/// The preset nearest to the settings. For splats it is the one from which they differ along the fewest axes, then the first one, preferring
/// equal numbers.
fn preset(settings: &Settings) -> Method {
    let of_points = |method: &Method| method.pull_push.is_some() && method.pull_push == settings.pull_push;
    if let Some(method) = Method::ALL.into_iter().find(of_points) {
        return method;
    }
    let differs = |method: &Method| {
        let preset = method.settings();
        (preset.cutoff, preset.lowpass, preset.pixel_filter)
            != (settings.cutoff, settings.lowpass, settings.pixel_filter)
            || (preset.widen, preset.cull) != (settings.widen, settings.cull)
    };
    let splatting = Method::ALL.into_iter().filter(|method| method.pull_push.is_none());
    let nearest = splatting.min_by_key(|method| (changes(method, settings).len(), differs(method)));
    nearest.unwrap_or(Method::SPLATTING[0])
}

/// Axes along which settings differ from those of a preset, as options.
fn changes(method: &Method, settings: &Settings) -> Vec<String> {
    if let (Some(own), Some(preset)) = (settings.pull_push, method.pull_push) {
        let weights = (own.weights != preset.weights).then(|| format!("with {} weights", own.weights.name()));
        return weights.into_iter().collect();
    }
    let (own, preset) = (Axes::of(&settings.splatting), Axes::of(&method.splatting));
    let pairs = own.named().into_iter().zip(preset.named()).filter(|(own, preset)| own != preset);
    pairs.map(|((axis, choice), _)| format!("--{axis} {choice}")).collect()
}

/// An engine with a loaded scene, ready for frames of one size.
pub trait LoadedEngine {
    /// Renders a frame and waits for it; `timed` records pass times, which may slow it down.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    fn frame(&mut self, camera: &Camera, settings: &Settings, timed: bool) -> Result<Vec<PassTime>>;

    /// Renders a frame with normals and depths, and reads it back.
    ///
    /// # Errors
    /// As [`Renderer::render_picture`].
    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture>;

    /// What measures the work of a frame.
    fn clock(&self) -> Clock;

    /// Memory of the last frame.
    fn memory(&self) -> Memory;

    /// The time of the last [`picture`](Self::picture), for an engine too slow to render more than one; otherwise none.
    fn time_of_picture(&self) -> Option<Time> {
        None
    }

    /// Traffic of the last frame's passes; empty if it is unknown.
    fn traffic(&self, _: &Camera, _: &Settings) -> Vec<PassTraffic> {
        Vec::new()
    }
}

/// A model on a Vulkan device, with one renderer for colour alone and one that adds normals and depths.
pub struct DeviceEngine {
    clock: Clock,
    scene: Rc<Scene>,
    /// Of the frames with colour alone.
    options: RenderOptions,
    colour_only: Renderer,
    with_depth: Renderer,
}

impl DeviceEngine {
    /// Renders `scene`, which other engines may render, too, with these options but for the images and the times.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(device: &Arc<Device>, scene: Rc<Scene>, options: RenderOptions) -> Result<Self> {
        let colour_only = RenderOptions { profile: true, ..options };
        let outputs = Outputs { normal: true, depth: true, id: false };
        let with_depth = RenderOptions { outputs, profile: false, ..colour_only };
        Ok(Self {
            clock: match device.capabilities().timestamps {
                _ if device.description().kind == DeviceDescription::CPU => Clock::Cpu,
                Some(_) => Clock::Gpu,
                None => Clock::Wall,
            },
            scene,
            options: colour_only,
            colour_only: Renderer::new(device, colour_only)?,
            with_depth: Renderer::new(device, with_depth)?,
        })
    }
}

impl LoadedEngine for DeviceEngine {
    fn frame(&mut self, camera: &Camera, settings: &Settings, timed: bool) -> Result<Vec<PassTime>> {
        self.colour_only.profile(timed);
        Ok(self.colour_only.render(&*self.scene, camera, settings)?.pass_times)
    }

    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        Ok(self.with_depth.render_picture(&*self.scene, camera, settings)?.0)
    }

    fn clock(&self) -> Clock {
        self.clock
    }

    fn memory(&self) -> Memory {
        Memory {
            scene: self.scene.bytes(),
            splats: self.colour_only.splat_bytes(),
            targets: self.colour_only.targets().iter().map(|target| target.bytes).sum(),
        }
    }

    fn traffic(&self, camera: &Camera, settings: &Settings) -> Vec<PassTraffic> {
        let (Some(rasterizer), Ok(projection)) = (self.colour_only.rasterizer(), camera.projection()) else {
            return Vec::new();
        };
        let options = RenderOptions { precision: self.colour_only.precision(), ..self.options };
        PassTraffic::of(&self.scene.streams(), projection.perspective, settings, &options, rasterizer)
    }
}

/// Surfels on the CPU, rendered by the baseline.
pub struct CpuEngine {
    baseline: Baseline,
    kind: Kind,
    size: [u32; 2],
}

impl CpuEngine {
    /// Copies `surfels`.
    ///
    /// # Errors
    /// As [`Baseline::new`].
    pub fn new(surfels: &Surfels, size: [u32; 2], kind: Kind) -> Result<Self> {
        Ok(Self { baseline: Baseline::new(surfels)?, kind, size })
    }
}

impl LoadedEngine for CpuEngine {
    fn frame(&mut self, camera: &Camera, settings: &Settings, _: bool) -> Result<Vec<PassTime>> {
        let outputs = Outputs::default();
        Ok(self.baseline.frame(self.kind, camera, self.size, settings, outputs)?.to_vec())
    }

    fn picture(&mut self, camera: &Camera, settings: &Settings) -> Result<Picture> {
        let outputs = Outputs { normal: true, depth: true, id: false };
        self.baseline.frame(self.kind, camera, self.size, settings, outputs)?;
        Ok(self.baseline.picture())
    }

    fn clock(&self) -> Clock {
        Clock::Cpu
    }

    fn memory(&self) -> Memory {
        let baseline::Memory { scene, splats, targets } = self.baseline.bytes();
        Memory { scene, splats, targets }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::splatting::{Filter, Footprint, Kernel, Splatting};

    fn named(splatting: Splatting) -> String {
        Engine::DEFAULT.implementation(&Settings { splatting, ..Default::default() }).label()
    }

    #[test]
    fn an_implementation_is_named_after_its_preset_or_the_nearest_with_its_changes() {
        for method in Method::ALL {
            let settings = method.settings();
            assert_eq!(Engine::DEFAULT.implementation_from(&method, &settings).label(), method.name);
            // Those as published that equal one of ours go by its name.
            let nearest = Engine::DEFAULT.implementation(&settings);
            assert!(Method::named(&nearest.method).is_some_and(|nearest| nearest.settings() == settings));
            assert_eq!(nearest.variant, "");
        }
        let default = Splatting::default();
        assert_eq!(named(Splatting { filter: Filter::None, ..default }), "perspective-ewa --filter none");
        let unfiltered = Method::named("sprites-unfiltered").unwrap().splatting;
        let squares = Splatting { footprint: Footprint::Square, ..unfiltered };
        assert_eq!(named(squares), "sprites-unfiltered --footprint square");
        let confetti = Method::named("confetti").unwrap().splatting;
        let wide = Splatting { kernel: Kernel::Confetti { a: 1.0, n: 2.0 }, ..confetti };
        assert_eq!(named(wide), "confetti --kernel confetti:1,2");
        let half = Engine::Splatting { rasterizer: Some(Rasterizer::Draw), precision: Precision::Half };
        let settings = Settings { splatting: squares, ..Default::default() };
        assert_eq!(half.implementation(&settings).variant, "--footprint square --rasterizer draw --half");
    }
}
