//! Statistical removal of points far from all others (Rusu et al., Towards 3D Point Cloud Based Object Maps for Household Environments,
//! 2008, section 4.1).

use super::Estimate;
use super::sites::Sites;
use crate::geometry::Surfels;
use rayon::prelude::*;

/// Removes the surfels whose mean distance from their neighbours is more than `deviations` standard deviations above the mean of all. Gives
/// their number.
pub(super) fn remove(surfels: &mut Surfels, deviations: f32, how: &Estimate) -> Result<u64, String> {
    let sites = Sites::new(&surfels.positions)?;
    let mean_distance = |site: u32| {
        let distances = sites
            .nearest(site, how.neighbours)
            .map(|other| f64::from(sites.at(site).distance(sites.at(other))));
        let (sum, count) = distances.fold((0.0, 0u32), |(sum, count), distance| (sum + distance, count + 1));
        sum / f64::from(count.max(1))
    };
    let distances: Vec<f64> = (0..sites.len() as u32).into_par_iter().map(mean_distance).collect();
    let count = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|distance| (distance - mean).powi(2)).sum::<f64>() / count;
    let most = mean + f64::from(deviations) * variance.sqrt();
    let stays = |i: &u32| distances[sites.of_point[*i as usize] as usize] <= most;
    let kept: Vec<u32> = (0..surfels.len() as u32).filter(stays).collect();
    let removed = surfels.len() - kept.len();
    if removed > 0 {
        surfels.permute(&kept);
    }
    Ok(removed as u64)
}
