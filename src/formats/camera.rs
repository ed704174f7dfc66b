//! Camera files: read by `--camera`, written by `--save-camera` and the window.
//!
//! ```json
//! {"eye": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fov_y_deg": 45}
//! ```
//!
//! With `height` in place of `fov_y_deg` the projection is orthographic, and the value is the height of the picture in the scene's unit. A
//! written camera is read back bit by bit.

use super::read_small;
use crate::error::{Error, Result};
use crate::geometry::{Pose, Span};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Contents of a file.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, expecting = "an object with eye, target, up, and fov_y_deg or height")]
pub struct Fields {
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fov_y_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
}

impl From<Pose> for Fields {
    fn from(Pose { eye, target, up, span }: Pose) -> Self {
        let (fov_y_deg, height) = match span {
            Span::Angle(degrees) => (Some(degrees), None),
            Span::Height(height) => (None, Some(height)),
        };
        Self { eye: eye.into(), target: target.into(), up: up.into(), fov_y_deg, height }
    }
}

/// Reads a file; an error names it and the field.
pub fn read(path: &Path) -> Result<Pose> {
    let text = read_small(path)?;
    parse(&text).map_err(|error| error.in_input(path.display().to_string()))
}

/// Parses the contents of a file.
pub fn parse(text: &[u8]) -> Result<Pose> {
    let fields: Fields =
        serde_json::from_slice(text).map_err(|error| Error::Usage(format!("{error}: correct the file")))?;
    let span = match (fields.fov_y_deg, fields.height) {
        (Some(degrees), None) => Span::Angle(degrees),
        (None, Some(height)) => Span::Height(height),
        _ => {
            return Err(Error::Usage(
                "it needs either `fov_y_deg`, in degrees, or `height`, for parallel rays: correct the file"
                    .into(),
            ));
        }
    };
    let pose = Pose { eye: fields.eye.into(), target: fields.target.into(), up: fields.up.into(), span };
    pose.check().map(|()| pose)
}

/// Contents of a file, one line per field.
pub fn text(pose: &Pose) -> String {
    let fields = Fields::from(*pose);
    let line = |name: &str, value: String| format!("\"{name}\": {value}");
    let place = |at: [f64; 3]| format!("[{:?}, {:?}, {:?}]", at[0], at[1], at[2]);
    let span = match pose.span {
        Span::Angle(degrees) => line("fov_y_deg", format!("{degrees:?}")),
        Span::Height(height) => line("height", format!("{height:?}")),
    };
    let lines = [
        line("eye", place(fields.eye)),
        line("target", place(fields.target)),
        line("up", place(fields.up)),
        span,
    ];
    format!("{{\n  {}\n}}\n", lines.join(",\n  "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        for span in [Span::Angle(44.999_999_999_999_99), Span::Height(1.0 / 3.0)] {
            let pose = Pose {
                eye: DVec3::new(0.1, -1e-17, 1e30),
                target: DVec3::new(1.0 / 7.0, 2.0, -3.5e-5),
                up: DVec3::new(0.0, 0.6, -0.8),
                span,
            };
            assert_eq!(parse(text(&pose).as_bytes()).unwrap(), pose, "{}", text(&pose));
            let line = serde_json::to_vec(&Fields::from(pose)).unwrap();
            assert_eq!(parse(&line).unwrap(), pose);
        }
    }

    #[test]
    fn errors_name_the_cause() {
        let with = |end: &str| format!(r#"{{"eye":[0,0,3],"target":[0,0,0],"up":[0,1,0]{end}}}"#);
        for (end, cause) in [
            ("", "either `fov_y_deg`"),
            (r#","fov_y_deg":45,"height":1"#, "either `fov_y_deg`"),
            (r#","fov_y_deg":180"#, "field of view is 180"),
            (r#","height":0"#, "height of the picture is 0"),
            (r#","fov":45"#, "unknown field `fov`"),
        ] {
            let error = parse(with(end).as_bytes()).unwrap_err().to_string();
            assert!(error.contains(cause), "{end}: {error}");
        }
        let on_target = with(r#","height":1"#).replace("0,0,3", "0,0,0");
        assert!(parse(on_target.as_bytes()).unwrap_err().to_string().contains("is at its target"));
    }
}
