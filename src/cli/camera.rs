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

/// Greatest part of the width that a colour bar keeps free of the scene.
const MOST_KEPT_FREE: f64 = 0.4;

/// A picture, and what covers a part of it.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Width of the colour bar at the right edge, px; 0 without one.
    pub bar: u32,
}

impl Room {
    /// All of a picture.
    pub fn whole(size: [u32; 2]) -> Self {
        Self { size, bar: 0 }
    }

    /// Width at the right edge that stays free, px: of a bar that takes most of the width, none.
    fn kept_free(self) -> u32 {
        if f64::from(self.bar) <= MOST_KEPT_FREE * f64::from(self.size[0]) { self.bar } else { 0 }
    }

    /// Width and height of the part for the scene.
    fn free(self) -> [u32; 2] {
        [self.size[0] - self.kept_free(), self.size[1]]
    }

    /// Eye and target of a pose that frames a scene in a picture as large as the free part, moved so that the scene is in that part.
    fn framed(self, pose: Pose, span: Span) -> (DVec3, DVec3) {
        let forward = pose.target - pose.eye;
        let height = match span {
            Span::Angle(fov) => 2.0 * (0.5 * fov.to_radians()).tan() * forward.length(),
            Span::Height(height) => height,
        };
        let right = forward.cross(pose.up).normalize_or_zero();
        let shift = 0.5 * f64::from(self.kept_free()) / f64::from(self.size[1]) * height * right;
        (pose.eye + shift, pose.target + shift)
    }
}

/// Reads the camera file, if one is given.
pub fn read(args: &args::Camera) -> Result<Option<(&Path, Pose)>> {
    args.file.as_deref().map(|path| Ok((path, camera_file::read(path)?))).transpose()
}

/// The camera of `file`, or else of the arguments, which by default frames `extent` with `up` upwards; with its pose.
pub fn make(
    args: &args::Camera,
    file: Option<(&Path, Pose)>,
    extent: &Extent,
    up: DVec3,
    room: Room,
) -> Result<(Pose, Camera)> {
    let size = room.size;
    let pose = pose(args, file.map(|(_, pose)| pose), extent, up, room)?;
    let camera = pose.camera(&extent.bounds(), aspect(size));
    let camera = match file {
        Some((path, _)) => {
            camera.map_err(|error| Error::input(path.display().to_string(), error.to_string()))
        }
        None => camera,
    };
    Ok((pose, camera?))
}

/// The pose of that camera, without near and far planes.
pub fn pose(args: &args::Camera, file: Option<Pose>, extent: &Extent, up: DVec3, room: Room) -> Result<Pose> {
    if let Some(pose) = file {
        return Ok(pose);
    }
    let fov = args.fov.unwrap_or(FOV);
    let span = args.parallel.map_or(Span::Angle(fov), Span::Height);
    let (eye, target) = match (args.eye, args.target) {
        (Some(eye), target) => (eye, target.unwrap_or(extent.centre())),
        (None, Some(target)) => (extent.pose(up, fov, aspect(room.size))?.eye, target),
        (None, None) => room.framed(extent.pose(up, fov, aspect(room.free()))?, span),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Command, Surfel};
    use clap::Parser;
    use surfel::verify::scenes::bumpy_sphere;

    /// Least and greatest column of the centres of the bumpy sphere's surfels in a picture with a bar, px.
    fn columns(options: &[&str], room: Room) -> [f64; 2] {
        let command = ["surfel", "render", "a.ply", "-o", "a.png"].iter().chain(options);
        let Command::Render(args) = Surfel::try_parse_from(command).unwrap().command else {
            panic!("no render")
        };
        let surfels = bumpy_sphere::sample(2000, 1);
        let extent = Extent::of(&surfels).unwrap();
        let (_, camera) = make(&args.camera, None, &extent, DVec3::Y, room).unwrap();
        let columns = surfels.positions.iter().map(|p| {
            let clip = camera.world_to_clip() * p.as_dvec3().extend(1.0);
            (0.5 + 0.5 * clip.x / clip.w) * f64::from(room.size[0])
        });
        columns.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    #[test]
    fn scenes_are_framed_beside_the_colour_bar() {
        for size in [[256, 192], [300, 600], [800, 300]] {
            let room = Room { size, bar: 100 };
            for options in [&[][..], &["--fov", "70"], &["--parallel", "2.5"]] {
                let [low, high] = columns(options, room);
                let [whole_low, whole_high] = columns(options, Room::whole(size));
                assert!(low < whole_low && high < whole_high, "{size:?} {options:?}");
                // The height of parallel rays is given.
                let fits = low > 0.0 && high < f64::from(size[0] - 100);
                assert!(fits || options.contains(&"--parallel"), "{size:?} {options:?}: {low} to {high}");
            }
            let narrow = Room { size: [240, 192], ..room };
            assert_eq!(columns(&[], narrow), columns(&[], Room::whole(narrow.size)));
            let given = ["--eye=0,0,4", "--target", "0,0,0"];
            assert_eq!(columns(&given, room), columns(&given, Room::whole(size)));
        }
    }
}
