//! Screenshot: a picture to be saved.

use std::path::Path;
use std::sync::Arc;
use surfel::formats::colour_bar::{ColourBar, write_with};
use surfel::formats::image::{Encoded, Output};
use surfel::geometry::Camera;
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Outputs, Picture, RasterizerChoice, RenderOptions, Renderer, Result, Scene, Settings};

/// What a screenshot shows, and its file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScreenshotKind {
    /// The picture alone, as PNG.
    Picture,
    /// The values of the picture, as EXR.
    Values,
    /// The window with its panels, as PNG.
    Window,
}

/// A picture to be saved.
pub enum Screenshot {
    Rendered { picture: Picture, shading: Shading, values: bool, bar: Option<ColourBar> },
    Window(Encoded),
}

impl Screenshot {
    /// Renders the picture of `size` px as `surfel render` writes it.
    pub fn render(
        device: &Arc<Device>,
        scene: &Scene,
        (camera, settings): (&Camera, &Settings),
        (size, rasterizer): ([u32; 2], RasterizerChoice),
        values: bool,
    ) -> Result<Self> {
        let outputs = Outputs::default().with_mask(settings);
        let options = RenderOptions { size, outputs, rasterizer, ..Default::default() };
        let (mut picture, _) = Renderer::new(device, options)?.render_picture(scene, camera, settings)?;
        if values {
            // The PNG alone needs them, for its mask.
            (picture.normal, picture.depth) = (None, None);
        }
        Ok(Self::Rendered { picture, shading: settings.shading, values, bar: None })
    }

    /// The screenshot with a colour bar, where `surfel render` draws one.
    pub fn with_bar(mut self, new: Option<ColourBar>, size: [u32; 2]) -> Self {
        if let Self::Rendered { shading, values: false, bar, .. } = &mut self {
            *bar = new.filter(|_| shading.is_coloured() && ColourBar::check(size).is_ok());
        }
        self
    }

    /// A screenshot of a window of `size` px.
    pub fn of_window(size: [u32; 2], mut pixels: Vec<[u8; 4]>) -> Result<Self> {
        pixels.iter_mut().for_each(|pixel| pixel[3] = 255);
        Encoded::new(size, pixels).map(Self::Window)
    }

    /// Extension of the file.
    pub fn extension(&self) -> &'static str {
        match self {
            Self::Rendered { values: true, .. } => "exr",
            Self::Rendered { .. } | Self::Window(_) => "png",
        }
    }

    /// Writes the file.
    pub fn write(self, path: &Path) -> Result<()> {
        let out = Output::File(path.to_owned());
        match self {
            Self::Rendered { picture, shading, bar, .. } => write_with(&picture, shading, bar.as_ref(), &out),
            Self::Window(encoded) => encoded.write_png(&out),
        }
    }
}
