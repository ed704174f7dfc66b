//! Resource accesses of passes.

use super::{Buffer, Image};
use ash::vk;

/// An access: pipeline stages, access mask and image layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    pub(super) stages: vk::PipelineStageFlags,
    pub(super) mask: vk::AccessFlags,
    pub(super) layout: vk::ImageLayout,
    pub(super) write: bool,
}

impl Access {
    /// Storage write, and possibly read, in a compute shader.
    pub const COMPUTE_WRITE: Self = Self::buffer(
        vk::PipelineStageFlags::COMPUTE_SHADER,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::SHADER_WRITE.as_raw(),
        ),
        true,
    );
    /// Storage read in a compute shader.
    pub const COMPUTE_READ: Self =
        Self::buffer(vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_READ, false);
    /// Storage read in a vertex shader.
    pub const VERTEX_READ: Self =
        Self::buffer(vk::PipelineStageFlags::VERTEX_SHADER, vk::AccessFlags::SHADER_READ, false);
    /// Image fetch in a compute shader.
    pub const COMPUTE_FETCH: Self =
        Self { layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, ..Self::COMPUTE_READ };
    /// Image fetch in a fragment shader.
    pub const FRAGMENT_READ: Self = Self {
        stages: vk::PipelineStageFlags::FRAGMENT_SHADER,
        mask: vk::AccessFlags::SHADER_READ,
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        write: false,
    };
    /// Buffer read in a fragment shader.
    pub const FRAGMENT_LOAD: Self =
        Self::buffer(vk::PipelineStageFlags::FRAGMENT_SHADER, vk::AccessFlags::SHADER_READ, false);
    /// Buffer write, and possibly read, in a fragment shader.
    pub const FRAGMENT_WRITE: Self = Self::buffer(
        vk::PipelineStageFlags::FRAGMENT_SHADER,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::SHADER_WRITE.as_raw(),
        ),
        true,
    );
    /// Colour attachment write; old contents are discarded.
    pub const COLOUR_WRITE: Self = Self {
        stages: vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        write: true,
    };
    /// Depth attachment write; old contents are discarded.
    pub const DEPTH_WRITE: Self = Self {
        stages: DEPTH_STAGES,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        write: true,
    };
    /// Depth test without writes. The store operation at the end of the render pass counts as a write, so later accesses must wait for it.
    pub const DEPTH_TEST: Self = Self {
        stages: DEPTH_STAGES,
        mask: vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        write: false,
    };
    /// Transfer source.
    pub const COPY_READ: Self = Self {
        stages: vk::PipelineStageFlags::TRANSFER,
        mask: vk::AccessFlags::TRANSFER_READ,
        layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        write: false,
    };
    /// Transfer destination, or fill.
    pub const COPY_WRITE: Self =
        Self::buffer(vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE, true);
    /// Transfer destination of an image; old contents are discarded.
    #[cfg(feature = "window")]
    pub const SCALE_WRITE: Self = Self { layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL, ..Self::COPY_WRITE };
    /// Storage read in any shader.
    pub const SHADER_READ: Self = Self::buffer(SHADER_STAGES, vk::AccessFlags::SHADER_READ, false);
    /// Uniform read in any shader.
    pub const UNIFORM_READ: Self = Self::buffer(SHADER_STAGES, vk::AccessFlags::UNIFORM_READ, false);
    /// Host read after the frame.
    pub const HOST_READ: Self = Self::buffer(vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ, false);

    /// Storage read, or with `write` also write, in these shader stages.
    pub fn of_shader(shaders: vk::ShaderStageFlags, write: bool) -> Self {
        let pairs = [
            (vk::ShaderStageFlags::COMPUTE, vk::PipelineStageFlags::COMPUTE_SHADER),
            (vk::ShaderStageFlags::VERTEX, vk::PipelineStageFlags::VERTEX_SHADER),
            (vk::ShaderStageFlags::FRAGMENT, vk::PipelineStageFlags::FRAGMENT_SHADER),
        ];
        let all = pairs.iter().filter(|(shader, _)| shaders.contains(*shader)).map(|(_, stage)| *stage);
        let stages = all.fold(vk::PipelineStageFlags::empty(), |stages, stage| stages | stage);
        let written = if write { vk::AccessFlags::SHADER_WRITE } else { vk::AccessFlags::empty() };
        Self::buffer(stages, vk::AccessFlags::SHADER_READ | written, write)
    }

    /// The same access to an image, if it is one of a buffer: shaders fetch from images, or store to them.
    pub fn of_image(self) -> Self {
        match self.layout {
            vk::ImageLayout::UNDEFINED if self.write => Self { layout: vk::ImageLayout::GENERAL, ..self },
            vk::ImageLayout::UNDEFINED => Self { layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, ..self },
            _ => self,
        }
    }

    /// The same access to an image that compute shaders load from and store to, if it is one of a buffer.
    pub fn of_stored_image(self) -> Self {
        if self.layout == vk::ImageLayout::UNDEFINED { self.in_general() } else { self }
    }

    /// The same access to an image of [`super::ImageUse::Stored`].
    pub fn in_general(self) -> Self {
        Self { layout: vk::ImageLayout::GENERAL, ..self }
    }

    /// The access of a buffer that also holds the workgroups of an indirect dispatch.
    pub fn and_indirect(self) -> Self {
        Self {
            stages: self.stages | vk::PipelineStageFlags::DRAW_INDIRECT,
            mask: self.mask | vk::AccessFlags::INDIRECT_COMMAND_READ,
            ..self
        }
    }

    /// Pipeline stages.
    pub const fn stages(self) -> vk::PipelineStageFlags {
        self.stages
    }

    /// Access mask.
    pub const fn mask(self) -> vk::AccessFlags {
        self.mask
    }

    const fn buffer(stages: vk::PipelineStageFlags, mask: vk::AccessFlags, write: bool) -> Self {
        Self { stages, mask, layout: vk::ImageLayout::UNDEFINED, write }
    }
}

const DEPTH_STAGES: vk::PipelineStageFlags = vk::PipelineStageFlags::from_raw(
    vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
        | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
);

pub(super) const SHADER_STAGES: vk::PipelineStageFlags = vk::PipelineStageFlags::from_raw(
    vk::PipelineStageFlags::VERTEX_SHADER.as_raw()
        | vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw()
        | vk::PipelineStageFlags::COMPUTE_SHADER.as_raw(),
);

/// A resource and its access by a pass.
#[derive(Clone, Copy)]
pub struct Use {
    pub(super) resource: Resource,
    pub(super) access: Access,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Resource {
    Buffer(vk::Buffer),
    Image(vk::Image, vk::ImageAspectFlags),
}

impl Buffer {
    /// An access to the buffer.
    pub fn with(&self, access: Access) -> Use {
        Use { resource: Resource::Buffer(self.raw), access }
    }
}

impl Image {
    /// An access to the image.
    pub fn with(&self, access: Access) -> Use {
        Use { resource: Resource::Image(self.raw, self.aspect()), access }
    }
}
