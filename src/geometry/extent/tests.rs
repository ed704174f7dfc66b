//! Tests of extents against projections of all points.

use super::*;
use crate::geometry::{Camera, Surfels};
use glam::DVec2;

const UPS: [DVec3; 4] = [DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::new(0.2, 1.0, -0.4)];

/// Points of an ellipsoid with their normals.
fn ellipsoid(count: u32, axes: Vec3) -> Surfels {
    let points = (0..count).map(|i| {
        let z = 1.0 - (2 * i + 1) as f32 / count as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        Vec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    });
    let (positions, normals) = points.map(|p| (p * axes, (p / axes).normalize())).unzip();
    Surfels { positions, normals, radii: vec![1e-3; count as usize], ..Default::default() }
}

/// A square of the plane with a normal.
fn square(normal: Vec3) -> Surfels {
    let (a, b) = normal.any_orthonormal_pair();
    let at = |i: i32| (i % 40 - 20) as f32 * a + (i / 40 - 20) as f32 * b;
    Surfels {
        positions: (0..1600).map(at).collect(),
        normals: vec![normal; 1600],
        radii: vec![0.5; 1600],
        ..Default::default()
    }
}

/// Least and greatest coordinates in a picture from −1 to 1.
fn projected(surfels: &Surfels, camera: &Camera) -> [DVec2; 2] {
    let clip = surfels
        .positions
        .iter()
        .map(|p| camera.world_to_clip() * (p.as_dvec3() + surfels.origin).extend(1.0));
    let points = clip.map(|p| p.truncate().truncate() / p.w);
    points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[lo, hi], p| [lo.min(p), hi.max(p)])
}

/// Part of the picture's width or height that the points fill, the greater one; they are in the middle of that.
fn fill(surfels: &Surfels, camera: &Camera) -> f64 {
    let [lo, hi] = projected(surfels, camera);
    let axis = if (hi - lo).x > (hi - lo).y { 0 } else { 1 };
    assert!((hi + lo)[axis].abs() < 0.04, "{lo} {hi}");
    (0.5 * (hi - lo)).max_element()
}

#[test]
fn models_fill_nine_tenths_of_the_picture() {
    for axes in [Vec3::ONE, Vec3::new(0.1, 1.0, 0.3), Vec3::new(20.0, 1.0, 3.0)] {
        let surfels = Surfels { origin: DVec3::new(4e6, -5e5, 17.0), ..ellipsoid(20_000, axes) };
        let extent = Extent::of(&surfels).unwrap();
        for up in UPS {
            for aspect in [0.4, 1.0, 2.5] {
                for fov_y in [0.1, 0.8, 1.5] {
                    let camera = Camera::framing(&extent, up, fov_y, aspect).unwrap();
                    let fill = fill(&surfels, &camera);
                    assert!((0.88..0.925).contains(&fill), "{axes} {up} {aspect} {fov_y}: {fill}");
                }
            }
        }
    }
}

#[test]
fn parallel_rays_have_the_same_fill() {
    let surfels = ellipsoid(20_000, Vec3::new(0.3, 1.0, 2.0));
    let extent = Extent::of(&surfels).unwrap();
    let pose = extent.pose(DVec3::Y, 45.0, 1.5).unwrap();
    let camera = pose.camera(&extent.bounds(), 1.5).unwrap();
    let axes = DMat3::from_mat4(camera.view).transpose() * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let slope = 22.5f64.to_radians().tan();
    let eye = extent.eye(axes, [1.5 * slope, slope], true);
    let distance = (eye - extent.centre()).dot(axes.z_axis);
    let pose = Pose { eye, target: eye - axes.z_axis, span: Span::Height(2.0 * slope * distance), ..pose };
    let fill = fill(&surfels, &pose.camera(&extent.bounds(), 1.5).unwrap());
    assert!((0.88..0.925).contains(&fill), "{fill}");
}

#[test]
fn stray_points_are_left_out() {
    let alone = ellipsoid(10_000, Vec3::new(1.0, 2.0, 0.5));
    let mut strewn = alone.clone();
    for i in 0..60 {
        let far = 10f32.powi(1 + i % 8) * Vec3::new((i as f32).sin(), (3.0 * i as f32).cos(), 0.7);
        strewn.positions.insert(150 * i as usize, far);
        strewn.normals.push(Vec3::Y);
        strewn.radii.push(1e-3);
    }
    strewn.normals.rotate_right(60);
    let [alone, strewn] = [alone, strewn].map(|surfels| Extent::of(&surfels).unwrap().bounds());
    assert_eq!(alone, strewn);
}

#[test]
fn thin_parts_and_few_points_are_not_stray() {
    // A pole, as high as the ground is wide, of few points.
    let mut ground = square(Vec3::Y);
    for i in 0..10 {
        ground.positions.push(Vec3::Y * 2.0 * i as f32);
        ground.normals.push(Vec3::Z);
        ground.radii.push(0.1);
    }
    assert!((Extent::of(&ground).unwrap().bounds().max.y - 18.1).abs() < 1e-5);
    let three = Surfels {
        positions: vec![Vec3::ZERO, Vec3::X, 1e6 * Vec3::Y],
        normals: vec![Vec3::Z; 3],
        radii: vec![1.0; 3],
        ..Default::default()
    };
    assert_eq!(Extent::of(&three).unwrap().bounds().max.y, 1_000_001.0);
}

#[test]
fn open_surfaces_are_seen_from_their_front() {
    let usual = Extent::default().view_direction([DVec3::X, DVec3::Y, DVec3::Z]);
    assert!(usual.abs_diff_eq(DVec3::new(0.489, 0.389, 0.78), 1e-3), "{usual}");
    let closed = Extent::of(&ellipsoid(5000, Vec3::ONE)).unwrap();
    assert_eq!(closed.view_direction([DVec3::X, DVec3::Y, DVec3::Z]), usual);
    for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, -usual.as_vec3()] {
        let surfels = square(normal);
        for up in UPS {
            let camera = Camera::framing(&Extent::of(&surfels).unwrap(), up, 0.8, 1.0).unwrap();
            let towards = -camera.view.row(2).truncate();
            assert!(towards.dot(normal.as_dvec3()) > OBLIQUE[0].cos() - 1e-6, "{normal} {up}: {towards}");
            let fill = fill(&surfels, &camera);
            assert!((0.84..0.925).contains(&fill), "{normal} {up}: {fill}");
        }
    }
}

#[test]
fn half_a_sphere_is_seen_from_its_outside() {
    let whole = ellipsoid(8000, Vec3::ONE);
    for side in [Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y] {
        let mut half = whole.clone();
        half.positions.retain(|p| p.dot(side) > 0.0);
        half.normals = half.positions.clone();
        half.radii.truncate(half.positions.len());
        let towards = Extent::of(&half).unwrap().view_direction([DVec3::X, DVec3::Y, DVec3::Z]);
        // Its mean normal is half as long as a plane's.
        assert!(towards.dot(side.as_dvec3()) > 0.49, "{side}: {towards}");
    }
}

#[test]
fn two_sided_surfels_are_seen_from_either_side() {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let usual = Extent::default().view_direction(axes);
    let towards = |surfels: Surfels| {
        let two_sided = Some(vec![true; surfels.len()]);
        Extent::of(&Surfels { two_sided, ..surfels }).unwrap().view_direction(axes)
    };
    for normal in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(-0.6, 0.0, 0.8)] {
        let mut surfels = square(normal);
        surfels.normals.iter_mut().step_by(3).for_each(|normal| *normal = -*normal);
        let cosine = towards(surfels).dot(normal.as_dvec3());
        let nearer = cosine * usual.dot(normal.as_dvec3()).signum();
        assert!(nearer > OBLIQUE[0].cos() - 1e-6, "{normal}: {cosine}");
    }
    assert_eq!(towards(ellipsoid(5000, Vec3::ONE)), usual);
}

#[test]
fn clouds_are_framed_by_their_triangles() {
    let cloud = Cloud {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 2, 1]],
        ..Default::default()
    };
    let towards = Extent::of_cloud(&cloud).unwrap().view_direction([DVec3::X, DVec3::Y, DVec3::Z]);
    assert!(towards.z < -0.86, "{towards}");
    assert_eq!(Extent::of_cloud(&Cloud::default()), None);
}

#[test]
fn a_turned_model_stays_in_the_picture() {
    let surfels = ellipsoid(5000, Vec3::new(0.2, 1.0, 3.0));
    let extent = Extent::of(&surfels).unwrap();
    let turned = extent.turned_about(extent.centre(), DVec3::Y);
    let camera = Camera::framing(&turned, DVec3::Y, 0.8, 1.0).unwrap();
    let most = (0..100).map(|turn| {
        let turn = DQuat::from_axis_angle(DVec3::Y, 0.0628 * f64::from(turn));
        let positions = surfels.positions.iter().map(|p| (turn * p.as_dvec3()).as_vec3()).collect();
        let [lo, hi] = projected(&Surfels { positions, ..surfels.clone() }, &camera);
        hi.max(-lo).max_element()
    });
    let most = most.fold(0.0, f64::max);
    assert!((0.85..0.94).contains(&most), "{most}");
}

#[test]
fn a_single_point_is_framed() {
    for radius in [0.0, 1e-9, 1.0, 1e9] {
        let bounds = Bounds { min: DVec3::ONE, max: DVec3::ONE, radius };
        let camera = Camera::framing(&Extent::from(&bounds), DVec3::Y, 0.8, 1.0).unwrap();
        let seen = camera.world_to_clip() * DVec3::ONE.extend(1.0);
        assert!(seen.w > radius && seen.x.abs() < 1e-6 * seen.w && seen.z < seen.w, "{radius}: {seen}");
    }
}
