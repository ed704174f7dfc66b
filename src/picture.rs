//! A rendered frame on the CPU, in linear float.

/// A rendered frame, row by row from the top left. Each image that is present has one entry per pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height, px.
    pub size: [u32; 2],
    /// The quantity that [`crate::Settings::shading`] selects, and coverage α: linear RGB for `Lit` and `Colour`, the unit normal for
    /// `Normal`, the depth in all three channels for `Depth`.
    pub colour: Vec<[f32; 4]>,
    /// Eye-space depth; 0 without a surface. Present if requested.
    pub depth: Option<Vec<f32>>,
    /// Unit normal in world space, towards the eye; 0 without a surface. Present if requested.
    pub normal: Option<Vec<[f32; 3]>>,
    /// Id of the visible point: surfel, segment of a ribbon or tube, or triangle. Surfels come first, then segments and triangles, each
    /// in the order of the scene's parts; [`Picture::NOBODY`] without a surface. Present if requested.
    pub id: Option<Vec<u32>>,
}

impl Picture {
    /// The id of pixels without a surface.
    pub const NOBODY: u32 = u32::MAX;
}
