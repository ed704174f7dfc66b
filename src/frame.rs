//! The numbers that the shaders need of camera, settings and picture size (`shaders-glsl/lib/frame.glsl`), from float64.

use crate::error::{Error, Result};
use crate::geometry::{Bounds, Camera, Projection};
use crate::settings::Settings;
use crate::vk::shaders::layout::Frame;
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, DVec4};

/// The frame block for positions relative to `origin`; `bounds` are the scene's, in the camera's world.
pub(crate) fn frame(
    camera: &Camera,
    settings: &Settings,
    size: [u32; 2],
    origin: DVec3,
    bounds: &Bounds,
) -> Result<Frame> {
    let projection = camera.projection()?;
    let lens = Lens::new(camera, &projection, size)?;
    let mut frame = Frame::zeroed();
    [frame.clip_x, frame.clip_y, frame.clip_w] = lens.clip.map(|row| row.as_vec4().to_array());
    [frame.eye_hi, frame.eye_lo] = split(lens.eye - origin);
    [frame.forward_hi, frame.forward_lo] = split(lens.forward);
    let key = DepthKey::new(&projection);
    for (i, column) in key.rays(&lens, &projection).into_iter().enumerate() {
        [frame.ray_hi[i], frame.ray_lo[i]] = split(column);
    }
    frame.viewport = size.map(|side| side as f32);
    frame.jacobian = lens.jacobian as f32;
    frame.near = projection.near as f32;
    frame.key_slope = key.slope as f32;
    frame.key_far = key.far as f32;
    frame.key_gain = key.gain(&projection, lens.distance(bounds.centre())) as f32;
    frame.cutoff = settings.cutoff;
    frame.epsilon = settings.epsilon;
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
fn split(v: DVec3) -> [[f32; 4]; 2] {
    let hi = v.as_vec3();
    let lo = (v - hi.as_dvec3()).as_vec3();
    [hi.extend(0.0).to_array(), lo.extend(0.0).to_array()]
}

/// The camera as rays through an eye.
struct Lens {
    /// Rows x, y, w of world → clip for positions relative to `eye`; clip w is the distance along `forward` in perspective.
    clip: [DVec4; 3],
    /// Where the rays meet; for parallel rays, the origin of eye space.
    eye: DVec3,
    /// Unit viewing direction.
    forward: DVec3,
    /// Columns: the ray of pixel (x, y) is `c0 x + c1 y + c2`: relative to the eye the point at distance 1 in perspective, the
    /// point on the eye plane otherwise.
    pixel: DMat3,
    /// `(W/2)(H/2) |det|` of the projection, see `√|V|` in `conic.glsl`.
    jacobian: f64,
}

impl Lens {
    fn new(camera: &Camera, projection: &Projection, size: [u32; 2]) -> Result<Self> {
        let world_to_clip = camera.world_to_clip();
        let rows = [0, 1, 3].map(|i| world_to_clip.row(i));
        let scale = camera.projection.row(3).abs().max_element();
        let [x, y, w] = rows.map(|row| row / scale);
        let forward = projection.forward * camera.view.row(2).truncate().normalize();
        let eye_of_view = camera.view.inverse().transform_point3(DVec3::ZERO);
        let third = if projection.perspective { w.truncate() } else { forward };
        // Columns of `matrix` are the rows of the projection.
        let matrix = DMat3::from_cols(x.truncate(), y.truncate(), third).transpose();
        let inverse = matrix.inverse();
        if !inverse.is_finite() || !eye_of_view.is_finite() {
            return Err(Error::Usage(
                "the camera's matrices are singular: give a field of view and axes of some extent".into(),
            ));
        }
        let eye = if projection.perspective { inverse * -DVec3::new(x.w, y.w, w.w) } else { eye_of_view };
        let at_eye = [x, y, w].map(|row| row.dot(eye.extend(1.0)));
        let offset = if projection.perspective { [0.0; 3] } else { at_eye };
        let clip = [x, y, w].into_iter().zip(offset).map(|(row, at)| row.truncate().extend(at));
        let clip = {
            let mut clip = clip;
            [clip.next(), clip.next(), clip.next()].map(Option::unwrap_or_default)
        };
        // Pixel (px, py, 1) to ndc relative to the eye's, then to the world.
        let [width, height] = size.map(f64::from);
        let to_ndc = DMat3::from_cols(
            DVec3::new(2.0 / width, 0.0, 0.0),
            DVec3::new(0.0, 2.0 / height, 0.0),
            DVec3::new(-1.0 - offset[0], -1.0 - offset[1], if projection.perspective { 1.0 } else { 0.0 }),
        );
        let determinant = if projection.perspective {
            matrix.determinant()
        } else {
            x.truncate().cross(y.truncate()).length()
        };
        Ok(Self {
            clip,
            eye,
            forward,
            pixel: inverse * to_ndc,
            jacobian: 0.25 * width * height * determinant.abs(),
        })
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
            false => Self { slope: 0.5 / (projection.far - projection.near), far: 0.5 },
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
