//! Options of how surfels are rendered, of every command that renders.

use super::Axes;
use crate::cli::values::{Background, background, choice, number, pixel_filter, whole};
use clap::Args;
use clap::builder::ArgPredicate;
use surfel::settings::methods::{self, Method};
use surfel::settings::splatting::Filter;
use surfel::settings::{Alpha, Choice, Cull, Edges, Hierarchy, Shading, Widen};
use surfel::{Error, Result, Settings};

/// Render settings.
#[derive(Args, Clone, Debug)]
pub struct RenderSettings {
    /// What the picture shows [default: lit; edl for coloured points if many are on no surface, or many estimated normals mean nothing]
    #[arg(long, value_parser = choice::<Shading>(), default_value_if("edl", ArgPredicate::IsPresent, Shading::Edl.name()))]
    pub shading: Option<Shading>,
    /// Strength of --shading edl, which it implies: how much pixels behind their neighbours are darkened
    #[arg(long, value_name = "STRENGTH", value_parser = number::<f32>, default_value_t = Settings::DEFAULT_EDL, allow_hyphen_values = true)]
    pub edl: f32,
    /// Ambient occlusion: darkens cavities and creases, where little light from around arrives, with this strength, 1 if none is given [default: 0; 1 if many points without colours are on no surface]
    #[arg(long, value_name = "STRENGTH", value_parser = number::<f32>, num_args = 0..=1, require_equals = true, default_missing_value = "1")]
    pub ao: Option<f32>,
    /// Meaning of α [default: the method's]
    #[arg(long, value_parser = choice::<Alpha>())]
    pub alpha: Option<Alpha>,
    /// Surfaces that pixels at edges show [default: the method's]
    #[arg(long, value_parser = choice::<Edges>())]
    pub edges: Option<Edges>,
    /// Background: transparent, sRGB codes from 0 to 255, or a CSS colour such as #fff or white
    #[arg(long, value_name = "R,G,B|COLOR|transparent", default_value = "transparent", value_parser = background, allow_hyphen_values = true)]
    pub background: Background,
    /// Variance of the anti-aliasing filter, px², of methods that have one, such as perspective-ewa and object-ewa [default: 1]
    #[arg(long, value_name = "VARIANCE_PX2", value_parser = number::<f32>, allow_hyphen_values = true)]
    pub lowpass: Option<f32>,
    /// Filter of pixels after shading, with its part of the anti-aliasing filter's variance: gaussian:VARIANCE_PX2, or none [default: the method's]
    #[arg(long, value_name = "none|gaussian[:VARIANCE_PX2]", value_parser = pixel_filter)]
    pub pixel_filter: Option<f32>,
    /// Which splats the anti-aliasing filter widens, of methods that have one [default: the method's]
    #[arg(long, value_parser = choice::<Widen>())]
    pub widen: Option<Widen>,
    /// Where a splat's kernel ends, in standard deviations [default: the method's; perspective-ewa: 3.5]
    #[arg(long, value_name = "F", value_parser = number::<f32>, allow_hyphen_values = true)]
    pub cutoff: Option<f32>,
    /// How far behind the nearest splat others are still blended with it, in radii
    #[arg(long, value_name = "RADII", value_parser = number::<f32>, default_value_t = Settings::default().epsilon, allow_hyphen_values = true)]
    pub epsilon: f32,
    /// Which surfels are culled by their orientation [default: the method's]
    #[arg(long, value_parser = choice::<Cull>())]
    pub cull: Option<Cull>,
    /// Shows every point as a circle of this diameter, px, by method points, which estimates neither normals nor radii [default of that method: 2]
    #[arg(long, value_name = "PX", value_parser = number::<f32>, allow_hyphen_values = true)]
    pub point_size: Option<f32>,
    /// Level of detail, px: surfels that stand for all points of a cell are drawn where its side is at most this; 0 draws all points
    #[arg(long, value_name = "PX", value_parser = number::<f32>, default_value_t = 0.0, allow_hyphen_values = true)]
    pub lod: f32,
    /// Where levels of detail come from
    #[arg(long, default_value = Hierarchy::default().name(), value_parser = choice::<Hierarchy>())]
    pub hierarchy: Hierarchy,
    /// Most surfels that are drawn: the level of detail is the least one that keeps to it
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1..=u64::MAX))]
    pub max_points: Option<u64>,
}

impl RenderSettings {
    /// Whether the shading and ambient occlusion are given. A given shading is shown as it is, without ambient occlusion that is not given.
    pub fn chosen_shading(&self) -> [bool; 2] {
        let shading = self.shading.is_some();
        [shading, shading || self.ao.is_some()]
    }

    /// The method, of which `asked` is the given one: points of a fixed size, if a size is given.
    ///
    /// # Errors
    /// [`surfel::Error::Usage`] if a size of points is given for another method, or an option of the low-pass filter for a method without one.
    pub(super) fn method(&self, asked: Option<Method>, axes: &Axes) -> Result<Option<Method>> {
        let asked = asked.or(self.point_size.map(|_| methods::points::METHOD));
        let method = asked.unwrap_or(Method::ALL[0]);
        let settings = self.settings(axes, &method);
        if let Some(size) = self.point_size
            && !settings.draws_points()
        {
            return Err(Error::Usage(format!(
                "--point-size {size} is of --method points, and {} draws discs: leave one of them out",
                method.name
            )));
        }
        self.check_lowpass(&settings, &method)?;
        Ok(asked)
    }

    /// Returns an error if an option of the low-pass filter is given, and `settings` of `method` have no such filter.
    fn check_lowpass(&self, settings: &Settings, method: &Method) -> Result<()> {
        let options = [("--lowpass", self.lowpass.is_some()), ("--widen", self.widen.is_some())];
        let given = options.into_iter().find(|(_, given)| *given);
        match given {
            Some((option, _))
                if settings.pull_push.is_some() || settings.splatting.filter == Filter::None =>
            {
                Err(Error::Usage(format!(
                    "{option} is of the low-pass filter of splats, and {} has none: leave it out, or choose a method with one, such as \
                     perspective-ewa",
                    method.name
                )))
            }
            _ => Ok(()),
        }
    }

    /// The settings of a method with these changes and those of `axes`.
    pub(super) fn settings(&self, axes: &Axes, method: &Method) -> Settings {
        let preset = method.settings();
        Settings {
            splatting: axes.apply(preset.splatting),
            pull_push: preset.pull_push,
            cutoff: self.cutoff.unwrap_or(preset.cutoff),
            lowpass: self.lowpass.unwrap_or(preset.lowpass),
            pixel_filter: self.pixel_filter.unwrap_or(preset.pixel_filter),
            widen: self.widen.unwrap_or(preset.widen),
            point_size: self.point_size.unwrap_or(preset.point_size),
            lod: self.lod,
            max_points: self.max_points,
            epsilon: self.epsilon,
            cull: self.cull.unwrap_or(preset.cull),
            alpha: self.alpha.unwrap_or(preset.alpha),
            edges: self.edges.unwrap_or(preset.edges),
            shading: self.shading.unwrap_or(preset.shading),
            edl: self.edl,
            ao: self.ao.unwrap_or(0.0),
            background: self.background.linear(),
            lighting: preset.lighting,
        }
    }
}
