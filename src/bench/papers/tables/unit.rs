//! Units of the tables' numbers.

use crate::bench::format;
use crate::bench::record::Run;

/// Unit of a table's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Frames per second.
    Fps,
    /// Million splats per second.
    MillionSplats,
    /// Milliseconds per frame, beside those of the projection and of pull and push.
    Parts,
    /// Nodes of an octree, their size, and the time to build it.
    Octree,
    /// Splats that are selected from an octree, and times: of the selection, of splatting, of normalization, and of all.
    Selection,
}

/// Passes before pull, with all clears, and passes of pull–push.
pub(super) const PROJECTION: &[&str] = &["clear", "project", "occupied", "fetch"];
pub(super) const PULL_PUSH: &[&str] = &["pull", "copy", "push", "filled"];
/// The pass that divides by the sum of the weights.
const NORMALIZE: &[&str] = &["normalize"];

impl Unit {
    /// Text of the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fps => "frames/s",
            Self::MillionSplats => "M splats/s",
            Self::Parts => "ms",
            Self::Octree => "nodes, MiB, s",
            Self::Selection => "splats, s, s, ms, s",
        }
    }

    /// A time of a frame in this unit, in that of the total where there are several.
    pub fn of(self, ms: f64, points: u64) -> f64 {
        match self {
            Self::Fps => 1e3 / ms,
            Self::MillionSplats => 1e-3 * points as f64 / ms,
            Self::Octree | Self::Selection => 1e-3 * ms,
            Self::Parts => ms,
        }
    }

    /// The numbers of runs in this unit: those of the octree, otherwise the mean of the runs' times; of a single run with its parts, if the
    /// unit has parts and they are known. None if one was not timed.
    pub fn format(self, runs: &[&Run]) -> Option<String> {
        match (self, runs) {
            (Self::Octree, [run]) => octree(run),
            (Self::Selection, [run]) => selection(run),
            _ => self.times(runs),
        }
    }

    fn times(self, runs: &[&Run]) -> Option<String> {
        let all: Option<Vec<f64>> = runs.iter().map(|run| Some(self.of(run.ms()?, run.points))).collect();
        let all = all.filter(|all| !all.is_empty())?;
        let whole = number(all.iter().sum::<f64>() / all.len() as f64);
        let [run] = runs else { return Some(whole) };
        let parts = [PROJECTION, PULL_PUSH].map(|names| sum(run, names).map(number));
        match parts {
            [Some(project), Some(pull_push)] if self == Self::Parts => {
                Some(format!("{whole} ({project}, {pull_push})"))
            }
            _ => Some(whole),
        }
    }
}

fn number(value: f64) -> String {
    format::significant(value, 3)
}

/// Nodes, MiB and seconds of a run's octree.
fn octree(run: &Run) -> Option<String> {
    let octree = run.octree.as_ref()?;
    let [size, seconds] = [format::mib(octree.bytes), number(1e-3 * octree.build_ms)];
    Some(format!("{}, {size}, {seconds}", octree.nodes))
}

/// Splats and times of a run's selection; without the parts of a frame where the device has no timestamps.
fn selection(run: &Run) -> Option<String> {
    let (octree, ms) = (run.octree.as_ref()?, run.ms()?);
    let passes = &run.time.as_ref()?.passes;
    let all: f64 = passes.iter().map(|pass| pass.ms.median).sum();
    let normalize = sum(run, NORMALIZE);
    let splatting = normalize.map(|normalize| number(1e-3 * (all - normalize)));
    let [splatting, normalize] = [splatting, normalize.map(number)].map(|part| part.unwrap_or("–".into()));
    let [select, total] = [octree.select_ms, octree.select_ms + ms].map(|ms| number(1e-3 * ms));
    Some(format!("{}, {select}, {splatting}, {normalize}, {total}", octree.surfels))
}

/// Sum of the medians of passes, ms; none if none was timed.
pub(super) fn sum(run: &Run, names: &[&str]) -> Option<f64> {
    let passes = &run.time.as_ref()?.passes;
    let own = passes.iter().filter(|pass| names.contains(&pass.name.as_str()));
    (!passes.is_empty()).then(|| own.map(|pass| pass.ms.median).sum())
}
