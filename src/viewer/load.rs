//! Loading, while the window is there: a preview of many points first, then all of them, then coarser scenes for while the camera moves.

use super::Loaded;
use super::events::{Event, Events};
use super::source::Source;
use std::borrow::Cow;
use std::ffi::OsString;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use surfel::geometry::Model;
use surfel::settings::methods::Method;
use surfel::vk::Device;
use surfel::{Error, Progress, Result, Scene};

/// Who is told of loads, from any thread.
pub type Window = Arc<dyn Fn(News) + Send + Sync>;

/// How many times as many surfels each scene has as the next coarser one.
const FEWER: f64 = 1.6;
/// The coarsest one has about as many.
const FEWEST: usize = 4000;
/// And no coarser one has fewer.
pub const LEAST_SURFELS: usize = 2500;
/// Part of all surfels that coarser ones still are made of.
const ENOUGH: usize = 4;

/// Gives the scene that inputs make, shows a preview of it before where that takes long, and tells how far it has come.
pub type Load = Arc<dyn Fn(&[OsString], &dyn Loading) -> Result<Loaded> + Send + Sync>;

/// Whoever waits for a scene.
pub trait Loading: Progress {
    /// Shows some of its points until all are there.
    fn preview(&self, loaded: Loaded);
}

/// What the window is told.
pub enum News {
    /// Of the load of this number.
    Load(u64, What),
    /// Files that are watched have changed.
    Changed,
    /// A picture is in its file, or cannot be.
    ScreenshotWritten,
}

/// What is new.
pub enum What {
    /// So much of a stage is done, thousandths.
    At(&'static str, u64),
    /// Some of the points are on the device.
    Preview(Arc<Scene>, Method, Box<Source>),
    /// The scene is on the device.
    Ready(Arc<Scene>, Method, Box<Source>),
    /// And so are fewer and larger surfels of it, ever fewer.
    Coarser(Vec<Arc<Scene>>),
    /// It cannot be loaded.
    Failed(Error),
}

/// Loads one scene after another, each on a thread of its own.
pub struct Loader {
    load: Load,
    window: Window,
    events: Events,
    /// `None` where there will never be one.
    device: Arc<OnceLock<Option<Arc<Device>>>>,
    /// Number of the last load, and what it is of.
    last: u64,
    inputs: Vec<OsString>,
    /// Whether the scene of the last load takes the place of an earlier state of it.
    again: bool,
    under_way: Vec<UnderWay>,
}

struct UnderWay {
    cancelled: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

impl Loader {
    /// Nothing is loaded yet.
    pub fn new(load: Load, window: Window, events: Events) -> Self {
        Self {
            load,
            window,
            events,
            device: Arc::default(),
            last: 0,
            inputs: Vec::new(),
            again: false,
            under_way: Vec::new(),
        }
    }

    /// Scenes are for this device from now on; what is loaded before waits for it.
    pub fn use_device(&mut self, device: &Arc<Device>) {
        if self.device.set(Some(device.clone())).is_err() {
            self.device = Arc::new(Some(device.clone()).into());
        }
    }

    /// Gives up what is being loaded, and what is loaded next waits for another device.
    pub fn leave_device(&mut self) {
        self.cancel();
        self.device = Arc::default();
    }

    /// Loads `inputs` as one scene, in place of what is being loaded.
    pub fn start(&mut self, inputs: Vec<OsString>) {
        self.inputs = inputs;
        self.again = false;
        self.begin();
    }

    /// Loads what is shown once more, as it is now.
    pub fn repeat(&mut self, inputs: Vec<OsString>) {
        self.inputs = inputs;
        self.again = true;
        self.begin();
    }

    /// Whether it is another state of what is shown.
    pub fn is_again(&self) -> bool {
        self.again
    }

    fn begin(&mut self) {
        let (load, inputs) = (self.load.clone(), self.inputs.clone());
        self.work(move |worker| {
            if let Err(error) = worker.load(&load, &inputs) {
                worker.send(What::Failed(error));
            }
        });
    }

    /// Makes the coarser scenes of the last load's anew, of what its surfels are now.
    pub fn coarsen(&mut self, source: Source) {
        self.work(move |worker| {
            if let Some(device) = worker.device() {
                worker.coarsen(device, &source.shown());
            }
        });
    }

    /// Does work for the last load on a thread of its own, in place of what is under way.
    fn work(&mut self, body: impl FnOnce(&Worker) + Send + 'static) {
        self.cancel();
        self.under_way.retain(|load| !load.thread.is_finished());
        let cancelled = Arc::new(AtomicBool::new(false));
        let worker = Worker {
            number: self.last,
            window: self.window.clone(),
            events: self.events,
            device: self.device.clone(),
            cancelled: cancelled.clone(),
            again: self.again,
            last: AtomicU64::new(u64::MAX),
        };
        let thread = thread::spawn(move || body(&worker));
        self.under_way.push(UnderWay { cancelled, thread });
    }

    /// Gives up what is being loaded; whether something was.
    pub fn cancel(&mut self) -> bool {
        // What it tells from now on is of no load.
        self.last += 1;
        let cancel =
            |load: &UnderWay| !load.cancelled.swap(true, Ordering::Relaxed) && !load.thread.is_finished();
        self.under_way.iter().map(cancel).fold(false, |any, one| any | one)
    }

    /// Whether this is the present load, which is not cancelled.
    pub fn is_present(&self, load: u64) -> bool {
        load == self.last
    }
}

impl Drop for Loader {
    /// Nothing is put on the device any more.
    fn drop(&mut self) {
        self.cancel();
        let _ = self.device.set(None);
        for load in self.under_way.drain(..) {
            // It has said what was wrong.
            let _ = load.thread.join();
        }
    }
}

/// Tells the window of a load.
struct Worker {
    number: u64,
    window: Window,
    events: Events,
    device: Arc<OnceLock<Option<Arc<Device>>>>,
    cancelled: Arc<AtomicBool>,
    again: bool,
    /// Thousandths of the stage that were told last.
    last: AtomicU64,
}

impl Worker {
    fn load(&self, load: &Load, inputs: &[OsString]) -> Result<()> {
        let loaded = load(inputs, self)?;
        self.events.tell(&Event::Loaded { surfels: loaded.model.surfels.len() as u64 });
        let Some(device) = self.device() else { return Ok(()) };
        self.at("uploading", 0, 1);
        let (scene, method, source) = put(loaded, device)?;
        let model = source.shown();
        self.send(What::Ready(scene, method, source));
        self.coarsen(device, &model);
        Ok(())
    }

    fn coarsen(&self, device: &Arc<Device>, model: &Model) {
        let coarser = self.coarser(device, model);
        if !self.is_cancelled() {
            self.send(What::Coarser(coarser));
        }
    }

    /// Ever fewer and larger surfels; none where there are lines or triangles, which have all to be there.
    fn coarser(&self, device: &Arc<Device>, model: &Model) -> Vec<Arc<Scene>> {
        let (mut scenes, all) = (Vec::new(), model.surfels.len());
        if !model.primitives.is_empty() {
            return scenes;
        }
        let (mut of, mut wanted, mut fewest) = (Cow::Borrowed(&model.surfels), all, all);
        while wanted > FEWEST && !self.is_cancelled() {
            wanted = (wanted as f64 / FEWER) as usize;
            let fewer = of.coarser(wanted);
            // Discs of other sides do not merge: of a thin sheet with two, there may be no fewer.
            if fewer.len() >= fewest || fewer.len() < LEAST_SURFELS {
                continue;
            }
            fewest = fewer.len();
            // Without them, frames have fewer pixels yet.
            let Ok(scene) = Scene::upload(device, &fewer) else { return scenes };
            scenes.push(Arc::new(scene));
            // From all of them the discs fit best; from fewer it takes no time.
            if fewest < all / ENOUGH && of.len() == all {
                of = Cow::Owned(fewer);
            }
        }
        scenes
    }

    /// The device, once it is there, if the scene is wanted yet.
    fn device(&self) -> Option<&Arc<Device>> {
        let device = self.device.wait().as_ref();
        device.filter(|_| !self.is_cancelled())
    }

    fn send(&self, what: What) {
        (self.window)(News::Load(self.number, what));
    }
}

impl Progress for Worker {
    /// Tells of every hundredth.
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        let part = 1000 * done / total.max(1);
        if part / 10 != self.last.swap(part, Ordering::Relaxed) / 10 {
            self.send(What::At(stage, part));
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl Loading for Worker {
    fn preview(&self, loaded: Loaded) {
        // Until all of it is there, its earlier state stays.
        let Some(device) = self.device().filter(|_| !self.again) else { return };
        // What is wrong with it is wrong with the whole scene, which says so.
        if let Ok((scene, method, source)) = put(loaded, device) {
            self.send(What::Preview(scene, method, source));
        }
    }
}

/// Puts what was loaded on the device, coloured as is asked for.
fn put(loaded: Loaded, device: &Arc<Device>) -> Result<(Arc<Scene>, Method, Box<Source>)> {
    let mut scene = Arc::new(Scene::upload(device, &loaded.model)?);
    let method = loaded.method;
    let mut source = Box::new(Source::new(loaded));
    source.apply(&mut scene, device)?;
    Ok((scene, method, source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::tests::device;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::{Duration, Instant};
    use surfel::verify::scenes;

    /// A loader, and what it tells.
    fn loader(
        load: impl Fn(&[OsString], &dyn Loading) -> Result<Loaded> + Send + Sync + 'static,
    ) -> (Loader, Receiver<News>) {
        let (send, news) = channel();
        let tell = Arc::new(move |event| drop(send.send(event)));
        (Loader::new(Arc::new(load), tell, Events::new(Instant::now(), false)), news)
    }

    fn loaded(points: u32) -> Result<Loaded> {
        let surfels = scenes::open(&format!("scene:sphere?points={points}"))?;
        Ok(Loaded::new(surfels.into(), Method::ALL[0]))
    }

    /// News of a load until its last, less how far it has come.
    fn until_coarser(loader: &Loader, news: &Receiver<News>) -> Vec<What> {
        let mut all = Vec::new();
        while !matches!(all.last(), Some(What::Coarser(_) | What::Failed(_))) {
            let event = news.recv_timeout(Duration::from_secs(60)).unwrap();
            let News::Load(load, what) = event else { panic!("another event") };
            if loader.is_present(load) && !matches!(what, What::At(..)) {
                all.push(what);
            }
        }
        all
    }

    #[test]
    fn a_preview_comes_first_and_fewer_surfels_last() {
        let Some(device) = device("a_preview_comes_first_and_fewer_surfels_last") else { return };
        let (mut loader, news) = loader(|_, window| {
            window.preview(loaded(100)?);
            loaded(30_000)
        });
        loader.start(Vec::new());
        loader.use_device(&device);
        let all = until_coarser(&loader, &news);
        let [What::Preview(preview, ..), What::Ready(whole, ..), What::Coarser(coarser)] = &all[..] else {
            panic!("{} news", all.len())
        };
        assert_eq!((preview.count(), whole.count()), (100, 30_000));
        let counts: Vec<u64> = coarser.iter().map(|scene| scene.count()).collect();
        assert!(counts.windows(2).all(|pair| pair[1] < pair[0]), "{counts:?}");
        let last = counts[counts.len() - 1] as usize;
        assert!(counts[0] > 10_000 && (LEAST_SURFELS..=2 * FEWEST).contains(&last), "{counts:?}");
    }

    #[test]
    fn of_a_thin_sheet_with_two_sides_there_is_an_end_of_fewer_surfels() {
        let Some(device) = device("of_a_thin_sheet_with_two_sides_there_is_an_end_of_fewer_surfels") else {
            return;
        };
        let (mut loader, news) = loader(|_, _| {
            let mut loaded = loaded(10_000)?;
            let surfels = &mut loaded.model.surfels;
            surfels.positions.extend_from_within(..);
            surfels.radii.extend_from_within(..);
            let other: Vec<_> = surfels.normals.iter().map(|normal| -*normal).collect();
            surfels.normals.extend(other);
            surfels.colours = None;
            Ok(loaded)
        });
        loader.use_device(&device);
        loader.start(Vec::new());
        let all = until_coarser(&loader, &news);
        let [What::Ready(whole, ..), What::Coarser(coarser)] = &all[..] else { panic!("{} news", all.len()) };
        let counts: Vec<u64> = std::iter::once(whole).chain(coarser).map(|scene| scene.count()).collect();
        assert!(counts.windows(2).all(|pair| pair[1] < pair[0]), "{counts:?}");
    }

    #[test]
    fn what_is_given_up_is_not_shown_and_another_load_takes_its_place() {
        let Some(device) = device("what_is_given_up_is_not_shown_and_another_load_takes_its_place") else {
            return;
        };
        let (mut loader, news) = loader(|inputs, window| {
            if inputs[0] != "slow" {
                return loaded(1000);
            }
            while !window.is_cancelled() {
                std::thread::yield_now();
            }
            Err(Error::Cancelled)
        });
        loader.use_device(&device);
        loader.start(vec!["slow".into()]);
        assert!(loader.cancel() && !loader.cancel(), "there is one to give up");
        loader.under_way.pop().unwrap().thread.join().unwrap();
        assert!(
            news.try_iter().all(|event| matches!(event, News::Load(load, _) if !loader.is_present(load)))
        );
        loader.start(vec!["slow".into()]);
        loader.start(vec!["quick".into()]);
        let all = until_coarser(&loader, &news);
        assert!(matches!(&all[..], [What::Ready(scene, ..), What::Coarser(_)] if scene.count() == 1000));
    }

    #[test]
    fn nobody_waits_for_a_device_that_never_comes() {
        let (mut loader, _news) = loader(|_, _| loaded(1000));
        loader.start(Vec::new());
        drop(loader);
    }

    #[test]
    fn a_scene_beyond_the_devices_memory_is_refused_with_the_sizes() {
        let Some(device) = device("a_scene_beyond_the_devices_memory_is_refused_with_the_sizes") else {
            return;
        };
        let options = surfel::vk::DeviceOptions {
            limits: surfel::vk::DeviceLimits { memory: Some(20_000), ..Default::default() },
            ..Default::default()
        };
        drop(device);
        let device = Device::open(&options).unwrap();
        let (mut loader, news) = loader(|_, _| loaded(1000));
        loader.use_device(&device);
        loader.start(Vec::new());
        let all = until_coarser(&loader, &news);
        let [What::Failed(error @ Error::Memory { bytes: 40_000, .. })] = &all[..] else {
            panic!("it is loaded")
        };
        let text = error.to_string();
        assert!(
            text.contains("1000 surfels") && text.contains("19.5 KiB") && text.contains("39.1 KiB"),
            "{text}"
        );
    }
}
