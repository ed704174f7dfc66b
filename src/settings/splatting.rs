//! How surfels become pixels: a choice along six axes. The papers' methods are [presets](crate::settings::methods); what else makes sense runs too.

use crate::error::{Error, Result};

/// One choice along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splatting {
    /// Which pixels a splat covers, and where in the kernel each of them is.
    pub footprint: Footprint,
    /// How a splat's weight falls off from its centre.
    pub kernel: Kernel,
    /// Where the kernel meets the low-pass filter.
    pub filter: Filter,
    /// Which splats a pixel sees.
    pub visibility: Visibility,
    /// What makes weights a partition of unity.
    pub normalization: Normalization,
    /// What is lit.
    pub shade: Shade,
}

/// The image of a surfel's disc.
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
    /// The approximation is Heckbert's (1989), right at the centre alone.
    Affine = 1,
    /// A parallelogram in the tangent plane, with the kernel on it (ren2002 §5.2).
    Parallelogram = 2,
    /// The disc in the tangent plane, with the kernel on it (pajarola2004 §6.3).
    Disc = 3,
    /// An ellipse as of parallel projection, with a slope in depth (botsch2003 §3.2).
    ///
    /// Its depth is linear on the screen, its foreshortening bounded.
    Sprite = 4,
    /// A sprite whose width is a whole number of px (botsch2003 §4).
    WholeSprite = 5,
    /// A square that faces the image plane, at the depth of its centre (botsch2003 §3.1).
    Square = 6,
}

/// The falloff of a splat's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// `exp(−½ m²)` at m σ from the centre, up to the cut-off.
    Gaussian,
    /// `ψ_E`: `exp(−a tⁿ / (1 − tⁿ))` with `t` from 0 at the centre to 1 at the rim (pajarola2004 equation 10). The paper's third
    /// parameter `b` is the unit of its radius: here, the rim.
    Confetti {
        /// The larger, the narrower.
        a: f32,
        /// The larger, the more like a plateau.
        n: f32,
    },
}

/// Where the low-pass filter is applied.
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
    /// No filter: a splat is widened only as far as it must be to own a pixel centre.
    None,
    /// The projected kernel is convolved with it on the screen (zwicker2004 equation 3).
    Screen,
    /// The filter is warped to the tangent plane and widens the kernel there (ren2002 equation 7).
    Object,
}

/// Which splats a pixel sees.
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
    /// All within ε behind the nearest one, along the viewing ray.
    Ray,
    /// All within ε behind the nearest one, along the camera's axis: hides too much near silhouettes (ren2002 figure 5a).
    Axis,
    /// The nearest one alone: one pass, and nothing is blended.
    Nearest,
}

/// What makes the weights at a pixel a partition of unity.
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
    /// The sums are divided by that of the weights at every pixel.
    Pixel = 0,
    /// Each surfel has a factor, captured beforehand by surfel convert --weights (ren2002 §7).
    Surfel = 1,
    /// Nothing is done: brightness varies with the overlap (ren2002 figure 10a).
    None = 2,
}

/// What is lit, where a frame is [lit](crate::settings::Shading::Lit).
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
pub enum Shade {
    /// Splats are lit at their centres, and light is blended.
    Splat,
    /// Normals and colours are blended, and pixels are lit.
    Pixel,
}

impl Default for Splatting {
    /// `perspective-ewa`'s.
    fn default() -> Self {
        Self {
            footprint: Footprint::Conic,
            kernel: Kernel::Gaussian,
            filter: Filter::Screen,
            visibility: Visibility::Ray,
            normalization: Normalization::Pixel,
            shade: Shade::Pixel,
        }
    }
}

impl Footprint {
    /// Whether the kernel lies in the tangent plane.
    pub fn is_on_plane(self) -> bool {
        matches!(self, Self::Parallelogram | Self::Disc)
    }

    /// Whether it is a sprite with a shape.
    pub fn is_sprite(self) -> bool {
        matches!(self, Self::Sprite | Self::WholeSprite)
    }
}

impl Splatting {
    /// Refuses what makes no sense together, with the reason.
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
                Footprint::Conic | Footprint::Affine | Footprint::Sprite | Footprint::WholeSprite,
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
            (_, Filter::Screen | Filter::Object) if confetti => refuse(
                "a Confetti kernel has no closed form under a low-pass filter (pajarola2004 §8): choose the filter none",
            ),
            _ if !blends && normalization != Normalization::None => refuse(
                "a pixel that sees the nearest splat alone has nothing to normalize: choose the normalization none",
            ),
            _ => Ok(()),
        }
    }
}

impl Normalization {
    /// Refuses surfels without the weights that it needs.
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
    /// As options and reports call it.
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
        let cases = [
            (Splatting { footprint: Footprint::Disc, ..conic }, "filter there"),
            (Splatting { filter: Filter::Object, ..conic }, "footprint parallelogram or disc"),
            (Splatting { footprint: Footprint::Square, ..conic }, "visibility nearest"),
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
