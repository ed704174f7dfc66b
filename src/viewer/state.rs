//! View state: the scene that is shown, its camera and its settings; everything that the user changes.

use super::choices::Choices;
use super::directions::Up;
use super::keys::Action;
use super::open_dialog::{DialogResult, OpenDialog};
use super::orbit::Orbit;
use super::quality::{Quality, Workload};
use super::saved_settings::SavedSettings;
use super::scene_view::{SceneOrigin, SceneView, can_render};
use super::source::Source;
use super::viewport::Viewport;
use super::{MethodSettings, Options, appearance::SavedAppearance};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use surfel::formats::Filter;
use surfel::formats::colour_bar::ColourBar;
use surfel::geometry::{Camera, Extent, MostDrawn, Pose};
use surfel::load::colour_bar;
use surfel::settings::methods::Method;
use surfel::settings::{Choice, Shading};
use surfel::thousands;
use surfel::vk::Device;
use surfel::{RasterizerChoice, Result, Scene, Settings};

/// The scene that is shown, its camera and its settings.
pub struct ViewState {
    pub viewport: Viewport,
    up: Up,
    method_settings: MethodSettings,
    pub rasterizer: RasterizerChoice,
    /// Method and settings saved by the last run, until the first scene that can be rendered with them.
    start: Option<(Method, Settings)>,
    /// What the next window starts with, without the changes of the scene that is shown.
    to_save: SavedSettings,
    /// Version of the scene's contents; rises with every change.
    version: u64,
    view: Option<SceneView>,
    /// Method, settings and appearance of the scene that was lost with its device.
    lost: Option<(Method, Settings, SavedAppearance)>,
    /// Position of a double click, px, whose surface becomes the pivot.
    pub pick: Option<DVec2>,
    /// The surface point that was picked last, world space.
    picked: Option<DVec3>,
    /// The dialog to open a file, while it is open, and its result.
    pub dialog: Option<OpenDialog>,
    pub dialog_result: Option<DialogResult>,
    /// Whether the user cancels loading.
    pub cancel: bool,
    /// Whether a legend tells what the picture's colours mean.
    pub legend: bool,
    /// Which points of the scene's files the user wants.
    pub filter: Filter,
}

/// A scene or a level of detail, its camera and its settings.
type FrameInputs<'a> = (&'a Arc<Scene>, Camera, Settings);

impl ViewState {
    /// The state of an empty window, which starts with the settings of the last one.
    pub fn new(options: &Options, method_settings: MethodSettings, saved: SavedSettings) -> Self {
        let viewport = Viewport { size: options.size, fov_y_deg: options.fov_y_deg, parallel: false };
        Self {
            viewport,
            up: nearest_axis(DVec3::Y),
            method_settings,
            rasterizer: options.rasterizer.into(),
            start: saved.settings().filter(|_| !options.method_chosen),
            legend: saved.legend,
            to_save: saved,
            version: 0,
            view: None,
            lost: None,
            pick: None,
            picked: None,
            dialog: None,
            dialog_result: None,
            cancel: false,
            filter: options.filter.clone(),
        }
    }

    /// Shows the scene of a load, framed from the front. The scene after its preview, and a reloaded one, keep camera, settings and appearance.
    pub fn set_scene(
        &mut self,
        scene: Arc<Scene>,
        (method, mut source): (Method, Source),
        origin: SceneOrigin,
    ) {
        self.keep_changes();
        // A scene after its preview, and a reloaded one, keep what the user has chosen.
        let is_new =
            !origin.reload && self.view.as_ref().is_none_or(|view| view.origin != origin.of_preview());
        if is_new {
            (self.up, self.picked) = (nearest_axis(source.up()), None);
        }
        let framed = Orbit::framing(source.extent(), self.up, &self.viewport);
        let given = None;
        let lost = self.lost.take().map(|(method, settings, appearance)| {
            source.restore(&appearance);
            (method, settings)
        });
        let (method, settings) = lost.unwrap_or_else(|| {
            let saved = self.start.take_if(|saved| can_render(&scene, &saved.1));
            let (method, settings) = saved.unwrap_or_else(|| (method, (self.method_settings)(&method)));
            (method, source.shaded(settings))
        });
        if !origin.preview {
            self.start = None;
        }
        self.view = Some(match self.view.take() {
            Some(preview) if preview.origin == origin.of_preview() => {
                let orbit = if preview.is_moved() { preview.orbit } else { framed };
                source.restore(&preview.source.saved_appearance());
                let (method, settings) = preview.method_for(&scene, (method, settings));
                let settings = source.shaded(settings);
                let before = None;
                let first = (method, settings.clone());
                SceneView { scene, source, origin, orbit, framed, before, first, method, settings, ..preview }
            }
            Some(view) if origin.reload && !view.origin.preview => {
                source.restore(&view.source.saved_appearance());
                let (method, settings) = view.method_for(&scene, (method, settings));
                let first = (method, settings.clone());
                SceneView { scene, source, origin, first, method, settings, ..view }
            }
            before => {
                // Before a preview, the last whole scene is kept.
                let whole = |view: SceneView| {
                    if view.origin.preview { view.before } else { Some(Box::new(view)) }
                };
                let before = before.filter(|_| origin.preview).and_then(whole);
                let orbit = framed;
                let first = (method, settings.clone());
                SceneView { scene, source, origin, before, orbit, framed, given, first, method, settings }
            }
        });
    }

    /// The settings, if a scene is shown.
    pub fn settings(&self) -> Option<&Settings> {
        self.view.as_ref().map(|view| &view.settings)
    }

    /// Keeps for the next window what the user has changed since the scene is shown.
    fn keep_changes(&mut self) {
        let Some(SceneView { first, method, settings, .. }) = &self.view else { return };
        let given = (self.method_settings)(method);
        self.to_save = self.to_save.with_changes((first.0, &first.1), (*method, settings), &given);
    }

    /// What the next window starts with.
    pub fn settings_to_save(&mut self, panel_hidden: bool) -> SavedSettings {
        self.keep_changes();
        let mut saved = self.to_save.clone();
        (saved.panel_hidden, saved.legend) = (panel_hidden, self.legend);
        saved
    }

    /// Version of the scene's contents.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Applies the appearance that the user wants to the scene. A change drops the levels of detail, which do not have it.
    pub fn apply(&mut self, device: &Arc<Device>) -> Result<()> {
        let Some(SceneView { scene, source, .. }) = &mut self.view else { return Ok(()) };
        if source.apply(scene, device)? {
            self.version += 1;
        }
        Ok(())
    }

    /// The source to build levels of detail from, if a whole scene is shown that has none.
    pub fn without_levels(&self) -> Option<Source> {
        let view =
            self.view.as_ref().filter(|view| !view.origin.preview && view.scene.level_table().is_none())?;
        Some(view.source.snapshot())
    }

    /// Whether the user has moved the camera before a preview of this load.
    pub fn has_moved_preview(&self, load: u64) -> bool {
        let preview =
            self.view.as_ref().filter(|view| (view.origin.load, view.origin.preview) == (load, true));
        preview.is_some_and(|view| view.given(&self.viewport).is_none())
    }

    /// Drops the scene, whose device is lost. If the next scene is the `same`, it keeps settings and appearance; returns its camera then.
    pub fn leave_device(&mut self, same: bool) -> Option<Pose> {
        self.keep_changes();
        let pose = self.pose().filter(|_| same);
        let lost = self.view.take().filter(|_| same);
        let lost = lost.map(|view| (view.method, view.settings, view.source.saved_appearance()));
        self.lost = lost.or(self.lost.take());
        pose
    }

    /// Sets the camera; its target becomes the pivot.
    pub fn set_pose(&mut self, pose: Pose) {
        let Self { view: Some(view), viewport, .. } = self else { return };
        view.orbit = Orbit::of(&pose, view.orbit.up(), viewport);
        view.given = Some((view.orbit, *viewport, pose));
    }

    /// Returns from a preview to what was shown before it.
    pub fn leave_preview(&mut self) {
        if let Some(SceneView { before, .. }) = self.view.take_if(|view| view.origin.preview) {
            self.view = before.map(|before| *before);
        }
    }

    /// Replaces the scene by the same one with levels of detail.
    pub fn set_levels(&mut self, scene: Arc<Scene>) {
        if let Some(view) = &mut self.view {
            view.scene = scene;
        }
    }

    /// The scene and its settings.
    pub fn scene_and_settings(&self) -> Option<(Arc<Scene>, Settings)> {
        self.view.as_ref().map(|view| (view.scene.clone(), view.settings.clone()))
    }

    /// What a frame of full quality renders, for adaptive resolution.
    pub fn workload(&self) -> Option<Workload> {
        let (scene, camera, _) = self.frame(Quality::FULL)?.ok()?;
        let [width, height] = self.viewport.size.map(f64::from);
        let drawn = scene.most_drawn(&camera, self.viewport.size);
        let levels = MostDrawn::lods().map(|lod| (lod.into(), drawn.at(lod) as f64));
        Some(Workload::new(width * height, levels))
    }

    /// Whether a whole scene is shown.
    pub fn is_whole(&self) -> bool {
        self.view.as_ref().is_some_and(|view| !view.origin.preview)
    }

    /// Whether a preview is shown.
    pub fn is_preview(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.origin.preview)
    }

    /// The camera.
    pub fn pose(&self) -> Option<Pose> {
        let view = self.view.as_ref()?;
        Some(view.given(&self.viewport).unwrap_or_else(|| view.orbit.pose(&self.viewport)))
    }

    /// The inputs of a frame of a quality.
    pub fn frame(&self, quality: Quality) -> Option<Result<FrameInputs<'_>>> {
        let SceneView { scene, settings, source, .. } = self.view.as_ref()?;
        let camera = self.pose()?.camera(&source.extent().bounds(), self.viewport.aspect());
        Some(camera.map(|camera| (scene, camera, quality.settings(settings))))
    }

    /// The orbit, for the user to move, with the viewport and what a camera frames.
    pub fn orbit_mut(&mut self) -> Option<(&mut Orbit, &Viewport, &Extent)> {
        let Self { view: Some(SceneView { orbit, source, .. }), viewport, .. } = self else { return None };
        Some((orbit, viewport, source.extent()))
    }

    /// Zooms by steps of the wheel towards the position `at`, px, where there may be a surface point.
    pub fn zoom(&mut self, steps: f64, at: DVec2, surface: Option<DVec3>) {
        if let Some((orbit, viewport, extent)) = self.orbit_mut() {
            orbit.zoom(steps, at, surface, viewport, &extent.bounds());
        }
    }

    /// Makes a point the pivot; the picture stays. Returns the distance of the point that was picked before, if there is one in this scene.
    pub fn pick_point(&mut self, point: DVec3) -> Option<f64> {
        if let Some((orbit, viewport, _)) = self.orbit_mut() {
            orbit.set_pivot(point, viewport);
        }
        self.picked.replace(point).map(|before| before.distance(point))
    }

    /// A number of decimals that tells parts of the scene's radius of 10⁻⁵ apart.
    pub fn decimals(&self) -> usize {
        let radius = self.view.as_ref().map_or(1.0, |view| view.source.extent().bounds().radius);
        (5.0 - radius.log10().floor()).clamp(0.0, 9.0) as usize
    }

    /// Names of the method and of the shading.
    pub fn names(&self) -> Option<[&'static str; 2]> {
        let SceneView { method, settings, .. } = self.view.as_ref()?;
        Some([method.name, settings.shading.name()])
    }

    /// Title of the window: scene, whether it is a preview, number of surfels, method and shading.
    pub fn title(&self) -> String {
        let Some(SceneView { method, settings, scene, source, origin, .. }) = &self.view else {
            return "surfel".into();
        };
        let (title, surfels) = (source.info().title(), thousands(scene.point_count()));
        let title = if origin.preview { format!("preview of {title}") } else { title };
        format!("{title} · {surfels} surfels · {}, {} · surfel", method.name, settings.shading.name())
    }

    /// Whether a property of the files is being read.
    pub fn is_reading(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.source.reading_progress().is_some())
    }

    /// Colour bar of the attribute that surfels are coloured by, if it has values.
    pub fn colour_bar(&self) -> Option<ColourBar> {
        let SceneView { source, .. } = self.view.as_ref()?;
        let scale = source.wanted.scale()?;
        Some(colour_bar(source.name(source.wanted.attribute), scale))
    }

    /// What the panels let the user choose, if a scene is shown.
    pub fn choices(&mut self) -> Option<Choices<'_>> {
        let camera = self.frame(Quality::FULL).map(|frame| frame.map(|(_, camera, _)| camera));
        let Self { view, viewport, method_settings, rasterizer, filter, legend, version, .. } = self;
        let SceneView { method, settings, scene, source, origin, .. } = view.as_mut()?;
        let streams = scene.streams();
        Some(Choices {
            method,
            settings,
            source,
            filter,
            surfels: scene.point_count(),
            preview: origin.preview,
            primitives: streams.primitives.any(),
            weighted: streams.weights.is_some(),
            scene,
            version: *version,
            camera,
            size: viewport.size,
            parallel: &mut viewport.parallel,
            legend,
            rasterizer: *rasterizer,
            method_settings,
        })
    }

    /// Runs an action that changes the view; ignores all others.
    pub fn act(&mut self, action: Action) {
        let Some(view) = &mut self.view else { return };
        match action {
            Action::Close | Action::Quit | Action::Help | Action::Panels | Action::Open => {}
            Action::SaveScreenshot(_) | Action::SaveCamera | Action::CopyCamera | Action::PasteCamera => {}
            Action::NextMethod => view.step_method(1, &self.method_settings),
            Action::PreviousMethod => view.step_method(Method::ALL.len() - 1, &self.method_settings),
            Action::NextShading => {
                let after =
                    Shading::ALL.iter().cycle().skip_while(|shading| **shading != view.settings.shading);
                view.settings.shading = after.skip(1).copied().next().unwrap_or(Shading::Lit);
            }
            Action::Parallel => self.viewport.parallel = !self.viewport.parallel,
            Action::Frame => view.orbit.frame(view.source.extent(), &self.viewport),
            Action::ViewFrom(direction) => view.orbit.view_from(direction),
            Action::Up(up) => {
                let down = view.orbit.up() == up.vector();
                self.up = Up { down, ..up };
                view.orbit.set_up(self.up);
            }
        }
    }
}

/// The axis that is nearest to a direction.
fn nearest_axis(up: DVec3) -> Up {
    let size = up.abs();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(1);
    Up { axis, down: up[axis] < 0.0 }
}

#[cfg(test)]
pub mod tests;
