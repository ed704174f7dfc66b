//! All metrics of a pair, with names and units.

use super::flip::{self, Map};
use super::{Pair, colour, coverage, depth, normals, psnr, rmse, ssim};
use crate::error::Result;

/// A metric; related ones are adjacent.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Metric {
    /// [RMSE](rmse) of linear colours.
    Rmse,
    /// [RMSE](rmse) of sRGB-encoded colours.
    RmseSrgb,
    /// [PSNR](psnr) of linear colours.
    Psnr,
    /// [PSNR](psnr) of sRGB-encoded colours.
    PsnrSrgb,
    /// [SSIM](ssim).
    Ssim,
    /// Mean of the [FLIP](flip) map.
    Flip,
    /// Largest value of the [FLIP](flip) map.
    FlipMax,
    /// [Intersection over union](coverage) of the silhouettes.
    Iou,
    /// [Holes](coverage): pixels that only the truth covers.
    Holes,
    /// Connected regions of holes.
    HoleRegions,
    /// Pixels of the largest one.
    LargestHole,
    /// [Bloat](coverage): pixels that only the picture covers.
    Bloat,
    /// Connected regions of bloat.
    BloatRegions,
    /// Pixels of the largest one.
    LargestBloat,
    /// Median of the [angles](normals) between normals.
    NormalMedian,
    /// Their mean.
    NormalMean,
    /// Their 95th percentile.
    NormalP95,
    /// The largest.
    NormalMax,
    /// Root mean square of the [differences](depth) of depths.
    DepthRms,
    /// Their 99th percentile.
    DepthP99,
    /// The largest.
    DepthMax,
}

/// Direction of improvement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// Less is better; 0 is best.
    Less,
    /// More is better.
    More,
}

/// Options of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Linear colour that both pictures are composited over.
    pub background: [f32; 3],
    /// Resolution for FLIP, px per degree of visual angle.
    pub pixels_per_degree: f32,
    /// Unit of depth errors, such as the object's size, in the positions' unit.
    pub object_size: f64,
}

/// Results of [`measure`].
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Every metric that could be computed, in the order of [`Metric`]; for the others see [`Metric::needs`].
    pub values: Vec<(Metric, f64)>,
    /// FLIP's difference map.
    pub flip: Map,
    /// Pixels that the picture covers.
    pub picture_covers: u64,
    /// Pixels that the truth covers.
    pub truth_covers: u64,
}

impl Default for Options {
    /// Over black, at FLIP's default resolution, with depth errors in the positions' unit.
    fn default() -> Self {
        Self { background: colour::BLACK, pixels_per_degree: flip::PIXELS_PER_DEGREE, object_size: 1.0 }
    }
}

impl Metric {
    /// Unit; empty if there is none.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Psnr | Self::PsnrSrgb => "dB",
            Self::Holes | Self::LargestHole | Self::Bloat | Self::LargestBloat => "px",
            Self::NormalMedian | Self::NormalMean | Self::NormalP95 | Self::NormalMax => "°",
            _ => "",
        }
    }

    /// Direction of improvement.
    pub fn better(self) -> Better {
        match self {
            Self::Psnr | Self::PsnrSrgb | Self::Ssim | Self::Iou => Better::More,
            _ => Better::Less,
        }
    }

    /// Requirements on the pictures; empty if there are none.
    pub fn needs(self) -> &'static str {
        match self {
            Self::Ssim => "pictures of at least 11x11 px",
            Self::NormalMedian | Self::NormalMean | Self::NormalP95 | Self::NormalMax => {
                "normals in both pictures, and a pixel that both cover"
            }
            Self::DepthRms | Self::DepthP99 | Self::DepthMax => {
                "depths in both pictures, and a pixel that both cover"
            }
            _ => "",
        }
    }
}

impl Measured {
    /// Value of a metric, if it could be computed.
    pub fn value(&self, metric: Metric) -> Option<f64> {
        self.values.iter().find(|(taken, _)| *taken == metric).map(|(_, value)| *value)
    }
}

/// Computes all metrics of a pair.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) if an option is invalid.
pub fn measure(pair: &Pair<'_>, options: &Options) -> Result<Measured> {
    let depth = depth::depth(pair, options.object_size)?;
    let (mut values, flip) = colours(pair, options)?;
    let coverage = coverage::coverage(pair);
    values.extend(silhouettes(&coverage));
    values.extend(normals::normals(pair).into_iter().flat_map(|normal| {
        [
            (Metric::NormalMedian, normal.median),
            (Metric::NormalMean, normal.mean),
            (Metric::NormalP95, normal.p95),
            (Metric::NormalMax, normal.max),
        ]
    }));
    values.extend(depth.into_iter().flat_map(|depth| {
        [(Metric::DepthRms, depth.rms), (Metric::DepthP99, depth.p99), (Metric::DepthMax, depth.max)]
    }));
    Ok(Measured { values, flip, picture_covers: coverage.picture, truth_covers: coverage.truth })
}

fn colours(pair: &Pair<'_>, options: &Options) -> Result<(Vec<(Metric, f64)>, Map)> {
    let linear = [pair.picture(), pair.truth()].map(|picture| colour::over(picture, options.background));
    let encoded = linear.each_ref().map(|linear| colour::encoded(linear));
    let luma = encoded.each_ref().map(|encoded| colour::luma(encoded));
    let of = |[picture, truth]: &[Vec<[f64; 3]>; 2]| rmse::rmse(picture, truth);
    let (rmse, rmse_srgb) = (of(&linear), of(&encoded));
    let map = flip::flip(&encoded[0], &encoded[1], pair.size(), options.pixels_per_degree)?;
    let mut values = vec![
        (Metric::Rmse, rmse),
        (Metric::RmseSrgb, rmse_srgb),
        (Metric::Psnr, psnr::psnr(rmse)),
        (Metric::PsnrSrgb, psnr::psnr(rmse_srgb)),
    ];
    values.extend(ssim::ssim(&luma[0], &luma[1], pair.size()).map(|ssim| (Metric::Ssim, ssim)));
    values.extend([(Metric::Flip, map.mean()), (Metric::FlipMax, map.max())]);
    Ok((values, map))
}

fn silhouettes(coverage: &coverage::Coverage) -> [(Metric, f64); 7] {
    let coverage::Coverage { iou, holes, bloat, .. } = coverage;
    [
        (Metric::Iou, *iou),
        (Metric::Holes, holes.pixels as f64),
        (Metric::HoleRegions, holes.count as f64),
        (Metric::LargestHole, holes.largest as f64),
        (Metric::Bloat, bloat.pixels as f64),
        (Metric::BloatRegions, bloat.count as f64),
        (Metric::LargestBloat, bloat.largest as f64),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;
    use crate::settings::Choice;

    /// A disc on an empty background, with normals and depths, `shift` px to the right of the middle.
    fn disc(shift: u32) -> Picture {
        let inside = |i: u32| (i % 32).abs_diff(16 + shift).pow(2) + (i / 32).abs_diff(16).pow(2) < 100;
        let all = |i: u32| if inside(i) { 1.0 } else { 0.0 };
        Picture {
            size: [32, 32],
            colour: (0..1024).map(|i| [0.5 * all(i), 0.25 * all(i), 0.75 * all(i), all(i)]).collect(),
            depth: Some((0..1024).map(|i| 5.0 * all(i)).collect()),
            normal: Some((0..1024).map(|i| [0.0, 0.0, all(i)]).collect()),
            id: None,
        }
    }

    fn of(picture: &Picture, truth: &Picture) -> Measured {
        measure(&Pair::new(picture, truth).unwrap(), &Options::default()).unwrap()
    }

    #[test]
    fn names_tell_metrics_apart() {
        for (i, metric) in Metric::ALL.iter().copied().enumerate() {
            assert_eq!(Metric::named(metric.name()), Some(metric));
            assert_eq!(Metric::ALL.iter().position(|other| *other == metric), Some(i));
        }
        assert_eq!(Metric::named("RMSE"), None);
    }

    #[test]
    fn the_same_is_best_by_every_metric_and_a_shift_is_not() {
        let (same, shifted) = (of(&disc(0), &disc(0)), of(&disc(1), &disc(0)));
        assert_eq!(same.values.iter().map(|(metric, _)| *metric).collect::<Vec<_>>(), Metric::ALL);
        for (metric, value) in same.values {
            let best = match metric {
                Metric::Psnr | Metric::PsnrSrgb => f64::INFINITY,
                _ if metric.better() == Better::More => 1.0,
                _ => 0.0,
            };
            assert!(value == best || (value - best).abs() < 1e-12, "{}: {value}", metric.name());
            let shifted = shifted.value(metric).unwrap();
            match metric.better() {
                // The disc is flat: normals and depths do not change.
                _ if metric.name().starts_with("normal") || metric.name().starts_with("depth") => {
                    assert_eq!(shifted, 0.0);
                }
                Better::Less => assert!(shifted > best, "{}: {shifted}", metric.name()),
                Better::More => assert!(shifted < best, "{}: {shifted}", metric.name()),
            }
        }
    }

    #[test]
    fn what_cannot_be_taken_is_left_out() {
        let small = Picture { size: [2, 2], colour: vec![[1.0; 4]; 4], ..Default::default() };
        let taken = of(&small, &small);
        for &metric in Metric::ALL {
            assert_eq!(taken.value(metric).is_none(), !metric.needs().is_empty(), "{}", metric.name());
        }
        let pair = Pair::new(&small, &small).unwrap();
        assert!(measure(&pair, &Options { object_size: 0.0, ..Default::default() }).is_err());
        assert!(measure(&pair, &Options { pixels_per_degree: 0.0, ..Default::default() }).is_err());
    }

    #[test]
    fn a_missing_surface_shows_on_any_other_background() {
        let mut missing = disc(0);
        missing.colour = vec![[0.0; 4]; 1024];
        let on = |background| {
            let pair = (&missing, &disc(0));
            let options = Options { background, ..Default::default() };
            measure(&Pair::new(pair.0, pair.1).unwrap(), &options).unwrap().value(Metric::Rmse).unwrap()
        };
        assert_eq!(on([0.5, 0.25, 0.75]), 0.0);
        assert!(on(colour::BLACK) > 0.1 && on([1.0; 3]) > 0.1);
    }
}
