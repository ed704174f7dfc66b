//! The numbers that the shaders need of camera, settings and picture size (`shaders-glsl/lib/frame.glsl`), from float64.

use super::splat_buffers::ALIGNMENT;
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Camera, Projection};
use crate::scene::instance::{Placed, Similarity, first_ids};
use crate::settings::Settings;
use crate::settings::splatting::Kernel;
use crate::vk::shaders::layout::{Frame, View};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer};
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, DVec4, Vec3};

/// Bytes of the camera as an instance has it.
pub const VIEW: u64 = size_of::<View>() as u64;
/// Where the camera begins in a buffer that it shares with what all instances have alike, bytes.
const VIEW_START: u64 = (size_of::<Frame>() as u64).next_multiple_of(ALIGNMENT);
/// Bytes of such a buffer.
pub const BYTES: u64 = VIEW_START + VIEW;

/// Where shaders see what such a buffer holds.
pub fn bindings(buffer: &Buffer) -> [(&'static shaders::Resource, Binding<'_>); 2] {
    let frame = Binding::Uniform(buffer, 0, size_of::<Frame>() as u64);
    [(&resource::FRAME, frame), (&resource::VIEWS, Binding::Uniform(buffer, VIEW_START, VIEW))]
}

/// The numbers of a frame.
pub struct Blocks {
    /// What all instances have alike.
    pub frame: Frame,
    /// The camera for passes over pixels, and for the only scene if that stands as it is.
    pub view: View,
    /// Otherwise for each instance.
    pub instances: Vec<View>,
}

impl Blocks {
    /// Those of a frame of these scenes.
    pub fn new(camera: &Camera, settings: &Settings, size: [u32; 2], scenes: &[Placed<'_>]) -> Result<Self> {
        let bounds = scenes.iter().map(Placed::bounds).reduce(|all, bounds| all.with(&bounds));
        let alone = match scenes {
            [Placed { scene, placement: None }] => Some(scene.origin()),
            _ => None,
        };
        let origin = alone.unwrap_or_default();
        let (lens, projection) = lens(camera, size)?;
        let mut view = view(&lens, &projection, origin);
        turn(&mut view, settings, &Similarity::IDENTITY);
        let frame = frame(settings, size, (&lens, &projection), bounds.as_ref());
        let listed = if alone.is_some() { &[] } else { scenes };
        let instances = listed.iter().zip(first_ids(scenes));
        let instances = instances.map(|(placed, first)| instance(camera, settings, size, placed, first));
        Ok(Self { frame, view, instances: instances.collect::<Result<_>>()? })
    }

    /// What all instances have alike, and the camera, as a buffer has them.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = bytemuck::bytes_of(&self.frame).to_vec();
        bytes.resize(VIEW_START as usize, 0);
        bytes.extend_from_slice(bytemuck::bytes_of(&self.view));
        bytes
    }
}

/// The camera as a placed scene has it, whose first point has this number in the frame.
fn instance(
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    placed: &Placed<'_>,
    first: u32,
) -> Result<View> {
    let placement = placed.placement.unwrap_or(Similarity::IDENTITY);
    let camera = placed.placement.map_or(*camera, |placement| placement.seen_by(camera));
    let (lens, projection) = lens(&camera, size)?;
    let mut view = view(&lens, &projection, placed.scene.origin());
    view.first_id = first;
    turn(&mut view, settings, &placement);
    Ok(view)
}

/// What a scene that is placed needs of the world: its axes and unit there, and the lights in its own axes.
fn turn(view: &mut View, settings: &Settings, placement: &Similarity) {
    let turn = placement.rotation();
    view.scale = placement.scale() as f32;
    for (column, axis) in view.rotation.iter_mut().zip([turn.x_axis, turn.y_axis, turn.z_axis]) {
        column[..3].copy_from_slice(&axis.as_vec3().to_array());
    }
    for (own, light) in view.to_light.iter_mut().zip(&settings.lighting.directional) {
        let to_light = turn.transpose() * Vec3::from_array(light.to_light).as_dvec3();
        own[..3].copy_from_slice(&to_light.as_vec3().to_array());
    }
}

/// The camera for positions relative to `origin`.
fn view(lens: &Lens, projection: &Projection, origin: DVec3) -> View {
    let mut view = View::zeroed();
    for (i, row) in lens.rows.into_iter().enumerate() {
        [view.rows_hi[i], view.rows_lo[i]] = split(row);
    }
    [view.eye_hi, view.eye_lo] = split((lens.eye - origin).extend(0.0));
    [view.forward_hi, view.forward_lo] = split(lens.forward.extend(0.0));
    for (i, row) in lens.rows.iter().take(2).enumerate() {
        let row = row.truncate();
        let flat = row - row.dot(lens.forward) * lens.forward;
        view.flat_rows[i][..3].copy_from_slice(&flat.as_vec3().to_array());
    }
    let key = DepthKey::new(projection);
    for (i, column) in key.rays(lens, projection).into_iter().enumerate() {
        [view.ray_hi[i], view.ray_lo[i]] = split(column.extend(0.0));
    }
    view.jacobian = lens.jacobian as f32;
    view.near = projection.near as f32;
    view.key_slope = key.slope as f32;
    view
}

/// What all scenes have alike; `bounds` are those of all that is seen, in the camera's world.
fn frame(
    settings: &Settings,
    size: [u32; 2],
    (lens, projection): (&Lens, &Projection),
    bounds: Option<&Bounds>,
) -> Frame {
    let mut frame = Frame::zeroed();
    let key = DepthKey::new(projection);
    frame.viewport = size.map(|side| side as f32);
    frame.near = projection.near as f32;
    frame.key_slope = key.slope as f32;
    frame.key_far = key.far as f32;
    let distance = bounds.map_or(projection.near, |bounds| lens.distance(bounds.centre()));
    frame.key_gain = key.gain(projection, distance) as f32;
    frame.cutoff = settings.cutoff;
    frame.epsilon = settings.epsilon;
    if let Kernel::Confetti { a, n } = settings.splatting.kernel {
        [frame.kernel_a, frame.kernel_n] = [a, n];
    }
    frame.visibility_lowpass = settings.least_lowpass();
    frame.attribute_lowpass = settings.attribute_lowpass();
    let light = &settings.lighting;
    frame.background = settings.background.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
    let [r, g, b] = light.albedo;
    frame.albedo = [r, g, b, light.headlight];
    frame.ambient = light.ambient;
    frame.specular = light.specular;
    frame.shininess = light.shininess;
    for (radiance, directional) in frame.radiance.iter_mut().zip(&light.directional) {
        radiance[..3].copy_from_slice(&directional.radiance);
    }
    frame
}

fn lens(camera: &Camera, size: [u32; 2]) -> Result<(Lens, Projection)> {
    let projection = camera.projection()?;
    Ok((Lens::new(camera, &projection, size)?, projection))
}

/// A vector as the sum of two float vectors: 48 bits of its coordinates.
fn split(v: DVec4) -> [[f32; 4]; 2] {
    let hi = v.as_vec4();
    let lo = (v - hi.as_dvec4()).as_vec4();
    [hi.to_array(), lo.to_array()]
}

/// The camera as rays through an eye.
struct Lens {
    /// World → homogeneous pixel (x, y, w) for positions relative to `eye`; w is the distance along `forward` in perspective.
    rows: [DVec4; 3],
    /// Where the rays meet; for parallel rays, the origin of eye space.
    eye: DVec3,
    /// Unit viewing direction.
    forward: DVec3,
    /// Columns: the ray of pixel (x, y) is `c0 x + c1 y + c2`: relative to the eye the point at distance 1 in perspective, the
    /// point on the eye plane otherwise.
    pixel: DMat3,
    /// Determinant that scales `√|V|`, see `footprint.glsl`.
    jacobian: f64,
}

impl Lens {
    fn new(camera: &Camera, projection: &Projection, size: [u32; 2]) -> Result<Self> {
        let world_to_clip = camera.world_to_clip();
        let scale = camera.projection.row(3).abs().max_element();
        let [x, y, w] = [0, 1, 3].map(|i| world_to_clip.row(i) / scale);
        let [half_width, half_height] = size.map(|side| 0.5 * f64::from(side));
        let rows = [half_width * (x + w), half_height * (y + w), w];
        let forward = projection.forward * camera.view.row(2).truncate().normalize();
        // The rows' directions, with the viewing direction in the place of parallel rays' constant w.
        let [x, y, w] = rows.map(DVec4::truncate);
        let third = if projection.perspective { w } else { forward };
        let inverse = DMat3::from_cols(x, y, third).transpose().inverse();
        let eye = match projection.perspective {
            true => inverse * -DVec3::from_array(rows.map(|row| row.w)),
            false => camera.view.inverse().transform_point3(DVec3::ZERO),
        };
        if !inverse.is_finite() || !eye.is_finite() {
            let text = "the camera's matrices are singular: give a field of view and axes of some extent";
            return Err(Error::Usage(text.into()));
        }
        let at_eye = rows.map(|row| if projection.perspective { 0.0 } else { row.dot(eye.extend(1.0)) });
        // Pixel (x, y) relative to the eye's, with w = 1 in perspective.
        let [x0, y0, _] = at_eye;
        let last = DVec3::new(-x0, -y0, if projection.perspective { 1.0 } else { 0.0 });
        let relative = DMat3::from_cols(DVec3::X, DVec3::Y, last);
        let jacobian = if projection.perspective { 1.0 / inverse.determinant() } else { x.cross(y).length() };
        let rows = [0, 1, 2].map(|i| rows[i].truncate().extend(at_eye[i]));
        Ok(Self { rows, eye, forward, pixel: inverse * relative, jacobian: jacobian.abs() })
    }

    /// Distance of a world point from the eye plane.
    fn distance(&self, point: DVec3) -> f64 {
        self.forward.dot(point - self.eye)
    }
}

/// The depth key κ: 1 at the near plane, falling with distance, affine on the screen for every plane.
struct DepthKey {
    /// Orthographic: −dκ/dz. The far plane's κ is ½, which leaves room for surfaces moved back by ε.
    slope: f64,
    /// κ of the far plane.
    far: f64,
}

impl DepthKey {
    fn new(projection: &Projection) -> Self {
        match projection.perspective {
            true => Self { slope: 0.0, far: projection.near / projection.far },
            // Rounded before it is used, so that the shaders' slope is the one that the rays are made with.
            false => Self { slope: f64::from((0.5 / (projection.far - projection.near)) as f32), far: 0.5 },
        }
    }

    /// Columns that give κ of a plane at a pixel, see `frame.glsl`.
    fn rays(&self, lens: &Lens, projection: &Projection) -> [DVec3; 3] {
        let DMat3 { x_axis, y_axis, z_axis } = lens.pixel;
        match projection.perspective {
            true => [x_axis, y_axis, z_axis].map(|column| projection.near * column),
            false => {
                let at_eye = (1.0 + projection.near * self.slope) * lens.forward;
                [self.slope * x_axis, self.slope * y_axis, self.slope * z_axis + at_eye]
            }
        }
    }

    /// The inverse of κ at `distance`, so that κ times it is near 1 where the scene is.
    fn gain(&self, projection: &Projection, distance: f64) -> f64 {
        match projection.perspective {
            true => distance.max(projection.near) / projection.near,
            false => 1.0,
        }
    }
}
