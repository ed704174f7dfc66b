//! What the panels let the user choose.

use super::MethodSettings;
use super::quality::Quality;
use super::scene_view::{can_render, with_picture_of};
use super::source::Source;
use std::sync::{Arc, Weak};
use surfel::formats::Filter;
use surfel::geometry::Camera;
use surfel::settings::methods::Method;
use surfel::{RasterizerChoice, Result, Scene, Settings};

/// What the panels let the user choose, and what that depends on.
pub struct Choices<'a> {
    pub method: &'a mut Method,
    pub settings: &'a mut Settings,
    pub source: &'a mut Source,
    /// Which points of the files are read; a change loads them again.
    pub filter: &'a mut Filter,
    pub parallel: &'a mut bool,
    /// Whether a legend tells what the picture's colours mean.
    pub legend: &'a mut bool,
    pub surfels: u64,
    /// Whether the scene is a preview.
    pub preview: bool,
    /// Whether the scene has lines or triangles.
    pub primitives: bool,
    /// Whether the surfels have normalization weights.
    pub weighted: bool,
    pub scene: &'a Arc<Scene>,
    /// Version of the scene's contents.
    pub version: u64,
    pub camera: Option<Result<Camera>>,
    /// Width and height of the window's picture, px.
    pub size: [u32; 2],
    pub rasterizer: RasterizerChoice,
    pub method_settings: &'a MethodSettings,
}

/// What determines a picture of full quality: with the same content the picture is the same.
#[derive(Clone)]
pub struct PictureContent {
    /// Tells scenes apart without keeping them.
    scene: Weak<Scene>,
    version: u64,
    pub camera: Camera,
    pub settings: Settings,
    /// Width and height, px.
    pub size: [u32; 2],
}

impl PartialEq for PictureContent {
    fn eq(&self, other: &Self) -> bool {
        Weak::ptr_eq(&self.scene, &other.scene)
            && (self.version, self.camera, self.size) == (other.version, other.camera, other.size)
            && self.settings == other.settings
    }
}

impl Choices<'_> {
    /// The content of the window's picture at full quality; `None` if there is no camera for it.
    pub fn content(&self) -> Option<PictureContent> {
        let Some(Ok(camera)) = &self.camera else { return None };
        Some(PictureContent {
            scene: Arc::downgrade(self.scene),
            version: self.version,
            camera: *camera,
            settings: Quality::FULL.settings(self.settings),
            size: self.size,
        })
    }

    /// Changes the method; shading, background and α stay.
    pub fn choose(&mut self, method: Method) {
        *self.settings = self.settings_of(&method);
        *self.method = method;
    }

    /// Whether the scene can be rendered with these settings.
    pub fn can_render(&self, settings: &Settings) -> bool {
        can_render(self.scene, settings)
    }

    /// The settings of a method with the present shading, background and α.
    pub fn settings_of(&self, method: &Method) -> Settings {
        with_picture_of((self.method_settings)(method), self.settings)
    }
}
