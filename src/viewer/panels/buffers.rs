//! Buffers panel: reads back intermediate buffers and shows them as pictures.

use super::raster::{Raster, RasterWindow, Values};
use super::widgets::combo;
use crate::viewer::choices::{Choices, PictureContent};
use egui::{Button, Slider, Ui};
use std::sync::Arc;
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Outputs, PyramidLevel, RenderOptions, Renderer, Result, Settings};

/// A buffer that can be shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Buffer {
    #[default]
    Depth,
    Normal,
    Weight,
    Overlap,
    Pulled,
    Pushed,
}

impl Buffer {
    const SPLATS: [Self; 4] = [Self::Depth, Self::Normal, Self::Weight, Self::Overlap];
    const PYRAMIDS: [Self; 4] = [Self::Depth, Self::Normal, Self::Pulled, Self::Pushed];

    fn name_and_help(self) -> [&'static str; 2] {
        match self {
            Self::Depth => ["depth", "Distance from the eye along the view, in the positions' unit."],
            Self::Normal => {
                ["normal", "Unit normal in world space: x, y, z from −1 to 1 as red, green, blue."]
            }
            Self::Weight => ["weight", "Sum of the splats' weights, by which normalization divides."],
            Self::Overlap => ["overlap", "Number of splats that are blended."],
            Self::Pulled => ["pulled level", "Distances of a pyramid level, pulled from the finer level."],
            Self::Pushed => {
                ["pushed level", "Distances of a pyramid level, with holes filled from the coarser level."]
            }
        }
    }

    fn is_level(self) -> bool {
        matches!(self, Self::Pulled | Self::Pushed)
    }
}

/// The panel, and the buffer that was read back.
#[derive(Default)]
pub struct Buffers {
    buffer: Buffer,
    level: u32,
    error: Option<String>,
    pub(super) window: RasterWindow,
    /// The picture that the buffer belongs to.
    read_for: Option<(PictureContent, Buffer, u32)>,
}

impl Buffers {
    /// Shows the choice of a buffer and the button that reads it back.
    pub fn show(&mut self, ui: &mut Ui, choices: &Choices<'_>, device: &Arc<Device>) {
        let all = if choices.settings.pull_push.is_some() { Buffer::PYRAMIDS } else { Buffer::SPLATS };
        if !all.contains(&self.buffer) {
            self.buffer = Buffer::Depth;
        }
        let [name, help] = self.buffer.name_and_help();
        combo(ui, "buffer", name, help, |ui| {
            for buffer in all {
                let [name, text] = buffer.name_and_help();
                ui.selectable_value(&mut self.buffer, buffer, name).on_hover_text(text);
            }
        });
        ui.weak(self.buffer.name_and_help()[1]);
        if self.buffer.is_level() {
            let top = choices.size[0].max(choices.size[1]).next_power_of_two().trailing_zeros();
            ui.add(Slider::new(&mut self.level, 0..=top).text("level")).on_hover_text(
                "Level 0 has the resolution of the picture, each further level a quarter of its pixels.",
            );
        }
        let Some(content) = choices.content() else { return };
        let key = (content, self.buffer, self.level);
        let old = self.window.open && self.read_for.as_ref() != Some(&key);
        let text = if old { "Read back again: an earlier picture is shown" } else { "Read back" };
        if ui
            .add(Button::new(text))
            .on_hover_text(
                "Renders the picture that the window shows at rest again and reads the buffer back.",
            )
            .clicked()
        {
            match self.read(choices, &key.0, device) {
                Ok(raster) => {
                    self.window = RasterWindow { raster: Some(raster), open: true };
                    (self.error, self.read_for) = (None, Some(key));
                }
                Err(error) => self.error = Some(error.to_string()),
            }
        }
        if let Some(error) = &self.error {
            ui.colored_label(ui.visuals().error_fg_color, error);
        }
    }

    /// Renders the picture and reads the buffer back.
    fn read(&self, choices: &Choices<'_>, content: &PictureContent, device: &Arc<Device>) -> Result<Raster> {
        let outputs =
            Outputs { normal: self.buffer == Buffer::Normal, depth: self.buffer == Buffer::Depth, id: false };
        let options = RenderOptions {
            size: content.size,
            outputs,
            rasterizer: choices.rasterizer,
            split: self.buffer.is_level(),
            ..Default::default()
        };
        let shading = match self.buffer {
            Buffer::Weight => Shading::Weight,
            Buffer::Overlap => Shading::Overlap,
            _ => content.settings.shading,
        };
        let settings = Settings { shading, background: None, ..content.settings.clone() };
        let mut renderer = Renderer::new(device, options)?;
        let (picture, _) = renderer.render_picture(choices.scene, &content.camera, &settings)?;
        let name = self.buffer.name_and_help()[0];
        let pyramids = if self.buffer.is_level() { renderer.read_pyramids()? } else { None };
        if let Some([pulled, pushed]) = pyramids {
            let levels = if self.buffer == Buffer::Pulled { pulled } else { pushed };
            let level = (self.level as usize).min(levels.len().saturating_sub(1));
            return Ok(distances(&format!("{name} {level}: distance"), &levels[level]));
        }
        let values = match self.buffer {
            Buffer::Normal => Values::Directions(picture.normal.unwrap_or_default()),
            Buffer::Depth => {
                let depths = picture.depth.unwrap_or_default();
                Values::Numbers(depths.into_iter().map(|z| if z == 0.0 { f32::NAN } else { z }).collect())
            }
            _ => {
                let number = |[value, _, _, a]: &[f32; 4]| if *a == 0.0 { f32::NAN } else { *value };
                Values::Numbers(picture.colour.iter().map(number).collect())
            }
        };
        Ok(Raster::new(name, picture.size, values))
    }
}

/// The distances of a pyramid level's samples.
fn distances(name: &str, level: &PyramidLevel) -> Raster {
    let distance =
        |sample: &Option<_>| sample.as_ref().map_or(f32::NAN, |sample: &surfel::PyramidSample| sample.depth);
    Raster::new(name, level.size, Values::Numbers(level.samples.iter().map(distance).collect()))
}
