//! A picture that is kept.

use std::path::Path;
use std::sync::Arc;
use surfel::formats::image::{Encoded, Output, write};
use surfel::geometry::Camera;
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Renderer, Result, Scene, Settings};

/// What is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScreenshotKind {
    /// The picture alone, as PNG.
    Picture,
    /// Its values, as EXR.
    Values,
    /// All that the window shows, as PNG.
    Window,
}

/// A picture that is not in its file yet.
pub enum Screenshot {
    Rendered { picture: Picture, shading: Shading, values: bool },
    Window(Encoded),
}

impl Screenshot {
    /// The whole picture of `size` px: what `surfel render` writes.
    pub fn render(
        device: &Arc<Device>,
        scene: &Scene,
        (camera, settings): (&Camera, &Settings),
        (size, rasterizer): ([u32; 2], Option<Rasterizer>),
        values: bool,
    ) -> Result<Self> {
        let outputs = Outputs::default().with_mask(settings);
        let options = RenderOptions { size, outputs, rasterizer, ..Default::default() };
        let (mut picture, _) = Renderer::new(device, options)?.render_picture(scene, camera, settings)?;
        if values {
            // They were rendered for a PNG's sake alone.
            (picture.normal, picture.depth) = (None, None);
        }
        Ok(Self::Rendered { picture, shading: settings.shading, values })
    }

    /// What a window of `size` px shows.
    pub fn of_window(size: [u32; 2], mut pixels: Vec<[u8; 4]>) -> Result<Self> {
        pixels.iter_mut().for_each(|pixel| pixel[3] = 255);
        Encoded::new(size, pixels).map(Self::Window)
    }

    pub fn extension(&self) -> &'static str {
        match self {
            Self::Rendered { values: true, .. } => "exr",
            Self::Rendered { .. } | Self::Window(_) => "png",
        }
    }

    pub fn write(self, path: &Path) -> Result<()> {
        let out = Output::File(path.to_owned());
        match self {
            Self::Rendered { picture, shading, .. } => write(&picture, shading, &out),
            Self::Window(encoded) => encoded.write_png(&out),
        }
    }
}
