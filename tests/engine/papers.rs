//! Effects of the papers' figures: the runs of each effect differ as expected.

use crate::support::gpu::{assert_silent, device};
use std::time::Duration;
use surfel::bench::papers::effects::{ALL, Effect, value};
use surfel::bench::record::Run;
use surfel::bench::runner::{Options, Runner};
use surfel::bench::stopwatch::Effort;
use surfel::verify::truth;
use surfel::vk::DeviceLimits;

/// Prints the values of every run, and checks that they differ as in the paper.
fn check(name: &str) {
    let effect = Effect::named(name).unwrap();
    let Some(device) = device(DeviceLimits::default()) else { return };
    let truth = truth::Options { error: 1.0 / 256.0, most_samples: 256, ..Default::default() };
    let effort = Effort { warmup: 1, least: 1, most: 1, budget: Duration::ZERO, until: None };
    let options = Options { device: Some(device.clone()), cache: None, truth, effort, ..Default::default() };
    let mut runner = Runner::new(options, Vec::new());
    let runs: Vec<Run> = effect.plans().iter().map(|plan| runner.run(plan).unwrap()).collect();
    for run in &runs {
        let metrics = effect.metrics.iter().map(|(name, label)| format!("{label} {:?}", value(run, name)));
        let what = [run.implementation.label(), format!("--cutoff {}, {}", run.settings.cutoff, run.scene)];
        println!("{}: {}: {}", effect.name, what.join(", "), metrics.collect::<Vec<_>>().join(", "));
        assert_eq!(run.refused, None);
    }
    let runs: Vec<&Run> = runs.iter().collect();
    for expected in effect.expected {
        assert_eq!(expected.holds(&runs), Some(true), "{}: {expected:?}", effect.name);
    }
    assert_silent(&device);
}

/// One test per effect, with its name.
macro_rules! effects {
    ($($(#[$attribute:meta])* $test:ident: $name:literal;)*) => {
        $(#[test] $(#[$attribute])* fn $test() { check($name); })*

        #[test]
        fn every_effect_has_a_test() {
            let tested = [$($name),*];
            assert!(ALL.iter().all(|effect| effect.name == "clip-lines" || tested.contains(&effect.name)));
        }
    };
}

effects! {
    an_offset_along_the_axis_hides_too_much: "axis-offset";
    squares_thicken_contours: "thickening";
    footprints_that_are_right_at_their_centre_alone_leave_holes: "perspective-holes";
    #[ignore = "takes long: tools/test --all"]
    without_a_low_pass_filter_a_checkerboard_flickers: "moire";
    #[ignore = "takes long: tools/test --all"]
    wide_kernels_blur: "kernel-blur";
    narrow_kernels_show_facets: "kernel-facets";
    filters_add_to_the_overlap: "overlap";
    #[ignore = "takes long: tools/test --all"]
    without_normalization_brightness_varies: "no-normalization";
    means_of_all_around_let_hidden_surfaces_through: "layers";
    #[ignore = "takes long: tools/test --all"]
    sprites_of_whole_sizes_are_too_large: "whole-sizes";
    #[ignore = "takes long: tools/test --all"]
    a_ribbon_is_as_wide_as_it_is: "ribbon";
    #[ignore = "takes long: tools/test --all"]
    a_tube_is_round: "tubes";
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

#[test]
fn discs_that_end_at_sharp_edges_keep_them_sharp() {
    check("clip-lines");
}
