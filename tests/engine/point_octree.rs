//! Cuts of the point octree stay near the exact picture, and near that of all points.

use crate::levels::{exact_colours, quality};
use crate::support::gpu::{assert_silent, device};
use crate::support::if_whole;
use crate::support::{mesh, skipping};
use glam::Vec3;
use std::time::Duration;
use surfel::bench::papers::models::Models;
use surfel::bench::papers::tables;
use surfel::bench::runner::{Options as RunnerOptions, Runner};
use surfel::bench::stopwatch::Effort;
use surfel::geometry::{Ellipses, Levels, PointOctree, Selection, Surfels};
use surfel::settings::methods::{confetti, perspective_ewa};
use surfel::vk::DeviceLimits;

/// By bounding ellipses and by the covariance alone, beside the grid's levels.
#[test]
#[ignore = "takes long: tools/test --all"]
fn a_cut_of_a_few_square_pixels_is_nearly_as_near_to_the_truth_as_all_points() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let points = if_whole(1_000_000, 100_000);
    let size = [if_whole(256, 96); 2];
    let (subject, camera, exact) = exact_colours(size);
    let surfels = subject.model(points).unwrap().surfels;
    let levels = Levels::of(surfels.clone()).unwrap();
    println!("{points} points at {}²: dB against the exact picture (splats per px)", size[0]);
    println!("| method | hierarchy | all points | 1 px | 2 px | 4 px |");
    let methods = [confetti::METHOD, perspective_ewa::METHOD];
    for method in &methods[..if_whole(2, 1)] {
        let of_points = quality(&device, &surfels, method, 0.0, &exact, &camera);
        let row = |name: &str, of: &dyn Fn(f32) -> (f64, f64)| {
            let cuts = [1.0, 2.0, 4.0].map(of);
            let cell = |(db, splats): (f64, f64)| format!("{db:.2} ({splats:.2})");
            let cells = [of_points, cuts[0], cuts[1], cuts[2]].map(cell).join(" | ");
            println!("| {} | {name} | {cells} |", method.name);
            cuts
        };
        row("grid", &|lod| quality(&device, &levels, method, lod, &exact, &camera));
        for ellipses in [Ellipses::Bounding, Ellipses::Covariance] {
            let octree = PointOctree::build(surfels.clone(), ellipses, &()).unwrap();
            let cuts = row(&format!("octree, {ellipses:?}"), &|tolerance| {
                let cut = octree.cut(&camera, &Selection { size, tolerance, back_faces: true }).unwrap();
                quality(&device, &cut, method, 0.0, &exact, &camera)
            });
            assert!(
                cuts[0].0 >= of_points.0 - 0.5 && cuts[1].0 >= of_points.0 - 1.0,
                "{ellipses:?}: {cuts:?}"
            );
            assert!(cuts.is_sorted_by(|a, b| a.1 > b.1) && cuts[2].1 < 0.2 * of_points.1, "{cuts:?}");
        }
    }
    assert_silent(&device);
}

/// Nodes of the Dragon in the paper's table 1.
const DRAGON: f64 = 173_507.0;

#[test]
fn the_dragon_has_as_many_nodes_as_in_the_paper() {
    let Some(path) = skipping::data("stanford/dragon/dragon_vrip.ply") else { return };
    let positions = mesh::read(&path).positions;
    let (normals, radii) = (vec![Vec3::Z; positions.len()], vec![1e-4; positions.len()]);
    let surfels = Surfels { positions, normals, radii, ..Surfels::default() };
    let octree = PointOctree::build(surfels, Ellipses::Bounding, &()).unwrap();
    println!("{} nodes, {} bytes", octree.node_count(), octree.bytes());
    assert!((octree.node_count() as f64 / DRAGON - 1.0).abs() < 1e-4, "{} nodes", octree.node_count());
    // 25.8 MB there.
    assert!((octree.bytes() as f64 / f64::from(1 << 20) - 25.8).abs() < 0.5, "{} bytes", octree.bytes());
}

/// Prints the Dragon's rows of the paper's tables: the published numbers, then those of here.
#[test]
#[ignore = "takes long: tools/test --all"]
fn every_number_of_the_dragons_rows_is_measured() {
    let Some(path) = skipping::data("stanford/dragon/dragon_vrip.ply") else { return };
    let Some(device) = device(DeviceLimits::default()) else { return };
    let models = Models::open(path.parent().unwrap(), &()).unwrap();
    let effort = Effort { warmup: 1, least: 3, most: 3, budget: Duration::ZERO, until: None };
    let options = RunnerOptions { device: Some(device.clone()), effort, ..Default::default() };
    let mut runner = Runner::new(options, models.subjects().collect());
    for table in tables::all().filter(|table| table.source().starts_with("pajarola2004")) {
        println!("{}: {}", table.source(), table.columns.join(", "));
        let plans: Vec<_> =
            table.plans(&models).into_iter().filter(|plan| plan.scene.ends_with("dragon_vrip.ply")).collect();
        let runs: Vec<_> = plans.iter().map(|plan| runner.run(plan).unwrap()).collect();
        let runs: Vec<_> = runs.iter().collect();
        for row in table.rows.iter().filter(|row| row.model.starts_with("Dragon")) {
            let own = row.runs(table.caption, &runs);
            let here = table.unit.format(&own).unwrap_or_else(|| panic!("{}: {own:?}", row.model));
            println!("{}: {:?}; here {here}", row.model, row.published);
            assert_eq!(here.split(", ").count(), table.columns.len(), "{here}");
            assert!(here.split(", ").all(|number| number.parse::<f64>().is_ok_and(|x| x > 0.0)), "{here}");
        }
    }
    assert_silent(&device);
}
