//! Σw at a surfel's centre, computed from the surfels around it: for surfels that no view shows, and to check captured
//! sums.

use crate::geometry::Surfels;
use crate::settings::splatting::{Footprint, Kernel};
use crate::settings::{Cull, Settings};
use crate::verify::reference::Surfel;
use glam::{DVec2, DVec3, I64Vec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Least cosine between two surfels' normals on one surface.
const LEAST_COSINE: f64 = 0.1;

/// `Σ_j r_j(u_k − u_j)` at the centres of the surfels `which`: the sum along the normal of each, without filters. A
/// circular disc's square has the axes of [`crate::geometry::first_axis`], where footprints are squares.
pub fn overlaps(surfels: &Surfels, settings: &Settings, which: &[u32]) -> Vec<f64> {
    if which.is_empty() {
        return Vec::new();
    }
    let grid = SurfelGrid::new(surfels, settings);
    which.par_iter().map(|&surfel| grid.overlap(surfel)).collect()
}

/// Surfels by position and reach.
struct SurfelGrid<'a> {
    surfels: &'a Surfels,
    settings: &'a Settings,
    /// Surfels by the power of two above their reach, and by the cell of that side that contains their centre.
    levels: HashMap<i32, HashMap<I64Vec3, Vec<u32>>>,
}

/// Intersection of a splat with the line through a surfel's centre along its normal.
struct Hit {
    /// Position along the normal.
    height: f64,
    /// The splat hides surfaces this far below it.
    epsilon: f64,
    weight: f64,
}

impl<'a> SurfelGrid<'a> {
    fn new(surfels: &'a Surfels, settings: &'a Settings) -> Self {
        let mut all = Self { surfels, settings, levels: HashMap::new() };
        for i in (0..surfels.len()).filter(|&i| surfels.is_valid(i)) {
            let level = all.reach(surfels.radii[i]).log2().ceil() as i32;
            let cell = cell(surfels.positions[i].as_dvec3(), level);
            all.levels.entry(level).or_default().entry(cell).or_default().push(i as u32);
        }
        all
    }

    /// Greatest distance from its centre at which a splat of this radius has weight, up to ε off its plane.
    fn reach(&self, radius: f32) -> f64 {
        let rim = if is_square(self.settings) { std::f64::consts::SQRT_2 } else { 1.0 };
        (rim + f64::from(self.settings.epsilon)) * f64::from(radius)
    }

    fn overlap(&self, surfel: u32) -> f64 {
        if self.surfels.is_billboard(surfel as usize) {
            // Alone: it belongs to no surface.
            return 1.0;
        }
        let centre = Surfel::of(self.surfels, surfel as usize);
        let mut hits = Vec::new();
        for (&level, cells) in &self.levels {
            let middle = cell(centre.position - self.surfels.origin, level);
            for i in 0..27 {
                let beside = middle + I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                let near = cells.get(&beside).into_iter().flatten();
                hits.extend(near.filter_map(|&j| self.hit(&centre, &Surfel::of(self.surfels, j as usize))));
            }
        }
        // As in the passes: splats below the highest one, moved down by its ε, are hidden.
        let visible = hits.iter().map(|hit| hit.height - hit.epsilon).fold(f64::NEG_INFINITY, f64::max);
        hits.iter().filter(|hit| hit.height >= visible).map(|hit| hit.weight).sum()
    }

    /// Intersection of the splat of `other` with the line through `centre` along its normal, if both belong to one
    /// surface.
    fn hit(&self, centre: &Surfel, other: &Surfel) -> Option<Hit> {
        let cosine = other.normal.dot(centre.normal);
        let one_sided = !other.two_sided && !centre.two_sided;
        let culled = self.settings.cull != Cull::None && cosine < 0.0 && one_sided;
        if culled || cosine.abs() < LEAST_COSINE {
            return None;
        }
        let height = other.normal.dot(other.position - centre.position) / cosine;
        let [epsilon, own] = [other, centre].map(|surfel| f64::from(self.settings.epsilon) * surfel.radius);
        let weight = self.weight(other, centre.position + height * centre.normal)?;
        (height.abs() <= epsilon.max(own)).then_some(Hit { height, epsilon, weight })
    }

    /// The kernel of a surfel at a point of its plane; `None` beyond its rim.
    fn weight(&self, surfel: &Surfel, point: DVec3) -> Option<f64> {
        let offset = (point - surfel.position) / surfel.radius;
        let across = offset.dot(surfel.normal.cross(surfel.major)) / surfel.aspect;
        kernel(self.settings, DVec2::new(offset.dot(surfel.major), across))
    }
}

/// The kernel of a disc at a position in its plane, in semi-axes from its centre; `None` beyond its rim.
pub(super) fn kernel(settings: &Settings, at: DVec2) -> Option<f64> {
    let rim = if is_square(settings) { at.abs().max_element() } else { at.length() };
    let weight = match settings.splatting.kernel {
        Kernel::Gaussian => (-0.5 * f64::from(settings.cutoff).powi(2) * at.length_squared()).exp(),
        Kernel::Confetti { a, n } => {
            let t = at.length().powf(n.into()).min(1.0);
            (-f64::from(a) * t / (1.0 - t)).exp()
        }
    };
    (rim <= 1.0).then_some(weight)
}

fn is_square(settings: &Settings) -> bool {
    settings.splatting.footprint == Footprint::Parallelogram
}

fn cell(position: DVec3, level: i32) -> I64Vec3 {
    (position / f64::from(level).exp2()).floor().as_i64vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::methods::object_ewa;
    use crate::settings::splatting::Splatting;
    use glam::Vec3;

    /// A lattice of spacing 1 in the plane z = 0, of discs with the given radius.
    fn lattice(side: u32, radius: f32) -> Surfels {
        let at = |i: u32| Vec3::new((i % side) as f32, (i / side) as f32, 0.0);
        Surfels {
            positions: (0..side * side).map(at).collect(),
            normals: vec![Vec3::Z; (side * side) as usize],
            radii: vec![radius; (side * side) as usize],
            ..Default::default()
        }
    }

    #[test]
    fn on_a_lattice_it_is_the_lattice_sum() {
        let mut surfels = lattice(9, 1.5);
        // Another surface below, and one above.
        surfels.positions.extend([Vec3::new(4.0, 4.0, -2.0), Vec3::new(4.0, 4.0, 1.6)]);
        surfels.normals.extend([Vec3::Z; 2]);
        surfels.radii.extend([1.5; 2]);
        let settings = object_ewa::METHOD.settings();
        // ½ F² d² / r² = d² / 2.25 with F = √2: eight neighbours are within the square, at 1 and √2; five at the border.
        let [one, two] = [1.0, 2.0].map(|square: f64| (-square / 2.25).exp());
        let found = overlaps(&surfels, &settings, &[40, 4, 0]);
        let expected = [1.0 + 4.0 * one + 4.0 * two, 1.0 + 3.0 * one + 2.0 * two, 1.0 + 2.0 * one + two];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
        }
        let disc = Splatting { footprint: Footprint::Disc, ..settings.splatting };
        let narrow = overlaps(&lattice(9, 1.25), &Settings { splatting: disc, ..settings }, &[40]);
        assert!((narrow[0] - 1.0 - 4.0 * (-1.0f64 / 1.5625).exp()).abs() < 1e-6, "√2 is beyond 1.25");
    }

    #[test]
    fn what_is_of_another_size_counts_as_far_as_it_reaches() {
        let mut surfels = lattice(3, 0.25);
        surfels.positions.push(Vec3::new(9.0, 1.0, 0.0));
        surfels.normals.push(Vec3::NEG_Z);
        surfels.radii.push(10.0);
        let both = Settings { cull: Cull::None, ..object_ewa::METHOD.settings() };
        let found = overlaps(&surfels, &both, &[4]);
        assert!((found[0] - 1.0 - (-0.64f64).exp()).abs() < 1e-6, "{found:?}");
        // With back-face culling, an eye above sees no other front.
        let front = overlaps(&surfels, &object_ewa::METHOD.settings(), &[4]);
        assert!((front[0] - 1.0).abs() < 1e-6, "{front:?}");
        surfels.two_sided = Some(vec![false, false, false, false, false, false, false, false, false, true]);
        assert_eq!(overlaps(&surfels, &object_ewa::METHOD.settings(), &[4]), found);
    }
}
