//! Warnings about what was read.

use crate::formats::{Dropped, Faces, Lines, Report};
use crate::thousands;

/// Logs warnings about parts of a file that are left out or may be damaged.
pub fn log(name: &str, report: &Report) {
    let Dropped { position, transparent, thinned, filtered } = report.dropped;
    for (count, why) in [(position, "have no finite position"), (transparent, "are less than a tenth opaque")]
    {
        if count > 0 {
            let [count, points] = [count, report.points].map(thousands);
            log::warn!("{name}: {count} of {points} points {why} and are left out");
        }
    }
    if let Some(stated) = report.stated {
        let [stated, points] = [stated, report.points].map(thousands);
        log::warn!("{name}: states {stated} points and has {points}: it may be cut or edited");
    }
    if report.clip_lines_dropped > 0 {
        log::warn!(
            "{name}: {} clip lines are not finite or in no tangent plane and are left out",
            thousands(report.clip_lines_dropped)
        );
    }
    if report.weights_dropped > 0 {
        log::warn!(
            "{name}: {} normalization weights are not finite or not above 0 and are left out",
            thousands(report.weights_dropped)
        );
    }
    if report.materials_dropped > 0 {
        log::warn!(
            "{name}: {} materials are more than can be read; points of theirs have none",
            thousands(report.materials_dropped)
        );
    }
    let unread = (thinned + filtered > 0).then_some("join points that are not read");
    let Faces { understood, skipped } = report.faces;
    if skipped > 0 {
        let why = unread.unwrap_or("have no three different corners that exist");
        let [skipped, all] = [skipped, skipped + understood].map(thousands);
        log::warn!("{name}: {skipped} of {all} faces {why} and are left out");
    }
    let Lines { understood, skipped, .. } = report.lines;
    if skipped > 0 {
        let why = unread.unwrap_or("have no two distinct ends that exist");
        let [skipped, all] = [skipped, skipped + understood].map(thousands);
        log::warn!("{name}: {skipped} of {all} segments of lines {why} and are left out");
    }
    if let Some(cause) = &report.texture_missing {
        log::warn!("{name}: drawn without its texture: {cause}");
    }
    if report.trailing > 0 {
        let bytes = thousands(report.trailing);
        log::warn!("{name}: {bytes} bytes after the last element mean nothing and are left out");
    }
}
