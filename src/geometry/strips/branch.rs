//! Tubes from rings of vertices.
//!
//! Vertices are sorted into layers by their distance in sides from an end of the component. The connected parts of a layer are the paper's
//! clusters: the ring of a branch or, beyond a fork, of several.

use super::component::{border, sides};
use super::weld::{TOLERANCE, Welded};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Least length of a tube, in mean radii of its rings: a ball has 2.5.
const SLENDER: f64 = 3.0;
/// Largest ratio between the distances of a ring's farthest and nearest vertex from its centre.
const ROUND: f64 = 2.0;
/// Part of a closed component's length at which vertices belong to its end.
const CAP: f64 = 1e-3;
/// Radius at an end in one vertex, in largest radii: close to 0, but not 0.
const TIP: f64 = 1e-3;

/// A vertex of a tube.
pub(super) struct Ring {
    pub centre: DVec3,
    pub radius: f64,
    /// Places that it replaces.
    pub places: Vec<u32>,
}

/// Tubes of a component.
pub(super) struct Tubes {
    pub rings: Vec<Ring>,
    /// Segments between rings.
    pub segments: Vec<[u32; 2]>,
    /// Triangles that are kept.
    pub rest: Vec<u32>,
}

/// The tubes of a component with radii of at most `thickest`.
pub(super) fn tubes(component: &[u32], mesh: &Welded, thickest: f64) -> Tubes {
    let stay = || Tubes { rings: Vec::new(), segments: Vec::new(), rest: component.to_vec() };
    let Some(border) = border(component, mesh) else { return stay() };
    let near = neighbours(component, mesh);
    let layers = layers(ends(&border, &near, mesh), &near);
    let (of_place, rings) = clusters(&layers, &near, mesh);
    let fit: Vec<bool> = rings.iter().map(|ring| is_fit(ring, &near, &of_place, mesh, thickest)).collect();
    let apart = |[a, b]: [u32; 2]| {
        let distance = rings[a as usize].centre.distance(rings[b as usize].centre);
        distance > TOLERANCE * mesh.diagonal
    };
    let mut segments: BTreeSet<[u32; 2]> = BTreeSet::new();
    for side in component.iter().flat_map(|&i| sides(&mesh.triangles[i as usize])) {
        let ends = side.map(|i| of_place[&i]);
        if ends.iter().all(|&i| fit[i as usize]) && apart(ends) {
            segments.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]);
        }
    }
    leave_out_stout(&mut segments, &rings);
    let used: BTreeSet<u32> = segments.iter().flatten().copied().collect();
    // The middle of a lid coincides with its ring.
    let is_lid = |[a, b]: [u32; 2]| {
        let middle = |i: u32| rings[i as usize].places.len() == 1;
        !apart([a, b]) && (used.contains(&a) && middle(b) || used.contains(&b) && middle(a))
    };
    let replaced = |i: &u32| {
        let corners = mesh.triangles[*i as usize].map(|i| of_place[&i]);
        let joined = |&[a, b]: &[u32; 2]| a == b || segments.contains(&[a, b]) || is_lid([a, b]);
        sides(&corners).iter().all(joined) && corners.iter().any(|corner| used.contains(corner))
    };
    let rest = component.iter().copied().filter(|i| !replaced(i)).collect();
    Tubes { rings: with_tips(rings, &segments), segments: segments.into_iter().collect(), rest }
}

type Neighbours = BTreeMap<u32, BTreeSet<u32>>;

fn neighbours(component: &[u32], mesh: &Welded) -> Neighbours {
    let mut near = Neighbours::new();
    for [a, b] in component.iter().flat_map(|&i| sides(&mesh.triangles[i as usize])) {
        near.entry(a).or_default().insert(b);
        near.entry(b).or_default().insert(a);
    }
    near
}

/// The vertices of the widest opening; for a closed component, those at one end of its longest axis.
fn ends(border: &[[u32; 2]], near: &Neighbours, mesh: &Welded) -> BTreeSet<u32> {
    let at = |i: &u32| mesh.positions[*i as usize];
    let mean = |places: &BTreeSet<u32>| places.iter().map(at).sum::<DVec3>() / places.len().max(1) as f64;
    if border.is_empty() {
        let all: BTreeSet<u32> = near.keys().copied().collect();
        let (middle, axis) = (mean(&all), axis(&all.iter().map(at).collect::<Vec<_>>()));
        let along = |i: &u32| (at(i) - middle).dot(axis);
        let [low, high] = [f64::INFINITY, f64::NEG_INFINITY];
        let (low, high) = all.iter().map(along).fold((low, high), |(low, high), x| (low.min(x), high.max(x)));
        let is_end = |i: &u32| along(i) <= low + CAP * (high - low);
        // The rim of a lid, or a point.
        let is_rim = |i: &&u32| is_end(i) && near[i].iter().any(|to| !is_end(to));
        return all.iter().filter(is_rim).copied().collect();
    }
    let mut around = Neighbours::new();
    for &[a, b] in border {
        around.entry(a).or_default().insert(b);
        around.entry(b).or_default().insert(a);
    }
    let width = |opening: &BTreeSet<u32>| {
        let centre = mean(opening);
        opening.iter().map(|i| at(i).distance(centre)).sum::<f64>() / opening.len() as f64
    };
    let places = around.keys().copied().collect();
    let openings = parts(&places, &around).into_iter();
    openings.max_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or_default()
}

/// The axis of largest extent, by power iteration on the covariance.
fn axis(points: &[DVec3]) -> DVec3 {
    const STEPS: usize = 64;
    let mean = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let offsets = || points.iter().map(|p| *p - mean);
    let start =
        offsets().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or_default();
    let step = |axis: DVec3, _| offsets().map(|p| p * p.dot(axis)).sum::<DVec3>().normalize_or_zero();
    (0..STEPS).fold(start.normalize_or_zero(), step)
}

/// The connected parts of a set of places.
fn parts(places: &BTreeSet<u32>, near: &Neighbours) -> Vec<BTreeSet<u32>> {
    let mut left = places.clone();
    let mut all = Vec::new();
    while let Some(start) = left.pop_first() {
        let (mut part, mut stack) = (BTreeSet::from([start]), vec![start]);
        while let Some(from) = stack.pop() {
            for &to in near[&from].iter().filter(|to| places.contains(to)) {
                if left.remove(&to) {
                    part.insert(to);
                    stack.push(to);
                }
            }
        }
        all.push(part);
    }
    all
}

fn layers(first: BTreeSet<u32>, near: &Neighbours) -> Vec<BTreeSet<u32>> {
    let mut seen = first.clone();
    let mut layers = vec![first];
    while let Some(last) = layers.last().filter(|last| !last.is_empty()) {
        let next: BTreeSet<u32> =
            last.iter().flat_map(|i| &near[i]).copied().filter(|i| !seen.contains(i)).collect();
        seen.extend(&next);
        layers.push(next);
    }
    layers
}

/// The cluster of each place, and the rings of the clusters.
fn clusters(layers: &[BTreeSet<u32>], near: &Neighbours, mesh: &Welded) -> (BTreeMap<u32, u32>, Vec<Ring>) {
    let (mut of_place, mut rings) = (BTreeMap::new(), Vec::new());
    for cluster in layers.iter().flat_map(|layer| parts(layer, near)) {
        of_place.extend(cluster.iter().map(|&i| (i, rings.len() as u32)));
        let count = cluster.len() as f64;
        let at = |i: &u32| mesh.positions[*i as usize];
        let centre = cluster.iter().map(at).sum::<DVec3>() / count;
        let mean = cluster.iter().map(|i| at(i).distance(centre)).sum::<f64>() / count;
        // Half the mean width of a regular polygon with this number of corners, by Cauchy: its perimeter over 2 π. The paper's largest
        // distance makes outlines wider than the mesh's: by 7 % for five corners and by 21 % for three.
        let radius = mean * (PI / count).sin() / (PI / count);
        rings.push(Ring { centre, radius, places: cluster.into_iter().collect() });
    }
    (of_place, rings)
}

/// Whether it is a round ring that is thin enough, or a single vertex at which a tube may end.
fn is_fit(
    ring: &Ring,
    near: &Neighbours,
    of_place: &BTreeMap<u32, u32>,
    mesh: &Welded,
    thickest: f64,
) -> bool {
    if let [_] = ring.places[..] {
        return true;
    }
    let own = of_place[&ring.places[0]];
    let closed = ring.places.iter().all(|i| near[i].iter().filter(|to| of_place[to] == own).count() >= 2);
    let far = ring.places.iter().map(|&i| mesh.positions[i as usize].distance(ring.centre));
    let (least, most) =
        far.fold((f64::INFINITY, 0.0f64), |(least, most), far| (least.min(far), most.max(far)));
    closed && ring.places.len() > 2 && most <= ROUND * least && ring.radius <= thickest
}

/// Removes tubes that are too short for their width.
fn leave_out_stout(segments: &mut BTreeSet<[u32; 2]>, rings: &[Ring]) {
    let mut near = Neighbours::new();
    for &[a, b] in segments.iter() {
        near.entry(a).or_default().insert(b);
        near.entry(b).or_default().insert(a);
    }
    let mut tubes: BTreeMap<u32, usize> = BTreeMap::new();
    let all = parts(&near.keys().copied().collect(), &near);
    for (tube, members) in all.iter().enumerate() {
        tubes.extend(members.iter().map(|&i| (i, tube)));
    }
    let mut lengths = vec![0.0; all.len()];
    for [a, b] in segments.iter() {
        lengths[tubes[a]] += rings[*a as usize].centre.distance(rings[*b as usize].centre);
    }
    let is_slender = |(members, length): (&BTreeSet<u32>, &f64)| {
        let radii = members.iter().map(|&i| rings[i as usize].radius).filter(|radius| *radius > 0.0);
        let (count, sum) = radii.fold((0u32, 0.0), |(count, sum), radius| (count + 1, sum + radius));
        count > 0 && *length >= SLENDER * sum / f64::from(count)
    };
    let slender: Vec<bool> = all.iter().zip(&lengths).map(is_slender).collect();
    segments.retain(|[a, _]| slender[tubes[a]]);
}

/// Gives single vertices a radius.
fn with_tips(mut rings: Vec<Ring>, segments: &BTreeSet<[u32; 2]>) -> Vec<Ring> {
    let used = || segments.iter().flatten();
    let widest = used().map(|&i| rings[i as usize].radius).fold(0.0, f64::max);
    rings.iter_mut().for_each(|ring| ring.radius = ring.radius.max(TIP * widest));
    rings
}
