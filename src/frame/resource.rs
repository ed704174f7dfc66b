//! Resources that passes read and write.

/// Buffers and images that passes hand to later passes. Inputs that no pass writes, such as positions, are not among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Resource {
    /// One splat per surfel: of a scene, or on the tile path of all scenes of a frame.
    Splats,
    /// Tile path, per scene in arbitrary order: indices of its surfels along a curve.
    Order,
    /// Compute path, per scene: lists of the clusters of surfels that were not culled.
    VisibleClusters,
    /// Tile path, per scene: which of its clusters were hidden in the last frame, and are in this one.
    HiddenClusters,
    /// Tile path: bounding boxes of splats, and of the hierarchy's nodes above them.
    Boxes,
    /// Tile path: attributes that sums read of each splat.
    Attributes,
    /// Projected clip lines, of a scene or a frame as splats are.
    ScreenClips,
    /// Per scene: culled surfels by reason.
    Counts,
    /// Per scene: indices of large triangles.
    LargeTriangles,
    /// Depth key of the nearest surface, moved back by ε; 0 in empty pixels.
    Visibility,
    /// `(Σw, Σw a)`: `a` is the normal if the frame needs normals, else the colour.
    Sums0,
    /// `(Σw κ, Σw rgb)`, if the frame needs depth, or colours and normals.
    Sums1,
    /// Tile path: the tiles that splats may cover, after the workgroups of an indirect dispatch over them.
    CoveredTiles,
    /// Tile path: the tiles that splats that face away may change, after the workgroups of an indirect dispatch over them.
    OpenTiles,
    /// Tile path: the tiles with pixels at edges, after the workgroups of an indirect dispatch over them.
    EdgeTiles,
    /// Tile path: the tiles that revealed clusters may change, after the workgroups of an indirect dispatch over them.
    RevealedTiles,
    /// Pull–push: the tiles with a nearest point, after the workgroups of indirect dispatches over their pixels.
    OccupiedTiles,
    /// Pull–push: the tiles that push may fill, likewise.
    FilledTiles,
    /// Mask of each pixel's covered samples, if α is coverage; in frames that mix edges also of those of the nearest surface.
    Coverage,
    /// Raster path: depth key of the surface behind in pixels at edges, moved back by ε.
    Behind,
    /// Distance and id of the nearest point of each pixel.
    Nearest,
    /// Depth of the nearest rasterized point, a bijection of its distance.
    NearestDepth,
    /// Its id + 1; 0 in empty pixels.
    NearestId,
    /// Pyramid whose level 0 fetch writes.
    Pulled,
    /// Pyramid whose level 0 shade reads.
    Pushed,
    /// Linear colour and α, or the quantity that is shaded.
    Image,
    /// Ambient occlusion of blocks of 2 × 2 pixels, if the picture has it.
    Occlusion,
    /// The filtered image, over the background, if pixels are filtered.
    Filtered,
    /// Unit normals, if requested.
    Normal,
    /// Eye-space depths, if requested.
    Depth,
    /// Ids of the visible points, if requested.
    Id,
    /// Number of the last frame of which a tile lacks splats; see `slicing`.
    IncompleteFrame,
    /// Depth attachment of a host.
    HostDepth,
}

impl Resource {
    /// The name of a target in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Splats => "splats",
            Self::Order => "order",
            Self::VisibleClusters => "visible clusters",
            Self::HiddenClusters => "hidden clusters",
            Self::Boxes => "boxes",
            Self::Attributes => "attributes",
            Self::ScreenClips => "screen clips",
            Self::Counts => "counts",
            Self::LargeTriangles => "large triangles",
            Self::Visibility => "visibility",
            Self::Sums0 => "sums0",
            Self::Sums1 => "sums1",
            Self::CoveredTiles => "covered tiles",
            Self::OpenTiles => "open tiles",
            Self::EdgeTiles => "edge tiles",
            Self::RevealedTiles => "revealed tiles",
            Self::OccupiedTiles => "occupied tiles",
            Self::FilledTiles => "filled tiles",
            Self::Coverage => "coverage",
            Self::Behind => "behind",
            Self::Nearest => "nearest",
            Self::NearestDepth => "nearest_depth",
            Self::NearestId => "nearest_id",
            Self::Pulled => "pulled",
            Self::Pushed => "pushed",
            Self::Image => "image",
            Self::Occlusion => "occlusion",
            Self::Filtered => "filtered",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Id => "id",
            Self::IncompleteFrame => "incomplete frame",
            Self::HostDepth => "host depth",
        }
    }

    /// Whether scenes have their own, or a range of the frame's.
    pub fn is_of_scene(self) -> bool {
        matches!(
            self,
            Self::Splats
                | Self::Order
                | Self::VisibleClusters
                | Self::HiddenClusters
                | Self::Boxes
                | Self::Attributes
                | Self::ScreenClips
                | Self::Counts
                | Self::LargeTriangles
        )
    }
}
