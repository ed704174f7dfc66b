//! Weighted sums of rays per pixel, and the picture computed from them.

use super::eye::SurfaceHit;
use super::kernel::Kernel;
use super::pixel::Sample;
use super::{StandardError, Truth};
use crate::picture::Picture;
use crate::settings::{Settings, Shading};
use glam::DVec3;
use std::ops::Range;

/// `Σ w` times each [value](super::pixel::Value), and `Σ w²` times the variance of the values; `Σ w` is 1.
type Cell = [f64; 8];

const ALPHA: usize = 0;
const VARIANCE: usize = 7;

/// Contributions of the rays through some rows to the pixels within reach of the filter.
pub struct BandSums<'a> {
    kernel: &'a Kernel,
    width: usize,
    /// Rows of `cells`, inside the picture.
    rows: Range<i64>,
    cells: Vec<Cell>,
    /// Rows of `centre_hits`, inside the picture.
    own: Range<i64>,
    centre_hits: Vec<Option<SurfaceHit>>,
}

impl<'a> BandSums<'a> {
    /// Contributions of the rays through `rows`, some of which may lie beyond the picture.
    pub fn new(kernel: &'a Kernel, size: [u32; 2], rows: Range<i64>) -> Self {
        let (width, height, reach) = (size[0] as usize, i64::from(size[1]), kernel.reach as i64);
        let inside = |rows: Range<i64>| rows.start.clamp(0, height)..rows.end.clamp(0, height);
        let own = inside(rows.clone());
        let rows = inside(rows.start - reach..rows.end + reach);
        let pixels = |rows: &Range<i64>| (rows.end - rows.start) as usize * width;
        let (cells, centre_hits) = (vec![[0.0; 8]; pixels(&rows)], vec![None; pixels(&own)]);
        Self { kernel, width, rows, cells, own, centre_hits }
    }

    /// Adds the rays of the pixel `at`, one per stratum, with the variances of their values.
    pub fn add(&mut self, at: [i64; 2], samples: &[Sample], variances: &[f64]) {
        if samples.iter().all(|sample| sample.hit.is_none()) {
            return;
        }
        let strata = samples.len().isqrt();
        let rows = samples.chunks(strata).zip(variances.chunks(strata));
        let mut row = vec![[0.0; 8]; self.kernel.width()];
        for ((samples, variances), weights) in rows.zip(self.kernel.weights(strata)) {
            self.along(samples, variances, &mut row);
            self.across(at, &row, weights);
        }
    }

    /// Sums a row of strata for the pixels of the same row.
    fn along(&self, samples: &[Sample], variances: &[f64], row: &mut [Cell]) {
        row.fill([0.0; 8]);
        let strata = samples.iter().zip(variances).zip(self.kernel.weights(samples.len()));
        for ((sample, variance), weights) in strata {
            let [v0, v1, v2, v3, v4, v5, v6] = sample.value();
            let values = [v0, v1, v2, v3, v4, v5, v6, *variance];
            for (cell, &weight) in row.iter_mut().zip(weights) {
                add(cell, &values, weight);
            }
        }
    }

    /// Adds the sums of a row of strata of the pixel `at` to the rows of the picture.
    fn across(&mut self, at: [i64; 2], row: &[Cell], weights: &[f64]) {
        let reach = self.kernel.reach as i64;
        let clip = |at: i64, start: i64, end: i64| (at - reach).max(start)..(at + reach + 1).min(end);
        let columns = clip(at[0], 0, self.width as i64);
        if columns.is_empty() {
            return;
        }
        let row = &row[(columns.start - at[0] + reach) as usize..][..(columns.end - columns.start) as usize];
        for y in clip(at[1], self.rows.start, self.rows.end) {
            let first = (y - self.rows.start) as usize * self.width + columns.start as usize;
            let weight = weights[(y - at[1] + reach) as usize];
            for (cell, values) in self.cells[first..].iter_mut().zip(row) {
                add(cell, values, weight);
            }
        }
    }

    /// Stores the surface at the centre of the pixel `at`, if that is in the picture.
    pub fn set_centre_hit(&mut self, [x, y]: [i64; 2], hit: impl FnOnce() -> Option<SurfaceHit>) {
        if self.own.contains(&y) && (0..self.width as i64).contains(&x) {
            self.centre_hits[(y - self.own.start) as usize * self.width + x as usize] = hit();
        }
    }
}

/// Adds weighted values; the variance is weighted by the square.
fn add(cell: &mut Cell, values: &Cell, weight: f64) {
    for (sum, value) in cell[..VARIANCE].iter_mut().zip(values) {
        *sum += weight * value;
    }
    cell[VARIANCE] += weight * weight * values[VARIANCE];
}

/// The sums of a picture.
pub struct Sums {
    size: [u32; 2],
    cells: Vec<Cell>,
    depths: Vec<f32>,
}

impl Sums {
    pub fn new(size: [u32; 2]) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, cells: vec![[0.0; 8]; pixels], depths: vec![0.0; pixels] }
    }

    pub fn add(&mut self, part: &BandSums<'_>) {
        let start = part.rows.start as usize * part.width;
        for (cell, add) in self.cells[start..].iter_mut().zip(&part.cells) {
            cell.iter_mut().zip(add).for_each(|(sum, add)| *sum += add);
        }
        let start = part.own.start as usize * part.width;
        for (depth, hit) in self.depths[start..].iter_mut().zip(&part.centre_hits) {
            *depth = hit.map_or(0.0, |hit| hit.depth as f32);
        }
    }

    /// The picture, and its error relative to `requested`.
    pub fn resolve(self, settings: &Settings, requested: f64) -> Truth {
        let errors = || self.cells.iter().map(|cell| cell[VARIANCE].sqrt());
        let squares: f64 = errors().map(|error| error * error).sum();
        let error = StandardError {
            rms: (squares / self.cells.len() as f64).sqrt(),
            max: errors().fold(0.0, f64::max),
            above: errors().filter(|error| *error > requested).count() as u64,
        };
        let pixels = self.cells.iter().zip(&self.depths);
        let (colour, normal) = pixels.map(|(cell, depth)| resolve(cell, *depth, settings)).unzip();
        let picture =
            Picture { size: self.size, colour, depth: Some(self.depths), normal: Some(normal), id: None };
        Truth { picture, error }
    }
}

/// Colour with α, and the normal.
fn resolve(cell: &Cell, depth: f32, settings: &Settings) -> ([f32; 4], [f32; 3]) {
    // Above 1 only by rounding.
    let covered = cell[ALPHA].min(1.0);
    if covered <= 0.0 {
        let colour = settings.background.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        return (colour, [0.0; 3]);
    }
    let normal = DVec3::new(cell[4], cell[5], cell[6]).normalize_or_zero().as_vec3().to_array();
    let light = DVec3::new(cell[1], cell[2], cell[3]) / covered;
    let shown = match settings.shading {
        Shading::Lit | Shading::Colour | Shading::Edl => {
            return (over(light, covered, settings.background), normal);
        }
        Shading::Normal => normal,
        Shading::Depth => [depth; 3],
        // The surface counts once.
        Shading::Overlap | Shading::Weight => [1.0; 3],
    };
    // Quantities are not blended with a colour: α ≥ ½ decides.
    let alpha = match settings.background {
        None => covered as f32,
        Some(_) if covered >= 0.5 => 1.0,
        Some([r, g, b]) => return ([r, g, b, 1.0], normal),
    };
    ([shown[0], shown[1], shown[2], alpha], normal)
}

/// Blends light with the background, if there is one.
fn over(light: DVec3, alpha: f64, background: Option<[f32; 3]>) -> [f32; 4] {
    match background {
        None => light.extend(alpha).as_vec4().to_array(),
        Some(background) => {
            let behind = DVec3::from(background.map(f64::from));
            (alpha * light + (1.0 - alpha) * behind).extend(1.0).as_vec4().to_array()
        }
    }
}
