//! Tests of the orbit camera against projections of points.

use super::*;
use glam::DVec4;
use surfel::Result;
use surfel::geometry::Camera;

const VIEWPORT: Viewport = Viewport { size: [640, 480], fov_y_deg: 46.0, parallel: false };
const Y_UP: Up = Up { axis: 1, down: false };
const UPS: [Up; 6] = [
    Up { axis: 0, down: false },
    Up { axis: 1, down: false },
    Up { axis: 2, down: false },
    Up { axis: 0, down: true },
    Up { axis: 1, down: true },
    Up { axis: 2, down: true },
];

fn bounds() -> Bounds {
    Bounds::of_box(DVec3::new(-1.0, 5.0, 2.0), DVec3::new(3.0, 6.0, 9.0))
}

impl Orbit {
    fn camera(&self, viewport: &Viewport, bounds: &Bounds) -> Result<Camera> {
        self.pose(viewport).camera(bounds, viewport.aspect())
    }
}

/// Projection of a point, px.
fn project(orbit: &Orbit, viewport: &Viewport, point: DVec3) -> DVec2 {
    let clip: DVec4 = orbit.camera(viewport, &bounds()).unwrap().world_to_clip() * point.extend(1.0);
    (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * DVec2::from(viewport.size.map(f64::from))
}

fn viewports() -> [Viewport; 2] {
    [VIEWPORT, Viewport { parallel: true, ..VIEWPORT }]
}

fn near(a: DVec2, b: DVec2) -> bool {
    (a - b).length() < 1e-6
}

#[test]
fn up_points_up_and_the_framed_scene_is_visible() {
    for up in UPS {
        for viewport in viewports() {
            let orbit = Orbit::framing(&(&bounds()).into(), up, &viewport);
            assert!(near(project(&orbit, &viewport, orbit.pivot), DVec2::new(320.0, 240.0)));
            let above = project(&orbit, &viewport, orbit.pivot + 0.1 * up.vector());
            assert!((above.x - 320.0).abs() < 1e-6 && above.y < 239.0, "{up:?} {above}");
            for i in 0..8 {
                let corner = DVec3::from_array(std::array::from_fn(|axis| match i >> axis & 1 {
                    0 => bounds().min[axis],
                    _ => bounds().max[axis],
                }));
                let at = project(&orbit, &viewport, corner);
                assert!(at.min_element() > 0.0 && at.x < 640.0 && at.y < 480.0, "{up:?} {at}");
            }
        }
    }
}

#[test]
fn a_framed_scene_is_centred_and_touches_the_edges() {
    for size in [[640, 480], [324, 480], [884, 850], [568, 300], [164, 900], [400, 300], [200, 300]] {
        for viewport in viewports() {
            let viewport = Viewport { size, ..viewport };
            let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
            let [width, height] = size.map(f64::from);
            let middle = 0.5 * DVec2::new(width, height);
            let distance = orbit.distance();
            for turned in 0..3 {
                assert!(near(project(&orbit, &viewport, orbit.pivot), middle), "{viewport:?} {turned}");
                // The sphere fills nine tenths of the picture.
                let least = ball(&orbit).map(|point| {
                    let at = project(&orbit, &viewport, point);
                    at.min_element().min(width - at.x).min(height - at.y)
                });
                let least = least.fold(f64::INFINITY, f64::min);
                let edge = 0.05 * width.min(height);
                assert!((edge - 1e-6..edge + 0.01 * width).contains(&least), "{viewport:?} {turned} {least}");
                assert!((orbit.distance() / distance - 1.0).abs() < 1e-9);
                match turned {
                    0 => orbit.view_from(ViewDirection::Left),
                    _ => orbit.set_up(Up { axis: 2, down: true }),
                }
            }
        }
    }
}

/// Points all over the framed sphere.
fn ball(orbit: &Orbit) -> impl Iterator<Item = DVec3> {
    let (pivot, radius) = (orbit.pivot, bounds().radius);
    let count = 40_000;
    (0..count).map(move |i| {
        let (z, angle) = (1.0 - (2 * i + 1) as f64 / count as f64, 2.399963 * f64::from(i));
        pivot + radius * DVec2::from_angle(angle).extend(0.0) * (1.0 - z * z).sqrt() + radius * z * DVec3::Z
    })
}

#[test]
fn points_are_projected_to_their_position_and_follow_panning() {
    let (at, delta) = (DVec2::new(100.0, 400.0), DVec2::new(33.0, -21.0));
    for viewport in viewports() {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
        let [there, deeper] = [1.0, 1.4].map(|part| orbit.point(at, part * orbit.distance(), &viewport));
        assert!(near(project(&orbit, &viewport, there), at) && near(project(&orbit, &viewport, deeper), at));
        let before = orbit.distance();
        orbit.pan(delta, &viewport);
        assert!(near(project(&orbit, &viewport, there), at + delta));
        assert!((orbit.distance() - before).abs() < 1e-9);
    }
}

#[test]
fn zooming_keeps_the_point_under_the_cursor() {
    let at = DVec2::new(500.0, 60.0);
    for viewport in viewports() {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
        let (distance, surface) = (orbit.distance(), 0.7 * orbit.distance());
        let there = orbit.point(at, surface, &viewport);
        orbit.zoom(3.0, at, Some(there), &viewport, &bounds());
        assert!(near(project(&orbit, &viewport, there), at), "{viewport:?}");
        assert!((orbit.pivot - there).length() < 1e-9, "the surface is the pivot");
        // Under a parallel projection the pivot's distance is the scale, which the surface does not change.
        let distance = if viewport.parallel { distance } else { surface };
        assert!((orbit.distance() / distance - STEP.powi(3)).abs() < 1e-12);
        // Zooming in parts, and back, gives the same.
        let mut steps = orbit;
        (0..4).for_each(|_| steps.zoom(-0.75, at, None, &viewport, &bounds()));
        orbit.zoom(-3.0, at, None, &viewport, &bounds());
        assert!((steps.eye - orbit.eye).length() < 1e-9 && (orbit.distance() / distance - 1.0).abs() < 1e-12);
        (0..10).for_each(|_| orbit.zoom(1e3, at, None, &viewport, &bounds()));
        assert!(orbit.distance() > 0.0 && orbit.camera(&viewport, &bounds()).is_ok());
    }
}

#[test]
fn turning_keeps_the_distance_and_the_pivot_wherever_it_is() {
    for viewport in viewports() {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
        let pivot = orbit.point(DVec2::new(200.0, 300.0), 0.8 * orbit.distance(), &viewport);
        let (before, other) = (project(&orbit, &viewport, pivot), DVec3::new(0.3, 5.5, 4.0));
        let other_before = project(&orbit, &viewport, other);
        orbit.set_pivot(pivot, &viewport);
        assert!(near(project(&orbit, &viewport, pivot), before), "{viewport:?}");
        if !viewport.parallel {
            assert!(near(project(&orbit, &viewport, other), other_before), "the picture stays");
        }
        let far = (orbit.eye - pivot).length();
        let mut once = orbit;
        once.turn(DVec2::new(80.0, 44.0), &viewport);
        (0..4).for_each(|_| orbit.turn(DVec2::new(20.0, 11.0), &viewport));
        assert!((once.eye - orbit.eye).length() < 1e-9, "one move, or four parts of it");
        assert!(((orbit.eye - pivot).length() - far).abs() < 1e-9);
        assert!(near(project(&orbit, &viewport, pivot), before), "the pivot keeps its position");
        orbit.turn(DVec2::new(0.0, 1e5), &viewport);
        assert!(orbit.camera(&viewport, &bounds()).is_ok(), "from straight above");
    }
}

#[test]
fn points_in_front_follow_the_cursor_as_it_turns() {
    let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &VIEWPORT);
    let front = orbit.pivot - 0.1 * orbit.axes()[0];
    orbit.turn(DVec2::new(10.0, 10.0), &VIEWPORT);
    let moved = project(&orbit, &VIEWPORT, front) - DVec2::new(320.0, 240.0);
    assert!(moved.x > 0.0 && moved.y > 0.0, "{moved}");
}

#[test]
fn turning_about_the_eye_moves_the_pivot_alone_and_points_follow_the_cursor() {
    for viewport in viewports() {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
        orbit.set_pivot(orbit.point(DVec2::new(200.0, 300.0), 0.8 * orbit.distance(), &viewport), &viewport);
        let (before, ahead) = (orbit, orbit.eye + 1e-3 * orbit.distance() * orbit.axes()[0]);
        orbit.turn_about_eye(DVec2::new(8.0, 5.0), &viewport);
        assert!((orbit.eye - before.eye).length() < 1e-12, "{viewport:?}");
        assert!((orbit.distance() / before.distance() - 1.0).abs() < 1e-9, "the pivot stays ahead");
        if !viewport.parallel {
            let clip = orbit.camera(&viewport, &bounds()).unwrap().world_to_clip() * ahead.extend(1.0);
            let moved = clip.truncate().truncate() / clip.w * DVec2::new(320.0, 240.0);
            assert!((moved - DVec2::new(8.0, 5.0)).length() < 0.1, "{moved}");
        }
        orbit.turn_about_eye(DVec2::new(0.0, 1e5), &viewport);
        assert!(orbit.camera(&viewport, &bounds()).is_ok(), "straight up");
    }
}

#[test]
fn view_directions_are_right() {
    for (direction, from) in [
        (ViewDirection::Front, DVec3::Z),
        (ViewDirection::Back, DVec3::NEG_Z),
        (ViewDirection::Right, DVec3::X),
        (ViewDirection::Left, DVec3::NEG_X),
        (ViewDirection::Top, DVec3::Y),
        (ViewDirection::Bottom, DVec3::NEG_Y),
    ] {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &VIEWPORT);
        let distance = orbit.distance();
        orbit.view_from(direction);
        assert!((orbit.eye - (orbit.pivot + distance * from)).length() < 1e-9, "{direction:?} {}", orbit.eye);
        assert!(orbit.camera(&VIEWPORT, &bounds()).is_ok());
    }
    let mut orbit = Orbit::framing(&(&bounds()).into(), Up { axis: 2, down: false }, &VIEWPORT);
    orbit.view_from(ViewDirection::Front);
    assert!((orbit.eye - orbit.pivot).normalize().abs_diff_eq(DVec3::NEG_Y, 1e-9), "z up: from −y");
}

#[test]
fn flight_moves_the_pivot_too() {
    let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &VIEWPORT);
    let (eye, distance) = (orbit.eye, orbit.distance());
    let mut parts = orbit;
    orbit.fly(DVec3::Z, 0.5, &VIEWPORT, &bounds());
    (0..5).for_each(|_| parts.fly(DVec3::Z, 0.1, &VIEWPORT, &bounds()));
    assert!((orbit.eye - parts.eye).length() < 1e-9, "independent of the frame rate");
    assert!(((orbit.eye - eye).length() - 0.5 * SPEED * distance).abs() < 1e-9);
}

#[test]
fn flight_goes_on_close_to_a_surface_but_not_past_a_parallel_picture() {
    for viewport in viewports() {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &viewport);
        orbit.zoom(100.0, viewport.centre(), None, &viewport, &bounds());
        let (eye, distance) = (orbit.eye, orbit.distance());
        orbit.fly(DVec3::X, 1.0, &viewport, &bounds());
        let least = if viewport.parallel { distance } else { FLIGHT_DISTANCE * bounds().radius };
        assert!(least >= distance && (orbit.eye - eye).length() > 0.999 * SPEED * least, "{viewport:?}");
    }
}

#[test]
fn zooming_reaches_the_surface_wherever_the_pivot_is_and_never_passes_it() {
    let at = DVec2::new(500.0, 60.0);
    for (part, steps) in [(0.1, 24.0), (3.0, 48.0)] {
        let mut orbit = Orbit::framing(&(&bounds()).into(), Y_UP, &VIEWPORT);
        let wall = orbit.point(at, part * orbit.distance(), &VIEWPORT);
        let far = orbit.distance_of(wall);
        (0..steps as u32).for_each(|_| orbit.zoom(1.0, at, Some(wall), &VIEWPORT, &bounds()));
        assert!((orbit.distance_of(wall) / far / STEP.powf(steps) - 1.0).abs() < 1e-6, "{part}");
        // A surface behind the eye is none.
        let behind = orbit;
        orbit.zoom(1.0, at, Some(orbit.eye - (wall - orbit.eye)), &VIEWPORT, &bounds());
        assert!((orbit.distance_of(wall) / behind.distance_of(wall) - STEP).abs() < 1e-6);
    }
}

#[test]
fn a_pose_gives_the_same_picture_and_stays_upright() {
    let points = [DVec3::new(0.3, 5.5, 4.0), DVec3::new(2.0, 5.1, 7.0), DVec3::new(-1.0, 6.0, 2.0)];
    let spans = [Span::Angle(31.0), Span::Height(7.0)];
    for up in [DVec3::Y, DVec3::NEG_Z, DVec3::new(0.2, -1.0, 0.7), DVec3::new(5.0, 0.0, 0.1)] {
        for span in spans {
            let pose = Pose { eye: DVec3::new(9.0, 8.0, -11.0), target: points[0], up, span };
            let mut viewport = VIEWPORT;
            let orbit = Orbit::of(&pose, DVec3::Y, &mut viewport);
            let camera = pose.camera(&bounds(), viewport.aspect()).unwrap();
            for point in points {
                let clip: DVec4 = camera.world_to_clip() * point.extend(1.0);
                let at = (clip.truncate().truncate() / clip.w * 0.5 + 0.5) * DVec2::new(640.0, 480.0);
                assert!(near(project(&orbit, &viewport, point), at), "{pose:?}");
            }
            let mut turned = orbit;
            turned.turn(DVec2::new(50.0, 30.0), &viewport);
            let above = project(&turned, &viewport, turned.pivot + 0.1 * up.normalize());
            assert!((above.x - 320.0).abs() < 1e-6, "{up}: upright still, {above}");
        }
    }
}

#[test]
fn a_saved_camera_continues_as_before() {
    for up in UPS {
        for start in viewports() {
            for delta in [DVec2::new(70.0, -20.0), DVec2::new(-30.0, 1e5)] {
                let mut orbit = Orbit::framing(&(&bounds()).into(), up, &start);
                orbit.turn(delta, &start);
                let mut viewport = Viewport { parallel: !start.parallel, ..start };
                let mut again = Orbit::of(&orbit.pose(&start), up.vector(), &mut viewport);
                assert_eq!(viewport.parallel, start.parallel);
                assert!((again.eye - orbit.eye).length() < 1e-9, "{up:?} {delta}");
                let next = DVec2::new(11.0, -40.0);
                again.turn(next, &viewport);
                orbit.turn(next, &start);
                assert!((again.eye - orbit.eye).length() < 1e-6, "{up:?} {delta} {start:?}");
            }
        }
    }
}
