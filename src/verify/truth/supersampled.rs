//! Supersampled frames of the float64 reference.

use super::kernel::Kernel;
use super::options::Filter;
use crate::error::{Error, Result};
use crate::geometry::{Camera, Parts};
use crate::picture::Picture;
use crate::progress::Progress;
use crate::settings::Settings;
use crate::verify::reference;
use rayon::prelude::*;

/// Rays along the side of a pixel.
const SIDE: usize = 8;
/// Most pixels of a picture: a frame of the reference takes some 150 bytes a ray.
pub const MOST_SUPERSAMPLED: u64 = 1 << 20;

/// The float64 reference of `parts` with 64 rays a pixel, colours and α. It is what the method converges to, not what the surface looks like:
/// an error against it is one of aliasing alone, and of missing points if `parts` has more.
///
/// The filter is that of an exact image. Rays beyond the picture's border are missing in its sums.
///
/// # Errors
/// [`Error::Usage`] for more than [`MOST_SUPERSAMPLED`] pixels; as [`reference::render`].
pub fn supersampled<'a>(
    parts: impl Into<Parts<'a>>,
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    filter: Filter,
    progress: &dyn Progress,
) -> Result<Picture> {
    if size.iter().map(|side| u64::from(*side)).product::<u64>() > MOST_SUPERSAMPLED {
        let [width, height] = size;
        return Err(Error::Usage(format!(
            "a supersampled reference of {width}x{height} px: give at most {MOST_SUPERSAMPLED} pixels"
        )));
    }
    let fine = size.map(|side| SIDE as u32 * side);
    // This filter takes the place of the frame's.
    let settings = &Settings { pixel_filter: 0.0, ..settings.clone() };
    let frame = reference::render(parts, camera, fine, settings, progress)?;
    let [width, height] = size.map(|side| side as usize);
    let kernel = Kernel::new(filter, SIDE);
    let rows: Vec<_> = frame
        .colour
        .par_chunks(fine[0] as usize)
        .map(|row| filtered(&kernel, row.iter().map(premultiplied), width))
        .collect();
    let mut colour = vec![[0.0; 4]; width * height];
    colour.par_chunks_mut(width).enumerate().for_each(|(y, line)| {
        for (x, pixel) in line.iter_mut().enumerate() {
            *pixel = straight(sum(&kernel, y, height, |stratum| rows[stratum][x]));
        }
    });
    Ok(Picture { size, colour, ..Picture::default() })
}

/// A row of strata, filtered along x: colour times α, α, and the sum of weights, per pixel.
fn filtered(kernel: &Kernel, strata: impl Iterator<Item = [f64; 5]>, width: usize) -> Vec<[f64; 5]> {
    let strata: Vec<_> = strata.collect();
    (0..width).map(|x| sum(kernel, x, width, |stratum| strata[stratum])).collect()
}

/// Filtered value of a pixel along an axis of `count` pixels, from the values of strata.
fn sum(kernel: &Kernel, pixel: usize, count: usize, value: impl Fn(usize) -> [f64; 5]) -> [f64; 5] {
    let reach = kernel.reach;
    let mut total = [0.0; 5];
    for near in pixel.saturating_sub(reach)..(pixel + reach + 1).min(count) {
        for (stratum, weights) in kernel.weights(SIDE).enumerate() {
            let weight = weights[pixel + reach - near];
            let value = value(SIDE * near + stratum);
            total.iter_mut().zip(value).for_each(|(total, value)| *total += weight * value);
        }
    }
    total
}

fn premultiplied([r, g, b, a]: &[f64; 4]) -> [f64; 5] {
    [a * r, a * g, a * b, *a, 1.0]
}

fn straight([r, g, b, a, all]: [f64; 5]) -> [f32; 4] {
    if a <= 0.0 { [0.0; 4] } else { [r / a, g / a, b / a, a / all].map(|value| value as f32) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Bounds, Colours, Surfels};
    use crate::settings::{Alpha, Shading};
    use crate::verify::truth::{self, Hit, Options, Traceable};
    use glam::{DVec3, Vec3};

    /// The unit disc in the plane z = 0.
    struct Disc;

    const COLOUR: [f32; 3] = [0.8, 0.4, 0.2];

    impl Traceable for Disc {
        fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
            let t = -origin.z / direction.z;
            let hit = Hit { t, normal: DVec3::Z, albedo: Some(COLOUR.map(f64::from)) };
            (t > 0.0 && (origin + t * direction).length() <= 1.0).then_some(hit)
        }

        fn bounds(&self) -> Bounds {
            Bounds::of_box(DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0))
        }
    }

    #[test]
    fn one_disc_is_the_exact_image() {
        let disc = Surfels {
            positions: vec![Vec3::ZERO],
            normals: vec![Vec3::Z],
            radii: vec![1.0],
            colours: Some(Colours::Linear(vec![COLOUR])),
            ..Surfels::default()
        };
        let eye = DVec3::new(0.3, 0.4, 4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.7, 1.0, 0.1).unwrap();
        let settings = Settings {
            shading: Shading::Colour,
            lowpass: 0.0,
            alpha: Alpha::Mask,
            background: None,
            ..Settings::default()
        };
        let (filter, size) = (Filter::Gaussian { variance: 1.0 }, [48, 48]);
        let found = supersampled(&disc, &camera, &settings, size, filter, &()).unwrap();
        let options = Options { filter, ..Options::default() };
        let exact = truth::render(&Disc, &camera, &settings, size, &options, &()).unwrap().picture;
        for (found, exact) in found.colour.iter().zip(&exact.colour) {
            // Footprints contain a pixel's centre: here an eighth of a pixel.
            assert!((found[3] - exact[3]).abs() < 0.06, "{found:?} {exact:?}");
            let same = found[..3].iter().zip(COLOUR).all(|(a, b)| (a - b).abs() < 1e-6);
            assert!(found[3] == 0.0 || same, "{found:?}");
        }
        let alpha = |picture: &Picture| picture.colour.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>();
        assert!((alpha(&found) / alpha(&exact) - 1.0).abs() < 0.02, "{} {}", alpha(&found), alpha(&exact));
    }

    #[test]
    fn large_pictures_are_refused() {
        let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.7, 1.0, 0.1).unwrap();
        let filter = Filter::Box;
        let refused =
            supersampled(&Surfels::default(), &camera, &Settings::default(), [2048; 2], filter, &());
        assert!(refused.is_err_and(|error| error.to_string().contains("1048576 pixels")));
    }
}
