//! The scene that is shown, its camera and its settings.

use super::MethodSettings;
use super::orbit::Orbit;
use super::source::Source;
use super::viewport::Viewport;
use std::sync::Arc;
use surfel::geometry::Pose;
use surfel::settings::methods::Method;
use surfel::{Scene, Settings};

/// The load that a scene comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneOrigin {
    /// Number of the load.
    pub load: u64,
    /// Whether the scene is a preview of it.
    pub preview: bool,
    /// Whether it reloads the inputs of the scene that is shown, which keeps its camera and its settings.
    pub reload: bool,
}

impl SceneOrigin {
    /// The origin of this load's preview.
    pub fn of_preview(self) -> Self {
        Self { preview: true, ..self }
    }
}

/// A scene, its camera and its settings.
pub struct SceneView {
    pub scene: Arc<Scene>,
    pub origin: SceneOrigin,
    /// What was shown before a preview, to return to if its load does not finish.
    pub before: Option<Box<SceneView>>,
    pub source: Source,
    pub orbit: Orbit,
    /// The orbit that frames the scene.
    pub framed: Orbit,
    /// A camera that was set, with the orbit and the viewport made of it. The scene is seen from exactly this pose until the user moves the camera.
    pub given: Option<(Orbit, Viewport, Pose)>,
    /// Method and settings when the scene came: what differs from these the user has changed.
    pub first: (Method, Settings),
    pub method: Method,
    pub settings: Settings,
}

impl SceneView {
    /// Method and settings of this view, if `scene` can be rendered with them; otherwise `default`.
    pub fn method_for(&self, scene: &Scene, default: (Method, Settings)) -> (Method, Settings) {
        if can_render(scene, &self.settings) { (self.method, self.settings.clone()) } else { default }
    }

    /// The camera that was set, if the user has not moved it since.
    pub fn given(&self, viewport: &Viewport) -> Option<Pose> {
        let unmoved = |(orbit, before, _): &(Orbit, Viewport, Pose)| {
            *orbit == self.orbit && Viewport { size: before.size, ..*viewport } == *before
        };
        self.given.filter(unmoved).map(|(.., pose)| pose)
    }

    /// Whether the user or a camera has moved the view away from the framed one.
    pub fn is_moved(&self) -> bool {
        self.given.is_some() || self.orbit != self.framed
    }

    /// Changes to the method that comes `steps` later in the list, or to the first after it that can render the scene, in the same steps; shading,
    /// background and α stay.
    pub fn step_method(&mut self, steps: usize, method_settings: &MethodSettings) {
        let (all, count) = (Method::ALL, Method::ALL.len());
        let now = all.iter().position(|method| method.name == self.method.name).unwrap_or(0);
        let next = (1..count).map(|number| all[(now + number * steps) % count]);
        let mut next = next.map(|method| (method, with_picture_of(method_settings(&method), &self.settings)));
        if let Some(next) = next.find(|(_, settings)| can_render(&self.scene, settings)) {
            (self.method, self.settings) = next;
        }
    }
}

/// `settings` with shading, its strengths, background and α of `before`.
pub fn with_picture_of(settings: Settings, before: &Settings) -> Settings {
    let Settings { shading, edl, ao, background, alpha, .. } = *before;
    Settings { shading, edl, ao, background, alpha, ..settings }
}

/// Whether a scene can be rendered with these settings.
pub fn can_render(scene: &Scene, settings: &Settings) -> bool {
    let streams = scene.streams();
    let weighted = settings.splatting.normalization.check_weights(streams.weights.is_some());
    settings.check_primitives(streams.primitives.any()).and(weighted).is_ok()
}
