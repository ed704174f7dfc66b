//! Updates of surfels on the GPU.

use super::clusters::ClusterChange;
use super::live::check_bounds;
use super::surfel_streams::normals_with_curvatures;
use super::{ColourStream, Scene, Stream, largest};
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Colours, Curvature, Ellipse, Surfels, is_unit};
use crate::vk::Uploads;
use bytemuck::NoUninit;
use glam::Vec3;
use std::ops::Range;
use std::sync::atomic::Ordering;

/// New values of consecutive surfels of a scene. A stream that is `None` keeps its values. The scene keeps the set of streams of its
/// upload.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Changes<'a> {
    /// Centres, relative to the scene's origin.
    pub positions: Option<&'a [Vec3]>,
    /// Unit normals, or 0 for billboards.
    pub normals: Option<&'a [Vec3]>,
    /// Curvatures, together with `normals`, in a scene that has curvatures. New normals without curvatures have unknown ones.
    pub curvatures: Option<&'a [Curvature]>,
    /// Radii.
    pub radii: Option<&'a [f32]>,
    /// Which radii are of two-sided surfels, together with `radii`, in a scene that has two-sided surfels.
    pub two_sided: Option<&'a [bool]>,
    /// Ellipses, in a scene that has ellipses.
    pub ellipses: Option<&'a [Ellipse]>,
    /// Colours, in the scene's format.
    pub colours: Option<&'a Colours>,
    /// New bounds, world space. `None` extends the bounds by new positions, or replaces them if all positions are new.
    pub bounds: Option<Bounds>,
}

impl Scene {
    /// Replaces values of the surfels from index `first` on. Later frames render the new values.
    ///
    /// Normalization weights stay those of the old surfels.
    ///
    /// Invalid surfels ([`Surfels::is_valid`]) are not drawn, and are counted as `invalid`: after the first change that may make some
    /// invalid, the shaders validate every surfel. In frames of a host, use [`crate::embed::update`].
    ///
    /// # Errors
    /// [`Error::Usage`] for arrays of unequal length or beyond the scene's end; for a stream that the scene does not have, or has in
    /// another format; for normals and ellipses that clip lines or corner weights depend on; for surfels in buffers of the host. Nothing is
    /// changed then.
    pub fn update(&self, first: u64, changes: &Changes<'_>) -> Result<()> {
        self.change(&Uploads::now(self.device())?, first, changes)
    }

    /// Like [`Scene::update`], through `uploads` of the same device.
    pub(crate) fn change(&self, uploads: &Uploads<'_>, first: u64, changes: &Changes<'_>) -> Result<()> {
        let count = changes.count()?;
        let range = first..first.saturating_add(count);
        self.check(&range, changes)?;
        let bounds = changes.bounds.or_else(|| self.bounds_with(&range, changes));
        bounds.as_ref().map_or(Ok(()), check_bounds)?;
        // A new radius enables a surfel that was disabled as invalid for another reason.
        let revived = self.had_invalid && changes.radii.is_some();
        if revived || changes.may_be_invalid(self.surfels.ellipses.is_some()) {
            // Before the writes: the new values may be drawn.
            self.unchecked.store(true, Ordering::Relaxed);
        }
        if changes.normals.is_some_and(|normals| normals.contains(&Vec3::ZERO)) {
            self.billboards.store(true, Ordering::Relaxed);
        }
        if let (Some(known), Some(radii)) = (&self.largest, changes.radii) {
            // The bits of non-negative floats are in the order of the floats.
            known.fetch_max(largest(radii).to_bits(), Ordering::Relaxed);
        }
        if self.surfels.curvatures {
            // New curvatures may be of any known radius.
            let all = changes.curvatures.and(self.largest());
            let curved = changes.radii.map(largest).or(all).unwrap_or_default();
            self.largest_curved.fetch_max(curved.to_bits(), Ordering::Relaxed);
        }
        let clusters = self.clusters.as_ref();
        let clusters = clusters.map(|clusters| clusters.change(uploads, range, changes, self.capacity()));
        let clusters = clusters.transpose()?.flatten();
        write(uploads, Some(&self.surfels.positions), first, changes.positions)?;
        if self.surfels.curvatures {
            let values = changes.normals.map(|normals| normals_with_curvatures(normals, changes.curvatures));
            write(uploads, Some(&self.surfels.normals), first, values.as_deref())?;
        } else {
            write(uploads, Some(&self.surfels.normals), first, changes.normals)?;
        }
        let radii = changes.radii.map(|radii| marked(radii, changes.two_sided));
        write(uploads, self.surfels.radii(), first, radii.as_deref())?;
        write(uploads, self.surfels.ellipses.as_ref(), first, changes.ellipses)?;
        match changes.colours {
            Some(Colours::Srgb8(colours)) => write(uploads, self.colours.as_ref(), first, Some(colours))?,
            Some(Colours::Linear(colours)) => write(uploads, self.colours.as_ref(), first, Some(colours))?,
            None => {}
        }
        match (changes.bounds, bounds) {
            (Some(set), _) => self.set_bounds(set)?,
            (None, Some(bounds)) => self.store_bounds(bounds),
            (None, None) => {}
        }
        clusters.into_iter().for_each(ClusterChange::keep);
        Ok(())
    }

    fn check(&self, range: &Range<u64>, changes: &Changes<'_>) -> Result<()> {
        let refuse = |what: &str| Err(Error::Usage(format!("surfels {range:?} cannot be updated: {what}")));
        let kind = changes.colours.map(|colours| match colours {
            Colours::Srgb8(_) => ColourStream::Srgb8,
            Colours::Linear(_) => ColourStream::Linear,
        });
        let corners = self.weights.as_ref().is_some_and(|weights| weights.corners);
        let turned = changes.normals.is_some() || changes.ellipses.is_some();
        let marks = self.clips.is_some() || self.weights.is_some() || self.texture.is_some();
        if self.of_host {
            return refuse("they are in buffers of the host: write them there");
        } else if self.levels.is_some() {
            return refuse(
                "the scene has levels of detail, which would not follow: upload the points without",
            );
        } else if self.surfels.radii().is_none() {
            return refuse("the scene stores them quantized: upload it in SurfelFormat::Float");
        } else if range.end > self.capacity() {
            return refuse(&format!("the scene has room for {}", self.capacity()));
        } else if changes.ellipses.is_some() && self.surfels.ellipses.is_none() {
            return refuse("the scene has circles: upload it with ellipses");
        } else if changes.curvatures.is_some() && (!self.surfels.curvatures || changes.normals.is_none()) {
            return refuse("curvatures need normals, and a scene that was uploaded with curvatures");
        } else if changes.two_sided.is_some() && (!self.two_sided || changes.radii.is_none()) {
            return refuse("two_sided needs radii, and a scene that was uploaded with two-sided surfels");
        } else if self.two_sided && changes.radii.is_some() && changes.two_sided.is_none() {
            return refuse("the scene has two-sided surfels: give two_sided along with radii");
        } else if kind.is_some_and(|kind| kind != self.colour_stream) {
            return refuse(&format!("the scene has colours of format {:?}: give these", self.colour_stream));
        } else if changes.normals.is_some() && self.clips.is_some() {
            return refuse("clip lines depend on the normals: upload surfels and clip lines anew");
        } else if turned && corners {
            return refuse("corner weights depend on the discs' axes: upload surfels and weights anew");
        } else if changes.radii.is_some() && self.had_invalid && marks {
            return refuse(
                "some were invalid at the upload, and a new radius would draw them with clip lines, weights or texture coordinates that may be invalid: upload Surfels::valid",
            );
        }
        Ok(())
    }

    /// Bounds with the new positions, or of these alone.
    fn bounds_with(&self, range: &Range<u64>, changes: &Changes<'_>) -> Option<Bounds> {
        let positions = changes.positions?;
        // Copy only if some are left out.
        let valid: Vec<Vec3> = if positions.iter().all(is_bounded) {
            Vec::new()
        } else {
            positions.iter().copied().filter(is_bounded).collect()
        };
        // Positions that are not finite do not change the bounds.
        positions.iter().any(is_bounded).then_some(())?;
        let of_positions = Bounds::of(if valid.is_empty() { positions } else { &valid })?;
        let largest = changes.radii.map(largest).or(self.largest()).unwrap_or_default();
        let added = of_positions.grown(largest.into()).translated(self.origin);
        let whole = *range == (0..self.capacity()) && self.primitives.is_none();
        Some(if whole { added } else { self.bounds().with(&added) })
    }
}

impl Changes<'_> {
    /// Number of surfels.
    fn count(&self) -> Result<u64> {
        let lengths = [
            self.positions.map(<[_]>::len),
            self.normals.map(<[_]>::len),
            self.curvatures.map(<[_]>::len),
            self.radii.map(<[_]>::len),
            self.two_sided.map(<[_]>::len),
            self.ellipses.map(<[_]>::len),
            self.colours.map(Colours::len),
        ];
        let mut given = lengths.into_iter().flatten();
        let first = given.next().unwrap_or(0);
        if given.all(|length| length == first) {
            Ok(first as u64)
        } else {
            Err(Error::Usage(format!(
                "arrays of positions, normals, curvatures, radii, two_sided, ellipses, colours have unequal lengths {lengths:?}: give one entry per surfel"
            )))
        }
    }

    /// Whether some surfel may become invalid. Invalid radii are marked as such.
    fn may_be_invalid(&self, ellipses: bool) -> bool {
        let shaped = |e: &Ellipse| is_unit(e.major) && e.aspect > 0.0 && e.aspect <= 1.0;
        // An ellipse must be orthogonal to its normal, which may be the old one.
        let turned = ellipses && (self.normals.is_some() || self.ellipses.is_some());
        turned
            || !self.positions.unwrap_or_default().iter().all(is_bounded)
            || !self.normals.unwrap_or_default().iter().all(|&normal| normal == Vec3::ZERO || is_unit(normal))
            || !self.ellipses.unwrap_or_default().iter().all(shaped)
            || match self.colours {
                Some(Colours::Linear(colours)) => !colours.iter().all(|colour| is_bounded(&(*colour).into())),
                Some(Colours::Srgb8(_)) | None => false,
            }
    }
}

fn is_bounded(v: &Vec3) -> bool {
    v.abs().cmple(Vec3::splat(Surfels::LARGEST)).all()
}

/// Radii as scenes store them; invalid ones are 0.
fn marked(radii: &[f32], two_sided: Option<&[bool]>) -> Vec<f32> {
    let valid = |radius: f32| if radius > 0.0 && radius <= Surfels::LARGEST { radius } else { 0.0 };
    let sign = |i: usize| if two_sided.is_some_and(|two_sided| two_sided[i]) { -1.0 } else { 1.0 };
    radii.iter().enumerate().map(|(i, radius)| sign(i) * valid(*radius)).collect()
}

fn write<T: NoUninit>(
    uploads: &Uploads<'_>,
    stream: Option<&Stream>,
    first: u64,
    values: Option<&[T]>,
) -> Result<()> {
    match (stream, values) {
        (Some(stream), Some(values)) if !values.is_empty() => {
            uploads.write(&stream.buffer, first * stream.stride, bytemuck::cast_slice(values))
        }
        _ => Ok(()),
    }
}
