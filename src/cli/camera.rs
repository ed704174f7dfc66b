//! The camera that the arguments ask for.

use super::args;
use super::files::read_json;
use glam::DVec3;
use std::path::Path;
use surfel::geometry::{Bounds, Camera};
use surfel::{Error, Result};

/// Vertical angle of view unless another is given, degrees.
const FOV: f64 = 45.0;

/// A camera file.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    fov_y_deg: f64,
}

/// The contents of the camera file, if one is named: read before anything large is.
pub fn read(args: &args::Camera) -> Result<Option<(&Path, File)>> {
    args.file.as_deref().map(|path| Ok((path, read_json(path)?))).transpose()
}

/// The camera of `file`, or else of the arguments: what is not given is as if the whole of `bounds` were framed.
pub fn make(
    args: &args::Camera,
    file: Option<(&Path, File)>,
    bounds: &Bounds,
    size: [u32; 2],
) -> Result<Camera> {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let look_at = |eye, target, up, fov: f64| {
        Camera::look_at(eye, target, up, fov.to_radians(), aspect, Camera::near_for(eye, bounds))
    };
    if let Some((path, File { eye, target, up, fov_y_deg })) = file {
        return look_at(eye.into(), target.into(), up.into(), fov_y_deg)
            .map_err(|error| Error::input(path.display().to_string(), error.to_string()));
    }
    let fov = args.fov.unwrap_or(FOV);
    let eye = match args.eye {
        Some(eye) => eye,
        None => framed_eye(bounds, fov, aspect)?,
    };
    look_at(eye, args.target.unwrap_or(bounds.centre()), up(args, None), fov)
}

/// What is up in the picture, as far as the arguments say; not of unit length.
pub fn up(args: &args::Camera, file: Option<(&Path, File)>) -> DVec3 {
    file.map(|(_, file)| file.up.into()).or(args.up).unwrap_or(DVec3::Y)
}

/// Where a camera stands that shows the whole of `bounds`.
fn framed_eye(bounds: &Bounds, fov: f64, aspect: f64) -> Result<DVec3> {
    Ok(Camera::framing(bounds, fov.to_radians(), aspect)?.view.inverse().w_axis.truncate())
}
