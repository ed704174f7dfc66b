//! Cached view: an offscreen view that is re-rendered only when its inputs change.

use super::depths::Depths;
use std::sync::Arc;
use surfel::embed::OffscreenView;
use surfel::geometry::{Camera, ValueRange};
use surfel::settings::Shading;
use surfel::vk::{Presented, Presenter};
use surfel::{FrameReport, RasterizerChoice, Result, Scene, Settings};

/// An offscreen view, and the request that it shows.
pub struct CachedView {
    view: OffscreenView,
    /// The request of the picture in the view; `None` if there is no picture.
    drawn: Option<ViewRequest>,
    /// Whether the last picture needed new resources.
    created: bool,
}

/// Inputs of a picture.
#[derive(Clone)]
pub struct ViewRequest {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    pub settings: Settings,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Version of the scene's contents.
    pub version: u64,
    /// Whether pass times and counts are measured.
    pub profile: bool,
}

impl ViewRequest {
    /// Whether this picture needs no other resources than `other` did: those of every level of detail are the same.
    fn needs_only_resources_of(&self, other: &Self) -> bool {
        let settings = Settings { lod: other.settings.lod, ..self.settings.clone() };
        Arc::ptr_eq(&self.scene, &other.scene) && self.size == other.size && settings == other.settings
    }

    /// Whether the picture of `other` serves this request.
    fn is_served_by(&self, other: &Self) -> bool {
        let frame = |request: &Self| (request.camera, request.size, request.version);
        Arc::ptr_eq(&self.scene, &other.scene)
            && frame(self) == frame(other)
            && self.settings == other.settings
            && (other.profile || !self.profile)
    }
}

impl CachedView {
    /// An empty view of a window.
    pub fn new(presenter: &Presenter, rasterizer: RasterizerChoice) -> Result<Self> {
        Ok(Self { view: OffscreenView::new(presenter, rasterizer)?, drawn: None, created: false })
    }

    /// Whether the last picture needed new resources: it had another size, scene or settings than the one before.
    pub fn created_resources(&self) -> bool {
        self.created
    }

    /// Records the rendering of a picture unless the view already shows it; returns whether it was recorded. After an error the view is empty.
    pub fn record(&mut self, window: &Presented, request: Option<&ViewRequest>) -> Result<bool> {
        self.created = false;
        if request.zip(self.drawn.as_ref()).is_some_and(|(request, drawn)| request.is_served_by(drawn)) {
            return Ok(false);
        }
        let drawn = self.drawn.take();
        self.created = !request
            .zip(drawn.as_ref())
            .is_some_and(|(request, drawn)| request.needs_only_resources_of(drawn));
        let size = request.map_or(window.size(), |request| request.size);
        let inputs = request.map(|request| (&request.scene, &request.camera, &request.settings));
        self.view.draw(window, size, inputs, request.is_some_and(|request| request.profile))?;
        self.drawn = request.cloned();
        Ok(request.is_some())
    }

    /// Whether the view holds no picture, not even a background.
    pub fn is_empty(&self) -> bool {
        self.view.is_empty()
    }

    /// Records a copy of some columns to an area of the window.
    ///
    /// `area` is the width and height of the area, px from the window's top left; `columns` are two parts of the width, from 0 to 1.
    pub fn present(&self, window: &Presented, area: [u32; 2], columns: [f64; 2]) -> Result<()> {
        self.view.blit(window, area, columns)
    }

    /// Shading and range of values of the last picture, if it shows values.
    pub fn range(&self, presenter: &Presenter) -> Result<Option<(Shading, ValueRange)>> {
        let shading = self.drawn.as_ref().map(|drawn| drawn.settings.shading);
        Ok(shading.zip(self.view.range(presenter)?))
    }

    /// Takes the report of the last picture; `None` if it was not profiled or the report was taken.
    pub fn report(&mut self, presenter: &Presenter) -> Result<Option<FrameReport>> {
        self.view.report(presenter)
    }

    /// The depths of the last picture.
    pub fn depths(&self, presenter: &Presenter) -> Result<Option<Depths<'_>>> {
        let Some(drawn) = &self.drawn else { return Ok(None) };
        let depths = self.view.depths(presenter)?;
        Ok(depths.map(|(size, bytes)| Depths { camera: drawn.camera, size, bytes }))
    }
}
