//! The camera as hands move it: about a pivot, across the picture, towards what is under the cursor, or through the scene.
//!
//! Places on the picture are in px from its top left; angles are radians. Nothing glides on: what the hands do is what moves, and the same
//! hand's way moves the same, however many frames it takes.

use super::viewport::Viewport;
use glam::{DMat3, DVec2, DVec3};
use surfel::geometry::{Bounds, Pose, Span};

/// How far the camera turns on a way as long as the picture is high.
const TURN: f64 = std::f64::consts::PI;
/// What one step of the wheel leaves of the distance.
const STEP: f64 = 0.85;
/// Nearest to the pivot, and farthest from it, in radii of the scene.
const REACH: [f64; 2] = [1e-6, 1e3];
/// Speed of flight, distances to the pivot a second.
const SPEED: f64 = 0.75;
/// Cosine of the angle from the horizon beyond which the camera looks straight up or down, where what is up in the world tells nothing of
/// what is up in the picture.
const STRAIGHT: f64 = 1e-6;

/// What is up in the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Up {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Whether it is the other way.
    pub down: bool,
}

/// A side to look from; `Front` is where +z comes towards the viewer if y is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewDirection {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
}

/// Where the camera stands and looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// World space.
    pub eye: DVec3,
    /// What it is turned about, world space; in front of the eye, not always in the middle of the picture.
    pub pivot: DVec3,
    /// What is up in the world, of unit length.
    up: DVec3,
    /// About what is up.
    yaw: f64,
    /// Above the horizon, from −π/2 to π/2: how far the camera looks down.
    pitch: f64,
}

impl Up {
    /// y.
    #[cfg(test)]
    pub const Y: Self = Self { axis: 1, down: false };

    /// The unit vector.
    pub fn vector(self) -> DVec3 {
        let sign = if self.down { -1.0 } else { 1.0 };
        sign * DVec3::AXES[self.axis]
    }
}

/// What points to the right and towards the viewer at a yaw of 0, at right angles to `up`: right × up is towards the viewer.
fn level(up: DVec3) -> [DVec3; 2] {
    let most = up.abs().max_element();
    let axis = DVec3::AXES[if up.x.abs() == most { 1 } else { 0 }];
    let right = (axis - axis.dot(up) * up).normalize();
    [right, right.cross(up)]
}

impl Orbit {
    /// Looks at the middle of `bounds` from the front, a little from the right and above, from where all of it is seen.
    pub fn framing(bounds: &Bounds, up: Up, viewport: &Viewport) -> Self {
        let (eye, pivot) = (DVec3::ZERO, DVec3::ZERO);
        let mut orbit = Self { eye, pivot, up: up.vector(), yaw: 0.56, pitch: 0.4 };
        orbit.frame(bounds, viewport);
        orbit
    }

    /// Looks from where `pose` does, about its target; `viewport` sees what it sees. What is up in the picture is up in the world, unless the
    /// camera looks straight along `upright`: then that is.
    pub fn of(pose: &Pose, upright: DVec3, viewport: &mut Viewport) -> Self {
        let forward = (pose.target - pose.eye).normalize();
        let up = match forward.cross(upright).length() < STRAIGHT {
            true => upright,
            false => pose.up.normalize(),
        };
        let [right, towards] = level(up);
        let across = forward.cross(pose.up).normalize();
        let yaw = f64::atan2(-across.dot(towards), across.dot(right));
        let pitch = f64::atan2(-forward.dot(up), forward.cross(up).length());
        let mut orbit = Self { eye: pose.eye, pivot: pose.target, up, yaw, pitch };
        viewport.parallel = match pose.span {
            Span::Angle(degrees) => {
                viewport.fov_y_deg = degrees;
                false
            }
            // Parallel rays show the same from anywhere along them.
            Span::Height(height) => {
                orbit.eye = pose.target - 0.5 * height / viewport.tan_half_fov() * forward;
                true
            }
        };
        orbit
    }

    /// What the camera looks along, to its right and up in the picture; unit vectors.
    fn axes(&self) -> [DVec3; 3] {
        let [right, towards] = level(self.up);
        let (sin, cos) = self.yaw.sin_cos();
        let away = sin * right + cos * towards;
        let across = cos * right - sin * towards;
        let (sin, cos) = self.pitch.sin_cos();
        let forward = -(cos * away + sin * self.up);
        [forward, across, across.cross(forward)]
    }

    fn rotation(&self) -> DMat3 {
        let [forward, right, up] = self.axes();
        DMat3::from_cols(right, up, -forward)
    }

    /// Distance of the pivot ahead of the eye.
    pub fn distance(&self) -> f64 {
        self.axes()[0].dot(self.pivot - self.eye)
    }

    /// Where it stands and looks, as a camera file has it.
    pub fn pose(&self, viewport: &Viewport) -> Pose {
        let [forward, _, above] = self.axes();
        let reach = self.distance().max(f64::MIN_POSITIVE);
        let span = match viewport.parallel {
            true => Span::Height(viewport.units_per_px(reach) * f64::from(viewport.size[1])),
            false => Span::Angle(viewport.fov_y_deg),
        };
        let up = if self.pitch.cos() < STRAIGHT { above } else { self.up };
        Pose { eye: self.eye, target: self.eye + reach * forward, up, span }
    }

    /// Turns about the pivot as the cursor moves by `way`: the surface follows it.
    pub fn turn(&mut self, way: DVec2, viewport: &Viewport) {
        let before = self.rotation();
        let angles = TURN / f64::from(viewport.size[1]) * way;
        self.yaw -= angles.x;
        self.pitch = (self.pitch + angles.y).clamp(-0.5 * std::f64::consts::PI, 0.5 * std::f64::consts::PI);
        self.eye = self.pivot + self.rotation() * (before.transpose() * (self.eye - self.pivot));
    }

    /// Moves along the picture: what is as far as the pivot stays under the cursor, which moves by `way`.
    pub fn pan(&mut self, way: DVec2, viewport: &Viewport) {
        let [_, right, up] = self.axes();
        let step = viewport.units_per_px(self.distance()) * (way.x * right - way.y * up);
        self.eye -= step;
        self.pivot -= step;
    }

    /// So many steps of the wheel nearer to what is under the cursor, which stays there; `distance` is that of the surface at the cursor, or the
    /// pivot's.
    pub fn zoom(
        &mut self,
        steps: f64,
        at: DVec2,
        distance: Option<f64>,
        viewport: &Viewport,
        bounds: &Bounds,
    ) {
        let [least, most] = REACH.map(|reach| reach * bounds.radius);
        let reach = self.distance();
        let part = (reach * STEP.powf(steps)).clamp(least, most.max(reach)) / reach;
        let under = self.point(at, distance.unwrap_or(reach), viewport);
        self.eye = under + part * (self.eye - under);
        self.pivot = under + part * (self.pivot - under);
    }

    /// The point at a distance ahead of the eye that is seen at `at`.
    pub fn point(&self, at: DVec2, distance: f64, viewport: &Viewport) -> DVec3 {
        let [forward, right, up] = self.axes();
        let scale = viewport.units_per_px(if viewport.parallel { self.distance() } else { distance });
        let at = scale * viewport.offset_from_centre(at);
        self.eye + distance * forward + at.x * right + at.y * up
    }

    /// Turns about this point from now on; the picture stays.
    pub fn set_pivot(&mut self, point: DVec3, viewport: &Viewport) {
        let was = self.distance();
        self.pivot = point;
        if viewport.parallel {
            // Its distance has the picture's scale.
            self.eye += (self.distance() - was) * self.axes()[0];
        }
    }

    /// Flies for so many seconds; `way` is how much to the right, up and ahead, each from −1 to 1.
    pub fn fly(&mut self, way: DVec3, seconds: f64) {
        let [forward, right, up] = self.axes();
        let step = SPEED * self.distance() * seconds * (way.x * right + way.y * up + way.z * forward);
        self.eye += step;
        self.pivot += step;
    }

    /// Stands so far from the pivot that it is seen in the middle.
    fn stand_back(&mut self, reach: f64) {
        self.eye = self.pivot - reach * self.axes()[0];
    }

    /// Looks at the pivot from a side, from as far as now.
    pub fn view_from(&mut self, direction: ViewDirection) {
        let quarter = 0.5 * std::f64::consts::PI;
        let reach = self.distance();
        (self.yaw, self.pitch) = match direction {
            ViewDirection::Front => (0.0, 0.0),
            ViewDirection::Right => (quarter, 0.0),
            ViewDirection::Back => (2.0 * quarter, 0.0),
            ViewDirection::Left => (-quarter, 0.0),
            ViewDirection::Top => (0.0, quarter),
            ViewDirection::Bottom => (0.0, -quarter),
        };
        self.stand_back(reach);
    }

    /// Makes something else up; looks at the pivot from as far as now, as it did from as far round.
    pub fn set_up(&mut self, up: Up) {
        let reach = self.distance();
        self.up = up.vector();
        self.stand_back(reach);
    }

    /// What is up in the world, of unit length.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Shows all of `bounds`, from where it looks.
    pub fn frame(&mut self, bounds: &Bounds, viewport: &Viewport) {
        let radius = if bounds.radius > 0.0 { 1.04 * bounds.radius } else { 1.0 };
        let slope = viewport.tan_half_fovs().into_iter().fold(f64::INFINITY, f64::min);
        // The way from a sphere's centre to the edge of the view beside it: at right angles to that.
        let slant = if viewport.parallel { 1.0 } else { slope.hypot(1.0) };
        let reach = radius * slant / slope;
        self.pivot = bounds.centre();
        self.stand_back(reach);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;
    use surfel::Result;
    use surfel::geometry::Camera;

    const VIEWPORT: Viewport = Viewport { size: [640, 480], fov_y_deg: 46.0, parallel: false };
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

    /// Where a point is on the picture.
    fn seen(orbit: &Orbit, viewport: &Viewport, point: DVec3) -> DVec2 {
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
    fn what_is_up_is_up_and_all_is_seen() {
        for up in UPS {
            for viewport in viewports() {
                let orbit = Orbit::framing(&bounds(), up, &viewport);
                assert!(near(seen(&orbit, &viewport, orbit.pivot), DVec2::new(320.0, 240.0)));
                let above = seen(&orbit, &viewport, orbit.pivot + 0.1 * up.vector());
                assert!((above.x - 320.0).abs() < 1e-6 && above.y < 239.0, "{up:?} {above}");
                for i in 0..8 {
                    let corner = DVec3::from_array(std::array::from_fn(|axis| match i >> axis & 1 {
                        0 => bounds().min[axis],
                        _ => bounds().max[axis],
                    }));
                    let at = seen(&orbit, &viewport, corner);
                    assert!(at.min_element() > 0.0 && at.x < 640.0 && at.y < 480.0, "{up:?} {at}");
                }
            }
        }
    }

    #[test]
    fn what_is_framed_is_in_the_middle_and_touches_the_edges() {
        for size in [[640, 480], [324, 480], [884, 850], [568, 300], [164, 900], [400, 300], [200, 300]] {
            for viewport in viewports() {
                let viewport = Viewport { size, ..viewport };
                let mut orbit = Orbit::framing(&bounds(), Up::Y, &viewport);
                let [width, height] = size.map(f64::from);
                let middle = 0.5 * DVec2::new(width, height);
                let reach = orbit.distance();
                for turned in 0..3 {
                    assert!(near(seen(&orbit, &viewport, orbit.pivot), middle), "{viewport:?} {turned}");
                    // Whatever is within 1.04 radii is seen, and something there only just.
                    let least = ball(&orbit).map(|point| {
                        let at = seen(&orbit, &viewport, point);
                        at.min_element().min(width - at.x).min(height - at.y)
                    });
                    let least = least.fold(f64::INFINITY, f64::min);
                    assert!((-1e-6..0.01 * width).contains(&least), "{viewport:?} {turned} {least}");
                    assert!((orbit.distance() / reach - 1.0).abs() < 1e-9);
                    match turned {
                        0 => orbit.view_from(ViewDirection::Left),
                        _ => orbit.set_up(Up { axis: 2, down: true }),
                    }
                }
            }
        }
    }

    /// Points all over the sphere that is framed.
    fn ball(orbit: &Orbit) -> impl Iterator<Item = DVec3> {
        let (pivot, radius) = (orbit.pivot, 1.04 * bounds().radius);
        let count = 40_000;
        (0..count).map(move |i| {
            let (z, angle) = (1.0 - (2 * i + 1) as f64 / count as f64, 2.399963 * f64::from(i));
            pivot
                + radius * DVec2::from_angle(angle).extend(0.0) * (1.0 - z * z).sqrt()
                + radius * z * DVec3::Z
        })
    }

    #[test]
    fn points_lie_where_they_are_seen_and_panning_takes_them_along() {
        let (at, way) = (DVec2::new(100.0, 400.0), DVec2::new(33.0, -21.0));
        for viewport in viewports() {
            let mut orbit = Orbit::framing(&bounds(), Up::Y, &viewport);
            let [there, deeper] = [1.0, 1.4].map(|part| orbit.point(at, part * orbit.distance(), &viewport));
            assert!(near(seen(&orbit, &viewport, there), at) && near(seen(&orbit, &viewport, deeper), at));
            let before = orbit.distance();
            orbit.pan(way, &viewport);
            assert!(near(seen(&orbit, &viewport, there), at + way));
            assert!((orbit.distance() - before).abs() < 1e-9);
        }
    }

    #[test]
    fn zooming_leaves_what_is_under_the_cursor() {
        let at = DVec2::new(500.0, 60.0);
        for viewport in viewports() {
            let mut orbit = Orbit::framing(&bounds(), Up::Y, &viewport);
            let (reach, surface) = (orbit.distance(), 0.7 * orbit.distance());
            let there = orbit.point(at, surface, &viewport);
            orbit.zoom(3.0, at, Some(surface), &viewport, &bounds());
            assert!(near(seen(&orbit, &viewport, there), at), "{viewport:?}");
            assert!((orbit.distance() / reach - STEP.powi(3)).abs() < 1e-12);
            // One step at a time, and back, is the same.
            let mut steps = orbit;
            (0..4).for_each(|_| steps.zoom(-0.75, at, None, &viewport, &bounds()));
            orbit.zoom(-3.0, at, None, &viewport, &bounds());
            assert!(
                (steps.eye - orbit.eye).length() < 1e-9 && (orbit.distance() / reach - 1.0).abs() < 1e-12
            );
            (0..10).for_each(|_| orbit.zoom(1e3, at, None, &viewport, &bounds()));
            assert!(orbit.distance() > 0.0 && orbit.camera(&viewport, &bounds()).is_ok());
        }
    }

    #[test]
    fn turning_keeps_the_distance_and_the_pivot_wherever_it_is() {
        for viewport in viewports() {
            let mut orbit = Orbit::framing(&bounds(), Up::Y, &viewport);
            let pivot = orbit.point(DVec2::new(200.0, 300.0), 0.8 * orbit.distance(), &viewport);
            let (before, other) = (seen(&orbit, &viewport, pivot), DVec3::new(0.3, 5.5, 4.0));
            let place = seen(&orbit, &viewport, other);
            orbit.set_pivot(pivot, &viewport);
            assert!(near(seen(&orbit, &viewport, pivot), before), "{viewport:?}");
            if !viewport.parallel {
                assert!(near(seen(&orbit, &viewport, other), place), "the picture stays");
            }
            let far = (orbit.eye - pivot).length();
            let mut once = orbit;
            once.turn(DVec2::new(80.0, 44.0), &viewport);
            (0..4).for_each(|_| orbit.turn(DVec2::new(20.0, 11.0), &viewport));
            assert!((once.eye - orbit.eye).length() < 1e-9, "one way, or four parts of it");
            assert!(((orbit.eye - pivot).length() - far).abs() < 1e-9);
            assert!(near(seen(&orbit, &viewport, pivot), before), "the pivot stays where it is seen");
            orbit.turn(DVec2::new(0.0, 1e5), &viewport);
            assert!(orbit.camera(&viewport, &bounds()).is_ok(), "from straight above");
        }
    }

    #[test]
    fn what_is_in_front_follows_the_cursor_as_it_turns() {
        let mut orbit = Orbit::framing(&bounds(), Up::Y, &VIEWPORT);
        let front = orbit.pivot - 0.1 * orbit.axes()[0];
        orbit.turn(DVec2::new(10.0, 10.0), &VIEWPORT);
        let moved = seen(&orbit, &VIEWPORT, front) - DVec2::new(320.0, 240.0);
        assert!(moved.x > 0.0 && moved.y > 0.0, "{moved}");
    }

    #[test]
    fn sides_are_seen_from_where_they_are() {
        for (side, from) in [
            (ViewDirection::Front, DVec3::Z),
            (ViewDirection::Back, DVec3::NEG_Z),
            (ViewDirection::Right, DVec3::X),
            (ViewDirection::Left, DVec3::NEG_X),
            (ViewDirection::Top, DVec3::Y),
            (ViewDirection::Bottom, DVec3::NEG_Y),
        ] {
            let mut orbit = Orbit::framing(&bounds(), Up::Y, &VIEWPORT);
            let reach = orbit.distance();
            orbit.view_from(direction);
            assert!((orbit.eye - (orbit.pivot + reach * from)).length() < 1e-9, "{side:?} {}", orbit.eye);
            assert!(orbit.camera(&VIEWPORT, &bounds()).is_ok());
        }
        let mut orbit = Orbit::framing(&bounds(), Up { axis: 2, down: false }, &VIEWPORT);
        orbit.view_from(ViewDirection::Front);
        assert!((orbit.eye - orbit.pivot).normalize().abs_diff_eq(DVec3::NEG_Y, 1e-9), "z up: from −y");
    }

    #[test]
    fn flight_takes_the_pivot_along() {
        let mut orbit = Orbit::framing(&bounds(), Up::Y, &VIEWPORT);
        let (eye, reach) = (orbit.eye, orbit.distance());
        let mut parts = orbit;
        orbit.fly(DVec3::new(0.0, 0.0, 1.0), 0.5);
        (0..5).for_each(|_| parts.fly(DVec3::new(0.0, 0.0, 1.0), 0.1));
        assert!((orbit.eye - parts.eye).length() < 1e-9, "whatever the frames");
        assert!(((orbit.eye - eye).length() - 0.5 * SPEED * reach).abs() < 1e-9);
    }

    #[test]
    fn what_a_pose_shows_is_shown_and_turns_upright() {
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
                    assert!(near(seen(&orbit, &viewport, point), at), "{pose:?}");
                }
                let mut turned = orbit;
                turned.turn(DVec2::new(50.0, 30.0), &viewport);
                let above = seen(&turned, &viewport, turned.pivot + 0.1 * up.normalize());
                assert!((above.x - 320.0).abs() < 1e-6, "{up}: upright still, {above}");
            }
        }
    }

    #[test]
    fn a_camera_that_was_kept_goes_on_as_it_was() {
        for up in UPS {
            for start in viewports() {
                for way in [DVec2::new(70.0, -20.0), DVec2::new(-30.0, 1e5)] {
                    let mut orbit = Orbit::framing(&bounds(), up, &start);
                    orbit.turn(way, &start);
                    let mut viewport = Viewport { parallel: !start.parallel, ..start };
                    let mut again = Orbit::of(&orbit.pose(&start), up.vector(), &mut viewport);
                    assert_eq!(viewport.parallel, start.parallel);
                    assert!((again.eye - orbit.eye).length() < 1e-9, "{up:?} {way}");
                    let next = DVec2::new(11.0, -40.0);
                    again.turn(next, &viewport);
                    orbit.turn(next, &start);
                    assert!((again.eye - orbit.eye).length() < 1e-6, "{up:?} {way} {start:?}");
                }
            }
        }
    }
}
