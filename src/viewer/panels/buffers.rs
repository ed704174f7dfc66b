//! What frames are made of, as pictures: depths, normals, weights, levels of the pyramid.

use super::raster::{Raster, Values};
use crate::viewer::state::Choices;
use egui::{Button, ComboBox, Context, Slider, Ui};
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Outputs, PyramidLevel, RenderOptions, Renderer, Result, Settings};

/// What can be looked at.
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
            Self::Depth => ["depth", "distance from the eye along the view, in the positions' unit"],
            Self::Normal => {
                ["normal", "unit normal in world space: x, y, z from −1 to 1 as red, green, blue"]
            }
            Self::Weight => ["weight", "the sum of the splats' weights, which normalization divides by"],
            Self::Overlap => ["overlap", "how many splats are blended"],
            Self::Pulled => [
                "pulled level",
                "distances of a level of the pyramid, as they were pulled from the finer one",
            ],
            Self::Pushed => [
                "pushed level",
                "distances of a level of the pyramid, with holes filled from the coarser one",
            ],
        }
    }

    fn is_level(self) -> bool {
        matches!(self, Self::Pulled | Self::Pushed)
    }
}

/// The section, and what was read.
#[derive(Default)]
pub struct Buffers {
    buffer: Buffer,
    level: u32,
    wrong: Option<String>,
    shown: bool,
    raster: Option<Raster>,
    /// Of which picture it was read.
    of: Option<(Camera, Settings, Buffer, u32)>,
}

impl Buffers {
    /// What can be read, and a button that does.
    pub fn show(&mut self, ui: &mut Ui, chosen: &Choices<'_>, device: &Arc<Device>) {
        let all = if chosen.settings.pull_push.is_some() { Buffer::PYRAMIDS } else { Buffer::SPLATS };
        if !all.contains(&self.buffer) {
            self.buffer = Buffer::Depth;
        }
        let shown =
            ComboBox::from_label("buffer").selected_text(self.buffer.name_and_help()[0]).show_ui(ui, |ui| {
                for buffer in all {
                    let [name, text] = buffer.name_and_help();
                    ui.selectable_value(&mut self.buffer, buffer, name).on_hover_text(text);
                }
            });
        shown.response.on_hover_text(self.buffer.name_and_help()[1]);
        ui.weak(self.buffer.name_and_help()[1]);
        if self.buffer.is_level() {
            let top = chosen.size[0].max(chosen.size[1]).next_power_of_two().trailing_zeros();
            ui.add(Slider::new(&mut self.level, 0..=top).text("level"))
                .on_hover_text("0 has the picture's pixels, each further one a quarter of them.");
        }
        let Some(Ok(camera)) = &chosen.camera else { return };
        let of = (*camera, chosen.settings.clone(), self.buffer, self.level);
        let old = self.shown && self.of.as_ref() != Some(&of);
        let text = if old { "Read back again: an earlier picture is shown" } else { "Read back" };
        if ui
            .add(Button::new(text))
            .on_hover_text("Renders the picture once more, whole, and reads it back.")
            .clicked()
        {
            match self.read(chosen, *camera, device) {
                Ok(raster) => {
                    (self.raster, self.shown, self.wrong, self.of) = (Some(raster), true, None, Some(of))
                }
                Err(error) => self.wrong = Some(error.to_string()),
            }
        }
        if let Some(wrong) = &self.wrong {
            ui.colored_label(ui.visuals().error_fg_color, wrong);
        }
    }

    /// Nothing is kept that belongs to a context that goes.
    pub fn release_textures(&mut self) {
        self.raster.iter_mut().for_each(Raster::release_textures);
    }

    /// Closes the picture of a buffer, if it is there.
    pub fn close(&mut self) -> bool {
        self.raster.is_some() && std::mem::take(&mut self.shown)
    }

    /// What was read, in a window of its own.
    pub fn picture(&mut self, context: &Context) {
        if let Some(raster) = self.raster.as_mut().filter(|_| self.shown) {
            raster.show(context, "buffer", &mut self.shown);
        }
    }

    fn read(&self, chosen: &Choices<'_>, camera: Camera, device: &Arc<Device>) -> Result<Raster> {
        let outputs =
            Outputs { normal: self.buffer == Buffer::Normal, depth: self.buffer == Buffer::Depth, id: false };
        let options =
            RenderOptions { size: chosen.size, outputs, rasterizer: chosen.rasterizer, ..Default::default() };
        let shading = match self.buffer {
            Buffer::Weight => Shading::Weight,
            Buffer::Overlap => Shading::Overlap,
            _ => chosen.settings.shading,
        };
        let settings = Settings { shading, background: None, ..chosen.settings.clone() };
        let mut renderer = Renderer::new(device, options)?;
        let (picture, _) = renderer.render_picture(chosen.scene, &camera, &settings)?;
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

/// The distances of a level's samples.
fn distances(name: &str, level: &PyramidLevel) -> Raster {
    let distance =
        |sample: &Option<_>| sample.as_ref().map_or(f32::NAN, |sample: &surfel::PyramidSample| sample.depth);
    Raster::new(name, level.size, Values::Numbers(level.samples.iter().map(distance).collect()))
}
