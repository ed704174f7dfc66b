//! Effects of the papers' figures, and those that we claim beyond: the runs of each differ as expected.

use crate::support::gpu::{assert_silent, device};
use std::time::Duration;
use surfel::bench::papers::effects::{self, Effect};
use surfel::bench::papers::models::Models;
use surfel::bench::record::Run;
use surfel::bench::runner::{Options, Runner};
use surfel::bench::stopwatch::Effort;
use surfel::verify::truth;
use surfel::vk::DeviceLimits;

/// Expectations that are not met, by their effect and their index, each with the reason.
const NOT_MET: [(&str, usize); 1] = [
    // The scene's discs overlap more than those of coarser levels of detail, which the paper shows.
    ("overlap", 0),
];

/// Prints the values of every run, and checks that they differ as the papers say and as we claim.
fn check(name: &str) {
    let effect = Effect::named(name).unwrap();
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = truth::Options { error: 1.0 / 256.0, most_samples: 256, ..Default::default() };
    let effort = Effort { warmup: 1, least: 1, most: 1, budget: Duration::ZERO, until: None };
    let options = Options { device: Some(device.clone()), cache: None, truth, effort, ..Default::default() };
    let mut runner = Runner::new(options, Vec::new());
    let plans = effect.plans(&Models::default());
    let runs: Vec<Run> = plans.iter().map(|plan| runner.run(plan).unwrap()).collect();
    for run in &runs {
        let metrics = effect.metrics.iter().map(|metric| format!("{} {:?}", metric.label, metric.of(run)));
        let what = [run.implementation.label(), format!("--cutoff {}, {}", run.settings.cutoff, run.scene)];
        println!("{}: {}: {}", effect.name, what.join(", "), metrics.collect::<Vec<_>>().join(", "));
        assert_eq!(run.refused, None);
        assert!(effect.metrics.iter().all(|metric| metric.of(run).is_some()), "a metric is missing");
    }
    let runs: Vec<&Run> = runs.iter().collect();
    let expected = effect.expected.iter().map(|expected| &expected.relation);
    let mut failed = Vec::new();
    for (i, relation) in expected.chain(effect.claims).enumerate() {
        let holds = relation.holds(&runs) == Some(!NOT_MET.contains(&(effect.name, i)));
        println!("{}: {holds}: {}", effect.name, relation.words(&runs).unwrap_or_default());
        failed.extend((!holds).then_some(i));
    }
    assert_eq!(failed, [0; 0], "{}", effect.name);
    assert_silent(&device);
}

/// One test per effect, with its name.
macro_rules! effects {
    ($($(#[$attribute:meta])* $test:ident: $name:literal;)*) => {
        $(#[test] $(#[$attribute])* fn $test() { check($name); })*

        #[test]
        fn every_effect_has_a_test() {
            let tested = [$($name),*];
            let all = effects::all().filter(|effect| !effect.name.ends_with(" models"));
            let missing: Vec<_> = all.map(|effect| effect.name).filter(|name| !tested.contains(name)).collect();
            assert_eq!(missing, [""; 0]);
        }
    };
}

effects! {
    a_disc_is_exact_at_its_rim_or_at_its_centre: "isocontours";
    #[ignore = "takes long: tools/test --all"]
    footprints_that_are_right_at_their_centre_alone_leave_holes: "perspective-holes";
    #[ignore = "takes long: tools/test --all"]
    without_a_low_pass_filter_a_checkerboard_is_aliased: "moire-screen";
    discs_that_end_at_sharp_edges_keep_them_sharp: "clip-lines";
    #[ignore = "takes long: tools/test --all"]
    an_offset_along_the_axis_hides_too_much: "axis-offset";
    #[ignore = "takes long: tools/test --all"]
    without_normalization_brightness_varies: "no-normalization";
    #[ignore = "takes long: tools/test --all"]
    weights_of_surfels_are_comparable_on_a_checkerboard: "moire-object";
    #[ignore = "takes long: tools/test --all"]
    weights_of_surfels_fail_where_samples_are_irregular: "irregular";
    #[ignore = "takes long: tools/test --all"]
    squares_thicken_contours: "thickening";
    #[ignore = "takes long: tools/test --all"]
    blending_smooths_a_texture: "filtering";
    #[ignore = "takes long: tools/test --all"]
    sprites_at_their_centres_depth_blend_wrongly: "depth-correction";
    #[ignore = "takes long: tools/test --all"]
    wide_kernels_blur: "kernel-blur";
    #[ignore = "takes long: tools/test --all"]
    narrow_kernels_show_facets: "kernel-facets";
    #[ignore = "takes long: tools/test --all"]
    filters_add_to_the_overlap: "overlap";
    #[ignore = "takes long: tools/test --all"]
    box_weights_show_facets: "box-weights";
    #[ignore = "takes long: tools/test --all"]
    light_at_every_pixel_keeps_highlights_sharp: "deferred-shading";
    #[ignore = "takes long: tools/test --all"]
    a_ribbon_is_narrower_where_it_turns: "ribbon-width";
    #[ignore = "takes long: tools/test --all"]
    lines_are_thicker_than_triangles: "thin-lines";
    #[ignore = "takes long: tools/test --all"]
    sprites_leave_holes_under_strong_perspective: "perspective-methods";
    #[ignore = "takes long: tools/test --all"]
    means_of_all_around_let_hidden_surfaces_through: "layers";
    #[ignore = "takes long: tools/test --all"]
    sprites_of_whole_sizes_have_more_error: "whole-sizes";
    #[ignore = "takes long: tools/test --all"]
    a_ribbon_is_as_wide_as_it_is: "ribbon";
    #[ignore = "takes long: tools/test --all"]
    a_tube_is_round: "tubes";
    #[ignore = "takes long: tools/test --all"]
    a_branch_has_leaves: "leaf-and-branch";
    #[ignore = "takes long: tools/test --all"]
    a_tree_is_lines: "tree";
    #[ignore = "takes long: tools/test --all"]
    ten_trees_are_lines: "ten-trees";
    #[ignore = "takes long: tools/test --all"]
    points_lines_and_polygons_hide_each_other: "kinds";
    #[ignore = "takes long: tools/test --all"]
    triangles_go_on_as_points: "hybrid";
}
