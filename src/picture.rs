//! A rendered frame on the CPU, in linear float.

/// A rendered frame, row by row from the top left. Every image that is present has one entry a pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height, px.
    pub size: [u32; 2],
    /// What [`crate::Settings::shading`] asked for, and coverage: linear RGB and α for `Lit` and `Colour`, the unit normal for
    /// `Normal`, the depth three times over for `Depth`.
    pub colour: Vec<[f32; 4]>,
    /// Eye-space depth; 0 where no surface is. Present where it was asked for.
    pub depth: Option<Vec<f32>>,
    /// Unit normal in world space, towards the eye; 0 where no surface is. Present where it was asked for.
    pub normal: Option<Vec<[f32; 3]>>,
    /// Number of the surfel, the segment of a ribbon or a tube, or the triangle that is shown: surfels come first, then these, each in the
    /// order of the scene's parts; [`Picture::NOBODY`] where no surface is. Present where it was asked for.
    pub id: Option<Vec<u32>>,
}

impl Picture {
    /// The number in [`Picture::id`] where no surface is.
    pub const NOBODY: u32 = u32::MAX;
}
