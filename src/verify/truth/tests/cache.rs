//! Exact images on disk.

use crate::Progress;
use crate::geometry::Camera;
use crate::settings::{Lighting, Settings, Shading};
use crate::verify::scenes;
use crate::verify::truth::{Cache, Filter, Options, Truth};
use glam::DMat4;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

const SIZE: [u32; 2] = [12, 10];

/// Counts rendered images.
#[derive(Default)]
struct Count(AtomicU64);

impl Progress for Count {
    fn at(&self, _: &'static str, done: u64, _: u64) {
        self.0.fetch_add(u64::from(done == 0), Ordering::Relaxed);
    }
}

struct Request<'a> {
    name: &'a str,
    settings: Settings,
    options: Options,
}

impl Request<'_> {
    fn camera(&self) -> Camera {
        scenes::camera("scene:torus")
            .unwrap()
            .camera(1.2, &scenes::surface("scene:torus").unwrap().bounds())
            .unwrap()
    }

    fn render(&self, cache: &Cache, count: &Count) -> Truth {
        let surface = scenes::surface(self.name).unwrap();
        cache
            .render(self.name, &*surface, &self.camera(), &self.settings, SIZE, &self.options, count)
            .unwrap()
    }

    fn path(&self, cache: &Cache) -> PathBuf {
        let surface = scenes::surface(self.name).unwrap();
        cache.path(self.name, &*surface, &self.camera(), &self.settings, SIZE, &self.options)
    }
}

fn request(name: &str) -> Request<'_> {
    Request { name, settings: Settings::default(), options: Options::default() }
}

#[test]
fn what_was_rendered_comes_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, count, torus) =
        (Cache::new(folder.path().join("a/b")), Count::default(), request("scene:torus"));
    let first = torus.render(&cache, &count);
    assert!(torus.path(&cache).is_file());
    assert_eq!((torus.render(&cache, &count), count.0.load(Ordering::Relaxed)), (first, 1));
}

#[test]
fn damaged_files_are_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, count, torus) = (Cache::new(folder.path()), Count::default(), request("scene:torus"));
    let first = torus.render(&cache, &count);
    let (image, note) = (torus.path(&cache), torus.path(&cache).with_extension("txt"));
    let (whole, noted) = (fs::read(&image).unwrap(), fs::read(&note).unwrap());
    let mut wrong = whole.clone();
    // In the pixel values, where the format cannot detect an error.
    let middle = wrong.len() / 2;
    wrong[middle] ^= 1;
    let damages: [(&PathBuf, &[u8]); 5] = [
        (&image, &wrong),
        (&image, &whole[..middle]),
        (&image, b""),
        (&note, b"x 0 0 0"),
        (&note, &noted[..70]),
    ];
    for (renders, (file, contents)) in damages.into_iter().enumerate() {
        fs::write(file, contents).unwrap();
        assert_eq!(torus.render(&cache, &count), first);
        assert_eq!(count.0.load(Ordering::Relaxed), renders as u64 + 2);
        assert_eq!((fs::read(&image).unwrap(), fs::read(&note).unwrap()), (whole.clone(), noted.clone()));
    }
}

#[test]
fn a_path_tells_images_apart_and_nothing_else() {
    let cache = Cache::new("somewhere");
    let path = |request: Request<'_>| request.path(&cache);
    let usual = path(request("scene:torus"));
    assert!(usual.starts_with("somewhere") && usual.extension().unwrap() == "exr");
    for same in ["scene:torus?", "scene:torus?points=7&seed=3", "scene:torus?noise=1&sampler=grid"] {
        assert_eq!(path(request(same)), usual, "{same}");
    }
    let splats = Settings { cutoff: 3.0, lowpass: 0.0, epsilon: 2.0, ..Default::default() };
    assert_eq!(path(Request { settings: splats, ..request("scene:torus") }), usual);

    let settings = |settings| Request { settings, ..request("scene:torus") };
    let options = |options| Request { options, ..request("scene:torus") };
    let point = |error| options(Options { filter: Filter::Point, error, ..Default::default() });
    let mut others = vec![
        usual,
        path(request("scene:torus?frequency=3")),
        path(request("scene:torus?frequency=3&minor=0.3")),
        path(request("scene:sphere")),
        path(settings(Settings { shading: Shading::Colour, ..Default::default() })),
        path(settings(Settings { background: Some([0.0; 3]), ..Default::default() })),
        path(options(Options { error: 0.1, ..Default::default() })),
        path(options(Options { filter: Filter::Gaussian { variance: 1.5 }, ..Default::default() })),
        path(options(Options { filter: Filter::Box, ..Default::default() })),
        path(point(0.1)),
        path(options(Options { most_samples: 256, ..Default::default() })),
        path(settings(Settings {
            lighting: Lighting { ambient: 0.2, ..Default::default() },
            ..Default::default()
        })),
    ];
    assert_eq!(path(point(0.2)), others[9], "single rays have no error");
    assert_eq!(path(request("scene:torus?minor=0.3&frequency=3")), others[2]);
    let count = others.len();
    others.sort();
    others.dedup();
    assert_eq!(others.len(), count);
}

#[test]
fn every_number_of_the_camera_and_the_size_tell_images_apart() {
    let (cache, torus) = (Cache::new("somewhere"), request("scene:torus"));
    let surface = scenes::surface(torus.name).unwrap();
    let path = |camera: Camera, size| {
        cache.path(torus.name, &*surface, &camera, &torus.settings, size, &torus.options)
    };
    let usual = torus.camera();
    let mut paths = vec![path(usual, SIZE), path(usual, [10, 12]), path(usual, [12, 11])];
    paths.push(path(Camera { reversed: !usual.reversed, ..usual }, SIZE));
    for i in 0..16 {
        let nudged = |matrix: DMat4| {
            let mut numbers = matrix.to_cols_array();
            numbers[i] += 1e-9;
            DMat4::from_cols_array(&numbers)
        };
        paths.push(path(Camera { view: nudged(usual.view), ..usual }, SIZE));
        paths.push(path(Camera { projection: nudged(usual.projection), ..usual }, SIZE));
    }
    let count = paths.len();
    paths.sort();
    paths.dedup();
    assert_eq!(paths.len(), count);
}

#[test]
fn a_scene_that_has_changed_is_another_under_the_same_name() {
    let cache = Cache::new("somewhere");
    let torus = request("scene:torus");
    let path = |text: &str| {
        let surface = scenes::surface(text).unwrap();
        cache.path("scene:torus", &*surface, &torus.camera(), &torus.settings, SIZE, &torus.options)
    };
    // Another shape; then other colours only.
    assert_ne!(path("scene:torus"), path("scene:torus?minor=0.41"));
    assert_ne!(path("scene:torus"), path("scene:torus?frequency=3"));
}
