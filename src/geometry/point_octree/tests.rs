//! The tree, its statistics and its cuts against direct computation in float64.

use super::split::{Cell, LEAF, octant};
use super::*;
use crate::geometry::{Camera, Materials, Texture, Weights};
use crate::verify::scenes;
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn bumpy(points: u32) -> Surfels {
    scenes::open(&format!("scene:bumpy-sphere?points={points}")).unwrap()
}

/// The points with elliptical discs.
fn elliptical(points: u32) -> Surfels {
    let mut surfels = bumpy(points);
    let shape =
        |(i, n): (usize, &Vec3)| Ellipse { aspect: 0.4 + 0.1 * (i % 7) as f32, ..Ellipse::circle(*n) };
    surfels.ellipses = Some(surfels.normals.iter().enumerate().map(shape).collect());
    surfels
}

fn octree(surfels: Surfels) -> PointOctree {
    PointOctree::build(surfels, Ellipses::Bounding, &()).unwrap()
}

/// Indices of the children of a node.
fn children(tree: &PointOctree, own: usize) -> Vec<usize> {
    let end = own + tree.nodes[own].cell.subtree as usize;
    let next =
        |child: &usize| Some(child + tree.nodes[*child].cell.subtree as usize).filter(|next| *next < end);
    std::iter::successors(Some(own + 1).filter(|first| *first < end), next).collect()
}

fn position(tree: &PointOctree, i: usize) -> DVec3 {
    tree.surfels.positions[i].as_dvec3()
}

fn mean(node: &Node, of: impl Fn(usize) -> DVec3) -> DVec3 {
    node.points().map(of).sum::<DVec3>() / node.points().len() as f64
}

#[test]
fn nodes_of_more_than_eight_points_are_divided_at_their_mean() {
    let tree = octree(bumpy(20_000));
    assert_eq!(tree.nodes[0].cell, Cell { first: 0, count: 20_000, subtree: tree.node_count() as u32 });
    for (own, node) in tree.nodes.iter().enumerate() {
        let below = children(&tree, own);
        assert_eq!((node.is_leaf(), below.is_empty()), (node.points().len() <= LEAF, node.is_leaf()));
        let mean = mean(node, |i| position(&tree, i));
        let mut next = node.cell.first;
        let mut octants = Vec::new();
        for child in below.iter().map(|child| &tree.nodes[*child]) {
            assert_eq!(child.cell.first, next, "points of children follow each other");
            next += child.cell.count;
            let of = |i: usize| octant(&Point { position: tree.surfels.positions[i], index: 0 }, mean);
            octants.push(of(child.points().start));
            assert!(child.points().all(|i| of(i) == octants[octants.len() - 1]));
        }
        octants.dedup();
        assert_eq!(octants.len(), below.len(), "a child an octant");
        assert!(below.is_empty() || next == node.cell.first + node.cell.count);
    }
    // As of the paper's four models: 0.396 to 0.401.
    let share = tree.node_count() as f64 / 20_000.0;
    assert!((share - 0.4).abs() < 0.04, "{share} nodes a point");
}

/// Covariance of a node's discs in its tangent plane by equation 1: variances and covariance along two axes of the plane.
fn plane_covariance(tree: &PointOctree, node: &Node, [s, t]: [DVec3; 2]) -> [f64; 3] {
    let centre = mean(node, |i| position(tree, i));
    let of = |i: usize| {
        let p = position(tree, i) - centre;
        let axes = tree.surfels.semi_axes(i).map(|axis| 0.5 * axis);
        let all = [p, axes[0], axes[1]].map(|v| [v.dot(s), v.dot(t)]);
        all.iter().fold([0.0; 3], |[xx, xy, yy], [x, y]| [xx + x * x, xy + x * y, yy + y * y])
    };
    let sum = node.points().map(of).fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    sum.map(|sum| sum / node.points().len() as f64)
}

#[test]
fn statistics_are_those_of_all_points_in_float64() {
    // Far from the origin, where sums of squares about it would cancel.
    let mut surfels = elliptical(3000);
    surfels.positions.iter_mut().for_each(|p| *p += Vec3::new(500.0, -300.0, 100.0));
    let tree = PointOctree::build(surfels, Ellipses::Covariance, &()).unwrap();
    let light = srgb::decode_table();
    for node in &tree.nodes {
        let disc = &node.disc;
        let rounding = 500.0 * f64::from(f32::EPSILON);
        let exact = mean(node, |i| position(&tree, i));
        assert!(disc.position.as_dvec3().distance(exact) < rounding, "{} {exact}", disc.position);
        let exact = mean(node, |i| tree.surfels.normals[i].as_dvec3()).normalize();
        assert!(disc.normal.as_dvec3().distance(exact) < 1e-6);
        let widest = node.points().map(|i| tree.surfels.normals[i].as_dvec3().angle_between(exact));
        let widest = widest.fold(0.0, f64::max);
        // The angle of equal vectors by their cosine is the root of its rounding error.
        assert!((f64::from(node.cone) - widest).abs() < 1e-6, "{} {widest}", node.cone);
        let centre = disc.position.as_dvec3();
        let reach = |i: usize| (position(&tree, i) - centre).length() + f64::from(tree.surfels.radii[i]);
        let farthest = node.points().map(reach).fold(0.0, f64::max);
        assert!((f64::from(node.sphere) / farthest - 1.0).abs() < 1e-6, "{} {farthest}", node.sphere);
        let Some(Colours::Srgb8(codes)) = &tree.surfels.colours else { panic!("the scene has colours") };
        let linear =
            |i: usize| DVec3::from_array([0, 1, 2].map(|c| f64::from(light[usize::from(codes[i][c])])));
        let exact = mean(node, linear);
        assert!(Vec3::from(disc.colour).as_dvec3().distance(exact) < 1e-6);
        // Along the axes there is no covariance, and the variances are in the ratio of the squared semi-axes.
        let normal = disc.normal.as_dvec3();
        let major = disc.ellipse.major.as_dvec3();
        let [xx, xy, yy] = plane_covariance(&tree, node, [major, normal.cross(major)]);
        assert!(xy.abs() < 1e-5 * xx, "{xy} {xx}");
        let aspect = (yy / xx).sqrt().max(0.2);
        assert!((f64::from(disc.ellipse.aspect) - aspect).abs() < 1e-5, "{} {aspect}", disc.ellipse.aspect);
        // A disc of uniform density has semi-axes of two standard deviations.
        assert!((f64::from(disc.radius) / (1.5 * 2.0 * xx.sqrt()) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn bounding_ellipses_hold_the_discs_of_all_their_points() {
    let tree = octree(elliptical(4000));
    for node in &tree.nodes {
        let disc = &node.disc;
        let [s, t] = disc.ellipse.semi_axes(disc.normal, disc.radius).map(Vec3::as_dvec3);
        let reach = |p: DVec3| {
            let p = p - disc.position.as_dvec3();
            (p.dot(s) / s.length_squared()).hypot(p.dot(t) / t.length_squared())
        };
        let mut corner = 0.0f64;
        for i in node.points() {
            let [a, b] = tree.surfels.semi_axes(i);
            for turn in 0..32 {
                let (sin, cos) = (TAU * f64::from(turn) / 32.0).sin_cos();
                assert!(reach(position(&tree, i) + cos * a + sin * b) <= 1.0 + 1e-6);
            }
            let corners = [a + b, a - b, b - a, -a - b];
            corner = corners.map(|c| reach(position(&tree, i) + c)).into_iter().fold(corner, f64::max);
        }
        // No larger than the boxes around the discs need.
        assert!((corner - 1.0).abs() < 1e-5, "{corner}");
    }
}

fn camera() -> Camera {
    Camera::look_at(DVec3::new(1.5, 2.0, 3.0), DVec3::ZERO, DVec3::Y, 0.8, 1.0, 0.01).unwrap()
}

fn selection(tolerance: f32, back_faces: bool) -> Selection {
    Selection { size: [512; 2], tolerance, back_faces }
}

/// How often each point is drawn, by itself or by a node.
fn times_drawn(tree: &PointOctree, selected: &Selected) -> Vec<u32> {
    let mut times = vec![0; tree.surfels.len()];
    selected.points.iter().for_each(|i| times[*i as usize] += 1);
    let of_nodes = selected.nodes.iter().flat_map(|node| tree.nodes[*node as usize].points());
    of_nodes.for_each(|i| times[i] += 1);
    times
}

#[test]
fn a_cut_draws_every_point_once_by_the_largest_node_that_is_small_enough() {
    let tree = octree(bumpy(20_000));
    let mut parents = vec![None; tree.node_count()];
    (0..tree.node_count()).for_each(|own| children(&tree, own).iter().for_each(|c| parents[*c] = Some(own)));
    let mut fewer = usize::MAX;
    for tolerance in [0.0, 8.0, 16.0, 32.0, 64.0] {
        let selected = tree.select(&camera(), &selection(tolerance, true)).unwrap();
        assert!(times_drawn(&tree, &selected).iter().all(|times| *times == 1));
        assert!(selected.len() < fewer, "{tolerance} px: {} surfels", selected.len());
        fewer = selected.len();
        assert_eq!(selected.nodes.is_empty(), tolerance == 0.0);
        let area = |own: usize| projected_area(&tree.nodes[own], &camera());
        for own in selected.nodes.iter().map(|own| *own as usize) {
            let least = f64::from(tolerance).powi(2);
            assert!(area(own) < least * (1.0 + 1e-9));
            assert!(parents[own].is_some_and(|parent| area(parent) >= least * (1.0 - 1e-9)));
        }
    }
}

/// Area of the ellipse of a node in a picture of 512 px by the paper's formula, px².
fn projected_area(node: &Node, camera: &Camera) -> f64 {
    let disc = &node.disc;
    let seen = camera.view.transform_point3(disc.position.as_dvec3());
    let eye = camera.view.inverse().transform_point3(DVec3::ZERO);
    let to_eye = (eye - disc.position.as_dvec3()).normalize();
    // Back faces are seen as front faces are.
    let tilt = disc.normal.as_dvec3().dot(to_eye).abs().acos() - f64::from(node.cone);
    let focal = 256.0 / (0.4f64).tan();
    let [a, b] = [1.0, f64::from(disc.ellipse.aspect)].map(|part| part * f64::from(disc.radius));
    PI * a * b * tilt.max(0.0).cos() * (focal / seen.z).powi(2)
}

#[test]
fn without_tolerance_the_points_that_face_the_eye_are_drawn() {
    let tree = octree(bumpy(20_000));
    let eye = camera().view.inverse().transform_point3(DVec3::ZERO);
    let facing = |i: usize| tree.surfels.normals[i].as_dvec3().dot(position(&tree, i) - eye) <= 0.0;
    let selected = tree.select(&camera(), &selection(0.0, false)).unwrap();
    let expected: Vec<u32> = (0..20_000).filter(|i| facing(*i as usize)).collect();
    assert!(
        selected.points == expected && selected.nodes.is_empty(),
        "{} of {}",
        selected.len(),
        expected.len()
    );
    // Nodes never hide what faces the eye.
    let selected = tree.select(&camera(), &selection(8.0, false)).unwrap();
    let times = times_drawn(&tree, &selected);
    assert!((0..20_000).all(|i| times[i] == 1 || !facing(i)));
    let culled = times.iter().filter(|times| **times == 0).count();
    assert!(culled > 8000, "{culled} of 20,000 points are culled");
}

#[test]
fn what_is_in_the_picture_is_drawn_and_what_is_far_outside_is_not() {
    let tree = octree(bumpy(20_000));
    let [eye, target] = [DVec3::new(0.3, 0.2, 1.6), DVec3::new(0.5, 0.3, 0.0)];
    let near = Camera::look_at(eye, target, DVec3::Y, 0.3, 1.0, 0.01).unwrap();
    let flat = Camera::orthographic([eye, target, DVec3::Y], 0.4, 1.0, [0.0, 10.0]).unwrap();
    for camera in [near, flat] {
        let selected = tree.select(&camera, &selection(2.0, true)).unwrap();
        let times = times_drawn(&tree, &selected);
        let clip = |i: usize| camera.world_to_clip() * position(&tree, i).extend(1.0);
        let inside = |i: usize| clip(i).w > 0.0 && clip(i).x.abs().max(clip(i).y.abs()) <= clip(i).w;
        assert!((0..20_000).all(|i| times[i] == 1 || !inside(i)));
        let all = (0..20_000).filter(|i| inside(*i)).count();
        let drawn = times.iter().filter(|times| **times == 1).count();
        assert!((200..15_000).contains(&all) && drawn < all + all / 2 + 500, "{drawn} drawn, {all} inside");
    }
}

#[test]
fn the_surfels_of_a_cut_are_whole_and_valid() {
    let mut surfels = bumpy(5000);
    let count = surfels.len();
    surfels.two_sided = Some((0..count).map(|i| i % 5 == 0).collect());
    surfels.normals.iter_mut().step_by(11).for_each(|normal| *normal = Vec3::ZERO);
    surfels.materials = Some(Materials { table: [].into(), of: vec![Materials::NONE; count] });
    surfels.point_indices = Some((0..count as u32).collect());
    surfels.positions[7] = Vec3::NAN;
    let tree = octree(surfels);
    assert_eq!(tree.points().len(), count - 1, "invalid points are left out");
    for tolerance in [0.0, 3.0, 1000.0] {
        let selection = selection(tolerance, true);
        let selected = tree.select(&camera(), &selection).unwrap();
        let cut = tree.cut(&camera(), &selection).unwrap();
        cut.check().unwrap();
        assert_eq!((cut.len(), cut.count_invalid()), (selected.len(), 0), "{tolerance} px");
        let of_points = &cut.point_indices.as_ref().unwrap()[..selected.points.len()];
        assert!(of_points.iter().all(|point| *point != Surfels::NO_POINT));
    }
    assert_eq!(tree.cut(&camera(), &selection(1000.0, true)).unwrap().len(), 1, "the root");
}

#[test]
fn texture_coordinates_are_those_of_a_point() {
    let mut surfels = bumpy(500);
    let image = crate::Picture { size: [1, 1], colour: vec![[1.0; 4]], ..Default::default() };
    let image = crate::geometry::MipMap::new(&image).unwrap();
    let coordinates = (0..500).map(|i| Vec2::new(i as f32, 0.5)).collect();
    surfels.colours = None;
    surfels.radii.iter_mut().enumerate().for_each(|(i, radius)| *radius *= 1.0 + 0.001 * i as f32);
    surfels.texture = Some(Texture { image: image.into(), coordinates });
    let tree = octree(surfels);
    let cut = tree.cut(&camera(), &selection(1000.0, true)).unwrap();
    cut.check().unwrap();
    let largest = tree.surfels.radii.iter().copied().fold(0.0, f32::max);
    let at = cut.texture.unwrap().coordinates[0];
    let own = tree.surfels.texture.as_ref().unwrap().coordinates.iter().position(|other| *other == at);
    assert_eq!(tree.surfels.radii[own.unwrap()], largest);
}

/// Number of nodes whose surfels cannot be drawn.
fn invalid_nodes(tree: &PointOctree) -> usize {
    let all = Selected { points: Vec::new(), nodes: (0..tree.node_count() as u32).collect() };
    tree.surfels(&all).count_invalid()
}

#[test]
fn coincident_and_ever_closer_points_end() {
    let mut surfels = bumpy(600);
    for (i, p) in surfels.positions.iter_mut().enumerate() {
        *p = if i < 300 { Vec3::ONE } else { Vec3::splat((2.0f32).powi(-(i as i32 % 120))) };
    }
    let tree = octree(surfels);
    let leaves: usize = tree.nodes.iter().filter(|node| node.is_leaf()).map(|node| node.points().len()).sum();
    assert_eq!(leaves, 600);
    assert_eq!(tree.nodes.iter().filter(|node| node.is_leaf() && node.points().len() > LEAF).count(), 1);
    assert_eq!(invalid_nodes(&tree), 0);
    let none = octree(Surfels::default());
    let mut far = bumpy(600);
    far.positions.iter_mut().for_each(|p| *p = p.normalize() * 0.9 * Surfels::LARGEST);
    far.radii.fill(Surfels::LARGEST);
    assert_eq!(invalid_nodes(&octree(far)), 0);
    assert!(none.node_count() == 0 && none.cut(&camera(), &selection(1.0, true)).unwrap().is_empty());
}

#[test]
fn bytes_are_about_the_papers_62_a_point() {
    assert_eq!(size_of::<Node>(), 84);
    let tree = octree(bumpy(20_000));
    // Of a point: position, normal, radius and colour.
    let bytes = 84 * tree.node_count() + (12 + 12 + 4 + 4) * 20_000;
    assert_eq!(tree.bytes(), bytes as u64);
    let each = bytes as f64 / 20_000.0;
    assert!((each - 62.0).abs() < 6.0, "{each} bytes a point");
}

#[test]
fn what_has_no_octree_and_no_cut_is_refused() {
    let mut surfels = bumpy(100);
    surfels.weights = Some(Weights::collect((0..100).map(|_| (1.0, None))));
    assert!(PointOctree::build(surfels, Ellipses::Bounding, &()).is_err());
    let tree = octree(bumpy(100));
    let refused = |selection: Selection| tree.select(&camera(), &selection).is_err();
    assert!(refused(selection(-1.0, true)) && refused(selection(f32::NAN, true)));
    assert!(refused(Selection { size: [0, 5], ..selection(1.0, true) }));
    struct Cancelled;
    impl Progress for Cancelled {
        fn at(&self, _: &'static str, _: u64, _: u64) {}
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let cancelled = PointOctree::build(bumpy(20_000), Ellipses::Bounding, &Cancelled);
    assert!(matches!(cancelled, Err(Error::Cancelled)));
}

#[test]
fn normals_of_two_sided_points_are_turned_to_one_side() {
    let mut surfels = bumpy(100);
    // Turned to the first one's side, their mean is along z; otherwise along x.
    let normals = [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, -0.8)];
    surfels.normals = (0..100).map(|i| normals[i % 2]).collect();
    surfels.two_sided = Some(vec![true; 100]);
    let tree = octree(surfels);
    assert!(tree.nodes.iter().all(|node| node.disc.normal.z.abs() > 0.79 && node.disc.two_sided));
    assert!(tree.nodes.iter().all(|node| f64::from(node.cone) > FRAC_PI_2));
}
