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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[repr(u32)]
pub enum Footprint {
    /// The ellipse that the disc's rim projects to, exactly (zwicker2004 §4).
    Conic = 0,
    /// The ellipse of the projection's affine approximation at the centre (Heckbert 1989; ren2002 §3): leaves holes under strong
    /// perspective, as it is right at the centre alone.
    Affine = 1,
    /// The projection of a parallelogram in the tangent plane, with the kernel on it (ren2002 §5.2).
    Parallelogram = 2,
    /// The projection of the disc in the tangent plane, with the kernel on it (pajarola2004 §6.3).
    Disc = 3,
    /// An ellipse as of parallel projection, with a depth that is linear on the screen and a bounded foreshortening (botsch2003 §3.2).
    Sprite = 4,
    /// A sprite whose width is a whole number of px (botsch2003 §4).
    WholeSprite = 5,
    /// A square that faces the image plane, at the depth of its centre: size without shape (botsch2003 §3.1).
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Filter {
    /// Nowhere: a splat is widened only as far as it must be to own a pixel centre.
    None,
    /// On the screen: the projected kernel is convolved with it (zwicker2004 equation 3).
    Screen,
    /// In the tangent plane: the filter is warped there and widens the kernel before it is projected (ren2002 equation 7).
    Object,
}

/// Which splats a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Visibility {
    /// All within ε behind the nearest one, along the viewing ray.
    Ray,
    /// All within ε behind the nearest one, whose disc is moved along the camera's axis: hides too much near silhouettes (ren2002 figure 5a).
    Axis,
    /// The nearest one alone: one pass, and nothing is blended.
    Nearest,
}

/// What makes the weights at a pixel a partition of unity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[repr(u32)]
pub enum Normalization {
    /// Division by their sum at every pixel.
    Pixel = 0,
    /// A factor of each surfel, captured beforehand (ren2002 §7).
    Surfel = 1,
    /// Nothing: brightness varies with the overlap (ren2002 figure 10a).
    None = 2,
}

/// What is lit, where a frame is [lit](crate::settings::Shading::Lit).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Shade {
    /// Every splat, at its centre: what is blended is light.
    Splat,
    /// Every pixel: what is blended are normals and colours.
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

impl Footprint {
    /// As options and reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Conic => "conic",
            Self::Affine => "affine",
            Self::Parallelogram => "parallelogram",
            Self::Disc => "disc",
            Self::Sprite => "sprite",
            Self::WholeSprite => "whole-sprite",
            Self::Square => "square",
        }
    }
}

impl Filter {
    /// As options and reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Screen => "screen",
            Self::Object => "object",
        }
    }
}

impl Visibility {
    /// As options and reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ray => "ray",
            Self::Axis => "axis",
            Self::Nearest => "nearest",
        }
    }
}

impl Normalization {
    /// As options and reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixel => "pixel",
            Self::Surfel => "surfel",
            Self::None => "none",
        }
    }
}

impl Shade {
    /// As options and reports call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Splat => "splat",
            Self::Pixel => "pixel",
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
