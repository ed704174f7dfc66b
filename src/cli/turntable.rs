//! `surfel render --turntable`: cameras on a circle about the scene.

use super::pattern::Pattern;
use super::render::Task;
use super::{args, files};
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::TAU;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use surfel::Result;
use surfel::formats::atomic;
use surfel::formats::image::Output;
use surfel::geometry::Camera;

/// The pattern of the output, if a turntable is rendered.
pub fn pattern(args: &args::Render) -> Result<Option<Pattern>> {
    args.turntable.map(|_| Pattern::parse(&args.output)).transpose()
}

/// The output, or the first one of a turntable.
pub fn first(args: &args::Render) -> Result<Output> {
    let first = pattern(args)?.map(|pattern| pattern.file(0));
    Ok(Output::parse(first.as_ref().unwrap_or(&args.output)))
}

/// The folder of the pictures, if a turntable is rendered.
pub fn folder(args: &args::Render, first: &Output) -> Option<PathBuf> {
    let Output::File(path) = first else { return None };
    args.turntable.map(|_| atomic::folder_of(path))
}

/// Checks that a file can be written, in the folder of the pictures also before that is created.
pub fn check_file(args: &args::Render, first: &Output, output: &OsString) -> Result<()> {
    let absolute = |path: &Path| std::path::absolute(path).ok();
    let own = absolute(&atomic::folder_of(Path::new(output)));
    match folder(args, first).filter(|folder| !folder.exists()) {
        Some(folder) if absolute(&folder) == own => Ok(()),
        _ => files::check(output),
    }
}

/// The cameras of a full turn of `count` pictures about the axis `up` through `middle`, counter-clockwise as seen from above. The first is
/// `camera` itself.
pub fn cameras(camera: &Camera, middle: DVec3, up: DVec3, count: u32) -> Vec<Camera> {
    let axis = up.normalize();
    let turned = |number: u32| {
        if number == 0 {
            return *camera;
        }
        // Turning the camera is turning the world the other way.
        let back = DQuat::from_axis_angle(axis, -TAU * f64::from(number) / f64::from(count));
        let about =
            DMat4::from_translation(middle) * DMat4::from_quat(back) * DMat4::from_translation(-middle);
        Camera { view: camera.view * about, ..*camera }
    };
    (0..count).map(turned).collect()
}

/// Reports the progress of the turn.
pub fn report_progress(task: &Task<'_>, number: usize, count: usize) {
    task.progress.at("rendering pictures", number as u64, count as u64);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_stand_on_a_circle_and_look_at_its_middle() {
        let (middle, up) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, 2.0));
        let eye = DVec3::new(1.0, -2.0, 4.0);
        let camera = Camera::look_at(eye, middle, up, 1.0, 1.0, 0.1).unwrap();
        let turn = cameras(&camera, middle, up, 4);
        assert_eq!((turn.len(), turn[0]), (4, camera));
        for (number, expected) in [(1, [5.0, 2.0]), (2, [1.0, 6.0]), (3, [-3.0, 2.0])] {
            let at = turn[number].view.inverse().transform_point3(DVec3::ZERO);
            assert!((at - DVec3::new(expected[0], expected[1], 4.0)).length() < 1e-12, "{number}: {at}");
            let seen = turn[number].view.transform_point3(middle);
            assert!(seen.truncate().length() < 1e-12 && (seen.z - 17f64.sqrt()).abs() < 1e-12, "{seen}");
            let above = turn[number].view.transform_vector3(up);
            assert!(above.x.abs() < 1e-12 && above.y < 0.0, "{above}");
        }
    }
}
