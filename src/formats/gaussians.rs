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

/// The logit of an opacity from 0 to 1.
pub fn logit(opacity: f64) -> f64 {
    (opacity / (1.0 - opacity)).ln()
}
