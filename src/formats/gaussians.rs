//! 3D Gaussians: the properties that all their formats have, named as in PLY files of the INRIA code.
//!
//! Source: Kerbl et al., 3D Gaussian Splatting for Real-Time Radiance Field Rendering, 2023.

/// Logarithms of the standard deviations along the three axes.
pub const SCALES: [&str; 3] = ["scale_0", "scale_1", "scale_2"];
/// Rotation, real part first.
pub const ROTATION: [&str; 4] = ["rot_0", "rot_1", "rot_2", "rot_3"];
/// Constant spherical harmonics of the colour.
pub const HARMONICS: [&str; 3] = ["f_dc_0", "f_dc_1", "f_dc_2"];
/// Logit of the opacity.
pub const OPACITY: &str = "opacity";

/// Beginnings of the names of numbered parameters.
const NUMBERED: [&str; 4] = ["f_dc_", "f_rest_", "scale_", "rot_"];

/// Whether a property is a parameter of a Gaussian, in whose place files have its disc and the colour of that. The harmonics of higher degree
/// are of colours that depend on the direction, which surfels do not have.
pub fn is_parameter(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name == OPACITY || NUMBERED.iter().any(|first| name.strip_prefix(first).is_some_and(is_number))
}

/// The logit of an opacity from 0 to 1.
pub fn logit(opacity: f64) -> f64 {
    (opacity / (1.0 - opacity)).ln()
}
