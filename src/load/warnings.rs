//! Warnings about what was read.

use super::part::Part;
use crate::formats::{Dropped, Faces, Lines, Report};
use crate::geometry::usual_box;
use crate::thousands;
use glam::DVec3;

/// Distance of two inputs, in the width of the wider one, above which they hardly fit into a picture.
const FAR: f64 = 100.0;

/// Logs a warning about inputs that are far apart, as those in different coordinate systems.
pub fn log_apart(parts: &[Part]) {
    apart(parts).into_iter().for_each(|text| log::warn!("{text}"));
}

/// The warning about the first part that is far from the first.
fn apart(parts: &[Part]) -> Option<String> {
    let (first, others) = parts.split_first().filter(|(_, others)| !others.is_empty())?;
    let range = |part: &Part| usual_box(&part.cloud.positions).map(|at| at.as_dvec3() + part.cloud.origin);
    let [low, high] = range(first);
    let far = others.iter().find_map(|other| {
        let [other_low, other_high] = range(other);
        let width = (high - low).max(other_high - other_low).max_element();
        let gap = (other_low - high).max(low - other_high).max(DVec3::ZERO).length();
        (width > 0.0 && gap > FAR * width).then_some((other, gap / width))
    });
    far.map(|(other, times)| {
        let times = thousands(times.min(1e18) as u64);
        format!(
            "{} and {} are {times} times their width apart, so that little is seen of either: give one of them, or bring both into one \
             coordinate system",
            first.name, other.name
        )
    })
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Cloud;
    use glam::Vec3;

    #[test]
    fn inputs_that_are_far_apart_are_named() {
        let part = |name: &str, x: f64, width: f32| {
            let positions = vec![Vec3::ZERO, Vec3::new(width, 0.5 * width, 0.0)];
            let origin = DVec3::new(x, 0.0, 0.0);
            Part::of(name.into(), Cloud { origin, positions, ..Default::default() }, DVec3::Y)
        };
        let warned = |all: &[(&str, f64, f32)]| {
            apart(&all.iter().map(|&(name, x, w)| part(name, x, w)).collect::<Vec<_>>())
        };
        let text = warned(&[("a", 0.0, 1.0), ("b", 50.0, 2.0), ("c", -4002.0, 2.0)]).unwrap();
        assert!(text.starts_with("a and c are 2,000 times their width apart"), "{text}");
        assert_eq!(warned(&[("a", 0.0, 1.0), ("b", 90.0, 0.001)]), None);
        assert_eq!(warned(&[("a", 0.0, 0.0), ("b", 90.0, 0.0)]), None);
        assert_eq!(warned(&[("a", 0.0, 1.0)]), None);
    }
}
