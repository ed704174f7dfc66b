//! Plan: the attachments, subpasses and dependencies that the engine adds to a host's render pass.

use super::HostRenderPass;
use super::dependencies::dependencies;
use crate::error::{Error, Result};
use crate::frame::RenderOptions;
use crate::frame::rasterizer::{Fit, rasterizer_for, width_of_sums};
use crate::frame::target_descriptions::sums_format;
use crate::frame::variant::Variant;
use crate::scene::Streams;
use crate::settings::splatting::Visibility;
use crate::settings::{Outputs, Precision, Rasterizer, Settings};
use crate::vk::{Device, input_layout};
use ash::vk;

/// The engine's additions to a host's render pass, each after the host's own.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The host's part of the render pass.
    pub(super) host: HostSide,
    pub(super) formats: PlanFormats,
    pub(super) precision: Precision,
    /// The steps, one per subpass.
    pub(super) steps: Vec<Step>,
    attachments: Vec<vk::AttachmentDescription>,
    references: Vec<References>,
}

/// The part of a [`HostRenderPass`] that a plan keeps.
#[derive(Clone, Copy, Debug)]
pub(super) struct HostSide {
    /// Number of the host's attachments.
    attachments: u32,
    /// Number of the host's subpasses before and after.
    pub(super) subpasses: [u32; 2],
    pub(super) samples: vk::SampleCountFlags,
    picture: u32,
    resolve: Option<u32>,
    pub(super) normal: Option<u32>,
    depth: Option<(u32, vk::Format)>,
    pub(super) reversed: Option<bool>,
    pub(super) encode: bool,
}

/// Formats of the engine's attachments.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanFormats {
    pub(super) visibility: vk::Format,
    pub(super) sums0: vk::Format,
    pub(super) sums1: Option<vk::Format>,
}

/// A subpass. Shaders, labels and documents use the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    Seed,
    Visibility,
    Attribute,
    Nearest,
    Normalize,
}

/// Attachment references of a subpass.
#[derive(Clone, Debug, Default)]
struct References {
    colours: Vec<vk::AttachmentReference>,
    resolves: Vec<vk::AttachmentReference>,
    inputs: Vec<vk::AttachmentReference>,
    depth: Option<vk::AttachmentReference>,
    preserved: Vec<u32>,
}

impl Plan {
    /// Creates a plan for scenes with these streams ([`Scene::streams`](crate::Scene::streams)) and settings in the render pass
    /// `host_pass`. Frames that need a part of it only can use it, too. Returns an error for unsupported passes and settings.
    pub fn new(
        device: &Device,
        host_pass: &HostRenderPass<'_>,
        precision: Precision,
        frames: &[(Streams, &Settings)],
    ) -> Result<Self> {
        host_pass.check(device)?;
        let host = HostSide::of(host_pass);
        let options = host.options([1, 1], precision);
        let variants: Vec<_> = frames
            .iter()
            .map(|(streams, settings)| variant(device, &options, *streams, settings))
            .collect::<Result<_>>()?;
        let Some(first) = variants.first() else {
            return Err(Error::Usage("the plan has no frames: give scenes and settings".into()));
        };
        let blends = |variant: &Variant| variant.visibility != Visibility::Nearest;
        if variants.iter().any(|variant| blends(variant) != blends(first)) {
            return Err(Error::Usage(
                "frames that blend splats and frames that show the nearest one only have different subpasses: make a plan for each".into(),
            ));
        }
        let seeds = host_pass.depth.is_some_and(|depth| depth.seed);
        let formats = PlanFormats::of(&variants, seeds && blends(first));
        let last = if blends(first) {
            &[Step::Visibility, Step::Attribute, Step::Normalize][..]
        } else {
            &[Step::Nearest, Step::Normalize]
        };
        let steps: Vec<_> = seeds.then_some(Step::Seed).into_iter().chain(last.iter().copied()).collect();
        let mut plan = Self {
            host,
            formats,
            precision,
            attachments: formats.attachments(&steps),
            references: Vec::new(),
            steps,
        };
        plan.references = plan.steps.iter().map(|step| plan.references(*step)).collect();
        Ok(plan)
    }

    /// Attachments to append to the host's. The framebuffer's views follow in the same order
    /// ([`Renderer::resize`](super::Renderer::resize)).
    pub fn attachments(&self) -> &[vk::AttachmentDescription] {
        &self.attachments
    }

    /// Clear values of these attachments.
    pub fn clear_values(&self) -> Vec<vk::ClearValue> {
        vec![vk::ClearValue::default(); self.attachments.len()]
    }

    /// Subpasses to insert after the host's first ones. They preserve all attachments of the host.
    pub fn subpasses(&self) -> Vec<vk::SubpassDescription<'_>> {
        self.references.iter().map(References::describe).collect()
    }

    /// Dependencies among these subpasses, and between them and the host's subpasses before and after, for the host's picture, normals and
    /// depth. All other dependencies of the render pass are the host's.
    pub fn dependencies(&self) -> Vec<vk::SubpassDependency> {
        dependencies(self)
    }

    /// Index of the engine's last subpass, which writes the host's attachments.
    pub fn last(&self) -> u32 {
        self.number(Step::Normalize).unwrap_or_default()
    }

    /// Format of the host's depth, if there is a seed.
    pub(super) fn seeded(&self) -> Option<vk::Format> {
        self.host.depth.map(|(_, format)| format).filter(|_| self.steps.contains(&Step::Seed))
    }

    /// Whether visibility marks its pixels in the stencil.
    pub(super) fn marks(&self) -> bool {
        self.formats.visibility == vk::Format::D32_SFLOAT_S8_UINT
    }

    /// Whether pixels without visibility have no sums; otherwise the last subpass reads visibility.
    pub(super) fn visible_by_sums(&self) -> bool {
        self.marks() || self.steps.contains(&Step::Nearest)
    }

    /// Index of a step's subpass.
    pub(super) fn number(&self, step: Step) -> Option<u32> {
        let found = self.steps.iter().position(|found| *found == step)?;
        Some(self.host.subpasses[0] + found as u32)
    }

    /// The steps with their subpass indices.
    pub(super) fn numbered(&self) -> impl Iterator<Item = (u32, Step)> {
        (self.host.subpasses[0]..).zip(self.steps.iter().copied())
    }

    /// Render options of the frames.
    pub(super) fn options(&self, size: [u32; 2]) -> RenderOptions {
        self.host.options(size, self.precision)
    }

    /// Returns an error for frames that need more than the plan has.
    pub(super) fn check(&self, variant: &Variant) -> Result<()> {
        let refuse = |needed: &str| {
            Err(Error::Usage(format!(
                "the frame needs {needed}, which the plan does not include: create it for such frames, too"
            )))
        };
        if (variant.visibility == Visibility::Nearest) != self.steps.contains(&Step::Nearest) {
            return refuse(if variant.visibility == Visibility::Nearest {
                "a subpass for the nearest splat only"
            } else {
                "subpasses that blend splats"
            });
        }
        let needed = PlanFormats::of(&[*variant], self.marks());
        if wider(needed.sums0, self.formats.sums0) != self.formats.sums0 {
            return refuse("sums of normals or colours");
        }
        match (needed.sums1, self.formats.sums1) {
            (Some(_), None) => refuse("sums of depths, or of colours beside normals"),
            (Some(needed), Some(there)) if wider(needed, there) != there => {
                refuse("sums of colours beside normals")
            }
            _ => Ok(()),
        }
    }

    fn references(&self, step: Step) -> References {
        use vk::ImageLayout as Layout;
        let HostSide { attachments: first, picture, resolve, normal, depth, .. } = self.host;
        let depth = depth.map(|(attachment, _)| attachment);
        let [visibility, sums0, sums1] = [first, first + 1, first + 2];
        let sums1 = self.formats.sums1.map(|_| sums1);
        let drawn = |attachment| optional(attachment, Layout::COLOR_ATTACHMENT_OPTIMAL);
        let tested = |attachment| reference(attachment, Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        let kept = |attachment| reference(attachment, Layout::DEPTH_STENCIL_READ_ONLY_OPTIMAL);
        let read = |attachment| reference(attachment, Layout::SHADER_READ_ONLY_OPTIMAL);
        let sums = vec![drawn(Some(sums0)), drawn(sums1)];
        let mut all = match step {
            Step::Seed => References {
                inputs: depth.map(kept).into_iter().collect(),
                depth: Some(tested(visibility)),
                ..Default::default()
            },
            Step::Visibility => References { depth: Some(tested(visibility)), ..Default::default() },
            Step::Attribute => {
                References { colours: sums, depth: Some(kept(visibility)), ..Default::default() }
            }
            Step::Nearest => {
                References { colours: sums, depth: Some(tested(visibility)), ..Default::default() }
            }
            Step::Normalize => References {
                colours: vec![drawn(Some(picture)), drawn(normal)],
                resolves: resolve.map_or(Vec::new(), |resolve| vec![drawn(Some(resolve)), drawn(None)]),
                inputs: [
                    if self.visible_by_sums() { optional(None, Layout::UNDEFINED) } else { kept(visibility) },
                    read(sums0),
                ]
                .into_iter()
                .chain(sums1.map(read))
                .collect(),
                depth: depth.map(tested),
                ..Default::default()
            },
        };
        all.preserved = (0..first).filter(|attachment| !all.names(*attachment)).collect();
        all
    }
}

impl References {
    fn names(&self, attachment: u32) -> bool {
        let all = [&self.colours, &self.resolves, &self.inputs];
        all.into_iter().flatten().chain(&self.depth).any(|found| found.attachment == attachment)
    }

    fn describe(&self) -> vk::SubpassDescription<'_> {
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&self.colours)
            .input_attachments(&self.inputs)
            .preserve_attachments(&self.preserved);
        if !self.resolves.is_empty() {
            subpass = subpass.resolve_attachments(&self.resolves);
        }
        match &self.depth {
            Some(depth) => subpass.depth_stencil_attachment(depth),
            None => subpass,
        }
    }
}

impl HostSide {
    /// Render options of the frames.
    fn options(&self, size: [u32; 2], precision: Precision) -> RenderOptions {
        let outputs = Outputs { normal: self.normal.is_some(), depth: self.depth.is_some(), id: false };
        RenderOptions { size, outputs, precision, rasterizer: Rasterizer::Draw.into(), ..Default::default() }
    }

    fn of(host_pass: &HostRenderPass<'_>) -> Self {
        Self {
            attachments: host_pass.attachments.len() as u32,
            subpasses: host_pass.subpasses,
            samples: host_pass.samples(),
            picture: host_pass.picture,
            resolve: host_pass.resolve,
            normal: host_pass.normal,
            depth: host_pass.depth.map(|depth| (depth.attachment, host_pass.format(depth.attachment))),
            reversed: host_pass.depth.map(|depth| depth.reversed),
            encode: host_pass.encode,
        }
    }
}

impl PlanFormats {
    /// Formats that suffice for all of `variants`, with or without a stencil.
    fn of(variants: &[Variant], marks: bool) -> Self {
        let sums0 = variants.iter().map(|variant| sums_format(variant.precision, variant.wide_sums0()));
        let sums1 = variants.iter().filter(|variant| variant.has_sums1());
        let sums1 = sums1.map(|variant| sums_format(variant.precision, variant.wide_sums1()));
        Self {
            visibility: if marks { vk::Format::D32_SFLOAT_S8_UINT } else { vk::Format::D32_SFLOAT },
            sums0: sums0.reduce(wider).unwrap_or_default(),
            sums1: sums1.reduce(wider),
        }
    }

    pub(super) fn list(&self) -> impl Iterator<Item = vk::Format> {
        [self.visibility, self.sums0].into_iter().chain(self.sums1)
    }

    /// The attachments: cleared, not stored.
    fn attachments(&self, steps: &[Step]) -> Vec<vk::AttachmentDescription> {
        let ends = |format| match format {
            // The layout of the last subpass that refers to it.
            vk::Format::D32_SFLOAT if steps.contains(&Step::Nearest) => {
                vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL
            }
            format => input_layout(format),
        };
        let describe = |format| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::DONT_CARE)
                .stencil_load_op(vk::AttachmentLoadOp::CLEAR)
                .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                .initial_layout(vk::ImageLayout::UNDEFINED)
                .final_layout(ends(format))
        };
        self.list().map(describe).collect()
    }
}

/// The wider of two formats of sums.
fn wider(a: vk::Format, b: vk::Format) -> vk::Format {
    let wide = [vk::Format::R32G32B32A32_SFLOAT, vk::Format::R16G16B16A16_SFLOAT];
    if wide.contains(&a) { a } else { b }
}

fn reference(attachment: u32, layout: vk::ImageLayout) -> vk::AttachmentReference {
    vk::AttachmentReference { attachment, layout }
}

fn optional(attachment: Option<u32>, layout: vk::ImageLayout) -> vk::AttachmentReference {
    match attachment {
        Some(attachment) => reference(attachment, layout),
        None => reference(vk::ATTACHMENT_UNUSED, vk::ImageLayout::UNDEFINED),
    }
}

/// Returns an error for methods that do not draw splats.
pub(super) fn check_method(settings: &Settings) -> Result<()> {
    match settings.pull_push {
        None => Ok(()),
        Some(_) => Err(Error::Usage(
            "pull-push computes pyramids, which is not possible inside a render pass: use `embed::Renderer`, or choose a method that draws splats"
                .into(),
        )),
    }
}

fn variant(
    device: &Device,
    options: &RenderOptions,
    streams: Streams,
    settings: &Settings,
) -> Result<Variant> {
    check_method(settings)?;
    settings.check()?;
    settings.splatting.normalization.check_weights(streams.weights.is_some())?;
    settings.check_primitives(streams.primitives.any())?;
    let (rasterizer, _) = rasterizer_for(device, options, settings.alpha, Fit::ALL)?;
    let options = RenderOptions { precision: width_of_sums(device, options, rasterizer), ..*options };
    Ok(Variant::new(&[streams], true, &settings.in_subpasses(), &options, rasterizer))
}
