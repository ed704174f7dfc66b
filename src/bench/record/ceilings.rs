//! Rates that bound the passes of a device, and the shares of them that passes reach.

use super::{Pass, Run};
use crate::frame::times::Interval;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rates of simple operations on a device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Ceilings {
    /// Whether timestamps of the device measured them, as they do passes; otherwise the wall time of the caller did.
    pub timestamps: bool,
    /// Copy bandwidth: bytes read and written by `vkCmdCopyBuffer`.
    pub copy: Rate,
    /// Atomic minima of 32-bit words at pseudo-random addresses of a buffer.
    pub atomics: Rate,
    /// The same of 64-bit words; none if the device lacks them.
    pub wide_atomics: Option<Rate>,
    /// Fill rate: pixels of four 32-bit floats, written by triangles over the whole target.
    pub fill: Rate,
}

/// A rate of operations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Rate {
    /// Operations of a repetition.
    pub operations: u64,
    /// Size of the memory that they are spread over, bytes.
    pub memory: u64,
    /// Operations per second over the repetitions.
    pub per_second: Interval,
}

/// Least work of a pass: see [`PassTraffic`](crate::frame::PassTraffic).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PassWork {
    /// Name of the pass.
    pub name: String,
    /// Bytes read and written.
    pub bytes: u64,
    /// Pixels written to images.
    pub pixels: u64,
    /// Atomic operations.
    pub atomics: u64,
}

/// The work of a pass relative to what the device could do in the same time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// Of the copy bandwidth.
    pub copy: f64,
    /// Of the fill rate.
    pub fill: f64,
    /// Of the rate of atomics: those of 64-bit words, where the device has them.
    pub atomics: f64,
}

impl Ceilings {
    /// Shares of a pass with this work that took so many milliseconds; none if one of the values is not above 0.
    pub fn shares(&self, work: &PassWork, ms: f64) -> Option<Shares> {
        let share = |done: u64, rate: &Rate| done as f64 / (rate.per_second.median * 1e-3 * ms);
        let shares = Shares {
            copy: share(work.bytes, &self.copy),
            fill: share(work.pixels, &self.fill),
            atomics: share(work.atomics, self.wide_atomics.as_ref().unwrap_or(&self.atomics)),
        };
        let are_finite = [shares.copy, shares.fill, shares.atomics].iter().all(|share| share.is_finite());
        (ms > 0.0 && are_finite).then_some(shares)
    }
}

impl Run {
    /// The passes of a run, with the shares of those whose work is known.
    pub fn shares(&self, ceilings: &Ceilings) -> impl Iterator<Item = (&Pass, Option<Shares>)> {
        let passes = self.time.iter().flat_map(|time| &time.passes);
        passes.map(move |pass| {
            let work = self.work.iter().find(|work| work.name == pass.name);
            (pass, work.and_then(|work| ceilings.shares(work, pass.ms.median)))
        })
    }
}
