//! Copy: what was pulled of each level → beside the coarser one, where the push reads both (marroquim2008 §3.5, figure 7b).

use crate::targets::Pyramids;
use crate::vk::{Access, Recorder};

/// Records the copy phase of pyramids that take turns: it completes both.
pub fn copy(rec: &mut Recorder<'_>, targets: &Pyramids) {
    let uses = targets.pyramids.iter().flat_map(|pyramid| pyramid.with(Access::COPY_WITHIN));
    rec.pass("copy", &uses.collect::<Vec<_>>(), |enc| {
        for level in 0..targets.levels() {
            let [_, from] = targets.storage.pull(level);
            let [to, _] = targets.storage.push(level);
            targets.pyramids[from].copy(enc, &targets.pyramids[to], targets.level_range(level));
        }
    });
}
