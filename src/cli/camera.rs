//! The camera of the arguments.

use super::args;
use glam::DVec3;
use std::path::Path;
use surfel::formats::camera as camera_file;
use surfel::geometry::{Camera, Extent, Pose, Span};
use surfel::{Error, Result};

/// Default vertical angle of view, degrees.
pub const FOV: f64 = 45.0;

/// Sine of the least angle between the view and a default up direction.
const ALONG: f64 = 1e-3;

/// Reads the camera file, if one is given.
pub fn read(args: &args::Camera) -> Result<Option<(&Path, Pose)>> {
    args.file.as_deref().map(|path| Ok((path, camera_file::read(path)?))).transpose()
}

/// The camera of `file`, or else of the arguments, which by default frames `extent` with `up` upwards.
pub fn make(
    args: &args::Camera,
    file: Option<(&Path, Pose)>,
    extent: &Extent,
    up: DVec3,
    size: [u32; 2],
) -> Result<Camera> {
    let pose = pose(args, file.map(|(_, pose)| pose), extent, up, size)?;
    let camera = pose.camera(&extent.bounds(), aspect(size));
    match file {
        Some((path, _)) => {
            camera.map_err(|error| Error::input(path.display().to_string(), error.to_string()))
        }
        None => camera,
    }
}

/// The pose of that camera, without near and far planes.
pub fn pose(
    args: &args::Camera,
    file: Option<Pose>,
    extent: &Extent,
    up: DVec3,
    size: [u32; 2],
) -> Result<Pose> {
    if let Some(pose) = file {
        return Ok(pose);
    }
    let fov = args.fov.unwrap_or(FOV);
    let span = args.parallel.map_or(Span::Angle(fov), Span::Height);
    let (eye, target) = match (args.eye, args.target) {
        (Some(eye), target) => (eye, target.unwrap_or(extent.centre())),
        (None, target) => {
            let framed = extent.pose(up, fov, aspect(size))?;
            (framed.eye, target.unwrap_or(framed.target))
        }
    };
    let along = (target - eye).try_normalize().unwrap_or(DVec3::ZERO);
    let up = if args.up.is_none() && along.cross(up).length() < ALONG { upright(up) } else { up };
    Ok(Pose { eye, target, up, span })
}

/// The up direction of a picture from straight above or below: y, as on maps, or −z where y is up.
fn upright(up: DVec3) -> DVec3 {
    if up.y.abs() > 0.5 { DVec3::NEG_Z } else { DVec3::Y }
}

/// Up direction of the picture, of any length; `None` for that of the points.
pub fn up(args: &args::Camera, file: Option<(&Path, Pose)>) -> Option<DVec3> {
    file.map(|(_, pose)| pose.up).or(args.up)
}

fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0]) / f64::from(size[1])
}
