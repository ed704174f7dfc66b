//! Split view: the picture beneath the panels, or two pictures of the scene side by side.

use super::cached_view::{CachedView, ViewRequest};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, ValueRange};
use surfel::settings::Shading;
use surfel::vk::{Presented, Presenter};
use surfel::{FrameReport, RasterizerChoice, Result, Scene, Settings};

/// Renders the scene to one or two cached views and presents them.
pub struct SplitView {
    left: CachedView,
    /// The right picture; `None` until the view is split for the first time.
    right: Option<CachedView>,
    rasterizer: RasterizerChoice,
    options: FrameOptions,
    /// Whether the last frame rendered a picture, and whether that needed new resources.
    rendered: bool,
    created: bool,
}

/// Options of a frame.
#[derive(Clone, Default)]
pub struct FrameOptions {
    /// Whether pass times and counts are measured.
    pub profile: bool,
    /// Version of the scene's contents.
    pub version: u64,
    /// Settings of the right picture, and where it begins as part of the width, if the view is split.
    pub split: Option<(Settings, f64)>,
}

/// Reports of the pictures that the last frame rendered.
pub struct Reports {
    /// Report of the left or only picture.
    pub left: Option<FrameReport>,
    /// Report of the right picture.
    pub right: Option<FrameReport>,
}

impl SplitView {
    /// An empty view of the presenter's window.
    pub fn new(presenter: &Presenter, rasterizer: RasterizerChoice) -> Result<Self> {
        let left = CachedView::new(presenter, rasterizer)?;
        Ok(Self {
            left,
            right: None,
            rasterizer,
            options: FrameOptions::default(),
            rendered: false,
            created: false,
        })
    }

    /// Sets the options of the next frames.
    pub fn set_options(&mut self, options: FrameOptions, presenter: &Presenter) -> Result<()> {
        if options.split.is_some() && self.right.is_none() {
            self.right = Some(CachedView::new(presenter, self.rasterizer)?);
        }
        self.options = options;
        Ok(())
    }

    /// Records a frame of `scene`, if there is one.
    ///
    /// `area` is the width and height of the picture in the window, `size` those of what is rendered, both in px. After an error the picture is
    /// empty.
    pub fn record(
        &mut self,
        window: &Presented,
        (area, size): ([u32; 2], [u32; 2]),
        scene: Option<(&Arc<Scene>, &Camera, &Settings)>,
    ) -> Result<()> {
        let FrameOptions { profile, version, split } = self.options.clone();
        let request = scene.map(|(scene, camera, settings)| ViewRequest {
            scene: scene.clone(),
            camera: *camera,
            settings: settings.clone(),
            size,
            version,
            profile,
        });
        let mut recorded = self.left.record(window, request.as_ref());
        self.rendered = *recorded.as_ref().unwrap_or(&false);
        self.created = self.left.created_resources();
        let (right_settings, divider) = split.filter(|_| request.is_some()).unzip();
        let divider = divider.unwrap_or(1.0);
        if let Some(((request, settings), view)) = request.zip(right_settings).zip(self.right.as_mut()) {
            let right = view.record(window, Some(&ViewRequest { settings, ..request }));
            self.rendered |= *right.as_ref().unwrap_or(&false);
            self.created |= view.created_resources();
            recorded = recorded.and(right);
        }
        let right = self.right.as_ref().filter(|_| divider < 1.0);
        // The panel covers the rest of the window, but its edge may lie within a pixel.
        if area != window.size() || [Some(&self.left), right].into_iter().flatten().any(CachedView::is_empty)
        {
            window.clear();
        }
        self.left.present(window, area, [0.0, divider])?;
        if let Some(right) = right {
            right.present(window, area, [divider, 1.0])?;
        }
        recorded.map(drop)
    }

    /// Whether the last frame rendered a picture; otherwise it presented cached ones.
    pub fn rendered(&self) -> bool {
        self.rendered
    }

    /// Whether that needed new resources.
    pub fn created_resources(&self) -> bool {
        self.created
    }

    /// Shading and range of values of the left and of the right picture, where they show values.
    pub fn ranges(&self, presenter: &Presenter) -> Result<[Option<(Shading, ValueRange)>; 2]> {
        let right = self.right.as_ref().filter(|_| self.options.split.is_some());
        let right = right.map_or(Ok(None), |right| right.range(presenter))?;
        Ok([self.left.range(presenter)?, right])
    }

    /// Takes the reports of the last frame; `None` where it was not profiled.
    pub fn reports(&mut self, presenter: &Presenter) -> Result<Reports> {
        let right = self.right.as_mut().map_or(Ok(None), |right| right.report(presenter))?;
        Ok(Reports { left: self.left.report(presenter)?, right })
    }

    /// The surface point of the last frame at `at`, px in a picture of `size` px; `None` if there is none near it.
    pub fn surface_at(&self, at: DVec2, size: [u32; 2], presenter: &Presenter) -> Result<Option<DVec3>> {
        let depths = self.left.depths(presenter)?;
        Ok(depths.and_then(|depths| depths.surface_at(at / DVec2::from(size.map(f64::from)))))
    }
}
