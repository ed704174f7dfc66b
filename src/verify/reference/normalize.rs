//! Pass `normalize`: divides the sums by the weights and shades (zwicker2004 section 6, third pass).

use super::Projector;
use super::attribute::Sums;
use super::bands::Band;
use super::rank::Rank;
use super::shading::{Shine, lit, lit_by_mean};
use crate::settings::splatting::{Normalization, Shade};
use crate::settings::{Settings, Shading};
use glam::{DVec2, DVec3};

/// Length of `Σ w n` relative to `Σ w` below which the normals cancel; the direction to the eye replaces them.
const CANCELLED: f64 = 1e-6;

/// The values of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// Whether there is a surface.
    pub covered: bool,
    /// The quantity of the shading, linear, and α.
    pub colour: [f64; 4],
    /// Eye-space distance; 0 where there is no surface.
    pub depth: f64,
    /// World-space unit normal; 0 where there is no surface.
    pub normal: [f64; 3],
}

/// The values of the band's pixels. A pixel is covered if `visible` exists, its weight is above 0 and `alpha` is not 0.
pub(super) fn pass(
    projector: &Projector,
    band: &Band,
    visible: &[Rank],
    sums: &[Sums],
    alpha: &[f64],
) -> Vec<Value> {
    let pixel = |(i, (visible, sums)): (usize, (&Rank, &Sums))| {
        resolve(projector, band.centre(i), visible.exists().then_some(sums), alpha[i])
    };
    visible.iter().zip(sums).enumerate().map(pixel).collect()
}

/// The values of the band's pixels from single nearest splats.
pub(super) fn pass_nearest(
    projector: &Projector,
    band: &Band,
    seen: &[Option<Sums>],
    alpha: &[f64],
) -> Vec<Value> {
    let pixel =
        |(i, sums): (usize, &Option<Sums>)| resolve(projector, band.centre(i), sums.as_ref(), alpha[i]);
    seen.iter().enumerate().map(pixel).collect()
}

/// The value of the pixel with centre `at` and covered fraction `alpha`; `sums` is `None` where visibility wrote
/// nothing.
pub(super) fn resolve(projector: &Projector, at: DVec2, sums: Option<&Sums>, alpha: f64) -> Value {
    let Some(sums) = sums.filter(|s| s.weight > 0.0 && alpha > 0.0) else { return uncovered(projector) };
    let viewer = projector.to_viewer(at);
    let cancelled = sums.normal.length() < CANCELLED * sums.weight;
    let normal = if cancelled { viewer } else { sums.normal.normalize() };
    let depth = if projector.depth.perspective { sums.weight / sums.depth } else { sums.depth / sums.weight };
    let settings = &projector.settings;
    let total = match settings.splatting.normalization {
        Normalization::Pixel => sums.weight,
        Normalization::Surfel | Normalization::None => 1.0,
    };
    let colour = sums.colour / total;
    let shown = match settings.shading {
        // The splats are shaded already.
        Shading::Lit if settings.splatting.shade == Shade::Splat => colour,
        Shading::Lit => {
            let (lighting, shine) = (&settings.lighting, Shine::of_frame(&settings.lighting));
            match settings.splatting.shade {
                Shade::MeanNormal | Shade::NormalField => {
                    lit_by_mean(lighting, shine, colour, normal, sums.normal / sums.weight, viewer)
                }
                Shade::Splat | Shade::Pixel => lit(lighting, shine, colour, normal, viewer),
            }
        }
        Shading::Colour | Shading::Edl => colour,
        Shading::Normal => normal,
        Shading::Depth => DVec3::splat(depth),
        Shading::Overlap | Shading::Weight => DVec3::splat(sums.weight),
    };
    Value { covered: true, colour: picture_pixel(projector, shown, alpha), depth, normal: normal.to_array() }
}

/// A pixel of the picture, unless a later pass blends with the background.
pub(super) fn picture_pixel(projector: &Projector, shown: DVec3, alpha: f64) -> [f64; 4] {
    match projector.settings.has_late_background() {
        false => blended(&projector.settings, shown, alpha),
        true => shown.extend(alpha).to_array(),
    }
}

/// Blends a value with the background, if there is one.
pub(super) fn blended(settings: &Settings, shown: DVec3, alpha: f64) -> [f64; 4] {
    let Some(background) = settings.background else { return shown.extend(alpha).to_array() };
    let behind = DVec3::from_array(background.map(f64::from));
    (alpha * shown + (1.0 - alpha) * behind).extend(1.0).to_array()
}

/// The value of an empty pixel.
pub(super) fn uncovered(projector: &Projector) -> Value {
    let colour = match projector.settings.background {
        Some([r, g, b]) if !projector.settings.has_late_background() => [r.into(), g.into(), b.into(), 1.0],
        _ => [0.0; 4],
    };
    Value { covered: false, colour, depth: 0.0, normal: [0.0; 3] }
}
