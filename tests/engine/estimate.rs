//! Normals and radii that are estimated, against surfaces whose own are known.

use crate::support::sampling::Random;
use crate::support::{if_whole, mesh, skipping};
use glam::{DQuat, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use surfel::estimate::{Estimate, Estimated, MeshSampling};
use surfel::geometry::{Cloud, Surfels, View, Viewpoints};
use surfel::verify::scenes::bumpy_sphere;

fn estimate(cloud: Cloud) -> (Surfels, Estimated) {
    cloud.into_surfels(&Estimate::default(), &()).unwrap()
}

/// How estimated normals differ from true ones.
#[derive(Debug)]
struct Errors {
    /// Angles between the lines, degrees.
    median: f32,
    p95: f32,
    /// Part of them on the true side.
    right: f64,
    /// Number without a known side.
    two_sided: u64,
}

/// Compares the estimated normals of a cloud without any with true ones (0 where there is none).
fn errors(cloud: Cloud, truth: &[Vec3]) -> Errors {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let truth: HashMap<_, _> = cloud.positions.iter().map(bits).zip(truth).collect();
    let count = cloud.positions.len() as u64;
    let (surfels, estimated) = estimate(cloud);
    assert_eq!(estimated.normals_from_neighbours, count);
    let pairs = surfels.positions.iter().zip(&surfels.normals).map(|(p, n)| (*n, *truth[&bits(p)]));
    let cosines: Vec<f32> =
        pairs.filter(|(_, truth)| *truth != Vec3::ZERO).map(|(n, truth)| n.dot(truth)).collect();
    let right = cosines.iter().filter(|cosine| **cosine > 0.0).count() as f64 / cosines.len() as f64;
    let mut angles: Vec<f32> =
        cosines.iter().map(|cosine| cosine.abs().min(1.0).acos().to_degrees()).collect();
    angles.sort_unstable_by(f32::total_cmp);
    let two_sided = estimated.two_sided;
    Errors { median: angles[angles.len() / 2], p95: angles[angles.len() * 95 / 100], right, two_sided }
}

#[test]
fn normals_of_a_noisy_sphere_are_right() {
    let truth = bumpy_sphere::sample(100_000, 1);
    let spacing = (bumpy_sphere::area() / 100_000.0).sqrt() as f32;
    let mut random = Random(7);
    let noisy: Vec<Vec3> = truth
        .positions
        .iter()
        .map(|p| *p + 0.1 * spacing * Vec3::from_array([0; 3].map(|_| random.normal() as f32)))
        .collect();
    let errors = errors(bare(noisy), &truth.normals);
    println!("{errors:?}");
    assert!(errors.median <= 2.0 && errors.p95 <= 8.0 && errors.right >= 0.995, "{errors:?}");
}

#[test]
fn normals_of_scans_are_those_of_their_meshes() {
    let names = ["stanford/bunny/bun_zipper.ply", "classic/igea.ply", "classic/feline_50k.ply"];
    for name in &names[..if_whole(3, 1)] {
        let Some(path) = skipping::data(name) else { return };
        let mesh = mesh::read(&path);
        let errors = errors(bare(mesh.positions.clone()), &mesh::normals(&mesh));
        println!("{name}: {errors:?}");
        assert!(errors.median <= 5.0 && errors.p95 <= 20.0 && errors.right >= 0.995, "{name}: {errors:?}");
    }
}

/// Every fourth point of a range scan of the bunny, in the coordinates of the mesh, without its triangles. `pose` is a translation and the quaternion of the inverse
/// rotation, and the scanner is a metre before the object.
fn range_scan(path: &Path, pose: [f64; 7]) -> Cloud {
    let [x, y, z, rotation @ ..] = pose;
    let rotation = DQuat::from_array(rotation).normalize().conjugate();
    let placed = |p: DVec3| (rotation * p + DVec3::new(x, y, z)).as_vec3();
    let scan = mesh::read(path);
    let at = |p: &Vec3| placed(scan.origin + p.as_dvec3());
    let view = View::From(placed(DVec3::new(0.0, 0.1, 1.0)));
    Cloud { view, ..bare(scan.positions.iter().step_by(4).map(at).collect()) }
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn normals_of_several_scans_are_those_of_the_mesh_that_was_made_of_them() {
    let Some(path) = skipping::data("stanford/bunny/range/bun.conf") else { return };
    let poses = std::fs::read_to_string(&path).unwrap();
    let scans = poses.lines().filter_map(|line| {
        let (name, pose) = line.strip_prefix("bmesh ")?.split_once(' ')?;
        let numbers: Vec<f64> = pose.split_whitespace().map(|number| number.parse().unwrap()).collect();
        // Not all of them are there.
        let file = Some(path.with_file_name(name)).filter(|file| file.exists())?;
        Some(range_scan(&file, numbers.try_into().unwrap()))
    });
    let cloud = Cloud::merge(scans.collect(), [0.5; 3]).unwrap();
    let mesh = mesh::read(&skipping::data("stanford/bunny/bun_zipper.ply").unwrap());
    let normals = mesh::normals(&mesh);
    let nearest = |p: &Vec3| {
        let all = mesh.positions.iter().map(|vertex| vertex.distance_squared(*p)).zip(&normals);
        *all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1
    };
    let truth: Vec<Vec3> = cloud
        .positions
        .par_iter()
        .enumerate()
        .map(|(i, p)| if i % 10 == 0 { nearest(p) } else { Vec3::ZERO })
        .collect();
    let blind = errors(Cloud { viewpoints: None, ..cloud.clone() }, &truth);
    let seen = errors(cloud, &truth);
    println!("{seen:?}, {blind:?} without scanners");
    assert!(seen.two_sided == 0 && seen.right >= 0.997, "{seen:?}");
    assert!(1.0 - seen.right < 0.5 * (1.0 - blind.right), "{seen:?} {blind:?}");
}

/// `across` × `along` points of a plane, `pitch` apart across, 1 along.
fn lines(across: i32, along: i32, pitch: f32) -> Vec<Vec3> {
    let point = |i: i32, j: i32| Vec3::new(pitch * i as f32, j as f32, 0.0);
    (0..across).flat_map(|i| (0..along).map(move |j| point(i, j))).collect()
}

fn bare(positions: Vec<Vec3>) -> Cloud {
    Cloud { positions, ..Default::default() }
}

/// The middle of a list.
fn median(values: &[f32]) -> f32 {
    let mut values = values.to_vec();
    values.sort_unstable_by(f32::total_cmp);
    values[values.len() / 2]
}

#[test]
fn radii_reach_from_scan_line_to_scan_line() {
    for pitch in [1.0_f32, 3.0, 10.0] {
        let (surfels, _) = estimate(bare(lines(200 / pitch as i32, 200, pitch)));
        // Half the diagonal of a cell between the lines, and the margin.
        let expected = 1.3 * 0.5 * pitch.hypot(1.0);
        assert!(
            (median(&surfels.radii) / expected - 1.0).abs() < 1e-3,
            "{pitch}: {}",
            median(&surfels.radii)
        );
        let largest = surfels.radii.iter().copied().fold(0.0, f32::max);
        assert!(largest < 1.05 * expected, "{pitch}: a disc of {largest} at the edge");
        assert!(surfels.normals.iter().all(|n| n.z.abs() > 0.9999), "{pitch}");
    }
}

#[test]
fn ellipses_follow_the_scan_lines() {
    let how = Estimate { elliptical: true, ..Default::default() };
    let (surfels, _) = bare(lines(40, 200, 5.0)).into_surfels(&how, &()).unwrap();
    let inner = |p: &Vec3| (20.0..180.0).contains(&p.x) && (20.0..180.0).contains(&p.y);
    let ellipses = surfels.ellipses.unwrap();
    for ((_, ellipse), radius) in
        surfels.positions.iter().zip(&ellipses).zip(&surfels.radii).filter(|((p, _), _)| inner(p))
    {
        assert!(ellipse.major.x.abs() > 0.99 && (ellipse.aspect - 0.2).abs() < 0.02, "{ellipse:?}");
        // The corner of a cell, 2.5 across and 0.5 along, lies on the ellipse without its margin.
        let corner = (2.5 * 2.5 + 0.25 / ellipse.aspect.powi(2)).sqrt();
        assert!((radius / (1.3 * corner) - 1.0).abs() < 0.02, "{radius} {corner}");
    }
}

#[test]
fn duplicates_change_nothing() {
    let sphere = bumpy_sphere::sample(5000, 2).positions;
    let (once, _) = estimate(bare(sphere.clone()));
    let (tripled, counts) = estimate(bare([&sphere[..], &sphere, &sphere].concat()));
    assert_eq!((tripled.len(), counts.normals_from_neighbours), (15_000, 15_000));
    let by_place = |surfels: &Surfels| -> HashMap<[u32; 3], (Vec3, f32)> {
        let places = surfels.positions.iter().map(|p| p.to_array().map(f32::to_bits));
        places.zip(surfels.normals.iter().copied().zip(surfels.radii.iter().copied())).collect()
    };
    assert_eq!(by_place(&once), by_place(&tripled));
}

#[test]
fn points_far_from_all_others_stay_small_and_can_be_removed() {
    let mut points = bumpy_sphere::sample(20_000, 3).positions;
    let largest = estimate(bare(points.clone())).0.radii.into_iter().fold(0.0, f32::max);
    let mut random = Random(5);
    points.extend((0..20).map(|_| (4.0 * random.vector().normalize()).as_vec3()));
    let (surfels, counts) = estimate(bare(points.clone()));
    let strays = || surfels.positions.iter().zip(&surfels.radii).filter(|(p, _)| p.length() > 3.0);
    assert_eq!((strays().count(), counts.outliers), (20, 0));
    assert!(strays().all(|(_, radius)| *radius < 4.0 * largest), "{:?}", strays().collect::<Vec<_>>());
    let how = Estimate { outliers: Some(4.0), ..Default::default() };
    let (surfels, counts) = bare(points).into_surfels(&how, &()).unwrap();
    assert_eq!((surfels.len() as u64 + counts.outliers, surfels.len()), (20_020, 20_000));
}

#[test]
fn a_point_that_floats_above_a_surface_lies_parallel_to_it() {
    let mut sheet = lines(60, 60, 1.0);
    let floating = |i: usize| i % 97 == 5;
    (0..sheet.len()).filter(|&i| floating(i)).for_each(|i| sheet[i].z = 5.0);
    let (surfels, _) = estimate(bare(sheet));
    let inner = |p: &Vec3| (5.0..55.0).contains(&p.x) && (5.0..55.0).contains(&p.y);
    let inside = || surfels.positions.iter().zip(&surfels.normals).filter(|(p, _)| inner(p));
    assert!(inside().filter(|(p, _)| p.z == 5.0).count() > 20);
    assert!(inside().all(|(_, n)| n.z.abs() > 0.99), "{:?}", inside().find(|(_, n)| n.z.abs() <= 0.99));
}

#[test]
fn normals_point_to_where_points_were_seen_from() {
    let sheet = lines(50, 50, 1.0);
    for (view, up) in [
        (View::From(Vec3::new(25.0, 25.0, 40.0)), 1.0),
        (View::From(Vec3::new(25.0, 25.0, -40.0)), -1.0),
        (View::Towards(Vec3::Z), 1.0),
        (View::Towards(Vec3::NEG_Z), -1.0),
    ] {
        let (surfels, counts) = estimate(Cloud { view, ..bare(sheet.clone()) });
        assert!(surfels.normals.iter().all(|n| n.z * up > 0.99), "{view:?}");
        assert_eq!((counts.two_sided, surfels.two_sided), (0, None), "{view:?}");
    }
    // An open sheet tells nothing of its side, but its normals agree.
    let (surfels, counts) = estimate(bare(sheet));
    assert_eq!((counts.two_sided, surfels.two_sided), (2500, Some(vec![true; 2500])));
    assert_eq!(surfels.normals.iter().filter(|n| n.z > 0.0).count() % 2500, 0);
}

#[test]
fn normals_point_to_the_scanners_of_their_points() {
    // Both sides of a wall, point by point in turns, from a scanner on each; and a sheet above of which nothing is known.
    let sheet = lines(50, 50, 1.0);
    let at = |z: f32| sheet.iter().map(move |p| p.with_z(z));
    let wall = at(0.0).zip(at(-5.0)).flat_map(|(front, back)| [front, back]);
    let positions: Vec<Vec3> = wall.chain(at(30.0)).collect();
    let eye = |z: f32| View::From(Vec3::new(25.0, 25.0, z));
    let scans = (0..7500).map(|point| if point < 5000 { point % 2 } else { 2 }).collect();
    let viewpoints = Some(Viewpoints { views: vec![eye(40.0), eye(-40.0), View::Unknown], scans });
    let cloud = Cloud { viewpoints, ..bare(positions) };
    for cloud in [cloud.clone(), Cloud::merge(vec![cloud.clone(), Cloud::default()], [0.5; 3]).unwrap()] {
        let (surfels, counts) = estimate(cloud);
        let two_sided = surfels.two_sided.unwrap();
        assert_eq!(counts.two_sided, 2500);
        for ((p, n), two_sided) in surfels.positions.iter().zip(&surfels.normals).zip(two_sided) {
            assert!(two_sided == (p.z == 30.0) && n.z.abs() > 0.99, "{p}: {n}");
            assert!(two_sided || n.z * (p.z + 2.5) > 0.0, "{p}: {n}");
        }
    }
    // One point for each voxel: the scan of its first.
    let thinned = cloud.thin(2.0).unwrap();
    let (surfels, counts) = estimate(thinned);
    assert!(counts.two_sided == surfels.normals.len() as u64 / 3, "{counts:?}");
}

#[test]
fn normals_that_are_there_stay_and_lead_the_others() {
    let sheet = lines(50, 50, 1.0);
    let known = |i: usize| if i == 7 { Vec3::new(0.0, 0.6, -0.8) } else { Vec3::ZERO };
    let normals = Some((0..sheet.len()).map(known).collect());
    let (surfels, counts) = estimate(Cloud { normals, ..bare(sheet) });
    assert_eq!((counts.normals_given, counts.normals_from_neighbours, counts.two_sided), (1, 2499, 0));
    assert_eq!(surfels.normals.iter().filter(|n| **n == Vec3::new(0.0, 0.6, -0.8)).count(), 1);
    assert!(surfels.normals.iter().all(|n| n.z < -0.7));
}

#[test]
fn closed_surfaces_are_oriented_each_by_itself() {
    let sphere = bumpy_sphere::sample(3000, 4).positions;
    let away = Vec3::new(10.0, 0.0, 0.0);
    let both: Vec<Vec3> = sphere.iter().copied().chain(sphere.iter().map(|p| *p + away)).collect();
    let (surfels, counts) = estimate(bare(both));
    assert_eq!(counts.two_sided, 0);
    let outwards = |(p, n): (&Vec3, &Vec3)| n.dot(if p.x > 5.0 { *p - away } else { *p }) > 0.0;
    assert!(surfels.positions.iter().zip(&surfels.normals).all(outwards));
}

#[test]
fn clutter_has_no_side() {
    let mut random = Random(11);
    let clutter = (0..5000).map(|_| random.vector().as_vec3()).collect();
    let how = Estimate { billboards: false, ..Estimate::default() };
    let (_, counts) = bare(clutter).into_surfels(&how, &()).unwrap();
    assert_eq!(counts.two_sided, 5000);
}

#[test]
fn faces_back_to_back_tell_nothing_and_neighbours_do() {
    let sphere = bumpy_sphere::sample(2000, 6).positions;
    // Small triangles around each point's place, each also the other way round, in an order that keeps their sum from being 0.
    let near = |i: u32, k: u32| (i + k) % 2000;
    let triangles: Vec<[u32; 3]> = (0..2000)
        .map(|i| [i, near(i, 5), near(i, 89)])
        .chain((0..2000).rev().map(|i| [i, near(i, 89), near(i, 5)]))
        .collect();
    let at_vertices = Estimate { mesh_sampling: MeshSampling::Vertices, ..Estimate::default() };
    let (surfels, counts) = Cloud { triangles, ..bare(sphere) }.into_surfels(&at_vertices, &()).unwrap();
    assert_eq!((counts.normals_from_faces, counts.normals_from_neighbours, counts.two_sided), (0, 2000, 0));
    assert!(surfels.positions.iter().zip(&surfels.normals).all(|(p, n)| p.dot(*n) > 0.0));
}

#[test]
fn given_ellipses_lie_in_the_plane_of_estimated_normals() {
    use surfel::geometry::Ellipse;
    let sheet = lines(20, 20, 1.0);
    let majors = [Vec3::Z, Vec3::new(0.6, 0.0, 0.8)];
    let ellipses = (0..sheet.len()).map(|i| Ellipse { major: majors[i % 2], aspect: 0.5 }).collect();
    let radii = Some(vec![1.0; sheet.len()]);
    let (surfels, _) = estimate(Cloud { ellipses: Some(ellipses), radii, ..bare(sheet) });
    let ellipses = surfels.ellipses.unwrap();
    for (ellipse, normal) in ellipses.iter().zip(&surfels.normals) {
        assert!(ellipse.major.dot(*normal).abs() < 1e-6 && ellipse.major.is_normalized(), "{ellipse:?}");
    }
    // What stood upright has no direction in the plane; what leaned has.
    assert_eq!(ellipses.iter().filter(|ellipse| ellipse.aspect == 1.0).count(), 200);
    assert_eq!(
        ellipses.iter().filter(|ellipse| ellipse.major.x > 0.999 && ellipse.aspect == 0.5).count(),
        200
    );
}

#[test]
fn outliers_take_their_triangles_along_and_are_not_counted_as_given() {
    let mut positions = lines(20, 20, 1.0);
    positions.push(Vec3::new(0.0, 0.0, 500.0));
    let stray = positions.len() as u32 - 1;
    let triangles = vec![[0, 20, 1], [stray, 0, 1], [20, 21, 1]];
    let radii = Some(vec![1.0; positions.len()]);
    let how = Estimate { outliers: Some(3.0), ..Default::default() };
    let cloud = Cloud { triangles, radii, ..bare(positions) };
    let (surfels, counts) = cloud.into_surfels(&how, &()).unwrap();
    assert_eq!((surfels.len(), counts.outliers, counts.radii_given), (400, 1, 400));
    assert_eq!((counts.normals_from_faces, counts.normals_from_neighbours), (4, 396));
    assert!(surfels.normals.iter().all(|n| n.z > 0.999));
}

#[test]
fn faces_tell_normals_and_radii_and_points_without_faces_follow() {
    // Two triangles of a unit square, and a point beside them.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::new(2.0, 0.5, 0.0)];
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let (surfels, counts) = estimate(Cloud { triangles, ..bare(positions) });
    assert_eq!((counts.normals_from_faces, counts.radii_from_faces), (4, 4));
    assert_eq!((counts.normals_from_neighbours, counts.radii_from_neighbours, counts.two_sided), (1, 1, 0));
    for (p, (n, radius)) in surfels.positions.iter().zip(surfels.normals.iter().zip(&surfels.radii)) {
        assert!((*n - Vec3::Z).length() < 1e-6, "{p}: {n}");
        assert!(p.x > 1.5 || (radius - 1.3 * 0.5_f32.sqrt()).abs() < 1e-6, "{p}: {radius}");
    }
}

#[test]
fn the_smallest_and_oddest_clouds_are_answered() {
    let radius = |radius| Estimate { radius: Some(radius), ..Default::default() };
    let one = || bare(vec![Vec3::ONE]);
    assert!(one().into_surfels(&Estimate::default(), &()).unwrap_err().to_string().contains("give a radius"));
    assert!(
        bare(vec![Vec3::ONE; 40])
            .into_surfels(&Estimate::default(), &())
            .unwrap_err()
            .to_string()
            .contains("give a radius")
    );
    let (surfels, _) = one().into_surfels(&radius(2.0), &()).unwrap();
    assert_eq!((surfels.radii, surfels.two_sided), (vec![2.0], Some(vec![true])));
    for scale in [1e-35_f32, 1e-6, 1.0, 1e6, 1e36] {
        let on_a_line = (0..30).map(|i| scale * Vec3::new(i as f32, 2.0 * i as f32, 0.0)).collect();
        let corners =
            (0..8).map(|i| scale * Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
        for positions in [vec![Vec3::ZERO, scale * Vec3::X], on_a_line, corners] {
            let count = positions.len();
            for elliptical in [false, true] {
                let how = Estimate { elliptical, billboards: false, ..Default::default() };
                let (surfels, _) = bare(positions.clone()).into_surfels(&how, &()).unwrap();
                assert_eq!(surfels.len(), count);
                assert!(
                    surfels.radii.iter().all(|r| (0.1..4.0).contains(&(r / scale))),
                    "{scale}: {:?}",
                    surfels.radii
                );
                assert!(surfels.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{scale}");
            }
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let cases = [
        (Estimate { neighbours: 5, ..Default::default() }, "5 neighbours"),
        (Estimate { neighbours: usize::MAX, ..Default::default() }, "give 6 to 64"),
        (Estimate { radius: Some(1e38), radius_scale: 100.0, ..Default::default() }, "have the radius inf"),
        (Estimate { radius: Some(1e-30), radius_scale: 1e-30, ..Default::default() }, "have the radius 0"),
        (Estimate { radius: Some(0.0), ..Default::default() }, "radius is 0"),
        (Estimate { radius_scale: f32::NAN, ..Default::default() }, "factor of the radii is NaN"),
        (Estimate { outliers: Some(-1.0), ..Default::default() }, "deviations is -1"),
    ];
    for (how, cause) in cases {
        let error = bare(lines(5, 5, 1.0)).into_surfels(&how, &()).unwrap_err().to_string();
        assert!(error.contains(cause), "{error}");
    }
    let ragged = Cloud { radii: Some(vec![1.0; 3]), ..bare(lines(2, 2, 1.0)) };
    assert!(
        ragged
            .into_surfels(&Estimate::default(), &())
            .unwrap_err()
            .to_string()
            .contains("4 positions and 3 radii")
    );
    let dangling = Cloud { triangles: vec![[0, 1, 4]], ..bare(lines(2, 2, 1.0)) };
    assert!(
        dangling
            .into_surfels(&Estimate::default(), &())
            .unwrap_err()
            .to_string()
            .contains("none of the 4 points")
    );
}
