//! Fixed-function state of draw pipelines.

use super::pipeline_pool::PassKey;
use ash::vk;

/// Primitive topology.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Three vertices per triangle.
    Triangles,
    /// One vertex per point; the vertex shader writes the point size.
    Points,
}

/// Depth test and depth write of a draw. Depth is reversed: greater is nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DepthTest {
    /// No depth target.
    None,
    /// Test and write: the nearest fragment is kept.
    Nearest,
    /// Test only: fragments that are not behind the target's depth pass.
    NotBehind,
    /// Write without a test.
    Always,
    /// Like [`DepthTest::Nearest`], and marks the written pixels in the stencil.
    Marking,
    /// Like [`DepthTest::NotBehind`], only where the stencil is marked.
    Marked,
    /// Test against the host's depth: fragments that are not behind it pass.
    Host {
        /// Whether greater depth is nearer.
        reversed: bool,
        /// Whether they are written.
        write: bool,
    },
}

/// Blending of fragments with the colour targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blend {
    /// Fragments replace the target.
    Replace,
    /// Fragments are added.
    Add,
    /// Premultiplied alpha: `source + (1 − α) target`.
    Over,
    /// Colours of the target are multiplied by those of fragments; its α stays.
    Multiply,
}

/// Fixed-function state of a draw pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DrawState {
    /// What is drawn.
    pub topology: Topology,
    /// Depth test.
    pub depth: DepthTest,
    /// Blending, the same for all colour targets that are drawn to.
    pub blend: Blend,
}

/// The part of a host's frame in which a pipeline draws.
#[derive(Clone, Debug)]
pub struct Within {
    pub(super) pass: PassKey,
    /// Blending of each colour target; `None` masks the target.
    pub(super) blends: Vec<Option<Blend>>,
    pub(super) samples: vk::SampleCountFlags,
}

impl Within {
    /// A subpass of the host's render pass with `samples` samples per pixel. `blends` has one entry per colour target: `None` masks it.
    ///
    /// # Safety
    /// The arguments describe a render pass of the device for which pipelines are created, and the pass outlives the pipelines.
    pub unsafe fn subpass(
        (pass, subpass): (vk::RenderPass, u32),
        blends: &[Option<Blend>],
        samples: vk::SampleCountFlags,
    ) -> Self {
        Self { pass: PassKey::Subpass(pass, subpass), blends: blends.to_vec(), samples }
    }

    /// The host's dynamic rendering with these formats of colours, depth and stencil; otherwise like [`Within::subpass`].
    ///
    /// # Safety
    /// The device for which pipelines are created has dynamicRendering enabled.
    pub unsafe fn rendering(
        (colours, depth, stencil): (&[vk::Format], vk::Format, vk::Format),
        blends: &[Option<Blend>],
        samples: vk::SampleCountFlags,
    ) -> Self {
        Self { pass: PassKey::Rendering(colours.to_vec(), depth, stencil), blends: blends.to_vec(), samples }
    }

    /// The same with all colour targets masked but that at `location`.
    pub fn masked_but(&self, location: usize) -> Self {
        let kept = |(i, blend): (usize, &Option<Blend>)| blend.filter(|_| i == location);
        Self { blends: self.blends.iter().enumerate().map(kept).collect(), ..self.clone() }
    }

    /// The render pass and subpass; null for dynamic rendering.
    pub(super) fn pass(&self) -> (vk::RenderPass, u32) {
        match self.pass {
            PassKey::Subpass(pass, subpass) => (pass, subpass),
            PassKey::Formats(..) | PassKey::Rendering(..) => (vk::RenderPass::null(), 0),
        }
    }
}

impl Topology {
    pub(super) fn info(self) -> vk::PipelineInputAssemblyStateCreateInfo<'static> {
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(match self {
            Self::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
            Self::Points => vk::PrimitiveTopology::POINT_LIST,
        })
    }
}

impl DepthTest {
    pub(super) fn info(self) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
        let compare = match self {
            Self::NotBehind | Self::Marked | Self::Host { reversed: true, .. } => {
                vk::CompareOp::GREATER_OR_EQUAL
            }
            Self::Host { reversed: false, .. } => vk::CompareOp::LESS_OR_EQUAL,
            Self::None | Self::Nearest | Self::Marking => vk::CompareOp::GREATER,
            Self::Always => vk::CompareOp::ALWAYS,
        };
        let stencil = self.stencil();
        vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self != Self::None)
            .depth_write_enable(self.writes())
            .depth_compare_op(compare)
            .stencil_test_enable(stencil.is_some())
            .front(stencil.unwrap_or_default())
            .back(stencil.unwrap_or_default())
    }

    fn writes(self) -> bool {
        !matches!(self, Self::None | Self::NotBehind | Self::Marked | Self::Host { write: false, .. })
    }

    fn stencil(self) -> Option<vk::StencilOpState> {
        let state = |compare_op, pass_op, write_mask| vk::StencilOpState {
            compare_op,
            pass_op,
            compare_mask: 1,
            write_mask,
            reference: 1,
            ..Default::default()
        };
        match self {
            Self::Marking => Some(state(vk::CompareOp::ALWAYS, vk::StencilOp::REPLACE, 1)),
            Self::Marked => Some(state(vk::CompareOp::EQUAL, vk::StencilOp::KEEP, 0)),
            Self::None | Self::Nearest | Self::NotBehind | Self::Always | Self::Host { .. } => None,
        }
    }
}

impl Blend {
    pub(super) fn info(self) -> vk::PipelineColorBlendAttachmentState {
        use vk::BlendFactor as Factor;
        // Factors of the source and of the target.
        let (colour, alpha) = match self {
            Self::Replace | Self::Add => ([Factor::ONE; 2], [Factor::ONE; 2]),
            Self::Over => {
                ([Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA], [Factor::ONE, Factor::ONE_MINUS_SRC_ALPHA])
            }
            Self::Multiply => ([Factor::ZERO, Factor::SRC_COLOR], [Factor::ZERO, Factor::ONE]),
        };
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)
            .blend_enable(self != Self::Replace)
            .src_color_blend_factor(colour[0])
            .dst_color_blend_factor(colour[1])
            .color_blend_op(vk::BlendOp::ADD)
            .src_alpha_blend_factor(alpha[0])
            .dst_alpha_blend_factor(alpha[1])
            .alpha_blend_op(vk::BlendOp::ADD)
    }
}
