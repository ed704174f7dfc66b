//! What a pass says of itself: its shaders, what they run over, what it reads and writes.
//!
//! From this, and from what its shaders declare, come layouts, barriers, labels, timers and the list of passes of a frame.

use super::recording::Frame;
use super::resource::Resource;
use super::variant::{SceneVariant, Variant};
use crate::vk::shaders::Module;
use crate::vk::{Blend, Constants, DepthTest, Recorder, Topology};

/// A pass. Passes of the same name do the same, by other means or in another step.
pub struct Pass {
    /// Of its shader, label, timer, function in the reference and column in reports.
    pub name: &'static str,
    /// What it reads of what other passes have written, as far as a frame has it.
    pub reads: &'static [Resource],
    /// What it writes, and maybe reads, beside what it draws to.
    pub writes: &'static [Resource],
    /// What is emptied before.
    pub clears: &'static [Resource],
    /// Its pipelines.
    pub programs: Programs,
    /// Its commands.
    pub commands: Commands,
}

/// The pipelines of a pass.
pub enum Programs {
    /// None: it copies.
    None,
    /// The same for all scenes of a frame.
    OfFrame(fn(&Variant) -> Vec<Program>),
    /// Of each scene.
    OfScene(fn(&SceneVariant) -> Vec<Program>),
}

/// The commands of a pass.
pub enum Commands {
    /// A dispatch of each program.
    Dispatches,
    /// A draw of each program.
    Draws(Targets),
    /// Several steps, each of which waits for the one before.
    Steps(fn(&Steps<'_>, &mut Recorder<'_>)),
}

/// What a pass of several steps is recorded with.
pub struct Steps<'a> {
    /// Its only program.
    pub pipeline: Option<&'a crate::vk::ComputePipeline>,
    /// Descriptor set 1, if it has a program.
    pub targets: Option<&'a crate::vk::DescriptorSet>,
    /// The frame.
    pub frame: &'a Frame<'a>,
}

/// What a pass draws to, and how.
pub struct Targets {
    /// Colours at the locations 0, 1, …; what a frame lacks is not written.
    pub colours: &'static [(Resource, Start)],
    /// Depth.
    pub depth: Option<(Resource, Start)>,
    /// What is drawn.
    pub topology: Topology,
    /// Depth test.
    pub test: DepthTest,
    /// Blending of all colours.
    pub blend: Blend,
}

/// What is in a target when a pass begins to draw to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Zeros.
    Cleared,
    /// What does not matter: every pixel is written.
    Overwritten,
    /// What an earlier pass has left, which stays.
    Tested,
}

/// A pipeline of a pass.
pub struct Program {
    /// Its shaders.
    pub stages: Stages,
    /// Specialization constants beside those of the frame or the scene.
    pub constants: Constants,
    /// What it runs over.
    pub over: Over,
}

/// The shaders of a pipeline.
#[derive(Clone, Copy)]
pub enum Stages {
    /// One.
    Compute(&'static Module),
    /// Vertex and fragment shader.
    Draw([&'static Module; 2]),
}

/// What a program runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// An invocation a surfel.
    Surfels,
    /// An invocation for each surfel that there is room for, in all instances.
    Slots,
    /// An invocation a pixel, for each part of a scene's surfels that one descriptor set names.
    PixelsOfSurfels,
    /// An invocation a segment.
    Lines,
    /// An invocation a pixel.
    PixelsOfLines,
    /// An invocation a triangle.
    Triangles,
    /// Workgroups that share the large triangles.
    LargeTriangles,
    /// An invocation a pixel.
    PixelsOfTriangles,
    /// An invocation a pixel.
    Pixels,
    /// A workgroup a tile.
    Tiles,
    /// Pixels of a pyramid's level, as the pass's steps say.
    Level,
    /// A triangle a splat.
    SplatTriangles,
    /// A point a surfel.
    Points,
    /// A triangle over the picture.
    FullScreen,
}

/// What of the frame descriptor set 0 is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// All scenes.
    View,
    /// A scene's surfels.
    Surfels,
    /// A scene's segments.
    Lines,
    /// A scene's triangles.
    Triangles,
}

impl Over {
    /// What descriptor set 0 is of.
    pub fn scope(self) -> Scope {
        match self {
            Self::Surfels | Self::Slots | Self::PixelsOfSurfels | Self::SplatTriangles | Self::Points => {
                Scope::Surfels
            }
            Self::Lines | Self::PixelsOfLines => Scope::Lines,
            Self::Triangles | Self::LargeTriangles | Self::PixelsOfTriangles => Scope::Triangles,
            Self::Pixels | Self::Tiles | Self::Level | Self::FullScreen => Scope::View,
        }
    }
}

impl Program {
    /// A compute shader.
    pub fn compute(module: &'static Module, over: Over) -> Self {
        Self { stages: Stages::Compute(module), constants: Constants::default(), over }
    }

    /// A vertex and a fragment shader.
    pub fn draw(modules: [&'static Module; 2], over: Over) -> Self {
        Self { stages: Stages::Draw(modules), constants: Constants::default(), over }
    }

    /// With another specialization constant.
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
    /// Whether it reads or writes what shaders see as this.
    pub fn sees(&self, shader: &crate::vk::shaders::Resource) -> bool {
        self.reads.iter().chain(self.writes).any(|resource| resource.is_seen_as(shader))
    }
}
