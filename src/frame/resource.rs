//! What passes read and write.

/// Buffers and images that passes hand on to each other. What is only read, such as positions, is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Resource {
    /// A splat a surfel: of a scene, or of all scenes of a frame one after the other, where they are for tiles.
    Splats,
    /// For tiles: the pixels of each splat, and of the nodes of the hierarchy above them.
    Boxes,
    /// For tiles: what the sums take of each splat.
    Attributes,
    /// Clip lines on the screen, of a scene or a frame as splats are.
    ScreenClips,
    /// Of a scene: culled surfels by reason.
    Counts,
    /// Of a scene: indices of triangles of many pixels.
    LargeTriangles,
    /// Depth key of the nearest surface, moved back by ε; 0 where there is none.
    Visibility,
    /// `(Σw, Σw a)`: `a` is the normal where normals are wanted, else the colour.
    Sums0,
    /// `(Σw κ, Σw rgb)`, where depth is wanted, or colour beside normals.
    Sums1,
    /// The samples of each pixel that a surface covers, a bit each, where α is coverage.
    Coverage,
    /// Distance and number of the nearest point of each pixel.
    Nearest,
    /// A depth that tells the distance of the nearest point that is drawn, bit for bit.
    NearestDepth,
    /// Its number, from 1 on; 0 where there is none.
    NearestNumber,
    /// The pyramid with the level 0 that fetch writes.
    Pulled,
    /// The pyramid with the level 0 that shade reads.
    Pushed,
    /// Linear colour and α, or the quantity that is shaded.
    Image,
    /// Unit normals, if requested.
    Normal,
    /// Eye-space depth, if requested.
    Depth,
    /// Ids of the visible points, if requested.
    Id,
    /// The number of the last frame that lacks splats of a tile; see `crowding`.
    IncompleteFrame,
    /// The depth of a host's surfaces.
    HostDepth,
}

impl Resource {
    /// The name of a target in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Splats => "splats",
            Self::Boxes => "boxes",
            Self::Attributes => "attributes",
            Self::ScreenClips => "screen clips",
            Self::Counts => "counts",
            Self::LargeTriangles => "large triangles",
            Self::Visibility => "visibility",
            Self::Sums0 => "sums0",
            Self::Sums1 => "sums1",
            Self::Coverage => "coverage",
            Self::Nearest => "nearest",
            Self::NearestDepth => "nearest_depth",
            Self::NearestNumber => "nearest_number",
            Self::Pulled => "pulled",
            Self::Pushed => "pushed",
            Self::Image => "image",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Id => "id",
            Self::IncompleteFrame => "incomplete frame",
            Self::HostDepth => "host depth",
        }
    }

    /// Whether each scene has one of its own, or its part of one.
    pub fn is_of_scene(self) -> bool {
        matches!(
            self,
            Self::Splats
                | Self::Boxes
                | Self::Attributes
                | Self::ScreenClips
                | Self::Counts
                | Self::LargeTriangles
        )
    }
}
