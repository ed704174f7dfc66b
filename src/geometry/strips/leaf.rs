//! Ribbons from small open sheets.
//!
//! The paper's leaves have four triangles between six vertices: a tip, two pairs, a tip. Here a leaf may have any outline with two ends,
//! and inner vertices. The ends are the two vertices of the outline that are farthest apart; the two sides of the outline between them are
//! traversed together.

use super::component::border;
use super::weld::Welded;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of triangles of a leaf.
const MOST: usize = 64;
/// Least length, in largest widths.
const ELONGATED: f64 = 1.5;
/// Largest ratio between the areas of ribbon and sheet, either way: a curled sheet is not a flat strip.
const AREA: f64 = 1.5;
/// Cosine of the largest corner angle of a blunt end, such as of a cut blade of grass: 110°.
const BLUNT: f64 = -0.342;
/// Radius of a pointed end, in largest radii: close to 0 as in the paper, but not 0.
const TIP: f64 = 1e-3;

/// A vertex of a ribbon.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub centre: DVec3,
    pub normal: DVec3,
    pub radius: f64,
    /// Places that it replaces.
    pub places: [u32; 2],
}

/// A point between place `a` and place `b`.
#[derive(Clone, Copy)]
struct Station {
    a: u32,
    b: u32,
    t: f64,
}

/// The rows of a leaf; `None` if the component is not a leaf.
pub(super) fn rows(component: &[u32], mesh: &Welded) -> Option<Vec<Row>> {
    if component.len() > MOST {
        return None;
    }
    let outline = outline(component, mesh)?;
    let pairs = pairs(&outline, mesh)?;
    let normals = normals(component, mesh);
    let mut rows: Vec<Row> = pairs.iter().map(|pair| row(pair, &normals, mesh)).collect();
    let widest = rows.iter().map(|row| row.radius).fold(0.0, f64::max);
    let steps = rows
        .windows(2)
        .map(|pair| (pair[0].centre.distance(pair[1].centre), pair[0].radius + pair[1].radius));
    let (length, area) =
        steps.fold((0.0, 0.0), |(length, area), (step, width)| (length + step, area + step * width));
    let double = |&i: &u32| {
        let [a, b, c] = mesh.triangles[i as usize].map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).length()
    };
    let sheet = 0.5 * component.iter().map(double).sum::<f64>();
    let flat = area <= AREA * sheet && sheet <= AREA * area;
    let is_leaf = flat && widest > 0.0 && length >= ELONGATED * 2.0 * widest;
    rows.iter_mut().for_each(|row| row.radius = row.radius.max(TIP * widest));
    (is_leaf && rows.iter().all(|row| row.normal != DVec3::ZERO)).then_some(rows)
}

/// The vertices around a connected sheet without holes, in order.
fn outline(component: &[u32], mesh: &Welded) -> Option<Vec<u32>> {
    let border = border(component, mesh)?;
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &[a, b] in &border {
        next.entry(a).or_default().push(b);
        next.entry(b).or_default().push(a);
    }
    let simple = next.values().all(|others| others.len() == 2);
    let places: BTreeSet<u32> = component.iter().flat_map(|&i| mesh.triangles[i as usize]).collect();
    // Euler's formula: vertices − sides + triangles = 1 for a disc. Each side is on the border or belongs to two triangles.
    let sides = (3 * component.len() + border.len()) / 2;
    if !simple || places.len() + component.len() != sides + 1 {
        return None;
    }
    let (&start, others) = next.iter().next()?;
    let mut loop_ = vec![start, others[0]];
    while let [.., before, last] = loop_[..] {
        let to = *next[&last].iter().find(|&&to| to != before)?;
        if to == start {
            break;
        }
        loop_.push(to);
    }
    (loop_.len() == next.len()).then_some(loop_)
}

/// Opposite points of the outline, from one end to the other.
fn pairs(outline: &[u32], mesh: &Welded) -> Option<Vec<[Station; 2]>> {
    let count = outline.len();
    let at = |i: usize| mesh.positions[outline[i % count] as usize];
    let all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    let [from, to] = all
        .max_by(|a, b| at(a.0).distance(at(a.1)).total_cmp(&at(b.0).distance(at(b.1))))
        .map(<[_; 2]>::from)?;
    // Start and end of the two sides: one vertex, or the two of a blunt end. One side goes up, the other down.
    let [up_from, down_from] = end(from, to, count, at);
    let [down_to, up_to] = end(to, from, count, at);
    let up: Vec<u32> = walk(up_from, up_to, count).map(|i| outline[i]).collect();
    let mut down: Vec<u32> = walk(down_to, down_from, count).map(|i| outline[i]).collect();
    down.reverse();
    (up.len() > 1 && down.len() > 1 && up.len().max(down.len()) > 2 || up_from != down_from).then_some(())?;
    Some(if up.len() == down.len() {
        up.iter().zip(&down).map(|(&a, &b)| [station(a), station(b)]).collect()
    } else {
        let (many, few) = if up.len() > down.len() { (&up, &down) } else { (&down, &up) };
        let fractions = fractions(many, mesh);
        many.iter().zip(&fractions).map(|(&a, &t)| [station(a), along(few, t, mesh)]).collect()
    })
}

/// The vertices where the side up from end `i` starts and the side down to it ends, as positions on the outline. They differ where one
/// neighbour forms a blunt end with `i`: its corner towards the other end, `far`, is about a right angle.
fn end(i: usize, far: usize, count: usize, at: impl Fn(usize) -> DVec3) -> [usize; 2] {
    let (next, before) = ((i + 1) % count, (i + count - 1) % count);
    let cosine = |corner: usize| {
        (at(i) - at(corner)).normalize_or_zero().dot((at(far) - at(corner)).normalize_or_zero())
    };
    let (up, down) = (cosine(next), cosine(before));
    if up.max(down) <= BLUNT || next == far || before == far {
        [i, i]
    } else if up > down {
        [next, i]
    } else {
        [i, before]
    }
}

/// Positions on the outline from one up to another.
fn walk(from: usize, to: usize, count: usize) -> impl Iterator<Item = usize> {
    (0..=(to + count - from) % count).map(move |step| (from + step) % count)
}

fn station(i: u32) -> Station {
    Station { a: i, b: i, t: 0.0 }
}

/// Length of the path to each vertex, as a fraction of the whole.
fn fractions(chain: &[u32], mesh: &Welded) -> Vec<f64> {
    let at = |i: u32| mesh.positions[i as usize];
    let mut sums = vec![0.0];
    for pair in chain.windows(2) {
        sums.push(sums[sums.len() - 1] + at(pair[0]).distance(at(pair[1])));
    }
    let all = sums[sums.len() - 1].max(f64::MIN_POSITIVE);
    sums.iter().map(|sum| sum / all).collect()
}

/// The point at fraction `t` of a chain's length.
fn along(chain: &[u32], t: f64, mesh: &Welded) -> Station {
    let fractions = fractions(chain, mesh);
    let after = fractions
        .iter()
        .position(|&fraction| fraction >= t)
        .unwrap_or(chain.len() - 1)
        .max(1)
        .min(chain.len() - 1);
    let [low, high] = [fractions[after.saturating_sub(1)], fractions[after]];
    let part = if high > low { ((t - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
    Station { a: chain[after.saturating_sub(1)], b: chain[after], t: part }
}

fn row(pair: &[Station; 2], normals: &BTreeMap<u32, DVec3>, mesh: &Welded) -> Row {
    let at = |s: &Station| mesh.positions[s.a as usize].lerp(mesh.positions[s.b as usize], s.t);
    let normal = |s: &Station| normals[&s.a].lerp(normals[&s.b], s.t);
    let [left, right] = [at(&pair[0]), at(&pair[1])];
    Row {
        centre: 0.5 * (left + right),
        normal: (normal(&pair[0]) + normal(&pair[1])).normalize_or_zero(),
        radius: 0.5 * left.distance(right),
        places: pair.map(|s| if s.t < 0.5 { s.a } else { s.b }),
    }
}

/// Mean normal of the component's triangles at each place, weighted by their angles there.
fn normals(component: &[u32], mesh: &Welded) -> BTreeMap<u32, DVec3> {
    let mut sums: BTreeMap<u32, DVec3> = BTreeMap::new();
    for &i in component {
        let triangle = mesh.triangles[i as usize];
        for turn in 0..3 {
            let [p, a, b] = [0, 1, 2].map(|k| mesh.positions[triangle[(turn + k) % 3] as usize]);
            let cross = (a - p).cross(b - p);
            let angle = cross.length().atan2((a - p).dot(b - p));
            *sums.entry(triangle[turn]).or_default() += angle * cross.normalize_or_zero();
        }
    }
    sums.values_mut().for_each(|sum| *sum = sum.normalize_or_zero());
    sums
}
