//! Passes in the subpasses of a plan.

use super::plan::{Plan, Step};
use crate::embed::drawn_alpha::DrawnAlpha;
use crate::frame::pass::Pass;
use crate::frame::passes::{attribute, nearest, normalize, seed, visibility};
use crate::frame::pipelines::{Host, HostDraw};
use crate::vk::shaders::{self, SEED_MULTISAMPLED_FRAGMENT, constant, resource};
use crate::vk::{Blend, Constants, DepthTest, Within};
use ash::vk;

impl Step {
    /// The pass of a step.
    pub(super) fn pass(self) -> &'static Pass {
        match self {
            Self::Seed => &seed::SEED,
            Self::Visibility => &visibility::RASTER,
            Self::Attribute => &attribute::RASTER,
            Self::Nearest => &nearest::RASTER,
            Self::Normalize => &normalize::IN_SUBPASS,
        }
    }
}

/// The pipelines' places in the render pass of `plan`.
///
/// # Safety
/// `pass` is as `plan` describes it, and outlives all pipelines that are created for it.
pub(super) unsafe fn host(plan: &Plan, pass: vk::RenderPass) -> Host {
    let draws = |(subpass, step)| {
        let one = vk::SampleCountFlags::TYPE_1;
        let samples = if step == Step::Normalize { plan.host.samples } else { one };
        let multisampled = step == Step::Seed && plan.host.samples != one;
        drawn(plan, step).iter().map(move |drawn| HostDraw {
            pass: step.pass(),
            // SAFETY: by the caller.
            within: unsafe { Within::subpass((pass, subpass), &blends(plan, step, *drawn), samples) },
            depth: depth_test(plan, step, *drawn),
            constants: constants(plan, step, *drawn),
            fragment: multisampled.then_some(&SEED_MULTISAMPLED_FRAGMENT),
            is_of_coverage: *drawn == DrawnAlpha::LeastCovered,
        })
    };
    Host { draws: plan.numbered().flat_map(draws).collect(), resources: inputs(plan) }
}

/// The draws of a step: the last writes to the host's attachments.
fn drawn(plan: &Plan, step: Step) -> &'static [DrawnAlpha] {
    let more = plan.host.reversed.is_some() || plan.host.normal.is_some();
    DrawnAlpha::of_frame(step == Step::Normalize && more, true)
}

/// Input attachments and buffers of the shaders.
pub(super) fn inputs(plan: &Plan) -> Vec<&'static shaders::Resource> {
    let visibility = (!plan.visible_by_sums()).then_some(&resource::VISIBILITY_INPUT);
    let sums1 = plan.formats.sums1.map(|_| &resource::SUMS1_INPUT);
    let depth = plan.seeded().map(|_| &resource::HOST_DEPTH);
    [visibility, Some(&resource::SUMS0_INPUT), sums1, depth].into_iter().flatten().collect()
}

fn blends(plan: &Plan, step: Step, drawn: DrawnAlpha) -> Vec<Option<Blend>> {
    match step {
        Step::Seed | Step::Visibility => Vec::new(),
        Step::Attribute => vec![Some(Blend::Add); 2],
        Step::Nearest => vec![Some(Blend::Replace); 2],
        // Without a normal attachment, all blending is like the picture's: independent blending needs a feature.
        Step::Normalize if plan.host.normal.is_some() => {
            vec![Some(Blend::Over), (drawn != DrawnAlpha::LeastCovered).then_some(Blend::Replace)]
        }
        Step::Normalize => vec![Some(Blend::Over); 2],
    }
}

fn depth_test(plan: &Plan, step: Step, drawn: DrawnAlpha) -> DepthTest {
    match step {
        Step::Seed => DepthTest::Always,
        Step::Visibility if plan.marks() => DepthTest::Marking,
        Step::Visibility | Step::Nearest => DepthTest::Nearest,
        Step::Attribute if plan.marks() => DepthTest::Marked,
        Step::Attribute => DepthTest::NotBehind,
        Step::Normalize => drawn.depth_test(plan.host.reversed, true),
    }
}

fn constants(plan: &Plan, step: Step, drawn: DrawnAlpha) -> Constants {
    match step {
        Step::Seed => Constants::default().with(constant::HOST_SAMPLES, plan.host.samples.as_raw()),
        Step::Normalize => drawn
            .add_to(Constants::default())
            .with(constant::VISIBLE_BY_SUMS, plan.visible_by_sums())
            .with(constant::HOST_DEPTH, plan.host.reversed.is_some())
            .with(constant::ENCODE, plan.host.encode),
        Step::Visibility | Step::Attribute | Step::Nearest => Constants::default(),
    }
}
