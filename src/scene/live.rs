//! State of a scene that may change between frames, beside the values of its surfels.

use super::{PrimitiveStreams, Scene};
use crate::error::{Error, Result};
use crate::geometry::Bounds;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;

impl Scene {
    /// Number of surfels to draw.
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// Maximum number of surfels.
    pub fn capacity(&self) -> u64 {
        self.chunks.last().map_or(0, |chunk| chunk.end)
    }

    /// Number of point ids: the maximum numbers of surfels, segments and triangles.
    pub(crate) fn id_count(&self) -> u64 {
        let elements = |primitives: &PrimitiveStreams| {
            let kinds = [&primitives.lines, &primitives.triangles];
            kinds.into_iter().flatten().map(|elements| u64::from(elements.count)).sum::<u64>()
        };
        self.capacity() + self.primitives.as_ref().map_or(0, elements)
    }

    /// Sets the number of surfels to draw in frames that are prepared later: the first `count`.
    ///
    /// # Errors
    /// [`Error::Usage`] if `count` exceeds [`Scene::capacity`], and in a scene with clip lines, whose stream depends on the count.
    pub fn set_count(&self, count: u64) -> Result<()> {
        let capacity = self.capacity();
        if count > capacity {
            let text = format!("{count} surfels of a scene with room for {capacity}: give at most that");
            return Err(Error::Usage(text));
        }
        if self.clips.is_some() && count != self.count() {
            let text = format!(
                "a scene with clip lines always has its {capacity} surfels: upload fewer, or leave out the clip lines"
            );
            return Err(Error::Usage(text));
        }
        self.count.store(count, Ordering::Relaxed);
        Ok(())
    }

    /// Bounds in world space.
    pub fn bounds(&self) -> Bounds {
        *self.bounds.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the bounds, for cameras that frame the scene. Elements beyond them are drawn all the same: frames use bounds that were set only to
    /// scale sums of depths by the approximate distance of the scene, and to sort surfels in arbitrary order ([`crate::scene::Order`]).
    ///
    /// # Errors
    /// [`Error::Usage`] if the bounds are not finite.
    pub fn set_bounds(&self, bounds: Bounds) -> Result<()> {
        check_bounds(&bounds)?;
        self.bounds_hold.store(false, Ordering::Relaxed);
        self.store_bounds(bounds);
        Ok(())
    }

    pub(super) fn store_bounds(&self, bounds: Bounds) {
        *self.bounds.lock().unwrap_or_else(PoisonError::into_inner) = bounds;
    }

    /// Bounds of all elements with their radii; `None` if the bounds were set, and may not hold.
    pub(crate) fn sure_bounds(&self) -> Option<Bounds> {
        self.bounds_with_radii(self.largest()?)
    }

    /// The same of the surfels with a curvature.
    pub(crate) fn curved_bounds(&self) -> Option<Bounds> {
        self.bounds_with_radii(self.largest_curved())
    }

    fn bounds_with_radii(&self, largest: f32) -> Option<Bounds> {
        let hold = self.bounds_hold.load(Ordering::Relaxed);
        hold.then(|| self.bounds().grown(largest.into()))
    }

    /// Upper bound of the radii, if known.
    pub(crate) fn largest(&self) -> Option<f32> {
        self.largest.as_ref().map(|bits| f32::from_bits(bits.load(Ordering::Relaxed)))
    }

    /// Upper bound of the radii of surfels with a curvature; 0 without any.
    pub(crate) fn largest_curved(&self) -> f32 {
        f32::from_bits(self.largest_curved.load(Ordering::Relaxed))
    }

    /// Whether the host owns the surfels' buffers.
    pub(crate) fn is_of_host(&self) -> bool {
        self.of_host
    }
}

/// Validates bounds.
pub(super) fn check_bounds(bounds: &Bounds) -> Result<()> {
    let Bounds { min, max, radius } = *bounds;
    if min.is_finite() && max.is_finite() && min.cmple(max).all() && radius.is_finite() && radius >= 0.0 {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "bounds from {min} to {max}, radius {radius}: give finite ones, the least first"
        )))
    }
}
