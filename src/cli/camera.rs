//! The camera of the arguments.

use super::args;
use glam::DVec3;
use std::path::Path;
use surfel::formats::camera as camera_file;
use surfel::geometry::{Bounds, Camera, Pose, Span};
use surfel::{Error, Result};

/// Default vertical angle of view, degrees.
pub const FOV: f64 = 45.0;

/// Reads the camera file, if one is given.
pub fn read(args: &args::Camera) -> Result<Option<(&Path, Pose)>> {
    args.file.as_deref().map(|path| Ok((path, camera_file::read(path)?))).transpose()
}

/// The camera of `file`, or else of the arguments, which by default frames `bounds`.
pub fn make(
    args: &args::Camera,
    file: Option<(&Path, Pose)>,
    bounds: &Bounds,
    size: [u32; 2],
) -> Result<Camera> {
    let camera = pose(args, file.map(|(_, pose)| pose), bounds, size)?.camera(bounds, aspect(size));
    match file {
        Some((path, _)) => {
            camera.map_err(|error| Error::input(path.display().to_string(), error.to_string()))
        }
        None => camera,
    }
}

/// The pose of that camera, without near and far planes.
pub fn pose(args: &args::Camera, file: Option<Pose>, bounds: &Bounds, size: [u32; 2]) -> Result<Pose> {
    if let Some(pose) = file {
        return Ok(pose);
    }
    let fov = args.fov.unwrap_or(FOV);
    let eye = match args.eye {
        Some(eye) => eye,
        None => framed_eye(bounds, fov, aspect(size))?,
    };
    let span = args.parallel.map_or(Span::Angle(fov), Span::Height);
    Ok(Pose { eye, target: args.target.unwrap_or(bounds.centre()), up: up(args, None), span })
}

/// Up direction of the picture, of any length.
pub fn up(args: &args::Camera, file: Option<(&Path, Pose)>) -> DVec3 {
    file.map(|(_, pose)| pose.up).or(args.up).unwrap_or(DVec3::Y)
}

fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0]) / f64::from(size[1])
}

/// Position of the eye that frames `bounds`.
fn framed_eye(bounds: &Bounds, fov: f64, aspect: f64) -> Result<DVec3> {
    Ok(Camera::framing(bounds, fov.to_radians(), aspect)?.view.inverse().w_axis.truncate())
}
