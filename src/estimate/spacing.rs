//! Distance between points.

use super::sites::Sites;
use glam::Vec3;
use rayon::prelude::*;

/// Median distance from a point to the nearest distinct one, in the points' unit; `None` if all coincide.
pub fn spacing(positions: &[Vec3]) -> Option<f32> {
    let sites = Sites::new(positions, &()).ok()?;
    let distance = |site: u32| Some(sites.at(site).distance(sites.at(sites.nearest(site, 1).next()?)));
    let mut distances: Vec<f32> = (0..sites.len() as u32).into_par_iter().filter_map(distance).collect();
    let middle = distances.len() / 2;
    (!distances.is_empty()).then(|| sites.unit * *distances.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_median_of_the_nearest() {
        let at = |x: f32| Vec3::new(x, 7.0, 0.0);
        assert_eq!(spacing(&[at(0.0), at(3.0), at(4.0), at(4.0), at(40.0)]), Some(3.0));
        assert_eq!(spacing(&[at(1.0), at(1.0)]), None);
        assert_eq!(spacing(&[]), None);
    }
}
