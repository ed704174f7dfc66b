//! An open window: a frame of it, and what it costs.

use super::Options;
use super::events::{Event, Events, Shown};
use super::hands::Hands;
use super::hud::Hud;
use super::pace::{Pace, Quality};
use super::panels::Told;
use super::screen::{Pick, Screen};
use super::state::State;
use std::sync::Arc;
use std::time::Instant;
use surfel::vk::{Device, Presenter};
use surfel::{Error, Result, Scene, Settings};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// An open window.
pub struct Opened {
    // The presenter waits for all frames before anything that they use goes.
    presenter: Presenter,
    pub hud: Hud,
    screen: Screen,
    pub pace: Pace,
    /// When the last frame began, if it was followed at once by this one.
    last: Option<Instant>,
    events: Events,
    /// What the pace knows the times of.
    look: Option<(Arc<Scene>, Settings)>,
    pub window: Arc<Window>,
}

impl Opened {
    /// Opens a window, and the device that presents to it.
    pub fn new(events: &ActiveEventLoop, options: &Options) -> Result<(Self, Arc<Device>)> {
        let [width, height] = options.size;
        let attributes =
            Window::default_attributes().with_title("surfel").with_inner_size(PhysicalSize { width, height });
        let window = events.create_window(attributes);
        let window = window.map_err(|cause| Error::NoDevice(format!("no window can be opened: {cause}")))?;
        let window = Arc::new(window);
        let (device, surface) = Device::open_for(&options.device, window.clone())?;
        let presenter = Presenter::new(&device, surface)?;
        let screen = Screen::new(&device, options.rasterizer)?;
        let hud = Hud::new(&device, &window, presenter.overlay())?;
        let pace = Pace::new(options.budget);
        let events = options.events;
        events.tell(&Event::Window { device: &device.description().name });
        Ok((Self { presenter, hud, screen, pace, last: None, events, look: None, window }, device))
    }

    /// The window's size is another, or may be.
    pub fn resized(&mut self) {
        self.presenter.resized();
        self.window.request_redraw();
    }

    /// Draws a frame; when another is to follow without an event.
    pub fn draw(&mut self, state: &mut State, hands: &Hands, told: &mut Told) -> Result<Option<Instant>> {
        let start = Instant::now();
        self.fly(state, hands, start);
        let look = state.look();
        if !self.look.as_ref().zip(look.as_ref()).is_some_and(|(a, b)| Arc::ptr_eq(&a.0, &b.0) && a.1 == b.1)
        {
            self.pace.forget();
            self.look = look;
        }
        let sight = state.sight();
        let moving = self.pace.moves(start);
        let quality = sight.as_ref().map_or(Quality::WHOLE, |sight| self.pace.quality(start, sight));
        told.side = quality.side;
        told.surfels =
            sight.as_ref().and_then(|sight| sight.surfels.get(quality.scene)).copied().unwrap_or(0.0);
        let again = self.hud.lay_out(&self.window, state, told);
        let shown = self.present(state, told, quality)?;
        // A frame's time is its own, and the next one shows where the hands are when it begins.
        self.presenter.wait()?;
        let ms = 1e3 * start.elapsed().as_secs_f64();
        if shown {
            told.frame = ms;
            if let Some(sight) = &sight {
                self.pace.took(quality, sight, ms, moving);
            }
            self.events.tell(&Event::Picture(Shown {
                size: state.lens.size,
                side: quality.side,
                surfels: told.surfels as u64,
                sketch: state.is_sketch(),
                moving,
                took_ms: ms,
            }));
        }
        if state.pick.is_some() {
            self.pick(state)?;
        }
        let flies = hands.flight().is_some();
        self.last = flies.then_some(start);
        if again || flies || state.pick.is_some() {
            self.window.request_redraw();
        }
        Ok(self.pace.refines(Instant::now()))
    }

    fn fly(&mut self, state: &mut State, hands: &Hands, now: Instant) {
        let Some((way, (orbit, ..))) = hands.flight().zip(state.moving()) else { return };
        let seconds = self.last.map_or(0.0, |last| (now - last).as_secs_f64());
        orbit.fly(way, seconds.min(0.25));
        self.pace.moved(now);
    }

    /// Whether there was a picture of something.
    fn present(&mut self, state: &mut State, told: &mut Told, quality: Quality) -> Result<bool> {
        let PhysicalSize { width, height } = self.window.inner_size();
        let Self { presenter, hud, screen, .. } = self;
        let shown = presenter.present([width, height], |frame| {
            state.lens.size = frame.size;
            let size = frame.size.map(|length| ((f64::from(length) * quality.side).round() as u32).max(1));
            let seen = state.frame(quality.scene).transpose()?;
            let there = seen.is_some();
            let seen = seen.as_ref().map(|(scene, camera, settings)| (*scene, camera, &**settings));
            match screen.record(frame, size, seen) {
                // Other settings may do: the window stays.
                Err(error @ (Error::Usage(_) | Error::Memory { .. })) => told.wrong = Some(error.to_string()),
                recorded => recorded?,
            }
            hud.record(frame)?;
            Ok(there)
        })?;
        Ok(shown == Some(true))
    }

    /// Turns about what is under the cursor from now on, if something is.
    fn pick(&mut self, state: &mut State) -> Result<()> {
        let Some(at) = state.pick.take() else { return Ok(()) };
        self.presenter.wait()?;
        let depth = self.screen.pick(Pick { at, size: state.lens.size });
        if let (Some(depth), Some(seen)) = (depth, state.frame(0).transpose()?) {
            let distance = seen.1.distance(depth)?;
            state.set_pivot(at, distance);
            self.window.request_redraw();
        }
        Ok(())
    }
}
