//! A picture of a scene before the window has it. It is drawn anew only where something else is to be seen.

use std::sync::Arc;
use surfel::embed::OffscreenView;
use surfel::geometry::{Camera, ValueRange};
use surfel::settings::Shading;
use surfel::vk::{Presented, Presenter};
use surfel::{FrameReport, Rasterizer, Result, Scene, Settings};

/// One picture of the window.
pub struct Side {
    view: OffscreenView,
    /// What it shows.
    drawn: Option<Seen>,
    /// Whether things had to be made for that.
    made: bool,
}

/// What is to be seen.
#[derive(Clone)]
pub struct Seen {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    pub settings: Settings,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Another for the same scene with other contents.
    pub version: u64,
    /// Whether the frame tells its times and counts.
    pub measured: bool,
}

impl Seen {
    /// Whether what another picture needed is all that this one needs.
    fn needs_what(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene) && self.size == other.size && self.settings == other.settings
    }

    fn is_as(&self, other: &Self) -> bool {
        let frame = |seen: &Self| (seen.camera, seen.size, seen.version);
        Arc::ptr_eq(&self.scene, &other.scene)
            && frame(self) == frame(other)
            && self.settings == other.settings
            && (other.measured || !self.measured)
    }
}

impl Side {
    pub fn new(presenter: &Presenter, rasterizer: Option<Rasterizer>) -> Result<Self> {
        Ok(Self { view: OffscreenView::new(presenter, rasterizer)?, drawn: None, made: false })
    }

    /// Whether things had to be made for the last picture: it was of another size or scene than the one before, or otherwise rendered.
    pub fn made(&self) -> bool {
        self.made
    }

    /// Records the picture, unless it is there; whether it was not. After an error it is empty.
    pub fn record(&mut self, window: &Presented, seen: Option<&Seen>) -> Result<bool> {
        self.made = false;
        let same = seen.zip(self.drawn.as_ref()).is_some_and(|(seen, drawn)| seen.is_as(drawn));
        if same {
            return Ok(false);
        }
        let drawn = self.drawn.take();
        self.made = !seen.zip(drawn.as_ref()).is_some_and(|(seen, drawn)| seen.needs_what(drawn));
        let size = seen.map_or(window.size(), |seen| seen.size);
        let shown = seen.map(|seen| (&seen.scene, &seen.camera, &seen.settings));
        self.view.draw(window, size, shown, seen.is_some_and(|seen| seen.measured))?;
        self.drawn = seen.cloned();
        Ok(seen.is_some())
    }

    /// Whether there is nothing to show, not even a background.
    pub fn is_empty(&self) -> bool {
        self.view.is_empty()
    }

    /// Shows the columns between two parts of the width in an area of the window, px from its top left.
    pub fn show(&self, window: &Presented, area: [u32; 2], columns: [f64; 2]) -> Result<()> {
        self.view.show(window, area, columns)
    }

    /// What numbers the last picture shows, if it shows some, and the least and the greatest of them.
    pub fn range(&self, presenter: &Presenter) -> Result<Option<(Shading, ValueRange)>> {
        let shading = self.drawn.as_ref().map(|drawn| drawn.settings.shading);
        Ok(shading.zip(self.view.range(presenter)?))
    }

    /// What the last picture tells, once; `None` where it was not measured.
    pub fn report(&mut self, presenter: &Presenter) -> Result<Option<FrameReport>> {
        self.view.report(presenter)
    }

    /// Width and height, and the depths row by row, of the last picture.
    pub fn depths(&self, presenter: &Presenter) -> Result<Option<([u32; 2], &[u8])>> {
        self.view.depths(presenter)
    }
}
