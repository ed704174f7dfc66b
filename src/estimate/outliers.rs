//! Statistical outlier removal (Rusu et al., Towards 3D Point Cloud Based Object Maps for Household Environments, 2008, section 4.1).

use super::Estimate;
use super::sites::Sites;
use crate::Progress;
use crate::error::Result;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of sites per task.
const PIECE: usize = 1 << 12;

/// The points whose mean distance from their neighbours is at most `deviations` standard deviations above the mean of all.
pub(super) fn kept(
    positions: &[Vec3],
    deviations: f32,
    how: &Estimate,
    progress: &dyn Progress,
) -> Result<Vec<u32>> {
    let sites = Sites::new(positions, progress)?;
    let distances = distances(&sites, how.neighbours, progress)?;
    let count = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|distance| (distance - mean).powi(2)).sum::<f64>() / count;
    let most = mean + f64::from(deviations) * variance.sqrt();
    let stays = |i: &u32| distances[sites.of_point[*i as usize] as usize] <= most;
    Ok((0..positions.len() as u32).filter(stays).collect())
}

/// Mean distance of each site from its neighbours.
fn distances(sites: &Sites, neighbours: usize, progress: &dyn Progress) -> Result<Vec<f64>> {
    let mean = |site: u32| {
        let each =
            sites.nearest(site, neighbours).map(|other| f64::from(sites.at(site).distance(sites.at(other))));
        let (sum, count) = each.fold((0.0, 0u32), |(sum, count), distance| (sum + distance, count + 1));
        sum / f64::from(count.max(1))
    };
    let mut distances = vec![0.0; sites.len()];
    let (done, total) = (AtomicU64::new(0), sites.len() as u64);
    distances.par_chunks_mut(PIECE).enumerate().try_for_each(|(piece, distances)| {
        let first = (piece * PIECE) as u32;
        distances.iter_mut().zip(first..).for_each(|(distance, site)| *distance = mean(site));
        let piece = distances.len() as u64;
        progress.at("looking for outliers", done.fetch_add(piece, Ordering::Relaxed) + piece, total);
        progress.check_cancelled()
    })?;
    Ok(distances)
}
