//! What a frame is asked to be: shared by the Vulkan methods and the float64 reference.

mod choice;
pub mod methods;
mod outputs;
pub mod pull_push;
pub mod splatting;

use crate::error::{Error, Result};
use crate::settings::pull_push::PullPush;
use crate::settings::splatting::{Filter, Splatting};
pub use choice::Choice;
pub use outputs::{Outputs, Precision, Rasterizer};
use std::ops::RangeInclusive;

/// Settings of a frame that are not the camera's or the scene's.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How surfels become pixels.
    pub splatting: Splatting,
    /// Makes the picture of points one pixel large instead; what is said of splats, kernels and filters is of no use then.
    pub pull_push: Option<PullPush>,
    /// Kernel cut-off `F`, in σ: the splat ends at `u² + v² = F²`. In [`Settings::CUTOFFS`].
    pub cutoff: f32,
    /// Variance of the low-pass filter `H = lowpass · I`, px², at most [`Settings::MOST_LOWPASS`]. Never less than what makes each splat own a pixel centre
    /// ([`Settings::least_lowpass`]).
    pub lowpass: f32,
    /// What the low-pass filter widens.
    pub widen: Widen,
    /// Depth tolerance ε in surfel radii: splats no further than this behind the nearest one, along the viewing ray, are blended.
    pub epsilon: f32,
    /// Which side of a surfel is seen.
    pub cull: Cull,
    /// What α is.
    pub alpha: Alpha,
    /// What the picture shows.
    pub shading: Shading,
    /// Colour where no surfel is, linear RGB; `None` leaves it transparent (all channels 0). What is partly covered is blended with it.
    pub background: Option<[f32; 3]>,
    /// Lights and material of [`Shading::Lit`].
    pub lighting: Lighting,
}

impl Default for Settings {
    /// What `surfel bench --suite full` supports: the cut-off beyond which the RMSE no longer falls though time rises, and a filter that costs
    /// nothing where splats are larger.
    fn default() -> Self {
        Self {
            pull_push: None,
            splatting: Splatting::default(),
            cutoff: 2.5,
            lowpass: 1.0,
            widen: Widen::Small,
            epsilon: 1.0,
            cull: Cull::None,
            alpha: Alpha::Mask,
            shading: Shading::Lit,
            background: None,
            lighting: Lighting::default(),
        }
    }
}

impl Settings {
    /// Cut-offs, σ. A Gaussian is below 10⁻¹³ beyond 8 σ, and what is lit are sums of normals, whose squares must not underflow in float32:
    /// those of weights below 10⁻¹⁹ do.
    pub const CUTOFFS: RangeInclusive<f32> = 0.1..=8.0;
    /// Largest low-pass variance, px²: a splat is no wider for its filter than 10 px a σ, however many there are.
    pub const MOST_LOWPASS: f32 = 100.0;

    /// The least low-pass variance that leaves no splat without a pixel centre, px²: `(0.71 / F)²`, so that the cut-off radius is at
    /// least √½ px. It is the low-pass of the visibility footprint.
    pub fn least_lowpass(&self) -> f32 {
        (0.71 / self.cutoff).powi(2)
    }

    /// The low-pass variance of the attribute footprint, px²: what is added to a splat's variance, or with [`Widen::Small`] what
    /// it is raised to.
    pub fn attribute_lowpass(&self) -> f32 {
        match self.splatting.filter {
            Filter::None => self.least_lowpass(),
            Filter::Screen | Filter::Object => self.lowpass.max(self.least_lowpass()),
        }
    }

    /// Refuses splats of a scene that has lines or triangles, as `there` says.
    pub fn check_primitives(&self, there: bool) -> Result<()> {
        if there && self.pull_push.is_none() {
            Err(Error::Usage(
                "lines and triangles are drawn by pull-push and pull-push-paper alone: choose one of them, or leave them out".into(),
            ))
        } else {
            Ok(())
        }
    }

    /// Refuses numbers of points where pixels are sums of several.
    pub fn check_outputs(&self, outputs: Outputs) -> Result<()> {
        if outputs.id && self.pull_push.is_none() {
            Err(Error::Usage(
                "numbers of points are those of pull-push and pull-push-paper alone, as splats are summed: choose one of them, or \
                 leave the numbers out"
                    .into(),
            ))
        } else {
            Ok(())
        }
    }

    /// Refuses what no frame can be made of.
    pub fn check(&self) -> Result<()> {
        if self.pull_push.is_some() && self.splatting != Splatting::default() {
            return Err(Error::Usage(
                "pull-push makes no splats: it has no footprint, kernel, filter, visibility, normalization or shade to choose".into(),
            ));
        }
        self.splatting.check()?;
        let positive = |name: &str, value: f32| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(Error::Usage(format!("{name} is {value}: give a finite number above 0")))
            }
        };
        if !Self::CUTOFFS.contains(&self.cutoff) {
            let (least, most) = (Self::CUTOFFS.start(), Self::CUTOFFS.end());
            return Err(Error::Usage(format!(
                "the cut-off is {}: give a number of standard deviations from {least} to {most}",
                self.cutoff
            )));
        }
        positive("epsilon", self.epsilon)?;
        if !(0.0..=Self::MOST_LOWPASS).contains(&self.lowpass) {
            return Err(Error::Usage(format!(
                "the low-pass variance is {}: give a number of px² from 0 to {}",
                self.lowpass,
                Self::MOST_LOWPASS
            )));
        }
        self.lighting.check()?;
        if self.background.is_some_and(|colour| !colour.iter().all(|channel| channel.is_finite())) {
            return Err(Error::Usage(format!(
                "the background is {:?}: give finite numbers",
                self.background
            )));
        }
        Ok(())
    }
}

/// What the low-pass filter `H` widens: how it turns the variance `V` of a projected kernel, with eigenvalues `λ`, into that of the
/// attribute footprint.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Widen {
    /// Every splat.
    ///
    /// `V + H`, the convolution of both (zwicker2004, equation 3).
    #[default]
    All,
    /// Splats, or their axes, that are smaller than the filter.
    ///
    /// Along either of `V`'s axes `λ` becomes `max(λ + least, H)`, with [`Settings::least_lowpass`]. Larger splats stay sharp and cost fewer pixels. Continuous in `V`, so that nothing jumps as a
    /// splat grows, and nowhere less than the visibility footprint, so that every pixel which that covers gets attributes. (Clamping
    /// the axes is how texture filters bound theirs: Greene, Heckbert, *Creating Raster Omnimax Images from Multiple Perspective
    /// Views Using the Elliptical Weighted Average Filter*, IEEE Computer Graphics and Applications 1986.)
    Small,
}

/// Which side of a surfel is seen.
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
pub enum Cull {
    /// Both sides are drawn.
    ///
    /// The normal is flipped towards the eye before it is accumulated.
    None,
    /// Surfels whose normals face away are left out.
    Back,
}

/// What α says of a pixel.
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
pub enum Alpha {
    /// 1 where a splat owns the pixel's centre, else 0.
    Mask,
    /// The part of the pixel that surface covers: smooth outlines.
    ///
    /// Of 16 samples, those within any splat, hidden or not. A splat counts up to 0.77 of its cut-off
    /// and unfiltered: discs of radii 1.3 times as large as needed leave no holes then, and reach no further beyond an outline. Each also
    /// covers the sample nearest to its centre if it holds none in that pixel, so that what is drawn shows however small it is. A clip line
    /// parts the pixels that it cuts by their samples too; what it cuts off is drawn up to half a pixel beyond it where nothing else is.
    /// Pull-push has a mask's pixels, and those next to an empty one have the samples within any disc that was made about them.
    Coverage,
}

/// What the picture shows.
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
pub enum Shading {
    /// Lit by a lamp at the eye.
    ///
    /// Blinn–Phong in linear light, with the lamps of [`Lighting`].
    Lit,
    /// The points' own colours.
    #[strum(to_string = "color", serialize = "colour")]
    Colour,
    /// Normals in world space: x, y, z from −1 to 1 as red, green, blue.
    Normal,
    /// Distance from the eye along the view, in the positions' unit.
    Depth,
    /// How many splats are blended (pajarola2004 figure 18).
    Overlap,
    /// What the splats' weights add up to.
    ///
    /// Normalization weights are included: how far they are from a partition of unity.
    Weight,
}

/// Lights and material, all linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// Colour of a surface whose scene has none.
    pub albedo: [f32; 3],
    /// Light that comes from everywhere, as a factor of the albedo.
    pub ambient: f32,
    /// Lambert's term of the headlight, which stands at the eye.
    pub headlight: f32,
    /// Blinn–Phong's specular factor, the same for every light.
    pub specular: f32,
    /// Blinn–Phong's exponent.
    pub shininess: f32,
    /// Further lights, at most [`Lighting::MAX_DIRECTIONAL`].
    pub directional: Vec<DirectionalLight>,
}

/// A light at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Unit vector from the surface to the light, world space.
    pub to_light: [f32; 3],
    /// Linear RGB radiance.
    pub radiance: [f32; 3],
}

impl Lighting {
    /// Most directional lights beside the headlight.
    pub const MAX_DIRECTIONAL: usize = 4;

    /// Refuses what no surface can be lit by.
    fn check(&self) -> Result<()> {
        let lights = self.directional.len();
        if lights > Self::MAX_DIRECTIONAL {
            let most = Self::MAX_DIRECTIONAL;
            return Err(Error::Usage(format!("{lights} directional lights: at most {most} are drawn")));
        }
        let factors = [self.ambient, self.headlight, self.specular, self.shininess];
        let directions = self.directional.iter().flat_map(|light| [light.to_light, light.radiance]).flatten();
        match self.albedo.into_iter().chain(factors).chain(directions).find(|number| !number.is_finite()) {
            Some(number) => Err(Error::Usage(format!(
                "a number of the lights or the material is {number}: give finite ones"
            ))),
            None => Ok(()),
        }
    }
}

impl Default for Lighting {
    fn default() -> Self {
        Self {
            albedo: [0.6; 3],
            ambient: 0.08,
            headlight: 0.87,
            specular: 0.06,
            shininess: 40.0,
            directional: Vec::new(),
        }
    }
}
