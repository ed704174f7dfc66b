//! Connected components of triangles.

use super::weld::Welded;
use std::collections::{BTreeMap, HashMap};

/// Indices of triangles by component. Triangles that share a side are connected; triangles that share only a corner are not, so that a leaf
/// ends where its stalk meets the branch. Ordered by the first triangles.
pub(super) fn components(mesh: &Welded) -> Vec<Vec<u32>> {
    let mut parent: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    let mut first = HashMap::new();
    for (i, triangle) in (0..).zip(&mesh.triangles) {
        for side in sides(triangle) {
            let other = *first.entry(side).or_insert(i);
            let (a, b) = (root(&mut parent, i), root(&mut parent, other));
            // The lesser index is the root, so that roots are first triangles.
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let mut all: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for i in 0..parent.len() as u32 {
        let root = root(&mut parent, i);
        all.entry(root).or_default().push(i);
    }
    all.into_values().collect()
}

/// The sides of a triangle, the lesser end first.
pub(super) fn sides(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

/// The sides of a component that belong to one triangle only; `None` if a side belongs to more than two.
pub(super) fn border(component: &[u32], mesh: &Welded) -> Option<Vec<[u32; 2]>> {
    let mut counts: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let all = component.iter().flat_map(|&i| sides(&mesh.triangles[i as usize]));
    all.for_each(|side| *counts.entry(side).or_default() += 1);
    let whole = counts.values().all(|&count| count <= 2);
    whole.then(|| counts.into_iter().filter(|&(_, count)| count == 1).map(|(side, _)| side).collect())
}
