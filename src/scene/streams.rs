//! The streams of a scene, on which frames, shaders and memory depend.

use super::SurfelLayout;
use super::surfel_streams::{CODE, ELLIPSE, LATTICE_POSITION, SCALAR, VECTOR};

/// Streams of a scene beside positions, normals and radii.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Streams {
    /// Discs are ellipses.
    pub ellipses: bool,
    /// The curvature of the surface is stored with the normals.
    pub curvatures: bool,
    /// Some surfels are two-sided.
    pub two_sided: bool,
    /// Some surfels are billboards: circles that face the eye, with a normal of 0.
    pub billboards: bool,
    /// Some discs have clip lines.
    pub clips: bool,
    /// `None` without normalization weights; otherwise whether some surfels have corner weights.
    pub weights: Option<bool>,
    /// Format of colours.
    pub colours: ColourStream,
    /// Kinds of primitives beside surfels.
    pub primitives: PrimitiveKinds,
    /// Format of the texels, with a texture.
    pub texture: Option<ColourStream>,
    /// Some points have materials.
    pub materials: bool,
    /// Layout of the surfels' values.
    pub layout: SurfelLayout,
    /// The surfels are not validated on the CPU, so shaders validate them.
    pub unchecked: bool,
    /// The surfels are in arbitrary order, so frames by tiles sort them.
    pub unordered: bool,
    /// The bounds of clusters of consecutive surfels are known, so frames by compute shaders cull these.
    pub clusters: bool,
    /// Some surfels stand for others from afar.
    pub levels: bool,
}

impl Streams {
    /// One-sided circles in buffers of the engine, with contiguous streams and nothing else.
    pub fn circles(colours: ColourStream) -> Self {
        Self {
            ellipses: false,
            curvatures: false,
            two_sided: false,
            billboards: false,
            clips: false,
            weights: None,
            colours,
            primitives: PrimitiveKinds::NONE,
            texture: None,
            materials: false,
            layout: SurfelLayout::side_by_side(colours),
            unchecked: false,
            unordered: false,
            clusters: true,
            levels: false,
        }
    }

    /// The same, but quantized.
    pub fn quantized(self) -> Self {
        Self { layout: self.layout.quantized(self.curvatures), ..self }
    }

    /// Streams of uploaded surfels by name, with bytes per surfel; curvatures lie beside the normals, of quantized surfels in the
    /// same bytes, and their radii beside the positions. A clip takes 32 more, corner weights 16, the lattice of 64 quantized surfels 16, and of those that stay exact 16 each.
    pub fn per_surfel(&self) -> Vec<(&'static str, u64)> {
        let (quantized, given) = match self.layout.is_quantized() {
            true => (true, vec![("positions", LATTICE_POSITION), ("normals", CODE)]),
            false => (false, vec![("positions", VECTOR), ("normals", VECTOR), ("radii", SCALAR)]),
        };
        let ellipse = if quantized { CODE } else { ELLIPSE };
        let optional = [
            ("curvatures", if self.curvatures && !quantized { SCALAR } else { 0 }),
            ("colours", self.colours.bytes()),
            ("ellipses", if self.ellipses { ellipse } else { 0 }),
            ("clips", if self.clips { 4 } else { 0 }),
            ("weights", if self.weights.is_some() { SCALAR } else { 0 }),
        ];
        given.into_iter().chain(optional.into_iter().filter(|(_, bytes)| *bytes > 0)).collect()
    }
}

/// Kinds of lines and triangles in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PrimitiveKinds {
    /// Ribbons or tubes.
    pub lines: bool,
    /// Triangles.
    pub triangles: bool,
    /// Format of the vertex colours.
    pub colours: ColourStream,
}

impl PrimitiveKinds {
    /// Surfels only.
    pub const NONE: Self = Self { lines: false, triangles: false, colours: ColourStream::None };

    /// Whether there are any.
    pub fn any(self) -> bool {
        self.lines || self.triangles
    }
}

/// Format of colours, with the values of `shaders-glsl/lib/colour_streams.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ColourStream {
    /// None.
    None = 0,
    /// sRGB-encoded, 8 bits per channel.
    Srgb8 = 1,
    /// Linear float.
    Linear = 2,
    /// Coordinates in a texture. For methods that blend a colour per point: the texture's colour there, linear float.
    Textured = 3,
    /// Linear, 8 bits per channel, in buffers of the host.
    Unorm8 = 4,
    /// Linear, four half floats, in buffers of the host.
    Half = 5,
}

impl ColourStream {
    /// Bytes of a colour.
    pub(crate) fn bytes(self) -> u64 {
        match self {
            Self::None => 0,
            Self::Srgb8 | Self::Unorm8 => 4,
            Self::Half => 8,
            Self::Linear => 12,
            Self::Textured => 20,
        }
    }
}
