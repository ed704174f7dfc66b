//! Background loading: a preview of many points first, then the whole scene with its levels of detail.

use super::events::{Event, Events};
use super::levels;
use super::source::Source;
use super::{LoadRequest, Loaded};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use surfel::geometry::{Model, SurfelFormat};
use surfel::settings::methods::Method;
use surfel::vk::Device;
use surfel::{Error, Progress, Result, Scene};

/// Sends events to the window, from any thread.
pub type EventSink = Arc<dyn Fn(AppEvent) + Send + Sync>;

/// Loads inputs as one scene. Reports its progress to the listener, and a preview where loading takes long.
pub type Load = Arc<dyn Fn(&LoadRequest, &dyn LoadListener) -> Result<Loaded> + Send + Sync>;

/// Receives the progress and the preview of a load.
pub trait LoadListener: Progress {
    /// Shows some of the points until all are loaded.
    fn preview(&self, loaded: Loaded);
}

/// An event of the window's background threads.
pub enum AppEvent {
    /// Of the load of this number.
    Load(u64, LoadEvent),
    /// Watched files have changed.
    FilesChanged,
    /// A screenshot was written, or could not be.
    ScreenshotWritten,
}

/// An event of a load.
pub enum LoadEvent {
    /// A stage, and how much of it is done, in thousandths.
    Progress(&'static str, u64),
    /// Some of the points are on the device.
    Preview(Arc<Scene>, Method, Box<Source>),
    /// The scene is on the device with its levels of detail, if it has any.
    Ready(Arc<Scene>, Method, Box<Source>),
    /// The changed scene is on the device with its levels of detail, if it has any.
    Levels(Option<Arc<Scene>>),
    /// Loading failed.
    Failed(Error),
}

/// Loads one scene at a time, each on its own thread.
pub struct Loader {
    load: Load,
    sink: EventSink,
    events: Events,
    /// The device that scenes are uploaded to; `None` once the loader is dropped.
    device: Arc<OnceLock<Option<Arc<Device>>>>,
    /// Number of the last load.
    last: u64,
    /// Whether the last load reloads the inputs of the scene that is shown.
    reload: bool,
    threads: Vec<LoadThread>,
}

struct LoadThread {
    cancelled: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

impl Loader {
    /// A loader without a load.
    pub fn new(load: Load, sink: EventSink, events: Events) -> Self {
        let (device, threads) = (Arc::default(), Vec::new());
        Self { load, sink, events, device, last: 0, reload: false, threads }
    }

    /// Sets the device that scenes are uploaded to. Loads that started before wait for it.
    pub fn use_device(&mut self, device: &Arc<Device>) {
        if self.device.set(Some(device.clone())).is_err() {
            self.device = Arc::new(Some(device.clone()).into());
        }
    }

    /// Cancels the load; the next one waits for another device.
    pub fn leave_device(&mut self) {
        self.cancel();
        self.device = Arc::default();
    }

    /// Loads a scene and cancels the load before. With `reload` its inputs are those of the scene that is shown, which stays until its new state
    /// is loaded.
    pub fn start(&mut self, request: LoadRequest, reload: bool) {
        self.reload = reload;
        let load = self.load.clone();
        self.spawn(move |worker| {
            if let Err(error) = worker.load(&load, &request) {
                worker.send(LoadEvent::Failed(error));
            }
        });
    }

    /// Whether the last load reloads the inputs of the scene that is shown.
    pub fn is_reload(&self) -> bool {
        self.reload
    }

    /// Rebuilds the levels of detail of the last load from what its surfels are now.
    pub fn rebuild_levels(&mut self, source: Source) {
        self.spawn(move |worker| {
            if let Some(device) = worker.device() {
                // A load that is cancelled sends nothing.
                if let Ok(levels) =
                    levels::upload(device, &source.visible_model(), source.format, &Silent(worker))
                {
                    worker.send(LoadEvent::Levels(levels));
                }
            }
        });
    }

    /// Runs work of a new load on its own thread and cancels the load before.
    fn spawn(&mut self, body: impl FnOnce(&Worker) + Send + 'static) {
        self.cancel();
        self.threads.retain(|load| !load.thread.is_finished());
        let cancelled = Arc::new(AtomicBool::new(false));
        let worker = Worker {
            number: self.last,
            sink: self.sink.clone(),
            events: self.events,
            device: self.device.clone(),
            cancelled: cancelled.clone(),
            reload: self.reload,
            reported: AtomicU64::new(u64::MAX),
        };
        let thread = thread::spawn(move || body(&worker));
        self.threads.push(LoadThread { cancelled, thread });
    }

    /// Cancels the load; returns whether one was running.
    pub fn cancel(&mut self) -> bool {
        // Later events of the cancelled load have an old number.
        self.last += 1;
        let cancel =
            |load: &LoadThread| !load.cancelled.swap(true, Ordering::Relaxed) && !load.thread.is_finished();
        self.threads.iter().map(cancel).fold(false, |any, one| any | one)
    }

    /// Whether this is the number of the last load, and that is not cancelled.
    pub fn is_present(&self, load: u64) -> bool {
        load == self.last
    }
}

impl Drop for Loader {
    /// Waits for all threads, so that nothing uses the device any more.
    fn drop(&mut self) {
        self.cancel();
        let _ = self.device.set(None);
        for load in self.threads.drain(..) {
            // A panic has been printed by its thread.
            let _ = load.thread.join();
        }
    }
}

/// A load on its thread.
struct Worker {
    number: u64,
    sink: EventSink,
    events: Events,
    device: Arc<OnceLock<Option<Arc<Device>>>>,
    cancelled: Arc<AtomicBool>,
    reload: bool,
    /// The progress that was reported last, thousandths of the stage.
    reported: AtomicU64,
}

impl Worker {
    fn load(&self, load: &Load, request: &LoadRequest) -> Result<()> {
        let loaded = load(request, self)?;
        self.events.emit(&Event::Loaded { surfels: loaded.model.surfels.len() as u64 });
        let Some(device) = self.device() else { return Ok(()) };
        let method = loaded.method;
        let (scene, source) =
            upload(loaded, |model, format| levels::upload_with(device, model, format, self))?;
        self.send(LoadEvent::Ready(scene, method, source));
        Ok(())
    }

    /// Waits for the device; `None` if the load is cancelled.
    fn device(&self) -> Option<&Arc<Device>> {
        let device = self.device.wait().as_ref();
        device.filter(|_| !self.is_cancelled())
    }

    fn send(&self, event: LoadEvent) {
        (self.sink)(AppEvent::Load(self.number, event));
    }
}

impl Progress for Worker {
    /// Reports every hundredth.
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        let part = 1000 * done / total.max(1);
        if part / 10 != self.reported.swap(part, Ordering::Relaxed) / 10 {
            self.send(LoadEvent::Progress(stage, part));
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Work behind the scene that is shown: it is cancelled with its load, and its progress is not shown.
struct Silent<'a>(&'a Worker);

impl Progress for Silent<'_> {
    fn at(&self, _: &'static str, _: u64, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

impl LoadListener for Worker {
    /// Uploads the preview. The previous state of reloaded inputs is shown instead; an error of a preview is one of the whole scene, too,
    /// which reports it.
    fn preview(&self, loaded: Loaded) {
        let Some(device) = self.device().filter(|_| !self.reload) else { return };
        let method = loaded.method;
        if let Ok((scene, source)) = upload(loaded, |model, _| Scene::upload(device, model).map(Arc::new)) {
            self.send(LoadEvent::Preview(scene, method, source));
        }
    }
}

/// Uploads what was loaded, coloured as it asks for.
fn upload(
    loaded: Loaded,
    to_device: impl FnOnce(&Model, SurfelFormat) -> Result<Arc<Scene>>,
) -> Result<(Arc<Scene>, Box<Source>)> {
    let mut source = Box::new(Source::new(loaded));
    let scene = to_device(&source.begin(), source.format)?;
    Ok((scene, source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::tests::device;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::{Duration, Instant};
    use surfel::verify::scenes;

    /// A loader, and its events.
    fn loader(
        load: impl Fn(&LoadRequest, &dyn LoadListener) -> Result<Loaded> + Send + Sync + 'static,
    ) -> (Loader, Receiver<AppEvent>) {
        let (send, events) = channel();
        let sink = Arc::new(move |event| drop(send.send(event)));
        (Loader::new(Arc::new(load), sink, Events::new(Instant::now(), false)), events)
    }

    fn named(input: &str) -> LoadRequest {
        LoadRequest { inputs: vec![input.into()], ..Default::default() }
    }

    fn loaded(points: u32) -> Result<Loaded> {
        let surfels = scenes::open(&format!("scene:sphere?points={points}"))?;
        Ok(Loaded::new(surfels.into(), Method::ALL[0]))
    }

    /// The events of a load up to its last one, without its progress.
    fn until_ready(loader: &Loader, events: &Receiver<AppEvent>) -> Vec<LoadEvent> {
        let mut all = Vec::new();
        while !matches!(all.last(), Some(LoadEvent::Ready(..) | LoadEvent::Failed(_))) {
            let event = events.recv_timeout(Duration::from_secs(60)).unwrap();
            let AppEvent::Load(load, what) = event else { panic!("another event") };
            if loader.is_present(load) && !matches!(what, LoadEvent::Progress(..)) {
                all.push(what);
            }
        }
        all
    }

    #[test]
    fn the_preview_comes_first_and_then_the_scene_with_its_levels_of_detail() {
        let name = "the_preview_comes_first_and_then_the_scene_with_its_levels_of_detail";
        let Some(device) = device(name) else { return };
        let (mut loader, events) = loader(|_, listener| {
            listener.preview(loaded(100)?);
            loaded(30_000)
        });
        loader.start(LoadRequest::default(), false);
        loader.use_device(&device);
        let all = until_ready(&loader, &events);
        let [LoadEvent::Preview(preview, ..), LoadEvent::Ready(whole, ..)] = &all[..] else {
            panic!("{} events", all.len())
        };
        assert_eq!((preview.count(), whole.point_count()), (100, 30_000));
        assert!(whole.level_table().is_some_and(|table| table.starts().len() > 3));
    }

    #[test]
    fn both_sides_of_a_sheet_have_levels_of_detail() {
        let Some(device) = device("both_sides_of_a_sheet_have_levels_of_detail") else {
            return;
        };
        let (mut loader, events) = loader(|_, _| {
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
        loader.start(LoadRequest::default(), false);
        let all = until_ready(&loader, &events);
        let [LoadEvent::Ready(levels, ..)] = &all[..] else { panic!("{} events", all.len()) };
        let starts = levels.level_table().unwrap().starts();
        assert!(starts[0] == 20_000 && levels.count() < 32_000, "{starts:?} of {}", levels.count());
    }

    #[test]
    fn a_cancelled_load_is_not_shown_and_another_replaces_it() {
        let Some(device) = device("a_cancelled_load_is_not_shown_and_another_replaces_it") else {
            return;
        };
        let (mut loader, events) = loader(|request, listener| {
            if request.inputs[0] != "slow" {
                return loaded(1000);
            }
            while !listener.is_cancelled() {
                std::thread::yield_now();
            }
            Err(Error::Cancelled)
        });
        loader.use_device(&device);
        loader.start(named("slow"), false);
        assert!(loader.cancel() && !loader.cancel(), "one load is running");
        loader.threads.pop().unwrap().thread.join().unwrap();
        assert!(
            events
                .try_iter()
                .all(|event| matches!(event, AppEvent::Load(load, _) if !loader.is_present(load)))
        );
        loader.start(named("slow"), false);
        loader.start(named("fast"), false);
        let all = until_ready(&loader, &events);
        assert!(matches!(&all[..], [LoadEvent::Ready(scene, ..)] if scene.point_count() == 1000));
    }

    #[test]
    fn dropping_the_loader_does_not_wait_for_a_device() {
        let (mut loader, _events) = loader(|_, _| loaded(1000));
        loader.start(LoadRequest::default(), false);
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
        let (mut loader, events) = loader(|_, _| loaded(1000));
        loader.use_device(&device);
        loader.start(LoadRequest::default(), false);
        let all = until_ready(&loader, &events);
        let [LoadEvent::Failed(error @ Error::Memory { bytes: 40_000, .. })] = &all[..] else {
            panic!("the scene is loaded")
        };
        let text = error.to_string();
        assert!(
            text.contains("1000 surfels") && text.contains("19.5 KiB") && text.contains("39.1 KiB"),
            "{text}"
        );
    }
}
