//! Simplification of lines.
//!
//! Removes inner vertices of lines (marroquim2008, section 4.1), chosen by David Douglas and Thomas Peucker, *Algorithms for the Reduction
//! of the Number of Points Required to Represent a Digitized Line or its Caricature*, Cartographica 1973.

use super::Primitives;

/// Position, and the offset of the line's edge: of a tube the radius, of a ribbon the normal times half the width, so that the vertices of
/// a twist are kept.
type Feature = [f64; 6];

impl Primitives {
    /// Removes inner vertices of lines that interpolation reproduces up to `tolerance`, in the positions' unit: the distance in space and
    /// in radius together, of ribbons in radius times normal. Colours and tangents are ignored. Vertices at ends, forks, changes of kind
    /// and triangles are kept, and so are rings that would vanish. Unused vertices are removed. Returns the number of removed segments.
    pub fn simplify(&mut self, tolerance: f64) -> u64 {
        let before = self.count();
        let fixed = self.fixed();
        let feature = |tube: bool| {
            let this = &*self;
            move |i: u32| this.feature(i as usize, tube)
        };
        let ribbons = simplified(&self.ribbons, &fixed, tolerance, feature(false));
        let tubes = simplified(&self.tubes, &fixed, tolerance, feature(true));
        (self.ribbons, self.tubes) = (ribbons, tubes);
        self.leave_out_unused();
        (before - self.count()) as u64
    }

    /// Whether each vertex must be kept.
    fn fixed(&self) -> Vec<bool> {
        let mut degrees = vec![0u32; self.len()];
        self.segments().flat_map(|(ends, _)| ends).for_each(|i| degrees[i as usize] += 1);
        let mut fixed: Vec<bool> = degrees.iter().map(|&degree| degree != 2).collect();
        let mut ribbon = vec![false; self.len()];
        self.ribbons.iter().flatten().for_each(|&i| ribbon[i as usize] = true);
        self.tubes.iter().flatten().for_each(|&i| fixed[i as usize] |= ribbon[i as usize]);
        self.triangles.iter().flatten().for_each(|&i| fixed[i as usize] = true);
        fixed
    }

    fn feature(&self, i: usize, tube: bool) -> Feature {
        let [x, y, z] = self.positions[i].as_dvec3().to_array();
        let radius = f64::from(self.radii[i]);
        let [a, b, c] =
            if tube { [radius, 0.0, 0.0] } else { (radius * self.directions[i].as_dvec3()).to_array() };
        [x, y, z, a, b, c]
    }

    fn leave_out_unused(&mut self) {
        let mut used = vec![false; self.len()];
        let lines = self.ribbons.iter().chain(&self.tubes).flatten();
        lines.chain(self.triangles.iter().flatten()).for_each(|&i| used[i as usize] = true);
        let kept: Vec<u32> = (0..self.len() as u32).filter(|&i| used[i as usize]).collect();
        *self = self.part(&kept);
    }
}

/// The segments between the kept vertices.
fn simplified(
    segments: &[[u32; 2]],
    fixed: &[bool],
    tolerance: f64,
    feature: impl Fn(u32) -> Feature,
) -> Vec<[u32; 2]> {
    let mut all = Vec::new();
    for chain in chains(segments, fixed) {
        let features: Vec<Feature> = chain.iter().map(|&i| feature(i)).collect();
        let stays = stays(&features, tolerance);
        let kept: Vec<u32> = chain.iter().zip(&stays).filter(|(_, stays)| **stays).map(|(i, _)| *i).collect();
        // A ring with fewer corners than a triangle would vanish.
        let vanishes = chain.first() == chain.last() && kept.len() < 4;
        let line = if vanishes { &chain } else { &kept };
        all.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    all
}

/// Lines between fixed vertices, and rings, whose first vertex is also the last.
fn chains(segments: &[[u32; 2]], fixed: &[bool]) -> Vec<Vec<u32>> {
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); fixed.len()];
    for (i, ends) in (0..).zip(segments) {
        ends.iter().for_each(|&end| at[end as usize].push(i));
    }
    let mut walked = vec![false; segments.len()];
    let mut chains = Vec::new();
    let ends = (0..fixed.len() as u32).filter(|&i| fixed[i as usize]);
    for start in ends.chain(0..fixed.len() as u32) {
        for &first in &at[start as usize] {
            if walked[first as usize] {
                continue;
            }
            let (mut chain, mut segment) = (vec![start], first);
            loop {
                walked[segment as usize] = true;
                let [a, b] = segments[segment as usize];
                let to = if chain[chain.len() - 1] == a { b } else { a };
                chain.push(to);
                let next = at[to as usize].iter().find(|&&next| !walked[next as usize]);
                match next {
                    Some(&next) if !fixed[to as usize] && to != start => segment = next,
                    _ => break,
                }
            }
            chains.push(chain);
        }
    }
    chains
}

/// The kept vertices: first and last, and recursively the farthest from the interpolation between two kept ones, if farther than the
/// tolerance.
fn stays(features: &[Feature], tolerance: f64) -> Vec<bool> {
    let mut stays = vec![false; features.len()];
    let Some(last) = features.len().checked_sub(1) else { return stays };
    (stays[0], stays[last]) = (true, true);
    let mut spans = vec![(0, last)];
    while let Some((from, to)) = spans.pop() {
        let far = |i: usize| (i, distance(&features[i], &features[from], &features[to]));
        let farthest = (from + 1..to).map(far).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = farthest.filter(|(_, far)| *far > tolerance) {
            stays[i] = true;
            spans.extend([(from, i), (i, to)]);
        }
    }
    stays
}

/// Distance from `p` to the segment from `a` to `b`.
fn distance(p: &Feature, a: &Feature, b: &Feature) -> f64 {
    let minus = |p: &Feature, q: &Feature| -> Feature { std::array::from_fn(|k| p[k] - q[k]) };
    let dot = |p: &Feature, q: &Feature| -> f64 { p.iter().zip(q).map(|(p, q)| p * q).sum() };
    let (ap, ab) = (minus(p, a), minus(b, a));
    let square = dot(&ab, &ab);
    let t = if square > 0.0 { (dot(&ap, &ab) / square).clamp(0.0, 1.0) } else { 0.0 };
    let off: Feature = std::array::from_fn(|k| ap[k] - t * ab[k]);
    dot(&off, &off).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Along x, with the given heights and radii.
    fn line(heights: &[f32], radii: &[f32]) -> Primitives {
        let count = heights.len() as u32;
        Primitives {
            positions: heights.iter().zip(0u8..).map(|(&y, x)| Vec3::new(x.into(), y, 0.0)).collect(),
            directions: vec![Vec3::Z; heights.len()],
            radii: radii.to_vec(),
            tubes: (1..count).map(|i| [i - 1, i]).collect(),
            ..Default::default()
        }
    }

    fn xs(primitives: &Primitives) -> Vec<f32> {
        primitives.positions.iter().map(|p| p.x).collect()
    }

    #[test]
    fn what_is_straight_and_tapers_evenly_goes() {
        let mut straight = line(&[0.0; 5], &[1.0, 0.75, 0.5, 0.25, 0.0]);
        assert_eq!(
            (straight.simplify(1e-6), xs(&straight), straight.tubes),
            (3, vec![0.0, 4.0], vec![[0, 1]])
        );
        let mut bent = line(&[0.0, 0.1, 1.0, 0.1, 0.0], &[0.5; 5]);
        assert_eq!((bent.clone().simplify(0.01), bent.simplify(0.5), xs(&bent)), (0, 2, vec![0.0, 2.0, 4.0]));
        let mut thick = line(&[0.0; 5], &[0.1, 0.1, 0.4, 0.1, 0.1]);
        assert_eq!((thick.simplify(0.25), xs(&thick)), (2, vec![0.0, 2.0, 4.0]));
        assert_eq!((thick.simplify(0.5), xs(&thick)), (1, vec![0.0, 4.0]));
    }

    #[test]
    fn twists_forks_and_corners_stay() {
        let mut twisted = line(&[0.0; 3], &[1.0; 3]);
        twisted.ribbons = std::mem::take(&mut twisted.tubes);
        twisted.directions[1] = Vec3::Y;
        assert_eq!((twisted.clone().simplify(0.5), twisted.simplify(1.5)), (0, 1));
        let mut fork = line(&[0.0; 5], &[1.0; 5]);
        fork.tubes.push([2, 4]);
        fork.triangles = vec![[3, 3, 3]];
        assert_eq!((fork.simplify(1e-6), xs(&fork)), (1, vec![0.0, 2.0, 3.0, 4.0]));
        let mut mixed = line(&[0.0; 4], &[1.0; 4]);
        mixed.ribbons = vec![mixed.tubes.pop().unwrap()];
        assert_eq!((mixed.simplify(1e-6), xs(&mixed)), (1, vec![0.0, 2.0, 3.0]));
    }

    #[test]
    fn rings_keep_a_triangle_or_all() {
        let mut ring = line(&[0.0, 0.0, 0.0, 2.0, 2.0], &[1.0; 5]);
        ring.positions[3].x = 2.0;
        ring.positions[4].x = 0.0;
        ring.tubes.push([4, 0]);
        assert_eq!((ring.clone().simplify(1e-6), ring.simplify(100.0)), (1, 0));
    }
}
