//! Neighbours in a scan: the points next to each other as the scanner sees them.
//!
//! Where a scanner sees a surface at a grazing angle, such as the ground far from it, the points nearest in space are all of one line of the
//! scan. They tell neither the normal nor how far the next line is. The points nearest by direction surround a point at any angle. They are
//! found in space seen from the scanner with ranges r compressed to rᵏ, in which points beyond a step in range stay far away.

use super::Scanner;
use super::draft::Draft;
use super::sites::{Sites, nearest};
use crate::geometry::View;
use glam::Vec3;
use kiddo::ImmutableKdTree;
use rayon::prelude::*;

/// Exponent of ranges. A surface at an angle of incidence whose tangent is 1 / k is as dense along its slope as across.
const COMPRESSION: f32 = 0.05;
/// Least number of points of a scan.
const FEWEST: usize = 1000;
/// Number of points from which a scan is judged.
const SAMPLE: usize = 2000;
/// Least median ratio of the distances of the two nearest points. It is 1 in any grid of directions, and √½ among random directions.
const REGULAR: f32 = 0.85;
/// Largest number of points whose scanner is looked for: a lidar sees fewer in a turn.
const MOST: usize = 4_000_000;
/// Least of these where the position of the scanner is not known.
const CLEARLY_REGULAR: f32 = 0.93;
/// Largest spread of the angles between points there, relative to that of their distances, which grow with the range.
const EVEN: f32 = 0.75;
/// Least ratio of the ranges of the farthest and the nearest tenth of the points there.
const DEEP: f32 = 2.0;

/// The sites of the scans of a cloud.
pub(super) struct Scans {
    scans: Vec<Scan>,
    /// The scan of each site; [`NONE`] if it is in none. Empty without scans.
    of_site: Vec<u16>,
    /// Its index in the scan.
    index: Vec<u32>,
}

/// The sites that a scanner saw from one position.
struct Scan {
    tree: ImmutableKdTree<f32, 3>,
    points: Vec<[f32; 3]>,
    sites: Vec<u32>,
}

/// No scan.
const NONE: u16 = u16::MAX;

impl Scans {
    /// The scans whose scanner is known and that have a point per direction of a grid. The scanner of a draft without one may be found.
    pub fn new(draft: &mut Draft, sites: &Sites, scanner: Scanner) -> Self {
        if scanner == Scanner::Auto && draft.views() == [View::Unknown] {
            let eye = (-draft.surfels.origin).as_vec3();
            if is_lidar(eye / sites.unit, sites) {
                draft.set_view(View::From(eye));
                draft.estimated.scanner_found = draft.surfels.len() as u64;
            }
        }
        if !draft.views().iter().any(|view| matches!(view, View::From(_))) {
            return Self { scans: Vec::new(), of_site: Vec::new(), index: Vec::new() };
        }
        let mut members = vec![Vec::new(); draft.views().len()];
        for site in 0..sites.len() as u32 {
            if let Some(members) = members.get_mut(draft.scan(sites.point[site as usize] as usize)) {
                members.push(site);
            }
        }
        let mut all =
            Self { scans: Vec::new(), of_site: vec![NONE; sites.len()], index: vec![0; sites.len()] };
        for (view, members) in draft.views().iter().zip(members).take(usize::from(NONE)) {
            let View::From(eye) = *view else { continue };
            let Some(found) = Scan::new(members, eye / sites.unit, sites) else { continue };
            for (index, site) in found.sites.iter().enumerate() {
                (all.of_site[*site as usize], all.index[*site as usize]) =
                    (all.scans.len() as u16, index as u32);
            }
            all.scans.push(found);
        }
        all
    }

    /// Whether a site is in a scan.
    pub fn has(&self, site: u32) -> bool {
        self.of_site.get(site as usize).is_some_and(|scan| *scan != NONE)
    }

    /// Replaces the sites that are nearest to `site` in space by up to `count` that are so by direction, nearest first. Returns false, and
    /// leaves them, if some are of other scans, which fill the gaps of this one, or the site is in none.
    pub fn nearest(&self, site: u32, count: usize, near: &mut Vec<u32>) -> bool {
        let Some(&number) = self.of_site.get(site as usize) else { return false };
        let is_alone = || near.iter().all(|other| self.of_site[*other as usize] == number);
        let Some(scan) = self.scans.get(usize::from(number)).filter(|_| is_alone()) else { return false };
        let found = nearest(&scan.tree, &scan.points, self.index[site as usize], count);
        near.clear();
        near.extend(found.map(|index| scan.sites[index as usize]));
        true
    }
}

impl Scan {
    /// The scan of some sites, unless it is none: few points, or directions that are no grid.
    fn new(sites: Vec<u32>, eye: Vec3, all: &Sites) -> Option<Self> {
        Self::of(sites, eye, all).filter(|scan| scan.spacing().regularity > REGULAR)
    }

    fn of(sites: Vec<u32>, eye: Vec3, all: &Sites) -> Option<Self> {
        if sites.len() < FEWEST {
            return None;
        }
        let compressed = |site: &u32| {
            let beam = all.at(*site) - eye;
            (beam * beam.length().max(f32::MIN_POSITIVE).powf(COMPRESSION - 1.0)).to_array()
        };
        let points: Vec<[f32; 3]> = sites.par_iter().map(compressed).collect();
        let is_finite = points.iter().flatten().all(|coordinate| coordinate.is_finite());
        let tree = ImmutableKdTree::new_from_slice(&points).ok().filter(|_| is_finite)?;
        Some(Self { tree, points, sites })
    }

    /// The spacing of the directions.
    fn spacing(&self) -> Spacing {
        Spacing::of(&self.points, |index, count| nearest(&self.tree, &self.points, index, count))
    }
}

/// Whether points are those that a lidar sees around it from `eye`: at many ranges in a grid by direction, whose angles are more even than
/// the distances in space.
fn is_lidar(eye: Vec3, sites: &Sites) -> bool {
    if !(FEWEST..=MOST).contains(&sites.len()) {
        return false;
    }
    let all = || 0..sites.len() as u32;
    let mut ranges: Vec<f32> = all().map(|site| sites.at(site).distance(eye)).collect();
    if spread(&mut ranges, 0.1) <= DEEP {
        return false;
    }
    let Some(scan) = Scan::of(all().collect(), eye, sites) else { return false };
    let by_direction = scan.spacing();
    let in_space = Spacing::of(sites.points(), |index, count| sites.nearest(index, count));
    by_direction.regularity > CLEARLY_REGULAR && by_direction.spread < EVEN * in_space.spread
}

/// How evenly points are spaced.
struct Spacing {
    /// Median ratio of the distances of the two nearest points.
    regularity: f32,
    /// Ratio of the quartiles of the distance of the nearest one.
    spread: f32,
}

impl Spacing {
    /// The spacing of some of the points.
    fn of<I: Iterator<Item = u32>>(points: &[[f32; 3]], nearest: impl Fn(u32, usize) -> I + Sync) -> Self {
        let two = |index: usize| {
            let at = Vec3::from(points[index]);
            let mut near = nearest(index as u32, 2).map(|other| at.distance(points[other as usize].into()));
            Some([near.next()?, near.next()?])
        };
        let step = points.len().div_ceil(SAMPLE).max(1);
        let pairs: Vec<[f32; 2]> = (0..points.len()).into_par_iter().step_by(step).filter_map(two).collect();
        let mut ratios: Vec<f32> = pairs.iter().map(|[first, second]| first / second).collect();
        let mut first: Vec<f32> = pairs.iter().map(|[first, _]| *first).collect();
        Self { regularity: at_part(&mut ratios, 0.5), spread: spread(&mut first, 0.25) }
    }
}

/// Ratio of the values at a part from the end and from the beginning of their order.
fn spread(values: &mut [f32], part: f64) -> f32 {
    at_part(values, 1.0 - part) / at_part(values, part)
}

/// The value at a part of the order of values; not a number without any.
fn at_part(values: &mut [f32], part: f64) -> f32 {
    let index = (part * values.len() as f64) as usize;
    if index < values.len() { *values.select_nth_unstable_by(index, f32::total_cmp).1 } else { f32::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Estimate;
    use crate::geometry::{Cloud, Ellipse, Surfels, Viewpoints};
    use glam::DVec3;

    /// Height of the scanner above the ground.
    const HEIGHT: f32 = 1.7;
    /// Angle between beams.
    const STEP: f32 = 0.0087;

    /// Where beams from `eye` with azimuths and elevations in steps meet the ground, which is at z = 0.
    fn ground(eye: Vec3) -> Vec<Vec3> {
        let elevations = (8..80).map(|row| -STEP * row as f32);
        let beams = elevations.flat_map(|elevation| {
            (0..720).map(move |column| {
                let range = eye.z / -elevation.tan();
                let (sin, cos) = (STEP * column as f32).sin_cos();
                Vec3::new(eye.x + range * cos, eye.y + range * sin, 0.0)
            })
        });
        beams.collect()
    }

    fn surfels(positions: Vec<Vec3>, view: View, scanner: Scanner) -> (Surfels, u64) {
        let cloud = Cloud { positions, view, ..Default::default() };
        let (surfels, estimated) =
            cloud.into_surfels(&Estimate { scanner, ..Default::default() }, &()).unwrap();
        (surfels, estimated.scanner_found)
    }

    /// The part of places between the lines of the scan of a scanner at 0 that a disc covers.
    fn covered(surfels: &Surfels) -> f32 {
        let covers = |place: Vec3| {
            (0..surfels.len()).into_par_iter().any(|i| {
                let ellipse = surfels.ellipses.as_ref().map_or(Ellipse::circle(Vec3::Z), |all| all[i]);
                let offset = place - surfels.positions[i];
                let along = offset.dot(ellipse.major);
                let across = (offset.length_squared() - along * along).max(0.0).sqrt() / ellipse.aspect;
                along.hypot(across) <= surfels.radii[i]
            })
        };
        let places = (0..300).map(|i| {
            let range = HEIGHT / (STEP * (10.5 + (i * 7 % 65) as f32)).tan();
            let (sin, cos) = (STEP * (i as f32 * 2.4 + 0.5)).sin_cos();
            range * Vec3::new(cos, sin, 0.0)
        });
        places.filter(|place| covers(*place)).count() as f32 / 300.0
    }

    #[test]
    fn the_ground_about_a_scanner_is_whole_far_from_it() {
        let eye = HEIGHT * Vec3::Z;
        let (known, _) = surfels(ground(eye), View::From(eye), Scanner::Auto);
        assert!(known.normals.iter().all(|normal| normal.z > 0.999));
        assert_eq!(covered(&known), 1.0);
        // At 24 m the lines are 3 m apart, and the points of a line 0.2 m.
        let farthest = (0..known.len()).max_by(|a, b| known.radii[*a].total_cmp(&known.radii[*b])).unwrap();
        let aspect = known.ellipses.as_ref().unwrap()[farthest].aspect;
        assert!((1.5..3.5).contains(&known.radii[farthest]) && aspect < 0.2, "{}", known.radii[farthest]);
        let (unknown, _) = surfels(ground(eye), View::Unknown, Scanner::OfFile);
        assert!(covered(&unknown) < 0.9, "{}", covered(&unknown));
        let (given, _) = surfels(ground(eye), View::Unknown, Scanner::At(eye.as_dvec3()));
        assert_eq!((given.radii, given.normals), (known.radii, known.normals));
    }

    #[test]
    fn the_scanner_at_0_of_a_lidar_is_found_and_none_in_other_points() {
        let eye = HEIGHT * Vec3::Z;
        let part = |i: usize, factor: f64| (i as f64 * factor).fract() as f32 - 0.5;
        // Ranges have an error of up to 2 cm.
        let noisy = |(i, at): (usize, Vec3)| {
            let beam = at - eye;
            beam + 0.04 * part(i, 0.754_877) * beam.normalize()
        };
        let lidar: Vec<Vec3> = ground(eye).into_iter().enumerate().map(noisy).collect();
        let count = lidar.len() as u64;
        let found = |positions: Vec<Vec3>, scanner| surfels(positions, View::Unknown, scanner).1;
        assert_eq!(found(lidar.clone(), Scanner::Auto), count);
        assert_eq!(found(lidar.clone(), Scanner::OfFile), 0);
        assert_eq!(found(lidar.iter().map(|at| *at + 6.0 * Vec3::X).collect(), Scanner::Auto), 0);
        // At 0 by their origin alone.
        let origin = DVec3::new(1e6, 2e6, 0.0);
        let far = Cloud { origin, positions: lidar.clone(), ..Default::default() };
        assert_eq!(far.into_surfels(&Estimate::default(), &()).unwrap().1.scanner_found, 0);
        let at = |i: usize| Vec3::new(part(i, 0.819_173), part(i, 0.671_044), part(i, 0.549_701));
        let ball: Vec<Vec3> = (0..20_000).map(at).filter(|at| at.length() < 0.5).collect();
        assert_eq!(found(ball, Scanner::Auto), 0);
        let terrain = (0..20_000).map(|i| {
            let (x, y) = ((i % 200) as f32 - 100.3, (i / 200) as f32 - 50.6);
            Vec3::new(x, y, (0.1 * x).sin() - 3.0)
        });
        assert_eq!(found(terrain.collect(), Scanner::Auto), 0);
    }

    #[test]
    fn points_of_another_scan_in_the_gaps_of_one_are_its_neighbours() {
        let [a, b] = [Vec3::new(0.0, 0.0, HEIGHT), Vec3::new(9.0, 0.0, HEIGHT)];
        let (first, second) = (ground(a), ground(b));
        let scans = [vec![0; first.len()], vec![1; second.len()]].concat();
        let positions = [first, second].concat();
        let views = vec![View::From(a), View::From(b)];
        let viewpoints = Some(Viewpoints { views, scans });
        let cloud = Cloud { positions, viewpoints, ..Default::default() };
        let (surfels, _) = cloud.into_surfels(&Estimate::default(), &()).unwrap();
        // The first scanner's lines are 0.4 m apart there, and the second one's points 0.05 m.
        let near_second =
            (0..surfels.len()).filter(|i| (2.8..3.5).contains(&surfels.positions[*i].distance(b)));
        let largest = near_second.map(|i| surfels.radii[i]).fold(0.0, f32::max);
        assert!(largest < 0.2, "{largest}");
    }

    #[test]
    fn a_scanner_must_be_somewhere() {
        let how = Estimate { scanner: Scanner::At(DVec3::new(0.0, f64::NAN, 0.0)), ..Default::default() };
        let refused = Cloud::default().into_surfels(&how, &()).unwrap_err().to_string();
        assert!(refused.contains("the scanner is at [0, NaN, 0]"), "{refused}");
    }
}
