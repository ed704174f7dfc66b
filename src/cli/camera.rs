//! The camera of the arguments.

use super::args;
use glam::DVec3;
use std::path::Path;
use surfel::formats::camera as camera_file;
use surfel::geometry::{Camera, Extent, Pose, Span};
use surfel::{Error, Result};

/// Default vertical angle of view, degrees.
pub const FOV: f64 = 45.0;

/// Reads the camera file, if one is given.
pub fn read(args: &args::Camera) -> Result<Option<(&Path, Pose)>> {
    args.file.as_deref().map(|path| Ok((path, camera_file::read(path)?))).transpose()
}

/// The camera of `file`, or else of the arguments, which by default frames `extent`.
pub fn make(
    args: &args::Camera,
    file: Option<(&Path, Pose)>,
    extent: &Extent,
    size: [u32; 2],
) -> Result<Camera> {
    let pose = pose(args, file.map(|(_, pose)| pose), extent, size)?;
    let camera = pose.camera(&extent.bounds(), aspect(size));
    match file {
        Some((path, _)) => {
            camera.map_err(|error| Error::input(path.display().to_string(), error.to_string()))
        }
        None => camera,
    }
}

/// The pose of that camera, without near and far planes.
pub fn pose(args: &args::Camera, file: Option<Pose>, extent: &Extent, size: [u32; 2]) -> Result<Pose> {
    if let Some(pose) = file {
        return Ok(pose);
    }
    let (fov, up) = (args.fov.unwrap_or(FOV), up(args, None));
    let span = args.parallel.map_or(Span::Angle(fov), Span::Height);
    let (eye, target) = match (args.eye, args.target) {
        (Some(eye), target) => (eye, target.unwrap_or(extent.centre())),
        (None, target) => {
            let framed = extent.pose(up, fov, aspect(size))?;
            (framed.eye, target.unwrap_or(framed.target))
        }
    };
    Ok(Pose { eye, target, up, span })
}

/// Up direction of the picture, of any length.
pub fn up(args: &args::Camera, file: Option<(&Path, Pose)>) -> DVec3 {
    file.map(|(_, pose)| pose.up).or(args.up).unwrap_or(DVec3::Y)
}

fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0]) / f64::from(size[1])
}
