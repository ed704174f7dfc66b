//! Camera and viewport of a host, and the derived shader parameters.

use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::vk::Device;
use ash::vk;

/// Camera and viewport of a frame.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The host's view and projection. `reversed` must equal that of the target.
    pub camera: Camera,
    /// The host's viewport: whole pixels from the top left of the target. A negative height is that of a projection whose y points up, with
    /// the viewport's y at its lower end.
    pub viewport: vk::Viewport,
}

impl View {
    /// A view of a whole target of `size` px, with depths from 0 to 1.
    pub fn whole(camera: Camera, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as f32);
        Self { camera, viewport: vk::Viewport { width, height, max_depth: 1.0, ..Default::default() } }
    }

    /// Converts to a target's conventions; `reversed` is that of the target's depth, if any. Returns an error for unsupported viewports and
    /// cameras.
    pub(super) fn in_target(&self, device: &Device, reversed: Option<bool>) -> Result<TargetView> {
        let area = self.area(device.capabilities().max_framebuffer)?;
        check_depths(self.viewport)?;
        let camera = self.upright();
        check_convention(reversed, &camera)?;
        let depth_coefficients = depth_coefficients(&camera, self.viewport)?;
        let depth = depths(depth_coefficients, self.viewport);
        Ok(TargetView {
            area,
            size: [area.extent.width, area.extent.height],
            camera,
            depth_coefficients,
            depth,
        })
    }

    /// The viewport as an area of a framebuffer of at most `most` px.
    fn area(&self, most: [u32; 2]) -> Result<vk::Rect2D> {
        let vk::Viewport { x, y, width, height, .. } = self.viewport;
        let top = if height < 0.0 { y + height } else { y };
        let whole = [x, top, width, height].iter().all(|side| side.fract() == 0.0 && side.abs() < 65536.0);
        if !whole || width < 1.0 || height.abs() < 1.0 || x < 0.0 || top < 0.0 {
            return Err(Error::Usage(format!(
                "a viewport of {width}x{height} px at ({x}, {y}): give whole pixels, at least 1x1, within the target"
            )));
        }
        let ends = [x + width, top + height.abs()];
        if ends.iter().zip(most).any(|(end, most)| *end > most as f32) {
            let [widest, highest] = most;
            return Err(Error::Usage(format!(
                "a viewport of {width}x{height} px at ({x}, {y}): the device supports targets of at most {widest}x{highest} px"
            )));
        }
        Ok(vk::Rect2D {
            offset: vk::Offset2D { x: x as i32, y: top as i32 },
            extent: vk::Extent2D { width: width as u32, height: height.abs() as u32 },
        })
    }

    /// The camera for rows of pixels from the top, whatever the sign of the viewport's height.
    fn upright(&self) -> Camera {
        let mut camera = self.camera;
        if self.viewport.height < 0.0 {
            for column in [
                &mut camera.projection.x_axis,
                &mut camera.projection.y_axis,
                &mut camera.projection.z_axis,
                &mut camera.projection.w_axis,
            ] {
                column.y = -column.y;
            }
        }
        camera
    }
}

/// A view in the conventions of its target.
pub(super) struct TargetView {
    /// Area of the picture in the target, px.
    pub(super) area: vk::Rect2D,
    /// Width and height of the area, px.
    pub(super) size: [u32; 2],
    /// The camera, for rows of pixels from the top.
    pub(super) camera: Camera,
    /// The host's depth at distance z is the first number plus the second divided by z in perspective, or times z otherwise.
    pub(super) depth_coefficients: [f64; 2],
    /// The parameters of `host_depth` in `lib/host.glsl`.
    pub(super) depth: [f32; 4],
}

impl TargetView {
    /// Returns an error if the area is not within the `attachments` of `size` px, which `call` sets.
    pub(super) fn check_area(&self, attachments: &str, size: [u32; 2], call: &str) -> Result<()> {
        let vk::Rect2D { offset, extent } = self.area;
        let ends = [offset.x as u32 + extent.width, offset.y as u32 + extent.height];
        let [width, height] = size;
        if ends[0] <= width && ends[1] <= height {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "the viewport ends at ({}, {}), but the {attachments} {width}x{height} px: call `{call}` with the framebuffer's size",
            ends[0], ends[1]
        )))
    }
}

/// Validates the depth range of the viewport.
fn check_depths(viewport: vk::Viewport) -> Result<()> {
    let range = [viewport.min_depth, viewport.max_depth];
    if range.iter().all(|depth| (0.0..=1.0).contains(depth)) {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "depths of the viewport from {} to {}: give numbers from 0 to 1",
            range[0], range[1]
        )))
    }
}

/// Validates that camera and target agree on reversed depth, if there is depth.
fn check_convention(reversed: Option<bool>, camera: &Camera) -> Result<()> {
    let name = |reversed| if reversed { "falls" } else { "rises" };
    match reversed {
        Some(reversed) if camera.reversed != reversed => Err(Error::Usage(format!(
            "the camera's depth {} with distance, the target's {}: give one convention",
            name(camera.reversed),
            name(reversed)
        ))),
        _ => Ok(()),
    }
}

/// See [`TargetView::depth_coefficients`].
fn depth_coefficients(camera: &Camera, viewport: vk::Viewport) -> Result<[f64; 2]> {
    let projection = camera.projection()?;
    let (z, w) = (camera.projection.row(2), camera.projection.row(3));
    let [first, by_distance] = if projection.perspective {
        [z.z / w.z, z.w / w.z.abs()]
    } else {
        [z.w / w.w, projection.forward * z.z / w.w]
    };
    let (low, range) = (f64::from(viewport.min_depth), f64::from(viewport.max_depth - viewport.min_depth));
    Ok([low + range * first, range * by_distance])
}

/// The parameters of `host_depth` in `lib/host.glsl`.
fn depths(coefficients: [f64; 2], viewport: vk::Viewport) -> [f32; 4] {
    let [first, by_distance] = coefficients.map(|coefficient| coefficient as f32);
    let [least, greatest] = [viewport.min_depth, viewport.max_depth];
    [first, by_distance, least.min(greatest), least.max(greatest)]
}
