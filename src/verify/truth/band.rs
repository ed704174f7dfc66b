//! Bands of rows that are traced together.

use super::eye::Eye;
use super::kernel::Kernel;
use super::options::{FEWEST_STRATA, Filter, Options};
use super::pixel::{Pixel, exact};
use super::sums::BandSums;
use super::traceable::Traceable;
use crate::settings::Shading;
use std::ops::Range;

/// Rows of a band.
const ROWS: i64 = 16;

/// Strata along a side for neighbours of a pixel that misses the error bound with the fewest strata: small features
/// that its few rays missed there, such as the tip of what the neighbour saw, are found.
const BESIDE: usize = 4 * FEWEST_STRATA as usize;

/// Distribution of the rays of a picture.
pub struct Plan<'a, S: ?Sized> {
    eye: &'a Eye<'a, S>,
    size: [u32; 2],
    kernel: Kernel,
    exact: &'static [usize],
    /// Variance of a pixel's mean that meets the error bound.
    enough: f64,
    /// Strata along a side: least and greatest number.
    strata: [usize; 2],
}

/// A row of pixels with the fewest strata, and the variances of their means.
struct Pilot {
    pixels: Vec<Pixel>,
    variances: Vec<f64>,
}

impl<'a, S: Traceable + ?Sized> Plan<'a, S> {
    pub fn new(eye: &'a Eye<'a, S>, size: [u32; 2], shading: Shading, options: &Options) -> Self {
        let strata = match options.filter {
            Filter::Point => [1; 2],
            _ => [FEWEST_STRATA as usize, options.most_strata() as usize],
        };
        let kernel = Kernel::new(options.filter, strata[1]);
        let enough = options.error * options.error / kernel.gain();
        Self { eye, size, kernel, exact: exact(shading), enough, strata }
    }

    /// The rows to trace; some lie beyond the picture, within reach of its filter.
    pub fn bands(&self) -> Vec<Range<i64>> {
        let reach = self.kernel.reach as i64;
        let end = i64::from(self.size[1]) + reach;
        let start = |band: i64| band * ROWS - reach;
        (0..).map(start).take_while(|row| *row < end).map(|row| row..end.min(row + ROWS)).collect()
    }

    /// Traces some rows.
    pub fn trace(&self, rows: Range<i64>) -> BandSums<'_> {
        let mut part = BandSums::new(&self.kernel, self.size, rows.clone());
        let mut above = self.pilot(rows.start - 1).variances;
        let mut here = self.pilot(rows.start);
        for y in rows {
            let below = self.pilot(y + 1);
            let rough = rough([&above, &here.variances, &below.variances], self.enough);
            for (index, (pixel, rough)) in here.pixels.into_iter().zip(rough).enumerate() {
                self.finish(pixel, rough, [index as i64 - self.kernel.reach as i64, y], &mut part);
            }
            above = here.variances;
            here = below;
        }
        part
    }

    fn pilot(&self, y: i64) -> Pilot {
        let reach = self.kernel.reach as i64;
        let mut scratch = Vec::new();
        let pixels: Vec<_> = (-reach..i64::from(self.size[0]) + reach)
            .map(|x| match self.strata[1] {
                1 => Pixel::point(self.eye, [x, y]),
                _ => Pixel::new(self.eye, [x, y], self.strata[0]),
            })
            .collect();
        let variances = pixels.iter().map(|pixel| pixel.variances(self.exact, &mut scratch)).collect();
        Pilot { pixels, variances }
    }

    /// Refines a pixel until it meets the error bound; `rough` if it or a neighbour missed it in the pilot.
    fn finish(&self, mut pixel: Pixel, rough: bool, at: [i64; 2], part: &mut BandSums<'_>) {
        let mut variances = Vec::new();
        let mut variance = pixel.variances(self.exact, &mut variances);
        let least = if rough { BESIDE } else { self.strata[0] };
        while pixel.strata() < self.strata[1] && (variance > self.enough || pixel.strata() < least) {
            pixel.refine(self.eye);
            variance = pixel.variances(self.exact, &mut variances);
        }
        part.add(at, &pixel.samples, &variances);
        part.set_centre_hit(at, || pixel.centre_hit(self.eye));
    }
}

/// For each pixel of the middle row: whether it or a neighbour misses the error bound.
fn rough(rows: [&Vec<f64>; 3], enough: f64) -> Vec<bool> {
    let column: Vec<bool> = (0..rows[1].len()).map(|x| rows.iter().any(|row| row[x] > enough)).collect();
    let at = |x: usize| column[x.saturating_sub(1)..(x + 2).min(column.len())].iter().any(|rough| *rough);
    (0..column.len()).map(at).collect()
}
