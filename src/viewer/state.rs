//! What is looked at, and how: everything that the hands change.

use super::about::thousands;
use super::keys::Action;
use super::open::{Answer, Opening};
use super::orbit::{Orbit, Up};
use super::quality::Workload;
use super::source::{Source, Wish};
use super::viewport::Viewport;
use super::{MethodSettings, Options};
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::sync::Arc;
use surfel::geometry::{Camera, ColourScale, Pose};
use surfel::settings::methods::Method;
use surfel::settings::splatting::Normalization;
use surfel::settings::{Choice, Shading};
use surfel::vk::Device;
use surfel::{Rasterizer, Result, Scene, Settings};

/// What is looked at, and how.
pub struct State {
    pub viewport: Viewport,
    up: Up,
    method_settings: MethodSettings,
    rasterizer: Option<Rasterizer>,
    /// How the first scene is seen, if it can be.
    remembered: Option<(Method, Settings)>,
    /// Another for scenes with other contents.
    version: u64,
    shown: Option<Shown>,
    /// How the scene was shown that the last device had.
    left: Option<(Method, Settings, Wish)>,
    /// The place whose surface is to be turned about, px.
    pub pick: Option<DVec2>,
    /// What is to be opened, while it is asked for, and the answer.
    pub opening: Option<Opening>,
    pub answer: Option<Answer>,
    /// What is being loaded is to be given up.
    pub cancel: bool,
}

/// A scene, from where it is seen, and how.
type Seen<'a> = (&'a Arc<Scene>, Camera, Cow<'a, Settings>);

/// What a scene is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Of {
    /// Number of the load.
    pub load: u64,
    /// Whether it is some of the points, until all are there.
    pub preview: bool,
    /// Whether it is another state of what is shown, which is looked at as that is.
    pub again: bool,
}

impl Of {
    fn preview_of(self) -> Self {
        Self { preview: true, ..self }
    }
}

struct Shown {
    scene: Arc<Scene>,
    of: Of,
    /// Ever fewer and larger surfels of it.
    coarser: Vec<Arc<Scene>>,
    /// What is looked at again where a preview is all that ever comes.
    before: Option<Box<Shown>>,
    source: Source,
    orbit: Orbit,
    /// As it was framed.
    framed: Orbit,
    /// The camera that the hands were given, and what they have made of it: until they move it is that, bit for bit.
    given: Option<(Orbit, Viewport, Pose)>,
    method: Method,
    settings: Settings,
}

impl State {
    pub fn new(
        options: &Options,
        method_settings: MethodSettings,
        remembered: Option<(Method, Settings)>,
    ) -> Self {
        let viewport = Viewport { size: options.size, fov_y_deg: options.fov_y_deg, parallel: false };
        Self {
            viewport,
            up: nearest(options.up),
            method_settings,
            rasterizer: options.rasterizer,
            remembered,
            version: 0,
            shown: None,
            left: None,
            pick: None,
            opening: None,
            answer: None,
            cancel: false,
        }
    }

    /// Looks at the scene of a load from the front; or at all of what was a preview as at that, and so at what is loaded again.
    pub fn show(&mut self, scene: Arc<Scene>, (method, mut source): (Method, Source), of: Of) {
        let framed = Orbit::framing(&scene.bounds(), self.up, &self.viewport);
        let (coarser, given) = (Vec::new(), None);
        let left = self.left.take().map(|(method, settings, wish)| {
            source.change_as(&wish);
            (method, settings)
        });
        let known = left.or(self.remembered.take_if(|known| suits(&scene, &known.1)));
        let (method, settings) = known.unwrap_or_else(|| (method, (self.method_settings)(&method)));
        if !of.preview {
            self.remembered = None;
        }
        self.shown = Some(match self.shown.take() {
            Some(preview) if preview.of == of.preview_of() => {
                let moved = preview.given.is_some() || preview.orbit != preview.framed;
                let orbit = if moved { preview.orbit } else { framed };
                source.change_as(&preview.source.wish());
                let (method, settings) = preview.seen_by(&scene, (method, settings));
                Shown { scene, source, of, orbit, framed, coarser, before: None, method, settings, ..preview }
            }
            Some(shown) if of.again && !shown.of.preview => {
                source.change_as(&shown.source.wish());
                let (method, settings) = shown.seen_by(&scene, (method, settings));
                Shown { scene, source, of, coarser, method, settings, ..shown }
            }
            before => {
                // Of one that is not whole there was something before.
                let whole =
                    |shown: Shown| if shown.of.preview { shown.before } else { Some(Box::new(shown)) };
                let before = before.filter(|_| of.preview).and_then(whole);
                Shown { scene, source, of, coarser, before, orbit: framed, framed, given, method, settings }
            }
        });
    }

    /// How it is seen, if something is.
    pub fn settings(&self) -> Option<&Settings> {
        self.shown.as_ref().map(|shown| &shown.settings)
    }

    /// Another for scenes with other contents.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Makes the scene what its source is to be. The coarser ones are not that, and go.
    pub fn apply(&mut self, device: &Arc<Device>) -> Result<()> {
        let Some(Shown { scene, source, coarser, .. }) = &mut self.shown else { return Ok(()) };
        if source.apply(scene, device)? {
            self.version += 1;
            coarser.clear();
        }
        Ok(())
    }

    /// What coarser scenes are to be made of, if there are none of what is shown whole.
    pub fn without_coarser(&self) -> Option<Source> {
        let shown = self.shown.as_ref().filter(|shown| !shown.of.preview && shown.coarser.is_empty())?;
        Some(shown.source.snapshot())
    }

    /// Whether the user has moved the camera before a preview of this load.
    pub fn has_moved_preview(&self, load: u64) -> bool {
        let preview = self.shown.as_ref().filter(|shown| (shown.of.load, shown.of.preview) == (load, true));
        preview.is_some_and(|shown| shown.given(&self.viewport).is_none())
    }

    /// Leaves the scene, with all that the device has of it; the next one, if it is the `same`, is shown as this one was. From where that was seen.
    pub fn leave(&mut self, same: bool) -> Option<Pose> {
        let pose = self.pose().filter(|_| same);
        let left = self.shown.take().filter(|_| same);
        let left = left.map(|shown| (shown.method, shown.settings, shown.source.wish()));
        self.left = left.or(self.left.take());
        pose
    }

    /// Looks from where this camera does, and turns about its target.
    pub fn set_pose(&mut self, pose: Pose) {
        let Self { shown: Some(shown), viewport, .. } = self else { return };
        shown.orbit = Orbit::of(&pose, shown.orbit.up(), viewport);
        shown.given = Some((shown.orbit, *viewport, pose));
    }

    /// Looks at what was before the preview, if that is what is looked at.
    pub fn leave_preview(&mut self) {
        if let Some(Shown { before, .. }) = self.shown.take_if(|shown| shown.of.preview) {
            self.shown = before.map(|before| *before);
        }
    }

    /// Shows fewer surfels of the scene while the hands move, if that has to be.
    pub fn add_coarser(&mut self, scenes: Vec<Arc<Scene>>) {
        if let Some(shown) = &mut self.shown {
            shown.coarser = scenes;
        }
    }

    /// The scene, and how it is rendered.
    pub fn scene_and_settings(&self) -> Option<(Arc<Scene>, Settings)> {
        self.shown.as_ref().map(|shown| (shown.scene.clone(), shown.settings.clone()))
    }

    /// What there is to be seen, for who chooses how much of it is.
    pub fn workload(&self) -> Option<Workload> {
        let Shown { scene, coarser, orbit, .. } = self.shown.as_ref()?;
        let [width, height] = self.viewport.size.map(f64::from);
        let scenes = std::iter::once(scene).chain(coarser);
        Some(Workload {
            pixels: width * height,
            surfels: scenes.map(|scene| scene.count() as f64).collect(),
            diameter_px: 2.0 * scene.bounds().radius / self.viewport.units_per_px(orbit.distance()),
        })
    }

    /// Whether a whole scene is shown.
    pub fn is_whole(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| !shown.of.preview)
    }

    /// Whether what is shown is some of the points, until all are there.
    pub fn is_preview(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.of.preview)
    }

    /// From where the scene is seen.
    pub fn pose(&self) -> Option<Pose> {
        let shown = self.shown.as_ref()?;
        Some(shown.given(&self.viewport).unwrap_or_else(|| shown.orbit.pose(&self.viewport)))
    }

    /// The scene, or the coarser one of this number, from where and how it is seen.
    pub fn frame(&self, number: usize) -> Option<Result<Seen<'_>>> {
        let Shown { scene, coarser, settings, .. } = self.shown.as_ref()?;
        let camera = self.pose()?.camera(&scene.bounds(), self.viewport.aspect());
        let fewer = number.checked_sub(1).and_then(|number| coarser.get(number));
        let seen = fewer.map_or((scene, Cow::Borrowed(settings)), |fewer| (fewer, quick(settings)));
        Some(camera.map(|camera| (seen.0, camera, seen.1)))
    }

    /// The camera and the bounds of what it sees.
    pub fn moving(&mut self) -> Option<(&mut Orbit, &Viewport, &Scene)> {
        let Self { shown: Some(Shown { orbit, scene, .. }), viewport, .. } = self else { return None };
        Some((orbit, viewport, scene))
    }

    /// Nearer by so many steps of the wheel, to what is at `at`.
    pub fn zoom(&mut self, steps: f64, at: DVec2) {
        if let Some((orbit, viewport, scene)) = self.moving() {
            orbit.zoom(steps, at, None, viewport, &scene.bounds());
        }
    }

    /// Turns from now on about what is at `at`, so far ahead of the eye; the picture stays. Nothing is infinitely far.
    pub fn set_pivot(&mut self, at: DVec2, distance: f64) {
        let Some((orbit, viewport, _)) = self.moving() else { return };
        if distance.is_finite() {
            orbit.set_pivot(orbit.point(at, distance, viewport), viewport);
        }
    }

    /// Names of the method and of what it shows.
    pub fn names(&self) -> Option<[&'static str; 2]> {
        let Shown { method, settings, .. } = self.shown.as_ref()?;
        Some([method.name, settings.shading.name()])
    }

    /// What is shown, how much of it, and by which method: the window's title.
    pub fn title(&self) -> String {
        let Some(Shown { method, settings, scene, source, .. }) = &self.shown else { return "surfel".into() };
        let (about, surfels) = (source.about().title(), thousands(scene.count()));
        format!("{about} · {surfels} surfels · {}, {} · surfel", method.name, settings.shading.name())
    }

    /// Whether numbers are being read for colours to show.
    pub fn is_reading(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.source.reading().is_some())
    }

    /// What surfels' colours stand for, where they stand for numbers.
    pub fn colour_scale(&self) -> Option<(String, ColourScale)> {
        let Shown { source, .. } = self.shown.as_ref()?;
        Some((source.name(source.changed.by).to_owned(), source.changed.scale()?))
    }

    /// What can be chosen, where something is shown.
    pub fn choices(&mut self) -> Option<Choices<'_>> {
        let camera = self.frame(0).map(|frame| frame.map(|(_, camera, _)| camera));
        let Self {
            shown: Some(Shown { method, settings, scene, source, .. }),
            viewport,
            method_settings,
            ..
        } = self
        else {
            return None;
        };
        let streams = scene.streams();
        Some(Choices {
            method,
            settings,
            source,
            surfels: scene.count(),
            primitives: streams.primitives.any(),
            weighted: streams.weights.is_some(),
            scene,
            camera,
            size: viewport.size,
            parallel: &mut viewport.parallel,
            rasterizer: self.rasterizer,
            method_settings,
        })
    }

    /// Does what a key asks for, of what is looked at.
    pub fn act(&mut self, action: Action) {
        let Some(shown) = &mut self.shown else { return };
        match action {
            Action::Close | Action::Quit | Action::Help | Action::Panels | Action::Open => {}
            Action::SaveScreenshot(_) | Action::SaveCamera | Action::CopyCamera | Action::PasteCamera => {}
            Action::NextMethod => shown.turn_method(1, &self.method_settings),
            Action::PreviousMethod => shown.turn_method(Method::ALL.len() - 1, &self.method_settings),
            Action::NextShading => {
                let after =
                    Shading::ALL.iter().cycle().skip_while(|shading| **shading != shown.settings.shading);
                shown.settings.shading = after.skip(1).copied().next().unwrap_or(Shading::Lit);
            }
            Action::Parallel => self.viewport.parallel = !self.viewport.parallel,
            Action::Frame => shown.orbit.frame(&shown.scene.bounds(), &self.viewport),
            Action::ViewFrom(direction) => shown.orbit.view_from(direction),
            Action::Up(up) => {
                let down = shown.orbit.up() == up.vector();
                self.up = Up { down, ..up };
                shown.orbit.set_up(self.up);
            }
        }
    }
}

/// What the panels let one choose.
pub struct Choices<'a> {
    pub method: &'a mut Method,
    pub settings: &'a mut Settings,
    pub source: &'a mut Source,
    pub parallel: &'a mut bool,
    pub surfels: u64,
    /// Whether there are lines or triangles.
    pub primitives: bool,
    /// Whether there are normalization weights.
    pub weighted: bool,
    pub scene: &'a Arc<Scene>,
    pub camera: Option<Result<Camera>>,
    /// Width and height of the window's picture, px.
    pub size: [u32; 2],
    pub rasterizer: Option<Rasterizer>,
    method_settings: &'a MethodSettings,
}

impl Choices<'_> {
    /// Takes another method; what is seen stays.
    pub fn choose(&mut self, method: Method) {
        *self.settings = self.settings_of(&method);
        *self.method = method;
    }

    /// The settings of a method; what is seen stays.
    pub fn settings_of(&self, method: &Method) -> Settings {
        seen_alike((self.method_settings)(method), self.settings)
    }
}

/// Settings with what those before let one see.
fn seen_alike(settings: Settings, before: &Settings) -> Settings {
    let Settings { shading, background, alpha, .. } = *before;
    Settings { shading, background, alpha, ..settings }
}

impl Shown {
    /// How another state of the scene is seen: as this one, or otherwise where that cannot be.
    fn seen_by(&self, scene: &Scene, otherwise: (Method, Settings)) -> (Method, Settings) {
        if suits(scene, &self.settings) { (self.method, self.settings.clone()) } else { otherwise }
    }

    /// The camera that the hands were given, until they move it.
    fn given(&self, viewport: &Viewport) -> Option<Pose> {
        let still = |(orbit, was, _): &(Orbit, Viewport, Pose)| {
            *orbit == self.orbit && Viewport { size: was.size, ..*viewport } == *was
        };
        self.given.filter(still).map(|(.., pose)| pose)
    }

    /// The method so many further on; what is seen stays.
    fn turn_method(&mut self, steps: usize, method_settings: &MethodSettings) {
        let now = Method::ALL.iter().position(|method| method.name == self.method.name).unwrap_or(0);
        self.method = Method::ALL[(now + steps) % Method::ALL.len()];
        self.settings = seen_alike(method_settings(&self.method), &self.settings);
    }
}

/// The settings for surfels that stand for others, whose normalization weights they have not.
pub fn quick(settings: &Settings) -> Cow<'_, Settings> {
    let mut quick = Cow::Borrowed(settings);
    if settings.splatting.normalization == Normalization::Surfel {
        quick.to_mut().splatting.normalization = Normalization::Pixel;
    }
    quick
}

/// Whether a scene can be rendered so.
fn suits(scene: &Scene, settings: &Settings) -> bool {
    let streams = scene.streams();
    let weighted = settings.splatting.normalization.check_weights(streams.weights.is_some());
    settings.check_primitives(streams.primitives.any()).and(weighted).is_ok()
}

/// The axis that is nearest to a direction.
fn nearest(up: DVec3) -> Up {
    let size = up.abs();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(1);
    Up { axis, down: up[axis] < 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::tests::device;
    use crate::viewer::{Events, Loaded, SaveFolder};
    use std::time::Instant;
    use surfel::geometry::Surfels;
    use surfel::verify::scenes;
    use surfel::vk::DeviceOptions;

    fn state() -> State {
        let options = Options {
            inputs: Vec::new(),
            size: [640, 480],
            device: DeviceOptions::default(),
            rasterizer: None,
            up: DVec3::Y,
            budget: 60.0,
            fov_y_deg: 45.0,
            place: Box::new(|_, _| None),
            watch: false,
            events: Events::new(Instant::now(), false),
            save_folder: SaveSaveFolder { path: ".".into(), print_names: false },
            remembered: None,
            asked: false,
        };
        State::new(&options, Box::new(Method::settings), None)
    }

    fn of(load: u64, preview: bool) -> Of {
        Of { load, preview, again: false }
    }

    #[test]
    fn a_preview_is_left_for_what_was_before_or_for_the_whole_scene() {
        let Some(device) = device("a_preview_is_left_for_what_was_before_or_for_the_whole_scene") else {
            return;
        };
        let scene = |points: u32| {
            let surfels = scenes::open(&format!("scene:sphere?points={points}")).unwrap();
            Arc::new(Scene::upload(&device, &surfels).unwrap())
        };
        let made = || (Method::ALL[0], Source::new(Loaded::new(Surfels::default().into(), Method::ALL[0])));
        let shown = |state: &State| state.scene_and_settings().map(|(scene, _)| scene.count());
        let mut state = state();
        state.show(scene(10), made(), of(1, true));
        assert_eq!((shown(&state), state.is_preview()), (Some(10), true));
        state.leave_preview();
        assert_eq!(shown(&state), None, "there was nothing before");
        state.show(scene(10), made(), of(2, true));
        let eye = |state: &mut State| state.moving().unwrap().0.eye;
        // Who has turned the preview sees the whole scene from there.
        let (orbit, ..) = state.moving().unwrap();
        orbit.view_from(super::super::orbit::ViewDirection::Top);
        let above = eye(&mut state);
        state.show(scene(100), made(), of(2, false));
        assert_eq!((shown(&state), state.is_preview(), eye(&mut state)), (Some(100), false, above));
        state.show(scene(10), made(), of(3, true));
        state.show(scene(20), made(), of(4, true));
        assert_ne!(eye(&mut state), above);
        state.leave_preview();
        assert_eq!((shown(&state), eye(&mut state)), (Some(100), above));
        // Another state of the same files is looked at as the one before.
        state.show(scene(50), made(), Of { load: 5, preview: false, again: true });
        assert_eq!((shown(&state), eye(&mut state)), (Some(50), above));
        state.add_coarser(vec![scene(5)]);
        assert_eq!(state.workload().unwrap().surfels, [50.0, 5.0]);
        state.show(scene(30), made(), of(6, false));
        assert_eq!(state.workload().unwrap().surfels, [30.0]);
        assert_ne!(eye(&mut state), above);
    }
}
