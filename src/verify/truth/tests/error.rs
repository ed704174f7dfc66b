//! The error of an image, and its reproducibility.

use super::GAUSSIAN;
use crate::error::Error;
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::progress::Progress;
use crate::settings::{Settings, Shading};
use crate::verify::scenes;
use crate::verify::truth::{Filter, Options, Truth, render};
use std::sync::atomic::{AtomicU64, Ordering};

const SIZE: [u32; 2] = [24, 24];

fn view(name: &str, shading: Shading, options: &Options) -> Truth {
    let surface = scenes::surface(name).unwrap();
    let camera: Camera = scenes::camera(name).unwrap().camera(1.0, &surface.bounds()).unwrap();
    let settings = Settings { shading, ..Default::default() };
    render(&*surface, &camera, &settings, SIZE, options, &()).unwrap()
}

/// Largest difference of each pixel's α and of its light times α.
fn differences(a: &Picture, b: &Picture) -> Vec<f64> {
    let light = |[r, g, b, alpha]: [f32; 4]| [r * alpha, g * alpha, b * alpha, alpha];
    let pixel = |(a, b): (&[f32; 4], &[f32; 4])| {
        let channels = light(*a).into_iter().zip(light(*b));
        channels.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
    };
    a.colour.iter().zip(&b.colour).map(pixel).collect()
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn the_stated_error_is_honest() {
    for filter in [GAUSSIAN, Filter::Box] {
        for name in ["scene:tree", "scene:bumpy-sphere", "scene:plane", "scene:part"] {
            let options = Options { filter, error: 1.0 / 256.0, most_samples: 4096 };
            let truth = view(name, Shading::Lit, &options);
            // 64 rays for each of the fewest, in every pixel.
            let fine = view(name, Shading::Lit, &Options { filter, error: 1e-9, most_samples: 4096 });
            let off = differences(&truth.picture, &fine.picture);
            let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
            let most = off.iter().copied().fold(0.0, f64::max);
            println!("{filter:?} {name}: {rms:.1e} RMS, {most:.1e} at most; stated {:?}", truth.error);
            let own_error = fine.error.rms;
            assert!(
                rms < 1.2 * truth.error.rms + own_error,
                "{name} {filter:?}: {rms:.2e}, stated {:?}",
                truth.error
            );
            assert!(rms > 0.1 * truth.error.rms, "{name} {filter:?}: {rms:.2e}, stated {:?}", truth.error);
            assert!(most < 4.5 / 256.0, "{name} {filter:?}: {most:.2e}");
            assert!(truth.error.max <= 1.05 / 256.0, "{name} {filter:?}: {:?}", truth.error);
        }
    }
}

#[test]
fn pixels_that_run_out_of_rays_are_counted() {
    let options = Options { filter: Filter::Box, error: 1e-4, most_samples: 63 };
    let truth = view("scene:plane", Shading::Colour, &options);
    assert!(truth.error.max > 1e-3 && truth.error.above > 20, "{:?}", truth.error);
}

#[test]
fn threads_do_not_matter() {
    let image = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| view("scene:tree", Shading::Lit, &Options::default()))
    };
    let one = image(1);
    assert_eq!(one, image(3));
    assert!(one.picture.colour.iter().any(|pixel| pixel[3] > 0.0));
}

/// Cancels once a band is traced.
#[derive(Default)]
struct OneBand(AtomicU64);

impl Progress for OneBand {
    fn at(&self, _: &'static str, done: u64, _: u64) {
        self.0.fetch_max(done, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }
}

#[test]
fn a_cancelled_image_traces_no_further_band() {
    let surface = scenes::surface("scene:sphere").unwrap();
    let camera = scenes::camera("scene:sphere").unwrap().camera(1.0, &surface.bounds()).unwrap();
    let (settings, options, progress) = (Settings::default(), Options::default(), OneBand::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let cancelled = pool.install(|| render(&*surface, &camera, &settings, [24, 64], &options, &progress));
    assert!(matches!(cancelled, Err(Error::Cancelled)));
    assert_eq!(progress.0.into_inner(), 1);
}

#[test]
fn impossible_requests_are_refused() {
    let surface = scenes::surface("scene:sphere").unwrap();
    let camera = scenes::camera("scene:sphere").unwrap().camera(1.0, &surface.bounds()).unwrap();
    let refused = |size, options: Options| {
        let refused = render(&*surface, &camera, &Settings::default(), size, &options, &());
        refused.unwrap_err().to_string()
    };
    let usual = Options::default();
    for variance in [0.0, -1.0, f64::NAN, 1e9] {
        assert!(
            refused(SIZE, Options { filter: Filter::Gaussian { variance }, ..usual }).contains("variance")
        );
    }
    for error in [0.0, f64::NAN, f64::INFINITY] {
        assert!(refused(SIZE, Options { error, ..usual }).contains("the error is"));
    }
    assert!(refused(SIZE, Options { most_samples: 3, ..usual }).contains("16 to 65536"));
    assert!(refused([1 << 20; 2], usual).contains("at most 67108864 pixels"));
    assert!(refused([0, 4], usual).contains("0 × 4 px"));
}
