//! Samplers of surfaces.

mod atlas;
mod blue_noise;
mod rows;
mod scanner;

use super::edges::{self, Disc};
use super::query::Query;
use super::random::Random;
use super::surface::Surface;
use crate::error::Result;
use crate::geometry::{Clips, Colours, Ellipse, Surfels};
use atlas::Atlas;
use glam::DVec3;
use rayon::prelude::*;

/// Samples that share a sequence of random numbers.
const CHUNK: usize = 4096;
/// Stream of random numbers for noise, independent of those for positions.
const NOISE_STREAM: u64 = 1 << 40;

/// A surfel before conversion to single precision.
struct Draft {
    position: DVec3,
    /// Point of the surface that was sampled; `None` for an outlier.
    sampled_at: Option<DVec3>,
    normal: DVec3,
    albedo: [f64; 3],
    /// Distance to its neighbours.
    spacing: f64,
    /// Radius of a disc that leaves no hole between neighbours; of an ellipse, the longer semi-axis.
    radius: f64,
    /// The shape of an elliptical disc.
    ellipse: Option<Ellipse>,
    two_sided: bool,
}

/// Samples `surface` as `query` asks, in no particular order.
pub fn sample(query: &Query, surface: &dyn Surface) -> Result<Surfels> {
    let (points, seed) = (query.whole("points") as usize, query.whole("seed"));
    let mut drafts = match query.word("sampler") {
        "scanner" => return Ok(surfels(query, scanner::scan(query, surface)?)),
        "blue-noise" => blue_noise::sample(&Atlas::new(surface.pieces()), points, seed),
        "grid" => rows::grid(&Atlas::new(surface.pieces()), points),
        _ => rows::jittered(&Atlas::new(surface.pieces()), points, seed),
    };
    displace(&mut drafts, query.number("noise"), seed);
    Ok(surfels(query, drafts))
}

/// Moves samples along their normals by normally distributed distances; `deviation` is in spacings.
fn displace(drafts: &mut [Draft], deviation: f64, seed: u64) {
    if deviation > 0.0 {
        drafts.par_chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| {
            let mut random = Random::new(seed, NOISE_STREAM + i as u64);
            for draft in chunk {
                draft.position += deviation * draft.spacing * random.normal() * draft.normal;
            }
        });
    }
}

/// Clips of the samples at the scene's sharp edges.
fn clips(query: &Query, drafts: &[Draft]) -> Option<Clips> {
    let edges = query.scene.edges(query);
    let clip = |draft: &Draft| {
        // The centre rounded as the surfel's.
        let centre = draft.position.as_vec3().as_dvec3();
        edges::clip(
            &edges,
            &Disc { sampled_at: draft.sampled_at?, centre, normal: draft.normal, radius: draft.radius },
        )
    };
    if edges.is_empty() {
        return None;
    }
    let chunk = |chunk: &[Draft]| (Clips::collect(chunk.iter().map(clip)), chunk.len());
    Clips::join(drafts.par_chunks(CHUNK).map(chunk).collect::<Vec<_>>())
}

fn surfels(query: &Query, drafts: Vec<Draft>) -> Surfels {
    let two_sided = drafts.iter().any(|draft| draft.two_sided);
    let elliptical = drafts.iter().any(|draft| draft.ellipse.is_some());
    let ellipse = |draft: &Draft| draft.ellipse.unwrap_or_else(|| Ellipse::circle(draft.normal.as_vec3()));
    Surfels {
        origin: DVec3::ZERO,
        positions: drafts.par_iter().map(|draft| draft.position.as_vec3()).collect(),
        normals: drafts.par_iter().map(|draft| draft.normal.as_vec3()).collect(),
        radii: drafts.par_iter().map(|draft| draft.radius as f32).collect(),
        texture: None,
        materials: None,
        point_indices: None,
        curvatures: None,
        ellipses: elliptical.then(|| drafts.par_iter().map(ellipse).collect()),
        two_sided: two_sided.then(|| drafts.par_iter().map(|draft| draft.two_sided).collect()),
        clips: clips(query, &drafts),
        weights: None,
        colours: Some(Colours::Linear(
            drafts.par_iter().map(|draft| draft.albedo.map(|channel| channel as f32)).collect(),
        )),
    }
}
