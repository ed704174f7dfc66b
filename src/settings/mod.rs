//! Settings of a frame, shared by the Vulkan methods and the float64 reference.

mod check;
mod choice;
mod hierarchy;
mod lighting;
pub mod methods;
mod outputs;
pub mod pull_push;
pub mod splatting;

use crate::settings::pull_push::{PullPush, Rules};
use crate::settings::splatting::{
    FLAT_VARIANCE, Filter, Footprint, Normalization, Shade, Splatting, Visibility,
};
pub use choice::Choice;
pub use hierarchy::Hierarchy;
pub use lighting::{DirectionalLight, Lighting};
pub use outputs::{Outputs, Precision, Rasterizer, RasterizerChoice, RasterizerReason};
use std::ops::RangeInclusive;

/// Settings of a frame beside camera and scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Splatting: how surfels become pixels.
    pub splatting: Splatting,
    /// Selects pull–push: points one pixel large. Settings of splats, kernels and filters are then unused.
    pub pull_push: Option<PullPush>,
    /// Kernel cut-off `F`, in σ: the splat ends at `u² + v² = F²`. Within [`Settings::CUTOFFS`].
    pub cutoff: f32,
    /// Variance of the low-pass filter `H = lowpass · I`, px², at most [`Settings::MOST_LOWPASS`]. At least [`Settings::least_lowpass`] is
    /// applied, so that each splat covers a pixel centre.
    pub lowpass: f32,
    /// Variance of the Gaussian that filters pixels after shading, px², at most [`Settings::MOST_PIXEL_FILTER`]; 0: none. The low-pass filter of
    /// splats has the rest of [`Settings::lowpass`]. It filters colour and α, not other quantities, and never normals, depths and ids. Of
    /// [`Alpha::Mask`] it filters the colours of pixels with a surface, and α stays.
    pub pixel_filter: f32,
    /// Splats that the low-pass filter widens.
    pub widen: Widen,
    /// Diameter of the circles of [`Footprint::Point`], px, within [`Settings::POINT_SIZES`]; unused otherwise. A smaller one than 1.42 px counts
    /// as that, so that each covers a pixel centre.
    pub point_size: f32,
    /// Level of detail, px: cells of at most this side are drawn as one surfel, in scenes with levels ([`crate::geometry::Levels`]); 0 draws all
    /// points.
    pub lod: f32,
    /// Most surfels that are drawn; `None` for any number. In scenes with levels the level of detail is at least the least one at which no more
    /// are drawn ([`crate::geometry::MostDrawn`]); without levels all are drawn.
    pub max_points: Option<u64>,
    /// Depth tolerance ε in surfel radii: splats at most this far behind the nearest one, along the viewing ray, are blended.
    pub epsilon: f32,
    /// Back-face culling.
    pub cull: Cull,
    /// Meaning of α.
    pub alpha: Alpha,
    /// Surfaces that pixels at edges show.
    pub edges: Edges,
    /// Quantity that the picture shows.
    pub shading: Shading,
    /// Strength of [`Shading::Edl`], at most [`Settings::MOST_EDL`].
    pub edl: f32,
    /// Strength of ambient occlusion, at most [`Settings::MOST_AO`]; 0: none. A coloured picture is multiplied by the part of the light from
    /// around that reaches each pixel's surface, to this power; other quantities are not. See the guide, Methods, Ambient occlusion.
    pub ao: f32,
    /// Background colour, linear RGB; `None` is transparent (all channels 0). Partly covered pixels are blended with it.
    pub background: Option<[f32; 3]>,
    /// Lights and material of [`Shading::Lit`].
    pub lighting: Lighting,
}

impl Default for Settings {
    /// Those of `perspective-ewa`: the most accurate pictures.
    fn default() -> Self {
        Self {
            pull_push: None,
            splatting: Splatting::default(),
            cutoff: 3.5,
            lowpass: 1.0,
            pixel_filter: 0.75,
            widen: Widen::Small,
            point_size: Self::DEFAULT_POINT_SIZE,
            lod: 0.0,
            max_points: None,
            epsilon: 1.0,
            cull: Cull::Auto,
            alpha: Alpha::Coverage,
            edges: Edges::Mixed,
            shading: Shading::Lit,
            edl: Self::DEFAULT_EDL,
            ao: 0.0,
            background: None,
            lighting: Lighting::default(),
        }
    }
}

impl Settings {
    /// Range of cut-offs, σ. A Gaussian is below 10⁻¹³ beyond 8 σ. Lighting needs sums of normals whose squares do not underflow in
    /// float32, as they do for weights below 10⁻¹⁹.
    pub const CUTOFFS: RangeInclusive<f32> = 0.1..=8.0;
    /// Range of diameters of points, px.
    pub const POINT_SIZES: RangeInclusive<f32> = 1.0..=64.0;
    /// Diameter of points where none is given, px.
    pub const DEFAULT_POINT_SIZE: f32 = 2.0;
    /// Largest level of detail, px.
    pub const MOST_LOD: f32 = 1000.0;
    /// Largest low-pass variance, px²: the filter widens a splat to at most 10 px per σ.
    pub const MOST_LOWPASS: f32 = 100.0;

    /// [`Settings::most_rise`] where sums are divided by those of weights: the low-pass extends the plane of a disc seen edge-on far in front
    /// of it.
    pub(crate) const MOST_RISE: f64 = 8.0;
    /// The same where they are not divided: kernels stay whole, as on a plane towards its horizon the sum of their weights counts.
    const MOST_RISE_UNDIVIDED: f64 = 1e9;

    /// Variance of the filter of pixels where none is given, px².
    pub const DEFAULT_PIXEL_FILTER: f32 = 0.75;
    /// Largest variance of the filter of pixels, px².
    pub const MOST_PIXEL_FILTER: f32 = 4.0;

    /// Strength of eye-dome lighting where none is given.
    pub const DEFAULT_EDL: f32 = 0.25;
    /// Largest strength of eye-dome lighting.
    pub const MOST_EDL: f32 = 100.0;

    /// Strength of ambient occlusion where none is given.
    pub const DEFAULT_AO: f32 = 1.0;
    /// Largest strength of ambient occlusion.
    pub const MOST_AO: f32 = 10.0;

    /// Least low-pass variance at which every splat covers a pixel centre, px²: `(0.71 / F)²`, so that the cut-off radius is at least √½
    /// px. The visibility footprint has at least this. Points of a fixed size have no other extent than that of the filter, so for these it
    /// is that of their circle.
    pub fn least_lowpass(&self) -> f32 {
        let radius = if self.draws_points() { (0.5 * self.point_size).max(0.71) } else { 0.71 };
        (radius / self.cutoff).powi(2)
    }

    /// Whether every point is a circle of a fixed size.
    pub fn draws_points(&self) -> bool {
        self.pull_push.is_none() && self.splatting.footprint == Footprint::Point
    }

    /// How far in front of its disc a splat's plane shows at most, in the widths of a pixel there.
    pub(crate) fn most_rise(&self) -> f64 {
        let Splatting { normalization, visibility, .. } = self.splatting;
        let divided = normalization == Normalization::Pixel || visibility == Visibility::Nearest;
        if divided { Self::MOST_RISE } else { Self::MOST_RISE_UNDIVIDED }
    }

    /// Radius of the filter of pixels, px: 3 σ, rounded up; 0 if the picture is not filtered.
    pub fn filter_radius(&self) -> u32 {
        if self.shading.is_coloured() { (3.0 * self.pixel_filter.sqrt()).ceil() as u32 } else { 0 }
    }

    /// Whether ambient occlusion darkens the picture.
    pub fn occludes(&self) -> bool {
        self.ao > 0.0 && self.shading.is_coloured()
    }

    /// Whether a pass after shading blends with the background: the filter of pixels, eye-dome lighting, or ambient occlusion.
    pub fn has_late_background(&self) -> bool {
        self.filter_radius() > 0 || self.shading == Shading::Edl || self.occludes()
    }

    /// Low-pass variance of the attribute footprint, px²: the variance that is added to a splat's, or with [`Widen::Small`] its lower
    /// bound.
    pub fn attribute_lowpass(&self) -> f32 {
        match self.splatting.filter {
            Filter::None => self.least_lowpass(),
            Filter::Screen | Filter::Object => (self.lowpass - self.pixel_filter).max(self.least_lowpass()),
        }
    }

    /// The meaning of α in the picture: normals, depths and counts are not blended with a colour, so before a background their α is a mask.
    /// So is that of points of a fixed size, which cover no part of a surface.
    pub fn drawn_alpha(&self) -> Alpha {
        if self.draws_points() {
            return Alpha::Mask;
        }
        if self.shading.is_coloured() || self.background.is_none() { self.alpha } else { Alpha::Mask }
    }

    /// Whether the sides of surfaces are found, for [`Cull::Auto`]: by splats along viewing rays, and by pull–push with its robust rules. The
    /// published ones and [`Visibility::Axis`] draw both sides then.
    pub fn finds_sides(&self) -> bool {
        let by_method = match self.pull_push {
            Some(pull_push) => pull_push.rules == Rules::Robust,
            None => self.splatting.visibility != Visibility::Axis,
        };
        self.cull == Cull::Auto && by_method
    }

    /// Whether pixels at edges show the surface behind, too, for [`Edges::Mixed`].
    pub fn mixes_edges(&self) -> bool {
        self.edges == Edges::Mixed
            && self.pull_push.is_none()
            && self.splatting.visibility == Visibility::Ray
            && self.drawn_alpha() == Alpha::Coverage
            && self.shading.is_coloured()
    }

    /// Whether normals vary over discs, of a scene with curvatures: [`Shade::NormalField`].
    pub fn has_normal_fields(&self) -> bool {
        self.splatting.shade == Shade::NormalField
            && self.pull_push.is_none()
            && self.splatting.visibility != Visibility::Nearest
            && self.splatting.has_gaussian_discs()
    }

    /// Variance of a splat before filters, px², up to which a normal field is 0 along that axis.
    pub(crate) fn flat_variance(&self) -> f64 {
        let [least, filter] = [self.least_lowpass(), self.attribute_lowpass()].map(f64::from);
        match self.widen {
            Widen::All => FLAT_VARIANCE * filter,
            // The larger of `filter` and V + `least` is at least V + V / FLAT_VARIANCE.
            Widen::Small => (FLAT_VARIANCE * least).max(filter * FLAT_VARIANCE / (FLAT_VARIANCE + 1.0)),
        }
    }

    /// The settings by which subpasses of a host draw: over the host's picture, without the filter of pixels, eye-dome lighting and ambient
    /// occlusion, which read neighbours, and without [`Cull::Auto`] and [`Edges::Mixed`], which need other passes before and after them.
    /// [`DepthShading`](crate::embed::DepthShading) adds eye-dome lighting and ambient occlusion afterwards.
    pub fn in_subpasses(&self) -> Self {
        let cull = if self.cull == Cull::Auto { Cull::None } else { self.cull };
        let shading = if self.shading == Shading::Edl { Shading::Colour } else { self.shading };
        let edges = Edges::Nearest;
        Self { background: None, pixel_filter: 0.0, cull, edges, shading, ao: 0.0, ..self.clone() }
    }
}

/// Splats that the low-pass filter `H` widens: how the variance `V` of a projected kernel, with eigenvalues `λ`, becomes that of the
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
    /// Splats, or axes of splats, that are smaller than the filter.
    ///
    /// Along each axis of `V`, `λ` becomes `max(λ + least, H)`, with [`Settings::least_lowpass`]. Larger splats stay sharp and cost fewer
    /// pixels. The result is continuous in `V`, so that nothing jumps as a splat grows, and at least the visibility footprint, so that
    /// every visible pixel gets attributes. Texture filters clamp the axes of their footprints in this way: Greene, Heckbert, *Creating
    /// Raster Omnimax Images from Multiple Perspective Views Using the Elliptical Weighted Average Filter*, IEEE Computer Graphics and
    /// Applications 1986.
    Small,
}

/// Back-face culling.
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
    /// Surfels whose normals face away are culled.
    Back,
    /// Of the surfels whose normals face away, those of the far side of a closed surface are culled.
    ///
    /// These are surfels that are hidden by a surface that faces the eye, or lie just past an outline of it: see the guide, Methods, Sides.
    /// Culling equals `back` on closed surfaces, and leaves open ones whole from behind. Other normals are flipped towards the eye.
    /// Pull–push, [`Visibility::Axis`] and subpasses of a host draw both sides.
    Auto,
}

/// Meaning of α.
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
    /// 1 if a splat covers the pixel's centre, otherwise 0.
    Mask,
    /// The covered part of the pixel: smooth outlines.
    ///
    /// Of 16 samples, those inside any splat, hidden or not. A splat counts up to 0.77 of its cut-off and unfiltered: discs with radii 1.3
    /// times as large as needed then leave no holes and do not extend beyond the outline. Each splat without a sample in its centre's pixel
    /// covers the sample nearest to its centre, so that it is visible however small it is. A clip line divides the pixels that it cuts by
    /// samples, too; the removed side is drawn up to half a pixel beyond it where nothing else is. Pull–push has the pixels of a mask;
    /// those next to an empty one have the samples inside any disc that was reconstructed around them.
    Coverage,
}

/// Surfaces that a pixel at an edge shows.
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
pub enum Edges {
    /// The nearest one alone.
    Nearest,
    /// The nearest one and the one behind it, each by its samples: smooth edges inside the picture.
    ///
    /// Of the 16 samples of [`Alpha::Coverage`], those inside splats within ε of the nearest one are of the nearest surface. If other splats
    /// cover further samples, the nearest of these and what is within its ε are the surface behind, which shows in all further samples. Only
    /// light and colours are mixed; depths, normals and α are as of `nearest`. Pull–push, [`Visibility::Axis`], [`Visibility::Nearest`],
    /// [`Alpha::Mask`] and subpasses of a host show the nearest surface alone.
    Mixed,
}

/// Quantity that the picture shows.
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
    /// Blinn–Phong in linear light, with the lights of [`Lighting`].
    Lit,
    /// The points' own colours.
    #[strum(to_string = "color", serialize = "colour")]
    Colour,
    /// Normals in world space: x, y, z from −1 to 1 as red, green, blue.
    Normal,
    /// Distance from the eye along the view, in the positions' unit.
    Depth,
    /// Number of blended splats (pajarola2004 figure 18).
    Overlap,
    /// Sum of the splats' weights.
    ///
    /// Includes normalization weights: shows the deviation from a partition of unity.
    Weight,
    /// The points' own colours under eye-dome lighting: darker behind neighbours.
    ///
    /// Shows shape and outlines where normals are unknown (Boucheny 2009). A pixel's colour is multiplied by exp(−s·r̄): `s` is
    /// [`Settings::edl`], and `r̄` the mean over its eight neighbours of how far these are in front of it, in widths of a pixel there per px
    /// between both, 0 for those behind or without a surface. A plane looks alike at every size of the picture and distance.
    Edl,
}

impl Shading {
    /// Whether it shows colours, which are filtered and blended with a background, and not another quantity.
    pub fn is_coloured(self) -> bool {
        matches!(self, Self::Lit | Self::Colour | Self::Edl)
    }
}
