//! Groups of results in their order of appearance.

use super::record::Run;

/// Groups runs by key, in the order of their first.
pub fn grouped<'r, K: PartialEq>(
    runs: impl IntoIterator<Item = &'r Run>,
    key: impl Fn(&'r Run) -> K,
) -> Vec<(K, Vec<&'r Run>)> {
    let mut groups: Vec<(K, Vec<&Run>)> = Vec::new();
    for run in runs {
        let key = key(run);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, group)) => group.push(run),
            None => groups.push((key, vec![run])),
        }
    }
    groups
}

/// The items without repetitions, in the order of their first.
pub fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut distinct = Vec::new();
    for item in items {
        if !distinct.contains(&item) {
            distinct.push(item);
        }
    }
    distinct
}
