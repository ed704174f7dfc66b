//! Which rasterizer is faster on a device: measured in pairs of frames, and kept by device and driver.

use super::renderer::{RenderOptions, Renderer};
use super::times::{Interval, Statistics};
use crate::error::Result;
use crate::geometry::Camera;
use crate::scene::Scene;
use crate::settings::{Rasterizer, RasterizerChoice, Settings};
use crate::vk::{Device, DeviceDescription};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Frames before those that are timed: the first creates pipelines and targets, and GPUs raise their clocks.
const WARMUP: usize = 2;

/// Times of frames by both rasterizers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RasterizerTimes {
    /// Median on the raster path, ms.
    pub draw: f64,
    /// Median on the compute path, ms.
    pub compute: f64,
    /// Time of a frame on the raster path relative to the next one on the compute path.
    pub ratios: Vec<f64>,
}

impl RasterizerTimes {
    /// Renders so many frames by each rasterizer, in turn, and waits for each. Fails if the device does not support the frame on either.
    pub fn measure(
        device: &Arc<Device>,
        scene: &Scene,
        camera: &Camera,
        settings: &Settings,
        (size, frames): ([u32; 2], usize),
    ) -> Result<Self> {
        let renderer = |rasterizer: Rasterizer| {
            Renderer::new(device, RenderOptions { size, rasterizer: rasterizer.into(), ..Default::default() })
        };
        let mut renderers = [renderer(Rasterizer::Draw)?, renderer(Rasterizer::Compute)?];
        let mut times = [Vec::new(), Vec::new()];
        for frame in 0..WARMUP + frames {
            for (renderer, times) in renderers.iter_mut().zip(&mut times) {
                let start = Instant::now();
                renderer.render(scene, camera, settings)?;
                if frame >= WARMUP {
                    times.push(start.elapsed().as_secs_f64() * 1e3);
                }
            }
        }
        let [draw, compute] = times.each_ref().map(|times| Statistics::of(times).unwrap_or_default().median);
        let ratios = times[0].iter().zip(&times[1]).map(|(draw, compute)| draw / compute).collect();
        Ok(Self { draw, compute, ratios })
    }

    /// Interval of the ratio.
    pub fn ratio(&self) -> Option<Interval> {
        Interval::of(&self.ratios)
    }

    /// Interval of the geometric mean of the ratios of several scenes or settings.
    pub fn mean_ratio(all: &[Self]) -> Option<Interval> {
        let rounds = all.iter().map(|times| times.ratios.len()).min()?;
        let mean = |round: usize| {
            let logarithms = all.iter().map(|times| times.ratios[round].ln());
            (logarithms.sum::<f64>() / all.len() as f64).exp()
        };
        Interval::of(&(0..rounds).map(mean).collect::<Vec<_>>())
    }
}

/// The faster rasterizer by the interval of raster time / compute time; `None` if it contains 1.
pub fn faster(ratio: &Interval) -> Option<Rasterizer> {
    if ratio.low > 1.0 {
        Some(Rasterizer::Compute)
    } else if ratio.high < 1.0 {
        Some(Rasterizer::Draw)
    } else {
        None
    }
}

/// Raster time / compute time of every measured device, by its name and driver.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
pub struct FasterRasterizers {
    devices: BTreeMap<String, Interval>,
}

impl FasterRasterizers {
    /// Adds a device, or replaces its former ratio.
    pub fn insert(&mut self, device: &DeviceDescription, ratio: Interval) {
        self.devices.insert(key(device), ratio);
    }

    /// The required rasterizer; without one, the faster on a device, if it was measured and there is one.
    pub fn choice(&self, required: Option<Rasterizer>, device: &DeviceDescription) -> RasterizerChoice {
        if let Some(required) = required {
            return RasterizerChoice::Require(required);
        }
        let measured = self.devices.get(&key(device));
        measured.and_then(faster).map_or(RasterizerChoice::Automatic, RasterizerChoice::Prefer)
    }
}

/// Another driver, or another version of it, may be faster by the other rasterizer.
fn key(device: &DeviceDescription) -> String {
    format!("{} | {}", device.name, device.driver)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(low: f64, high: f64) -> Interval {
        Interval { median: 0.5 * (low + high), low, high }
    }

    #[test]
    fn the_faster_rasterizer_is_outside_of_the_interval() {
        assert_eq!(faster(&interval(1.1, 1.3)), Some(Rasterizer::Compute));
        assert_eq!(faster(&interval(0.2, 0.9)), Some(Rasterizer::Draw));
        assert_eq!(faster(&interval(0.9, 1.1)), None);
    }

    #[test]
    fn rounds_of_several_scenes_are_averaged() {
        let times = |ratios: &[f64]| RasterizerTimes { ratios: ratios.to_vec(), ..Default::default() };
        let mean = RasterizerTimes::mean_ratio(&[times(&[4.0, 2.0, 9.0]), times(&[1.0, 0.5])]).unwrap();
        assert_eq!((mean.low, mean.median, mean.high), (1.0, 1.5, 2.0));
        assert_eq!(RasterizerTimes::mean_ratio(&[]), None);
        assert_eq!(RasterizerTimes::mean_ratio(&[times(&[])]), None);
    }

    #[test]
    fn another_driver_has_another_choice() {
        let device = |driver: &str| DeviceDescription {
            name: "GPU".into(),
            kind: "discrete GPU",
            driver: driver.into(),
            api_version: "1.3.0".into(),
            refused: None,
            score: 1,
        };
        let mut all = FasterRasterizers::default();
        all.insert(&device("a 1"), interval(0.5, 0.6));
        all.insert(&device("a 2"), interval(0.5, 1.6));
        assert_eq!(all.choice(None, &device("a 1")), RasterizerChoice::Prefer(Rasterizer::Draw));
        assert_eq!(all.choice(None, &device("a 2")), RasterizerChoice::Automatic);
        assert_eq!(all.choice(None, &device("a 3")), RasterizerChoice::Automatic);
        let required = RasterizerChoice::Require(Rasterizer::Compute);
        assert_eq!(all.choice(Some(Rasterizer::Compute), &device("a 1")), required);
        #[cfg(feature = "serde")]
        {
            let ratio = serde_json::json!({ "low": 0.5, "median": 1.0, "high": 1.5 });
            let mut one = FasterRasterizers::default();
            one.insert(&device("a 2"), interval(0.5, 1.5));
            assert_eq!(serde_json::to_value(&one).unwrap(), serde_json::json!({ "GPU | a 2": ratio }));
            let text = serde_json::to_string(&all).unwrap();
            assert_eq!(serde_json::from_str::<FasterRasterizers>(&text).unwrap(), all);
        }
        all.insert(&device("a 1"), interval(1.5, 1.6));
        assert_eq!(all.choice(None, &device("a 1")), RasterizerChoice::Prefer(Rasterizer::Compute));
    }
}
