//! Variant resources: the targets and passes of frames of one variant.

use super::pass::{Commands, Pass};
use super::pipelines::Pipelines;
use super::recording::PreparedPass;
use super::scene_variant::SceneVariant;
use super::targets::{HostBindings, RenderTargets};
use super::uniforms;
use super::variant::Variant;
use crate::error::Result;
use crate::scene::Scene;
use crate::vk::shaders::resource;
use crate::vk::{Binding, Buffer, DescriptorSet, Device, Framebuffer};
use std::sync::Arc;

/// Targets and passes of a variant.
pub struct VariantResources {
    /// Unique id.
    pub id: u64,
    pub variant: Variant,
    /// Variants of the scenes that the passes have pipelines for.
    pub(super) scenes: Vec<SceneVariant>,
    /// Id of the splat list in the passes' descriptor sets.
    pub(super) splats: u64,
    pub(super) passes: Vec<PreparedPass>,
    pub(super) view: ViewSet,
    pub targets: RenderTargets,
    pub readback: Vec<Buffer>,
    /// Keeps the buffer in the view's set alive.
    pub(super) _view: Arc<Buffer>,
}

/// Descriptor set 0 of passes over pixels.
pub(super) struct ViewSet {
    pub(super) set: DescriptorSet,
    /// The scene whose texture or materials it binds.
    pub(super) scene: Option<u64>,
}

impl VariantResources {
    /// A pass of this variant.
    pub fn pass(&self, pass: &'static Pass) -> Option<&PreparedPass> {
        self.passes.iter().find(|prepared| std::ptr::eq(prepared.pass, pass))
    }
}

/// Creates a pass without its pipelines.
pub(super) fn prepared(
    device: &Arc<Device>,
    pass: &'static Pass,
    pipelines: &mut Pipelines,
    current: &VariantResources,
    of_host: HostBindings<'_>,
) -> Result<PreparedPass> {
    let framebuffer = match (pipelines.render_pass(device, pass, &current.variant)?, &pass.commands) {
        (Some(into), Commands::Draws(targets)) => {
            Some(Framebuffer::new(device, &into, &targets.images(&current.targets))?)
        }
        _ => None,
    };
    let targets = current.targets.set(device, pass, of_host)?;
    Ok(PreparedPass { pass, accesses: Vec::new(), targets, framebuffer, pipelines: Vec::new() })
}

impl ViewSet {
    /// Creates the set, with the texture and materials of `scene` that the variant looks up.
    pub(super) fn new(
        device: &Arc<Device>,
        view: &Buffer,
        variant: &Variant,
        scene: Option<&Scene>,
    ) -> Result<Self> {
        let texture = scene.and_then(|scene| scene.texture.as_ref()).filter(|_| variant.texture.is_some());
        let materials = scene.and_then(|scene| scene.materials.as_ref()).filter(|_| variant.materials);
        let lookups = [
            texture.map(|texture| (&resource::TEXTURE, Binding::whole(&texture.buffer))),
            materials.map(|materials| (&resource::MATERIALS, Binding::whole(&materials.buffer))),
        ];
        let all: Vec<_> = uniforms::bindings(view).into_iter().chain(lookups.into_iter().flatten()).collect();
        Ok(Self { set: DescriptorSet::new(device, &all)?, scene: scene.map(|scene| scene.id) })
    }
}
