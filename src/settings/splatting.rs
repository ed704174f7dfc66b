//! Splatting: six choices that turn surfels into pixels. The papers' methods are [presets](crate::settings::methods); other valid
//! combinations run, too.

use crate::error::{Error, Result};

/// One choice per axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splatting {
    /// Pixels that a splat covers, and their kernel coordinates.
    pub footprint: Footprint,
    /// Falloff of a splat's weight.
    pub kernel: Kernel,
    /// Space of the low-pass filter.
    pub filter: Filter,
    /// Splats that contribute to a pixel.
    pub visibility: Visibility,
    /// Normalization of the weights to a partition of unity.
    pub normalization: Normalization,
    /// Stage of lighting.
    pub shade: Shade,
}

/// Screen-space shape of a splat.
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
#[repr(u32)]
pub enum Footprint {
    /// The ellipse that the disc's rim projects to, exactly (zwicker2004 §4).
    Conic = 0,
    /// The ellipse by an affine approximation at the centre: holes under strong perspective (ren2002 §3).
    ///
    /// The approximation is Heckbert's (1989), exact at the centre only.
    Affine = 1,
    /// A parallelogram in the tangent plane, with the kernel on it (ren2002 §5.2).
    Parallelogram = 2,
    /// The disc in the tangent plane, with the kernel on it (pajarola2004 §6.3).
    Disc = 3,
    /// An ellipse as of parallel projection, with a slope in depth (botsch2003 §3.2).
    ///
    /// Its depth is linear in screen space, its foreshortening bounded.
    Sprite = 4,
    /// A sprite with a width of whole pixels (botsch2003 §4).
    WholeSprite = 5,
    /// A square parallel to the image plane, at the depth of its centre (botsch2003 §3.1).
    Square = 6,
    /// A sprite without depth correction: all of it is at the depth of its centre (botsch2003 §3.3, figure 6).
    FlatSprite = 7,
    /// A circle of the same size on every screen, at the depth of its centre, whatever its disc is.
    ///
    /// Its diameter is [`Settings::point_size`](super::Settings::point_size). It needs neither a normal nor a radius: the points of other
    /// viewers.
    Point = 8,
}

/// Falloff of a splat's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// `exp(−½ m²)` at a distance of m σ from the centre, up to the cut-off.
    Gaussian,
    /// `ψ_E`: `exp(−a tⁿ / (1 − tⁿ))` with `t` from 0 at the centre to 1 at the rim (pajarola2004 equation 10). The paper's third parameter
    /// `b`, its unit of radius, is the rim here.
    Confetti {
        /// Larger values are narrower.
        a: f32,
        /// Larger values have a flatter top.
        n: f32,
    },
}

/// Space in which the low-pass filter is applied.
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
pub enum Filter {
    /// No filter: a splat is widened only as far as needed to cover a pixel centre.
    None,
    /// Screen space: the projected kernel is convolved with the filter (zwicker2004 equation 3).
    Screen,
    /// The tangent plane: the filter is projected there and widens the kernel (ren2002 equation 7).
    Object,
}

/// Splats that contribute to a pixel.
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
pub enum Visibility {
    /// Splats at most ε behind the nearest one, along the viewing ray.
    Ray,
    /// Splats at most ε behind the nearest one, along the camera's axis: hides too much at silhouettes (ren2002 figure 5a).
    Axis,
    /// The nearest splat only: one pass without blending.
    Nearest,
}

/// Normalization of the weights at a pixel to a partition of unity.
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
#[repr(u32)]
pub enum Normalization {
    /// Divides the sums by the sum of the weights at every pixel.
    Pixel = 0,
    /// Multiplies by a factor per surfel, captured beforehand by surfel convert --weights (ren2002 §7).
    Surfel = 1,
    /// None: brightness varies with the overlap (ren2002 figure 10a).
    None = 2,
}

/// Stage at which a [lit](crate::settings::Shading::Lit) frame is lit.
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
#[repr(u32)]
pub enum Shade {
    /// Lights splats at their centres, and blends light.
    Splat = 0,
    /// Blends normals and colours, and lights pixels by the normalized normal.
    Pixel = 1,
    /// As pixel, but diffuse light is that of the mean normal, which is shorter than 1 where the blended normals differ.
    ///
    /// The mean of the diffuse light of several normals is that of their mean, as long as all of them face the light: a pixel with a crease is
    /// as bright as its parts are on average. Highlights are those of the normalized normal.
    MeanNormal = 2,
    /// As mean-normal, of normals that vary over a disc by the curvature of its surface.
    ///
    /// A splat has a linear field of normals, not one normal, so that large discs show no facets (Botsch, Spernat and Kobbelt 2004, *Phong
    /// Splatting*). Where curvatures are unknown, and for sprites, Confetti's kernel and the nearest splat alone, it is mean-normal.
    NormalField = 3,
}

/// Factor of the variance that filters add to a splat: normal fields are 0 along axes of no larger variance.
pub(crate) const FLAT_VARIANCE: f64 = 7.0;

impl Default for Splatting {
    /// The choices of `perspective-ewa`.
    fn default() -> Self {
        Self {
            footprint: Footprint::Conic,
            kernel: Kernel::Gaussian,
            filter: Filter::Screen,
            visibility: Visibility::Ray,
            normalization: Normalization::Pixel,
            shade: Shade::NormalField,
        }
    }
}

impl Splatting {
    /// Whether splats are discs in tangent planes with a Gaussian kernel: these read curvatures.
    pub fn has_gaussian_discs(&self) -> bool {
        self.footprint.is_in_tangent_plane() && self.kernel == Kernel::Gaussian
    }
}

impl Footprint {
    /// Whether the kernel is in the tangent plane.
    pub fn is_on_plane(self) -> bool {
        matches!(self, Self::Parallelogram | Self::Disc)
    }

    /// Whether its depth is that of the tangent plane.
    pub fn is_in_tangent_plane(self) -> bool {
        !self.is_sprite() && !matches!(self, Self::Square | Self::Point)
    }

    /// Whether it is an elliptical sprite.
    pub fn is_sprite(self) -> bool {
        matches!(self, Self::Sprite | Self::WholeSprite | Self::FlatSprite)
    }
}

impl Splatting {
    /// Returns an error for combinations that are not supported.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn check(&self) -> Result<()> {
        let Self { footprint, kernel, filter, visibility, normalization, .. } = *self;
        if let Kernel::Confetti { a, n } = kernel
            && !(a.is_finite() && a > 0.0 && n.is_finite() && n > 0.0)
        {
            return refuse(&format!(
                "a Confetti kernel with a = {a} and n = {n}: give finite numbers above 0"
            ));
        }
        let confetti = kernel != Kernel::Gaussian;
        let blends = visibility != Visibility::Nearest;
        match (footprint, filter) {
            (Footprint::Parallelogram | Footprint::Disc, Filter::Screen) => refuse(
                "a kernel in the tangent plane has its low-pass filter there: choose the filter object or none",
            ),
            (
                Footprint::Conic
                | Footprint::Affine
                | Footprint::Sprite
                | Footprint::WholeSprite
                | Footprint::FlatSprite,
                Filter::Object,
            ) => refuse(
                "a filter in object space widens a kernel in the tangent plane: choose the footprint parallelogram or disc, or the \
                 filter screen",
            ),
            (Footprint::Square, _) if blends => {
                refuse("squares have neither kernel nor slope to blend by: choose the visibility nearest")
            }
            (Footprint::Square, Filter::Screen | Filter::Object) => {
                refuse("squares have no kernel to filter: choose the filter none")
            }
            (Footprint::Point, _) if blends => {
                refuse("points of a fixed size have no kernel to blend by: choose the visibility nearest")
            }
            (Footprint::Point, Filter::Screen | Filter::Object) => {
                refuse("points of a fixed size have no kernel to filter: choose the filter none")
            }
            (_, Filter::Screen | Filter::Object) if confetti => refuse(
                "a Confetti kernel has no closed form under a low-pass filter (pajarola2004 §8): choose the filter none",
            ),
            _ if !blends && normalization != Normalization::None => refuse(
                "with the nearest splat only there is nothing to normalize: choose the normalization none",
            ),
            _ => Ok(()),
        }
    }
}

impl Normalization {
    /// Returns an error if weights are needed and not `there`.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn check_weights(self, there: bool) -> Result<()> {
        match self {
            Self::Surfel if !there => refuse(
                "normalization by surfel needs surfels with normalization weights: capture them beforehand, or \
                 choose the normalization pixel",
            ),
            _ => Ok(()),
        }
    }
}

impl std::fmt::Display for Kernel {
    /// The form of options and reports.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Gaussian => f.write_str("gaussian"),
            Self::Confetti { a, n } => write!(f, "confetti:{a},{n}"),
        }
    }
}

fn refuse(cause: &str) -> Result<()> {
    Err(Error::Usage(cause.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_makes_no_sense_together_is_refused_with_its_reason() {
        let conic = Splatting::default();
        let confetti = Kernel::Confetti { a: 6.0, n: 3.0 };
        let single =
            Splatting { visibility: Visibility::Nearest, normalization: Normalization::None, ..conic };
        let cases = [
            (Splatting { footprint: Footprint::Disc, ..conic }, "filter there"),
            (Splatting { filter: Filter::Object, ..conic }, "footprint parallelogram or disc"),
            (Splatting { footprint: Footprint::Square, ..conic }, "visibility nearest"),
            (Splatting { footprint: Footprint::Point, ..conic }, "visibility nearest"),
            (Splatting { footprint: Footprint::Point, ..single }, "filter none"),
            (Splatting { kernel: confetti, ..conic }, "no closed form"),
            (Splatting { visibility: Visibility::Nearest, ..conic }, "normalization none"),
            (Splatting { kernel: Kernel::Confetti { a: 0.0, n: 3.0 }, ..conic }, "above 0"),
            (Splatting { kernel: Kernel::Confetti { a: 1.0, n: f32::NAN }, ..conic }, "above 0"),
        ];
        for (splatting, reason) in cases {
            let cause = splatting.check().unwrap_err().to_string();
            assert!(cause.contains(reason), "{cause}");
        }
        Splatting { filter: Filter::None, kernel: confetti, ..conic }.check().unwrap();
    }
}
