//! Orbit camera: turns about a pivot, pans, zooms towards the cursor and flies.
//!
//! Positions on the picture are px from its top left; angles are radians. There is no inertia, and moves do not depend on the frame rate.

use super::directions::{Up, ViewDirection};
use super::viewport::Viewport;
use glam::{DMat3, DVec2, DVec3};
use surfel::geometry::{Bounds, Extent, Pose, Span, horizontal_axes};

/// Angle by which the camera turns when the cursor moves by the height of the picture.
const TURN: f64 = std::f64::consts::PI;
/// Factor of the distance to the pivot per step of the wheel.
const STEP: f64 = 0.85;
/// The least and the greatest distance to the pivot, in radii of the scene.
const DISTANCES: [f64; 2] = [1e-6, 1e3];
/// Speed of flight, distances to the pivot per second.
const SPEED: f64 = 0.75;
/// The least distance to the pivot that counts for the speed of flight, in radii of the scene: close to a surface, too, flight goes on.
const FLIGHT_DISTANCE: f64 = 0.02;
/// The least cosine of the pitch that turning about the eye allows for: near the poles it would turn without end.
const LEAST_COSINE: f64 = 0.25;
/// Cosine of the pitch below which the camera looks straight up or down, where the up axis of the world does not determine that of the picture.
const STRAIGHT: f64 = 1e-6;

/// Position and orientation of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Position of the eye, world space.
    pub eye: DVec3,
    /// Centre of rotation, world space; in front of the eye, but not always in the centre of the picture.
    pub pivot: DVec3,
    /// Up direction of the world, a unit vector.
    up: DVec3,
    /// Rotation about the up direction.
    yaw: f64,
    /// Angle of the eye above the horizon, from −π/2 to π/2.
    pitch: f64,
}

impl Orbit {
    /// Frames `extent` from its [default direction](Extent::view_direction).
    pub fn framing(extent: &Extent, up: Up, viewport: &Viewport) -> Self {
        let up = up.vector();
        let [right, front] = horizontal_axes(up);
        let towards = extent.view_direction([right, up, front]);
        let yaw = f64::atan2(towards.dot(right), towards.dot(front));
        let pitch = f64::atan2(towards.dot(up), towards.cross(up).length());
        let mut orbit = Self { eye: DVec3::ZERO, pivot: DVec3::ZERO, up, yaw, pitch };
        orbit.frame(extent, viewport);
        orbit
    }

    /// The orbit of a pose about its target; sets the projection of `viewport` to that of the pose. Up is the pose's up direction, or `upright` if
    /// the camera looks straight along that.
    pub fn of(pose: &Pose, upright: DVec3, viewport: &mut Viewport) -> Self {
        let forward = (pose.target - pose.eye).normalize();
        let is_straight = forward.cross(upright).length() < STRAIGHT;
        let up = if is_straight { upright } else { pose.up.normalize() };
        let [right, towards] = horizontal_axes(up);
        let across = forward.cross(pose.up).normalize();
        let yaw = f64::atan2(-across.dot(towards), across.dot(right));
        let pitch = f64::atan2(-forward.dot(up), forward.cross(up).length());
        let mut orbit = Self { eye: pose.eye, pivot: pose.target, up, yaw, pitch };
        viewport.parallel = match pose.span {
            Span::Angle(degrees) => {
                viewport.fov_y_deg = degrees;
                false
            }
            // A parallel projection shows the same from anywhere along its rays.
            Span::Height(height) => {
                orbit.eye = pose.target - 0.5 * height / viewport.tan_half_fov() * forward;
                true
            }
        };
        orbit
    }

    /// Unit vectors forward, to the right and up in the picture.
    fn axes(&self) -> [DVec3; 3] {
        let [right, towards] = horizontal_axes(self.up);
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

    /// Distance of the pivot ahead of the eye, along the view direction.
    pub fn distance(&self) -> f64 {
        self.distance_of(self.pivot)
    }

    /// Distance of a point ahead of the eye, along the view direction.
    fn distance_of(&self, point: DVec3) -> f64 {
        self.axes()[0].dot(point - self.eye)
    }

    /// The pose, as a camera file stores it.
    pub fn pose(&self, viewport: &Viewport) -> Pose {
        let [forward, _, above] = self.axes();
        let distance = self.distance().max(f64::MIN_POSITIVE);
        let span = if viewport.parallel {
            Span::Height(viewport.units_per_px(distance) * f64::from(viewport.size[1]))
        } else {
            Span::Angle(viewport.fov_y_deg)
        };
        let up = if self.pitch.cos() < STRAIGHT { above } else { self.up };
        Pose { eye: self.eye, target: self.eye + distance * forward, up, span }
    }

    /// Turns about the pivot as the cursor moves by `delta`, px: the surface follows the cursor.
    pub fn turn(&mut self, delta: DVec2, viewport: &Viewport) {
        let before = self.rotation();
        let angles = TURN / f64::from(viewport.size[1]) * delta;
        self.yaw -= angles.x;
        self.pitch = (self.pitch + angles.y).clamp(-0.5 * std::f64::consts::PI, 0.5 * std::f64::consts::PI);
        self.eye = self.pivot + self.rotation() * (before.transpose() * (self.eye - self.pivot));
    }

    /// Turns about the eye as the cursor moves by `delta`, px: points in the middle of the picture follow the cursor.
    pub fn turn_about_eye(&mut self, delta: DVec2, viewport: &Viewport) {
        let before = self.rotation();
        // In the middle of the picture a pixel is that many radians.
        let angles = viewport.units_per_px(1.0) * delta;
        self.yaw += angles.x / self.pitch.cos().max(LEAST_COSINE);
        self.pitch = (self.pitch - angles.y).clamp(-0.5 * std::f64::consts::PI, 0.5 * std::f64::consts::PI);
        self.pivot = self.eye + self.rotation() * (before.transpose() * (self.pivot - self.eye));
    }

    /// Pans as the cursor moves by `delta`, px: points at the pivot's distance follow the cursor.
    pub fn pan(&mut self, delta: DVec2, viewport: &Viewport) {
        let [_, right, up] = self.axes();
        let step = viewport.units_per_px(self.distance()) * (delta.x * right - delta.y * up);
        self.eye -= step;
        self.pivot -= step;
    }

    /// Zooms by steps of the wheel towards the point under the cursor, which stays there. `surface` is the surface point at the cursor, which
    /// becomes the pivot; without one the pivot's distance counts.
    pub fn zoom(
        &mut self,
        steps: f64,
        at: DVec2,
        surface: Option<DVec3>,
        viewport: &Viewport,
        bounds: &Bounds,
    ) {
        let [least, most] = DISTANCES.map(|distance| distance * bounds.radius);
        let surface = surface.map(|point| self.distance_of(point)).filter(|distance| *distance > 0.0);
        if let Some(distance) = surface {
            self.set_pivot(self.point(at, distance, viewport), viewport);
        }
        let distance = self.distance();
        let part = (distance * STEP.powf(steps)).clamp(least.min(distance), most.max(distance)) / distance;
        let under = self.point(at, distance, viewport);
        self.eye = under + part * (self.eye - under);
        self.pivot = under + part * (self.pivot - under);
    }

    /// The point at a distance ahead of the eye that is projected to `at`.
    pub fn point(&self, at: DVec2, distance: f64, viewport: &Viewport) -> DVec3 {
        let [forward, right, up] = self.axes();
        let scale = viewport.units_per_px(if viewport.parallel { self.distance() } else { distance });
        let at = scale * viewport.offset_from_centre(at);
        self.eye + distance * forward + at.x * right + at.y * up
    }

    /// Sets the pivot; the picture stays.
    pub fn set_pivot(&mut self, point: DVec3, viewport: &Viewport) {
        let was = self.distance();
        self.pivot = point;
        if viewport.parallel {
            // Under a parallel projection the pivot's distance sets the scale.
            self.eye += (self.distance() - was) * self.axes()[0];
        }
    }

    /// Flies for some seconds; `direction` is right, up, ahead: 1 is the usual speed.
    pub fn fly(&mut self, direction: DVec3, seconds: f64, viewport: &Viewport, bounds: &Bounds) {
        let [forward, right, up] = self.axes();
        // Under a parallel projection the pivot's distance is the scale of the picture.
        let least = if viewport.parallel { 0.0 } else { FLIGHT_DISTANCE * bounds.radius };
        let step = SPEED
            * self.distance().max(least)
            * seconds
            * (direction.x * right + direction.y * up + direction.z * forward);
        self.eye += step;
        self.pivot += step;
    }

    /// Moves the eye so that the pivot is in the centre of the picture at a distance.
    fn centre_pivot(&mut self, distance: f64) {
        self.eye = self.pivot - distance * self.axes()[0];
    }

    /// Views the pivot from a direction; the distance stays.
    pub fn view_from(&mut self, direction: ViewDirection) {
        let distance = self.distance();
        [self.yaw, self.pitch] = direction.yaw_and_pitch();
        self.centre_pivot(distance);
    }

    /// Sets the up axis; yaw, pitch and distance to the pivot stay.
    pub fn set_up(&mut self, up: Up) {
        let distance = self.distance();
        self.up = up.vector();
        self.centre_pivot(distance);
    }

    /// Up direction of the world, a unit vector.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Frames `extent`; the direction of view stays.
    pub fn frame(&mut self, extent: &Extent, viewport: &Viewport) {
        self.eye = extent.eye(self.rotation(), viewport.tan_half_fovs(), viewport.parallel);
        let forward = self.axes()[0];
        self.pivot = self.eye + (extent.centre() - self.eye).dot(forward) * forward;
    }
}

#[cfg(test)]
mod tests;
