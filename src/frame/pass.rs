//! Pass declarations: shaders, what their invocations run over, resources read and written.
//!
//! Layouts, barriers, labels, timers and the list of passes of a frame follow from these and from shader reflection.

use super::recording::{Frame, PreparedPass};
use super::resource::Resource;
use super::scene_variant::SceneVariant;
use super::variant::Variant;
use crate::vk::shaders::Module;
use crate::vk::{Blend, Constants, DepthTest, Recorder, Topology};

/// A pass. Passes of one name are alternatives of, or steps of, the same computation.
pub struct Pass {
    /// Name of the shader, debug label, timer, reference function and report column.
    pub name: &'static str,
    /// Resources written by other passes that it reads, if the frame has them.
    pub reads: &'static [Resource],
    /// Resources that it writes and may read, without its attachments.
    pub writes: &'static [Resource],
    /// Resources cleared before it, which it or a later pass writes.
    pub clears: &'static [Resource],
    /// Its pipelines.
    pub programs: Programs,
    /// Its commands.
    pub commands: Commands,
}

/// The pipelines of a pass.
pub enum Programs {
    /// One set for all scenes of a frame.
    OfFrame(fn(&Variant) -> Vec<Program>),
    /// One set per scene.
    OfScene(fn(&SceneVariant) -> Vec<Program>),
}

/// The commands of a pass.
pub enum Commands {
    /// One dispatch per program.
    Dispatches,
    /// One draw per program.
    Draws(DrawTargets),
    /// Several steps, with a barrier between them.
    Steps(fn(&StepContext<'_>, &mut Recorder<'_>)),
}

/// Context in which the steps of a pass are recorded.
pub struct StepContext<'a> {
    /// The pipeline of its first program.
    pub pipeline: Option<&'a crate::vk::ComputePipeline>,
    /// Descriptor set 1.
    pub targets: &'a crate::vk::DescriptorSet,
    /// The frame.
    pub frame: &'a Frame<'a>,
    /// The pass.
    pub prepared: &'a PreparedPass,
}

/// Attachments and fixed-function state of a raster pass.
pub struct DrawTargets {
    /// Colour attachments at locations 0, 1, …; those that the frame lacks are absent.
    pub colours: &'static [(Resource, InitialContents)],
    /// Depth attachment.
    pub depth: Option<(Resource, InitialContents)>,
    /// Primitive topology.
    pub topology: Topology,
    /// Depth test.
    pub test: DepthTest,
    /// Blending of all colour attachments.
    pub blend: Blend,
}

/// Contents of an attachment when the render pass begins (its load operation).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialContents {
    /// Zeros.
    Cleared,
    /// Undefined: every pixel is written.
    Overwritten,
    /// The result of an earlier pass, which is only tested.
    Tested,
}

/// A pipeline of a pass.
pub struct Program {
    /// Its shaders.
    pub stages: Stages,
    /// Specialization constants in addition to those of the frame or the scene.
    pub constants: Constants,
    /// Domain of its invocations.
    pub domain: Domain,
    /// Each workgroup is one subgroup.
    pub is_subgroup: bool,
}

/// The shaders of a pipeline.
#[derive(Clone, Copy)]
pub enum Stages {
    /// A compute shader.
    Compute(&'static Module),
    /// Vertex and fragment shader.
    Draw([&'static Module; 2]),
}

/// Domain of a program's invocations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// One invocation per surfel.
    Surfels,
    /// One invocation per surfel of the capacity, in all instances.
    SurfelSlots,
    /// One workgroup per group of clusters, of all instances, that the CPU has not culled.
    Clusters,
    /// One workgroup per cluster in the list of visible ones.
    VisibleClusters,
    /// One workgroup per cluster in the list of those that pass hidden has revealed.
    RevealedClusters,
    /// One invocation per pixel of occupied tiles, for each chunk of a scene's surfels.
    PixelsOfSurfels,
    /// One invocation per segment.
    Lines,
    /// One invocation per pixel of occupied tiles.
    PixelsOfLines,
    /// One invocation per triangle.
    Triangles,
    /// Workgroups that share the list of large triangles.
    LargeTriangles,
    /// One invocation per pixel of occupied tiles.
    PixelsOfTriangles,
    /// One invocation per row of pixels of a pyramid tile.
    RowsOfPyramidTiles,
    /// One invocation per pixel.
    Pixels,
    /// One invocation per block of pixels.
    Blocks,
    /// One invocation per block of 2 × 2 pixels, and per corner of such blocks.
    Quads,
    /// One workgroup per tile.
    Tiles,
    /// One workgroup per tile, for the splats that face the eye.
    FrontTiles,
    /// One invocation per tile.
    TileSlots,
    /// One invocation per strip of tiles.
    TileStrips,
    /// One workgroup per tile, with all splats in one dispatch.
    WholeTiles,
    /// One workgroup per tile in the list of those that splats may cover.
    CoveredTiles,
    /// The same, for the splats that face the eye.
    CoveredFrontTiles,
    /// One workgroup per tile in the list of open ones.
    OpenTiles,
    /// One workgroup per tile in the list of those with edges.
    EdgeTiles,
    /// One workgroup per tile in the list of those of revealed clusters, for the splats that face the eye.
    RevealedTiles,
    /// Elements of a level, as the steps of the pass define.
    Level,
    /// The same of levels from 3 on, which have few.
    CoarseLevels,
    /// One triangle per splat.
    SplatTriangles,
    /// One point per surfel.
    Points,
    /// One triangle over the viewport.
    FullScreen,
}

/// Owner of descriptor set 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// The frame.
    View,
    /// A scene's surfels.
    Surfels,
    /// A scene's clusters of surfels.
    Clusters,
    /// A scene's segments.
    Lines,
    /// A scene's triangles.
    Triangles,
}

impl Domain {
    /// The list of tiles that it is.
    pub fn tile_list(self) -> Option<Resource> {
        match self {
            Self::CoveredTiles | Self::CoveredFrontTiles => Some(Resource::CoveredTiles),
            Self::OpenTiles => Some(Resource::OpenTiles),
            Self::EdgeTiles => Some(Resource::EdgeTiles),
            Self::RevealedTiles => Some(Resource::RevealedTiles),
            Self::PixelsOfSurfels | Self::PixelsOfLines | Self::PixelsOfTriangles => {
                Some(Resource::OccupiedTiles)
            }
            _ => None,
        }
    }

    /// Owner of descriptor set 0.
    pub fn scope(self) -> Scope {
        match self {
            Self::Surfels
            | Self::SurfelSlots
            | Self::VisibleClusters
            | Self::RevealedClusters
            | Self::PixelsOfSurfels
            | Self::SplatTriangles
            | Self::Points => Scope::Surfels,
            Self::Clusters => Scope::Clusters,
            Self::Lines | Self::PixelsOfLines => Scope::Lines,
            Self::Triangles | Self::LargeTriangles | Self::PixelsOfTriangles => Scope::Triangles,
            Self::Pixels
            | Self::Blocks
            | Self::Quads
            | Self::Tiles
            | Self::FrontTiles
            | Self::WholeTiles
            | Self::TileSlots
            | Self::TileStrips
            | Self::CoveredTiles
            | Self::CoveredFrontTiles
            | Self::OpenTiles
            | Self::EdgeTiles
            | Self::RevealedTiles
            | Self::RowsOfPyramidTiles
            | Self::Level
            | Self::CoarseLevels
            | Self::FullScreen => Scope::View,
        }
    }
}

impl Program {
    /// A compute shader.
    pub fn compute(module: &'static Module, domain: Domain) -> Self {
        Self { stages: Stages::Compute(module), constants: Constants::default(), domain, is_subgroup: false }
    }

    /// A vertex and a fragment shader.
    pub fn draw(modules: [&'static Module; 2], domain: Domain) -> Self {
        Self { stages: Stages::Draw(modules), constants: Constants::default(), domain, is_subgroup: false }
    }

    /// Adds a specialization constant.
    pub fn with(self, id: u32, value: impl Into<u32>) -> Self {
        Self { constants: self.constants.with(id, value), ..self }
    }

    /// Its shaders.
    pub fn modules(&self) -> &[&'static Module] {
        self.stages.modules()
    }
}

impl Stages {
    fn modules(&self) -> &[&'static Module] {
        match self {
            Self::Compute(module) => std::slice::from_ref(module),
            Self::Draw(modules) => modules,
        }
    }
}

impl Pass {
    /// Whether the pass reads or writes a resource that shaders declare as `shader`.
    pub fn binds(&self, shader: &crate::vk::shaders::Resource) -> bool {
        self.reads.iter().chain(self.writes).any(|resource| resource.is_bound_as(shader))
    }
}
