//! What the panels let the user choose.

use super::MethodSettings;
use super::scene_view::with_picture_of;
use super::source::Source;
use std::sync::Arc;
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
    /// Whether the scene has lines or triangles.
    pub primitives: bool,
    /// Whether the surfels have normalization weights.
    pub weighted: bool,
    pub scene: &'a Arc<Scene>,
    pub camera: Option<Result<Camera>>,
    /// Width and height of the window's picture, px.
    pub size: [u32; 2],
    pub rasterizer: RasterizerChoice,
    pub method_settings: &'a MethodSettings,
}

impl Choices<'_> {
    /// Changes the method; shading, background and α stay.
    pub fn choose(&mut self, method: Method) {
        *self.settings = self.settings_of(&method);
        *self.method = method;
    }

    /// The settings of a method with the present shading, background and α.
    pub fn settings_of(&self, method: &Method) -> Settings {
        with_picture_of((self.method_settings)(method), self.settings)
    }
}
