//! Metrics of single effects. All but the overlap and the covered pixels compare a picture with the truth, over black, by the luma of linear
//! light.

use crate::bench::error_terms::WHOLE;
use crate::bench::record::Blended;
use crate::picture::Picture;
use crate::verify::metrics::{Pair, colour, covers};

/// Pixels well inside the surface that the picture does not cover: the truth covers them and the support of its filter.
pub const GAPS: &str = "gaps";
/// Unevenness of brightness: the standard deviation of the picture's luma over the truth's, relative to its mean, over
/// pixels that both cover wholly. 0 for a constant factor.
pub const UNEVENNESS: &str = "unevenness";
/// Contrast between neighbouring pixels relative to the truth: `Σ ∇p·∇t / Σ ∇t·∇t` over pixels that both cover wholly.
/// 1 is as sharp as the truth, less is blurred.
pub const SHARPNESS: &str = "sharpness";
/// Facets: the root mean square of the error's Laplacian, over pixels that both cover wholly with their neighbours.
/// Smooth errors have none; borders between splats have.
pub const FACETS: &str = "facets";

/// Distance, px, between the middles of the brightest parts: the mean positions of the pixels above 0.9 of each picture's largest luma.
pub const PEAK: &str = "peak";

/// Pixels that the picture covers, at least in part.
pub const COVERED: &str = "covered";

/// Pixels well inside the surface whose depth exceeds the truth's by more than 1 %.
pub const LEAKS: &str = "leaks";

/// All metrics that the pictures allow.
pub fn of(pair: &Pair<'_>) -> Vec<(&'static str, f64)> {
    let image = Image::new(pair);
    let gaps = (0..pair.pixels()).filter(|&i| image.inside_truth[i] && !covers(pair.picture(), i)).count();
    let peak = image.peak();
    let others = [
        (PEAK, peak),
        (UNEVENNESS, image.unevenness()),
        (SHARPNESS, image.sharpness()),
        (FACETS, image.facets()),
    ];
    let known = others.into_iter().filter_map(|(name, value)| Some((name, value?)));
    let leaks = leaks(pair, &image).map(|leaks| (LEAKS, leaks as f64));
    let covered = (0..pair.pixels()).filter(|&i| covers(pair.picture(), i)).count();
    [(GAPS, gaps as f64), (COVERED, covered as f64)].into_iter().chain(leaks).chain(known).collect()
}

/// None without depths.
fn leaks(pair: &Pair<'_>, image: &Image) -> Option<usize> {
    let (picture, truth) = (pair.picture().depth.as_ref()?, pair.truth().depth.as_ref()?);
    let behind = |i: &usize| image.inside_truth[*i] && picture[*i] > 1.01 * truth[*i];
    Some((0..pair.pixels()).filter(behind).count())
}

/// Blended splats in a picture of [overlaps](crate::settings::Shading::Overlap); none if nothing is covered.
pub fn blended(picture: &Picture) -> Option<Blended> {
    let counts = || picture.colour.iter().filter(|pixel| pixel[3] > 0.0).map(|pixel| f64::from(pixel[0]));
    let covered = counts().count();
    let mean = counts().sum::<f64>() / covered as f64;
    (covered > 0).then(|| Blended { mean, largest: counts().fold(0.0, f64::max) })
}

/// Luma of both pictures, and masks of wholly covered pixels.
struct Image {
    width: usize,
    picture: Vec<f64>,
    truth: Vec<f64>,
    inside_truth: Vec<bool>,
    inside_both: Vec<bool>,
}

impl Image {
    fn new(pair: &Pair<'_>) -> Self {
        let both = [pair.picture(), pair.truth()];
        let [picture, truth] = both.map(|picture| colour::luma(&colour::over(picture, colour::BLACK)));
        let [ours, inside_truth] =
            both.map(|picture| picture.colour.iter().map(|pixel| pixel[3] >= WHOLE).collect::<Vec<_>>());
        let inside_both = ours.iter().zip(&inside_truth).map(|(a, b)| *a && *b).collect();
        Self { width: pair.size()[0] as usize, picture, truth, inside_truth, inside_both }
    }

    /// Pixels that both pictures cover wholly, with their four neighbours.
    fn inner(&self) -> impl Iterator<Item = usize> + '_ {
        let (width, inside) = (self.width, &self.inside_both);
        let height = inside.len() / width;
        let rows = (1..height.max(1) - 1).map(move |y| y * width);
        let all = rows.flat_map(move |row| (1..width.max(1) - 1).map(move |x| row + x));
        all.filter(move |&i| [i, i - 1, i + 1, i - width, i + width].into_iter().all(|k| inside[k]))
    }

    fn peak(&self) -> Option<f64> {
        let middle = |luma: &[f64]| {
            let largest = luma.iter().copied().fold(0.0, f64::max);
            let bright = || (0..luma.len()).filter(|&i| luma[i] > 0.9 * largest);
            let sum = bright()
                .fold([0.0; 2], |[x, y], i| [x + (i % self.width) as f64, y + (i / self.width) as f64]);
            let count = bright().count() as f64;
            (count > 0.0).then(|| sum.map(|sum| sum / count))
        };
        let ([x, y], [u, v]) = (middle(&self.picture)?, middle(&self.truth)?);
        Some((x - u).hypot(y - v))
    }

    fn unevenness(&self) -> Option<f64> {
        let lit = (0..self.truth.len()).filter(|&i| self.inside_both[i] && self.truth[i] > 0.0);
        let ratios: Vec<f64> = lit.map(|i| self.picture[i] / self.truth[i]).collect();
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        let square = ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / ratios.len() as f64;
        (mean > 0.0).then(|| square.sqrt() / mean)
    }

    fn sharpness(&self) -> Option<f64> {
        let gradient =
            |of: &[f64], i: usize| [of[i + 1] - of[i - 1], of[i + self.width] - of[i - self.width]];
        let sums = self.inner().fold([0.0; 2], |[along, own], i| {
            let ([px, py], [tx, ty]) = (gradient(&self.picture, i), gradient(&self.truth, i));
            [along + px * tx + py * ty, own + tx * tx + ty * ty]
        });
        (sums[1] > 0.0).then(|| sums[0] / sums[1])
    }

    fn facets(&self) -> Option<f64> {
        let error = |i: usize| self.picture[i] - self.truth[i];
        let laplacian = |i: usize| {
            error(i - 1) + error(i + 1) + error(i - self.width) + error(i + self.width) - 4.0 * error(i)
        };
        let (count, sum) = self.inner().fold((0, 0.0), |(n, sum), i| (n + 1, sum + laplacian(i).powi(2)));
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 8×8 px with a luma and a coverage each.
    fn picture(of: impl Fn(usize, usize) -> (f32, f32)) -> Picture {
        let pixels = (0..64).map(|i| of(i % 8, i / 8)).map(|(grey, alpha)| [grey, grey, grey, alpha]);
        Picture { size: [8, 8], colour: pixels.collect(), ..Default::default() }
    }

    fn value(name: &str, picture: &Picture, truth: &Picture) -> f64 {
        let found = of(&Pair::new(picture, truth).unwrap());
        found.into_iter().find(|(other, _)| *other == name).unwrap().1
    }

    #[test]
    fn gaps_are_what_is_missing_where_the_truth_is_whole() {
        let truth = picture(|x, _| (0.5, if x == 7 { 0.9 } else { 1.0 }));
        assert_eq!(value(GAPS, &truth, &truth), 0.0);
        let holed = picture(|x, y| (0.5, if y == 3 && x > 4 { 0.0 } else { 1.0 }));
        assert_eq!(value(GAPS, &holed, &truth), 2.0);
    }

    #[test]
    fn the_peak_is_where_it_is_brightest() {
        let bright = |at: usize| picture(move |x, y| (if (x, y) == (at, 3) { 1.0 } else { 0.5 }, 1.0));
        assert_eq!(value(PEAK, &bright(6), &bright(2)), 4.0);
        assert_eq!(value(COVERED, &bright(6), &bright(2)), 64.0);
    }

    #[test]
    fn brightness_is_even_if_it_is_wrong_by_one_factor() {
        let truth = picture(|x, _| (0.1 + 0.05 * x as f32, 1.0));
        let scaled = |of: fn(usize) -> f32| picture(|x, _| (of(x) * (0.1 + 0.05 * x as f32), 1.0));
        assert!(value(UNEVENNESS, &scaled(|_| 2.0), &truth) < 1e-6);
        // Half of the factors are 1.5, half 0.5: a deviation of half their mean.
        let uneven = value(UNEVENNESS, &scaled(|x| [0.5, 1.5][x % 2]), &truth);
        assert!((uneven - 0.5).abs() < 1e-6, "{uneven}");
    }

    #[test]
    fn blur_takes_sharpness_and_edges_make_facets() {
        let truth = picture(|x, _| (0.1 * x as f32, 1.0));
        assert!((value(SHARPNESS, &truth, &truth) - 1.0).abs() < 1e-6);
        let blurred = picture(|x, _| (0.3 + 0.025 * x as f32, 1.0));
        assert!((value(SHARPNESS, &blurred, &truth) - 0.25).abs() < 1e-6);
        // The error of the blurred picture is linear; steps of two pixels are off by 0.1 at every other pixel:
        // Laplacians of ±0.1.
        assert!(value(FACETS, &blurred, &truth) < 1e-6);
        let steps = picture(|x, _| (0.2 * (x / 2) as f32, 1.0));
        let facets = value(FACETS, &steps, &truth);
        assert!((facets - 0.2).abs() < 1e-6, "{facets}");
    }

    #[test]
    fn the_overlap_is_that_of_covered_pixels() {
        let counts = picture(|x, y| if y == 0 { (x as f32 + 1.0, 1.0) } else { (0.0, 0.0) });
        assert_eq!(blended(&counts), Some(Blended { mean: 4.5, largest: 8.0 }));
        assert_eq!(blended(&picture(|_, _| (0.0, 0.0))), None);
    }
}
