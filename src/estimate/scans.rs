//! Scans of a cloud, whose points have neighbours by direction, and the scanner of a lidar that does not state it.

use super::draft::Draft;
use super::scan::{Around, FEWEST, Scan, sample};
use super::sites::Sites;
use super::{Estimate, Scanner};
use crate::geometry::View;
use glam::Vec3;
use rayon::prelude::*;

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

/// No scan.
const NONE: u16 = u16::MAX;

impl Scans {
    /// The scans whose scanner is known and that have a point per direction of a grid. The scanner of a draft without one may be found.
    pub fn new(draft: &mut Draft, sites: &Sites, how: &Estimate) -> Self {
        if how.scanner == Scanner::Auto && draft.views() == [View::Unknown] {
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
            let Some(found) = scan_of(members, eye / sites.unit, sites, how.neighbours) else { continue };
            for (index, site) in found.sites().iter().enumerate() {
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

    /// Replaces `near`, the nearest sites in space, by neighbours in the scan of `site`: see [`Scan::nearest`]. Returns false, and leaves them, if
    /// `site` is in no scan, or some of them are in another, which fills the gaps of this one.
    pub fn nearest(&self, site: u32, otherwise: usize, around: &mut Around, near: &mut Vec<u32>) -> bool {
        let Some(&number) = self.of_site.get(site as usize) else { return false };
        let is_alone = || near.iter().all(|other| self.of_site[*other as usize] == number);
        let Some(scan) = self.scans.get(usize::from(number)).filter(|_| is_alone()) else { return false };
        scan.nearest(self.index[site as usize], otherwise, around, near)
    }
}

/// The scan of some sites, unless it is none: few points, or directions that are no grid.
fn scan_of(members: Vec<u32>, eye: Vec3, all: &Sites, neighbours: usize) -> Option<Scan> {
    let is_grid = |scan: &Scan| Spacing::by_direction(scan).regularity > REGULAR;
    Scan::new(members, eye, all).filter(is_grid).map(|scan| scan.reaching_around(neighbours))
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
    let Some(scan) = Scan::new(all().collect(), eye, sites) else { return false };
    let by_direction = Spacing::by_direction(&scan);
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
    /// The spacing of the directions of a scan.
    fn by_direction(scan: &Scan) -> Self {
        Self::of(scan.points(), |index, count| scan.by_direction(index, count))
    }

    /// The spacing of some of the points.
    fn of<I: Iterator<Item = u32>>(points: &[[f32; 3]], nearest: impl Fn(u32, usize) -> I + Sync) -> Self {
        let two = |index: usize| {
            let at = Vec3::from(points[index]);
            let mut near = nearest(index as u32, 2).map(|other| at.distance(points[other as usize].into()));
            Some([near.next()?, near.next()?])
        };
        let pairs: Vec<[f32; 2]> = sample(points.len()).filter_map(two).collect();
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
    /// Number of beams of a line: a third of a turn.
    const COLUMNS: usize = 240;

    /// Where beams from `eye` with azimuths and elevations in steps, of which only each `line`-th is there, meet the ground, which is at
    /// z = 0. Ranges have an error of up to `noise`.
    fn beams(eye: Vec3, line: usize, noise: f32) -> Vec<Vec3> {
        let elevations = (8..80).step_by(line).map(|row| -STEP * row as f32);
        let directions = elevations.flat_map(|elevation| {
            (0..COLUMNS).map(move |column| {
                let (sin, cos) = (STEP * column as f32).sin_cos();
                Vec3::new(cos, sin, elevation.tan())
            })
        });
        let meet = |(i, direction): (usize, Vec3)| {
            eye + direction * (eye.z / -direction.z)
                + 2.0 * noise * part(i, 0.754_877) * direction.normalize()
        };
        directions.enumerate().map(meet).collect()
    }

    fn ground(eye: Vec3) -> Vec<Vec3> {
        beams(eye, 1, 0.0)
    }

    /// A number from -½ to ½.
    fn part(i: usize, factor: f64) -> f32 {
        (i as f64 * factor).fract() as f32 - 0.5
    }

    fn surfels(positions: Vec<Vec3>, view: View, scanner: Scanner) -> (Surfels, u64) {
        let cloud = Cloud { positions, view, ..Default::default() };
        let (surfels, estimated) =
            cloud.into_surfels(&Estimate { scanner, outlines: false, ..Default::default() }, &()).unwrap();
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
            let (sin, cos) = (STEP * (i as f32 * 0.75 + 5.5)).sin_cos();
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
    fn the_ground_is_as_whole_with_noise_and_with_lines_far_apart() {
        let eye = HEIGHT * Vec3::Z;
        for (line, noise, least) in [(1, 0.05, 1.0), (7, 0.02, 0.95)] {
            let points = beams(eye, line, noise);
            let covered = covered(&surfels(points, View::From(eye), Scanner::OfFile).0);
            assert!(covered >= least, "{line} {noise}: {covered}");
        }
    }

    #[test]
    fn discs_at_the_border_of_a_scan_are_as_those_in_it() {
        let eye = HEIGHT * Vec3::Z;
        let half = ground(eye).into_iter().filter(|at| at.y > -0.001).collect();
        let (surfels, _) = surfels(half, View::From(eye), Scanner::OfFile);
        // 3 m away the lines are 0.06 m apart, and the points of a line 0.03 m; at 4 m, 0.1 m and 0.04 m.
        let is_border =
            |i: &usize| (3.0..4.0).contains(&surfels.positions[*i].x) && surfels.positions[*i].y < 0.001;
        let aspects: Vec<f32> = (0..surfels.len())
            .filter(is_border)
            .map(|i| surfels.ellipses.as_ref().unwrap()[i].aspect)
            .collect();
        assert!(aspects.len() > 5 && aspects.iter().all(|aspect| *aspect < 0.8), "{aspects:?}");
    }

    #[test]
    fn the_scanner_at_0_of_a_lidar_is_found_and_none_in_other_points() {
        let eye = HEIGHT * Vec3::Z;
        let lidar: Vec<Vec3> = beams(eye, 1, 0.02).into_iter().map(|at| at - eye).collect();
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
        let is_near_second = |i: &usize| {
            let offset = surfels.positions[*i] - b;
            (2.8..3.5).contains(&offset.length()) && offset.x > 0.0 && offset.y > 1.0
        };
        let near_second = (0..surfels.len()).filter(is_near_second);
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
