//! The numbers that the shaders need of camera, settings and picture size (`shaders-glsl/lib/frame.glsl`), from float64.

use crate::error::{Error, Result};
use crate::geometry::{Bounds, Camera, Projection};
use crate::scene::instance::{Placed, Similarity};
use crate::settings::Settings;
use crate::settings::splatting::Kernel;
use crate::vk::shaders::layout::Frame;
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, DVec4, Vec3};

/// The numbers of a frame.
pub struct Blocks {
    /// Those of passes over pixels, and of the only scene if that stands as it is.
    pub view: Frame,
    /// Otherwise each scene's own.
    pub scenes: Vec<Frame>,
}

impl Blocks {
    /// Those of a frame of these scenes.
    pub fn new(camera: &Camera, settings: &Settings, size: [u32; 2], scenes: &[Placed<'_>]) -> Result<Self> {
        let bounds = scenes.iter().map(Placed::bounds).reduce(|all, bounds| all.with(&bounds));
        if let [Placed { scene, placement: None }] = scenes {
            let view = frame(camera, settings, size, scene.origin(), bounds.as_ref())?;
            return Ok(Self { view, scenes: Vec::new() });
        }
        let view = frame(camera, settings, size, DVec3::ZERO, bounds.as_ref())?;
        let own = |placed: &Placed<'_>| {
            let origin = placed.scene.origin();
            let camera = placed.placement.map_or(*camera, |placement| placement.seen_by(camera));
            let mut block = frame(&camera, settings, size, origin, None)?;
            block.key_gain = view.key_gain;
            if let Some(placement) = &placed.placement {
                place(&mut block, &view, settings, placement);
            }
            Ok(block)
        };
        let scenes = scenes.iter().map(own).collect::<Result<_>>()?;
        Ok(Self { view, scenes })
    }

    /// Each block.
    pub fn each(&mut self) -> impl Iterator<Item = &mut Frame> {
        std::iter::once(&mut self.view).chain(&mut self.scenes)
    }
}

/// What of a placed scene's block tells of the world, and what of the world comes to it turned.
fn place(block: &mut Frame, view: &Frame, settings: &Settings, placement: &Similarity) {
    let turn = placement.rotation();
    block.scale = placement.scale() as f32;
    block.world_near = view.near;
    block.world_key_slope = view.key_slope;
    for (column, axis) in block.turn.iter_mut().zip([turn.x_axis, turn.y_axis, turn.z_axis]) {
        column[..3].copy_from_slice(&axis.as_vec3().to_array());
    }
    for (own, light) in block.to_light.iter_mut().zip(&settings.lighting.directional) {
        let to_light = turn.transpose() * Vec3::from_array(light.to_light).as_dvec3();
        own[..3].copy_from_slice(&to_light.as_vec3().to_array());
    }
}

/// The frame block for positions relative to `origin`; `bounds` are those of all that is seen, in the camera's world.
fn frame(
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    origin: DVec3,
    bounds: Option<&Bounds>,
) -> Result<Frame> {
    let projection = camera.projection()?;
    let lens = Lens::new(camera, &projection, size)?;
    let mut frame = Frame::zeroed();
    for (i, row) in lens.rows.into_iter().enumerate() {
        [frame.rows_hi[i], frame.rows_lo[i]] = split(row);
    }
    [frame.eye_hi, frame.eye_lo] = split((lens.eye - origin).extend(0.0));
    [frame.forward_hi, frame.forward_lo] = split(lens.forward.extend(0.0));
    for (i, row) in lens.rows.iter().take(2).enumerate() {
        let row = row.truncate();
        let flat = row - row.dot(lens.forward) * lens.forward;
        frame.flat_rows[i][..3].copy_from_slice(&flat.as_vec3().to_array());
    }
    let key = DepthKey::new(&projection);
    for (i, column) in key.rays(&lens, &projection).into_iter().enumerate() {
        [frame.ray_hi[i], frame.ray_lo[i]] = split(column.extend(0.0));
    }
    frame.viewport = size.map(|side| side as f32);
    frame.jacobian = lens.jacobian as f32;
    frame.near = projection.near as f32;
    frame.key_slope = key.slope as f32;
    frame.key_far = key.far as f32;
    let distance = bounds.map_or(projection.near, |bounds| lens.distance(bounds.centre()));
    frame.key_gain = key.gain(&projection, distance) as f32;
    frame.cutoff = settings.cutoff;
    frame.epsilon = settings.epsilon;
    if let Kernel::Confetti { a, n } = settings.splatting.kernel {
        [frame.kernel_a, frame.kernel_n] = [a, n];
    }
    frame.visibility_lowpass = settings.least_lowpass();
    frame.attribute_lowpass = settings.attribute_lowpass();
    shading(&mut frame, settings);
    Ok(frame)
}

fn shading(frame: &mut Frame, settings: &Settings) {
    let light = &settings.lighting;
    frame.background = settings.background.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
    let [r, g, b] = light.albedo;
    frame.albedo = [r, g, b, light.headlight];
    frame.ambient = light.ambient;
    frame.specular = light.specular;
    frame.shininess = light.shininess;
    for (i, directional) in light.directional.iter().enumerate() {
        frame.to_light[i][..3].copy_from_slice(&directional.to_light);
        frame.radiance[i][..3].copy_from_slice(&directional.radiance);
    }
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
