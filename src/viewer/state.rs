//! What is looked at, and how: everything that the hands change.

use super::keys::Action;
use super::orbit::{Lens, Orbit, Up};
use super::pace::Sight;
use super::{Look, Options};
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::methods::Method;
use surfel::settings::Shading;
use surfel::splatting::Normalization;
use surfel::{Result, Scene, Settings};

/// Vertical angle of view, radians.
const FOV: f64 = std::f64::consts::FRAC_PI_4;
/// What the picture can show.
pub const SHADINGS: [Shading; 4] = [Shading::Lit, Shading::Colour, Shading::Normal, Shading::Depth];

/// What is looked at, and how.
pub struct State {
    pub lens: Lens,
    up: Up,
    look: Look,
    shown: Option<Shown>,
    /// The place whose surface is to be turned about, px.
    pub pick: Option<DVec2>,
    /// What is being loaded is to be given up.
    pub cancel: bool,
}

/// What a scene is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Of {
    /// Number of the load.
    pub load: u64,
    /// Whether it is some of the points, until all are there.
    pub sketch: bool,
    /// Whether it is another state of what is shown, which is looked at as that is.
    pub again: bool,
}

impl Of {
    fn sketch_of(self) -> Self {
        Self { sketch: true, ..self }
    }
}

struct Shown {
    scene: Arc<Scene>,
    of: Of,
    /// Ever fewer and larger surfels of it.
    coarser: Vec<Arc<Scene>>,
    /// What is looked at again where a sketch is all that ever comes.
    before: Option<Box<Shown>>,
    orbit: Orbit,
    method: Method,
    settings: Settings,
}

impl State {
    pub fn new(options: &Options, look: Look) -> Self {
        let lens = Lens { size: options.size, fov_y: FOV, parallel: false };
        Self { lens, up: nearest(options.up), look, shown: None, pick: None, cancel: false }
    }

    /// Looks at the scene of a load from the front; or at all of what was a sketch as at that.
    pub fn show(&mut self, scene: Arc<Scene>, method: Method, of: Of) {
        let mut orbit = Orbit::framing(&scene.bounds(), self.up, &self.lens);
        let settings = (self.look)(&method);
        let before = self.shown.take();
        let new = match before {
            Some(sketch) if sketch.of == Of::sketch_of(of) => {
                if sketch.orbit != Orbit::framing(&sketch.scene.bounds(), self.up, &self.lens) {
                    orbit = sketch.orbit;
                }
                Shown { scene, of, orbit, coarser: Vec::new(), ..sketch }
            }
            Some(shown) if of.again && !shown.of.sketch => Shown { scene, of, coarser: Vec::new(), ..shown },
            // Of one that is not whole there was something before.
            Some(Shown { of: Of { sketch: true, .. }, before, .. }) => {
                Shown { scene, of, orbit, method, settings, before, coarser: Vec::new() }
            }
            before => {
                let before = before.map(Box::new);
                Shown { scene, of, orbit, method, settings, before, coarser: Vec::new() }
            }
        };
        let before = new.before.filter(|_| of.sketch);
        self.shown = Some(Shown { before, ..new });
    }

    /// Looks at what was before the sketch, if that is what is looked at.
    pub fn leave_sketch(&mut self) {
        if let Some(Shown { before, .. }) = self.shown.take_if(|shown| shown.of.sketch) {
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
    pub fn look(&self) -> Option<(Arc<Scene>, Settings)> {
        self.shown.as_ref().map(|shown| (shown.scene.clone(), shown.settings.clone()))
    }

    /// What there is to be seen, for who chooses how much of it is.
    pub fn sight(&self) -> Option<Sight> {
        let Shown { scene, coarser, orbit, .. } = self.shown.as_ref()?;
        let [width, height] = self.lens.size.map(f64::from);
        let scenes = std::iter::once(scene).chain(coarser);
        Some(Sight {
            pixels: width * height,
            surfels: scenes.map(|scene| scene.count() as f64).collect(),
            across: 2.0 * scene.bounds().radius / self.lens.px(orbit.distance()),
        })
    }

    /// Whether what is shown is some of the points, until all are there.
    pub fn is_sketch(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.of.sketch)
    }

    /// The scene, or the coarser one of this number, from where and how it is seen.
    pub fn frame(&self, number: usize) -> Option<Result<(&Arc<Scene>, Camera, Cow<'_, Settings>)>> {
        let Shown { scene, coarser, orbit, settings, .. } = self.shown.as_ref()?;
        let camera = orbit.camera(&self.lens, &scene.bounds());
        let fewer = number.checked_sub(1).and_then(|number| coarser.get(number));
        let seen = fewer.map_or((scene, Cow::Borrowed(settings)), |fewer| (fewer, quick(settings)));
        Some(camera.map(|camera| (seen.0, camera, seen.1)))
    }

    /// The camera and the bounds of what it sees.
    pub fn moving(&mut self) -> Option<(&mut Orbit, &Lens, &Scene)> {
        let Self { shown: Some(Shown { orbit, scene, .. }), lens, .. } = self else { return None };
        Some((orbit, lens, scene))
    }

    /// Nearer by so many steps of the wheel, to what is at `at`.
    pub fn zoom(&mut self, steps: f64, at: DVec2) {
        if let Some((orbit, lens, scene)) = self.moving() {
            orbit.zoom(steps, at, None, lens, &scene.bounds());
        }
    }

    /// Turns from now on about what is at `at`, so far ahead of the eye; the picture stays. Nothing is infinitely far.
    pub fn set_pivot(&mut self, at: DVec2, distance: f64) {
        let Some((orbit, lens, _)) = self.moving() else { return };
        if distance.is_finite() {
            orbit.set_pivot(orbit.point(at, distance, lens), lens);
        }
    }

    /// In a word: what is shown, and by which method.
    pub fn title(&self) -> String {
        match &self.shown {
            Some(Shown { method, settings, scene, .. }) => {
                format!("{} · {} · {} surfels", method.name, settings.shading.name(), scene.count())
            }
            None => "nothing yet".into(),
        }
    }

    /// What can be chosen, where something is shown.
    pub fn choices(&mut self) -> Option<Choices<'_>> {
        let Self { shown: Some(Shown { method, settings, scene, .. }), lens, look, .. } = self else {
            return None;
        };
        Some(Choices { method, settings, parallel: &mut lens.parallel, surfels: scene.count(), look })
    }

    /// Does what a key asks for, but to quit.
    pub fn act(&mut self, action: Action) {
        let Some(shown) = &mut self.shown else { return };
        match action {
            Action::Quit | Action::Help => {}
            Action::NextMethod => shown.turn_method(1, &self.look),
            Action::PreviousMethod => shown.turn_method(Method::ALL.len() - 1, &self.look),
            Action::NextShading => {
                let now = SHADINGS.iter().position(|shading| *shading == shown.settings.shading);
                shown.settings.shading = SHADINGS[now.map_or(0, |now| (now + 1) % SHADINGS.len())];
            }
            Action::Parallel => self.lens.parallel = !self.lens.parallel,
            Action::Frame => shown.orbit.frame(&shown.scene.bounds(), &self.lens),
            Action::Side(side) => shown.orbit.side(side),
            Action::Up(up) => {
                let down = shown.orbit.up() == up;
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
    pub parallel: &'a mut bool,
    pub surfels: u64,
    look: &'a Look,
}

impl Choices<'_> {
    /// Takes another method, with the shading of this one.
    pub fn choose(&mut self, method: Method) {
        *self.settings = Settings { shading: self.settings.shading, ..(self.look)(&method) };
        *self.method = method;
    }
}

impl Shown {
    /// The method so many further on, with the shading of this one.
    fn turn_method(&mut self, steps: usize, look: &Look) {
        let now = Method::ALL.iter().position(|method| method.name == self.method.name).unwrap_or(0);
        self.method = Method::ALL[(now + steps) % Method::ALL.len()];
        self.settings = Settings { shading: self.settings.shading, ..look(&self.method) };
    }
}

/// The settings for surfels that stand for others, whose normalization weights they have not.
fn quick(settings: &Settings) -> Cow<'_, Settings> {
    let mut quick = Cow::Borrowed(settings);
    if settings.splatting.normalization == Normalization::Surfel {
        quick.to_mut().splatting.normalization = Normalization::Pixel;
    }
    quick
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
    use crate::viewer::Events;
    use crate::viewer::tests::device;
    use std::time::Instant;
    use surfel::scenes;
    use surfel::vk::DeviceOptions;

    fn state() -> State {
        let options = Options {
            inputs: Vec::new(),
            size: [640, 480],
            device: DeviceOptions::default(),
            rasterizer: None,
            up: DVec3::Y,
            budget: 60.0,
            watch: false,
            events: Events::new(Instant::now(), false),
        };
        State::new(&options, Box::new(Method::settings))
    }

    fn of(load: u64, sketch: bool) -> Of {
        Of { load, sketch, again: false }
    }

    #[test]
    fn a_sketch_is_left_for_what_was_before_or_for_the_whole_scene() {
        let Some(device) = device("a_sketch_is_left_for_what_was_before_or_for_the_whole_scene") else {
            return;
        };
        let scene = |points: u32| {
            let surfels = scenes::open(&format!("scene:sphere?points={points}")).unwrap();
            Arc::new(Scene::upload(&device, &surfels).unwrap())
        };
        let method = Method::ALL[0];
        let shown = |state: &State| state.look().map(|(scene, _)| scene.count());
        let mut state = state();
        state.show(scene(10), method, of(1, true));
        assert_eq!((shown(&state), state.is_sketch()), (Some(10), true));
        state.leave_sketch();
        assert_eq!(shown(&state), None, "there was nothing before");
        state.show(scene(10), method, of(2, true));
        let eye = |state: &mut State| state.moving().unwrap().0.eye;
        // Who has turned the sketch sees the whole scene from there.
        state.moving().unwrap().0.side(super::super::orbit::Side::Top);
        let above = eye(&mut state);
        state.show(scene(100), method, of(2, false));
        assert_eq!((shown(&state), state.is_sketch(), eye(&mut state)), (Some(100), false, above));
        state.show(scene(10), method, of(3, true));
        state.show(scene(20), method, of(4, true));
        assert_ne!(eye(&mut state), above);
        state.leave_sketch();
        assert_eq!((shown(&state), eye(&mut state)), (Some(100), above));
        // Another state of the same files is looked at as the one before.
        state.show(scene(50), method, Of { load: 5, sketch: false, again: true });
        assert_eq!((shown(&state), eye(&mut state)), (Some(50), above));
        state.add_coarser(vec![scene(5)]);
        assert_eq!(state.sight().unwrap().surfels, [50.0, 5.0]);
        state.show(scene(30), method, of(6, false));
        assert_eq!(state.sight().unwrap().surfels, [30.0]);
        assert_ne!(eye(&mut state), above);
    }
}
