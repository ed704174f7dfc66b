//! What is looked at, and how: everything that the hands change.

use super::keys::Action;
use super::orbit::{Lens, Orbit, Up};
use super::source::Source;
use super::{Look, Options};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use surfel::geometry::Camera;
use surfel::methods::Method;
use surfel::settings::Shading;
use surfel::vk::Device;
use surfel::{Rasterizer, Result, Scene, Settings};

/// Vertical angle of view, radians.
const FOV: f64 = std::f64::consts::FRAC_PI_4;
/// What the picture can show.
pub const SHADINGS: [Shading; 4] = [Shading::Lit, Shading::Colour, Shading::Normal, Shading::Depth];

/// What a shading shows.
pub fn shading_text(shading: Shading) -> &'static str {
    match shading {
        Shading::Lit => "lit by a lamp at the eye",
        Shading::Colour => "the points' colours as they are",
        Shading::Normal => "normals in world space: x, y, z as red, green, blue; below 0 is black",
        Shading::Depth => "distance from the eye, in the positions' unit: 1 and above is white",
        Shading::Overlap => "how many splats are blended",
        Shading::Weight => "what the splats' weights add up to",
    }
}

/// What is looked at, and how.
pub struct State {
    pub lens: Lens,
    up: Up,
    look: Look,
    rasterizer: Option<Rasterizer>,
    /// How the first scene is seen, if it can be.
    remembered: Option<(Method, Settings)>,
    /// Another for scenes with other contents.
    version: u64,
    shown: Option<Shown>,
    /// The place whose surface is to be turned about, px.
    pub pick: Option<DVec2>,
}

struct Shown {
    scene: Arc<Scene>,
    source: Source,
    orbit: Orbit,
    method: Method,
    settings: Settings,
}

impl State {
    pub fn new(options: &Options, look: Look, remembered: Option<(Method, Settings)>) -> Self {
        let lens = Lens { size: options.size, fov_y: FOV, parallel: false };
        let (up, rasterizer) = (nearest(options.up), options.rasterizer);
        Self { lens, up, look, rasterizer, remembered, version: 0, shown: None, pick: None }
    }

    /// Looks at a scene from the front.
    pub fn show(&mut self, scene: Arc<Scene>, method: Method, source: Source) {
        let orbit = Orbit::framing(&scene.bounds(), self.up, &self.lens);
        let settings = (self.look)(&method);
        let (method, settings) =
            self.remembered.take_if(|known| suits(&scene, &known.1)).unwrap_or((method, settings));
        self.remembered = None;
        self.shown = Some(Shown { scene, source, orbit, method, settings });
    }

    /// How it is seen, if something is.
    pub fn settings(&self) -> Option<&Settings> {
        self.shown.as_ref().map(|shown| &shown.settings)
    }

    /// Another for scenes with other contents.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Makes the scene what its source is to be.
    pub fn apply(&mut self, device: &Arc<Device>) -> Result<()> {
        let Some(Shown { scene, source, .. }) = &mut self.shown else { return Ok(()) };
        self.version += u64::from(source.apply(scene, device)?);
        Ok(())
    }

    /// Names of the method and of what it shows.
    pub fn names(&self) -> Option<[&'static str; 2]> {
        let Shown { method, settings, .. } = self.shown.as_ref()?;
        Some([method.name, settings.shading.name()])
    }

    /// The scene, from where and how it is seen.
    pub fn frame(&self) -> Option<Result<(&Arc<Scene>, Camera, &Settings)>> {
        let Shown { scene, orbit, settings, .. } = self.shown.as_ref()?;
        let camera = orbit.camera(&self.lens, &scene.bounds());
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
        let camera = self.frame().map(|frame| frame.map(|(_, camera, _)| camera));
        let Self { shown: Some(Shown { method, settings, scene, source, .. }), lens, look, .. } = self else {
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
            size: lens.size,
            parallel: &mut lens.parallel,
            rasterizer: self.rasterizer,
            look,
        })
    }

    /// Does what a key asks for, but to quit.
    pub fn act(&mut self, action: Action) {
        let Some(shown) = &mut self.shown else { return };
        match action {
            Action::Quit | Action::Help | Action::Panels => {}
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
    look: &'a Look,
}

impl Choices<'_> {
    /// Takes another method; what is seen stays.
    pub fn choose(&mut self, method: Method) {
        *self.settings = self.settings_of(&method);
        *self.method = method;
    }

    /// The settings of a method; what is seen stays.
    pub fn settings_of(&self, method: &Method) -> Settings {
        seen_alike((self.look)(method), self.settings)
    }
}

/// Settings with what those before let one see.
fn seen_alike(settings: Settings, before: &Settings) -> Settings {
    let Settings { shading, background, alpha, .. } = *before;
    Settings { shading, background, alpha, ..settings }
}

impl Shown {
    /// The method so many further on; what is seen stays.
    fn turn_method(&mut self, steps: usize, look: &Look) {
        let now = Method::ALL.iter().position(|method| method.name == self.method.name).unwrap_or(0);
        self.method = Method::ALL[(now + steps) % Method::ALL.len()];
        self.settings = seen_alike(look(&self.method), &self.settings);
    }
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
