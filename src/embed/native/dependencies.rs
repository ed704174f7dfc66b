//! Subpass dependencies.

use super::Plan;
use super::plan::Step;
use ash::vk;
use vk::{AccessFlags as Access, PipelineStageFlags as Stages};

/// Stages and accesses of one side of a dependency.
type Scope = (Stages, Access);

const TESTS: Stages =
    Stages::from_raw(Stages::EARLY_FRAGMENT_TESTS.as_raw() | Stages::LATE_FRAGMENT_TESTS.as_raw());
const DEPTH: Scope = (
    TESTS,
    Access::from_raw(
        Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw() | Access::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
);
const COLOUR: Scope = (
    Stages::COLOR_ATTACHMENT_OUTPUT,
    Access::from_raw(Access::COLOR_ATTACHMENT_READ.as_raw() | Access::COLOR_ATTACHMENT_WRITE.as_raw()),
);
const INPUT: Scope = (Stages::FRAGMENT_SHADER, Access::INPUT_ATTACHMENT_READ);
/// Coverage, written to a buffer by fragment shaders.
const COVERS: Scope = (Stages::FRAGMENT_SHADER, Access::SHADER_WRITE);
const COVERED: Scope = (Stages::FRAGMENT_SHADER, Access::SHADER_READ);
const ANYTHING: Scope =
    (Stages::ALL_COMMANDS, Access::from_raw(Access::MEMORY_READ.as_raw() | Access::MEMORY_WRITE.as_raw()));

fn all(scopes: &[Scope]) -> Scope {
    scopes.iter().fold((Stages::empty(), Access::empty()), |(stages, access), scope| {
        (stages | scope.0, access | scope.1)
    })
}

pub(super) fn dependencies(plan: &Plan) -> Vec<vk::SubpassDependency> {
    let number = |step| plan.number(step);
    let normalize = plan.last();
    // The first subpass that finds surfaces, and the one that sums.
    let surface = number(Step::Visibility).or(number(Step::Nearest)).unwrap_or(normalize);
    let sums = number(Step::Attribute).unwrap_or(surface);
    let seed = number(Step::Seed);
    let outside = vk::SUBPASS_EXTERNAL;
    let drawn = all(&[COLOUR, DEPTH, INPUT]);
    let mut list = vec![
        // Consecutive frames use the same attachments.
        dependency([outside, seed.unwrap_or(surface)], all(&[DEPTH, INPUT]), DEPTH),
        dependency([outside, sums], all(&[COLOUR, INPUT]), COLOUR),
        dependency([surface, normalize], all(&[DEPTH, COVERS]), all(&[INPUT, COVERED])),
        dependency([sums, normalize], COLOUR, INPUT),
    ];
    if sums != surface {
        list.push(dependency([surface, sums], DEPTH, DEPTH));
    }
    let [before, after] = plan.host.subpasses;
    let earlier = if before == 0 { vec![(outside, ANYTHING)] } else { vec![] };
    for (host, done) in earlier.into_iter().chain((0..before).map(|host| (host, drawn))) {
        list.push(dependency([host, normalize], done, all(&[COLOUR, DEPTH])));
        list.extend(seed.map(|seed| dependency([host, seed], done, INPUT)));
    }
    if let Some(seed) = seed {
        list.push(dependency([seed, surface], DEPTH, DEPTH));
        list.push(dependency([seed, normalize], INPUT, DEPTH));
    }
    list.extend(
        (normalize + 1..=normalize + after)
            .map(|host| dependency([normalize, host], all(&[COLOUR, DEPTH]), all(&[COLOUR, DEPTH, INPUT]))),
    );
    list
}

/// A framebuffer-local dependency within the render pass.
fn dependency([from, to]: [u32; 2], before: Scope, after: Scope) -> vk::SubpassDependency {
    let within = from != vk::SUBPASS_EXTERNAL;
    vk::SubpassDependency {
        src_subpass: from,
        dst_subpass: to,
        src_stage_mask: before.0,
        src_access_mask: before.1,
        dst_stage_mask: after.0,
        dst_access_mask: after.1,
        dependency_flags: if within { vk::DependencyFlags::BY_REGION } else { vk::DependencyFlags::empty() },
    }
}
