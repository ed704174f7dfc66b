//! Exact images kept on disk, by what they are of.

use super::options::{Filter, Options};
use super::scene::Scene;
use super::{Achieved, Truth, render};
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

/// Rises whenever the tracer makes other images of the same request.
const VERSION: u32 = 1;

/// Rays by which a scene is recognised beside its name.
const FINGERPRINT: usize = 1024;

/// A folder of exact images, two files each: `HASH.exr`, and `HASH.txt` with its checksum and how exact it is.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// A cache in a folder, which is made when there is something to keep.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// [`render`], unless the same has been rendered before. `name` is the scene's text or [`Mesh::digest`](super::Mesh::digest);
    /// parameters of the samples, which do not change the surface, are passed over. A scene whose definition has changed is told from
    /// what it was by what rays meet. Files that are damaged are replaced; where none can be written it is logged.
    ///
    /// # Errors
    /// As [`render`].
    #[expect(clippy::too_many_arguments, reason = "a name, and what `render` takes")]
    pub fn render<S: Scene + ?Sized>(
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

    /// Where the image of a request is or would be.
    pub fn path<S: Scene + ?Sized>(
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
        // Numbers are printed with all their digits.
        let Settings { shading, background, lighting, .. } = settings;
        text(&mut hash, &format!("{shading:?} {background:?} {lighting:?}"));
        let Options { filter, error, most_samples } = options;
        // Neither matters to single rays.
        let (error, most_samples) = if *filter == Filter::Point { (&0.0, &0) } else { (error, most_samples) };
        text(&mut hash, &format!("{filter:?} {error:?} {most_samples}"));
        self.folder.join(format!("{:032x}.exr", hash.digest128()))
    }

    fn store(&self, path: &Path, truth: &Truth) -> Result<()> {
        fs::create_dir_all(&self.folder).map_err(Error::io(&self.folder, "cannot make the folder"))?;
        image::write_exr(&truth.picture, path)?;
        let sum = digest(&fs::read(path).map_err(Error::io(path, "cannot read"))?);
        let Achieved { rms, max, above } = truth.error;
        atomic::write(&path.with_extension("txt"), |out| write!(out, "{sum} {rms:?} {max:?} {above}"))
    }
}

/// What is in a cache at a path; nothing if it is not as it was written.
fn load(path: &Path) -> Option<Truth> {
    let note = fs::read_to_string(path.with_extension("txt")).ok()?;
    let mut words = note.split(' ');
    if words.next()? != digest(&fs::read(path).ok()?) {
        return None;
    }
    let mut number = || words.next()?.parse().ok();
    let (rms, max) = (number()?, number()?);
    let above = words.next()?.parse().ok()?;
    Some(Truth { picture: image::read(path).ok()?, error: Achieved { rms, max, above } })
}

/// Of a file, 32 hexadecimal digits.
fn digest(bytes: &[u8]) -> String {
    format!("{:032x}", xxh3_128(bytes))
}

/// A scene's text without the parameters of its samples.
fn surface_of(name: &str) -> String {
    let Some((scene, query)) = name.split_once('?').filter(|_| is_scene(name)) else { return name.into() };
    let samples =
        |pair: &str| SAMPLING.iter().any(|parameter| pair.split('=').next() == Some(parameter.name));
    let mut pairs: Vec<_> = query.split('&').filter(|pair| !pair.is_empty() && !samples(pair)).collect();
    pairs.sort_unstable();
    if pairs.is_empty() { scene.into() } else { format!("{scene}?{}", pairs.join("&")) }
}

/// What rays through the scene meet, bit by bit.
fn fingerprint<S: Scene + ?Sized>(hash: &mut Xxh3, scene: &S) {
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
