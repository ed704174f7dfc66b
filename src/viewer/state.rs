//! What is looked at, and how: everything that the hands change.

use super::keys::Action;
use super::open::{Answer, Opening};
use super::orbit::{Lens, Orbit, Up};
use super::{Look, Options};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use surfel::geometry::{Camera, Pose};
use surfel::methods::Method;
use surfel::settings::Shading;
use surfel::{Result, Scene, Settings};

/// What the picture can show.
pub const SHADINGS: [Shading; 4] = [Shading::Lit, Shading::Colour, Shading::Normal, Shading::Depth];

/// What is looked at, and how.
pub struct State {
    pub lens: Lens,
    up: Up,
    look: Look,
    shown: Option<Shown>,
    /// How the scene was shown that the last device had.
    before: Option<(Method, Settings)>,
    /// The place whose surface is to be turned about, px.
    pub pick: Option<DVec2>,
    /// What is to be opened, while it is asked for, and the answer.
    pub opening: Option<Opening>,
    pub answer: Option<Answer>,
}

struct Shown {
    scene: Arc<Scene>,
    orbit: Orbit,
    /// The camera that the hands were given, and what they have made of it: until they move it is that, bit for bit.
    given: Option<(Orbit, Lens, Pose)>,
    method: Method,
    settings: Settings,
}

impl State {
    pub fn new(options: &Options, look: Look) -> Self {
        let lens = Lens { size: options.size, fov_y_deg: options.fov_y_deg, parallel: false };
        Self {
            lens,
            up: nearest(options.up),
            look,
            shown: None,
            before: None,
            pick: None,
            opening: None,
            answer: None,
        }
    }

    /// Looks at a scene from the front.
    pub fn show(&mut self, scene: Arc<Scene>, method: Method) {
        let orbit = Orbit::framing(&scene.bounds(), self.up, &self.lens);
        let before = self.before.take();
        let (method, settings) = before.unwrap_or_else(|| (method, (self.look)(&method)));
        self.shown = Some(Shown { scene, orbit, given: None, method, settings });
    }

    /// Leaves the scene, with all that the device has of it; the next one is shown as this one was. From where it was seen.
    pub fn leave(&mut self) -> Option<Pose> {
        let pose = self.pose();
        self.before = self.shown.take().map(|shown| (shown.method, shown.settings)).or(self.before.take());
        pose
    }

    /// Looks from where this camera does.
    pub fn look_from(&mut self, pose: Pose) {
        let Self { shown: Some(shown), lens, .. } = self else { return };
        shown.orbit = Orbit::of(&pose, shown.orbit.up(), lens);
        shown.given = Some((shown.orbit, *lens, pose));
    }

    /// From where the scene is seen.
    pub fn pose(&self) -> Option<Pose> {
        let Shown { orbit, given, .. } = self.shown.as_ref()?;
        let still = |(was, lens, _): &(Orbit, Lens, Pose)| {
            was == orbit && Lens { size: lens.size, ..self.lens } == *lens
        };
        Some(given.filter(still).map_or_else(|| orbit.pose(&self.lens), |(.., pose)| pose))
    }

    /// The scene, from where and how it is seen.
    pub fn frame(&self) -> Option<Result<(&Arc<Scene>, Camera, &Settings)>> {
        let Shown { scene, settings, .. } = self.shown.as_ref()?;
        let camera = self.pose()?.camera(&scene.bounds(), self.lens.aspect());
        Some(camera.map(|camera| (scene, camera, settings)))
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

    /// Names of the method and of what it shows.
    pub fn names(&self) -> Option<[&'static str; 2]> {
        let Shown { method, settings, .. } = self.shown.as_ref()?;
        Some([method.name, settings.shading.name()])
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

    /// Does what a key asks for, of what is looked at.
    pub fn act(&mut self, action: Action) {
        let Some(shown) = &mut self.shown else { return };
        match action {
            Action::Quit | Action::Help | Action::Open => {}
            Action::Keep(_) | Action::SaveCamera | Action::CopyCamera | Action::PasteCamera => {}
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

/// The axis that is nearest to a direction.
fn nearest(up: DVec3) -> Up {
    let size = up.abs();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(1);
    Up { axis, down: up[axis] < 0.0 }
}
