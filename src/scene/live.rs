//! What may change of a scene from frame to frame, beside its surfels' values.

use super::{PrimitiveStreams, Scene};
use crate::error::{Error, Result};
use crate::geometry::Bounds;
use std::sync::PoisonError;
use std::sync::atomic::Ordering;

impl Scene {
    /// Number of surfels that are drawn.
    pub fn count(&self) -> u64 {
        self.count.load(Ordering::Relaxed)
    }

    /// Number of surfels that there is room for.
    pub fn capacity(&self) -> u64 {
        self.chunks.last().map_or(0, |chunk| chunk.end)
    }

    /// Number of surfels, segments and triangles that there is room for: as many points have numbers.
    pub(crate) fn id_count(&self) -> u64 {
        let elements = |primitives: &PrimitiveStreams| {
            let kinds = [&primitives.lines, &primitives.triangles];
            kinds.into_iter().flatten().map(|elements| u64::from(elements.count)).sum::<u64>()
        };
        self.capacity() + self.primitives.as_ref().map_or(0, elements)
    }

    /// Frames that are prepared from now on draw the first `count` surfels.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no room for as many, and in a scene with clip lines, which lie behind all of their surfels.
    pub fn set_count(&self, count: u64) -> Result<()> {
        let capacity = self.capacity();
        if count > capacity {
            let text = format!("{count} surfels of a scene with room for {capacity}: give at most as many");
            return Err(Error::Usage(text));
        }
        if self.clips.is_some() && count != self.count() {
            let text = format!(
                "a scene with clip lines has all of its {capacity} surfels: upload fewer, or leave out the clip lines"
            );
            return Err(Error::Usage(text));
        }
        self.count.store(count, Ordering::Relaxed);
        Ok(())
    }

    /// Bounds in the world.
    pub fn bounds(&self) -> Bounds {
        *self.bounds.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Declares the bounds, for who frames the scene by them. What is beyond them is drawn all the same: frames take from them no more than
    /// about how far from the eye the scene is, to which sums of depths are scaled.
    ///
    /// # Errors
    /// [`Error::Usage`] if they are not finite.
    pub fn set_bounds(&self, bounds: Bounds) -> Result<()> {
        check_bounds(&bounds)?;
        *self.bounds.lock().unwrap_or_else(PoisonError::into_inner) = bounds;
        Ok(())
    }

    /// A radius that no surfel is larger than, if one is known.
    pub(crate) fn largest(&self) -> Option<f32> {
        self.largest.as_ref().map(|bits| f32::from_bits(bits.load(Ordering::Relaxed)))
    }

    /// Whether a host owns the surfels' buffers.
    pub(crate) fn is_of_host(&self) -> bool {
        self.of_host
    }
}

/// Refuses bounds that are none.
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
