//! Which streams a scene has: what frames, shaders and memory depend on.

use super::{ELLIPSE, SCALAR, SurfelLayout, VECTOR};

/// What a scene has beside positions, normals and radii.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Streams {
    /// Discs are ellipses.
    pub ellipses: bool,
    /// Some surfels have no side.
    pub two_sided: bool,
    /// Some discs end at clip lines.
    pub clips: bool,
    /// Surfels have normalization weights, and some have four: none, or whether.
    pub weights: Option<bool>,
    /// How it holds colours.
    pub colours: ColourStream,
    /// What else there is than surfels.
    pub primitives: PrimitiveKinds,
    /// How it holds the texels of its texture, if it has one.
    pub texture: Option<ColourStream>,
    /// Some points shine in their own way.
    pub materials: bool,
    /// Where it has its surfels' values.
    pub layout: SurfelLayout,
    /// Nobody has looked whether all of them can be drawn: the shaders have to.
    pub unchecked: bool,
}

impl Streams {
    /// Those of surfels that have sides, own all their buffers, and hold nothing else; each stream side by side.
    pub fn circles(colours: ColourStream) -> Self {
        Self {
            ellipses: false,
            two_sided: false,
            clips: false,
            weights: None,
            colours,
            primitives: PrimitiveKinds::NONE,
            texture: None,
            materials: false,
            layout: SurfelLayout::side_by_side(colours),
            unchecked: false,
        }
    }

    /// The streams of surfels that are uploaded, by name, with the bytes of a surfel; a clip takes 32 more, weights at corners 16.
    pub fn per_surfel(&self) -> Vec<(&'static str, u64)> {
        let optional = [
            ("colours", self.colours.bytes()),
            ("ellipses", if self.ellipses { ELLIPSE } else { 0 }),
            ("clips", if self.clips { 4 } else { 0 }),
            ("weights", if self.weights.is_some() { SCALAR } else { 0 }),
        ];
        let given = [("positions", VECTOR), ("normals", VECTOR), ("radii", SCALAR)].into_iter();
        given.chain(optional.into_iter().filter(|(_, bytes)| *bytes > 0)).collect()
    }
}

/// Which lines and triangles a scene has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PrimitiveKinds {
    /// Ribbons or tubes.
    pub lines: bool,
    /// Triangles.
    pub triangles: bool,
    /// How it holds the colours of their vertices.
    pub colours: ColourStream,
}

impl PrimitiveKinds {
    /// Nothing but surfels.
    pub const NONE: Self = Self { lines: false, triangles: false, colours: ColourStream::None };

    /// Whether it has any.
    pub fn any(self) -> bool {
        self.lines || self.triangles
    }
}

/// How a scene holds its colours; the numbers are those of `shaders-glsl/lib/colour_streams.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum ColourStream {
    /// It has none.
    None = 0,
    /// sRGB-encoded, 8 bits a channel.
    Srgb8 = 1,
    /// Linear float.
    Linear = 2,
    /// Coordinates in a texture, and for methods that blend a colour a point that which is there, linear float.
    Textured = 3,
    /// Linear, 8 bits a channel: in buffers of a host.
    Unorm8 = 4,
    /// Linear half floats, four: in buffers of a host.
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
