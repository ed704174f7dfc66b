//! One file per pass, next to the shader of the same name: resources, shaders, and domain or attachments.
//!
//! Visibility, attribute, nearest and normalize have a compute and a raster pass, chosen by [`crate::Rasterizer`]; so has project for
//! surfels. Raster passes also run in subpasses of a host ([`crate::embed::native`]).

pub mod ambient;
pub mod attribute;
pub mod behind;
pub mod boxes;
pub mod copy;
pub mod covered;
pub mod cull;
pub mod edl;
pub mod fetch;
pub mod filled;
pub mod filter;
pub mod footprint;
pub mod hidden;
pub mod nearest;
pub mod normalize;
pub mod occlusion;
pub mod occupied;
pub mod open;
pub mod order;
pub mod project;
pub mod pull;
pub mod push;
pub mod seed;
pub mod shade;
pub mod sides;
pub mod surface;
pub mod visibility;

use crate::frame::pass::{Domain, Program};
use crate::frame::variant::Variant;
use crate::vk::shaders::{Module, constant};

/// Specialization constant id of the workgroup size of tile passes: LANES of `lib/workgroup.glsl`.
const LANES: u32 = 44;

/// Program of a tile pass: one module exchanges values through shared memory, the other by subgroup shuffles.
fn tiles(variant: &Variant, [shared, subgroups]: [&'static Module; 2]) -> Vec<Program> {
    let module = if variant.workgroup.subgroups { subgroups } else { shared };
    let program = Program::compute(module, Domain::Tiles)
        .with(LANES, variant.workgroup.lanes)
        .with(constant::LIMITED_LOOPS, variant.workgroup.limited_loops);
    vec![Program { is_subgroup: variant.workgroup.subgroups, ..program }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::RenderOptions;
    use crate::frame::methods::{Path, passes};
    use crate::frame::pass::{Pass, Programs};
    use crate::frame::resource::Resource;
    use crate::frame::scene_variant::SceneVariant;
    use crate::frame::variant::Variant;
    use crate::scene::{ColourStream, PrimitiveKinds, Streams, SurfelLayout};
    use crate::settings::Rasterizer;
    use crate::settings::methods::Method;
    use crate::settings::splatting::Visibility;
    use crate::settings::{Alpha, Outputs, Settings};
    use std::collections::BTreeSet;

    /// The passes of all methods on all paths, in frames with scenes.
    fn all() -> Vec<&'static Pass> {
        let paths = [Path::Compute, Path::Raster, Path::Subpasses { seed: true }];
        let mut all: Vec<&'static Pass> = Vec::new();
        for (variant, method) in
            variants().iter().flat_map(|variant| Method::ALL.map(|method| (variant, method)))
        {
            for (visibility, split) in
                [(method.splatting.visibility, false), (Visibility::Ray, true), (Visibility::Axis, true)]
            {
                for (primitives, count) in [(false, false), (false, true), (true, true)] {
                    let pull_push = method.pull_push;
                    let frame = Variant {
                        visibility,
                        split,
                        pull_push,
                        primitives,
                        count,
                        ao: count,
                        edl: count,
                        ..variant.frame
                    };
                    for pass in paths.iter().flat_map(|path| passes(&frame, *path)) {
                        if !all.iter().any(|known| std::ptr::eq(*known, pass)) {
                            all.push(pass);
                        }
                    }
                }
            }
        }
        assert!(all.len() >= 24, "{} passes", all.len());
        all
    }

    const RESOURCES: [Resource; 33] = [
        Resource::VisibleClusters,
        Resource::Order,
        Resource::Splats,
        Resource::Boxes,
        Resource::ScreenClips,
        Resource::Counts,
        Resource::LargeTriangles,
        Resource::Visibility,
        Resource::Sums0,
        Resource::Sums1,
        Resource::Attributes,
        Resource::CoveredTiles,
        Resource::OpenTiles,
        Resource::Coverage,
        Resource::Nearest,
        Resource::EdgeTiles,
        Resource::RevealedTiles,
        Resource::OccupiedTiles,
        Resource::FilledTiles,
        Resource::HiddenClusters,
        Resource::Behind,
        Resource::NearestDepth,
        Resource::NearestId,
        Resource::Pulled,
        Resource::Pushed,
        Resource::Image,
        Resource::Occlusion,
        Resource::Filtered,
        Resource::Normal,
        Resource::Depth,
        Resource::Id,
        Resource::IncompleteFrame,
        Resource::HostDepth,
    ];

    /// Variants with all optional features, and with none.
    fn variants() -> Vec<SceneVariant> {
        let mut list = Vec::new();
        for rich in [false, true] {
            let streams = Streams {
                ellipses: rich,
                curvatures: rich,
                two_sided: rich,
                billboards: rich,
                clips: rich,
                weights: rich.then_some(true),
                colours: if rich { ColourStream::Linear } else { ColourStream::None },
                primitives: PrimitiveKinds { lines: rich, triangles: rich, colours: ColourStream::None },
                texture: None,
                materials: rich,
                layout: SurfelLayout::side_by_side(ColourStream::None),
                unchecked: rich,
                unordered: rich,
                clusters: rich,
                levels: rich,
            };
            for (alpha, rasterizer) in [Alpha::Mask, Alpha::Coverage]
                .into_iter()
                .flat_map(|alpha| [(alpha, Rasterizer::Draw), (alpha, Rasterizer::Compute)])
            {
                for pull_push in [None, crate::settings::methods::pull_push::METHOD.pull_push] {
                    let settings = Settings { alpha, pull_push, ..Default::default() };
                    let outputs = Outputs { normal: rich, depth: rich, id: rich };
                    let options = RenderOptions { count: rich, outputs, ..Default::default() };
                    let frame = Variant::new(&[streams], true, &settings, &options, rasterizer);
                    list.push(SceneVariant::new(frame, streams, rich));
                    list.push(SceneVariant::new(frame.with_slices(true), streams, rich));
                    list.push(SceneVariant::new(frame.with_occlusion_culling(1, 0), streams, rich));
                }
            }
        }
        list
    }

    fn programs(pass: &Pass, variant: &SceneVariant) -> Vec<Program> {
        match pass.programs {
            Programs::OfFrame(programs) => programs(&variant.frame),
            Programs::OfScene(programs) => programs(variant),
        }
    }

    /// What passes of several steps bind otherwise than they declare: boxes read a list that other passes write through the same declaration,
    /// and pyramids change places from level to level. Barriers of steps are tested by `tests/embed/barriers.rs`.
    const BY_STEPS: [(&str, Resource); 6] = [
        ("boxes", Resource::RevealedTiles),
        ("copy", Resource::Pulled),
        ("copy", Resource::Pushed),
        ("push", Resource::Pulled),
        ("push", Resource::Pushed),
        ("shade", Resource::Pulled),
    ];

    #[test]
    fn passes_declare_what_their_shaders_read_and_write() {
        let mut wrong = BTreeSet::new();
        for pass in all() {
            let mut bindings = Vec::new();
            for program in variants().iter().flat_map(|variant| programs(pass, variant)) {
                for (declared, writes) in program.modules().iter().flat_map(|module| module.resources) {
                    let known = RESOURCES.iter().find(|resource| resource.is_bound_as(declared));
                    bindings.extend(known.map(|resource| (*resource, *writes)));
                }
            }
            for (resource, writes) in &bindings {
                let list = if *writes { pass.writes } else { pass.reads };
                if !list.contains(resource) && !BY_STEPS.contains(&(pass.name, *resource)) {
                    wrong.insert(format!("{} does not declare {resource:?}, written: {writes}", pass.name));
                }
            }
            for resource in pass.reads.iter().chain(pass.writes) {
                let is_declared = bindings.iter().any(|(declared, _)| declared == resource);
                if !is_declared && !BY_STEPS.contains(&(pass.name, *resource)) {
                    wrong.insert(format!(
                        "{} declares {resource:?}, which none of its shaders declares",
                        pass.name
                    ));
                }
            }
            let is_written = |cleared: &Resource| all().iter().any(|pass| pass.writes.contains(cleared));
            assert!(pass.clears.iter().all(is_written), "{}", pass.name);
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
    }

    #[test]
    fn a_pass_has_the_name_of_its_shader() {
        for pass in all() {
            for program in variants().iter().flat_map(|variant| programs(pass, variant)) {
                for module in program.modules() {
                    let drawn = pass.name == "project" && module.name.starts_with("points_");
                    assert!(
                        module.name.starts_with(pass.name) || drawn,
                        "{} runs {}",
                        pass.name,
                        module.name
                    );
                }
            }
        }
    }
}
