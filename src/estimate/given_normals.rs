//! Normals of the file: whether their sides agree, as those of neighbours on a surface do.

use super::draft::lacks_normal;
use crate::geometry::Surfels;
use glam::Vec3;
use rayon::prelude::*;

/// Which normals the surfels get.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum NormalSource {
    /// Those of the file, unless their sides contradict each other; estimated ones where the file has none.
    #[default]
    Auto,
    /// Those of the file, as they are; estimated ones where it has none.
    File,
    /// Estimated ones for all points.
    Estimate,
}

/// Pairs of neighbours whose normals are less than 37° from parallel, or antiparallel, and less than 17° from orthogonal to the line between
/// both, are on one surface, or on both sides of a thin one.
const PARALLEL: f32 = 0.8;
const ALONG: f32 = 0.3;
/// Neighbours are at most this factor of the median distance apart.
const NEAR: f32 = 4.0;
/// Least number of pairs, and the greatest share of them whose sides contradict each other: half of all for sides at random.
const FEWEST: usize = 100;
const CONTRADICTORY: f64 = 0.1;

/// Whether the sides of given normals contradict each other, of surfels in Morton order. Two-sided surfels have normals of either side.
///
/// Antiparallel neighbours are back to back on the two sides of a thin sheet. Where sides are at random, as many are front to front: each
/// of these stands for two that contradict each other. Points with both sides at one position are a sheet without a thickness.
pub(super) fn contradict(surfels: &Surfels) -> bool {
    let [contradictory, all] = pairs(surfels);
    all >= FEWEST && contradictory as f64 > CONTRADICTORY * all as f64
}

/// Number of pairs of consecutive neighbours whose sides contradict each other, and of all that are on one surface.
fn pairs(surfels: &Surfels) -> [usize; 2] {
    let positions = &surfels.positions;
    let is_one_sided = |i: usize| {
        surfels.normals[i] != Vec3::ZERO && !surfels.two_sided.as_ref().is_some_and(|two_sided| two_sided[i])
    };
    let step = |i: usize| positions[i + 1] - positions[i];
    let followed: Vec<usize> = (0..positions.len().saturating_sub(1))
        .into_par_iter()
        .filter(|&i| is_one_sided(i) && is_one_sided(i + 1))
        .collect();
    let mut distances: Vec<f32> =
        followed.par_iter().map(|&i| step(i).length()).filter(|length| *length > 0.0).collect();
    let middle = distances.len() / 2;
    let Some(_) = distances.get(middle) else { return [0; 2] };
    let farthest = NEAR * *distances.select_nth_unstable_by(middle, f32::total_cmp).1;
    // Contradictory, coincident and all.
    let of_pair = |&i: &usize| {
        let (along, [m, n]) = (step(i), [i, i + 1].map(|i| surfels.normals[i]));
        let (distance, agreement) = (along.length(), m.dot(n));
        let is_along = m.dot(along).abs().max(n.dot(along).abs()) <= ALONG * distance;
        if distance > farthest || agreement.abs() < PARALLEL || !is_along {
            return [0; 3];
        }
        let apart = (m - n).dot(along);
        match agreement < 0.0 {
            true if distance == 0.0 => [0, 1, 1],
            true if apart > 0.0 => [2, 0, 1],
            true if apart == 0.0 => [1, 0, 1],
            _ => [0, 0, 1],
        }
    };
    let add = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [contradictory, coincident, all] = followed.par_iter().map(of_pair).reduce(|| [0; 3], add);
    // Each coincident pair explains two antiparallel steps: to it and from it.
    [contradictory.saturating_sub(2 * coincident), all]
}

/// Removes the given normals, so that they are estimated; returns their number. Declared billboards stay.
pub(super) fn remove(surfels: &mut Surfels) -> u64 {
    let given: Vec<usize> = (0..surfels.len())
        .filter(|&i| surfels.normals[i] != Vec3::ZERO && !lacks_normal(surfels, i))
        .collect();
    for &i in &given {
        surfels.normals[i] = Vec3::ZERO;
        // With a radius, it would declare a billboard.
        if let Some(two_sided) = &mut surfels.two_sided {
            two_sided[i] = false;
        }
    }
    given.len() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Result;
    use crate::estimate::{Estimate, Estimated};
    use crate::geometry::Cloud;

    /// Points of a unit sphere with outward normals.
    fn sphere(count: u32) -> Surfels {
        let point = |i: u32| {
            let z = 1.0 - (2 * i + 1) as f32 / count as f32;
            let (sin, cos) = (2.399_963 * i as f32).sin_cos();
            Vec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
        };
        let positions: Vec<Vec3> = (0..count).map(point).collect();
        let mut surfels = Surfels {
            normals: positions.clone(),
            radii: vec![0.05; positions.len()],
            positions,
            ..Surfels::default()
        };
        surfels.sort_morton();
        surfels
    }

    /// Turns about this part of the normals round.
    fn turn(surfels: &mut Surfels, part: f64) {
        let chosen = |i: usize| (i as f64 * 0.618_034).fract() < part;
        surfels.normals.iter_mut().enumerate().filter(|(i, _)| chosen(*i)).for_each(|(_, n)| *n = -*n);
    }

    /// Both sides of a square of unit spacing, so far apart.
    fn sheet(thickness: f32) -> Surfels {
        let side = |z: f32| (0..900).map(move |i| Vec3::new((i % 30) as f32, (i / 30) as f32, z));
        let positions: Vec<Vec3> = side(0.0).chain(side(thickness)).collect();
        let normals = [vec![Vec3::NEG_Z; 900], vec![Vec3::Z; 900]].concat();
        let mut surfels = Surfels { normals, radii: vec![0.5; 1800], positions, ..Surfels::default() };
        surfels.sort_morton();
        surfels
    }

    #[test]
    fn both_sides_of_a_bent_sheet_agree() {
        for thickness in [1e-4, 1e-3, 1e-2] {
            let (mut outside, inside) = (sphere(4000), sphere(4000));
            outside.positions.extend(inside.positions.iter().map(|p| *p * (1.0 - thickness)));
            outside.normals.extend(inside.normals.iter().map(|n| -*n));
            outside.radii.extend(inside.radii);
            outside.sort_morton();
            assert!(!contradict(&outside), "{thickness}");
        }
    }

    #[test]
    fn sides_at_random_contradict_each_other_and_both_sides_of_a_sheet_do_not() {
        assert!(!contradict(&sphere(3000)));
        for thickness in [0.0, 1e-3, 0.05, 0.2, 1.0, 4.0] {
            assert!(!contradict(&sheet(thickness)), "{thickness}");
        }
        let mut mixed = sheet(0.3);
        turn(&mut mixed, 0.5);
        assert!(contradict(&mixed));
        for part in [0.1, 0.5, 0.9] {
            let mut surfels = sphere(3000);
            turn(&mut surfels, part);
            assert!(contradict(&surfels), "{part}");
            surfels.two_sided = Some(vec![true; surfels.len()]);
            assert!(!contradict(&surfels), "two-sided");
        }
        let mut inwards = sphere(3000);
        turn(&mut inwards, 1.0);
        assert!(!contradict(&inwards));
        // Two pieces, and too few points to tell.
        let mut half = sphere(3000);
        half.normals[..1500].iter_mut().for_each(|normal| *normal = -*normal);
        assert!(!contradict(&half));
        let mut few = sphere(60);
        turn(&mut few, 0.5);
        assert!(!contradict(&few));
    }

    #[test]
    fn normals_are_those_of_the_file_or_estimated() -> Result<()> {
        let mut surfels = sphere(3000);
        turn(&mut surfels, 0.3);
        let estimated = |normals| -> Result<(usize, Estimated)> {
            let (positions, given) = (surfels.positions.clone(), Some(surfels.normals.clone()));
            let cloud = Cloud { positions, normals: given, ..Cloud::default() };
            let (found, counts) = cloud.into_surfels(&Estimate { normals, ..Estimate::default() }, &())?;
            let outwards = found.positions.iter().zip(&found.normals).filter(|(p, n)| p.dot(**n) > 0.9);
            Ok((outwards.count(), counts))
        };
        let (outwards, counts) = estimated(NormalSource::Auto)?;
        assert_eq!(
            (outwards, counts.normals_contradictory, counts.normals_from_neighbours),
            (3000, 3000, 3000)
        );
        let (outwards, counts) = estimated(NormalSource::Estimate)?;
        assert_eq!((outwards, counts.normals_contradictory, counts.normals_from_neighbours), (3000, 0, 3000));
        let (outwards, counts) = estimated(NormalSource::File)?;
        assert_eq!((counts.normals_given, counts.normals_contradictory), (3000, 0));
        assert!(outwards < 2400, "{outwards} outwards");
        Ok(())
    }

    #[test]
    fn declared_billboards_stay() {
        let mut surfels = sphere(3);
        surfels.normals[1] = Vec3::ZERO;
        surfels.two_sided = Some(vec![false, true, false]);
        assert_eq!(remove(&mut surfels), 2);
        assert!(!lacks_normal(&surfels, 1) && lacks_normal(&surfels, 0));
        // Two-sided discs with radii, as of a file that was converted.
        let mut surfels = Surfels { two_sided: Some(vec![true; 3]), ..sphere(3) };
        assert_eq!(remove(&mut surfels), 3);
        assert!((0..3).all(|i| lacks_normal(&surfels, i)));
    }
}
