//! A sphere through every kind of camera.

use super::centre;
use crate::geometry::Camera;
use crate::settings::{Settings, Shading};
use crate::verify::scenes;
use crate::verify::truth::{Eye, Filter, Options, render};
use glam::dcamera::{lh, rh};
use glam::{DVec2, DVec3, DVec4};

const SIZE: [u32; 2] = [96, 64];

fn cameras() -> Vec<Camera> {
    let [eye, target] = [DVec3::new(0.9, 1.2, -2.6), DVec3::new(0.1, 0.0, 0.2)];
    let view = rh::view::look_at_mat4(eye, target, DVec3::Y);
    let forward = lh::view::look_at_mat4(eye, target, DVec3::Y);
    let mut shifted = rh::proj::directx::perspective(0.9, 1.5, 0.1, 30.0);
    (shifted.z_axis.x, shifted.z_axis.y) = (0.2, -0.1);
    let camera = |view, projection, reversed| Camera { view, projection, reversed };
    vec![
        Camera::look_at(DVec3::new(0.3, 0.4, 3.0), DVec3::new(0.2, 0.0, 0.0), DVec3::Y, 0.8, 1.5, 0.01)
            .unwrap(),
        Camera::orthographic([DVec3::new(0.9, 2.0, 2.0), DVec3::ZERO, DVec3::Y], 2.6, 1.5, [-1.0, 50.0])
            .unwrap(),
        camera(view, shifted, false),
        camera(forward, lh::proj::directx::perspective(1.0, 1.5, 0.1, 30.0), false),
        camera(view, rh::proj::directx::orthographic(-2.0, 2.2, -1.4, 1.3, 0.1, 30.0), false),
    ]
}

/// The ray through a pixel position by the inverse matrix: a point of it, and its direction.
fn ray(camera: &Camera, at: DVec2) -> (DVec3, DVec3) {
    let ndc = 2.0 * at / DVec2::new(SIZE[0].into(), SIZE[1].into()) - 1.0;
    let inverse = camera.world_to_clip().inverse();
    let point = |z: f64| {
        let p = inverse * DVec4::new(ndc.x, ndc.y, z, 1.0);
        p.truncate() / p.w
    };
    let (a, b) = (point(0.9), point(0.5));
    let away = if camera.reversed { b - a } else { a - b };
    (a, away.normalize())
}

/// Eye-space distance of the nearest point of the unit sphere, and how far inside the outline the ray passes.
fn exact(camera: &Camera, at: DVec2) -> (Option<f64>, f64) {
    let (point, along) = ray(camera, at);
    let middle = point - along * point.dot(along);
    let inside = 1.0 - middle.length();
    let hit = middle - along * (1.0 - middle.length_squared()).max(0.0).sqrt();
    let depth = (camera.view * hit.extend(1.0)).z * camera.projection().unwrap().forward;
    ((inside > 0.0).then_some(depth), inside)
}

#[test]
fn outline_and_depth_are_the_closed_form() {
    let sphere = scenes::surface("scene:sphere?albedo=plain").unwrap();
    let settings = Settings { shading: Shading::Normal, ..Default::default() };
    let point = Options { filter: Filter::Point, ..Default::default() };
    for (index, camera) in cameras().iter().enumerate() {
        let picture = render(&*sphere, camera, &settings, SIZE, &point, &()).unwrap().picture;
        let eye = Eye::new(&*sphere, camera, &settings, SIZE).unwrap();
        let mut covered = 0;
        for (i, pixel) in picture.colour.iter().enumerate() {
            let at = centre(i, SIZE);
            let (depth, inside) = exact(camera, at);
            assert!(inside.abs() > 1e-9, "camera {index}: a pixel on the outline tells nothing");
            let hit = eye.hit(at);
            assert_eq!(
                (hit.is_some(), pixel[3]),
                (depth.is_some(), f32::from(depth.is_some())),
                "camera {index}, {at}"
            );
            let (Some(hit), Some(depth)) = (hit, depth) else { continue };
            covered += 1;
            // Near the outline the depth is as ill-conditioned as its square root.
            let bar = if inside > 1e-3 { 1e-9 } else { 1e-7 };
            assert!((hit.depth - depth).abs() < bar, "camera {index}, {at}: {} {depth}", hit.depth);
            assert_eq!(picture.depth.as_ref().unwrap()[i], hit.depth as f32);
        }
        assert!(covered > 500, "camera {index}: {covered}");
    }
}

/// Two surfaces in a pixel have no meaningful mean depth; at the outline the nearest ray to the centre counts.
#[test]
fn depth_is_that_of_the_ray_through_the_centre() {
    let sphere = scenes::surface("scene:sphere?albedo=plain").unwrap();
    let (settings, camera) = (Settings::default(), cameras()[0]);
    let picture = render(&*sphere, &camera, &settings, SIZE, &Options::default(), &()).unwrap().picture;
    let (eye, mut beside) = (Eye::new(&*sphere, &camera, &settings, SIZE).unwrap(), 0);
    for (i, depth) in picture.depth.unwrap().into_iter().enumerate() {
        match eye.hit(centre(i, SIZE)) {
            Some(hit) => assert_eq!(depth, hit.depth as f32),
            None if depth > 0.0 => {
                beside += 1;
                assert!(picture.colour[i][3] > 0.0 && depth > 2.0 && depth < 3.1, "{depth}");
            }
            None => {}
        }
    }
    assert!(beside > 20, "{beside}");
}

#[test]
fn normals_face_the_eye_and_light_is_the_references() {
    let inside = Camera::look_at(DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, DVec3::Y, 1.0, 1.5, 0.01).unwrap();
    let sphere = scenes::surface("scene:sphere?albedo=plain").unwrap();
    let settings = Settings::default();
    let eye = Eye::new(&*sphere, &inside, &settings, SIZE).unwrap();
    // The ray through the middle of the picture hits the far side head-on: the full headlight and its highlight.
    let hit = eye.hit(DVec2::new(48.0, 32.0)).unwrap();
    assert!(hit.normal.abs_diff_eq(DVec3::Z, 1e-12) && (hit.depth - 1.5).abs() < 1e-12, "{hit:?}");
    let albedo = sphere.trace(DVec3::ZERO, DVec3::NEG_Z).unwrap().albedo;
    let light = DVec3::from(albedo) * f64::from(0.08f32 + 0.87f32) + f64::from(0.06f32);
    assert!(hit.colour.abs_diff_eq(light, 1e-6), "{} {light}", hit.colour);
}

#[test]
fn planes_cut() {
    let sphere = scenes::surface("scene:sphere").unwrap();
    let settings = Settings::default();
    let view = [DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, DVec3::Y];
    let depth = |planes| {
        let camera = Camera::orthographic(view, 2.0, 1.0, planes).unwrap();
        Eye::new(&*sphere, &camera, &settings, [9, 9]).unwrap().hit(DVec2::splat(4.5)).map(|hit| hit.depth)
    };
    assert!((depth([0.5, 9.0]).unwrap() - 2.0).abs() < 1e-12);
    assert!((depth([2.5, 9.0]).unwrap() - 4.0).abs() < 1e-12, "the near side is cut away");
    assert_eq!((depth([0.5, 1.5]), depth([4.5, 9.0])), (None, None));
}
