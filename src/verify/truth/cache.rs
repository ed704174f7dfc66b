//! Cache of exact images on disk.

use super::options::{Filter, Options};
use super::traceable::Traceable;
use super::{StandardError, Truth, render};
use crate::error::{Error, Result};
use crate::formats::{atomic, image};
use crate::geometry::Camera;
use crate::progress::Progress;
use crate::settings::Settings;
use crate::verify::scenes::random::Random;
use crate::verify::scenes::{SAMPLING, is_scene};
use glam::DVec3;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::{Xxh3, xxh3_128};

/// Version of the tracer; bumped when it renders the same request differently.
const VERSION: u32 = 1;

/// Rays of a scene's fingerprint, which supplements its name.
const FINGERPRINT: usize = 1024;

/// A folder of exact images, two files each: `HASH.exr`, and `HASH.txt` with its checksum and its error.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// A cache in a folder, which is created when the first image is stored.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// [`render`] with caching. `name` is the scene's text or [`Mesh::digest`](super::Mesh::digest); sampling
    /// parameters, which do not change the surface, are ignored. The key includes a fingerprint of traced rays, so a
    /// changed scene does not match. Damaged files are replaced; a failure to write is logged.
    ///
    /// # Errors
    /// As [`render`].
    #[expect(clippy::too_many_arguments, reason = "a name, and what `render` takes")]
    pub fn render<S: Traceable + ?Sized>(
        &self,
        name: &str,
        scene: &S,
        camera: &Camera,
        settings: &Settings,
        size: [u32; 2],
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Truth> {
        let path = self.path(name, scene, camera, settings, size, options);
        if let Some(truth) = load(&path).filter(|truth| truth.picture.size == size) {
            return Ok(truth);
        }
        let truth = render(scene, camera, settings, size, options, progress)?;
        if let Err(error) = self.store(&path, &truth) {
            log::warn!("the exact image is not kept: {error}");
        }
        Ok(truth)
    }

    /// Path of the image of a request.
    pub fn path<S: Traceable + ?Sized>(
        &self,
        name: &str,
        scene: &S,
        camera: &Camera,
        settings: &Settings,
        size: [u32; 2],
        options: &Options,
    ) -> PathBuf {
        let mut hash = Xxh3::new();
        hash.update(&VERSION.to_le_bytes());
        text(&mut hash, &surface_of(name));
        fingerprint(&mut hash, scene);
        for matrix in [camera.view, camera.projection] {
            numbers(&mut hash, &matrix.to_cols_array());
        }
        hash.update(&[camera.reversed.into()]);
        size.iter().for_each(|side| {
            hash.update(&side.to_le_bytes());
        });
        // Numbers are printed with all digits.
        let Settings { shading, background, lighting, .. } = settings;
        text(&mut hash, &format!("{shading:?} {background:?} {lighting:?}"));
        let Options { filter, error, most_samples } = options;
        // Neither affects single rays.
        let (error, most_samples) = if *filter == Filter::Point { (&0.0, &0) } else { (error, most_samples) };
        text(&mut hash, &format!("{filter:?} {error:?} {most_samples}"));
        self.folder.join(format!("{:032x}.exr", hash.digest128()))
    }

    fn store(&self, path: &Path, truth: &Truth) -> Result<()> {
        fs::create_dir_all(&self.folder).map_err(Error::io(&self.folder, "cannot make the folder"))?;
        image::write_exr(&truth.picture, path)?;
        let sum = digest(&fs::read(path).map_err(Error::io(path, "cannot read"))?);
        let StandardError { rms, max, above } = truth.error;
        atomic::write(&path.with_extension("txt"), |out| write!(out, "{sum} {rms:?} {max:?} {above}"))
    }
}

/// Loads an image; `None` if it is missing or damaged.
fn load(path: &Path) -> Option<Truth> {
    let note = fs::read_to_string(path.with_extension("txt")).ok()?;
    let mut words = note.split(' ');
    if words.next()? != digest(&fs::read(path).ok()?) {
        return None;
    }
    let mut number = || words.next()?.parse().ok();
    let (rms, max) = (number()?, number()?);
    let above = words.next()?.parse().ok()?;
    Some(Truth { picture: image::read(path).ok()?, error: StandardError { rms, max, above } })
}

/// Digest of a file, 32 hexadecimal digits.
fn digest(bytes: &[u8]) -> String {
    format!("{:032x}", xxh3_128(bytes))
}

/// A scene's text without its sampling parameters.
fn surface_of(name: &str) -> String {
    let Some((scene, query)) = name.split_once('?').filter(|_| is_scene(name)) else { return name.into() };
    let samples =
        |pair: &str| SAMPLING.iter().any(|parameter| pair.split('=').next() == Some(parameter.name));
    let mut pairs: Vec<_> = query.split('&').filter(|pair| !pair.is_empty() && !samples(pair)).collect();
    pairs.sort_unstable();
    if pairs.is_empty() { scene.into() } else { format!("{scene}?{}", pairs.join("&")) }
}

/// Hashes the hits of random rays, bit by bit.
fn fingerprint<S: Traceable + ?Sized>(hash: &mut Xxh3, scene: &S) {
    let bounds = scene.bounds();
    numbers(hash, &[bounds.min, bounds.max].map(|corner| corner.to_array()).concat());
    let mut random = Random::new(1, 1);
    let mut point = |scale: f64| {
        let at = DVec3::from_array(std::array::from_fn(|_| random.unit()));
        bounds.centre() + scale * (at - 0.5) * (bounds.max - bounds.min)
    };
    for _ in 0..FINGERPRINT {
        let (from, to) = (point(4.0), point(1.0));
        let Some(hit) = scene.trace(from, to - from) else { continue };
        numbers(hash, &[hit.t, hit.normal.x, hit.normal.y, hit.normal.z]);
        numbers(hash, &hit.albedo.unwrap_or([-1.0; 3]));
    }
}

fn numbers(hash: &mut Xxh3, numbers: &[f64]) {
    numbers.iter().for_each(|number| {
        hash.update(&number.to_le_bytes());
    });
}

fn text(hash: &mut Xxh3, text: &str) {
    hash.update(&(text.len() as u64).to_le_bytes());
    hash.update(text.as_bytes());
}
