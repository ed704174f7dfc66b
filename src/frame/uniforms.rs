//! Frame uniforms of shaders (`shaders-glsl/lib/frame.glsl`), computed in float64 from camera, settings and size.

use super::splat_buffers::ALIGNMENT;
use crate::error::{Error, Result};
use crate::geometry::{Bounds, Camera, LevelTable, MOST_LEVELS, Projection};
use crate::scene::instance::{Placed, Similarity, first_ids};
use crate::settings::Settings;
use crate::settings::splatting::Kernel;
use crate::vk::shaders::layout::{Frame, View};
use crate::vk::shaders::{self, resource};
use crate::vk::{Binding, Buffer};
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, DVec4, Vec3};

/// Bytes of the view of an instance.
pub const VIEW: u64 = size_of::<View>() as u64;
/// Offset of the view in the uniform buffer of a frame, bytes.
const VIEW_START: u64 = (size_of::<Frame>() as u64).next_multiple_of(ALIGNMENT);
/// Bytes of the uniform buffer of a frame.
pub const BYTES: u64 = VIEW_START + VIEW;

/// Bindings of the uniform buffer of a frame.
pub fn bindings(buffer: &Buffer) -> [(&'static shaders::Resource, Binding<'_>); 2] {
    let frame = Binding::Uniform(buffer, 0, size_of::<Frame>() as u64);
    [(&resource::FRAME, frame), (&resource::VIEWS, Binding::Uniform(buffer, VIEW_START, VIEW))]
}

/// Uniforms of a frame.
pub struct Uniforms {
    /// Uniforms shared by all instances.
    pub frame: Frame,
    /// The view of passes over pixels, and of a single scene without placement.
    pub view: View,
    /// Views of instances, in other cases.
    pub instances: Vec<View>,
}

impl Uniforms {
    /// The uniforms of a frame of these scenes.
    pub fn new(camera: &Camera, settings: &Settings, size: [u32; 2], scenes: &[Placed<'_>]) -> Result<Self> {
        let bounds = scenes.iter().map(Placed::bounds).reduce(|all, bounds| all.with(&bounds));
        let single_origin = match scenes {
            [Placed { scene, placement: None }] => Some(scene.origin()),
            _ => None,
        };
        let origin = single_origin.unwrap_or_default();
        let sure = scenes.iter().map(Placed::sure_bounds).reduce(|all, bounds| Some(all?.with(&bounds?)));
        let depths = DepthRange::new(camera, size, sure.flatten().as_ref())?;
        let (rays, projection) = camera_rays(camera, size, &depths, 1.0)?;
        let mut view = view(&rays, &projection, &depths.in_unit(1.0), origin);
        apply_placement(&mut view, settings, &Similarity::IDENTITY);
        let table = scenes.first().and_then(|placed| placed.scene.level_table());
        apply_levels(&mut view, settings, table);
        let frame = frame(settings, size, (&rays, &projection, &depths), bounds.as_ref());
        let instanced = if single_origin.is_some() { &[] } else { scenes };
        let instances = instanced.iter().zip(first_ids(scenes));
        let instances =
            instances.map(|(placed, first)| instance_view((camera, &depths), settings, size, placed, first));
        Ok(Self { frame, view, instances: instances.collect::<Result<_>>()? })
    }

    /// Whether the camera is in perspective, and the scenes are far away in a narrow field of view.
    pub fn is_distant(&self) -> bool {
        self.frame.key_offset != [0.0; 2]
    }

    /// Contents of the uniform buffer of a frame.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = bytemuck::bytes_of(&self.frame).to_vec();
        bytes.resize(VIEW_START as usize, 0);
        bytes.extend_from_slice(bytemuck::bytes_of(&self.view));
        bytes
    }
}

/// The view of a placed scene; `first` is the id of its first point in the frame.
fn instance_view(
    (camera, depths): (&Camera, &DepthRange),
    settings: &Settings,
    size: [u32; 2],
    placed: &Placed<'_>,
    first: u32,
) -> Result<View> {
    let placement = placed.placement.unwrap_or(Similarity::IDENTITY);
    let camera = placed.placement.map_or(*camera, |placement| placement.seen_by(camera));
    let (rays, projection) = camera_rays(&camera, size, depths, placement.scale())?;
    let mut view = view(&rays, &projection, &depths.in_unit(placement.scale()), placed.scene.origin());
    view.first_id = first;
    apply_placement(&mut view, settings, &placement);
    apply_levels(&mut view, settings, placed.scene.level_table());
    Ok(view)
}

/// Sets the levels of detail of a scene, and how far they reach.
fn apply_levels(view: &mut View, settings: &Settings, table: Option<&LevelTable>) {
    let [x, y, z, _] = view.flat_rows[1];
    let focal = DVec3::new(x.into(), y.into(), z.into()).length();
    view.level_reach = (focal / f64::from(settings.lod)) as f32;
    view.level_starts = [[u32::MAX; 4]; MOST_LEVELS / 4];
    let Some(table) = table else { return };
    view.level_spacing = table.spacing();
    for (target, start) in view.level_starts.as_flattened_mut().iter_mut().zip(table.starts()) {
        *target = *start;
    }
}

/// Sets scale and rotation of a placed scene, and the lights in its axes.
fn apply_placement(view: &mut View, settings: &Settings, placement: &Similarity) {
    let rotation = placement.rotation();
    view.scale = placement.scale() as f32;
    for (column, axis) in view.rotation.iter_mut().zip([rotation.x_axis, rotation.y_axis, rotation.z_axis]) {
        column[..3].copy_from_slice(&axis.as_vec3().to_array());
    }
    for (target, light) in view.to_light.iter_mut().zip(&settings.lighting.directional) {
        let to_light = rotation.transpose() * Vec3::from_array(light.to_light).as_dvec3();
        target[..3].copy_from_slice(&to_light.as_vec3().to_array());
    }
}

/// The view for positions relative to `origin`, of distances in the same unit.
fn view(rays: &CameraRays, projection: &Projection, depths: &DepthRange, origin: DVec3) -> View {
    let mut view = View::zeroed();
    for (i, row) in rays.rows.into_iter().enumerate() {
        [view.rows_hi[i], view.rows_lo[i]] = split(row);
    }
    let key = DepthKey::new(projection, depths);
    [view.eye_hi, view.eye_lo] = split((rays.eye - origin).extend(key.at_zero(depths)));
    let counted_from = if depths.is_distant(projection) { depths.offset } else { 0.0 };
    [view.forward_hi, view.forward_lo] = split(rays.forward.extend(-counted_from));
    view.distance_offset = depths.offset as f32;
    for (i, row) in rays.rows.iter().take(2).enumerate() {
        let row = row.truncate();
        let flat = row - row.dot(rays.forward) * rays.forward;
        view.flat_rows[i][..3].copy_from_slice(&flat.as_vec3().to_array());
    }
    for (i, column) in key.rays(rays, projection).into_iter().enumerate() {
        [view.ray_hi[i], view.ray_lo[i]] = split(column.extend(0.0));
    }
    view.jacobian = rays.jacobian as f32;
    view.near = projection.near as f32;
    view.key_slope = key.slope as f32;
    view
}

/// Uniforms shared by all scenes; `bounds` are those of all scenes in world space.
fn frame(
    settings: &Settings,
    size: [u32; 2],
    (rays, projection, depths): (&CameraRays, &Projection, &DepthRange),
    bounds: Option<&Bounds>,
) -> Frame {
    let mut frame = Frame::zeroed();
    let key = DepthKey::new(projection, depths);
    frame.viewport = size.map(|side| side as f32);
    frame.near = projection.near as f32;
    frame.key_slope = key.slope as f32;
    [frame.key_near, frame.key_far] = key.of_planes(projection, depths).map(|key| key as f32);
    let distance = bounds.map_or(projection.near, |bounds| rays.distance(bounds.centre()));
    frame.key_gain = key.gain(projection, depths, distance) as f32;
    frame.key_reach = key.reach(settings, rays, projection) as f32;
    let [hi, lo] = split(DVec4::splat(key.offset));
    frame.key_offset = [hi[0], lo[0]];
    frame.key_at_zero = key.at_zero(depths) as f32;
    frame.distance_offset = depths.offset as f32;
    frame.cutoff = settings.cutoff;
    frame.epsilon = settings.epsilon;
    if let Kernel::Confetti { a, n } = settings.splatting.kernel {
        [frame.kernel_a, frame.kernel_n] = [a, n];
    }
    frame.visibility_lowpass = settings.least_lowpass();
    frame.attribute_lowpass = settings.attribute_lowpass();
    frame.pixel_filter = settings.pixel_filter;
    frame.edl = settings.edl;
    frame.ao = settings.ao;
    frame.pixel_width = rays.pixel_width() as f32;
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

/// The rays of a camera whose unit is `unit` world units, and its projection with these depths.
fn camera_rays(
    camera: &Camera,
    size: [u32; 2],
    depths: &DepthRange,
    unit: f64,
) -> Result<(CameraRays, Projection)> {
    let projection = camera.projection()?;
    let rays = CameraRays::new(camera, &projection, size, depths.offset / unit)?;
    let [near, far] = match depths.planes {
        Some(planes) => planes.map(|plane| plane / unit),
        None => [projection.near, projection.far],
    };
    Ok((rays, Projection { near, far, ..projection }))
}

/// Distances of a frame. With parallel rays, and in perspective if the scenes are far away in a narrow field of view, they are counted from a
/// plane near the scenes, and the near and far planes are moved to them, so that float32 resolves depths relative to the scenes, wherever the
/// eye and the camera's own planes are.
struct DepthRange {
    /// Distance of that plane from the eye.
    offset: f64,
    /// Distances from it between which the depth key is exact; `None` for those of the camera's planes.
    planes: Option<[f64; 2]>,
    /// Distances of the camera's near and far planes from it.
    clip: [f64; 2],
}

/// Distance of the planes from the middle of the scenes, in radii of their bounding sphere: edge-on discs that the low-pass widens have
/// fragments far in front of and behind them.
const PLANES: f64 = 4.0;
/// Least distance of the middle of scenes that are far away, likewise.
const DISTANT: f64 = 10.0;
/// Largest width of a pixel in a narrow field of view, relative to the distance: float32 rounds distances by 1/4000 of that or more.
const NARROW: f64 = 1.0 / 4000.0;

impl DepthRange {
    /// The range for scenes with these bounds; the camera's own without any.
    fn new(camera: &Camera, size: [u32; 2], bounds: Option<&Bounds>) -> Result<Self> {
        let projection = camera.projection()?;
        let clip = [projection.near, projection.far];
        let own = Self { offset: 0.0, planes: None, clip };
        let Some(bounds) = bounds.filter(|bounds| bounds.radius > 0.0) else {
            return Ok(own);
        };
        let middle = projection.forward * camera.view.transform_point3(bounds.centre()).z;
        let pixel_width = CameraRays::new(camera, &projection, size, 0.0)?.pixel_width();
        let is_distant = middle >= DISTANT * bounds.radius && pixel_width <= NARROW;
        if projection.perspective && !is_distant {
            return Ok(own);
        }
        let reach = PLANES * bounds.radius;
        let (near, far) = (projection.near.max(middle - reach), projection.far.min(middle + reach));
        if near >= far {
            return Ok(own);
        }
        // Distances stay above 0 where they are.
        let offset = (near - (far - near)).max(0.0);
        let counted = |plane: f64| plane - offset;
        Ok(Self { offset, planes: Some([near, far].map(counted)), clip: clip.map(counted) })
    }

    /// The range in a unit of `unit` world units.
    fn in_unit(&self, unit: f64) -> Self {
        let in_unit = |distances: [f64; 2]| distances.map(|distance| distance / unit);
        Self { offset: self.offset / unit, planes: self.planes.map(in_unit), clip: in_unit(self.clip) }
    }

    /// Whether distances of a camera in perspective are not counted from the eye.
    fn is_distant(&self, projection: &Projection) -> bool {
        projection.perspective && self.planes.is_some()
    }

    /// Distance at which κ is 0 in perspective if distances are not counted from the eye.
    fn zero(&self) -> f64 {
        self.planes.map_or(f64::INFINITY, |[_, far]| far)
    }
}

/// Splits a vector into the sum of two float vectors, 48 bits per coordinate.
fn split(v: DVec4) -> [[f32; 4]; 2] {
    let hi = v.as_vec4();
    let lo = (v - hi.as_dvec4()).as_vec4();
    [hi.to_array(), lo.to_array()]
}

/// The rays of pixels.
struct CameraRays {
    /// World → homogeneous pixel (x, y, w) for positions relative to `eye`; w is the distance along `forward` in perspective.
    rows: [DVec4; 3],
    /// Common point of the rays; for parallel rays, a point of the eye plane.
    eye: DVec3,
    /// Unit viewing direction.
    forward: DVec3,
    /// Columns: the ray of pixel (x, y) is `c0 x + c1 y + c2`: in perspective the point at distance 1 relative to the eye, otherwise the
    /// point on the eye plane.
    pixel: DMat3,
    /// Determinant that scales `√|V|`: see `footprint.glsl`.
    jacobian: f64,
}

impl CameraRays {
    /// The rays of a camera; the eye plane of parallel rays is `offset` in front of the camera's.
    fn new(camera: &Camera, projection: &Projection, size: [u32; 2], offset: f64) -> Result<Self> {
        let world_to_clip = camera.world_to_clip();
        let scale = camera.projection.row(3).abs().max_element();
        let [x, y, w] = [0, 1, 3].map(|i| world_to_clip.row(i) / scale);
        let [half_width, half_height] = size.map(|side| 0.5 * f64::from(side));
        let rows = [half_width * (x + w), half_height * (y + w), w];
        let forward = projection.forward * camera.view.row(2).truncate().normalize();
        // Directions of the rows; parallel rays have the viewing direction in place of the constant w.
        let [x, y, w] = rows.map(DVec4::truncate);
        let third = if projection.perspective { w } else { forward };
        let inverse = DMat3::from_cols(x, y, third).transpose().inverse();
        let eye = if projection.perspective {
            inverse * -DVec3::from_array(rows.map(|row| row.w))
        } else {
            camera.view.inverse().transform_point3(DVec3::ZERO) + offset * forward
        };
        if !inverse.is_finite() || !eye.is_finite() {
            let text = "the camera's matrices are singular: give a field of view and axes of some extent";
            return Err(Error::Usage(text.into()));
        }
        let at_eye = rows.map(|row| if projection.perspective { 0.0 } else { row.dot(eye.extend(1.0)) });
        // Pixel (x, y) relative to that of the eye, with w = 1 in perspective.
        let [x0, y0, _] = at_eye;
        let last = DVec3::new(-x0, -y0, if projection.perspective { 1.0 } else { 0.0 });
        let relative = DMat3::from_cols(DVec3::X, DVec3::Y, last);
        let jacobian = if projection.perspective { 1.0 / inverse.determinant() } else { x.cross(y).length() };
        let rows = [0, 1, 2].map(|i| rows[i].truncate().extend(at_eye[i]));
        Ok(Self { rows, eye, forward, pixel: inverse * relative, jacobian: jacobian.abs() })
    }

    /// Width of a pixel at distance 1 in perspective, at every distance otherwise: of the larger side.
    fn pixel_width(&self) -> f64 {
        self.pixel.x_axis.length().max(self.pixel.y_axis.length())
    }

    /// Distance of a world point from the eye plane.
    fn distance(&self, point: DVec3) -> f64 {
        self.forward.dot(point - self.eye)
    }
}

/// The depth key κ: falling with distance, affine on the screen for every plane. 1 at the near plane if distances are counted from the eye, and
/// with parallel rays.
struct DepthKey {
    /// Orthographic: −dκ/dz. The far plane's κ is ½, which leaves room for surfaces moved back by ε.
    slope: f64,
    /// Perspective: near / z − κ. Above 0 if distances are not counted from the eye: then κ is 0 at the far plane, and depth tests take what is
    /// beyond it for as far away.
    offset: f64,
}

impl DepthKey {
    /// The key of distances in the projection's unit.
    fn new(projection: &Projection, depths: &DepthRange) -> Self {
        let slope = match projection.perspective {
            true => 0.0,
            // Rounded first, so that the rays are computed from the shaders' slope.
            false => f64::from((0.5 / (projection.far - projection.near)) as f32),
        };
        let offset = match depths.is_distant(projection) {
            true => projection.near / (depths.zero() + depths.offset),
            false => 0.0,
        };
        Self { slope, offset }
    }

    /// What the shaders' `key_at_zero` is.
    fn at_zero(&self, depths: &DepthRange) -> f64 {
        if self.offset > 0.0 { self.offset * depths.zero() } else { 0.0 }
    }

    /// κ of the camera's near and far plane.
    fn of_planes(&self, projection: &Projection, depths: &DepthRange) -> [f64; 2] {
        depths.clip.map(|distance| match projection.perspective {
            true => projection.near / (distance + depths.offset) - self.offset,
            false => 1.0 - self.slope * (distance - projection.near),
        })
    }

    /// Columns that give the κ of a plane at a pixel: see `frame.glsl`.
    fn rays(&self, rays: &CameraRays, projection: &Projection) -> [DVec3; 3] {
        let DMat3 { x_axis, y_axis, z_axis } = rays.pixel;
        match projection.perspective {
            true => [x_axis, y_axis, z_axis].map(|column| projection.near * column),
            false => {
                let at_eye = (1.0 + projection.near * self.slope) * rays.forward;
                [self.slope * x_axis, self.slope * y_axis, self.slope * z_axis + at_eye]
            }
        }
    }

    /// How much nearer than its disc a fragment's depth may be, as the shaders' `key_reach`.
    fn reach(&self, settings: &Settings, rays: &CameraRays, projection: &Projection) -> f64 {
        let reach = settings.most_rise() * rays.pixel_width();
        match projection.perspective {
            true if self.offset > 0.0 => reach,
            true => 1.0 + reach,
            false => self.slope * reach,
        }
    }

    /// Inverse of κ at a distance from the eye, or halfway between the planes near the scene, so that their product is near 1 at the scene.
    fn gain(&self, projection: &Projection, depths: &DepthRange, distance: f64) -> f64 {
        match projection.perspective {
            true if self.offset > 0.0 => {
                let halfway = depths.offset + 0.5 * (projection.near + depths.zero());
                1.0 / (projection.near / halfway - self.offset)
            }
            true => distance.max(projection.near) / projection.near,
            false => 1.0,
        }
    }
}
