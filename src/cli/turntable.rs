//! `surfel render --turntable`: cameras on a circle about the scene, and the names of their pictures.

use super::args;
use super::render::Task;
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::TAU;
use std::ffi::{OsStr, OsString};
use surfel::formats::image::Output;
use surfel::geometry::Camera;
use surfel::{Error, Result};

/// Maximum number of digits.
const MOST_DIGITS: usize = 9;

/// Pattern of the pictures' names.
pub struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Parses a name with one `%d`, or `%04d` for numbers of at least four digits.
    pub fn parse(name: &OsStr) -> Result<Self> {
        let refuse = || {
            Error::Usage(format!(
                "{}: --turntable numbers its pictures: name them with %04d, once, as in frames/%04d.png",
                name.display()
            ))
        };
        let text = name.to_str().ok_or_else(refuse)?;
        let (before, rest) = text.split_once('%').ok_or_else(refuse)?;
        let (width, after) = rest.split_once('d').ok_or_else(refuse)?;
        let digits = match width {
            "" => 1,
            _ => width.strip_prefix('0').and_then(|digits| digits.parse().ok()).ok_or_else(refuse)?,
        };
        if !(1..=MOST_DIGITS).contains(&digits) || after.contains('%') {
            return Err(refuse());
        }
        Ok(Self { before: before.into(), digits, after: after.into() })
    }

    /// The name of a picture.
    pub fn file(&self, number: u32) -> OsString {
        let Self { before, digits, after } = self;
        format!("{before}{number:0digits$}{after}").into()
    }
}

/// The pattern of the output, if a turntable is rendered.
pub fn pattern(args: &args::Render) -> Result<Option<Pattern>> {
    args.turntable.map(|_| Pattern::parse(&args.output)).transpose()
}

/// The output, or the first one of a turntable.
pub fn first(args: &args::Render) -> Result<Output> {
    let first = pattern(args)?.map(|pattern| pattern.file(0));
    Ok(Output::parse(first.as_ref().unwrap_or(&args.output)))
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
    fn names_contain_the_number() {
        let file = |name: &str, number| Pattern::parse(name.as_ref()).unwrap().file(number);
        assert_eq!(file("frames/%04d.png", 7), "frames/0007.png");
        assert_eq!(file("%d.exr", 12), "12.exr");
        assert_eq!(file("a%02db.png", 123), "a123b.png");
        for bad in ["a.png", "-", "%.png", "%4d.png", "%0d.png", "%s.png", "%d%d.png", "%d%.png", "%099d.png"]
        {
            let error = Pattern::parse(bad.as_ref()).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains("%04d") && error.contains(bad), "{error}");
        }
    }

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
